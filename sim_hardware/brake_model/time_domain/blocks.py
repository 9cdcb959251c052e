"""The fast recursion while both pads slide forwards: eight steps at a time, two friction groups, 16 modes.

Between two evaluations of the friction law everything is linear in w = (s form of the modes, past g), in the
g of the steps and in the excitation. So the recursion of `kernels` is written for eight steps at once: the
contact motion that w and the excitation cause is computed for all of them beforehand, the g of each step is
added to the contact motion of the later ones as it becomes known, and w is carried on once. The same numbers
up to rounding, but only the law, one product and one sum lie on the path from step to step.
A block in which a slip would reverse is not taken; the caller (`integrator`) turns to `kernels` for it.
NOT its job: what the coefficients mean (`modal`, `integrator`), careful steps (`contact`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit

from sim_hardware.brake_model.time_domain import simd as _simd
from sim_hardware.brake_model.time_domain.contact import DEPTH, SLIDES, Array, Coefficients
from sim_hardware.brake_model.time_domain.modal import MODE_BLOCK

#: intrinsics get their first argument from the compiler: no type checker knows that
simd: Any = _simd

#: internal steps at a time
STEPS = 8
_PADS = 2
_CONTACTS = 2 * _PADS
#: parts of the vector x = (Re s, Im s, past g, excitation of the steps, g of the steps)
_PAST = 2 * MODE_BLOCK
_PUSH = _PAST + _PADS * (DEPTH - 1)
_G = _PUSH + _PADS * STEPS
_SIZE = _G + _PADS * STEPS
_WIDE = -(-_SIZE // 4) * 4
#: order of contact motions in vectors: slip of both pads, compression of both pads
_ORDER = (0, 2, 1, 3)
#: vectors that straddle two cache lines are slow to load
_CACHE_LINE = 64
_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}


class BlockTables(NamedTuple):
    """Effect of x on the eight steps of a block."""

    ahead: Array  # (_G, STEPS * 4) contact motion at the ends of the steps, by parts of x but the last
    response: Array  # (STEPS, 2, 4) contact motion 1, 2, ... steps after a unit g
    carry: Array  # (2 * STEPS * 2, 2, MODE_BLOCK) s at the end from excitation and g of the steps
    rotation: Array  # (2, MODE_BLOCK) eight steps of the free modes
    output: Array  # (O, _WIDE, STEPS) outputs at the starts of the steps
    share: Array  # (2,)
    x: Array  # (_WIDE,) scratch
    ends: Array  # (STEPS * 4,) scratch


def suits(c: Coefficients) -> bool:
    """Whether the block form is made for this brake and rate."""
    return (len(c.share), c.modal.shape[2]) == (_PADS, MODE_BLOCK) and STEPS % c.substeps == 0


def _aligned(values: Array) -> Array:
    """Copy to the beginning of a cache line."""
    line = _CACHE_LINE // values.itemsize
    buffer = np.zeros(values.size + line)
    start = -(buffer.ctypes.data // values.itemsize) % line
    aligned = buffer[start : start + values.size].reshape(values.shape)
    aligned[...] = values
    return aligned


def block_tables(c: Coefficients) -> BlockTables:
    """Write the one-step recursion of `kernels` for blocks of `STEPS` steps."""
    past, rows = _PADS * (DEPTH - 1), len(c.output_direct)
    flat = c.modal.reshape(len(c.modal), _PAST)  # (Re, Im) of each row
    one = np.zeros((_PUSH, _PUSH))  # w one step later
    er, ei = np.diag(c.modal[c.rotation, 0]), np.diag(c.modal[c.rotation, 1])
    one[:_PAST, :_PAST] = np.block([[er, -ei], [ei, er]])
    one[_PAST + _PADS :, _PAST:-_PADS] = np.eye(past - _PADS)
    drive, hold = np.zeros((_PUSH, _PADS)), np.zeros((_PUSH, _PADS))
    drive[:_PAST] = flat[c.drive : c.drive + _PADS].T
    drive[_PAST : _PAST + _PADS] = np.eye(_PADS)
    hold[:_PAST] = flat[c.hold : c.hold + _PADS].T
    order = list(_ORDER)
    ahead = np.hstack([flat[c.ahead : c.ahead + _CONTACTS], c.ahead_history[:, 1:].reshape(_CONTACTS, past)])
    ahead, ahead_g, ahead_hold = ahead[order], c.ahead_history[order, 0], c.ahead_hold[order]
    output = np.hstack([flat[c.output : c.output + rows], c.output_history[:, 1:].reshape(rows, past)])
    output_g = c.output_history[:, 0] + c.output_direct

    power = [np.eye(_PUSH)]
    for _ in range(STEPS):
        power.append(one @ power[-1])
    from_state = np.zeros((STEPS, _CONTACTS, _G))
    response = np.zeros((STEPS, _CONTACTS, _PADS))
    carry = np.zeros((2 * STEPS, _PADS, _PAST))
    seen = np.zeros((rows, _WIDE, STEPS))
    for n in range(STEPS):
        from_state[n, :, :_PUSH] = ahead @ power[n]
        response[n] = ahead @ power[n - 1] @ drive if n else ahead_g
        carry[n] = (power[STEPS - 1 - n] @ hold)[:_PAST].T
        carry[STEPS + n] = (power[STEPS - 1 - n] @ drive)[:_PAST].T
        seen[:, :_PUSH, n] = output @ power[n]
        for i in range(n + 1):  # excitation and g of step i
            push, g = (slice(part + _PADS * i, part + _PADS * (i + 1)) for part in (_PUSH, _G))
            from_state[n, :, push] = ahead @ power[n - 1 - i] @ hold if i < n else ahead_hold
            seen[:, push, n] = output @ power[n - 1 - i] @ hold if i < n else c.output_direct
            seen[:, g, n] = output @ power[n - 1 - i] @ drive if i < n else output_g
    rotation = (c.modal[c.rotation, 0] + 1j * c.modal[c.rotation, 1]) ** STEPS
    tables = (
        from_state.reshape(STEPS * _CONTACTS, _G).T,
        response.transpose(0, 2, 1),
        carry.reshape(-1, 2, MODE_BLOCK),
        np.vstack([rotation.real, rotation.imag]),
        seen,
        c.share,
        np.zeros(_WIDE),
        np.zeros(STEPS * _CONTACTS),
    )
    return BlockTables(*map(_aligned, tables))


@njit(inline="always", **_OPTIONS)
def _law(contact: Any, share: Any, n0: float, mu: float, k: float, mu_ref: float, inverse: float) -> Any:
    """g of both pads, sliding forwards (`contact.forward_g`): exactly 0 at rest."""
    slip, compression = simd.lower_half(contact), simd.upper_half(contact)
    mean = simd.multiply(share, simd.splat2(n0))
    lifted = simd.larger(compression, simd.multiply(share, simd.splat2(-n0)))  # max(N~, -N0)
    x = simd.multiply(slip, simd.splat2(inverse))
    normal = simd.multiply(simd.multiply(slip, simd.splat2(k)), simd.add(mean, lifted))
    linear = simd.scale_add(lifted, mu, simd.multiply(compression, simd.splat2(-mu_ref)))
    return simd.add(simd.over_root(normal, simd.multiply_add(x, x, simd.splat2(1.0))), linear)


@njit(inline="always", **_OPTIONS)
def _later(response: Array, n: int, ga: float, gb: float, contact: Any) -> Any:
    """Contact motion n + 1 steps later, with the effect of the present g added."""
    first = simd.scale_add(simd.load4(response, 8 * n + 4), gb, contact)
    return simd.scale_add(simd.load4(response, 8 * n), ga, first)


@njit(**_OPTIONS)
def advance_blocks(  # noqa: PLR0912, PLR0915 (one loop: what it holds in vector registers cannot be passed)
    t: BlockTables,
    memory: Array,
    operation: Array,
    inverse_saturation: float,
    mu_ref: float,
    substeps: int,
    first: int,
    excitation: Array,
    out: Array,
) -> int:
    """Advance by as many whole blocks as there are, up to one in which the slip of a pad would reverse.

    Parameters
    ----------
    t : tables
    memory : flat `contact.Memory`; g must follow from the law (`contact.FROM_LAW`); updated
    operation, inverse_saturation, excitation, out : as in `kernels.advance_general`
    first : internal step to begin with, a multiple of `substeps`

    Returns
    -------
    first internal step that was not taken
    """
    steps = out.shape[0] * substeps
    n0, mu, v, k = operation[0, 0], operation[1, 0], operation[2, 0], operation[3, 0]
    n0_step = (operation[0, 1] - n0) / steps
    mu_step = (operation[1, 1] - mu) / steps
    v_step = (operation[2, 1] - v) / steps
    k_step = (operation[3, 1] - k) / steps
    pushed = len(excitation) > 0
    share = simd.load2(t.share, 0)
    x, ends = t.x, t.ends
    for j in range(_WIDE):
        x[j] = memory[j] if j < _PUSH else 0.0
    for row in range(4):
        ends[row] = memory[_PUSH + _ORDER[row]]
    now = simd.load4(ends, 0)
    step, interval, intervals = first, first // substeps, STEPS // substeps
    while step + STEPS <= steps:
        # contact motion at the ends of the steps from w and the excitation
        low = high = simd.zero16()
        if pushed:
            at_x = _PUSH
            for i in range(intervals):
                ea, eb = excitation[interval + i, 0], excitation[interval + i, 1]
                for _ in range(substeps):
                    x[at_x], x[at_x + 1] = ea, eb
                    at_x += 2
        for j in range(_G if pushed else _PUSH):
            low = simd.scale_add(simd.load16(t.ahead, 32 * j), x[j], low)
            high = simd.scale_add(simd.load16(t.ahead, 32 * j + 16), x[j], high)
        simd.store(ends, 0, low)
        simd.store(ends, 16, high)
        # step by step: friction law, its effect on the contact motion of the later steps
        c1, c2 = simd.load4(ends, 0), simd.load4(ends, 4)
        c3, c4 = simd.load4(ends, 8), simd.load4(ends, 12)
        c5, c6 = simd.load4(ends, 16), simd.load4(ends, 20)
        c7, c8 = simd.load4(ends, 24), simd.load4(ends, 28)
        contact = now
        margin = simd.splat2(np.inf)
        for n in range(STEPS):
            at = float(step + n)
            g = _law(
                contact, share, n0 + n0_step * at, mu + mu_step * at, k + k_step * at, mu_ref,
                inverse_saturation,
            )  # fmt: skip
            simd.store(x, _G + 2 * n, g)
            ga, gb = simd.lane0(g), simd.lane1(g)
            contact = _later(t.response, 0, ga, gb, c1)
            c1 = _later(t.response, 1, ga, gb, c2)
            c2 = _later(t.response, 2, ga, gb, c3)
            c3 = _later(t.response, 3, ga, gb, c4)
            c4 = _later(t.response, 4, ga, gb, c5)
            c5 = _later(t.response, 5, ga, gb, c6)
            c6 = _later(t.response, 6, ga, gb, c7)
            c7 = _later(t.response, 7, ga, gb, c8)
            sliding = (1.0 - SLIDES) * (v + v_step * (at + 1.0))
            margin = simd.smaller(
                simd.multiply_add(simd.lower_half(contact), simd.splat2(-1.0), simd.splat2(sliding)), margin
            )
        if not (simd.lane0(margin) > 0.0 and simd.lane1(margin) > 0.0):
            break
        for o in range(t.output.shape[0]):
            q0 = q1 = q2 = q3 = simd.zero8()  # four sums at a time hide the latency
            base = o * _WIDE * STEPS
            for j in range(0, _WIDE, 4):
                at_j = base + STEPS * j
                q0 = simd.scale_add(simd.load8(t.output, at_j), x[j], q0)
                q1 = simd.scale_add(simd.load8(t.output, at_j + 8), x[j + 1], q1)
                q2 = simd.scale_add(simd.load8(t.output, at_j + 16), x[j + 2], q2)
                q3 = simd.scale_add(simd.load8(t.output, at_j + 24), x[j + 3], q3)
            simd.store(ends, 0, simd.add(simd.add(q0, q1), simd.add(q2, q3)))
            for i in range(intervals):
                out[interval + i, o] = ends[i * substeps]
        # w at the end of the block
        zr, zi = simd.load16(x, 0), simd.load16(x, 16)
        er, ei = simd.load16(t.rotation, 0), simd.load16(t.rotation, 16)
        re = simd.negative_multiply_add(ei, zi, simd.multiply(er, zr))
        im = simd.multiply_add(er, zi, simd.multiply(ei, zr))
        for j in range(0 if pushed else 2 * STEPS, 4 * STEPS):
            re = simd.scale_add(simd.load16(t.carry, 32 * j), x[_PUSH + j], re)
            im = simd.scale_add(simd.load16(t.carry, 32 * j + 16), x[_PUSH + j], im)
        simd.store(x, 0, re)
        simd.store(x, 16, im)
        for d in range(DEPTH - 1):
            simd.store(x, _PAST + 2 * d, simd.load2(x, _SIZE - 2 * (d + 1)))
        now = contact
        step += STEPS
        interval += intervals
    if step > first:
        at = float(step)
        g = _law(
            now, share, n0 + n0_step * at, mu + mu_step * at, k + k_step * at, mu_ref, inverse_saturation
        )
        for j in range(_PUSH):
            memory[j] = x[j]
        simd.store(memory, _PUSH + 4, g)
        simd.store(ends, 0, now)
        for row in range(4):
            memory[_PUSH + _ORDER[row]] = ends[row]
    return step

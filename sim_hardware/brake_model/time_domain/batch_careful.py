"""Careful steps of lanes in which a slip would reverse: eight lanes at a time, set-valued friction.

The mathematics of `contact.careful_step`, written across brakings.
NOT its job: which lanes need it, the steps of lanes that slide (`batch_kernels`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from sim_hardware.brake_model.time_domain import simd as _simd
from sim_hardware.brake_model.time_domain.batch_tables import (
    CALM_ROW,
    CONTACT_ROW,
    FINE,
    FINE_END,
    FINE_HOLD,
    HISTORY_ROW,
    LANES,
    LATE,
    MODAL_SIZE,
    MODE_SIZE,
    MU_REF,
    OPERATION_ROWS,
    PRESENT_ROW,
    SATURATION_ROW,
    SHARE,
)
from sim_hardware.brake_model.time_domain.contact import SLIDES, Array

#: intrinsics get their first argument from the compiler: no type checker knows that
simd: Any = _simd

_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
#: as in `contact`: Gauss-Seidel sweeps over the pads, fixed-point steps for mu(v) within each
_SWEEPS = 3
_INNER = 2
# rows of the careful step's work space: history (6), contact (4), present (2), calm, operation (9),
# excitation (2), then twice two rows per mode: modes, effect of the held excitation
_W_HISTORY, _W_CONTACT, _W_PRESENT, _W_CALM, _W_OPERATION, _W_PUSH, _W_MODES = 0, 6, 10, 12, 13, 22, 24
WORK_ROWS = _W_MODES
WORK_ROWS_PER_MODE = 4


@njit(inline="always", **_OPTIONS)
def _variation(slip: Any, k: Any, inverse: Any, fades: bool) -> Any:
    """mu(v) - mu_mean (`contact.mu_variation`)."""
    if fades:
        x = simd.multiply(slip, inverse)
        return simd.over_root(simd.multiply(k, slip), simd.multiply_add(x, x, simd.splat8(1.0)))
    return simd.multiply(k, slip)


@njit(**_OPTIONS)
def careful_lanes(  # noqa: PLR0912 (plain copying)
    table: Array,
    modes: int,
    fine_steps: int,
    fades: bool,
    state: Array,
    operation: Array,
    excitation: Array,
    pushed: bool,
    work: Array,
    waiting: Any,
    n_waiting: int,
    at: float,
    interval: int,
    now: int,
    later: int,
    first_group: int,
) -> None:
    """Gather waiting lanes, up to eight at a time, take their careful steps, bring them back.

    With a table per lane only lanes of one group go together, each in its own place.
    """
    lanes = np.empty(LANES, np.int64)
    goes = np.empty(LANES, np.bool_)
    first = 0
    while first < n_waiting:
        group, count = waiting[first] // LANES, first
        for slot in range(LANES):
            lanes[slot], goes[slot] = waiting[first], False
        while count < n_waiting and count - first < LANES:
            lane = waiting[count]
            slot = count - first
            if table.ndim == 2:
                if lane // LANES != group:
                    break
                slot = lane % LANES
            lanes[slot], goes[slot] = lane, True
            count += 1
        first = count
        for slot in range(LANES):
            q, lane = lanes[slot] // LANES, lanes[slot] % LANES
            for row in range(6):
                work[_W_HISTORY + row, slot] = state[q, HISTORY_ROW + row, lane]
            for row in range(4):
                work[_W_CONTACT + row, slot] = state[q, CONTACT_ROW + row, lane]
            for row in range(2):
                work[_W_PRESENT + row, slot] = state[q, PRESENT_ROW + row, lane]
            work[_W_CALM, slot] = state[q, CALM_ROW, lane]
            for row in range(OPERATION_ROWS):
                work[_W_OPERATION + row, slot] = operation[q, row, lane]
            for row in range(2):
                work[_W_PUSH + row, slot] = 0.0
            for row in range(2 * modes):
                work[_W_MODES + row, slot] = state[q, now + row, lane]
            if pushed:
                for row in range(2):
                    work[_W_PUSH + row, slot] = excitation[interval, first_group + q, row, lane]
        _careful_step(table, group, modes, fine_steps, fades, work, at)
        for slot in range(LANES):
            if goes[slot]:
                q, lane = lanes[slot] // LANES, lanes[slot] % LANES
                for row in range(6):
                    state[q, HISTORY_ROW + row, lane] = work[_W_HISTORY + row, slot]
                for row in range(4):
                    state[q, CONTACT_ROW + row, lane] = work[_W_CONTACT + row, slot]
                for row in range(2):
                    state[q, PRESENT_ROW + row, lane] = work[_W_PRESENT + row, slot]
                state[q, CALM_ROW, lane] = work[_W_CALM, slot]
                for row in range(2 * modes):
                    state[q, later + row, lane] = work[_W_MODES + row, slot]


@njit(inline="always", **_OPTIONS)
def _least_slide(work: Array, v: Any) -> Any:
    """> 0 in the lanes whose pads slide forwards for certain."""
    sliding = simd.multiply(simd.splat8(1.0 - SLIDES), v)
    return simd.smaller(
        simd.subtract(sliding, simd.load8(work, _W_CONTACT * LANES)),
        simd.subtract(sliding, simd.load8(work, (_W_CONTACT + 2) * LANES)),
    )


@njit(**_OPTIONS)
def _careful_step(  # noqa: PLR0915 (one loop, in vector registers)
    table: Array, group: int, modes: int, fine_steps: int, fades: bool, work: Array, at: float
) -> None:
    """One main step of eight lanes in fine steps with set-valued friction (`contact.careful_and_count`).

    The modes are carried without the effect of the newest g:
    y[i+1] = E y[i] + drive g[i] + hold, z = y + end g.
    """
    per_mode = modes * MODAL_SIZE
    late, fine, hold = modes * LATE, modes * FINE, modes * FINE_HOLD
    single = per_mode
    modal, held = _W_MODES * LANES, (_W_MODES + 2 * modes) * LANES
    op = _W_OPERATION * LANES
    v_row, v_step = simd.load8(work, op + 4 * LANES), simd.load8(work, op + 5 * LANES)
    least = _least_slide(work, simd.scale_add(v_step, at, v_row))
    g0, g1 = simd.load8(work, _W_PRESENT * LANES), simd.load8(work, (_W_PRESENT + 1) * LANES)
    pa, pb = simd.load8(work, _W_PUSH * LANES), simd.load8(work, (_W_PUSH + 1) * LANES)
    for j in range(2 * modes):  # from the s form; the newest g without what a fine step adds at its end
        c = late + 8 * j
        value = simd.load8(work, modal + j * LANES)
        value = simd.multiply_add(simd.coefficient8(table, group, c), g0, value)
        value = simd.multiply_add(simd.coefficient8(table, group, c + 1), g1, value)
        for i in range(6):
            h = simd.load8(work, (_W_HISTORY + i) * LANES)
            value = simd.multiply_add(simd.coefficient8(table, group, c + 2 + i), h, value)
        simd.store(work, modal + j * LANES, value)
        c = hold + 2 * j
        value = simd.multiply(simd.coefficient8(table, group, c), pa)
        simd.store(
            work, held + j * LANES, simd.multiply_add(simd.coefficient8(table, group, c + 1), pb, value)
        )
    for i in range(4):
        h = (_W_HISTORY + 3 - i) * LANES
        simd.store(work, h + 2 * LANES, simd.load8(work, h))
    simd.store(work, _W_HISTORY * LANES, g0)
    simd.store(work, (_W_HISTORY + 1) * LANES, g1)
    for step in range(fine_steps):
        c0 = c1 = c2 = c3 = simd.zero8()
        for j in range(modes):
            z, c = 2 * j * LANES, fine + MODE_SIZE * j
            re, im = simd.load8(work, modal + z), simd.load8(work, modal + z + LANES)
            er, ei = simd.coefficient8(table, group, c), simd.coefficient8(table, group, c + 1)
            next_re = simd.multiply_add(er, re, simd.load8(work, held + z))
            next_im = simd.multiply_add(er, im, simd.load8(work, held + z + LANES))
            next_re = simd.negative_multiply_add(ei, im, next_re)
            next_im = simd.multiply_add(ei, re, next_im)
            next_re = simd.multiply_add(simd.coefficient8(table, group, c + 2), g0, next_re)
            next_im = simd.multiply_add(simd.coefficient8(table, group, c + 3), g0, next_im)
            next_re = simd.multiply_add(simd.coefficient8(table, group, c + 4), g1, next_re)
            next_im = simd.multiply_add(simd.coefficient8(table, group, c + 5), g1, next_im)
            simd.store(work, modal + z, next_re)
            simd.store(work, modal + z + LANES, next_im)
            c0 = simd.multiply_add(simd.coefficient8(table, group, c + 6), next_re, c0)
            c1 = simd.multiply_add(simd.coefficient8(table, group, c + 7), next_re, c1)
            c2 = simd.multiply_add(simd.coefficient8(table, group, c + 8), next_re, c2)
            c3 = simd.multiply_add(simd.coefficient8(table, group, c + 9), next_re, c3)
            c0 = simd.multiply_add(simd.coefficient8(table, group, c + 10), next_im, c0)
            c1 = simd.multiply_add(simd.coefficient8(table, group, c + 11), next_im, c1)
            c2 = simd.multiply_add(simd.coefficient8(table, group, c + 12), next_im, c2)
            c3 = simd.multiply_add(simd.coefficient8(table, group, c + 13), next_im, c3)
        # set-valued friction (`contact.solve_friction`)
        part = at + (step + 1.0) / fine_steps
        n0 = simd.scale_add(simd.load8(work, op + LANES), part, simd.load8(work, op))
        mu = simd.scale_add(simd.load8(work, op + 3 * LANES), part, simd.load8(work, op + 2 * LANES))
        v = simd.scale_add(v_step, part, v_row)
        k = simd.scale_add(simd.load8(work, op + 7 * LANES), part, simd.load8(work, op + 6 * LANES))
        inverse = simd.load8(work, op + SATURATION_ROW * LANES)
        mu_ref = simd.coefficient8(table, group, single + MU_REF)
        holding = simd.add(mu, _variation(v, k, inverse, fades))
        for _ in range(_SWEEPS):
            e = single + FINE_END
            slip = simd.multiply_add(simd.coefficient8(table, group, e + 1), g1, c0)
            compression = simd.multiply_add(simd.coefficient8(table, group, e + 2), g0, c1)
            compression = simd.multiply_add(simd.coefficient8(table, group, e + 3), g1, compression)
            g0 = _friction(
                g0, slip, compression, simd.coefficient8(table, group, e),
                simd.multiply(simd.coefficient8(table, group, single + SHARE), n0),
                mu, holding, v, k, inverse, mu_ref, fades,
            )  # fmt: skip
            slip = simd.multiply_add(simd.coefficient8(table, group, e + 4), g0, c2)
            compression = simd.multiply_add(simd.coefficient8(table, group, e + 6), g0, c3)
            compression = simd.multiply_add(simd.coefficient8(table, group, e + 7), g1, compression)
            g1 = _friction(
                g1, slip, compression, simd.coefficient8(table, group, e + 5),
                simd.multiply(simd.coefficient8(table, group, single + SHARE + 1), n0),
                mu, holding, v, k, inverse, mu_ref, fades,
            )  # fmt: skip
        e = single + FINE_END
        c0 = simd.multiply_add(simd.coefficient8(table, group, e), g0, c0)
        c0 = simd.multiply_add(simd.coefficient8(table, group, e + 1), g1, c0)
        c1 = simd.multiply_add(simd.coefficient8(table, group, e + 2), g0, c1)
        c1 = simd.multiply_add(simd.coefficient8(table, group, e + 3), g1, c1)
        c2 = simd.multiply_add(simd.coefficient8(table, group, e + 4), g0, c2)
        c2 = simd.multiply_add(simd.coefficient8(table, group, e + 5), g1, c2)
        c3 = simd.multiply_add(simd.coefficient8(table, group, e + 6), g0, c3)
        c3 = simd.multiply_add(simd.coefficient8(table, group, e + 7), g1, c3)
        simd.store(work, _W_CONTACT * LANES, c0)
        simd.store(work, (_W_CONTACT + 1) * LANES, c1)
        simd.store(work, (_W_CONTACT + 2) * LANES, c2)
        simd.store(work, (_W_CONTACT + 3) * LANES, c3)
    for j in range(2 * modes):  # back to the s form
        c = late + 8 * j
        value = simd.load8(work, modal + j * LANES)
        value = simd.negative_multiply_add(simd.coefficient8(table, group, c), g0, value)
        value = simd.negative_multiply_add(simd.coefficient8(table, group, c + 1), g1, value)
        for i in range(6):
            h = simd.load8(work, (_W_HISTORY + i) * LANES)
            value = simd.negative_multiply_add(simd.coefficient8(table, group, c + 2 + i), h, value)
        simd.store(work, modal + j * LANES, value)
    simd.store(work, _W_PRESENT * LANES, g0)
    simd.store(work, (_W_PRESENT + 1) * LANES, g1)
    least = simd.smaller(_least_slide(work, simd.scale_add(v_step, at + 1.0, v_row)), least)
    calm = simd.add(simd.load8(work, _W_CALM * LANES), simd.splat8(1.0))
    simd.store(work, _W_CALM * LANES, simd.where_positive(least, calm, simd.zero8()))


@njit(inline="always", **_OPTIONS)
def _friction(
    g: Any, slip: Any, compression: Any, mobility: Any, n0: Any, mu: Any, holding: Any, v: Any, k: Any,
    inverse: Any, mu_ref: Any, fades: bool,
) -> Any:  # fmt: skip
    """New g of a pad from the motion without it: v + mobility F(v) = drive with set-valued F."""
    zero = simd.zero8()
    lifted = simd.larger(compression, simd.subtract(zero, n0))
    normal = simd.add(n0, lifted)  # max(N0 + N~, 0)
    mean = simd.multiply_add(mu_ref, compression, simd.multiply(mu, n0))
    free = simd.subtract(v, slip)
    drive = simd.multiply_add(mobility, mean, free)
    size = simd.larger(drive, simd.subtract(zero, drive))
    speed = simd.negative_multiply_add(mobility, g, free)
    speed = simd.larger(speed, simd.subtract(zero, speed))
    pressed = simd.multiply(mobility, normal)
    for _ in range(_INNER):
        now = simd.add(mu, _variation(simd.subtract(v, speed), k, inverse, fades))
        speed = simd.larger(simd.negative_multiply_add(pressed, now, size), zero)
    variation = _variation(simd.subtract(v, speed), k, inverse, fades)
    now = simd.add(mu, variation)
    forwards = simd.negative_multiply_add(
        mu_ref, compression, simd.multiply_add(now, lifted, simd.multiply(variation, n0))
    )
    backwards = simd.subtract(simd.negative_multiply_add(now, normal, zero), mean)
    sliding = simd.where_positive(drive, forwards, backwards)
    held = simd.subtract(simd.divide(drive, mobility), mean)
    return simd.where_positive(simd.negative_multiply_add(pressed, holding, size), sliding, held)

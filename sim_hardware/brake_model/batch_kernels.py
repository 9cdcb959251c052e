"""Compiled recursion of many brakings at once: eight brakings as lanes of every vector, two friction groups.

The mathematics of `kernels` and `contact`, written across brakings: exponential Adams-Moulton steps in the s
form while the pads of a lane slide forwards; lanes in which a slip would reverse leave the common step, are
gathered eight at a time whatever group they stand in, take their careful step with set-valued friction, and
go back. Lanes that slide on are not held up by them otherwise. Every lane has its own working point; the
coefficients are shared by all lanes, a (size,) table, or each lane has its own, a (groups, 8 size) table: the
same source, compiled for each.
NOT its job: coefficients and memory (`batch_tables`), the object around it (`batch`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from sim_hardware.brake_model import simd as _simd
from sim_hardware.brake_model.batch_tables import (
    AHEAD,
    AHEAD_HOLD,
    CALM_ROW,
    CONTACT_ROW,
    FINE,
    FINE_END,
    FINE_HOLD,
    HISTORY_ROW,
    HOLD,
    LANES,
    LATE,
    MODAL_SIZE,
    MODE_SIZE,
    MU_REF,
    OPERATION_ROWS,
    OUTPUT,
    OUTPUT_SIZE,
    PRESENT_ROW,
    SATURATION_ROW,
    SHARE,
    SOLVED_ROW,
    STATE_ROWS,
)
from sim_hardware.brake_model.contact import CALM, SLIDES, Array

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
def _law(
    slip: Any, compression: Any, share: Any, n0: Any, mu: Any, k: Any, mu_ref: Any, inverse: Any, fades: bool
) -> Any:
    """g of a pad that slides forwards (`contact.forward_g`): exactly 0 at rest."""
    mean = simd.multiply(share, n0)
    lifted = simd.larger(compression, simd.subtract(simd.zero8(), mean))  # max(N~, -N0)
    normal = simd.multiply(simd.multiply(slip, k), simd.add(mean, lifted))
    linear = simd.negative_multiply_add(mu_ref, compression, simd.multiply(lifted, mu))
    if fades:
        x = simd.multiply(slip, inverse)
        return simd.add(simd.over_root(normal, simd.multiply_add(x, x, simd.splat8(1.0))), linear)
    return simd.add(normal, linear)


@njit(inline="always", **_OPTIONS)
def _variation(slip: Any, k: Any, inverse: Any, fades: bool) -> Any:
    """mu(v) - mu_mean (`contact.mu_variation`)."""
    if fades:
        x = simd.multiply(slip, inverse)
        return simd.over_root(simd.multiply(k, slip), simd.multiply_add(x, x, simd.splat8(1.0)))
    return simd.multiply(k, slip)


@njit(**_OPTIONS)
def advance_lanes(  # noqa: PLR0912, PLR0915 (one loop: what it holds in vector registers cannot be passed)
    table: Array,
    modes: int,
    columns: int,
    substeps: int,
    fine_steps: int,
    fades: bool,
    state: Array,
    operation: Array,
    excitation: Array,
    pushed: bool,
    work: Array,
    out: Array,
    first_group: int,
    begin: int,
) -> None:
    """Advance all lanes of a tile through a call.

    Parameters
    ----------
    table : coefficients, see `batch_tables`
    fades : whether the friction law of any lane saturates (1 / v_s > 0)
    state : (groups, STATE_ROWS + 4 modes, 8) memory of the tile, updated
    operation : (groups, OPERATION_ROWS, 8) pad force, mu, slip, k at the start of the call, each followed by
        its change per internal step; 1 / v_s
    excitation : (n_out, all groups, 2, 8) N, read where `pushed`
    work : (WORK_ROWS + WORK_ROWS_PER_MODE modes, 8) scratch
    out : (n_out, columns, all groups, 8) filled with the outputs at the start of each interval
    first_group : place of the tile among all groups
    begin : internal steps since the point that `operation` starts from
    """
    groups, n_out, total = state.shape[0], out.shape[0], out.shape[2]
    rows = STATE_ROWS + 4 * modes
    per_mode = modes * MODAL_SIZE  # where the coefficients without modes begin
    hold_at, single = modes * HOLD, per_mode
    waiting = np.empty(groups * LANES, np.int64)
    mixed = np.zeros(groups, np.bool_)
    for q in range(groups):
        for lane in range(LANES):
            if state[q, CALM_ROW, lane] < CALM or state[q, SOLVED_ROW, lane] > 0.0:
                mixed[q] = True
    steps = n_out * substeps
    for n in range(steps):
        at = float(begin + n)
        interval = n // substeps
        now, later = STATE_ROWS + (n & 1) * 2 * modes, STATE_ROWS + (1 - (n & 1)) * 2 * modes
        n_waiting: Any = np.int64(0)  # no literal: it would be compiled twice
        for q in range(groups):
            m = q * rows * LANES
            p = q * OPERATION_ROWS * LANES
            n0 = simd.scale_add(simd.load8(operation, p + LANES), at, simd.load8(operation, p))
            mu = simd.scale_add(
                simd.load8(operation, p + 3 * LANES), at, simd.load8(operation, p + 2 * LANES)
            )
            v = simd.scale_add(
                simd.load8(operation, p + 5 * LANES), at + 1.0, simd.load8(operation, p + 4 * LANES)
            )
            k = simd.scale_add(simd.load8(operation, p + 7 * LANES), at, simd.load8(operation, p + 6 * LANES))
            inverse = simd.load8(operation, p + SATURATION_ROW * LANES)
            mu_ref = simd.coefficient8(table, q, single + MU_REF)
            at_contact = m + CONTACT_ROW * LANES
            g0 = _law(
                simd.load8(state, at_contact), simd.load8(state, at_contact + LANES),
                simd.coefficient8(table, q, single + SHARE), n0, mu, k, mu_ref, inverse, fades,
            )  # fmt: skip
            g1 = _law(
                simd.load8(state, at_contact + 2 * LANES), simd.load8(state, at_contact + 3 * LANES),
                simd.coefficient8(table, q, single + SHARE + 1), n0, mu, k, mu_ref, inverse, fades,
            )  # fmt: skip
            at_present = m + PRESENT_ROW * LANES
            if mixed[q]:  # after a careful step g is its solution
                solved = simd.load8(state, m + SOLVED_ROW * LANES)
                g0 = simd.where_positive(solved, simd.load8(state, at_present), g0)
                g1 = simd.where_positive(solved, simd.load8(state, at_present + LANES), g1)
            at_history = m + HISTORY_ROW * LANES
            at_push = ((interval * total + first_group + q) * 2) * LANES
            at_modes = m + now * LANES
            if n % substeps == 0:
                for o in range(columns):
                    c = per_mode + OUTPUT + o * (2 * modes + OUTPUT_SIZE)
                    d = c + 2 * modes
                    ya = simd.multiply(simd.coefficient8(table, q, d), g0)
                    yb = simd.multiply(simd.coefficient8(table, q, d + 1), g1)
                    for i in range(3):
                        h = at_history + 2 * i * LANES
                        ya = simd.multiply_add(
                            simd.coefficient8(table, q, d + 2 + 2 * i), simd.load8(state, h), ya
                        )
                        yb = simd.multiply_add(
                            simd.coefficient8(table, q, d + 3 + 2 * i), simd.load8(state, h + LANES), yb
                        )
                    if pushed:
                        ya = simd.multiply_add(
                            simd.coefficient8(table, q, d + 8), simd.load8(excitation, at_push), ya
                        )
                        yb = simd.multiply_add(
                            simd.coefficient8(table, q, d + 9), simd.load8(excitation, at_push + LANES), yb
                        )
                    for j in range(modes):
                        z = at_modes + 2 * j * LANES
                        ya = simd.multiply_add(
                            simd.coefficient8(table, q, c + 2 * j), simd.load8(state, z), ya
                        )
                        yb = simd.multiply_add(
                            simd.coefficient8(table, q, c + 2 * j + 1), simd.load8(state, z + LANES), yb
                        )
                    simd.store(
                        out, ((interval * columns + o) * total + first_group + q) * LANES, simd.add(ya, yb)
                    )
            # contact motion one step ahead, from g and its history
            a = single + AHEAD
            c0 = simd.multiply(simd.coefficient8(table, q, a), g0)
            c1 = simd.multiply(simd.coefficient8(table, q, a + 1), g0)
            c2 = simd.multiply(simd.coefficient8(table, q, a + 2), g0)
            c3 = simd.multiply(simd.coefficient8(table, q, a + 3), g0)
            c0 = simd.multiply_add(simd.coefficient8(table, q, a + 4), g1, c0)
            c1 = simd.multiply_add(simd.coefficient8(table, q, a + 5), g1, c1)
            c2 = simd.multiply_add(simd.coefficient8(table, q, a + 6), g1, c2)
            c3 = simd.multiply_add(simd.coefficient8(table, q, a + 7), g1, c3)
            for i in range(6):
                h = simd.load8(state, at_history + i * LANES)
                a += 4
                c0 = simd.multiply_add(simd.coefficient8(table, q, a + 4), h, c0)
                c1 = simd.multiply_add(simd.coefficient8(table, q, a + 5), h, c1)
                c2 = simd.multiply_add(simd.coefficient8(table, q, a + 6), h, c2)
                c3 = simd.multiply_add(simd.coefficient8(table, q, a + 7), h, c3)
            if pushed:
                for i in range(2):
                    push = simd.load8(excitation, at_push + i * LANES)
                    a = single + AHEAD_HOLD + 4 * i
                    c0 = simd.multiply_add(simd.coefficient8(table, q, a), push, c0)
                    c1 = simd.multiply_add(simd.coefficient8(table, q, a + 1), push, c1)
                    c2 = simd.multiply_add(simd.coefficient8(table, q, a + 2), push, c2)
                    c3 = simd.multiply_add(simd.coefficient8(table, q, a + 3), push, c3)
            # ... and from the modes, which go on to the other half of their memory
            at_later = m + later * LANES
            for j in range(modes):
                z = 2 * j * LANES
                re, im = simd.load8(state, at_modes + z), simd.load8(state, at_modes + z + LANES)
                c = MODE_SIZE * j
                er, ei = simd.coefficient8(table, q, c), simd.coefficient8(table, q, c + 1)
                next_re = simd.negative_multiply_add(ei, im, simd.multiply(er, re))
                next_im = simd.multiply_add(ei, re, simd.multiply(er, im))
                next_re = simd.multiply_add(simd.coefficient8(table, q, c + 2), g0, next_re)
                next_im = simd.multiply_add(simd.coefficient8(table, q, c + 3), g0, next_im)
                next_re = simd.multiply_add(simd.coefficient8(table, q, c + 4), g1, next_re)
                next_im = simd.multiply_add(simd.coefficient8(table, q, c + 5), g1, next_im)
                simd.store(state, at_later + z, next_re)
                simd.store(state, at_later + z + LANES, next_im)
                c0 = simd.multiply_add(simd.coefficient8(table, q, c + 6), re, c0)
                c1 = simd.multiply_add(simd.coefficient8(table, q, c + 7), re, c1)
                c2 = simd.multiply_add(simd.coefficient8(table, q, c + 8), re, c2)
                c3 = simd.multiply_add(simd.coefficient8(table, q, c + 9), re, c3)
                c0 = simd.multiply_add(simd.coefficient8(table, q, c + 10), im, c0)
                c1 = simd.multiply_add(simd.coefficient8(table, q, c + 11), im, c1)
                c2 = simd.multiply_add(simd.coefficient8(table, q, c + 12), im, c2)
                c3 = simd.multiply_add(simd.coefficient8(table, q, c + 13), im, c3)
            if pushed:
                pa, pb = simd.load8(excitation, at_push), simd.load8(excitation, at_push + LANES)
                for j in range(modes):
                    c, z = hold_at + 4 * j, at_later + 2 * j * LANES
                    re = simd.multiply_add(simd.coefficient8(table, q, c), pa, simd.load8(state, z))
                    im = simd.multiply_add(
                        simd.coefficient8(table, q, c + 1), pa, simd.load8(state, z + LANES)
                    )
                    simd.store(state, z, simd.multiply_add(simd.coefficient8(table, q, c + 2), pb, re))
                    simd.store(
                        state, z + LANES, simd.multiply_add(simd.coefficient8(table, q, c + 3), pb, im)
                    )
            sliding = simd.multiply(simd.splat8(1.0 - SLIDES), v)
            margin = simd.smaller(simd.subtract(sliding, c0), simd.subtract(sliding, c2))
            if mixed[q]:
                margin = simd.smaller(
                    simd.subtract(simd.load8(state, m + CALM_ROW * LANES), simd.splat8(CALM - 0.5)), margin
                )
            slides = simd.positive_lanes(margin)
            if slides == (1 << LANES) - 1:
                for i in range(4):
                    h = at_history + (3 - i) * LANES
                    simd.store(state, h + 2 * LANES, simd.load8(state, h))
                simd.store(state, at_history, g0)
                simd.store(state, at_history + LANES, g1)
                simd.store(state, at_contact, c0)
                simd.store(state, at_contact + LANES, c1)
                simd.store(state, at_contact + 2 * LANES, c2)
                simd.store(state, at_contact + 3 * LANES, c3)
                if mixed[q]:
                    simd.store(state, m + SOLVED_ROW * LANES, simd.zero8())
                    mixed[q] = False
                continue
            mixed[q] = True
            simd.store(state, at_present, g0)
            simd.store(state, at_present + LANES, g1)
            for i in range(4):
                h = at_history + (3 - i) * LANES
                old = simd.load8(state, h + 2 * LANES)
                simd.store(state, h + 2 * LANES, simd.where_positive(margin, simd.load8(state, h), old))
            simd.store(state, at_history, simd.where_positive(margin, g0, simd.load8(state, at_history)))
            h = at_history + LANES
            simd.store(state, h, simd.where_positive(margin, g1, simd.load8(state, h)))
            h = at_contact
            simd.store(state, h, simd.where_positive(margin, c0, simd.load8(state, h)))
            h += LANES
            simd.store(state, h, simd.where_positive(margin, c1, simd.load8(state, h)))
            h += LANES
            simd.store(state, h, simd.where_positive(margin, c2, simd.load8(state, h)))
            h += LANES
            simd.store(state, h, simd.where_positive(margin, c3, simd.load8(state, h)))
            simd.store(
                state, m + SOLVED_ROW * LANES, simd.where_positive(margin, simd.zero8(), simd.splat8(1.0))
            )
            for lane in range(LANES):
                if not (slides >> lane) & 1:
                    waiting[n_waiting] = q * LANES + lane
                    n_waiting += 1
        if n_waiting:
            _careful_lanes(
                table, modes, fine_steps, fades, state, operation, excitation, pushed, work, waiting,
                n_waiting, at, interval, now, later, first_group,
            )  # fmt: skip
    if steps & 1:
        for q in range(groups):
            for row in range(2 * modes):
                for lane in range(LANES):
                    state[q, STATE_ROWS + row, lane] = state[q, STATE_ROWS + 2 * modes + row, lane]


@njit(**_OPTIONS)
def _careful_lanes(  # noqa: PLR0912 (plain copying)
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

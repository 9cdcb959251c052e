"""Compiled recursion of many brakings at once: eight brakings as lanes of every vector, two friction groups.

The mathematics of `kernels` and `contact`, written across brakings: exponential Adams-Moulton steps in the s
form while the pads of a lane slide forwards; lanes in which a slip would reverse leave the common step, are
gathered eight at a time whatever group they stand in, take their careful step with set-valued friction, and
go back. Lanes that slide on are not held up by them otherwise. Every lane has its own working point; the
coefficients are shared by all lanes, a (size,) table, or each lane has its own, a (groups, 8 size) table: the
same source, compiled for each.
NOT its job: the careful step itself (`batch_careful`), coefficients and memory (`batch_tables`), the object
around it (`batch`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from sim_hardware.brake_model.time_domain import simd as _simd
from sim_hardware.brake_model.time_domain.batch_careful import careful_lanes
from sim_hardware.brake_model.time_domain.batch_tables import (
    AHEAD,
    AHEAD_HOLD,
    CALM_ROW,
    CONTACT_ROW,
    HISTORY_ROW,
    HOLD,
    LANES,
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
from sim_hardware.brake_model.time_domain.contact import CALM, SLIDES, Array

#: intrinsics get their first argument from the compiler: no type checker knows that
simd: Any = _simd

_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}


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
            careful_lanes(
                table, modes, fine_steps, fades, state, operation, excitation, pushed, work, waiting,
                n_waiting, at, interval, now, later, first_group,
            )  # fmt: skip
    if steps & 1:
        for q in range(groups):
            for row in range(2 * modes):
                for lane in range(LANES):
                    state[q, STATE_ROWS + row, lane] = state[q, STATE_ROWS + 2 * modes + row, lane]

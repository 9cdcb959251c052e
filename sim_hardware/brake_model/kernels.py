"""Compiled recursion of the squealing brake: exact linear propagation, friction evaluated at the pads only.

Main step: exponential Adams-Moulton in the s form (`modal`). The contact motion of the next step is predicted
before the modes are updated, so the friction law's latency overlaps with the modal products. Where a pad's
slip would reverse, careful steps take over (`contact`).
Two entries with the same meaning: `advance_pair` for two friction groups and up to 16 modes (vector
registers), `advance_general` for anything else.
NOT its job: building the coefficients (`integrator`).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

from sim_hardware.brake_model import simd as _simd
from sim_hardware.brake_model.contact import (
    CALM,
    DEPTH,
    FRESH,
    FROM_LAW,
    OPTIONS,
    PAST,
    SLIDES,
    Array,
    Coefficients,
    Memory,
    careful_and_count,
    forward_g,
    mu_variation,
    outputs_now,
    point,
    present_g,
    shift,
)

#: intrinsics get their first argument from the compiler: no type checker knows that
simd: Any = _simd


@njit(**OPTIONS)
def advance_general(
    c: Coefficients, m: Memory, operation: Array, inverse_saturation: float, excitation: Array, out: Array
) -> None:
    """Advance by len(out) output intervals; see `advance_pair`."""
    groups, modes = c.drive_r.shape
    steps = len(out) * c.substeps
    ahead = np.zeros(2 * groups)
    start, end = np.zeros(4), np.zeros(4)
    still = np.zeros(groups)
    for n in range(steps):
        push = excitation[n // c.substeps] if len(excitation) else still
        point(operation, n / steps, start)
        point(operation, (n + 1) / steps, end)
        present_g(c, m, start, inverse_saturation)
        if n % c.substeps == 0:
            outputs_now(c, m, push, out[n // c.substeps])
        forwards = m.flags[0] >= CALM
        for row in range(2 * groups):
            value = 0.0
            for j in range(modes):
                value += c.ahead_r[row, j] * m.modes[0, j] + c.ahead_i[row, j] * m.modes[1, j]
            for q in range(groups):
                value += c.ahead_history[row, 0, q] * m.present[q] + c.ahead_hold[row, q] * push[q]
                for d in range(1, DEPTH):
                    value += c.ahead_history[row, d, q] * m.history[d - 1, q]
            ahead[row] = value
            if row % 2 == 0:
                forwards = forwards and end[2] - value > SLIDES * end[2]
        if not forwards:
            careful_and_count(c, m, push, start, end, inverse_saturation)
            continue
        for j in range(modes):
            re = c.rotation[0, j] * m.modes[0, j] - c.rotation[1, j] * m.modes[1, j]
            im = c.rotation[0, j] * m.modes[1, j] + c.rotation[1, j] * m.modes[0, j]
            for p in range(groups):
                re += c.drive_r[p, j] * m.present[p] + c.hold_r[p, j] * push[p]
                im += c.drive_i[p, j] * m.present[p] + c.hold_i[p, j] * push[p]
            m.modes[0, j], m.modes[1, j] = re, im
        shift(m)
        m.contact[:] = ahead
        m.flags[1] = FROM_LAW
    point(operation, 1.0, end)
    present_g(c, m, end, inverse_saturation)


@njit(**OPTIONS)
def _store_pair(
    m: Memory,
    modes: tuple[Any, Any],
    past_a: tuple[float, float, float],
    past_b: tuple[float, float, float],
    contact: tuple[float, float, float, float],
) -> None:
    """Write the registers of `advance_pair` to memory."""
    simd.store(m.modes, 0, modes[0])
    simd.store(m.modes, 1, modes[1])
    for d in range(PAST):
        m.history[d, 0], m.history[d, 1] = past_a[d], past_b[d]
    for row in range(4):
        m.contact[row] = contact[row]


@njit(inline="always", **OPTIONS)
def _product(rows_r: Array, rows_i: Array, row: int, zr: Any, zi: Any) -> float:
    """Product of a row with the modes in registers."""
    return simd.total(
        simd.multiply_add(simd.load(rows_r, row), zr, simd.multiply(simd.load(rows_i, row), zi))
    )


@njit(inline="always", **OPTIONS)
def _late(h: Array, row: int, a1: float, a2: float, a3: float, b1: float, b2: float, b3: float) -> float:
    """Effect of the past g on the contact motion one step ahead."""
    return (h[row, 1, 0] * a1 + h[row, 2, 0] * a2 + h[row, 3, 0] * a3) + (
        h[row, 1, 1] * b1 + h[row, 2, 1] * b2 + h[row, 3, 1] * b3
    )


@njit(**OPTIONS)
def advance_pair(  # noqa: PLR0915 (one loop: what is called in it would leave the registers)
    c: Coefficients, m: Memory, operation: Array, inverse_saturation: float, excitation: Array, out: Array
) -> None:
    """Advance by len(out) output intervals: two friction groups (a, b), 16 padded modes in vector registers.

    Parameters
    ----------
    c, m : coefficients; memory, updated
    operation : (4, 2) pad force (N), mu_mean, mean slip (m/s), slope k (s/m) at the two ends of the call;
        linear between
    inverse_saturation : 1 / v_s (s/m)
    excitation : (n_out, 2) N, held over each output interval; (0, 2) for none
    out : (n_out, O) filled with the outputs at the start of each interval
    """
    n_out, n_outputs = out.shape
    substeps = c.substeps
    steps = n_out * substeps
    start, end, push = np.zeros(4), np.zeros(4), np.zeros(2)
    n0, mu, v, k = operation[0, 0], operation[1, 0], operation[2, 0], operation[3, 0]
    n0_step = (operation[0, 1] - n0) / steps
    mu_step = (operation[1, 1] - mu) / steps
    v_step = (operation[2, 1] - v) / steps
    k_step = (operation[3, 1] - k) / steps
    share_a, share_b, mu_ref = c.share[0], c.share[1], c.mu_ref
    h, r = c.ahead_history, c.ahead_hold
    oh, od = c.output_history, c.output_direct
    if m.flags[1] == FRESH:  # the modes get the friction history they lack
        point(operation, 0.0, start)
        present_g(c, m, start, inverse_saturation)
    zr, zi = simd.load(m.modes, 0), simd.load(m.modes, 1)
    a1, a2, a3 = m.history[0, 0], m.history[1, 0], m.history[2, 0]
    b1, b2, b3 = m.history[0, 1], m.history[1, 1], m.history[2, 1]
    da, na, db, nb = m.contact[0], m.contact[1], m.contact[2], m.contact[3]
    calm = m.flags[0] >= CALM
    p0 = _product(c.ahead_r, c.ahead_i, 0, zr, zi) + _late(h, 0, a1, a2, a3, b1, b2, b3)
    p1 = _product(c.ahead_r, c.ahead_i, 1, zr, zi) + _late(h, 1, a1, a2, a3, b1, b2, b3)
    p2 = _product(c.ahead_r, c.ahead_i, 2, zr, zi) + _late(h, 2, a1, a2, a3, b1, b2, b3)
    p3 = _product(c.ahead_r, c.ahead_i, 3, zr, zi) + _late(h, 3, a1, a2, a3, b1, b2, b3)
    ea, eb = 0.0, 0.0
    for i in range(n_out):
        if len(excitation):
            ea, eb = excitation[i, 0], excitation[i, 1]
        xr = simd.scale_add(simd.load(c.hold_r, 0), ea, simd.scale(simd.load(c.hold_r, 1), eb))
        xi = simd.scale_add(simd.load(c.hold_i, 0), ea, simd.scale(simd.load(c.hold_i, 1), eb))
        x0, x1 = r[0, 0] * ea + r[0, 1] * eb, r[1, 0] * ea + r[1, 1] * eb
        x2, x3 = r[2, 0] * ea + r[2, 1] * eb, r[3, 0] * ea + r[3, 1] * eb
        for sub in range(substeps):
            if calm:
                n0_a, n0_b = share_a * n0, share_b * n0
                ga = forward_g(mu_variation(da, k, inverse_saturation), mu, mu_ref, n0_a, na)
                gb = forward_g(mu_variation(db, k, inverse_saturation), mu, mu_ref, n0_b, nb)
            else:
                point(operation, (i * substeps + sub) / steps, start)
                present_g(c, m, start, inverse_saturation)
                ga, gb = m.present[0], m.present[1]
            if sub == 0:
                for o in range(n_outputs):
                    late_a = oh[o, 0, 0] * ga + oh[o, 1, 0] * a1 + oh[o, 2, 0] * a2 + oh[o, 3, 0] * a3
                    late_b = oh[o, 0, 1] * gb + oh[o, 1, 1] * b1 + oh[o, 2, 1] * b2 + oh[o, 3, 1] * b3
                    now = od[o, 0] * (ga + ea) + od[o, 1] * (gb + eb)
                    out[i, o] = _product(c.output_r, c.output_i, o, zr, zi) + late_a + late_b + now
            # contact motion one step ahead: p holds all but the effect of the present g and excitation
            next_da = (p0 + x0) + (h[0, 0, 0] * ga + h[0, 0, 1] * gb)
            next_na = (p1 + x1) + (h[1, 0, 0] * ga + h[1, 0, 1] * gb)
            next_db = (p2 + x2) + (h[2, 0, 0] * ga + h[2, 0, 1] * gb)
            next_nb = (p3 + x3) + (h[3, 0, 0] * ga + h[3, 0, 1] * gb)
            n0, mu, v, k = n0 + n0_step, mu + mu_step, v + v_step, k + k_step
            if calm and v - max(next_da, next_db) > SLIDES * v:
                er, ei = simd.load(c.rotation, 0), simd.load(c.rotation, 1)
                new_r = simd.negative_multiply_add(ei, zi, simd.multiply_add(er, zr, xr))
                new_i = simd.multiply_add(er, zi, simd.multiply_add(ei, zr, xi))
                zr = simd.scale_add(
                    simd.load(c.drive_r, 0), ga, simd.scale_add(simd.load(c.drive_r, 1), gb, new_r)
                )
                zi = simd.scale_add(
                    simd.load(c.drive_i, 0), ga, simd.scale_add(simd.load(c.drive_i, 1), gb, new_i)
                )
                a3, a2, a1 = a2, a1, ga
                b3, b2, b1 = b2, b1, gb
                da, na, db, nb = next_da, next_na, next_db, next_nb
                p0 = _product(c.ahead_r, c.ahead_i, 0, zr, zi) + _late(h, 0, a1, a2, a3, b1, b2, b3)
                p1 = _product(c.ahead_r, c.ahead_i, 1, zr, zi) + _late(h, 1, a1, a2, a3, b1, b2, b3)
                p2 = _product(c.ahead_r, c.ahead_i, 2, zr, zi) + _late(h, 2, a1, a2, a3, b1, b2, b3)
                p3 = _product(c.ahead_r, c.ahead_i, 3, zr, zi) + _late(h, 3, a1, a2, a3, b1, b2, b3)
                m.flags[1] = FROM_LAW
            else:
                _store_pair(m, (zr, zi), (a1, a2, a3), (b1, b2, b3), (da, na, db, nb))
                m.present[0], m.present[1] = ga, gb
                push[0], push[1] = ea, eb
                point(operation, (i * substeps + sub) / steps, start)
                point(operation, (i * substeps + sub + 1) / steps, end)
                careful_and_count(c, m, push, start, end, inverse_saturation)
                calm = m.flags[0] >= CALM
                zr, zi = simd.load(m.modes, 0), simd.load(m.modes, 1)
                a1, a2, a3 = m.history[0, 0], m.history[1, 0], m.history[2, 0]
                b1, b2, b3 = m.history[0, 1], m.history[1, 1], m.history[2, 1]
                da, na, db, nb = m.contact[0], m.contact[1], m.contact[2], m.contact[3]
                p0 = _product(c.ahead_r, c.ahead_i, 0, zr, zi) + _late(h, 0, a1, a2, a3, b1, b2, b3)
                p1 = _product(c.ahead_r, c.ahead_i, 1, zr, zi) + _late(h, 1, a1, a2, a3, b1, b2, b3)
                p2 = _product(c.ahead_r, c.ahead_i, 2, zr, zi) + _late(h, 2, a1, a2, a3, b1, b2, b3)
                p3 = _product(c.ahead_r, c.ahead_i, 3, zr, zi) + _late(h, 3, a1, a2, a3, b1, b2, b3)
    _store_pair(m, (zr, zi), (a1, a2, a3), (b1, b2, b3), (da, na, db, nb))
    point(operation, 1.0, end)
    present_g(c, m, end, inverse_saturation)

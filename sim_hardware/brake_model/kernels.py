"""Compiled recursion of the squealing brake: exact linear propagation, friction evaluated at the pads only.

Main step: exponential Adams-Moulton in the s form (`modal`). The contact motion of the next step is predicted before
the modes are updated, so the friction law's latency overlaps with the modal products. Whenever a pad's slip would reverse,
and until enough smooth values exist again, careful steps are taken: fine first-order-hold steps in which the set-valued
friction law (sliding forwards, backwards, sticking) is solved in closed form per pad, with Gauss-Seidel sweeps between
the pads.
Two entries with the same meaning: `advance_pair` for two friction groups and up to 16 modes (vector registers),
`advance_general` for anything else.
NOT its job: building the coefficients (`integrator`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from sim_hardware.brake_model import simd

Array = NDArray[np.float64]

#: values of g kept from earlier steps, and with the present one
PAST = 3
DEPTH = PAST + 1
#: smooth steps in a row before the main step may follow careful ones: as many as its polynomial needs
CALM = DEPTH
#: slip, relative to its mean, above which a pad slides forwards for certain (sticking leaves rounding errors)
_SLIDES = 1e-6
#: Gauss-Seidel sweeps over the pads, and fixed-point steps for mu(v) within each
_SWEEPS = 3
_INNER = 2

_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "fastmath": True, "error_model": "numpy"}


class Coefficients(NamedTuple):
    """Everything constant during a run. G groups, P padded modes, O outputs; complex numbers as (real, imaginary).

    A product of an output row with the modes is sum(row_r * re + row_i * im): the sign is in the row.
    """

    substeps: int
    fine_steps: int
    mu_ref: float
    share: Array  # (G,)
    rotation: Array  # (2, P)
    drive_r: Array  # (G, P)
    drive_i: Array
    hold_r: Array  # (G, P) excitation held over the step
    hold_i: Array
    history_r: Array  # (DEPTH * G, P) from g[n], g[n-1], ...
    history_i: Array
    contact_r: Array  # (2 G, P) slip and compression variation from the modes (fine steps)
    contact_i: Array
    ahead_r: Array  # (2 G, P) the same one main step ahead
    ahead_i: Array
    ahead_history: Array  # (2 G, DEPTH, G) one step ahead from g[n], g[n-1], ...
    ahead_hold: Array  # (2 G, G)
    fine_rotation: Array  # (2, P)
    fine_start_r: Array  # (G, P)
    fine_start_i: Array
    fine_end_r: Array  # (G, P)
    fine_end_i: Array
    fine_end_contact: Array  # (2 G, G)
    output_r: Array  # (O, P)
    output_i: Array
    output_history: Array  # (O, DEPTH, G)
    output_direct: Array  # (O, G)


class Memory(NamedTuple):
    """Everything that changes.

    `flags`: number of smooth steps in a row; how `present` and `modes` are to be taken (next three constants).
    """

    modes: Array  # (2, P) in the s form
    history: Array  # (PAST, G) earlier g, latest first
    present: Array  # (G,) g now
    contact: Array  # (2 G,) slip and compression variation now
    flags: Array  # (2,)


#: g follows from the friction law at `contact`
FROM_LAW = 0.0
#: g is in `present`: the solution of a careful step, which may be sticking
SOLVED = 1.0
#: the modes were set from outside and do not contain any g yet
FRESH = 2.0


@njit(inline="always", **_OPTIONS)
def _mu_variation(slip_variation: float, k: float, inverse_saturation: float) -> float:
    """Friction law around the working point, sliding forwards: mu(v) - mu_mean for v - v_mean = -slip_variation."""
    x = slip_variation * inverse_saturation
    return k * slip_variation / np.sqrt(1.0 + x * x)


@njit(inline="always", **_OPTIONS)
def _forward_g(mu_variation: float, mu_mean: float, mu_ref: float, n0: float, compression: float) -> float:
    """mu max(N0 + N~, 0) - mu_mean N0 - mu_ref N~ without the difference of large numbers: exactly 0 at rest."""
    return mu_variation * n0 + (mu_mean + mu_variation) * max(compression, -n0) - mu_ref * compression


@njit(**_OPTIONS)
def _deviation(
    slip_variation: float,
    compression: float,
    n0: float,
    mu_mean: float,
    v_mean: float,
    k: float,
    inverse_saturation: float,
    mu_ref: float,
) -> float:
    """Deviation g of the friction force from its mean and from the linear part mu_ref N~, any slip direction."""
    v = v_mean - slip_variation
    if v > 0.0:
        return _forward_g(_mu_variation(slip_variation, k, inverse_saturation), mu_mean, mu_ref, n0, compression)
    mu = mu_mean + _mu_variation(v_mean + v, k, inverse_saturation) if v < 0.0 else 0.0
    return -mu * max(n0 + compression, 0.0) - mu_mean * n0 - mu_ref * compression


@njit(**_OPTIONS)
def _add_history(c: Coefficients, m: Memory, sign: float, zr: Array, zi: Array) -> None:
    """Add or take away the friction history: between the s form and the modes themselves."""
    groups, modes = c.drive_r.shape
    for d in range(DEPTH):
        for p in range(groups):
            g = sign * (m.present[p] if d == 0 else m.history[d - 1, p])
            for j in range(modes):
                zr[j] += c.history_r[d * groups + p, j] * g
                zi[j] += c.history_i[d * groups + p, j] * g


@njit(**_OPTIONS)
def _shift(m: Memory) -> None:
    """Make the present g the latest of the past."""
    for d in range(PAST - 1, 0, -1):
        m.history[d] = m.history[d - 1]
    m.history[0] = m.present


@njit(**_OPTIONS)
def _careful_step(
    c: Coefficients, m: Memory, excitation: Array, start: Array, end: Array, inverse_saturation: float
) -> None:
    """Advance by one main step in fine steps with set-valued friction.

    `start`, `end`: (4,) pad force, mu_mean, mean slip, k at both ends. The present g must be in `m.present`; afterwards it
    and `m.contact` are those of the new time.
    """
    groups, modes = c.drive_r.shape
    zr, zi = m.modes[0].copy(), m.modes[1].copy()
    g, contact = m.present, m.contact
    _add_history(c, m, 1.0, zr, zi)
    _shift(m)
    for fine in range(c.fine_steps):
        part = (fine + 1.0) / c.fine_steps
        n0 = start[0] + part * (end[0] - start[0])
        mu_mean = start[1] + part * (end[1] - start[1])
        v_mean = start[2] + part * (end[2] - start[2])
        k = start[3] + part * (end[3] - start[3])
        for j in range(modes):
            re = c.fine_rotation[0, j] * zr[j] - c.fine_rotation[1, j] * zi[j]
            im = c.fine_rotation[0, j] * zi[j] + c.fine_rotation[1, j] * zr[j]
            for p in range(groups):
                first = g[p] + excitation[p]
                re += c.fine_start_r[p, j] * first + c.fine_end_r[p, j] * excitation[p]
                im += c.fine_start_i[p, j] * first + c.fine_end_i[p, j] * excitation[p]
            zr[j], zi[j] = re, im
        for row in range(2 * groups):
            contact[row] = 0.0
            for j in range(modes):
                contact[row] += c.contact_r[row, j] * zr[j] + c.contact_i[row, j] * zi[j]
        _solve_friction(c, g, contact, n0, mu_mean, v_mean, k, inverse_saturation)
        for p in range(groups):
            for j in range(modes):
                zr[j] += c.fine_end_r[p, j] * g[p]
                zi[j] += c.fine_end_i[p, j] * g[p]
    _add_history(c, m, -1.0, zr, zi)
    m.modes[0] = zr
    m.modes[1] = zi


@njit(**_OPTIONS)
def _solve_friction(
    c: Coefficients,
    g: Array,
    contact: Array,
    n0_pad: float,
    mu_mean: float,
    v_mean: float,
    k: float,
    inverse_saturation: float,
) -> None:
    """Find g at the end of a fine step so that every pad obeys the set-valued law.

    In: `contact` without the effect of the new g, `g` as first guess. Out: both at the end of the step.
    """
    groups = len(g)
    holding = mu_mean + _mu_variation(v_mean, k, inverse_saturation)
    for _ in range(_SWEEPS):
        for p in range(groups):
            n0 = c.share[p] * n0_pad
            slip, compression = contact[2 * p], contact[2 * p + 1]
            for q in range(groups):
                compression += c.fine_end_contact[2 * p + 1, q] * g[q]
                if q != p:
                    slip += c.fine_end_contact[2 * p, q] * g[q]
            normal = max(n0 + compression, 0.0)
            mobility = c.fine_end_contact[2 * p, p]
            mean = mu_mean * n0 + c.mu_ref * compression
            # v + mobility F(v) = drive, F set-valued: |F| <= holding * normal at v = 0
            drive = v_mean - slip + mobility * mean
            if abs(drive) <= mobility * holding * normal:
                g[p] = drive / mobility - mean
            else:
                speed = abs(v_mean - slip - mobility * g[p])
                for _inner in range(_INNER):
                    mu = mu_mean + _mu_variation(v_mean - speed, k, inverse_saturation)
                    speed = max(abs(drive) - mobility * mu * normal, 0.0)
                variation = _mu_variation(v_mean - speed, k, inverse_saturation)
                if drive > 0.0:
                    g[p] = _forward_g(variation, mu_mean, c.mu_ref, n0, compression)
                else:
                    g[p] = -(mu_mean + variation) * normal - mean
    for row in range(2 * groups):
        for q in range(groups):
            contact[row] += c.fine_end_contact[row, q] * g[q]


@njit(**_OPTIONS)
def _outputs_now(c: Coefficients, m: Memory, excitation: Array, out: Array) -> None:
    """All outputs at the present time, into `out` (O,)."""
    groups, modes = c.drive_r.shape
    for o in range(len(out)):
        value = 0.0
        for j in range(modes):
            value += c.output_r[o, j] * m.modes[0, j] + c.output_i[o, j] * m.modes[1, j]
        for q in range(groups):
            value += c.output_direct[o, q] * (m.present[q] + excitation[q]) + c.output_history[o, 0, q] * m.present[q]
            for d in range(1, DEPTH):
                value += c.output_history[o, d, q] * m.history[d - 1, q]
        out[o] = value


@njit(**_OPTIONS)
def _point(operation: Array, part: float, into: Array) -> None:
    """Operating values (4,) at a part of the call; `operation`: (4, 2) at its ends."""
    for i in range(4):
        into[i] = operation[i, 0] + part * (operation[i, 1] - operation[i, 0])


@njit(**_OPTIONS)
def _present_g(c: Coefficients, m: Memory, op: Array, inverse_saturation: float) -> None:
    """Bring g into `m.present`: by the friction law, unless the last careful step left its solution there."""
    if m.flags[1] == SOLVED:
        return
    for p in range(len(m.present)):
        m.present[p] = _deviation(
            m.contact[2 * p],
            m.contact[2 * p + 1],
            c.share[p] * op[0],
            op[1],
            op[2],
            op[3],
            inverse_saturation,
            c.mu_ref,
        )
    if m.flags[1] == FRESH:
        _add_history(c, m, -1.0, m.modes[0], m.modes[1])
        m.flags[1] = SOLVED


@njit(**_OPTIONS)
def _careful_and_count(
    c: Coefficients, m: Memory, excitation: Array, start: Array, end: Array, inverse_saturation: float
) -> None:
    """Take a careful step and count how many steps in a row slid forwards at both ends."""
    forwards = True
    for p in range(len(m.present)):
        forwards = forwards and start[2] - m.contact[2 * p] > _SLIDES * start[2]
    _careful_step(c, m, excitation, start, end, inverse_saturation)
    for p in range(len(m.present)):
        forwards = forwards and end[2] - m.contact[2 * p] > _SLIDES * end[2]
    m.flags[0] = m.flags[0] + 1.0 if forwards else 0.0
    m.flags[1] = SOLVED


@njit(**_OPTIONS)
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
        _point(operation, n / steps, start)
        _point(operation, (n + 1) / steps, end)
        _present_g(c, m, start, inverse_saturation)
        if n % c.substeps == 0:
            _outputs_now(c, m, push, out[n // c.substeps])
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
                forwards = forwards and end[2] - value > _SLIDES * end[2]
        if not forwards:
            _careful_and_count(c, m, push, start, end, inverse_saturation)
            continue
        for j in range(modes):
            re = c.rotation[0, j] * m.modes[0, j] - c.rotation[1, j] * m.modes[1, j]
            im = c.rotation[0, j] * m.modes[1, j] + c.rotation[1, j] * m.modes[0, j]
            for p in range(groups):
                re += c.drive_r[p, j] * m.present[p] + c.hold_r[p, j] * push[p]
                im += c.drive_i[p, j] * m.present[p] + c.hold_i[p, j] * push[p]
            m.modes[0, j], m.modes[1, j] = re, im
        _shift(m)
        m.contact[:] = ahead
        m.flags[1] = FROM_LAW
    _point(operation, 1.0, end)
    _present_g(c, m, end, inverse_saturation)


@njit(**_OPTIONS)
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


@njit(inline="always", **_OPTIONS)
def _product(rows_r: Array, rows_i: Array, row: int, zr: Any, zi: Any) -> float:
    """Product of a row with the modes in registers."""
    return simd.total(simd.multiply_add(simd.load(rows_r, row), zr, simd.multiply(simd.load(rows_i, row), zi)))


@njit(**_OPTIONS)
def advance_pair(
    c: Coefficients, m: Memory, operation: Array, inverse_saturation: float, excitation: Array, out: Array
) -> None:
    """Advance by len(out) output intervals: two friction groups (a, b), 16 padded modes in vector registers.

    Parameters
    ----------
    c, m : coefficients; memory, updated
    operation : (4, 2) pad force (N), mu_mean, mean slip (m/s), slope k (s/m) at the two ends of the call; linear between
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
    zr, zi = simd.load(m.modes, 0), simd.load(m.modes, 1)
    a1, a2, a3 = m.history[0, 0], m.history[1, 0], m.history[2, 0]
    b1, b2, b3 = m.history[0, 1], m.history[1, 1], m.history[2, 1]
    da, na, db, nb = m.contact[0], m.contact[1], m.contact[2], m.contact[3]
    calm = m.flags[0] >= CALM
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
                ga = _forward_g(_mu_variation(da, k, inverse_saturation), mu, mu_ref, n0_a, na)
                gb = _forward_g(_mu_variation(db, k, inverse_saturation), mu, mu_ref, n0_b, nb)
            else:
                _point(operation, (i * substeps + sub) / steps, start)
                _present_g(c, m, start, inverse_saturation)
                ga, gb = m.present[0], m.present[1]
                zr, zi = simd.load(m.modes, 0), simd.load(m.modes, 1)
            if sub == 0:
                for o in range(n_outputs):
                    late_a = oh[o, 0, 0] * ga + oh[o, 1, 0] * a1 + oh[o, 2, 0] * a2 + oh[o, 3, 0] * a3
                    late_b = oh[o, 0, 1] * gb + oh[o, 1, 1] * b1 + oh[o, 2, 1] * b2 + oh[o, 3, 1] * b3
                    now = od[o, 0] * (ga + ea) + od[o, 1] * (gb + eb)
                    out[i, o] = _product(c.output_r, c.output_i, o, zr, zi) + late_a + late_b + now
            # contact motion one step ahead; only the last term of each waits for the friction law
            p0 = _product(c.ahead_r, c.ahead_i, 0, zr, zi) + x0
            p1 = _product(c.ahead_r, c.ahead_i, 1, zr, zi) + x1
            p2 = _product(c.ahead_r, c.ahead_i, 2, zr, zi) + x2
            p3 = _product(c.ahead_r, c.ahead_i, 3, zr, zi) + x3
            p0 += (h[0, 1, 0] * a1 + h[0, 2, 0] * a2 + h[0, 3, 0] * a3) + (h[0, 1, 1] * b1 + h[0, 2, 1] * b2 + h[0, 3, 1] * b3)
            p1 += (h[1, 1, 0] * a1 + h[1, 2, 0] * a2 + h[1, 3, 0] * a3) + (h[1, 1, 1] * b1 + h[1, 2, 1] * b2 + h[1, 3, 1] * b3)
            p2 += (h[2, 1, 0] * a1 + h[2, 2, 0] * a2 + h[2, 3, 0] * a3) + (h[2, 1, 1] * b1 + h[2, 2, 1] * b2 + h[2, 3, 1] * b3)
            p3 += (h[3, 1, 0] * a1 + h[3, 2, 0] * a2 + h[3, 3, 0] * a3) + (h[3, 1, 1] * b1 + h[3, 2, 1] * b2 + h[3, 3, 1] * b3)
            next_da = p0 + (h[0, 0, 0] * ga + h[0, 0, 1] * gb)
            next_na = p1 + (h[1, 0, 0] * ga + h[1, 0, 1] * gb)
            next_db = p2 + (h[2, 0, 0] * ga + h[2, 0, 1] * gb)
            next_nb = p3 + (h[3, 0, 0] * ga + h[3, 0, 1] * gb)
            n0, mu, v, k = n0 + n0_step, mu + mu_step, v + v_step, k + k_step
            if calm and v - max(next_da, next_db) > _SLIDES * v:
                er, ei = simd.load(c.rotation, 0), simd.load(c.rotation, 1)
                new_r = simd.negative_multiply_add(ei, zi, simd.multiply_add(er, zr, xr))
                new_i = simd.multiply_add(er, zi, simd.multiply_add(ei, zr, xi))
                zr = simd.scale_add(simd.load(c.drive_r, 0), ga, simd.scale_add(simd.load(c.drive_r, 1), gb, new_r))
                zi = simd.scale_add(simd.load(c.drive_i, 0), ga, simd.scale_add(simd.load(c.drive_i, 1), gb, new_i))
                a3, a2, a1 = a2, a1, ga
                b3, b2, b1 = b2, b1, gb
                da, na, db, nb = next_da, next_na, next_db, next_nb
                m.flags[1] = FROM_LAW
            else:
                _store_pair(m, (zr, zi), (a1, a2, a3), (b1, b2, b3), (da, na, db, nb))
                m.present[0], m.present[1] = ga, gb
                push[0], push[1] = ea, eb
                _point(operation, (i * substeps + sub) / steps, start)
                _point(operation, (i * substeps + sub + 1) / steps, end)
                _careful_and_count(c, m, push, start, end, inverse_saturation)
                calm = m.flags[0] >= CALM
                zr, zi = simd.load(m.modes, 0), simd.load(m.modes, 1)
                a1, a2, a3 = m.history[0, 0], m.history[1, 0], m.history[2, 0]
                b1, b2, b3 = m.history[0, 1], m.history[1, 1], m.history[2, 1]
                da, na, db, nb = m.contact[0], m.contact[1], m.contact[2], m.contact[3]
    _store_pair(m, (zr, zi), (a1, a2, a3), (b1, b2, b3), (da, na, db, nb))
    _point(operation, 1.0, end)
    _present_g(c, m, end, inverse_saturation)

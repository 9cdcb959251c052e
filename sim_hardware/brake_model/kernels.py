"""Compiled recursion of the squealing brake: exact linear propagation, friction evaluated at the pads only.

Main step: exponential Adams-Bashforth in the s form (`modal`). The slip variation of the next step is known before the
modes are updated, so the friction law's latency overlaps with the modal products. Whenever a pad's slip would reverse,
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

#: order of the main step
ORDER = 4
#: values of g kept from earlier steps
DEPTH = ORDER - 1
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
    history_r: Array  # (DEPTH * G, P)
    history_i: Array
    contact_r: Array  # (2 G, P) slip and compression variation from the modes
    contact_i: Array
    ahead_r: Array  # (2 G, P) the same one step ahead
    ahead_i: Array
    contact_history: Array  # (2 G, DEPTH, G)
    ahead_history: Array  # (2 G, DEPTH, G) one step ahead from g[n], g[n-1], g[n-2]
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
    """Everything that changes: modes in the s form, earlier and present g, [calm steps, present g is known]."""

    modes: Array  # (2, P)
    history: Array  # (DEPTH, G)
    present: Array  # (G,)
    flags: Array  # (2,)


@njit(inline="always", **_OPTIONS)
def _mu(slip_variation: float, mu_mean: float, k: float, inverse_saturation: float) -> float:
    """Friction law around the working point, sliding forwards: v - v_mean = -slip_variation."""
    x = slip_variation * inverse_saturation
    return mu_mean + k * slip_variation / np.sqrt(1.0 + x * x)


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
    sign = 1.0 if v > 0.0 else (-1.0 if v < 0.0 else 0.0)
    mu = _mu(v_mean - abs(v), mu_mean, k, inverse_saturation)
    return sign * mu * max(n0 + compression, 0.0) - mu_mean * n0 - mu_ref * compression


@njit(**_OPTIONS)
def _careful_step(
    c: Coefficients, m: Memory, excitation: Array, start: Array, end: Array, inverse_saturation: float, contact: Array
) -> None:
    """Advance by one main step in fine steps with set-valued friction.

    `start`, `end`: (4,) pad force, mu_mean, mean slip, k at both ends. `contact`: (2 G,) slip and compression variation,
    updated. The present g must be in `m.present`; afterwards it is that of the new time.
    """
    groups, modes = c.drive_r.shape
    zr, zi = m.modes[0].copy(), m.modes[1].copy()
    for d in range(DEPTH):
        for p in range(groups):
            for j in range(modes):
                zr[j] += c.history_r[d * groups + p, j] * m.history[d, p]
                zi[j] += c.history_i[d * groups + p, j] * m.history[d, p]
    for d in range(DEPTH - 1, 0, -1):
        m.history[d] = m.history[d - 1]
    m.history[0] = m.present
    g = m.present
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
    for d in range(DEPTH):
        for p in range(groups):
            for j in range(modes):
                zr[j] -= c.history_r[d * groups + p, j] * m.history[d, p]
                zi[j] -= c.history_i[d * groups + p, j] * m.history[d, p]
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
    holding = _mu(v_mean, mu_mean, k, inverse_saturation)
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
                    mu = _mu(v_mean - speed, mu_mean, k, inverse_saturation)
                    speed = max(abs(drive) - mobility * mu * normal, 0.0)
                mu = _mu(v_mean - speed, mu_mean, k, inverse_saturation)
                g[p] = (mu if drive > 0.0 else -mu) * normal - mean
    for row in range(2 * groups):
        for q in range(groups):
            contact[row] += c.fine_end_contact[row, q] * g[q]


@njit(**_OPTIONS)
def _contact_now(c: Coefficients, m: Memory, contact: Array) -> None:
    """Slip and compression variation of all groups at the present time, into `contact`."""
    groups, modes = c.drive_r.shape
    for row in range(2 * groups):
        value = 0.0
        for j in range(modes):
            value += c.contact_r[row, j] * m.modes[0, j] + c.contact_i[row, j] * m.modes[1, j]
        for d in range(DEPTH):
            for q in range(groups):
                value += c.contact_history[row, d, q] * m.history[d, q]
        contact[row] = value


@njit(**_OPTIONS)
def _outputs_now(c: Coefficients, m: Memory, excitation: Array, out: Array) -> None:
    """All outputs at the present time, into `out` (O,)."""
    groups, modes = c.drive_r.shape
    for o in range(len(out)):
        value = 0.0
        for j in range(modes):
            value += c.output_r[o, j] * m.modes[0, j] + c.output_i[o, j] * m.modes[1, j]
        for q in range(groups):
            value += c.output_direct[o, q] * (m.present[q] + excitation[q])
            for d in range(DEPTH):
                value += c.output_history[o, d, q] * m.history[d, q]
        out[o] = value


@njit(**_OPTIONS)
def _point(operation: Array, part: float, into: Array) -> None:
    """Operating values (4,) at a part of the call; `operation`: (4, 2) at its ends."""
    for i in range(4):
        into[i] = operation[i, 0] + part * (operation[i, 1] - operation[i, 0])


@njit(**_OPTIONS)
def _present_g(c: Coefficients, m: Memory, contact: Array, op: Array, inverse_saturation: float) -> None:
    """Evaluate the friction law at the present time unless the last careful step left its solution."""
    if m.flags[1] == 0.0:
        for p in range(len(m.present)):
            m.present[p] = _deviation(
                contact[2 * p], contact[2 * p + 1], c.share[p] * op[0], op[1], op[2], op[3], inverse_saturation, c.mu_ref
            )


@njit(**_OPTIONS)
def _careful_and_count(
    c: Coefficients, m: Memory, excitation: Array, start: Array, end: Array, inverse_saturation: float, contact: Array
) -> None:
    """Take a careful step and count how many steps in a row slid forwards throughout."""
    forwards = True
    for p in range(len(m.present)):
        forwards = forwards and start[2] - contact[2 * p] > 0.0
    _careful_step(c, m, excitation, start, end, inverse_saturation, contact)
    for p in range(len(m.present)):
        forwards = forwards and end[2] - contact[2 * p] > 0.0
    m.flags[0] = m.flags[0] + 1.0 if forwards else 0.0
    m.flags[1] = 1.0


@njit(**_OPTIONS)
def advance_general(
    c: Coefficients, m: Memory, operation: Array, inverse_saturation: float, excitation: Array, out: Array
) -> None:
    """Advance by len(out) output intervals; see `advance_pair`."""
    groups, modes = c.drive_r.shape
    steps = len(out) * c.substeps
    contact, ahead = np.zeros(2 * groups), np.zeros(2 * groups)
    start, end = np.zeros(4), np.zeros(4)
    still = np.zeros(groups)
    _contact_now(c, m, contact)
    for n in range(steps):
        push = excitation[n // c.substeps] if len(excitation) else still
        _point(operation, n / steps, start)
        _point(operation, (n + 1) / steps, end)
        _present_g(c, m, contact, start, inverse_saturation)
        if n % c.substeps == 0:
            _outputs_now(c, m, push, out[n // c.substeps])
        forwards = m.flags[0] >= ORDER
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
                forwards = forwards and end[2] - value > 0.0
        if not forwards:
            _careful_and_count(c, m, push, start, end, inverse_saturation, contact)
            continue
        for j in range(modes):
            re = c.rotation[0, j] * m.modes[0, j] - c.rotation[1, j] * m.modes[1, j]
            im = c.rotation[0, j] * m.modes[1, j] + c.rotation[1, j] * m.modes[0, j]
            for p in range(groups):
                re += c.drive_r[p, j] * m.present[p] + c.hold_r[p, j] * push[p]
                im += c.drive_i[p, j] * m.present[p] + c.hold_i[p, j] * push[p]
            m.modes[0, j], m.modes[1, j] = re, im
        for d in range(DEPTH - 1, 0, -1):
            m.history[d] = m.history[d - 1]
        m.history[0] = m.present
        contact[:] = ahead
        m.flags[1] = 0.0


@njit(**_OPTIONS)
def _store_pair(m: Memory, zr: Any, zi: Any, a1: float, a2: float, a3: float, b1: float, b2: float, b3: float) -> None:
    """Write the registers of `advance_pair` back to memory."""
    simd.store(m.modes, 0, zr)
    simd.store(m.modes, 1, zi)
    m.history[0, 0], m.history[1, 0], m.history[2, 0] = a1, a2, a3
    m.history[0, 1], m.history[1, 1], m.history[2, 1] = b1, b2, b3


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
    steps = n_out * c.substeps
    contact = np.zeros(4)
    start, end = np.zeros(4), np.zeros(4)
    push = np.zeros(2)
    _contact_now(c, m, contact)
    zr, zi = simd.load(m.modes, 0), simd.load(m.modes, 1)
    a1, a2, a3 = m.history[0, 0], m.history[1, 0], m.history[2, 0]
    b1, b2, b3 = m.history[0, 1], m.history[1, 1], m.history[2, 1]
    da, na, db, nb = contact[0], contact[1], contact[2], contact[3]
    h, r = c.ahead_history, c.ahead_hold
    n0, mu, v, k = operation[0, 0], operation[1, 0], operation[2, 0], operation[3, 0]
    n0_step = (operation[0, 1] - n0) / steps
    mu_step = (operation[1, 1] - mu) / steps
    v_step = (operation[2, 1] - v) / steps
    k_step = (operation[3, 1] - k) / steps
    share_a, share_b, mu_ref = c.share[0], c.share[1], c.mu_ref
    calm = m.flags[0] >= ORDER
    ea, eb = 0.0, 0.0
    for i in range(n_out):
        if len(excitation):
            ea, eb = excitation[i, 0], excitation[i, 1]
        xr = simd.scale_add(simd.load(c.hold_r, 0), ea, simd.scale(simd.load(c.hold_r, 1), eb))
        xi = simd.scale_add(simd.load(c.hold_i, 0), ea, simd.scale(simd.load(c.hold_i, 1), eb))
        x0, x1 = r[0, 0] * ea + r[0, 1] * eb, r[1, 0] * ea + r[1, 1] * eb
        x2, x3 = r[2, 0] * ea + r[2, 1] * eb, r[3, 0] * ea + r[3, 1] * eb
        for sub in range(c.substeps):
            if calm:
                na0, nb0 = share_a * n0, share_b * n0
                ga = _mu(da, mu, k, inverse_saturation) * max(na0 + na, 0.0) - mu * na0 - mu_ref * na
                gb = _mu(db, mu, k, inverse_saturation) * max(nb0 + nb, 0.0) - mu * nb0 - mu_ref * nb
            else:
                contact[0], contact[1], contact[2], contact[3] = da, na, db, nb
                _point(operation, (i * c.substeps + sub) / steps, start)
                _present_g(c, m, contact, start, inverse_saturation)
                ga, gb = m.present[0], m.present[1]
            if sub == 0:
                for o in range(n_outputs):
                    oh, od = c.output_history[o], c.output_direct[o]
                    row = simd.multiply_add(
                        simd.load(c.output_r, o), zr, simd.multiply(simd.load(c.output_i, o), zi)
                    )
                    late = oh[0, 0] * a1 + oh[1, 0] * a2 + oh[2, 0] * a3 + oh[0, 1] * b1 + oh[1, 1] * b2 + oh[2, 1] * b3
                    out[i, o] = simd.total(row) + late + od[0] * (ga + ea) + od[1] * (gb + eb)
            # slip and compression one step ahead; only the last line of each waits for the friction law
            p0 = simd.total(simd.multiply_add(simd.load(c.ahead_r, 0), zr, simd.multiply(simd.load(c.ahead_i, 0), zi)))
            p1 = simd.total(simd.multiply_add(simd.load(c.ahead_r, 1), zr, simd.multiply(simd.load(c.ahead_i, 1), zi)))
            p2 = simd.total(simd.multiply_add(simd.load(c.ahead_r, 2), zr, simd.multiply(simd.load(c.ahead_i, 2), zi)))
            p3 = simd.total(simd.multiply_add(simd.load(c.ahead_r, 3), zr, simd.multiply(simd.load(c.ahead_i, 3), zi)))
            q0 = h[0, 1, 0] * a1 + h[0, 2, 0] * a2 + h[0, 1, 1] * b1 + h[0, 2, 1] * b2
            q1 = h[1, 1, 0] * a1 + h[1, 2, 0] * a2 + h[1, 1, 1] * b1 + h[1, 2, 1] * b2
            q2 = h[2, 1, 0] * a1 + h[2, 2, 0] * a2 + h[2, 1, 1] * b1 + h[2, 2, 1] * b2
            q3 = h[3, 1, 0] * a1 + h[3, 2, 0] * a2 + h[3, 1, 1] * b1 + h[3, 2, 1] * b2
            next_da = (p0 + q0 + x0) + (h[0, 0, 0] * ga + h[0, 0, 1] * gb)
            next_na = (p1 + q1 + x1) + (h[1, 0, 0] * ga + h[1, 0, 1] * gb)
            next_db = (p2 + q2 + x2) + (h[2, 0, 0] * ga + h[2, 0, 1] * gb)
            next_nb = (p3 + q3 + x3) + (h[3, 0, 0] * ga + h[3, 0, 1] * gb)
            n0, mu, v, k = n0 + n0_step, mu + mu_step, v + v_step, k + k_step
            if calm and v - max(next_da, next_db) > 0.0:
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
                m.flags[1] = 0.0
            else:
                _store_pair(m, zr, zi, a1, a2, a3, b1, b2, b3)
                m.present[0], m.present[1] = ga, gb
                push[0], push[1] = ea, eb
                contact[0], contact[1], contact[2], contact[3] = da, na, db, nb
                _point(operation, (i * c.substeps + sub) / steps, start)
                _point(operation, (i * c.substeps + sub + 1) / steps, end)
                _careful_and_count(c, m, push, start, end, inverse_saturation, contact)
                calm = m.flags[0] >= ORDER
                zr, zi = simd.load(m.modes, 0), simd.load(m.modes, 1)
                a1, a2, a3 = m.history[0, 0], m.history[1, 0], m.history[2, 0]
                b1, b2, b3 = m.history[0, 1], m.history[1, 1], m.history[2, 1]
                da, na, db, nb = contact[0], contact[1], contact[2], contact[3]
    _store_pair(m, zr, zi, a1, a2, a3, b1, b2, b3)

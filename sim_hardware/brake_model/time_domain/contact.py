"""Friction at the pads: the compiled law, and careful steps around slip reversals.

Whenever a pad's slip would reverse, and until enough smooth values exist again, careful steps are taken: fine
first-order-hold steps in which the set-valued friction law (sliding forwards, backwards, sticking) is solved
in closed form per pad, with Gauss-Seidel sweeps between the pads. Here are also the data that all compiled
functions share. NOT its job: the fast recursion while all pads slide forwards (`kernels`), building the
coefficients (`integrator`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: values of g kept from earlier steps, and with the present one
PAST = 3
DEPTH = PAST + 1
#: smooth steps in a row before the main step may follow careful ones: as many as its polynomial needs
CALM = DEPTH
#: slip, relative to its mean, above which a pad slides forwards for certain (sticking leaves rounding errors)
SLIDES = 1e-6
#: Gauss-Seidel sweeps over the pads, and fixed-point steps for mu(v) within each
_SWEEPS = 3
_INNER = 2

OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "fastmath": True, "error_model": "numpy"}


class Coefficients(NamedTuple):
    """Everything constant during a run. G groups, P padded modes, O outputs.

    `modal` holds all rows over the modes, complex numbers as (real, imaginary); the integers say where each
    kind begins. A product of a contact, ahead or output row with the modes is sum(row[0] * re + row[1] * im):
    the sign is in the row. Few arrays: numba unpacks each of them at every call.
    """

    substeps: int
    fine_steps: int
    mu_ref: float
    rotation: int  # 1 row
    drive: int  # G
    hold: int  # G: excitation held over the step
    history: int  # DEPTH * G: from g[n], g[n-1], ...
    contact: int  # 2 G: slip and compression variation from the modes (fine steps)
    ahead: int  # 2 G: the same one main step ahead
    fine_rotation: int  # 1
    fine_start: int  # G
    fine_end: int  # G
    output: int  # O
    modal: Array  # (rows, 2, P)
    share: Array  # (G,)
    ahead_history: Array  # (2 G, DEPTH, G) one step ahead from g[n], g[n-1], ...
    ahead_hold: Array  # (2 G, G)
    fine_end_contact: Array  # (2 G, G)
    output_history: Array  # (O, DEPTH, G)
    output_direct: Array  # (O, G)


class Memory(NamedTuple):
    """Everything that changes.

    `flags`: number of smooth steps in a row; how `present` and `modes` are to be taken (next three
    constants).
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


@njit(inline="always", **OPTIONS)
def mu_variation(slip_variation: float, k: float, inverse_saturation: float) -> float:
    """Friction law around the working point, sliding forwards: mu(v) - mu_mean for v - v_mean =
    -slip_variation."""
    x = slip_variation * inverse_saturation
    return k * slip_variation / np.sqrt(1.0 + x * x)


@njit(inline="always", **OPTIONS)
def forward_g(mu_variation: float, mu_mean: float, mu_ref: float, n0: float, compression: float) -> float:
    """mu max(N0 + N~, 0) - mu_mean N0 - mu_ref N~ without the difference of large numbers: exactly 0 at
    rest."""
    return mu_variation * n0 + (mu_mean + mu_variation) * max(compression, -n0) - mu_ref * compression


@njit(**OPTIONS)
def deviation(
    slip_variation: float,
    compression: float,
    n0: float,
    mu_mean: float,
    v_mean: float,
    k: float,
    inverse_saturation: float,
    mu_ref: float,
) -> float:
    """Deviation g of the friction force from its mean and from the linear part mu_ref N~, any slip
    direction."""
    v = v_mean - slip_variation
    if v > 0.0:
        return forward_g(
            mu_variation(slip_variation, k, inverse_saturation), mu_mean, mu_ref, n0, compression
        )
    mu = mu_mean + mu_variation(v_mean + v, k, inverse_saturation) if v < 0.0 else 0.0
    return -mu * max(n0 + compression, 0.0) - mu_mean * n0 - mu_ref * compression


@njit(**OPTIONS)
def add_history(c: Coefficients, m: Memory, sign: float, zr: Array, zi: Array) -> None:
    """Add or take away the friction history: between the s form and the modes themselves."""
    groups, modes = len(c.share), c.modal.shape[2]
    for d in range(DEPTH):
        for p in range(groups):
            g = sign * (m.present[p] if d == 0 else m.history[d - 1, p])
            for j in range(modes):
                zr[j] += c.modal[c.history + d * groups + p, 0, j] * g
                zi[j] += c.modal[c.history + d * groups + p, 1, j] * g


@njit(**OPTIONS)
def shift(m: Memory) -> None:
    """Make the present g the latest of the past."""
    for p in range(len(m.present)):
        for d in range(PAST - 1, 0, -1):
            m.history[d, p] = m.history[d - 1, p]
        m.history[0, p] = m.present[p]


@njit(**OPTIONS)
def careful_step(
    c: Coefficients, m: Memory, excitation: Array, start: Array, end: Array, inverse_saturation: float
) -> None:
    """Advance by one main step in fine steps with set-valued friction.

    `start`, `end`: (4,) pad force, mu_mean, mean slip, k at both ends. The present g must be in `m.present`;
    afterwards it and `m.contact` are those of the new time.
    """
    groups, modes = len(c.share), c.modal.shape[2]
    zr, zi = m.modes[0], m.modes[1]
    g, contact = m.present, m.contact
    add_history(c, m, 1.0, zr, zi)
    shift(m)
    for fine in range(c.fine_steps):
        part = (fine + 1.0) / c.fine_steps
        n0 = start[0] + part * (end[0] - start[0])
        mu_mean = start[1] + part * (end[1] - start[1])
        v_mean = start[2] + part * (end[2] - start[2])
        k = start[3] + part * (end[3] - start[3])
        for j in range(modes):
            re = c.modal[c.fine_rotation, 0, j] * zr[j] - c.modal[c.fine_rotation, 1, j] * zi[j]
            im = c.modal[c.fine_rotation, 0, j] * zi[j] + c.modal[c.fine_rotation, 1, j] * zr[j]
            for p in range(groups):
                first = g[p] + excitation[p]
                re += c.modal[c.fine_start + p, 0, j] * first + c.modal[c.fine_end + p, 0, j] * excitation[p]
                im += c.modal[c.fine_start + p, 1, j] * first + c.modal[c.fine_end + p, 1, j] * excitation[p]
            zr[j], zi[j] = re, im
        for row in range(2 * groups):
            contact[row] = 0.0
            for j in range(modes):
                contact[row] += (
                    c.modal[c.contact + row, 0, j] * zr[j] + c.modal[c.contact + row, 1, j] * zi[j]
                )
        solve_friction(c, g, contact, n0, mu_mean, v_mean, k, inverse_saturation)
        for p in range(groups):
            for j in range(modes):
                zr[j] += c.modal[c.fine_end + p, 0, j] * g[p]
                zi[j] += c.modal[c.fine_end + p, 1, j] * g[p]
    add_history(c, m, -1.0, zr, zi)


@njit(**OPTIONS)
def solve_friction(
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
    holding = mu_mean + mu_variation(v_mean, k, inverse_saturation)
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
                    mu = mu_mean + mu_variation(v_mean - speed, k, inverse_saturation)
                    speed = max(abs(drive) - mobility * mu * normal, 0.0)
                variation = mu_variation(v_mean - speed, k, inverse_saturation)
                if drive > 0.0:
                    g[p] = forward_g(variation, mu_mean, c.mu_ref, n0, compression)
                else:
                    g[p] = -(mu_mean + variation) * normal - mean
    for row in range(2 * groups):
        for q in range(groups):
            contact[row] += c.fine_end_contact[row, q] * g[q]


@njit(**OPTIONS)
def outputs_now(c: Coefficients, m: Memory, excitation: Array, out: Array) -> None:
    """All outputs at the present time, into `out` (O,)."""
    groups, modes = len(c.share), c.modal.shape[2]
    for o in range(len(out)):
        value = 0.0
        for j in range(modes):
            value += c.modal[c.output + o, 0, j] * m.modes[0, j] + c.modal[c.output + o, 1, j] * m.modes[1, j]
        for q in range(groups):
            value += (
                c.output_direct[o, q] * (m.present[q] + excitation[q])
                + c.output_history[o, 0, q] * m.present[q]
            )
            for d in range(1, DEPTH):
                value += c.output_history[o, d, q] * m.history[d - 1, q]
        out[o] = value


@njit(**OPTIONS)
def point(operation: Array, part: float, into: Array) -> None:
    """Operating values (4,) at a part of the call; `operation`: (4, 2) at its ends."""
    for i in range(4):
        into[i] = operation[i, 0] + part * (operation[i, 1] - operation[i, 0])


@njit(**OPTIONS)
def present_g(c: Coefficients, m: Memory, op: Array, inverse_saturation: float) -> None:
    """Bring g into `m.present`: by the friction law, unless the last careful step left its solution there.

    After smooth steps the pads slide forwards; a brake at rest under a disc that stands (v = 0) is held.
    """
    if m.flags[1] == SOLVED:
        return
    n0, mu_mean, v_mean, k = op[0], op[1], op[2], op[3]
    for p in range(len(m.present)):
        slip, compression, share = m.contact[2 * p], m.contact[2 * p + 1], c.share[p]
        if m.flags[0] >= CALM:
            variation = mu_variation(slip, k, inverse_saturation)
            m.present[p] = forward_g(variation, mu_mean, c.mu_ref, share * n0, compression)
        else:
            m.present[p] = deviation(
                slip, compression, share * n0, mu_mean, v_mean, k, inverse_saturation, c.mu_ref
            )
    if m.flags[1] == FRESH:
        add_history(c, m, -1.0, m.modes[0], m.modes[1])
        m.flags[1] = SOLVED


@njit(**OPTIONS)
def careful_and_count(
    c: Coefficients, m: Memory, excitation: Array, start: Array, end: Array, inverse_saturation: float
) -> None:
    """Take a careful step and count how many steps in a row slid forwards at both ends."""
    forwards = True
    for p in range(len(m.present)):
        forwards = forwards and start[2] - m.contact[2 * p] > SLIDES * start[2]
    careful_step(c, m, excitation, start, end, inverse_saturation)
    for p in range(len(m.present)):
        forwards = forwards and end[2] - m.contact[2 * p] > SLIDES * end[2]
    m.flags[0] = m.flags[0] + 1.0 if forwards else 0.0
    m.flags[1] = SOLVED

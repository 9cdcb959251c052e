"""Forces on a brake whose friction groups slide or stick, compiled: right-hand side of the event integration.

Here are the data that all compiled functions of the event integration share, and the derivative of the state
while the cases (every group of contacts slides forwards, backwards or sticks; every contact is loaded or not)
stay as they are. A sticking group is a constraint: its friction force is what keeps its slip velocity at that
of the disc. NOT its job: when cases end (`event_cases`), steps (`event_steps`), building the data (`motion`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from sim_hardware.brake_model.time_domain.contact import mu_variation

Array = NDArray[np.float64]
Cases = NDArray[np.int64]

#: not all of fastmath: the control of steps asks whether numbers are finite; nothing is allocated, so that no
#: references need counting
OPTIONS: dict[str, Any] = {
    "cache": True,
    "nogil": True,
    "error_model": "numpy",
    "fastmath": {"reassoc", "contract", "arcp", "nsz"},
    "_nrt": False,
}
#: functions that are called by compiled ones only need no entrance from Python, which takes long to compile
INNER: dict[str, Any] = OPTIONS | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}

#: coefficients of the dense output of a step
POWERS = 7
#: counters in `Memory.counts`
STEPS, REJECTED, WRITTEN, EVENTS, AT_ONCE, STARTED = range(6)


class Tables(NamedTuple):
    """Everything constant. n freedoms, C contacts, G friction groups, Q lines with a cubic part, T knots."""

    linear: Array  # (2n, n) accelerations of displacements and velocities, contacts' normal forces left out
    inverse_inertia: Array  # (n,)
    cubic_rows: Array  # (Q, n)
    cubic: Array  # (Q,)
    normal_rows: Array  # (C, n) compression of the contact
    stiffness: Array  # (C,)
    hardening: Array  # (C,)
    damping: Array  # (C,)
    one_sided: Cases  # (C,)
    share: Array  # (C,)
    group: Cases  # (C,) group of the contact
    slip_rows: Array  # (G, n)
    mobility: Array  # (G, G) slip acceleration by friction force
    knots: Array  # (T,) s
    course: Array  # (T, 4) pad force, mu_mean, sliding speed, slope k at the knots; linear between
    inverse_saturation: float
    static_mu: float  # negative: the law's limit at standstill
    always_sliding: bool
    tolerance: Array  # (3,) relative; absolute of displacements, of velocities
    most_steps: int
    longest_step_s: float


class Memory(NamedTuple):
    """Everything that changes."""

    state: Array  # (2n,)
    clock: Array  # (2,) time, size of the next step
    sliding: Cases  # (G,) 1 forwards, -1 backwards, 0 sticks
    loaded: Cases  # (C,)
    counts: Cases  # (6,)


class Record(NamedTuple):
    """Where results go. N times."""

    times: Array  # (N,)
    states: Array  # (N, 2n)
    friction: Array  # (N, G) whole friction force on the pad, N
    normal: Array  # (N, C) whole normal force, N
    sliding: Cases  # (N, G)
    event_time: Array  # (E,)
    event_what: Cases  # (E, 2) kind; group or contact


class Scratch(NamedTuple):
    """Work space."""

    stages: Array  # (16, 2n)
    trial: Array  # (2n,)
    end: Array  # (2n,)
    dense: Array  # (7, 2n)
    look: Array  # (2n,)
    rate: Array  # (2n,)
    point: Array  # (5,) pad force, mu_mean, sliding speed, k; rate of the sliding speed
    force: Array  # (G,) deviation of the friction force
    bearing: Array  # (G,) normal force of the group
    variation: Array  # (C,) variation N~ of the contact's normal force
    system: Array  # (G, G + 1)
    watch: Array  # (G + C,) positive within the case
    standing: Cases  # (G,) groups without slip speed
    held: Cases  # (G,)
    before: Cases  # (G,)


def scratch(n: int, groups: int, contacts: int) -> Scratch:
    """Work space for a brake."""
    return Scratch(
        stages=np.zeros((16, 2 * n)),
        trial=np.zeros(2 * n),
        end=np.zeros(2 * n),
        dense=np.zeros((POWERS, 2 * n)),
        look=np.zeros(2 * n),
        rate=np.zeros(2 * n),
        point=np.zeros(5),
        force=np.zeros(groups),
        bearing=np.zeros(groups),
        variation=np.zeros(contacts),
        system=np.zeros((groups, groups + 1)),
        watch=np.zeros(groups + contacts),
        standing=np.zeros(groups, dtype=np.int64),
        held=np.zeros(groups, dtype=np.int64),
        before=np.zeros(groups, dtype=np.int64),
    )


@njit(**INNER)
def copy(source: Array, to: Array) -> None:
    """Copy a vector."""
    for i in range(len(source)):
        to[i] = source[i]


@njit(**INNER)
def segment_of(b: Tables, t: float) -> int:
    """Index of the knot that begins the segment of time t."""
    low, high = 0, len(b.knots) - 1
    while high - low > 1:
        middle = (low + high) // 2
        if b.knots[middle] <= t:
            low = middle
        else:
            high = middle
    return low


@njit(**INNER)
def working_point(b: Tables, segment: int, t: float, point: Array) -> None:
    """Operating values at time t, taken along the line of a segment."""
    length = b.knots[segment + 1] - b.knots[segment]
    part = (t - b.knots[segment]) / length
    for i in range(4):
        point[i] = b.course[segment, i] + part * (b.course[segment + 1, i] - b.course[segment, i])
    point[4] = (b.course[segment + 1, 2] - b.course[segment, 2]) / length


@njit(**INNER)
def contact_motion(b: Tables, y: Array, w: Scratch) -> None:
    """Variation N~ of every contact's normal force, as if it were pressed."""
    n = len(b.inverse_inertia)
    for c in range(len(b.share)):
        compression, rate = 0.0, 0.0
        for i in range(n):
            compression += b.normal_rows[c, i] * y[i]
            rate += b.normal_rows[c, i] * y[n + i]
        w.variation[c] = (
            b.stiffness[c] + b.hardening[c] * compression * compression
        ) * compression + b.damping[c] * rate


@njit(**INNER)
def slip_speed(b: Tables, y: Array, point: Array, g: int) -> float:
    """Speed of the disc under the group's contacts, > 0: slides forwards."""
    n = len(b.inverse_inertia)
    speed = point[2]
    for i in range(n):
        speed -= b.slip_rows[g, i] * y[n + i]
    return speed


@njit(**INNER)
def holding_mu(b: Tables, point: Array) -> float:
    """Largest coefficient of friction that sticking can hold."""
    if b.static_mu >= 0.0:
        return b.static_mu
    return point[1] + mu_variation(point[2], point[3], b.inverse_saturation)


@njit(**INNER)
def derivative(  # noqa: PLR0912
    b: Tables, y: Array, sliding: Cases, loaded: Cases, w: Scratch, rate: Array
) -> None:
    """Derivative of (displacements, velocities) with the cases given; leaves forces in the scratch.

    `w.point` must be that of the time.
    """
    n, groups, contacts = len(b.inverse_inertia), len(b.slip_rows), len(b.share)
    point = w.point
    for i in range(n):
        rate[i] = y[n + i]
        rate[n + i] = 0.0
    for j in range(2 * n):  # this order of loops is fast: no sum waits for the last one
        value = y[j]
        for i in range(n):
            rate[n + i] += b.linear[j, i] * value
    for q in range(len(b.cubic)):
        strain = 0.0
        for i in range(n):
            strain += b.cubic_rows[q, i] * y[i]
        force = b.cubic[q] * strain * strain * strain
        for i in range(n):
            rate[n + i] -= b.inverse_inertia[i] * b.cubic_rows[q, i] * force
    contact_motion(b, y, w)
    for g in range(groups):
        w.bearing[g] = 0.0
        w.force[g] = 0.0
    for c in range(contacts):
        mean = b.share[c] * point[0]
        variation = w.variation[c]
        change = variation if loaded[c] else -mean  # of the force that bears friction
        force = change if b.one_sided[c] else variation  # of the force between the bodies
        w.bearing[b.group[c]] += mean + change
        w.force[b.group[c]] += change  # for now: the change of the group's normal force
        for i in range(n):
            rate[n + i] -= b.inverse_inertia[i] * b.normal_rows[c, i] * force  # eqs 6, 7, 12, 13
    sticking = 0
    for g in range(groups):
        change, bearing = w.force[g], w.bearing[g]
        if sliding[g] == 0:
            w.force[g] = 0.0
            sticking += 1
            continue
        speed = sliding[g] * slip_speed(b, y, point, g)
        deviation = mu_variation(point[2] - speed, point[3], b.inverse_saturation)
        if sliding[g] > 0:  # mu N - mu_mean N0 without the difference of large numbers
            w.force[g] = deviation * (bearing - change) + (point[1] + deviation) * change
        else:
            w.force[g] = -(point[1] + deviation) * bearing - point[1] * (bearing - change)
        add_friction(b, g, w.force[g], rate)
    if sticking:
        hold(b, sliding, w, rate)


@njit(**INNER)
def add_friction(b: Tables, g: int, force: float, rate: Array) -> None:
    """Let a friction force act on the accelerations."""
    n = len(b.inverse_inertia)
    for i in range(n):
        rate[n + i] += b.inverse_inertia[i] * b.slip_rows[g, i] * force


@njit(**INNER)
def slip_acceleration(b: Tables, g: int, rate: Array, point: Array) -> float:
    """Rate of the slip speed."""
    n = len(b.inverse_inertia)
    value = point[4]
    for i in range(n):
        value -= b.slip_rows[g, i] * rate[n + i]
    return value


@njit(**INNER)
def hold(b: Tables, sliding: Cases, w: Scratch, rate: Array) -> None:
    """Friction forces that keep the sticking groups at the disc's speed (a constraint on accelerations)."""
    groups = len(b.slip_rows)
    for g in range(groups):
        w.held[g] = 1 if sliding[g] == 0 else 0
    for g in range(groups):
        for h in range(groups):
            w.system[g, h] = b.mobility[g, h] if w.held[g] and w.held[h] else 0.0
        w.system[g, groups] = slip_acceleration(b, g, rate, w.point) if w.held[g] else 0.0
    solve(w.system, w.force, w.held, b.mobility)
    for g in range(groups):
        if w.held[g]:
            add_friction(b, g, w.force[g], rate)


@njit(**INNER)
def solve(m: Array, result: Array, held: Cases, scale: Array) -> None:
    """Gauss elimination over the groups that are held; one whose slip others already fix gets no force."""
    groups = len(result)
    for g in range(groups):
        if not held[g]:
            continue
        if m[g, g] <= 1e-12 * scale[g, g]:
            m[g, g] = 0.0
            continue
        for h in range(g + 1, groups):
            if held[h]:
                factor = m[h, g] / m[g, g]
                for k in range(g, groups + 1):
                    m[h, k] -= factor * m[g, k]
    for g in range(groups - 1, -1, -1):
        if not held[g]:
            continue
        value = m[g, groups]
        for h in range(g + 1, groups):
            if held[h]:
                value -= m[g, h] * result[h]
        result[g] = value / m[g, g] if m[g, g] > 0.0 else 0.0


@njit(**INNER)
def limit(b: Tables, g: int, w: Scratch) -> float:
    """Largest whole friction force that a sticking group can hold."""
    return holding_mu(b, w.point) * max(w.bearing[g], 0.0)


@njit(**INNER)
def mean_force(b: Tables, g: int, point: Array) -> float:
    """Mean friction force of a group."""
    share = 0.0
    for c in range(len(b.share)):
        if b.group[c] == g:
            share += b.share[c]
    return point[1] * share * point[0]

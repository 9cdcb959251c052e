"""Compiled steps of the event-driven integrator: order 8 with automatic step, friction by cases.

Between events every group of contacts slides forwards, backwards or sticks, and every contact is loaded or
not; with these cases fixed the equations are smooth and a Dormand-Prince step of order 8 (coefficients and
dense output: Hairer, Norsett, Wanner, as `scipy.integrate.DOP853`) is taken. Functions watched over the dense
output tell when a case ends; the step is cut there, the new cases follow from the set-valued law at the level
of accelerations, and integration starts again. A sticking group is a constraint: its friction force is what
keeps its slip velocity at that of the disc, |F| <= mu(0) N.
NOT its job: building the data, names, units, errors for people (`motion`).
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy.integrate import DOP853

from sim_hardware.brake_model.contact import mu_variation

Array = NDArray[np.float64]
Cases = NDArray[np.int64]

#: not all of fastmath: the control of steps asks whether numbers are finite; nothing is allocated, so that no
#: references need counting
_OPTIONS: dict[str, Any] = {
    "cache": True,
    "nogil": True,
    "error_model": "numpy",
    "fastmath": {"reassoc", "contract", "arcp", "nsz"},
    "_nrt": False,
}

#: functions that are called by compiled ones only need no entrance from Python, which takes long to compile
_INNER: dict[str, Any] = _OPTIONS | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}

_STAGES = 12
_A = np.zeros((16, 16))
_A[:_STAGES, :_STAGES] = DOP853.A
_A[12, :12] = DOP853.B
_A[13:16, :16] = DOP853.A_EXTRA
_C = np.concatenate([DOP853.C, [1.0], DOP853.C_EXTRA])
_E3, _E5, _D = np.array(DOP853.E3), np.array(DOP853.E5), np.array(DOP853.D)
_POWERS = 7

_SAFETY, _SHRINK, _GROW = 0.9, 0.2, 6.0
_EXPONENT = -1.0 / 8.0
#: parts of a step at which watched functions are looked at
_LOOKS = 4
_BISECTIONS = 60
#: sweeps that decide which groups stick
_SWEEPS = 200
#: a watched function has changed sign when it is beyond zero by this part of its scale
_BEYOND = 1e-10
#: scale of the slip velocity (m/s) where the sliding speed gives none, and of forces (N)
_LEAST_SPEED, _LEAST_FORCE = 1e-6, 1e-3
#: events within so short a time (s) count as one moment; more of them than this are no motion any more
_MOMENT_S, _MOST_AT_ONCE = 1e-12, 64

#: results of `advance`
DONE, NOT_FINITE, STEP_TOO_SMALL, TOO_MANY_STEPS, CHATTER, BUFFER_FULL = range(6)
#: kinds of events
STICK, RELEASE, REVERSE, OPEN, CLOSE = range(5)
#: counters in `Memory.counts`
STEPS, REJECTED, CALLS, WRITTEN, EVENTS, AT_ONCE, STARTED = range(7)


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
    counts: Cases  # (7,)


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
        dense=np.zeros((_POWERS, 2 * n)),
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


@njit(**_INNER)
def copy(source: Array, to: Array) -> None:
    """Copy a vector."""
    for i in range(len(source)):
        to[i] = source[i]


@njit(**_INNER)
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


@njit(**_INNER)
def working_point(b: Tables, segment: int, t: float, point: Array) -> None:
    """Operating values at time t, taken along the line of a segment."""
    length = b.knots[segment + 1] - b.knots[segment]
    part = (t - b.knots[segment]) / length
    for i in range(4):
        point[i] = b.course[segment, i] + part * (b.course[segment + 1, i] - b.course[segment, i])
    point[4] = (b.course[segment + 1, 2] - b.course[segment, 2]) / length


@njit(**_INNER)
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


@njit(**_INNER)
def slip_speed(b: Tables, y: Array, point: Array, g: int) -> float:
    """Speed of the disc under the group's contacts, > 0: slides forwards."""
    n = len(b.inverse_inertia)
    speed = point[2]
    for i in range(n):
        speed -= b.slip_rows[g, i] * y[n + i]
    return speed


@njit(**_INNER)
def holding_mu(b: Tables, point: Array) -> float:
    """Largest coefficient of friction that sticking can hold."""
    if b.static_mu >= 0.0:
        return b.static_mu
    return point[1] + mu_variation(point[2], point[3], b.inverse_saturation)


@njit(**_INNER)
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


@njit(**_INNER)
def add_friction(b: Tables, g: int, force: float, rate: Array) -> None:
    """Let a friction force act on the accelerations."""
    n = len(b.inverse_inertia)
    for i in range(n):
        rate[n + i] += b.inverse_inertia[i] * b.slip_rows[g, i] * force


@njit(**_INNER)
def slip_acceleration(b: Tables, g: int, rate: Array, point: Array) -> float:
    """Rate of the slip speed."""
    n = len(b.inverse_inertia)
    value = point[4]
    for i in range(n):
        value -= b.slip_rows[g, i] * rate[n + i]
    return value


@njit(**_INNER)
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


@njit(**_INNER)
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


@njit(**_INNER)
def limit(b: Tables, g: int, w: Scratch) -> float:
    """Largest whole friction force that a sticking group can hold."""
    return holding_mu(b, w.point) * max(w.bearing[g], 0.0)


@njit(**_INNER)
def mean_force(b: Tables, g: int, point: Array) -> float:
    """Mean friction force of a group."""
    share = 0.0
    for c in range(len(b.share)):
        if b.group[c] == g:
            share += b.share[c]
    return point[1] * share * point[0]


@njit(**_INNER)
def look_at(b: Tables, y: Array, sliding: Cases, loaded: Cases, w: Scratch) -> bool:
    """Fill `w.watch` (positive within the case); whether any case has ended. `w.point` as for
    `derivative`."""
    groups = len(b.slip_rows)
    ended, sticking = False, False
    contact_motion(b, y, w)
    for c in range(len(b.share)):
        mean = b.share[c] * w.point[0]
        whole = mean + w.variation[c]
        w.watch[groups + c] = (whole if loaded[c] else -whole) + _BEYOND * max(mean, _LEAST_FORCE)
        ended = ended or w.watch[groups + c] < 0.0
    for g in range(groups):
        if sliding[g] == 0:
            sticking = True
        else:
            speed = slip_speed(b, y, w.point, g)
            w.watch[g] = sliding[g] * speed + _BEYOND * max(w.point[2], _LEAST_SPEED)
            ended = ended or w.watch[g] < 0.0
    if sticking:
        derivative(b, y, sliding, loaded, w, w.rate)
        for g in range(groups):
            if sliding[g] == 0:
                most = limit(b, g, w)
                force = abs(w.force[g] + mean_force(b, g, w.point))
                w.watch[g] = most * (1.0 + _BEYOND) + _BEYOND * _LEAST_FORCE - force
                ended = ended or w.watch[g] < 0.0
    return ended


@njit(**_INNER)
def decide(b: Tables, m: Memory, w: Scratch) -> None:  # noqa: PLR0912
    """Cases of the groups without slip speed (`w.standing`): sticks, or slides to where it accelerates.

    The set-valued law at the level of accelerations: F within +-mu(0) N, at its bound where the slip speed
    changes. A projected Gauss-Seidel solution, which exists and is unique because the mobility is positive
    definite on independent slips.
    """
    groups, standing, sliding = len(m.sliding), w.standing, m.sliding
    for g in range(groups):
        if standing[g]:
            sliding[g] = 1  # its friction is taken out again below
    derivative(b, m.state, sliding, m.loaded, w, w.rate)
    for g in range(groups):
        if standing[g]:
            add_friction(b, g, -w.force[g], w.rate)
            w.force[g] = 0.0
    for _ in range(_SWEEPS):
        moved = 0.0
        for g in range(groups):
            if not standing[g] or b.mobility[g, g] == 0.0:
                continue
            mean, most = mean_force(b, g, w.point), limit(b, g, w)
            wanted = w.force[g] + slip_acceleration(b, g, w.rate, w.point) / b.mobility[g, g]
            force = min(max(wanted, -most - mean), most - mean)
            change = force - w.force[g]
            if change != 0.0:
                add_friction(b, g, change, w.rate)
                w.force[g] = force
                moved = max(moved, abs(change) / (most + _LEAST_FORCE))
        if moved < 1e-14:
            break
    for g in range(groups):
        if standing[g]:
            most = limit(b, g, w)
            whole = w.force[g] + mean_force(b, g, w.point)
            if abs(whole) < most * (1.0 - 1e-13):
                sliding[g] = 0
            else:
                sliding[g] = 1 if slip_acceleration(b, g, w.rate, w.point) >= 0.0 else -1


@njit(**_INNER)
def stop_slip(b: Tables, y: Array, w: Scratch) -> None:
    """Take the rounding errors of slip speed from the groups that are `w.standing`."""
    n, groups = len(b.inverse_inertia), len(b.slip_rows)
    for g in range(groups):
        for h in range(groups):
            w.system[g, h] = b.mobility[g, h] if w.standing[g] and w.standing[h] else 0.0
        w.system[g, groups] = slip_speed(b, y, w.point, g) if w.standing[g] else 0.0
        w.force[g] = 0.0
    solve(w.system, w.force, w.standing, b.mobility)
    for g in range(groups):
        if w.standing[g]:
            for i in range(n):
                y[n + i] += b.inverse_inertia[i] * b.slip_rows[g, i] * w.force[g]


@njit(**_INNER)
def begin(b: Tables, m: Memory, w: Scratch) -> None:
    """Cases at the start."""
    groups = len(b.slip_rows)
    working_point(b, segment_of(b, m.clock[0]), m.clock[0], w.point)
    contact_motion(b, m.state, w)
    for c in range(len(b.share)):
        m.loaded[c] = 1 if b.always_sliding or b.share[c] * w.point[0] + w.variation[c] >= 0.0 else 0
    still = False
    for g in range(groups):
        speed = slip_speed(b, m.state, w.point, g)
        m.sliding[g] = 1 if speed >= 0.0 or b.always_sliding else -1
        w.standing[g] = 0
        if not b.always_sliding and abs(speed) <= _BEYOND * max(w.point[2], _LEAST_SPEED):
            w.standing[g], still = 1, True
    if still:
        decide(b, m, w)


@njit(**_INNER)
def change_cases(b: Tables, m: Memory, r: Record, w: Scratch) -> bool:
    """New cases after `look_at` has found some ended at the present state; records the events.

    False where the events chatter.
    """
    groups = len(b.slip_rows)
    still = False
    for g in range(groups):
        w.before[g] = m.sliding[g]
        w.standing[g] = 1 if w.watch[g] < 0.0 or m.sliding[g] == 0 else 0
        still = still or w.standing[g] == 1
    for c in range(len(b.share)):
        if w.watch[groups + c] < 0.0:
            m.loaded[c] = 1 - m.loaded[c]
            note(m, r, CLOSE if m.loaded[c] else OPEN, c)
    if still:
        stop_slip(b, m.state, w)
        decide(b, m, w)
    for g in range(groups):
        if m.sliding[g] != w.before[g]:
            kind = STICK if m.sliding[g] == 0 else (RELEASE if w.before[g] == 0 else REVERSE)
            note(m, r, kind, g)
    return m.counts[AT_ONCE] <= _MOST_AT_ONCE


@njit(**_INNER)
def note(m: Memory, r: Record, kind: int, which: int) -> None:
    """Record an event."""
    i = m.counts[EVENTS]
    if i > 0 and m.clock[0] - r.event_time[i - 1] < _MOMENT_S:
        m.counts[AT_ONCE] += 1
    else:
        m.counts[AT_ONCE] = 0
    r.event_time[i], r.event_what[i, 0], r.event_what[i, 1] = m.clock[0], kind, which
    m.counts[EVENTS] = i + 1


@njit(**_INNER)
def write(b: Tables, m: Memory, r: Record, w: Scratch, y: Array) -> None:
    """Record state and forces of the next output time. `w.point` must be that of the time."""
    i = m.counts[WRITTEN]
    derivative(b, y, m.sliding, m.loaded, w, w.rate)
    for j in range(len(y)):
        r.states[i, j] = y[j]
    for g in range(len(b.slip_rows)):
        r.friction[i, g] = w.force[g] + mean_force(b, g, w.point)
        r.sliding[i, g] = m.sliding[g]
    for c in range(len(b.share)):
        force = w.variation[c] if m.loaded[c] or not b.one_sided[c] else -b.share[c] * w.point[0]
        r.normal[i, c] = b.share[c] * w.point[0] + force
    m.counts[WRITTEN] = i + 1


@njit(**_INNER)
def interpolate(y: Array, dense: Array, part: float, out: Array) -> None:
    """Dense output at a part of the step."""
    for i in range(len(y)):
        value = 0.0
        for power in range(_POWERS - 1, -1, -1):
            value += dense[power, i]
            value *= part if (_POWERS - 1 - power) % 2 == 0 else 1.0 - part
        out[i] = y[i] + value


@njit(**_INNER)
def stage(b: Tables, m: Memory, w: Scratch, s: int, h: float, segment: int) -> None:
    """Derivative of stage s into `w.stages[s]`, its state into `w.trial`."""
    size = len(m.state)
    for i in range(size):
        w.trial[i] = m.state[i]
    for j in range(s):
        weight = h * _A[s, j]
        if weight != 0.0:
            for i in range(size):
                w.trial[i] += weight * w.stages[j, i]
    working_point(b, segment, m.clock[0] + _C[s] * h, w.point)
    derivative(b, w.trial, m.sliding, m.loaded, w, w.stages[s])


@njit(**_INNER)
def step_error(b: Tables, m: Memory, w: Scratch, h: float) -> float:
    """Error of the step in units of the tolerance."""
    size = len(m.state)
    five, three = 0.0, 0.0
    for i in range(size):
        e5, e3 = 0.0, 0.0
        for j in range(_STAGES + 1):
            e5 += _E5[j] * w.stages[j, i]
            e3 += _E3[j] * w.stages[j, i]
        scale = b.tolerance[1] if i < size // 2 else b.tolerance[2]
        scale += b.tolerance[0] * max(abs(m.state[i]), abs(w.end[i]))
        five += (e5 / scale) ** 2
        three += (e3 / scale) ** 2
    if five == 0.0 and three == 0.0:
        return 0.0
    return abs(h) * five / np.sqrt((five + 0.01 * three) * size)


@njit(**_INNER)
def densify(b: Tables, m: Memory, w: Scratch, h: float, segment: int) -> None:
    """Coefficients of the dense output of the step just taken."""
    for s in range(13, 16):
        stage(b, m, w, s, h, segment)
    size = len(m.state)
    for i in range(size):
        delta = w.end[i] - m.state[i]
        first = w.stages[0, i]
        w.dense[0, i] = delta
        w.dense[1, i] = h * first - delta
        w.dense[2, i] = 2.0 * delta - h * (w.stages[12, i] + first)
    for p in range(3, _POWERS):
        for i in range(size):
            w.dense[p, i] = 0.0
        for j in range(16):
            weight = h * _D[p - 3, j]
            if weight != 0.0:
                for i in range(size):
                    w.dense[p, i] += weight * w.stages[j, i]


@njit(**_INNER)
def ended_at(b: Tables, m: Memory, w: Scratch, part: float, h: float, segment: int) -> bool:
    """Whether a case has ended at a part of the step; leaves the state there in `w.look`."""
    if part >= 1.0:
        copy(w.end, w.look)
    else:
        interpolate(m.state, w.dense, part, w.look)
    working_point(b, segment, m.clock[0] + part * h, w.point)
    return look_at(b, w.look, m.sliding, m.loaded, w)


@njit(**_INNER)
def first_end(b: Tables, m: Memory, w: Scratch, h: float, segment: int) -> float:
    """Part of the step just after which the first case ends; 2 where none does."""
    low = 0.0
    for k in range(1, _LOOKS + 1):
        high = k / _LOOKS
        if ended_at(b, m, w, high, h, segment):
            for _ in range(_BISECTIONS):
                middle = 0.5 * (low + high)
                if (high - low) * h < 0.01 * _MOMENT_S or middle in (low, high):
                    break
                if ended_at(b, m, w, middle, h, segment):
                    high = middle
                else:
                    low = middle
            return high
        low = high
    return 2.0


@njit(**_INNER)
def first_step(b: Tables, m: Memory, w: Scratch) -> float:
    """Size of a first step: state over rate, in units of the tolerance."""
    working_point(b, segment_of(b, m.clock[0]), m.clock[0], w.point)
    derivative(b, m.state, m.sliding, m.loaded, w, w.rate)
    size = len(m.state)
    h = b.longest_step_s
    for i in range(size):
        absolute = b.tolerance[1] if i < size // 2 else b.tolerance[2]
        if w.rate[i] != 0.0:
            h = min(h, 0.01 * (abs(m.state[i]) + absolute / b.tolerance[0]) / abs(w.rate[i]))
    return max(h, 1e-9)


@njit(**_OPTIONS)
def advance(  # noqa: PLR0911, PLR0912, PLR0915 (one loop, its cases in order)
    b: Tables, m: Memory, r: Record, w: Scratch, pause: int
) -> int:
    """Integrate until the last output time is written, or for `pause` steps; returns how it ended.

    `pause` steps are taken at a time so that the caller can be interrupted; DONE with outputs missing means:
    call again.
    """
    groups, contacts = len(b.slip_rows), len(b.share)
    if m.counts[STARTED] == 0:
        begin(b, m, w)
        m.clock[1] = first_step(b, m, w)
        m.counts[STARTED] = 1
    for _ in range(pause):
        while m.counts[WRITTEN] < len(r.times) and r.times[m.counts[WRITTEN]] <= m.clock[0]:
            working_point(b, segment_of(b, m.clock[0]), m.clock[0], w.point)
            write(b, m, r, w, m.state)
        if m.counts[WRITTEN] == len(r.times):
            return DONE
        if m.counts[EVENTS] + 2 * (groups + contacts) > len(r.event_time):
            return BUFFER_FULL
        if m.counts[STEPS] >= b.most_steps:
            return TOO_MANY_STEPS
        segment = segment_of(b, m.clock[0])
        working_point(b, segment, m.clock[0], w.point)
        derivative(b, m.state, m.sliding, m.loaded, w, w.stages[0])
        stop = min(float(b.knots[segment + 1]), float(r.times[-1]))
        h = min(m.clock[1], b.longest_step_s)
        while True:
            last = m.clock[0] + 1.0000001 * h >= stop
            if last:
                h = stop - m.clock[0]
            for s in range(1, _STAGES + 1):
                stage(b, m, w, s, h, segment)
            copy(w.trial, w.end)
            error = step_error(b, m, w, h)
            if error < 1.0:
                break
            m.counts[REJECTED] += 1
            if not np.isfinite(error):
                h *= _SHRINK
                if h < 1e-16 + 1e-15 * abs(m.clock[0]):
                    return NOT_FINITE
                continue
            h *= max(_SHRINK, _SAFETY * error**_EXPONENT)
            if h < 1e-15 + 1e-14 * abs(m.clock[0]):
                return STEP_TOO_SMALL
        grown = h * (_GROW if error == 0.0 else min(_GROW, max(_SHRINK, _SAFETY * error**_EXPONENT)))
        m.clock[1] = max(grown, m.clock[1]) if last else grown
        m.counts[STEPS] += 1
        densify(b, m, w, h, segment)
        part = 2.0 if b.always_sliding else first_end(b, m, w, h, segment)
        until = m.clock[0] + min(part, 1.0) * h
        while m.counts[WRITTEN] < len(r.times) and r.times[m.counts[WRITTEN]] < until:
            t = float(r.times[m.counts[WRITTEN]])
            interpolate(m.state, w.dense, (t - m.clock[0]) / h, w.look)
            working_point(b, segment, t, w.point)
            write(b, m, r, w, w.look)
        if part <= 1.0:
            ended_at(b, m, w, part, h, segment)
            copy(w.look, m.state)
            m.clock[0] = until
            if not change_cases(b, m, r, w):
                return CHATTER
        else:
            copy(w.end, m.state)
            m.clock[0] = stop if last else until
            still = False
            for g in range(groups):
                w.standing[g] = 1 if m.sliding[g] == 0 else 0
                still = still or w.standing[g] == 1
            if still:
                working_point(b, segment, m.clock[0], w.point)
                stop_slip(b, m.state, w)
    return DONE

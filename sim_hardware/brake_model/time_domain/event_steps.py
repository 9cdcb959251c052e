"""Compiled steps of the event-driven integrator: order 8 with automatic step, cut at events.

Between events every group of contacts slides forwards, backwards or sticks, and every contact is loaded or
not; with these cases fixed the equations are smooth and a Dormand-Prince step of order 8 (coefficients and
dense output: Hairer, Norsett, Wanner, as `scipy.integrate.DOP853`) is taken. Functions watched over the dense
output tell when a case ends; the step is cut there, new cases are found (`event_cases`), and integration
starts again.
NOT its job: forces (`event_forces`), building the data, names, units, errors for people (`motion`).
"""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.integrate import DOP853

from sim_hardware.brake_model.time_domain.event_cases import MOMENT_S, begin, change_cases, look_at, stop_slip
from sim_hardware.brake_model.time_domain.event_forces import (
    EVENTS,
    INNER,
    OPTIONS,
    POWERS,
    REJECTED,
    STARTED,
    STEPS,
    WRITTEN,
    Array,
    Memory,
    Record,
    Scratch,
    Tables,
    copy,
    derivative,
    mean_force,
    segment_of,
    working_point,
)

_STAGES = 12
_A = np.zeros((16, 16))
_A[:_STAGES, :_STAGES] = DOP853.A
_A[12, :12] = DOP853.B
_A[13:16, :16] = DOP853.A_EXTRA
_C = np.concatenate([DOP853.C, [1.0], DOP853.C_EXTRA])
_E3, _E5, _D = np.array(DOP853.E3), np.array(DOP853.E5), np.array(DOP853.D)

_SAFETY, _SHRINK, _GROW = 0.9, 0.2, 6.0
_EXPONENT = -1.0 / 8.0
#: parts of a step at which watched functions are looked at
_LOOKS = 4
_BISECTIONS = 60

#: results of `advance`
DONE, NOT_FINITE, STEP_TOO_SMALL, TOO_MANY_STEPS, CHATTER, BUFFER_FULL = range(6)


@njit(**INNER)
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


@njit(**INNER)
def interpolate(y: Array, dense: Array, part: float, out: Array) -> None:
    """Dense output at a part of the step."""
    for i in range(len(y)):
        value = 0.0
        for power in range(POWERS - 1, -1, -1):
            value += dense[power, i]
            value *= part if (POWERS - 1 - power) % 2 == 0 else 1.0 - part
        out[i] = y[i] + value


@njit(**INNER)
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


@njit(**INNER)
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


@njit(**INNER)
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
    for p in range(3, POWERS):
        for i in range(size):
            w.dense[p, i] = 0.0
        for j in range(16):
            weight = h * _D[p - 3, j]
            if weight != 0.0:
                for i in range(size):
                    w.dense[p, i] += weight * w.stages[j, i]


@njit(**INNER)
def ended_at(b: Tables, m: Memory, w: Scratch, part: float, h: float, segment: int) -> bool:
    """Whether a case has ended at a part of the step; leaves the state there in `w.look`."""
    if part >= 1.0:
        copy(w.end, w.look)
    else:
        interpolate(m.state, w.dense, part, w.look)
    working_point(b, segment, m.clock[0] + part * h, w.point)
    return look_at(b, w.look, m.sliding, m.loaded, w)


@njit(**INNER)
def first_end(b: Tables, m: Memory, w: Scratch, h: float, segment: int) -> float:
    """Part of the step just after which the first case ends; 2 where none does."""
    low = 0.0
    for k in range(1, _LOOKS + 1):
        high = k / _LOOKS
        if ended_at(b, m, w, high, h, segment):
            for _ in range(_BISECTIONS):
                middle = 0.5 * (low + high)
                if (high - low) * h < 0.01 * MOMENT_S or middle in (low, high):
                    break
                if ended_at(b, m, w, middle, h, segment):
                    high = middle
                else:
                    low = middle
            return high
        low = high
    return 2.0


@njit(**INNER)
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


@njit(**OPTIONS)
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

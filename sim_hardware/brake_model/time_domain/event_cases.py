"""When a case of friction or contact ends, and what follows: events of the event integration, compiled.

Watched functions are positive within a case. Where one has changed sign, the new cases follow from the
set-valued law at the level of accelerations: a group without slip speed sticks where a force within +-mu(0) N
can hold it, and slides to where it accelerates otherwise.
NOT its job: forces (`event_forces`), finding the time of an event (`event_steps`).
"""

from __future__ import annotations

from numba import njit

from sim_hardware.brake_model.time_domain.event_forces import (
    AT_ONCE,
    EVENTS,
    INNER,
    Array,
    Cases,
    Memory,
    Record,
    Scratch,
    Tables,
    add_friction,
    contact_motion,
    derivative,
    limit,
    mean_force,
    segment_of,
    slip_acceleration,
    slip_speed,
    solve,
    working_point,
)

#: sweeps that decide which groups stick
_SWEEPS = 200
#: a watched function has changed sign when it is beyond zero by this part of its scale
_BEYOND = 1e-10
#: scale of the slip velocity (m/s) where the sliding speed gives none, and of forces (N)
_LEAST_SPEED, _LEAST_FORCE = 1e-6, 1e-3
#: events within so short a time (s) count as one moment; more of them than this are no motion any more
MOMENT_S, _MOST_AT_ONCE = 1e-12, 64

#: kinds of events
STICK, RELEASE, REVERSE, OPEN, CLOSE = range(5)


@njit(**INNER)
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


@njit(**INNER)
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


@njit(**INNER)
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


@njit(**INNER)
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


@njit(**INNER)
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


@njit(**INNER)
def note(m: Memory, r: Record, kind: int, which: int) -> None:
    """Record an event."""
    i = m.counts[EVENTS]
    if i > 0 and m.clock[0] - r.event_time[i - 1] < MOMENT_S:
        m.counts[AT_ONCE] += 1
    else:
        m.counts[AT_ONCE] = 0
    r.event_time[i], r.event_what[i, 0], r.event_what[i, 1] = m.clock[0], kind, which
    m.counts[EVENTS] = i + 1

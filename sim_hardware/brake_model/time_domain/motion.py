"""Motion of a brake with every nonlinearity and event: slip reversal, sticking, lift-off, hardening springs.

Integrates the deviation of a brake from its steadily sliding state under given pad force, sliding speed and
friction law, with automatic steps of order 8 (`event_steps`) that end exactly where a group of contacts
sticks, releases or reverses its slip, or a contact loses or regains its load. For any brake file: cubic
springs, one-sided contacts, rigid-body motions, any number of pads. Forces of all coupling elements can be
recorded.

The mean friction force and the mean normal force are in balance with mean deformations that are not part of
the motion; where the working point changes in time, they follow it at once (quasi-statically).
A contact bears friction only while its whole normal force presses; a contact that is not `one_sided` keeps
its linear or cubic spring when it pulls (the file says so), and the event tells. Cases shorter than a quarter
of a step can be missed: shorten `longest_step_s` where grazing matters.
NOT its job: speed for long runs of linear couplings (`integrator`), energies (`energy`), files and figures.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sim_hardware.brake_model.assembly import Array, Brake
from sim_hardware.brake_model.laws import spring_force
from sim_hardware.brake_model.time_domain import event_cases as cases
from sim_hardware.brake_model.time_domain import event_forces as model
from sim_hardware.brake_model.time_domain import event_steps as steps
from sim_hardware.brake_model.time_domain.modal import FrictionGroup, friction_groups
from sim_hardware.brake_model.time_domain.reference import WorkingPoint

Kind = Literal["sticks", "releases", "reverses", "lifts off", "lands"]
_KINDS: tuple[Kind, ...] = ("sticks", "releases", "reverses", "lifts off", "lands")

#: steps between looks at whether somebody wants to interrupt
_PAUSE = 20_000
_EVENTS = 4096
_PER_SECOND = 1e4


@dataclass(frozen=True, eq=False)
class WorkingCourse:
    """Working point over time, linear between its times and constant outside.

    Attributes
    ----------
    times_s : (k,) increasing
    pad_force_n : (k,) mean normal force of one pad, >= 0
    slip_m_s : (k,) mean sliding speed, >= 0
    mu_mean, k_s_m : (k,) coefficient of friction and falling slope at the mean sliding speed
    saturation_m_s : size of speed variation at which the slope fades (`friction`); None: linear law (eq 28)
    static_mu : largest coefficient that sticking holds; None: the limit of the law at standstill

    Raises
    ------
    ValueError
        shapes differ, times not increasing, values negative or not finite
    """

    times_s: Array
    pad_force_n: Array
    slip_m_s: Array
    mu_mean: Array
    k_s_m: Array
    saturation_m_s: float | None = None
    static_mu: float | None = None

    def __post_init__(self) -> None:
        names = ("times_s", "pad_force_n", "slip_m_s", "mu_mean", "k_s_m")
        for name in names:
            object.__setattr__(self, name, np.atleast_1d(np.asarray(getattr(self, name), dtype=float)))
        shapes = {name: getattr(self, name).shape for name in names}
        if len(set(shapes.values())) != 1 or self.times_s.ndim != 1:
            raise ValueError(f"working course: arrays of unequal shapes {shapes}; give one value per time")
        for name in names:
            values = getattr(self, name)
            if not np.isfinite(values).all() or (name != "times_s" and values.min() < 0.0):
                raise ValueError(f"working course: {name} is negative or not finite; correct it")
        if (np.diff(self.times_s) <= 0.0).any():
            raise ValueError("working course: times_s must increase; sort them and keep each once")
        for name in ("saturation_m_s", "static_mu"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value >= 0.0):
                raise ValueError(f"working course: {name} is {value!r}; give a positive number or None")
        if self.saturation_m_s == 0.0:
            raise ValueError("working course: saturation_m_s is 0; give a positive speed or None")

    @staticmethod
    def constant(point: WorkingPoint, *, static_mu: float | None = None) -> WorkingCourse:
        """The same working point at all times."""
        law, inverse = point.law, point.law.inverse_saturation_s_m
        return WorkingCourse(
            np.zeros(1),
            np.array([point.pad_force_n]),
            np.array([point.slip_m_s]),
            np.array([law.mu_mean]),
            np.array([law.slope_s_m]),
            1.0 / inverse if inverse else None,
            static_mu,
        )

    def at(self, times_s: Array) -> Array:
        """(len(times), 4) pad force, mu, sliding speed, slope at given times."""
        values = (self.pad_force_n, self.mu_mean, self.slip_m_s, self.k_s_m)
        return np.stack([np.interp(times_s, self.times_s, v) for v in values], axis=-1)


@dataclass(frozen=True, slots=True)
class Event:
    """What happened when: a friction group sticks, releases or reverses its slip; a contact lifts off or
    lands.

    `where`: name of the friction group or the contact.
    """

    time_s: float
    where: str
    kind: Kind


@dataclass(frozen=True, eq=False)
class CouplingForces:
    """Forces of all coupling elements over time, as they act on the second body, deviations from the mean.

    Attributes
    ----------
    elements, torsions : names
    forces_n : (n_times, n_elements, 2) along the element's axes x and y; at contacts x is friction and y
        normal. The friction of a sticking group is shared among its contacts as the normal forces are (only
        the sum has an effect)
    moments_nm : (n_times, n_torsions)
    """

    elements: tuple[str, ...]
    forces_n: Array
    torsions: tuple[str, ...]
    moments_nm: Array


@dataclass(frozen=True, eq=False)
class Motion:
    """What `integrate` found. N times, G friction groups, C contacts.

    Attributes
    ----------
    times_s : (N,)
    states : (N, 2 n_dof) displacements and velocities from the steadily sliding state
    groups : names of the friction groups: the pad, with its contacts where a pad has several groups
    friction_n : (N, G) whole friction force on the pad along x
    normal_n : (N, C) whole normal force of each contact
    sliding : (N, G) 1 slides forwards, -1 backwards, 0 sticks
    sliding_speed_m_s : (N, G) speed of the disc under the contacts
    events : in order of time
    steps, rejected : integration steps taken and repeated
    coupling_forces : where asked for
    """

    brake: Brake
    course: WorkingCourse
    always_sliding: bool
    times_s: Array
    states: Array
    groups: tuple[str, ...]
    friction_n: Array
    normal_n: Array
    sliding: NDArray[np.int64]
    sliding_speed_m_s: Array
    events: tuple[Event, ...]
    steps: int
    rejected: int
    coupling_forces: CouplingForces | None = field(default=None)

    def sticking_s(self, group: int) -> Array:
        """(m, 2) begin and end of each time in which a friction group sticks, from the events."""
        begins = [float(self.times_s[0])] if self.sliding[0, group] == 0 else []
        ends: list[float] = []
        for event in self.events:
            if event.where == self.groups[group]:
                if event.kind == "sticks":
                    begins.append(event.time_s)
                elif event.kind == "releases" and len(ends) < len(begins):
                    ends.append(event.time_s)
        ends += [float(self.times_s[-1])] * (len(begins) - len(ends))
        return np.array([begins, ends]).T


def integrate(
    brake: Brake,
    point: WorkingPoint | WorkingCourse,
    state: ArrayLike,
    times_s: ArrayLike,
    *,
    rtol: float = 1e-8,
    atol_m: float = 1e-14,
    always_sliding: bool = False,
    record_forces: bool = False,
    longest_step_s: float = math.inf,
    most_steps: int = 10_000_000,
) -> Motion:
    """Integrate a brake with all events.

    Parameters
    ----------
    brake : any brake
    point : constant working point, or a course over time
    state : (2 n_dof,) displacements and velocities at times_s[0], from the steadily sliding state
    times_s : (N,) increasing; results are given there (dense output), the steps choose themselves
    rtol, atol_m : tolerance of a step, relative and absolute (m, rad; of velocities 1e4 1/s times as much)
    always_sliding : the paper's law (section 2.1): friction mu N towards +x always, no reversal, sticking or
        lift-off, however large the motion; no events. A one-sided contact is refused then
    record_forces : fill `coupling_forces`
    longest_step_s, most_steps : limits

    Raises
    ------
    ValueError
        wrong shapes, values not finite, `always_sliding` with one-sided contacts
    ArithmeticError
        the motion is not finite, needs too small or too many steps, or its events chatter
    """
    times, start = np.asarray(times_s, dtype=float), np.asarray(state, dtype=float)
    _check(brake, times, start, rtol, atol_m, longest_step_s, always_sliding)
    course = WorkingCourse.constant(point) if isinstance(point, WorkingPoint) else point
    groups = friction_groups(brake)
    knots = _knots(course, times)
    tables = _tables(
        brake, groups, course, knots, np.array([rtol, atol_m, _PER_SECOND * atol_m]),
        always_sliding=always_sliding, longest_step_s=min(longest_step_s, float(times[-1] - times[0])),
        most_steps=most_steps,
    )  # fmt: skip
    n, n_contacts = brake.n_dof, len(brake.contacts)
    memory = model.Memory(
        start.copy(), np.array([times[0], 0.0]), np.ones(len(groups), dtype=np.int64),
        np.ones(n_contacts, dtype=np.int64), np.zeros(6, dtype=np.int64),
    )  # fmt: skip
    record = model.Record(
        times, np.empty((len(times), 2 * n)), np.empty((len(times), len(groups))),
        np.empty((len(times), n_contacts)), np.empty((len(times), len(groups)), dtype=np.int64),
        np.empty(_EVENTS), np.empty((_EVENTS, 2), dtype=np.int64),
    )  # fmt: skip
    names = group_names(groups)
    events = _run(brake, tables, memory, record, names)
    slip_rows = np.array([group.slip_row for group in groups])
    speed = course.at(times)[:, 2:3] - record.states[:, n:] @ slip_rows.T
    motion = Motion(
        brake, course, always_sliding, times, record.states, names, record.friction, record.normal,
        record.sliding, speed, events, int(memory.counts[model.STEPS]), int(memory.counts[model.REJECTED]),
    )  # fmt: skip
    if record_forces:
        object.__setattr__(motion, "coupling_forces", _coupling_forces(motion, groups))
    return motion


def group_names(groups: tuple[FrictionGroup, ...]) -> tuple[str, ...]:
    """Name of each friction group: its pad, with its contacts where the pad has several groups."""
    pads = [group.pad for group in groups]
    return tuple(
        g.pad if pads.count(g.pad) == 1 else f"{g.pad}:{'+'.join(c.name for c in g.contacts)}" for g in groups
    )


def _check(
    brake: Brake, times: Array, state: Array, rtol: float, atol_m: float, longest: float, always_sliding: bool
) -> None:
    if times.ndim != 1 or len(times) < 2 or not np.isfinite(times).all() or (np.diff(times) <= 0.0).any():
        raise ValueError(f"times_s of shape {times.shape}: give at least two increasing, finite times")
    if state.shape != (2 * brake.n_dof,) or not np.isfinite(state).all():
        raise ValueError(f"state of shape {state.shape}: give {2 * brake.n_dof} finite values")
    if not (0.0 < rtol < 0.1 and atol_m > 0.0 and longest > 0.0):
        raise ValueError(
            f"rtol {rtol!r}, atol_m {atol_m!r}, longest_step_s {longest!r}: give positive "
            "numbers, rtol below 0.1"
        )
    loose = [c.name for c in brake.contacts if c.one_sided]
    if always_sliding and loose:
        raise ValueError(
            f"always_sliding knows no lift-off, and the contact '{loose[0]}' is one_sided; drop either"
        )


def _knots(course: WorkingCourse, times: Array) -> Array:
    """Times between which the working point is linear, at least two."""
    inside = course.times_s[(course.times_s > times[0]) & (course.times_s < times[-1])]
    return np.unique(np.concatenate([times[:1], inside, times[-1:]]))


def _tables(
    brake: Brake,
    groups: tuple[FrictionGroup, ...],
    course: WorkingCourse,
    knots: Array,
    tolerance: Array,
    *,
    always_sliding: bool,
    longest_step_s: float,
    most_steps: int,
) -> model.Tables:
    n = brake.n_dof
    stiffness, damping = np.zeros((n, n)), np.zeros((n, n))
    cubic: list[tuple[Array, float]] = []
    for element in brake.elements:
        for axis, row in enumerate((element.row_x, element.row_y)):
            if element.side:
                continue
            stiffness += element.stiffness_n_m[axis] * np.outer(row, row)
            damping += element.damping_ns_m[axis] * np.outer(row, row)
            cubic.append((row, element.cubic_n_m3[axis]))
    for torsion in brake.torsions:
        stiffness += torsion.stiffness_nm_rad * np.outer(torsion.row, torsion.row)
        damping += torsion.damping_nms_rad * np.outer(torsion.row, torsion.row)
        cubic.append((torsion.row, torsion.cubic_nm_rad3))
    cubic = [(row, value) for row, value in cubic if value]
    contacts = brake.contacts
    slip_rows = np.array([group.slip_row for group in groups])
    inverse = 1.0 / brake.inertia
    owner = {contact.name: g for g, group in enumerate(groups) for contact in group.contacts}
    return model.Tables(
        linear=np.ascontiguousarray(-(inverse[:, None] * np.hstack([stiffness, damping])).T),
        inverse_inertia=inverse,
        cubic_rows=np.array([row for row, _ in cubic]).reshape(-1, n),
        cubic=np.array([value for _, value in cubic]),
        normal_rows=np.array([c.side * c.row_y for c in contacts]),
        stiffness=np.array([c.stiffness_n_m[1] for c in contacts]),
        hardening=np.array([c.cubic_n_m3[1] for c in contacts]),
        damping=np.array([c.damping_ns_m[1] for c in contacts]),
        one_sided=np.array([int(c.one_sided) for c in contacts]),
        share=np.array([c.load_share for c in contacts]),
        group=np.array([owner[c.name] for c in contacts]),
        slip_rows=slip_rows,
        mobility=slip_rows @ (inverse[:, None] * slip_rows.T),
        knots=knots,
        course=np.ascontiguousarray(course.at(knots)),
        inverse_saturation=1.0 / course.saturation_m_s if course.saturation_m_s else 0.0,
        static_mu=-1.0 if course.static_mu is None else float(course.static_mu),
        always_sliding=always_sliding,
        tolerance=tolerance,
        most_steps=most_steps,
        longest_step_s=longest_step_s,
    )


def _run(
    brake: Brake, tables: model.Tables, memory: model.Memory, record: model.Record, groups: tuple[str, ...]
) -> tuple[Event, ...]:
    """All steps, in portions so that they can be interrupted; returns the events."""
    contacts = [contact.name for contact in brake.contacts]
    work = model.scratch(brake.n_dof, len(groups), len(contacts))
    events: list[Event] = []
    while True:
        status = steps.advance(tables, memory, record, work, _PAUSE)
        for i in range(int(memory.counts[model.EVENTS])):
            kind, which = (int(v) for v in record.event_what[i])
            where = groups[which] if kind < cases.OPEN else contacts[which]
            events.append(Event(float(record.event_time[i]), where, _KINDS[kind]))
        memory.counts[model.EVENTS] = 0
        if status not in (steps.DONE, steps.BUFFER_FULL):
            raise _failure(brake, status, memory, tables, events)
        if memory.counts[model.WRITTEN] == len(record.times):
            return tuple(events)


def _failure(
    brake: Brake, status: int, memory: model.Memory, tables: model.Tables, events: list[Event]
) -> ArithmeticError:
    what = {
        steps.NOT_FINITE: "is not finite: check the stability of the brake at this working point",
        steps.STEP_TOO_SMALL: "needs steps below rounding: raise rtol or atol_m, or look for extreme values",
        steps.TOO_MANY_STEPS: f"took {tables.most_steps} steps: shorten it, raise rtol, or raise most_steps",
        steps.CHATTER: "has events without end at one moment: raise rtol, or check contacts with no load",
    }[status]
    mu = _mu_at(memory, tables)
    if status in (steps.NOT_FINITE, steps.STEP_TOO_SMALL) and mu < 0.0:
        what = (
            f"grows beyond all bounds: the falling friction law has left its range, mu = {mu:.3g} at the "
            "slip speed reached; lower the slope k, or give a law that saturates"
        )
    last = events[-1] if events else None
    before = f"; last event: {last.where} {last.kind} at {last.time_s:.9g} s" if last else ""
    return ArithmeticError(f"the motion of brake '{brake.name}' at {memory.clock[0]:.9g} s {what}{before}")


def _mu_at(memory: model.Memory, tables: model.Tables) -> float:
    """Least coefficient of friction at the present slip speeds."""
    n = len(tables.inverse_inertia)
    _, mu, mean, slope = (float(np.interp(memory.clock[0], tables.knots, c)) for c in tables.course.T)
    beyond = np.abs(mean - tables.slip_rows @ memory.state[n:]) - mean
    return float((mu - slope * beyond / np.sqrt(1.0 + (beyond * tables.inverse_saturation) ** 2)).min())


def _coupling_forces(motion: Motion, groups: tuple[FrictionGroup, ...]) -> CouplingForces:
    """Forces of all elements from the states, and of the contacts as recorded (eqs 8, 9)."""
    brake, n = motion.brake, motion.brake.n_dof
    q, v = motion.states[:, :n], motion.states[:, n:]
    forces = np.zeros((len(q), len(brake.elements), 2))
    work = motion.course.at(motion.times_s)
    number = {contact.name: c for c, contact in enumerate(brake.contacts)}
    for e, element in enumerate(brake.elements):
        if element.side:
            whole = motion.normal_n[:, number[element.name]]
            forces[:, e, 1] = element.side * (whole - element.load_share * work[:, 0])
            continue
        for axis, row in enumerate((element.row_x, element.row_y)):
            forces[:, e, axis] = (
                spring_force(element.stiffness_n_m[axis], element.cubic_n_m3[axis], q @ row)
                + element.damping_ns_m[axis] * (v @ row)
            )  # fmt: skip
    place = {element.name: e for e, element in enumerate(brake.elements)}
    for g, group in enumerate(groups):
        loads = np.stack([motion.normal_n[:, number[c.name]] for c in group.contacts], axis=1)
        if not motion.always_sliding:
            loads = np.maximum(loads, 0.0)
        total = loads.sum(axis=1, keepdims=True)
        even = np.array([c.load_share for c in group.contacts]) / group.load_share
        parts = np.where(total != 0.0, loads / np.where(total != 0.0, total, 1.0), even)
        for i, contact in enumerate(group.contacts):
            mean = work[:, 1] * contact.load_share * work[:, 0]
            # -F acts on the pad, so friction towards +x on the pad enters with a minus
            forces[:, place[contact.name], 0] = -(parts[:, i] * motion.friction_n[:, g] - mean)
    moments = [
        spring_force(t.stiffness_nm_rad, t.cubic_nm_rad3, q @ t.row) + t.damping_nms_rad * (v @ t.row)
        for t in brake.torsions
    ]
    return CouplingForces(
        tuple(e.name for e in brake.elements),
        forces,
        tuple(t.name for t in brake.torsions),
        np.array(moments).reshape(len(brake.torsions), len(q)).T,
    )

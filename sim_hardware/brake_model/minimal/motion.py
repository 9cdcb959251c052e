"""Motion of the belt oscillator in time: slip, stick and reversed sliding, with every change located exactly.

Rules. While the mass sticks, x' = v_belt; sticking ends where |c x + d v_belt| > mu_static F_n. Where the
sliding speed v = v_belt - x' becomes 0, the mass sticks if mu_static F_n can hold it; if not, it passes
through and slides the other way (v < 0: the mass overtakes the belt). NOT its job: periodic solutions
(`cycles`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from sim_hardware.brake_model.minimal.belt import BeltOscillator
from sim_hardware.brake_model.minimal.phases import (
    Array,
    Direction,
    LinearSliding,
    Motion,
    Sticking,
    integrate_sliding,
)

Kind = Literal["slip", "stick", "reverse"]
#: relative size of a force difference that counts as none
_ROUNDING = 1e-12


@dataclass(frozen=True, slots=True)
class Phase:
    """A stretch of motion of one kind, from `start_s` to `end_s`."""

    kind: Kind
    start_s: float
    end_s: float
    motion: Motion

    @property
    def duration_s(self) -> float:
        """Its length."""
        return self.end_s - self.start_s

    @property
    def end(self) -> tuple[float, float]:
        """Position and velocity at its end."""
        x, v = self.motion.at(np.array([self.duration_s]))
        return float(x[0]), float(v[0])


@dataclass(frozen=True, slots=True)
class Trajectory:
    """Phases one after the other, from t = 0."""

    phases: tuple[Phase, ...]

    @property
    def end_s(self) -> float:
        """Length."""
        return self.phases[-1].end_s

    def share(self, kind: Kind) -> float:
        """Part of the time spent in a kind of motion."""
        return (
            sum(p.duration_s for p in self.phases if p.kind == kind) / self.end_s if self.end_s > 0.0 else 0.0
        )

    def at(self, times_s: Array) -> tuple[Array, Array]:
        """Positions (m) and velocities (m/s) at times within the trajectory, same shape.

        Raises
        ------
        ValueError
            a time before 0 or beyond the end
        """
        times = np.asarray(times_s, dtype=float)
        if times.size and (times.min() < 0.0 or times.max() > self.end_s * (1.0 + 1e-12)):
            raise ValueError(
                f"time {times.min():g} … {times.max():g} s is outside the trajectory, 0 … {self.end_s:g} s. "
                "Ask within it"
            )
        x, v = np.empty_like(times), np.empty_like(times)
        index = np.searchsorted([p.end_s for p in self.phases[:-1]], times, side="right")
        for i in np.unique(index):
            chosen = index == i
            x[chosen], v[chosen] = self.phases[i].motion.at(times[chosen] - self.phases[i].start_s)
        return x, v

    def sampled(self, points: int = 400) -> tuple[Array, Array, Array]:
        """Times, positions, velocities: about `points` of them, with every event among them."""
        pieces = [
            np.linspace(
                p.start_s, p.end_s, max(2, math.ceil(points * p.duration_s / max(self.end_s, 1e-300)) + 1)
            )
            for p in self.phases
        ]
        states = [p.motion.at(t - p.start_s) for p, t in zip(self.phases, pieces, strict=True)]
        return (
            np.concatenate(pieces),
            np.concatenate([s[0] for s in states]),
            np.concatenate([s[1] for s in states]),
        )


def simulate(
    belt: BeltOscillator,
    position_m: float,
    velocity_m_s: float,
    duration_s: float,
    *,
    max_phases: int = 100_000,
) -> Trajectory:
    """Motion from an initial state over `duration_s`, each phase located to rounding (affine laws) or 1e-11.

    Raises
    ------
    ValueError
        a value that is not finite, no duration, or more than `max_phases` phases
    """
    for name, value in (
        ("position_m", position_m),
        ("velocity_m_s", velocity_m_s),
        ("duration_s", duration_s),
    ):
        if not math.isfinite(value):
            raise ValueError(f"{name} = {value:g}: not a finite number. Give one")
    if duration_s <= 0.0:
        raise ValueError(f"duration_s = {duration_s:g}: there is nothing to simulate. Give a time above 0")
    walker = Walker(belt, position_m, velocity_m_s)
    while walker.time_s < duration_s:
        if len(walker.phases) >= max_phases:
            raise ValueError(
                f"duration_s = {duration_s:g}: more than {max_phases} phases until {walker.time_s:g} s. "
                "Ask for a shorter time"
            )
        walker.advance(duration_s)
    return Trajectory(tuple(walker.phases))


class Walker:
    """Goes through the motion phase by phase; `phases` are those behind it."""

    def __init__(self, belt: BeltOscillator, position_m: float, velocity_m_s: float) -> None:
        self.belt = belt
        self.position_m, self.velocity_m_s = position_m, velocity_m_s
        self.time_s = 0.0
        self.phases: list[Phase] = []
        self._kind: Kind = self._first_kind()
        self._acceleration: float | None = None

    @property
    def kind(self) -> Kind:
        """Kind of the phase ahead."""
        return self._kind

    def release(self) -> None:
        """Let the mass go from where sticking has just ended: it slides back with what friction lacks."""
        self._kind = "slip"
        lack = self.belt.law.sliding(0.0) - self.belt.law.mu_static
        self._acceleration = lack * self.belt.normal_force_n / self.belt.mass_kg

    def advance(self, until_s: float, *, turn: bool = False) -> bool:
        """Go through the next phase, at most to the time `until_s`.

        With `turn`: stop also where the mass turns back (x' = 0 downwards) and return True if it did.
        """
        limit = until_s - self.time_s
        if self._kind == "stick":
            self._stick(limit)
            return False
        return self._slide(limit, turn)

    def _first_kind(self) -> Kind:
        if self.velocity_m_s == self.belt.belt_speed_m_s:
            return self._kind_at_rest()
        return "slip" if self.velocity_m_s < self.belt.belt_speed_m_s else "reverse"

    def _kind_at_rest(self) -> Kind:
        """Which phase follows where v = 0: sticking if friction can hold the mass."""
        belt = self.belt
        force = belt.stiffness_n_m * self.position_m + belt.damping_ns_m * belt.belt_speed_m_s
        if abs(force) <= belt.holding_force_n * (1.0 + _ROUNDING):
            return "stick"
        return "slip" if force > 0.0 else "reverse"

    def _add(self, duration_s: float, motion: Motion, velocity_m_s: float | None = None) -> None:
        phase = Phase(self._kind, self.time_s, self.time_s + duration_s, motion)
        self.phases.append(phase)
        self.time_s = phase.end_s
        self.position_m, self.velocity_m_s = phase.end
        if velocity_m_s is not None:
            self.velocity_m_s = velocity_m_s

    def _stick(self, limit_s: float) -> None:
        belt = self.belt
        speed = belt.belt_speed_m_s
        duration = math.inf
        if speed > 0.0 and belt.stiffness_n_m > 0.0:
            duration = max(0.0, (belt.stick_end_m - self.position_m) / speed)
        motion = Sticking(self.position_m, speed)
        self._add(min(duration, limit_s), motion)
        if duration <= limit_s:
            self.position_m = belt.stick_end_m
            self.release()

    def _slide(self, limit_s: float, turn: bool) -> bool:
        belt = self.belt
        forward = self._kind == "slip"
        sign = 1.0 if forward else -1.0
        speed = belt.belt_speed_m_s
        levels: tuple[tuple[float, Direction], ...] = ((speed, 1 if forward else -1),)
        if turn and forward:
            levels = (*levels, (0.0, -1))
        affine = belt.law.affine
        if affine is not None:
            motion, duration, crossed = self._closed(affine, sign, levels, limit_s)
        else:
            motion, duration, crossed = self._integrated(sign, levels, limit_s)
        if crossed is None:
            self._add(limit_s, motion)
            self._acceleration = None
            return False
        self._add(duration, motion, levels[crossed][0])
        self._acceleration = None
        if crossed == 1:
            return True
        self._kind = self._kind_at_rest()
        return False

    def _closed(
        self,
        affine: tuple[float, float],
        sign: float,
        levels: tuple[tuple[float, Direction], ...],
        limit_s: float,
    ) -> tuple[Motion, float, int | None]:
        belt = self.belt
        a, b = affine
        force = belt.normal_force_n
        damping = belt.damping_ns_m + force * b  # mu = a + b |v|: the slope acts as a damper (eqs 29-31)
        push = force * (sign * a + b * belt.belt_speed_m_s)
        acceleration = self._acceleration
        if acceleration is None:
            pull = damping * self.velocity_m_s + belt.stiffness_n_m * self.position_m
            acceleration = (push - pull) / belt.mass_kg
        motion = LinearSliding(
            delta_1_s=0.5 * damping / belt.mass_kg,
            w2_1_s2=belt.stiffness_n_m / belt.mass_kg,
            position_m=self.position_m,
            velocity_m_s=self.velocity_m_s,
            acceleration_m_s2=acceleration,
        )
        found: int | None = None
        duration = limit_s
        for i, (level, direction) in enumerate(levels):
            time = motion.crossing(level, direction, duration)
            if time is not None:
                found, duration = i, time
        return motion, duration, found

    def _integrated(
        self, sign: float, levels: tuple[tuple[float, Direction], ...], limit_s: float
    ) -> tuple[Motion, float, int | None]:
        belt = self.belt
        mass, damping, stiffness = belt.mass_kg, belt.damping_ns_m, belt.stiffness_n_m
        force, speed, sliding = belt.normal_force_n, belt.belt_speed_m_s, belt.law.sliding

        def acceleration(x: float, v: float) -> float:
            return (sign * force * sliding(sign * (speed - v)) - damping * v - stiffness * x) / mass

        omega = belt.angular_frequency_1_s
        period = 2.0 * math.pi / omega if omega > 0.0 else math.inf
        size_v = max(abs(self.velocity_m_s), speed, 1e-300)
        size_x = max(abs(self.position_m), size_v / omega if omega > 0.0 else size_v * limit_s)
        return integrate_sliding(
            acceleration,
            self.position_m,
            self.velocity_m_s,
            levels,
            limit_s=limit_s,
            period_s=period,
            scales=(size_x, size_v),
        )

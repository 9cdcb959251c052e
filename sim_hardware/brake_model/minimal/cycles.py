"""Limit cycles of the belt oscillator, regions of its phase plane, frequency over belt speed (section 1.1).

Everything follows from one map: amplitude a of a turn (x' = 0, spring side) to that of the next turn, P(a).
Fixed points are limit cycles, P(a) > a diverges, P(a) < a contracts. The stick-slip cycle needs no search:
after sticking the mass always leaves from the same state, so one turn from there is the cycle. In the plane
trajectories cannot cross: what does not stick within one turn after sticking never does again.
NOT its job: single phases (`phases`, `motion`), figures.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from sim_hardware.brake_model.minimal.belt import BeltOscillator
from sim_hardware.brake_model.minimal.laws import CoulombLaw, LinearFallingLaw
from sim_hardware.brake_model.minimal.motion import Phase, Trajectory, Walker
from sim_hardware.brake_model.minimal.phases import Array, root_between

CycleKind = Literal["stick-slip", "sliding", "reversing"]
Behaviour = Literal["diverging", "contracting", "neutral"]

#: |P(a) / a - 1| below which a turn counts as closed
_NEUTRAL = 1e-9
#: the same at a fixed point that is one; a jump of P (touching v = 0) leaves more
_CLOSED = 1e-6
#: periods after which a sliding mass that has not come back never will
_PATIENCE = 20.0


@dataclass(frozen=True, slots=True)
class LimitCycle:
    """A periodic motion.

    Attributes
    ----------
    kind : with sticking; sliding one way only; sliding both ways
    period_s : duration of one turn
    turn_m : distance of its turning point from the equilibrium
    amplitude_m : half the distance between its extreme positions
    stick_share : part of the period spent sticking
    slip_speed_max_m_s : largest |v_belt - x'|
    law_valid : whether mu stays positive up to that speed
    multiplier : dP/da, |.| < 1: stable; 0 where the mass sticks: reached within finite time
    trajectory : one period
    """

    kind: CycleKind
    period_s: float
    turn_m: float
    amplitude_m: float
    stick_share: float
    slip_speed_max_m_s: float
    law_valid: bool
    multiplier: float
    trajectory: Trajectory

    @property
    def frequency_hz(self) -> float:
        """1 / period."""
        return 1.0 / self.period_s

    @property
    def stable(self) -> bool:
        """Whether neighbouring motions come closer."""
        return abs(self.multiplier) < 1.0


@dataclass(frozen=True, slots=True)
class Region:
    """Range of amplitudes of turns (m, from the equilibrium) in which motions behave alike."""

    from_m: float
    to_m: float
    behaviour: Behaviour


@dataclass(frozen=True, slots=True)
class PhasePlane:
    """Cycles by amplitude, and the regions between 0 and the largest amplitude looked at."""

    cycles: tuple[LimitCycle, ...]
    regions: tuple[Region, ...]


def next_turn_m(belt: BeltOscillator, amplitude_m: float) -> float:
    """P(a): distance from the equilibrium of the turn after a turn at distance `amplitude_m` > 0.

    0 where the mass comes to rest without turning, inf where it runs away.
    """
    walker = _walk_to_turn(belt, amplitude_m)
    if walker is None:
        return 0.0 if belt.effective_damping_ns_m >= 0.0 else math.inf
    return walker.position_m - belt.equilibrium_m


def stick_slip_cycle(belt: BeltOscillator) -> LimitCycle | None:
    """The cycle that begins where sticking ends, or None where the mass never sticks again after that.

    Raises
    ------
    ValueError
        no stiffness or belt at rest
    """
    _need_motion(belt)
    if _runs_away(belt) or belt.normal_force_n == 0.0:
        return None
    walker = Walker(belt, belt.stick_end_m, belt.belt_speed_m_s)
    walker.release()
    limit = _patience_s(belt)
    turns = 0
    while turns < 2 and walker.time_s < limit:  # the first turn is on the way down
        turns += walker.advance(limit, turn=True)
        if walker.phases[-1].kind == "stick" and walker.kind == "slip":
            return _described(belt, Trajectory(tuple(walker.phases)), multiplier=0.0)
    return None


def phase_plane(
    belt: BeltOscillator, amplitude_max_m: float | None = None, points: int | None = None
) -> PhasePlane:
    """All limit cycles and regions up to an amplitude.

    Parameters
    ----------
    amplitude_max_m : largest distance of a turn from the equilibrium; where None well beyond the range that
        friction can hold, and beyond the amplitude at which reversed sliding balances a negative damping
    points : amplitudes tried, spaced by equal ratios; cycles closer together than two of them are missed

    Raises
    ------
    ValueError
        no stiffness or belt at rest
    """
    _need_motion(belt)
    if _runs_away(belt):  # no turn at all
        return PhasePlane((), (Region(0.0, math.inf, "diverging"),))
    low = 1e-3 * belt.belt_speed_m_s / belt.angular_frequency_1_s
    high = amplitude_max_m if amplitude_max_m is not None else default_amplitude_m(belt)
    if not low < high < math.inf:
        raise ValueError(
            f"amplitude_max_m = {high:g}: the search begins at {low:g} m (a thousandth of v_belt / omega). "
            "Give a finite amplitude above it"
        )
    grid = np.geomspace(low, high, points or (160 if belt.law.affine is not None else 48))
    behaviours: list[Behaviour] = [_behaviour(belt, float(a)) for a in grid]
    cycles: list[LimitCycle] = []
    regions: list[Region] = []
    begin = 0.0
    for i in range(1, grid.size):
        if behaviours[i] == behaviours[i - 1]:
            continue
        boundary, cycle = _boundary(
            belt, float(grid[i - 1]), float(grid[i]), behaviours[i - 1], behaviours[i]
        )
        regions.append(Region(begin, boundary, behaviours[i - 1]))
        begin = boundary
        if cycle is not None:
            cycles.append(cycle)
    regions.append(Region(begin, high, behaviours[-1]))
    return PhasePlane(tuple(cycles), tuple(regions))


def default_amplitude_m(belt: BeltOscillator) -> float:
    """Amplitude up to which `phase_plane` looks by default."""
    holding = belt.holding_force_n / belt.stiffness_n_m
    size = 6.0 * (holding + belt.belt_speed_m_s / belt.angular_frequency_1_s)
    affine = belt.law.affine
    if affine is not None and belt.effective_damping_ns_m < 0.0:
        # for large amplitudes friction takes 4 mu F a per turn, the slope gives 2 pi |D| c a^2
        size = max(size, 4.0 * holding / (2.0 * math.pi * abs(belt.damping_ratio)) * 2.5)
    return size


@dataclass(frozen=True, slots=True)
class SpeedCurve:
    """Limit cycle over the belt speed; nan where there is none. All arrays of one shape (n,).

    Attributes
    ----------
    speeds_m_s, frequency_hz, amplitude_m, stick_share : of the stable cycle
    kinds : of the cycles, "" where none
    law_valid : whether mu stays positive in the cycle
    """

    speeds_m_s: Array
    frequency_hz: Array
    amplitude_m: Array
    stick_share: Array
    kinds: tuple[str, ...]
    law_valid: tuple[bool, ...]

    @property
    def exists(self) -> NDArrayBool:
        """Where there is a cycle, (n,)."""
        return np.isfinite(self.frequency_hz)

    @property
    def spread(self) -> float:
        """(largest - smallest) / mean frequency of the stick-slip cycles; nan where fewer than two."""
        f = self.frequency_hz[np.array([kind == "stick-slip" for kind in self.kinds], dtype=bool)]
        return float((f.max() - f.min()) / f.mean()) if f.size > 1 else math.nan


NDArrayBool = np.ndarray[tuple[int, ...], np.dtype[np.bool_]]


def frequency_over_speed(
    belt: BeltOscillator, speeds_m_s: ArrayLike, progress: Callable[[int], None] | None = None
) -> SpeedCurve:
    """Frequency of the stable limit cycle at several belt speeds: the argument of section 1.1.

    The stick-slip cycle where there is one, else a stable cycle without sticking.

    Raises
    ------
    ValueError
        no stiffness, no speeds, or a speed that is not above 0
    """
    speeds = np.atleast_1d(np.asarray(speeds_m_s, dtype=float))
    if not speeds.size or not np.all(np.isfinite(speeds)) or speeds.min() <= 0.0:
        raise ValueError(f"speeds_m_s = {speeds.tolist()}: not all above 0. Give belt speeds above 0 m/s")
    cycles: list[LimitCycle | None] = []
    for i, speed in enumerate(speeds):
        cycles.append(stable_cycle(belt.with_speed(float(speed))))
        if progress is not None:
            progress(i + 1)

    def values(of: Callable[[LimitCycle], float]) -> Array:
        return np.array([of(c) if c is not None else math.nan for c in cycles])

    return SpeedCurve(
        speeds_m_s=speeds,
        frequency_hz=values(lambda c: c.frequency_hz),
        amplitude_m=values(lambda c: c.amplitude_m),
        stick_share=values(lambda c: c.stick_share),
        kinds=tuple(c.kind if c is not None else "" for c in cycles),
        law_valid=tuple(c is None or c.law_valid for c in cycles),
    )


def stable_cycle(belt: BeltOscillator) -> LimitCycle | None:
    """The stick-slip cycle, else the smallest stable cycle without sticking, else None."""
    cycle = stick_slip_cycle(belt)
    if cycle is not None or (belt.law.affine is not None and belt.effective_damping_ns_m >= 0.0):
        return cycle
    return next((c for c in phase_plane(belt).cycles if c.stable), None)


def largest_one_way_speed(belt: BeltOscillator) -> float:
    """Belt speed (m/s) up to which the stick-slip cycle of a linear falling law slides one way only; 0: no
    cycle.

    Under eq 28 everything measured from the equilibrium is proportional to the belt speed: the frequency does
    not depend on it, and one slip decides. It ends at c x + d v = mu_0 F_n - g v, and can stick while that is
    above -mu_0 F_n. Beyond, the mass overtakes the belt before it sticks, and the frequency depends on the
    speed.

    Raises
    ------
    ValueError
        another law, no stiffness
    """
    if not isinstance(belt.law, LinearFallingLaw):
        raise ValueError(
            f"law = {belt.law.law}: only the linear law has this closed limit. Search over speeds instead"
        )
    test = belt.with_speed(
        1e-6 * belt.angular_frequency_1_s * max(belt.holding_force_n / belt.stiffness_n_m, 1e-300)
    )
    cycle = stick_slip_cycle(test)
    if cycle is None:
        return 0.0
    landing = next(p for p in cycle.trajectory.phases if p.kind == "stick").motion.at(np.zeros(1))[0][0]
    force = belt.stiffness_n_m * landing + belt.damping_ns_m * test.belt_speed_m_s
    return float(2.0 * belt.holding_force_n * test.belt_speed_m_s / (belt.holding_force_n - force))


def coulomb_period_s(belt: BeltOscillator) -> float:
    """Closed formula for the period of the undamped Coulomb stick-slip cycle.

    T = 2 (pi - atan(omega D / v)) / omega + 2 D / v,   D = (mu_s - mu_d) F_n / c

    Raises
    ------
    ValueError
        another law, or damping
    """
    if not isinstance(belt.law, CoulombLaw) or belt.damping_ns_m != 0.0:
        raise ValueError(
            f"law = {belt.law.law}, damping_ns_m = {belt.damping_ns_m:g}: the formula is for Coulomb "
            "friction without damping. Use stick_slip_cycle"
        )
    _need_motion(belt)
    drop = (belt.law.mu_static - belt.law.mu_dynamic) * belt.normal_force_n / belt.stiffness_n_m
    omega, speed = belt.angular_frequency_1_s, belt.belt_speed_m_s
    return 2.0 * (math.pi - math.atan(omega * drop / speed)) / omega + 2.0 * drop / speed


def orbit(belt: BeltOscillator, amplitude_m: float) -> Trajectory | None:
    """One turn from a turn at a distance from the equilibrium to the next, or None where there is no next."""
    walker = _walk_to_turn(belt, amplitude_m)
    return None if walker is None else Trajectory(tuple(walker.phases))


def _need_motion(belt: BeltOscillator) -> None:
    _ = belt.equilibrium_m  # raises where there is none


def _runs_away(belt: BeltOscillator) -> bool:
    """Whether sliding is a monotone departure: closed solution with D <= -1."""
    return belt.law.affine is not None and belt.damping_ratio <= -1.0


def _patience_s(belt: BeltOscillator) -> float:
    period = 2.0 * math.pi / belt.angular_frequency_1_s
    affine = belt.law.affine
    damping = belt.damping_ratio if affine is not None else 0.0
    if abs(damping) < 1.0:
        period /= math.sqrt(1.0 - damping**2)
    sticking = 2.0 * belt.holding_force_n / (belt.stiffness_n_m * belt.belt_speed_m_s)
    return (3.0 if affine is not None else _PATIENCE) * period + 2.0 * sticking


def _walk_to_turn(belt: BeltOscillator, amplitude_m: float) -> Walker | None:
    walker = Walker(belt, belt.equilibrium_m + amplitude_m, 0.0)
    limit = _patience_s(belt)
    while walker.time_s < limit:
        if walker.advance(limit, turn=True):
            return walker
    return None


def _behaviour(belt: BeltOscillator, amplitude_m: float) -> Behaviour:
    ratio = next_turn_m(belt, amplitude_m) / amplitude_m - 1.0
    if abs(ratio) < _NEUTRAL:
        return "neutral"
    return "diverging" if ratio > 0.0 else "contracting"


def _boundary(
    belt: BeltOscillator, low_m: float, high_m: float, below: Behaviour, above: Behaviour
) -> tuple[float, LimitCycle | None]:
    """Amplitude between two behaviours, and the cycle there if the map is continuous."""
    if "neutral" in (below, above):
        while high_m - low_m > 1e-10 * high_m:
            middle = 0.5 * (low_m + high_m)
            if _behaviour(belt, middle) == below:
                low_m = middle
            else:
                high_m = middle
        return high_m, None

    def growth(amplitude_m: float) -> float:
        return max(-1.0, min(1.0, next_turn_m(belt, amplitude_m) / amplitude_m - 1.0))

    amplitude = root_between(growth, low_m, high_m)
    if abs(growth(amplitude)) > _CLOSED:
        return amplitude, None  # the motion that touches v = 0 without sticking
    turn = orbit(belt, amplitude)
    if turn is None:
        return amplitude, None
    if turn.share("stick") > 0.0:
        return amplitude, stick_slip_cycle(belt)
    step = 1e-5 * amplitude
    multiplier = (next_turn_m(belt, amplitude + step) - next_turn_m(belt, amplitude - step)) / (2.0 * step)
    return amplitude, _described(belt, turn, multiplier)


def _described(belt: BeltOscillator, trajectory: Trajectory, multiplier: float) -> LimitCycle:
    x, v = _extremes(belt, trajectory.phases)
    slips = np.abs(belt.belt_speed_m_s - v)
    kinds = {phase.kind for phase in trajectory.phases if phase.duration_s > 0.0}
    kind: CycleKind = "stick-slip" if "stick" in kinds else "reversing" if "reverse" in kinds else "sliding"
    return LimitCycle(
        kind=kind,
        period_s=trajectory.end_s,
        turn_m=float(x.max()) - belt.equilibrium_m,
        amplitude_m=0.5 * float(x.max() - x.min()),
        stick_share=trajectory.share("stick"),
        slip_speed_max_m_s=float(slips.max()),
        law_valid=bool(slips.max() < belt.law.zero_speed_m_s),
        multiplier=float(multiplier),
        trajectory=trajectory,
    )


def _extremes(belt: BeltOscillator, phases: tuple[Phase, ...]) -> tuple[Array, Array]:
    """Positions and velocities with the extremes among them: finely sampled, then sharpened by a parabola."""
    positions, velocities = [], []
    for phase in phases:
        t = np.linspace(0.0, phase.duration_s, 721)
        x, v = phase.motion.at(t)
        for values, kept in ((x, positions), (v, velocities)):
            kept.append(values)
            for i in (int(np.argmax(values)), int(np.argmin(values))):
                if 0 < i < values.size - 1:
                    left, middle, right = values[i - 1 : i + 2]
                    bend = left - 2.0 * middle + right
                    if bend != 0.0:
                        kept.append(np.array([middle - (right - left) ** 2 / (8.0 * bend)]))
    return np.concatenate(positions), np.concatenate(velocities)

"""Squeal beyond its onset: limit cycles over a quantity, from small and from large starts, and slow ramps.

At every value of a quantity (pressure, friction, slope, sliding speed or a parameter of the brake) the brake
is integrated as a lane of a batch until its motion is steady. Where small and large starts end differently
the squeal is subcritical: on a slow ramp it sets in later than it ends. The limit cycle is bounded by what
the friction law says: a slope that fades with the variation of speed (saturating law), or only by the
reversal of slip and by lift-off (linear law, eq 28).
NOT its job: how fast the lanes run (`batch`), the linear onset in detail (`stability`), sound pressure (the
caller gives weights of outputs), figures.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.assembly import Array, Brake
from sim_hardware.brake_model.time_domain.batch_serial import batch_of
from sim_hardware.brake_model.time_domain.modal import friction_groups
from sim_hardware.brake_model.time_domain.squeal_points import (
    WORKING_QUANTITIES,
    CriticalMode,
    SquealPoints,
    critical_mode,
)

RATE_HZ = 40_000
#: window of one amplitude, and of the last measurement (intervals of 25 us)
_WINDOW, _MEASURED = RATE_HZ // 20, RATE_HZ // 10
#: time to the next value when a motion is carried on
_STEP = RATE_HZ // 10
#: a motion is steady when its amplitude changes more slowly than this (1/s) in so many windows in a row
_STEADY_1_S, _CALM_WINDOWS = 0.1, 4
#: amplitudes relative to the scale of the law: smaller is no squeal; smaller still is silence
_SQUEAL, _SILENT = 3e-3, 1e-7
#: starts relative to the scale of the law, and to the sliding speed
_SMALL, _LARGE = 1e-3, 1.0
#: growth in time: first amplitude, end of the linear range (relative to the scale), windows of 10 ms
_SEED, _LINEAR, _SHORT, _SHORTS, _FITTED = 1e-9, 3e-3, RATE_HZ // 100, 40, 8

Start = Literal["small", "large"]
Verdict = Literal["none", "supercritical", "sudden", "subcritical"]
Bools = NDArray[np.bool_]


@dataclass(frozen=True)
class LimitCycles:
    """Steady motions at the points; all (n,).

    Attributes
    ----------
    squeals : a vibration larger than 0.3 % of the scale that is not dying away as a small one does
    settled : the amplitude was steady before the time was over
    slip_amplitude_m_s : half of peak to peak of the slip, of the pad that moves more
    surface_velocity_m_s, surface_acceleration_m_s2 : rms of the disc along y
    frequency_hz : of the disc's motion; not a number where silent
    stuck_share, lifted_share : part of the time in which a pad sticks, in which a pad's normal force is zero
    radiated : rms of the weighted sum the caller asked for (sound pressure, Pa); zero without
    growth_time_s : from the start to 90 % of the final amplitude, for what squeals
    """

    squeals: Bools
    settled: Bools
    slip_amplitude_m_s: Array
    surface_velocity_m_s: Array
    surface_acceleration_m_s2: Array
    frequency_hz: Array
    stuck_share: Array
    lifted_share: Array
    radiated: Array
    growth_time_s: Array


class SquealSimulation:
    """Batch of a set of points with the outputs this module needs.

    Parameters
    ----------
    points : working points
    radiation : weights of outputs ("disc.y": Pa per m/s2) whose sum is the sound; None: no sound
    """

    def __init__(self, points: SquealPoints, radiation: Mapping[str, float] | None = None) -> None:
        self.points = points
        self.mode = critical_mode(points)
        disc = _disc(points.brakes[0])
        pads = tuple(dict.fromkeys(group.pad for group in friction_groups(points.brakes[0])))
        own = [f"{pad}:slip" for pad in pads] + [f"{disc}.y:velocity", f"{disc}.y"]
        own += [f"{pad}:normal" for pad in pads]
        radiating = dict(radiation or {})
        names = own + list(radiating)
        sums = np.zeros((len(own) + 1, len(names)))
        sums[: len(own), : len(own)] = np.eye(len(own))
        sums[-1, len(own) :] = np.array(list(radiating.values()))
        self.n_pads = len(pads)
        brakes = points.brakes if len(points.brakes) > 1 else points.brake(0)
        self.batch = batch_of(brakes, len(points), outputs=names, weights=sums)

    def limit_cycles(self, start: Start | Array = "small", *, longest_s: float = 6.0) -> LimitCycles:
        """Run until all amplitudes are steady, `longest_s` at most, and measure.

        Parameters
        ----------
        start : motion in the critical mode: "small", far inside the linear range; "large", as fast as the
            disc slides; or states (n, 2 n_dof)
        """
        points, batch, scale = self.points, self.batch, self.points.scale_m_s
        if isinstance(start, str):
            speed = _SMALL * scale if start == "small" else _LARGE * points.slip_m_s
            batch.states = speed[:, None] * self.mode.states
        else:
            batch.states = start
        point = points.working_point()
        history: list[Array] = []
        calm = np.zeros(len(points), dtype=int)
        for _ in range(max(1, round(longest_s * RATE_HZ / _WINDOW))):
            seen = batch.observe(_WINDOW, **point, columns=self.n_pads)
            history.append(seen.rms.max(axis=1))
            if len(history) > 1:
                calm = np.where(self._steady(history), calm + 1, 0)
            if (calm >= _CALM_WINDOWS).all():
                break
        settled = calm >= _CALM_WINDOWS
        recorded = np.array(history)
        return self._measure(recorded, settled, self._dying(recorded))

    def _dying(self, history: Array) -> Bools:
        """Whether amplitudes still fall at the end, as linear motion does: slow decay is no limit cycle."""
        back = min(len(history), _CALM_WINDOWS)
        with np.errstate(all="ignore"):
            rate = np.log(history[-1] / history[-back]) * RATE_HZ / (_WINDOW * max(back - 1, 1))
        return (self.mode.growth_1_s < 0.0) & (rate <= 0.5 * self.mode.growth_1_s)

    def _steady(self, history: list[Array]) -> Bools:
        """Whether each amplitude is steady over the last two windows: a limit cycle, or silence, or lost."""
        before, now = history[-2:]
        scale = self.points.scale_m_s
        with np.errstate(all="ignore"):
            slow = np.abs(np.log(now / before)) * RATE_HZ / _WINDOW < _STEADY_1_S
        return (slow & (now > _SQUEAL * scale)) | (now < _SILENT * scale) | self.batch.lost

    def _measure(self, history: Array, settled: Bools, dying: Bools) -> LimitCycles:
        points, pads = self.points, self.n_pads
        y = self.batch.advance(_MEASURED, **points.working_point())
        slips, velocity, acceleration = y[:, :, :pads], y[:, :, pads], y[:, :, pads + 1]
        normal, sound = y[:, :, pads + 2 : -1], y[:, :, -1]
        amplitude = 0.5 * (slips.max(axis=0) - slips.min(axis=0)).max(axis=1)
        with np.errstate(invalid="ignore"):
            squeals = (amplitude > _SQUEAL * points.scale_m_s) & ~dying
        sliding = np.abs(points.slip_m_s[:, None] - slips)
        stuck = (sliding < 1e-6 * points.slip_m_s[:, None]).mean(axis=0).max(axis=1)
        force = points.pad_force_n[:, None] + normal
        lifted = (force < -1e-9 * points.pad_force_n[:, None]).mean(axis=0).max(axis=1)
        times = np.array([_growth_time(history[:, i]) if squeals[i] else np.nan for i in range(len(points))])
        return LimitCycles(
            squeals,
            settled & ~self.batch.lost & ~(dying & (amplitude > _SILENT * points.scale_m_s)),
            amplitude,
            velocity.std(axis=0),
            acceleration.std(axis=0),
            np.where(squeals, _frequencies(velocity), np.nan),
            stuck,
            lifted,
            sound.std(axis=0),
            times,
        )

    def growth(self, *, seed: int = 1) -> Array:
        """Growth rates (n,) 1/s of small random motions in time: what eigenvalues predict, without them.

        All bodies get random speeds; the rate is fitted to the last amplitudes within the linear range.
        """
        points, batch = self.points, self.batch
        n = points.brakes[0].n_dof
        states = np.zeros((len(points), 2 * n))
        states[:, n:] = np.random.default_rng(seed).normal(size=n)
        batch.states = _SEED * points.scale_m_s[:, None] * states
        point = points.working_point()
        history = np.array(
            [batch.observe(_SHORT, **point, columns=self.n_pads).rms.max(axis=1) for _ in range(_SHORTS)]
        )
        rates = np.full(len(points), np.nan)
        for i in range(len(points)):
            beyond = np.flatnonzero(~(history[:, i] < _LINEAR * points.scale_m_s[i]))
            stop = int(beyond[0]) if len(beyond) else _SHORTS
            part = history[max(0, stop - _FITTED) : stop, i]
            if len(part) > 1 and (part > 0.0).all():
                times = np.arange(len(part)) * _SHORT / RATE_HZ
                rates[i] = np.polyfit(times, np.log(part), 1)[0]
        return rates


def _growth_time(history: Array) -> float:
    """Time to 90 % of the last amplitude, from amplitudes per window."""
    beyond = np.flatnonzero(history >= 0.9 * history[-1])
    return float((beyond[0] + 0.5) * _WINDOW / RATE_HZ)


def _frequencies(y: Array) -> Array:
    """Frequency of the strongest line of every column of y (samples, n), interpolated."""
    windowed = np.nan_to_num(y - y.mean(axis=0)) * np.blackman(len(y))[:, None]
    size = 1 << int(np.ceil(np.log2(4 * len(y))))
    spectrum = np.log(np.abs(np.fft.rfft(windowed, size, axis=0)) + 1e-300)
    at = np.clip(spectrum.argmax(axis=0), 1, len(spectrum) - 2)
    a, b, c = (np.take_along_axis(spectrum, (at + d)[None], axis=0)[0] for d in (-1, 0, 1))
    with np.errstate(all="ignore"):
        return (at + np.nan_to_num(0.5 * (a - c) / (a - 2.0 * b + c))) * RATE_HZ / size


def _disc(brake: Brake) -> str:
    """Name of the body that the pads rub on."""
    return next(c.between[1].split(".")[0] for c in brake.spec.couplings if c.kind == "contact")


@dataclass(frozen=True)
class Branches:
    """Bifurcation diagram: what small and large starts end in, and where.

    Attributes
    ----------
    growth_1_s : (n,) growth rates of small random motions seen in time
    onset_eigenvalues : value at which the first pair becomes unstable, interpolated; None: no change
    onset_time : the same from `growth_1_s`
    fold : value at which the squeal of large motions ends, going away from the unstable side; the end of the
        range where they squeal all over the stable side (`beyond`); None as above
    hysteresis : how far large motions squeal into the stable side, in units of the quantity; None as above
    resolution : how exactly fold is known
    """

    points: SquealPoints
    mode: CriticalMode
    small: LimitCycles
    large: LimitCycles
    growth_1_s: Array
    onset_eigenvalues: float | None
    onset_time: float | None
    fold: float | None
    hysteresis: float | None
    resolution: float | None
    beyond: bool = False

    @property
    def verdict(self) -> Verdict:
        """What kind of onset it is.

        "none": nothing changes within the range; "subcritical": large motions squeal on the stable side;
        "supercritical": the amplitude grows from zero; "sudden": at once to more than half of the largest
        amplitude, but on the unstable side only (a law that stays linear up to the reversal of slip).
        """
        if self.hysteresis is None or self.resolution is None:
            return "none"
        if self.beyond or self.hysteresis > 2.0 * self.resolution:
            return "subcritical"
        return "sudden" if self._first_amplitude() > 0.5 else "supercritical"

    def _first_amplitude(self) -> float:
        """Amplitude at the first value beyond the onset relative to the largest."""
        unstable = self.mode.growth_1_s > 0.0
        amplitude = np.where(unstable & self.large.squeals, self.large.slip_amplitude_m_s, np.nan)
        if self.onset_eigenvalues is None or np.isnan(amplitude).all():
            return 0.0
        distance = np.where(np.isnan(amplitude), np.inf, np.abs(self.points.values - self.onset_eigenvalues))
        return float(amplitude[np.argmin(distance)] / np.nanmax(amplitude))


def branches(
    points: SquealPoints,
    radiation: Mapping[str, float] | None = None,
    *,
    longest_s: float = 6.0,
    refinement: int = 16,
) -> Branches:
    """Bifurcation diagram over the points (in order); the fold is found more exactly by a finer run.

    Parameters
    ----------
    points : with increasing or decreasing values
    radiation : weights of outputs whose sum is the sound
    longest_s : simulated time at most for each motion to become steady
    refinement : parts into which the interval of the fold is divided
    """
    simulation = SquealSimulation(points, radiation)
    small = simulation.limit_cycles("small", longest_s=longest_s)
    large = simulation.limit_cycles("large", longest_s=longest_s)
    if large.squeals.any():
        starts = _carried_on(simulation, large.squeals)
        large = simulation.limit_cycles(starts, longest_s=longest_s)
    states = simulation.batch.states
    rates = simulation.growth()
    eigen, seen = _crossing(points.values, simulation.mode.growth_1_s), _crossing(points.values, rates)
    fold = hysteresis = resolution = None
    beyond = False
    if eigen is not None:
        side = _direction(points.values, simulation.mode.growth_1_s)
        fold, resolution = _fold(points, large.squeals, states, eigen, longest_s, refinement)
        beyond = fold is None and bool(large.squeals.all())
        if beyond:  # the end of the range on the stable side
            fold = float(points.values.min() if side > 0.0 else points.values.max())
            resolution = 0.0
        if fold is not None:
            hysteresis = max(0.0, side * (eigen - fold))
    return Branches(
        points, simulation.mode, small, large, rates, eigen, seen, fold, hysteresis, resolution, beyond
    )  # fmt: skip


def _carried_on(simulation: SquealSimulation, squeals: Bools) -> Array:
    """States (n, 2 n_dof) of large motions: limit cycles, carried slowly from there into what was quiet.

    A vibration that the critical mode does not lead to may still live on where it is led to from the
    unstable side. A parameter of the brake cannot change while it runs: there the nearest limit cycle starts.
    """
    points, states = simulation.points, simulation.batch.states
    n = len(points)
    paths = []
    for i in np.flatnonzero(squeals):
        for way in (-1, 1):
            path = [int(i)]
            while 0 <= path[-1] + way < n and not squeals[path[-1] + way]:
                path.append(path[-1] + way)
            if len(path) > 1:
                paths.append(path)
    if not paths:
        return states
    if points.quantity not in WORKING_QUANTITIES:
        for path in paths:
            states[path[1:]] = states[path[0]]
        return states
    starts = [path[0] for path in paths]
    walk = SquealSimulation(points.at([points.values[i] for i in starts])).batch
    walk.states = states[starts]
    size = np.zeros(n)
    for step in range(max(map(len, paths)) - 1):
        ends = [[path[min(step + d, len(path) - 1)] for path in paths] for d in (0, 1)]
        a, b = (points.at(points.values[which]).working_point() for which in ends)
        point = {key: a[key] if key == "saturation_m_s" else (a[key], b[key]) for key in a}
        walk.observe(_STEP, **point, columns=0)
        for lane, state in enumerate(walk.states):
            i = ends[1][lane]
            if step + 1 < len(paths[lane]) and np.linalg.norm(state) > size[i]:
                size[i], states[i] = np.linalg.norm(state), state
    return states


def _crossing(values: Array, growth: Array) -> float | None:
    """Value of the first change of sign of the growth rate, interpolated."""
    for i in range(len(values) - 1):
        a, b = growth[i], growth[i + 1]
        if np.isfinite(a) and np.isfinite(b) and (a > 0.0) != (b > 0.0):
            return float(values[i] + (values[i + 1] - values[i]) * a / (a - b))
    return None


def _direction(values: Array, growth: Array) -> float:
    """+1 where the brake becomes unstable with growing value, -1 otherwise."""
    i = int(np.flatnonzero((growth[:-1] > 0.0) != (growth[1:] > 0.0))[0])
    return float(np.sign((growth[i + 1] - growth[i]) * (values[i + 1] - values[i])))


def _fold(
    points: SquealPoints, squeals: Bools, states: Array, onset: float, longest_s: float, refinement: int
) -> tuple[float | None, float | None]:
    """Where large starts cease to squeal, next to the onset, and how exactly."""
    changes = np.flatnonzero(squeals[:-1] != squeals[1:])
    if not len(changes):
        return None, None
    i = int(changes[np.argmin(np.abs(points.values[changes] - onset))])
    ends = points.values[i : i + 2]
    if points.quantity not in WORKING_QUANTITIES:
        return float(ends.mean()), float(np.ptp(ends))
    fine = np.linspace(ends[0], ends[1], refinement + 1)
    start = np.tile(states[i] if squeals[i] else states[i + 1], (len(fine), 1))
    found = SquealSimulation(points.at(fine)).limit_cycles(start, longest_s=longest_s)
    at = np.flatnonzero(found.squeals[:-1] != found.squeals[1:])
    if not len(at):
        return float(ends.mean()), float(np.ptp(ends))
    j = int(at[np.argmin(np.abs(fine[at] - onset))])
    return float(fine[j : j + 2].mean()), float(np.ptp(fine[j : j + 2]))

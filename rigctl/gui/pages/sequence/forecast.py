"""What a program will be like on a rig: the dry run, and the course of its first brakings to be drawn.

Job: numbers, computed in the worker process (or at once, when the program is small). Imports no Qt. Not its
job: when to compute (`forecaster`), drawing (`preview`).

The course follows the duration estimate (`sequences.estimate.ThermalWalk`): a sketch for planning, not a
simulation of the plant. Between two known temperatures, cooling is drawn as it decays towards the ambient
and heating as a straight line.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from rigctl.config.rig import RigConfig
from sequences.braking import Braking
from sequences.check import CheckResult, check_program
from sequences.estimate import DurationEstimate, LoopOrder, ThermalWalk, loop_order_durations
from sequences.matrix import brakings
from sequences.pressure import SinePressure, StepsPressure, TrianglePressure
from sequences.program import Program

FIRST_BRAKINGS = 60


@dataclass(frozen=True)
class Course:
    """Set-points over time from the start of a sequence.

    Attributes
    ----------
    first_index : int
        Program number of its first braking.
    total : int
        Brakings of the sequence; `spans` may hold fewer.
    t_s, temperature_degc, speed_rpm, pressure_bar : ndarray, shape (n,)
    spans : ndarray, shape (brakings, 2)
        Begin and end of each braking, s.
    """

    first_index: int
    total: int
    t_s: npt.NDArray[np.float64]
    temperature_degc: npt.NDArray[np.float64]
    speed_rpm: npt.NDArray[np.float64]
    pressure_bar: npt.NDArray[np.float64]
    spans: npt.NDArray[np.float64]


@dataclass(frozen=True)
class Forecast:
    """The dry run of a program on a rig and the courses of its sequences by name."""

    program: Program
    rig: RigConfig
    check: CheckResult
    courses: dict[str, Course]


def forecast(program: Program, rig: RigConfig) -> Forecast:
    """Check the whole program; draw the first brakings of each sequence."""
    return Forecast(program, rig, check_program(program, rig.capabilities), courses(program, rig))


def loop_orders(program: Program, sequence: str, rig: RigConfig) -> dict[LoopOrder, DurationEstimate]:
    """Duration of the program for each loop order of one sequence."""
    return loop_order_durations(program, sequence, rig.capabilities)


def courses(program: Program, rig: RigConfig, first: int = FIRST_BRAKINGS) -> dict[str, Course]:
    """The course of the first brakings of every sequence that is on, the disc as left by the one before."""
    last = next((s.name for s in reversed(program.sequences) if s.count), "")
    walk = ThermalWalk(rig.capabilities)
    pens: dict[str, _Pen] = {}
    totals = {sequence.name: sequence.count for sequence in program.sequences}
    for braking in program.brakings():
        pen = pens.get(braking.sequence)
        if pen is None:
            pen = pens[braking.sequence] = _Pen(rig, braking.index)
        if len(pen.spans) < first:
            pen.draw(braking, walk)
        elif braking.sequence == last:
            break
        else:
            walk.step(braking)
    return {name: pen.course(totals[name]) for name, pen in pens.items()}


def effort(program: Program) -> int:
    """How much a forecast computes: brakings walked, and a tenth of the points drawn."""
    points = 0
    for sequence in program.sequences:
        first = next(brakings(sequence), None)
        if first is not None:
            points += min(sequence.count, FIRST_BRAKINGS) * len(braking_times(first))
    return program.count + points // 10


@dataclass
class _Pen:
    """Draws brakings one after the other."""

    rig: RigConfig
    first_index: int
    now_s: float = 0.0
    points: list[tuple[float, float, float, float]] = field(default_factory=list)
    spans: list[tuple[float, float]] = field(default_factory=list)
    speed_rpm: float = 0.0

    def course(self, total: int) -> Course:
        table = np.array(self.points, dtype=float).reshape(-1, 4)
        t_s, temperature, speed, pressure = table.T
        spans = np.array(self.spans, dtype=float).reshape(-1, 2)
        return Course(self.first_index, total, t_s, temperature, speed, pressure, spans)

    def _point(self, degc: float, rpm: float, bar: float) -> None:
        self.points.append((self.now_s, degc, rpm, bar))

    def _wait(self, seconds: float) -> None:
        self.now_s += max(seconds, 0.0)

    def draw(self, braking: Braking, walk: ThermalWalk) -> None:
        before, from_degc = walk.estimate, walk.temperature_degc
        expected = walk.step(braking)
        after, capabilities = walk.estimate, self.rig.capabilities
        heating_s, cooling_s = after.heating_s - before.heating_s, after.cooling_s - before.cooling_s
        soak_s = after.soaking_s - before.soaking_s
        end_cooling_s = self._cooling_after(braking, expected.end_degc, cooling_s, from_degc)
        self._point(from_degc, self.speed_rpm, 0.0)
        reached_degc = expected.start_degc
        if heating_s > 0:
            self._heat(braking, from_degc, reached_degc, heating_s)
        if cooling_s - end_cooling_s > 0:
            self._cool(from_degc, reached_degc, cooling_s - end_cooling_s)
        if soak_s > 0:
            self._hold(reached_degc, self.rig.conditioning.soak_speed_rpm, soak_s)
        rate = capabilities.max_speed_rate_rpm_s
        lead_s = max(capabilities.start_s, braking.recording.pre_s)
        self._wait(abs(braking.speed_profile.start_rpm) / rate)
        self._point(reached_degc, braking.speed_profile.start_rpm, 0.0)
        self._wait(lead_s)
        self._point(reached_degc, braking.speed_profile.start_rpm, 0.0)
        self._brake(braking, reached_degc, expected.end_degc)
        self._wait(max(capabilities.release_s, braking.recording.post_s))
        self._point(expected.end_degc, braking.speed_profile.end_rpm, 0.0)
        self._wait(abs(braking.speed_profile.end_rpm) / rate)
        self.speed_rpm = 0.0
        self._point(expected.end_degc, 0.0, 0.0)
        self._wait(braking.dwell_s)
        if end_cooling_s > 0:
            self._cool(expected.end_degc, walk.temperature_degc, end_cooling_s)
        self._point(walk.temperature_degc, self.speed_rpm, 0.0)

    def _cooling_after(self, braking: Braking, end_degc: float, cooling_s: float, from_degc: float) -> float:
        """Share of the cooling that follows the braking because the maximum temperature was passed."""
        if end_degc <= braking.limits.max_degc:
            return 0.0
        target = braking.temperature_degc
        hot = target is not None and from_degc > target + braking.conditioning.tolerance_k
        return cooling_s / 2 if hot else cooling_s

    def _heat(self, braking: Braking, from_degc: float, to_degc: float, seconds: float) -> None:
        how, capabilities = braking.conditioning, self.rig.capabilities
        rpm = how.drag_speed_rpm or capabilities.conditioning_speed_rpm
        bar = how.drag_pressure_bar or capabilities.conditioning_pressure_bar
        spin_s = min(abs(rpm) / capabilities.max_speed_rate_rpm_s, seconds)
        self._wait(spin_s)
        self._point(from_degc, rpm, 0.0)
        self._point(from_degc, rpm, bar)
        self._wait(max(seconds - spin_s - capabilities.release_s, 0.0))
        self._point(to_degc, rpm, bar)
        self._point(to_degc, rpm, 0.0)
        self._wait(min(capabilities.release_s, max(seconds - spin_s, 0.0)))
        self.speed_rpm = rpm

    def _cool(self, from_degc: float, to_degc: float, seconds: float) -> None:
        rpm, ambient = self.rig.conditioning.cooling_speed_rpm, self.rig.capabilities.thermal.ambient_degc
        above, left = from_degc - ambient, to_degc - ambient
        decays = above > left > 0
        begin_s = self.now_s
        for share in np.linspace(0.0, 1.0, 9 if decays else 2):
            self.now_s = begin_s + seconds * float(share)
            decayed = ambient + above * math.exp(float(share) * math.log(left / above)) if decays else 0.0
            self._point(decayed if decays else from_degc + (to_degc - from_degc) * float(share), rpm, 0.0)
        self.speed_rpm = rpm

    def _hold(self, degc: float, rpm: float, seconds: float) -> None:
        self._point(degc, rpm, 0.0)
        self._wait(seconds)
        self._point(degc, rpm, 0.0)
        self.speed_rpm = rpm

    def _brake(self, braking: Braking, from_degc: float, to_degc: float) -> None:
        begin_s, duration_s = self.now_s, braking.duration_s
        for t_s in braking_times(braking):
            self.now_s = begin_s + t_s
            degc = from_degc + (to_degc - from_degc) * t_s / duration_s
            self._point(degc, braking.speed_setpoint_rpm(t_s), braking.pressure_setpoint_bar(t_s))
        self.spans.append((begin_s, begin_s + duration_s))


def braking_times(braking: Braking) -> list[float]:
    """Moments at which a braking is drawn: enough for its swings, few for straight lines."""
    duration_s, function = braking.duration_s, braking.pressure_function
    times = {0.0, duration_s, min(function.rise_s, duration_s)}
    at_s = 0.0
    for segment in braking.speed_profile.segments:
        at_s += segment.duration_s
        times.add(min(at_s, duration_s))
    if isinstance(function, StepsPressure):
        share = duration_s / len(function.steps_bar)
        for k in range(1, len(function.steps_bar)):
            times |= {k * share * (1 - 1e-6), k * share * (1 + 1e-9)}
    elif isinstance(function, SinePressure | TrianglePressure):
        points = min(max(24, round(16 * function.frequency_hz * duration_s)), 400)
        times |= {duration_s * k / points for k in range(points + 1)}
    if function.rise_s > 0 and function.kind != "constant":
        times |= {function.rise_s * k / 8 for k in range(9)}
    return sorted(t for t in times if t <= duration_s)

"""Courses over the time of one braking: disc speed (t, n1, n2) and brake pressure, as pure functions of time.

Job: say which speed and which pressure are wanted t seconds after the pressure came on. No state, no clock,
no rig. Not the job: how the drive or the actuator follows (plant, engine) and whether they can (``check``).

The pressure function of the paper's dialog (Fig. 5: 'Bremsdruck-Zeitfunktion', 'Bremsdruck-Amplitude') acts
around the working point p: every function stays between p - amplitude and p + amplitude. A ramp therefore
runs from p - amplitude to p + amplitude and has the working point as its mean.
"""

from __future__ import annotations

import itertools
import math
from abc import ABC, abstractmethod
from typing import Annotated, Any, Literal, Self, cast

from pydantic import Field, model_validator

from sequences.fields import AmplitudeBar, Data, FrequencyHz, OffsetBar, PauseS, SegmentS, SpeedRpm, refuse

MAX_PROFILE_S = 3600.0


class SpeedSegment(Data):
    """One row of the dialog's speed table: within `duration_s` from `start_rpm` (n1) to `end_rpm` (n2)."""

    duration_s: SegmentS
    start_rpm: SpeedRpm
    end_rpm: SpeedRpm

    @property
    def slope_rpm_s(self) -> float:
        return (self.end_rpm - self.start_rpm) / self.duration_s


class SpeedProfile(Data):
    """Disc speed during one braking: segments in order, without jumps. Its length is that of the braking."""

    segments: tuple[SpeedSegment, ...]

    @model_validator(mode="before")
    @classmethod
    def _short_forms(cls, data: Any) -> Any:
        """Accept one segment, or a list of segments, in place of the table with ``segments``."""
        if isinstance(data, list | tuple):
            return {"segments": cast("list[Any]", data)}
        one = isinstance(data, SpeedSegment) or (isinstance(data, dict) and "duration_s" in data)
        return {"segments": [cast("Any", data)]} if one else cast("Any", data)

    @model_validator(mode="after")
    def _continuous(self) -> Self:
        if not self.segments:
            raise refuse(
                "no_segments", "a speed profile without segments", "give at least one segment (t, n1, n2)"
            )
        if self.duration_s > MAX_PROFILE_S:
            raise refuse(
                "profile_too_long",
                "the segments last {value} s together",
                f"shorten the braking to at most {MAX_PROFILE_S:g} s",
                self.duration_s,
            )
        for number, (a, b) in enumerate(itertools.pairwise(self.segments), start=1):
            if a.end_rpm != b.start_rpm:
                raise refuse(
                    "speed_jump",
                    "the speed jumps by {value} 1/min after segment {number}",
                    "let the next segment start where the last one ends, or put a ramp between them",
                    b.start_rpm - a.end_rpm,
                    number=number,
                )
        return self

    @classmethod
    def constant(cls, speed_rpm: float, duration_s: float) -> Self:
        segment = SpeedSegment(duration_s=duration_s, start_rpm=speed_rpm, end_rpm=speed_rpm)
        return cls(segments=(segment,))

    @property
    def duration_s(self) -> float:
        return math.fsum(segment.duration_s for segment in self.segments)

    @property
    def start_rpm(self) -> float:
        return self.segments[0].start_rpm

    @property
    def end_rpm(self) -> float:
        return self.segments[-1].end_rpm

    @property
    def min_rpm(self) -> float:
        return min(min(s.start_rpm, s.end_rpm) for s in self.segments)

    @property
    def max_rpm(self) -> float:
        return max(max(s.start_rpm, s.end_rpm) for s in self.segments)

    @property
    def max_slope_rpm_s(self) -> float:
        return max(abs(s.slope_rpm_s) for s in self.segments)

    def speed_rpm(self, t_s: float) -> float:
        """Wanted disc speed at `t_s` after the start; before it the first, after the end the last speed."""
        left_s = max(t_s, 0.0)
        for segment in self.segments:
            if left_s < segment.duration_s:
                share = left_s / segment.duration_s
                return segment.start_rpm * (1.0 - share) + segment.end_rpm * share
            left_s -= segment.duration_s
        return self.end_rpm


class _PressureShape(Data, ABC):
    """What all pressure functions share: clamping of time, optional linear rise from zero, extremes."""

    rise_s: PauseS = 0.0

    @abstractmethod
    def _offset_bar(self, t_s: float, duration_s: float) -> float:
        """Deviation from the working point at 0 <= t_s <= duration_s."""

    @abstractmethod
    def offsets_bar(self) -> tuple[float, float]:
        """Lower and upper bound of the deviation from the working point."""

    def _swing_bar_s(self, duration_s: float) -> float:
        """Largest rate of change after the rise. Steps count as none: the actuator sets their rate."""
        return 0.0

    def rate_bar_s(self, working_point_bar: float, duration_s: float) -> float:
        """Upper bound of the rate of change, rise included; without a rise time the onset is a step."""
        rise_bar_s = self.max_bar(working_point_bar) / self.rise_s if self.rise_s > 0 else 0.0
        return rise_bar_s + self._swing_bar_s(duration_s)

    def pressure_bar(self, t_s: float, working_point_bar: float, duration_s: float) -> float:
        """Wanted pressure at `t_s` after the pressure came on; held outside 0 ... `duration_s`."""
        t_s = min(max(t_s, 0.0), duration_s)
        pressure = working_point_bar + self._offset_bar(t_s, duration_s)
        return pressure * (t_s / self.rise_s) if t_s < self.rise_s else pressure

    def min_bar(self, working_point_bar: float) -> float:
        """Lower bound of the pressure after the rise (during the rise it starts from zero)."""
        return working_point_bar + self.offsets_bar()[0]

    def max_bar(self, working_point_bar: float) -> float:
        """Upper bound of the pressure over the whole braking."""
        return working_point_bar + self.offsets_bar()[1]


class ConstantPressure(_PressureShape):
    """The working point itself."""

    kind: Literal["constant"] = "constant"

    def _offset_bar(self, t_s: float, duration_s: float) -> float:
        return 0.0

    def offsets_bar(self) -> tuple[float, float]:
        return 0.0, 0.0


class _Swinging(_PressureShape, ABC):
    amplitude_bar: AmplitudeBar

    def offsets_bar(self) -> tuple[float, float]:
        return -self.amplitude_bar, self.amplitude_bar


class RampPressure(_Swinging):
    """'Rampe': linear over the whole braking from p - amplitude to p + amplitude, or back if falling."""

    kind: Literal["ramp"]
    direction: Literal["rising", "falling"] = "rising"

    def _offset_bar(self, t_s: float, duration_s: float) -> float:
        course = 2.0 * t_s / duration_s - 1.0
        return self.amplitude_bar * (course if self.direction == "rising" else -course)

    def _swing_bar_s(self, duration_s: float) -> float:
        return 2.0 * self.amplitude_bar / duration_s


class SinePressure(_Swinging):
    """Sine around the working point, beginning there and rising."""

    kind: Literal["sine"]
    frequency_hz: FrequencyHz

    def _offset_bar(self, t_s: float, duration_s: float) -> float:
        return self.amplitude_bar * math.sin(2.0 * math.pi * self.frequency_hz * t_s)

    def _swing_bar_s(self, duration_s: float) -> float:
        return 2.0 * math.pi * self.frequency_hz * self.amplitude_bar


class TrianglePressure(_Swinging):
    """Triangle around the working point, beginning there and rising: constant rate up and down."""

    kind: Literal["triangle"]
    frequency_hz: FrequencyHz

    def _offset_bar(self, t_s: float, duration_s: float) -> float:
        phase = (self.frequency_hz * t_s + 0.25) % 1.0
        return self.amplitude_bar * (1.0 - abs(4.0 * phase - 2.0))

    def _swing_bar_s(self, duration_s: float) -> float:
        return 4.0 * self.frequency_hz * self.amplitude_bar


class StepsPressure(_PressureShape):
    """Equal shares of the braking at the working point plus each of `steps_bar` in turn."""

    kind: Literal["steps"]
    steps_bar: Annotated[tuple[OffsetBar, ...], Field(min_length=1, max_length=100)]

    def _offset_bar(self, t_s: float, duration_s: float) -> float:
        step = int(t_s / duration_s * len(self.steps_bar))
        return self.steps_bar[min(step, len(self.steps_bar) - 1)]

    def offsets_bar(self) -> tuple[float, float]:
        return min(self.steps_bar), max(self.steps_bar)


PressureFunction = Annotated[
    ConstantPressure | RampPressure | SinePressure | TrianglePressure | StepsPressure,
    Field(discriminator="kind"),
]

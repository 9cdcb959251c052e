"""Brake pressure over the time of one braking, as pure functions of time.

Job: say which pressure is wanted t seconds after the pressure came on, and between which bounds it stays. Not
the job: how the actuator follows (plant, engine) and whether it can (``check``).

The pressure function of the paper's dialog (Fig. 5: 'Bremsdruck-Zeitfunktion', 'Bremsdruck-Amplitude') acts
around the working point p: every function stays between p - amplitude and p + amplitude. A ramp therefore
runs from p - amplitude to p + amplitude and has the working point as its mean.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from typing import Annotated, Literal

from pydantic import Field

from sequences.fields import AmplitudeBar, Data, FrequencyHz, OffsetBar, PauseS


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

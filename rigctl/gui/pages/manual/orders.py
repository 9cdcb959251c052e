"""What a person may order by hand, held against what the rig can do. No widgets.

Job: the limits of every input of the manual page, and a pressure order (constant, ramp, sine, triangle,
steps) made of the numbers in its fields, with the reason when the rig cannot do it: the rules are those of
the dry run (`sequences.limits`). Not its job: what may be done in which state (`model`), the fields.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from pydantic import TypeAdapter, ValidationError
from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

from rigctl.config.rig import RigConfig
from rigctl.gui.widgets.entries import NumberRange
from sequences.braking import (
    Braking,
    Conditioning,
    LoopIndices,
    RecordedChannel,
    Recording,
    TemperatureLimits,
)
from sequences.capabilities import RigCapabilities
from sequences.limits import Finding, pressure_findings, speed_findings
from sequences.pressure import ConstantPressure, PressureFunction
from sequences.profiles import SpeedProfile

translate = QCoreApplication.translate

MAX_DURATION_S = 3600.0
MIN_DURATION_S = 0.5
MAX_FREQUENCY_HZ = 20.0
PREVIEW_POINTS = 240
LOAD_UNITS = ("N·m", "kW")
KINDS = ("constant", "ramp", "sine", "triangle", "steps")
_FUNCTION: TypeAdapter[Any] = TypeAdapter(PressureFunction)
_WHAT = {
    "speed": QT_TRANSLATE_NOOP("manual", "The speed"),
    "ramp": QT_TRANSLATE_NOOP("manual", "The ramp"),
    "pressure": QT_TRANSLATE_NOOP("manual", "The pressure"),
    "amplitude": QT_TRANSLATE_NOOP("manual", "The amplitude"),
    "frequency": QT_TRANSLATE_NOOP("manual", "The frequency"),
    "duration": QT_TRANSLATE_NOOP("manual", "The duration"),
    "ventilator": QT_TRANSLATE_NOOP("manual", "The air flow"),
    "temperature": QT_TRANSLATE_NOOP("manual", "The temperature"),
}


def _range(what: str, low: float, high: float, unit: str, decimals: int = 1, **more: Any) -> NumberRange:
    return NumberRange(low, high, unit, decimals, what=translate("manual", str(_WHAT[what])), **more)


def ranges_of(rig: RigConfig) -> dict[str, NumberRange]:
    """Limits of each input, by its name (the keys of `_WHAT`)."""
    can = rig.capabilities
    return {
        "speed": _range("speed", can.min_speed_rpm, can.max_speed_rpm, "1/min"),
        "ramp": _range("ramp", 1.0, can.max_speed_rate_rpm_s, translate("manual", "1/min per s")),
        "pressure": _range("pressure", can.min_pressure_bar, can.max_pressure_bar, "bar", 2, or_zero=True),
        "amplitude": _range("amplitude", 0.0, can.max_pressure_bar / 2.0, "bar", 2),
        "frequency": _range("frequency", 0.01, MAX_FREQUENCY_HZ, "Hz", 2),
        "duration": _range("duration", MIN_DURATION_S, MAX_DURATION_S, "s"),
        "ventilator": _range("ventilator", 0.0, rig.conditioning.ventilator_m3_h, "m³/h", 0),
        "temperature": _range(
            "temperature", can.min_conditioning_degc, can.max_disc_temperature_degc, "°C", 0
        ),
    }


def common_ranges() -> dict[str, NumberRange]:
    """Limits as shown before a rig is known."""
    return {
        "speed": _range("speed", 0.0, 1000.0, "1/min"),
        "ramp": _range("ramp", 1.0, 100.0, translate("manual", "1/min per s")),
        "pressure": _range("pressure", 0.5, 50.0, "bar", 2, or_zero=True),
        "amplitude": _range("amplitude", 0.0, 25.0, "bar", 2),
        "frequency": _range("frequency", 0.01, MAX_FREQUENCY_HZ, "Hz", 2),
        "duration": _range("duration", MIN_DURATION_S, MAX_DURATION_S, "s"),
        "ventilator": _range("ventilator", 0.0, 1000.0, "m³/h", 0),
        "temperature": _range("temperature", 20.0, 500.0, "°C", 0),
    }


@dataclass(frozen=True)
class PressureOrder:
    """A pressure to be applied; without a function it stays until it is released."""

    pressure_bar: float
    function: Mapping[str, Any] | None = None
    duration_s: float | None = None

    def course(self, duration_s: float | None = None) -> list[tuple[float, float]]:
        """Set-points (s, bar) for a drawing."""
        length_s = self.duration_s or duration_s or 10.0
        function = self._function()
        steps = [length_s * k / PREVIEW_POINTS for k in range(PREVIEW_POINTS + 1)]
        return [(t_s, function.pressure_bar(t_s, self.pressure_bar, length_s)) for t_s in steps]

    def _function(self) -> Any:
        return ConstantPressure() if self.function is None else _FUNCTION.validate_python(dict(self.function))

    def problem(self, rig: RigCapabilities, speed_rpm: float, duration_s: float | None = None) -> str:
        """Why the rig cannot do it at that speed; "" when it can. The load of the drive is not judged."""
        found = self._findings(rig, speed_rpm, duration_s)
        return next((text for text, is_load in found if not is_load), "")

    def load_problem(self, rig: RigCapabilities, speed_rpm: float, duration_s: float | None = None) -> str:
        """Torque or power that the drive may not have, at the highest coefficient of friction; "" if none.

        A recorded braking is refused for it, as in a program; by hand it is a warning.
        """
        found = self._findings(rig, speed_rpm, duration_s)
        return next((text for text, is_load in found if is_load), "")

    def _findings(
        self, rig: RigCapabilities, speed_rpm: float, duration_s: float | None
    ) -> list[tuple[str, bool]]:
        length_s = self.duration_s or duration_s or 10.0
        try:
            braking = Braking(
                index=1, sequence="manual", role="check", index_in_sequence=1, repetition=1,
                loop=LoopIndices(temperature=0, speed=0, pressure=0), temperature_degc=None,
                pressure_bar=self.pressure_bar,
                speed_profile=SpeedProfile.constant(speed_rpm, length_s),
                pressure_function=self._function(),
                conditioning=Conditioning(enabled=False), limits=TemperatureLimits(),
                dwell_s=0.0, ventilator=False,
                recording=Recording(channels=(RecordedChannel(name="pressure"),)),
            )  # fmt: skip
        except ValidationError as error:
            return [(str(error.errors()[0]["msg"]), False)]
        if braking.min_pressure_bar < -1e-9:
            text = translate(
                "manual",
                "The pressure would fall to {0} bar. Raise the mean pressure or reduce the amplitude.",
            ).format(f"{braking.min_pressure_bar:g}")
            return [(text, False)]
        return [
            (_words(finding), finding.unit in LOAD_UNITS)
            for finding in (*speed_findings(braking, rig), *pressure_findings(braking, rig))
        ]


def _words(finding: Finding) -> str:
    value = finding.value if isinstance(finding.value, str) else f"{finding.value:.4g}"
    remedy = finding.remedy[:1].upper() + finding.remedy[1:]
    return f"{value}\u202f{finding.unit} {finding.problem}. {remedy}."


@dataclass
class PressureEntry:
    """The numbers in the fields of the pressure row, each None while its field is refused.

    A ramp runs from `from_bar` to `to_bar`; sine and triangle swing by `amplitude_bar` around `pressure_bar`;
    steps are offsets from it, each for an equal share of the duration.
    """

    kind: str = "constant"
    pressure_bar: float | None = 10.0
    from_bar: float | None = 2.0
    to_bar: float | None = 20.0
    amplitude_bar: float | None = 2.0
    frequency_hz: float | None = 0.5
    steps_bar: list[float] | None = field(default_factory=lambda: [0.0, 5.0, 10.0])
    duration_s: float | None = 10.0

    def order(self) -> PressureOrder | None:
        """The order, None while a field that it needs is refused."""
        if self.kind == "ramp":
            return None if self.duration_s is None else self._ramp(self.duration_s)
        if self.pressure_bar is None:
            return None
        if self.kind == "constant":
            return PressureOrder(self.pressure_bar)
        function = self._function()
        if function is None or self.duration_s is None:
            return None
        return PressureOrder(self.pressure_bar, function, self.duration_s)

    def _function(self) -> dict[str, Any] | None:
        if self.kind == "steps":
            return {"kind": "steps", "steps_bar": self.steps_bar} if self.steps_bar else None
        if self.amplitude_bar is None or self.frequency_hz is None:
            return None
        return {"kind": self.kind, "amplitude_bar": self.amplitude_bar, "frequency_hz": self.frequency_hz}

    def _ramp(self, duration_s: float) -> PressureOrder | None:
        if self.from_bar is None or self.to_bar is None:
            return None
        middle, half = 0.5 * (self.from_bar + self.to_bar), 0.5 * abs(self.to_bar - self.from_bar)
        direction = "rising" if self.to_bar >= self.from_bar else "falling"
        function = {"kind": "ramp", "amplitude_bar": half, "direction": direction}
        return PressureOrder(middle, function, duration_s)

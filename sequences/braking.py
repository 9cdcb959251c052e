"""One braking: everything the engine needs to run it, without looking back at the sequence it came from.

Job: immutable data with a JSON round trip (``model_dump_json`` / ``model_validate_json``), stored with every
measurement as its specification. Not the job: running it (``rigctl.engine``) or saying what happened.

Time of a braking: t = 0 is the moment the pressure comes on, with the disc running at ``start_rpm`` and at
its start temperature. The braking lasts as long as its speed profile. Recording begins ``pre_s`` before and
ends ``post_s`` after it.
"""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import model_validator

from sequences.fields import (
    Bounds,
    ChannelName,
    Data,
    PauseS,
    PressureBar,
    SafeName,
    SpeedRpm,
    TemperatureDegc,
    TimeoutS,
    ToleranceK,
    refuse,
)
from sequences.pressure import PressureFunction
from sequences.profiles import SpeedProfile

Role = Literal["bedding", "matrix", "friction", "stop", "calibration", "check"]
Axis = Literal["temperature", "speed", "pressure"]
AXES: tuple[Axis, Axis, Axis] = ("temperature", "speed", "pressure")

Counting = Annotated[int, Bounds(1, 100_000, "", "give a whole number of 1 or more")]
Position = Annotated[int, Bounds(0, 100_000, "", "give a whole number of 0 or more")]
Decimation = Annotated[int, Bounds(1, 1_000_000, "", "give a whole number of 1 or more, e.g. 40")]
SamplingHz = Annotated[
    float, Bounds(0, 10_000_000, "Hz", "give the sampling rate in Hz, e.g. 40000", above_low=True)
]

LeadS = Annotated[float, Bounds(0, 60, "s", "give a time in seconds from 0 to 60, e.g. 0.5")]


class Conditioning(Data):
    """How the disc is brought to its start temperature ('Temperaturkonditionierung').

    ``mode = "exact"``: drag-heat or cool until the temperature stays within +- `tolerance_k` of the set-point
    for `soak_s`. ``mode = "at_most"``: only cool, and start as soon as the disc is not hotter than the
    set-point + `tolerance_k` (bedding). `timeout_s` bounds heating, cooling and soaking together. Drag speed
    and pressure are the rig's own unless given here.
    """

    enabled: bool = True
    mode: Literal["exact", "at_most"] = "exact"
    tolerance_k: ToleranceK = 2.0
    soak_s: PauseS = 2.0
    timeout_s: TimeoutS = 3600.0
    drag_speed_rpm: SpeedRpm | None = None
    drag_pressure_bar: PressureBar | None = None

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.soak_s >= self.timeout_s:
            raise refuse(
                "soak_exceeds_timeout",
                "soak_s = {value} leaves no time within timeout_s = {timeout_s}",
                "raise timeout_s or shorten soak_s",
                self.soak_s,
                timeout_s=self.timeout_s,
            )
        if self.drag_speed_rpm == 0 or self.drag_pressure_bar == 0:
            raise refuse(
                "drag_without_power",
                "dragging at {value} does not heat",
                "leave out drag_speed_rpm and drag_pressure_bar to use the rig's own, or give values above 0",
                "0 1/min" if self.drag_speed_rpm == 0 else "0 bar",
            )
        return self


class TemperatureLimits(Data):
    """'Maximaltemperatur' and 'Abkühltemperatur': above the one stop braking, and cool to the other."""

    max_degc: TemperatureDegc = 500.0
    cool_down_degc: TemperatureDegc = 480.0

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.max_degc < self.cool_down_degc:
            raise refuse(
                "limits_reversed",
                "max_degc = {value} is below cool_down_degc = {cool_down_degc}",
                "let the cool-down temperature be the lower one, e.g. max_degc = 500, cool_down_degc = 480",
                self.max_degc,
                cool_down_degc=self.cool_down_degc,
            )
        return self


class RecordedChannel(Data):
    """A channel to store; its stored rate is the sampling rate over `decimation` ('Dezimierung')."""

    name: ChannelName
    decimation: Decimation = 1


class Recording(Data):
    """What is stored of a braking: channels, their rates, and how long before and after it."""

    sampling_hz: SamplingHz = 40000.0
    channels: tuple[RecordedChannel, ...]
    pre_s: LeadS = 0.5
    post_s: LeadS = 0.5

    @model_validator(mode="after")
    def _distinct(self) -> Self:
        names = [channel.name for channel in self.channels]
        if not names:
            raise refuse(
                "no_channels", "no channel is recorded", 'name at least one, e.g. { name = "torque" }'
            )
        for name in names:
            if names.count(name) > 1:
                raise refuse(
                    "repeated_channel", "channel {value} is listed twice", "remove one of them", name
                )
        return self

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(channel.name for channel in self.channels)

    def stored_rate_hz(self, name: str) -> float:
        """Rate at which `name` is stored; raises KeyError if it is not recorded."""
        for channel in self.channels:
            if channel.name == name:
                return self.sampling_hz / channel.decimation
        raise KeyError(name)


class LoopIndices(Data):
    """Zero-based places of a braking's set-points in the lists of its sequence."""

    temperature: Position
    speed: Position
    pressure: Position


class Braking(Data):
    """One braking of a program. `index` counts from 1 through the whole program."""

    index: Counting
    sequence: SafeName
    role: Role
    index_in_sequence: Counting
    repetition: Counting
    loop: LoopIndices
    temperature_degc: TemperatureDegc | None  # None: start at whatever temperature the disc has
    pressure_bar: PressureBar  # working point
    speed_profile: SpeedProfile
    pressure_function: PressureFunction
    conditioning: Conditioning
    limits: TemperatureLimits
    recording: Recording
    dwell_s: PauseS
    ventilator: bool  # True: the ventilator may run during the braking

    @property
    def duration_s(self) -> float:
        return self.speed_profile.duration_s

    @property
    def max_pressure_bar(self) -> float:
        return self.pressure_function.max_bar(self.pressure_bar)

    @property
    def min_pressure_bar(self) -> float:
        return self.pressure_function.min_bar(self.pressure_bar)

    def speed_setpoint_rpm(self, t_s: float) -> float:
        """Wanted disc speed `t_s` seconds after the pressure came on."""
        return self.speed_profile.speed_rpm(t_s)

    def pressure_setpoint_bar(self, t_s: float) -> float:
        """Wanted brake pressure `t_s` seconds after the pressure came on."""
        return self.pressure_function.pressure_bar(t_s, self.pressure_bar, self.duration_s)

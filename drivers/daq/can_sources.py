"""Sources on CANopen: measuring amplifier and current loop (CiA 404), encoder (CiA 406).

Job: verify what the values mean (units, digits, steps per turn), and turn integers into physical values; what
is not valid becomes NaN and a fault on the board, never a number. Not its job: frames (`can_source`), time.
"""

# numpy's stubs are partly unknown in some of its versions:
# pyright: reportUnknownMemberType=false

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from drivers.can.canopen_node import CanopenNode
from drivers.can.objects import ObjectRef
from drivers.daq.can_source import CanSettings, CanSource
from drivers.daq.source import checked
from rigctl.core.channels import DISC_TEMPERATURE, SPEED, ChannelSpec
from rigctl.core.errors import DeviceError
from rigctl.hal.devices import RigContext

Values = NDArray[np.float64]

UNIT_CODES = {"bar": 0x004E_0000, "N·m": 0x0056_0000}
"""Units after CiA 303-2 as 6131h holds them. That of N·m is from memory: `unit_code` replaces it."""
INVALID_I32 = (-(2.0**31), 2.0**31 - 1.0)
NOT_VALID, TOO_HIGH, TOO_LOW = 1, 2, 4  # bits of 6150h
# NAMUR NE 43, in uA
FAULT_LOW_UA, VALID_LOW_UA, VALID_HIGH_UA, FAULT_HIGH_UA = 3600.0, 3800.0, 20_500.0, 21_000.0


class AnalogChannel(BaseModel):
    """One input of an amplifier.

    Attributes
    ----------
    input : int
        Sub-index of 9130h.
    unit : str
        Unit of the channel; must be what 6131h says.
    unit_code : int or None
        Value that 6131h must have, where `UNIT_CODES` does not know the unit.
    factor : float
        The channel is the device's value times this (1 for the device's own unit).
    description : str
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    input: int = Field(ge=1, le=64)
    unit: str = Field(min_length=1)
    unit_code: int | None = Field(default=None, ge=0, le=0xFFFF_FFFF)
    factor: float = 1.0
    description: str = ""


class AnalogSettings(CanSettings):
    """Settings of kind "canopen_analog": `channels` in the order of the TPDO's mapping."""

    channels: dict[str, AnalogChannel] = Field(min_length=1, max_length=2)


class CanopenAnalog(CanSource):
    """Process values 9130h of a CiA 404 device, with the digits that it says itself (6132h)."""

    profile = 404

    def __init__(self, name: str, settings: Mapping[str, Any], context: RigContext, place: str) -> None:
        own = checked(AnalogSettings, settings, place)
        self._channels = own.channels
        super().__init__(
            name, own, context, place,
            objects=tuple(ObjectRef(0x9130, channel.input, "i32") for channel in own.channels.values()),
            emcy_names={0x5010: "a bridge is broken", 0x2110: "overload of an input"},
        )  # fmt: skip
        self._scale = np.ones(len(own.channels))

    def verify(self, node: CanopenNode) -> None:
        """Units and decimal digits."""
        for position, (channel_name, channel) in enumerate(self._channels.items()):
            wanted = channel.unit_code if channel.unit_code is not None else UNIT_CODES.get(channel.unit)
            unit = node.read(ObjectRef(0x6131, channel.input, "u32"))
            if wanted is None or unit != wanted:
                expected = "no code is known for it" if wanted is None else f"{wanted:08X}h"
                raise DeviceError(
                    f"input {channel.input} measures in unit {unit:08X}h (6131h), the rig file says "
                    f"{channel.unit!r} ({expected}).",
                    place=f"{self.place}.channels.{channel_name}", value=unit,
                    remedy="Set the amplifier's unit, or unit_code here if the code is that of this unit.",
                )  # fmt: skip
            digits = node.read(ObjectRef(0x6132, channel.input, "u8"))
            if digits > 9:
                raise DeviceError(
                    f"input {channel.input} has {digits} decimal digits (6132h).", place=self.place,
                    value=digits, remedy="Set 0 to 6 with the maker's tool.",
                )  # fmt: skip
            self._scale[position] = channel.factor * 10.0**-digits
            self._identity[f"{channel_name}_digits"] = str(digits)

    def channels(self) -> Sequence[ChannelSpec]:
        """See `AnySource.channels`."""
        return [
            ChannelSpec(name, channel.unit, self.settings.output_hz, description=channel.description)
            for name, channel in self._channels.items()
        ]

    def convert(self, numbers: NDArray[np.int64], values: Values) -> tuple[Values, Values]:
        """See `Source.convert`."""
        physical = self.show(values)
        for position, name in enumerate(self._channels):
            bad = int(np.count_nonzero(np.isnan(physical[:, position])))
            self.fault(name, "the amplifier has no valid value (bridge broken?)" if bad else "")
        return numbers.astype(np.float64), physical

    def show(self, raw: Values) -> Values:
        """See `CanSource.show`."""
        return np.where((raw == INVALID_I32[0]) | (raw == INVALID_I32[1]), np.nan, raw * self._scale)


class CurrentLoopSettings(CanSettings):
    """Settings of kind "current_loop".

    Attributes
    ----------
    at_4ma, at_20ma : float
        Values in `unit` at 4 and 20 mA, as set in the transmitter.
    channel, unit, description : str
    input : int
        Sub-index of 7130h and 6150h.
    """

    at_4ma: float
    at_20ma: float
    channel: str = DISC_TEMPERATURE
    unit: str = "°C"
    description: str = ""
    input: int = Field(default=1, ge=1, le=64)
    event_ms: int = Field(default=10, ge=1, le=1000)


class CurrentLoop(CanSource):
    """Current 7130h in uA with status 6150h; limits of NAMUR NE 43."""

    profile = 404
    settings: CurrentLoopSettings

    def __init__(self, name: str, settings: Mapping[str, Any], context: RigContext, place: str) -> None:
        own = checked(CurrentLoopSettings, settings, place)
        super().__init__(
            name, own, context, place,
            objects=(ObjectRef(0x7130, own.input, "i16"), ObjectRef(0x6150, own.input, "u8")),
            emcy_names={0x2130: "current outside 3.6...21 mA"},
        )  # fmt: skip

    def verify(self, node: CanopenNode) -> None:
        """The input must count in microampere: without digits, as far as the device says."""
        digits = node.read(ObjectRef(0x6132, self.settings.input, "u8"))
        unit = node.read(ObjectRef(0x6131, self.settings.input, "u32"))
        if digits != 0 or unit != 0xFA04_0000:
            raise DeviceError(
                f"input {self.settings.input} does not count in uA: unit {unit:08X}h (6131h), "
                f"{digits} digits (6132h).",
                place=self.place, value=unit, remedy="Set unit FA040000h and 0 digits with the maker's tool.",
            )  # fmt: skip

    def channels(self) -> Sequence[ChannelSpec]:
        """See `AnySource.channels`."""
        own = self.settings
        return [ChannelSpec(own.channel, own.unit, own.output_hz, description=own.description)]

    def convert(self, numbers: NDArray[np.int64], values: Values) -> tuple[Values, Values]:
        """See `Source.convert`."""
        worst = max((namur_problem(ua, int(status)) for ua, status in values[-10:]), key=len, default="")
        self.fault(self.settings.channel, worst)
        return numbers.astype(np.float64), self._physical(values)

    def show(self, raw: Values) -> Values:
        """See `CanSource.show`."""
        self.fault(self.settings.channel, namur_problem(raw[0], int(raw[1])))
        return self._physical(raw[None, :])[0]

    def _physical(self, values: Values) -> Values:
        own = self.settings
        current_ua, status = values[:, :1], values[:, 1:2].astype(np.int64)
        physical = own.at_4ma + (current_ua - 4000.0) * ((own.at_20ma - own.at_4ma) / 16_000.0)
        valid = (current_ua >= VALID_LOW_UA) & (current_ua <= VALID_HIGH_UA) & (status == 0)
        return np.where(valid, physical, np.nan)


def namur_problem(current_ua: float, status: int) -> str:
    """What NAMUR NE 43 (and the input's status) says of a current; empty where it is a measured value."""
    shown = f"{current_ua / 1000.0:.2f} mA"
    if current_ua < FAULT_LOW_UA:
        return f"loop fault: {shown}, wire broken or transmitter failed"
    if current_ua > FAULT_HIGH_UA:
        return f"loop fault: {shown}, short circuit or transmitter failed"
    if status & NOT_VALID:
        return f"the input marks its value as not valid ({shown})"
    if not VALID_LOW_UA <= current_ua <= VALID_HIGH_UA or status & (TOO_HIGH | TOO_LOW):
        return f"out of range: {shown}"
    return ""


class EncoderSettings(CanSettings):
    """Settings of kind "encoder".

    Attributes
    ----------
    steps_per_turn : int or None
        Must be what 6001h says; None: taken from there.
    window_s : float
        The speed is the slope of the position over this time (least squares), dated to its middle.
    reversed : bool
        The speed's sign is changed.
    max_speed_rpm : float
        Positions that jump by more than this speed allows are no motion.
    disagreement_rpm, disagreement_share : float
        The encoder's own speed (6030h) may differ by the larger of both.
    disagreement_s : float
        ... for so long.
    """

    steps_per_turn: int | None = Field(default=None, ge=1, le=1 << 24)
    window_s: float = Field(default=0.02, ge=0.002, le=1.0)
    reversed: bool = False
    max_speed_rpm: float = Field(default=3000.0, gt=0.0, le=60_000.0)
    disagreement_rpm: float = Field(default=5.0, gt=0.0)
    disagreement_share: float = Field(default=0.05, gt=0.0, le=1.0)
    disagreement_s: float = Field(default=0.25, gt=0.0, le=10.0)
    channel: str = SPEED
    description: str = ""


class Encoder(CanSource):
    """Position 6004h to speed, held against the encoder's own speed 6030h."""

    profile = 406
    settings: EncoderSettings

    def __init__(self, name: str, settings: Mapping[str, Any], context: RigContext, place: str) -> None:
        own = checked(EncoderSettings, settings, place)
        super().__init__(
            name, own, context, place,
            objects=(ObjectRef(0x6004, 0, "u32"), ObjectRef(0x6030, 1, "i16")),
            emcy_names={0x7320: "position error"}, tolerated=False,
        )  # fmt: skip
        self._meter: SpeedMeter | None = None
        self._disagree = 0

    def verify(self, node: CanopenNode) -> None:
        """Steps per turn and total range."""
        own = self.settings
        steps = node.read(ObjectRef(0x6001, 0, "u32"))
        total = node.read(ObjectRef(0x6002, 0, "u32"))
        if steps == 0 or (own.steps_per_turn is not None and steps != own.steps_per_turn):
            raise DeviceError(
                f"has {steps} steps per turn (6001h), the rig file says {own.steps_per_turn}.",
                place=f"{self.place}.steps_per_turn", value=steps, remedy="Correct one of them.",
            )  # fmt: skip
        self._meter = SpeedMeter(
            steps,
            total or 1 << 32,
            self.rate_hz,
            max(3, round(own.window_s * self.rate_hz)),
            own.max_speed_rpm,
        )
        self._disagree = 0
        self._identity["steps_per_turn"] = str(steps)

    def channels(self) -> Sequence[ChannelSpec]:
        """See `AnySource.channels`."""
        own = self.settings
        return [ChannelSpec(own.channel, "1/min", own.output_hz, description=own.description)]

    def convert(self, numbers: NDArray[np.int64], values: Values) -> tuple[Values, Values]:
        """See `Source.convert`."""
        if self._meter is None:
            raise DeviceError("is not open.", place=self.place)
        axis, speed_rpm = self._meter(numbers, values[:, 0])
        self._judge(speed_rpm, values[:, 1] * 0.1)
        if self._disagree > self.settings.disagreement_s * self.rate_hz:
            speed_rpm = np.full_like(speed_rpm, np.nan)
        sign = -1.0 if self.settings.reversed else 1.0
        return axis, sign * speed_rpm[:, None]

    def show(self, raw: Values) -> Values:
        """See `CanSource.show`: the encoder's own speed."""
        return (-0.1 if self.settings.reversed else 0.1) * raw[1:2]

    def _judge(self, speed_rpm: Values, own_rpm: Values) -> None:
        known = speed_rpm[np.isfinite(speed_rpm)]
        if len(known) == 0 or len(own_rpm) == 0:
            return
        ours, theirs = float(np.median(known)), float(np.median(own_rpm))
        allowed = max(self.settings.disagreement_rpm, self.settings.disagreement_share * abs(theirs))
        if abs(ours - theirs) <= allowed or abs(theirs) >= 3276.0:
            self._disagree = 0
            self.fault(self.settings.channel, "")
            return
        self._disagree += len(own_rpm)
        if self._disagree > self.settings.disagreement_s * self.rate_hz:
            self.fault(
                self.settings.channel,
                f"position says {ours:.1f} 1/min, the encoder's own speed (6030h) {theirs:.1f} 1/min",
            )


class SpeedMeter:
    """Speed from positions that wrap, by the slope over a window.

    Parameters
    ----------
    steps : int
        Per turn.
    total : int
        The position wraps there.
    rate_hz : float
    window : int
        Samples of the window, at least 3.
    max_speed_rpm : float

    Notes
    -----
    The least-squares slope over N samples of a position rounded to steps has a standard deviation of
    sqrt(1/12) sqrt(12 / (N^3 - N)) steps per sample: 0.16 1/min at N = 20, 1 kHz and 4096 steps.
    Lost samples shorter than half a window are filled by the mean speed between the positions on both sides:
    the position knows all turns, also those of lost samples.
    """

    def __init__(self, steps: int, total: int, rate_hz: float, window: int, max_speed_rpm: float) -> None:
        self._total = total
        self._window = window
        self._to_rpm = 60.0 * rate_hz / steps
        # beyond half the range a motion cannot be told from the opposite one
        self._max_step = min(1.5 * max_speed_rpm / self._to_rpm + 2.0, total / 2.0)
        offsets = np.arange(window) - 0.5 * (window - 1)
        self._kernel = offsets / np.sum(offsets**2)
        self._last: tuple[int, float] | None = None
        self._position: Values = np.zeros(0)
        self._segment: NDArray[np.int64] = np.zeros(0, np.int64)
        self._segments = 0

    def __call__(self, numbers: NDArray[np.int64], wrapped: Values) -> tuple[Values, Values]:
        """(numbers at the windows' middles, speeds in 1/min) of all samples since the last call."""
        if len(numbers) == 0:
            return np.zeros(0), np.zeros(0)
        first = self._last or (int(numbers[0]) - 1, float(wrapped[0]))
        apart = np.diff(numbers, prepend=first[0])
        step = np.diff(wrapped, prepend=first[1])
        step = (step + self._total / 2.0) % self._total - self._total / 2.0
        broken = (np.abs(step) > self._max_step * apart) | (apart > self._window // 2)
        if self._last is None:
            broken[0] = True
        origin = float(self._position[-1]) if len(self._position) else 0.0
        unwrapped = origin + np.cumsum(step)
        segments = self._segments + np.cumsum(broken)
        dense = np.arange(first[0] + 1, int(numbers[-1]) + 1)
        filled = np.interp(
            dense, np.concatenate(([first[0]], numbers)), np.concatenate(([origin], unwrapped))
        )
        owner = np.searchsorted(numbers, dense, side="left")
        position = np.concatenate((self._position, filled)) - origin
        segment = np.concatenate((self._segment, segments[owner]))
        n, window = len(dense), self._window
        speeds = np.full(n, np.nan)
        known = len(position) - window + 1
        if known > 0:
            slope = np.correlate(position, self._kernel, "valid") * self._to_rpm
            whole = segment[window - 1 :] == segment[:known]
            count = min(n, known)
            speeds[n - count :] = np.where(whole, slope, np.nan)[known - count :]
        self._position = position[1 - window :]
        self._segment = segment[1 - window :]
        self._segments = int(segments[-1])
        self._last = (int(numbers[-1]), float(wrapped[-1]))
        return np.asarray(dense - 0.5 * (window - 1), np.float64), speeds

"""Bridge amplifier with two channels after CiA 404: torque and line pressure.

Job: scale the rig's values into integers with decimal digits, clamp at the range, mark what is not valid. Not
its job: noise and lag of the sensors (the plant).
"""

from __future__ import annotations

from sim_hardware.bench.can import emergency
from sim_hardware.bench.can.datatypes import DataType
from sim_hardware.bench.can.dictionary import Access
from sim_hardware.bench.can.node import Device
from sim_hardware.bench.can.settings import AmplifierChannel, AmplifierSettings
from sim_hardware.bench.signals import RigSignals

NOT_VALID, POSITIVE_OVERLOAD, NEGATIVE_OVERLOAD = 1, 2, 4
INVALID_VALUE = -(1 << 31)
BRIDGE_BROKEN = 0x5010
OVERLOADED = 0x2110
UNIT_NM, UNIT_BAR = 0x0056_0000, 0x004E_0000


class Channel:
    """One measuring channel: settings, the output of the rig it measures, and its objects."""

    def __init__(self, number: int, settings: AmplifierChannel, source: str, unit: int) -> None:
        self.number, self.settings, self.source, self.unit = number, settings, source, unit
        self.broken = False
        self.factor = 10.0**settings.digits


class Amplifier(Device):
    """See the manual, node 20h."""

    device_type = 0x0002_0194
    name = "Bench bridge amplifier"

    def __init__(self, settings: AmplifierSettings, signals: RigSignals, delay_ns: int) -> None:
        self._settings, self._signals, self._delay_ns = settings, signals, delay_ns
        self._channels = (
            Channel(1, settings.torque, "torque_nm", UNIT_NM),
            Channel(2, settings.pressure, "pressure_bar", UNIT_BAR),
        )

    def define(self) -> None:
        add, i32, u8 = self.node.add, DataType.INTEGER32, DataType.UNSIGNED8
        for index in (0x9130, 0x6131, 0x6132, 0x6150, 0x9124, 0x6148, 0x6149):
            self.node.dictionary.add_count(index, len(self._channels))
        self._values = [
            add(0x9130, c.number, "process value", i32, Access.RO, mappable=True) for c in self._channels
        ]
        for c in self._channels:
            add(0x6131, c.number, "physical unit", DataType.UNSIGNED32, Access.CONST, c.unit)
        self._digits = [
            add(
                0x6132,
                c.number,
                "decimal digits",
                u8,
                Access.RW,
                c.settings.digits,
                high=6,
                written=self._rescale,
            )
            for c in self._channels
        ]
        self._status = [add(0x6150, c.number, "status", u8, Access.RO, mappable=True) for c in self._channels]
        self._offsets = [
            add(0x9124, c.number, "offset", i32, Access.RW, low=-(1 << 30), high=1 << 30)
            for c in self._channels
        ]
        for c in self._channels:
            add(0x6148, c.number, "range start", DataType.REAL32, Access.CONST, c.settings.low)
            add(0x6149, c.number, "range end", DataType.REAL32, Access.CONST, c.settings.high)
        mapping = tuple((0x9130, c.number, 32) for c in self._channels)
        self._tpdo = self.node.add_tpdo(mapping, self._settings.tpdo_ms)

    def power_on(self) -> None:
        self._rescale()
        for channel in self._channels:
            if channel.broken:
                self.node.emergencies.came(BRIDGE_BROKEN, emergency.PROFILE, channel.number)

    def refresh(self, due_ns: int) -> None:
        t_ns = due_ns - self._delay_ns
        for position, channel in enumerate(self._channels):
            value, status = self._measure(channel, self._signals.at(channel.source, t_ns))
            if status != self._status[position].value:
                self._status[position].value = status
                self._report_overload(channel, status)
            if not status & NOT_VALID:
                offset = self._offsets[position].number()
                value = max(INVALID_VALUE + 1, min((1 << 31) - 2, value - offset))
            self._values[position].value = value

    def disturb(self, *, channel: int, broken: bool) -> None:
        """Break the bridge of a channel (1 torque, 2 pressure), or mend it."""
        if channel not in (1, 2):
            raise ValueError(f"there is no channel {channel}, only 1 (torque) and 2 (pressure)")
        found = self._channels[channel - 1]
        found.broken = broken
        if broken:
            self.node.emergencies.came(BRIDGE_BROKEN, emergency.PROFILE, channel)
        else:
            self.node.emergencies.went(BRIDGE_BROKEN, channel)

    @staticmethod
    def _measure(channel: Channel, physical: float) -> tuple[int, int]:
        """Integer value and status of a physical value."""
        if channel.broken:
            return INVALID_VALUE, NOT_VALID
        settings = channel.settings
        if physical > settings.high:
            return round(settings.high * channel.factor), POSITIVE_OVERLOAD
        if physical < settings.low:
            return round(settings.low * channel.factor), NEGATIVE_OVERLOAD
        return round(physical * channel.factor), 0

    def _report_overload(self, channel: Channel, status: int) -> None:
        if status & (POSITIVE_OVERLOAD | NEGATIVE_OVERLOAD):
            self.node.emergencies.came(OVERLOADED, emergency.PROFILE, channel.number)
        else:
            self.node.emergencies.went(OVERLOADED, channel.number)

    def _rescale(self) -> None:
        for channel, digits in zip(self._channels, self._digits, strict=True):
            channel.factor = 10.0 ** digits.number()

"""Current input 4..20 mA after CiA 404 with the fault limits of NAMUR NE 43; the pyrometer hangs on it.

Job: temperature to current as the pyrometer's analog output makes it, current to object and status. Not its
job: what the current means (the driver knows the pyrometer's range).
"""

from __future__ import annotations

from typing import Literal

from sim_hardware.bench.can import emergency
from sim_hardware.bench.can.datatypes import DataType
from sim_hardware.bench.can.dictionary import Access
from sim_hardware.bench.can.node import Device
from sim_hardware.bench.can.scheduler import NS_PER_MS
from sim_hardware.bench.can.settings import CurrentInputSettings
from sim_hardware.bench.signals import RigSignals

Wire = Literal["ok", "broken", "short", "failure_low", "failure_high"]
WIRES: tuple[Wire, ...] = ("ok", "broken", "short", "failure_low", "failure_high")

NOT_VALID, POSITIVE_OVERLOAD, NEGATIVE_OVERLOAD = 1, 2, 4
UNIT_MICROAMPERE = 0xFA04_0000
CURRENT_FAULT = 0x2130

# NAMUR NE 43, µA
FAULT_LOW, VALID_LOW, VALID_HIGH, FAULT_HIGH = 3600, 3800, 20500, 21000
FAULT_DELAY_MS = 6
#: What the input measures when the wire is broken or shorted, or the transmitter reports failure
_CURRENTS_UA: dict[str, int] = {"broken": 0, "short": 25000, "failure_low": 3500, "failure_high": 21600}


def namur_status(current_ua: int) -> int:
    """Status bits of a current after NAMUR NE 43."""
    if current_ua < FAULT_LOW:
        return NOT_VALID | NEGATIVE_OVERLOAD
    if current_ua > FAULT_HIGH:
        return NOT_VALID | POSITIVE_OVERLOAD
    if current_ua < VALID_LOW:
        return NEGATIVE_OVERLOAD
    return POSITIVE_OVERLOAD if current_ua > VALID_HIGH else 0


class CurrentInput(Device):
    """See the manual, node 21h."""

    device_type = 0x0002_0194
    name = "Bench current input"

    def __init__(self, settings: CurrentInputSettings, signals: RigSignals, delay_ns: int) -> None:
        self._settings, self._signals, self._delay_ns = settings, signals, delay_ns
        self._ua_per_k = 16000.0 / (settings.at_20ma_degc - settings.at_4ma_degc)
        self.wire: Wire = "ok"
        self._fault_since_ns: int | None = None

    def define(self) -> None:
        add = self.node.add
        for index in (0x7130, 0x6131, 0x6132, 0x6150):
            self.node.dictionary.add_count(index, 1)
        self._current = add(0x7130, 1, "current, uA", DataType.INTEGER16, Access.RO, 4000, mappable=True)
        add(0x6131, 1, "physical unit", DataType.UNSIGNED32, Access.CONST, UNIT_MICROAMPERE)
        add(0x6132, 1, "decimal digits", DataType.UNSIGNED8, Access.CONST, 0)
        self._status = add(0x6150, 1, "status", DataType.UNSIGNED8, Access.RO, mappable=True)
        self.node.add_tpdo(((0x7130, 1, 16), (0x6150, 1, 8)), self._settings.tpdo_ms)

    def power_on(self) -> None:
        self._fault_since_ns = None

    def refresh(self, due_ns: int) -> None:
        current_ua = self._measure(due_ns)
        status = namur_status(current_ua)
        if not status & NOT_VALID:
            self._fault_since_ns = None
            self.node.emergencies.went(CURRENT_FAULT, 1)
        else:
            if self._fault_since_ns is None:
                self._fault_since_ns = due_ns
            if due_ns - self._fault_since_ns < FAULT_DELAY_MS * NS_PER_MS:
                status &= ~NOT_VALID  # may be a spike
            else:
                self.node.emergencies.came(CURRENT_FAULT, emergency.CURRENT, 1)
        self._current.value = current_ua
        self._status.value = status

    def disturb(self, *, wire: Wire) -> None:
        """Break or short the wire, let the transmitter report failure, or mend it ("ok")."""
        if wire not in WIRES:
            raise ValueError(f"a wire cannot be {wire!r}, only {', '.join(WIRES)}")
        self.wire = wire

    def _measure(self, due_ns: int) -> int:
        fault_ua = _CURRENTS_UA.get(self.wire)
        if fault_ua is not None:
            return fault_ua
        degc = self._signals.at("disc_temperature_degc", due_ns - self._delay_ns)
        current_ua = 4000.0 + (degc - self._settings.at_4ma_degc) * self._ua_per_k
        return round(max(VALID_LOW, min(VALID_HIGH, current_ua)))  # a transmitter after NE 43 stays within

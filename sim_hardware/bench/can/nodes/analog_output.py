"""Analog output after CiA 401: air of the ventilator, with an error value.

Job: 6411h to air, error value when the controller is gone. Not its job: running up and down (the plant).
"""

from __future__ import annotations

from sim_hardware.bench.can.datatypes import DataType
from sim_hardware.bench.can.dictionary import Access
from sim_hardware.bench.can.node import Device, NmtState
from sim_hardware.bench.can.settings import AnalogOutputSettings
from sim_hardware.bench.signals import RigSignals

FULL_SCALE = 32767
KEEP, USE_ERROR_VALUE = 0, 1


class AnalogOutput(Device):
    """See the manual, node 31h."""

    device_type = 0x0008_0191
    name = "Bench analog output"

    def __init__(self, settings: AnalogOutputSettings, signals: RigSignals) -> None:
        self._settings, self._signals = settings, signals
        self._failed = True

    def define(self) -> None:
        add, settings = self.node.add, self._settings
        for index in (0x6411, 0x6443, 0x6444):
            self.node.dictionary.add_count(index, 1)
        self._output = add(
            0x6411, 1, "analog output", DataType.INTEGER16, Access.RWW, mappable=True, written=self._commanded
        )
        self._mode = add(
            0x6443, 1, "error mode", DataType.UNSIGNED8, Access.RW, settings.error_mode, high=USE_ERROR_VALUE
        )
        self._error_value = add(
            0x6444, 1, "error value", DataType.INTEGER32, Access.RW, settings.error_value,
            low=-32768, high=FULL_SCALE, written=self._actuate,
        )  # fmt: skip
        self.node.add_rpdo(((0x6411, 1, 16),))

    def power_on(self) -> None:
        self._failed = True
        self._actuate()

    def power_off(self) -> None:
        self._signals.set(ventilator_m3_h=0.0)

    def nmt_changed(self, state: NmtState) -> None:
        if state is NmtState.STOPPED:
            self._fail()

    def heartbeat_lost(self, node: int) -> None:
        self._fail()

    def rpdo(self, number: int) -> None:
        self._commanded()

    def _commanded(self) -> None:
        """Somebody commands: that ends the error value, unless the watched heartbeat is still missing."""
        if not self.node.watched_silent:
            self._failed = False
        self._actuate()

    def _fail(self) -> None:
        self._failed = True
        self._actuate()

    def _actuate(self) -> None:
        if self._failed and self._mode.number() == USE_ERROR_VALUE:
            value = self._error_value.number()
        else:
            value = self._output.number()
        air = max(0, min(FULL_SCALE, value)) / FULL_SCALE * self._settings.full_m3_h
        self._signals.set(ventilator_m3_h=air)

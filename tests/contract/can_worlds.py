"""Two worlds for the contracts of pressure actuator and ventilator: emulated CANopen nodes, simulated rig.

Each has the devices under test, lets time pass with a control loop that asks for blocks, and knows the truth.
"""

from __future__ import annotations

import itertools
import math
import os
import threading
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import can

from drivers.pressure.canopen_regulator import CanopenPressureActuator
from drivers.ventilator.canopen_output import CanopenVentilator
from rigctl.config.loading import load_model
from rigctl.hal.devices import RigContext
from sim_hardware.bench.can import BenchCan, BenchCanSettings, FaultRule
from sim_hardware.bench.can.settings import AnalogOutputSettings, RegulatorSettings
from sim_hardware.bench.signals import RigSignals
from sim_hardware.brake_model import load_brake
from sim_hardware.devices import roles
from sim_hardware.plant import Commands, Plant, PlantSettings

CONFIGS = Path(__file__).resolve().parents[2] / "configs"
REGULATOR, OUTPUT = 0x10, 0x31
PRESSURE_SETTINGS: dict[str, Any] = {
    "bus": "main", "node": REGULATOR, "range_bar": 50.0, "configure": True,
    "loss_reaction": {"object": "2100h:0 u8", "vent": 1}, "watch_ms": 600, "silence_s": 0.6,
}  # fmt: skip
VENTILATOR_SETTINGS: dict[str, Any] = {
    "bus": "main", "node": OUTPUT, "full_m3_h": 1000.0, "configure": True, "watch_ms": 600, "silence_s": 0.6,
}  # fmt: skip
QUICK = BenchCanSettings(
    regulator=RegulatorSettings(boot_ms=10), analog_output=AnalogOutputSettings(boot_ms=10)
)
_channels = itertools.count()


class _Line(threading.Thread):
    """A pressure line with a lag between regulator and brake, in real time."""

    LAG_S, STEP_S = 0.03, 0.01

    def __init__(self, signals: RigSignals) -> None:
        super().__init__(name="line", daemon=True)
        self._signals, self.ended, self.pressure_bar = signals, threading.Event(), 0.0

    def run(self) -> None:
        share = 1.0 - math.exp(-self.STEP_S / self.LAG_S)
        while not self.ended.wait(self.STEP_S):
            inputs = self._signals.commands()
            target_bar = 0.0 if inputs.vent else inputs.pressure_set_bar
            self.pressure_bar += share * (target_bar - self.pressure_bar)
            now_ns = time.monotonic_ns()
            values = [self.pressure_bar] * 10
            self._signals.publish(now_ns, pressure_bar=values, regulator_pressure_bar=values)


class _Signals(RigSignals):
    """Signals that say when something is commanded."""

    on_command: Callable[[], None] | None = None

    def set(self, **values: float | bool) -> None:
        super().set(**values)
        if self.on_command is not None:
            self.on_command()


class EmulatedWorld:
    """Drivers on a virtual CAN bus with the bench's nodes; real time."""

    def __init__(self, folder: Path, bench: BenchCanSettings | None = None, **context: Any) -> None:
        self.channel = f"contract-{os.getpid()}-{next(_channels)}"
        self.bus = can.Bus(interface="virtual", channel=self.channel, ignore_config=True)
        self.signals = _Signals()
        self.bench = BenchCan(self.bus, self.signals, bench or QUICK)
        self.bench.start()
        self.bench.wait_booted()
        self.line = _Line(self.signals)
        self.line.start()
        buses = {"main": {"interface": "virtual", "channel": self.channel}}
        self.context = RigContext(folder, "real", None, "rig.toml", folder, buses=buses, **context)
        self._devices: list[Any] = []

    def pressure(self, **changes: Any) -> CanopenPressureActuator:
        return self._kept(CanopenPressureActuator(PRESSURE_SETTINGS | changes, self.context))

    def ventilator(self, **changes: Any) -> CanopenVentilator:
        return self._kept(CanopenVentilator(VENTILATOR_SETTINGS | changes, self.context))

    def _kept(self, device: Any) -> Any:
        self._devices.append(device)
        return device

    def run(self, duration_s: float) -> None:
        """A control loop that asks for blocks."""
        end_s = time.monotonic() + duration_s
        while time.monotonic() < end_s:
            self.context.lease.renew()
            time.sleep(0.02)

    def idle(self, duration_s: float) -> None:
        """Nobody asks for blocks."""
        time.sleep(duration_s)

    def run_until(self, condition: Any, timeout_s: float = 3.0) -> bool:
        end_s = time.monotonic() + timeout_s
        while not condition() and time.monotonic() < end_s:
            self.run(0.02)
        return bool(condition())

    def run_until_idle(self, condition: Any, timeout_s: float = 3.0) -> bool:
        """The same, while nobody asks for blocks."""
        end_s = time.monotonic() + timeout_s
        while not condition() and time.monotonic() < end_s:
            time.sleep(0.005)
        return bool(condition())

    def on_command(self, call: Callable[[], None]) -> None:
        """Have something called in the nodes' thread whenever a node commands the plant."""
        self.signals.on_command = call

    def line_bar(self) -> float:
        return self.line.pressure_bar

    def air_m3_h(self) -> float:
        return float(self.signals.get("ventilator_m3_h"))

    def inject(self, **rule: Any) -> None:
        self.bench.add_fault(FaultRule(**rule))

    def fault(self, device: str) -> str:
        faults: Mapping[str, str] = self.context.board.snapshot().get("faults", {})
        return faults.get(device, "")

    def close(self) -> None:
        for device in self._devices:
            device.close()
        self.line.ended.set()
        self.line.join()
        self.bench.stop()
        self.bus.shutdown()


class SimulatedWorld:
    """The simulated devices in front of the plant, stepped at once."""

    def __init__(self, folder: Path) -> None:
        settings = load_model(CONFIGS / "plants" / "a_class.toml", PlantSettings)
        self.plant = Plant(settings, load_brake(CONFIGS / "brakes" / "plant.toml"), seed=1)
        self.context = RigContext(folder, "virtual", 1, "rig.toml", folder)
        self.session = roles.SimulatedSession(self.context)
        self.opened = 0
        self.session.open = lambda: setattr(self, "opened", self.opened + 1)  # type: ignore[method-assign]
        self.session.close = lambda: setattr(self, "opened", self.opened - 1)  # type: ignore[method-assign]
        self.context.share("simulated", lambda: self.session)

    def pressure(self) -> roles.SimulatedPressureActuator:
        return roles.SimulatedPressureActuator({}, self.context)

    def ventilator(self) -> roles.SimulatedVentilator:
        return roles.SimulatedVentilator({}, self.context)

    def run(self, duration_s: float) -> None:
        points = self.session.setpoints
        commands = Commands(
            speed_set_rpm=0.0, speed_ramp_rpm_per_s=50.0, drive_enabled=False, quick_stop=False,
            pressure_set_bar=points.pressure_bar, vent=points.vent, ventilator_m3_h=points.ventilator_m3_h,
            relay_closed=True,
        )  # fmt: skip
        for _ in range(math.ceil(duration_s / 0.05)):
            self.plant.step(50_000_000, commands, full_rate=False)

    def run_until(self, condition: Any, timeout_s: float = 10.0) -> bool:
        for _ in range(math.ceil(timeout_s / 0.05)):
            if condition():
                break
            self.run(0.05)
        return bool(condition())

    def line_bar(self) -> float:
        return self.plant.truth.pressure_bar

    def air_m3_h(self) -> float:
        return self.plant.truth.ventilator_m3_h

    def close(self) -> None:
        """Nothing runs."""

"""Speed drives for the contract: the simulated one, and each driver with its emulator and a shaft.

Job: one `DriveUnderTest` for each kind, with the same handles. Not its job: assertions.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from drivers.dc_drive.eurotherm590 import Eurotherm590Drive
from drivers.dc_drive.modbus import ModbusDrive
from rigctl.hal.devices import RigContext
from sim_hardware.bench.serial.abb_drive import AbbDriveSettings
from sim_hardware.bench.serial.bench import AbbDrivePort, Drive590Port, SerialSettings, make_ports
from sim_hardware.bench.serial.line import Line
from sim_hardware.bench.serial.ports import SerialPort
from sim_hardware.bench.signals import RigSignals
from sim_hardware.devices.roles import SimulatedDrive

CONFIGS = Path(__file__).resolve().parents[2] / "configs"
FULL_SPEED_RPM = 1000.0
SAFE_LOSS = {"58.16": 1.0}
#: A loaded test machine answers late; what is tested are reactions, not times.
PATIENCE = {"reply_timeout_s": 0.25, "deadline_s": 0.6}


class Shaft:
    """A shaft that follows the commands along their ramp; without torque it stops in a second."""

    def __init__(self, signals: RigSignals) -> None:
        self._signals = signals
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self.speed_rpm = 0.0
        self._thread.start()

    def _run(self) -> None:
        last_s = time.monotonic()
        while not self._stop.wait(0.01):
            now_s = time.monotonic()
            inputs = self._signals.commands()
            aim = inputs.speed_set_rpm if inputs.drive_enabled else 0.0
            rate = inputs.speed_ramp_rpm_per_s if inputs.drive_enabled else FULL_SPEED_RPM
            step = rate * (now_s - last_s)
            self.speed_rpm += max(-step, min(step, aim - self.speed_rpm))
            self._signals.publish(time.monotonic_ns(), speed_rpm=[self.speed_rpm])
            last_s = now_s

    def close(self) -> None:
        self._stop.set()
        self._thread.join()


class Loop:
    """A control loop that asks for blocks: renews the lease until it is stopped."""

    def __init__(self, context: RigContext) -> None:
        self._context = context
        self._stop = threading.Event()
        context.lease.renew()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while not self._stop.wait(0.02):
            self._context.lease.renew()

    def stop(self) -> None:
        self._stop.set()
        self._thread.join()


@dataclass
class DriveUnderTest:
    """A drive and what is behind it.

    Attributes
    ----------
    torque_on : callable
        Whether the motor gets torque: seen from the plant, not from the driver.
    speed_set_rpm : callable
        The set-point that has reached the plant.
    """

    drive: Any
    context: RigContext
    torque_on: Callable[[], bool]
    speed_set_rpm: Callable[[], float]
    close_relay: Callable[[bool], None]
    loop: Loop
    port: SerialPort | None = None
    signals: RigSignals | None = None
    shaft: Shaft | None = None
    extra: dict[str, Any] = field(default_factory=dict)


def until(condition: Callable[[], bool], timeout_s: float = 5.0, what: str = "condition") -> None:
    """Wait for it, or fail."""
    end_s = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < end_s, f"{what} did not come within {timeout_s} s"
        time.sleep(0.005)


def make_context(tmp_path: Path) -> RigContext:
    return RigContext(tmp_path, "real", 1, "rig.toml", CONFIGS / "rigs")


@contextmanager
def simulated(tmp_path: Path) -> Iterator[DriveUnderTest]:
    """The simulated drive; no server is started: the set-points are what travels with the next block."""
    context = make_context(tmp_path)
    drive = SimulatedDrive({}, context)
    session = context.share("simulated", lambda: None)
    session.status = {"relay": True}

    class _NoServer:
        open = staticmethod(lambda: None)

    drive.open = _NoServer.open  # pyright: ignore[reportAttributeAccessIssue]
    loop = Loop(context)
    points = session.setpoints
    try:
        yield DriveUnderTest(
            drive, context,
            torque_on=lambda: points.enable and not points.quick_stop,
            speed_set_rpm=lambda: points.speed_rpm,
            close_relay=lambda closed: session.status.update(relay=closed),
            loop=loop,
        )  # fmt: skip
    finally:
        loop.stop()


@contextmanager
def emulated(
    tmp_path: Path,
    kind: str,
    *,
    parameters: Mapping[str, float] | None = None,
    tcp: bool = False,
    line_baud: int | None = None,
    **settings: Any,
) -> Iterator[DriveUnderTest]:
    """A driver with its emulator behind a pty."""
    context = make_context(tmp_path)
    signals = RigSignals()
    signals.set(relay_closed=True)
    tcp_port = 0 if tcp else None
    if kind == "modbus":
        device = AbbDriveSettings(parameters={**SAFE_LOSS, **(parameters or {})})
        line = Line(baud=line_baud or 115200)
        serial = SerialSettings(drive=AbbDrivePort(line=line, device=device, tcp=tcp_port))
    else:
        line = Line(baud=line_baud or 19200, data_bits=7, parity="E")
        serial = SerialSettings(drive590=Drive590Port(line=line, tcp=tcp_port))
    (port,) = make_ports(serial, signals, tmp_path / "ports", seed=1).values()
    shaft = Shaft(signals)
    loop = Loop(context)
    with port:
        common = {"port": port.address, "full_speed_rpm": FULL_SPEED_RPM, **PATIENCE, **settings}
        if kind == "modbus":
            common = {"map": "../devices/abb_drives_profile.toml", **common}
            drive = ModbusDrive(common, context)
        else:
            common = {"map": "../devices/eurotherm_590.toml", "baud": 19200, **common}
            drive = Eurotherm590Drive(common, context)
        try:
            yield DriveUnderTest(
                drive, context,
                torque_on=lambda: bool(signals.get("drive_enabled")),
                speed_set_rpm=lambda: float(signals.get("speed_set_rpm")),
                close_relay=lambda closed: signals.set(relay_closed=closed),
                loop=loop, port=port, signals=signals, shaft=shaft, extra={"settings": common},
            )  # fmt: skip
        finally:
            drive.close()
            loop.stop()
            shaft.close()
            assert port.failure is None, port.failure

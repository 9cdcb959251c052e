"""All serial ports of a bench, from its settings.

Job: settings (`SerialSettings`, the table ``[serial]`` of a bench file) and the making of ports. Not its job:
the plant, the command socket (`sim_hardware.bench.process`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from sim_hardware.bench.serial.abb_drive import AbbDrive, AbbDriveSettings
from sim_hardware.bench.serial.drive590 import Drive590, Drive590Settings
from sim_hardware.bench.serial.line import Line
from sim_hardware.bench.serial.ports import SerialPort
from sim_hardware.bench.serial.pyrometer import Pyrometer, PyrometerSettings
from sim_hardware.bench.signals import RigSignals


class _Port(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    tcp: Annotated[int, Field(ge=0, le=65535)] | None = None
    """A TCP port on 127.0.0.1 instead of a pty; 0 is any free one."""


class AbbDrivePort(_Port):
    """``[serial.drive]``"""

    line: Line = Line(baud=115200)
    device: AbbDriveSettings = AbbDriveSettings()


class Drive590Port(_Port):
    """``[serial.drive590]``"""

    line: Line = Line(baud=9600, data_bits=7, parity="E")
    device: Drive590Settings = Drive590Settings()


class PyrometerPort(_Port):
    """``[serial.pyrometer]``"""

    line: Line = Line(baud=19200, parity="E")
    device: PyrometerSettings = PyrometerSettings()


class SerialSettings(BaseModel):
    """The table ``[serial]`` of a bench file. A port that is left out does not exist.

    Only one of the two drives turns the plant's shaft: the bench file names one of them.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    drive: AbbDrivePort | None = None
    drive590: Drive590Port | None = None
    pyrometer: PyrometerPort | None = None


def make_ports(
    settings: SerialSettings, signals: RigSignals, folder: Path, *, seed: int = 0
) -> dict[str, SerialPort]:
    """Ports by name, not started yet.

    Parameters
    ----------
    settings : SerialSettings
    signals : RigSignals
        What the devices read and command.
    folder : Path
        Where the links go.
    seed : int
        Seed of the fault seams.
    """
    ports: dict[str, SerialPort] = {}
    if settings.drive is not None:
        entry = settings.drive
        device = AbbDrive(signals, entry.line, entry.device)
        ports["drive"] = SerialPort("drive", device, entry.line, folder, tcp=entry.tcp, seed=seed)
    if settings.drive590 is not None:
        entry = settings.drive590
        device = Drive590(signals, entry.device)
        ports["drive590"] = SerialPort("drive590", device, entry.line, folder, tcp=entry.tcp, seed=seed + 1)
    if settings.pyrometer is not None:
        entry = settings.pyrometer
        device = Pyrometer(signals, entry.device)
        ports["pyrometer"] = SerialPort("pyrometer", device, entry.line, folder, tcp=entry.tcp, seed=seed + 2)
    return ports

"""The folder of all calibrations of a rig: one TOML file each, kept for ever, the newest of a quantity holds.

Job: save (never over an older file), history, what is in force, what is due. Not its job: what is in them.

::

    <data>/calibrations/<rig>/torque-20261130-093000.toml
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date
from pathlib import Path

import tomli_w

from rigctl.calibration.record import Calibration, Due, Quantity
from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from rigctl.core.errors import ConfigError
from rigctl.recording.durable import disk_error, publish, write_part

FOLDER = "calibrations"


@dataclass(frozen=True, slots=True)
class Kept:
    """A calibration and its file."""

    path: Path
    calibration: Calibration


@dataclass(frozen=True, slots=True)
class DueLine:
    """One line of the overview: a quantity, what is in force, and when the next is due."""

    quantity: Quantity
    kept: Kept | None
    state: Due


def rig_folder(data_folder: Path, rig_name: str) -> Path:
    """Where the calibrations of a rig are kept."""
    return data_folder / FOLDER / (re.sub(r"[^A-Za-z0-9]+", "-", rig_name).strip("-").lower() or "rig")


def calibration_folder(rig: RigConfig, rig_file: Path, data_folder: Path) -> Path:
    """Where the calibrations of a rig are: named in its file, else in the data folder."""
    if rig.calibrations is not None:
        return (rig_file.resolve().parent / rig.calibrations.folder).resolve()
    return rig_folder(data_folder, rig.name)


def save(folder: Path, calibration: Calibration) -> Path:
    """Keep a calibration; returns its file. The file appears whole or not at all, and none is overwritten.

    Raises
    ------
    RecordingError
        The disk is full or fails.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise disk_error(error, folder, "make the folder of calibrations") from error
    data = tomli_w.dumps(calibration.model_dump(mode="json", exclude_none=True)).encode()
    name = f"{calibration.quantity}-{calibration.date:%Y%m%d-%H%M%S}"
    for number in range(1, 1000):
        path = folder / (f"{name}.toml" if number == 1 else f"{name}-{number}.toml")
        try:
            os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o644))
        except FileExistsError:
            continue
        except OSError as error:
            raise disk_error(error, path, "make the file") from error
        part = path.with_suffix(".part")
        try:
            write_part(part, data)
            publish(part, path)
        except BaseException:
            path.unlink(missing_ok=True)
            raise
        return path
    raise ConfigError("too many calibrations of one second.", place=str(folder), remedy="Wait a second.")


def history(folder: Path) -> tuple[list[Kept], list[str]]:
    """All calibrations, newest first, and what is wrong with files that cannot be read, a line each."""
    kept: list[Kept] = []
    faults: list[str] = []
    for path in sorted(folder.glob("*.toml")) if folder.is_dir() else []:
        try:
            kept.append(Kept(path, load_model(path, Calibration)))
        except ConfigError as error:
            faults.append(str(error))
    kept.sort(key=lambda entry: (entry.calibration.date, entry.path.name), reverse=True)
    return kept, faults


def in_force(folder: Path) -> dict[Quantity, Kept]:
    """The newest calibration of each quantity.

    Raises
    ------
    ConfigError
        A file cannot be read: a rig must not run on an older calibration by accident.
    """
    kept, faults = history(folder)
    if faults:
        raise ConfigError("\n".join(faults))
    return newest(kept)


def newest(kept: Sequence[Kept]) -> dict[Quantity, Kept]:
    """Of each quantity the first of a history, which is sorted newest first."""
    found: dict[Quantity, Kept] = {}
    for entry in kept:
        found.setdefault(entry.calibration.quantity, entry)
    return found


def due_lines(kept: Sequence[Kept], today: date) -> list[DueLine]:
    """One line for each quantity that can be calibrated."""
    force = newest(kept)
    return [
        DueLine(
            quantity,
            force.get(quantity),
            force[quantity].calibration.state(today) if quantity in force else Due.NEVER,
        )
        for quantity in Quantity
    ]

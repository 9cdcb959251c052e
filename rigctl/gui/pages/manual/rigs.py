"""The rigs that can be chosen: read from the files of a folder, wrong ones with what is wrong.

Job: a list for the connect panel, made in a thread; limits of the watchdog for the indicators. Not its job:
building or opening a rig (the controller does).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from rigctl.core.errors import RigctlError
from rigctl.gui.pages.manual.model import WatchdogLimits


@dataclass(frozen=True)
class RigChoice:
    """One rig file; `problem` says why it cannot be used, "" when it can."""

    path: Path
    name: str
    simulated: bool = False
    problem: str = ""


def list_rigs(folder: Path, _reporter: Any = None) -> list[RigChoice]:
    """Rig files of a folder: simulated ones first, then by name, wrong ones last."""
    choices: list[RigChoice] = []
    for path in sorted(folder.glob("*.toml")):
        try:
            rig = load_model(path, RigConfig)
        except RigctlError as error:
            choices.append(RigChoice(path, path.name, problem=str(error)))
        else:
            choices.append(RigChoice(path, rig.name, rig.simulated))
    return sorted(choices, key=lambda choice: (bool(choice.problem), not choice.simulated, choice.name))


def read_watchdog_limits(path: Path, _reporter: Any = None) -> WatchdogLimits:
    """Where the watchdog would stop the rig.

    Raises
    ------
    RigctlError, ValueError, OSError
        The file cannot be read.
    """
    from rigctl.safety.limits import load_limits

    limits = load_limits(path).limits
    return WatchdogLimits(
        speed_rpm=limits.speed.max_rpm,
        pressure_bar=limits.pressure.max_bar,
        torque_nm=limits.torque.max_nm,
        temperature_degc=limits.disc_temperature.max_degc,
    )

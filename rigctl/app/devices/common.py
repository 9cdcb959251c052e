"""What the commands of `rigctl devices` share: options, and how a value looks.

Not its job: any command.
"""

from __future__ import annotations

import math
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from rigctl.config.rig import ROLES
from rigctl.hal.diagnosis import Reading


class Role(StrEnum):
    """The roles of `rigctl.config.rig.ROLES`, as an option."""

    DRIVE = "drive"
    PRESSURE = "pressure"
    VENTILATOR = "ventilator"
    ACQUISITION = "acquisition"
    SAFETY = "safety"


RigArgument = Annotated[
    Path, typer.Argument(help="Rig file, e.g. configs/rigs/lab-example.toml.", metavar="RIG")
]
RoleOption = Annotated[
    list[Role] | None, typer.Option("--role", help="Only this device. Repeatable. [default: all]")
]
WireLogOption = Annotated[
    Path | None,
    typer.Option(
        "--wire-log",
        metavar="DIR",
        help="Log every transfer there: serial as hex with time, CAN as candump does.",
    ),
]
_WIDE = 160


def console() -> Console:
    """Console for results; a pipe or a file folds nothing."""
    screen = Console(soft_wrap=True, highlight=False)
    return screen if screen.is_terminal else Console(soft_wrap=True, highlight=False, width=_WIDE)


def roles_of(chosen: list[Role] | None) -> list[str]:
    """The roles asked for, in the order of the rig file."""
    return [role for role in ROLES if not chosen or role in {entry.value for entry in chosen}]


def value_text(reading: Reading) -> str:
    """A value with its unit; a dash where it is not valid."""
    value = reading.value
    if value is None or (isinstance(value, float) and not math.isfinite(value)):
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    text = f"{value:.6g}" if isinstance(value, float) else str(value)
    return f"{text} {reading.unit}".rstrip()


def seconds_text(seconds: float | None) -> str:
    """A short time, in ms below one second."""
    if seconds is None:
        return ""
    if not math.isfinite(seconds):
        return "never"
    return f"{seconds * 1e3:.3g} ms" if seconds < 1.0 else f"{seconds:.1f} s"

"""`rigctl calibrations …`: what is calibrated on a rig, by whom, and when the next is due.

Job: which calibrations hold for a run, the overview on the command line. Not its job: making one (the
window's Service page), their contents (`rigctl.calibration`).
"""

from __future__ import annotations

import json
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from rigctl.app import exit_codes
from rigctl.app.compose import read_rig
from rigctl.calibration.record import Calibration, Due
from rigctl.calibration.store import DueLine, calibration_folder, due_lines, history, in_force
from rigctl.config.rig import RigConfig

_WORDS = {
    Due.VALID: "valid until {0}",
    Due.SOON: "due on {0}",
    Due.OVERDUE: "OVERDUE since {0}",
    Due.NEVER: "never calibrated",
}


def for_run(rig: RigConfig, rig_path: Path, data_folder: Path) -> tuple[Calibration, ...]:
    """What is in force now, to be frozen with a campaign.

    Raises
    ------
    ConfigError
        A file of the folder cannot be read.
    """
    return tuple(
        kept.calibration for kept in in_force(calibration_folder(rig, rig_path, data_folder)).values()
    )


def register(app: typer.Typer) -> None:
    """Add `rigctl calibrations` to the command line."""
    family = typer.Typer(
        name="calibrations",
        help="Calibrations of a rig's sensors. They are made on the window's Service page.",
        no_args_is_help=True,
    )
    family.command("list")(_list)
    app.add_typer(family)


def _list(
    rig: Annotated[Path, typer.Argument(help="Rig file, e.g. configs/rigs/simulated.toml.")],
    out: Annotated[Path, typer.Option("--out", help="Folder for campaigns.")] = Path("data"),
    older: Annotated[bool, typer.Option("--all", help="All that were ever made.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """What holds, what is due. Exit code 1 when one is overdue or a file cannot be read."""
    folder = calibration_folder(read_rig(rig), rig, out)
    kept, faults = history(folder)
    lines = due_lines(kept, datetime.now(UTC).date())
    if as_json:
        print(json.dumps(_mapping(folder, lines, faults), indent=1, ensure_ascii=False))
    else:
        console = Console(soft_wrap=True)
        console.print(f"Calibrations in {folder}", highlight=False, markup=False)
        for line in lines:
            console.print(line_text(line), highlight=False, markup=False)
        if older:
            for entry in kept:
                console.print(f"{entry.path.name}  {_what(entry.calibration)}", highlight=False, markup=False)
        for fault in faults:
            console.print(fault, highlight=False, markup=False)
    bad = faults or any(line.state is Due.OVERDUE for line in lines)
    raise typer.Exit(exit_codes.FAILED if bad else exit_codes.OK)


def line_text(line: DueLine) -> str:
    """One quantity: due date and what it was."""
    if line.kept is None:
        return f"{line.quantity:12}{_WORDS[line.state]}"
    found = line.kept.calibration
    return f"{line.quantity:12}{_WORDS[line.state].format(found.due)}; {_what(found)}"


def _what(found: Calibration) -> str:
    result = f"gain {found.gain:.5g}, offset {found.offset:.4g} {found.unit}"
    if found.emissivity is not None:
        result = f"emissivity {found.emissivity:.3f}, {result}"
    return f"{result}; {found.date:%Y-%m-%d %H:%M} UTC by {found.operator}"


def _mapping(folder: Path, lines: list[DueLine], faults: list[str]) -> dict[str, Any]:
    return {
        "folder": str(folder),
        "calibrations": [
            {
                "quantity": line.quantity.value,
                "state": line.state.value,
                "file": str(line.kept.path) if line.kept else None,
                **(line.kept.calibration.summary() if line.kept else {}),
            }
            for line in lines
        ],
        "faults": faults,
    }

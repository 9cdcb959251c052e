"""`rigctl compare A B`: whether two campaigns of one program agree, as a table and an exit code.

Job: options, table, words. Not its job: the comparison (`rigctl.analysis.compare`).
"""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.console import Console
from rich.table import Table

from rigctl.app import exit_codes
from rigctl.core.units import unit_of

if TYPE_CHECKING:
    from rigctl.analysis.compare import Compared, Comparison

DEFAULT_TOLERANCES = Path("configs/tolerances/same_program.toml")
_WIDE = 160


def register(app: typer.Typer) -> None:
    """Add `rigctl compare` to the command line."""
    app.command("compare")(_compare)


def _compare(
    a: Annotated[Path, typer.Argument(metavar="A", help="Campaign folder, the reference.")],
    b: Annotated[Path, typer.Argument(metavar="B", help="Campaign folder of the same program.")],
    tolerances: Annotated[
        Path, typer.Option("--tolerances", metavar="FILE", help="What may differ by how much.")
    ] = DEFAULT_TOLERANCES,
    as_json: Annotated[bool, typer.Option("--json", help="Everything, as JSON.")] = False,
) -> None:
    """Compare two campaigns of one program, braking by braking, against tolerances.

    Exit code 0 when they agree, 1 when they do not.
    """
    from rigctl.analysis.campaign_table import read_campaign
    from rigctl.analysis.compare import compare, read_tolerances

    limits = read_tolerances(tolerances)
    found = compare(read_campaign(a), read_campaign(b), limits)
    if as_json:
        print(json.dumps(_plain({"agree": found.agree, **dataclasses.asdict(found)}), indent=1))
    else:
        screen = Console(soft_wrap=True, highlight=False)
        show(found, screen if screen.is_terminal else Console(highlight=False, width=_WIDE))
    raise typer.Exit(exit_codes.OK if found.agree else exit_codes.FAILED)


def show(found: Comparison, console: Console) -> None:
    """The table, and a sentence for everything that keeps the campaigns from agreeing."""
    table = Table(title=f"{found.pairs} pairs of brakings")
    for title in (
        "result",
        "pairs",
        "mean A",
        "mean B",
        "allowed",
        "worst B − A",
        "at braking",
        "allowed",
        "",
    ):
        table.add_column(title, justify="left" if title in ("result", "") else "right")
    for entry in found.quantities:
        table.add_row(*_cells(entry))
    console.print(table)
    for one, other, missing in (("A", "B", found.only_a), ("B", "A", found.only_b)):
        if missing:
            console.print(f"Complete in {one} and not in {other}: {_listed(missing)}.")
    if found.squeal_differs:
        console.print(
            f"Squeal in one campaign only: {_listed(found.squeal_differs)}; "
            f"{found.squeal_may_differ} may differ."
        )
    if not found.pairs:
        console.print("No braking counts in both campaigns.")
    console.print(
        "The campaigns agree within the tolerances." if found.agree else "The campaigns do NOT agree."
    )


def _cells(entry: Compared) -> tuple[str, ...]:
    unit = unit_of(entry.name)
    name = f"{entry.name.rpartition('_')[0]}, {unit}" if unit else entry.name
    problems = [f"outside: {_listed(entry.outside)}"] if entry.outside else []
    problems += [] if entry.means_agree else ["means differ"]
    verdict = ", ".join(problems) or ("ok" if entry.pairs else "nowhere")
    mean_allowed = "" if entry.mean_allowed is None else _number(entry.mean_allowed)
    at = "" if entry.worst_index is None else str(entry.worst_index)
    means = (_number(entry.mean_a), _number(entry.mean_b), mean_allowed)
    return (name, str(entry.pairs), *means, _number(entry.worst), at, _number(entry.allowed), verdict)


def _number(value: float) -> str:
    return "" if math.isnan(value) else f"{value:.4g}"


def _listed(numbers: tuple[int, ...], at_most: int = 12) -> str:
    more = f" and {len(numbers) - at_most} more" if len(numbers) > at_most else ""
    return "braking " + ", ".join(map(str, numbers[:at_most])) + more


def _plain(value: object) -> object:
    """NaN has no JSON."""
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(entry) for entry in value]
    return None if isinstance(value, float) and math.isnan(value) else value

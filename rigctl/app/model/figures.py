"""`rigctl model figures`: the paper's figures from our model.

NOT its job: the figures (`rigctl.model.paper`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rigctl.app.model.common import console, rich_table
from rigctl.core.errors import ConfigError


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("figures")(figures)


def figures(
    only: Annotated[
        list[str] | None,
        typer.Option(
            "--only", metavar="NUMBER", help="Figures to make: 1a, 1b, 7, 8, 9, 10, 11, 13. Repeatable."
        ),
    ] = None,
    brakes: Annotated[Path, typer.Option("--brakes", help="Folder of model.toml and basic.toml.")] = Path(
        "configs/brakes"
    ),
    out: Annotated[Path, typer.Option("--out", help="Folder for page, figures and tables.")] = Path(
        "figures"
    ),
) -> None:
    """Make the paper's figures 1, 7 to 11 and 13 from our model, its numbers beside ours, on one page."""
    from rigctl.model.paper import FIGURES, numbers_table, paper_figures, write_page

    known = [figure.key for figure in FIGURES]
    for number in only or ():
        if number not in known:
            raise ConfigError(
                "no such figure.",
                place=f"--only {number}",
                value=number,
                remedy=f"Known: {', '.join(known)}.",
            )
    screen = console()
    made = []
    for figure, study in paper_figures(brakes, only or ()):
        screen.print(f"{figure.number}: {study.title}")
        made.append((figure, study))
    page = write_page(made, brakes, out)
    screen.print(rich_table(numbers_table(made), None))
    screen.print(f"Page: {page}")

"""What all `rigctl model` commands share: options, reading models, printing and writing a study.

Job: one way to name models, ranges and formats, one look of results. NOT its job: any study.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table as RichTable

from rigctl.core.errors import ConfigError
from rigctl.model.formats import FORMATS

if TYPE_CHECKING:
    from rigctl.model.output import Study, Table

ModelArgument = Annotated[
    Path,
    typer.Argument(
        help="Brake file (.toml), or matrices made elsewhere (.npz, .mat, folder of .mtx).", metavar="MODEL"
    ),
]
OutOption = Annotated[
    Path | None, typer.Option("--out", help="Folder for figures, tables and JSON. [default: print only]")
]
FormatOption = Annotated[
    str, typer.Option("--format", help=f"Files to write, comma-separated: {', '.join(FORMATS)}.")
]
SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="NAME=VALUE", help="Other value for a quantity (SI; pressure in bar). Repeatable."
    ),
]
DEFAULT_FORMATS = "png,svg,csv,json"
_LINES = 24
_WIDE = 160


def console() -> Console:
    """Console for results."""
    screen = Console(soft_wrap=True, highlight=False)
    if not screen.is_terminal:
        screen = Console(soft_wrap=True, highlight=False, width=_WIDE)  # a pipe or a file folds nothing
    return screen


def parse_settings(texts: list[str] | None) -> dict[str, float]:
    """`--set name=value` options as a dictionary.

    Raises
    ------
    ConfigError
        not NAME=NUMBER, or a name twice
    """
    values: dict[str, float] = {}
    for text in texts or ():
        name, _, number = text.partition("=")
        name = name.strip()
        try:
            value = float(number)
        except ValueError:
            value = float("nan")
        if not name or name in values or math.isnan(value):
            raise ConfigError(
                "is not NAME=NUMBER, or names a quantity twice.",
                place=f"--set {text}", value=text, remedy="For example --set mu=0.45 --set c_pis_n=2.2e8.",
            )  # fmt: skip
        values[name] = value
    return values


def finish(
    study: Study,
    out: Path | None,
    formats: str,
    *,
    tables: tuple[str, ...] | None = None,
    lines: int | None = _LINES,
) -> None:
    """Print a study, and write its files where `--out` is given.

    `tables`: names of the tables to print (all where None), `lines` of each (all where None); files always
    get everything.
    """
    screen = console()
    screen.print(f"[bold]{escape(study.title)}[/bold]")
    for key, value in study.facts.items():
        if not isinstance(value, dict | list | tuple):
            screen.print(f"  {key.replace('_', ' ')}: {cell(value)}")
    for table in study.tables:
        if tables is None or table.name in tables:
            screen.print(rich_table(table, lines))
    if out is not None:
        from rigctl.model.output import write

        paths = write(study, out, tuple(f.strip() for f in formats.split(",") if f.strip()))
        screen.print(f"{len(paths)} files in {out}: {', '.join(path.name for path in paths)}")


def rich_table(table: Table, lines: int | None = _LINES) -> RichTable:
    """A table for the console; its first lines where it is long."""
    from rigctl.model.output import plain

    shown = RichTable(
        title=escape(table.title), title_justify="left", title_style="bold", header_style="", box=None
    )
    for column in table.columns:
        numeric = all(isinstance(plain(v), int | float | None) for v in column.values)
        first = column is table.columns[0]
        shown.add_column(
            escape(column.heading.replace("_", " ")),
            justify="right" if numeric else "left",
            no_wrap=first or numeric,
        )
    rows = table.rows()
    for row in rows[:lines]:
        shown.add_row(*(escape(cell(value)) for value in row))
    if lines is not None and len(rows) > lines:
        shown.caption = f"… {len(rows) - lines} more lines; --out writes all"
    return shown


def cell(value: Any) -> str:
    """A value for people: six significant digits."""
    from rigctl.model.output import plain

    value = plain(value)
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.6g}" if isinstance(value, float) else str(value)

"""`rigctl model map` and `rigctl model boundary`: where a brake is stable.

NOT its job: the studies (`rigctl.model.maps`).
"""

from __future__ import annotations

from typing import Annotated

import typer

from rigctl.app.model.common import (
    DEFAULT_FORMATS,
    FormatOption,
    ModelArgument,
    OutOption,
    SetOption,
    finish,
    parse_settings,
)
from rigctl.app.model.ranges import RANGE_METAVAR, parse_range, parse_search


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.command("map")(stability_map)
    app.command("boundary")(boundary)


def stability_map(
    model: ModelArgument,
    x: Annotated[
        str,
        typer.Option(
            "--x",
            metavar=RANGE_METAVAR,
            help="Horizontal axis: mu:0:1:128, slope:0:0.1:64, c_pis_n:1e8:4e8:64.",
        ),
    ] = "mu:0:1:128",
    y: Annotated[
        str,
        typer.Option(
            "--y",
            metavar=RANGE_METAVAR,
            help="Vertical axis. A parameter group moves as a whole by a share: "
            "piston_stiffness:-0.3:0.3:64; piston_position:clockwise:-0.2:0.2:64 moves leading up, "
            "trailing down.",
        ),
    ] = "pressure:0:30:128",
    workers: Annotated[int, typer.Option("--workers", min=1, help="Threads.")] = 1,
    settings: SetOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Map of stability over two quantities: growth rate, and the exact boundary with its frequencies.

    All eigenvalues at every point, by a secular equation continued from point to point (about a hundred times
    faster than LAPACK); points that its guards do not pass go to LAPACK, their share is printed.

    rigctl model map configs/brakes/model.toml --x mu:0:1:256 --y pressure:0:30:256 --out results

    rigctl model map configs/brakes/basic.toml --x mu:0:1:128 --y contact_stiffness:clockwise:-0.3:0.3:128
    """
    from rigctl.model.loading import read_model, study_errors
    from rigctl.model.maps import map_study

    values = parse_settings(settings)
    ranges = parse_range(x, "--x"), parse_range(y, "--y")
    loaded = read_model(model)
    with study_errors(str(model)):
        study = map_study(loaded, *ranges, values, workers=workers)
    finish(study, out, formats, tables=("boundary",))


def boundary(
    model: ModelArgument,
    over: Annotated[
        str,
        typer.Option(
            "--over",
            metavar="NAME[:FROM:TO]",
            help="What is moved until stability is lost, and the range searched from FROM on. Without range: "
            "mu 0 to 1, pressure 0 to 30 bar, anything else its value up and down by half. Groups as in "
            "`map`.",
        ),
    ] = "pressure",
    along: Annotated[
        str | None,
        typer.Option(
            "--along",
            metavar=RANGE_METAVAR,
            help="Repeat for every value of another quantity: slope:0.02:0.12:41.",
        ),
    ] = None,
    settings: SetOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Exact stability boundary: the first value at which a pair becomes unstable, and its frequency.

    Newton's method with the analytic derivative of the eigenvalue (eq. 24) after a search that is safe
    against modes changing places; flutter or divergence is named. With --along a curve: critical pressure
    over slope, critical friction over a stiffness.

    rigctl model boundary configs/brakes/model.toml --over pressure --set slope=0.0576

    rigctl model boundary configs/brakes/model.toml --over pressure:0:60 --along slope:0.02:0.12:41

    rigctl model boundary configs/brakes/basic.toml --over c_con_it --set mu=0.6
    """
    from rigctl.model.loading import read_model, study_errors
    from rigctl.model.maps import boundary_study, curve_study

    values = parse_settings(settings)
    name, search = parse_search(over, "--over")
    course = None if along is None else parse_range(along, "--along")
    loaded = read_model(model)
    with study_errors(str(model)):
        if course is None:
            study = boundary_study(loaded, name, search, values)
        else:
            study = curve_study(loaded, name, course, search, values)
    finish(study, out, formats)

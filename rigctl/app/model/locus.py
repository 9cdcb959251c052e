"""`rigctl model locus`: eigenvalues over a quantity, mode by mode.

NOT its job: the study (`rigctl.model.locus`).
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
from rigctl.app.model.ranges import RANGE_METAVAR, parse_range
from rigctl.core.errors import ConfigError


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("locus")(locus)


def locus(
    model: ModelArgument,
    over: Annotated[
        str,
        typer.Option(
            "--over",
            metavar=RANGE_METAVAR,
            help="What is varied: mu:0.47:0.69:23, pressure:0:25:26 (bar), c_pis_n:1e8:4e8:50; with --group "
            "factor:0.8:1.2:41 (1: as in the file).",
        ),
    ] = "mu:0:1:51",
    group: Annotated[
        str | None,
        typer.Option("--group", metavar="NAME", help="Vary a parameter group by a common relative factor."),
    ] = None,
    asymmetric: Annotated[
        bool,
        typer.Option(
            "--asymmetric", help="With --group: leading members by the factor s, trailing ones by 2 - s."
        ),
    ] = False,
    figure: Annotated[
        int | None,
        typer.Option("--figure", metavar="7|13", help="The paper's figure with its numbers beside ours."),
    ] = None,
    band: Annotated[
        tuple[float, float] | None,
        typer.Option(
            "--band", metavar="HZ HZ", help="Follow only the modes of this frequency band (large models)."
        ),
    ] = None,
    settings: SetOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Root locus: how eigenvalues move over a quantity, which mode becomes unstable where, which modes
    couple.

    Modes keep their identity: they are followed by derivative (eq. 24) and by the correlation of their
    vectors, with finer steps where two come close. Modes are numbered by frequency at the start of the range.

    rigctl model locus configs/brakes/basic.toml --over mu:0.47:0.69:23 --out results

    rigctl model locus configs/brakes/model.toml --over pressure:0:25:26 --set slope=0.0576

    rigctl model locus configs/brakes/basic.toml --group contact_stiffness --over factor:0.7:1.3:61 --set
    mu=0.6
    """
    from rigctl.model.loading import read_model, study_errors
    from rigctl.model.locus import figure_7_study, figure_13_study, locus_study

    values = parse_settings(settings)
    name, points = parse_range(over, "--over")
    if group is not None and name != "factor":
        raise ConfigError(
            "a group is varied by a relative factor.",
            place="--over", value=over, remedy="Write --over factor:0.8:1.2:41 (1: as in the file).",
        )  # fmt: skip
    if len(points) < 2:
        raise ConfigError(
            "a locus needs at least two points.", place="--over", value=over, remedy="Raise COUNT."
        )
    studies = {7: figure_7_study, 13: figure_13_study}
    if figure is not None and figure not in studies:
        raise ConfigError("no such root locus.", place="--figure", value=figure, remedy="Known: 7, 13.")
    loaded = read_model(model)
    with study_errors(str(model)):
        if figure is not None:
            study = studies[figure](loaded)
        else:
            study = locus_study(loaded, group or name, points, values, asymmetric=asymmetric, band_hz=band)
    shown = ("paper", "crossings", "events", "modes", "coupling")
    finish(study, out, formats, tables=shown)

"""`rigctl model pairs` and `rigctl model reduce`: eigenvalue pairs of a brake file or of matrices made
elsewhere; large matrices made small.

NOT its job: the study (`rigctl.model.foreign`).
"""

from __future__ import annotations

from pathlib import Path
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
from rigctl.core.errors import ConfigError


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.command("pairs")(pairs)
    app.command("reduce")(reduce)


def pairs(
    model: ModelArgument,
    band: Annotated[
        str | None,
        typer.Option(
            "--band",
            metavar="FROM:TO",
            help="Frequencies in Hz, 1000:5000. Needed for models of more than 1500 degrees of freedom; "
            "seconds for several thousand. [default: all eigenvalues]",
        ),
    ] = None,
    damping_max: Annotated[
        float,
        typer.Option(
            "--damping-max",
            metavar="RATIO",
            help="With --band in a large model: damping ratio (at the band's upper end) up to which the "
            "search is complete.",
        ),
    ] = 0.1,
    settings: SetOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Eigenvalue pairs at one working point: frequency, damping ratio, real part; which ones grow (squeal).

    A pair grows where its real part is positive beyond the rounding error printed beside it. For matrices
    made elsewhere (M, D, K, K_mu, …) see the how-to on foreign models.

    rigctl model pairs configs/brakes/basic.toml --set mu=0.66

    rigctl model pairs disc.npz --band 1000:5000 --set mu=0.5 --out results
    """
    from rigctl.model.foreign import pairs_study
    from rigctl.model.loading import read_model, study_errors

    values, limits = parse_settings(settings), parse_band(band)
    loaded = read_model(model)
    with study_errors(str(model)):
        study = pairs_study(loaded, values, limits, damping_max=damping_max)
    finish(study, out, formats)


def reduce(
    model: ModelArgument,
    to: Annotated[Path, typer.Argument(help="File of the small model, ending with .npz.", metavar="SMALL")],
    band: Annotated[
        str, typer.Option("--band", metavar="FROM:TO", help="Frequencies in Hz that shall stay.")
    ],
    at: Annotated[
        list[str] | None,
        typer.Option(
            "--at",
            metavar="NAME=VALUE,…",
            help="Working point at which the small model is exact, mu=0.4 or mu=0.4,pressure=10. Repeatable: "
            "give the ends and the middle of the range that studies will use. [default: the file's]",
        ),
    ] = None,
) -> None:
    """Make a large model of matrices small, so that every `rigctl model` study takes it.

    The small model has the same friction, pressure and part factors, and the same eigenvalues in the band at
    the given working points; the error halfway between them is measured and printed. Eigenvalues outside the
    band mean nothing.

    rigctl model reduce disc.npz small.npz --band 1000:5000 --at mu=0 --at mu=0.5 --at mu=1

    rigctl model locus small.npz --over mu:0:1:51
    """
    from rigctl.model.foreign import reduction_study
    from rigctl.model.loading import read_model, study_errors
    from sim_hardware.brake_model.foreign.files import save_matrices
    from sim_hardware.brake_model.foreign.matrix_model import MatrixModel
    from sim_hardware.brake_model.foreign.reduction import reduce_model

    limits = parse_band(band)
    points = [parse_settings(text.split(",")) for text in at or []] or [{}]
    loaded = read_model(model)
    if limits is None or not isinstance(loaded, MatrixModel):
        raise ConfigError(
            "a brake file is small already.", place=str(model), remedy="Give matrices (.npz, .mat, folder)."
        )
    with study_errors(str(model)):
        reduction = reduce_model(loaded, limits, points, name=to.stem)
        small = reduction.model
        with study_errors(str(to)):
            save_matrices(to, {part.name: small.part(part.name) for part in small.parts}, small.numbers)
    finish(reduction_study(reduction), None, "")


def parse_band(text: str | None) -> tuple[float, float] | None:
    """FROM:TO in Hz as two numbers.

    Raises
    ------
    ConfigError
        not of that form
    """
    if text is None:
        return None
    low, _, high = text.partition(":")
    try:
        limits = float(low), float(high)
    except ValueError:
        limits = (0.0, -1.0)
    if not 0.0 <= limits[0] < limits[1] < float("inf"):
        raise ConfigError(
            "is not FROM:TO in Hz with 0 <= FROM < TO.",
            place=f"--band {text}", value=text, remedy="For example --band 1000:5000.",
        )  # fmt: skip
    return limits

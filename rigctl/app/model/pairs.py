"""`rigctl model pairs`: eigenvalue pairs of a brake file or of matrices made elsewhere.

NOT its job: the study (`rigctl.model.foreign`).
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
from rigctl.core.errors import ConfigError


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("pairs")(pairs)


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

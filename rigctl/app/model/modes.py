"""`rigctl model modes`: mode shapes, drawn as the brake deforms.

NOT its job: shapes and drawings (`rigctl.model.modes`).
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
    console,
    finish,
    parse_settings,
)
from rigctl.core.errors import ConfigError


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("modes")(modes)


def modes(
    model: ModelArgument,
    pair: Annotated[
        int | None, typer.Option("--pair", min=1, help="Number of the mode, from 1 by frequency.")
    ] = None,
    near: Annotated[
        float | None, typer.Option("--near", metavar="HZ", help="The mode nearest to this frequency.")
    ] = None,
    animation: Annotated[
        str | None,
        typer.Option(
            "--animate", metavar="gif,html,mp4", help="Animations to write into --out: gif, html, mp4."
        ),
    ] = None,
    band: Annotated[
        tuple[float, float] | None,
        typer.Option("--band", metavar="HZ HZ", help="Frequency band, for large models made elsewhere."),
    ] = None,
    settings: SetOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Mode shapes: who moves, which springs are strained, what feeds the vibration, and the brake as it
    deforms.

    Without --pair and --near the critical mode is shown: unstable, or least damped. The page (html) animates
    all modes and needs no network.

    rigctl model modes configs/brakes/basic.toml --set mu=0.64 --near 2400 --out results --animate gif,html
    """
    from rigctl.model.loading import read_model, study_errors
    from rigctl.model.modes import animate, check_animations, modes_study

    if pair is not None and near is not None:
        raise ConfigError(
            "--pair and --near name two modes.", place="--near", value=near, remedy="Give one of them."
        )
    if animation and out is None:
        raise ConfigError(
            "animations are files.", place="--animate", value=animation, remedy="Name a folder with --out."
        )
    values = parse_settings(settings)
    loaded = read_model(model)
    with study_errors(str(model)):
        kinds = [kind.strip() for kind in (animation or "").split(",") if kind.strip()]
        if kinds:
            check_animations(loaded, kinds)
        study = modes_study(loaded, pair, near, values, band_hz=band)
        finish(study, out, formats)
        if kinds and out is not None:
            for path in animate(loaded, out, kinds, pair, near, values, band_hz=band):
                console().print(f"animation: {path}")

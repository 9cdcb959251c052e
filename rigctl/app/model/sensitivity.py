"""`rigctl model sensitivity | robustness | influence | recommend | claims`: what design changes do to squeal.

NOT its job: the studies themselves (`rigctl.model.sensitivity`, `.advice`, `.claims`).
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

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
from rigctl.app.model.pairs import parse_band

if TYPE_CHECKING:
    from rigctl.model.output import Study
    from sim_hardware.brake_model.linear import LinearModel

StepOption = Annotated[
    float, typer.Option("--step", help="Change of each group's members, %.", min=0.001, max=99.0)
]
GroupOption = Annotated[
    list[str] | None,
    typer.Option(
        "--group", help="Group of parameters, or the beginning of several: piston. Repeatable. [all]"
    ),
]
BandOption = Annotated[
    str | None,
    typer.Option("--band", metavar="F1:F2", help="Only modes between these frequencies, Hz (large models)."),
]


def register(app: typer.Typer) -> None:
    """Add the commands."""
    for command in (sensitivity, robustness, influence, recommend, claims):
        app.command(command.__name__)(command)


def sensitivity(
    model: ModelArgument,
    pair: Annotated[
        int | None, typer.Option("--pair", help="Number of the eigenvalue pair, by frequency.")
    ] = None,
    near: Annotated[
        float | None, typer.Option("--near", help="The pair nearest to this frequency, Hz.")
    ] = None,
    places: Annotated[
        bool,
        typer.Option("--places", help="Each single element and coordinate too, not only file parameters."),
    ] = False,
    band: BandOption = None,
    settings: SetOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """What moves an eigenvalue: exact derivatives by every quantity (eq 24), ranked.

    Without --pair and --near it takes the pair nearest to instability. Choose the working point with --set,
    for example --set pressure=15 --set mu=0.4. Where two eigenvalues coincide or nearly do, their derivatives
    do not exist: the table of pairs says so and gives no number. "holds up to" is the change up to which the
    derivative tells the change; beyond it use `influence`, which solves the changed brake.
    """
    from rigctl.model.sensitivity import sensitivity_study

    values, limits = parse_settings(settings), parse_band(band)
    study = _run(
        model, lambda m: sensitivity_study(m, values, pair=pair, near_hz=near, places=places, band_hz=limits)
    )
    finish(study, out, formats, tables=("ranking", "pairs"))


def robustness(
    model: ModelArgument,
    low: Annotated[
        float, typer.Option("--from", help="Coefficient of friction to start from.", min=0.0)
    ] = 0.4,
    high: Annotated[float, typer.Option("--to", help="Coefficient of friction to go to.", min=0.0)] = 0.6,
    step: StepOption = 10.0,
    band: BandOption = None,
    settings: SetOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """How real parts react to more friction (eq 25): the design as it is, and each of its modifications (Figs
    8, 9).

    Positive values lose damping as friction grows. A maximum far from that of the basic design, above or
    below, says that the group matters; it does not alone say that the modification is bad: see `recommend`.
    """
    from rigctl.model.sensitivity import robustness_study

    values, limits = parse_settings(settings), parse_band(band)
    study = _run(
        model, lambda m: robustness_study(m, values, low=low, high=high, step=step / 100.0, band_hz=limits)
    )
    finish(study, out, formats, tables=("modifications",))


def influence(
    model: ModelArgument,
    group: GroupOption = None,
    mode: Annotated[
        list[str] | None,
        typer.Option("--mode", help="increase, decrease, clockwise, counter-clockwise. Repeatable. [all]"),
    ] = None,
    mu: Annotated[float, typer.Option("--mu", help="Coefficient of friction.", min=0.0)] = 0.4,
    step: StepOption = 10.0,
    band: BandOption = None,
    settings: SetOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """How modifications move every real part at constant friction, and what kind of effect that is (Fig. 10).

    Classes: narrow band, broad band, mode coupling (neighbours move in opposite directions), monodirectional
    (all in one direction). The thresholds stand in `sim_hardware.brake_model.design.effects.EffectRule`.
    """
    from rigctl.core.errors import ConfigError
    from rigctl.model.sensitivity import influence_study
    from sim_hardware.brake_model.design.variations import MODES, Mode

    values, limits = parse_settings(settings), parse_band(band)
    for name in mode or ():
        if name not in MODES:
            raise ConfigError(
                "no such mode of variation.", place="--mode", value=name, remedy=", ".join(MODES)
            )
    modes: tuple[Mode, ...] = tuple(m for m in MODES if not mode or m in mode)
    study = _run(
        model,
        lambda m: influence_study(
            m, group or (), values, modes=modes, mu=mu, step=step / 100.0, band_hz=limits
        ),
    )
    finish(study, out, formats, tables=("effects",))


def recommend(
    model: ModelArgument,
    group: GroupOption = None,
    friction: Annotated[
        str, typer.Option("--friction", help="Coefficients of friction at which a change has to help.")
    ] = "0.3,0.4,0.5,0.6",
    below: Annotated[
        float, typer.Option("--below", help="Upper end of the squeal range, Hz.", min=1.0)
    ] = 5000.0,
    pressure_max: Annotated[
        float, typer.Option("--pressure-max", help="Search the onset up to this pressure, bar.", min=0.1)
    ] = 60.0,
    step: StepOption = 10.0,
    band: BandOption = None,
    settings: SetOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Which design changes quieten the brake: ranked, with side effects and the change of the onset pressure.

    recommended: helps at every friction and harms no mode. with care: helps, at a price the table names.
    """
    from rigctl.core.errors import ConfigError
    from rigctl.model.advice import recommendation_study

    values, limits = parse_settings(settings), parse_band(band)
    try:
        mus = tuple(float(text) for text in friction.split(","))
    except ValueError:
        raise ConfigError(
            "is not a list of numbers.", place="--friction", value=friction, remedy="For example 0.3,0.5."
        ) from None
    study = _run(
        model,
        lambda m: recommendation_study(
            m,
            values,
            groups=group or (),
            mus=mus,
            step=step / 100.0,
            below_hz=below,
            pressure_max_bar=pressure_max,
            band_hz=limits,
        ),
    )
    finish(study, out, formats)


def claims(
    model: ModelArgument,
    scatter: Annotated[
        int,
        typer.Option(
            "--scatter", help="Test the claims on this many scattered brakes too.", min=0, max=10_000
        ),
    ] = 0,
    spread: Annotated[
        float, typer.Option("--spread", help="Scatter of every parameter, ± %, evenly.", min=0.0, max=50.0)
    ] = 10.0,
    seed: Annotated[int, typer.Option("--seed", help="Seed of the scatter.", min=0)] = 1,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Whether the paper's statements on robustness and influence (4.3.3, 4.3.4) hold for this brake.

    Each claim with what was measured, our numbers and an honest verdict. The groups of the file have to be
    named as in the shipped brakes (contact_…, piston_…, finger_…, abutment_…, …_damping, …_position): claims
    without their groups cannot be tested, and the table says so.
    """
    from rich.progress import Progress

    from rigctl.model.claims import claims_study

    with Progress(transient=True) as bar:
        task = bar.add_task("scattered brakes", total=scatter, visible=scatter > 0)

        def done(count: int) -> None:
            bar.update(task, completed=count)

        study = _run(
            model,
            lambda m: claims_study(m, samples=scatter, spread=spread / 100.0, seed=seed, progress=done),
        )
    finish(study, out, formats, lines=None)


def _run(path: Path, make: Callable[[LinearModel], Study]) -> Study:
    from rigctl.model.loading import read_model, study_errors

    model = read_model(path)
    with study_errors(str(path)):
        return make(model)

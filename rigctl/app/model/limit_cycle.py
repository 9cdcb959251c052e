"""`rigctl model squeal`: limit cycles, sound level and hysteresis over a quantity.

NOT its job: the study (`rigctl.model.limit_cycle`).
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
from rigctl.app.model.ranges import RANGE_METAVAR, parse_range
from rigctl.core.errors import ConfigError

_OPERATING = ("mu", "slope", "pressure")


def register(app: typer.Typer) -> None:
    """Add the command."""
    app.command("squeal")(squeal)


def squeal(
    model: ModelArgument,
    over: Annotated[
        str,
        typer.Option(
            "--over",
            metavar=RANGE_METAVAR,
            help="What is varied: pressure:0:30:61 (bar), mu:0.3:0.6:31, slope:0:0.1:41 (s/m), slip:0.1:1:31 "
            "(sliding speed, m/s), or a parameter of the brake file.",
        ),
    ] = "pressure:0:30:61",
    plant: Annotated[
        Path | None,
        typer.Option(
            "--plant",
            metavar="FILE",
            help="Plant file of the simulated rig, for example configs/plants/a_class.toml: its radiation "
            "gives the sound level, its friction law v_s, its roughness the excitation of ramps. Without: "
            "no sound.",
        ),
    ] = None,
    linear: Annotated[
        bool,
        typer.Option(
            "--linear",
            help="Friction falls linearly (eq. 28): only reversal of slip and lift-off bound the motion.",
        ),
    ] = False,
    saturation: Annotated[
        float | None,
        typer.Option(
            "--saturation",
            metavar="M/S",
            min=1e-6,
            help="Variation of slip v_s at which the falling slope fades. [default: the plant's, else 0.1]",
        ),
    ] = None,
    speed: Annotated[
        float, typer.Option("--speed", metavar="RPM", min=0.1, help="Speed of the disc, 1/min.")
    ] = 40.0,
    ramp: Annotated[
        bool, typer.Option("--ramp", help="Also ramp the quantity slowly up and down, at four speeds.")
    ] = False,
    longest: Annotated[
        float,
        typer.Option(
            "--longest", metavar="S", min=0.1, max=600.0, help="Simulated time for a motion to become steady."
        ),
    ] = 6.0,
    settings: SetOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Squeal beyond its onset: limit cycles, sound level, hysteresis.

    Every value is simulated from a small and from a large motion until
    the vibration is steady. Where both end alike there is no hysteresis;
    where only large motions squeal, squeal once begun lasts below its
    onset. Eigenvalues give the onset; growth rates of small random
    motions check it in time.

    rigctl model squeal configs/brakes/plant.toml --plant configs/plants/a_class.toml --ramp --out results

    rigctl model squeal configs/brakes/model.toml --over pressure:10:30:81 --linear

    rigctl model squeal configs/brakes/plant.toml --over slip:0.05:1:40 --set pressure=18
    """
    from rigctl.model.limit_cycle import read_radiation, squeal_study
    from rigctl.model.loading import read_brake, study_errors

    quantity, values = parse_range(over, "--over")
    chosen = parse_settings(settings)
    operating = {name: chosen.pop(name) for name in _OPERATING if name in chosen}
    if model.suffix != ".toml":
        raise ConfigError(
            "squeal in time needs a brake file with contacts.",
            place="MODEL", value=str(model), remedy="Name a .toml brake file.",
        )  # fmt: skip
    if ramp and quantity not in ("pressure", "mu", "slope", "slip"):
        raise ConfigError(
            "a parameter of the brake cannot be ramped while it runs.",
            place="--over", value=quantity, remedy="Leave out --ramp, or vary pressure, mu, slope or slip.",
        )  # fmt: skip
    if quantity in operating or quantity in chosen:
        raise ConfigError(
            "is varied and set at once.", place="--set", value=quantity, remedy="Leave out one of the two."
        )
    brake = read_brake(model)
    with study_errors(str(model)):
        if chosen:
            brake = brake.with_parameters(**chosen)
        study = squeal_study(
            brake,
            quantity,
            values,
            radiation=None if plant is None else read_radiation(plant),
            linear_law=linear,
            saturation_m_s=saturation,
            speed_rpm=speed,
            pressure_bar=operating.get("pressure", 20.0),
            mu=operating.get("mu"),
            slope_s_m=operating.get("slope"),
            ramp=ramp,
            longest_s=longest,
        )
    finish(study, out, formats, tables=("ramps",))

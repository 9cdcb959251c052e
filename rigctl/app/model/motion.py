"""`rigctl model simulate` and `rigctl model decay`: motion of a brake in time, with every nonlinearity.

NOT its job: the studies (`rigctl.model.motion`, `rigctl.model.energy`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from rigctl.app.model.common import DEFAULT_FORMATS, FormatOption, OutOption, finish
from rigctl.core.errors import ConfigError

BrakeArgument = Annotated[Path, typer.Argument(help="Brake file (.toml).", metavar="BRAKE")]
MuOption = Annotated[
    float | None, typer.Option("--mu", help="Coefficient of friction. [default: the brake file's]")
]


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.command("simulate")(simulate)
    app.command("decay")(decay)


def simulate(
    brake: BrakeArgument,
    pressure: Annotated[float, typer.Option("--pressure", metavar="BAR", help="Brake pressure.")] = 20.0,
    speed: Annotated[float, typer.Option("--speed", metavar="RPM", help="Speed of the disc, 1/min.")] = 40.0,
    duration: Annotated[float, typer.Option("--duration", metavar="S", help="Simulated time.")] = 0.2,
    law: Annotated[
        str,
        typer.Option(
            "--law",
            metavar="constant|linear|saturating",
            help="Friction over sliding speed: constant; falling line (eq. 28); a line that levels off.",
        ),
    ] = "saturating",
    mu: MuOption = None,
    slope: Annotated[
        float | None,
        typer.Option("--slope", metavar="S/M", help="Falling slope k. [default: the brake file's]"),
    ] = None,
    saturation: Annotated[
        float,
        typer.Option(
            "--saturation", metavar="M/S", help="Speed variation at which the saturating law levels off."
        ),
    ] = 0.1,
    start: Annotated[
        float, typer.Option("--start", metavar="M/S", help="Slip velocity of the small motion to start from.")
    ] = 1e-3,
    forces: Annotated[
        bool, typer.Option("--forces", help="Record the forces of all coupling elements too.")
    ] = False,
    rtol: Annotated[float, typer.Option("--rtol", help="Relative tolerance of a step.")] = 1e-8,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Motion of a brake at one working point, integrated with all events: pads stick, release and reverse,
    contacts lift off and land; cubic and one-sided couplings as the brake file has them.

    Starts from a small motion of the least stable shape. The first run compiles for about half a minute.

    rigctl model simulate configs/brakes/plant.toml --pressure 20 --speed 40 --out results

    rigctl model simulate configs/brakes/plant.toml --law linear --speed 2 --forces --format csv,parquet,png
    --out results
    """
    from rigctl.model.loading import read_brake, study_errors
    from rigctl.model.motion import LAWS, simulation_study

    if law not in LAWS:
        raise ConfigError(
            "no such friction law.", place=f"--law {law}", value=law, remedy=f"Known: {', '.join(LAWS)}."
        )
    loaded = read_brake(brake)
    with study_errors(str(brake)):
        study = simulation_study(
            loaded, pressure, speed, duration, law=law, mu=mu, slope_s_m=slope, saturation_m_s=saturation,
            start_m_s=start, forces=forces, rtol=rtol,
        )  # fmt: skip
    finish(study, out, formats, tables=("events", "peak_forces"))


def decay(
    brake: BrakeArgument,
    strengths: Annotated[
        str,
        typer.Option("--strengths", metavar="S,S,…", help="Factors on the realistic cubic stiffness."),
    ] = "1,10,100,1000",
    doubled_at: Annotated[
        float,
        typer.Option(
            "--doubled-at",
            metavar="µM",
            help="Compression at which the contact stiffness has doubled (factor 1).",
        ),
    ] = 50.0,
    energy: Annotated[float, typer.Option("--energy", metavar="NM", help="Energy at the start.")] = 1.0,
    mode: Annotated[int, typer.Option("--mode", help="Mode drawn over time; 3 is the paper's i = 5, 6.")] = 3,
    mu: MuOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Nonlinear pad stiffness (section 4.4, Fig. 11): does cubic hardening of the pads change the decay?

    From every mode shape, scaled to the same energy, the brake is integrated with linear and with cubic
    contacts, and the linear energy (eq. 26) compared.

    rigctl model decay configs/brakes/model.toml --out results

    rigctl model decay configs/brakes/basic.toml --strengths 1,30 --mode 7
    """
    from rigctl.model.energy import decay_study
    from rigctl.model.loading import read_brake, study_errors

    try:
        factors = tuple(float(text) for text in strengths.split(","))
    except ValueError as error:
        raise ConfigError(
            "is not a list of numbers.",
            place=f"--strengths {strengths}",
            value=strengths,
            remedy="For example 1,10,100.",
        ) from error  # fmt: skip
    loaded = read_brake(brake)
    with study_errors(str(brake)):
        study = decay_study(
            loaded, factors, doubled_at_m=1e-6 * doubled_at, mu=mu, energy_nm=energy, mode=mode
        )
    finish(study, out, formats, tables=("modes", "paper"))

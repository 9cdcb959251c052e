"""`rigctl model minimal …`: studies of the minimal models (Table 1, Fig. 1).

NOT its job: the studies (`rigctl.model.minimal`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rigctl.app.model.common import DEFAULT_FORMATS, FormatOption, OutOption, finish
from rigctl.core.errors import ConfigError

if TYPE_CHECKING:
    from sim_hardware.brake_model.minimal.laws import BeltLaw

PLACE = "rigctl model minimal"


class Law(StrEnum):
    """Friction laws of the phase plane."""

    coulomb = "coulomb"
    linear = "linear"
    exponential = "exponential"


def register(app: typer.Typer) -> None:
    """Add the commands."""
    minimal = typer.Typer(
        help="The minimal models of squeal: one mechanism each, small enough for closed formulas.\n\n"
        "belt: falling friction and stick-slip (1.1) · sprag: geometric instability (1.2) · two-dof: mode "
        "coupling by nonconservative restoring forces (1.3) · cases: systems of the literature as data.",
        no_args_is_help=True,
    )
    minimal.command("belt")(belt)
    minimal.command("sprag")(sprag)
    minimal.command("two-dof")(two_dof)
    minimal.command("cases")(cases)
    app.add_typer(minimal, name="minimal")


@contextmanager
def _checked(command: str) -> Iterator[None]:
    """Errors of the numerics and of validation as one line that names option, value and remedy."""
    from pydantic import ValidationError

    from rigctl.config.loading import describe
    from rigctl.model.loading import study_errors

    place = f"{PLACE} {command}"
    with study_errors(place):
        try:
            yield
        except ValidationError as error:
            raise ConfigError(describe(error, place)) from error


def _range(text: str, option: str) -> tuple[float, float]:
    """LOW:HIGH as two numbers."""
    try:
        low, high = map(float, text.split(":"))
    except ValueError:
        low = high = math.nan
    if not low < high:
        raise ConfigError(
            "is not LOW:HIGH with two rising numbers.", place=option, value=text, remedy="For example 0.01:1."
        )
    return low, high


def belt(
    law: Annotated[Law, typer.Option("--law", help="Friction law of the phase plane.")] = Law.linear,
    mass: Annotated[float, typer.Option("--mass", help="m, kg.")] = 1.0,
    stiffness: Annotated[float, typer.Option("--stiffness", help="c, N/m.")] = 1.8e8,
    damping: Annotated[float, typer.Option("--damping", help="d, N s/m.")] = 0.0,
    normal_force: Annotated[
        float, typer.Option("--normal-force", help="F_n, N; 3435 N are 15 bar.")
    ] = 3435.0,
    belt_speed: Annotated[float, typer.Option("--belt-speed", help="v_belt of the phase plane, m/s.")] = 0.15,
    mu_static: Annotated[float, typer.Option("--mu-static", help="mu at rest, mu_0 of eq 28.")] = 0.5,
    mu_dynamic: Annotated[float, typer.Option("--mu-dynamic", help="mu while sliding (not linear).")] = 0.4,
    slope: Annotated[
        float, typer.Option("--slope", help="k of eq 28, s/m (linear). Measured: 0.0576.")
    ] = 0.6,
    speed_scale: Annotated[
        float, typer.Option("--speed-scale", help="v0 of the exponential law, m/s.")
    ] = 0.1,
    viscous: Annotated[float, typer.Option("--viscous", help="mu_v of the exponential law, s/m.")] = 0.0,
    speeds: Annotated[
        str, typer.Option("--speeds", metavar="LOW:HIGH", help="Belt speeds of the comparison, m/s.")
    ] = "0.01:1",
    points: Annotated[int, typer.Option("--points", help="Number of belt speeds.")] = 41,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Mass on a moving belt: phase plane with stick-slip limit cycle and stability regions (Fig. 1a), and the
    frequency of the limit cycle over the belt speed for three friction laws.

    The equilibrium is unstable where friction falls more steeply than damping holds: dmu/dv < -d/F_n. The
    default slope is ten times the measured one, so that growth is seen by eye.

    rigctl model minimal belt --out results

    rigctl model minimal belt --slope 0.0576 --belt-speed 0.44 --damping 100
    """
    with _checked("belt"):
        from rigctl.model.minimal import belt_study
        from sim_hardware.brake_model.minimal.belt import BeltOscillator
        from sim_hardware.brake_model.minimal.laws import CoulombLaw, ExponentialLaw, LinearFallingLaw

        laws: dict[Law, BeltLaw] = {
            Law.coulomb: CoulombLaw(mu_static=mu_static, mu_dynamic=mu_dynamic),
            Law.linear: LinearFallingLaw(mu_static=mu_static, slope_s_m=slope),
            Law.exponential: ExponentialLaw(
                mu_static=mu_static, mu_dynamic=mu_dynamic, speed_scale_m_s=speed_scale, viscous_s_m=viscous
            ),
        }
        oscillator = BeltOscillator(
            mass_kg=mass,
            stiffness_n_m=stiffness,
            damping_ns_m=damping,
            normal_force_n=normal_force,
            belt_speed_m_s=belt_speed,
            law=laws[law],
        )
        study = belt_study(
            oscillator, laws=tuple(laws.values()), speeds_m_s=_range(speeds, "--speeds"), points=points
        )
    finish(study, out, formats, tables=("cycles", "regions", "paper"))


def sprag(
    angle: Annotated[float, typer.Option("--angle", help="Angle gamma of the strut, degrees.")] = 15.0,
    disc_damping: Annotated[
        float, typer.Option("--disc-damping", help="d1, normal to the disc, N s/m.")
    ] = 1000.0,
    pad_damping: Annotated[float, typer.Option("--pad-damping", help="d2, along the strut, N s/m.")] = 20.0,
    mass: Annotated[float, typer.Option("--mass", help="m, kg.")] = 1.0,
    pad_stiffness: Annotated[
        float, typer.Option("--pad-stiffness", help="c2, along the strut, N/m.")
    ] = 1.8e8,
    disc_stiffness: Annotated[
        float, typer.Option("--disc-stiffness", help="c1, normal to the disc, N/m.")
    ] = 0.0,
    mu_max: Annotated[float, typer.Option("--mu-max", help="Largest mu drawn.")] = 1.5,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Spurr's sprag-slip in Crisp's linear form: critical mu over the angle, and the dampers it needs.

    Unstable for mu > tan(gamma) + 2 d2 / (sin(2 gamma) d1), gamma > 0. For gamma < 0 the relation turns
    round: only a disc that turns back (mu < 0) is unstable.

    rigctl model minimal sprag --angle 10 --disc-damping 500 --out results
    """
    with _checked("sprag"):
        from rigctl.model.minimal import sprag_study
        from sim_hardware.brake_model.minimal.sprag import SpragModel

        if not abs(angle) < 90.0:
            raise ConfigError(
                "is not between -90° and 90°.", place=f"--angle {angle:g}", remedy="For example 15."
            )
        model = SpragModel(
            mass_kg=mass,
            angle_rad=math.radians(angle),
            disc_damping_ns_m=disc_damping,
            pad_damping_ns_m=pad_damping,
            pad_stiffness_n_m=pad_stiffness,
            disc_stiffness_n_m=disc_stiffness,
        )
        study = sprag_study(model, mu_max=mu_max)
    finish(study, out, formats, tables=("needed",))


def two_dof(
    mass: Annotated[float, typer.Option("--mass", help="m, kg.")] = 0.4,
    inertia: Annotated[float, typer.Option("--inertia", help="J, kg m².")] = 4.7e-4,
    d1: Annotated[float, typer.Option("--d1", help="Damper of x, N s/m.")] = 60.0,
    d2: Annotated[float, typer.Option("--d2", help="Damper of phi, N m s.")] = 0.07,
    c1: Annotated[float, typer.Option("--c1", help="Spring of x, N/m.")] = 3.4e7,
    c2: Annotated[float, typer.Option("--c2", help="Spring of phi, N m.")] = 1.12e5,
    c3: Annotated[float, typer.Option("--c3", help="Contact spring, N/m.")] = 5e7,
    s: Annotated[float, typer.Option("--s", help="Contact beside the centre of mass, m.")] = 0.005,
    h: Annotated[float, typer.Option("--h", help="Friction surface from the centre of mass, m.")] = 0.0165,
    mu_max: Annotated[float, typer.Option("--mu-max", help="Range of mu, from 0.")] = 0.8,
    points: Annotated[int, typer.Option("--points", help="Values of mu.")] = 801,
    case: Annotated[
        Path | None,
        typer.Option("--case", help="A 2-DOF system as data (TOML) instead of the numbers above."),
    ] = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """The 2-DOF model of eq 1: root locus over mu (Fig. 1b), and Hurwitz's five expressions as boundaries
    of mu, each named: divergence, flutter (mode coupling), or never the first to fail.

    rigctl model minimal two-dof --out results

    rigctl model minimal two-dof --d2 0.14: more damping on one side lowers the boundary
    """
    with _checked("two-dof"):
        from rigctl.model.minimal import two_dof_study
        from sim_hardware.brake_model.minimal.cases import TwoDofCase
        from sim_hardware.brake_model.minimal.two_dof import TwoDofModel

        model: TwoDofModel | TwoDofCase
        if case is not None:
            chosen = _read_case(case)
            if not isinstance(chosen, TwoDofCase):
                raise ConfigError(
                    "is not a 2-DOF system.",
                    place=str(case),
                    value=chosen.kind,
                    remedy='Give kind = "two-dof".',
                )
            model = chosen
        else:
            model = TwoDofModel(mass=mass, inertia=inertia, d1=d1, d2=d2, c1=c1, c2=c2, c3=c3, s=s, h=h)
        study = two_dof_study(model, mu_max=mu_max, points=points)
    finish(study, out, formats, tables=("boundaries",))


def cases(
    files: Annotated[
        list[Path] | None, typer.Argument(help="Systems as data (TOML). [default: those of the package]")
    ] = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Systems of the literature, fed in as data: published or derived numbers beside what our models give."""
    with _checked("cases"):
        from rigctl.model.minimal import cases_study
        from sim_hardware.brake_model.minimal.cases import shipped_cases

        study = cases_study([_read_case(path) for path in files] if files else shipped_cases())
    finish(study, out, formats, tables=("numbers",))
    if study.facts["passed"] < study.facts["numbers"]:
        raise typer.Exit(1)


def _read_case(path: Path):
    from rigctl.config.loading import translated
    from sim_hardware.brake_model.minimal.cases import load_case

    with translated(path):
        return load_case(path)
    raise AssertionError  # `translated` has raised

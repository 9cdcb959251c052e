"""Command line of rigctl.

Job: options, help that teaches, exit codes, errors without tracebacks. Not its job: the commands' work.
"""

from __future__ import annotations

import os
import sys
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from rigctl import __version__
from rigctl.app import exit_codes
from rigctl.core.errors import RigctlError

# Before numpy loads: matrices of brakes are small, threads of the linear algebra only wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

DEFAULT_RIG = Path("configs/rigs/simulated.toml")

app = typer.Typer(
    name="rigctl",
    help="Runs a brake-noise test rig, real or simulated.\n\n"
    "Start with:  rigctl run configs/programs/quick_check.toml",
    epilog="Exit codes: 0 done, 1 failed, 2 wrong file or option, 3 stopped by a person, "
    "4 safety trip, 5 some brakings are incomplete.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    rich_markup_mode="markdown",
)


class Time(StrEnum):
    """How time runs on a simulated rig."""

    VIRTUAL = "virtual"
    REAL = "real"


RigOption = Annotated[Path, typer.Option("--rig", help="Rig file.", show_default=True)]
OutOption = Annotated[Path, typer.Option("--out", help="Folder for campaigns.")]
NameOption = Annotated[
    str | None, typer.Option("--name", help="Name of the campaign. [default: what and when]")
]
SeedOption = Annotated[
    int | None,
    typer.Option("--seed", min=0, max=2**31 - 1, help="Seed of the simulated rig. [default: random]"),
]
ReportOption = Annotated[bool, typer.Option(help="Build the report at the end.")]


@app.command()
def run(
    program: Annotated[Path, typer.Argument(help="Program file, e.g. configs/programs/squeal_matrix.toml.")],
    rig: RigOption = DEFAULT_RIG,
    out: OutOption = Path("data"),
    name: NameOption = None,
    seed: SeedOption = None,
    time: Annotated[
        Time | None,
        typer.Option(
            "--time",
            help="virtual: as fast as possible; real: by the clock. [default: virtual on a simulated rig]",
        ),
    ] = None,
    report: ReportOption = True,
) -> None:
    """Run a program: condition, brake, record, find squeal, report.

    Every set-point is checked before anything moves. A watchdog process guards the rig. Ctrl-C stops safely;
    `rigctl resume CAMPAIGN` goes on later.
    """
    from rigctl.app.running import RunOptions
    from rigctl.app.running import run as run_program

    raise typer.Exit(
        run_program(
            RunOptions(program, rig, out, name, seed, time.value if time else None, report), _console()
        )
    )


@app.command()
def manual(
    rig: RigOption = DEFAULT_RIG,
    out: OutOption = Path("data"),
    name: NameOption = None,
    seed: SeedOption = None,
    time: Annotated[
        Time | None,
        typer.Option("--time", help="real: by the clock; virtual: as fast as possible. [default: real]"),
    ] = None,
    report: ReportOption = True,
) -> None:
    """Hold a rig for manual brakings: `rigctl gui` and `rigctl control` command it. Ctrl-C ends safely.

    Nothing moves before somebody enables it.
    """
    from rigctl.app.running import RunOptions
    from rigctl.app.running import run as run_session

    options = RunOptions(None, rig, out, name, seed, time.value if time else None, report)
    raise typer.Exit(run_session(options, _console()))


@app.command()
def resume(
    campaign: Annotated[Path, typer.Argument(help="Campaign folder of a run that did not come to its end.")],
    acknowledge: Annotated[
        str,
        typer.Option(
            "--acknowledge",
            metavar="REASON",
            help="After a safety trip: what was found and done, in your words.",
        ),
    ] = "",
    report: ReportOption = True,
) -> None:
    """Recover what a broken run has left and go on with the first braking that is not complete."""
    from rigctl.app.running import resume as resume_campaign

    raise typer.Exit(resume_campaign(campaign, acknowledge, report, _console()))


@app.command()
def check(
    program: Annotated[Path, typer.Argument(help="Program file.")],
    rig: RigOption = DEFAULT_RIG,
) -> None:
    """Dry run: every set-point against the rig's limits, number of brakings, estimated duration."""
    from rigctl.app.checking import show_check

    raise typer.Exit(show_check(program, rig, _console()))


@app.command("report")
def build_report(
    campaign: Annotated[Path, typer.Argument(help="Campaign folder.")],
) -> None:
    """Build the report of a campaign again."""
    from rigctl.app.reporting import make_report

    make_report(campaign, _console())


@app.command()
def stability(
    brake: Annotated[Path, typer.Argument(help="Brake file, e.g. configs/brakes/model.toml.")],
    k: Annotated[
        float | None,
        typer.Option("--k", min=0, max=10, help="Falling slope of the friction, s/m. [default: brake file]"),
    ] = None,
    mu: Annotated[
        float | None,
        typer.Option("--mu", min=0, max=5, help="Coefficient of friction. [default: brake file]"),
    ] = None,
    max_bar: Annotated[
        float, typer.Option("--max-bar", min=0.1, max=200, help="Highest pressure, bar.")
    ] = 25.0,
) -> None:
    """Eigenvalues of a brake, and the pressure and frequency at which it begins to squeal."""
    from rigctl.app.stability import show_stability

    raise typer.Exit(show_stability(brake, k, mu, max_bar, _console()))


def _add_families() -> None:
    from rigctl.app import annotating, bench, calibrations, comparing, control, devices, laboratory
    from rigctl.app.model import model_app

    app.add_typer(model_app(), name="model")
    devices.register(app)
    bench.register(app)
    annotating.register(app)
    calibrations.register(app)
    comparing.register(app)
    control.register(app)
    laboratory.register(app)


_add_families()


def _version(wanted: bool) -> None:
    if wanted:
        print(f"rigctl {__version__}")
        raise typer.Exit


@app.callback()
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Root of the commands."""


def _console() -> Console:
    return Console(soft_wrap=True)


def main() -> None:
    """Entry point: turns errors into one clear message and an exit code."""
    try:
        app()
    except RigctlError as error:
        print(f"rigctl: {error}", file=sys.stderr)
        sys.exit(exit_codes.of(error))
    except KeyboardInterrupt:
        print("rigctl: interrupted; no rig is being driven.", file=sys.stderr)
        sys.exit(exit_codes.STOPPED)


if __name__ == "__main__":
    main()

"""`rigctl model scatter`, `optimise`, `identify`: long studies with progress, workers, and going on after
Ctrl-C.

Job: options, progress, what a person sees when it is stopped. NOT its job: the studies
(`rigctl.model.scatter`, `.optimise`, `.identification`), running them (`rigctl.model.runner`).
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
from rich.progress import Progress as Bar

from rigctl.app import exit_codes
from rigctl.app.durations import duration_text
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
from rigctl.app.model.ranges import RANGE_METAVAR, parse_range
from rigctl.core.errors import ConfigError

if TYPE_CHECKING:
    from rigctl.model.identification import Recorded
    from rigctl.model.runner import Progress, RunOptions

_LINE_EVERY_S = 5.0

WorkersOption = Annotated[
    int, typer.Option("--workers", metavar="N", min=1, help="Processes on this machine that compute.")
]
SchedulerOption = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        metavar="ADDRESS",
        help="Dask scheduler instead of --workers, e.g. tcp://host:8786 (needs the package distributed). "
        "Results are the same bit for bit.",
    ),
]
FolderOption = Annotated[
    Path | None,
    typer.Option(
        "--folder",
        help="Folder that keeps what is finished; a stopped study goes on there. "
        "[default: in the user's cache until the study is done]",
    ),
]
SeedOption = Annotated[int, typer.Option("--seed", min=0, max=2**31 - 1, help="Seed of all random numbers.")]


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.command("scatter")(scatter)
    app.command("optimise")(optimise)
    app.command("identify")(identify)


def scatter(
    model: ModelArgument,
    over: Annotated[
        str, typer.Option("--over", metavar=RANGE_METAVAR, help="Quantity that is raised until it squeals.")
    ] = "pressure:0:30:61",
    spread: Annotated[
        float, typer.Option("--spread", help="Scatter of every variable as a share: 0.05 is 5 %.")
    ] = 0.05,
    law: Annotated[
        str,
        typer.Option(
            "--law",
            help="uniform: within ± spread; lognormal: spread is the standard deviation of ln(value).",
        ),
    ] = "uniform",
    samples: Annotated[int, typer.Option("--samples", min=1, help="Number of random brakes.")] = 1000,
    free: Annotated[
        list[str] | None,
        typer.Option(
            "--free", metavar="NAME", help="Scatter only this quantity. Repeatable. [default: all parameters]"
        ),
    ] = None,
    groups: Annotated[
        list[str] | None,
        typer.Option("--groups", metavar="NAME", help="Scatter this group, its members alike. Repeatable."),
    ] = None,
    seed: SeedOption = 1,
    settings: SetOption = None,
    workers: WorkersOption = 1,
    scheduler: SchedulerOption = None,
    folder: FolderOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """How probable squeal is when all parameters scatter, and which of them decide.

    Every sample is a brake whose parameters are multiplied by independent random factors. For each one: where
    it first becomes unstable and with which frequency. Result: squeal probability over pressure (or mu) with
    its 95 % confidence interval, the spread of onset and frequency, and rank correlations that name the
    drivers.

    Example:  rigctl model scatter configs/brakes/model.toml --spread 0.05 --workers 4 --out results
    """
    from rigctl.model.scatter import scatter_study

    name, values_over = parse_range(over, "--over")
    with _running(f"scatter {model.name}", workers, scheduler, folder) as options:
        study = scatter_study(
            model,
            name,
            values_over,
            spread=spread,
            law=_law(law),
            samples=samples,
            seed=seed,
            names=free or None,
            groups=groups or (),
            values=parse_settings(settings),
            options=options,
        )
        finish(study, out, formats, tables=("probability", "drivers"))


def optimise(
    model: ModelArgument,
    free: Annotated[
        list[str] | None,
        typer.Option(
            "--free",
            metavar="NAME:LOW:HIGH",
            help="Quantity that may change, with bounds in its unit. Repeatable.",
        ),
    ] = None,
    groups: Annotated[
        list[str] | None,
        typer.Option(
            "--groups",
            metavar="NAME[:LOW:HIGH]",
            help="Group whose members change alike, bounds as factors (0.8:1.25 where left out). Repeatable.",
        ),
    ] = None,
    over: Annotated[
        list[str] | None,
        typer.Option(
            "--over",
            metavar=RANGE_METAVAR,
            help="Operating range; every combination counts. Repeatable. "
            "[default: pressure:0:30:7 and mu:0.3:0.5:3]",
        ),
    ] = None,
    starts: Annotated[
        int,
        typer.Option(
            "--starts", min=1, help="Starting points: the file's values, others spread over the bounds."
        ),
    ] = 8,
    seed: SeedOption = 1,
    settings: SetOption = None,
    workers: WorkersOption = 1,
    scheduler: SchedulerOption = None,
    folder: FolderOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Change quantities or groups within bounds for the largest stability margin.

    The margin is the smallest damping ratio of all eigenvalues over the whole operating range: positive means
    that the brake is stable everywhere in it. Exact gradients (eq. 24); several starts look for other
    optima; the result is checked by solving again on a finer grid.

    Example:  rigctl model optimise configs/brakes/model.toml --free x_pis:0.014:0.022 --groups
    piston_damping:0.5:2
    """
    from rigctl.model.optimise import optimise_study

    ranges: dict[str, list[float]] = {}
    for text in over or ("pressure:0:30:7", "mu:0.3:0.5:3"):
        name, grid = parse_range(text, "--over")
        if name in ranges:
            raise ConfigError(
                "names a quantity twice.", place="--over", value=text, remedy="Give one range of it."
            )
        ranges[name] = sorted(grid.tolist())
    with _running(f"optimise {model.name}", workers, scheduler, folder) as options:
        study = optimise_study(
            model,
            free=free or (),
            groups=groups or (),
            ranges=ranges,
            start_count=starts,
            seed=seed,
            values=parse_settings(settings),
            options=options,
        )
        finish(study, out, formats, tables=("variables", "onsets", "starts"))


def identify(
    model: ModelArgument,
    campaign: Annotated[
        Path | None, typer.Option("--campaign", help="Campaign folder whose squeal is to be explained.")
    ] = None,
    onset_bar: Annotated[
        float | None, typer.Option("--onset-bar", help="Instead: pressure at which it begins to squeal, bar.")
    ] = None,
    onset_mu: Annotated[
        float | None, typer.Option("--onset-mu", help="Instead: coefficient of friction at which it begins.")
    ] = None,
    frequency_hz: Annotated[
        float | None, typer.Option("--frequency-hz", help="Squeal frequency at onset, Hz.")
    ] = None,
    onset_sigma: Annotated[
        float | None,
        typer.Option("--onset-sigma", help="Standard uncertainty of the onset. [default: 5 % of it]"),
    ] = None,
    frequency_sigma_hz: Annotated[
        float | None,
        typer.Option("--frequency-sigma-hz", help="Of the frequency, Hz. [default: 0.5 % of it]"),
    ] = None,
    free: Annotated[
        list[str] | None,
        typer.Option(
            "--free",
            metavar="NAME[:SPREAD]",
            help="Quantity to identify, with its prior spread (0.1: 10 %). Repeatable. "
            "[default: all parameters]",
        ),
    ] = None,
    groups: Annotated[
        list[str] | None,
        typer.Option(
            "--groups", metavar="NAME[:SPREAD]", help="Group to identify, members alike. Repeatable."
        ),
    ] = None,
    spread: Annotated[
        float, typer.Option("--spread", help="Prior spread where none is given: what is believed before.")
    ] = 0.05,
    samples: Annotated[
        int,
        typer.Option("--samples", min=0, help="Samples of the posterior; 0: linearised uncertainty only."),
    ] = 400,
    write: Annotated[
        Path | None,
        typer.Option("--write", help="New brake file with the identified values; never overwrites."),
    ] = None,
    seed: SeedOption = 1,
    settings: SetOption = None,
    workers: WorkersOption = 1,
    scheduler: SchedulerOption = None,
    folder: FolderOption = None,
    out: OutOption = None,
    formats: FormatOption = DEFAULT_FORMATS,
) -> None:
    """Parameters that explain recorded squeal: onset and frequency of a campaign, or numbers by hand.

    Two numbers cannot fix many parameters. What is believed before (--spread around the file's values) and
    what was measured are weighed by their uncertainties; the result says which combinations the data fix at
    all, and how uncertain each parameter stays.

    Example:  rigctl model identify configs/brakes/model.toml --onset-bar 12 --frequency-hz 2350 \
--free c_abu_t:0.2 --free m_padi --write fitted.toml
    """
    from rigctl.model.identification import identify_study, write_brake

    values = parse_settings(settings)
    recorded = _recorded(campaign, onset_bar, onset_mu, frequency_hz, onset_sigma, frequency_sigma_hz)
    if write is not None and write.exists():
        raise ConfigError(
            "is there already and is not overwritten.", place=f"--write {write}", remedy="Name a new file."
        )
    with _running(f"identify {model.name}", workers, scheduler, folder) as options:
        study, result = identify_study(
            model,
            recorded,
            free=free or None,
            groups=groups or (),
            spread=spread,
            samples=samples,
            seed=seed,
            values=values,
            options=options,
        )
        finish(study, out, formats)
        if write is not None:
            write_brake(model, write, result, values)
            console().print(f"Brake file: {write}")


def _law(text: str) -> Literal["uniform", "lognormal"]:
    if text == "uniform":
        return "uniform"
    if text == "lognormal":
        return "lognormal"
    raise ConfigError("no such law.", place="--law", value=text, remedy="Known: uniform, lognormal.")


def _recorded(
    campaign: Path | None,
    onset_bar: float | None,
    onset_mu: float | None,
    frequency_hz: float | None,
    onset_sigma: float | None,
    frequency_sigma_hz: float | None,
) -> Recorded:
    from rigctl.model.identification import by_hand, measured_in

    if sum(given is not None for given in (campaign, onset_bar, onset_mu)) != 1:
        raise ConfigError(
            "give exactly one of them.",
            place="--campaign, --onset-bar, --onset-mu",
            remedy="For example --campaign data/night_1, or --onset-bar 12 --frequency-hz 2350.",
        )
    if campaign is not None:
        if any(given is not None for given in (frequency_hz, onset_sigma, frequency_sigma_hz)):
            raise ConfigError(
                "the campaign says onset, frequency and their uncertainty itself.",
                place="--frequency-hz, --onset-sigma, --frequency-sigma-hz",
                remedy="Leave them out, or give all numbers by hand with --onset-bar.",
            )
        return measured_in(campaign)
    if onset_bar is not None:
        return by_hand(onset_bar, frequency_hz, onset_sigma, frequency_sigma_hz, "pressure")
    assert onset_mu is not None
    return by_hand(onset_mu, frequency_hz, onset_sigma, frequency_sigma_hz, "mu")


@contextmanager
def _running(what: str, workers: int, scheduler: str | None, folder: Path | None) -> Iterator[RunOptions]:
    """Options that show progress; Ctrl-C prints what is kept and ends with exit code 3."""
    from rigctl.model.runner import RunOptions, StudyStopped

    with _ProgressView(what) as view:
        options = RunOptions(
            folder=folder, workers=workers, scheduler=scheduler, on_progress=view.show, cached=True
        )
        try:
            yield options
        except StudyStopped as stopped:
            view.stop()
            console().print(str(stopped))
            raise typer.Exit(exit_codes.STOPPED) from None
        options.forget()


class _ProgressView:
    """A live line on a terminal, a plain line every few seconds elsewhere; on standard error: results
    stay clean.
    """

    def __init__(self, what: str) -> None:
        from rich.console import Console

        self._what = what
        self._screen = Console(stderr=True, soft_wrap=True)
        self._line_at = time.monotonic() + _LINE_EVERY_S
        self._bar = Bar(
            TextColumn(what),
            BarColumn(bar_width=24),
            MofNCompleteColumn(),
            TextColumn("{task.fields[text]}"),
            console=self._screen,
            transient=True,
            disable=not self._screen.is_terminal,
        )
        self._task = self._bar.add_task("", total=None, text="")

    def __enter__(self) -> _ProgressView:
        self._bar.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def stop(self) -> None:
        """End the live line."""
        self._bar.stop()

    def show(self, progress: Progress) -> None:
        """Show the newest progress."""
        left = "" if progress.left_s is None else f"{duration_text(progress.left_s)} left"
        kept = f", {progress.restored} from before" if progress.restored else ""
        if self._screen.is_terminal:
            self._bar.update(self._task, completed=progress.done, total=progress.total, text=left + kept)
            if progress.done == progress.total:
                self.stop()
        elif time.monotonic() >= self._line_at:
            self._line_at = time.monotonic() + _LINE_EVERY_S
            self._screen.print(
                f"{self._what}  {progress.done}/{progress.total}{kept}  {left}", highlight=False
            )

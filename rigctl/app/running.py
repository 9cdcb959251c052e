"""`rigctl run`, `rigctl manual` and `rigctl resume`: check, freeze, supervise, report, tell.

Job: the course of one campaign from files to exit code. Not its job: option parsing (`rigctl.app.cli`),
processes (`rigctl.app.supervisor`).
"""

from __future__ import annotations

import re
import secrets
import shutil
import threading
import time
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from rich.console import Console

from rigctl.app import campaign_file, exit_codes
from rigctl.app.calibrations import for_run
from rigctl.app.campaign_file import CampaignFile
from rigctl.app.compose import (
    build_rig,
    dry_run,
    prediction_of,
    problems_text,
    read_program,
    read_rig,
    resolved_paths,
)
from rigctl.app.durations import duration_text
from rigctl.app.progress_view import ProgressView
from rigctl.app.reporting import make_report
from rigctl.app.supervisor import Supervisor
from rigctl.config.rig import RigConfig
from rigctl.core.errors import ConfigError, SafetyTrip
from rigctl.core.journal import read_journal
from rigctl.engine.state import Outcome, RunResult
from rigctl.hal.devices import RigContext
from rigctl.recording.campaign import Campaign, create_campaign, open_campaign, require_free_space
from rigctl.recording.recovery import recover
from rigctl.safety.limits import load_limits
from sequences.program import Program

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,99}")
DISK_RESERVE_BYTES = 500e6
PROCESS_CAUSES = frozenset(
    {"controller_gone", "controller_deaf", "heartbeat_late", "samples_late", "rig_gone", "terminated"}
)


@dataclass(frozen=True)
class RunOptions:
    """What a person has chosen. `program`: None for a manual session; `time`: None for what suits the rig."""

    program: Path | None
    rig: Path
    out: Path
    name: str | None
    seed: int | None
    time: str | None
    report: bool = True


def run(options: RunOptions, console: Console) -> int:
    """Run a program from its start, or a manual session, in a new campaign; returns the exit code.

    Raises
    ------
    ConfigError
        Something is wrong with a file or option; nothing was started.
    """
    program = None if options.program is None else read_program(options.program)
    rig = read_rig(options.rig)
    time_mode = _time_of(rig, options)
    resolved_paths(rig, options.rig)
    limits = load_limits((options.rig.resolve().parent / rig.safety.limits).resolve())
    if rig.prediction is not None:
        prediction_of((options.rig.resolve().parent / rig.prediction.brake).resolve())
    context = RigContext(Path(), time_mode, options.seed, str(options.rig), options.rig.resolve().parent)
    build_rig(rig, context)
    needed_bytes, news = DISK_RESERVE_BYTES, f"Manual session on {rig.name}"
    if program is not None:
        result = dry_run(program, rig)
        if not result.ok:
            raise ConfigError(problems_text(result, str(options.program)))
        needed_bytes += 2 * result.data_bytes
        news = (
            f"{program.count} brakings ({_parts(program)}) on {rig.name}, "
            f"about {duration_text(result.estimated_duration_s)} of rig time"
        )
    title = "manual" if program is None else program.name.replace(" ", "_")
    name = f"{title}-{datetime.now():%Y%m%d-%H%M%S}" if options.name is None else options.name
    if not _NAME.fullmatch(name):
        raise ConfigError(
            f"{name!r} cannot be the name of a campaign.",
            place="--name",
            value=name,
            remedy="Use up to 100 letters, digits, '.', '_' and '-', beginning with a letter or digit.",
        )
    require_free_space(options.out, needed_bytes)
    file, copies = campaign_file.freeze(
        name,
        program=program,
        program_path=options.program,
        rig=rig,
        rig_path=options.rig,
        time=time_mode,
        seed=secrets.randbelow(2**31) if options.seed is None else options.seed,
        limits_hash8=limits.hash8,
        calibrations=for_run(rig, options.rig, options.out),
    )
    campaign = create_campaign(options.out / name, file.model_dump(mode="json", exclude_none=True))
    with campaign.lock("run"):
        for target, source in copies.items():
            (campaign.folder / target).parent.mkdir(exist_ok=True)
            shutil.copyfile(source, campaign.folder / target)
        console.print(f"{news}; seed {file.seed}", highlight=False)
        console.print(f"Campaign {campaign.folder}", highlight=False)
        return _carry_out(
            campaign, file, attempt=0, done=[], acknowledgement="", report=options.report, console=console
        )


def _time_of(rig: RigConfig, options: RunOptions) -> str:
    """How time runs: by the clock on a real rig and by hand, else as fast as possible by default."""
    if rig.simulated:
        return options.time or ("real" if options.program is None else "virtual")
    if options.time == "virtual":
        raise ConfigError(
            "a rig of real devices runs by the clock.",
            place="--time virtual",
            value=options.time,
            remedy="Leave --time away, or use --rig configs/rigs/simulated.toml.",
        )
    return "real"


def resume(folder: Path, acknowledgement: str, report: bool, console: Console) -> int:
    """Recover what a broken run has left, then go on with the first braking that is not complete.

    Raises
    ------
    ConfigError
        The folder is no campaign.
    SafetyTrip
        The run ended with a trip that wants a person's word first.
    """
    file = CampaignFile.load(folder)
    campaign = open_campaign(folder)
    with campaign.lock("run"):
        _recover(campaign, console)
        done = campaign.completed_indices()
        if file.program is not None:
            left = file.count - len(done)
            if left == 0:
                console.print(f"All {file.count} brakings are complete already.", highlight=False)
                if report:
                    make_report(folder, console)
                return exit_codes.OK
            console.print(f"{len(done)} brakings are complete, {left} are left.", highlight=False)
        attempt = sum(1 for record in read_journal(campaign.journal_path) if record.kind == "run_started")
        acknowledgement = _acknowledgement(campaign, acknowledgement)
        return _carry_out(
            campaign,
            file,
            attempt=attempt,
            done=sorted(done),
            acknowledgement=acknowledgement,
            report=report,
            console=console,
        )


def _acknowledgement(campaign: Campaign, given: str) -> str:
    """The word that the watchdog wants before it arms again; empty when nothing is to be acknowledged.

    `rigctl resume` itself acknowledges that a process was gone. A trip by the rig's own state (temperature,
    pressure, a sensor) wants the reason in a person's words.
    """
    trip = None
    for record in read_journal(campaign.journal_path):
        if record.source == "watchdog" and record.kind in ("trip", "reset"):
            trip = record.payload if record.kind == "trip" else None
    if trip is None:
        return ""
    if not given and trip.get("cause") not in PROCESS_CAUSES:
        raise SafetyTrip(
            f"the run ended with a safety trip: {trip.get('words', trip.get('cause'))}",
            place=str(campaign.folder),
            remedy='Remove the cause, then: rigctl resume CAMPAIGN --acknowledge "what was found and done"',
        )
    return given or "resumed on the command line after a process had gone"


def _recover(campaign: Campaign, console: Console) -> None:
    for line in recover(campaign).lines():
        console.print(line, highlight=False)


def _carry_out(
    campaign: Campaign,
    file: CampaignFile,
    *,
    attempt: int,
    done: list[int],
    acknowledgement: str,
    report: bool,
    console: Console,
) -> int:
    warm_up = threading.Thread(target=_warm_up_figures, daemon=True)
    if report:
        warm_up.start()
    started = time.monotonic()
    with ProgressView(console, file.program, file.rig.capabilities) as view:
        supervisor = Supervisor(
            campaign.folder,
            file,
            attempt=attempt,
            done=done,
            acknowledgement=acknowledgement,
            show=view.show,
            say=view.say,
        )
        result = supervisor.run()
    wall_s = time.monotonic() - started
    if any(campaign.spools.iterdir()):
        _recover(campaign, console)
    _tell(result, file.program, wall_s, console)
    if report and (file.program is not None or result.done):
        warm_up.join()  # the report is drawn by two processes, which wants a process without threads
        make_report(campaign.folder, console, wall_s=wall_s, rig_s=result.rig_s)
    return _end(result, campaign.folder, console)


def _warm_up_figures() -> None:
    """Load the plotting library while the rig is busy; the report needs it in the end."""
    import matplotlib.figure  # noqa: F401


def _parts(program: Program) -> str:
    """Brakings by sequence: "30 bedding + 225 matrix"."""
    return " + ".join(f"{sequence.count} {sequence.name}" for sequence in program.sequences if sequence.count)


def _tell(result: RunResult, program: Program | None, wall_s: float, console: Console) -> None:
    factor = result.rig_s / wall_s if wall_s > 0 else 0.0
    if program is None:
        words = f"{result.done} brakings by hand in {duration_text(wall_s)}"
        console.print(words, highlight=False)
        return
    parts = f" ({_parts(program)})" if result.done == result.total else ""
    console.print(
        f"{result.done} of {result.total} brakings complete{parts}; "
        f"{duration_text(result.rig_s)} of rig time in {wall_s:.1f} s ({factor:.0f}× real time)",
        highlight=False,
    )


def _end(result: RunResult, folder: Path, console: Console) -> int:
    again = f"Go on with: rigctl resume {folder}"
    if result.outcome is Outcome.FINISHED:
        if not result.incomplete:
            return exit_codes.OK
        console.print(f"Incomplete: {', '.join(map(str, result.incomplete))}. {again}", highlight=False)
        return exit_codes.INCOMPLETE
    if result.outcome is Outcome.STOPPED:
        console.print(f"Stopped safely. {again}", highlight=False)
        return exit_codes.STOPPED
    tripped = result.outcome is Outcome.TRIPPED
    head = "SAFETY TRIP" if tripped else "FAILED"
    console.print(f"[bold]{head}[/bold]: {result.cause}", highlight=False)
    if result.remedy:
        console.print(result.remedy, highlight=False)
    console.print(f"See {folder / 'journal.jsonl'}. {again}", highlight=False)
    return exit_codes.TRIPPED if tripped else exit_codes.FAILED

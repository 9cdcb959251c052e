"""`rigctl check`: the dry run, for people.

Job: print count, duration and problems. Not its job: the rules (`sequences.check`).
"""

from __future__ import annotations

from pathlib import Path

from rich.console import Console

from rigctl.app import exit_codes
from rigctl.app.compose import build_rig, dry_run, read_program, read_rig, resolved_paths
from rigctl.app.durations import duration_text
from rigctl.hal.devices import RigContext
from rigctl.safety.limits import load_limits


def show_check(program_path: Path, rig_path: Path, console: Console) -> int:
    """Print the dry run; returns the exit code."""
    program, rig = read_program(program_path), read_rig(rig_path)
    resolved_paths(rig, rig_path)
    folder = rig_path.resolve().parent
    load_limits((folder / rig.safety.limits).resolve())
    time = "virtual" if rig.simulated else "real"
    build_rig(rig, RigContext(Path(), time, None, str(rig_path), folder))
    result = dry_run(program, rig)
    estimate = result.estimate
    console.print(f"{program.name} on {rig.name}", highlight=False)
    for name, count in result.n_by_sequence.items():
        console.print(f"  {count:5d} brakings  {name}", highlight=False)
    console.print(f"  {result.n_brakings:5d} brakings in all", highlight=False)
    console.print(
        f"Estimated duration {duration_text(estimate.total_s)} of rig time: "
        f"heating {duration_text(estimate.heating_s)}, cooling {duration_text(estimate.cooling_s)}, "
        f"braking {duration_text(estimate.braking_s)}, other "
        f"{duration_text(estimate.soaking_s + estimate.other_s)}",
        highlight=False,
    )
    console.print(f"Recorded data before compression: {result.data_bytes / 1e6:.0f} MB", highlight=False)
    for problem in result.problems:
        console.print(
            f"[bold]{problem.severity}[/bold] {problem.place} = {problem.value}: {problem.problem} "
            f"({problem.count} brakings, first {problem.first_index}); {problem.remedy}",
            highlight=False,
        )
    if result.ok:
        console.print("The program can be run.", highlight=False)
        return exit_codes.OK
    console.print("The program cannot be run on this rig.", highlight=False)
    return exit_codes.USAGE

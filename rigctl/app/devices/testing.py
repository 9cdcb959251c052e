"""`rigctl devices test RIG`: each device of a rig file opened one by one, without moving anything.

Job: the command, its report for people and as JSON, its exit code. Not its job: the examination
(`rigctl.app.devices.examine`).
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape

from rigctl.app import exit_codes
from rigctl.app.devices.common import (
    RigArgument,
    RoleOption,
    WireLogOption,
    console,
    roles_of,
    seconds_text,
    value_text,
)
from rigctl.app.devices.examine import DeviceReport, Result, RigFile, examine, run_folder

DEFAULT_ROUND_TRIPS = 100
_COLOURS = {Result.OK: "green", Result.WARNING: "yellow", Result.FAILED: "red", Result.SIMULATED: "dim"}


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command("test")
    def test(
        rig: RigArgument,
        role: RoleOption = None,
        round_trips: Annotated[
            int, typer.Option("--round-trips", "-n", min=1, max=100_000, help="Exchanges to time per device.")
        ] = DEFAULT_ROUND_TRIPS,
        as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
        wire_log: WireLogOption = None,
    ) -> None:
        """Open each device of a rig one by one, move nothing, and say what each is and what is unsafe.

        Exit code 0: all may be used (look at the warnings); 1: at least one failed.
        """
        screen = console()
        file = RigFile.read(rig)
        reports: list[DeviceReport] = []
        with run_folder() as run_dir:
            for name in roles_of(role):
                folder = run_dir / name
                folder.mkdir()
                logs = wire_log / name if wire_log else None  # each device opens its bus anew
                report = examine(file, name, round_trips=round_trips, run_dir=folder, wire_log_dir=logs)
                reports.append(report)
                if not as_json:
                    show(report, screen)
        failed = [report.role for report in reports if report.result is Result.FAILED]
        if as_json:
            print(json.dumps(as_mapping(file, reports), indent=2, ensure_ascii=False, allow_nan=False))
        else:
            screen.print(_summary(reports, failed))
        raise typer.Exit(exit_codes.FAILED if failed else exit_codes.OK)


def show(report: DeviceReport, screen: Console) -> None:
    """One device, for people."""
    colour = _COLOURS[report.result]
    screen.print(f"[bold]{report.role}[/bold] ({escape(report.kind)}): [{colour}]{report.result}[/{colour}]")
    if report.result is Result.SIMULATED:
        screen.print("  has no wires; its settings are right")
    diagnosis = report.diagnosis
    if diagnosis is not None:
        for line in identity_lines(diagnosis.identity):
            screen.print(f"  {escape(line)}")
        for reading in diagnosis.values:
            age = f", {seconds_text(reading.age_s)} old" if reading.age_s is not None else ""
            rate = f", {reading.rate_hz:.4g}/s" if reading.rate_hz is not None else ""
            screen.print(f"  {escape(reading.name):28s} {escape(value_text(reading))}{rate}{age}")
    if report.timing is not None:
        times = report.timing
        screen.print(
            f"  {f'{times.count} round trips':28s} min {seconds_text(times.min_s)}, "
            f"median {seconds_text(times.median_s)}, p99 {seconds_text(times.p99_s)}, "
            f"max {seconds_text(times.max_s)}"
        )
    for finding in report.findings:
        mark = "[red]unsafe[/red]" if finding.unsafe else f"[{colour}]![/{colour}]"
        screen.print(f"  {mark} {escape(finding.problem)}")
        if finding.remedy:
            screen.print(f"    {escape(finding.remedy)}")


def identity_lines(identity: Mapping[str, str]) -> list[str]:
    """What a device says of itself, one line; "source.key" of an acquisition: one line for each source."""
    parts: dict[str, list[str]] = {}
    for key, value in identity.items():
        source, dot, inner = key.partition(".")
        parts.setdefault(f"{source}: " if dot else "", []).append(f"{inner or source} {value}")
    return [f"{source}{', '.join(said)}" for source, said in parts.items()] or ["says nothing of itself"]


def as_mapping(file: RigFile, reports: list[DeviceReport]) -> dict[str, Any]:
    """The same for programs; numbers that are not finite become null."""
    return {
        "rig": file.config.name,
        "file": str(file.path),
        "result": "failed" if any(report.result is Result.FAILED for report in reports) else "ok",
        "devices": [
            {
                "role": report.role,
                "kind": report.kind,
                "class": report.target,
                "result": report.result.value,
                "identity": dict(report.diagnosis.identity) if report.diagnosis else {},
                "values": [_finite(asdict(reading)) for reading in report.diagnosis.values]
                if report.diagnosis
                else [],
                "round_trip_s": _finite(asdict(report.timing)) if report.timing else None,
                "findings": [asdict(finding) for finding in report.findings],
            }
            for report in reports
        ],
    }


def _finite(mapping: dict[str, Any]) -> dict[str, Any]:
    return {
        key: None if isinstance(value, float) and not math.isfinite(value) else value
        for key, value in mapping.items()
    }


def _summary(reports: list[DeviceReport], failed: list[str]) -> str:
    if failed:
        return f"[red]{len(failed)} of {len(reports)} failed:[/red] {', '.join(failed)}."
    if all(report.result is Result.SIMULATED for report in reports):
        return "All devices are simulated: there is nothing to bring up."
    warned = [report.role for report in reports if report.result is Result.WARNING]
    return f"None failed{'; look at the warnings of: ' + ', '.join(warned) if warned else ''}."

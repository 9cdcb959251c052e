"""`rigctl laboratory …`: faults and stimuli on a running simulated rig.

Job: find the running rig, the command, the words of its answer. Not its job: what a stimulus does
(`sim_hardware.devices.stimuli`).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console
from rich.markup import escape

from rigctl.app.fields import parsed_fields

_EXAMPLES = """\b
rigctl laboratory status
rigctl laboratory estop pressed=true
rigctl laboratory doors open=true
rigctl laboratory sensor channel=pressure mode=invalid
rigctl laboratory sensor channel=disc_temperature mode=frozen seen_by=watchdog
rigctl laboratory sensor channel=torque mode=offset value=40
rigctl laboratory disc degc=120
rigctl laboratory vent_valve stuck=true
rigctl laboratory weight torque_nm=250
rigctl laboratory calibrator level_db=94
rigctl laboratory microphone drift_db=0.4
rigctl laboratory sensor channel=speed mode=invalid at_s=30
rigctl laboratory clear"""


def register(app: typer.Typer) -> None:
    """Add `rigctl laboratory` to the command line."""
    app.command("laboratory", epilog=f"Examples:\n\n{_EXAMPLES}")(_laboratory)


def _laboratory(
    do: Annotated[str, typer.Argument(help="status, or what to do; see the examples.")] = "status",
    fields: Annotated[
        list[str] | None, typer.Argument(metavar="[KEY=VALUE]...", help="How, e.g. pressed=true.")
    ] = None,
    campaign: Annotated[
        Path | None, typer.Option("--campaign", help="Campaign folder, when several runs are going on.")
    ] = None,
) -> None:
    """Make something go wrong on the running simulated rig, or mend it: emergency stop, doors, sensors, …"""
    from rigctl.app.sessions import the_session
    from sim_hardware.devices.laboratory import Laboratory

    with Laboratory(the_session(campaign).run_dir) as laboratory:
        answer = laboratory.ask(do, **parsed_fields(fields or [], "rigctl laboratory"))
    if do == "status":
        print(json.dumps(answer, indent=1))
        return
    console = Console(soft_wrap=True)
    for line in in_force(answer) or ["Nothing is disturbed."]:
        console.print(escape(line), highlight=False)


def in_force(answer: dict[str, Any]) -> list[str]:
    """What an answer says is in force, a line each."""
    lines = []
    if answer["estop_pressed"]:
        lines.append("The emergency stop is pressed.")
    if answer["doors_open"]:
        lines.append("A door is open.")
    for channel, fault in answer["sensors"].items():
        value = f" by {fault['value']:g}" if fault["mode"] == "offset" else ""
        who = "" if fault["seen_by"] == "both" else f" (seen by the {fault['seen_by']} only)"
        lines.append(f"Sensor {channel}: {fault['mode']}{value}{who}.")
    if answer["vent_valve_stuck"]:
        lines.append("The vent valve is stuck.")
    if answer["weight_nm"]:
        lines.append(f"A lever puts {answer['weight_nm']:g} N·m on the torque sensor.")
    if answer["calibrator_db"]:
        lines.append(f"A calibrator gives {answer['calibrator_db']:g} dB at the microphone.")
    if answer["drift_db"]:
        lines.append(f"The microphone has drifted by {answer['drift_db']:+g} dB.")
    for request in answer["waiting"]:
        fields = ((key, value) for key, value in request.items() if key not in ("do", "at_s"))
        words = ", ".join(f"{key}={value}" for key, value in fields)
        lines.append(f"At {request['at_s']:g} s of rig time: {request['do']} {words}".rstrip())
    return lines

"""`rigctl laboratory …`: faults and stimuli on a running simulated rig.

Job: find the running rig, the command. Not its job: what a stimulus does (`sim_hardware.devices.stimuli`).
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Annotated

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
    from sim_hardware.devices.laboratory import Laboratory, in_force

    with Laboratory(the_session(campaign).run_dir) as laboratory:
        answer = laboratory.ask(do, **parsed_fields(fields or [], "rigctl laboratory"))
    if do == "status":
        print(json.dumps(answer, indent=1))
        return
    console = Console(soft_wrap=True)
    for line in in_force(answer) or ["Nothing is disturbed."]:
        console.print(escape(line), highlight=False)

"""`rigctl sessions`, `rigctl control`, `rigctl gui`: what runs, verbs and set-points for it, and the window.

Job: the same verbs and commands as in the window, for terminals and scripts. Not its job: what they do
(`rigctl.engine`), the window (a process of its own).
"""

from __future__ import annotations

import getpass
import json
import os
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from rich.console import Console
from rich.table import Table

from rigctl.app import exit_codes
from rigctl.app.fields import parsed_fields
from rigctl.core.errors import RunError
from rigctl.engine.state import Progress, Verb

if TYPE_CHECKING:
    from rigctl.app.control_socket import ControlClient

ANSWER_TIMEOUT_S = 30.0
CONNECT_TIMEOUT_S = 5.0
_VERBS = ", ".join(verb.value for verb in Verb)
_EXAMPLES = """\b
rigctl control pause
rigctl control stop
rigctl control note "text=new pads"
rigctl control rate rating=7
rigctl control enable
rigctl control set_speed speed_rpm=100 ramp_rpm_per_s=50
rigctl control set_pressure pressure_bar=10
rigctl control record duration_s=5 speed_rpm=40 pressure_bar=20 "comment=first try"
rigctl control condition temperature_degc=80
rigctl control disable
rigctl control reset "reason=door was open; closed it"
"""

CampaignOption = Annotated[
    Path | None, typer.Option("--campaign", help="Campaign folder. [default: the one that runs]")
]


def register(app: typer.Typer) -> None:
    """Add the commands."""
    app.command("sessions")(_sessions)
    app.command("control", epilog=f"Examples:\n\n{_EXAMPLES}")(_control)
    app.command(
        "gui",
        context_settings={"allow_extra_args": True, "ignore_unknown_options": True, "help_option_names": []},
        add_help_option=False,
    )(_gui)


def _gui(ctx: typer.Context) -> None:
    """The operator's window; it attaches to what runs, and closing it changes nothing on the rig."""
    sys.stdout.flush()
    os.execv(sys.executable, [sys.executable, "-m", "rigctl.gui", *ctx.args])


def _sessions(as_json: Annotated[bool, typer.Option("--json", help="As JSON.")] = False) -> None:
    """What is running on this machine."""
    from rigctl.app.sessions import running_sessions

    sessions = running_sessions()
    if as_json:
        rows = [
            {"campaign": str(s.campaign), "pid": s.pid, "mode": s.mode, "rig": s.rig.name, "time": s.time}
            for s in sessions
        ]
        print(json.dumps(rows, indent=1))
        return
    console = Console(soft_wrap=True)
    if not sessions:
        console.print("Nothing is running.")
        return
    table = Table("campaign", "mode", "rig", "time", "pid")
    for session in sessions:
        rig = session.rig.name + (" (simulated)" if session.simulated else " (REAL)")
        table.add_row(str(session.campaign), session.mode, rig, session.time, str(session.pid))
    console.print(table)


def _control(
    what: Annotated[str, typer.Argument(help=f"A verb ({_VERBS}) or a command; see the examples.")],
    fields: Annotated[
        list[str] | None, typer.Argument(metavar="[KEY=VALUE]...", help="Values of a command.")
    ] = None,
    campaign: CampaignOption = None,
    take_over: Annotated[
        bool, typer.Option("--take-over", help="Command even if somebody else does; they are told.")
    ] = False,
) -> None:
    """Give a verb or a command to a running session: the same as in the window."""
    from rigctl.app.control_socket import COMMAND, ControlClient
    from rigctl.app.sessions import the_session

    session = the_session(campaign)
    who = f"{getpass.getuser()} (rigctl control)"
    client = ControlClient(session.run_dir, CONNECT_TIMEOUT_S, who=who, role=COMMAND)
    try:
        if take_over:
            client.take()
        values = parsed_fields(fields or [], command="rigctl control")
        number = _say(client, what, values)
        progress = _wait(client, number)
    finally:
        client.close()
    if progress is not None:
        words = f"{progress.state.value}: {progress.phase}"
        Console(soft_wrap=True).print(words, highlight=False, markup=False)
    raise typer.Exit(exit_codes.OK)


def _say(client: ControlClient, what: str, values: dict[str, Any]) -> int:
    name = what.replace("-", "_")
    if name in {verb.value for verb in Verb}:
        return client.send(Verb(name))
    return client.command(name, **values)


def _wait(client: ControlClient, number: int) -> Progress | None:
    """Newest progress once the answer has come.

    Raises
    ------
    RunError
        The request was refused, or nobody has answered.
    """
    from rigctl.app.control_socket import Answer

    deadline, progress = time.monotonic() + ANSWER_TIMEOUT_S, None
    while time.monotonic() < deadline:
        news = client.recv(0.5)
        if isinstance(news, Progress):
            progress = news
        elif isinstance(news, Answer) and news.number == number:
            if news.reason:
                raise RunError(f"refused: {news.reason}", place="rigctl control", remedy=news.remedy)
            return progress
    raise RunError(
        f"no answer within {ANSWER_TIMEOUT_S:g} s.", place="rigctl control",
        remedy="Look at the session's logs.",
    )  # fmt: skip

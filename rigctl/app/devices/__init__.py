"""`rigctl devices …`: bring-up of a rig: what is connected, does each device answer, what does it say now.

Job: the commands. Not its job: talking to devices (their drivers), running programs. None of the commands
enables, moves, pressurises or closes the safety relay.
"""

from __future__ import annotations

from importlib import import_module

import typer

#: modules with a function `register(app)`, in the order of the help
_COMMANDS = ("listing", "testing", "monitor")


def devices_app() -> typer.Typer:
    """All commands of `rigctl devices`."""
    app = typer.Typer(
        name="devices",
        help="Bring-up of a rig: what is connected, does it answer, what does it say.\n\n"
        "Start with:  rigctl devices list",
        no_args_is_help=True,
    )
    for command in _COMMANDS:
        import_module(f"rigctl.app.devices.{command}").register(app)
    return app


def register(app: typer.Typer) -> None:
    """Add them to the command line."""
    app.add_typer(devices_app(), name="devices")

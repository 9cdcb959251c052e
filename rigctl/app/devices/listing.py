"""`rigctl devices list`: what is connected to this machine, and which kinds of devices rigctl knows.

Job: the command and its tables. Each part is asked by itself: a missing library or sound server is one line
there, and the rest is still told. Not its job: asking the libraries (`drivers.listing`).
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Annotated, Any

import typer
from rich.markup import escape
from rich.table import Table

from drivers import listing as hardware
from rigctl.app import compose
from rigctl.app.devices.common import console
from rigctl.config.rig import ROLES
from rigctl.core.errors import RigctlError
from rigctl.core.registry import Registry

SOURCE = "source"
"""Signal sources of the live acquisition (`drivers.daq.source`) are registered like roles."""


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of device: where it comes from, and why it cannot be used ("" when it can)."""

    role: str
    kind: str
    target: str
    origin: str
    problem: str = ""


@dataclass(frozen=True, slots=True)
class Part:
    """One part of the list: rows, and remarks that are lines."""

    title: str
    rows: Sequence[Any]
    remarks: Sequence[str] = ()


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command("list")
    def list_devices(
        network: Annotated[
            bool, typer.Option("--network", help="Ask the network for socketcand servers too (4 s).")
        ] = False,
        as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
    ) -> None:
        """Serial ports, CAN interfaces, sound devices, ports of a running bench, known kinds of devices."""
        parts = collect(network=network)
        if as_json:
            content = {
                part.title: {"found": [asdict(row) for row in part.rows], "remarks": list(part.remarks)}
                for part in parts
            }
            print(json.dumps(content, indent=2, ensure_ascii=False))
            return
        screen = console()
        for part in parts:
            screen.print(f"[bold]{part.title}[/bold]")
            if part.rows:
                screen.print(_table(part.rows))
            elif not part.remarks:
                screen.print("  none")
            for remark in part.remarks:
                screen.print(f"  {escape(remark)}")


def collect(*, network: bool = False) -> list[Part]:
    """All parts; none of them can break another."""

    def can() -> tuple[Sequence[Any], Sequence[str]]:
        return hardware.can_interfaces(network=network)

    def sound() -> tuple[Sequence[Any], Sequence[str]]:
        found = hardware.sound_devices()
        return found, () if found else (
            "none with inputs: plug the microphone's interface in; if it is, start the sound server "
            "(pulseaudio --start, or PipeWire), and see that this user is in the group audio.",
        )

    return [
        _part("serial ports", lambda: (hardware.serial_ports(), ())),
        _part("CAN interfaces", can),
        _part("sound devices", sound),
        _part("ports of a running bench", lambda: (hardware.bench_ports(), ())),
        _part("kinds of devices", lambda: (known_kinds(_with_sources(compose.registry())), ())),
    ]


def known_kinds(table: Registry) -> list[Kind]:
    """All kinds for all roles and for sources of the acquisition, each tried by importing it."""
    kinds: list[Kind] = []
    for role in (*ROLES, SOURCE):
        for kind in table.kinds(role):
            target = origin = problem = ""
            try:
                target = table.target(role, kind)
                origin = table.origin(role, kind)
                table.load(role, kind, place=f"{role} {kind!r}")
            except RigctlError as error:
                problem = f"{error.problem} {error.remedy}".rstrip()
            kinds.append(Kind(role, kind, target, origin, problem))
    return kinds


def _with_sources(table: Registry) -> Registry:
    from drivers.daq.acquisition import KINDS

    for kind, target in KINDS.items():
        table.register(SOURCE, kind, target)
    return table


def _part(title: str, ask: Callable[[], tuple[Sequence[Any], Sequence[str]]]) -> Part:
    try:
        rows, remarks = ask()
    except RigctlError as error:
        return Part(title, (), (f"{error.problem} {error.remedy}".rstrip(),))
    except Exception as error:  # a vendor's library that is broken here
        return Part(title, (), (f"cannot be listed: {type(error).__name__}: {error}.",))
    return Part(title, rows, remarks)


def _table(rows: Sequence[Any]) -> Table:
    shown = [asdict(row) for row in rows]
    columns = [name for name in shown[0] if any(row[name] not in ("", None) for row in shown)]
    table = Table(box=None, pad_edge=True, header_style="dim")
    for name in columns:
        table.add_column(name.replace("_", " "), overflow="fold")
    for row in shown:
        table.add_row(*(escape(_cell(row[name])) for name in columns))
    return table


def _cell(value: Any) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, tuple):
        return " ".join(str(entry) for entry in value) or "none tried"
    return f"{value:g}" if isinstance(value, float) else str(value)

"""`rigctl devices monitor RIG`: a live table of what all devices say; nothing is enabled or moved.

Job: the command; a thread per device that opens it, asks it, and opens it again after a failure; the table. A
device that is slow or gone holds up none of the others. Not its job: the words of a device (its `diagnose`).
"""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import FrameType
from typing import Annotated, Any

import typer
from rich.live import Live
from rich.markup import escape
from rich.table import Table

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
from rigctl.app.devices.examine import SIMULATED, RigFile, ask, explained, run_folder
from rigctl.core.errors import ConfigError
from rigctl.hal.devices import RigContext
from rigctl.hal.diagnosis import Diagnosis

RETRY_S = 2.0
OPENING = "is being opened"
LONGEST_OPENING_S = 60.0
_STALE_S = 1.0
_JOIN_S = 10.0


@dataclass(frozen=True, slots=True)
class View:
    """What is known of a device: newest diagnosis, when it was made, and the failure, if any."""

    diagnosis: Diagnosis | None = None
    at_s: float = 0.0
    failure: str = OPENING


class Watcher:
    """Keeps one device open and asks it again and again, in a thread of its own.

    Parameters
    ----------
    rig, role, context
        The device.
    every_s : float
        Time between questions.
    opening : threading.Lock
        Devices on one bus are opened and closed one after the other.
    """

    def __init__(
        self, rig: RigFile, role: str, context: RigContext, every_s: float, opening: threading.Lock
    ) -> None:
        self.role = role
        self.kind = rig.device(role).kind
        self.view = View()
        self._rig, self._context, self._every_s, self._opening = rig, context, every_s, opening
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f"monitor {role}", daemon=True)

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self) -> None:
        """Ask the thread to close its device and end."""
        self._stop.set()

    def join(self, timeout_s: float) -> bool:
        """Whether it has ended within the time."""
        self._thread.join(timeout_s)
        return not self._thread.is_alive()

    def board_faults(self) -> Mapping[str, str]:
        """Faults that devices have published, by device; the board is common to the rig."""
        return self._context.board.snapshot().get("faults", {})

    def _run(self) -> None:
        while not self._stop.is_set():
            device: Any = None
            try:
                with self._opening:
                    device = self._rig.make(self.role, self._context)
                    device.open()
                while not self._stop.is_set():
                    diagnosis = ask(device, self.role, 0)
                    self.view = View(diagnosis, time.monotonic(), "")
                    self._stop.wait(self._every_s)
            except Exception as error:  # shown in the table; the device is tried again
                finding = explained(error, self._rig.place(self.role), self.kind)
                self.view = View(self.view.diagnosis, self.view.at_s, str(finding))
            finally:
                self._close(device)
            self._stop.wait(RETRY_S)

    def _close(self, device: Any) -> None:
        if device is None:
            return
        try:
            with self._opening:
                device.close()
        except Exception as error:  # told, since the contract says that close never raises
            self.view = View(self.view.diagnosis, self.view.at_s, f"closing: {type(error).__name__}: {error}")


def register(app: typer.Typer) -> None:
    """Add the command."""

    @app.command("monitor")
    def monitor(
        rig: RigArgument,
        role: RoleOption = None,
        every: Annotated[
            float, typer.Option("--every", min=0.05, max=60, help="Seconds between readings.")
        ] = 0.2,
        duration: Annotated[
            float | None,
            typer.Option("--for", min=0.1, help="End so many seconds after all are open. [default: Ctrl-C]"),
        ] = None,
        wire_log: WireLogOption = None,
    ) -> None:
        """Live table of all values with their age and rate, and of faults. Ctrl-C ends it.

        Nothing is enabled or moved. A device that fails is opened again every two seconds. With --for, exit
        code 1 says that a device had failed at the end.
        """
        file = RigFile.read(rig)
        roles = [name for name in roles_of(role) if not _is_simulated(file, name)]
        if not roles:
            raise ConfigError(
                "all devices are simulated: there is nothing to monitor.", place=str(rig),
                remedy="Name a rig file with real devices, e.g. configs/rigs/bench.toml.",
            )  # fmt: skip
        with run_folder() as run_dir:
            failed = watch(file, roles, run_dir, every_s=every, duration_s=duration, wire_log_dir=wire_log)
        raise typer.Exit(exit_codes.FAILED if failed and duration is not None else exit_codes.OK)


def watch(
    file: RigFile,
    roles: Sequence[str],
    run_dir: Path,
    *,
    every_s: float,
    duration_s: float | None,
    wire_log_dir: Path | None,
) -> bool:
    """Show the table until the time is over or a person ends it; whether any device had failed at the end."""
    context = file.context(run_dir, wire_log_dir)
    opening = threading.Lock()
    watchers = [Watcher(file, role, context, every_s, opening) for role in roles]
    before = signal.signal(signal.SIGTERM, _interrupt)
    end_s = float("inf")
    tried_by_s = time.monotonic() + LONGEST_OPENING_S
    try:
        for watcher in watchers:
            watcher.start()
        with Live(table(watchers), console=console(), auto_refresh=False) as live:
            while (now_s := time.monotonic()) < end_s:
                opening_now = any(watcher.view.failure == OPENING for watcher in watchers)
                if duration_s is not None and end_s == float("inf"):
                    end_s = now_s + duration_s if not opening_now or now_s > tried_by_s else end_s
                time.sleep(max(0.0, min(every_s, end_s - now_s)))
                live.update(table(watchers), refresh=True)
    except KeyboardInterrupt:
        pass
    finally:
        failed = any(watcher.view.failure for watcher in watchers)
        for watcher in watchers:
            watcher.stop()
        for watcher in watchers:
            watcher.join(_JOIN_S)
        signal.signal(signal.SIGTERM, before)
    return failed


def table(watchers: Sequence[Watcher]) -> Table:
    """All values of all devices as they are known now."""
    now_s = time.monotonic()
    shown = Table(box=None, header_style="bold", expand=False)
    for heading in ("device", "value", "", "age", "rate", "fault"):
        numeric = heading in ("", "age", "rate")
        shown.add_column(heading, justify="right" if numeric else "left", no_wrap=heading != "fault")
    for watcher in watchers:
        view = watcher.view
        label = f"{watcher.role} ({escape(watcher.kind)})"
        if view.failure:
            shown.add_row(label, "", "", "", "", f"[red]{escape(view.failure)}[/red]")
            label = ""
        if view.diagnosis is None:
            continue
        waited_s = now_s - view.at_s
        for reading in view.diagnosis.values:
            age_s = (reading.age_s or 0.0) + waited_s
            stale = view.failure or age_s > _STALE_S or reading.fault
            rate = "" if reading.rate_hz is None else f"{reading.rate_hz:.4g}/s"
            shown.add_row(
                label, escape(reading.name), escape(value_text(reading)), seconds_text(age_s), rate,
                escape(reading.fault), style="yellow" if stale else "",
            )  # fmt: skip
            label = ""
    faults = watchers[0].board_faults() if watchers else {}
    for device, problem in faults.items():
        shown.add_row(escape(device), "", "", "", "", f"[red]{escape(problem)}[/red]")
    return shown


def _is_simulated(file: RigFile, role: str) -> bool:
    try:
        return file.target(role).startswith(SIMULATED)
    except ConfigError:
        return False  # told in the table


def _interrupt(_number: int, _frame: FrameType | None) -> None:
    raise KeyboardInterrupt

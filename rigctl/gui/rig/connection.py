"""The window's one connection to a controller: signals for what comes, methods for what a person asks.

Job: find running sessions, watch one, start new ones as processes of their own, send commands. Everything is
asked of the controller, which decides; a refusal comes back as `refused` with the reason. Not its job:
samples (`rigctl.gui.live`), words for the state (`rigctl.gui.rig.state`).
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal

from rigctl.engine.state import Verb
from rigctl.gui.rig.state import RigState


class RigConnection(QObject):
    """Signals and commands of the rig."""

    stateChanged = Signal(object)
    """RigState, at most ten times a second and with every change of its word."""
    recordsAdded = Signal(list)
    """Newly read records of the campaign's journal (`rigctl.core.journal.Record`); first all."""
    attached = Signal(object)
    """Session that the window watches now."""
    detached = Signal(str)
    """It has ended or gone; why."""
    refused = Signal(str)
    """The controller or this window refused something; why."""
    blocksArrived = Signal(list)
    """Blocks since the last time, for live plots: mappings with t_ns, dt_ns, stride and ranges (as `Block`)."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.state = RigState()
        self.session: Any = None
        """Session that is watched, as `attached` gave it; pages that are made later look here."""
        self.records: list[Any] = []
        """All records of its journal so far."""

    # -- sessions ---------------------------------------------------------------------------------

    def start_manual(self, rig: Path, *, time: str = "real", seed: int | None = None) -> None:
        """Start a controller for manual brakings on a rig, and watch it."""

    def start_program(
        self, program: Path, rig: Path, *, time: str | None = None, seed: int | None = None
    ) -> None:
        """Start a program run (`rigctl run`), and watch it."""

    def resume(self, campaign: Path, reason: str) -> None:
        """Go on with a campaign (`rigctl resume --acknowledge REASON`)."""

    # -- commands: any of them may be refused ------------------------------------------------------

    def stop(self) -> None:
        """Software stop: from anybody, at any time."""

    def verb(self, verb: Verb) -> None:
        """Pause, hold, resume, skip, repeat or stop the program."""

    def take_command(self) -> None:
        """Command from this window from now on; whoever had it is told."""

    def enable(self) -> None:
        """Manual: arm the watchdog and allow torque and pressure. The page has asked the person."""

    def disable(self) -> None:
        """Manual: release, run down, open the relay."""

    def set_speed(self, speed_rpm: float, ramp_rpm_per_s: float) -> None:
        """Manual: go to a speed."""

    def set_pressure(self, pressure_bar: float, function: Mapping[str, Any] | None = None,
                     duration_s: float | None = None) -> None:  # fmt: skip
        """Manual: apply a pressure; with a function (as in a program file) for a duration around it."""

    def set_ventilator(self, flow_m3_h: float) -> None:
        """Manual: cooling air; 0 is off."""

    def condition(self, temperature_degc: float) -> None:
        """Manual: bring the disc to a temperature by dragging or cooling; any other command ends it."""

    def record(self, duration_s: float, *, speed_rpm: float, pressure_bar: float,
               function: Mapping[str, Any] | None = None, comment: str = "") -> None:  # fmt: skip
        """Manual: record one braking of that duration at a speed and pressure."""

    def reset(self, reason: str) -> None:
        """After a trip: acknowledged by a person in words; leads to LOCKED, never to motion."""

    def note(self, text: str) -> None:
        """An operator's note, journaled with time, stored with the present braking."""

    def rate(self, rating: int) -> None:
        """Subjective noise rating 1 (nothing heard) to 9 of the present or last braking."""

    def acknowledge_alarm(self, alarm: str) -> None:
        """A person has seen an alarm; the controller journals it."""

    def close(self) -> None:
        """Leave; the run goes on."""

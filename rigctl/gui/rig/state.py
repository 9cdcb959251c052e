"""What the window believes about the rig: one immutable value, made from controller and journal.

Job: the words of the state bar and the reasons behind them. Plain data, no Qt: tested without a screen. Not
its job: where the news come from (`rigctl.gui.rig.connection`).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path


class Word(StrEnum):
    """State of the rig in one word."""

    OFFLINE = "OFFLINE"
    STARTING = "STARTING"
    LOCKED = "LOCKED"
    READY = "READY"
    RUNNING = "RUNNING"
    PAUSED = "PAUSED"
    STOPPING = "STOPPING"
    TRIPPED = "TRIPPED"


@dataclass(frozen=True)
class SafetyCause:
    """First-out cause of a trip: what, and what to do next, in plain words; time as in the journal."""

    words: str
    remedy: str = ""
    utc: str = ""
    acknowledged: bool = False


@dataclass(frozen=True)
class Readings:
    """Newest block means and set-points in rig units; NaN where nothing is known."""

    speed_rpm: float = float("nan")
    pressure_bar: float = float("nan")
    torque_nm: float = float("nan")
    temperature_degc: float = float("nan")
    mu: float = float("nan")
    set_speed_rpm: float = float("nan")
    set_pressure_bar: float = float("nan")
    ventilator_m3_h: float = float("nan")


@dataclass(frozen=True)
class RigState:
    """All that is shown of the rig outside the live plots.

    Attributes
    ----------
    word : Word
    mode : str
        "program", "manual" or "" when there is no session.
    campaign : Path or None
        Folder of the campaign that is being written.
    rig_name, simulated, time : str, bool or None, str
        Of the session; `simulated` is None while no rig is known.
    phase : str
        What is going on, in words of the engine.
    braking, done, total, incomplete, squealing : int
        Number of the present braking (program number), complete ones, all, broken off, with squeal.
    left_s : float or None
        Estimated time to the end, s of wall clock.
    disk_left_bytes : float or None
        Free bytes where the campaign is written.
    cause : SafetyCause or None
        First-out cause while tripped.
    relay_closed, enabled : bool
        Safety relay, drive torque.
    commander : str
        Who may command ("" nobody); `commanding` is True when it is this window.
    recording, recording_left_s : bool, float or None
        A braking is being recorded, and for how much longer in rig time, s; None when unknown.
    """

    word: Word = Word.OFFLINE
    mode: str = ""
    campaign: Path | None = None
    rig_name: str = ""
    simulated: bool | None = None
    time: str = ""
    phase: str = ""
    braking: int = 0
    done: int = 0
    total: int = 0
    incomplete: int = 0
    squealing: int = 0
    rig_s: float = 0.0
    left_s: float | None = None
    disk_left_bytes: float | None = None
    cause: SafetyCause | None = None
    relay_closed: bool = False
    enabled: bool = False
    commander: str = ""
    commanding: bool = False
    recording: bool = False
    recording_left_s: float | None = None
    readings: Readings = field(default_factory=Readings)

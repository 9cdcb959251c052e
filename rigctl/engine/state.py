"""States, verbs and results of the engine: the words that CLI, GUI and journal share."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum


class State(StrEnum):
    """What the engine is doing. `FAULTED` lasts until the process ends; nothing moves any more."""

    IDLE = "idle"
    RUNNING = "running"
    PAUSED = "paused"
    STOPPING = "stopping"
    FAULTED = "faulted"


class Verb(StrEnum):
    """What a person can ask of a running program.

    ``PAUSE``: break off the present braking, release, wait; it is repeated on resume.
    ``HOLD``: finish the present braking, then wait. ``RESUME``: go on.
    ``SKIP``: break off the present braking and go on with the next.
    ``REPEAT``: break off the present braking and start it again.
    ``STOP``: break off the present braking, release, end the run; `rigctl resume` continues later. A manual
    session runs down and locks, and can be enabled again.
    ``END``: as ``STOP``, and a manual session ends, too.
    """

    PAUSE = "pause"
    HOLD = "hold"
    RESUME = "resume"
    SKIP = "skip"
    REPEAT = "repeat"
    STOP = "stop"
    END = "end"


class BreakOff(Exception):
    """Thrown into the script of a braking to end it early; `reason` is stored with the braking."""

    def __init__(self, verb: Verb | None, reason: str) -> None:
        self.verb = verb
        self.reason = reason
        super().__init__(reason)


class Outcome(StrEnum):
    """How a run ended."""

    FINISHED = "finished"
    STOPPED = "stopped"
    TRIPPED = "tripped"
    FAILED = "failed"


@dataclass
class Progress:
    """What a person wants to see while a program runs; sent to every client as plain values."""

    state: State = State.IDLE
    phase: str = ""
    braking: int = 0
    total: int = 0
    done: int = 0
    incomplete: int = 0
    squealing: int = 0
    rig_s: float = 0.0
    speed_rpm: float = 0.0
    pressure_bar: float = 0.0
    torque_nm: float = 0.0
    temperature_degc: float = 0.0
    safety: str = "locked"
    mode: str = "program"
    set_speed_rpm: float = 0.0
    set_pressure_bar: float = 0.0
    ventilator_m3_h: float = 0.0
    mu: float = float("nan")
    relay: bool = False
    enabled: bool = False
    recording: bool = False
    recording_left_s: float = 0.0
    cause: str = ""
    remedy: str = ""


@dataclass
class RunResult:
    """How a run ended and what it left."""

    outcome: Outcome
    done: int
    total: int
    incomplete: list[int] = field(default_factory=list)
    rig_s: float = 0.0
    cause: str = ""
    remedy: str = ""

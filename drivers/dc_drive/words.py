"""The words between a drive's thread and the link to one kind of drive.

Job: what is wished, what the drive reports, what can go wrong, and the protocol of links. Not its job:
threads (`polled`), bytes (`modbus_link`, `eurotherm_link`).
"""

from __future__ import annotations

import enum
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

from rigctl.hal.diagnosis import Finding
from rigctl.hal.wirelog import WireLog


class LinkError(Exception):
    """The drive did not answer, or not correctly, within the deadline; or its port is gone."""


class Refused(LinkError):
    """The drive has answered, and refuses."""


class Torque(enum.Enum):
    """What is asked of the motor."""

    OFF = "off"
    ON = "on"
    QUICK_STOP = "quick stop"


class DriveState(enum.Enum):
    """What the drive says it does."""

    OFF = "off"
    INHIBITED = "start inhibited (safe torque off, or an interlock of the drive)"
    RUNNING = "running"
    STOPPING = "stopping"
    TRIPPED = "tripped"


@dataclass(frozen=True, slots=True)
class Wish:
    """What the drive is to do; sent whole in every cycle."""

    torque: Torque = Torque.OFF
    speed_rpm: float = 0.0
    ramp_rpm_per_s: float | None = None
    reset: bool = False


@dataclass(frozen=True, slots=True)
class Report:
    """What the drive reports in a cycle."""

    state: DriveState
    actual_rpm: float
    status: int
    remote: bool = True
    alarm: bool = False


@dataclass(frozen=True, slots=True)
class Trip:
    """A trip by its code, its name and whether the driver may reset it when it enables the drive."""

    code: int
    name: str
    resettable: bool

    def __str__(self) -> str:
        return f"{self.name} (code {self.code:#06x})"


class DriveLink(Protocol):
    """How to talk to one kind of drive. Used by one thread at a time. Every call raises `LinkError`.

    Attributes
    ----------
    log : WireLog
        Where transfers are written; given anew with every opening.
    """

    log: WireLog

    @property
    def round_trips_s(self) -> Sequence[float]:
        """Times of the newest exchanges."""
        ...

    @property
    def retries(self) -> int:
        """Exchanges that had to be repeated."""
        ...

    def connect(self) -> None:
        """Open the port."""
        ...

    def disconnect(self) -> None:
        """Close the port; never raises."""
        ...

    def identity(self) -> Mapping[str, str]:
        """Who the drive says it is."""
        ...

    def findings(self) -> list[Finding]:
        """Read back the settings that matter for safety."""
        ...

    def check_setpoint(self, speed_rpm: float, ramp_rpm_per_s: float) -> str:
        """Why the drive cannot take this set-point; empty when it can."""
        ...

    def cycle(self, wish: Wish) -> Report:
        """Send the wish, read the state."""
        ...

    def trip(self) -> Trip:
        """Read which trip it is."""
        ...

    def status_exchange(self) -> None:
        """One exchange of the kind that a cycle makes, without effect."""
        ...

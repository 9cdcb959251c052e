"""What a device can tell about itself at bring-up: values, round-trip times, unsafe settings.

Job: the optional interface between drivers and `rigctl devices test|monitor`, and its words. Not its job:
asking (`rigctl.app.devices`), how a person reads it, and anything while a program runs.

How a driver implements it
--------------------------
Add one method to the class of the device; nothing is inherited::

    def diagnose(self, round_trips: int) -> Diagnosis:
        times = measured(self._read_status, round_trips)           # [] for round_trips = 0
        warnings = []
        if self._comm_loss_action == 0:
            warnings.append(Finding(
                "the drive keeps running when the link is lost (30.18 COMM FAULT FUNC = 0).",
                remedy="Set 30.18 to 1 (fault) and 30.19 to 0.5 s.", unsafe=True))
        return Diagnosis(
            values=(Reading("speed", self._speed_rpm, "1/min", age_s=self._age_s(), rate_hz=20.0), ...),
            round_trip_s=times, warnings=tuple(warnings), identity=self.identity())

Rules:

* it is called after `open` and before `close`, from one thread; it never enables, moves, pressurises or
  closes a relay, and never writes a parameter;
* `round_trips` > 0 (`devices test`): make so many request-answer exchanges of the kind that a run makes, and
  read back every setting that matters for safety (time-out and action on loss of communication, heartbeat
  consumer and its reaction, scaling, ranges). A device that only talks by itself gives no times;
* `round_trips` = 0 (`devices monitor`, several times a second): newest values only, quickly, no parameter
  traffic;
* a value that is not valid is `Reading(…, value=None, fault="sensor open circuit (2.1 mA)")`, never a
  number;
* a setting that lets something move or stay under pressure when the link breaks is a `Finding` with
  `unsafe=True`: the test of the device then *fails*. Everything else that deserves a look is a warning only;
* a device that does not answer raises `DeviceError`, as everywhere.

A device without `diagnose` is tested too: it is opened, asked for its `identity`, and closed.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable


@dataclass(frozen=True, slots=True)
class Reading:
    """One value of a device.

    Attributes
    ----------
    name : str
        What it is, e.g. "speed", "status word".
    value : float, int, str, bool or None
        None: not valid; `fault` says why.
    unit : str
        Unit of the value, "" for states.
    age_s : float or None
        Seconds since it was received, None where it was read just now.
    rate_hz : float or None
        How often it arrives by itself or is polled, as measured; None where it is read on demand.
    fault : str
        Why it is not valid, or what is wrong with it.
    """

    name: str
    value: float | int | str | bool | None
    unit: str = ""
    age_s: float | None = None
    rate_hz: float | None = None
    fault: str = ""


@dataclass(frozen=True, slots=True)
class Finding:
    """A setting or state that a person should know of.

    Attributes
    ----------
    problem : str
        One sentence, with parameter or object number and value.
    remedy : str
        What to set, and where.
    unsafe : bool
        True when it lets the rig move or hold pressure after a loss of communication.
    """

    problem: str
    remedy: str = ""
    unsafe: bool = False

    def __str__(self) -> str:
        return f"{self.problem} {self.remedy}".rstrip()


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """All that a device says of itself at one time.

    Attributes
    ----------
    values : tuple of Reading
    round_trip_s : sequence of float
        Times of request-answer exchanges, s; empty where the device is not asked.
    warnings : tuple of Finding
    identity : mapping of str to str
        As `Device.identity`.
    """

    values: tuple[Reading, ...] = ()
    round_trip_s: Sequence[float] = ()
    warnings: tuple[Finding, ...] = ()
    identity: Mapping[str, str] = field(default_factory=dict[str, str])


@runtime_checkable
class Diagnosable(Protocol):
    """A device that can be diagnosed; optional, see the module."""

    def diagnose(self, round_trips: int) -> Diagnosis:
        """Diagnose an open device without moving anything. Raises `DeviceError` when it does not answer."""
        ...


@dataclass(frozen=True, slots=True)
class Timing:
    """Statistics of round trips, s."""

    count: int
    min_s: float
    median_s: float
    p99_s: float
    max_s: float


def measured(exchange: Callable[[], object], count: int) -> list[float]:
    """Times of `count` exchanges, s; what `exchange` raises is not held back."""
    times: list[float] = []
    for _ in range(count):
        start = time.perf_counter()
        exchange()
        times.append(time.perf_counter() - start)
    return times


def timing(times_s: Sequence[float]) -> Timing | None:
    """Statistics of measured times (nearest rank); None where nothing was measured."""
    if not times_s:
        return None
    ordered = sorted(times_s)

    def rank(share: float) -> float:
        return ordered[max(0, math.ceil(share * len(ordered)) - 1)]

    return Timing(len(ordered), ordered[0], rank(0.5), rank(0.99), ordered[-1])

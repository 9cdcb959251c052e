"""The watchdog's own view of the rig: what it needs from a safety channel, and nothing more.

Job: name the samples and calls between the watchdog and the safety hardware (a CAN safety I/O node, or the
simulated rig's safety bus). Standard library only. Not its job: limits and decisions (`rigctl.safety`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, slots=True)
class SafetySample:
    """What the watchdog saw of one block, by its own reading of the sensors.

    Attributes
    ----------
    k : int
        Number of the block, rising by one.
    t_s, dt_s : float
        Rig time at the end of the block and its length.
    pressure_bar, speed_rpm, torque_nm, temperature_degc : tuple of (float or None)
        Readings at 100 Hz, oldest first. None marks a reading that is not valid.
    relay_closed : bool
        Read-back of the safety relay.
    drive_enabled : bool
        Read-back of the torque enable.
    estop_ok, doors_ok : bool
        State of the hard-wired chain.
    channel_fault : str
        What is wrong with the channel itself (silent bus or node, restart, second sender); empty when well.
        What is not known then reads False.
    """

    k: int
    t_s: float
    dt_s: float
    pressure_bar: tuple[float | None, ...]
    speed_rpm: tuple[float | None, ...]
    torque_nm: tuple[float | None, ...]
    temperature_degc: tuple[float | None, ...]
    relay_closed: bool
    drive_enabled: bool
    estop_ok: bool
    doors_ok: bool
    channel_fault: str = ""


class SafetyLink(Protocol):
    """Safety channel as the watchdog uses it. Built with one argument: a dict of settings from the rig file.

    After `open_relay` the torque enable is off and the vent valve open, whatever anybody else commands.
    The relay opens by itself when no `edge` arrives in time, and when this link closes.
    """

    def connect(self, timeout_s: float) -> None:
        """Open the channel; raises `DeviceError` when nobody answers."""
        ...

    def fileno(self) -> int:
        """Descriptor for poll: readable when a sample is there or the channel is gone. Nothing is held back
        in a buffer: while it is not readable, `recv` has nothing."""
        ...

    def recv(self, timeout_s: float) -> SafetySample | None:
        """Next sample, None after `timeout_s`; raises `LinkClosed` when the channel is gone."""
        ...

    def edge(self, k: int) -> None:
        """Renew the relay for one more block: sample `k` was seen and is good."""
        ...

    def hold(self, k: int) -> None:
        """Answer sample `k` without renewing the relay (locked: it is open anyway)."""
        ...

    def close_relay(self, k: int) -> None:
        """Answer sample `k` by closing the relay (arming). Counts as an edge."""
        ...

    def open_relay(self, k: int, reason: str) -> None:
        """Open the relay at once. `k` is the last sample seen; counts as its answer."""
        ...

    def close(self) -> None:
        """Give up the channel; the relay opens."""
        ...

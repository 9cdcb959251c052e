"""What the devices of one rig share while it runs: the lease on set-points, and the board of their states.

Job: `Lease` (is the control loop still asking for blocks?) and `StatusBoard` (what devices last said of
themselves). Both are safe between threads. Not its job: acting on either.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Mapping
from typing import Any


class Lease:
    """Renewed by the control loop with every block; set-points hold only while it is in force.

    A driver's thread that finds it expired stops renewing what its device was told, so that the device's own
    time-out brings it to the safe state.
    """

    def __init__(self) -> None:
        self._renewed_at: float | None = None

    def renew(self) -> None:
        """The control loop has asked for a block."""
        self._renewed_at = time.monotonic()

    def age_s(self) -> float:
        """Seconds since the last renewal; infinite before the first."""
        renewed_at = self._renewed_at
        return float("inf") if renewed_at is None else time.monotonic() - renewed_at

    def in_force(self, limit_s: float) -> bool:
        """Whether it was renewed within `limit_s`."""
        return self.age_s() <= limit_s


class StatusBoard:
    """Newest state of all devices, by key: "relay", "estop", "doors", "enabled", "faults", …"""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._values: dict[str, Any] = {}
        self._faults: dict[str, str] = {}

    def set(self, **values: Any) -> None:
        """Publish values; they stay until they are published again."""
        with self._lock:
            self._values.update(values)

    def fault(self, device: str, problem: str) -> None:
        """Publish a device's fault; an empty text takes it back."""
        with self._lock:
            if problem:
                self._faults[device] = problem
            else:
                self._faults.pop(device, None)

    def snapshot(self) -> Mapping[str, Any]:
        """A copy of all values; with "faults" (device -> problem) where there are any."""
        with self._lock:
            copy = dict(self._values)
            if self._faults:
                copy["faults"] = dict(self._faults)
        return copy

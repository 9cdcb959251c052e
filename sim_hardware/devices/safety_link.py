"""The watchdog's connection to the simulated rig's safety bus (`rigctl.core.safety_link.SafetyLink`).

Standard library only: it runs in the watchdog process. Not its job: limits.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rigctl.core.errors import LinkClosed
from rigctl.core.safety_link import SafetySample
from rigctl.core.wire import Link, connect


class SimulatedSafetyLink:
    """Settings: ``socket``, the path of the rig server's socket."""

    def __init__(self, settings: Mapping[str, Any]) -> None:
        self._path = Path(settings["socket"])
        self._link: Link | None = None

    def connect(self, timeout_s: float) -> None:
        """See `SafetyLink.connect`."""
        self._link = connect(self._path, timeout_s, "safety bus")
        self._link.send({"m": "hello", "role": "safety"})

    def fileno(self) -> int:
        """Descriptor for select and poll."""
        return self._open().fileno()

    def recv(self, timeout_s: float) -> SafetySample | None:
        """See `SafetyLink.recv`."""
        message = self._open().recv(timeout_s)
        if message is None:
            return None
        return SafetySample(
            message["k"],
            message["t"],
            message["dt"],
            tuple(message["p"]),
            tuple(message["n"]),
            tuple(message["M"]),
            tuple(message["T"]),
            message["relay"],
            message["enabled"],
            message["estop"],
            message["doors"],
        )

    def edge(self, k: int) -> None:
        """See `SafetyLink.edge`."""
        self._open().send({"m": "edge", "k": k})

    def hold(self, k: int) -> None:
        """See `SafetyLink.hold`."""
        self._open().send({"m": "hold", "k": k})

    def close_relay(self, k: int) -> None:
        """See `SafetyLink.close_relay`."""
        self._open().send({"m": "close", "k": k})

    def open_relay(self, k: int, reason: str) -> None:
        """See `SafetyLink.open_relay`."""
        self._open().send({"m": "open", "k": k, "reason": reason})

    def close(self) -> None:
        """See `SafetyLink.close`."""
        if self._link is not None:
            self._link.close()
            self._link = None

    def _open(self) -> Link:
        if self._link is None:
            raise LinkClosed("the safety bus is not connected", place=str(self._path))
        return self._link

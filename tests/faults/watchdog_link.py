"""Safety channel of the fake rig, loaded by name in the watchdog process. Standard library only."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rigctl.core.safety_link import SafetySample
from rigctl.core.wire import Link, connect


class FakeSafetyLink:
    """Settings: ``socket``."""

    def __init__(self, settings: Mapping[str, Any]) -> None:
        self._path = Path(settings["socket"])
        self._link: Link | None = None

    @property
    def link(self) -> Link:
        assert self._link is not None
        return self._link

    def connect(self, timeout_s: float) -> None:
        self._link = connect(self._path, timeout_s, "fake rig")

    def fileno(self) -> int:
        return self.link.fileno()

    def recv(self, timeout_s: float) -> SafetySample | None:
        message = self.link.recv(timeout_s)
        if message is None:
            return None
        for name in ("pressure_bar", "speed_rpm", "torque_nm", "temperature_degc"):
            message[name] = tuple(message[name])
        return SafetySample(**message)

    def edge(self, k: int) -> None:
        self.link.send({"m": "edge", "k": k})

    def hold(self, k: int) -> None:
        self.link.send({"m": "hold", "k": k})

    def close_relay(self, k: int) -> None:
        self.link.send({"m": "close", "k": k})

    def open_relay(self, k: int, reason: str) -> None:
        self.link.send({"m": "open", "k": k, "reason": reason})

    def close(self) -> None:
        if self._link is not None:
            self._link.close()

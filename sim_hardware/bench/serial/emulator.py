"""What a port asks of an emulated device. Not its job: any device."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol


class Emulator(Protocol):
    """An emulated device on a serial line. All calls come under the port's lock; times are
    `time.monotonic`."""

    def receive(self, data: bytes, first_s: float, last_s: float) -> None:
        """Bytes have arrived; the first of them at `first_s`, the last at `last_s`."""
        ...

    def advance(self, now_s: float) -> bytes:
        """Let time pass; returns what the device sends now, one message at most."""
        ...

    def due_s(self, now_s: float) -> float:
        """When `advance` wants to be called next."""
        ...

    def command(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Something happens to the device (a trip, its power) or its state is asked for; see the device."""
        ...

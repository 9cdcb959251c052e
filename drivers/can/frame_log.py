"""Wire log of a bus in python-can's own formats: candump's .log, Vector's .asc and .blf.

Job: write received and sent frames in the order in which they passed, from several threads. Not its job:
logs of serial lines (`rigctl.hal.wirelog`).
"""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING

from rigctl.core.errors import DeviceError

if TYPE_CHECKING:
    import can


class FrameLog:
    """One file; closed by `close`.

    Parameters
    ----------
    path : Path
        Its suffix chooses the format.
    channel : str
        Name of the bus in the log.

    Raises
    ------
    DeviceError
        The file cannot be written.
    """

    def __init__(self, path: Path, channel: str) -> None:
        import can

        self.path = path
        self._channel: str | int = channel if path.suffix == ".log" else 0  # Vector's formats number them
        self._lock = threading.Lock()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._writer = can.Logger(str(path), channel=self._channel)
        except OSError as error:
            raise DeviceError(
                f"the wire log cannot be written: {error.strerror}.", place=str(path),
                remedy="Free space or name another folder.",
            ) from error  # fmt: skip
        self._closed = False

    def write(self, message: can.Message, *, sent: bool) -> None:
        """Append a frame; a sent one gets the present time."""
        if sent:
            message.timestamp = time.time()
            message.is_rx = False
        message.channel = self._channel
        with self._lock:
            if not self._closed:
                self._writer.on_message_received(message)

    def close(self) -> None:
        """Flush and close."""
        with self._lock:
            if not self._closed:
                self._closed = True
                self._writer.stop()

"""Wire log of serial ports: every transfer as one line of hex with time and direction.

Job: the file that says what really went over a wire, for drivers of serial devices. Size is limited: when
the file is full it becomes ``NAME.1`` and so on, and the oldest goes. A log that cannot be written (full
disk) ends itself with one message and never disturbs the device. Not its job: CAN (python-can's own writers,
candump and ASC, in `drivers.can`), understanding what was sent.

::

    # rigctl serial wire log 1: drive on /dev/ttyUSB0; UTC, seconds since the line before, > to, < from device
    2026-11-23T09:14:07.123456Z  0.000000 > 01 03 00 03 00 01 74 0a  |....t.|
    2026-11-23T09:14:07.125718Z  0.002262 < 01 03 02 02 33 f9 31     |....3.1|

A driver asks for its log once and tells it every transfer::

    self._log = wire_log(context, "drive", port)
    self._log.sent(request)
    self._log.received(answer)          # or: pymodbus' client(..., trace_packet=self._log.trace)
"""

from __future__ import annotations

import contextlib
import io
import re
import sys
import threading
import time
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

from rigctl.hal.devices import RigContext

DEFAULT_LIMIT_BYTES = 16 * 1024 * 1024
DEFAULT_KEEP = 4
VERSION = 1

_LINE = re.compile(
    r"(?P<time>\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{6}Z) +(?P<since>\d+\.\d{6}) (?P<way>[<>]) "
    r"(?P<hex>[0-9a-f]{2}(?: [0-9a-f]{2})*)  \|"
)


class WireLog:
    """Log of one port; safe between threads.

    Parameters
    ----------
    path : Path or None
        The file; None: nothing is logged.
    title : str
        Device and port, for the first line.
    limit_bytes, keep : int
        A file grows to the limit; so many older ones are kept.
    """

    def __init__(
        self,
        path: Path | None,
        title: str = "",
        *,
        limit_bytes: int = DEFAULT_LIMIT_BYTES,
        keep: int = DEFAULT_KEEP,
    ) -> None:
        self._path = path
        self._title = title
        self._limit_bytes = limit_bytes
        self._keep = keep
        self._lock = threading.Lock()
        self._file: io.FileIO | None = None
        self._size = 0
        self._last: float | None = None
        if path is not None:
            with self._lock:
                self._guarded(self._start)

    @property
    def active(self) -> bool:
        """Whether transfers are being written."""
        return self._file is not None

    def sent(self, data: bytes) -> None:
        """Bytes went to the device."""
        self._transfer(">", data)

    def received(self, data: bytes) -> None:
        """Bytes came from the device."""
        self._transfer("<", data)

    def note(self, text: str) -> None:
        """A remark of the driver: time-outs, reconnects."""
        self._write(f"{_utc()}  # {' '.join(text.split())}\n")

    def trace(self, sending: bool, data: bytes) -> bytes:
        """The same in the form of pymodbus' `trace_packet`."""
        self._transfer(">" if sending else "<", data)
        return data

    def close(self) -> None:
        """End the log."""
        with self._lock:
            if self._file is not None:
                self._guarded(self._file.close)
                self._file = None

    def _transfer(self, way: str, data: bytes) -> None:
        if self._file is None or not data:
            return
        now = time.monotonic()
        since = 0.0 if self._last is None else now - self._last
        self._last = now
        shown = "".join(chr(byte) if 32 <= byte < 127 else "." for byte in data)
        self._write(f"{_utc()} {since:9.6f} {way} {data.hex(' ')}  |{shown}|\n")

    def _write(self, line: str) -> None:
        with self._lock:
            if self._file is not None:
                self._guarded(lambda: self._append(line))

    def _append(self, line: str) -> None:
        assert self._file is not None
        data = line.encode()
        if self._size + len(data) > self._limit_bytes:
            self._file.close()
            self._rotate()
            self._start()
        self._size += self._file.write(data)

    def _start(self) -> None:
        assert self._path is not None
        self._path.parent.mkdir(parents=True, exist_ok=True)
        # without a buffer, so that the last transfer before a crash is in the file
        self._file = self._path.open("ab", buffering=0)
        self._size = self._path.stat().st_size
        if self._size == 0:
            head = (
                f"# rigctl serial wire log {VERSION}: {self._title}; UTC, seconds since the line before, "
                "> to, < from device\n"
            )
            self._size += self._file.write(head.encode())

    def _rotate(self) -> None:
        assert self._path is not None
        for number in range(self._keep, 0, -1):
            older = self._path.with_name(f"{self._path.name}.{number}")
            newer = self._path if number == 1 else self._path.with_name(f"{self._path.name}.{number - 1}")
            if newer.exists():
                newer.replace(older)
        if self._keep == 0:
            self._path.unlink(missing_ok=True)

    def _guarded(self, action: Callable[[], object]) -> None:
        """The log must never disturb the device: the first failure ends it, with one message."""
        try:
            action()
        except (OSError, ValueError) as error:
            file, self._file = self._file, None
            if file is not None:
                with contextlib.suppress(OSError):
                    file.close()
            print(f"rigctl: wire log {self._path} ends: {error}.", file=sys.stderr)


def wire_log(context: RigContext, device: str, port: str) -> WireLog:
    """Log of a device's port in `context.wire_log_dir`; one that writes nothing where that is None."""
    folder = context.wire_log_dir
    if folder is None:
        return WireLog(None)
    name = re.sub(r"[^A-Za-z0-9]+", "-", f"{device}-{port}").strip("-")
    return WireLog(folder / f"{name}.log", f"{device} on {port}")


def read_wire_log(path: Path) -> list[tuple[datetime, str, bytes]]:
    """Transfers of a log: (UTC, ">" or "<", bytes); remarks are left out."""
    transfers: list[tuple[datetime, str, bytes]] = []
    for line in path.read_text(encoding="utf-8").splitlines():
        match = _LINE.match(line)
        if match:
            when = datetime.fromisoformat(match["time"])
            transfers.append((when, match["way"], bytes.fromhex(match["hex"])))
    return transfers


def _utc() -> str:
    return datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%S.%fZ")

"""A serial port of the bench: a pty with a stable name or a TCP port, the wire's speed and faults, and a
device at it.

Job: `SerialPort` runs the thread that moves bytes between a host and an `Emulator`. The name is a symbolic
link in the bench's folder to a pty that changes when the plug is pulled and put back. Not its job: protocols,
what the faults do (`faults`).

A host that opens the pty at another speed than the device's is heard as noise: its bytes are thrown away.
"""

from __future__ import annotations

import errno
import heapq
import itertools
import os
import select
import threading
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from sim_hardware.bench.serial.emulator import Emulator
from sim_hardware.bench.serial.faults import FaultSeam
from sim_hardware.bench.serial.line import Line, Pacer, Piece
from sim_hardware.bench.serial.transports import PtyTransport, TcpTransport, Transport

#: An idle line of this many characters ends a message.
MESSAGE_GAP_CHARACTERS = 3.5
LONGEST_SLEEP_S = 0.5
#: How often a port that no host has open is looked at.
ABSENT_HOST_S = 0.01


class _Queue:
    """Pieces in order of their arrival."""

    def __init__(self) -> None:
        self._heap: list[tuple[float, int, Piece]] = []
        self._order = itertools.count()

    def push(self, pieces: list[Piece]) -> None:
        for piece in pieces:
            heapq.heappush(self._heap, (piece.due_s, next(self._order), piece))

    def pop_due(self, now_s: float) -> list[Piece]:
        due: list[Piece] = []
        while self._heap and self._heap[0][0] <= now_s:
            due.append(heapq.heappop(self._heap)[2])
        return due

    def next_s(self) -> float:
        return self._heap[0][0] if self._heap else float("inf")

    def clear(self) -> None:
        self._heap.clear()


class SerialPort:
    """One port with one emulated device.

    Parameters
    ----------
    name : str
        Name of the port: the link in `folder`.
    emulator : Emulator
    line : Line
        Speed and format of the device.
    folder : Path
        Where the link goes.
    tcp : int or None
        A TCP port on 127.0.0.1 instead of a pty (0: any free one); for ``socket://127.0.0.1:PORT``.
    seed : int
        Seed of the faults.
    """

    def __init__(
        self,
        name: str,
        emulator: Emulator,
        line: Line,
        folder: Path,
        *,
        tcp: int | None = None,
        seed: int = 0,
    ) -> None:
        self.name = name
        self.emulator = emulator
        self.line = line
        self.seam = FaultSeam(seed)
        self._transport: Transport = PtyTransport(folder / name) if tcp is None else TcpTransport(tcp)
        self._pacers = {"to_device": Pacer(line.character_s), "to_host": Pacer(line.character_s)}
        self._inbound, self._outbound = _Queue(), _Queue()
        self._lock = threading.RLock()
        self._stop = threading.Event()
        self._wake_read, self._wake_write = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
        self._thread = threading.Thread(target=self._run, name=f"bench-{name}", daemon=True)
        self._replug_s = float("inf")
        self._last_in_s = float("-inf")
        self._turned = True
        self._failure: BaseException | None = None
        self.bytes_in = self.bytes_out = self.bytes_at_wrong_speed = 0

    @property
    def address(self) -> str:
        """What a host opens: a path, or a ``socket://`` address."""
        return self._transport.address

    def start(self) -> None:
        """Make the port and begin to serve it."""
        self._transport.plug()
        self._thread.start()

    def close(self) -> None:
        """End the thread and take the port away."""
        if self._thread.is_alive():
            self._stop.set()
            self._wake()
            self._thread.join(timeout=5)
        self._transport.unplug()
        for descriptor in (self._wake_read, self._wake_write):
            try:
                os.close(descriptor)
            except OSError:
                pass

    def __enter__(self) -> SerialPort:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def command(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """Carry out one command, given and answered as JSON can carry it.

        ``{"do": "fault", ...fields of Fault}`` answers ``{"id": n}``; ``{"do": "clear"}`` or with ``"id"``;
        ``{"do": "faults"}``; ``{"do": "unplug", "for_s": 2.0}`` (for ever without `for_s`); ``{"do":
        "plug"}``; ``{"do": "counts"}``; everything else goes to the device, for example ``{"do": "trip",
        "code": 8976}``.

        Raises
        ------
        ValueError
            Not such a command; pydantic's ValidationError is one.
        """
        arguments = dict(request)
        action = arguments.pop("do", None)
        own = {
            "fault": self._add_fault,
            "clear": self._clear_faults,
            "faults": self._list_faults,
            "counts": self._counts,
            "unplug": self._unplug,
            "plug": self._plug,
        }
        with self._lock:
            if action in own:
                return own[action](arguments, time.monotonic())
            return self.emulator.command(request)

    def _add_fault(self, arguments: dict[str, Any], now_s: float) -> dict[str, Any]:
        return {"id": self.seam.add(arguments, now_s)}

    def _clear_faults(self, arguments: dict[str, Any], now_s: float) -> dict[str, Any]:
        self.seam.clear(arguments.get("id"))
        return {}

    def _list_faults(self, arguments: dict[str, Any], now_s: float) -> dict[str, Any]:
        return {"faults": self.seam.describe(now_s)}

    def _counts(self, arguments: dict[str, Any], now_s: float) -> dict[str, Any]:
        return {
            "bytes_in": self.bytes_in,
            "bytes_out": self.bytes_out,
            "bytes_at_wrong_speed": self.bytes_at_wrong_speed,
            "struck": dict(self.seam.counts),
        }

    def _unplug(self, arguments: dict[str, Any], now_s: float) -> dict[str, Any]:
        self._replug_s = now_s + float(arguments.get("for_s", "inf"))
        self._transport.unplug()
        self._inbound.clear()
        self._outbound.clear()
        self._wake()
        return {}

    def _plug(self, arguments: dict[str, Any], now_s: float) -> dict[str, Any]:
        self._replug_s = float("inf")
        self._transport.plug()
        self._wake()
        return {"address": self.address}

    # -- the thread ---------------------------------------------------------------------------------

    def _run(self) -> None:
        try:
            while not self._stop.is_set():
                with self._lock:
                    next_s = self._work(time.monotonic())
                    descriptors = [self._wake_read, *self._transport.descriptors()]
                longest_s = LONGEST_SLEEP_S if len(descriptors) > 1 else ABSENT_HOST_S
                pause_s = min(max(next_s - time.monotonic(), 0.0), longest_s)
                try:
                    ready, _, _ = select.select(descriptors, [], [], pause_s)
                except OSError as error:
                    if error.errno != errno.EBADF:
                        raise
                    continue  # the plug was pulled in between
                if self._wake_read in ready:
                    os.read(self._wake_read, 4096)
        except BaseException as error:
            # A device that has crashed is a device without a plug: the host notices at once, the bench by
            # `failure`.
            self._failure = error
            self._transport.unplug()
            raise

    @property
    def failure(self) -> BaseException | None:
        """Why the thread has ended, if it has."""
        return self._failure

    def _work(self, now_s: float) -> float:
        """Everything that is due; returns when the next thing is."""
        if now_s >= self._replug_s:
            self._replug_s = float("inf")
            self._transport.plug()
        data = self._transport.read()
        if data:
            self._take(data, now_s)
        for piece in self._inbound.pop_due(now_s):
            self.emulator.receive(piece.data, piece.first_s, piece.due_s)
        reply = self.emulator.advance(now_s)
        if reply:
            self._turned = True
            characters = self.seam.apply(reply, "to_host", begins=True, now_s=now_s)
            self._outbound.push(self._pacers["to_host"].schedule(characters, now_s))
        for piece in self._outbound.pop_due(now_s):
            self.bytes_out += len(piece.data)
            self._transport.write(piece.data)
        return min(
            self._inbound.next_s(), self._outbound.next_s(), self.emulator.due_s(now_s), self._replug_s
        )

    def _take(self, data: bytes, now_s: float) -> None:
        """Bytes of the host begin their way to the device."""
        if not self._transport.speed_is(self.line.baud):
            self.bytes_at_wrong_speed += len(data)
            return
        self.bytes_in += len(data)
        idle_s = now_s - self._last_in_s
        begins = self._turned or idle_s > MESSAGE_GAP_CHARACTERS * self.line.character_s
        characters = self.seam.apply(data, "to_device", begins=begins, now_s=now_s)
        self._inbound.push(self._pacers["to_device"].schedule(characters, now_s))
        self._turned = False
        self._last_in_s = now_s + len(data) * self.line.character_s

    def _wake(self) -> None:
        try:
            os.write(self._wake_write, b"x")
        except OSError:
            pass

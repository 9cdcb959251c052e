"""Frames of a python-can bus, taken in batches and with little work for each of them.

Job: `frame_reader` gives a `FrameReader` for an open bus: wait for frames, hand out all that have come, each
with its time of arrival on the monotonic clock. Not its job: threads, dispatch, what frames mean
(`drivers.can.session`, `drivers.safety_io.watchdog_link`).

A bus with 1 kHz PDOs carries some thousand frames a second. Waking up for each of them, and building
python-can's `Message` for it, costs a fifth of a processor in every process that listens. Where the kernel
notes the time of arrival (`FrameReader.stamped`: socketcan, udp_multicast) a listener may therefore sleep for
some milliseconds and take what has come meanwhile: nothing is lost and no time stamp moves. The kernel's
queue is made long enough for a listener that is late, and says when it was not (`FrameReader.overrun`).

Frames of udp_multicast are taken from the socket itself: each datagram is one frame in msgpack, as
python-can's manual describes it. All other interfaces are read through `can.Bus.recv`.
"""

from __future__ import annotations

import os
import select
import socket
import struct
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, NamedTuple, Protocol

from rigctl.core.units import NS_PER_S

if TYPE_CHECKING:
    import can

EXTENDED: Final = 1
REMOTE: Final = 2
ERROR: Final = 4
FD: Final = 8

BATCH: Final = 512
"""Frames handed out by one call at most, so that a flood cannot hold up who called."""
_MAX_AGE_NS: Final = NS_PER_S  # time stamps older than this, or of the future, are of another clock
_BATCH_NS: Final = 50_000_000  # frames may come while a batch is taken
_TORN_NS: Final = 20_000
_QUEUE_BYTES: Final = 4 << 20  # some seconds of a full bus
_MAX_STANDARD_ID, _MAX_EXTENDED_ID = 0x7FF, 0x1FFF_FFFF
_MAX_DATA, _MAX_FD_DATA = 8, 64

# Linux: asm-generic/socket.h; Python's socket module does not have them in all versions
_SO_RCVBUFFORCE: Final = 33
_SO_TIMESTAMPNS: Final = 35
_SO_RXQ_OVFL: Final = 40
_TIMESPEC: Final = struct.Struct("@ll")
_DROPPED: Final = struct.Struct("@I")
_DATAGRAM: Final = 1024


class Frame(NamedTuple):
    """One frame as it came from the bus.

    Attributes
    ----------
    cob_id : int
        Identifier; of error frames: the class of the error.
    data : bytes
        Of remote frames: as many zeros as are asked for.
    t_ns : int
        Arrival, on the clock of `time.monotonic_ns()`.
    flags : int
        `EXTENDED`, `REMOTE`, `ERROR`, `FD`; 0 for a plain data frame.
    """

    cob_id: int
    data: bytes
    t_ns: int
    flags: int = 0

    def message(self) -> can.Message:
        """The frame as python-can's loggers take it, with the time of the day."""
        import can

        age_s = (time.monotonic_ns() - self.t_ns) * 1e-9
        return can.Message(
            timestamp=time.time() - age_s,
            arbitration_id=self.cob_id,
            is_extended_id=bool(self.flags & EXTENDED),
            is_remote_frame=bool(self.flags & REMOTE),
            is_error_frame=bool(self.flags & ERROR),
            is_fd=bool(self.flags & FD),
            data=None if self.flags & REMOTE else self.data,
            dlc=len(self.data),
        )


class FrameReader(Protocol):
    """Reads an open bus.

    Attributes
    ----------
    stamped : bool
        The kernel notes the time of arrival: frames may wait for their reader.
    overrun : int
        Frames that the kernel has dropped because the reader was late, as far as it says so.
    """

    stamped: bool
    overrun: int

    def take(self, timeout_s: float, on_frame: Callable[[Frame], None]) -> int:
        """Wait for a frame, then hand out it and all that have come, up to `BATCH`.

        Parameters
        ----------
        timeout_s : float
            For the first one.
        on_frame : callable

        Returns
        -------
        int
            Frames that were taken from the bus.

        Raises
        ------
        can.CanError, OSError
            The interface gave an error in place of a frame. Frames before it have been handed out.
        """
        ...

    def close(self) -> None:
        """Give back what the reader holds; the bus stays open."""
        ...


def frame_reader(bus: can.BusABC, interface: str) -> FrameReader:
    """The reader for a bus of this interface; `close` it before the bus."""
    if interface == "udp_multicast":
        return MulticastReader(bus)
    return BusReader(bus, stamped=interface == "socketcan")


class BusReader:
    """A `FrameReader` through `can.Bus.recv`.

    Parameters
    ----------
    bus : can.BusABC
    stamped : bool
    """

    overrun = 0

    def __init__(self, bus: can.BusABC, *, stamped: bool) -> None:
        self._bus = bus
        self.stamped = stamped
        if stamped:
            with socket.socket(fileno=os.dup(bus.fileno())) as own:
                _lengthen_queue(own)

    def take(self, timeout_s: float, on_frame: Callable[[Frame], None]) -> int:
        """See `FrameReader.take`."""
        for taken in range(BATCH):
            message = self._bus.recv(0.0 if taken else timeout_s)
            if message is None:
                return taken
            on_frame(frame_of(message))
        return BATCH

    def close(self) -> None:
        """See `FrameReader.close`."""


class MulticastReader:
    """A `FrameReader` of python-can's udp_multicast, at the socket.

    Parameters
    ----------
    bus : can.BusABC
    """

    stamped = True

    def __init__(self, bus: can.BusABC) -> None:
        import can
        import msgpack

        self._fd_too = bus.protocol is can.CanProtocol.CAN_FD
        self._malformed = can.CanOperationError
        self._unpack: Callable[..., Any] = msgpack.unpackb
        self._socket = socket.socket(fileno=os.dup(bus.fileno()))
        self._socket.setblocking(False)
        self._socket.setsockopt(socket.SOL_SOCKET, _SO_TIMESTAMPNS, 1)
        self._socket.setsockopt(socket.SOL_SOCKET, _SO_RXQ_OVFL, 1)
        _lengthen_queue(self._socket)
        self._poll = select.poll()
        self._poll.register(self._socket, select.POLLIN)
        self._room = socket.CMSG_SPACE(_TIMESPEC.size) + socket.CMSG_SPACE(_DROPPED.size)
        self.overrun = 0

    def take(self, timeout_s: float, on_frame: Callable[[Frame], None]) -> int:
        """See `FrameReader.take`."""
        if not self._poll.poll(1000.0 * timeout_s):
            return 0
        receive, room = self._socket.recvmsg, self._room
        now_ns, ahead_ns = _clocks()
        for taken in range(BATCH):
            try:
                datagram, notes, _, _ = receive(_DATAGRAM, room)
            except BlockingIOError:
                return taken
            arrived_ns = now_ns
            for _, kind, note in notes:
                if kind == _SO_TIMESTAMPNS:
                    seconds, nanoseconds = _TIMESPEC.unpack(note)
                    arrived_ns = seconds * NS_PER_S + nanoseconds - ahead_ns
                elif kind == _SO_RXQ_OVFL:
                    (self.overrun,) = _DROPPED.unpack(note)
            if not now_ns - _MAX_AGE_NS < arrived_ns < now_ns + _BATCH_NS:
                arrived_ns = time.monotonic_ns()
            frame = self._decode(datagram, arrived_ns)
            if frame is not None:
                on_frame(frame)
        return BATCH

    def close(self) -> None:
        """See `FrameReader.close`."""
        self._poll.unregister(self._socket)
        self._socket.close()

    def _decode(self, datagram: bytes, t_ns: int) -> Frame | None:
        """The frame in a datagram; None for a kind that this bus does not carry."""
        try:
            fields = self._unpack(datagram, raw=False)
            cob_id, data, dlc = fields["arbitration_id"], fields["data"], fields["dlc"]
            extended, remote, fd = fields["is_extended_id"], fields["is_remote_frame"], fields["is_fd"]
            error = fields["is_error_frame"]
            sound = (
                0 <= cob_id <= (_MAX_EXTENDED_ID if extended or error else _MAX_STANDARD_ID)
                and len(data) <= (_MAX_FD_DATA if fd else _MAX_DATA)
                and (dlc == len(data) or remote)
            )
        except Exception as error:  # msgpack's own errors, a missing field, a field of another type
            raise self._malformed(f"no CAN frame in a datagram of {len(datagram)} bytes") from error
        if not sound or type(cob_id) is not int or type(data) is not bytes:
            raise self._malformed(f"no valid CAN frame: identifier {cob_id!r}, {len(data)} bytes")
        if fd and not self._fd_too:
            return None
        if not (extended or remote or error or fd):
            return Frame(cob_id, data, t_ns)
        return Frame(cob_id, bytes(dlc) if remote else data, t_ns, _flags(extended, remote, error, fd))


def frame_of(message: can.Message) -> Frame:
    """A message of python-can, its time stamp moved to the monotonic clock where it is of this machine's."""
    now_ns, ahead_ns = _clocks()
    t_ns = round(message.timestamp * NS_PER_S) - ahead_ns
    if not now_ns - _MAX_AGE_NS < t_ns <= now_ns:
        t_ns = now_ns
    flags = _flags(message.is_extended_id, message.is_remote_frame, message.is_error_frame, message.is_fd)
    return Frame(
        message.arbitration_id, bytes(message.dlc if message.is_remote_frame else message.data), t_ns, flags
    )


def _flags(extended: bool, remote: bool, error: bool, fd: bool) -> int:
    return extended * EXTENDED | remote * REMOTE | error * ERROR | fd * FD


def _clocks() -> tuple[int, int]:
    """(monotonic time, how far the time of the day is ahead of it), ns; not torn apart by another thread."""
    before_ns, day_ns, now_ns = time.monotonic_ns(), time.time_ns(), time.monotonic_ns()
    if now_ns - before_ns > _TORN_NS:
        day_ns, now_ns = time.time_ns(), time.monotonic_ns()
    return now_ns, day_ns - now_ns


def _lengthen_queue(own: socket.socket) -> None:
    """Room for frames of a late reader: as much as wanted with the right to, else what the system allows."""
    try:
        own.setsockopt(socket.SOL_SOCKET, _SO_RCVBUFFORCE, _QUEUE_BYTES)
    except PermissionError:
        own.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _QUEUE_BYTES)

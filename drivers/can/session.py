"""One CAN bus, shared by all devices of a process: subscribe to identifiers, send frames, know its health.

Job: one `can.Bus` and one reading thread for each `[buses.NAME]`; dispatch by identifier with monotonic time
stamps; frame statistics; bus-off, a lost interface and failing callbacks are kept, put on the status board
and raised from the next call. Not its job: CANopen (`drivers.can.canopen_node`).

Use from a device::

    self._bus = can_session(context, settings["bus"])        # __init__: checks the rig file only
    self._bus.open()                                         # open(): counted, the last close() shuts it
    self._bus.subscribe(0x1A0, self._on_frame)               # _on_frame(data: bytes, timestamp_s: float)
    self._bus.send(0x210, struct.pack("<Hh", 7, 1234))
    self._bus.check()                                        # raises DeviceError when the bus has failed
"""

from __future__ import annotations

import contextlib
import logging
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from drivers.can.bus import LOG_SUFFIXES, BusSettings, bus_settings, open_bus
from drivers.can.frame_log import FrameLog
from drivers.can.frames import ERROR, EXTENDED, REMOTE, Frame, FrameReader, frame_reader
from rigctl.core.errors import DeviceError
from rigctl.hal.devices import RigContext

if TYPE_CHECKING:
    import can

FrameCallback = Callable[[bytes, float], None]
"""callback(data, timestamp_s): called in the bus's own thread, must return at once. `timestamp_s` is on the
clock of `time.monotonic()`."""

_LOG = logging.getLogger(__name__)
_READ_TIMEOUT_S = 0.1
_SEND_TIMEOUT_S = 0.05
_REST_S = 0.004  # frames that the kernel has stamped may wait so long: far fewer wake-ups
_MAX_CONSECUTIVE_ERRORS = 5
_BUS_OFF = 0x40  # error frames of Linux: linux/can/error.h CAN_ERR_BUSOFF
_CONTROLLER_PROBLEM = 0x04  # CAN_ERR_CRTL
_PASSIVE = 0x30  # CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE


@dataclass(slots=True)
class BusStatistics:
    """Counts since the bus was opened.

    Attributes
    ----------
    received, sent : int
        Data frames.
    unheard : int
        Received frames that nobody has subscribed to.
    echoed : int
        Own frames that the interface gave back.
    malformed : int
        What the interface delivered that is no frame.
    error_frames : int
        Error frames reported by the controller.
    overrun : int
        Frames that the kernel dropped since nobody read them in time, where it says so.
    last_received_s : float
        Monotonic time of the newest frame; -inf before the first.
    """

    received: int = 0
    sent: int = 0
    unheard: int = 0
    echoed: int = 0
    malformed: int = 0
    error_frames: int = 0
    overrun: int = 0
    last_received_s: float = float("-inf")


class CanSession:
    """A bus that several devices use. Made by `can_session`."""

    def __init__(self, settings: BusSettings, context: RigContext) -> None:
        self.settings = settings
        self.statistics = BusStatistics()
        self._context = context
        self._subscribers: dict[int, tuple[FrameCallback, ...]] = {}
        self._lock = threading.RLock()
        self._send_lock = threading.Lock()
        self._failure_lock = threading.Lock()
        self._users = 0
        self._bus: can.BusABC | None = None
        self._reader: threading.Thread | None = None
        self._closing = threading.Event()
        self._hurry = threading.Event()
        self._hurry_lock = threading.Lock()
        self._hurried = 0
        self._log: FrameLog | None = None
        self._failure: DeviceError | None = None
        self._consecutive_errors = 0
        self._own_sent: dict[int, int] = {}  # written under the send lock
        self._own_heard: dict[int, int] = {}  # written by the reading thread

    @property
    def name(self) -> str:
        """Name of the bus in the rig file."""
        return self.settings.name

    @property
    def failure(self) -> DeviceError | None:
        """Why the bus cannot be used any more; None while it can."""
        return self._failure

    # -- opening ----------------------------------------------------------------------------------

    def open(self) -> None:
        """Open the bus for one more user; the first one opens the interface.

        Raises
        ------
        DeviceError
            The interface does not open; names what is missing.
        """
        with self._lock:
            if self._users == 0:
                self._start()
            self._users += 1

    def close(self) -> None:
        """One user less; the last one closes the interface. Never raises."""
        with self._lock:
            if self._users == 0:
                return
            self._users -= 1
            if self._users == 0:
                self._stop()

    def _start(self) -> None:
        self.statistics = BusStatistics()
        self._failure = None
        self._consecutive_errors = 0
        self._own_sent, self._own_heard = {}, {}
        self._bus = open_bus(self.settings)
        wire_log_dir = self._context.wire_log_dir
        log_dir = wire_log_dir or (self._context.log_dir if self.settings.log_suffix else None)
        try:
            if log_dir is not None:
                suffix = self.settings.log_suffix or LOG_SUFFIXES[0]
                self._log = FrameLog(log_dir / f"can-{self.name}.{suffix}", self.name)
            frames = frame_reader(self._bus, self.settings.interface)
            self._closing.clear()
            self._reader = threading.Thread(
                target=self._read, args=(frames,), name=f"can {self.name}", daemon=True
            )
            self._reader.start()
        except BaseException:
            self._stop()
            raise

    def _stop(self) -> None:
        import can

        reader, self._reader = self._reader, None
        if reader is not None:
            self._closing.set()
            self._hurry.set()
            reader.join(10 * _READ_TIMEOUT_S)
            self._hurry.clear()
        if self._bus is not None:
            try:
                self._bus.shutdown()
            except (can.CanError, OSError) as error:
                _LOG.warning("bus %s: closing it: %s", self.name, error)
            self._bus = None
        if self._log is not None:
            self._log.close()
            self._log = None
        self._context.board.fault(self._fault_name, "")

    # -- use --------------------------------------------------------------------------------------

    def subscribe(self, cob_id: int, callback: FrameCallback) -> Callable[[], None]:
        """Have `callback(data, timestamp_s)` called for every frame of an identifier.

        Parameters
        ----------
        cob_id : int
            11-bit identifier (above 7FFh: 29-bit).
        callback : callable
            Runs in the bus's thread and must return at once. What it raises counts as a failure of the
            bus: it is kept, put on the board and raised by `check`.

        Returns
        -------
        callable
            Call it to end the subscription.
        """
        with self._lock:
            self._subscribers[cob_id] = (*self._subscribers.get(cob_id, ()), callback)

        def unsubscribe() -> None:
            with self._lock:
                rest = tuple(entry for entry in self._subscribers.get(cob_id, ()) if entry is not callback)
                if rest:
                    self._subscribers[cob_id] = rest
                else:
                    self._subscribers.pop(cob_id, None)

        return unsubscribe

    def send(self, cob_id: int, data: bytes) -> None:
        """Send a data frame of up to 8 bytes now; safe from several threads.

        Raises
        ------
        DeviceError
            The bus is not open, has failed, or did not take the frame.
        """
        import can

        self.check()
        message = can.Message(arbitration_id=cob_id, data=data, is_extended_id=cob_id > 0x7FF, check=True)
        with self._send_lock:
            bus = self._bus
            if bus is None:
                raise DeviceError("is not open.", place=self._place, remedy="Open the device first.")
            if self.settings.echoes:
                self._own_sent[cob_id] = self._own_sent.get(cob_id, 0) + 1
            if self._log is not None:
                self._log.write(message, sent=True)
            try:
                bus.send(message, _SEND_TIMEOUT_S)
            except (can.CanError, OSError) as error:
                raise self.fail(f"does not take frames (identifier {cob_id:03X}h): {error}") from error
            self.statistics.sent += 1

    def check(self) -> None:
        """Raise when the bus has failed.

        Raises
        ------
        DeviceError
            With the first cause.
        """
        if self._failure is not None:
            raise DeviceError(
                self._failure.problem, place=self._failure.place, remedy=self._failure.remedy
            ) from self._failure

    @contextlib.contextmanager
    def hurried(self) -> Iterator[None]:
        """While an answer is waited for: frames are dispatched as they come, not some milliseconds later."""
        with self._hurry_lock:
            self._hurried += 1
            self._hurry.set()
        try:
            yield
        finally:
            with self._hurry_lock:
                self._hurried -= 1
                if self._hurried == 0 and not self._closing.is_set():
                    self._hurry.clear()

    def silent_s(self) -> float:
        """Seconds since the newest frame of anybody; infinite before the first."""
        return time.monotonic() - self.statistics.last_received_s

    def look(self) -> None:
        """Look after the controller's own state; called some times a second by whoever has a thread."""
        import can

        bus, reader = self._bus, self._reader
        if bus is None or self._failure is not None:
            return
        if reader is not None and not reader.is_alive():
            self.fail("its reading thread has ended")
            return
        try:
            state = bus.state
        except (can.CanError, OSError, NotImplementedError):
            return
        if state == can.BusState.ERROR:
            self.fail("the controller is bus-off")

    def fail(self, problem: str) -> DeviceError:
        """Keep the first failure, put it on the board, and return it."""
        with self._failure_lock:
            if self._failure is None:
                self._failure = DeviceError(
                    f"{problem}.", place=self._place,
                    remedy="Check adapter, cable, termination and bit rate; then open the rig anew.",
                )  # fmt: skip
                self._context.board.fault(self._fault_name, problem)
            return self._failure

    # -- the reading thread -------------------------------------------------------------------------

    def _read(self, frames: FrameReader) -> None:
        try:
            while not self._closing.is_set():
                try:
                    taken = frames.take(_READ_TIMEOUT_S, self._on_frame)
                except Exception as error:  # interfaces raise what they like in place of a frame
                    self._on_reading_error(error)
                    continue
                self.statistics.overrun = frames.overrun
                if taken and frames.stamped:
                    self._hurry.wait(_REST_S)
        finally:
            frames.close()

    def _on_frame(self, frame: Frame) -> None:
        cob_id, data, t_ns, flags = frame
        self._consecutive_errors = 0
        statistics = self.statistics
        heard = self._own_heard.get(cob_id, 0)
        if heard < self._own_sent.get(cob_id, 0):
            self._own_heard[cob_id] = heard + 1
            statistics.echoed += 1
            return
        if self._log is not None:
            self._log.write(frame.message(), sent=False)
        if flags & ERROR:
            self._on_error_frame(frame)
            return
        if flags & REMOTE or bool(flags & EXTENDED) != (cob_id > 0x7FF):
            return
        timestamp_s = t_ns * 1e-9
        statistics.received += 1
        statistics.last_received_s = timestamp_s
        callbacks = self._subscribers.get(cob_id)
        if callbacks is None:
            statistics.unheard += 1
            return
        for callback in callbacks:
            try:
                callback(data, timestamp_s)
            except Exception as error:  # whatever a driver's callback does, the others go on
                _LOG.exception("bus %s: callback of identifier %03Xh", self.name, cob_id)
                self.fail(f"a driver failed on a frame {cob_id:03X}h {data.hex(' ')}: {error!r}")

    def _on_error_frame(self, frame: Frame) -> None:
        self.statistics.error_frames += 1
        if frame.cob_id & _BUS_OFF:
            self.fail("the controller is bus-off")
        elif frame.cob_id & _CONTROLLER_PROBLEM and len(frame.data) > 1:
            passive = bool(frame.data[1] & _PASSIVE)
            problem = "the controller is error-passive: many frames are disturbed" if passive else ""
            if self._failure is None:
                self._context.board.fault(self._fault_name, problem)

    def _on_reading_error(self, error: Exception) -> None:
        """The interface delivered no frame but an error; a row of them is a lost interface."""
        self.statistics.malformed += 1
        self._consecutive_errors += 1
        if self._consecutive_errors >= _MAX_CONSECUTIVE_ERRORS:
            self.fail(f"cannot be read any more: {error}")
        if self._consecutive_errors > 1:
            time.sleep(_READ_TIMEOUT_S / 2)  # do not spin on an interface that has gone

    @property
    def _place(self) -> str:
        return f"bus {self.name!r} ({self.settings.interface} {self.settings.arguments.get('channel', '')})"

    @property
    def _fault_name(self) -> str:
        return f"bus {self.name}"


def can_session(context: RigContext, name: str) -> CanSession:
    """The session of a bus of the rig file; the same object for all devices of the process.

    Raises
    ------
    ConfigError
        The rig file has no such bus, or its table is wrong.
    """
    settings = bus_settings(context.buses, name, context.place)
    return context.share(f"can:{name}", lambda: CanSession(settings, context))

"""The watchdog's own connection to a real rig: a second listener on the CAN bus, and the owner of the relay.

Job: `CanSafetyLink` (see `rigctl.core.safety_link.SafetyLink`): decode the sensors' PDOs by itself, make one
sample of every 50 ms, renew, close and open the relay with a rising counter, and say what is wrong with the
channel itself. Runs in the watchdog process: standard library and python-can only. Not its job: limits and
decisions (`rigctl.safety`), the controller's view of the rig (`drivers.daq`), configuration of the nodes.

How time runs: `t_s` of the samples is the monotonic clock since the first state was heard, on a grid of
50 ms; each of the five readings belongs to 10 ms, each frame to the time at which the kernel received it.
After a delay of this process the frames that wait are put in their places first, then samples are handed out.
"""

from __future__ import annotations

import contextlib
import os
import select
import socket
import threading
import time
from collections import deque
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

from drivers.can.bus import bus_settings, open_bus
from drivers.can.frames import BATCH, ERROR, Frame, FrameReader, frame_reader
from drivers.safety_io.decoding import SignalDecoder
from drivers.safety_io.settings import parse_settings
from rigctl.core.errors import DeviceError, LinkClosed
from rigctl.core.safety_link import SafetySample

if TYPE_CHECKING:
    import can

READING_NS: Final = 10_000_000
READINGS: Final = 5
SAMPLE_S: Final = READING_NS * READINGS * 1e-9

OPEN, RENEW, CLOSE = 0, 1, 2
RELAY_CLOSED, ESTOP_OK, DOORS_OK, DRIVE_ENABLED = 1, 2, 4, 8

_NMT, _NMT_START = 0x000, 0x01
_HEARTBEAT, _BOOT_UP, _OPERATIONAL = 0x700, 0, 5
_NODE_MASK = 0x7F
_BUS_OFF = 0x40  # error frames of Linux: linux/can/error.h CAN_ERR_BUSOFF
_START_AGAIN_NS = 500_000_000
_ECHO_NS = 300_000_000  # a command older than this need not be echoed any more
_MAX_AGE_S = 1.0  # time stamps of the interface older than this are of another clock
_DRAIN_FRAMES = 512  # frames read at once, so that a flood cannot hold up the samples
_SEND_TIMEOUT_S = 0.02
_ERRORS_IN_A_ROW = 5
_SAMPLES_WAITING = 40
_SENT_KEPT = 32


class CanSafetyLink:
    """Safety channel of the watchdog on a CAN bus.

    Parameters
    ----------
    settings : mapping
        ``bus``: keys of `[buses.NAME]` (python-can's arguments); ``bus_name``; ``channel``:
        `SafetyIoSettings` as a mapping. `CanSafetyChannel.watchdog_link` makes it.

    Raises
    ------
    ConfigError
        A setting is wrong.
    """

    def __init__(self, settings: Mapping[str, Any]) -> None:
        self._bus_name = str(settings.get("bus_name", "safety"))
        self._bus_settings = bus_settings(
            {self._bus_name: settings["bus"]}, self._bus_name, "safety channel of the watchdog"
        )
        self._io = parse_settings(settings.get("channel", {}), "safety channel of the watchdog")
        self._place = f"safety I/O {self._io.node:02X}h on bus {self._bus_name!r}"
        self._signals = {name: SignalDecoder(signal) for name, signal in self._io.signals().items()}
        self._by_id: dict[int, list[SignalDecoder]] = {}
        for signal in self._signals.values():
            self._by_id.setdefault(signal.cob_id, []).append(signal)
        # Standard identifiers of TPDOs carry the node's number.
        self._watched = {
            self._io.node,
            *self._io.start_nodes,
            *(cob_id & _NODE_MASK for cob_id in self._by_id),
        }
        self._stale_ns = round(self._io.state_stale_s * 1e9)
        self._nonce = os.urandom(2)
        # commands (the thread of the watchdog)
        self._counter = 0
        self._sent: tuple[int, int, int | None] | None = None  # time, last counter, the one before
        self._own = deque[bytes](maxlen=_SENT_KEPT)
        # what was heard (the listening thread)
        self._heard_ids: set[int] = set()
        self._heard_ns: int | None = None
        self._state: tuple[int, int, int] | None = None  # time, bits, echo
        self._restarted: set[int] = set()
        self._foreign = False
        self._not_operational: set[int] = set(self._io.start_nodes)
        self._started_ns = 0
        self._errors_in_a_row = 0
        # hand-over of samples
        self._readings: dict[str, list[float | None]] = {name: [] for name in self._signals}
        self._k = 0
        self._start_ns = self._end_ns = 0
        self._samples = deque[SafetySample]()
        self._bus: can.BusABC | None = None
        self._frames: FrameReader | None = None
        self._thread: threading.Thread | None = None
        self._closing = threading.Event()
        self._state_came = threading.Event()
        self._failure = "it is not connected"
        self._reader: socket.socket | None = None
        self._writer: socket.socket | None = None

    # -- life -------------------------------------------------------------------------------------

    def connect(self, timeout_s: float) -> None:
        """See `SafetyLink.connect`. The relay is told to open first of all."""
        self._bus = open_bus(self._bus_settings)
        self._frames = frame_reader(self._bus, self._bus_settings.interface)
        self._reader, self._writer = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
        self._reader.setblocking(False)
        self._writer.setblocking(False)
        self._failure = "it was closed"
        self._start_ns = self._end_ns = time.monotonic_ns()
        self._thread = threading.Thread(target=self._listen, name="safety-can", daemon=True)
        self._thread.start()
        if not self._state_came.wait(timeout_s):
            self.close()
            heard = ", ".join(f"{cob_id:03X}h" for cob_id in sorted(self._heard_ids)) or "nothing"
            raise DeviceError(
                f"sends no state ({self._io.state_cob_id:03X}h) within {timeout_s:g} s; "
                f"heard on the bus: {heard}.",
                place=self._place,
                remedy="Check its supply, node id and bit rate, and that no other program holds the adapter.",
            )
        state = self._state
        self._counter = state[2] if state is not None else 0
        self._command(OPEN)

    def close(self) -> None:
        """See `SafetyLink.close`. Never raises: a bus that has gone cannot be told."""
        if self._bus is None:
            return
        if self._state is not None:
            with contextlib.suppress(DeviceError):
                self._command(OPEN)
        self._closing.set()
        if self._thread is not None:
            self._thread.join(1.0)
        bus, self._bus = self._bus, None
        if self._frames is not None:
            self._frames.close()
            self._frames = None
        if self._reader is not None:
            self._reader.close()
            self._reader = None
        import can

        with contextlib.suppress(can.CanError, OSError):
            bus.shutdown()

    # -- the watchdog's thread ----------------------------------------------------------------------

    def fileno(self) -> int:
        """See `SafetyLink.fileno`."""
        if self._reader is None:
            raise self._closed()
        return self._reader.fileno()

    def recv(self, timeout_s: float) -> SafetySample | None:
        """See `SafetyLink.recv`."""
        reader = self._reader
        if reader is None:
            raise self._closed()
        if timeout_s > 0.0:
            select.select([reader], [], [], timeout_s)
        try:
            token = reader.recv(1)
        except BlockingIOError:
            return None
        if not token:
            raise self._closed()
        return self._samples.popleft()

    def edge(self, k: int) -> None:
        """See `SafetyLink.edge`."""
        self._command(RENEW)

    def hold(self, k: int) -> None:
        """See `SafetyLink.hold`. A relay that still reads closed is told again to open."""
        state = self._state
        if state is not None and state[1] & RELAY_CLOSED:
            self._command(OPEN)

    def close_relay(self, k: int) -> None:
        """See `SafetyLink.close_relay`."""
        self._command(CLOSE)

    def open_relay(self, k: int, reason: str) -> None:
        """See `SafetyLink.open_relay`."""
        self._command(OPEN)

    def _command(self, word: int) -> None:
        bus = self._bus
        if bus is None:
            raise self._closed()
        import can

        before = self._counter
        self._counter = (before + 1) & 0xFF
        data = bytes((word, self._counter)) + self._nonce
        self._own.append(data)
        now_ns = time.monotonic_ns()
        recent = self._sent is not None and now_ns - self._sent[0] < _ECHO_NS
        self._sent = (now_ns, self._counter, before if recent else None)
        message = can.Message(arbitration_id=self._io.command_cob_id, data=data, is_extended_id=False)
        try:
            bus.send(message, _SEND_TIMEOUT_S)
        except (can.CanError, OSError) as error:
            raise LinkClosed(f"the bus takes no frames: {error}", place=self._place) from error

    def _closed(self) -> LinkClosed:
        return LinkClosed(self._failure, place=self._place)

    # -- the listening thread -----------------------------------------------------------------------

    def _listen(self) -> None:
        try:
            while not self._closing.is_set():
                self._turn()
        except Exception as error:  # whatever it was: the channel has gone, and the watchdog is told why
            self._failure = f"{type(error).__name__}: {error}"
        finally:
            assert self._writer is not None
            self._writer.close()

    def _turn(self) -> None:
        """Wait for frames until the next reading is due, then put all that wait in their places."""
        frames = self._frames
        assert frames is not None
        wait_s = max(0.0, (self._end_ns + READING_NS - time.monotonic_ns()) * 1e-9)
        if frames.stamped and wait_s > 0.0:
            self._closing.wait(wait_s)  # what comes meanwhile is stamped by the kernel
            wait_s = 0.0
        self._take(frames, wait_s)
        now_ns = time.monotonic_ns()
        while self._end_ns + READING_NS <= now_ns:
            self._end_reading()
        if now_ns - self._started_ns > _START_AGAIN_NS:
            self._start_nodes(now_ns)

    def _take(self, frames: FrameReader, wait_s: float) -> None:
        import can

        for _ in range(BATCH):
            try:
                frames.take(wait_s, self._on_frame)
                return
            except (can.CanError, OSError) as error:
                self._errors_in_a_row += 1
                if self._errors_in_a_row >= _ERRORS_IN_A_ROW:
                    raise LinkClosed(
                        f"the bus cannot be read any more: {error}", place=self._place
                    ) from error
            wait_s = 0.0  # what waits behind it is not held up

    def _on_frame(self, frame: Frame) -> None:
        cob_id, data, t_ns, flags = frame
        self._errors_in_a_row = 0
        if flags & ERROR:
            if cob_id & _BUS_OFF:
                raise LinkClosed("the CAN controller is bus-off", place=self._place)
            return
        if flags:
            return
        while self._end_ns + READING_NS <= t_ns:
            self._end_reading()
        if cob_id == self._io.command_cob_id:
            # Some interfaces give own frames back; those are no sign of life of the bus.
            self._foreign = self._foreign or data not in self._own
            return
        if cob_id == _NMT:
            return
        self._heard_ids.add(cob_id)
        self._heard_ns = t_ns
        signals = self._by_id.get(cob_id)
        if signals is not None:
            for signal in signals:
                signal.take(data, t_ns)
        elif cob_id == self._io.state_cob_id:
            if len(data) >= 2:
                self._state = (t_ns, data[0], data[1])
                self._state_came.set()
        elif cob_id & ~_NODE_MASK == _HEARTBEAT and len(data) == 1:
            self._on_heartbeat(cob_id & _NODE_MASK, data[0] & _NODE_MASK)

    def _on_heartbeat(self, node: int, state: int) -> None:
        if state == _BOOT_UP and node in self._watched:
            self._restarted.add(node)
        if node in self._io.start_nodes:
            if state == _OPERATIONAL:
                self._not_operational.discard(node)
            else:
                self._not_operational.add(node)

    def _start_nodes(self, now_ns: int) -> None:
        """NMT start for nodes known not to be operational. Nothing moves by that."""
        self._started_ns = now_ns
        state = self._state
        if state is not None and now_ns - state[0] <= self._stale_ns:
            self._not_operational.discard(self._io.node)
        if not self._not_operational:
            return
        import can

        assert self._bus is not None
        for node in sorted(self._not_operational):
            data = bytes((_NMT_START, node))
            try:
                self._bus.send(
                    can.Message(arbitration_id=_NMT, data=data, is_extended_id=False), _SEND_TIMEOUT_S
                )
            except (can.CanError, OSError) as error:
                raise LinkClosed(f"the bus takes no frames: {error}", place=self._place) from error

    # -- samples ------------------------------------------------------------------------------------

    def _end_reading(self) -> None:
        end_ns = self._end_ns = self._end_ns + READING_NS
        for name, signal in self._signals.items():
            self._readings[name].append(signal.reading(end_ns))
        if len(self._readings["pressure"]) >= READINGS and self._state_came.is_set():
            self._hand_over(end_ns)
        elif len(self._readings["pressure"]) >= READINGS:  # nobody waits for samples yet
            self._start_ns = end_ns
            self._clear_readings()

    def _hand_over(self, end_ns: int) -> None:
        if len(self._samples) >= _SAMPLES_WAITING:
            raise LinkClosed(f"the watchdog has left {_SAMPLES_WAITING} samples waiting", place=self._place)
        fault = self._channel_fault(end_ns)
        state = self._state
        bits = state[1] if state is not None and end_ns - state[0] <= self._stale_ns else 0
        readings = self._readings
        self._samples.append(
            SafetySample(
                k=self._k,
                t_s=(self._k + 1) * SAMPLE_S,
                dt_s=SAMPLE_S,
                pressure_bar=tuple(readings["pressure"]),
                speed_rpm=tuple(readings["speed"]),
                torque_nm=tuple(readings["torque"]),
                temperature_degc=tuple(readings["temperature"]),
                relay_closed=bool(bits & RELAY_CLOSED),
                drive_enabled=bool(bits & DRIVE_ENABLED),
                estop_ok=bool(bits & ESTOP_OK),
                doors_ok=bool(bits & DOORS_OK),
                channel_fault=fault,
            )
        )
        self._k += 1
        self._clear_readings()
        assert self._writer is not None
        self._writer.send(b"s")

    def _clear_readings(self) -> None:
        for values in self._readings.values():
            values.clear()

    def _channel_fault(self, now_ns: int) -> str:
        """What is wrong with bus, safety I/O or the way to it; empty when all is well."""
        if self._restarted:
            nodes, self._restarted = self._restarted, set()
            names = ", ".join(f"{node:02X}h" for node in sorted(nodes))
            return f"node {names} has restarted"
        if self._foreign:
            self._foreign = False
            return f"somebody else sends {self._io.command_cob_id:03X}h, the relay's command"
        silent_ns = None if self._heard_ns is None else now_ns - self._heard_ns
        if silent_ns is None or silent_ns > self._stale_ns:
            return (
                "the bus is silent"
                if silent_ns is None
                else f"the bus is silent for {silent_ns / 1e6:.0f} ms"
            )
        state = self._state
        if state is None or now_ns - state[0] > self._stale_ns:
            since = "" if state is None else f" for {(now_ns - state[0]) / 1e6:.0f} ms"
            return f"the safety I/O (node {self._io.node:02X}h) is silent{since}"
        sent = self._sent
        if sent is not None and sent[2] is not None and now_ns - sent[0] < _ECHO_NS:
            echo = state[2]
            if state[0] > sent[0] and echo not in (sent[1], sent[2]):
                return f"the safety I/O does not take commands: counter {sent[1]} sent, {echo} echoed"
        return ""

"""The controller's side of the recorder: say what to record, pass on ranges of samples, hear what is safe.

Job: messages with little cost per block (samples stay in the ring; consecutive blocks share a message), and a
window so that the recorder can never be overrun: when it is more than `window_s` of rig time behind, `block`
waits. In normal operation nothing waits. NOT its job: files (`recorder`), what to do when recording fails
(`rigctl.engine`).

Blocks are held back until `MERGED_NS` of rig time are together *and* the next block has come: by then the
converter has delivered the samples of those before it, and the recorder need not wait for them. What a dying
controller had not passed on yet, at most `MERGED_NS` and one block, is lost with it.
"""

from __future__ import annotations

import contextlib
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from rigctl.core import wire
from rigctl.core.blocks import CLOCKS, Block
from rigctl.core.errors import DeviceError, LinkClosed, RecordingError
from rigctl.core.wire import Link, Message
from rigctl.recording.spool import CLOCKS_MARK

SOCKET_NAME: Final = "recorder.sock"
MERGED_NS: Final = 250_000_000
"""Rig time that one message stands for; part of the second that a crash may cost (`spool.SYNC_PERIOD_S`)."""
SIMULATED_EPOCH: Final = "2000-01-01T00:00:00+00:00"
"""Date at rig time 0 of a simulated rig: fixed, so that the same seed gives the same files."""
_NOTHING: Final = (0, 0)
_Ranges = list[tuple[int, int]]


def _continues(ranges: _Ranges, before: _Ranges) -> bool:
    """True when the range of every channel begins where the one before it ended."""
    return all([start == stop for (start, _), (_, stop) in zip(ranges, before, strict=True)])


class RecorderClient:
    """One controller's connection to the recorder.

    Parameters
    ----------
    link : Link
    evaluation : mapping
        {"friction": {...}, "detection": {...}}: settings of `rigctl.signals.evaluation`.
    metadata : mapping
        Plain JSON values stored in each file: sensors, calibrations, rig, brake, versions, seed.
    clock_epoch : str
        ISO date and time with zone at rig time 0.
    window_s : float
        Rig time that the recorder may be behind; must be well below what the ring holds.
    """

    def __init__(
        self,
        link: Link,
        *,
        evaluation: Mapping[str, Any] | None = None,
        metadata: Mapping[str, Any] | None = None,
        clock_epoch: str = SIMULATED_EPOCH,
        window_s: float = 8.0,
    ) -> None:
        self._link = link
        self._constant = {
            "evaluation": dict(evaluation or {}),
            "metadata": dict(metadata or {}),
            "epoch": clock_epoch,
        }
        self._window_s = window_s
        self._names: tuple[str, ...] | None = None
        self._clocks: Mapping[str, Any] | None = None  # as told for this braking
        self._copied_s = 0.0
        self._start_ns = self._stop_ns = 0  # rig time of the blocks held back; none when equal
        self._full_ns = 0  # they go with the first block from here on
        self._first: _Ranges = []  # of the first and the last of them
        self._last: _Ranges = []
        self._events: list[Message] = []
        self._idle_asked = 0
        self._idle_answered = 0

    @classmethod
    def connect(cls, run_dir: Path, timeout_s: float = 10.0, **settings: Any) -> RecorderClient:
        """Connect to the recorder of a run; `settings` as for the constructor."""
        return cls(wire.connect(run_dir / SOCKET_NAME, timeout_s, "recorder"), **settings)

    def fileno(self) -> int:
        """Descriptor for select and poll."""
        return self._link.fileno()

    @property
    def recording(self) -> bool:
        """True between `begin` and `end`."""
        return self._names is not None

    def begin(self, specification: Mapping[str, Any], *, t0_s: float) -> None:
        """Start recording a braking with the next block.

        Parameters
        ----------
        specification : mapping
            The braking as plain JSON (`Braking.model_dump(mode="json")`).
        t0_s : float
            Rig time now.
        """
        if self._names is not None:
            raise RecordingError("a braking is being recorded already.", remedy="Call `end` first.")
        names = tuple(channel["name"] for channel in specification["recording"]["channels"])
        self._link.send({"m": "begin", "specification": dict(specification), "t0_s": t0_s, **self._constant})
        self._names = names
        self._clocks = None
        self._copied_s = t0_s

    def block(self, block: Block) -> None:
        """Pass on one block: ranges of samples only, in one message with those after it, and what is new of
        the clocks of the rig's sources. Does nothing while no braking is recorded.
        """
        names = self._names
        if names is None:
            return
        ranges, t_ns = block.ranges, block.t_ns
        found = [ranges.get(name, _NOTHING) for name in names]
        if t_ns != self._stop_ns or t_ns >= self._full_ns or not _continues(found, self._last):
            self._send_blocks()
            self._start_ns, self._full_ns, self._first = t_ns, t_ns + MERGED_NS, found
        self._last = found
        self._stop_ns = t_ns + block.dt_ns
        clocks = block.status.get(CLOCKS)
        if clocks and clocks != self._clocks:
            self._clocks = clocks
            self._link.send({"m": "mark", "name": CLOCKS_MARK, "t": block.end_s, "values": clocks})

    def mark(self, name: str, t_s: float, **values: Any) -> None:
        """State what happened in the braking, e.g. "pressure_onset", at rig time `t_s`; NaN becomes null."""
        self._send_blocks()
        plain = {key: None if value != value else value for key, value in values.items()}  # noqa: PLR0124
        self._link.send({"m": "mark", "name": name, "t": t_s, "values": plain})

    def end(self, status: str = "complete", note: str = "") -> None:
        """End the braking: "complete" or "incomplete". The file is made while the rig goes on."""
        self._names = None
        self._send_blocks()
        self._link.send({"m": "end", "status": status, "note": note})

    def poll(self) -> list[Message]:
        """What the recorder has said since the last call, without waiting.

        Returns
        -------
        list of dict
            {"m": "begun", "index"}; {"m": "spooled", "index", "t"}: samples up to rig time t survive a power
            cut; {"m": "committed", "index", "status", "sha256", "events", "summary"}: the file is there;
            {"m": "gap", "index", "error"}: samples are missing, the braking will not be complete;
            {"m": "failed", "index", "error"}: it could not be recorded.

        Raises
        ------
        LinkClosed
            The recorder is dead, and everything it said has been returned.
        """
        try:
            self._take_all()
        except LinkClosed:
            if not self._events:  # last words first; the next call raises
                raise
        events, self._events = self._events, []
        return events

    def wait_idle(self, timeout_s: float = 60.0) -> None:
        """Wait until every braking that was ended is in its file or has failed; `poll` then tells which.

        Raises
        ------
        RecordingError
            Not within `timeout_s`.
        """
        self._send_blocks()
        self._idle_asked += 1
        self._link.send({"m": "idle", "n": self._idle_asked})
        deadline = time.monotonic() + timeout_s
        while self._idle_answered < self._idle_asked:
            self._receive(deadline, f"has not finished its files within {timeout_s:g} s.")

    def close(self) -> None:
        """Part from the recorder: it finishes its files and ends. A running braking becomes incomplete."""
        message = self._take_blocks()
        if message is not None:
            with contextlib.suppress(DeviceError):  # the recorder has gone before: nobody to pass it on to
                self._link.send(message)
        self._link.close()

    def _send_blocks(self) -> None:
        """Send the blocks held back, after waiting for the recorder when it is too far behind."""
        end_s = self._stop_ns * 1e-9
        message = self._take_blocks()
        if message is None:
            return
        if end_s - self._copied_s > self._window_s:
            self._wait_until_copied(end_s - self._window_s)
        self._link.send(message)

    def _take_blocks(self) -> Message | None:
        """The blocks held back as one message, None when there are none; they are given out once."""
        start_ns, stop_ns = self._start_ns, self._stop_ns
        if start_ns == stop_ns:
            return None
        ranges = [(start, stop) for (start, _), (_, stop) in zip(self._first, self._last, strict=True)]
        self._start_ns = self._stop_ns = self._full_ns = 0
        return {"m": "block", "t": start_ns, "dt": stop_ns - start_ns, "r": ranges}

    def _wait_until_copied(self, t_s: float, timeout_s: float = 30.0) -> None:
        deadline = time.monotonic() + timeout_s
        self._take_all()
        while self._copied_s < t_s:
            self._receive(deadline, f"has not taken any samples for {timeout_s:g} s.")

    def _receive(self, deadline: float, complaint: str) -> None:
        message = self._link.recv(max(0.0, deadline - time.monotonic()))
        if message is None:
            raise RecordingError(
                f"the recorder {complaint}",
                place=self._link.name,
                remedy="The disk is too slow or full: see the journal; `rigctl resume` continues.",
            )
        self._take(message)

    def _take_all(self) -> None:
        try:
            self._take_waiting()
        except LinkClosed:
            self._take_waiting()  # the kernel reports a sudden death before it hands out the last words

    def _take_waiting(self) -> None:
        while (message := self._link.recv(0)) is not None:
            self._take(message)

    def _take(self, message: Message) -> None:
        if message["m"] == "copied":
            self._copied_s = max(self._copied_s, message["t"])
        elif message["m"] == "idle":
            self._idle_answered = message["n"]
        else:
            self._events.append(message)

"""The controller's side of the recorder: say what to record, pass on ranges of samples, hear what is safe.

Job: messages with little cost per block (samples stay in the ring), and a window so that the recorder can
never be overrun: when it is more than `window_s` of rig time behind, `block` waits. In normal operation
nothing waits. NOT its job: files (`recorder`), what to do when recording fails (`rigctl.engine`).
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from rigctl.core import wire
from rigctl.core.blocks import Block
from rigctl.core.errors import LinkClosed, RecordingError
from rigctl.core.wire import Link, Message

SOCKET_NAME: Final = "recorder.sock"
SIMULATED_EPOCH: Final = "2000-01-01T00:00:00+00:00"
"""Date at rig time 0 of a simulated rig: fixed, so that the same seed gives the same files."""


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
        self._names: list[str] | None = None
        self._copied_s = 0.0
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
        names = [channel["name"] for channel in specification["recording"]["channels"]]
        self._link.send({"m": "begin", "specification": dict(specification), "t0_s": t0_s, **self._constant})
        self._names = names
        self._copied_s = t0_s

    def block(self, block: Block) -> None:
        """Pass on one block: ranges of samples only. Does nothing while no braking is recorded."""
        names = self._names
        if names is None:
            return
        ranges = block.ranges
        if block.end_s - self._copied_s > self._window_s:
            self._wait_until_copied(block.end_s - self._window_s)
        self._link.send(
            {
                "m": "block",
                "t": block.t_ns,
                "dt": block.dt_ns,
                "r": [ranges.get(name, (0, 0)) for name in names],
            }
        )

    def mark(self, name: str, t_s: float, **values: Any) -> None:
        """State what happened in the braking, e.g. "pressure_onset", at rig time `t_s`; NaN becomes null."""
        plain = {key: None if value != value else value for key, value in values.items()}  # noqa: PLR0124
        self._link.send({"m": "mark", "name": name, "t": t_s, "values": plain})

    def end(self, status: str = "complete", note: str = "") -> None:
        """End the braking: "complete" or "incomplete". The file is made while the rig goes on."""
        self._names = None
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
        self._idle_asked += 1
        self._link.send({"m": "idle", "n": self._idle_asked})
        deadline = time.monotonic() + timeout_s
        while self._idle_answered < self._idle_asked:
            self._receive(deadline, f"has not finished its files within {timeout_s:g} s.")

    def close(self) -> None:
        """Part from the recorder: it finishes its files and ends. A running braking becomes incomplete."""
        self._link.close()

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

"""The finaliser: a thread that makes braking files, one after the other, while the next braking is recorded.

Job: take spools in order, commit them, say what came of it. NOT its job: how (`commit`), messages.

A thread, not a process: the compression, the filters and the disk calls release the interpreter, and the
file is built in memory, so that a full disk cannot bring HDF5 (and with it the recorder) down.
"""

from __future__ import annotations

import threading
import traceback
from collections import deque
from collections.abc import Callable
from pathlib import Path
from queue import SimpleQueue

import numpy as np

from rigctl.core.channels import (
    DISC_TEMPERATURE,
    MICROPHONE,
    PRESSURE,
    SPEED,
    TORQUE,
    ChannelData,
    ChannelSpec,
)
from rigctl.core.errors import RecordingError
from rigctl.core.wire import Message
from rigctl.recording.braking import Evaluator
from rigctl.recording.campaign import Campaign
from rigctl.recording.commit import EventWriter, commit
from rigctl.signals.decimation import decimate


class Finaliser:
    """Commits spools in the order of `submit`. `notify` is called, from its thread, after each result.

    Attributes
    ----------
    results : deque of dict
        {"m": "committed", ...} and {"m": "failed", ...}, oldest first; the owner takes them out.
    """

    def __init__(
        self, campaign: Campaign, evaluate: Evaluator, journal: EventWriter, notify: Callable[[], None]
    ) -> None:
        self.results: deque[Message] = deque()
        self._campaign = campaign
        self._evaluate = evaluate
        self._journal = journal
        self._notify = notify
        self._queue: SimpleQueue[tuple[int, Path] | None] = SimpleQueue()
        self._submitted = 0
        self._done = 0
        self._thread = threading.Thread(target=self._run, name="finaliser", daemon=True)

    @property
    def idle(self) -> bool:
        """True when every spool submitted has its result."""
        return self._done == self._submitted

    def start(self) -> None:
        """Start the thread; it first loads what evaluation needs."""
        self._thread.start()

    def submit(self, index: int, spool_path: Path) -> None:
        """Make the file of a spool that has ended and is closed."""
        self._submitted += 1
        self._queue.put((index, spool_path))

    def finish(self) -> None:
        """Make all files that are due, then end the thread."""
        self._queue.put(None)
        self._thread.join()

    def _run(self) -> None:
        try:
            warm_up(self._evaluate)
        except Exception:  # said here once; each braking then says that it could not be made
            traceback.print_exc()
        while (job := self._queue.get()) is not None:
            self.results.append(self._result(*job))
            self._done += 1
            self._notify()

    def _result(self, index: int, spool_path: Path) -> Message:
        try:
            done = commit(self._campaign, spool_path, self._evaluate, self._journal)
        except RecordingError as error:
            return {"m": "failed", "index": index, "error": str(error)}
        except Exception as error:  # a defect must not end the thread: the other brakings are to be kept
            traceback.print_exc()
            return {
                "m": "failed",
                "index": index,
                "error": f"{type(error).__name__}: {error}. See recorder's log.",
            }
        return {
            "m": "committed",
            "index": index,
            "status": done.status,
            "sha256": done.sha256,
            "events": done.n_events,
            "summary": done.summary["results"],
        }


def warm_up(evaluate: Evaluator) -> None:
    """Run filters and evaluation once: loading compiled code takes longer than a whole braking."""
    units = {PRESSURE: "bar", TORQUE: "N·m", SPEED: "1/min", DISC_TEMPERATURE: "°C"}
    decimate(np.zeros(1000, np.float32), 4)
    channels = {
        name: ChannelData(ChannelSpec(name, unit, 1000.0), 0.0, np.ones(1000, np.float32))
        for name, unit in units.items()
    }
    spec = ChannelSpec(MICROPHONE, "Pa", 40000.0, "int16", 6e-3)
    channels[MICROPHONE] = ChannelData(spec, 0.0, (np.arange(40000) % 7).astype(np.int16))
    evaluate(channels, {})

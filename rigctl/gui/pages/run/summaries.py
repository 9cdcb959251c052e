"""Results of committed brakings, read from their files in a thread, some at a time.

Job: a queue; the newest word on each braking wins. Not its job: what the results mean (`model`).
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal

from rigctl.gui.work import Job, Work

BATCH = 48


def read_summaries(files: Sequence[tuple[int, Path]], reporter: Any = None) -> list[tuple[int, Any]]:
    """(number, summary or None when the file cannot be read) of each file."""
    from rigctl.core.errors import RecordingError
    from rigctl.recording.braking_file import read_summary

    found: list[tuple[int, Any]] = []
    for index, path in files:
        if reporter is not None and reporter.cancelled:
            break
        try:
            found.append((index, read_summary(path)))
        except RecordingError:  # moved aside by a further attempt, or damaged: the data page says so
            found.append((index, None))
    return found


class SummaryReader(QObject):
    """`ask` for brakings of one campaign; `read` brings them."""

    read = Signal(list)
    """[(number, summary)] of files that could be read."""

    failed = Signal(str)
    """Something unexpected; the reason."""

    def __init__(self, work: Work, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._work = work
        self._campaign: Path | None = None
        self._queue: dict[int, None] = {}
        self._job: Job | None = None

    def begin(self, campaign: Path | None) -> None:
        """Another campaign; what was asked for the one before is not wanted any more."""
        self._campaign = campaign
        self._queue.clear()
        if self._job is not None:
            self._job.cancel()
            self._job = None

    def ask(self, indices: Sequence[int]) -> None:
        """Read these, in their turn."""
        for index in indices:
            self._queue[index] = None
        self._next()

    @property
    def idle(self) -> bool:
        """True when nothing is to be read."""
        return self._job is None and not self._queue

    def _next(self) -> None:
        if self._job is not None or not self._queue or self._campaign is None:
            return
        batch = list(self._queue)[:BATCH]
        for index in batch:
            del self._queue[index]
        files = [(index, self._campaign / "brakings" / f"{index:05d}.h5") for index in batch]
        self._job = self._work.in_thread(read_summaries, files, done=self._on_read, failed=self._on_failed)

    def _on_failed(self, problem: str) -> None:
        self._job = None
        self.failed.emit(problem)
        self._next()

    def _on_read(self, found: list[tuple[int, Any]]) -> None:
        self._job = None
        self.read.emit([(index, summary) for index, summary in found if summary is not None])
        self._next()

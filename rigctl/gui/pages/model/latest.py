"""The newest question only: what a dragged slider asks while the worker is still busy with the last position.

Job: one question of a kind in the worker at a time; of those that come meanwhile the newest is kept. Not its
job: what is asked.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject, Signal

from rigctl.gui.work import Job, Work


class Latest(QObject):
    """Questions of one kind to a worker process.

    Signals
    -------
    answered : result of the newest question but one at most; in order
    failed : its error in words
    """

    answered = Signal(object)
    failed = Signal(str)

    def __init__(self, work: Work, function: Callable[..., Any], lane: str, parent: QObject) -> None:
        super().__init__(parent)
        self._work, self._function, self._lane = work, function, lane
        self._job: Job | None = None
        self._waiting: tuple[Any, ...] | None = None

    @property
    def busy(self) -> bool:
        """Whether an answer is still to come."""
        return self._job is not None

    def ask(self, *args: Any) -> None:
        """Ask; a question that waits is replaced."""
        self._waiting = args
        if self._job is None:
            self._next()

    def drop(self) -> None:
        """Neither the answer that is being worked out nor the question that waits is wanted any more."""
        if self._job is not None:
            self._job.cancel()
        self._job, self._waiting = None, None

    def _next(self) -> None:
        if self._waiting is None:
            return
        args, self._waiting = self._waiting, None
        self._job = self._work.in_process(
            self._function, *args, done=self._on_done, failed=self._on_failed, lane=self._lane
        )

    def _on_done(self, result: object) -> None:
        self._job = None
        self._next()  # the worker goes on while this answer is drawn
        self.answered.emit(result)

    def _on_failed(self, text: str) -> None:
        self._job = None
        self._next()
        self.failed.emit(text)

"""Asking the fault laboratory of the session without stopping the window.

Job: one request after the other in a thread, answers and refusals as signals. Not its job: what a stimulus
does (`sim_hardware.devices.stimuli`).
"""

from __future__ import annotations

from collections import deque
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal

from rigctl.gui.work import Reporter, Work


class LaboratoryClient(QObject):
    """The laboratory of one run folder."""

    answered = Signal(dict)
    """What is in force now."""
    refused = Signal(str)
    """Why something is not done."""

    def __init__(self, run_dir: Path, work: Work, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._run_dir, self._work = run_dir, work
        self._waiting: deque[tuple[str, dict[str, Any]]] = deque()
        self._job: Any = None

    @property
    def busy(self) -> bool:
        """True while a request waits for its answer."""
        return self._job is not None

    def ask(self, do: str, **fields: Any) -> None:
        """Give a stimulus, after the ones given before."""
        self._waiting.append((do, fields))
        self._next()

    def look(self) -> None:
        """Ask what is in force, unless an answer is on its way anyway."""
        if not self.busy:
            self.ask("status")

    def close(self) -> None:
        """Answers are not wanted any more; stimuli stay in force."""
        self._waiting.clear()
        if self._job is not None:
            self._job.cancel()
            self._job = None

    def _next(self) -> None:
        if self._job is None and self._waiting:
            do, fields = self._waiting.popleft()
            self._job = self._work.in_thread(
                _ask, self._run_dir, do, fields, done=self._on_answer, failed=self._on_refused
            )

    def _on_answer(self, answer: dict[str, Any]) -> None:
        self._job = None
        self.answered.emit(answer)
        self._next()

    def _on_refused(self, why: str) -> None:
        self._job = None
        self.refused.emit(why)
        self._next()


def _ask(run_dir: Path, do: str, fields: dict[str, Any], _reporter: Reporter) -> dict[str, Any]:
    from sim_hardware.devices.laboratory import Laboratory

    with Laboratory(run_dir) as laboratory:
        return laboratory.ask(do, **fields)

"""`rigctl report` in a process of its own.

Job: start it, wait for it in a thread, say what came of it. Not its job: the report.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from rigctl.core.errors import RunError
from rigctl.gui.work import Job, Reporter, Work

_POLL_S = 0.1


class ReportBuilder(QObject):
    """One report at a time."""

    started = Signal()
    finished = Signal(object)
    """Path of the report."""
    failed = Signal(str)

    def __init__(self, work: Work, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._work = work
        self._job: Job | None = None

    @property
    def busy(self) -> bool:
        """True while a report is built."""
        return self._job is not None

    def build(self, campaign: Path) -> None:
        """Build the report of a campaign; nothing happens while one is being built."""
        if self._job is None:
            self._job = self._work.in_thread(build, campaign, done=self._on_done, failed=self._on_failed)
            self.started.emit()

    def cancel(self) -> None:
        """The report is not wanted any more: its process ends."""
        if self._job is not None:
            self._job.cancel()
            self._job = None

    def _on_done(self, path: Path) -> None:
        self._job = None
        self.finished.emit(path)

    def _on_failed(self, words: str) -> None:
        self._job = None
        self.failed.emit(words)


def build(campaign: Path, reporter: Reporter) -> Path:
    """Run `rigctl report CAMPAIGN`; returns the path of the report.

    Raises
    ------
    RunError
        It did not succeed; with its own words.
    """
    process = subprocess.Popen(
        [sys.executable, "-m", "rigctl.app.cli", "report", str(campaign)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    while True:
        try:
            _, errors = process.communicate(timeout=_POLL_S)
            break
        except subprocess.TimeoutExpired:
            if reporter.cancelled:
                process.terminate()
    if process.returncode:
        words = errors.strip().splitlines()
        raise RunError(words[-1] if words else f"rigctl report ended with code {process.returncode}.")
    return campaign / "report" / "report.html"

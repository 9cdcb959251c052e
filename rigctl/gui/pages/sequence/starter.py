"""From the second click to the run: what is not saved is copied first, then the connection is asked.

Job: saving the copy, asking, and what follows from the answer. Not its job: whether it may be started
(`readiness`), the question (`start_panel`).
"""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

from PySide6.QtCore import QObject

from rigctl.gui.pages.sequence.draft import ProgramDraft
from rigctl.gui.pages.sequence.files import ProgramFiles
from rigctl.gui.pages.sequence.program_file import save_copy
from rigctl.gui.pages.sequence.start_panel import StartChoice
from rigctl.gui.services import Services
from rigctl.gui.widgets.notice import Notice


class Starter(QObject):
    """Starts the program of the page."""

    def __init__(self, services: Services, draft: ProgramDraft, files: ProgramFiles, notice: Notice) -> None:
        super().__init__(files)
        self._services = services
        self._draft = draft
        self._files = files
        self._notice = notice

    def start(self, choice: StartChoice, rig: Path | None) -> None:
        """Start on that rig and show the run."""
        program = self._draft.program
        if program is None or rig is None:
            return
        if self._files.path is not None and not self._draft.dirty:
            self._run(self._files.path, rig, choice)
            return
        self._services.work.in_thread(
            save_copy, program, self._services.data_folder / "programs", datetime.now(),
            done=lambda saved: self._run(saved.path, rig, choice), failed=self._say,
        )  # fmt: skip

    def _run(self, program: Path, rig: Path, choice: StartChoice) -> None:
        refusals: list[str] = []
        connection = self._services.rig.refused.connect(refusals.append)
        self._services.rig.start_program(program, rig, time=choice.time, seed=choice.seed)
        self.disconnect(connection)
        if refusals:
            self._say(refusals[0])
        else:
            self._services.navigate("run")

    def _say(self, why: str) -> None:
        self._notice.ask(why, [(self.tr("Close"), None)])

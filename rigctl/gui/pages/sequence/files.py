"""New, open, save, save as, recent: files of the page, with every question asked in place.

Job: `ProgramFiles` keeps path and text of the open file and the recent ones; reading and writing run in a
thread. Not its job: the draft's contents, formats (`program_file`).
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QWidget

from rigctl.gui.pages.sequence.draft import ProgramDraft
from rigctl.gui.pages.sequence.program_file import (
    OpenedProgram,
    has_comments,
    open_program,
    save_program,
    text_on_disk,
)
from rigctl.gui.services import Services
from rigctl.gui.widgets.file_asking import ask_open, ask_save
from rigctl.gui.widgets.notice import Notice

MOST_RECENT = 6
_RECENT = "sequence-recent"

Then = Callable[[], None] | None


class ProgramFiles(QObject):
    """The open file."""

    opened = Signal(object)
    """OpenedProgram: show it."""
    changed = Signal()
    """Path, saved state or recent files have changed."""

    def __init__(self, services: Services, draft: ProgramDraft, notice: Notice, page: QWidget) -> None:
        super().__init__(page)
        self._services = services
        self._draft = draft
        self._notice = notice
        self._page = page
        self.path: Path | None = None
        self.text = ""

    # -- recent -----------------------------------------------------------------------------------

    def recent(self) -> tuple[Path, ...]:
        """Files opened or saved last, newest first, as far as they are still there."""
        stored: Any = self._services.settings.value(_RECENT, [])
        names = [stored] if isinstance(stored, str) else list(stored or [])
        return tuple(path for path in map(Path, names) if path.is_file())

    def _remember(self, path: Path) -> None:
        names = [str(path.resolve()), *(str(p) for p in self.recent() if p != path.resolve())]
        self._services.settings.setValue(_RECENT, names[:MOST_RECENT])

    # -- leaving what is open ---------------------------------------------------------------------

    def leave(self, then: Callable[[], None]) -> None:
        """Go on with `then` when nothing would be lost, or when a person has said so."""
        if not self._draft.dirty:
            then()
            return
        self._notice.ask(
            self.tr("“{0}” has changes that are not saved.").format(self._draft.form.name),
            [
                (self.tr("Save"), lambda: self.save(then)),
                (self.tr("Discard"), then),
                (self.tr("Keep editing"), None),
            ],
        )

    def forget(self) -> None:
        """There is no file any more (a new program)."""
        self.path, self.text = None, ""
        self.changed.emit()

    # -- open -------------------------------------------------------------------------------------

    def ask_open(self) -> None:
        """Choose a file; the dialog blocks nothing."""
        folder = self.path.parent if self.path is not None else self._services.config_folder / "programs"
        ask_open(self._page, self.tr("Open a program"), folder, self.tr("Programs (*.toml)"), self.open)

    def open(self, path: Path) -> None:
        """Open a file, unless something would be lost."""
        self.leave(lambda: self._read(path))

    def _read(self, path: Path) -> None:
        self._services.work.in_thread(
            open_program, path, done=self._on_read, failed=lambda why: self._say(self.tr("Not opened."), why)
        )

    def _on_read(self, read: OpenedProgram) -> None:
        self.path, self.text = read.path, read.text
        self._remember(read.path)
        self._notice.close_notice()
        self.opened.emit(read)
        self.changed.emit()

    # -- save -------------------------------------------------------------------------------------

    def save(self, then: Then = None) -> None:
        """To the open file; what would be lost there is said first."""
        if not self._valid():
            return
        if self.path is None:
            self.ask_save_as(then)
            return
        if not self._draft.dirty:
            if then is not None:
                then()
            return
        path, on_disk = self.path, text_on_disk(self.path)
        if on_disk is not None and on_disk != self.text:
            words = self.tr(
                "{0} was changed by somebody else since it was opened. Saving here overwrites that."
            )
        elif on_disk is not None and has_comments(on_disk):
            words = self.tr("{0} has comments, written by hand. Saving here removes them.")
        else:
            self._write(path, then)
            return
        self._notice.ask(
            words.format(path.name),
            [
                (self.tr("Save as …"), lambda: self.ask_save_as(then)),
                (self.tr("Overwrite"), lambda: self._write(path, then)),
                (self.tr("Cancel"), None),
            ],
        )

    def ask_save_as(self, then: Then = None) -> None:
        """Choose a name; the dialog asks before it takes an existing one."""
        if not self._valid():
            return
        folder = self._services.data_folder / "programs"
        if self.path is not None:
            folder = self.path.parent
        folder.mkdir(parents=True, exist_ok=True)
        start = folder / (self._draft.form.name.strip().replace(" ", "_") + ".toml")
        ask_save(
            self._page, self.tr("Save the program"), start, self.tr("Programs (*.toml)"),
            lambda path: self._write(path, then),
        )  # fmt: skip

    def save_as(self, path: Path, then: Then = None) -> None:
        """To a file of that name."""
        if self._valid():
            self._write(path, then)

    def _valid(self) -> bool:
        if self._draft.program is not None:
            return True
        self._say(self.tr("Not saved: the marked fields must be right first."), "")
        return False

    def _write(self, path: Path, then: Then) -> None:
        program, form = self._draft.program, self._draft.form
        if program is None:
            return

        def written(saved: OpenedProgram) -> None:
            self.path, self.text = saved.path, saved.text
            self._draft.mark_saved(form)
            self._remember(saved.path)
            self._services.notify(self.tr("Saved as {0}").format(saved.path.name))
            self.changed.emit()
            if then is not None:
                then()

        self._services.work.in_thread(
            save_program, program, path, done=written,
            failed=lambda why: self._say(self.tr("Not saved."), why),
        )  # fmt: skip

    # -- small things -----------------------------------------------------------------------------

    def _say(self, words: str, why: str) -> None:
        self._notice.ask(f"{words} {why}".strip(), [(self.tr("Close"), None)])

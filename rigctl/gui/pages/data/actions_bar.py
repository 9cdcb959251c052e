"""What can be done with the chosen brakings, each with its consequence in the tooltip.

Job: buttons, the line that asks for a reason or a tag, and the line that says what was done with [Undo].
Not its job: doing it (`Annotator`, `ExportBar`).
"""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from rigctl.gui.pages.data.entry import UNREADABLE, Entry
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.elided import ElidedLabel
from rigctl.gui.widgets.flow import FlowLayout
from rigctl.gui.widgets.inline import AskLine


class ActionsBar(QWidget):
    """For the selection of the table."""

    compare = Signal()
    excludeGiven = Signal(str)
    restore = Signal()
    tagGiven = Signal(str)
    trash = Signal()
    putBack = Signal()
    export = Signal()
    undo = Signal()

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._chosen: Sequence[Entry] = ()
        self.compare_button = self._button("compare", self.tr("&Compare"))
        self.exclude_button = self._button("exclude", self.tr("E&xclude…"))
        self.restore_button = self._button("restore", self.tr("Count &again"))
        self.tag_button = self._button("tag", self.tr("Ta&g…"))
        self.trash_button = self._button("trash", self.tr("Move to t&rash"))
        self.back_button = self._button("put-back", self.tr("Put &back"))
        self.export_button = self._button("export", self.tr("E&xport…"))
        self._tips()
        self.reason = AskLine(theme, "data-reason", self.tr("Exclude"))
        self.tag = AskLine(theme, "data-tag", self.tr("Add tag"))
        self.done = ElidedLabel()
        self.done.setObjectName("data-done")
        self.undo_button = QPushButton(self.tr("Undo"))
        self.undo_button.setObjectName("data-undo")
        self.undo_button.setToolTip(self.tr("Undo this (Ctrl+Z)"))
        done_row = QHBoxLayout()
        done_row.setContentsMargins(0, 0, 0, 0)
        done_row.addWidget(self.done, 1)
        done_row.addWidget(self.undo_button)
        self._flow = FlowLayout()
        for button in (
            self.compare_button, self.exclude_button, self.restore_button, self.tag_button, self.trash_button,
            self.back_button, self.export_button,
        ):  # fmt: skip
            self._flow.addWidget(button)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.addLayout(self._flow)
        for part, tip in (
            (self.reason, self.tr("Why these brakings must not count; the report prints it")),
            (self.tag, self.tr("Up to 40 letters, no comma")),
        ):
            part.edit.setToolTip(tip)
            part.done.setToolTip(self.tr("Enter"))
            self._column.addWidget(part)
        self._column.addLayout(done_row)
        self.compare_button.clicked.connect(self.compare)
        self.exclude_button.clicked.connect(self.ask_reason)
        self.restore_button.clicked.connect(self.restore)
        self.tag_button.clicked.connect(self.ask_tag)
        self.trash_button.clicked.connect(self.trash)
        self.back_button.clicked.connect(self.putBack)
        self.export_button.clicked.connect(self.export)
        self.undo_button.clicked.connect(self.undo)
        self.reason.given.connect(self.excludeGiven)
        self.tag.given.connect(self.tagGiven)
        theme.changed.connect(self._restyle)
        self._restyle()
        self.say("", can_undo=False)
        self.show_selection(())

    def _button(self, name: str, text: str) -> QPushButton:
        button = QPushButton(text)
        button.setObjectName(f"data-{name}")
        return button

    def _tips(self) -> None:
        for button, tip in (
            (
                self.compare_button,
                self.tr("Lay up to four brakings over each other; one more is added to them"),
            ),
            (
                self.exclude_button,
                self.tr(
                    "They stay in the list, struck through, and count in no statistics and no report. "
                    "Asks for the reason."
                ),
            ),
            (self.restore_button, self.tr("Excluded brakings count again")),
            (self.tag_button, self.tr("Add a short word for finding them again")),
            (
                self.trash_button,
                self.tr(
                    "Moves their files to the folder trash of the campaign; nothing is deleted. "
                    "“rigctl resume” would do these brakings again. Undo moves them back."
                ),
            ),
            (
                self.back_button,
                self.tr("Moves the files back from the trash; “rigctl resume” leaves them alone then"),
            ),
            (self.export_button, self.tr("WAV, CSV, MATLAB or HDF5 files in a folder of your choice")),
        ):
            button.setToolTip(tip)

    def _restyle(self) -> None:
        self._flow.setSpacing(self._theme.px(1))
        self._column.setSpacing(self._theme.px(1))

    def show_selection(self, chosen: Sequence[Entry]) -> None:
        """Enable what can be done with these."""
        self._chosen = chosen
        here = [entry for entry in chosen if not entry.trashed]
        readable = [entry for entry in here if entry.row.status != UNREADABLE]
        self.compare_button.setEnabled(1 <= len(readable) <= 4)
        self.exclude_button.setEnabled(any(not entry.row.excluded for entry in readable))
        self.restore_button.setVisible(any(entry.row.excluded for entry in here))
        self.tag_button.setEnabled(bool(readable))
        self.trash_button.setEnabled(bool(here))
        self.back_button.setVisible(any(entry.trashed for entry in chosen))
        self.export_button.setEnabled(any(entry.row.status != UNREADABLE for entry in chosen))

    def ask_reason(self) -> None:
        """Ask why the chosen brakings are to be excluded."""
        self.tag.cancel()
        count = sum(1 for entry in self._chosen if not entry.row.excluded and not entry.trashed)
        if count:
            one, many = self.tr("Exclude this braking. Why?"), self.tr("Exclude {0} brakings. Why?")
            self.reason.ask(one if count == 1 else many.format(count), self.tr("door slammed, wrong disc, …"))

    def ask_tag(self) -> None:
        """Ask for a tag for the chosen brakings."""
        self.reason.cancel()
        self.tag.ask(self.tr("Tag for {0} chosen").format(len(self._chosen)), self.tr("one short word"))

    def say(self, words: str, *, can_undo: bool, wrong: bool = False) -> None:
        """What was done or went wrong."""
        self.done.setText(("▲ " if wrong else "") + words)
        self.done.setToolTip(words)
        self.done.setProperty("look", "error" if wrong else "muted")
        self.done.style().polish(self.done)
        self.done.setVisible(bool(words))
        self.undo_button.setVisible(can_undo and bool(words))

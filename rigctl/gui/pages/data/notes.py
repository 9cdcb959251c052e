"""What people say about a braking: tags, note, noise rating, and what was said when it was recorded.

Job: fields for the braking that is open; what is given goes to the `Annotator`. Not its job: writing it.
"""

from __future__ import annotations

from PySide6.QtCore import QStringListModel, Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QCompleter,
    QFormLayout,
    QLabel,
    QLineEdit,
    QVBoxLayout,
    QWidget,
)

from rigctl.core.errors import ConfigError
from rigctl.gui.pages.data.entry import Entry
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.field_grid import FaultLabel, set_wrong
from rigctl.gui.widgets.rating_row import RATINGS
from rigctl.recording.annotations import Action, checked_value


class TagField(QWidget):
    """Tags, separated by commas. `value()` is a tuple of tags in alphabetical order."""

    valueChanged = Signal(tuple)
    """A person has finished editing; all tags can be used."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self.edit = QLineEdit()
        self.edit.setObjectName("data-tags")
        self.edit.setPlaceholderText(self.tr("cold, check again"))
        self.edit.setToolTip(self.tr("Short words for finding brakings again, separated by commas"))
        self.fault = FaultLabel(theme)
        self.fault.setObjectName("data-tags-error")
        self._known = QStringListModel(self)
        completer = QCompleter(self._known, self)
        completer.setCaseSensitivity(Qt.CaseSensitivity.CaseInsensitive)
        self.edit.setCompleter(completer)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.edit)
        column.addWidget(self.fault)
        self._last: tuple[str, ...] = ()
        self.edit.editingFinished.connect(self._on_finished)
        self.edit.textEdited.connect(self._check)

    def value(self) -> tuple[str, ...]:
        """The tags."""
        return tuple(sorted({" ".join(word.split()) for word in self.edit.text().split(",") if word.strip()}))

    def setValue(self, tags: tuple[str, ...]) -> None:
        """Show tags."""
        self._last = tuple(sorted(tags))
        if self.value() != self._last:
            self.edit.setText(", ".join(self._last))
        self._check()

    def set_known(self, tags: list[str]) -> None:
        """Tags to be offered while typing."""
        self._known.setStringList(tags)

    def _check(self) -> bool:
        problem = ""
        for tag in self.value():
            try:
                checked_value(Action.TAG, tag)
            except ConfigError as error:
                problem = str(error)
        set_wrong(self.edit, "error" if problem else "")
        self.fault.setFault(problem)
        return not problem

    def _on_finished(self) -> None:
        tags = self.value()
        if self._check() and tags != self._last:
            self._last = tags
            self.valueChanged.emit(tags)


class NotesPanel(QWidget):
    """Fields and marks of one braking."""

    tagsGiven = Signal(object, list, list)
    """Entry, tags to add, tags to remove."""
    noteGiven = Signal(object, str)
    ratingGiven = Signal(object, object)

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._entry: Entry | None = None
        self.tags = TagField(theme)
        self.note = QLineEdit()
        self.note.setObjectName("data-note")
        self.note.setMaxLength(2000)
        self.note.setPlaceholderText(self.tr("What was seen or heard; Enter saves"))
        self.note.setToolTip(self.tr("A note for this braking; the journal keeps who wrote it and when"))
        self.said = QLabel()
        self.said.setWordWrap(True)
        self.said.setTextFormat(Qt.TextFormat.PlainText)
        self.said.setProperty("look", "muted")
        self.rating = QComboBox()
        self.rating.setObjectName("data-rating")
        self.rating.setToolTip(self.tr("Subjective noise rating of this braking"))
        ends = {1: self.tr("1  nothing heard"), 5: self.tr("5  clearly heard"), 9: self.tr("9  unbearable")}
        self.rating.addItem(self.tr("not rated"), None)
        for number in RATINGS:
            self.rating.addItem(ends.get(number, str(number)), number)
        self._form = QFormLayout()
        self._form.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.ExpandingFieldsGrow)
        self._form.addRow(self.tr("Ta&gs"), self.tags)
        self._form.labelForField(self.tags).setBuddy(self.tags.edit)  # type: ignore[union-attr]
        self._form.addRow(self.tr("N&ote"), self.note)
        self._form.addRow(self.tr("Ra&ting"), self.rating)
        self._form.addRow(self.tr("Said then"), self.said)
        self._column = QVBoxLayout(self)
        self._column.addLayout(self._form)
        self._column.addStretch(1)
        self.tags.valueChanged.connect(self._on_tags)
        self.note.editingFinished.connect(self._on_note)
        self.rating.activated.connect(self._on_rating)
        self._note_before = ""
        theme.changed.connect(self._restyle)
        self._restyle()
        self.show_entry(None, (), "")

    def _restyle(self) -> None:
        u = self._theme.px
        self._column.setContentsMargins(u(1), u(1), u(1), u(1))
        self._column.setSpacing(u(1))
        self._form.setHorizontalSpacing(u(1))
        self._form.setVerticalSpacing(u(0.5))

    def show_entry(self, entry: Entry | None, said: tuple[str, ...], note: str) -> None:
        """Another braking, or other words about it; what is being typed about the same one stays."""
        same = entry is not None and self._entry is not None and entry.name == self._entry.name
        self._entry = entry
        for widget in (self.tags, self.note, self.rating):
            widget.setEnabled(entry is not None and not entry.trashed)
        if not (same and self.tags.edit.hasFocus()):
            self.tags.setValue(entry.row.tags if entry else ())
        if not (same and self.note.hasFocus() and self.note.isModified()):
            self.note.setText(note)
            self.note.setCursorPosition(0)
        self._note_before = note
        place = self.rating.findData(entry.row.rating if entry else None)
        self.rating.setCurrentIndex(max(place, 0))
        self.said.setText(" · ".join(said))
        self._form.setRowVisible(self.said, bool(said))

    def _on_tags(self, tags: tuple[str, ...]) -> None:
        if self._entry is not None:
            old = set(self._entry.row.tags)
            self.tagsGiven.emit(self._entry, sorted(set(tags) - old), sorted(old - set(tags)))

    def _on_note(self) -> None:
        text = self.note.text().strip()
        if self._entry is not None and text != self._note_before:
            self._note_before = text
            self.note.setModified(False)
            self.noteGiven.emit(self._entry, text)

    def _on_rating(self) -> None:
        rating = self.rating.currentData()
        if self._entry is not None and rating != self._entry.row.rating:
            self.ratingGiven.emit(self._entry, rating)

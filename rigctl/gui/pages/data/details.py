"""Tables below the plots of a braking: events, marks, results, metadata.

Job: show lines of text; say which event was chosen. Not its job: words and numbers (`results`), `notes`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableWidget, QTableWidgetItem

from rigctl.gui.format import number_text
from rigctl.gui.pages.data.marks import Mark
from rigctl.gui.theme import ThemeKeeper

_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


class LinesTable(QTableWidget):
    """A few lines of text; columns named in `right` are right-aligned. Ctrl+C copies the selection."""

    def __init__(
        self, theme: ThemeKeeper, name: str, titles: Sequence[str], right: Sequence[int] = ()
    ) -> None:
        super().__init__(0, len(titles))
        self.setObjectName(name)
        self._theme = theme
        self._right = set(right)
        self.setHorizontalHeaderLabels(list(titles))
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setAlternatingRowColors(True)
        self.setShowGrid(False)
        self.setTabKeyNavigation(False)
        self.verticalHeader().hide()
        for column in range(len(titles)):
            side = (
                _RIGHT
                if column in self._right
                else Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
            )
            title = self.horizontalHeaderItem(column)
            if title is not None:
                title.setTextAlignment(side)
        header = self.horizontalHeader()
        header.setStretchLastSection(True)
        header.setHighlightSections(False)
        header.setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self.verticalHeader().setDefaultSectionSize(self._theme.px(3))
        self.verticalHeader().setMinimumSectionSize(self._theme.px(2))

    def show_lines(self, lines: Sequence[Sequence[str]]) -> None:
        """Replace all lines."""
        self.clearSelection()
        self.setRowCount(len(lines))
        for row, line in enumerate(lines):
            for column, text in enumerate(line):
                item = QTableWidgetItem(text)
                item.setToolTip(text)
                if column in self._right:
                    item.setTextAlignment(_RIGHT)
                self.setItem(row, column, item)
        self.resizeColumnsToContents()

    def lines(self) -> list[list[str]]:
        """What is shown."""
        found = []
        for row in range(self.rowCount()):
            items = [self.item(row, column) for column in range(self.columnCount())]
            found.append([item.text() if item is not None else "" for item in items])
        return found


class EventsTable(LinesTable):
    """Noise events; choosing one shows its time."""

    chosen = Signal(float, float)
    """Start and end of the event, s."""

    def __init__(self, theme: ThemeKeeper) -> None:
        titles = (
            self.tr("Squeal\nHz"), self.tr("Level\ndB"), self.tr("Level A\ndB(A)"), self.tr("Start\ns"),
            self.tr("Length\ns"), "p\nbar", "T\n°C", "n\n1/min", "µ\n", "",
        )  # fmt: skip
        super().__init__(theme, "data-events", titles, right=range(9))
        self._times: list[tuple[float, float] | None] = []
        self.setToolTip(self.tr("Noise events; click one to see it in time"))
        self.itemSelectionChanged.connect(self._on_selected)

    def show_events(self, events: dict[str, list[Any]]) -> None:
        """Columns of the table of events as the braking file has them."""
        names = (
            ("frequency_hz", 0), ("level_db", 1), ("level_dba", 1), ("start_s", 2), ("duration_s", 2),
            ("pressure_bar", 1), ("temperature_degc", 0), ("speed_rpm", 1), ("mu", 3),
        )  # fmt: skip
        count = len(events.get("frequency_hz", ()))
        nothing: list[Any] = [None] * count
        lines: list[list[str]] = []
        self._times = []
        for row in range(count):
            harmonic = events.get("harmonic_of", nothing)[row] not in (None, -1)
            cells = [number_text(events.get(name, nothing)[row], decimals) for name, decimals in names]
            lines.append([*cells, self.tr("harmonic") if harmonic else ""])
            start, length = events.get("start_s", nothing)[row], events.get("duration_s", nothing)[row]
            self._times.append(None if start is None or length is None else (start, start + length))
        self.show_lines(lines)

    def _on_selected(self) -> None:
        rows = {index.row() for index in self.selectedIndexes()}
        if len(rows) == 1 and (times := self._times[rows.pop()]) is not None:
            self.chosen.emit(*times)


class MarksTable(LinesTable):
    """What happened while the braking was recorded; choosing a mark shows its time."""

    chosen = Signal(float, float)

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__(theme, "data-marks", (self.tr("Time\ns"), self.tr("What happened")), right=(0,))
        self._times: list[float] = []
        self.setToolTip(self.tr("Marks of the recording; click one to see it in time"))
        self.itemSelectionChanged.connect(self._on_selected)

    def show_marks(self, marks: Sequence[Mark]) -> None:
        """Marks in order of time."""
        self._times = [mark.time_s for mark in marks]
        self.show_lines([(number_text(mark.time_s, 2), mark.words) for mark in marks])

    def _on_selected(self) -> None:
        rows = {index.row() for index in self.selectedIndexes()}
        if len(rows) == 1:
            time_s = self._times[rows.pop()]
            self.chosen.emit(time_s, time_s)

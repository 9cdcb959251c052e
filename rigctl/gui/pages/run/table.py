"""The table of brakings: 10,000 rows stay fast, the present one is followed until somebody scrolls.

Job: a Qt model over the rows of `RunModel`, and a view that follows. Not its job: the rows.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt, Signal
from PySide6.QtGui import QFont, QFontMetrics, QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView

from rigctl.gui.format import frequency_text, number_text
from rigctl.gui.pages.run.model import RunModel
from rigctl.gui.pages.run.rows import NOT_DONE, UNDER_WAY, Row, RowState
from rigctl.gui.theme import ThemeKeeper

Index = QModelIndex | QPersistentModelIndex
NO_PARENT = QModelIndex()
NUMBER, SEQUENCE, STATE, TEMPERATURE, SPEED, PRESSURE, MU, LEVEL, FREQUENCY, RATING, NOTE = range(11)
_WIDEST = ("0000", "Sequence", "● conditioning", "000.0", "0000", "00.00", "0.000", "Squeal", "frequency",
           "rating", "a note")  # fmt: skip
_KEYS = (Qt.Key.Key_Up, Qt.Key.Key_Down, Qt.Key.Key_PageUp, Qt.Key.Key_PageDown, Qt.Key.Key_Home,
         Qt.Key.Key_End)  # fmt: skip
_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


class BrakingTableModel(QAbstractTableModel):
    """Rows of a `RunModel` as text."""

    def __init__(self, theme: ThemeKeeper, run: RunModel) -> None:
        super().__init__()
        self._theme = theme
        self._run = run
        self._bold = QFont()
        self._bold.setBold(True)
        self._titles = (
            self.tr("No."), self.tr("Sequence"), self.tr("State"), self.tr("T\n°C"), self.tr("n\n1/min"),
            self.tr("p\nbar"), self.tr("mu\nmean"), self.tr("Squeal\ndB"), self.tr("Squeal\nfrequency"),
            self.tr("Noise\nrating"), self.tr("Note"),
        )  # fmt: skip
        self._tips = (
            self.tr("Number in the program"),
            self.tr("Sequence of the program"),
            self.tr("What has become of the braking"),
            self.tr(
                "Set-point of the disc temperature at the start; (measured) where the disc is taken as it is"
            ),
            self.tr("Set-point of the speed, at the beginning → at the end"),
            self.tr("Set-point of the pressure"),
            self.tr("Mean coefficient of friction"),
            self.tr("Level of the loudest squeal; none: judged without squeal"),
            self.tr("Frequency of the loudest squeal"),
            self.tr("Subjective noise rating, keys 1 to 9"),
            self.tr("What the operator has said (key N), and why it is not complete"),
        )
        self._words = {
            RowState.WAITING: self.tr("waiting"),
            RowState.CONDITIONING: self.tr("● conditioning"),
            RowState.BRAKING: self.tr("● braking"),
            RowState.COMPLETE: self.tr("✓ complete"),
            RowState.INCOMPLETE: self.tr("▲ incomplete"),
            RowState.SKIPPED: self.tr("↷ skipped"),
            RowState.RECOVERED: self.tr("▲ recovered"),
        }
        self._none = self.tr("none")

    # -- QAbstractTableModel ----------------------------------------------------------------------

    def rowCount(self, parent: Index = NO_PARENT) -> int:
        """See Qt."""
        return 0 if parent.isValid() else len(self._run.rows)

    def columnCount(self, parent: Index = NO_PARENT) -> int:
        """See Qt."""
        return 0 if parent.isValid() else len(self._titles)

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        """Names with units."""
        if orientation is not Qt.Orientation.Horizontal:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return self._titles[section]
        return self._tips[section] if role == Qt.ItemDataRole.ToolTipRole else None

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """Text, alignment, and colours that come with a shape."""
        row, column = self._run.rows[index.row()], index.column()
        if role == Qt.ItemDataRole.DisplayRole:
            return self.text(row, column)
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return _LEFT if column in (SEQUENCE, STATE, NOTE) else _RIGHT
        if role == Qt.ItemDataRole.ToolTipRole:
            return row.note if column in (STATE, NOTE) and row.note else None
        return self._look(row, column, role)

    def _look(self, row: Row, column: int, role: int) -> Any:
        t = self._theme
        not_done = row.state in NOT_DONE and row.state is not RowState.SKIPPED
        if role == Qt.ItemDataRole.FontRole:
            return self._bold if row.state in UNDER_WAY else None
        if role == Qt.ItemDataRole.BackgroundRole:
            return t.colour("amber") if column == STATE and not_done else None
        if role == Qt.ItemDataRole.ForegroundRole:
            if column == STATE and not_done:
                return t.colour("on_amber")
            return t.colour("muted") if row.state in (RowState.WAITING, RowState.SKIPPED) else None
        return None

    def text(self, row: Row, column: int) -> str:
        """One cell as text."""
        if column in (MU, LEVEL, FREQUENCY, RATING):
            return self._result(row, column)
        values = {
            NUMBER: lambda: str(row.index),
            SEQUENCE: lambda: row.sequence,
            STATE: lambda: self._words[row.state],
            TEMPERATURE: lambda: _temperature(row),
            SPEED: lambda: _speed(row),
            PRESSURE: lambda: _plain(row.pressure_bar),
            NOTE: lambda: row.note,
        }
        return values[column]()

    def _result(self, row: Row, column: int) -> str:
        if column == RATING:
            return str(row.rating) if row.rating else ""
        if column == MU:
            return "" if row.mean_mu is None else number_text(row.mean_mu, 3)
        if column == LEVEL:
            if row.squeal_level_db is not None:
                return number_text(row.squeal_level_db, 1)
            return self._none if row.judged else ""
        return "" if row.squeal_frequency_hz is None else frequency_text(row.squeal_frequency_hz)

    # -- news -------------------------------------------------------------------------------------

    def reset(self, run: RunModel) -> None:
        """Another campaign."""
        self.beginResetModel()
        self._run = run
        self.endResetModel()

    def grown(self, before: int) -> None:
        """Rows have been appended to the run after the first `before`."""
        if len(self._run.rows) > before:
            self.beginInsertRows(QModelIndex(), before, len(self._run.rows) - 1)
            self.endInsertRows()

    def changed(self, places: Iterable[int]) -> None:
        """Rows have changed; one signal for each stretch."""
        for first, last in stretches(sorted(places)):
            self.dataChanged.emit(self.index(first, 0), self.index(last, len(self._titles) - 1))

    def titles(self) -> tuple[str, ...]:
        """Names of the columns."""
        return self._titles


def stretches(places: list[int]) -> list[tuple[int, int]]:
    """Ascending places as stretches (first, last) without gaps."""
    found: list[tuple[int, int]] = []
    for place in places:
        if found and found[-1][1] + 1 == place:
            found[-1] = (found[-1][0], place)
        else:
            found.append((place, place))
    return found


def _plain(value: float | None) -> str:
    return "—" if value is None else f"{value:g}"


def _temperature(row: Row) -> str:
    if row.temperature_degc is None and row.start_degc is not None:
        return f"({row.start_degc:.0f})"
    return _plain(row.temperature_degc)


def _speed(row: Row) -> str:
    if row.speed_rpm is None:
        return "—"
    if row.end_speed_rpm is None or row.end_speed_rpm == row.speed_rpm:
        return f"{row.speed_rpm:.0f}"
    return f"{row.speed_rpm:.0f} → {row.end_speed_rpm:.0f}"


class BrakingTable(QTableView):
    """Follows the present braking until somebody scrolls or moves the selection."""

    followChanged = Signal(bool)
    opened = Signal(int)
    """A row was double-clicked or Enter was pressed on it: its place."""

    def __init__(self, theme: ThemeKeeper, model: BrakingTableModel) -> None:
        super().__init__()
        self.setObjectName("run-table")
        self._theme = theme
        self._follow = True
        self._place = -1
        self.setModel(model)
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        self.setAlternatingRowColors(True)
        self.setShowGrid(False)
        self.setWordWrap(False)
        self.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setTabKeyNavigation(False)
        self.verticalHeader().hide()
        self.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        self.horizontalHeader().setStretchLastSection(True)
        self.horizontalHeader().setHighlightSections(False)
        self.doubleClicked.connect(lambda index: self.opened.emit(index.row()))
        self.verticalScrollBar().actionTriggered.connect(self._scrolled_by_hand)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        metrics = QFontMetrics(self._theme.font("normal", bold=True))
        self.verticalHeader().setDefaultSectionSize(metrics.height() + self._theme.px(1))
        model = self.model()
        for column, text in enumerate(_WIDEST):
            words = [text, *str(model.headerData(column, Qt.Orientation.Horizontal) or "").splitlines()]
            widest = max(metrics.horizontalAdvance(word) for word in words)
            self.setColumnWidth(column, widest + self._theme.px(1))

    def fit(self, rows: Sequence[Row]) -> None:
        """Columns as wide as names and speeds of these rows want."""
        metrics = QFontMetrics(self._theme.font("normal", bold=True))
        names = {row.sequence for row in rows}
        speeds = {_speed(row) for row in rows}
        for column, texts in ((SEQUENCE, names), (SPEED, speeds)):
            widest = max((metrics.horizontalAdvance(text) for text in texts), default=0)
            wanted = min(widest + self._theme.px(1.5), self._theme.px(20))
            self.setColumnWidth(column, max(wanted, self.columnWidth(column)))

    # -- following --------------------------------------------------------------------------------

    def follows(self) -> bool:
        """True while the present braking is kept in sight."""
        return self._follow

    def setFollow(self, follow: bool) -> None:
        """Keep the present braking in sight, or let the person look elsewhere."""
        if follow != self._follow:
            self._follow = follow
            self.followChanged.emit(follow)
        if follow:
            self.show_present(self._place)

    def place(self) -> int:
        """Where the present braking is, -1 before the first."""
        return self._place

    def show_present(self, place: int) -> None:
        """The present braking's place; scrolled to while following."""
        self._place = place
        if self._follow and 0 <= place < self.model().rowCount():
            self.scrollTo(self.model().index(place, 0), QAbstractItemView.ScrollHint.PositionAtCenter)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """The present braking stays in sight while following."""
        super().resizeEvent(event)
        self.show_present(self._place)

    def _scrolled_by_hand(self, _action: int) -> None:
        self.setFollow(False)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Cursor keys look elsewhere; Enter opens the braking."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.currentIndex().isValid():
            self.opened.emit(self.currentIndex().row())
            return
        if event.key() in _KEYS:
            self.setFollow(False)
        super().keyPressEvent(event)

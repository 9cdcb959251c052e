"""The ranking of design modifications as a table whose numbers are bars, too.

Job: table model, delegate, view. Not its job: asking for the ranking.
"""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, QRect, Qt, Signal
from PySide6.QtGui import QColor, QKeyEvent, QPainter
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableView,
)

from rigctl.gui.format import number_text
from rigctl.gui.pages.model.data import Advice, Ranking
from rigctl.gui.pages.model.words import advice_text, verdict_text
from rigctl.gui.theme import ThemeKeeper

Index = QModelIndex | QPersistentModelIndex
_MARKS = {"recommended": "✔", "with care": "▲", "no effect": "–", "not recommended": "✖"}
VERDICT, TITLE, GAIN, ONSET, RISE, RISE_HZ = range(6)
#: role of a number that is drawn as a bar: share of the largest in its column, −1…1
BAR = int(Qt.ItemDataRole.UserRole)


class RankingRows(QAbstractTableModel):
    """Modifications as rows, best first."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.ranking: Ranking | None = None
        self.rows: tuple[Advice, ...] = ()
        self._scale = {GAIN: 1.0, ONSET: 1.0, RISE: 1.0}

    def show(self, ranking: Ranking | None, *, helpful_only: bool = False) -> None:
        """Show a ranking, all of it or what helps."""
        self.beginResetModel()
        self.ranking = ranking
        rows = () if ranking is None else ranking.rows
        self.rows = tuple(r for r in rows if not helpful_only or r.verdict in ("recommended", "with care"))
        for column in self._scale:
            sizes = [abs(value) for row in self.rows if (value := self.number(row, column)) is not None]
            self._scale[column] = max(sizes, default=0.0) or 1.0
        self.endResetModel()

    def number(self, row: Advice, column: int) -> float | None:
        """Number of a column that is drawn as a bar."""
        if column == GAIN:
            return row.gain_1_s
        if column == ONSET:
            return None if self.ranking is None else self.ranking.change_bar(row)
        return 100.0 * row.worst_rise if column == RISE else None

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008 Qt's signature
        """Rows."""
        return 0 if parent.isValid() else len(self.rows)

    def columnCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        """Columns."""
        return 0 if parent.isValid() else 6

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> Any:
        """Names with units."""
        if orientation != Qt.Orientation.Horizontal:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return (
                self.tr("Verdict"), self.tr("Modification"), self.tr("Gain\n[1/s]"), self.tr("Onset\n[bar]"),
                self.tr("Worst\nrise [%]"), self.tr("of mode\nat [Hz]"),
            )[section]  # fmt: skip
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return int(_alignment(section))
        return None

    def data(self, index: Index, role: int = 0) -> Any:
        """Texts and looks."""
        row, column = self.rows[index.row()], index.column()
        roles = Qt.ItemDataRole
        found: Any = None
        if role == roles.DisplayRole:
            found = self._text(row, column)
        elif role == BAR:
            number = self.number(row, column)
            found = None if number is None else number / self._scale[column]
        elif role == roles.ToolTipRole and self.ranking is not None:
            found = advice_text(row, self.ranking)
        elif role == roles.TextAlignmentRole:
            found = int(_alignment(column))
        elif role == roles.ForegroundRole and row.verdict == "no effect":
            found = QColor(self._theme.current.muted)
        elif role == roles.FontRole and column == TITLE and row.verdict == "recommended":
            found = self._theme.font("normal", bold=True)
        return found

    def _text(self, row: Advice, column: int) -> str:
        if column == VERDICT:
            return f"{_MARKS[row.verdict]} {verdict_text(row.verdict)}"
        if column == TITLE:
            return row.title
        if column == RISE_HZ:
            return number_text(row.rise_hz, 0)
        return number_text(self.number(row, column), 2 if column != GAIN else 1)


class BarDelegate(QStyledItemDelegate):
    """A number over a bar from the middle: right for more, left for less."""

    def __init__(self, theme: ThemeKeeper, view: QTableView) -> None:
        super().__init__(view)
        self._theme = theme

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        """The cell as always, then the bar at its lower edge."""
        super().paint(painter, option, index)
        share = index.data(BAR)
        if share is None:
            return
        cell: QRect = getattr(option, "rect")  # noqa: B009 not in PySide's stubs
        thick, inset = self._theme.px(0.5), self._theme.px(0.5)
        half = cell.width() // 2 - inset
        middle = cell.x() + cell.width() // 2
        length = round(abs(share) * half)
        left = middle if share >= 0.0 else middle - length
        t = self._theme.current
        painter.fillRect(QRect(left, cell.bottom() - thick, max(length, 1), thick), QColor(t.muted))
        painter.fillRect(QRect(middle, cell.y() + 2, 1, cell.height() - 4), QColor(t.line))


class RankingTable(QTableView):
    """`chosen`: another row is selected; `applied`: Enter or double click."""

    chosen = Signal(object)
    applied = Signal()

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.rows = RankingRows(theme)
        self.setModel(self.rows)
        self.setAccessibleName(self.tr("Ranking of modifications"))
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setShowGrid(False)
        self.setTabKeyNavigation(False)
        self.setWordWrap(False)
        self.verticalHeader().hide()
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        header.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        header.setSectionResizeMode(TITLE, QHeaderView.ResizeMode.Stretch)
        self._bars = BarDelegate(theme, self)
        for column in (GAIN, ONSET, RISE):
            self.setItemDelegateForColumn(column, self._bars)
        self.selectionModel().currentRowChanged.connect(self._on_row)
        self.doubleClicked.connect(self._on_double)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        px = self._theme.px
        self.verticalHeader().setDefaultSectionSize(px(3.75))
        for column, width in ((VERDICT, 18), (GAIN, 13), (ONSET, 13), (RISE, 13), (RISE_HZ, 9)):
            self.setColumnWidth(column, px(width))

    def value(self) -> Advice | None:
        """The modification that is selected."""
        row = self.currentIndex().row()
        return self.rows.rows[row] if 0 <= row < len(self.rows.rows) else None

    def show_ranking(self, ranking: Ranking | None, *, helpful_only: bool = False) -> None:
        """Show a ranking; its best row is selected."""
        self.rows.show(ranking, helpful_only=helpful_only)
        if self.rows.rows:
            self.selectRow(0)
        else:
            self.chosen.emit(None)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter applies."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.value() is not None:
            self.applied.emit()
            return
        super().keyPressEvent(event)

    def _on_row(self, index: QModelIndex, _before: QModelIndex) -> None:
        if index.isValid():
            self.chosen.emit(self.rows.rows[index.row()])

    def _on_double(self, _index: QModelIndex) -> None:
        self.applied.emit()


def _alignment(column: int) -> Qt.AlignmentFlag:
    left = column in (VERDICT, TITLE)
    side = Qt.AlignmentFlag.AlignLeft if left else Qt.AlignmentFlag.AlignRight
    return side | Qt.AlignmentFlag.AlignVCenter

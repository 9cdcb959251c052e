"""The shown brakings as a Qt table model: text, alignment, strike-through. No widget per row.

Job: cells of `BrakingList` for a QTableView, and the smallest news that describe a change. Not its job:
choosing rows (`listing`), columns (`columns`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt
from PySide6.QtGui import QFont

from rigctl.gui.pages.data.columns import BY_KEY, COLUMNS, Column
from rigctl.gui.pages.data.entry import EXCLUDED, TRASHED, UNREADABLE, Entry
from rigctl.gui.pages.data.listing import BrakingFilter, BrakingList
from rigctl.gui.theme import ThemeKeeper

Index = QModelIndex | QPersistentModelIndex
_ROOT = QModelIndex()
_RIGHT = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
_LEFT = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)


class BrakingTableModel(QAbstractTableModel):
    """Rows: shown brakings; columns: all of `COLUMNS` (the view hides those not wanted)."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self.list = BrakingList()
        self._theme = theme
        self._struck = QFont()
        theme.changed.connect(self._restyle)
        self._restyle()

    # -- Qt's questions -----------------------------------------------------------------------------

    def rowCount(self, parent: Index = _ROOT) -> int:
        """Shown brakings."""
        return 0 if parent.isValid() else len(self.list.visible)

    def columnCount(self, parent: Index = _ROOT) -> int:
        """All columns."""
        return 0 if parent.isValid() else len(COLUMNS)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """One cell."""
        if not index.isValid():
            return None
        entry, column = self.list.visible[index.row()], COLUMNS[index.column()]
        answer: Any = None
        if role == Qt.ItemDataRole.DisplayRole:
            answer = column.text(entry)
        elif role == Qt.ItemDataRole.TextAlignmentRole:
            answer = _RIGHT if column.is_number else _LEFT
        elif role == Qt.ItemDataRole.ForegroundRole and not entry.counts:
            answer = self._theme.colour("muted")
        elif role == Qt.ItemDataRole.FontRole and entry.state in (EXCLUDED, TRASHED):
            answer = self._struck
        elif role == Qt.ItemDataRole.ToolTipRole:
            answer = self._tip(entry, column)
        return answer

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        """Title and unit."""
        if orientation != Qt.Orientation.Horizontal:
            return None
        column = COLUMNS[section]
        if role == Qt.ItemDataRole.DisplayRole:
            return self._header(column)
        if role == Qt.ItemDataRole.ToolTipRole:
            return column.tip_text() + "\n" + self.tr("Click: sort. Right click: choose columns.")
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return _RIGHT if column.is_number else _LEFT
        return None

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        """Called by the view when a header is clicked."""

        def change() -> None:
            self.list.sort_by = COLUMNS[column].key
            self.list.descending = order == Qt.SortOrder.DescendingOrder
            self.list.arrange()

        self._change(change)
        self.headerDataChanged.emit(Qt.Orientation.Horizontal, 0, len(COLUMNS) - 1)

    # -- changes ------------------------------------------------------------------------------------

    def replace_all(self, entries: Iterable[Entry]) -> None:
        """Another campaign."""
        self.beginResetModel()
        self.list.replace_all(entries)
        self.endResetModel()

    def put(self, entries: Iterable[Entry], gone: Iterable[str] = ()) -> None:
        """New, changed and vanished entries."""
        self._change(lambda: self.list.put(entries, gone))

    def set_filter(self, wanted: BrakingFilter) -> None:
        """Show others."""
        if wanted != self.list.filter:
            self.list.filter = wanted
            self._change(self.list.arrange)

    def entry(self, row: int) -> Entry:
        """The entry in a row."""
        return self.list.visible[row]

    def _change(self, change: Callable[[], None]) -> None:
        """Tell Qt the least: cells changed, rows added at the end, else everything anew."""
        shown = self.list.visible
        old = [entry.name for entry in shown]
        change()
        arranged = self.list.visible
        new = [entry.name for entry in arranged]
        if new == old:
            different = [row for row, (a, b) in enumerate(zip(shown, arranged, strict=True)) if a is not b]
            if different:
                first, last = self.index(different[0], 0), self.index(different[-1], len(COLUMNS) - 1)
                self.dataChanged.emit(first, last)
        elif old and new[: len(old)] == old:
            self.list.visible = arranged[: len(old)]
            self.beginInsertRows(QModelIndex(), len(old), len(new) - 1)
            self.list.visible = arranged
            self.endInsertRows()
        else:
            self.list.visible = shown
            self.beginResetModel()
            self.list.visible = arranged
            self.endResetModel()

    def _header(self, column: Column) -> str:
        if column.key != self.list.sort_by:
            return column.header_text()
        first, *rest = column.header_text().split("\n")
        return "\n".join([f"{first} {'▾' if self.list.descending else '▴'}", *rest])

    # -- look ---------------------------------------------------------------------------------------

    def _restyle(self) -> None:
        self._struck = self._theme.font()
        self._struck.setStrikeOut(True)
        if self.list.visible:
            last = self.index(len(self.list.visible) - 1, len(COLUMNS) - 1)
            self.dataChanged.emit(self.index(0, 0), last)

    def _tip(self, entry: Entry, column: Column) -> str:
        row = entry.row
        if row.status == UNREADABLE:
            return row.note
        lines = []
        if entry.trashed:
            lines.append(self.tr("In the trash: “rigctl resume” would do this braking again."))
        if row.excluded:
            lines.append(self.tr("Excluded, does not count: {0} ({1})").format(row.excluded, row.excluded_by))
        if column.key in ("remark", "tags", "sequence"):
            lines.append(BY_KEY[column.key].text(entry))
        if not row.complete and row.note:
            lines.append(row.note)
        return "\n".join(line for line in lines if line)

"""A list of numbers, or of rows of numbers, edited like a sheet: typed, pasted, copied; wrong cells framed.

Job: raw texts in cells, one empty row at the end to go on; several numbers typed or pasted at once fill
several rows. A grouped table has a mark for rows that go on with the one above. Not its job: what the
numbers mean.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QObject, QPersistentModelIndex, Qt, Signal
from PySide6.QtGui import QAction, QColor, QKeyEvent, QKeySequence, QPainter, QPen
from PySide6.QtWidgets import (
    QAbstractItemDelegate,
    QAbstractItemView,
    QApplication,
    QHeaderView,
    QLineEdit,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableView,
    QWidget,
)

from rigctl.gui.theme import ThemeKeeper

Index = QModelIndex | QPersistentModelIndex
Row = tuple[str, ...]
"""Mark ("" or "+"), then the cells."""
Parse = Callable[[str, int], list[list[str]]]
"""(text, columns) -> rows of a mark and at most that many cells."""
MOST_ROWS = 2000
_HINT = QAbstractItemDelegate.EndEditHint


class ValuesModel(QAbstractTableModel):
    """Rows of texts. `edited` tells that a person has changed them."""

    edited = Signal()

    def __init__(self, heads: tuple[str, ...], parse: Parse, grouped: bool, parent: QObject) -> None:
        super().__init__(parent)
        self._heads = heads
        self._parse = parse
        self.grouped = grouped
        self.rows: list[Row] = []
        self.faults: dict[tuple[int, int], str] = {}

    @property
    def columns(self) -> int:
        """Cells of a row."""
        return len(self._heads)

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008  Qt's own default
        """See QAbstractItemModel."""
        return 0 if parent.isValid() else len(self.rows) + 1

    def columnCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        """See QAbstractItemModel."""
        return 0 if parent.isValid() else self.columns

    def flags(self, index: Index) -> Qt.ItemFlag:
        """See QAbstractItemModel."""
        return Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsEditable

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        """See QAbstractItemModel."""
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        if role == Qt.ItemDataRole.ToolTipRole:
            return self.faults.get((index.row(), index.column()))
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.EditRole) and index.row() < len(self.rows):
            return self.rows[index.row()][index.column() + 1]
        return None

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> Any:
        """Names of the columns; numbers of the groups, "+" where a row goes on with the one above."""
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        if role != Qt.ItemDataRole.DisplayRole:
            return None
        if orientation == Qt.Orientation.Horizontal:
            return self._heads[section]
        if section >= len(self.rows):
            return "…"
        if section and self.rows[section][0]:
            return "+"
        return str(sum(1 for number, row in enumerate(self.rows[: section + 1]) if not row[0] or not number))

    def set_rows(self, rows: tuple[Row, ...]) -> None:
        """Show rows; not an edit."""
        if tuple(self.rows) != rows:
            self._replace(list(rows))

    def _replace(self, rows: list[Row]) -> None:
        """Grow or shrink at the end, never reset: an editor that is just committing stays valid."""
        old, new = len(self.rows), len(rows)
        if new > old:
            self.beginInsertRows(QModelIndex(), old + 1, new)
            self.rows = rows
            self.endInsertRows()
        elif new < old:
            self.beginRemoveRows(QModelIndex(), new + 1, old)
            self.rows = rows
            self.endRemoveRows()
        self.rows = rows
        self.dataChanged.emit(self.index(0, 0), self.index(new, self.columns - 1))
        self.headerDataChanged.emit(Qt.Orientation.Vertical, 0, new)

    def set_faults(self, faults: Mapping[tuple[int, int], str]) -> None:
        """Cells that are wrong, and why."""
        if faults != self.faults:
            self.faults = dict(faults)
            self.dataChanged.emit(self.index(0, 0), self.index(len(self.rows), self.columns - 1))

    def setData(self, index: Index, value: Any, role: int = Qt.ItemDataRole.EditRole) -> bool:
        """Take what was typed: one number, or several for several cells."""
        text = str(value).strip()
        shown = self.data(index) or ""
        if role != Qt.ItemDataRole.EditRole or text == shown:
            return False
        block = self._parse(text, self.columns) if text else [["", ""]]
        self.put(index.row(), index.column(), block)
        return True

    def put(self, row: int, column: int, block: list[list[str]]) -> None:
        """Write a block of cells from a place on, as a sheet does; rows left empty go."""
        rows = [list(r) for r in self.rows]
        for offset, cells in enumerate(block):
            at = row + offset
            while len(rows) <= at:
                rows.append([""] * (self.columns + 1))
            if cells[0]:
                rows[at][0] = cells[0]
            for number, cell in enumerate(cells[1:]):
                if column + number < self.columns:
                    rows[at][column + number + 1] = cell
        self.take(rows)

    def take(self, rows: list[list[str]] | list[Row]) -> None:
        """Rows as a person has made them."""
        kept = [tuple(row) for row in rows if any(cell.strip() for cell in row[1:])][:MOST_ROWS]
        if kept != self.rows:
            self._replace(kept)
            self.edited.emit()


class _Delegate(QStyledItemDelegate):
    """Right-aligned editor of the height of a row; a frame around wrong cells."""

    def __init__(self, theme: ThemeKeeper, parent: QObject) -> None:
        super().__init__(parent)
        self._theme = theme

    def createEditor(self, parent: QWidget, option: QStyleOptionViewItem, index: Index) -> QWidget:
        """See QStyledItemDelegate."""
        editor = QLineEdit(parent)
        editor.setAlignment(Qt.AlignmentFlag.AlignRight)
        editor.setStyleSheet("min-height: 0; padding: 0;")
        return editor

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        """See QStyledItemDelegate."""
        super().paint(painter, option, index)
        model = index.model()
        if isinstance(model, ValuesModel) and (index.row(), index.column()) in model.faults:
            painter.save()
            painter.setPen(QPen(QColor(self._theme.current.red), 2.0))
            painter.drawRect(option.rect.adjusted(1, 1, -2, -2))  # type: ignore[attr-defined]
            painter.restore()


class ValuesTable(QTableView):
    """The sheet. `value()` and `setValue()` are rows of texts, each with its mark in front."""

    valueChanged = Signal(tuple)

    def __init__(
        self, theme: ThemeKeeper, heads: tuple[str, ...], parse: Parse, *, grouped: bool = False
    ) -> None:
        super().__init__()
        self._theme = theme
        self._model = ValuesModel(heads, parse, grouped, self)
        self.setModel(self._model)
        self.setItemDelegate(_Delegate(theme, self))
        self.setTabKeyNavigation(False)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ContiguousSelection)
        self.setEditTriggers(
            QAbstractItemView.EditTrigger.AnyKeyPressed
            | QAbstractItemView.EditTrigger.DoubleClicked
            | QAbstractItemView.EditTrigger.EditKeyPressed
        )
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.horizontalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        self.horizontalHeader().setHighlightSections(False)
        self.horizontalHeader().setSectionsClickable(False)
        self.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        self.verticalHeader().setHighlightSections(False)
        self.setCornerButtonEnabled(False)
        self._model.edited.connect(self._on_edited)
        self._make_actions()
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self.verticalHeader().setDefaultSectionSize(self._theme.px(3.25))
        self.verticalHeader().setFixedWidth(self._theme.px(4))
        self.horizontalHeader().setFont(self._theme.font("small"))
        self.verticalHeader().setFont(self._theme.font("small"))

    def _make_actions(self) -> None:
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)
        entries: list[tuple[str, QKeySequence | QKeySequence.StandardKey | None, Callable[[], Any]]] = [
            (self.tr("Cut"), QKeySequence.StandardKey.Cut, self.cut),
            (self.tr("Copy"), QKeySequence.StandardKey.Copy, self.copy),
            (self.tr("Paste"), QKeySequence.StandardKey.Paste, self.paste),
            (self.tr("Delete rows"), QKeySequence(Qt.Key.Key_Delete), self.delete_rows),
            (self.tr("Insert a row above"), QKeySequence("Ctrl+Shift+I"), self.insert_row),
            (self.tr("Reverse the order"), None, self.reverse),
        ]
        if self._model.grouped:
            entries.append((self.tr("Join with the row above (+)"), QKeySequence("+"), self.toggle_joined))
        for text, keys, function in entries:
            action = QAction(text, self)
            if keys is not None:
                action.setShortcut(keys)
                action.setShortcutContext(Qt.ShortcutContext.WidgetShortcut)
            action.triggered.connect(function)
            self.addAction(action)

    # -- value ------------------------------------------------------------------------------------

    def value(self) -> tuple[Row, ...]:
        """Rows of texts without the empty one at the end."""
        return tuple(self._model.rows)

    def setValue(self, rows: tuple[Row, ...]) -> None:
        """Show rows; the place of the cursor stays."""
        if rows != self.value():
            current = self.currentIndex()
            row, column = current.row(), max(current.column(), 0)
            self._model.set_rows(rows)
            if row >= 0:
                self.setCurrentIndex(self._model.index(min(row, len(rows)), column))

    def set_faults(self, faults: Mapping[tuple[int, int], str]) -> None:
        """Frame cells, with the reason as their tip."""
        self._model.set_faults(faults)

    def _on_edited(self) -> None:
        self.valueChanged.emit(self.value())

    # -- sheet ------------------------------------------------------------------------------------

    def _selected_rows(self) -> range:
        chosen = [index.row() for index in self.selectedIndexes()] or [self.currentIndex().row()]
        return range(max(min(chosen), 0), min(max(chosen) + 1, len(self._model.rows)))

    def copy(self) -> None:
        """Selected cells to the clipboard, as a spreadsheet takes them."""
        columns = sorted({index.column() for index in self.selectedIndexes()})
        lines = ["\t".join(self._model.rows[row][c + 1] for c in columns) for row in self._selected_rows()]
        if lines:
            QApplication.clipboard().setText("\n".join(lines))

    def cut(self) -> None:
        """Copy, then delete the rows."""
        self.copy()
        self.delete_rows()

    def paste(self) -> None:
        """The clipboard from the current cell on."""
        block = self._model._parse(QApplication.clipboard().text(), self._model.columns)
        if block:
            current = self.currentIndex()
            row = current.row() if current.isValid() else len(self._model.rows)
            self._model.put(row, max(current.column(), 0) if self._fits(block) else 0, block)
            self.setCurrentIndex(self._model.index(min(row + len(block), len(self._model.rows)), 0))

    def _fits(self, block: list[list[str]]) -> bool:
        return max(len(cells) for cells in block) - 1 < self._model.columns

    def delete_rows(self) -> None:
        """Delete the selected rows."""
        chosen = self._selected_rows()
        rows = [row for number, row in enumerate(self._model.rows) if number not in chosen]
        self._model.take(rows)
        self.setCurrentIndex(self._model.index(min(chosen.start, len(rows)), 0))

    def insert_row(self) -> None:
        """A copy of the current row above it, to be changed."""
        at = self.currentIndex().row()
        if 0 <= at < len(self._model.rows):
            self._model.take([*self._model.rows[: at + 1], *self._model.rows[at:]])
            self.setCurrentIndex(self._model.index(at, 0))

    def reverse(self) -> None:
        """Last one first; joined rows stay together."""
        groups: list[list[Row]] = []
        for row in self._model.rows:
            if row[0] and groups:
                groups[-1].append(row)
            else:
                groups.append([row])
        self._model.take([row for group in reversed(groups) for row in group])

    def toggle_joined(self) -> None:
        """The current row goes on with the one above, or begins anew."""
        at = self.currentIndex().row()
        if 0 < at < len(self._model.rows):
            rows = [list(row) for row in self._model.rows]
            rows[at][0] = "" if rows[at][0] else "+"
            column = self.currentIndex().column()
            self._model.take(rows)
            self.setCurrentIndex(self._model.index(at, column))

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Enter opens a cell; Backspace empties it."""
        current = self.currentIndex()
        if self.state() == QAbstractItemView.State.EditingState:  # the editor has let the key pass
            super().keyPressEvent(event)
            return
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and current.isValid():
            self.edit(current)
            return
        if event.key() == Qt.Key.Key_Backspace and current.isValid():
            self._model.put(current.row(), current.column(), [["", ""]])
            return
        super().keyPressEvent(event)

    def closeEditor(self, editor: QWidget, hint: QAbstractItemDelegate.EndEditHint) -> None:
        """After Enter or Tab the next cell is the current one: right, then the next row."""
        current = self.currentIndex()
        row, column = current.row(), current.column()
        onward = hint in (_HINT.SubmitModelCache, _HINT.EditNextItem)
        super().closeEditor(editor, _HINT.NoHint if onward else hint)
        if onward:
            row, column = (row, column + 1) if column + 1 < self._model.columns else (row + 1, 0)
            self.setCurrentIndex(self._model.index(min(max(row, 0), len(self._model.rows)), column))
            self.setFocus(Qt.FocusReason.OtherFocusReason)

"""The list of modes: number, state by shape and word, frequency, damping ratio, real part.

Job: a table model over poles and the view that selects among them. Not its job: which mode stays selected.
"""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import (
    QAbstractTableModel,
    QCoreApplication,
    QModelIndex,
    QPersistentModelIndex,
    Qt,
    Signal,
)
from PySide6.QtGui import QColor, QFontMetrics
from PySide6.QtWidgets import QAbstractItemView, QHeaderView, QTableView

from rigctl.gui.format import number_text
from rigctl.gui.pages.model.data import Pole, Poles
from rigctl.gui.pages.model.words import STABLE_MARK, UNSTABLE_MARK, state_word
from rigctl.gui.theme import ThemeKeeper

Index = QModelIndex | QPersistentModelIndex

_LEFT = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
_RIGHT = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
_ALIGNED = (_RIGHT, _LEFT, _RIGHT, _RIGHT, _RIGHT)
#: roles as plain numbers: comparing Qt's enumerations takes longer than all else
_DISPLAY, _ALIGNMENT = int(Qt.ItemDataRole.DisplayRole), int(Qt.ItemDataRole.TextAlignmentRole)
_FONT, _GROUND = int(Qt.ItemDataRole.FontRole), int(Qt.ItemDataRole.BackgroundRole)
_LOOKS = frozenset((_FONT, _GROUND, int(Qt.ItemDataRole.ForegroundRole)))


class ModeRows(QAbstractTableModel):
    """Poles as rows."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.poles: tuple[Pole, ...] = ()
        self.restyle()

    def restyle(self) -> None:
        """Take the present look."""
        self._bold = self._theme.font("normal", bold=True)
        self._amber = QColor(self._theme.current.amber)
        self._on_amber = QColor(self._theme.current.on_amber)

    def show(self, poles: tuple[Pole, ...]) -> None:
        """Other poles; rows stay where their number stays."""
        if len(poles) == len(self.poles) and poles:
            self.poles = poles
            self.dataChanged.emit(self.index(0, 0), self.index(len(poles) - 1, self.columnCount() - 1))
            return
        self.beginResetModel()
        self.poles = poles
        self.endResetModel()

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008 Qt's signature
        """Rows."""
        return 0 if parent.isValid() else len(self.poles)

    def columnCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        """Columns."""
        return 0 if parent.isValid() else 5

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> Any:
        """Names with units."""
        if orientation != Qt.Orientation.Horizontal:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return (
                self.tr("No."), self.tr("State"), self.tr("Frequency\n[Hz]"), self.tr("Damping\n[%]"),
                self.tr("Real part\n[1/s]"),
            )[section]  # fmt: skip
        if role == Qt.ItemDataRole.ToolTipRole and section == 3:
            return self.tr("Damping ratio −Re / |λ|, percent of critical; negative: the mode grows")
        if role == Qt.ItemDataRole.TextAlignmentRole:
            return _ALIGNED[section]
        return None

    def data(self, index: Index, role: int = 0) -> Any:
        """Texts and looks; asked some hundred times with every step of a slider."""
        column = index.column()
        if role == _ALIGNMENT:
            return _ALIGNED[column]
        if role == _DISPLAY:
            return self._text(self.poles[index.row()], column)
        if role in _LOOKS and self.poles[index.row()].unstable:
            if role == _FONT:
                return self._bold
            if column == 1:
                return self._amber if role == _GROUND else self._on_amber
        return None

    def _text(self, pole: Pole, column: int) -> str:
        if column == 1:
            return f"{UNSTABLE_MARK if pole.unstable else STABLE_MARK} {state_word(pole)}"
        if column == 2:
            return number_text(pole.frequency_hz, 1)
        if column == 3:
            return number_text(100.0 * pole.damping_ratio, 2)
        return number_text(pole.real_part_1_s, 1) if column else str(pole.number)


class ModeTable(QTableView):
    """Modes; `picked` when a person chooses a row by mouse or keys."""

    picked = Signal(object)
    """Pole."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._showing = False
        self.rows = ModeRows(theme)
        self.setModel(self.rows)
        self.setAccessibleName(self.tr("Modes"))
        self.setToolTip(self.tr("Choose a mode: the brake below moves in it"))
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setShowGrid(False)
        self.setAlternatingRowColors(True)
        self.setTabKeyNavigation(False)
        self.setWordWrap(False)
        self.verticalHeader().hide()
        header = self.horizontalHeader()
        header.setHighlightSections(False)
        header.setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        for column in (0, 1):  # not by contents: they would be measured anew with every step of a slider
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.Fixed)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.selectionModel().currentRowChanged.connect(self._on_row)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self.verticalHeader().setDefaultSectionSize(self._theme.px(3))
        self.rows.restyle()
        metrics = QFontMetrics(self._theme.font("normal", bold=True))
        words = f"{UNSTABLE_MARK} {QCoreApplication.translate('model', 'unstable')}"
        self.setColumnWidth(0, metrics.horizontalAdvance("0000"))
        self.setColumnWidth(1, metrics.horizontalAdvance(words) + self._theme.px(1.5))
        self.setMinimumHeight(self._theme.px(16))

    def show_poles(self, poles: Poles | None) -> None:
        """Show modes and which one is selected."""
        self._showing = True
        self.rows.show(() if poles is None else poles.poles)
        row = -1 if poles is None else poles.shape.number - 1
        if row >= 0 and row != self.currentIndex().row():
            self.selectRow(row)
        self._showing = False

    def value(self) -> int | None:
        """Number of the selected mode."""
        row = self.currentIndex().row()
        return self.rows.poles[row].number if 0 <= row < len(self.rows.poles) else None

    def _on_row(self, index: QModelIndex, _before: QModelIndex) -> None:
        if index.isValid() and not self._showing:
            self.picked.emit(self.rows.poles[index.row()])

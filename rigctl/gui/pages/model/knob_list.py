"""Parameter groups and quantities of a brake as a searchable list with their factors.

Job: which rows a search shows (`rows_of`), and the table model over them. Not its job: sliders, the brake.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QPersistentModelIndex, Qt
from PySide6.QtGui import QColor

from rigctl.gui.format import number_text
from rigctl.gui.pages.model.data import Knob
from rigctl.gui.pages.model.words import knob_title, side_text
from rigctl.gui.theme import ThemeKeeper

Index = QModelIndex | QPersistentModelIndex


def rows_of(
    knobs: Sequence[Knob], search: str, factors: Mapping[str, float], *, singles: bool, changed_only: bool
) -> list[Knob]:
    """Knobs whose names hold all words of the search, in the order of the brake file.

    Sides of a group follow it. Single quantities come when asked for; whatever is changed is shown if it fits
    the search.
    """
    words = search.lower().split()
    found = []
    for knob in knobs:
        changed = knob.key in factors
        if not changed and (changed_only or (not singles and not knob.group)):
            continue
        text = f"{knob_title(knob)} {knob.key} {knob.kind}".lower()
        if all(word in text for word in words):
            found.append(knob)
    return found


class KnobTable(QAbstractTableModel):
    """Two columns: name, factor. Changed factors are blue and bold."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.rows: list[Knob] = []
        self._factors: dict[str, float] = {}
        self.restyle()

    def restyle(self) -> None:
        """Take the present look."""
        self._fonts = {bold: self._theme.font("normal", bold=bold) for bold in (False, True)}
        self._colours = {
            True: QColor(self._theme.current.blue), False: QColor(self._theme.current.text)
        }  # fmt: skip

    def show(self, rows: Sequence[Knob], factors: Mapping[str, float]) -> None:
        """Show these rows; keeps the view's selection where the rows stay the same."""
        before, self._factors = self._factors, dict(factors)
        if [knob.key for knob in rows] == [knob.key for knob in self.rows]:
            if rows and before != self._factors:
                self.dataChanged.emit(self.index(0, 1), self.index(len(rows) - 1, 1))
            return
        self.beginResetModel()
        self.rows = list(rows)
        self.endResetModel()

    def row_of(self, key: str) -> int | None:
        """Row of a knob, None where it is not shown."""
        return next((row for row, knob in enumerate(self.rows) if knob.key == key), None)

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008 Qt's signature
        """Rows."""
        return 0 if parent.isValid() else len(self.rows)

    def columnCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        """Columns."""
        return 0 if parent.isValid() else 2

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> Any:
        """Names of the columns."""
        if orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole:
            return (self.tr("Parameter group"), self.tr("Factor"))[section]
        return None

    def data(self, index: Index, role: int = 0) -> Any:
        """Texts and looks."""
        knob = self.rows[index.row()]
        factor = self._factors.get(knob.key, 1.0)
        changed = factor != 1.0
        roles = Qt.ItemDataRole
        found: Any = None
        if role == roles.DisplayRole:
            name = f"      {side_text(knob)}" if knob.side else knob_title(knob)
            found = f"×{number_text(factor, 2)}" if index.column() else name
        elif role == roles.ToolTipRole:
            found = "\n".join((knob_title(knob), *knob.members))
        elif role == roles.TextAlignmentRole and index.column() == 1:
            found = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        elif role == roles.FontRole:
            found = self._fonts[changed]
        elif role == roles.ForegroundRole:
            found = self._colours[changed]
        return found

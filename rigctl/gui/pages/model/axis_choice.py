"""Which slider an axis of the stability map is, and over which range.

Job: a searchable combo box and two numbers; `value`, `setValue`, `read`. Not its job: the map.
"""

from __future__ import annotations

from PySide6.QtCore import QSignalBlocker, Qt
from PySide6.QtWidgets import QComboBox, QCompleter, QDoubleSpinBox, QHBoxLayout, QLabel, QWidget

from rigctl.gui.pages.model.data import FACTORS, OPERATING, BrakeFacts, MapAxis
from rigctl.gui.pages.model.map_state import start_axis
from rigctl.gui.pages.model.words import UNITS, title_of
from rigctl.gui.theme import ThemeKeeper


class AxisChoice(QWidget):
    """Which slider an axis of the map is, and its range."""

    def __init__(self, theme: ThemeKeeper, axis: MapAxis) -> None:
        super().__init__()
        self._axis = axis
        self.combo = QComboBox()
        self.combo.setEditable(True)
        self.combo.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        self.combo.setMinimumContentsLength(10)
        self.combo.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.combo.setToolTip(self.tr("Slider along this axis; type to search"))
        completer = self.combo.completer()
        if completer is not None:
            completer.setFilterMode(Qt.MatchFlag.MatchContains)
            completer.setCompletionMode(QCompleter.CompletionMode.PopupCompletion)
        self.low, self.high = QDoubleSpinBox(), QDoubleSpinBox()
        for spin in (self.low, self.high):
            spin.setKeyboardTracking(False)
            spin.setButtonSymbols(QDoubleSpinBox.ButtonSymbols.PlusMinus)
            spin.setAlignment(Qt.AlignmentFlag.AlignRight)
            spin.setMinimumWidth(theme.px(10))
        self.low.setToolTip(self.tr("Least value on this axis"))
        self.high.setToolTip(self.tr("Largest value on this axis"))
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(theme.px(1))
        row.addWidget(self.combo, 1)
        row.addWidget(self.low)
        row.addWidget(QLabel("–"))
        row.addWidget(self.high)

    def fill(self, facts: BrakeFacts | None) -> None:
        """Sliders to choose from."""
        keys = [*OPERATING, *(knob.key for knob in facts.knobs)] if facts is not None else [*OPERATING]
        with QSignalBlocker(self.combo):
            self.combo.clear()
            for key in keys:
                self.combo.addItem(title_of(key, facts), key)
        self.setValue(self._axis)

    def value(self) -> MapAxis:
        """The axis chosen."""
        return self._axis

    def setValue(self, axis: MapAxis) -> None:
        """Show an axis; no signal."""
        self._axis = axis
        ends = OPERATING.get(axis.key, FACTORS)
        blockers = [QSignalBlocker(widget) for widget in (self.combo, self.low, self.high)]
        self.combo.setCurrentIndex(max(self.combo.findData(axis.key), 0))
        edit = self.combo.lineEdit()
        if edit is not None:
            edit.setCursorPosition(0)
        for spin, value in ((self.low, axis.low), (self.high, axis.high)):
            span = ends[1] - ends[0]
            spin.setDecimals(3 if span < 1.0 else 2 if span < 10.0 else 1)
            spin.setSingleStep(span / 20.0)
            spin.setRange(*ends)
            unit = UNITS.get(axis.key, "")
            spin.setSuffix(f"\u202f{unit}" if unit else "")
            spin.setPrefix("" if axis.key in OPERATING else "×")
            spin.setValue(value)
        del blockers

    def read(self) -> MapAxis:
        """The axis as the widgets say it; another slider takes its usual range."""
        key = self.combo.currentData()
        if key != self._axis.key:
            return start_axis(key)
        return MapAxis(key, self.low.value(), self.high.value())

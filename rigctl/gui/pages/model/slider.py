"""A slider with name, exact entry, and reset: linear, or logarithmic for factors.

Job: one number by mouse, keys or typing; `value`, `setValue`, `valueChanged`. Not its job: what it means.
"""

from __future__ import annotations

import math

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import QDoubleSpinBox, QHBoxLayout, QPushButton, QSlider, QVBoxLayout, QWidget

from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.elided import ElidedLabel

#: positions of a logarithmic slider on each side of the factor 1
_LOG_HALF = 200


class KnobSlider(QWidget):
    """Name and reset above, slider and number below."""

    valueChanged = Signal(float)
    """By a person: slider, keys or typing; not by `setValue`."""
    resetAsked = Signal()

    def __init__(
        self, theme: ThemeKeeper, title: str, ends: tuple[float, float], step: float, decimals: int,
        unit: str = "", *, logarithmic: bool = False,
    ) -> None:  # fmt: skip
        super().__init__()
        self._theme, self._ends, self._step, self._decimals = theme, ends, step, decimals
        self._log = logarithmic
        self._value = ends[0]
        self.title = ElidedLabel(title)
        self.number = QDoubleSpinBox()
        self.number.setRange(*ends)
        self.number.setDecimals(decimals)
        self.number.setSingleStep(step)
        self.number.setKeyboardTracking(False)
        self.number.setButtonSymbols(QDoubleSpinBox.ButtonSymbols.PlusMinus)
        self.number.setAlignment(Qt.AlignmentFlag.AlignRight)
        if unit:
            self.number.setSuffix(f"\u202f{unit}")
        if logarithmic:
            self.number.setPrefix("×")
            self.number.setStepType(QDoubleSpinBox.StepType.AdaptiveDecimalStepType)
        self.title.setBuddy(self.number)
        self.slider = QSlider(Qt.Orientation.Horizontal)
        self.slider.setRange(0, 2 * _LOG_HALF if logarithmic else round((ends[1] - ends[0]) / step))
        self.slider.setSingleStep(1)
        self.slider.setPageStep(10)
        self.reset = QPushButton(self.tr("Reset"))
        self.reset.setToolTip(self.tr("Back to the value of the brake file"))
        tip = self.tr("{0} to {1}{2}. Arrow keys: small steps, Page Up and Page Down: large ones").format(
            f"{ends[0]:g}", f"{ends[1]:g}", f"\u202f{unit}" if unit else ""
        )
        self.slider.setToolTip(tip)
        self.number.setToolTip(self.tr("Type a value and press Enter"))
        self._arrange()
        self.slider.valueChanged.connect(self._on_slider)
        self.number.valueChanged.connect(self._on_number)
        self.reset.clicked.connect(self.resetAsked)
        theme.changed.connect(self._restyle)
        self._restyle()
        self.setTitle(title)

    def _arrange(self) -> None:
        self._top, self._bottom = QHBoxLayout(), QHBoxLayout()
        self._top.addWidget(self.title, 1)
        self._top.addWidget(self.reset)
        self._bottom.addWidget(self.slider, 1)
        self._bottom.addWidget(self.number)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.addLayout(self._top)
        self._column.addLayout(self._bottom)

    def _restyle(self) -> None:
        px = self._theme.px
        for layout in (self._top, self._bottom):
            layout.setSpacing(px(1))
        self._column.setSpacing(px(0.5))
        self.number.setMinimumWidth(px(12.5))

    def setTitle(self, title: str) -> None:
        """Another name."""
        self.title.setText(title)
        self.slider.setAccessibleName(title)
        self.number.setAccessibleName(title)

    def setActive(self, active: bool) -> None:
        """Show that the path in the plane belongs to this slider."""
        font = self._theme.font("normal", bold=active)
        self.title.setFont(font)

    def value(self) -> float:
        """The number."""
        return self._value

    def setValue(self, value: float) -> None:
        """Show a number; no signal."""
        self._value = min(max(value, self._ends[0]), self._ends[1])
        blockers = [QSignalBlocker(self.slider), QSignalBlocker(self.number)]
        self.slider.setValue(self._position(self._value))
        self.number.setValue(self._value)
        del blockers

    def setResettable(self, can: bool) -> None:
        """Whether the value differs from the file's."""
        self.reset.setEnabled(can)

    def _position(self, value: float) -> int:
        if self._log:
            return round(_LOG_HALF * (1.0 + math.log(value) / math.log(self._ends[1])))
        return round((value - self._ends[0]) / self._step)

    def _at(self, position: int) -> float:
        if self._log:
            return round(self._ends[1] ** (position / _LOG_HALF - 1.0), 3)
        return round(self._ends[0] + position * self._step, self._decimals)

    def _on_slider(self, position: int) -> None:
        self._value = self._at(position)
        with QSignalBlocker(self.number):
            self.number.setValue(self._value)
        self.valueChanged.emit(self._value)

    def _on_number(self, value: float) -> None:
        self._value = value
        with QSignalBlocker(self.slider):
            self.slider.setValue(self._position(value))
        self.valueChanged.emit(value)

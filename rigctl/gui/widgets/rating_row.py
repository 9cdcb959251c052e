"""Nine keys for the subjective noise rating: 1 nothing heard … 9 unbearable.

Job: take a rating by mouse, show the one given. Not its job: the keys of the keyboard (pages), storing it.
"""

from __future__ import annotations

from functools import partial

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QButtonGroup, QHBoxLayout, QPushButton, QWidget

from rigctl.gui.theme import ThemeKeeper

RATINGS = range(1, 10)


class RatingRow(QWidget):
    """`value()` is 0 while none is given."""

    valueChanged = Signal(int)
    """A person has given a rating (not: it was set)."""

    def __init__(self, theme: ThemeKeeper, name: str) -> None:
        super().__init__()
        self.setObjectName(name)
        self._theme = theme
        self._group = QButtonGroup(self)
        self._group.setExclusive(False)
        self._row = QHBoxLayout(self)
        self._row.setContentsMargins(0, 0, 0, 0)
        self.buttons: dict[int, QPushButton] = {}
        for rating in RATINGS:
            button = QPushButton(str(rating))
            button.setObjectName(f"{name}-{rating}")
            button.setCheckable(True)
            button.setToolTip(self._tip(rating))
            button.clicked.connect(partial(self.give, rating))
            self._group.addButton(button, rating)
            self._row.addWidget(button)
            self.buttons[rating] = button
        theme.changed.connect(self._restyle)
        self._restyle()

    def _tip(self, rating: int) -> str:
        ends = {
            1: self.tr("1: nothing heard"),
            5: self.tr("5: clearly heard"),
            9: self.tr("9: unbearable"),
        }
        return ends.get(rating, str(rating)) + "\n" + self.tr("Noise rating; the number keys do the same")

    def _restyle(self) -> None:
        self._row.setSpacing(self._theme.px(0.5))
        for button in self.buttons.values():
            button.setFixedWidth(self._theme.px(3.5))

    def value(self) -> int:
        """The rating, 0 for none."""
        return next((rating for rating, button in self.buttons.items() if button.isChecked()), 0)

    def setValue(self, rating: int) -> None:
        """Show a rating; 0 for none."""
        for number, button in self.buttons.items():
            button.setChecked(number == rating)

    def give(self, rating: int, _checked: bool = False) -> None:
        """As if its key had been pressed."""
        if self.isEnabled():
            self.setValue(rating)
            self.valueChanged.emit(rating)

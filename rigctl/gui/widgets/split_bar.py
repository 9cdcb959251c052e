"""A thin bar whose parts are shares of a whole, with their names below: where the time goes.

Job: painting. Not its job: numbers.
"""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QRectF, QSize, Qt
from PySide6.QtGui import QBrush, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from rigctl.gui.theme import ThemeKeeper


class SplitBar(QWidget):
    """Parts are (share, token of the colour, hatched)."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._parts: tuple[tuple[float, str, bool], ...] = ()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        theme.changed.connect(self._restyle)

    def _restyle(self) -> None:
        self.updateGeometry()
        self.update()

    def value(self) -> tuple[tuple[float, str, bool], ...]:
        """The parts."""
        return self._parts

    def setValue(self, parts: Sequence[tuple[float, str, bool]]) -> None:
        """Show parts; the shares need not sum up to 1."""
        self._parts = tuple(parts)
        self.update()

    def sizeHint(self) -> QSize:
        """See QWidget."""
        return QSize(self._theme.px(16), self._theme.px(1.5))

    def paintEvent(self, event: QPaintEvent) -> None:
        """See QWidget."""
        painter = QPainter(self)
        total = sum(share for share, _, _ in self._parts)
        frame = QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5)
        painter.fillRect(frame, self._theme.colour("field"))
        left = frame.left()
        for share, token, hatched in self._parts:
            width = frame.width() * share / total if total > 0 else 0.0
            part = QRectF(left, frame.top(), width, frame.height())
            style = Qt.BrushStyle.BDiagPattern if hatched else Qt.BrushStyle.SolidPattern
            painter.fillRect(part, QBrush(self._theme.colour(token), style))
            left += width
        painter.setPen(QPen(self._theme.colour("line"), 1.0))
        painter.drawRect(frame)

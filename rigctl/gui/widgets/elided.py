"""A line of text that is shortened with "…" where there is no room, and told whole in its tip.

Not its job: texts of several lines.
"""

from __future__ import annotations

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QPainter, QPaintEvent, QPalette
from PySide6.QtWidgets import QLabel, QSizePolicy, QWidget


class ElidedLabel(QLabel):
    """One line; takes the width it gets. Another text only repaints it: no layout is computed anew."""

    def __init__(self, text: str = "", parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._line = text
        self.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Fixed)
        self.setAccessibleName(text)

    def text(self) -> str:
        """The whole text."""
        return self._line

    def setText(self, text: str) -> None:
        """Another text."""
        if text != self._line:
            self._line = text
            self.setAccessibleName(text)
            self.update()

    def clear(self) -> None:
        """No text."""
        self.setText("")

    def sizeHint(self) -> QSize:
        """As wide as the text of the moment, one line high."""
        metrics = self.fontMetrics()
        return QSize(metrics.horizontalAdvance(self._line), metrics.height())

    def minimumSizeHint(self) -> QSize:
        """A few letters wide, one line high."""
        metrics = self.fontMetrics()
        return QSize(metrics.horizontalAdvance("mmmm"), metrics.height())

    def paintEvent(self, _event: QPaintEvent) -> None:
        """Draw what fits; the tip holds the rest."""
        shown = self.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, self.width())
        tip = self.text() if shown != self.text() else ""
        if tip != self.toolTip():
            self.setToolTip(tip)
        painter = QPainter(self)
        painter.setFont(self.font())
        painter.setPen(self.palette().color(QPalette.ColorRole.WindowText))
        painter.drawText(self.rect(), int(self.alignment() | Qt.AlignmentFlag.AlignVCenter), shown)
        painter.end()

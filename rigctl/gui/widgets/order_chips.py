"""Chips in an order that a person changes by dragging them, or with the arrow keys.

Job: `value()` is the order of the keys, outermost first. Not its job: what the order means.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping

from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QFocusEvent, QFontMetricsF, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from rigctl.gui.theme import ThemeKeeper

GRIP = "⠿ "


class OrderChips(QWidget):
    """A row of chips with arrows between them."""

    valueChanged = Signal(tuple)
    """A person has changed the order."""

    def __init__(self, theme: ThemeKeeper, names: Mapping[str, str]) -> None:
        super().__init__()
        self._theme = theme
        self._names = dict(names)
        self._order = tuple(names)
        self._current = 0
        self._grabbed: float | None = None
        self._pointer = 0.0
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.setCursor(Qt.CursorShape.OpenHandCursor)
        theme.changed.connect(self._restyle)

    def _restyle(self) -> None:
        self.updateGeometry()
        self.update()

    def value(self) -> tuple[str, ...]:
        """Keys, first one outermost."""
        return self._order

    def setValue(self, order: tuple[str, ...]) -> None:
        """Show an order of the same keys."""
        if order != self._order and self._grabbed is None:
            self._order = tuple(order)
            self.update()

    # -- places -----------------------------------------------------------------------------------

    def _gap(self) -> int:
        return self._theme.px(2.5)

    def _width_of(self, key: str) -> float:
        metrics = QFontMetricsF(self._theme.font())
        return metrics.horizontalAdvance(GRIP + self._names[key]) + self._theme.px(2)

    def chip_rects(self) -> list[QRectF]:
        """Where each chip stands, in the present order."""
        left, rects = 1.0, []
        for key in self._order:
            width = self._width_of(key)
            rects.append(QRectF(left, 1.0, width, self.height() - 2.0))
            left += width + self._gap()
        return rects

    def sizeHint(self) -> QSize:
        """See QWidget."""
        width = sum(map(self._width_of, self._order)) + self._gap() * (len(self._order) - 1) + 2
        return QSize(round(width) + 1, self._theme.px(4))

    def minimumSizeHint(self) -> QSize:
        """See QWidget."""
        return self.sizeHint()

    # -- hands ------------------------------------------------------------------------------------

    def mousePressEvent(self, event: QMouseEvent) -> None:
        """Take a chip."""
        for number, rect in enumerate(self.chip_rects()):
            if rect.contains(event.position()) and event.button() == Qt.MouseButton.LeftButton:
                self._current = number
                self._pointer = event.position().x()
                self._grabbed = self._pointer - rect.left()
                self.setCursor(Qt.CursorShape.ClosedHandCursor)
                self._before = self._order
                self.update()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        """Carry it; it changes places with a neighbour when its middle passes the neighbour's."""
        if self._grabbed is None:
            return
        self._pointer = event.position().x()
        middle = self._pointer - self._grabbed + self._width_of(self._order[self._current]) / 2
        rects = self.chip_rects()
        if self._current > 0 and middle < rects[self._current - 1].center().x():
            self._swap(self._current - 1)
        elif self._current < len(rects) - 1 and middle > rects[self._current + 1].center().x():
            self._swap(self._current + 1)
        self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        """Let it go."""
        if self._grabbed is None:
            return
        self._grabbed = None
        self.setCursor(Qt.CursorShape.OpenHandCursor)
        self.update()
        if self._order != self._before:
            self.valueChanged.emit(self._order)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Left, right: choose a chip; with Ctrl or Alt: move it."""
        step = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}.get(Qt.Key(event.key()), 0)
        place = self._current + step
        if step == 0:
            super().keyPressEvent(event)
            return
        if not 0 <= place < len(self._order):
            return
        if event.modifiers() & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier):
            self._swap(place)
            self.valueChanged.emit(self._order)
        else:
            self._current = place
        self.update()

    def _swap(self, place: int) -> None:
        order = list(self._order)
        order[self._current], order[place] = order[place], order[self._current]
        self._order = tuple(order)
        self._current = place

    def focusInEvent(self, event: QFocusEvent) -> None:
        """See QWidget."""
        super().focusInEvent(event)
        self.update()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        """See QWidget."""
        super().focusOutEvent(event)
        self.update()

    def changeEvent(self, event: QEvent) -> None:
        """Greyed when it has no effect."""
        super().changeEvent(event)
        self.update()

    # -- look -------------------------------------------------------------------------------------

    def paintEvent(self, event: QPaintEvent) -> None:
        """See QWidget."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(self._theme.font())
        rects = self.chip_rects()
        painter.setPen(self._theme.colour("muted"))
        for left, right in itertools.pairwise(rects):
            gap = QRectF(left.right(), 0, right.left() - left.right(), self.height())
            painter.drawText(gap, Qt.AlignmentFlag.AlignCenter, "›")
        for number, rect in enumerate(rects):
            if not (self._grabbed is not None and number == self._current):
                self._paint_chip(painter, number, rect)
        if self._grabbed is not None:
            carried = rects[self._current].translated(0, 0)
            left = min(max(self._pointer - self._grabbed, 1.0), self.width() - carried.width() - 1.0)
            carried.moveTopLeft(QPointF(left, carried.top()))
            self._paint_chip(painter, self._current, carried)

    def _paint_chip(self, painter: QPainter, number: int, rect: QRectF) -> None:
        chosen = self.hasFocus() and number == self._current
        theme, on = self._theme, self.isEnabled()
        painter.setPen(QPen(theme.colour("blue" if chosen else "line"), 2.0 if chosen else 1.0))
        painter.setBrush(theme.colour("field" if on else "panel"))
        painter.drawRoundedRect(rect, theme.px(0.5), theme.px(0.5))
        text = rect.adjusted(theme.px(1), 0, -theme.px(1), 0)
        painter.setPen(theme.colour("muted" if on else "plot_line"))
        painter.drawText(text, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, GRIP)
        painter.setPen(theme.colour("text" if on else "plot_line"))
        name = self._names[self._order[number]]
        painter.drawText(text, Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight, name)

"""A small drawing of a set-point over time, beside the fields that make it.

Job: painting points with the limits of the rig and the ends of the axes. Not its job: computing the course.
"""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QFontMetricsF, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from rigctl.gui.theme import ThemeKeeper


class CoursePreview(QWidget):
    """Set-point over time: blue line, red dashed upper limit."""

    def __init__(self, theme: ThemeKeeper, unit: str) -> None:
        super().__init__()
        self._theme = theme
        self._unit = unit
        self._points: list[tuple[float, float]] = []
        self._limit: float | None = None
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        theme.changed.connect(self._restyle)

    def _restyle(self) -> None:
        self.updateGeometry()
        self.update()

    def value(self) -> list[tuple[float, float]]:
        """The points (s, value)."""
        return list(self._points)

    def setValue(self, points: Sequence[tuple[float, float]], limit: float | None = None) -> None:
        """Points (s, value) in order of time; none draws an empty field."""
        self._points = list(points)
        self._limit = limit
        self.update()

    def sizeHint(self) -> QSize:
        """See QWidget."""
        return QSize(self._theme.px(24), self._theme.px(9))

    def minimumSizeHint(self) -> QSize:
        """See QWidget."""
        return QSize(self._theme.px(16), self._theme.px(9))

    def paintEvent(self, event: QPaintEvent) -> None:
        """See QWidget."""
        t = self._theme
        painter = QPainter(self)
        painter.fillRect(self.rect(), t.colour("plot"))
        painter.setPen(QPen(t.colour("line"), 1.0))
        painter.drawRect(QRectF(self.rect()).adjusted(0, 0, -1, -1))
        if len(self._points) < 2:
            return
        font = t.font("small")
        metrics = QFontMetricsF(font)
        painter.setFont(font)
        values = [value for _, value in self._points]
        top = max([*values, 1.0] + ([self._limit] if self._limit is not None else []))
        bottom = min([*values, 0.0])
        end_s = self._points[-1][0] or 1.0
        upper = f"{top:g}\u202f{self._unit}"
        left = metrics.horizontalAdvance(upper) + t.px(1)
        place = QRectF(self.rect()).adjusted(left, t.px(1), -t.px(1), -metrics.height() - t.px(0.25))

        def spot(t_s: float, value: float) -> QPointF:
            return QPointF(
                place.left() + t_s / end_s * place.width(),
                place.bottom() - (value - bottom) / (top - bottom) * place.height(),
            )

        painter.setPen(t.colour("muted"))
        align = Qt.AlignmentFlag
        painter.drawText(
            QRectF(0, place.top() - t.px(0.75), left - t.px(0.5), metrics.height()), align.AlignRight, upper
        )
        painter.drawText(
            QRectF(0, place.bottom() - metrics.height() * 0.7, left - t.px(0.5), metrics.height()),
            align.AlignRight, f"{bottom:g}",
        )  # fmt: skip
        painter.drawText(
            QRectF(place.left(), place.bottom(), place.width(), metrics.height()),
            align.AlignRight, f"{end_s:g}\u202fs",
        )  # fmt: skip
        if self._limit is not None:
            painter.setPen(QPen(t.colour("red"), 1.0, Qt.PenStyle.DashLine))
            painter.drawLine(spot(0.0, self._limit), spot(end_s, self._limit))
        painter.setPen(QPen(t.colour("line"), 1.0))
        painter.drawLine(spot(0.0, bottom), spot(end_s, bottom))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(t.colour("blue"), 2.0))
        painter.drawPolyline([spot(*point) for point in self._points])

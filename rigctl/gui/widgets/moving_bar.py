"""A moving-bar indicator: large figures, bar with limit bands, set-point mark, trend of the last minute.

Job: painting one reading so that it is understood at a glance: grey while well, blue for the set-point, amber
or red with a shape beyond a limit. Not its job: where limits come from, what a value means.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QBrush, QFontMetricsF, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from rigctl.gui.format import number_text
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.trend import Trend


@dataclass(frozen=True)
class BarScale:
    """Ends of the bar and the limits in it; None where there is none."""

    low: float
    high: float
    unit: str
    decimals: int = 1
    warn_from: float | None = None
    alarm_from: float | None = None

    def share(self, value: float) -> float:
        """Place of a value along the bar, 0 to 1."""
        return min(max((value - self.low) / (self.high - self.low), 0.0), 1.0)

    def severity(self, value: float) -> str:
        """ "", "warning" or "alarm"."""
        if not math.isfinite(value):
            return ""
        if self.alarm_from is not None and value >= self.alarm_from:
            return "alarm"
        return "warning" if self.warn_from is not None and value >= self.warn_from else ""


class MovingBar(QWidget):
    """One reading. `setReading` is its input; `severityChanged` tells when it passes a limit."""

    severityChanged = Signal(str)

    def __init__(self, theme: ThemeKeeper, name: str, scale: BarScale) -> None:
        super().__init__()
        self._theme = theme
        self._name = name
        self._scale = scale
        self._value = math.nan
        self._set_point = math.nan
        self._severity = ""
        self.trend = Trend()
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Expanding)
        self.setAccessibleName(name)
        theme.changed.connect(self._restyle)

    def _restyle(self) -> None:
        self.updateGeometry()
        self.update()

    # -- value ------------------------------------------------------------------------------------

    def value(self) -> float:
        """The reading; NaN when there is none."""
        return self._value

    def setPoint(self) -> float:
        """The commanded set-point; NaN when there is none."""
        return self._set_point

    def severity(self) -> str:
        """ "", "warning" or "alarm"."""
        return self._severity

    def setScale(self, scale: BarScale) -> None:
        """Other limits."""
        self._scale = scale
        self.update()

    def scale(self) -> BarScale:
        """Ends and limits."""
        return self._scale

    def setReading(self, value: float, set_point: float = math.nan, t_s: float | None = None) -> None:
        """Show a reading; with its time it joins the trend."""
        self._value, self._set_point = value, set_point
        if t_s is not None:
            self.trend.add(t_s, value)
        severity = self._scale.severity(value)
        if severity != self._severity:
            self._severity = severity
            self.severityChanged.emit(severity)
        text = f"{number_text(value, self._scale.decimals)} {self._scale.unit}"
        self.setAccessibleDescription(text)
        self.update()

    def clear(self) -> None:
        """No reading, no trend."""
        self.trend.clear()
        self.setReading(math.nan)

    # -- painting ---------------------------------------------------------------------------------

    def _heights(self) -> tuple[float, float, float]:
        """Of the line of figures, the bar, and the line of the scale's ends."""
        large = QFontMetricsF(self._theme.font("large", bold=True)).height()
        small = QFontMetricsF(self._theme.font("small")).height()
        return large, float(self._theme.px(1.75)), small

    def minimumSizeHint(self) -> QSize:
        """Without the trend: it is left out where there is no room."""
        return QSize(self._theme.px(24), math.ceil(sum(self._heights()) + self._theme.px(1.5)))

    def sizeHint(self) -> QSize:
        """With the trend."""
        return QSize(self._theme.px(32), math.ceil(sum(self._heights()) + self._theme.px(6)))

    def paintEvent(self, event: QPaintEvent) -> None:
        """See QWidget."""
        painter = QPainter(self)
        figures, bar, ends = self._heights()
        gap = float(self._theme.px(0.5))
        width = float(self.width())
        self._paint_figures(painter, QRectF(0, 0, width, figures))
        self._paint_bar(painter, QRectF(gap, figures + gap, width - 2 * gap, bar))
        below = figures + 2 * gap + bar
        self._paint_ends(painter, QRectF(gap, below, width - 2 * gap, ends))
        rest = QRectF(gap, below + ends + gap, width - 2 * gap, self.height() - below - ends - 2 * gap)
        if rest.height() >= self._theme.px(2):
            self._paint_trend(painter, rest)

    def _paint_figures(self, painter: QPainter, place: QRectF) -> None:
        t = self._theme
        large, normal, small = t.font("large", bold=True), t.font("normal"), t.font("small")
        base = place.top() + QFontMetricsF(large).ascent()
        painter.setFont(normal)
        painter.setPen(t.colour("text"))
        name_width = QFontMetricsF(normal).horizontalAdvance(self._name)
        painter.drawText(QPointF(place.left(), base), self._name)
        mark_left = place.left() + name_width + t.px(1)
        if self._severity:
            self._paint_shape(painter, mark_left, base)
        unit = self._scale.unit
        unit_width = QFontMetricsF(normal).horizontalAdvance(unit)
        painter.setPen(t.colour("muted"))
        painter.drawText(QPointF(place.right() - unit_width, base), unit)
        painter.setFont(large)
        painter.setPen(t.colour("text"))
        text = number_text(self._value, self._scale.decimals)
        text_width = QFontMetricsF(large).horizontalAdvance(text)
        left = place.right() - unit_width - t.px(0.75) - text_width
        painter.drawText(QPointF(left, base), text)
        if math.isfinite(self._set_point):
            painter.setFont(small)
            painter.setPen(t.colour("blue"))
            word = "▸ " + number_text(self._set_point, self._scale.decimals)
            at = left - t.px(1.5) - QFontMetricsF(small).horizontalAdvance(word)
            if at > mark_left + (t.px(2) if self._severity else 0):
                painter.drawText(QPointF(at, base), word)

    def _paint_shape(self, painter: QPainter, left: float, base: float) -> None:
        """Triangle for a warning, square for an alarm: told apart without colour."""
        size = float(self._theme.px(1.75))
        alarm = self._severity == "alarm"
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setBrush(self._theme.colour("red" if alarm else "amber"))
        painter.setPen(QPen(self._theme.colour("text"), 1.0))
        if alarm:
            painter.drawRect(QRectF(left, base - size, size, size))
        else:
            painter.drawPolygon(
                QPolygonF(
                    [QPointF(left, base), QPointF(left + size, base), QPointF(left + size / 2, base - size)]
                )
            )
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)

    def _paint_bar(self, painter: QPainter, place: QRectF) -> None:
        t, scale = self._theme, self._scale
        painter.fillRect(place, t.colour("field"))

        def x_of(value: float) -> float:
            return place.left() + scale.share(value) * place.width()

        for start, stop, token in (
            (scale.warn_from, scale.alarm_from, "amber"),
            (scale.alarm_from, None, "red"),
        ):
            if start is not None:
                left, right = x_of(start), x_of(stop if stop is not None else scale.high)
                band = QRectF(left, place.top(), right - left, place.height())
                painter.fillRect(band, QBrush(t.colour(token), Qt.BrushStyle.BDiagPattern))
        if math.isfinite(self._value):
            token = {"": "muted", "warning": "amber", "alarm": "red"}[self._severity]
            zero = x_of(max(scale.low, 0.0))
            end = x_of(self._value)
            inset = place.height() * 0.2
            painter.fillRect(
                QRectF(min(zero, end), place.top() + inset, abs(end - zero), place.height() - 2 * inset),
                t.colour(token),
            )
        painter.setPen(QPen(t.colour("line"), 1.0))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(place)
        if math.isfinite(self._set_point):
            self._paint_set_point(painter, x_of(self._set_point), place)

    def _paint_set_point(self, painter: QPainter, x: float, place: QRectF) -> None:
        half = self._theme.px(0.625)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(QPen(self._theme.colour("blue"), 2.0))
        painter.drawLine(QPointF(x, place.top() - 1), QPointF(x, place.bottom() + 1))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(self._theme.colour("blue"))
        top = place.top() - self._theme.px(0.25)
        painter.drawPolygon(
            QPolygonF([QPointF(x - half, top), QPointF(x + half, top), QPointF(x, top + 1.6 * half)])
        )
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)

    def _paint_ends(self, painter: QPainter, place: QRectF) -> None:
        painter.setFont(self._theme.font("small"))
        painter.setPen(self._theme.colour("muted"))
        align = Qt.AlignmentFlag
        painter.drawText(place, align.AlignLeft | align.AlignTop, f"{self._scale.low:g}")
        painter.drawText(place, align.AlignRight | align.AlignTop, f"{self._scale.high:g}")

    def _paint_trend(self, painter: QPainter, place: QRectF) -> None:
        t, scale = self._theme, self._scale
        painter.fillRect(place, t.colour("plot"))
        span = self.trend.span_s

        def y_of(value: float) -> float:
            return place.bottom() - scale.share(value) * place.height()

        painter.setPen(QPen(t.colour("line"), 1.0))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(place)
        if math.isfinite(self._set_point):
            painter.setPen(QPen(t.colour("blue"), 1.0, Qt.PenStyle.DashLine))
            y = y_of(self._set_point)
            painter.drawLine(QPointF(place.left(), y), QPointF(place.right(), y))
        points = self.trend.points()
        if not points:
            return
        line: list[QPointF] = []
        for age_s, low, high in points:
            x = place.right() - age_s / span * place.width()
            line.append(QPointF(x, y_of(low)))
            if high != low:
                line.append(QPointF(x, y_of(high)))
        painter.setPen(QPen(t.colour("text"), 1.0))
        painter.drawPolyline(line)

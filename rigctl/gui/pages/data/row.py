"""One row of the plots of a braking: a curve or the spectrogram, with marks, cursor and name.

Job: make the plot once, renew what is in it for every braking (making plots costs ten times as much). Not its
job: which rows there are, the mouse (`time_rows`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QFontMetricsF

from rigctl.analysis.braking_view import MU, Curve, SoundPicture
from rigctl.gui.format import number_text
from rigctl.gui.pages.data.marks import Mark
from rigctl.gui.theme import ThemeKeeper

_RANGE_DB = 70.0
_LEAST_TOP_DB = 75.0
"""The colours of a quiet braking stay dark: they are not spread over its noise."""
_FRICTION = (-0.2, 2.0)
_BOX_KHZ = 0.2


class FewTicks(pg.AxisItem):
    """A value axis with as many ticks as have room below each other: low rows have two or three."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__("left")
        self._line_px = QFontMetricsF(theme.font("small")).height()

    def tickSpacing(self, minVal: float, maxVal: float, size: float) -> Any:
        """One level of ticks, at 1, 2 or 5 times a power of ten."""
        span = abs(maxVal - minVal)
        if span == 0.0 or not math.isfinite(span):
            return super().tickSpacing(minVal, maxVal, size)
        least = span / max(size / (1.3 * self._line_px), 2.0)
        power = 10.0 ** math.floor(math.log10(least))
        step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= least * 0.999)
        return [(step, 0.0)]


class Row:
    """The plot `item` and what is in it; `title` stands beside it."""

    def __init__(self, theme: ThemeKeeper, item: Any, name: str, time_name: str) -> None:
        self._theme = theme
        self.item = item
        self.name = name
        self.title = pg.LabelItem(justify="left")
        self.cursor = pg.InfiniteLine(angle=90, movable=False)
        self.play = pg.InfiniteLine(angle=90, movable=False)
        self._curve: Any = None
        self._image: Any = None
        self._extras: list[Any] = []
        self._range = (0.0, 1.0)
        self._dress(time_name)

    def _dress(self, time_name: str) -> None:
        t, item = self._theme.current, self.item
        item.hideButtons()
        item.disableAutoRange()
        item.setMouseEnabled(x=True, y=False)
        item.setClipToView(True)
        item.setDownsampling(auto=True, mode="peak")
        for side in ("left", "bottom"):
            axis = item.getAxis(side)
            axis.enableAutoSIPrefix(False)
            axis.setPen(pg.mkPen(t.plot_line))
            axis.setTextPen(pg.mkPen(t.text))
            axis.setTickFont(self._theme.font("small"))
        bottom = item.getAxis("bottom")
        item.getAxis("left").setWidth(self._theme.px(5.5))
        bottom.setStyle(showValues=bool(time_name))
        bottom.setHeight(self._theme.px(4.5 if time_name else 0.5))
        if time_name:
            bottom.label.setFont(self._theme.font("small"))
            item.setLabel("bottom", time_name, color=t.text)
        self.cursor.setPen(pg.mkPen(t.blue, width=1))
        self.play.setPen(pg.mkPen(t.text, width=2))
        for line in (self.cursor, self.play):
            line.hide()
            line.setZValue(20)
            item.addItem(line, ignoreBounds=True)

    # -- contents -----------------------------------------------------------------------------------

    def empty(self) -> None:
        """Take out what belongs to one braking."""
        for extra in self._extras:
            self.item.removeItem(extra)
        self._extras = []

    def show_curve(self, curve: Curve) -> None:
        """Draw a quantity over time."""
        if self._curve is None:
            colour = self._theme.current.series.get(curve.name, self._theme.current.sound)
            self._curve = self.item.plot(pen=pg.mkPen(colour), connect="finite")
        values = curve.values
        with_gaps = curve.name == MU
        self._curve.setData(curve.time_s(), values, skipFiniteCheck=not with_gaps)
        known = values[np.isfinite(values)] if with_gaps else values
        low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
        if with_gaps:
            low, high = max(low, _FRICTION[0]), min(high, _FRICTION[1])
        room = 0.06 * (high - low) or 0.5
        self._range = (low - room, high + room)

    def show_picture(self, picture: SoundPicture, events: dict[str, list[Any]]) -> None:
        """Draw the spectrogram, and a frame around each event."""
        levels = picture.level_db
        top = max(float(levels.max()), _LEAST_TOP_DB)
        if self._image is None:
            self._image = pg.ImageItem(axisOrder="row-major")
            self._image.setColorMap("viridis")
            self.item.addItem(self._image, ignoreBounds=True)
        self._image.setImage(levels.T, autoLevels=False, levels=(top - _RANGE_DB, top))
        self._image.setRect(
            QRectF(
                picture.t0_s - picture.dt_s / 2,
                -picture.line_hz / 2e3,
                picture.dt_s * levels.shape[0],
                picture.line_hz * levels.shape[1] / 1e3,
            )
        )
        highest = max((f for f in events.get("frequency_hz", ()) if f), default=0.0)
        nyquist_khz = picture.line_hz * (levels.shape[1] - 1) / 1e3
        self._range = (0.0, min(nyquist_khz, max(8.0, 1.6 * highest / 1e3)))
        self._show_events(events)

    def _show_events(self, events: dict[str, list[Any]]) -> None:
        for number, frequency in enumerate(events.get("frequency_hz", ())):
            start, length = (events[name][number] for name in ("start_s", "duration_s"))
            if start is None or length is None:
                continue
            harmonics = events.get("harmonic_of")
            harmonic = harmonics is not None and harmonics[number] not in (None, -1)
            f_khz = frequency / 1e3
            x = np.array([0.0, length, length, 0.0, 0.0]) + start
            y = np.array([-1, -1, 1, 1, -1]) * _BOX_KHZ + f_khz
            style = Qt.PenStyle.DotLine if harmonic else Qt.PenStyle.DashLine
            self._add(pg.PlotCurveItem(x, y, pen=pg.mkPen("#ffffff", width=1, style=style)))
            if not harmonic:
                words = f"{frequency:.0f} Hz  {number_text(events['level_db'][number], 0)} dB"
                label = pg.TextItem(words, color="#ffffff", anchor=(0, 1), fill=pg.mkBrush(0, 0, 0, 130))
                label.setFont(self._theme.font("small"))
                label.setPos(start, f_khz + _BOX_KHZ)
                self._add(label)

    def show_marks(self, marks: Sequence[Mark]) -> None:
        """A dotted line for each mark."""
        colour = "#ffffff" if self._image is not None else self._theme.current.plot_line
        for mark in marks:
            line = pg.InfiniteLine(mark.time_s, angle=90, pen=pg.mkPen(colour, style=Qt.PenStyle.DotLine))
            line.setToolTip(mark.words)
            self._add(line)

    def _add(self, extra: Any) -> None:
        self._extras.append(extra)
        self.item.addItem(extra, ignoreBounds=True)

    def show_all_values(self) -> None:
        """The whole range of values."""
        self.item.setYRange(*self._range, padding=0)

    def write(self, first: str, second: str) -> None:
        """Two lines beside the row."""
        t = self._theme.current
        words = f"<span style='color:{t.muted}'>{first}</span><br>"
        words += f"<span style='color:{t.text}'>{second or '&nbsp;'}</span>"
        self.title.setText(words, size=f"{self._theme.font('small').pointSizeF():.1f}pt")

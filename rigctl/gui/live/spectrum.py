"""Spectrum of the newest sound with the threshold of squeal and the events that are going on.

Job: levels over frequency, largest of the last time, squeal band, threshold line, marks with frequency
and level. Not its job: finding events (`peaks`).
"""

from __future__ import annotations

import math

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor

from rigctl.gui.format import frequency_text, quantity_text
from rigctl.gui.live.axes import PlainAxis
from rigctl.gui.live.data import SILENT_AFTER_S, LiveData
from rigctl.gui.live.groups import TimeGroup, XGroup
from rigctl.gui.live.items import LineItem, OutsideItem, pen
from rigctl.gui.live.peaks import LiveEvent
from rigctl.gui.live.plot import LivePlot
from rigctl.gui.live.ranges import clock_text
from rigctl.gui.live.sound import LiveSpectrum
from rigctl.gui.theme import ThemeKeeper

LEVELS_DB = (0.0, 120.0)
_MARKS = 4
_ABOVE_DB = 4.0


class SpectrumPlot(LivePlot):
    """Level over frequency.

    Parameters
    ----------
    theme : ThemeKeeper
    group : XGroup
        Of the frequency axis.
    time : TimeGroup
        Its cursors, when shown, choose the moments: A, and B as dotted line. Else the newest is shown.
    """

    def __init__(self, theme: ThemeKeeper, group: XGroup, time: TimeGroup) -> None:
        super().__init__(theme, group, "", PlainAxis("bottom", theme, factor=1e-3))
        self._time = time
        self._sound: LiveSpectrum | None = None
        self._shown: NDArray[np.floating] | None = None
        self.title.setText(self.tr("Spectrum (dB re 20 µPa)"))
        self.x_axis.name(self.tr("Frequency (kHz)"))
        self._hold = LineItem(pen(theme.current.line))
        self._outside = OutsideItem(theme.current.window, 255, vertical=True)
        self._threshold = pg.InfiniteLine(angle=0, movable=False)
        self._marks = pg.ScatterPlotItem(symbol="t", size=theme.px(1.5), pxMode=True)
        self._labels = [pg.TextItem(anchor=(0.5, 1.3)) for _ in range(_MARKS)]
        self._threshold_label = pg.TextItem(anchor=(1.0, 1.0))
        self._line = LineItem(pen(theme.current.sound))
        for order, item in enumerate(
            (self._outside, self._hold, self._line, self._threshold, self._threshold_label, self._marks)
        ):
            item.setZValue(order - 10)
            self.graphics.add(item)
        for label in self._labels:
            self.graphics.add(label)
            label.hide()
        self.colour()

    def colour(self) -> None:
        """Colours of the present theme."""
        look = self.theme.current
        self._line.set_pen(pen(look.sound))
        self._hold.set_pen(pen(look.plot_line, 1.0, Qt.PenStyle.DotLine))
        self._outside.colour = look.panel
        self._threshold.setPen(pen(look.muted, 1.0, Qt.PenStyle.DashLine))
        self._marks.setBrush(look.amber)
        self._marks.setPen(pen(look.on_amber))
        self._marks.setSize(self.theme.px(1.5))
        self._threshold_label.setColor(look.muted)
        self._threshold_label.setFont(self.theme.font("small"))
        for label in self._labels:
            label.setColor(look.on_amber)
            label.fill = pg.mkBrush(QColor(look.amber))
            label.setFont(self.theme.font("small"))

    def draw(self, data: LiveData) -> None:
        """The newest frame."""
        sound = self._sound = data.sound
        whole = (0.0, 20_000.0 if sound is None else sound.rate_hz / 2)
        x = self.group.window(whole)
        self.set_ranges(x, LEVELS_DB)
        self._show_settings(sound, x)
        self._shown, second, events = self._moments(data)
        if sound is None or self._shown is None:
            self._show_events([], x)
            for line in (self._line, self._hold):
                line.set_points(np.empty(0), np.empty(0))
            self.show_hint(self._why_empty(data))
            return
        self.show_hint("")
        self._line.set_points(*_largest(sound.line_hz, self._shown, x, self.pixels()))
        second = np.empty(0) if second is None else second
        self._hold.set_points(*_largest(sound.line_hz, second, x, self.pixels()))
        self._show_events(sorted(events, key=lambda event: -event.level_db), x)

    def _moments(
        self, data: LiveData
    ) -> tuple[NDArray[np.floating] | None, NDArray[np.floating] | None, list[LiveEvent]]:
        """Levels to be shown, those of the dotted line, and the events at that time."""
        sound, cursors = data.sound, self._time.cursors
        if sound is None:
            return None, None, []
        if cursors is None:
            going_on = [] if self._stale(data, sound) else [event for event in sound.events() if event.open]
            return sound.spectrum_db, sound.hold_db, going_on
        first, second = (sound.spectrogram.column_db(t_s) for t_s in cursors)
        events = [event for event in sound.events() if event.start_s <= cursors[0] <= event.end_s]
        return first, second, events

    @staticmethod
    def _stale(data: LiveData, sound: LiveSpectrum) -> bool:
        """True when the rig goes on and sound has not come for long."""
        return math.isfinite(sound.spectrum_s) and sound.spectrum_s < data.end_s - SILENT_AFTER_S

    def _why_empty(self, data: LiveData) -> str:
        if not math.isfinite(data.end_s):
            return ""
        if self._time.cursors is not None:
            return self.tr("No sound at cursor A.")
        return self.tr("No sound yet.")

    def _show_settings(self, sound: LiveSpectrum | None, x: tuple[float, float]) -> None:
        if sound is None:
            return
        settings = sound.settings
        if self._outside.band != settings.band_hz:
            self._outside.band = settings.band_hz
            self._threshold.setValue(settings.threshold_db)
            words = self.tr("threshold {0}").format(quantity_text(settings.threshold_db, "dB", 0))
            self._threshold_label.setText(words)
        self._threshold_label.setPos(x[1], settings.threshold_db)

    def _show_events(self, events: list[LiveEvent], x: tuple[float, float]) -> None:
        """Marks on the level that the line has now; labels for the loudest."""
        sound = self._sound
        points: list[tuple[float, float, LiveEvent]] = []
        for event in events:
            if sound is not None and self._shown is not None:
                line = round(event.frequency_hz / sound.line_hz)
                near = self._shown[max(line - 2, 0) : line + 3]
                points.append((event.frequency_hz, float(near.max()), event))
        self._marks.setData([p[0] for p in points], [p[1] + _ABOVE_DB for p in points])
        wanted = [point for point in points if not point[2].harmonic and x[0] <= point[0] <= x[1]]
        per_pixel = [(high - low) / max(size, 1.0) for (low, high), size in zip(
            self.view.viewRange(), (self.view.width(), self.view.height()), strict=True)]  # fmt: skip
        wanted = sorted(wanted[:_MARKS], key=lambda point: point[0])
        placed: list[tuple[float, float]] = []
        for number, label in enumerate(self._labels):
            label.setVisible(number < len(wanted))
            if number >= len(wanted):
                continue
            frequency_hz, level, _ = wanted[number]
            label.setText(f"{frequency_text(frequency_hz)}  {quantity_text(level, 'dB', 0)}")
            size = label.boundingRect().size()
            wide, tall = 1.03 * size.width() * per_pixel[0], 1.05 * size.height() * per_pixel[1]
            at_db = min(level + _ABOVE_DB, LEVELS_DB[1] - 1.3 * tall)
            at_hz = min(max(frequency_hz, x[0] + wide / 2), x[1] - wide / 2)
            beside = [hz for hz, db in placed if abs(db - at_db) < tall and at_hz - hz < wide]
            if beside:
                at_hz = max(beside) + wide
            if at_hz > x[1] - wide / 2:  # no room to the right: below
                at_hz, at_db = x[1] - wide / 2, at_db - tall * len(beside)
            placed.append((at_hz, at_db))
            label.setPos(at_hz, at_db)

    def value_text(self, data: LiveData) -> str:
        """The loudest event at the shown moment."""
        cursors = self._time.cursors
        words = "" if cursors is None else self.tr("at A {0}, dotted: B").format(clock_text(cursors[0], 0.01))
        sound, events = data.sound, self._moments(data)[2]
        if cursors is None and sound is not None and self._stale(data, sound):
            words = self.tr("newest sound, from {0}").format(clock_text(sound.spectrum_s))
        if events:
            loudest = max(events, key=lambda event: event.level_db)
            squeal = self.tr("squeal {0}").format(frequency_text(loudest.frequency_hz))
            words = f"<b>▼ {squeal}</b> {words}"
        return words

    def _level(self, frequency_hz: float) -> float:
        if self._sound is None or self._shown is None:
            return math.nan
        line = round(frequency_hz / self._sound.line_hz)
        return float(self._shown[line]) if 0 <= line < len(self._shown) else math.nan

    def describe(self, x: float, y: float) -> str:
        """Level of the line under the mouse."""
        return f"{frequency_text(x)}   {quantity_text(self._level(x), 'dB', 1)}"

    def cursor_value(self, x: float) -> float:
        """Level at a cursor."""
        return self._level(x)

    def cursor_words(self, a: float, b: float) -> str:
        """A, B and B−A."""
        level_a, level_b = self._level(a), self._level(b)
        return "    ".join(
            (
                f"A {frequency_text(a)}  {quantity_text(level_a, 'dB', 1)}",
                f"B {frequency_text(b)}  {quantity_text(level_b, 'dB', 1)}",
                f"B−A {frequency_text(b - a)}  {quantity_text(level_b - level_a, 'dB', 1)}",
            )
        )


def _largest(
    line_hz: float, levels: NDArray[np.floating], x: tuple[float, float], pixels: int
) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
    """Lines of a stretch; with more than two per pixel, the largest of each group at its own frequency."""
    first = max(int(x[0] / line_hz) - 1, 0)
    stop = min(int(x[1] / line_hz) + 2, len(levels))
    if stop <= first:
        return np.empty(0), np.empty(0)
    group = max((stop - first) // max(pixels, 1), 1)
    y = levels[first:stop]
    if group == 1:
        return np.arange(first, stop) * line_hz, y
    starts = np.arange(0, len(y), group)
    padded = np.full(len(starts) * group, -np.inf)
    padded[: len(y)] = y
    at = padded.reshape(-1, group).argmax(axis=1) + starts
    return (first + at) * line_hz, y[at]

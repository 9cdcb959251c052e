"""Sound pressure over time, and sound levels over time.

Job: the waveform with every peak; LAF and LZF. Not its job: spectra.
"""

from __future__ import annotations

import math
import time

import numpy as np
from PySide6.QtCore import QCoreApplication

from rigctl.core.channels import MICROPHONE
from rigctl.gui.format import number_text
from rigctl.gui.live.data import LiveData
from rigctl.gui.live.groups import TimeGroup
from rigctl.gui.live.history import ChannelHistory
from rigctl.gui.live.items import LineItem, pen
from rigctl.gui.live.ranges import CalmRange
from rigctl.gui.live.sound import LAF, LZF
from rigctl.gui.live.trend import TimePlot
from rigctl.gui.theme import ThemeKeeper

_PEAK_S = 1.0
_NO_POINTS = np.empty(0)


def sound_hint(plot: TimePlot, data: LiveData) -> str:
    """Why there is no sound to be seen; empty when there is."""
    history = data.buffer.channels.get(MICROPHONE)
    if not math.isfinite(data.end_s):
        return QCoreApplication.translate("LivePlot", "No signals yet. They appear when a rig is running.")
    if history is None:
        return QCoreApplication.translate("LivePlot", "This rig has no microphone.")
    if history.end_s < plot.stretch(data)[0]:
        return QCoreApplication.translate(
            "LivePlot", "No sound now. A simulated rig makes sound while a braking is recorded."
        )
    return ""


class WaveformPlot(TimePlot):
    """Sound pressure."""

    unit, decimals = "Pa", 3

    def __init__(self, theme: ThemeKeeper, group: TimeGroup) -> None:
        super().__init__(theme, group, "")
        self._range = CalmRange(0.02, symmetric=True)
        self.title.setText(self.tr("Sound pressure (Pa)"))
        self._line = LineItem(pen(theme.current.sound))
        self.graphics.add(self._line)

    def colour(self) -> None:
        """Colours of the present theme."""
        self._line.set_pen(pen(self.theme.current.sound))

    def history(self) -> ChannelHistory | None:
        """Of the microphone."""
        return None if self.data is None else self.data.buffer.channels.get(MICROPHONE)

    def draw(self, data: LiveData) -> None:
        """Envelope of the shown stretch."""
        t0, t1 = self.stretch(data)
        history = data.buffer.channels.get(MICROPHONE)
        self.show_hint(sound_hint(self, data))
        if history is not None:
            envelope = history.envelope(t0, t1, self.pixels())
            self._line.set_envelope(envelope)
            found = envelope.extremes()
            if found is not None:
                self._range.follow(*found, time.monotonic())
        else:
            self._line.set_points(_NO_POINTS, _NO_POINTS)
        self.set_ranges((t0, t1), (self._range.low, self._range.high))

    def value_text(self, data: LiveData) -> str:
        """Largest pressure of the last second."""
        history = data.buffer.channels.get(MICROPHONE)
        if sound_hint(self, data):
            return ""
        found = None if history is None else history.extremes(history.end_s - _PEAK_S, history.end_s)
        if found is None:
            return ""
        peak = number_text(max(abs(found[0]), abs(found[1])), 2)
        words = self.tr("peak {0}").format(peak)  # not in an f-string: lupdate does not look into those
        return f"<b>{words}</b>"


class LevelPlot(TimePlot):
    """Sound levels, fast: A-weighted (strong line) and unweighted."""

    unit, decimals = "dB", 1

    def __init__(self, theme: ThemeKeeper, group: TimeGroup) -> None:
        super().__init__(theme, group, "")
        self._lines: dict[str, LineItem] = {}
        self._range = CalmRange(40.0, start=(40.0, 100.0))
        self.title.setText(self.tr("Sound level, fast (dB)"))
        self.x_axis.name(self.tr("Rig time (h:mm:ss)"))
        for name in (LZF, LAF):
            self._lines[name] = LineItem(pen("#000000"))
            self.graphics.add(self._lines[name])
        self.colour()

    def colour(self) -> None:
        """Colours of the present theme."""
        self._lines[LAF].set_pen(pen(self.theme.current.text, 2.0))
        self._lines[LZF].set_pen(pen(self.theme.current.plot_line, 1.0))

    def history(self) -> ChannelHistory | None:
        """Of the A-weighted level."""
        return None if self.data is None or self.data.sound is None else self.data.sound.levels[LAF]

    def draw(self, data: LiveData) -> None:
        """Both levels of the shown stretch."""
        t0, t1 = self.stretch(data)
        self.show_hint(sound_hint(self, data))
        lows: list[float] = []
        highs: list[float] = []
        for name, line in self._lines.items():
            if data.sound is None:
                line.set_points(_NO_POINTS, _NO_POINTS)
                continue
            envelope = data.sound.levels[name].envelope(t0, t1, self.pixels())
            line.set_envelope(envelope)
            found = envelope.extremes()
            if found is not None:
                lows.append(max(found[0], 0.0))
                highs.append(max(found[1], 0.0))
        if lows:
            self._range.follow(min(lows), max(highs), time.monotonic())
        self.set_ranges((t0, t1), (self._range.low, self._range.high))

    def value_text(self, data: LiveData) -> str:
        """Present levels."""
        if data.sound is None or sound_hint(self, data):
            return ""
        newest = [history.value(history.end_s - 1.0 / history.rate_hz)
                  for history in (data.sound.levels[LAF], data.sound.levels[LZF])]  # fmt: skip
        muted = self.theme.current.muted
        laf, lzf = (number_text(value, 1) for value in newest)
        return f"<b>LAF {laf}</b> &nbsp;<span style='color:{muted}'>LZF {lzf}</span>"

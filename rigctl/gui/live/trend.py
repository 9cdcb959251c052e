"""Slow channels over time, one under the other: pressure, torque, speed, temperatures, mu.

Job: rows with set-point line (blue), limit band and present value; which rows are shown. Not its job:
sound.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtWidgets import QSplitter, QVBoxLayout, QWidget

from rigctl.core.channels import DISC_TEMPERATURE, MICROPHONE, PRESSURE, SPEED, TORQUE, ChannelSpec
from rigctl.gui.format import number_text, quantity_text
from rigctl.gui.live.buffer import MU
from rigctl.gui.live.data import LiveData
from rigctl.gui.live.groups import TimeGroup
from rigctl.gui.live.history import ChannelHistory
from rigctl.gui.live.items import LimitItem, LineItem, pen
from rigctl.gui.live.limits import Bands
from rigctl.gui.live.plot import LivePlot
from rigctl.gui.live.ranges import CalmRange, clock_text
from rigctl.gui.theme import ThemeKeeper

_VALUE_S = 0.25  # the present value is the mean of so much


@dataclass(frozen=True, slots=True)
class RowSpec:
    """One row: id (a channel name, or "temperatures"), title, unit, decimals, least span of its axis."""

    row: str
    title: str
    unit: str
    decimals: int
    least: float


def spread_text(low: float, high: float, unit: str, decimals: int) -> str:
    """What lies in one pixel: a value, or its least and largest."""
    if math.isnan(low):
        return number_text(low)
    first, last = number_text(low, decimals), number_text(high, decimals)
    return quantity_text(high, unit, decimals) if first == last else f"{first} … {last}\u202f{unit}"


class TimePlot(LivePlot):
    """A plot over rig time; `x_axis` and hover speak of clock times."""

    group: TimeGroup

    def stretch(self, data: LiveData) -> tuple[float, float]:
        """What is shown of the time."""
        return self.group.stretch(data.end_s)

    def history(self) -> ChannelHistory | None:
        """Of the first line of the plot."""
        return None

    unit, decimals = "", 1

    def describe(self, x: float, y: float) -> str:
        """Clock time and what lies under the mouse's column of pixels."""
        history, (t0, t1) = self.history(), self.view.viewRange()[0]
        if history is None:
            return ""
        width_s = (t1 - t0) / self.pixels()
        found = history.envelope(x - width_s / 2, x + width_s / 2, 1).extremes()
        low, high = found or (math.nan, math.nan)
        return f"{clock_text(x, width_s)}   {spread_text(low, high, self.unit, self.decimals)}"

    def cursor_value(self, x: float) -> float:
        """The sample at a cursor."""
        history = self.history()
        return math.nan if history is None else history.value(x)

    def cursor_words(self, a: float, b: float) -> str:
        """A, B and B−A."""
        t0, t1 = self.view.viewRange()[0]
        step_s = max((t1 - t0) / self.pixels(), 1e-4)
        parts: list[str] = []
        for name, x in (("A", a), ("B", b)):
            value = number_text(self.cursor_value(x), self.decimals)
            parts.append(f"{name} {clock_text(x, step_s)}  {value}")
        difference = number_text(self.cursor_value(b) - self.cursor_value(a), self.decimals)
        parts.append(f"B−A {number_text(b - a, 3)}\u202fs  {difference}\u202f{self.unit}")
        return "    ".join(parts)


class TrendRow(TimePlot):
    """One quantity over time. With several channels (temperatures), each has its own line."""

    def __init__(self, theme: ThemeKeeper, group: TimeGroup, spec: RowSpec) -> None:
        self.spec = spec
        self.unit, self.decimals = spec.unit, spec.decimals
        super().__init__(theme, group, f"{spec.title} ({spec.unit})" if spec.unit else spec.title)
        self.channels: list[str] = [spec.row]
        self._lines: list[LineItem] = []
        self._range = CalmRange(spec.least, zero=spec.row != "temperatures")
        self._limits = LimitItem(theme.current.red)
        self._setpoint = LineItem(pen(theme.current.blue, 3.0))
        for item, order in ((self._limits, -10), (self._setpoint, -5)):
            item.setZValue(order)
            self.graphics.add(item)
        self.set_channels(self.channels)

    def set_channels(self, channels: list[str]) -> None:
        """Channels of this row; the first one gives value and read-out."""
        self.channels = channels
        while len(self._lines) < len(channels):
            line = LineItem(pen("#000000"))
            self._lines.append(line)
            self.graphics.add(line)
        while len(self._lines) > len(channels):
            self.graphics.remove(self._lines.pop())
        self.colour()

    def colour(self) -> None:
        """Colours of the present theme."""
        look = self.theme.current
        styles = (Qt.PenStyle.SolidLine, Qt.PenStyle.DashLine, Qt.PenStyle.DotLine)
        for number, line in enumerate(self._lines):
            colour = look.series.get(self.channels[number], look.temperature)
            line.set_pen(pen(colour, 1.0, styles[number % len(styles)]))
        self._limits.colour = look.red
        self._setpoint.set_pen(pen(look.blue, 3.0))

    def set_limits(self, band: tuple[float, float] | None) -> None:
        """Limits of the row's quantity."""
        self._limits.band = band
        self._limits.update()

    def history(self) -> ChannelHistory | None:
        """Of the first channel."""
        return None if self.data is None else self.data.buffer.channels.get(self.channels[0])

    def draw(self, data: LiveData) -> None:
        """Envelopes and set-points of the shown stretch."""
        t0, t1 = self.stretch(data)
        lows: list[float] = []
        highs: list[float] = []
        for line, name in zip(self._lines, self.channels, strict=True):
            history = data.buffer.channels.get(name)
            if history is None:
                line.set_points(np.empty(0), np.empty(0))
                continue
            envelope = history.envelope(t0, t1, self.pixels())
            line.set_envelope(envelope)
            found = envelope.extremes()
            if found is not None:
                lows.append(found[0])
                highs.append(found[1])
        series = data.setpoints.get(self.channels[0])
        if series is not None:
            t, values = series.course(t0, t1)
            self._setpoint.set_points(t, values)
            valid = values[np.isfinite(values)]
            if len(valid):
                lows.append(float(valid.min()))
                highs.append(float(valid.max()))
        if lows:
            self._range.follow(min(lows), max(highs), time.monotonic())
        self.set_ranges((t0, t1), (self._range.low, self._range.high))

    def value_text(self, data: LiveData) -> str:
        """Present value; the set-point in blue behind it."""
        history = data.buffer.channels.get(self.channels[0])
        value = math.nan if history is None else history.mean(data.end_s - _VALUE_S, data.end_s)
        text = f"<b>{number_text(value, self.decimals)}</b>"
        series = data.setpoints.get(self.channels[0])
        if series is not None and math.isfinite(series.value()):
            words = self.tr("set {0}").format(number_text(series.value(), self.decimals))
            text += f" <span style='color:{self.theme.current.blue}'>&nbsp;{words}</span>"
        return text


class TrendPlot(QWidget):
    """Rows of trends with one time axis; drag between rows to give one more room.

    Parameters
    ----------
    theme : ThemeKeeper
    group : TimeGroup
    """

    menuAsked = Signal(object, QPoint)
    resized = Signal()

    def __init__(self, theme: ThemeKeeper, group: TimeGroup) -> None:
        super().__init__()
        self._theme = theme
        self._group = group
        self._bands: Bands = {}
        self.splitter = QSplitter(Qt.Orientation.Vertical)
        self.splitter.setChildrenCollapsible(False)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.splitter)
        self.rows: dict[str, TrendRow] = {}
        for spec in (
            RowSpec(PRESSURE, self.tr("Pressure"), "bar", 1, 2.0),
            RowSpec(TORQUE, self.tr("Torque"), "N·m", 0, 20.0),
            RowSpec(SPEED, self.tr("Speed"), "1/min", 0, 20.0),
            RowSpec("temperatures", self.tr("Temperature"), "°C", 0, 20.0),
            RowSpec(MU, self.tr("Friction coefficient µ"), "", 2, 0.2),
        ):
            self._add(spec)
        self.rows["temperatures"].set_channels([DISC_TEMPERATURE])
        self._show_axis()

    def _add(self, spec: RowSpec) -> None:
        row = TrendRow(self._theme, self._group, spec)
        row.menuAsked.connect(self.menuAsked)
        row.resized.connect(self.resized)
        self.rows[spec.row] = row
        self.splitter.addWidget(row)

    def plots(self) -> list[TrendRow]:
        """The rows that are shown."""
        return [row for row in self.rows.values() if not row.isHidden()]

    def set_channels(self, specs: list[ChannelSpec]) -> None:
        """Channels of a session: temperatures share a row; what rigctl does not know gets its own."""
        temperatures = [s.name for s in specs if s.unit == "°C"]
        first = [name for name in temperatures if name == DISC_TEMPERATURE]
        ordered = first + [name for name in temperatures if name != DISC_TEMPERATURE]
        self.rows["temperatures"].set_channels(ordered or [DISC_TEMPERATURE])
        for spec in specs:
            if spec.name not in (*self.rows, *temperatures, MICROPHONE):
                self._add(RowSpec(spec.name, spec.name.replace("_", " "), spec.unit, 2, 1.0))
        self._show_axis()

    def titles(self) -> dict[str, str]:
        """Names of all rows, for a menu."""
        return {row: plot.spec.title for row, plot in self.rows.items()}

    def set_shown(self, row: str, shown: bool) -> None:
        """Show or hide a row; the last one stays."""
        if not shown and len(self.plots()) == 1:
            return
        self.rows[row].setVisible(shown)
        self._show_axis()

    def set_limits(self, bands: Bands) -> None:
        """Limits by channel name."""
        for row in self.rows.values():
            row.set_limits(bands.get(row.channels[0]))

    def refresh(self, data: LiveData) -> None:
        """Draw all rows that are shown."""
        empty = not math.isfinite(data.end_s)
        for number, row in enumerate(self.plots()):
            row.refresh(data)
            waiting = empty and number == 0
            row.show_hint(self.tr("No signals yet. They appear when a rig is running.") if waiting else "")

    def _show_axis(self) -> None:
        shown = self.plots()
        for row in shown:
            row.show_x_axis(row is shown[-1])
            row.x_axis.name(self.tr("Rig time (h:mm:ss)") if row is shown[-1] else "")

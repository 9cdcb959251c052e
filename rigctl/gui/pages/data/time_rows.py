"""All channels of a braking below each other on one time axis, the spectrogram among them.

Job: rows that can be switched on and off, events and marks drawn into them, one cursor with the values
below the mouse, zoom by wheel along the time. Not its job: reading the braking, tables.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPoint, QRectF, Qt, Signal
from PySide6.QtGui import QContextMenuEvent, QFontMetricsF, QGuiApplication
from PySide6.QtWidgets import QMenu

from rigctl.analysis.braking_view import LEVEL, MU, BrakingView, Curve, SoundPicture
from rigctl.core.channels import DISC_TEMPERATURE, MICROPHONE, PRESSURE, SPEED, TORQUE
from rigctl.gui.format import number_text
from rigctl.gui.pages.data.marks import Mark
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.file_asking import ask_save
from rigctl.gui.widgets.plot_dress import save_picture

SPECTROGRAM = "spectrogram"
ROWS = (SPECTROGRAM, MICROPHONE, LEVEL, PRESSURE, TORQUE, SPEED, DISC_TEMPERATURE, MU)
DECIMALS = {LEVEL: 1, PRESSURE: 1, TORQUE: 0, SPEED: 1, DISC_TEMPERATURE: 0, MU: 3, MICROPHONE: 3}
_TALL = 3
_LEAST_FIRST = (SPEED, LEVEL, DISC_TEMPERATURE, TORQUE, MU, PRESSURE, MICROPHONE)
"""Rows that give way first where there is little room."""
_LEAST_HEIGHT = 3.25
_RANGE_DB = 70.0


class _Row:
    """One plot with its title, cursor lines and curve."""

    def __init__(self, item: Any, name: str) -> None:
        self.item = item
        self.name = name
        self.title = pg.LabelItem(justify="left")
        self.cursor = pg.InfiniteLine(angle=90, movable=False)
        self.play = pg.InfiniteLine(angle=90, movable=False)
        self.curve: Any = None
        self.image: Any = None
        self.extras: list[Any] = []


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


class TimeRows(pg.GraphicsLayoutWidget):
    """The plots of one braking."""

    timePointed = Signal(float)
    """Time below the mouse, s; NaN when it has left."""
    timeClicked = Signal(float)

    def __init__(self, theme: ThemeKeeper, notify: Callable[[str], None]) -> None:
        super().__init__()
        self._theme, self._notify = theme, notify
        self.setObjectName("data-rows")
        self.setMinimumHeight(0)
        self.titles: dict[str, tuple[str, str]] = {}
        self.shown: set[str] = {name for name in ROWS if name != LEVEL}
        self._view: BrakingView | None = None
        self._marks: Sequence[Mark] = ()
        self._rows: dict[str, _Row] = {}
        self._play_s: float | None = None
        scene: Any = self.scene()
        scene.sigMouseMoved.connect(self._on_mouse)
        scene.sigMouseClicked.connect(self._on_click)
        theme.changed.connect(self._restyle)

    # -- contents -----------------------------------------------------------------------------------

    def show_view(self, view: BrakingView | None, marks: Sequence[Mark] = ()) -> None:
        """Draw a braking, from its beginning to its end."""
        self._view, self._marks = view, marks
        self._build()
        self.show_all()

    def available(self) -> list[str]:
        """Rows for which the present braking has values."""
        if self._view is None:
            return []
        return [
            n for n in ROWS if n in self._view.curves or (n == SPECTROGRAM and self._view.picture is not None)
        ]

    def set_shown(self, name: str, shown: bool) -> None:
        """Switch a row on or off; the stretch of time stays."""
        (self.shown.add if shown else self.shown.discard)(name)
        self._rebuild()

    def span(self) -> tuple[float, float] | None:
        """Stretch of time that is shown, s."""
        row = self._first()
        if row is None:
            return None
        low, high = row.item.vb.viewRange()[0]
        return float(low), float(high)

    def set_span(self, start_s: float, end_s: float) -> None:
        """Show a stretch of time."""
        row = self._first()
        if row is not None:
            row.item.setXRange(start_s, end_s, padding=0)

    def show_all(self) -> None:
        """From the first sample to the last, all values."""
        if self._view is None:
            return
        self.set_span(0.0, max(float(self._view.summary.get("duration_s") or 1.0), 0.1))
        for row in self._rows.values():
            if row.name != SPECTROGRAM:
                row.item.enableAutoRange(axis="y")

    def show_event(self, start_s: float, end_s: float) -> None:
        """Show an event with a second around it."""
        self.set_span(start_s - 0.5, end_s + 0.5)

    def set_play(self, time_s: float | None) -> None:
        """Where the sound is; None when it is not played."""
        self._play_s = time_s
        for row in self._rows.values():
            row.play.setVisible(time_s is not None)
            if time_s is not None:
                row.play.setPos(time_s)

    def _rebuild(self) -> None:
        """Make the rows anew; the stretch of time stays."""
        span = self.span()
        self._build()
        if span is not None:
            self.set_span(*span)

    # -- making -------------------------------------------------------------------------------------

    def _first(self) -> _Row | None:
        return next(iter(self._rows.values()), None)

    def _build(self) -> None:
        self.ci.clear()
        self._rows = {}
        view = self._view
        if view is None:
            return
        names = self._names_that_fit()
        layout: Any = self.ci.layout
        layout.setVerticalSpacing(self._theme.px(0.25))
        layout.setContentsMargins(*[self._theme.px(0.5)] * 4)
        layout.setHorizontalSpacing(0)
        layout.setColumnFixedWidth(0, self._theme.px(8.5))
        for number, name in enumerate(names):
            axis = FewTicks(self._theme)
            item: Any = self.ci.addPlot(row=number, col=1, enableMenu=False, axisItems={"left": axis})
            row = self._rows[name] = self._dress(item, name, last=number == len(names) - 1)
            self.ci.addItem(row.title, row=number, col=0)
        first = self._first()
        for name, row in self._rows.items():
            if first is not None and row is not first:
                row.item.setXLink(first.item)
            if name == SPECTROGRAM and view.picture is not None:
                self._draw_picture(row, view.picture, view.summary)
            elif name in view.curves:
                self._draw_curve(row, view.curves[name])
            self._draw_marks(row)
            self._say(row, None)
        self._share_height()

    def _names_that_fit(self) -> list[str]:
        """Rows that are switched on, as far as they are not too low to be read."""
        names = [name for name in self.available() if name in self.shown]
        for name in _LEAST_FIRST:
            if len(names) > 1 and name in names and self._unit(names) < self._theme.px(_LEAST_HEIGHT):
                names.remove(name)
        return names

    def _unit(self, names: Sequence[str]) -> float:
        """Height of a curve, px."""
        edges = self._theme.px(1) + self._theme.px(0.25) * max(len(names) - 1, 0) + self._theme.px(4.5)
        parts = sum(_TALL if name == SPECTROGRAM else 1 for name in names)
        return max((self.height() - edges) / max(parts, 1), 1.0)

    def _share_height(self) -> None:
        """The spectrogram is three times as high as a curve, the last row has the time axis below it."""
        layout: Any = self.ci.layout
        axis = self._theme.px(4.5)
        names = list(self._rows)
        unit = self._unit(names)
        for number in range(layout.rowCount()):
            name = names[number] if number < len(names) else ""
            height = unit * (_TALL if name == SPECTROGRAM else 1) if name else 0.0
            layout.setRowFixedHeight(number, height + (axis if number == len(names) - 1 else 0))

    def resizeEvent(self, event: Any) -> None:
        """Share the new height."""
        super().resizeEvent(event)
        if not hasattr(self, "_rows"):  # called while it is being made
            return
        if list(self._rows) == self._names_that_fit():
            self._share_height()
        else:
            self._rebuild()

    def _dress(self, item: Any, name: str, last: bool) -> _Row:
        t, row = self._theme.current, _Row(item, name)
        item.hideButtons()
        item.setMouseEnabled(x=True, y=False)
        item.setClipToView(True)
        item.setDownsampling(auto=True, mode="peak")
        for side in ("left", "bottom"):
            axis = item.getAxis(side)
            axis.enableAutoSIPrefix(False)
            axis.setPen(pg.mkPen(t.plot_line))
            axis.setTextPen(pg.mkPen(t.text))
            axis.setTickFont(self._theme.font("small"))
        item.getAxis("left").setWidth(self._theme.px(5.5))
        item.getAxis("bottom").setStyle(showValues=last)
        if last:
            item.getAxis("bottom").label.setFont(self._theme.font("small"))
            item.setLabel("bottom", self.tr("Time since the first sample [s]"), color=t.text)
            item.getAxis("bottom").setHeight(self._theme.px(4.5))
        else:
            item.getAxis("bottom").setHeight(self._theme.px(0.5))
        row.cursor.setPen(pg.mkPen(t.blue, width=1))
        row.cursor.hide()
        row.play.setPen(pg.mkPen(t.text, width=2))
        row.play.setVisible(self._play_s is not None)
        for line in (row.cursor, row.play):
            line.setZValue(20)
            item.addItem(line, ignoreBounds=True)
        return row

    def _draw_curve(self, row: _Row, curve: Curve) -> None:
        colour = self._theme.current.series.get(curve.name, self._theme.current.sound)
        row.curve = row.item.plot(
            curve.time_s(),
            curve.values,
            pen=pg.mkPen(colour),
            connect="finite",
            skipFiniteCheck=curve.name != MU,
        )
        if curve.name == MU:
            row.item.setLimits(yMin=-0.2, yMax=2.0)

    def _draw_picture(self, row: _Row, picture: SoundPicture, summary: dict[str, Any]) -> None:
        levels = picture.level_db
        peak = float(levels.max())
        image = pg.ImageItem(levels.T, axisOrder="row-major")
        image.setColorMap("viridis")
        image.setLevels((peak - _RANGE_DB, peak))
        image.setRect(
            QRectF(
                picture.t0_s - picture.dt_s / 2,
                -picture.line_hz / 2e3,
                picture.dt_s * levels.shape[0],
                picture.line_hz * levels.shape[1] / 1e3,
            )
        )
        row.image = image
        row.item.addItem(image)
        row.item.setMouseEnabled(x=True, y=False)
        frequencies = [f for f in summary["events"].get("frequency_hz", ()) if f]
        nyquist_khz = picture.line_hz * (levels.shape[1] - 1) / 1e3
        top_khz = min(nyquist_khz, max(8.0, 1.6 * max(frequencies, default=0.0) / 1e3))
        row.item.setYRange(0.0, top_khz, padding=0)
        self._draw_events(row, summary["events"])

    def _draw_events(self, row: _Row, events: dict[str, list[Any]]) -> None:
        for number, frequency in enumerate(events.get("frequency_hz", ())):
            start, length = (events[name][number] for name in ("start_s", "duration_s"))
            if start is None or length is None:
                continue
            harmonic = (events.get("harmonic_of") or [-1] * (number + 1))[number] not in (None, -1)
            f_khz = frequency / 1e3
            pen = pg.mkPen(
                "#ffffff", width=1, style=Qt.PenStyle.DotLine if harmonic else Qt.PenStyle.DashLine
            )
            box = pg.PlotCurveItem(
                np.array([0.0, length, length, 0.0, 0.0]) + start,
                f_khz + np.array([-1, -1, 1, 1, -1]) * 0.2,
                pen=pen,
            )
            row.item.addItem(box, ignoreBounds=True)
            if not harmonic:
                words = f"{frequency:.0f} Hz  {number_text(events['level_db'][number], 0)} dB"
                label = pg.TextItem(words, color="#ffffff", anchor=(0, 1), fill=pg.mkBrush(0, 0, 0, 130))
                label.setFont(self._theme.font("small"))
                label.setPos(start, f_khz + 0.25)
                row.item.addItem(label, ignoreBounds=True)

    def _draw_marks(self, row: _Row) -> None:
        colour = "#ffffff" if row.name == SPECTROGRAM else self._theme.current.plot_line
        for mark in self._marks:
            line = pg.InfiniteLine(mark.time_s, angle=90, pen=pg.mkPen(colour, style=Qt.PenStyle.DotLine))
            line.setToolTip(mark.words)
            row.item.addItem(line, ignoreBounds=True)

    # -- reading ------------------------------------------------------------------------------------

    def values_at(self, time_s: float) -> dict[str, float]:
        """Value of each curve at a time."""
        if self._view is None:
            return {}
        found = {}
        for name, curve in self._view.curves.items():
            place = round((time_s - curve.t0_s) / curve.dt_s)
            if 0 <= place < len(curve.values):
                found[name] = float(curve.values[place])
        return found

    def _say(self, row: _Row, values: dict[str, float] | None) -> None:
        """Name and unit beside the row; with a cursor the value before the unit."""
        name, unit = self.titles.get(row.name, (row.name, ""))
        second = unit
        if values is not None and row.name in values:
            number = number_text(values[row.name], DECIMALS.get(row.name, 2))
            second = f"<b>{number}</b> {unit}"
        self._write(row, name, second)

    def _write(self, row: _Row, first: str, second: str) -> None:
        t = self._theme.current
        words = f"<span style='color:{t.muted}'>{first}</span><br>"
        words += f"<span style='color:{t.text}'>{second or '&nbsp;'}</span>"
        row.title.setText(words, size=f"{self._theme.font('small').pointSizeF():.1f}pt")

    def _row_at(self, place: Any) -> tuple[_Row, float, float] | None:
        for row in self._rows.values():
            if row.item.vb.sceneBoundingRect().contains(place):
                point = row.item.vb.mapSceneToView(place)
                return row, float(point.x()), float(point.y())
        return None

    def _on_mouse(self, place: Any) -> None:
        found = self._row_at(place)
        if found is None:
            self._point(None, None)
            return
        row, x, y = found
        self._point(x, y if row.name == SPECTROGRAM else None)

    def _point(self, time_s: float | None, f_khz: float | None) -> None:
        values = None if time_s is None else self.values_at(time_s)
        for row in self._rows.values():
            row.cursor.setVisible(time_s is not None)
            if time_s is not None:
                row.cursor.setPos(time_s)
            self._say(row, values)
        spectrogram = self._rows.get(SPECTROGRAM)
        if spectrogram is not None and time_s is not None and f_khz is not None and self._view is not None:
            level = _level_at(self._view.picture, time_s, f_khz * 1e3)
            if level is not None:
                self._write(spectrogram, f"{f_khz * 1e3:.0f} Hz", f"<b>{level:.0f}</b> dB")
        self.timePointed.emit(float("nan") if time_s is None else time_s)

    def leaveEvent(self, event: Any) -> None:
        """The mouse has left: no cursor."""
        self._point(None, None)
        super().leaveEvent(event)

    def _on_click(self, event: Any) -> None:
        found = self._row_at(event.scenePos())
        if found is not None and event.button() == Qt.MouseButton.LeftButton:
            self.timeClicked.emit(found[1])

    # -- picture ------------------------------------------------------------------------------------

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        """Right click: whole braking, copy, save."""
        self.menu().popup(event.globalPos() if event.globalPos() else QPoint())
        event.accept()

    def menu(self) -> QMenu:
        """The menu, made anew."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for text, action in (
            (self.tr("Whole braking"), self.show_all),
            (self.tr("Copy picture"), self.copy_picture),
            (self.tr("Save picture…"), self._ask_picture),
        ):
            menu.addAction(text).triggered.connect(partial(_call, action))
        return menu

    def copy_picture(self) -> None:
        """To the clipboard."""
        QGuiApplication.clipboard().setPixmap(self.grab())
        self._notify(self.tr("Picture copied"))

    def _ask_picture(self) -> None:
        ask_save(
            self,
            self.tr("Save picture"),
            Path.home() / "braking.png",
            self.tr("Picture (*.png)"),
            lambda path: save_picture(self, path, self._notify),
        )

    def _restyle(self) -> None:
        self.setBackground(self._theme.current.plot)
        self._rebuild()


def _call(action: Callable[[], object], _checked: bool = False) -> None:
    action()


def _level_at(picture: SoundPicture | None, time_s: float, f_hz: float) -> float | None:
    if picture is None:
        return None
    frame = round((time_s - picture.t0_s) / picture.dt_s)
    line = round(f_hz / picture.line_hz)
    frames, lines = picture.level_db.shape
    return float(picture.level_db[frame, line]) if 0 <= frame < frames and 0 <= line < lines else None

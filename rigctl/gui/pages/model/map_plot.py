"""The stability map as a picture: frequency where unstable, boundary, measured squeal, the sliders' place.

Job: show `StabilityMap` and `CampaignPoints`, say what is under the mouse, tell where a person clicked. Not
its job: asking for them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QCoreApplication, QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QGraphicsRectItem

from rigctl.gui.format import frequency_text, quantity_text
from rigctl.gui.pages.model.data import MapAxis, Measured, StabilityMap
from rigctl.gui.pages.model.words import value_text
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.plot_dress import dress

_REACH = 1.5
#: room of a label on a contour line, as shares of the axes
_LABEL_ROOM = np.array([0.07, 0.05])
#: least span of the colours, Hz: a single mode is not spread over the whole scale
_LEAST_SPAN_HZ = 200.0


class MapPlot(pg.PlotWidget):
    """Unstable region in colours of frequency, everything else grey."""

    jumped = Signal(float, float)
    """A person clicked at this place of the axes."""
    chosen = Signal(object)
    """Measured point that was clicked, or None."""
    pointed = Signal(str)

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._map: StabilityMap | None = None
        self._view: tuple[MapAxis, MapAxis] | None = None
        self._names = ("", "")
        self._squeals: list[tuple[Measured, tuple[float, float]]] = []
        self._quiet: list[tuple[Measured, tuple[float, float]]] = []
        self._lines: list[Any] = []
        self.setAccessibleName(self.tr("Stability map"))
        self._item: Any = self.getPlotItem()
        self._item.setClipToView(True)
        self._item.setDownsampling(auto=False)
        self._box: Any = self._item.getViewBox()
        scene: Any = self.scene()
        self._ground = QGraphicsRectItem()
        self._image = pg.ImageItem()
        self._bar: Any = pg.ColorBarItem(
            values=(1000.0, 4000.0), colorMap=pg.colormap.get("viridis"), interactive=False, width=12,
            orientation="vertical",
        )  # fmt: skip
        self._bar.setImageItem(self._image, insert_in=self._item)
        self._marks_quiet = pg.ScatterPlotItem(pxMode=True)
        self._marks = pg.ScatterPlotItem(pxMode=True)
        self._here = pg.ScatterPlotItem(pxMode=True)
        self._ground.setZValue(-20)
        self._image.setZValue(-10)
        self._here.setZValue(20)
        self._marks.setZValue(10)
        self._marks_quiet.setZValue(9)
        for part in (self._ground, self._image, self._marks_quiet, self._marks, self._here):
            self._item.addItem(part)
        scene.sigMouseMoved.connect(self._on_moved)
        scene.sigMouseClicked.connect(self._on_clicked)
        theme.changed.connect(self.restyle)
        self.restyle()

    # -- look -------------------------------------------------------------------------------------

    def restyle(self) -> None:
        """Take the present look."""
        t = self._theme.current
        dress(self, self._theme, *self._names)
        axis = self._bar.axis
        axis.setPen(pg.mkPen(t.plot_line))
        axis.setTextPen(pg.mkPen(t.text))
        axis.setTickFont(self._theme.font("small"))
        axis.label.setFont(self._theme.font("small"))
        name = self.tr("Frequency of the unstable mode [Hz]")
        axis.setLabel(name, siPrefixEnableRanges=(), color=t.text)
        axis.enableAutoSIPrefix(False)
        axis.setWidth(self._theme.px(8))
        self._item.setContentsMargins(0, self._theme.px(1), 0, 0)
        grey = QColor(t.plot_line)
        grey.setAlpha(28)
        self._ground.setBrush(grey)
        self._ground.setPen(pg.mkPen(None))
        if self._map is not None:
            self._draw_lines(self._map)
        self._draw_points()

    def set_names(self, x: str, y: str) -> None:
        """Names of the axes."""
        self._names = (x, y)
        dress(self, self._theme, x, y)

    # -- showing ----------------------------------------------------------------------------------

    def show_map(self, found: StabilityMap | None) -> None:
        """Another map; its whole range comes into view when the axes are others."""
        self._map = found
        for line in self._lines:
            self._item.removeItem(line)
        self._lines = []
        if found is None:
            self._image.clear()
            self._ground.setRect(QRectF())
            return
        x, y = found.x_values, found.y_values
        half_x, half_y = 0.5 * (x[1] - x[0]), 0.5 * (y[1] - y[0])
        area = QRectF(x[0] - half_x, y[0] - half_y, x[-1] - x[0] + 2 * half_x, y[-1] - y[0] + 2 * half_y)
        low, high = self._levels(found)
        self._image.setImage(found.frequency_hz, levels=(low, high))
        self._bar.setLevels((low, high))
        self._image.setRect(area)
        self._ground.setRect(area)
        self._draw_lines(found)
        self._draw_points()
        if self._view != (found.x, found.y):  # afterwards the axes stay as a person has them
            self._view = (found.x, found.y)
            self.show_whole()

    def show_whole(self) -> None:
        """The whole map in view."""
        if self._map is not None:
            x, y = self._map.x, self._map.y
            self._box.setRange(xRange=(x.low, x.high), yRange=(y.low, y.high), padding=0.0)

    def _levels(self, found: StabilityMap) -> tuple[float, float]:
        known = found.frequency_hz[np.isfinite(found.frequency_hz)]
        low, high = (float(known.min()), float(known.max())) if known.size else (1000.0, 4000.0)
        lack = 0.5 * max(_LEAST_SPAN_HZ - (high - low), 0.0)
        return low - lack, high + lack

    def _draw_lines(self, found: StabilityMap) -> None:
        for line in self._lines:
            self._item.removeItem(line)
        t = self._theme.current
        self._lines = []
        labels: list[np.ndarray] = []
        span = np.array([found.x.high - found.x.low, found.y.high - found.y.low])
        for level, segments in found.contours:
            for points in segments:
                self._lines.append(
                    pg.PlotCurveItem(
                        points[:, 0], points[:, 1], pen=pg.mkPen(t.panel, width=1), antialias=True
                    )
                )
            longest = max(segments, key=len)
            spot = longest[len(longest) // 2]
            if any((np.abs(spot - other) < _LABEL_ROOM * span).all() for other in labels):
                continue  # it would stand on another
            labels.append(spot)
            text = pg.TextItem(f"{level:g}", color=t.panel, anchor=(0.5, 0.5))
            text.setFont(self._theme.font("small"))
            text.setPos(*spot)
            self._lines.append(text)
        for x, y, _ in found.boundary:
            self._lines.append(pg.PlotCurveItem(x, y, pen=pg.mkPen(t.text, width=3), antialias=True))
        for line in self._lines:
            self._item.addItem(line, ignoreBounds=True)

    def show_points(
        self,
        squeals: list[tuple[Measured, tuple[float, float]]],
        quiet: list[tuple[Measured, tuple[float, float]]],
    ) -> None:
        """Measured squeal and brakings without, each with its place on the axes."""
        self._squeals, self._quiet = squeals, quiet
        self._draw_points()

    def _draw_points(self) -> None:
        t, px = self._theme.current, self._theme.px
        levels = self._bar.levels()
        colours: Any = pg.colormap.get("viridis")
        spots = []
        for point, place in self._squeals:
            share = ((point.frequency_hz or 0.0) - levels[0]) / (levels[1] - levels[0])
            spots.append(
                {"pos": place, "brush": pg.mkBrush(colours.map(min(max(share, 0.0), 1.0), "qcolor"))}
            )
        self._marks.setData(spots, symbol="s", size=px(1.4), pen=pg.mkPen(t.text, width=2))
        self._marks_quiet.setData(
            [place[0] for _, place in self._quiet], [place[1] for _, place in self._quiet],
            symbol="o", size=px(1.25), brush=pg.mkBrush(t.plot), pen=pg.mkPen(t.green, width=2),
        )  # fmt: skip

    def show_here(self, x: float, y: float) -> None:
        """Where the sliders are."""
        t, px = self._theme.current, self._theme.px
        self._here.setData(
            [x, x], [y, y], symbol=["o", "+"], size=[px(2.5), px(1.5)],
            pen=[pg.mkPen(t.blue, width=3), pg.mkPen(None)], brush=[None, pg.mkBrush(t.blue)],
        )  # fmt: skip

    # -- mouse ------------------------------------------------------------------------------------

    def point_at(self, place: QPointF) -> Measured | None:
        """The measured point within reach of a place of the scene, squeal before silence."""
        width, height = self._box.viewPixelSize()
        here = self._box.mapSceneToView(place)
        for points in (self._squeals, self._quiet):
            near = [
                (np.hypot((x - here.x()) / width, (y - here.y()) / height), k)
                for k, (_, (x, y)) in enumerate(points)
            ]
            if near and min(near)[0] <= self._theme.px(_REACH):
                return points[min(near)[1]][0]
        return None

    def text_at(self, place: QPointF) -> str:
        """What is at a place of the scene, in words."""
        point = self.point_at(place)
        if point is not None:
            return measured_text(point)
        found = self._map
        here = self._box.mapSceneToView(place)
        if found is None or not self._ground.rect().contains(here):
            return ""
        row = int(np.abs(found.y_values - here.y()).argmin())
        column = int(np.abs(found.x_values - here.x()).argmin())
        at = ", ".join((value_text(found.x.key, here.x()), value_text(found.y.key, here.y())))
        growth, frequency = float(found.growth_1_s[row, column]), float(found.frequency_hz[row, column])
        if not np.isfinite(frequency):
            return self.tr("{0}: stable, {1}").format(at, quantity_text(growth, "1/s", 1))
        return self.tr("{0}: unstable at {1}, grows with {2}").format(
            at, frequency_text(frequency), quantity_text(growth, "1/s", 1)
        )

    def _on_moved(self, place: QPointF) -> None:
        inside = self._box.sceneBoundingRect().contains(place)
        self.pointed.emit(self.text_at(place) if inside else "")

    def _on_clicked(self, event: Any) -> None:
        place = event.scenePos()
        if event.button() != Qt.MouseButton.LeftButton or not self._box.sceneBoundingRect().contains(place):
            return
        event.accept()
        point = self.point_at(place)
        self.chosen.emit(point)
        spots = dict((id(p), spot) for p, spot in (*self._squeals, *self._quiet))
        here = self._box.mapSceneToView(place)
        x, y = spots[id(point)] if point is not None else (here.x(), here.y())
        self.jumped.emit(float(x), float(y))

    def leaveEvent(self, ev: Any) -> None:
        """The read-out ends with the mouse."""
        super().leaveEvent(ev)
        self.pointed.emit("")


def measured_text(point: Measured) -> str:
    """A measured point in one line."""
    translate = QCoreApplication.translate
    at = ", ".join((value_text("mu", point.mu), value_text("pressure", point.pressure_bar)))
    if point.frequency_hz is None:
        return translate("model", "Braking {0}: no squeal at {1}").format(point.braking, at)
    return translate("model", "Braking {0}: squeal at {1}, {2}, at {3}").format(
        point.braking, frequency_text(point.frequency_hz), quantity_text(point.level_db, "dB", 1), at
    )

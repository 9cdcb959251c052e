"""The plane of eigenvalues: poles of the present sliders, their paths, the half planes.

Job: show `Poles` and `LocusLines`, say what is under the mouse, tell which pole was picked. The conjugate
lower half is left out; frequency stands upright in Hz, the real part lies in 1/s. Not its job: the worker.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QGraphicsRectItem

from rigctl.gui.format import frequency_text, quantity_text
from rigctl.gui.pages.model.data import LocusLines, Pole, Poles
from rigctl.gui.pages.model.words import pole_text, value_text
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.plot_dress import dress

#: reach of a pick and of the read-out of a path, in steps of the grid
_REACH, _NEAR = 2.5, 1.25
_LABELS = 3
#: the range of low-frequency brake squeal, as the ranking of modifications takes it
SQUEAL_HZ = 5000.0


class LocusPlot(pg.PlotWidget):
    """Poles, paths, ghosts of another brake."""

    picked = Signal(object)
    """Pole."""
    pointed = Signal(str)
    """What is under the mouse, in words; "" when it has left."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._poles: Poles | None = None
        self._ghosts_of: tuple[Pole, ...] | None = None
        self._locus: LocusLines | None = None
        self._mouse: QPointF | None = None
        self.setAccessibleName(self.tr("Plane of eigenvalues"))
        item: Any = self.getPlotItem()
        scene: Any = self.scene()
        self._box: Any = item.getViewBox()
        item.showGrid(x=True, y=True, alpha=0.12)
        item.setClipToView(True)
        item.setDownsampling(auto=False)
        self._stable, self._unstable = QGraphicsRectItem(), QGraphicsRectItem()
        self._axis = pg.InfiniteLine(0.0, angle=90)
        self._paths = pg.PlotCurveItem(connect="finite", antialias=True)
        self._starts = pg.ScatterPlotItem(pxMode=True)
        self._crossings = pg.ScatterPlotItem(pxMode=True)
        self._ghosts = pg.ScatterPlotItem(pxMode=True)
        self._ring = pg.ScatterPlotItem(pxMode=True)
        self._marks = pg.ScatterPlotItem(pxMode=True)
        self._texts = [pg.TextItem(anchor=(0.0, 1.0)) for _ in range(_LABELS)]
        self._halves = [pg.TextItem(anchor=(1.0, 0.0)), pg.TextItem(anchor=(0.0, 0.0))]
        for region in (self._stable, self._unstable):
            region.setZValue(-20)
            item.addItem(region, ignoreBounds=True)
        item.addItem(self._axis, ignoreBounds=True)
        for part in (self._paths, self._starts, self._ghosts, self._crossings, self._marks, self._ring):
            item.addItem(part)
        for text in (*self._texts, *self._halves):
            item.addItem(text, ignoreBounds=True)
            text.hide()
        self._box.setRange(xRange=(-1500.0, 300.0), yRange=(0.0, 9000.0), padding=0.0)
        self._box.setLimits(yMin=-500.0)
        scene.sigMouseMoved.connect(self._on_moved)
        scene.sigMouseClicked.connect(self._on_clicked)
        self._box.sigRangeChanged.connect(self._place_halves)
        theme.changed.connect(self.restyle)
        self.restyle()

    # -- look -------------------------------------------------------------------------------------

    def restyle(self) -> None:
        """Take the present look."""
        t = self._theme.current
        dress(self, self._theme, self.tr("Real part [1/s]"), self.tr("Frequency [Hz]"))
        grey, amber = QColor(t.plot_line), QColor(t.amber)
        grey.setAlpha(28)
        amber.setAlpha(48)
        for region, colour in ((self._stable, grey), (self._unstable, amber)):
            region.setBrush(colour)
            region.setPen(pg.mkPen(None))
        self._axis.setPen(pg.mkPen(t.text, width=1.5))
        self._axis.setHoverPen(pg.mkPen(t.text, width=1.5))
        for text in (*self._texts, *self._halves):
            text.setFont(self._theme.font("small"))
        for text, words in zip(self._halves, (self.tr("stable"), self.tr("unstable")), strict=True):
            text.setText(words, color=t.muted)
        self._ghosts_of = None
        self._draw_locus()
        self._draw_poles()

    def _place_halves(self) -> None:
        """The half planes over what is in view; their names beside the axis while it is in view."""
        (left, right), (bottom, top) = self._box.viewRange()
        height = top - bottom
        self._stable.setRect(QRectF(left, bottom, max(min(right, 0.0) - left, 0.0), height))
        self._unstable.setRect(QRectF(max(left, 0.0), bottom, max(right - max(left, 0.0), 0.0), height))
        for text, seen in zip(self._halves, (bool(left < 0.0 < right),) * 2, strict=True):
            text.setVisible(seen)
            text.setPos(0.0, top)

    # -- showing ----------------------------------------------------------------------------------

    def show_poles(self, poles: Poles | None) -> None:
        """Poles of the present sliders."""
        self._poles = poles
        self._draw_poles()
        if self._mouse is not None:
            self._point()

    def show_locus(self, locus: LocusLines | None) -> None:
        """Paths that belong to the present sliders."""
        self._locus = locus
        self._draw_locus()

    def fade_locus(self) -> None:
        """The path is out of date until the next comes."""
        for item in (self._paths, self._starts, self._crossings, *self._texts):
            item.setOpacity(0.3)

    def _draw_poles(self) -> None:
        t, px = self._theme.current, self._theme.px
        found = self._poles
        if found is None:
            for item in (self._marks, self._ghosts, self._ring):
                item.setData([], [])
            self._ghosts_of = None
            return
        edge = pg.mkPen(t.text, width=1.2)
        spots = [
            {
                "pos": (pole.real_part_1_s, pole.frequency_hz),
                "symbol": "t1" if pole.unstable else "o",
                "size": px(1.75 if pole.unstable else 1.25),
                "brush": pg.mkBrush(t.amber if pole.unstable else t.plot_line),
                "pen": edge,
            }
            for pole in found.poles
        ]
        self._marks.setData(spots)
        if found.other != self._ghosts_of:
            self._draw_ghosts(found.other)
        chosen = found.selected
        self._ring.setData(
            [chosen.real_part_1_s], [chosen.frequency_hz],
            symbol="o", size=px(3), brush=None, pen=pg.mkPen(t.blue, width=2.5),
        )  # fmt: skip

    def _draw_ghosts(self, other: tuple[Pole, ...]) -> None:
        self._ghosts_of = other
        t, px = self._theme.current, self._theme.px
        self._ghosts.setData(
            [p.real_part_1_s for p in other], [p.frequency_hz for p in other],
            symbol="d", size=px(1.5), brush=None, pen=pg.mkPen(t.muted, width=1.5),
        )  # fmt: skip

    def _draw_locus(self) -> None:
        t, px = self._theme.current, self._theme.px
        for item in (self._paths, self._starts, self._crossings, *self._texts):
            item.setOpacity(1.0)
        for text in self._texts:
            text.hide()
        found = self._locus
        if found is None:
            self._paths.setData([], [])
            self._starts.setData([], [])
            self._crossings.setData([], [])
            return
        gap = np.full((1, found.eigenvalues.shape[1]), np.nan)
        x = np.concatenate([found.eigenvalues.real, gap]).T.ravel()
        y = np.concatenate([found.eigenvalues.imag / (2.0 * np.pi), gap]).T.ravel()
        self._paths.setData(x, y, pen=pg.mkPen(t.muted, width=1))
        first = found.eigenvalues[0]
        self._starts.setData(
            first.real,
            first.imag / (2.0 * np.pi),
            symbol="x",
            size=px(1),
            pen=None,
            brush=pg.mkBrush(t.muted),
        )
        self._crossings.setData(
            [0.0] * len(found.crossings), [frequency for _, frequency, _ in found.crossings],
            symbol="+", size=px(1.5), pen=None, brush=pg.mkBrush(t.text),
        )  # fmt: skip
        losing = [(value, frequency) for value, frequency, lost in found.crossings if lost]
        for text, (value, frequency) in zip(self._texts, losing, strict=False):
            text.setText(f" {value_text(found.over, value)}", color=t.text)
            text.setPos(0.0, frequency)
            text.show()

    # -- ranges -----------------------------------------------------------------------------------

    def show_all(self) -> None:
        """All poles in view, and the boundary."""
        self._show_below(np.inf)

    def show_squeal(self) -> None:
        """Poles of the squeal range in view, and the boundary."""
        self._show_below(SQUEAL_HZ)

    def _show_below(self, limit_hz: float) -> None:
        if self._poles is None:
            return
        every = (*self._poles.poles, *self._poles.other)
        shown = [pole for pole in every if pole.frequency_hz < limit_hz] or every
        left = min(-100.0, *(p.real_part_1_s for p in shown))
        right = max(0.4 * -left, *(1.15 * p.real_part_1_s for p in shown))
        top = max(p.frequency_hz for p in shown)
        self._box.setRange(xRange=(1.05 * left, right), yRange=(-0.02 * top, 1.08 * top), padding=0.0)

    def sees(self, pole: Pole) -> bool:
        """Whether a pole is in view."""
        (left, right), (low, high) = self._box.viewRange()
        return left <= pole.real_part_1_s <= right and low <= pole.frequency_hz <= high

    def show_boundary(self) -> None:
        """A closer look at the modes that couple or come nearest to the boundary."""
        if self._locus is not None:
            left, right, low, high = self._locus.near
            self._box.setRange(xRange=(left, right), yRange=(low, high), padding=0.02)

    # -- mouse ------------------------------------------------------------------------------------

    def pole_at(self, place: QPointF) -> Pole | None:
        """The pole within reach of a place of the scene."""
        if self._poles is None:
            return None
        points = np.array([(p.real_part_1_s, p.frequency_hz) for p in self._poles.poles])
        distance = self._distances(points, place)
        nearest = int(distance.argmin())
        return self._poles.poles[nearest] if distance[nearest] <= self._theme.px(_REACH) else None

    def _distances(self, points: np.ndarray, place: QPointF) -> np.ndarray:
        """Pixels between points (k, 2) of the plane and a place of the scene."""
        width, height = self._box.viewPixelSize()
        here = self._box.mapSceneToView(place)
        return np.hypot((points[:, 0] - here.x()) / width, (points[:, 1] - here.y()) / height)

    def text_at(self, place: QPointF) -> str:
        """What is at a place of the scene, in words."""
        pole = self.pole_at(place)
        if pole is not None:
            return pole_text(pole)
        if self._locus is not None:
            points = self._locus.eigenvalues
            flat = np.column_stack([points.real.ravel(), points.imag.ravel() / (2.0 * np.pi)])
            distance = self._distances(flat, place)
            nearest = int(np.nanargmin(distance))
            if distance[nearest] <= self._theme.px(_NEAR):
                value = float(self._locus.values[nearest // points.shape[1]])
                return self.tr("Path at {0}: {1}, {2}").format(
                    value_text(self._locus.over, value),
                    frequency_text(float(flat[nearest, 1])),
                    quantity_text(float(flat[nearest, 0]), "1/s", 1),
                )
        here = self._box.mapSceneToView(place)
        return f"{frequency_text(here.y())}, {quantity_text(here.x(), '1/s', 0)}"

    def _on_moved(self, place: QPointF) -> None:
        self._mouse = place if self._box.sceneBoundingRect().contains(place) else None
        self._point()

    def _point(self) -> None:
        self.pointed.emit("" if self._mouse is None else self.text_at(self._mouse))

    def _on_clicked(self, event: Any) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            pole = self.pole_at(event.scenePos())
            if pole is not None:
                event.accept()
                self.picked.emit(pole)

    def leaveEvent(self, ev: Any) -> None:
        """The read-out ends with the mouse."""
        super().leaveEvent(ev)
        self._mouse = None
        self._point()

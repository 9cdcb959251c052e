"""A brake that deforms, painted by Qt: bodies, springs, the ground, and the sense in which the disc moves.

Job: paint a `Shape` at a phase. Not its job: where bodies stand and how points move
(`rigctl.model.drawn_brake`), the clock of the animation (`mode_view`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen, QPolygonF

from rigctl.gui.pages.model.data import Shape
from rigctl.gui.theme import ThemeKeeper
from rigctl.model.drawn_brake import (
    Drawing,
    DrawnBody,
    DrawnSpring,
    displaced,
    ground_path,
    label_of,
    spring_path,
)

#: share of the strain energy from which a spring is drawn as strongly strained (as the studies' pictures do)
_STRAINED = 0.08
_ROOM = 0.08
#: tokens of the theme for bodies other than disc and pads, in turn; halves of one thing alike
_FAMILIES = ("speed", "torque", "friction", "sound")


class BrakeItem(pg.GraphicsObject):
    """The brake; coordinates are metres, y upwards."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.shape_shown: Shape | None = None
        self.phase_rad = 0.0
        self.amplitude = 1.0
        self._looks: dict[str, QColor] = {}
        self._ground, self._arrow = QPainterPath(), QPainterPath()

    def show_shape(self, shape: Shape | None) -> None:
        """Another mode, or none."""
        before = self.shape_shown
        if before is None or shape is None or before.drawing.box != shape.drawing.box:
            self.prepareGeometryChange()
        self.shape_shown = shape
        self._ground = QPainterPath() if shape is None else _ground_of(shape.drawing)
        self._arrow = QPainterPath() if shape is None else _arrow_of(shape.drawing)
        self.restyle()

    def restyle(self) -> None:
        """Take the present look."""
        self._looks = {} if self.shape_shown is None else self._colours(self.shape_shown)
        self.update()

    def move(self, phase_rad: float, amplitude: float) -> None:
        """Paint at another phase, or with another amplitude (1: the study's own scale)."""
        self.phase_rad, self.amplitude = phase_rad, amplitude
        self.update()

    def _colours(self, shape: Shape) -> dict[str, QColor]:
        families: dict[str, str] = {}
        looks = {}
        for body in sorted(shape.drawing.bodies, key=lambda b: b.name):
            token = {"disc": "plot_line", "pad": "temperature"}.get(body.role, "")
            if not token:
                family = body.name.rsplit("_", 1)[0]
                token = families.setdefault(family, _FAMILIES[len(families) % len(_FAMILIES)])
            looks[body.name] = self._theme.colour(token)
        return looks

    def moved(self, points: np.ndarray, body: DrawnBody) -> np.ndarray:
        """Points (k, 2) of a body at the present phase."""
        assert self.shape_shown is not None
        motions = self.shape_shown.motions
        scale = motions.scale * self.amplitude
        return displaced(points, body.centre, motions.of(body.name), self.phase_rad, scale)

    def label_places(self) -> dict[str, tuple[float, float]]:
        """Where the names of bodies stand at the present phase."""
        if self.shape_shown is None:
            return {}
        found = {}
        for body in self.shape_shown.drawing.bodies:
            x, y = self.moved(body.label[None, :], body)[0]
            found[label_of(body.name)] = (float(x), float(y))
        return found

    # -- Qt ---------------------------------------------------------------------------------------

    def boundingRect(self) -> QRectF:
        """Everything with room for the motion."""
        if self.shape_shown is None:
            return QRectF(0.0, 0.0, 1.0, 1.0)
        x0, x1, y0, y1 = self.shape_shown.drawing.box
        room = _ROOM * self.shape_shown.drawing.size
        return QRectF(x0 - room, y0 - room, x1 - x0 + 2 * room, y1 - y0 + 2 * room)

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Bodies from the outside to the disc, then springs."""
        shape = self.shape_shown
        if shape is None:
            return
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for body in shape.drawing.bodies:
            self._paint_body(painter, body)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(_pen(self._theme.colour("plot_line"), 1.0))
        painter.drawPath(self._ground)
        for spring in shape.drawing.springs:
            self._paint_spring(painter, shape, spring)
        painter.setPen(_pen(self._theme.colour("text"), 1.5))
        painter.drawPath(self._arrow)

    def _paint_body(self, painter: QPainter, body: DrawnBody) -> None:
        colour = self._looks[body.name]
        if body.bridge is not None:
            pale = QColor(colour)
            pale.setAlpha(36)
            painter.setPen(_pen(colour, 1.0))
            painter.setBrush(pale)
            painter.drawPolygon(_polygon(self.moved(body.bridge, body)))
        fill = QColor(colour)
        fill.setAlpha(120)
        for outline in body.parts:
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(_pen(self._theme.colour("line"), 1.0))
            painter.drawPolygon(_polygon(outline))
            painter.setPen(_pen(colour, 1.5))
            painter.setBrush(fill)
            painter.drawPolygon(_polygon(self.moved(outline, body)))

    def _paint_spring(self, painter: QPainter, shape: Shape, spring: DrawnSpring) -> None:
        share = shape.motions.strain.get(spring.coupling, 0.0)
        colour = self._theme.colour("text" if share >= _STRAINED else "muted")
        size = shape.drawing.size
        ends = []
        for name, place in (spring.first, spring.second):
            ends.append(self.moved(place[None, :], shape.drawing.body(name))[0] if name else place)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(_pen(colour, 1.0 + 3.0 * math.sqrt(min(share, 1.0))))
        painter.drawPath(_line(spring_path(ends[0], ends[1], spring.kind, 0.012 * size)))


def _ground_of(drawing: Drawing) -> QPainterPath:
    """The ground under all springs that end there."""
    path = QPainterPath()
    for spring in drawing.springs:
        if not spring.second[0] and spring.kind != "torsion":
            path.addPath(_line(ground_path(spring.first[1], spring.second[1], 0.03 * drawing.size)))
    return path


def _arrow_of(drawing: Drawing) -> QPainterPath:
    """The sense in which the disc moves."""
    disc = next((body for body in drawing.bodies if body.role == "disc"), None)
    if disc is None:
        return QPainterPath()
    size = drawing.size
    left = float(disc.parts[0][:, 0].min())
    y = float(disc.parts[0][:, 1].max()) + 0.025 * size
    tip, head = left + 0.13 * size, 0.012 * size
    points = [(left, y), (tip, y), (tip - head, y + head / 2), (np.nan, np.nan), (tip, y)]
    return _line(np.array([*points, (tip - head, y - head / 2)]))


def _pen(colour: QColor, width: float, style: Qt.PenStyle = Qt.PenStyle.SolidLine) -> QPen:
    pen = QPen(colour, width, style)
    pen.setCosmetic(True)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    return pen


def _polygon(points: np.ndarray) -> QPolygonF:
    return pg.functions.arrayToQPolygonF(points[:, 0], points[:, 1])


def _line(points: np.ndarray) -> QPainterPath:
    """Lines between points (k, 2); nan lifts the pen."""
    return pg.functions.arrayToQPath(points[:, 0], points[:, 1], connect="finite")

"""What is drawn inside the live plots: lines, envelopes, limit bands, squeal marks, spectrogram.

Job: paint with as few operations as software rendering needs: one polyline per stretch without gap, pens
of one pixel. Items never ask for a range of their own. Not its job: data.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from numpy.typing import NDArray
from pyqtgraph.functions import create_qpolygonf, ndarray_from_qpolygonf
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen, QPolygonF

from rigctl.gui.live.history import Envelope


def pen(colour: str, width: float = 1.0, style: Qt.PenStyle = Qt.PenStyle.SolidLine) -> QPen:
    """A pen whose width is in pixels, whatever the zoom."""
    made = QPen(QColor(colour), width, style)
    made.setCosmetic(True)
    return made


class ViewItem(pg.GraphicsObject):
    """Fills the view; takes no part in ranges."""

    def boundingRect(self) -> QRectF:
        """The view."""
        return self.viewRect() or QRectF()

    def viewRangeChanged(self, *_: Any) -> None:
        """pyqtgraph's call: the view shows something else now."""
        self.prepareGeometryChange()


class LineItem(ViewItem):
    """A line through points, with gaps at NaN."""

    def __init__(self, line_pen: QPen) -> None:
        super().__init__()
        self.pen = line_pen
        self._lines: list[QPolygonF] = []

    def set_pen(self, line_pen: QPen) -> None:
        """Another colour or width."""
        self.pen = line_pen
        self.update()

    def set_points(self, x: NDArray[np.floating], y: NDArray[np.floating]) -> None:
        """Points in the order of drawing; a NaN in `y` interrupts the line."""
        self._lines = _polygons(x, y)
        self.update()

    def set_envelope(self, envelope: Envelope) -> None:
        """Draw least and largest of each bin; a line that goes up and down within the bin's own pixel."""
        x = envelope.times_s()
        if envelope.exact:
            self.set_points(x, envelope.low)
            return
        # Always from low to high: Qt drops pixels where a line of one pixel turns back on itself.
        y = np.stack([envelope.low, envelope.high], axis=1)
        self.set_points(np.repeat(x, 2), y.reshape(-1))

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Qt's call."""
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        painter.setPen(self.pen)
        for line in self._lines:
            if line.size() == 1:
                painter.drawPoints(line)
            else:
                painter.drawPolyline(line)


def _polygons(x: NDArray[np.floating], y: NDArray[np.floating]) -> list[QPolygonF]:
    valid = np.isfinite(y)
    if valid.all():
        pieces = [(0, len(y))] if len(y) else []
    else:
        edges = np.flatnonzero(np.diff(np.concatenate(([False], valid, [False])).astype(np.int8)))
        pieces = list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))
    polygons: list[QPolygonF] = []
    for begin, end in pieces:
        polygon = create_qpolygonf(end - begin)
        points = ndarray_from_qpolygonf(polygon)
        points[:, 0] = x[begin:end]
        points[:, 1] = y[begin:end]
        polygons.append(polygon)
    return polygons


class LimitItem(ViewItem):
    """Forbidden side of a limit: tinted and edged, where it comes into view."""

    def __init__(self, colour: str) -> None:
        super().__init__()
        self.colour = colour
        self.band: tuple[float, float] | None = None

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Qt's call."""
        if self.band is None:
            return
        view, (low, high) = self.boundingRect(), self.band
        tint = QColor(self.colour)
        tint.setAlpha(26)
        painter.setPen(pen(self.colour, 1.0, Qt.PenStyle.DashLine))
        bottom, top = view.top(), view.bottom()  # the view's y points upwards
        for edge, outside, visible in (
            (high, QRectF(QPointF(view.left(), high), QPointF(view.right(), top)), high < top),
            (low, QRectF(QPointF(view.left(), bottom), QPointF(view.right(), low)), low > bottom),
        ):
            if visible:
                painter.fillRect(outside, tint)
                painter.drawLine(QPointF(view.left(), edge), QPointF(view.right(), edge))


class OutsideItem(ViewItem):
    """Shades what lies outside a band of one axis: the squeal band."""

    def __init__(self, colour: str, alpha: int, *, vertical: bool) -> None:
        super().__init__()
        self.colour, self.alpha, self._vertical = colour, alpha, vertical
        self.band: tuple[float, float] = (0.0, 0.0)
        self.span: tuple[float, float] | None = None
        """Along the other axis; None: all of the view. Only for a horizontal band."""
        self.edge: QPen | None = None

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Qt's call."""
        view, (low, high) = self.boundingRect(), self.band
        shade = QColor(self.colour)
        shade.setAlpha(self.alpha)
        left, right, bottom, top = view.left(), view.right(), view.top(), view.bottom()
        if self.span is not None:
            left, right = max(left, self.span[0]), min(right, self.span[1])
        if self._vertical:
            areas = (
                QRectF(left, bottom, low - left, top - bottom),
                QRectF(high, bottom, right - high, top - bottom),
            )
            edges = ((QPointF(low, bottom), QPointF(low, top)), (QPointF(high, bottom), QPointF(high, top)))
        else:
            areas = (
                QRectF(left, bottom, right - left, low - bottom),
                QRectF(left, high, right - left, top - high),
            )
            edges = ((QPointF(left, low), QPointF(right, low)), (QPointF(left, high), QPointF(right, high)))
        for area in areas:
            if area.width() > 0 and area.height() > 0:
                painter.fillRect(area, shade)
        if self.edge is not None:
            painter.setPen(self.edge)
            for begin, end in edges:
                painter.drawLine(begin, end)


class BoxesItem(ViewItem):
    """Frames around squeal events in the spectrogram: dark and light, to be seen on any colour."""

    def __init__(self) -> None:
        super().__init__()
        self._boxes: list[tuple[QRectF, bool]] = []

    def set_boxes(self, boxes: list[tuple[QRectF, bool]]) -> None:
        """Rectangles in data units, and whether they are of minor importance (harmonics)."""
        self._boxes = boxes
        self.update()

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Qt's call."""
        for box, minor in self._boxes:
            style = Qt.PenStyle.DotLine if minor else Qt.PenStyle.SolidLine
            if not minor:
                painter.setPen(pen("#000000", 2.0))
                painter.drawRect(box)
            painter.setPen(pen("#ffffff", 1.0, style))
            painter.drawRect(box)


class PictureItem(ViewItem):
    """An image of stored levels under a colour table; cells are drawn whole."""

    def __init__(self) -> None:
        super().__init__()
        self._image: QImage | None = None
        self._cells: NDArray[np.uint8] | None = None
        self._target = QRectF()
        self._table: list[int] = []

    def set_table(self, table: list[int]) -> None:
        """256 colours as 0xAARRGGBB."""
        self._table = table
        if self._image is not None:
            self._image.setColorTable(table)
        self.update()

    def set_picture(self, cells: NDArray[np.uint8] | None, target: QRectF) -> None:
        """Cells, shape (rows, columns), first row at the bottom; None: nothing."""
        self._image, self._target = None, target
        if cells is not None:
            rows, columns = cells.shape
            padded = np.zeros((rows, -(-columns // 4) * 4), np.uint8)
            padded[:, :columns] = cells
            self._cells = padded  # QImage does not copy
            self._image = QImage(padded.data, columns, rows, padded.shape[1], QImage.Format.Format_Indexed8)
            self._image.setColorTable(self._table)
        self.update()

    def paint(self, painter: QPainter, *_: Any) -> None:
        """Qt's call."""
        if self._image is not None:
            painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, False)
            painter.drawImage(self._target, self._image)

"""One figure of a campaign, to be clicked: a dot or a cell opens its braking.

Job: draw `Dots` or `Cells`, say what is below the mouse, tell what was clicked, mark the open braking. Not
its job: the numbers (`figure_data`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor

from rigctl.gui.pages.data.figure_data import LEVEL_RANGE_DB, Cell, Cells, Dots
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.plot_dress import PictureMenu, dress

_CLASSES = 16
_MAX_TEXTS = 400
_EVEN = 0.18
"""Above this luminance black letters have more contrast than white ones."""


class FigurePlot(pg.PlotWidget):
    """Shows one picture at a time."""

    picked = Signal(list)
    """Files behind the dot or cell that was clicked, the loudest first."""

    def __init__(self, theme: ThemeKeeper, name: str, notify: Callable[[str], None]) -> None:
        super().__init__()
        self._theme = theme
        self.setObjectName(name)
        self._names = ("", "")
        self._picture: Dots | Cells | None = None
        self._chosen: list[str] = []
        self._scatter: Any = None
        self._rings: Any = None
        self._frames: list[Any] = []
        self.menu = PictureMenu(self, "figure", notify)
        self.menu.add(self.tr("Show all"), self.show_all)
        scene: Any = self.scene()
        scene.sigMouseClicked.connect(self._on_click)
        scene.sigMouseMoved.connect(self._on_move)
        theme.changed.connect(self._restyle)
        self._colours: Any = pg.colormap.get("viridis")

    def show_picture(self, picture: Dots | Cells | None, x_name: str, y_name: str) -> None:
        """Draw another picture."""
        fresh = picture is None or self._names != (x_name, y_name)
        self._picture, self._names = picture, (x_name, y_name)
        self._draw()
        if fresh:
            self.show_all()

    def show_all(self) -> None:
        """All dots or cells; from now on the range follows them."""
        item: Any = self.getPlotItem()
        if isinstance(self._picture, Cells):
            item.setRange(
                xRange=(-0.5, len(self._picture.pressures_bar) - 0.5),
                yRange=(-0.5, len(self._picture.temperatures_degc) - 0.5),
                padding=0.01,
            )
        else:
            self._show_dots(item)

    def _show_dots(self, item: Any) -> None:
        if not isinstance(self._picture, Dots):
            return
        for axis, wide, values in (
            ("x", self._picture.x_range, self._picture.x),
            ("y", self._picture.y_range, self._picture.y),
        ):
            low, high = wide
            if len(values):
                low, high = min(low, float(values.min())), max(high, float(values.max()))
            item.setRange(**{f"{axis}Range": (low, high)}, padding=0.03)

    def set_chosen(self, names: list[str]) -> None:
        """Mark brakings."""
        self._chosen = names
        self._mark()

    # -- drawing ------------------------------------------------------------------------------------

    def _draw(self) -> None:
        item: Any = self.getPlotItem()
        item.clear()
        self._scatter = self._rings = None
        self._frames = []
        dress(self, self._theme, *self._names)
        bottom, left = item.getAxis("bottom"), item.getAxis("left")
        bottom.setTicks(None)
        left.setTicks(None)
        item.showGrid(x=isinstance(self._picture, Dots), y=isinstance(self._picture, Dots), alpha=0.15)
        if isinstance(self._picture, Dots):
            self._draw_dots(item, self._picture)
        elif isinstance(self._picture, Cells):
            bottom.setTicks([[(n, f"{p:g}") for n, p in enumerate(self._picture.pressures_bar)]])
            left.setTicks([[(n, f"{t:g}") for n, t in enumerate(self._picture.temperatures_degc)]])
            self._draw_cells(item, self._picture)
        self._mark()

    def _draw_dots(self, item: Any, dots: Dots) -> None:
        low, high = LEVEL_RANGE_DB
        share = np.clip((dots.level_db - low) / (high - low), 0.0, 1.0)
        classes = np.where(np.isfinite(share), np.round(share * (_CLASSES - 1)), -1).astype(int)
        brushes = [pg.mkBrush(self._colour(n / (_CLASSES - 1))) for n in range(_CLASSES)]
        brushes.append(pg.mkBrush(self._theme.colour("plot_line")))  # class -1: no squeal
        base = self._theme.px(0.9)
        sizes = np.where(classes >= 0, base * (1.0 + classes / _CLASSES), base * 0.8)
        self._scatter = pg.ScatterPlotItem(
            x=dots.x, y=dots.y, size=sizes, brush=[brushes[n] for n in classes],
            pen=pg.mkPen(self._theme.current.plot, width=1), data=np.arange(len(dots.names)),
        )  # fmt: skip
        item.addItem(self._scatter)
        self._rings = pg.ScatterPlotItem(
            size=2.6 * base, brush=None, pen=pg.mkPen(self._theme.current.blue, width=3)
        )
        item.addItem(self._rings)

    def _draw_cells(self, item: Any, cells: Cells) -> None:
        shape = (len(cells.temperatures_degc), len(cells.pressures_bar))
        if not cells.cells:
            return
        image = np.zeros((*shape, 4), np.ubyte)
        span = max(cells.high - cells.low, 1e-9)
        texts = len(cells.cells) <= _MAX_TEXTS
        for cell in cells.cells:
            if math.isfinite(cell.value):
                colour = self._colour((cell.value - cells.low) / span)
            else:
                colour = self._theme.colour("panel")
            image[cell.row, cell.column] = (colour.red(), colour.green(), colour.blue(), 255)
            if texts:
                item.addItem(self._text(cell, colour))
        drawn = pg.ImageItem(image, axisOrder="row-major", levels=(0, 255))
        drawn.setRect(QRectF(-0.5, -0.5, shape[1], shape[0]))
        drawn.setZValue(-10)
        item.addItem(drawn)

    def _text(self, cell: Cell, back: QColor) -> Any:
        ink = "#101214" if _luminance(back) > _EVEN else "#ffffff"
        text = pg.TextItem(cell.text, color=ink, anchor=(0.5, 0.5))
        text.setFont(self._theme.font("small"))
        text.setPos(cell.column, cell.row)
        return text

    def _colour(self, share: float) -> QColor:
        return self._colours.mapToQColor(min(max(share, 0.0), 1.0))

    def _mark(self) -> None:
        item: Any = self.getPlotItem()
        wanted = set(self._chosen)
        for frame in self._frames:
            item.removeItem(frame)
        self._frames = []
        if isinstance(self._picture, Dots) and self._rings is not None:
            places = [n for n, name in enumerate(self._picture.names) if name in wanted]
            self._rings.setData(self._picture.x[places], self._picture.y[places])
        elif isinstance(self._picture, Cells):
            for cell in self._picture.cells:
                if wanted.intersection(cell.names):
                    self._frames.append(self._frame(cell.column, cell.row))
                    item.addItem(self._frames[-1])

    def _frame(self, column: int, row: int) -> Any:
        x = np.array([-0.46, 0.46, 0.46, -0.46, -0.46]) + column
        y = np.array([-0.46, -0.46, 0.46, 0.46, -0.46]) + row
        return pg.PlotCurveItem(x, y, pen=pg.mkPen(self._theme.current.blue, width=3))

    # -- mouse --------------------------------------------------------------------------------------

    def below(self, place: Any) -> tuple[list[str], str]:
        """Files and words for what is below a place of the scene."""
        item: Any = self.getPlotItem()
        if not item.vb.sceneBoundingRect().contains(place):
            return [], ""
        if isinstance(self._picture, Dots) and self._scatter is not None:
            points = self._scatter.pointsAt(self._scatter.mapFromScene(place))
            numbers = [int(point.data()) for point in points]
            tips = [self._picture.tips[n] for n in numbers[:6]]
            return [self._picture.names[n] for n in numbers], "\n".join(tips)
        if isinstance(self._picture, Cells):
            point = item.vb.mapSceneToView(place)
            cell = self._picture.at(round(point.x()), round(point.y()))
            if cell is not None:
                pressure = self._picture.pressures_bar[cell.column]
                temperature = self._picture.temperatures_degc[cell.row]
                words = f"{pressure:g} bar, {temperature:g} °C: {cell.text}"
                more = self.tr("{0} brakings; click again for the next").format(len(cell.names))
                return list(cell.names), f"{words}\n{more}" if len(cell.names) > 1 else words
        return [], ""

    def _on_move(self, place: Any) -> None:
        names, words = self.below(place)
        self.setCursor(Qt.CursorShape.PointingHandCursor if names else Qt.CursorShape.ArrowCursor)
        self.setToolTip(words)

    def _on_click(self, event: Any) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            return
        names, _ = self.below(event.scenePos())
        if names:
            event.accept()
            self.picked.emit(names)

    def _restyle(self) -> None:
        self._draw()


def _luminance(colour: QColor) -> float:
    """Relative luminance of WCAG 2.1."""

    def linear(share: float) -> float:
        return share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4

    red, green, blue = (linear(share) for share in (colour.redF(), colour.greenF(), colour.blueF()))
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue

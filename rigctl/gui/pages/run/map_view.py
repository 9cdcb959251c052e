"""The occurrence map: a cell for each pressure and temperature, filled while the run goes on.

Job: draw `Occurrence` (outlined: to come, grey: judged without squeal, filled in viridis with a dot: squeal,
by its level), say what is under the mouse, tell which braking was clicked. Not its job: counting.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QHBoxLayout, QLabel, QVBoxLayout, QWidget

from rigctl.gui.format import number_text
from rigctl.gui.pages.run.occurrence import Cell, Occurrence
from rigctl.gui.services import Services
from rigctl.gui.widgets.plot_dress import PictureMenu, dress

LOWEST_DB, HIGHEST_DB = 60.0, 110.0
_COLOURS: Any = pg.colormap.get("viridis")


def level_colour(level_db: float) -> QColor:
    """Colour of a squeal level: viridis from 60 to 110 dB."""
    share = min(max((level_db - LOWEST_DB) / (HIGHEST_DB - LOWEST_DB), 0.0), 1.0)
    return _COLOURS.map(share, mode="qcolor")


class OccurrenceView(QWidget):
    """Shows an `Occurrence`; `clicked` carries the number of a braking."""

    clicked = Signal(int)

    def __init__(self, services: Services) -> None:
        super().__init__()
        self.setObjectName("occurrence-map")
        self._theme = services.theme
        self._occurrence = Occurrence()
        self._shown = -1
        self._pressures: list[float] = []
        self._temperatures: list[float] = []
        self.title = QLabel()
        self.title.setProperty("look", "title")
        self.hover = QLabel()
        self.hover.setObjectName("occurrence-hover")
        self.hover.setProperty("look", "muted")
        self.plot = pg.PlotWidget()
        self.plot.setObjectName("occurrence-plot")
        self.plot.setToolTip(
            self.tr("Click a cell: its loudest braking opens on the Data page. Right click: copy, save.")
        )
        self._item: Any = self.plot.getPlotItem()
        self._item.setMouseEnabled(False, False)
        self._item.hideButtons()
        self._image = pg.ImageItem()
        self._dots = pg.ScatterPlotItem(pxMode=True, symbol="o")
        self._item.addItem(self._image)
        self._item.addItem(self._dots)
        self._menu = PictureMenu(self.plot, "occurrence", services.notify)
        self._item.vb.sigResized.connect(self._on_resized)
        scene: Any = self.plot.scene()
        scene.sigMouseMoved.connect(self._on_moved)
        scene.sigMouseClicked.connect(self._on_clicked)
        self.scale_bar = _LevelScale(services)
        self._header = QHBoxLayout()
        self._header.addWidget(self.title)
        self._header.addStretch(1)
        self._header.addWidget(self.hover)
        self._column = QVBoxLayout(self)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.addLayout(self._header)
        self._column.addWidget(self.plot, 1)
        self._column.addWidget(self.scale_bar)
        self._theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        dress(self.plot, self._theme, self.tr("Brake pressure (bar)"), self.tr("Disc temperature (°C)"))
        self._column.setSpacing(self._theme.px(0.5))
        self.hover.setFont(self._theme.font("small"))
        self._shown = -1
        self.refresh()

    # -- value ------------------------------------------------------------------------------------

    def setValue(self, occurrence: Occurrence) -> None:
        """Another campaign."""
        self._occurrence = occurrence
        self._shown = -1
        self.refresh()

    def value(self) -> Occurrence:
        """What is shown."""
        return self._occurrence

    def refresh(self) -> None:
        """Draw anew when something has changed."""
        occurrence = self._occurrence
        if occurrence.revision == self._shown:
            return
        self._shown = occurrence.revision
        pressures, temperatures = occurrence.pressures, occurrence.temperatures
        if (pressures, temperatures) != (self._pressures, self._temperatures):
            self._pressures, self._temperatures = pressures, temperatures
            self._take_axes()
        self.title.setText(
            self.tr("Squeal over pressure and temperature: {0} of {1}").format(
                occurrence.squealing, occurrence.judged
            )
        )
        self._draw()

    def _take_axes(self) -> None:
        for side, values in (("bottom", self._pressures), ("left", self._temperatures)):
            self._item.getAxis(side).setTicks([_ticks(values), []])
        self._item.setRange(
            xRange=(-0.5, max(len(self._pressures), 1) - 0.5),
            yRange=(-0.5, max(len(self._temperatures), 1) - 0.5),
            padding=0.02,
        )

    def _draw(self) -> None:
        t = self._theme
        shape = (len(self._temperatures), len(self._pressures))
        if 0 in shape:
            self._image.clear()
            self._dots.clear()
            return
        image = np.zeros((*shape, 4), np.uint8)
        dots: list[dict[str, Any]] = []
        columns = {value: place for place, value in enumerate(self._pressures)}
        lines = {value: place for place, value in enumerate(self._temperatures)}
        planned, none = t.colour("window"), t.colour("plot_line")
        for (pressure, temperature), cell in self._occurrence.cells.items():
            place = lines[temperature], columns[pressure]
            level = cell.level_db
            colour = level_colour(level) if level is not None else none if cell.judged else planned
            image[place] = (colour.red(), colour.green(), colour.blue(), 255)
            if level is not None:
                dots.append({"pos": (place[1], place[0]), "brush": _dot_colour(colour)})
        self._image.setImage(image, levels=None, rect=(-0.5, -0.5, shape[1], shape[0]))
        self._dots.setData(dots, size=self._dot_size(), pen=None)

    def _dot_size(self) -> float:
        """A third of a cell, so that dots never touch."""
        box = self._item.vb
        lines, columns = max(len(self._temperatures), 1), max(len(self._pressures), 1)
        cell = min(box.height() / lines, box.width() / columns)
        return min(max(cell / 3.0, 1.0), float(self._theme.px(1)))

    def _on_resized(self) -> None:
        self._dots.setSize(self._dot_size())

    # -- mouse ------------------------------------------------------------------------------------

    def cell_at(self, x: float, y: float) -> tuple[tuple[float, float], Cell] | None:
        """Set-points and cell at a place of the plot."""
        column, line = round(x), round(y)
        if not (0 <= column < len(self._pressures) and 0 <= line < len(self._temperatures)):
            return None
        key = self._pressures[column], self._temperatures[line]
        cell = self._occurrence.cells.get(key)
        return None if cell is None else (key, cell)

    def describe(self, x: float, y: float) -> str:
        """What is at a place of the plot, in words."""
        found = self.cell_at(x, y)
        if found is None:
            return ""
        (pressure, temperature), cell = found
        place = self.tr("{0} bar, {1} °C: ").format(f"{pressure:g}", f"{temperature:g}")
        if cell.level_db is not None:
            return place + self.tr("squeal in {0} of {1}, up to {2} dB").format(
                len(cell.levels), len(cell.judged), number_text(cell.level_db, 1)
            )
        if cell.judged:
            return place + self.tr("no squeal in {0}").format(len(cell.judged))
        return place + self.tr("to come")

    def _place(self, position: QPointF) -> tuple[float, float]:
        point = self._item.vb.mapSceneToView(position)
        return point.x(), point.y()

    def _on_moved(self, position: QPointF) -> None:
        self.hover.setText(self.describe(*self._place(position)))

    def _on_clicked(self, event: Any) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            return
        found = self.cell_at(*self._place(event.scenePos()))
        if found is not None and found[1].loudest is not None:
            self.clicked.emit(found[1].loudest)


def _dot_colour(ground: QColor) -> QColor:
    """Black on light cells, white on dark ones."""
    return QColor("#000000" if ground.lightnessF() > 0.5 else "#ffffff")


def _ticks(values: list[float]) -> list[tuple[int, str]]:
    """Set-points at their places, thinned out to about a dozen."""
    step = max(-(-len(values) // 12), 1)
    return [(place, f"{value:g}") for place, value in enumerate(values) if place % step == 0]


class _LevelScale(QWidget):
    """Legend: what grey means, and the colours of the levels."""

    def __init__(self, services: Services) -> None:
        super().__init__()
        self._theme = services.theme
        self._none = QLabel(self.tr("no squeal"))
        self._swatch = QLabel()
        self._low = QLabel(f"{LOWEST_DB:.0f}")
        self._bar = QLabel()
        self._high = QLabel(f"{HIGHEST_DB:.0f}\u202fdB")
        self._row = QHBoxLayout(self)
        self._row.setContentsMargins(0, 0, 0, 0)
        for widget in (self._swatch, self._none, QLabel(self.tr("squeal")), self._low):
            self._row.addWidget(widget)
        self._row.addWidget(self._bar, 1)
        self._row.addWidget(self._high)
        self._theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        t = self._theme
        self._row.setSpacing(t.px(1))
        for label in self.findChildren(QLabel):
            label.setFont(t.font("small"))
        self._swatch.setFixedSize(t.px(1.5), t.px(1.5))
        self._swatch.setStyleSheet(f"background: {t.current.plot_line};")
        stops = ", ".join(
            f"stop:{share:.2f} {_COLOURS.map(share, mode='qcolor').name()}" for share in np.linspace(0, 1, 9)
        )
        self._bar.setFixedHeight(t.px(1.25))
        self._bar.setStyleSheet(f"background: qlineargradient(x1:0, y1:0, x2:1, y2:0, {stops});")

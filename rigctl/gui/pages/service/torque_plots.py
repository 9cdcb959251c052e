"""Two plots of a torque calibration: readings over torque with their line, and residuals in % of full scale.

Job: drawing. Not its job: the evaluation.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSizePolicy, QVBoxLayout, QWidget

from rigctl.calibration.record import Point
from rigctl.calibration.torque import TorqueAcceptance, TorqueResult
from rigctl.gui.pages.service.parts import label
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.plot_dress import PictureMenu, dress

_SYMBOLS = {"up": "t1", "down": "t"}


class TorquePlots(QWidget):
    """Line and residuals; rising loads ▲ and full lines, falling loads ▼ and dashed ones."""

    def __init__(self, theme: ThemeKeeper, notify: Callable[[str], None]) -> None:
        super().__init__()
        self._theme = theme
        self._points: Sequence[Point] = ()
        self._result: TorqueResult | None = None
        self._full_nm = 1.0
        self.line_plot = pg.PlotWidget()
        self.residual_plot = pg.PlotWidget()
        self.readout = label("", "muted")
        theme.changed.connect(self._restyle)
        for plot, name in ((self.line_plot, "torque-line"), (self.residual_plot, "torque-residuals")):
            item: Any = plot.getPlotItem()
            item.setClipToView(False)
            item.showGrid(x=True, y=True, alpha=0.15)
            plot.setMouseEnabled(x=True, y=False)
            plot.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Ignored)
            self._menu = PictureMenu(plot, name, notify)
            scene: Any = plot.scene()
            scene.sigMouseMoved.connect(lambda place, plot=plot: self._on_mouse(plot, place))
        self.residual_plot.setXLink(self.line_plot)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(theme.px(0.5))
        layout.addWidget(self.line_plot, 3)
        layout.addWidget(self.residual_plot, 2)
        layout.addWidget(self.readout)
        self._restyle()

    def _restyle(self) -> None:
        self.line_plot.setMinimumHeight(self._theme.px(20))
        self.residual_plot.setMinimumHeight(self._theme.px(18))
        self._draw()

    def show_result(self, points: Sequence[Point], result: TorqueResult | None, full_nm: float) -> None:
        """Draw readings so far, with the line when there is one."""
        self._points, self._result, self._full_nm = points, result, full_nm
        self._draw()

    def _draw(self) -> None:
        t = self._theme.current
        x_name = self.tr("torque of the weights (N·m)")
        dress(self.line_plot, self._theme, x_name, self.tr("reading (N·m)"))
        dress(self.residual_plot, self._theme, x_name, self.tr("residual (% FS)"))
        for plot in (self.line_plot, self.residual_plot):
            plot.clear()
            plot.addItem(pg.InfiniteLine(0.0, 0, pen=pg.mkPen(t.plot_line)))
        self.residual_plot.setYRange(-1.6 * self._limit(), 1.6 * self._limit())
        result = self._result
        if result is not None:
            applied = np.array([point.applied for point in self._points])
            ends = np.array([applied.min(), applied.max()])
            self.line_plot.plot(ends, (ends - result.offset) / result.gain, pen=pg.mkPen(t.muted, width=1))
            for edge in (-self._limit(), self._limit()):
                pen = pg.mkPen(t.text, style=Qt.PenStyle.DashLine)
                self.residual_plot.addItem(pg.InfiniteLine(edge, 0, pen=pen))
        if result is not None:
            self._draw_loops(result)
        for number, point in enumerate(self._points):
            symbol = _SYMBOLS.get(point.series.rpartition(" ")[2], "o")
            style = {"pen": None, "symbol": symbol, "symbolSize": self._theme.px(1.25), "symbolPen": None}
            self.line_plot.plot([point.applied], [point.measured], symbolBrush=t.torque, **style)
            if result is not None:
                percent = 100.0 * result.residuals_nm[number] / self._full_nm
                beyond = abs(percent) > self._limit()
                self.residual_plot.plot(
                    [point.applied], [percent], symbolBrush=t.red if beyond else t.torque, **style
                )
                span = max(1.6 * self._limit(), 1.2 * abs(percent))
                low, high = self.residual_plot.viewRange()[1]
                if span > high:
                    self.residual_plot.setYRange(min(low, -span), span)

    def _draw_loops(self, result: TorqueResult) -> None:
        """Residuals of rising and falling loads joined: the gap between the lines is the hysteresis."""
        t = self._theme.current
        for series in dict.fromkeys(point.series for point in self._points):
            own = [number for number, point in enumerate(self._points) if point.series == series]
            falling = series.endswith("down")
            pen = pg.mkPen(t.muted, style=Qt.PenStyle.DashLine if falling else Qt.PenStyle.SolidLine)
            applied = [self._points[number].applied for number in own]
            percent = [100.0 * result.residuals_nm[number] / self._full_nm for number in own]
            self.residual_plot.plot(applied, percent, pen=pen)

    def _limit(self) -> float:
        return TorqueAcceptance().residual_percent

    def _on_mouse(self, plot: pg.PlotWidget, place: Any) -> None:
        item: Any = plot.getPlotItem()
        if not self._points or not item.sceneBoundingRect().contains(place):
            self.readout.setText("")
            return
        at = item.vb.mapSceneToView(place).x()
        number = min(range(len(self._points)), key=lambda i: abs(self._points[i].applied - at))
        point = self._points[number]
        text = self.tr("{0}: {1:.1f} N·m applied, {2:.2f} N·m read").format(
            point.series, point.applied, point.measured
        )
        if self._result is not None:
            text += self.tr(", residual {0:+.2f} N·m").format(self._result.residuals_nm[number])
        self.readout.setText(text)

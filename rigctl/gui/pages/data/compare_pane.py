"""Two to four brakings laid over each other: spectra, friction, level; their results side by side.

Job: keep the set of brakings (of any campaign), have them read, draw one quantity of all. Not its job:
choosing them (the table).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QPushButton, QSplitter, QVBoxLayout, QWidget

from rigctl.analysis.braking_view import LEVEL, MU, BrakingView
from rigctl.core.channels import PRESSURE, TORQUE
from rigctl.gui.format import number_text
from rigctl.gui.pages.data import remote
from rigctl.gui.pages.data.details import LinesTable
from rigctl.gui.pages.data.entry import Entry
from rigctl.gui.services import Services
from rigctl.gui.widgets.elided import ElidedLabel
from rigctl.gui.widgets.plot_dress import PictureMenu, dress
from rigctl.gui.work import Job

MOST = 4
SPECTRUM, PEAKS = "spectrum", "peaks"
_LINES = (Qt.PenStyle.SolidLine, Qt.PenStyle.SolidLine, Qt.PenStyle.DashLine, Qt.PenStyle.DotLine)
_TOKENS = ("pressure", "torque", "speed", "temperature")


@dataclass
class _Compared:
    entry: Entry
    path: Path
    campaign: str
    view: BrakingView | None = None
    job: Job | None = None


class ComparePane(QWidget):
    """The brakings that are compared."""

    def __init__(self, services: Services) -> None:
        super().__init__()
        self._services = services
        theme = services.theme
        self._set: list[_Compared] = []
        self.what = QComboBox()
        self.what.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.what.setMinimumContentsLength(20)
        self.what.setObjectName("data-compare-what")
        self.what.setToolTip(self.tr("What is laid over each other"))
        for text, key in (
            (self.tr("Spectrum, mean while braking"), SPECTRUM),
            (self.tr("Spectrum, largest while braking"), PEAKS),
            (self.tr("Coefficient of friction over time"), MU),
            (self.tr("Sound level over time"), LEVEL),
            (self.tr("Pressure over time"), PRESSURE),
            (self.tr("Torque over time"), TORQUE),
        ):
            self.what.addItem(text, key)
        self.clear = QPushButton(self.tr("C&lear"))
        self.clear.setObjectName("data-compare-clear")
        self.clear.setToolTip(self.tr("Take all brakings out of the comparison"))
        self._top = QHBoxLayout()
        self._top.addWidget(self.what, 1)
        self._top.addWidget(self.clear)
        self.hint = QLabel(
            self.tr(
                "Choose two to four brakings in the table and press Compare. Further ones are added, also "
                "from other campaigns."
            )
        )
        self.hint.setWordWrap(True)
        self.hint.setProperty("look", "muted")
        self.plot = pg.PlotWidget()
        self.plot.setObjectName("data-compare-plot")
        item: Any = self.plot.getPlotItem()
        item.setClipToView(True)
        item.setDownsampling(auto=True, mode="peak")
        item.setMouseEnabled(x=True, y=False)
        self._legend: Any = item.addLegend(offset=(-10, 10))
        self.menu = PictureMenu(self.plot, "comparison", services.notify)
        self.menu.add(self.tr("Show all"), item.enableAutoRange)
        self.readout = ElidedLabel()
        self.readout.setProperty("look", "muted")
        self.table = LinesTable(
            theme,
            "data-compare-table",
            (self.tr("Result"), "", "", "", "", self.tr("Unit")),
            right=range(1, 5),
        )
        self.split = QSplitter(Qt.Orientation.Vertical)
        self.split.addWidget(self.plot)
        self.split.addWidget(self.table)
        self.split.setStretchFactor(0, 3)
        self.split.setStretchFactor(1, 2)
        self.split.setSizes([theme.px(40), theme.px(26)])
        self._column = QVBoxLayout(self)
        self._column.addLayout(self._top)
        self._column.addWidget(self.hint)
        self._column.addWidget(self.readout)
        self._column.addWidget(self.split, 1)
        self.what.currentIndexChanged.connect(self._draw_all)
        self.clear.clicked.connect(self.show_nothing)
        scene: Any = self.plot.scene()
        scene.sigMouseMoved.connect(self._on_move)
        theme.changed.connect(self._restyle)
        self._restyle()
        self._draw_all()

    # -- the set ------------------------------------------------------------------------------------

    def compared(self) -> list[Entry]:
        """Brakings in the set."""
        return [item.entry for item in self._set]

    @property
    def busy(self) -> bool:
        """True while brakings are read."""
        return any(item.job is not None for item in self._set)

    def show_nothing(self) -> None:
        """Empty the set."""
        self._drop(self._set)
        self._set = []
        self._draw_all()

    def compare(self, campaign: Path, entries: list[Entry]) -> None:
        """Two or more brakings are the new set; a single one is added, the oldest one leaves a full set."""
        if len(entries) > 1:
            self._drop(self._set)
            self._set = []
        for entry in entries[:MOST]:
            path = entry.path(campaign)
            if any(item.path == path for item in self._set):
                continue
            item = _Compared(entry, path, campaign.name)
            item.job = self._services.work.in_process(
                remote.overlay, path, done=partial(self._on_view, item),
                failed=partial(self._on_failed, item), lane=remote.LANE,
            )  # fmt: skip
            self._set.append(item)
        surplus = self._set[: max(len(self._set) - MOST, 0)]
        self._drop(surplus)
        self._set = self._set[len(surplus) :]
        self._draw_all()

    def _drop(self, items: list[_Compared]) -> None:
        for item in items:
            if item.job is not None:
                item.job.cancel()
                item.job = None

    def _on_view(self, item: _Compared, view: BrakingView) -> None:
        item.job, item.view = None, view
        self._draw_all()

    def _on_failed(self, item: _Compared, words: str) -> None:
        item.job = None
        self._set = [other for other in self._set if other is not item]
        self._services.notify(words)
        self._draw_all()

    # -- drawing ------------------------------------------------------------------------------------

    def _name(self, item: _Compared) -> str:
        several = len({other.campaign for other in self._set}) > 1
        number = self.tr("Braking {0}").format(item.entry.index)
        return f"{item.campaign} · {number}" if several else number

    def _pen(self, place: int) -> Any:
        colour = getattr(self._services.theme.current, _TOKENS[place % MOST])
        return pg.mkPen(colour, width=2 if place else 1, style=_LINES[place % MOST])

    def _draw_all(self) -> None:
        item: Any = self.plot.getPlotItem()
        item.clear()
        what = self.what.currentData()
        x_name, y_name = self._axis_names(what)
        dress(self.plot, self._services.theme, x_name, y_name)
        item.showGrid(x=True, y=True, alpha=0.15)
        self._legend.setLabelTextColor(self._services.theme.current.text)
        self._legend.setLabelTextSize(f"{self._services.theme.font('small').pointSizeF():.1f}pt")
        for place, compared in enumerate(self._set):
            points = self._points(compared, what)
            if points is not None:
                item.plot(*points, pen=self._pen(place), name=self._name(compared), connect="finite")
        if what in (SPECTRUM, PEAKS):
            item.setLimits(xMin=0.0, xMax=None)
        else:
            item.setLimits(xMin=None, xMax=None)
        item.enableAutoRange()
        for widget, shown in ((self.hint, len(self._set) < 2), (self.table, bool(self._set))):
            widget.setVisible(shown)
        self.clear.setEnabled(bool(self._set))
        self._fill_table()

    def _points(self, compared: _Compared, what: str) -> tuple[Any, Any] | None:
        view = compared.view
        if view is None:
            return None
        if what in (SPECTRUM, PEAKS):
            if view.spectrum is None:
                return None
            levels = view.spectrum.mean_db if what == SPECTRUM else view.spectrum.peak_db
            return view.spectrum.frequency_hz() / 1e3, levels
        curve = view.curves.get(what)
        return None if curve is None else (curve.time_s(), curve.values)

    def _axis_names(self, what: str) -> tuple[str, str]:
        time = self.tr("Time since the first sample [s]")
        return {
            SPECTRUM: (self.tr("Frequency [kHz]"), self.tr("Level per line [dB]")),
            PEAKS: (self.tr("Frequency [kHz]"), self.tr("Level per line [dB]")),
            MU: (time, self.tr("Coefficient of friction µ")),
            LEVEL: (time, self.tr("Sound level, Fast [dB]")),
            PRESSURE: (time, self.tr("Pressure [bar]")),
            TORQUE: (time, self.tr("Torque [N·m]")),
        }[what]

    def _fill_table(self) -> None:
        rows: list[tuple[str, str, Any, int]] = [
            (self.tr("Set pressure"), "bar", lambda r: r.set_pressure_bar, 1),
            (self.tr("Disc, start"), "°C", lambda r: r.temperature_initial_degc, 0),
            (self.tr("Speed, mean"), "1/min", lambda r: r.speed_mean_rpm, 1),
            (self.tr("Mean µ"), "", lambda r: r.mean_mu, 3),
            (self.tr("Torque, mean"), "N·m", lambda r: r.torque_mean_nm, 1),
            (self.tr("Squeal frequency"), "Hz", lambda r: r.squeal_frequency_hz, 0),
            (self.tr("Squeal level"), "dB", lambda r: r.squeal_level_db, 1),
            (self.tr("Equivalent level, A"), "dB(A)", lambda r: r.laeq_db, 1),
            (self.tr("Highest level"), "dB", lambda r: r.lmax_db, 1),
        ]
        lines = []
        for name, unit, value, decimals in rows:
            cells = [number_text(value(item.entry.row), decimals) for item in self._set]
            lines.append((name, *cells, *[""] * (MOST - len(cells)), unit))
        for place in range(MOST):
            title = self.table.horizontalHeaderItem(place + 1)
            if title is not None:
                title.setText(self._name(self._set[place]) if place < len(self._set) else "")
            self.table.setColumnHidden(place + 1, place >= len(self._set))
        self.table.show_lines(lines)

    def _on_move(self, place: Any) -> None:
        item: Any = self.plot.getPlotItem()
        if not item.vb.sceneBoundingRect().contains(place):
            self.readout.setText("")
            return
        point = item.vb.mapSceneToView(place)
        what = self.what.currentData()
        x = f"{point.x() * 1e3:.0f} Hz" if what in (SPECTRUM, PEAKS) else f"{point.x():.2f} s"
        parts = [x]
        for compared in self._set:
            points = self._points(compared, what)
            if points is not None and len(points[0]):
                near = min(max(int(points[0].searchsorted(point.x())), 0), len(points[0]) - 1)
                decimals = 3 if what == MU else 1
                parts.append(f"{self._name(compared)}: {number_text(float(points[1][near]), decimals)}")
        self.readout.setText("   ".join(parts))

    def _restyle(self) -> None:
        u = self._services.theme.px
        self._column.setContentsMargins(u(1), u(1), u(1), u(1))
        self._column.setSpacing(u(1))
        self._top.setSpacing(u(1))
        self._draw_all()

"""Figures and statistics of the campaign, and of a second one beside it.

Job: choose a figure, choose the second campaign, keep both on one scale, the statistics in two columns;
what is clicked is told. Not its job: numbers (`figure_data`), drawing (`figure_plot`).
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QSplitter, QVBoxLayout, QWidget

from rigctl.gui.pages.data.campaigns import CampaignInfo
from rigctl.gui.pages.data.entry import Entry
from rigctl.gui.pages.data.figure_data import FIGURES, Dots, FigureData, figure_data
from rigctl.gui.pages.data.figure_plot import FigurePlot
from rigctl.gui.pages.data.loader import CampaignLoader
from rigctl.gui.pages.data.statistics_table import StatisticsTable
from rigctl.gui.services import Services
from rigctl.gui.widgets.elided import ElidedLabel
from rigctl.gui.work import Job, Reporter

_SETTLE_MS = 250


class FiguresPane(QWidget):
    """One or two campaigns."""

    picked = Signal(list)
    """Files of the first campaign that were clicked."""
    pickedBeside = Signal(object, list)
    """Second campaign and its files that were clicked."""

    def __init__(self, services: Services) -> None:
        super().__init__()
        self._services = services
        theme = services.theme
        self._axes = self._axis_names()
        self._make_top()
        self._make_plots()
        self._entries: tuple[list[Entry], list[Entry]] = ([], [])
        self._data: list[FigureData | None] = [None, None]
        self._jobs: list[Job | None] = [None, None]
        self._active = False
        self._stale = [False, False]
        self._last_pick: tuple[str, ...] = ()
        self._pick_number = 0
        self._settle = QTimer(self)
        self._settle.setSingleShot(True)
        self._settle.setInterval(_SETTLE_MS)
        self._settle.timeout.connect(self._compute)
        self.loader = CampaignLoader(services.work, self)
        self._second: dict[str, Entry] = {}
        self.loader.opened.connect(self._on_second)
        self.loader.changed.connect(self._on_second_changed)
        self.loader.failed.connect(services.notify)
        self.figure.currentIndexChanged.connect(self._on_figure)
        self.beside.currentIndexChanged.connect(self._on_beside)
        self.plots[0].picked.connect(self._on_picked)
        self.plots[1].picked.connect(self._on_picked_beside)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _make_top(self) -> None:
        self.figure = QComboBox()
        self.figure.setObjectName("data-figure")
        self.figure.setToolTip(self.tr("Figures of the report; click a dot or a cell to open its braking"))
        self.figure.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.figure.setMinimumContentsLength(12)
        for key, text in self._titles().items():
            self.figure.addItem(text, key)
        self.beside = QComboBox()
        self.beside.setObjectName("data-beside")
        self.beside.setToolTip(self.tr("A second campaign beside the first, on the same scales"))
        self.beside.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.beside.setMinimumContentsLength(8)
        label = QLabel(self.tr("&Beside"))
        label.setBuddy(self.beside)
        self.scale = ElidedLabel()
        self.scale.setProperty("look", "muted")
        self._top = QHBoxLayout()
        self._top.addWidget(self.figure, 2)
        self._top.addWidget(label)
        self._top.addWidget(self.beside, 1)

    def _make_plots(self) -> None:
        theme, services = self._services.theme, self._services
        self.plots = (
            FigurePlot(theme, "data-figure-plot", services.notify),
            FigurePlot(theme, "data-figure-beside", services.notify),
        )
        self.captions = (ElidedLabel(), ElidedLabel())
        self._halves: list[QWidget] = []
        self.split = QSplitter(Qt.Orientation.Horizontal)
        for caption, plot in zip(self.captions, self.plots, strict=True):
            caption.setProperty("look", "title")
            half = QWidget()
            column = QVBoxLayout(half)
            column.setContentsMargins(0, 0, 0, 0)
            column.addWidget(caption)
            column.addWidget(plot, 1)
            self._halves.append(half)
            self.split.addWidget(half)
        self._halves[1].hide()
        self.statistics = StatisticsTable(theme)
        self.outer = QSplitter(Qt.Orientation.Vertical)
        self.outer.addWidget(self.split)
        self.outer.addWidget(self.statistics)
        self.outer.setStretchFactor(0, 3)
        self.outer.setStretchFactor(1, 2)
        self.outer.setSizes([theme.px(40), theme.px(26)])
        self._column = QVBoxLayout(self)
        self._column.addLayout(self._top)
        self._column.addWidget(self.scale)
        self._column.addWidget(self.outer, 1)

    # -- what is shown ------------------------------------------------------------------------------

    def show_entries(self, name: str, entries: list[Entry]) -> None:
        """The first campaign; drawn soon, at once for many changes."""
        self.captions[0].setText(name)
        self._entries = (entries, self._entries[1])
        self._renew(0)

    def show_campaigns(self, campaigns: list[CampaignInfo], present: Path | None) -> None:
        """Campaigns that may stand beside the present one."""
        chosen = self.beside.currentData()
        self.beside.blockSignals(True)
        self.beside.clear()
        self.beside.addItem(self.tr("no other"), None)
        for info in campaigns:
            if info.path != present:
                self.beside.addItem(info.name, info.path)
        self.beside.setCurrentIndex(max(self.beside.findData(chosen), 0))
        self.beside.blockSignals(False)
        if self.beside.currentData() != chosen:
            self._on_beside()

    def set_chosen(self, names: list[str]) -> None:
        """Mark brakings of the first campaign."""
        self.plots[0].set_chosen(names)

    def set_active(self, active: bool) -> None:
        """Only figures that are seen are computed."""
        self._active = active
        if active and any(self._stale):
            self._settle.start(0)
        elif not active:
            self._settle.stop()

    def close_jobs(self) -> None:
        """Compute and read nothing more."""
        self._settle.stop()
        self.loader.close()
        for job in self._jobs:
            if job is not None:
                job.cancel()
        self._jobs = [None, None]

    @property
    def busy(self) -> bool:
        """True while something is to be computed."""
        return any(self._jobs) or self._settle.isActive() or self.loader.busy

    def _renew(self, side: int) -> None:
        self._stale[side] = True
        if self._active:
            self._settle.start(_SETTLE_MS)

    def _compute(self) -> None:
        for side in (0, 1):
            if not self._stale[side]:
                continue
            self._stale[side] = False
            job = self._jobs[side]
            if job is not None:
                job.cancel()
            self._jobs[side] = self._services.work.in_thread(
                _figure, self.figure.currentData(), list(self._entries[side]),
                done=partial(self._on_data, side), failed=self._services.notify,
            )  # fmt: skip

    def _on_data(self, side: int, data: FigureData) -> None:
        self._jobs[side] = None
        self._data[side] = data
        self.plots[side].show_picture(data.picture, *self._axes[data.key])
        self._link(isinstance(data.picture, Dots))
        self._say_statistics()
        self._show_scale(data)

    def _link(self, linked: bool) -> None:
        """Both on one scale where the axes are numbers."""
        second: Any = self.plots[1].getPlotItem()
        first: Any = self.plots[0].getPlotItem() if linked and self.beside.currentData() else None
        second.setXLink(first)
        second.setYLink(first)

    # -- the second campaign ------------------------------------------------------------------------

    def _on_beside(self) -> None:
        path: Path | None = self.beside.currentData()
        self._halves[1].setVisible(path is not None)
        self._second = {}
        self._data[1] = None
        self.loader.close()
        if path is None:
            self._link(False)
            self._say_statistics()
            return
        self.captions[1].setText(self.beside.currentText())
        self.loader.open(path)

    def _on_second(self, entries: list[Entry]) -> None:
        self._second = {entry.name: entry for entry in entries}
        self._entries = (self._entries[0], list(self._second.values()))
        self._renew(1)

    def _on_second_changed(self, entries: list[Entry], gone: list[str]) -> None:
        for name in gone:
            self._second.pop(name, None)
        self._second.update((entry.name, entry) for entry in entries)
        self._entries = (self._entries[0], list(self._second.values()))
        self._renew(1)

    # -- clicks -------------------------------------------------------------------------------------

    def _on_figure(self) -> None:
        self._stale = [True, self.beside.currentData() is not None]
        if self._active:
            self._compute()

    def _next_of(self, names: list[str]) -> list[str]:
        """Clicking the same place again goes to the next braking there."""
        if tuple(names) == self._last_pick:
            self._pick_number += 1
        else:
            self._last_pick, self._pick_number = tuple(names), 0
        return [names[self._pick_number % len(names)]]

    def _on_picked(self, names: list[str]) -> None:
        self.picked.emit(self._next_of(names))

    def _on_picked_beside(self, names: list[str]) -> None:
        self.pickedBeside.emit(self.beside.currentData(), self._next_of(names))

    # -- words --------------------------------------------------------------------------------------

    def _titles(self) -> dict[str, str]:
        titles = {
            "pressure_frequency": self.tr("Frequency over pressure"),
            "occurrence": self.tr("Occurrence over pressure and temperature"),
            "levels": self.tr("Levels of squeal"),
            "frequency_temperature": self.tr("Frequency over temperature"),
            "friction_map": self.tr("Friction over pressure and temperature"),
            "friction_number": self.tr("Friction over number"),
        }
        return {key: titles[key] for key in FIGURES}

    def _axis_names(self) -> dict[str, tuple[str, str]]:
        pressure, temperature = self.tr("Brake pressure [bar]"), self.tr("Disc temperature [°C]")
        frequency = self.tr("Frequency [kHz]")
        mean_mu = self.tr("Mean coefficient of friction")
        return {
            "pressure_frequency": (pressure, frequency),
            "occurrence": (pressure, temperature),
            "levels": (self.tr("Level of the loudest squeal [dB]"), self.tr("Brakings that reach it [%]")),
            "frequency_temperature": (temperature, frequency),
            "friction_map": (pressure, temperature),
            "friction_number": (self.tr("Number of the braking"), mean_mu),
        }

    def _show_scale(self, data: FigureData) -> None:
        if data.key == "friction_map":
            words = self.tr("Number: mean µ. Dark: low, light: high.")
        elif data.key == "occurrence":
            words = self.tr(
                "Number: level of the loudest squeal in dB, or squealing / all brakings. Blank: no squeal. "
                "Dark 60 dB … light 100 dB."
            )
        else:
            words = self.tr(
                "Size and colour: level of the squeal, dark 60 dB … light 100 dB. Grey: no squeal."
            )
        self.scale.setText(words)

    def _say_statistics(self) -> None:
        first, second = (None if data is None else data.summary for data in self._data)
        self.statistics.show_summaries((self.captions[0].text(), first), (self.captions[1].text(), second))

    def _restyle(self) -> None:
        u = self._services.theme.px
        self._column.setContentsMargins(u(1), u(1), u(1), u(1))
        self._column.setSpacing(u(1))
        self._top.setSpacing(u(1))
        self.scale.setFont(self._services.theme.font("small"))


def _figure(key: str, entries: list[Entry], reporter: Reporter) -> FigureData:
    del reporter
    return figure_data(key, entries)

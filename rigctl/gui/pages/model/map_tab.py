"""Second tab of the model page: stability over two sliders, with measured squeal drawn into it.

Job: the choices above the map and the lines below it. Not its job: asking the worker (`map_state`), painting
(`map_plot`).
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QSignalBlocker
from PySide6.QtWidgets import (
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.pages.model.axis_choice import AxisChoice
from rigctl.gui.pages.model.data import (
    BrakeFacts,
    CampaignPoints,
    MapAxis,
    Measured,
    StabilityMap,
)
from rigctl.gui.pages.model.map_plot import MapPlot, measured_text
from rigctl.gui.pages.model.map_state import MapState
from rigctl.gui.pages.model.state import ModelState
from rigctl.gui.pages.model.words import axis_of
from rigctl.gui.services import Services
from rigctl.gui.widgets.elided import ElidedLabel
from rigctl.gui.widgets.file_asking import ask_open
from rigctl.gui.widgets.plot_dress import PictureMenu

_OTHER_FOLDER = "other"


class MapTab(QWidget):
    """Axes, campaign, map, progress."""

    def __init__(self, state: ModelState, services: Services) -> None:
        super().__init__()
        theme = services.theme
        self._state, self._services, self._theme = state, services, theme
        self.map = MapState(state, services)
        self.across, self.upwards = AxisChoice(theme, self.map.x), AxisChoice(theme, self.map.y)
        self.campaign = QComboBox()
        self.campaign.setObjectName("map-campaign")
        self.campaign.setToolTip(self.tr("Measured squeal of this campaign is drawn into the map"))
        self.plot = MapPlot(theme)
        self.plot.setObjectName("model-map")
        self.problem, self.note = QLabel(), ElidedLabel()
        self.problem.setProperty("look", "error")
        self.problem.setWordWrap(True)
        self.problem.hide()
        self.note.setProperty("look", "muted")
        self.under_mouse = ElidedLabel()
        self.progress, self.progress_words = QProgressBar(), QLabel()
        self.progress.setRange(0, 0)
        self.cancel, self.again = QPushButton(self.tr("Cancel")), QPushButton(self.tr("C&ompute"))
        self.cancel.setObjectName("map-cancel")
        self.cancel.setToolTip(self.tr("Keep the map that is there"))
        self.again.setToolTip(self.tr("Compute the map for the sliders' values"))
        self.open_braking = QPushButton(self.tr("Open bra&king"))
        self.open_braking.setToolTip(self.tr("Show the braking of the measured point on the data page"))
        self.chosen: Measured | None = None
        self.menu = PictureMenu(self.plot, "stability-map", services.notify)
        self.menu.add(self.tr("View: whole map"), self.plot.show_whole)
        self._arrange()
        self._connect()
        theme.changed.connect(self._restyle)
        self._restyle()
        self._show_work("")
        self._choose_point(None)
        self._fill(None)
        self._list_campaigns()

    def _arrange(self) -> None:
        self._grid = QGridLayout()
        for column, (text, widget) in enumerate(
            (
                (self.tr("Across"), self.across),
                (self.tr("Upwards"), self.upwards),
            )
        ):
            label = QLabel(text)
            label.setBuddy(widget)
            self._grid.addWidget(label, 0, column)
            self._grid.addWidget(widget, 1, column)
            self._grid.setColumnStretch(column, 1)
        self._work = QHBoxLayout()
        self._work.addWidget(self.under_mouse, 1)
        for widget in (self.progress_words, self.progress, self.cancel, self.again, self.open_braking):
            self._work.addWidget(widget)
        self._column = QVBoxLayout(self)
        self._column.addLayout(self._grid)
        self._column.addWidget(self.problem)
        self._column.addWidget(self.plot, 1)
        self._column.addLayout(self._work)
        self._measured = QHBoxLayout()
        label = QLabel(self.tr("Measured s&queal"))
        label.setBuddy(self.campaign)
        self._measured.addWidget(label)
        self._measured.addWidget(self.campaign)
        self._measured.addWidget(self.note, 1)
        self._column.addLayout(self._measured)

    def _connect(self) -> None:
        for axis in (self.across, self.upwards):
            axis.combo.activated.connect(self._axes_changed)
            axis.low.valueChanged.connect(self._axes_changed)
            axis.high.valueChanged.connect(self._axes_changed)
        self.campaign.activated.connect(self._choose_campaign)
        self.cancel.clicked.connect(self.map.cancel)
        self.again.clicked.connect(self.map.again)
        self.open_braking.clicked.connect(self._open_braking)
        self.map.mapFound.connect(self._show_map)
        self.map.working.connect(self._show_work)
        self.map.failed.connect(self._show_problem)
        self.map.campaignWrong.connect(self._show_problem)
        self.map.stale.connect(self.again.setVisible)
        self.map.pointsFound.connect(self._show_points)
        self._state.brakeRead.connect(self._fill)
        self._state.changed.connect(self._show_here)
        self.plot.jumped.connect(self._jump)
        self.plot.chosen.connect(self._choose_point)
        self.plot.pointed.connect(self._say)

    def _restyle(self) -> None:
        px = self._theme.px
        self._column.setContentsMargins(px(1), px(1), px(1), px(1))
        self._column.setSpacing(px(1))
        self._grid.setHorizontalSpacing(px(2))
        self._grid.setVerticalSpacing(px(0.5))
        self._work.setSpacing(px(1))
        self._measured.setSpacing(px(1))
        self.progress.setFixedWidth(px(12))

    # -- page -------------------------------------------------------------------------------------

    def set_seen(self, seen: bool) -> None:
        """Only a map that is looked at is computed."""
        if seen:
            self._list_campaigns()
        self.map.set_seen(seen)
        self._show_here()

    # -- showing ----------------------------------------------------------------------------------

    def _fill(self, facts: BrakeFacts | None) -> None:
        for choice, axis in ((self.across, self.map.x), (self.upwards, self.map.y)):
            choice.setValue(axis)
            choice.fill(facts)
            choice.setEnabled(facts is not None)
        if facts is None:
            self.plot.show_map(None)
        self._names()

    def _names(self) -> None:
        facts = self._state.facts
        self.plot.set_names(axis_of(self.map.x.key, facts), axis_of(self.map.y.key, facts))

    def _show_map(self, found: StabilityMap) -> None:
        self._names()
        self.plot.show_map(found)
        self._place_points(self.map.points)
        self._show_here()
        self._say("")

    def _show_work(self, words: str) -> None:
        for widget in (self.progress, self.progress_words, self.cancel):
            widget.setVisible(bool(words))
        self.progress_words.setText(words)
        if words or self.map.map is not None:
            self.again.hide()

    def _show_problem(self, text: str) -> None:
        self.problem.setText(text)
        self.problem.setVisible(bool(text))

    def _show_here(self) -> None:
        if self._state.facts is not None:
            self.plot.show_here(self._state.value(self.map.x.key), self._state.value(self.map.y.key))

    def _say(self, text: str) -> None:
        found = self.map.map
        if not text and self.chosen is not None:
            text = measured_text(self.chosen)
        if not text and found is not None:
            text = self.tr("Unstable over {0} % of the area. Click: the sliders jump there.").format(
                f"{100.0 * found.unstable_share:.0f}"
            )
        self.under_mouse.setText(text)

    # -- measured squeal --------------------------------------------------------------------------

    def _list_campaigns(self) -> None:
        points = self.map.points
        shown = None if points is None else points.folder
        folders = self.map.campaigns()
        if shown is not None and shown not in folders:
            folders.insert(0, shown)
        with QSignalBlocker(self.campaign):
            self.campaign.clear()
            self.campaign.addItem(self.tr("none"), None)
            for folder in folders:
                self.campaign.addItem(folder.name, folder)
            self.campaign.addItem(self.tr("Other folder…"), _OTHER_FOLDER)
            row = next((r for r in range(self.campaign.count()) if self.campaign.itemData(r) == shown), 0)
            self.campaign.setCurrentIndex(row)
        if points is None:
            self._show_points(None)

    def _choose_campaign(self, row: int) -> None:
        folder = self.campaign.itemData(row)
        if folder == _OTHER_FOLDER:
            self._list_campaigns()
            start = self._services.data_folder
            ask_open(self, self.tr("Choose a campaign"), start, "", self.open_campaign, folders=True)
        else:
            self.open_campaign(folder)

    def open_campaign(self, folder: Path | None) -> None:
        """Draw the squeal of a campaign into the map; None: none."""
        self.map.open_campaign(folder)

    def _show_points(self, points: CampaignPoints | None) -> None:
        self._choose_point(None)
        self._place_points(points)
        if points is None:
            self.note.setText(
                self.tr("Choose a campaign to see its measured squeal over the predicted boundary.")
            )
            return
        self._list_campaigns()

    def _place_points(self, points: CampaignPoints | None) -> None:
        if points is None:
            self.plot.show_points([], [])
            return
        placed = [
            [(p, place) for p in group if (place := self.map.place_of(p)) is not None]
            for group in (points.squeals, points.quiet)
        ]
        self.plot.show_points(placed[0], placed[1])
        if (points.squeals or points.quiet) and not any(placed):
            words = self.tr("Measured squeal is drawn where the axes are friction and pressure.")
        else:
            words = self.tr("■ squeal measured: {0}, colour is its frequency   ○ braking without squeal: {1}")
            words = words.format(len(points.squeals), len(points.quiet))
            if points.without_place:
                words += self.tr("   not drawn, no friction measured: {0}").format(points.without_place)
        self.note.setText(words)

    def _choose_point(self, point: Measured | None) -> None:
        self.chosen = point
        self.open_braking.setVisible(point is not None)
        self._say("")

    def _open_braking(self) -> None:
        if self.chosen is not None:
            self._services.navigate("data", braking=self.chosen.file)

    # -- a person's doings ------------------------------------------------------------------------

    def _axes_changed(self) -> None:
        axes = []
        for choice in (self.across, self.upwards):
            axis = choice.read()
            choice.setValue(axis)
            axes.append(axis)
        problem = self._problem_of(*axes)
        self._show_problem(problem)
        if not problem:
            self.map.set_axes(*axes)

    def _problem_of(self, x: MapAxis, y: MapAxis) -> str:
        if x.key == y.key:
            return self.tr("Both axes are the same slider. Choose another for one of them.")
        for axis in (x, y):
            if not axis.low < axis.high:
                return self.tr("{0}: the least value must lie below the largest.").format(
                    axis_of(axis.key, self._state.facts)
                )
        return ""

    def _jump(self, x: float, y: float) -> None:
        self._state.set({self.map.x.key: x, self.map.y.key: y})

"""First tab of the model page: plane of eigenvalues, list of modes, the brake moving in one of them.

Job: lay the three out and let them agree about the selected mode. Not its job: sliders.
"""

from __future__ import annotations

from PySide6.QtCore import QSettings, Qt
from PySide6.QtWidgets import QHBoxLayout, QPushButton, QSplitter, QVBoxLayout, QWidget

from rigctl.gui.pages.model.data import LocusLines, Poles
from rigctl.gui.pages.model.locus_plot import LocusPlot
from rigctl.gui.pages.model.mode_table import ModeTable
from rigctl.gui.pages.model.mode_view import ModeView
from rigctl.gui.pages.model.state import ModelState
from rigctl.gui.pages.model.words import axis_of
from rigctl.gui.services import Services
from rigctl.gui.widgets.elided import ElidedLabel
from rigctl.gui.widgets.plot_dress import PictureMenu


class LocusTab(QWidget):
    """Plot on the left; modes above the moving brake on the right."""

    def __init__(self, state: ModelState, services: Services) -> None:
        super().__init__()
        theme = services.theme
        self._state, self._theme = state, theme
        self._fresh, self._wrong, self._pointed = True, "", ""
        self.plot, self.table, self.view = LocusPlot(theme), ModeTable(theme), ModeView(theme)
        self.plot.setObjectName("model-locus")
        self.path, self.under_mouse = ElidedLabel(), ElidedLabel()
        self.under_mouse.setProperty("look", "muted")
        self.all_modes = QPushButton(self.tr("&All"))
        self.all_modes.setToolTip(self.tr("All poles in view"))
        self.squeal = QPushButton(self.tr("&To 5 kHz"))
        self.squeal.setToolTip(self.tr("Poles of the squeal range in view"))
        self.boundary = QPushButton(self.tr("Bou&ndary"))
        self.boundary.setToolTip(self.tr("A closer look at the modes that couple or become unstable first"))
        self.menu = PictureMenu(self.plot, "root-locus", services.notify)
        self.menu.add(self.tr("View: all modes"), self.plot.show_all)
        self.menu.add(self.tr("View: squeal range"), self.plot.show_squeal)
        self.menu.add(self.tr("View: near the boundary"), self.plot.show_boundary)
        self.view_menu = PictureMenu(self.view.plot, "mode", services.notify)
        self._arrange()
        self._connect()
        theme.changed.connect(self._restyle)
        self._restyle()

    def _arrange(self) -> None:
        left, right = QWidget(), QSplitter(Qt.Orientation.Vertical)
        self._left = QVBoxLayout(left)
        self._bar = QHBoxLayout()
        self._bar.addWidget(self.path, 1)
        self._bar.addWidget(self.all_modes)
        self._bar.addWidget(self.squeal)
        self._bar.addWidget(self.boundary)
        self._left.addLayout(self._bar)
        self._left.addWidget(self.plot, 1)
        self._left.addWidget(self.under_mouse)
        right.addWidget(self.table)
        right.addWidget(self.view)
        right.setStretchFactor(0, 2)
        right.setStretchFactor(1, 3)
        right.setChildrenCollapsible(False)
        self.split, self.split_right = QSplitter(Qt.Orientation.Horizontal), right
        self.split.addWidget(left)
        self.split.addWidget(right)
        self.split.setStretchFactor(0, 1)
        self.split.setSizes([self._theme.px(56), self._theme.px(48)])
        self.split.setChildrenCollapsible(False)
        right.setSizes([self._theme.px(38), self._theme.px(40)])
        self._whole = QVBoxLayout(self)
        self._whole.addWidget(self.split)

    def _connect(self) -> None:
        state = self._state
        state.polesFound.connect(self._show_poles)
        state.locusFound.connect(self._show_locus)
        state.locusAway.connect(self._fade)
        state.locusWrong.connect(self._no_path)
        state.brakeRead.connect(self._show_brake)
        state.wrong.connect(self._say_wrong)
        self.plot.picked.connect(state.select)
        self.table.picked.connect(state.select)
        self.plot.pointed.connect(self._point)
        self.all_modes.clicked.connect(self.plot.show_all)
        self.squeal.clicked.connect(self.plot.show_squeal)
        self.boundary.clicked.connect(self.plot.show_boundary)

    def _restyle(self) -> None:
        px = self._theme.px
        self._left.setContentsMargins(0, 0, px(1), 0)
        self._left.setSpacing(px(1))
        self._bar.setSpacing(px(1))
        self._whole.setContentsMargins(px(1), px(1), px(1), px(1))
        self.split.setHandleWidth(px(0.5))
        self.split_right.setHandleWidth(px(0.5))
        self.view.setContentsMargins(px(1), px(1), 0, 0)
        self._say("")

    # -- showing ----------------------------------------------------------------------------------

    def _show_brake(self, facts: object) -> None:
        self._fresh = True
        self.plot.show_locus(None)
        if facts is None:
            self.plot.show_poles(None)
            self.table.show_poles(None)
            self.view.show_poles(None)
            self.path.clear()
            self._say("")

    def _show_poles(self, poles: Poles) -> None:
        self.plot.show_poles(poles)
        self.table.show_poles(poles)
        self.view.show_poles(poles)
        if self._fresh:  # a new brake: afterwards the axes stay as a person has them
            self._fresh = False
            self.plot.show_squeal()
        if not self._pointed:
            self._say("")

    def _show_locus(self, locus: LocusLines) -> None:
        self.path.setText(self.tr("Path: {0}").format(axis_of(locus.over, self._state.facts)))
        self.plot.show_locus(locus)

    def _fade(self) -> None:
        self.plot.fade_locus()

    def _no_path(self, reason: str) -> None:
        self.plot.show_locus(None)
        self.path.setText(self.tr("No path: {0}").format(reason))

    def _point(self, text: str) -> None:
        self._pointed = text
        self._say(text)

    def _say(self, text: str) -> None:
        """What is under the mouse; else what is wrong, or what a person can do here."""
        selected = self._state.selected
        if self._wrong or self._state.facts is None:
            text = self._wrong
        elif not text and selected is not None and not self.plot.sees(selected):
            text = self.tr("The selected mode lies outside the view. Press [To 5 kHz] or [All].")
        elif not text:
            text = self.tr("Click a pole: the brake moves in that mode. × start of a path.")
        self.under_mouse.setText(text)

    def _say_wrong(self, text: str) -> None:
        if text == self._wrong:
            return
        self._wrong = text
        self.under_mouse.setProperty("look", "error" if text else "muted")
        self.under_mouse.style().polish(self.under_mouse)
        self._say("")

    # -- layout -----------------------------------------------------------------------------------

    def save_layout(self, settings: QSettings) -> None:
        """Remember the splitters."""
        settings.setValue("locus-split", self.split.saveState())
        settings.setValue("locus-split-right", self.split_right.saveState())

    def restore_layout(self, settings: QSettings) -> None:
        """Splitters as they were left."""
        for name, split in (("locus-split", self.split), ("locus-split-right", self.split_right)):
            value = settings.value(name)
            if value is not None:
                split.restoreState(value)

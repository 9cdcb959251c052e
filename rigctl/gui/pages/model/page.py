"""The model page: what the brake model says about stability, and what would help.

Job: put the parts together (head, sliders, three tabs), remember the layout. Not its job: what they show.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import QSettings, Qt
from PySide6.QtWidgets import QFrame, QScrollArea, QSplitter, QTabWidget, QVBoxLayout

from rigctl.gui.pages.base import Page
from rigctl.gui.pages.model.header import ModelHeader
from rigctl.gui.pages.model.locus_tab import LocusTab
from rigctl.gui.pages.model.map_tab import MapTab
from rigctl.gui.pages.model.ranking_tab import RankingTab
from rigctl.gui.pages.model.sliders_panel import SlidersPanel
from rigctl.gui.pages.model.state import ModelState
from rigctl.gui.services import Services


class ModelPage(Page):
    """Root locus, stability map, ranking of design modifications."""

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self.state = ModelState(services, self)
        self.header = ModelHeader(self.state, services.theme, services.config_folder / "brakes")
        self.sliders = SlidersPanel(self.state, services.theme)
        self.locus = LocusTab(self.state, services)
        self.tabs = QTabWidget()
        self.tabs.setObjectName("model-tabs")
        self.tabs.setDocumentMode(True)
        self.map = MapTab(self.state, services)
        self.ranking = RankingTab(self.state, services)
        self.tabs.addTab(self.locus, self.tr("Root &locus"))
        self.tabs.addTab(self.map, self.tr("Stability &map"))
        self.tabs.addTab(self.ranking, self.tr("What h&elps"))
        self.tabs.currentChanged.connect(self._tab_changed)
        self.split = QSplitter(Qt.Orientation.Horizontal)
        self.side = QScrollArea()
        self.side.setWidgetResizable(True)
        self.side.setFrameShape(QFrame.Shape.NoFrame)
        self.side.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.side.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.side.setWidget(self.sliders)
        self.split.addWidget(self.side)
        self.split.addWidget(self.tabs)
        self.split.setStretchFactor(1, 1)
        self.split.setChildrenCollapsible(False)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.header)
        column.addWidget(self.split, 1)
        services.theme.changed.connect(self._restyle)
        self._restyle()
        self._begun, self._active = False, False
        self._brake: Path | None = self.header.brake.first()
        self._other: Path | None = None

    def _restyle(self) -> None:
        px = self.services.theme.px
        self.split.setHandleWidth(px(0.5))
        bar = self.side.verticalScrollBar().sizeHint().width()
        self.side.setMinimumWidth(self.sliders.minimumSizeHint().width() + bar)
        self.split.setSizes([px(38), px(100)])

    # -- page -------------------------------------------------------------------------------------

    def activated(self) -> None:
        """Read the brake when first looked at; let the brake move."""
        if not self._begun:
            self._begun = True
            if self._brake is not None:
                self.header.brake.setValue(self._brake)
                self.state.open(self._brake)
            if self._other is not None:
                self.header.other.setValue(self._other)
                self.state.compare(self._other)
        self._active = True
        self._tab_changed()

    def deactivated(self) -> None:
        """Nothing moves and nothing is computed unseen."""
        self._active = False
        self._tab_changed()

    def _tab_changed(self) -> None:
        shown = self.tabs.currentWidget() if self._active else None
        self.locus.view.setSeen(shown is self.locus)
        self.map.set_seen(shown is self.map)
        self.ranking.set_seen(shown is self.ranking)

    def open(self, **what: Any) -> None:
        """``brake=path``: study that brake file."""
        if "brake" in what:
            path = Path(what["brake"])
            self.header.brake.setValue(path)
            self.state.open(path)

    def save_layout(self, settings: QSettings) -> None:
        """Remember files and splitters."""
        brake, other = self.header.brake.value(), self.header.other.value()
        settings.setValue("brake", "" if brake is None else str(brake))
        settings.setValue("other", "" if other is None else str(other))
        settings.setValue("split", self.split.saveState())
        settings.setValue("tab", self.tabs.currentIndex())
        self.locus.save_layout(settings)

    def restore_layout(self, settings: QSettings) -> None:
        """Files and splitters as they were left; files that are gone are forgotten."""
        for name in ("brake", "other"):
            path = Path(str(settings.value(name, "") or ""))
            if path.suffix == ".toml" and path.exists():
                setattr(self, f"_{name}", path)
        split = settings.value("split")
        if split is not None:
            self.split.restoreState(split)
        self.tabs.setCurrentIndex(int(str(settings.value("tab", 0))))
        self.locus.restore_layout(settings)

    def help_text(self) -> str:
        """What F1 shows."""
        return self.tr(
            "<b>Model</b><p>Where does the brake model become unstable, in which mode, and what would help? "
            "Move a slider: poles move along their paths. Right of the axis a mode grows: squeal.</p>"
            "<p>Click a pole or a row of the list, and the brake moves in that mode. "
            "The second tab shows the stable region with measured squeal in it, the third what to change.</p>"
            "<p>Keys: arrows and Page Up/Down move a slider, Tab goes on, type a number for an exact value. "
            "Right click on a picture: copy or save it.</p>"
        )

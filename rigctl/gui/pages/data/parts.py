"""The panes of the data page and how they lie: campaigns, table, and what is looked at.

Job: make them, the large view, the empty state. Not its job: news between them (`page`).
"""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QPushButton, QSplitter, QStackedWidget, QTabWidget, QVBoxLayout, QWidget

from rigctl.gui.pages.data.braking_pane import BrakingPane
from rigctl.gui.pages.data.campaign_pane import CampaignPane
from rigctl.gui.pages.data.compare_pane import ComparePane
from rigctl.gui.pages.data.empty import EmptyPane
from rigctl.gui.pages.data.export_bar import ExportBar
from rigctl.gui.pages.data.figures_pane import FiguresPane
from rigctl.gui.pages.data.table_pane import TablePane
from rigctl.gui.services import Services


class Parts(QStackedWidget):
    """Either the data, or what to do when there are none."""

    def __init__(self, services: Services) -> None:
        super().__init__()
        theme = services.theme
        self.campaigns = CampaignPane(theme)
        self.table = TablePane(theme)
        self.braking = BrakingPane(services)
        self.figures = FiguresPane(services)
        self.compare = ComparePane(services)
        self.export = ExportBar(services)
        self.empty = EmptyPane(theme)
        self.tabs = QTabWidget()
        self.tabs.setObjectName("data-tabs")
        self.tabs.setDocumentMode(True)
        self.tabs.addTab(self.braking, self.tr("Braking"))
        self.tabs.addTab(self.figures, self.tr("Figures"))
        self.tabs.addTab(self.compare, self.tr("Comparison"))
        self.large = QPushButton(self.tr("Large"))
        self.large.setObjectName("data-large")
        self.large.setCheckable(True)
        self.large.setToolTip(self.tr("Hide list and table (F11); Esc brings them back"))
        self.tabs.setCornerWidget(self.large)
        self._middle = QWidget()
        column = QVBoxLayout(self._middle)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.table, 1)
        column.addWidget(self.export)
        self.split = QSplitter(Qt.Orientation.Horizontal)
        for part, stretch in ((self.campaigns, 0), (self._middle, 4), (self.tabs, 5)):
            self.split.addWidget(part)
            self.split.setStretchFactor(self.split.count() - 1, stretch)
        self.split.setCollapsible(1, False)
        self.split.setSizes([theme.px(21), theme.px(59), theme.px(64)])
        self.addWidget(self.split)
        self.addWidget(self.empty)
        self.large.toggled.connect(self._on_large)

    def show_data(self, there: bool) -> None:
        """The data, or the way to the first braking."""
        self.setCurrentWidget(self.split if there else self.empty)

    def show_large(self, pane: QWidget) -> None:
        """One of the tabs over the whole page."""
        self.tabs.setCurrentWidget(pane)
        self.large.setChecked(True)

    def _on_large(self, large: bool) -> None:
        self.campaigns.setVisible(not large)
        self._middle.setVisible(not large)
        self.braking.set_wide(large)

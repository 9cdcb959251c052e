"""The campaigns of a folder, newest first.

Job: a list to choose from, another folder, open the folder, report. Not its job: brakings, building
reports.
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QListWidget, QListWidgetItem, QPushButton, QVBoxLayout, QWidget

from rigctl.gui.pages.data.campaigns import CampaignInfo
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.elided import ElidedLabel

_PATH = Qt.ItemDataRole.UserRole


class CampaignPane(QWidget):
    """`value()` is the chosen campaign."""

    valueChanged = Signal(object)
    """Path of the campaign that a person has chosen."""
    otherFolder = Signal()
    openFolder = Signal()
    openReport = Signal()
    buildReport = Signal()

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.setObjectName("data-campaigns-pane")
        self.folder = ElidedLabel()
        self.folder.setProperty("look", "muted")
        self.list = QListWidget()
        self.list.setObjectName("data-campaigns")
        self.list.setUniformItemSizes(True)
        self.list.setAlternatingRowColors(True)
        self.list.setTextElideMode(Qt.TextElideMode.ElideRight)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setToolTip(self.tr("Campaigns, newest first"))
        self.other = self._button(
            "other", self.tr("&Open folder…"), self.tr("A campaign, or a folder of them")
        )
        self.show_folder = self._button(
            "folder", self.tr("Show &files"), self.tr("The campaign in the file manager")
        )
        self.report = self._button("report", self.tr("Open re&port"), self.tr("The report in the browser"))
        self.build = self._button(
            "build", self.tr("Build report"), self.tr("As “rigctl report”; without excluded brakings")
        )
        self._column = QVBoxLayout(self)
        self._column.addWidget(self.folder)
        self._column.addWidget(self.list, 1)
        for button in (self.report, self.build, self.show_folder, self.other):
            self._column.addWidget(button)
        self._shown: dict[Path, CampaignInfo] = {}
        self.list.currentItemChanged.connect(self._on_current)
        self.other.clicked.connect(self.otherFolder)
        self.show_folder.clicked.connect(self.openFolder)
        self.report.clicked.connect(self.openReport)
        self.build.clicked.connect(self.buildReport)
        theme.changed.connect(self._restyle)
        self._restyle()
        self._enable()

    def _button(self, name: str, text: str, tip: str) -> QPushButton:
        button = QPushButton(text)
        button.setObjectName(f"data-{name}")
        button.setToolTip(tip)
        return button

    def _restyle(self) -> None:
        u = self._theme.px
        self._column.setContentsMargins(u(1), u(1), u(1), u(1))
        self._column.setSpacing(u(0.5))
        self.folder.setFont(self._theme.font("small"))
        self.setMinimumWidth(u(16))
        self.list.setStyleSheet(f"QListWidget::item {{ padding: {u(0.5)}px; }}")

    def value(self) -> Path | None:
        """The chosen campaign."""
        item = self.list.currentItem()
        return None if item is None else item.data(_PATH)

    def setValue(self, path: Path | None) -> bool:
        """Choose a campaign; False when it is not in the list."""
        for row in range(self.list.count()):
            if self.list.item(row).data(_PATH) == path:
                self.list.blockSignals(True)
                self.list.setCurrentRow(row)
                self.list.blockSignals(False)
                self._enable()
                return True
        return False

    def campaigns(self) -> list[CampaignInfo]:
        """What is shown."""
        return list(self._shown.values())

    def show_campaigns(self, folder: Path, campaigns: list[CampaignInfo]) -> None:
        """Another list; the chosen campaign stays chosen."""
        chosen = self.value()
        self._shown = {info.path: info for info in campaigns}
        self.folder.setText(folder.name)
        self.folder.setToolTip(str(folder))
        self.list.blockSignals(True)
        self.list.clear()
        for info in campaigns:
            item = QListWidgetItem(self._text(info))
            item.setData(_PATH, info.path)
            item.setToolTip(self._tip(info))
            self.list.addItem(item)
        self.list.blockSignals(False)
        if chosen is not None:
            self.setValue(chosen)
        self._enable()

    def set_building(self, building: bool) -> None:
        """While the report is built."""
        self.build.setEnabled(not building and self.value() is not None)
        self.build.setText(self.tr("Building …") if building else self.tr("Build report"))

    def _on_current(self) -> None:
        self._enable()
        self.valueChanged.emit(self.value())

    def _enable(self) -> None:
        path = self.value()
        for button in (self.show_folder, self.build):
            button.setEnabled(path is not None)
        self.report.setEnabled(path is not None and (path / "report" / "report.html").exists())

    def renew_buttons(self) -> None:
        """A report may have come into being."""
        self._enable()

    def _text(self, info: CampaignInfo) -> str:
        day = info.created[:10] or self.tr("no date")
        return f"{info.name}\n{day} · {info.brakings}"

    def _tip(self, info: CampaignInfo) -> str:
        count = self.tr("{0} brakings").format(info.brakings)
        started = f"{info.day_and_time} UTC" if info.created else ""
        lines = [str(info.path), started, count, info.program, info.rig]
        if info.simulated:
            lines.append(self.tr("simulated rig"))
        if info.problem:
            lines.append(self.tr("campaign.toml cannot be read: {0}").format(info.problem))
        return "\n".join(line for line in lines if line)

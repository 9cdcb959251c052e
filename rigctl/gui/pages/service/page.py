"""The Service page: devices, calibrations, alarms, journal, fault laboratory, settings of the window.

Job: the tabs, made when they are first shown. Not its job: what is in them.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import QSettings
from PySide6.QtWidgets import QTabWidget, QVBoxLayout, QWidget

from rigctl.gui.pages.base import Page
from rigctl.gui.pages.service.alarms_tab import AlarmsTab
from rigctl.gui.pages.service.calibrations_tab import CalibrationsTab
from rigctl.gui.pages.service.devices_tab import DevicesTab
from rigctl.gui.pages.service.journal_tab import JournalTab
from rigctl.gui.pages.service.laboratory_tab import LaboratoryTab
from rigctl.gui.pages.service.window_tab import WindowTab
from rigctl.gui.services import Services

DEVICES, CALIBRATIONS, ALARMS = "devices", "calibrations", "alarms"
JOURNAL, LABORATORY, WINDOW = "journal", "laboratory", "window"


class ServicePage(Page):
    """Six tabs."""

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self.devices = DevicesTab(services)
        self.calibrations = CalibrationsTab(services)
        self.alarms = AlarmsTab(services)
        self.journal = JournalTab(services)
        self.laboratory = LaboratoryTab(services)
        self.window_settings = WindowTab(services)
        self._parts: dict[str, Any] = {
            DEVICES: self.devices, CALIBRATIONS: self.calibrations, ALARMS: self.alarms,
            JOURNAL: self.journal, LABORATORY: self.laboratory, WINDOW: self.window_settings,
        }  # fmt: skip
        titles = {
            DEVICES: self.tr("&Devices"), CALIBRATIONS: self.tr("&Calibrations"),
            ALARMS: self.tr("&Alarms"), JOURNAL: self.tr("&Journal"),
            LABORATORY: self.tr("Fault &laboratory"), WINDOW: self.tr("&Window"),
        }  # fmt: skip
        self.tabs = QTabWidget()
        self.tabs.setObjectName("service-tabs")
        self.tabs.setDocumentMode(True)
        for name, part in self._parts.items():
            self.tabs.addTab(part, titles[name])
        layout = QVBoxLayout(self)
        unit = services.theme.px(1)
        layout.setContentsMargins(unit, unit, unit, unit)
        layout.addWidget(self.tabs)
        self._active: Any = None
        self.tabs.currentChanged.connect(lambda _index: self._switch())
        services.rig.attached.connect(self._show_laboratory)
        services.rig.detached.connect(self._show_laboratory)
        if services.alarms is not None:
            services.alarms.changed.connect(self._count_alarms)
        self._show_laboratory()
        self._count_alarms()

    # -- tabs ------------------------------------------------------------------------------------

    def tab(self) -> str:
        """Name of the tab that is shown."""
        shown = self.tabs.currentWidget()
        return next(name for name, part in self._parts.items() if part is shown)

    def show_tab(self, name: str) -> None:
        """Show a tab by its name."""
        part: QWidget | None = self._parts.get(name)
        if part is not None and self.tabs.isTabVisible(self.tabs.indexOf(part)):
            self.tabs.setCurrentWidget(part)

    def _switch(self) -> None:
        if not self.isVisible() and self._active is None:
            return
        if self._active is not None:
            self._active.deactivated()
        self._active = self.tabs.currentWidget()
        self._active.activated()

    def _show_laboratory(self, _session_or_why: Any = None) -> None:
        session = self.services.rig.session
        there = session is not None and session.simulated
        self.tabs.setTabVisible(self.tabs.indexOf(self.laboratory), there)

    def _count_alarms(self) -> None:
        count = 0 if self.services.alarms is None else self.services.alarms.open_count
        text = self.tr("&Alarms ({0})").format(count) if count else self.tr("&Alarms")
        self.tabs.setTabText(self.tabs.indexOf(self.alarms), text)

    # -- page ------------------------------------------------------------------------------------

    def activated(self) -> None:
        """See `Page`."""
        self._active = self.tabs.currentWidget()
        self._active.activated()

    def deactivated(self) -> None:
        """See `Page`."""
        if self._active is not None:
            self._active.deactivated()
            self._active = None

    def open(self, **what: Any) -> None:
        """``tab="alarms"``; ``campaign=path`` shows its journal."""
        campaign = what.get("campaign")
        if campaign is not None:
            self.journal.open_campaign(Path(campaign))
            self.show_tab(JOURNAL)
        else:
            self.show_tab(str(what.get("tab", "")))

    def unsaved(self) -> list[str]:
        """See `Page`."""
        return self.calibrations.unsaved()

    def save_layout(self, settings: QSettings) -> None:
        """See `Page`."""
        settings.setValue("tab", self.tab())
        settings.setValue("journal", self.journal.splitter.saveState())

    def restore_layout(self, settings: QSettings) -> None:
        """See `Page`."""
        self.show_tab(str(settings.value("tab", "")))
        state = settings.value("journal")
        if state is not None:
            self.journal.splitter.restoreState(state)

    def closeEvent(self, event: Any) -> None:
        """Nothing goes on after the page."""
        self.closing()
        super().closeEvent(event)

    def closing(self) -> None:
        """End a device test, a procedure, the laboratory's client."""
        self.deactivated()
        self.devices.stop()
        self.calibrations.stop()
        self.laboratory.stop()

    def help_text(self) -> str:
        """See `Page`."""
        return self.tr(
            "<b>Service</b><p><b>Devices</b>: who they are, newest values, settings that are unsafe.<br>"
            "<b>Calibrations</b>: torque by lever and weights, microphone by calibrator, emissivity by "
            "contact thermometer; a saved one holds from the next start of the rig.<br>"
            "<b>Alarms</b>: what needs a person, with what to do; acknowledging is journaled.<br>"
            "<b>Journal</b>: everything that happened, searched by words, process and kind.<br>"
            "<b>Fault laboratory</b>: make things go wrong on a simulated rig.<br>"
            "<b>Window</b>: language, look, size of text, data folder.</p>"
            "<p>Ctrl+Tab next tab · Enter takes a reading or acknowledges · Esc leaves a calibration</p>"
        )

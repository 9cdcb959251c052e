"""The Service page: devices, calibrations, alarms, journal, fault laboratory, settings of the window.

Job: the tabs, made when they are first shown. Not its job: what is in them.
"""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QSettings
from PySide6.QtWidgets import QTabWidget, QVBoxLayout, QWidget

from rigctl.gui.pages.base import Page
from rigctl.gui.pages.service.live_session import LiveSession
from rigctl.gui.services import Services

if TYPE_CHECKING:
    from rigctl.gui.pages.service.alarms_tab import AlarmsTab
    from rigctl.gui.pages.service.calibrations_tab import CalibrationsTab
    from rigctl.gui.pages.service.devices_tab import DevicesTab
    from rigctl.gui.pages.service.journal_tab import JournalTab
    from rigctl.gui.pages.service.laboratory_tab import LaboratoryTab
    from rigctl.gui.pages.service.window_tab import WindowTab

DEVICES, CALIBRATIONS, ALARMS = "devices", "calibrations", "alarms"
JOURNAL, LABORATORY, WINDOW = "journal", "laboratory", "window"
_PACKAGE = "rigctl.gui.pages.service"


class ServicePage(Page):
    """Six tabs; each is loaded and built when it is first shown, so that none makes the window wait."""

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        self.live = LiveSession(services.rig, self)
        self._built: dict[str, Any] = {}
        self._journal_state: Any = None
        titles = {
            DEVICES: self.tr("&Devices"), CALIBRATIONS: self.tr("&Calibrations"),
            ALARMS: self.tr("&Alarms"), JOURNAL: self.tr("&Journal"),
            LABORATORY: self.tr("Fault &laboratory"), WINDOW: self.tr("&Window"),
        }  # fmt: skip
        self.tabs = QTabWidget()
        self.tabs.setObjectName("service-tabs")
        self.tabs.setDocumentMode(True)
        self._holders: dict[str, QWidget] = {}
        for name, title in titles.items():
            holder = QWidget()
            QVBoxLayout(holder).setContentsMargins(0, 0, 0, 0)
            self._holders[name] = holder
            self.tabs.addTab(holder, title)
        layout = QVBoxLayout(self)
        unit = services.theme.px(1)
        layout.setContentsMargins(unit, unit, unit, unit)
        layout.addWidget(self.tabs)
        self._active: Any = None
        self.tabs.currentChanged.connect(self._switch)
        self.live.began.connect(self._show_laboratory)
        self.live.ended.connect(self._show_laboratory)
        if services.alarms is not None:
            services.alarms.changed.connect(self._count_alarms)
        self._show_laboratory()
        self._count_alarms()

    # -- tabs ------------------------------------------------------------------------------------

    @property
    def devices(self) -> DevicesTab:
        """The tab, built when it is first asked for."""
        return self._part(DEVICES, "devices_tab:DevicesTab", self.live)

    @property
    def calibrations(self) -> CalibrationsTab:
        """See `devices`."""
        return self._part(CALIBRATIONS, "calibrations_tab:CalibrationsTab", self.live)

    @property
    def alarms(self) -> AlarmsTab:
        """See `devices`."""
        return self._part(ALARMS, "alarms_tab:AlarmsTab")

    @property
    def journal(self) -> JournalTab:
        """See `devices`."""
        new = JOURNAL not in self._built
        tab = self._part(JOURNAL, "journal_tab:JournalTab", self.live)
        if new and self._journal_state is not None:
            tab.splitter.restoreState(self._journal_state)
        return tab

    @property
    def laboratory(self) -> LaboratoryTab:
        """See `devices`."""
        return self._part(LABORATORY, "laboratory_tab:LaboratoryTab", self.live)

    @property
    def window_settings(self) -> WindowTab:
        """See `devices`."""
        return self._part(WINDOW, "window_tab:WindowTab")

    def _part(self, name: str, target: str, *further: Any) -> Any:
        if name not in self._built:
            module, _, kind = target.partition(":")
            part = getattr(importlib.import_module(f"{_PACKAGE}.{module}"), kind)(self.services, *further)
            self._built[name] = part
            layout = self._holders[name].layout()
            assert layout is not None
            layout.addWidget(part)
        return self._built[name]

    def tab(self) -> str:
        """Name of the tab that is shown."""
        shown = self.tabs.currentWidget()
        return next(name for name, holder in self._holders.items() if holder is shown)

    def tab_index(self, name: str) -> int:
        """Place of a tab."""
        return self.tabs.indexOf(self._holders[name])

    def show_tab(self, name: str) -> None:
        """Show a tab by its name."""
        if name in self._holders and self.tabs.isTabVisible(self.tab_index(name)):
            self.tabs.setCurrentWidget(self._holders[name])

    def _shown_part(self) -> Any:
        name = self.tab()
        return getattr(self, "window_settings" if name == WINDOW else name)

    def _switch(self, _index: int = 0) -> None:
        if not self.isVisible() and self._active is None:
            return
        if self._active is not None:
            self._active.deactivated()
        self._active = self._shown_part()
        self._active.activated()

    def _show_laboratory(self, _session: Any = None) -> None:
        session = self.live.session
        there = session is not None and session.simulated
        self.tabs.setTabVisible(self.tab_index(LABORATORY), there)

    def _count_alarms(self) -> None:
        count = 0 if self.services.alarms is None else self.services.alarms.open_count
        text = self.tr("&Alarms ({0})").format(count) if count else self.tr("&Alarms")
        self.tabs.setTabText(self.tab_index(ALARMS), text)

    # -- page ------------------------------------------------------------------------------------

    def activated(self) -> None:
        """See `Page`."""
        self._active = self._shown_part()
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
        return self.calibrations.unsaved() if CALIBRATIONS in self._built else []

    def save_layout(self, settings: QSettings) -> None:
        """See `Page`."""
        settings.setValue("tab", self.tab())
        if JOURNAL in self._built:
            settings.setValue("journal", self.journal.splitter.saveState())

    def restore_layout(self, settings: QSettings) -> None:
        """See `Page`."""
        self.show_tab(str(settings.value("tab", "")))
        self._journal_state = settings.value("journal")

    def closeEvent(self, event: Any) -> None:
        """Nothing goes on after the page."""
        self.closing()
        super().closeEvent(event)

    def closing(self) -> None:
        """End a device test, a procedure, the laboratory's client."""
        self.deactivated()
        for name in (DEVICES, CALIBRATIONS, LABORATORY):
            if name in self._built:
                self._built[name].stop()

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

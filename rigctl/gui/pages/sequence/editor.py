"""Middle of the page: one sequence, its head and its sections, each with what is wrong in it.

Job: `value()` and `setValue()` of a `SequenceForm`; faults at their fields and as marks on the tabs; the
way to a field. Not its job: judging, keeping (`draft`).
"""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QResizeEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QGridLayout,
    QLabel,
    QScrollArea,
    QTabWidget,
    QVBoxLayout,
    QWidget,
)

from rigctl.config.rig import RigConfig
from rigctl.gui.pages.sequence.checking import Fault
from rigctl.gui.pages.sequence.forms import ROLES, SequenceForm
from rigctl.gui.pages.sequence.orders import SetpointsSection
from rigctl.gui.pages.sequence.pressure_section import PressureSection
from rigctl.gui.pages.sequence.recording_section import RecordingSection
from rigctl.gui.pages.sequence.section import Faults, Section, choose, fault_text
from rigctl.gui.pages.sequence.temperature_section import TemperatureSection
from rigctl.gui.pages.sequence.words import name_of
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.field_grid import FaultLabel, PlainEdit, set_wrong

TALL_UNITS = 92
"""Height in grid units from which set-points and tabs stand above each other."""
_HEAD = ("name", "role", "repeat", "enabled")


class _Head(QWidget):
    """Name, role, repetition, on or off: one line."""

    changed = Signal(str, bool)

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self.name, self.repeat = PlainEdit(), PlainEdit()
        self.name.setToolTip(self.tr("Name of the sequence; the data are filed under it"))
        self.repeat.setToolTip(self.tr("How many times the whole sequence is run"))
        self.repeat.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.role = QComboBox()
        self.role.setToolTip(self.tr("What the brakings are for; the evaluation looks at it"))
        self.role.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.role.setMinimumContentsLength(6)
        for role in ROLES:
            self.role.addItem(name_of(role), role)
        self.enabled = QCheckBox(self.tr("run it"))
        self.enabled.setToolTip(
            self.tr("A sequence that is off stays in the program and is left out of the run")
        )
        self.name.textEdited.connect(lambda _t: self.changed.emit("name", True))
        self.repeat.textEdited.connect(lambda _t: self.changed.emit("repeat", True))
        self.role.activated.connect(lambda _i: self.changed.emit("role", False))
        self.enabled.toggled.connect(lambda _on: self.changed.emit("enabled", False))
        self.fault = FaultLabel(theme)
        self._grid = QGridLayout(self)
        self._grid.setContentsMargins(0, 0, 0, 0)
        for column, (text, widget) in enumerate(
            (
                (self.tr("&Name"), self.name),
                (self.tr("Ro&le"), self.role),
                (self.tr("&Repeat"), self.repeat),
                ("", self.enabled),
            )
        ):
            label = QLabel(text)
            label.setProperty("look", "muted")
            label.setBuddy(widget)
            widget.setAccessibleName(text.replace("&", "") or self.tr("Run it"))
            self._grid.addWidget(label, 0, column)
            self._grid.addWidget(widget, 1, column)
        for place, widget in zip(_HEAD, (self.name, self.role, self.repeat, self.enabled), strict=True):
            widget.setObjectName(f"field-{place}")
        self._grid.addWidget(self.fault, 2, 0, 1, 4)
        self._grid.setColumnStretch(0, 1)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self._grid.setHorizontalSpacing(self._theme.px(1.5))
        self._grid.setVerticalSpacing(self._theme.px(0.25))
        self.name.setMinimumWidth(self._theme.px(9))
        self.repeat.setFixedWidth(self._theme.px(7))

    def show_faults(self, faults: Faults) -> None:
        """Below the line, in words."""
        found = [fault for place in _HEAD for fault in faults.get(place, [])]
        self.fault.setFault(*(fault_text(found) if found else ("", "error")))
        set_wrong(self.name, "error" if faults.get("name") else "")
        set_wrong(self.repeat, "error" if faults.get("repeat") else "")


class SequenceEditor(QWidget):
    """Editor of one sequence."""

    valueChanged = Signal(str, bool)
    """(place, typed)."""
    ordersAsked = Signal()

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._form = SequenceForm(name="")
        self._faults: Faults = {}
        self.head = _Head(theme)
        self.setpoints = SetpointsSection(theme)
        self.pressure = PressureSection(theme)
        self.temperature = TemperatureSection(theme)
        self.recording = RecordingSection(theme)
        self._sections: tuple[tuple[Section, str], ...] = (
            (self.setpoints, self.tr("Set-points")),
            (self.pressure, self.tr("Pressure course")),
            (self.temperature, self.tr("Conditioning")),
            (self.recording, self.tr("Recording")),
        )
        self.tabs = QTabWidget()
        self.tabs.setObjectName("sequence-tabs")
        self.tabs.setDocumentMode(True)
        self._areas: list[QScrollArea] = []
        self._pinned = False
        for section, title in self._sections:
            area = QScrollArea()
            area.setWidgetResizable(True)
            area.setFrameShape(QScrollArea.Shape.NoFrame)
            area.setWidget(section)
            area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
            self._areas.append(area)
            self.tabs.addTab(area, title)
            section.valueChanged.connect(self._on_changed)
        self.head.changed.connect(self._on_changed)
        self.setpoints.ordersAsked.connect(self.ordersAsked)
        self._layout = QVBoxLayout(self)
        self._layout.addWidget(self.head)
        self._layout.addWidget(self.tabs, 4)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        unit = self._theme.px(1)
        self._layout.setContentsMargins(unit, unit, unit, unit)
        self._layout.setSpacing(unit)
        for section, _ in self._sections:
            layout = section.layout()
            if layout is not None:
                layout.setContentsMargins(0, round(1.5 * unit), 0, 0)

    def resizeEvent(self, event: QResizeEvent) -> None:
        """In a tall window the set-points stand above the tabs, always in sight."""
        super().resizeEvent(event)
        self.temperature.show_width(self.width())
        self._pin(self.height() >= self._theme.px(TALL_UNITS))

    def _pin(self, pinned: bool) -> None:
        if pinned == self._pinned:
            return
        self._pinned = pinned
        area = self._areas[0]
        if pinned:
            self.tabs.removeTab(0)
            self._layout.insertWidget(1, area, 6)
            area.show()
        else:
            self._layout.removeWidget(area)
            self.tabs.insertTab(0, area, "")
            self.tabs.setCurrentIndex(0)
        self._mark_tabs()

    def value(self) -> SequenceForm:
        """What is shown."""
        form = replace(
            self._form,
            name=self.head.name.text(),
            role=self.head.role.currentData(),
            repeat=self.head.repeat.text(),
            enabled=self.head.enabled.isChecked(),
        )
        for section, _ in self._sections:
            form = section.value(form)
        return form

    def setValue(self, form: SequenceForm) -> None:
        """Show a sequence; not an edit."""
        if form.uid != self._form.uid:
            self.setpoints.orders.hide()
        self._form = form
        self.head.name.setValue(form.name)
        self.head.repeat.setValue(form.repeat)
        choose(self.head.role, form.role)
        self.head.enabled.blockSignals(True)
        self.head.enabled.setChecked(form.enabled)
        self.head.enabled.blockSignals(False)
        for section, _ in self._sections:
            section.setValue(form)

    def _on_changed(self, place: str, typed: bool) -> None:
        self.valueChanged.emit(place, typed)

    def show_rig(self, rig: RigConfig | None) -> None:
        """Take limits and channels of the rig."""
        for section, _ in self._sections:
            section.show_rig(rig)
        self.recording.setValue(self._form)

    def show_faults(self, faults: list[Fault]) -> None:
        """Faults of this sequence: at the fields, and how many on each tab."""
        by_place: Faults = {}
        for fault in faults:
            by_place.setdefault(fault.place, []).append(fault)
        self.head.show_faults(by_place)
        for section, _ in self._sections:
            section.show_faults(by_place)
        self._faults = by_place
        self._mark_tabs()

    def _mark_tabs(self) -> None:
        for (section, title), area in zip(self._sections, self._areas, strict=True):
            number = self.tabs.indexOf(area)
            if number < 0:
                continue
            found = [fault for place in section.places for fault in self._faults.get(place, [])]
            errors = sum(fault.severity == "error" for fault in found)
            mark = f"  ✕ {errors}" if errors else ("  ▲" if found else "")
            self.tabs.setTabText(number, title + mark)
            self.tabs.setTabToolTip(number, "\n".join(fault.text for fault in found))

    def focus(self, place: str) -> None:
        """Show the tab with that field and bring the keyboard to it."""
        if place in _HEAD:
            getattr(self.head, place).setFocus(Qt.FocusReason.OtherFocusReason)
            return
        for (section, _), area in zip(self._sections, self._areas, strict=True):
            if place in section.places:
                if self.tabs.indexOf(area) >= 0:
                    self.tabs.setCurrentWidget(area)
                section.focus(place)

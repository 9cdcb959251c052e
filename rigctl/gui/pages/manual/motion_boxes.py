"""Controls of the motor and of the disc's temperature: next to what they move.

Job: fields with limits, [Set], [Stop motor], ventilator, conditioning; signals say what was ordered. Not
their job: whether it is allowed (`model`), doing it (page).
"""

from __future__ import annotations

import math

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QGridLayout, QGroupBox, QLabel, QPushButton, QWidget

from rigctl.gui.pages.manual.model import Action, ManualModel, Permission
from rigctl.gui.rig.state import RigState
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.entries import NumberRange
from rigctl.gui.widgets.value_field import ValueField


def labelled(text: str, field: QWidget) -> QLabel:
    """A label whose mnemonic leads to the field."""
    label = QLabel(text)
    label.setBuddy(field)
    if isinstance(field, ValueField):  # stays beside the field when an error stands below it
        label.setMinimumHeight(field.edit.sizeHint().height())
        label.setAlignment(Qt.AlignmentFlag.AlignVCenter)
    return label


def permit(button: QWidget, permission: Permission, tip: str) -> None:
    """Enable or disable a button; its tip says what it does, or why it cannot be used."""
    button.setEnabled(permission.allowed)
    button.setToolTip(tip if permission.allowed else f"{tip}\n{permission.reason}")


class ControlBox(QGroupBox):
    """A titled group with a grid on the 8 px raster."""

    def __init__(self, theme: ThemeKeeper, title: str, name: str) -> None:
        super().__init__(title)
        self.setObjectName(name)
        self._theme = theme
        self.grid = QGridLayout(self)
        self.grid.setColumnStretch(1, 1)
        theme.changed.connect(self._respace)
        self._respace()

    def _respace(self) -> None:
        self.grid.setHorizontalSpacing(self._theme.px(1))
        self.grid.setVerticalSpacing(self._theme.px(1))
        self.grid.setContentsMargins(*(self._theme.px(1),) * 4)

    def button(self, name: str, text: str) -> QPushButton:
        """A named button."""
        made = QPushButton(text)
        made.setObjectName(name)
        return made

    def name(self, text: str, field: QWidget, row: int) -> QLabel:
        """The name of a field, at the top of its row."""
        label = labelled(text, field)
        self.grid.addWidget(label, row, 0, Qt.AlignmentFlag.AlignTop)
        return label


class SpeedBox(ControlBox):
    """Speed and ramp."""

    ordered = Signal(float, float)
    stopAsked = Signal()
    changed = Signal()
    refused = Signal(str)

    def __init__(self, theme: ThemeKeeper, ranges: dict[str, NumberRange]) -> None:
        super().__init__(theme, self.tr("Motor"), "box-motor")
        self.speed = ValueField(theme, ranges["speed"], 100.0)
        self.speed.setObjectName("speed")
        self.speed.setToolTip(self.tr("Speed of the disc. Enter applies; blue is the commanded speed."))
        self.ramp = ValueField(theme, ranges["ramp"], ranges["ramp"].high)
        self.ramp.setObjectName("ramp")
        self.ramp.setToolTip(self.tr("How fast the speed changes"))
        self.set = self.button("set-speed", self.tr("Set speed"))
        self.stop = self.button("stop-motor", self.tr("Stop &motor"))
        self.name(self.tr("&Speed"), self.speed, 0)
        self.grid.addWidget(self.speed, 0, 1, 1, 2)
        self.name(self.tr("Ramp"), self.ramp, 1)
        self.grid.addWidget(self.ramp, 1, 1, 1, 2)
        self.grid.addWidget(self.set, 2, 1)
        self.grid.addWidget(self.stop, 2, 2)
        self._permission = Permission(False)
        for field in (self.speed, self.ramp):
            field.committed.connect(self._order)
            field.valueChanged.connect(self.changed)
            field.edited.connect(self.changed)
        self.set.clicked.connect(self._order)
        self.stop.clicked.connect(self.stopAsked)

    def setRanges(self, ranges: dict[str, NumberRange]) -> None:
        """Limits of another rig."""
        self.speed.setLimits(ranges["speed"])
        self.ramp.setLimits(ranges["ramp"])
        value = self.ramp.value()
        if value is None or value > ranges["ramp"].high:
            self.ramp.setValue(ranges["ramp"].high)

    def show_state(self, state: RigState, model: ManualModel) -> None:
        """Set-point in force, and what may be done."""
        value = state.readings.set_speed_rpm
        self.speed.setInForce(value if math.isfinite(value) and model.live_energy else None)
        self._permission = model.may(Action.SPEED)
        permit(self.set, self._permission, self.tr("Go to this speed along the ramp (Enter)"))
        permit(self.stop, model.may(Action.STOP_MOTOR), self.tr("Go to 0 1/min with the fastest ramp"))

    def value(self) -> tuple[float, float] | None:
        """(speed, ramp); None while a field is refused."""
        speed, ramp = self.speed.value(), self.ramp.value()
        return None if speed is None or ramp is None else (speed, ramp)

    def _order(self, _value: object = None) -> None:
        value = self.value()
        if not self._permission.allowed:
            self.refused.emit(self._permission.reason)
        elif value is not None:
            self.ordered.emit(*value)


class DiscBox(ControlBox):
    """Disc temperature and cooling air."""

    conditionOrdered = Signal(float)
    ventilatorOrdered = Signal(float)
    refused = Signal(str)

    def __init__(self, theme: ThemeKeeper, ranges: dict[str, NumberRange]) -> None:
        super().__init__(theme, self.tr("Disc temperature"), "box-disc")
        self.temperature = ValueField(theme, ranges["temperature"], 100.0)
        self.temperature.setObjectName("temperature")
        self.temperature.setToolTip(self.tr("Temperature that the disc is brought to"))
        self.condition = self.button("condition", self.tr("&Heat or cool"))
        self.air = ValueField(theme, ranges["ventilator"], ranges["ventilator"].high)
        self.air.setObjectName("air")
        self.air.setToolTip(self.tr("Cooling air"))
        self.blow = self.button("set-air", self.tr("&Blow"))
        self.still = self.button("air-off", self.tr("Air off"))
        self.name(self.tr("Temp."), self.temperature, 0)
        self.grid.addWidget(self.temperature, 0, 1)
        self.grid.addWidget(self.condition, 0, 2)
        self.name(self.tr("&Air"), self.air, 1)
        self.grid.addWidget(self.air, 1, 1, 1, 2)
        self.grid.addWidget(self.blow, 2, 1)
        self.grid.addWidget(self.still, 2, 2)
        self._may_condition = self._may_blow = Permission(False)
        self.temperature.committed.connect(self._order_condition)
        self.condition.clicked.connect(self._order_condition)
        self.air.committed.connect(self._order_air)
        self.blow.clicked.connect(self._order_air)
        self.still.clicked.connect(lambda: self.ventilatorOrdered.emit(0.0))

    def setRanges(self, ranges: dict[str, NumberRange]) -> None:
        """Limits of another rig."""
        self.temperature.setLimits(ranges["temperature"])
        self.air.setLimits(ranges["ventilator"])
        value = self.air.value()
        if value is None or value > ranges["ventilator"].high:
            self.air.setValue(ranges["ventilator"].high)

    def show_state(self, state: RigState, model: ManualModel) -> None:
        """Air in force, what the rig does, and what may be done."""
        flow = state.readings.ventilator_m3_h
        self.air.setInForce(flow if math.isfinite(flow) else None)
        self._may_condition, self._may_blow = model.may(Action.CONDITION), model.may(Action.VENTILATOR)
        permit(
            self.condition, self._may_condition,
            self.tr("Drags the brake to heat the disc, or blows air to cool it; any other order ends it"),
        )  # fmt: skip
        permit(self.blow, self._may_blow, self.tr("Blow this much cooling air (Enter)"))
        permit(self.still, self._may_blow, self.tr("Stop the ventilator"))

    def _order_condition(self, _value: object = None) -> None:
        value = self.temperature.value()
        if not self._may_condition.allowed:
            self.refused.emit(self._may_condition.reason)
        elif value is not None:
            self.conditionOrdered.emit(value)

    def _order_air(self, _value: object = None) -> None:
        value = self.air.value()
        if not self._may_blow.allowed:
            self.refused.emit(self._may_blow.reason)
        elif value is not None:
            self.ventilatorOrdered.emit(value)

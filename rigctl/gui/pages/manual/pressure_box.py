"""Controls of the brake: constant pressure or a course over time, with a preview.

Job: fields for each kind of course, the reason when the rig cannot do it, a drawing. Not its job: what the
rig can do (`orders`), whether it is allowed now (`model`), doing it (page).
"""

from __future__ import annotations

import math

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QComboBox, QLabel, QLineEdit

from rigctl.gui.pages.manual.model import Action, ManualModel, Permission
from rigctl.gui.pages.manual.motion_boxes import ControlBox, permit
from rigctl.gui.pages.manual.orders import KINDS, PressureEntry, PressureOrder
from rigctl.gui.rig.state import RigState
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.course_preview import CoursePreview
from rigctl.gui.widgets.entries import NumberRange, numbers_in
from rigctl.gui.widgets.value_field import ValueField
from sequences.capabilities import RigCapabilities

_FIELDS = {
    "constant": ("pressure",),
    "ramp": ("from", "to", "duration"),
    "sine": ("pressure", "amplitude", "frequency", "duration"),
    "triangle": ("pressure", "amplitude", "frequency", "duration"),
    "steps": ("pressure", "steps", "duration"),
}


class PressureBox(ControlBox):
    """One pressure order. `order()` is None while a field is refused or the rig cannot do it."""

    ordered = Signal(object)
    changed = Signal()
    refused = Signal(str)

    def __init__(self, theme: ThemeKeeper, ranges: dict[str, NumberRange]) -> None:
        super().__init__(theme, self.tr("Brake"), "box-brake")
        self.kind = QComboBox()
        self.kind.setObjectName("pressure-kind")
        self.kind.setToolTip(self.tr("Course of the pressure over time"))
        names = (
            self.tr("constant"), self.tr("ramp"), self.tr("sine"), self.tr("triangle"), self.tr("steps"),
        )  # fmt: skip
        for kind, name in zip(KINDS, names, strict=True):
            self.kind.addItem(name, kind)
        self._fields = {
            "pressure": self._field(ranges["pressure"], 10.0, "pressure"),
            "from": self._field(ranges["pressure"], 2.0, "pressure-from"),
            "to": self._field(ranges["pressure"], 20.0, "pressure-to"),
            "amplitude": self._field(ranges["amplitude"], 2.0, "amplitude"),
            "frequency": self._field(ranges["frequency"], 0.5, "frequency"),
            "duration": self._field(ranges["duration"], 10.0, "course-duration"),
        }
        self.steps = QLineEdit("0 5 10")
        self.steps.setObjectName("steps")
        self.steps.setToolTip(
            self.tr(
                "Offsets from the pressure in bar, separated by blanks; each for an equal share of the time"
            )
        )
        self._capabilities: RigCapabilities | None = None
        self._speed_rpm = 0.0
        self._permission = Permission(False)
        self._build()
        self.kind.currentIndexChanged.connect(self._on_kind)
        self.steps.textChanged.connect(self._on_changed)
        self.steps.returnPressed.connect(self._order)
        self.apply.clicked.connect(self._order)
        self._on_kind()

    def _field(self, limits: NumberRange, value: float, name: str) -> ValueField:
        field = ValueField(self._theme, limits, value)
        field.setObjectName(name)
        field.valueChanged.connect(self._on_changed)
        field.edited.connect(self._on_changed)
        field.committed.connect(self._order)
        return field

    def _build(self) -> None:
        labels = {
            "pressure": self.tr("P&ressure"),
            "from": self.tr("From"),
            "to": self.tr("To"),
            "amplitude": self.tr("Amplitude"),
            "frequency": self.tr("Frequency"),
            "steps": self.tr("Steps"),
            "duration": self.tr("Time"),
        }
        tips = {
            "pressure": self.tr("Pressure, or the mean of a course. Enter applies; blue is commanded."),
            "from": self.tr("Pressure at the beginning of the ramp"),
            "to": self.tr("Pressure at the end of the ramp"),
            "amplitude": self.tr("How far the pressure swings around its mean"),
            "frequency": self.tr("Swings per second"),
            "duration": self.tr("How long the course takes; the pressure is released after it"),
        }
        self.name(self.tr("C&ourse"), self.kind, 0).setMinimumHeight(self.kind.sizeHint().height())
        self.grid.addWidget(self.kind, 0, 1)
        self._rows: dict[str, list] = {}
        for row, (key, label) in enumerate(labels.items(), start=1):
            widget = self.steps if key == "steps" else self._fields[key]
            if key in tips:
                widget.setToolTip(tips[key])
            name = self.name(label, widget, row)
            self.grid.addWidget(widget, row, 1, 1, 2)
            self._rows[key] = [name, widget]
        self.preview = CoursePreview(self._theme, "bar")
        self.preview.setObjectName("course-preview")
        self.preview.setToolTip(self.tr("Set-points over time; dashed: the rig's limit"))
        self.problem = QLabel()
        self.problem.setObjectName("pressure-problem")
        self.problem.setWordWrap(True)
        self.apply = self.button("set-pressure", self.tr("App&ly pressure"))
        self.grid.addWidget(self.preview, 8, 0, 1, 3)
        self.grid.addWidget(self.problem, 9, 0, 1, 3)
        self.grid.addWidget(self.apply, 10, 1, 1, 2)

    # -- value ------------------------------------------------------------------------------------

    def entry(self) -> PressureEntry:
        """The numbers in the fields."""
        value = {key: field.value() for key, field in self._fields.items()}
        return PressureEntry(
            kind=str(self.kind.currentData()),
            pressure_bar=value["pressure"],
            from_bar=value["from"],
            to_bar=value["to"],
            amplitude_bar=value["amplitude"],
            frequency_hz=value["frequency"],
            steps_bar=numbers_in(self.steps.text()),
            duration_s=value["duration"],
        )

    def setEntry(self, entry: PressureEntry) -> None:
        """Fill the fields."""
        for key, number in (
            ("pressure", entry.pressure_bar), ("from", entry.from_bar), ("to", entry.to_bar),
            ("amplitude", entry.amplitude_bar), ("frequency", entry.frequency_hz),
            ("duration", entry.duration_s),
        ):  # fmt: skip
            if number is not None:
                self._fields[key].setValue(number)
        if entry.steps_bar is not None:
            self.steps.setText(" ".join(f"{step:g}" for step in entry.steps_bar))
        self.kind.setCurrentIndex(self.kind.findData(entry.kind))

    def field(self, key: str) -> ValueField:
        """One of the number fields."""
        return self._fields[key]

    def order(self) -> PressureOrder | None:
        """What would be ordered now; None when it cannot."""
        order = self.entry().order()
        if order is None or self._capabilities is None:
            return order
        return None if order.problem(self._capabilities, self._speed_rpm) else order

    def setContext(self, capabilities: RigCapabilities | None, speed_rpm: float) -> None:
        """What the rig can do, and at which speed the brake will be applied."""
        if (capabilities, speed_rpm) != (self._capabilities, self._speed_rpm):
            self._capabilities, self._speed_rpm = capabilities, speed_rpm
            self._on_changed()

    def setRanges(self, ranges: dict[str, NumberRange]) -> None:
        """Limits of another rig."""
        for key, field in self._fields.items():
            field.setLimits(ranges["pressure" if key in ("from", "to") else key])
        self._on_changed()

    def show_state(self, state: RigState, model: ManualModel) -> None:
        """Set-point in force, and what may be done."""
        value = state.readings.set_pressure_bar
        in_force = value if math.isfinite(value) and model.live_energy else None
        self._fields["pressure"].setInForce(in_force)
        self._fields["to"].setInForce(in_force)
        self._permission = model.may(Action.PRESSURE)
        self._permit()

    # -- what a person does -----------------------------------------------------------------------

    def _on_kind(self) -> None:
        wanted = _FIELDS[str(self.kind.currentData())]
        for key, widgets in self._rows.items():
            for widget in widgets:
                widget.setVisible(key in wanted)
        self.preview.setVisible(wanted != ("pressure",))
        self._on_changed()

    def _on_changed(self, _value: object = None) -> None:
        entry = self.entry()
        order = entry.order()
        problem, look = "", "error"
        if entry.kind == "steps" and entry.steps_bar is None:
            problem = self.tr("Steps are numbers separated by blanks, e.g. 0 5 10.")
        elif order is not None and self._capabilities is not None:
            problem = order.problem(self._capabilities, self._speed_rpm)
            if not problem:
                problem = order.load_problem(self._capabilities, self._speed_rpm)
                look = "warning"
        self._show_problem(problem, look)
        limit = None if self._capabilities is None else self._capabilities.max_pressure_bar
        self.preview.setValue([] if order is None else order.course(), limit)
        self._permit()
        self.changed.emit()

    def _show_problem(self, problem: str, look: str) -> None:
        self.problem.setText("▲ " + problem if problem else "")
        self.problem.setVisible(bool(problem))
        if self.problem.property("look") != look:
            self.problem.setProperty("look", look)
            self.problem.style().polish(self.problem)

    def _permit(self) -> None:
        tip = self.tr("Apply the brake with this pressure (Enter)")
        allowed = self._permission
        if allowed.allowed and self.order() is None:
            allowed = Permission(False, self.tr("Mend the entry first."))
        permit(self.apply, allowed, tip)

    def _order(self, _value: object = None) -> None:
        order = self.order()
        if not self._permission.allowed:
            self.refused.emit(self._permission.reason)
        elif order is not None:
            self.ordered.emit(order)

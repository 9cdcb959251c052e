"""Section "Pressure": what the brake pressure does during a braking, with a drawing of it.

Not its job: the functions themselves (`sequences.pressure`).
"""

from __future__ import annotations

from dataclasses import replace

from pydantic import TypeAdapter, ValidationError
from PySide6.QtWidgets import QLabel, QSizePolicy, QVBoxLayout

from rigctl.config.rig import RigConfig
from rigctl.gui.pages.sequence.checking import judge
from rigctl.gui.pages.sequence.forecast import braking_times
from rigctl.gui.pages.sequence.forms import KINDS, FunctionForm, SequenceForm, function_mapping
from rigctl.gui.pages.sequence.paste import parse_number
from rigctl.gui.pages.sequence.section import Faults, Section, choose, show_in_grid
from rigctl.gui.pages.sequence.words import name_of
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.course_preview import CoursePreview
from rigctl.gui.widgets.field_grid import FieldGrid
from sequences.matrix import brakings
from sequences.pressure import PressureFunction

_FUNCTION: TypeAdapter[PressureFunction] = TypeAdapter(PressureFunction)
_USED = {
    "amplitude_bar": ("ramp", "sine", "triangle"),
    "frequency_hz": ("sine", "triangle"),
    "direction": ("ramp",),
    "steps_bar": ("steps",),
}


class PressureSection(Section):
    """Kind, its numbers, rise time, drawing."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__(theme)
        self._limit: float | None = None
        self.grid = FieldGrid(theme)
        key = "pressure_function."
        self.kind = self.chosen(
            self.grid, key + "kind", self.tr("&Course"), {kind: name_of(kind) for kind in KINDS},
            self.tr("The pressure swings around the working point from the list of pressures."),
        )  # fmt: skip
        self.amplitude = self.typed(
            self.grid, key + "amplitude_bar", self.tr("&Amplitude"), "bar",
            self.tr("The pressure stays between working point − amplitude and working point + amplitude."),
        )  # fmt: skip
        self.direction = self.chosen(
            self.grid, key + "direction", self.tr("&Direction"),
            {"rising": self.tr("rising"), "falling": self.tr("falling")},
            self.tr("A rising ramp begins at working point − amplitude."),
        )  # fmt: skip
        self.frequency = self.typed(
            self.grid, key + "frequency_hz", self.tr("&Frequency"), "Hz", self.tr("Swings per second")
        )
        self.steps = self.typed(
            self.grid, key + "steps_bar", self.tr("&Steps"), "bar",
            self.tr("Offsets from the working point in turn, each for an equal share of the braking: 0 5 −3"),
            wide=True,
        )  # fmt: skip
        self.rise = self.typed(
            self.grid, key + "rise_s", self.tr("&Rise time"), "s",
            self.tr("The pressure rises in a straight line from zero in this time; 0: as fast as the rig "
            "can."),
        )  # fmt: skip
        self.preview = CoursePreview(theme, "bar")
        self.preview.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.preview.setToolTip(self.tr("Pressure over the time of a braking; dashed: most the rig can do"))
        self.caption = QLabel()
        self.caption.setProperty("look", "muted")
        self._layout = QVBoxLayout(self)
        self._layout.addWidget(self.grid)
        self._layout.addWidget(self.caption)
        self._layout.addWidget(self.preview, 2)
        self._layout.addStretch(1)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        self._layout.setSpacing(self.theme.px(1))
        self.caption.setFont(self.theme.font("small"))
        self.preview.setMinimumHeight(self.theme.px(16))
        self.preview.setMaximumHeight(self.theme.px(40))

    @property
    def places(self) -> tuple[str, ...]:
        """See Section."""
        return self.grid.places

    def value(self, form: SequenceForm) -> SequenceForm:
        """See Section."""
        function = FunctionForm(
            kind=self.kind.currentData(),
            amplitude=self.amplitude.text(),
            frequency=self.frequency.text(),
            direction=self.direction.currentData(),
            steps=self.steps.text(),
            rise=self.rise.text(),
        )
        return replace(form, function=function)

    def setValue(self, form: SequenceForm) -> None:
        """See Section."""
        function = form.function
        choose(self.kind, function.kind)
        choose(self.direction, function.direction)
        self.amplitude.setValue(function.amplitude)
        self.frequency.setValue(function.frequency)
        self.steps.setValue(function.steps)
        self.rise.setValue(function.rise)
        for name, kinds in _USED.items():
            self.grid.set_row_visible(f"pressure_function.{name}", function.kind in kinds)
        self._draw(form)

    def _draw(self, form: SequenceForm) -> None:
        """The first braking; nothing while fields are wrong."""
        points: list[tuple[float, float]] = []
        words = ""
        model = judge(form).sequence
        first = next(brakings(model.model_copy(update={"enabled": True})), None) if model else None
        if first is not None and model is not None:
            first = first.model_copy(update={"pressure_bar": max(model.pressures_bar)})
            times = braking_times(first)
            points = [(t, first.pressure_setpoint_bar(t)) for t in times]
            words = self.tr("Drawn for the highest working point, {0:g} bar, over {1:g} s").format(
                first.pressure_bar, first.duration_s
            )
        else:
            points, words = self._draw_alone(form)
        self.caption.setText(words)
        self.preview.setValue(points, self._limit)

    def _draw_alone(self, form: SequenceForm) -> tuple[list[tuple[float, float]], str]:
        """The function over 12 s when the rest of the sequence is not right yet."""
        try:
            function = _FUNCTION.validate_python(function_mapping(form.function))
        except ValidationError:
            return [], self.tr("No drawing: a field above is wrong.")
        working = max((p for p in map(parse_number, form.pressures) if p is not None), default=10.0)
        points = [(0.05 * k, function.pressure_bar(0.05 * k, working, 12.0)) for k in range(241)]
        return points, self.tr("Working point {0:g} bar, drawn over 12 s").format(working)

    def show_faults(self, faults: Faults) -> None:
        """See Section."""
        show_in_grid(self.grid, faults)

    def show_rig(self, rig: RigConfig | None) -> None:
        """See Section."""
        self._limit = rig.capabilities.max_pressure_bar if rig is not None else None
        self.preview.setValue(self.preview.value(), self._limit)

    def focus(self, place: str) -> None:
        """See Section."""
        self.grid.focus(place)

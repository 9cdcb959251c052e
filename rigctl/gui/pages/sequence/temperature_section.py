"""Section "Temperature": how the start temperature is met, limits of the disc, rest and cooling air.

Not its job: doing it (`rigctl.engine.conditioning`).
"""

from __future__ import annotations

from dataclasses import replace

from PySide6.QtWidgets import QCheckBox, QGridLayout, QLabel

from rigctl.config.rig import RigConfig
from rigctl.gui.pages.sequence.forms import ConditioningForm, LimitsForm, SequenceForm
from rigctl.gui.pages.sequence.section import Faults, Section, choose, show_in_grid
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.field_grid import FieldGrid

_DRAG = ("conditioning.drag_speed_rpm", "conditioning.drag_pressure_bar")


WIDE_UNITS = 60
"""Width in grid units from which the two halves stand side by side."""


class TemperatureSection(Section):
    """Conditioning on the left, the rest on the right."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__(theme)
        self.left, self.right = FieldGrid(theme, 9), FieldGrid(theme, 9)
        self._build_conditioning()
        self._build_rest()
        self._narrow: bool | None = None
        self._titles = (QLabel(self.tr("Before each braking")), QLabel(self.tr("Limits and pauses")))
        self._grid = QGridLayout(self)
        for title in self._titles:
            title.setProperty("look", "title")
        self.show_width(theme.px(WIDE_UNITS))
        theme.changed.connect(self._restyle)
        self._restyle()

    def show_width(self, width: int) -> None:
        """Side by side, or below each other in a narrow place."""
        narrow = width < self.theme.px(WIDE_UNITS)
        if narrow == self._narrow:
            return
        self._narrow = narrow
        for number, (title, fields) in enumerate(zip(self._titles, (self.left, self.right), strict=True)):
            row, column = (2 * number, 0) if narrow else (0, number)
            for widget, at in ((title, row), (fields, row + 1)):
                self._grid.removeWidget(widget)
                self._grid.addWidget(widget, at, column)
        self._grid.setColumnStretch(0, 1)
        self._grid.setColumnStretch(1, 0 if narrow else 1)
        self._grid.setRowStretch(4, 1)

    def _restyle(self) -> None:
        self._grid.setHorizontalSpacing(self.theme.px(3))
        self._grid.setVerticalSpacing(self.theme.px(1))

    def _build_conditioning(self) -> None:
        key = "conditioning."
        self.enabled = QCheckBox(self.tr("bring the disc to it"))
        self.enabled.toggled.connect(self._on_enabled)
        self.left.add(
            key + "enabled",
            self.tr("Start t&emperature"),
            self.enabled,
            tip=self.tr(
                "Off: brake at whatever temperature the disc has; the list of temperatures is not used."
            ),
            wide=True,
        )
        self.mode = self.chosen(
            self.left,
            key + "mode",
            self.tr("&How"),
            {"exact": self.tr("heat or cool to it"), "at_most": self.tr("only cool, at most")},
            self.tr(
                "“Only cool” starts as soon as the disc is not hotter (bedding); it never waits for heat."
            ),
        )
        self.tolerance = self.typed(
            self.left,
            key + "tolerance_k",
            self.tr("To&lerance ±"),
            "K",
            self.tr("Half width of the band around the start temperature"),
        )
        self.soak = self.typed(
            self.left,
            key + "soak_s",
            self.tr("Soa&k"),
            "s",
            self.tr("How long the disc stays in the band before the braking"),
        )
        self.timeout = self.typed(
            self.left,
            key + "timeout_s",
            self.tr("Ti&me-out"),
            "s",
            self.tr("Heating, cooling and soaking together may take this long"),
        )
        self.drag_speed = self.typed(
            self.left,
            _DRAG[0],
            self.tr("Drag speed"),
            "1/min",
            self.tr("Speed of heating by dragging; empty: the rig's own"),
        )
        self.drag_pressure = self.typed(
            self.left,
            _DRAG[1],
            self.tr("Drag pressure"),
            "bar",
            self.tr("Pressure of heating by dragging; empty: the rig's own"),
        )

    def _build_rest(self) -> None:
        self.maximum = self.typed(
            self.right,
            "limits.max_degc",
            self.tr("Ma&ximum temperature"),
            "°C",
            self.tr("Hotter than this, braking stops …"),
        )
        self.cool_down = self.typed(
            self.right,
            "limits.cool_down_degc",
            self.tr("&Cool-down temperature"),
            "°C",
            self.tr("… and goes on when the disc has cooled to this"),
        )
        self.dwell = self.typed(
            self.right,
            "dwell_s",
            self.tr("Rest &between brakings"),
            "s",
            self.tr("From release to the next braking"),
        )
        self.ventilator = QCheckBox(self.tr("may run"))
        self.ventilator.toggled.connect(lambda _on: self.valueChanged.emit("ventilator", False))
        self.right.add(
            "ventilator",
            self.tr("Ventilator while braking"),
            self.ventilator,
            tip=self.tr(
                "Never with recorded sound: the ventilator would be heard. Between brakings it always cools."
            ),
            wide=True,
        )

    def _on_enabled(self, _on: bool) -> None:
        self.valueChanged.emit("conditioning.enabled", False)

    @property
    def places(self) -> tuple[str, ...]:
        """See Section."""
        return (*self.left.places, *self.right.places)

    def value(self, form: SequenceForm) -> SequenceForm:
        """See Section."""
        conditioning = ConditioningForm(
            enabled=self.enabled.isChecked(),
            mode=self.mode.currentData(),
            tolerance=self.tolerance.text(),
            soak=self.soak.text(),
            timeout=self.timeout.text(),
            drag_speed=self.drag_speed.text(),
            drag_pressure=self.drag_pressure.text(),
        )
        return replace(
            form,
            conditioning=conditioning,
            limits=LimitsForm(self.maximum.text(), self.cool_down.text()),
            dwell=self.dwell.text(),
            ventilator=self.ventilator.isChecked(),
        )

    def setValue(self, form: SequenceForm) -> None:
        """See Section."""
        how = form.conditioning
        for box, on in ((self.enabled, how.enabled), (self.ventilator, form.ventilator)):
            box.blockSignals(True)
            box.setChecked(on)
            box.blockSignals(False)
        choose(self.mode, how.mode)
        for edit, text in (
            (self.tolerance, how.tolerance),
            (self.soak, how.soak),
            (self.timeout, how.timeout),
            (self.drag_speed, how.drag_speed),
            (self.drag_pressure, how.drag_pressure),
            (self.maximum, form.limits.maximum),
            (self.cool_down, form.limits.cool_down),
            (self.dwell, form.dwell),
        ):
            edit.setValue(text)
        for place in self.left.places[1:]:
            heats = place not in _DRAG or how.mode == "exact"
            self.left.set_row_enabled(place, how.enabled and heats)

    def show_faults(self, faults: Faults) -> None:
        """See Section."""
        show_in_grid(self.left, faults)
        show_in_grid(self.right, faults)

    def show_rig(self, rig: RigConfig | None) -> None:
        """The rig's own drag stands in the empty fields."""
        if rig is not None:
            own = self.tr("rig: {0:g}")
            self.drag_speed.setPlaceholderText(own.format(rig.capabilities.conditioning_speed_rpm))
            self.drag_pressure.setPlaceholderText(own.format(rig.capabilities.conditioning_pressure_bar))

    def focus(self, place: str) -> None:
        """See Section."""
        (self.left if place in self.left.places else self.right).focus(place)

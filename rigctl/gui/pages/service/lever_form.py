"""The inputs of lever and weights.

Job: lengths and masses as typed, held against what is possible, remembered. Not its job: the procedure.
"""

from __future__ import annotations

from pydantic import ValidationError
from PySide6.QtCore import QSettings, Signal
from PySide6.QtWidgets import QLineEdit, QVBoxLayout, QWidget

from rigctl.calibration.torque import STANDARD_GRAVITY, Lever
from rigctl.gui.pages.service.fault_words import fault_said
from rigctl.gui.pages.service.parts import Form, set_wrong
from rigctl.gui.pages.service.torque_guide import masses_in
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.entries import NumberRange
from rigctl.gui.widgets.value_field import ValueField

_LENGTH, _MASSES = "calibration/lever-m", "calibration/masses-kg"


class LeverForm(QWidget):
    """Four inputs. `value()` is None while one is refused; `problem()` says why."""

    valueChanged = Signal()

    def __init__(self, theme: ThemeKeeper, settings: QSettings) -> None:
        super().__init__()
        self._settings = settings
        self.length = ValueField(
            theme, NumberRange(0.05, 5.0, "m", 4), float(str(settings.value(_LENGTH, 1.0)))
        )
        self.masses = QLineEdit(str(settings.value(_MASSES, "10 20 30 40 50 60")))
        self.own = ValueField(theme, NumberRange(0.0, 500.0, "N·m", 3), 0.0)
        self.gravity = ValueField(theme, NumberRange(9.76, 9.84, "m/s²", 5), STANDARD_GRAVITY)
        for field, name in ((self.length, "length"), (self.masses, "masses"), (self.own, "own"),
                            (self.gravity, "gravity")):  # fmt: skip
            field.setObjectName(f"lever-{name}")
        form = Form(theme)
        form.add(self.tr("Lever &length"), self.length, self.tr("From the axis of the disc to the weights"))
        form.add(
            self.tr("&Masses (kg)"), self.masses,
            self.tr("What hangs on the lever, step by step, from light to heavy, with blanks between"),
        )  # fmt: skip
        form.add(
            self.tr("&Own moment"), self.own,
            self.tr("Moment of the lever itself on the sensor; 0 when it is balanced"),
        )  # fmt: skip
        form.add(self.tr("&Gravity g"), self.gravity, self.tr("At this place; Germany 9.807 to 9.815 m/s²"))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(form)
        self.masses.textChanged.connect(self._on_changed)
        for field in (self.length, self.own, self.gravity):
            field.edit.textChanged.connect(self._on_changed)

    def _read(self) -> tuple[Lever | None, str]:
        length, own, gravity = self.length.value(), self.own.value(), self.gravity.value()
        fields = (self.length, self.own, self.gravity)
        problem = next((found for field in fields if (found := field.problem())), "")
        if length is None or own is None or gravity is None:
            return None, problem
        try:
            masses = masses_in(self.masses.text())
            if len(masses) < 2:
                return None, self.tr("Give two masses at least: a line needs them.")
            return Lever(length_m=length, masses_kg=masses, own_nm=own, gravity=gravity), ""
        except ValidationError as error:
            words = str(error.errors()[0]["msg"]).removeprefix("Value error, ")
        except ValueError as error:
            words = str(error)
        words = fault_said(words)
        return None, words[:1].upper() + words[1:] + "."

    def _on_changed(self) -> None:
        values = (self.length.value(), self.own.value(), self.gravity.value())
        set_wrong(self.masses, None not in values and self.value() is None)
        self.valueChanged.emit()

    def value(self) -> Lever | None:
        """The lever; None while an input is refused."""
        return self._read()[0]

    def problem(self) -> str:
        """Why an input is refused, "" when none is."""
        return self._read()[1]

    def setValue(self, lever: Lever) -> None:
        """Show another lever."""
        self.length.setValue(lever.length_m)
        self.masses.setText(" ".join(f"{mass:g}" for mass in lever.masses_kg))
        self.own.setValue(lever.own_nm)
        self.gravity.setValue(lever.gravity)

    def remember(self) -> None:
        """For the next time."""
        if (lever := self.value()) is not None:
            self._settings.setValue(_LENGTH, lever.length_m)
            self._settings.setValue(_MASSES, self.masses.text())

"""What is asked at every calibration: who, what with, on which instrument, for how long it holds.

Job: the inputs, remembered for the next time. Not its job: the procedure.
"""

from __future__ import annotations

import getpass
from dataclasses import dataclass

from PySide6.QtCore import QSettings, Signal
from PySide6.QtWidgets import QLineEdit, QVBoxLayout, QWidget

from rigctl.gui.pages.service.parts import Form
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.entries import NumberRange
from rigctl.gui.widgets.value_field import ValueField


@dataclass(frozen=True)
class Facts:
    """Who and what."""

    operator: str
    instrument: str
    reference: str
    valid_days: int


class FactsForm(QWidget):
    """Four inputs. `value()` is None while one is refused."""

    valueChanged = Signal()

    def __init__(
        self, theme: ThemeKeeper, settings: QSettings, quantity: str, reference_name: str, days: int
    ) -> None:
        super().__init__()
        self._settings, self._key = settings, f"calibration/{quantity}"
        self.operator = QLineEdit(str(settings.value("calibration/operator", "")) or getpass.getuser())
        self.instrument = QLineEdit(str(settings.value(f"{self._key}/instrument", "")))
        self.instrument.setPlaceholderText(self.tr("maker, type, serial number"))
        self.reference = QLineEdit(str(settings.value(f"{self._key}/reference", "")))
        self.reference.setPlaceholderText(self.tr("type, class, serial number, certificate"))
        self.days = ValueField(theme, NumberRange(1, 3650, self.tr("days"), 0), days)
        for field, name in ((self.operator, "operator"), (self.instrument, "instrument"),
                            (self.reference, "reference"), (self.days, "days")):  # fmt: skip
            field.setObjectName(f"{quantity}-{name}")
        form = Form(theme)
        form.add(self.tr("Operator"), self.operator, self.tr("Who calibrates; stands in the file"))
        form.add(self.tr("Sensor"), self.instrument, self.tr("The sensor that is calibrated"))
        form.add(reference_name, self.reference, self.tr("What it is compared with"))
        form.add(self.tr("Valid for"), self.days, self.tr("After so many days it is due again"))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(form)
        self.operator.textChanged.connect(self.valueChanged)
        self.days.valueChanged.connect(self.valueChanged)

    def value(self) -> Facts | None:
        """What was typed; None when the operator or the days are missing."""
        days, operator = self.days.value(), self.operator.text().strip()
        if days is None or not operator:
            return None
        return Facts(operator, self.instrument.text().strip(), self.reference.text().strip(), round(days))

    def setValue(self, facts: Facts) -> None:
        """Show other facts."""
        self.operator.setText(facts.operator)
        self.instrument.setText(facts.instrument)
        self.reference.setText(facts.reference)
        self.days.setValue(facts.valid_days)

    def problem(self) -> str:
        """What is missing, in words."""
        if not self.operator.text().strip():
            return self.tr("Say who calibrates.")
        return self.days.problem()

    def remember(self) -> None:
        """For the next time."""
        self._settings.setValue("calibration/operator", self.operator.text().strip())
        self._settings.setValue(f"{self._key}/instrument", self.instrument.text().strip())
        self._settings.setValue(f"{self._key}/reference", self.reference.text().strip())

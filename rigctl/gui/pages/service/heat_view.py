"""The emissivity calibration on the screen: contact thermometer against pyrometer, pair by pair.

Job: inputs, live pyrometer, pairs, result and where it is corrected, save. Not its job: the evaluation
(`heat_guide`), samples (`sampler`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import QTimer
from PySide6.QtWidgets import (
    QButtonGroup,
    QCheckBox,
    QHBoxLayout,
    QPushButton,
    QRadioButton,
    QVBoxLayout,
    QWidget,
)

from rigctl.calibration.emissivity import Pyrometer
from rigctl.core.channels import DISC_TEMPERATURE
from rigctl.gui.format import number_text, quantity_text, signed_text
from rigctl.gui.pages.service.fault_words import fault_said
from rigctl.gui.pages.service.form import FactsForm
from rigctl.gui.pages.service.heat_guide import HeatGuide
from rigctl.gui.pages.service.parts import FaultList, Form, Panel, PlainTable, label, scrolled
from rigctl.gui.pages.service.procedure import Procedure
from rigctl.gui.pages.service.sampler import Reading
from rigctl.gui.services import Services
from rigctl.gui.widgets.entries import NumberRange
from rigctl.gui.widgets.value_field import ValueField

_LOOK_MS = 300
_LIVE_SAMPLES = 40
MEASURE_S = 1.0
"""Shorter than for the torque: the disc cools meanwhile."""


class HeatView(Procedure):
    """Emissivity by contact thermometer."""

    def __init__(self, services: Services, session: Any, folder: Path) -> None:
        super().__init__(services, session, folder)
        self.headline.setText(self.tr("Emissivity by contact thermometer"))
        self.guide = HeatGuide()
        self._truths: list[float] = []
        self._reading: Reading | None = None
        self._facts = FactsForm(
            self.theme, services.settings, "emissivity", self.tr("Contact thermometer"), days=180
        )
        inside = QWidget()
        left = QVBoxLayout(inside)
        left.setContentsMargins(0, 0, 0, 0)
        left.addWidget(self._steps())
        left.addStretch(1)
        self.content.addWidget(scrolled(inside), 4)
        self.content.addWidget(self._result_panel(), 5)
        self._look = QTimer(self)
        self._look.setInterval(_LOOK_MS)
        self._look.timeout.connect(self._show_live)
        self._look.start()
        if self.laboratory is not None:
            self.laboratory.answered.connect(self._on_truth)
            self.laboratory.refused.connect(self._on_failed)
        for field in (self.set_value, self.wavelength, self.ambient):
            field.valueChanged.connect(lambda _value: self._on_settings())
        self._facts.valueChanged.connect(self._show)
        self._on_settings()

    @property
    def facts(self) -> FactsForm:
        """See `Procedure`."""
        return self._facts

    def _restyle(self) -> None:
        self.live.setFont(self.theme.font("large"))

    # -- build -----------------------------------------------------------------------------------

    def _steps(self) -> QWidget:
        self.set_value = ValueField(self.theme, NumberRange(0.05, 1.0, "", 3), 0.85)
        self.set_value.setObjectName("heat-set")
        self.wavelength = ValueField(self.theme, NumberRange(0.7, 20.0, "µm", 2), 10.0)
        self.wavelength.setObjectName("heat-wavelength")
        self.ambient = ValueField(self.theme, NumberRange(-40.0, 60.0, "°C", 1), 20.0)
        self.ambient.setObjectName("heat-ambient")
        self.contact = ValueField(self.theme, NumberRange(0.0, 900.0, "°C", 1))
        self.contact.setObjectName("heat-contact")
        form = Form(self.theme)
        form.add(self.tr("&Emissivity set"), self.set_value, self.tr("As it is set at the pyrometer now"))
        form.add(self.tr("&Wavelength"), self.wavelength, self.tr("Effective one; 10 µm for 8 to 14 µm"))
        form.add(self.tr("Sur&roundings"), self.ambient, self.tr("Temperature of what the disc reflects"))
        form.add(self.tr("&Contact reading"), self.contact, self.tr("What it shows on the rub track, now"))
        self.live = label("")
        self.live.setObjectName("heat-live")
        self.live.setFont(self.theme.font("large"))
        self.theme.changed.connect(self._restyle)
        self.aid = QCheckBox(self.tr("Contact thermometer of the &simulated rig"))
        self.aid.setObjectName("heat-aid")
        self.aid.setToolTip(
            self.tr("True temperature of the rub surface meanwhile, from the fault laboratory")
        )
        self.aid.setVisible(self.laboratory is not None)
        self.aid.setChecked(self.laboratory is not None)
        self.aid.toggled.connect(self.contact.setDisabled)
        self.contact.setDisabled(self.aid.isChecked())
        self.take = QPushButton(self.tr("&Take the pair"))
        self.take.setObjectName("heat-take")
        self.take.setProperty("look", "primary")
        self.take.setToolTip(self.tr("Mean of the pyrometer over 1 s, beside the contact reading"))
        self.take.clicked.connect(self._take)
        panel = Panel(self.theme)
        panel.body.addWidget(
            label(
                self.tr(
                    "Bring the disc to about 100 °C, let it stand, press the contact thermometer on the rub "
                    "track, wait, type its reading, take the pair. A second pair at 200 °C or more shows "
                    "errors."
                ),
                "muted",
                wrap=True,
            )
        )
        panel.body.addWidget(self._facts)
        panel.body.addWidget(form)
        panel.body.addWidget(self.aid)
        panel.body.addWidget(self.live)
        panel.body.addWidget(self.take)
        return panel

    def _result_panel(self) -> QWidget:
        heads = (self.tr("Contact"), self.tr("Pyrometer"), self.tr("Difference"), self.tr("After correction"))
        self.table = PlainTable(self.theme, heads, stretch=3)
        self.table.setObjectName("heat-table")
        self.table.itemSelectionChanged.connect(self._show_buttons)
        self.remove = QPushButton(self.tr("Remo&ve the selected pair"))
        self.remove.setObjectName("heat-remove")
        self.remove.clicked.connect(self._remove)
        self.result = label(wrap=True)
        self.result.setObjectName("heat-result")
        self.faults = FaultList(self.theme)
        self.at_device = QRadioButton(self.tr("to be set at the &pyrometer"))
        self.in_channel = QRadioButton(self.tr("corrected in the c&hannel"))
        self.at_device.setToolTip(self.tr("Exact; set the new emissivity there and in the rig file"))
        self.in_channel.setToolTip(self.tr("A line over the range; the pyrometer keeps its setting"))
        self.in_channel.setChecked(True)
        self._where = QButtonGroup(self)
        self._where.addButton(self.at_device)
        self._where.addButton(self.in_channel)
        self.save = QPushButton(self.tr("Save cali&bration"))
        self.save.setObjectName("heat-save")
        self.save.setProperty("look", "primary")
        self.save.clicked.connect(self._save)
        panel = Panel(self.theme, self.tr("Pairs"))
        panel.body.addWidget(self.table, 1)
        first = QHBoxLayout()
        first.addWidget(self.remove)
        first.addStretch(1)
        panel.body.addLayout(first)
        panel.body.addWidget(self.result)
        panel.body.addWidget(self.faults)
        row = QHBoxLayout()
        row.setSpacing(self.theme.px(2))
        row.addWidget(self.in_channel)
        row.addWidget(self.at_device)
        row.addStretch(1)
        row.addWidget(self.save)
        panel.body.addLayout(row)
        return panel

    # -- readings --------------------------------------------------------------------------------

    def _show_live(self) -> None:
        reading = self.sampler.newest(DISC_TEMPERATURE, _LIVE_SAMPLES)
        value = None if reading is None else reading.mean
        self.live.setText(self.tr("Pyrometer {0}").format(quantity_text(value, "°C", 1)))

    def _take(self) -> None:
        if self.sampler.busy or self._reading is not None:
            return
        self.say("")
        self._truths = []
        if self.laboratory is not None and self.aid.isChecked():
            self.take.setEnabled(False)
            self.laboratory.ask("status")
            return
        self.contact.setError("")  # shows what is wrong with the number, if anything
        if self.contact.value() is None:
            self.contact.setFocus()
            return
        self._measure()

    def _on_truth(self, answer: dict[str, Any]) -> None:
        """Before and after the pyrometer's mean: the disc cools meanwhile."""
        self._truths.append(float(answer["truth"]["disc_degc"]))
        if self._reading is None:
            self._measure()
        else:
            self.contact.setValue(round(sum(self._truths) / len(self._truths), 1))
            self._take_pair(self._reading)

    def _measure(self) -> None:
        self.take.setEnabled(False)
        self.sampler.measure((DISC_TEMPERATURE,), self._on_read, self._on_failed, MEASURE_S)

    def _on_read(self, readings: dict[str, Reading]) -> None:
        if self._truths and self.laboratory is not None:
            self._reading = readings[DISC_TEMPERATURE]
            self.laboratory.ask("status")
        else:
            self._take_pair(readings[DISC_TEMPERATURE])

    def _take_pair(self, reading: Reading) -> None:
        self._reading = None
        contact = self.contact.value()
        if contact is None or reading.mean != reading.mean:
            self._on_failed(self.tr("The pyrometer has no valid reading."))
            return
        self.guide.nominal_scale = reading.spec.scale
        self.guide.take(contact, reading.mean, reading.scatter)
        self._show()

    def _on_failed(self, why: str) -> None:
        self._reading = None
        self.say(why, "error")
        self._show_buttons()

    def _remove(self) -> None:
        row = self.table.currentRow()
        if 0 <= row < len(self.guide.points):
            self.guide.remove(row)
            self._show()

    # -- result ----------------------------------------------------------------------------------

    def _on_settings(self) -> None:
        emissivity, wavelength = self.set_value.value(), self.wavelength.value()
        ambient = self.ambient.value()
        if emissivity is not None and wavelength is not None and ambient is not None:
            self.guide.pyrometer = Pyrometer(
                wavelength_um=wavelength, emissivity_set=emissivity, ambient_degc=ambient,
                range_to_degc=self.session.rig.capabilities.max_disc_temperature_degc,
            )  # fmt: skip
        self._show()

    def _show(self) -> None:
        result, why = self.guide.result()
        why = fault_said(why)
        rows = []
        for point in self.guide.points:
            after = ""
            if result is not None:
                left_k = self.guide.pyrometer.true_degc(point.measured, result.emissivity) - point.applied
                after = f"{signed_text(left_k, 1)}\u202fK"
            difference = f"{signed_text(point.measured - point.applied, 1)}\u202fK"
            pair = (quantity_text(point.applied, "°C"), quantity_text(point.measured, "°C"))
            rows.append((*pair, difference, after))
        self.table.show_rows(rows, frozenset({0, 1, 2, 3}))
        if result is None:
            self.result.setText(why[:1].upper() + why[1:] or self.tr("No pair yet."))
            self.faults.show_faults(())
        else:
            self.result.setText(
                self.tr("Emissivity {0}; in the channel: gain {1}, offset {2}, within {3} of it").format(
                    number_text(result.emissivity, 3), number_text(result.gain, 4),
                    quantity_text(result.offset, "K", 2), quantity_text(result.figures["line_k"], "K", 1),
                )
            )  # fmt: skip
            self.faults.show_faults(result.faults)
        self._show_buttons()

    def _show_buttons(self) -> None:
        result, _ = self.guide.result()
        self.take.setEnabled(not self.sampler.busy and self._reading is None)
        self.remove.setEnabled(0 <= self.table.currentRow() < len(self.guide.points))
        ready = result is not None and result.acceptable and self._facts.value() is not None
        self.save.setEnabled(ready)
        self.save.setToolTip(
            self.tr("Keep it; it holds from the next start of the rig")
            if ready
            else self._facts.problem() or self.tr("Pairs are needed that nothing speaks against")
        )

    def _save(self) -> None:
        facts = self._facts.value()
        if facts is not None:
            in_channel = self.in_channel.isChecked()
            self.keep(self.guide.calibration(**self.common(facts), in_channel=in_channel))

    def unsaved(self) -> bool:
        """True when pairs would be lost."""
        return bool(self.guide.points)

    def stop(self) -> None:
        """See `Procedure`."""
        self._look.stop()
        super().stop()

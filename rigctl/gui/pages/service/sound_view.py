"""The microphone calibration on the screen: calibrator on, level live, record, result with drift, save.

Job: inputs, live level, recordings, result. Not its job: the evaluation (`sound_guide`), samples (`sampler`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
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

from rigctl.core.channels import MICROPHONE
from rigctl.core.units import REFERENCE_PRESSURE_PA
from rigctl.gui.format import number_text, quantity_text, signed_text
from rigctl.gui.pages.service.fault_words import fault_said
from rigctl.gui.pages.service.form import FactsForm
from rigctl.gui.pages.service.parts import FaultList, Panel, PlainTable, ThinBar, label, scrolled
from rigctl.gui.pages.service.procedure import Procedure
from rigctl.gui.pages.service.sampler import Reading
from rigctl.gui.pages.service.sound_guide import RECORD_S, SoundGuide, read_and_evaluate
from rigctl.gui.services import Services

LEVELS_DB = (94.0, 114.0)
_LOOK_MS = 200
_LIVE_S = 0.4
SETTLE_MS = 600
"""Until the sound of a simulated calibrator has come through."""


def level_db(counts: Any, pa_per_count: float) -> float:
    """Level of counts over all frequencies, dB re 20 µPa; NaN for none."""
    samples = np.asarray(counts, dtype=np.float64)
    if not len(samples):
        return float("nan")
    rms_pa = float(np.std(samples)) * pa_per_count
    return 20.0 * float(np.log10(max(rms_pa, 1e-9) / REFERENCE_PRESSURE_PA))


class SoundView(Procedure):
    """Microphone by calibrator."""

    def __init__(
        self, services: Services, session: Any, folder: Path, last_gain: float | None = None
    ) -> None:
        super().__init__(services, session, folder)
        self.headline.setText(self.tr("Microphone by calibrator"))
        self.guide: SoundGuide | None = None
        self._last_gain = last_gain
        self._job: Any = None
        self._facts = FactsForm(self.theme, services.settings, "microphone", self.tr("Calibrator"), days=90)
        self._facts.valueChanged.connect(self._show)
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
        self._settle = QTimer(self)
        self._settle.setSingleShot(True)
        self._settle.timeout.connect(self._measure)
        if self.laboratory is not None:
            self.laboratory.answered.connect(self._on_calibrator)
            self.laboratory.refused.connect(self._on_failed)
        self._wants_reading = False
        self._show()

    @property
    def facts(self) -> FactsForm:
        """See `Procedure`."""
        return self._facts

    def _restyle(self) -> None:
        self.live.setFont(self.theme.font("large"))

    # -- build -----------------------------------------------------------------------------------

    def _steps(self) -> QWidget:
        self.levels: dict[float, QRadioButton] = {}
        group = QButtonGroup(self)
        row = QHBoxLayout()
        row.setSpacing(self.theme.px(2))
        for level in LEVELS_DB:
            button = QRadioButton(f"{level:g}\u202fdB")
            button.setObjectName(f"sound-level-{level:g}")
            button.setToolTip(self.tr("Level that is set at the calibrator (1 kHz)"))
            group.addButton(button)
            row.addWidget(button)
            self.levels[level] = button
        self.levels[94.0].setChecked(True)
        row.addStretch(1)
        self.live = label("")
        self.live.setObjectName("sound-live")
        self.live.setFont(self.theme.font("large"))
        self.live_note = label("", "muted", wrap=True)
        self.theme.changed.connect(self._restyle)
        self.aid = QCheckBox(self.tr("Calibrator of the &simulated rig"))
        self.aid.setObjectName("sound-aid")
        self.aid.setToolTip(self.tr("The fault laboratory puts a calibrator of that level on the microphone"))
        self.aid.setVisible(self.laboratory is not None)
        self.aid.setChecked(self.laboratory is not None)
        self.take = QPushButton(self.tr("&Record {0:g} s").format(RECORD_S))
        self.take.setObjectName("sound-take")
        self.take.setProperty("look", "primary")
        self.take.setToolTip(self.tr("Record the tone and find the sensitivity; once for each level"))
        self.take.clicked.connect(self._take)
        self.bar = ThinBar(self.theme)
        panel = Panel(self.theme)
        panel.body.addWidget(
            label(
                self.tr(
                    "Push the calibrator on to its stop, choose its level, switch it on and wait until the "
                    "level below stands still. Then record. Ventilator and motor off."
                ),
                "muted",
                wrap=True,
            )
        )
        panel.body.addWidget(self._facts)
        panel.body.addLayout(row)
        panel.body.addWidget(self.aid)
        panel.body.addWidget(self.live)
        panel.body.addWidget(self.live_note)
        panel.body.addWidget(self.take)
        panel.body.addWidget(self.bar)
        return panel

    def _result_panel(self) -> QWidget:
        heads = (
            self.tr("Level"), self.tr("Sensitivity"), self.tr("Tone"), self.tr("Moves by"),
            self.tr("Above rest"),
        )  # fmt: skip
        self.table = PlainTable(self.theme, heads, stretch=4)
        self.table.setObjectName("sound-table")
        self.result = label(self.tr("No recording yet."), wrap=True)
        self.result.setObjectName("sound-result")
        self.faults = FaultList(self.theme)
        self.faults.setObjectName("sound-faults")
        self.save = QPushButton(self.tr("Sa&ve calibration"))
        self.save.setObjectName("sound-save")
        self.save.setProperty("look", "primary")
        self.save.clicked.connect(self._save)
        panel = Panel(self.theme, self.tr("Recordings"))
        panel.body.addWidget(self.table, 1)
        panel.body.addWidget(self.result)
        panel.body.addWidget(self.faults)
        row = QHBoxLayout()
        row.addStretch(1)
        row.addWidget(self.save)
        panel.body.addLayout(row)
        return panel

    # -- live ------------------------------------------------------------------------------------

    def _show_live(self) -> None:
        self.bar.setValue(round(100 * self.sampler.share))
        spec = self.sampler.spec(MICROPHONE)
        reading = None if spec is None else self.sampler.newest(MICROPHONE, round(_LIVE_S * spec.rate_hz))
        if not self.sampler.flows(MICROPHONE):
            reading = None
        if reading is None:
            self.live.setText(quantity_text(None, "dB"))
            self.live_note.setText(
                self.tr(
                    "No sound yet. A simulated rig gives sound at rest only while a calibrator is on its "
                    "microphone."
                )
                if self.session.simulated
                else self.tr("No sound yet: wait until the rig has started.")
            )
            return
        self.live.setText(quantity_text(level_db(reading.samples, reading.spec.scale), "dB", 2))
        self.live_note.setText(self.tr("newest sound, with the nominal sensitivity"))

    # -- recordings ------------------------------------------------------------------------------

    @property
    def level(self) -> float:
        """Level that is chosen, dB."""
        return next(level for level, button in self.levels.items() if button.isChecked())

    def _take(self) -> None:
        if self.sampler.busy or self._job is not None:
            return
        self.say("")
        self.take.setEnabled(False)
        if self.laboratory is not None and self.aid.isChecked():
            self._wants_reading = True
            self.laboratory.ask("calibrator", level_db=self.level)
        else:
            self._measure()

    def _on_calibrator(self, _answer: dict[str, Any]) -> None:
        if self._wants_reading:
            self._wants_reading = False
            self._settle.start(SETTLE_MS)

    def _measure(self) -> None:
        self.sampler.measure((MICROPHONE,), self._on_read, self._on_failed, RECORD_S)

    def _on_read(self, readings: dict[str, Reading]) -> None:
        reading = readings[MICROPHONE]
        spec = reading.spec
        if self.guide is None:
            self.guide = SoundGuide(spec.scale, self._last_gain)
        guide = self.guide
        self.say(self.tr("Evaluating …"))
        self._job = self.services.work.in_process(
            read_and_evaluate, reading.samples, spec.rate_hz, self.level, guide.others(self.level),
            guide.nominal_pa_per_count, guide.last_gain, done=self._on_result, failed=self._on_failed,
            lane="calibration",
        )  # fmt: skip

    def _on_result(self, pair: Any) -> None:
        self._job = None
        self.say("")
        if self.guide is not None:
            self.guide.take(*pair)
        if self.laboratory is not None and self.aid.isChecked():
            self.laboratory.ask("calibrator", level_db=0.0)
        self._show()

    def _on_failed(self, why: str) -> None:
        self._job = None
        self._wants_reading = False
        why = fault_said(why.removeprefix("ValueError: "))
        self.say(why[:1].upper() + why[1:] + ("" if why.endswith(".") else "."), "error")
        self._show()

    # -- result ----------------------------------------------------------------------------------

    def _show(self) -> None:
        busy = self.sampler.busy or self._job is not None
        self.take.setEnabled(not busy)
        guide = self.guide
        result = guide.result if guide is not None else None
        if guide is not None:
            self.table.show_rows(
                [
                    (
                        quantity_text(r.level_db, "dB", 0),
                        self.tr("{0} mPa/count").format(f"{r.pa_per_count * 1e3:.5f}"),
                        quantity_text(r.frequency_hz, "Hz", 1),
                        quantity_text(r.spread_db, "dB", 2),
                        quantity_text(r.tone_to_rest_db, "dB", 0),
                    )
                    for r in guide.recordings.values()
                ],
                frozenset({0, 1, 2, 3, 4}),
            )
        if result is not None:
            words = self.tr("{0:.5f} mPa per count: {1} dB against the nominal sensitivity").format(
                1e3 * result.pa_per_count, signed_text(result.figures["error_db"])
            )
            if result.drift_db is not None:
                words += self.tr("; drift since the last calibration {0} dB").format(
                    signed_text(result.drift_db)
                )
            if (linearity := result.figures.get("linearity_db")) is not None:
                words += self.tr("; the levels agree within {0} dB").format(number_text(linearity, 2))
            self.result.setText(words)
            self.faults.show_faults(result.faults)
        ready = result is not None and result.acceptable and self._facts.value() is not None and not busy
        self.save.setEnabled(ready)
        self.save.setToolTip(
            self.tr("Keep it; it holds from the next start of the rig")
            if ready
            else self._facts.problem() or self.tr("A recording is needed that nothing speaks against")
        )

    def _save(self) -> None:
        facts = self._facts.value()
        if self.guide is not None and facts is not None:
            self.keep(self.guide.calibration(**self.common(facts)))

    def unsaved(self) -> bool:
        """True when recordings would be lost."""
        return self.guide is not None and bool(self.guide.recordings)

    def stop(self) -> None:
        """See `Procedure`; a simulated calibrator is taken off."""
        self._look.stop()
        self._settle.stop()
        if self._job is not None:
            self._job.cancel()
            self._job = None
        super().stop()

"""The guided torque calibration on the screen: lever and weights, step by step, line and residuals.

Job: inputs, the present step in large words, readings, result, save. Not its job: order and evaluation
(`torque_guide`), samples (`sampler`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import (
    QCheckBox,
    QHBoxLayout,
    QPushButton,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from rigctl.core.channels import TORQUE
from rigctl.core.errors import RigctlError
from rigctl.gui.format import number_text
from rigctl.gui.pages.service.fault_words import fault_said
from rigctl.gui.pages.service.form import FactsForm
from rigctl.gui.pages.service.lever_form import LeverForm
from rigctl.gui.pages.service.parts import FaultList, Panel, PlainTable, ThinBar, label, scrolled
from rigctl.gui.pages.service.procedure import Procedure
from rigctl.gui.pages.service.sampler import MEASURE_S, Reading
from rigctl.gui.pages.service.torque_guide import CHANNELS, TorqueGuide
from rigctl.gui.pages.service.torque_plots import TorquePlots
from rigctl.gui.services import Services
from rigctl.safety.limits import load_limits

SETTLE_MS = 400
"""A simulated weight hangs still at once; the blocks in between are waited for."""


class TorqueView(Procedure):
    """Torque by lever and weights."""

    def __init__(self, services: Services, session: Any, folder: Path) -> None:
        super().__init__(services, session, folder)
        self.headline.setText(self.tr("Torque by lever and weights"))
        self.guide: TorqueGuide | None = None
        self._watched = watched_range(session)
        self._facts = FactsForm(
            self.theme, services.settings, "torque", self.tr("Lever and weights"), days=365
        )
        self.plots = TorquePlots(self.theme, services.notify)
        self._left = QStackedWidget()
        self._left.addWidget(scrolled(self._inputs()))
        self._left.addWidget(self._steps())
        inside = QWidget()
        right = QVBoxLayout(inside)
        right.setContentsMargins(0, 0, 0, 0)
        right.setSpacing(self.theme.px(1))
        right.addWidget(self.plots, 1)
        right.addWidget(self._result_panel())
        self.content.addWidget(self._left, 4)
        self.content.addWidget(scrolled(inside), 5)
        self._look = QTimer(self)
        self._look.setInterval(100)
        self._look.timeout.connect(self._show_share)
        self._settle = QTimer(self)
        self._settle.setSingleShot(True)
        self._settle.timeout.connect(self._measure)
        if self.laboratory is not None:
            self.laboratory.answered.connect(self._on_weight)
            self.laboratory.refused.connect(self._on_failed)
        self._show()

    @property
    def facts(self) -> FactsForm:
        """See `Procedure`."""
        return self._facts

    def _restyle(self) -> None:
        self.order.setFont(self.theme.font("large"))

    # -- build -----------------------------------------------------------------------------------

    def _inputs(self) -> QWidget:
        self.lever = LeverForm(self.theme, self.services.settings)
        self.input_error = label("", "error", wrap=True)
        self.input_error.setObjectName("lever-error")
        self.trip_note = label("", "muted", wrap=True)
        self.trip_note.setObjectName("lever-trip-note")
        self.begin = QPushButton(self.tr("&Begin"))
        self.begin.setObjectName("torque-begin")
        self.begin.setProperty("look", "primary")
        self.begin.setToolTip(self.tr("Fix these inputs and take the first reading"))
        self.begin.clicked.connect(self._begin)
        self.lever.valueChanged.connect(self._check)
        self._facts.valueChanged.connect(self._check)
        panel = Panel(self.theme, self.tr("Before you begin"))
        teaching = label(
            self.tr(
                "Rig at rest, drive disabled, pressure released. Bolt the lever to the frame that carries "
                "the brake. Loads go up and down on the right, then on the left: so both directions of "
                "rotation, play and friction are seen."
            ),
            "muted",
            wrap=True,
        )
        panel.body.addWidget(teaching)
        panel.body.addWidget(self.lever)
        panel.body.addWidget(self._facts)
        panel.body.addWidget(self.trip_note)
        panel.body.addWidget(self.input_error)
        panel.body.addStretch(1)
        panel.body.addWidget(self.begin)
        return panel

    def _steps(self) -> QWidget:
        self.order = label(wrap=True)
        self.order.setObjectName("torque-order")
        self.order.setFont(self.theme.font("large"))
        self.theme.changed.connect(self._restyle)
        self.take = QPushButton(self.tr("&Take the reading"))
        self.take.setObjectName("torque-take")
        self.take.setProperty("look", "primary")
        self.take.setToolTip(
            self.tr("Mean of the live torque over {0:g} s; the weights must hang still").format(MEASURE_S)
        )
        self.take.clicked.connect(self._take)
        self.aid = QCheckBox(self.tr("Weights of the &simulated rig"))
        self.aid.setObjectName("torque-aid")
        self.aid.setToolTip(self.tr("The fault laboratory hangs the weights on before each reading"))
        self.aid.setChecked(self.laboratory is not None)
        self.aid.setVisible(self.laboratory is not None)
        self.repeat = QPushButton(self.tr("&Repeat the selected"))
        self.repeat.setObjectName("torque-repeat")
        self.repeat.setToolTip(self.tr("Take the reading of the selected row again"))
        self.repeat.clicked.connect(self._repeat)
        self.bar = ThinBar(self.theme)
        self.table = PlainTable(
            self.theme,
            (self.tr("Side"), self.tr("kg"), self.tr("N·m"), self.tr("Reading"), self.tr("Scatter")),
            stretch=3,
        )
        self.table.setObjectName("torque-table")
        self.table.itemSelectionChanged.connect(self._show_buttons)
        panel = Panel(self.theme)
        row = QHBoxLayout()
        row.setSpacing(self.theme.px(1))
        row.addWidget(self.take)
        row.addWidget(self.repeat)
        row.addStretch(1)
        panel.body.addWidget(self.order)
        panel.body.addWidget(self.aid)
        panel.body.addLayout(row)
        panel.body.addWidget(self.bar)
        panel.body.addWidget(self.table, 1)
        return panel

    def _result_panel(self) -> QWidget:
        self.result = label(wrap=True)
        self.result.setObjectName("torque-result")
        self.faults = FaultList(self.theme)
        self.faults.setObjectName("torque-faults")
        self.save = QPushButton(self.tr("Sa&ve calibration"))
        self.save.setObjectName("torque-save")
        self.save.setProperty("look", "primary")
        self.save.clicked.connect(self._save)
        panel = Panel(self.theme)
        panel.body.addWidget(self.result)
        panel.body.addWidget(self.faults)
        row = QHBoxLayout()
        row.addStretch(1)
        row.addWidget(self.save)
        panel.body.addLayout(row)
        return panel

    # -- inputs ----------------------------------------------------------------------------------

    def _check(self) -> None:
        problem = self.lever.problem() or self._facts.problem()
        self.input_error.setText("▲ " + problem if problem else "")
        self.input_error.setVisible(bool(problem))
        self.begin.setEnabled(not problem)
        lever = self.lever.value()
        low, high = self._watched
        largest = 0.0 if lever is None else lever.torque_nm(lever.masses_kg[-1])
        trips = largest > high or -largest < low
        self.trip_note.setVisible(trips)
        if trips:
            self.trip_note.setText(
                self.tr(
                    "△ The watchdog feels the weights too and trips outside {0:g} … {1:g} N·m. Nothing moves "
                    "by that; reset it when the weights are off."
                ).format(low, high)
            )

    def _begin(self) -> None:
        lever = self.lever.value()
        spec = self.sampler.spec(TORQUE)
        if lever is None:
            return
        if spec is None:
            self.say(self.tr("The rig delivers no torque yet: wait until it has started."), "error")
            return
        self.lever.remember()
        self.guide = TorqueGuide(lever, self.session.rig.capabilities.max_torque_nm, spec.scale)
        self._left.setCurrentIndex(1)
        self.say("")
        self._show()
        self.take.setFocus()

    # -- readings --------------------------------------------------------------------------------

    def _take(self) -> None:
        guide = self.guide
        if guide is None or guide.step is None or self.sampler.busy:
            return
        self.say("")
        self.take.setEnabled(False)
        if self.laboratory is not None and self.aid.isChecked():
            self.laboratory.ask("weight", torque_nm=guide.step.applied_nm)
        else:
            self._measure()

    def _on_weight(self, _answer: dict[str, Any]) -> None:
        self._settle.start(SETTLE_MS)

    def _measure(self) -> None:
        self.sampler.measure(CHANNELS, self._on_read, self._on_failed)
        self._look.start()
        self._show_buttons()

    def _on_read(self, readings: dict[str, Reading]) -> None:
        self._look.stop()
        guide = self.guide
        if guide is None:
            return
        problem = guide.problem({name: reading.mean for name, reading in readings.items()})
        torque = readings[TORQUE]
        if problem or torque.mean != torque.mean:
            self._on_failed(fault_said(problem) or self.tr("the torque has no valid reading"))
            return
        guide.take(torque.mean, torque.scatter)
        self._show()
        if guide.complete and self.laboratory is not None and self.aid.isChecked():
            self.laboratory.answered.disconnect(self._on_weight)
            self.laboratory.ask("weight", torque_nm=0.0)
            self.laboratory.answered.connect(self._on_cleared)

    def _on_cleared(self, _answer: dict[str, Any]) -> None:
        if self.laboratory is not None:
            self.laboratory.answered.disconnect(self._on_cleared)
            self.laboratory.answered.connect(self._on_weight)

    def _on_failed(self, why: str) -> None:
        self._look.stop()
        self.say(why[:1].upper() + why[1:] + ("" if why.endswith(".") else "."), "error")
        self._show_buttons()

    def _repeat(self) -> None:
        row = self.table.currentRow()
        if self.guide is not None and row >= 0:
            self.guide.repeat(row)
            self._show()
            self.take.setFocus()

    # -- show ------------------------------------------------------------------------------------

    def _show_share(self) -> None:
        self.bar.setValue(round(100 * self.sampler.share))

    def _show(self) -> None:
        self._check()
        guide = self.guide
        result = guide.result() if guide is not None else None
        if guide is not None:
            self._show_steps(guide)
            self.plots.show_result(guide.taken, result, guide.full_scale_nm)
        if result is None:
            self.result.setText(self.tr("The line is drawn from the third load on."))
            self.faults.show_faults(())
        else:
            figures = result.figures
            self.result.setText(
                self.tr(
                    "gain {0:.5f}, offset {1:+.2f} N·m; largest residual {2:.3f} %, hysteresis {3:.3f} %, "
                    "zero {4:.3f} % of full scale"
                ).format(
                    result.gain, result.offset, figures["residual_percent"], figures["hysteresis_percent"],
                    figures["zero_percent"],
                )
            )  # fmt: skip
            self.faults.show_faults(result.faults if guide is not None and guide.complete else ())
        self._show_buttons()

    def _show_steps(self, guide: TorqueGuide) -> None:
        sides = {1: self.tr("right"), -1: self.tr("left")}
        ways = {"up": "▲", "down": "▼"}
        rows = []
        for step, point in zip(guide.steps, guide.points, strict=True):
            read = ("", "") if point is None else (f"{point.measured:.2f}", f"{point.scatter:.2f}")
            side = f"{sides[step.direction]} {ways[step.course]}"
            rows.append((side, f"{step.mass_kg:g}", number_text(step.applied_nm, 1), *read))
        self.table.show_rows(rows, frozenset({1, 2, 3, 4}))
        step = guide.step
        if step is None:
            self.order.setText(self.tr("All readings are taken."))
            return
        self.table.blockSignals(True)
        self.table.selectRow(guide.at)
        self.table.blockSignals(False)
        count = f"{sum(point is not None for point in guide.points) + 1}/{len(guide.steps)}"
        if step.mass_kg == 0.0:
            text = self.tr("{0}  Lever on the {1}, no weights").format(count, sides[step.direction])
        else:
            text = self.tr("{0}  {1:g} kg on the {2}").format(count, step.mass_kg, sides[step.direction])
        self.order.setText(text)

    def _show_buttons(self) -> None:
        guide = self.guide
        if guide is None:
            self.save.setEnabled(False)
            return
        busy = self.sampler.busy or self._settle.isActive()
        self.take.setEnabled(not busy and guide.step is not None)
        if not busy:
            self.bar.setValue(0)
        row = self.table.currentRow()
        self.repeat.setEnabled(not busy and 0 <= row < len(guide.points) and guide.points[row] is not None)
        result = guide.result()
        ready = guide.complete and result is not None and result.acceptable and not busy
        self.save.setEnabled(ready)
        self.save.setToolTip(
            self.tr("Keep it; it holds from the next start of the rig")
            if ready
            else self.tr("Every step wants its reading, and nothing may speak against the result")
        )

    # -- end -------------------------------------------------------------------------------------

    def _save(self) -> None:
        facts = self._facts.value()
        if self.guide is not None and facts is not None:
            self.keep(self.guide.calibration(**self.common(facts)))

    def unsaved(self) -> bool:
        """True when readings would be lost."""
        return self.guide is not None and bool(self.guide.taken)

    def stop(self) -> None:
        """See `Procedure`."""
        self._look.stop()
        self._settle.stop()
        super().stop()

    def keyPressEvent(self, event: Any) -> None:
        """Enter takes the reading."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.take.isEnabled():
            self._take()
            return
        super().keyPressEvent(event)


def watched_range(session: Any) -> tuple[float, float]:
    """Torque within which the watchdog does not trip, N·m; everything when its limits cannot be read."""
    try:
        limits = load_limits(session.campaign / session.rig.safety.limits).limits
    except RigctlError:
        return float("-inf"), float("inf")
    return limits.torque.min_nm, limits.torque.max_nm

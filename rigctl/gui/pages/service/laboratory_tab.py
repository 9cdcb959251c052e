"""The fault laboratory: make something go wrong on the simulated rig, and mend it.

Job: one control for each stimulus, what is in force, what was refused. Not its job: what a stimulus does
(`sim_hardware.devices.stimuli`).
"""

from __future__ import annotations

from functools import partial
from typing import Any

from PySide6.QtCore import QSignalBlocker, QTimer
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from rigctl.core.channels import DISC_TEMPERATURE, PRESSURE, SPEED, TORQUE
from rigctl.gui.format import number_text
from rigctl.gui.pages.service.laboratory_client import LaboratoryClient
from rigctl.gui.pages.service.live_session import LiveSession
from rigctl.gui.pages.service.parts import Form, Panel, label, scrolled, set_look
from rigctl.gui.services import Services
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.entries import NumberRange
from rigctl.gui.widgets.value_field import ValueField
from sim_hardware.devices.laboratory import in_force

_LOOK_MS = 1000
_UNITS = {PRESSURE: "bar", SPEED: "1/min", TORQUE: "N·m", DISC_TEMPERATURE: "K"}


class SensorRow(QWidget):
    """One sensor: how it is disturbed, by how much, and who sees it."""

    def __init__(self, theme: ThemeKeeper, channel: str) -> None:
        super().__init__()
        self.channel = channel
        self.mode = QComboBox()
        self.mode.setObjectName(f"lab-mode-{channel}")
        for word, text in (("ok", self.tr("well")), ("invalid", self.tr("no valid reading")),
                           ("frozen", self.tr("frozen")), ("offset", self.tr("reads off by"))):  # fmt: skip
            self.mode.addItem(text, word)
        self.mode.setToolTip(self.tr("What the sensor does"))
        self.value = ValueField(theme, NumberRange(-2000.0, 2000.0, _UNITS[channel], 2), 0.0)
        self.value.setObjectName(f"lab-value-{channel}")
        self.value.limits.hide()
        self.unit = label(_UNITS[channel], "muted")
        self.seen_by = QComboBox()
        self.seen_by.setObjectName(f"lab-seen-{channel}")
        for word, text in (("both", self.tr("both see it")), ("controller", self.tr("controller only")),
                           ("watchdog", self.tr("watchdog only"))):  # fmt: skip
            self.seen_by.addItem(text, word)
        self.seen_by.setToolTip(self.tr("The watchdog has sensors of its own"))
        self.apply = QPushButton(self.tr("Apply"))
        self.apply.setObjectName(f"lab-apply-{channel}")
        self.mode.currentIndexChanged.connect(self._show)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(theme.px(1))
        layout.addWidget(self.mode)
        layout.addWidget(self.value)
        layout.addWidget(self.unit)
        layout.addWidget(self.seen_by)
        layout.addWidget(self.apply)
        layout.addStretch(1)
        self._show()

    def _show(self) -> None:
        offset = self.mode.currentData() == "offset"
        self.value.setVisible(offset)
        self.unit.setVisible(offset)
        self.seen_by.setEnabled(self.mode.currentData() != "ok")

    def value_fields(self) -> dict[str, Any] | None:
        """Fields of the request; None while the offset is refused."""
        fields: dict[str, Any] = {"channel": self.channel, "mode": self.mode.currentData()}
        if fields["mode"] == "offset":
            offset = self.value.value()
            if offset is None:
                return None
            fields["value"] = offset
        return {**fields, "seen_by": self.seen_by.currentData()}

    def show_fault(self, fault: dict[str, Any]) -> None:
        """Show what is in force."""
        self.mode.setCurrentIndex(self.mode.findData(fault.get("mode", "ok")))
        self.seen_by.setCurrentIndex(self.seen_by.findData(fault.get("seen_by", "both")))
        if fault.get("mode") == "offset":
            self.value.setValue(float(fault["value"]))


class LaboratoryTab(QWidget):
    """All stimuli."""

    def __init__(self, services: Services, live: LiveSession) -> None:
        super().__init__()
        self._services = services
        self._theme = services.theme
        self.client: LaboratoryClient | None = None
        self._last: dict[str, Any] = {}
        self._shown = False
        self.teaching = label(
            self.tr(
                "Everything here happens to the simulated rig only, as it would in reality: trips are real "
                "trips of the watchdog, journaled and to be acknowledged. By command: rigctl laboratory."
            ),
            "muted",
            wrap=True,
        )
        self.news = label(wrap=True)
        self.news.setObjectName("lab-news")
        self.news.hide()
        column = QVBoxLayout()
        column.setSpacing(self._theme.px(1))
        top = QHBoxLayout()
        top.setSpacing(self._theme.px(2))
        top.addWidget(self._chain(), 1)
        top.addWidget(self._plant(), 1)
        column.addLayout(top)
        column.addWidget(self._sensors())
        column.addWidget(self._in_force())
        column.addStretch(1)
        inside = QWidget()
        inside.setLayout(column)
        column.setContentsMargins(0, 0, 0, 0)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(*(self._theme.px(1),) * 4)
        layout.setSpacing(self._theme.px(1))
        layout.addWidget(self.teaching)
        layout.addWidget(self.news)
        layout.addWidget(scrolled(inside), 1)
        self._look = QTimer(self)
        self._look.setInterval(_LOOK_MS)
        self._look.timeout.connect(self._on_look)
        live.began.connect(self._on_began)
        live.ended.connect(self._on_ended)
        if live.session is not None:
            self._on_began(live.session)
        self._show({})

    # -- build -----------------------------------------------------------------------------------

    def _chain(self) -> QWidget:
        self.estop = QPushButton()
        self.estop.setObjectName("lab-estop")
        self.doors = QPushButton()
        self.doors.setObjectName("lab-doors")
        self.vent = QPushButton()
        self.vent.setObjectName("lab-vent")
        for button, do, field, tip in (
            (self.estop, "estop", "pressed", self.tr("Hard-wired: torque off and pressure vented at once")),
            (self.doors, "doors", "open", self.tr("Hard-wired: torque off and pressure vented at once")),
            (self.vent, "vent_valve", "stuck", self.tr("The pressure stays when the relay opens")),
        ):
            button.setCheckable(True)
            button.setToolTip(tip)
            button.toggled.connect(lambda on, do=do, field=field: self._on_switch(do, field, on))
        panel = Panel(self._theme, self.tr("Safety chain and valves"))
        for button in (self.estop, self.doors, self.vent):
            panel.body.addWidget(button)
        panel.body.addStretch(1)
        return panel

    def _plant(self) -> QWidget:
        self.disc = ValueField(self._theme, NumberRange(0.0, 700.0, "°C", 0), 120.0)
        self.disc.setObjectName("lab-disc")
        self.weight = ValueField(self._theme, NumberRange(-1200.0, 1200.0, "N·m", 1), 0.0)
        self.weight.setObjectName("lab-weight")
        self.drift = ValueField(self._theme, NumberRange(-6.0, 6.0, "dB", 2), 0.0)
        self.drift.setObjectName("lab-drift")
        self.disc.committed.connect(lambda value: self.ask("disc", degc=value))
        self.weight.committed.connect(lambda value: self.ask("weight", torque_nm=value))
        self.drift.committed.connect(lambda value: self.ask("microphone", drift_db=value))
        self.calibrator = QComboBox()
        self.calibrator.setObjectName("lab-calibrator")
        for level, text in ((0, self.tr("none")), (94, "94\u202fdB"), (114, "114\u202fdB")):
            self.calibrator.addItem(text, level)
        self.calibrator.activated.connect(
            lambda _index: self.ask("calibrator", level_db=self.calibrator.currentData())
        )
        form = Form(self._theme)
        form.add(self.tr("Disc at"), self.disc, self.tr("Set the disc to this temperature at once (Enter)"))
        form.add(self.tr("Lever puts"), self.weight, self.tr("Torque on both sensors, at standstill (Enter)"))
        form.add(self.tr("Calibrator"), self.calibrator, self.tr("On the microphone, 1 kHz"))
        form.add(self.tr("Microphone off by"), self.drift, self.tr("Its sensitivity has drifted (Enter)"))
        panel = Panel(self._theme, self.tr("Plant and microphone"))
        panel.body.addWidget(form)
        panel.body.addStretch(1)
        return panel

    def _sensors(self) -> QWidget:
        names = {
            PRESSURE: self.tr("Brake pressure"), SPEED: self.tr("Speed"), TORQUE: self.tr("Torque"),
            DISC_TEMPERATURE: self.tr("Disc temperature"),
        }  # fmt: skip
        panel = Panel(self._theme, self.tr("Sensors"))
        grid = QGridLayout()
        grid.setHorizontalSpacing(self._theme.px(2))
        grid.setVerticalSpacing(self._theme.px(1))
        grid.setColumnStretch(1, 1)
        self.sensors: dict[str, SensorRow] = {}
        for number, (channel, name) in enumerate(names.items()):
            row = SensorRow(self._theme, channel)
            row.apply.setToolTip(self.tr("Do this to the sensor now"))
            row.apply.clicked.connect(partial(self._on_sensor, row))
            grid.addWidget(label(name), number, 0)
            grid.addWidget(row, number, 1)
            self.sensors[channel] = row
        panel.body.addLayout(grid)
        return panel

    def _in_force(self) -> QWidget:
        self.force = label(wrap=True)
        self.force.setObjectName("lab-force")
        self.truth = label("", "muted", wrap=True)
        self.live = QCheckBox(self.tr("Look every second"))
        self.live.setChecked(True)
        self.live.setToolTip(self.tr("Ask the rig what is in force"))
        self.clear = QPushButton(self.tr("Mend &all"))
        self.clear.setObjectName("lab-clear")
        self.clear.setProperty("look", "primary")
        self.clear.setToolTip(self.tr("End everything that is in force; the disc keeps its temperature"))
        self.clear.clicked.connect(lambda: self.ask("clear"))
        panel = Panel(self._theme, self.tr("In force"))
        panel.body.addWidget(self.force)
        panel.body.addWidget(self.truth)
        row = QHBoxLayout()
        row.addWidget(self.clear)
        row.addStretch(1)
        row.addWidget(self.live)
        panel.body.addLayout(row)
        return panel

    # -- life ------------------------------------------------------------------------------------

    def activated(self) -> None:
        """Shown: look what is in force."""
        self._shown = True
        self._look.start()
        self._on_look()

    def deactivated(self) -> None:
        """Another tab or page; stimuli stay in force."""
        self._shown = False
        self._look.stop()

    def stop(self) -> None:
        """The window closes."""
        self._look.stop()
        if self.client is not None:
            self.client.close()

    def _on_began(self, session: Any) -> None:
        self._on_ended()
        if session.simulated:
            self.client = LaboratoryClient(session.run_dir, self._services.work, self)
            self.client.answered.connect(self._show)
            self.client.refused.connect(self._on_refused)
        self._show({})

    def _on_ended(self) -> None:
        if self.client is not None:
            self.client.close()
            self.client.deleteLater()
            self.client = None
        self._show({})

    # -- asking ----------------------------------------------------------------------------------

    def ask(self, do: str, **fields: Any) -> None:
        """Give a stimulus."""
        if self.client is not None:
            self.news.hide()
            self.client.ask(do, **fields)

    def _on_look(self) -> None:
        if self.client is not None and (self.live.isChecked() or not self._last):
            self.client.look()

    def _on_switch(self, do: str, field: str, on: bool) -> None:
        self.ask(do, **{field: on})

    def _on_sensor(self, row: SensorRow) -> None:
        fields = row.value_fields()
        if fields is not None:
            self.ask("sensor", **fields)

    def _on_refused(self, why: str) -> None:
        set_look(self.news, "error")
        self.news.setText("▲ " + why.removeprefix("fault laboratory: "))
        self.news.show()
        self._show(self._last)

    def _show(self, answer: dict[str, Any]) -> None:
        before, self._last = self._last, answer
        for widget in (self.estop, self.doors, self.vent, self.clear, self.calibrator, self.disc, self.weight,
                       self.drift, *self.sensors.values()):  # fmt: skip
            widget.setEnabled(bool(answer))
        self._show_switches(answer)
        if not answer:
            self.force.setText(self.tr("No simulated rig is connected."))
            self.truth.setText("")
            return
        self._show_inputs(answer, before)
        lines = in_force(answer)
        self.force.setText("\n".join(lines) or self.tr("Nothing is disturbed."))
        truth = answer["truth"]
        self.truth.setText(
            self.tr("Truth behind the sensors: {0} 1/min, {1} bar, {2} N·m, {3} °C").format(
                number_text(truth["speed_rpm"], 1), number_text(truth["pressure_bar"], 2),
                number_text(truth["torque_nm"], 1), number_text(truth["disc_degc"], 1),
            )
        )  # fmt: skip

    def _show_switches(self, answer: dict[str, Any]) -> None:
        stop = (self.tr("Press the &emergency stop"), self.tr("Emergency stop is pressed: r&elease it"))
        doors = (self.tr("Open the &doors"), self.tr("&Doors are open: close them"))
        vent = (self.tr("Let the &vent valve stick"), self.tr("&Vent valve sticks: mend it"))
        for button, key, texts in (
            (self.estop, "estop_pressed", stop), (self.doors, "doors_open", doors),
            (self.vent, "vent_valve_stuck", vent),
        ):  # fmt: skip
            on = bool(answer.get(key))
            with QSignalBlocker(button):  # what is told is no order
                button.setChecked(on)
            button.setText(texts[on])

    def _show_inputs(self, answer: dict[str, Any], before: dict[str, Any]) -> None:
        """Inputs follow what others do, and are left alone while nothing changes."""
        if answer["calibrator_db"] != before.get("calibrator_db"):
            self.calibrator.setCurrentIndex(max(self.calibrator.findData(round(answer["calibrator_db"])), 0))
        for key, field in (("weight_nm", self.weight), ("drift_db", self.drift)):
            if answer[key] != before.get(key) and not field.edit.hasFocus():
                field.setValue(answer[key])
        for channel, row in self.sensors.items():
            if answer["sensors"].get(channel) != before.get("sensors", {}).get(channel):
                row.show_fault(answer["sensors"].get(channel, {}))

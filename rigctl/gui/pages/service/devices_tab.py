"""The devices of the rig: who they are, what they say now, what is set in an unsafe way.

Job: one card for each role, from the session that is watched or from `rigctl devices test` in a process of
its own. Not its job: asking devices (`rigctl.app.devices`), what is known of them (`devices_list`).
"""

from __future__ import annotations

import sys
import time
from pathlib import Path
from typing import Any

from PySide6.QtCore import QProcess, Qt, QTimer
from PySide6.QtWidgets import (
    QComboBox,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.pages.manual.rigs import RigChoice, list_rigs
from rigctl.gui.pages.service.devices_list import (
    DeviceRow,
    rows_of_session,
    rows_of_test,
    values_of_state,
)
from rigctl.gui.pages.service.live_session import LiveSession
from rigctl.gui.pages.service.parts import Panel, label, scrolled, set_look
from rigctl.gui.rig.state import RigState
from rigctl.gui.services import Services
from rigctl.gui.theme import ThemeKeeper

_REFRESH_MS = 500


class DeviceCard(Panel):
    """One device."""

    def __init__(self, theme: ThemeKeeper, title: str) -> None:
        super().__init__(theme, title)
        self.kind = label("", "muted")
        self.result = label()
        head = QHBoxLayout()
        self.body.removeWidget(self.title)
        head.addWidget(self.title)
        head.addWidget(self.kind)
        head.addStretch(1)
        head.addWidget(self.result)
        self.identity = label("", "muted", wrap=True)
        self._values = QGridLayout()
        self._values.setHorizontalSpacing(theme.px(2))
        self._values.setVerticalSpacing(theme.px(0.5))
        self._values.setColumnStretch(1, 1)
        self._values.setColumnStretch(3, 1)
        self._names: list[tuple[QLabel, QLabel]] = []
        self.findings = label(wrap=True)
        self.findings.setTextFormat(Qt.TextFormat.RichText)
        self.body.addLayout(head)
        self.body.addWidget(self.identity)
        self.body.addLayout(self._values)
        self.body.addWidget(self.findings)

    def show_row(self, row: DeviceRow) -> None:
        """Show what is known."""
        words = {
            "ok": self.tr("test passed"), "warning": self.tr("▲ look at the warnings"),
            "failed": self.tr("▲ failed"), "simulated": self.tr("simulated, no wires"),
        }  # fmt: skip
        looks = {"warning": "warning", "failed": "alarm"}
        self.kind.setText(row.kind)
        self.result.setText(words.get(row.result, ""))
        set_look(self.result, looks.get(row.result, "muted"))
        self.identity.setText(row.identity_text)
        self.identity.setVisible(bool(row.identity))
        self.show_values(row.values)
        t = self._theme.current
        lines = []
        for finding in row.findings:
            mark, colour = (self.tr("▲ unsafe: "), t.red) if finding.unsafe else ("△ ", t.text)
            lines.append(
                f'<span style="color:{colour}">{mark}{_escaped(finding.words)}</span> '
                f'<span style="color:{t.muted}">{_escaped(finding.remedy)}</span>'
            )
        self.findings.setText("<br>".join(lines))
        self.findings.setVisible(bool(lines))

    def show_values(self, values: tuple[tuple[str, str], ...]) -> None:
        """Show newest values, two beside each other."""
        while len(self._names) < len(values):
            number = len(self._names)
            pair = (label("", "muted"), label())
            self._names.append(pair)
            pair[0].setMinimumWidth(self._theme.px(14))
            for place, part in enumerate(pair):
                self._values.addWidget(part, number // 2, 2 * (number % 2) + place)
        for number, pair in enumerate(self._names):
            there = number < len(values)
            for part, text in zip(pair, values[number] if there else ("", ""), strict=True):
                part.setVisible(there)
                if part.text() != text:
                    part.setText(text)


def test_command(rig: Path) -> list[str]:
    """The same as ``rigctl devices test RIG --json``."""
    return [sys.executable, "-m", "rigctl.app.cli", "devices", "test", str(rig), "--json"]


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


class DevicesTab(QWidget):
    """Cards and [Test devices]."""

    def __init__(self, services: Services, live: LiveSession) -> None:
        super().__init__()
        self._services = services
        self._live = live
        self._theme = services.theme
        self._process: QProcess | None = None
        self._state_at = 0.0
        self._state = RigState()
        self._rows: list[DeviceRow] = []
        self.line = label(wrap=True)
        self.line.setObjectName("devices-line")
        self.rig = QComboBox()
        self.rig.setObjectName("devices-rig")
        self.rig.setToolTip(self.tr("Rig file whose devices are tested"))
        self.rig.setMinimumContentsLength(28)
        self.rig.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.test = QPushButton(self.tr("&Test devices"))
        self.test.setObjectName("devices-test")
        self.test.setToolTip(
            self.tr("Open each device one by one and ask it; nothing moves. Same as: rigctl devices test RIG")
        )
        self.test.clicked.connect(self._toggle_test)
        row = QHBoxLayout()
        row.setSpacing(self._theme.px(1))
        row.addWidget(self.line, 1)
        row.addWidget(self.rig)
        row.addWidget(self.test)
        titles = {
            "drive": self.tr("Drive"), "pressure": self.tr("Brake pressure"),
            "ventilator": self.tr("Ventilator"), "acquisition": self.tr("Acquisition"),
            "safety": self.tr("Safety"),
        }  # fmt: skip
        self.cards = {role: DeviceCard(self._theme, title) for role, title in titles.items()}
        inside = QWidget()
        column = QVBoxLayout(inside)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(self._theme.px(1))
        for card in self.cards.values():
            column.addWidget(card)
        column.addStretch(1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(*(self._theme.px(1),) * 4)
        layout.setSpacing(self._theme.px(1))
        layout.addLayout(row)
        layout.addWidget(scrolled(inside), 1)
        self._refresh = QTimer(self)
        self._refresh.setInterval(_REFRESH_MS)
        self._refresh.timeout.connect(self._show_values)
        rig = services.rig
        live.began.connect(self._on_began)
        live.ended.connect(self._from_session)
        rig.stateChanged.connect(self._on_state)
        rig.recordsAdded.connect(self._on_records)
        self._theme.changed.connect(self._restyle)

    # -- life ------------------------------------------------------------------------------------

    def activated(self) -> None:
        """Shown: follow the values."""
        if not self.rig.count():
            folder = self._services.config_folder / "rigs"
            self._services.work.in_thread(list_rigs, folder, done=self._show_rigs, failed=self._say_error)
        self._from_session()
        self._refresh.start()

    def deactivated(self) -> None:
        """Another tab or page."""
        self._refresh.stop()

    def stop(self) -> None:
        """The window closes: a running test ends."""
        self._refresh.stop()
        if self._process is not None:
            self._process.kill()
            self._process.waitForFinished(2000)

    def _show_rigs(self, choices: list[RigChoice]) -> None:
        for choice in choices:
            if not choice.problem:
                self.rig.addItem(choice.name, choice.path)

    def _restyle(self) -> None:
        self._show_rows(self._rows)

    def _on_began(self, _session: Any) -> None:
        self._from_session()

    # -- from the session ------------------------------------------------------------------------

    def _from_session(self) -> None:
        session = self._live.session
        self.rig.setEnabled(session is None)
        self.test.setEnabled(session is None)
        if session is None:
            if not self._rows or not any(row.result for row in self._rows):
                self._rows = []
                for card in self.cards.values():
                    card.setVisible(False)
                self._say(
                    self.tr(
                        "No rig is connected. [Test devices] opens each device of a rig file one by one, "
                        "asks who it is and what is set in an unsafe way; nothing moves."
                    )
                )
            return
        words = self.tr(
            "{0}: identities from its start, values as they come. A test needs a rig that is not running."
        )
        self._say(words.format(session.rig.name))
        self._show_rows(rows_of_session(session.rig, self._services.rig.records))
        self._show_values()

    def _on_records(self, records: list[Any]) -> None:
        if any(record.kind == "rig_opened" for record in records) and self.isVisible():
            self._from_session()

    def _on_state(self, state: RigState) -> None:
        self._state, self._state_at = state, time.monotonic()

    def _show_values(self) -> None:
        if self._live.session is None or not self._state_at:
            return
        for role, values in values_of_state(self._state, time.monotonic() - self._state_at).items():
            self.cards[role].show_values(values)

    def _show_rows(self, rows: list[DeviceRow]) -> None:
        self._rows = rows
        for row in rows:
            if row.role in self.cards:
                self.cards[row.role].setVisible(True)
                self.cards[row.role].show_row(row)

    # -- test ------------------------------------------------------------------------------------

    def _toggle_test(self) -> None:
        if self._process is not None:
            self._process.kill()
            return
        path = self.rig.currentData()
        if path is None:
            self._say_error(self.tr("Choose a rig first."))
            return
        self._start(Path(path))

    def _start(self, rig: Path) -> None:
        process = QProcess(self)
        program, *arguments = test_command(rig)
        process.setProgram(program)
        process.setArguments(arguments)
        process.finished.connect(self._on_finished)
        process.errorOccurred.connect(self._on_process_error)
        self._process = process
        self.test.setText(self.tr("&Cancel the test"))
        self._say(self.tr("Testing the devices of {0} …").format(self.rig.currentText()))
        process.start()

    def _on_finished(self, code: int, status: QProcess.ExitStatus) -> None:
        process, self._process = self._process, None
        self.test.setText(self.tr("&Test devices"))
        if process is None:
            return
        text = bytes(process.readAllStandardOutput().data()).decode(errors="replace")
        errors = bytes(process.readAllStandardError().data()).decode(errors="replace").strip()
        process.deleteLater()
        if status is QProcess.ExitStatus.CrashExit:
            self._say(self.tr("The test was cancelled."))
            return
        try:
            rows = rows_of_test(text)
        except ValueError as error:
            self._say_error(errors.removeprefix("rigctl: ") or str(error))
            return
        for card in self.cards.values():
            card.setVisible(False)
        self._show_rows(rows)
        failed = [row.role for row in rows if row.result == "failed"]
        unsafe = sum(finding.unsafe for row in rows for finding in row.findings)
        if failed:
            self._say_error(self.tr("Failed: {0}.").format(", ".join(failed)))
        elif unsafe:
            self._say_error(self.tr("{0} settings are unsafe: see below.").format(unsafe))
        else:
            self._say(self.tr("All devices of {0} have answered.").format(self.rig.currentText()))

    def _on_process_error(self, error: QProcess.ProcessError) -> None:
        if error is QProcess.ProcessError.FailedToStart:
            self._process = None
            self.test.setText(self.tr("&Test devices"))
            self._say_error(self.tr("The test could not be started."))

    def _say(self, text: str) -> None:
        set_look(self.line, "")
        self.line.setText(text)

    def _say_error(self, text: str) -> None:
        set_look(self.line, "error")
        self.line.setText("▲ " + text)

"""What the run does just now: phase in words, time left, end, how fast rig time runs.

Job: one calm block of text above map and traces. Not its job: computing it (`pace`, connection).
"""

from __future__ import annotations

from datetime import datetime

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QGridLayout, QLabel, QProgressBar, QSizePolicy, QVBoxLayout, QWidget

from rigctl.gui.format import time_text
from rigctl.gui.pages.run.model import RunModel
from rigctl.gui.pages.run.pace import end_text
from rigctl.gui.pages.run.rows import RowState
from rigctl.gui.rig.phases import said
from rigctl.gui.rig.state import RigState
from rigctl.gui.theme import ThemeKeeper


class StatusPanel(QWidget):
    """`show_run` is its input."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self.setProperty("look", "panel")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self._theme = theme
        self.phase = QLabel()
        self.phase.setObjectName("run-phase")
        self.phase.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.what = QLabel()
        self.what.setObjectName("run-what")
        self.what.setProperty("look", "muted")
        self.bar = QProgressBar()
        self.bar.setObjectName("run-bar")
        self.bar.setTextVisible(False)
        self._names: list[QLabel] = []
        self.left, self.end, self.factor, self.counts = QLabel(), QLabel(), QLabel(), QLabel()
        grid = QGridLayout()
        for column, (name, value, text, tip) in enumerate((
            ("run-left", self.left, self.tr("Time left"),
             self.tr("Estimated from the program and the pace so far")),
            ("run-end", self.end, self.tr("End about"), self.tr("Local time")),
            ("run-factor", self.factor, self.tr("Rig time"),
             self.tr("How many seconds of rig time pass in one second")),
            ("run-counts", self.counts, self.tr("Complete"), self.tr("Complete brakings of all")),
        )):  # fmt: skip
            label = QLabel(text)
            label.setProperty("look", "muted")
            value.setObjectName(name)
            value.setToolTip(tip)
            self._names.append(label)
            grid.addWidget(label, 0, column)
            grid.addWidget(value, 1, column)
        self._grid = grid
        self._column = QVBoxLayout(self)
        self._column.addWidget(self.phase)
        self._column.addWidget(self.what)
        self._column.addWidget(self.bar)
        self._column.addLayout(grid)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        t = self._theme
        self._column.setContentsMargins(*(t.px(1),) * 4)
        self._column.setSpacing(t.px(0.5))
        self._grid.setHorizontalSpacing(t.px(3))
        self._grid.setVerticalSpacing(0)
        self.phase.setFont(t.font("normal", bold=True))
        self.bar.setFixedHeight(t.px(1))
        for label in (*self._names, self.what):
            label.setFont(t.font("small"))

    def show_run(self, state: RigState, model: RunModel, factor: float | None, now: datetime) -> None:
        """The newest state."""
        program = state.mode == "program"
        self.phase.setText(said(state.phase) or self.tr("Waiting for the controller"))
        self.what.setText(self._what(state, model))
        total = len(model.rows)
        done = model.count(RowState.COMPLETE)
        self.bar.setVisible(program)
        if (self.bar.maximum(), self.bar.value()) != (max(total, 1), done):  # each call paints at once
            self.bar.setRange(0, max(total, 1))
            self.bar.setValue(done)
        self.left.setText(time_text(state.left_s))
        self.end.setText("—" if state.left_s is None else end_text(now, state.left_s))
        self.factor.setText(self.tr("by the clock") if state.time == "real" else _factor(factor))
        self.counts.setText(self.tr("{0} of {1}").format(done, total))

    def _what(self, state: RigState, model: RunModel) -> str:
        row = model.row(state.braking or model.present)
        if row is None:
            return ""
        parts = [self.tr("Braking {0}").format(row.index), row.sequence]
        if row.pressure_bar is not None:
            parts.append(f"{row.pressure_bar:g}\u202fbar")
        if row.speed_rpm is not None:
            parts.append(f"{row.speed_rpm:g}\u202f1/min")
        if row.temperature_degc is not None:
            parts.append(f"{row.temperature_degc:g}\u202f°C")
        if model.hold_asked:
            parts.append(self.tr("waits after this braking"))
        return "  ·  ".join(part for part in parts if part)


def _factor(factor: float | None) -> str:
    if factor is None:
        return "—"
    return f"{factor:.0f} ×" if factor >= 10 else f"{factor:.1f} ×"

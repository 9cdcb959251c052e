"""The end of a run: how it ended, once, what is not complete, and what to do next.

Job: words for a `RunEnd`, [Resume] with a reason where a trip wants one, ways to data and report. Not its
job: how it ended (`model`), resuming (connection).
"""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from rigctl.engine.state import Outcome
from rigctl.gui.pages.run.model import RunEnd, RunModel
from rigctl.gui.rig.phases import said
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.inline import AskLine

SHOWN = 12


class ResultPanel(QWidget):
    """`show_end` is its input; hidden while a run goes on."""

    resumeAsked = Signal(str)
    dataAsked = Signal()
    reportAsked = Signal()
    otherAsked = Signal()
    resetAsked = Signal(str)

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self.setObjectName("run-result")
        self.setProperty("look", "panel")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self._theme = theme
        self._tripped = False
        self._told: tuple[object, ...] = ()
        self.title = QLabel()
        self.title.setObjectName("run-outcome")
        self.title.setWordWrap(True)
        self.text = QLabel()
        self.text.setObjectName("run-outcome-text")
        self.text.setWordWrap(True)
        self.news = QLabel()
        self.news.setObjectName("run-refused")
        self.news.setProperty("look", "error")
        self.news.setWordWrap(True)
        self.news.hide()
        self.resume = self._button("resume", self.tr("&Resume"), self.tr("Do what is not complete"))
        self.resume.setProperty("look", "primary")
        self.reset = self._button(
            "run-reset", self.tr("Rese&t…"), self.tr("Acknowledge the trip in your words, without going on")
        )
        self.data = self._button(
            "open-data", self.tr("Open &data"), self.tr("This campaign on the Data page")
        )
        self.report = self._button("open-report", self.tr("Open re&port"), self.tr("There is none yet"))
        self.other = self._button(
            "other-run", self.tr("&Other programs"), self.tr("Programs and campaigns that can be run")
        )
        self.reason = AskLine(theme, "resume-reason", self.tr("Resume"))
        self.reason.done.setToolTip(self.tr("Go on with the first braking that is not complete"))
        self._row = QHBoxLayout()
        for button in (self.resume, self.reset, self.data, self.report, self.other):
            self._row.addWidget(button)
        self._row.addStretch(1)
        self._column = QVBoxLayout(self)
        self._column.addWidget(self.title)
        self._column.addWidget(self.text)
        self._column.addLayout(self._row)
        self._column.addWidget(self.news)
        self._column.addWidget(self.reason)
        self.reset_reason = AskLine(theme, "run-reset-reason", self.tr("Reset"))
        self.reset_reason.done.setToolTip(self.tr("Put it into the journal (Enter)"))
        self.reset_reason.given.connect(self.resetAsked)
        self._column.addWidget(self.reset_reason)
        self.reset.clicked.connect(self._on_reset)
        self.resume.clicked.connect(self._on_resume)
        self.reason.given.connect(self.resumeAsked)
        self.data.clicked.connect(self.dataAsked)
        self.report.clicked.connect(self.reportAsked)
        self.other.clicked.connect(self.otherAsked)
        theme.changed.connect(self._restyle)
        self._restyle()
        self.hide()

    def _button(self, name: str, text: str, tip: str) -> QPushButton:
        button = QPushButton(text)
        button.setObjectName(name)
        button.setToolTip(tip)
        return button

    def _restyle(self) -> None:
        self._column.setContentsMargins(*(self._theme.px(1),) * 4)
        self._column.setSpacing(self._theme.px(1))
        self._row.setSpacing(self._theme.px(1))
        self.title.setFont(self._theme.font("normal", bold=True))

    def setNews(self, text: str) -> None:
        """Why something was refused, e.g. the report is still being made; "" for nothing."""
        self.news.setText("▲ " + text if text else "")
        self.news.setVisible(bool(text))

    def show_end(
        self, end: RunEnd | None, model: RunModel, report: Path | None, *, tripped: bool = False
    ) -> None:
        """How the run ended; None while it goes on. `tripped`: the trip has not been reset yet."""
        self.setVisible(end is not None)
        self.reset.setVisible(tripped)
        if not tripped:
            self.reset_reason.hide()
        if end is None:
            self.reason.hide()
            self.setNews("")
            return
        there = report is not None and report.is_file()
        told = (end, tuple(model.not_done()), len(model.rows), there)
        if told == self._told:
            return
        self._told = told
        self._tripped = end.outcome is Outcome.TRIPPED
        bad = end.outcome in (Outcome.TRIPPED, Outcome.FAILED)
        total = len(model.rows)
        self.title.setText(("▲ " if bad else "") + self._outcome(end.outcome, end.done, total))
        self.title.setProperty("look", "alarm" if bad else "title")
        self.title.style().polish(self.title)
        self.text.setText("\n".join(line for line in self._lines(end, model) if line))
        self.resume.setVisible(end.done < total)
        self.report.setEnabled(there)
        self.report.setToolTip(
            self.tr("Figures and report of the campaign, in the browser")
            if there
            else self.tr("There is no report yet; it is made at the end of a run.")
        )

    def _outcome(self, outcome: Outcome, done: int, total: int) -> str:
        words = {
            Outcome.FINISHED: self.tr("The program is through: {0} of {1} brakings are complete."),
            Outcome.STOPPED: self.tr("Stopped by the operator: {0} of {1} brakings are complete."),
            Outcome.TRIPPED: self.tr("Stopped by the watchdog: {0} of {1} brakings are complete."),
            Outcome.FAILED: self.tr("The run has failed: {0} of {1} brakings are complete."),
        }
        return words[outcome].format(done, total)

    def _lines(self, end: RunEnd, model: RunModel) -> list[str]:
        lines: list[str] = []
        if end.outcome in (Outcome.TRIPPED, Outcome.FAILED):
            lines += [said(end.cause), said(end.remedy)]
        numbers = model.not_done()
        if numbers:
            shown = ", ".join(map(str, numbers[:SHOWN])) + (" …" if len(numbers) > SHOWN else "")
            lines.append(self.tr("Tried but not complete: {0}.").format(shown))
        return lines

    def _on_reset(self) -> None:
        self.reason.hide()
        self.reset_reason.ask(
            self.tr("What was the cause, and what was done? It goes into the journal."),
            self.tr("e.g. vent valve was closed; opened it"),
        )

    def _on_resume(self) -> None:
        self.reset_reason.hide()
        if self._tripped:
            self.reason.ask(
                self.tr("What was the cause, and what was done? The watchdog wants it before it arms again."),
                self.tr("e.g. vent valve was closed; opened it"),
            )
        else:
            self.resumeAsked.emit("")

"""The run page without a run: what it is for, programs to begin with, campaigns to go on with.

Job: two lists with a button each row. Not its job: reading them (`campaigns`), starting (connection).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.pages.run.campaigns import OpenCampaign, ProgramChoice
from rigctl.gui.theme import ThemeKeeper
from rigctl.gui.widgets.inline import AskLine


class StartPanel(QWidget):
    """Programs and open campaigns."""

    programChosen = Signal(object)
    """Path of a program file, to be looked at on the Sequence page."""
    resumeAsked = Signal(object, str)
    """Campaign folder, and the reason where a trip wants one."""
    manualAsked = Signal()

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self.setObjectName("run-start")
        self._theme = theme
        self._waiting: Path | None = None
        self.title = QLabel(self.tr("Run a program"))
        self.teaching = QLabel(
            self.tr(
                "A program is a list of brakings that the rig carries out by itself, for minutes or nights."
                " Choose one to look at it, change it and start it on the Sequence page. Here you watch it:"
                " the table of brakings, the map of squeal, pause, skip, repeat, abort."
            )
        )
        self.teaching.setWordWrap(True)
        self.busy = QLabel()
        self.busy.setObjectName("run-start-news")
        self.busy.setWordWrap(True)
        self.busy.hide()
        self.programs = QGridLayout()
        self.campaigns = QGridLayout()
        self.programs_title = QLabel(self.tr("Programs"))
        self.campaigns_title = QLabel(self.tr("Not complete yet"))
        self.no_campaigns = QLabel(self.tr("No campaign waits to be completed."))
        self.no_campaigns.setProperty("look", "muted")
        self.reason = AskLine(theme, "campaign-reason", self.tr("Resume"))
        self.reason.done.setToolTip(self.tr("Go on with the first braking that is not complete"))
        self.reason.given.connect(self._on_reason)
        self._build()
        theme.changed.connect(self._restyle)
        self._restyle()

    def _build(self) -> None:
        box = QWidget()
        box.setProperty("look", "panel")
        box.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self._column = QVBoxLayout(box)
        for item in (self.title, self.teaching, self.busy, self.programs_title):
            self._column.addWidget(item)
        self._column.addLayout(self.programs)
        self._column.addWidget(self.campaigns_title)
        self._column.addWidget(self.no_campaigns)
        self._column.addLayout(self.campaigns)
        self._column.addWidget(self.reason)
        self._column.addStretch(1)
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setFrameShape(QFrame.Shape.NoFrame)
        area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        area.setWidget(box)
        outer = QVBoxLayout(self)
        outer.addWidget(area)
        self._outer = outer

    def _restyle(self) -> None:
        t = self._theme
        self._outer.setContentsMargins(*(t.px(1),) * 4)
        self._column.setContentsMargins(*(t.px(3),) * 4)
        self._column.setSpacing(t.px(2))
        self.title.setFont(t.font("large", bold=True))
        for label in (self.programs_title, self.campaigns_title):
            label.setFont(t.font("normal", bold=True))
        for grid in (self.programs, self.campaigns):
            grid.setHorizontalSpacing(t.px(2))
            grid.setVerticalSpacing(t.px(1))

    def showEvent(self, event: QShowEvent) -> None:
        """Fonts of labels in a scroll area get lost when it is put into a window with a style sheet."""
        super().showEvent(event)
        self._restyle()

    # -- value ------------------------------------------------------------------------------------

    def setPrograms(self, choices: Sequence[ProgramChoice]) -> None:
        """Programs that can be chosen."""
        _clear(self.programs)
        for line, choice in enumerate(choices):
            open_it = QPushButton(self.tr("Open"))
            open_it.setObjectName(f"program-{choice.path.stem}")
            open_it.setToolTip(self.tr("Look at it and start it on the Sequence page"))
            open_it.clicked.connect(partial(self.programChosen.emit, choice.path))
            name = QLabel(choice.name)
            words = choice.description.split("\n")[0]
            count = self.tr("{0} brakings").format(choice.count) if not choice.problem else ""
            about = QLabel("▲ " + choice.problem if choice.problem else words)
            about.setProperty("look", "error" if choice.problem else "muted")
            about.setWordWrap(True)
            for column, widget in enumerate((name, QLabel(count), about, open_it)):
                self.programs.addWidget(widget, line, column)
        self.programs.setColumnStretch(2, 1)

    def setCampaigns(self, campaigns: Sequence[OpenCampaign]) -> None:
        """Campaigns that are not complete."""
        _clear(self.campaigns)
        self.no_campaigns.setVisible(not campaigns)
        for line, campaign in enumerate(campaigns):
            go_on = QPushButton(self.tr("Resume"))
            go_on.setObjectName(f"resume-{campaign.path.name}")
            go_on.setToolTip(self.tr("Go on with the first braking that is not complete"))
            go_on.clicked.connect(partial(self._on_resume, campaign))
            about = QLabel("▲ " + campaign.trip if campaign.trip else campaign.rig)
            about.setProperty("look", "error" if campaign.trip else "muted")
            about.setWordWrap(True)
            count = QLabel(self.tr("{0} of {1}").format(campaign.done, campaign.total))
            for column, widget in enumerate((QLabel(campaign.path.name), count, about, go_on)):
                self.campaigns.addWidget(widget, line, column)
        self.campaigns.setColumnStretch(2, 1)

    def setNews(self, text: str, look: str = "") -> None:
        """A line above the lists, e.g. that a controller is starting."""
        self.busy.setText(text)
        self.busy.setVisible(bool(text))
        self.busy.setProperty("look", look)
        self.busy.style().polish(self.busy)

    def _on_resume(self, campaign: OpenCampaign, _checked: bool = False) -> None:
        if not campaign.trip:
            self.resumeAsked.emit(campaign.path, "")
            return
        self._waiting = campaign.path
        self.reason.ask(
            self.tr("{0} ended with a trip: {1} What was the cause, and what was done?").format(
                campaign.path.name, campaign.trip
            ),
            self.tr("e.g. vent valve was closed; opened it"),
        )

    def _on_reason(self, reason: str) -> None:
        if self._waiting is not None:
            self.resumeAsked.emit(self._waiting, reason)


def _clear(grid: QGridLayout) -> None:
    while (item := grid.takeAt(0)) is not None:
        widget = item.widget()
        if widget is not None:
            widget.hide()
            widget.deleteLater()

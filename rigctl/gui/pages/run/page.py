"""The run page: table of brakings at the left, squeal map and traces at the right, verbs below.

Job: follow a session, feed model, table and map, turn verbs, notes and ratings into commands. Not its job:
what has happened (`model`), what may be asked (`verbs`), how the parts look.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

from PySide6.QtCore import QSettings, Qt, QTimer, QUrl
from PySide6.QtGui import QDesktopServices, QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QSplitter,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from rigctl.core.errors import RigctlError
from rigctl.gui.pages.base import Page
from rigctl.gui.pages.run.campaigns import list_open_campaigns, list_programs
from rigctl.gui.pages.run.map_view import OccurrenceView
from rigctl.gui.pages.run.model import RunModel
from rigctl.gui.pages.run.pace import Pace
from rigctl.gui.pages.run.result_panel import ResultPanel
from rigctl.gui.pages.run.rows import Row, rows_of
from rigctl.gui.pages.run.start_panel import StartPanel
from rigctl.gui.pages.run.status_panel import StatusPanel
from rigctl.gui.pages.run.summaries import SummaryReader
from rigctl.gui.pages.run.table import BrakingTable, BrakingTableModel
from rigctl.gui.pages.run.verb_row import VerbRow
from rigctl.gui.rig.state import RigState, Word
from rigctl.gui.services import Services
from rigctl.gui.widgets.live_slot import LiveSlot
from rigctl.gui.widgets.rating_row import RATINGS

CHUNK = 1000
"""Rows of a program made, or records folded, per turn of the event loop: 15 to 30 ms."""
MAP_EVERY_MS = 500


class RunPage(Page):
    """Watches and holds a program."""

    def __init__(self, services: Services) -> None:
        super().__init__(services)
        theme = services.theme
        self.model = RunModel()
        self.pace = Pace()
        self.campaign: Path | None = None
        self._plan: Iterator[Row] | None = None
        self._records: list[Any] = []  # still to be folded
        self._live = False  # a session is watched and its controller is there
        self._wanted = False  # the start panel although there is a run to look at
        self.reader = SummaryReader(services.work, self)
        self.table_model = BrakingTableModel(theme, self.model)
        self.table = BrakingTable(theme, self.table_model)
        self.map = OccurrenceView(services)
        self.live = LiveSlot(services, ("trend",), hidden=("row-temperatures", "row-mu"))
        self.status = StatusPanel(theme)
        self.verbs = VerbRow(theme)
        self.result = ResultPanel(theme)
        self.start = StartPanel(theme)
        self._planner = QTimer(self)
        self._planner.setInterval(0)
        self._planner.timeout.connect(self._go_on)
        self._map_timer = QTimer(self)
        self._map_timer.setInterval(MAP_EVERY_MS)
        self._map_timer.timeout.connect(self.map.refresh)
        self._build()
        self._wire()
        theme.changed.connect(self._restyle)
        self._restyle()
        rig = services.rig
        if rig.session is not None:
            self._on_attached(rig.session)
            self._on_records(rig.records)
            self._live = rig.state.word not in (Word.OFFLINE, Word.TRIPPED)
        self._show_state(rig.state)

    # -- building ---------------------------------------------------------------------------------

    def _build(self) -> None:
        self.count = QLabel()
        self.count.setObjectName("run-count")
        self.count.setProperty("look", "title")
        self.count.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.follow = QPushButton(self.tr("Follow"))
        self.follow.setObjectName("run-follow")
        self.follow.setCheckable(True)
        self.follow.setChecked(True)
        self.follow.setToolTip(self.tr("Keep the present braking in sight; scrolling by hand ends it"))
        self._head = QHBoxLayout()
        self._head.addWidget(self.count, 1)
        self._head.addWidget(self.follow)
        left = QWidget()
        self._left_column = QVBoxLayout(left)
        self._left_column.setContentsMargins(0, 0, 0, 0)
        self._left_column.addLayout(self._head)
        self._left_column.addWidget(self.table, 1)
        self.right = QSplitter(Qt.Orientation.Vertical)
        self.right.setObjectName("run-right")
        self.right.setChildrenCollapsible(False)
        for place, widget in enumerate((self.map, self.live)):
            self.right.addWidget(widget)
            self.right.setStretchFactor(place, 1)
        self.right.setSizes([1000, 1000])
        right = QWidget()
        self._right_column = QVBoxLayout(right)
        self._right_column.setContentsMargins(0, 0, 0, 0)
        self._right_column.addWidget(self.status)
        self._right_column.addWidget(self.right, 1)
        self.splitter = QSplitter(Qt.Orientation.Horizontal)
        self.splitter.setObjectName("run-splitter")
        self.splitter.setChildrenCollapsible(False)
        self.splitter.addWidget(left)
        self.splitter.addWidget(right)
        self.splitter.setStretchFactor(0, 4)
        self.splitter.setStretchFactor(1, 3)
        self.splitter.setSizes([4000, 3000])
        console = QWidget()
        self._console_column = QVBoxLayout(console)
        self._console_column.addWidget(self.result)
        self._console_column.addWidget(self.splitter, 1)
        self._console_column.addWidget(self.verbs)
        self.scenes = QStackedWidget()
        self.scenes.addWidget(self.start)
        self.scenes.addWidget(console)
        self._console = console
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self.scenes)

    def _restyle(self) -> None:
        t = self.services.theme
        self._console_column.setContentsMargins(*(t.px(1),) * 4)
        for layout in (self._console_column, self._left_column, self._right_column, self._head):
            layout.setSpacing(t.px(1))
        self._right_column.setContentsMargins(t.px(1), 0, 0, 0)
        self._left_column.setContentsMargins(0, 0, t.px(1), 0)
        for splitter in (self.splitter, self.right):
            splitter.setHandleWidth(t.px(0.25))
        self.map.setMinimumHeight(t.px(16))
        self.live.setMinimumHeight(t.px(10))

    def _wire(self) -> None:
        rig = self.services.rig
        rig.stateChanged.connect(self._show_state)
        rig.recordsAdded.connect(self._on_records)
        rig.attached.connect(self._on_attached)
        rig.detached.connect(self._on_detached)
        rig.refused.connect(self._on_refused)
        self.reader.read.connect(self._on_summaries)
        self.reader.failed.connect(self.services.notify)
        self.table.opened.connect(self._open_row)
        self.table.followChanged.connect(self.follow.setChecked)
        self.follow.clicked.connect(self.table.setFollow)
        self.map.clicked.connect(self._open_braking)
        self.verbs.asked.connect(rig.verb)
        self.verbs.takeCommandAsked.connect(rig.take_command)
        self.verbs.noteGiven.connect(rig.note)
        self.verbs.rated.connect(rig.rate)
        self.result.resumeAsked.connect(self._resume_this)
        self.result.dataAsked.connect(lambda: self.services.navigate("data", campaign=self.campaign))
        self.result.reportAsked.connect(self._open_report)
        self.result.otherAsked.connect(self._show_others)
        self.result.resetAsked.connect(rig.reset)
        self.start.programChosen.connect(lambda path: self.services.navigate("sequence", program=path))
        self.start.resumeAsked.connect(self._resume)
        self._key("N", self._open_note)
        for rating in RATINGS:
            self._key(str(rating), partial(self._rate, rating))

    def _key(self, key: str, action: Callable[[], object]) -> None:
        shortcut = QShortcut(QKeySequence(key), self, context=Qt.ShortcutContext.WidgetWithChildrenShortcut)
        shortcut.activated.connect(action)

    # -- life of the page -------------------------------------------------------------------------

    def activated(self) -> None:
        """Programs and campaigns are read anew; map and traces run."""
        self._read_lists()
        self._map_timer.start()
        self.map.refresh()
        self._show_scene()

    def deactivated(self) -> None:
        """Map and traces rest; the table keeps up."""
        self._map_timer.stop()
        self.live.stop()

    def save_layout(self, settings: QSettings) -> None:
        """Where the parts end."""
        settings.setValue("columns", self.splitter.saveState())
        settings.setValue("right", self.right.saveState())
        settings.setValue("table", self.table.horizontalHeader().saveState())
        self.live.save_layout(settings)

    def restore_layout(self, settings: QSettings) -> None:
        """As left."""
        for key, part in (
            ("columns", self.splitter), ("right", self.right), ("table", self.table.horizontalHeader()),
        ):  # fmt: skip
            state = settings.value(key)
            if state is not None:
                part.restoreState(state)
        self.live.restore_layout(settings)

    def _read_lists(self) -> None:
        work, services = self.services.work, self.services
        work.in_thread(
            list_programs, services.config_folder / "programs", done=self.start.setPrograms,
            failed=services.notify,
        )  # fmt: skip
        work.in_thread(
            list_open_campaigns, services.data_folder, done=self.start.setCampaigns, failed=services.notify
        )

    # -- sessions ---------------------------------------------------------------------------------

    def _on_attached(self, session: Any) -> None:
        self._live = True
        self.campaign = Path(session.campaign)
        self.model = RunModel()
        self.pace.clear()
        self._records = []
        self._wanted = False
        self.start.setNews("")
        self.table_model.reset(self.model)
        self.table.setFollow(True)
        self.map.setValue(self.model.occurrence)
        self.reader.begin(self.campaign)
        try:
            program = session.program
        except RigctlError as error:
            self.services.notify(str(error))
            program = None
        self._plan = None if program is None else rows_of(program)
        self._go_on()

    def _go_on(self) -> None:
        """Some rows of the program; then, when all are there, some records of its journal."""
        if self._plan is not None:
            self._make_rows(self._plan)
        else:
            some, self._records = self._records[:CHUNK], self._records[CHUNK:]
            self._fold(some)
        if self._plan is not None or self._records:
            self._planner.start()
        else:
            self._planner.stop()

    def _make_rows(self, plan: Iterator[Row]) -> None:
        before = len(self.model.rows)
        rows = list(itertools.islice(plan, CHUNK))
        self.model.add(rows)
        self.table_model.grown(before)
        self.table.fit(rows)
        if len(rows) < CHUNK:
            self._plan = None

    def _on_detached(self, why: str) -> None:
        self._live = False
        self.start.setNews(why)
        if self.isVisible():
            self._read_lists()
        self._show_state(self.services.rig.state)

    def _on_refused(self, why: str) -> None:
        if self.scenes.currentWidget() is self.start:
            self.start.setNews("▲ " + why, "error")
        else:
            self.result.setNews(why)
            self.verbs.setRefusal(why)

    # -- news -------------------------------------------------------------------------------------

    def _on_records(self, records: list[Any]) -> None:
        waiting = self._plan is not None or bool(self._records)
        self._records += records
        if not waiting:
            self._go_on()
        elif not self._planner.isActive():
            self._planner.start()

    def _fold(self, records: list[Any]) -> None:
        before = len(self.model.rows)
        ended = self.model.end
        changed = self.model.fold(records)
        self.table_model.grown(before)
        self._show_changed(changed)
        unread, self.model.unread = self.model.unread, []
        self.reader.ask(unread)
        if records:
            self._show_state(self.services.rig.state)
            if self.model.end is not None and ended is None and self.isVisible():
                self._read_lists()

    def _on_summaries(self, found: list[tuple[int, Any]]) -> None:
        changed: set[int] = set()
        for index, summary in found:
            changed |= self.model.summary(index, summary)
        self._show_changed(changed)
        self.count.setText(self._count_text())

    def _show_changed(self, changed: set[int]) -> None:
        places = [place for index in changed if (place := self.model.place(index)) is not None]
        self.table_model.changed(places)

    def _show_state(self, state: RigState) -> None:
        self._show_changed(self.model.show(state))
        self.pace.see(state.rig_s, time.monotonic())
        present = self.model.place(self.model.present)
        if present is not None and present != self.table.place():
            self.table.show_present(present)
            row = self.model.rows[present]
            self.verbs.rating.setValue(row.rating)
        if self.isVisible():
            self._show_scene()

    def _show_scene(self) -> None:
        state = self.services.rig.state
        running = self._live and state.word is not Word.OFFLINE
        there = bool(self.model.rows) or running
        console = there and not (self._wanted and not running)
        self.scenes.setCurrentWidget(self._console if console else self.start)
        if state.word is Word.STARTING and not console:
            self.start.setNews(self.tr("Starting the controller …"))
        if not console or not self._map_timer.isActive():
            self.live.stop()
        else:
            self.live.start()
        if not console:
            return
        self.status.show_run(state, self.model, self.pace.factor, datetime.now())
        self.count.setText(self._count_text())
        self.verbs.setVisible(running)
        self.verbs.show_state(state, self.model.hold_asked)
        end = self.model.end if not running or state.mode == "program" else None
        report = None if self.campaign is None or end is None else self.campaign / "report" / "report.html"
        tripped = state.word is Word.TRIPPED and not state.commander
        self.result.show_end(end, self.model, report, tripped=tripped)

    def _count_text(self) -> str:
        squealing, judged = self.model.occurrence.squealing, self.model.occurrence.judged
        count = len(self.model.rows)
        text = self.tr("1 braking") if count == 1 else self.tr("{0} brakings").format(count)
        return text + self.tr(", squeal in {0} of {1}").format(squealing, judged) if judged else text

    # -- what a person does -----------------------------------------------------------------------

    def open(self, **what: Any) -> None:
        """`braking=N` shows that row."""
        place = self.model.place(int(what.get("braking", 0)))
        if place is not None:
            self.table.setFollow(False)
            self.table.selectRow(place)
            self.table.scrollTo(self.table_model.index(place, 0))

    def _open_row(self, place: int) -> None:
        self._open_braking(self.model.rows[place].index)

    def _open_braking(self, index: int) -> None:
        row = self.model.row(index)
        if row is None or self.campaign is None:
            return
        if row.attempt == 0:
            self.services.notify(self.tr("Braking {0} has no recording yet.").format(index))
            return
        self.services.navigate("data", campaign=self.campaign, braking=index)

    def _rate(self, rating: int) -> None:
        if self.verbs.isVisible():
            self.verbs.rating.give(rating)

    def _open_note(self) -> None:
        if self.verbs.isVisible():
            self.verbs.open_note()

    def _resume_this(self, reason: str) -> None:
        if self.campaign is not None:
            self._resume(self.campaign, reason)

    def _resume(self, campaign: Path, reason: str) -> None:
        self.result.setNews("")
        self.services.rig.resume(campaign, reason)

    def _open_report(self) -> None:
        if self.campaign is not None:
            path = self.campaign / "report" / "report.html"
            QDesktopServices.openUrl(QUrl.fromLocalFile(str(path)))

    def _show_others(self) -> None:
        self._wanted = True
        self._show_scene()

    def help_text(self) -> str:
        """What F1 shows."""
        return self.tr(
            "<h3>Run</h3>"
            "<p>Watch a program: every braking is a row, the map fills with squeal over pressure and"
            " temperature, the traces show the present braking. The tips of the verbs say what will happen."
            " Closing this window does not stop the run.</p>"
            "<p><b>1 … 9</b> noise rating of the present braking<br>"
            "<b>N</b> write a note, Enter puts it into the journal, Esc leaves<br>"
            "<b>Enter</b> or double click opens a braking on the Data page; so does a click on the map<br>"
            "<b>Alt + underlined letter</b> presses a button<br>"
            "<b>F12</b> software stop</p>"
            "<p><b>Follow</b> keeps the present braking in sight until you scroll.</p>"
        )

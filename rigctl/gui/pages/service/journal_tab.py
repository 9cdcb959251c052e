"""The journal of a campaign: what happened, by whom, searched and filtered, with what comes live.

Job: choice of campaign, table, filters, details, check for gaps. Not its job: reading (`journal_list`).
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from PySide6.QtCore import QModelIndex, Qt, QTimer
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QComboBox,
    QHBoxLayout,
    QHeaderView,
    QLineEdit,
    QPlainTextEdit,
    QPushButton,
    QSplitter,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from rigctl.core.journal import verify_journal
from rigctl.gui.format import clock_text, number_text
from rigctl.gui.pages.service.headed_table import HeadedTable, Index
from rigctl.gui.pages.service.journal_list import Filter, JournalFile, Row, campaigns_of, details_of
from rigctl.gui.pages.service.live_session import LiveSession
from rigctl.gui.pages.service.parts import LEFT, RIGHT, label, pad_cells, set_look
from rigctl.gui.services import Services
from rigctl.gui.work import Reporter

_ROLE = Qt.ItemDataRole
TAIL_MS = 500
_RIG_TIME = 1


class JournalTable(HeadedTable):
    """Rows that pass the filter, oldest first."""

    def __init__(self) -> None:
        super().__init__()
        self._all: list[Row] = []
        self._shown: list[Row] = []
        self._filter = Filter()
        self.sources: set[str] = set()
        self.kinds: set[str] = set()
        """Processes and kinds that occur."""
        self._heads = (
            self.tr("Time"), self.tr("Rig time (s)"), self.tr("Process"), self.tr("Kind"), self.tr("What"),
        )  # fmt: skip

    @property
    def total(self) -> int:
        """All records."""
        return len(self._all)

    def clear(self) -> None:
        """Another journal."""
        self.beginResetModel()
        self._all, self._shown = [], []
        self.sources, self.kinds = set(), set()
        self.endResetModel()

    def append(self, rows: list[Row]) -> None:
        """New records."""
        self._all += rows
        self.sources.update(row.record.source for row in rows)
        self.kinds.update(row.record.kind for row in rows)
        fresh = self._filter.pick(rows)
        if fresh:
            start = len(self._shown)
            self.beginInsertRows(QModelIndex(), start, start + len(fresh) - 1)
            self._shown += fresh
            self.endInsertRows()

    def set_filter(self, wanted: Filter) -> None:
        """Show other rows."""
        if wanted != self._filter:
            self.beginResetModel()
            self._filter = wanted
            self._shown = wanted.pick(self._all)
            self.endResetModel()

    def row(self, number: int) -> Row | None:
        """A shown row."""
        return self._shown[number] if 0 <= number < len(self._shown) else None

    def shown(self) -> int:
        """Rows that are shown."""
        return len(self._shown)

    def data(self, index: Index, role: int = _ROLE.DisplayRole) -> Any:
        """See QAbstractItemModel."""
        column = index.column()
        if role == _ROLE.TextAlignmentRole:
            return RIGHT if column == _RIG_TIME else LEFT
        if role not in (_ROLE.DisplayRole, _ROLE.ToolTipRole):
            return None
        row = self._shown[index.row()]
        record = row.record
        if column == 0:
            return record.utc if role == _ROLE.ToolTipRole else clock_text(record.utc)
        if column == _RIG_TIME:
            return number_text(record.rig_s, 2)
        return (record.source, record.kind, row.words)[column - 2]


class JournalTab(QWidget):
    """Any campaign's journal."""

    def __init__(self, services: Services, live: LiveSession) -> None:
        super().__init__()
        self._services = services
        self._live = live
        self._file: JournalFile | None = None
        self._job: Any = None
        self._wanted: Path | None = None
        self.model = JournalTable()
        self._make_controls()
        self._make_table()
        theme = services.theme
        first, second = QHBoxLayout(), QHBoxLayout()
        for row in (first, second):
            row.setSpacing(theme.px(1))
        first.addWidget(self.campaign, 1)
        first.addWidget(self.search, 1)
        for widget in (self.source, self.kind, self.follow):
            second.addWidget(widget)
        second.addStretch(1)
        second.addWidget(self.verify)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(*(theme.px(1),) * 4)
        layout.setSpacing(theme.px(1))
        layout.addLayout(first)
        layout.addLayout(second)
        layout.addWidget(self.splitter, 1)
        layout.addWidget(self.status)
        self._tail = QTimer(self)
        self._tail.setInterval(TAIL_MS)
        self._tail.timeout.connect(self._read_on)
        self._typing = QTimer(self)
        self._typing.setSingleShot(True)
        self._typing.setInterval(150)
        self._typing.timeout.connect(self._filter)
        self.search.textChanged.connect(lambda _text: self._typing.start())
        self.campaign.activated.connect(self._on_campaign)
        self.table.selectionModel().currentRowChanged.connect(self._show_details)
        theme.changed.connect(self._restyle)
        self._restyle()
        self._fill_filters()
        live.began.connect(self._on_began)

    def _make_controls(self) -> None:
        self.campaign = QComboBox()
        self.campaign.setObjectName("journal-campaign")
        self.campaign.setToolTip(self.tr("Campaigns of the data folder, newest first"))
        self.campaign.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.campaign.setMinimumContentsLength(24)
        self.search = QLineEdit()
        self.search.setObjectName("journal-search")
        self.search.setPlaceholderText(self.tr("search"))
        self.search.setClearButtonEnabled(True)
        self.search.setToolTip(self.tr("Rows with all these words (Ctrl+F)"))
        self.source, self.kind = QComboBox(), QComboBox()
        for box, name, tip in (
            (self.source, "journal-source", self.tr("Process that wrote the record")),
            (self.kind, "journal-kind", self.tr("Kind of record")),
        ):
            box.setObjectName(name)
            box.setToolTip(tip)
            box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToContents)
            box.currentIndexChanged.connect(self._filter)
        self.follow = QCheckBox(self.tr("&Follow"))
        self.follow.setObjectName("journal-follow")
        self.follow.setChecked(True)
        self.follow.setToolTip(self.tr("Show new records as they come"))
        self.verify = QPushButton(self.tr("&Check for gaps"))
        self.verify.setObjectName("journal-verify")
        self.verify.setToolTip(
            self.tr("Every process chains its records by hash: gaps and changes are found")
        )
        self.verify.clicked.connect(self._verify)
        self.status = label("", "muted", wrap=True)
        self.status.setObjectName("journal-status")

    def _make_table(self) -> None:
        self.table = QTableView()
        self.table.setObjectName("journal-table")
        self.table.setModel(self.model)
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.table.setAlternatingRowColors(True)
        self.table.setShowGrid(False)
        self.table.setWordWrap(False)
        self.table.setTabKeyNavigation(False)
        self.table.verticalHeader().hide()
        self.table.horizontalHeader().setHighlightSections(False)
        self.table.horizontalHeader().setDefaultAlignment(LEFT)
        self.table.horizontalHeader().setSectionResizeMode(4, QHeaderView.ResizeMode.Stretch)
        self.details = QPlainTextEdit()
        self.details.setReadOnly(True)
        self.details.setPlaceholderText(self.tr("Choose a record to see all of it."))
        self.splitter = QSplitter(Qt.Orientation.Vertical)
        self.splitter.addWidget(self.table)
        self.splitter.addWidget(self.details)
        self.splitter.setStretchFactor(0, 3)
        self.splitter.setStretchFactor(1, 1)

    def _restyle(self) -> None:
        theme = self._services.theme
        pad_cells(self.table, theme)
        self.table.verticalHeader().setDefaultSectionSize(theme.px(3))
        metrics = self.table.horizontalHeader().fontMetrics()
        for column, units in enumerate((11, 12, 12, 22)):
            title = str(self.table.model().headerData(column, Qt.Orientation.Horizontal) or "")
            self.table.setColumnWidth(
                column, max(theme.px(units), metrics.horizontalAdvance(title) + theme.px(2))
            )

    # -- life ------------------------------------------------------------------------------------

    def activated(self) -> None:
        """Shown: look for campaigns, follow the chosen one."""
        self._services.work.in_thread(
            _campaigns, self._services.data_folder, done=self._show_campaigns, failed=self._on_failed
        )
        self._tail.start()

    def deactivated(self) -> None:
        """Another tab or page."""
        self._tail.stop()
        self._typing.stop()

    def open_campaign(self, folder: Path) -> None:
        """Show the journal of this campaign."""
        self._wanted = folder
        self._choose(folder)

    def _on_began(self, session: Any) -> None:
        if self._wanted is None or self._file is None:
            self._wanted = session.campaign
            if self._tail.isActive():
                self.activated()

    def _show_campaigns(self, folders: list[Path]) -> None:
        chosen = self._wanted or (self._file.path.parent if self._file is not None else None)
        running = self._live.session
        if chosen is None and running is not None:
            chosen = running.campaign
        for extra in (chosen, running.campaign if running is not None else None):
            if extra is not None and extra not in folders:
                folders.insert(0, extra)
        self.campaign.blockSignals(True)
        self.campaign.clear()
        for folder in folders:
            live = running is not None and folder == running.campaign
            name = self.tr("{0} (running)").format(folder.name) if live else folder.name
            self.campaign.addItem(name, str(folder))
        self.campaign.blockSignals(False)
        self._wanted = None
        if not folders:
            self.status.setText(
                self.tr(
                    "No campaign in {0} yet: every run and every manual session writes a journal."
                ).format(self._services.data_folder)
            )
            return
        self._choose(chosen or folders[0])

    def _on_campaign(self, index: int) -> None:
        self._choose(Path(self.campaign.itemData(index)))

    def _choose(self, folder: Path) -> None:
        self.campaign.setCurrentIndex(self.campaign.findData(str(folder)))
        if self._file is None or self._file.path.parent != folder:
            if self._job is not None:
                self._job.cancel()
                self._job = None
            self._file = JournalFile(folder / "journal.jsonl")
            self.model.clear()
            self.details.clear()
            self._fill_filters()
        self._read_on()

    # -- reading ---------------------------------------------------------------------------------

    def _read_on(self) -> None:
        if self._file is not None and self._job is None and (self.follow.isChecked() or not self.model.total):
            self._job = self._services.work.in_thread(
                _read_on, self._file, done=self._on_rows, failed=self._on_failed
            )

    def _on_rows(self, rows: list[Row]) -> None:
        self._job = None
        if not rows:
            return
        bar = self.table.verticalScrollBar()
        at_end = bar.value() >= bar.maximum() - 2
        before = len(self.model.sources), len(self.model.kinds)
        self.model.append(rows)
        if (len(self.model.sources), len(self.model.kinds)) != before:
            self._fill_filters()
        self._show_counts()
        if at_end and self.follow.isChecked():
            self.table.scrollToBottom()

    def _on_failed(self, why: str) -> None:
        self._job = None
        self._say(why, "error")

    # -- filters ---------------------------------------------------------------------------------

    def _fill_filters(self) -> None:
        for box, words, any_text in zip(
            (self.source, self.kind),
            (sorted(self.model.sources), sorted(self.model.kinds)),
            (self.tr("all processes"), self.tr("all kinds")),
            strict=True,
        ):
            chosen = box.currentData() or ""
            box.blockSignals(True)
            box.clear()
            box.addItem(any_text, "")
            for word in words:
                box.addItem(word, word)
            box.setCurrentIndex(max(box.findData(chosen), 0))
            box.blockSignals(False)

    def _filter(self) -> None:
        wanted = Filter(self.search.text(), self.source.currentData() or "", self.kind.currentData() or "")
        self.model.set_filter(wanted)
        self._show_counts()

    def _show_counts(self) -> None:
        if self.model.total:
            text = self.tr("{0} of {1} records").format(self.model.rowCount(), self.model.total)
            self._say(text, "muted")

    def _say(self, text: str, look: str) -> None:
        set_look(self.status, look)
        self.status.setText(text)

    def _show_details(self, current: QModelIndex, _before: QModelIndex) -> None:
        row = self.model.row(current.row())
        self.details.setPlainText("" if row is None else details_of(row.record))

    def _verify(self) -> None:
        if self._file is not None:
            self._say(self.tr("Checking …"), "muted")
            self._services.work.in_thread(
                _verify, self._file.path, done=self._on_verified, failed=self._on_failed
            )

    def _on_verified(self, problems: list[str]) -> None:
        if problems:
            self._say("▲ " + "\n".join(problems[:5]), "error")
        else:
            self._say(self.tr("No gaps: every record is whole and in its place."), "muted")
        self.details.setPlainText("\n".join(problems))


def _campaigns(folder: Path, _reporter: Reporter) -> list[Path]:
    return campaigns_of(folder)


def _read_on(file: JournalFile, _reporter: Reporter) -> list[Row]:
    return file.read_on()


def _verify(path: Path, _reporter: Reporter) -> list[str]:
    return verify_journal(path)

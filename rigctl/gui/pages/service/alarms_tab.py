"""The list of alarms: severity, time, words, remedy, number of times, who has acknowledged.

Job: the table and [Acknowledge]. Not its job: which alarms there are (`rigctl.gui.rig.alarms`).
"""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QHBoxLayout,
    QHeaderView,
    QPushButton,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from rigctl.gui.format import clock_text
from rigctl.gui.pages.service.headed_table import HeadedTable, Index
from rigctl.gui.pages.service.parts import LEFT, RIGHT, label, pad_cells
from rigctl.gui.rig.alarm_list import ALARM, Alarm
from rigctl.gui.services import Services
from rigctl.gui.theme import ThemeKeeper

_WORDS = 3
_COUNT = 2
_ROLE = Qt.ItemDataRole


class AlarmTable(HeadedTable):
    """Alarms, newest first."""

    def __init__(self, theme: ThemeKeeper) -> None:
        super().__init__()
        self._theme = theme
        self._rows: list[Alarm] = []
        self._heads = (
            self.tr("Severity"), self.tr("Time"), self.tr("Times"), self.tr("What"), self.tr("What to do"),
            self.tr("Acknowledged"),
        )  # fmt: skip

    def show_alarms(self, alarms: list[Alarm]) -> None:
        """Show these."""
        if len(alarms) == len(self._rows):
            self._rows = alarms
            if alarms:
                self.dataChanged.emit(self.index(0, 0), self.index(len(alarms) - 1, len(self._heads) - 1))
            return
        self.beginResetModel()
        self._rows = alarms
        self.endResetModel()

    def alarm(self, row: int) -> Alarm | None:
        """The alarm in a row."""
        return self._rows[row] if 0 <= row < len(self._rows) else None

    def shown(self) -> int:
        """Rows that are shown."""
        return len(self._rows)

    def data(self, index: Index, role: int = _ROLE.DisplayRole) -> Any:
        """See QAbstractItemModel."""
        alarm, column = self._rows[index.row()], index.column()
        if role in (_ROLE.DisplayRole, _ROLE.ToolTipRole):
            return self._texts(alarm)[column]
        if role == _ROLE.TextAlignmentRole:
            return RIGHT if column == _COUNT else LEFT
        return self._look(alarm, column, role)

    def _look(self, alarm: Alarm, column: int, role: int) -> Any:
        if not alarm.open:
            return self._theme.colour("muted") if role == _ROLE.ForegroundRole else None
        if role == _ROLE.FontRole and column == _WORDS:
            return self._theme.font(bold=True)
        if column == 0 and role in (_ROLE.BackgroundRole, _ROLE.ForegroundRole):
            kind = "red" if alarm.severity == ALARM else "amber"
            return self._theme.colour(kind if role == _ROLE.BackgroundRole else f"on_{kind}")
        return None

    def _texts(self, alarm: Alarm) -> tuple[str, ...]:
        word = self.tr("Alarm") if alarm.severity == ALARM else self.tr("Warning")
        seen = f"{alarm.acknowledged_by}, {clock_text(alarm.acknowledged_utc)}"
        return (
            f"▲ {word}",
            f"{alarm.last_utc[:10]}  {clock_text(alarm.last_utc)}",
            f"{alarm.count}",
            alarm.words + (self.tr("  (lasts)") if alarm.active else ""),
            alarm.remedy,
            "—" if alarm.open else seen,
        )


class AlarmsTab(QWidget):
    """Table and buttons."""

    def __init__(self, services: Services) -> None:
        super().__init__()
        self._services = services
        self._alarms = services.alarms
        theme = services.theme
        self._make_table(theme)
        self.acknowledge = QPushButton(self.tr("&Acknowledge the selected"))
        self.acknowledge.setObjectName("alarms-acknowledge")
        self.acknowledge.setToolTip(
            self.tr("Say that they have been seen; they stay in the list (Ctrl+A: all)")
        )
        self.acknowledge.clicked.connect(self._acknowledge)
        self.all = QPushButton(self.tr("Acknowledge a&ll"))
        self.all.setObjectName("alarms-acknowledge-all")
        self.all.setToolTip(self.tr("Say that all have been seen; each is journaled"))
        self.only_open = QCheckBox(self.tr("Only what is not acknowledged"))
        self.only_open.setObjectName("alarms-open")
        self.only_open.setToolTip(self.tr("Hide what somebody has seen"))
        self.only_open.toggled.connect(self._show)
        self.empty = label(
            self.tr(
                "No alarm. Trips, refusals, broken-off brakings and values near the watchdog's limits appear "
                "here with what to do; the newest also stands in the bar below."
            ),
            "muted",
            wrap=True,
        )
        row = QHBoxLayout()
        row.setSpacing(theme.px(1))
        row.addWidget(self.acknowledge)
        row.addWidget(self.all)
        row.addStretch(1)
        row.addWidget(self.only_open)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(*(theme.px(1),) * 4)
        layout.setSpacing(theme.px(1))
        layout.addLayout(row)
        layout.addWidget(self.empty)
        layout.addWidget(self.table, 1)
        layout.addStretch(0)
        QShortcut(QKeySequence(Qt.Key.Key_Return), self.table, self._acknowledge)
        self.table.selectionModel().selectionChanged.connect(lambda *_: self._show_buttons())
        if self._alarms is not None:
            self.all.clicked.connect(self._alarms.acknowledge_all)
            self._alarms.changed.connect(self._show)
        self._show()

    def _make_table(self, theme: ThemeKeeper) -> None:
        self.model = AlarmTable(theme)
        self.table = QTableView()
        self.table.setObjectName("alarms-table")
        self.table.setModel(self.model)
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.table.setAlternatingRowColors(True)
        self.table.setShowGrid(False)
        self.table.setWordWrap(True)
        self.table.setTabKeyNavigation(False)
        self.table.verticalHeader().hide()
        self.table.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        header = self.table.horizontalHeader()
        header.setHighlightSections(False)
        header.setDefaultAlignment(LEFT)
        for column in (0, 1, 2, 5):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        for column in (3, 4):
            header.setSectionResizeMode(column, QHeaderView.ResizeMode.Stretch)
        theme.changed.connect(self._restyle)
        self._restyle()

    def _restyle(self) -> None:
        pad_cells(self.table, self._services.theme)

    def activated(self) -> None:
        """Shown."""
        self._show()

    def deactivated(self) -> None:
        """Another tab."""

    def _show(self) -> None:
        alarms = [] if self._alarms is None else self._alarms.alarms
        alarms.sort(key=lambda alarm: alarm.last_utc, reverse=True)
        if self.only_open.isChecked():
            alarms = [alarm for alarm in alarms if alarm.open]
        self.model.show_alarms(alarms)
        self.empty.setVisible(not alarms)
        self.table.setVisible(bool(alarms))
        self._show_buttons()

    def _selected(self) -> list[Alarm]:
        rows = {index.row() for index in self.table.selectionModel().selectedRows()}
        return [alarm for row in sorted(rows) if (alarm := self.model.alarm(row)) is not None and alarm.open]

    def _show_buttons(self) -> None:
        self.acknowledge.setEnabled(bool(self._selected()))
        self.all.setEnabled(self._alarms is not None and self._alarms.open_count > 0)

    def _acknowledge(self) -> None:
        if self._alarms is not None:
            for alarm in self._selected():
                self._alarms.acknowledge(alarm.key)

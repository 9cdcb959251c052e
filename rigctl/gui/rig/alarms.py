"""The alarms of the window: the list kept up with connection and journal, and acknowledgements written down.

Job: feed an `AlarmList` from the `RigConnection`, tell who shows it, journal who has acknowledged. Not its
job: which alarms there are (`alarm_list`), their look (alarm bar, Service page).
"""

from __future__ import annotations

import getpass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from PySide6.QtCore import QObject, Signal

from rigctl.core.errors import RigctlError
from rigctl.core.journal import Journal
from rigctl.gui.rig.alarm_list import WARNING, Alarm, AlarmList
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.rig.near_limits import LimitWatch
from rigctl.gui.rig.phases import said
from rigctl.gui.rig.state import RigState
from rigctl.gui.work import Reporter, Work

SOURCE = "operator"


class AlarmModel(QObject):
    """One for the window (`Services.alarms`)."""

    changed = Signal()
    """The list has changed."""
    newestChanged = Signal(object)
    """The newest alarm that nobody has acknowledged (`Alarm`), or None."""

    def __init__(self, rig: RigConnection, work: Work, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._rig = rig
        self._work = work
        self._list = AlarmList()
        self._campaign: Path | None = None
        self._attached = False
        self._newest: Alarm | None = None
        rig.attached.connect(self._on_attached)
        rig.detached.connect(self._on_detached)
        rig.recordsAdded.connect(self._on_records)
        rig.stateChanged.connect(self._on_state)
        if rig.session is not None:
            self._on_attached(rig.session)
            self._on_records(rig.records)

    @property
    def alarms(self) -> list[Alarm]:
        """All alarms, newest last."""
        return list(self._list.alarms)

    @property
    def newest(self) -> Alarm | None:
        """The newest that nobody has acknowledged."""
        return self._newest

    @property
    def open_count(self) -> int:
        """How many nobody has acknowledged."""
        return sum(alarm.open for alarm in self._list.alarms)

    def raise_warning(self, key: str, words: str, remedy: str = "") -> None:
        """Something that the window itself has found."""
        utc = datetime.now(UTC).isoformat(timespec="milliseconds")
        self._list.raise_alarm(key, WARNING, words, remedy, utc)
        self._tell()

    # -- acknowledge -----------------------------------------------------------------------------

    def acknowledge_newest(self) -> None:
        """The one in the alarm bar has been seen."""
        if self._newest is not None:
            self.acknowledge(self._newest.key)

    def acknowledge_all(self) -> None:
        """All have been seen."""
        for key in dict.fromkeys(alarm.key for alarm in self._list.alarms if alarm.open):
            self.acknowledge(key)

    def acknowledge(self, key: str) -> None:
        """An alarm has been seen by this person; it stays in the list."""
        who = getpass.getuser()
        if not self._list.acknowledge(key, who, datetime.now(UTC).isoformat(timespec="milliseconds")):
            return
        self._tell()
        if self._attached:
            self._rig.acknowledge_alarm(key)
        elif self._campaign is not None:
            self._work.in_thread(
                _journal, self._campaign / "journal.jsonl", key, who, done=_done, failed=self._on_not_written
            )

    def _on_not_written(self, why: str) -> None:
        self.raise_warning("journal", self.tr("The acknowledgement was not journaled: {0}").format(why))

    # -- news ------------------------------------------------------------------------------------

    def _on_attached(self, session: Any) -> None:
        if session.campaign != self._campaign:
            self._list.clear()
        self._campaign, self._attached = session.campaign, True
        try:
            config = session.rig
            self._list.watch = LimitWatch.of_file(
                session.campaign / config.safety.limits, config.capabilities
            )
        except (RigctlError, OSError) as error:
            self._list.watch = LimitWatch(None, {})
            self.raise_warning("limits", self.tr("Values are not watched: {0}").format(error))
        self._watch_calibrations(session)
        self._tell()

    def _watch_calibrations(self, session: Any) -> None:
        today = datetime.now(UTC).date()
        for calibration in getattr(session.file, "calibrations", ()):
            if calibration.due < today:
                self.raise_warning(
                    f"calibration:{calibration.quantity}",
                    self.tr("The calibration of {0} is overdue since {1}.").format(
                        said(calibration.quantity), calibration.due.isoformat()
                    ),
                    self.tr("Calibrate it on the Service page."),
                )

    def _on_detached(self, _why: str) -> None:
        self._attached = False
        if self._list.take_state(RigState()):
            self._tell()

    def _on_records(self, records: list[Any]) -> None:
        if self._list.take_records(records):
            self._tell()

    def _on_state(self, state: RigState) -> None:
        if self._attached and self._list.take_state(state):
            self._tell()

    def _tell(self) -> None:
        newest = self._list.newest_open()
        if newest != self._newest:
            self._newest = newest
            self.newestChanged.emit(newest)
        self.changed.emit()


def _journal(path: Path, alarm: str, who: str, _reporter: Reporter) -> None:
    """Write an acknowledgement into the journal of a campaign that no controller writes."""
    journal = Journal(path, SOURCE)
    try:
        journal.write("alarm_acknowledged", alarm=alarm, who=who)
    finally:
        journal.close()


def _done(_result: object) -> None:
    """Nothing more is to be said."""

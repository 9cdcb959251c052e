"""Brakings of one campaign, read beside the window and handed over piece by piece.

Job: what the catalogue knows at once (in a thread), what it does not know in pieces from the worker
process, with progress; later only what has changed. Not its job: showing, statistics.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from rigctl.core.errors import RecordingError
from rigctl.core.journal import Record
from rigctl.gui.pages.data import remote
from rigctl.gui.pages.data.entry import Entry, entries_of, with_words
from rigctl.gui.work import Job, Reporter, Work
from rigctl.recording.annotations import Folding, read_annotations
from rigctl.recording.catalogue import Catalogue, Found, files_of

PIECE = 200
"""Files read per piece: about a tenth of a second of work, and of waiting for a cancel."""
_NEWS = 0.25
"""Share of new entries among all that is worth a new arrangement of the table."""

State = tuple[int, int]


@dataclass(frozen=True)
class _Scan:
    entries: list[Entry]
    stale: list[str]
    names: set[str]
    said: Folding
    stamp: State


class CampaignLoader(QObject):
    """Keeps the entries of one campaign up to date."""

    opened = Signal(list)
    """All entries known at once, of a newly opened campaign."""
    changed = Signal(list, list)
    """New or changed entries, and names of files that have gone."""
    progress = Signal(float)
    """Share of the files that are read; 1 at the end."""
    failed = Signal(str)

    def __init__(self, work: Work, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._work = work
        self.campaign: Path | None = None
        self.said = Folding()
        self._entries: dict[str, Entry] = {}
        self._waiting: list[str] = []
        self._news: list[Entry] = []
        self._gone: list[str] = []
        self._total = 0
        self._stamp: State = (0, 0)
        self._scan: Job | None = None
        self._piece: Job | None = None

    @property
    def busy(self) -> bool:
        """True while files are being read."""
        return self._scan is not None or self._piece is not None or bool(self._waiting)

    def open(self, campaign: Path) -> None:
        """Read another campaign; what was being read is dropped."""
        self.close()
        self.campaign = campaign
        self.said = Folding()
        self._entries = {}
        self.progress.emit(0.0)
        self._scan = self._work.in_thread(
            _scan, campaign, done=partial(self._on_scan, campaign, True), failed=self._on_failed
        )

    def refresh(self) -> None:
        """Look for new, changed and vanished files and words; nothing happens when nothing has changed."""
        if self.campaign is None or self.busy or _stamp(self.campaign) == self._stamp:
            return
        self._scan = self._work.in_thread(
            _scan, self.campaign, done=partial(self._on_scan, self.campaign, False), failed=self._on_failed
        )

    def read(self, names: Iterable[str]) -> None:
        """Read these files (again): they were committed or moved just now."""
        self._waiting += [name for name in names if name not in self._waiting]
        self._total = max(self._total, len(self._waiting))
        self._next()

    def hear(self, records: Iterable[Record]) -> None:
        """Take in records of this campaign's journal."""
        indices = self.said.add(records)
        found = [with_words(e, self.said) for e in self._entries.values() if e.index in indices]
        changed = [entry for entry in found if entry != self._entries[entry.name]]
        self._entries.update((entry.name, entry) for entry in changed)
        if changed:
            self.changed.emit(changed, [])

    def forget(self, name: str) -> None:
        """A file was moved away."""
        if self._entries.pop(name, None) is not None:
            self.changed.emit([], [name])

    def close(self) -> None:
        """Read nothing more."""
        for job in (self._scan, self._piece):
            if job is not None:
                job.cancel()
        self._scan = self._piece = None
        self._waiting, self._news, self._gone = [], [], []
        self._total = 0

    # -- results ------------------------------------------------------------------------------------

    def _on_scan(self, campaign: Path, first: bool, found: _Scan) -> None:
        self._scan = None
        if campaign != self.campaign:
            return
        self.said, self._stamp = found.said, found.stamp
        self._waiting = found.stale
        self._total = len(found.stale)
        if first:
            self._entries = {entry.name: entry for entry in found.entries}
            self.opened.emit(found.entries)
        else:
            gone = [name for name in self._entries if name not in found.names]
            changed = [entry for entry in found.entries if self._entries.get(entry.name) != entry]
            for name in gone:
                del self._entries[name]
            self._entries.update((entry.name, entry) for entry in changed)
            if gone or changed:
                self.changed.emit(changed, gone)
        self._next()

    def _next(self) -> None:
        if self._piece is not None or self._scan is not None or self.campaign is None:
            return
        self.progress.emit(1.0 - len(self._waiting) / self._total if self._total else 1.0)
        if not self._waiting:
            self._total = 0
            return
        piece, self._waiting = self._waiting[:PIECE], self._waiting[PIECE:]
        done = partial(self._on_piece, self.campaign, piece)
        self._piece = self._work.in_process(
            remote.read_files, self.campaign, piece, done=done, failed=self._on_failed, lane=remote.LANE
        )

    def _on_piece(self, campaign: Path, piece: list[str], found: Found) -> None:
        self._piece = None
        if campaign != self.campaign:
            return
        entries = entries_of(found, self.said)
        known = {entry.name for entry in entries}
        gone = [name for name in piece if name not in known and name in self._entries]
        for name in gone:
            del self._entries[name]
        self._entries.update((entry.name, entry) for entry in entries)
        self._news += entries
        self._gone += gone
        if not self._waiting or len(self._news) > _NEWS * len(self._entries):
            self._tell()
        self._next()

    def _tell(self) -> None:
        """Hand over what was read: seldom while much is read, so that the table is not arranged too often."""
        entries, gone, self._news, self._gone = self._news, self._gone, [], []
        if entries or gone:
            self.changed.emit(entries, gone)

    def _on_failed(self, words: str) -> None:
        self._scan = self._piece = None
        self._waiting = []
        self._tell()
        self.progress.emit(1.0)
        self.failed.emit(words)


def _scan(campaign: Path, reporter: Reporter) -> _Scan:
    """In a thread: what catalogue and journal know."""
    if not (campaign / "brakings").is_dir():
        raise RecordingError(
            "this is not a campaign: it has no folder 'brakings'.",
            place=str(campaign),
            remedy="Choose a folder that holds campaign.toml.",
        )
    stamp = _stamp(campaign)
    said = read_annotations(campaign)
    with Catalogue(campaign) as catalogue:
        found = catalogue.read()
    entries = [] if reporter.cancelled else entries_of(found, said)
    return _Scan(entries, found.stale, set(files_of(campaign)), said, stamp)


def _stamp(campaign: Path) -> State:
    """Changes with every event of the journal and every file that comes or goes."""

    def changed_ns(path: Path) -> int:
        try:
            return path.stat().st_mtime_ns
        except FileNotFoundError:
            return 0

    journal = campaign / "journal.jsonl"
    size = journal.stat().st_size if journal.exists() else 0
    return size, max(changed_ns(campaign / "brakings"), changed_ns(campaign / "trash"))

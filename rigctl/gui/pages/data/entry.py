"""One line of the table of brakings: its row, its events and the file behind them. No Qt.

Job: make entries from summaries, keep them up to date with what people say. Not its job: reading files
(`loader`), columns (`columns`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from rigctl.analysis.campaign_table import BrakingRow, CampaignTable, EventRow, annotated, in_order, rows_of
from rigctl.core.errors import RecordingError
from rigctl.recording.annotations import Folding
from rigctl.recording.catalogue import Found
from rigctl.recording.trash import FOLDER as TRASH
from rigctl.recording.trash import index_of

UNREADABLE = "unreadable"
TRASHED = "trashed"
EXCLUDED = "excluded"


@dataclass(frozen=True, slots=True)
class Entry:
    """A braking of a campaign.

    Attributes
    ----------
    name : str
        Its file relative to the campaign.
    row, events, marks
        What is known of it.
    trashed : bool
        True when its file is in the trash.
    state : str
        trashed, unreadable, excluded, else the status of the recording.
    counts : bool
        True when it belongs to the base of statistics.
    """

    name: str
    row: BrakingRow
    events: tuple[EventRow, ...] = ()
    marks: tuple[dict[str, Any], ...] = ()
    trashed: bool = field(init=False, compare=False)
    state: str = field(init=False, compare=False)
    counts: bool = field(init=False, compare=False)

    def __post_init__(self) -> None:
        """Derived once: ten thousand entries are asked for them with every filter."""
        trashed = self.name.startswith(f"{TRASH}/")
        state = EXCLUDED if self.row.excluded else self.row.status
        object.__setattr__(self, "trashed", trashed)
        object.__setattr__(self, "state", TRASHED if trashed else state)
        object.__setattr__(self, "counts", self.row.counts and not trashed)

    @property
    def index(self) -> int:
        """Number of the braking."""
        return self.row.index

    def path(self, campaign: Path) -> Path:
        """The file."""
        return campaign / self.name


def entries_of(found: Found, said: Folding) -> list[Entry]:
    """Entries of all files of which something is known."""
    entries = []
    problems = dict(found.unreadable)
    for name, summary in found.summaries.items():
        try:
            row, events = rows_of(summary, name.partition("/")[2])
        except RecordingError as error:
            problems[name] = error.problem
            continue
        entries.append(with_words(Entry(name, row, events, tuple(summary["marks"])), said))
    entries += [_unreadable(name, problem) for name, problem in problems.items()]
    return entries


def with_words(entry: Entry, said: Folding) -> Entry:
    """The entry with what people say now."""
    if entry.row.status == UNREADABLE:
        return entry
    return replace(entry, row=annotated(entry.row, said.of(entry.index), entry.marks))


def table_of(entries: Iterable[Entry]) -> CampaignTable:
    """The table that statistics are made of; the trash is left out."""
    here: Sequence[Entry] = [entry for entry in entries if not entry.trashed]
    readable = [entry for entry in here if entry.row.status != UNREADABLE]
    return in_order(
        (entry.row for entry in readable),
        (event for entry in readable for event in entry.events),
        ((entry.row.file, entry.row.note) for entry in here if entry.row.status == UNREADABLE),
    )


def _unreadable(name: str, problem: str) -> Entry:
    file = name.partition("/")[2]
    try:
        index = index_of(file)
    except RecordingError:
        index = 0
    nothing: dict[str, Any] = dict.fromkeys(BrakingRow.__dataclass_fields__)
    nothing.update(
        index=index, file=file, sequence="", role="", status=UNREADABLE, note=problem, start_time="",
        squeals=0, sound_recorded=False, evaluation_error="", excluded="", excluded_by="", tags=(),
        remark="",
    )  # fmt: skip
    return Entry(name, BrakingRow(**nothing))

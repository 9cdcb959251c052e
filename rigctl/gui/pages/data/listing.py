"""Which brakings of a campaign are shown, and in which order. No Qt.

Job: hold all entries, filter and sort them. Done here, not by Qt's sorting proxy: comparing ten thousand
rows in Python one call at a time takes about a second, one pass over them some milliseconds. Not its job:
cells (`table_model`), reading (`loader`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from operator import itemgetter

from rigctl.gui.pages.data.columns import BY_KEY, Column
from rigctl.gui.pages.data.entry import Entry

COUNTED = "counted"
Check = Callable[[Entry], bool]


@dataclass(frozen=True)
class BrakingFilter:
    """What is shown.

    Attributes
    ----------
    pressure_bar, temperature_degc : (float or None, float or None)
        From and to, of the set-point (of the measured value where there is none); None is open.
    squeal : bool or None
        With or without squeal.
    state : str
        A state of `Entry`, "counted", or "" for all but the trash.
    tag, text : str
        A tag; words anywhere in note, reason, sequence or tags.
    """

    pressure_bar: tuple[float | None, float | None] = (None, None)
    temperature_degc: tuple[float | None, float | None] = (None, None)
    squeal: bool | None = None
    state: str = ""
    tag: str = ""
    text: str = ""

    def accepts(self, entry: Entry) -> bool:
        """True when the entry is shown."""
        return all(check(entry) for check in self.checks())

    def checks(self) -> list[Check]:
        """What an entry has to fulfil: only the conditions that are in force, for many entries."""
        checks: list[Check] = [self._state_check()]
        if self.pressure_bar != (None, None):
            checks.append(lambda e: _within(_pressure(e), self.pressure_bar))
        if self.temperature_degc != (None, None):
            checks.append(lambda e: _within(_temperature(e), self.temperature_degc))
        if self.squeal is not None:
            checks.append(lambda e: e.row.sound_recorded and (e.row.squeals > 0) is self.squeal)
        if self.tag:
            checks.append(lambda e: self.tag in e.row.tags)
        if self.text:
            checks.append(self._text_fits)
        return checks

    def _state_check(self) -> Check:
        wanted = self.state
        if wanted == COUNTED:
            return lambda e: e.counts
        return (lambda e: e.state == wanted) if wanted else (lambda e: not e.trashed)

    def _text_fits(self, entry: Entry) -> bool:
        row = entry.row
        words = " ".join((row.remark, row.excluded, row.note, row.sequence, row.role, *row.tags)).casefold()
        return all(word in words for word in self.text.casefold().split())


class BrakingList:
    """All entries of a campaign, and those that are shown (`visible`) in their order.

    `squealing` is the number of shown ones that count and squealed.
    """

    def __init__(self) -> None:
        self._all: dict[str, Entry] = {}
        self._ordered: list[Entry] | None = None
        self._here: int | None = None
        self._tags: list[str] | None = None
        self.filter = BrakingFilter()
        self.sort_by = "index"
        self.descending = False
        self.visible: list[Entry] = []
        self.squealing = 0
        self._row_of: dict[str, int] = {}

    def all(self) -> list[Entry]:
        """Every entry, in order of its number."""
        if self._ordered is None:
            self._ordered = sorted(self._all.values(), key=_number)
        return self._ordered

    def get(self, name: str) -> Entry | None:
        """The entry of a file."""
        return self._all.get(name)

    def of_braking(self, index: int) -> list[Entry]:
        """Entries of one braking: its file, and older ones in the trash."""
        return [entry for entry in self._all.values() if entry.index == index]

    def row_of(self, name: str) -> int | None:
        """Row in which it is shown."""
        return self._row_of.get(name)

    def count_here(self) -> int:
        """Entries that are not in the trash."""
        if self._here is None:
            self._here = sum(1 for entry in self._all.values() if not entry.trashed)
        return self._here

    def tags(self) -> list[str]:
        """All tags in use."""
        if self._tags is None:
            found = {tag for entry in self._all.values() for tag in entry.row.tags}
            self._tags = sorted(found, key=str.casefold)
        return self._tags

    def replace_all(self, entries: Iterable[Entry]) -> None:
        """A new campaign."""
        self._all = {entry.name: entry for entry in entries}
        self._ordered = self._tags = self._here = None
        self.arrange()

    def put(self, entries: Iterable[Entry], gone: Iterable[str] = ()) -> None:
        """New or changed entries; files that have gone."""
        for name in gone:
            self._all.pop(name, None)
        self._all.update((entry.name, entry) for entry in entries)
        self._ordered = self._tags = self._here = None
        self.arrange()

    def arrange(self) -> None:
        """Filter and sort again."""
        chosen = self.all()
        for check in self.filter.checks():
            chosen = [entry for entry in chosen if check(entry)]
        self.squealing = sum(1 for entry in chosen if entry.counts and entry.row.squeals)
        if self.sort_by != "index" or self.descending:
            chosen = self._sorted(chosen, BY_KEY[self.sort_by])
        self.visible = chosen
        self._row_of = {entry.name: row for row, entry in enumerate(chosen)}

    def _sorted(self, entries: list[Entry], column: Column) -> list[Entry]:
        """By the value of a column, equal ones by number; without a value last, whichever way round."""
        keyed = [(column.sort_key(entry), entry) for entry in entries]
        missing = [entry for (absent, _), entry in keyed if absent]
        there = [(key, entry) for (absent, key), entry in keyed if not absent]
        there.sort(key=itemgetter(0), reverse=self.descending)
        return [entry for _, entry in there] + missing


def _number(entry: Entry) -> tuple[int, str]:
    return entry.index, entry.name


def _pressure(entry: Entry) -> float | None:
    row = entry.row
    return row.pressure_mean_bar if row.set_pressure_bar is None else row.set_pressure_bar


def _temperature(entry: Entry) -> float | None:
    row = entry.row
    return row.temperature_initial_degc if row.set_temperature_degc is None else row.set_temperature_degc


def _within(value: float | None, bounds: tuple[float | None, float | None]) -> bool:
    low, high = bounds
    if low is None and high is None:
        return True
    return value is not None and (low is None or value >= low) and (high is None or value <= high)

"""Which brakings of a campaign are shown, and in which order. No Qt.

Job: hold all entries, filter and sort them. Done here, not by Qt's sorting proxy: comparing ten thousand
rows in Python one call at a time takes about a second, one pass over them some milliseconds. Not its job:
cells (`table_model`), reading (`loader`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from rigctl.gui.pages.data.columns import BY_KEY
from rigctl.gui.pages.data.entry import TRASHED, Entry

COUNTED = "counted"


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
        row = entry.row
        return (
            self._state_fits(entry)
            and _within(_first(row.set_pressure_bar, row.pressure_mean_bar), self.pressure_bar)
            and _within(_first(row.set_temperature_degc, row.temperature_initial_degc), self.temperature_degc)
            and (self.squeal is None or (row.sound_recorded and (row.squeals > 0) is self.squeal))
            and (not self.tag or self.tag in row.tags)
            and (not self.text or self._text_fits(entry))
        )

    def _state_fits(self, entry: Entry) -> bool:
        if self.state == COUNTED:
            return entry.counts
        return entry.state == self.state if self.state else entry.state != TRASHED

    def _text_fits(self, entry: Entry) -> bool:
        row = entry.row
        words = " ".join((row.remark, row.excluded, row.note, row.sequence, row.role, *row.tags)).casefold()
        return all(word in words for word in self.text.casefold().split())


class BrakingList:
    """All entries of a campaign, and those that are shown in their order."""

    def __init__(self) -> None:
        self._all: dict[str, Entry] = {}
        self.filter = BrakingFilter()
        self.sort_by = "index"
        self.descending = False
        self.visible: list[Entry] = []
        self._row_of: dict[str, int] = {}

    def all(self) -> list[Entry]:
        """Every entry, in order of its number."""
        return sorted(self._all.values(), key=lambda e: (e.index, e.name))

    def get(self, name: str) -> Entry | None:
        """The entry of a file."""
        return self._all.get(name)

    def of_braking(self, index: int) -> list[Entry]:
        """Entries of one braking: its file, and older ones in the trash."""
        return [entry for entry in self._all.values() if entry.index == index]

    def row_of(self, name: str) -> int | None:
        """Row in which it is shown."""
        return self._row_of.get(name)

    def tags(self) -> list[str]:
        """All tags in use."""
        return sorted({tag for entry in self._all.values() for tag in entry.row.tags}, key=str.casefold)

    def replace_all(self, entries: Iterable[Entry]) -> None:
        """A new campaign."""
        self._all = {entry.name: entry for entry in entries}
        self.arrange()

    def put(self, entries: Iterable[Entry], gone: Iterable[str] = ()) -> None:
        """New or changed entries; files that have gone."""
        for name in gone:
            self._all.pop(name, None)
        self._all.update((entry.name, entry) for entry in entries)
        self.arrange()

    def arrange(self) -> None:
        """Filter and sort again."""
        column = BY_KEY[self.sort_by]
        chosen = [entry for entry in self._all.values() if self.filter.accepts(entry)]
        chosen.sort(key=lambda e: (e.index, e.name))
        if self.descending:
            with_value = [entry for entry in chosen if not column.sort_key(entry)[0]]
            without = [entry for entry in chosen if column.sort_key(entry)[0]]
            with_value.sort(key=column.sort_key, reverse=True)
            chosen = with_value + without
        else:
            chosen.sort(key=column.sort_key)
        self.visible = chosen
        self._row_of = {entry.name: row for row, entry in enumerate(chosen)}


def _first(*values: float | None) -> float | None:
    return next((value for value in values if value is not None), None)


def _within(value: float | None, bounds: tuple[float | None, float | None]) -> bool:
    low, high = bounds
    if low is None and high is None:
        return True
    return value is not None and (low is None or value >= low) and (high is None or value <= high)

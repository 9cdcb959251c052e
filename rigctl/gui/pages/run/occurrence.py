"""Squeal over pressure and temperature, filling while the run goes on. No Qt.

Job: one cell for each pair of set-points, with the same rules as the report (`rigctl.analysis.occurrence`):
complete brakings with evaluated sound count; a braking without a temperature of its own is sorted by its
measured one into classes of 20 K. Updated row by row. Not its job: drawing (`map_view`).
"""

from __future__ import annotations

from dataclasses import dataclass, field

from rigctl.gui.pages.run.rows import Row

TEMPERATURE_CLASS_K = 20.0
Key = tuple[float, float]
"""(pressure in bar, temperature in °C)."""


@dataclass
class Cell:
    """Brakings of one pair of set-points, by number."""

    planned: set[int] = field(default_factory=set)
    judged: set[int] = field(default_factory=set)
    levels: dict[int, float] = field(default_factory=dict)

    @property
    def level_db(self) -> float | None:
        """Loudest squeal, None without one."""
        return max(self.levels.values(), default=None)

    @property
    def loudest(self) -> int | None:
        """Number of the braking to look at: the loudest one, else the newest judged."""
        if self.levels:
            return max(self.levels, key=lambda index: self.levels[index])
        return max(self.judged, default=None)


class Occurrence:
    """Cells by their set-points."""

    def __init__(self) -> None:
        self.cells: dict[Key, Cell] = {}
        self._key_of: dict[int, Key] = {}
        self.revision = 0
        """Rises with every change."""

    @property
    def pressures(self) -> list[float]:
        """Pressures that have a cell, ascending."""
        return sorted({pressure for pressure, _ in self.cells})

    @property
    def temperatures(self) -> list[float]:
        """Temperatures that have a cell, ascending."""
        return sorted({temperature for _, temperature in self.cells})

    @property
    def judged(self) -> int:
        """Brakings that count."""
        return sum(len(cell.judged) for cell in self.cells.values())

    @property
    def squealing(self) -> int:
        """Brakings among them that squealed."""
        return sum(len(cell.levels) for cell in self.cells.values())

    def take(self, row: Row) -> None:
        """A row as it is now."""
        key = _key(row)
        before = self._key_of.get(row.index)
        if before is not None and before != key:
            self._leave(row.index, before)
        if key is None:
            return
        cell = self.cells.setdefault(key, Cell())
        level = row.squeal_level_db if row.judged else None
        known = row.index in cell.planned
        if known and (row.index in cell.judged) == row.judged and cell.levels.get(row.index) == level:
            return
        self._key_of[row.index] = key
        cell.planned.add(row.index)
        cell.judged.discard(row.index)
        cell.levels.pop(row.index, None)
        if row.judged:
            cell.judged.add(row.index)
        if level is not None:
            cell.levels[row.index] = level
        self.revision += 1

    def _leave(self, index: int, key: Key) -> None:
        cell = self.cells[key]
        cell.planned.discard(index)
        cell.judged.discard(index)
        cell.levels.pop(index, None)
        del self._key_of[index]
        if not cell.planned:
            del self.cells[key]
        self.revision += 1


def _key(row: Row) -> Key | None:
    temperature = row.temperature_degc
    if temperature is None and row.start_degc is not None:
        temperature = TEMPERATURE_CLASS_K * round(row.start_degc / TEMPERATURE_CLASS_K)
    if not row.sound or row.pressure_bar is None or temperature is None:
        return None
    return row.pressure_bar, temperature

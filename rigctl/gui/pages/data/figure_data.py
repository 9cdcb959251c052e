"""The figures of the report as numbers to be drawn and picked. No Qt.

Job: dots and cells with the brakings behind them, and the statistics beside them, all from brakings that
count. Not its job: drawing (`figure_plot`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from rigctl.analysis.campaign_table import CampaignTable
from rigctl.analysis.friction_map import BEDDING, brakings_with_mu
from rigctl.analysis.occurrence import temperature_class_degc
from rigctl.analysis.summary import Summary, summarise
from rigctl.gui.pages.data.entry import Entry, table_of

LEVEL_RANGE_DB = (60.0, 100.0)
"""One colour scale of levels for all figures, as in the report."""
_FREQUENCIES_KHZ = (1.0, 4.0)
_FRICTION = (0.2, 0.6)


@dataclass(frozen=True)
class Dots:
    """Dots; `names` are the files behind them, `level_db` (NaN: none) gives their colour and size.

    The ranges are shown at least, further where there are dots.
    """

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    level_db: NDArray[np.float64]
    names: list[str]
    tips: list[str]
    x_range: tuple[float, float] = (0.0, 1.0)
    y_range: tuple[float, float] = (0.0, 1.0)


@dataclass(frozen=True)
class Cell:
    """One set-point of pressure and temperature: what stands in it, its colour value, and its brakings."""

    column: int
    row: int
    text: str
    value: float
    names: tuple[str, ...]


@dataclass(frozen=True)
class Cells:
    """A map over pressure (columns) and temperature (rows)."""

    pressures_bar: list[float]
    temperatures_degc: list[float]
    cells: list[Cell] = field(default_factory=list)
    low: float = 0.0
    high: float = 1.0

    def at(self, column: int, row: int) -> Cell | None:
        """The cell, None where there is no braking."""
        return next((cell for cell in self.cells if (cell.column, cell.row) == (column, row)), None)


@dataclass(frozen=True)
class FigureData:
    """One figure of a campaign and its statistics."""

    key: str
    picture: Dots | Cells
    summary: Summary


def figure_data(key: str, entries: Sequence[Entry]) -> FigureData:
    """Compute a figure by its key (see `FIGURES`)."""
    table = table_of(entries)
    names = {entry.index: entry.name for entry in entries if not entry.trashed}
    return FigureData(key, FIGURES[key](table, names), summarise(table, None))


def _pressure_frequency(table: CampaignTable, names: dict[int, str]) -> Dots:
    rows = []
    for event in table.squeals():
        pressure = event.pressure_bar if event.pressure_bar is not None else event.set_pressure_bar
        if pressure is not None:
            tip = f"{event.braking}: {pressure:.1f} bar, {event.frequency_hz:.0f} Hz, {event.level_db:.1f} dB"
            rows.append((pressure, event.frequency_hz / 1e3, event.level_db, names[event.braking], tip))
    set_points = [b.set_pressure_bar for b in table.with_sound() if b.set_pressure_bar is not None]
    return _dots(rows, (0.0, max(set_points, default=10.0)), _FREQUENCIES_KHZ)


def _frequency_temperature(table: CampaignTable, names: dict[int, str]) -> Dots:
    rows = []
    for event in table.squeals():
        if event.temperature_degc is not None:
            tip = (
                f"{event.braking}: {event.temperature_degc:.0f} °C, {event.frequency_hz:.0f} Hz, "
                f"{event.level_db:.1f} dB"
            )
            rows.append(
                (event.temperature_degc, event.frequency_hz / 1e3, event.level_db, names[event.braking], tip)
            )
    starts = [
        b.temperature_initial_degc for b in table.with_sound() if b.temperature_initial_degc is not None
    ]
    return _dots(rows, (min(starts, default=0.0), max(starts, default=100.0)), _FREQUENCIES_KHZ)


def _levels(table: CampaignTable, names: dict[int, str]) -> Dots:
    """Share of brakings (with sound) that reach a level; a dot per squealing braking."""
    base = len(table.with_sound())
    loud = sorted((b for b in table.squealing() if b.squeal_level_db is not None), key=_level, reverse=True)
    rows = []
    for count, braking in enumerate(loud, start=1):
        level, share = _level(braking), 100.0 * count / base
        rows.append(
            (level, share, level, names[braking.index], f"{braking.index}: {level:.1f} dB; {share:.0f} %")
        )
    return _dots(rows, LEVEL_RANGE_DB, (0.0, 100.0))


def _level(braking: object) -> float:
    return float(getattr(braking, "squeal_level_db", None) or 0.0)


def _friction_number(table: CampaignTable, names: dict[int, str]) -> Dots:
    rows = []
    for braking in brakings_with_mu(table):
        if braking.mean_mu is not None:
            level = math.nan if braking.squeal_level_db is None else braking.squeal_level_db
            tip = f"{braking.index}: µ {braking.mean_mu:.3f}"
            rows.append((float(braking.index), braking.mean_mu, level, names[braking.index], tip))
    return _dots(rows, (0.0, 2.0), _FRICTION)


def _dots(
    rows: list[tuple[float, float, float, str, str]],
    x_range: tuple[float, float],
    y_range: tuple[float, float],
) -> Dots:
    rows.sort(key=lambda row: -row[2] if math.isfinite(row[2]) else 0.0)  # quiet, small ones on top
    x, y, level = (np.array([row[i] for row in rows], np.float64) for i in range(3))
    return Dots(x, y, level, [row[3] for row in rows], [row[4] for row in rows], x_range, y_range)


def _occurrence(table: CampaignTable, names: dict[int, str]) -> Cells:
    def content(found: list[tuple[str, float | None]]) -> tuple[str, float]:
        levels = [level for _, level in found if level is not None]
        top = max(levels, default=math.nan)
        if len(found) == 1:
            return (f"{top:.0f}" if levels else "–"), top
        return f"{len(levels)}/{len(found)}", top

    rows = []
    for braking in table.with_sound():
        level = braking.squeal_level_db if braking.squeals else None
        rows.append((braking.set_pressure_bar, temperature_class_degc(braking), names[braking.index], level))
    return _cells(rows, content, LEVEL_RANGE_DB)


def _friction_map(table: CampaignTable, names: dict[int, str]) -> Cells:
    def content(found: list[tuple[str, float | None]]) -> tuple[str, float]:
        mean = float(np.mean([mu for _, mu in found if mu is not None]))
        return f"{mean:.2f}", mean

    found = brakings_with_mu(table)
    found = tuple(b for b in found if b.role != BEDDING) or found
    rows = [(b.set_pressure_bar, temperature_class_degc(b), names[b.index], b.mean_mu) for b in found]
    values = [mu for *_, mu in rows if mu is not None]
    return _cells(rows, content, (min(values, default=0.0), max(values, default=1.0)))


def _cells(
    rows: list[tuple[float | None, float | None, str, float | None]],
    content: Callable[[list[tuple[str, float | None]]], tuple[str, float]],
    limits: tuple[float, float],
) -> Cells:
    groups: dict[tuple[float, float], list[tuple[str, float | None]]] = {}
    for pressure, temperature, name, value in rows:
        if pressure is not None and temperature is not None:
            groups.setdefault((pressure, temperature), []).append((name, value))
    column_of = {p: n for n, p in enumerate(sorted({p for p, _ in groups}))}
    row_of = {t: n for n, t in enumerate(sorted({t for _, t in groups}))}
    cells = []
    for (pressure, temperature), found in groups.items():
        loudest_first = sorted(
            found, key=lambda item: -math.inf if item[1] is None else item[1], reverse=True
        )
        text, value = content(found)
        cells.append(
            Cell(
                column_of[pressure],
                row_of[temperature],
                text,
                value,
                tuple(name for name, _ in loudest_first),
            )
        )
    return Cells(list(column_of), list(row_of), cells, *limits)


FIGURES: dict[str, Callable[[CampaignTable, dict[int, str]], Dots | Cells]] = {
    "pressure_frequency": _pressure_frequency,
    "occurrence": _occurrence,
    "levels": _levels,
    "frequency_temperature": _frequency_temperature,
    "friction_map": _friction_map,
    "friction_number": _friction_number,
}

"""Squeal statistics over a campaign: occurrence, onset pressure, frequency, levels.

Job: numbers only, from a `CampaignTable`. NOT its job: drawing (`figures`), friction (`friction_map`).

Occurrence is the share of brakings with recorded sound whose loudest squeal reaches a level (SAE J2521:
"absolute occurrence"); a braking counts once, however many events it has.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigctl.analysis.campaign_table import BrakingRow, CampaignTable

THRESHOLDS_DB = (60, 65, 70, 75, 80, 85, 90, 95, 100)
BANDS_HZ = ((1000.0, 3000.0), (3000.0, 5000.0), (5000.0, 10000.0), (10000.0, 16000.0))
TEMPERATURE_CLASS_K = 20.0


@dataclass(frozen=True, slots=True)
class Spread:
    """Median, quartiles and range of a set of values."""

    count: int
    median: float
    lower_quartile: float
    upper_quartile: float
    minimum: float
    maximum: float


@dataclass(frozen=True, slots=True)
class PressureRow:
    """Occurrence at one pressure set-point."""

    pressure_bar: float
    brakings: int
    squealing: int
    level_max_db: float | None
    frequency_median_hz: float | None

    @property
    def share(self) -> float:
        """Share of squealing brakings, 0...1."""
        return self.squealing / self.brakings


@dataclass(frozen=True, slots=True)
class OccurrenceMap:
    """Occurrence over pressure and temperature.

    `pressures_bar` shape (n_p,), `temperatures_degc` shape (n_t,); `brakings`, `squealing` (int) and
    `level_max_db` (NaN without squeal) of shape (n_t, n_p).
    """

    pressures_bar: NDArray[np.float64]
    temperatures_degc: NDArray[np.float64]
    brakings: NDArray[np.int64]
    squealing: NDArray[np.int64]
    level_max_db: NDArray[np.float64]


def spread(values: Iterable[float | None]) -> Spread | None:
    """Median and spread of the defined values; None when there is none."""
    found = np.array([v for v in values if v is not None], dtype=np.float64)
    if found.size == 0:
        return None
    low, median, high = np.percentile(found, (25, 50, 75))
    return Spread(found.size, float(median), float(low), float(high), float(found.min()), float(found.max()))


def temperature_class_degc(row: BrakingRow) -> float | None:
    """Set temperature; without one, the initial temperature rounded to 20 K."""
    if row.set_temperature_degc is not None:
        return row.set_temperature_degc
    if row.temperature_initial_degc is None:
        return None
    return TEMPERATURE_CLASS_K * round(row.temperature_initial_degc / TEMPERATURE_CLASS_K)


def by_pressure(table: CampaignTable) -> tuple[PressureRow, ...]:
    """Occurrence per pressure set-point, in order of pressure."""
    base = [b for b in table.with_sound() if b.set_pressure_bar is not None]
    rows = []
    for pressure in sorted({b.set_pressure_bar for b in base if b.set_pressure_bar is not None}):
        here = [b for b in base if b.set_pressure_bar == pressure]
        loud = [b for b in here if b.squeals > 0]
        levels, frequencies = (
            spread(b.squeal_level_db for b in loud),
            spread(b.squeal_frequency_hz for b in loud),
        )
        rows.append(
            PressureRow(
                pressure_bar=pressure,
                brakings=len(here),
                squealing=len(loud),
                level_max_db=levels.maximum if levels else None,
                frequency_median_hz=frequencies.median if frequencies else None,
            )
        )
    return tuple(rows)


def onset_bar(table: CampaignTable) -> float | None:
    """Measured onset: the lowest pressure set-point at which a braking squealed; None without squeal."""
    return min((row.pressure_bar for row in by_pressure(table) if row.squealing), default=None)


def occurrence_map(table: CampaignTable) -> OccurrenceMap:
    """Occurrence over pressure and temperature set-points."""
    base = [
        (b, b.set_pressure_bar, temperature)
        for b in table.with_sound()
        if b.set_pressure_bar is not None and (temperature := temperature_class_degc(b)) is not None
    ]
    pressures, temperatures = sorted({p for _, p, _ in base}), sorted({t for _, _, t in base})
    shape = (len(temperatures), len(pressures))
    brakings, squealing = np.zeros(shape, np.int64), np.zeros(shape, np.int64)
    level = np.full(shape, np.nan)
    for braking, pressure, temperature in base:
        cell = temperatures.index(temperature), pressures.index(pressure)
        brakings[cell] += 1
        if braking.squeals and braking.squeal_level_db is not None:
            squealing[cell] += 1
            level[cell] = np.fmax(level[cell], braking.squeal_level_db)
    return OccurrenceMap(np.array(pressures), np.array(temperatures), brakings, squealing, level)


def occurrence_per_threshold(
    table: CampaignTable, thresholds_db: Sequence[float] = THRESHOLDS_DB
) -> tuple[tuple[float, float, float], ...]:
    """Rows (threshold, share >= threshold in dB, share >= threshold in dB(A)); empty without recorded sound.

    Below the threshold of the detector (60 dB by default) there are no events, so no share either.
    """
    base = table.with_sound()
    if not base:
        return ()
    levels = np.array([b.squeal_level_db if b.squeal_level_db is not None else -np.inf for b in base])
    a_levels = np.array([b.squeal_level_dba if b.squeal_level_dba is not None else -np.inf for b in base])
    return tuple((t, float((levels >= t).mean()), float((a_levels >= t).mean())) for t in thresholds_db)


def events_per_band(table: CampaignTable) -> tuple[tuple[float, float, int, int], ...]:
    """Rows (lower Hz, upper Hz, events, brakings with such an event)."""
    events = table.squeals()
    rows = []
    for low, high in BANDS_HZ:
        inside = [e for e in events if low <= e.frequency_hz < high]
        rows.append((low, high, len(inside), len({e.braking for e in inside})))
    return tuple(rows)

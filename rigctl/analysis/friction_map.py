"""Coefficient of friction over pressure and temperature (the paper's Fig. 6), and over the braking number.

Job: numbers only. NOT its job: mu of a single braking (rigctl.signals.friction), drawing (`figures`).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigctl.analysis.campaign_table import BrakingRow, CampaignTable
from rigctl.analysis.occurrence import temperature_class_degc

BEDDING = "bedding"


@dataclass(frozen=True, slots=True)
class FrictionMap:
    """Mean mu per set-point: `pressures_bar` (n_p,), `temperatures_degc` (n_t,), `mu` (n_t, n_p; NaN = no
    braking).
    """

    pressures_bar: NDArray[np.float64]
    temperatures_degc: NDArray[np.float64]
    mu: NDArray[np.float64]


def brakings_with_mu(table: CampaignTable) -> tuple[BrakingRow, ...]:
    """Complete brakings whose mean mu is defined."""
    return tuple(b for b in table.complete() if b.mean_mu is not None)


def friction_map(table: CampaignTable) -> FrictionMap:
    """Mean mu over pressure and temperature set-points; bedding is left out unless there is nothing else."""
    rows = brakings_with_mu(table)
    rows = tuple(b for b in rows if b.role != BEDDING) or rows
    cells: dict[tuple[float, float], list[float]] = {}
    for b in rows:
        temperature = temperature_class_degc(b)
        if b.set_pressure_bar is not None and temperature is not None and b.mean_mu is not None:
            cells.setdefault((temperature, b.set_pressure_bar), []).append(b.mean_mu)
    temperatures = sorted({t for t, _ in cells})
    pressures = sorted({p for _, p in cells})
    mu = np.full((len(temperatures), len(pressures)), np.nan)
    for (temperature, pressure), values in cells.items():
        mu[temperatures.index(temperature), pressures.index(pressure)] = np.mean(values)
    return FrictionMap(np.array(pressures), np.array(temperatures), mu)

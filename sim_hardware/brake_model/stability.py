"""Stability of the steadily sliding brake: eigenvalues of A (eq 27), onset of squeal over pressure or
friction.

NOT its job: time integration, sensitivities (eqs 24, 25), printing.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.assembly import Brake
from sim_hardware.brake_model.rigid_body import eigenvalues, largest_growth

PA_PER_BAR = 1e5

#: relative imaginary part below which an eigenvalue counts as real
_REAL = 1e-9
#: real part that rounding makes of none, as part of the largest eigenvalue
_NO_GROWTH = 1e-11
#: width to which an onset is refined, relative to the range
_ONSET_TOLERANCE = 1e-10


@dataclass(frozen=True)
class EigenPair:
    """A conjugate pair of eigenvalues, or one real eigenvalue (frequency 0).

    Attributes
    ----------
    frequency_hz : imaginary part / 2 pi
    damping_ratio : -Re / |lambda|; negative: unstable
    real_part_1_s : growth rate of the amplitude; exactly 0 where it is rounding only (no damping, free
        motion)
    """

    frequency_hz: float
    damping_ratio: float
    real_part_1_s: float

    @property
    def unstable(self) -> bool:
        """Whether a small motion of this pair grows."""
        return self.real_part_1_s > 0.0


@dataclass(frozen=True)
class Onset:
    """Where the first pair becomes unstable: `value` in bar or as mu (see the function), and its frequency.

    `frequency_hz` = 0 means that the brake diverges without vibrating.
    """

    value: float
    frequency_hz: float


@dataclass(frozen=True)
class Prediction:
    """What the model predicts: pairs without pressure and at `pressure_max_bar`, onset or None where
    stable."""

    brake: str
    mu: float
    slope_s_m: float
    pressure_max_bar: float
    pairs: tuple[EigenPair, ...]
    pairs_at_max: tuple[EigenPair, ...]
    onset_pressure_bar: float | None
    onset_frequency_hz: float | None

    @property
    def stable(self) -> bool:
        """Whether no pair becomes unstable within the range."""
        return self.onset_pressure_bar is None


def eigen_pairs(
    brake: Brake, mu: float | None = None, slope_s_m: float | None = None, pressure_bar: float = 0.0
) -> tuple[EigenPair, ...]:
    """Return the eigenvalue pairs of a brake, sorted by frequency.

    Parameters
    ----------
    mu, slope_s_m : coefficient of friction and falling slope k (s/m); the brake file's where None
    pressure_bar : brake pressure; acts only with k > 0

    Raises
    ------
    ValueError
        an argument is negative or not finite, or so large that the matrices overflow
    """
    _check(mu=mu, slope_s_m=slope_s_m, pressure_bar=pressure_bar)
    values = eigenvalues(_finite(brake.state_matrix(mu, slope_s_m, pressure_bar * PA_PER_BAR)))
    values.real[np.abs(values.real) <= _NO_GROWTH * np.abs(values).max(initial=0.0)] = 0.0
    return _pairs(values)


def onset_pressure(
    brake: Brake,
    mu: float | None = None,
    slope_s_m: float | None = None,
    pressure_max_bar: float = 25.0,
    *,
    steps: int = 100,
) -> Onset | None:
    """Return the lowest pressure (bar) at which a pair becomes unstable, or None where stable through the
    range.

    The range from 0 is scanned in `steps` steps and the first change of sign refined.

    Raises
    ------
    ValueError
        as `eigen_pairs`; no positive range, no steps
    """
    _check(mu=mu, slope_s_m=slope_s_m)
    return _first_crossing(
        lambda pressure: brake.state_matrix(mu, slope_s_m, pressure * PA_PER_BAR), pressure_max_bar, steps
    )


def onset_mu(
    brake: Brake,
    slope_s_m: float | None = None,
    pressure_bar: float = 0.0,
    mu_max: float = 1.0,
    *,
    steps: int = 100,
) -> Onset | None:
    """Return the lowest coefficient of friction at which a pair becomes unstable, or None up to `mu_max`.

    Raises
    ------
    ValueError
        as `onset_pressure`
    """
    _check(slope_s_m=slope_s_m, pressure_bar=pressure_bar)
    return _first_crossing(
        lambda mu: brake.state_matrix(mu, slope_s_m, pressure_bar * PA_PER_BAR), mu_max, steps
    )


def predict(
    brake: Brake, mu: float | None = None, slope_s_m: float | None = None, pressure_max_bar: float = 25.0
) -> Prediction:
    """Return pairs and onset of a brake over the pressures 0 to `pressure_max_bar` (section 5.2).

    `mu` and `slope_s_m` are the brake file's where None.
    """
    mu = brake.mu if mu is None else mu
    slope = brake.slope_s_m if slope_s_m is None else slope_s_m
    onset = onset_pressure(brake, mu, slope, pressure_max_bar)
    return Prediction(
        brake=brake.name,
        mu=mu,
        slope_s_m=slope,
        pressure_max_bar=pressure_max_bar,
        pairs=eigen_pairs(brake, mu, slope, 0.0),
        pairs_at_max=eigen_pairs(brake, mu, slope, pressure_max_bar),
        onset_pressure_bar=None if onset is None else onset.value,
        onset_frequency_hz=None if onset is None else onset.frequency_hz,
    )


def _check(**values: float | None) -> None:
    for name, value in values.items():
        if value is not None and not (math.isfinite(value) and value >= 0.0):
            raise ValueError(f"{name} is {value!r}; give a finite number that is not negative")


def _finite(matrices: NDArray[np.float64]) -> NDArray[np.float64]:
    if not np.isfinite(matrices).all():
        raise ValueError("the matrices overflow; give smaller values of friction, slope or pressure")
    return matrices


def _pairs(values: NDArray[np.complex128]) -> tuple[EigenPair, ...]:
    kept = values[values.imag >= -_REAL * np.abs(values)]
    pairs = [
        EigenPair(
            frequency_hz=float(value.imag) / (2.0 * math.pi) if value.imag > _REAL * abs(value) else 0.0,
            damping_ratio=-float(value.real / abs(value)) if value != 0.0 else 0.0,
            real_part_1_s=float(value.real),
        )
        for value in kept
    ]
    return tuple(sorted(pairs, key=lambda pair: (pair.frequency_hz, pair.real_part_1_s)))


def _first_crossing(matrix: Callable[[float], NDArray[np.float64]], top: float, steps: int) -> Onset | None:
    if not (math.isfinite(top) and top > 0.0):
        raise ValueError(f"the end of the range is {top!r}; give a positive number")
    if steps < 1:
        raise ValueError(f"steps is {steps!r}; give at least 1")
    grid = np.linspace(0.0, top, steps + 1)
    matrices = _finite(np.stack([matrix(float(value)) for value in grid]))
    rounding = _NO_GROWTH * float(np.abs(np.linalg.eigvals(matrices[0])).max(initial=0.0))
    unstable = np.flatnonzero(largest_growth(matrices) > rounding)
    if unstable.size == 0:
        return None
    first = int(unstable[0])
    below, value = float(grid[max(first - 1, 0)]), float(grid[first])
    while value - below > _ONSET_TOLERANCE * top:  # bisection: safe where the leading pair changes
        middle = 0.5 * (below + value)
        if largest_growth(matrix(middle)[None])[0] > rounding:
            value = middle
        else:
            below = middle
    at_onset = eigenvalues(matrix(value))
    critical = at_onset[int(np.argmax(at_onset.real))]
    return Onset(value, abs(float(critical.imag)) / (2.0 * math.pi))

"""Onset of instability of many variants of a model at once: the distance that a modification adds or takes.

The largest real part of all variants is scanned over the quantity and its first change of sign refined, all
variants in one batch. NOT its job: boundaries of a single model by Newton with mode identity, two-parameter
maps.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.design.matrix_batches import matrix_batch
from sim_hardware.brake_model.linear import PRESSURE, LinearModel

Array = NDArray[np.float64]

#: width of the refined bracket, as share of the range
_TOLERANCE = 1e-8
_MOST_REFINEMENTS = 60


@dataclass(frozen=True, slots=True)
class Onsets:
    """First instability of each variant.

    Attributes
    ----------
    quantity, low, high : range searched
    values : (b,) where it becomes unstable; `low` where it is unstable from the start, nan where it stays
        stable
    frequencies_hz : (b,) of the pair that does; 0: divergence; nan where it stays stable
    """

    quantity: str
    low: float
    high: float
    values: Array
    frequencies_hz: Array


def onsets(
    model: LinearModel,
    variants: Sequence[Mapping[str, float]],
    *,
    quantity: str = PRESSURE,
    low: float = 0.0,
    high: float = 60.0,
    steps: int = 30,
) -> Onsets:
    """First value of a quantity at which each variant becomes unstable.

    Parameters
    ----------
    variants : other values than the file's, (b,)
    steps : of the scan; an unstable range narrower than a step is missed

    Raises
    ------
    KeyError, ValueError
        unknown quantity, impossible values, an empty range
    """
    if not high > low or steps < 1:
        raise ValueError(
            f"{quantity} from {low:g} to {high:g} in {steps} steps: give a range and at least one step"
        )
    count = len(variants)
    system = _along(model, variants, quantity, low, high)
    everything = np.arange(count)
    grid = np.linspace(0.0, 1.0, steps + 1)
    start, end = np.full(count, np.nan), np.full(count, np.nan)
    growth_start, growth_end = np.full(count, -np.inf), np.full(count, np.nan)
    waiting = everything
    for number, share in enumerate(grid):
        if not waiting.size:
            break
        growth = _growth(system(waiting, np.full(waiting.size, share)))[0]
        hit = growth > 0.0
        end[waiting[hit]], growth_end[waiting[hit]] = share, growth[hit]
        if number == 0:
            start[waiting[hit]] = 0.0
        waiting = waiting[~hit]
        start[waiting], growth_start[waiting] = share, growth[~hit]
    _refine(system, np.flatnonzero(end > 0.0), start, end, growth_start, growth_end)
    frequencies = np.full(count, np.nan)
    unstable = np.flatnonzero(~np.isnan(end))
    if unstable.size:
        frequencies[unstable] = _growth(system(unstable, end[unstable]))[1]
    return Onsets(quantity, low, high, low + end * (high - low), frequencies)


_System = Callable[[NDArray[np.intp], Array], Array]


def _along(
    model: LinearModel, variants: Sequence[Mapping[str, float]], quantity: str, low: float, high: float
) -> _System:
    """State matrices of some variants at shares of the range; interpolated where that is exact."""

    def exact(chosen: NDArray[np.intp], share: Array) -> Array:
        values = [
            {**variants[i], quantity: low + s * (high - low)} for i, s in zip(chosen, share, strict=True)
        ]
        return matrix_batch(model, values).state_matrices()

    everything = np.arange(len(variants))
    first, middle, last = (exact(everything, np.full(everything.size, share)) for share in (0.0, 0.5, 1.0))
    scale = np.abs(first).max(initial=0.0) + np.abs(last).max(initial=0.0)
    if np.abs(0.5 * (first + last) - middle).max(initial=0.0) > 1e-14 * scale:
        return exact
    return lambda chosen, share: first[chosen] + share[:, None, None] * (last[chosen] - first[chosen])


def _growth(matrices: Array) -> tuple[Array, Array]:
    """Largest real part (1/s) and its frequency (Hz) of each matrix."""
    values: NDArray[np.complex128] = np.linalg.eigvals(matrices).astype(complex)
    leading = values.real.argmax(axis=1)
    rows = np.arange(len(matrices))
    return values.real[rows, leading], np.abs(values.imag[rows, leading]) / (2.0 * np.pi)


def _refine(
    system: _System,
    active: NDArray[np.intp],
    start: Array,
    end: Array,
    growth_start: Array,
    growth_end: Array,
) -> None:
    """Shrink the brackets in place: regula falsi with the Illinois weights, all variants together."""
    weight_start, weight_end = growth_start.copy(), growth_end.copy()
    for number in range(_MOST_REFINEMENTS):
        active = active[end[active] - start[active] > _TOLERANCE]
        if not active.size:
            return
        a, b, fa, fb = start[active], end[active], weight_start[active], weight_end[active]
        share = a - fa * (b - a) / (fb - fa) if number % 4 < 3 else 0.5 * (a + b)
        share = np.clip(share, a + 0.25 * _TOLERANCE, b - 0.25 * _TOLERANCE)
        growth = _growth(system(active, share))[0]
        above = growth > 0.0
        upper, lower = active[above], active[~above]
        end[upper], weight_end[upper] = share[above], growth[above]
        weight_start[upper] *= 0.5
        start[lower], weight_start[lower] = share[~above], growth[~above]
        weight_end[lower] *= 0.5

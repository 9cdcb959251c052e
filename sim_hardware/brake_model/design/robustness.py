"""Robustness against a change of friction (eq 25), of a design and of its modifications (4.3.3).

S(i) = (Re l_i(mu2) - Re l_i(mu1)) / (mu2 - mu1) for every eigenvalue i; the paper takes mu1 = 0.4, mu2 = 0.6.
Positive: the eigenvalue loses damping as friction grows. The sum over all eigenvalues is zero wherever mu
enters K and D without changing tr(M^-1 D): every gain is another mode's loss, so the maximum is what can be
compared.
NOT its job: changes at constant friction (`effects`), judging (`rigctl.model.claims`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.design.resolving import Resolved, resolve
from sim_hardware.brake_model.design.resolving_band import resolve_in_band
from sim_hardware.brake_model.design.variations import Variation
from sim_hardware.brake_model.linear import MU, LinearModel

Array = NDArray[np.float64]
ROUNDING = 1e-9  # of the largest value


@dataclass(frozen=True, slots=True)
class Robustness:
    """Values of eq 25.

    Attributes
    ----------
    quantity, low, high : what changes, from where to where
    basic : (m,) 1/s per unit, of the design as it is
    varied : (v, m) of the modifications
    """

    quantity: str
    low: float
    high: float
    resolved: Resolved
    basic: Array
    varied: Array

    @property
    def variations(self) -> tuple[Variation, ...]:
        """The modifications, (v,)."""
        return self.resolved.variations

    @property
    def frequencies_hz(self) -> Array:
        """(m,) of the modes of the basic design at `low`."""
        return self.resolved.frequencies_hz

    @property
    def loses_damping(self) -> NDArray[np.bool_]:
        """(m,) modes of the basic design that lose damping, by more than rounding can make of no change."""
        return self.basic > ROUNDING * np.nanmax(np.abs(self.basic))

    @property
    def reference(self) -> float:
        """Maximum of the basic design: the line in Figs 8 and 9."""
        return float(np.nanmax(self.basic))

    @property
    def maxima(self) -> Array:
        """(v,) maximum over all eigenvalues of each modification (Fig. 9)."""
        return np.nanmax(self.varied, axis=1)

    @property
    def worst_modes(self) -> NDArray[np.intp]:
        """(v,) eigenvalue that has the maximum."""
        return np.nanargmax(self.varied, axis=1)

    @property
    def deviations(self) -> Array:
        """(v,) maximum minus reference; large of either sign: the group matters for robustness (4.3.3)."""
        return self.maxima - self.reference

    @property
    def sums(self) -> Array:
        """(v + 1,) sum over all eigenvalues: basic design first."""
        return np.concatenate([[self.basic.sum()], self.varied.sum(axis=1)])

    def maxima_below(self, frequency_hz: float) -> Array:
        """(v,) maximum over the eigenvalues below a frequency; nan where there is none."""
        below = self.frequencies_hz < frequency_hz
        if not below.any():
            return np.full(len(self.varied), np.nan)
        return np.nanmax(self.varied[:, below], axis=1)


def robustness(
    model: LinearModel,
    variations: Sequence[Variation] = (),
    values: Mapping[str, float] | None = None,
    *,
    low: float = 0.4,
    high: float = 0.6,
    quantity: str = MU,
    band_hz: tuple[float, float] | None = None,
) -> Robustness:
    """Eq 25 for a design and its modifications.

    Parameters
    ----------
    values : other values that differ from the file's
    low, high : ends of the change of `quantity`, the coefficient of friction unless said otherwise
    band_hz : only the eigenvalues of a frequency band (large models)

    Raises
    ------
    KeyError, ValueError
        unknown quantity, impossible values, low equal to high
    """
    if not high > low:
        raise ValueError(f"{quantity} from {low:g} to {high:g}: give a second value larger than the first")
    points = ({quantity: low}, {quantity: high})
    if band_hz is None:
        resolved = resolve(model, variations, points, values)
    else:
        resolved = resolve_in_band(model, variations, points, values, band_hz)
    span = high - low
    basic = (resolved.nominal[1] - resolved.nominal[0]).real / span  # eq 25
    varied = (resolved.varied[:, 1] - resolved.varied[:, 0]).real / span  # eq 25
    return Robustness(quantity, low, high, resolved, basic, varied)

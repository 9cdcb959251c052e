"""Which modifications quieten a brake: gains, side effects, robustness over friction, and distance to the
onset.

For each modification the changes of all real parts are taken at several coefficients of friction. Gain: by
how much the real parts below a frequency fall in all, at the friction where that is least. Harm: the largest
rise of any real part at any of them, as share of that mode's own real part. `RecommendationRule` turns both
into a verdict, and is the one place of its thresholds. NOT its job: words for people (`rigctl.model.advice`),
choosing modifications.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.design.effects import one_of_each_pair
from sim_hardware.brake_model.design.margins import Onsets, onsets
from sim_hardware.brake_model.design.resolving import Resolved, resolve
from sim_hardware.brake_model.design.resolving_band import resolve_in_band
from sim_hardware.brake_model.design.variations import Variation
from sim_hardware.brake_model.linear import MU, PRESSURE, SLOPE, LinearModel, value_of

Array = NDArray[np.float64]
Verdict = Literal["recommended", "with care", "no effect", "not recommended"]
VERDICTS: tuple[Verdict, ...] = ("recommended", "with care", "no effect", "not recommended")


#: rises below this share of a real part are rounding
_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True)
class RecommendationRule:
    """Thresholds.

    - gain counts from `least_gain` x the mean |Re| of the modes below the frequency; a loss likewise.
    - a mode is made worse when its real part rises by more than `harm` x its own |Re|.
    - an onset moves when it changes by more than `onset` x its value.
    helps: gain at every friction, or a higher onset without loss. recommended: helps, no mode worse, onset
    not lower. with care: helps, but a mode is worse or the onset lower. no effect: none of this.
    Else not recommended.
    """

    below_hz: float = 5000.0
    least_gain: float = 1e-2
    harm: float = 0.01
    onset: float = 0.005


ADVICE_RULE = RecommendationRule()


@dataclass(frozen=True, slots=True)
class Recommendations:
    """Measures of each modification, (v,), in the order of `variations`; `order` ranks them.

    Attributes
    ----------
    mus : coefficients of friction looked at
    gains : fall of the sum of real parts below the frequency, least over friction, 1/s (one per pair);
        negative: rise
    harm : largest rise of a real part as share of its |Re|, at any friction and frequency; 0 where none rises
    harmed : mode (index) with that rise
    least_gain_1_s : what counts as gain
    onset_changes : change of the onset, unit of its quantity; nan where either never becomes unstable
    sure : whether the identity of all modes is certain throughout
    """

    rule: RecommendationRule
    mus: tuple[float, ...]
    resolved: Resolved
    gains: Array
    least_gain_1_s: float
    harm: Array
    harmed: NDArray[np.intp]
    onset: Onsets | None
    onset_changes: Array
    sure: NDArray[np.bool_]
    verdicts: tuple[Verdict, ...]

    @property
    def variations(self) -> tuple[Variation, ...]:
        """The modifications, (v,)."""
        return self.resolved.variations

    @property
    def order(self) -> NDArray[np.intp]:
        """Best first: by verdict, then gain."""
        return np.lexsort((-self.gains, np.array([VERDICTS.index(verdict) for verdict in self.verdicts])))


def recommend(
    model: LinearModel,
    variations: Sequence[Variation],
    values: Mapping[str, float] | None = None,
    *,
    mus: Sequence[float] = (0.3, 0.4, 0.5, 0.6),
    pressure_max_bar: float = 60.0,
    rule: RecommendationRule = ADVICE_RULE,
    band_hz: tuple[float, float] | None = None,
) -> Recommendations:
    """Measure and rank modifications.

    Parameters
    ----------
    values : other values that differ from the file's
    mus : coefficients of friction at which a modification has to help; empty for models without friction
    pressure_max_bar : the onset is searched from 0 to here, at the model's own friction, where it falls with
        speed
    band_hz : only the eigenvalues of a frequency band, and no onset (large models)

    Raises
    ------
    KeyError, ValueError
        unknown quantity, impossible values
    """
    points = tuple({MU: mu} for mu in mus) or ({},)
    if band_hz is None:
        resolved = resolve(model, variations, points, values)
    else:
        resolved = resolve_in_band(model, variations, points, values, band_hz)
    kept = one_of_each_pair(resolved.nominal[0])
    before = resolved.nominal[:, kept].real
    changes = np.nan_to_num(resolved.varied[:, :, kept].real - before)
    below = resolved.frequencies_hz[kept] < rule.below_hz
    gains = -changes[:, :, below].sum(axis=2).max(axis=1)
    scale = np.maximum(np.abs(before), 1e-9 * np.abs(resolved.nominal).max())
    rises = (changes / scale).max(axis=1)
    harmed = rises.argmax(axis=1)
    harm = rises[np.arange(len(rises)), harmed]
    harm = np.where(harm > _ROUNDING, harm, 0.0)
    onset = _onset(model, variations, values, pressure_max_bar) if band_hz is None else None
    change = np.full(len(variations), np.nan) if onset is None else onset.values[1:] - onset.values[0]
    least = rule.least_gain * float(np.abs(before[:, below]).mean()) if below.any() else 0.0
    share = np.zeros(len(variations)) if onset is None else np.nan_to_num(change / onset.values[0])
    verdicts: tuple[Verdict, ...] = tuple(
        _verdict(float(g), float(h), float(s), least, rule)
        for g, h, s in zip(gains, harm, share, strict=True)
    )
    return Recommendations(
        rule,
        tuple(mus),
        resolved,
        gains,
        least,
        harm,
        kept[harmed],
        onset,
        change,
        np.asarray(resolved.sure.all(axis=(1, 2))),
        verdicts,
    )


def _onset(
    model: LinearModel, variations: Sequence[Variation], values: Mapping[str, float] | None, high: float
) -> Onsets | None:
    """Onset pressures, the design as it is first; None without falling friction, or where it never
    squeals.
    """
    if not {PRESSURE, SLOPE} <= set(model.quantities) or value_of(model, SLOPE, values) == 0.0:
        return None
    found = onsets(model, [dict(values or {}), *(v.values(model, values) for v in variations)], high=high)
    return None if np.isnan(found.values[0]) or found.values[0] == 0.0 else found


def _verdict(gain: float, harm: float, onset: float, least: float, rule: RecommendationRule) -> Verdict:
    later, earlier, worse = onset > rule.onset, onset < -rule.onset, harm > rule.harm
    if gain > least or (later and gain >= -least):
        return "with care" if worse or earlier else "recommended"
    if worse or earlier or later or gain < -least:
        return "not recommended"
    return "no effect"

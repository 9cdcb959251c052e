"""Influence of modifications at constant friction, and what kind of effect each has (4.3.4).

The paper names four effects by eye from bar charts of Delta Re: narrow band, mode coupling, broad band,
monodirectional. `EffectRule` is that eye in numbers; all thresholds are there and nowhere else.
NOT its job: robustness against friction (`robustness`), ranking (`recommending`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.design.resolving import Resolved, resolve
from sim_hardware.brake_model.design.resolving_band import resolve_in_band
from sim_hardware.brake_model.design.variations import Variation
from sim_hardware.brake_model.linear import MU, LinearModel

Array = NDArray[np.float64]
EffectClass = Literal[
    "negligible", "narrow band", "broad band", "mode coupling", "monodirectional", "bidirectional"
]


@dataclass(frozen=True, slots=True)
class EffectRule:
    """Thresholds of the effect classes. d_j: change of the real part of mode j (one per pair).

    - negligible: no |d_j| exceeds `negligible` x |Re| of its mode; no other class then.
    - The band of an effect is the narrowest range of neighbouring modes that holds `band_share` of sum |d_j|.
      narrow band: it spans at most `narrow_octaves`; broad band: more than `broad_octaves`, over at least
      `broad_modes` modes that take part (|d_j| >= `taking_part` x the largest).
    - mode coupling: two modes adjacent in frequency move in opposite directions, each by at least
      `coupling_size` x the largest |d|, and their changes cancel to at most `coupling_rest` x the larger one.
    - monodirectional: the changes against the main direction are at most `against` of sum |d_j|; else
      bidirectional.
    """

    negligible: float = 1e-3
    band_share: float = 0.8
    narrow_octaves: float = 1.0
    broad_octaves: float = 1.5
    broad_modes: int = 3
    taking_part: float = 0.1
    coupling_size: float = 0.25
    coupling_rest: float = 0.5
    against: float = 0.1


RULE = EffectRule()


@dataclass(frozen=True, slots=True)
class Effect:
    """What a modification does to the pattern of eigenvalues.

    Attributes
    ----------
    classes : all that apply, in the order of `EffectRule`
    band_hz : lowest and highest frequency of the narrowest band with most of the effect
    against : share of sum |d| against the main direction, 0 to 0.5
    direction : -1 stabilising, +1 destabilising on the whole
    coupled : pairs of modes (indices into the arrays given) that move in opposite directions
    total : sum of d, 1/s
    """

    classes: tuple[EffectClass, ...]
    band_hz: tuple[float, float]
    against: float
    direction: int
    coupled: tuple[tuple[int, int], ...]
    total: float


@dataclass(frozen=True, slots=True)
class Influence:
    """Change of real parts by modifications at one working point.

    Attributes
    ----------
    changes : (v, m) Delta Re, 1/s, over all eigenvalues
    effects : (v,)
    """

    resolved: Resolved
    changes: Array
    effects: tuple[Effect, ...]

    @property
    def variations(self) -> tuple[Variation, ...]:
        """The modifications, (v,)."""
        return self.resolved.variations


def classify(changes: Array, frequencies_hz: Array, real_parts: Array, rule: EffectRule = RULE) -> Effect:
    """Effect classes of one modification.

    Parameters
    ----------
    changes : (n,) change of the real part of each mode, 1/s; one per conjugate pair
    frequencies_hz, real_parts : (n,) of the modes before the change
    """
    order = np.argsort(frequencies_hz, kind="stable")
    d, f = changes[order], frequencies_hz[order]
    size = np.abs(d)
    total, largest = float(size.sum()), float(size.max(initial=0.0))
    if not (size > rule.negligible * np.abs(real_parts[order])).any():
        return Effect(("negligible",), (0.0, 0.0), 0.0, 0, (), float(d.sum()))
    classes: list[EffectClass] = []
    low, high, octaves = _band(size, f, rule.band_share)
    if octaves <= rule.narrow_octaves:
        classes.append("narrow band")
    elif octaves > rule.broad_octaves and int((size >= rule.taking_part * largest).sum()) >= rule.broad_modes:
        classes.append("broad band")
    coupled = tuple(
        (int(order[j]), int(order[j + 1]))
        for j in range(d.size - 1)
        if d[j] * d[j + 1] < 0.0
        and min(size[j], size[j + 1]) >= rule.coupling_size * largest
        and abs(d[j] + d[j + 1]) <= rule.coupling_rest * max(size[j], size[j + 1])
    )
    if coupled:
        classes.append("mode coupling")
    rising = float(d[d > 0.0].sum())
    against = min(rising, total - rising) / total
    classes.append("monodirectional" if against <= rule.against else "bidirectional")
    return Effect(
        tuple(classes), (low, high), against, 1 if 2.0 * rising > total else -1, coupled, float(d.sum())
    )


def influence(
    model: LinearModel,
    variations: Sequence[Variation],
    values: Mapping[str, float] | None = None,
    *,
    mu: float | None = 0.4,
    rule: EffectRule = RULE,
    band_hz: tuple[float, float] | None = None,
) -> Influence:
    """Delta Re of all eigenvalues by modifications at constant friction, with effect classes.

    Parameters
    ----------
    values : other values that differ from the file's
    mu : coefficient of friction; None for models without
    band_hz : only the eigenvalues of a frequency band (large models)

    Raises
    ------
    KeyError, ValueError
        unknown quantity, impossible values
    """
    points = ({} if mu is None else {MU: mu},)
    if band_hz is None:
        return influence_of(resolve(model, variations, points, values), rule=rule)
    return influence_of(resolve_in_band(model, variations, points, values, band_hz), rule=rule)


def influence_of(resolved: Resolved, point: int = 0, *, rule: EffectRule = RULE) -> Influence:
    """Delta Re and effect classes from modifications that are solved already, at one of their working
    points.
    """
    nominal = resolved.nominal[point]
    changes = np.nan_to_num(
        (resolved.varied[:, point] - nominal).real
    )  # modes that left a band count as still
    kept, frequencies = one_of_each_pair(nominal), resolved.frequencies_hz
    effects = tuple(classify(row[kept], frequencies[kept], nominal.real[kept], rule) for row in changes)
    return Influence(resolved, changes, effects)


def one_of_each_pair(values: NDArray[np.complex128]) -> NDArray[np.intp]:
    """Indices of one eigenvalue of each conjugate pair, and of the real ones."""
    return np.flatnonzero(values.imag >= 0.0)


def _band(size: Array, frequencies_hz: Array, share: float) -> tuple[float, float, float]:
    """Narrowest range of neighbouring modes that holds a share of the effect: ends in Hz, width in octaves.

    Modes without vibration (0 Hz) count as an octave below the slowest that vibrates.
    """
    moving = frequencies_hz[frequencies_hz > 0.0]
    floor = moving.min() / 2.0 if moving.size else 1.0
    octave = np.log2(np.maximum(frequencies_hz, floor))
    needed, sums = share * size.sum() * (1.0 - 1e-12), np.concatenate([[0.0], np.cumsum(size)])
    best = (0, size.size - 1)
    width = octave[-1] - octave[0]
    for first in range(size.size):
        last = int(np.searchsorted(sums, sums[first] + needed)) - 1
        if last < size.size and octave[last] - octave[first] < width:
            best, width = (first, last), octave[last] - octave[first]
    return float(frequencies_hz[best[0]]), float(frequencies_hz[best[1]]), float(width)

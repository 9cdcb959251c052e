"""Scatter of parameters: random brakes around a model, the share of them that squeal, and what decides it.

A real brake's parameters differ from the file's. Every chosen variable (a parameter, or a group whose members
change alike) is multiplied by its own random factor; samples are independent, so that the share of squealing
samples has the confidence interval of a binomial share. Laws of the factor f, for a spread s:

    uniform     f = 1 + s u, u uniform on [-1, 1]: "±5 %" as bounds; standard deviation s / sqrt(3)
    lognormal   f = exp(s z), z normal: s is the standard deviation of ln f; every factor is positive

NOT its job: sharing samples out to workers, tables and figures (`rigctl.model.scatter`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy import special

from sim_hardware.brake_model.linear import LinearModel, known, value_of

Array = NDArray[np.float64]
Law = Literal["uniform", "lognormal"]
LAWS: tuple[Law, ...] = ("uniform", "lognormal")


@dataclass(frozen=True, slots=True)
class Variable:
    """Quantities that are multiplied by one common factor.

    Attributes
    ----------
    name, title : key, and name for people
    members : quantities of the model
    """

    name: str
    title: str
    members: tuple[str, ...]


def variables(
    model: LinearModel, names: Sequence[str] | None = None, groups: Sequence[str] = ()
) -> tuple[Variable, ...]:
    """Variables of a study: single quantities and groups.

    Parameters
    ----------
    names : quantities; where None and no group is given, every parameter of the file that is not 0 (not the
        operating values mu, slope, pressure, piston area; not the places of expressions)
    groups : names of the file's parameter groups

    Raises
    ------
    KeyError
        unknown quantity or group
    ValueError
        a quantity twice, or one whose value is 0 (a factor does not change it)
    """
    if names is None:
        names = (
            ()
            if groups
            else tuple(n for n, q in model.quantities.items() if _is_parameter(n, q.kind, q.value))
        )
    found = [Variable(name, name, (known(model, name).name,)) for name in names]
    by_name = {group.name: group for group in model.groups}
    for name in groups:
        if name not in by_name:
            listed = ", ".join(by_name) or "none; add [[groups]] to its file"
            raise KeyError(f"the model '{model.name}' has no group {name!r}; it has: {listed}")
        found.append(Variable(name, by_name[name].title, by_name[name].members))
    owner: dict[str, str] = {}
    for variable in found:
        for member in variable.members:
            if member in owner:
                raise ValueError(f"{member} is varied twice: by {owner[member]} and by {variable.name}")
            owner[member] = variable.name
            if value_of(model, member) == 0.0:
                raise ValueError(f"{member} is 0 in the model '{model.name}': a factor does not change it")
    if not found:
        raise ValueError(f"the model '{model.name}' has no parameter to vary")
    return tuple(found)


def changed(
    model: LinearModel, chosen: Sequence[Variable], factors: Array, base: Mapping[str, float] | None = None
) -> dict[str, float]:
    """Values of a model whose variables are multiplied by factors, on top of `base` (other values,
    working point).
    """
    values = dict(base or {})
    for variable, factor in zip(chosen, factors.tolist(), strict=True):
        for member in variable.members:
            values[member] = value_of(model, member, base) * factor
    return values


def draw(random: np.random.Generator, count: int, spread: float, law: Law) -> Array:
    """Random factors of one sample, (count,).

    Raises
    ------
    ValueError
        unknown law, or a spread that is not positive or gives factors that are not
    """
    check_law(spread, law)
    if law == "uniform":
        return 1.0 + spread * random.uniform(-1.0, 1.0, count)
    return np.exp(spread * random.standard_normal(count))


def check_law(spread: float, law: str) -> None:
    """Refuse what `draw` cannot use.

    Raises
    ------
    ValueError
        see `draw`
    """
    if law not in LAWS:
        raise ValueError(f"unknown law {law!r}; there are: {', '.join(LAWS)}")
    if not (0.0 < spread < 1.0):
        raise ValueError(f"spread {spread!r}: give a share between 0 and 1, for example 0.05 for 5 %")


@dataclass(frozen=True, slots=True)
class Shares:
    """Shares with their confidence interval, each (m,)."""

    share: Array
    low: Array
    high: Array


def wilson(successes: Array, trials: int, confidence: float = 0.95) -> Shares:
    """Binomial shares with Wilson's score interval.

    Its coverage is near the stated confidence also for shares near 0 and 1 and few trials, where the usual
    normal interval has no width.

    Parameters
    ----------
    successes : (m,) counts out of `trials`

    Raises
    ------
    ValueError
        no trials, or counts outside 0 to trials
    """
    counts = np.atleast_1d(np.asarray(successes, dtype=float))
    if trials < 1 or (counts < 0).any() or (counts > trials).any():
        raise ValueError(f"counts {successes!r} of {trials} trials: give counts from 0 to a positive number")
    z = float(special.ndtri(0.5 + 0.5 * confidence))
    share = counts / trials
    centre = (share + z**2 / (2 * trials)) / (1 + z**2 / trials)
    half = z / (1 + z**2 / trials) * np.sqrt(share * (1 - share) / trials + z**2 / (4 * trials**2))
    low = np.where(counts == 0, 0.0, centre - half)
    high = np.where(counts == trials, 1.0, centre + half)
    return Shares(share, low, high)


@dataclass(frozen=True, slots=True)
class Drivers:
    """Which variables decide an outcome.

    Attributes
    ----------
    correlation : (k,) Spearman's rank correlation of each factor with the outcome; nan with too few samples
    threshold : |correlation| above which it is unlikely (5 % for all variables together) to be chance
    samples : samples that entered
    """

    correlation: Array
    threshold: float
    samples: int


def drivers(factors: Array, outcome: Array, significance: float = 0.05) -> Drivers:
    """Rank correlation of factors (n, k) with an outcome (n,); nan outcomes are left out, inf rank highest.

    The threshold is that of a single correlation at `significance` / k (Bonferroni), by Student's t.
    """
    from scipy import stats  # takes a second to load, which workers need not wait for

    there = ~np.isnan(outcome)
    count, k = int(there.sum()), factors.shape[1]
    ranked = stats.rankdata(outcome[there]) if count else np.empty(0)
    if count < 4 or np.ptp(ranked) == 0.0:
        return Drivers(np.full(k, np.nan), np.nan, count)
    ranks = stats.rankdata(factors[there], axis=0)
    a, b = ranks - ranks.mean(axis=0), ranked - ranked.mean()
    correlation = (a * b[:, None]).sum(axis=0) / np.sqrt((a**2).sum(axis=0) * (b**2).sum())
    t = float(special.stdtrit(count - 2, 1.0 - 0.5 * significance / k))
    return Drivers(correlation, t / float(np.sqrt(count - 2 + t**2)), count)


def _is_parameter(name: str, kind: str, value: float) -> bool:
    return kind != "operating" and "." not in name and value != 0.0

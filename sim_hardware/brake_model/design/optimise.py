"""Optimisation: chosen quantities within bounds for the largest stability margin over an operating range.

The margin is the smallest damping ratio -Re / |lambda| of all eigenvalues at all operating points (values
of mu and pressure, say): positive where the brake is stable in the whole range, and then the larger the
further from squeal; negative where it squeals somewhere. A smallest value of many is not smooth where the
smallest changes hands; so the largest t is sought with every damping ratio >= t (epigraph), which is
smooth, by SLSQP with exact gradients (eq 24). That finds the optimum of a valley; starts spread over the
bounds (Sobol sequence) find the valleys. NOT its job: sharing starts out to workers, tables and figures
(`rigctl.model.optimise`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from sim_hardware.brake_model.design.scatter import Variable
from sim_hardware.brake_model.design.sensitivity import sensitivities_of
from sim_hardware.brake_model.eigen.eigen_systems import EigenSystem, eigen_system
from sim_hardware.brake_model.eigen.first_onset import check_dense
from sim_hardware.brake_model.linear import LinearModel, value_of

Array = NDArray[np.float64]

#: least damping ratios of every operating point that become constraints: those that may become the smallest
_WATCHED = 4
#: modulus of an eigenvalue, as share of the largest, below which the body is free (rigid-body motion)
_FREE = 1e-6
#: least ratio of bounds, and largest
_LEAST_RATIO, _MOST_RATIO = 1.0 + 1e-9, 100.0
#: a value this close to its bound, as share of the range, is at it
_AT_BOUND = 1e-3


@dataclass(frozen=True, slots=True)
class Bounds:
    """A variable with its bounds as factors on the file's values (all members alike)."""

    variable: Variable
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Margin:
    """Smallest damping ratio, and where.

    Attributes
    ----------
    damping_ratio : the margin; negative: unstable
    real_part_1_s, frequency_hz : of that eigenvalue
    point : operating point
    """

    damping_ratio: float
    real_part_1_s: float
    frequency_hz: float
    point: Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Optimum:
    """Where a start ended.

    Attributes
    ----------
    factors : (k,) on the file's values
    margin : smallest damping ratio there
    evaluations : gradients evaluated
    converged : whether SLSQP's own test was met; the margin is right either way
    message : SLSQP's words
    """

    factors: Array
    margin: float
    evaluations: int
    converged: bool
    message: str


def check_bounds(
    model: LinearModel,
    bounds: Sequence[Bounds],
    points: Sequence[Mapping[str, float]],
    base: Mapping[str, float],
) -> None:
    """Refuse bounds that make no sense.

    Raises
    ------
    ValueError
        not finite, not positive factors, low not below high, further apart than 100 times, or a model that is
        impossible at a bound; a quantity that is also of the operating range
    KeyError
        unknown quantity
    """
    check_dense(model)
    if not bounds:
        raise ValueError("nothing is free: name quantities or groups that may change")
    if not points:
        raise ValueError("the operating range is empty: give at least one value of mu and of pressure")
    for bound in bounds:
        name, low, high = bound.variable.name, bound.low, bound.high
        if not (np.isfinite(low) and np.isfinite(high)):
            raise ValueError(f"{name}: bounds {low:g} to {high:g} are not finite")
        if not low > 0.0:
            raise ValueError(
                f"{name}: a bound has another sign than the file's value or is 0; give bounds of its sign"
            )
        if not low * _LEAST_RATIO < high:
            raise ValueError(f"{name}: the lower bound is not below the upper one")
        if high > _MOST_RATIO * low:
            raise ValueError(
                f"{name}: bounds {high / low:.3g} times apart are no design range; at most {_MOST_RATIO:g}"
            )
        for member in bound.variable.members:
            if any(member in point for point in points):
                raise ValueError(f"{member} belongs to the operating range and cannot be free")
        for factor in (low, high):
            try:
                model.matrices({**values_at(model, [bound], np.array([factor]), base), **points[0]})
            except ValueError as error:
                raise ValueError(f"{name}: the model is impossible at a bound: {error}") from error


def values_at(
    model: LinearModel, bounds: Sequence[Bounds], factors: Array, base: Mapping[str, float] | None = None
) -> dict[str, float]:
    """Values of the model at factors (k,) on top of `base`."""
    values = dict(base or {})
    for bound, factor in zip(bounds, factors.tolist(), strict=True):
        for member in bound.variable.members:
            values[member] = value_of(model, member, base) * factor
    return values


def stability_margin(
    model: LinearModel, points: Sequence[Mapping[str, float]], values: Mapping[str, float] | None = None
) -> Margin:
    """Smallest damping ratio over operating points, by plain eigenvalues of the state matrix (eq 27).

    Rigid-body motions (eigenvalue 0) do not count.

    Parameters
    ----------
    points : operating points, such as {"mu": 0.4, "pressure": 20.0}
    values : other values than the file's
    """
    stack = np.stack([model.matrices({**(values or {}), **point}).state_matrix() for point in points])
    found = np.linalg.eigvals(stack)
    size = np.abs(found)
    free = size <= _FREE * size.max(axis=1, keepdims=True)
    ratio = np.where(free, np.inf, -found.real / np.where(free, 1.0, size))
    place, mode = np.unravel_index(int(ratio.argmin()), ratio.shape)
    worst = found[place, mode]
    return Margin(
        float(ratio[place, mode]),
        float(worst.real),
        float(abs(worst.imag)) / (2.0 * np.pi),
        dict(points[int(place)]),
    )


def starts(count: int, dimensions: int, seed: int) -> Array:
    """Starting points in the unit cube, (count, dimensions): a scrambled Sobol sequence; of a larger count
    the first ones are the same.
    """
    from scipy.stats import qmc  # takes a second to load, which workers need not wait for

    power = max(0, int(np.ceil(np.log2(max(count, 1)))))
    return qmc.Sobol(dimensions, scramble=True, rng=np.random.default_rng(seed)).random_base2(power)[:count]


def improve(
    model: LinearModel,
    bounds: Sequence[Bounds],
    points: Sequence[Mapping[str, float]],
    start: Array,
    *,
    base: Mapping[str, float] | None = None,
    iterations: int = 60,
    accuracy: float = 1e-8,
) -> Optimum:
    """Climb from a start to the largest margin of its valley.

    Parameters
    ----------
    start : (k,) place between the bounds, on a logarithmic scale, 0 to 1
    iterations, accuracy : of SLSQP; accuracy of the damping ratio

    Raises
    ------
    ValueError, KeyError
        impossible values (see `check_bounds`)
    """
    low = np.log([bound.low for bound in bounds])
    span = np.log([bound.high for bound in bounds]) - low
    names = tuple(member for bound in bounds for member in bound.variable.members)
    owner = np.repeat(np.arange(len(bounds)), [len(bound.variable.members) for bound in bounds])
    table = _Remembered(lambda y: _watched(model, bounds, points, np.exp(low + span * y), names, owner, base))
    best, best_margin = np.clip(start, 0.0, 1.0), -np.inf

    def note(y: Array) -> tuple[Array, Array]:
        nonlocal best, best_margin
        ratios, slopes = table(np.clip(y, 0.0, 1.0))
        if ratios.min() > best_margin:
            best, best_margin = np.clip(y, 0.0, 1.0), float(ratios.min())
        return ratios, slopes

    first = note(best)[0]
    solution = minimize(
        lambda z: -100.0 * z[-1],  # damping ratio in per cent, so that SLSQP's scale is 1
        np.append(best, first.min()),
        jac=lambda z: np.append(np.zeros(z.size - 1), -100.0),
        bounds=[(0.0, 1.0)] * len(bounds) + [(-1.0, 1.0)],
        constraints=[
            {
                "type": "ineq",
                "fun": lambda z: 100.0 * (note(z[:-1])[0] - z[-1]),
                "jac": lambda z: 100.0 * np.column_stack([note(z[:-1])[1] * span, -np.ones(first.size)]),
            }
        ],
        method="SLSQP",
        options={"maxiter": iterations, "ftol": 100.0 * accuracy},
    )
    note(solution.x[:-1])
    return Optimum(
        np.exp(low + span * best),
        best_margin,
        table.evaluations,
        bool(solution.success),
        str(solution.message),
    )


def at_bounds(bounds: Sequence[Bounds], factors: Array) -> tuple[str, ...]:
    """Which bound each factor is at: "lower", "upper" or ""."""
    found = []
    for bound, factor in zip(bounds, factors.tolist(), strict=True):
        share = (np.log(factor) - np.log(bound.low)) / (np.log(bound.high) - np.log(bound.low))
        found.append("lower" if share < _AT_BOUND else "upper" if share > 1.0 - _AT_BOUND else "")
    return tuple(found)


class _Remembered:
    """A function of a vector that keeps its last values: SLSQP asks for value and gradient apart."""

    def __init__(self, function: Callable[[Array], tuple[Array, Array]]) -> None:
        self._function = function
        self._key: bytes | None = None
        self._value: tuple[Array, Array] | None = None
        self.evaluations = 0

    def __call__(self, y: Array) -> tuple[Array, Array]:
        if self._value is None or y.tobytes() != self._key:
            self._key, self._value = y.tobytes(), self._function(y)
            self.evaluations += 1
        return self._value


def _watched(
    model: LinearModel,
    bounds: Sequence[Bounds],
    points: Sequence[Mapping[str, float]],
    factors: Array,
    names: Sequence[str],
    owner: NDArray[np.intp],
    base: Mapping[str, float] | None,
) -> tuple[Array, Array]:
    """The least damping ratios of every operating point, and their gradients by the logarithms of the
    factors.

    (n_points * _WATCHED,), (n_points * _WATCHED, k)
    """
    values = values_at(model, bounds, factors, base)
    all_ratios, all_slopes = [], []
    for point in points:
        at = {**values, **point}
        with np.errstate(
            over="ignore", invalid="ignore"
        ):  # rigid-body motions have vectors beyond all numbers
            system = eigen_system(model.matrices(at))
        ratios = _damping_ratios(system)
        least = np.argsort(ratios, kind="stable")[:_WATCHED]
        slopes = _ratio_slopes(model, system, names, at)[:, least]
        gradient = np.zeros((least.size, len(bounds)))
        np.add.at(gradient.T, owner, slopes)
        all_ratios.append(ratios[least])
        all_slopes.append(gradient)
    return np.concatenate(all_ratios), np.concatenate(all_slopes)


def _damping_ratios(system: EigenSystem) -> Array:
    """(m,) of each pair once; those of its lower half and of rigid-body motions are no candidates (1)."""
    size = np.abs(system.values)
    skipped = (system.values.imag < 0.0) | (size <= _FREE * size.max())
    return np.where(skipped, 1.0, -system.values.real / np.where(size > 0.0, size, 1.0))


def _ratio_slopes(
    model: LinearModel, system: EigenSystem, names: Sequence[str], at: Mapping[str, float]
) -> Array:
    """d(-Re / |lambda|) / d ln x, (k, m); 0 where eq 24 gives no number: SLSQP then steps by the other
    modes.
    """
    found = sensitivities_of(model, system, names, at)
    rate = found.absolute * found.amounts[:, None]
    value = system.values
    size = np.maximum(np.abs(value), np.finfo(float).tiny)
    growth = (value.conj() * rate).real / size  # d |lambda|
    slopes = -rate.real / size + value.real * growth / size**2
    return np.nan_to_num(slopes, nan=0.0, posinf=0.0, neginf=0.0)

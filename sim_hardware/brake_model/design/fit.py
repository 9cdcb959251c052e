"""Identification from recorded squeal: parameters that explain a measured onset and frequency, with
uncertainty.

Two numbers cannot fix many parameters: without more knowledge infinitely many brakes squeal at 12 bar with
2350 Hz. So every free variable has a prior, ln(factor on the file's value) ~ N(0, spread^2), and the answer
is a distribution (Bayes): its maximum by Gauss-Newton and BFGS with exact gradients
(`first_onset.onset_gradient`), its covariance linearised there, and samples of the posterior itself. The
singular values of the data's gradients, in units of prior spread and measurement error, say how many
combinations of variables the data fix at all: those above 1, at most as many as there are data. NOT its
job: data from campaigns, files (`rigctl.model.identification`); `identify` makes a parameter set meet
published numbers exactly and knows no uncertainty.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from sim_hardware.brake_model.design.scatter import Variable, changed
from sim_hardware.brake_model.eigen.first_onset import onset_gradient, scan
from sim_hardware.brake_model.linear import PRESSURE, LinearModel

Array = NDArray[np.float64]

_GAUSS_NEWTON, _QUASI_NEWTON = 12, 200
_GRADIENT_TOLERANCE = 1e-4
#: stands for infinity in a line search
_IMPOSSIBLE = 1e9
#: cost that a full step would still save, as share of it, below which the fit has converged
_COST_TOLERANCE = 1e-9
_LEAST_ANGLE = 1e-9
#: range searched for the onset as a multiple of the measured one, and steps of that scan
_REACH, _STEPS = 3.0, 36


@dataclass(frozen=True, slots=True)
class Measured:
    """Squeal as recorded.

    Attributes
    ----------
    onset, onset_sigma : of `quantity` (bar where that is pressure), and its standard uncertainty
    frequency_hz, frequency_sigma_hz : at onset; None where only the onset is known
    quantity : "pressure" or "mu"
    """

    onset: float
    onset_sigma: float
    frequency_hz: float | None = None
    frequency_sigma_hz: float | None = None
    quantity: str = PRESSURE

    def __post_init__(self) -> None:
        numbers = [("onset", self.onset), ("uncertainty of the onset", self.onset_sigma)]
        if self.frequency_hz is not None:
            if self.frequency_sigma_hz is None:
                raise ValueError("the frequency has no uncertainty; give one in Hz")
            numbers += [
                ("frequency", self.frequency_hz),
                ("uncertainty of the frequency", self.frequency_sigma_hz),
            ]
        for name, value in numbers:
            if not (np.isfinite(value) and value > 0.0):
                raise ValueError(f"{name} is {value!r}; give a positive number")

    @property
    def data(self) -> Array:
        """(d,) onset, frequency."""
        return np.array([self.onset] if self.frequency_hz is None else [self.onset, self.frequency_hz])

    @property
    def sigma(self) -> Array:
        """(d,) their standard uncertainties."""
        return np.array(
            [self.onset_sigma]
            if self.frequency_sigma_hz is None
            else [self.onset_sigma, self.frequency_sigma_hz]
        )


@dataclass(frozen=True, slots=True)
class Fit:
    """Most probable parameters and their uncertainty; k variables, d data.

    Attributes
    ----------
    logarithms : (k,) ln(factor) at the maximum of the posterior
    prior : (k,) standard deviation of ln(factor) before
    posterior : (k,) after, linearised
    covariance : (k, k) of ln(factor), linearised
    before, after : (d,) onset and frequency of the model; `before` is nan where the start does not squeal
    predicted_sigma : (d,) uncertainty of what the fitted model gives, from the posterior
    singular_values : (min(d, k),) of the gradients in units of prior spread and measurement error; above 1:
    the
        data say more about that combination than the prior
    directions : (min(d, k), k) those combinations, in units of prior spread
    cost_data, cost_prior : halves of squared deviations in units of their spread: far above 1: the
        data contradict the model and prior
    iterations, converged
    """

    logarithms: Array
    prior: Array
    posterior: Array
    covariance: Array
    before: Array
    after: Array
    predicted_sigma: Array
    singular_values: Array
    directions: Array
    cost_data: float
    cost_prior: float
    iterations: int
    converged: bool

    @property
    def factors(self) -> Array:
        """(k,) on the file's values."""
        return np.exp(self.logarithms)

    @property
    def identifiable(self) -> int:
        """Number of combinations of variables that the data fix better than the prior does."""
        return int((self.singular_values > 1.0).sum())


def predict(
    model: LinearModel,
    chosen: Sequence[Variable],
    logarithms: Array,
    measured: Measured,
    base: Mapping[str, float] | None = None,
) -> Array | None:
    """Onset (and frequency) of the model at ln(factor) (k,); None where it stays stable or starts
    unstable.
    """
    values = changed(model, chosen, np.exp(logarithms), base)
    grid = np.linspace(0.0, _REACH * measured.onset, _STEPS + 1)
    found = scan(model, measured.quantity, grid, values, whole=False)
    if found.onset is None or found.frequency_hz is None or found.onset <= grid[0]:
        return None
    return np.array([found.onset, found.frequency_hz])[: measured.data.size]


def gradient(
    model: LinearModel,
    chosen: Sequence[Variable],
    logarithms: Array,
    onset: float,
    measured: Measured,
    base: Mapping[str, float] | None = None,
) -> Array:
    """Derivatives (d, k) of `predict` by ln(factor), exact.

    Raises
    ------
    ValueError
        the critical eigenvalue cannot be differentiated
    """
    values = changed(model, chosen, np.exp(logarithms), base)
    names = [member for variable in chosen for member in variable.members]
    moved = onset_gradient(model, measured.quantity, onset, names, values)
    amounts = np.array([values[name] for name in names])
    owner = np.repeat(np.arange(len(chosen)), [len(variable.members) for variable in chosen])
    slopes = np.zeros((2, len(chosen)))
    for row, slope in enumerate(moved):
        np.add.at(slopes[row], owner, slope * amounts)
    return slopes[: measured.data.size]


def fit(
    model: LinearModel,
    chosen: Sequence[Variable],
    measured: Measured,
    *,
    spreads: Sequence[float],
    base: Mapping[str, float] | None = None,
) -> Fit:
    """Most probable parameters given a measured squeal (Gauss-Newton, then BFGS where that is not enough).

    Parameters
    ----------
    chosen : (k,) free variables
    spreads : (k,) standard deviations of ln(factor) before the measurement: 0.05 for 5 %
    base : other values than the file's (working point)

    Raises
    ------
    ValueError
        spreads not positive; a variable that is the measured quantity; a model that does not squeal up to
        three times the measured onset; a critical eigenvalue that cannot be differentiated
    """
    prior = np.asarray(spreads, dtype=float)
    _check(chosen, prior, measured)
    x = np.zeros(len(chosen))
    here = predict(model, chosen, x, measured, base)
    if here is None:
        raise ValueError(
            f"the model '{model.name}' does not begin to squeal between {measured.quantity} 0 and "
            f"{_REACH * measured.onset:g}: a fit must start from one that does; set other values"
            + (
                " (a falling slope of the friction: without it pressure has no effect)"
                if measured.quantity == PRESSURE
                else ""
            )
        )
    problem = _Problem(model, chosen, measured, prior, base)
    z, iterations, converged = problem.gauss_newton(np.zeros(len(chosen)))
    if not converged:
        z, more, converged = problem.quasi_newton(z)
        iterations += more
    x = z * prior
    after, jacobian = problem.point(z)
    return _summary(x, after, here, jacobian / prior, measured, prior, iterations, converged)


class _Problem:
    """Half the sum of squared deviations over z = ln(factor) / prior spread, with its gradients."""

    def __init__(
        self,
        model: LinearModel,
        chosen: Sequence[Variable],
        measured: Measured,
        prior: Array,
        base: Mapping[str, float] | None,
    ) -> None:
        self._model, self._chosen, self._measured = model, chosen, measured
        self._prior, self._base = prior, base

    def point(self, z: Array) -> tuple[Array, Array]:
        """Prediction (d,) and gradients (d + k, k) of the deviations at a z that squeals."""
        here = predict(self._model, self._chosen, z * self._prior, self._measured, self._base)
        assert here is not None
        return here, self._jacobian(z, here)

    def _jacobian(self, z: Array, here: Array) -> Array:
        slopes = gradient(self._model, self._chosen, z * self._prior, here[0], self._measured, self._base)
        return np.vstack([slopes * self._prior / self._measured.sigma[:, None], np.eye(z.size)])

    def _cost(self, z: Array, here: Array) -> float:
        return _cost(here, z * self._prior, self._measured, self._prior)

    def gauss_newton(self, z: Array) -> tuple[Array, int, bool]:
        """Few, long steps; damped by Levenberg, Marquardt and Nielsen. Ends where curvature makes them
        useless.
        """
        here, jacobian = self.point(z)
        cost, damping, growth = self._cost(z, here), 1e-3, 2.0
        for iteration in range(_GAUSS_NEWTON):
            misses = np.concatenate([(here - self._measured.data) / self._measured.sigma, z])
            normal, slope = jacobian.T @ jacobian, jacobian.T @ misses
            if 0.5 * float(slope @ np.linalg.solve(normal, slope)) <= _COST_TOLERANCE * (1.0 + cost):
                return z, iteration, True
            weight = damping * np.diagonal(normal)
            step = -np.linalg.solve(normal + np.diag(weight), slope)
            there = _tried(self._model, self._chosen, (z + step) * self._prior, self._measured, self._base)
            new_cost = np.inf if there is None else self._cost(z + step, there)
            gain = (cost - new_cost) / (0.5 * float(step @ (weight * step - slope)))
            if there is None or not gain > 0.0:  # beyond the linearisation, or another pair is first: shorter
                damping, growth = damping * growth, 2.0 * growth
                continue
            damping, growth = damping * max(1.0 / 3.0, 1.0 - (2.0 * gain - 1.0) ** 3), 2.0  # Nielsen's rule
            z, here, cost = z + step, there, new_cost
            jacobian = self._jacobian(z, here)
        return z, _GAUSS_NEWTON, False

    def quasi_newton(self, z: Array) -> tuple[Array, int, bool]:
        """BFGS: learns the curvature of the frequency where two pairs veer, which Gauss-Newton leaves out."""

        def function(z: Array) -> tuple[float, Array]:
            here = _tried(self._model, self._chosen, z * self._prior, self._measured, self._base)
            if here is None:
                return _IMPOSSIBLE, np.zeros(z.size)
            jacobian = self._jacobian(z, here)
            misses = np.concatenate([(here - self._measured.data) / self._measured.sigma, z])
            return 0.5 * float(misses @ misses), jacobian.T @ misses

        found = minimize(
            function,
            z,
            jac=True,
            method="BFGS",
            options={"gtol": _GRADIENT_TOLERANCE, "maxiter": _QUASI_NEWTON},
        )
        return found.x, int(found.nit), bool(np.abs(found.jac).max() <= 100.0 * _GRADIENT_TOLERANCE)


def fitted(logarithms: Sequence[float], covariance: Sequence[Sequence[float]], prior: Sequence[float]) -> Fit:
    """The part of a fit that `chain` needs, put together again from numbers (nothing else is known of it)."""
    spread, none = np.array(covariance), np.empty(0)
    return Fit(
        np.array(logarithms), np.array(prior), np.sqrt(np.diagonal(spread)), spread,
        none, none, none, none, none, np.nan, np.nan, 0, True,
    )  # fmt: skip


def chain(
    model: LinearModel,
    chosen: Sequence[Variable],
    measured: Measured,
    found: Fit,
    random: np.random.Generator,
    length: int,
    *,
    warm_up: int = 10,
    base: Mapping[str, float] | None = None,
) -> tuple[Array, Array]:
    """Samples of the posterior itself, not of its linearisation: elliptical slice sampling around it.

    Each step mixes the last sample with a draw from the linearised posterior on an ellipse, and shrinks the
    angle until the ratio of true to linearised posterior is above a random level: nothing to tune, and
    nearly independent samples where the linearisation is fair.

    Returns
    -------
    (length, k) ln(factor), (length, d) onset and frequency
    """
    root = np.linalg.cholesky(found.covariance)

    def level(apart: Array) -> tuple[float, Array | None]:
        predicted = _tried(model, chosen, found.logarithms + apart, measured, base)
        if predicted is None:
            return -np.inf, None
        linearised = 0.5 * float((np.linalg.solve(root, apart) ** 2).sum())
        return linearised - _cost(predicted, found.logarithms + apart, measured, found.prior), predicted

    apart, ratio, predicted = np.zeros(len(chosen)), *level(np.zeros(len(chosen)))
    samples, predictions = [], []
    for number in range(warm_up + length):
        other = root @ random.standard_normal(len(chosen))
        least = ratio + np.log1p(-random.random())
        angle = 2.0 * np.pi * random.random()
        low, high = angle - 2.0 * np.pi, angle
        while True:
            tried = np.cos(angle) * apart + np.sin(angle) * other
            new_ratio, new_predicted = level(tried)
            if new_ratio >= least and new_predicted is not None:
                apart, ratio, predicted = tried, new_ratio, new_predicted
                break
            low, high = (angle, high) if angle < 0.0 else (low, angle)
            if high - low < _LEAST_ANGLE:
                break  # stays where it is
            angle = random.uniform(low, high)
        if number >= warm_up and predicted is not None:
            samples.append(found.logarithms + apart)
            predictions.append(predicted)
    return np.array(samples), np.array(predictions)


def potential_scale_reduction(chains: Array) -> Array:
    """Gelman and Rubin's R of chains (c, n, k), for each of k numbers: near 1 where chains agree; (k,)."""
    count = chains.shape[1]
    within = chains.var(axis=1, ddof=1).mean(axis=0)
    between = chains.mean(axis=1).var(axis=0, ddof=1)
    return np.sqrt((count - 1) / count + between / np.where(within > 0.0, within, np.inf))


def _check(chosen: Sequence[Variable], prior: Array, measured: Measured) -> None:
    if prior.shape != (len(chosen),) or not (np.isfinite(prior) & (prior > 0.0)).all():
        raise ValueError(
            f"prior spreads {prior.tolist()}: give a positive one for each of {len(chosen)} variables"
        )
    for variable in chosen:
        if measured.quantity in variable.members:
            raise ValueError(f"{measured.quantity} is what was measured and cannot be free")


def _tried(
    model: LinearModel,
    chosen: Sequence[Variable],
    x: Array,
    measured: Measured,
    base: Mapping[str, float] | None,
) -> Array | None:
    try:
        return predict(model, chosen, x, measured, base)
    except ValueError:  # an impossible model (a negative stiffness between parameters): no step goes there
        return None


def _cost(predicted: Array, x: Array, measured: Measured, prior: Array) -> float:
    return 0.5 * float((((predicted - measured.data) / measured.sigma) ** 2).sum() + ((x / prior) ** 2).sum())


def _summary(
    x: Array, here: Array, before: Array, jacobian: Array, measured: Measured, prior: Array,
    iterations: int, converged: bool,
) -> Fit:  # fmt: skip
    covariance = np.linalg.inv(jacobian.T @ jacobian)
    covariance = 0.5 * (covariance + covariance.T)
    data = jacobian[: measured.data.size]
    _, singular, directions = np.linalg.svd(data * prior, full_matrices=False)
    spread = np.sqrt(np.einsum("ij,jk,ik->i", data, covariance, data)) * measured.sigma
    return Fit(
        logarithms=x,
        prior=prior,
        posterior=np.sqrt(np.diagonal(covariance)),
        covariance=covariance,
        before=before,
        after=here,
        predicted_sigma=spread,
        singular_values=singular,
        directions=directions,
        cost_data=0.5 * float((((here - measured.data) / measured.sigma) ** 2).sum()),
        cost_prior=0.5 * float(((x / prior) ** 2).sum()),
        iterations=iterations,
        converged=converged,
    )

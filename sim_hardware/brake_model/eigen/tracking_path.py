"""What is varied in a tracking study: one quantity, or a group by a common relative factor; and M, D, K
along it.

Job: `Path` (parameter of the path -> values of quantities and their rates), `path_of`, `Sampler` (matrices
and their derivative along a path, by few calls of the model). NOT its job: eigenvalues.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from sim_hardware.brake_model.linear import Array, LinearModel, Matrices, ParameterGroup, known, value_of

#: degrees tried for the matrices along a path, before the model is called for every point
_DEGREES = (1, 2, 6)
#: largest deviation of such a polynomial from the model's own matrices, relative to their largest entry
_EXACT = 2e-13
_EXACT_RATE = 1e-9


@dataclass(frozen=True, slots=True)
class Path:
    """A line through the space of quantities, with one parameter s.

    A plain quantity has the value s itself; a relative variation gives each member i the value
    v_i (1 + sign_i (s - 1)), so that s = 1 is the model as it is.

    Attributes
    ----------
    name, title, unit : of the parameter s, for people
    absolute : name of the quantity that is s, or None for a relative variation
    members : name -> (value at s = 1, sign) of a relative variation
    fixed : other quantities that differ from the file
    """

    name: str
    title: str
    unit: str
    absolute: str | None
    members: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    fixed: Mapping[str, float] = field(default_factory=dict)

    def values(self, s: float) -> dict[str, float]:
        """Values of all quantities that differ from the file at s."""
        if self.absolute is not None:
            return {**self.fixed, self.absolute: s}
        changed = {name: value * (1.0 + sign * (s - 1.0)) for name, (value, sign) in self.members.items()}
        return {**self.fixed, **changed}

    def rates(self) -> dict[str, float]:
        """Derivative of each varied quantity by s."""
        if self.absolute is not None:
            return {self.absolute: 1.0}
        return {name: value * sign for name, (value, sign) in self.members.items()}


def path_of(
    model: LinearModel,
    what: str | ParameterGroup | Mapping[str, float] | Path,
    values: Mapping[str, float] | None = None,
    *,
    asymmetric: bool = False,
) -> Path:
    """Return the path that a study varies.

    Parameters
    ----------
    what : name of a quantity; name of a parameter group, or the group itself (common relative factor on its
        members); or name -> sign (+1, -1 or any weight) of a relative variation of your own
    values : other quantities that differ from the file; relative variations start from them
    asymmetric : of a group with sides: the leading members by s, the trailing ones by 2 - s

    Raises
    ------
    KeyError
        no such quantity or group; the message lists near names
    ValueError
        asymmetric variation of what has no sides, or nothing to vary
    """
    if isinstance(what, Path):
        return what
    fixed = dict(values or {})
    for name in fixed:
        known(model, name)
    if isinstance(what, str) and what in model.quantities:
        if asymmetric:
            raise ValueError(f"{what}: one quantity has no sides; name a group for an asymmetric variation")
        quantity = model.quantities[what]
        fixed.pop(what, None)
        return Path(what, what, quantity.unit, what, fixed=fixed)
    if isinstance(what, Mapping):
        signs, name, title = dict(what), "variation", "relative factor of " + ", ".join(what)
    else:
        group = what if isinstance(what, ParameterGroup) else _group(model, what)
        if asymmetric and not group.has_sides:
            raise ValueError(f"group '{group.name}' has no leading and trailing side; vary it symmetrically")
        signs = {member: 1.0 for member in (group.leading if asymmetric else group.members)}
        signs |= {member: -1.0 for member in group.trailing if asymmetric}
        way = ", leading up and trailing down" if asymmetric else ""
        name, title = group.name, f"relative factor of '{group.title}'{way}"
    if not signs:
        raise ValueError("the variation has no members")
    members = {member: (value_of(model, member, fixed), float(sign)) for member, sign in signs.items()}
    return Path(name, title, "1", None, members, fixed)


def _group(model: LinearModel, name: str) -> ParameterGroup:
    for group in model.groups:
        if group.name == name:
            return group
    from difflib import get_close_matches

    near = get_close_matches(name, [*model.quantities, *(g.name for g in model.groups)], n=4, cutoff=0.5)
    hint = f"did you mean {', '.join(near)}?" if near else "list the quantities and groups of the model first"
    raise KeyError(f"the model '{model.name}' has no quantity or group {name!r}; {hint}")


class Sampler:
    """M, D, K along a path and their derivatives by its parameter, dense.

    Most paths are polynomials of low degree in s (affine for friction, pressure, any stiffness or damping). A
    polynomial through a few points is used where it agrees with the model at other points to rounding, and
    its derivative with the model's; otherwise the model is asked at every point.

    Attributes
    ----------
    exact : whether the model itself is asked at every point
    """

    def __init__(self, model: LinearModel, path: Path, low: float, high: float) -> None:
        self._model, self._path = model, path
        self._middle, self._half = 0.5 * (low + high), max(0.5 * (high - low), 1e-300)
        self._coefficients: Array | None = None
        for degree in _DEGREES:
            self._coefficients = self._fitted(degree)
            if self._coefficients is not None:
                break
        self.exact = self._coefficients is None

    def matrices(self, points: Array) -> tuple[Array, Array]:
        """Matrices and their derivatives by s, each (g, 3, n_dof, n_dof), at points (g,)."""
        if self._coefficients is None:
            stacks = [(self._asked(float(s)), self._asked_rate(float(s))) for s in points]
            return np.stack([a for a, _ in stacks]), np.stack([b for _, b in stacks])
        t = (np.asarray(points, dtype=float) - self._middle) / self._half
        degree = len(self._coefficients) - 1
        powers = t[:, None] ** np.arange(degree + 1)
        rates = np.arange(1, degree + 1) * t[:, None] ** np.arange(degree) / self._half
        flat = self._coefficients.reshape(degree + 1, -1)
        shape = (len(t), *self._coefficients.shape[1:])
        return (powers @ flat).reshape(shape), (rates @ flat[1:]).reshape(shape)

    def _asked(self, s: float) -> Array:
        return _stacked(self._model.matrices(self._path.values(s)))

    def _asked_rate(self, s: float) -> Array:
        values = self._path.values(s)
        return sum(
            (
                rate * _stacked(self._model.derivative(name, values))
                for name, rate in self._path.rates().items()
            ),
            start=np.zeros(1),
        )

    def _fitted(self, degree: int) -> Any | None:
        nodes = np.cos(np.pi * np.arange(degree + 1) / degree)  # Chebyshev points, ends included
        samples = np.stack([self._asked(self._middle + self._half * float(t)) for t in nodes])
        flat = np.linalg.solve(nodes[:, None] ** np.arange(degree + 1), samples.reshape(degree + 1, -1))
        coefficients = flat.reshape(samples.shape)
        scale = np.maximum(np.abs(samples).max(axis=(0, 2, 3)), 1e-300)[:, None, None]
        for t in (0.31830988, -0.57721566):
            powers = t ** np.arange(degree + 1)
            error = np.abs(np.tensordot(powers, coefficients, 1) - self._asked(self._middle + self._half * t))
            if (error > _EXACT * scale).any():
                return None
        for t, exact in ((1.0, samples[0]), (-1.0, samples[-1])):  # wide ranges: small values count too
            powers = t ** np.arange(degree + 1)
            own = np.maximum(np.abs(exact).max(axis=(1, 2)), 1e-300)[:, None, None]
            if (np.abs(np.tensordot(powers, coefficients, 1) - exact) > _EXACT * own).any():
                return None
        t = 0.14159265
        rate = np.tensordot(np.arange(1, degree + 1) * t ** np.arange(degree), coefficients[1:], 1)
        error = np.abs(rate - self._half * self._asked_rate(self._middle + self._half * t))
        if (error > _EXACT_RATE * scale).any():
            return None
        return coefficients


def _stacked(matrices: Matrices) -> Array:
    dense = matrices.dense()
    return np.stack([dense.mass, dense.damping, dense.stiffness])

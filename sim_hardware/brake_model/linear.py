"""What every linear study asks of a model: matrices M, D, K as functions of named quantities.

The studies (eigenvalues, tracking, boundaries, maps, sensitivities, variations) take any `LinearModel`: our
brake (`parametric.LinearBrake`) or matrices made elsewhere (`foreign.MatrixModel`).
NOT its job: any study, any brake.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

Array = NDArray[np.float64]
#: dense array or scipy sparse array, (n_dof, n_dof)
Matrix = Any

Kind = Literal["operating", "stiffness", "damping", "inertia", "geometry", "other"]
#: names of the operating quantities that studies know: coefficient of friction, falling slope k (s/m),
#: brake pressure (bar, as engineers name it; everything else is SI)
MU, SLOPE, PRESSURE = "mu", "slope", "pressure"


@dataclass(frozen=True, slots=True)
class Matrices:
    """M, D, K of M x'' + D x' + K x = 0, or their derivatives by a quantity. Each (n_dof, n_dof), SI."""

    mass: Matrix
    damping: Matrix
    stiffness: Matrix

    @property
    def n_dof(self) -> int:
        """Number of degrees of freedom."""
        return int(self.mass.shape[0])

    @property
    def is_sparse(self) -> bool:
        """Whether any of the three is a scipy sparse array."""
        return any(sparse.issparse(m) for m in (self.mass, self.damping, self.stiffness))

    def dense(self) -> Matrices:
        """The same as dense arrays."""
        return Matrices(*(_dense(m) for m in (self.mass, self.damping, self.stiffness)))

    def state_matrix(self) -> Array:
        """State matrix A of (displacements, velocities), dense, (2 n_dof, 2 n_dof) (eq 27).

        Raises
        ------
        numpy.linalg.LinAlgError
            M is singular
        """
        d, n = self.dense(), self.n_dof
        matrix = np.zeros((2 * n, 2 * n))
        matrix[:n, n:] = np.eye(n)
        if np.count_nonzero(d.mass) == np.count_nonzero(np.diagonal(d.mass)) == n:
            inertia = np.diagonal(d.mass)[:, None]
            matrix[n:, :n], matrix[n:, n:] = -d.stiffness / inertia, -d.damping / inertia
        else:
            solved = np.linalg.solve(d.mass, np.hstack([d.stiffness, d.damping]))
            matrix[n:, :n], matrix[n:, n:] = -solved[:, :n], -solved[:, n:]
        return matrix


@dataclass(frozen=True, slots=True)
class NamedQuantity:
    """A number of the model that a study may change: its name, value in the file, unit and kind."""

    name: str
    value: float
    unit: str
    kind: Kind


@dataclass(frozen=True, slots=True)
class ParameterGroup:
    """Quantities changed together, named as an engineer would (section 4.3.2).

    Attributes
    ----------
    name, title : key and name for people, "piston_position", "Piston: distance of connecting points"
    kind : of all members
    leading, trailing : members on the leading and trailing side, changed alike (symmetric) or in opposite
        directions (asymmetric); both empty where the group has no sides
    both : members without a side: changed in symmetric variations only
    """

    name: str
    title: str
    kind: Kind
    leading: tuple[str, ...] = ()
    trailing: tuple[str, ...] = ()
    both: tuple[str, ...] = ()

    @property
    def has_sides(self) -> bool:
        """Whether an asymmetric variation is possible."""
        return bool(self.leading and self.trailing)

    @property
    def members(self) -> tuple[str, ...]:
        """All names of the group."""
        return (*self.leading, *self.trailing, *self.both)


@runtime_checkable
class LinearModel(Protocol):
    """M, D, K as functions of named quantities. Immutable."""

    @property
    def name(self) -> str:
        """Name of the model."""
        ...

    @property
    def freedoms(self) -> tuple[str, ...]:
        """Names of the degrees of freedom, in the order of all vectors."""
        ...

    @property
    def quantities(self) -> Mapping[str, NamedQuantity]:
        """Everything that `values` may name, with the values in the file."""
        ...

    @property
    def groups(self) -> tuple[ParameterGroup, ...]:
        """Parameter groups of the file."""
        ...

    def matrices(self, values: Mapping[str, float] | None = None) -> Matrices:
        """M, D, K with other values for some quantities.

        Raises
        ------
        KeyError
            unknown quantity; the message lists near names
        ValueError
            not finite, or outside what is possible (mass or stiffness not positive, damping, friction,
            pressure negative)
        """
        ...

    def derivative(self, name: str, values: Mapping[str, float] | None = None) -> Matrices:
        """Derivatives of M, D, K by one quantity, exact, per unit of the quantity.

        Raises
        ------
        KeyError, ValueError
            as `matrices`
        """
        ...


def value_of(model: LinearModel, name: str, values: Mapping[str, float] | None = None) -> float:
    """Value of a quantity: from `values`, else from the file.

    Raises
    ------
    KeyError
        unknown quantity; the message lists near names
    """
    if values is not None and name in values:
        return float(values[name])
    return known(model, name).value


def known(model: LinearModel, name: str) -> NamedQuantity:
    """The quantity of that name.

    Raises
    ------
    KeyError
        unknown; the message lists near names
    """
    if name not in model.quantities:
        raise unknown_quantity(model.name, name, model.quantities)
    return model.quantities[name]


def unknown_quantity(model: str, name: str, quantities: Mapping[str, NamedQuantity]) -> KeyError:
    """The error for a name that the model does not have."""
    from difflib import get_close_matches

    near = get_close_matches(name, quantities, n=4, cutoff=0.5)
    hint = f"did you mean {', '.join(near)}?" if near else f"it has: {', '.join(list(quantities)[:12])}, …"
    return KeyError(f"the model '{model}' has no quantity {name!r}; {hint}")


def _dense(matrix: Matrix) -> Array:
    return matrix.toarray() if sparse.issparse(matrix) else np.asarray(matrix, dtype=float)

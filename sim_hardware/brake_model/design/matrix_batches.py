"""M, D, K of many variants of one model as stacked arrays, for batched eigenvalues.

Our brake's coupling lines are evaluated once per design, whatever the number of working points, and summed
for all variants together; other models are asked one variant at a time. NOT its job: eigenvalues, what the
variants are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.linear import MU, PRESSURE, SLOPE, LinearModel, Matrices
from sim_hardware.brake_model.lines import Lines
from sim_hardware.brake_model.parametric import AREA, PA_PER_BAR, LinearBrake

Array = NDArray[np.float64]
Values = Mapping[str, float]


@dataclass(frozen=True, slots=True)
class MatrixBatch:
    """Stacked dense matrices, each (b, n_dof, n_dof)."""

    mass: Array
    damping: Array
    stiffness: Array

    def minus(self, other: Matrices, part: slice) -> MatrixBatch:
        """Differences of some of the variants from dense matrices."""
        return MatrixBatch(
            self.mass[part] - other.mass,
            self.damping[part] - other.damping,
            self.stiffness[part] - other.stiffness,
        )

    def state_matrices(self) -> Array:
        """State matrices of all variants, (b, 2 n_dof, 2 n_dof) (eq 27).

        Raises
        ------
        numpy.linalg.LinAlgError
            a mass matrix is singular
        """
        count, n, _ = self.mass.shape
        matrices = np.zeros((count, 2 * n, 2 * n))
        matrices[:, :n, n:] = np.eye(n)
        inertia = np.diagonal(self.mass, axis1=1, axis2=2)
        if np.count_nonzero(self.mass) == np.count_nonzero(inertia) == inertia.size:
            matrices[:, n:, :n] = -self.stiffness / inertia[:, :, None]
            matrices[:, n:, n:] = -self.damping / inertia[:, :, None]
        else:
            matrices[:, n:, :n] = -np.linalg.solve(self.mass, self.stiffness)
            matrices[:, n:, n:] = -np.linalg.solve(self.mass, self.damping)
        return matrices


def matrix_batch(model: LinearModel, variants: Sequence[Values]) -> MatrixBatch:
    """Matrices of a model for many sets of values.

    Raises
    ------
    KeyError, ValueError
        as `LinearModel.matrices`
    """
    if isinstance(model, LinearBrake):
        return _brake_batch(model, variants)
    n = len(model.freedoms)
    batch = MatrixBatch(*(np.empty((len(variants), n, n)) for _ in range(3)))
    for number, values in enumerate(variants):
        one = model.matrices(values).dense()
        batch.mass[number], batch.damping[number], batch.stiffness[number] = (
            one.mass,
            one.damping,
            one.stiffness,
        )
    return batch


def _brake_batch(model: LinearBrake, variants: Sequence[Values]) -> MatrixBatch:
    operating = {name: model.quantities[name].value for name in (MU, SLOPE, PRESSURE, AREA)}
    designs: dict[tuple[tuple[str, float], ...], int] = {}
    lines: list[Lines] = []
    design = np.empty(len(variants), dtype=int)
    at = {name: np.full(len(variants), value) for name, value in operating.items()}
    for number, values in enumerate(variants):
        own = {name: value for name, value in values.items() if name not in operating}
        key = tuple(own.items())
        if key not in designs:
            designs[key] = len(lines)
            lines.append(model.lines(own))
        design[number] = designs[key]
        for name in values.keys() & operating.keys():
            at[name][number] = values[name]
    for name, found in at.items():
        bad = ~(np.isfinite(found) & (found >= 0.0)) | ((found == 0.0) & (name == AREA))
        if bad.any():
            model.matrices(variants[int(np.flatnonzero(bad)[0])])  # raises with the model's own words
            raise AssertionError(f"{name} was accepted by the model")
    n = len(model.freedoms)
    if not lines:
        return MatrixBatch(*(np.empty((0, n, n)) for _ in range(3)))
    rows = np.stack([line.rows for line in lines])
    stiffness, damping = (
        np.stack([line.stiffness for line in lines]),
        np.stack([line.damping for line in lines]),
    )
    contacts = model.brake.structure.contacts
    along, across = [c[0] for c in contacts], [c[1] for c in contacts]
    side, share = np.array([c[2] for c in contacts], dtype=float), np.array([c[3] for c in contacts])
    x, y = rows[:, along], rows[:, across]
    damping_mu = _sum(x, -side * damping[:, across], y)
    damping_kn = _sum(x, np.broadcast_to(-share, (len(lines), len(contacts))), x)
    stiffness_mu = _sum(x, -side * stiffness[:, across], y)
    mu = at[MU][:, None, None]
    falling = (at[SLOPE] * at[PRESSURE] * PA_PER_BAR * at[AREA])[:, None, None]  # k N (eq 31)
    mass = np.zeros((len(lines), n, n))
    mass[:, np.arange(n), np.arange(n)] = np.stack([line.inertia for line in lines])
    return MatrixBatch(
        mass[design],
        _sum(rows, damping, rows)[design] + mu * damping_mu[design] + falling * damping_kn[design],
        _sum(rows, stiffness, rows)[design] + mu * stiffness_mu[design],
    )


def _sum(left: Array, factors: Array, right: Array) -> Array:
    """Sum over lines of factor * outer(left, right), for each variant."""
    return np.matmul((left * factors[:, :, None]).transpose(0, 2, 1), right)

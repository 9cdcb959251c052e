"""A large model made small, so that every study can take it: projection on what moves in a frequency band.

The basis are real and imaginary parts of right and left vectors of all eigenvalues in the band (and a little
beyond) at chosen working points. There the small model has the same eigenvalues as the large one; between
them the error is of second order, since left vectors are in the basis too, and is measured at the points
halfway. All parts, numbers and factors of the model stay, so that friction, pressure, speed and parts may be
varied. NOT its job: which studies follow; eigenvalues outside the band, which the small model has but which
mean nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from sim_hardware.brake_model.eigen.band import EigenPairs, eigen_pairs_of
from sim_hardware.brake_model.eigen.band_pencil import Array
from sim_hardware.brake_model.foreign.matrix_model import MatrixModel

#: the basis is made of the band widened by this part of its upper end
_BEYOND = 0.25
#: directions whose kinetic energy is below this part of the largest are left out
_NEGLIGIBLE = 1e-9


@dataclass(frozen=True, slots=True)
class Check:
    """Agreement of small and large model at a working point.

    Attributes
    ----------
    basis_point : whether the basis was made there (else: halfway between two such points)
    pairs : eigenvalues of the large model in the band
    error : largest distance to the small model's nearest eigenvalue, relative to the eigenvalue
    same_unstable : whether as many of them grow
    complete : as `EigenPairs.complete` of the large model
    """

    values: Mapping[str, float]
    basis_point: bool
    pairs: int
    error: float
    same_unstable: bool
    complete: bool | None


@dataclass(frozen=True, slots=True)
class Reduction:
    """A small model, its basis (n_dof, n_small), orthonormal by M, and its checks."""

    model: MatrixModel
    basis: Array
    band_hz: tuple[float, float]
    checks: tuple[Check, ...]

    @property
    def largest_error(self) -> float:
        """Of all checks."""
        return max(check.error for check in self.checks)


def reduce_model(
    model: MatrixModel,
    band: tuple[float, float],
    points: Sequence[Mapping[str, float]],
    *,
    name: str | None = None,
) -> Reduction:
    """Project a model on its eigenvectors in a band at some working points.

    Parameters
    ----------
    band : Hz
    points : working points, for example ({"mu": 0.0}, {"mu": 0.4}, {"mu": 0.8}); the range that studies will
        use

    Raises
    ------
    ValueError
        no points, no eigenvalues in the band, or a basis not smaller than the model
    KeyError, ArithmeticError
        as `eigen_pairs_of`
    """
    if not points:
        raise ValueError("give at least one working point at which the small model shall be exact")
    wide = (max(band[0] - _BEYOND * band[1], 0.0), (1.0 + _BEYOND) * band[1])
    found = [eigen_pairs_of(model, point, wide) for point in points]
    columns = np.concatenate(
        [part(v) for pairs in found for v in (pairs.right, pairs.left) for part in (np.real, np.imag)], axis=1
    )
    if not columns.shape[1]:
        raise ValueError(
            f"the model has no eigenvalues from {wide[0]:g} to {wide[1]:g} Hz; give another band"
        )
    basis = _orthonormal(columns, model.matrices(points[0]).mass)
    if basis.shape[1] >= len(model.freedoms):
        raise ValueError(
            f"{basis.shape[1]} directions are needed for a model of {len(model.freedoms)} degrees of "
            "freedom: it is "
            "small already, or give a narrower band or fewer points"
        )
    small = model.projected(basis, name or f"{model.name}_reduced")
    checks = [
        _check(small, point, _inside(pairs, band), True) for point, pairs in zip(points, found, strict=True)
    ]
    for one, other in pairwise(points):
        halfway = _halfway(model, one, other)
        checks.append(_check(small, halfway, eigen_pairs_of(model, halfway, band), False))
    return Reduction(small, basis, band, tuple(checks))


def _orthonormal(columns: Array, mass: object) -> Array:
    """Basis of the columns' space, V^T M V = 1 (the symmetric part of M), without negligible directions."""
    lengths = np.linalg.norm(columns, axis=0)
    columns = columns[:, lengths > 0.0] / lengths[lengths > 0.0]
    basis = columns
    for _ in range(2):  # the second pass makes the first one's rounding good
        gram = basis.T @ (mass @ basis)  # type: ignore[operator]
        sizes, turn = np.linalg.eigh(0.5 * (gram + gram.T))
        kept = sizes > _NEGLIGIBLE * sizes.max()
        basis = basis @ (turn[:, kept] / np.sqrt(sizes[kept]))
    return basis


def _inside(pairs: EigenPairs, band: tuple[float, float]) -> EigenPairs:
    keep = np.flatnonzero((pairs.frequencies_hz >= band[0]) & (pairs.frequencies_hz <= band[1]))
    return pairs.chosen(keep)


def _check(small: MatrixModel, values: Mapping[str, float], large: EigenPairs, basis_point: bool) -> Check:
    own = eigen_pairs_of(small, values).eigenvalues
    distance = np.abs(large.eigenvalues[:, None] - own[None, :])
    nearest = distance.argmin(axis=1)
    size = np.maximum(np.abs(large.eigenvalues), 1e-300)
    error = float((distance.min(axis=1) / size).max(initial=0.0)) if len(size) else 0.0
    grows = own[nearest].real > large.errors_1_s
    return Check(
        dict(values), basis_point, len(size), error, bool((grows == large.unstable).all()), large.complete
    )


def _halfway(model: MatrixModel, one: Mapping[str, float], other: Mapping[str, float]) -> dict[str, float]:
    names = {**one, **other}
    nominal = {name: model.quantities[name].value for name in names}
    return {n: 0.5 * (one.get(n, nominal[n]) + other.get(n, nominal[n])) for n in names}

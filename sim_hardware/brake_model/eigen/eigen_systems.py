"""Eigenvalues with left and right vectors, and how far their derivatives can be trusted.

Eigenvalues l and vectors of the pencil Q(l) = l^2 M + l D + K: Q v = 0, w^T Q = 0. Where two eigenvalues
coincide, or nearly so with one common vector (defective: w^T v -> 0), a derivative does not exist or is
drowned by rounding: such eigenvalues carry a reason. NOT its job: derivatives (`sensitivity`), following
modes (`tracking`, `resolving`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from sim_hardware.brake_model.eigen.band import DENSE_ALWAYS, eigen_pairs_of_matrices
from sim_hardware.brake_model.linear import Matrices

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

#: two eigenvalues nearer than this share of the largest modulus coincide: rounding decides their vectors
COINCIDING = 1e-7
#: condition from which eq 24 gives no number: rounding changes it by about eps * condition^2, here 2e-4
ILL_CONDITIONED = 1e6
_TINY = np.finfo(float).tiny


@dataclass(frozen=True, slots=True)
class EigenSystem:
    """Eigenvalues with vectors, how well they are conditioned, and which cannot be differentiated.

    Attributes
    ----------
    values : (m,) 1/s, sorted by frequency, of each pair the one with positive imaginary part first (see
        `mode_order`)
    right, left : (n_dof, m) displacement vectors v and w of the pencil, Q v = 0 and w^T Q = 0, any scale
    slope : (m,) w^T (2 l M + D) v, the denominator of eq 24 (w^T v of the state vectors)
    condition : (m,) |w| |v| / |w^T v| of the state vectors in coordinates scaled by mass and frequency; 1 is
        best, infinite where defective
    gap : (m,) 1/s, distance to the nearest other eigenvalue
    reasons : (m,) why eq 24 gives no number here, "" where it does
    """

    values: ComplexArray
    right: ComplexArray
    left: ComplexArray
    slope: ComplexArray
    condition: Array
    gap: Array
    reasons: tuple[str, ...]

    @property
    def regular(self) -> NDArray[np.bool_]:
        """(m,) where eq 24 gives a number."""
        return np.array([not reason for reason in self.reasons])

    @property
    def frequencies_hz(self) -> Array:
        """(m,) |Im| / 2 pi; 0 for real eigenvalues."""
        return np.abs(self.values.imag) / (2.0 * np.pi)


def mode_order(values: ComplexArray) -> NDArray[np.intp]:
    """Order of eigenvalues: by frequency, then real part; of a pair the one with positive imaginary part
    first.
    """
    return np.lexsort((-values.imag, values.real, np.abs(values.imag)))


def eigen_system(matrices: Matrices) -> EigenSystem:
    """All 2 n_dof eigenvalues with right and left vectors.

    Raises
    ------
    ValueError
        more than `DENSE_ALWAYS` degrees of freedom
    numpy.linalg.LinAlgError
        M is singular
    """
    n = matrices.n_dof
    if n > DENSE_ALWAYS:
        raise ValueError(f"all eigenvalues of {n} degrees of freedom take minutes: give a frequency band")
    dense = matrices.dense()
    solved: Any = linalg.eig(dense.state_matrix(), left=True, right=True)
    values, left, right = solved
    order = mode_order(values)
    values = values[order].astype(complex)
    v = right[:n, order].astype(complex)
    w = np.linalg.solve(dense.mass.T, left[n:, order].conj())  # state vector's lower half is M^T w
    return assess(dense, values, v, w, neighbours=values)


def band_system(matrices: Matrices, band_hz: tuple[float, float]) -> EigenSystem:
    """Eigenvalues within a frequency band, dense or sparse: pairs as in `eigen_system`, with both vectors.

    Gaps are measured to the eigenvalues found: at the ends of the band they may be smaller.

    Raises
    ------
    ValueError
        band not 0 <= f1 < f2, or no eigenvalue in it
    ArithmeticError, numpy.linalg.LinAlgError
        no convergence, M is singular
    """
    pairs = eigen_pairs_of_matrices(matrices, band_hz)
    if not pairs.eigenvalues.size:
        raise ValueError(f"no eigenvalue between {band_hz[0]:g} and {band_hz[1]:g} Hz; widen the band")
    twins = np.flatnonzero(pairs.eigenvalues.imag > 0.0)
    values, right, left = (
        np.concatenate([found, found[..., twins].conj()], axis=-1)
        for found in (pairs.eigenvalues, pairs.right, pairs.left)
    )
    order = mode_order(values)
    values = values[order]
    return assess(matrices, values, right[:, order], left[:, order], neighbours=values)


def assess(
    matrices: Matrices,
    values: ComplexArray,
    right: ComplexArray,
    left: ComplexArray,
    *,
    neighbours: ComplexArray,
) -> EigenSystem:
    """Condition, gaps and reasons for eigenvalues with vectors that are known.

    Parameters
    ----------
    values, right, left : (m,), (n_dof, m), (n_dof, m)
    neighbours : all eigenvalues known, `values` among them; gaps are measured to these
    """
    inertia_v, damping_v = matrices.mass @ right, matrices.damping @ right
    inertia_w, damping_w = matrices.mass.T @ left, matrices.damping.T @ left
    slope = np.sum(left * (2.0 * values * inertia_v + damping_v), axis=0)
    scale = np.sqrt(np.abs(matrices.mass.diagonal()))
    scale = np.where(scale > 0.0, scale, 1.0)[:, None]
    speed = np.maximum(np.abs(values), _TINY)
    above, below = (values * inertia_w + damping_w) / scale / speed, inertia_w / scale
    norm_w = np.sqrt(_square(above) + _square(below))
    norm_v = np.sqrt((speed**2 + np.abs(values) ** 2) * _square(scale * right))
    with np.errstate(divide="ignore", invalid="ignore"):
        condition = np.where(slope == 0.0, np.inf, norm_w * norm_v / np.abs(slope))
    distance = np.abs(values[:, None] - neighbours[None, :])
    itself = np.argmin(distance, axis=1)
    distance[np.arange(values.size), itself] = np.inf
    gap = distance.min(axis=1) if neighbours.size > 1 else np.full(values.size, np.inf)
    nearest = np.argmin(distance, axis=1)
    largest = float(np.abs(neighbours).max(initial=0.0))
    reasons = tuple(
        _reason(float(gap[i]), float(condition[i]), largest, int(nearest[i])) for i in range(values.size)
    )
    return EigenSystem(values, right, left, slope, condition, gap, reasons)


def _square(vectors: Any) -> Array:
    return np.sum(np.abs(vectors) ** 2, axis=0)


def _reason(gap: float, condition: float, largest: float, nearest: int) -> str:
    if gap <= COINCIDING * largest:
        return f"coincides with eigenvalue {nearest + 1}: no derivative of its own exists"
    if not condition < ILL_CONDITIONED:
        return (
            f"near-defective with eigenvalue {nearest + 1} (condition {condition:.0e}): rounding would decide"
        )
    return ""

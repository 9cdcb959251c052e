"""T(lambda) = lambda^2 M + lambda D + K of large sparse models: factorised, solved, its determinant's
argument.

Job: `Pencil` (M, D, K on one sparsity pattern) and `Factors` (LU of T at one place). NOT its job: which
places, which eigenvalues (`band_arnoldi`, `band_count`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse import csgraph
from scipy.sparse.linalg import splu

from sim_hardware.brake_model.linear import Matrices

Complex = NDArray[np.complex128]
Array = NDArray[np.float64]

#: largest relative residual of a solution for which an LU without pivoting is kept
_WORST_SOLVE = 1e-7


class Pencil:
    """M, D, K (n_dof, n_dof) on the union of their sparsity patterns.

    Attributes
    ----------
    norms : Frobenius norms of M, D, K
    scale : about the highest angular frequency (1/s), from the diagonals

    Raises
    ------
    ValueError
        values not finite, or so large that their squares are not
    """

    def __init__(self, matrices: Matrices) -> None:
        parts: list[Any] = [
            sparse.csc_array(m) for m in (matrices.mass, matrices.damping, matrices.stiffness)
        ]
        self.n_dof = matrices.n_dof
        marks = (sparse.csc_array((np.ones_like(p.data), p.indices, p.indptr), shape=p.shape) for p in parts)
        pattern: Any = sparse.csc_array(sum(marks, start=sparse.eye_array(self.n_dof, format="csc")))
        self._indices, self._indptr = pattern.indices, pattern.indptr
        self._data = tuple(_on_pattern(part, pattern) for part in parts)
        self.mass, self.damping, self.stiffness = (self._matrix(data) for data in self._data)
        with np.errstate(over="ignore"):
            self.norms = tuple(float(np.linalg.norm(data)) for data in self._data)
        if not all(map(math.isfinite, self.norms)):
            raise ValueError("the matrices hold values that are not finite or too large; check the units")
        inertia, stiffness = self.mass.diagonal(), np.abs(self.stiffness.diagonal())
        ratio = stiffness[inertia > 0.0] / inertia[inertia > 0.0]
        self.scale = math.sqrt(float(ratio.max())) if ratio.size else 0.0

    def _matrix(self, data: NDArray[Any]) -> Any:
        return sparse.csc_array((data, self._indices, self._indptr), shape=(self.n_dof, self.n_dof))

    def at(self, place: complex) -> Any:
        """T(place), sparse and complex."""
        m, d, k = self._data
        return self._matrix(place * place * m + place * d + k)

    def factors(self, place: complex) -> Factors:
        """LU of T(place).

        Raises
        ------
        ZeroDivisionError
            T(place) is exactly singular: `place` is an eigenvalue
        """
        return Factors(self.at(place), place)

    def applied(self, values: Complex, vectors: Complex, *, transposed: bool = False) -> Complex:
        """T(values[i]) vectors[:, i], or with the transpose of T; (n_dof, m)."""
        m, d, k = (a.T if transposed else a for a in (self.mass, self.damping, self.stiffness))
        return np.asarray((m @ vectors) * values**2 + (d @ vectors) * values + k @ vectors)

    def residuals(self, values: Complex, vectors: Complex, *, transposed: bool = False) -> Array:
        """Norm of T x, relative to (|l|^2 |M| + |l| |D| + |K|) |x|: the backward error; (m,)."""
        size = self.sizes(values) * np.linalg.norm(vectors, axis=0)
        return np.linalg.norm(self.applied(values, vectors, transposed=transposed), axis=0) / size

    def sizes(self, values: Complex) -> Array:
        """|l|^2 |M| + |l| |D| + |K| with Frobenius norms, never zero; (m,)."""
        m, d, k = self.norms
        return np.maximum(np.abs(values) ** 2 * m + np.abs(values) * d + k, np.finfo(float).tiny)

    def slopes(self, values: Complex, right: Complex, left: Complex) -> Complex:
        """w^T (2 l M + D) x of each pair, the denominator of eq 24; (m,)."""
        return np.einsum("im,im->m", left, 2.0 * (self.mass @ right) * values + self.damping @ right)


class Factors:
    """LU of T at one place.

    Without pivoting first (little fill, symmetric ordering) and with partial pivoting where that is not
    accurate.
    """

    def __init__(self, matrix: Any, place: complex) -> None:
        n = matrix.shape[0]
        probe = np.exp(1j * np.arange(n))
        try:
            self._lu = splu(
                matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            )
            x = self._lu.solve(probe)
            error = float(np.linalg.norm(matrix @ x - probe))
            reference = float(np.linalg.norm(abs(matrix) @ np.abs(x))) + math.sqrt(n)
            accurate = error <= _WORST_SOLVE * reference and math.isfinite(error)
        except RuntimeError:  # SuperLU: "Factor is exactly singular"
            accurate = False
        if not accurate:
            try:
                self._lu = splu(matrix)
            except RuntimeError as error:
                raise ZeroDivisionError(f"T is singular at {place:.6g} 1/s") from error

    def solve(self, b: Complex, *, transposed: bool = False) -> Complex:
        """Solve T x = b, or T^T x = b."""
        return np.asarray(self._lu.solve(b, "T" if transposed else "N"))

    def argument(self) -> float:
        """Argument of det T, modulo 2 pi."""
        diagonal = self._lu.U.diagonal()  # L has ones
        flips = _odd(self._lu.perm_r) ^ _odd(self._lu.perm_c)
        return float(np.sum(np.angle(diagonal)) % (2.0 * math.pi)) + math.pi * flips


def _on_pattern(part: Any, pattern: Any) -> Array:
    """Values of `part` at the places of `pattern`, explicit zeros included."""
    n = pattern.shape[0]
    columns = np.repeat(np.arange(n), np.diff(pattern.indptr))
    keys = columns.astype(np.int64) * n + pattern.indices
    part = sparse.csc_array(part)
    part.sum_duplicates()
    own = np.repeat(np.arange(n), np.diff(part.indptr)).astype(np.int64) * n + part.indices
    order = np.argsort(keys, kind="stable")
    data = np.zeros(len(keys))
    data[order[np.searchsorted(keys[order], own)]] = part.data
    return data


def _odd(permutation: NDArray[Any]) -> bool:
    n = len(permutation)
    graph = sparse.coo_array((np.ones(n), (np.arange(n), permutation)), shape=(n, n))
    cycles = csgraph.connected_components(graph, directed=True, connection="weak", return_labels=False)
    return bool((n - int(cycles)) % 2)

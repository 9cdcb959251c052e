"""All eigenvalues on a grid over two numbers, from a secular equation instead of one LAPACK call a point.

The equation (`secular_equation`) costs one sum of n terms for each eigenvalue of a point, continued from its
neighbour by Newton, and guarded: the traces of A and A^2 must come out, every last correction be small, every
root stand alone; where the structure changes (pairs become real), all roots are found anew by Ehrlich and
Aberth, and guarded alike. What is not guarded through is solved by LAPACK; the share of such points is
reported.
NOT its job: the equation, what the eigenvalues mean (`maps`, `boundary`).
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.eigen.secular_equation import (
    Array,
    Complex,
    Interval,
    MatricesAt,
    MatrixSurface,
    SecularEquation,
    secular_equation,
    sorted_eigenvalues,
)
from sim_hardware.brake_model.rigid_body import eigenvalues

#: state matrices (m, n, n) at points (m,), (m,)
StateMatrices = Callable[[Array, Array], Array]
Method = Literal["secular", "lapack"]

#: most past points from which a root is predicted
HISTORY = 6
#: what the kernels say of a point
SOLVED, FLAGGED = 0, 1
#: grids below this many points per interpolation point are left to LAPACK
_WORTHWHILE = 4
#: larger state matrices are not tried; reduced finite-element models of 126 eigenvalues agree to 1e-12
_LARGEST = 300
#: more than this share flagged: LAPACK for all
_HOPELESS = 0.6
_CHUNK = 2048
#: eigenvalues below this part of the largest may be those of rigid-body motions
SMALL = 1e-6


@dataclass(frozen=True, slots=True)
class GridEigenvalues:
    """Eigenvalues on a grid.

    Attributes
    ----------
    values : (ny, nx, n) 1/s, sorted by frequency at each point; a pair as l (Im > 0), conjugate; real ones
        first
    method : "secular", or "lapack" where that pays or must be
    reason : why, in words
    fallback : (ny, nx) points that the guards left to LAPACK
    equation : the secular equation, None by LAPACK
    """

    values: Complex
    method: Method
    reason: str
    fallback: NDArray[np.bool_]
    equation: SecularEquation | None = None

    @property
    def fallback_share(self) -> float:
        """Share of points left to LAPACK."""
        return float(self.fallback.mean())


def grid_eigenvalues(
    matrices_at: MatricesAt, xs: Array, ys: Array, *, method: Method | None = None, workers: int = 1
) -> GridEigenvalues:
    """All eigenvalues of A(x, y) at every point of a grid.

    Parameters
    ----------
    matrices_at : M, D, K at (x, y)
    xs, ys : (nx,), (ny,) in any order
    method : None: the faster one that works
    workers : threads

    Raises
    ------
    numpy.linalg.LinAlgError
        the mass matrix is singular
    """
    x, y = Interval(xs), Interval(ys)
    matrices = MatrixSurface(matrices_at, x, y)
    size = matrices.sampled.shape[-1]
    if method is None:
        method, reason = _choice(
            len(xs) * len(ys), size, matrices.sampled.shape[0] * matrices.sampled.shape[1]
        )
    else:
        reason = "as asked"
    if method == "secular":
        equation = secular_equation(matrices, x, y)
        if equation is None:
            reason = "the characteristic polynomial is not smooth enough over this range"
        else:
            solved = _by_secular(equation, matrices, xs, ys, workers)
            if solved is not None:
                return GridEigenvalues(solved[0], "secular", reason, solved[1], equation)
            reason = "the secular equation failed its guards at most points"
    fallback = np.zeros((len(ys), len(xs)), dtype=bool)
    values = np.empty((len(ys), len(xs), size), dtype=np.complex128)
    _by_lapack(matrices, xs, ys, ~fallback, values)
    return GridEigenvalues(values, "lapack", reason, fallback)


def _choice(points: int, size: int, sampled: int) -> tuple[Method, str]:
    if size > _LARGEST:
        return "lapack", f"more than {_LARGEST} eigenvalues"
    if points < _WORTHWHILE * sampled:
        return "lapack", "a small grid"
    return "secular", "the faster one"


def _by_secular(
    equation: SecularEquation, matrices: MatrixSurface, xs: Array, ys: Array, workers: int
) -> tuple[Complex, NDArray[np.bool_]] | None:
    """Eigenvalues (ny, nx, n) and which are LAPACK's, or None where the guards pass too little."""
    if len(ys) > len(xs):  # lines along y: the longer they are, the better roots are predicted
        values, state = _lines(equation.swapped(), lambda a, b: matrices(b, a), ys, xs, workers)
        values, state = values.swapaxes(0, 1), state.T
    else:
        values, state = _lines(equation, matrices, xs, ys, workers)
    flagged = state == FLAGGED
    if flagged.mean() > _HOPELESS:
        return None
    _by_lapack(matrices, xs, ys, flagged, values)
    return values, flagged


def _lines(
    equation: SecularEquation, matrices: StateMatrices, xs: Array, ys: Array, workers: int
) -> tuple[Complex, NDArray[np.uint8]]:
    """Eigenvalues along lines of constant y, which points are SOLVED; all FLAGGED where a few tries fail."""
    from sim_hardware.brake_model.eigen.secular_kernels import walk_rows  # here: LAPACK does without numba

    nx, ny, size = len(xs), len(ys), equation.size
    values = np.empty((ny, nx, size), dtype=np.complex128)
    state = np.full((ny, nx), FLAGGED, dtype=np.uint8)
    starts, counts = _first_column(equation, matrices, xs, ys)
    basis = equation.x.basis(xs, equation.numerators.shape[2])
    weights = prediction_weights(equation.x.scaled(xs))
    numerators, sums = equation.along_x(ys)

    def rows(which: NDArray[np.int64]) -> None:
        walk_rows(
            which, basis, weights, equation.a, equation.b, numerators, sums, starts, counts, values, state
        )

    picked = np.unique(np.linspace(0, ny - 1, min(ny, 4)).astype(np.int64))
    rows(picked)
    if (state[picked] == FLAGGED).mean() > _HOPELESS:
        return values, np.full_like(state, FLAGGED)
    others = np.setdiff1d(np.arange(ny), picked)
    if workers > 1:
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(rows, np.array_split(others, 4 * workers)))
    else:
        rows(others)
    return values, state


def _first_column(
    equation: SecularEquation, matrices: StateMatrices, xs: Array, ys: Array
) -> tuple[Array, NDArray[np.int64]]:
    """Roots near the first point of each line, (ny, 2, n), and their numbers, along the first column."""
    from sim_hardware.brake_model.eigen.secular_kernels import walk_rows

    size = equation.size
    starts, counts = np.empty((len(ys), 2, size)), np.empty(len(ys), dtype=np.int64)
    starts[0], counts[0] = _half(sorted_eigenvalues(np.linalg.eigvals(matrices(xs[:1], ys[:1]))[0]))
    numerators, sums = equation.along_y(xs[:1])
    values = np.empty((1, len(ys), size), dtype=np.complex128)
    state = np.empty((1, len(ys)), dtype=np.uint8)
    basis, weights = equation.y.basis(ys, numerators.shape[2]), prediction_weights(equation.y.scaled(ys))
    only = np.zeros(1, dtype=np.int64)
    walk_rows(only, basis, weights, equation.a, equation.b, numerators, sums, starts, counts, values, state)
    for row in range(1, len(ys)):
        solved = state[0, row] != FLAGGED
        starts[row], counts[row] = _half(values[0, row]) if solved else (starts[row - 1], counts[row - 1])
    return starts, counts


def _half(values: Complex) -> tuple[Array, int]:
    """Re and Im of the eigenvalues with Im >= 0, padded, and their number."""
    kept = values[values.imag >= 0.0]
    roots = np.zeros((2, values.size))
    roots[0, : kept.size], roots[1, : kept.size] = kept.real, kept.imag
    return roots, int(kept.size)


def _by_lapack(
    matrices: MatrixSurface, xs: Array, ys: Array, where: NDArray[np.bool_], values: Complex
) -> None:
    """Fill in the eigenvalues of some points; those of rigid-body motions are exactly 0."""
    rows, columns = np.nonzero(where)
    for first in range(0, len(rows), _CHUNK):
        r, c = rows[first : first + _CHUNK], columns[first : first + _CHUNK]
        sampled = matrices(xs[c], ys[r])
        found = np.linalg.eigvals(sampled).astype(np.complex128)
        size = np.abs(found)
        for i in np.flatnonzero(size.min(axis=1) < SMALL * size.max(axis=1)):
            found[i] = eigenvalues(sampled[i])
        values[r, c] = sorted_eigenvalues(found)


def prediction_weights(points: Array) -> Array:
    """Weights (n, HISTORY, HISTORY): [i, h - 1, :h] predict point i from its h predecessors, last first."""
    n = len(points)
    weights = np.zeros((n, HISTORY, HISTORY))
    for used in range(1, HISTORY + 1):
        index = np.arange(used, n)
        if not index.size:
            break
        past = points[index[:, None] - 1 - np.arange(used)]
        for k in range(used):
            others = np.delete(past, k, axis=1)
            with np.errstate(divide="ignore", invalid="ignore"):
                ratio = (points[index, None] - others) / (past[:, k, None] - others)
            weights[used:, used - 1, k] = np.prod(ratio, axis=1)
    repeated = ~np.isfinite(weights).all(axis=2)
    weights[repeated] = np.eye(1, HISTORY)[0]  # points repeated: as the last one
    return weights

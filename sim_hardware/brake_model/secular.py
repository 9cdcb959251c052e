"""All eigenvalues on a grid over two numbers, from a secular equation instead of one LAPACK call a point.

With nodes z_1 … z_n, the characteristic polynomial p of the state matrix A(x, y) is, exactly,

    p(l) / prod (l - z_j) = F(l) = 1 + sum_j w_j(x, y) / (l - z_j),   w_j = p(z_j; x, y) / prod_{k != j} (z_j
    - z_k).

The nodes are the eigenvalues at a reference point, moved a little aside. Where A differs from the reference
by a term U C(x, y) V^T of low rank r (friction acts at two rigid pads: r = 2), F is the r x r secular
determinant det(I + C V^T (A0 - l)^-1 U) written out, and w_j are polynomials of degree r in x and y; in any
case they are smooth, even where eigenvalues coincide, so that a few points give them for a whole rectangle
(Chebyshev interpolation). A point of the grid then costs one sum of n terms for each eigenvalue, continued
from its neighbour, and guards: the traces of A and A^2 must come out, every last correction be small, every
root stand alone. What is not guarded through is solved by LAPACK; the share of such points is reported.
NOT its job: what the eigenvalues mean (`maps`, `boundary`).
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from sim_hardware.brake_model.linear import Matrices
from sim_hardware.brake_model.secular_kernels import FLAGGED, HISTORY, LANES, walk_rows

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
MatricesAt = Callable[[float, float], Matrices]
#: state matrices (m, n, n) at points (m,), (m,)
StateMatrices = Callable[[Array, Array], Array]
Method = Literal["secular", "lapack"]

#: nodes lie this far to the right of the reference eigenvalues, relative to their magnitude: no root is hit
_ASIDE = 0.05
_APART = 0.02
#: degrees tried for the interpolation, and what may be left of the highest two terms
_DEGREES = (3, 6, 12, 24)
_NEGLIGIBLE = 3e-12
#: grids below this many points per interpolation point are left to LAPACK
_WORTHWHILE = 4
#: larger state matrices lose too many digits in products of n differences
_LARGEST = 120
#: more than this share flagged in the first rows: LAPACK for all
_HOPELESS = 0.6
_CHUNK = 2048
_CHECKED = 1e-10


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


def sorted_eigenvalues(values: NDArray[np.complexfloating | np.floating]) -> Complex:
    """Eigenvalues (..., n) of real matrices sorted by |Im|, then Re, then Im falling: pairs stay together."""
    values = np.asarray(values, dtype=np.complex128)
    return np.take_along_axis(
        values, np.lexsort((-values.imag, values.real, np.abs(values.imag)), axis=-1), axis=-1
    )


class Interval:
    """A range of numbers mapped to -1 … 1, with Chebyshev points and polynomials."""

    def __init__(self, numbers: Array) -> None:
        low, high = float(np.min(numbers)), float(np.max(numbers))
        self.middle, self.half = 0.5 * (low + high), 0.5 * (high - low)

    def scaled(self, numbers: Array | float) -> Array:
        """Numbers as -1 … 1."""
        return (np.asarray(numbers, dtype=float) - self.middle) / (self.half or 1.0)

    def points(self, degree: int) -> Array:
        """The degree + 1 Chebyshev points; the middle alone where the range has no extent."""
        if self.half == 0.0:
            return np.array([self.middle])
        return self.middle + self.half * chebyshev.chebpts1(degree + 1)

    def basis(self, numbers: Array | float, terms: int) -> Array:
        """Polynomials T_0 … at numbers, (..., terms)."""
        return np.asarray(chebyshev.chebvander(self.scaled(numbers), terms - 1), dtype=float)


@dataclass(frozen=True, slots=True)
class SecularEquation:
    """F(l; x, y) over a rectangle, in real quadratics: F = 1 + sum_j (c_j l + e_j) / (l^2 - a_j l + b_j).

    Attributes
    ----------
    size : number n of eigenvalues
    x, y : the rectangle
    a, b : (n / 2,) of the pairs of nodes; here and below padded to a multiple of `LANES`
    numerators : (2, terms y, terms x, n / 2) Chebyshev coefficients of c and e
    sums : (2, terms y, terms x) of the traces of A and of A^2
    """

    size: int
    x: Interval
    y: Interval
    a: Array
    b: Array
    numerators: Array
    sums: Array

    def along_x(self, ys: Array) -> tuple[Array, Array]:
        """Coefficients (m, 2, terms x, n / 2) and sums (m, 2, terms x) on lines of constant y."""
        basis = self.y.basis(ys, self.numerators.shape[1])
        return _contracted(basis, self.numerators), _contracted(basis, self.sums)

    def along_y(self, xs: Array) -> tuple[Array, Array]:
        """Coefficients (m, 2, terms y, n / 2) and sums (m, 2, terms y) on lines of constant x."""
        basis = self.x.basis(xs, self.numerators.shape[2])
        return _contracted(basis, self.numerators.swapaxes(1, 2)), _contracted(
            basis, self.sums.swapaxes(1, 2)
        )

    def swapped(self) -> SecularEquation:
        """The same with x and y exchanged."""
        return SecularEquation(
            self.size, self.y, self.x, self.a, self.b, self.numerators.swapaxes(1, 2), self.sums.swapaxes(1,
            2)
        )  # fmt: skip


class MatrixSurface:
    """State matrices A(x, y) on a rectangle: interpolated where they are low polynomials (exact), else asked
    for.
    """

    def __init__(self, matrices_at: MatricesAt, x: Interval, y: Interval) -> None:
        self._at, self._x, self._y = matrices_at, x, y
        xs, ys = x.points(_DEGREES[0]), y.points(_DEGREES[0])
        self.sampled = np.array([[self._matrix(a, b) for a in xs] for b in ys])
        coefficients = _coefficients(self.sampled, x, y)
        scale = np.abs(self.sampled).max(axis=(0, 1)) + np.finfo(float).tiny
        ends = [coefficients[-1]] * (y.half > 0.0) + [coefficients[:, -1]] * (x.half > 0.0)
        self.polynomial = all(bool(np.all(np.abs(end) <= 1e-14 * scale)) for end in ends)
        self._coefficients = coefficients

    def _matrix(self, x: float, y: float) -> Array:
        return self._at(float(x), float(y)).state_matrix()

    def __call__(self, xs: Array, ys: Array) -> Array:
        """State matrices at points, (m, n, n)."""
        if not self.polynomial:
            return np.stack([self._matrix(x, y) for x, y in zip(xs, ys, strict=True)])
        rows, columns = self._coefficients.shape[:2]
        basis = np.einsum("ms,mt->mst", self._y.basis(ys, rows), self._x.basis(xs, columns))
        return np.asarray(np.tensordot(basis, self._coefficients, axes=2), dtype=float)


def secular_equation(matrices: MatrixSurface, x: Interval, y: Interval) -> SecularEquation | None:
    """The secular equation over a rectangle, or None where a moderate degree does not carry it.

    Raises
    ------
    numpy.linalg.LinAlgError
        the mass matrix is singular
    """
    centre = matrices(np.array([x.middle]), np.array([y.middle]))[0]
    nodes = _nodes(np.linalg.eigvals(centre))
    for degree in _DEGREES:
        xs, ys = x.points(degree), y.points(degree)
        grid_x, grid_y = (g.ravel() for g in np.meshgrid(xs, ys))
        sampled = matrices(grid_x, grid_y)
        sums = np.stack([np.einsum("mii->m", sampled), np.einsum("mij,mji->m", sampled, sampled)])
        weights = _weights(sorted_eigenvalues(np.linalg.eigvals(sampled)), nodes)
        c, e = 2.0 * weights.real, -2.0 * (weights * nodes.conj()).real
        shape = (len(ys), len(xs))
        numerators = np.stack([_coefficients(part.reshape(*shape, -1), x, y) for part in (c, e)])
        traces = np.stack([_coefficients(part.reshape(shape), x, y) for part in sums])
        scale = np.abs(numerators).max(axis=(1, 2), keepdims=True)
        small = np.abs(numerators) <= _NEGLIGIBLE * scale
        done_y = y.half == 0.0 or bool(small[:, -1].all())
        done_x = x.half == 0.0 or bool(small[:, :, -1].all())
        if done_x and done_y:
            high = np.abs(traces) > 1e-15 * np.abs(traces).max(axis=(1, 2), keepdims=True)
            used = ~small.all(axis=(0, 3)) | high.any(axis=0)
            rows, columns = (int(np.flatnonzero(used.any(axis=k))[-1]) + 1 for k in (1, 0))
            short = np.ascontiguousarray(traces[:, :rows, :columns])
            spare = -len(nodes) % LANES
            nodes = np.pad(nodes, (0, spare), mode="edge")  # terms that are zero, at a place where no root is
            padding = ((0, 0), (0, 0), (0, 0), (0, spare))
            return SecularEquation(
                2 * (len(nodes) - spare), x, y, 2.0 * nodes.real, np.abs(nodes) ** 2,
                np.pad(numerators[:, :rows, :columns], padding), short,
            )  # fmt: skip
    return None


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
    rows, columns = np.nonzero(where)
    for first in range(0, len(rows), _CHUNK):
        r, c = rows[first : first + _CHUNK], columns[first : first + _CHUNK]
        values[r, c] = sorted_eigenvalues(np.linalg.eigvals(matrices(xs[c], ys[r])))


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


def _nodes(eigenvalues: NDArray[np.complexfloating | np.floating]) -> Complex:
    """n / 2 nodes with Im > 0 beside the eigenvalues, distinct."""
    values = sorted_eigenvalues(eigenvalues)
    floor = 1e-3 * float(np.abs(values).max()) or 1.0
    nodes: list[complex] = []
    for first, second in values.reshape(-1, 2):
        magnitude = max(abs(first), abs(second), floor)
        node = complex(0.5 * (first + second).real, max(0.5 * abs(first - second), _ASIDE * magnitude))
        node += _ASIDE * magnitude
        while any(abs(node - other) < _APART * abs(node) for other in nodes):
            node *= 1.0 + _APART
        nodes.append(node)
    return np.array(nodes)


def _weights(eigenvalues: Complex, nodes: Complex) -> Complex:
    """w_j (m, n / 2) for sorted eigenvalues (m, n), as products of ratios of like size."""
    both = np.stack([nodes, nodes.conj()], axis=1).ravel()
    weights = np.empty((eigenvalues.shape[0], len(nodes)), dtype=np.complex128)
    for j, node in enumerate(nodes):
        difference = node - both
        difference[2 * j] = 1.0
        weights[:, j] = np.prod((node - eigenvalues) / difference, axis=1)
    return weights


def _coefficients(sampled: Array, x: Interval, y: Interval) -> Array:
    """Chebyshev coefficients (terms y, terms x, ...) of samples at the Chebyshev points of a rectangle."""
    rows, columns = sampled.shape[:2]
    to_y = np.linalg.inv(y.basis(y.points(rows - 1), rows))
    to_x = np.linalg.inv(x.basis(x.points(columns - 1), columns))
    return np.einsum("ab,cd,bd...->ac...", to_y, to_x, sampled, optimize=True)


def _contracted(basis: Array, coefficients: Array) -> Array:
    """Sums over axis 1 with polynomial bases (m, terms), the first axis of the result."""
    return np.ascontiguousarray(np.tensordot(basis, coefficients, axes=(1, 1)))

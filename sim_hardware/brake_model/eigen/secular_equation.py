"""The characteristic polynomial of A(x, y) over a rectangle as a secular equation: what `secular` solves.

With nodes z_1 … z_n, the characteristic polynomial p of the state matrix A(x, y) is, exactly,

    p(l) / prod (l - z_j) = F(l) = 1 + sum_j w_j(x, y) / (l - z_j),   w_j = p(z_j; x, y) / prod_{k != j} (z_j
    - z_k).

The nodes are the eigenvalues at a reference point, moved a little aside. Where A differs from the reference
by a term U C(x, y) V^T of low rank r (friction acts at two rigid pads: r = 2), F is the r x r secular
determinant det(I + C V^T (A0 - l)^-1 U) written out, and w_j are polynomials of degree r in x and y; in any
case they are smooth, even where eigenvalues coincide, so that a few points give them for a whole rectangle
(Chebyshev interpolation). NOT its job: solving it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from sim_hardware.brake_model.linear import Matrices

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
MatricesAt = Callable[[float, float], Matrices]

#: tables of terms are padded to a multiple of this
LANES = 8
#: nodes lie this far to the right of the reference eigenvalues, relative to their magnitude: no root is hit
_ASIDE = 0.05
_APART = 0.02
#: degrees tried for the interpolation, and what may be left of the highest terms
_DEGREES = (3, 6, 12, 24)
_NEGLIGIBLE = 3e-12
#: places in -1 … 1 at which interpolation is checked
_CHECKED = ((0.318, -0.771, 0.0871), (-0.6123, 0.4539, 0.8313))


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
    """State matrices A(x, y) on a rectangle: interpolated where low polynomials (exact), else asked for."""

    def __init__(self, matrices_at: MatricesAt, x: Interval, y: Interval) -> None:
        self._at, self._x, self._y = matrices_at, x, y
        xs, ys = x.points(_DEGREES[0]), y.points(_DEGREES[0])
        self.sampled = np.array([[self._matrix(a, b) for a in xs] for b in ys])
        coefficients = _coefficients(self.sampled, x, y)
        scale = np.abs(self.sampled).max(axis=(0, 1)) + np.finfo(float).tiny
        ends = [coefficients[-1]] * (y.half > 0.0) + [coefficients[:, -1]] * (x.half > 0.0)
        self._coefficients = coefficients
        self.polynomial = all(bool(np.all(np.abs(end) <= 1e-14 * scale)) for end in ends)
        if self.polynomial:  # what is even about the middle may hide from the last terms
            some = between(x, y)
            exact = np.stack([self._matrix(a, b) for a, b in zip(*some, strict=True)])
            self.polynomial = bool(np.all(np.abs(self(*some) - exact) <= 1e-13 * scale))

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
        terms, sums = _terms(sampled, nodes)
        shape = (len(ys), len(xs))
        numerators = np.stack([_coefficients(part.reshape(*shape, -1), x, y) for part in terms])
        traces = np.stack([_coefficients(part.reshape(shape), x, y) for part in sums])
        scale = np.abs(numerators).max(axis=(1, 2), keepdims=True)
        small = np.abs(numerators) <= _NEGLIGIBLE * scale
        done_y = y.half == 0.0 or bool(small[:, -1].all())
        done_x = x.half == 0.0 or bool(small[:, :, -1].all())
        if done_x and done_y and _holds_between(matrices, x, y, nodes, (numerators, traces)):
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


def between(x: Interval, y: Interval) -> tuple[Array, Array]:
    """Some points of a rectangle at which interpolation is checked."""
    return (x.middle + x.half * np.array(_CHECKED[0]), y.middle + y.half * np.array(_CHECKED[1]))


def _holds_between(
    matrices: MatrixSurface, x: Interval, y: Interval, nodes: Complex, coefficients: tuple[Array, Array]
) -> bool:
    """Whether interpolated coefficients and traces are right between the points that gave them."""
    some = between(x, y)
    terms, sums = _terms(matrices(*some), nodes)
    speed = np.sqrt(np.abs(coefficients[1][1]).max())
    for wanted, table, least in ((terms, coefficients[0], 0.0), (sums, coefficients[1], speed)):
        basis = np.einsum("ms,mt->mst", y.basis(some[1], table.shape[1]), x.basis(some[0], table.shape[2]))
        found = np.einsum("mst,pst...->pm...", basis, table)
        scale = np.maximum(np.abs(table).max(axis=(1, 2))[:, None], least)
        if not np.all(np.abs(found - wanted) <= 10.0 * _NEGLIGIBLE * scale):
            return False
    return True


def _terms(sampled: Array, nodes: Complex) -> tuple[Array, Array]:
    """Coefficients c and e (2, m, n / 2), and traces of A and A^2 (2, m), of state matrices (m, n, n)."""
    weights = _weights(sorted_eigenvalues(np.linalg.eigvals(sampled)), nodes)
    sums = np.stack([np.einsum("mii->m", sampled), np.einsum("mij,mji->m", sampled, sampled)])
    return np.stack([2.0 * weights.real, -2.0 * (weights * nodes.conj()).real]), sums


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

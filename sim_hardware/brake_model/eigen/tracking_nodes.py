"""Eigenvalues, vectors and derivatives (eq 24) at points of a path, and how well two points match.

A node holds the eigenvalues with imaginary part >= 0: first the complex ones by frequency, then the real
ones. State vectors are scaled by a frequency, (w0 x, v), so that both halves have one unit. Left vectors
are normalised, w_i^T v_i = 1 (eq 21). NOT its job: which modes are which (`tracking`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from sim_hardware.brake_model.eigen.tracking_path import Sampler
from sim_hardware.brake_model.linear import Array

ComplexArray = NDArray[np.complex128]

#: relative to the largest modulus: eigenvalues nearer to each other coincide, nearer to zero are zero
COINCIDING = 1e-7
#: relative imaginary part below which an eigenvalue counts as real
_REAL = 1e-9
#: steps whose relative position changes by more than the smallest distance of two eigenvalues are halved
_APPROACH = 2.0
#: least correlation left * right of a mode with itself over a step, as |1 - X|
_UNLIKE = 0.5
#: largest error of the predicted eigenvalue, relative to the distance to the next one
_MISSED = 0.5
_FORBIDDEN = 1e6
_ENDLESS = 1e100
#: singular values of K below this share of the largest are zero
_SINGULAR = 1e-12
_SAMPLES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])


@dataclass(slots=True)
class Node:
    """Eigenvalues at a point of a path.

    Attributes
    ----------
    s : parameter of the path
    values, rates : (u,) eigenvalues with Im >= 0 in 1/s, and their derivatives by s (eq 24); nan where
        defective
    right, left : (n_state, u), (u, n_state) state vectors, w_i^T v_i = 1
    n_complex : the first so many are complex, the others real
    """

    s: float
    values: ComplexArray
    rates: ComplexArray
    right: ComplexArray
    left: ComplexArray
    n_complex: int

    @property
    def signature(self) -> tuple[int, int]:
        """Numbers of complex and of real eigenvalues."""
        return self.n_complex, len(self.values) - self.n_complex


def evaluate(sampler: Sampler, points: Array, scale_1_s: float) -> list[Node]:
    """Nodes at several points (g,) of a path; `scale_1_s`: frequency w0 that scales the state."""
    matrices, rates = sampler.matrices(points)
    mass, damping, stiffness = matrices[:, 0], matrices[:, 1], matrices[:, 2]
    n = mass.shape[-1]
    state = np.zeros((len(points), 2 * n, 2 * n))
    state[:, :n, n:] = scale_1_s * np.eye(n)
    diagonal = np.einsum("gii->gi", mass)
    if np.count_nonzero(mass) == np.count_nonzero(diagonal) == diagonal.size:
        inverse = np.zeros_like(mass)
        np.einsum("gii->gi", inverse)[...] = 1.0 / diagonal
        state[:, n:, :n] = stiffness / (-scale_1_s * diagonal[:, :, None])
        state[:, n:, n:] = -damping / diagonal[:, :, None]
    else:
        inverse = np.linalg.inv(mass)
        state[:, n:, :n] = -np.matmul(inverse, stiffness) / scale_1_s
        state[:, n:, n:] = -np.matmul(inverse, damping)
    values, right = (part.astype(np.complex128) for part in np.linalg.eig(state))
    left = _left(state, values, right)
    largest = np.maximum(np.abs(values).max(axis=1), 1e-300)[:, None]
    values[_zero(values, largest, stiffness)] = 0.0
    values.imag[np.abs(values.imag) < _REAL * np.abs(values)] = 0.0
    # eq 24 for the pencil: dl = - y^T (l^2 dM + l dD + dK) x with y = w2^T M^-1, x = v1 / w0, w^T v = 1
    x = right[:, :n, :] / scale_1_s
    y = np.matmul(left[:, :, n:], inverse)
    parts = [np.einsum("gun,gnu->gu", y, np.matmul(rates[:, i], x)) for i in range(3)]
    slopes: ComplexArray = -(values**2 * parts[0] + values * parts[1] + parts[2])
    slopes.imag[values.imag == 0.0] = 0.0
    slopes[~(np.abs(slopes) < _ENDLESS)] = np.nan
    # complex ones by frequency, then real ones, then the conjugates, which are left out
    order = np.lexsort((values.real, values.imag, values.imag == 0.0, values.imag < 0.0), axis=-1)
    values, slopes = np.take_along_axis(values, order, 1), np.take_along_axis(slopes, order, 1)
    right = np.take_along_axis(right, order[:, None, :], 2)
    left = np.take_along_axis(left, order[:, :, None], 1)
    used = (values.imag >= 0.0).sum(axis=1).tolist()
    n_complex = (values.imag > 0.0).sum(axis=1).tolist()
    return [
        Node(s, values[k, :u], slopes[k, :u], right[k, :, :u], left[k, :u], c)
        for k, (s, u, c) in enumerate(zip(np.asarray(points).tolist(), used, n_complex, strict=True))
    ]


def _zero(values: ComplexArray, largest: Array, stiffness: Array) -> NDArray[np.bool_]:
    """Which eigenvalues are zero but for rounding: small ones, as many as a singular stiffness allows."""
    small = np.abs(values) < COINCIDING * largest
    for k in np.flatnonzero(small.any(axis=1)):
        strengths = np.linalg.svd(stiffness[k], compute_uv=False)
        allowed = 2 * int((strengths <= _SINGULAR * strengths[0]).sum())
        small[k, np.argsort(np.abs(values[k]))[allowed:]] = False
    return small


def _left(state: Array, values: ComplexArray, right: ComplexArray) -> ComplexArray:
    """Left vectors as the inverse of the right ones; singly where a matrix is defective."""
    try:
        inverse: ComplexArray = np.linalg.inv(right).astype(np.complex128, copy=False)
        if np.isfinite(inverse).all():
            return inverse
    except np.linalg.LinAlgError:
        pass
    found = np.empty_like(right)
    for k in range(len(state)):
        try:
            found[k] = np.linalg.inv(right[k])
        except np.linalg.LinAlgError:
            z, vectors = linalg.eig(state[k], left=True, right=False)  # type: ignore[misc]
            order = np.argmin(np.abs(values[k][:, None] - z[None, :]), axis=1)
            w = vectors.conj().T[order]
            product = np.einsum("un,nu->u", w, right[k])
            found[k] = w / np.where(np.abs(product) < 1e-14, 1e-14, product)[:, None]
    return found


@dataclass(slots=True)
class Match:
    """How two nodes match: `order[i]` is the eigenvalue at the end that continues eigenvalue i, -1: none.

    `doubtful` (u,): correlation or prediction contradict; `close` (u,): comes near another within the step.
    """

    order: NDArray[np.intp]
    doubtful: NDArray[np.bool_]
    close: NDArray[np.bool_]

    @property
    def clear(self) -> bool:
        """Whether identity is beyond doubt."""
        return not (self.doubtful.any() or self.close.any())


def matches(starts: list[Node], ends: list[Node]) -> list[Match]:
    """Match nodes pair by pair: all starts of one signature, all ends of one; the ends may have more."""
    a, b = (np.stack([node.values for node in side]) for side in (starts, ends))
    da, db = (np.nan_to_num(np.stack([node.rates for node in side])) for side in (starts, ends))
    step = np.array([end.s - start.s for start, end in zip(starts, ends, strict=True)])
    (n_complex, n_real), (m_complex, m_real) = starts[0].signature, ends[0].signature
    forward = np.matmul(np.stack([n.left for n in starts]), np.stack([n.right for n in ends]))
    backward = np.matmul(np.stack([n.left for n in ends]), np.stack([n.right for n in starts]))
    correlation = forward * backward.transpose(0, 2, 1)  # X_ij = (w_i^T v'_j)(w'_j^T v_i); rows sum to 1
    half = 0.5 * step[:, None, None]
    missed = np.abs(b[:, None, :] - a[:, :, None] - half * (da[:, :, None] + db[:, None, :]))
    scale = np.maximum(np.abs(a).max(axis=1), np.abs(b).max(axis=1)) + 1e-300
    tolerance = COINCIDING * scale
    gap_a, gap_b = _gaps(a), _gaps(b)
    cost = (
        missed / (missed + gap_a[:, :, None] + tolerance[:, None, None])
        + 1.0
        - np.minimum(np.abs(correlation), 1.0)
    )
    if n_real or m_real:
        cost[:, :n_complex, m_complex:] = cost[:, n_complex:, :m_complex] = _FORBIDDEN
    cost = np.where(np.isfinite(cost), cost, _FORBIDDEN)
    order = _assigned(cost)
    ends_b, ends_db = np.take_along_axis(b, order, 1), np.take_along_axis(db, order, 1)
    # modes that coincide at the end share their space: what counts is the correlation with all of it
    same = np.abs(ends_b[:, :, None] - b[:, None, :]) <= tolerance[:, None, None]
    like = np.where(same, correlation, 0.0).sum(axis=2)
    miss = np.take_along_axis(missed, order[:, :, None], 2)[:, :, 0]
    apart = np.maximum(np.minimum(gap_a, np.take_along_axis(gap_b, order, 1)), tolerance[:, None])
    zero = (a == 0.0) & (ends_b == 0.0)
    doubtful = ~zero & ~((np.abs(1.0 - like) < _UNLIKE) & (miss < _MISSED * apart))
    close = _approaching(a, da, ends_b, ends_db, step, tolerance)
    close &= ~zero
    return [Match(order[k], doubtful[k], close[k]) for k in range(len(starts))]


def _assigned(cost: Array) -> NDArray[np.intp]:
    """Cheapest assignment of each cost matrix (k, u, v): the row minima where they differ; -1: left over."""
    from scipy.optimize import linear_sum_assignment

    order = cost.argmin(axis=2)
    plain = (np.diff(np.sort(order, axis=1), axis=1).astype(int) > 0).all(axis=1)
    for k in np.flatnonzero(~plain):
        rows, columns = linear_sum_assignment(cost[k])
        order[k] = -1
        order[k, rows] = columns
    return order


def _gaps(values: ComplexArray) -> Array:
    """Distance of each eigenvalue (k, u) to the nearest other one."""
    u = values.shape[1]
    distance = np.abs(values[:, :, None] - values[:, None, :])
    distance[:, np.arange(u), np.arange(u)] = np.inf
    return np.minimum(distance.min(axis=2), 1e300)


def _approaching(
    a: ComplexArray, da: ComplexArray, b: ComplexArray, db: ComplexArray, step: Array, tolerance: Array
) -> NDArray[np.bool_]:
    """Whether an eigenvalue moves, against another one or its own conjugate, further than their least
    distance.

    Only neighbours by start or end can do so; all are cubic Hermite curves over the step.
    """
    t = _SAMPLES
    basis = np.stack([2 * t**3 - 3 * t**2 + 1, t**3 - 2 * t**2 + t, -2 * t**3 + 3 * t**2, t**3 - t**2])
    h = step[:, None]
    curves = np.einsum("pku,pt->ktu", np.stack([a, h * da, b, h * db]), basis)
    u = a.shape[1]
    i, j = np.triu_indices(u, 1)
    # a pair that is far apart compared with how far both move needs no closer look
    reach = np.abs(np.diff(curves, axis=1)).sum(axis=1)
    maybe = (np.abs(a[:, i] - a[:, j]) < (1.0 + _APPROACH) * (reach[:, i] + reach[:, j])).any(axis=0)
    i, j = i[maybe], j[maybe]
    close = np.zeros(a.shape, dtype=bool)
    if i.size:
        near = _nearing(curves[:, :, i] - curves[:, :, j], tolerance)
        for column in np.flatnonzero(near.any(axis=0)):
            close[:, i[column]] |= near[:, column]
            close[:, j[column]] |= near[:, column]
    return close | _nearing(2j * curves.imag, tolerance)


def _nearing(difference: ComplexArray, tolerance: Array) -> NDArray[np.bool_]:
    """(k, q) whether curves (k, t, q) run further than their least distance to zero."""
    start, along = difference[:, :-1], np.diff(difference, axis=1)
    length = np.abs(along)
    where = np.clip(-(start * along.conj()).real / np.maximum(length**2, 1e-300), 0.0, 1.0)
    least = np.abs(start + where * along).min(axis=1)
    return length.sum(axis=1) > _APPROACH * np.maximum(least, tolerance[:, None])

"""All eigenvalues of T(lambda) x = 0 in a rectangle of the complex plane, by shift-invert Arnoldi.

At a shift s on the imaginary axis Arnoldi's method, its basis grown as long as needed (no restarts: the basis
is small beside the LU), converges to the eigenvalues of the linearisation nearest to s first, so to all
within the distance of the farthest. Discs about shifts are laid until they cover the rectangle; what they
find is united. NOT its job: proving that nothing was missed (`band_count`); results for people (`band`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy import sparse

from sim_hardware.brake_model.eigen.band_pencil import Complex, Factors, Pencil

#: size of the basis at which convergence is looked at first, steps after that, and the largest
_FIRST, _STEP, _MOST = 60, 20, 400
#: size up to which the basis is grown to save another shift
_ENOUGH = 160
#: error of 1 / (lambda - shift), relative, below which an eigenvalue has converged
_TOLERANCE = 1e-11
#: relative distance below which two runs mean the same eigenvalue
_SAME = 1e-6
#: part of a vector outside the span of others that makes it another vector
_INDEPENDENT = 1e-3
#: backward error above which what Arnoldi gives is no eigenvalue
_WORST_RESIDUAL = 1e-8
_MOST_SHIFTS = 400


@dataclass
class Found:
    """Eigenvalues found so far with their vectors and the covered discs."""

    zero: float = 0.0  # eigenvalues below it are those of free motion: one value
    values: list[complex] = field(default_factory=list)
    right: list[Complex] = field(default_factory=list)
    shifts: list[tuple[complex, float]] = field(default_factory=list)

    def unite(self, values: Complex, vectors: Complex) -> int:
        """Add what is new, multiplicities kept; returns how many were new.

        An eigenvalue of this run is known if a near one is, which no other of this run has been taken for,
        unless its vector is independent of those of all near ones (a multiple eigenvalue of which each run
        saw one).
        """
        known, taken, new = len(self.values), set[int](), 0
        old = np.array(self.values)
        for value, vector in zip(values, vectors.T, strict=True):
            near = (
                np.flatnonzero(np.abs(old - value) <= max(_SAME * abs(value), 2.0 * self.zero))
                if known
                else np.zeros(0, dtype=int)
            )
            free = [int(i) for i in near if int(i) not in taken]
            if free and not _independent(vector, [self.right[i] for i in near]):
                taken.add(min(free, key=lambda i: abs(old[i] - value)))
            else:
                self.values.append(complex(value))
                self.right.append(vector)
                new += 1
        return new


def cover(
    pencil: Pencil,
    low: float,
    high: float,
    width: float,
    found: Found,
    mirror: Found | None,
    *,
    seed: int = 0,
) -> None:
    """Find all eigenvalues with `low` <= Im <= `high` (1/s) and |Re| <= `width`.

    What is found is added to `found`, and, where `mirror` is given, the left vectors to `mirror`.

    Raises
    ------
    ArithmeticError
        the discs cannot cover the rectangle (too many eigenvalues), or Arnoldi does not converge
    """
    gaps, begun = [(low, high)], len(found.shifts)
    reach = 0.5 * (high - low)
    while gaps:
        if len(found.shifts) - begun >= _MOST_SHIFTS:
            raise ArithmeticError(
                f"more than {_MOST_SHIFTS} shifts are needed for this band; give a narrower one"
            )
        start, end = gaps.pop()
        middle = 0.5 * (start + end) if end - start <= 2.001 * reach else start + 0.9 * reach
        shift, radius = _search(
            pencil, middle, 1.001 * max(middle - start, 1e-3 * (end - start)), width, found, mirror, seed
        )
        half = math.sqrt(max(radius**2 - width**2, 0.0))
        found.shifts.append((shift, radius))
        reach = half
        for gap in ((start, middle - half), (middle + half, end)):
            if gap[1] > gap[0]:
                gaps.append(gap)


def _search(
    pencil: Pencil, height: float, half: float, width: float, found: Found, mirror: Found | None, seed: int
) -> tuple[complex, float]:
    """Find the eigenvalues next to i `height`, up to +- `half` where that is cheap, and return shift and
    radius within which all are found.
    """
    shift, factors = _shift(pencil, height)
    wanted = max(math.hypot(half, width), 1.2 * width)
    values, vectors, radius = arnoldi(pencil, factors, shift, 1.2 * width, wanted, seed=seed)
    found.unite(values, vectors)
    if mirror is not None:
        values, vectors, _ = arnoldi(
            pencil, factors, shift, 0.95 * radius, 0.95 * radius, transposed=True, seed=seed + 1
        )
        mirror.unite(values, vectors)
    return shift, radius


def _shift(pencil: Pencil, height: float) -> tuple[complex, Factors]:
    place = 1j * height
    for _ in range(4):
        try:
            return place, pencil.factors(place)
        except ZeroDivisionError:  # hit an eigenvalue
            place += (1e-6 + 1e-6j) * max(abs(height), 1e-6 * pencil.scale, 1e-6)
    raise ArithmeticError(
        f"T(lambda) is singular all around {height / (2 * math.pi):.4g} Hz: M, D and K share a null space"
    )


def arnoldi(
    pencil: Pencil,
    factors: Factors,
    shift: complex,
    reach: float,
    wanted: float,
    *,
    transposed: bool = False,
    seed: int = 0,
) -> tuple[Complex, Complex, float]:
    """Find all eigenvalues within at least `reach` of `shift`, if cheap within `wanted`, of T or its
    transpose.

    The linearisation has the state (x, y) with y = lambda x / balance, so that both parts are of one size.

    Returns
    -------
    values : (m,) 1/s
    vectors : (n_dof, m) norm 1
    radius : within it all are found

    Raises
    ------
    ArithmeticError
        too many eigenvalues so near, or what is found is not accurate
    """
    n, where = pencil.n_dof, f"{shift.imag / (2.0 * math.pi):.4g} Hz"
    balance = max(abs(shift), 1e-6 * pencil.scale, 1e-3)
    m, d = (sparse.csr_array(a.T if transposed else a) for a in (pencil.mass, pencil.damping))
    from_position, from_velocity = d + shift * m, (balance * m).astype(complex)
    most = min(_MOST, 2 * n)
    basis = np.zeros((most + 1, 2 * n), dtype=complex)  # row vectors: contiguous
    hessenberg = np.zeros((most + 1, most), dtype=complex)
    rng = np.random.default_rng(seed)
    start = rng.normal(size=2 * n) + 1j * rng.normal(size=2 * n)
    basis[0] = start / np.linalg.norm(start)
    for j in range(most):
        position, velocity = basis[j, :n], basis[j, n:]
        x = -factors.solve(from_position @ position + from_velocity @ velocity, transposed=transposed)
        new = np.concatenate([x, (position + shift * x) / balance])
        for _ in range(2):  # Gram and Schmidt, twice is enough
            part = (basis[: j + 1] @ new.conj()).conj()
            hessenberg[: j + 1, j] += part
            new -= part @ basis[: j + 1]
        length = float(np.linalg.norm(new))
        hessenberg[j + 1, j] = length
        whole = length <= 1e-14 * float(np.abs(hessenberg[: j + 1, j]).max())  # an invariant subspace
        if not whole:
            basis[j + 1] = new / length
        if whole or j + 1 == most or (j + 1 >= _FIRST and (j + 1) % _STEP == 0):
            ritz, shapes = np.linalg.eig(hessenberg[: j + 1, : j + 1])
            order = np.argsort(-np.abs(ritz))
            errors = (0.0 if whole else length) * np.abs(shapes[j, order]) / np.abs(ritz[order])
            unconverged = np.flatnonzero(errors > _TOLERANCE)
            count = int(unconverged[0]) if unconverged.size else j + 1
            radius = 1.0 / float(np.abs(ritz[order[count - 1]])) if count else 0.0
            if whole and not unconverged.size and j + 1 == 2 * n:
                radius = math.inf
            if radius >= (wanted if j + 1 < _ENOUGH else reach):
                break
    else:
        raise ArithmeticError(
            f"more than about {count} eigenvalues lie within {reach:.4g} 1/s of {where}; ask for a smaller "
            "largest damping ratio or a narrower band"
        )
    chosen = order[:count]
    values: Complex = (shift + 1.0 / ritz[chosen]).astype(complex)
    vectors: Complex = (basis[: j + 1, :n].T @ shapes[:, chosen]).astype(complex)
    vectors /= np.maximum(np.linalg.norm(vectors, axis=0), np.finfo(float).tiny)
    residual = float(pencil.residuals(values, vectors, transposed=transposed).max(initial=0.0))
    if not residual <= _WORST_RESIDUAL:
        raise ArithmeticError(
            f"eigenvalues near {where} are not accurate (residual {residual:.1e}); scale the matrices"
        )
    return values, vectors, radius


def paired_left(pencil: Pencil, values: Complex, right: Complex, mirror: Found) -> Complex:
    """Left vectors (n_dof, m) of the eigenvalues: the nearest of `mirror`, inverse iteration where it has
    none.

    Vectors of a cluster (relative distance below 1e-6) are combined so that w_i^T T'(lambda) x_j = 0.
    """
    left = np.zeros_like(right)
    pool = np.array(mirror.values)
    taken: set[int] = set()
    for i, value in enumerate(values):
        near = [
            int(j) for j in np.flatnonzero(np.abs(pool - value) <= _SAME * abs(value)) if int(j) not in taken
        ]
        if near:
            best = min(near, key=lambda j: abs(pool[j] - value))
            taken.add(best)
            left[:, i] = mirror.right[best]
        else:
            left[:, i] = inverse_iteration(pencil, value, transposed=True, seed=i)
    for cluster in _clusters(values):
        x, value = right[:, cluster], complex(values[cluster].mean())
        slopes = left[:, cluster].T @ (2.0 * value * (pencil.mass @ x) + pencil.damping @ x)
        if np.linalg.cond(slopes) < 1e6:  # else defective: there is no such combination
            left[:, cluster] = left[:, cluster] @ np.linalg.inv(slopes).T
            left[:, cluster] /= np.linalg.norm(left[:, cluster], axis=0)
    return left


def inverse_iteration(pencil: Pencil, value: complex, *, transposed: bool = False, seed: int = 0) -> Complex:
    """Right (or left) vector (n_dof,) of one eigenvalue, norm 1."""
    rng = np.random.default_rng(seed)
    vector = rng.normal(size=pencil.n_dof) + 1j * rng.normal(size=pencil.n_dof)
    factors = pencil.factors(value + 1e-9 * max(abs(value), 1e-6 * pencil.scale))
    for _ in range(3):
        vector = factors.solve(vector, transposed=transposed)
        vector /= np.linalg.norm(vector)
    return vector


def _clusters(values: Complex) -> list[list[int]]:
    clusters: list[list[int]] = []
    for i, value in enumerate(values):
        home = next((c for c in clusters if abs(values[c[-1]] - value) <= _SAME * abs(value)), None)
        if home is None:
            clusters.append([i])
        else:
            home.append(i)
    return [c for c in clusters if len(c) > 1]


def _independent(vector: Complex, others: list[Complex]) -> bool:
    basis, _ = np.linalg.qr(np.stack(others, axis=1))
    return bool(np.linalg.norm(vector - basis @ (basis.conj().T @ vector)) > _INDEPENDENT)

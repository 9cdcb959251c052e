"""Hurwitz's conditions of a 2-DOF system as boundaries in mu, each named (section 1.3).

    det(M l^2 + (D + mu D') l + K + mu K') = a4 l^4 + a3 l^3 + a2 l^2 + a1 l + a0

Asymptotically stable if and only if all a > 0, H2 = a3 a2 - a4 a1 > 0 and H3 = a1 H2 - a3^2 a0 > 0 (a4 > 0).
For eq 1 a4 and a3 are free of mu; the other five, a0, a1, a2, H2 (linear in mu) and H3 (quadratic), are the
paper's "five expressions". Which of them can be the first to fail:

- a0 = det K: divergence, a real eigenvalue passes 0.
- H3: flutter, a pair passes the imaginary axis at omega^2 = a1 / a3.
- a1, a2, H2: never, as long as a3 > 0 (positive damping). On a1 = 0 H3 = -a3^2 a0; on a2 = 0 H3 = -a4 a1^2 -
  a3^2 a0; on H2 = 0 H3 = -a3^2 a0: with a0 > 0 H3 has failed before.

Without damping a3 = a1 = H2 = H3 = 0, and flutter is the discriminant a2^2 - 4 a4 a0 < 0, for diagonal M the
same as (a11 - a22)^2 + 4 a12 a21 < 0 of M^-1 K. NOT its job: models (`two_dof`, `cases`), larger systems.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.polynomial import polynomial as poly
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import linear_sum_assignment

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Role = Literal["divergence", "flutter", "never first", "reference"]

#: size of a coefficient, relative to what it is summed from, that counts as 0
_ZERO = 1e-13
#: real part, relative to the eigenvalues, that counts as on the imaginary axis
_AXIS = 1e-6
#: roots beyond this mu are left out: nothing rubs so hard, and squares of it must stay finite
_MU_MAX = 1e9


@dataclass(frozen=True, slots=True, eq=False)
class TwoFreedoms:
    """M, D + mu D', K + mu K' of a system with two degrees of freedom, each (2, 2), SI."""

    mass: Array
    damping: Array
    damping_mu: Array
    stiffness: Array
    stiffness_mu: Array

    @property
    def undamped(self) -> bool:
        """Whether there is no damping at any mu."""
        return not (self.damping.any() or self.damping_mu.any())

    def state_matrix(self, mu: ArrayLike) -> Array:
        """State matrices of (displacements, velocities), mu's shape + (4, 4).

        Raises
        ------
        ValueError
            mu is not finite
        """
        mus = np.asarray(mu, dtype=float)
        if not np.all(np.isfinite(mus)):
            raise ValueError(f"mu = {mu}: not finite. Give a coefficient of friction")
        inverse = np.linalg.inv(self.mass)
        factor = mus[..., None, None]
        matrix = np.zeros((*mus.shape, 4, 4))
        matrix[..., 0, 2] = matrix[..., 1, 3] = 1.0
        matrix[..., 2:, :2] = -inverse @ (self.stiffness + factor * self.stiffness_mu)
        matrix[..., 2:, 2:] = -inverse @ (self.damping + factor * self.damping_mu)
        return matrix

    def eigenvalues(self, mu: ArrayLike) -> ComplexArray:
        """Eigenvalues (1/s), mu's shape + (4,), unsorted."""
        return np.linalg.eigvals(self.state_matrix(mu)).astype(np.complex128)

    def coefficients(self) -> tuple[Array, ...]:
        """a0 ... a4, each a polynomial in mu: coefficients of mu^0, mu^1, ... with trailing zeros removed."""
        entries = np.zeros((2, 2, 3, 2))  # [row, column, power of l, power of mu]
        entries[:, :, 0, 0], entries[:, :, 0, 1] = self.stiffness, self.stiffness_mu
        entries[:, :, 1, 0], entries[:, :, 1, 1] = self.damping, self.damping_mu
        entries[:, :, 2, 0] = self.mass
        total, size = np.zeros((5, 3)), np.zeros((5, 3))
        for i in range(3):
            for k in range(3):
                plus = np.convolve(entries[0, 0, i], entries[1, 1, k])
                minus = np.convolve(entries[0, 1, i], entries[1, 0, k])
                total[i + k] += plus - minus
                size[i + k] += np.abs(plus) + np.abs(minus)
        total[np.abs(total) < _ZERO * size] = 0.0
        return tuple(_trimmed(row) for row in total)


@dataclass(frozen=True, slots=True)
class Crossing:
    """A root of an expression: mu, frequency there of the eigenvalue nearest the imaginary axis (0: real),
    and
    whether the system is stable on exactly one side of it."""

    mu: float
    frequency_hz: float
    is_stability_boundary: bool


@dataclass(frozen=True, slots=True)
class Boundary:
    """One expression as polynomial in mu (ascending powers), its meaning, and its real roots (ascending)."""

    name: str
    formula: str
    role: Role
    meaning: str
    polynomial: tuple[float, ...]
    crossings: tuple[Crossing, ...]

    @property
    def vanishes(self) -> bool:
        """Whether the expression is 0 for every mu."""
        return not any(self.polynomial)

    def value(self, mu: float) -> float:
        """Value of the expression."""
        return float(poly.polyval(mu, self.polynomial))


def hurwitz_boundaries(system: TwoFreedoms) -> tuple[Boundary, ...]:
    """The five expressions a0, a1, a2, H2, H3, and the undamped flutter discriminant as reference.

    Roots of degree one and two are closed formulas; higher degrees (damping that depends on mu) are
    eigenvalues of the companion matrix.
    """
    a0, a1, a2, a3, a4 = system.coefficients()
    h2 = _difference(_product(a3, a2), _product(a4, a1))
    h3 = _difference(_product(a1, h2), _product(_product(a3, a3), a0))
    coupling = _difference(_product(a2, a2), 4.0 * _product(a4, a0))
    if not system.undamped:  # a2 without its part from damping
        bare = TwoFreedoms(
            system.mass, 0.0 * system.damping, 0.0 * system.damping, system.stiffness, system.stiffness_mu
        ).coefficients()
        coupling = _difference(_product(bare[2], bare[2]), 4.0 * _product(bare[4], bare[0]))
    rows: tuple[tuple[str, str, Role, str, Array], ...] = (
        (
            "a0",
            "det K > 0",
            "divergence",
            "an eigenvalue passes 0: the system runs away without vibrating",
            a0,
        ),
        ("a1", "a1 > 0", "never first", "fails only after H3 (damping positive)", a1),
        ("a2", "a2 > 0", "never first", "fails only after H3 (damping positive)", a2),
        ("H2", "a3 a2 - a4 a1 > 0", "never first", "fails only after H3 (damping positive)", h2),
        ("H3", "a1 H2 - a3² a0 > 0", "flutter", "a pair passes the imaginary axis at ω² = a1 / a3", h3),
        (
            "coupling",
            "a2² - 4 a4 a0 > 0 without damping",
            "reference",
            "frequencies of the undamped system meet: mode coupling",
            coupling,
        ),
    )
    return tuple(
        Boundary(name, formula, role, meaning, tuple(map(float, p)), _crossings(system, p))
        for name, formula, role, meaning, p in rows
    )


def is_stable(system: TwoFreedoms, mu: float) -> bool:
    """Asymptotically stable by Hurwitz's conditions (never without damping)."""
    a0, a1, a2, a3, a4 = (float(poly.polyval(mu, p)) for p in system.coefficients())
    h2 = a3 * a2 - a4 * a1
    return min(a0, a1, a2, a3, a4) > 0.0 and h2 > 0.0 and a1 * h2 - a3 * a3 * a0 > 0.0


def first_instability(system: TwoFreedoms, mu_from: float = 0.0) -> tuple[str, Crossing] | None:
    """Smallest root above `mu_from` at which the system stops being stable: ("divergence" or "flutter",
    where).

    None where it stays stable for ever. Undamped systems: where the first eigenvalue leaves the imaginary
    axis.

    Raises
    ------
    ValueError
        unstable at `mu_from` already
    """
    worst = float(system.eigenvalues(mu_from).real.max())
    if worst > _AXIS * _size(system, mu_from):
        raise ValueError(
            f"mu = {mu_from:g}: the system is unstable there already (growth rate {worst:g} 1/s). "
            "Give a smaller mu"
        )
    found = [
        (crossing.mu, "divergence" if boundary.role == "divergence" else "flutter", crossing)
        for boundary in hurwitz_boundaries(system)
        for crossing in boundary.crossings
        if crossing.is_stability_boundary and crossing.mu > mu_from
    ]
    if not found:
        return None
    _, role, crossing = min(found, key=lambda item: item[0])
    return role, crossing


def root_locus(system: TwoFreedoms, mus: ArrayLike) -> ComplexArray:
    """Eigenvalues over mu with their identity kept, (n, 4): column i belongs to one continuous curve.

    Sorted by frequency at the first mu; each step is matched to the straight continuation of the last two.

    Raises
    ------
    ValueError
        no values, or not finite
    """
    values = np.atleast_1d(np.asarray(mus, dtype=float))
    if not values.size:
        raise ValueError("mus = []: no values of mu to follow. Give at least one")
    found = system.eigenvalues(values)
    found[0] = found[0][np.lexsort((found[0].real, -np.sign(found[0].imag), np.abs(found[0].imag)))]
    for i in range(1, len(found)):
        ahead = found[i - 1] if i == 1 else 2.0 * found[i - 1] - found[i - 2]
        _, order = linear_sum_assignment(np.abs(ahead[:, None] - found[i][None, :]))
        found[i] = found[i][order]
    return found


def real_roots(polynomial: ArrayLike) -> tuple[float, ...]:
    """Real roots up to 1e9 in size, ascending, of a polynomial with ascending coefficients."""
    with np.errstate(over="ignore"):
        return tuple(root for root in _real_roots(polynomial) if abs(root) <= _MU_MAX)


def _real_roots(polynomial: ArrayLike) -> tuple[float, ...]:
    p = _trimmed(np.asarray(polynomial, dtype=float))
    if p.size <= 1:
        return ()
    if p.size == 2:
        return (float(-p[0] / p[1]),)
    if p.size == 3:
        c, b, a = (float(v) for v in p)
        square = b * b - 4.0 * a * c
        if square < 0.0:
            return ()
        q = -0.5 * (b + math.copysign(math.sqrt(square), b))  # free of cancellation
        roots = [q / a, c / q] if q != 0.0 else [0.0, 0.0]
        return tuple(sorted(roots)) if square > 0.0 else (roots[0],)
    roots = poly.polyroots(p)
    real = roots[np.abs(roots.imag) <= 1e-9 * np.maximum(np.abs(roots), 1e-300)].real
    return tuple(sorted(float(r) for r in real))


def _trimmed(polynomial: Array) -> Array:
    """Without zeros at the high end; at least one coefficient."""
    used = np.flatnonzero(polynomial)
    return polynomial[: used[-1] + 1] if used.size else np.zeros(1)


def _product(left: Array, right: Array) -> Array:
    return np.convolve(left, right)


def _difference(plus: Array, minus: Array) -> Array:
    """plus - minus, with what is rounding only set to 0."""
    n = max(plus.size, minus.size)
    left, right = np.zeros(n), np.zeros(n)
    left[: plus.size], right[: minus.size] = plus, minus
    result = left - right
    result[np.abs(result) < _ZERO * (np.abs(left) + np.abs(right))] = 0.0
    return _trimmed(result)


def _size(system: TwoFreedoms, mu: float) -> float:
    """Size of the eigenvalues, 1/s."""
    return float(np.abs(system.eigenvalues(mu)).max())


def _holds(system: TwoFreedoms, mu: float) -> bool:
    """Stable; without damping: no eigenvalue right of the imaginary axis."""
    if system.undamped:
        return float(system.eigenvalues(mu).real.max()) <= _AXIS * _size(system, mu)
    return is_stable(system, mu)


def _crossings(system: TwoFreedoms, polynomial: Array) -> tuple[Crossing, ...]:
    crossings = []
    for mu in real_roots(polynomial):
        eigenvalues = system.eigenvalues(mu)
        nearest = eigenvalues[np.argmin(np.abs(eigenvalues.real))]
        step = 1e-7 * abs(mu) if mu != 0.0 else 1e-12
        changes = _holds(system, mu - step) != _holds(system, mu + step)
        frequency = abs(float(nearest.imag)) / (2.0 * math.pi)
        real = abs(nearest) < 1e-6 * float(np.abs(eigenvalues).max())
        crossings.append(Crossing(mu, 0.0 if real else frequency, changes))
    return tuple(crossings)

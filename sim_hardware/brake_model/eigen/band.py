"""Eigenvalues lambda of (lambda^2 M + lambda D + K) x = 0 with vectors: all of a small model, those in a
frequency band of a large one.

Small models: LAPACK on the state matrix (eq 27). Large sparse ones: shift-invert Arnoldi over the band
(`band_arnoldi`) and a count of eigenvalues by the argument principle (`band_count`), so that the result says
whether it is complete. NOT its job: sensitivities (they use the vectors), figures.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy.linalg
from numpy.typing import NDArray

from sim_hardware.brake_model.eigen.band_arnoldi import Found, cover, paired_left
from sim_hardware.brake_model.eigen.band_count import missed
from sim_hardware.brake_model.eigen.band_pencil import Array, Complex, Pencil
from sim_hardware.brake_model.linear import LinearModel, Matrices

#: degrees of freedom up to which all eigenvalues are computed, with and without a band
DENSE_WITH_BAND, DENSE_ALWAYS = 250, 1500
#: largest damping ratio (either sign, of the band's upper edge) up to which a band is complete
DAMPING_MAX = 0.1
#: |lambda| below this part of the highest frequency is zero: rounding makes a double zero +-1e-8 of it
ZERO = 1e-7
_EPSILON = float(np.finfo(float).eps)


@dataclass(frozen=True, slots=True)
class EigenPairs:
    """Eigenvalues with Im >= 0, one of each conjugate pair and every real one, sorted by frequency, then real
    part.

    Attributes
    ----------
    eigenvalues : (m,) 1/s
    right, left : (n_dof, m) x and w, norm 1, T x = 0 and w^T T = 0 with T = lambda^2 M + lambda D + K;
        w^T (2 lambda M + D) x is real and not negative (eq 24: dlambda = - w^T dT x / w^T (2 lambda M + D) x)
    residuals : (m,) |T x| / ((|lambda|^2 |M| + |lambda| |D| + |K|) |x|), the backward error
    conditions : (m,) relative change of lambda per relative change of the matrices (in their Frobenius norms)
    alignments : (m,) |w^T (2 lambda M + D) x| / (2 |lambda| sqrt(x* M x  w* M w)), at most 1: 1 for undamped
        symmetric models, 0 for a defective pair; small: the vectors and everything made of them are not to be
        trusted
    errors_1_s : (m,) first-order bound of the error of lambda, from residual and condition
    method : "dense" or "shift-invert"
    band_hz : the band asked for, None for all
    real_part_max_1_s : |Re| up to which the band is covered; infinite for dense
    complete : whether all eigenvalues of the band (up to that real part) are here: True proven, False some
        are known to be missing, None not proven
    evidence : how `complete` is known, a sentence
    """

    eigenvalues: Complex
    right: Complex
    left: Complex
    residuals: Array
    conditions: Array
    alignments: Array
    errors_1_s: Array
    method: str
    band_hz: tuple[float, float] | None
    real_part_max_1_s: float
    complete: bool | None
    evidence: str

    def chosen(self, keep: NDArray[np.intp]) -> EigenPairs:
        """Some of the pairs, by their indices."""
        fields = ("eigenvalues", "residuals", "conditions", "alignments", "errors_1_s")
        picked = {name: getattr(self, name)[keep] for name in fields}
        return replace(self, right=self.right[:, keep], left=self.left[:, keep], **picked)

    @property
    def frequencies_hz(self) -> Array:
        """Im / 2 pi, (m,)."""
        return self.eigenvalues.imag / (2.0 * math.pi)

    @property
    def damping_ratios(self) -> Array:
        """-Re / |lambda|, (m,); 0 for lambda = 0."""
        size = np.abs(self.eigenvalues)
        return np.where(size > 0.0, -self.eigenvalues.real / np.where(size > 0.0, size, 1.0), 0.0)

    @property
    def unstable(self) -> np.ndarray:
        """Whether Re is positive beyond the bound of its error, (m,)."""
        return self.eigenvalues.real > self.errors_1_s


def eigen_pairs_of(
    model: LinearModel,
    values: Mapping[str, float] | None = None,
    band: tuple[float, float] | None = None,
    *,
    damping_max: float = DAMPING_MAX,
) -> EigenPairs:
    """Eigenvalue pairs of a model at other values of its quantities, all or within a frequency band (Hz).

    Raises
    ------
    KeyError, ValueError
        as `LinearModel.matrices`; band not 0 <= f1 < f2; no band for a model of more than `DENSE_ALWAYS`
        freedoms
    ArithmeticError
        Arnoldi's method does not converge
    numpy.linalg.LinAlgError
        M is singular
    """
    return eigen_pairs_of_matrices(model.matrices(values), band, damping_max=damping_max)


def eigen_pairs_of_matrices(
    matrices: Matrices, band: tuple[float, float] | None = None, *, damping_max: float = DAMPING_MAX
) -> EigenPairs:
    """As `eigen_pairs_of`, for M, D, K at hand."""
    if band is not None and not (0.0 <= band[0] < band[1] < math.inf):
        raise ValueError(f"the band {band[0]:g} to {band[1]:g} Hz is none; give 0 <= lower < upper")
    if not 0.0 < damping_max <= 1.0:
        raise ValueError(f"the largest damping ratio is {damping_max!r}; give more than 0, at most 1")
    pencil = Pencil(matrices)
    if band is None and pencil.n_dof > DENSE_ALWAYS:
        raise ValueError(
            f"the model has {pencil.n_dof} degrees of freedom; all eigenvalues of more "
            f"than {DENSE_ALWAYS} take minutes: give a frequency band"
        )
    if band is None or pencil.n_dof <= DENSE_WITH_BAND:
        return _dense(matrices, pencil, band)
    return _sparse(pencil, band, damping_max)


def _dense(matrices: Matrices, pencil: Pencil, band: tuple[float, float] | None) -> EigenPairs:
    state = matrices.state_matrix()
    if not np.isfinite(state).all():
        raise ValueError("the matrices hold values that are not finite, or M is singular")
    n = pencil.n_dof
    with np.errstate(all="ignore"):
        decomposition: Any = scipy.linalg.eig(state, left=True, right=True)
    values, left, right = decomposition
    values[np.abs(values) <= ZERO * np.abs(values).max(initial=0.0)] = 0.0
    kept = values.imag >= 0.0
    if band is not None:
        kept &= _within(values, band)
    # w^T A = lambda w^T of the state (w1, w2): w2 = M^T w (conjugate: LAPACK gives w^H)
    bottom = left[n:, kept].conj()
    mass = matrices.dense().mass
    w = np.linalg.solve(mass.T, bottom)
    x = np.where(np.abs(values[kept]) > 1.0, right[n:, kept], right[:n, kept])  # (x, lambda x)
    return _result(
        pencil, values[kept], x, w, "dense", band, math.inf, True, "all eigenvalues were computed (LAPACK)"
    )


def _sparse(pencil: Pencil, band: tuple[float, float], damping_max: float) -> EigenPairs:
    low, high = (2.0 * math.pi * f for f in band)
    width = damping_max * high
    margin = 0.02 * (high - low)
    zero = ZERO * pencil.scale
    found = Found(zero)
    mirror = None if _symmetric(pencil) else Found(zero)
    bottom, top = (low - margin if low > 0.0 else -margin), high + margin
    for attempt in range(3):
        cover(pencil, bottom, top, width, found, mirror, seed=7 * attempt)
        known = _with_conjugates(np.array(found.values), zero)
        edges = _free(known.imag, bottom, low), _free(known.imag, high, top)
        corners = (
            complex(-_free(-known.real, 0.95 * width, width), edges[0]),
            complex(_free(known.real, 0.95 * width, width), edges[1]),
        )
        lacking = missed(pencil, known, corners, most_factors=600)
        if lacking is None or lacking == 0:
            break
    complete = None if lacking is None else lacking == 0
    count = len(found.shifts)
    discs = f"{count} {'shifts cover' if count > 1 else 'shift covers'} the band up to a damping ratio of "
    discs += f"{damping_max:g}"
    evidence = {
        True: f"{discs}; the argument principle counts as many eigenvalues as were found",
        False: f"{discs}; the argument principle counts {lacking} more than were found",
        None: f"{discs}; not proven: the count by the argument principle did not end",
    }[complete]
    values: Complex = np.array(found.values, dtype=complex)
    chosen = np.flatnonzero((values.imag >= -zero) & _within(values, band))
    values[np.abs(values) <= zero] = 0.0
    values = np.where(np.abs(values.imag) <= 1e-9 * np.abs(values), values.real, values)
    chosen = chosen[(values[chosen].imag >= 0.0)]
    right = (
        np.stack([found.right[i] for i in chosen], axis=1)
        if len(chosen)
        else np.zeros((pencil.n_dof, 0), complex)
    )
    left = right if mirror is None else paired_left(pencil, values[chosen], right, mirror)
    refined = _rayleigh(pencil, values[chosen], right, left)
    return _result(pencil, refined, right, left, "shift-invert", band, width, complete, evidence)


def _result(
    pencil: Pencil, values: Complex, right: Complex, left: Complex, method: str,
    band: tuple[float, float] | None, width: float, complete: bool | None, evidence: str,
) -> EigenPairs:  # fmt: skip
    tiny = np.finfo(float).tiny
    order = np.lexsort((values.real, values.imag))
    values, right, left = values[order], right[:, order], left[:, order]
    right, left = (v / np.maximum(np.linalg.norm(v, axis=0), tiny) for v in (right, left))
    largest = right[np.abs(right).argmax(axis=0), np.arange(len(values))]
    right = right * (np.abs(largest) / np.where(largest == 0.0, 1.0, largest))
    slopes = pencil.slopes(values, right, left)
    left = left * np.where(slopes == 0.0, 1.0, slopes.conj() / np.maximum(np.abs(slopes), tiny))
    sizes = pencil.sizes(values)
    with np.errstate(over="ignore"):
        spread = sizes / np.maximum(np.abs(slopes), tiny * sizes)
        conditions = spread / np.maximum(np.abs(values), tiny * spread)
    residuals = pencil.residuals(values, right)
    momenta = (np.abs(np.einsum("im,im->m", v.conj(), pencil.mass @ v)) for v in (right, left))
    kinetic = 2.0 * np.abs(values) * np.sqrt(np.prod(list(momenta), axis=0))
    alignments = np.minimum(np.abs(slopes) / np.maximum(kinetic, tiny), 1.0)
    return EigenPairs(
        values, right, left, residuals, conditions, alignments, np.maximum(residuals, _EPSILON) * spread,
        method, band, width, complete, evidence,
    )  # fmt: skip


def _rayleigh(pencil: Pencil, values: Complex, right: Complex, left: Complex) -> Complex:
    """Eigenvalues improved by Newton's step on w^T T(lambda) x = 0, whose error is the product of both
    vectors'.
    """
    slopes = pencil.slopes(values, right, left)
    step = np.einsum("im,im->m", left, pencil.applied(values, right)) / np.where(slopes == 0.0, 1.0, slopes)
    safe = (np.abs(step) <= 1e-7 * np.abs(values)) & (slopes != 0.0)  # not at nearly defective pairs
    return np.where(safe, values - step, values)


def _within(values: Complex, band: tuple[float, float]) -> np.ndarray:
    low, high = (2.0 * math.pi * f for f in band)
    return (np.abs(values.imag) >= low) & (np.abs(values.imag) <= high)


def _symmetric(pencil: Pencil) -> bool:
    parts = (pencil.mass, pencil.damping, pencil.stiffness)
    return all(abs(part - part.T).max() <= 1e-14 * abs(part).max() for part in parts)


def _with_conjugates(values: Complex, zero: float) -> Complex:
    """Values and the conjugates that are not among them."""
    known = list(values)
    for value in values:
        if min(abs(other - value.conjugate()) for other in known) > max(1e-6 * abs(value), 2.0 * zero):
            known.append(value.conjugate())
    return np.array(known)


def _free(known: Array, low: float, high: float) -> float:
    """Place between `low` and `high` farthest from all known ones."""
    places = np.linspace(low, high, 41)[1:-1]
    distance = np.abs(places[:, None] - known[None, :]).min(axis=1, initial=math.inf)
    return float(places[int(np.argmax(distance))])

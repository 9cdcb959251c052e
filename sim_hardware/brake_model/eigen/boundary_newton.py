"""Refining a crossing of the imaginary axis between two points: Newton with eq 24, or with the secular
equation.

Both are kept within their bracket. Also the meaning of "unstable" beyond rounding, and of motions without any
restoring force. NOT its job: finding the bracket (`boundary`, `maps`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.eigen.secular import SMALL
from sim_hardware.brake_model.eigen.secular_equation import Interval, SecularEquation
from sim_hardware.brake_model.linear import Matrices

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Kind = Literal["flutter", "divergence"]
#: M, D, K and their derivatives at a number t, dense
WithDerivative = Callable[[float], tuple[Matrices, Matrices]]

#: real parts up to this share of the largest modulus are on the axis
ON_AXIS = 1e-9
#: Newton's last step, relative: its square is rounding; width of a bracket that can only be halved
_AT_REST, _NARROW = 1e-9, 1e-14
_ITERATIONS = 100


@dataclass(frozen=True, slots=True)
class BoundaryPoint:
    """A crossing of the imaginary axis.

    Attributes
    ----------
    value : of the quantity moved, or relative change of the group
    frequency_hz : exact, 0 at divergence
    kind : "flutter" (a pair crosses) or "divergence" (a real eigenvalue passes 0)
    destabilises : whether stability is lost with rising distance from the start; else it is regained
    rate_1_s : d Re(lambda) / d value there (eq 24); nan where eq 24 has no number (coinciding eigenvalues)
    """

    value: float
    frequency_hz: float
    kind: Kind
    destabilises: bool
    rate_1_s: float


def crossing_between(
    at: WithDerivative, before: float, after: float, *, free: int, began_unstable: bool
) -> tuple[BoundaryPoint, int]:
    """The crossing between two numbers by Newton with eq 24 on the leading eigenvalue, else by halving.

    Parameters
    ----------
    before, after : stable and unstable, or the other way round where `began_unstable`
    free : number of eigenvalues that are always 0 (see `free_motions`)

    Returns
    -------
    the crossing, number of steps
    """
    span, cell = max(abs(before), abs(after)), abs(after - before)
    t, iteration = after, 0
    leading, rate = 0j, complex("nan")
    while iteration < _ITERATIONS:
        iteration += 1
        matrices, change = at(t)
        values = np.linalg.eigvals(matrices.state_matrix()).astype(complex)
        axis = ON_AXIS * float(np.abs(values).max())
        kept = without_free(values, free)
        leading = complex(kept[int(kept.real.argmax())])
        rate = eigenvalue_rate(matrices, change, leading)
        if (leading.real > axis) == began_unstable:
            before = t
        else:
            after = t
        # a derivative that moves nothing over the cell is rounding: undamped, or coinciding eigenvalues
        step = leading.real / rate.real if abs(rate.real) * cell > axis else math.nan
        if abs(step) <= _AT_REST * span:
            t -= step
            break
        if abs(after - before) <= _NARROW * span:
            break
        inside = min(before, after) < t - step < max(before, after)
        on_axis = abs(leading.real) <= axis and abs(step) < 0.1 * cell
        t = t - step if inside or on_axis else 0.5 * (before + after)
    flutter = abs(leading.imag) > ON_AXIS * abs(leading)
    frequency = abs(leading.imag) / (2.0 * math.pi) if flutter else 0.0
    kind: Kind = "flutter" if flutter else "divergence"
    return BoundaryPoint(t, frequency, kind, not began_unstable, rate.real), iteration


def secular_crossings(
    equation: SecularEquation, lines: tuple[Array, Interval], cells: Array, near: Complex
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Crossings in cells of lines by Newton in (omega, t) on the secular equation.

    Parameters
    ----------
    lines : coefficients (m, 2, terms, n / 2) of each line (`SecularEquation.along_x` or `along_y`), and the
        range of t
    cells : (m, 2) ends of the cells
    near : (m, 2, n) eigenvalues there; unstable at one end

    Returns
    -------
    (m,) t, (m,) omega (0: divergence), (m,) whether found within its cell
    """
    from sim_hardware.brake_model.eigen.secular_kernels import cross_rows  # here: eq 24 does without numba

    numerators, interval = lines
    ends = interval.scaled(cells)
    index = np.arange(len(ends))
    leading = near.real.argmax(axis=2)
    growth = np.take_along_axis(near.real, leading[:, :, None], axis=2)[:, :, 0]
    share = growth[:, 0] / (growth[:, 0] - growth[:, 1])
    outside = np.where(growth[:, 1] > growth[:, 0], 1, 0)  # the unstable end, where the right pair leads
    start = np.abs(near[index, outside, leading[index, outside]].imag)
    found = np.stack([ends[:, 0] + share * (ends[:, 1] - ends[:, 0]), start], axis=1)
    good = cross_rows(equation.a, equation.b, numerators, ends.min(axis=1), ends.max(axis=1), found)
    return interval.middle + interval.half * found[:, 0], np.abs(found[:, 1]), good


def eigenvalue_rate(matrices: Matrices, change: Matrices, value: complex) -> complex:
    """Derivative of one eigenvalue (eq 24, written for the pencil; see `sensitivity`), nan where it has none.

    Parameters
    ----------
    matrices, change : M, D, K and their derivatives, dense
    value : the eigenvalue, 1/s
    """
    left, size, right = np.linalg.svd(
        value**2 * matrices.mass + value * matrices.damping + matrices.stiffness
    )
    if len(size) > 1 and size[-1] > 1e-3 * size[-2]:
        return complex("nan")  # no single null vector: eigenvalues coincide
    w, v = left[:, -1].conj(), right[-1].conj()
    across = w @ (2.0 * value * matrices.mass + matrices.damping) @ v
    if abs(across) == 0.0:
        return complex("nan")
    return complex(
        -(w @ (value**2 * change.mass + value * change.damping + change.stiffness) @ v) / across
    )  # eq 24


def free_motions(values: Complex) -> int:
    """Number of eigenvalues (..., n) that are 0 but for rounding everywhere: bodies without couplings."""
    size = np.abs(values)
    return int((size <= SMALL * size.max(axis=-1, keepdims=True)).sum(axis=-1).min())


def without_free(values: Complex, free: int) -> Complex:
    """Eigenvalues (..., n) without the `free` smallest."""
    if not free:
        return values
    return np.take_along_axis(values, np.argsort(np.abs(values), axis=-1)[..., free:], axis=-1)


def growing(values: Complex, free: int) -> NDArray[np.bool_]:
    """Whether an eigenvalue (..., n), sorted by frequency, has a positive real part, beyond rounding."""
    return without_free(values, free).real.max(axis=-1) > on_axis(values)


def on_axis(values: Complex) -> Array:
    """Real part up to which eigenvalues (..., n), sorted by frequency, count as on the axis."""
    return ON_AXIS * np.maximum(np.abs(values[..., 0]), np.abs(values[..., -1]))

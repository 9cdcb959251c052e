"""Technical sensitivity of large models: the modes of a frequency band after each modification.

Each mode of the band is carried from the model as it is to the modified one: eq 24 for the whole change
predicts its eigenvalue, Newton's method on Q(l) v = 0 (nonlinear inverse iteration, one sparse factorisation
a step) finds it. A mode that ends far from its prediction, or where another one ends too, is flagged; one
that is not found is nan.
NOT its job: small models, all eigenvalues (`resolving`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.design.resolving import CLEAR, Resolved, predicted
from sim_hardware.brake_model.design.variations import Variation
from sim_hardware.brake_model.eigen.band_pencil import Pencil
from sim_hardware.brake_model.eigen.eigen_systems import ComplexArray, EigenSystem, band_system
from sim_hardware.brake_model.linear import LinearModel, Matrices

#: a step of Newton's method smaller than this share of the eigenvalue ends it
_CONVERGED = 1e-10
_MOST_STEPS = 12
#: found eigenvalues nearer than this share are one and the same
_SAME = 1e-7

Values = Mapping[str, float]


def resolve_in_band(
    model: LinearModel,
    variations: Sequence[Variation],
    points: Sequence[Values],
    values: Values | None,
    band_hz: tuple[float, float],
) -> Resolved:
    """Modes of a band, in the model as it is and modified, at some working points; see `resolving.resolve`.

    Raises
    ------
    KeyError, ValueError
        unknown quantity, impossible value or modification, no eigenvalue in the band
    ArithmeticError, numpy.linalg.LinAlgError
        no convergence in the band, M is singular
    """
    bases = [{**(values or {}), **point} for point in points]
    before = model.matrices(bases[0])
    first = band_system(before, band_hz)
    nominal = np.empty((len(bases), first.values.size), dtype=complex)
    nominal_sure = np.ones(nominal.shape, dtype=bool)
    varied = np.empty((len(variations), *nominal.shape), dtype=complex)
    sure = np.ones(varied.shape, dtype=bool)
    for k, base in enumerate(bases):
        nominal[k] = first.values
        if k:
            nominal[k], nominal_sure[k] = _carried(first, before, model.matrices(base))
        for number, v in enumerate(variations):
            after = model.matrices(v.values(model, base))
            varied[number, k], sure[number, k] = _carried(first, before, after)
    return Resolved(tuple(points), tuple(variations), nominal, varied, nominal_sure, sure)


def _carried(start: EigenSystem, before: Matrices, after: Matrices) -> tuple[ComplexArray, NDArray[np.bool_]]:
    """Where the modes of a system are after a change, and whether each is recognised clearly."""
    change = Matrices(
        after.mass - before.mass, after.damping - before.damping, after.stiffness - before.stiffness
    )
    guesses = predicted(start, change)
    found = np.full(guesses.size, complex(np.nan, np.nan))
    pencil = Pencil(after)
    for i in np.flatnonzero(start.values.imag >= 0.0):
        found[i] = _newton(pencil, complex(guesses[i]), start.right[:, i])
    for i in np.flatnonzero(start.values.imag < 0.0):  # the twin of the pair stands before it
        found[i] = found[i - 1].conj()
    sure = np.abs(found - guesses) <= CLEAR * start.gap
    with np.errstate(invalid="ignore"):
        twice = np.abs(found[:, None] - found[None, :]) <= _SAME * np.abs(found)[:, None]
    return found, sure & (twice.sum(axis=1) == 1)


def _newton(pencil: Pencil, value: complex, vector: ComplexArray) -> complex:
    """Eigenvalue near a guess; nan where the steps do not end."""
    vector = vector / np.linalg.norm(vector)
    keep = vector.conj()
    for _ in range(_MOST_STEPS):
        try:
            factors = pencil.factors(value)
        except ZeroDivisionError:  # exactly singular: the guess is the eigenvalue
            return value
        solved = factors.solve((2.0 * value) * (pencil.mass @ vector) + pencil.damping @ vector)
        size = complex(keep @ solved)
        if size == 0.0 or not np.isfinite(size):
            break
        step = complex(keep @ vector) / size
        value, vector = value - step, solved / size
        if abs(step) <= _CONVERGED * abs(value):
            return value
    return complex(np.nan, np.nan)

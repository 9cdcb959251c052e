"""Technical sensitivity analysis (4.3.1): eigenvalues before and after a finite change, each mode kept apart.

The varied models of all modifications and working points are solved in one batch. Which varied eigenvalue
belongs to which mode is decided by eq 24 applied to the whole change of M, D, K: it predicts every
eigenvalue, and the nearest one found is taken if it is clearly the nearest and each is taken once. Where that
is not clear the change is made in smaller steps until it is; where even tiny steps leave it open (two
eigenvalues pass through a common point) the modes are flagged: their identity is undefined.
NOT its job: what is varied (`variations`), continuous tracking for root loci, judging the results.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from sim_hardware.brake_model.design.matrix_batches import MatrixBatch, matrix_batch
from sim_hardware.brake_model.design.variations import Variation
from sim_hardware.brake_model.eigen.eigen_systems import ComplexArray, EigenSystem, eigen_system
from sim_hardware.brake_model.linear import LinearModel, Matrices, value_of

#: an eigenvalue is recognised when it lies nearer to its prediction than this share of its distance to the
#: next one
CLEAR = 0.3
#: smallest step, as share of the whole change, before the identity is given up
_SMALLEST = 2.0**-14

Values = Mapping[str, float]


@dataclass(frozen=True, slots=True)
class Resolved:
    """Eigenvalues of a design and of its modifications at several working points.

    Attributes
    ----------
    points : (k,) working points
    nominal : (k, m) 1/s; column i is one mode, in `sensitivity.mode_order` at the first point
    varied : (v, k, m) 1/s, the same modes
    sure : (v, k, m) whether a mode's identity is certain
    nominal_sure : (k, m)
    """

    points: tuple[Values, ...]
    variations: tuple[Variation, ...]
    nominal: ComplexArray
    varied: ComplexArray
    nominal_sure: NDArray[np.bool_]
    sure: NDArray[np.bool_]

    @property
    def frequencies_hz(self) -> NDArray[np.float64]:
        """(m,) of the modes at the first point."""
        return np.abs(self.nominal[0].imag) / (2.0 * np.pi)


def resolve(
    model: LinearModel,
    variations: Sequence[Variation],
    points: Sequence[Values] = ({},),
    values: Values | None = None,
) -> Resolved:
    """Solve a model and all its modifications at some working points.

    Parameters
    ----------
    points : values of each working point, for example ({"mu": 0.4}, {"mu": 0.6})
    values : other values that differ from the file's, at all points

    Raises
    ------
    KeyError, ValueError
        unknown quantity, impossible value or modification
    numpy.linalg.LinAlgError
        M is singular
    """
    bases = [{**(values or {}), **point} for point in points]
    first = eigen_system(model.matrices(bases[0]))
    systems, nominal_sure = [first], [np.ones(first.values.size, dtype=bool)]
    for base in bases[1:]:
        moved, sure = follow(model, systems[0], bases[0], base)
        systems.append(moved)
        nominal_sure.append(sure)
    varied = np.empty((len(variations), len(bases), first.values.size), dtype=complex)
    sure = np.ones(varied.shape, dtype=bool)
    targets = [[v.values(model, base) for v in variations] for base in bases]
    batch = matrix_batch(model, [values for several in targets for values in several])
    found = np.linalg.eigvals(batch.state_matrices()).astype(complex)
    for k, (base, system) in enumerate(zip(bases, systems, strict=True)):
        part = slice(k * len(variations), (k + 1) * len(variations))
        changes = batch.minus(model.matrices(base).dense(), part)
        varied[:, k], sure[:, k] = _recognise(model, system, base, targets[k], changes, found[part])
    return Resolved(
        tuple(points), tuple(variations), np.stack([s.values for s in systems]), varied,
        np.stack(nominal_sure), sure,
    )  # fmt: skip


def follow(
    model: LinearModel, start: EigenSystem, origin: Values, target: Values
) -> tuple[EigenSystem, NDArray[np.bool_]]:
    """Follow all modes from one set of values to another, in steps as small as needed.

    Parameters
    ----------
    start : eigenvalues and vectors at `origin`

    Returns
    -------
    system : at `target`, in the order of `start`
    sure : (m,) whether each mode's identity is certain
    """
    sure = np.ones(start.values.size, dtype=bool)
    system, matrices = start, model.matrices(origin).dense()
    done, step = 0.0, 1.0
    while done < 1.0:
        step = min(step, 1.0 - done)
        reached = 1.0 if done + step >= 1.0 else done + step
        ahead_matrices = model.matrices(_between(model, origin, target, reached)).dense()
        ahead = eigen_system(ahead_matrices)
        _, order, clear = matched(predicted(system, _change(matrices, ahead_matrices)), ahead.values)
        if not clear.all() and step > _SMALLEST:
            step /= 4.0
            continue
        sure &= clear
        system, matrices, done = _ordered(ahead, order), ahead_matrices, reached
        step *= 2.0
    return system, sure


def _recognise(
    model: LinearModel,
    system: EigenSystem,
    base: Values,
    targets: Sequence[Values],
    changes: MatrixBatch,
    found: ComplexArray,
) -> tuple[ComplexArray, NDArray[np.bool_]]:
    """Eigenvalues found of each modification in the order of the modes of `system`, and whether that is
    certain.
    """
    distance = np.abs(_predict_batch(system, changes)[:, :, None] - found[:, None, :])
    choice = distance.argmin(axis=2)
    chosen = np.take_along_axis(found, choice, axis=1)
    error = np.take_along_axis(distance, choice[:, :, None], axis=2)[:, :, 0]
    spacing = np.abs(chosen[:, :, None] - found[:, None, :])
    np.put_along_axis(spacing, choice[:, :, None], np.inf, axis=2)
    once = (np.sort(choice, axis=1) == np.arange(system.values.size)).all(axis=1)
    clear = (error <= CLEAR * spacing.min(axis=2)).all(axis=1) & once
    sure = np.ones(found.shape, dtype=bool)
    for number in map(int, np.flatnonzero(~clear)):
        moved, sure[number] = follow(model, system, base, targets[number])
        chosen[number] = moved.values
    return chosen, sure


def _between(model: LinearModel, origin: Values, target: Values, share: float) -> dict[str, float]:
    if share >= 1.0:
        return dict(target)
    names = {**origin, **target}
    return {
        name: (1.0 - share) * value_of(model, name, origin) + share * value_of(model, name, target)
        for name in names
    }


def _change(before: Matrices, after: Matrices) -> Matrices:
    return Matrices(
        after.mass - before.mass, after.damping - before.damping, after.stiffness - before.stiffness
    )


def predicted(system: EigenSystem, change: Matrices) -> ComplexArray:
    """Eigenvalues after a finite change by eq 24; nan-free: irregular ones stay where they are."""
    v, w, values = system.right, system.left, system.values
    force = values**2 * (change.mass @ v) + values * (change.damping @ v) + change.stiffness @ v
    return _moved(system, np.sum(w * force, axis=0))


def _predict_batch(system: EigenSystem, changes: MatrixBatch) -> ComplexArray:
    """As `predicted` for all modifications at once, (v, m)."""
    v, values = system.right, system.values
    both = np.ascontiguousarray(
        np.hstack([v.real, v.imag])
    )  # small real products: no threads, no complex copies

    def applied(change: NDArray[np.float64]) -> ComplexArray:
        parts = change @ both
        return parts[:, :, : values.size] + 1j * parts[:, :, values.size :]

    force = applied(changes.stiffness) + values * applied(changes.damping)
    if changes.mass.any():
        force += values**2 * applied(changes.mass)
    return _moved(system, np.sum(system.left * force, axis=1))


def _moved(system: EigenSystem, change: ComplexArray) -> ComplexArray:
    regular = system.regular
    slope = np.where(regular, system.slope, 1.0)
    return system.values - np.where(regular, change / slope, 0.0)


def matched(
    predictions: ComplexArray, found: ComplexArray
) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.bool_]]:
    """Assignment of eigenvalues to predictions of least total distance: rows, columns, which are clear."""
    distance = np.abs(predictions[:, None] - found[None, :])
    rows, columns = linear_sum_assignment(distance)
    chosen = found[columns]
    spacing = np.abs(chosen[:, None] - found[None, :])
    spacing[np.arange(chosen.size), columns] = np.inf
    return rows, columns, distance[rows, columns] <= CLEAR * spacing.min(axis=1, initial=np.inf)


def _ordered(system: EigenSystem, order: NDArray[np.intp]) -> EigenSystem:
    return EigenSystem(
        system.values[order], system.right[:, order], system.left[:, order], system.slope[order],
        system.condition[order], system.gap[order], tuple(system.reasons[i] for i in order),
    )  # fmt: skip

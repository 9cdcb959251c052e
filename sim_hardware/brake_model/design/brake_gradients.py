"""Numerators of eq 24 for all quantities of a brake at once, by the rank-one structure of its coupling lines.

A line with relative displacement r and coefficients c, d contributes (c + l d) (r.w)(r.v) to w^T Q(l) v,
friction at a contact -side mu (c + l d) (rx.w)(ry.v) and -share k N l (rx.w)(rx.v). So the change of w^T Q v
by every place of the brake file needs only the products r.w and r.v of all lines: no matrix dM, dD, dK is
formed.
NOT its job: eigenvalues, conditions (`sensitivity`); models other than our brake, which give their matrices.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.linear import MU, PRESSURE, SLOPE
from sim_hardware.brake_model.lines import Lines, Structure
from sim_hardware.brake_model.parametric import AREA, PA_PER_BAR, LinearBrake

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class _Entries:
    """Derivatives of lines by places as lists of entries (place, line or freedom, [column], value)."""

    rows: tuple[Index, Index, Index, Array]
    stiffness: tuple[Index, Index, Array]
    damping: tuple[Index, Index, Array]
    inertia: tuple[Index, Index, Array]


def numerators(
    model: LinearBrake,
    names: Sequence[str],
    values: Mapping[str, float] | None,
    eigenvalues: Complex,
    left: Complex,
    right: Complex,
) -> Complex:
    """w^T (l^2 dM + l dD + dK) v for each quantity and eigenvalue, (q, m).

    Parameters
    ----------
    names : quantities of the model
    values : other values than the file's, at which eigenvalues and vectors were found
    eigenvalues, left, right : (m,), (n_dof, m), (n_dof, m)

    Raises
    ------
    KeyError, ValueError
        as `LinearModel.matrices`
    """
    values = values or {}
    structure, lines = model.brake.structure, model.lines(values)
    at = {name: values.get(name, model.quantities[name].value) for name in (MU, SLOPE, PRESSURE, AREA)}
    parameters = np.array([values.get(name, model.quantities[name].value) for name in structure.parameters])
    places = structure.formulas.values(parameters)
    own_places, own_parameters = set(structure.places), set(structure.parameters)
    given = [structure.place_index(name) for name in values if name in own_places]
    places[given] = [value for name, value in values.items() if name in own_places]
    by_place, by_mu, by_kn = _by_places(structure, lines, places, at, eigenvalues, left, right)
    factors = {SLOPE: at[SLOPE], PRESSURE: at[PRESSURE] * PA_PER_BAR, AREA: at[AREA]}
    found = np.empty((len(names), eigenvalues.size), dtype=complex)
    own: list[tuple[int, Array]] = []
    for number, name in enumerate(names):
        if name == MU:
            found[number] = by_mu
        elif name in factors:  # d(k p A) by one of the three
            rate = PA_PER_BAR if name == PRESSURE else 1.0
            found[number] = (
                by_kn * rate * float(np.prod([f for other, f in factors.items() if other != name]))
            )
        elif name in own_parameters:
            gradient = structure.formulas.gradient(parameters, name)
            gradient[given] = 0.0
            own.append((number, gradient))
        else:
            found[number] = by_place[structure.place_index(name)]
    if own:
        chain = np.stack([gradient for _, gradient in own]) @ by_place.view(float)
        found[[number for number, _ in own]] = chain.view(complex)
    return found


def _by_places(
    structure: Structure,
    lines: Lines,
    places: Array,
    at: Mapping[str, float],
    eigenvalues: Complex,
    left: Complex,
    right: Complex,
) -> tuple[Complex, Complex, Complex]:
    """Change of w^T Q v by every place (n_places, m), by mu (m,), by k N (m,)."""
    a, b = lines.rows @ left, lines.rows @ right
    weight = lines.stiffness[:, None] + eigenvalues * lines.damping[:, None]
    x, y = (np.array([c[i] for c in structure.contacts], dtype=int) for i in (0, 1))
    side, share = (np.array([c[i] for c in structure.contacts], dtype=float)[:, None] for i in (2, 3))
    falling = at[SLOPE] * at[PRESSURE] * PA_PER_BAR * at[AREA]  # k N (eq 31)
    sliding, slipping = -side * at[MU], -share * falling * eigenvalues
    by_a, by_b = weight * b, weight * a  # derivatives of w^T Q v by r.w and r.v of each line
    by_a[x] += sliding * weight[y] * b[y] + slipping * b[x]
    by_b[y] += sliding * weight[y] * a[x]
    by_b[x] += slipping * a[x]
    by_stiffness = a * b
    by_stiffness[y] += sliding * a[x] * b[y]
    entries = _fixed_entries(structure) if not _has_angles(structure) else _entries(structure, places)
    found = np.zeros((len(structure.places), eigenvalues.size), dtype=complex)
    place, line, column, value = entries.rows
    np.add.at(found, place, value[:, None] * (left[column] * by_a[line] + right[column] * by_b[line]))
    place, line, value = entries.stiffness
    np.add.at(found, place, value[:, None] * by_stiffness[line])
    place, line, value = entries.damping
    np.add.at(found, place, value[:, None] * eigenvalues * by_stiffness[line])
    place, freedom, value = entries.inertia
    np.add.at(found, place, value[:, None] * eigenvalues**2 * left[freedom] * right[freedom])
    by_mu = np.sum(-side * weight[y] * a[x] * b[y], axis=0)
    return found, by_mu, np.sum(-share * eigenvalues * a[x] * b[x], axis=0)


def _has_angles(structure: Structure) -> bool:
    """Whether axes of elements are turned: then the derivatives of lines depend on the values."""
    return any(place.endswith(".angle") for place in structure.places)


@lru_cache(maxsize=32)
def _fixed_entries(structure: Structure) -> _Entries:
    return _entries(structure, np.zeros(len(structure.places)))


def _entries(structure: Structure, places: Array) -> _Entries:
    units = np.eye(len(structure.places))
    changes = [structure.line_derivatives(places, unit) for unit in units]
    rows = np.stack([change.rows for change in changes])
    place, line, column = np.nonzero(rows)

    def listed(values: Array) -> tuple[Index, Index, Array]:
        first, second = np.nonzero(values)
        return first, second, values[first, second]

    return _Entries(
        (place, line, column, rows[place, line, column]),
        listed(np.stack([change.stiffness for change in changes])),
        listed(np.stack([change.damping for change in changes])),
        listed(np.stack([change.inertia for change in changes])),
    )

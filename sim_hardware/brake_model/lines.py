"""Coupling lines: what the coupling tables g and h come to, as arrays over the places of a brake file.

A coupling element between two points is two lines (along its axes x and y), a torsion is one. A line's row
gives the relative displacement per degree of freedom (eqs 8-10). Geometry enters linearly through the lever
arms, then the axes of an element may be turned. One structure, any parameter values: matrices, their
derivatives and the coupling forces all come from here. NOT its job: reading files, matrices.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.formulas import Formulas
from sim_hardware.brake_model.spec import BrakeSpec, Contact, Spring, place_name

Array = NDArray[np.float64]

_FREEDOMS = ("x", "y", "phi")
_NONE = -1


@dataclass(frozen=True, slots=True)
class Lines:
    """Lines with numbers, or the derivatives of those numbers.

    Attributes
    ----------
    rows : (n_lines, n_dof) relative displacement per degree of freedom
    stiffness, damping : (n_lines,) N/m or N m/rad, N s/m or N m s/rad
    inertia : (n_dof,) kg or kg m2
    """

    rows: Array
    stiffness: Array
    damping: Array
    inertia: Array


class Structure:
    """Topology of a brake: which place of the file enters which line. Immutable.

    Attributes
    ----------
    freedoms : "body.x", "body.y", "body.phi", in the order of all vectors
    parameters : names in the order of parameter vectors
    formulas : all expressions of the file
    places : short names of the places, "piston_l.stiffness_y", "inner_pad.piston_l.x", "disc.mass"
    units, signs : unit of each place and what its sign must be
    contacts : (line along x, line along y, side, load share) of each friction contact
    """

    def __init__(self, spec: BrakeSpec) -> None:
        self.freedoms = tuple(
            f"{body.name}.{f}" for body in spec.bodies for f in _FREEDOMS if f in body.freedoms
        )
        self._dof = {name: i for i, name in enumerate(self.freedoms)}
        uses = {place_name(place): (text, sign, unit) for place, text, sign, unit in spec.uses()}
        self.parameters = tuple(spec.parameters)
        self.formulas = Formulas({place: text for place, (text, _, _) in uses.items()}, self.parameters)
        self.places = self.formulas.places
        self.signs = tuple(sign for _, sign, _ in uses.values())
        self.units = tuple(unit for _, _, unit in uses.values())
        self._place = {place: i for i, place in enumerate(self.places)}
        self.n_couplings = len(spec.couplings)
        count = 2 * len(spec.couplings) + len(spec.torsions)
        self._base = np.zeros((count, len(self.freedoms)))
        self._arms: list[tuple[int, int, int, float]] = []  # line, column, place, sign
        self._turned: list[tuple[int, int]] = []  # first line of the element, place of the angle
        self._stiffness = np.full(count, _NONE)
        self._damping = np.full(count, _NONE)
        self.contacts: tuple[tuple[int, int, int, float], ...] = ()
        for number, coupling in enumerate(spec.couplings):
            self._add_coupling(2 * number, coupling)
        for number, torsion in enumerate(spec.torsions):
            line = 2 * len(spec.couplings) + number
            for body, sign in zip(torsion.between, (1.0, -1.0), strict=True):
                self._add_freedom(line, body, "phi", sign)
            self._stiffness[line] = self._place[f"{torsion.name}.stiffness"]
            self._damping[line] = self._place.get(f"{torsion.name}.damping", _NONE)
        keys = {"x": "mass", "y": "mass", "phi": "inertia"}
        pairs = (name.rsplit(".", 1) for name in self.freedoms)
        self._inertia = np.array([self._place[f"{body}.{keys[f]}"] for body, f in pairs], dtype=int)
        self._arm_table = (
            tuple(np.array(column) for column in zip(*self._arms, strict=True))
            or (np.zeros(0, dtype=int),) * 4
        )

    def place_index(self, name: str) -> int:
        """Index of a place by its short name.

        Raises
        ------
        KeyError
            unknown place
        """
        return self._place[name]

    def lines(self, places: Array) -> Lines:
        """Lines with numbers from the values of all places, (n_places,)."""
        rows = self._raw_rows(places)
        for line, place in self._turned:
            rows[line : line + 2] = _turn(places[place]) @ rows[line : line + 2]
        return Lines(
            rows, _pick(places, self._stiffness), _pick(places, self._damping), places[self._inertia]
        )

    def line_derivatives(self, places: Array, gradient: Array) -> Lines:
        """Derivatives of all numbers along a direction of the places, (n_places,) per unit."""
        rows = self._add_arms(np.zeros_like(self._base), gradient)
        if self._turned:
            straight = self._raw_rows(places)
            for line, place in self._turned:
                pair = slice(line, line + 2)
                angle = places[place]
                rows[pair] = _turn(angle) @ rows[pair] + gradient[place] * _turn_rate(angle) @ straight[pair]
        return Lines(
            rows, _pick(gradient, self._stiffness), _pick(gradient, self._damping), gradient[self._inertia]
        )

    def _raw_rows(self, places: Array) -> Array:
        return self._add_arms(self._base.copy(), places)

    def _add_arms(self, rows: Array, places: Array) -> Array:
        line, column, place, sign = self._arm_table
        np.add.at(rows, (line, column), sign * places[place])
        return rows

    def _add_freedom(self, line: int, body: str, freedom: str, sign: float) -> None:
        column = self._dof.get(f"{body}.{freedom}")
        if column is not None:
            self._base[line, column] += sign

    def _add_coupling(self, line: int, coupling: Spring | Contact) -> None:
        name = coupling.name
        for point, sign in zip(coupling.between, (1.0, -1.0), strict=True):
            body = point.split(".", maxsplit=1)[0]
            self._add_freedom(line, body, "x", sign)
            self._add_freedom(line + 1, body, "y", sign)
            column = self._dof.get(f"{body}.phi")
            if column is not None:  # u = (x - phi ry, y + phi rx) (eq 10)
                self._arms.append((line, column, self._place[f"{point}.y"], -sign))
                self._arms.append((line + 1, column, self._place[f"{point}.x"], sign))
        if isinstance(coupling, Contact):
            self.contacts += ((line, line + 1, coupling.side, coupling.load_share),)
            self._stiffness[line + 1] = self._place[f"{name}.stiffness"]
            self._damping[line + 1] = self._place.get(f"{name}.damping", _NONE)
            return
        for axis, offset in (("x", 0), ("y", 1)):
            self._stiffness[line + offset] = self._place.get(f"{name}.stiffness_{axis}", _NONE)
            self._damping[line + offset] = self._place.get(f"{name}.damping_{axis}", _NONE)
        if f"{name}.angle" in self._place:
            self._turned.append((line, self._place[f"{name}.angle"]))


def _pick(places: Array, index: NDArray[np.int_]) -> Array:
    return np.where(index == _NONE, 0.0, places[index])


def _turn(angle: float) -> Array:
    """Relative displacement along axes turned by an angle (rad) from x towards y."""
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def _turn_rate(angle: float) -> Array:
    return np.array([[-np.sin(angle), np.cos(angle)], [-np.cos(angle), -np.sin(angle)]])

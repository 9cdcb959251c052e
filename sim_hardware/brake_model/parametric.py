"""The brake as a `LinearModel`: M, D, K and their exact derivatives by every quantity of its file.

Quantities: operating values (mu, slope, pressure, piston_area), parameters of the file ("c_con_il"), and
places of its expressions ("piston_l.stiffness_y"), which may be changed one by one where parameters are
shared. A place that is given overrides what the parameters would give.
NOT its job: studies, forces, reading files.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from types import MappingProxyType

import numpy as np

from sim_hardware.brake_model.assembly import Brake, LinearParts, linear_parts
from sim_hardware.brake_model.linear import (
    MU,
    PRESSURE,
    SLOPE,
    Array,
    Kind,
    Matrices,
    NamedQuantity,
    ParameterGroup,
    unknown_quantity,
)
from sim_hardware.brake_model.lines import Lines

PA_PER_BAR = 1e5
AREA = "piston_area"
_OPERATING = (MU, SLOPE, PRESSURE, AREA)
_KINDS: dict[str, Kind] = {
    "N/m": "stiffness", "N m/rad": "stiffness", "N s/m": "damping", "N m s/rad": "damping",
    "kg": "inertia", "kg m2": "inertia", "m": "geometry", "rad": "geometry",
}  # fmt: skip


class LinearBrake:
    """A brake whose matrices are functions of named quantities. Immutable; see `linear.LinearModel`."""

    def __init__(self, brake: Brake) -> None:
        self.brake = brake
        self._structure = brake.structure
        self._nominal = np.array([p.value for p in brake.spec.parameters.values()])
        self._column = {name: i for i, name in enumerate(self._structure.parameters)}
        self._positive = np.array([sign == "positive" for sign in self._structure.signs])
        self._not_negative = self._positive | np.array([s == "not negative" for s in self._structure.signs])

    @property
    def name(self) -> str:
        """Name of the brake."""
        return self.brake.name

    @property
    def freedoms(self) -> tuple[str, ...]:
        """Names of the degrees of freedom."""
        return self.brake.freedoms

    @property
    def quantities(self) -> Mapping[str, NamedQuantity]:
        """Operating values, parameters and places by name."""
        return self._quantities

    @property
    def groups(self) -> tuple[ParameterGroup, ...]:
        """Parameter groups of the brake file."""
        return self._groups

    @cached_property
    def _quantities(self) -> Mapping[str, NamedQuantity]:
        brake, structure = self.brake, self._structure
        found = [
            NamedQuantity(MU, brake.mu, "1", "operating"),
            NamedQuantity(SLOPE, brake.slope_s_m, "s/m", "operating"),
            NamedQuantity(PRESSURE, 0.0, "bar", "operating"),
            NamedQuantity(AREA, brake.piston_area_m2, "m2", "operating"),
        ]
        found += [
            NamedQuantity(name, p.value, p.unit, _KINDS.get(p.unit, "other"))
            for name, p in brake.spec.parameters.items()
        ]
        nominal = structure.formulas.values(self._nominal)
        found += [
            NamedQuantity(place, float(value), unit, _KINDS.get(unit, "other"))
            for place, value, unit in zip(structure.places, nominal, structure.units, strict=True)
        ]
        return MappingProxyType({quantity.name: quantity for quantity in found})

    @cached_property
    def _groups(self) -> tuple[ParameterGroup, ...]:
        return tuple(
            ParameterGroup(
                g.name,
                g.title,
                self.quantities[(*g.leading, *g.trailing, *g.both)[0]].kind,
                g.leading,
                g.trailing,
                g.both,
            )
            for g in self.brake.spec.groups
        )

    def matrices(self, values: Mapping[str, float] | None = None) -> Matrices:
        """M, D, K with other values for some quantities (SI; pressure in bar). See `LinearModel.matrices`."""
        operating, _, places, _ = self._evaluated(values)
        parts = linear_parts(self._structure, self._structure.lines(places))
        return Matrices(np.diag(parts.inertia), *_combine(parts, operating))

    def derivative(self, name: str, values: Mapping[str, float] | None = None) -> Matrices:
        """Derivatives of M, D, K by one quantity, per unit of it. See `LinearModel.derivative`."""
        operating, parameters, places, given = self._evaluated(values)
        structure = self._structure
        if name in _OPERATING:
            parts = linear_parts(structure, structure.lines(places))
            return _operating_derivative(parts, operating, name)
        if name in self._column:
            gradient = structure.formulas.gradient(parameters, name)
            gradient[given] = 0.0
        elif name in structure.places:
            gradient = np.zeros(len(structure.places))
            gradient[structure.place_index(name)] = 1.0
        else:
            raise unknown_quantity(self.name, name, self.quantities)
        lines = structure.lines(places)
        change = linear_parts(structure, lines, structure.line_derivatives(places, gradient))
        return Matrices(np.diag(change.inertia), *_combine(change, operating))

    def lines(self, values: Mapping[str, float] | None = None) -> Lines:
        """Coupling lines with other values for some quantities."""
        return self._structure.lines(self._evaluated(values)[2])

    def _evaluated(
        self, values: Mapping[str, float] | None
    ) -> tuple[dict[str, float], Array, Array, list[int]]:
        """Operating values, parameters, places, and which places were given."""
        brake = self.brake
        operating = {MU: brake.mu, SLOPE: brake.slope_s_m, PRESSURE: 0.0, AREA: brake.piston_area_m2}
        parameters = self._nominal
        overrides: list[tuple[int, float]] = []
        for name, value in (values or {}).items():
            if not np.isfinite(value):
                raise ValueError(f"{name} = {value!r}: give a finite number")
            if name in operating:
                if value < 0.0 or (name == AREA and value == 0.0):
                    raise ValueError(f"{name} = {value:g}: give a value that is not negative")
                operating[name] = float(value)
            elif name in self._column:
                if parameters is self._nominal:
                    parameters = self._nominal.copy()
                parameters[self._column[name]] = value
            elif name in self._structure.places:
                overrides.append((self._structure.place_index(name), float(value)))
            else:
                raise unknown_quantity(self.name, name, self.quantities)
        places = self._structure.formulas.values(parameters)
        given = [index for index, _ in overrides]
        for index, value in overrides:
            places[index] = value
        self._check(places)
        return operating, parameters, places, given

    def _check(self, places: Array) -> None:
        wrong = (self._positive & ~(places > 0.0)) | (self._not_negative & ~(places >= 0.0))
        if wrong.any():
            index = int(np.flatnonzero(wrong)[0])
            raise ValueError(
                f"{self._structure.places[index]} = {places[index]:g} {self._structure.units[index]}: "
                f"must be {self._structure.signs[index]}; change it less"
            )


def _combine(parts: LinearParts, operating: Mapping[str, float]) -> tuple[Array, Array]:
    """D and K at an operating point."""
    falling = operating[SLOPE] * operating[PRESSURE] * PA_PER_BAR * operating[AREA]  # k N (eq 31)
    return (
        parts.damping + operating[MU] * parts.damping_mu + falling * parts.damping_kn,
        parts.stiffness + operating[MU] * parts.stiffness_mu,
    )


def _operating_derivative(parts: LinearParts, operating: Mapping[str, float], name: str) -> Matrices:
    zero = np.zeros_like(parts.stiffness)
    if name == MU:
        return Matrices(zero, parts.damping_mu, parts.stiffness_mu)
    factors = {SLOPE: operating[SLOPE], PRESSURE: operating[PRESSURE] * PA_PER_BAR, AREA: operating[AREA]}
    rate = PA_PER_BAR if name == PRESSURE else 1.0
    for other, factor in factors.items():
        rate *= 1.0 if other == name else factor
    return Matrices(zero, rate * parts.damping_kn, zero)

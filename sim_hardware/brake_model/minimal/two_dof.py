"""The 2-DOF model with nonconservative restoring forces (eq 1; Table 1 right): a pad that moves and tilts.

    M = diag(m, J), D = diag(d1, d2),
    C = [[c1 + c3, -c3 s], [(mu h - s) c3, (s - mu h) c3 s + c2]]

The contact spring c3 acts at the distance s beside the centre of mass, friction at the height h: it makes C
unsymmetric. A `LinearModel`, so that every linear study takes it. NOT its job: boundaries (`hurwitz`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from sim_hardware.brake_model.linear import (
    MU,
    Kind,
    Matrices,
    NamedQuantity,
    ParameterGroup,
    unknown_quantity,
)
from sim_hardware.brake_model.minimal.hurwitz import TwoFreedoms

_QUANTITIES: dict[str, tuple[str, Kind]] = {
    "mass": ("kg", "inertia"),
    "inertia": ("kg m2", "inertia"),
    "d1": ("N s/m", "damping"),
    "d2": ("N m s", "damping"),
    "c1": ("N/m", "stiffness"),
    "c2": ("N m", "stiffness"),
    "c3": ("N/m", "stiffness"),
    "s": ("m", "geometry"),
    "h": ("m", "geometry"),
    MU: ("", "operating"),
}
_STEP = 1e-30


class TwoDofModel(BaseModel):
    """Parameters of eq 1, SI. Negative mu: the disc turns the other way."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    mass: Annotated[float, Field(gt=0.0)]
    inertia: Annotated[float, Field(gt=0.0)]
    d1: Annotated[float, Field(ge=0.0)]
    d2: Annotated[float, Field(ge=0.0)]
    c1: Annotated[float, Field(ge=0.0)]
    c2: Annotated[float, Field(ge=0.0)]
    c3: Annotated[float, Field(ge=0.0)]
    s: float
    h: float
    mu: float = 0.0

    @property
    def name(self) -> str:
        """Name of the model."""
        return "two-dof"

    @property
    def freedoms(self) -> tuple[str, ...]:
        """x and phi."""
        return "pad.x", "pad.phi"

    @property
    def quantities(self) -> Mapping[str, NamedQuantity]:
        """All parameters."""
        return {n: NamedQuantity(n, float(getattr(self, n)), *_QUANTITIES[n]) for n in _QUANTITIES}

    @property
    def groups(self) -> tuple[ParameterGroup, ...]:
        """None: too small a model."""
        return ()

    def matrices(self, values: Mapping[str, float] | None = None) -> Matrices:
        """M, D, K with other values for some quantities (eq 1).

        Raises
        ------
        KeyError
            unknown quantity
        pydantic.ValidationError (a ValueError)
            a value out of its bounds
        """
        model = self._changed(values)
        return Matrices(*(np.real(m) for m in _matrices({n: getattr(model, n) for n in _QUANTITIES})))

    def derivative(self, name: str, values: Mapping[str, float] | None = None) -> Matrices:
        """Derivatives of M, D, K by one quantity: the imaginary part at value + i 1e-30, exact for
        polynomials.

        Raises
        ------
        KeyError, ValueError
            as `matrices`
        """
        if name not in _QUANTITIES:
            raise unknown_quantity(self.name, name, self.quantities)
        model = self._changed(values)
        numbers: dict[str, Any] = {n: getattr(model, n) for n in _QUANTITIES}
        numbers[name] += 1j * _STEP
        return Matrices(*(np.imag(m) / _STEP for m in _matrices(numbers)))

    @property
    def system(self) -> TwoFreedoms:
        """The same with mu left open."""
        base, slope = self.matrices({MU: 0.0}), self.derivative(MU)
        return TwoFreedoms(base.mass, base.damping, slope.damping, base.stiffness, slope.stiffness)

    @property
    def divergence_mu(self) -> float:
        """The expression printed in Table 1: s/h + c2/(h s c3) + c2/(h s c1). It is det C < 0: divergence.

        inf where friction does not enter det C (h, s, c1 or c3 is 0).
        """
        if self.h * self.s * self.c1 * self.c3 == 0.0:
            return math.inf
        return self.s / self.h + self.c2 / (self.h * self.s * self.c3) + self.c2 / (self.h * self.s * self.c1)

    def _changed(self, values: Mapping[str, float] | None) -> TwoDofModel:
        if not values:
            return self
        for name in values:
            if name not in _QUANTITIES:
                raise unknown_quantity(self.name, name, self.quantities)
        return TwoDofModel.model_validate(self.model_dump() | dict(values))


def _matrices(p: Mapping[str, Any]) -> tuple[Any, Any, Any]:
    lever = p["mu"] * p["h"] - p["s"]
    stiffness = [  # eq 1
        [p["c1"] + p["c3"], -p["c3"] * p["s"]],
        [lever * p["c3"], -lever * p["c3"] * p["s"] + p["c2"]],
    ]
    return (
        np.diag(np.array([p["mass"], p["inertia"]], dtype=complex)),
        np.diag(np.array([p["d1"], p["d2"]], dtype=complex)),
        np.array(stiffness, dtype=complex),
    )

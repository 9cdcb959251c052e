"""What a study moves along: one quantity, or quantities changed together by a common share.

Job: a number t as values of a model, and the exact derivatives of M, D, K by t. NOT its job: any study, the
design modifications themselves (`variations`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from sim_hardware.brake_model.design.variations import MODES, Variation, variation
from sim_hardware.brake_model.linear import LinearModel, Matrices, ParameterGroup, known, value_of

_STEP = 0.5
Moved = "str | ParameterGroup | Variation | Direction"


@dataclass(frozen=True, slots=True)
class Direction:
    """A way through the values of a model.

    Attributes
    ----------
    name, unit : of the number t; for several quantities t is the relative change, unit "1"
    rates : quantity -> relative change per unit of t; empty where t is the value of the quantity `name`
        itself
    """

    name: str
    unit: str
    rates: Mapping[str, float] = field(default_factory=dict, hash=False)

    @property
    def single(self) -> bool:
        """Whether t is the value of one quantity."""
        return not self.rates

    def values(
        self, model: LinearModel, t: float, base: Mapping[str, float] | None = None
    ) -> dict[str, float]:
        """Values of the model at t; `base`: other values, from which relative changes count too."""
        if self.single:
            return {**(base or {}), self.name: float(t)}
        changed = {
            name: value_of(model, name, base) * (1.0 + rate * float(t)) for name, rate in self.rates.items()
        }
        return {**(base or {}), **changed}

    def start(self, model: LinearModel, base: Mapping[str, float] | None = None) -> float:
        """The t of the model as it is: the quantity's value, or 0."""
        return value_of(model, self.name, base) if self.single else 0.0

    def derivative(self, model: LinearModel, t: float, base: Mapping[str, float] | None = None) -> Matrices:
        """dM/dt, dD/dt, dK/dt at t, dense and exact."""
        values = self.values(model, t, base)
        if self.single:
            return model.derivative(self.name, values).dense()
        parts = [
            (value_of(model, name, base) * rate, model.derivative(name, values).dense())
            for name, rate in self.rates.items()
        ]
        return Matrices(
            *(
                np.sum([rate * getattr(d, key) for rate, d in parts], axis=0)
                for key in ("mass", "damping", "stiffness")
            )
        )


def direction(model: LinearModel, moved: str | ParameterGroup | Variation | Direction) -> Direction:
    """The direction that `moved` names.

    Parameters
    ----------
    moved : a quantity; a group or its name, moved as a whole by the share t; "group:clockwise" (or another
        mode of `variations`): leading up, trailing down by the share t; a `Variation`: t = 1 is the variation
        as it is

    Raises
    ------
    KeyError
        neither a quantity nor a group of the model
    ValueError
        the group has no sides for that mode
    """
    if isinstance(moved, Direction):
        return moved
    if isinstance(moved, Variation):
        return Direction(moved.name, "1", {name: factor - 1.0 for name, factor in moved.factors.items()})
    if isinstance(moved, ParameterGroup):
        return Direction(moved.name, "1", dict.fromkeys(moved.members, 1.0))
    if moved in model.quantities:
        return Direction(moved, model.quantities[moved].unit)
    name, _, mode = moved.partition(":")
    for group in model.groups:
        if group.name == name and not mode:
            return direction(model, group)
        if group.name == name and mode in MODES:
            factors = variation(group, mode, _STEP).factors  # pyright: ignore[reportArgumentType]
            return Direction(moved, "1", {member: (f - 1.0) / _STEP for member, f in factors.items()})
    known(model, moved)  # raises, with near names
    raise AssertionError

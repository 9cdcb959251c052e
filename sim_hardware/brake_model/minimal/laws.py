"""Friction laws of the belt oscillator as data: coefficient of friction over the sliding speed.

Job: Coulomb, linear falling (eq 28), exponential, and two laws of published 1-DOF studies (hyperbolic,
cubic). NOT its job: the laws of the 14-DOF plant, written around a working point (`brake_model.friction`).

In all of them the mass sticks as long as |force| <= mu_static F_n.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

Array = NDArray[np.float64]
Mu = Annotated[float, Field(ge=0.0, le=10.0)]


class _Law(BaseModel):
    """What all laws have. `sliding` and `slope` take a sliding speed |v| >= 0 in m/s."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    mu_static: Mu

    @property
    def affine(self) -> tuple[float, float] | None:
        """(a, b) where mu = a + b |v| while sliding: then the motion has a closed solution. Otherwise
        None."""
        return None

    def sliding(self, speed_m_s: float) -> float:
        """Coefficient of friction while sliding; smooth beyond speed 0, so that events can be bracketed."""
        raise NotImplementedError

    def slope(self, speed_m_s: float) -> float:
        """d mu / d|v| while sliding (s/m)."""
        raise NotImplementedError

    def curve(self, speeds_m_s: ArrayLike) -> Array:
        """Coefficient of friction at several sliding speeds of any sign, same shape."""
        speeds = np.abs(np.asarray(speeds_m_s, dtype=float))
        return np.vectorize(self.sliding, otypes=[float])(speeds)

    @property
    def zero_speed_m_s(self) -> float:
        """Speed beyond which the formula gives a negative mu (no friction law any more); inf where never."""
        return math.inf


class CoulombLaw(_Law):
    """mu_static at rest, a lower constant mu_dynamic while sliding."""

    law: Literal["coulomb"] = "coulomb"
    mu_dynamic: Mu

    @model_validator(mode="after")
    def _static_is_larger(self) -> Self:
        if self.mu_dynamic > self.mu_static:
            raise PydanticCustomError(
                "mu_order",
                "mu_dynamic = {mu_dynamic} is larger than mu_static = {mu_static}",
                {
                    "mu_dynamic": self.mu_dynamic,
                    "mu_static": self.mu_static,
                    "remedy": "Give mu_static of at least mu_dynamic.",
                },
            )
        return self

    @property
    def affine(self) -> tuple[float, float]:
        """Constant."""
        return self.mu_dynamic, 0.0

    def sliding(self, speed_m_s: float) -> float:
        """mu_dynamic."""
        return self.mu_dynamic

    def slope(self, speed_m_s: float) -> float:
        """0."""
        return 0.0


class LinearFallingLaw(_Law):
    """mu_0 - k |v| (eq 28), mu_0 = mu_static. Taken literally: negative beyond `zero_speed_m_s`."""

    law: Literal["linear"] = "linear"
    slope_s_m: Annotated[float, Field(ge=0.0, le=1e3)]

    @property
    def affine(self) -> tuple[float, float]:
        """(mu_0, -k)."""
        return self.mu_static, -self.slope_s_m

    def sliding(self, speed_m_s: float) -> float:
        """Eq 28."""
        return self.mu_static - self.slope_s_m * speed_m_s

    def slope(self, speed_m_s: float) -> float:
        """-k."""
        return -self.slope_s_m

    @property
    def zero_speed_m_s(self) -> float:
        """mu_0 / k."""
        return self.mu_static / self.slope_s_m if self.slope_s_m > 0.0 else math.inf


class ExponentialLaw(_Law):
    """mu_d + (mu_s - mu_d) exp(-|v| / v_scale) + mu_v |v| (Stribeck)."""

    law: Literal["exponential"] = "exponential"
    mu_dynamic: Mu
    speed_scale_m_s: Annotated[float, Field(gt=0.0)]
    viscous_s_m: Annotated[float, Field(ge=0.0, le=1e3)] = 0.0

    @property
    def affine(self) -> tuple[float, float] | None:
        """Closed where the exponential part vanishes."""
        return (self.mu_dynamic, self.viscous_s_m) if self.mu_static == self.mu_dynamic else None

    def sliding(self, speed_m_s: float) -> float:
        """The formula of the class."""
        fading = (self.mu_static - self.mu_dynamic) * math.exp(-speed_m_s / self.speed_scale_m_s)
        return self.mu_dynamic + fading + self.viscous_s_m * speed_m_s

    def slope(self, speed_m_s: float) -> float:
        """Derivative of the formula."""
        drop = (self.mu_static - self.mu_dynamic) / self.speed_scale_m_s
        return self.viscous_s_m - drop * math.exp(-speed_m_s / self.speed_scale_m_s)


class HyperbolicLaw(_Law):
    """mu_s / (1 + |v| / v_scale): the law of several published stick-slip studies."""

    law: Literal["hyperbolic"] = "hyperbolic"
    speed_scale_m_s: Annotated[float, Field(gt=0.0)]

    def sliding(self, speed_m_s: float) -> float:
        """The formula of the class."""
        return self.mu_static / (1.0 + speed_m_s / self.speed_scale_m_s)

    def slope(self, speed_m_s: float) -> float:
        """Derivative of the formula."""
        return -self.mu_static / self.speed_scale_m_s / (1.0 + speed_m_s / self.speed_scale_m_s) ** 2


class CubicLaw(_Law):
    """Falls from mu_s to mu_m at v_m, then rises: mu_s - 1.5 (mu_s - mu_m) (v/v_m - (v/v_m)^3 / 3)."""

    law: Literal["cubic"] = "cubic"
    mu_minimum: Mu
    speed_scale_m_s: Annotated[float, Field(gt=0.0, description="v_m, speed of the smallest friction")]

    def sliding(self, speed_m_s: float) -> float:
        """The formula of the class."""
        r = speed_m_s / self.speed_scale_m_s
        return self.mu_static - 1.5 * (self.mu_static - self.mu_minimum) * (r - r**3 / 3.0)

    def slope(self, speed_m_s: float) -> float:
        """Derivative of the formula."""
        r = speed_m_s / self.speed_scale_m_s
        return -1.5 * (self.mu_static - self.mu_minimum) / self.speed_scale_m_s * (1.0 - r**2)


BeltLaw = Annotated[
    CoulombLaw | LinearFallingLaw | ExponentialLaw | HyperbolicLaw | CubicLaw, Field(discriminator="law")
]

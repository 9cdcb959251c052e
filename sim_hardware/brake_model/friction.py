"""Friction laws as data: coefficient of friction over the sliding speed, with set-valued sticking.

All laws are one formula around the working point (mu_mean at the sliding speed v_mean):

    mu(v) = mu_mean - k (v - v_mean) / sqrt(1 + ((v - v_mean) / v_s)^2)

constant: k = 0; linear falling (eq 28): v_s infinite; saturating: slope -k at the working point, so that the
onset of squeal is that of the linear law, fading once the speed varies by more than v_s, so that the limit
cycle stays small. The friction force opposes sliding: F = mu(|v|) N sgn(v) towards +x on the pad, and any
value within +-mu(0) N at v = 0. NOT its job: where k and mu come from (the plant's friction map), time
integration.
"""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import BaseModel, ConfigDict, Field


class _Law(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    mu_mean: Annotated[float, Field(ge=0.0, le=2.0)]

    @property
    def slope_s_m(self) -> float:
        """Falling slope k at the working point (s/m)."""
        return 0.0

    @property
    def inverse_saturation_s_m(self) -> float:
        """1 / v_s (s/m); 0 for a law that does not saturate."""
        return 0.0

    def mu(self, speed_m_s: ArrayLike, mean_speed_m_s: float) -> NDArray[np.float64]:
        """Coefficient of friction while sliding at `speed_m_s` (any sign), working point at
        `mean_speed_m_s`."""
        x = np.abs(np.asarray(speed_m_s, dtype=float)) - mean_speed_m_s
        return self.mu_mean - self.slope_s_m * x / np.sqrt(1.0 + (x * self.inverse_saturation_s_m) ** 2)

    def holding_mu(self, mean_speed_m_s: float) -> float:
        """Largest coefficient of friction that sticking can hold: the limit of mu(v) at v = 0."""
        return float(self.mu(0.0, mean_speed_m_s))


class ConstantFriction(_Law):
    """Coulomb: mu does not depend on speed."""

    law: Literal["constant"] = "constant"


class LinearFriction(_Law):
    """Linear falling friction (eq 28)."""

    law: Literal["linear"] = "linear"
    k_s_m: Annotated[float, Field(ge=0.0, le=10.0)]

    @property
    def slope_s_m(self) -> float:
        """Falling slope k (s/m)."""
        return self.k_s_m


class SaturatingFriction(LinearFriction):
    """Falling friction whose slope fades with the size of the speed's variation."""

    law: Literal["saturating"] = "saturating"  # type: ignore[assignment]
    saturation_m_s: Annotated[float, Field(gt=0.0)]

    @property
    def inverse_saturation_s_m(self) -> float:
        """1 / v_s (s/m)."""
        return 1.0 / self.saturation_m_s


FrictionLaw = Annotated[ConstantFriction | LinearFriction | SaturatingFriction, Field(discriminator="law")]

"""What a rig can do, in the words of a program: the other side of the dry run.

Job: limits and coefficients as plain numbers, filled from the rig's configuration by whoever knows it. Not
the job: reading rig files (``rigctl.config``), guarding limits while the rig moves (``rigctl.safety``).
"""

from __future__ import annotations

import math
from typing import Annotated, Self

from pydantic import Field, model_validator

from sequences.fields import ChannelName, Data, refuse

Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]
WATTS_PER_NM_RPM = 2.0 * math.pi / 60.0


class ChannelCapability(Data):
    """A signal the rig delivers. ``is_sound``: it must not be recorded while the ventilator runs."""

    rate_hz: Positive
    bytes_per_sample: Annotated[int, Field(ge=1, le=16)] = 4
    is_sound: bool = False


class ThermalCoefficients(Data):
    """The disc as one thermal node: C dT/dt = P - G (T - Ta) - R ((T + 273.15)^4 - (Ta + 273.15)^4)."""

    heat_capacity_j_k: Positive
    still_w_k: Positive
    ventilated_w_k: Positive
    radiation_w_k4: NotNegative = 0.0
    disc_heat_share: Annotated[float, Field(gt=0, le=1)] = 1.0  # of the friction power, into the disc
    ambient_degc: float = 20.0


class RigCapabilities(Data):
    """Limits and estimates of one rig with one brake.

    Torque grows with the pressure above `dead_pressure_bar`: by `nominal_torque_nm_bar` as a rule (for heat
    and time), by `peak_torque_nm_bar` at the highest coefficient of friction (for the drive's limits).
    """

    min_pressure_bar: NotNegative = 0.0  # lowest pressure above zero that can be held
    max_pressure_bar: Positive
    max_pressure_rate_bar_s: Positive | None = None  # None: not known, not checked
    min_speed_rpm: Annotated[float, Field(le=0)] = 0.0  # below zero if the drive can reverse
    max_speed_rpm: Positive
    max_speed_rate_rpm_s: Positive
    max_torque_nm: Positive
    drive_power_kw: Positive
    dead_pressure_bar: NotNegative = 0.0
    nominal_torque_nm_bar: Positive
    peak_torque_nm_bar: Positive
    max_disc_temperature_degc: float
    conditioning_margin_k: Positive = 5.0  # above ambient: what the ventilator reaches in useful time
    conditioning_speed_rpm: Positive
    conditioning_pressure_bar: Positive
    start_s: NotNegative = 0.0  # from speed reached to pressure on
    release_s: NotNegative = 0.5  # from pressure off to free disc
    ventilator_settle_s: NotNegative = 0.0  # from ventilator off to quiet
    thermal: ThermalCoefficients
    channels: dict[ChannelName, ChannelCapability]

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.peak_torque_nm_bar < self.nominal_torque_nm_bar:
            raise refuse(
                "peak_below_nominal",
                "peak_torque_nm_bar = {value} is below the nominal {nominal}",
                "the highest coefficient of friction gives the peak; check the two values",
                self.peak_torque_nm_bar,
                nominal=self.nominal_torque_nm_bar,
            )
        return self

    @property
    def min_conditioning_degc(self) -> float:
        """Lowest start temperature that cooling reaches."""
        return self.thermal.ambient_degc + self.conditioning_margin_k

    def nominal_torque_nm(self, pressure_bar: float) -> float:
        return self.nominal_torque_nm_bar * max(0.0, pressure_bar - self.dead_pressure_bar)

    def peak_torque_nm(self, pressure_bar: float) -> float:
        return self.peak_torque_nm_bar * max(0.0, pressure_bar - self.dead_pressure_bar)

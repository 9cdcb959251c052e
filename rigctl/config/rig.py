"""The rig file: which devices make up the rig, what it can do, and the geometry of the brake on it.

Job: frozen model of `configs/rigs/*.toml`. Settings of a device are passed to its class unread: the class
validates them. Not its job: the watchdog's limits (their own file, read by the watchdog itself) and the
physics of a simulated rig (`sim_hardware.plant`).
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from rigctl.core.units import PA_PER_BAR
from sequences.capabilities import RigCapabilities

Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]

LEAST_NET_BAR = 0.5  # below it torque over pressure is noise
ROLES = ("drive", "pressure", "ventilator", "acquisition", "safety")


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class DeviceConfig(BaseModel):
    """One device: its kind (see the registry) and the settings that its class reads."""

    model_config = ConfigDict(frozen=True, extra="allow", allow_inf_nan=False)
    kind: Annotated[str, Field(min_length=1)]

    @property
    def settings(self) -> dict[str, Any]:
        """Everything but the kind."""
        return dict(self.model_extra or {})


class BusConfig(BaseModel):
    """A field bus that several devices share: python-can's `interface` and its own keyword arguments."""

    model_config = ConfigDict(frozen=True, extra="allow", allow_inf_nan=False)
    interface: Annotated[str, Field(min_length=1)]

    @property
    def settings(self) -> dict[str, Any]:
        """All keyword arguments."""
        return {"interface": self.interface, **(self.model_extra or {})}


class Devices(_Frozen):
    """The five roles that every rig fills."""

    drive: DeviceConfig
    pressure: DeviceConfig
    ventilator: DeviceConfig
    acquisition: DeviceConfig
    safety: DeviceConfig


class ConditioningConfig(_Frozen):
    """How the disc is brought to a temperature; heating speed and pressure are among the capabilities."""

    cooling_speed_rpm: Positive
    soak_speed_rpm: Positive
    ventilator_m3_h: Positive
    idle_block_s: Annotated[float, Field(ge=0.05, le=1.0)] = 0.5


class FrictionConfig(_Frozen):
    """Geometry that turns torque and pressure into a coefficient of friction: mu = M / (2 (p - p0) A r)."""

    piston_area_m2: Annotated[float, Field(gt=0, le=0.1)]
    effective_radius_m: Annotated[float, Field(gt=0, le=1.0)]
    p0_bar: NotNegative = 0.5

    def mu(self, torque_nm: float, pressure_bar: float) -> float:
        """Momentary coefficient of friction; NaN where so little pressure is left that it is noise."""
        net_bar = pressure_bar - self.p0_bar
        if net_bar < LEAST_NET_BAR:
            return math.nan
        return torque_nm / (2.0 * net_bar * PA_PER_BAR * self.piston_area_m2 * self.effective_radius_m)


class PredictionConfig(_Frozen):
    """The engineer's model of the brake on the rig, for the comparison in the report."""

    brake: Path


class CalibrationsConfig(_Frozen):
    """Where the calibrations of the rig's sensors are kept; without it, in the data folder."""

    folder: Path


class SafetyConfig(_Frozen):
    """Where the watchdog finds its limits."""

    limits: Path


class RigConfig(_Frozen):
    """A rig file, validated. Relative paths in it start at the folder of the file."""

    name: Annotated[str, Field(min_length=1, max_length=120)]
    simulated: bool
    devices: Devices
    buses: dict[str, BusConfig] = Field(default_factory=dict[str, BusConfig])
    capabilities: RigCapabilities
    conditioning: ConditioningConfig
    friction: FrictionConfig
    safety: SafetyConfig
    prediction: PredictionConfig | None = None
    calibrations: CalibrationsConfig | None = None
    block_s: Annotated[float, Field(ge=0.01, le=0.5)] = 0.05
    steady_block_s: Annotated[float, Field(ge=0.01, le=0.5)] = 0.05
    """Virtual time: length of recorded blocks while the set-points do not change."""

"""Physical values of the simulated rig as frozen, validated data (`configs/plants/*.toml`).

Values are in the units that people use on a rig (bar, degC, 1/min); every key carries its unit. `layout`
turns them into SI for the kernels.
NOT its job: reading files (callers hand in a mapping), the brake's masses and stiffnesses
(`sim_hardware.brake_model`).
"""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

Positive = Annotated[float, Field(gt=0.0)]
NotNegative = Annotated[float, Field(ge=0.0)]
Share = Annotated[float, Field(ge=0.0, le=1.0)]
Level = Annotated[float, Field(ge=0.0, le=140.0)]
TICK_S = 1.0 / 4000.0
FULL_RATE_HZ = 4000.0


class _Section(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class DriveSettings(_Section):
    """Motor, its speed controller and everything that turns."""

    inertia_kg_m2: Positive
    max_torque_nm: Positive
    max_power_w: Positive
    speed_gain_nm_s_rad: Positive
    speed_reset_nm_rad: NotNegative
    torque_lag_s: Annotated[float, Field(ge=0.001, le=0.1)]
    quick_stop_rpm_per_s: Positive
    standstill_rpm: Annotated[float, Field(gt=0.0, le=2.0)]
    bearing_torque_nm: NotNegative
    bearing_viscous_nm_s_rad: NotNegative


class PressureSettings(_Section):
    """Pneumatic regulator, actuator and master cylinder, expressed as line pressure."""

    dead_time_s: Annotated[float, Field(ge=0.0, le=0.1)]
    time_constant_s: Annotated[float, Field(ge=0.02, le=1.0)]
    damping_ratio: Annotated[float, Field(ge=0.3, le=2.0)]
    release_slowdown: Annotated[float, Field(ge=1.0, le=4.0)]
    max_rate_bar_per_s: Positive
    max_pressure_bar: Annotated[float, Field(gt=0.0, le=200.0)]
    hysteresis_bar: Annotated[float, Field(ge=0.0, le=2.0)]
    compensating_port_bar: Positive
    ripple_bar: NotNegative
    ripple_half_bar: Positive
    vent_time_constant_s: Annotated[float, Field(ge=0.01, le=0.5)]
    vent_valve_lag_s: Annotated[float, Field(ge=0.002, le=0.1)]


class ThermalSettings(_Section):
    """Two-node disc (rub surface, bulk) and one node for both pads."""

    ambient_degc: Annotated[float, Field(ge=-40.0, le=60.0)]
    surface_capacity_j_k: Annotated[float, Field(ge=20.0)]
    bulk_capacity_j_k: Annotated[float, Field(ge=100.0)]
    pad_capacity_j_k: Annotated[float, Field(ge=50.0)]
    surface_bulk_w_k: Annotated[float, Field(gt=0.0, le=1000.0)]
    pad_disc_w_k: NotNegative
    pad_loss_w_k: NotNegative
    disc_heat_share: Share
    surface_loss_share: Share
    still_air_w_k: NotNegative
    rotation_w_k: NotNegative
    rotation_reference_rpm: Positive
    ventilator_w_k: NotNegative
    ventilator_max_m3_h: Positive
    ventilator_lag_s: Annotated[float, Field(ge=0.05, le=10.0)]
    flow_exponent: Annotated[float, Field(ge=0.3, le=1.2)]
    radiating_area_m2: NotNegative
    emissivity: Share


class FrictionSettings(_Section):
    """Map of the coefficient of friction over pressure, temperature and speed (paper, Figs 6 and 12)."""

    seal_pressure_bar: NotNegative
    residual_drag_nm: NotNegative
    reference_rpm: Positive
    low_mu_cold: Annotated[float, Field(gt=0.0, le=1.0)]
    low_mu_rise: Annotated[float, Field(ge=0.0, le=1.0)]
    low_rise_k: Positive
    high_mu_base: Annotated[float, Field(gt=0.0, le=1.0)]
    high_mu_peak: Annotated[float, Field(ge=0.0, le=1.0)]
    high_peak_degc: float
    high_width_k: Positive
    high_fade_per_k: NotNegative
    blend_pressure_bar: Positive
    minimum_mu: Annotated[float, Field(gt=0.0, le=0.3)]
    slope_s_m: NotNegative
    slope_floor: Share
    slope_peak: Annotated[float, Field(ge=0.0, le=3.0)]
    slope_peak_degc: float
    slope_width_k: Positive
    slope_pressure_exponent: Annotated[float, Field(ge=-1.0, le=1.0)]
    slope_reference_bar: Positive
    slope_range_m_s: Positive
    bedding_deficit: Annotated[float, Field(ge=0.0, le=0.5)]
    bedding_energy_j: Positive
    scatter_mu: Annotated[float, Field(ge=0.0, le=0.2)]
    scatter_slope: Annotated[float, Field(ge=0.0, le=0.2)]


class TorqueChainSettings(_Section):
    """Frame and force sensor: what stands between the brake torque and its signal."""

    frame_hz: Annotated[float, Field(ge=40.0, le=500.0)]
    frame_damping_ratio: Annotated[float, Field(ge=0.005, le=1.0)]


class PyrometerSettings(_Section):
    """Radiation thermometer on the rub surface."""

    t90_s: Annotated[float, Field(ge=0.005, le=10.0)]
    wavelength_m: Annotated[float, Field(ge=1e-6, le=14e-6)]
    emissivity: Annotated[float, Field(gt=0.05, le=1.0)]
    emissivity_set: Annotated[float, Field(gt=0.05, le=1.0)]
    noise_k: NotNegative
    range_from_degc: float
    range_to_degc: float

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if self.range_from_degc >= self.range_to_degc:
            raise PydanticCustomError(
                "pyrometer_range",
                "the measuring range starts at {low} degC and ends at {high} degC",
                {
                    "low": self.range_from_degc,
                    "high": self.range_to_degc,
                    "remedy": "Give range_from_degc below range_to_degc.",
                },
            )
        return self


class SensorError(_Section):
    """reading = value * gain + offset + noise (standard deviation), in the unit of the signal."""

    gain: Annotated[float, Field(ge=0.9, le=1.1)]
    offset: Annotated[float, Field(ge=-10.0, le=10.0)]
    noise: NotNegative


class SensorsSettings(_Section):
    """Errors of the transducers that the controller reads (bar, N m, 1/min)."""

    pressure: SensorError
    torque: SensorError
    speed: SensorError


class SafetySensorsSettings(_Section):
    """Errors of the watchdog's own transducers (bar, 1/min, N m, degC)."""

    pressure: SensorError
    speed: SensorError
    torque: SensorError
    temperature: SensorError
    temperature_lag_s: Annotated[float, Field(ge=0.01, le=10.0)]


class RadiationSettings(_Section):
    """How the motion of the brake becomes sound pressure at the microphone: one monopole per body."""

    air_density_kg_m3: Positive
    microphone_distance_m: Positive
    efficiency: Share
    areas_m2: Annotated[dict[str, NotNegative], Field(min_length=1)]
    modulation: Share
    roughness_n_per_sqrt_n: NotNegative
    saturation_m_s: Positive


class BackgroundSettings(_Section):
    """Sound of the rig itself; levels in dB(Z), 20 Hz to 20 kHz, at the microphone."""

    background_db: Level
    background_corner_hz: Positive
    shaft_modulation: Share
    motor_line_hz: Annotated[float, Field(ge=20.0, le=1000.0)]
    motor_lines_db: Annotated[tuple[Level, ...], Field(min_length=1, max_length=3)]
    motor_line_db_per_knm: NotNegative
    ventilator_db: Level
    ventilator_corner_hz: Positive
    ventilator_blade_hz: Annotated[float, Field(ge=20.0, le=1000.0)]
    ventilator_blade_db: Level
    ventilator_level_exponent: Annotated[float, Field(ge=1.0, le=4.0)]
    hiss_db: Level
    hiss_rate_bar_per_s: Positive
    hiss_from_hz: Positive
    hiss_to_hz: Positive


class MicrophoneSettings(_Section):
    """Microphone and its converter."""

    sensitivity_v_pa: Positive
    full_scale_pa: Positive
    self_noise_db: Level


class PlantSettings(_Section):
    """All physical values of a simulated rig around its brake."""

    name: Annotated[str, Field(min_length=1, max_length=120)]
    drive: DriveSettings
    pressure: PressureSettings
    thermal: ThermalSettings
    friction: FrictionSettings
    torque_chain: TorqueChainSettings
    pyrometer: PyrometerSettings
    sensors: SensorsSettings
    safety_sensors: SafetySensorsSettings
    radiation: RadiationSettings
    background: BackgroundSettings
    microphone: MicrophoneSettings

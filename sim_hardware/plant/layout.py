"""Constants and state of the slow physics as flat records, in SI: the seam between settings and kernels.

Job: `CONSTANTS` and `STATE` (numpy record types that the kernels read by name), `constants` (settings to SI,
with what depends on the step computed once), `initial_state`.
NOT its job: physics (`slow_physics`).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rigctl.core.units import KELVIN_AT_0_DEGC, M3_S_PER_M3_H, PA_PER_BAR, RAD_S_PER_RPM
from sim_hardware.plant.settings import TICK_S, PlantSettings

#: second radiation constant h c / k_B, m K
RADIATION_C2_M_K = 0.01438777
#: t90 of a first-order lag is this many time constants
_T90 = math.log(10.0)

_CONSTANTS = (
    "h inertia max_torque max_power speed_gain speed_reset torque_factor quick_stop_rate standstill "
    "bearing bearing_viscous rise_omega fall_omega damping max_rate max_pressure half_hysteresis port "
    "ripple ripple_half vent_rate vent_factor ambient surface_capacity bulk_capacity pad_capacity "
    "surface_bulk pad_disc pad_loss disc_share surface_loss still rotation rotation_reference ventilated "
    "flow_max fan_lag flow_exponent radiation seal drag reference_speed low_cold low_rise low_range "
    "high_base high_peak high_centre high_width high_fade blend minimum_mu slope slope_floor slope_peak "
    "slope_centre slope_width slope_exponent slope_pressure slope_range bedding_deficit bedding_energy "
    "piston_area radius f11 f12 f21 f22 pyro_factor c2_lambda emissivity emissivity_set pyro_low "
    "pyro_high safety_factor"
)
_STATE = (
    "omega angle omega_set motor_torque reset pressure_set regulator regulator_rate vent_opening "
    "hydraulic pressure surface bulk pad flow heat mu_reference slope_reference mu slope brake_torque "
    "scatter_mu scatter_slope next_mu next_slope bedding_energy frame frame_rate pyro pyro_target "
    "safety_temperature friction_energy loss_energy"
)
_STATE_COUNTERS = "tick heat_ticks pressed scatter_used queued"

CONSTANTS = np.dtype([(name, np.float64) for name in _CONSTANTS.split()])
STATE = np.dtype(
    [(name, np.float64) for name in _STATE.split()] + [(name, np.int64) for name in _STATE_COUNTERS.split()]
)
#: values of one row of the sound track
TRACK = ("force", "mu", "slip", "slope", "air_rate", "omega", "motor_torque", "flow", "angle")

Record = NDArray[np.void]


def constants(settings: PlantSettings, piston_area_m2: float, radius_m: float, ticks: int) -> Record:
    """Constants of the kernels, shape (1,), for mechanics advanced by `ticks` (of 0.25 ms) at a time."""
    h = ticks * TICK_S
    drive, line, heat = settings.drive, settings.pressure, settings.thermal
    friction, pyrometer = settings.friction, settings.pyrometer
    rise_omega = 1.0 / line.time_constant_s
    (f11, f12), (f21, f22) = _oscillator_step(
        2.0 * math.pi * settings.torque_chain.frame_hz, settings.torque_chain.frame_damping_ratio, h
    )
    values = {
        "h": h,
        "inertia": drive.inertia_kg_m2,
        "max_torque": drive.max_torque_nm,
        "max_power": drive.max_power_w,
        "speed_gain": drive.speed_gain_nm_s_rad,
        "speed_reset": drive.speed_reset_nm_rad,
        "torque_factor": -math.expm1(-h / drive.torque_lag_s),
        "quick_stop_rate": drive.quick_stop_rpm_per_s * RAD_S_PER_RPM,
        "standstill": drive.standstill_rpm * RAD_S_PER_RPM,
        "bearing": drive.bearing_torque_nm,
        "bearing_viscous": drive.bearing_viscous_nm_s_rad,
        "rise_omega": rise_omega,
        "fall_omega": rise_omega / line.release_slowdown,
        "damping": line.damping_ratio,
        "max_rate": line.max_rate_bar_per_s * PA_PER_BAR,
        "max_pressure": line.max_pressure_bar * PA_PER_BAR,
        "half_hysteresis": 0.5 * line.hysteresis_bar * PA_PER_BAR,
        "port": line.compensating_port_bar * PA_PER_BAR,
        "ripple": line.ripple_bar * PA_PER_BAR,
        "ripple_half": line.ripple_half_bar * PA_PER_BAR,
        "vent_rate": 1.0 / line.vent_time_constant_s,
        "vent_factor": -math.expm1(-h / line.vent_valve_lag_s),
        "ambient": heat.ambient_degc + KELVIN_AT_0_DEGC,
        "surface_capacity": heat.surface_capacity_j_k,
        "bulk_capacity": heat.bulk_capacity_j_k,
        "pad_capacity": heat.pad_capacity_j_k,
        "surface_bulk": heat.surface_bulk_w_k,
        "pad_disc": heat.pad_disc_w_k,
        "pad_loss": heat.pad_loss_w_k,
        "disc_share": heat.disc_heat_share,
        "surface_loss": heat.surface_loss_share,
        "still": heat.still_air_w_k,
        "rotation": heat.rotation_w_k,
        "rotation_reference": heat.rotation_reference_rpm * RAD_S_PER_RPM,
        "ventilated": heat.ventilator_w_k,
        "flow_max": heat.ventilator_max_m3_h * M3_S_PER_M3_H,
        "fan_lag": heat.ventilator_lag_s,
        "flow_exponent": heat.flow_exponent,
        "radiation": 5.670374e-8 * heat.emissivity * heat.radiating_area_m2,  # Stefan-Boltzmann, W/(m2 K4)
        "seal": friction.seal_pressure_bar * PA_PER_BAR,
        "drag": friction.residual_drag_nm,
        "reference_speed": friction.reference_rpm * RAD_S_PER_RPM * radius_m,
        "low_cold": friction.low_mu_cold,
        "low_rise": friction.low_mu_rise,
        "low_range": friction.low_rise_k,
        "high_base": friction.high_mu_base,
        "high_peak": friction.high_mu_peak,
        "high_centre": friction.high_peak_degc + KELVIN_AT_0_DEGC,
        "high_width": friction.high_width_k,
        "high_fade": friction.high_fade_per_k,
        "blend": friction.blend_pressure_bar * PA_PER_BAR,
        "minimum_mu": friction.minimum_mu,
        "slope": friction.slope_s_m,
        "slope_floor": friction.slope_floor,
        "slope_peak": friction.slope_peak,
        "slope_centre": friction.slope_peak_degc + KELVIN_AT_0_DEGC,
        "slope_width": friction.slope_width_k,
        "slope_exponent": friction.slope_pressure_exponent,
        "slope_pressure": friction.slope_reference_bar * PA_PER_BAR,
        "slope_range": friction.slope_range_m_s,
        "bedding_deficit": friction.bedding_deficit,
        "bedding_energy": friction.bedding_energy_j,
        "piston_area": piston_area_m2,
        "radius": radius_m,
        "f11": f11,
        "f12": f12,
        "f21": f21,
        "f22": f22,
        "pyro_factor": -math.expm1(-h * _T90 / pyrometer.t90_s),
        "c2_lambda": RADIATION_C2_M_K / pyrometer.wavelength_m,
        "emissivity": pyrometer.emissivity,
        "emissivity_set": pyrometer.emissivity_set,
        "pyro_low": pyrometer.range_from_degc + KELVIN_AT_0_DEGC,
        "pyro_high": pyrometer.range_to_degc + KELVIN_AT_0_DEGC,
        "safety_factor": -math.expm1(-h / settings.safety_sensors.temperature_lag_s),
    }
    record = np.zeros(1, CONSTANTS)
    for name in CONSTANTS.names or ():
        record[name] = values[name]
    return record


def initial_state(settings: PlantSettings) -> Record:
    """State of a rig at rest at ambient temperature, shape (1,)."""
    record = np.zeros(1, STATE)
    for name in ("surface", "bulk", "pad", "pyro", "pyro_target", "safety_temperature"):
        record[name] = settings.thermal.ambient_degc + KELVIN_AT_0_DEGC
    for name in ("scatter_mu", "scatter_slope", "next_mu", "next_slope"):
        record[name] = 1.0
    record["mu"] = record["mu_reference"] = settings.friction.low_mu_cold
    return record


def _oscillator_step(omega: float, zeta: float, h: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Exact step over `h` of e'' + 2 zeta omega e' + omega^2 e = 0 for (e, e'), zeta < 1."""
    damped = omega * math.sqrt(max(1.0 - zeta * zeta, 1e-12))
    decay, c, s = math.exp(-zeta * omega * h), math.cos(damped * h), math.sin(damped * h) / damped
    return (
        (decay * (c + zeta * omega * s), decay * s),
        (-decay * omega * omega * s, decay * (c - zeta * omega * s)),
    )

"""The slow physics of the rig, compiled: drive, pressure line, temperatures, friction map, sensors' lags.

One kernel, `advance`, steps everything on a grid of ticks of 0.25 ms: mechanics every `inner` ticks (1 while
recording, 10 = 2.5 ms while nothing is recorded), temperatures and the friction map every 20 ticks (5 ms) in
both cases. SI units; constants and state are the records of `layout`.
All compiled functions are in this one file on purpose: numba's disk cache looks at the file of the kernel
only, so a change in a helper elsewhere would go unnoticed.
NOT its job: sensor noise and gains (`plant`), sound (`sound`), squeal (`sim_hardware.brake_model`).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit

#: ticks of 0.25 ms between two updates of temperatures and friction map
HEAT_TICKS = 20
#: ticks between two readings of the safety sensors (100 Hz) and two rows of the sound track
SAFETY_TICKS = 40
#: how many set-points of pressure can wait in the regulator's dead time
QUEUE = 16


@njit(cache=True, nogil=True)
def map_mu(c: Any, pressure_pa: float, temperature_k: float) -> float:
    """Coefficient of friction of bedded pads at the reference speed (paper, Fig. 6).

    At low pressure it rises with temperature; at high pressure it has a maximum. c: `layout.CONSTANTS`.
    """
    warm = 1.0 - math.exp(-(temperature_k - 293.15) / c.low_range)
    low = c.low_cold + c.low_rise * warm
    off = temperature_k - c.high_centre
    high = c.high_base + c.high_peak * math.exp(-((off / c.high_width) ** 2)) - c.high_fade * max(off, 0.0)
    share = 1.0 / (1.0 + (max(pressure_pa, 0.0) / c.blend) ** 2)
    return max(share * low + (1.0 - share) * high, c.minimum_mu)


@njit(cache=True, nogil=True)
def map_slope(c: Any, pressure_pa: float, temperature_k: float) -> float:
    """Falling slope k at the reference speed, s/m (eq 28; Fig. 12: depends on pressure and temperature)."""
    off = (temperature_k - c.slope_centre) / c.slope_width
    shape = c.slope_floor + c.slope_peak * math.exp(-off * off)
    return c.slope * shape * (max(pressure_pa, 0.1 * c.slope_pressure) / c.slope_pressure) ** c.slope_exponent


@njit(cache=True, nogil=True)
def _heat_rates(
    c: Any, surface: float, bulk: float, pad: float, power: float, film: float
) -> tuple[float, float, float, float]:
    """Rates of the three temperatures (K/s) and the heat lost to the surroundings (W)."""
    a = c.ambient
    inward = c.surface_bulk * (surface - bulk)
    contact = c.pad_disc * (pad - surface)
    loss_s = c.surface_loss * (film * (surface - a) + c.radiation * (surface**4 - a**4))
    loss_b = (1.0 - c.surface_loss) * (film * (bulk - a) + c.radiation * (bulk**4 - a**4))
    loss_p = c.pad_loss * (pad - a)
    return (
        (c.disc_share * power + contact - inward - loss_s) / c.surface_capacity,
        (inward - loss_b) / c.bulk_capacity,
        ((1.0 - c.disc_share) * power - contact - loss_p) / c.pad_capacity,
        loss_s + loss_b + loss_p,
    )


@njit(cache=True, nogil=True)
def heat_step(
    c: Any, surface: float, bulk: float, pad: float, power: float, omega: float, flow: float, h: float
) -> tuple[float, float, float, float]:
    """Advance the three temperatures (K) by h (s) with Heun's method, friction power constant.

    Returns the temperatures and the heat lost (J); energy is conserved to rounding.
    """
    film = c.still
    if omega > 0.0:
        film += c.rotation * (omega / c.rotation_reference) ** c.flow_exponent
    if flow > 1e-6:
        film += c.ventilated * (flow / c.flow_max) ** c.flow_exponent  # turbulent: h ~ flow^0.8
    s1, b1, p1, l1 = _heat_rates(c, surface, bulk, pad, power, film)
    s2, b2, p2, l2 = _heat_rates(c, surface + h * s1, bulk + h * b1, pad + h * p1, power, film)
    return (
        surface + 0.5 * h * (s1 + s2),
        bulk + 0.5 * h * (b1 + b2),
        pad + 0.5 * h * (p1 + p2),
        0.5 * h * (l1 + l2),
    )


@njit(cache=True, nogil=True)
def pyrometer_reading(c: Any, temperature_k: float) -> float:
    """What the pyrometer makes of a surface (K): emissivity error, reflected ambient light, range limits."""
    around = 1.0 / math.expm1(c.c2_lambda / c.ambient)
    signal = c.emissivity / math.expm1(c.c2_lambda / temperature_k) + (1.0 - c.emissivity) * around
    object_only = max((signal - (1.0 - c.emissivity_set) * around) / c.emissivity_set, 1e-30)
    reading = c.c2_lambda / math.log1p(1.0 / object_only)
    return min(max(reading, c.pyro_low), c.pyro_high)


@njit(cache=True, nogil=True)
def _drive(c: Any, s: Any, target: float, ramp: float, on: bool, quick: bool) -> None:
    """Ramp generator, speed controller with current and power limit, current loop: the motor torque."""
    if not on:
        s.omega_set = s.omega
        s.reset = 0.0
        s.motor_torque -= s.motor_torque * c.torque_factor
        return
    goal = 0.0 if quick else max(target, 0.0)
    step = (c.quick_stop_rate if quick else ramp) * c.h
    s.omega_set += min(max(goal - s.omega_set, -step), step)
    demand = 0.0
    if s.omega_set <= 0.0 and s.omega < c.standstill:
        s.reset = 0.0
    else:
        error = s.omega_set - s.omega
        limit = min(c.max_torque, c.max_power / max(s.omega, 1e-3))
        wanted = c.speed_gain * error + s.reset + c.speed_reset * c.h * error
        demand = min(max(wanted, -limit), limit)
        if demand == wanted or error * wanted < 0.0:  # no wind-up at the limit
            s.reset += c.speed_reset * c.h * error
    s.motor_torque += (demand - s.motor_torque) * c.torque_factor


@njit(cache=True, nogil=True)
def _turn(c: Any, s: Any) -> None:
    """Brake torque and motion of the shaft. Friction stops the shaft, holds it, never turns it backwards."""
    speed = s.omega * c.radius - c.reference_speed
    relative = speed / c.slope_range
    root = math.sqrt(1.0 + relative * relative)
    factor = (1.0 - c.bedding_deficit * math.exp(-s.bedding_energy / c.bedding_energy)) * s.scatter_mu
    slope = s.slope_reference * s.scatter_slope
    s.mu = max(factor * (s.mu_reference - slope * speed / root), c.minimum_mu)  # eq 28
    s.slope = factor * slope / (root * root * root)
    holding = 2.0 * s.mu * max(s.pressure - c.seal, 0.0) * c.piston_area * c.radius + c.drag
    bearing = c.bearing + c.bearing_viscous * s.omega
    if s.omega > 0.0:
        s.brake_torque = holding
        new = s.omega + c.h * (s.motor_torque - holding - bearing) / c.inertia
        mean = 0.5 * (s.omega + max(new, 0.0))
    elif s.motor_torque > holding + bearing:
        s.brake_torque = holding
        new = c.h * (s.motor_torque - holding - bearing) / c.inertia
        mean = 0.5 * new
    else:
        s.brake_torque = min(max(s.motor_torque - bearing, 0.0), holding)
        new = mean = 0.0
    s.omega = max(new, 0.0)
    s.angle += c.h * mean
    if s.angle > 2.0 * math.pi:
        s.angle -= 2.0 * math.pi
    work = s.brake_torque * mean * c.h
    s.heat += work
    s.friction_energy += work
    s.bedding_energy += work


@njit(cache=True, nogil=True)
def _line(c: Any, s: Any, set_point: float, vent: bool) -> None:
    """Pressure line: regulator (second order, slower in release), vent valve, seal friction, ripple."""
    s.vent_opening += ((1.0 if vent else 0.0) - s.vent_opening) * c.vent_factor
    if vent:
        escaped = s.regulator * -math.expm1(-s.vent_opening * c.vent_rate * c.h)
        s.regulator -= escaped
        s.regulator_rate = -escaped / c.h
    else:
        releasing = set_point < s.regulator and s.regulator_rate <= 0.0
        omega = c.fall_omega if releasing else c.rise_omega
        pull = omega * omega * (set_point - s.regulator) - 2.0 * c.damping * omega * s.regulator_rate
        s.regulator_rate = min(max(s.regulator_rate + c.h * pull, -c.max_rate), c.max_rate)
        s.regulator += c.h * s.regulator_rate
        if s.regulator < 0.0 or s.regulator > c.max_pressure:
            s.regulator = min(max(s.regulator, 0.0), c.max_pressure)
            s.regulator_rate = 0.0
    # seal friction: the line pressure follows with play (Prandtl element); the open port leaves none at zero
    play = c.half_hysteresis * min(1.0, s.regulator / c.port)
    s.hydraulic = max(min(max(s.hydraulic, s.regulator - play), s.regulator + play), 0.0)
    ripple = c.ripple * s.hydraulic / (s.hydraulic + c.ripple_half) * math.sin(s.angle)
    s.pressure = max(s.hydraulic + ripple, 0.0)
    if s.pressed == 0 and s.pressure > 1.2 * c.seal:
        s.pressed = 1
        if s.scatter_used == 0:  # the caller draws the next pair after the step
            s.scatter_mu = s.next_mu
            s.scatter_slope = s.next_slope
            s.scatter_used = 1
    elif s.pressed == 1 and s.pressure < 0.6 * c.seal:
        s.pressed = 0


@njit(cache=True, nogil=True)
def _warm(c: Any, s: Any, flow_set: float) -> None:
    """Temperatures, ventilator, friction map and the pyrometer's target, every `HEAT_TICKS`."""
    h = s.heat_ticks * 0.25e-3
    s.flow += (flow_set - s.flow) * -math.expm1(-h / c.fan_lag)
    s.surface, s.bulk, s.pad, lost = heat_step(c, s.surface, s.bulk, s.pad, s.heat / h, s.omega, s.flow, h)
    s.loss_energy += lost
    s.heat = 0.0
    s.heat_ticks = 0
    s.mu_reference = map_mu(c, s.pressure, s.surface)
    s.slope_reference = map_slope(c, s.pressure, s.surface)
    s.pyro_target = pyrometer_reading(c, s.surface)


@njit(cache=True, nogil=True)
def _note(c: Any, s: Any, row: Any) -> None:
    """Row of the sound track (`layout.TRACK`)."""
    row[0] = max(s.pressure - c.seal, 0.0) * c.piston_area
    row[1] = s.mu
    row[2] = s.omega * c.radius
    row[3] = s.slope
    row[4] = abs(s.regulator_rate)
    row[5] = s.omega
    row[6] = s.motor_torque
    row[7] = s.flow
    row[8] = s.angle


@njit(cache=True, nogil=True)
def advance(
    constants: Any,
    state: Any,
    queue_tick: Any,
    queue_value: Any,
    ticks: int,
    inner: int,
    stride: int,
    speed_set: float,
    speed_ramp: float,
    drive_on: bool,
    quick: bool,
    vent: bool,
    flow_set: float,
    out: Any,
    safety: Any,
    track: Any,
) -> None:
    """Advance the rig by `ticks` of 0.25 ms.

    Parameters
    ----------
    constants, state : (1,) records of `layout`; state is changed
    queue_tick, queue_value : (QUEUE,) when the set-points of pressure on their way act, and Pa; changed
    inner : ticks per mechanical step; divides stride and SAFETY_TICKS
    stride : ticks between two samples; divides `ticks`
    speed_set, speed_ramp : rad/s, rad/s2
    flow_set : m3/s
    out : (4, ticks // stride) torque N m, pressure Pa, speed rad/s, pyrometer K, at each interval's start
    safety : (4, ceil(ticks / SAFETY_TICKS)) pressure Pa, speed rad/s, torque N m, temperature K
    track : (rows, 9) every SAFETY_TICKS and at the end, or (0, 9) for none
    """
    c = constants[0]
    s = state[0]
    noted = track.shape[0] > 0
    for i in range(0, ticks, inner):
        if i % stride == 0:
            j = i // stride
            out[0, j] = s.frame
            out[1, j] = s.pressure
            out[2, j] = s.omega
            out[3, j] = s.pyro
        if i % SAFETY_TICKS == 0:
            j = i // SAFETY_TICKS
            safety[0, j] = s.pressure
            safety[1, j] = s.omega
            safety[2, j] = s.frame
            safety[3, j] = s.safety_temperature
            if noted:
                _note(c, s, track[j])
        while s.queued > 0 and queue_tick[0] <= s.tick:
            s.pressure_set = queue_value[0]
            s.queued -= 1
            for q in range(s.queued):
                queue_tick[q] = queue_tick[q + 1]
                queue_value[q] = queue_value[q + 1]
        _drive(c, s, speed_set, speed_ramp, drive_on, quick)
        _line(c, s, s.pressure_set, vent)
        _turn(c, s)
        error, rate = (
            s.frame - s.brake_torque,
            s.frame_rate,
        )  # frame and force sensor, exact for a held torque
        s.frame = s.brake_torque + c.f11 * error + c.f12 * rate
        s.frame_rate = c.f21 * error + c.f22 * rate
        s.pyro += (s.pyro_target - s.pyro) * c.pyro_factor
        s.safety_temperature += (s.surface - s.safety_temperature) * c.safety_factor
        s.tick += inner
        s.heat_ticks += inner
        if s.heat_ticks >= HEAT_TICKS:
            _warm(c, s, flow_set)
    if noted:
        _note(c, s, track[track.shape[0] - 1])


@njit(cache=True, nogil=True)
def read_sensors(true: Any, noise: Any, errors: Any, digits: float, readings: Any) -> None:
    """Readings of four sensors: readings (4, n) = errors[0] true + errors[1] + errors[2] noise.

    true (4, n); noise (n, 4); errors (3, 4): scale, offset, standard deviation; rounded to 1/digits if that
    is not 0.
    """
    for j in range(4):
        scale, offset, sigma = errors[0, j], errors[1, j], errors[2, j]
        for i in range(true.shape[1]):
            value = scale * true[j, i] + offset + sigma * noise[i, j]
            if digits > 0.0:
                value = round(value * digits) / digits
            readings[j, i] = value


@njit(cache=True, nogil=True)
def map_grid(constants: Any, pressure_pa: Any, temperature_k: Any, mu: Any, slope: Any) -> None:
    """Friction map on a grid: mu and slope, (n_pressures, n_temperatures), are filled."""
    c = constants[0]
    for i in range(pressure_pa.shape[0]):
        for j in range(temperature_k.shape[0]):
            mu[i, j] = map_mu(c, pressure_pa[i], temperature_k[j])
            slope[i, j] = map_slope(c, pressure_pa[i], temperature_k[j])


@njit(cache=True, nogil=True)
def heat_course(
    constants: Any, start_k: Any, power_w: float, omega: float, flow: float, h: float, out: Any
) -> None:
    """Temperatures under constant power: out (n, 3) K at h, 2 h, ...; for studies and tests."""
    c = constants[0]
    surface, bulk, pad = start_k[0], start_k[1], start_k[2]
    for i in range(out.shape[0]):
        surface, bulk, pad, _ = heat_step(c, surface, bulk, pad, power_w, omega, flow, h)
        out[i, 0], out[i, 1], out[i, 2] = surface, bulk, pad


def empty_queue() -> tuple[np.ndarray, np.ndarray]:
    """Queue of set-points: (QUEUE,) ticks and values."""
    return np.zeros(QUEUE, np.int64), np.zeros(QUEUE)

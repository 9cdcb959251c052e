"""Disc temperatures against a tight integrator, analytic time constants and the balance of energy."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sim_hardware.brake_model import load_brake
from sim_hardware.plant import Commands, Plant, PlantSettings, slow_physics
from sim_hardware.plant.layout import constants

CONFIGS = Path(__file__).resolve().parents[3] / "configs"
MS = 1_000_000
SETTINGS = PlantSettings.model_validate(tomllib.loads((CONFIGS / "plants" / "a_class.toml").read_text()))
BRAKE = load_brake(CONFIGS / "brakes" / "plant.toml")
T = SETTINGS.thermal


def reference(start_k, power_w, rpm, flow_m3_h, duration_s):
    """Independent statement of the thermal equations from the settings, integrated tightly."""
    ambient = T.ambient_degc + 273.15
    film = T.still_air_w_k
    film += T.rotation_w_k * (rpm / T.rotation_reference_rpm) ** T.flow_exponent
    film += T.ventilator_w_k * (flow_m3_h / T.ventilator_max_m3_h) ** T.flow_exponent
    black = 5.670374e-8 * T.emissivity * T.radiating_area_m2
    capacity = np.array([T.surface_capacity_j_k, T.bulk_capacity_j_k, T.pad_capacity_j_k])
    share = np.array([T.surface_loss_share, 1 - T.surface_loss_share])

    def rates(_, y):
        loss = share * (film * (y[:2] - ambient) + black * (y[:2] ** 4 - ambient**4))
        inward, contact = T.surface_bulk_w_k * (y[0] - y[1]), T.pad_disc_w_k * (y[2] - y[0])
        heat = np.array(
            [
                T.disc_heat_share * power_w + contact - inward - loss[0],
                inward - loss[1],
                (1 - T.disc_heat_share) * power_w - contact - T.pad_loss_w_k * (y[2] - ambient),
            ]
        )
        return heat / capacity

    return solve_ivp(rates, (0, duration_s), start_k, method="DOP853", rtol=1e-10, atol=1e-9).y[:, -1]


def course(start_k, power_w, rpm, flow_m3_h, duration_s, h):
    out = np.zeros((round(duration_s / h), 3))
    slow_physics.heat_course(
        constants(SETTINGS, BRAKE.piston_area_m2, BRAKE.effective_radius_m, 1),
        np.array(start_k, dtype=float),
        power_w,
        rpm * 2 * math.pi / 60,
        flow_m3_h / 3600,
        h,
        out,
    )
    return out


@pytest.mark.parametrize("h", [0.005, 0.0075])
@pytest.mark.parametrize(
    ("start_degc", "power_w", "rpm", "flow_m3_h"),
    [
        (30.0, 2700.0, 40.0, 0.0),
        (310.0, 0.0, 40.0, 1000.0),
        (100.0, 4000.0, 200.0, 300.0),
        (500.0, 0.0, 0.0, 0.0),
    ],
)
def test_kernel_agrees_with_a_tight_integrator(start_degc, power_w, rpm, flow_m3_h, h):
    start = np.array([start_degc + 10.0, start_degc, 0.5 * (start_degc + 20.0)]) + 273.15
    got = course(start, power_w, rpm, flow_m3_h, 60.0, h)[-1]
    expected = reference(start, power_w, rpm, flow_m3_h, 60.0)
    assert np.abs(got - expected).max() < 2e-4  # K


@pytest.mark.parametrize(
    ("flow_m3_h", "shortest_s", "longest_s"), [(0.0, 700.0, 1100.0), (1000.0, 150.0, 280.0)]
)
def test_disc_cools_with_the_time_constant_of_the_field(flow_m3_h, shortest_s, longest_s):
    """Still air about 15 min, ventilator 160 to 270 s; small excess temperature, pads equally warm."""
    start = np.full(3, 20.0 + 40.0 + 273.15)
    bulk = course(start, 0.0, 0.0, flow_m3_h, 1500.0, 0.01)[:, 1] - 293.15
    time_constant = np.argmax(bulk < 40.0 / math.e) * 0.01
    assert shortest_s < time_constant < longest_s


def test_surface_flash_relaxes_in_one_to_three_seconds():
    heated = course(np.full(3, 373.15), 2700.0, 40.0, 0.0, 12.0, 0.005)[-1]
    flash = heated[0] - heated[1]
    assert 5.0 < flash < 25.0
    after = course(heated, 0.0, 40.0, 0.0, 5.0, 0.005)
    difference = after[:, 0] - after[:, 1]
    assert 0.5 < np.argmax(difference < flash / math.e) * 0.005 < 3.0


@pytest.mark.parametrize(("full_rate", "block_ms"), [(True, 50), (False, 500)])
def test_energy_balance_of_a_braking(full_rate, block_ms):
    """Friction work = heat stored + heat lost, in both step sizes."""
    plant = Plant(SETTINGS, BRAKE, seed=1)
    commands = Commands(
        speed_set_rpm=40.0,
        speed_ramp_rpm_per_s=40.0,
        drive_enabled=True,
        pressure_set_bar=20.0,
        relay_closed=True,
    )
    for _ in range(30_000 // block_ms):
        plant.step(block_ms * MS, commands, full_rate=full_rate)
    truth = plant.truth
    stored = (
        T.surface_capacity_j_k * (truth.surface_degc - 20.0)
        + T.bulk_capacity_j_k * (truth.bulk_degc - 20.0)
        + T.pad_capacity_j_k * (truth.pad_degc - 20.0)
    )
    assert truth.friction_energy_j > 30_000.0
    assert stored + truth.loss_energy_j == pytest.approx(truth.friction_energy_j, rel=1e-6)


def test_braking_at_30_bar_warms_the_disc_by_about_15_kelvin():
    plant = Plant(SETTINGS, BRAKE, seed=1)
    plant.set_condition(disc_degc=100.0, bedding=0.95)
    commands = Commands(
        speed_set_rpm=40.0,
        speed_ramp_rpm_per_s=100.0,
        drive_enabled=True,
        pressure_set_bar=0.0,
        relay_closed=True,
    )
    plant.step(1000 * MS, commands, full_rate=False)
    before = plant.truth.bulk_degc
    plant.step(12_000 * MS, replace(commands, pressure_set_bar=30.0), full_rate=False)
    plant.step(5_000 * MS, commands, full_rate=False)
    assert 12.0 < plant.truth.bulk_degc - before < 20.0

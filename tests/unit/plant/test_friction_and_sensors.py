"""Friction map (paper, Figs 6 and 12), bedding, scatter; frame, pyrometer and transducer errors."""

import math

import numpy as np
import pytest
from plant_rig import Rig, changed_settings, shipped_brake, shipped_settings, smooth

from sim_hardware.plant import slow_physics
from sim_hardware.plant.layout import constants

BRAKE = shipped_brake()
PRESSURES_BAR = np.arange(2.0, 31.0, 2.0)
TEMPERATURES_DEGC = np.arange(50.0, 301.0, 10.0)


@pytest.fixture(scope="module")
def maps():
    """mu and slope over (pressure, temperature), bedded, at 40 1/min."""
    record = constants(shipped_settings(), BRAKE.piston_area_m2, BRAKE.effective_radius_m, 1)
    shape = (len(PRESSURES_BAR), len(TEMPERATURES_DEGC))
    mu, slope = np.zeros(shape), np.zeros(shape)
    slow_physics.map_grid(record, PRESSURES_BAR * 1e5, TEMPERATURES_DEGC + 273.15, mu, slope)
    return mu, slope


def test_mu_spreads_from_0_3_to_0_6(maps):
    mu, _ = maps
    assert 0.3 <= mu.min() < 0.36 and 0.5 < mu.max() <= 0.6


def test_mu_rises_with_temperature_at_low_pressure(maps):
    mu, _ = maps
    for row in mu[PRESSURES_BAR <= 4.0]:
        assert np.all(np.diff(row) > 0.0)


def test_mu_has_its_maximum_between_100_and_150_degrees_at_high_pressure(maps):
    mu, _ = maps
    for row in mu[PRESSURES_BAR >= 20.0]:
        assert 100.0 <= TEMPERATURES_DEGC[np.argmax(row)] <= 150.0
        assert row.max() > 1.05 * row[0] and row.max() > 1.2 * row[-1]


def test_slope_is_near_the_mean_of_the_paper_and_largest_in_the_squeal_range(maps):
    _, slope = maps
    assert slope.mean() == pytest.approx(0.0576, rel=0.35)
    assert np.all(slope > 0.0)
    for row in slope:
        assert 100.0 <= TEMPERATURES_DEGC[np.argmax(row)] <= 200.0
    assert slope.max(axis=0).min() / slope.min(axis=0).max() < 3.0  # moderate


def test_stop_braking_shows_the_nearly_linear_fall_of_fig_12():
    """200 to 0 1/min in 12 s: mu against speed is close to a falling line of the slope that the map gives."""
    rig = Rig(settings=changed_settings(friction__scatter_mu=0.0, friction__scatter_slope=0.0)).turn(200.0)
    rig.plant.set_condition(disc_degc=60.0, bedding=0.95)
    rig.run(1.0, pressure_set_bar=10.0)
    slow = rig.run(12.0, speed_set_rpm=0.0, speed_ramp_rpm_per_s=200.0 / 12.0)
    m, p, n = (smooth(slow[name], 400) for name in ("torque", "pressure", "speed"))
    mu = m / (2.0 * (p - 0.5) * 1e5 * BRAKE.piston_area_m2 * BRAKE.effective_radius_m)
    sliding = n > 20.0
    v = n[sliding] * 2 * math.pi / 60 * BRAKE.effective_radius_m
    slope, offset = np.polyfit(v, mu[sliding], 1)
    assert -0.08 < slope < -0.03
    assert np.std(mu[sliding] - (slope * v + offset)) < 0.01


def test_bedding_raises_mu_towards_its_end_value():
    mus = []
    for bedding in (0.0, 1 - math.exp(-1.0), 0.99):
        rig = Rig(settings=changed_settings(friction__scatter_mu=0.0)).turn()
        rig.plant.set_condition(bedding=bedding, disc_degc=60.0)
        rig.run(1.0, pressure_set_bar=10.0)
        mus.append(rig.plant.truth.mu)
    new, third, bedded = mus
    assert new / bedded == pytest.approx(0.88, abs=0.01)
    assert (bedded - third) / (bedded - new) == pytest.approx(math.exp(-1.0), abs=0.05)


def test_bedding_brakings_wear_in_as_exp_minus_n_over_30():
    rig = Rig()
    rig.turn(100.0)
    for _ in range(30):
        rig.plant.set_condition(disc_degc=100.0)
        rig.run(6.0, full_rate=False, block_ms=500, pressure_set_bar=10.0)
        rig.run(1.5, full_rate=False, block_ms=500, pressure_set_bar=0.0)
    assert 0.5 < rig.plant.truth.bedding < 0.75  # 1 - exp(-1) = 0.63


def test_mu_scatters_from_stop_to_stop_by_two_to_three_percent():
    rig = Rig(seed=11).turn()
    mus = []
    for _ in range(120):
        rig.plant.set_condition(disc_degc=100.0, bedding=0.99)
        rig.run(1.0, full_rate=False, block_ms=500, pressure_set_bar=10.0)
        mus.append(rig.plant.truth.mu)
        held = rig.plant.truth.mu
        rig.run(0.5, full_rate=False, block_ms=500)
        assert rig.plant.truth.mu == pytest.approx(held, rel=6e-3)  # one value per braking
        rig.run(2.0, full_rate=False, block_ms=500, pressure_set_bar=0.0)
    assert 0.015 < np.std(mus) / np.mean(mus) < 0.03


def test_torque_is_friction_plus_residual_drag():
    rig = Rig().turn()
    drag = rig.run(1.0)["torque"].mean()
    assert 1.0 <= drag <= 3.0
    slow = rig.run(4.0, pressure_set_bar=10.0)
    truth = rig.plant.truth
    expected = (
        2 * truth.mu * (truth.pressure_bar - 0.5) * 1e5 * BRAKE.piston_area_m2 * BRAKE.effective_radius_m
    )
    assert truth.brake_torque_nm == pytest.approx(expected + 1.6, rel=1e-3)
    assert slow["torque"][-400:].mean() == pytest.approx(truth.brake_torque_nm, rel=0.02)


def test_frame_rings_at_its_natural_frequency():
    rig = Rig(settings=changed_settings(pressure__ripple_bar=0.0)).turn()
    rig.plant._state["frame_rate"] = 2e4  # a blow to the frame, N m/s
    torque = rig.run(0.5)["torque"].astype(float)
    spectrum = np.abs(np.fft.rfft((torque - torque.mean()) * np.hanning(len(torque)), 16 * len(torque)))
    assert np.argmax(spectrum) / (16 * 0.5) == pytest.approx(62.0, abs=2.0)


def test_pyrometer_lags_by_its_t90_and_errs_by_emissivity():
    rig = Rig(settings=changed_settings(pyrometer__noise_k=0.0))
    rig.plant.set_condition(disc_degc=100.0)
    rig.run(0.5)
    settled = rig.run(0.05)["disc_temperature"][-1]
    assert -1.5 < settled - rig.plant.truth.surface_degc < -0.2
    rig.plant._state["surface"] = rig.plant._state["bulk"] = 300.0 + 273.15
    course = rig.run(0.4)["disc_temperature"].astype(float)
    end = course[-1]
    assert -6.0 < end - rig.plant.truth.surface_degc < -2.0  # grows with temperature
    t90 = np.argmax(course > settled + 0.9 * (end - settled)) / 4000
    assert t90 == pytest.approx(0.09, abs=0.01)


def test_pyrometer_stops_at_its_lower_limit():
    rig = Rig(settings=changed_settings(pyrometer__range_from_degc=60.0, pyrometer__noise_k=0.0))
    assert rig.run(1.0)["disc_temperature"][-1] == pytest.approx(60.0, abs=1e-3)


def test_transducers_err_as_the_settings_say():
    rig = Rig().turn()
    rig.run(2.0, pressure_set_bar=20.0)
    n = rig.run(1.0)
    assert np.std(np.diff(n["pressure"])) / math.sqrt(2) == pytest.approx(0.02, rel=0.15)
    assert np.std(np.diff(n["speed"])) / math.sqrt(2) == pytest.approx(0.02, rel=0.15)
    assert np.std(np.diff(n["disc_temperature"])) / math.sqrt(2) == pytest.approx(0.3, rel=0.15)

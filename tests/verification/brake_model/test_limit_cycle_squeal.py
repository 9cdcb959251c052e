"""Limit cycles: onset and growth as eigenvalues say, amplitude as an independent integration has it."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.friction import SaturatingFriction
from sim_hardware.brake_model.stability import onset_pressure
from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator
from sim_hardware.brake_model.time_domain.limit_cycle import SquealSimulation, branches
from sim_hardware.brake_model.time_domain.reference import WorkingPoint, motion
from sim_hardware.brake_model.time_domain.squeal_points import critical_mode, squeal_points
from sim_hardware.brake_model.time_domain.squeal_ramp import ramps

PLANT = load_brake(Path(__file__).parents[3] / "configs" / "brakes" / "plant.toml")
SLIDING: dict[str, Any] = {"slip_m_s": 0.44, "saturation_m_s": 0.1}
LINEAR: dict[str, Any] = {"slip_m_s": 0.44, "saturation_m_s": None}


def test_saturating_law_is_supercritical_and_sets_in_where_eigenvalues_say() -> None:
    found = branches(squeal_points(PLANT, "pressure", np.linspace(8.0, 20.0, 13), **SLIDING), longest_s=2.0)
    onset = onset_pressure(PLANT)
    assert onset is not None and found.onset_eigenvalues == pytest.approx(onset.value, abs=2e-3)
    assert found.onset_time == pytest.approx(onset.value, abs=0.01)
    assert found.fold == pytest.approx(onset.value, abs=0.1)
    assert found.verdict == "supercritical" and found.hysteresis is not None and found.hysteresis < 0.1
    unstable = found.mode.growth_1_s > 0.0
    np.testing.assert_allclose(found.growth_1_s[unstable], found.mode.growth_1_s[unstable], rtol=2e-3)
    for cycles in (found.small, found.large):
        np.testing.assert_array_equal(cycles.squeals[1:], unstable[1:])
        assert not cycles.stuck_share.any() and not cycles.lifted_share.any()
        assert cycles.settled[unstable].all()
    np.testing.assert_allclose(
        found.small.slip_amplitude_m_s[unstable], found.large.slip_amplitude_m_s[unstable], rtol=2e-3
    )
    np.testing.assert_allclose(found.large.frequency_hz[unstable], onset.frequency_hz, atol=0.5)
    # supercritical: near the onset the square of the amplitude grows in proportion to the distance
    near = unstable & (found.points.values < 15.5)
    square, distance = found.small.slip_amplitude_m_s[near] ** 2, found.points.values[near] - onset.value
    assert square / distance == pytest.approx(np.mean(square / distance), rel=0.15)


def test_amplitude_is_that_of_an_independent_integration() -> None:
    """The steady motion, continued for five periods by DOP853: the same amplitude."""
    points = squeal_points(PLANT, "pressure", [16.0], **SLIDING)
    simulation = SquealSimulation(points)
    cycles = simulation.limit_cycles("small", longest_s=2.0)
    state = simulation.batch.states[0]
    law = SaturatingFriction(mu_mean=PLANT.mu, k_s_m=PLANT.slope_s_m, saturation_m_s=0.1)
    times = np.arange(86) / 40_000
    states = motion(PLANT, WorkingPoint(points.pad_force_n[0], 0.44, law), state, times, rtol=1e-9)
    index = PLANT.freedom_index("disc.y")
    velocity = states[:85, PLANT.n_dof + index]  # five periods of 2350 Hz
    assert np.sqrt(np.mean(velocity**2)) == pytest.approx(cycles.surface_velocity_m_s[0], rel=3e-3)


def test_linear_law_jumps_to_the_reversal_of_slip_and_sticks() -> None:
    found = branches(squeal_points(PLANT, "pressure", np.linspace(9.0, 21.0, 9), **LINEAR), longest_s=2.0)
    assert found.verdict == "sudden"
    squeals = found.large.squeals
    np.testing.assert_array_equal(squeals, found.mode.growth_1_s > 0.0)
    amplitude = found.large.slip_amplitude_m_s[squeals]
    assert (amplitude > 0.42).all() and (amplitude < 0.5).all() and (np.diff(amplitude) > 0.0).all()
    assert (found.large.stuck_share[squeals] > 0.01).all()
    assert (np.diff(found.large.frequency_hz[squeals]) < 0.0).all()  # sticking slows the vibration down


def test_verdict_follows_from_the_end_of_large_motions() -> None:
    found = branches(squeal_points(PLANT, "pressure", [10.0, 12.5, 15.0], **SLIDING), longest_s=0.5)
    assert found.verdict == "supercritical"
    assert replace(found, hysteresis=1.0, resolution=0.1).verdict == "subcritical"
    assert replace(found, hysteresis=None).verdict == "none"


def test_other_quantities_and_parameters() -> None:
    slope = squeal_points(PLANT, "slope", np.linspace(0.02, 0.08, 4), pressure_bar=15.0, **SLIDING)
    cycles = SquealSimulation(slope).limit_cycles("large", longest_s=1.0)
    np.testing.assert_array_equal(cycles.squeals, critical_mode(slope).growth_1_s > 0.0)
    mass = squeal_points(PLANT, "m_disc", [4.5, 5.0, 5.5], pressure_bar=16.0, **SLIDING)
    assert mass.unit == "kg" and len(mass.brakes) == 3
    heavier = SquealSimulation(mass).limit_cycles("large", longest_s=1.0)
    mode = critical_mode(mass)
    np.testing.assert_array_equal(heavier.squeals, mode.growth_1_s > 0.0)
    np.testing.assert_allclose(
        heavier.frequency_hz[heavier.squeals], mode.frequency_hz[heavier.squeals], atol=2.0
    )


def test_radiated_sound_is_the_weighted_sum() -> None:
    points = squeal_points(PLANT, "pressure", [16.0, 18.0], **SLIDING)
    cycles = SquealSimulation(points, {"disc.y": 2.5}).limit_cycles("large", longest_s=1.0)
    np.testing.assert_allclose(cycles.radiated, 2.5 * cycles.surface_acceleration_m_s2, rtol=1e-12)


def test_ramps_lag_less_the_slower_they_are() -> None:
    runs = ramps(PLANT, "pressure", 6.0, 20.0, durations_s=(0.5, 2.0), seeds=(1,), **SLIDING)
    fast, slow = (run.width for run in runs)
    assert fast is not None and slow is not None and 0.0 < slow < 0.75 * fast
    again = ramps(PLANT, "pressure", 6.0, 20.0, durations_s=(0.5, 2.0), seeds=(1,), **SLIDING)
    np.testing.assert_array_equal(again[1].slip_up_m_s, runs[1].slip_up_m_s)
    quiet = ramps(PLANT, "pressure", 2.0, 8.0, durations_s=(0.5,), seeds=(1,), **SLIDING)
    assert quiet[0].onset is None and quiet[0].width is None


def test_wrong_input_is_refused() -> None:
    with pytest.raises(KeyError, match="m_disk"):
        squeal_points(PLANT, "m_disk", [1.0], **SLIDING)
    with pytest.raises(ValueError, match="pressure"):
        squeal_points(PLANT, "pressure", [-1.0], **SLIDING)
    with pytest.raises(ValueError, match="slip"):
        squeal_points(PLANT, "slip", [0.0], saturation_m_s=None, slip_m_s=1.0)
    with pytest.raises(ValueError, match="values"):
        squeal_points(PLANT, "pressure", [], **SLIDING)
    with pytest.raises(ValueError, match="ramped"):
        ramps(PLANT, "m_disc", 4.0, 5.0, **SLIDING)


def test_extremes() -> None:
    """No pressure, no friction, the whole range stable or unstable: quiet or squealing, and no onset."""
    still = branches(squeal_points(PLANT, "pressure", [0.0, 1.0], **SLIDING), longest_s=0.5)
    assert still.verdict == "none" and not still.large.squeals.any() and still.onset_time is None
    loud = branches(squeal_points(PLANT, "pressure", [18.0, 20.0], **SLIDING), longest_s=0.5)
    assert loud.verdict == "none" and loud.small.squeals.all()
    smooth = branches(
        squeal_points(PLANT, "pressure", [10.0, 20.0], mu=0.0, slope_s_m=0.0, **SLIDING), longest_s=0.5
    )
    assert smooth.verdict == "none" and not smooth.large.squeals.any()


def test_flutter_of_the_basic_brake_is_subcritical() -> None:
    """Squeal by mode coupling, once begun, lasts far below its onset: a single braking confirms it."""
    basic = load_brake(Path(__file__).parents[3] / "configs" / "brakes" / "basic.toml")
    fixed: dict[str, Any] = {"slope_s_m": 0.0, "pressure_bar": 10.0, **LINEAR}
    found = branches(
        squeal_points(basic, "mu", np.linspace(0.35, 0.7, 8), **fixed), longest_s=1.0, refinement=4
    )
    assert found.verdict == "subcritical" and not found.beyond
    assert found.onset_eigenvalues == pytest.approx(0.64, abs=0.01)
    assert found.fold is not None and found.fold < 0.45
    np.testing.assert_array_equal(found.small.squeals, found.mode.growth_1_s > 0.0)
    narrow = branches(squeal_points(basic, "mu", [0.5, 0.55, 0.6, 0.7], **fixed), longest_s=1.0)
    assert narrow.beyond and narrow.fold == 0.5

    def amplitude(mu: float, state: np.ndarray) -> float:
        single = SquealIntegrator(basic, outputs=["inner_pad:slip"])
        single.state = state
        force = basic.pad_force_n(10e5)
        y = single.advance(12_000, normal_force_n=(force, force), mu=(mu, mu), slip_m_s=(0.44, 0.44))
        return float(np.ptp(y[-2000:]) / 2.0)

    simulation = SquealSimulation(squeal_points(basic, "mu", [0.65], **fixed))
    loud = simulation.limit_cycles("large", longest_s=1.0)
    state = simulation.batch.states[0]
    assert amplitude(0.6, state) > 0.5 * loud.slip_amplitude_m_s[0]
    assert amplitude(0.6, 1e-3 * state) < 1e-6

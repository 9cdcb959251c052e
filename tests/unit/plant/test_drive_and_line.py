"""Drive train and pressure line: ramps, dips, stiction, limits, dead time, overshoot, play, venting."""

import numpy as np
import pytest
from plant_rig import MS, Rig, changed_settings, smooth


def _quiet(**changes):
    """Settings without sensor noise, to see the process."""
    sensors = {name: {"gain": 1.0, "offset": 0.0, "noise": 0.0} for name in ("pressure", "torque", "speed")}
    return changed_settings(
        sensors__pressure=sensors["pressure"],
        sensors__torque=sensors["torque"],
        sensors__speed=sensors["speed"],
        **changes,
    )


# -- drive ---------------------------------------------------------------------------------------------------


def test_speed_follows_the_ramp():
    rig = Rig(settings=_quiet())
    n = rig.run(2.0, speed_set_rpm=200.0, speed_ramp_rpm_per_s=50.0, drive_enabled=True, relay_closed=True)
    assert n["speed"][4000] == pytest.approx(50.0, abs=2.0)
    assert n["speed"][-1] == pytest.approx(100.0, abs=2.0)


@pytest.mark.parametrize("pressure_bar", [10.0, 30.0])
def test_speed_dips_at_brake_onset_and_recovers(pressure_bar):
    rig = Rig(settings=_quiet()).turn()
    rig.plant.set_condition(disc_degc=120.0, bedding=0.95)
    n = rig.run(1.5, pressure_set_bar=pressure_bar)["speed"]
    dip = 40.0 - n.min()
    assert 0.5 < dip < 2.2
    lowest = int(np.argmin(n))
    recovered = lowest + int(np.argmax(n[lowest:] > 40.0 - 0.1 * dip))
    assert 0.2 * 4000 < recovered < 0.7 * 4000  # from the command on, dead time included
    assert abs(n[-400:].mean() - 40.0) < 0.1


def test_brake_stops_the_disc_and_never_turns_it_backwards():
    rig = Rig(settings=_quiet()).turn(100.0)
    n = rig.run(3.0, drive_enabled=False, pressure_set_bar=20.0)["speed"]
    assert n.min() == 0.0
    assert rig.plant.truth.speed_rpm == 0.0
    angle = float(rig.plant._state["angle"][0])
    rig.run(0.5)
    assert float(rig.plant._state["angle"][0]) == angle
    assert rig.plant.truth.brake_torque_nm == pytest.approx(0.0, abs=1e-6)  # nothing pushes, so nothing holds


def test_brake_holds_the_disc_against_the_motor():
    """Stiction at n = 0: the motor may push up to its limit, the measured torque is what it pushes."""
    rig = Rig(settings=_quiet(drive__max_torque_nm=200.0))
    rig.run(1.0, pressure_set_bar=30.0, relay_closed=True)
    slow = rig.run(2.0, speed_set_rpm=40.0, drive_enabled=True)
    assert slow["speed"].max() == 0.0
    assert slow["torque"][-1] == pytest.approx(200.0 - 3.0, abs=1.0)
    rig.run(1.5, pressure_set_bar=0.0)
    assert rig.plant.truth.speed_rpm == pytest.approx(40.0, abs=1.0)


def test_power_and_torque_limits_hold():
    rig = Rig(settings=_quiet(drive__max_power_w=4000.0))
    rig.turn(200.0)
    rig.plant.set_condition(disc_degc=120.0, bedding=0.95)
    rig.run(3.0, pressure_set_bar=30.0)
    truth = rig.plant.truth
    assert truth.speed_rpm < 100.0  # stalls instead of delivering 13 kW
    assert truth.motor_torque_nm * truth.speed_rpm * 2 * np.pi / 60 < 4000.0 * 1.05 or truth.speed_rpm < 1.0
    assert truth.motor_torque_nm <= 1200.0


def test_disabled_drive_coasts_and_quick_stop_ramps():
    coasting = Rig(settings=_quiet()).turn(200.0)
    coasting.run(1.0, drive_enabled=False)
    quick = Rig(settings=_quiet()).turn(200.0)
    quick.run(1.0, quick_stop=True)
    assert 100.0 < coasting.plant.truth.speed_rpm < 195.0
    assert abs(coasting.plant.truth.motor_torque_nm) < 1e-6
    assert quick.plant.truth.speed_rpm < 0.5
    quick.run(0.5)
    assert abs(quick.plant.truth.motor_torque_nm) < 1e-3  # torque off after the stop
    coasting.run(20.0, full_rate=False, block_ms=500)
    assert coasting.plant.truth.speed_rpm == 0.0


def test_drive_needs_the_relay():
    rig = Rig()
    rig.run(1.0, speed_set_rpm=40.0, drive_enabled=True, relay_closed=False)
    assert rig.plant.truth.speed_rpm == 0.0 and not rig.plant.truth.relay_closed


def test_open_relay_takes_torque_and_pressure_within_a_second():
    rig = Rig().turn(200.0)
    rig.run(2.0, pressure_set_bar=40.0)
    assert rig.plant.truth.pressure_bar > 35.0
    rig.run(0.05, relay_closed=False)
    assert abs(rig.plant.truth.motor_torque_nm) < 1.0
    rig.run(0.95)
    assert rig.plant.truth.pressure_bar < 1.0
    rig.run(10.0, full_rate=False, block_ms=500)
    assert rig.plant.truth.speed_rpm == 0.0 and rig.plant.truth.pressure_bar < 0.05


# -- pressure line -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("target_bar", [5.0, 20.0, 38.0])
def test_pressure_step_has_dead_time_rise_and_overshoot(target_bar):
    rig = Rig(settings=_quiet(pressure__ripple_bar=0.0, pressure__hysteresis_bar=0.0)).turn()
    p = rig.run(2.5, pressure_set_bar=target_bar)["pressure"]
    moved = np.argmax(p > 0.001 * target_bar) / 4000
    assert 0.02 <= moved <= 0.05
    rise = (np.argmax(p > 0.9 * target_bar) - np.argmax(p > 0.1 * target_bar)) / 4000
    assert 0.2 <= rise <= 0.5
    assert 0.03 <= p.max() / target_bar - 1.0 <= 0.10
    assert p[-1] == pytest.approx(target_bar, rel=2e-3)
    down = rig.run(3.0, pressure_set_bar=0.0)["pressure"]
    fall = (np.argmax(down < 0.1 * target_bar) - np.argmax(down < 0.9 * target_bar)) / 4000
    assert 1.3 <= fall / rise <= 2.0
    assert down[-1] < 0.02


def test_pressure_stays_below_the_physical_limit():
    rig = Rig(settings=_quiet(pressure__ripple_bar=0.0))
    p = rig.run(2.0, pressure_set_bar=100.0, relay_closed=True)["pressure"]
    assert 40.0 < p.max() <= 44.0 + 1e-4


def test_seal_friction_makes_a_hysteresis():
    rig = Rig(settings=_quiet(pressure__ripple_bar=0.0, pressure__damping_ratio=1.5), seed=1).turn()
    rig.run(4.0, pressure_set_bar=20.0)
    from_below = rig.plant.truth.pressure_bar
    rig.run(3.0, pressure_set_bar=25.0)
    rig.run(5.0, pressure_set_bar=20.0)
    assert rig.plant.truth.pressure_bar - from_below == pytest.approx(0.3, abs=0.02)


def test_thickness_variation_makes_a_ripple_once_a_turn():
    rig = Rig(settings=_quiet()).turn(120.0)
    rig.run(2.0, pressure_set_bar=20.0)
    p = rig.run(4.0)["pressure"].astype(float)
    spectrum = np.abs(np.fft.rfft(p - p.mean())) * 2 / len(p)
    assert np.argmax(spectrum) / 4.0 == pytest.approx(2.0)  # 120 1/min
    assert 0.05 <= spectrum.max() <= 0.3


def test_vent_overrides_the_set_point_until_it_is_taken_back():
    rig = Rig().turn()
    rig.run(1.5, pressure_set_bar=20.0)
    rig.run(0.8, vent=True)
    assert rig.plant.truth.pressure_bar < 0.5
    rig.run(1.5, vent=False)
    assert rig.plant.truth.pressure_bar == pytest.approx(20.0, abs=0.6)


def test_set_points_queue_in_the_dead_time():
    """Set-points that change faster than the dead time are obeyed in order, not dropped."""
    rig = Rig(settings=_quiet(pressure__dead_time_s=0.05, pressure__ripple_bar=0.0))
    courses = []
    for k in range(60):
        step = rig.plant.step(10 * MS, _pressed(rig, 10.0 + 10.0 * (k % 2)), full_rate=True)
        courses.append(step.samples["pressure"])
    p = np.concatenate(courses)
    assert p[: int(0.05 * 4000)].max() < 1e-6
    assert smooth(p, 400)[-1] == pytest.approx(15.0, abs=1.5)


def _pressed(rig, pressure_bar):
    from dataclasses import replace

    return replace(rig.commands, relay_closed=True, pressure_set_bar=pressure_bar)

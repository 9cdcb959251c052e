"""Plant loop of the bench, step by step without a clock: signals in, samples out; the loop's time keeping."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pytest

from rigctl.config.loading import load_model
from sim_hardware.bench.plant_loop import SAMPLES, STEP_NS, PlantLoop
from sim_hardware.bench.signals import NS_PER_MS, RigSignals
from sim_hardware.brake_model import load_brake
from sim_hardware.plant import Commands, Plant, PlantSettings, SoundJob, behind_relay

ROOT = Path(__file__).parents[3]
RUN = {
    "speed_set_rpm": 300.0, "speed_ramp_rpm_per_s": 2000.0, "drive_enabled": True, "vent": False,
    "relay_closed": True,
}  # fmt: skip


@pytest.fixture
def plant() -> Plant:
    settings = load_model(ROOT / "configs/plants/a_class.toml", PlantSettings)
    return Plant(settings, load_brake(ROOT / "configs/brakes/plant.toml"), seed=3)


class Stepper:
    """A loop whose steps the test makes."""

    def __init__(self, plant: Plant) -> None:
        self.signals = RigSignals()
        self.jobs: list[SoundJob] = []
        self.loop = PlantLoop(plant, self.signals, sound=self.jobs.append)
        self.now_ns = 1_000 * STEP_NS

    def go(self, seconds: float) -> None:
        for _ in range(round(seconds / (1e-9 * STEP_NS))):
            self.now_ns += STEP_NS
            self.loop.step(self.now_ns)

    def course(self, name: str, milliseconds: int) -> np.ndarray:
        first = self.now_ns - milliseconds * NS_PER_MS
        return np.array([self.signals.at(name, first + i * NS_PER_MS) for i in range(milliseconds)])


def test_position_is_smooth_and_its_rate_is_the_speed(plant: Plant) -> None:
    rig = Stepper(plant)
    rig.signals.set(**RUN)
    rig.go(2.0)
    positions, speeds = rig.course("position_turns", 1900), rig.course("speed_rpm", 1900)
    rates_rpm = np.diff(positions) * 60_000.0
    assert np.all(rates_rpm >= 0.0)
    assert np.max(np.abs(rates_rpm - 0.5 * (speeds[1:] + speeds[:-1]))) < 3.0  # ramp of 2 1/min per ms, noise
    assert positions[-1] > 8.0  # many turns: the wrap of the plant's angle does not show


def test_torque_and_pressure_of_a_braking(plant: Plant) -> None:
    rig = Stepper(plant)
    rig.signals.set(**RUN)
    rig.go(0.5)
    rig.signals.set(pressure_set_bar=10.0)
    rig.go(1.0)
    assert rig.signals.newest("pressure_bar") == pytest.approx(10.0, abs=0.6)
    assert rig.signals.newest("regulator_pressure_bar") == pytest.approx(10.0, abs=0.6)
    assert rig.signals.newest("torque_nm") > 100.0
    assert rig.signals.newest("motor_torque_nm") > 100.0
    assert rig.signals.newest("drive_speed_rpm") == pytest.approx(300.0, rel=0.02)


@pytest.mark.parametrize("lost", ["relay_closed", "estop_ok", "doors_ok"])
def test_open_chain_takes_torque_and_pressure_away(plant: Plant, lost: str) -> None:
    rig = Stepper(plant)
    rig.signals.set(**RUN, pressure_set_bar=10.0)
    rig.go(1.0)
    rig.signals.set(**{lost: False})
    rig.go(1.0)
    assert rig.signals.newest("pressure_bar") < 0.5
    assert rig.signals.newest("motor_torque_nm") < 1.0
    assert plant.truth.ventilator_m3_h > 0.7 * plant.ventilator_max_m3_h
    assert not plant.truth.relay_closed


def test_every_step_gives_ten_samples_and_a_sound_job(plant: Plant) -> None:
    rig = Stepper(plant)
    rig.go(0.1)
    assert len(rig.jobs) == 10
    assert all(ticks == 40 for _, ticks, _ in rig.jobs)
    values = rig.course("torque_nm", 10 * SAMPLES)
    assert len(np.unique(values)) > 9 * SAMPLES  # each millisecond has a reading of its own


def test_same_seed_same_samples() -> None:
    courses = []
    for _ in range(2):
        settings = load_model(ROOT / "configs/plants/a_class.toml", PlantSettings)
        rig = Stepper(Plant(settings, load_brake(ROOT / "configs/brakes/plant.toml"), seed=9))
        rig.signals.set(**RUN)
        rig.go(0.3)
        courses.append(rig.course("torque_nm", 300))
    assert np.array_equal(*courses)


def test_behind_relay_keeps_set_points_when_closed() -> None:
    wanted = Commands(speed_set_rpm=10.0, drive_enabled=True, pressure_set_bar=5.0, ventilator_m3_h=7.0)
    closed = behind_relay(wanted, closed=True, ventilator_max_m3_h=1000.0)
    opened = behind_relay(wanted, closed=False, ventilator_max_m3_h=1000.0)
    assert (closed.drive_enabled, closed.vent, closed.ventilator_m3_h) == (True, False, 7.0)
    assert (opened.drive_enabled, opened.vent, opened.ventilator_m3_h) == (False, True, 1000.0)


def test_thread_keeps_to_the_clock_and_catches_up(plant: Plant) -> None:
    pause_s = 0.12
    calls: list[int] = []

    def slow_once(_job: SoundJob) -> None:
        calls.append(time.monotonic_ns())
        if len(calls) == 5:
            time.sleep(pause_s)

    loop = PlantLoop(plant, RigSignals(), sound=slow_once)
    started = time.monotonic()
    loop.start()
    time.sleep(0.6)
    loop.stop()
    elapsed_s = time.monotonic() - started
    assert loop.counts()["given_up"] == 0
    # no step is left out: as many as the time holds (the last may still be due), in spite of the pause
    assert elapsed_s / 0.01 - 12 <= len(calls) <= elapsed_s / 0.01 + 1
    assert np.max(np.diff(calls)) * 1e-9 >= pause_s


def test_failure_is_reported_once(plant: Plant) -> None:
    failures: list[BaseException] = []
    signals = RigSignals()
    loop = PlantLoop(plant, signals, failed=failures.append)
    signals.set(speed_set_rpm=float("nan"))
    loop.start()
    deadline = time.monotonic() + 5.0
    while not failures and time.monotonic() < deadline:
        time.sleep(0.01)
    loop.stop()
    assert len(failures) == 1
    assert "finite" in str(failures[0])

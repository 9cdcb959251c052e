"""Cost of the simulated rig per step and per run.

Run by hand: `python tests/benchmarks/bench_plant.py`. Prints best and median of many repetitions and, as the
error of the cheap monitoring step, its difference from the same run at full rate.
"""

import time
import tomllib
from dataclasses import replace
from pathlib import Path

from sim_hardware.brake_model import load_brake
from sim_hardware.plant import Commands, Plant, PlantSettings

CONFIGS = Path(__file__).resolve().parents[2] / "configs"
MS = 1_000_000
BLOCKS_225 = 225 * 13 * 20  # 225 brakings of 12 s with half a second before and after
BLOCKS_CONDITIONING = 10 * 3600 * 2


def microseconds(call, repetitions=400):
    """Best and median of one call."""
    times = []
    for _ in range(repetitions):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    times.sort()
    return times[0] * 1e6, times[len(times) // 2] * 1e6


def _median(times):
    return sorted(times)[len(times) // 2]


def main():
    settings = PlantSettings.model_validate(tomllib.loads((CONFIGS / "plants" / "a_class.toml").read_text()))
    brake = load_brake(CONFIGS / "brakes" / "plant.toml")
    plant = Plant(settings, brake, seed=1)
    start = time.perf_counter()
    plant.compile()
    print(f"kernels compiled or loaded in {time.perf_counter() - start:.1f} s")
    turn = Commands(speed_set_rpm=40.0, speed_ramp_rpm_per_s=100.0, drive_enabled=True, relay_closed=True)
    costs = {}
    for label, pressure_bar in (
        ("open", 0.0),
        ("8 bar", 8.0),
        ("15 bar, squeal", 15.0),
        ("30 bar, squeal", 30.0),
    ):
        commands = replace(turn, pressure_set_bar=pressure_bar)
        for _ in range(60):
            plant.set_condition(disc_degc=140.0, bedding=0.9)
            plant.step(50 * MS, commands, full_rate=True)
            plant.render_sound()
        step, sound = [], []
        for _ in range(200):
            start = time.perf_counter()
            plant.step(50 * MS, commands, full_rate=True)
            middle = time.perf_counter()
            plant.render_sound()
            step.append(middle - start)
            sound.append(time.perf_counter() - middle)
        costs[label] = (_median(step) + _median(sound)) * 1e6
        best, median = (f"{pick(step) * 1e6:5.0f} + {pick(sound) * 1e6:5.0f}" for pick in (min, _median))
        print(
            f"50 ms block, {label:15s}: slow physics + sound, best {best} us, median {median} us, "
            f"{0.05e6 / costs[label]:.0f} x real time"
        )
    best, median = microseconds(lambda: plant.step(500 * MS, turn, full_rate=False))
    print(f"0.5 s monitoring step: {best:.0f} / {median:.0f} us, {0.5e6 / median:.0f} x real time")
    total_s = (
        0.5 * (costs["8 bar"] + costs["15 bar, squeal"]) * BLOCKS_225 + median * BLOCKS_CONDITIONING
    ) * 1e-6
    print(f"225 brakings of 13 s and 10 h of conditioning: about {total_s:.0f} s on one core")
    print(f"error of the monitoring step: {_error(settings, brake)}")


def _error(settings, brake):
    truths = []
    for full_rate in (True, False):
        plant = Plant(settings, brake, seed=1)
        for speed_rpm, pressure_bar in ((200.0, 0.0), (200.0, 10.0), (40.0, 0.0)):
            commands = Commands(
                speed_set_rpm=speed_rpm, speed_ramp_rpm_per_s=100.0, drive_enabled=True,
                pressure_set_bar=pressure_bar, relay_closed=True,
            )  # fmt: skip
            for _ in range(60):
                plant.step(500 * MS, commands, full_rate=full_rate)
        truths.append(plant.truth)
    fine, coarse = truths
    return (
        f"{coarse.surface_degc - fine.surface_degc:+.4f} K after heating to {fine.surface_degc:.0f} degC, "
        f"friction work {coarse.friction_energy_j / fine.friction_energy_j - 1:+.1e}"
    )


if __name__ == "__main__":
    main()

"""Batch of brakings against one braking at a time and against Exudyn; run by hand: python
tests/benchmarks/bench_batch.py

Squeal of the plant at 20 bar (saturating law), 40 kHz output, rms and frequency of a weighted sum of outputs.
Times real time are summed over the lanes of one core. All are measured in turns within the same minutes, by
processor time (wall clock beside it: other load on the machine shows there). Beside every time: the squeal's
frequency and level against 640 kHz over 0.25 s, and the largest velocity error over 5 ms against DOP853 at
rtol 1e-10.
Exudyn is measured where the interpreter has it (`exudyn_brake` says how, and how its friction is modelled).
"""

from __future__ import annotations

import math
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import exudyn_brake

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.friction import SaturatingFriction
from sim_hardware.brake_model.time_domain.batch import BatchIntegrator
from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator
from sim_hardware.brake_model.time_domain.reference import WorkingPoint, motion

PLANT = load_brake(Path(__file__).parents[2] / "configs" / "brakes" / "plant.toml")
BAR, MU, K, SLIP, SATURATION = 20.0, 0.4, 0.0576, 0.44, 0.01
FORCE = PLANT.pad_force_n(BAR * 1e5)
POINT: dict[str, Any] = {
    "normal_force_n": FORCE,
    "mu": MU,
    "slip_m_s": SLIP,
    "k_s_m": K,
    "saturation_m_s": SATURATION,
}
PAIRS: dict[str, Any] = {k: (v, v) if k != "saturation_m_s" else v for k, v in POINT.items()}
REVERSING: dict[str, Any] = {"slip_m_s": 0.02, "saturation_m_s": None}
RATE, ROUNDS = 40_000, 9
OUTPUTS = ["disc.y", "disc.x", "inner_pad.y", "outer_pad.y"]
ONES = [1.0] * len(OUTPUTS)
VELOCITIES = [f"{name}:velocity" for name in PLANT.freedoms]


def limit_cycle() -> np.ndarray:
    """A state on the limit cycle."""
    warm = SquealIntegrator(PLANT, substeps=8, outputs=())
    warm.state = np.concatenate([np.zeros(PLANT.n_dof), np.full(PLANT.n_dof, 1e-3)])
    warm.advance(60_000, **PAIRS)
    return warm.state


def line(signal: np.ndarray) -> tuple[float, float]:
    """Frequency (Hz) and level (dB) of the strongest line."""
    spectrum = np.abs(np.fft.rfft(signal * np.blackman(len(signal)), 1 << 20))
    i = int(spectrum.argmax())
    a, b, c = np.log(spectrum[i - 1 : i + 2])
    return (i + 0.5 * (a - c) / (a - 2 * b + c)) * RATE / (1 << 20), 20.0 * math.log10(signal.std())


def batch_run(
    lanes: int, start: np.ndarray, *, own: bool = False, push: bool = False, **other: Any
) -> Callable[[], float]:
    """A batch that simulates 0.1 s of every lane per call and returns the simulated seconds."""
    batch = BatchIntegrator([PLANT] * lanes if own else PLANT, lanes, outputs=OUTPUTS, weights=ONES)
    batch.states = start * np.linspace(0.8, 1.2, lanes)[:, None]
    noise = np.random.default_rng(0).normal(size=(4000, 2)) if push else None

    def run() -> float:
        batch.observe(4000, **(POINT | other), excitation_n=noise)
        return 0.1 * lanes

    return run


def single_run(start: np.ndarray, **other: Any) -> Callable[[], float]:
    """One braking, 0.1 s per call."""
    integrator = SquealIntegrator(PLANT, outputs=OUTPUTS, weights=ONES)
    integrator.state = start
    pairs: dict[str, Any] = PAIRS | {k: (v, v) if k != "saturation_m_s" else v for k, v in other.items()}

    def run() -> float:
        integrator.advance(4000, **pairs)
        return 0.1

    return run


def clocked(run: Callable[[], float]) -> tuple[float, float]:
    """Times real time by wall clock and by processor time."""
    wall, processor = time.perf_counter(), time.process_time()
    simulated = run()
    return simulated / (time.perf_counter() - wall), simulated / (time.process_time() - processor)


def exudyn_runs(
    start: np.ndarray, rates: dict[str, list[tuple[float, float]]]
) -> list[tuple[str, Callable[[], None]]]:
    """Exudyn's runs, which note their own times real time: the solver alone, without assembling."""
    made = []
    for name, friction, method, hz in (
        ("Exudyn alpha 160 kHz", "symbolic", "alpha", 160e3),
        ("Exudyn RK4 80 kHz", "symbolic", "rk4", 80e3),
        ("Exudyn alpha, no friction", "none", "alpha", 160e3),
    ):
        model = exudyn_brake.ExudynBrake(
            PLANT, pad_force_n=FORCE, mu=MU, k_s_m=K, saturation_m_s=SATURATION, friction=friction
        )

        def run(model: Any = model, method: str = method, hz: float = hz, name: str = name) -> None:
            _, (wall, processor) = model.simulate(start, 0.02, hz, method=method)
            rates.setdefault(name, []).append((0.02 / wall, 0.02 / processor))

        made.append((name, run))
    return made


def errors(start: np.ndarray) -> dict[str, str]:
    """Frequency, level and velocity errors of what the runs do."""
    law = SaturatingFriction(mu_mean=MU, k_s_m=K, saturation_m_s=SATURATION)
    grid = np.arange(200) / RATE
    tight = motion(PLANT, WorkingPoint(FORCE, SLIP, law), start, grid)[:, PLANT.n_dof :]
    n = RATE // 4
    at = PLANT.freedom_index("inner_pad.x")

    def report(velocities: np.ndarray, columns: list[int], finest: tuple[float, float]) -> str:
        frequency, level = line(velocities[:n, columns.index(at)])
        error = np.abs(velocities[: len(grid)] - tight[:, columns]).max() / np.abs(tight).max()
        return f"{frequency - finest[0]:+10.4f} Hz {level - finest[1]:+9.4f} dB   {error:.1e}"

    def one(substeps: int) -> np.ndarray:
        integrator = SquealIntegrator(PLANT, substeps=substeps, outputs=VELOCITIES)
        integrator.state = start
        return integrator.advance(n, **PAIRS)

    every = list(range(PLANT.n_dof))
    finest = line(one(16)[:, at])
    batch = BatchIntegrator(PLANT, 8, outputs=VELOCITIES)
    batch.states = start
    found = {
        "single": report(one(1), every, finest),
        "batch": report(batch.advance(n, **POINT)[:, 5], every, finest),
    }
    if exudyn_brake.exu is not None:
        for name, method, hz in (
            ("Exudyn alpha 160 kHz", "alpha", 160e3),
            ("Exudyn RK4 80 kHz", "rk4", 80e3),
        ):
            model = exudyn_brake.ExudynBrake(
                PLANT, pad_force_n=FORCE, mu=MU, k_s_m=K, saturation_m_s=SATURATION
            )
            velocities, _ = model.simulate(start, 0.2502, hz, method=method)
            found[name] = report(velocities, model.seen, finest)
    return found


def main() -> None:
    """Print the table."""
    start = limit_cycle()
    begin = time.perf_counter()
    runs = {
        "single": single_run(start),
        "batch 8 lanes": batch_run(8, start),
        "batch 64 lanes": batch_run(64, start),
        "batch 256 lanes": batch_run(256, start),
        "batch 64, own brakes": batch_run(64, start, own=True),
        "batch 64, excited": batch_run(64, start, push=True),
        "single, slip reverses": single_run(start, **REVERSING),
        "batch 64, slip reverses": batch_run(64, start, **REVERSING),
    }
    for run in runs.values():
        run()
    print(f"ready after {time.perf_counter() - begin:.1f} s (kernels compiled, or loaded from numba's cache)")
    found = errors(start)
    rates: dict[str, list[tuple[float, float]]] = {}
    peers = exudyn_runs(start, rates) if exudyn_brake.exu is not None else []
    for _ in range(ROUNDS):
        for name, run in runs.items():
            rates.setdefault(name, []).append(clocked(run))
        for _, peer in peers:
            peer()
    base = statistics.median(processor for _, processor in rates["single"])
    print(
        "\n                           x real time, one core          to    squeal error        velocity error"
    )
    print(
        "                           processor  best   wall clock  single  frequency     level  5 ms, relative"
    )
    for name, pairs in rates.items():
        wall, processor = (statistics.median(values) for values in zip(*pairs, strict=True))
        error = found.get(name) or (found["batch"] if name in ("batch 64 lanes", "batch 8 lanes") else "")
        best = max(p for _, p in pairs)
        print(f"{name:26s} {processor:8.3g} {best:7.3g} {wall:10.3g}   {processor / base:7.4f}  {error}")
    if not peers:
        print(f"\n{exudyn_brake.HOW_TO_INSTALL}")
        return
    peer = statistics.median(processor for _, processor in rates["Exudyn alpha 160 kHz"])
    bare = statistics.median(processor for _, processor in rates["Exudyn alpha, no friction"])
    many = statistics.median(processor for _, processor in rates["batch 64 lanes"])
    print(f"\nsingle / Exudyn (alpha, 160 kHz): {base / peer:.0f}; without friction there: {base / bare:.0f}")
    print(f"batch  / Exudyn (alpha, 160 kHz): {many / peer:.0f}")


if __name__ == "__main__":
    main()

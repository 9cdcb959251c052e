"""Speed and error of the brake model's time integration; run by hand: python
tests/benchmarks/bench_brake_model.py

Squeal of the plant at 20 bar, blocks of 50 ms, a weighted sum of four outputs, roughness excitation: times
real time and nanoseconds per internal step (median and best of the blocks, one core), with the squeal's
frequency and level error against 640 kHz, the largest velocity error over 5 ms of limit cycle against DOP853
at rtol 1e-10, and general-purpose integrators as peers. Other load on the machine slows the medians: look at
ratios.
"""

import math
import time
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.friction import SaturatingFriction
from sim_hardware.brake_model.stability import predict
from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator, compile_kernels
from sim_hardware.brake_model.time_domain.reference import ReferenceModel, WorkingPoint, motion

PLANT = load_brake(Path(__file__).parents[2] / "configs" / "brakes" / "plant.toml")
BAR, MU, K, SLIP, SATURATION = 20.0, 0.4, 0.0576, 0.44, 0.01
FORCE = PLANT.pad_force_n(BAR * 1e5)
POINT = {
    "normal_force_n": (FORCE, FORCE),
    "mu": (MU, MU),
    "slip_m_s": (SLIP, SLIP),
    "k_s_m": (K, K),
    "saturation_m_s": SATURATION,
}
RATE, BLOCK = 40_000, 2000
OUTPUTS = ["disc.y", "disc.x", "inner_pad.y", "outer_pad.y"]


def squeal(substeps: int, start: np.ndarray) -> tuple[float, float]:
    """Frequency and level of the pad's slip over 0.25 s."""
    integrator = SquealIntegrator(PLANT, substeps=substeps, outputs=["inner_pad:slip"])
    integrator.state = start
    signal = integrator.advance(RATE // 4, **POINT)[:, 0]
    spectrum = np.abs(np.fft.rfft(signal * np.blackman(len(signal)), 1 << 20))
    i = int(spectrum.argmax())
    a, b, c = np.log(spectrum[i - 1 : i + 2])
    return (i + 0.5 * (a - c) / (a - 2 * b + c)) * RATE / (1 << 20), 20.0 * math.log10(signal.std())


def block_times(
    start: np.ndarray, substeps: int, slip: float = SLIP, saturation: float | None = SATURATION
) -> np.ndarray:
    """Seconds for each of 60 blocks of 50 ms."""
    integrator = SquealIntegrator(PLANT, substeps=substeps, outputs=OUTPUTS, weights=[1.0] * len(OUTPUTS))
    integrator.state = start
    push = np.random.default_rng(0).normal(size=(BLOCK, 2))
    point = POINT | {"slip_m_s": (slip, slip), "saturation_m_s": saturation}
    times = np.zeros(60)
    for i in range(len(times)):
        begin = time.perf_counter()
        integrator.advance(BLOCK, **point, excitation_n=push)
        times[i] = time.perf_counter() - begin
    return times


def main() -> None:
    """Print the table."""
    begin = time.perf_counter()
    compile_kernels(PLANT)
    print(f"kernels ready after {time.perf_counter() - begin:.2f} s (compiled, or loaded from numba's cache)")
    warm = SquealIntegrator(PLANT, substeps=8, outputs=())
    warm.state = np.concatenate([np.zeros(PLANT.n_dof), np.full(PLANT.n_dof, 1e-3)])
    warm.advance(60_000, **POINT)
    start = warm.state
    law = SaturatingFriction(mu_mean=MU, k_s_m=K, saturation_m_s=SATURATION)
    point = WorkingPoint(FORCE, SLIP, law)
    grid = np.arange(200) / RATE
    tight = motion(PLANT, point, start, grid)[:, PLANT.n_dof :]
    finest = squeal(16, start)
    print(f"squeal at {BAR:g} bar: {finest[0]:.3f} Hz\n")
    print("ours          x real time      ns/step        squeal error              velocity error")
    print("internal kHz  median   best    median  best   frequency Hz   level dB   5 ms, relative")
    for substeps in (1, 2, 4, 8):
        times = block_times(start, substeps)
        frequency, level = squeal(substeps, start)
        integrator = SquealIntegrator(
            PLANT, substeps=substeps, outputs=[f"{f}:velocity" for f in PLANT.freedoms]
        )
        integrator.state = start
        error = np.abs(integrator.advance(len(grid), **POINT) - tight).max() / np.abs(tight).max()
        per_step = times / (BLOCK * substeps) * 1e9
        print(
            f"{RATE * substeps / 1000:12.0f}  {0.05 / np.median(times):6.1f} {0.05 / times.min():6.1f}  "
            f"{np.median(per_step):7.1f} {per_step.min():6.1f}  {frequency - finest[0]:+12.4f}  "
            f"{level - finest[1]:+9.4f}   {error:.1e}"
        )
    times = block_times(start, 1, slip=0.02, saturation=None)
    print(
        f"with slip reversal in every cycle (0.02 m/s, linear law), 40 kHz: "
        f"{0.05 / np.median(times):.1f} x real time"
    )
    print("\npeers, numpy right-hand side, rtol 1e-6")
    for method in ("RK45", "DOP853", "LSODA"):
        model = ReferenceModel(PLANT, point)
        begin = time.perf_counter()
        solution = solve_ivp(model, (0.0, grid[-1]), start, method=method, t_eval=grid, rtol=1e-6, atol=1e-12)
        seconds = time.perf_counter() - begin
        error = np.abs(solution.y[PLANT.n_dof :].T - tight).max() / np.abs(tight).max()
        print(
            f"{method:12s}  {grid[-1] / seconds:.4f} x real time, velocity error {error:.1e}, "
            f"{model.evaluations} calls"
        )
    begin = time.perf_counter()
    predict(PLANT)
    milliseconds = (time.perf_counter() - begin) * 1e3
    print(f"\nstability over 0 to 25 bar (101 pressures, onset refined): {milliseconds:.0f} ms")


if __name__ == "__main__":
    main()

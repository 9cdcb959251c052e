"""Speed and error of the integration with events; run by hand: python tests/benchmarks/bench_motion.py

Growing squeal that slides forwards (peers: scipy's DOP853 and RK45 with a numpy right-hand side), a limit
cycle by sticking (peer: our fixed-rate integrator), one-sided contacts that lift off (peer: scipy's DOP853
without events on the kinked force), and the whole of Fig. 11. Each time stands beside its error against rtol
1e-12.
"""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.friction import ConstantFriction, LinearFriction, SaturatingFriction
from sim_hardware.brake_model.spec import BrakeSpec
from sim_hardware.brake_model.time_domain.energy import decays
from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator
from sim_hardware.brake_model.time_domain.motion import integrate
from sim_hardware.brake_model.time_domain.reference import ReferenceModel, WorkingPoint

BRAKES = Path(__file__).parents[2] / "configs" / "brakes"
PLANT, MODEL = load_brake(BRAKES / "plant.toml"), load_brake(BRAKES / "model.toml")
N, RATE = PLANT.n_dof, 40_000.0


def kicked(speed_m_s: float) -> np.ndarray:
    state = np.zeros(2 * N)
    state[N + PLANT.freedom_index("inner_pad.x")] = speed_m_s
    return state


def timed(run: Callable[[], Any], repeats: int = 3) -> tuple[float, Any]:
    """Best time of some, and the result."""
    best, result = np.inf, None
    for _ in range(repeats):
        begin = time.perf_counter()
        result = run()
        best = min(best, time.perf_counter() - begin)
    return best, result


def velocity_error(states: np.ndarray, exact: np.ndarray) -> float:
    return float(np.abs(states[:, N:] - exact[:, N:]).max() / np.abs(exact[:, N:]).max())


def line(name: str, seconds: float, simulated_s: float, error: float, steps: object, ours_s: float) -> None:
    print(
        f"  {name:44s} {1e3 * seconds:9.2f} ms  {simulated_s / seconds:8.3f} x real time  error {error:.1e}  "
        f"{steps!s:>7} steps  {seconds / ours_s:8.1f} x our time"
    )


def sliding() -> None:
    """Forward sliding, 10 ms."""
    point = WorkingPoint(
        PLANT.pad_force_n(20e5), 0.44, SaturatingFriction(mu_mean=0.4, k_s_m=0.0576, saturation_m_s=0.01)
    )
    times, start = np.arange(400) / RATE, kicked(1e-3)
    exact = integrate(PLANT, point, start, times, rtol=1e-12, atol_m=1e-19).states
    print("squeal that slides forwards, 10 ms:")
    ours = 0.0
    for rtol in (1e-8, 1e-10):
        seconds, motion = timed(
            lambda rtol=rtol: integrate(PLANT, point, start, times, rtol=rtol, atol_m=1e-16)
        )
        ours = ours or seconds
        error = velocity_error(motion.states, exact)
        line(f"ours, rtol {rtol:g}", seconds, times[-1], error, motion.steps, ours)
    for method in ("DOP853", "RK45"):
        model = ReferenceModel(PLANT, point)
        seconds, found = timed(
            lambda method=method, model=model: solve_ivp(
                model, (0.0, times[-1]), start, method=method, t_eval=times, rtol=1e-8, atol=1e-14
            ),
            1,
        )
        error = velocity_error(found.y.T, exact)
        line(f"scipy {method}, numpy, rtol 1e-8", seconds, times[-1], error, found.nfev, ours)


def sticking() -> None:
    """Limit cycle by sticking, 50 ms."""
    load = PLANT.pad_force_n(20e5)
    point = WorkingPoint(load, 0.02, LinearFriction(mu_mean=0.4, k_s_m=0.0576))
    long = np.array([0.0, 0.2])
    start = integrate(PLANT, point, kicked(0.015), long).states[-1]
    times = np.arange(2000) / RATE
    exact = integrate(PLANT, point, start, times, rtol=1e-12, atol_m=1e-19)
    print(f"limit cycle by sticking, 50 ms, {len(exact.events)} events:")
    seconds, motion = timed(lambda: integrate(PLANT, point, start, times))
    ours = seconds
    line(
        "ours, rtol 1e-8", seconds, times[-1], velocity_error(motion.states, exact.states), motion.steps, ours
    )
    for substeps in (1, 8):
        fast = SquealIntegrator(PLANT, outputs=[f"{f}:velocity" for f in PLANT.freedoms], substeps=substeps)

        def run(fast: SquealIntegrator = fast) -> np.ndarray:
            fast.state = start
            return fast.advance(
                2000, normal_force_n=(load,) * 2, mu=(0.4,) * 2, slip_m_s=(0.02,) * 2, k_s_m=(0.0576,) * 2
            )

        run()
        seconds, velocities = timed(run)
        error = float(np.abs(velocities - exact.states[:, N:]).max() / np.abs(exact.states[:, N:]).max())
        line(f"fixed rate, {40 * substeps} kHz", seconds, times[-1], error, 2000 * substeps, ours)


def one_sided() -> Brake:
    data = PLANT.spec.model_dump()
    for coupling in data["couplings"]:
        if coupling["kind"] == "contact":
            coupling["one_sided"] = True
    return Brake(BrakeSpec.model_validate(data))


def lifting() -> None:
    """Pads that lift off, constant friction at high sliding speed, 5 ms."""
    brake = one_sided()
    load = brake.pad_force_n(0.5e5)
    point = WorkingPoint(load, 10.0, ConstantFriction(mu_mean=0.4))
    times = np.arange(200) / RATE
    start = np.zeros(2 * N)
    start[N + brake.freedom_index("disc.y")] = 0.3
    exact = integrate(brake, point, start, times, rtol=1e-12, atol_m=1e-19)
    print(f"pads that lift off, 5 ms, {len(exact.events)} events:")
    seconds, motion = timed(lambda: integrate(brake, point, start, times))
    ours = seconds
    line(
        "ours, rtol 1e-8", seconds, times[-1], velocity_error(motion.states, exact.states), motion.steps, ours
    )

    def rate(_: float, y: np.ndarray) -> np.ndarray:
        acceleration = brake.accelerations(y[:N], y[N:], lambda c, v, force: 0.4 * force, pad_force_n=load)
        return np.concatenate([y[N:], acceleration])

    seconds, found = timed(
        lambda: solve_ivp(
            rate, (0.0, times[-1]), start, method="DOP853", t_eval=times, rtol=1e-8, atol=1e-14
        ),
        1,
    )
    error = velocity_error(found.y.T, exact.states)
    line("scipy DOP853, loop over couplings, no events", seconds, times[-1], error, found.nfev, ours)


def figure_11() -> None:
    """All 14 modes, linear and four strengths."""
    seconds, found = timed(lambda: decays(MODEL), 2)
    tight = decays(MODEL, rtol=1e-11)
    error = max(
        float(np.abs(a.rates_1_s / b.rates_1_s - 1.0).max()) for a, b in zip(found, tight, strict=True)
    )
    simulated = sum(5.0 * d.times_s[-1] for d in found)
    print(
        f"Fig. 11, {5 * len(found)} motions of {1e3 * simulated:.0f} ms in all: {seconds:.2f} s, "
        f"rates within {error:.1e}"
    )


def main() -> None:
    """Print all."""
    begin = time.perf_counter()
    integrate(PLANT, WorkingPoint(1.0, 1.0, ConstantFriction(mu_mean=0.4)), np.zeros(2 * N), [0.0, 1e-5])
    print(f"steps ready after {time.perf_counter() - begin:.1f} s (compiled, or loaded from numba's cache)")
    for part in (sliding, sticking, lifting, figure_11):
        part()


if __name__ == "__main__":
    main()

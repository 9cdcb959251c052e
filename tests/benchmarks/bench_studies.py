"""Long studies: cost of the runner, scaling with workers, scatter and optimisation against scipy's ways,
with errors.

    python tests/benchmarks/bench_studies.py [--samples N]

Peers in the same run: concurrent.futures' process pool task by task (runner), a plain loop of
`stability.onset_*` with validated brakes (scatter), scipy's differential evolution and SLSQP with finite
differences (optimisation). Run by hand on a quiet machine; ratios are meant, not seconds.
"""

from __future__ import annotations

import argparse
import json
import time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from scipy.optimize import differential_evolution, minimize

from rigctl.model.runner import RunOptions, generator, run_study, seeded
from rigctl.model.runner_model import load_source, model_source
from rigctl.model.scatter import scatter
from sim_hardware.brake_model.design.optimise import Bounds, improve, stability_margin, values_at
from sim_hardware.brake_model.design.scatter import draw, variables
from sim_hardware.brake_model.stability import onset_pressure

MODEL = Path("configs/brakes/model.toml")


def tiny(task: dict, setting: dict) -> float:
    """A task of microseconds: what remains is the runner."""
    return float(generator(task).random()) + setting["add"]


def tiny_plain(task: dict) -> float:
    """The same for the peer."""
    return tiny(task, {"add": 1.0})


def clock(call):
    """Result and seconds."""
    started = time.perf_counter()
    result = call()
    return result, time.perf_counter() - started


def cpu(call):
    """Result and processor seconds of this process: fair also on a shared machine."""
    started = time.process_time()
    result = call()
    return result, time.process_time() - started


def bench_runner(count: int = 20_000) -> None:
    """Overhead per task."""
    tasks = seeded([{} for _ in range(count)], 1)
    plain, plain_s = clock(lambda: [tiny_plain(task) for task in tasks])
    here, here_s = clock(lambda: run_study(tasks, "bench_studies:tiny", setting={"add": 1.0}))
    pool, pool_s = clock(lambda: run_study(tasks, "bench_studies:tiny", setting={"add": 1.0}, workers=2))
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as executor:
        peer, peer_s = clock(lambda: list(executor.map(tiny_plain, tasks[: count // 10], chunksize=1)))
    same = json.dumps(plain) == json.dumps(here) == json.dumps(pool) and plain[: len(peer)] == peer
    print(f"runner, {count} empty tasks: same results bit for bit: {same}")
    print(f"  plain loop                          {1e6 * plain_s / count:8.1f} us a task")
    print(f"  run_study here                      {1e6 * here_s / count:8.1f} us a task")
    print(f"  run_study 2 workers (with start)    {1e6 * pool_s / count:8.1f} us a task")
    print(f"  ProcessPoolExecutor, task by task   {1e7 * peer_s / count:8.1f} us a task")


def bench_scatter(samples: int) -> None:
    """Samples a second, against the same onsets by validated brakes and bisection."""
    grid = np.linspace(0.0, 30.0, 61)
    (one, one_cpu_s), one_s = clock(lambda: cpu(lambda: scatter(MODEL, "pressure", grid, samples=samples)))
    two, two_s = clock(
        lambda: scatter(MODEL, "pressure", grid, samples=samples, options=RunOptions(workers=2))
    )
    model = load_source(model_source(MODEL))
    chosen, few = variables(model), max(4, samples // 20)
    tasks = seeded([{} for _ in range(samples)], 1)[:few]

    def peer() -> list[float]:
        found = []
        for task in tasks:
            factors = draw(generator(task), len(chosen), 0.05, "uniform").tolist()
            values = {
                v.name: model.quantities[v.name].value * f for v, f in zip(chosen, factors, strict=True)
            }
            found.append(
                onset_pressure(model.brake.with_parameters(**values), pressure_max_bar=30.0, steps=60).value
            )
        return found

    reference, peer_s = cpu(peer)
    error = np.abs(one.onsets[:few] / np.array(reference) - 1.0).max()
    print(f"scatter, {samples} samples of 61 pressures, same in workers: {(one.onsets == two.onsets).all()}")
    print(f"  one process   {samples / one_s:8.1f} samples/s, largest difference from bisection {error:.1e}")
    print(
        f"  two workers   {samples / two_s:8.1f} samples/s, {one_s / two_s:.2f} times (with start of workers)"
    )
    ratio = peer_s / few / (one_cpu_s / samples)
    print(f"  plain loop of validated brakes and bisection: {ratio:.2f} times our processor time a sample")
    low, high = np.quantile(one.onsets, (0.1, 0.9))
    print(f"  10-90 %: {low:.2f} to {high:.2f} bar")


def bench_optimise() -> None:
    """Exact gradients against finite differences and differential evolution, on the same problem."""
    model = load_source(model_source(MODEL))
    bounds = [Bounds(v, 0.8, 1.25) for v in variables(model, ["x_pis", "m_padi", "c_abu_t", "d_pis_t"])]
    points = [{"mu": 0.4, "pressure": p} for p in (0.0, 10.0, 20.0, 30.0)]
    low, span = np.log(0.8), np.log(1.25) - np.log(0.8)

    def worst(y) -> float:
        values = values_at(model, bounds, np.exp(low + span * np.asarray(y)))
        return -100.0 * stability_margin(model, points, values).damping_ratio

    ours, ours_s = cpu(lambda: improve(model, bounds, points, np.full(4, 0.5)))
    direct, direct_s = cpu(
        lambda: minimize(worst, np.full(4, 0.5), method="SLSQP", bounds=[(0, 1)] * 4, options={"ftol": 1e-6})
    )
    evolved, evolved_s = cpu(
        lambda: differential_evolution(worst, [(0, 1)] * 4, rng=1, maxiter=25, popsize=8, polish=False)
    )
    print("optimisation, 4 variables, 4 operating points; margin (%) found, gap to the best, processor time")
    best = max(100.0 * ours.margin, -direct.fun, -evolved.fun)
    for name, margin, seconds in (
        ("epigraph, eq 24 gradients", 100.0 * ours.margin, ours_s),
        ("SLSQP, finite differences", -direct.fun, direct_s),
        ("differential evolution", -evolved.fun, evolved_s),
    ):
        print(f"  {name:28s} {margin:9.5f}  gap {best - margin:8.1e}  {seconds / ours_s:6.1f} times our time")


def main() -> None:
    """All of them."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("--samples", type=int, default=400)
    samples = parser.parse_args().samples
    bench_runner()
    bench_scatter(samples)
    bench_optimise()


if __name__ == "__main__":
    main()

"""Eigenvalue maps and stability boundaries against LAPACK: time and error side by side, in one run.

    python tests/benchmarks/bench_eigenvalues.py [--grid 512] [--brake model]

Peers: numpy's batched eigvals on the same matrices (assembled beforehand, not counted), a loop of
scipy.linalg.eigvals over a part of them, and for the boundary the paper's grid of 23 values of mu with all
eigenvalues at each. Everything on one core unless the line says otherwise; ours is timed as a user calls it,
from the model to all eigenvalues in the result, interpolation, guards and fallbacks included. Wall time and
processor time (on a machine that does other things the second says more); the load is printed with them.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.linalg

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.eigen.boundary import boundary_curve, stability_boundary
from sim_hardware.brake_model.eigen.boundary_newton import crossing_between, secular_crossings
from sim_hardware.brake_model.eigen.maps import eigenvalue_map
from sim_hardware.brake_model.eigen.secular import grid_eigenvalues
from sim_hardware.brake_model.eigen.secular_equation import sorted_eigenvalues
from sim_hardware.brake_model.linear import Matrices
from sim_hardware.brake_model.parametric import LinearBrake

BRAKES = Path(__file__).parents[2] / "configs" / "brakes"
SLOPE = 0.0576
SCIPY_POINTS = 2000


@dataclass(frozen=True)
class Time:
    """Wall time and processor time, s."""

    wall: float
    cpu: float

    def __add__(self, other: Time) -> Time:
        return Time(self.wall + other.wall, self.cpu + other.cpu)

    def __mul__(self, factor: float) -> Time:
        return Time(self.wall * factor, self.cpu * factor)


def timed(work: Callable[[], Any], repeats: int = 1) -> tuple[Time, Any]:
    """Shortest wall and processor time of some runs, and the last result."""
    walls, cpus, result = [], [], None
    for _ in range(repeats):
        wall, cpu = time.perf_counter(), time.process_time()
        result = work()
        walls.append(time.perf_counter() - wall)
        cpus.append(time.process_time() - cpu)
    return Time(min(walls), min(cpus)), result


def load_model(name: str) -> LinearBrake:
    """A shipped brake."""
    return LinearBrake(load_brake(BRAKES / f"{name}.toml"))


def rows_of_matrices(model: LinearBrake, xs: np.ndarray, ys: np.ndarray):
    """State matrices of each row of the grid; assembled from the model at three points (bilinear)."""

    def at(mu: float, pressure: float) -> np.ndarray:
        return model.matrices({"mu": mu, "pressure": pressure, "slope": SLOPE}).state_matrix()

    base = at(0.0, 0.0)
    by_mu, by_pressure = at(1.0, 0.0) - base, at(0.0, 1.0) - base
    for y in ys:
        yield base + xs[:, None, None] * by_mu + y * by_pressure


def bench_map(name: str, top_mu: float, points: int) -> None:
    """Eigenvalue map over mu and pressure."""
    model = load_model(name)
    cores = os.cpu_count() or 1
    xs, ys = np.linspace(0.0, top_mu, points), np.linspace(0.0, 30.0, points)

    def ours(workers: int = 1):
        return eigenvalue_map(model, ("mu", xs), ("pressure", ys), {"slope": SLOPE}, workers=workers)

    eigenvalue_map(model, ("mu", xs[:40]), ("pressure", ys[:40]))  # compiled
    wall, found = timed(ours, 3)
    wall_all, _ = timed(lambda: ours(cores), 3)

    peer, error, error_radius, real = Time(0.0, 0.0), 0.0, 0.0, 0
    for row, matrices in enumerate(rows_of_matrices(model, xs, ys)):
        seconds, values = timed(lambda m=matrices: np.linalg.eigvals(m))
        peer += seconds
        values = sorted_eigenvalues(values)
        difference = np.abs(found.eigenvalues[row] - values)
        error = max(error, float((difference / np.abs(values)).max()))
        error_radius = max(error_radius, float(difference.max() / np.abs(values).max()))
        real += int((values.imag == 0.0).any(axis=-1).sum())

    some = list(rows_of_matrices(model, xs, ys[:: max(1, points // 8)]))
    with ThreadPoolExecutor(cores) as pool:
        peer_all, _ = timed(lambda: list(pool.map(np.linalg.eigvals, some)))
    peer_all = peer_all * (points / len(some))
    flat = np.concatenate(some)[:SCIPY_POINTS]
    scipy_loop, _ = timed(lambda: [scipy.linalg.eigvals(m) for m in flat])
    scipy_loop = scipy_loop * (points**2 / len(flat))

    total = points**2
    print(
        f"\n{name}: {points} x {points} points, mu 0 to {top_mu:g} x pressure 0 to 30 bar, slope {SLOPE} s/m"
    )
    print(
        f"  method {found.method}; left to LAPACK by the guards: {found.fallback.sum()} of {total}", end=" "
    )
    print(f"({100.0 * found.fallback_share:.4f} %); points with real eigenvalues: {real}")
    print(f"  largest error of all points and eigenvalues: {error:.1e} of the eigenvalue itself", end=", ")
    print(f"{error_radius:.1e} of the largest")
    for what, spent, against in (
        ("ours, one core", wall, peer),
        (f"ours, {cores} threads", wall_all, peer_all),
        ("numpy batched eigvals, one core", peer, peer),
        (f"numpy batched eigvals, {cores} threads (from a part)", peer_all, peer_all),
        ("scipy.linalg.eigvals loop (from a part)", scipy_loop, peer),
    ):
        print(f"  {what:52s} {spent.wall:8.3f} s  {1e6 * spent.wall / total:8.3f} us a point", end="  ")
        print(f"x {against.wall / spent.wall:6.1f} wall, x {against.cpu / spent.cpu:6.1f} processor")


def bench_boundary() -> None:
    """A point of the stability boundary in mu of the basic brake."""
    model = load_model("basic")

    def at(mu: float) -> Matrices:
        return model.matrices({"mu": mu})

    def with_derivative(mu: float) -> tuple[Matrices, Matrices]:
        return at(mu).dense(), model.derivative("mu", {"mu": mu})

    grid = np.linspace(0.47, 0.69, 23)
    matrices = np.stack([at(mu).state_matrix() for mu in grid])

    def paper() -> float:
        return float(grid[np.flatnonzero(np.linalg.eigvals(matrices).real.max(axis=1) > 0.0)[0]])

    paper()
    paper_s, on_grid = timed(paper, 30)
    stability_boundary(model, "mu", 0.0, 1.0)
    safe_s, safe = timed(lambda: stability_boundary(model, "mu", 0.0, 1.0), 10)
    newton_s, (newton, steps) = timed(
        lambda: crossing_between(with_derivative, 0.63, 0.65, free=0, began_unstable=False), 10
    )
    exact = safe.point.value
    curves = {}
    for moved, low, high, along, values, brake, settings in (
        ("mu", 0.0, 1.0, "c_con_it", np.linspace(1.0e8, 2.0e8, 4096), "basic", {}),
        ("mu", 0.47, 0.69, "c_con_it", np.linspace(1.15e8, 1.4e8, 4096), "basic", {}),
        ("pressure", 0.0, 60.0, "slope", np.linspace(0.03, 0.12, 4096), "model", {}),
    ):
        other = load_model(brake)
        steps_of = 22 if low else 64

        def curve(o=other, m=moved, a=low, b=high, w=along, v=values, s=settings, n=steps_of):
            return boundary_curve(o, m, a, b, w, v, s, steps=n)

        curve()
        spent, found = timed(curve, 5)
        error = max(
            abs(found.values[i] / exactly(other, moved, (low, high), {along: float(values[i])}) - 1)
            for i in range(0, len(values), len(values) // 16)
        )
        curves[moved, along, steps_of] = spent * (1 / len(values)), error, float(found.by_secular.mean())
    newton_point, newton_error = bench_secular_newton(model)

    print("\nPoint of the stability boundary (basic brake: mu_crit)")

    def line(what: str, spent: Time, error: float) -> None:
        print(f"  {what:60s} {1e6 * spent.wall:9.1f} us  x {paper_s.wall / spent.wall:7.1f} wall", end=", ")
        print(f"x {paper_s.cpu / spent.cpu:7.1f} processor; error {error:.1e}")

    line("the paper: 23 values of mu, all eigenvalues at each", paper_s, abs(on_grid / exact - 1))
    line(f"Newton with eq 24 from a bracket, {steps} steps", newton_s, abs(newton.value / exact - 1))
    line(f"first crossing in 0 ... 1, safe, alone ({safe.scanned} points scanned)", safe_s, 0.0)
    for (moved, along, n), (spent, error, share) in curves.items():
        line(f"curve {moved}_crit({along}), {n} cells scanned, {100 * share:.0f} % secular", spent, error)
    line("secular Newton in (omega, mu) alone, after the scan", newton_point, newton_error)
    print("  errors: relative to the exact crossing (Newton with eq 24); the paper's: of its grid's step")


def exactly(model: LinearBrake, moved: str, ends: tuple[float, float], values: dict[str, float]) -> float:
    """The first crossing by Newton with eq 24."""
    point = stability_boundary(model, moved, *ends, values).point
    assert point is not None
    return point.value


def bench_secular_newton(model: LinearBrake) -> tuple[Time, float]:
    """Time of a point of Newton alone along a curve, and its largest relative error."""
    xs, ys = np.linspace(0.0, 1.0, 65), np.linspace(1.0e8, 2.0e8, 4096)
    solved = grid_eigenvalues(lambda x, y: model.matrices({"mu": x, "c_con_it": y}), xs, ys)
    cells = (solved.values.real.max(axis=2) > 0.0).argmax(axis=1) - 1
    rows = np.arange(len(ys))
    near = solved.values[rows[:, None], np.stack([cells, cells + 1], axis=1)]
    ends = np.stack([xs[cells], xs[cells + 1]], axis=1)
    assert solved.equation is not None
    lines = solved.equation.along_x(ys)[0], solved.equation.x
    equation = solved.equation
    spent, (found, _, good) = timed(lambda: secular_crossings(equation, lines, ends, near), 10)
    assert good.all()
    errors = [
        abs(found[i] / exactly(model, "mu", (0.0, 1.0), {"c_con_it": float(ys[i])}) - 1)
        for i in range(0, len(ys), 512)
    ]
    return spent * (1 / len(ys)), max(errors)


if __name__ == "__main__":
    if "OPENBLAS_NUM_THREADS" not in os.environ:  # LAPACK on one core, which must be said before it is loaded
        one = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
        os.execve(sys.executable, [sys.executable, *sys.argv], os.environ | one)
    parser = argparse.ArgumentParser()
    parser.add_argument("--grid", type=int, default=512)
    parser.add_argument("--brake", nargs="*", default=["model"])
    arguments = parser.parse_args()
    print(f"load of the machine before: {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    bench_boundary()
    for brake in arguments.brake:
        bench_map(brake, 1.0, arguments.grid)
    bench_map("basic", 3.0, arguments.grid // 4)
    print(f"\nload of the machine after: {os.getloadavg()[0]:.1f}")

"""Speed and error of eigenvalue tracking against three usual ways; run by hand: python
tests/benchmarks/bench_tracking.py

Same model, same grid, same run. Peers, each with numpy's batched LAPACK: sorting by frequency at every point;
the nearest eigenvalue by optimal assignment; the modal assurance criterion (MAC) of the right vectors by
optimal assignment. Reference: nearest eigenvalue on a grid refined 400 times, whose own steps are so small
that the nearest is the next (checked). Wrong: share of (point, mode) that a way gives to another mode than
the reference; error: largest |difference| of the rest, relative to the largest modulus. Times are the best of
several, one process; the time of eigenvalues with vectors alone (numpy.linalg.eig) is the floor of all ways
that use vectors.
"""

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import time
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
from scipy.optimize import linear_sum_assignment

from sim_hardware.brake_model import load_brake
from sim_hardware.brake_model.eigen.tracking import track
from sim_hardware.brake_model.linear import Matrices, NamedQuantity
from sim_hardware.brake_model.parametric import LinearBrake

BRAKES = Path(__file__).parents[2] / "configs" / "brakes"
REFINED = 400


class Veering:
    """Six oscillators with crossing frequencies and weak couplings: many narrow avoided crossings.

    Symmetric with damping proportional to mass: modes never cross, so that sorting is right by chance.
    """

    name, groups = "veering", ()
    freedoms = tuple("abcdef")
    quantities: Mapping[str, NamedQuantity] = {"s": NamedQuantity("s", 0.0, "1", "other")}
    _slope = np.diag([3.0, -2.0, 1.0, -1.0, 2.0, -3.0])
    _weak = 0.04 * np.random.default_rng(3).uniform(0.3, 1.0, (6, 6))
    _base = np.diag([8.0, 13.1, 9.6, 11.3, 9.2, 14.3]) + np.triu(_weak, 1) + np.triu(_weak, 1).T

    def matrices(self, values: Mapping[str, float] | None = None) -> Matrices:
        s = (values or {}).get("s", 0.0)
        return Matrices(np.eye(6), 0.002 * np.eye(6), self._base + s * self._slope)

    def derivative(self, name: str, values: Mapping[str, float] | None = None) -> Matrices:
        return Matrices(np.zeros((6, 6)), np.zeros((6, 6)), self._slope)


def states(model: object, name: str, grid: np.ndarray) -> np.ndarray:
    return np.stack([model.matrices({name: float(s)}).state_matrix() for s in grid])  # type: ignore[attr-defined]


def upper(values: np.ndarray, vectors: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray | None]:
    kept = np.flatnonzero(values.imag > 0)
    kept = kept[np.argsort(values[kept].imag)]
    return values[kept], None if vectors is None else vectors[:, kept]


def by_frequency(model: object, name: str, grid: np.ndarray) -> np.ndarray:
    return np.stack([upper(z)[0] for z in np.linalg.eigvals(states(model, name, grid))])


def by_nearest(model: object, name: str, grid: np.ndarray) -> np.ndarray:
    rows = [upper(z)[0] for z in np.linalg.eigvals(states(model, name, grid))]
    out = [rows[0]]
    for row in rows[1:]:
        out.append(row[linear_sum_assignment(np.abs(out[-1][:, None] - row[None, :]))[1]])
    return np.stack(out)


def by_mac(model: object, name: str, grid: np.ndarray) -> np.ndarray:
    values, vectors = np.linalg.eig(states(model, name, grid))
    n = values.shape[1] // 2
    last, shape = upper(values[0], vectors[0])
    out, shape = [last], shape[:n] / np.linalg.norm(shape[:n], axis=0)  # type: ignore[index]
    for z, v in zip(values[1:], vectors[1:], strict=True):
        row, now = upper(z, v)
        now = now[:n] / np.linalg.norm(now[:n], axis=0)  # type: ignore[index]
        order = linear_sum_assignment(-(np.abs(shape.conj().T @ now) ** 2))[1]
        out.append(row[order])
        shape = now[:, order]
    return np.stack(out)


def ours(model: object, name: str, grid: np.ndarray) -> np.ndarray:
    return track(model, name, grid).eigenvalues  # type: ignore[arg-type]


def reference(model: object, name: str, grid: np.ndarray) -> tuple[np.ndarray, float]:
    """Eigenvalues on the grid by tiny steps; largest step relative to the distance of the next eigenvalue."""
    fine = np.interp(np.arange((len(grid) - 1) * REFINED + 1) / REFINED, np.arange(len(grid)), grid)
    tracked = by_nearest(model, name, fine)
    gap = np.abs(tracked[:, :, None] - tracked[:, None, :]) + np.where(np.eye(tracked.shape[1]), np.inf, 0.0)
    worst = (np.abs(np.diff(tracked, axis=0)) / gap.min(axis=2)[1:]).max()
    return tracked[::REFINED], float(worst)


def best_time(call: Callable[[], object], repeats: int = 9) -> float:
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        call()
        times.append(time.perf_counter() - begin)
    return min(times)


def main() -> None:
    basic, refined = (LinearBrake(load_brake(BRAKES / f"{name}.toml")) for name in ("basic", "model"))
    cases = [
        ("Fig. 7: basic, mu 0.47-0.69", basic, "mu", np.linspace(0.47, 0.69, 101)),
        ("basic, mu 0-2", basic, "mu", np.linspace(0.0, 2.0, 101)),
        ("basic, mu 0-2, 6 points", basic, "mu", np.linspace(0.0, 2.0, 6)),
        ("model, c_abu_t 1e7-2e8", refined, "c_abu_t", np.linspace(1e7, 2e8, 101)),
        ("model, c_abu_t, 9 points", refined, "c_abu_t", np.linspace(1e7, 2e8, 9)),
        ("veering of 6, 41 points", Veering(), "s", np.linspace(0.0, 2.0, 41)),
        ("veering of 6, 9 points", Veering(), "s", np.linspace(0.0, 2.0, 9)),
    ]
    ways = {"ours": ours, "frequency": by_frequency, "nearest": by_nearest, "MAC": by_mac}
    print(f"{'case':30}{'way':11}{'ms':>8}{'x eig':>8}{'wrong %':>9}{'error':>10}")
    for title, model, name, grid in cases:
        right, worst = reference(model, name, grid)
        matrices = states(model, name, grid)
        floor = best_time(lambda m=matrices: np.linalg.eig(m))
        for way, function in ways.items():
            values = function(model, name, grid)
            order = linear_sum_assignment(np.abs(values[0][:, None] - right[0][None, :]))[1]
            difference = np.abs(values - right[:, order]) / np.abs(right).max()
            wrong = difference > 1e-7
            seconds = best_time(lambda f=function, m=model, q=name, g=grid: f(m, q, g))
            error = difference[~wrong].max()
            print(
                f"{title if way == 'ours' else '':30}{way:11}{1e3 * seconds:8.1f}{seconds / floor:8.2f}"
                f"{100 * wrong.mean():9.2f}{error:10.1e}"
            )
        note = "" if worst < 0.5 else "  (reference not certain: refine)"
        print(f"{'':30}{'np.eig':11}{1e3 * floor:8.1f}{1.0:8.2f}   reference: step/gap {worst:.2f}{note}")


if __name__ == "__main__":
    main()

"""Speed and error of the sensitivity analysis; run by hand: python tests/benchmarks/bench_sensitivity.py

1. Eq 24 for all quantities of the brake file x 28 eigenvalues, against central differences with numpy's
   eigvals (two eigenvalue problems for each quantity) and against the matrix form with derivatives dM, dD,
   dK.
2. All modifications x 2 coefficients of friction re-solved with mode identity, against a plain loop: a model,
   numpy's eigvals and an assignment of nearest eigenvalues for each.
Best of several rounds: other load on the machine slows all of them; look at ratios.
"""

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import linear_sum_assignment

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.design.matrix_batches import matrix_batch
from sim_hardware.brake_model.design.resolving import resolve
from sim_hardware.brake_model.design.sensitivity import (
    derivatives,
    eigen_sensitivities,
    parameter_names,
    sensitivities,
    sensitivities_of,
)
from sim_hardware.brake_model.design.variations import all_variations
from sim_hardware.brake_model.eigen.eigen_systems import eigen_system
from sim_hardware.brake_model.linear import value_of
from sim_hardware.brake_model.parametric import LinearBrake

MODEL = LinearBrake(load_brake(Path(__file__).parents[2] / "configs" / "brakes" / "model.toml"))
POINT = {"mu": 0.4, "pressure": 10.0}
MUS = (0.4, 0.6)
ROUNDS = 7


def best(work: Callable[[], Any], rounds: int = ROUNDS) -> tuple[float, Any]:
    """Shortest time in ms and the result."""
    times, result = [], None
    for _ in range(rounds):
        start = time.perf_counter()
        result = work()
        times.append(1e3 * (time.perf_counter() - start))
    return min(times), result


def worst(ours: np.ndarray, peer: np.ndarray, floor: float = 0.0) -> float:
    """Largest difference in a row as share of the row's largest value (of `floor` at least)."""
    scale = np.maximum(np.abs(peer).max(axis=1), floor)
    return float((np.abs(ours - peer).max(axis=1)[scale > 0.0] / scale[scale > 0.0]).max())


def central_differences(names: tuple[str, ...], share: float = 2e-5) -> np.ndarray:
    """Change of all eigenvalues for 1 % more of each quantity."""
    nominal = eigen_system(MODEL.matrices(POINT)).values
    found = np.empty((len(names), nominal.size), dtype=complex)
    for number, name in enumerate(names):
        amount = value_of(MODEL, name, POINT)
        ends = []
        for sign in (1.0, -1.0):
            matrix = MODEL.matrices({**POINT, name: amount * (1.0 + sign * share)}).state_matrix()
            values = np.linalg.eigvals(matrix)
            ends.append(values[np.abs(nominal[:, None] - values[None, :]).argmin(axis=1)])
        found[number] = 0.01 * (ends[0] - ends[1]) / (2.0 * share)
    return found


def plain_loop(variations: tuple) -> np.ndarray:
    """All modifications one by one: the model, eigenvalues, nearest to the basic design's."""
    found = np.empty((len(variations), len(MUS), 28), dtype=complex)
    for k, mu in enumerate(MUS):
        nominal = eigen_system(MODEL.matrices({"mu": mu})).values
        for number, v in enumerate(variations):
            values = np.linalg.eigvals(MODEL.matrices(v.values(MODEL, {"mu": mu})).state_matrix())
            _, order = linear_sum_assignment(np.abs(nominal[:, None] - values[None, :]))
            found[number, k] = values[order]
    return found


def line(what: str, time_ms: float, ratio: str = "") -> None:
    """Print a line of a comparison."""
    print(f"  {what:40s}{time_ms:9.2f} ms   {ratio}".rstrip())


def main() -> None:
    """Print both comparisons."""
    names = parameter_names(MODEL, places=True)
    system = eigen_system(MODEL.matrices(POINT))
    rank_one, ours = best(lambda: sensitivities_of(MODEL, system, names, POINT))
    whole, _ = best(lambda: eigen_sensitivities(MODEL, names, POINT))
    stack = derivatives(MODEL, names, POINT)
    given, _ = best(lambda: sensitivities(system, stack))
    matrices, dense = best(lambda: sensitivities(system, derivatives(MODEL, names, POINT)), 3)
    differences, peer = best(lambda: central_differences(names), 2)
    matrices_error = worst(ours.absolute, dense.absolute)
    differences_error = worst(ours.per_percent, peer, floor=1e-2)
    print(f"eq 24: {len(names)} quantities x {system.values.size} eigenvalues")
    line("rank-one structure, eigenvectors given", rank_one)
    line("the same with eigenvectors", whole)
    line("derivatives of M, D, K given", given)
    line("derivatives of M, D, K formed", matrices, f"{matrices / rank_one:6.1f} x rank-one")
    line("central differences, numpy eigvals", differences, f"{differences / whole:6.1f} x all of eq 24")
    print("  largest difference, as share of a quantity's largest change:")
    print(f"    rank-one and matrices {matrices_error:.1e}, eq 24 and differences {differences_error:.1e}")

    variations = all_variations(MODEL)
    points = tuple({"mu": mu} for mu in MUS)
    resolved_ms, resolved = best(lambda: resolve(MODEL, variations, points))
    targets = [v.values(MODEL, point) for point in points for v in variations]
    batch_ms, batch = best(lambda: matrix_batch(MODEL, targets))
    states = batch.state_matrices()
    eigvals_ms, _ = best(lambda: np.linalg.eigvals(states))
    loop_ms, plain = best(lambda: plain_loop(variations), 3)
    error = max(
        np.abs(np.sort_complex(a) - np.sort_complex(b)).max() / np.abs(b).max()
        for a, b in zip(resolved.varied.reshape(-1, 28), plain.reshape(-1, 28), strict=True)
    )
    differently = int((np.abs(resolved.varied - plain) > 1.0).any(axis=(1, 2)).sum())
    uncertain = int((~resolved.sure).sum())
    print(f"technical sensitivity: {len(variations)} modifications x {len(MUS)} coefficients of friction")
    line("batch with mode identity", resolved_ms)
    line("  of these matrices", batch_ms)
    line("  of these LAPACK's eigenvalues", eigvals_ms)
    line("plain loop, nearest eigenvalues", loop_ms, f"{loop_ms / resolved_ms:6.1f} x")
    print(f"  largest relative difference of eigenvalues {error:.1e}")
    print(f"  modifications where 'nearest' takes another mode: {differently}; uncertain modes: {uncertain}")


if __name__ == "__main__":
    main()

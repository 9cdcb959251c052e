"""Eigenvalues in a band of a large brake-like model: time and error beside peers; run by hand:
OPENBLAS_NUM_THREADS=1 python tests/benchmarks/bench_band.py [--dense]

The disc-brake mesh of the tests at three sizes, band 1 to 5 kHz, unsymmetric by friction. Peers on the same
matrices in the same run: LAPACK on the state matrix (all eigenvalues; small size only, or --dense for both:
minutes), and scipy's `eigs` in shift-invert mode about the middle of the band on the assembled linearisation,
told how many eigenvalues to find (which nobody knows beforehand). Errors are relative to LAPACK where it ran,
to Newton-refined values of ours else. Other load on the machine slows all of them: look at ratios.
"""

import math
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import eigs

sys.path.insert(0, str(Path(__file__).parents[1] / "verification" / "brake_model"))
from disc_brake_mesh import disc_brake

from sim_hardware.brake_model.eigen.band import eigen_pairs_of_matrices
from sim_hardware.brake_model.eigen.band_arnoldi import Found, cover
from sim_hardware.brake_model.eigen.band_pencil import Pencil
from sim_hardware.brake_model.linear import Matrices

BAND = (1000.0, 5000.0)


def timed(work: Callable[[], Any], times: int = 3) -> tuple[Any, float]:
    """Result and best time of some runs, s."""
    best, result = math.inf, None
    for _ in range(times):
        begin = time.perf_counter()
        result = work()
        best = min(best, time.perf_counter() - begin)
    return result, best


def inside(values: np.ndarray) -> np.ndarray:
    """Those of the band, by frequency."""
    kept = values[(values.imag >= math.tau * BAND[0]) & (values.imag <= math.tau * BAND[1])]
    return kept[np.argsort(kept.imag)]


def plain_eigs(m: Matrices, count: int) -> np.ndarray:
    """scipy's shift-invert on A z = lambda B z with A = [[0, 1], [-K, -D]], B = [[1, 0], [0, M]]."""
    one = sparse.eye_array(m.n_dof)
    a = sparse.csc_array(sparse.block_array([[None, one], [-m.stiffness, -m.damping]]), dtype=complex)
    b = sparse.csc_array(sparse.block_array([[one, None], [None, m.mass]]), dtype=complex)
    middle = 0.5j * math.tau * sum(BAND)
    return eigs(a, count, b, sigma=middle, return_eigenvectors=True)[0]


def without_proof(m: Matrices) -> np.ndarray:
    """Our search alone: right vectors only, no count."""
    found = Found()
    low, high = (math.tau * f for f in BAND)
    cover(Pencil(m), low, high, 0.1 * high, found, None)
    return np.array(found.values)


def main() -> None:
    """Print the table."""
    for size, dense in (((4, 36), True), ((5, 84), "--dense" in sys.argv), ((7, 120), False)):
        parts = disc_brake(*size)
        m = Matrices(parts["M"], parts["D"] + 0.8 * parts["D_mu"], parts["K"] + 0.8 * parts["K_mu"])
        ours, full_s = timed(lambda m=m: eigen_pairs_of_matrices(m, BAND))
        bare, bare_s = timed(lambda m=m: inside(without_proof(m)))
        truth, dense_s = ours.eigenvalues, math.nan
        if dense:
            truth, dense_s = timed(lambda m=m: inside(np.linalg.eigvals(m.state_matrix())), 1)
        count = len(ours.eigenvalues)
        # eigs finds the nearest to the middle, also beyond the band: more until the band is full
        wanted = count
        peer, peer_s = timed(lambda m=m, k=wanted: inside(plain_eigs(m, k)), 1)
        while len(peer) < len(truth):
            wanted += 8
            peer, peer_s = timed(lambda m=m, k=wanted: inside(plain_eigs(m, k)), 1)

        def error(values: np.ndarray, truth: np.ndarray = truth) -> str:
            if len(values) != len(truth):
                return f"{len(values)} of {len(truth)} found"
            return f"{float((np.abs(values - truth) / np.abs(truth)).max()):.1e}"

        reference = "LAPACK" if dense else "ours"
        print(
            f"{m.n_dof} degrees of freedom, {count} pairs from {BAND[0]:g} to {BAND[1]:g} Hz, complete: "
            f"{ours.complete}"
        )
        print(f"  largest residual {ours.residuals.max():.1e}; {ours.evidence}")
        print(f"  {'':44s} {'s':>8s}   error against {reference}")
        rows = [
            ("ours: right and left vectors, proof", full_s, error(ours.eigenvalues)),
            ("ours: search alone", bare_s, error(bare)),
            (f"scipy eigs, shift-invert, told k = {wanted}", peer_s, error(peer)),
        ]
        if dense:
            rows.append(("LAPACK, all eigenvalues, no vectors", dense_s, "0"))
        for name, seconds, text in rows:
            print(f"  {name:44s} {seconds:8.2f}   {text}   {seconds / full_s:7.1f} x ours with proof")


if __name__ == "__main__":
    main()

"""Tracking in a frequency band: the same modes as by the full system, sparse models, modes that leave the
band.
"""

from pathlib import Path

import numpy as np
import pytest
from scipy import sparse

from sim_hardware.brake_model import load_brake
from sim_hardware.brake_model.eigen.tracking import Flag, track
from sim_hardware.brake_model.eigen.tracking_band import track_band
from sim_hardware.brake_model.foreign.matrix_model import MatrixModel
from sim_hardware.brake_model.parametric import LinearBrake

ROOT = Path(__file__).parents[3]


def two_bars(n: int) -> MatrixModel:
    """Two elastic bars of n masses along each other, coupled by springs and by friction: 2 n freedoms,
    sparse.

    Mode j of the pair obeys the 2-DOF system with the bars' own squared frequencies on the diagonal, so that
    the whole spectrum is known in closed form.
    """
    chain = sparse.diags_array(
        [np.full(n - 1, -1.0), np.full(n, 2.0), np.full(n - 1, -1.0)], offsets=[-1, 0, 1]
    )
    eye, c = sparse.eye_array(n), COUPLING
    first, second = (stiffness * n**2 * chain + c * eye for stiffness in STIFF)
    parts = {
        "M": sparse.eye_array(2 * n),
        "K": sparse.block_array([[first, -c * eye], [-c * eye, second]]),
        "K_mu": sparse.block_array([[None, -c * eye], [c * eye, None]]),
        "D": DAMPING * sparse.eye_array(2 * n),
    }
    return MatrixModel("bars", {key: part.tocsr() for key, part in parts.items()}, {"mu": 0.0})


STIFF, COUPLING, DAMPING = (1000.0**2, 1060.0**2), (2.0 * np.pi * 400.0) ** 2, 20.0


def exact(n: int, j: int, mu: float) -> np.ndarray:
    """Both eigenvalues with Im > 0 of the j-th mode of the bars."""
    wave = 4.0 * n**2 * np.sin(j * np.pi / (2.0 * (n + 1))) ** 2
    c = COUPLING
    k = np.array([[STIFF[0] * wave + c, -c - mu * c], [-c + mu * c, STIFF[1] * wave + c]])
    a = np.block([[np.zeros((2, 2)), np.eye(2)], [-k, -DAMPING * np.eye(2)]])
    z = np.linalg.eigvals(a)
    return z[z.imag > 0]


def test_same_modes_as_the_full_system() -> None:
    model = LinearBrake(load_brake(ROOT / "configs/brakes/basic.toml"))
    grid = np.linspace(0.47, 0.69, 9)
    band, full = track_band(model, "mu", grid, (2000.0, 3000.0)), track(model, "mu", grid)
    assert band.n_modes == 4
    assert np.abs(band.eigenvalues - full.eigenvalues[:, 5:9]).max() < 1e-8
    (crossing,) = band.crossings
    assert crossing.value == pytest.approx(full.crossings[0].value, rel=1e-9)
    assert crossing.mode == full.crossings[0].mode - 5


def test_sparse_model_of_260_freedoms_against_its_closed_form() -> None:
    n, grid = 130, np.array([0.0, 0.6])
    locus = track_band(two_bars(n), "mu", grid, (1700.0, 2200.0))
    known = np.concatenate([exact(n, j, 0.0) for j in range(1, 9)])
    inside = (known.imag > 2 * np.pi * 1700.0) & (known.imag < 2 * np.pi * 2200.0)
    assert locus.n_modes == inside.sum() > 1
    for k, mu in enumerate(grid):
        known = np.concatenate([exact(n, j, mu) for j in range(1, 9)])
        distance = np.abs(locus.eigenvalues[k][:, None] - known[None, :]).min(axis=1)
        assert distance.max() < 1e-6 * np.abs(known).max()
    assert (np.abs(np.diff(locus.frequencies_hz, axis=0)) < 60.0).all()


def test_a_mode_that_leaves_the_band_is_marked_lost() -> None:
    model = MatrixModel(
        "pair", {"M": np.eye(2), "K": np.diag([1e6, 4e6]), "K_s": np.diag([3e6, 0.0])}, {"s": 0.0}
    )
    locus = track_band(model, "s", np.linspace(0.0, 1.0, 11), (100.0, 200.0))
    assert locus.n_modes == 1 and not (locus.flags[0] & Flag.LOST).any()
    assert (locus.flags[-1] & Flag.LOST).all() and np.isnan(locus.eigenvalues[-1]).all()
    kept = np.isfinite(locus.eigenvalues[:, 0])
    assert (kept == [True] * 3 + [False] * 8).all() and locus.frequencies_hz[kept, 0].max() < 212.0
    assert locus.frequencies_hz[kept, 0] == pytest.approx(np.sqrt(1e6 + 3e6 * locus.grid[kept]) / (2 * np.pi))


def test_bad_bands_and_large_models_say_what_to_do() -> None:
    model = two_bars(150)
    with pytest.raises(ValueError, match="--band"):
        track(model, "mu", [0.0, 1.0])
    small = LinearBrake(load_brake(ROOT / "configs/brakes/basic.toml"))
    with pytest.raises(ValueError, match="lower < upper"):
        track_band(small, "mu", [0.0, 1.0], (900.0, 800.0))
    with pytest.raises(ValueError, match="widen the band"):
        track_band(small, "mu", [0.0, 1.0], (1.0, 2.0))

"""Eigenvalues in a band by shift-invert against LAPACK's on the same matrices; completeness, multiplicity,
vectors.
"""

import math
from functools import cache

import numpy as np
import pytest
from disc_brake_mesh import disc_brake
from scipy import sparse

from sim_hardware.brake_model.eigen import band as band_module
from sim_hardware.brake_model.eigen.band import EigenPairs, eigen_pairs_of_matrices
from sim_hardware.brake_model.eigen.band_count import missed
from sim_hardware.brake_model.eigen.band_pencil import Pencil
from sim_hardware.brake_model.linear import Matrices

SMALL = disc_brake(2, 12)  # 96 degrees of freedom


def of(parts: dict, mu: float, bar: float = 10.0, slope: float = 0.05) -> Matrices:
    return Matrices(
        parts["M"],
        parts["D"] + mu * parts["D_mu"] + slope * bar * parts["D_k_p"],
        parts["K"] + mu * parts["K_mu"],
    )


@cache
def by_lapack(mu: float) -> EigenPairs:
    return eigen_pairs_of_matrices(of(SMALL, mu))


def by_shifts(matrices: Matrices, band: tuple[float, float], monkeypatch: pytest.MonkeyPatch) -> EigenPairs:
    monkeypatch.setattr(band_module, "DENSE_WITH_BAND", 0)
    found = eigen_pairs_of_matrices(matrices, band)
    assert found.method == "shift-invert"
    return found


@pytest.mark.parametrize("mu", [0.0, 0.6])
@pytest.mark.parametrize("band", [(1000.0, 5000.0), (0.0, 900.0), (6000.0, 12000.0)])
def test_band_equals_lapack(mu: float, band: tuple[float, float], monkeypatch: pytest.MonkeyPatch) -> None:
    matrices = of(SMALL, mu)
    everything = by_lapack(mu)
    assert everything.method == "dense"
    inside = (everything.frequencies_hz >= band[0]) & (everything.frequencies_hz <= band[1])
    found = by_shifts(matrices, band, monkeypatch)
    assert found.complete is True, found.evidence
    assert len(found.eigenvalues) == inside.sum() > 3
    np.testing.assert_allclose(found.eigenvalues, everything.eigenvalues[inside], rtol=1e-10)
    np.testing.assert_array_equal(found.unstable, everything.unstable[inside])
    for result in (found, everything):
        assert result.residuals.max() < 1e-12
        pencil = Pencil(matrices)
        assert pencil.residuals(result.eigenvalues, result.left, transposed=True).max() < 1e-12
        assert np.all(np.diff(result.frequencies_hz) >= 0.0)
        np.testing.assert_allclose(np.linalg.norm(result.right, axis=0), 1.0)
    # the same lines in space: right, and left with the promised phase
    right, left = everything.right[:, inside], everything.left[:, inside]
    assert np.abs(np.einsum("im,im->m", found.right.conj(), right)).min() > 1.0 - 1e-6
    assert np.einsum("im,im->m", left.conj(), found.left).real.min() > 1.0 - 1e-6


def test_vectors_give_eq_24(monkeypatch: pytest.MonkeyPatch) -> None:
    found = by_shifts(of(SMALL, 0.5), (1000.0, 5000.0), monkeypatch)
    step = 1e-4
    ahead, behind = (eigen_pairs_of_matrices(of(SMALL, 0.5 + s), (900.0, 5100.0)) for s in (step, -step))
    for value, x, w, condition in zip(
        found.eigenvalues, found.right.T, found.left.T, found.conditions, strict=True
    ):
        slope = w @ (2 * value * (SMALL["M"] @ x) + of(SMALL, 0.5).damping @ x)
        assert slope.imag == pytest.approx(0.0, abs=1e-9 * abs(slope))
        assert slope.real > 0.0
        rate = -(w @ (value * (SMALL["D_mu"] @ x) + SMALL["K_mu"] @ x)) / slope  # eq 24
        near = [p.eigenvalues[np.abs(p.eigenvalues - value).argmin()] for p in (ahead, behind)]
        difference = (near[0] - near[1]) / (2 * step)
        assert rate == pytest.approx(difference, rel=1e-3, abs=1e-9 * condition)


def test_large_model_squeals_by_friction_alone() -> None:
    matrices = of(disc_brake(7, 120), 0.8, bar=0.0)
    assert matrices.n_dof == 3360
    found = eigen_pairs_of_matrices(matrices, (1000.0, 4000.0))
    assert found.method == "shift-invert"
    assert found.complete is True, found.evidence
    assert found.residuals.max() < 1e-12
    assert len(found.eigenvalues) > 8
    assert found.frequencies_hz[found.unstable] == pytest.approx([1539.17], abs=0.01)


def test_mode_coupling_needs_friction(monkeypatch: pytest.MonkeyPatch) -> None:
    parts = disc_brake(2, 24)
    calm, rubbed = (by_shifts(of(parts, mu, bar=0.0), (1000.0, 2000.0), monkeypatch) for mu in (0.0, 0.6))
    assert not calm.unstable.any()
    assert rubbed.frequencies_hz[rubbed.unstable] == pytest.approx([1424.9], abs=0.01)
    assert np.abs(np.einsum("im,im->m", calm.left.conj(), calm.right)).min() > 1 - 1e-12  # symmetric: w = x


def test_exactly_double_eigenvalues_are_found_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two identical brakes in one model: each eigenvalue twice, semi-simple."""
    one = of(SMALL, 0.5)
    two = Matrices(
        *(sparse.csr_array(sparse.block_diag([m, m])) for m in (one.mass, one.damping, one.stiffness))
    )
    single = eigen_pairs_of_matrices(one, (1000.0, 5000.0))
    found = by_shifts(two, (1000.0, 5000.0), monkeypatch)
    assert found.complete is True, found.evidence
    np.testing.assert_allclose(found.eigenvalues, np.repeat(single.eigenvalues, 2), rtol=1e-9)
    for i in range(0, len(found.eigenvalues), 2):
        assert np.linalg.svd(found.right[:, i : i + 2], compute_uv=False)[1] > 0.1


def test_count_notices_what_is_missing() -> None:
    matrices = of(SMALL, 0.5)
    pairs = by_lapack(0.5).eigenvalues
    known = np.concatenate([pairs, pairs[pairs.imag > 0].conj()])
    inside = np.flatnonzero((pairs.imag > 2 * np.pi * 1000) & (pairs.imag < 2 * np.pi * 5000))
    corners = (-3000 + 2j * np.pi * 1000, 3000 + 2j * np.pi * 5000)
    pencil = Pencil(matrices)
    assert missed(pencil, known, corners, most_factors=400) == 0
    assert missed(pencil, np.delete(known, inside[[1, 3]]), corners, most_factors=400) == 2
    assert missed(pencil, np.append(known, -100 + 2j * np.pi * 3000), corners, most_factors=400) == -1
    assert missed(pencil, known, corners, most_factors=5) is None


def test_argument_of_the_determinant() -> None:
    pencil = Pencil(of(disc_brake(2, 12), 0.7))
    for place in (-300 + 4000j, 2000 + 1j, -1e4 + 1e5j):
        sign, _ = np.linalg.slogdet(pencil.at(place).toarray())
        turned = (pencil.factors(place).argument() - np.angle(sign)) / (2 * math.pi)
        assert turned == pytest.approx(round(turned), abs=1e-9)


@pytest.mark.parametrize(
    ("band", "ratio", "message"),
    [
        ((5000.0, 1000.0), 0.1, "lower < upper"),
        ((-1.0, 10.0), 0.1, "lower < upper"),
        ((0.0, math.inf), 0.1, "lower < upper"),
        ((math.nan, 10.0), 0.1, "lower < upper"),
        ((0.0, 10.0), 0.0, "damping"),
    ],
)
def test_nonsense_bands_are_refused(band: tuple[float, float], ratio: float, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        eigen_pairs_of_matrices(of(SMALL, 0.0), band, damping_max=ratio)


def test_large_model_without_band_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(band_module, "DENSE_ALWAYS", 90)
    with pytest.raises(ValueError, match="give a frequency band"):
        eigen_pairs_of_matrices(of(SMALL, 0.0))

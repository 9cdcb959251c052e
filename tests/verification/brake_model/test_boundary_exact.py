"""Stability boundaries against all crossings at once, which a bialternate eigenvalue problem gives exactly.

For A(t) = A0 + t A1 some sum of two different eigenvalues is zero exactly where det(2 A(t) (.) I) = 0: an
eigenvalue problem in t of size n (n - 1) / 2 that shares nothing with a scan. Real eigenvalues pass zero
where det A(t) = 0.
"""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import linalg

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.design.variations import variation
from sim_hardware.brake_model.eigen.boundary import boundary_curve, stability_boundary
from sim_hardware.brake_model.eigen.boundary_newton import eigenvalue_rate
from sim_hardware.brake_model.eigen.directions import direction
from sim_hardware.brake_model.linear import Matrices, NamedQuantity, known
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.stability import onset_mu, onset_pressure

BRAKES = {name: LinearBrake(load_brake(Path(__file__).parents[3] / f"configs/brakes/{name}.toml")) for name in
          ("basic", "model", "plant")}  # fmt: skip


class Affine:
    """K = K0 + t K1, D = D0 + t D1."""

    name, groups = "affine", ()

    def __init__(self, base: Matrices, change: Matrices) -> None:
        self._base, self._change = base, change
        self.freedoms = tuple(f"q{i}" for i in range(base.n_dof))
        self.quantities = MappingProxyType({"t": NamedQuantity("t", 0.0, "1", "other")})

    def matrices(self, values: Mapping[str, float] | None = None) -> Matrices:
        t, b, c = (values or {}).get("t", 0.0), self._base, self._change
        return Matrices(b.mass, b.damping + t * c.damping, b.stiffness + t * c.stiffness)

    def derivative(self, name: str, values: Mapping[str, float] | None = None) -> Matrices:
        known(self, name)
        return self._change


def bialternate(a: np.ndarray) -> np.ndarray:
    """2 A (.) I: its eigenvalues are the sums of two different eigenvalues of A."""
    n = len(a)
    pairs = list(itertools.combinations(range(n), 2))
    index = {pair: k for k, pair in enumerate(pairs)}
    result = np.zeros((len(pairs), len(pairs)))
    for (p, q), row in index.items():
        for r in range(n):
            for (i, j), value in (((r, q), a[p, r]), ((p, r), a[q, r])):
                if i != j:
                    result[row, index[min(i, j), max(i, j)]] += value if i < j else -value
    return result


def crossings(model: Affine, low: float, high: float) -> list[tuple[float, float]]:
    """All (t, omega) in the range at which an eigenvalue lies on the imaginary axis."""
    at_0, at_1 = (model.matrices({"t": t}).state_matrix() for t in (0.0, 1.0))
    change = at_1 - at_0
    found = []
    for base, rate in ((bialternate(at_0), bialternate(change)), (at_0, change)):
        for t in linalg.eigvals(base, -rate):
            if np.isfinite(t) and abs(t.imag) < 1e-7 * (1 + abs(t)) and low < t.real < high:
                values = np.linalg.eigvals(model.matrices({"t": t.real}).state_matrix())
                nearest = values[np.abs(values.real).argmin()]
                if abs(nearest.real) < 1e-5:
                    found.append((float(t.real), abs(float(nearest.imag))))
    return sorted(found)


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(2, 4), circulatory=st.floats(0.2, 3.0))
def test_the_first_of_all_crossings(seed: int, n: int, circulatory: float) -> None:
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(n, n))
    stiffness = root @ root.T + n * np.diag(rng.uniform(0.5, 3.0, n))
    push = circulatory * rng.normal(size=(n, n))
    model = Affine(
        Matrices(np.eye(n), 0.02 * stiffness + 0.02 * np.eye(n), stiffness),
        Matrices(np.zeros((n, n)), 0.05 * rng.normal(size=(n, n)), push),
    )
    low, high = 0.0, 3.0
    wanted = crossings(model, low, high)
    found = stability_boundary(model, "t", low, high)
    assert not found.starts_unstable
    if not wanted:
        assert found.point is None
        return
    assert found.point is not None
    assert found.point.value == pytest.approx(wanted[0][0], rel=1e-7)
    assert 2.0 * np.pi * found.point.frequency_hz == pytest.approx(wanted[0][1], rel=1e-6, abs=1e-6)
    assert found.point.kind == ("flutter" if wanted[0][1] > 1e-4 else "divergence")
    assert found.point.destabilises
    assert found.point.rate_1_s > 0.0


def test_the_paper_s_boundaries() -> None:
    basic = stability_boundary(BRAKES["basic"], "mu", 0.0, 1.0).point
    assert basic is not None
    assert basic.value == pytest.approx(0.64, abs=5e-4)
    assert basic.frequency_hz == pytest.approx(2400.0, abs=0.5)
    assert basic.kind == "flutter"
    model = stability_boundary(BRAKES["model"], "pressure", 0.0, 30.0).point
    assert model is not None
    assert (model.value, model.frequency_hz) == (
        pytest.approx(15.0, abs=0.01),
        pytest.approx(2140.0, abs=0.1),
    )
    assert stability_boundary(BRAKES["model"], "mu", 0.0, 0.69, {"slope": 0.0}).point is None


@pytest.mark.parametrize(
    ("brake", "moved", "low", "high", "values"),
    [
        ("basic", "mu", 0.0, 1.0, {}),
        ("model", "pressure", 0.0, 30.0, {}),
        ("plant", "slope", 0.0, 0.2, {"pressure": 10.0}),
        ("basic", "c_con_il", 1e8, 3e8, {"mu": 0.6}),
        ("model", "abutment_stiffness", 0.0, -0.5, {"pressure": 14.0}),
        ("model", "finger_stiffness:clockwise", 0.0, 0.5, {"pressure": 14.0}),
    ],
)
def test_at_the_boundary_one_pair_lies_on_the_axis(
    brake: str, moved: str, low: float, high: float, values
) -> None:
    model = BRAKES[brake]
    found = stability_boundary(model, moved, low, high, values)
    assert found.point is not None
    way = direction(model, moved)
    at = np.linalg.eigvals(model.matrices(way.values(model, found.point.value, values)).state_matrix())
    leading = at[at.real.argmax()]
    assert abs(leading.real) < 1e-11 * np.abs(at).max()
    assert abs(leading.imag) / (2.0 * np.pi) == pytest.approx(found.point.frequency_hz, rel=1e-11)
    before = np.linspace(low, found.point.value, 41)[:-1]
    for t in before:
        assert np.linalg.eigvals(model.matrices(way.values(model, t, values)).state_matrix()).real.max() < 0.0
    step = 1e-5 * (high - low)
    moved_on = [
        np.linalg.eigvals(
            model.matrices(way.values(model, found.point.value + s, values)).state_matrix()
        ).real.max()
        for s in (-step, step)
    ]
    assert found.point.rate_1_s == pytest.approx((moved_on[1] - moved_on[0]) / (2.0 * step), rel=1e-4)


def test_it_agrees_with_the_plain_search_of_the_prediction() -> None:
    for name, model in BRAKES.items():
        for moved, top, plain in (("pressure", 25.0, onset_pressure), ("mu", 1.0, onset_mu)):
            found, wanted = stability_boundary(model, moved, 0.0, top).point, plain(model.brake)
            assert (found is None) == (wanted is None), name
            if found is not None and wanted is not None:
                assert found.value == pytest.approx(wanted.value, rel=1e-7)
                assert found.frequency_hz == pytest.approx(wanted.frequency_hz, rel=1e-7)


def test_a_body_without_couplings_is_no_instability() -> None:
    base = Matrices(np.eye(3), np.diag([0.1, 0.1, 0.0]), np.diag([1.0, 2.0, 0.0]))
    change = Matrices(np.zeros((3, 3)), np.zeros((3, 3)), np.diag([-1.0, 0.0, 0.0]))
    found = stability_boundary(Affine(base, change), "t", 0.0, 3.0)
    assert not found.starts_unstable
    assert found.point is not None
    assert found.point.value == pytest.approx(1.0, rel=1e-6)
    assert stability_boundary(Affine(base, change), "t", 0.0, 0.9).point is None


def test_unstable_from_the_start_gives_where_stability_is_regained() -> None:
    up = stability_boundary(BRAKES["basic"], "mu", 0.0, 1.0)
    down = stability_boundary(BRAKES["basic"], "mu", 1.0, 0.0)
    assert down.starts_unstable
    assert up.point is not None
    assert down.point is not None
    assert not down.point.destabilises
    assert down.point.value == pytest.approx(up.point.value, rel=1e-11)


def test_a_narrow_unstable_range_between_points_of_the_scan_is_found() -> None:
    """Growth -e^2 + small - t^2: unstable over 0.4 % of the range only."""
    width = 4e-3

    class Narrow(Affine):
        def matrices(self, values: Mapping[str, float] | None = None) -> Matrices:
            t = (values or {}).get("t", 0.0)
            return Matrices(np.eye(1), np.array([[(t - 0.5037) ** 2 - (width / 2) ** 2]]), np.eye(1))

        def derivative(self, name: str, values: Mapping[str, float] | None = None) -> Matrices:
            t = (values or {}).get("t", 0.0)
            return Matrices(np.zeros((1, 1)), np.array([[2.0 * (t - 0.5037)]]), np.zeros((1, 1)))

    one = Matrices(np.eye(1), np.eye(1), np.eye(1))
    found = stability_boundary(Narrow(one, one), "t", 0.0, 1.0)
    assert found.point is not None
    assert found.point.value == pytest.approx(0.5037 - width / 2, rel=1e-9)


def test_undamped_mode_coupling_where_eq_24_has_no_number() -> None:
    """Two modes of the undamped circulatory system coincide: lambda is not differentiable there."""
    base = Matrices(np.eye(2), np.zeros((2, 2)), np.diag([1.0, 2.0]))
    change = Matrices(np.zeros((2, 2)), np.zeros((2, 2)), np.array([[0.0, 1.0], [-1.0, 0.0]]))
    found = stability_boundary(Affine(base, change), "t", 0.0, 1.0)
    assert found.point is not None
    assert found.point.value == pytest.approx(0.5, rel=1e-8)  # (k1 - k2)^2 = 4 t^2
    assert found.point.frequency_hz * 2.0 * np.pi == pytest.approx(np.sqrt(1.5), rel=1e-6)


def test_divergence() -> None:
    base = Matrices(np.eye(2), 0.1 * np.eye(2), np.diag([1.0, 2.0]))
    change = Matrices(np.zeros((2, 2)), np.zeros((2, 2)), np.diag([-1.0, 0.0]))
    found = stability_boundary(Affine(base, change), "t", 0.0, 3.0).point
    assert found is not None
    assert (found.kind, found.frequency_hz) == ("divergence", 0.0)
    assert found.value == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(
    ("brake", "moved", "low", "high", "along", "values"),
    [
        ("basic", "mu", 0.0, 1.0, "c_con_it", np.linspace(1.0e8, 1.6e8, 9)),
        ("model", "pressure", 0.0, 60.0, "slope", np.linspace(0.02, 0.12, 11)),
        ("plant", "pressure", 0.0, 40.0, "mu", np.linspace(0.0, 1.5, 9)),
        ("basic", "mu", 1.5, 0.0, "x_con", np.linspace(0.03, 0.035, 5)),
    ],
)
def test_curves_equal_single_boundaries(
    brake: str, moved: str, low: float, high: float, along: str, values
) -> None:
    model = BRAKES[brake]
    curve = boundary_curve(model, moved, low, high, along, values)
    assert curve.by_secular.any()
    for i in range(len(values)):
        single = stability_boundary(model, moved, low, high, {along: float(values[i])})
        assert single.starts_unstable == curve.starts_unstable[i]
        if single.point is None:
            assert np.isnan(curve.values[i])
            continue
        assert curve.values[i] == pytest.approx(single.point.value, rel=1e-9)
        assert curve.frequencies_hz[i] == pytest.approx(single.point.frequency_hz, rel=1e-9)
        assert curve.destabilises[i] == single.point.destabilises


def test_falling_friction_scales_with_slope_times_pressure() -> None:
    """D depends on k p only: p_crit k is constant (brake-identification)."""
    curve = boundary_curve(BRAKES["model"], "pressure", 0.0, 60.0, "slope", np.linspace(0.03, 0.12, 7))
    product = curve.values * curve.along_values
    np.testing.assert_allclose(product, product[0], rtol=1e-10)
    np.testing.assert_allclose(curve.frequencies_hz, curve.frequencies_hz[0], rtol=1e-10)


def test_directions_of_groups_and_variations() -> None:
    model = BRAKES["model"]
    group = next(g for g in model.groups if g.has_sides)
    by_name, by_group = direction(model, group.name), direction(model, group)
    assert by_name == by_group
    varied = variation(group, "clockwise", 0.1)
    wanted = varied.values(model)
    assert direction(model, varied).values(model, 1.0) == pytest.approx(wanted)
    assert direction(model, f"{group.name}:clockwise").values(model, 0.1) == pytest.approx(wanted)
    way = direction(model, f"{group.name}:clockwise")
    exact = way.derivative(model, 0.05)
    up, down = (model.matrices(way.values(model, 0.05 + s)) for s in (1e-5, -1e-5))
    for key in ("mass", "damping", "stiffness"):
        numeric = (getattr(up, key) - getattr(down, key)) / 2e-5
        np.testing.assert_allclose(getattr(exact, key), numeric, atol=1e-6 * max(1.0, np.abs(numeric).max()))


def test_bad_input_is_refused_with_names() -> None:
    model = BRAKES["model"]
    with pytest.raises(KeyError, match="did you mean"):
        stability_boundary(model, "presure", 0.0, 1.0)
    with pytest.raises(KeyError):
        stability_boundary(model, "mu", 0.0, 1.0, {"nothing": 1.0})
    with pytest.raises(ValueError, match="two different"):
        stability_boundary(model, "mu", 1.0, 1.0)
    with pytest.raises(ValueError, match="two different"):
        stability_boundary(model, "mu", 0.0, float("inf"))
    with pytest.raises(ValueError, match="not negative"):
        stability_boundary(model, "mu", -1.0, 1.0)
    with pytest.raises(ValueError, match="name another"):
        boundary_curve(model, "mu", 0.0, 1.0, "mu", np.linspace(0.0, 1.0, 3))


def test_rate_is_nan_where_eigenvalues_coincide() -> None:
    two = Matrices(np.eye(2), 0.1 * np.eye(2), np.eye(2))
    value = complex(np.linalg.eigvals(two.state_matrix())[0])
    assert np.isnan(eigenvalue_rate(two, two, value))

"""Eigenvalue tracking: numbers of Figs 7 and 13, identity through avoided crossings, exceptional points,
splitting.
"""

from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim_hardware.brake_model import load_brake
from sim_hardware.brake_model.eigen.tracking import Flag, track
from sim_hardware.brake_model.eigen.tracking_events import mode_couplings
from sim_hardware.brake_model.linear import Matrices, NamedQuantity
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.stability import onset_pressure

ROOT = Path(__file__).parents[3]
Array = np.ndarray


class Affine:
    """M, D, K as functions of one quantity s."""

    name = "affine"
    groups = ()

    def __init__(
        self, n: int, parts: Callable[[float], tuple[Array, Array, Array]], rates: tuple[Array, Array, Array]
    ) -> None:
        self.freedoms = tuple(f"q{i}" for i in range(n))
        self.quantities = {"s": NamedQuantity("s", 0.0, "1", "other")}
        self._parts, self._rates = parts, rates

    def matrices(self, values: Mapping[str, float] | None = None) -> Matrices:
        return Matrices(*(np.asarray(m, dtype=float) for m in self._parts((values or {}).get("s", 0.0))))

    def derivative(self, name: str, values: Mapping[str, float] | None = None) -> Matrices:
        assert name == "s"
        return Matrices(*(np.asarray(m, dtype=float) for m in self._rates))


class Permuted:
    """A model with its degrees of freedom in another order."""

    groups = ()

    def __init__(self, model: LinearBrake, order: Array) -> None:
        self._model, self._order = model, order
        self.name, self.quantities = model.name, model.quantities
        self.freedoms = tuple(model.freedoms[i] for i in order)

    def _shuffled(self, m: Matrices) -> Matrices:
        index = np.ix_(self._order, self._order)
        return Matrices(m.mass[index], m.damping[index], m.stiffness[index])

    def matrices(self, values: Mapping[str, float] | None = None) -> Matrices:
        return self._shuffled(self._model.matrices(values))

    def derivative(self, name: str, values: Mapping[str, float] | None = None) -> Matrices:
        return self._shuffled(self._model.derivative(name, values))


EYE, ZERO = np.eye(2), np.zeros((2, 2))


def flutter(damping: Array) -> Affine:
    """Two degrees of freedom with nonconservative coupling; undamped they coalesce at s = 0.1."""
    square = (2.0 * np.pi * 1000.0) ** 2
    return Affine(
        2,
        lambda s: (EYE, damping, square * np.array([[1.2, -s], [s, 1.0]])),
        (ZERO, ZERO, square * np.array([[0.0, -1.0], [1.0, 0.0]])),
    )


def veering(coupling: float) -> Affine:
    """Two oscillators whose frequencies meet at s = 1 but for a weak spring."""
    return Affine(
        2,
        lambda s: (EYE, 0.01 * EYE, np.array([[1.0 + s, -coupling], [-coupling, 2.0]])),
        (ZERO, ZERO, np.diag([1.0, 0.0])),
    )


@pytest.fixture(scope="module")
def basic() -> LinearBrake:
    return LinearBrake(load_brake(ROOT / "configs/brakes/basic.toml"))


@pytest.fixture(scope="module")
def refined() -> LinearBrake:
    return LinearBrake(load_brake(ROOT / "configs/brakes/model.toml"))


def test_figure_7_destabilised_at_064_by_coupling_of_the_two_modes_at_2400_hz(basic: LinearBrake) -> None:
    locus = track(basic, "mu", np.linspace(0.47, 0.69, 23), {"slope": 0.0})
    (crossing,) = locus.crossings
    assert crossing.value == pytest.approx(0.640, abs=1e-3)
    assert crossing.frequency_hz == pytest.approx(2400.0, abs=1.0)
    assert crossing.kind == "flutter" and crossing.destabilising and locus.events == ()
    first, *others = mode_couplings(locus)
    assert first.coupled and not any(other.coupled for other in others)
    assert crossing.mode in first.modes
    assert first.frequencies_hz[0] == pytest.approx((2351.8, 2460.5), abs=0.1)
    assert first.frequencies_hz[-1] == pytest.approx((2405.5, 2419.9), abs=0.1)
    assert first.real_parts_1_s[-1] == pytest.approx((83.8, -437.4), abs=0.1)
    assert 0.55 < first.exceptional_value < 0.68 and first.distance < 0.06


def test_figure_13_destabilised_at_15_bar_and_2140_hz_without_coupling(refined: LinearBrake) -> None:
    locus = track(refined, "pressure", np.linspace(0.0, 25.0, 26), {"slope": 0.0576})
    (crossing,) = locus.crossings
    assert crossing.value == pytest.approx(15.0, abs=0.01)
    assert crossing.frequency_hz == pytest.approx(2140.0, abs=0.1)
    assert not any(coupling.coupled for coupling in mode_couplings(locus))
    onset = onset_pressure(refined.brake, slope_s_m=0.0576)
    assert onset is not None and crossing.value == pytest.approx(onset.value, rel=1e-8)
    index = crossing.mode - 1  # the rate of eq 24 against the neighbouring grid points
    slope = np.gradient(locus.real_parts[:, index], locus.grid)[15]
    assert crossing.rate_1_s == pytest.approx(slope, rel=1e-3)


def test_eigenvalues_are_those_of_lapack(basic: LinearBrake) -> None:
    locus = track(basic, "mu", np.linspace(0.0, 2.0, 9))
    for mu, upper, lower in zip(locus.grid, locus.eigenvalues, locus.partners, strict=True):
        expected = np.linalg.eigvals(basic.matrices({"mu": mu}).state_matrix())
        ours = np.concatenate([upper, lower])
        distance = np.abs(ours[:, None] - expected[None, :])
        assert distance.min(axis=1).max() < 1e-9 * np.abs(expected).max()
        assert len(set(distance.argmin(axis=1).tolist())) == len(ours)


@pytest.mark.parametrize(
    ("name", "low", "high"), [("mu", 0.0, 2.0), ("x_pis", 0.008, 0.04), ("c_con_it", 5e7, 4e8)]
)
def test_coarse_steps_give_the_identity_of_fine_steps(
    basic: LinearBrake, name: str, low: float, high: float
) -> None:
    fine = track(basic, name, np.linspace(low, high, 601))
    coarse = track(basic, name, np.linspace(low, high, 4))
    assert np.abs(coarse.eigenvalues - fine.eigenvalues[::200]).max() < 1e-7 * np.abs(fine.eigenvalues).max()
    assert np.abs(np.diff(fine.eigenvalues, axis=0)).max() < 0.02 * np.abs(fine.eigenvalues).max()  # no jumps


def test_backwards_is_the_same_way_back(basic: LinearBrake) -> None:
    grid = np.linspace(0.0, 1.0, 12)
    up, down = track(basic, "mu", grid), track(basic, "mu", grid[::-1])
    order = np.argsort(up.eigenvalues[-1].imag)  # numbers are given at the start of each
    assert np.abs(down.eigenvalues[::-1] - up.eigenvalues[:, order]).max() < 1e-6
    assert down.crossings[0].value == pytest.approx(up.crossings[0].value, rel=1e-9)
    assert up.crossings[0].destabilising and not down.crossings[0].destabilising


@given(st.permutations(range(14)))
@settings(max_examples=8, deadline=None)
def test_order_of_freedoms_does_not_matter(order: list[int]) -> None:
    model = LinearBrake(load_brake(ROOT / "configs/brakes/basic.toml"))
    grid = np.linspace(0.4, 0.8, 7)
    one, other = track(model, "mu", grid), track(Permuted(model, np.array(order)), "mu", grid)
    assert np.abs(one.eigenvalues - other.eigenvalues).max() < 1e-8 * np.abs(one.eigenvalues).max()


@pytest.mark.parametrize("coupling", [1e-1, 1e-2, 1e-3, 1e-4])
@pytest.mark.parametrize("count", [2, 6, 21])
def test_avoided_crossing_keeps_the_upper_mode_above(coupling: float, count: int) -> None:
    locus = track(veering(coupling), "s", np.linspace(0.0, 2.0, count))
    assert (locus.frequencies_hz[:, 1] > locus.frequencies_hz[:, 0]).all()
    assert locus.events == ()


@pytest.mark.parametrize("count", [3, 20, 21])  # 3 and 21 have a point where they coincide
def test_uncoupled_modes_pass_through_each_other(count: int) -> None:
    locus = track(veering(0.0), "s", np.linspace(0.0, 2.0, count))
    first = np.sqrt(1.0 + locus.grid - 0.005**2) / (2.0 * np.pi)
    assert locus.frequencies_hz[:, 0] == pytest.approx(first, rel=1e-9)
    (event,) = locus.events
    assert event.kind == "crossing" and event.modes == (1, 2) and event.value == pytest.approx(1.0, abs=1e-4)
    assert (locus.flags & Flag.EXCEPTIONAL == 0).all()


@pytest.mark.parametrize("count", [20, 21])
def test_exceptional_point_is_marked_and_located(count: int) -> None:
    locus = track(flutter(ZERO), "s", np.linspace(0.0, 0.2, count))
    (event,) = locus.events
    assert (
        event.kind == "exceptional" and event.modes == (1, 2) and event.value == pytest.approx(0.1, abs=1e-5)
    )
    marked = (locus.flags & Flag.EXCEPTIONAL) > 0
    assert marked.sum() == 2 and marked[np.searchsorted(locus.grid, 0.0999)].all()
    (crossing,) = locus.crossings
    assert crossing.value == pytest.approx(0.1, rel=1e-6)
    assert crossing.frequency_hz == pytest.approx(1000.0 * np.sqrt(1.1), rel=1e-6)
    assert crossing.destabilising and np.isnan(crossing.rate_1_s)


def test_near_an_exceptional_point_identity_is_clear() -> None:
    model = flutter(np.diag([20.0, 10.0]))
    coarse, fine = track(model, "s", np.linspace(0.0, 0.2, 5)), track(model, "s", np.linspace(0.0, 0.2, 4001))
    assert coarse.events == () and fine.events == ()
    assert np.abs(coarse.eigenvalues - fine.eigenvalues[::1000]).max() < 1e-6 * np.abs(fine.eigenvalues).max()
    (strongest,) = mode_couplings(fine)
    assert strongest.coupled and strongest.exceptional_value == pytest.approx(0.1, abs=2e-3)


def test_a_vibration_that_ceases_becomes_two_real_eigenvalues_and_back() -> None:
    one = np.eye(1)
    model = Affine(1, lambda s: (one, s * one, 100.0 * one), (0.0 * one, one, 0.0 * one))
    locus = track(model, "s", np.linspace(1.0, 40.0, 14))
    (event,) = locus.events
    assert event.kind == "split" and event.value == pytest.approx(20.0, abs=1e-3)
    real = (locus.flags[:, 0] & Flag.REAL) > 0
    assert (real == (locus.grid > 20.0)).all()
    assert (locus.frequencies_hz[real, 0] == 0.0).all()
    s = locus.grid[real]
    assert locus.eigenvalues[real, 0].real == pytest.approx(-s / 2 + np.sqrt(s**2 / 4 - 100.0), rel=1e-9)
    assert locus.partners[real, 0].real == pytest.approx(-s / 2 - np.sqrt(s**2 / 4 - 100.0), rel=1e-9)
    back = track(model, "s", np.linspace(40.0, 1.0, 14))
    assert [e.kind for e in back.events] == ["merge"]
    assert back.eigenvalues[::-1] == pytest.approx(locus.eigenvalues, rel=1e-9)


def test_divergence_is_told_from_flutter() -> None:
    one = np.eye(1)
    model = Affine(1, lambda s: (one, 2.0 * one, (100.0 - s) * one), (0.0 * one, 0.0 * one, -one))
    (crossing,) = track(model, "s", np.linspace(0.0, 203.0, 21)).crossings
    assert crossing.kind == "divergence" and crossing.frequency_hz == 0.0
    assert crossing.value == pytest.approx(100.0, rel=1e-9)


def test_a_mode_unstable_only_between_two_grid_points_is_found() -> None:
    rates = (ZERO, np.array([[-1.0, 0.0], [0.0, 0.0]]), ZERO)
    model = Affine(2, lambda s: (EYE, np.diag([(s - 0.5) ** 2 - 0.01, 1.0]), np.diag([100.0, 400.0])), rates)
    model.derivative = lambda name, values=None: Matrices(  # type: ignore[method-assign]
        ZERO, np.diag([2.0 * ((values or {}).get("s", 0.0) - 0.5), 0.0]), ZERO
    )
    found = track(model, "s", [0.0, 1.0]).crossings
    assert [c.destabilising for c in found] == [True, False]
    assert [c.value for c in found] == pytest.approx([0.4, 0.6], rel=1e-9)


def test_rigid_body_modes_and_equal_modes_are_kept_apart_from_trouble() -> None:
    three, none = np.eye(3), np.zeros((3, 3))
    model = Affine(
        3, lambda s: (three, none, np.diag([1.0 + s, 1.0 + s, 0.0])), (none, none, np.diag([1.0, 1.0, 0.0]))
    )
    locus = track(model, "s", np.linspace(0.0, 2.0, 9))
    assert (locus.eigenvalues[:, 0] == 0.0).all() and locus.crossings == () and locus.events == ()
    assert locus.eigenvalues[:, 1].imag == pytest.approx(np.sqrt(1.0 + locus.grid), rel=1e-9)


def test_extremes_of_friction_track_without_trouble(basic: LinearBrake) -> None:
    locus = track(basic, "mu", np.linspace(0.0, 12.0, 25))
    assert np.isfinite(locus.eigenvalues).all()
    assert not any(event.kind == "unresolved" for event in locus.events)
    total = locus.eigenvalues.real.sum(axis=1) + locus.partners.real.sum(axis=1)
    m = basic.matrices({"mu": 3.0})
    assert total == pytest.approx(
        -np.trace(np.linalg.solve(m.mass, m.damping)), rel=1e-9
    )  # independent of mu


def test_extreme_damping_keeps_slow_modes_apart_from_zero(basic: LinearBrake) -> None:
    """Contacts like rock: four eigenvalues beyond 1e8 1/s, four creep at some 1/s, none is zero or
    unstable.
    """
    locus = track(basic, "d_con", np.geomspace(1.0, 1e8, 17))
    creeping = np.sort(locus.eigenvalues[-1].real)[-4:]
    assert creeping == pytest.approx([-3.65, -2.39, -2.34, -1.52], abs=0.01)
    assert [event.kind for event in locus.events] == ["split"] * 4 and locus.crossings == ()


def test_undamped_brake_couples_exactly_where_the_damped_one_says(basic: LinearBrake) -> None:
    """Without damping the two modes of Fig. 7 coincide; eq 24 on the damped model foretells the place."""
    free = {name: 0.0 for name in basic.quantities if name.startswith("d_")}
    (event,) = track(basic, "mu", np.linspace(0.0, 1.0, 21), free).events
    assert event.kind == "exceptional" and event.modes == (7, 8)
    foretold = mode_couplings(track(basic, "mu", np.linspace(0.47, 0.69, 23)))[0].exceptional_value
    assert event.value == pytest.approx(foretold, abs=1e-3)


def test_group_by_a_relative_factor_and_against_its_side(refined: LinearBrake) -> None:
    signs = {"c_con_il": 1.0, "c_con_it": -1.0}
    locus = track(refined, signs, [0.9, 1.0, 1.1], {"mu": 0.5})
    values = {name: refined.quantities[name].value * (1.0 + sign * 0.1) for name, sign in signs.items()}
    expected = np.linalg.eigvals(refined.matrices({**values, "mu": 0.5}).state_matrix())
    assert np.sort(locus.eigenvalues[2].imag) == pytest.approx(
        np.sort(expected[expected.imag > 0].imag), rel=1e-9
    )
    group = next(g for g in refined.groups if g.has_sides)
    whole, opposite = (
        track(refined, group.name, [1.0, 1.05]),
        track(refined, group, [1.0, 1.05], asymmetric=True),
    )
    assert whole.eigenvalues[0] == pytest.approx(opposite.eigenvalues[0], rel=1e-12)
    assert np.abs(whole.eigenvalues[1] - opposite.eigenvalues[1]).max() > 1e-3


@pytest.mark.parametrize(
    ("what", "grid", "problem"),
    [
        ("mu", [0.4], "at least two"),
        ("mu", [0.4, 0.4], "strictly"),
        ("mu", [0.4, np.nan], "finite"),
        ("mu", [-0.2, 0.4], "not negative"),
        ("muu", [0.0, 0.4], "did you mean"),
        ("c_pis_n", [-1e8, 1e8], "positive"),
    ],
)
def test_bad_input_says_what_is_wrong(basic: LinearBrake, what: str, grid: list[float], problem: str) -> None:
    with pytest.raises((KeyError, ValueError), match=problem):
        track(basic, what, grid)

"""Modifications and technical sensitivity: counts, factors, identity of modes, batches, onsets."""

from pathlib import Path

import numpy as np
import pytest
from scipy import sparse

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.design.margins import onsets
from sim_hardware.brake_model.design.matrix_batches import matrix_batch
from sim_hardware.brake_model.design.resolving import resolve
from sim_hardware.brake_model.design.resolving_band import resolve_in_band
from sim_hardware.brake_model.design.sensitivity import eigen_sensitivities
from sim_hardware.brake_model.design.variations import (
    Variation,
    all_variations,
    group_of,
    groups_like,
    variation,
)
from sim_hardware.brake_model.foreign.matrix_model import MatrixModel
from sim_hardware.brake_model.linear import Matrices, NamedQuantity, ParameterGroup, value_of
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.stability import onset_pressure

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
BRAKE = load_brake(BRAKES / "model.toml")
MODEL = LinearBrake(BRAKE)
ALL = all_variations(MODEL)


class Coupled:
    """Two oscillators coupled by a force without potential, K = [[1, p], [-p, 2]]: they meet at p = 0.5.

    Undamped they pass through one point, and which is which afterwards is undefined; `split` keeps them
    apart.
    """

    name, freedoms, groups = "coupled", ("a", "b"), ()

    def __init__(self, split: float = 0.0) -> None:
        self.split = split
        self.quantities = {"p": NamedQuantity("p", 0.4, "1", "other")}

    def matrices(self, values=None) -> Matrices:
        p = value_of(self, "p", values)
        return Matrices(np.eye(2), np.diag([0.0, self.split]), np.array([[1.0, p], [-p, 2.0]]))

    def derivative(self, name, values=None) -> Matrices:
        zero = np.zeros((2, 2))
        return Matrices(zero, zero, np.array([[0.0, 1.0], [-1.0, 0.0]]))


def test_shipped_brakes_have_more_than_100_modifications_each_with_an_effect() -> None:
    for file in ("model.toml", "basic.toml", "plant.toml"):
        model = LinearBrake(load_brake(BRAKES / file))
        variations = all_variations(model)
        assert len(variations) > 100 and len({v.name for v in variations}) == len(variations)
        nominal = model.matrices()
        for v in variations:
            changed = model.matrices(v.values(model))
            difference = max(
                np.abs(a - b).max() / np.abs(a).max()
                for a, b in ((nominal.mass, changed.mass), (nominal.damping, changed.damping),
                             (nominal.stiffness, changed.stiffness))
            )  # fmt: skip
            assert difference > 1e-6, v.name


def test_modes_of_a_group_with_sides() -> None:
    group = ParameterGroup("g", "Group", "stiffness", ("l1", "l2"), ("t",), ("b",))
    assert variation(group, "increase").factors == pytest.approx({"l1": 1.1, "l2": 1.1, "t": 1.1, "b": 1.1})
    assert variation(group, "decrease", 0.2).factors == pytest.approx(
        {"l1": 0.8, "l2": 0.8, "t": 0.8, "b": 0.8}
    )
    assert variation(group, "clockwise").factors == pytest.approx({"l1": 1.1, "l2": 1.1, "t": 0.9})
    assert variation(group, "counter-clockwise").factors == pytest.approx({"l1": 0.9, "l2": 0.9, "t": 1.1})
    assert variation(group, "clockwise").title == "Group, leading +10 %, trailing −10 %"


def test_shifting_points_moves_both_to_one_edge_and_keeps_their_distance() -> None:
    shifted = variation(group_of(MODEL, "piston_position"), "clockwise").values(MODEL)
    moved = {name: value - MODEL.quantities[name].value for name, value in shifted.items()}
    assert len(moved) == 4 and all(change == pytest.approx(-0.0017) for change in moved.values())


def test_errors_of_variations_say_what_to_do() -> None:
    sided, plain = group_of(MODEL, "piston_stiffness"), group_of(MODEL, "disc_mass")
    with pytest.raises(ValueError, match="between 0 and 1"):
        variation(sided, "increase", 10.0)
    with pytest.raises(ValueError, match="symmetrically only"):
        variation(plain, "clockwise")
    with pytest.raises(ValueError, match="increase, decrease"):
        variation(plain, "up")  # type: ignore[arg-type]
    with pytest.raises(KeyError, match="piston_stiffness"):
        all_variations(MODEL, groups=["pistons"])
    assert {g.name for g in groups_like(MODEL, "tie")} == {"tie_stiffness", "tie_damping"}


def test_batch_of_matrices_equals_the_model_one_by_one() -> None:
    points = (
        {"mu": 0.4},
        {"mu": 0.6, "pressure": 7.0, "slope": 0.03},
        {"piston_area": 2e-3, "pressure": 3.0},
    )
    variants = [{**p, **v.values(MODEL)} for v in ALL[::5] for p in points]
    batch = matrix_batch(MODEL, variants)
    states = batch.state_matrices()
    for number, values in enumerate(variants):
        single = MODEL.matrices(values)
        for ours, theirs in ((batch.mass, single.mass), (batch.damping, single.damping),
                             (batch.stiffness, single.stiffness)):  # fmt: skip
            assert np.abs(ours[number] - theirs).max() <= 1e-14 * np.abs(theirs).max()
        assert np.abs(states[number] - single.state_matrix()).max() <= 1e-12 * np.abs(states[number]).max()


def test_batch_refuses_what_the_model_refuses() -> None:
    with pytest.raises(ValueError, match="mu"):
        matrix_batch(MODEL, [{"mu": -0.1}])
    with pytest.raises(ValueError, match=r"c_con_il|contact_il"):
        matrix_batch(MODEL, [{"c_con_il": -1.0}])


def test_resolved_eigenvalues_are_those_of_a_plain_loop_and_modes_keep_their_columns() -> None:
    resolved = resolve(MODEL, ALL, ({"mu": 0.4}, {"mu": 0.6}))
    assert resolved.sure.all() and resolved.nominal_sure.all()
    for k, mu in enumerate((0.4, 0.6)):
        for number, v in enumerate(ALL):
            plain = np.linalg.eigvals(MODEL.matrices(v.values(MODEL, {"mu": mu})).state_matrix())
            ours = resolved.varied[number, k]
            assert np.abs(np.sort_complex(plain) - np.sort_complex(ours)).max() <= 1e-9 * np.abs(plain).max()
    assert np.all(resolved.varied[..., ::2] == resolved.varied[..., 1::2].conj())


def test_small_modifications_agree_with_eq_24() -> None:
    tiny = all_variations(MODEL, 1e-4)
    resolved = resolve(MODEL, tiny)
    names = sorted({name for v in tiny for name in v.factors})
    analytic = eigen_sensitivities(MODEL, names)
    row = dict(zip(names, analytic.per_percent, strict=True))
    for number, v in enumerate(tiny):
        expected = sum(100.0 * (factor - 1.0) * row[name] for name, factor in v.factors.items())
        found = resolved.varied[number, 0] - resolved.nominal[0]
        assert np.abs(found - expected).max() <= 1e-5 + 0.02 * np.abs(expected).max(), v.name


def test_steps_are_refined_where_modes_come_near_and_flagged_where_they_meet() -> None:
    through = Variation("p:increase", "p", "p", "increase", {"p": 1.5})
    meeting = resolve(Coupled(), [through])
    assert not meeting.sure.any()
    apart = resolve(Coupled(split=0.02), [through])
    assert apart.sure.all()
    fine = resolve(Coupled(split=0.02), [Variation("", "", "p", "increase", {"p": 1.0 + 0.5 * s})
                                        for s in np.linspace(0.002, 1.0, 500)])  # fmt: skip
    steps = np.abs(np.diff(fine.varied[:, 0], axis=0))
    assert steps.max() < 0.01  # each column is one continuous path
    np.testing.assert_allclose(fine.varied[-1, 0], apart.varied[0, 0])


def test_onsets_of_a_batch_are_those_of_single_brakes() -> None:
    chosen = [ALL[i] for i in (0, 20, 50, 90, 120)]
    found = onsets(MODEL, [{}, *(v.values(MODEL) for v in chosen)], high=40.0)
    single = onset_pressure(BRAKE, pressure_max_bar=40.0)
    assert single is not None
    assert found.values[0] == pytest.approx(single.value, abs=1e-6)
    assert found.frequencies_hz[0] == pytest.approx(single.frequency_hz, abs=1e-4)
    for v, value in zip(chosen, found.values[1:], strict=True):
        for offset, stable in ((-1e-4, True), (1e-4, False)):
            state = MODEL.matrices(v.values(MODEL, {"pressure": value + offset})).state_matrix()
            assert (np.linalg.eigvals(state).real.max() < 0.0) == stable, v.name


def test_onset_of_a_stable_and_of_an_unstable_model() -> None:
    found = onsets(MODEL, [{"slope": 0.0}, {"slope": 10.0}, {}], low=2.0, high=30.0)
    assert np.isnan(found.values[0]) and np.isnan(found.frequencies_hz[0])
    assert found.values[1] == 2.0 and found.values[2] == pytest.approx(15.0016, abs=1e-3)
    with pytest.raises(ValueError, match="range"):
        onsets(MODEL, [{}], low=1.0, high=1.0)


def test_modes_of_a_band_are_those_of_the_whole_model() -> None:
    some, points = ALL[:24], ({"mu": 0.4}, {"mu": 0.6})
    whole = resolve(MODEL, some, points)
    band = resolve_in_band(MODEL, some, points, None, (1500.0, 3500.0))
    chosen = (whole.frequencies_hz > 1500.0) & (whole.frequencies_hz < 3500.0)
    assert band.varied.shape == (24, 2, 10) and band.nominal_sure.all()
    difference = np.abs(band.varied - whole.varied[:, :, chosen])
    assert difference[band.sure].max() < 1e-4 and band.sure.mean() > 0.95


def test_large_sparse_model_is_varied_in_a_band() -> None:
    """A chain of 260 masses on springs whose lower end rubs: parts as groups, band of some modes."""
    n = 260
    above = sparse.eye_array(n, k=1)
    chain = (2.0 * sparse.eye_array(n) - above - above.T) * 1e8
    rubbing = sparse.coo_array(([2e5], ([0], [1])), shape=(n, n))
    parts = {"M": sparse.eye_array(n), "D": 1e-6 * chain, "K": chain, "K_mu": rubbing}
    model = MatrixModel("chain", parts, {"mu": 0.4})
    variations = all_variations(model, 0.01, groups=["k"], modes=["increase"])
    found = resolve_in_band(model, variations, ({},), None, (150.0, 210.0))
    assert found.sure.all() and found.nominal.size >= 4
    dense = np.linalg.eigvals(model.matrices(variations[0].values(model)).state_matrix())
    assert np.abs(found.varied[0, 0][:, None] - dense[None, :]).min(axis=1).max() < 1e-5

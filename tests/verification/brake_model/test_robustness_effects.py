"""Robustness (eq 25), effect classes, recommendations: known numbers of our brake, rules on made-up
patterns.
"""

from pathlib import Path

import numpy as np
import pytest

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.design.effects import EffectRule, classify, influence, one_of_each_pair
from sim_hardware.brake_model.design.recommending import recommend
from sim_hardware.brake_model.design.robustness import robustness
from sim_hardware.brake_model.design.variations import all_variations
from sim_hardware.brake_model.parametric import LinearBrake

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
MODEL = LinearBrake(load_brake(BRAKES / "model.toml"))
ALL = all_variations(MODEL)


@pytest.fixture(scope="module")
def study():
    return robustness(MODEL, ALL)


def test_robustness_of_the_basic_design(study) -> None:
    assert study.basic.shape == (28,)
    assert np.array_equal(study.basic[::2], study.basic[1::2])  # equal in pairs
    assert study.reference == pytest.approx(19.02, abs=0.01)
    worst = int(np.argmax(study.basic))
    assert study.frequencies_hz[worst] == pytest.approx(7177, abs=1)
    below = study.frequencies_hz < 5000.0
    assert study.basic[below].max() == pytest.approx(0.440, abs=0.001)


def test_robustness_is_the_definition(study) -> None:
    low, high = (np.linalg.eigvals(MODEL.matrices({"mu": mu}).state_matrix()) for mu in (0.4, 0.6))
    assert study.basic.sum() == pytest.approx((high.real.sum() - low.real.sum()) / 0.2, abs=1e-7)
    least_damped = [e[np.abs(e.imag / 2 / np.pi - 2140) < 3][0] for e in (low, high)]
    found = study.basic[np.argmin(np.abs(study.frequencies_hz - 2140.0))]
    assert found == pytest.approx((least_damped[1].real - least_damped[0].real) / 0.2, rel=1e-6)


def test_sum_of_robustness_values_is_that_of_the_trace(study) -> None:
    """Zero, except where contact damping is uneven along the disc: then mu itself has a share in the
    damping.
    """
    d_mu = MODEL.derivative("mu")
    for v, total in zip([None, *study.variations], study.sums, strict=True):
        values = {} if v is None else v.values(MODEL)
        mass, d_mu = MODEL.matrices(values).mass, MODEL.derivative("mu", values)
        assert total == pytest.approx(-np.trace(np.linalg.solve(mass, d_mu.damping)), abs=1e-6)
        if v is None or v.symmetric or not v.group.startswith("contact"):
            assert abs(total) < 1e-6


def test_mirror_symmetric_brake_does_not_feel_friction() -> None:
    """With axial elements alike on both sides no eigenvalue depends on mu: asymmetry is needed for squeal."""
    mean = {}
    for a, b in (("contact_il.stiffness", "contact_it.stiffness"), ("contact_ol.stiffness",
    "contact_ot.stiffness"),
                 ("abutment_il.stiffness_y", "abutment_it.stiffness_y"),
                 ("abutment_ol.stiffness_y", "abutment_ot.stiffness_y"),
                 ("guide_l.stiffness_y", "guide_t.stiffness_y")):  # fmt: skip
        both = 0.5 * (MODEL.quantities[a].value + MODEL.quantities[b].value)
        mean |= {a: both, b: both}
    assert np.abs(robustness(MODEL, values=mean, high=2.0).basic).max() < 1e-6


def test_order_of_friction_values_is_checked() -> None:
    with pytest.raises(ValueError, match="larger"):
        robustness(MODEL, low=0.6, high=0.4)


F = np.array([700.0, 900.0, 1400.0, 2100.0, 3000.0, 4200.0, 6000.0, 8000.0])
RE = -0.05 * F


@pytest.mark.parametrize(
    ("changes", "classes"),
    [
        ([0, 0, 0, 0, 0, 0, -5, -4], ("narrow band", "monodirectional")),
        ([0, 0, 0, 0, 0, 0, 5, -4], ("narrow band", "mode coupling", "bidirectional")),
        ([3, 3, 3, 3, 3, 3, 3, 3], ("broad band", "monodirectional")),
        ([3, -3, 3, -3, 3, -3, 3, -3], ("broad band", "mode coupling", "bidirectional")),
        ([0, 0, 0, 2, 0, 2, 0, 0], ("narrow band", "monodirectional")),
        ([5, 0, 0, 0, 0, 0, 0, 5], ("monodirectional",)),  # two modes far apart: neither narrow nor broad
        ([1e-4] * 8, ("negligible",)),
    ],
)
def test_effect_classes_of_made_up_patterns(changes, classes) -> None:
    effect = classify(np.array(changes, dtype=float), F, RE)
    assert effect.classes == classes
    assert effect.total == pytest.approx(sum(changes))


def test_effect_does_not_depend_on_order_or_scale() -> None:
    changes, shuffle = np.array([0, 1.0, 0, -2, 2.5, 0, 4, -4]), np.random.default_rng(1).permutation(8)
    effect, mixed = classify(changes, F, RE), classify(changes[shuffle], F[shuffle], RE[shuffle])
    assert (effect.classes, effect.band_hz, effect.against) == (mixed.classes, mixed.band_hz, mixed.against)
    assert {frozenset(F[i] for i in p) for p in effect.coupled} == {
        frozenset(F[shuffle][i] for i in p) for p in mixed.coupled
    }
    assert classify(30.0 * changes, F, RE).classes == effect.classes
    assert classify(changes, F, RE, EffectRule(broad_octaves=5.0)).classes == (
        "mode coupling",
        "bidirectional",
    )


def test_influence_of_the_piston_group_as_in_fig_10() -> None:
    effects = {v.name: e for v, e in zip(ALL, influence(MODEL, ALL).effects, strict=True)}
    stiffness = effects["piston_stiffness:increase"]
    assert stiffness.classes == ("narrow band", "mode coupling", "bidirectional")
    assert stiffness.band_hz[0] > 5000.0 and abs(stiffness.total) < 1e-6
    distance = effects["piston_position:increase"]
    assert "monodirectional" in distance.classes and distance.direction == -1
    assert distance.total == pytest.approx(-36.0, abs=0.1)
    assert "broad band" not in effects["piston_position:clockwise"].classes  # the paper's brake differs here


def test_influence_is_the_plain_difference() -> None:
    some = [v for v in ALL if v.group == "abutment_damping"]
    found = influence(MODEL, some, {"pressure": 10.0}, mu=0.5)
    base = {"pressure": 10.0, "mu": 0.5}
    for v, row in zip(some, found.changes, strict=True):
        ends = [np.linalg.eigvals(MODEL.matrices(x).state_matrix()) for x in (base, v.values(MODEL, base))]
        assert row.sum() == pytest.approx((ends[1] - ends[0]).real.sum(), abs=1e-6)


def test_recommendations_are_ranked_and_say_what_they_measure() -> None:
    some = all_variations(
        MODEL, groups=["abutment_damping", "pad_mass", "contact_position", "hub_stiffness_tangential"]
    )
    found = recommend(MODEL, some)
    verdict = dict(zip([v.name for v in some], found.verdicts, strict=True))
    assert verdict["abutment_damping:increase"] == verdict["pad_mass:decrease"] == "recommended"
    assert verdict["abutment_damping:decrease"] == verdict["contact_position:decrease"] == "not recommended"
    assert verdict["hub_stiffness_tangential:increase"] == "no effect"
    ranked = [some[i].name for i in found.order]
    assert ranked[:2] == ["pad_mass:decrease", "abutment_damping:increase"]
    best = found.order[0]
    kept = one_of_each_pair(found.resolved.nominal[0])
    below = kept[found.resolved.frequencies_hz[kept] < 5000.0]
    falls = -(found.resolved.varied[best] - found.resolved.nominal)[:, below].real.sum(axis=1)
    assert found.gains[best] == pytest.approx(falls.min())
    assert found.onset is not None and found.onset.values[0] == pytest.approx(15.0016, abs=1e-3)
    assert found.onset_changes[best] == pytest.approx(0.685, abs=0.01)


def test_recommendations_without_falling_friction_have_no_onset() -> None:
    found = recommend(MODEL, all_variations(MODEL, groups=["tie_damping"]), {"slope": 0.0})
    assert found.onset is None and np.isnan(found.onset_changes).all()

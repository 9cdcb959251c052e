"""Optimisation: the margin, its gradient, optima found against brute force, refused bounds."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.design.optimise import (
    Bounds,
    _watched,
    at_bounds,
    check_bounds,
    improve,
    stability_margin,
    starts,
    values_at,
)
from sim_hardware.brake_model.design.scatter import Variable, variables
from sim_hardware.brake_model.linear import Matrices, NamedQuantity, unknown_quantity
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.stability import eigen_pairs

MODEL = LinearBrake(load_brake(Path("configs/brakes/model.toml")))
POINTS = [{"mu": mu, "pressure": p} for mu in (0.3, 0.5) for p in (0.0, 20.0)]


@dataclass(frozen=True)
class Oscillator:
    """Two masses, free to move together: damping ratio d / (2 sqrt(c m/2) ...) and a rigid-body motion."""

    name: str = "oscillator"
    freedoms: tuple[str, ...] = ("a.x", "b.x")
    groups: tuple = ()

    @property
    def quantities(self):
        """Stiffness, damping."""
        return {
            "c": NamedQuantity("c", 4.0, "N/m", "stiffness"),
            "d": NamedQuantity("d", 0.1, "N s/m", "damping"),
        }

    def matrices(self, values=None):
        """Of unit masses."""
        at = {name: q.value for name, q in self.quantities.items()} | dict(values or {})
        spring = np.array([[1.0, -1.0], [-1.0, 1.0]])
        if at["c"] <= 0.0:
            raise ValueError("c must be positive")
        return Matrices(np.eye(2), at["d"] * spring, at["c"] * spring)

    def derivative(self, name, values=None):
        """Constant."""
        spring, zero = np.array([[1.0, -1.0], [-1.0, 1.0]]), np.zeros((2, 2))
        if name not in self.quantities:
            raise unknown_quantity(self.name, name, self.quantities)
        return Matrices(zero, spring, zero) if name == "d" else Matrices(zero, zero, spring)


def _bounds(*names, low=0.8, high=1.25):
    return tuple(Bounds(v, low, high) for v in variables(MODEL, names))


def test_margin_is_the_smallest_damping_ratio_of_the_pairs():
    found = stability_margin(MODEL, POINTS)
    ratios = {
        (p["mu"], p["pressure"]): min(
            pair.damping_ratio for pair in eigen_pairs(MODEL.brake, p["mu"], None, p["pressure"])
        )
        for p in POINTS
    }
    assert found.damping_ratio == pytest.approx(min(ratios.values()), rel=1e-9)
    assert (found.point["mu"], found.point["pressure"]) == min(ratios, key=ratios.__getitem__)
    assert found.real_part_1_s > 0.0


def test_rigid_body_motion_does_not_count():
    found = stability_margin(Oscillator(), [{}])
    assert found.damping_ratio == pytest.approx(0.1 / np.sqrt(2 * 4.0))  # 2 d / (2 sqrt(2 c))
    assert found.frequency_hz == pytest.approx(np.sqrt(8.0 - 0.01) / (2 * np.pi))


def test_gradient_is_that_of_finite_differences():
    bounds = tuple(Bounds(v, 0.8, 1.25) for v in variables(MODEL, ["x_pis", "m_padi"], ["finger_stiffness"]))
    names = tuple(n for b in bounds for n in b.variable.members)
    owner = np.repeat(np.arange(3), [len(b.variable.members) for b in bounds])

    def watched(logarithms):
        return _watched(MODEL, bounds, POINTS, np.exp(logarithms), names, owner, None)

    slopes = watched(np.zeros(3))[1]
    for i in range(3):
        step = np.zeros(3)
        step[i] = 1e-6
        numeric = (watched(step)[0] - watched(-step)[0]) / 2e-6
        assert slopes[:, i] == pytest.approx(numeric, abs=1e-7)


def test_optimum_is_that_of_brute_force():
    bounds = _bounds("c_knu_l", low=0.5, high=2.0)
    found = improve(MODEL, bounds, POINTS, np.array([0.5]))
    grid = np.exp(np.linspace(np.log(0.5), np.log(2.0), 201))
    margins = [
        stability_margin(MODEL, POINTS, values_at(MODEL, bounds, np.array([f]))).damping_ratio for f in grid
    ]
    assert found.margin >= max(margins) - 1e-7
    assert found.margin == pytest.approx(max(margins), abs=1e-5)


def test_optimum_where_two_modes_hold_the_margin_is_found_from_anywhere():
    """m_padi against c_con_il: the optimum lies on a ridge where the smallest ratio changes hands."""
    bounds = _bounds("m_padi", "c_abu_t", "x_pis")
    found = [improve(MODEL, bounds, POINTS, start) for start in starts(3, 3, 1)]
    before = stability_margin(MODEL, POINTS).damping_ratio
    assert np.ptp([f.margin for f in found]) < 2e-5
    assert found[0].margin > before + 0.001
    again = stability_margin(MODEL, POINTS, values_at(MODEL, bounds, found[0].factors)).damping_ratio
    assert again == pytest.approx(found[0].margin, abs=1e-9)


def test_a_small_model_climbs_to_its_bounds():
    model = Oscillator()
    bounds = [
        Bounds(Variable("c", "c", ("c",)), 0.5, 2.0),
        Bounds(Variable("d", "d", ("d",)), 0.5, 2.0),
    ]
    found = improve(model, bounds, [{}], np.array([0.5, 0.5]))
    assert found.factors == pytest.approx([0.5, 2.0], rel=1e-3)
    assert at_bounds(bounds, found.factors) == ("lower", "upper")
    assert found.margin == pytest.approx(0.2 / np.sqrt(2 * 2.0), rel=1e-3)


@pytest.mark.parametrize(
    ("low", "high", "words"),
    [
        (1.2, 0.8, "lower bound is not below"),
        (1.0, 1.0, "lower bound is not below"),
        (float("nan"), 1.0, "not finite"),
        (0.5, float("inf"), "not finite"),
        (-0.5, 1.0, "another sign"),
        (0.0, 1.0, "another sign"),
        (0.01, 2.0, "no design range"),
    ],
)
def test_nonsense_bounds_are_refused(low, high, words):
    with pytest.raises(ValueError, match=words):
        check_bounds(MODEL, _bounds("m_padi", low=low, high=high), POINTS, {})


def test_other_nonsense_is_refused():
    with pytest.raises(ValueError, match="nothing is free"):
        check_bounds(MODEL, (), POINTS, {})
    with pytest.raises(ValueError, match="operating range is empty"):
        check_bounds(MODEL, _bounds("m_padi"), [], {})
    with pytest.raises(ValueError, match="belongs to the operating range"):
        check_bounds(MODEL, _bounds("mu"), POINTS, {})


def test_more_starts_keep_the_first_ones():
    assert (starts(3, 5, 9) == starts(8, 5, 9)[:3]).all()
    assert not (starts(3, 5, 9) == starts(3, 5, 10)).any()

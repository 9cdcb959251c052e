"""Mode shapes: they solve the equations of motion, energies are shares, the budget of the real part is
exact.
"""

from pathlib import Path

import numpy as np
import pytest

from sim_hardware.brake_model import load_brake
from sim_hardware.brake_model.eigen.mode_shapes import (
    find_shape,
    mode_shapes,
    participation,
    point_coordinates,
)
from sim_hardware.brake_model.linear import Matrices, NamedQuantity
from sim_hardware.brake_model.parametric import LinearBrake

ROOT = Path(__file__).parents[3]
SETTINGS = [
    ("basic", {"mu": 0.64}),
    ("model", {"slope": 0.0576, "pressure": 15.0}),
    ("model", {"mu": 0.0, "d_con": 0.0}),
    ("basic", {"mu": 3.0, "x_pis": 0.02, "outer_pad.finger_l.x": -0.03}),
]


def brake(name: str) -> LinearBrake:
    return LinearBrake(load_brake(ROOT / f"configs/brakes/{name}.toml"))


@pytest.mark.parametrize(("name", "values"), SETTINGS)
def test_shapes_solve_the_equations_and_their_budget_is_the_real_part(
    name: str, values: dict[str, float]
) -> None:
    model = brake(name)
    matrices = model.matrices(values)
    shapes = mode_shapes(model, values)
    assert len(shapes) == 14 and [s.number for s in shapes] == list(range(1, 15))
    assert (np.diff([s.frequency_hz for s in shapes]) >= 0.0).all()
    for shape in shapes:
        z, x = shape.eigenvalue, shape.vector
        residual = (z * z * matrices.mass + z * matrices.damping + matrices.stiffness) @ x
        assert np.abs(residual).max() < 1e-8 * np.abs(matrices.stiffness @ x).max()
        shares = participation(model, shape, values)
        assert sum(b.kinetic for b in shares.bodies) == pytest.approx(1.0, abs=1e-12)
        assert sum(c.strain for c in shares.couplings) == pytest.approx(1.0, abs=1e-12)
        assert shares.damping_1_s + shares.friction_1_s == pytest.approx(z.real, abs=1e-6)
        assert all(c.damping_1_s <= 0.0 for c in shares.couplings)
        assert all(c.friction_1_s == 0.0 for c in shares.couplings if not c.name.startswith("contact"))


def test_without_friction_nothing_feeds_and_without_damping_nothing_is_lost() -> None:
    model = brake("model")
    for shape in mode_shapes(model, {"mu": 0.0}):
        shares = participation(model, shape, {"mu": 0.0})
        assert shares.friction_1_s == 0.0 and shares.damping_1_s < 0.0


def test_falling_friction_feeds_the_2140_hz_mode_by_150_per_second_at_15_bar() -> None:
    values = {"slope": 0.0576, "pressure": 15.0}
    model = brake("model")
    shape = find_shape(mode_shapes(model, values), near_hz=2140.0)
    shares = participation(model, shape, values)
    assert sum(c.falling_1_s for c in shares.couplings) == pytest.approx(150.0, abs=15.0)
    assert max(shares.bodies, key=lambda b: b.kinetic).name == "inner_pad"


def test_largest_point_moves_by_one_and_the_phase_is_the_best() -> None:
    model = brake("basic")
    turns = np.exp(1j * np.linspace(0.0, np.pi, 721))
    for shape in mode_shapes(model, {"mu": 0.64}):
        reach = 0.0
        for key, (r_x, r_y) in point_coordinates(model, {"mu": 0.64}).items():
            x, y, phi = (shape.body_motion(key.split(".")[0])[:, None] * turns).real
            reach = max(reach, float(np.hypot(x - phi * r_y, y + phi * r_x).max()))
        assert reach == pytest.approx(1.0, rel=1e-4)
        mass = model.matrices().mass
        energy = [shape.at_phase(p) @ mass @ shape.at_phase(p) for p in (-0.2, 0.0, 0.2)]
        assert energy[1] == max(energy)
        assert 0.0 <= shape.collinearity <= 1.0 + 1e-12


def test_choice_of_a_mode() -> None:
    shapes = mode_shapes(brake("basic"), {"mu": 0.66})
    assert find_shape(shapes).number == 7  # the unstable one
    assert find_shape(shapes, number=3).number == 3
    assert find_shape(shapes, near_hz=2420.0).number == 8
    with pytest.raises(ValueError, match="modes 1 to 14"):
        find_shape(shapes, number=15)


def test_points_follow_parameters_and_places() -> None:
    model = brake("basic")
    moved = point_coordinates(model, {"x_pis": 0.02, "inner_pad.piston_t.x": 0.025})
    assert moved["inner_pad.piston_l"][0] == pytest.approx(-0.02)
    assert moved["caliper.piston_t"][0] == pytest.approx(0.02)
    assert moved["inner_pad.piston_t"][0] == pytest.approx(0.025)


def test_any_model_has_shapes_with_its_largest_component_one() -> None:
    class Chain:
        """Three masses in a row, free at both ends: a rigid-body mode."""

        name, freedoms, groups = "chain", ("a", "b", "c"), ()

        def __init__(self) -> None:
            self.quantities = {"k": NamedQuantity("k", 1.0, "N/m", "stiffness")}

        def matrices(self, values: dict[str, float] | None = None) -> Matrices:
            k = np.array([[1.0, -1.0, 0.0], [-1.0, 2.0, -1.0], [0.0, -1.0, 1.0]])
            return Matrices(np.eye(3), 0.01 * k, k)

        def derivative(self, name: str, values: dict[str, float] | None = None) -> Matrices:
            raise NotImplementedError

    shapes = mode_shapes(Chain())
    highest = shapes[-1]
    assert highest.frequency_hz == pytest.approx(np.sqrt(3.0) / (2.0 * np.pi), rel=1e-3)
    assert np.abs(highest.vector) == pytest.approx([0.5, 1.0, 0.5], rel=1e-9)
    assert [s.frequency_hz for s in shapes[:2]] == [0.0, 0.0]
    assert np.abs(shapes[0].vector) == pytest.approx([1.0, 1.0, 1.0], abs=1e-6)

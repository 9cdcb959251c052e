"""The parametric brake: matrices of the assembled one, derivatives equal to finite differences."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.linear import LinearModel, Matrices
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.spec import BrakeSpec

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
BRAKE = load_brake(BRAKES / "model.toml")
MODEL = LinearBrake(BRAKE)
POINT = {"mu": 0.47, "pressure": 12.5, "slope": 0.06}


def turned() -> LinearBrake:
    """The brake with turned abutment axes, and a product and a quotient among its expressions."""
    data = BRAKE.spec.model_dump()
    data["parameters"]["tilt"] = {"value": 0.3, "unit": "rad", "origin": "test"}
    data["parameters"]["ratio"] = {"value": 1.4, "unit": "1", "origin": "test"}
    couplings = {coupling["name"]: coupling for coupling in data["couplings"]}
    couplings["abutment_il"] |= {"angle": "tilt", "stiffness_y": "c_abu_y_il * ratio"}
    couplings["abutment_ot"] |= {"angle": "0.5 - tilt", "stiffness_x": "c_abu_t / ratio"}
    return LinearBrake(Brake(BrakeSpec.model_validate(data)))


def test_matrices_are_those_of_the_assembled_brake() -> None:
    assert isinstance(MODEL, LinearModel)
    m = MODEL.matrices(POINT)
    force = BRAKE.pad_force_n(12.5e5)
    np.testing.assert_array_equal(m.mass, BRAKE.mass_matrix)
    np.testing.assert_array_equal(m.stiffness, BRAKE.stiffness_matrix(0.47))
    np.testing.assert_allclose(m.damping, BRAKE.damping_matrix(0.47, 0.06, force), rtol=1e-14, atol=1e-9)
    np.testing.assert_allclose(
        m.state_matrix(), BRAKE.state_matrix(0.47, 0.06, 12.5e5), rtol=1e-14, atol=1e-9
    )


@given(st.lists(st.floats(0.8, 1.25), min_size=60, max_size=60))
@settings(max_examples=15, deadline=None)
def test_changed_parameters_are_those_of_a_changed_file(factors: list[float]) -> None:
    names = sorted(BRAKE.spec.parameters)
    values = {
        name: BRAKE.spec.parameters[name].value * factor for name, factor in zip(names, factors, strict=False)
    }
    changed = BRAKE.with_parameters(**values)
    m = MODEL.matrices(values | {"mu": 0.5})
    np.testing.assert_allclose(m.stiffness, changed.stiffness_matrix(0.5), rtol=1e-13, atol=1e-6)
    np.testing.assert_allclose(m.damping, changed.damping_matrix(0.5), rtol=1e-13, atol=1e-10)
    np.testing.assert_allclose(m.mass, changed.mass_matrix, rtol=1e-15)


@pytest.mark.parametrize("model", [MODEL, turned()], ids=["shipped", "turned"])
def test_derivatives_are_those_of_finite_differences(model: LinearBrake) -> None:
    for name, quantity in model.quantities.items():
        nominal = POINT.get(name, quantity.value)
        step = 1e-4 * abs(nominal) or 1e-5
        high, low = (model.matrices(POINT | {name: nominal + s * step}) for s in (1, -1))
        for part, derivative in named(model.derivative(name, POINT)):
            expected = (getattr(high, part) - getattr(low, part)) / (2.0 * step)
            scale = np.abs(getattr(model.matrices(POINT), part)).max() / max(abs(nominal), step)
            np.testing.assert_allclose(
                derivative, expected, rtol=1e-6, atol=3e-8 * scale, err_msg=f"{part}: {name}"
            )


def named(m: Matrices) -> list[tuple[str, np.ndarray]]:
    return [("mass", m.mass), ("damping", m.damping), ("stiffness", m.stiffness)]


def test_a_given_place_overrides_its_parameter() -> None:
    values = {"piston_l.stiffness_y": 1.1 * BRAKE.spec.parameters["c_pis_n"].value}
    changed = MODEL.matrices(values).stiffness - MODEL.matrices().stiffness
    assert np.linalg.matrix_rank(changed) == 1  # one element of two that share the parameter
    np.testing.assert_allclose(
        MODEL.derivative("c_pis_n", values).stiffness, MODEL.derivative("piston_t.stiffness_y").stiffness
    )


def test_every_group_of_the_shipped_brakes_changes_the_matrices() -> None:
    for path in sorted(BRAKES.glob("*.toml")):
        model = LinearBrake(load_brake(path))
        nominal = model.matrices({"mu": 0.4, "pressure": 10.0})
        assert len(model.groups) > 30
        for group in model.groups:
            changed = model.matrices(
                {name: 1.1 * model.quantities[name].value for name in group.members}
                | {"mu": 0.4, "pressure": 10.0}
            )
            difference = max(
                float(np.abs(new - old).max())
                for (_, new), (_, old) in zip(named(changed), named(nominal), strict=True)
            )
            assert difference > 0.0, f"{path.name}: {group.name}"
            assert {model.quantities[name].kind for name in group.members} == {group.kind}, group.name


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"mu": float("nan")}, "mu = nan: give a finite number"),
        ({"mu": -0.1}, "mu = -0.1: give a value that is not negative"),
        ({"m_disc": -1.0}, "disc.mass = -1 kg: must be positive"),
        ({"piston_l.damping_y": -1.0}, "piston_l.damping_y = -1 N s/m: must be not negative"),
    ],
)
def test_impossible_values_are_refused(values: dict[str, float], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        MODEL.matrices(values)


def test_unknown_quantities_name_near_ones() -> None:
    with pytest.raises(KeyError, match=r"did you mean .*c_pis_n"):
        MODEL.matrices({"c_pis": 1.0})
    with pytest.raises(KeyError, match="no quantity 'nothing_like_it'"):
        MODEL.derivative("nothing_like_it")

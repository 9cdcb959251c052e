"""Cubic and one-sided couplings: the file, the laws, their tangent, and who refuses them."""

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.friction import ConstantFriction, LinearFriction
from sim_hardware.brake_model.laws import (
    cubic_for_doubled_stiffness,
    nonlinear_couplings,
    one_sided_energy,
    release_strain,
    spring_energy,
    spring_force,
    spring_tangent,
    with_cubic_contacts,
)
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.spec import BrakeSpec
from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator
from sim_hardware.brake_model.time_domain.motion import WorkingCourse, integrate
from sim_hardware.brake_model.time_domain.reference import ReferenceModel, WorkingPoint

#: the first run compiles the integrator
pytestmark = pytest.mark.timeout(600)

FILE = Path(__file__).parents[3] / "configs" / "brakes" / "model.toml"
MODEL = load_brake(FILE)
POINT = WorkingPoint(3435.0, 0.44, ConstantFriction(mu_mean=0.4))


def data() -> dict[str, Any]:
    return tomllib.loads(FILE.read_text(encoding="utf-8"))


def entry(brake: dict[str, Any], table: str, name: str) -> dict[str, Any]:
    return next(item for item in brake[table] if item["name"] == name)


def nonlinear_data() -> dict[str, Any]:
    """Every nonlinear law once."""
    brake = data()
    brake["parameters"] |= {
        "c3_con": {"value": 3.6e16, "unit": "N/m3", "origin": "test"},
        "c3_abu": {"value": 1e17, "unit": "N/m3", "origin": "test"},
        "c3_hub": {"value": 1e13, "unit": "N m/rad3", "origin": "test"},
    }
    entry(brake, "couplings", "contact_il").update(cubic="c3_con", one_sided=True)
    entry(brake, "couplings", "abutment_it").update(cubic_x="c3_abu", cubic_y="2 * c3_abu")
    entry(brake, "torsions", "hub_torsion").update(cubic="c3_hub")
    return brake


NONLINEAR = Brake(BrakeSpec.model_validate(nonlinear_data()))


def test_laws_are_read_from_the_file() -> None:
    by_name = {element.name: element for element in NONLINEAR.elements}
    assert by_name["contact_il"].cubic_n_m3 == (0.0, 3.6e16)
    assert by_name["contact_il"].one_sided
    assert by_name["abutment_it"].cubic_n_m3 == (1e17, 2e17)
    assert NONLINEAR.torsions[0].cubic_nm_rad3 == 1e13
    assert nonlinear_couplings(NONLINEAR) == ("contact_il", "abutment_it", "hub_torsion")
    assert nonlinear_couplings(MODEL) == ()


def test_matrices_are_the_tangent_at_the_steadily_sliding_state() -> None:
    np.testing.assert_array_equal(NONLINEAR.stiffness_matrix(0.4), MODEL.stiffness_matrix(0.4))
    np.testing.assert_array_equal(NONLINEAR.damping_matrix(0.4), MODEL.damping_matrix(0.4))
    step, n = 1e-9, MODEL.n_dof
    columns = []
    for i in range(n):
        pair = [
            NONLINEAR.accelerations(
                sign * step * np.eye(n)[i], np.zeros(n), lambda c, v, force: 0.4 * force, pad_force_n=3435.0
            )
            for sign in (1.0, -1.0)
        ]
        columns.append(-NONLINEAR.inertia * (pair[0] - pair[1]) / (2.0 * step))
    stiffness = MODEL.stiffness_matrix(0.4)
    np.testing.assert_allclose(np.array(columns).T, stiffness, atol=1e-6 * np.abs(stiffness).max())


def test_parameters_of_nonlinear_laws_change_no_matrix() -> None:
    model = LinearBrake(NONLINEAR)
    assert model.quantities["c3_con"].unit == "N/m3"
    for name in ("c3_con", "contact_il.cubic", "hub_torsion.cubic"):
        change = model.derivative(name)
        assert not change.stiffness.any()
        assert not change.damping.any()
        assert not change.mass.any()


def test_forces_follow_the_laws() -> None:
    n = MODEL.n_dof
    displacement = np.zeros(n)
    displacement[MODEL.freedom_index("inner_pad.y")] = 30e-6
    displacement[MODEL.freedom_index("disc.phi")] = 1e-4
    names = [element.name for element in NONLINEAR.elements]
    forces, moments = NONLINEAR.coupling_forces(displacement, np.zeros(n), lambda *_: 0.0, pad_force_n=3435.0)
    linear, _ = MODEL.coupling_forces(displacement, np.zeros(n), lambda *_: 0.0)
    i = names.index("contact_il")
    strain = NONLINEAR.elements[i].row_y @ displacement
    assert forces[i, 1] - linear[i, 1] == pytest.approx(3.6e16 * strain**3, rel=1e-12)
    assert moments[0] == pytest.approx(1.38e6 * 1e-4 + 1e13 * 1e-12, rel=1e-12)
    # away from the disc: the one-sided contact is left with nothing of its share of the pad force
    forces, _ = NONLINEAR.coupling_forces(-displacement, np.zeros(n), lambda *_: 0.0, pad_force_n=100.0)
    assert forces[i, 1] == -50.0
    with pytest.raises(ValueError, match=r"'contact_il' is one-sided: give pad_force_n"):
        NONLINEAR.coupling_forces(displacement, np.zeros(n), lambda *_: 0.0)


@given(st.floats(1e3, 1e9), st.floats(0.0, 1e18), st.floats(-1e-3, 1e-3), st.floats(0.0, 1e4))
def test_energies_are_integrals_of_forces(stiffness: float, cubic: float, strain: float, mean: float) -> None:
    u = np.linspace(0.0, strain, 4001)
    force = spring_force(stiffness, cubic, u)
    scale = abs(float(force[-1] * strain)) + mean * abs(strain) + 1e-30
    assert spring_energy(stiffness, cubic, strain) == pytest.approx(np.trapezoid(force, u), abs=1e-5 * scale)
    whole = np.maximum(force, -mean)
    assert float(one_sided_energy(stiffness, cubic, mean, strain)) == pytest.approx(
        np.trapezoid(whole, u), abs=1e-3 * scale
    )
    free = release_strain(stiffness, cubic, mean)
    assert float(spring_force(stiffness, cubic, free)) == pytest.approx(-mean, rel=1e-9, abs=1e-12)
    assert float(spring_tangent(stiffness, cubic, strain)) >= stiffness


def test_strength_of_hardening_doubles_the_stiffness() -> None:
    assert cubic_for_doubled_stiffness(2.69e8, 50e-6) == pytest.approx(3.587e16, rel=1e-3)
    hard = with_cubic_contacts(MODEL, doubled_at_m=50e-6, strength=10.0)
    for contact in hard.contacts:
        tangent = spring_tangent(contact.stiffness_n_m[1], contact.cubic_n_m3[1], 50e-6)
        assert float(tangent) == pytest.approx(11.0 * contact.stiffness_n_m[1], rel=1e-12)
    assert nonlinear_couplings(with_cubic_contacts(hard, strength=0.0)) == ()
    # cubic values of the file make way, and no parameter is left unused
    assert with_cubic_contacts(NONLINEAR).contacts[0].cubic_n_m3[1] == pytest.approx(3.587e16, rel=1e-3)
    for strength, at in ((-1.0, 5e-5), (float("nan"), 5e-5), (1.0, 0.0)):
        with pytest.raises(ValueError, match="give"):
            with_cubic_contacts(MODEL, doubled_at_m=at, strength=strength)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda b: entry(b, "couplings", "tie").update(cubic_y="c3_con"), ["cubic_y", "without stiffness_y"]),
        (
            lambda b: entry(b, "couplings", "contact_it").update(cubic="c_tie"),
            ["contact_it", "N/m where N/m3"],
        ),
        (lambda b: b["parameters"]["c3_con"].update(value=-1.0), ["contact_il", "not negative"]),
        (lambda b: b["parameters"]["c3_hub"].update(unit="N/m3"), ["hub_torsion", "N m/rad"]),
        (lambda b: entry(b, "couplings", "contact_it").update(cubic_x="c3_con"), ["cubic_x", "Extra inputs"]),
        (lambda b: entry(b, "couplings", "tie").update(one_sided=True), ["one_sided", "Extra inputs"]),
        (lambda b: entry(b, "couplings", "contact_it").update(one_sided="perhaps"), ["one_sided", "boolean"]),
        (lambda b: entry(b, "couplings", "contact_it").update(cubic="c3_con / 0"), ["divides by zero"]),
    ],
)
def test_wrong_laws_are_refused_with_place_and_remedy(change: Any, words: list[str]) -> None:
    brake = nonlinear_data()
    change(brake)
    with pytest.raises(ValidationError) as caught:
        BrakeSpec.model_validate(brake)
    error = caught.value.errors()[0]
    text = " ".join(map(str, (error["loc"], error["msg"], error.get("ctx"))))
    assert all(word in text for word in words), text


def test_linear_integrators_refuse_nonlinear_brakes() -> None:
    """Never silently linear: the message names couplings and the way out."""
    with pytest.raises(ValueError, match=r"contact_il, abutment_it, hub_torsion.*motion\.integrate"):
        SquealIntegrator(NONLINEAR)
    with pytest.raises(ValueError, match=r"reference integrator .*contact_il"):
        ReferenceModel(NONLINEAR, POINT)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"state": np.zeros(3)}, "28 finite"),
        ({"state": np.full(28, np.nan)}, "28 finite"),
        ({"times_s": [0.0]}, "at least two"),
        ({"times_s": [0.0, 1.0, 0.5]}, "increasing"),
        ({"rtol": 0.0}, "rtol"),
        ({"atol_m": -1.0}, "atol_m"),
        ({"longest_step_s": 0.0}, "longest_step_s"),
        ({"always_sliding": True}, "'contact_il' is one_sided"),
    ],
)
def test_nonsense_to_integrate_is_refused(keys: dict[str, Any], message: str) -> None:
    arguments: dict[str, Any] = {"state": np.zeros(28), "times_s": [0.0, 1e-4]} | keys
    with pytest.raises(ValueError, match=message):
        integrate(NONLINEAR, POINT, arguments.pop("state"), arguments.pop("times_s"), **arguments)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"pad_force_n": [-1.0, 1.0]}, "pad_force_n is negative"),
        ({"slip_m_s": [0.1, np.inf]}, "slip_m_s is negative or not finite"),
        ({"mu_mean": [0.4]}, "unequal shapes"),
        ({"times_s": [0.0, 0.0]}, "must increase"),
        ({"saturation_m_s": 0.0}, "saturation_m_s is 0"),
        ({"static_mu": -0.1}, "static_mu"),
    ],
)
def test_nonsense_courses_are_refused(change: dict[str, Any], message: str) -> None:
    good = {key: np.array([0.1, 0.2]) for key in ("times_s", "pad_force_n", "slip_m_s", "mu_mean", "k_s_m")}
    with pytest.raises(ValueError, match=message):
        WorkingCourse(**(good | change))


def test_limits_of_integration_are_reported() -> None:
    state = np.zeros(28)
    state[20] = 1e-3
    with pytest.raises(ArithmeticError, match=r"took 5 steps: shorten it"):
        integrate(NONLINEAR, POINT, state, [0.0, 0.1], most_steps=5)
    steep = WorkingPoint(3000.0, 0.1, LinearFriction(mu_mean=0.4, k_s_m=5.0))
    with pytest.raises(ArithmeticError, match=r"left its range, mu = -.* a law that saturates"):
        integrate(NONLINEAR, steep, 1e3 * state, [0.0, 0.1])
    with pytest.raises(ArithmeticError, match=r"'model' at 0 s is not finite"):
        integrate(NONLINEAR, POINT, np.full(28, 1e200), [0.0, 0.1])

"""Eq 24 against central differences, against the state matrix, against sum rules; and where it has no
meaning.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.design.sensitivity import (
    derivatives,
    eigen_sensitivities,
    parameter_names,
    sensitivities,
)
from sim_hardware.brake_model.eigen.eigen_systems import eigen_system, mode_order
from sim_hardware.brake_model.linear import Matrices, NamedQuantity, ParameterGroup, value_of
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.spec import BrakeSpec

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
MODEL = load_brake(BRAKES / "model.toml")
SCATTERED = tuple(MODEL.spec.parameters)


@dataclass(frozen=True)
class Pencil:
    """A small model: M, D, K as polynomials of one quantity `p`, coefficients in rising order."""

    mass: tuple[np.ndarray, ...]
    damping: tuple[np.ndarray, ...]
    stiffness: tuple[np.ndarray, ...]
    p: float
    name: str = "pencil"
    groups: tuple[ParameterGroup, ...] = ()

    @property
    def freedoms(self) -> tuple[str, ...]:
        return tuple(f"q{i}" for i in range(len(self.mass[0])))

    @property
    def quantities(self) -> Mapping[str, NamedQuantity]:
        return MappingProxyType({"p": NamedQuantity("p", self.p, "1", "other")})

    def matrices(self, values: Mapping[str, float] | None = None) -> Matrices:
        p = value_of(self, "p", values)
        return Matrices(
            *(sum(c * p**i for i, c in enumerate(m)) for m in (self.mass, self.damping, self.stiffness))
        )

    def derivative(self, name: str, values: Mapping[str, float] | None = None) -> Matrices:
        p = value_of(self, name, values)
        return Matrices(
            *(
                sum((i * c * p ** (i - 1) for i, c in enumerate(m) if i), np.zeros_like(m[0]))
                for m in (self.mass, self.damping, self.stiffness)
            )
        )


ONE, NONE = np.eye(2), np.zeros((2, 2))
#: eigenvalues of K: 1.5 +- sqrt(0.25 - p^2); they meet at p = 0.5 with one common vector
FLUTTER = Pencil((ONE,), (NONE,), (np.diag([1.0, 2.0]), np.array([[0.0, 1.0], [-1.0, 0.0]])), 0.4)


def central_difference(model, name: str, values: dict[str, float], share: float = 2e-5) -> np.ndarray:
    """d lambda for 1 % more of a quantity, modes in the order of `eigen_system`."""
    amount = value_of(model, name, values)
    ends = [
        np.linalg.eigvals(model.matrices({**values, name: amount * (1 + sign * share)}).state_matrix())
        for sign in (1, -1)
    ]
    nominal = eigen_system(model.matrices(values)).values
    plus, minus = (end[np.abs(nominal[:, None] - end[None, :]).argmin(axis=1)] for end in ends)
    return 0.01 * (plus - minus) / (2.0 * share)


@pytest.mark.parametrize("file", ["basic.toml", "model.toml", "plant.toml"])
def test_eq_24_agrees_with_central_differences_for_every_quantity(file: str) -> None:
    model = LinearBrake(load_brake(BRAKES / file))
    point = {"pressure": 8.0, "mu": 0.35}
    found = eigen_sensitivities(model, parameter_names(model, places=True), point)
    assert len(found.names) > 190 and found.system.regular.all()
    for name, ours in zip(found.names, found.per_percent, strict=True):
        peer = central_difference(model, name, point)
        assert np.abs(ours - peer).max() <= 2e-4 + 1e-5 * np.abs(peer).max(), name


@settings(max_examples=12, deadline=None)
@given(
    st.lists(st.floats(0.85, 1.15), min_size=len(SCATTERED), max_size=len(SCATTERED)),
    st.floats(0.0, 0.7), st.floats(0.0, 20.0), st.integers(0, 10**6),
)  # fmt: skip
def test_eq_24_agrees_with_central_differences_on_scattered_brakes(factors, mu, pressure, seed) -> None:
    changes = {
        name: f * MODEL.spec.parameters[name].value for name, f in zip(SCATTERED, factors, strict=True)
    }
    model = LinearBrake(MODEL.with_parameters(**changes))
    point = {"mu": mu, "pressure": pressure}
    names = np.random.default_rng(seed).choice(parameter_names(model, places=True), 6, replace=False)
    found = eigen_sensitivities(model, [*map(str, names)], point)
    clear = found.system.regular & (found.system.gap > 20.0)
    for name, ours in zip(found.names, found.per_percent, strict=True):
        peer = central_difference(model, name, point)
        assert np.abs(ours - peer)[clear].max() <= 1e-3 + 1e-4 * np.abs(peer).max(), name


@pytest.mark.parametrize("file", ["basic.toml", "plant.toml", "turned"])
def test_rank_one_form_equals_the_matrices_form_for_every_quantity(file: str) -> None:
    brake = MODEL if file == "turned" else load_brake(BRAKES / file)
    if file == "turned":
        data = brake.spec.model_dump()
        data["parameters"]["tilt"] = {"value": 0.2, "unit": "rad", "origin": "test"}
        data["parameters"]["lever"] = {"value": 2.0, "unit": "1", "origin": "test"}
        for coupling in data["couplings"]:
            if coupling["name"] in {"piston_l", "abutment_ot"}:
                coupling["angle"] = "tilt"
        data["bodies"][0]["mass"] = "m_cal * lever / 2"
        brake = Brake(BrakeSpec.model_validate(data))
    model = LinearBrake(brake)
    for point in (
        {},
        {"pressure": 9.0, "mu": 0.7, "slope": 0.03, "x_pis": 0.02, "inner_pad.piston_l.x": -0.01},
    ):
        system = eigen_system(model.matrices(point))
        names = parameter_names(model, places=True)
        ours = eigen_sensitivities(model, names, point).absolute
        matrices = sensitivities(system, derivatives(model, names, point)).absolute
        scale = np.abs(matrices).max(axis=1, keepdims=True)
        assert (np.abs(ours - matrices) <= 1e-9 * scale).all()


def test_pencil_form_equals_the_state_matrix_form_of_the_paper() -> None:
    model = LinearBrake(MODEL)
    system = eigen_system(model.matrices())
    matrix = model.matrices().state_matrix()
    values, vectors = np.linalg.eig(matrix)
    order = mode_order(values)
    right, left = vectors[:, order], np.linalg.inv(vectors[:, order])  # w^T v = 1 (eq 21)
    for name in ("c_con_il", "mu", "inner_pad.piston_l.x", "m_padi", "d_con"):
        matrices, change = model.matrices(), model.derivative(name)
        inverse = np.linalg.inv(matrices.mass)
        n = matrices.n_dof
        d_a = np.zeros((2 * n, 2 * n))
        d_a[n:, :n] = inverse @ (change.mass @ inverse @ matrices.stiffness - change.stiffness)
        d_a[n:, n:] = inverse @ (change.mass @ inverse @ matrices.damping - change.damping)
        paper = np.einsum("ia,ab,bi->i", left, d_a, right)  # eq 24 as printed
        ours = sensitivities(system, derivatives(model, [name])).absolute[0]
        assert np.abs(ours - paper).max() <= 1e-8 * np.abs(paper).max()


def test_sum_over_all_eigenvalues_is_the_change_of_the_trace() -> None:
    model = LinearBrake(MODEL)
    found = eigen_sensitivities(model, values={"pressure": 5.0})
    total = found.per_percent.sum(axis=1)
    kinds = {name: model.quantities[name].kind for name in found.names}
    size = np.abs(found.per_percent).sum(axis=1)
    for name, value, scale in zip(found.names, total, size, strict=True):
        if kinds[name] == "stiffness":
            assert abs(value) <= 1e-9 * scale, name  # stiffness only moves damping from mode to mode
        if kinds[name] == "damping":
            assert value.real < 0.0, name


def test_undamped_symmetric_model_is_perfectly_conditioned() -> None:
    system = eigen_system(Matrices(np.diag([2.0, 5.0]), NONE, np.array([[3.0, -1.0], [-1.0, 4.0]])))
    np.testing.assert_allclose(system.condition, 1.0, rtol=1e-12)


@pytest.mark.parametrize("p", [0.5, 0.5 - 1e-15, 0.5 + 1e-14])
def test_defective_pair_gets_a_reason_and_no_number(p: float) -> None:
    found = eigen_sensitivities(FLUTTER, ["p"], {"p": p})
    assert np.isnan(found.absolute).all() and np.isnan(found.reach_percent).all()
    assert all("coincides" in r or "near-defective" in r for r in found.system.reasons)


@pytest.mark.parametrize("distance", [1e-3, 1e-6, -1e-6])
def test_beside_a_defective_pair_the_number_is_right_and_its_reach_is_short(distance: float) -> None:
    p = 0.5 - distance
    found = eigen_sensitivities(FLUTTER, ["p"], {"p": p})
    root = np.sqrt(0.25 - p**2 + 0j)
    exact = {}
    for sign in (1, -1):
        for side in (1j, -1j):
            value = side * np.sqrt(1.5 + sign * root)
            exact[value] = side * 0.5 / np.sqrt(1.5 + sign * root) * sign * (-p / root)
    for value, ours in zip(found.system.values, found.absolute[0], strict=True):
        nearest = min(exact, key=lambda e: abs(e - value))
        assert ours == pytest.approx(exact[nearest], rel=1e-4)
    assert found.system.condition.min() > 0.1 / np.sqrt(abs(distance))
    assert found.reach_percent.max() < 100.0 * abs(distance) * 3.0


def test_coinciding_eigenvalues_of_two_equal_oscillators_get_no_number() -> None:
    model = Pencil((ONE,), (0.1 * ONE,), (ONE, np.array([[0.0, 1.0], [1.0, 0.0]])), 0.0)
    found = eigen_sensitivities(model, ["p"])
    assert np.isnan(found.absolute).all()
    assert all(reason.startswith("coincides with eigenvalue") for reason in found.system.reasons)


def test_free_body_without_damping_gets_a_reason_and_the_others_numbers() -> None:
    model = Pencil((np.diag([1.0, 4.0]),), (NONE,), (NONE, np.array([[1.0, -1.0], [-1.0, 1.0]])), 1e6)
    found = eigen_sensitivities(model, ["p"])
    assert [bool(r) for r in found.system.reasons] == [True, True, False, False]
    assert found.per_percent[0, 2] == pytest.approx(0.005 * found.system.values[2], rel=1e-9)


def test_divergence_real_eigenvalues_have_frequency_zero_and_right_derivatives() -> None:
    model = Pencil((ONE,), (0.2 * ONE,), (np.diag([1.0, 4.0]), np.diag([-1.0, 0.0])), 3.0)
    found = eigen_sensitivities(model, ["p"])
    assert list(found.system.frequencies_hz[:2]) == [0.0, 0.0]
    assert found.system.values[1].real > 0.0
    # l^2 + 0.2 l + 1 - p = 0: dl/dp = 1 / (2 l + 0.2)
    np.testing.assert_allclose(found.absolute[0, :2], 1.0 / (2.0 * found.system.values[:2] + 0.2), rtol=1e-10)


def test_singular_mass_is_refused() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        eigen_system(Matrices(np.array([[1.0, 1.0], [1.0, 1.0]]), NONE, ONE))


def test_unknown_quantity_names_its_neighbours() -> None:
    with pytest.raises(KeyError, match="c_con_il"):
        eigen_sensitivities(LinearBrake(MODEL), ["c_con_li"])

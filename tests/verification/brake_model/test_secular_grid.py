"""All eigenvalues on grids by the secular equation against LAPACK, at every point."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.eigen.secular import grid_eigenvalues, prediction_weights
from sim_hardware.brake_model.eigen.secular_equation import sorted_eigenvalues
from sim_hardware.brake_model.linear import Matrices
from sim_hardware.brake_model.parametric import LinearBrake

BRAKES = {name: load_brake(Path(__file__).parents[3] / f"configs/brakes/{name}.toml") for name in
          ("basic", "model", "plant")}  # fmt: skip


def lapack(at, xs, ys):
    matrices = np.array([[at(float(x), float(y)).state_matrix() for x in xs] for y in ys])
    return sorted_eigenvalues(np.linalg.eigvals(matrices))


def mu_pressure(model: LinearBrake, slope: float = 0.0576):
    return lambda x, y: model.matrices({"mu": x, "pressure": y, "slope": slope})


def assert_equal(found, wanted, tolerance: float = 1e-9) -> None:
    assert found.shape == wanted.shape
    np.testing.assert_array_less(np.abs(found - wanted), tolerance * np.abs(wanted) + 1e-300)


@pytest.mark.parametrize("name", BRAKES)
def test_friction_and_pressure_over_the_working_range(name: str) -> None:
    at = mu_pressure(LinearBrake(BRAKES[name]))
    xs, ys = np.linspace(0.0, 1.0, 61), np.linspace(0.0, 30.0, 37)
    result = grid_eigenvalues(at, xs, ys)
    assert result.method == "secular"
    assert result.fallback_share <= 0.002
    assert_equal(result.values, lapack(at, xs, ys), 1e-11)


@settings(max_examples=12, deadline=None)
@given(
    name=st.sampled_from(sorted(BRAKES)),
    seed=st.integers(0, 2**32 - 1),
    top=st.floats(0.1, 30.0),
    slope=st.floats(0.0, 0.2),
)
def test_scattered_brakes_equal_lapack_everywhere(name: str, seed: int, top: float, slope: float) -> None:
    brake = BRAKES[name]
    factors = np.random.default_rng(seed).uniform(0.8, 1.25, len(brake.spec.parameters))
    changed = {n: p.value * f for (n, p), f in zip(brake.spec.parameters.items(), factors, strict=True)}
    at = mu_pressure(LinearBrake(brake.with_parameters(**changed)), slope)
    xs, ys = np.linspace(0.0, top, 23), np.linspace(0.0, 30.0, 9)
    result = grid_eigenvalues(at, xs, ys, method="secular")
    wanted = lapack(at, xs, ys)
    # where eigenvalues coincide LAPACK itself has no more than about half of the digits
    gap = np.abs(wanted[..., :, None] - wanted[..., None, :])
    gap[..., np.arange(28), np.arange(28)] = np.inf
    radius = np.abs(wanted).max()
    allowed = np.maximum(1e-9 * np.abs(wanted), 1e-12 * radius**2 / gap.min(axis=-1))
    assert np.all(np.abs(result.values - wanted) <= allowed)


def test_divergence_is_found_and_never_wrong() -> None:
    """Real eigenvalues at large mu: the structure of the spectrum changes within the grid."""
    changed = {
        n: p.value * (1.2 if i % 2 else 0.85)
        for i, (n, p) in enumerate(BRAKES["basic"].spec.parameters.items())
    }
    at = mu_pressure(LinearBrake(BRAKES["basic"].with_parameters(**changed)))
    xs, ys = np.linspace(0.0, 60.0, 121), np.linspace(0.0, 30.0, 7)
    result = grid_eigenvalues(at, xs, ys, method="secular")
    wanted = lapack(at, xs, ys)
    real = (wanted.imag == 0.0).any(axis=-1)
    assert 0.02 < real.mean() < 0.98
    assert_equal(result.values, wanted, 1e-8)
    np.testing.assert_array_equal((result.values.imag == 0.0).sum(axis=-1), (wanted.imag == 0.0).sum(axis=-1))


def test_any_two_quantities_also_geometry_and_inertia() -> None:
    model = LinearBrake(BRAKES["basic"])
    base = model.quantities
    for x, y in (("c_con_il", "mu"), ("m_padi", "d_con"), ("x_con", "c_pis_n"), ("slope", "pressure")):
        spans = [
            np.linspace(0.7 * base[n].value, 1.3 * base[n].value, 25)
            if base[n].value
            else np.linspace(0.0, 0.2, 25)
            for n in (x, y)
        ]

        def at(a: float, b: float, x: str = x, y: str = y) -> Matrices:
            return model.matrices({x: a, y: b})

        result = grid_eigenvalues(at, *spans)
        assert result.method == "secular", (x, y, result.reason)
        assert_equal(result.values, lapack(at, *spans))


@pytest.mark.parametrize(("nx", "ny"), [(1, 1), (2, 1), (1, 3), (3, 2)])
@pytest.mark.parametrize("method", ["secular", "lapack", None])
def test_small_grids(nx: int, ny: int, method) -> None:
    at = mu_pressure(LinearBrake(BRAKES["plant"]))
    xs, ys = np.linspace(0.2, 0.6, nx), np.linspace(3.0, 9.0, ny)
    result = grid_eigenvalues(at, xs, ys, method=method)
    assert result.method == (method or "lapack")
    assert_equal(result.values, lapack(at, xs, ys))


def test_constant_and_repeated_values_and_threads() -> None:
    at = mu_pressure(LinearBrake(BRAKES["model"]))
    xs, ys = np.full(30, 0.4), np.linspace(30.0, 0.0, 20)
    result = grid_eigenvalues(at, xs, ys, method="secular")
    assert_equal(result.values, lapack(at, xs, ys))
    xs = np.sort(np.random.default_rng(3).uniform(0.0, 1.0, 40))[::-1]
    one, two = (grid_eigenvalues(at, xs, ys, workers=n).values for n in (1, 2))
    np.testing.assert_array_equal(one, two)
    assert_equal(one, lapack(at, xs, ys))


def test_a_quantity_without_influence() -> None:
    at = mu_pressure(LinearBrake(BRAKES["basic"]), slope=0.0)
    xs, ys = np.linspace(0.0, 1.0, 40), np.linspace(0.0, 30.0, 12)
    result = grid_eigenvalues(at, xs, ys)
    assert result.method == "secular"
    assert_equal(result.values, lapack(at, xs, ys))
    assert_equal(result.values, np.broadcast_to(result.values[:1], result.values.shape), 1e-11)


def chain(n: int, damping: float, friction: bool = True, ground: float = 1.0):
    """A chain of n masses; x scales a nonconservative force, y a damper."""
    k = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    k[0, 0] = 1.0 + ground
    k[-1, -1] = 1.0
    push = np.zeros((n, n))
    push[0, 1] = float(friction)
    one = np.zeros((n, n))
    one[-1, -1] = 1.0
    return lambda x, y: Matrices(np.eye(n), damping * k + y * one, 1e6 * (k - x * push))


@pytest.mark.parametrize("damping", [0.0, 1e-3])
def test_undamped_systems(damping: float) -> None:
    xs, ys = np.linspace(-0.5, 0.5, 31), np.zeros(9)
    at = chain(4, damping)
    result = grid_eigenvalues(at, xs, ys)
    wanted = lapack(at, xs, ys)
    np.testing.assert_allclose(result.values.imag, wanted.imag, rtol=1e-9)
    assert np.abs(result.values.real - wanted.real).max() < 1e-9 * np.abs(wanted).max()


def test_rigid_body_motion_is_left_to_lapack() -> None:
    """An eigenvalue 0 at every point, double and defective where no damper holds the chain (y = 0)."""
    at = chain(5, 1e-3, friction=False, ground=0.0)
    xs, ys = np.linspace(0.0, 1.0, 20), np.linspace(0.0, 5.0, 20)
    result = grid_eigenvalues(at, xs, ys)
    assert result.method == "lapack"
    assert result.reason
    assert_equal(result.values[..., 2:], lapack(at, xs, ys)[..., 2:])
    assert np.all(result.values[0, :, :2] == 0.0)
    assert np.all(result.values[1:].real.max(axis=-1) < 1e-6)


def test_two_equal_systems_have_coinciding_eigenvalues() -> None:
    def at(x: float, y: float) -> Matrices:
        one = chain(3, 1e-3)(x, y)
        return Matrices(*(np.kron(np.eye(2), part) for part in (one.mass, one.damping, one.stiffness)))

    xs, ys = np.linspace(0.0, 0.5, 12), np.linspace(0.0, 5.0, 12)
    result = grid_eigenvalues(at, xs, ys)
    wanted = lapack(at, xs, ys)
    # of equal pairs, rounding says which conjugate comes first
    found, expected = (np.take_along_axis(v, v.imag.argsort(axis=-1), -1) for v in (result.values, wanted))
    assert np.abs(found - expected).max() < 1e-7 * np.abs(wanted).max()
    single = lapack(chain(3, 1e-3), xs, ys)
    np.testing.assert_allclose(
        result.values.real.max(axis=-1), single.real.max(axis=-1), atol=1e-6 * np.abs(wanted).max()
    )


def test_one_degree_of_freedom() -> None:
    def at(x: float, y: float) -> Matrices:
        return Matrices(np.eye(1), np.array([[x]]), np.array([[y]]))

    xs, ys = np.linspace(0.0, 5.0, 21), np.linspace(1.0, 9.0, 21)
    result = grid_eigenvalues(at, xs, ys, method="secular")
    rest = np.sqrt(xs[None, :] ** 2 / 4.0 - ys[:, None] + 0j)
    wanted = sorted_eigenvalues(np.stack([-xs / 2.0 + rest, -xs / 2.0 - rest], axis=-1))
    assert np.abs(result.values - wanted).max() < 1e-6


def test_predictions_are_exact_for_polynomials() -> None:
    points = np.sort(np.random.default_rng(1).uniform(-1.0, 1.0, 12))
    values = 3.0 * points**5 - points**2 + 0.5
    weights = prediction_weights(points)
    for i in range(6, 12):
        assert weights[i, 5] @ values[i - 1 - np.arange(6)] == pytest.approx(values[i], rel=1e-6)


def test_singular_mass_matrix_is_refused() -> None:
    with pytest.raises(np.linalg.LinAlgError):
        grid_eigenvalues(
            lambda x, y: Matrices(np.zeros((2, 2)), np.eye(2), x * np.eye(2)),
            np.array([1.0, 2.0]),
            np.array([1.0]),
        )


def test_a_dependence_that_interpolation_points_do_not_see() -> None:
    """Even in x and of degree 4: at the four points tried first its highest term is zero."""
    stiffness = np.diag([1.0, 1.7, 2.9, 4.1])
    across = np.zeros((4, 4))
    across[:2, 2:] = [[0.9, -0.4], [0.3, 0.8]]
    across[2:, :2] = [[-0.7, 0.2], [0.5, -0.6]]

    def at(x: float, y: float) -> Matrices:
        return Matrices(np.eye(4), (0.05 + y) * np.eye(4), stiffness + x * across)

    xs, ys = np.linspace(-1.0, 1.0, 41), np.linspace(0.0, 0.1, 9)
    result = grid_eigenvalues(at, xs, ys, method="secular")
    assert result.method == "secular"
    assert result.equation is not None
    assert result.equation.numerators.shape[2] == 5
    assert_equal(result.values, lapack(at, xs, ys), 1e-8)


def test_a_model_too_large_for_the_secular_equation_goes_to_lapack() -> None:
    at = chain(151, 1e-3)
    xs, ys = np.linspace(0.0, 0.2, 3), np.linspace(0.0, 1.0, 3)
    result = grid_eigenvalues(at, xs, ys)
    assert (result.method, result.fallback_share) == ("lapack", 0.0)
    assert "eigenvalues" in result.reason
    assert result.values.shape == (3, 3, 302)

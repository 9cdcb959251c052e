"""Extremes of the linear analysis: right result or a clear error, never a lie.

mu = 0, no damping, no pressure, real eigenvalues (divergence), coinciding eigenvalues, a body without
coupling, absurd input; for `stability` and for `band.eigen_pairs_of` over brakes and matrices made elsewhere.
"""

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from pydantic import ValidationError
from scipy import sparse
from small_brakes import CONTACT, brake_text

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.eigen import band as band_module
from sim_hardware.brake_model.eigen.band import eigen_pairs_of, eigen_pairs_of_matrices
from sim_hardware.brake_model.foreign.matrix_model import MatrixModel
from sim_hardware.brake_model.linear import Matrices
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.spec import BrakeSpec
from sim_hardware.brake_model.stability import eigen_pairs, onset_mu, onset_pressure, predict

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
NUMBERS = {"m_pad": 0.4, "c_n": 2e8, "d_n": 300.0, "c_x": 1e7, "c_y": 1e7, "d_x": 40.0, "d_y": 25.0}
BODIES = {"pad": "xy", "disc": "", "frame": ""}
POINTS = {"pad.face": ("0", "0"), "disc.face": ("0", "0"), "pad.back": ("0", "0"), "frame.back": ("0", "0")}
BACK = ("spring", "pad.back", "frame.back",
        {"stiffness_x": "c_x", "stiffness_y": "c_y", "damping_x": "d_x", "damping_y": "d_y"})  # fmt: skip


def brake_of(text: str) -> Brake:
    return Brake(BrakeSpec.model_validate(tomllib.loads(text)))


def undamped(name: str) -> Brake:
    brake = load_brake(BRAKES / f"{name}.toml")
    return brake.with_parameters(**{k: 0.0 for k in brake.spec.parameters if k.startswith("d_")})


# -- mu = 0, no damping, no pressure -------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["basic", "model", "plant"])
def test_without_friction_nothing_grows(name: str) -> None:
    brake = load_brake(BRAKES / f"{name}.toml")
    pairs = eigen_pairs(brake, mu=0.0, slope_s_m=0.0)
    assert len(pairs) == 14
    assert all(p.real_part_1_s < 0.0 and p.damping_ratio > 0.0 for p in pairs)
    found = eigen_pairs_of(LinearBrake(brake), {"mu": 0.0, "slope": 0.0})
    assert not found.unstable.any()
    assert found.alignments.min() > 0.9  # symmetric matrices
    # at no pressure the slope does nothing, at no slope the pressure
    assert (
        eigen_pairs(brake, 0.4, 0.2, 0.0)
        == eigen_pairs(brake, 0.4, 0.0, 0.0)
        == eigen_pairs(brake, 0.4, 0.0, 30.0)
    )


@pytest.mark.parametrize("name", ["basic", "model", "plant"])
def test_without_damping_pairs_stay_on_the_axis(name: str) -> None:
    """Not +1e-12 1/s and "unstable", as LAPACK's numbers say."""
    brake = undamped(name)
    for mu in (0.0, 0.5):
        pairs = eigen_pairs(brake, mu, 0.0)
        assert all(p.real_part_1_s == 0.0 == p.damping_ratio and not p.unstable for p in pairs)
        assert not eigen_pairs_of(LinearBrake(brake), {"mu": mu, "slope": 0.0}).unstable.any()
    assert onset_mu(brake, 0.0, mu_max=0.5) is None
    assert predict(brake, 0.3, 0.0).stable


def test_undamped_mode_coupling_where_two_frequencies_meet() -> None:
    """The onset is the defective point: below it two pairs on the axis, which have met there."""
    brake = undamped("basic")
    onset = onset_mu(brake, 0.0)
    assert onset is not None
    below, above = (eigen_pairs(brake, onset.value + step, 0.0) for step in (-1e-6, 1e-6))
    near = [p for p in below if abs(p.frequency_hz - onset.frequency_hz) < 5.0]
    assert len(near) == 2 and all(p.real_part_1_s == 0.0 for p in near)
    assert near[0].frequency_hz < onset.frequency_hz < near[1].frequency_hz
    assert [p.unstable for p in above].count(True) == 1
    met = eigen_pairs_of(LinearBrake(brake), {"mu": onset.value, "slope": 0.0})
    least = np.argsort(met.alignments)
    assert met.alignments[least[1]] < 1e-3
    assert met.alignments[least[2]] > 0.3
    assert met.frequencies_hz[least[:2]] == pytest.approx([onset.frequency_hz] * 2, rel=1e-5)


def test_falling_friction_without_damping_squeals_at_any_pressure() -> None:
    onset = onset_pressure(undamped("model"), 0.0, 0.0576)
    assert onset is not None
    assert 0.0 <= onset.value < 1e-6


# -- real eigenvalues ----------------------------------------------------------------------------------------


def test_divergence_is_growth_without_frequency() -> None:
    """A pad held by a spring that is turned against the sliding: det K(mu) falls to zero."""
    turned = {**BACK[3], "stiffness_x": "200 * c_x", "angle": "a_back"}
    text = brake_text({**NUMBERS, "a_back": -0.6}, BODIES, POINTS, [CONTACT, (*BACK[:3], turned)])
    brake = brake_of(text)
    k0, k1 = brake.stiffness_matrix(0.0), brake.stiffness_matrix(1.0) - brake.stiffness_matrix(0.0)
    exact = np.linalg.det(k0) / (k1[0, 1] * k0[1, 0])  # det(K0 + mu K1) is linear in mu
    assert exact > 0.0
    onset = onset_mu(brake, 0.0, mu_max=2.0 * exact)
    assert onset is not None
    assert onset.value == pytest.approx(exact, rel=1e-6)
    assert onset.frequency_hz == 0.0
    beyond = eigen_pairs(brake, 1.05 * exact, 0.0)
    growing = [p for p in beyond if p.unstable]
    assert len(growing) == 1 and growing[0].frequency_hz == 0.0 and growing[0].damping_ratio == -1.0
    found = eigen_pairs_of(LinearBrake(brake), {"mu": 1.05 * exact, "slope": 0.0})
    assert found.frequencies_hz[found.unstable].tolist() == [0.0]
    assert found.eigenvalues.real[found.unstable] == pytest.approx([growing[0].real_part_1_s], rel=1e-9)


def test_overdamped_pairs_are_two_real_eigenvalues() -> None:
    """m = 1, c = 1, d = 2.5: -0.5 and -2; d = 2: the double one, defective."""
    model = MatrixModel("o", {"M": np.eye(1), "D": np.array([[2.5]]), "K": np.eye(1)})
    np.testing.assert_allclose(eigen_pairs_of(model).eigenvalues, [-2.0, -0.5])
    critical = eigen_pairs_of(MatrixModel("o", {"M": np.eye(1), "D": np.array([[2.0]]), "K": np.eye(1)}))
    np.testing.assert_allclose(critical.eigenvalues, -1.0, atol=1e-7)
    assert critical.alignments.max() < 1e-6
    assert not critical.unstable.any()


# -- coinciding eigenvalues ----------------------------------------------------------------------------------


def test_two_equal_bodies_have_each_pair_twice() -> None:
    numbers = {**NUMBERS, "m_one": 1.3, "m_two": 1.3}
    bodies = {**BODIES, "one": "x", "two": "x"}
    points = {**POINTS, "one.a": ("0", "0"), "two.a": ("0", "0"), "frame.a": ("0", "0")}
    alike = {"stiffness_x": "c_x", "damping_x": "d_x"}
    couplings = [CONTACT, BACK, ("spring", "one.a", "frame.a", alike), ("spring", "two.a", "frame.a", alike)]
    brake = brake_of(brake_text(numbers, bodies, points, couplings))
    exact = complex(-40.0 / 2.6, math.sqrt(1e7 / 1.3 - (40.0 / 2.6) ** 2))
    pairs = [
        p
        for p in eigen_pairs(brake, 0.4)
        if p.frequency_hz == pytest.approx(exact.imag / math.tau, rel=1e-12)
    ]
    assert len(pairs) == 2
    assert all(p.real_part_1_s == pytest.approx(exact.real, rel=1e-9) for p in pairs)
    found = eigen_pairs_of(LinearBrake(brake), {"mu": 0.4})
    twice = np.abs(found.eigenvalues - exact) < 1e-8 * abs(exact)
    assert twice.sum() == 2
    assert found.alignments[twice].min() > 0.99  # semi-simple, not defective
    assert np.linalg.svd(found.right[:, twice], compute_uv=False)[1] > 0.5


# -- free motion ---------------------------------------------------------------------------------------------


def test_body_without_coupling_drifts_and_squeals_not() -> None:
    plain = brake_of(brake_text(NUMBERS, BODIES, POINTS, [CONTACT, BACK]))
    text = brake_text(
        {**NUMBERS, "m_loose": 2.0, "J_loose": 0.1}, {**BODIES, "loose": "xyp"}, POINTS, [CONTACT, BACK]
    )
    loose = brake_of(text)
    expected, pairs = eigen_pairs(plain, 0.4), eigen_pairs(loose, 0.4)
    free, others = pairs[:6], pairs[6:]
    assert all(p.frequency_hz == p.real_part_1_s == p.damping_ratio == 0.0 and not p.unstable for p in free)
    for one, other in zip(expected, others, strict=True):
        assert other.frequency_hz == pytest.approx(one.frequency_hz, rel=1e-12)
        assert other.real_part_1_s == pytest.approx(one.real_part_1_s, rel=1e-9)
    assert onset_mu(loose, 0.0, mu_max=0.9) is None
    found = eigen_pairs_of(LinearBrake(loose), {"mu": 0.4})
    assert (found.eigenvalues == 0.0).sum() == 6
    assert not found.unstable.any()


def free_chain(n: int) -> Matrices:
    """Masses on a line, coupled to each other only."""
    k = sparse.diags_array(
        [np.r_[1.0, np.full(n - 2, 2.0), 1.0], -np.ones(n - 1), -np.ones(n - 1)], offsets=[0, 1, -1]
    )
    return Matrices(
        sparse.csr_array(sparse.eye_array(n)), sparse.csr_array(1e-6 * k), sparse.csr_array(1e6 * k)
    )


@pytest.mark.parametrize("shifts", [False, True])
def test_free_chain(shifts: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """One rigid-body motion, and 2 omega sin(i pi / 2n): dense, and by shift-invert from 0 Hz."""
    n = 40
    if shifts:
        monkeypatch.setattr(band_module, "DENSE_WITH_BAND", 0)
    exact = 2.0 * 1e3 * np.sin(np.arange(n) * math.pi / (2 * n)) / math.tau
    found = eigen_pairs_of_matrices(free_chain(n), (0.0, 200.0))
    assert found.complete is True, found.evidence
    assert found.method == ("shift-invert" if shifts else "dense")
    inside = exact[exact < 200.0]
    assert (found.eigenvalues == 0.0).sum() == 2
    np.testing.assert_allclose(found.frequencies_hz, np.r_[0.0, inside], rtol=1e-9)
    assert not found.unstable.any()


# -- absurd input --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "arguments",
    [{"mu": math.nan}, {"mu": -0.1}, {"mu": math.inf}, {"slope_s_m": -1.0}, {"slope_s_m": math.nan},
     {"pressure_bar": -1.0}, {"pressure_bar": math.inf}],
)  # fmt: skip
def test_absurd_working_points_are_refused(arguments: dict[str, float]) -> None:
    brake = load_brake(BRAKES / "model.toml")
    (name,) = arguments
    with pytest.raises(ValueError, match=f"{name} is .*; give a finite number"):
        eigen_pairs(brake, **arguments)
    with pytest.raises(ValueError, match="give"):
        (onset_mu if name == "pressure_bar" else onset_pressure)(brake, **arguments)
    quantity = {"slope_s_m": "slope", "pressure_bar": "pressure"}.get(name, name)
    with pytest.raises(ValueError, match=f"{quantity} = "):
        eigen_pairs_of(LinearBrake(brake), {quantity: arguments[name]})


def test_huge_numbers_are_refused_not_wrong() -> None:
    brake = load_brake(BRAKES / "model.toml")
    with np.errstate(over="ignore"), pytest.raises(ValueError, match="overflow"):
        eigen_pairs(brake, mu=1e305)
    with np.errstate(over="ignore"), pytest.raises(ValueError, match="too large"):
        eigen_pairs_of(LinearBrake(brake), {"mu": 1e305})
    huge = Matrices(np.eye(2), np.zeros((2, 2)), 1e200 * np.eye(2))
    with pytest.raises(ValueError, match="too large"):
        eigen_pairs_of_matrices(huge)


@pytest.mark.parametrize("top", [0.0, -1.0, math.nan, math.inf])
def test_absurd_ranges_are_refused(top: float) -> None:
    brake = load_brake(BRAKES / "model.toml")
    for search in (lambda: onset_mu(brake, mu_max=top), lambda: onset_pressure(brake, pressure_max_bar=top)):
        with pytest.raises(ValueError, match="end of the range"):
            search()


@pytest.mark.parametrize(
    ("change", "message"),
    [({"m_disc": -5.0}, "must be positive"), ({"m_disc": 0.0}, "must be positive"),
     ({"c_tie": -1.0}, "must be positive"),
     ({"d_con": -1.0}, "must be not negative"), ({"m_disc": math.nan}, "finite number"),
     ({"J_disc": math.inf}, "finite number")],
)  # fmt: skip
def test_absurd_brakes_are_refused(change: dict[str, float], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        load_brake(BRAKES / "model.toml").with_parameters(**change)


def test_absurd_values_of_a_model_are_refused() -> None:
    model = LinearBrake(load_brake(BRAKES / "model.toml"))
    for change, message in (
        ({"m_disc": -5.0}, "disc.mass"),
        ({"c_tie": 0.0}, "positive"),
        ({"d_con": math.nan}, "finite"),
    ):
        with pytest.raises(ValueError, match=message):
            eigen_pairs_of(model, change)


def test_extremely_unequal_sizes_keep_their_digits() -> None:
    """Frequencies of 1e-3 and 1e6 Hz in one model: the low one is not taken for a free motion."""
    omega = np.array([1.0, 1e6]) * math.tau
    found = eigen_pairs_of_matrices(Matrices(np.eye(2), np.diag([0.02, 2e4]) * math.tau, np.diag(omega**2)))
    expected = np.sqrt(1.0 - 0.01**2) * omega / math.tau
    np.testing.assert_allclose(found.frequencies_hz, expected, rtol=1e-6)

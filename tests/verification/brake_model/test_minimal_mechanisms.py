"""Sprag-slip and the 2-DOF model: criteria against eigenvalues, Hurwitz's boundaries, published cases."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from sim_hardware.brake_model.linear import LinearModel
from sim_hardware.brake_model.minimal.cases import FOLDER, TwoDofCase, check_case, load_case, shipped_cases
from sim_hardware.brake_model.minimal.hurwitz import (
    TwoFreedoms,
    first_instability,
    hurwitz_boundaries,
    is_stable,
    real_roots,
    root_locus,
)
from sim_hardware.brake_model.minimal.sprag import (
    SpragModel,
    critical_mu,
    needed_disc_damping,
    smallest_critical_mu,
)
from sim_hardware.brake_model.minimal.two_dof import TwoDofModel

PAD = TwoDofModel(mass=0.4, inertia=4.7e-4, d1=60.0, d2=0.07, c1=3.4e7, c2=1.12e5, c3=5e7, s=0.005, h=0.0165)


def sprag(angle_deg: float, d1: float = 100.0, d2: float = 3.0, **more: float) -> SpragModel:
    fields = {
        "mass_kg": 1.0, "angle_rad": math.radians(angle_deg), "disc_damping_ns_m": d1, "pad_damping_ns_m": d2,
        "pad_stiffness_n_m": 1e8,
    }  # fmt: skip
    return SpragModel.model_validate(fields | more)


@given(
    angle=st.floats(-85.0, 85.0), d1=st.floats(0.1, 1e4), d2=st.floats(0.0, 1e3), mu=st.floats(-3.0, 3.0)
)  # fmt: skip
def test_criterion_is_the_boundary_of_the_equation_of_motion(angle, d1, d2, mu) -> None:
    model = sprag(angle, d1, d2)
    assume(abs(angle) > 1e-3)
    assume(abs(model.damping_ns_m(mu)) > 1e-9 * (d1 + d2))
    assert model.unstable(mu) == (model.damping_ns_m(mu) < 0.0)
    assert model.unstable(mu) == (model.eigenvalues(mu)[0].real > 0.0)


@given(angle=st.floats(0.5, 85.0), d1=st.floats(1.0, 1e4), d2=st.floats(0.0, 1e3))
def test_boundary_mirrors_with_the_angle(angle, d1, d2) -> None:
    """gamma < 0 inverts the relation: unstable below -mu, the disc turning the other way."""
    model, mirrored = sprag(angle, d1, d2), sprag(-angle, d1, d2)
    assert mirrored.critical_mu == pytest.approx(-model.critical_mu)
    assert model.damping_ns_m(model.critical_mu) == pytest.approx(
        0.0, abs=1e-9 * (d1 + d2) * model.critical_mu
    )
    assert not mirrored.unstable(5.0) and mirrored.unstable(1.01 * mirrored.critical_mu - 1e-9)


def test_realistic_friction_needs_a_much_stronger_disc_damper() -> None:
    for ratio in (0.0, 0.02, 0.3, 1.0):
        angles = np.linspace(1e-4, math.pi / 2 - 1e-4, 200001)
        mu, angle = smallest_critical_mu(ratio)
        assert critical_mu(angles, 1.0, ratio).min() == pytest.approx(mu, abs=2e-4)
        assert float(critical_mu(max(angle, 1e-9), 1.0, ratio)) == pytest.approx(mu, abs=1e-8)
    assert needed_disc_damping(0.4) == pytest.approx(25.97, abs=0.01)
    assert smallest_critical_mu(1.0 / needed_disc_damping(0.6))[0] == pytest.approx(0.6, rel=1e-12)
    assert smallest_critical_mu(1.0)[0] == pytest.approx(
        2.0 * math.sqrt(2.0)
    )  # equal dampers: never in practice


def test_sprag_extremes() -> None:
    flat = sprag(0.0)
    assert flat.critical_mu == math.inf and not flat.unstable(100.0)
    assert sprag(20.0, d1=0.0).critical_mu == math.inf
    assert sprag(-20.0, d1=0.0).critical_mu == -math.inf
    locked = sprag(20.0, disc_stiffness_n_m=1e9)
    assert locked.locking_mu == pytest.approx(math.tan(math.radians(20)) + 0.2 / math.sin(math.radians(40)))
    above = locked.eigenvalues(1.01 * locked.locking_mu)
    assert above[0].imag == 0.0 and above[0].real > 0.0  # divergence
    for call, words in (
        (lambda: critical_mu(math.pi / 2, 1.0, 1.0), "between -90° and 90°"),
        (lambda: critical_mu(0.1, -1.0, 1.0), "disc = -1"),
        (lambda: smallest_critical_mu(-1.0), "damping_ratio = -1"),
        (lambda: needed_disc_damping(0.0), "mu = 0"),
    ):
        with pytest.raises(ValueError, match=words):
            call()


positive = st.floats(0.05, 20.0)
pads = st.builds(
    TwoDofModel, mass=positive, inertia=positive, d1=positive, d2=positive,
    c1=positive, c2=positive, c3=positive, s=st.floats(-3.0, 3.0), h=st.floats(-3.0, 3.0),
)  # fmt: skip


@settings(max_examples=50, deadline=None)
@given(model=pads, mu=st.floats(-3.0, 3.0))
def test_hurwitz_agrees_with_eigenvalues(model: TwoDofModel, mu: float) -> None:
    eigenvalues = model.system.eigenvalues(mu)
    assert model.matrices({"mu": mu}).state_matrix() == pytest.approx(model.system.state_matrix(mu))
    size = np.abs(eigenvalues).max()
    assume(abs(eigenvalues.real.max()) > 1e-7 * size)
    assert is_stable(model.system, mu) == bool(eigenvalues.real.max() < 0.0)


@settings(max_examples=30, deadline=None)
@given(model=pads)
def test_every_boundary_means_what_its_name_says(model: TwoDofModel) -> None:
    assume(min(abs(model.s), abs(model.h)) > 0.05)
    system = model.system
    a0, a1, a2, h2, h3, coupling = hurwitz_boundaries(system)
    # divergence: the expression printed in Table 1 (for h s > 0 as a lower bound of mu)
    assert a0.crossings[0].mu == pytest.approx(model.divergence_mu, rel=1e-9)
    eigenvalues = system.eigenvalues(a0.crossings[0].mu)
    assert np.abs(eigenvalues).min() < 1e-6 * np.abs(eigenvalues).max()
    # flutter: a pair on the imaginary axis at omega^2 = a1 / a3, or a pair of opposite real eigenvalues
    a3 = system.coefficients()[3][0]
    for crossing in h3.crossings:
        square = a1.value(crossing.mu) / a3
        assume(abs(square) > 1e-6)
        values = system.eigenvalues(crossing.mu)
        expected = 1j * math.sqrt(square) if square > 0 else math.sqrt(-square)
        assert np.abs(values - expected).min() < 2e-5 * np.abs(values).max()
        if crossing.is_stability_boundary:
            assert crossing.frequency_hz == pytest.approx(math.sqrt(square) / (2 * math.pi), rel=1e-4)
    # the other three are never the border of stability
    for boundary in (a1, a2, h2):
        assert boundary.role == "never first"
        assert not any(c.is_stability_boundary for c in boundary.crossings)
        for crossing in boundary.crossings:
            if a0.value(crossing.mu) > 0.0:
                assert h3.value(crossing.mu) < 1e-9 * max(1.0, abs(h3.polynomial[0]))
    # undamped flutter is (a11 - a22)^2 + 4 a12 a21 = 0 of M^-1 C
    for crossing in coupling.crossings:
        m = model.matrices({"mu": crossing.mu})
        a = np.linalg.solve(m.mass, m.stiffness)
        terms = (a[0, 0] - a[1, 1]) ** 2, 4 * a[0, 1] * a[1, 0]
        assert sum(terms) == pytest.approx(0.0, abs=1e-7 * (abs(terms[0]) + np.abs(a).max() ** 2))


@settings(max_examples=25, deadline=None)
@given(model=pads)
def test_first_instability_is_the_first_along_a_fine_path(model: TwoDofModel) -> None:
    found = first_instability(model.system)
    mus = np.linspace(0.0, min(found[1].mu, 1e3) if found else 30.0, 100, endpoint=False)
    values = model.system.eigenvalues(mus)
    assert values.real.max() < 1e-6 * np.abs(values).max()
    if found and found[1].mu < 1e3:
        role, crossing = found
        beyond = model.system.eigenvalues(crossing.mu * 1.001 + 1e-9)
        worst = beyond[np.argmax(beyond.real)]
        assert worst.real > 0.0
        assert (role == "divergence") == (abs(worst.imag) < 1e-6 * np.abs(beyond).max())


def test_mode_coupling_of_figure_1b() -> None:
    """Frequencies approach, then the real parts part; flutter at mu = 0.4715, 2379 Hz, divergence far off."""
    role, crossing = first_instability(PAD.system)
    assert role == "flutter"
    assert crossing.mu == pytest.approx(0.47149, abs=1e-5)
    assert crossing.frequency_hz == pytest.approx(2379.13, abs=0.01)
    assert PAD.divergence_mu == pytest.approx(67.38, abs=0.01)
    locus = root_locus(PAD.system, np.linspace(0.0, 0.7, 701))
    pair = locus[:, np.flatnonzero(locus[0].imag > 0)]
    gap = np.abs(np.diff(pair.imag, axis=1)[:, 0]) / (2 * math.pi)
    assert gap[0] > 80.0 and gap[600:].max() < 2.0
    assert (
        np.abs(np.diff(pair[:300].real, axis=1)).max() < 0.1 * np.abs(np.diff(pair[600:].real, axis=1)).min()
    )
    assert pair[-1].real.max() > 0.0 > pair[-1].real.min()
    assert np.all(np.abs(np.diff(locus, axis=0)) < 1000.0)  # curves, no jumps between them


def test_more_damping_on_one_side_can_destabilise() -> None:
    """Section 4.3.3 in the small: "increase of damping does not always improve"."""
    more = TwoDofModel.model_validate(PAD.model_dump() | {"d2": 0.14})
    bare = TwoDofModel.model_validate(PAD.model_dump() | {"d1": 0.0, "d2": 0.0})
    assert first_instability(more.system)[1].mu == pytest.approx(0.45917, abs=1e-5)
    undamped = first_instability(bare.system)
    assert undamped is not None and undamped[0] == "flutter"
    assert undamped[1].mu == pytest.approx(0.46738, abs=1e-5)
    assert first_instability(more.system)[1].mu < undamped[1].mu < first_instability(PAD.system)[1].mu


def test_derivatives_are_exact_for_every_quantity() -> None:
    assert isinstance(PAD, LinearModel)
    for name, quantity in PAD.quantities.items():
        value = quantity.value or 0.3
        at = {name: value, **({"mu": 0.3} if name != "mu" else {})}
        step = 1e-3 * value
        exact = PAD.derivative(name, at)
        up, down = PAD.matrices(at | {name: value + step}), PAD.matrices(at | {name: value - step})
        for part in ("mass", "damping", "stiffness"):
            numeric = (getattr(up, part) - getattr(down, part)) / (2 * step)
            assert getattr(exact, part) == pytest.approx(
                numeric, rel=1e-6, abs=1e-9 * (1 + np.abs(numeric).max())
            )


def test_two_dof_extremes() -> None:
    free = TwoDofModel(mass=1.0, inertia=1.0, d1=0.0, d2=0.0, c1=0.0, c2=0.0, c3=1.0, s=0.0, h=0.5)
    assert np.abs(free.system.eigenvalues(0.4)).min() == 0.0  # a rigid-body mode is there, not hidden
    assert free.divergence_mu == math.inf
    assert all(not b.crossings for b in hurwitz_boundaries(free.system) if b.name in ("a1", "H2", "H3"))
    equal = TwoDofModel(mass=1.0, inertia=1.0, d1=0.0, d2=0.0, c1=1.0, c2=2.0, c3=1.0, s=0.0, h=1.0)
    assert np.allclose(np.abs(equal.system.eigenvalues(0.0)), math.sqrt(2.0))  # coinciding eigenvalues
    assert first_instability(equal.system) is None  # s = 0: friction acts one way only, never unstable
    with pytest.raises(KeyError, match=r"no quantity 'c4'"):
        PAD.matrices({"c4": 1.0})
    with pytest.raises(ValidationError):
        PAD.matrices({"mass": -1.0})
    with pytest.raises(ValueError, match="mu = nan"):
        PAD.system.eigenvalues(math.nan)
    with pytest.raises(ValueError, match=r"unstable there already"):
        first_instability(PAD.system, mu_from=0.6)
    with pytest.raises(ValueError, match="no values of mu"):
        root_locus(PAD.system, [])


@given(roots=st.lists(st.floats(-5.0, 5.0), min_size=1, max_size=4, unique=True))
def test_real_roots(roots: list[float]) -> None:
    ordered = sorted(roots)
    assume(all(b - a > 0.1 for a, b in itertools.pairwise(ordered)))
    assert real_roots(np.polynomial.polynomial.polyfromroots(ordered)) == pytest.approx(ordered, abs=1e-6)


def test_real_roots_of_degenerate_polynomials() -> None:
    assert real_roots([1.0]) == () and real_roots([1.0, 0.0, 0.0]) == () and real_roots([1.0, 0.0, 1.0]) == ()
    assert real_roots([0.0, 0.0, 3.0]) == (0.0,)


def test_damping_that_depends_on_mu_is_allowed() -> None:
    """General 2-DOF systems: expressions of higher degree in mu, roots from the companion matrix."""
    system = TwoFreedoms(
        np.eye(2), np.diag([1.0, 1.0]), np.array([[0.0, 0.3], [-0.4, 0.0]]), np.diag([4.0, 5.0]),
        np.array([[0.0, -2.0], [1.5, 0.0]]),
    )  # fmt: skip
    found = first_instability(system)
    assert found is not None
    below, above = (system.eigenvalues(found[1].mu * f).real.max() for f in (0.999, 1.001))
    assert below < 0.0 < above


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.toml")), ids=lambda p: p.stem)
def test_published_case(path) -> None:
    """Every shipped case gives its numbers; the derivation stands in the file."""
    for check in check_case(load_case(path)):
        assert check.passed, (
            f"{check.expectation.quantity}: {check.computed} against {check.expectation.value}"
        )


def test_cases_are_models_and_refuse_nonsense() -> None:
    cases = shipped_cases()
    assert len(cases) >= 8
    for case in cases:
        if isinstance(case, TwoDofCase):
            assert isinstance(case, LinearModel)
            assert np.allclose(
                case.matrices({"mu": 2.0}).stiffness, case.system.stiffness + 2 * case.system.stiffness_mu
            )
            with pytest.raises(KeyError, match="no quantity 'pressure'"):
                case.matrices({"pressure": 1.0})
    hulten = load_case(FOLDER / "hulten.toml")
    wrong = hulten.model_copy(
        update={"expect": (hulten.expect[0].model_copy(update={"quantity": "critical_mi"}),)}
    )  # fmt: skip
    with pytest.raises(ValueError, match=r"critical_mi.*Did you mean: critical_mu"):
        check_case(wrong)

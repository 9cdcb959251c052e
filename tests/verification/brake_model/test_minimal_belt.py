"""Belt oscillator: criterion of Table 1, eqs 28-31, exact events, limit cycles, frequency over belt speed."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from sim_hardware.brake_model.minimal.belt import BeltOscillator
from sim_hardware.brake_model.minimal.cycles import (
    coulomb_period_s,
    frequency_over_speed,
    largest_one_way_speed,
    next_turn_m,
    orbit,
    phase_plane,
    stable_cycle,
    stick_slip_cycle,
)
from sim_hardware.brake_model.minimal.laws import (
    CoulombLaw,
    CubicLaw,
    ExponentialLaw,
    HyperbolicLaw,
    LinearFallingLaw,
)
from sim_hardware.brake_model.minimal.motion import simulate
from sim_hardware.brake_model.minimal.phases import LinearSliding

COULOMB = CoulombLaw(mu_static=0.5, mu_dynamic=0.4)
FALLING = LinearFallingLaw(mu_static=0.5, slope_s_m=0.6)
STEEP = LinearFallingLaw(mu_static=0.5, slope_s_m=900.0)
EXPONENTIAL = ExponentialLaw(mu_static=0.5, mu_dynamic=0.4, speed_scale_m_s=0.1, viscous_s_m=0.01)
LAWS = (
    COULOMB, FALLING, EXPONENTIAL,
    HyperbolicLaw(mu_static=0.5, speed_scale_m_s=0.3),
    CubicLaw(mu_static=0.5, mu_minimum=0.3, speed_scale_m_s=0.5),
)  # fmt: skip


def brake_like(law, **changes) -> BeltOscillator:
    """1 kg at 2135 Hz under 15 bar."""
    fields = {
        "mass_kg": 1.0, "stiffness_n_m": 1.8e8, "normal_force_n": 3435.0, "belt_speed_m_s": 0.15, "law": law,
    }  # fmt: skip
    return BeltOscillator.model_validate(fields | changes)


def unit(law, speed=0.2, **changes) -> BeltOscillator:
    return brake_like(
        law, mass_kg=1.0, stiffness_n_m=1.0, normal_force_n=1.0, belt_speed_m_s=speed, **changes
    )


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
@pytest.mark.parametrize("speed", [0.05, 0.4, 0.9])
def test_slope_of_law_is_its_derivative(law, speed) -> None:
    step = 1e-6
    numeric = (law.sliding(speed + step) - law.sliding(speed - step)) / (2 * step)
    assert law.slope(speed) == pytest.approx(numeric, rel=1e-6, abs=1e-9)
    assert law.curve([-speed, speed]) == pytest.approx([law.sliding(speed)] * 2)
    if law.affine is not None:
        assert law.affine[0] + law.affine[1] * speed == law.sliding(speed)


@given(
    slope=st.floats(0.0, 3.0), damping=st.floats(0.0, 500.0), force=st.floats(0.0, 1e4),
    speed=st.floats(0.01, 1.0),
)  # fmt: skip
def test_criterion_of_table_1_is_the_linearised_boundary(slope, damping, force, speed) -> None:
    belt = brake_like(
        LinearFallingLaw(mu_static=0.5, slope_s_m=slope),
        damping_ns_m=damping, normal_force_n=force, belt_speed_m_s=speed,
    )  # fmt: skip
    eigenvalues = np.array(belt.eigenvalues())
    matrix = np.array([[0.0, 1.0], [-belt.stiffness_n_m, -belt.effective_damping_ns_m]])
    lapack = np.sort_complex(np.linalg.eigvals(matrix / np.array([[1.0], [belt.mass_kg]])))
    assert np.sort_complex(eigenvalues) == pytest.approx(lapack, rel=1e-9)
    if abs(slope * force - damping) > 1e-9 * (1.0 + damping):
        assert (eigenvalues.real.max() > 0.0) == belt.falls_too_steeply


def test_damping_ratio_is_equation_31_and_dimensionless_motion_is_the_same() -> None:
    belt = brake_like(FALLING, damping_ns_m=40.0)
    small = belt.dimensionless()
    impedance = math.sqrt(belt.stiffness_n_m * belt.mass_kg)
    assert small.friction_damping == pytest.approx(-3435.0 * 0.6 / (2.0 * impedance), rel=1e-15)
    assert small.damping == pytest.approx(belt.damping_ratio, rel=1e-14)
    right_side = 3435.0 / 1.8e8 * (0.5 - 0.6 * 0.15)  # eq 30: F_n / c (mu_0 sgn(v) - k v_0)
    assert belt.equilibrium_m == pytest.approx(right_side, rel=1e-14)
    assert small.oscillator.equilibrium_m * small.length_scale_m == pytest.approx(right_side, rel=1e-14)
    times = np.linspace(0.0, 3e-3, 50)
    x, v = simulate(belt, 2e-6, 0.0, 3e-3).at(times)
    end = 3e-3 / small.time_scale_s
    y, w = simulate(small.oscillator, 2e-6 / small.length_scale_m, 0.0, end).at(times / small.time_scale_s)
    assert y * small.length_scale_m == pytest.approx(x, abs=1e-15)
    assert w * small.length_scale_m / small.time_scale_s == pytest.approx(v, abs=1e-11)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.law)
def test_motion_agrees_with_a_plain_integration_between_events(law) -> None:
    """Each phase again by an independent method (Radau), from the state at which it begins."""
    belt = unit(law, speed=0.3, damping_ns_m=0.01)
    motion = simulate(belt, 1.2, -0.5, 30.0)
    kinds = {phase.kind for phase in motion.phases}
    assert "slip" in kinds
    for phase in motion.phases[:6]:
        x0, v0 = phase.motion.at(np.zeros(1))
        if phase.kind == "stick":
            force = np.abs(belt.stiffness_n_m * np.array([x0[0], phase.end[0]]) + belt.damping_ns_m * v0[0])
            assert force.max() <= belt.holding_force_n * (1 + 1e-9)
            assert phase.end[1] == belt.belt_speed_m_s
            continue
        sign = 1.0 if phase.kind == "slip" else -1.0
        mu = belt.law.sliding

        def rate(_, y, sign=sign, mu=mu):
            return [y[1], sign * mu(sign * (0.3 - y[1])) - 0.01 * y[1] - y[0]]

        peer = solve_ivp(rate, (0.0, phase.duration_s), [x0[0], v0[0]], method="Radau", rtol=1e-9, atol=1e-11)
        assert phase.end == pytest.approx(tuple(peer.y[:, -1]), abs=2e-7)
        inner = phase.motion.at(np.linspace(0.0, phase.duration_s, 200)[1:-1])[1]
        assert np.all(sign * (0.3 - inner) > -1e-9)  # no crossing was missed


@settings(max_examples=40, deadline=None)
@given(delta=st.floats(-3.0, 3.0), w2=st.sampled_from([0.0, 1e-12, 0.5, 1.0, 4.0]), t=st.floats(0.0, 20.0))
def test_closed_solution_solves_the_equation(delta, w2, t) -> None:
    """Against the matrix exponential: vibrating, critical, creeping, growing, without a spring."""
    motion = LinearSliding(delta, w2, 0.3, -0.2, 0.7 + 0.4 * delta - 0.3 * w2)
    matrix = np.array([[0.0, 1.0, 0.0], [-w2, -2.0 * delta, 0.7], [0.0, 0.0, 0.0]])
    expected = expm(matrix * t) @ [0.3, -0.2, 1.0]
    x, v = motion.at(np.array([t]))
    size = 1.0 + np.abs(expected).max()
    assert [x[0], v[0]] == pytest.approx(expected[:2].tolist(), abs=1e-9 * size)
    assert motion.velocity(t) == pytest.approx(v[0], abs=1e-12 * size)


@settings(max_examples=60, deadline=None)
@given(
    x=st.floats(-3.0, 3.0), v=st.floats(-3.0, 3.0), speed=st.floats(0.0, 1.0), damping=st.floats(0.0, 2.5),
    slope=st.floats(0.0, 0.8), stiffness=st.sampled_from([0.0, 0.5, 1.0]),
)  # fmt: skip
def test_motion_is_continuous_and_obeys_the_rules_of_sticking(x, v, speed, damping, slope, stiffness) -> None:
    belt = unit(
        LinearFallingLaw(mu_static=0.5, slope_s_m=slope), speed=speed, damping_ns_m=damping
    ).changed(stiffness_n_m=stiffness)  # fmt: skip
    motion = simulate(belt, x, v, 25.0)
    state = (x, v)
    for phase in motion.phases:
        begin = phase.motion.at(np.zeros(1))
        assert (begin[0][0], begin[1][0]) == pytest.approx(state, abs=1e-9)
        state = phase.end
        middle = phase.motion.at(np.linspace(0.0, phase.duration_s, 9)[1:-1])
        slip = speed - middle[1]
        if phase.kind == "stick":
            assert np.all(np.abs(stiffness * middle[0] + damping * speed) <= 0.5 + 1e-9)
            assert slip == pytest.approx(0.0, abs=1e-15)
        else:
            assert np.all((slip if phase.kind == "slip" else -slip) >= -1e-9 * (1.0 + abs(v)))


@given(drop=st.floats(0.001, 0.4), speed=st.floats(0.01, 2.0))
@settings(deadline=None, max_examples=40)
def test_coulomb_period_is_the_closed_formula(drop, speed) -> None:
    belt = unit(CoulombLaw(mu_static=0.2 + drop, mu_dynamic=0.2), speed=speed)
    cycle = stick_slip_cycle(belt)
    if cycle is None or cycle.kind != "stick-slip":
        pytest.fail("undamped Coulomb friction with mu_s > mu_d sticks at every speed")
    if "reverse" not in {phase.kind for phase in cycle.trajectory.phases}:
        assert cycle.period_s == pytest.approx(coulomb_period_s(belt), rel=1e-12)


def test_phase_plane_of_the_falling_law_is_figure_1a() -> None:
    """Diverging inside the stick-slip cycle, contracting outside, diverging again beyond an outer cycle."""
    belt = brake_like(FALLING)
    plane = phase_plane(belt)
    assert [r.behaviour for r in plane.regions] == ["diverging", "contracting", "diverging"]
    inner, outer = plane.cycles
    assert (inner.kind, outer.kind) == ("stick-slip", "reversing")
    assert inner.stable and not outer.stable
    assert inner.law_valid and not outer.law_valid  # mu < 0 out there: the law, not the brake, diverges
    growth = math.exp(-2 * math.pi * belt.damping_ratio / math.sqrt(1 - belt.damping_ratio**2))
    assert next_turn_m(belt, 0.3 * inner.turn_m) == pytest.approx(0.3 * inner.turn_m * growth, rel=1e-10)
    assert next_turn_m(belt, 3 * inner.turn_m) < 3 * inner.turn_m
    assert next_turn_m(belt, 1.2 * inner.turn_m) == pytest.approx(inner.turn_m, rel=1e-9)  # sticks at once
    start, end = inner.trajectory.phases[0], inner.trajectory.phases[-1]
    assert (start.motion.at(np.zeros(1))[0][0], belt.belt_speed_m_s) == pytest.approx(end.end)
    turn = orbit(belt, outer.turn_m)
    assert turn is not None and turn.end_s == pytest.approx(outer.period_s)


def test_coulomb_without_damping_has_a_neutral_core() -> None:
    """Section 1.1: infinitely many closed orbits with peak velocities below the belt's."""
    belt = brake_like(COULOMB)
    plane = phase_plane(belt)
    assert [r.behaviour for r in plane.regions] == ["neutral", "diverging", "contracting"]
    touching = belt.belt_speed_m_s / belt.angular_frequency_1_s
    assert plane.regions[0].to_m == pytest.approx(touching, rel=1e-8)
    assert plane.cycles[0].turn_m == pytest.approx(math.hypot(touching, 0.1 * 3435 / 1.8e8), rel=1e-9)


def test_coulomb_with_damping_keeps_a_jump_not_a_cycle() -> None:
    """Below the motion that touches v = 0 everything comes to rest; above it, to stick-slip."""
    plane = phase_plane(brake_like(COULOMB, damping_ns_m=60.0, belt_speed_m_s=0.05))
    assert [r.behaviour for r in plane.regions] == ["contracting", "diverging", "contracting"]
    assert [c.kind for c in plane.cycles] == ["stick-slip"]


def test_frequency_is_free_of_speed_for_the_linear_law_only() -> None:
    """The argument of section 1.1, with its limit: as long as the mass does not overtake the belt."""
    falling = brake_like(FALLING)
    limit = largest_one_way_speed(falling)
    assert limit == pytest.approx(0.2112684, rel=1e-6)
    curve = frequency_over_speed(falling, np.geomspace(1e-4, 0.999 * limit, 9))
    assert curve.frequency_hz == pytest.approx(np.full(9, 2037.72875), rel=1e-8)
    assert curve.amplitude_m / curve.speeds_m_s == pytest.approx(
        np.full(9, curve.amplitude_m[0] / 1e-4), rel=1e-7
    )
    beyond = frequency_over_speed(falling, [1.05 * limit])
    assert beyond.frequency_hz[0] > 2037.73
    assert "reverse" in {p.kind for p in stick_slip_cycle(falling.with_speed(1.05 * limit)).trajectory.phases}
    assert "reverse" not in {
        p.kind for p in stick_slip_cycle(falling.with_speed(0.999 * limit)).trajectory.phases
    }
    coulomb = frequency_over_speed(brake_like(COULOMB), np.geomspace(0.002, 0.5, 6))
    assert np.all(np.diff(coulomb.frequency_hz) > 0.0)
    assert coulomb.frequency_hz[0] < 0.35 * coulomb.frequency_hz[-1]
    exponential = frequency_over_speed(brake_like(EXPONENTIAL), [0.02, 0.2])
    assert 0.02 < exponential.spread < 0.1


def test_exponential_law_jumps_stable_sliding_beside_stick_slip() -> None:
    """The Hopf point in closed form; beyond it rest and stick-slip coexist, parted by an unstable cycle."""
    law = ExponentialLaw(mu_static=0.5, mu_dynamic=0.4, speed_scale_m_s=0.1)
    hopf = 0.1 * math.log(0.1 / 0.1 * 3435.0 / 100.0)  # F_n mu'(v) = -d

    def damped(factor: float) -> BeltOscillator:
        return brake_like(law, damping_ns_m=100.0, belt_speed_m_s=factor * hopf)

    assert damped(0.99).falls_too_steeply and not damped(1.01).falls_too_steeply
    plane = phase_plane(damped(1.2), points=16)
    assert [r.behaviour for r in plane.regions] == ["contracting", "diverging", "contracting"]
    between, outer = plane.cycles
    assert (between.kind, between.stable, outer.kind, outer.stable) == ("sliding", False, "stick-slip", True)
    assert between.turn_m == pytest.approx(1.88314e-5, rel=1e-5)
    assert between.multiplier == pytest.approx(1.0304, abs=1e-3)
    assert stick_slip_cycle(damped(3.0)) is None  # faster: rest only


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: unit(COULOMB, speed=0.0).equilibrium_m, "belt_speed_m_s = 0.*Give a belt speed"),
        (lambda: stick_slip_cycle(unit(COULOMB, speed=0.0)), "belt_speed_m_s = 0"),
        (lambda: unit(COULOMB).changed(stiffness_n_m=0.0).equilibrium_m, "stiffness_n_m = 0.*Give"),
        (lambda: unit(COULOMB).changed(stiffness_n_m=0.0).damping_ratio, "stiffness_n_m = 0"),
        (lambda: unit(COULOMB).changed(normal_force_n=0.0).dimensionless(), "normal_force_n = 0.*Give"),
        (lambda: simulate(unit(COULOMB), math.nan, 0.0, 1.0), "position_m = nan"),
        (lambda: simulate(unit(COULOMB), 0.0, 0.0, 0.0), "duration_s = 0"),
        (lambda: simulate(unit(STEEP), 0.1, 0.0, 9.0), "beyond all numbers"),
        (lambda: frequency_over_speed(unit(COULOMB), [0.0]), "speeds_m_s = .*above 0"),
        (lambda: largest_one_way_speed(unit(COULOMB)), "law = coulomb"),
        (lambda: coulomb_period_s(unit(FALLING)), "law = linear"),
        (lambda: phase_plane(unit(COULOMB), amplitude_max_m=math.inf), "amplitude_max_m = inf"),
        (lambda: simulate(unit(COULOMB), 0.0, 0.0, 1.0).at([2.0]), "outside the trajectory"),
    ],
)  # fmt: skip
def test_what_does_not_exist_is_refused_by_name(call, words) -> None:
    with pytest.raises(ValueError, match=words):
        call()


def test_extremes_give_the_right_motion() -> None:
    at_rest = simulate(unit(COULOMB, speed=0.0), 0.3, 0.0, 50.0)  # friction holds it
    assert [p.kind for p in at_rest.phases] == ["stick"]
    assert at_rest.at(np.array([50.0]))[0][0] == 0.3
    swings = simulate(unit(COULOMB, speed=0.0), 3.0, 0.0, 50.0)  # 0.8 less each half swing until it stays
    assert swings.phases[-1].kind == "stick"
    assert swings.phases[-1].end[0] == pytest.approx(-0.2)
    carried = simulate(unit(COULOMB).changed(stiffness_n_m=0.0), 0.0, 0.2, 9.0)
    assert carried.at(np.array([9.0]))[0][0] == pytest.approx(1.8)
    free = unit(COULOMB).changed(normal_force_n=0.0)
    assert stick_slip_cycle(free) is None and stable_cycle(free) is None
    assert next_turn_m(free, 0.1) == pytest.approx(0.1, rel=1e-12)
    runaway = unit(LinearFallingLaw(mu_static=0.5, slope_s_m=2.5))  # D = -1.25: leaves without vibrating
    assert stick_slip_cycle(runaway) is None
    assert [r.behaviour for r in phase_plane(runaway).regions] == ["diverging"]
    assert max(e.real for e in runaway.eigenvalues()) > 0.0 and runaway.eigenvalues()[0].imag == 0.0
    heavy = unit(COULOMB, damping_ns_m=4.0)  # D = 2: creeps to rest
    assert stick_slip_cycle(heavy) is None
    assert next_turn_m(heavy, 0.5) == 0.0


def test_laws_refuse_nonsense() -> None:
    with pytest.raises(ValidationError, match=r"mu_dynamic = 0\.6 is larger than mu_static = 0\.5"):
        CoulombLaw(mu_static=0.5, mu_dynamic=0.6)
    with pytest.raises(ValidationError):
        LinearFallingLaw(mu_static=math.nan, slope_s_m=1.0)
    with pytest.raises(ValidationError):
        unit(COULOMB).changed(mass_kg=0.0)

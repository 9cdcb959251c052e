"""Integration with events against closed forms, the tight reference, the fast integrator and energy."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oscillators import belt
from scipy.linalg import expm
from scipy.special import ellipk

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.friction import ConstantFriction, LinearFriction, SaturatingFriction
from sim_hardware.brake_model.laws import with_cubic_contacts
from sim_hardware.brake_model.spec import BrakeSpec
from sim_hardware.brake_model.time_domain import reference
from sim_hardware.brake_model.time_domain.energy import balance
from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator
from sim_hardware.brake_model.time_domain.motion import WorkingCourse, integrate
from sim_hardware.brake_model.time_domain.reference import WorkingPoint

#: the first run compiles the integrator
pytestmark = pytest.mark.timeout(600)

PLANT = load_brake(Path(__file__).parents[3] / "configs" / "brakes" / "plant.toml")
N = PLANT.n_dof
RATE = 40_000.0
FORCE = PLANT.pad_force_n(20e5)


def kicked(speed_m_s: float) -> np.ndarray:
    state = np.zeros(2 * N)
    state[N + PLANT.freedom_index("inner_pad.x")] = speed_m_s
    return state


def one_sided(brake: Brake) -> Brake:
    data = brake.spec.model_dump()
    for coupling in data["couplings"]:
        if coupling["kind"] == "contact":
            coupling["one_sided"] = True
    return Brake(BrakeSpec.model_validate(data))


# -- against other integrators


def test_forward_sliding_equals_the_reference() -> None:
    """10 ms of growing squeal against DOP853 written element by element."""
    point = WorkingPoint(FORCE, 0.44, SaturatingFriction(mu_mean=0.4, k_s_m=0.0576, saturation_m_s=0.01))
    times = np.arange(400) / RATE
    expected = reference.motion(PLANT, point, kicked(1e-3), times)
    tight = integrate(PLANT, point, kicked(1e-3), times, rtol=1e-11, atol_m=1e-18)
    usual = integrate(PLANT, point, kicked(1e-3), times)
    assert not usual.events
    for part in (slice(0, N), slice(N, 2 * N)):
        scale = np.abs(expected[:, part]).max()
        assert np.abs(tight.states[:, part] - expected[:, part]).max() < 1e-8 * scale
        assert np.abs(usual.states[:, part] - expected[:, part]).max() < 1e-5 * scale
    assert usual.steps < tight.steps


def test_paper_law_equals_the_matrix_exponential() -> None:
    """Friction mu N always, however large the motion: the linear brake exactly (eq 18)."""
    state = np.random.default_rng(1).normal(size=2 * N) * np.repeat([1e-4, 1.0], N)
    times = np.array([0.0, 1e-4, 1e-3, 5e-3])
    point = WorkingPoint(0.0, 1.0, ConstantFriction(mu_mean=0.4))
    motion = integrate(PLANT, point, state, times, always_sliding=True, rtol=1e-11, atol_m=1e-18)
    for time, found in zip(times, motion.states, strict=True):
        expected = expm(PLANT.state_matrix(0.4, 0.0, 0.0) * time) @ state
        np.testing.assert_allclose(found[N:], expected[N:], atol=1e-8 * np.abs(expected[N:]).max())


def test_slip_reversal_equals_the_fast_integrator() -> None:
    """Limit cycle by sticking at 0.02 m/s, linear law: frequency and level as the fixed-rate integrator's."""
    point = WorkingPoint(FORCE, 0.02, LinearFriction(mu_mean=0.4, k_s_m=0.0576))
    start = kicked(0.015)
    motion = integrate(PLANT, point, start, np.arange(12_000) / RATE)
    assert {event.kind for event in motion.events} >= {"sticks", "releases"}
    fast = SquealIntegrator(PLANT, substeps=4, outputs=["inner_pad:slip"], fine_steps=8)
    fast.state = start
    expected = fast.advance(
        12_000, normal_force_n=(FORCE,) * 2, mu=(0.4,) * 2, slip_m_s=(0.02,) * 2, k_s_m=(0.0576,) * 2
    )[:, 0]
    found = 0.02 - motion.sliding_speed_m_s[:, 0]
    results = []
    for signal in (found[-6000:], expected[-6000:]):
        spectrum = np.abs(np.fft.rfft(signal * np.blackman(len(signal)), 1 << 19))
        results.append((spectrum.argmax() * RATE / (1 << 19), 20.0 * math.log10(signal.std())))
    assert results[0][0] == pytest.approx(results[1][0], abs=0.3)
    assert results[0][1] == pytest.approx(results[1][1], abs=0.03)


# -- closed forms


def test_coulomb_stick_slip_cycle_in_closed_form() -> None:
    """Static friction above sliding friction, no damping: every event of the cycle (section 1.1)."""
    mass, c, v0, load, mu, static = 0.5, 0.5e6, 0.3, 1000.0, 0.3, 0.45
    omega = math.sqrt(c / mass)
    tear = (static - mu) * load / c
    angle = math.atan2(v0 / omega, tear)
    slide, stick = (math.pi + 2.0 * angle) / omega, 2.0 * tear / v0
    course = WorkingCourse.constant(WorkingPoint(load, v0, ConstantFriction(mu_mean=mu)), static_mu=static)
    motion = integrate(
        belt(mass=mass, stiffness_x=c), course, [-tear, v0], np.linspace(0.0, 5.2 * (slide + stick), 50),
        rtol=1e-11, atol_m=1e-18,
    )  # fmt: skip
    assert motion.sliding[0, 0] == 0  # it sticks at the start
    assert [event.kind for event in motion.events] == ["releases", "sticks"] * 5 + []
    expected = np.cumsum([stick, slide] * 5)
    np.testing.assert_allclose([event.time_s for event in motion.events], expected, rtol=1e-8)
    np.testing.assert_allclose(motion.sticking_s(0)[0], [0.0, stick], rtol=1e-8)
    np.testing.assert_allclose(np.diff(motion.sticking_s(0), axis=1)[:5, 0], stick, rtol=1e-6)


def test_dry_friction_at_rest_in_closed_form() -> None:
    """A standing belt: the turning points come nearer by 2 mu N / c each, then the mass sticks for good."""
    mass, c, load, mu = 0.5, 0.5e6, 100.0, 0.4
    grip = mu * load / c
    first = 7.3 * grip  # from the unstretched spring
    # the deviation counts from the mean state under mu N towards +x
    motion = integrate(
        belt(mass=mass, stiffness_x=c), WorkingPoint(load, 0.0, ConstantFriction(mu_mean=mu)),
        [first - grip, 0.0], np.linspace(0.0, 0.02, 4001), rtol=1e-11, atol_m=1e-18,
    )  # fmt: skip
    position = motion.states[:, 0] + grip
    half = math.pi * math.sqrt(mass / c)
    turns = [event.time_s for event in motion.events if event.kind in ("reverses", "sticks")]
    np.testing.assert_allclose(turns, half * np.arange(1, len(turns) + 1), rtol=1e-7)
    # 7.3, -5.3, 3.3, -1.3, then -1.3 + 2 (1.3 - 1) = -0.7: held
    assert [event.kind for event in motion.events] == ["reverses"] * 3 + ["sticks"]
    assert position[-1] == pytest.approx(-(7.3 - 2.0 * 4) * grip * -1.0, rel=1e-6)
    assert np.ptp(motion.states[times_after(motion, turns[-1]), 0]) < 1e-15
    assert np.abs(motion.friction_n[-1, 0]) == pytest.approx(0.7 * mu * load, rel=1e-6)


def times_after(motion: object, time_s: float) -> np.ndarray:
    return motion.times_s > time_s  # type: ignore[attr-defined]


def test_lift_off_and_landing_in_closed_form() -> None:
    """A one-sided contact under a constant load: half sines and parabolas, event by event."""
    mass, c, load, speed = 0.5, 1e8, 500.0, 0.2
    brake = belt(mass=mass, contact=c, freedoms=("x", "y"), contact_keys={"one_sided": True})
    omega = math.sqrt(c / mass)
    rising = math.asin(load * omega / (c * speed)) / omega
    away = math.sqrt(speed**2 - (load / mass / omega) ** 2)
    flight = 2.0 * away * mass / load
    period = 2.0 * rising + flight + math.pi / omega
    point = WorkingPoint(load, 0.3, ConstantFriction(mu_mean=0.0))
    times = np.linspace(0.0, 2.0 * period, 400)
    motion = integrate(brake, point, [0.0, 0.0, 0.0, -speed], times, rtol=1e-11, atol_m=1e-18)
    assert [event.kind for event in motion.events] == ["lifts off", "lands"] * 2
    expected = [rising, rising + flight, rising + period, rising + flight + period]
    np.testing.assert_allclose([event.time_s for event in motion.events], expected, rtol=1e-8)
    assert motion.normal_n.min() == pytest.approx(0.0, abs=1e-6)
    flying = (times > rising) & (times < rising + flight)
    t = times[flying] - rising
    np.testing.assert_allclose(
        motion.states[flying, 1], -load / c - away * t + 0.5 * load / mass * t**2, atol=1e-12
    )


@pytest.mark.parametrize("where", ["spring", "contact"])
def test_duffing_period_is_the_elliptic_integral(where: str) -> None:
    """Cubic hardening without damping: the period over amplitude."""
    mass, c, amplitude, epsilon = 0.5, 0.5e6, 1e-4, 3.0
    extra = {"c3": (epsilon * c / amplitude**2, "N/m3")}
    if where == "spring":
        brake = belt(mass=mass, stiffness_x=c, extra=extra, spring_keys={"cubic_x": "c3"})
        state, row = [amplitude, 0.0], 0
    else:
        keys = {"cubic": "c3"}
        brake = belt(mass=mass, contact=c, freedoms=("x", "y"), extra=extra, contact_keys=keys)
        state, row = [0.0, amplitude, 0.0, 0.0], 1
    modulus = epsilon / (2.0 * (1.0 + epsilon))
    period = 4.0 * ellipk(modulus) / math.sqrt(c / mass * (1.0 + epsilon))
    point = WorkingPoint(1e4, 10.0, ConstantFriction(mu_mean=0.0))
    motion = integrate(brake, point, state, np.array([0.0, 0.5, 1.0, 7.0]) * period, rtol=1e-11, atol_m=1e-18)
    np.testing.assert_allclose(motion.states[:, row], amplitude * np.array([1.0, -1.0, 1.0, 1.0]), rtol=1e-7)


# -- what holds for any motion


@pytest.mark.parametrize("kind", ["linear", "cubic", "one-sided"])
def test_energy_balance_through_all_events(kind: str) -> None:
    """Work of friction = dissipation + change of stored energy, sticking and lift-off included."""
    brake = {
        "linear": PLANT,
        "cubic": with_cubic_contacts(PLANT, strength=100.0),
        "one-sided": one_sided(with_cubic_contacts(PLANT, strength=10.0)),
    }[kind]
    bar = 0.2 if kind == "one-sided" else 2.0
    point = WorkingPoint(PLANT.pad_force_n(bar * 1e5), 0.02, LinearFriction(mu_mean=0.4, k_s_m=0.0576))
    times = np.linspace(0.0, 4e-3, 8001)
    first = integrate(brake, point, kicked(0.3), times, rtol=1e-10, atol_m=1e-17)
    # forces jump at events: sums over time need both of their sides
    sides = [event.time_s + side for event in first.events for side in (-1e-12, 1e-12)]
    motion = integrate(brake, point, kicked(0.3), np.union1d(times, sides), rtol=1e-10, atol_m=1e-17)
    kinds = {event.kind for event in motion.events}
    assert {"sticks", "reverses"} & kinds
    assert ("lifts off" in kinds) == (kind == "one-sided")
    found = balance(motion)
    throughput = max(found.dissipated[-1], found.kinetic.max())
    assert found.dissipated[-1] > 0.1 * found.kinetic[0]
    assert np.abs(found.error).max() < 2e-5 * throughput


def test_newtons_law_with_recorded_forces() -> None:
    """Accelerations from the recorded coupling forces equal the slope of the velocities (eqs 2, 3, 6, 7)."""
    brake = one_sided(with_cubic_contacts(PLANT, strength=100.0))
    point = WorkingPoint(FORCE, 0.44, SaturatingFriction(mu_mean=0.4, k_s_m=0.0576, saturation_m_s=0.1))
    step = 1e-8
    times = np.add.outer(np.linspace(1e-4, 1e-3, 10), [-step, 0.0, step]).ravel()
    motion = integrate(
        brake,
        point,
        kicked(0.2),
        np.concatenate([[0.0], times]),
        rtol=1e-11,
        atol_m=1e-18,
        record_forces=True,
    )
    forces = motion.coupling_forces
    assert forces is not None
    assert forces.forces_n.shape == (31, 18, 2)
    assert forces.elements == tuple(e.name for e in brake.elements)
    assert (forces.torsions, forces.moments_nm.shape) == (("hub_torsion",), (31, 1))
    slopes = (motion.states[3::3, N:] - motion.states[1::3, N:]) / (2.0 * step)
    for i, slope in enumerate(slopes):
        total = -forces.moments_nm[2 + 3 * i, 0] * brake.torsions[0].row
        for e, element in enumerate(brake.elements):
            total = total - forces.forces_n[2 + 3 * i, e] @ np.array([element.row_x, element.row_y])
        np.testing.assert_allclose(total / brake.inertia, slope, atol=2e-6 * np.abs(slope).max())


def test_recorded_forces_equal_the_loop_over_couplings() -> None:
    """The same forces from `Brake.coupling_forces`, the paper's loop, at every recorded state (eqs 8, 9)."""
    brake = one_sided(with_cubic_contacts(PLANT, strength=1000.0))
    load = PLANT.pad_force_n(0.5e5)
    point = WorkingPoint(load, 0.1, ConstantFriction(mu_mean=0.4))
    motion = integrate(brake, point, kicked(0.5), np.linspace(0.0, 1e-3, 60), record_forces=True)
    assert any(event.kind == "lifts off" for event in motion.events)
    forces = motion.coupling_forces
    assert forces is not None
    places = [e for e, element in enumerate(brake.elements) if element.side]
    for i, state in enumerate(motion.states):
        friction = [-float(forces.forces_n[i, e, 0]) for e in places]
        loop, moments = brake.coupling_forces(
            state[:N], state[N:], lambda c, *_, friction=friction: friction[c], pad_force_n=load
        )
        np.testing.assert_allclose(forces.forces_n[i], loop, atol=1e-9 * np.abs(loop).max())
        np.testing.assert_allclose(forces.moments_nm[i], moments, atol=1e-12)


def test_both_pads_stick_on_a_standing_disc() -> None:
    """At rest under load the pads hold more than the mean friction: no slip while the brake rings down."""
    point = WorkingCourse.constant(WorkingPoint(FORCE, 0.0, ConstantFriction(mu_mean=0.4)), static_mu=0.6)
    state = np.zeros(2 * N)
    state[PLANT.freedom_index("caliper.y")] = 1e-7
    motion = integrate(PLANT, point, state, np.linspace(0.0, 5e-3, 200))
    assert not motion.events
    assert (motion.sliding == 0).all()
    assert np.abs(motion.sliding_speed_m_s).max() < 1e-15
    assert np.abs(motion.states[:, :N]).max() > 1e-8


def test_stop_braking_ends_sticking() -> None:
    """Sliding speed falls to 0 in time: squeal, then every pad sticks and stays."""
    course = WorkingCourse(
        np.array([0.0, 0.03, 0.05]),
        np.full(3, FORCE),
        np.array([0.03, 0.0, 0.0]),
        np.full(3, 0.4),
        np.full(3, 0.02),
    )
    motion = integrate(PLANT, course, kicked(1e-3), np.linspace(0.0, 0.05, 2001))
    assert (motion.sliding[-1] == 0).all()
    assert np.abs(motion.sliding_speed_m_s[motion.times_s > 0.04]).max() < 1e-14
    last = max(event.time_s for event in motion.events if event.kind == "sticks")
    assert 0.02 < last < 0.031
    # the friction force is what the springs ask for, within what it can hold
    assert (np.abs(motion.friction_n[motion.sliding == 0]) <= (0.4 + 0.02 * 0.03) * FORCE * 1.01).all()


def test_output_times_do_not_change_the_motion() -> None:
    point = WorkingPoint(FORCE, 0.02, LinearFriction(mu_mean=0.4, k_s_m=0.0576))
    few = integrate(PLANT, point, kicked(0.015), np.linspace(0.0, 0.01, 11))
    many = integrate(PLANT, point, kicked(0.015), np.linspace(0.0, 0.01, 1001))
    np.testing.assert_array_equal(few.states, many.states[::100])
    assert few.events == many.events


def test_tolerance_controls_the_error_through_events() -> None:
    """Time of the 20th event converges with the tolerance."""
    point = WorkingPoint(FORCE, 0.02, LinearFriction(mu_mean=0.4, k_s_m=0.0576))
    times = [
        integrate(PLANT, point, kicked(0.015), [0.0, 0.015], rtol=r, atol_m=r * 1e-7).events[20].time_s
        for r in (1e-6, 1e-8, 1e-12)
    ]
    assert abs(times[1] - times[2]) < 1e-9
    assert abs(times[0] - times[2]) < 1e-6


@settings(max_examples=30, deadline=None, derandomize=True)
@given(
    seed=st.integers(0, 10_000),
    size=st.floats(-5.0, 0.3),
    load=st.sampled_from([0.0, 1e-3, 10.0, 300.0, 3000.0]),
    slip=st.sampled_from([0.0, 1e-4, 0.01, 0.3]),
    lifts=st.booleans(),
    hardening=st.sampled_from([0.0, 1.0, 1000.0]),
    static_mu=st.sampled_from([None, 1.0]),
)
def test_set_valued_law_holds_for_any_motion(
    seed: int, size: float, load: float, slip: float, lifts: bool, hardening: float, static_mu: float | None
) -> None:
    """Random kicks: forces within the law, no slip while sticking, no pull at one-sided contacts."""
    brake = with_cubic_contacts(PLANT, strength=hardening)
    brake = one_sided(brake) if lifts else brake
    law = LinearFriction(mu_mean=0.5, k_s_m=0.05)
    course = WorkingCourse.constant(WorkingPoint(load, slip, law), static_mu=static_mu)
    start = np.zeros(2 * N)
    start[N:] = 10.0**size * np.random.default_rng(seed).normal(size=N)
    motion = integrate(brake, course, start, np.linspace(0.0, 5e-4, 501))
    pressed = np.maximum(motion.normal_n, 0.0)
    bearing = np.stack([pressed[:, :2].sum(axis=1), pressed[:, 2:].sum(axis=1)], axis=1)
    speed, stuck = motion.sliding_speed_m_s, motion.sliding == 0
    holding = law.holding_mu(slip) if static_mu is None else static_mu
    scale = 1e-6 * (bearing.max() + 1.0)
    assert (np.abs(motion.friction_n[stuck]) <= holding * bearing[stuck] + scale).all()
    sliding = law.mu(speed, slip) * bearing * motion.sliding
    np.testing.assert_allclose(motion.friction_n[~stuck], sliding[~stuck], atol=scale)
    assert np.abs(speed[stuck]).max(initial=0.0) < 1e-12
    assert (speed * motion.sliding).min() > -1e-8 * max(slip, 1.0)
    if lifts:
        assert motion.normal_n.min() > -scale

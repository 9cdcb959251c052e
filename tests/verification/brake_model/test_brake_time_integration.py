"""The fast time integrator against exact solutions, eigenvalues and a tight general-purpose integrator."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.friction import LinearFriction, SaturatingFriction
from sim_hardware.brake_model.spec import BrakeSpec
from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator
from sim_hardware.brake_model.time_domain.reference import WorkingPoint, motion

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
PLANT = load_brake(BRAKES / "plant.toml")
SLIP = 0.44  # m/s: 40 1/min at 105 mm
K = 0.0576
RATE = 40_000.0


def at(
    brake: Brake, bar: float, mu: float = 0.4, k: float = K, slip: float = SLIP
) -> dict[str, tuple[float, float]]:
    """A constant working point as keyword arguments of `advance`."""
    force = brake.pad_force_n(bar * 1e5)
    return {"normal_force_n": (force, force), "mu": (mu, mu), "slip_m_s": (slip, slip), "k_s_m": (k, k)}


def kicked(brake: Brake, speed_m_s: float) -> np.ndarray:
    state = np.zeros(2 * brake.n_dof)
    state[brake.n_dof + brake.freedom_index("inner_pad.x")] = speed_m_s
    return state


def limit_cycle(brake: Brake, bar: float, mu: float, saturation: float, seconds: float = 1.2) -> np.ndarray:
    """State on the limit cycle, found with a fine step."""
    integrator = SquealIntegrator(brake, substeps=4, outputs=())
    integrator.state = kicked(brake, saturation)
    integrator.advance(int(seconds * RATE), **at(brake, bar, mu), saturation_m_s=saturation)
    return integrator.state


def frequency_and_level(signal: np.ndarray, rate: float) -> tuple[float, float]:
    """Frequency (Hz) of the highest line by parabolic interpolation, and level (dB) of the whole."""
    spectrum = np.abs(np.fft.rfft(signal * np.blackman(len(signal)), 1 << 19))
    i = int(spectrum.argmax())
    a, b, c = np.log(spectrum[i - 1 : i + 2])
    return (i + 0.5 * (a - c) / (a - 2 * b + c)) * rate / (1 << 19), 20.0 * math.log10(signal.std())


@pytest.mark.parametrize(("substeps", "worst"), [(1, 1e-2), (2, 1e-3), (4, 1e-4)])
@pytest.mark.parametrize(("bar", "mu", "saturation"), [(20.0, 0.4, 0.01), (30.0, 0.5, 0.02)])
def test_limit_cycle_equals_tight_reference(
    substeps: int, worst: float, bar: float, mu: float, saturation: float, references: Callable
) -> None:
    """Largest deviation of any velocity over 5 ms of limit cycle, relative to the largest velocity."""
    start, expected = references(bar, mu, saturation)
    integrator = SquealIntegrator(PLANT, substeps=substeps, outputs=[f"{f}:velocity" for f in PLANT.freedoms])
    integrator.state = start
    actual = integrator.advance(len(expected), **at(PLANT, bar, mu), saturation_m_s=saturation)
    velocities = expected[:, PLANT.n_dof :]
    assert velocities.std(axis=0).max() > 0.5 * saturation  # it does squeal
    assert np.abs(actual - velocities).max() / np.abs(velocities).max() < worst


@pytest.fixture(scope="module")
def references() -> Callable:
    found: dict[tuple, tuple[np.ndarray, np.ndarray]] = {}

    def reference(bar: float, mu: float, saturation: float) -> tuple[np.ndarray, np.ndarray]:
        if (bar, mu, saturation) not in found:
            start = limit_cycle(PLANT, bar, mu, saturation)
            law = SaturatingFriction(mu_mean=mu, k_s_m=K, saturation_m_s=saturation)
            point = WorkingPoint(PLANT.pad_force_n(bar * 1e5), SLIP, law)
            found[bar, mu, saturation] = start, motion(PLANT, point, start, np.arange(200) / RATE)
        return found[bar, mu, saturation]

    return reference


def test_before_the_limit_cycle_equals_tight_reference() -> None:
    """A small motion of all modes, linear falling law (eq 28), 5 ms."""
    start = kicked(PLANT, 1e-5)
    law = LinearFriction(mu_mean=0.45, k_s_m=K)
    expected = motion(
        PLANT, WorkingPoint(PLANT.pad_force_n(20e5), SLIP, law), start, np.arange(200) / RATE, atol=1e-18
    )
    for substeps, worst in ((1, 1e-2), (4, 1e-3)):
        integrator = SquealIntegrator(
            PLANT, substeps=substeps, outputs=[f"{f}:displacement" for f in PLANT.freedoms]
        )
        integrator.state = start
        actual = integrator.advance(200, **at(PLANT, 20.0, 0.45))
        scale = np.abs(expected[:, : PLANT.n_dof]).max()
        assert np.abs(actual - expected[:, : PLANT.n_dof]).max() / scale < worst


@pytest.mark.parametrize(
    ("bar", "mu", "mu_ref"), [(8.0, 0.4, 0.4), (14.0, 0.4, 0.4), (20.0, 0.55, 0.4), (20.0, 0.3, 0.4)]
)
def test_growth_and_frequency_of_small_motion_equal_the_eigenvalue(
    bar: float, mu: float, mu_ref: float
) -> None:
    """The squealing mode over 50 ms: growth within 0.1 1/s, frequency within 0.02 Hz."""
    values, vectors = np.linalg.eig(PLANT.state_matrix(mu, K, bar * 1e5))
    squeal = int(np.argmin(np.abs(values - 2350.0j * 2.0 * np.pi)))
    left = np.linalg.inv(vectors)[squeal]
    integrator = SquealIntegrator(PLANT, mu_ref=mu_ref, outputs=())
    shape = vectors[:, squeal] / np.abs(vectors[PLANT.n_dof :, squeal]).max()
    integrator.state = shape.real * 1e-8
    integrator.advance(400, **at(PLANT, bar, mu))
    before = left @ integrator.state
    integrator.advance(2000, **at(PLANT, bar, mu))
    after = left @ integrator.state
    time = 2000 / RATE
    rate = values[squeal] + np.log(after / before / np.exp(values[squeal] * time)) / time
    assert rate.real == pytest.approx(values[squeal].real, abs=0.1)
    assert rate.imag / (2 * np.pi) == pytest.approx(values[squeal].imag / (2 * np.pi), abs=0.02)


def test_squeal_above_the_onset_only() -> None:
    levels = []
    for bar in (11.0, 13.0):
        integrator = SquealIntegrator(PLANT, outputs=["inner_pad.x:velocity"])
        integrator.state = kicked(PLANT, 1e-3)
        levels.append(integrator.advance(120_000, **at(PLANT, bar), saturation_m_s=0.01)[-2000:].std())
    assert levels[0] < 1e-9
    assert levels[1] > 1e-3


def test_40_khz_keeps_squeal_frequency_and_level() -> None:
    start = limit_cycle(PLANT, 20.0, 0.4, 0.01)
    found = []
    for substeps in (1, 8):
        integrator = SquealIntegrator(PLANT, substeps=substeps, outputs=["inner_pad:slip"])
        integrator.state = start
        found.append(
            frequency_and_level(
                integrator.advance(10_000, **at(PLANT, 20.0), saturation_m_s=0.01)[:, 0], RATE
            )
        )
    assert found[0][0] == pytest.approx(found[1][0], abs=0.02)
    assert found[0][1] == pytest.approx(found[1][1], abs=0.01)


def test_changed_stiffness_moves_the_squeal_as_the_eigenvalue() -> None:
    shifts = []
    changed = PLANT.with_parameters(c_fin_t=1.2 * PLANT.spec.parameters["c_fin_t"].value)
    for brake in (PLANT, changed):
        values = np.linalg.eigvals(brake.state_matrix(0.4, K, 20e5))
        expected = values[int(np.argmax(values.real))].imag / (2 * np.pi)
        integrator = SquealIntegrator(brake, outputs=["inner_pad:slip"])
        integrator.state = kicked(brake, 0.01)
        integrator.advance(60_000, **at(brake, 20.0), saturation_m_s=0.005)
        squeal, _ = frequency_and_level(
            integrator.advance(10_000, **at(brake, 20.0), saturation_m_s=0.005)[:, 0], RATE
        )
        shifts.append((expected, squeal))
    (expected_before, before), (expected_after, after) = shifts
    assert abs(abs(expected_after) - abs(expected_before)) > 10.0
    assert after - before == pytest.approx(abs(expected_after) - abs(expected_before), abs=1.0)


def test_roughness_excitation_is_exact() -> None:
    """Random force held over each interval, no friction deviation: equals the matrix exponential."""
    rng = np.random.default_rng(5)
    push = rng.normal(size=(300, 2))
    integrator = SquealIntegrator(PLANT, mu_ref=0.4, outputs=["disc.y:velocity", "inner_pad.phi"])
    assert integrator.pads == ("inner_pad", "outer_pad")
    actual = integrator.advance(300, **at(PLANT, 10.0, 0.4, 0.0), excitation_n=push)
    n = PLANT.n_dof
    matrix = PLANT.state_matrix(0.4, 0.0, 0.0)
    inputs = np.zeros((2 * n, 2))
    inputs[n:, 0] = PLANT.contacts[0].row_x / PLANT.inertia
    inputs[n:, 1] = PLANT.contacts[2].row_x / PLANT.inertia
    whole = expm(np.block([[matrix, inputs], [np.zeros((2, 2 * n + 2))]]) / RATE)
    state, expected = np.zeros(2 * n), []
    disc, pad = PLANT.freedom_index("disc.y"), PLANT.freedom_index("inner_pad.phi")
    for force in push:
        expected.append([state[n + disc], (matrix @ state + inputs @ force)[n + pad]])
        state = whole[: 2 * n, : 2 * n] @ state + whole[: 2 * n, 2 * n :] @ force
    np.testing.assert_allclose(actual, expected, rtol=1e-7, atol=1e-7 * np.abs(expected).max(axis=0).min())


@pytest.mark.parametrize("substeps", [1, 2])
@pytest.mark.parametrize("slip", [SLIP, 0.02])
def test_blocks_of_steps_equal_single_steps(slip: float, substeps: int) -> None:
    """Two compiled versions of the same recursion; at 0.02 m/s with reversals of slip."""
    names = ["disc.y", "inner_pad:friction", "outer_pad:normal", "piston_l:force_y"]
    fast, plain = (SquealIntegrator(PLANT, outputs=names, substeps=substeps) for _ in range(2))
    assert fast._blocks is not None
    plain._blocks = None
    push = np.random.default_rng(2).normal(size=(800, 2))
    results = []
    for integrator in (fast, plain):
        integrator.state = kicked(PLANT, 0.05)
        results.append(
            integrator.advance(800, **at(PLANT, 25.0, slip=slip), saturation_m_s=0.1, excitation_n=push)
        )
    np.testing.assert_allclose(results[0], results[1], rtol=1e-6, atol=1e-6 * np.abs(results[1]).max())


def belt_oscillator() -> Brake:
    """A mass on a belt (section 1.1 of the paper), as the smallest brake file."""
    own = {"unit": "1", "origin": "test"}
    parameters = {
        "m": {"value": 0.5, "unit": "kg", "origin": "test"},
        "c": {"value": 0.5 * (2 * np.pi * 300.0) ** 2, "unit": "N/m", "origin": "test"},
        "d": {"value": 2.0, "unit": "N s/m", "origin": "test"},
        "c_n": {"value": 1e8, "unit": "N/m", "origin": "test"},
    }
    points = [{"body": b, "name": n, "x": "0", "y": "0"} for b in ("mass", "belt") for n in ("rub", "spring")]
    return Brake(
        BrakeSpec.model_validate(
            {
                "name": "belt",
                "description": "one degree of freedom",
                "operating": {
                    "mu": {**own, "value": 0.4},
                    "slope": {"value": 0.1, "unit": "s/m", "origin": "test"},
                    "piston_area": {"value": 1e-3, "unit": "m2", "origin": "test"},
                    "effective_radius": {"value": 0.1, "unit": "m", "origin": "test"},
                },
                "parameters": parameters,
                "bodies": [{"name": "mass", "freedoms": ["x"], "mass": "m"}, {"name": "belt"}],
                "points": points,
                "couplings": [
                    {
                        "kind": "contact",
                        "name": "rub",
                        "between": ["mass.rub", "belt.rub"],
                        "side": 1,
                        "load_share": 1.0,
                        "stiffness": "c_n",
                    },
                    {
                        "kind": "spring",
                        "name": "spring",
                        "between": ["mass.spring", "belt.spring"],
                        "stiffness_x": "c",
                        "damping_x": "d",
                    },
                ],
            }
        )
    )


def stick_slip_reference(
    brake: Brake, n: float, mu: float, k: float, v0: float, times: np.ndarray
) -> np.ndarray:
    """Displacement from the mean, phase by phase: slip until the mass has the belt's speed, stick until it
    tears off."""
    m, c, d = (brake.spec.parameters[key].value for key in "mcd")
    holding = k * v0 * n  # what mu(0) holds beyond the mean friction force
    tear_off = (holding - d * v0) / c
    events = [lambda t, y: v0 - y[1]]
    events[0].terminal, events[0].direction = True, -1  # type: ignore[attr-defined]
    time, state, out = 0.0, np.array([tear_off, v0 * (1 - 1e-9)]), np.zeros(len(times))
    while time < times[-1]:
        solution = solve_ivp(
            lambda t, y: [y[1], (-c * y[0] - d * y[1] + k * n * y[1]) / m],
            (time, times[-1] + 1e-9),
            state,
            events=events,
            rtol=1e-10,
            atol=1e-14,
            dense_output=True,
        )
        inside = (times >= time) & (times <= solution.t[-1])
        out[inside] = solution.sol(times[inside])[0]
        time = solution.t[-1]
        if not solution.t_events[0].size:
            break
        x = solution.y[0, -1]
        until = time + (tear_off - x) / v0
        inside = (times >= time) & (times <= until)
        out[inside] = x + v0 * (times[inside] - time)
        time, state = until, np.array([tear_off, v0 * (1 - 1e-9)])
    return out


def test_stick_slip_of_the_belt_oscillator() -> None:
    """Set-valued friction: the stick-slip cycle of the 1-DOF oscillator under eq 28 against its exact
    phases."""
    brake = belt_oscillator()
    n, mu, k, v0 = 1000.0, 0.4, 0.1, 0.3
    times = np.arange(2000) / RATE
    expected = stick_slip_reference(brake, n, mu, k, v0, times)
    integrator = SquealIntegrator(brake, outputs=["mass.x:displacement", "mass.x:velocity"])
    assert integrator._blocks is None
    integrator.state = np.array([expected[0], v0 * (1 - 1e-9)])
    actual = integrator.advance(
        2000, normal_force_n=(n, n), mu=(mu, mu), slip_m_s=(v0, v0), k_s_m=(k, k), saturation_m_s=None
    )
    sticking = np.abs(actual[:, 1] - v0) < 1e-9
    assert 0.05 < sticking.mean() < 0.5  # it sticks, and it slides
    assert actual[:, 1].max() < v0 * (1 + 1e-6)  # and never overtakes the belt
    # 50 ms, 14 cycles: displacement within 1 % of the amplitude
    assert np.abs(actual[:, 0] - expected).max() < 0.01 * np.abs(expected).max()


def test_slip_reversal_converges() -> None:
    """The whole brake at a sliding speed that squeal reverses: finer steps change little, and the order is
    kept."""
    runs = {}
    for substeps in (1, 2, 8):
        integrator = SquealIntegrator(PLANT, substeps=substeps, outputs=["inner_pad:slip"], fine_steps=8)
        integrator.state = kicked(PLANT, 0.02)
        signal = integrator.advance(30_000, **at(PLANT, 20.0, slip=0.02))[
            -8000:, 0
        ]  # linear law: limited by reversal only
        runs[substeps] = frequency_and_level(signal, RATE)
        assert np.abs(signal).max() > 0.0199
    for substeps in (1, 2):
        assert runs[substeps][0] == pytest.approx(runs[8][0], abs=0.5)
        assert runs[substeps][1] == pytest.approx(runs[8][1], abs=0.1)

"""Many brakings at once: the same numbers as single runs, lane by lane, whatever runs beside them."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.time_domain.batch import BatchIntegrator
from sim_hardware.brake_model.time_domain.batch_serial import SerialBatch, batch_of
from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator

PLANT = load_brake(Path(__file__).parents[3] / "configs" / "brakes" / "plant.toml")
N = 2 * PLANT.n_dof
NAMES = ["disc.y", "inner_pad:slip", "outer_pad:friction"]
FORCE = PLANT.pad_force_n(20e5)
SQUEALING: dict[str, Any] = {
    "normal_force_n": FORCE, "mu": 0.4, "slip_m_s": 0.44, "k_s_m": 0.0576, "saturation_m_s": 0.01,
}  # fmt: skip
#: slip reverses in every cycle, with sticking
REVERSING: dict[str, Any] = SQUEALING | {"slip_m_s": 0.02, "saturation_m_s": None}


def starts(lanes: int, size_m_s: float = 1e-3) -> np.ndarray:
    """Random motions, one per lane."""
    states = size_m_s * np.random.default_rng(3).normal(size=(lanes, N))
    states[:, : N // 2] *= 1e-4
    return states


def of_lane(value: Any, lane: int) -> Any:
    """Working point of one lane as `SquealIntegrator` takes it."""
    pair = value if isinstance(value, tuple) else (value, value)
    return tuple(float(np.broadcast_to(v, lane + 1)[lane] if np.ndim(v) == 0 else v[lane]) for v in pair)


def singly(
    lane: int,
    state: np.ndarray,
    n: int,
    point: dict[str, Any],
    push: np.ndarray | None = None,
    brake: Brake = PLANT,
    **settings: Any,
) -> tuple[np.ndarray, np.ndarray]:
    """The same braking by `SquealIntegrator`: outputs, last state."""
    integrator = SquealIntegrator(brake, outputs=NAMES, **settings)
    integrator.state = state
    saturation: Any = point.get("saturation_m_s")
    if np.ndim(saturation):
        saturation = None if np.isinf(saturation[lane]) else float(saturation[lane])
    values = {name: of_lane(value, lane) for name, value in point.items() if name != "saturation_m_s"}
    y = integrator.advance(n, **values, saturation_m_s=saturation, excitation_n=push)
    return y, integrator.state


def check_lanes(
    lanes: int, n: int, point: dict[str, Any], push: np.ndarray | None = None, **settings: Any
) -> np.ndarray:
    """Compare all lanes with single runs; returns the outputs."""
    states = starts(lanes)
    batch = BatchIntegrator(PLANT, lanes, outputs=NAMES, **settings)
    batch.states = states
    outputs = batch.advance(n, **point, excitation_n=push)
    assert outputs.shape == (n, lanes, len(NAMES))
    for lane in range(lanes):
        own = push if push is None or push.ndim == 2 else push[:, lane]
        expected, state = singly(lane, states[lane], n, point, own, **settings)
        size = np.abs(expected).max(axis=0)
        np.testing.assert_allclose(outputs[:, lane], expected, rtol=0.0, atol=1e-9 * size.max(initial=1e-300))
        np.testing.assert_allclose(batch.states[lane], state, rtol=0.0, atol=1e-9 * np.abs(state).max())
    return outputs


@pytest.mark.parametrize("lanes", [1, 7, 8, 67])
def test_lanes_equal_single_runs_whatever_their_number(lanes: int) -> None:
    check_lanes(lanes, 161, SQUEALING)


def test_stable_and_unstable_lanes_with_their_own_working_points() -> None:
    lanes = 11
    spread = np.linspace(0.0, 1.0, lanes)
    point = {
        "normal_force_n": (FORCE * spread, FORCE * (0.5 + spread)),
        "mu": (0.35 + 0.2 * spread, 0.4 + 0.0 * spread),
        "slip_m_s": (0.44, 0.3 + 0.1 * spread),
        "k_s_m": 0.08 * spread,
        "saturation_m_s": np.where(np.arange(lanes) % 2, 0.01, np.inf),
    }
    outputs = check_lanes(lanes, 1201, point)
    growth = np.abs(outputs[-200:, :, 1]).max(axis=0) / np.abs(outputs[400:600, :, 1]).max(axis=0)
    assert growth.min() < 0.7 and growth.max() > 1.2, growth  # the mixture is one


def test_lanes_whose_slip_reverses_among_lanes_that_slide() -> None:
    slow = np.array([0.02, 0.44, 0.44, 0.015, 0.44, 0.03, 0.44, 0.44, 0.02, 0.44])
    reversing = slow < 0.1
    saturation = np.where(reversing, np.inf, 0.01)
    outputs = check_lanes(10, 1500, SQUEALING | {"slip_m_s": slow, "saturation_m_s": saturation})
    sliding = (slow - outputs[:, :, 1])[500:]
    stuck = (np.abs(sliding) < 1e-9).mean(axis=0)
    assert (stuck[reversing] > 0.005).all() and not stuck[~reversing].any(), stuck


@pytest.mark.parametrize("point", [SQUEALING, SQUEALING | {"slip_m_s": 0.02}], ids=["sliding", "reversing"])
def test_excitation_of_all_lanes_and_of_each(point: dict[str, Any]) -> None:
    noise = np.random.default_rng(1).normal(size=(400, 5, 2))
    check_lanes(5, 400, point, noise)
    check_lanes(5, 400, point, noise[:, 0])


def test_substeps_and_a_lift_off_of_the_pads() -> None:
    check_lanes(3, 300, SQUEALING, substeps=2)
    check_lanes(3, 300, SQUEALING | {"normal_force_n": np.array([0.0, 2.0, 30.0])})


def test_a_brake_per_lane() -> None:
    brakes = [PLANT.with_parameters(m_disc=mass) for mass in (4.8, 5.0, 5.3)]
    states = starts(3)
    for point in (SQUEALING, REVERSING):
        batch = BatchIntegrator(brakes, outputs=NAMES)
        batch.states = states
        outputs = batch.advance(500, **point)
        for lane, brake in enumerate(brakes):
            expected, state = singly(lane, states[lane], 500, point, brake=brake)
            np.testing.assert_allclose(
                outputs[:, lane], expected, rtol=0.0, atol=1e-9 * np.abs(expected).max()
            )
            np.testing.assert_allclose(batch.states[lane], state, rtol=0.0, atol=1e-9 * np.abs(state).max())


def test_repeatable_and_independent_of_neighbours() -> None:
    states = starts(9)

    def run(chosen: slice) -> np.ndarray:
        batch = BatchIntegrator(PLANT, len(states[chosen]), outputs=NAMES)
        batch.states = states[chosen]
        return batch.advance(300, **REVERSING)

    whole = run(slice(None))
    np.testing.assert_array_equal(run(slice(None)), whole)
    np.testing.assert_array_equal(
        run(slice(3, 5)), whole[:, 3:5]
    )  # other places in the vector, other neighbours


def test_calls_continue() -> None:
    whole, split = (BatchIntegrator(PLANT, 3, outputs=NAMES) for _ in range(2))
    whole.states = split.states = starts(3)
    expected = whole.advance(301, **REVERSING)
    parts = [split.advance(n, **REVERSING) for n in (1, 100, 0, 200)]
    np.testing.assert_array_equal(np.concatenate(parts), expected)


def test_rest_stays_at_rest_and_states_come_back() -> None:
    batch = BatchIntegrator(PLANT, 3, outputs=NAMES)
    assert not batch.advance(100, **SQUEALING).any() and not batch.states.any()
    states = starts(3)
    batch.states = states
    np.testing.assert_allclose(batch.states, states, atol=1e-12 * np.abs(states).max())
    batch.reset()
    assert not batch.advance(10, **SQUEALING).any()


def test_statistics_are_those_of_the_outputs() -> None:
    lanes, n = 5, 1700  # more than one piece
    point: dict[str, Any] = SQUEALING | {"normal_force_n": (FORCE, 1.2 * FORCE)}
    noise = 0.1 * np.random.default_rng(1).normal(size=(n, 2))
    whole, observed = (BatchIntegrator(PLANT, lanes, outputs=NAMES) for _ in range(2))
    whole.states = observed.states = starts(lanes, 1e-2)
    y = whole.advance(n, **point, excitation_n=noise)
    found = observed.observe(n, **point, excitation_n=noise)
    np.testing.assert_allclose(found.mean, y.mean(axis=0), atol=1e-9 * np.abs(y).max())
    np.testing.assert_allclose(found.rms, y.std(axis=0), rtol=1e-7)
    np.testing.assert_allclose(found.minimum, y.min(axis=0), rtol=1e-7)
    np.testing.assert_allclose(found.maximum, y.max(axis=0), rtol=1e-7)
    np.testing.assert_array_equal(found.crossings, ((y[:-1] <= 0.0) & (y[1:] > 0.0)).sum(axis=0))
    np.testing.assert_allclose(observed.states, whole.states, atol=1e-9 * np.abs(whole.states).max())


def test_frequency_by_zero_crossings_is_that_of_the_spectrum() -> None:
    batch = BatchIntegrator(PLANT, 1, outputs=["inner_pad.x:velocity"])
    batch.states = np.concatenate([np.zeros(14), np.full(14, 1e-3)])
    batch.observe(40_000, **SQUEALING)
    found = batch.observe(8000, **SQUEALING)
    y = batch.advance(8000, **SQUEALING)[:, 0, 0]
    spectrum = np.abs(np.fft.rfft(y * np.hanning(len(y)), 1 << 18))
    assert found.frequency_hz[0, 0] == pytest.approx(spectrum.argmax() * 40_000 / (1 << 18), abs=0.3)
    assert found.rms[0, 0] == pytest.approx(y.std(), rel=1e-3)


def test_a_lane_that_is_lost_does_not_take_the_others_with_it() -> None:
    batch = BatchIntegrator(PLANT, 3, outputs=NAMES)
    states = starts(3)
    states[1] *= 1e200  # overflows in its sums
    batch.states = states
    y = batch.advance(200, **SQUEALING)
    assert batch.lost.tolist() == [False, True, False]
    assert np.isnan(y[:, 1]).all() and np.isfinite(y[:, [0, 2]]).all() and np.isnan(batch.states[1]).all()
    np.testing.assert_allclose(
        y[:, 2], singly(2, states[2], 200, SQUEALING)[0], atol=1e-9 * np.abs(y[:, 2]).max()
    )
    assert np.isnan(batch.observe(10, **SQUEALING).rms[1]).all()
    batch.reset()
    assert not batch.lost.any() and not batch.advance(10, **SQUEALING).any()


def test_wrong_input_is_refused() -> None:
    with pytest.raises(ValueError, match="lanes"):
        BatchIntegrator(PLANT)
    with pytest.raises(ValueError, match="one each"):
        BatchIntegrator([PLANT, PLANT], 3)
    with pytest.raises(ValueError, match="weights"):
        BatchIntegrator(PLANT, 2, outputs=NAMES, weights=[1.0])
    with pytest.raises(KeyError, match=r"disc\.z"):
        BatchIntegrator(PLANT, 2, outputs=["disc.z"])
    batch = BatchIntegrator(PLANT, 3, outputs=NAMES)
    wrongs: list[dict[str, Any]] = [
        {"mu": np.zeros(2)}, {"slip_m_s": -0.1}, {"k_s_m": np.nan}, {"saturation_m_s": 0.0},
        {"excitation_n": np.zeros((5, 2))}, {"normal_force_n": (1.0, 2.0, 3.0)},
    ]  # fmt: skip
    for wrong in wrongs:
        with pytest.raises(ValueError, match=next(iter(wrong))):
            batch.advance(10, **(SQUEALING | wrong))
    with pytest.raises(ValueError, match="states"):
        batch.states = np.zeros((2, N))


def three_groups() -> Brake:
    """The plant with a contact at another height: its pad then slides along two lines."""
    spec = PLANT.spec
    contact = next(c for c in spec.couplings if c.kind == "contact")
    moved = contact.model_copy(
        update={"between": (contact.between[0].split(".")[0] + ".piston_l", contact.between[1])}
    )
    couplings = tuple(moved if c is contact else c for c in spec.couplings)
    return Brake(spec.model_copy(update={"couplings": couplings}))


def test_brakes_that_do_not_fit_are_refused_with_the_remedy_and_run_one_by_one() -> None:
    brake = three_groups()
    with pytest.raises(ValueError, match=r"3 friction groups.*batch_of"):
        BatchIntegrator(brake, 2)
    with pytest.raises(ValueError, match="differ"):
        BatchIntegrator([PLANT, Brake(PLANT.spec.model_copy(update={"couplings": brake.spec.couplings}))])
    sums = np.eye(len(NAMES))
    assert isinstance(batch_of(PLANT, 2, outputs=NAMES, weights=sums), BatchIntegrator)
    batch = batch_of(brake, 3, outputs=NAMES, weights=sums)
    states = starts(3)
    batch.states = states
    y = batch.advance(100, **SQUEALING)
    for lane in range(3):
        expected, state = singly(lane, states[lane], 100, SQUEALING, brake=brake)
        np.testing.assert_array_equal(y[:, lane], expected)
        np.testing.assert_array_equal(batch.states[lane], state)
    rest = batch.observe(200, **SQUEALING, columns=1)
    assert rest.rms.shape == (3, 1) and (rest.rms > 0.0).all()


def test_serial_lanes_are_those_of_the_batch() -> None:
    sums = np.eye(len(NAMES))
    batches = [made(PLANT, 3, outputs=NAMES, weights=sums) for made in (BatchIntegrator, SerialBatch)]
    found = []
    for batch in batches:
        states = starts(3)
        states[1] *= 1e200
        batch.states = states
        found.append(batch.observe(200, **SQUEALING))
        assert batch.lost.tolist() == [False, True, False]
    np.testing.assert_allclose(found[1].rms, found[0].rms, rtol=1e-9)
    np.testing.assert_allclose(found[1].frequency_hz, found[0].frequency_hz, rtol=1e-9)


def test_several_sums_of_outputs_and_the_first_columns_only() -> None:
    sums = np.array([[0.5, 20.0, -1e-3], [0.0, 1.0, 0.0]])
    every, summed, first = (
        BatchIntegrator(PLANT, 3, outputs=NAMES),
        BatchIntegrator(PLANT, 3, outputs=NAMES, weights=sums),
        BatchIntegrator(PLANT, 3, outputs=NAMES),
    )
    for batch in (every, summed, first):
        batch.states = starts(3)
    y = every.advance(200, **SQUEALING)
    np.testing.assert_allclose(
        summed.advance(200, **SQUEALING), y @ sums.T, rtol=0.0, atol=1e-12 * np.abs(y).max()
    )
    np.testing.assert_array_equal(first.advance(200, **SQUEALING, columns=2), y[:, :, :2])
    assert first.observe(10, **SQUEALING, columns=1).rms.shape == (3, 1)
    with pytest.raises(ValueError, match="columns"):
        first.advance(10, **SQUEALING, columns=4)

"""The integrator as an object: continuation, repeatability, refusals, outputs, degenerate working points."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator, compile_kernels

PLANT = load_brake(Path(__file__).parents[3] / "configs" / "brakes" / "plant.toml")
POINT: dict[str, Any] = {
    "normal_force_n": (4000.0, 4500.0),
    "mu": (0.4, 0.42),
    "slip_m_s": (0.44, 0.43),
    "k_s_m": (0.0576, 0.0576),
    "saturation_m_s": 0.01,
}
STEADY: dict[str, Any] = {
    "normal_force_n": (4500.0, 4500.0),
    "mu": (0.4, 0.4),
    "slip_m_s": (0.44, 0.44),
    "k_s_m": (0.0576, 0.0576),
    "saturation_m_s": 0.01,
}
OUTPUTS = ["disc.y", "inner_pad.x:velocity", "inner_pad:friction"]


def noise(n: int, seed: int = 1) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(n, 2))


def test_compile_before_motion() -> None:
    compile_kernels(PLANT)


def test_rest_stays_at_rest() -> None:
    """The steadily sliding state is an exact solution, whatever the working point does."""
    integrator = SquealIntegrator(PLANT, outputs=OUTPUTS)
    assert not integrator.advance(2000, **POINT).any()
    assert not integrator.state.any()


def test_same_input_gives_the_same_bits_and_calls_can_be_split() -> None:
    push = noise(600)
    whole, split, again = (SquealIntegrator(PLANT, outputs=OUTPUTS) for _ in range(3))
    expected = whole.advance(600, **STEADY, excitation_n=push)
    np.testing.assert_array_equal(again.advance(600, **STEADY, excitation_n=push), expected)
    parts = [split.advance(n, **STEADY, excitation_n=push[s : s + n]) for s, n in ((0, 200), (200, 400))]
    np.testing.assert_array_equal(np.concatenate(parts), expected)  # whole blocks of 8 steps: the same bits
    split.reset()
    parts = [
        split.advance(n, **STEADY, excitation_n=push[s : s + n]) for s, n in ((0, 1), (1, 196), (197, 403))
    ]
    np.testing.assert_allclose(
        np.concatenate(parts), expected, rtol=0.0, atol=1e-10 * np.abs(expected).max(axis=0).min()
    )
    assert expected[1:].any(axis=0).all()
    different = SquealIntegrator(PLANT, outputs=OUTPUTS).advance(600, **STEADY, excitation_n=noise(600, 2))
    assert (different != expected).any()


def test_weighted_sum_is_the_sum_of_the_outputs() -> None:
    push, weights = noise(300), [0.5, 20.0, -1e-3]
    single, summed = (
        SquealIntegrator(PLANT, outputs=OUTPUTS),
        SquealIntegrator(PLANT, outputs=OUTPUTS, weights=weights),
    )
    expected = single.advance(300, **POINT, excitation_n=push) @ np.array(weights)
    result = summed.advance(300, **POINT, excitation_n=push)
    assert result.shape == (300, 1)
    np.testing.assert_allclose(result[:, 0], expected, rtol=0.0, atol=1e-12 * np.abs(expected).max())
    with pytest.raises(ValueError, match="weights"):
        SquealIntegrator(PLANT, outputs=OUTPUTS, weights=[1.0])


def test_excitation_ends_with_the_call() -> None:
    """A call without excitation after one with it: the same as excitation of zero."""
    pushed, zero = SquealIntegrator(PLANT, outputs=OUTPUTS), SquealIntegrator(PLANT, outputs=OUTPUTS)
    for integrator in (pushed, zero):
        integrator.advance(80, **STEADY, excitation_n=noise(80))
    np.testing.assert_array_equal(
        pushed.advance(80, **STEADY), zero.advance(80, **STEADY, excitation_n=np.zeros((80, 2)))
    )


def test_memory_continues_bit_for_bit_and_reset_forgets() -> None:
    integrator, other = SquealIntegrator(PLANT, outputs=OUTPUTS), SquealIntegrator(PLANT, outputs=OUTPUTS)
    integrator.advance(300, **POINT, excitation_n=noise(300))
    other.restore(integrator.memory())
    np.testing.assert_array_equal(other.advance(300, **STEADY), integrator.advance(300, **STEADY))
    integrator.reset()
    assert not integrator.advance(10, **STEADY).any()


def test_state_round_trip() -> None:
    integrator = SquealIntegrator(PLANT, outputs=OUTPUTS)
    state = 1e-6 * np.random.default_rng(4).normal(size=28)
    integrator.state = state
    np.testing.assert_allclose(integrator.state, state, atol=1e-14)
    first = integrator.advance(1, **STEADY)
    assert first[0, 1] == pytest.approx(state[14 + PLANT.freedom_index("inner_pad.x")], rel=1e-9)
    # a run continued from its state alone (no friction history) agrees closely
    integrator.advance(999, **STEADY)
    other = SquealIntegrator(PLANT, outputs=OUTPUTS)
    other.state = integrator.state
    a, b = integrator.advance(200, **STEADY), other.advance(200, **STEADY)
    assert np.abs(a - b).max(axis=0) == pytest.approx(0.0, abs=1e-3 * np.abs(a).max())


def test_outputs_agree_with_each_other() -> None:
    """Newton's law for a pad: its acceleration times mass is the sum of the recorded forces."""
    names = ["inner_pad.x", "inner_pad:friction", "piston_l:force_x", "piston_t:force_x"]
    names += ["abutment_il:force_x", "abutment_it:force_x"]
    integrator = SquealIntegrator(PLANT, outputs=names)
    integrator.state = 1e-6 * np.random.default_rng(4).normal(size=28)
    y = integrator.advance(400, **STEADY)
    # pistons: the pad is the second body (+F); abutments: it is the first (-F)
    force = y[:, 1] + y[:, 2] + y[:, 3] - y[:, 4] - y[:, 5]
    mass = PLANT.spec.parameters["m_padi"].value
    np.testing.assert_allclose(mass * y[:, 0], force, rtol=1e-6, atol=1e-8 * np.abs(force).max())


@pytest.mark.parametrize(
    "change",
    [{"normal_force_n": (0.0, 0.0)}, {"slip_m_s": (0.0, 0.0)}, {"slip_m_s": (0.02, 0.0)}, {"mu": (0.0, 0.0)}],
)
def test_degenerate_working_points_stay_finite(change: dict[str, tuple[float, float]]) -> None:
    integrator = SquealIntegrator(PLANT, outputs=OUTPUTS)
    y = integrator.advance(400, **(STEADY | change), excitation_n=noise(400))
    assert np.isfinite(y).all()
    assert np.abs(y[:, 1]).max() < 0.05


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"normal_force_n": (-1.0, 0.0)}, "pad force"),
        ({"slip_m_s": (-0.1, 0.1)}, "slip"),
        ({"mu": (float("nan"), 0.4)}, "finite"),
        ({"saturation_m_s": 0.0}, "saturation_m_s"),
        ({"excitation_n": np.zeros((3, 2))}, "shape"),
    ],
)
def test_nonsense_is_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        SquealIntegrator(PLANT, outputs=OUTPUTS).advance(10, **(STEADY | change))


def test_bad_settings_are_refused() -> None:
    with pytest.raises(KeyError, match=r"disc\.z"):
        SquealIntegrator(PLANT, outputs=["disc.z"])
    with pytest.raises(KeyError, match="contact_il"):
        SquealIntegrator(PLANT, outputs=["contact_il:force_x"])
    with pytest.raises(ValueError, match="substeps"):
        SquealIntegrator(PLANT, substeps=0)
    with pytest.raises(ValueError, match="output_hz"):
        SquealIntegrator(PLANT, output_hz=0.0)
    with pytest.raises(ValueError, match="28 finite"):
        SquealIntegrator(PLANT).state = np.zeros(3)


def test_runaway_is_reported() -> None:
    """The linear law at a sliding speed that no motion reverses: nothing limits the growth."""
    integrator = SquealIntegrator(PLANT, outputs=())
    integrator.state = np.full(28, 1e-6)
    with pytest.raises(FloatingPointError, match="not finite"):
        for _ in range(100):
            integrator.advance(
                40_000, **(STEADY | {"slip_m_s": (1e300, 1e300), "saturation_m_s": None, "k_s_m": (0.5, 0.5)})
            )

"""Published numbers of the brakes, and facts that hold for any parameters (`brake-identification`)."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.spec import BrakeSpec
from sim_hardware.brake_model.stability import eigen_pairs, onset_mu, onset_pressure, predict

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
MODEL = load_brake(BRAKES / "model.toml")

PRINTED_HZ_PERCENT = [
    (688.4, 0.69), (914.7, 0.73), (1078.8, 0.65), (1359.8, 1.01), (2140.0, 1.11),
    (2278.6, 0.75), (2564.4, 1.08), (2935.8, 1.26), (3244.7, 1.37), (4048.6, 1.33),
    (6459.0, 3.82), (7177.2, 3.90), (7673.0, 3.64), (8048.4, 3.88),
]  # fmt: skip

scatter = st.lists(st.floats(0.8, 1.25), min_size=60, max_size=60)


def scattered(brake: Brake, factors: list[float]) -> Brake:
    """The brake with every parameter multiplied by its own factor."""
    names = sorted(brake.spec.parameters)
    return brake.with_parameters(
        **{n: brake.spec.parameters[n].value * factors[i % len(factors)] for i, n in enumerate(names)}
    )


def test_model_squeals_from_15_bar_at_2140_hz() -> None:
    prediction = predict(MODEL, slope_s_m=0.0576, pressure_max_bar=25.0)
    assert prediction.onset_pressure_bar == pytest.approx(15.0, abs=0.2)
    assert prediction.onset_frequency_hz == pytest.approx(2140.0, abs=5.0)
    assert len(prediction.pairs) == len(prediction.pairs_at_max) == 14
    unstable = [pair.frequency_hz for pair in prediction.pairs_at_max if pair.unstable]
    assert unstable == [pytest.approx(2140.0, abs=5.0)]


def test_model_pairs_as_identified() -> None:
    pairs = eigen_pairs(MODEL, mu=0.4, pressure_bar=0.0)
    assert [
        (round(p.frequency_hz, 1), round(100.0 * p.damping_ratio, 2)) for p in pairs
    ] == PRINTED_HZ_PERCENT


def test_friction_alone_does_not_destabilise_the_model() -> None:
    prediction = predict(MODEL, mu=0.69, slope_s_m=0.0)
    assert prediction.stable
    assert prediction.onset_pressure_bar is None
    assert onset_mu(MODEL, 0.0, mu_max=0.69) is None


def test_plant_squeals_from_12_bar_at_2350_hz() -> None:
    onset = onset_pressure(load_brake(BRAKES / "plant.toml"), 0.4, 0.0576)
    assert onset is not None
    assert onset.value == pytest.approx(12.0, abs=0.05)
    assert onset.frequency_hz == pytest.approx(2350.0, abs=1.0)


def test_basic_brake_mode_coupling_at_mu_064() -> None:
    brake = load_brake(BRAKES / "basic.toml")
    onset = onset_mu(brake)
    assert onset is not None
    assert onset.value == pytest.approx(0.64, abs=0.002)
    assert onset.frequency_hz == pytest.approx(2400.0, abs=1.0)

    def close_pairs(mu: float) -> list[float]:
        return [p.frequency_hz for p in eigen_pairs(brake, mu) if 2340.0 < p.frequency_hz < 2470.0]

    assert close_pairs(0.47) == pytest.approx([2351.8, 2460.5], abs=0.5)
    assert close_pairs(0.69) == pytest.approx([2405.5, 2419.9], abs=0.5)


@settings(max_examples=20, deadline=None)
@given(factors=scatter, mu=st.floats(0.0, 1.0))
def test_sum_of_real_parts_is_the_trace_of_damping(factors: list[float], mu: float) -> None:
    """Sum of all real parts = -1/2 tr(M^-1 D) per pair, whatever K and mu."""
    brake = scattered(MODEL, factors)
    total = np.linalg.eigvals(brake.state_matrix(mu, 0.0, 0.0)).real.sum()
    expected = -np.sum(np.diag(brake.damping_matrix(0.0)) / brake.inertia)
    assert total == pytest.approx(expected, rel=1e-6)


@settings(max_examples=20, deadline=None)
@given(factors=scatter, bar=st.floats(1.0, 40.0), k=st.floats(0.01, 0.2))
def test_falling_friction_raises_the_sum_of_real_parts(factors: list[float], bar: float, k: float) -> None:
    """By sum over contacts of k N w (1/m along the slip), half of it per pair."""
    brake = scattered(MODEL, factors)
    pad_force = brake.pad_force_n(bar * 1e5)
    expected = sum(
        0.5 * k * pad_force * c.load_share * float(np.sum(c.row_x**2 / brake.inertia)) for c in brake.contacts
    )
    rise = sum(p.real_part_1_s for p in eigen_pairs(brake, 0.4, k, bar)) - sum(
        p.real_part_1_s for p in eigen_pairs(brake, 0.4, 0.0, bar)
    )
    assert rise == pytest.approx(expected, rel=1e-4)
    assert rise > 0.0


def test_onset_pressure_is_inverse_to_slope() -> None:
    one, two = onset_pressure(MODEL, 0.4, 0.0576), onset_pressure(MODEL, 0.4, 2 * 0.0576)
    assert one is not None
    assert two is not None
    assert two.value == pytest.approx(one.value / 2.0, rel=1e-9)


def symmetric(spec: BrakeSpec) -> BrakeSpec:
    """The same brake, mirrored leading to trailing."""
    changes = {}
    for name in spec.parameters:
        for leading, trailing in (("_il", "_it"), ("_ol", "_ot"), ("_l", "_t")):
            twin = name[: -len(leading)] + trailing
            axial = name.startswith(("c_con", "c_abu_y", "c_gui_y"))
            if axial and name.endswith(leading) and twin in spec.parameters:
                changes[twin] = spec.parameters[name].value
    assert changes
    return spec.with_values(changes)


@settings(max_examples=15, deadline=None)
@given(factors=scatter, mu=st.floats(0.1, 2.0))
def test_mirror_symmetry_makes_eigenvalues_independent_of_mu(factors: list[float], mu: float) -> None:
    brake = Brake(symmetric(scattered(MODEL, factors).spec))
    without, with_friction = eigen_pairs(brake, 0.0, 0.0), eigen_pairs(brake, mu, 0.0)
    for a, b in zip(without, with_friction, strict=True):
        assert b.frequency_hz == pytest.approx(a.frequency_hz, rel=1e-6)
        assert b.real_part_1_s == pytest.approx(a.real_part_1_s, rel=1e-3, abs=1e-2)
    # and the asymmetric brake does depend on mu
    uneven, rubbed = eigen_pairs(MODEL, 0.0, 0.0), eigen_pairs(MODEL, mu, 0.0)
    assert max(abs(a.frequency_hz - b.frequency_hz) for a, b in zip(uneven, rubbed, strict=True)) > 1e-3


def test_disc_x_is_inert_without_falling_friction() -> None:
    """Constant friction on the two pads cancels nothing else: a heavier m_disc along x only matters with k >
    0."""
    softer = MODEL.with_parameters(c_disc_x=3.0e8)

    def others(brake: Brake, k: float) -> list[float]:
        own = np.sqrt(brake.spec.parameters["c_disc_x"].value / brake.spec.parameters["m_disc"].value) / (
            2 * np.pi
        )
        pairs = sorted(eigen_pairs(brake, 0.4, k, 15.0), key=lambda p: abs(p.frequency_hz - own))[1:]
        return sorted(p.real_part_1_s for p in pairs)

    np.testing.assert_allclose(others(MODEL, 0.0), others(softer, 0.0), rtol=1e-6)
    assert np.abs(np.array(others(MODEL, 0.0576)) - np.array(others(softer, 0.0576))).max() > 1e-3

"""Torque by lever and weights: the steps, the line against numpy's, and what is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from rigctl.calibration.record import Point
from rigctl.calibration.torque import Lever, Step, TorqueResult, evaluate, steps

LEVER = Lever(length_m=1.0, masses_kg=(20.0, 40.0, 60.0))
FULL_NM = 1200.0


def readings(gain: float = 0.998, offset: float = 0.4, *, lever: Lever = LEVER, play: float = 0.0,
             left: float = 1.0, drift: float = 0.0) -> list[Point]:  # fmt: skip
    """A chain that reads gain · torque + offset, with play between up and down, and other faults."""
    found = []
    for number, step in enumerate(steps(lever)):
        value = gain * step.applied_nm * (left if step.direction < 0 else 1.0) + offset + drift * number
        if step.course == "down":
            value += play * step.direction
        found.append(Point(applied=step.applied_nm, measured=value, scatter=0.1, series=step.series))
    return found


def words(result: TorqueResult) -> str:
    return "; ".join(fault.words for fault in result.faults)


def test_steps_go_up_and_down_on_both_sides():
    found = steps(LEVER)
    assert [step.mass_kg for step in found[:7]] == [0, 20, 40, 60, 40, 20, 0]
    assert [step.course for step in found[:7]] == ["up"] * 4 + ["down"] * 3
    assert len(found) == 14
    assert found[3] == Step(1, 60.0, "up", pytest.approx(60 * 9.80665))
    assert found[10].series == "left up"
    assert found[10].applied_nm == pytest.approx(-588.4, abs=0.1)


def test_own_moment_of_the_lever_counts_without_weights_too():
    lever = Lever(length_m=0.5, masses_kg=(10.0,), own_nm=12.0)
    assert [round(step.applied_nm, 3) for step in steps(lever)[:2]] == [12.0, 61.033]


@given(gain=st.floats(0.96, 1.04), offset=st.floats(-20, 20))
def test_a_linear_chain_is_found_exactly(gain: float, offset: float):
    result = evaluate(readings(gain, offset), FULL_NM)
    assert result.gain == pytest.approx(1.0 / gain, rel=1e-9)
    assert result.gain * (gain * 300.0 + offset) + result.offset == pytest.approx(300.0, abs=1e-6)
    assert max(map(abs, result.residuals_nm)) < 1e-6
    assert result.acceptable, words(result)


def test_against_polyfit_with_noise():
    random = np.random.default_rng(3)
    points = [
        point.model_copy(update={"measured": point.measured + random.normal(0, 0.5)}) for point in readings()
    ]
    slope, intercept = np.polyfit([p.applied for p in points], [p.measured for p in points], 1)
    result = evaluate(points, FULL_NM)
    assert result.gain == pytest.approx(1.0 / slope, rel=1e-12)
    assert result.offset == pytest.approx(-intercept / slope, rel=1e-9)
    assert result.figures["residual_percent"] == pytest.approx(max(map(abs, result.residuals_nm)) / 12.0)
    assert result.acceptable, words(result)


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"play": 8.0}, "hysteresis 0.6"),
        ({"left": 1.02}, "two directions differ by 1.98"),
        ({"drift": 0.6}, "zero does not come back"),
        ({"gain": 0.9}, "more than 5 % off"),
    ],
)
def test_faults_are_named_and_forbid_saving(changes: dict[str, float], expected: str):
    result = evaluate(readings(**changes), FULL_NM)
    assert expected in words(result)
    assert not result.acceptable
    assert all(fault.remedy for fault in result.faults)


def test_one_outlier_shows_in_its_residual():
    points = readings()
    points[2] = points[2].model_copy(update={"measured": points[2].measured + 15.0})
    result = evaluate(points, FULL_NM)
    assert int(np.argmax(np.abs(result.residuals_nm))) == 2
    assert "largest residual" in words(result)


def test_one_direction_is_not_enough_and_a_small_load_is_said():
    assert "only one direction" in words(evaluate(readings()[:7], FULL_NM))
    small = evaluate(readings(lever=Lever(length_m=0.2, masses_kg=(5.0, 10.0))), FULL_NM)
    assert small.acceptable
    assert "only 2 % of full scale" in words(small)


def test_too_little_is_refused():
    with pytest.raises(ValueError, match="three different loads"):
        evaluate(readings()[:2], FULL_NM)
    with pytest.raises(ValueError, match="sign"):
        evaluate(readings(gain=-1.0), FULL_NM)


@pytest.mark.parametrize("masses", [(), (20.0, 10.0), (0.0, 5.0), (5.0, 5.0)])
def test_masses_must_rise(masses: tuple[float, ...]):
    with pytest.raises(ValidationError):
        Lever(length_m=1.0, masses_kg=masses)

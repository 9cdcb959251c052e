"""Codecs of the sources: speed from wrapping positions, NAMUR NE 43, UPP answers, counts."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from drivers.daq.can_sources import SpeedMeter, namur_problem
from drivers.daq.microphone import to_counts
from drivers.daq.pyrometer_upp import ERRORS, JumpJudge, parse_range, parse_temperature
from drivers.daq.source import SlowSettings, checked
from rigctl.core.errors import ConfigError

STEPS, TOTAL, WINDOW = 4096, 1 << 24, 20


def meter(max_speed_rpm=3000.0):
    return SpeedMeter(STEPS, TOTAL, 1000.0, WINDOW, max_speed_rpm)


def positions(speed_rpm, n, start=0):
    return np.floor(start + speed_rpm / 60_000.0 * STEPS * np.arange(n)) % TOTAL


@given(
    speed_rpm=st.floats(-2500.0, 2500.0),
    start=st.integers(0, TOTAL - 1),
    cuts=st.lists(st.integers(1, 199), max_size=5),
)
def test_constant_speed_is_found_whatever_the_position_and_the_batches(speed_rpm, start, cuts):
    own = meter()
    wrapped, numbers = positions(speed_rpm, 200, start), np.arange(200)
    found = [
        own(part, values)
        for part, values in zip(np.split(numbers, sorted(cuts)), np.split(wrapped, sorted(cuts)), strict=True)
    ]
    axis = np.concatenate([x for x, _ in found])
    speeds = np.concatenate([y for _, y in found])
    assert np.array_equal(axis, np.arange(200) - 0.5 * (WINDOW - 1))
    assert np.all(np.isnan(speeds[: WINDOW - 1]))
    assert speeds[WINDOW - 1 :] == pytest.approx(speed_rpm, abs=1.2)  # steps of the position


@given(st.lists(st.integers(30, 150), min_size=1, max_size=8, unique=True))
def test_lost_positions_lose_no_turns(lost):
    keep = np.array([n for n in range(200) if n not in lost])
    _, speeds = meter()(keep, positions(40.0, 200)[keep])
    finite = speeds[np.isfinite(speeds)]
    assert len(speeds) == 200
    assert finite == pytest.approx(40.0, abs=1.5)


def test_a_jump_of_the_position_is_no_speed():
    wrapped = positions(40.0, 200)
    wrapped[100:] = (wrapped[100:] + 1_000_000) % TOTAL
    _, speeds = meter()(np.arange(200), wrapped)
    assert np.all(np.isnan(speeds[100 : 100 + WINDOW - 1]))
    assert speeds[100 + WINDOW :] == pytest.approx(40.0, abs=1.2)
    assert np.nanmax(speeds) < 42.0


def test_a_ramp_is_dated_to_the_windows_middle():
    t_s = np.arange(2000) / 1000.0
    turns = 0.5 * (100.0 / 60.0) * t_s**2  # 100 1/min per s
    axis, speeds = meter()(np.arange(2000), np.floor(turns * STEPS) % TOTAL)
    known = np.isfinite(speeds)
    assert speeds[known] == pytest.approx(100.0 * axis[known] / 1000.0, abs=1.2)


@pytest.mark.parametrize(
    "current_ua, problem",
    [(0, "loop fault"), (3599, "loop fault"), (3600, "out of range"), (3799, "out of range"), (3800, ""),
     (12000, ""), (20500, ""), (20501, "out of range"), (21000, "out of range"), (21001, "loop fault"),
     (25000, "loop fault")],
)  # fmt: skip
def test_limits_of_namur_ne_43(current_ua, problem):
    found = namur_problem(current_ua, 0)
    assert found.startswith(problem) and bool(found) == bool(problem)


@given(st.integers(3800, 20500), st.integers(1, 255))
def test_a_status_of_the_input_makes_a_good_current_bad(current_ua, status):
    assert bool(namur_problem(current_ua, status)) == bool(status & 7)


@given(st.integers(-9999, 99999))
def test_temperatures_of_upp(tenths):
    answer = f"-{-tenths:04d}" if tenths < 0 else f"{tenths:05d}"
    degc, problem = parse_temperature(answer.encode())
    if tenths in ERRORS:
        assert degc is None and problem == ERRORS[tenths]
    else:
        assert degc == tenths / 10.0 and not problem


@given(st.binary(max_size=12))
def test_only_five_characters_of_a_number_are_a_temperature(answer):
    degc, problem = parse_temperature(answer)
    text = answer.decode("latin-1")
    if degc is not None:
        assert len(answer) == 5 and text.isascii() and text.lstrip("-").isdigit()
    else:
        assert problem


@given(st.integers(-1000, 2000), st.integers(1, 3000))
def test_measuring_range_of_upp(low, width):
    text = f"{low & 0xFFFF:04X}{(low + width) & 0xFFFF:04X}"
    assert parse_range(text.encode()) == (low, low + width)


@pytest.mark.parametrize("answer", [b"", b"no", b"00000000", b"0320", b"zzzzzzzz"])
def test_what_is_no_measuring_range_is_refused(answer):
    with pytest.raises(ValueError):
        parse_range(answer)


def test_a_single_jump_is_not_believed_two_are():
    judge = JumpJudge(50.0)
    assert [judge(value) for value in (100.0, 101.0, 901.0, 102.0)] == [100.0, 101.0, None, 102.0]
    assert [judge(value) for value in (300.0, 305.0, 306.0)] == [None, 305.0, 306.0]
    assert judge(None) is None
    assert judge(310.0) == 310.0


@given(st.lists(st.floats(-3.0, 3.0, width=32), max_size=50))
def test_float_samples_clip_and_never_wrap(values):
    samples = np.array(values, np.float32)
    counts = to_counts(samples)
    assert counts.dtype == np.int16
    expected = np.clip(samples.astype(float) * 32768.0, -32768, 32767)
    assert counts.astype(float) == pytest.approx(expected, abs=0.51)


@given(st.lists(st.integers(-32768, 32767), max_size=50))
def test_counts_survive_the_way_through_floats(values):
    counts = np.array(values, np.int16)
    assert np.array_equal(to_counts(counts.astype(np.float32) / 32768.0), counts)
    assert to_counts(counts) is counts


def test_errors_of_settings_name_key_and_value():
    with pytest.raises(ConfigError, match=r"rig\.toml: x\.output_hz: .*greater than or equal") as caught:
        checked(SlowSettings, {"output_hz": 0.0}, "rig.toml: x")
    assert caught.value.value == 0.0
    with pytest.raises(ConfigError, match="Known keys"):
        checked(SlowSettings, {"colour": "red"}, "rig.toml: x")
    with pytest.raises(ValidationError):
        SlowSettings.model_validate({"delay_s": float("nan")})

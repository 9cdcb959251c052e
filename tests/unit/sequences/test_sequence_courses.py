"""Speed profiles and pressure functions: values at known times, and bounds at all times."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import TypeAdapter

from sequences import (
    ConstantPressure,
    PressureFunction,
    RampPressure,
    SinePressure,
    SpeedProfile,
    SpeedSegment,
    StepsPressure,
    TrianglePressure,
)
from sequences.ranges import expand_range

shapes = st.one_of(
    st.builds(ConstantPressure, rise_s=st.floats(0, 5)),
    st.builds(
        RampPressure,
        kind=st.just("ramp"),
        amplitude_bar=st.floats(0, 20),
        direction=st.sampled_from(["rising", "falling"]),
        rise_s=st.floats(0, 5),
    ),
    st.builds(
        SinePressure,
        kind=st.just("sine"),
        amplitude_bar=st.floats(0, 20),
        frequency_hz=st.floats(0.01, 10),
        rise_s=st.floats(0, 5),
    ),
    st.builds(
        TrianglePressure,
        kind=st.just("triangle"),
        amplitude_bar=st.floats(0, 20),
        frequency_hz=st.floats(0.01, 10),
        rise_s=st.floats(0, 5),
    ),
    st.builds(
        StepsPressure,
        kind=st.just("steps"),
        steps_bar=st.lists(st.floats(-20, 20), min_size=1, max_size=6).map(tuple),
        rise_s=st.floats(0, 5),
    ),
)


@given(shapes, st.floats(20, 40), st.floats(0.1, 60), st.floats(-1, 70))
def test_every_function_stays_within_its_extremes(
    shape: PressureFunction, working_point_bar: float, duration_s: float, t_s: float
) -> None:
    pressure_bar = shape.pressure_bar(t_s, working_point_bar, duration_s)
    assert 0.0 <= pressure_bar <= shape.max_bar(working_point_bar) + 1e-9
    if min(t_s, duration_s) >= shape.rise_s:
        assert pressure_bar >= shape.min_bar(working_point_bar) - 1e-9


@given(shapes, st.floats(20, 40), st.floats(5.5, 60), st.floats(0, 60), st.floats(1e-4, 0.1))
def test_no_function_but_steps_changes_faster_than_its_rate(
    shape: PressureFunction, working_point_bar: float, duration_s: float, t_s: float, dt_s: float
) -> None:
    if isinstance(shape, StepsPressure):
        return
    first = shape.pressure_bar(t_s, working_point_bar, duration_s)
    second = shape.pressure_bar(t_s + dt_s, working_point_bar, duration_s)
    assert abs(second - first) <= shape.rate_bar_s(working_point_bar, duration_s) * dt_s + 1e-6


@given(shapes)
def test_pressure_functions_survive_json(shape: PressureFunction) -> None:
    adapter: TypeAdapter[PressureFunction] = TypeAdapter(PressureFunction)
    assert adapter.validate_json(adapter.dump_json(shape)) == shape


def test_ramp_has_the_working_point_as_its_mean() -> None:
    rising = RampPressure(kind="ramp", amplitude_bar=5.0)
    falling = RampPressure(kind="ramp", amplitude_bar=5.0, direction="falling")
    assert [rising.pressure_bar(t, 15.0, 10.0) for t in (0.0, 5.0, 10.0)] == [10.0, 15.0, 20.0]
    assert [falling.pressure_bar(t, 15.0, 10.0) for t in (0.0, 5.0, 10.0)] == [20.0, 15.0, 10.0]


def test_sine_and_triangle_reach_both_extremes_in_one_period() -> None:
    sine = SinePressure(kind="sine", amplitude_bar=4.0, frequency_hz=0.5)
    triangle = TrianglePressure(kind="triangle", amplitude_bar=4.0, frequency_hz=0.5)
    for shape in (sine, triangle):
        values = [shape.pressure_bar(t, 10.0, 10.0) for t in (0.0, 0.5, 1.0, 1.5, 2.0)]
        assert values == pytest.approx([10.0, 14.0, 10.0, 6.0, 10.0])
    assert triangle.pressure_bar(0.25, 10.0, 10.0) == pytest.approx(12.0)


def test_steps_share_the_braking_equally() -> None:
    steps = StepsPressure(kind="steps", steps_bar=(0.0, 5.0, -5.0))
    assert [steps.pressure_bar(t, 10.0, 9.0) for t in (0.0, 2.9, 3.0, 6.0, 9.0)] == [10, 10, 15, 5, 5]


def test_rise_begins_at_zero_and_ends_at_the_function() -> None:
    shape = ConstantPressure(rise_s=2.0)
    assert [shape.pressure_bar(t, 10.0, 10.0) for t in (0.0, 1.0, 2.0, 9.0)] == [0.0, 5.0, 10.0, 10.0]


@st.composite
def profiles(draw: st.DrawFn) -> SpeedProfile:
    corners = draw(st.lists(st.floats(-300, 300), min_size=2, max_size=6))
    segments = tuple(
        SpeedSegment(duration_s=draw(st.floats(0.1, 20)), start_rpm=a, end_rpm=b)
        for a, b in itertools.pairwise(corners)
    )
    return SpeedProfile(segments=segments)


@given(profiles(), st.floats(-1, 130))
def test_speed_stays_between_its_corners(profile: SpeedProfile, t_s: float) -> None:
    assert profile.min_rpm - 1e-9 <= profile.speed_rpm(t_s) <= profile.max_rpm + 1e-9


@given(profiles())
def test_speed_passes_through_every_corner(profile: SpeedProfile) -> None:
    t_s = 0.0
    for segment in profile.segments:
        assert profile.speed_rpm(t_s) == pytest.approx(segment.start_rpm, abs=1e-6)
        t_s += segment.duration_s
    assert profile.speed_rpm(profile.duration_s) == pytest.approx(profile.end_rpm, abs=1e-6)
    assert profile.speed_rpm(profile.duration_s + 1.0) == profile.end_rpm


def test_stop_braking_of_the_paper() -> None:
    stop = SpeedProfile(segments=(SpeedSegment(duration_s=12.0, start_rpm=200.0, end_rpm=0.0),))
    assert [stop.speed_rpm(t) for t in (-1.0, 0.0, 6.0, 12.0, 13.0)] == [200.0, 200.0, 100.0, 0.0, 0.0]
    assert stop.max_slope_rpm_s == pytest.approx(200.0 / 12.0)


def test_short_forms_of_a_profile_mean_the_same() -> None:
    row = {"duration_s": 12.0, "start_rpm": 40.0, "end_rpm": 40.0}
    long = SpeedProfile.model_validate({"segments": [row]})
    assert SpeedProfile.model_validate(row) == SpeedProfile.model_validate([row]) == long
    assert SpeedProfile.constant(40.0, 12.0) == long


@pytest.mark.parametrize(
    ("table", "values"),
    [
        ({"from": 2, "to": 30, "step": 2}, [2.0 * k for k in range(1, 16)]),
        ({"from": 30, "to": 310, "count": 15}, [30.0 + 20.0 * k for k in range(15)]),
        ({"from": 30, "to": 10, "step": 10}, [30.0, 20.0, 10.0]),
        ({"from": 0.1, "to": 0.5, "step": 0.1}, [0.1, 0.2, 0.3, 0.4, 0.5]),
        ({"from": 7, "to": 7, "count": 1}, [7.0]),
    ],
)
def test_ranges(table: dict[str, float], values: list[float]) -> None:
    assert expand_range(table) == values


@given(st.floats(-500, 500), st.floats(-500, 500), st.integers(2, 100))
def test_ranges_keep_both_ends_and_even_steps(start: float, stop: float, count: int) -> None:
    if start == stop:
        return
    values = expand_range({"from": start, "to": stop, "count": count})
    assert len(values) == count
    assert (values[0], values[-1]) == (start, stop)
    step = (stop - start) / (count - 1)
    assert all(b - a == pytest.approx(step, abs=1e-8) for a, b in itertools.pairwise(values))

"""Calm ranges, clock times, set-point courses, limits from the files of a session."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigctl.gui.live.data import StepSeries
from rigctl.gui.live.limits import limit_bands, read_session
from rigctl.gui.live.ranges import CalmRange, clock_text, nice_step, nice_time_step, number_decimals
from rigctl.safety.limits import load_limits

FINITE = st.floats(-1e4, 1e4)


@given(st.lists(st.tuples(FINITE, FINITE), min_size=1, max_size=20), st.booleans(), st.booleans())
def test_range_always_holds_the_data(pairs, symmetric, zero):
    calm = CalmRange(2.0, symmetric=symmetric, zero=zero)
    for now_s, pair in enumerate(pairs):
        low, high = sorted(pair)
        bottom, top = calm.follow(low, high, float(now_s))
        slack = 0.06 * max(abs(low), abs(high), 2.0) if zero else 1e-6 * max(abs(low), abs(high), 1.0)
        assert bottom <= low + slack and high - slack <= top
        assert top - bottom >= 2.0 - 1e-9
        if symmetric:
            assert bottom == -top


def test_range_does_not_twitch_and_shrinks_late():
    calm = CalmRange(1.0, zero=True)
    first = calm.follow(0.0, 9.3, 0.0)
    assert first == (0.0, 10.0)
    assert calm.follow(0.5, 6.0, 1.0) == first
    assert calm.follow(0.5, 2.0, 2.0) == first
    assert calm.follow(0.5, 2.0, 5.9) == first
    assert calm.follow(0.5, 2.0, 6.1) == (0.0, 2.0)
    assert calm.follow(0.5, 25.0, 6.2) == (0.0, 25.0)


@pytest.mark.parametrize(
    ("t_s", "step_s", "text"),
    [(0, 1, "0:00"), (75.26, 1, "1:15"), (75.26, 0.1, "1:15.3"), (3753.0, 1, "1:02:33"), (-2.0, 1, "-0:02"),
     (59.999, 0.01, "1:00.00"), (12.34567, 0.0005, "0:12.3457")],
)  # fmt: skip
def test_clock_times(t_s, step_s, text):
    assert clock_text(t_s, step_s) == text


def test_steps():
    assert nice_step(20_000, 4) == 5000
    assert nice_step(0.0, 4) == 1.0
    assert nice_step(math.nan, 4) == 1.0
    assert [nice_time_step(s, 6) for s in (12, 60, 600, 86_400 * 7, 0.3)] == [2, 10, 120, 200_000, 0.05]
    assert [number_decimals(s) for s in (5, 1, 0.5, 0.02)] == [0, 0, 1, 2]


def test_set_points_hold_until_the_next():
    series = StepSeries(history_s=10.0)
    assert len(series.course(0.0, 1.0)[0]) == 0 and math.isnan(series.value())
    for t_s, value in ((1.0, 5.0), (2.0, 5.0), (3.0, 8.0), (4.0, math.nan), (5.0, 2.0)):
        series.set(t_s, value)
    t, v = series.course(2.5, 6.0)
    np.testing.assert_array_equal(t, [2.5, 3.0, 3.0, 4.0, 4.0, 5.0, 5.0, 6.0])
    np.testing.assert_array_equal(v, [5.0, 5.0, 8.0, 8.0, math.nan, math.nan, 2.0, 2.0])
    t, v = series.course(5.5, 6.0)
    assert (t.tolist(), v.tolist()) == ([5.5, 6.0], [2.0, 2.0])
    assert len(series.course(0.0, 0.5)[0]) == 0
    still = series.copy()
    series.set(30.0, 1.0)
    assert len(series._points) == 2 and len(still._points) == 4
    series.set(0.0, 3.0)  # a new session
    assert series.value() == 3.0 and len(series._points) == 1


def test_limits_from_object_file_and_mapping(services, tmp_path):
    shipped = load_limits(services.config_folder / "limits" / "a_class.toml").limits
    bands = limit_bands(shipped)
    assert bands["pressure"] == (-1.0, 41.0) and bands["speed"][1] == 840.0
    assert bands["disc_temperature"] == (5.0, 500.0) and bands["torque"][1] == 1300.0
    assert limit_bands(None) == {} and limit_bands({"pressure": (0, 3)}) == {"pressure": (0.0, 3.0)}
    (tmp_path / "config").mkdir()
    text = (services.config_folder / "limits" / "a_class.toml").read_text()
    (tmp_path / "config" / "limits.toml").write_text(text)
    (tmp_path / "campaign.toml").write_text(
        "[rig.friction]\npiston_area_m2 = 0.002\neffective_radius_m = 0.1\n"
        '[rig.safety]\nlimits = "config/limits.toml"\n'
    )
    values = read_session(tmp_path)
    assert values.limits == bands
    assert values.friction.effective_radius_m == 0.1 and values.friction.p0_bar == 0.5
    assert read_session(tmp_path / "config").limits == {}

"""Histories: every extreme is in the envelope, whatever the zoom and the blocks; what is missing is a gap."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rigctl.core.channels import ChannelSpec
from rigctl.gui.live.buffer import MU, Friction, LiveBuffer, Stretch
from rigctl.gui.live.history import ChannelHistory
from rigctl.signals.friction import FrictionGeometry, friction_coefficient

RATE_HZ = 1000.0


def _signal(n: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    x = rng.normal(size=n).astype(np.float32)
    x[rng.random(n) < 0.001] *= 50.0  # single samples that a plain decimation would lose
    x[rng.random(n) < 0.05] = np.nan
    return x


@settings(max_examples=150, deadline=None)
@given(
    sizes=st.lists(st.integers(0, 700), min_size=1, max_size=25),
    pixels=st.integers(1, 400),
    window=st.tuples(st.floats(-0.2, 1.2), st.floats(-0.2, 1.2)),
    seed=st.integers(0, 10),
    history_s=st.sampled_from([0.3, 1.0, 3.0]),
)
def test_envelope_holds_every_extreme(sizes, pixels, window, seed, history_s):
    x = _signal(sum(sizes), seed)
    history = ChannelHistory(RATE_HZ, history_s)
    at = 0
    for size in sizes:
        history.append(5.0 + at / RATE_HZ, x[at : at + size])
        at += size
    if not at:
        assert history.empty
        return
    assert history.end_s == pytest.approx(5.0 + at / RATE_HZ)
    kept = min(at, round(history_s * RATE_HZ))
    assert history.start_s <= history.end_s - kept / RATE_HZ + 1e-9
    lo, hi = sorted(history.start_s + w * (history.end_s - history.start_s) for w in window)
    env = history.envelope(lo, hi, pixels)
    t = 5.0 + np.arange(at) / RATE_HZ
    oldest = history.start_s - 1e-9
    inside = np.flatnonzero((t >= max(lo, oldest)) & (t <= hi))
    bins = np.floor((t - env.start_s) / env.step_s + 1e-6).astype(int)
    per_bin = max(round(env.step_s * RATE_HZ), 1)
    assert len(env.low) <= 2 * pixels + 2 or per_bin == 1 << (history._levels)
    for i in inside:
        if np.isnan(x[i]):
            continue
        assert env.low[bins[i]] <= x[i] <= env.high[bins[i]]
    for j in range(len(env.low)):  # and nothing that never was
        members = x[(bins == j) & (t >= oldest - env.step_s)]
        members = members[~np.isnan(members)]
        if len(members) == 0:
            assert np.isnan(env.low[j]) and np.isnan(env.high[j])
        elif len(x[bins == j]) == per_bin:
            assert env.high[j] <= np.nanmax(x[bins == j]) and env.low[j] >= np.nanmin(x[bins == j])


def test_one_bad_sample_in_a_minute_is_seen_at_any_zoom():
    history = ChannelHistory(40_000.0, 12.0)
    x = np.zeros(12 * 40_000, np.float32)
    x[123_457] = 7.0
    for at in range(0, len(x), 2000):
        history.append(at / 40_000.0, x[at : at + 2000])
    for pixels in (50, 333, 1920):
        assert np.nanmax(history.envelope(0.0, 12.0, pixels).high) == 7.0
        assert len(history.envelope(0.0, 12.0, pixels).low) <= 2 * pixels + 2


def test_missing_time_is_a_gap_and_never_zero():
    history = ChannelHistory(RATE_HZ, 5.0)
    history.append(0.0, np.full(1000, 3.0))
    history.append(2.0, np.full(1000, 4.0))
    env = history.envelope(0.0, 3.0, 300)
    t = env.times_s()
    assert np.isnan(env.low[(t > 1.01) & (t < 1.99)]).all()
    assert np.nanmin(env.low) == 3.0
    assert np.isnan(history.value(1.5))
    assert history.value(2.5) == 4.0
    assert history.extremes(1.1, 1.9) is None
    assert history.mean(0.0, 3.0) == pytest.approx(3.5)


def test_rounded_block_times_make_no_gap():
    history = ChannelHistory(RATE_HZ, 5.0)
    for k in range(50):
        history.append(k * 0.05 + (0.0008 if k % 2 else -0.0008), np.ones(50))
    assert not np.isnan(history.envelope(0.0, 2.49, 5000).low).any()


def test_jump_far_ahead_and_back_again():
    history = ChannelHistory(RATE_HZ, 1.0)
    history.append(0.0, np.ones(500))
    history.append(1e6, np.full(100, 2.0))
    assert history.end_s == pytest.approx(1e6 + 0.1)
    assert history.extremes(0.0, 1e7) == (2.0, 2.0)
    history.append(0.0, np.full(10, 5.0))  # a new session
    assert history.extremes(-1e9, 1e9) == (5.0, 5.0)
    history.append(0.01, np.arange(100_000, dtype=float))  # more at once than is kept
    assert history.extremes(-1e9, 1e9)[1] == 99_999.0
    assert history.end_s == pytest.approx(0.01 + 100.0)


def test_asking_an_empty_history_or_endless_times_is_harmless():
    history = ChannelHistory(RATE_HZ, 1.0)
    for _ in range(2):
        assert np.isnan(history.value(history.end_s if history.empty else np.inf))
        assert np.isnan(history.mean(np.nan, np.nan))
        assert len(history.envelope(np.inf, np.inf, 10).low) <= 1
        history.append(0.0, np.ones(10))
    assert history.extremes(-np.inf, np.inf) == (1.0, 1.0)
    assert history.extremes(-5.0, -1.0) is None and history.extremes(1.0, 2.0) is None


def test_strided_samples_are_held():
    history = ChannelHistory(RATE_HZ, 5.0)
    history.append(0.0, [1.0, 2.0, 3.0], stride=100)
    assert history.end_s == pytest.approx(0.3)
    assert history.value(0.199) == 2.0
    history.append(0.3, np.full(10, 4.0))
    assert not np.isnan(history.envelope(0.0, 0.309, 5000).low).any()


def test_copy_stands_still():
    history = ChannelHistory(RATE_HZ, 1.0)
    history.append(0.0, np.ones(100))
    still = history.copy()
    history.append(0.1, np.full(3000, 9.0))
    assert still.end_s == pytest.approx(0.1)
    assert still.extremes(0.0, 10.0) == (1.0, 1.0)
    for pixels in (2, 2000):
        assert np.nanmax(still.envelope(0.0, 10.0, pixels).high) == 1.0


SPECS = [
    ChannelSpec("torque", "N·m", 100.0), ChannelSpec("pressure", "bar", 100.0),
    ChannelSpec("speed", "1/min", 100.0),
]  # fmt: skip


def test_mu_is_that_of_the_evaluation():
    rng = np.random.default_rng(1)
    p = np.concatenate([np.zeros(50), np.linspace(0, 20, 100), np.full(50, 20.0)]) + rng.normal(0, 0.1, 200)
    torque, speed = rng.normal(200, 5, 200), np.concatenate([np.full(180, 150.0), np.zeros(20)])
    buffer = LiveBuffer(SPECS, Friction(2.29e-3, 0.105))
    for part in (slice(0, 77), slice(77, 200)):
        t_s = part.start / 100.0
        buffer.feed(
            [Stretch("torque", t_s, torque[part]), Stretch("pressure", t_s, p[part]),
             Stretch("speed", t_s, speed[part])]
        )  # fmt: skip
    expected = friction_coefficient(torque, p, speed, FrictionGeometry())
    np.testing.assert_allclose(buffer.channels[MU].envelope(0.0, 1.99, 1000).low, expected, rtol=1e-5)
    assert np.isnan(expected).any() and np.isfinite(expected).any()


def test_without_geometry_there_is_no_mu():
    buffer = LiveBuffer(SPECS)
    buffer.feed([Stretch(name, 0.0, np.ones(10)) for name in ("torque", "pressure", "speed")])
    assert buffer.channels[MU].empty
    assert buffer.end_s == pytest.approx(0.1)
    assert buffer.copy().channels["speed"].value(0.05) == 1.0

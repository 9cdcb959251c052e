"""Clocks of sources against the master: alignment with synthetic clocks, lost, late and doubled samples."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivers.daq.clock import ClockFit, missing_before
from drivers.daq.collector import Collector
from drivers.daq.rig_time import SoundTime
from drivers.daq.source import SlowSettings, Taken
from rigctl.core.channels import ChannelSpec
from rigctl.core.errors import DeviceError

OFFSET_S = 0.030
SLOPE = 1.0  # the signal is the true time itself, so that an error of value is an error of time


class SyntheticSource:
    """A counting clock with drift and offset; its signal is true time; arrivals are late by jitter."""

    counted = True
    interpolation = "linear"
    hold_s = 0.0
    name = place = "synthetic"

    def __init__(self, *, rate_hz=1000.0, drift_ppm=0.0, jitter_s=0.002, seed=1, seconds=25.0, bridge_s=0.0):
        self.settings = SlowSettings(bridge_s=bridge_s)
        self.rate_hz = rate_hz
        random = np.random.default_rng(seed)
        number = np.arange(int(seconds * rate_hz))
        self.true_s = OFFSET_S + number / rate_hz / (1.0 + 1e-6 * drift_ppm)
        late = random.uniform(0.0, jitter_s, len(number))
        self.arrivals_s = np.maximum.accumulate(self.true_s + late)  # one queue: never out of order
        self.values = SLOPE * self.true_s[:, None]
        self.at = 0
        self.now_s = 0.0

    def drop(self, *numbers):
        for name in ("true_s", "arrivals_s", "values"):
            setattr(self, name, np.delete(getattr(self, name), numbers, axis=0))

    def double(self, number):
        for name in ("true_s", "arrivals_s", "values"):
            own = getattr(self, name)
            setattr(self, name, np.insert(own, number, own[number], axis=0))

    def stall(self, begin_s, end_s):
        """Nothing arrives in between; then all at once."""
        stalled = (self.arrivals_s > begin_s) & (self.arrivals_s < end_s)
        self.arrivals_s[stalled] = end_s

    def channels(self):
        return [ChannelSpec("torque", "N·m", 1000.0)]

    def check(self):
        return

    def convert(self, numbers, values):
        return numbers.astype(float), values

    def take(self):
        stop = int(np.searchsorted(self.arrivals_s, self.now_s, side="right"))
        start, self.at = self.at, stop
        return Taken(self.arrivals_s[start:stop], self.values[start:stop])


def errors_of(source, *, seconds=20.0, block_s=0.05, lateness_s=0.1):
    """Error in time of every grid point of all blocks after the first second; NaN where invalid."""
    collector = Collector(source, 0.0)
    for now in np.arange(0.05, 1.0, 0.05):
        source.now_s = now
        collector.update(now)
    found = []
    for begin in np.arange(1.0, seconds, block_s):
        end = begin + block_s
        source.now_s = now = end + lateness_s
        collector.update(now)
        grid = begin + np.arange(round(block_s * 1000)) / 1000.0
        found.append(collector.lay(grid)[:, 0] - grid)
    return np.concatenate(found), collector


@pytest.mark.parametrize("drift_ppm", [-100.0, 0.0, 100.0])
@pytest.mark.parametrize("seed", [1, 2])
def test_samples_are_laid_on_the_grid_within_half_a_millisecond(drift_ppm, seed):
    errors, collector = errors_of(SyntheticSource(drift_ppm=drift_ppm, seed=seed))
    assert np.all(np.isfinite(errors))
    assert np.max(np.abs(errors)) < 0.5e-3
    assert collector.lost == collector.doubled == 0
    state = collector.state(0.0, 0.0)
    assert state.offset_s == pytest.approx(OFFSET_S, abs=1.5e-3)  # extrapolated over 20 s: 100 ppm are 2 ms
    assert state.drift_ppm == pytest.approx(drift_ppm, abs=25.0)
    assert state.jitter_s < 4e-3


def test_a_slow_source_of_100_hz_is_aligned_as_well():
    errors, _ = errors_of(SyntheticSource(rate_hz=100.0, drift_ppm=100.0))
    assert np.max(np.abs(errors)) < 0.5e-3


def test_a_lost_sample_is_invalid_and_shifts_nothing():
    source = SyntheticSource(drift_ppm=50.0, jitter_s=0.0005)
    source.drop(5000, 7000, 7001, 7002)
    errors, collector = errors_of(source)
    assert collector.lost == 4
    assert np.count_nonzero(np.isnan(errors)) in (2 + 4, 2 + 4 + 1, 2 + 4 - 1)
    assert np.nanmax(np.abs(errors)) < 0.5e-3


def test_a_lost_sample_can_be_bridged():
    source = SyntheticSource(jitter_s=0.0005, bridge_s=0.002)
    source.drop(5000)
    errors, collector = errors_of(source)
    assert collector.lost == 1
    assert np.all(np.isfinite(errors))


def test_a_doubled_sample_is_counted_once():
    source = SyntheticSource(jitter_s=0.0005)
    source.double(5000)
    errors, collector = errors_of(source)
    assert collector.doubled == 1
    assert collector.lost == 0
    assert np.nanmax(np.abs(errors)) < 0.5e-3


def test_a_stalled_machine_loses_nothing():
    source = SyntheticSource()
    source.stall(5.0, 5.06)
    errors, collector = errors_of(source, lateness_s=0.15)
    assert collector.lost == collector.doubled == 0
    assert np.max(np.abs(errors)) < 0.5e-3


def test_samples_that_were_given_up_and_come_are_late_not_lost():
    """A sender behind by 0.1 s for longer than anybody can wait, which then makes up for it."""
    source = SyntheticSource(jitter_s=0.0005)
    behind = (source.arrivals_s > 5.0) & (source.arrivals_s < 5.4)
    source.arrivals_s[behind] += 0.1
    source.arrivals_s = np.maximum.accumulate(source.arrivals_s)
    errors, collector = errors_of(source)
    assert collector.late > 50
    assert collector.lost == collector.doubled == 0
    assert np.count_nonzero(np.isnan(errors)) >= collector.late
    # until it makes up, such a sender cannot be told from lost samples: what it sends is dated as it comes
    wrong = np.abs(np.nan_to_num(errors)) > 0.5e-3
    assert np.count_nonzero(wrong) < 510 and np.nanmax(np.abs(errors)) < 0.1005


def test_silence_is_invalid_not_held():
    source = SyntheticSource()
    source.drop(*range(4970, 25_000))
    errors, _ = errors_of(source, seconds=6.0)
    assert np.all(np.isnan(errors[4010:]))
    assert np.all(np.isfinite(errors[:3950]))


@given(
    late=st.lists(st.floats(0.0, 0.01), min_size=1, max_size=60),
    missing=st.lists(st.integers(0, 3), min_size=1, max_size=60),
)
def test_missing_samples_never_fall_and_need_all_later_ones_late(late, missing):
    n = min(len(late), len(missing))
    gaps = np.cumsum(missing[:n])
    lateness = gaps * 1e-3 + np.array(late[:n]) * 0.02  # jitter below a quarter of the period
    found = missing_before(lateness, 1e-3)
    assert np.array_equal(found, gaps)
    assert np.all(np.diff(found) >= 0)


@given(st.floats(-200.0, 200.0), st.floats(-1e3, 1e6))
def test_exact_clocks_are_found_exactly(drift_ppm, t0_s):
    fit = ClockFit(1000.0)
    numbers = np.arange(0, 8000)
    period_s = 1e-3 / (1.0 + 1e-6 * drift_ppm)
    fit.add(numbers, t0_s + numbers * period_s)
    assert fit.drift_ppm == pytest.approx(drift_ppm, abs=0.1)
    assert fit.line.at(7000) == pytest.approx(t0_s + 7000 * period_s, abs=1e-6)


class SyntheticMaster:
    """Callbacks of 200 frames at 40 kHz."""

    place = "rig.toml: devices.acquisition.sources.microphone"
    name = "microphone"
    rate_hz = 40_000.0

    def __init__(self, rate_hz=40_000.0, delay_s=lambda t_s: 0.0):
        self.settings = SimpleNamespace(delay_s=0.0, silent_s=0.5)
        self.true_hz = rate_hz
        self.count = 0
        self.lost = 0
        self.now_s = 0.0
        self.random = np.random.default_rng(3)
        self.waiting = []
        self.delay_s = delay_s  # beyond jitter, of the frames of a time

    def until(self, now_s):
        while (t_s := (self.count + self.lost + 200) / self.true_hz) <= now_s:
            self.count += 200
            self.waiting.append((self.count, t_s + self.random.uniform(0.0, 0.002) + self.delay_s(t_s)))
            self.now_s = t_s

    def check(self):
        return

    def frames(self):
        return self.count

    def stamps(self):
        waiting, self.waiting = self.waiting, []
        return np.array([n for n, _ in waiting], int), np.array([t for _, t in waiting])

    def last_arrival_s(self):
        return self.now_s


def run_master(master, begin_s, end_s, rig_time):
    for now_s in np.arange(begin_s, end_s, 0.05):
        master.until(now_s)
        rig_time.update(now_s)


def sound_time(master):
    return SoundTime(master, 0.0, gap_limit_s=0.02, max_drift_ppm=1000.0)


def test_the_sound_cards_clock_is_the_rigs_time():
    master = SyntheticMaster(40_004.0)  # 100 ppm fast
    rig_time = sound_time(master)
    run_master(master, 0.05, 1.0, rig_time)
    rig_time.start(1.0)
    run_master(master, 1.0, 15.0, rig_time)
    assert rig_time.drift_ppm == pytest.approx(100.0, abs=25.0)
    rig_s = np.array([12.0])
    assert rig_time.host_s(rig_s)[0] == pytest.approx((rig_time.origin + 12.0 * 40_000) / 40_004, abs=0.5e-3)


def test_lost_sound_is_found_without_any_flag():
    master = SyntheticMaster()
    rig_time = sound_time(master)
    run_master(master, 0.05, 5.0, rig_time)
    master.lost = 5200 // 4  # wires.md: 5200 samples in 4 gaps
    with pytest.raises(DeviceError, match=r"sources\.microphone: has lost \d+ ms of sound"):
        run_master(master, 5.0, 9.0, rig_time)


def test_a_silent_microphone_is_named():
    master = SyntheticMaster()
    rig_time = sound_time(master)
    run_master(master, 0.05, 2.0, rig_time)
    with pytest.raises(DeviceError, match=r"sources\.microphone: has delivered no sound"):
        rig_time.update(2.6)


def test_a_wrong_rate_is_found():
    master = SyntheticMaster(44_100.0)
    with pytest.raises(DeviceError, match=r"delivers 44\d\d\d frames/s instead of 40000"):
        run_master(master, 0.05, 5.0, sound_time(master))


@pytest.mark.parametrize("waited_s", [0.1, 0.4])
@pytest.mark.parametrize("burst_s", [0.05, 0.3, 0.8])
def test_what_waited_in_the_server_at_the_start_is_no_rate(waited_s, burst_s):
    """It had taken `waited_s` of sound before it was heard, and hands it out within `burst_s`."""
    master = SyntheticMaster(40_004.0, delay_s=lambda t_s: waited_s * max(0.0, 1.0 - t_s / burst_s))
    rig_time = sound_time(master)
    run_master(master, 0.05, 15.0, rig_time)
    assert rig_time.warm
    assert rig_time.drift_ppm == pytest.approx(100.0, abs=25.0)
    assert rig_time.jitter_s < 0.01


@pytest.mark.parametrize("until_s", [0.7, 1.05, 2.3])
def test_late_callbacks_that_come_in_time_again_are_no_rate(until_s):
    """A machine that was busy, or a server that shortens its buffer: one step, however long it was late."""
    master = SyntheticMaster(delay_s=lambda t_s: 0.3 if t_s < until_s else 0.0)
    run_master(master, 0.05, 15.0, sound_time(master))


@pytest.mark.parametrize(
    ("rate_hz", "words"),
    [
        (48_000.0, "delivers 4[78]... frames/s instead of 40000"),
        (42_000.0, "delivers 4[12]... frames/s instead of 40000"),
        (40_400.0, "drifts by"),
        (39_600.0, "has lost"),  # a clock that is slow cannot be told from one that loses frames
        (32_000.0, "has lost"),
    ],
)
def test_other_wrong_rates_are_found(rate_hz, words):
    master = SyntheticMaster(rate_hz)
    with pytest.raises(DeviceError, match=words):
        run_master(master, 0.05, 20.0, sound_time(master))

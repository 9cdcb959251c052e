"""Live spectra, events and levels against the evaluation of finished brakings (`rigctl.signals`)."""

import subprocess
import sys
from dataclasses import asdict

import numpy as np
import pytest

from rigctl.gui.live.levels import a_gain
from rigctl.gui.live.peaks import LiveDetection
from rigctl.gui.live.sound import LAF, LZF, LiveSpectrum
from rigctl.gui.live.stft import Frames, SpectrogramHistory, StreamingSpectrum, level_db, to_db
from rigctl.signals.levels import time_weighted_db
from rigctl.signals.spectra import spectrogram
from rigctl.signals.squeal import SquealDetection, detect_squeal
from rigctl.signals.weighting import apply_weighting, weighting_gain

RATE_HZ = 40_000.0


def _squeal(seconds: float = 6.0, seed: int = 3) -> np.ndarray:
    """Noise, a growing squeal with a harmonic, and a second, shorter one with a gap."""
    rng = np.random.default_rng(seed)
    t = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
    x = rng.normal(0, 0.01, len(t))
    grow = 0.6 * np.clip((t - 1.0) / 1.5, 0, 1) * (t < 4.5)
    x += grow * np.sin(2 * np.pi * 2350.3 * t) + 0.1 * grow * np.sin(2 * np.pi * 4700.6 * t)
    x += 0.3 * ((t > 3.0) & (t < 3.6)) * np.sin(2 * np.pi * 6810.0 * t)
    x += 0.02 * ((t > 5.0) & (t < 5.1)) * np.sin(2 * np.pi * 9000.0 * t)  # too short
    return x.astype(np.float32)


def _pieces(n: int, seed: int):
    rng = np.random.default_rng(seed)
    at = 0
    while at < n:
        size = int(rng.integers(1, 6000))
        yield at, min(at + size, n)
        at += size


@pytest.mark.parametrize("seed", [0, 1])
def test_frames_are_those_of_the_evaluation(seed):
    x = _squeal(2.0)
    stft = StreamingSpectrum(RATE_HZ)
    made, first_s = [], None
    for begin, end in _pieces(len(x), seed):
        frames = stft.feed(7.0 + begin / RATE_HZ, x[begin:end])
        if len(frames.power) and first_s is None:
            first_s = frames.t_s
        made.append(frames.power)
    power = np.concatenate(made)
    expected = spectrogram(x, RATE_HZ, t0_s=7.0)
    assert power.shape == expected.power.shape
    assert first_s == pytest.approx(expected.time_s()[0])
    np.testing.assert_allclose(power, expected.power, rtol=2e-3, atol=1e-10)


def test_a_gap_begins_a_new_frame_and_bad_samples_make_no_level():
    stft = StreamingSpectrum(RATE_HZ)
    assert len(stft.feed(0.0, np.ones(4000)).power) == 0
    frames = stft.feed(1.0, np.ones(4096))
    assert len(frames.power) == 1 and frames.t_s == pytest.approx(1.0 + 2048 / RATE_HZ)
    history = SpectrogramHistory(stft.hop_s, stft.line_hz, 2049, 12.0)
    history.append(stft.feed(3.0, np.full(4096, np.nan)))
    assert np.isnan(history.value_db(3.0 + 2048 / RATE_HZ, 1000.0))


def test_settings_are_those_of_the_evaluation():
    evaluation = SquealDetection().model_dump()
    for name, value in asdict(LiveDetection()).items():
        assert evaluation[name] == value, name
    assert LiveDetection().hop == SquealDetection().hop


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_events_are_those_of_the_evaluation(seed):
    x = _squeal(seed=seed)
    live = LiveSpectrum(RATE_HZ)
    for begin, end in _pieces(len(x), seed):
        live.feed(begin / RATE_HZ, x[begin:end])
    live.feed(len(x) / RATE_HZ, np.zeros(40_000))
    events = live.events()
    expected = detect_squeal(spectrogram(x, RATE_HZ), SquealDetection())
    assert len(expected) == 3
    assert len(events) == len(expected)
    for event, truth in zip(events, expected, strict=True):
        assert event.frequency_hz == pytest.approx(truth.frequency_hz, abs=0.5)
        assert event.level_db == pytest.approx(truth.level_db, abs=0.05)
        assert event.start_s == pytest.approx(truth.start_s, abs=1e-6)
        assert event.end_s - event.start_s == pytest.approx(truth.duration_s, abs=1e-6)
        assert event.harmonic == (truth.harmonic_of is not None)
        assert not event.open


def test_noise_alone_has_no_events_but_a_tone_is_marked_while_it_lasts():
    rng = np.random.default_rng(5)
    live = LiveSpectrum(RATE_HZ)
    t = np.arange(40_000) / RATE_HZ
    for second in range(4):
        live.feed(float(second), rng.normal(0, 0.3, 40_000))  # 83 dB
    assert live.events() == []
    live.feed(4.0, rng.normal(0, 0.05, 40_000) + 0.5 * np.sin(2 * np.pi * 3000 * t))
    (event,) = live.events()
    assert event.open and event.frequency_hz == pytest.approx(3000, abs=1)
    still = live.copy()
    for second in range(5, 70):
        live.feed(float(second), np.zeros(40_000, np.float32))
    assert live.events() == [] and len(still.events()) == 1


@pytest.mark.parametrize("rate_hz", [40_000.0, 48_000.0, 44_100.0])
def test_levels_are_those_of_the_evaluation(rate_hz):
    rng = np.random.default_rng(2)
    n = round(3 * rate_hz)
    t = np.arange(n) / rate_hz
    x = rng.normal(0, 0.05, n) + 0.5 * np.sin(2 * np.pi * 2350 * t) * (t > 1.0) * (t < 2.0)
    x += 0.4 * np.sin(2 * np.pi * 100 * t) * (t > 2.2)
    live = LiveSpectrum(rate_hz)
    for begin, end in _pieces(n, 1):
        live.feed(20.0 + begin / rate_hz, x[begin:end])
    for name, course in (
        (LZF, time_weighted_db(x, rate_hz)),
        (LAF, time_weighted_db(apply_weighting(x, rate_hz, "A"), rate_hz)),
    ):
        env = live.levels[name].envelope(20.0, 23.0, 10_000)
        at = np.round((env.times_s() - 20.0) * rate_hz).astype(int) - 1
        seen = (at > 0.2 * rate_hz) & (at < n)
        assert seen.sum() > 500
        np.testing.assert_allclose(env.low[seen], course[at[seen]], atol=0.15)


def test_weighting_is_the_standards():
    f = np.geomspace(10, 20_000, 200)
    np.testing.assert_allclose(a_gain(f), weighting_gain(f, "A"), rtol=1e-12)


def test_offset_of_the_converter_is_no_sound():
    live = LiveSpectrum(RATE_HZ)
    for k in range(100):
        live.feed(k * 0.05, np.full(2000, 0.5, np.float32))
    assert live.levels[LZF].extremes(4.0, 5.0)[1] < 60.0


def test_picture_of_the_spectrogram_keeps_the_loudest_cell():
    history = SpectrogramHistory(0.05, 10.0, 2049, 12.0)
    power = np.full((400, 2049), 1e-10, np.float32)
    power[333, 777] = 1.0
    for at in range(0, 400, 7):
        history.append(Frames(0.025 + at * 0.05, power[at : at + 7]))
    assert history.end_s == pytest.approx(20.0)
    for columns, rows in ((30, 40), (240, 2049), (100, 300)):
        picture = history.picture(0.0, 20.0, (1000.0, 16_000.0), columns, rows)
        row, column = np.unravel_index(np.argmax(picture.levels), picture.levels.shape)
        loudest = to_db(int(picture.levels[row, column]))
        assert loudest == pytest.approx(float(level_db(np.array(1.0))), abs=0.5)
        t_s, f_hz = picture.start_s + column * picture.column_s, picture.low_hz + row * picture.row_hz
        assert t_s <= 333.5 * 0.05 <= t_s + picture.column_s
        assert f_hz <= 7770.0 <= f_hz + picture.row_hz
    assert history.value_db(333.5 * 0.05, 7770.0) == pytest.approx(94.0, abs=0.5)
    assert np.isnan(history.value_db(1.0, 1000.0))  # older than the history
    history.append(Frames(25.025, power[:3]))
    assert (history.picture(20.5, 24.5, (0.0, 20_000.0), 100, 100).levels == 0).all()
    history.append(Frames(0.025, power[:3]))  # a new session
    assert history.end_s == pytest.approx(0.15)


def test_the_window_does_not_load_compilers():
    code = (
        "import sys, rigctl.gui.live.sound, rigctl.gui.live.source;"
        "print([m for m in ('numba', 'scipy', 'h5py', 'PySide6') if m in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"

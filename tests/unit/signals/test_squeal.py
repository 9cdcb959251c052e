"""Squeal detection: what must be found, and what must not (domain.md 2.2)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.signal import butter, sosfilt

from rigctl.signals.calibration import mean_square_pa2
from rigctl.signals.spectra import spectrogram
from rigctl.signals.squeal import SpeedCourse, SquealDetection, detect_squeal

RATE_HZ = 40000.0
DEFAULT = SquealDetection()
LINE_HZ = RATE_HZ / DEFAULT.fft_size


def amplitude(level):
    return float(np.sqrt(2 * mean_square_pa2(level)))


def time_s(seconds):
    return np.arange(int(seconds * RATE_HZ)) / RATE_HZ


def noise(level, seconds, seed=0):
    rng = np.random.default_rng(seed)
    return np.sqrt(mean_square_pa2(level)) * rng.standard_normal(int(seconds * RATE_HZ))


def tone(level, f_hz, seconds, start_s=0.0, stop_s=1e9, *, phase=0.3):
    t = time_s(seconds)
    return amplitude(level) * np.sin(2 * np.pi * f_hz * t + phase) * ((t >= start_s) & (t < stop_s))


def detect(x, window_s=None, speed=None, cfg=DEFAULT):
    spec = spectrogram(x, RATE_HZ, fft_size=cfg.fft_size, hop=cfg.hop)
    return detect_squeal(spec, cfg, window_s=window_s, speed=speed)


def squeals(*args, **kwargs):
    return [e for e in detect(*args, **kwargs) if e.harmonic_of is None]


# ---- found ----


@settings(max_examples=25, deadline=None)
@given(
    f_hz=st.floats(1050, 15900),
    level=st.floats(61, 110),
    start_s=st.floats(0.5, 1.5),
    seconds=st.floats(0.4, 1.5),
)
def test_a_tone_is_one_event_with_its_frequency_level_and_time(f_hz, level, start_s, seconds):
    x = tone(level, f_hz, 3.5, start_s, start_s + seconds) + noise(40, 3.5)
    (event,) = detect(x, window_s=(0.4, 3.5))
    assert event.frequency_hz == pytest.approx(f_hz, abs=0.1 * LINE_HZ)
    assert event.level_db == pytest.approx(level, abs=0.2)
    # a loud tone is seen as soon as the window touches it: half a frame of 0.102 s early and late
    assert event.start_s == pytest.approx(start_s, abs=0.08)
    assert event.start_s + event.duration_s == pytest.approx(start_s + seconds, abs=0.08)
    assert event.share == pytest.approx(event.duration_s / 3.1)
    assert start_s - 0.05 <= event.peak_s <= start_s + seconds + 0.05


def test_a_weighted_level_is_1_3_db_higher_at_the_squeal_of_the_paper():
    (event,) = detect(tone(80, 2350, 2))
    assert event.level_dba - event.level_db == pytest.approx(1.27, abs=0.01)


@pytest.mark.parametrize(("level", "count"), [(59.5, 0), (60.5, 1)])
def test_threshold(level, count):
    assert len(detect(tone(level, 2350, 3) + noise(45, 3))) == count


def test_a_lower_threshold_finds_more():
    cfg = SquealDetection(threshold_db=50.0)
    assert len(detect(tone(55, 2350, 3) + noise(45, 3), cfg=cfg)) == 1


def test_two_simultaneous_squeals_are_two_events():
    x = tone(80, 2350, 4, 1, 3) + tone(72, 2530, 4, 1.5, 3.5) + noise(50, 4)
    a, b = squeals(x)
    assert (a.frequency_hz, b.frequency_hz) == pytest.approx((2350, 2530), abs=1.0)
    assert (a.level_db, b.level_db) == pytest.approx((80, 72), abs=0.2)


def test_modulation_once_per_revolution_is_one_event():
    t = time_s(12)
    x = tone(80, 2350, 12) * (1 - 0.4 + 0.4 * np.cos(2 * np.pi * 40 / 60 * t)) + noise(50, 12)
    (event,) = detect(x)
    assert event.duration_s > 11.7
    assert event.level_db == pytest.approx(80, abs=0.3)
    assert event.leq_db < event.level_db - 1.0


@pytest.mark.parametrize("modulation_hz", [5.0, 20.0, 50.0, 90.0])
def test_side_bands_of_fast_modulation_are_not_events(modulation_hz):
    t = time_s(4)
    x = tone(85, 2350, 4) * (0.55 + 0.45 * np.cos(2 * np.pi * modulation_hz * t)) + noise(50, 4)
    (event,) = detect(x)
    assert event.frequency_hz == pytest.approx(2350, abs=0.2 * LINE_HZ)


def test_drift_with_temperature_is_one_event():
    t = time_s(10)
    phase = 2 * np.pi * (2350 * t - 0.5 * 3.0 * t**2)
    (event,) = detect(amplitude(75) * np.sin(phase) + noise(50, 10))
    assert event.frequency_hz == pytest.approx(2335, abs=3)


def test_short_gap_is_bridged_and_long_gap_is_not():
    gaps = tone(80, 2350, 6, 1, 2) + tone(80, 2350, 6, 2.15, 3) + tone(80, 2350, 6, 4, 5)
    events = detect(gaps + noise(50, 6))
    assert [round(e.start_s) for e in events] == [1, 4]


def test_hysteresis_keeps_a_squeal_that_flickers_around_the_threshold():
    t = time_s(6)
    level = 60.0 + 1.5 * np.sin(2 * np.pi * 0.8 * t)
    x = amplitude(0) * 10 ** (level / 20) * np.sin(2 * np.pi * 2350 * t)
    assert len(detect(x)) == 1


def test_harmonics_are_children_and_not_counted():
    x = tone(90, 2350, 4, 1, 3) + tone(75, 4702, 4, 1, 3) + tone(68, 7050, 4, 1, 3) + tone(70, 5600, 4, 1, 3)
    events = detect(x + noise(50, 4))
    assert len(events) == 4
    main = next(i for i, e in enumerate(events) if abs(e.frequency_hz - 2350) < 2)
    parents = {round(e.frequency_hz, -1): e.harmonic_of for e in events}
    assert parents == {2350: None, 4700: main, 7050: main, 5600: None}


def test_a_multiple_at_another_time_is_a_squeal_of_its_own():
    x = tone(90, 2350, 5, 0.5, 2) + tone(75, 4700, 5, 3, 4.5) + noise(50, 5)
    assert len(squeals(x)) == 2


@settings(max_examples=15, deadline=None)
@given(gain_db=st.floats(0, 20), seed=st.integers(0, 50))
def test_scaling_moves_levels_and_nothing_else(gain_db, seed):
    rng = np.random.default_rng(seed)
    x = (
        tone(85, rng.uniform(1500, 9000), 3, 1, 2.5)
        + tone(80, rng.uniform(10000, 15000), 3)
        + noise(40, 3, seed)
    )
    quiet, loud = detect(x), detect(x * 10 ** (gain_db / 20))
    assert len(quiet) == 2
    for a, b in zip(quiet, loud, strict=True):
        assert b.level_db - a.level_db == pytest.approx(gain_db, abs=1e-3)
        assert b.leq_db - a.leq_db == pytest.approx(gain_db, abs=0.1 + 0.05 * gain_db)
        assert b.frequency_hz == pytest.approx(a.frequency_hz, abs=0.05)


# ---- not found ----


@pytest.mark.parametrize("seed", range(4))
def test_white_noise_of_75_db_is_no_squeal(seed):
    assert detect(noise(75, 12, seed)) == []


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("level", [95, 110])
def test_deafening_noise_with_single_lines_far_above_threshold_is_no_squeal(level, seed):
    assert detect(noise(level, 12, seed)) == []


def test_steady_ventilator_tone_is_removed_by_the_spectrum_before_onset():
    ventilator = tone(70, 1480, 6)
    assert detect(ventilator + noise(50, 6), window_s=(1.0, 5.5)) == []
    # the same tone, without knowledge of the time before onset, is an event: the background did the work
    assert len(detect(ventilator + noise(50, 6))) == 1


def test_squeal_beside_and_above_the_ventilator_tone_is_still_found():
    ventilator = tone(70, 1480, 6)
    beside = tone(66, 2350, 6, 2, 4)
    (event,) = detect(ventilator + beside + noise(50, 6), window_s=(1.0, 5.5))
    assert event.frequency_hz == pytest.approx(2350, abs=1)
    above = tone(90, 1480, 6, 2, 4, phase=0.3)
    (event,) = detect(ventilator + above + noise(50, 6), window_s=(1.0, 5.5))
    assert event.start_s == pytest.approx(2.0, abs=0.1)


def test_a_tone_that_ends_at_onset_is_no_event():
    assert detect(tone(75, 3000, 5, 0, 1.0) + noise(50, 5), window_s=(1.0, 5.0)) == []


def test_hiss_of_the_valve_is_no_event():
    sos = butter(4, (3000, 9000), "bandpass", fs=RATE_HZ, output="sos")
    t = time_s(5)
    hiss = sosfilt(sos, noise(95, 5, 1)) * np.exp(-(((t - 1.2) / 0.25) ** 2))
    assert detect(hiss + noise(50, 5), window_s=(1.0, 5.0)) == []


@pytest.mark.parametrize("decay_s", [0.001, 0.005, 0.02])
def test_click_and_ringing_knock_are_no_events(decay_s):
    t = time_s(4)
    x = noise(50, 4)
    for at_s in (1.0, 2.03, 2.9):
        dt = t - at_s
        ring = np.exp(-np.clip(dt, 0, None) / decay_s) * (dt >= 0)
        x += amplitude(90) * ring * np.sin(2 * np.pi * 3100 * dt)
    assert detect(x) == []


def test_wire_brush_noise_modulated_with_the_wheel_is_no_event():
    t = time_s(8)
    x = noise(85, 8, 4) * (1 + 0.8 * np.sin(2 * np.pi * 0.67 * t))
    assert detect(x) == []


def test_low_hum_and_its_harmonics_below_the_band_are_ignored():
    assert detect(sum(tone(80, 300 * k, 4) for k in range(1, 4)) + noise(50, 4)) == []


def test_shaft_order_is_rejected_while_the_speed_varies_and_squeal_is_not():
    t = time_s(8)
    n_rpm = 200 - 12 * t
    order = 600
    phase = 2 * np.pi * order * np.cumsum(n_rpm) / 60 / RATE_HZ
    x = amplitude(75) * np.sin(phase) + noise(50, 8)
    speed = SpeedCourse(t[::40], n_rpm[::40])
    assert len(detect(x)) >= 1
    assert detect(x, speed=speed) == []
    (event,) = detect(noise(50, 8) + tone(75, 2350, 8), speed=speed)
    assert event.frequency_hz == pytest.approx(2350, abs=1)


def test_shaft_order_cannot_be_told_from_squeal_at_constant_speed():
    t = time_s(4)
    speed = SpeedCourse(t[::40], np.full(t[::40].size, 40.0))
    assert len(detect(tone(75, 2350, 4) + noise(50, 4), speed=speed)) == 1


def test_silence_and_short_signals_are_no_events():
    assert detect(np.zeros(40000)) == []
    assert detect(np.zeros(100)) == []


def test_band_limits_hold():
    x = tone(80, 900, 3) + tone(80, 16500, 3) + tone(80, 5000, 3)
    (event,) = detect(x)
    assert event.frequency_hz == pytest.approx(5000, abs=1)


# ---- settings ----


@pytest.mark.parametrize(
    "wrong",
    [
        {"threshold_db": float("nan")},
        {"threshold_db": 200},
        {"band_hz": (5000, 1000)},
        {"fft_size": 3000},
        {"overlap": 0.99},
        {"treshold_db": 60},
    ],
)
def test_nonsense_settings_are_refused(wrong):
    with pytest.raises(ValidationError):
        SquealDetection(**wrong)


def test_own_refusals_carry_a_remedy():
    with pytest.raises(ValidationError) as caught:
        SquealDetection(fft_size=3000)
    assert "remedy" in caught.value.errors()[0]["ctx"]

"""Spectra: calibration of tones and noise, interpolation, frame times."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rigctl.signals.calibration import level_db, mean_square_pa2
from rigctl.signals.spectra import band_mean_square, hann, interpolate_peak, spectrogram

RATE_HZ = 40000.0


def tone(level, f_hz, n, phase=0.0):
    t = np.arange(n) / RATE_HZ
    return np.sqrt(2 * mean_square_pa2(level)) * np.sin(2 * np.pi * f_hz * t + phase)


def test_peak_of_a_tone_on_a_line_reads_its_level():
    spec = spectrogram(tone(80.0, 240 * RATE_HZ / 4096, 8192), RATE_HZ)
    assert spec.power.shape == (3, 2049)
    assert level_db(spec.power[0, 240]) == pytest.approx(80.0, abs=0.001)


@settings(max_examples=60, deadline=None)
@given(f_hz=st.floats(1000, 16000), level=st.floats(40, 110), phase=st.floats(0, 6.28))
def test_any_tone_is_found_within_a_hundredth_line_and_db(f_hz, level, phase):
    spec = spectrogram(tone(level, f_hz, 4096, phase), RATE_HZ)
    line, power = interpolate_peak(spec.power[0], int(np.argmax(spec.power[0])))
    assert line * spec.line_hz == pytest.approx(f_hz, abs=0.01 * spec.line_hz)
    assert level_db(power) == pytest.approx(level, abs=0.02)


def test_equals_scipy_short_time_fft():
    from scipy.signal import ShortTimeFFT

    x = np.random.default_rng(0).standard_normal(40000)
    mine = spectrogram(x, RATE_HZ, fft_size=1024, hop=256)
    stft = ShortTimeFFT(hann(1024).astype(float), 256, RATE_HZ, scale_to="magnitude")
    theirs = np.abs(stft.stft(x, p0=2, p1=2 + mine.power.shape[0], k_offset=0)) ** 2 * 2
    assert np.allclose(mine.power[:, 1:-1].T, theirs[1:-1], rtol=1e-3, atol=1e-9)


def test_counts_and_floats_agree():
    x = tone(90.0, 3000.0, 20000)
    counts = np.round(x / 1e-4).astype(np.int16)
    a = spectrogram(counts, RATE_HZ, scale=1e-4)
    b = spectrogram(counts * 1e-4, RATE_HZ)
    assert np.allclose(a.power, b.power, rtol=1e-4, atol=1e-12)


def test_energy_of_noise_is_kept():
    x = np.random.default_rng(3).standard_normal(200000)
    assert band_mean_square(spectrogram(x, RATE_HZ), 0, RATE_HZ / 2) == pytest.approx(1.0, rel=0.01)


def test_frame_times_are_the_centres():
    x = np.zeros(40000)
    x[20000] = 1.0
    spec = spectrogram(x, RATE_HZ, fft_size=1024, hop=512, t0_s=5.0)
    loudest = spec.time_s()[np.argmax(spec.power.sum(axis=1))]
    assert loudest == pytest.approx(5.5, abs=512 / RATE_HZ / 2 + 1e-9)


def test_short_signal_has_no_frame_and_no_energy():
    spec = spectrogram(np.zeros(100), RATE_HZ)
    assert spec.power.shape == (0, 2049)
    assert band_mean_square(spec, 0, 20000) == 0.0


@pytest.mark.parametrize(("fft_size", "hop"), [(15, 4), (4095, 100), (4096, 0), (4096, 5000)])
def test_impossible_sizes_are_refused(fft_size, hop):
    with pytest.raises(ValueError, match="Use"):
        spectrogram(np.zeros(10000), RATE_HZ, fft_size=fft_size, hop=hop)


def test_flat_top_of_three_equal_lines_is_not_extrapolated():
    assert interpolate_peak(np.ones(9, np.float32), 4) == (4.0, 1.0)

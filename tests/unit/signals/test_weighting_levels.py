"""Frequency and time weighting against the table of IEC 61672-1:2013 and its tone-burst responses."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigctl.signals.calibration import (
    MicrophoneChain,
    clipped_share,
    level_db,
    mean_square_pa2,
    read_calibrator,
)
from rigctl.signals.levels import (
    band_levels_db,
    leq_and_lmax_db,
    third_octave_bands_hz,
    time_weighted_db,
    weighted_levels_db,
)
from rigctl.signals.weighting import apply_weighting, weighting_db, weighting_gain

RATE_HZ = 40000.0

# IEC 61672-1:2013 Table 3: exponent n of the exact frequency 10**(n/10) Hz, A dB, C dB.
TABLE_3 = [
    (10, -70.4, -14.3), (13, -50.5, -6.2), (16, -34.6, -2.0), (20, -19.1, -0.3), (24, -8.6, 0.0),
    (27, -3.2, 0.0), (30, 0.0, 0.0), (32, 1.0, -0.1), (34, 1.3, -0.3), (36, 1.0, -0.8), (38, -0.1, -2.0),
    (39, -1.1, -3.0), (40, -2.5, -4.4), (41, -4.3, -6.2), (42, -6.6, -8.5), (43, -9.3, -11.2),
]  # fmt: skip


def tone(level, f_hz, seconds=2.0, rate_hz=RATE_HZ):
    t = np.arange(int(seconds * rate_hz)) / rate_hz
    return np.sqrt(2 * mean_square_pa2(level)) * np.sin(2 * np.pi * f_hz * t)


@pytest.mark.parametrize(("n", "a_db", "c_db"), TABLE_3)
def test_curves_equal_the_table_of_the_standard(n, a_db, c_db):
    f_hz = 10.0 ** (n / 10)
    assert weighting_db(f_hz, "A") == pytest.approx(a_db, abs=0.051)
    assert weighting_db(f_hz, "C") == pytest.approx(c_db, abs=0.051)
    assert weighting_db(f_hz, "Z") == 0.0


def test_curves_are_zero_db_at_1_khz_and_block_direct_current():
    assert weighting_db(1000.0, "A") == pytest.approx(0.0, abs=1e-12)
    assert weighting_db(1000.0, "C") == pytest.approx(0.0, abs=1e-12)
    assert weighting_gain(0.0, "A") == weighting_gain(0.0, "C") == 0.0


def test_unknown_weighting_is_refused():
    with pytest.raises(ValueError, match=r"'B' is unknown\. Use"):
        weighting_gain(1000.0, "B")  # type: ignore[arg-type]


@pytest.mark.parametrize("f_hz", [63.0, 1000.0, 2350.0, 8000.0, 12500.0, 16000.0])
def test_weighted_signal_has_the_exact_gain_even_where_a_bilinear_filter_is_wrong(f_hz):
    signal = tone(80.0, f_hz)
    middle = slice(20000, 60000)
    for weighting in ("A", "C"):
        out = apply_weighting(signal, RATE_HZ, weighting)[middle]
        gain_db = level_db(np.mean(out.astype(float) ** 2)) - level_db(np.mean(signal[middle] ** 2))
        assert gain_db == pytest.approx(float(weighting_db(f_hz, weighting)), abs=0.01)


def test_weighting_leaves_the_input_alone_and_z_is_a_copy():
    signal = tone(80.0, 1000.0, 0.1).astype(np.float32)
    before = signal.copy()
    out = apply_weighting(signal, RATE_HZ, "Z")
    assert np.array_equal(out, signal)
    assert not np.shares_memory(out, signal)
    apply_weighting(signal, RATE_HZ, "A")
    assert np.array_equal(signal, before)


# IEC 61672-1:2013 Table 4: burst length ms, LAFmax - LA of the steady tone, 4 kHz.
@pytest.mark.parametrize(
    ("burst_ms", "expected_db"),
    [(1000, 0.0), (500, -0.1), (200, -1.0), (100, -2.6), (50, -4.8), (20, -8.3), (10, -11.1), (5, -14.1)],
)
def test_fast_tone_burst_response(burst_ms, expected_db):
    signal = np.concatenate((tone(90.0, 4000.0, burst_ms / 1000), np.zeros(20000)))
    _, lmax_db = leq_and_lmax_db(signal, RATE_HZ)
    assert lmax_db - 90.0 == pytest.approx(expected_db, abs=0.06)


def test_decay_of_fast_and_slow():
    signal = np.concatenate((tone(94.0, 1000.0, 6.0), np.zeros(40000)))
    for weighting, decay_db_s in (("F", 34.7), ("S", 4.34)):
        course = time_weighted_db(signal, RATE_HZ, weighting)
        assert course[240000] - course[279999] == pytest.approx(decay_db_s, rel=0.01)


def test_leq_of_a_calibrator_is_94_db_with_counts_offset_and_scale():
    counts = np.round(tone(94.0, 1000.0) / 1e-3 + 250).astype(np.int16)
    leq_db, lmax_db = leq_and_lmax_db(counts, RATE_HZ, scale=1e-3)
    # 94 dB are 1.0024 Pa
    assert leq_db == pytest.approx(94.0, abs=0.001)
    assert lmax_db == pytest.approx(94.0, abs=0.02)


def test_leq_of_a_stretch_and_refusal_of_an_empty_one():
    signal = np.concatenate((np.zeros(40000), tone(80.0, 1000.0, 1.0)))
    signal -= signal.mean()
    assert leq_and_lmax_db(signal, RATE_HZ, start=40000)[0] == pytest.approx(80.0, abs=0.001)
    assert leq_and_lmax_db(signal, RATE_HZ)[0] == pytest.approx(77.0, abs=0.02)
    with pytest.raises(ValueError, match=r"\[9, 9\) .* is empty. Give start < stop"):
        leq_and_lmax_db(signal, RATE_HZ, start=9, stop=9)


def test_a_weighted_level_of_a_low_tone():
    laeq_db, _ = weighted_levels_db(tone(94.0, 100.0), RATE_HZ)
    assert laeq_db == pytest.approx(94.0 + float(weighting_db(100.0, "A")), abs=0.1)


def test_band_levels_share_out_the_energy():
    signal = tone(80.0, 2350.0) + tone(70.0, 6000.0)
    low, high, rest = band_levels_db(signal, RATE_HZ, [(1000, 5000), (5000, 16000), (8000, 16000)])
    assert low == pytest.approx(80.0, abs=0.05)
    assert high == pytest.approx(70.0, abs=0.05)
    assert rest < 10.0


def test_white_noise_level_is_found_by_the_bands():
    noise = np.sqrt(mean_square_pa2(75.0)) * np.random.default_rng(5).standard_normal(400000)
    (half,) = band_levels_db(noise, RATE_HZ, [(5000, 15000)])
    assert half == pytest.approx(75.0 - 3.01, abs=0.1)


def test_third_octave_bands():
    bands = third_octave_bands_hz(1000, 16000)
    assert len(bands) == 13
    assert bands[1][1] == pytest.approx(1258.9, abs=0.1)
    assert all(a[2] == pytest.approx(b[0]) for a, b in itertools.pairwise(bands))


def test_microphone_chain_of_the_rig():
    chain = MicrophoneChain(sensitivity_v_per_pa=0.05)
    assert chain.pa_per_count == pytest.approx(200.0 / 32768)
    assert chain.full_scale_db == pytest.approx(137.0, abs=0.1)


def test_calibrator_recording_gives_the_factor_of_the_chain():
    chain = MicrophoneChain(sensitivity_v_per_pa=0.0475, gain=10.0)
    rng = np.random.default_rng(1)
    noise = np.sqrt(mean_square_pa2(40.0)) * rng.standard_normal(80000)
    counts = np.round((tone(94.0, 1003.7) + noise) / chain.pa_per_count).astype(np.int16)
    reading = read_calibrator(counts, RATE_HZ)
    assert reading.pa_per_count == pytest.approx(chain.pa_per_count, rel=0.001)
    assert reading.frequency_hz == pytest.approx(1003.7, abs=0.05)
    assert reading.level_spread_db < 0.05
    assert reading.tone_to_rest_db == pytest.approx(54.0, abs=1.0)


def test_calibrator_recordings_that_cannot_be_read_are_refused():
    with pytest.raises(ValueError, match=r"all samples are zero\. Check"):
        read_calibrator(np.zeros(40000, np.int16), RATE_HZ)
    with pytest.raises(ValueError, match=r"0\.10 s is too short"):
        read_calibrator(np.zeros(4000, np.int16), RATE_HZ)


def test_clipped_share_counts_both_ends():
    counts = np.array([0, 32767, -32768, -32767, 5, 6, 7, 8], np.int16)
    assert clipped_share(counts) == pytest.approx(3 / 8)
    assert clipped_share(np.array([32766, -32766], np.int16)) == 0.0
    assert clipped_share(np.empty(0, np.int16)) == 0.0


@given(st.floats(-50, 160))
def test_level_and_mean_square_are_inverse(level):
    assert level_db(mean_square_pa2(level)) == pytest.approx(level, abs=1e-9)


def test_silence_has_a_finite_level():
    assert np.isfinite(level_db(0.0))

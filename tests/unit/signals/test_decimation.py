"""Decimation: attenuation, ripple, zero delay, edges, and the stream equal to the block bit for bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rigctl.signals.decimation import StreamingDecimator, decimate, design_decimation


@pytest.mark.parametrize("factor", [2, 4, 5, 10, 40])
def test_design_meets_its_statement(factor):
    filt = design_decimation(factor)
    assert filt.attenuation_db > 80.0
    assert filt.ripple_db < 0.001
    assert np.allclose(filt.taps, filt.taps[::-1], atol=0)
    assert filt.taps.sum() == pytest.approx(1.0, abs=1e-12)
    # measured independently of the design's own measurement, at single frequencies
    n = np.arange(filt.taps.size) - filt.delay

    def response(f):
        return abs(np.sum(filt.taps * np.cos(2 * np.pi * f * n)))

    new_nyquist = 0.5 / factor
    assert max(response(f) for f in np.linspace(new_nyquist, 0.5, 301)) < 1e-4
    assert all(abs(response(f) - 1) < 1e-4 for f in np.linspace(0, 0.8 * new_nyquist, 101))


def test_tone_in_the_pass_band_keeps_amplitude_and_phase():
    rate_hz, f_hz = 4000.0, 130.0
    t = np.arange(8000) / rate_hz
    out = decimate(np.sin(2 * np.pi * f_hz * t).astype(np.float32), 4)
    expected = np.sin(2 * np.pi * f_hz * t[::4])
    assert out.dtype == np.float32
    assert np.max(np.abs(out - expected)[40:-40]) < 2e-5


@pytest.mark.parametrize("f_hz", [500.0, 620.0, 870.0, 1000.0, 1370.0, 1999.0])
def test_tone_beyond_the_new_nyquist_is_gone_instead_of_folded(f_hz):
    t = np.arange(8000) / 4000.0
    out = decimate(np.cos(2 * np.pi * f_hz * t), 4)
    assert np.max(np.abs(out[60:-60])) < 1e-4


def test_step_stays_where_it_was():
    x = np.zeros(4001)
    x[2000] = 0.5
    x[2001:] = 1.0
    out = decimate(x, 4)
    assert out[500] == pytest.approx(0.5, abs=1e-6)
    assert np.allclose(out[400:500] + out[501:601][::-1], 1.0, atol=1e-6)
    assert np.all(out[:440] < 1e-4)


def test_constant_and_edges_stay():
    assert np.allclose(decimate(np.full(1001, 7.25, np.float32), 4), 7.25, rtol=1e-6)
    ramp = decimate(np.linspace(0, 1, 4001), 4)
    assert abs(ramp[0]) < 1e-3
    assert abs(ramp[-1] - 1) < 1e-3


@settings(max_examples=60, deadline=None)
@given(
    n=st.integers(0, 1500),
    factor=st.sampled_from([1, 2, 3, 4, 7]),
    cuts=st.lists(st.integers(0, 1500), max_size=12),
    seed=st.integers(0, 99),
)
def test_stream_equals_block_bit_for_bit(n, factor, cuts, seed):
    x = np.random.default_rng(seed).standard_normal(n).astype(np.float32)
    stream = StreamingDecimator(factor)
    parts = [stream.push(block) for block in np.split(x, sorted(min(c, n) for c in cuts))]
    parts.append(stream.flush())
    assert np.array_equal(np.concatenate(parts), decimate(x, factor))
    assert np.concatenate(parts).shape == (-(-n // factor),)


def test_stream_gives_output_while_it_runs_with_the_stated_delay():
    stream = StreamingDecimator(4)
    out = stream.push(np.ones(4000, np.float32))
    delay = round(stream.delay_s(4000.0) * 4000)
    assert out.size == (4000 - 1 - delay) // 4 + 1
    assert stream.delay_s(4000.0) < 0.03


def test_stream_is_closed_after_flush():
    stream = StreamingDecimator(4)
    stream.push(np.ones(10))
    assert stream.flush().size == 3
    assert stream.flush().size == 0
    with pytest.raises(RuntimeError, match="Start a new"):
        stream.push(np.ones(3))


@pytest.mark.parametrize("factor", [0, -1, 1001])
def test_impossible_factors_are_refused(factor):
    with pytest.raises(ValueError, match=f"decimation factor: {factor} "):
        design_decimation(factor)


def test_description_is_json_and_true():
    text = design_decimation(4).describe(4000.0)
    assert (text.rate_out_hz, text.pass_band_hz, text.stop_band_hz) == (1000.0, 400.0, 500.0)
    assert text.stop_band_attenuation_db > 80
    assert type(text).model_validate_json(text.model_dump_json()) == text
    identity = design_decimation(1).describe(1000.0)
    assert identity.kind == "none"
    assert identity.stop_band_attenuation_db is None

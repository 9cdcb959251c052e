"""Microphone by calibrator and emissivity by contact thermometer."""

import numpy as np
import pytest

from rigctl.calibration import emissivity, microphone
from rigctl.calibration.emissivity import Pyrometer
from rigctl.calibration.record import Point

RATE_HZ = 40_000.0
NOMINAL = 20.0 / 32768.0


def tone(level_db: float, *, gain: float = 1.0, hz: float = 1000.0, noise_db: float = 30.0, seconds=1.0):
    random = np.random.default_rng(1)
    t = np.arange(round(RATE_HZ * seconds)) / RATE_HZ
    pa = np.sqrt(2) * 20e-6 * 10 ** (level_db / 20) * np.sin(2 * np.pi * hz * t)
    pa += random.normal(0, 20e-6 * 10 ** (noise_db / 20), len(t))
    return np.clip(np.rint(pa / NOMINAL * gain), -32768, 32767).astype(np.int16)


@pytest.mark.parametrize("level_db", microphone.LEVELS_DB)
@pytest.mark.parametrize("drift_db", [-0.4, 0.0, 0.3])
def test_sensitivity_is_found_to_a_hundredth_of_a_decibel(level_db: float, drift_db: float):
    recording = microphone.read(tone(level_db, gain=10 ** (drift_db / 20)), RATE_HZ, level_db)
    result = microphone.evaluate([recording], NOMINAL, last_gain=1.0)
    assert result.drift_db == pytest.approx(drift_db, abs=0.01)
    assert result.gain == pytest.approx(10 ** (-drift_db / 20), rel=2e-3)
    assert result.acceptable
    assert microphone.level_of(result.pa_per_count, NOMINAL, level_db) == pytest.approx(
        level_db + drift_db, abs=0.01
    )


def faults(*recordings: microphone.Recording, last: float | None = None) -> str:
    return "; ".join(fault.words for fault in microphone.evaluate(recordings, NOMINAL, last).faults)


def test_what_is_wrong_is_said():
    assert "not at 1 kHz" in faults(microphone.read(tone(94, hz=400), RATE_HZ, 94))
    assert "above the rest" in faults(microphone.read(tone(94, noise_db=70), RATE_HZ, 94))
    assert "at its limit" in faults(microphone.read(tone(114, gain=3), RATE_HZ, 114))
    assert "nominal sensitivity" in faults(microphone.read(tone(94), RATE_HZ, 114))
    rising = (tone(94) * np.linspace(1.0, 1.05, 40_000)).astype(np.int16)
    assert "moves by" in faults(microphone.read(rising, RATE_HZ, 94))
    assert "disagree" in faults(
        microphone.read(tone(94), RATE_HZ, 94), microphone.read(tone(114, gain=1.05), RATE_HZ, 114)
    )
    changed = microphone.evaluate([microphone.read(tone(94, gain=0.9), RATE_HZ, 94)], NOMINAL, 1.0)
    assert "changed by -0.9" in changed.faults[0].words
    assert changed.acceptable  # a person decides


def test_silence_and_too_short_are_refused():
    with pytest.raises(ValueError, match="samples are zero"):
        microphone.read(np.zeros(40_000, np.int16), RATE_HZ, 94)
    with pytest.raises(ValueError, match="too short"):
        microphone.read(tone(94, seconds=0.2), RATE_HZ, 94)


def seen_by(pyrometer: Pyrometer, true: float, degc: float) -> float:
    """What a pyrometer shows of a surface, by bisection of its own equation."""
    low, high = -50.0, 1500.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if pyrometer.true_degc(middle, true) < degc else (low, middle)
    return 0.5 * (low + high)


@pytest.mark.parametrize("true", [0.6, 0.84, 0.95])
def test_emissivity_is_found_and_corrects(true: float):
    pyrometer = Pyrometer(emissivity_set=0.9)
    pairs = [Point(applied=t, measured=seen_by(pyrometer, true, t)) for t in (100.0, 200.0, 300.0)]
    result = emissivity.evaluate(pairs, pyrometer)
    assert result.emissivity == pytest.approx(true, abs=1e-6)
    assert result.figures["residual_k"] < 1e-4
    assert result.acceptable
    corrected = [result.gain * pair.measured + result.offset for pair in pairs]
    assert corrected == pytest.approx([100, 200, 300], abs=result.figures["line_k"] + 0.01)


def test_the_line_is_better_than_nothing():
    pyrometer = Pyrometer(emissivity_set=0.95)
    pairs = [Point(applied=t, measured=seen_by(pyrometer, 0.8, t)) for t in (100.0, 300.0)]
    figures = emissivity.evaluate(pairs, pyrometer).figures
    assert figures["line_k"] < 0.25 * figures["uncorrected_k"]


def test_emissivity_faults():
    pyrometer = Pyrometer()
    with pytest.raises(ValueError, match="30 K warmer"):
        emissivity.evaluate([Point(applied=30, measured=30)], pyrometer)
    one = emissivity.evaluate([Point(applied=200, measured=190)], pyrometer)
    assert one.acceptable and "one pair" in one.faults[0].words
    bad = emissivity.evaluate([Point(applied=200, measured=60), Point(applied=300, measured=100)], pyrometer)
    assert not bad.acceptable
    apart = emissivity.evaluate(
        [Point(applied=200, measured=180), Point(applied=300, measured=300)], pyrometer
    )
    assert "disagree" in "; ".join(fault.words for fault in apart.faults)

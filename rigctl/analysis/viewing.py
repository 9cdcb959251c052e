"""One braking as a person looks at it: curves on one time axis, spectrogram, spectrum, sound to listen to.

Job: read a braking file and compute what a screen draws (`braking_view`). NOT its job: drawing (`rigctl.gui`,
`spectrogram_figure`), finding events (done when it was recorded).
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.analysis.braking_view import (
    LEVEL,
    MU,
    BrakingView,
    Curve,
    Listenable,
    SoundPicture,
    Spectrum,
)
from rigctl.core.channels import MICROPHONE, PRESSURE, SPEED, TORQUE, ChannelData
from rigctl.recording.braking_file import BrakingFile, read_braking
from rigctl.signals.calibration import level_db
from rigctl.signals.friction import FrictionGeometry, friction_coefficient
from rigctl.signals.levels import time_weighted_db
from rigctl.signals.spectra import Spectrogram, spectrogram
from rigctl.signals.weighting import apply_weighting, weighting_gain

MAX_POINTS = 4_000_000
"""Longer signals are sent as minima and maxima of blocks: no peak is lost."""
_LEVEL_RATE_HZ = 100.0
_FFT_SIZE = 2048
_MAX_FRAMES = 2000
_LOUDNESS_DB = -20.0
_PEAK = 0.891  # -1 dB of full scale
_MAX_GAIN_DB = 60.0
_FIXED_GAIN_PER_PA = 0.05  # without equal loudness: 20 Pa (120 dB) is full scale
_FADE_S = 0.02


def view_braking(path: Path, *, waveform: bool = True) -> BrakingView:
    """Read a braking file and compute what is drawn.

    Parameters
    ----------
    path : Path
    waveform : bool
        False leaves out the samples of the sound and the spectrogram: enough for comparing brakings.

    Raises
    ------
    RecordingError
        The file cannot be read.
    """
    file = read_braking(path)
    channels = {name: file.channels[name] for name in file.channels}
    curves: dict[str, Curve] = {}
    picture: SoundPicture | None = None
    spectrum: Spectrum | None = None
    for name, data in channels.items():
        if name != MICROPHONE:
            curves[name] = _curve(name, data)
    mu = _mu(channels, file.settings)
    if mu is not None:
        curves[MU] = mu
    sound = channels.get(MICROPHONE)
    if sound is not None and len(sound.samples):
        curves[LEVEL] = _level(sound)
        if waveform:
            curves[MICROPHONE] = _curve(MICROPHONE, sound)
        found = _spectra(sound)
        if found.power.shape[0]:
            spectrum = _spectrum(found, file)
            picture = _picture(found) if waveform else None
    return BrakingView(
        path, file.summary, file.specification, file.metadata, file.settings, curves, picture, spectrum
    )


def listenable(path: Path, *, equal_loudness: bool = True, rate_hz: float | None = None) -> Listenable:
    """The sound of a braking, ready for a loudspeaker: within ±1, faded in and out.

    Parameters
    ----------
    path : Path
    equal_loudness : bool
        Every braking is made equally loud (A-weighted); otherwise all with one gain, so that they compare.
    rate_hz : float, optional
        Rate that the sound device wants; as recorded by default.

    Raises
    ------
    RecordingError
        The file cannot be read.
    LookupError
        It holds no sound.
    """
    file = read_braking(path)
    if MICROPHONE not in file.channels:
        raise LookupError("this braking was recorded without sound")
    sound = file.channels[MICROPHONE]
    rate = sound.spec.rate_hz
    pressure = sound.physical().astype(np.float32)
    pressure = pressure - pressure.mean(dtype=np.float64).astype(np.float32)
    gain = _FIXED_GAIN_PER_PA
    if equal_loudness and len(pressure):
        rms = float(np.sqrt(np.mean(np.square(apply_weighting(pressure, rate, "A"), dtype=np.float64))))
        peak = float(np.abs(pressure).max())
        gain = min(
            10 ** (_LOUDNESS_DB / 20) / max(rms, 1e-9),
            _PEAK / max(peak, 1e-9),
            _FIXED_GAIN_PER_PA * 10 ** (_MAX_GAIN_DB / 20),
        )
    samples = pressure * np.float32(gain)
    if rate_hz is not None and rate_hz != rate:
        from fractions import Fraction

        from scipy.signal import resample_poly

        ratio = Fraction(round(rate_hz), round(rate)).limit_denominator(2000)
        samples = resample_poly(samples, ratio.numerator, ratio.denominator).astype(np.float32)
        rate = rate_hz
    fade = min(round(_FADE_S * rate), len(samples) // 2)
    if fade:
        ramp = (0.5 - 0.5 * np.cos(np.pi * np.arange(fade) / fade)).astype(np.float32)
        samples[:fade] *= ramp
        samples[-fade:] *= ramp[::-1]
    np.clip(samples, -1.0, 1.0, out=samples)
    return Listenable(samples, rate, 20 * float(np.log10(gain / _FIXED_GAIN_PER_PA)))


def _curve(name: str, data: ChannelData) -> Curve:
    values = data.physical().astype(np.float32, copy=False)
    dt_s = 1.0 / data.spec.rate_hz
    if len(values) > MAX_POINTS:
        block = -(-len(values) // (MAX_POINTS // 2))
        whole = values[: len(values) // block * block].reshape(-1, block)
        values = np.stack((whole.min(axis=1), whole.max(axis=1)), axis=1).ravel()
        dt_s *= block / 2
    return Curve(name, data.spec.unit, data.t0_s, dt_s, values, data.spec.description)


def _mu(channels: Mapping[str, ChannelData], settings: Mapping[str, Any]) -> Curve | None:
    needed = [channels.get(name) for name in (TORQUE, PRESSURE, SPEED)]
    if any(data is None for data in needed):
        return None
    torque, pressure, speed = (data for data in needed if data is not None)
    if not torque.spec.rate_hz == pressure.spec.rate_hz == speed.spec.rate_hz:
        return None
    n = min(len(torque.samples), len(pressure.samples), len(speed.samples))
    geometry = FrictionGeometry(**settings.get("friction", {}))
    mu = friction_coefficient(
        torque.physical()[:n], pressure.physical()[:n], speed.physical()[:n], geometry
    ).astype(np.float32)
    return Curve(MU, "", torque.t0_s, 1.0 / torque.spec.rate_hz, mu)


def _level(sound: ChannelData) -> Curve:
    rate = sound.spec.rate_hz
    pressure = sound.physical().astype(np.float64)
    course = time_weighted_db(pressure - pressure.mean(), rate)
    step = max(round(rate / _LEVEL_RATE_HZ), 1)
    values = course[step - 1 :: step].astype(np.float32)
    return Curve(LEVEL, "dB", sound.t0_s + step / rate, step / rate, values)


def _spectra(sound: ChannelData) -> Spectrogram:
    hop = max(_FFT_SIZE // 2, -(-len(sound.samples) // _MAX_FRAMES))
    return spectrogram(
        sound.samples, sound.spec.rate_hz, fft_size=_FFT_SIZE, hop=min(hop, _FFT_SIZE), scale=sound.spec.scale
    )


def _picture(found: Spectrogram) -> SoundPicture:
    times = found.time_s()
    return SoundPicture(level_db(found.power).astype(np.float32), float(times[0]), found.hop_s, found.line_hz)


def _spectrum(found: Spectrogram, file: BrakingFile) -> Spectrum:
    times = found.time_s()
    start, end = (file.results.get(f"application_{side}_s") for side in ("start", "end"))
    inside = np.ones(len(times), bool)
    if start is not None and end is not None:
        inside = (times >= start) & (times <= end)
        if not inside.any():
            inside[:] = True
    power = found.power[inside]
    return Spectrum(
        found.line_hz,
        level_db(power.mean(axis=0, dtype=np.float64)).astype(np.float32),
        level_db(power.max(axis=0)).astype(np.float32),
    )


def a_weighted_db(spectrum: Spectrum) -> NDArray[np.float32]:
    """Mean level per line with A weighting, dB(A)."""
    gain = weighting_gain(spectrum.frequency_hz(), "A")
    return (spectrum.mean_db + 20 * np.log10(np.maximum(gain, 1e-9))).astype(np.float32)

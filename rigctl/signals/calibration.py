"""From converter counts to pascal, and from pascal to decibel.

Job: the microphone chain as data, its factor Pa per count, calibrator readings, sound pressure level re 20
uPa. NOT its job: levels over time (`levels`), reading calibration files (rigctl.config).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field

from rigctl.core.units import REFERENCE_PRESSURE_PA
from rigctl.signals._model import FrozenModel
from rigctl.signals.spectra import HANN_NOISE_BANDWIDTH, interpolate_peak, spectrogram

_FLOOR_PA2 = 1e-30


def level_db(mean_square_pa2: ArrayLike) -> NDArray[np.float64]:
    """Sound pressure level re 20 uPa, dB, of a mean-square pressure in Pa^2 (any shape).

    Zero gives a floor of -206 dB instead of minus infinity.
    """
    ms = np.maximum(np.asarray(mean_square_pa2, dtype=np.float64), _FLOOR_PA2)
    return 10.0 * np.log10(ms / REFERENCE_PRESSURE_PA**2)


def mean_square_pa2(level: ArrayLike) -> NDArray[np.float64]:
    """Inverse of `level_db`: mean-square pressure, Pa^2, of a level in dB."""
    return REFERENCE_PRESSURE_PA**2 * 10.0 ** (np.asarray(level, dtype=np.float64) / 10.0)


class MicrophoneChain(FrozenModel):
    """Microphone, preamplifier and converter: everything between the sound and the counts."""

    sensitivity_v_per_pa: float = Field(gt=0, le=10)
    gain: float = Field(default=1.0, gt=0, le=1e5)
    full_scale_v: float = Field(default=10.0, gt=0, le=100)
    bits: int = Field(default=16, ge=8, le=32)

    @property
    def pa_per_count(self) -> float:
        """Pa per count: full scale in volt spread over 2**(bits-1) counts, back through gain and
        sensitivity.
        """
        return self.full_scale_v / 2 ** (self.bits - 1) / (self.gain * self.sensitivity_v_per_pa)

    @property
    def full_scale_db(self) -> float:
        """Level of the loudest undistorted sine, dB re 20 uPa."""
        peak_pa = self.pa_per_count * 2 ** (self.bits - 1)
        return float(level_db(peak_pa**2 / 2.0))


@dataclass(frozen=True, slots=True)
class CalibratorReading:
    """What a recording of an acoustic calibrator says about the chain."""

    pa_per_count: float
    frequency_hz: float
    level_spread_db: float
    tone_to_rest_db: float


def read_calibrator(counts: ArrayLike, rate_hz: float, level: float = 94.0) -> CalibratorReading:
    """Determine Pa per count from a recording of an acoustic calibrator.

    Parameters
    ----------
    counts : array_like, shape (n,)
        Recorded counts, at least half a second.
    rate_hz : float
        Sampling rate, Hz.
    level : float
        Level of the calibrator, dB re 20 uPa (94 dB = 1.00 Pa rms).

    Returns
    -------
    CalibratorReading
        Factor, frequency of the tone, spread of the frame levels (dB) and tone-to-rest ratio (dB): a reading
        with a spread above 0.1 dB or a ratio below 40 dB should not be accepted.

    Raises
    ------
    ValueError
        The recording is too short or silent.
    """
    samples = np.asarray(counts)
    if samples.shape[0] < rate_hz / 2:
        raise ValueError(
            f"calibrator recording: {samples.shape[0] / rate_hz:.2f} s is too short. Record at least 0.5 s"
        )
    spec = spectrogram(samples, rate_hz, fft_size=4096, hop=2048)
    mean = spec.power.mean(axis=0, dtype=np.float64)
    k = int(np.argmax(mean[2:-2])) + 2
    if mean[k] <= 0:
        raise ValueError("calibrator recording: all samples are zero. Check that the microphone is connected")
    peaks = [interpolate_peak(frame, k) for frame in spec.power]
    ms = np.array([p for _, p in peaks])
    tone = float(ms.mean())
    lines = np.arange(mean.size)
    rest = float(mean[(lines > 2) & (np.abs(lines - k) > 8)].sum()) / HANN_NOISE_BANDWIDTH
    factor = float(np.sqrt(mean_square_pa2(level) / tone))
    return CalibratorReading(
        pa_per_count=factor,
        frequency_hz=float(np.mean([f for f, _ in peaks])) * rate_hz / 4096,
        level_spread_db=float(np.ptp(10.0 * np.log10(ms))),
        tone_to_rest_db=float(10.0 * np.log10(tone / max(rest, 1e-12 * tone))),
    )


def clipped_share(counts: NDArray[np.integer]) -> float:
    """Share of samples (0...1) at the end of the converter's range. `counts` is a signed integer array."""
    if counts.size == 0:
        return 0.0
    info = np.iinfo(counts.dtype)
    low, high = int(counts.min()), int(counts.max())
    if low > info.min + 1 and high < info.max:
        return 0.0
    return float(np.count_nonzero((counts >= info.max) | (counts <= info.min + 1)) / counts.size)

"""Sound levels of a calibrated signal: Leq, Fast and Slow time weighting, levels in bands.

Job: IEC 61672-1 quantities of one stretch of sound pressure.
NOT its job: calibration of counts (`calibration`), narrow-band events (`squeal`).
"""

from typing import Literal

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from rigctl.signals.calibration import level_db
from rigctl.signals.spectra import band_mean_square, spectrogram
from rigctl.signals.weighting import Weighting, apply_weighting, weighting_gain

TIME_CONSTANT_S = {"F": 0.125, "S": 1.0}


@numba.njit(cache=True, nogil=True)
def _square_sums(samples, scale, offset, alpha, start, stop):
    """Sum of squares over [start, stop) and the largest exponential mean square there (state runs from 0)."""
    total = 0.0
    state = 0.0
    largest = 0.0
    for i in range(samples.shape[0]):
        value = samples[i] * scale - offset
        square = value * value
        state += alpha * (square - state)
        if start <= i < stop:
            total += square
            largest = max(largest, state)
    return total, largest


def leq_and_lmax_db(
    samples: ArrayLike,
    rate_hz: float,
    *,
    scale: float = 1.0,
    start: int = 0,
    stop: int | None = None,
    time_weighting: Literal["F", "S"] = "F",
) -> tuple[float, float]:
    """Equivalent level and maximum time-weighted level of a stretch of sound, in one pass.

    Parameters
    ----------
    samples : array_like, shape (n,)
        Counts or Pa.
    rate_hz : float
        Sampling rate, Hz.
    scale : float
        Pa per sample unit.
    start, stop : int
        The stretch, samples; the exponential average has run since sample 0.
    time_weighting : {"F", "S"}
        F: 0.125 s, S: 1 s (IEC 61672-1 5.8).

    Returns
    -------
    leq_db, lmax_db : float
        dB re 20 uPa. The mean of all samples (offset of the converter) is removed first.

    Raises
    ------
    ValueError
        The stretch holds no sample.
    """
    x = np.ascontiguousarray(samples)
    end = x.shape[0] if stop is None else min(stop, x.shape[0])
    if not 0 <= start < end:
        raise ValueError(
            f"stretch [{start}, {end}) of {x.shape[0]} samples is empty. Give start < stop inside the signal"
        )
    offset = float(x.mean(dtype=np.float64)) * scale
    # y[n] = y[n-1] + (1 - exp(-1/(fs tau))) (p^2[n] - y[n-1])
    alpha = -np.expm1(-1.0 / (rate_hz * TIME_CONSTANT_S[time_weighting]))
    total, largest = _square_sums(x, float(scale), offset, float(alpha), start, end)
    return float(level_db(total / (end - start))), float(level_db(largest))


def weighted_levels_db(
    pressure_pa: ArrayLike,
    rate_hz: float,
    weighting: Weighting = "A",
    time_weighting: Literal["F", "S"] = "F",
) -> tuple[float, float]:
    """Leq and Lmax of a frequency-weighted signal (LAeq, LAFmax by default), dB; see `leq_and_lmax_db`."""
    return leq_and_lmax_db(
        apply_weighting(pressure_pa, rate_hz, weighting), rate_hz, time_weighting=time_weighting
    )


def time_weighted_db(
    pressure_pa: ArrayLike, rate_hz: float, time_weighting: Literal["F", "S"] = "F"
) -> NDArray[np.float64]:
    """Course of the time-weighted level, dB re 20 uPa, shape (n,)."""
    x = np.asarray(pressure_pa, dtype=np.float64)
    alpha = float(-np.expm1(-1.0 / (rate_hz * TIME_CONSTANT_S[time_weighting])))
    return level_db(_exponential(x * x, alpha))


@numba.njit(cache=True, nogil=True)
def _exponential(square, alpha):
    out = np.empty_like(square)
    state = 0.0
    for i in range(square.shape[0]):
        state += alpha * (square[i] - state)
        out[i] = state
    return out


def band_levels_db(
    pressure_pa: ArrayLike,
    rate_hz: float,
    bands_hz: list[tuple[float, float]],
    weighting: Weighting = "Z",
    fft_size: int = 4096,
) -> list[float]:
    """Equivalent level per frequency band, dB re 20 uPa (Welch average, Hann, 50 % overlap)."""
    spec = spectrogram(pressure_pa, rate_hz, fft_size=fft_size, hop=fft_size // 2)
    gain = weighting_gain(spec.frequency_hz(), weighting)
    return [float(level_db(band_mean_square(spec, low, high, gain))) for low, high in bands_hz]


def third_octave_bands_hz(low_hz: float, high_hz: float) -> list[tuple[float, float, float]]:
    """Third-octave bands (lower edge, mid, upper edge) whose exact mid-band frequency lies in the range.

    Mid-band 1000 * 10**(n / 10) Hz (IEC 61260-1, base ten).
    """
    first = int(np.ceil(10.0 * np.log10(low_hz / 1000.0) - 1e-9))
    last = int(np.floor(10.0 * np.log10(high_hz / 1000.0) + 1e-9))
    edge = 10.0**0.05
    return [(m / edge, m, m * edge) for m in (1000.0 * 10.0 ** (n / 10.0) for n in range(first, last + 1))]

"""Frequency weightings A, C and Z of IEC 61672-1, exact, applied in the frequency domain.

Job: the analytic curves of Annex E and their application to spectra and to whole signals.
NOT its job: time weighting and levels (`levels`), filters that run sample by sample: a bilinear A filter at
40 kHz is 4.5 dB wrong at 12.5 kHz, so none is offered.
"""

from typing import Literal

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike, NDArray

Weighting = Literal["A", "C", "Z"]

# Pole frequencies of IEC 61672-1:2013 Annex E, Hz.
F1_HZ = 20.598997
F2_HZ = 107.65265
F3_HZ = 737.86223
F4_HZ = 12194.217


def _a_shape(f_hz: NDArray[np.float64]) -> NDArray[np.float64]:
    f2 = f_hz**2
    return (F4_HZ**2 * f2**2) / (
        (f2 + F1_HZ**2) * np.sqrt(f2 + F2_HZ**2) * np.sqrt(f2 + F3_HZ**2) * (f2 + F4_HZ**2)
    )


def _c_shape(f_hz: NDArray[np.float64]) -> NDArray[np.float64]:
    f2 = f_hz**2
    return (F4_HZ**2 * f2) / ((f2 + F1_HZ**2) * (f2 + F4_HZ**2))


# Normalised so that both curves are exactly 0 dB at 1 kHz (the standard prints the constants as 2.000 and
# 0.062 dB).
_A_AT_1KHZ = float(_a_shape(np.array(1000.0)))
_C_AT_1KHZ = float(_c_shape(np.array(1000.0)))


def weighting_gain(frequency_hz: ArrayLike, weighting: Weighting) -> NDArray[np.float64]:
    """Amplitude gain of a weighting, IEC 61672-1:2013 eqs (E.1) and (E.6).

    Parameters
    ----------
    frequency_hz : array_like, any shape
        Frequencies, Hz, >= 0.
    weighting : {"A", "C", "Z"}

    Returns
    -------
    ndarray, same shape
        Linear amplitude factor, 1 at 1 kHz; 0 at 0 Hz for A and C.

    Raises
    ------
    ValueError
        Unknown weighting.
    """
    f_hz = np.asarray(frequency_hz, dtype=np.float64)
    if weighting == "A":
        return _a_shape(f_hz) / _A_AT_1KHZ
    if weighting == "C":
        return _c_shape(f_hz) / _C_AT_1KHZ
    if weighting == "Z":
        return np.ones_like(f_hz)
    raise ValueError(f"weighting: {weighting!r} is unknown. Use 'A', 'C' or 'Z'")


def weighting_db(frequency_hz: ArrayLike, weighting: Weighting) -> NDArray[np.float64]:
    """Weighting in dB at `frequency_hz` (> 0 Hz); see `weighting_gain`."""
    return 20.0 * np.log10(weighting_gain(frequency_hz, weighting))


def apply_weighting(signal: ArrayLike, rate_hz: float, weighting: Weighting) -> NDArray[np.float32]:
    """Weight a whole signal through its spectrum: exact magnitude, zero phase.

    Parameters
    ----------
    signal : array_like, shape (n,)
        Samples, any unit.
    rate_hz : float
        Sampling rate, Hz.
    weighting : {"A", "C", "Z"}

    Returns
    -------
    ndarray, shape (n,), float32
        The weighted signal. It is zero-padded to twice its length for the transform, so its ends do not wrap.
    """
    x = np.asarray(signal, dtype=np.float32)
    n = x.shape[0]
    if weighting == "Z" or n == 0:
        return x.copy()
    n_fft = int(scipy.fft.next_fast_len(2 * n, real=True))  # pyright: ignore[reportArgumentType]
    gain = weighting_gain(np.fft.rfftfreq(n_fft, 1.0 / rate_hz), weighting).astype(np.float32)
    spectrum = np.asarray(scipy.fft.rfft(x, n_fft)) * gain
    return np.asarray(scipy.fft.irfft(spectrum, n_fft, overwrite_x=True))[:n]

"""Linear-phase anti-alias decimation with zero net delay, for whole signals and for live blocks.

Job: FIR design for an integer factor, block decimation, the streaming decimator with kept state, and a
description of the chain for the metadata of a recording.
NOT its job: resampling to unrelated rates, choosing which channel is decimated (sequences, recording).

Output sample m is the filtered signal at input sample m * factor: the delay of the filter is taken out, so
stored times need no correction; live output comes `delay_s` later. Beyond its ends the signal is continued by
its mirror image. Block and stream add the same products in the same order: their results are equal bit for
bit.
"""

import math
from dataclasses import dataclass
from functools import lru_cache

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray

from rigctl.signals._model import FrozenModel

PASS_BAND_SHARE = 0.8
"""End of the pass-band, as share of the new Nyquist frequency; the stop-band begins at the new Nyquist."""

_DESIGN_ATTENUATION_DB = 90.0
_TILE = 256


class FilterDescription(FrozenModel):
    """The decimation as metadata: what a reader of the file must know about the bandwidth of its samples."""

    kind: str
    factor: int
    rate_in_hz: float
    rate_out_hz: float
    taps: int
    pass_band_hz: float
    pass_band_ripple_db: float
    stop_band_hz: float
    stop_band_attenuation_db: float | None
    delay_s: float
    edges: str


@dataclass(frozen=True, slots=True)
class DecimationFilter:
    """Designed filter: `taps` (shape (n_taps,), odd, symmetric, sum 1) with its measured ripple and
    attenuation.
    """

    factor: int
    taps: NDArray[np.float64]
    ripple_db: float
    attenuation_db: float | None

    @property
    def delay(self) -> int:
        """Delay of the filter, input samples."""
        return (self.taps.shape[0] - 1) // 2

    def describe(self, rate_in_hz: float) -> FilterDescription:
        """Metadata of this filter at an input rate in Hz."""
        out_hz = rate_in_hz / self.factor
        return FilterDescription(
            kind="FIR, linear phase, Kaiser window" if self.factor > 1 else "none",
            factor=self.factor,
            rate_in_hz=rate_in_hz,
            rate_out_hz=out_hz,
            taps=self.taps.shape[0],
            pass_band_hz=PASS_BAND_SHARE * out_hz / 2,
            pass_band_ripple_db=self.ripple_db,
            stop_band_hz=out_hz / 2,
            stop_band_attenuation_db=self.attenuation_db,
            delay_s=0.0,
            edges="mirror image",
        )


@lru_cache(maxsize=32)
def design_decimation(factor: int) -> DecimationFilter:
    """Design the anti-alias filter for an integer factor.

    Kaiser-window FIR: pass-band up to 0.8 of the new Nyquist frequency (ripple < 0.001 dB), stop-band from
    the new Nyquist frequency (attenuation > 80 dB), so nothing folds into any stored frequency. Ripple and
    attenuation are measured on the designed taps. The factor 1 gives the identity.

    Raises
    ------
    ValueError
        Factor outside 1...1000.
    """
    if not 1 <= factor <= 1000:
        raise ValueError(f"decimation factor: {factor} is outside 1...1000. Decimate in stages")
    if factor == 1:
        return DecimationFilter(1, np.ones(1), 0.0, None)
    # Kaiser's formulas for attenuation a (dB) and transition width (share of the input's Nyquist frequency)
    a, width = _DESIGN_ATTENUATION_DB, (1.0 - PASS_BAND_SHARE) / factor
    half = math.ceil((a - 7.95) / (2.285 * math.pi * width) / 2)
    cutoff = (1.0 + PASS_BAND_SHARE) / 2 / factor
    n_taps = 2 * half + 1
    taps = np.sinc(cutoff * np.arange(-half, half + 1)) * np.kaiser(n_taps, 0.1102 * (a - 8.7))
    taps /= taps.sum()
    w = np.linspace(0.0, np.pi, 32 * n_taps + 1)
    gain = np.abs(np.fft.rfft(taps, 64 * n_taps))
    pass_band = gain[w <= PASS_BAND_SHARE * np.pi / factor]
    stop_band = gain[w >= np.pi / factor]
    ripple_db = float(np.max(np.abs(20.0 * np.log10(pass_band))))
    taps.flags.writeable = False
    return DecimationFilter(factor, taps, ripple_db, float(-20.0 * np.log10(stop_band.max())))


@numba.njit(cache=True, nogil=True)
def _filter(phases, taps, factor, out):
    """out[m] = sum_k taps[k] x[m factor + k], with x split into `phases`[k % factor, k // factor].

    Taps outside, outputs inside: the inner loop is contiguous and vectorises without reordering any sum.
    """
    n = out.shape[0]
    for first in range(0, n, _TILE):
        size = min(_TILE, n - first)
        tile = out[first : first + size]
        tile[:] = 0.0
        for k in range(taps.shape[0]):
            tap = taps[k]
            begin = first + k // factor
            row = phases[k % factor, begin : begin + size]
            for i in range(size):
                tile[i] += tap * row[i]


def _run(x: NDArray[np.float64], filt: DecimationFilter, n_out: int) -> NDArray[np.float64]:
    """The first `n_out` outputs of the filter whose first tap meets x[0]."""
    width = (filt.taps.shape[0] - 1) // filt.factor + 1 + n_out
    padded = np.zeros(width * filt.factor)
    used = min(x.shape[0], padded.shape[0])
    padded[:used] = x[:used]
    out = np.empty(n_out)
    _filter(np.ascontiguousarray(padded.reshape(width, filt.factor).T), filt.taps, filt.factor, out)
    return out


def decimate(samples: ArrayLike, factor: int) -> NDArray[np.float32]:
    """Decimate a whole signal.

    Parameters
    ----------
    samples : array_like, shape (n,)
    factor : int

    Returns
    -------
    ndarray, shape (ceil(n / factor),), float32
        Sample m belongs to input sample m * factor.

    Raises
    ------
    ValueError
        Factor outside 1...1000, or samples not one-dimensional.
    """
    x = np.asarray(samples)
    if x.ndim != 1:
        raise ValueError(f"samples: {x.ndim} dimensions. Decimate one channel at a time")
    if factor == 1 or x.shape[0] == 0:
        return x.astype(np.float32)
    filt = design_decimation(factor)
    padded = np.pad(x.astype(np.float64), filt.delay, mode="reflect")
    return _run(padded, filt, -(-x.shape[0] // factor)).astype(np.float32)


class StreamingDecimator:
    """Decimate a signal that arrives in blocks; `push` all blocks, then `flush` once: equal to `decimate`.

    Holds at most one filter length and one block of samples. Output lags the input by `delay_s`.
    """

    def __init__(self, factor: int) -> None:
        self._filter = design_decimation(factor)
        self._pending = np.empty(0)
        self._received = 0
        self._emitted = 0
        self._started = False
        self._ended = False

    def delay_s(self, rate_in_hz: float) -> float:
        """How long after an input sample its filtered value is available, s."""
        return self._filter.delay / rate_in_hz

    def push(self, block: ArrayLike) -> NDArray[np.float32]:
        """Take the next samples (shape (n,)); returns the outputs that have become complete (shape (m,),
        float32).

        Raises
        ------
        RuntimeError
            After `flush`.
        """
        if self._ended:
            raise RuntimeError("stream is flushed. Start a new StreamingDecimator")
        x = np.asarray(block, dtype=np.float64)
        self._received += x.shape[0]
        self._pending = np.concatenate((self._pending, x))
        delay = self._filter.delay
        if not self._started:
            if self._pending.shape[0] <= delay:
                return np.empty(0, np.float32)
            mirror = self._pending[1 : delay + 1][::-1]
            self._pending = np.concatenate((mirror, self._pending))
            self._started = True
        return self._emit((self._pending.shape[0] - self._filter.taps.shape[0]) // self._filter.factor + 1)

    def flush(self) -> NDArray[np.float32]:
        """End the stream: returns the remaining outputs, the signal continued by its mirror image."""
        if self._ended:
            return np.empty(0, np.float32)
        self._ended = True
        delay = self._filter.delay
        if self._received == 0:
            return np.empty(0, np.float32)
        if not self._started:
            self._pending = np.pad(self._pending, delay, mode="reflect")
        elif delay:
            self._pending = np.concatenate((self._pending, self._pending[-delay - 1 : -1][::-1]))
        return self._emit(-(-self._received // self._filter.factor) - self._emitted)

    def _emit(self, n_out: int) -> NDArray[np.float32]:
        if n_out <= 0:
            return np.empty(0, np.float32)
        out = _run(self._pending, self._filter, n_out).astype(np.float32)
        self._pending = self._pending[n_out * self._filter.factor :]
        self._emitted += n_out
        return out

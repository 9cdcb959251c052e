"""Fast sound levels of sound that arrives in pieces: LZF and LAF every few milliseconds.

Job: the exponential average of IEC 61672-1 (125 ms) of the pressure, unweighted and A-weighted; the A
weighting is the exact curve, applied in the frequency domain. Tests hold it against
`rigctl.signals.levels`. Plain numpy, no Qt. Not its job: calibration of counts.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigctl.gui.live.stft import level_db

FAST_S = 0.125
STEP_S = 0.005
"""Levels are given so often; in between the average moves by 0.2 dB at most."""
SETTLING_S = 0.25
"""After a gap the averages rise from nothing; levels are given once they are within 0.6 dB of the truth."""
_CHUNKS = 10
_TAPS = 4096
_MEAN_S = 1.0
_JOIN_S = 0.002
_POLES_HZ = (20.598997, 107.65265, 737.86223, 12194.217)  # IEC 61672-1:2013 Annex E


def a_gain(frequency_hz: NDArray[np.floating]) -> NDArray[np.float64]:
    """Amplitude gain of the A weighting, 1 at 1 kHz; IEC 61672-1:2013 eq. (E.6)."""

    def shape(f_hz: NDArray[np.floating]) -> NDArray[np.float64]:
        f1, f2, f3, f4 = (pole**2 for pole in _POLES_HZ)
        f = np.asarray(f_hz, np.float64) ** 2
        return f4 * f**2 / ((f + f1) * np.sqrt((f + f2) * (f + f3)) * (f + f4))

    return shape(frequency_hz) / shape(np.array(1000.0))


@dataclass(frozen=True, slots=True)
class Levels:
    """Levels at the ends of steps; the first at `t_s`, dB re 20 µPa, shape (n,)."""

    t_s: float
    lzf_db: NDArray[np.floating]
    laf_db: NDArray[np.floating]


class _Average:
    """Exponential mean square, exact at the end of each step."""

    def __init__(self, rate_hz: float, step: int) -> None:
        decay = np.exp(-1.0 / (rate_hz * FAST_S))
        self._weights = (1.0 - decay) * decay ** np.arange(step - 1, -1, -1, dtype=np.float64)
        self._over_step = float(decay**step)
        self.state = 0.0

    def feed(self, steps: NDArray[np.floating]) -> NDArray[np.float64]:
        """Samples, shape (n, step); mean square after each step, shape (n,)."""
        out = np.square(steps, dtype=np.float64) @ self._weights
        for i in range(len(out)):
            self.state = self.state * self._over_step + out[i]
            out[i] = self.state
        return out


class LevelMeter:
    """Feeds on pressure, gives levels.

    Parameters
    ----------
    rate_hz : float
    """

    def __init__(self, rate_hz: float) -> None:
        self.rate_hz = float(rate_hz)
        self.step = max(round(rate_hz * STEP_S), 1)
        self.levels_hz = rate_hz / self.step
        self._advance = self.step * _CHUNKS
        self._size = 1 << (_TAPS + self._advance - 1).bit_length()
        self._gain = self._filter()
        self._begin(0.0)

    def _filter(self) -> NDArray[np.complex64]:
        """Spectrum of a linear-phase filter of `_TAPS` taps with the exact curve's magnitude."""
        gain = a_gain(np.fft.rfftfreq(_TAPS, 1.0 / self.rate_hz))
        taps = np.roll(np.fft.irfft(gain), _TAPS // 2) * np.hanning(_TAPS + 1)[:-1]
        return np.fft.rfft(taps, self._size).astype(np.complex64)

    def _begin(self, t_s: float) -> None:
        self._tail = np.zeros(0, np.float32)
        self._tail_s = self._begin_s = t_s
        # Silence before the first sample: the weighted sound comes half the taps later than the plain one.
        self._past = np.zeros(_TAPS, np.float32)
        self._mean: float | None = None
        self._z = _Average(self.rate_hz, self.step)
        self._a = _Average(self.rate_hz, self.step)

    def feed(self, t_s: float, pascal: NDArray[np.floating]) -> Levels:
        """Samples that begin at `t_s`; levels that can be given now. After a gap all begins anew."""
        samples = np.asarray(pascal, np.float32)
        if np.isnan(samples).any():
            samples = np.nan_to_num(samples)
        expected_s = self._tail_s + len(self._tail) / self.rate_hz
        if abs(t_s - expected_s) > _JOIN_S:
            self._begin(t_s)
        samples = np.concatenate([self._tail, samples])
        rounds = len(samples) // self._advance
        used = rounds * self._advance
        start_s = self._tail_s + (self.step - _TAPS // 2) / self.rate_hz
        self._tail = samples[used:]
        self._tail_s += used / self.rate_hz
        plain, weighted = [np.empty(0)], [np.empty(0)]
        for piece in samples[:used].reshape(rounds, self._advance):
            z, a = self._round(piece)
            plain.append(z)
            weighted.append(a)
        before = max(int(np.ceil((self._begin_s + SETTLING_S - start_s) * self.levels_hz)), 0)
        return Levels(
            start_s + before / self.levels_hz,
            level_db(np.concatenate(plain)[before:]),
            level_db(np.concatenate(weighted)[before:]),
        )

    def _round(self, piece: NDArray[np.float32]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """One advance: mean square of the plain and the weighted sound, both late by half the taps."""
        mean = float(piece.mean(dtype=np.float64))
        share = -np.expm1(-len(piece) / (self.rate_hz * _MEAN_S))
        self._mean = mean if self._mean is None else self._mean + share * (mean - self._mean)
        line = np.concatenate([self._past, piece - np.float32(self._mean)])
        weighted = np.fft.irfft(np.fft.rfft(line, self._size) * self._gain, self._size)
        weighted = weighted[_TAPS : _TAPS + len(piece)]
        begin = _TAPS - _TAPS // 2
        plain = line[begin : begin + len(piece)]
        self._past = line[len(piece) :]
        return self._z.feed(plain.reshape(-1, self.step)), self._a.feed(weighted.reshape(-1, self.step))

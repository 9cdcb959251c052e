"""Short-time spectra of sound that arrives in pieces, and their rolling history.

Job: frames, Hann window, power per line as in `rigctl.signals.spectra` (a test holds them together; that
module compiles at import, which a window cannot wait for); levels of the last minute for the spectrogram.
Plain numpy, no Qt. Not its job: peaks (`peaks`), colours (`spectrogram`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigctl.core.units import REFERENCE_PRESSURE_PA

_BATCH_FRAMES = 16
_FLOOR_PA2 = 1e-30
_JOIN_S = 0.002

LEVEL_STEP_DB = 0.5
LEVEL_LOWEST_DB = -7.5
"""Stored levels: 0 is "nothing", 1 is the lowest or less, 255 is 119.5 dB or more."""


def level_db(mean_square_pa2: NDArray[np.floating]) -> NDArray[np.floating]:
    """Sound pressure level re 20 µPa of a mean-square pressure, any shape."""
    return 10.0 * np.log10(np.maximum(mean_square_pa2, _FLOOR_PA2) / REFERENCE_PRESSURE_PA**2)


@dataclass(frozen=True, slots=True)
class Frames:
    """Power spectra of consecutive frames.

    Attributes
    ----------
    t_s : float
        Middle of the first frame, rig time.
    power : ndarray, shape (n_frames, n_lines), float32
        Mean square of a tone at that line, Pa²; NaN in frames with invalid samples.
    """

    t_s: float
    power: NDArray[np.float32]


class StreamingSpectrum:
    """Spectra of overlapping frames; keeps the samples that the next frame needs.

    Parameters
    ----------
    rate_hz : float
    fft_size, hop : int
        Length of a frame and step, samples.
    """

    def __init__(self, rate_hz: float, fft_size: int = 4096, hop: int = 2048) -> None:
        self.rate_hz, self.fft_size, self.hop = float(rate_hz), fft_size, hop
        self.line_hz = rate_hz / fft_size
        self.hop_s = hop / rate_hz
        turns = 2.0 * np.pi * np.arange(fft_size) / fft_size
        self._window = (0.5 - 0.5 * np.cos(turns)).astype(np.float32)
        self._scale = np.float32(2.0 / float(self._window.sum(dtype=np.float64)) ** 2)
        self._tail = np.empty(0, np.float32)
        self._tail_s = 0.0

    def feed(self, t_s: float, pascal: NDArray[np.floating]) -> Frames:
        """Samples that begin at `t_s`; the frames that are complete now. After a gap it begins anew."""
        samples = np.asarray(pascal, np.float32)
        expected_s = self._tail_s + len(self._tail) / self.rate_hz
        if len(self._tail) and abs(t_s - expected_s) <= _JOIN_S:
            samples = np.concatenate([self._tail, samples])
        else:
            self._tail_s = t_s
        n = 0 if len(samples) < self.fft_size else 1 + (len(samples) - self.fft_size) // self.hop
        power = np.empty((n, self.fft_size // 2 + 1), np.float32)
        for first in range(0, n, _BATCH_FRAMES):
            part = samples[first * self.hop :]
            frames = np.lib.stride_tricks.sliding_window_view(part, self.fft_size)[:: self.hop]
            self._to_power(frames[:_BATCH_FRAMES], power[first : first + _BATCH_FRAMES])
        made = Frames(self._tail_s + self.fft_size / 2 / self.rate_hz, power)
        self._tail = samples[n * self.hop :].copy()
        self._tail_s += n * self.hop_s
        return made

    def _to_power(self, frames: NDArray[np.float32], out: NDArray[np.float32]) -> None:
        lines = np.fft.rfft(frames * self._window, axis=1)
        np.square(lines.real, out=out)
        out += np.square(lines.imag)
        out *= self._scale
        out[:, 0] *= 0.5
        out[:, -1] *= 0.5


@dataclass(frozen=True, slots=True)
class Picture:
    """Levels of a stretch for drawing: rows are frequency (upwards), columns time; see `to_db`."""

    start_s: float
    column_s: float
    low_hz: float
    row_hz: float
    levels: NDArray[np.uint8]


class SpectrogramHistory:
    """Levels of the frames of the last `history_s`, as steps of half a decibel."""

    def __init__(self, hop_s: float, line_hz: float, lines: int, history_s: float) -> None:
        self.hop_s, self.line_hz = hop_s, line_hz
        self._data = np.zeros((max(int(np.ceil(history_s / hop_s)), 2), lines), np.uint8)
        self._origin_s = 0.0
        self._stop = 0
        self._first = 0

    @property
    def end_s(self) -> float:
        """End of the last frame's column; minus infinity when empty."""
        return -np.inf if self._stop == self._first else self._origin_s + self._stop * self.hop_s

    def append(self, frames: Frames) -> None:
        """Add frames in the order of time; between them and the last ones may be a gap."""
        n, capacity = len(frames.power), len(self._data)
        if not n:
            return
        begin_s = frames.t_s - self.hop_s / 2
        ahead = round((begin_s - self._origin_s) / self.hop_s) - self._stop
        if self._stop == self._first or ahead < 0 or ahead >= capacity:
            self._data.fill(0)
            self._origin_s, self._stop, self._first = begin_s, 0, 0
        elif ahead:
            self._data[(self._stop + np.arange(ahead)) % capacity] = 0
            self._stop += ahead
        steps = (level_db(frames.power[-capacity:]) - LEVEL_LOWEST_DB) / LEVEL_STEP_DB + 1.0
        steps = np.nan_to_num(np.clip(np.rint(steps), 1.0, 255.0), nan=0.0)
        at = (self._stop + max(n - capacity, 0) + np.arange(len(steps))) % capacity
        self._data[at] = steps.astype(np.uint8)
        self._stop += n

    def picture(
        self, from_s: float, to_s: float, band_hz: tuple[float, float], columns: int, rows: int
    ) -> Picture | None:
        """Levels of a stretch and band in at most twice `columns` × `rows` cells, each the largest in it."""
        oldest = max(self._first, self._stop - len(self._data))
        first = max(int(np.floor((from_s - self._origin_s) / self.hop_s)), oldest)
        stop = min(int(np.ceil((to_s - self._origin_s) / self.hop_s)), self._stop)
        low = max(int(np.floor(band_hz[0] / self.line_hz)), 0)
        high = min(int(np.ceil(band_hz[1] / self.line_hz)) + 1, self._data.shape[1])
        if stop <= first or high <= low:
            return None
        wide = max((stop - first) // max(columns, 1), 1)
        tall = max((high - low) // max(rows, 1), 1)
        first -= first % wide  # cells stay where they are while time goes on
        at = np.arange(max(first, oldest), stop) % len(self._data)
        cells = self._data[at, low:high]
        if tall > 1:
            cells = np.maximum.reduceat(cells, np.arange(0, high - low, tall), axis=1)
        if wide > 1:
            begins = np.maximum(np.arange(first, stop, wide), max(first, oldest)) - max(first, oldest)
            cells = np.maximum.reduceat(cells, np.unique(begins), axis=0)
        return Picture(
            self._origin_s + first * self.hop_s, wide * self.hop_s,
            (low - 0.5) * self.line_hz, tall * self.line_hz, np.ascontiguousarray(cells.T),
        )  # fmt: skip

    def column_db(self, t_s: float) -> NDArray[np.floating] | None:
        """Levels of all lines at a time, to half a decibel; None where there is no frame."""
        if not np.isfinite(t_s):
            return None
        column = int(np.floor((t_s - self._origin_s) / self.hop_s))
        if not max(self._first, self._stop - len(self._data)) <= column < self._stop:
            return None
        steps = self._data[column % len(self._data)]
        return LEVEL_LOWEST_DB + (steps.astype(np.float32) - 1.0) * LEVEL_STEP_DB if steps.any() else None

    def value_db(self, t_s: float, frequency_hz: float) -> float:
        """Level at a time and frequency, to half a decibel; NaN where there is none."""
        levels, line = self.column_db(t_s), round(frequency_hz / self.line_hz)
        if levels is None or not 0 <= line < len(levels):
            return float("nan")
        return float(levels[line])

    def copy(self) -> SpectrogramHistory:
        """Independent copy, for a frozen display."""
        twin = object.__new__(SpectrogramHistory)
        twin.__dict__.update(self.__dict__)
        twin._data = self._data.copy()
        return twin


def to_db(step: int) -> float:
    """Decibel of a stored level; NaN for 0."""
    return float("nan") if step == 0 else LEVEL_LOWEST_DB + (step - 1) * LEVEL_STEP_DB

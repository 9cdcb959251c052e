"""Rolling history of one channel with min/max envelopes at every power of two.

Job: append samples at their rig time in O(new samples); read any stretch for a width in pixels in
O(pixels), with every extreme kept. Time is a grid of slots of the channel's rate; NaN is "no valid
sample" and stays a gap. Plain numpy, no Qt. Not its job: where samples come from (`source`), how
envelopes are drawn (`items`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

_TOP_BINS = 64
"""Bins of the coarsest envelope over the whole history, at least."""
_TOLERANCE_S = 0.002
"""A stretch that begins this near to the end of the last one follows without a gap (rounding of times)."""


@dataclass(frozen=True, slots=True)
class Envelope:
    """Least and largest value per bin.

    Attributes
    ----------
    start_s, step_s : float
        Beginning of the first bin and length of each, s of rig time. A bin of one sample begins at its time.
    low, high : ndarray, shape (n,), float32
        NaN where a bin holds no valid sample. The same array when a bin is one sample (`exact`).
    """

    start_s: float
    step_s: float
    low: NDArray[np.float32]
    high: NDArray[np.float32]

    @property
    def exact(self) -> bool:
        """True when every bin is one sample."""
        return self.low is self.high

    def times_s(self) -> NDArray[np.floating]:
        """Time of each sample, or middle of each bin, shape (n,)."""
        shift = 0.0 if self.exact else 0.5
        return self.start_s + (np.arange(len(self.low)) + shift) * self.step_s

    def extremes(self) -> tuple[float, float] | None:
        """Least and largest valid value; None when there is none."""
        valid = ~np.isnan(self.low)
        if not valid.any():
            return None
        return float(self.low[valid].min()), float(self.high[valid].max())


class ChannelHistory:
    """The last `history_s` seconds of one channel.

    Parameters
    ----------
    rate_hz : float
        Slots per second.
    history_s : float
        What can be read back at least.
    """

    def __init__(self, rate_hz: float, history_s: float) -> None:
        self.rate_hz = float(rate_hz)
        self.history_s = float(history_s)
        wanted = max(int(np.ceil(rate_hz * history_s)), 2)
        self._levels = max(1, int(np.ceil(np.log2(max(wanted / _TOP_BINS, 2.0)))))
        self._unit = 1 << self._levels
        self._capacity = (-(-wanted // self._unit) + 3) * self._unit
        values = np.full(self._capacity, np.nan, np.float32)
        self._low = [values]
        self._high = [values]
        for level in range(1, self._levels + 1):
            self._low.append(np.full(self._capacity >> level, np.nan, np.float32))
            self._high.append(np.full(self._capacity >> level, np.nan, np.float32))
        self._origin_s = 0.0
        self._first = 0
        self._stop = 0
        self._empty = True

    # -- state ------------------------------------------------------------------------------------

    @property
    def empty(self) -> bool:
        """True before the first sample."""
        return self._empty

    @property
    def start_s(self) -> float:
        """Time of the oldest sample that can be read."""
        return self._origin_s + self._oldest() / self.rate_hz

    @property
    def end_s(self) -> float:
        """Time after the newest sample; minus infinity when empty."""
        return -np.inf if self._empty else self._origin_s + self._stop / self.rate_hz

    def _oldest(self) -> int:
        # The newest bins of all levels overwrite up to a unit of the oldest slots; reading rounds outwards.
        return max(self._first, self._stop - self._capacity + 2 * self._unit)

    def copy(self) -> ChannelHistory:
        """Independent copy, for a frozen display."""
        twin = object.__new__(ChannelHistory)
        twin.__dict__.update(self.__dict__)
        values = self._low[0].copy()
        twin._low = [values, *(level.copy() for level in self._low[1:])]
        twin._high = [values, *(level.copy() for level in self._high[1:])]
        return twin

    # -- writing ----------------------------------------------------------------------------------

    def append(self, t_s: float, samples: ArrayLike, stride: int = 1) -> None:
        """Add samples that begin at `t_s`.

        Parameters
        ----------
        t_s : float
            Rig time of the first sample. Later than the end of the history: a gap. Earlier: time has begun
            anew (another session), and the history with it.
        samples : array_like, shape (n,)
            Physical values; NaN where not valid.
        stride : int
            Slots per sample; each value is held until the next.
        """
        values = np.asarray(samples, dtype=np.float32)
        if not len(values):
            return
        if stride > 1:
            values = np.repeat(values, stride)
        if self._empty:
            self._begin(t_s)
        ahead = round((t_s - self._origin_s) * self.rate_hz) - self._stop
        tolerance = max(2, round(_TOLERANCE_S * self.rate_hz))
        if ahead < -tolerance:
            self._begin(t_s)
        elif ahead > tolerance:
            self._skip(ahead)
        if len(values) > self._capacity:
            self._skip(len(values) - self._capacity)
            values = values[-self._capacity :]
        self._write(values)

    def _begin(self, t_s: float) -> None:
        for level in (*self._low, *self._high):
            level.fill(np.nan)
        self._origin_s, self._first, self._stop, self._empty = t_s, 0, 0, False

    def _skip(self, slots: int) -> None:
        if slots >= self._capacity:
            end_s = self._origin_s + (self._stop + slots) / self.rate_hz
            self._begin(end_s)
        else:
            self._write(np.full(slots, np.nan, np.float32))

    def _write(self, values: NDArray[np.float32]) -> None:
        at = self._stop % self._capacity
        room = self._capacity - at
        self._fold(at, values[:room])
        if len(values) > room:
            self._fold(0, values[room:])
        self._stop += len(values)

    def _fold(self, at: int, values: NDArray[np.float32]) -> None:
        """Store values without wrap, and bring the bins above them up to date."""
        begin, end = at, at + len(values)
        self._low[0][begin:end] = values
        for level in range(1, self._levels + 1):
            low, high = self._low[level - 1], self._high[level - 1]
            if end & 1:  # the other half of the newest bin is from the last lap of the ring
                low[end] = high[end] = np.nan
            begin, end = begin >> 1, (end + 1) >> 1
            even, odd = slice(2 * begin, 2 * end, 2), slice(2 * begin + 1, 2 * end, 2)
            np.fmin(low[even], low[odd], out=self._low[level][begin:end])
            np.fmax(high[even], high[odd], out=self._high[level][begin:end])

    # -- reading ----------------------------------------------------------------------------------

    def envelope(self, from_s: float, to_s: float, pixels: int) -> Envelope:
        """Envelope of [from_s, to_s]: one to two bins per pixel, single samples when there are fewer.

        Every valid sample of the stretch lies within the bin at its time; both bounds of a bin are samples.
        A bin that is cut by an end of the stretch is given whole.
        """
        first, stop = self._slots(from_s, to_s, 1)
        if stop <= first:
            none = np.empty(0, np.float32)
            return Envelope(from_s, 1.0 / self.rate_hz, none, none)
        level = (max((stop - first) // max(pixels, 1), 1)).bit_length() - 1
        level = min(level, self._levels)
        begin, end = first >> level, ((stop - 1) >> level) + 1
        low = self._take(self._low[level], begin, end)
        high = low if level == 0 else self._take(self._high[level], begin, end)
        step_s = (1 << level) / self.rate_hz
        return Envelope(self._origin_s + begin * step_s, step_s, low, high)

    def extremes(self, from_s: float, to_s: float) -> tuple[float, float] | None:
        """Least and largest valid value of a stretch, rounded outwards to bins; None: there is none."""
        return self.envelope(from_s, to_s, 2 * _TOP_BINS).extremes()

    def value(self, t_s: float) -> float:
        """The sample at a time; NaN when there is none."""
        if self._empty or not np.isfinite(t_s):
            return float("nan")
        slot = round((t_s - self._origin_s) * self.rate_hz)
        if not self._oldest() <= slot < self._stop:
            return float("nan")
        return float(self._low[0][slot % self._capacity])

    def mean(self, from_s: float, to_s: float) -> float:
        """Mean of the valid samples of a stretch; NaN when there is none."""
        first, stop = self._slots(from_s, to_s)
        if stop <= first:
            return float("nan")
        values = self._take(self._low[0], first, stop)
        valid = values[~np.isnan(values)]
        return float(valid.mean(dtype=np.float64)) if len(valid) else float("nan")

    def _slots(self, from_s: float, to_s: float, more: int = 0) -> tuple[int, int]:
        """First slot and the one after the last of a stretch, within what is kept; `more` slots behind it."""
        if self._empty or np.isnan(from_s) or np.isnan(to_s):
            return 0, 0
        oldest, stop = self._oldest(), self._stop
        low, high = (
            np.clip((t_s - self._origin_s) * self.rate_hz, oldest - 2.0, stop + 2.0) for t_s in (from_s, to_s)
        )
        return max(int(np.floor(low)), oldest), min(int(np.ceil(high)) + more, stop)

    @staticmethod
    def _take(ring: NDArray[np.float32], begin: int, end: int) -> NDArray[np.float32]:
        at, n = begin % len(ring), end - begin
        first = min(n, len(ring) - at)
        out = np.empty(n, np.float32)
        out[:first] = ring[at : at + first]
        out[first:] = ring[: n - first]
        return out

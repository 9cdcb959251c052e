"""Clocks of the signal sources against the machine's clock, estimated from when samples arrive.

Job: `ClockFit` turns arrival times of counted samples into "sample number j was taken at host time t", with
the clock's offset and drift; `missing_before` finds samples lost on the way from the arrival times alone.
Not its job: waiting, reading devices, interpolation (`drivers.daq.collector`).

A sample cannot arrive before it was taken: every delay on the way is positive, so the *earliest* arrivals
are the good ones. Of each bin of half a second only the earliest arrival (against the nominal rate) counts;
through those a line is laid that single late bins cannot move (Theil-Sen: median of slopes, then median of
residuals). Jitter of scheduling, queues and USB frames thus falls out instead of being averaged in. What
remains is the constant shortest delay, which the rig file names for each source (`delay_s`).
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]
Int = NDArray[np.int64]

WINDOW_S = 10.0
BIN_S = 0.5
MIN_BINS = 6  # before that the nominal rate holds and only the offset is estimated
MAX_DRIFT = 0.01  # clocks further off are faults, and are reported as such by who uses the fit


@dataclass(frozen=True, slots=True)
class Line:
    """Host time of sample j: ``t0_s + j * period_s``."""

    t0_s: float
    period_s: float

    def host_s(self, number: Float | Int) -> Float:
        """Host times of sample numbers."""
        return self.t0_s + np.asarray(number, np.float64) * self.period_s

    def at(self, number: float) -> float:
        """Host time of one sample."""
        return self.t0_s + number * self.period_s

    def number(self, host_s: Float) -> Float:
        """Sample numbers (with fractions) at host times."""
        return (host_s - self.t0_s) / self.period_s


class ClockFit:
    """Online fit of a counting clock.

    Parameters
    ----------
    rate_hz : float
        Nominal rate.
    window_s, bin_s : float
        Memory of the fit, and the time of which the earliest arrival is taken.
    """

    def __init__(self, rate_hz: float, *, window_s: float = WINDOW_S, bin_s: float = BIN_S) -> None:
        self.nominal_s = 1.0 / rate_hz
        self._per_bin = max(1, round(bin_s * rate_hz))
        # the earliest arrivals of the bins: (bin, sample number, arrival minus nominal time)
        self._bins: deque[tuple[int, int, float]] = deque(maxlen=max(MIN_BINS, round(window_s / bin_s)))
        self._line: Line | None = None
        self._jitter_s = 0.0

    @property
    def line(self) -> Line:
        """The fit.

        Raises
        ------
        ValueError
            Nothing has arrived yet.
        """
        if self._line is None:
            self._line = self._fit()
        return self._line

    @property
    def ready(self) -> bool:
        """Whether anything has arrived."""
        return bool(self._bins)

    @property
    def full(self) -> bool:
        """Whether the window is full, so that the drift can be judged."""
        return len(self._bins) == self._bins.maxlen

    @property
    def drift_ppm(self) -> float:
        """How much faster than nominal the clock counts, in parts per million of the machine's clock."""
        return (self.nominal_s / self.line.period_s - 1.0) * 1e6 if self.ready else 0.0

    @property
    def jitter_s(self) -> float:
        """Largest delay of the newest batch beyond the shortest one."""
        return self._jitter_s

    def recent_rates(self, count: int) -> Float:
        """Rates between the earliest arrivals of the newest finished bins, Hz; fewer at the start."""
        late = [late_s for _, _, late_s in self._bins][:-1][-count - 1 :]
        return 1.0 / self.nominal_s / (1.0 + np.diff(late) / (self._per_bin * self.nominal_s))

    def add(self, numbers: Int, arrivals_s: Float) -> None:
        """Take a batch of samples: their numbers, rising, and when they arrived."""
        if len(numbers) == 0:
            return
        lateness = arrivals_s - numbers * self.nominal_s
        bins = numbers // self._per_bin
        starts = np.flatnonzero(np.diff(bins, prepend=bins[0] - 1))
        for start, stop in zip(starts, [*starts[1:], len(bins)], strict=True):
            best = int(start + np.argmin(lateness[start:stop]))
            self._take(int(bins[best]), int(numbers[best]), float(lateness[best]))
        self._jitter_s = float(np.max(arrivals_s - self.line.host_s(numbers)))

    def _take(self, at: int, number: int, lateness_s: float) -> None:
        if self._bins and self._bins[-1][0] == at:
            if lateness_s < self._bins[-1][2]:
                self._bins[-1] = (at, number, lateness_s)
                if len(self._bins) <= MIN_BINS:  # otherwise the fit leaves the newest bin out
                    self._line = None
        else:
            self._bins.append((at, number, lateness_s))
            self._line = None

    def _fit(self) -> Line:
        if not self._bins:
            raise ValueError("no sample has arrived yet")
        # the newest bin is not finished: its earliest arrival may still come
        bins = list(self._bins)[:-1] if len(self._bins) > MIN_BINS else list(self._bins)
        numbers = np.array([number for _, number, _ in bins], np.float64)
        lateness = np.array([late for _, _, late in bins])
        slope = 0.0
        if len(bins) >= MIN_BINS:
            first, second = np.triu_indices(len(bins), 1)
            apart = numbers[second] - numbers[first]
            far = apart >= self._per_bin  # neighbours may be almost the same sample
            slopes = (lateness[second] - lateness[first])[far] / apart[far]
            limit = MAX_DRIFT * self.nominal_s
            slope = float(np.clip(np.median(slopes), -limit, limit)) if len(slopes) else 0.0
            offset = float(np.median(lateness - slope * numbers))
        else:
            offset = float(lateness.min())
        return Line(offset, self.nominal_s + slope)


def missing_before(lateness_s: Float, period_s: float, *, threshold: float = 0.75) -> Int:
    """How many samples are missing before each of a batch, from their lateness alone.

    Parameters
    ----------
    lateness_s : ndarray, shape (n,)
        Arrival minus the host time that the clock gives for the sample, numbered without gaps.
    period_s : float
        Of the samples.
    threshold : float
        Share of a period by which *all* later samples must be late before a sample is called missing.

    Returns
    -------
    ndarray of int64, shape (n,)
        Samples missing between the start of the batch and each sample: never falling. A delay that passes
        (a stalled reader, a full bus) gives 0, since one of the later samples is on time again.
    """
    if len(lateness_s) == 0:
        return np.zeros(0, np.int64)
    later = np.minimum.accumulate(lateness_s[::-1])[::-1]
    return np.maximum(np.floor(later / period_s + (1.0 - threshold)), 0.0).astype(np.int64)

"""Samples of one slow source, numbered by its clock and laid on the grid of the blocks.

Job: number samples (finding lost and doubled ones), fit the source's clock, interpolate at asked host times,
mark what is missing as invalid (NaN). Not its job: waiting and the rig's time (`drivers.daq.acquisition`).

Nothing is invented: a grid point gets a value only between two valid samples that follow each other (or are
not further apart than the source's `bridge_s`), or, for a source that is held, while its newest reading is
not older than `hold_s`.
"""

# numpy's stubs are partly unknown in some of its versions:
# pyright: reportUnknownMemberType=false

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from drivers.daq.clock import ClockFit, missing_before
from drivers.daq.source import Source

SETTLE_S = 0.02
"""Samples of counting clocks wait so long before they are numbered: what comes after them within this time
tells a late sample from a lost one."""
SUSPECT_S = 0.09
"""... and so long where all later ones are late by a period or more: lost, or a stalled machine?"""
THRESHOLD = 0.75  # share of a period
LATE_S = 2.0
"""Samples given up may still come for so long; after that, one too many is a doubled one."""
WARM_S = 0.5


@dataclass(frozen=True, slots=True)
class ClockState:
    """What is known of a source's clock.

    Attributes
    ----------
    offset_s : float
        Rig time of the clock's first sample (counting clocks).
    drift_ppm : float
        How much faster it counts than the rig's master clock.
    jitter_s : float
        Largest delay of arrival beyond the shortest one in the newest batch.
    samples, lost, late, doubled : int
        Since it was opened. Late ones came after they had been given up: they are in no block.
    """

    offset_s: float
    drift_ppm: float
    jitter_s: float
    samples: int
    lost: int
    late: int
    doubled: int

    def to_mapping(self) -> dict[str, Any]:
        """For the board and the record."""
        return {
            "offset_ms": round(1e3 * self.offset_s, 3),
            "drift_ppm": round(self.drift_ppm, 1),
            "jitter_ms": round(1e3 * self.jitter_s, 3),
            "samples": self.samples, "lost": self.lost, "late": self.late, "doubled": self.doubled,
        }  # fmt: skip


class Collector:
    """Takes the samples of a source and gives values on a grid.

    Parameters
    ----------
    source : Source
        Open.
    now_s : float
        Host time.
    """

    def __init__(self, source: Source, now_s: float) -> None:
        self.source = source
        self.samples = self.lost = self.late = self.doubled = 0
        self._given_up = 0  # samples counted as lost lately, and when
        self._given_up_s = float("-inf")
        self.last_arrival_s = now_s
        self.fit = ClockFit(source.rate_hz) if source.counted else None
        self._since_s: float | None = None
        self._next = 0
        self._arrivals: NDArray[np.float64] = np.zeros(0)  # not settled yet
        self._raw: NDArray[np.float64] = np.zeros((0, 0))
        columns = len(source.channels())
        self._x: NDArray[np.float64] = np.zeros(0)  # sample numbers, or host times
        self._y: NDArray[np.float64] = np.zeros((0, columns))

    def update(self, now_s: float) -> None:
        """Take what has arrived. Raises the source's `DeviceError`."""
        self.source.check()
        taken = self.source.take()
        n = len(taken.arrivals_s)
        if n:
            self.samples += n
            self.last_arrival_s = float(taken.arrivals_s[-1])
            if self._since_s is None:
                self._since_s = float(taken.arrivals_s[0])
            fresh = len(self._arrivals) == 0
            self._raw = taken.values if fresh else np.concatenate((self._raw, taken.values))
            self._arrivals = taken.arrivals_s if fresh else np.concatenate((self._arrivals, taken.arrivals_s))
        if self.fit is None:
            if n:
                self._keep(self._arrivals.copy(), *self._cut(len(self._arrivals)))
            return
        settled = int(np.searchsorted(self._arrivals, now_s - SETTLE_S, side="right"))
        if settled:
            self._number(self.fit, settled, now_s)

    @property
    def warm(self) -> bool:
        """Whether it has delivered long enough to know its clock."""
        return (
            self._since_s is not None and self.last_arrival_s - self._since_s >= WARM_S and len(self._x) > 0
        )

    def silent_s(self, now_s: float) -> float:
        """Time since the newest sample arrived."""
        return now_s - self.last_arrival_s

    @property
    def settled_after_s(self) -> float:
        """How long after a host time its value is settled, when nothing is late."""
        if self.source.interpolation == "hold":
            return 0.0
        usual_s = self.source.settings.delay_s + 1.0 / self.source.rate_hz
        return usual_s if self.fit is None else usual_s + SETTLE_S

    def covers(self, host_s: float) -> bool:
        """Whether the value at a host time is settled."""
        if self.source.interpolation == "hold":
            return True
        return len(self._x) > 0 and self._x[-1] > self._position(np.array([host_s]))[0]

    def lay(self, host_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Values at host times, shape (n, channels), NaN where there are none. Earlier ones are forgotten."""
        at = self._position(host_s)
        x, y = self._x, self._y
        if len(x) == 0:
            return np.full((len(at), y.shape[1]), np.nan)
        right = np.searchsorted(x, at, side="right")
        left = right - 1
        valid = left >= 0
        left_in = np.maximum(left, 0)
        if self.source.interpolation == "hold":
            out = y[left_in]
            valid &= at - x[left_in] <= self.source.hold_s
        else:
            valid &= right < len(x)
            right_in = np.minimum(right, len(x) - 1)
            apart = x[right_in] - x[left_in]
            settings = self.source.settings
            rate = self.source.rate_hz if self.source.counted else 1.0
            usual = 1.0 if self.source.counted else 1.0 / self.source.rate_hz
            valid &= apart <= max(1.01 * usual, settings.bridge_s * rate + usual)
            share = (at - x[left_in]) / np.where(apart > 0.0, apart, 1.0)
            out = y[left_in] + share[:, None] * (y[right_in] - y[left_in])
        out = np.where(valid[:, None], out, np.nan)
        if len(left):
            keep = max(0, int(left[-1]))
            self._x, self._y = x[keep:], y[keep:]
        return out

    def state(self, master_drift_ppm: float, origin_s: float) -> ClockState:
        """Of the clock: drift against the master, offset against the rig's time zero at host `origin_s`."""
        if self.fit is None or not self.fit.ready:
            return ClockState(0.0, 0.0, 0.0, self.samples, self.lost, self.late, self.doubled)
        return ClockState(
            self.fit.line.at(0.0) - self.source.settings.delay_s - origin_s,
            self.fit.drift_ppm - master_drift_ppm,
            self.fit.jitter_s,
            self.samples,
            self.lost,
            self.late,
            self.doubled,
        )

    def _position(self, host_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where host times lie on the axis of the samples."""
        shifted = host_s + self.source.settings.delay_s
        return shifted if self.fit is None or not self.fit.ready else self.fit.line.number(shifted)

    def _cut(self, count: int) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Take the oldest `count` off what is not settled: (numbers without gaps, raw values)."""
        raw = self._raw[:count]
        self._raw, self._arrivals = self._raw[count:], self._arrivals[count:]
        return self._next + np.arange(count, dtype=np.int64), raw

    def _number(self, fit: ClockFit, settled: int, now_s: float) -> None:
        waiting = self._arrivals
        numbers = self._next + np.arange(len(waiting), dtype=np.int64)
        if self.warm and fit.ready:
            period_s = fit.line.period_s
            lateness = waiting - fit.line.host_s(numbers)
            missing = missing_before(lateness, period_s, threshold=THRESHOLD)
            suspect = (missing > 0) & (waiting > now_s - SUSPECT_S)
            if suspect.any():
                settled = min(settled, int(np.argmax(suspect)))
            # nothing arrives early: from such a sample on, a doubled one has been counted
            early = np.floor((missing * period_s - lateness) / period_s + 1.0 - THRESHOLD)
            numbers += missing - np.maximum.accumulate(np.maximum(early, 0.0)).astype(np.int64)
        if settled == 0:
            return
        arrivals = waiting[:settled]
        numbers = numbers[:settled]
        _, raw = self._cut(settled)
        highest = np.maximum.accumulate(np.concatenate(([self._next - 1], numbers)))[:-1]
        good = numbers > highest
        repeated = int(np.count_nonzero(~good))
        numbers, raw, arrivals = numbers[good], raw[good], arrivals[good]
        missing = int(numbers[-1]) + 1 - self._next - len(numbers) if len(numbers) else 0
        self._count(missing, repeated, now_s)
        if len(numbers) == 0:
            return
        self._next = int(numbers[-1]) + 1
        fit.add(numbers, arrivals)
        self._keep(numbers.astype(np.float64), numbers, raw)

    def _count(self, missing: int, repeated: int, now_s: float) -> None:
        """Numbers that never came, and samples beyond the count: those given up just before, or doubled."""
        if missing:
            recent = self._given_up if now_s - self._given_up_s < LATE_S else 0
            self._given_up, self._given_up_s = recent + missing, now_s
            self.lost += missing
        if repeated:
            late = min(repeated, self._given_up) if now_s - self._given_up_s < LATE_S else 0
            self._given_up -= late
            self.lost -= late
            self.late += late
            self.doubled += repeated - late

    def _keep(self, axis: NDArray[np.float64], numbers: NDArray[np.int64], raw: NDArray[np.float64]) -> None:
        x, y = self.source.convert(numbers, raw)
        if self.fit is None:
            x = axis
            self._next += len(axis)
        self._x, self._y = np.concatenate((self._x, x)), np.concatenate((self._y, y))

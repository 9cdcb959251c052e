"""The rig's time: the microphone's count of frames, or the machine's clock where there is no microphone.

Job: relate rig time to host time (`time.monotonic`), say when a block's end is reached, and find out that the
master is silent, has lost frames, or runs at another rate than it was opened with. Sound servers lose frames
without a flag, so loss is found by counting frames against time. Not its job: the sound card
(`drivers.daq.microphone`).
"""

from __future__ import annotations

from collections import deque
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from drivers.daq.clock import ClockFit
from drivers.daq.source import Master
from rigctl.core.errors import DeviceError
from rigctl.core.units import NS_PER_S

WARM_S = 0.5
# A sound server first hands out what waited in its buffers, in a burst: frames come ever earlier until that
# is over, and only then do they tell the clock. A source at a wrong rate does so for ever.
BURST_S, BURST_MAX_S = 0.005, 2.0
# all callbacks of so long are late: frames are missing, and it is not a machine that was busy for a while
GAP_SEEN_S = 2.0
RATE_TOLERANCE = 0.005
# Too fast: the earliest arrivals of so many bins in a row are each earlier, and by more than jitter. A stall
# that ends, or a server that shortens its buffer, makes one step. Too slow: frames may come late for a while.
FAST_BINS, JITTER_SLACK = 3, 0.02
LATE_SLACK_S = 1.0
RATE_AFTER_S = 1.0


class RigTime(Protocol):
    """Rig time against host time."""

    def update(self, now_s: float) -> None:
        """Look at the master. Raises `DeviceError` when it has failed."""
        ...

    def start(self, now_s: float) -> None:
        """Rig time zero is now."""
        ...

    def host_s(self, rig_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """Host times of rig times."""
        ...

    def reached(self, end_ns: int, now_s: float) -> bool:
        """Whether rig time has come to `end_ns`."""
        ...

    @property
    def warm(self) -> bool:
        """Whether the clock is known."""
        ...

    @property
    def drift_ppm(self) -> float:
        """How much faster than the machine's clock it counts."""
        ...


class HostTime:
    """The machine's clock as the rig's time."""

    drift_ppm = 0.0
    warm = True

    def __init__(self) -> None:
        self._origin_s = 0.0

    def update(self, now_s: float) -> None:
        """Nothing to look at."""

    def start(self, now_s: float) -> None:
        """See `RigTime`."""
        self._origin_s = now_s

    def host_s(self, rig_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """See `RigTime`."""
        return self._origin_s + rig_s

    def reached(self, end_ns: int, now_s: float) -> bool:
        """See `RigTime`."""
        return now_s >= self._origin_s + end_ns * 1e-9


class SlidingMinimum:
    """Smallest of the values of the newest `span_s`, at a constant price for each of them."""

    def __init__(self, span_s: float) -> None:
        self._span_s = span_s
        self._times: deque[float] = deque()
        self._candidates: deque[tuple[float, float]] = deque()  # rising: none that a later, smaller one beats

    def add(self, time_s: float, value: float) -> None:
        """Take a value; times rise."""
        times, candidates = self._times, self._candidates
        times.append(time_s)
        while candidates and candidates[-1][1] >= value:
            candidates.pop()
        candidates.append((time_s, value))
        begin_s = time_s - self._span_s
        while times[0] < begin_s:
            times.popleft()
        while candidates[0][0] < begin_s:
            candidates.popleft()

    def __len__(self) -> int:
        return len(self._times)

    @property
    def covered_s(self) -> float:
        """From the oldest to the newest value."""
        return self._times[-1] - self._times[0] if self._times else 0.0

    @property
    def minimum(self) -> float:
        """The smallest value; there must be one."""
        return self._candidates[0][1]


class SoundTime:
    """The microphone's frames as the rig's time.

    Parameters
    ----------
    master : Master
        Open.
    now_s : float
    gap_limit_s : float
        Frames missing for longer than this are a gap.
    max_drift_ppm : float
        A clock further off the machine's clock loses frames all the time.
    """

    def __init__(self, master: Master, now_s: float, *, gap_limit_s: float, max_drift_ppm: float) -> None:
        self._master = master
        self._fit = ClockFit(master.rate_hz)
        self._gap_limit_s = gap_limit_s
        self._max_drift_ppm = max_drift_ppm
        self._begin_s: float | None = None  # of the first frames
        self._earliest_s = float("inf")  # arrival minus nominal time, at the start
        self._steady_from_s = 0.0
        self._first: tuple[int, float] | None = None  # since it has settled
        self._newest: tuple[int, float] = (0, now_s)
        self._lateness = SlidingMinimum(GAP_SEEN_S)
        self.origin = 0

    @property
    def drift_ppm(self) -> float:
        """See `RigTime`."""
        return self._fit.drift_ppm

    @property
    def jitter_s(self) -> float:
        """Delay of callbacks beyond the shortest one."""
        return self._fit.jitter_s

    @property
    def warm(self) -> bool:
        """See `RigTime`."""
        return self._first is not None and self._newest[1] - self._first[1] >= WARM_S

    def update(self, now_s: float) -> None:
        """See `RigTime`."""
        self._master.check()
        frames, arrivals_s = self._master.stamps()
        if len(frames):
            self._newest = (int(frames[-1]), float(arrivals_s[-1]))
            if self._first is None and self._steady(frames, arrivals_s):
                self._first = self._newest
                self._fit = ClockFit(self._master.rate_hz)
            missing = False
            if self._first is not None and self._fit.ready:
                late = arrivals_s - self._fit.line.host_s(frames)
                for arrival_s, late_s in zip(arrivals_s.tolist(), late.tolist(), strict=True):
                    self._lateness.add(arrival_s, late_s)
                missing = bool(late.min() > self._gap_limit_s)
            if not missing:  # the fit must not follow a clock that has lost frames
                self._fit.add(frames, arrivals_s)
            if self._first is not None:
                self._check_rate(*self._first)
                self._check_gap()
        silent_s = now_s - self._master.last_arrival_s()
        if silent_s > self._master.settings.silent_s:
            raise self._error(
                f"has delivered no sound for {silent_s:.2f} s.",
                "Check that it is plugged in, and its server.",
            )

    def start(self, now_s: float) -> None:
        """See `RigTime`."""
        self.origin = self._master.frames()

    def frame(self, rig_ns: int) -> int:
        """Number of the first frame at or after a rig time."""
        return self.origin + -(-rig_ns * round(self._master.rate_hz) // NS_PER_S)

    def host_s(self, rig_s: NDArray[np.float64]) -> NDArray[np.float64]:
        """See `RigTime`."""
        taken = self._fit.line.host_s(self.origin + rig_s * self._master.rate_hz)
        return taken - self._master.settings.delay_s

    def reached(self, end_ns: int, now_s: float) -> bool:
        """See `RigTime`."""
        return self._master.frames() >= self.frame(end_ns)

    def _steady(self, frames: NDArray[np.int64], arrivals_s: NDArray[np.float64]) -> bool:
        """Whether what waited in the server's buffers has come."""
        if self._begin_s is None:
            self._begin_s = float(arrivals_s[0])
        late_s = arrivals_s - frames / self._master.rate_hz
        at = int(np.argmin(late_s))
        if late_s[at] < self._earliest_s - BURST_S:
            self._earliest_s = float(late_s[at])
            self._steady_from_s = float(arrivals_s[at])
        newest_s = self._newest[1]
        return newest_s - self._steady_from_s >= WARM_S or newest_s - self._begin_s >= BURST_MAX_S

    def _check_rate(self, first_frame: int, first_s: float) -> None:
        nominal_hz = self._master.rate_hz
        elapsed_s = self._newest[1] - first_s
        if elapsed_s < RATE_AFTER_S:
            return
        rates = self._fit.recent_rates(FAST_BINS) / nominal_hz
        rate = (self._newest[0] - first_frame) / elapsed_s / nominal_hz
        fast = len(rates) == FAST_BINS and float(rates.min()) > 1.0 + RATE_TOLERANCE + JITTER_SLACK
        if fast or rate < 1.0 - RATE_TOLERANCE - LATE_SLACK_S / elapsed_s:
            raise self._error(
                f"delivers {(np.median(rates) if fast else rate) * nominal_hz:.0f} frames/s instead of "
                f"{nominal_hz:.0f}.",
                "Set rate_hz to the device's own rate.",
            )
        if self._fit.full and abs(self._fit.drift_ppm) > self._max_drift_ppm:
            raise self._error(
                f"drifts by {self._fit.drift_ppm:.0f} ppm against the machine's clock "
                f"(limit {self._max_drift_ppm:.0f} ppm): it loses or doubles frames.",
                "Look for USB errors and overload, or raise max_drift_ppm if its clock is that bad.",
            )

    def _check_gap(self) -> None:
        if len(self._lateness) < 3 or self._lateness.covered_s < 0.8 * GAP_SEEN_S:
            return
        missing_s = self._lateness.minimum
        if missing_s > self._gap_limit_s:
            raise self._error(
                f"has lost {1e3 * missing_s:.0f} ms of sound ({missing_s * self._master.rate_hz:.0f} frames) "
                "without saying so.",
                "The machine is overloaded, or the sound server's buffer too small: raise `latency`.",
            )

    def _error(self, problem: str, remedy: str) -> DeviceError:
        return DeviceError(problem, place=self._master.place, remedy=remedy)

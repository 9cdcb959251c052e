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

WARM_S = 0.5  # what a sound server does at its start says nothing of the clock
# all callbacks of so long are late: frames are missing, and it is not a machine that was busy for a while
GAP_SEEN_S = 2.0
RATE_TOLERANCE = 0.005
# frames may come late for a while (a stalled machine), but not early
EARLY_SLACK_S, LATE_SLACK_S = 0.05, 1.0
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
        self._first: tuple[int, float] | None = None
        self._settled = False
        self._newest: tuple[int, float] = (0, now_s)
        self._lateness: deque[tuple[float, float]] = deque()
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
        return self._first is not None and self._newest[1] - self._first[1] >= 2.0 * WARM_S

    def update(self, now_s: float) -> None:
        """See `RigTime`."""
        self._master.check()
        frames, arrivals_s = self._master.stamps()
        if len(frames):
            if self._first is None:
                self._first = (int(frames[0]), float(arrivals_s[0]))
            self._newest = (int(frames[-1]), float(arrivals_s[-1]))
            if not self._settled and self._newest[1] - self._first[1] >= WARM_S:
                self._settled = True
                self._fit = ClockFit(self._master.rate_hz)
            missing = False
            if self._settled and self._fit.ready:
                late = arrivals_s - self._fit.line.host_s(frames)
                self._lateness.extend(zip(arrivals_s.tolist(), late.tolist(), strict=True))
                missing = bool(late.min() > self._gap_limit_s)
            if not missing:  # the fit must not follow a clock that has lost frames
                self._fit.add(frames, arrivals_s)
            self._check_rate()
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

    def _check_rate(self) -> None:
        assert self._first is not None
        elapsed_s = self._newest[1] - self._first[1]
        if elapsed_s < RATE_AFTER_S:
            return
        rate_hz = (self._newest[0] - self._first[0]) / elapsed_s
        nominal_hz = self._master.rate_hz
        off = rate_hz / nominal_hz - 1.0
        slack_s = EARLY_SLACK_S if off > 0.0 else LATE_SLACK_S
        if abs(off) > RATE_TOLERANCE + slack_s / elapsed_s:
            raise self._error(
                f"delivers {rate_hz:.0f} frames/s instead of {nominal_hz:.0f}.",
                "Set rate_hz to the device's own rate.",
            )
        if self._fit.full and abs(self._fit.drift_ppm) > self._max_drift_ppm:
            raise self._error(
                f"drifts by {self._fit.drift_ppm:.0f} ppm against the machine's clock "
                f"(limit {self._max_drift_ppm:.0f} ppm): it loses or doubles frames.",
                "Look for USB errors and overload, or raise max_drift_ppm if its clock is that bad.",
            )

    def _check_gap(self) -> None:
        newest_s = self._newest[1]
        while self._lateness and self._lateness[0][0] < newest_s - GAP_SEEN_S:
            self._lateness.popleft()
        if len(self._lateness) < 3 or newest_s - self._lateness[0][0] < 0.8 * GAP_SEEN_S:
            return
        missing_s = min(late for _, late in self._lateness)
        if missing_s > self._gap_limit_s:
            raise self._error(
                f"has lost {1e3 * missing_s:.0f} ms of sound ({missing_s * self._master.rate_hz:.0f} frames) "
                "without saying so.",
                "The machine is overloaded, or the sound server's buffer too small: raise `latency`.",
            )

    def _error(self, problem: str, remedy: str) -> DeviceError:
        return DeviceError(problem, place=self._master.place, remedy=remedy)

"""How fast rig time runs against the clock, and when the run will end. No Qt.

Job: a factor over the last seconds, and the end in local time. Not its job: the estimate of what is left
(connection).
"""

from __future__ import annotations

from collections import deque
from datetime import datetime, timedelta

WINDOW_S = 10.0
LEAST_S = 1.0


class Pace:
    """Feed it rig time and the monotonic clock."""

    def __init__(self) -> None:
        self._seen: deque[tuple[float, float]] = deque()

    def see(self, rig_s: float, clock_s: float) -> None:
        """Rig time at a moment of the clock; rig time that runs backwards begins anew."""
        if self._seen and rig_s < self._seen[-1][1]:
            self._seen.clear()
        self._seen.append((clock_s, rig_s))
        while len(self._seen) > 2 and clock_s - self._seen[0][0] > WINDOW_S:
            self._seen.popleft()

    def clear(self) -> None:
        """Another session."""
        self._seen.clear()

    @property
    def factor(self) -> float | None:
        """Seconds of rig time per second of the clock; None before it can be said."""
        if len(self._seen) < 2:
            return None
        (start_clock, start_rig), (end_clock, end_rig) = self._seen[0], self._seen[-1]
        span_s = end_clock - start_clock
        return (end_rig - start_rig) / span_s if span_s >= LEAST_S else None


def end_text(now: datetime, left_s: float) -> str:
    """Local time of the end: "14:05", with the day when it is another one: "Tue 03:20"."""
    end = now + timedelta(seconds=left_s)
    return f"{end:%H:%M}" if end.date() == now.date() else f"{end:%a %H:%M}"

"""The last minute of one value, in few points: least and greatest of each stretch of time. No Qt.

Job: keep what a small trend line needs, however often values come; peaks are kept. Not its job: painting.
"""

from __future__ import annotations

import math
from collections import deque


class Trend:
    """Least and greatest value of each stretch.

    Parameters
    ----------
    span_s : float
        How far back it looks.
    points : int
        Stretches in that span.
    """

    def __init__(self, span_s: float = 60.0, points: int = 120) -> None:
        self.span_s = span_s
        self._step_s = span_s / points
        self._stretches: deque[tuple[int, float, float]] = deque(maxlen=points + 1)
        self._now_s = -math.inf

    def add(self, t_s: float, value: float) -> None:
        """A value at a time; time that runs backwards begins anew, values that are no number leave a gap."""
        if t_s < self._now_s - self._step_s:
            self._stretches.clear()
        self._now_s = t_s
        if not math.isfinite(value):
            return
        number = math.floor(t_s / self._step_s)
        if self._stretches and self._stretches[-1][0] == number:
            _, low, high = self._stretches.pop()
            self._stretches.append((number, min(low, value), max(high, value)))
        else:
            self._stretches.append((number, value, value))

    def clear(self) -> None:
        """Forget everything."""
        self._stretches.clear()
        self._now_s = -math.inf

    def points(self) -> list[tuple[float, float, float]]:
        """(age in s, least, greatest) within the span, oldest first."""
        end = self._now_s
        return [
            (max(end - number * self._step_s, 0.0), low, high)
            for number, low, high in self._stretches
            if end - number * self._step_s <= self.span_s
        ]

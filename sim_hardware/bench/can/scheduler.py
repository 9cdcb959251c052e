"""Timers of all emulated nodes on one time line that somebody else advances.

Job: call what is due, in order of due time, on an absolute grid (a late call does not shift the ones after
it). Not its job: reading a clock or waiting; the bench's thread does that, and tests advance the time
themselves.
"""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Callable

NS_PER_MS = 1_000_000
#: A periodic timer later than this gives its missed calls up instead of making up for them.
MAX_BACKLOG_NS = 250 * NS_PER_MS


class Timer:
    """A call that is due once or every `period_ns`; `cancel` ends it."""

    __slots__ = ("active", "call", "due_ns", "period_ns")

    def __init__(self, due_ns: int, period_ns: int, call: Callable[[int], None]) -> None:
        self.due_ns, self.period_ns, self.call = due_ns, period_ns, call
        self.active = True

    def cancel(self) -> None:
        """It will not be called any more."""
        self.active = False


class Scheduler:
    """All timers.

    Attributes
    ----------
    now_ns : int
        Time of the call under way, or of the last advance.
    skipped : int
        Calls given up because they were too late.
    latest_ns : int
        The largest lateness of a call so far.
    """

    def __init__(self, now_ns: int = 0) -> None:
        self.now_ns = now_ns
        self.skipped = 0
        self.latest_ns = 0
        self._heap: list[tuple[int, int, Timer]] = []
        self._order = itertools.count()

    def every(self, period_ns: int, call: Callable[[int], None]) -> Timer:
        """Call every period, on the grid of whole periods: timers of the same period come together."""
        first_ns = (self.now_ns // period_ns + 1) * period_ns
        return self._push(Timer(first_ns, period_ns, call))

    def after(self, delay_ns: int, call: Callable[[int], None]) -> Timer:
        """Call once."""
        return self._push(Timer(self.now_ns + delay_ns, 0, call))

    def next_due_ns(self) -> int | None:
        """When the next call is due."""
        while self._heap and not self._heap[0][2].active:
            heapq.heappop(self._heap)
        return self._heap[0][0] if self._heap else None

    def advance(self, now_ns: int) -> None:
        """Make all calls that are due until `now_ns`; each hears its own due time."""
        heap = self._heap
        while heap and heap[0][0] <= now_ns:
            due_ns, _, timer = heapq.heappop(heap)
            if not timer.active:
                continue
            self.now_ns = max(self.now_ns, due_ns)
            late_ns = now_ns - due_ns
            self.latest_ns = max(self.latest_ns, late_ns)
            if timer.period_ns:
                timer.due_ns = due_ns + timer.period_ns
                if late_ns > MAX_BACKLOG_NS:
                    missed = late_ns // timer.period_ns
                    self.skipped += missed
                    timer.due_ns += missed * timer.period_ns
                self._push(timer)
            else:
                timer.active = False
            timer.call(due_ns)
        self.now_ns = max(self.now_ns, now_ns)

    def _push(self, timer: Timer) -> Timer:
        heapq.heappush(self._heap, (timer.due_ns, next(self._order), timer))
        return timer

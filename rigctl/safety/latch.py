"""The latch: locked, arming, armed, tripped. What is tripped stays tripped until a person resets it.

Job: the only place where the state changes, and the record of the first cause. Starts locked. Not its job:
when to arm or trip (`rigctl.safety.guard`).

::

    locked --close--> arming --confirm--> armed
      ^                  |                  |
      |<-----open--------+------------------+      (disarm, at rest)
      |                  v                  v
      +<----reset---- tripped <---trip--- (any)
"""

from __future__ import annotations

from enum import Enum
from typing import Final

from rigctl.safety.causes import Cause


class State(Enum):
    """State of the latch. The controller is told "locked" while arming: nothing may move yet."""

    LOCKED = "locked"
    ARMING = "arming"
    ARMED = "armed"
    TRIPPED = "tripped"

    @property
    def told(self) -> str:
        """Word for the controller."""
        return "locked" if self is State.ARMING else self.value


class Latch:
    """State, first cause and further causes."""

    def __init__(self) -> None:
        self.state = State.LOCKED
        self.cause: Cause | None = None
        self.further: dict[str, Cause] = {}

    @property
    def relay_wanted(self) -> bool:
        """Whether the relay is to be closed; edges are sent in these states only."""
        return self.state is State.ARMING or self.state is State.ARMED

    def trip(self, cause: Cause) -> bool:
        """Enter the tripped state. True when this cause is news: the first, or one of another kind."""
        if self.state is State.TRIPPED:
            assert self.cause is not None
            if cause.id == self.cause.id or cause.id in self.further:
                return False
            self.further[cause.id] = cause
            return True
        self.state = State.TRIPPED
        self.cause = cause
        self.further = {}
        return True

    def close(self) -> None:
        """Begin arming."""
        self._step(State.LOCKED, State.ARMING)

    def confirm(self) -> None:
        """The relay has been seen closed for long enough: armed."""
        self._step(State.ARMING, State.ARMED)

    def open(self) -> None:
        """Disarm."""
        if not self.relay_wanted:
            raise RuntimeError(f"cannot disarm in state {self.state.value}")
        self.state = State.LOCKED

    def reset(self) -> None:
        """Acknowledge the trip; the rig is locked, not armed."""
        self._step(State.TRIPPED, State.LOCKED)
        self.cause = None
        self.further = {}

    def _step(self, expected: State, new: State) -> None:
        if self.state is not expected:
            raise RuntimeError(f"cannot go to {new.value} in state {self.state.value}")
        self.state = new


HOUR_S: Final = 3600.0


class ResetBook:
    """How often each cause has been reset within the last hour."""

    def __init__(self, limit_per_hour: int) -> None:
        self._limit = limit_per_hour
        self._times: dict[str, list[float]] = {}

    def add(self, cause_id: str, now_s: float) -> None:
        """A reset of this cause at this time (monotonic clock)."""
        self._times.setdefault(cause_id, []).append(now_s)

    def exhausted(self, cause_id: str, now_s: float) -> bool:
        """Whether this cause has been reset as often as is allowed."""
        recent = [time_s for time_s in self._times.get(cause_id, []) if now_s - time_s < HOUR_S]
        self._times[cause_id] = recent
        return len(recent) >= self._limit

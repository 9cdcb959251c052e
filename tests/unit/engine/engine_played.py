"""Watchdog and recorder as played by the tests of the engine."""

import math
from typing import Any

from rigctl.core.errors import SafetyTrip
from rigctl.engine.guard import Checkpoint


class PlayedGuard:
    """Arms after some blocks; trips when told to. Counts heartbeats and demands that none is missed."""

    def __init__(self) -> None:
        self.state = "locked"
        self.cause: str | None = None
        self.remedy: str | None = None
        self.beats: list[int] = []
        self.setpoints: list[dict[str, Any]] = []
        self.masks: list[Checkpoint] = []
        self.mask = Checkpoint(0)
        self.trip_at = math.inf
        self.disarmed = False
        self.resets: list[tuple[str, str]] = []
        self.refuses_reset = False
        self.reset_refused: tuple[int, str, str] = (0, "", "")

    def arm(self) -> None:
        self.state = "armed"

    def disarm(self) -> None:
        self.disarmed = True
        self.state = "locked"

    def reset(self, who: str, reason: str) -> None:
        self.resets.append((who, reason))
        if self.refuses_reset:
            count = self.reset_refused[0] + 1
            self.reset_refused = (count, "the pressure is not gone.", "Open the vent valve.")
        else:
            self.state, self.cause, self.remedy = "locked", None, None

    def passed(self, checkpoint: Checkpoint) -> None:
        self.mask |= checkpoint

    def update(self, k: int) -> None:
        if k >= self.trip_at:
            self.trip_at = math.inf
            self.state, self.cause, self.remedy = "tripped", "pressure above 41 bar", "Look at the valve."
            raise SafetyTrip("pressure above 41 bar", remedy="Look at the valve.")

    def listen(self, k: int) -> bool:
        return True

    def heartbeat(self, k: int, setpoints: dict[str, Any]) -> None:
        self.beats.append(k)
        self.setpoints.append(setpoints)
        self.masks.append(self.mask)
        self.mask = Checkpoint(0)


class PlayedRecorder:
    """Commits at once; keeps what it was told."""

    def __init__(self) -> None:
        self.log: list[tuple[Any, ...]] = []
        self.events: list[dict[str, Any]] = []
        self.index = 0
        self.blocks = 0
        self.seconds = 0.0

    def begin(self, specification: Any, *, t0_s: float) -> None:
        self.index = specification["index"]
        self.blocks = 0
        self.seconds = 0.0
        self.log.append(("begin", self.index))

    def block(self, block: Any) -> None:
        self.blocks += 1
        self.seconds += block.dt_s

    def mark(self, name: str, t_s: float, **values: Any) -> None:
        self.log.append(("mark", name, values) if values.keys() & {"text", "rating"} else ("mark", name))

    def end(self, status: str = "complete", note: str = "") -> None:
        self.log.append(("end", self.index, status, note))
        self.events.append({"m": "committed", "index": self.index, "status": status, "events": 0})

    def poll(self) -> list[dict[str, Any]]:
        events, self.events = self.events, []
        return events

    def wait_idle(self, timeout_s: float = 60.0) -> None:
        pass

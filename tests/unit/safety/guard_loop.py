"""A controller and a rig around a `Guard`, without processes: what the wire carries, in lockstep."""

from __future__ import annotations

import copy
import itertools
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, settings

from rigctl.core.safety_link import SafetySample
from rigctl.safety.guard import Answer, Guard
from rigctl.safety.heartbeat import CHECKPOINTS, answer_to
from rigctl.safety.latch import ResetBook, State
from rigctl.safety.limits import LoadedLimits, load_limits

CALM = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])  # whatever the machine's load
LIMITS_FILE = Path(__file__).parents[3] / "configs" / "limits" / "a_class.toml"


def raw_limits() -> dict[str, Any]:
    """Content of the shipped limits file, free to be changed."""
    return copy.deepcopy(tomllib.loads(LIMITS_FILE.read_text(encoding="utf-8")))


def loaded_limits() -> LoadedLimits:
    """A fresh copy of the shipped limits (a test may damage it)."""
    return load_limits(LIMITS_FILE)


def sample_at(k: int, **changes: Any) -> SafetySample:
    """A rig at rest, with the unrest of living sensors."""
    unrest = [((k * 5 + i) * 37 % 101) / 1000.0 for i in range(5)]
    sample = SafetySample(
        k=k,
        t_s=(k + 1) * 0.05,
        dt_s=0.05,
        pressure_bar=tuple(0.1 + u for u in unrest),
        speed_rpm=tuple(0.1 + u for u in unrest),
        torque_nm=tuple(1.0 + u for u in unrest),
        temperature_degc=tuple(25.0 + u for u in unrest),
        relay_closed=False,
        drive_enabled=False,
        estop_ok=True,
        doors_ok=True,
    )
    return replace(sample, **changes)


BRAKING = {
    "pressure_bar": (20.0, 20.1, 20.2, 20.1, 20.0),
    "speed_rpm": (40.0, 40.1, 40.0, 39.9, 40.0),
    "torque_nm": (380.0, 381.0, 382.0, 381.0, 380.0),
    "temperature_degc": (120.0, 120.1, 120.2, 120.1, 120.0),
}


class Loop:
    """Lockstep of rig, guard and controller. `block` is one block; the relay follows the answers."""

    def __init__(self, *, lockstep: bool = True, **options: Any) -> None:
        self.loaded = options.pop("loaded", None) or loaded_limits()
        self.limits = self.loaded.limits
        times = self.limits.time
        nonces = itertools.count(1000)
        options.setdefault("resets", ResetBook(self.limits.reset.same_cause_per_hour))
        self.guard = Guard(
            self.loaded,
            times.virtual if lockstep else times.real_without_priority,
            lockstep=lockstep,
            nonce=lambda: next(nonces),
            **options,
        )
        self.k = -1
        self.nonce = 0
        self.relay = False
        self.welded = False
        self.now_s = 100.0
        self.set: dict[str, Any] = {"p": 0.0, "n": 0.0, "enable": False}
        self.answers: list[Answer] = []
        self.notes: list[Any] = []
        self.status: dict[str, Any] = {}

    def heartbeat(self, **changes: Any) -> None:
        """The controller's heartbeat for the newest block."""
        k = changes.get("k", self.k)
        mask = changes.get("mask", CHECKPOINTS)
        message = {
            "m": "hb",
            "k": k,
            "mask": mask,
            "answer": answer_to(changes.pop("nonce", self.nonce), k, mask, self.loaded.hash8),
            "limits": self.loaded.hash8,
            "set": dict(self.set),
        }
        self.guard.on_heartbeat({**message, **changes}, self.now_s)

    def block(self, *, beat: bool = True, **changes: Any) -> Answer:
        """Heartbeat for the block before, then one sample; the relay does what the answer says."""
        if beat and self.k >= 0:
            self.heartbeat()
        self.k += 1
        self.now_s += 0.05
        changes.setdefault("relay_closed", self.relay or self.welded)
        answer = self.guard.on_sample(sample_at(self.k, **changes), self.now_s)
        self.status = self.guard.status(self.k)
        self.nonce = self.status["nonce"]
        self.serve(answer)
        return answer

    def serve(self, answer: Answer | None = None) -> None:
        """What the process does after every input."""
        reason = self.guard.take_open()
        if reason is not None:
            self.relay = False
        elif answer is Answer.CLOSE:
            self.relay = True
        if answer is not None:
            self.answers.append(answer)
        self.notes += self.guard.take_notes()

    def blocks(self, count: int, **changes: Any) -> Answer:
        """Several blocks; the last answer."""
        answer = Answer.HOLD
        for _ in range(count):
            answer = self.block(**changes)
        return answer

    def arm(self) -> Loop:
        """From locked to armed by the whole handshake."""
        self.guard.request_arm()
        for _ in range(60):
            self.block()
            if self.guard.state is State.ARMED:
                return self
        raise AssertionError(f"not armed: {self.status}, {self.notes}")

    def kinds(self) -> list[str]:
        """Kinds of all notes so far."""
        return [note.kind for note in self.notes]

    def note(self, kind: str) -> dict[str, Any]:
        """Payload of the last note of a kind."""
        return dict([note for note in self.notes if note.kind == kind][-1].payload)

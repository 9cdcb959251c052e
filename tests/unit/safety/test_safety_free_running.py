"""Real time on a real rig: samples and the controller's blocks are counted by clocks of their own."""

from __future__ import annotations

import itertools
from typing import Any

import pytest
from guard_loop import BRAKING, loaded_limits, sample_at

from rigctl.safety.guard import ACCEPTED_LAG, Answer, Guard
from rigctl.safety.heartbeat import CHECKPOINTS, answer_to
from rigctl.safety.latch import ResetBook, State

REST = {"p": 0.0, "n": 0.0, "enable": False}


class FreeRig:
    """Watchdog and controller, each with its own period, phase and numbers; time is simulated in ms."""

    def __init__(self, *, first_block: int, block_ms: int = 50, phase_ms: int = 17) -> None:
        self.loaded = loaded_limits()
        times = self.loaded.limits.time.real
        nonces = itertools.count(1)
        self.guard = Guard(
            self.loaded, times, lockstep=False, nonce=lambda: next(nonces), resets=ResetBook(3)
        )
        self.block, self.block_ms, self.phase_ms = first_block, block_ms, phase_ms
        self.ms = 0
        self.k = 0
        self.relay = False
        self.nonces: list[int] = [0]
        self.lag = 0  # nonces by which the controller is behind
        self.beating = True
        self.sent: list[dict[str, Any]] = []
        self.causes: list[str] = []

    @property
    def now_s(self) -> float:
        return 100.0 + self.ms / 1000.0

    def beat(self) -> dict[str, Any]:
        nonce = self.nonces[max(0, len(self.nonces) - 1 - self.lag)]
        answer = answer_to(nonce, self.block, CHECKPOINTS, self.loaded.hash8)
        return {
            "m": "hb", "k": self.block, "mask": CHECKPOINTS, "answer": answer, "limits": self.loaded.hash8,
            "set": REST,
        }  # fmt: skip

    def run(self, ms: int, **changes: Any) -> None:
        """So much time with heartbeats and samples when each is due."""
        for _ in range(ms):
            self.ms += 1
            if self.beating and self.ms % self.block_ms == self.phase_ms:
                message = self.beat()
                self.block += 1
                self.sent.append(message)
                self.guard.on_heartbeat(message, self.now_s)
            if self.ms % 50 == 0:
                answer = self.guard.on_sample(
                    sample_at(self.k, relay_closed=self.relay, **changes), self.now_s
                )
                self.nonces.append(self.guard.status(self.k)["nonce"])
                self.k += 1
                if answer is Answer.CLOSE:
                    self.relay = True
            deadline_s = self.guard.silence_deadline_s()
            if deadline_s is not None and self.now_s >= deadline_s:
                self.guard.on_silence(self.now_s)
            self.serve()

    def serve(self) -> None:
        if self.guard.take_open() is not None:
            self.relay = False
        self.causes += [str(note.payload["cause"]) for note in self.guard.take_notes() if note.kind == "trip"]

    def armed(self) -> FreeRig:
        self.run(300)
        self.guard.request_arm()
        self.run(3000)
        assert self.guard.state is State.ARMED, self.guard.status(self.k)
        return self


@pytest.mark.parametrize("first_block", [0, 3, 100_000])
@pytest.mark.parametrize("phase_ms", [0, 1, 25, 49])
def test_numbers_and_phases_are_independent(first_block: int, phase_ms: int) -> None:
    rig = FreeRig(first_block=first_block, phase_ms=phase_ms).armed()
    rig.run(5000, **BRAKING_UNREST)
    assert rig.guard.state is State.ARMED and rig.causes == []


BRAKING_UNREST = {key: value for key, value in BRAKING.items() if key == "temperature_degc"}


@pytest.mark.parametrize("block_ms", [47, 49, 51, 53])
def test_clocks_may_drift_against_each_other(block_ms: int) -> None:
    rig = FreeRig(first_block=7, block_ms=block_ms).armed()
    rig.run(60_000)
    assert rig.guard.state is State.ARMED and abs(rig.block - rig.k) > 10


@pytest.mark.parametrize("lag", range(ACCEPTED_LAG))
def test_a_controller_may_lag_by_some_nonces(lag: int) -> None:
    rig = FreeRig(first_block=50).armed()
    rig.lag = lag
    rig.run(1000)
    assert rig.guard.state is State.ARMED


def test_a_controller_that_lags_too_far_answers_no_accepted_nonce() -> None:
    rig = FreeRig(first_block=50).armed()
    rig.lag = ACCEPTED_LAG
    rig.run(100)
    assert rig.causes == ["heartbeat_wrong"] and not rig.relay


def test_a_frozen_controller_is_found_by_the_age_of_its_heartbeat() -> None:
    rig = FreeRig(first_block=50).armed()
    rig.beating = False
    window_ms = round(rig.loaded.limits.time.real.heartbeat_s * 1000)
    rig.run(window_ms + 50)
    assert rig.causes == ["heartbeat_late"] and not rig.relay


@pytest.mark.parametrize("number", ["old", "new"])
def test_a_replayed_heartbeat_is_wrong(number: str) -> None:
    rig = FreeRig(first_block=50).armed()
    rig.beating = False
    replayed = dict(rig.sent[-6])
    if number == "new":
        replayed["k"] = rig.block
    rig.guard.on_heartbeat(replayed, rig.now_s)
    rig.serve()
    assert rig.causes == ["heartbeat_wrong"] and not rig.relay


def test_a_burst_of_heartbeats_on_one_nonce_lasts_no_longer_than_the_nonces() -> None:
    """A controller whose loop goes on without reading the watchdog is found within `ACCEPTED_LAG` samples."""
    rig = FreeRig(first_block=50).armed()
    rig.nonces = rig.nonces[-1:]
    stuck = rig.nonces[0]
    for _ in range(ACCEPTED_LAG + 1):
        rig.run(50)
        rig.nonces = [stuck]
    assert rig.causes == ["heartbeat_wrong"]


def test_a_watchdog_that_was_stopped_trips_with_its_first_sample() -> None:
    """What the controller sent meanwhile looks fresh; the watchdog's own absence does not."""
    rig = FreeRig(first_block=50).armed()
    rig.ms += 2000
    message = rig.beat()
    rig.guard.on_heartbeat(message, rig.now_s)
    answer = rig.guard.on_sample(sample_at(rig.k, relay_closed=True), rig.now_s)
    rig.serve()
    assert answer is Answer.OPEN or not rig.relay
    assert rig.causes == ["samples_late"]


def test_no_heartbeat_at_all_never_arms() -> None:
    rig = FreeRig(first_block=0)
    rig.beating = False
    rig.run(500)
    rig.guard.request_arm()
    rig.run(2000)
    assert rig.guard.state is State.LOCKED


def test_a_fault_of_the_channel_is_the_first_cause() -> None:
    rig = FreeRig(first_block=9).armed()
    blind: dict[str, Any] = {
        "channel_fault": "the bus is silent for 60 ms", "estop_ok": False, "doors_ok": False,
        "pressure_bar": (None,) * 5, "speed_rpm": (None,) * 5,
    }  # fmt: skip
    rig.run(50, **blind)
    assert rig.causes == ["safety_channel"]
    cause = rig.guard.cause
    assert cause is not None and "the bus is silent for 60 ms" in cause.words

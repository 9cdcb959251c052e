"""The latch and the kick as properties: any order of events, and what must hold after each."""

from __future__ import annotations

import math

from guard_loop import BRAKING, CALM, Loop
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from rigctl.safety.causes import Cause
from rigctl.safety.guard import Answer
from rigctl.safety.latch import State

BAD_BLOCKS = st.sampled_from(
    [
        {"estop_ok": False},
        {"doors_ok": False},
        {"temperature_degc": (501.0,) * 5},
        {"temperature_degc": (math.nan,) * 5},
        {"pressure_bar": (43.0,) * 5},
        {"speed_rpm": (None,) * 5},
        {"torque_nm": ()},
        {"relay_closed": True},
        {"drive_enabled": True},
        {"dt_s": 3.0},
    ]
)
BAD_BEATS = st.sampled_from(
    [
        {"mask": 3},
        {"answer": 1},
        {"limits": "x"},
        {"k": 0},
        {"k": 10**9},
        {"set": {"p": 45, "n": 0, "enable": True}},
    ]
)


class WatchdogMachine(RuleBasedStateMachine):
    """Blocks good and bad, messages right and wrong, in any order.

    `since_reset` and `since_arm` follow what a person and the controller did, apart from the guard's own
    state: the relay may be closed only after arm was asked for, and after a trip only when reset came first.
    """

    @initialize()
    def start(self) -> None:
        self.loop = Loop()
        self.tripped = False  # a trip was noted and no reset since
        self.asked = False  # arm was asked for since the last trip, reset or disarm
        self.clean = True  # nothing bad was put in since the last block

    def after(self, answer: Answer | None = None) -> None:
        new = self.loop.notes
        self.loop.notes = []
        for note in new:
            if note.kind == "trip":
                assert not self.tripped, "two first causes"
                self.tripped, self.asked = True, False
            elif note.kind == "reset":
                self.tripped, self.asked = False, False
            elif note.kind in ("disarmed", "refused_arm"):
                self.asked = False
        if answer in (Answer.EDGE, Answer.CLOSE):
            assert not self.tripped, "an edge after a trip"
            assert self.clean, "an edge in a block in which something was wrong"
            assert self.asked, "an edge that nobody asked for"
        if answer is not None:
            self.clean = True

    @rule(count=st.integers(1, 30))
    def good_blocks(self, count: int) -> None:
        for _ in range(count):
            self.after(self.loop.block())

    @rule()
    def moving_blocks(self) -> None:
        if self.loop.guard.state is State.ARMED:
            for _ in range(3):
                self.after(self.loop.block(**BRAKING))

    @rule(changes=BAD_BLOCKS)
    def bad_blocks(self, changes: dict) -> None:
        self.after(self.loop.block(**changes))
        self.after(self.loop.block(**changes))

    @rule()
    def block_without_heartbeat(self) -> None:
        self.clean = False
        self.after(self.loop.block(beat=False))

    @rule(changes=BAD_BEATS)
    def bad_heartbeat(self, changes: dict) -> None:
        if self.loop.k < 0:
            return
        self.loop.heartbeat(**changes)
        self.loop.serve()
        self.clean = False
        self.after()
        self.after(self.loop.block(beat=False))

    @rule()
    def arm(self) -> None:
        self.loop.guard.request_arm()
        if self.loop.guard.state is State.LOCKED:
            self.asked = True
        self.loop.serve()
        self.loop.notes = [note for note in self.loop.notes if note.kind != "refused_arm"]
        self.after()

    @rule(count=st.integers(25, 40))
    def arm_and_wait(self, count: int) -> None:
        self.arm()
        self.good_blocks(count)

    @rule()
    def disarm(self) -> None:
        if self.loop.guard.state is State.LOCKED:
            self.asked = False
        self.loop.guard.disarm()
        self.loop.serve()
        self.after()

    @rule(who=st.sampled_from(["A. Person", ""]), reason=st.sampled_from(["checked", ""]))
    def reset(self, who: str, reason: str) -> None:
        before = self.loop.guard.state
        self.loop.guard.reset(who, reason, self.loop.now_s)
        self.loop.serve()
        if before is State.TRIPPED and self.loop.guard.state is State.LOCKED:
            assert who and reason
        elif before is not State.TRIPPED:
            assert self.loop.guard.state is before
        self.after()

    @rule()
    def rest_and_reset(self) -> None:
        self.good_blocks(50)
        self.reset("A. Person", "checked")

    @rule()
    def controller_gone(self) -> None:
        self.loop.guard.controller_gone("killed", self.loop.now_s)
        self.asked = self.asked and self.loop.guard.state is State.ARMED
        self.loop.serve()
        self.after()

    @rule()
    def silence(self) -> None:
        self.loop.now_s += 100.0
        self.loop.guard.on_silence(self.loop.now_s)
        self.loop.serve()
        self.after()

    @precondition(lambda self: self.loop.guard.live)
    @rule()
    def other_trip(self) -> None:
        self.loop.guard.trip(Cause("rig_garbage", detail="x"), self.loop.now_s)
        self.loop.serve()
        self.after()

    @invariant()
    def the_relay_follows_the_state(self) -> None:
        if not hasattr(self, "loop"):
            return
        if self.tripped:
            assert self.loop.guard.state is State.TRIPPED
            assert not self.loop.relay
        if self.loop.guard.state in (State.LOCKED, State.TRIPPED):
            assert not self.loop.relay
            assert self.loop.guard.silence_deadline_s() is None


WatchdogMachine.TestCase.settings = settings(CALM, max_examples=60, stateful_step_count=30)
TestWatchdogMachine = WatchdogMachine.TestCase

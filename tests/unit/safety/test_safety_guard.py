"""The guard: arming handshake, kicks, trips, resets; one condition at a time."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
from guard_loop import BRAKING, LIMITS_FILE, Loop, sample_at

from rigctl.safety import guard as guard_module
from rigctl.safety.causes import Cause
from rigctl.safety.guard import Answer
from rigctl.safety.latch import ResetBook, State
from rigctl.safety.limits import load_limits

REST = {name: (0.0,) * 5 for name in ("pressure_bar", "speed_rpm")}


@pytest.fixture
def armed() -> Loop:
    return Loop().arm()


# -- locked and arming ------------------------------------------------------------------------------


def test_it_starts_locked_and_stays_so_unasked() -> None:
    loop = Loop()
    assert loop.blocks(50) is Answer.HOLD
    assert set(loop.answers) == {Answer.HOLD}
    assert loop.status["state"] == "locked" and loop.status["cause"] is None


def test_the_handshake_closes_once_then_renews_and_arms_after_the_proof() -> None:
    loop = Loop().arm()
    closes = loop.answers.count(Answer.CLOSE)
    edges = loop.answers.count(Answer.EDGE)
    assert (closes, edges) == (1, loop.limits.arming.edges)
    assert loop.answers.index(Answer.CLOSE) >= loop.limits.arming.samples - 1
    assert loop.kinds() == ["relay_closed", "armed"]
    assert loop.status["state"] == "armed"


def test_the_controller_is_told_locked_until_the_relay_is_proven() -> None:
    loop = Loop()
    loop.blocks(10)
    loop.guard.request_arm()
    told = set()
    while loop.guard.state is not State.ARMED:
        loop.block()
        if loop.guard.state is not State.ARMED:
            told.add(loop.status["state"])
    assert told == {"locked"}


def test_arming_waits_for_samples_and_heartbeats_and_says_so() -> None:
    loop = Loop()
    loop.guard.request_arm()
    loop.blocks(2)
    assert loop.status["cause"].startswith("Seen so far: 2 good samples of 5")
    loop.arm()


def test_arming_is_decided_with_the_heartbeat_after_the_request() -> None:
    loop = Loop()
    loop.blocks(10)
    loop.heartbeat()  # read before the request
    loop.guard.request_arm()
    assert loop.block(beat=False) is Answer.HOLD
    assert loop.block() is Answer.CLOSE


def test_arming_needs_heartbeats() -> None:
    loop = Loop()
    loop.blocks(10, beat=False)
    loop.guard.request_arm()
    assert loop.blocks(10, beat=False) is Answer.HOLD
    assert loop.guard.state is State.LOCKED


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"estop_ok": False}, "estop"),
        ({"doors_ok": False}, "doors"),
        ({"temperature_degc": (None,) * 5}, "temperature_invalid"),
        ({"torque_nm": ()}, "torque_stale"),
        ({"dt_s": 9.0}, "samples_clock"),
    ],
)
def test_a_fault_refuses_arming_until_it_is_asked_for_again(changes: dict[str, Any], why: str) -> None:
    loop = Loop()
    loop.blocks(10)
    loop.guard.request_arm()
    loop.block(**changes)
    assert loop.note("refused_arm")["why"] == why
    assert loop.status["cause"] == loop.note("refused_arm")["words"]
    assert loop.blocks(30) is Answer.HOLD  # the fault has gone, the request too
    loop.arm()


@pytest.mark.parametrize("field", ["pressure_bar", "speed_rpm"])
def test_arming_waits_until_the_rig_is_at_rest(field: str) -> None:
    loop = Loop()
    loop.blocks(10)
    loop.guard.request_arm()
    assert loop.blocks(10, **{field: (1.5, 1.4, 1.3, 1.2, 1.1)}) is Answer.HOLD
    assert "not at rest" in loop.status["cause"]
    assert loop.block() is Answer.CLOSE


@pytest.mark.parametrize("setpoint", [{"p": 1.0}, {"n": 10.0}])
def test_arming_is_refused_with_setpoints(setpoint: dict[str, float]) -> None:
    loop = Loop()
    loop.set.update(setpoint)
    loop.blocks(10)
    loop.guard.request_arm()
    loop.blocks(3)
    assert loop.note("refused_arm")["why"] == "setpoints"


def test_arming_is_refused_after_a_wrong_heartbeat() -> None:
    loop = Loop()
    loop.blocks(10)
    loop.guard.request_arm()
    loop.heartbeat(mask=7)
    loop.block(beat=False)
    assert loop.note("refused_arm")["why"] == "heartbeat_wrong"


def test_arming_is_refused_when_the_limits_file_was_edited(tmp_path: Path) -> None:
    path = tmp_path / "limits.toml"
    path.write_bytes(LIMITS_FILE.read_bytes())
    loop = Loop(loaded=load_limits(path))
    loop.blocks(10)
    path.write_bytes(LIMITS_FILE.read_bytes() + b"# edited\n")
    loop.guard.request_arm()
    loop.blocks(3)
    assert loop.note("refused_arm")["why"] == "limits_file"


def test_arming_is_refused_when_a_check_is_blind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guard_module, "failed_checks", lambda limits: ["estop"])
    loop = Loop()
    loop.blocks(10)
    loop.guard.request_arm()
    loop.blocks(3)
    assert loop.note("refused_arm")["words"] == "The proof test failed for estop."


def test_arming_is_refused_while_the_journal_cannot_be_written() -> None:
    loop = Loop()
    loop.guard.journal_failed("disk full", loop.now_s)
    loop.blocks(10)
    loop.guard.request_arm()
    loop.blocks(3)
    assert loop.note("refused_arm")["why"] == "journal"
    assert loop.guard.state is State.LOCKED


@pytest.mark.parametrize("state", ["armed", "tripped"])
def test_arming_is_for_the_locked(armed: Loop, state: str) -> None:
    if state == "tripped":
        armed.guard.trip(Cause("estop"), armed.now_s)
    armed.guard.request_arm()
    armed.serve()
    assert armed.note("refused_arm")["why"] == state


def test_a_relay_that_does_not_close_trips() -> None:
    loop = Loop()
    loop.blocks(10)
    loop.guard.request_arm()
    while loop.guard.state is not State.ARMING:
        loop.block()
    loop.blocks(loop.limits.relay.readback_blocks, relay_closed=False)
    assert loop.note("trip")["cause"] == "relay_not_closed"
    assert loop.note("trip")["state_before"] == "arming"


def test_motion_commanded_while_the_relay_is_proven_trips() -> None:
    loop = Loop()
    loop.blocks(10)
    loop.guard.request_arm()
    while loop.guard.state is not State.ARMING:
        loop.block()
    loop.set["n"] = 40.0
    loop.block()
    assert loop.note("trip")["cause"] == "setpoint"


def test_a_second_controller_session_begins_its_heartbeats_anew() -> None:
    loop = Loop()
    loop.blocks(10)
    loop.guard.controller_connected()
    loop.nonce = 0
    loop.arm()


# -- the kick ---------------------------------------------------------------------------------------


def test_an_armed_guard_renews_while_all_is_well(armed: Loop) -> None:
    armed.set.update(p=20.0, n=40.0, enable=True)
    assert {armed.block(drive_enabled=True, **BRAKING) for _ in range(30)} == {Answer.EDGE}


@pytest.mark.parametrize(
    ("missing", "cause"),
    [
        ("sample", "estop"),
        ("heartbeat", "heartbeat_late"),
        ("limits", "limits_changed"),
        ("checks", "cycle_incomplete"),
        ("latch", "doors"),
        ("journal", "journal_failed"),
    ],
)
def test_no_kick_without_each_condition(armed: Loop, missing: str, cause: str) -> None:
    changes: dict[str, Any] = {}
    if missing == "sample":
        changes["estop_ok"] = False
    elif missing == "heartbeat":
        changes["beat"] = False
    elif missing == "limits":
        object.__setattr__(armed.limits.disc_temperature, "max_degc", 900.0)
    elif missing == "checks":
        armed.guard._runner._functions.pop()
    elif missing == "latch":
        armed.guard.trip(Cause("doors"), armed.now_s)
    elif missing == "journal":
        armed.guard._journal_failure = "disk full"  # not told: the cycle itself must notice
        cause = "cycle_incomplete"
    assert armed.block(**changes) is Answer.OPEN
    assert armed.note("trip")["cause"] == cause
    assert not armed.relay
    assert armed.blocks(5) is Answer.HOLD


@pytest.mark.parametrize("lag", [-2, 2, 5])
def test_in_lockstep_the_heartbeat_of_the_block_before_is_asked_for(armed: Loop, lag: int) -> None:
    armed.guard.monitor.last_k += 1 - lag  # as if the controller had counted otherwise
    assert armed.block(beat=False) is Answer.OPEN
    assert armed.note("trip")["cause"] == "heartbeat_late"


def test_all_is_well_is_recorded_now_and_then(armed: Loop) -> None:
    armed.guard._watching_s -= guard_module.WATCHING_EVERY_S
    armed.blocks(10)
    assert armed.kinds().count("watching") == 1


# -- trips ------------------------------------------------------------------------------------------


def test_a_trip_tells_cause_values_threshold_and_what_came_before(armed: Loop) -> None:
    armed.blocks(50)
    armed.block(temperature_degc=(501.0, 502.0, 503.0, 504.0, 505.0))
    note = next(note for note in armed.notes if note.kind == "trip")
    payload = dict(note.payload)
    assert payload["cause"] == "temperature_range"
    assert (payload["value"], payload["threshold"]) == (505.0, 500.0)
    assert payload["stop_category"] == 0
    assert payload["words"] == "disc temperature in °C is out of its range: 505 (limit 500)."
    assert payload["temperature_degc"] == 505.0
    assert len(note.samples) == guard_module.TAPE_BLOCKS
    assert note.samples[-1].k == armed.k
    assert armed.status["state"] == "tripped"
    assert armed.status["cause"] == payload["words"] and armed.status["remedy"] == payload["remedy"]


def test_the_relay_is_asked_to_open_exactly_once(armed: Loop) -> None:
    assert armed.block(doors_ok=False) is Answer.OPEN
    armed.blocks(10)
    assert armed.answers.count(Answer.OPEN) == 1


@pytest.mark.parametrize(
    "changes",
    [
        {"mask": 7},
        {"answer": 5},
        {"limits": "00000000"},
        {"k": 3},
        {"k": 10**6},
        {"set": {"p": 45.0, "n": 0.0, "enable": True}},
        {"set": {"p": math.nan, "n": 0.0, "enable": True}},
    ],
)
def test_a_wrong_heartbeat_trips_at_once(armed: Loop, changes: dict[str, Any]) -> None:
    armed.heartbeat(**changes)
    assert armed.guard.state is State.TRIPPED  # before any sample
    armed.serve()
    assert armed.note("trip")["cause"] in ("heartbeat_wrong", "setpoint")
    assert not armed.relay


def test_hardware_that_misbehaves_trips_even_while_locked() -> None:
    loop = Loop()
    loop.welded = True
    loop.blocks(loop.limits.relay.readback_blocks)
    assert loop.note("trip")["cause"] == "relay_welded"
    hot = Loop()
    hot.blocks(3, temperature_degc=(510.0,) * 5)
    assert hot.note("trip")["cause"] == "temperature_range"
    blind = Loop()
    blind.blocks(20, temperature_degc=(None,) * 5, pressure_bar=(math.nan,) * 5)
    assert blind.guard.state is State.LOCKED


def test_a_cause_that_only_forbids_motion_does_not_trip_while_locked() -> None:
    loop = Loop()
    loop.blocks(5, estop_ok=False)
    loop.heartbeat(mask=1)
    loop.guard.on_controller_garbage("nonsense", loop.now_s)
    loop.guard.on_sample_garbage("nonsense", loop.now_s)
    loop.guard.on_silence(loop.now_s + 1e6)
    loop.guard.controller_gone("gone", loop.now_s)
    assert loop.guard.state is State.LOCKED
    assert loop.guard.silence_deadline_s() is None


@pytest.mark.parametrize(
    ("do", "cause"),
    [
        (lambda g, t: g.controller_gone("its process has ended", t), "controller_gone"),
        (lambda g, t: g.journal_failed("disk full", t), "journal_failed"),
        (lambda g, t: g.on_controller_garbage("x", t), "heartbeat_wrong"),
        (lambda g, t: g.on_sample_garbage("x", t), "rig_garbage"),
    ],
)
def test_other_faults_trip_at_once(armed: Loop, do: Any, cause: str) -> None:
    do(armed.guard, armed.now_s)
    armed.serve()
    assert armed.note("trip")["cause"] == cause
    assert not armed.relay


def test_further_causes_are_noted_and_the_first_stays(armed: Loop) -> None:
    armed.block(doors_ok=False)
    armed.blocks(2, temperature_degc=(600.0,) * 5)
    armed.blocks(2, temperature_degc=(600.0,) * 5)
    assert armed.kinds().count("trip") == 1
    assert [n.payload["cause"] for n in armed.notes if n.kind == "further_cause"] == [
        "temperature_range",
        "temperature_approach",
    ]
    assert armed.guard.cause is not None and armed.guard.cause.id == "doors"


def test_silence_in_lockstep(armed: Loop) -> None:
    windows = armed.limits.time.virtual
    due = armed.now_s + windows.heartbeat_s
    assert armed.guard.silence_deadline_s() == pytest.approx(due)
    armed.guard.on_silence(due - 0.001)
    assert armed.guard.state is State.ARMED
    armed.guard.on_silence(due + 0.001)
    armed.serve()
    assert armed.note("trip")["cause"] == "heartbeat_late"


def test_silence_of_the_rig_in_lockstep(armed: Loop) -> None:
    armed.heartbeat()  # the controller has answered, the rig has not
    armed.guard.on_silence(armed.now_s + armed.limits.time.virtual.sample_s - 0.001)
    assert armed.guard.state is State.ARMED
    armed.guard.on_silence(armed.now_s + armed.limits.time.virtual.sample_s + 0.001)
    armed.serve()
    assert armed.note("trip")["cause"] == "samples_late"


@pytest.mark.parametrize("who", ["heartbeat", "sample"])
def test_silence_in_real_time(who: str) -> None:
    loop = Loop(lockstep=False).arm()
    windows = loop.limits.time.real_without_priority
    if who == "heartbeat":
        loop.now_s += windows.heartbeat_s + 0.001
        expected = "heartbeat_late"
        loop.guard._sample_at_s = loop.now_s
    else:
        loop.now_s += windows.sample_s + 0.001
        expected = "samples_late"
        loop.guard._heartbeat_at_s = loop.now_s
    loop.guard.on_silence(loop.now_s)
    loop.serve()
    assert loop.note("trip")["cause"] == expected


def test_in_real_time_an_old_heartbeat_is_found_with_the_sample() -> None:
    loop = Loop(lockstep=False).arm()
    assert loop.block(beat=False) is Answer.EDGE  # 0.05 s old
    loop.now_s += 0.2
    assert loop.block(beat=False) is Answer.OPEN
    assert loop.note("trip")["cause"] == "heartbeat_late"


def test_in_real_time_a_controller_too_many_blocks_behind_is_late() -> None:
    loop = Loop(lockstep=False).arm()
    loop.guard._heartbeat_at_s += 100.0
    assert {loop.block(beat=False) for _ in range(guard_module.ACCEPTED_LAG - 1)} == {Answer.EDGE}
    assert loop.block(beat=False) is Answer.OPEN


# -- safe state, disarm, reset ----------------------------------------------------------------------


def test_the_safe_state_is_reported_once_and_only_with_the_relay_open(armed: Loop) -> None:
    armed.set.update(p=20.0, n=40.0, enable=True)
    armed.block(**BRAKING)
    armed.block(doors_ok=False, **BRAKING)
    armed.block(**BRAKING)
    assert "safe_state_reached" not in armed.kinds()
    armed.block(relay_closed=True)
    assert not armed.guard.safe_state_reached
    armed.blocks(4)
    assert armed.kinds().count("safe_state_reached") == 1
    note = armed.note("safe_state_reached")
    assert note["pressure_bar"] < 1.0 and note["speed_rpm"] < 1.0
    assert note["after_rig_s"] == pytest.approx(0.15)


def test_disarming_at_rest_opens_the_relay_and_locks(armed: Loop) -> None:
    armed.guard.disarm()
    armed.serve()
    assert armed.guard.state is State.LOCKED and not armed.relay and armed.guard.disarmed
    assert armed.note("disarmed")["pressure_bar"] < 1.0
    assert armed.blocks(5) is Answer.HOLD
    armed.arm()


@pytest.mark.parametrize("field", ["pressure_bar", "speed_rpm"])
def test_disarming_in_motion_is_refused(armed: Loop, field: str) -> None:
    armed.block(**{field: (5.0, 5.1, 5.2, 5.1, 5.3)})
    armed.guard.disarm()
    armed.serve()
    assert armed.note("refused_disarm")["why"] == "not_at_rest"
    assert armed.guard.state is State.ARMED and not armed.guard.disarmed
    assert armed.block() is Answer.EDGE


def test_disarming_the_locked_and_the_tripped(armed: Loop) -> None:
    loop = Loop()
    loop.guard.disarm()
    assert loop.guard.disarmed and not loop.guard.take_notes()
    armed.block(doors_ok=False)
    armed.guard.disarm()
    armed.serve()
    assert armed.note("refused_disarm")["why"] == "tripped"
    assert not armed.guard.disarmed


def tripped_and_at_rest(**trip: Any) -> Loop:
    loop = Loop().arm()
    loop.block(**(trip or {"doors_ok": False}))
    loop.blocks(50)
    assert loop.guard.state is State.TRIPPED
    return loop


def reset(loop: Loop, who: object = "A. Person", reason: object = "door closed") -> None:
    loop.guard.reset(who, reason, loop.now_s)
    loop.serve()


def test_a_reset_leads_to_locked_and_arming_is_asked_for_anew() -> None:
    loop = tripped_and_at_rest()
    reset(loop)
    assert loop.guard.state is State.LOCKED
    assert loop.note("reset") | {"who": "A. Person", "reason": "door closed", "cause": "doors"} == loop.note(
        "reset"
    )
    assert loop.blocks(50) is Answer.HOLD
    loop.arm()


@pytest.mark.parametrize(
    ("who", "reason"),
    [("", "x"), ("x", ""), (None, "x"), ("x", None), ("  ", "x"), ("x", 3), ("x" * 201, "x")],
)
def test_a_reset_names_person_and_reason(who: Any, reason: Any) -> None:
    loop = tripped_and_at_rest()
    reset(loop, who, reason)
    assert loop.guard.state is State.TRIPPED
    assert loop.note("refused_reset")["why"] in ("who", "reason")


@pytest.mark.parametrize(
    ("changes", "why"),
    [
        ({"doors_ok": False}, "doors"),
        ({"estop_ok": False}, "estop"),
        ({"relay_closed": True}, "relay"),
        ({"speed_rpm": (5.5, 5.4, 5.3, 5.2, 5.1)}, "not_at_rest"),
        ({"pressure_bar": (1.5, 1.4, 1.3, 1.2, 1.1)}, "not_at_rest"),
        ({"speed_rpm": (0.1, 0.2, 0.1, 0.2, None)}, "not_at_rest"),
    ],
)
def test_no_reset_while_a_cause_is_active_or_anything_moves(changes: dict[str, Any], why: str) -> None:
    loop = tripped_and_at_rest()
    loop.block(**changes)
    reset(loop)
    assert loop.guard.state is State.TRIPPED
    assert loop.note("refused_reset")["why"] == why
    loop.blocks(50)
    reset(loop)
    assert loop.guard.state is State.LOCKED


def test_no_reset_before_two_seconds_of_standstill() -> None:
    loop = Loop().arm()
    loop.set.update(p=20.0, n=40.0)
    loop.block(**BRAKING)
    loop.block(doors_ok=False, **BRAKING)
    loop.set.update(p=0.0, n=0.0)
    loop.blocks(40)
    reset(loop)
    assert loop.note("refused_reset")["why"] == "not_at_rest"
    loop.blocks(2)
    reset(loop)
    assert loop.guard.state is State.LOCKED


def test_no_reset_without_a_living_controller() -> None:
    loop = Loop().arm()
    loop.blocks(60, beat=False)
    assert loop.note("trip")["cause"] == "heartbeat_late"
    reset(loop)
    assert loop.note("refused_reset")["why"] == "heartbeats"


def test_the_same_cause_is_reset_so_often_and_no_more() -> None:
    book = ResetBook(3)
    loop = Loop(resets=book)
    for _ in range(3):
        loop.arm()
        loop.block(doors_ok=False)
        loop.blocks(50)
        reset(loop)
        assert loop.guard.state is State.LOCKED
    loop.arm()
    loop.block(doors_ok=False)
    loop.blocks(50)
    reset(loop)
    assert loop.note("refused_reset")["why"] == "too_often"
    loop.now_s += 3600.0
    loop.blocks(50)
    reset(loop)
    assert loop.guard.state is State.LOCKED


@pytest.mark.parametrize(
    "cause", ["limits_changed", "cycle_incomplete", "journal_failed", "relay_welded", "watchdog_error"]
)
def test_trips_that_no_reset_can_lift(cause: str) -> None:
    loop = Loop().arm()
    loop.guard.trip(Cause(cause), loop.now_s)
    loop.blocks(50)
    reset(loop)
    assert loop.note("refused_reset")["why"] == "not_resettable"


def test_no_reset_while_the_journal_cannot_be_written() -> None:
    loop = tripped_and_at_rest()
    loop.guard.journal_failed("disk full", loop.now_s)
    reset(loop)
    assert loop.note("refused_reset")["why"] == "journal"


def test_a_reset_without_a_trip_or_a_sample_is_refused() -> None:
    loop = Loop()
    reset(loop)
    assert loop.note("refused_reset")["why"] == "nothing"
    loop.blocks(3)
    reset(loop)
    assert loop.guard.state is State.LOCKED


def test_an_unacknowledged_trip_keeps_the_rig_locked_until_it_is_reset() -> None:
    loop = Loop(unacknowledged=Cause("doors"))
    loop.blocks(10)
    assert loop.status["cause"] == "a door is open."
    loop.guard.request_arm()
    loop.blocks(5)
    assert loop.note("refused_arm")["why"] == "unacknowledged"
    loop.blocks(60)
    reset(loop)
    assert loop.note("reset")["cause"] == "doors"
    loop.arm()


def test_repeated_refusals_do_not_flood_the_journal() -> None:
    loop = Loop()
    for _ in range(100):
        loop.guard.on_controller_garbage("nonsense", loop.now_s)
    loop.serve()
    assert loop.kinds() == ["refused_message"]


def test_a_trip_before_the_first_sample() -> None:
    loop = Loop()
    assert loop.guard.last_k == -1
    loop.guard.trip(Cause("watchdog_error", detail="x"), loop.now_s)
    loop.serve()
    assert loop.note("trip")["k"] == -1
    assert sample_at(0).k == 0


def test_the_good_samples_are_counted_anew_after_a_bad_one() -> None:
    loop = Loop()
    loop.blocks(10)
    loop.block(doors_ok=False)
    loop.guard.request_arm()
    needed = loop.limits.arming.samples
    assert [loop.block() for _ in range(needed)] == [Answer.HOLD] * (needed - 1) + [Answer.CLOSE]

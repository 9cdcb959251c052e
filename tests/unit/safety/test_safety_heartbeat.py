"""Heartbeats: number, nonce, checkpoints, limits, set-points."""

from __future__ import annotations

import math
import zlib
from typing import Any

import pytest
from guard_loop import CALM, loaded_limits
from hypothesis import given
from hypothesis import strategies as st

from rigctl.safety.heartbeat import CHECKPOINTS, HeartbeatMonitor, answer_to, setpoint_fault

LOADED = loaded_limits()
LIMITS = LOADED.limits.setpoints
REST = {"p": 0.0, "n": 0.0, "enable": False}


def monitor(nonces: int = 2) -> HeartbeatMonitor:
    return HeartbeatMonitor(LOADED.hash8, LIMITS, nonces)


def beat(k: int, nonce: int = 0, **changes: Any) -> dict[str, Any]:
    mask = changes.get("mask", CHECKPOINTS)
    message = {"m": "hb", "k": k, "mask": mask, "answer": answer_to(nonce, k, mask, LOADED.hash8)}
    return {**message, "limits": LOADED.hash8, "set": REST, **changes}


def words(watch: HeartbeatMonitor, message: dict[str, Any]) -> str:
    fault = watch.judge(message)
    return "" if fault is None else fault.words


def test_the_answer_is_that_of_the_protocol() -> None:
    assert answer_to(77, 5, 15, "0123abcd") == zlib.crc32(b"77:5:15:0123abcd")


def test_good_heartbeats_are_counted() -> None:
    watch = monitor()
    for k in range(5):
        assert watch.judge(beat(k, nonce=0 if k == 0 else 1000 + k)) is None
        watch.issued(1001 + k)
    assert (watch.good_in_a_row, watch.last_k, watch.standing_still) == (5, 4, True)


def test_the_first_heartbeat_may_begin_anywhere_but_not_below_zero() -> None:
    assert words(monitor(), beat(7)) == ""
    assert "block -3 instead of 0" in words(monitor(), beat(-3))


@pytest.mark.parametrize("k", [0, 1, 2, 4, 5, 100])
def test_the_number_rises_by_exactly_one(k: int) -> None:
    watch = monitor()
    for good in range(3):
        assert watch.judge(beat(good)) is None
    assert f"block {k} instead of 3" in words(watch, beat(k))
    assert watch.good_in_a_row == 0


def test_after_a_gap_the_count_goes_on_from_the_newest_and_never_backwards() -> None:
    watch = monitor()
    watch.judge(beat(0))
    assert watch.judge(beat(5)) is not None
    assert watch.judge(beat(6)) is None
    assert watch.judge(beat(2)) is not None
    assert watch.judge(beat(7)) is None


@pytest.mark.parametrize("mask", [m for m in range(16) if m != 15] + [31])
def test_every_checkpoint_must_have_been_passed(mask: int) -> None:
    assert "checkpoints" in words(monitor(), beat(0, mask=mask))


@pytest.mark.parametrize("other", ["00000000", "", None, 5])
def test_the_limits_must_be_the_same(other: Any) -> None:
    assert "limits" in words(monitor(), beat(0, limits=other))


def test_only_the_newest_nonces_are_answered() -> None:
    watch = monitor()
    for nonce in (11, 12, 13):
        watch.issued(nonce)
    assert words(watch, beat(0, nonce=13)) == ""
    assert words(watch, beat(1, nonce=12)) == ""
    assert "does not answer the newest nonce" in words(watch, beat(2, nonce=11))
    assert "does not answer" in words(watch, beat(3, nonce=0))
    assert "does not answer" in words(watch, beat(4, answer=1))


def test_a_replayed_heartbeat_is_refused_even_when_its_number_is_made_new() -> None:
    watch = monitor()
    old = beat(0)
    assert watch.judge(old) is None
    watch.issued(11)
    watch.issued(12)
    assert "block 0 instead of 1" in words(watch, old)
    assert "does not answer" in words(watch, {**old, "k": 1})


@pytest.mark.parametrize("key", ["k", "mask", "answer"])
@pytest.mark.parametrize("bad", [None, "3", 1.0, True, math.nan])
def test_numbers_that_are_none(key: str, bad: Any) -> None:
    assert "must be whole numbers" in words(monitor(), {**beat(0), key: bad})


@pytest.mark.parametrize(
    "setpoints",
    [
        {"p": 0, "n": 0, "enable": False},
        {"p": 0.0, "n": 0.0, "enable": True},
        {"p": 40.0, "n": 800.0, "enable": True},
    ],
)
def test_setpoints_within_limits_and_zero_pass(setpoints: Any) -> None:
    assert setpoint_fault(setpoints, LIMITS) is None


@pytest.mark.parametrize("value", [40.001, -0.001, math.nan, math.inf, -math.inf, None, "1", True, [1]])
def test_pressures_that_are_not_allowed(value: Any) -> None:
    fault = setpoint_fault({"p": value, "n": 0.0, "enable": False}, LIMITS)
    assert fault is not None and "bar (limit 40 bar)" in fault.words


@pytest.mark.parametrize("value", [800.001, -0.001, math.nan, math.inf, -math.inf, None, "1", True, [1]])
def test_speeds_that_are_not_allowed(value: Any) -> None:
    fault = setpoint_fault({"p": 0.0, "n": value, "enable": False}, LIMITS)
    assert fault is not None and "1/min (limit 800 1/min)" in fault.words


@pytest.mark.parametrize(
    "setpoints", [None, [], "p", {}, {"p": 0, "n": 0}, {"p": 0, "n": 0, "enable": False, "torque": 5}]
)
def test_unknown_setpoints_are_not_allowed(setpoints: Any) -> None:
    fault = setpoint_fault(setpoints, LIMITS)
    assert fault is not None and "nothing else" in fault.words


@pytest.mark.parametrize("enable", [None, 1, "true"])
def test_enable_is_true_or_false(enable: Any) -> None:
    fault = setpoint_fault({"p": 0, "n": 0, "enable": enable}, LIMITS)
    assert fault is not None and "enable is" in fault.words


def test_commanding_motion_is_not_standing_still() -> None:
    watch = monitor()
    assert watch.judge(beat(0, set={"p": 0.0, "n": 40.0, "enable": True})) is None
    assert not watch.standing_still
    assert watch.judge(beat(1, set={"p": 99.0, "n": 0.0, "enable": True})) is not None
    assert not watch.standing_still


ANYTHING = st.integers() | st.sampled_from([None, "", "15", 0.5, math.nan, True, [], {}, LOADED.hash8])


@CALM
@given(st.dictionaries(st.sampled_from(["k", "mask", "answer", "limits", "set", "x"]), ANYTHING))
def test_nothing_random_is_ever_good(message: dict[str, Any]) -> None:
    assert monitor().judge(message) is not None

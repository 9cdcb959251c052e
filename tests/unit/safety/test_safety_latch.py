"""The latch: first cause kept, no way round the reset."""

from __future__ import annotations

import pytest

from rigctl.safety.causes import CAUSES, Cause, plain_json
from rigctl.safety.latch import HOUR_S, Latch, ResetBook, State

A, B = Cause("estop"), Cause("doors")


def test_it_starts_locked() -> None:
    latch = Latch()
    assert latch.state is State.LOCKED and not latch.relay_wanted and latch.cause is None


def test_the_way_to_armed_and_back() -> None:
    latch = Latch()
    latch.close()
    assert latch.relay_wanted and latch.state.told == "locked"
    latch.confirm()
    assert latch.relay_wanted and latch.state.told == "armed"
    latch.open()
    assert latch.state is State.LOCKED


@pytest.mark.parametrize("steps", [[], ["close"], ["close", "confirm"]])
def test_a_trip_latches_from_every_state(steps: list[str]) -> None:
    latch = Latch()
    for step in steps:
        getattr(latch, step)()
    assert latch.trip(A)
    assert latch.state is State.TRIPPED and not latch.relay_wanted
    for step in ("close", "confirm", "open"):
        with pytest.raises(RuntimeError):
            getattr(latch, step)()
    assert latch.state is State.TRIPPED


def test_the_first_cause_is_kept_and_further_ones_are_news_once() -> None:
    latch = Latch()
    assert latch.trip(A)
    assert not latch.trip(A)
    assert latch.trip(B)
    assert not latch.trip(B)
    assert latch.cause is A and latch.further == {"doors": B}


def test_a_reset_leads_to_locked_with_nothing_left() -> None:
    latch = Latch()
    latch.trip(A)
    latch.trip(B)
    latch.reset()
    assert (latch.state, latch.cause, latch.further) == (State.LOCKED, None, {})


@pytest.mark.parametrize("step", ["confirm", "open", "reset"])
def test_steps_that_do_not_begin_at_locked(step: str) -> None:
    with pytest.raises(RuntimeError, match="in state locked"):
        getattr(Latch(), step)()


def test_resets_of_the_last_hour_are_counted_by_cause() -> None:
    book = ResetBook(2)
    book.add("estop", 0.0)
    assert not book.exhausted("estop", 1.0)
    book.add("estop", 100.0)
    assert book.exhausted("estop", 101.0)
    assert not book.exhausted("doors", 101.0)
    assert book.exhausted("estop", HOUR_S - 1.0)
    assert not book.exhausted("estop", HOUR_S)


def test_every_cause_says_what_to_do() -> None:
    for text in CAUSES.values():
        assert text.words[0].islower() and not text.words.endswith(".")
        assert text.remedy.endswith(".")


@pytest.mark.parametrize(
    ("cause", "words"),
    [
        (Cause("estop"), "the emergency stop is pressed."),
        (Cause("pressure_range", 41.5, 41.0), "brake pressure in bar is out of its range: 41.5 (limit 41)."),
        (Cause("samples_gap", 7), "blocks of the safety channel are missing or repeated: 7."),
        (
            Cause("controller_gone", detail="its process has ended"),
            "the controller has gone: its process has ended.",
        ),
    ],
)
def test_causes_are_told_in_plain_words(cause: Cause, words: str) -> None:
    assert cause.words == words
    assert cause.to_mapping()["words"] == words


def test_the_journal_gets_no_nan() -> None:
    assert [plain_json(x) for x in (1.5, float("nan"), float("inf"), None, True)] == [
        1.5,
        "nan",
        "inf",
        None,
        True,
    ]

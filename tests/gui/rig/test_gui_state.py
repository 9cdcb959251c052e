"""From news to the state that is shown, without a screen."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from rigctl.app.pace import Pace
from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from rigctl.core.journal import Journal, Record
from rigctl.engine.state import Outcome, Progress, RunResult, State
from rigctl.gui.rig.fold import after_loss, after_result, with_progress, with_record, word_of
from rigctl.gui.rig.journal_tail import JournalTail
from rigctl.gui.rig.state import RigState, Word
from sequences.program import Program

MANUAL = Progress(State.IDLE, "ready", mode="manual", safety="armed", enabled=True)


@pytest.mark.parametrize(
    ("progress", "word"),
    [
        (Progress(State.IDLE), Word.STARTING),
        (Progress(State.RUNNING, "arming"), Word.STARTING),
        (Progress(State.RUNNING, "braking with 5 bar"), Word.RUNNING),
        (Progress(State.PAUSED, "paused"), Word.PAUSED),
        (Progress(State.STOPPING, "stopping"), Word.STOPPING),
        (Progress(State.FAULTED, "safe state"), Word.TRIPPED),
        (MANUAL, Word.READY),
        (replace(MANUAL, state=State.RUNNING, phase="by hand"), Word.RUNNING),
        (replace(MANUAL, phase="stopping", state=State.RUNNING), Word.STOPPING),
        (replace(MANUAL, enabled=False), Word.LOCKED),
        (replace(MANUAL, safety="locked"), Word.LOCKED),
        (replace(MANUAL, state=State.FAULTED), Word.TRIPPED),
    ],
)
def test_one_word_for_every_progress(progress: Progress, word: Word):
    assert word_of(progress) is word


def record(kind: str, source: str = "watchdog", **payload) -> Record:
    return Record("2026-11-30T10:00:00+00:00", 1, 0.0, source, 1, 0, kind, payload, "", "")


def test_first_cause_stays_until_the_watchdog_has_reset_it():
    trip = record("trip", words="the emergency stop is pressed.", remedy="Release it.", cause="estop")
    state = with_record(RigState(), trip)
    assert state.cause is not None
    assert (state.cause.words, state.cause.remedy) == ("The emergency stop is pressed.", "Release it.")
    state = with_progress(state, replace(MANUAL, state=State.FAULTED), None)
    assert (state.word, state.cause is not None) == (Word.TRIPPED, True)
    assert with_record(state, record("trip", source="controller")).cause == state.cause
    state = with_record(state, record("reset", who="anna"))
    assert state.cause is None
    assert with_progress(state, MANUAL, None).word is Word.READY


def test_lost_controller_is_a_trip_with_a_cause_and_then_safe():
    state = after_loss(RigState(Word.RUNNING, commanding=True, enabled=True), safe=False)
    assert (state.word, state.commanding, state.enabled) == (Word.TRIPPED, False, False)
    assert state.cause is not None
    assert "waiting" in state.phase
    assert "in the safe state" in after_loss(state, safe=True).phase


@pytest.mark.parametrize(
    ("outcome", "word"),
    [
        (Outcome.FINISHED, Word.OFFLINE),
        (Outcome.STOPPED, Word.OFFLINE),
        (Outcome.FAILED, Word.OFFLINE),
        (Outcome.TRIPPED, Word.TRIPPED),
    ],
)
def test_end_of_a_session(outcome: Outcome, word: Word):
    result = RunResult(outcome, 3, 9, [4], cause="why", remedy="do")
    state = after_result(RigState(Word.RUNNING, left_s=9.0), result)
    assert (state.word, state.left_s, state.done) == (word, None, 3)
    assert (state.cause is not None) == (outcome in (Outcome.TRIPPED, Outcome.FAILED))


def test_tail_reads_each_record_once_and_waits_for_half_a_line(tmp_path: Path):
    path = tmp_path / "journal.jsonl"
    tail = JournalTail(path)
    assert tail.read() == []
    journal = Journal(path, "test")
    journal.write("one", value=1)
    assert [r.kind for r in tail.read()] == ["one"]
    assert tail.read() == []
    journal.write("two")
    whole = path.read_bytes()
    lines = whole.splitlines(keepends=True)
    path.write_bytes(lines[0] + lines[1][:20])
    assert tail.read() == []
    path.write_bytes(whole + b"no record\n" + json.dumps({"a": 1}).encode() + b"\n")
    assert [r.kind for r in tail.read()] == ["two"]
    journal.close()


def test_time_left_follows_the_estimate_and_the_pace(configs: Path):
    rig = load_model(configs / "rigs" / "simulated.toml", RigConfig)
    program = load_model(configs / "programs" / "quick_check.toml", Program)
    pace = Pace(program, rig.capabilities)
    assert pace.left_s(Progress(State.RUNNING, braking=1, total=6), 0.0) is None
    half = pace.left_s(Progress(State.RUNNING, braking=4, total=6, rig_s=40.0), 10.0)
    assert half is not None
    assert 1.0 < half < 60.0
    late = pace.left_s(Progress(State.RUNNING, braking=6, total=6, rig_s=70.0), 15.0)
    assert late is not None
    assert late < half
    assert pace.factor == pytest.approx(70.0 / 15.0)

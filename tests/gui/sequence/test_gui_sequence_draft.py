"""The draft: exact round trips, undo and redo, validity, and the sequences of a program."""

import tomllib
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule
from sequence_strategies import programs

from rigctl.gui.pages.sequence.draft import MERGE_S, ProgramDraft, new_sequence
from rigctl.gui.pages.sequence.forms import ProgramForm, SequenceForm, SpeedRow, form_of, profile_rows
from sequences.program import Program, dump_program, load_program

ROOT = Path(__file__).resolve().parents[3]
SHIPPED = sorted((ROOT / "configs/programs").glob("*.toml"))
CHANNELS = {"microphone": (40000.0, True), "torque": (4000.0, False)}


class Clock:
    """Seconds set by hand."""

    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


def drafted(*kinds: str) -> ProgramDraft:
    draft = ProgramDraft(Clock())
    draft.load(ProgramForm(name="test"), saved=False)
    for kind in kinds or ("matrix",):
        draft.add(new_sequence(kind, CHANNELS))
    return draft


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_programs_round_trip(path: Path) -> None:
    program = load_program(path)
    draft = ProgramDraft()
    draft.load(program)
    assert draft.program == program
    assert not draft.faults
    assert not draft.dirty


@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(programs())
def test_draft_program_toml_round_trip(program: Program) -> None:
    draft = ProgramDraft()
    draft.load(program)
    assert draft.program == program
    text = dump_program(draft.program)
    again = Program.model_validate(tomllib.loads(text))
    assert again == program
    assert form_of(again) == draft.form


@pytest.mark.parametrize("kind", ["matrix", "bedding", "stop"])
def test_new_sequences_are_right_at_once(kind: str) -> None:
    draft = drafted(kind)
    assert draft.program is not None
    recorded = [channel.name for channel in draft.program.sequences[0].recording.channels]
    assert ("microphone" in recorded) == (kind != "bedding")


def test_typing_is_one_step_and_a_pause_begins_another() -> None:
    draft = drafted()
    clock = draft._clock
    for text in ("a", "ab", "abc"):
        draft.set_head(name=text)
        clock.now += 0.2
    clock.now += MERGE_S
    draft.set_head(name="abcd")
    assert draft.undo() == (0, "name")
    assert draft.form.name == "abc"
    draft.undo()
    assert draft.form.name == "test"
    draft.redo()
    draft.redo()
    assert draft.form.name == "abcd"
    assert draft.redo() is None


def test_typing_in_another_field_is_another_step() -> None:
    draft = drafted()
    sequence = draft.form.sequences[0]
    draft.set_sequence(replace(sequence, repeat="2"), "repeat", merge=True)
    draft.set_sequence(replace(sequence, repeat="2", dwell="3"), "dwell_s", merge=True)
    draft.undo()
    assert (draft.form.sequences[0].repeat, draft.form.sequences[0].dwell) == ("2", "1")


def test_no_change_is_no_step() -> None:
    draft = drafted()
    steps = len(draft._undo)
    assert not draft.set_sequence(draft.form.sequences[0], "repeat")
    assert not draft.set_head(name="test")
    assert len(draft._undo) == steps


def test_undo_after_save_is_dirty_and_redo_is_clean_again() -> None:
    draft = drafted()
    draft.mark_saved(draft.form)
    draft.set_head(name="other")
    assert draft.dirty
    draft.undo()
    assert not draft.dirty
    draft.redo()
    assert draft.dirty


def test_remove_is_undone_with_contents_and_place() -> None:
    draft = drafted("bedding", "matrix", "stop")
    before = draft.form
    middle = draft.form.sequences[1].uid
    assert draft.remove(middle) == draft.form.sequences[1].uid
    assert [s.name for s in draft.form.sequences] == ["bedding", "stop"]
    assert draft.undo() == (middle, "sequences")
    assert draft.form == before


def test_duplicates_get_free_names() -> None:
    draft = drafted("matrix")
    first = draft.form.sequences[0].uid
    draft.duplicate(first)
    draft.duplicate(first)
    assert [s.name for s in draft.form.sequences] == ["matrix", "matrix 3", "matrix 2"]
    assert len({s.uid for s in draft.form.sequences}) == 3
    assert draft.program is not None


def test_free_names_ignore_capitals_and_stay_short() -> None:
    draft = drafted()
    draft.set_sequence(replace(draft.form.sequences[0], name="M" * 64))
    assert len(draft.free_name("m" * 64)) <= 64
    assert draft.free_name("other") == "other"


def test_move_and_its_ends() -> None:
    draft = drafted("bedding", "matrix", "stop")
    last = draft.form.sequences[2].uid
    assert draft.move(last, -5)
    assert [s.name for s in draft.form.sequences] == ["stop", "bedding", "matrix"]
    assert not draft.move(last, 0)
    assert not draft.move(999_999, 1)


def test_invalid_keeps_the_last_valid_program() -> None:
    draft = drafted()
    valid = draft.program
    sequence = draft.form.sequences[0]
    draft.set_sequence(replace(sequence, repeat="x"), "repeat")
    assert draft.program is None
    assert draft.last_valid == valid
    assert draft.count(sequence.uid) is None
    draft.set_sequence(replace(sequence, enabled=False), "enabled")
    assert draft.count(sequence.uid) == 0
    assert [fault.place for fault in draft.faults] == ["sequences"]  # nothing is left to run


def test_empty_only_before_anything_was_done() -> None:
    draft = ProgramDraft()
    assert draft.empty
    assert not draft.dirty
    draft.load(ProgramForm(name="x"), saved=False)
    assert not draft.empty
    assert draft.dirty


def test_profiles_are_groups_of_joined_rows() -> None:
    rows = (SpeedRow(joined=True), SpeedRow(joined=True), SpeedRow(), SpeedRow(joined=True))
    assert profile_rows(rows) == [[0, 1], [2, 3]]
    assert profile_rows(()) == []


class DraftMachine(RuleBasedStateMachine):
    """Any history of changes: undo to the beginning and redo to the end meet every state again."""

    @initialize()
    def begin(self) -> None:
        self.draft = drafted("matrix", "bedding")
        self.draft._undo.clear()
        self.states = [self.draft.form]
        self.at = 0

    def _took(self) -> None:
        if self.draft.form != self.states[self.at]:
            del self.states[self.at + 1 :]
            self.states.append(self.draft.form)
            self.at += 1

    def _any(self, number: int) -> SequenceForm | None:
        listed = self.draft.form.sequences
        return listed[number % len(listed)] if listed else None

    @rule(number=st.integers(0, 5), text=st.sampled_from(["1", "2", "x", ""]))
    def repeat(self, number: int, text: str) -> None:
        form = self._any(number)
        if form is not None:
            self.draft.set_sequence(replace(form, repeat=text), "repeat")
            self._took()

    @rule(number=st.integers(0, 5), place=st.integers(0, 5))
    def move(self, number: int, place: int) -> None:
        form = self._any(number)
        if form is not None:
            self.draft.move(form.uid, place)
            self._took()

    @rule(number=st.integers(0, 5))
    def remove(self, number: int) -> None:
        form = self._any(number)
        if form is not None:
            self.draft.remove(form.uid)
            self._took()

    @rule(number=st.integers(0, 5))
    def duplicate(self, number: int) -> None:
        form = self._any(number)
        if form is not None and len(self.draft.form.sequences) < 6:
            self.draft.duplicate(form.uid)
            self._took()

    @rule()
    def undo(self) -> None:
        assert (self.draft.undo() is not None) == (self.at > 0)
        self.at = max(self.at - 1, 0)

    @rule()
    def redo(self) -> None:
        assert (self.draft.redo() is not None) == (self.at < len(self.states) - 1)
        self.at = min(self.at + 1, len(self.states) - 1)

    @invariant()
    def as_expected(self) -> None:
        if hasattr(self, "draft"):
            assert self.draft.form == self.states[self.at]
            assert (self.draft.program is None) == bool(self.draft.faults)
            uids = [s.uid for s in self.draft.form.sequences]
            assert len(set(uids)) == len(uids)


DraftMachine.TestCase.settings = settings(max_examples=15, stateful_step_count=25, deadline=None)
TestDraftMachine = DraftMachine.TestCase

"""Annotations: events in the journal and the state they add up to; the trash."""

import pytest

from rigctl.core.errors import ConfigError, RecordingError
from rigctl.core.journal import Journal, read_journal, verify_journal
from rigctl.recording.annotations import UNTOUCHED, Action, Folding, annotate, annotate_many, read_annotations
from rigctl.recording.kinds import COMMITTED
from rigctl.recording.trash import restore_braking, trash_braking, trashed_files


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "brakings").mkdir()
    (tmp_path / "brakings" / "00003.h5").write_bytes(b"first")
    return tmp_path


def controller(folder, *events):
    journal = Journal(folder / "journal.jsonl", "controller")
    for kind, payload in events:
        journal.write(kind, **payload)
    journal.close()


def test_events_fold_to_the_newest_state_and_the_journal_stays_whole(folder):
    annotate(folder, 3, Action.EXCLUDE, "  door   slammed ", who="anna")
    annotate_many(folder, [(3, Action.TAG, "b"), (3, Action.TAG, "a"), (4, Action.TAG, "a")])
    annotate_many(folder, [(3, Action.NOTE, "one"), (3, Action.NOTE, "two"), (3, Action.RATE, 7)])
    state = read_annotations(folder).of(3)
    assert state.excluded == "door slammed"
    assert state.excluded_by.startswith("anna, 2") and state.excluded_by.endswith("UTC")
    assert (state.tags, state.note, state.rating) == (("a", "b"), "two", 7)
    annotate_many(folder, [(3, Action.RESTORE, None), (3, Action.UNTAG, "b"), (3, Action.NOTE, "")])
    annotate(folder, 3, Action.RATE, None)
    state = read_annotations(folder).of(3)
    assert (state.excluded, state.excluded_by, state.tags, state.note, state.rating) == (
        "",
        "",
        ("a",),
        "",
        None,
    )
    assert read_annotations(folder).of(4).tags == ("a",)
    assert read_annotations(folder).of(5) is UNTOUCHED
    assert verify_journal(folder / "journal.jsonl") == []
    assert {r.source for r in read_journal(folder / "journal.jsonl")} == {"operator"}


@pytest.mark.parametrize(
    ("action", "value", "words"),
    [
        (Action.EXCLUDE, "  ", "with a reason"),
        (Action.TAG, "", "empty"),
        (Action.TAG, "a, b", "cannot be a tag"),
        (Action.RATE, 11, "1 to 10"),
        (Action.NOTE, "x" * 3000, "3000 letters"),
    ],
)
def test_what_cannot_be_used_is_refused_with_the_reason_and_nothing_is_written(folder, action, value, words):
    with pytest.raises(ConfigError, match=words):
        annotate_many(folder, [(3, Action.TAG, "fine"), (3, action, value)])
    assert not (folder / "journal.jsonl").exists()


def test_a_braking_recorded_anew_begins_without_annotations(folder):
    controller(folder, (COMMITTED, {"index": 3, "sha256": "aa"}))
    annotate(folder, 3, Action.EXCLUDE, "microphone fell")
    controller(folder, (COMMITTED, {"index": 3, "sha256": "aa"}))  # recovery says it again
    assert read_annotations(folder).of(3).excluded == "microphone fell"
    controller(
        folder,
        ("braking_started", {"index": 3}),
        ("operator_note", {"index": 3, "text": "second try", "who": "anna"}),
        ("operator_rating", {"index": 3, "rating": 2, "who": "anna"}),
    )
    assert read_annotations(folder).of(3).excluded == "microphone fell", "until the new file is there"
    controller(folder, (COMMITTED, {"index": 3, "sha256": "bb"}))
    state = read_annotations(folder).of(3)
    assert (state.excluded, state.said, state.rating) == ("", ("second try",), 2)


def test_what_the_operator_says_during_and_after_the_run_is_one_remark(folder):
    controller(
        folder,
        ("braking_started", {"index": 3}),
        ("operator_note", {"index": 3, "text": "hiss"}),
        (COMMITTED, {"index": 3, "sha256": "aa"}),
        ("operator_note", {"index": 3, "text": "and a click"}),
    )
    annotate(folder, 3, Action.NOTE, "looked at")
    assert read_annotations(folder).of(3).remark == "hiss · and a click · looked at"


def test_record_by_record_as_in_one_go(folder):
    annotate_many(folder, [(3, Action.TAG, "a"), (4, Action.EXCLUDE, "why")])
    records = list(read_journal(folder / "journal.jsonl"))
    folding = Folding()
    assert [folding.add([r]) for r in records] == [{3}, {4}]
    assert folding.add(records) == set(), "told twice changes nothing"
    assert folding.states == Folding(records).states


def test_trash_and_back_with_events(folder):
    moved = trash_braking(folder, 3)
    assert moved.read_bytes() == b"first" and not (folder / "brakings" / "00003.h5").exists()
    assert read_annotations(folder).of(3).trashed == "00003.h5"
    assert trashed_files(folder) == [moved]
    assert restore_braking(folder, moved.name).read_bytes() == b"first"
    assert read_annotations(folder).of(3).trashed == ""
    assert trashed_files(folder) == []


def test_the_trash_never_replaces_a_file(folder):
    moved = trash_braking(folder, 3)
    (folder / "brakings" / "00003.h5").write_bytes(b"again")
    with pytest.raises(RecordingError, match="recorded again since"):
        restore_braking(folder, moved.name)
    second = trash_braking(folder, 3)
    assert (moved.name, second.name) == ("00003.h5", "00003-2.h5")
    assert (moved.read_bytes(), second.read_bytes()) == (b"first", b"again")
    with pytest.raises(RecordingError, match="has no file"):
        trash_braking(folder, 3)


def test_a_file_stays_when_the_journal_cannot_be_written(folder):
    (folder / "journal.jsonl").mkdir()
    with pytest.raises(RecordingError, match="annotation"):
        trash_braking(folder, 3)
    assert (folder / "brakings" / "00003.h5").exists()

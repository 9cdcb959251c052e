"""The journal folded into rows, squeal per set-point, the end of a run; verbs, pace, campaigns."""

from dataclasses import replace
from datetime import datetime

import pytest
from recording_rig import MANUAL, ROOT, record

from rigctl.core.journal import Journal
from rigctl.engine.state import Outcome, Verb
from rigctl.gui.pages.run.campaigns import list_open_campaigns, list_programs
from rigctl.gui.pages.run.model import RunModel
from rigctl.gui.pages.run.pace import Pace, end_text
from rigctl.gui.pages.run.rows import Row, RowState, rows_of
from rigctl.gui.pages.run.table import stretches
from rigctl.gui.pages.run.verbs import VERBS, consequence, may
from rigctl.gui.rig.state import Word
from sequences.program import dump_program, load_program

PROGRAM = load_program(ROOT / "configs" / "programs" / "quick_check.toml")
RUNNING = replace(MANUAL, word=Word.RUNNING, mode="program")


@pytest.fixture
def model():
    made = RunModel()
    made.add(rows_of(PROGRAM))
    return made


def started(index):
    return record("braking_started", index=index, sequence="quick", temperature_degc=40.0, pressure_bar=6.0)


def committed(index, status="complete", attempt=1, note=""):
    return record(
        "BRAKING_COMMITTED", "recorder", index=index, status=status, attempt=attempt, note=note, events=0
    )


def summary(attempt=1, level=None, frequency=None, status="complete", sound=True, **more):
    results = {
        "mean_mu": 0.41, "squeal_level_db": level, "squeal_frequency_hz": frequency,
        "disc_temperature_initial_degc": 61.0, "speed_mean_rpm": 40.2,
    }  # fmt: skip
    return {
        "attempt": attempt, "status": status, "results": results, "set_points": {"pressure_bar": 6.0},
        "channels": {"microphone": {}} if sound else {}, "evaluation_error": "", "sequence": "quick", **more,
    }  # fmt: skip


def states(model):
    return [row.state for row in model.rows]


def test_rows_are_the_brakings_of_the_program(model):
    assert len(model.rows) == PROGRAM.count == 6
    first, braking = model.rows[0], next(PROGRAM.brakings())
    assert (first.index, first.sequence) == (1, "quick")
    assert (first.temperature_degc, first.pressure_bar) == (braking.temperature_degc, braking.pressure_bar)
    assert (first.speed_rpm, first.end_speed_rpm) == (40.0, 40.0)
    assert set(states(model)) == {RowState.WAITING}


def test_a_braking_goes_through_its_states(model):
    assert model.fold([record("run_started", "supervisor", attempt=0), started(1)]) == {1}
    assert model.rows[0].state is RowState.CONDITIONING and model.present == 1
    assert model.show(replace(RUNNING, braking=1)) == set()
    assert model.show(replace(RUNNING, braking=1, recording=True)) == {1}
    assert model.rows[0].state is RowState.BRAKING
    model.fold([committed(1)])
    assert model.rows[0].state is RowState.COMPLETE
    assert model.unread == [1]
    assert model.summary(1, summary(level=84.0, frequency=2345.0)) == {1}
    row = model.rows[0]
    assert (row.mean_mu, row.squeal_level_db, row.squeal_frequency_hz) == (0.41, 84.0, 2345.0)
    assert row.judged


def test_skipped_by_the_operator(model):
    model.fold([started(1), record("verb", verb="skip", braking=1)])
    model.fold([record("braking_broken_off", index=1, reason="skip by the operator"), started(2)])
    assert model.rows[0].state is RowState.SKIPPED and "skip" in model.rows[0].note
    model.fold([committed(1, "incomplete")])  # the recorder is later
    assert model.rows[0].state is RowState.SKIPPED
    assert model.not_done() == [1]


def test_skipped_while_paused(model):
    model.fold(
        [started(1), record("verb", verb="pause", braking=1), record("state", state="paused", why="p")]
    )
    model.fold([committed(1, "incomplete", note="pause by the operator")])  # the recorder is later
    assert model.rows[0].state is RowState.WAITING
    model.fold([
        record("verb", verb="skip", braking=1),
        record("braking_broken_off", index=1, reason="pause by the operator"),
    ])  # fmt: skip
    assert model.rows[0].state is RowState.SKIPPED


def test_repeated_is_not_incomplete(model):
    model.fold([started(1), record("verb", verb="repeat", braking=1)])
    model.fold([started(1), committed(1, "incomplete", note="repeat by the operator")])
    assert model.rows[0].state is RowState.CONDITIONING
    model.fold([committed(1, "complete", attempt=2)])
    assert (model.rows[0].state, model.rows[0].attempt) == (RowState.COMPLETE, 2)
    assert model.rows[0].note == ""


def test_too_hot_is_incomplete_with_the_reason(model):
    model.fold([started(1), committed(1, "incomplete", note="disc at 510 °C")])
    model.fold([record("braking_broken_off", index=1, reason="disc at 510 °C, above max_degc 500 °C")])
    assert model.rows[0].state is RowState.INCOMPLETE and "510" in model.rows[0].note


def test_stopped_in_the_middle_of_a_recording(model):
    model.fold([started(2), committed(2, "incomplete", note="stop by the operator")])
    assert model.rows[1].state is RowState.CONDITIONING  # it could be done again at once
    model.fold([record("ended", outcome="stopped", done=1, cause="stopped by the operator")])
    assert model.rows[1].state is RowState.INCOMPLETE
    assert model.end is not None
    assert (model.end.outcome, model.end.done) == (Outcome.STOPPED, 1)


def test_stopped_before_anything_was_recorded(model):
    model.fold([started(2), record("ended", outcome="stopped", done=0, cause="")])
    assert model.rows[1].state is RowState.WAITING


def test_a_trip_ends_the_run_with_the_first_cause(model):
    model.fold([
        started(1),
        record("trip", "watchdog", words="Pressure is too high.", remedy="Find out why."),
        record("trip", "watchdog", words="Something later.", remedy="no"),
        record("ended", outcome="tripped", done=0, cause=""),
        record("run_ended", "supervisor", outcome="tripped", done=0, cause=""),
    ])  # fmt: skip
    assert model.end is not None
    assert (model.end.outcome, model.end.cause) == (Outcome.TRIPPED, "Pressure is too high.")
    assert model.end.remedy == "Find out why."


def test_recovered_after_a_crash_and_resumed(model):
    model.fold([started(1), record("run_ended", "supervisor", outcome="failed", done=0, cause="killed")])
    model.fold([committed(1, "recovered")])
    assert model.rows[0].state is RowState.RECOVERED
    model.fold([record("run_started", "supervisor", attempt=1), started(1)])
    assert model.end is None
    assert model.rows[0].state is RowState.CONDITIONING


def test_hold_is_remembered_until_it_is_obeyed_or_taken_back(model):
    model.fold([started(1), record("verb", verb="hold", braking=1)])
    assert model.hold_asked
    model.fold([record("verb", verb="resume", braking=1)])
    assert not model.hold_asked
    model.fold([record("verb", verb="hold", braking=1), record("state", state="paused", why="held")])
    assert not model.hold_asked


def test_notes_and_ratings(model):
    model.fold([
        started(3),
        record("operator_note", index=3, who="anna", text="groan"),
        record("operator_note", index=3, who="anna", text="smell"),
        record("operator_rating", index=3, who="anna", rating=6),
        record("BRAKING_ANNOTATED", "operator", index=3, action="rate", value=4),
        record("BRAKING_ANNOTATED", "operator", index=3, action="note", value="later word"),
        record("BRAKING_ANNOTATED", "operator", index=3, action="tag", value="x"),
    ])  # fmt: skip
    assert model.rows[2].note == "groan · smell · later word"
    assert model.rows[2].rating == 4
    model.fold([started(3)])
    assert model.rows[2].note == "" and model.rows[2].rating == 0


def test_results_of_an_earlier_attempt_are_passed_over(model):
    model.fold([started(1), committed(1), started(1)])
    assert model.summary(1, summary()) == set()
    model.fold([committed(1, attempt=2)])
    assert model.summary(1, summary(attempt=1)) == set()
    assert model.summary(1, summary(attempt=2)) == {1}


def test_brakings_by_hand_make_rows_of_their_own():
    model = RunModel()
    model.fold([
        record("manual", do="record", duration_s=5, speed_rpm=80.0, pressure_bar=12.0),
        record("braking_started", index=1, sequence="manual", temperature_degc=None, pressure_bar=12.0),
        committed(1),
    ])  # fmt: skip
    row = model.rows[0]
    assert (row.index, row.sequence, row.pressure_bar, row.speed_rpm) == (1, "manual", 12.0, 80.0)
    assert row.state is RowState.COMPLETE


def test_the_same_journal_gives_the_same_rows(model):
    records = [started(1), committed(1), started(2), record("verb", verb="skip", braking=2),
               record("braking_broken_off", index=2, reason="skip"), started(3)]  # fmt: skip
    for single in records:
        model.fold([single])
    again = RunModel()
    again.add(rows_of(PROGRAM))
    again.fold(records)
    assert again.rows == model.rows


def test_the_occurrence_map_fills_and_follows_the_rules_of_the_report(model):
    cells = model.occurrence.cells
    assert set(cells) == {(p, t) for p in (6.0, 20.0, 26.0) for t in (40.0, 60.0)}
    model.fold([started(1), committed(1), started(2), committed(2)])
    model.summary(1, summary(level=None))
    model.summary(2, summary(level=88.0))
    quiet, loud = model.rows[0], model.rows[1]
    assert cells[quiet.pressure_bar, quiet.temperature_degc].judged == {1}
    cell = cells[loud.pressure_bar, loud.temperature_degc]
    assert (cell.level_db, cell.loudest) == (88.0, 2)
    assert (model.occurrence.judged, model.occurrence.squealing) == (2, 1)
    model.fold([started(2)])  # done again: not judged until it is
    assert model.occurrence.judged == 1 and cell.level_db is None


def test_without_a_set_temperature_the_measured_one_sorts_into_classes():
    model = RunModel()
    model.fold([record("braking_started", index=1, sequence="m", pressure_bar=6.0), committed(1)])
    assert model.occurrence.cells == {}
    model.summary(1, summary(level=80.0))
    assert list(model.occurrence.cells) == [(6.0, 60.0)]
    model.fold([started(1), committed(1, attempt=2)])
    assert model.occurrence.cells == {}
    model.summary(1, summary(attempt=2, sound=False))
    assert model.occurrence.cells == {}


def test_rows_without_sound_have_no_cell():
    model = RunModel()
    model.add([Row(1, "bedding", 100.0, 100.0, 100.0, 10.0, sound=False)])
    assert model.occurrence.cells == {}


# -- verbs ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("state", "hold", "allowed"),
    [
        (RUNNING, False, {Verb.PAUSE, Verb.HOLD, Verb.SKIP, Verb.REPEAT, Verb.STOP}),
        (RUNNING, True, {Verb.PAUSE, Verb.RESUME, Verb.SKIP, Verb.REPEAT, Verb.STOP}),
        (replace(RUNNING, word=Word.PAUSED), False, {Verb.RESUME, Verb.SKIP, Verb.REPEAT, Verb.STOP}),
        (replace(RUNNING, word=Word.STOPPING), False, set()),
        (replace(RUNNING, word=Word.TRIPPED), False, set()),
        (replace(RUNNING, commanding=False), False, set()),
        (replace(RUNNING, mode="manual"), False, set()),
    ],
)
def test_verbs_that_can_be_asked(state, hold, allowed):
    permissions = {verb: may(verb, state, hold) for verb in VERBS}
    assert {verb for verb, permission in permissions.items() if permission.allowed} == allowed
    assert all(permission.reason for permission in permissions.values() if not permission.allowed)
    assert all(consequence(verb) for verb in VERBS)


# -- pace -----------------------------------------------------------------------------------------


def test_pace_over_the_last_seconds():
    pace = Pace()
    assert pace.factor is None
    for second in range(30):
        pace.see(second * 50.0, float(second))
    assert pace.factor == pytest.approx(50.0)
    for second in range(30, 45):  # slower now
        pace.see(1450.0 + (second - 29) * 10.0, float(second))
    assert pace.factor == pytest.approx(10.0)
    pace.see(0.0, 46.0)
    assert pace.factor is None


def test_end_in_local_time():
    now = datetime(2026, 11, 30, 22, 0)
    assert end_text(now, 3600.0) == "23:00"
    assert end_text(now, 3 * 3600.0) == "Tue 01:00"


def test_stretches():
    assert stretches([]) == []
    assert stretches([1, 2, 3, 7, 9, 10]) == [(1, 3), (7, 7), (9, 10)]


# -- what could be run ----------------------------------------------------------------------------


def test_shipped_programs_are_offered_and_wrong_files_say_why(tmp_path):
    programs = list_programs(ROOT / "configs" / "programs")
    assert {"quick_check", "squeal_matrix"} <= {choice.name for choice in programs}
    assert all(choice.count and not choice.problem for choice in programs)
    (tmp_path / "bad.toml").write_text("format = 1", encoding="utf-8")
    assert list_programs(tmp_path)[0].problem


def make_campaign(folder, *records):
    folder.mkdir(parents=True)
    text = dump_program(PROGRAM).replace("[[sequences", "[[program.sequences")
    text = text.replace("[sequences", "[program.sequences")
    (folder / "campaign.toml").write_text(f'[rig]\nname = "R"\n\n[program]\n{text}', encoding="utf-8")
    for source, kind, payload in records:
        journal = Journal(folder / "journal.jsonl", source)
        journal.write(kind, **payload)
        journal.close()


def test_campaigns_with_brakings_left(tmp_path):
    done = [("recorder", "BRAKING_COMMITTED", {"index": i, "status": "complete"}) for i in range(1, 7)]
    make_campaign(tmp_path / "whole", *done)
    make_campaign(tmp_path / "half", *done[:3], ("watchdog", "trip", {"words": "Too hot."}))
    make_campaign(tmp_path / "reset", *done[:1], ("watchdog", "trip", {"words": "Too hot."}),
                  ("watchdog", "reset", {}))  # fmt: skip
    (tmp_path / "damaged").mkdir()
    (tmp_path / "damaged" / "campaign.toml").write_text("[", encoding="utf-8")
    found = {campaign.path.name: campaign for campaign in list_open_campaigns(tmp_path)}
    assert set(found) == {"half", "reset"}
    assert (found["half"].done, found["half"].total, found["half"].trip) == (3, 6, "Too hot.")
    assert (found["reset"].done, found["reset"].trip) == (1, "")
    assert found["half"].rig == "R"
    assert list_open_campaigns(tmp_path / "nowhere") == []

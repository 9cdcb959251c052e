"""The run page as a person uses it: table, map, verbs, notes, the end of a run."""

from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtWidgets import QApplication, QLabel, QLineEdit, QPushButton
from recording_rig import MANUAL, ROOT, record, session
from test_gui_run_model import committed, make_campaign, started, summary

from rigctl.engine.state import Verb
from rigctl.gui.pages.run import page as page_module
from rigctl.gui.pages.run.page import RunPage
from rigctl.gui.pages.run.rows import RowState
from rigctl.gui.pages.run.table import MU, NOTE, RATING, STATE
from rigctl.gui.rig.state import RigState, SafetyCause, Word
from sequences.program import load_program

QUICK = load_program(ROOT / "configs" / "programs" / "quick_check.toml")
MATRIX = load_program(ROOT / "configs" / "programs" / "squeal_matrix.toml")
RUNNING = replace(
    MANUAL, word=Word.RUNNING, mode="program", phase="braking with 6 bar", braking=1, total=6, left_s=600.0
)


@pytest.fixture
def page(services, rig, qtbot):
    made = RunPage(services)
    qtbot.addWidget(made)
    made.resize(1140, 650)
    made.show()
    qtbot.waitExposed(made)
    made.activateWindow()
    made.activated()
    yield made
    made.deactivated()


def attach(page, rig, qtbot, tmp_path, program=QUICK, **more):
    facts = {"program": program, "mode": "program", "campaign": tmp_path / "campaign", "time": "virtual"}
    rig.attach(session(**{**facts, **more}))
    if program is not None:
        qtbot.waitUntil(lambda: len(page.model.rows) == program.count)


@pytest.fixture
def run(page, rig, qtbot, tmp_path):
    """A run of six brakings; the first is under way."""
    attach(page, rig, qtbot, tmp_path)
    tell(rig, record("run_started", "supervisor", attempt=0), started(1))
    rig.say(RUNNING)
    return page


def tell(rig, *records):
    rig.records += records
    rig.recordsAdded.emit(list(records))


def find(page, name, kind=QPushButton):
    found = page.findChild(kind, name)
    assert found is not None, name
    return found


def wait_for(page, qtbot, name):
    """Lists are read in a thread."""

    def there():
        button = page.findChild(QPushButton, name)
        return button is not None and button.isVisible()

    qtbot.waitUntil(there)


def click(page, qtbot, name):
    button = find(page, name)
    assert button.isVisible() and button.isEnabled(), f"{name}: {button.toolTip()}"
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def cell(page, row, column):
    return page.table_model.data(page.table_model.index(row, column))


# -- without a run --------------------------------------------------------------------------------


def test_without_a_run_it_offers_programs(page, services, qtbot):
    wait_for(page, qtbot, "program-quick_check")
    assert page.start.isVisible()
    click(page, qtbot, "program-quick_check")
    assert services.shown == [("sequence", {"program": ROOT / "configs" / "programs" / "quick_check.toml"})]


def test_campaigns_that_are_not_complete_can_be_resumed(page, services, rig, qtbot):
    done = [("recorder", "BRAKING_COMMITTED", {"index": i, "status": "complete"}) for i in (1, 2)]
    make_campaign(services.data_folder / "half", *done)
    make_campaign(services.data_folder / "hot", *done, ("watchdog", "trip", {"words": "Too hot."}))
    page.activated()
    wait_for(page, qtbot, "resume-half")
    click(page, qtbot, "resume-half")
    assert rig.asked == [("resume", (services.data_folder / "half", ""), {})]
    click(page, qtbot, "resume-hot")  # wants a reason first
    assert len(rig.asked) == 1
    edit = find(page, "campaign-reason-text", QLineEdit)
    qtbot.keyClicks(edit, "it has cooled")
    qtbot.keyClick(edit, Qt.Key.Key_Return)
    assert rig.asked[-1] == ("resume", (services.data_folder / "hot", "it has cooled"), {})
    rig.say(RigState(word=Word.STARTING))
    assert "Starting" in page.start.busy.text()
    rig.say(RigState())
    rig.refused.emit("The disk is full.")
    assert "The disk is full." in page.start.busy.text()


# -- a run ----------------------------------------------------------------------------------------


def test_rows_follow_the_journal(run, rig):
    assert run.splitter.isVisible() and not run.start.isVisible()
    assert cell(run, 0, STATE) == "● conditioning" and cell(run, 1, STATE) == "waiting"
    rig.say(replace(RUNNING, recording=True))
    assert cell(run, 0, STATE) == "● braking"
    tell(rig, committed(1), started(2))
    assert cell(run, 0, STATE) == "✓ complete" and cell(run, 1, STATE) == "● conditioning"


def test_results_come_from_the_committed_files(run, rig, qtbot, tmp_path, monkeypatch):
    asked = []

    def read(files, reporter=None):
        asked.extend(files)
        return [(index, summary(level=84.25, frequency=12345.0)) for index, _ in files]

    monkeypatch.setattr("rigctl.gui.pages.run.summaries.read_summaries", read)
    tell(rig, committed(1), record("operator_rating", index=1, rating=7))
    qtbot.waitUntil(lambda: run.reader.idle and cell(run, 0, MU) != "")
    assert asked == [(1, tmp_path / "campaign" / "brakings" / "00001.h5")]
    assert [cell(run, 0, column) for column in range(MU, NOTE)] == ["0.410", "84.2", "12.35\u202fkHz", "7"]
    assert "squeal in 1 of 1" in run.count.text()


def test_a_file_that_cannot_be_read_leaves_the_row(run, rig, qtbot):
    tell(rig, committed(1))
    qtbot.waitUntil(lambda: run.reader.idle)
    assert cell(run, 0, STATE) == "✓ complete" and cell(run, 0, MU) == ""


def test_records_wait_until_the_rows_of_a_long_program_are_made(page, rig, qtbot, tmp_path, monkeypatch):
    monkeypatch.setattr(page_module, "CHUNK", 50)
    rig.attach(session(program=MATRIX, mode="program", campaign=tmp_path, time="virtual"))
    tell(rig, started(200))
    assert len(page.model.rows) < MATRIX.count
    qtbot.waitUntil(lambda: len(page.model.rows) == MATRIX.count)
    assert [row.index for row in page.model.rows] == list(range(1, MATRIX.count + 1))
    qtbot.waitUntil(lambda: page.model.row(200).state is RowState.CONDITIONING)


def test_a_page_made_later_catches_up(services, rig, qtbot, tmp_path):
    rig.attach(session(program=QUICK, mode="program", campaign=tmp_path, time="virtual"))
    tell(rig, started(1), committed(1), started(2))
    rig.say(replace(RUNNING, braking=2))
    late = RunPage(services)
    qtbot.addWidget(late)
    late.show()
    late.activated()
    assert late.model.rows[0].state is RowState.COMPLETE and late.model.present == 2
    assert late.splitter.isVisible() and find(late, "verb-pause").isEnabled()
    qtbot.waitUntil(lambda: late.reader.idle)
    late.deactivated()


def test_the_present_braking_is_followed_until_scrolled_by_hand(page, rig, qtbot, tmp_path):
    attach(page, rig, qtbot, tmp_path, MATRIX)
    rig.say(RUNNING)
    tell(rig, started(150))
    rows = page.table

    def in_sight(place):
        return rows.viewport().rect().intersects(rows.visualRect(page.table_model.index(place, 0)))

    assert in_sight(149)
    qtbot.waitUntil(lambda: rows.verticalScrollBar().maximum() > 0)
    middle = rows.viewport().rect().center()
    wheel = QWheelEvent(
        middle, rows.viewport().mapToGlobal(middle), QPoint(), QPoint(0, 1200), Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(rows.viewport(), wheel)
    assert not rows.follows() and not page.follow.isChecked()
    tell(rig, started(250))
    assert not in_sight(249)
    click(page, qtbot, "run-follow")
    assert rows.follows() and in_sight(249)


def test_cursor_keys_end_following_and_enter_opens(run, rig, services, qtbot, tmp_path):
    tell(rig, committed(1), started(2))
    run.table.setFocus()
    run.table.selectRow(1)
    qtbot.keyClick(run.table, Qt.Key.Key_Up)
    assert not run.table.follows()
    qtbot.keyClick(run.table, Qt.Key.Key_Return)
    assert services.shown == [("data", {"campaign": tmp_path / "campaign", "braking": 1})]
    run.table.opened.emit(2)  # nothing recorded yet
    assert len(services.shown) == 1 and "no recording" in services.news[-1]


def test_status_says_phase_time_left_and_pace(run, rig):
    rig.say(replace(RUNNING, time="virtual", phase="heating to 60 °C"))
    assert find(run, "run-phase", QLabel).text() == "heating to 60 °C"
    assert find(run, "run-left", QLabel).text() == "10:00"
    assert ":" in find(run, "run-end", QLabel).text()
    assert "Braking 1" in find(run, "run-what", QLabel).text()
    rig.say(replace(RUNNING, time="real"))
    assert find(run, "run-factor", QLabel).text() == "by the clock"


def test_the_map_fills_and_a_click_opens_the_loudest_braking(run, rig, services, qtbot, tmp_path):
    tell(rig, committed(1), started(2), committed(2))
    run._on_summaries([(1, summary()), (2, summary(level=91.0))])
    run.map.refresh()
    assert "1 of 2" in run.map.title.text()
    quiet, loud = run.model.rows[0], run.model.rows[1]
    place = {
        row.index: (
            run.model.occurrence.pressures.index(row.pressure_bar),
            run.model.occurrence.temperatures.index(row.temperature_degc),
        )
        for row in (quiet, loud)
    }
    assert "no squeal in 1" in run.map.describe(*place[1])
    assert "squeal in 1 of 1, up to 91.0 dB" in run.map.describe(*place[2])
    assert run.map.describe(-3.0, 0.0) == ""
    spot = run.map._item.vb.mapViewToScene(QPoint(*place[2]))
    qtbot.mouseClick(run.map.plot.viewport(), Qt.MouseButton.LeftButton, pos=run.map.plot.mapFromScene(spot))
    assert services.shown == [("data", {"campaign": tmp_path / "campaign", "braking": 2})]


# -- verbs, notes, rating -------------------------------------------------------------------------


@pytest.mark.parametrize("verb", [Verb.PAUSE, Verb.HOLD, Verb.SKIP, Verb.REPEAT])
def test_verbs_are_asked_of_the_rig(run, rig, qtbot, verb):
    click(run, qtbot, f"verb-{verb.value}")
    assert rig.asked == [("verb", (verb,), {})]


def test_verbs_that_do_not_apply_say_why(run, rig):
    assert not find(run, "verb-resume").isEnabled()
    assert "does not wait" in find(run, "verb-resume").toolTip()
    assert "does it again" in find(run, "verb-pause").toolTip()
    rig.say(replace(RUNNING, word=Word.PAUSED))
    assert find(run, "verb-resume").isEnabled() and not find(run, "verb-pause").isEnabled()


def test_a_refusal_stands_beside_the_verbs_until_something_changes(run, rig):
    rig.refused.emit("A program is running.")
    refused = find(run, "verb-refused", QLabel)
    assert refused.isVisible() and "A program is running" in refused.text()
    rig.say(replace(RUNNING, word=Word.PAUSED))
    assert not refused.isVisible()


def test_a_hold_is_shown_and_can_be_taken_back(run, rig, qtbot):
    tell(rig, record("verb", verb="hold", braking=1))
    assert "Will hold" in find(run, "verb-hold").text()
    assert "waits after this braking" in find(run, "run-what", QLabel).text()
    click(run, qtbot, "verb-resume")
    assert rig.asked == [("verb", (Verb.RESUME,), {})]


def test_abort_asks_in_place(run, rig, qtbot):
    click(run, qtbot, "verb-stop")
    assert rig.asked == []
    assert "ends the run" in find(run, "abort-confirm-question", QLabel).text()
    click(run, qtbot, "abort-confirm-no")
    click(run, qtbot, "verb-stop")
    click(run, qtbot, "abort-confirm-yes")
    assert rig.asked == [("verb", (Verb.STOP,), {})]


def test_watching_only_offers_to_take_command(run, rig, qtbot):
    rig.say(replace(RUNNING, commanding=False, commander="bert"))
    assert not find(run, "verb-pause").isEnabled()
    click(run, qtbot, "run-take-command")
    assert rig.asked == [("take_command", (), {})]


def test_number_keys_rate_and_n_writes_a_note(run, rig, qtbot):
    run.table.setFocus()
    qtbot.keyClick(run.table, "6")
    assert rig.asked == [("rate", (6,), {})]
    assert run.verbs.rating.value() == 6
    qtbot.keyClick(run.table, "n")
    edit = find(run, "note-line-text", QLineEdit)
    assert edit.isVisible() and edit.hasFocus()
    qtbot.keyClicks(edit, "groan 7 n")  # letters and digits are text here
    qtbot.keyClick(edit, Qt.Key.Key_Return)
    assert rig.asked[1:] == [("note", ("groan 7 n",), {})]
    assert not edit.isVisible()
    tell(
        rig, record("operator_note", index=1, text="groan 7 n"), record("operator_rating", index=1, rating=6)
    )
    assert cell(run, 0, NOTE) == "groan 7 n" and cell(run, 0, RATING) == "6"
    tell(rig, started(2))
    assert run.verbs.rating.value() == 0  # the next braking is not rated yet


def test_escape_leaves_the_note(run, rig, qtbot):
    click(run, qtbot, "run-note")
    edit = find(run, "note-line-text", QLineEdit)
    qtbot.keyClick(edit, Qt.Key.Key_Escape)
    assert not edit.isVisible() and rig.asked == []


# -- the end --------------------------------------------------------------------------------------


def end(rig, outcome, done, cause="", **state):
    tell(rig, record("ended", outcome=outcome, done=done, cause=cause))
    rig.say(replace(RUNNING, word=Word.OFFLINE, commander="", commanding=False, left_s=None, **state))
    rig.detached.emit(f"The session has ended: {outcome}.")


def test_the_result_is_said_once_with_what_is_left(run, rig, services, qtbot, tmp_path):
    tell(rig, committed(1), started(2), record("verb", verb="skip", braking=2),
         record("braking_broken_off", index=2, reason="skip by the operator"))  # fmt: skip
    end(rig, "finished", 5)
    assert "5 of 6" in find(run, "run-outcome", QLabel).text()
    assert "not complete: 2" in find(run, "run-outcome-text", QLabel).text()
    assert not run.verbs.isVisible() and run.table.isVisible()
    assert not find(run, "open-report").isEnabled()
    click(run, qtbot, "open-data")
    assert services.shown == [("data", {"campaign": tmp_path / "campaign"})]
    click(run, qtbot, "resume")
    assert rig.asked == [("resume", (tmp_path / "campaign", ""), {})]
    rig.refused.emit("Another process works on this campaign.")
    refused = find(run, "run-refused", QLabel)
    assert refused.isVisible() and "Another process" in refused.text()


def test_after_a_complete_run_there_is_nothing_to_resume(run, rig, qtbot, tmp_path):
    end(rig, "finished", 6)
    assert not find(run, "resume").isVisible()
    report = tmp_path / "campaign" / "report"
    report.mkdir(parents=True)
    (report / "report.html").write_text("<p>report</p>", encoding="utf-8")
    rig.say(rig.state)
    assert find(run, "open-report").isEnabled()
    click(run, qtbot, "other-run")
    assert run.start.isVisible()


def test_after_a_trip_resuming_wants_a_reason_and_it_can_be_reset(run, rig, qtbot, tmp_path):
    cause = SafetyCause("Pressure is too high.", "Find out why.")
    tell(rig, record("trip", "watchdog", words=cause.words, remedy=cause.remedy))
    tell(rig, record("ended", outcome="tripped", done=0, cause=cause.words))
    rig.say(replace(RUNNING, word=Word.TRIPPED, commander="", commanding=False, cause=cause))
    rig.detached.emit("The session has ended: tripped.")
    text = find(run, "run-outcome-text", QLabel).text()
    assert "too high" in text and "Find out why" in text
    assert find(run, "run-outcome", QLabel).property("look") == "alarm"
    click(run, qtbot, "run-reset")
    edit = find(run, "run-reset-reason-text", QLineEdit)
    qtbot.keyClicks(edit, "valve opened")
    qtbot.keyClick(edit, Qt.Key.Key_Return)
    assert rig.asked == [("reset", ("valve opened",), {})]
    click(run, qtbot, "resume")
    assert len(rig.asked) == 1
    edit = find(run, "resume-reason-text", QLineEdit)
    qtbot.keyClicks(edit, "valve opened")
    qtbot.keyClick(edit, Qt.Key.Key_Return)
    assert rig.asked[-1] == ("resume", (tmp_path / "campaign", "valve opened"), {})


def test_a_resumed_run_begins_a_new_picture(run, rig, qtbot, tmp_path):
    end(rig, "stopped", 0)
    attach(run, rig, qtbot, tmp_path)
    tell(rig, started(1), committed(1))
    tell(rig, record("run_started", "supervisor", attempt=1))
    rig.say(RUNNING)
    assert not run.result.isVisible() and run.verbs.isVisible()
    assert run.table.follows() and cell(run, 0, STATE) == "✓ complete"


def test_brakings_by_hand_are_listed_without_verbs(page, rig, qtbot, tmp_path):
    attach(page, rig, qtbot, tmp_path, None, mode="manual")
    rig.say(MANUAL)
    tell(rig, record("manual", do="record", speed_rpm=40.0),
         record("braking_started", index=1, sequence="manual", pressure_bar=12.0), committed(1))  # fmt: skip
    assert page.table_model.rowCount() == 1 and page.table.isVisible()
    assert not find(page, "verb-pause").isVisible()
    assert find(page, "run-note").isVisible()
    tell(rig, record("ended", outcome="stopped", done=1))  # a manual session has no result to be told
    assert not page.result.isVisible()
    qtbot.waitUntil(lambda: page.reader.idle)


def test_ten_thousand_rows_stay_fast(page, rig, qtbot):
    rows = MATRIX.model_copy(update={"sequences": (MATRIX.sequences[1].model_copy(update={"repeat": 45}),)})
    attach(page, rig, qtbot, page.services.data_folder, rows)
    assert page.table_model.rowCount() == 10125
    tell(rig, *[item for i in range(1, 4001) for item in (started(i), committed(i))])
    assert page.model.count(RowState.COMPLETE) < 4000  # the window is not held up by a long journal
    qtbot.waitUntil(lambda: page.model.count(RowState.COMPLETE) == 4000)
    page.reader.begin(None)


def test_every_control_has_a_tip(run):
    bare = [button.objectName() for button in run.verbs.findChildren(QPushButton) if not button.toolTip()]
    bare += [button.objectName() for button in run.result.findChildren(QPushButton) if not button.toolTip()]
    assert bare == []


def test_live_traces_rest_with_the_page(run, rig):
    assert run.live.running
    run.deactivated()
    assert not run.live.running
    rig.say(RUNNING)
    assert not run.live.running


def test_layout_is_remembered(run, services):
    run.splitter.setSizes([700, 440])
    sizes = run.splitter.sizes()
    run.save_layout(services.settings)
    run.splitter.setSizes([500, 640])
    run.restore_layout(services.settings)
    assert run.splitter.sizes() == sizes


def test_help_names_the_keys(page):
    assert "N" in page.help_text() and "1 … 9" in page.help_text()

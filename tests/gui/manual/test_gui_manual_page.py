"""The manual page as a person uses it: mouse and keys, and what was asked of the rig."""

from dataclasses import replace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QLabel, QLineEdit, QPushButton, QWidget
from recording_rig import LOCKED, MANUAL, RIGS, session

from rigctl.gui.pages.manual.page import ManualPage
from rigctl.gui.rig.state import SafetyCause, Word


@pytest.fixture
def page(services, rig, qtbot):
    made = ManualPage(services)
    qtbot.addWidget(made)
    made.resize(1140, 650)
    made.show()
    qtbot.waitExposed(made)
    made.activateWindow()
    made.activated()
    yield made
    made.deactivated()


@pytest.fixture
def manual(page, rig, qtbot):
    """With a session that is enabled, and limits of the watchdog."""
    rig.attach(session())
    rig.say(MANUAL)
    qtbot.waitUntil(lambda: page.model.limits is not None)
    return page


def find(page: QWidget, name: str, kind: type = QPushButton):
    found = page.findChild(kind, name)
    assert found is not None, name
    return found


def click(page, qtbot, name):
    button = find(page, name)
    assert button.isVisible() and button.isEnabled(), f"{name}: {button.toolTip()}"
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def type_in(page, qtbot, name, text, enter=True):
    edit = find(page, name, QLineEdit)
    edit.setFocus()
    edit.selectAll()
    qtbot.keyClicks(edit, text)
    if enter:
        qtbot.keyClick(edit, Qt.Key.Key_Return)
    return edit


def test_without_a_session_it_teaches_and_connects(page, rig, qtbot):
    qtbot.waitUntil(lambda: page.panel.rig.count() > 0)
    assert page.panel.isVisible()
    assert "SIMULATED" in page.panel.rig.currentText()
    page.panel.virtual.setChecked(True)
    click(page, qtbot, "connect")
    assert rig.asked == [("start_manual", (RIGS / "simulated.toml",), {"time": "virtual"})]
    assert not find(page, "connect").isEnabled() and "Starting" in find(page, "connect").text()
    rig.refused.emit("the campaign folder cannot be made.")
    assert find(page, "connect").isEnabled()
    assert "cannot be made" in page.panel.error.text()


def test_a_real_rig_has_no_choice_of_time(page, qtbot):
    qtbot.waitUntil(lambda: page.panel.rig.count() > 0)
    real = next(i for i in range(page.panel.rig.count()) if "REAL" in page.panel.rig.itemText(i))
    page.panel.virtual.setChecked(True)
    page.panel.rig.setCurrentIndex(real)
    assert not page.panel.virtual.isVisible()
    value = page.panel.value()
    assert value is not None and value[1] == "real"


def test_a_broken_rig_file_says_what_is_wrong(page, services, rig, qtbot, tmp_path):
    folder = tmp_path / "configs" / "rigs"
    folder.mkdir(parents=True)
    (folder / "bad.toml").write_text("name = 1", encoding="utf-8")
    services.config_folder = folder.parent
    page.activated()
    qtbot.waitUntil(page.panel.error.isVisible)
    assert "bad.toml" in page.panel.error.text()
    assert not find(page, "connect").isEnabled()


def test_a_page_made_later_finds_the_session(services, rig, qtbot):
    rig.attach(session())
    rig.say(MANUAL)
    late = ManualPage(services)
    qtbot.addWidget(late)
    late.show()
    assert late.model.rig is not None and late.controls.isVisible()
    qtbot.waitUntil(lambda: late.model.limits is not None)


def test_enabling_says_what_will_move_first_and_asks_once(manual, rig, qtbot):
    rig.say(LOCKED)
    click(manual, qtbot, "enable")
    assert rig.asked == []
    question = find(manual, "enable-confirm-question", QLabel)
    assert question.isVisible() and "up to 800\u202f1/min" in question.text()
    assert find(manual, "enable-confirm-no").hasFocus()
    click(manual, qtbot, "enable-confirm-no")
    assert rig.asked == [] and not question.isVisible()
    click(manual, qtbot, "enable")
    click(manual, qtbot, "enable-confirm-yes")
    assert rig.asked == [("enable", (), {})]
    rig.say(MANUAL)
    click(manual, qtbot, "disable")
    rig.say(LOCKED)
    click(manual, qtbot, "enable")  # not asked again in this session
    assert [name for name, _, _ in rig.asked] == ["enable", "disable", "enable"]


def test_escape_answers_no(manual, rig, qtbot):
    rig.say(LOCKED)
    click(manual, qtbot, "enable")
    qtbot.keyClick(find(manual, "enable-confirm-no"), Qt.Key.Key_Escape)
    assert not find(manual, "enable-confirm", QWidget).isVisible()
    assert find(manual, "enable").isVisible() and rig.asked == []


def test_speed_and_ramp(manual, rig, qtbot):
    type_in(manual, qtbot, "ramp", "50", enter=False)
    type_in(manual, qtbot, "speed", "250")
    assert rig.asked == [("set_speed", (250.0, 50.0), {})]
    click(manual, qtbot, "stop-motor")
    assert rig.asked[-1] == ("set_speed", (0.0, 100.0), {})
    assert manual.controls.motor.speed.in_force.text() == "▸ 100"


def test_a_speed_outside_is_refused_at_the_field(manual, rig, qtbot):
    type_in(manual, qtbot, "speed", "900")
    assert rig.asked == []
    error = find(manual, "speed-error", QLabel)
    assert error.isVisible() and "above the 800" in error.text()
    assert not find(manual, "start-braking").isEnabled()


def test_pressure_constant_and_release_by_space(manual, rig, qtbot):
    edit = type_in(manual, qtbot, "pressure", "15,5")
    assert rig.asked == [("set_pressure", (15.5, None, None), {})]
    qtbot.keyClick(edit, Qt.Key.Key_Space)
    assert rig.asked[-1] == ("set_pressure", (0.0,), {})
    click(manual, qtbot, "release")
    assert len(rig.asked) == 3


def test_space_in_the_comment_is_a_blank(manual, rig, qtbot):
    comment = type_in(manual, qtbot, "record-comment", "new pads", enter=False)
    assert comment.text() == "new pads" and rig.asked == []


def test_space_releases_even_from_a_button(manual, rig, qtbot):
    button = find(manual, "disable")
    button.setFocus()
    qtbot.keyClick(button, Qt.Key.Key_Space)
    assert rig.asked == [("set_pressure", (0.0,), {})]
    qtbot.keyClick(button, Qt.Key.Key_Return)
    assert rig.asked[-1][0] == "disable"


def test_a_course_is_drawn_and_ordered(manual, rig, qtbot):
    box = manual.controls.brake
    box.kind.setCurrentIndex(box.kind.findData("ramp"))
    assert find(manual, "pressure-from", QLineEdit).isVisibleTo(box)
    assert not find(manual, "pressure", QLineEdit).isVisibleTo(box)
    type_in(manual, qtbot, "pressure-from", "4", enter=False)
    type_in(manual, qtbot, "pressure-to", "24", enter=False)
    type_in(manual, qtbot, "course-duration", "5", enter=False)
    points = box.preview.value()
    assert points[0] == pytest.approx((0.0, 4.0)) and points[-1] == pytest.approx((5.0, 24.0))
    click(manual, qtbot, "set-pressure")
    assert rig.asked == [
        ("set_pressure", (14.0, {"kind": "ramp", "amplitude_bar": 10.0, "direction": "rising"}, 5.0), {})
    ]


def test_a_course_beyond_the_rig_says_why_and_is_not_sent(manual, rig, qtbot):
    box = manual.controls.brake
    box.kind.setCurrentIndex(box.kind.findData("sine"))
    type_in(manual, qtbot, "pressure", "38")
    type_in(manual, qtbot, "amplitude", "5")
    assert rig.asked[-1:] != [("set_pressure", (38.0, None, None), {})]
    problem = find(manual, "pressure-problem", QLabel)
    assert "above the 40 bar" in problem.text() and problem.isVisibleTo(box)
    assert not find(manual, "set-pressure").isEnabled()
    count = len(rig.asked)
    type_in(manual, qtbot, "amplitude", "5")
    assert len(rig.asked) == count


def test_steps_are_typed_with_blanks(manual, rig, qtbot):
    box = manual.controls.brake
    box.kind.setCurrentIndex(box.kind.findData("steps"))
    type_in(manual, qtbot, "steps", "0 x", enter=False)
    assert "separated by blanks" in box.problem.text()
    type_in(manual, qtbot, "steps", "0 5 10")
    assert rig.asked[-1] == (
        "set_pressure", (10.0, {"kind": "steps", "steps_bar": [0.0, 5.0, 10.0]}, 10.0), {},
    )  # fmt: skip


def test_pressure_entry_round_trip(manual):
    box = manual.controls.brake
    for kind in ("constant", "ramp", "sine", "triangle", "steps"):
        box.kind.setCurrentIndex(box.kind.findData(kind))
        before = box.entry()
        box.setEntry(before)
        assert box.entry() == before


def test_air_and_temperature(manual, rig, qtbot):
    type_in(manual, qtbot, "temperature", "150")
    type_in(manual, qtbot, "air", "500")
    manual.controls.disc.still.click()
    assert rig.asked == [
        ("condition", (150.0,), {}), ("set_ventilator", (500.0,), {}), ("set_ventilator", (0.0,), {}),
    ]  # fmt: skip
    type_in(manual, qtbot, "temperature", "10")
    assert len(rig.asked) == 3
    assert "below 25" in find(manual, "temperature-error", QLabel).text()


def test_locked_enter_says_what_to_do_first(manual, rig, services, qtbot):
    rig.say(LOCKED)
    type_in(manual, qtbot, "speed", "100")
    assert rig.asked == []
    assert "Enable first" in services.news[-1]
    assert "Enable first" in find(manual, "set-speed").toolTip()


def test_recording_a_braking(manual, rig, qtbot):
    type_in(manual, qtbot, "speed", "40", enter=False)
    type_in(manual, qtbot, "pressure", "20", enter=False)
    type_in(manual, qtbot, "record-duration", "5", enter=False)
    type_in(manual, qtbot, "record-comment", "first try", enter=False)
    assert "20 bar (constant) at 40 1/min" in find(manual, "record-what", QLabel).text()
    click(manual, qtbot, "start-braking")
    assert rig.asked == [
        ("record", (5.0,),
         {"speed_rpm": 40.0, "pressure_bar": 20.0, "function": None, "comment": "first try"}),
    ]  # fmt: skip
    rig.say(replace(MANUAL, word=Word.RUNNING, recording=True, rig_s=10.0))
    rig.say(replace(MANUAL, word=Word.RUNNING, recording=True, rig_s=12.0))
    assert manual.record.bar.isVisible() and "0:03 left" in manual.record.bar.text()
    assert not find(manual, "start-braking").isEnabled()
    assert find(manual, "release").isEnabled()
    click(manual, qtbot, "manual-rating-7")
    assert rig.asked[-1] == ("rate", (7,), {})
    rig.say(MANUAL)
    assert not manual.record.bar.isVisible()


def test_a_braking_that_the_drive_cannot_hold_is_refused_before(manual, qtbot):
    type_in(manual, qtbot, "speed", "800", enter=False)
    type_in(manual, qtbot, "pressure", "40", enter=False)
    what = find(manual, "record-what", QLabel)
    assert "84 kW" in what.text() and what.property("look") == "error"
    assert not find(manual, "start-braking").isEnabled()
    assert find(manual, "set-pressure").isEnabled()  # by hand it is a warning only
    assert find(manual, "pressure-problem", QLabel).property("look") == "warning"


def test_rating_by_key_when_no_field_has_the_cursor(manual, rig, qtbot):
    find(manual, "disable").setFocus()
    qtbot.keyClick(find(manual, "disable"), "8")
    assert rig.asked == [("rate", (8,), {})]
    assert manual.record.rating.value() == 8


def test_watching_disables_everything_but_taking_command(manual, rig, qtbot):
    rig.say(replace(MANUAL, commanding=False, commander="bert"))
    for name in ("set-speed", "set-pressure", "release", "condition", "start-braking"):
        assert not find(manual, name).isEnabled(), name
    assert not find(manual, "disable").isVisible()
    click(manual, qtbot, "take-command")
    assert rig.asked == [("take_command", (), {})]


def test_a_trip_names_cause_and_remedy_and_wants_a_reason(manual, rig, qtbot):
    cause = SafetyCause("Pressure did not fall within 1 s.", "Check the vent valve, then reset.")
    rig.say(replace(LOCKED, word=Word.TRIPPED, cause=cause))
    assert "did not fall" in find(manual, "manual-notice", QLabel).text()
    assert "vent valve" in find(manual, "manual-remedy", QLabel).text()
    assert not find(manual, "enable").isVisible()
    click(manual, qtbot, "reset")
    assert not find(manual, "reset-reason-done").isEnabled()
    edit = find(manual, "reset-reason-text", QLineEdit)
    assert edit.hasFocus()
    qtbot.keyClicks(edit, "valve opened")
    rig.say(replace(LOCKED, word=Word.TRIPPED, cause=cause, rig_s=101.0))  # news don't take the line away
    assert edit.isVisible() and edit.text() == "valve opened"
    qtbot.keyClick(edit, Qt.Key.Key_Return)
    assert rig.asked == [("reset", ("valve opened",), {})]
    rig.refused.emit("A door is open. Close it; then reset.")
    refused = find(manual, "manual-refused", QLabel)
    assert refused.isVisible() and "A door is open" in refused.text()
    rig.say(LOCKED)
    assert not refused.isVisible()
    assert find(manual, "enable").isVisible() and not find(manual, "reset").isVisible()


def test_ending_the_session(manual, rig, qtbot):
    click(manual, qtbot, "end-session")
    assert rig.asked == [("end_session", (), {})]


def test_live_plots_are_shown_beside_the_controls_and_keep_their_layout(real_plots, manual, services):
    view = manual.live.view
    assert view is not None and view.isVisible()
    view.tools.span.setCurrentIndex(0)
    span_s = view.time.span_s
    manual.save_layout(services.settings)
    view.tools.span.setCurrentIndex(view.tools.span.count() - 1)
    manual.restore_layout(services.settings)
    assert view.time.span_s == span_s


def test_live_plots_run_only_while_the_console_is_shown(manual, rig):
    assert manual.live.running
    manual.deactivated()
    assert not manual.live.running
    rig.say(MANUAL)
    assert not manual.live.running
    manual.activated()
    assert manual.live.running
    rig.say(replace(MANUAL, word=Word.OFFLINE, mode=""))
    assert not manual.live.running


def test_a_running_program_makes_the_page_read_only(manual, rig, services, qtbot):
    rig.say(replace(MANUAL, mode="program", word=Word.RUNNING))
    assert not manual.record.isVisible()
    assert not find(manual, "set-speed").isVisible()
    assert manual.readouts.isVisible()
    click(manual, qtbot, "show-run")
    assert services.shown == [("run", {})]


def test_readouts_show_readings_set_points_and_limits(manual, rig):
    hot = replace(MANUAL.readings, temperature_degc=470.0, pressure_bar=41.5)
    rig.say(replace(MANUAL, readings=hot))
    bars = manual.readouts.bars
    assert bars["pressure"].value() == 41.5 and bars["pressure"].setPoint() == 20.0
    assert (bars["pressure"].severity(), bars["temperature"].severity()) == ("alarm", "warning")
    assert bars["speed"].severity() == ""
    assert manual.readouts.mu.text() == "0.430"
    assert bars["torque"].trend.points()
    manual.readouts.setLevel(87.25)
    assert "87.2" in manual.readouts.level.text()


def test_trends_have_no_hole_when_another_page_was_shown(manual, rig):
    manual.deactivated()
    manual.hide()
    for second in range(100, 110):
        rig.say(replace(MANUAL, rig_s=float(second)))
    assert len(manual.readouts.bars["speed"].trend.points()) == 10


def test_the_end_of_a_session_leads_back_and_says_why(manual, rig):
    rig.say(replace(MANUAL, word=Word.OFFLINE, mode=""))
    rig.detached.emit("the controller has gone.")
    assert manual.panel.isVisible()
    assert "the controller has gone" in manual.panel.news.text()


def test_every_control_has_a_tip(manual):
    bare = [
        button.objectName() or button.text()
        for button in manual.findChildren(QPushButton)
        if not button.toolTip() and not button.objectName().endswith("-done")
    ]
    assert bare == []


def test_layout_is_remembered(services, manual, qtbot):
    manual.splitter.setSizes([300, 420, 420])
    sizes = manual.splitter.sizes()
    manual.save_layout(services.settings)
    manual.splitter.setSizes([220, 500, 420])
    manual.restore_layout(services.settings)
    assert manual.splitter.sizes() == sizes


def test_help_names_the_keys(page):
    assert "Space" in page.help_text() and "F12" in page.help_text()

"""What may be done by hand in which state, in which words, and what the rig can do."""

import math
from dataclasses import replace

import pytest
from recording_rig import LOCKED, MANUAL, RIGS, simulated_rig

from rigctl.gui.pages.manual.model import Action, ManualModel, Scene
from rigctl.gui.pages.manual.orders import PressureEntry, PressureOrder, ranges_of
from rigctl.gui.pages.manual.rigs import list_rigs, read_watchdog_limits
from rigctl.gui.rig.state import RigState, SafetyCause, Word
from rigctl.gui.widgets.moving_bar import BarScale
from sequences.pressure import RampPressure


@pytest.fixture(scope="module")
def rig():
    return simulated_rig()


@pytest.fixture
def model(rig):
    made = ManualModel()
    made.session(rig)
    made.show(MANUAL)
    return made


def allowed(model):
    return {action for action in Action if model.may(action).allowed}


MOVES = {
    Action.SPEED, Action.PRESSURE, Action.RELEASE, Action.VENTILATOR, Action.CONDITION, Action.STOP_MOTOR,
    Action.RECORD, Action.DISABLE, Action.RATE, Action.END,
}  # fmt: skip


@pytest.mark.parametrize(
    ("state", "scene"),
    [
        (RigState(), Scene.NO_SESSION),
        (RigState(word=Word.STARTING), Scene.STARTING),
        (replace(MANUAL, mode="program", word=Word.RUNNING), Scene.PROGRAM),
        (replace(MANUAL, mode="program", word=Word.OFFLINE), Scene.NO_SESSION),
        (MANUAL, Scene.MANUAL),
        (replace(MANUAL, word=Word.TRIPPED), Scene.MANUAL),
    ],
)
def test_scenes(model, state, scene):
    model.show(state)
    assert model.scene is scene
    if scene is not Scene.MANUAL:
        assert not allowed(model)


def test_enabled_everything_moves(model):
    assert allowed(model) == MOVES


def test_locked_only_enabling(model):
    model.show(LOCKED)
    assert allowed(model) == {Action.ENABLE, Action.RATE, Action.END}
    assert "Enable first" in model.may(Action.SPEED).reason
    assert model.notice().title.startswith("Locked") and "Press Enable" in model.notice().text


def test_watching_only_taking_command(model):
    model.show(replace(MANUAL, commanding=False, commander="bert"))
    assert allowed(model) == {Action.TAKE_COMMAND}
    assert "bert commands" in model.notice().title
    assert "Take command" in model.may(Action.RELEASE).reason


def test_tripped_only_reset_and_it_says_why(model):
    cause = SafetyCause("Pressure did not fall within 1 s.", "Check the vent valve, then reset.")
    model.show(replace(LOCKED, word=Word.TRIPPED, cause=cause))
    assert allowed(model) == {Action.RESET, Action.RATE, Action.END}
    notice = model.notice()
    assert notice.look == "alarm"
    assert "did not fall" in notice.title and "vent valve" in notice.text


@pytest.mark.parametrize("mode", ["manual", "program"])
def test_after_the_controller_has_gone_only_a_word_is_wanted(model, mode):
    gone = SafetyCause("The controller process has gone.", "The watchdog brings the rig to the safe state.")
    lost = replace(LOCKED, word=Word.TRIPPED, mode=mode, cause=gone, commander="", commanding=False)
    model.show(lost)
    assert model.scene is Scene.MANUAL and allowed(model) == {Action.RESET}
    assert "has gone" in model.notice().title


def test_a_braking_that_is_being_prepared_is_not_ordered_twice(model):
    model.ordered(12.0)
    assert not model.may(Action.RECORD).allowed
    model.show(MANUAL)  # news from before the order was taken
    assert not model.may(Action.RECORD).allowed
    model.show(replace(MANUAL, phase="spinning up to 100 1/min"))
    assert not model.may(Action.RECORD).allowed
    model.show(MANUAL)  # given up without a recording
    assert model.may(Action.RECORD).allowed
    model.ordered(12.0)
    model.refused()
    assert model.may(Action.RECORD).allowed


def test_stopping_waits(model):
    model.show(replace(MANUAL, word=Word.STOPPING))
    assert allowed(model) == {Action.RATE, Action.END}


def test_recording_leaves_the_ways_out(model):
    model.show(replace(MANUAL, recording=True))
    assert allowed(model) == {
        Action.RELEASE, Action.STOP_MOTOR, Action.DISABLE, Action.RATE, Action.END,
    }  # fmt: skip
    assert "being recorded" in model.may(Action.SPEED).reason


def test_the_question_names_what_will_move_and_is_asked_once_a_session(model, rig):
    assert model.enable_question() == (
        "The motor may turn up to 800\u202f1/min and the brake apply up to 40\u202fbar. Is the door closed?"
    )
    assert model.must_ask
    model.answered_yes()
    assert not model.must_ask
    model.session(rig)
    assert model.must_ask


def test_time_left_of_a_recording(model):
    model.ordered(12.0)
    model.show(replace(MANUAL, recording=True, rig_s=50.0))
    model.show(replace(MANUAL, recording=True, rig_s=53.0))
    assert model.recording_progress() == (3.0, 9.0)
    model.show(replace(MANUAL, recording=True, rig_s=54.0, recording_left_s=7.5))  # the engine knows better
    assert model.recording_progress() == (4.0, 7.5)
    model.show(MANUAL)
    assert model.recording_progress() is None
    model.show(replace(MANUAL, recording=True, rig_s=60.0))  # started by somebody else
    assert model.recording_progress() == (0.0, None)


def test_scales_warn_above_the_rig_and_alarm_where_the_watchdog_stops(model):
    model.limits = read_watchdog_limits(RIGS / "../limits/a_class.toml")
    speed, hot = model.scales()["speed"], model.scales()["temperature"]
    assert [speed.severity(v) for v in (800.5, 815.0, 841.0, math.nan)] == ["", "warning", "alarm", ""]
    assert speed.high > 840.0
    assert [hot.severity(v) for v in (440.0, 455.0, 500.0)] == ["", "warning", "alarm"]
    for scale in model.scales().values():
        assert scale.alarm_from is not None and scale.alarm_from < scale.high


def test_scales_without_a_rig_have_no_limits():
    assert all(s.warn_from is None and s.alarm_from is None for s in ManualModel().scales().values())


def test_share_of_a_bar_stays_inside():
    scale = BarScale(0.0, 50.0, "bar")
    assert [scale.share(v) for v in (-5.0, 25.0, 80.0)] == [0.0, 0.5, 1.0]


# -- orders ---------------------------------------------------------------------------------------


def test_limits_are_those_of_the_rig_file(rig):
    ranges = ranges_of(rig)
    assert (ranges["speed"].low, ranges["speed"].high) == (0.0, 800.0)
    assert ranges["ramp"].high == 100.0
    assert ranges["pressure"].problem(0.3) and not ranges["pressure"].problem(0.0)
    assert (ranges["temperature"].low, ranges["temperature"].high) == (25.0, 500.0)
    assert ranges["ventilator"].high == 1000.0


@pytest.mark.parametrize(
    ("start", "end", "direction"), [(2.0, 20.0, "rising"), (20.0, 2.0, "falling"), (5.0, 5.0, "rising")]
)
def test_a_ramp_runs_from_start_to_end(start, end, direction):
    order = PressureEntry(kind="ramp", from_bar=start, to_bar=end, duration_s=8.0).order()
    assert order is not None and order.function is not None
    assert order.function["direction"] == direction
    function = RampPressure.model_validate(order.function)
    assert function.pressure_bar(0.0, order.pressure_bar, 8.0) == pytest.approx(start)
    assert function.pressure_bar(8.0, order.pressure_bar, 8.0) == pytest.approx(end)
    course = order.course()
    assert course[0] == pytest.approx((0.0, start)) and course[-1] == pytest.approx((8.0, end))


def test_orders_of_each_kind_are_functions_of_a_program_file():
    assert PressureEntry().order() == PressureOrder(10.0)
    assert PressureEntry(kind="sine").order() == PressureOrder(
        10.0, {"kind": "sine", "amplitude_bar": 2.0, "frequency_hz": 0.5}, 10.0
    )
    steps = PressureEntry(kind="steps", steps_bar=[0.0, 5.0]).order()
    assert steps is not None
    assert {bar for _, bar in steps.course()} == {10.0, 15.0}


@pytest.mark.parametrize(
    "entry",
    [
        PressureEntry(pressure_bar=None),
        PressureEntry(kind="ramp", to_bar=None),
        PressureEntry(kind="sine", amplitude_bar=None),
        PressureEntry(kind="triangle", duration_s=None),
        PressureEntry(kind="steps", steps_bar=None),
        PressureEntry(kind="ramp", duration_s=None),
    ],
)
def test_no_order_while_a_field_is_refused(entry):
    assert entry.order() is None


@pytest.mark.parametrize(
    ("entry", "words"),
    [
        (PressureEntry(kind="sine", pressure_bar=38.0, amplitude_bar=5.0), "above the 40 bar"),
        (PressureEntry(kind="sine", pressure_bar=1.0, amplitude_bar=3.0), "fall to -2 bar"),
        (PressureEntry(kind="sine", amplitude_bar=9.0, frequency_hz=10.0), "faster than the actuator"),
        (PressureEntry(kind="ramp", from_bar=0.2, to_bar=10.0), "lowest pressure the actuator can hold"),
        (PressureEntry(pressure_bar=10.0), ""),
    ],
)
def test_what_the_rig_cannot_do_is_refused_in_the_words_of_the_dry_run(rig, entry, words):
    order = entry.order()
    assert order is not None
    problem = order.problem(rig.capabilities, 100.0)
    assert words in problem if words else not problem


def test_the_load_of_the_drive_is_a_warning_of_its_own(rig):
    order = PressureOrder(40.0)
    assert order.problem(rig.capabilities, 800.0) == ""
    assert "84 kW" in order.load_problem(rig.capabilities, 800.0)
    assert order.load_problem(rig.capabilities, 100.0) == ""


# -- rigs -----------------------------------------------------------------------------------------


def test_rigs_are_listed_simulated_first_and_wrong_ones_say_why(tmp_path):
    for path in RIGS.glob("*.toml"):
        (tmp_path / path.name).write_text(path.read_text(encoding="utf-8"), encoding="utf-8")
    (tmp_path / "broken.toml").write_text("name = 3", encoding="utf-8")
    rigs = list_rigs(tmp_path)
    assert rigs[0].simulated and rigs[0].path.name == "simulated.toml"
    assert rigs[-1].path.name == "broken.toml" and "name" in rigs[-1].problem
    assert [choice.problem for choice in rigs[:-1]] == [""] * (len(rigs) - 1)

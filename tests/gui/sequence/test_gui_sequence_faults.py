"""Every fault stands at its field: of single values, of a sequence as a whole, of the program, of the rig."""

from dataclasses import replace
from pathlib import Path

import pytest

from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from rigctl.gui.pages.sequence.checking import judge, judge_program, rig_faults
from rigctl.gui.pages.sequence.draft import new_sequence
from rigctl.gui.pages.sequence.forecast import forecast
from rigctl.gui.pages.sequence.forms import ProgramForm, SequenceForm, SpeedRow
from sequences.check import check_program
from sequences.program import Program

ROOT = Path(__file__).resolve().parents[3]
RIG = load_model(ROOT / "configs/rigs/simulated.toml", RigConfig)
CHANNELS = {name: (c.rate_hz, c.is_sound) for name, c in RIG.capabilities.channels.items()}
GOOD = new_sequence("matrix", CHANNELS)


def changed(place: str, **parts: object) -> SequenceForm:
    """The good sequence with parts of one of its forms changed; "" for its own."""
    if not place:
        return replace(GOOD, **parts)
    return replace(GOOD, **{place: replace(getattr(GOOD, place), **parts)})


@pytest.mark.parametrize(
    ("form", "place", "words"),
    [
        (changed("", name=""), "name", "name is missing"),
        (changed("", name="a/b"), "name", "cannot be a name"),
        (changed("", repeat="1.5"), "repeat", "not a whole number"),
        (changed("", repeat="0"), "repeat", "0"),
        (changed("", repeat=""), "repeat", "Nothing is entered"),
        (changed("", dwell="-1"), "dwell_s", "-1"),
        (changed("", temperatures=()), "temperatures_degc", "empty"),
        (changed("", pressures=()), "pressures_bar", "empty"),
        (changed("", speeds=()), "speed_profiles", "empty"),
        (changed("", temperatures=("50", "501")), "temperatures_degc", "maximum temperature"),
        (changed("", processing="lists", pressures=("1", "2", "3")), "processing", "unequal length"),
        (changed("", repeat="99999"), "repeat", "brakings are more than"),
        (changed("function", kind="ramp", amplitude="20"), "pressures_bar", "less the amplitude"),
        (changed("function", kind="ramp", amplitude=""), "pressure_function.amplitude_bar", "Nothing"),
        (changed("function", kind="sine", frequency="0"), "pressure_function.frequency_hz", "0"),
        (changed("function", kind="steps", steps=""), "pressure_function.steps_bar", "No step"),
        (changed("function", kind="steps", steps="1 x"), "pressure_function.steps_bar", "not a number"),
        (changed("function", rise="12"), "pressure_function.rise_s", "rise time"),
        (changed("conditioning", soak="50", timeout="40"), "conditioning.soak_s", "leaves no time"),
        (changed("conditioning", drag_speed="0"), "conditioning.drag_speed_rpm", "does not heat"),
        (changed("conditioning", tolerance="0"), "conditioning.tolerance_k", "0"),
        (changed("limits", cool_down="600"), "limits.cool_down_degc", "cool-down temperature"),
        (changed("limits", maximum="hot"), "limits.max_degc", "“hot” is not a number"),
        (changed("recording", channels=()), "recording.channels", "No channel"),
        (changed("recording", sampling="0"), "recording.sampling_hz", "0"),
        (changed("recording", pre="61"), "recording.pre_s", "61"),
    ],
)
def test_each_fault_has_its_field(form: SequenceForm, place: str, words: str) -> None:
    judged = judge(form)
    assert judged.sequence is None
    assert [fault.place for fault in judged.faults] == [place]
    assert words in judged.faults[0].text
    assert judged.faults[0].uid == form.uid
    assert judged.faults[0].remedy


def test_wrong_cells_are_named_and_equal_words_said_once() -> None:
    judged = judge(replace(GOOD, pressures=("1", "", "5", "", "x", "2000")))
    by_words = {fault.words: fault.cells for fault in judged.faults}
    assert by_words["Nothing is entered here."] == ((1, 0), (3, 0))
    assert by_words["“x” is not a number."] == ((4, 0),)
    assert {fault.place for fault in judged.faults} == {"pressures_bar"}
    assert ((5, 0),) in by_words.values()


def test_cells_of_speed_rows() -> None:
    rows = (
        SpeedRow("5", "40", "40"), SpeedRow("2", "100", "100"), SpeedRow("x", "100", "0", joined=True),
    )  # fmt: skip
    assert judge(replace(GOOD, speeds=rows)).faults[0].cells == ((2, 0),)
    jump = (SpeedRow("5", "40", "40"), SpeedRow("2", "100", "0"), SpeedRow("2", "50", "0", joined=True))
    fault = judge(replace(GOOD, speeds=jump)).faults[0]
    assert "jumps" in fault.words
    assert {row for row, _ in fault.cells} == {1, 2}


def test_too_hot_cells() -> None:
    fault = judge(replace(GOOD, temperatures=("50", "510", "40", "700"))).faults[0]
    assert fault.cells == ((1, 0), (3, 0))


def test_every_wrong_field_is_told_at_once() -> None:
    form = replace(changed("recording", pre=""), repeat="x", dwell="y")
    assert {fault.place for fault in judge(form).faults} == {"recording.pre_s", "repeat", "dwell_s"}


def test_equal_sequences_keep_their_own_faults() -> None:
    first, second = replace(GOOD, repeat="x", uid=1001), replace(GOOD, repeat="x", uid=1002)
    assert judge(first).faults[0].uid == 1001
    assert judge(second).faults[0].uid == 1002
    assert judge(first).faults[0].uid == 1001


def test_faults_of_the_program() -> None:
    twice = ProgramForm(name="p", sequences=(GOOD, replace(GOOD, name="MATRIX", uid=5001)))
    program, faults = judge_program(twice)
    assert program is None
    assert [(fault.uid, fault.place) for fault in faults] == [(5001, "name")]
    assert judge_program(ProgramForm(name="", sequences=(GOOD,)))[1][0].place == "name"
    assert judge_program(ProgramForm(name="p"))[1][0].place == "sequences"


def test_off_without_temperatures_and_blanks_around_names_are_fine() -> None:
    form = replace(changed("conditioning", enabled=False), name=" a b ", temperatures=("x",))
    judged = judge(form)
    assert judged.faults == ()
    assert judged.sequence is not None
    assert judged.sequence.name == "a b"
    assert judged.sequence.temperatures_degc == ()


# -- against the rig ----------------------------------------------------------------------------------


def found(form: SequenceForm) -> list:
    program_form = ProgramForm(name="p", sequences=(replace(GOOD, name="first"), form))
    program, faults = judge_program(program_form)
    assert not faults
    assert program is not None
    return [
        f for f in rig_faults(check_program(program, RIG.capabilities), program_form) if f.uid == form.uid
    ]


@pytest.mark.parametrize(
    ("form", "place", "cells"),
    [
        (changed("", pressures=("5", "41", "50")), "pressures_bar", ((1, 0), (2, 0))),
        (changed("", temperatures=("10", "50")), "temperatures_degc", ((0, 0),)),
        (changed("", speeds=(SpeedRow("5", "40", "40"), SpeedRow("9", "900", "900"))), "speed_profiles",
         ((1, 1), (1, 2))),
        (changed("limits", maximum="600"), "limits.max_degc", ()),
        (changed("conditioning", drag_speed="900"), "conditioning.drag_speed_rpm", ()),
        (changed("function", kind="sine", amplitude="9", frequency="50"), "pressure_function.kind", ()),
        (changed("", ventilator=True), "ventilator", ()),
    ],
)  # fmt: skip
def test_limits_of_the_rig_are_at_their_fields(form: SequenceForm, place: str, cells: tuple) -> None:
    own = replace(form, name="second", uid=7001)
    faults = [fault for fault in found(own) if fault.place == place]
    assert faults
    assert faults[0].severity == "error"
    assert faults[0].cells == cells
    assert "braking" in faults[0].note.lower()
    assert place in {p for p in (place,)} and "degC" not in faults[0].text and "_" not in faults[0].text


def test_unknown_channel_and_impossible_rate() -> None:
    rows = (*GOOD.recording.channels, replace(GOOD.recording.channels[0], name="humidity"))
    form = replace(changed("recording", channels=rows), uid=7002, name="second")
    fault = next(f for f in found(form) if f.place == "recording.channels")
    assert "humidity" in fault.words
    assert fault.cells == ((len(rows) - 1, 0),)


def test_warnings_are_warnings() -> None:
    form = replace(changed("conditioning", timeout="20"), temperatures=("50", "300"), name="second", uid=7003)
    faults = found(form)
    assert {fault.severity for fault in faults} == {"warning"}
    assert faults[0].place == "conditioning.timeout_s"
    assert "time-out" in faults[0].remedy
    assert faults[0].words.startswith("20 s: conditioning is expected")


def test_more_values_than_named_mark_the_list_as_a_whole() -> None:
    form = replace(GOOD, pressures=tuple(str(41 + k) for k in range(9)), name="second", uid=7004)
    fault = next(f for f in found(form) if f.place == "pressures_bar")
    assert fault.cells == ()


def test_a_sequence_renamed_since_the_check_has_no_stale_faults() -> None:
    form = replace(GOOD, pressures=("50",), uid=7005)
    program, _ = judge_program(ProgramForm(name="p", sequences=(form,)))
    assert isinstance(program, Program)
    result = forecast(program, RIG)
    renamed = ProgramForm(name="p", sequences=(replace(form, name="other"),))
    assert rig_faults(result.check, renamed) == ()

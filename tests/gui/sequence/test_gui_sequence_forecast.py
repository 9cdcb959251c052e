"""The course agrees with the estimate, its brakings with the program; readiness says why not."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from sequence_strategies import programs

from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from rigctl.gui.pages.sequence.draft import ProgramDraft, new_sequence
from rigctl.gui.pages.sequence.forecast import FIRST_BRAKINGS, courses, forecast, loop_orders
from rigctl.gui.pages.sequence.forms import ProgramForm
from rigctl.gui.pages.sequence.readiness import start_words, why_not
from rigctl.gui.pages.sequence.words import brakings_text, long_time_text
from rigctl.gui.rig.state import RigState, Word
from sequences.program import Program, load_program

ROOT = Path(__file__).resolve().parents[3]
RIG = load_model(ROOT / "configs/rigs/simulated.toml", RigConfig)
CHANNELS = {name: (c.rate_hz, c.is_sound) for name, c in RIG.capabilities.channels.items()}
PROGRAMS = {path.stem: load_program(path) for path in (ROOT / "configs/programs").glob("*.toml")}


@settings(max_examples=20, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(programs())
def test_course_of_any_program(program: Program) -> None:
    result = forecast(program, RIG)
    assert set(result.courses) == {s.name for s in program.sequences if s.count}
    lasts = [course.t_s[-1] for course in result.courses.values()]
    drawn = {s.name: min(s.count, FIRST_BRAKINGS) for s in program.sequences if s.count}
    for name, course in result.courses.items():
        assert len(course.spans) == drawn[name]
        assert np.all(np.diff(course.t_s) >= -1e-9)
        assert np.all(np.isfinite(course.temperature_degc))
    if drawn == {s.name: s.count for s in program.sequences if s.count}:
        assert sum(lasts) == pytest.approx(result.check.estimate.total_s, rel=1e-9)


def test_spans_are_the_brakings() -> None:
    program = PROGRAMS["squeal_matrix"]
    course = courses(program, RIG)["matrix"]
    assert course.first_index == 31
    assert course.total == 225
    assert len(course.spans) == FIRST_BRAKINGS
    assert np.allclose(course.spans[:, 1] - course.spans[:, 0], 12.0)
    middle = course.spans.mean(axis=1)
    at = np.interp(middle, course.t_s, course.pressure_bar)
    assert np.allclose(at[:15], np.arange(2.0, 31.0, 2.0))
    assert np.allclose(np.interp(middle, course.t_s, course.speed_rpm), 40.0)


def test_swings_of_the_pressure_are_drawn() -> None:
    program = PROGRAMS["dialog_fig5"]
    sequence = program.sequences[0]
    swinging = sequence.model_copy(
        update={"pressure_function": type(program).model_validate(
            {"name": "x", "sequences": [{**sequence.model_dump(), "pressure_function":
             {"kind": "sine", "amplitude_bar": 3.0, "frequency_hz": 1.0}}]}).sequences[0].pressure_function}
    )  # fmt: skip
    course = courses(program.model_copy(update={"sequences": (swinging,)}), RIG)["Matrix"]
    inside = (course.t_s > course.spans[0, 0] + 0.01) & (course.t_s < course.spans[0, 1] - 0.01)
    assert course.pressure_bar[inside].max() == pytest.approx(8.0, abs=0.1)
    assert course.pressure_bar[inside].min() == pytest.approx(2.0, abs=0.1)


def test_loop_orders_of_the_matrix() -> None:
    durations = loop_orders(PROGRAMS["squeal_matrix"], "matrix", RIG)
    assert len(durations) == 6
    assert (
        durations["temperature", "speed", "pressure"].total_s
        < durations["pressure", "speed", "temperature"].total_s
    )


def checked(draft: ProgramDraft):
    assert draft.program is not None
    return forecast(draft.program, RIG)


def test_readiness_in_words() -> None:
    draft, idle = ProgramDraft(), RigState()
    assert "add a sequence" in why_not(draft, [], None, RIG, idle)
    draft.load(ProgramForm(name="p", sequences=(new_sequence("matrix", CHANNELS),)), saved=False)
    result = checked(draft)
    assert why_not(draft, [], result, RIG, idle) == ""
    assert "no rig" in why_not(draft, [], result, None, idle)
    assert "Checking" in why_not(draft, [], None, RIG, idle)
    running = replace(idle, mode="program", word=Word.RUNNING)
    assert "running" in why_not(draft, [], result, RIG, running)
    assert "being started" in why_not(draft, [], result, RIG, replace(idle, word=Word.STARTING))
    manual = replace(idle, mode="manual", word=Word.READY)
    assert "manual session" in why_not(draft, [], result, RIG, manual)
    assert why_not(draft, [], result, RIG, replace(idle, mode="program", word=Word.TRIPPED)) == ""
    sequence = draft.form.sequences[0]
    draft.set_sequence(replace(sequence, repeat="x"), "repeat")
    reason = why_not(draft, list(draft.faults), result, RIG, idle)
    assert "matrix, repeat" in reason
    assert "not a whole number" in reason
    draft.undo()
    assert "Checking" in why_not(draft, [], result, RIG, idle) or draft.program is result.program


def test_the_second_click_says_what_will_be_run() -> None:
    draft = ProgramDraft()
    draft.load(PROGRAMS["squeal_matrix"])
    words = start_words(checked(draft), 10**9, 0, saved=True)
    assert "255 brakings" in words
    assert "2 h" in words.replace("\u202f", " ")
    assert "copy" not in words
    little = start_words(checked(draft), 10**6, 2, saved=False)
    assert "may not fit" in little
    assert "Warnings: 2" in little
    assert "copy" in little
    real = replace(checked(draft), rig=RIG.model_copy(update={"simulated": False}))
    assert "REAL rig" in start_words(real, None, 0, saved=True)


@pytest.mark.parametrize(
    ("seconds", "text"),
    [(0, "0 s"), (42, "42 s"), (89, "89 s"), (90, "2 min"), (3599, "1 h 00 min"), (7440, "2 h 04 min"),
     (4 * 86400 + 3 * 3600, "4 d 3 h")],
)  # fmt: skip
def test_long_times(seconds: float, text: str) -> None:
    assert long_time_text(seconds).replace("\u202f", " ") == text


def test_counts() -> None:
    assert [brakings_text(n) for n in (None, 0, 1, 225)] == ["—", "0 brakings", "1 braking", "225 brakings"]

"""The engine on the real plant, with watchdog and recorder played by the test: verbs, faults, ways out."""

from collections.abc import Callable
from typing import Any

import pytest
from engine_played import PlayedGuard, PlayedRecorder

from rigctl.core.journal import Journal, read_journal
from rigctl.engine.engine import Engine
from rigctl.engine.guard import Checkpoint
from rigctl.engine.procedures import course_of
from rigctl.engine.state import Outcome, Progress, RunResult, State, Verb
from sequences.program import Program

PROGRAM: dict[str, Any] = {
    "name": "three",
    "sequences": [
        {
            "name": "drag",
            "role": "check",
            "temperatures_degc": [40],
            "speed_profiles": [{"duration_s": 1.0, "start_rpm": 40.0, "end_rpm": 40.0}],
            "pressures_bar": [5, 10, 15],
            "conditioning": {"tolerance_k": 15.0, "soak_s": 0.0},
            "recording": {"channels": [{"name": "pressure", "decimation": 40}], "pre_s": 0.1, "post_s": 0.1},
        }
    ],
}


class Stage:
    """An engine with everything around it."""

    def __init__(self, make_rig: Any, tmp_path: Any) -> None:
        self.rig, self.session = make_rig()
        self.guard, self.recorder = PlayedGuard(), PlayedRecorder()
        self.journal_path = tmp_path / "journal.jsonl"
        self.program = Program.model_validate(PROGRAM)
        self.script: Callable[[Progress], Verb | None] = lambda progress: None
        self.pressures: list[float] = []
        self.said: dict[tuple[int, str], bool] = {}

    def once(self, braking: int, phase: str, verb: Verb) -> None:
        """Give a verb when a braking comes into a phase for the first time; "braking": in its midst."""
        before = self.script

        def script(progress: Progress) -> Verb | None:
            key = (braking, phase)
            there = progress.braking == braking and phase in progress.phase
            if phase == "braking":
                there = there and self.recorder.index == braking and self.recorder.blocks == 4
            if there and key not in self.said:
                self.said[key] = True
                return verb
            return before(progress)

        self.script = script

    def run(self) -> RunResult:
        self.engine = Engine(
            self.rig,
            self.guard,  # type: ignore[arg-type]
            self.recorder,
            Journal(self.journal_path, "controller"),
            self.program.brakings(),
            total=self.program.count,
            verbs=lambda: self.script(self.engine.progress),
            report=lambda progress: None,
        )
        return self.engine.run()

    @property
    def ends(self) -> list[tuple[int, str]]:
        return [(entry[1], entry[2]) for entry in self.recorder.log if entry[0] == "end"]

    def assert_at_rest(self) -> None:
        truth = self.session.plant.truth
        assert truth.pressure_bar < 1.0
        assert abs(truth.speed_rpm) < 1.0
        assert self.session.setpoints.vent
        assert self.session.setpoints.pressure_bar == 0.0
        assert self.session.setpoints.speed_rpm == 0.0


@pytest.fixture
def stage(make_rig, tmp_path) -> Stage:
    return Stage(make_rig, tmp_path)


def test_program_runs_to_its_end(stage: Stage):
    result = stage.run()
    assert (result.outcome, result.done, result.incomplete) == (Outcome.FINISHED, 3, [])
    assert stage.ends == [(1, "complete"), (2, "complete"), (3, "complete")]
    assert stage.guard.disarmed
    stage.assert_at_rest()
    # one heartbeat per block, none missed, with all checkpoints; set-points named as commanded
    assert stage.guard.beats == list(range(len(stage.guard.beats)))
    assert set(stage.guard.masks) == {Checkpoint(15)}
    assert max(points["p"] for points in stage.guard.setpoints) == 15.0
    assert ("mark", "pressure_onset") in stage.recorder.log
    assert stage.recorder.seconds == pytest.approx(0.1 + 1.0 + 0.1)


def test_skip_goes_on_with_the_next(stage: Stage):
    stage.once(2, "braking", Verb.SKIP)
    result = stage.run()
    assert (result.outcome, result.done, result.incomplete) == (Outcome.FINISHED, 2, [2])
    assert stage.ends == [(1, "complete"), (2, "incomplete"), (3, "complete")]


def test_repeat_starts_the_braking_again(stage: Stage):
    stage.once(2, "braking", Verb.REPEAT)
    result = stage.run()
    assert (result.outcome, result.done, result.incomplete) == (Outcome.FINISHED, 3, [])
    assert stage.ends == [(1, "complete"), (2, "incomplete"), (2, "complete"), (3, "complete")]


def test_stop_in_a_braking_releases_and_ends(stage: Stage):
    stage.once(2, "braking", Verb.STOP)
    result = stage.run()
    assert (result.outcome, result.done) == (Outcome.STOPPED, 1)
    assert stage.ends == [(1, "complete"), (2, "incomplete")]
    assert stage.guard.disarmed
    stage.assert_at_rest()


def test_stop_while_arming_ends_before_anything_moves(stage: Stage):
    stage.once(0, "arming", Verb.STOP)
    result = stage.run()
    assert (result.outcome, result.done) == (Outcome.STOPPED, 0)
    assert stage.recorder.log == []
    assert max(points["p"] for points in stage.guard.setpoints) == 0.0


@pytest.mark.parametrize(
    ("verb", "ends"),
    [
        (Verb.PAUSE, [(1, "complete"), (2, "incomplete"), (2, "complete"), (3, "complete")]),
        (Verb.HOLD, [(1, "complete"), (2, "complete"), (3, "complete")]),
    ],
)
def test_pause_and_hold_wait_at_rest_until_resume(stage: Stage, verb: Verb, ends: list[tuple[int, str]]):
    paused: list[float] = []

    def script(progress: Progress) -> Verb | None:
        if progress.state is State.PAUSED:
            paused.append(stage.session.plant.truth.speed_rpm)
            return Verb.RESUME if len(paused) == 40 else None
        return None

    stage.script = script
    stage.once(2, "braking", verb)
    result = stage.run()
    assert (result.outcome, result.done) == (Outcome.FINISHED, 3)
    assert stage.ends == ends
    assert len(paused) >= 40
    assert abs(paused[-1]) < 1.0  # two seconds of rig time: the disc stands


def test_skip_while_paused_leaves_the_braking_out(stage: Stage):
    stage.script = lambda progress: Verb.SKIP if progress.state is State.PAUSED else None
    stage.once(2, "braking", Verb.PAUSE)
    result = stage.run()
    assert (result.done, result.incomplete) == (2, [2])


def test_trip_takes_the_rig_to_rest_and_marks_the_braking(stage: Stage):
    real = stage.recorder.begin

    def begin(specification: Any, *, t0_s: float) -> None:
        real(specification, t0_s=t0_s)
        if specification["index"] == 2:
            stage.guard.trip_at = stage.guard.beats[-1] + 4
            stage.session.status["relay"] = True

    stage.recorder.begin = begin  # type: ignore[method-assign]
    result = stage.run()
    assert result.outcome is Outcome.TRIPPED
    assert "41 bar" in result.cause
    assert result.remedy == "Look at the valve."
    assert stage.ends[-1] == (2, "incomplete")
    assert not stage.guard.disarmed
    kinds = [record.kind for record in read_journal(stage.journal_path)]
    assert kinds[-1] == "at_rest_after_trip" or "at_rest_after_trip" in kinds
    stage.assert_at_rest()


def test_recorder_that_cannot_keep_a_braking_ends_the_run_safely(stage: Stage):
    stage.recorder.poll = lambda: (  # type: ignore[method-assign]
        [{"m": "failed", "index": 1, "error": "the disk is full"}] if stage.ends else []
    )
    result = stage.run()
    assert result.outcome is Outcome.FAILED
    assert "disk is full" in result.cause
    assert stage.guard.disarmed
    stage.assert_at_rest()


def test_hot_disc_breaks_the_braking_off_and_cools(stage: Stage):
    data = {**PROGRAM, "sequences": [{**PROGRAM["sequences"][0]}]}
    data["sequences"][0]["limits"] = {"max_degc": 60.0, "cool_down_degc": 50.0}
    data["sequences"][0]["pressures_bar"] = [30, 5]
    data["sequences"][0]["speed_profiles"] = [{"duration_s": 12.0, "start_rpm": 300.0, "end_rpm": 300.0}]
    stage.program = Program.model_validate(data)
    result = stage.run()
    assert 1 in result.incomplete
    broken = next(r for r in read_journal(stage.journal_path) if r.kind == "braking_broken_off")
    assert "above max_degc" in broken.payload["reason"]
    stage.assert_at_rest()


def test_internal_error_is_not_swallowed_and_leaves_the_rig_at_rest(stage: Stage):
    def mark(name: str, t_s: float, **values: Any) -> None:
        raise ZeroDivisionError

    stage.recorder.mark = mark  # type: ignore[method-assign]
    with pytest.raises(ZeroDivisionError):
        stage.run()
    stage.assert_at_rest()


@pytest.mark.parametrize(
    ("function", "duration_s", "expected_blocks"),
    [
        ({"kind": "constant"}, 1.0, 10),
        ({"kind": "constant"}, 0.33, 4),  # 0.1 + 0.1 + 0.1 + 0.03
        ({"kind": "ramp", "amplitude_bar": 5.0}, 1.0, 20),
    ],
)
def test_course_keeps_its_length_and_its_shape(
    function: dict[str, Any], duration_s: float, expected_blocks: int
):
    """Changing set-points keep the resolution of 50 ms; steady ones may take longer blocks."""
    sequence = {**PROGRAM["sequences"][0], "pressure_function": function, "pressures_bar": [10]}
    sequence["speed_profiles"] = [{"duration_s": duration_s, "start_rpm": 40.0, "end_rpm": 40.0}]
    (braking,) = Program.model_validate({**PROGRAM, "sequences": [sequence]}).brakings()
    course = course_of(braking, 0.05, 0.1, 50.0)
    assert len(course) == expected_blocks
    assert sum(point.dt_s for point in course) == pytest.approx(duration_s)
    t_s = 0.0
    for point in course:
        wanted_bar = braking.pressure_setpoint_bar(t_s + 0.5 * point.dt_s)
        assert point.pressure_bar == pytest.approx(wanted_bar, abs=0.3)
        t_s += point.dt_s

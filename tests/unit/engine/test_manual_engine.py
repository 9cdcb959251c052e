"""A manual session on the real plant: commands, refusals, recordings, trips and resets, an absent person."""

from collections.abc import Callable
from typing import Any

import pytest
from engine_played import PlayedGuard, PlayedRecorder

from rigctl.core.journal import Journal, read_journal
from rigctl.engine import manual
from rigctl.engine.commands import Ask, parse_command
from rigctl.engine.manual import ManualEngine
from rigctl.engine.state import Outcome, Progress, RunResult, State, Verb

SHORT = {"do": "record", "duration_s": 1.0, "speed_rpm": 40.0, "pressure_bar": 10.0}


class Bench:
    """A manual engine; a script of (when, what) plays the person."""

    def __init__(self, make_rig: Any, tmp_path: Any) -> None:
        self.rig, self.session = make_rig()
        self.guard, self.recorder = PlayedGuard(), PlayedRecorder()
        self.journal_path = tmp_path / "journal.jsonl"
        self.steps: list[tuple[Callable[[Progress], bool], Any]] = []
        self.answers: list[tuple[str, str, str]] = []
        self.attended = True
        self.seen: list[Progress] = []
        self.blocks = 0
        self.most_blocks = 4000

    def then(self, what: Any, when: Callable[[Progress], bool] = lambda progress: True) -> None:
        """A command (mapping), a verb, or a callable, once `when` holds; in this order."""
        self.steps.append((when, what))

    def _next(self, kind: type) -> Any:
        progress = self.engine.progress
        if self.steps and isinstance(self.steps[0][1], kind) and self.steps[0][0](progress):
            return self.steps.pop(0)[1]
        return None

    def _verb(self) -> Verb | None:
        self.blocks += 1
        assert self.blocks < self.most_blocks, (self.steps[:1], self.engine.progress)
        if (call := self._next(type(lambda: None))) is not None:
            call()
        return self._next(Verb)

    def _asks(self) -> list[Ask]:
        step = self._next(dict)
        if step is None:
            return []
        return [
            Ask(parse_command(step), "tester", lambda why, cure: self.answers.append((step["do"], why, cure)))
        ]

    def run(self) -> RunResult:
        self.engine = ManualEngine(
            self.rig, self.guard, self.recorder, Journal(self.journal_path, "controller"), (),
            total=0, first_index=7, attended=lambda: self.attended,
            verbs=self._verb, asks=self._asks, report=lambda progress: None,
        )  # type: ignore[arg-type]  # fmt: skip
        return self.engine.run()

    def kinds(self) -> list[str]:
        return [record.kind for record in read_journal(self.journal_path)]


@pytest.fixture
def bench(make_rig, tmp_path, monkeypatch) -> Bench:
    monkeypatch.setattr(manual, "IDLE_PACE", 0.0)
    monkeypatch.setattr("rigctl.engine.engine.REPORT_EVERY_S", 0.0)
    return Bench(make_rig, tmp_path)


def ready(progress: Progress) -> bool:
    return progress.phase == "ready"


def idle(progress: Progress) -> bool:
    return progress.phase in ("ready", "by hand")


def test_nothing_moves_before_it_is_enabled(bench: Bench):
    bench.then({"do": "set_speed", "speed_rpm": 50.0})
    bench.then({"do": "set_pressure", "pressure_bar": 5.0})
    bench.then(SHORT)
    bench.then(Verb.END)
    result = bench.run()
    assert result.outcome is Outcome.FINISHED
    assert [why for _, why, _ in bench.answers] == ["the rig is locked."] * 3
    assert max(abs(points["n"]) + points["p"] for points in bench.guard.setpoints) == 0.0


def test_speed_and_pressure_by_hand(bench: Bench):
    truth = bench.session.plant
    bench.then({"do": "enable"})
    bench.then({"do": "set_speed", "speed_rpm": 60.0, "ramp_rpm_per_s": 40.0}, ready)
    bench.then({"do": "set_pressure", "pressure_bar": 8.0}, lambda p: truth.truth.speed_rpm > 59.0)
    bench.then({"do": "set_pressure", "pressure_bar": 0.0}, lambda p: truth.truth.pressure_bar > 7.5)
    bench.then({"do": "set_speed", "speed_rpm": 0.0}, lambda p: truth.truth.pressure_bar < 0.5)
    bench.then({"do": "disable"}, ready)
    bench.then(Verb.END, lambda p: p.phase == "locked")
    assert bench.run().outcome is Outcome.FINISHED
    assert [why for _, why, _ in bench.answers] == [""] * 6
    assert bench.guard.disarmed
    assert not bench.session.setpoints.enable


def test_what_the_rig_cannot_do_is_refused_with_the_reason(bench: Bench):
    bench.then({"do": "enable"})
    bench.then({"do": "set_speed", "speed_rpm": 900.0}, ready)
    bench.then({"do": "set_pressure", "pressure_bar": 55.0})
    sine = {"kind": "sine", "amplitude_bar": 12.0, "frequency_hz": 1.0}
    bench.then({"do": "set_pressure", "pressure_bar": 10.0, "function": sine, "duration_s": 2.0})
    bench.then({"do": "condition", "temperature_degc": 900.0})
    bench.then({**SHORT, "pressure_bar": 60.0})
    bench.then({"do": "reset", "reason": "why not"})
    bench.then(Verb.END)
    bench.run()
    reasons = {do: why for do, why, _ in bench.answers}
    assert "900 1/min is outside 0 … 800" in reasons["set_speed"]
    assert "-2 bar" in reasons["set_pressure"]
    assert "900 °C" in reasons["condition"]
    assert "60" in reasons["record"]
    assert reasons["reset"] == "nothing has tripped."


def test_braking_is_recorded_with_comment_note_and_rating(bench: Bench):
    bench.then({"do": "enable"})
    bench.then({**SHORT, "comment": "first try"}, ready)
    bench.then({"do": "note", "text": "smells"}, lambda p: bench.recorder.blocks > 4)
    bench.then({"do": "rate", "rating": 7})
    bench.then({"do": "set_speed", "speed_rpm": 10.0})
    bench.then(Verb.END, lambda p: p.done == 1 and idle(p))
    result = bench.run()
    assert (result.outcome, result.done, result.incomplete) == (Outcome.FINISHED, 1, [])
    log = bench.recorder.log
    assert ("begin", 7) in log
    assert ("end", 7, "complete", "first try") in log
    assert ("mark", "operator_note", {"text": "smells"}) in log
    assert ("mark", "operator_rating", {"rating": 7}) in log
    assert [why for do, why, _ in bench.answers if do == "set_speed"] == ["a braking is being recorded."]
    assert bench.recorder.seconds == pytest.approx(0.5 + 1.0 + 0.5)


def test_stop_keeps_what_was_recorded_and_locks(bench: Bench):
    bench.then({"do": "enable"})
    bench.then(SHORT, ready)
    bench.then(Verb.STOP, lambda p: bench.recorder.blocks == 5)
    bench.then({"do": "enable"}, lambda p: p.phase == "locked")
    bench.then(Verb.END, ready)
    result = bench.run()
    assert (result.outcome, result.incomplete) == (Outcome.FINISHED, [7])
    assert ("end", 7, "incomplete", "stop by the operator") in bench.recorder.log
    assert [why for do, why, _ in bench.answers if do == "enable"] == ["", ""]


def test_pressure_follows_its_function_and_is_released(bench: Bench):
    ramp = {"kind": "ramp", "amplitude_bar": 5.0}
    bench.then({"do": "enable"})
    bench.then({"do": "set_pressure", "pressure_bar": 10.0, "function": ramp, "duration_s": 2.0}, ready)
    bench.then(Verb.END, lambda p: ready(p) and bench.session.plant.truth.pressure_bar < 0.5)
    bench.run()
    commanded = [points["p"] for points in bench.guard.setpoints]
    course = [value for value in commanded if value > 0.0]
    assert course == sorted(course)
    assert min(course) == pytest.approx(5.0, abs=0.3)
    assert max(course) == pytest.approx(15.0, abs=0.3)


def test_conditioning_by_hand_is_ended_by_any_other_command(bench: Bench):
    bench.then({"do": "enable"})
    bench.then({"do": "condition", "temperature_degc": 60.0}, ready)
    bench.then(
        {"do": "set_pressure", "pressure_bar": 0.0}, lambda p: bench.session.plant.truth.pressure_bar > 3.0
    )
    bench.then(Verb.END, idle)
    assert bench.run().outcome is Outcome.FINISHED
    assert bench.session.setpoints.pressure_bar == 0.0


def test_trip_is_served_until_it_is_reset(bench: Bench):
    bench.then({"do": "enable"})
    bench.then({"do": "set_speed", "speed_rpm": 50.0}, ready)
    bench.then(
        lambda: setattr(bench.guard, "trip_at", 0), lambda p: bench.session.plant.truth.speed_rpm > 30.0
    )
    bench.then({"do": "set_speed", "speed_rpm": 50.0}, lambda p: p.state is State.FAULTED)
    bench.then({"do": "reset", "reason": "valve cleaned"}, lambda p: p.cause == "pressure above 41 bar")
    bench.then({"do": "enable"}, lambda p: p.phase == "locked")
    bench.then(Verb.END, ready)
    result = bench.run()
    assert result.outcome is Outcome.FINISHED
    assert bench.guard.resets == [("tester", "valve cleaned")]
    assert ("set_speed", "the watchdog has tripped.", "Remove the cause, then reset.") in bench.answers
    assert bench.engine.progress.cause == ""
    # no heartbeat was missed from the beginning to the end, whatever happened in between
    assert bench.guard.beats == list(range(len(bench.guard.beats)))


def test_refused_reset_says_why_and_the_trip_stays(bench: Bench):
    bench.guard.refuses_reset = True
    bench.then({"do": "enable"})
    bench.then(lambda: setattr(bench.guard, "trip_at", 0), ready)
    bench.then({"do": "reset", "reason": "try"}, lambda p: p.state is State.FAULTED)
    bench.then(Verb.END, lambda p: any(do == "reset" for do, _, _ in bench.answers))
    result = bench.run()
    assert result.outcome is Outcome.TRIPPED
    assert ("reset", "the pressure is not gone.", "Open the vent valve.") in bench.answers


def test_energy_without_a_hand_is_taken_away(bench: Bench, monkeypatch):
    monkeypatch.setattr(manual, "UNATTENDED_S", 0.0)
    bench.then({"do": "enable"})
    bench.then({"do": "set_speed", "speed_rpm": 50.0}, ready)
    bench.then(
        lambda: setattr(bench, "attended", False), lambda p: bench.session.plant.truth.speed_rpm > 30.0
    )
    bench.then(Verb.END, lambda p: p.phase == "locked")
    assert bench.run().outcome is Outcome.FINISHED
    assert "unattended" in bench.kinds()
    assert bench.guard.disarmed


@pytest.mark.parametrize(
    ("mapping", "words"),
    [
        ({"do": "fly"}, "fly"),
        ({"do": "set_speed"}, "speed_rpm"),
        ({"do": "set_speed", "speed_rpm": float("nan")}, "speed_rpm"),
        ({"do": "set_pressure", "pressure_bar": -1.0}, "pressure_bar"),
        ({"do": "rate", "rating": 11}, "rating"),
        ({"do": "record", "duration_s": 0, "speed_rpm": 1, "pressure_bar": 1}, "duration_s"),
        ({"do": "set_ventilator", "flow_m3_h": 1.0, "extra": 1}, "extra"),
    ],
)
def test_nonsense_is_refused_with_the_field(mapping, words):
    from rigctl.core.errors import ConfigError

    with pytest.raises(ConfigError, match=words):
        parse_command(mapping)

"""Alarms: what the journal and live values make of them, counting, acknowledging, and the alarm bar."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from rigctl.core.journal import Journal, Record, read_journal
from rigctl.gui.rig.alarm_list import ALARM, WARNING, AlarmList
from rigctl.gui.rig.alarms import AlarmModel
from rigctl.gui.rig.connection import RigConnection
from rigctl.gui.rig.near_limits import LimitWatch
from rigctl.gui.rig.state import Readings, RigState
from rigctl.gui.work import Work

CONFIGS = Path(__file__).resolve().parents[3] / "configs"
LIMITS = CONFIGS / "limits" / "a_class.toml"


def record(source: str, kind: str, second: int = 0, **payload: Any) -> Record:
    utc = f"2026-11-30T09:00:{second:02d}.000+00:00"
    return Record(utc, 0, None, source, 1, 0, kind, payload, "", "")


TRIP = record(
    "watchdog", "trip", 1, cause="estop", words="the emergency stop is pressed.", remedy="Release it."
)
BROKEN = record(
    "controller", "braking_broken_off", 2, index=3, reason="disc at 455 °C, above max_degc 450 °C"
)


@pytest.fixture
def config() -> RigConfig:
    return load_model(CONFIGS / "rigs" / "simulated.toml", RigConfig)


def test_records_become_alarms_with_words_and_remedy():
    found = AlarmList()
    assert found.take_records([TRIP, BROKEN, record("controller", "state", state="running")])
    trip, broken = found.alarms
    assert (trip.severity, trip.words, trip.remedy) == (
        ALARM,
        "The emergency stop is pressed.",
        "Release it.",
    )
    assert broken.severity == WARNING
    assert broken.words == "Braking 3 was broken off: disc at 455 °C, above max_degc 450 °C."
    assert found.newest_open() == trip  # an alarm before a newer warning
    assert not found.take_records([record("controller", "verb", verb="hold")])


@pytest.mark.parametrize(
    ("source", "kind", "payload", "severity", "words"),
    [
        (
            "watchdog",
            "refused_arm",
            {"why": "doors", "words": "a door is open"},
            WARNING,
            "Arming was refused",
        ),
        (
            "watchdog",
            "further_cause",
            {"cause": "doors", "words": "a door"},
            WARNING,
            "Further cause: a door.",
        ),
        ("watchdog", "safe_state_not_confirmed", {"words": "no sample"}, ALARM, "not confirmed: no sample"),
        ("controller", "recorder_lost", {"error": "link closed"}, ALARM, "recorder has gone: link closed"),
        ("controller", "failed", {"error": "drive: silent"}, ALARM, "failed: drive: silent"),
        (
            "recorder",
            "RECORDING_FAILED",
            {"index": 4, "error": "disk full"},
            ALARM,
            "Braking 4 was not recorded",
        ),
        ("supervisor", "run_ended", {"outcome": "failed", "cause": "killed"}, ALARM, "has failed: killed"),
    ],
)
def test_what_each_record_says(source: str, kind: str, payload: dict, severity: str, words: str):
    found = AlarmList()
    assert found.take_records([record(source, kind, **payload)])
    assert found.alarms[0].severity == severity
    assert words in found.alarms[0].words


def test_a_person_who_skips_makes_no_alarm():
    found = AlarmList()
    assert not found.take_records(
        [
            record("controller", "braking_broken_off", index=1, reason="skip by the operator"),
            record("controller", "braking_broken_off", index=1, reason="safety trip: the emergency stop"),
            record("supervisor", "run_ended", outcome="finished"),
        ]
    )


def test_the_same_again_is_counted_until_it_is_acknowledged():
    found = AlarmList()
    found.take_records([BROKEN] * 50)
    assert [alarm.count for alarm in found.alarms] == [50]
    assert found.acknowledge("braking_broken_off", "meier", "2026-11-30T09:01:00+00:00")
    assert not found.acknowledge("braking_broken_off", "meier", "2026-11-30T09:01:01+00:00")
    assert found.newest_open() is None
    found.take_records([BROKEN])
    assert [alarm.count for alarm in found.alarms] == [50, 1]


def test_journal_tells_who_has_acknowledged_and_a_reset_does_it_too():
    found = AlarmList()
    found.take_records([TRIP, BROKEN])
    found.take_records(
        [record("controller", "alarm_acknowledged", 5, alarm="braking_broken_off", who="meier")]
    )
    found.take_records([record("watchdog", "reset", 6, who="huber", reason="pressed by mistake")])
    assert [alarm.acknowledged_by for alarm in found.alarms] == ["huber: pressed by mistake", "meier"]


def test_warning_levels_lie_above_every_allowed_set_point(config: RigConfig):
    watch = LimitWatch.of_file(LIMITS, config.capabilities)
    levels = watch.warn_levels()
    assert levels["pressure"] == pytest.approx(40.5)
    assert levels["speed"] == pytest.approx(820)
    assert levels["temperature"] == pytest.approx(475)  # the rig allows the limit itself: 95 %
    calm = Readings(speed_rpm=800, pressure_bar=40, torque_nm=900, temperature_degc=450)
    assert watch.near(replace(calm, torque_nm=100)) == []
    assert watch.near(Readings()) == []


def test_near_a_limit_with_hysteresis_is_one_alarm(config: RigConfig):
    found = AlarmList()
    found.watch = LimitWatch.of_file(LIMITS, config.capabilities)

    def see(degc: float) -> bool:
        return found.take_state(RigState(readings=Readings(temperature_degc=degc, pressure_bar=1.0)))

    assert not see(470)
    assert see(476)
    alarm = found.alarms[0]
    assert alarm.words == "Disc temperature 476 °C is near its limit 500 °C."
    assert alarm.active
    see(472), see(477), see(466)
    assert (len(found.alarms), found.alarms[0].count) == (1, 1)
    see(464)  # 475 − 10
    assert not found.alarms[0].active
    assert found.alarms[0].open
    see(480)
    assert (len(found.alarms), found.alarms[0].count) == (1, 2)
    found.acknowledge("near:temperature", "meier", "now")
    see(481)  # lasts: no second alarm for what has been seen
    assert len(found.alarms) == 1
    see(400), see(480)
    assert len(found.alarms) == 2


def test_low_disk_is_a_warning():
    found = AlarmList()
    assert found.take_state(RigState(disk_left_bytes=0.5e9))
    assert "0.50 GB" in found.alarms[0].words
    assert not found.take_state(RigState(disk_left_bytes=0.5e9))


class Session(SimpleNamespace):
    """What the model needs of a session."""


@pytest.fixture
def session(tmp_path: Path, config: RigConfig) -> Session:
    changed = config.model_copy(update={"safety": config.safety.model_copy(update={"limits": LIMITS})})
    Journal(tmp_path / "journal.jsonl", "test").close()
    return Session(campaign=tmp_path, rig=changed, file=SimpleNamespace(calibrations=()))


def test_model_tells_the_newest_and_journals_without_a_controller(services, session, qtbot):
    rig: RigConnection = services.rig
    work: Work = services.work
    model = AlarmModel(rig, work)
    rig.attached.emit(session)
    with qtbot.waitSignal(model.newestChanged) as told:
        rig.recordsAdded.emit([TRIP])
    assert told.args[0].words == "The emergency stop is pressed."
    rig.detached.emit("it has ended")
    model.acknowledge_newest()
    assert model.newest is None
    path = session.campaign / "journal.jsonl"
    qtbot.waitUntil(lambda: any(r.kind == "alarm_acknowledged" for r in read_journal(path)))
    written = next(r for r in read_journal(path) if r.kind == "alarm_acknowledged")
    assert (written.source, written.payload["alarm"]) == ("operator", "trip:estop")


def test_model_asks_the_controller_while_one_runs(services, session, monkeypatch):
    asked: list[str] = []
    monkeypatch.setattr(services.rig, "acknowledge_alarm", asked.append)
    model = AlarmModel(services.rig, services.work)
    services.rig.attached.emit(session)
    services.rig.recordsAdded.emit([BROKEN, TRIP])
    assert model.open_count == 2
    model.acknowledge_all()
    assert asked == ["braking_broken_off", "trip:estop"]
    assert model.open_count == 0


def test_model_starts_in_the_middle_and_forgets_another_campaign(services, session, tmp_path):
    services.rig.session, services.rig.records = session, [TRIP]
    model = AlarmModel(services.rig, services.work)
    assert [alarm.key for alarm in model.alarms] == ["trip:estop"]
    services.rig.attached.emit(Session(**{**vars(session), "campaign": tmp_path / "other"}))
    assert model.alarms == []


def test_overdue_calibration_is_said(services, session):
    from datetime import UTC, datetime

    due = SimpleNamespace(due=datetime(2020, 1, 1, tzinfo=UTC).date(), quantity="torque")
    session.file.calibrations = (due,)
    model = AlarmModel(services.rig, services.work)
    services.rig.attached.emit(session)
    assert model.newest is not None and "overdue since 2020-01-01" in model.newest.words


def test_alarm_bar_of_the_window(theme, qtbot, tmp_path, session):
    from PySide6.QtCore import QSettings, Qt

    from rigctl.gui.window import MainWindow

    settings = QSettings(str(tmp_path / "w.ini"), QSettings.Format.IniFormat)
    rig = RigConnection()
    window = MainWindow(theme, settings, rig, tmp_path, CONFIGS)
    qtbot.addWidget(window)
    window.show()
    bar = window.alarm_bar
    rig.attached.emit(session)
    rig.recordsAdded.emit([BROKEN, BROKEN, TRIP])
    assert "The emergency stop is pressed. Release it." in bar.line.text()
    qtbot.mouseClick(bar.acknowledge, Qt.MouseButton.LeftButton)
    assert "Braking 3 was broken off" in bar.line.text()
    assert "(2 times)" in bar.line.text()
    qtbot.mouseClick(bar.acknowledge, Qt.MouseButton.LeftButton)
    assert bar.line.text() == ""
    assert not bar.acknowledge.isVisible()
    window.close()

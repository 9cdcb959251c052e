"""The Service page: tabs, devices, journal, fault laboratory, settings of the window."""

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QApplication
from service_mini_rig import MiniRig, session_of

from rigctl.core.journal import Journal, Record
from rigctl.gui.pages.service.devices_list import rows_of_session, rows_of_test, values_of_state
from rigctl.gui.pages.service.journal_list import Filter, JournalFile, campaigns_of, row_of
from rigctl.gui.pages.service.page import ServicePage
from rigctl.gui.rig.alarms import AlarmModel
from rigctl.gui.rig.state import Readings, RigState


@pytest.fixture
def session(tmp_path: Path) -> SimpleNamespace:
    return session_of(tmp_path)


@pytest.fixture
def page(services, qtbot) -> Iterator[ServicePage]:
    services.alarms = AlarmModel(services.rig, services.work)
    made = ServicePage(services)
    qtbot.addWidget(made)
    made.resize(1200, 700)
    made.show()
    qtbot.waitExposed(made)
    made.activated()
    yield made
    made.closing()


def attach(services, session) -> None:
    services.rig.session = session
    services.rig.attached.emit(session)


def show_tab(page: ServicePage, name: str) -> None:
    """Show a tab and let it be laid out."""
    page.show_tab(name)
    QApplication.processEvents()


def record(source: str, kind: str, rig_s: float | None = None, **payload) -> Record:
    return Record("2026-11-30T09:00:00.000+00:00", 0, rig_s, source, 7, 0, kind, payload, "", "ab")


# -- page --------------------------------------------------------------------------------------------


def test_laboratory_is_there_on_simulated_rigs_only(page, services, session, tmp_path):
    index = page.tab_index("laboratory")
    assert not page.tabs.isTabVisible(index)
    attach(services, session)
    assert page.tabs.isTabVisible(index)
    services.rig.detached.emit("it has ended")  # the connection still remembers it
    assert not page.tabs.isTabVisible(index)
    (tmp_path / "real").mkdir()
    attach(services, session_of(tmp_path / "real", simulated=False))
    assert not page.tabs.isTabVisible(index)


def test_other_pages_open_a_tab(page, services, tmp_path):
    folder = tmp_path / "data" / "old"
    folder.mkdir(parents=True)
    journal = Journal(folder / "journal.jsonl", "controller")
    journal.write("state", state="running")
    journal.close()
    page.open(tab="alarms")
    assert page.tab() == "alarms"
    page.open(campaign=folder)
    assert page.tab() == "journal"
    page.open(tab="nonsense")
    assert page.tab() == "journal"


def test_only_the_shown_tab_works(page, qtbot):
    show_tab(page, "journal")
    assert page.journal._tail.isActive()
    assert not page.devices._refresh.isActive()
    show_tab(page, "devices")
    assert page.devices._refresh.isActive()
    page.deactivated()
    assert not page.devices._refresh.isActive() and not page.journal._tail.isActive()


def test_tab_counts_the_alarms_nobody_has_seen(page, services, session, qtbot):
    attach(services, session)
    trip = record("watchdog", "trip", cause="estop", words="the emergency stop is pressed.")
    broken = record("controller", "braking_broken_off", index=2, reason="disc too hot")
    services.rig.recordsAdded.emit([trip, broken])
    assert "(2)" in page.tabs.tabText(2)
    show_tab(page, "alarms")
    page.alarms.table.selectRow(0)
    qtbot.mouseClick(page.alarms.acknowledge, Qt.MouseButton.LeftButton)
    assert "(1)" in page.tabs.tabText(2)
    page.alarms.only_open.setChecked(True)
    assert page.alarms.model.rowCount() == 1
    qtbot.mouseClick(page.alarms.all, Qt.MouseButton.LeftButton)
    assert page.alarms.model.rowCount() == 0
    assert page.alarms.empty.isVisible()


# -- devices -----------------------------------------------------------------------------------------

TESTED = {
    "devices": [
        {
            "role": "drive", "kind": "modbus", "class": "", "result": "warning", "identity": {"maker": "ABB"},
            "values": [
                {"name": "speed", "value": 1.5, "unit": "1/min", "age_s": 0.02, "fault": ""},
                {"name": "ready", "value": True, "unit": "", "age_s": None, "fault": ""},
                {"name": "torque", "value": None, "unit": "N·m", "age_s": None, "fault": "wire broken"},
            ],
            "round_trip_s": None,
            "findings": [
                {"problem": "slow answers", "remedy": "", "unsafe": False},
                {"problem": "30.02 is 0: goes on without us", "remedy": "Set it to 1.", "unsafe": True},
            ],
        }
    ]
}  # fmt: skip


def test_devices_of_a_test_in_words():
    row = rows_of_test(json.dumps(TESTED))[0]
    assert row.identity_text == "maker ABB"
    assert row.values == (
        ("speed", "1.5 1/min, 20 ms old"), ("ready", "True"), ("torque", "not valid, wire broken"),
    )  # fmt: skip
    assert [finding.unsafe for finding in row.findings] == [True, False]
    with pytest.raises(ValueError):
        rows_of_test("rigctl: no such file")
    with pytest.raises(ValueError, match="something else"):
        rows_of_test('{"devices": [{}]}')


def test_devices_of_a_session_with_values(page, services, session):
    opened = record("controller", "rig_opened", devices={"drive": {"maker": "rigctl", "model": "simulated"}})
    rows = {row.role: row for row in rows_of_session(session.rig, [opened])}
    assert rows["drive"].identity_text == "maker rigctl, model simulated"
    assert rows["safety"].kind == "simulated" and rows["safety"].identity == ()
    services.rig.records = [opened]
    attach(services, session)
    state = RigState(enabled=True, readings=Readings(speed_rpm=41.26, pressure_bar=10.004))
    services.rig.stateChanged.emit(state)
    page.devices._show_values()
    names, values = zip(*page.devices.cards["drive"]._names, strict=True)
    assert [label.text() for label in names] == ["speed", "set-point", "torque enable"]
    assert values[0].text().startswith("41.3 1/min")
    assert values[2].text() == "on"
    assert not page.devices.test.isEnabled()  # its ports are in use
    assert values_of_state(state, 0.25)["pressure"][0][1] == "10.00 bar, 0.2 s old"


def test_test_devices_runs_beside_the_window(page, services, qtbot, monkeypatch):
    devices = page.devices
    qtbot.waitUntil(lambda: devices.rig.count() > 0)
    program = f"import json; print('''{json.dumps(TESTED)}''')"
    monkeypatch.setattr(
        "rigctl.gui.pages.service.devices_tab.test_command", lambda rig: [sys.executable, "-c", program]
    )
    qtbot.mouseClick(devices.test, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(devices.cards["drive"].isVisible, timeout=15000)
    assert "unsafe" in devices.line.text()
    assert "30.02 is 0" in devices.cards["drive"].findings.text()
    assert not devices.cards["safety"].isVisible()


def test_a_test_can_be_cancelled_and_its_failure_is_said(page, qtbot, monkeypatch):
    devices = page.devices
    qtbot.waitUntil(lambda: devices.rig.count() > 0)
    programs = iter(["import time; time.sleep(60)", "import sys; sys.exit('rigctl: no such port')"])
    monkeypatch.setattr(
        "rigctl.gui.pages.service.devices_tab.test_command",
        lambda rig: [sys.executable, "-c", next(programs)],
    )
    devices.test.click()
    assert "Cancel" in devices.test.text()
    devices.test.click()
    qtbot.waitUntil(lambda: "cancelled" in devices.line.text(), timeout=15000)
    devices.test.click()
    qtbot.waitUntil(lambda: "no such port" in devices.line.text(), timeout=15000)
    assert devices.line.property("look") == "error"


# -- journal -----------------------------------------------------------------------------------------


def test_journal_is_read_on_without_torn_lines(tmp_path):
    path = tmp_path / "journal.jsonl"
    journal = Journal(path, "controller")
    journal.write("state", rig_s=1.0, state="running", why="arming")
    file = JournalFile(path)
    assert [row.words for row in file.read_on()] == ["state running, why arming"]
    assert file.read_on() == []
    with path.open("ab") as raw:
        raw.write(b'{"utc": "torn')
    assert file.read_on() == []
    Journal(path, "recorder").write("trip", words="Too hot.", remedy="Wait.")
    rows = file.read_on()
    assert [row.words for row in rows] == ["Too hot. Wait."]
    journal.close()


def test_filter_wants_all_words_process_and_kind():
    rows = [
        row_of(record("watchdog", "trip", words="disc temperature is out of its range")),
        row_of(record("controller", "state", state="running")),
        row_of(record("controller", "trip_note", words="temperature")),
    ]
    assert len(Filter("temperature").pick(rows)) == 2
    assert len(Filter("Temperature DISC").pick(rows)) == 1
    assert len(Filter(source="controller").pick(rows)) == 2
    assert Filter("temperature", "controller", "state").pick(rows) == []
    assert Filter().pick(rows) == rows


def test_campaigns_are_found_newest_first(tmp_path):
    import os

    for age, name in ((10, "b"), (5, "a"), (20, "c")):
        (tmp_path / name).mkdir()
        path = tmp_path / name / "journal.jsonl"
        path.touch()
        os.utime(path, (1e9 - age, 1e9 - age))
    (tmp_path / "calibrations").mkdir()
    assert [folder.name for folder in campaigns_of(tmp_path)] == ["a", "b", "c"]
    assert campaigns_of(tmp_path / "none") == []


def test_journal_tab_searches_and_follows(page, services, session, qtbot):
    services.data_folder = session.campaign.parent
    journal = Journal(session.campaign / "journal.jsonl", "controller")
    journal.write("state", rig_s=12.5, state="running")
    journal.write("verb", rig_s=13.0, verb="hold")
    attach(services, session)
    show_tab(page, "journal")
    tab = page.journal
    qtbot.waitUntil(lambda: tab.model.rowCount() == 2)
    assert "(running)" in tab.campaign.currentText()
    assert tab.model.index(0, 1).data() == "12.50"
    Journal(session.campaign / "journal.jsonl", "watchdog").write("trip", words="the door is open.")
    qtbot.waitUntil(lambda: tab.model.rowCount() == 3)
    qtbot.keyClicks(tab.search, "door")
    qtbot.waitUntil(lambda: tab.model.rowCount() == 1)
    tab.search.clear()
    qtbot.waitUntil(lambda: tab.model.rowCount() == 3)
    tab.source.setCurrentIndex(tab.source.findData("controller"))
    assert tab.model.rowCount() == 2
    tab.table.selectRow(1)
    assert '"verb": "hold"' in tab.details.toPlainText()
    qtbot.mouseClick(tab.verify, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: "No gaps" in tab.status.text())
    journal.close()


def test_a_changed_journal_is_found(page, services, session, qtbot):
    services.data_folder = session.campaign.parent
    path = session.campaign / "journal.jsonl"
    journal = Journal(path, "controller")
    journal.write("state", state="running")
    journal.close()
    path.write_text(path.read_text().replace("running", "nothing"))
    page.open(campaign=session.campaign)
    qtbot.waitUntil(lambda: page.journal.model.rowCount() == 1)
    page.journal.verify.click()
    qtbot.waitUntil(lambda: "changed after it was written" in page.journal.status.text())


def test_journal_of_ten_thousand_records_is_filtered_at_once(page, qtbot):
    import time

    model = page.journal.model
    rows = [
        row_of(record("controller", f"kind{i % 7}", float(i), index=i, note="braking")) for i in range(10_000)
    ]
    started = time.perf_counter()
    model.append(rows)
    model.set_filter(Filter("braking index 77"))
    spent_s = time.perf_counter() - started
    assert model.rowCount() > 100
    assert spent_s < 1.0  # some tens of ms on a free machine


def test_no_campaign_teaches(page, qtbot):
    show_tab(page, "journal")
    qtbot.waitUntil(lambda: "writes a journal" in page.journal.status.text())


# -- fault laboratory --------------------------------------------------------------------------------


@pytest.fixture
def mini(session) -> Iterator[MiniRig]:
    rig = MiniRig(session.run_dir)
    yield rig
    rig.close()


def test_laboratory_does_what_it_says(page, services, session, mini, qtbot):
    attach(services, session)
    show_tab(page, "laboratory")
    tab = page.laboratory
    qtbot.waitUntil(tab.estop.isEnabled)
    assert tab.force.text() == "Nothing is disturbed."
    qtbot.mouseClick(tab.estop, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: "emergency stop is pressed" in tab.force.text())
    assert not mini.stimuli.estop_ok
    assert "release" in tab.estop.text().replace("&", "")
    row = tab.sensors["torque"]
    row.mode.setCurrentIndex(row.mode.findData("offset"))
    row.value.setValue(12.5)
    qtbot.mouseClick(row.apply, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: "Sensor torque: offset by 12.5" in tab.force.text())
    tab.disc.edit.setText("150")
    qtbot.keyClick(tab.disc.edit, Qt.Key.Key_Return)
    qtbot.waitUntil(lambda: mini.plant.truth.surface_degc > 140)
    qtbot.mouseClick(tab.clear, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: tab.force.text() == "Nothing is disturbed.")
    assert row.mode.currentData() == "ok"
    assert not tab.estop.isChecked()


def test_what_others_do_is_shown_and_a_refusal_too(page, services, session, mini, qtbot):
    attach(services, session)
    show_tab(page, "laboratory")
    tab = page.laboratory
    qtbot.waitUntil(tab.estop.isEnabled)
    mini.stimuli.handle({"do": "calibrator", "level_db": 114})
    mini.stimuli.handle({"do": "sensor", "channel": "speed", "mode": "frozen", "seen_by": "watchdog"})
    qtbot.waitUntil(lambda: tab.calibrator.currentData() == 114, timeout=8000)
    assert tab.sensors["speed"].mode.currentData() == "frozen"
    assert tab.sensors["speed"].seen_by.currentData() == "watchdog"
    tab.ask("calibrator", level_db=100)
    qtbot.waitUntil(lambda: "94, 114" in tab.news.text())


# -- window ------------------------------------------------------------------------------------------


def test_window_settings_are_remembered_and_take_effect(page, services, theme, qtbot, tmp_path):
    show_tab(page, "window")
    tab = page.window_settings
    try:
        qtbot.mouseClick(tab.looks["dark"], Qt.MouseButton.LeftButton)
        assert theme.current.name == "dark"
        tab.text_size.setValue(13)
        assert theme.scale == pytest.approx(1.3)
        assert tab.size_text.text().startswith("130")
        assert services.settings.value("theme") == "dark"
        assert float(services.settings.value("text-scale")) == pytest.approx(1.3)
    finally:
        theme.set(name="light", scale=1.0)
    assert tab.looks["light"].isChecked()
    assert tab.text_size.value() == 10
    tab.language.setCurrentIndex(1)
    tab.language.activated.emit(1)
    assert services.settings.value("language") == "de"
    assert "started again" in tab.later.text()


def test_data_folder_must_be_one(page, services, tmp_path, qtbot):
    tab = page.window_settings
    show_tab(page, "window")
    file = tmp_path / "file"
    file.touch()
    for text, words in (
        ("data", "whole path"),
        (str(file), "a file"),
        (str(tmp_path / "x" / "y"), "Make it"),
    ):
        tab.set_folder(Path(text))
        assert words in tab.folder_error.text()
        assert tab.folder.property("wrong") == "true"
        assert services.settings.value("data-folder") is None
    tab.set_folder(tmp_path / "new")
    assert not tab.folder_error.isVisible()
    assert services.settings.value("data-folder") == str(tmp_path / "new")


def test_layout_is_remembered(page, services, qtbot):
    show_tab(page, "alarms")
    page.save_layout(services.settings)
    again = ServicePage(services)
    qtbot.addWidget(again)
    again.restore_layout(services.settings)
    assert again.tab() == "alarms"
    assert "laboratory" in again.help_text()

"""Calibrations on the screen: procedures from the first step to the file, on a small simulated rig."""

from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PySide6.QtCore import QSettings, Qt
from service_mini_rig import MiniRig, braking, session_of

from rigctl.calibration.record import Calibration, Point, Quantity
from rigctl.calibration.store import history, rig_folder, save
from rigctl.calibration.torque import Lever
from rigctl.gui.pages.service import heat_view, sampler, sound_view, torque_view
from rigctl.gui.pages.service.calibrations_tab import CalibrationsTab, figure_text
from rigctl.gui.pages.service.form import Facts, FactsForm
from rigctl.gui.pages.service.lever_form import LeverForm
from rigctl.gui.pages.service.live_session import LiveSession
from rigctl.gui.pages.service.torque_guide import TorqueGuide, masses_in


@pytest.fixture(autouse=True)
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Measurements of a fifth of a second."""
    monkeypatch.setattr(torque_view, "SETTLE_MS", 30)
    monkeypatch.setattr(sound_view, "SETTLE_MS", 120)
    monkeypatch.setattr(sound_view, "RECORD_S", 0.6)
    monkeypatch.setattr(heat_view, "MEASURE_S", 0.1)
    monkeypatch.setattr(sampler.LiveSampler.measure, "__defaults__", (0.05,))
    monkeypatch.setattr(sampler, "_LOOK_MS", 20)


@pytest.fixture
def session(tmp_path: Path) -> SimpleNamespace:
    return session_of(tmp_path)


@pytest.fixture
def mini(session: SimpleNamespace) -> Iterator[MiniRig]:
    rig = MiniRig(session.run_dir)
    yield rig
    rig.close()


@pytest.fixture
def tab(services, session, qtbot) -> Iterator[CalibrationsTab]:
    services.rig.session = session
    made = CalibrationsTab(services, LiveSession(services.rig))
    qtbot.addWidget(made)
    made.resize(1100, 640)
    made.show()
    made.activated()
    qtbot.waitUntil(lambda: made.empty.isVisible() or made.table.isVisible())
    yield made
    made.stop()


def files(session: SimpleNamespace) -> list[Calibration]:
    kept, faults = history(rig_folder(session.campaign.parent, session.rig.name))
    assert faults == []
    return [entry.calibration for entry in kept]


def test_torque_from_the_first_load_to_the_file(tab, mini, session, qtbot):
    qtbot.mouseClick(tab.cards[Quantity.TORQUE].start, Qt.MouseButton.LeftButton)
    view = tab.procedure
    view.lever.setValue(Lever(length_m=1.0, masses_kg=(30.0, 60.0)))
    view.facts.setValue(Facts("Meier", "HBM U2B 1234", "weights M1", 180))
    assert view.trip_note.isVisible()  # −588 N·m lies outside the watchdog's range
    qtbot.mouseClick(view.begin, Qt.MouseButton.LeftButton)
    assert "no weights" in view.order.text()
    for count in range(1, 11):
        qtbot.waitUntil(view.take.isEnabled)
        assert not view.save.isEnabled()
        qtbot.mouseClick(view.take, Qt.MouseButton.LeftButton)
        qtbot.waitUntil(lambda count=count: len(view.guide.taken) == count, timeout=8000)
    assert view.guide.complete
    # the plant's chain reads 0.998 · M + 0.4 N·m
    assert "gain 1.00" in view.result.text()
    assert not view.faults.isVisible()
    qtbot.mouseClick(view.save, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: tab.procedure is None)
    kept = files(session)[0]
    # means over few samples of the noise of 0.8 N·m
    assert kept.gain == pytest.approx(1.0 / 0.998, abs=8e-4)
    assert kept.offset == pytest.approx(-0.4, abs=0.35)
    assert (kept.operator, kept.valid_days, len(kept.points)) == ("Meier", 180, 10)
    assert "lever 1 m" in kept.reference
    qtbot.waitUntil(lambda: "valid until" in tab.cards[Quantity.TORQUE].state.text())
    assert mini.plant._lever_nm == 0.0  # the weights are off again


def test_a_turning_shaft_gives_no_reading(tab, mini, qtbot):
    braking(mini)
    qtbot.waitUntil(lambda: mini.plant.truth.speed_rpm > 5)
    tab.begin(Quantity.TORQUE)
    view = tab.procedure
    view.begin.click()
    view.aid.setChecked(False)
    view.take.click()
    qtbot.waitUntil(lambda: "bring the rig to rest" in view.message.text(), timeout=8000)
    assert view.guide.taken == []
    assert view.take.isEnabled()


def test_a_bad_reading_forbids_saving_and_can_be_repeated(tab, mini, qtbot):
    tab.begin(Quantity.TORQUE)
    view = tab.procedure
    view.lever.setValue(Lever(length_m=1.0, masses_kg=(30.0, 60.0)))
    view.begin.click()
    for step in view.guide.steps:
        view.guide.take(step.applied_nm * 0.998 + (25.0 if view.guide.at == 2 else 0.0), 0.1)
    view._show()
    assert not view.save.isEnabled()
    assert "largest residual" in view.faults.text()
    view.table.selectRow(2)
    qtbot.mouseClick(view.repeat, Qt.MouseButton.LeftButton)
    assert "60 kg" in view.order.text()
    qtbot.mouseClick(view.take, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: view.guide.complete, timeout=8000)
    assert view.save.isEnabled()


def test_leaving_asks_when_readings_would_be_lost(tab, mini, qtbot):
    tab.begin(Quantity.TORQUE)
    view = tab.procedure
    view.begin.click()
    assert tab.unsaved() == []
    view.guide.take(0.4, 0.1)
    assert tab.unsaved()
    qtbot.mouseClick(view.back, Qt.MouseButton.LeftButton)
    assert tab.procedure is view
    qtbot.mouseClick(tab.notice.buttons[1], Qt.MouseButton.LeftButton)  # go on
    assert tab.procedure is view
    qtbot.mouseClick(view.back, Qt.MouseButton.LeftButton)
    qtbot.mouseClick(tab.notice.buttons[0], Qt.MouseButton.LeftButton)
    assert tab.procedure is None


def test_microphone_with_drift_since_the_last(services, tab, mini, session, qtbot):
    mini.stimuli.handle({"do": "microphone", "drift_db": 0.3})
    folder = rig_folder(session.campaign.parent, session.rig.name)
    save(
        folder,
        Calibration(
            quantity=Quantity.MICROPHONE, channel="microphone", unit="Pa", rig="r", operator="x", gain=1.0,
            date=datetime.now(UTC) - timedelta(days=400), nominal_scale=20 / 32768,
            points=(Point(applied=94, measured=1),),
        ),
    )  # fmt: skip
    tab.refresh()
    qtbot.waitUntil(lambda: "overdue" in tab.cards[Quantity.MICROPHONE].state.text())
    assert tab.cards[Quantity.MICROPHONE].state.property("look") == "alarm"
    tab.begin(Quantity.MICROPHONE)
    view = tab.procedure
    assert not view.save.isEnabled()
    qtbot.mouseClick(view.take, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: view.guide is not None and view.guide.result is not None, timeout=25000)
    assert "drift since the last calibration +0.30 dB" in view.result.text()
    assert view.table.item(0, 0).text().startswith("94")
    qtbot.waitUntil(view.save.isEnabled)
    qtbot.mouseClick(view.save, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: tab.procedure is None)
    assert files(session)[0].gain == pytest.approx(10 ** (-0.3 / 20), rel=1e-3)
    qtbot.waitUntil(lambda: tab.table.rowCount() == 2)


def test_emissivity_of_the_simulated_rig(tab, mini, session, qtbot):
    tab.begin(Quantity.EMISSIVITY)
    view = tab.procedure
    view.aid.setChecked(False)
    view.take.click()
    assert "Give a number" in view.contact.error.text()
    assert view.contact.error.isVisible()
    assert not view.sampler.busy
    for count, degc in enumerate((120.0, 300.0), start=1):
        mini.plant.set_condition(disc_degc=degc)
        view.aid.setChecked(True)
        qtbot.mouseClick(view.take, Qt.MouseButton.LeftButton)
        qtbot.waitUntil(lambda count=count: len(view.guide.points) == count, timeout=8000)
    # the rub track has 0.84, the pyrometer is set to 0.85
    assert view.guide.result()[0].emissivity == pytest.approx(0.84, abs=0.015)
    view.at_device.setChecked(True)
    qtbot.mouseClick(view.save, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: tab.procedure is None)
    kept = files(session)[0]
    assert (kept.gain, kept.offset) == (1.0, 0.0)
    assert kept.emissivity == pytest.approx(0.84, abs=0.015)
    assert "at the pyrometer" in kept.note


def test_readings_are_those_of_the_uncalibrated_chain(services, tmp_path, qtbot):
    """A session that runs with a calibration must not have it counted twice."""
    known = Calibration(
        quantity=Quantity.TORQUE, channel="torque", unit="N·m", rig="r", operator="x", gain=1.1, offset=-5.0,
        date=datetime.now(UTC), points=(Point(applied=0, measured=0),),
    )  # fmt: skip
    session = session_of(tmp_path, (known,))
    mini = MiniRig(session.run_dir, (known.correction,))
    taken = sampler.LiveSampler(session.run_dir, [known.correction])
    found: list[dict] = []
    taken.measure(("torque",), found.append, pytest.fail)
    qtbot.waitUntil(lambda: bool(found), timeout=8000)
    assert found[0]["torque"].mean == pytest.approx(0.4, abs=0.9)
    assert taken.spec("torque").scale == pytest.approx(1.0)
    taken.close()
    mini.close()


def test_no_samples_is_said(services, tmp_path, qtbot, monkeypatch):
    monkeypatch.setattr(sampler, "PATIENCE_S", 0.1)
    session = session_of(tmp_path)
    taken = sampler.LiveSampler(session.run_dir, [])
    said: list[str] = []
    taken.measure(("torque",), pytest.fail, said.append)
    assert "no samples yet" in said[0]
    mini = MiniRig(session.run_dir)
    taken.measure(("odour",), pytest.fail, said.append)
    assert "odour" in said[1]
    mini.close()
    taken.measure(("torque",), pytest.fail, said.append)
    qtbot.waitUntil(lambda: len(said) == 3, timeout=8000)
    assert "not paused" in said[2]
    taken.close()


def test_without_a_session_the_tab_teaches(services, qtbot):
    tab = CalibrationsTab(services, LiveSession(services.rig))
    qtbot.addWidget(tab)
    tab.show()
    tab.activated()
    assert "Manual page" in tab.place.text()
    assert not any(card.start.isEnabled() for card in tab.cards.values())


# -- inputs ------------------------------------------------------------------------------------------


def test_lever_form_round_trip_and_errors(theme, qtbot, tmp_path):
    settings = QSettings(str(tmp_path / "s.ini"), QSettings.Format.IniFormat)
    form = LeverForm(theme, settings)
    qtbot.addWidget(form)
    lever = Lever(length_m=0.75, masses_kg=(2.5, 5.0, 7.5), own_nm=3.25, gravity=9.81)
    form.setValue(lever)
    assert form.value() == lever
    form.remember()
    assert LeverForm(theme, settings).value().masses_kg == lever.masses_kg
    form.masses.setText("5 x 10")
    assert form.value() is None
    assert "“x” is not a mass" in form.problem()
    assert form.masses.property("wrong") == "true"
    form.masses.setText("10 5")
    assert "light to heavy" in form.problem()
    form.masses.setText("5")
    assert "two masses" in form.problem()
    form.masses.setText("2,5; 5")
    assert form.value().masses_kg == (2.5, 5.0)
    assert form.masses.property("wrong") == "false"
    form.length.edit.setText("50")
    assert form.value() is None and form.problem()


def test_facts_form_round_trip(theme, qtbot, tmp_path):
    settings = QSettings(str(tmp_path / "s.ini"), QSettings.Format.IniFormat)
    form = FactsForm(theme, settings, "torque", "Lever", 365)
    qtbot.addWidget(form)
    facts = Facts("Huber", "sensor 7", "weights", 90)
    form.setValue(facts)
    assert form.value() == facts
    form.remember()
    again = FactsForm(theme, settings, "torque", "Lever", 365).value()
    assert (again.operator, again.instrument) == ("Huber", "sensor 7")
    form.operator.setText(" ")
    assert form.value() is None
    assert "who" in form.problem()


def test_guide_repeats_and_knows_what_is_missing():
    guide = TorqueGuide(Lever(length_m=1.0, masses_kg=(10.0, 20.0)), 1200.0)
    while guide.step is not None:
        guide.take(guide.step.applied_nm, 0.0)
    guide.repeat(3)
    assert guide.at == 3 and not guide.complete
    with pytest.raises(ValueError, match="missing"):
        guide.calibration(rig="r", operator="x", instrument="", reference="", valid_days=1)
    guide.take(guide.step.applied_nm, 0.0)
    assert guide.complete and guide.step is None
    with pytest.raises(ValueError, match="all readings"):
        guide.take(1.0, 0.0)
    assert guide.problem({"speed": 0.2, "pressure": 0.1}) == ""
    assert "release it" in guide.problem({"speed": 0.2, "pressure": 4})
    assert guide.problem({"speed": float("nan"), "pressure": 0.0})


def test_words():
    assert masses_in("1 2,5; 4") == (1.0, 2.5, 4.0)
    assert figure_text("residual_percent", 0.0823) == "residual 0.0823 %"
    assert figure_text("emissivity_set", 0.85) == "emissivity set 0.85"


def test_live_level_of_a_tone():
    wave = np.round(2.0**0.5 / (20.0 / 32768) * np.sin(2 * np.pi * np.arange(40_000) / 40)).astype(np.int16)
    assert sound_view.level_db(wave, 20.0 / 32768) == pytest.approx(94.0, abs=0.05)  # 1 Pa
    assert np.isnan(sound_view.level_db([], 1.0))

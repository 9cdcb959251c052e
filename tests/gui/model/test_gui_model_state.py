"""Sliders, poles and selection agree; the newest question wins; what is not wanted is dropped."""

from pathlib import Path

import pytest

from rigctl.gui.pages.model import worker
from rigctl.gui.pages.model.data import MU, PRESSURE, Setting
from rigctl.gui.pages.model.knob_list import rows_of
from rigctl.gui.pages.model.latest import Latest
from rigctl.gui.pages.model.map_state import COARSE, FINE, MapState
from rigctl.gui.pages.model.state import START_PRESSURE_BAR, ModelState

BRAKES = Path(__file__).resolve().parents[3] / "configs" / "brakes"


def test_sliders_begin_at_the_files_values(state):
    assert state.operating == {"mu": 0.4, "pressure": START_PRESSURE_BAR, "slope": 0.0576}
    assert state.changed_keys() == []
    assert state.poles.setting == state.setting == Setting(0.4, START_PRESSURE_BAR, 0.0576)


def test_a_slider_moves_poles_onset_and_list(state, settled):
    before = state.onsets.own.value
    state.set({"piston_stiffness": 1.5, MU: 0.5}, active="piston_stiffness")
    settled(state)
    direct = worker.poles(state.facts.file, state.setting, None, None)
    assert state.poles.poles == direct.poles
    assert state.onsets.own.value != before
    assert state.locus.over == "piston_stiffness"
    assert dict(state.setting.factors) == dict.fromkeys(state.facts.knob("piston_stiffness").members, 1.5)


def test_factors_of_overlapping_sliders_multiply(state):
    state.set({"piston_stiffness": 2.0, "piston_stiffness:leading": 1.5, "piston_stiffness_normal": 0.5})
    factors = dict(state.setting.factors)
    assert factors["piston_l.stiffness_y"] == pytest.approx(1.5)
    assert factors["piston_t.stiffness_x"] == pytest.approx(2.0)


def test_values_stay_in_range_and_reset_goes_home(state):
    state.set({PRESSURE: 99.0, "disc_mass": 100.0})
    assert (state.value(PRESSURE), state.value("disc_mass")) == (60.0, 4.0)
    assert state.changed_keys() == [PRESSURE, "disc_mass"]
    state.reset([PRESSURE])
    assert state.value(PRESSURE) == START_PRESSURE_BAR
    state.reset()
    assert state.changed_keys() == []


def test_while_a_slider_is_dragged_its_path_is_not_computed_again(state, settled, inline):
    paths = inline.work.count("locus")
    for k in range(20):
        state.set({PRESSURE: 11.0 + k}, active=PRESSURE)
        settled(state, onsets=False)
    assert inline.work.count("locus") == paths
    state.set({MU: 0.5}, active=MU)
    settled(state)
    assert inline.work.count("locus") == paths + 1


def test_the_newest_position_wins(state, settled, inline):
    asked = inline.work.count("poles")
    for k in range(50):
        state.set({PRESSURE: 0.5 * k}, active=PRESSURE)
    settled(state)
    assert state.poles.setting.pressure == 24.5
    assert inline.work.count("poles") - asked == 2  # the first and the last


def test_a_selected_mode_stays_selected_while_dragging(state, settled):
    chosen = state.poles.poles[2]
    state.select(chosen)
    settled(state)
    for k in range(30):
        state.set({PRESSURE: 10.0 + k}, active=PRESSURE)
        settled(state, onsets=False)
    assert state.selected.number == 3
    state.select(None)
    settled(state)
    assert state.selected.real_part_1_s == max(p.real_part_1_s for p in state.poles.poles)


def test_another_selection_is_not_lost_to_a_late_answer(state, settled):
    state.select(state.poles.poles[1])
    state.select(state.poles.poles[8])
    state.set({PRESSURE: 12.0})
    settled(state)
    assert state.selected.number == 9


def test_a_second_brake_stands_beside(state, settled, qtbot):
    state.compare(BRAKES / "plant.toml")
    qtbot.waitUntil(lambda: state.onsets.other is not None and bool(state.poles.other))
    plant = worker.read(BRAKES / "plant.toml").file
    assert state.poles.other == worker.poles(plant, state.setting, None, None).poles
    assert state.onsets.other == worker.onsets(plant, state.setting, None).own
    state.compare(None)
    settled(state)
    assert state.poles.other == ()


def test_a_bad_file_is_told_and_leaves_no_old_answers(state, qtbot, tmp_path):
    path = tmp_path / "bad.toml"
    path.write_text("nonsense = 1\n")
    with qtbot.waitSignal(state.brakeWrong) as caught:
        state.open(path)
    assert "bad.toml" in caught.args[0]
    assert (state.facts, state.poles, state.onsets, state.locus) == (None, None, None, None)
    state.set({MU: 0.3})  # nothing happens
    state.open(BRAKES / "model.toml")
    qtbot.waitUntil(lambda: state.poles is not None)


def test_a_dropped_answer_never_comes(inline, qtbot, qapp):
    latest = Latest(inline.work, worker.read, "", qapp)
    heard = []
    latest.answered.connect(heard.append)
    latest.ask(BRAKES / "model.toml")
    latest.ask(BRAKES / "plant.toml")
    latest.drop()
    latest.ask(BRAKES / "basic.toml")
    qtbot.waitUntil(lambda: not latest.busy)
    assert [facts.name for facts in heard] == ["basic"]
    latest.deleteLater()


def test_search_finds_all_words_in_any_order_and_what_is_changed(state):
    def keys(search, **options):
        rows = rows_of(
            state.facts.knobs, search, state.factors, **{"singles": False, "changed_only": False} | options
        )
        return [knob.key for knob in rows]

    assert keys("stiffness piston normal") == [
        "piston_stiffness_normal", "piston_stiffness_normal:leading", "piston_stiffness_normal:trailing",
    ]  # fmt: skip
    assert keys("c_pis_n") == []
    assert keys("c_pis_n", singles=True) == ["c_pis_n"]
    state.set({"c_pis_n": 1.2, "disc_mass": 0.9})
    assert keys("") != keys("", changed_only=True) == ["disc_mass", "c_pis_n"]


def test_map_is_coarse_then_fine_follows_the_sliders_and_can_be_cancelled(state, inline, qtbot, settled):
    maps = MapState(state, inline)
    sizes, words, stale = [], [], []
    maps.mapFound.connect(lambda found: sizes.append(len(found.x_values)))
    maps.working.connect(words.append)
    maps.stale.connect(stale.append)
    maps.set_seen(True)
    qtbot.waitUntil(lambda: sizes == [COARSE, FINE])
    assert words[0] and not words[-1]
    state.set({MU: 0.5, PRESSURE: 20.0})  # the axes themselves: the map holds
    assert inline.work.count("stability_map") == 2
    state.set({"slope": 0.08})
    maps.cancel()
    assert stale[-1] and not words[-1]
    settled(state)
    assert sizes == [COARSE, FINE]
    maps.again()
    qtbot.waitUntil(lambda: sizes == [COARSE, FINE, COARSE, FINE])
    assert not stale[-1]
    maps.set_seen(False)
    state.set({"slope": 0.09})
    assert inline.work.count("stability_map") == 5  # the cancelled one was asked, nothing unseen


def test_with_the_real_worker_a_drag_is_answered_and_long_work_can_be_cancelled(services, qtbot, settled):
    """One process of its own: files are read, sliders answered, a cancelled map never comes."""
    state = ModelState(services)
    maps = MapState(state, services)
    found = []
    maps.mapFound.connect(found.append)
    state.open(BRAKES / "model.toml")
    qtbot.waitUntil(lambda: state.facts is not None, timeout=60_000)
    maps.set_seen(True)
    maps.cancel()
    for k in range(10):
        state.set({PRESSURE: 20.0 + k}, active=PRESSURE)
    settled(state, timeout=60_000, onsets=False)
    assert state.poles.setting.pressure == 29.0
    assert found == []
    state.deleteLater()

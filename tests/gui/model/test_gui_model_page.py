"""What a person does on the model page: drag, type, click poles, rows and the map, apply, save."""

from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, QPointF, QSettings, Qt

from rigctl.gui.pages.model.data import MU, PRESSURE, CampaignPoints, MapAxis, Measured
from rigctl.gui.pages.model.map_state import FINE
from rigctl.gui.pages.model.page import ModelPage
from rigctl.gui.pages.model.slider import KnobSlider

BRAKES = Path(__file__).resolve().parents[3] / "configs" / "brakes"


def pixel(plot, x, y):
    """Widget pixel of a place of the axes."""
    place = plot.getPlotItem().getViewBox().mapViewToScene(QPointF(x, y))
    return plot.mapFromScene(place)


def click(qtbot, plot, x, y, button=Qt.MouseButton.LeftButton):
    place = QPoint(pixel(plot, x, y))
    qtbot.mouseMove(plot.viewport(), place)
    qtbot.mouseClick(plot.viewport(), button, pos=place)


@pytest.mark.parametrize("logarithmic", [False, True])
def test_slider_round_trip_keys_typing(theme, qtbot, logarithmic):
    ends, step = ((0.25, 4.0), 0.05) if logarithmic else ((0.0, 60.0), 0.1)
    slider = KnobSlider(theme, "p", ends, step, 3 if logarithmic else 1, "bar", logarithmic=logarithmic)
    qtbot.addWidget(slider)
    heard = []
    slider.valueChanged.connect(heard.append)
    for value in (ends[0], 1.0, 2.5, ends[1]):
        slider.setValue(value)
        assert slider.value() == value
    assert heard == []
    slider.setValue(1.0)
    qtbot.keyClick(slider.slider, Qt.Key.Key_Right)
    assert heard == [pytest.approx(1.007 if logarithmic else 1.1)]
    assert slider.number.value() == pytest.approx(heard[-1])
    qtbot.keyClick(slider.slider, Qt.Key.Key_PageDown if logarithmic else Qt.Key.Key_PageUp)
    assert slider.value() != heard[0]
    slider.number.selectAll()
    qtbot.keyClicks(slider.number, "3.2")
    qtbot.keyClick(slider.number, Qt.Key.Key_Return)
    assert slider.value() == heard[-1] == 3.2


def test_head_says_where_it_squeals_and_what_is_now(page, settled):
    assert page.header.onset.text() == "Squeals from 15.0\u202fbar at 2140\u202fHz"
    assert "stable" in page.header.now.text()
    page.sliders.sliders[PRESSURE].number.setValue(20.0)
    settled(page.state)
    assert "1 mode unstable" in page.header.now.text()


def test_slider_poles_list_and_marks_agree(page, settled, qtbot):
    qtbot.keyClick(page.sliders.sliders[PRESSURE].slider, Qt.Key.Key_End)
    settled(page.state)
    assert page.state.value(PRESSURE) == 60.0
    poles = page.state.poles.poles
    rows = page.locus.table.rows
    for row, pole in enumerate(poles):
        texts = [rows.data(rows.index(row, c), Qt.ItemDataRole.DisplayRole) for c in range(5)]
        assert texts[0] == str(pole.number)
        assert texts[1] == ("▲ unstable" if pole.unstable else "● stable")
        assert float(texts[2]) == pytest.approx(pole.frequency_hz, abs=0.06)
        assert float(texts[4]) == pytest.approx(pole.real_part_1_s, abs=0.06)
    assert any(pole.unstable for pole in poles)


def test_clicking_a_pole_opens_its_mode(page, qtbot, settled):
    pole = page.state.poles.poles[5]
    click(qtbot, page.locus.plot, pole.real_part_1_s, pole.frequency_hz)
    settled(page.state)
    assert page.state.selected.number == 6
    assert page.locus.table.value() == 6
    assert page.locus.view.item.shape_shown.number == 6
    assert "Mode 6" in page.locus.view.title.text()


def test_choosing_a_row_opens_its_mode(page, qtbot, settled):
    page.locus.table.setFocus()
    page.locus.table.selectRow(1)
    settled(page.state)
    assert page.locus.view.item.shape_shown.number == 2
    qtbot.keyClick(page.locus.table, Qt.Key.Key_Down)
    settled(page.state)
    assert page.locus.view.item.shape_shown.number == 3


def test_what_is_under_the_mouse_is_told(page):
    plot = page.locus.plot
    pole = page.state.poles.poles[4]
    box = plot.getPlotItem().getViewBox()
    at = box.mapViewToScene(QPointF(pole.real_part_1_s, pole.frequency_hz))
    assert plot.text_at(at).startswith("Mode 5 · stable · 2140")
    lines = page.state.locus
    value = lines.eigenvalues[-8, 4]
    plot.setRange(xRange=(value.real - 10, value.real + 10), yRange=(1000, 3000), padding=0)
    text = plot.text_at(box.mapViewToScene(QPointF(value.real, value.imag / 6.283185307)))
    assert text.startswith("Path at ") and "bar" in text


def test_axes_stay_while_poles_move(page, settled):
    before = page.locus.plot.getPlotItem().getViewBox().viewRange()
    page.state.set({PRESSURE: 55.0, MU: 0.7})
    settled(page.state)
    assert page.locus.plot.getPlotItem().getViewBox().viewRange() == before
    assert "outside" in page.locus.under_mouse.text()
    page.locus.all_modes.click()
    assert page.locus.plot.sees(page.state.selected)


def test_brake_moves_only_while_it_is_seen(page, qtbot):
    view = page.locus.view
    assert view.playing
    start = view.phase.value()
    qtbot.waitUntil(lambda: view.phase.value() != start)
    page.tabs.setCurrentIndex(1)
    assert not view.playing
    page.tabs.setCurrentIndex(0)
    qtbot.mouseClick(view.play, Qt.MouseButton.LeftButton)
    assert not view.playing and view.play.text() == "Play"
    qtbot.mouseClick(view.play, Qt.MouseButton.LeftButton)
    view.phase.setValue(90)
    assert not view.playing and view.phase_text.text() == "90°"
    view.setPlaying(True)
    page.deactivated()
    assert not view.playing


def test_group_is_found_moved_and_reset(page, qtbot, settled):
    panel = page.sliders
    qtbot.keyClicks(panel.search, "disc mass")
    assert [knob.key for knob in panel.knobs.rows] == ["disc_mass"]
    panel.table.selectRow(0)
    assert panel.chosen == "disc_mass"
    qtbot.keyClick(panel.factor.slider, Qt.Key.Key_PageDown)
    settled(page.state)
    assert page.state.value("disc_mass") < 1.0
    assert page.state.locus.over == "disc_mass"
    assert "Disc: mass" in page.locus.path.text()
    qtbot.mouseClick(panel.factor.reset, Qt.MouseButton.LeftButton)
    assert page.state.value("disc_mass") == 1.0
    assert not panel.reset_all.isEnabled()
    panel.search.setText("no such thing")
    assert panel.nothing.isVisible()


def test_a_bad_file_is_told_beside_the_choice(page, qtbot, tmp_path, settled):
    path = tmp_path / "bad.toml"
    path.write_text((BRAKES / "model.toml").read_text().replace('"spring"', '"sprnig"', 1))
    page.open(brake=path)
    qtbot.waitUntil(page.header.brake.error.isVisible)
    assert "bad.toml" in page.header.brake.error.text()
    assert not page.sliders.isEnabled()
    assert page.locus.table.rows.poles == ()
    page.open(brake=BRAKES / "plant.toml")
    qtbot.waitUntil(lambda: page.state.facts is not None)
    settled(page.state)
    assert not page.header.brake.error.isVisible()
    assert page.header.brake.combo.currentText() == "plant"


def show_map(page, qtbot):
    page.tabs.setCurrentIndex(1)
    qtbot.waitUntil(lambda: page.map.map.map is not None and len(page.map.map.map.x_values) == FINE)


def test_a_click_into_the_map_moves_the_sliders(page, qtbot, settled):
    show_map(page, qtbot)
    assert page.map.cancel.isHidden()
    click(qtbot, page.map.plot, 0.55, 30.0)
    settled(page.state)
    assert page.state.value(MU) == pytest.approx(0.55, abs=0.005)
    assert page.state.value(PRESSURE) == pytest.approx(30.0, abs=0.3)
    assert page.sliders.sliders[MU].value() == page.state.value(MU)
    assert page.state.selected.unstable


def test_measured_squeal_is_drawn_told_and_opened(page, qtbot):
    show_map(page, qtbot)
    squeal = Measured(7, Path("c/brakings/00007.h5"), 0.5, 25.0, 2150.0, 91.0)
    quiet = Measured(8, Path("c/brakings/00008.h5"), 0.3, 5.0)
    page.map.map._take_points(CampaignPoints(Path("c"), (squeal,), (quiet,), 1))
    assert "squeal measured: 1" in page.map.note.text()
    click(qtbot, page.map.plot, 0.5, 25.0)
    assert (page.state.value(MU), page.state.value(PRESSURE)) == (0.5, 25.0)
    assert "Braking 7" in page.map.under_mouse.text()
    page.map.open_braking.click()
    assert page.services.shown[-1] == ("data", {"braking": squeal.file})
    page.map.across.combo.setCurrentIndex(page.map.across.combo.findData("disc_mass"))
    page.map.across.combo.activated.emit(page.map.across.combo.currentIndex())
    assert page.map.map.x == MapAxis("disc_mass", 0.5, 2.0)
    assert "friction and pressure" in page.map.note.text() or page.map.map.map.x.key == MU
    qtbot.waitUntil(lambda: page.map.map.map.x.key == "disc_mass")
    assert "friction and pressure" in page.map.note.text()


def test_a_folder_that_is_no_campaign_is_told(page, qtbot, tmp_path):
    page.tabs.setCurrentIndex(1)
    page.map.open_campaign(tmp_path)
    qtbot.waitUntil(page.map.problem.isVisible)
    assert "not a campaign" in page.map.problem.text()


def test_wrong_axes_are_told_at_once(page, qtbot):
    show_map(page, qtbot)
    page.map.across.low.setValue(0.9)
    assert "least value" in page.map.problem.text()
    page.map.across.low.setValue(0.2)
    assert not page.map.problem.isVisible()
    assert page.map.map.x.low == 0.2


def test_a_modification_is_applied_and_taken_back(page, qtbot, tmp_path):
    page.tabs.setCurrentIndex(2)
    qtbot.waitUntil(lambda: page.ranking.ranking is not None)
    row = page.ranking.table.value()
    assert row == page.ranking.ranking.rows[0]
    assert page.ranking.words.text().startswith(row.title)
    qtbot.mouseClick(page.ranking.apply, Qt.MouseButton.LeftButton)
    assert {key: page.state.value(key) for key in row.factors} == pytest.approx(dict(row.factors))
    assert page.ranking.stale.isVisible()
    qtbot.mouseClick(page.ranking.take_back, Qt.MouseButton.LeftButton)
    assert page.state.factors == {}
    assert not page.ranking.stale.isVisible()
    page.ranking.table.setFocus()
    qtbot.keyClick(page.ranking.table, Qt.Key.Key_Return)
    assert page.state.factors
    page.ranking.helpful.setChecked(True)
    assert {r.verdict for r in page.ranking.table.rows.rows} <= {"recommended", "with care"}
    page.ranking.save(tmp_path / "ranking.csv")
    qtbot.waitUntil(lambda: bool(page.services.news))
    assert (tmp_path / "ranking.csv").read_text().startswith("modification,")


def test_a_ranking_that_is_not_wanted_is_dropped(page, qtbot):
    page.tabs.setCurrentIndex(2)
    page.ranking.cancel.click()
    assert page.ranking.progress.isHidden()
    qtbot.wait(1)
    assert page.ranking.ranking is None


def test_pictures_are_copied_and_saved(page, tmp_path):
    menu = page.locus.menu.menu()
    assert [action.text() for action in menu.actions()][-2:] == ["Copy picture", "Save picture…"]
    next(action for action in menu.actions() if action.text() == "View: all modes").trigger()
    assert all(page.locus.plot.sees(pole) for pole in page.state.poles.poles)
    menu.deleteLater()
    page.locus.menu.copy()
    page.locus.menu.save(tmp_path / "locus")
    assert (tmp_path / "locus.png").stat().st_size > 1000
    assert "locus.png" in page.services.news[-1]
    page.locus.menu.save(tmp_path / "no" / "such" / "folder.png")
    assert "cannot be written" in page.services.news[-1]


def test_look_and_size_of_text_change_while_shown(page, theme, qtbot):
    show_map(page, qtbot)
    try:
        theme.set(name="dark", scale=1.5)
        page.grab()
        page.tabs.setCurrentIndex(0)
        page.grab()
    finally:
        theme.set(name="light", scale=1.0)


def test_layout_and_files_are_remembered(page, qtbot, tmp_path, settled):
    settings = QSettings(str(tmp_path / "layout.ini"), QSettings.Format.IniFormat)
    page.open(brake=BRAKES / "plant.toml")
    qtbot.waitUntil(lambda: page.state.facts is not None and page.state.facts.name == "plant")
    settled(page.state)
    page.tabs.setCurrentIndex(2)
    page.save_layout(settings)
    again = ModelPage(page.services)
    qtbot.addWidget(again)
    again.restore_layout(settings)
    again.activated()
    qtbot.waitUntil(lambda: again.state.facts is not None)
    assert again.state.facts.name == "plant"
    assert again.tabs.currentIndex() == 2
    again.deactivated()

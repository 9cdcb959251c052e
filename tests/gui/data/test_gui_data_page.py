"""What an operator does on the data page."""

import shutil
import wave
from dataclasses import replace

import pytest
from PySide6.QtCore import QPointF, QSettings, Qt

from rigctl.core.journal import read_journal, verify_journal
from rigctl.gui.pages.data.page import DataPage
from rigctl.gui.rig.state import RigState
from rigctl.recording.annotations import Action, annotate, read_annotations

LONG = 20_000


def names(page):
    return [e.index for e in page.table.model.list.visible]


def choose(page, qtbot, *indices):
    """Choose brakings and wait until the first one is open."""
    files = [page.table.model.list.of_braking(index)[0].name for index in indices]
    assert page.table.choose(files)
    qtbot.waitUntil(lambda: not page.braking.busy and page.braking.view is not None, timeout=LONG)


def key_in(qtbot, widget, text):
    qtbot.keyClicks(widget, text)
    qtbot.keyClick(widget, Qt.Key.Key_Return)


def press(qtbot, button):
    qtbot.mouseClick(button, Qt.MouseButton.LeftButton)


def test_the_newest_campaign_opens_with_its_first_braking(opened, second, qtbot):
    assert opened.campaigns.value().name == "first"
    assert names(opened) == [1, 2, 3, 4, 5, 6]
    qtbot.waitUntil(lambda: opened.braking.view is not None, timeout=LONG)
    assert opened.braking.title.text().startswith("Braking 1")
    assert "2 squealing" in opened.table.count.text()
    opened.refresh()
    qtbot.waitUntil(lambda: len(opened.campaigns.campaigns()) == 2, timeout=LONG)


def test_a_braking_opened_shows_channels_events_and_results(opened, qtbot):
    choose(opened, qtbot, 2)
    pane = opened.braking
    assert pane.events.lines()[0][0] == "2350"
    assert any(line[0] == "Loudest squeal, level" for line in pane.results.lines())
    assert {"spectrogram", "microphone", "pressure", "mu"} <= set(pane.rows.available())
    assert 19.5 < pane.rows.values_at(1.5)["pressure"] < 20.5
    pane.events.selectRow(0)
    low, high = pane.rows.span()
    assert low == pytest.approx(0.5, abs=0.2) and high == pytest.approx(2.8, abs=0.2)
    pane.switches["speed"].setChecked(False)
    assert pane.rows.span() == pytest.approx((low, high)), "the stretch of time stays"
    pane.rows.show_all()
    assert pane.rows.span() == pytest.approx((0.0, 3.0))


def test_exclude_with_a_reason_and_undo(opened, campaign, qtbot):
    choose(opened, qtbot, 2, 4)
    bar = opened.table.bar
    press(qtbot, bar.exclude_button)
    assert not bar.reason.done.isEnabled(), "no reason, no exclusion"
    key_in(qtbot, bar.reason.edit, "hammering next door")
    qtbot.waitUntil(lambda: bar.done.text() == "2 brakings excluded", timeout=LONG)
    assert [e.row.excluded for e in opened.table.chosen()] == ["hammering next door"] * 2
    assert "0 squealing" in opened.table.count.text() and names(opened) == [1, 2, 3, 4, 5, 6]
    assert "hammering next door" in opened.braking.words.text()
    qtbot.keyClick(opened.table.view, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: "Undone" in bar.done.text(), timeout=LONG)
    assert not any(state.excluded for state in read_annotations(campaign).states.values())
    assert [r.payload["action"] for r in read_journal(campaign / "journal.jsonl")] == (
        ["exclude"] * 2 + ["restore"] * 2
    )
    assert verify_journal(campaign / "journal.jsonl") == []


def test_trash_and_undo(opened, campaign, qtbot):
    choose(opened, qtbot, 3)
    qtbot.keyClick(opened.table.view, Qt.Key.Key_Delete)
    qtbot.waitUntil(lambda: not (campaign / "brakings" / "00003.h5").exists(), timeout=LONG)
    qtbot.waitUntil(lambda: names(opened) == [1, 2, 4, 5, 6] and not opened.loader.busy, timeout=LONG)
    assert "resume" in opened.table.bar.trash_button.toolTip()
    opened.table.filters.state.setCurrentIndex(opened.table.filters.state.findData("trashed"))
    assert names(opened) == [3]
    press(qtbot, opened.table.bar.undo_button)
    qtbot.waitUntil((campaign / "brakings" / "00003.h5").exists, timeout=LONG)
    press(qtbot, opened.table.filters.clear)
    qtbot.waitUntil(lambda: names(opened) == [1, 2, 3, 4, 5, 6], timeout=LONG)


def test_tags_note_and_rating_of_the_open_braking(opened, campaign, qtbot):
    choose(opened, qtbot, 4)
    notes = opened.braking.notes
    opened.braking.tabs.setCurrentWidget(notes)
    notes.tags.edit.setFocus()
    key_in(qtbot, notes.tags.edit, "cold, again")
    qtbot.waitUntil(lambda: read_annotations(campaign).of(4).tags == ("again", "cold"), timeout=LONG)
    key_in(qtbot, notes.note, "sounds like a flute")
    qtbot.waitUntil(lambda: read_annotations(campaign).of(4).note == "sounds like a flute", timeout=LONG)
    notes.rating.setCurrentIndex(notes.rating.findData(7))
    notes.rating.activated.emit(notes.rating.currentIndex())
    qtbot.waitUntil(lambda: read_annotations(campaign).of(4).rating == 7, timeout=LONG)
    qtbot.waitUntil(lambda: opened.table.chosen()[0].row.rating == 7, timeout=LONG)
    opened.table.filters.tag.setCurrentIndex(opened.table.filters.tag.findData("cold"))
    assert names(opened) == [4]
    notes.tags.edit.setText("bad;tag")
    notes.tags.edit.textEdited.emit("bad;tag")
    assert notes.tags.edit.property("wrong") == "true" and "cannot be a tag" in notes.tags.fault.text()


def test_filters_say_what_they_cannot_read(opened, qtbot):
    bounds = opened.table.filters.pressure
    qtbot.keyClicks(bounds.low, "1O")
    assert bounds.low.property("wrong") == "true"
    assert "no number" in opened.table.filters.fault.text()
    assert names(opened) == [1, 2, 3, 4, 5, 6], "the last usable filter stays"
    bounds.low.clear()
    qtbot.keyClicks(bounds.low, "15")
    assert names(opened) == [2, 4] and not opened.table.filters.fault.text()
    assert "2 of 6" in opened.table.count.text()


def test_a_click_on_a_dot_or_cell_opens_its_braking(opened, qtbot):
    figures = opened.figures
    opened.tabs.setCurrentWidget(figures)
    figures.figure.setCurrentIndex(figures.figure.findData("occurrence"))
    qtbot.waitUntil(lambda: not figures.busy, timeout=LONG)
    plot = figures.plots[0]
    cells = figures._data[0].picture
    spot = QPointF(cells.pressures_bar.index(20.0), cells.temperatures_degc.index(150.0))
    place = plot.mapFromScene(plot.getPlotItem().vb.mapViewToScene(spot))
    qtbot.mouseClick(plot.viewport(), Qt.MouseButton.LeftButton, pos=place)
    qtbot.waitUntil(lambda: [e.index for e in opened.table.chosen()] == [4], timeout=LONG)
    assert opened.tabs.currentWidget() is opened.braking
    opened.tabs.setCurrentWidget(figures)
    figures.figure.setCurrentIndex(figures.figure.findData("pressure_frequency"))
    qtbot.waitUntil(lambda: not figures.busy, timeout=LONG)
    dots = figures._data[0].picture
    number = dots.names.index("brakings/00002.h5")
    spot = QPointF(dots.x[number], dots.y[number])
    place = plot.mapFromScene(plot.getPlotItem().vb.mapViewToScene(spot))
    qtbot.mouseClick(plot.viewport(), Qt.MouseButton.LeftButton, pos=place)
    qtbot.waitUntil(lambda: opened.table.chosen()[0].index in (2, 4), timeout=LONG)


def test_two_campaigns_side_by_side(opened, second, qtbot):
    annotate(second, 2, Action.EXCLUDE, "why")
    opened.refresh()
    qtbot.waitUntil(lambda: opened.figures.beside.count() == 2, timeout=LONG)
    opened.tabs.setCurrentWidget(opened.figures)
    opened.figures.beside.setCurrentIndex(1)
    qtbot.waitUntil(
        lambda: not opened.figures.busy and not opened.figures.statistics.isColumnHidden(2), timeout=LONG
    )
    lines = {line[0]: line[1:3] for line in opened.figures.statistics.lines()}
    assert lines["squealing"] == ["2", "1"] and lines["excluded"] == ["0", "1"]


def test_brakings_laid_over_each_other(opened, qtbot):
    choose(opened, qtbot, 1, 2)
    press(qtbot, opened.table.bar.compare_button)
    assert opened.tabs.currentWidget() is opened.compare
    qtbot.waitUntil(lambda: not opened.compare.busy, timeout=LONG)
    choose(opened, qtbot, 4)
    press(qtbot, opened.table.bar.compare_button)
    qtbot.waitUntil(lambda: not opened.compare.busy, timeout=LONG)
    assert [e.index for e in opened.compare.compared()] == [1, 2, 4]
    assert len(opened.compare.plot.getPlotItem().listDataItems()) == 3
    for place in range(opened.compare.what.count()):
        opened.compare.what.setCurrentIndex(place)
        assert len(opened.compare.plot.getPlotItem().listDataItems()) == 3
    table = {line[0]: line[1:5] for line in opened.compare.table.lines()}
    assert table["Set pressure"] == ["6.0", "20.0", "20.0", ""]


def test_export_with_progress(opened, tmp_path, qtbot, services):
    choose(opened, qtbot, 1, 6)
    press(qtbot, opened.table.bar.export_button)
    bar, target = opened.export, tmp_path / "out"
    bar.folder.setText(str(target))
    for box in bar.formats.values():
        box.setChecked(False)
    assert not bar.start.isEnabled() and "format" in bar.fault.text()
    for box in bar.formats.values():
        box.setChecked(True)
    with qtbot.waitSignal(bar.finished, timeout=LONG) as done:
        press(qtbot, bar.start)
    found = sorted(path.name for path in target.iterdir())
    assert done.args == [len(found)] and "first-00001.wav" in found and "first-00006.mat" in found
    assert "first-00006.wav" not in found, "recorded without sound"
    assert bar.isHidden() and "files written" in services.news[-1]


def test_a_cancelled_export_stops_after_the_present_braking(opened, tmp_path, qtbot):
    choose(opened, qtbot, 1, 2, 3, 4)
    opened.export.ask(opened.loader.campaign, opened.table.chosen())
    opened.export.folder.setText(str(tmp_path / "out"))
    with qtbot.waitSignal(opened.export.finished, timeout=LONG):
        press(qtbot, opened.export.start)
        press(qtbot, opened.export.cancel)
    assert {path.name[:11] for path in (tmp_path / "out").iterdir()} == {"first-00001"}


def test_the_sound_as_wav(opened, campaign, tmp_path, qtbot):
    choose(opened, qtbot, 2)
    opened.braking.sound.save_to(campaign / "brakings" / "00002.h5", tmp_path / "s.wav")
    qtbot.waitUntil((tmp_path / "s.wav").exists, timeout=LONG)
    with wave.open(str(tmp_path / "s.wav")) as sound:
        assert (sound.getframerate(), sound.getnchannels(), sound.getsampwidth()) == (40000, 1, 2)


def test_new_brakings_of_a_running_campaign_appear_by_themselves(opened, campaign, qtbot, services):
    shutil.copy(campaign / "brakings" / "00004.h5", campaign / "brakings" / "00007.h5")
    record = next(iter(_records(campaign, "BRAKING_COMMITTED", index=7, file="00007.h5", sha256="x")))
    services.rig.recordsAdded.emit([record])
    assert names(opened) == [1, 2, 3, 4, 5, 6], "another campaign, or none, is being written"
    services.rig.state = replace(RigState(), campaign=campaign)
    services.rig.recordsAdded.emit([record])
    qtbot.waitUntil(lambda: opened.table.model.rowCount() == 7, timeout=LONG)


def test_words_from_elsewhere_arrive_when_the_page_is_shown_again(opened, campaign, qtbot):
    opened.deactivated()
    annotate(campaign, 1, Action.TAG, "cli")
    opened.activated()
    qtbot.waitUntil(lambda: opened.table.model.list.tags() == ["cli"], timeout=LONG)


def _records(campaign, kind, **payload):
    from rigctl.core.journal import Journal

    journal = Journal(campaign / "journal.jsonl", "recorder")
    yield journal.write(kind, **payload)
    journal.close()


def test_other_pages_open_a_braking(page, campaign, second, qtbot):
    page.open(campaign=second, braking=4)
    qtbot.waitUntil(lambda: [e.index for e in page.table.chosen()] == [4], timeout=LONG)
    assert page.loader.campaign == second
    page.open(braking=campaign / "brakings" / "00003.h5")
    qtbot.waitUntil(lambda: [e.index for e in page.table.chosen()] == [3], timeout=LONG)
    assert page.loader.campaign == campaign
    page.open(campaign=campaign, braking=99)
    assert "99 is not in this campaign" in page.table.bar.done.text()


def test_without_data_the_page_says_how_to_get_some(page, services, qtbot):
    page.show()
    page.activated()
    qtbot.waitUntil(lambda: page.parts.currentWidget() is page.empty, timeout=LONG)
    assert "simulated rig" in page.empty.words.text()
    press(qtbot, page.empty.by_hand)
    press(qtbot, page.empty.test)
    assert [name for name, _ in services.shown] == ["manual", "sequence"]


def test_columns_and_order_are_remembered(opened, services, tmp_path, qtbot):
    menu = opened.table.column_menu()
    next(a for a in menu.actions() if a.objectName() == "column-lmax").trigger()
    opened.table.view.horizontalHeader().moveSection(1, 0)
    opened.table._on_header(0)
    settings = QSettings(str(tmp_path / "layout.ini"), QSettings.Format.IniFormat)
    columns = opened.table.shown_columns()
    opened.save_layout(settings)
    again = DataPage(services)
    qtbot.addWidget(again)
    again.restore_layout(settings)
    assert again.table.shown_columns() == columns and "lmax" in columns
    assert again.table.model.list.descending
    assert again.loader.campaign == opened.loader.campaign
    again.table.reset_columns()
    assert again.table.shown_columns()[0] == "index" and "lmax" not in again.table.shown_columns()
    again.stop_reading()


def test_a_report_that_cannot_be_built_says_why(opened, qtbot):
    press(qtbot, opened.campaigns.build)
    assert not opened.campaigns.build.isEnabled()
    qtbot.waitUntil(lambda: not opened.reports.busy, timeout=LONG)
    assert "campaign.toml" in opened.table.bar.done.text()
    assert opened.campaigns.build.isEnabled()


def test_large_view_by_keys_and_another_look(opened, services, qtbot):
    choose(opened, qtbot, 2)
    qtbot.keyClick(opened.table.view, Qt.Key.Key_Return)
    assert not opened.table.isVisible() and opened.braking.isVisible()
    theme = services.theme
    theme.set(name="dark", scale=1.5)
    assert {"spectrogram", "pressure"} <= set(opened.braking.rows._rows)
    theme.set(name="light", scale=1.0)
    qtbot.keyClick(opened.braking, Qt.Key.Key_Escape)
    assert opened.table.isVisible()


def test_every_control_has_a_tip(opened):
    from PySide6.QtWidgets import QAbstractButton, QComboBox, QLineEdit

    silent = [
        w.objectName() or w
        for kind in (QAbstractButton, QComboBox, QLineEdit)
        for w in opened.findChildren(kind)
        if w.objectName().startswith("data-") and not w.toolTip()
    ]
    assert silent == []

"""The live view as a person uses it: follow, zoom, freeze, cursors, pictures, limits, empty states."""

import numpy as np
import pytest
import shiboken6
from PySide6.QtCore import QPoint, QPointF, QSettings, Qt
from PySide6.QtGui import QGuiApplication, QImage, QPainter, QTransform, QWheelEvent
from PySide6.QtWidgets import QApplication, QFileDialog

from rigctl.gui.live.feed import LiveFeed
from rigctl.gui.live.history import ChannelHistory
from rigctl.gui.live.items import LineItem, pen
from rigctl.gui.live.pictures import save_picture
from rigctl.gui.live.view import LiveView
from rigctl.gui.rig.state import Readings, RigState


def _x(plot) -> tuple[float, float]:
    low, high = plot.view.viewRange()[0]
    return round(low, 6), round(high, 6)


def _wheel(plot, notches: int, modifiers=Qt.KeyboardModifier.NoModifier) -> None:
    viewport = plot.graphics.viewport()
    centre = plot.graphics.mapFromScene(plot.view.sceneBoundingRect().center())
    event = QWheelEvent(
        QPointF(centre), QPointF(viewport.mapToGlobal(centre)), QPoint(0, 0), QPoint(0, 120 * notches),
        Qt.MouseButton.NoButton, modifiers, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(viewport, event)


@pytest.fixture
def running(live_view, acquisition, qtbot, services) -> LiveView:
    """A view with eight seconds of a squealing braking, limits read."""
    view = live_view(columns=2)
    acquisition.attach()
    qtbot.waitUntil(lambda: bool(view.feed.limits))
    for _ in range(4):
        acquisition.blocks(40)
        while view.feed.data.work(1.0):
            pass
    view._tick()
    return view


def test_without_a_rig_it_says_what_to_expect(live_view):
    view = live_view()
    view._tick()
    assert "rig is running" in view.panels["waveform"].hint.text()
    assert view.panels["trend"].plots()[0].hint.isVisible()
    assert not view.panels["spectrum"].hint.isVisible()


def test_signals_set_points_limits_and_mu_are_shown(running, acquisition, services):
    view = running
    services.rig.stateChanged.emit(RigState(readings=Readings(set_speed_rpm=160.0, set_pressure_bar=20.0)))
    acquisition.blocks(20)
    for plot in view.plots():
        plot._value_at = 0.0
    view._tick()
    rows = view.panels["trend"].rows
    assert "<b>20.0</b>" in rows["pressure"].value.text()
    assert "set 160" in rows["speed"].value.text()
    assert "<b>0.40</b>" in rows["mu"].value.text()
    assert rows["pressure"]._limits.band == (-1.0, 24.0)
    assert rows["temperatures"].channels == ["disc_temperature", "pad_temperature"]
    assert "vibration" in rows
    low, high = rows["speed"].view.viewRange()[1]
    assert low < 150.0 and high > 160.0
    assert "squeal 2350" in view.panels["spectrum"].value.text()
    assert len(view.panels["spectrogram"]._boxes._boxes) == 1
    assert view.feed.data.level_db() == pytest.approx(92.2, abs=0.2)
    assert "LAF 92" in view.panels["level"].value.text()
    assert "peak 1.00" in view.panels["waveform"].value.text()


def test_it_follows_until_somebody_zooms_and_again_on_demand(running, acquisition):
    view = running
    waveform, pressure = view.panels["waveform"], view.panels["trend"].rows["pressure"]
    assert _x(waveform) == _x(pressure) == (-4.0, 8.0)
    _wheel(waveform, 3)
    zoomed = _x(waveform)
    assert zoomed == _x(pressure) and zoomed[1] - zoomed[0] < 8.0
    assert not view.tools.follow.isChecked()
    acquisition.blocks(20)
    view._tick()
    assert _x(waveform) == zoomed  # it does not jump while a person looks
    view.tools.follow.click()
    assert _x(waveform) == (-3.0, 9.0) and view.tools.follow.isChecked()


def test_ctrl_wheel_zooms_the_vertical_axis_of_one_plot(running, acquisition):
    view = running
    level = view.panels["level"]
    before = level.view.viewRange()[1]
    _wheel(level, 3, Qt.KeyboardModifier.ControlModifier)
    after = level.view.viewRange()[1]
    assert after[1] - after[0] < 0.8 * (before[1] - before[0])
    acquisition.blocks(20)
    view._tick()
    assert level.view.viewRange()[1] == after
    assert _x(level) == (-3.0, 9.0)
    view.follow()
    assert level.view.viewRange()[1] == before


def test_drag_moves_and_double_click_follows(running, qtbot):
    view = running
    waveform = view.panels["waveform"]
    viewport = waveform.graphics.viewport()
    centre = waveform.graphics.mapFromScene(waveform.view.sceneBoundingRect().center())
    qtbot.mousePress(viewport, Qt.MouseButton.LeftButton, pos=centre)
    for dx in (10, 30, 60):
        qtbot.mouseMove(viewport, centre + QPoint(dx, 0))
        QApplication.processEvents()
    qtbot.mouseRelease(viewport, Qt.MouseButton.LeftButton, pos=centre + QPoint(60, 0))
    low, high = _x(waveform)
    assert low < -4.2 and high - low == pytest.approx(12.0)
    waveform.view.followAsked.emit()
    assert _x(waveform) == (-4.0, 8.0)


def test_keys_and_span(running, qtbot):
    view = running
    level = view.panels["level"]
    for keys, expected in (
        (Qt.Key.Key_Left, (-7.0, 5.0)), (Qt.Key.Key_Right, (-4.0, 8.0)), (Qt.Key.Key_Plus, (-2.0, 6.0)),
        (Qt.Key.Key_Home, (-4.0, 8.0)),
    ):  # fmt: skip
        view.tools.follow.setFocus()
        qtbot.keyClick(view.tools.follow, keys)
        assert _x(level) == expected
    view.tools.span.setCurrentIndex(view.tools.span.findData(5.0))
    view.tools.span.activated.emit(view.tools.span.currentIndex())
    assert _x(level) == (3.0, 8.0)


def test_freeze_holds_the_picture_and_reading_goes_on(running, acquisition):
    view = running
    view.tools.freeze.click()
    assert view.frozen and "FROZEN at 0:08.0" in view.tools.frozen_mark.text()
    assert view.tools.frozen_mark.isVisible() and not view.tools.follow.isChecked()
    acquisition.blocks(40)
    view._tick()
    assert _x(view.panels["waveform"]) == (-4.0, 8.0)
    assert view.feed.data.buffer.channels["pressure"].end_s == pytest.approx(10.0)
    assert view.data.buffer.channels["pressure"].end_s == pytest.approx(8.0)
    view.tools.freeze.click()
    assert _x(view.panels["waveform"]) == (-2.0, 10.0)
    view.tools.freeze.click()
    view.tools.follow.click()  # one press shows the present
    assert not view.frozen and not view.tools.frozen_mark.isVisible()


def test_cursors_give_values_and_difference(running, acquisition):
    view = running
    view.tools.cursors.click()
    pressure, level = view.panels["trend"].rows["pressure"], view.panels["level"]
    view.time.move_cursor(0, 2.0)
    view.time.move_cursor(1, 5.5)
    assert pressure.cursor_text.isVisible()
    assert "B−A 3.500\u202fs" in pressure.cursor_text.text() and "0:02" in pressure.cursor_text.text()
    assert [line.value() for line in level._cursor_lines] == [2.0, 5.5]
    level._cursor_lines[0].setValue(3.0)
    level._cursor_lines[0].sigDragged.emit(level._cursor_lines[0])
    assert pressure._cursor_lines[0].value() == 3.0
    spectrum = view.panels["spectrum"]
    spectrum._value_at = 0.0
    view._forget_drawn()
    view._tick()
    assert "at A 0:03.00" in spectrum.value.text() and "squeal 2350" in spectrum.value.text()
    view.time.move_cursor(0, -1.0)
    assert "cursor A" in spectrum.hint.text()
    view.tools.cursors.click()
    assert not pressure.cursor_text.isVisible() and level._cursor_lines == []


def test_hover_tells_what_is_there(running):
    plots = running.panels
    assert plots["trend"].rows["pressure"].describe(4.0, 0.0) == "0:04.00   20.0\u202fbar"
    assert "2350\u202fHz   9" in plots["spectrum"].describe(2350.0, 0.0)
    assert plots["spectrogram"].describe(4.0, 2350.0)[-5:] in ("90\u202fdB", "91\u202fdB")
    assert "−" not in plots["waveform"].describe(4.0, 0.0)
    assert plots["waveform"].describe(-3.0, 0.0).endswith("—")
    waveform = plots["waveform"]
    waveform._on_mouse(waveform.view.sceneBoundingRect().center())
    assert "Pa" in waveform.readout.text()
    waveform._on_mouse(QPointF(-5.0, -5.0))
    assert waveform.readout.text() == ""


def test_panels_and_rows_can_be_hidden_and_are_remembered(running, live_view, services, tmp_path):
    view = running
    actions = {action.text(): action for action in view.tools.show_menu.actions()}
    actions["Torque"].trigger()
    actions["Spectrum"].trigger()
    assert not view.panels["spectrum"].isVisible()
    assert "torque" not in [plot.spec.row for plot in view.panels["trend"].plots()]
    view.time.set_span(30.0)
    settings = QSettings(str(tmp_path / "layout.ini"), QSettings.Format.IniFormat)
    view.save_layout(settings)
    other = live_view(columns=2)
    other.restore_layout(settings)
    assert not other.panels["spectrum"].isVisible() and other.time.span_s == 30.0
    assert other.tools.span.currentData() == 30.0
    assert other.panels["trend"].rows["torque"].isHidden()
    only = live_view(panels=("level",))
    only._on_shown("level", False)
    assert only.panels["level"].isVisible()  # the last one stays


def test_pictures_to_clipboard_png_and_svg(running, tmp_path, services):
    view = running
    view.copy_picture(view.panels["waveform"])
    assert QGuiApplication.clipboard().image().width() > 100
    assert services.news == ["Picture copied"]
    save_picture(view.panels["spectrogram"], tmp_path / "a.png")
    image = QImage(str(tmp_path / "a.png"))
    assert image.width() == 2 * view.panels["spectrogram"].width()
    save_picture(view, tmp_path / "a.svg")
    assert "<svg" in (tmp_path / "a.svg").read_text() and "Pressure" in (tmp_path / "a.svg").read_text()
    with pytest.raises(OSError):
        save_picture(view, tmp_path / "missing" / "a.svg")
    with pytest.raises(OSError):
        save_picture(view, tmp_path / "missing" / "a.png")


def test_saving_asks_without_blocking(running, tmp_path, services, qtbot):
    dialog = running.save_picture(running.panels["level"])
    assert isinstance(dialog, QFileDialog) and not dialog.isModal()
    dialog.fileSelected.emit(str(tmp_path / "level.png"))
    dialog.fileSelected.emit(str(tmp_path / "missing" / "level.png"))
    assert (tmp_path / "level.png").exists()
    assert "saved as" in services.news[0] and "not saved" in services.news[1]
    dialog.close()
    qtbot.waitUntil(lambda: not shiboken6.isValid(dialog))


def test_right_button_offers_the_tools(running, qtbot):
    view = running
    menu = view.tools.menu_of(view.panels["level"])
    words = [action.text() for action in menu.actions() if action.text()]
    assert words == ["Follow", "Freeze", "Cursors", "Copy picture", "Save picture…"]
    menu.actions()[1].trigger()
    assert view.frozen
    menu.aboutToHide.emit()
    qtbot.waitUntil(lambda: not shiboken6.isValid(menu))


def test_nothing_is_drawn_when_nothing_is_new_or_nobody_looks(running, acquisition, monkeypatch):
    view = running
    drawn: list[int] = []
    monkeypatch.setattr(view.panels["level"], "refresh", lambda data: drawn.append(1))
    view._tick()
    view._tick()
    assert drawn == []
    acquisition.blocks(1)
    view._tick()
    assert drawn == [1]
    view.hide()
    acquisition.blocks(1)
    view._tick()
    assert drawn == [1]
    view.stop()
    assert not view._timer.isActive()


def test_theme_and_size_of_text_are_taken_on(running, theme, qtbot):
    view = running
    pressure = view.panels["trend"].rows["pressure"]
    width = pressure.y_axis.width()
    try:
        theme.set(name="dark", scale=1.5)
        view._tick()
        assert pressure._lines[0].pen.color().name() == theme.current.pressure
        qtbot.waitUntil(lambda: pressure.y_axis.width() > width)
        assert view.grab().toImage().pixelColor(60, 120).lightness() < 128
    finally:
        theme.set(name="light", scale=1.0)


def test_several_views_share_one_feed(live_view, services):
    assert live_view().feed is live_view().feed is LiveFeed.of(services)


def test_session_ends_and_another_comes(running, acquisition, services, tmp_path, qtbot):
    view = running
    services.rig.detached.emit("finished")
    assert not view.feed.attached
    assert view.data.buffer.channels["pressure"].value(4.0) == 20.0  # still to be looked at
    acquisition.blocks(1)
    view._tick()
    assert view.data.end_s == pytest.approx(8.0)
    (tmp_path / "next").mkdir()
    second = type(acquisition)(tmp_path / "next", services)
    second.attach()
    qtbot.waitUntil(lambda: view.feed._reading is None)
    second.blocks(2)
    assert view.data.end_s == pytest.approx(0.1)
    assert view.data.buffer.friction is not None


def test_sound_of_virtual_time_never_holds_the_window_up(running, acquisition):
    """Bursts are analysed in slices; what cannot be analysed is left out, the newest is kept."""
    view = running
    acquisition.blocks(280)  # 14 s at once
    data = view.feed.data
    assert data._backlog_s <= 3.0
    for left in reversed(range(len(data._backlog))):
        assert data.work(0.0) == (left > 0)  # one slice a turn when there is no time
        assert len(data._backlog) == left
    assert data.sound.spectrogram.end_s > 21.8


def test_paused_rig_without_sound_says_so(running, acquisition):
    acquisition.blocks(280, sound=False)
    for plot in running.plots():
        plot._value_at = 0.0
    running._tick()
    assert np.isnan(running.feed.data.level_db())
    assert "while a braking is recorded" in running.panels["waveform"].hint.text()
    assert running.panels["level"].value.text() == ""
    assert "squeal" not in running.panels["spectrum"].value.text()
    assert "from 0:08" in running.panels["spectrum"].value.text()


@pytest.mark.parametrize("at", [3, 11_111, 77_777, 239_999, 431_234])
def test_a_peak_of_one_sample_is_painted(at, qapp):
    """Down to the pixels: Qt's lines, too, lose nothing."""
    rng = np.random.default_rng(at)
    x = rng.normal(0, 0.1, 480_000).astype(np.float32)
    x[at] = 1.0
    history = ChannelHistory(40_000.0, 12.0)
    history.append(1000.0, x)
    width, height = 583, 100
    line = LineItem(pen("#000000"))
    line.set_envelope(history.envelope(1000.0, 1012.0, width))
    image = QImage(width, height, QImage.Format.Format_Grayscale8)
    image.fill(255)
    painter = QPainter(image)
    scale = QTransform.fromScale(width / 12.0, -height / 2.2)
    painter.setTransform(
        QTransform.fromTranslate(-1000.0, 0.0) * scale * QTransform.fromTranslate(0, height / 2)
    )
    line.paint(painter)
    painter.end()
    pixels = np.frombuffer(image.constBits(), np.uint8).reshape(height, image.bytesPerLine())[:, :width]
    top = np.flatnonzero((pixels[5:20] < 128).any(axis=0))
    assert len(top) >= 1 and abs(top.mean() - at / 480_000 * width) < 2.0
    assert ((pixels < 128).sum(axis=0)[2:-2] > 8).all()  # no column is left out

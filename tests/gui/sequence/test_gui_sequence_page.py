"""The page as a person uses it: open, edit, undo, save, start; nothing is lost without a question."""

import shutil
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent, QWheelEvent
from PySide6.QtWidgets import QApplication, QFileDialog, QPushButton

from rigctl.app.compose import read_program
from rigctl.gui.pages.sequence.page import SequencePage
from rigctl.gui.rig.state import RigState, Word
from sequences.program import load_program

ROOT = Path(__file__).resolve().parents[3]
CONTROL = Qt.KeyboardModifier.ControlModifier


@pytest.fixture
def page(services, qtbot) -> SequencePage:
    """The page, shown, with the rigs read."""
    page = SequencePage(services)
    qtbot.addWidget(page)
    page.resize(1140, 660)
    page.show()
    qtbot.waitExposed(page)
    page.activated()
    qtbot.waitUntil(lambda: page.rig_choice.rig is not None and bool(page.empty.findChildren(QPushButton)))
    return page


def opened(page: SequencePage, qtbot, path: Path) -> None:
    page.open(program=path)
    qtbot.waitUntil(lambda: page.files.path == path)


def copied(tmp_path: Path, name: str) -> Path:
    return Path(shutil.copy(ROOT / f"configs/programs/{name}.toml", tmp_path / f"{name}.toml"))


def settled(page: SequencePage, qtbot) -> None:
    qtbot.waitUntil(lambda: page._current_forecast() is not None)


def button(page: SequencePage, name: str) -> QPushButton:
    found = page.findChild(QPushButton, name)
    assert found is not None, name
    return found


@pytest.fixture
def started(page: SequencePage, monkeypatch: pytest.MonkeyPatch) -> list[tuple]:
    """What the connection was asked to start."""
    calls: list[tuple] = []
    monkeypatch.setattr(
        page.services.rig, "start_program", lambda program, rig, **how: calls.append((program, rig, how))
    )
    return calls


def test_the_empty_page_offers_programs(page, qtbot) -> None:
    assert page.body.currentWidget() is page.empty
    button(page, "program-quick_check").click()
    qtbot.waitUntil(lambda: page.body.currentIndex() == 1)
    settled(page, qtbot)
    assert page.figures.count.text() == "6 brakings"
    assert page.figures.duration.text().replace("\u202f", " ") == "about 53 s"
    assert page.start.button.isEnabled()
    assert page.unsaved() == []


def test_a_new_matrix_can_be_started_at_once_and_is_unsaved(page, qtbot, started) -> None:
    button(page, "empty-new").click()
    settled(page, qtbot)
    assert page.start.button.isEnabled()
    assert len(page.unsaved()) == 1
    page.start.button.click()
    assert "copy" in page.start.words.text()
    qtbot.keyClicks(page.start.seed, "5")
    page.start.go.click()
    qtbot.waitUntil(lambda: bool(started))
    program, rig, how = started[0]
    assert program.parent == page.services.data_folder / "programs"
    assert read_program(program) == page.draft.program
    assert rig.name == "simulated.toml"
    assert how == {"time": "virtual", "seed": 5}
    assert page.services.shown == [("run", {})]
    assert len(page.unsaved()) == 1  # the copy is not the program's file


def test_a_refused_start_is_told_here(page, qtbot, tmp_path, monkeypatch) -> None:
    opened(page, qtbot, copied(tmp_path, "quick_check"))
    settled(page, qtbot)
    rig = page.services.rig
    monkeypatch.setattr(
        rig, "start_program", lambda *a, **how: rig.refused.emit("A session is running already.")
    )
    page.start.button.click()
    page.start.go.click()
    assert "running already" in page.notice.words.text()
    assert page.services.shown == []
    page.notice.close_notice()
    rig.refused.emit("something else")
    assert page.notice.isHidden()


def test_a_saved_program_is_started_from_its_file(page, qtbot, started, tmp_path) -> None:
    path = copied(tmp_path, "quick_check")
    opened(page, qtbot, path)
    settled(page, qtbot)
    page.start.button.click()
    page.start.go.click()
    assert started == [(path, page.rig_choice.path, {"time": "virtual", "seed": None})]


def test_typing_recomputes_and_errors_hinder_the_start(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "quick_check"))
    settled(page, qtbot)
    repeat = page.editor.head.repeat
    repeat.selectAll()
    qtbot.keyClicks(repeat, "3")
    assert page.figures.count.text() == "18 brakings"
    assert not page.start.button.isEnabled()
    settled(page, qtbot)
    assert page.start.button.isEnabled()
    assert page.forecast.check.n_brakings == 18
    qtbot.keyClicks(repeat, "x")
    assert not page.start.button.isEnabled()
    assert "quick, repeat" in page.start.why.text()
    assert repeat.property("wrong") == "true"
    assert page.fault_list.list.count() == 1
    page.editor.tabs.setCurrentIndex(3)
    page.go_to(page.selected, "pressures_bar")
    assert page.editor.tabs.currentIndex() == 0


def test_limits_of_the_rig_are_told_at_the_field(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "quick_check"))
    table = page.editor.setpoints.lists.pressures.table
    QApplication.clipboard().setText("6\n20\n45")
    table.setCurrentIndex(table.model().index(0, 0))
    table.paste()
    settled(page, qtbot)
    assert "40 bar of the actuator" in page.editor.setpoints.lists.pressures.fault.text()
    assert table.model().faults.keys() == {(2, 0)}
    assert "Cannot be started" in page.start.why.text()
    table.setValue((("", "6"),))
    table.valueChanged.emit(table.value())
    settled(page, qtbot)
    assert page.editor.setpoints.lists.pressures.fault.isHidden()
    assert page.start.button.isEnabled()


def test_undo_and_redo_by_keys_over_the_whole_program(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "squeal_matrix"))
    page.activateWindow()
    before = page.draft.form
    uids = [s.uid for s in before.sequences]
    page.select(uids[0])
    page.program_list.remove.click()
    assert [s.name for s in page.draft.form.sequences] == ["matrix"]
    assert page.services.news
    name = page.editor.head.name
    name.setFocus()
    qtbot.waitUntil(name.hasFocus)
    qtbot.keyClicks(name, "2")
    qtbot.keyClick(name, Qt.Key.Key_Z, CONTROL)
    qtbot.waitUntil(lambda: page.draft.form.sequences[0].name == "matrix")
    assert name.text() == "matrix"
    qtbot.keyClick(name, Qt.Key.Key_Z, CONTROL)
    qtbot.waitUntil(lambda: page.draft.form == before)
    assert page.selected == uids[0]
    assert page.unsaved() == []
    qtbot.keyClick(name, Qt.Key.Key_Y, CONTROL)
    qtbot.waitUntil(lambda: len(page.draft.form.sequences) == 1)


def test_order_of_sequences_enabling_and_copies(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "squeal_matrix"))
    listed = page.program_list
    assert [listed.list.item(k).text().split("\n")[0] for k in range(2)] == ["bedding", "matrix"]
    listed.down.click()
    assert [s.name for s in page.draft.form.sequences] == ["matrix", "bedding"]
    assert listed.current() == page.selected
    assert not listed.down.isEnabled()
    listed.list.item(1).setCheckState(Qt.CheckState.Unchecked)
    assert page.draft.program.count == 225
    assert not page.editor.head.enabled.isChecked()
    listed.duplicate.click()
    assert [s.name for s in page.draft.form.sequences] == ["matrix", "bedding", "bedding 2"]
    page.add_sequence("stop")
    assert page.draft.form.sequences[-1].role == "stop"
    assert page.draft.program is not None


def test_dragging_a_sequence_moves_it(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "squeal_matrix"))
    listed = page.program_list.list
    model = listed.model()
    assert model.moveRow(listed.rootIndex(), 0, listed.rootIndex(), 2)  # what a drop does
    qtbot.waitUntil(lambda: [s.name for s in page.draft.form.sequences] == ["matrix", "bedding"])
    assert listed.count() == 2


def test_a_number_still_being_typed_is_saved_with_the_keys(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "quick_check"))
    page.files.save_as(tmp_path / "mine.toml")
    qtbot.waitUntil(lambda: page.files.path == tmp_path / "mine.toml")
    page.activateWindow()
    table = page.editor.setpoints.lists.pressures.table
    table.setFocus()
    qtbot.waitUntil(table.hasFocus)
    table.setCurrentIndex(table.model().index(3, 0))
    qtbot.keyClicks(table, "9")
    editor = QApplication.focusWidget()
    assert editor is not table
    qtbot.keyClick(editor, Qt.Key.Key_S, CONTROL)
    qtbot.waitUntil(lambda: read_program(tmp_path / "mine.toml").sequences[0].pressures_bar[-1] == 9.0)


def test_a_failed_check_hinders_the_start_and_the_next_change_tries_again(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "quick_check"))
    settled(page, qtbot)
    repeat = page.editor.head.repeat
    qtbot.keyClicks(repeat, "0")
    page.forecaster.ask(None, None)
    page.forecaster.failed.emit("the worker died")
    assert "the worker died" in page.start.why.text()
    assert not page.start.button.isEnabled()
    qtbot.keyClick(repeat, Qt.Key.Key_Backspace)
    settled(page, qtbot)
    assert page.start.button.isEnabled()


def test_saving_over_comments_asks_first(page, qtbot, tmp_path) -> None:
    path = copied(tmp_path, "quick_check")
    text = path.read_text()
    opened(page, qtbot, path)
    page.draft.set_head(description="changed")
    page._show()
    page.files.save()
    assert page.notice.isVisible()
    assert "comments" in page.notice.words.text()
    page.notice.buttons[2].click()
    assert path.read_text() == text
    page.files.save()
    page.notice.buttons[1].click()
    qtbot.waitUntil(lambda: not page.draft.dirty)
    assert read_program(path) == page.draft.program
    page.draft.set_head(description="again")
    page.files.save()  # no comments any more: no question
    qtbot.waitUntil(lambda: not page.draft.dirty)
    assert read_program(path).description == "again"


def test_a_file_changed_by_somebody_else_is_not_overwritten_unasked(page, qtbot, tmp_path) -> None:
    path = copied(tmp_path, "quick_check")
    opened(page, qtbot, path)
    path.write_text(path.read_text() + "\n# mine\n")
    page.draft.set_head(description="changed")
    page.files.save()
    assert "somebody else" in page.notice.words.text()


def test_unsaved_changes_are_asked_about_before_another_program(page, qtbot, tmp_path) -> None:
    first, second = copied(tmp_path, "quick_check"), copied(tmp_path, "dialog_fig5")
    opened(page, qtbot, first)
    page.draft.set_head(description="changed")
    page.files.open(second)
    assert page.notice.isVisible()
    page.notice.buttons[2].click()
    assert page.files.path == first
    page.files.open(second)
    page.notice.buttons[1].click()
    qtbot.waitUntil(lambda: page.files.path == second)
    assert page.draft.program == load_program(second)
    assert page.files.recent() == (second.resolve(), first.resolve())


def test_save_as_and_recent(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "dialog_fig5"))
    target = tmp_path / "mine.toml"
    page.files.save_as(target)
    qtbot.waitUntil(lambda: page.files.path == target)
    assert read_program(target) == page.draft.program
    assert page.files.recent()[0] == target.resolve()
    assert page.bar.file.text() == "mine.toml"


def test_asking_for_a_file_blocks_nothing(page, qtbot) -> None:
    page.begin()
    for ask in (page.files.ask_open, page.files.ask_save_as):
        ask()
        dialogs = page.window().findChildren(QFileDialog)
        assert len(dialogs) == 1
        assert not dialogs[0].isModal()
        dialogs[0].reject()
        qtbot.waitUntil(lambda: not page.window().findChildren(QFileDialog))


def test_what_is_wrong_cannot_be_saved_and_says_so(page, qtbot) -> None:
    page.begin()
    page.draft.set_head(name="")
    page.files.save()
    assert "Not saved" in page.notice.words.text()


def test_broken_files_say_why(page, qtbot, tmp_path) -> None:
    path = tmp_path / "broken.toml"
    path.write_text("name = ")
    page.files.open(path)
    qtbot.waitUntil(page.notice.isVisible)
    assert "Not opened" in page.notice.words.text()
    assert page.files.path is None


def test_a_file_can_be_dropped(page, qtbot, tmp_path) -> None:
    path = copied(tmp_path, "quick_check")
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    event = QDropEvent(
        QPointF(10, 10),
        Qt.DropAction.CopyAction,
        data,
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.NoModifier,
    )
    page.dropEvent(event)
    qtbot.waitUntil(lambda: page.files.path == path)


def test_other_orders_of_the_loops_are_compared_and_taken(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "dialog_fig5"))
    button(page, "compare-orders").click()
    name = "use-speed-pressure-temperature"
    qtbot.waitUntil(lambda: page.editor.findChild(QPushButton, name) is not None, timeout=30_000)
    button(page, name).click()
    assert page.draft.program.sequences[0].loop_order == ("speed", "pressure", "temperature")
    settled(page, qtbot)
    assert page.forecast.check.estimate.total_s > 609


def test_the_preview_follows_the_selected_sequence(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "squeal_matrix"))
    settled(page, qtbot)
    assert page.preview.value().first_index == 1
    page.select(page.draft.form.sequences[1].uid)
    assert page.preview.value().first_index == 31
    assert "braking 31" in page.preview.text_at(float(page.preview.value().spans[0].mean()))
    box = page.preview.plots["pressure"].getViewBox()
    box.sigRangeChangedManually.emit(box.state["mouseEnabled"])
    box.setXRange(0.0, 0.5, padding=0)
    page.editor.valueChanged.emit("repeat", True)
    settled(page, qtbot)
    assert box.viewRange()[0] == pytest.approx([0.0, 0.5])
    page.preview.whole.click()
    assert box.viewRange()[0][1] > 1.0


def test_mouse_over_the_course_reads_it_and_the_wheel_zooms_time_only(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "dialog_fig5"))
    settled(page, qtbot)
    view, box = page.preview.view, page.preview.plots["pressure"].getViewBox()
    place = QPointF(view.width() * 0.6, view.height() * 0.2)
    qtbot.mouseMove(view.viewport(), place.toPoint())
    qtbot.mouseMove(view.viewport(), place.toPoint() + QPoint(2, 2))
    qtbot.waitUntil(lambda: "bar" in page.preview.readout.text())
    (left, right), y_range = box.viewRange()
    wheel = QWheelEvent(
        place,
        view.viewport().mapToGlobal(place),
        QPoint(0, 0),
        QPoint(0, 120),
        Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(view.viewport(), wheel)
    qtbot.waitUntil(page.preview.whole.isVisible)
    zoomed = box.viewRange()
    assert left < zoomed[0][0] < zoomed[0][1] < right
    assert zoomed[1] == y_range
    page.preview.whole.click()
    assert box.viewRange()[0] == pytest.approx([left, right])


def test_a_running_program_hinders_another(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "quick_check"))
    settled(page, qtbot)
    page.services.rig.state = RigState(word=Word.RUNNING, mode="program")
    page.services.rig.stateChanged.emit(page.services.rig.state)
    assert not page.start.button.isEnabled()
    assert "running" in page.start.why.text()


def test_another_rig_has_other_limits(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "quick_check"))
    settled(page, qtbot)
    page.rig_choice.combo.setCurrentIndex(page.rig_choice.combo.count() - 1)
    page.rig_choice.combo.activated.emit(page.rig_choice.combo.currentIndex())
    assert page._current_forecast() is None
    settled(page, qtbot)
    assert page.forecast.rig is page.rig_choice.rig
    again = SequencePage(page.services)
    qtbot.addWidget(again)
    again.activated()
    qtbot.waitUntil(lambda: again.rig_choice.rig is not None)
    assert again.rig_choice.path == page.rig_choice.path


def longest_turn(qtbot, done: Callable[[], bool]) -> float:
    """Longest CPU time of one turn of the event loop until `done`, s; other programs do not count."""
    turns = [0.0]

    def turn() -> bool:
        begin = time.thread_time()
        QApplication.processEvents()
        turns.append(time.thread_time() - begin)
        return done()

    qtbot.waitUntil(turn, timeout=120_000)
    return max(turns)


def test_ten_thousand_brakings_do_not_freeze_the_window(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "dialog_fig5"))
    settled(page, qtbot)
    repeat = page.editor.head.repeat
    repeat.selectAll()
    begin = time.thread_time()
    qtbot.keyClicks(repeat, "400")
    typing = time.thread_time() - begin
    turn = longest_turn(qtbot, lambda: page._current_forecast() is not None)
    assert page.forecast.check.n_brakings == 10_000
    assert typing / 3 < 0.15
    assert turn < 0.15  # 0.03 is usual; walking the brakings here would take 0.5


def test_pages_that_are_not_shown_compute_nothing(page, qtbot, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "quick_check"))
    page.deactivated()
    assert not page.forecaster._timer.isActive()
    page.activated()
    settled(page, qtbot)


def test_looks(page, qtbot, services, tmp_path) -> None:
    opened(page, qtbot, copied(tmp_path, "squeal_matrix"))
    settled(page, qtbot)
    try:
        for name, scale in (("dark", 1.5), ("light", 1.0)):
            services.theme.set(name=name, scale=scale)
            page.grab()
    finally:
        services.theme.set(name="light", scale=1.0)
    assert page.help_text()

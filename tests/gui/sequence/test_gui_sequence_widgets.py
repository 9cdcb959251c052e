"""Widgets of the page: value round trips, hands on sheets and chips, faults at fields."""

from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtWidgets import QApplication, QLineEdit, QWidget

from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from rigctl.gui.pages.sequence.checking import judge
from rigctl.gui.pages.sequence.draft import new_sequence
from rigctl.gui.pages.sequence.editor import SequenceEditor
from rigctl.gui.pages.sequence.forms import form_of, new_uid
from rigctl.gui.pages.sequence.paste import parse_block, parse_list, parse_number
from rigctl.gui.pages.sequence.start_panel import StartChoice, StartPanel
from rigctl.gui.widgets.field_grid import FieldGrid, PlainEdit
from rigctl.gui.widgets.notice import Notice
from rigctl.gui.widgets.order_chips import OrderChips
from rigctl.gui.widgets.range_filler import RangeFiller
from rigctl.gui.widgets.split_bar import SplitBar
from rigctl.gui.widgets.values_table import ValuesTable
from sequences.program import load_program
from sequences.ranges import expand_range

ROOT = Path(__file__).resolve().parents[3]
RIG = load_model(ROOT / "configs/rigs/simulated.toml", RigConfig)
CHANNELS = {name: (c.rate_hz, c.is_sound) for name, c in RIG.capabilities.channels.items()}
FORMS = [
    form for path in sorted((ROOT / "configs/programs").glob("*.toml"))
    for form in form_of(load_program(path)).sequences
]  # fmt: skip


def shown(widget: QWidget, qtbot, size: tuple[int, int] = (700, 600)) -> QWidget:
    qtbot.addWidget(widget)
    widget.resize(*size)
    widget.show()
    qtbot.waitExposed(widget)
    return widget


# -- the sheet ------------------------------------------------------------------------------------------


def sheet(theme, qtbot, *, grouped: bool = False) -> ValuesTable:
    heads = ("t", "n1", "n2") if grouped else ("bar",)
    parse = parse_block if grouped else (lambda text, _columns: [["", cell] for cell in parse_list(text)])
    table = ValuesTable(theme, heads, parse, grouped=grouped)
    shown(table, qtbot, (300, 400))
    table.activateWindow()
    table.setFocus()
    qtbot.waitUntil(table.hasFocus)
    return table


def typed(qtbot, table: ValuesTable, text: str, key: Qt.Key = Qt.Key.Key_Return) -> None:
    """Type into the current cell as a person does: the first key opens it."""
    qtbot.keyClicks(table, text[:1])
    editor = QApplication.focusWidget()
    assert isinstance(editor, QLineEdit)
    qtbot.keyClicks(editor, text[1:])
    qtbot.keyClick(editor, key)
    qtbot.waitUntil(lambda: table.state() != table.State.EditingState)


def test_sheet_round_trip_and_no_signal_for_setting(theme, qtbot) -> None:
    table = sheet(theme, qtbot)
    with qtbot.assertNotEmitted(table.valueChanged):
        table.setValue((("", "5"), ("", "x")))
    assert table.value() == (("", "5"), ("", "x"))
    assert table.model().rowCount() == 3


def test_typing_goes_down_the_list(theme, qtbot) -> None:
    table = sheet(theme, qtbot)
    table.setFocus()
    table.setCurrentIndex(table.model().index(0, 0))
    for text in ("5", "10", "2,5"):
        with qtbot.waitSignal(table.valueChanged):
            typed(qtbot, table, text)
    assert table.value() == (("", "5"), ("", "10"), ("", "2,5"))
    assert table.currentIndex().row() == 3


def test_several_numbers_typed_at_once_fill_several_rows(theme, qtbot) -> None:
    table = sheet(theme, qtbot)
    table.setCurrentIndex(table.model().index(0, 0))
    typed(qtbot, table, "5 10;15")
    assert [row[1] for row in table.value()] == ["5", "10", "15"]


def test_typing_a_row_of_three_goes_to_the_right(theme, qtbot) -> None:
    table = sheet(theme, qtbot, grouped=True)
    table.setCurrentIndex(table.model().index(0, 0))
    for text in ("12", "200", "0"):
        typed(qtbot, table, text, Qt.Key.Key_Tab if text == "12" else Qt.Key.Key_Return)
    assert table.value() == (("", "12", "200", "0"),)
    assert (table.currentIndex().row(), table.currentIndex().column()) == (1, 0)


def test_paste_copy_delete_insert_reverse(theme, qtbot) -> None:
    table = sheet(theme, qtbot)
    QApplication.clipboard().setText("p/bar\n5\n10\n15\n20")
    table.setCurrentIndex(table.model().index(0, 0))
    table.paste()
    assert [row[1] for row in table.value()] == ["5", "10", "15", "20"]
    table.setCurrentIndex(table.model().index(1, 0))
    table.delete_rows()
    assert [row[1] for row in table.value()] == ["5", "15", "20"]
    table.selectAll()
    table.copy()
    assert QApplication.clipboard().text() == "5\n15\n20"
    table.reverse()
    assert [row[1] for row in table.value()] == ["20", "15", "5"]
    table.setCurrentIndex(table.model().index(0, 0))
    table.insert_row()
    assert [row[1] for row in table.value()] == ["20", "20", "15", "5"]
    table.selectAll()
    table.cut()
    assert table.value() == ()


def test_backspace_empties_and_the_row_goes(theme, qtbot) -> None:
    table = sheet(theme, qtbot)
    table.setValue((("", "5"), ("", "10")))
    table.setCurrentIndex(table.model().index(0, 0))
    qtbot.keyClick(table, Qt.Key.Key_Backspace)
    assert table.value() == (("", "10"),)


def test_rows_are_joined_by_plus(theme, qtbot) -> None:
    table = sheet(theme, qtbot, grouped=True)
    table.setValue((("", "2", "200", "200"), ("", "12", "200", "0"), ("", "5", "40", "40")))
    table.setCurrentIndex(table.model().index(1, 0))
    table.toggle_joined()
    assert [row[0] for row in table.value()] == ["", "+", ""]
    head = [table.model().headerData(r, Qt.Orientation.Vertical) for r in range(4)]
    assert head == ["1", "+", "2", "…"]
    table.reverse()
    assert [row[0] for row in table.value()] == ["", "", "+"]
    assert table.value()[1][1] == "2"


def test_wrong_cells_have_the_reason_as_tip(theme, qtbot) -> None:
    table = sheet(theme, qtbot)
    table.setValue((("", "5"), ("", "x")))
    table.set_faults({(1, 0): "no number"})
    assert table.model().index(1, 0).data(Qt.ItemDataRole.ToolTipRole) == "no number"
    table.grab()


def test_a_long_paste_is_bounded(theme, qtbot) -> None:
    table = sheet(theme, qtbot)
    QApplication.clipboard().setText("\n".join(str(k) for k in range(5000)))
    table.setCurrentIndex(table.model().index(0, 0))
    table.paste()
    assert len(table.value()) == 2000


# -- chips, range, small ones ---------------------------------------------------------------------------


def chips(theme, qtbot) -> OrderChips:
    widget = OrderChips(theme, {"a": "Temperature", "b": "Speed", "c": "Pressure"})
    shown(widget, qtbot, (400, 40))
    return widget


def test_chips_by_keyboard(theme, qtbot) -> None:
    widget = chips(theme, qtbot)
    with qtbot.waitSignal(widget.valueChanged):
        qtbot.keyClick(widget, Qt.Key.Key_Right, Qt.KeyboardModifier.ControlModifier)
    assert widget.value() == ("b", "a", "c")
    qtbot.keyClick(widget, Qt.Key.Key_Right)
    qtbot.keyClick(widget, Qt.Key.Key_Left, Qt.KeyboardModifier.ControlModifier)
    assert widget.value() == ("b", "c", "a")
    widget.setValue(("a", "b", "c"))
    assert widget.value() == ("a", "b", "c")


def test_chips_by_mouse(theme, qtbot) -> None:
    widget = chips(theme, qtbot)
    rects = widget.chip_rects()
    begin, end = rects[0].center().toPoint(), rects[2].center().toPoint() + QPoint(20, 0)
    seen: list[tuple] = []
    widget.valueChanged.connect(seen.append)
    qtbot.mousePress(widget, Qt.MouseButton.LeftButton, pos=begin)
    for share in range(1, 21):
        qtbot.mouseMove(widget, begin + (end - begin) * share / 20)
    widget.grab()
    qtbot.mouseRelease(widget, Qt.MouseButton.LeftButton, pos=end)
    assert widget.value() == ("b", "c", "a")
    assert seen == [("b", "c", "a")]


def test_a_click_on_a_chip_changes_nothing(theme, qtbot) -> None:
    widget = chips(theme, qtbot)
    with qtbot.assertNotEmitted(widget.valueChanged):
        qtbot.mouseClick(widget, Qt.MouseButton.LeftButton, pos=widget.chip_rects()[1].center().toPoint())
    assert widget.value() == ("a", "b", "c")


@pytest.mark.parametrize(
    ("start", "stop", "by", "step", "values"),
    [
        ("2", "30", 0, "2", [2.0 * k for k in range(1, 16)]),
        ("2", "30", 1, "15", [2.0 * k for k in range(1, 16)]),
        ("1", "0", 0, "0,5", [1.0, 0.5, 0.0]),
        ("5", "5", 1, "1", [5.0]),
    ],
)
def test_ranges_fill(theme, qtbot, start: str, stop: str, by: int, step: str, values: list[float]) -> None:
    filler = RangeFiller(theme, expand_range, parse_number)
    shown(filler, qtbot, (300, 200))
    filler.by.setCurrentIndex(by)
    for edit, text in ((filler.start, start), (filler.stop, stop), (filler.step, step)):
        qtbot.keyClicks(edit, text)
    with qtbot.waitSignal(filler.filled) as filled:
        qtbot.keyClick(filler.step, Qt.Key.Key_Return)
    assert filled.args == [values, ""]
    assert filler.fault.isHidden()


@pytest.mark.parametrize(
    ("stop", "step", "words"), [("30", "5", "does not land"), ("30", "", "three numbers")]
)
def test_ranges_that_cannot_be_filled_say_why(theme, qtbot, stop: str, step: str, words: str) -> None:
    filler = RangeFiller(theme, expand_range, parse_number, duration=True)
    shown(filler, qtbot, (300, 200))
    filler.start.setText("2")
    filler.stop.setText(stop)
    filler.step.setText(step)
    with qtbot.assertNotEmitted(filler.filled):
        filler.fill.click()
    assert words in filler.fault.text()


def test_undo_keys_are_left_to_the_page(theme, qtbot) -> None:
    edit = PlainEdit()
    shown(edit, qtbot)
    qtbot.keyClicks(edit, "abc")
    qtbot.keyClick(edit, Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    assert edit.selectedText() == "abc"
    edit.setCursorPosition(1)
    edit.setValue("abc")
    assert edit.cursorPosition() == 1


def test_field_grid_shows_and_hides(theme, qtbot) -> None:
    grid = FieldGrid(theme)
    first, second = PlainEdit(), PlainEdit()
    grid.add("a", "&A", first, "bar", "tip a")
    grid.add("b", "B", second, wide=True)
    shown(grid, qtbot)
    grid.set_fault("a", "wrong. Do this.", "error")
    assert first.property("wrong") == "true"
    grid.set_fault("a", "hm", "warning")
    assert first.property("wrong") == "false"
    grid.set_row_visible("a", False)
    assert first.isHidden()
    grid.set_row_enabled("b", False)
    assert not second.isEnabled()
    assert first.toolTip() == "tip a"


def test_notice_asks_once_and_esc_is_the_last_answer(theme, qtbot) -> None:
    notice, said = Notice(theme), []
    shown(notice, qtbot)
    notice.ask("a?", [("yes", lambda: said.append("yes")), ("no", None)])
    notice.ask("b?", [("yes", lambda: said.append("yes b")), ("no", lambda: said.append("no b"))])
    assert [button.text() for button in notice.buttons] == ["yes", "no"]
    qtbot.keyClick(notice.buttons[0], Qt.Key.Key_Escape)
    assert said == ["no b"]
    assert notice.isHidden()


def test_split_bar_round_trip(theme, qtbot) -> None:
    bar = SplitBar(theme)
    shown(bar, qtbot)
    for parts in ((), ((0.0, "muted", False),), ((2.0, "muted", True), (1.0, "field", False))):
        bar.setValue(parts)
        assert bar.value() == parts
        bar.grab()


# -- editor ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("form", FORMS, ids=lambda form: form.name)
def test_editor_round_trip(theme, qtbot, form) -> None:
    editor = SequenceEditor(theme)
    qtbot.addWidget(editor)
    editor.show_rig(RIG)
    with qtbot.assertNotEmitted(editor.valueChanged):
        editor.setValue(form)
    assert editor.value() == form
    other = replace(
        form, uid=new_uid(), temperatures=("x", "1,5"), loop_order=("pressure", "speed", "temperature"),
        function=replace(form.function, kind="steps", steps="1 2"), ventilator=not form.ventilator,
        conditioning=replace(form.conditioning, enabled=not form.conditioning.enabled, drag_speed="90"),
        recording=replace(form.recording, channels=form.recording.channels[::-1], pre=""),
    )  # fmt: skip
    editor.setValue(other)
    assert editor.value() == other


def test_editor_round_trip_with_channels_the_rig_does_not_have(theme, qtbot) -> None:
    form = new_sequence("matrix", {"humidity": (100.0, False), "torque": (4000.0, False)})
    editor = SequenceEditor(theme)
    qtbot.addWidget(editor)
    editor.show_rig(RIG)
    editor.setValue(form)
    assert editor.value() == form
    names = [line.name for line in editor.recording.lines]
    assert names[:2] == ["humidity", "torque"]
    assert "microphone" in names


def test_ticking_a_channel_adds_it_with_a_fitting_decimation(theme, qtbot) -> None:
    form = new_sequence("bedding", CHANNELS)
    editor = SequenceEditor(theme)
    shown(editor, qtbot)
    editor.show_rig(RIG)
    editor.setValue(form)
    sound = next(line for line in editor.recording.lines if line.name == "microphone")
    assert sound.rate.text() == "—"
    with qtbot.waitSignal(editor.valueChanged):
        sound.box.setChecked(True)
    value = editor.value()
    assert {c.name: c.decimation for c in value.recording.channels}["microphone"] == "1"
    editor.setValue(value)
    assert sound.rate.text().replace("\u202f", " ") == "40.00 kHz"
    torque = next(line for line in editor.recording.lines if line.name == "torque")
    assert torque.rate.text().replace("\u202f", " ") == "1000 Hz"


def test_faults_are_at_fields_and_on_tabs(theme, qtbot) -> None:
    form = new_sequence("matrix", CHANNELS)
    form = replace(form, pressures=("5", "x"), recording=replace(form.recording, pre=""))
    editor = SequenceEditor(theme)
    shown(editor, qtbot)
    editor.setValue(form)
    editor.show_faults(list(judge(form).faults))
    texts = [editor.tabs.tabText(k) for k in range(editor.tabs.count())]
    assert texts[0].endswith("✕ 1")
    assert texts[3].endswith("✕ 1")
    assert "✕" not in texts[1] + texts[2]
    assert editor.recording.pre.property("wrong") == "true"
    assert "not a number" in editor.setpoints.lists.pressures.fault.text()
    editor.focus("recording.pre_s")
    assert editor.tabs.currentIndex() == 3
    editor.show_faults([])
    assert editor.recording.pre.property("wrong") == "false"
    assert editor.setpoints.lists.pressures.fault.isHidden()


def test_only_fields_of_the_course_are_shown(theme, qtbot) -> None:
    editor = SequenceEditor(theme)
    shown(editor, qtbot)
    form = new_sequence("matrix", CHANNELS)
    visible = {
        "constant": set(), "ramp": {"amplitude", "direction"}, "sine": {"amplitude", "frequency"},
        "triangle": {"amplitude", "frequency"}, "steps": {"steps"},
    }  # fmt: skip
    section = editor.pressure
    for kind, names in visible.items():
        editor.setValue(replace(form, function=replace(form.function, kind=kind)))
        for name in ("amplitude", "direction", "frequency", "steps"):
            assert getattr(section, name).isHidden() == (name not in names), (kind, name)
        assert len(section.preview.value()) >= 2
    section.show_rig(RIG)
    editor.setValue(replace(form, function=replace(form.function, kind="sine", frequency="x")))
    assert section.preview.value() == []
    assert "No drawing" in section.caption.text()


def test_set_points_stand_above_the_tabs_in_a_tall_window(theme, qtbot) -> None:
    editor = SequenceEditor(theme)
    shown(editor, qtbot, (700, 500))
    assert editor.tabs.count() == 4
    editor.resize(700, 950)
    qtbot.waitUntil(lambda: editor.tabs.count() == 3)
    assert editor.setpoints.isVisible()
    editor.focus("pressures_bar")
    editor.resize(700, 500)
    qtbot.waitUntil(lambda: editor.tabs.count() == 4)
    assert editor.tabs.tabText(0) == "Set-points"


# -- start ----------------------------------------------------------------------------------------------


def test_start_takes_two_clicks_and_a_right_seed(theme, qtbot) -> None:
    panel = StartPanel(theme)
    shown(panel, qtbot)
    panel.show_state("", "6 brakings", simulated=True)
    panel.button.click()
    assert panel.asking
    assert "6 brakings" in panel.words.text()
    qtbot.keyClicks(panel.seed, "7x")
    assert not panel.go.isEnabled()
    assert "whole number" in panel.seed_fault.text()
    qtbot.keyClick(panel.seed, Qt.Key.Key_Backspace)
    panel.time.setCurrentIndex(1)
    with qtbot.waitSignal(panel.started) as started:
        panel.go.click()
    assert started.args == [StartChoice("real", 7)]
    assert not panel.asking


def test_a_hindrance_closes_the_question(theme, qtbot) -> None:
    panel = StartPanel(theme)
    shown(panel, qtbot)
    panel.show_state("", "x", simulated=False)
    assert panel.time.isHidden()
    panel.button.click()
    qtbot.keyClick(panel, Qt.Key.Key_Escape)
    assert not panel.asking
    panel.button.click()
    panel.show_state("why", "x", simulated=False)
    assert not panel.asking
    assert not panel.button.isEnabled()
    assert panel.why.text() == "why"

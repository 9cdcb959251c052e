"""Numbers that are typed: read, refused with the reason; the field shows it and speaks on Enter."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from rigctl.gui.widgets.entries import EntryError, NumberRange, number_in, numbers_in
from rigctl.gui.widgets.trend import Trend
from rigctl.gui.widgets.value_field import ValueField

SPEED = NumberRange(0.0, 800.0, "1/min", what="The speed")
PRESSURE = NumberRange(0.5, 40.0, "bar", 2, or_zero=True, what="The pressure")


def test_range_is_shown_as_at_the_input():
    assert SPEED.text() == "0…800\u202f1/min"
    assert PRESSURE.text() == "0 or 0.5…40\u202fbar"


@pytest.mark.parametrize(("text", "value"), [("100", 100.0), (" 12,5 ", 12.5), ("0", 0.0), ("8e2", 800.0)])
def test_numbers_are_read(text, value):
    assert SPEED.read(text) == value


@pytest.mark.parametrize(
    ("limits", "text", "words"),
    [
        (SPEED, "900", "The speed 900 is above the 800\u202f1/min of this rig. Give 0…800\u202f1/min."),
        (SPEED, "-1", "The speed -1 is below 0\u202f1/min"),
        (SPEED, "fast", "“fast” is not a number"),
        (SPEED, "", "Give a number"),
        (SPEED, "nan", "is not a number"),
        (PRESSURE, "0.2", "The pressure 0.2 is below 0.5\u202fbar. Give 0 or 0.5…40\u202fbar."),
    ],
)
def test_refusals_say_the_reason_and_the_range(limits, text, words):
    with pytest.raises(EntryError) as refused:
        limits.read(text)
    assert words in str(refused.value)


def test_zero_apart_is_taken():
    assert PRESSURE.read("0") == 0.0


def test_hopeless_is_only_what_typing_cannot_mend():
    assert SPEED.hopeless("9000") and SPEED.hopeless("x") and SPEED.hopeless("-3")
    assert not NumberRange(20.0, 500.0, "°C").hopeless("1")  # "100" may follow
    assert not SPEED.hopeless("") and not SPEED.hopeless("-")


def test_lists_of_numbers():
    assert numbers_in("0 5, -2,5; 10") == [0.0, 5.0, -2.5, 10.0]
    assert numbers_in("1 b") is None and numbers_in("  ") is None
    assert number_in("−4") == -4.0


@pytest.fixture
def field(qtbot, theme):
    made = ValueField(theme, SPEED, 100.0)
    made.setObjectName("speed")
    qtbot.addWidget(made)
    made.show()
    return made


def test_field_round_trip(field):
    field.setValue(123.5)
    assert field.value() == 123.5
    assert field.edit.text() == "123.5"


def test_enter_commits_and_says_why_not(field, qtbot):
    field.edit.selectAll()
    with qtbot.waitSignal(field.committed) as sent:
        qtbot.keyClicks(field.edit, "250")
        qtbot.keyClick(field.edit, Qt.Key.Key_Return)
    assert sent.args == [250.0]
    field.edit.selectAll()
    with qtbot.assertNotEmitted(field.committed):
        qtbot.keyClicks(field.edit, "900")
        qtbot.keyClick(field.edit, Qt.Key.Key_Return)
    assert field.value() is None
    assert field.error.isVisible() and "above the 800" in field.error.text()
    assert field.edit.property("wrong") == "true"
    field.setValue(10.0)
    assert not field.error.isVisible() and field.edit.property("wrong") == "false"


def test_half_typed_numbers_are_not_complained_about(qtbot, theme):
    field = ValueField(theme, NumberRange(25.0, 500.0, "°C"), 100.0)
    qtbot.addWidget(field)
    field.show()
    field.edit.selectAll()
    qtbot.keyClicks(field.edit, "1")
    assert not field.error.isVisible()
    qtbot.keyClick(field.edit, Qt.Key.Key_Return)
    assert field.error.isVisible()


def test_set_point_in_force_is_shown_apart(field):
    field.setInForce(100.0)
    assert field.in_force.text() == "▸ 100"
    field.setInForce(None)
    assert field.in_force.text() == ""


def test_other_limits_judge_anew(field):
    field.setValue(700.0)
    field.setLimits(NumberRange(0.0, 300.0, "1/min", what="The speed"))
    assert field.value() is None and "300" in field.limits.text()


def test_an_error_of_the_page_stands_at_the_field(field):
    field.setError("Not at this pressure.")
    assert "Not at this pressure." in field.error.text()
    field.setError("")
    assert not field.error.isVisible()


def test_the_space_bar_is_left_to_the_page(field, qtbot):
    field.edit.setText("10")
    QTest.keyClick(field.edit, Qt.Key.Key_Space)
    assert field.edit.text() == "10"


def test_trend_keeps_peaks_and_forgets_the_old():
    trend = Trend(span_s=60.0, points=60)
    for k in range(1000):
        trend.add(k * 0.1, 50.0 if k == 905 else 1.0)
    points = trend.points()
    assert len(points) <= 61
    assert max(high for _, _, high in points) == 50.0
    assert points[0][0] <= 60.0 and points[-1][0] < 1.0
    trend.add(0.0, 3.0)  # a new session: time begins anew
    assert trend.points() == [(0.0, 3.0, 3.0)]
    trend.add(1.0, float("nan"))
    assert len(trend.points()) == 1

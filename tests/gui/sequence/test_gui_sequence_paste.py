"""Numbers typed and pasted: what is read, and what is refused because it could mean two things."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigctl.gui.pages.sequence.paste import parse_block, parse_list, parse_number, parse_rows, write_number

FINITE = st.floats(allow_nan=False, allow_infinity=False)


@pytest.mark.parametrize(
    ("text", "number"),
    [
        ("12.5", 12.5),
        ("12,5", 12.5),
        (" 7 ", 7.0),
        ("\u22125", -5.0),
        ("1e3", 1000.0),
        (".5", 0.5),
        ("5.", 5.0),
        ("+4", 4.0),
        ("\u00a030\u202f", 30.0),
    ],
)
def test_one_number(text: str, number: float) -> None:
    assert parse_number(text) == number


@pytest.mark.parametrize(
    "text",
    ["", " ", "x", "12 bar", "1.234,5", "1,234.5", "1,2,3", "nan", "inf", "1_000", "0x10", "--1", "5-", "1e"],
)
def test_what_is_no_number_is_refused(text: str) -> None:
    assert parse_number(text) is None


@given(FINITE)
def test_written_numbers_are_read_back_exactly(value: float) -> None:
    read = parse_number(write_number(value))
    assert read == value
    assert math.copysign(1.0, read) == math.copysign(1.0, value)


@pytest.mark.parametrize(
    ("text", "cells"),
    [
        ("5 10 15", ["5", "10", "15"]),
        ("5\n10\r\n15\n", ["5", "10", "15"]),  # a column of a spreadsheet
        ("5\t10\t15", ["5", "10", "15"]),  # a row of it
        ("5;10;15", ["5", "10", "15"]),
        ("5, 10, 15", ["5", "10", "15"]),
        ("5,10,15", ["5", "10", "15"]),
        ("2,5", ["2,5"]),  # one number with a decimal comma
        ("2,5;3,5", ["2,5", "3,5"]),
        ("2,5\n3,5", ["2,5", "3,5"]),
        ("2.5,3.5", ["2.5", "3.5"]),
        ("1.234,5", ["1.234,5"]),  # refused later, not guessed
        ("Pressure [bar]\n5\n10", ["5", "10"]),  # the heading of a column
        ("", []),
        ("\n\t\n;", []),
        ("abc", ["abc"]),
        ("5\t\t10", ["5", "10"]),
        ("5 10;15", ["5", "10", "15"]),
        ("5 bar", ["5", "bar"]),
        ("5 bar;6", ["5 bar", "6"]),
    ],
)
def test_lists(text: str, cells: list[str]) -> None:
    assert parse_list(text) == cells


def test_block_with_segments() -> None:
    text = "t\tn1\tn2\n2\t200\t200\n+\t12\t200\t0\n10\t40\t40"
    assert parse_block(text, 3) == [["", "2", "200", "200"], ["+", "12", "200", "0"], ["", "10", "40", "40"]]
    assert parse_block("+ 12 200 0", 3) == [["+", "12", "200", "0"]]
    assert parse_block("1;2;3;4", 3) == [["", "1", "2", "3"]]


@given(st.lists(FINITE, min_size=1, max_size=20), st.sampled_from(["\n", "\t", ";", " ", "\r\n"]))
def test_lists_joined_by_any_separator_come_back(values: list[float], separator: str) -> None:
    text = separator.join(write_number(value) for value in values)
    assert [parse_number(cell) for cell in parse_list(text)] == values


@given(st.lists(FINITE, min_size=2, max_size=20))
def test_decimal_commas_come_back_from_a_column(values: list[float]) -> None:
    text = "\n".join(write_number(value).replace(".", ",") for value in values)
    assert [parse_number(cell) for cell in parse_list(text)] == values


@given(st.text(max_size=60))
def test_any_text_is_taken_without_an_error(text: str) -> None:
    assert all(isinstance(cell, str) for row in parse_rows(text) for cell in row)
    assert all(len(row) <= 4 for row in parse_block(text, 3))

"""Ranges on the command line."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from rigctl.app.model.ranges import parse_range, parse_search
from rigctl.core.errors import ConfigError

numbers = st.floats(-1e12, 1e12, allow_nan=False)


@given(numbers, numbers, st.integers(2, 300))
def test_a_range_has_its_ends_and_its_count(first: float, last: float, count: int) -> None:
    if first == last:
        return
    name, values = parse_range(f"inner_pad.piston_l.x:{first!r}:{last!r}:{count}")
    assert name == "inner_pad.piston_l.x"
    assert values.shape == (count,)
    assert values[0] == first
    assert values[-1] == last


def test_spaces_are_no_matter_and_a_range_may_fall() -> None:
    name, values = parse_range(" mu : 1 : 0 : 3 ")
    assert name == "mu"
    np.testing.assert_array_equal(values, [1.0, 0.5, 0.0])


def test_a_single_value() -> None:
    assert parse_range("mu:0.4:0.4:1")[1].tolist() == [0.4]


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("mu", "NAME:FROM:TO:COUNT"),
        ("mu:0:1", "NAME:FROM:TO:COUNT"),
        (":0:1:5", "NAME:FROM:TO:COUNT"),
        ("mu:0:1:5:7", "NAME:FROM:TO:COUNT"),
        ("mu:0:1:", "whole number"),
        ("mu:a:1:5", "must be numbers"),
        ("mu:0:inf:5", "finite"),
        ("mu:nan:1:5", "finite"),
        ("mu:0:1:2.5", "whole number"),
        ("mu:0:1:0", "COUNT must be from 1"),
        ("mu:0:1:-3", "COUNT must be from 1"),
        ("mu:0:1:100000000", "COUNT must be from 1"),
        ("mu:0:1:1", "FROM equal to TO"),
        ("mu:1:1:5", "needs an extent"),
    ],
)
def test_what_is_no_range_is_refused_with_an_example(text: str, problem: str) -> None:
    with pytest.raises(ConfigError) as caught:
        parse_range(text, "--x")
    message = str(caught.value)
    assert problem in message
    assert "--x" in message
    assert "mu:0:1:128" in message


def test_names_of_variations_keep_their_colon() -> None:
    name, values = parse_range("piston_position:clockwise:-0.2:0.2:3")
    assert name == "piston_position:clockwise"
    assert values.tolist() == [-0.2, 0.0, 0.2]
    assert parse_search("piston_position:clockwise:0:0.5") == ("piston_position:clockwise", (0.0, 0.5))
    assert parse_search("piston_position:clockwise") == ("piston_position:clockwise", None)


def test_a_search_has_a_range_or_not() -> None:
    assert parse_search(" pressure ") == ("pressure", None)
    assert parse_search("mu:1:0") == ("mu", (1.0, 0.0))


@pytest.mark.parametrize(
    "text", ["", "mu:1", "mu:0:1:5:", ":0:1", "mu:0:inf", "mu:1:1", "mu:", "0:1", "mu:0:1:2"]
)  # fmt: skip
def test_what_is_no_search_is_refused(text: str) -> None:
    with pytest.raises(ConfigError, match="mu:0:1"):
        parse_search(text, "--over")

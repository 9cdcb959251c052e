"""Whatever stands in a program file, reading it ends in a program or in a ValidationError: no traceback."""

from __future__ import annotations

import copy
import datetime
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from sequences import Program

anything = st.recursive(
    st.none()
    | st.booleans()
    | st.integers()
    | st.sampled_from([10**30, -(10**400), 10**400])
    | st.floats()
    | st.text(max_size=5)
    | st.just(datetime.date(2026, 1, 1)),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(["from", "to", "step", "count", "kind", "duration_s", "segments", "name", "x"]),
            inner,
        )
    ),
    max_leaves=6,
)


def _places(value: Any, place: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    if isinstance(value, dict | list):
        for key, entry in value.items() if isinstance(value, dict) else enumerate(value):
            yield (*place, key)
            yield from _places(entry, (*place, key))


def _replaced(data: Any, place: tuple[Any, ...], value: Any) -> Any:
    data = copy.deepcopy(data)
    inner = data
    for key in place[:-1]:
        inner = inner[key]
    inner[place[-1]] = value
    return data


FILE = Path(__file__).parents[3] / "configs" / "programs" / "dialog_fig5.toml"
DATA = tomllib.loads(FILE.read_text())
PLACES = list(_places(DATA))


@given(st.sampled_from(PLACES), anything)
def test_any_value_at_any_place_is_read_or_refused(place: tuple[Any, ...], value: Any) -> None:
    try:
        program = Program.model_validate(_replaced(DATA, place, value))
    except ValidationError as error:
        for fault in error.errors():
            assert fault["msg"]
            assert "remedy" not in fault.get("ctx", {}) or fault["ctx"]["remedy"].endswith(".")
    else:
        assert program.count >= 1
        assert next(program.brakings()).index == 1


@pytest.mark.parametrize(
    "key", [place[-1] for place in PLACES if len(place) == 3 and place[0] == "sequences"]
)
def test_endless_integers_are_refused_at_every_key(key: str) -> None:
    with pytest.raises(ValidationError):
        Program.model_validate(_replaced(DATA, ("sequences", 0, key), 10**400))


def test_the_schema_for_editors_names_the_bounds() -> None:
    definitions = Program.model_json_schema()["$defs"]
    assert definitions["SpeedSegment"]["properties"]["duration_s"]["maximum"] == 3600
    assert definitions["SpeedSegment"]["properties"]["duration_s"]["exclusiveMinimum"] == 0

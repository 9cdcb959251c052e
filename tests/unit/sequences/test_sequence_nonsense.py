"""Nonsense is refused when it is read, with the place, the kind of fault and what to write instead."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from pydantic import ValidationError

from sequences import Program, Sequence

Maker = Callable[..., dict[str, Any]]
ROW = {"duration_s": 10, "start_rpm": 40, "end_rpm": 40}
NAN, INF = math.nan, math.inf


def only_fault(model: type[Program] | type[Sequence], data: Any) -> Any:
    with pytest.raises(ValidationError) as caught:
        model.model_validate(data)
    faults = caught.value.errors()
    assert len(faults) == 1, faults
    return faults[0]


# changes -> type of the fault, last key of its place (None: the sequence as a whole), part of the remedy
REFUSED: list[tuple[dict[str, Any], str, str | int | None, str]] = [
    ({"temperatures_degc": []}, "empty_list", None, "conditioning.enabled = false"),
    ({"speed_profiles": []}, "empty_list", "speed_profiles", "at least one"),
    ({"pressures_bar": []}, "empty_list", "pressures_bar", "at least one"),
    ({"pressures_bar": [NAN]}, "not_finite", 0, "bar"),
    ({"pressures_bar": [5, INF]}, "not_finite", 1, "bar"),
    ({"pressures_bar": [-1]}, "out_of_bounds", 0, "0 or more"),
    ({"pressures_bar": [4000]}, "out_of_bounds", 0, "bar"),
    ({"temperatures_degc": [-274]}, "out_of_bounds", 0, "-273.15"),
    ({"temperatures_degc": [NAN]}, "not_finite", 0, "Celsius"),
    ({"temperatures_degc": [501]}, "set_point_above_limit", None, "lower the temperature"),
    ({"temperatures_degc": [50], "conditioning": {"enabled": False}}, "temperatures_unused", None, "remove"),
    ({"speed_profiles": [{**ROW, "duration_s": 0}]}, "out_of_bounds", "duration_s", "seconds"),
    ({"speed_profiles": [{**ROW, "duration_s": -2}]}, "out_of_bounds", "duration_s", "seconds"),
    ({"speed_profiles": [{**ROW, "duration_s": 1e6}]}, "out_of_bounds", "duration_s", "one hour"),
    ({"speed_profiles": [{**ROW, "start_rpm": NAN}]}, "not_finite", "start_rpm", "1/min"),
    ({"speed_profiles": [{**ROW, "start_rpm": 1e5}]}, "out_of_bounds", "start_rpm", "1/min"),
    ({"speed_profiles": [{"segments": []}]}, "no_segments", 0, "at least one segment"),
    ({"speed_profiles": [[ROW, {**ROW, "start_rpm": 50}]]}, "speed_jump", 0, "ramp between"),
    ({"speed_profiles": [[{**ROW, "duration_s": 3600}, ROW]]}, "profile_too_long", 0, "shorten"),
    (
        {"pressure_function": {"kind": "ramp", "amplitude_bar": 6.0}},
        "negative_pressure",
        None,
        "reduce the amplitude",
    ),
    (
        {"pressure_function": {"kind": "ramp", "amplitude_bar": -1.0}},
        "out_of_bounds",
        "amplitude_bar",
        "0 or more",
    ),
    (
        {"pressure_function": {"kind": "sine", "amplitude_bar": 1.0, "frequency_hz": 0.0}},
        "out_of_bounds",
        "frequency_hz",
        "Hz",
    ),
    ({"pressure_function": {"kind": "constant", "rise_s": 10.0}}, "rise_too_long", None, "shorten rise_s"),
    ({"limits": {"max_degc": 400.0, "cool_down_degc": 480.0}}, "limits_reversed", "limits", "lower one"),
    ({"conditioning": {"tolerance_k": 0}}, "out_of_bounds", "tolerance_k", "kelvin"),
    ({"conditioning": {"soak_s": 60, "timeout_s": 60}}, "soak_exceeds_timeout", "conditioning", "timeout_s"),
    ({"conditioning": {"drag_speed_rpm": 0}}, "drag_without_power", "conditioning", "leave out"),
    ({"recording": {"channels": []}}, "no_channels", "recording", "at least one"),
    ({"recording": {"channels": [{"name": "a"}, {"name": "a"}]}}, "repeated_channel", "recording", "remove"),
    ({"recording": {"channels": [{"name": "a", "decimation": 0}]}}, "out_of_bounds", "decimation", "whole"),
    ({"recording": {"channels": [{"name": "a", "decimation": -4}]}}, "out_of_bounds", "decimation", "whole"),
    ({"recording": {"channels": [{"name": "../a"}]}}, "unsafe_channel", "name", "lower-case"),
    ({"recording": {"sampling_hz": 0, "channels": [{"name": "a"}]}}, "out_of_bounds", "sampling_hz", "40000"),
    ({"loop_order": ["temperature", "temperature", "speed"]}, "loop_order", "loop_order", "outermost first"),
    ({"processing": "lists"}, "unequal_lists", None, 'processing = "loops"'),
    ({"recording": {"pre_s": 3600, "channels": [{"name": "a"}]}}, "out_of_bounds", "pre_s", "0 to 60"),
    ({"repeat": 0}, "out_of_bounds", "repeat", "1 or more"),
    ({"repeat": 20_000}, "too_many_brakings", None, "several programs"),
    ({"dwell_s": -1}, "out_of_bounds", "dwell_s", "0 or more"),
    ({"dwell_s": INF}, "not_finite", "dwell_s", "0 or more"),
    ({"name": "../../etc/passwd"}, "unsafe_name", "name", "letters, digits"),
    ({"name": ".hidden"}, "unsafe_name", "name", "letters, digits"),
    ({"name": "a/b"}, "unsafe_name", "name", "letters, digits"),
    ({"name": "a\\b"}, "unsafe_name", "name", "letters, digits"),
    ({"name": "line\n"}, "unsafe_name", "name", "letters, digits"),
    ({"name": "nul\x00"}, "unsafe_name", "name", "letters, digits"),
    ({"name": "CON.h5"}, "unsafe_name", "name", "operating system"),
    ({"name": "ends."}, "unsafe_name", "name", "not ending"),
    ({"name": ""}, "unsafe_name", "name", "1 to 64"),
    ({"name": "x" * 65}, "unsafe_name", "name", "1 to 64"),
    ({"pressures_bar": {"from": 2, "to": 30}}, "range_keys", "pressures_bar", "step = 2"),
    ({"pressures_bar": {"from": 2, "to": 30, "steps": 2}}, "range_keys", "pressures_bar", "step = 2"),
    ({"pressures_bar": {"from": 2, "to": 30, "step": 0}}, "range_step", "pressures_bar", "magnitude"),
    ({"pressures_bar": {"from": 30, "to": 2, "step": -2}}, "range_step", "pressures_bar", "magnitude"),
    ({"pressures_bar": {"from": 2, "to": 30, "step": 3}}, "range_step", "pressures_bar", "to = 29"),
    ({"pressures_bar": {"from": 2, "to": 30, "step": 1e-9}}, "range_step", "pressures_bar", "larger step"),
    ({"pressures_bar": {"from": 2, "to": INF, "step": 1}}, "range_number", "pressures_bar", "from = 2"),
    ({"pressures_bar": {"from": "2", "to": 30, "step": 1}}, "range_number", "pressures_bar", "from = 2"),
    ({"pressures_bar": {"from": 2, "to": 30, "count": 0}}, "range_count", "pressures_bar", "from = 2"),
    ({"pressures_bar": {"from": 2, "to": 30, "count": 2.5}}, "range_count", "pressures_bar", "from = 2"),
    ({"pressures_bar": {"from": 2, "to": 30, "count": 10**9}}, "range_count", "pressures_bar", "from = 2"),
    ({"pressures_bar": {"from": 2, "to": 30, "count": 1}}, "range_count", "pressures_bar", "count >= 2"),
    ({"speed_profiles": {"from": 2, "to": 30, "step": 2}}, "range_keys", "speed_profiles", "duration_s"),
]


@pytest.mark.parametrize(("changes", "kind", "key", "remedy"), REFUSED, ids=lambda value: str(value)[:60])
def test_refused_with_place_and_remedy(
    sequence_data: Maker, changes: dict[str, Any], kind: str, key: str | int | None, remedy: str
) -> None:
    fault = only_fault(Sequence, sequence_data(**changes))
    assert fault["type"] == kind
    assert (fault["loc"][-1] if fault["loc"] else None) == key
    assert remedy.lower() in fault["ctx"]["remedy"].lower()
    assert "{" not in fault["msg"], "every field of the text is filled"


@pytest.mark.parametrize(
    ("changes", "kind", "place"),
    [
        ({"presures_bar": [5]}, "extra_forbidden", ("presures_bar",)),
        ({"conditioning": {"tolerance": 2}}, "extra_forbidden", ("conditioning", "tolerance")),
        ({"recording": ...}, "missing", ("recording",)),
        ({"pressures_bar": ["12 bar"]}, "float_type", ("pressures_bar", 0)),
        ({"pressures_bar": ["12"]}, "float_type", ("pressures_bar", 0)),
        ({"pressures_bar": [True]}, "float_type", ("pressures_bar", 0)),
        ({"repeat": 1.5}, "int_type", ("repeat",)),
        ({"repeat": True}, "int_type", ("repeat",)),
        ({"role": "squeal"}, "literal_error", ("role",)),
        ({"processing": "random"}, "literal_error", ("processing",)),
        ({"loop_order": ["temperature", "pressure"]}, "missing", ("loop_order", 2)),
        ({"pressure_function": {"kind": "square"}}, "union_tag_invalid", ("pressure_function",)),
        ({"pressures_bar": list(range(1001))}, "too_long", ("pressures_bar",)),
    ],
    ids=lambda value: str(value)[:40],
)
def test_wrong_structure_is_refused_at_its_place(
    sequence_data: Maker, changes: dict[str, Any], kind: str, place: tuple[str | int, ...]
) -> None:
    fault = only_fault(Sequence, sequence_data(**changes))
    assert (fault["type"], fault["loc"]) == (kind, place)


def test_values_of_a_range_are_checked_like_those_of_a_list(sequence_data: Maker) -> None:
    with pytest.raises(ValidationError) as caught:
        Sequence.model_validate(sequence_data(pressures_bar={"from": -2, "to": 2, "count": 5}))
    assert [fault["loc"] for fault in caught.value.errors()] == [("pressures_bar", 0), ("pressures_bar", 1)]


def test_program_without_brakings(sequence_data: Maker) -> None:
    for data in ([], [sequence_data(enabled=False)]):
        fault = only_fault(Program, {"name": "none", "sequences": data})
        assert fault["type"] == "zero_brakings"
        assert "[[sequences]]" in fault["ctx"]["remedy"]


def test_program_with_repeated_names(sequence_data: Maker) -> None:
    data = [sequence_data(name="Matrix"), sequence_data(name="matrix")]
    fault = only_fault(Program, {"name": "twice", "sequences": data})
    assert (fault["type"], fault["ctx"]["value"]) == ("repeated_name", "'matrix'")


def test_program_with_too_many_brakings_in_all(sequence_data: Maker) -> None:
    data = [sequence_data(name=f"s{i}", repeat=10_000) for i in range(2)]
    fault = only_fault(Program, {"name": "long", "sequences": data})
    assert (fault["type"], fault["ctx"]["value"]) == ("too_many_brakings", 120_000)


def test_the_unchanged_sequence_is_valid(sequence_data: Maker) -> None:
    assert Sequence.model_validate(sequence_data()).count == 6

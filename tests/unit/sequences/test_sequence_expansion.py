"""Expansion of sequences and programs to brakings: how many, in which order, and back from JSON and TOML."""

from __future__ import annotations

import itertools
import tomllib
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from sequences import Braking, Program, Sequence, brakings, dump_program
from sequences.braking import AXES, Axis

Maker = Callable[..., dict[str, Any]]


@st.composite
def sequences(draw: st.DrawFn, name: str = "one") -> Sequence:
    """Any valid sequence: list-wise or loop-wise, conditioned or not, with any pressure function."""
    list_wise = draw(st.booleans())
    longest = draw(st.integers(1, 4))
    sizes = [draw(st.sampled_from([1, longest]) if list_wise else st.integers(1, 4)) for _ in range(3)]
    conditioned = draw(st.booleans())
    function = draw(
        st.sampled_from(
            [
                {"kind": "constant"},
                {"kind": "ramp", "amplitude_bar": 4.5, "direction": "falling"},
                {"kind": "sine", "amplitude_bar": 1.25, "frequency_hz": 0.5, "rise_s": 0.5},
                {"kind": "steps", "steps_bar": [0.0, 1.5, -1.5]},
            ]
        )
    )
    temperatures = draw(st.lists(st.floats(-50, 480), min_size=sizes[0], max_size=sizes[0]))
    speeds = draw(st.lists(st.floats(-300, 300), min_size=sizes[1], max_size=sizes[1]))
    durations = draw(st.lists(st.floats(1, 60), min_size=sizes[1], max_size=sizes[1]))
    return Sequence.model_validate(
        {
            "name": name,
            "role": draw(st.sampled_from(["bedding", "matrix", "stop"])),
            "enabled": draw(st.booleans()),
            "repeat": draw(st.integers(1, 3)),
            "temperatures_degc": temperatures if conditioned else [],
            "speed_profiles": [
                {"duration_s": t, "start_rpm": n, "end_rpm": n / 2}
                for t, n in zip(durations, speeds, strict=True)
            ],
            "pressures_bar": draw(st.lists(st.floats(5, 40), min_size=sizes[2], max_size=sizes[2])),
            "loop_order": list(draw(st.permutations(AXES))),
            "processing": "lists" if list_wise else "loops",
            "pressure_function": function,
            "conditioning": {"enabled": conditioned, "tolerance_k": draw(st.floats(0.1, 10))},
            "recording": {"channels": [{"name": "torque", "decimation": draw(st.integers(1, 100))}]},
            "dwell_s": draw(st.floats(0, 100)),
            "ventilator": draw(st.booleans()),
        }
    )


@given(sequences())
def test_count_is_the_number_of_brakings(sequence: Sequence) -> None:
    expanded = list(brakings(sequence, first_index=7))
    assert len(expanded) == sequence.count
    if not sequence.enabled:
        assert not expanded
        return
    sizes = [
        max(1, len(sequence.temperatures_degc)),
        len(sequence.speed_profiles),
        len(sequence.pressures_bar),
    ]
    product = sizes[0] * sizes[1] * sizes[2]
    assert len(expanded) == sequence.repeat * (max(sizes) if sequence.processing == "lists" else product)
    assert [b.index for b in expanded] == list(range(7, 7 + len(expanded)))
    assert [b.index_in_sequence for b in expanded] == list(range(1, 1 + len(expanded)))


@given(sequences())
def test_set_points_are_the_entries_that_the_loop_indices_name(sequence: Sequence) -> None:
    for braking in brakings(sequence):
        assert braking.pressure_bar == sequence.pressures_bar[braking.loop.pressure]
        assert braking.speed_profile == sequence.speed_profiles[braking.loop.speed]
        if sequence.conditioning.enabled:
            assert braking.temperature_degc == sequence.temperatures_degc[braking.loop.temperature]
        else:
            assert braking.temperature_degc is None


@given(sequences())
def test_brakings_survive_json(sequence: Sequence) -> None:
    for braking in itertools.islice(brakings(sequence), 3):
        assert Braking.model_validate_json(braking.model_dump_json()) == braking


@given(sequences("first"), sequences("second"))
def test_programs_survive_toml(first: Sequence, second: Sequence) -> None:
    if not (first.enabled or second.enabled):
        return
    program = Program(name="any", description='line 1\n"line 2" \\ µ', sequences=(first, second))
    again = Program.model_validate(tomllib.loads(dump_program(program)))
    assert again == program
    assert list(again.brakings()) == list(program.brakings())


@pytest.mark.parametrize("order", list(itertools.permutations(AXES)))
def test_outermost_loop_comes_first_in_the_order(sequence_data: Maker, order: tuple[Axis, ...]) -> None:
    data = sequence_data(
        loop_order=list(order), speed_profiles={"from": 20, "to": 80, "count": 4, "duration_s": 5}
    )
    expanded = [b.loop.model_dump() for b in brakings(Sequence.model_validate(data))]
    places = [tuple(loop[axis] for axis in order) for loop in expanded]
    assert places == sorted(places)
    assert len(set(places)) == 2 * 4 * 3


def test_default_order_is_that_of_the_dialog(sequence_data: Maker) -> None:
    sequence = Sequence.model_validate(sequence_data())
    pairs = [(b.temperature_degc, b.pressure_bar) for b in brakings(sequence)]
    assert pairs == [(50, 5), (50, 10), (50, 15), (100, 5), (100, 10), (100, 15)]


def test_lists_go_together_and_single_values_hold_for_all(sequence_data: Maker) -> None:
    data = sequence_data(processing="lists", temperatures_degc=[50, 100, 150], repeat=2)
    expanded = list(brakings(Sequence.model_validate(data)))
    assert [(b.temperature_degc, b.pressure_bar) for b in expanded] == [(50, 5), (100, 10), (150, 15)] * 2
    assert [b.repetition for b in expanded] == [1, 1, 1, 2, 2, 2]


def test_program_numbers_through_and_skips_what_is_off(sequence_data: Maker) -> None:
    program = Program.model_validate(
        {
            "name": "three",
            "sequences": [
                sequence_data(name="a"),
                sequence_data(name="b", enabled=False),
                sequence_data(name="c", repeat=2),
            ],
        }
    )
    expanded = list(program.brakings())
    assert program.count == len(expanded) == 6 + 0 + 12
    assert [b.index for b in expanded] == list(range(1, 19))
    assert [b.sequence for b in expanded] == ["a"] * 6 + ["c"] * 12


def test_a_braking_answers_without_its_sequence(sequence_data: Maker) -> None:
    data = sequence_data(
        pressure_function={"kind": "ramp", "amplitude_bar": 5.0},
        speed_profiles=[{"duration_s": 10, "start_rpm": 200, "end_rpm": 0}],
    )
    braking = next(brakings(Sequence.model_validate(data)))
    assert (braking.duration_s, braking.min_pressure_bar, braking.max_pressure_bar) == (10.0, 0.0, 10.0)
    assert (braking.speed_setpoint_rpm(5.0), braking.pressure_setpoint_bar(5.0)) == (100.0, 5.0)
    assert braking.recording.stored_rate_hz("torque") == 1000.0
    assert braking.recording.stored_rate_hz("microphone") == 40000.0
    with pytest.raises(KeyError):
        braking.recording.stored_rate_hz("pressure")


def test_values_are_frozen(sequence_data: Maker) -> None:
    braking = next(brakings(Sequence.model_validate(sequence_data())))
    with pytest.raises(ValidationError, match="frozen"):
        braking.pressure_bar = 1.0

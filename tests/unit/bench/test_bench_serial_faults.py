"""The byte-level fault seam and the pace of the wire."""

import itertools
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from sim_hardware.bench.serial.faults import FaultSeam
from sim_hardware.bench.serial.line import Line, Pacer

MESSAGE = bytes(range(16, 32))


def _through(seam: FaultSeam, data: bytes = MESSAGE) -> bytes:
    return bytes(value for value, _ in seam.apply(data, "to_host", begins=True))


def test_without_faults_bytes_pass() -> None:
    assert _through(FaultSeam()) == MESSAGE


@given(st.integers(0, 1000), st.lists(st.integers(1, 15), max_size=4))
def test_the_same_bytes_meet_the_same_faults_however_they_are_cut(seed: int, cuts: list[int]) -> None:
    faults = [{"kind": kind, "probability": 0.2} for kind in ("drop", "corrupt", "duplicate")]
    whole, cut = FaultSeam(seed), FaultSeam(seed)
    for fault in faults:
        whole.add(fault)
        cut.add(fault)
    edges = [0, *sorted(cuts), len(MESSAGE)]
    parts = [
        value
        for start, stop in itertools.pairwise(edges)
        for value, _ in cut.apply(MESSAGE[start:stop], "to_host", begins=start == 0)
    ]
    assert bytes(parts) == _through(whole)


def test_position_mask_skip_and_count() -> None:
    seam = FaultSeam()
    seam.add({"kind": "corrupt", "position": 3, "mask": 0xFF, "skip": 1, "count": 1})
    assert _through(seam) == MESSAGE
    assert _through(seam) == MESSAGE[:3] + bytes([MESSAGE[3] ^ 0xFF]) + MESSAGE[4:]
    assert _through(seam) == MESSAGE


def test_messages_are_lost_or_doubled_whole() -> None:
    seam = FaultSeam()
    number = seam.add({"kind": "drop", "per": "message", "count": 1})
    assert [_through(seam), _through(seam)] == [b"", MESSAGE]
    seam.clear(number)
    seam.add({"kind": "duplicate", "per": "message", "count": 1})
    assert _through(seam) == MESSAGE * 2


def test_mute_ends_by_itself_and_keeps_to_its_direction() -> None:
    seam = FaultSeam()
    seam.add({"kind": "mute", "direction": "to_host", "for_s": 1.0}, now_s=10.0)
    assert seam.apply(MESSAGE, "to_host", begins=True, now_s=10.5) == []
    assert len(seam.apply(MESSAGE, "to_device", begins=True, now_s=10.5)) == len(MESSAGE)
    assert len(seam.apply(MESSAGE, "to_host", begins=True, now_s=11.0)) == len(MESSAGE)
    assert seam.describe(11.0) == []


def test_delay_is_before_a_message_and_split_within() -> None:
    seam = FaultSeam()
    seam.add({"kind": "delay", "silence_s": 0.5, "count": 1})
    assert [silence_s for _, silence_s in seam.apply(b"abc", "to_host", begins=True)] == [0.5, 0.0, 0.0]
    seam.add({"kind": "split", "silence_s": 0.1, "position": 2})
    assert [silence_s for _, silence_s in seam.apply(b"abc", "to_host", begins=True)] == [0.0, 0.0, 0.1]


def test_faults_are_json_and_checked() -> None:
    seam = FaultSeam()
    seam.add(json.loads('{"kind": "drop", "probability": 0.5, "count": 2}'))
    assert json.loads(json.dumps(seam.describe()))[0]["kind"] == "drop"
    for wrong in (
        {"kind": "explode"},
        {"kind": "drop", "probability": 2},
        {"kind": "split", "per": "message"},
    ):
        with pytest.raises(ValidationError):
            seam.add(wrong)


@pytest.mark.parametrize(
    ("line", "bits"),
    [
        (Line(baud=9600), 10),
        (Line(baud=9600, parity="E"), 11),
        (Line(baud=9600, data_bits=7, parity="E"), 10),
    ],
)
def test_characters_take_their_time(line: Line, bits: int) -> None:
    pacer = Pacer(line.character_s)
    pieces = pacer.schedule([(value, 0.0) for value in MESSAGE], 100.0)
    assert b"".join(piece.data for piece in pieces) == MESSAGE
    assert pieces[-1].due_s == pytest.approx(100.0 + len(MESSAGE) * bits / 9600)
    (following,) = pacer.schedule([(0, 0.0)], 100.0)
    assert following.due_s == pytest.approx(pieces[-1].due_s + bits / 9600)


@given(st.lists(st.tuples(st.integers(0, 255), st.sampled_from([0.0, 0.0, 0.0, 0.005])), max_size=60))
def test_pacing_keeps_bytes_and_order(characters: list[tuple[int, float]]) -> None:
    pieces = Pacer(Line(baud=115200).character_s).schedule(characters, 5.0)
    assert b"".join(piece.data for piece in pieces) == bytes(value for value, _ in characters)
    times = [time_s for piece in pieces for time_s in (piece.first_s, piece.due_s)]
    assert times == sorted(times)
    assert all(piece.due_s - piece.first_s <= 0.001 for piece in pieces)

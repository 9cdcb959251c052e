"""Decoding of the watchdog's PDOs: every byte string gives a number within its range, or none."""

from __future__ import annotations

import json
import math
import struct
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from drivers.safety_io.decoding import SignalDecoder
from drivers.safety_io.settings import SIGNALS, SIZES, TYPES, SafetyIoSettings, SignalSettings, parse_settings

IO = SafetyIoSettings()
MS = 1_000_000


def test_the_defaults_are_the_nodes_of_the_rig() -> None:
    amplifier = struct.pack("<ii", 38_012, 201_234)  # N·m with 2 digits, bar with 4
    assert SignalDecoder(IO.torque).value_of(amplifier) == pytest.approx(380.12)
    assert SignalDecoder(IO.pressure).value_of(amplifier) == pytest.approx(20.1234)
    assert SignalDecoder(IO.speed).value_of(struct.pack("<Ih", 123, -405)) == pytest.approx(-40.5)
    for current_ua, degc in ((4000, 0.0), (12000, 300.0), (20000, 600.0), (3800, -7.5)):
        assert SignalDecoder(IO.temperature).value_of(struct.pack("<hB", current_ua, 0)) == pytest.approx(
            degc
        )


@pytest.mark.parametrize("current_ua", [0, 3200, 3599, 3700, 3799, 20501, 21001, 21600, 32767, -32768])
def test_a_loop_current_outside_its_range_is_no_temperature(current_ua: int) -> None:
    assert SignalDecoder(IO.temperature).value_of(struct.pack("<hB", current_ua, 0)) is None


@pytest.mark.parametrize("status", range(1, 256))
def test_any_bit_of_the_status_makes_the_value_invalid(status: int) -> None:
    assert SignalDecoder(IO.temperature).value_of(struct.pack("<hB", 12000, status)) is None


@pytest.mark.parametrize("raw", [-0x8000_0000, 0x7FFF_FFFF])
def test_the_ends_of_the_range_are_no_values(raw: int) -> None:
    data = struct.pack("<ii", raw, raw)
    assert SignalDecoder(IO.torque).value_of(data) is None
    assert SignalDecoder(IO.pressure).value_of(data) is None


@given(st.binary(max_size=8), st.sampled_from(SIGNALS))
def test_no_bytes_give_a_wrong_number(data: bytes, name: str) -> None:
    settings = getattr(IO, name)
    value = SignalDecoder(settings).value_of(data)
    if len(data) < settings.length:
        assert value is None
    elif value is not None:
        raw = struct.unpack_from(TYPES[settings.type], data, settings.offset)[0]
        assert value == raw * settings.scale + settings.zero
        assert not settings.current_loop or (3800 <= raw <= 20500 and data[settings.status_offset] == 0)


@given(st.floats(width=32))
def test_floats_are_finite_or_none(number: float) -> None:
    value = SignalDecoder(SignalSettings(0x2A0, 2, "f32", 2.0)).value_of(struct.pack("<Hf", 7, number))
    assert value == 2.0 * number if math.isfinite(number) else value is None


def speed(raw: int) -> bytes:
    return struct.pack("<Ih", 0, raw)


def test_a_reading_is_the_mean_of_its_ten_milliseconds() -> None:
    decoder = SignalDecoder(IO.speed)
    for ms, raw in enumerate((100, 110, 120)):
        decoder.take(speed(raw), ms * MS)
    assert decoder.reading(10 * MS) == pytest.approx(11.0)
    decoder.take(speed(400), 12 * MS)
    assert decoder.reading(20 * MS) == pytest.approx(40.0)


def test_without_a_new_value_the_newest_holds_until_it_is_stale() -> None:
    decoder = SignalDecoder(IO.speed)
    assert decoder.reading(10 * MS) is None  # never seen
    decoder.take(speed(300), 10 * MS)
    assert decoder.reading(20 * MS) == 30.0
    assert decoder.reading(60 * MS) == 30.0
    assert decoder.reading(61 * MS) is None
    decoder.take(speed(310), 70 * MS)
    assert decoder.reading(80 * MS) == 31.0


def test_the_newest_value_decides_whether_a_reading_is_valid() -> None:
    decoder = SignalDecoder(IO.speed)
    decoder.take(speed(300), 1 * MS)
    decoder.take(speed(0x7FFF), 2 * MS)
    assert decoder.reading(10 * MS) is None
    assert decoder.reading(20 * MS) is None
    decoder.take(speed(300), 21 * MS)
    assert decoder.reading(30 * MS) == 30.0
    assert (decoder.frames, decoder.invalid_values) == (3, 1)


def test_short_frames_do_not_keep_a_signal_alive() -> None:
    decoder = SignalDecoder(IO.speed)
    decoder.take(speed(300), 0)
    for ms in range(1, 60):
        decoder.take(speed(300)[:5], ms * MS)
    assert decoder.reading(60 * MS) is None
    assert (decoder.frames, decoder.short_frames) == (1, 59)


def test_settings_survive_json() -> None:
    changed = replace(
        IO,
        node=0x31,
        start_nodes=(1, 2),
        speed=replace(IO.speed, scale=-0.05, stale_s=0.1, type="i32", offset=0),
    )
    for settings in (IO, changed):
        assert parse_settings(json.loads(json.dumps(settings.to_mapping())), "x") == settings


@given(st.sampled_from(sorted(TYPES)), st.integers(0, 7), st.integers(-1, 7))
def test_what_is_accepted_fits_into_a_frame(kind: str, offset: int, status_offset: int) -> None:
    raw = {"type": kind, "offset": offset, "status_offset": status_offset}
    try:
        settings = parse_settings({"speed": raw}, "x").speed
    except Exception as error:
        assert type(error).__name__ == "ConfigError"
        overlaps = offset <= status_offset < offset + SIZES[kind]
        assert offset + SIZES[kind] > 8 or overlaps
    else:
        assert settings.length <= 8

"""Codecs of the serial drives: registers, start sequence, EI-Bisynch; and the shipped maps."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from drivers.dc_drive import bisynch
from drivers.dc_drive.eurotherm_map import TagMap
from drivers.dc_drive.modbus_map import LIMITS, Register, RegisterMap
from drivers.dc_drive.profile import control_word, drive_state
from drivers.dc_drive.words import DriveState, Torque, Wish
from rigctl.config.loading import load_model

CONFIGS = Path(__file__).resolve().parents[3] / "configs" / "devices"
ABB = load_model(CONFIGS / "abb_drives_profile.toml", RegisterMap)
TAGS_590 = load_model(CONFIGS / "eurotherm_590.toml", TagMap)
NAMES = st.text("0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ", min_size=2, max_size=2)


@given(st.sampled_from(sorted(LIMITS)), st.sampled_from(["high_first", "low_first"]), st.data())
def test_registers_carry_every_value(kind: str, words: str, data: st.DataObject) -> None:
    register = Register.model_validate({"number": 400101, "type": kind, "scale": 10.0, "words": words})
    raw = data.draw(st.integers(*LIMITS[kind]))
    encoded = register.encode(raw / 10)
    assert all(0 <= word <= 0xFFFF for word in encoded)
    assert register.decode(encoded) == raw / 10
    assert register.address == 100


@pytest.mark.parametrize(
    ("kind", "value"), [("u16", -1.0), ("u16", 65536.0), ("i16", 32768.0), ("u32", float("nan"))]
)
def test_values_that_do_not_fit(kind: str, value: float) -> None:
    with pytest.raises(ValueError, match="does not fit"):
        Register.model_validate({"number": 400001, "type": kind}).encode(value)


def test_word_order() -> None:
    assert Register(number=400001, type="u32").encode(0x12345678) == [0x1234, 0x5678]
    assert Register(number=400001, type="u32", words="low_first").encode(0x12345678) == [0x5678, 0x1234]


@pytest.mark.parametrize(
    ("status", "last", "expected"),
    [
        (0x0270, 0x0474, 0x0476),  # inhibited
        (0x0230, 0x0476, 0x0476),  # not ready
        (0x0231, 0x0476, 0x0477),  # ready to switch on
        (0x0233, 0x0477, 0x047F),  # ready to run
        (0x0237, 0x047F, 0x047F),  # running
        (0x0238, 0x0476, 0x04F6),  # tripped: reset after a word without it
        (0x0238, 0x04F6, 0x0476),
    ],
)
def test_start_sequence(status: int, last: int, expected: int) -> None:
    wish = Wish(Torque.ON, reset=True)
    assert control_word(wish, status, last, ABB.control_words, ABB.status_bits) == expected


@given(st.integers(0, 0xFFFF), st.integers(0, 0xFFFF))
def test_off_is_off_whatever_the_drive_says(status: int, last: int) -> None:
    assert control_word(Wish(), status, last, ABB.control_words, ABB.status_bits) == 0x0474
    quick = Wish(Torque.QUICK_STOP)
    assert control_word(quick, status, last, ABB.control_words, ABB.status_bits) == 0x047B


@given(st.integers(0, 0xFFFF), st.integers(0, 0xFFFF))
def test_a_trip_is_never_reset_unasked(status: int, last: int) -> None:
    assert control_word(Wish(Torque.ON), status, last, ABB.control_words, ABB.status_bits) != 0x04F6
    if status & 0x08:
        assert drive_state(status, ABB.status_bits) is DriveState.TRIPPED


@given(st.integers(0, bisynch.TAGS - 1))
def test_tags_have_each_their_own_mnemonic(tag: int) -> None:
    name = bisynch.mnemonic(tag)
    assert len(name) == 2
    first, second = name
    if second.isupper():
        assert tag == 936 + 26 * (ord(first) - 97) + ord(second) - 65
    else:
        assert tag == int(first, 36) * 36 + int(second, 36) - 360


def test_golden_frames() -> None:
    assert bisynch.poll_request(0, 1, "22").hex(" ") == "04 30 30 31 31 32 32 05"
    assert bisynch.write_request(0, 1, "ow", ">0207").hex(" ") == (
        "04 30 30 31 31 02 6f 77 3e 30 32 30 37 03 20"
    )  # 6f^77^3e^30^32^30^37^03 = 20
    assert bisynch.parse_poll(bytes.fromhex("02 32 32 34 30 2e 30 03 19"), "22") == "40.0"


def _answer(name: str, text: str) -> bytes:
    body = (name + text).encode() + b"\x03"
    return b"\x02" + body + bytes([bisynch.check(body)])


@given(NAMES, st.integers(-9_999_999, 9_999_999))
def test_numbers_survive(name: str, hundredths: int) -> None:
    text = f"{hundredths / 100:.2f}"
    assert bisynch.parse_number(bisynch.parse_poll(_answer(name, text), name)) == hundredths / 100


@given(NAMES, st.integers(0, 0xFFFF))
def test_words_survive(name: str, word: int) -> None:
    assert bisynch.parse_word(bisynch.parse_poll(_answer(name, bisynch.format_word(word)), name)) == word


@given(st.integers(-99999, 99999), st.integers(0, 200), st.integers(0, 6))
def test_no_single_bit_error_is_accepted(value: int, position: int, bit: int) -> None:
    answer = bytearray(_answer("22", f"{value / 10:.1f}"))
    answer[position % len(answer)] ^= 1 << bit
    with pytest.raises(bisynch.BadAnswer):
        bisynch.parse_poll(bytes(answer), "22")


@given(st.integers(-99999, 99999), st.data())
def test_no_lost_byte_is_accepted(value: int, data: st.DataObject) -> None:
    answer = _answer("22", f"{value / 10:.1f}")
    gone = data.draw(st.integers(0, len(answer) - 1))
    with pytest.raises(bisynch.BadAnswer):
        bisynch.parse_poll(answer[:gone] + answer[gone + 1 :], "22")


@given(st.binary(max_size=30))
def test_garbage_is_no_answer(data: bytes) -> None:
    try:
        text = bisynch.parse_poll(data, "22")
    except bisynch.BadAnswer:
        return
    assert data == _answer("22", text)


@pytest.mark.parametrize("text", ["", ">12", "1e5", "nan", "1.2.3", "--1", "123456", "inf"])
def test_what_is_no_number(text: str) -> None:
    with pytest.raises(bisynch.BadAnswer):
        bisynch.parse_number(text)


def test_shipped_maps_say_what_is_safe() -> None:
    assert [action.value for action in ABB.communication_loss.actions if action.safe] == [1]
    assert ABB.ramps.acceleration.address == 24623
    assert TAGS_590.parameters.acceleration_s.name == "a2"
    assert TAGS_590.parameters.health.name == "0F"


def test_a_map_entry_is_a_tag_or_a_mnemonic() -> None:
    content = TAGS_590.model_dump()
    content["parameters"]["health"] = {"tag": 5, "mnemonic": "0F"}
    with pytest.raises(ValidationError, match="either a tag or a mnemonic"):
        TagMap.model_validate(content)

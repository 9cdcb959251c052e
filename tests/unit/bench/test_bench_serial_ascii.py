"""The emulated 590 and pyrometer: protocols byte by byte."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim_hardware.bench.serial.bisynch_slave import block_check, tag_mnemonic
from sim_hardware.bench.serial.drive590 import Drive590
from sim_hardware.bench.serial.pyrometer import Pyrometer, PyrometerSettings
from sim_hardware.bench.signals import RigSignals


def _drive590() -> tuple[Drive590, RigSignals]:
    signals = RigSignals({"speed_rpm": 40.0})
    signals.set(relay_closed=True)
    return Drive590(signals), signals


def _ask(device: Drive590 | Pyrometer, request: bytes, now_s: float = 1.0) -> bytes:
    device.advance(now_s)
    device.receive(request, now_s, now_s)
    return device.advance(now_s + 0.1)


def _write(name: str, text: str) -> bytes:
    body = f"{name}{text}\x03".encode()
    return b"\x040011\x02" + body + bytes([block_check(body)])


def test_tag_mapping_of_the_manual() -> None:
    assert [tag_mnemonic(tag) for tag in (0, 2, 3, 5, 935, 936, 961, 962)] == [
        "a0", "a2", "a3", "a5", "zz", "aA", "aZ", "bA",
    ]  # fmt: skip
    with pytest.raises(ValueError, match="no tag"):
        tag_mnemonic(936 + 676)


def test_golden_poll_and_write() -> None:
    drive, _ = _drive590()
    assert _ask(drive, bytes.fromhex("04 30 30 31 31 32 32 05")) == bytes.fromhex(
        "02 32 32 34 30 2e 30 03 19"
    )
    assert _ask(drive, b"\x0400110F\x05") == b"\x020F>0200\x03" + bytes([block_check(b"0F>0200\x03")])
    assert _ask(drive, _write("a5", "-2.2")) == b"\x06"
    assert _ask(drive, b"\x040011a5\x05")[3:-2] == b"-2.20"


def test_after_an_answer_nak_repeats_and_ack_goes_on() -> None:
    drive, _ = _drive590()
    first = _ask(drive, b"\x04001109\x05")
    assert _ask(drive, b"\x15") == first
    assert _ask(drive, b"\x06")[1:3] == b"0B"


@pytest.mark.parametrize(
    "request_bytes", [b"\x0400220F\x05", b"\x0401110F\x05", b"\x0400110F", b"0F\x05", b"\x06"]
)
def test_silence_for_others(request_bytes: bytes) -> None:
    assert _ask(_drive590()[0], request_bytes) == b""


@given(st.integers(5, 12), st.integers(0, 6))
def test_no_single_bit_error_in_a_write_is_taken(position: int, bit: int) -> None:
    drive, _ = _drive590()
    request = bytearray(_write("a5", "5.00"))
    request[position] ^= 1 << bit
    assert _ask(drive, bytes(request)) != b"\x06"
    assert drive.poll("a5") == "0.00"


@pytest.mark.parametrize("text", ["", "x", ">12", "1e3", "200.00", "1-2", "nan"])
def test_bad_numbers_are_refused(text: str) -> None:
    assert _ask(_drive590()[0], _write("a5", text)) == b"\x15"


def test_590_start_stop_and_time_out() -> None:
    drive, signals = _drive590()
    for text in (">0206", ">0207"):
        assert _ask(drive, _write("ow", text)) == b"\x06"
    assert _ask(drive, _write("a5", "10.00")) == b"\x06"
    assert signals.get("drive_enabled")
    assert signals.get("speed_set_rpm") == pytest.approx(100.0)
    drive.advance(5.0)
    assert not signals.get("drive_enabled")
    assert int((drive.poll("0F") or ">0")[1:], 16) & 1 << 11


@pytest.mark.parametrize(
    ("request_text", "answer"),
    [("00ms", "02563"), ("98ms", "02563"), ("00em", "1000"), ("00em?", "00501000"), ("00mb", "00000320"),
     ("00xx", "no"), ("00em0001", "no"), ("00em0970", "ok"), ("00ms002", "02563\r02563"), ("00ez", "0")],
)  # fmt: skip
def test_pyrometer_commands(request_text: str, answer: str) -> None:
    pyrometer = Pyrometer(RigSignals({"disc_temperature_degc": 256.3}))
    assert _ask(pyrometer, request_text.encode() + b"\r") == answer.encode() + b"\r"


@pytest.mark.parametrize("request_text", ["01ms", "ms", "", "0", "\xff\xff"])
def test_pyrometer_keeps_silent(request_text: str) -> None:
    assert _ask(Pyrometer(RigSignals()), request_text.encode("latin-1") + b"\r") == b""


def test_pyrometer_errors_instead_of_temperatures() -> None:
    signals = RigSignals({"disc_temperature_degc": 900.0})
    assert _ask(Pyrometer(signals), b"00ms\r") == b"88880\r"
    warming = Pyrometer(RigSignals(), PyrometerSettings(warm_up_s=10.0))
    assert _ask(warming, b"00ms\r") == b"77770\r"
    assert _ask(warming, b"00ms\r", 20.0) == b"00200\r"
    warming.command({"do": "error", "value": 75550})
    assert _ask(warming, b"00ms\r", 21.0) == b"75550\r"


def test_pyrometer_below_zero() -> None:
    cold = Pyrometer(RigSignals({"disc_temperature_degc": -17.0}), PyrometerSettings(low_degc=-50))
    assert _ask(cold, b"00ms\r") == b"-0170\r"


@given(st.binary(max_size=80))
def test_garbage_does_no_harm(data: bytes) -> None:
    drive, signals = _drive590()
    pyrometer = Pyrometer(signals)
    for device in (drive, pyrometer):
        _ask(device, data)
    assert not signals.get("drive_enabled")
    assert _ask(pyrometer, b"\r" + b"00em\r", 3.0)[-1:] == b"\r"

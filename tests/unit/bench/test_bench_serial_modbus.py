"""The emulated ABB drive: frames, registers and profile, alone and with independent masters."""

import shutil
import struct
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pymodbus.client import ModbusSerialClient
from pymodbus.framer.rtu import FramerRTU

from sim_hardware.bench.serial.abb_drive import AbbDrive, AbbDriveSettings
from sim_hardware.bench.serial.bench import AbbDrivePort, SerialSettings, make_ports
from sim_hardware.bench.serial.line import Line
from sim_hardware.bench.serial.modbus_slave import ModbusException, RtuSlave, crc16, seal
from sim_hardware.bench.serial.ports import SerialPort
from sim_hardware.bench.signals import RigSignals

LINE = Line(baud=115200)


class Memory:
    def __init__(self) -> None:
        self.words = [0] * 100

    def read(self, address: int, count: int) -> list[int]:
        if address + count > len(self.words):
            raise ModbusException(2)
        return self.words[address : address + count]

    def write(self, address: int, values: list[int]) -> None:
        if address + len(values) > len(self.words):
            raise ModbusException(2)
        self.words[address : address + len(values)] = values


def _slave(memory: Memory | None = None) -> RtuSlave:
    return RtuSlave(1, memory or Memory(), silence_s=0.00175, response_s=0.0)


def _drive(**parameters: float) -> tuple[AbbDrive, RigSignals]:
    signals = RigSignals()
    signals.set(relay_closed=True)
    named = {key.replace("_", "."): value for key, value in parameters.items()}
    return AbbDrive(signals, LINE, AbbDriveSettings(parameters=named)), signals


@given(st.binary(max_size=64))
def test_crc_is_pymodbus_crc(data: bytes) -> None:
    assert struct.pack("<H", crc16(data)) == struct.pack(">H", FramerRTU.compute_CRC(data))


def test_crc_of_the_specification() -> None:
    assert seal(bytes.fromhex("01 03 00 03 00 01")) == bytes.fromhex("01 03 00 03 00 01 74 0a")


@given(st.binary(max_size=300))
def test_garbage_never_gets_an_answer_without_a_valid_crc(data: bytes) -> None:
    answer = _slave().answer(data)
    valid = 4 <= len(data) <= 256 and struct.unpack("<H", data[-2:])[0] == crc16(data[:-2])
    assert not answer or valid


@given(st.integers(0, 7 * 8 - 1))
def test_every_single_bit_error_is_noticed(bit: int) -> None:
    frame = bytearray(seal(bytes.fromhex("01 03 00 03 00")))
    frame[bit // 8 % len(frame)] ^= 1 << bit % 8
    assert _slave().answer(bytes(frame)) == b""


@given(st.integers(0, 99), st.lists(st.integers(0, 0xFFFF), min_size=1, max_size=123))
def test_write_then_read(address: int, values: list[int]) -> None:
    memory = Memory()
    slave = _slave(memory)
    count = len(values)
    body = struct.pack(">BBHHB", 1, 16, address, count, 2 * count) + struct.pack(f">{count}H", *values)
    answer = slave.answer(seal(body))
    if address + count > 100:
        assert answer == seal(bytes([1, 0x90, 2]))
        assert memory.words == [0] * 100
    else:
        assert answer == seal(struct.pack(">BBHH", 1, 16, address, count))
        read = slave.answer(seal(struct.pack(">BBHH", 1, 3, address, count)))
        assert list(struct.unpack(f">{count}H", read[3:-2])) == values


@pytest.mark.parametrize(
    ("request_hex", "answer_hex"),
    [
        ("01 2b 0e 01 00", "01 ab 01"),  # function unknown
        ("01 03 00 00 00 00", "01 83 03"),  # no registers
        ("01 03 00 00 00 7e", "01 83 03"),  # 126 registers
        ("01 04 00 63 00 02", "01 84 02"),
        ("01 06 00 64 00 00", "01 86 02"),
        ("01 10 00 00 00 02 02 00 00", "01 90 03"),  # byte count wrong
        ("02 03 00 00 00 01", ""),  # another slave
        ("00 06 00 05 12 34", ""),  # broadcast
    ],
)
def test_exceptions(request_hex: str, answer_hex: str) -> None:
    answer = _slave().answer(seal(bytes.fromhex(request_hex)))
    assert answer == (seal(bytes.fromhex(answer_hex)) if answer_hex else b"")


def test_a_silence_within_a_frame_spoils_it() -> None:
    slave = _slave()
    frame = seal(bytes.fromhex("01 03 00 00 00 01"))
    slave.receive(frame[:4], 0.0, 0.0003)
    slave.receive(frame[4:], 0.01, 0.0103)
    assert slave.advance(0.1) == b""
    slave.receive(frame, 0.2, 0.2007)
    assert slave.advance(0.201) == b""  # not before the silence
    assert slave.advance(0.203) == seal(bytes.fromhex("01 03 02 00 00"))


def test_start_sequence_and_inhibit() -> None:
    drive, signals = _drive()
    words = []
    for control in (0x0477, 0x0476, 0x0477, 0x047F):
        drive.write(0, [control, 4000])
        words.append(drive.read(3, 1)[0] & 0x4F)
    assert words == [0x40, 0x01, 0x03, 0x07]  # start with OFF1 set is inhibited
    assert signals.get("drive_enabled")
    assert signals.get("speed_set_rpm") == 200.0
    signals.publish(0, speed_rpm=[200.0])
    drive.write(0, [0x047B])  # OFF3
    assert signals.get("quick_stop")
    drive.write(0, [0x047F])  # cannot be taken back
    assert signals.get("quick_stop")
    assert signals.get("speed_set_rpm") == 0.0
    signals.publish(0, speed_rpm=[0.0])
    drive.advance(1.0)
    assert not signals.get("drive_enabled")
    assert drive.read(3, 1)[0] & 0x40


def test_reset_needs_a_rising_edge() -> None:
    drive, _ = _drive()
    drive.write(0, [0x04F6])
    drive.command({"do": "trip", "code": 0x2310})
    assert drive.read(400, 1) == [0x2310]  # parameter 4.01
    drive.write(0, [0x04F6])
    assert drive.read(3, 1)[0] & 0x08
    drive.write(0, [0x0476])
    drive.write(0, [0x04F6])
    assert not drive.read(3, 1)[0] & 0x08


@pytest.mark.parametrize(
    ("action", "tripped", "turning"), [(0, False, True), (1, True, False), (2, False, True), (5, False, True)]
)
def test_loss_of_communication(action: int, tripped: bool, turning: bool) -> None:
    drive, signals = _drive(**{"58_16": 0.5, "58_14": action})
    drive.advance(0.0)
    for control in (0x0476, 0x0477, 0x047F):
        drive.write(0, [control, 2000])
    drive.advance(0.4)
    assert signals.get("drive_enabled")
    drive.advance(1.0)
    assert bool(drive.read(3, 1)[0] & 0x08) is tripped
    assert bool(signals.get("drive_enabled")) is turning


@given(st.floats(0.1, 1800.0))
def test_ramp_time_in_both_forms(time_s: float) -> None:
    drive, _ = _drive()
    counts = round(time_s * 1000)
    drive.write(24623, [counts >> 16, counts & 0xFFFF])  # 23.12 as 32 bits
    assert drive.read(24623, 2) == [counts >> 16, counts & 0xFFFF]
    assert abs(drive.read(2311, 1)[0] / 10 - time_s) <= 0.0511


def test_parameters_refuse() -> None:
    drive, _ = _drive()
    for address, values, code in ((100, [1], 3), (5813, [9], 3), (5899, [0], 2), (24624, [0, 0], 2)):
        with pytest.raises(ModbusException) as caught:
            drive.write(address, values)
        assert caught.value.code == code


@pytest.fixture
def port(tmp_path: Path) -> Iterator[SerialPort]:
    signals = RigSignals({"speed_rpm": 123.0, "torque_nm": 400.0})
    signals.set(relay_closed=True)
    (made,) = make_ports(SerialSettings(drive=AbbDrivePort()), signals, tmp_path).values()
    with made:
        yield made


def _mbpoll(port: SerialPort, *arguments: str) -> subprocess.CompletedProcess[str]:
    program = shutil.which("mbpoll")
    if program is None:
        pytest.skip("mbpoll is not installed (Debian package mbpoll)")
    common = ["-m", "rtu", "-b", "115200", "-P", "none", "-t", "4", "-1", "-q", "-o", "2"]
    return subprocess.run(
        [program, *common, *arguments], capture_output=True, text=True, timeout=30, check=False
    )


def test_libmodbus_reads_and_writes(port: SerialPort) -> None:
    read = _mbpoll(port, "-a", "1", "-r", "5", "-c", "2", port.address)
    assert read.returncode == 0, read.stderr
    assert [line.split()[-1] for line in read.stdout.splitlines() if line.startswith("[")] == [
        "2460",
        "10000",
    ]
    written = _mbpoll(port, "-a", "1", "-r", "1", port.address, "1142", "4000")  # 0476h, REF1
    assert written.returncode == 0, written.stderr
    assert port.command({"do": "state"})["reference"] == 4000
    assert port.command({"do": "state"})["state"] == "ready to switch on"


def test_libmodbus_sees_exceptions_and_absent_slaves(port: SerialPort) -> None:
    refused = _mbpoll(port, "-a", "1", "-r", "9000", port.address)
    assert refused.returncode != 0
    assert "Illegal data address" in refused.stderr
    assert _mbpoll(port, "-a", "2", "-r", "1", port.address).returncode != 0


def test_pymodbus_reads_and_writes(port: SerialPort) -> None:
    client = ModbusSerialClient(port.address, baudrate=115200, timeout=1.0)
    assert client.connect()
    try:
        assert not client.write_registers(0, [0x0476, 100], device_id=1).isError()
        assert client.read_holding_registers(0, count=2, device_id=1).registers == [0x0476, 100]
        assert client.read_input_registers(4, count=1, device_id=1).registers == [2460]
        assert client.read_holding_registers(9000, count=1, device_id=1).exception_code == 2
    finally:
        client.close()


def test_another_speed_is_noise(port: SerialPort) -> None:
    client = ModbusSerialClient(port.address, baudrate=9600, timeout=0.2, retries=0)
    assert client.connect()
    try:
        client.send(seal(bytes.fromhex("01 03 00 00 00 01")))
        assert client.recv(None) == b""
    finally:
        client.close()
    assert port.command({"do": "counts"})["bytes_at_wrong_speed"] == 8

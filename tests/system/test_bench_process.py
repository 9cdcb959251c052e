"""The bench as a process, from outside: frames and bytes on its wires, command socket, its end by SIGKILL.

Nothing of the project talks to the wires here: CAN frames are raw, Modbus frames are put together by hand.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import struct
import subprocess
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import can
import numpy as np
import pytest
import serial
from bench_rig import START_TIMEOUT_S, BenchProcess, free_port

from rigctl.core.errors import DeviceError

GROUP = "239.74.163.2"


class Host:
    """The controller's side of the bus in raw frames: newest data and counts by identifier, renewal."""

    def __init__(self, port: int) -> None:
        self.bus = can.Bus(interface="udp_multicast", channel=GROUP, port=port, hop_limit=0, fd=False)
        self.newest: dict[int, bytes] = {}
        self.counts: Counter[int] = Counter()
        self.renew: int | None = None  # command of the safety RPDO: 2 closes, 1 renews
        self._counter = 0
        self._stop = threading.Event()
        self._threads = [threading.Thread(target=run) for run in (self._read, self._write)]
        for thread in self._threads:
            thread.start()

    def send(self, cob_id: int, data: bytes) -> None:
        self.bus.send(can.Message(arbitration_id=cob_id, data=data, is_extended_id=False))

    def _read(self) -> None:
        while not self._stop.is_set():
            message = self.bus.recv(0.05)
            if message is not None:
                self.newest[message.arbitration_id] = bytes(message.data)
                self.counts[message.arbitration_id] += 1

    def _write(self) -> None:
        while not self._stop.wait(0.03):
            if self.renew is not None:
                self._counter = (self._counter + 1) & 0xFF
                self.send(0x230, struct.pack("<BBH", self.renew, self._counter, 0))

    def close(self) -> None:
        self._stop.set()
        for thread in self._threads:
            thread.join()
        self.bus.shutdown()

    # what frames say
    def torque_nm(self) -> float:
        return struct.unpack("<ii", self.newest[0x1A0])[0] / 100.0

    def pressure_bar(self) -> float:
        return struct.unpack("<ii", self.newest[0x1A0])[1] / 10_000.0

    def speed_rpm(self) -> float:
        return struct.unpack("<Ih", self.newest[0x1A2])[1] / 10.0

    def position(self) -> int:
        return struct.unpack("<Ih", self.newest[0x1A2])[0]

    def safety_bits(self) -> int:
        return self.newest[0x1B0][0]


def wait_for(condition: Callable[[], bool], what: str, timeout_s: float = 8.0) -> None:
    deadline = time.monotonic() + timeout_s
    while time.monotonic() < deadline:
        with contextlib.suppress(KeyError):  # no such frame yet
            if condition():
                return
        time.sleep(0.01)
    pytest.fail(f"within {timeout_s:g} s: {what}")


def modbus(port: serial.Serial, request: bytes) -> bytes:
    """One RTU request to address 1; returns the answer without address and CRC."""
    frame = b"\x01" + request
    crc = 0xFFFF
    for byte in frame:
        crc ^= byte
        for _ in range(8):
            crc = (crc >> 1) ^ (0xA001 if crc & 1 else 0)
    port.reset_input_buffer()
    port.write(frame + struct.pack("<H", crc))
    answer = port.read(5)
    assert len(answer) == 5, f"the drive does not answer {request.hex()}"
    length = {0x03: answer[2] + 5, 0x10: 8}.get(answer[1], 5)
    return (answer + port.read(length - 5))[1:-2]


class Drive:
    """The controller's side of the drive's line: renews control word and reference as the drive demands."""

    def __init__(self, path: str) -> None:
        self._port = serial.Serial(path, 115200, timeout=0.5)
        self._lock, self._stop = threading.Lock(), threading.Event()
        self._words = (0x0476, 0)
        self._thread = threading.Thread(target=self._renew)
        self._thread.start()

    def __enter__(self) -> Drive:
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join()
        self._port.close()

    def command(self, control: int, reference: int) -> None:
        self._words = (control, reference)
        assert self.ask(struct.pack(">BHHBHH", 0x10, 0, 2, 4, control, reference))[0] == 0x10

    def ask(self, request: bytes) -> bytes:
        with self._lock:
            return modbus(self._port, request)

    def _renew(self) -> None:
        while not self._stop.wait(0.1):
            self.command(*self._words)


@pytest.fixture(scope="module")
def folder() -> Iterator[Path]:
    """Short, for the paths of sockets."""
    with tempfile.TemporaryDirectory(prefix="rb-") as name:
        yield Path(name) / "bench"


@pytest.fixture(scope="module")
def bench(folder: Path) -> Iterator[BenchProcess]:
    process = BenchProcess(folder, free_port()).wait_ready()
    yield process
    if process.process.poll() is None:
        process.end()


@pytest.fixture
def host(bench: BenchProcess) -> Iterator[Host]:
    host = Host(bench.port)
    wait_for(lambda: 0x730 in host.newest and 0x710 in host.newest, "heartbeats of the nodes")
    host.send(0x000, b"\x01\x00")  # NMT: start all
    wait_for(lambda: 0x1B0 in host.newest, "TPDO of the safety I/O")
    host.send(0x230, struct.pack("<BBH", 0, 0, 0))  # open: this counter begins our count
    yield host
    host.close()


def close_relay(host: Host) -> None:
    host.renew = 2
    wait_for(lambda: host.safety_bits() & 1 == 1, "relay closed")
    host.renew = 1


def test_shaft_and_pressure_react_to_raw_frames(bench: BenchProcess, host: Host) -> None:
    close_relay(host)
    with Drive(bench.ready["ports"]["drive"]) as drive:
        drive.command(0x0476, 0)
        drive.command(0x047F, 1200)  # 20000 is 1000 1/min
        host.send(0x231, struct.pack("<h", 0))
        wait_for(lambda: abs(host.speed_rpm() - 60.0) < 1.0, "60 1/min at the encoder")

        before, started = host.position(), time.monotonic()
        counts = host.counts.copy()
        time.sleep(1.0)
        turned, elapsed_s = (host.position() - before) / 4096, time.monotonic() - started
        assert turned / elapsed_s == pytest.approx(1.0, rel=0.1)  # turns in a second
        for cob_id, rate_hz in ((0x1A0, 1000), (0x1A2, 1000), (0x190, 100), (0x1B0, 100)):
            assert (host.counts[cob_id] - counts[cob_id]) / elapsed_s == pytest.approx(rate_hz, rel=0.15)

        idle_nm = host.torque_nm()
        host.send(0x210, struct.pack("<Hh", 0x0007, round(12.0 / 50.0 * 16384)))
        wait_for(lambda: abs(host.pressure_bar() - 12.0) < 1.0, "12 bar at the amplifier")
        wait_for(lambda: host.torque_nm() > idle_nm + 100.0, "torque of the brake")
        answer = drive.ask(struct.pack(">BHH", 0x03, 4, 1))
        assert struct.unpack(">h", answer[2:4])[0] / 20.0 == pytest.approx(60.0, abs=2.0)

        host.renew = None  # nobody renews the relay: it opens, pressure and torque go
        wait_for(lambda: host.safety_bits() & 1 == 0, "relay open", 1.0)
        wait_for(lambda: host.pressure_bar() < 1.0, "line vented")
        wait_for(lambda: host.speed_rpm() < 30.0, "shaft runs down")
    assert bench.status()["plant"]["given_up"] == 0


@pytest.mark.skipif(shutil.which("pulseaudio") is None, reason="PulseAudio is not installed")
@pytest.mark.skipif(shutil.which("parec") is None, reason="parec (pulseaudio-utils) is not installed")
def test_microphone_is_recorded_at_its_rate(bench: BenchProcess) -> None:
    microphone = bench.ready["microphone"]
    rate_hz, wanted_s = microphone["rate_hz"], 1.5
    command = [
        "parec", "--device", microphone["device"], "--format=float32le", f"--rate={rate_hz}", "--channels=1",
        "--raw", "--latency-msec=20",
    ]  # fmt: skip
    recorder = subprocess.Popen(
        command, env={**os.environ, **microphone["environment"]}, stdout=subprocess.PIPE
    )
    assert recorder.stdout is not None
    data = recorder.stdout.read(4)
    started = time.monotonic()
    data += recorder.stdout.read(4 * round(rate_hz * wanted_s))
    elapsed_s = time.monotonic() - started
    assert bench.status()["sound"]["recording"]
    recorder.kill()
    recorder.communicate()
    pressure_pa = np.frombuffer(data, "<f4") * microphone["full_scale_pa"]
    level_db = 20.0 * np.log10(np.std(pressure_pa[rate_hz // 2 :]) / 20e-6)
    assert elapsed_s == pytest.approx(wanted_s, abs=0.25)
    assert 40.0 < level_db < 90.0  # background and ventilator of the plant file
    assert bench.status()["sound"]["lost"] == 0


def test_faults_by_the_command_socket(bench: BenchProcess, host: Host) -> None:
    close_relay(host)

    bench.ask("can", "disturb", node="current_input", wire="broken")
    wait_for(lambda: host.newest[0x1A1] == struct.pack("<hB", 0, 0x05), "wire break in the frames (NE 43)")
    bench.ask("can", "disturb", node="current_input", wire="ok")
    wait_for(lambda: host.newest[0x1A1][2] == 0, "wire mended")

    bench.ask("rig", "estop", pressed=True)
    wait_for(lambda: host.safety_bits() & 0b11 == 0, "e-stop seen, relay open", 1.0)
    bench.ask("rig", "estop", pressed=False)
    bench.ask("rig", "doors", open=True)
    wait_for(lambda: host.safety_bits() & 0b111 == 0b010, "doors open")
    bench.ask("rig", "doors", open=False)

    wait_for(lambda: host.newest.get(0x710) == b"\x05", "regulator operational")
    bench.ask("can", "fault", kind="reboot", node=0x10, outage_ms=100)
    wait_for(lambda: host.newest[0x710] == b"\x7f", "regulator came back pre-operational")

    link = Path(bench.ready["ports"]["drive"])
    bench.ask("drive", "unplug")
    assert not link.is_symlink()
    assert not bench.status()["serial"]["drive"]["plugged"]
    bench.ask("drive", "plug")
    with serial.Serial(str(link), 115200, timeout=0.5) as port:
        assert modbus(port, struct.pack(">BHH", 0x03, 3, 1))[0] == 0x03

    bench.ask("rig", "condition", disc_degc=150.0)
    wait_for(lambda: bench.status()["outputs"]["disc_temperature_degc"] > 120.0, "hot disc")


@pytest.mark.parametrize(
    ("to", "do", "fields", "says"),
    [
        ("nobody", "status", {}, "Targets are"),
        ("rig", "explode", {}, "estop"),
        ("rig", "estop", {"pressed": "yes"}, "neither true nor false"),
        ("rig", "condition", {"disc_degc": 5000}, "900"),
        ("can", "disturb", {"node": "toaster"}, "there is no node"),
        ("drive", "trip", {}, "lacks the field 'code'"),
    ],
)
def test_wrong_commands_are_refused_with_words(
    bench: BenchProcess, to: str, do: str, fields: dict[str, Any], says: str
) -> None:
    with pytest.raises(DeviceError, match=says):
        bench.ask(to, do, **fields)


def test_a_second_bench_is_refused(bench: BenchProcess) -> None:
    same_folder = BenchProcess(bench.folder, free_port())
    same_bus = BenchProcess(bench.folder.with_name("other"), bench.port)
    words = [process.process.communicate(timeout=START_TIMEOUT_S)[1] for process in (same_folder, same_bus)]
    assert f"a bench is running here (process {bench.process.pid})" in words[0]
    assert "is on the bus already" in words[1]
    assert (same_folder.process.returncode, same_bus.process.returncode) == (1, 1)
    assert bench.status()["pid"] == bench.process.pid  # the first goes on


def test_sigkill_leaves_nothing_that_blocks_the_next_start(bench: BenchProcess) -> None:
    """Runs last: it ends the bench of this module."""
    pid_file = bench.folder / "sound" / "pulseaudio.pid"
    sound = int(pid_file.read_text()) if pid_file.exists() else None
    bench.process.kill()
    bench.process.communicate()
    assert (bench.folder / "bench.json").exists()  # left behind, and no obstacle
    with pytest.raises(DeviceError, match="no bench is running here"):
        bench.status()
    if sound is not None:
        wait_for(lambda: not Path(f"/proc/{sound}/exe").exists(), "PulseAudio ends with the bench")

    # the next one, on a machine without PulseAudio: it runs, and says what is missing
    again = BenchProcess(bench.folder, bench.port, path="/nonexistent").wait_ready()
    try:
        assert again.ready["microphone"] == {}
        assert any("PulseAudio is not installed" in note for note in again.ready["notes"])
        assert again.status()["plant"]["steps"] >= 0
        with serial.Serial(again.ready["ports"]["drive"], 115200, timeout=0.5) as port:
            assert modbus(port, struct.pack(">BHH", 0x03, 3, 1))[0] == 0x03
    finally:
        assert again.end() == ""
    assert again.process.returncode == 0
    left = {path.name for path in again.folder.iterdir()}
    assert left <= {"bench.lock", "sound"}
    assert not (again.folder / "sound" / "asound.conf").exists()  # of the bench that was killed

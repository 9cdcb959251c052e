"""What tests of the live acquisition stand on: emulated devices on a virtual bus and a pty, a sound library.

`StandInSound` stands in for sounddevice only where a test needs faults that no sound server makes on demand
(overflow flags, an unplugged device) or where no server can run.
"""

import itertools
import threading
import time
from types import SimpleNamespace

import can
import numpy as np

from rigctl.hal.devices import RigContext
from sim_hardware.bench.can import BenchCan
from sim_hardware.bench.serial.bench import PyrometerPort, SerialSettings, make_ports
from sim_hardware.bench.signals import RigSignals

SPEED_RPM, TORQUE_NM, PRESSURE_BAR, DISC_DEGC = 40.0, 202.0, 10.5, 123.4
_CHANNELS = itertools.count()


class StandInSound:
    """The part of sounddevice that the microphone uses; frames are their own numbers (modulo 1000)."""

    PortAudioError = RuntimeError

    def __init__(self, rate_hz=40_000, actual_hz=None, name="rigmic"):
        self.rate_hz, self.actual_hz, self.name = rate_hz, actual_hz or rate_hz, name
        self.mute = self.overflow = self.unplugged = False
        self.skip = 0
        self.stream = None

    def _terminate(self):
        return

    def _initialize(self):
        return

    def query_hostapis(self):
        return [{"name": "ALSA"}]

    def query_devices(self):
        return [{"name": self.name, "hostapi": 0, "max_input_channels": 2, "default_samplerate": 44_100.0}]

    def check_input_settings(self, **_):
        return

    def InputStream(self, **settings):  # noqa: N802  the library's own name
        self.stream = _StandInStream(self, settings)
        return self.stream


class _StandInStream:
    latency = 0.01

    def __init__(self, sound, settings):
        self.sound, self.settings = sound, settings
        self.samplerate = sound.rate_hz
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self):
        self._thread.start()

    def close(self, ignore_errors=True):
        self._stop.set()
        self._thread.join(2.0)

    def _run(self):
        sound, block, count = self.sound, 200, 0
        begin_s = time.monotonic()
        while not self._stop.is_set():
            if sound.unplugged:
                self.settings["finished_callback"]()
                return
            due_s = begin_s + (count + block) / sound.actual_hz
            time.sleep(max(0.0, due_s - time.monotonic()))
            numbers = np.arange(count, count + block)
            count += block
            if sound.skip > 0:
                sound.skip -= block
                continue
            if not sound.mute:
                frame = ((numbers % 1000) / 32768.0).astype(np.float32)
                data = np.stack([frame] * self.settings["channels"], axis=1)
                status = SimpleNamespace(input_overflow=True) if sound.overflow else None
                self.settings["callback"](data, block, None, status)


class Rig:
    """Emulated nodes and pyrometer, with the disc turning steadily."""

    def __init__(self, folder, *, pyrometer=False):
        self.channel = f"daq-{next(_CHANNELS)}"
        self.signals = RigSignals({
            "torque_nm": TORQUE_NM, "pressure_bar": PRESSURE_BAR, "disc_temperature_degc": DISC_DEGC,
            "speed_rpm": SPEED_RPM,
        })  # fmt: skip
        self._bus = can.Bus(self.channel, interface="virtual")
        self.can = BenchCan(self._bus, self.signals)
        self.can.start()
        self.can.wait_booted()
        self.folder = folder
        self.ports = {}
        if pyrometer:
            self.ports = make_ports(SerialSettings(pyrometer=PyrometerPort()), self.signals, folder)
            for port in self.ports.values():
                port.start()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._turn, daemon=True)
        self._thread.start()

    def _turn(self):
        step_ns = 10_000_000
        end_ns = time.monotonic_ns() // step_ns * step_ns
        while not self._stop.is_set():
            end_ns += step_ns
            ms = np.arange(end_ns // 1_000_000 - 10, end_ns // 1_000_000)
            self.signals.publish(end_ns, position_turns=SPEED_RPM / 60_000.0 * (ms % 100_000_000))
            time.sleep(max(0.0, (end_ns - time.monotonic_ns()) * 1e-9))

    def close(self):
        self._stop.set()
        self._thread.join(2.0)
        for port in self.ports.values():
            port.close()
        self.can.stop()
        self._bus.shutdown()

    def context(self, **changes):
        run_dir = self.folder / f"run{next(_CHANNELS)}"
        run_dir.mkdir()
        context = RigContext(run_dir, "real", None, "rig.toml", self.folder, **changes)
        context.buses = {"main": {"interface": "virtual", "channel": self.channel}}
        return context


CAN_SOURCES = {
    "bridge": {
        "kind": "canopen_analog", "bus": "main", "node": 0x20,
        "channels": {"torque": {"input": 1, "unit": "N·m"}, "pressure": {"input": 2, "unit": "bar"}},
    },
    "shaft": {"kind": "encoder", "bus": "main", "node": 0x22, "steps_per_turn": 4096},
    "loop": {"kind": "current_loop", "bus": "main", "node": 0x21, "at_4ma": 0.0, "at_20ma": 600.0},
}  # fmt: skip
MICROPHONE = {"kind": "sounddevice", "device": "rigmic", "full_scale_pa": 20.0}

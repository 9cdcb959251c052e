"""The microphone on a real sound server: a private PulseAudio with a pipe as source, through PortAudio."""

import fcntl
import os
import threading
import time

import numpy as np
import pytest

from drivers.daq.acquisition import LiveAcquisition
from rigctl.core.errors import DeviceError
from rigctl.hal.devices import Request, RigContext
from sim_hardware.bench import pulse
from sim_hardware.bench.settings import MicrophoneSettings

RECORDING = Request(50_000_000, recording=True)
PERIOD = 30_011  # of the ramp, a prime: a lost or repeated block shows


def _why_not():
    if not pulse.installed():
        return "PulseAudio is not installed (apt-get install pulseaudio libasound2-plugins)"
    try:
        import sounddevice  # noqa: F401
    except OSError as error:
        return f"PortAudio is not installed (apt-get install libportaudio2): {error}"
    return ""


pytestmark = pytest.mark.skipif(bool(_why_not()), reason=_why_not() or "sound works here")


class RampWriter:
    """Writes the ramp at the pace of the clock; the pipe's source has no clock of its own."""

    def __init__(self, pipe, rate_hz):
        self.lost = 0
        self.pause = False
        self._rate_hz = rate_hz
        self._fd = os.open(pipe, os.O_RDWR | os.O_NONBLOCK)
        fcntl.fcntl(self._fd, 1031, 65_536)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        begin_s, count = time.monotonic(), 0
        while not self._stop.wait(0.005):
            due = round((time.monotonic() - begin_s) * self._rate_hz)
            while count + 400 <= due:
                numbers = np.arange(count, count + 400)
                count += 400
                if self.pause:
                    continue
                frames = ((numbers % PERIOD) / 32768.0).astype("<f4").tobytes()
                try:
                    os.write(self._fd, frames)
                except BlockingIOError:  # nobody records
                    self.lost += 400

    def close(self):
        self._stop.set()
        self._thread.join(2.0)
        os.close(self._fd)


@pytest.fixture(params=[40_000, 48_000])
def server(request, tmp_path, monkeypatch):
    for name in ("ALSA_CONFIG_PATH", "PULSE_SERVER"):
        monkeypatch.setenv(name, "")  # restored afterwards: the driver sets them
    monkeypatch.setenv("RIGCTL_BENCH_DIR", str(tmp_path))
    started = pulse.PulseServer(tmp_path, MicrophoneSettings(rate_hz=request.param))
    started.start()
    writer = RampWriter(started.pipe, request.param)
    yield request.param, writer
    writer.close()
    started.stop()


def microphone(tmp_path, rate_hz, **changes):
    run_dir = tmp_path / "run"
    run_dir.mkdir(exist_ok=True)
    settings = {"kind": "sounddevice", "device": "bench:rigmic", "full_scale_pa": 20.0, "rate_hz": rate_hz}
    context = RigContext(run_dir, "real", None, "rig.toml", tmp_path)
    return LiveAcquisition({"sources": {"microphone": settings | changes}}, context)


def test_every_frame_arrives_once_and_unchanged(server, tmp_path):
    rate_hz, _ = server
    device = microphone(tmp_path, rate_hz)
    device.open()
    try:
        blocks = [device.next_block(RECORDING) for _ in range(60)]
        counts = np.concatenate([block.samples("microphone") for block in blocks]).astype(int)
        assert len(counts) == 3 * rate_hz
        assert np.all(np.diff(counts) % PERIOD == 1)
        assert device.identity()["microphone.host_api"] == "ALSA"
        clock = device.clocks()["microphone"]
        assert abs(clock["drift_ppm"]) < 3000  # three seconds on a busy machine
        print(f"{rate_hz} Hz: {clock}, block ready after {1e3 * device.ready_after_s:.1f} ms")
    finally:
        device.close()


def test_a_microphone_that_falls_silent_is_named(server, tmp_path):
    rate_hz, writer = server
    device = microphone(tmp_path, rate_hz)
    device.open()
    try:
        device.next_block(RECORDING)
        writer.pause = True
        deadline = time.monotonic() + 4.0
        with pytest.raises(DeviceError, match=r"sources\.microphone: has delivered no sound"):
            while time.monotonic() < deadline:
                device.next_block(RECORDING)
    finally:
        device.close()


def test_an_unknown_name_lists_what_is_there(server, tmp_path):
    rate_hz, _ = server
    device = microphone(tmp_path, rate_hz, device="bench:nothing")
    with pytest.raises(DeviceError, match=r"sources\.microphone\.device: .*'rigmic' \(ALSA\)"):
        device.open()

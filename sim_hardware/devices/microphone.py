"""The simulated microphone: a process of its own that renders the sound while the rig goes on.

Job: take the course of the slow state block by block, integrate the brake's vibration, write counts into the
sample ring. The sound acts back on nothing, so it may follow some blocks behind; readers wait for it at the
ring. Not its job: the sound itself (`sim_hardware.plant.sound`), lockstep (`sim_hardware.devices.server`).
"""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from rigctl.config.loading import load_model
from rigctl.core.channels import MICROPHONE, ChannelSpec
from rigctl.core.ending import end_process
from rigctl.core.errors import DeviceError, LinkClosed
from rigctl.core.ring import RING_NAME, SampleRing
from rigctl.core.wire import Link, Listener, connect
from sim_hardware.brake_model import load_brake
from sim_hardware.devices.options import add_plant_arguments
from sim_hardware.plant import Plant, PlantSettings, SoundJob, sound_of
from sim_hardware.plant.calibrator import CalibratorOnMicrophone

SOCKET_NAME = "microphone.sock"
MOTION_NAME = "motion"
MOTION_VALUES = 4_000_000  # 8-byte values of slow state that may wait: some minutes of rig time
BATCH = 5  # blocks of virtual time per message: waking another processor costs more than rendering a block
MAX_LAG_S = 6.0  # rig time
START_TIMEOUT_S = 170.0


class SimulatedMicrophone:
    """The rig server's end: submits jobs in the order of the blocks.

    Parameters
    ----------
    run_dir : Path
    ring : SampleRing
        The rig's ring, with the microphone among its channels.
    arguments : list of str
        Brake, plant and seed, as for the rig server.
    batch : int
        Jobs per message.
    """

    def __init__(self, run_dir: Path, ring: SampleRing, arguments: list[str], *, batch: int) -> None:
        self._ring = ring
        self._rate_hz = ring.specs[MICROPHONE].rate_hz
        self._batch = batch
        self._jobs: list[list[Any]] = []
        self._submitted = 0  # samples
        spec = ChannelSpec(MOTION_NAME, "", MOTION_VALUES, "float64")
        self._motion = SampleRing.create(run_dir / MOTION_NAME, [spec], seconds=1.0)
        self._listener = Listener(run_dir / SOCKET_NAME)
        command = [sys.executable, "-m", "sim_hardware.devices.microphone", "--run-dir", str(run_dir)]
        self._process = subprocess.Popen([*command, *arguments], stdin=subprocess.DEVNULL)
        _use_other_processors(self._process.pid)
        self._link: Link | None = None

    @property
    def pid(self) -> int:
        """Its process."""
        return self._process.pid

    def wait_until_ready(self) -> None:
        """Wait until its kernels are compiled.

        Raises
        ------
        DeviceError
            It did not start.
        """
        self._link = self._listener.accept(START_TIMEOUT_S)
        self._listener.close()
        if self._link is None or self._link.recv(START_TIMEOUT_S) is None:
            raise DeviceError("does not start.", place="simulated microphone", remedy="See logs/rig.log.")

    def submit(self, k: int, job: SoundJob, coupler: list[float] | None = None) -> tuple[int, int]:
        """Order the sound of block `k`; returns its range of samples, which the ring will have soon.

        `coupler`: level of a calibrator on the microphone and drift of the microphone, dB.
        """
        track, ticks, drive_on = job
        values = np.ascontiguousarray(track).reshape(-1)
        start, stop = self._motion.write(MOTION_NAME, values)
        self._jobs.append([k, start, stop, len(track), ticks, drive_on, coupler])
        samples = (self._submitted, self._submitted + round(ticks * self._rate_hz / 4000.0))
        self._submitted = samples[1]
        if len(self._jobs) >= self._batch:
            self.flush()
            self._wait_for_the_slow()
        return samples

    def nothing(self) -> tuple[int, int]:
        """Range of samples of a block without sound."""
        return self._submitted, self._submitted

    def flush(self) -> None:
        """Send what has been ordered.

        Raises
        ------
        LinkClosed
            The process has gone.
        """
        if self._jobs and self._link is not None:
            self._link.send({"m": "render", "jobs": self._jobs}, timeout_s=30.0)
            self._jobs = []

    def _wait_for_the_slow(self) -> None:
        """Bound the lag, whatever the machine does."""
        while self._submitted - self._ring.written(MICROPHONE) > MAX_LAG_S * self._rate_hz:
            time.sleep(0.002)
            if self._process.poll() is not None:
                raise LinkClosed("the process has ended", place="simulated microphone")

    def close(self) -> None:
        """Let it finish and end."""
        if self._link is not None:
            with contextlib.suppress(DeviceError):
                self.flush()
            self._link.close()
        self._process.wait()


def _use_other_processors(pid: int) -> None:
    """A rig server bound to one processor (virtual time) leaves the others to its microphone."""
    own = os.sched_getaffinity(0)
    others = set(range(os.cpu_count() or 1)) - own
    if len(own) == 1 and others:
        with contextlib.suppress(OSError):
            os.sched_setaffinity(pid, others)


def main() -> None:
    """Entry of ``python -m sim_hardware.devices.microphone``."""
    parser = argparse.ArgumentParser(prog="simulated microphone", description=__doc__)
    add_plant_arguments(parser)
    options = parser.parse_args()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    link = connect(options.run_dir / SOCKET_NAME, 10.0, "rig server")
    settings, brake = load_model(options.plant, PlantSettings), load_brake(options.brake)
    sound = sound_of(settings, brake, options.seed)
    ring = SampleRing.attach(options.run_dir / RING_NAME, 10.0, writes=True)
    motion = SampleRing.attach(options.run_dir / MOTION_NAME, 10.0)
    Plant(settings, brake, seed=0).compile()
    link.send({"m": "ready"})
    calibrator = CalibratorOnMicrophone(settings.microphone.full_scale_pa)
    last_k = -1
    while True:
        try:
            message = link.recv(None)
        except LinkClosed:
            return
        for k, start, stop, rows, ticks, drive_on, coupler in (message or {}).get("jobs", []):
            if k != last_k + 1:
                sound.forget()
            last_k = k
            track = motion.read(MOTION_NAME, start, stop).reshape(rows, -1)
            counts = sound.render(track, ticks, drive_on)
            ring.write(MICROPHONE, counts if coupler is None else calibrator.heard(counts, *coupler))


if __name__ == "__main__":
    main()
    end_process(0)

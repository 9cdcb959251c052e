"""Whether anything is lost in long runs: 1 kHz CAN signals and the microphone, through the real drivers.

By hand, on an idle machine: ``bench_long_acquisition.py [--minutes 10] [--rate 40000 48000]``. The bench runs
as a process; it writes down every frame of sound that it puts into the sound card. The rig is opened here
with all its real drivers and asked for blocks of 50 ms, as a program does. At the end the sound of the blocks
is held against what the bench wrote, frame by frame; slow signals are counted, numbered by their clocks; the
kernel says whether it dropped frames of the bus, and every sample on the grid is looked at.
"""

from __future__ import annotations

import argparse
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "system"))

from bench_rig import BenchProcess, free_port

from drivers.can.session import can_session
from drivers.daq.microphone import to_counts
from rigctl.app.compose import build_rig, read_rig
from rigctl.core.channels import MICROPHONE
from rigctl.hal.devices import RigContext
from rigctl.hal.priority import CONTROLLER, raise_priority
from sim_hardware.bench.microphone import Microphone
from sim_hardware.bench.process import main as bench_main

WRITTEN = "written.f32"
LEARN = 4096  # frames that are looked for in what was written


class WritingMicrophone(Microphone):
    """Writes down what it has put into the pipe."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self._file = (Path(os.environ["BENCH_LONG_FOLDER"]) / WRITTEN).open("wb")

    def _write(self, data: bytes) -> None:
        before = self._counts.samples
        super()._write(data)
        if self._counts.samples - before != len(data) // self._frame_bytes:
            data = data[:-4] + np.float32(np.nan).tobytes()  # not all went in: what came cannot be equal
        self._file.write(data)
        self._file.flush()


def serve() -> None:
    """The bench's process."""
    import sim_hardware.bench.microphone

    sim_hardware.bench.microphone.Microphone = WritingMicrophone
    bench_main()


def measure(rate_hz: int, minutes: float) -> bool:
    """One run; whether nothing was lost."""
    folder = Path(tempfile.mkdtemp(prefix="rl-"))
    os.environ["BENCH_LONG_FOLDER"] = str(folder)
    bench = BenchProcess(
        folder / "bench", free_port(), rate_hz=rate_hz, command=(str(Path(__file__).resolve()), "--serve")
    ).wait_ready()
    try:
        rig_path = bench.rig_file(folder / "rig.toml")
        os.environ["RIGCTL_BENCH_DIR"] = str(bench.folder)
        config = read_rig(rig_path)
        context = RigContext(folder, "real", None, "bench_long", rig_path.parent, buses=config.buses)
        sound_path, holes, late = folder / "sound.i16", dict[str, int](), list[float]()
        with build_rig(config, context) as rig, sound_path.open("wb") as sound:
            acquisition: Any = rig.acquisition
            granted = raise_priority([os.getpid()], CONTROLLER)  # as the controller's process does
            statistics = can_session(context, "main").statistics
            for block in rig.blocks():
                if block.k == 0:
                    received, before = statistics.received, acquisition.clocks()
                    cpu_s, start_s = time.process_time(), time.monotonic()
                late.append(acquisition.ready_after_s)
                for name in block.ranges:
                    values = block.samples(name)
                    if name == MICROPHONE:
                        sound.write(values.tobytes())
                    elif bad := int(np.count_nonzero(np.isnan(values))):
                        holes[name] = holes.get(name, 0) + bad
                if time.monotonic() - start_s > 60.0 * minutes:
                    break
            lived_s = time.monotonic() - start_s
            cpu = (time.process_time() - cpu_s) / lived_s
            clocks, blocks = acquisition.clocks(), block.k + 1
            received = statistics.received - received
        status = bench.status()["sound"]
        got = np.fromfile(sound_path, np.int16)
        written = to_counts(np.fromfile(folder / WRITTEN, np.float32))
        missing = compare(got, written)
        print(f"\n{rate_hz} Hz for {lived_s:.1f} s: {blocks} blocks of 50 ms")
        print(f"  this process: {cpu:.3f} cores, priority {granted}; load average {os.getloadavg()[1]:.1f}")
        print(f"  microphone  {len(got)} frames, {missing}")
        print(f"              the bench could not write {status['lost']}, took back {status['unread']}")
        lost = 0
        for name, state in clocks.items():
            if state.get("master"):
                print(f"  {name:11} clock: drift {state['drift_ppm']} ppm, jitter {state['jitter_ms']} ms")
                continue
            samples = state["samples"] - before[name]["samples"]
            lost += state["lost"] + state["late"] + state["doubled"]
            counts = ", ".join(f"{key} {state[key]}" for key in ("lost", "late", "doubled"))
            print(f"  {name:11} {samples} samples ({samples / lived_s:.3f}/s), {counts}")
            print(f"              drift {state['drift_ppm']} ppm, jitter {state['jitter_ms']} ms")
        print(f"  invalid samples on the grid of the blocks: {holes or 'none'}")
        print(f"  bus: {received} frames, {statistics.overrun} dropped by the kernel, "
              f"{statistics.malformed} malformed")  # fmt: skip
        p50, p99, top = 1e3 * np.quantile(late, [0.5, 0.99, 1.0])
        print(f"  block delivered after its end: p50 {p50:.1f}  p99 {p99:.1f}  max {top:.1f} ms", flush=True)
        return missing.startswith("0 ") and not (lost or holes or statistics.overrun)
    finally:
        bench.end()
        shutil.rmtree(folder)


def compare(got: NDArray[np.int16], written: NDArray[np.int16]) -> str:
    """Where what came is found in what was written, and whether all of it follows without a gap."""
    pattern = got[:LEARN]
    candidates = np.flatnonzero(written[: len(written) - LEARN] == pattern[0])
    starts = [at for at in candidates if np.array_equal(written[at : at + LEARN], pattern)]
    if len(starts) != 1:
        return f"the beginning is found {len(starts)} times in what the bench wrote"
    same = got == written[starts[0] : starts[0] + len(got)]
    if same.all():
        return "0 lost: all equal to what the bench wrote, frame by frame"
    return f"differs from what the bench wrote from frame {int(np.argmin(same))} on"


def main() -> None:
    """All rates; the exit code says whether anything was lost."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--rate", type=int, nargs="+", default=[40_000, 48_000])
    options = parser.parse_args()
    print(f"load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors", flush=True)
    sys.exit(0 if all([measure(rate, options.minutes) for rate in options.rate]) else 1)


if __name__ == "__main__":
    if "--serve" in sys.argv:
        sys.argv.remove("--serve")
        serve()
    else:
        main()

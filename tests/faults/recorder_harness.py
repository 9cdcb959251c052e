"""A controller and a data acquisition in miniature, to drive the recorder process in the fault tests.

The rig's part (ring, blocks) is played by the tests; recorder, client, spool and files are the product.
"""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import forkserver
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "unit" / "recording"))

from recording_samples import BLOCK_S, SPECS, signals, specification

from rigctl.core.blocks import Block
from rigctl.core.ring import SampleRing
from rigctl.recording.__main__ import main
from rigctl.recording.client import RecorderClient

BLOCK_NS = round(BLOCK_S * 1e9)


class MiniRig:
    """Writes made-up samples into a ring and hands out blocks of 50 ms."""

    def __init__(self, run_dir: Path, seconds: float = 16.0) -> None:
        self.ring = SampleRing.create(run_dir / "ring", SPECS, seconds)
        self.k = 0

    def blocks(self, data: dict[str, np.ndarray]) -> Iterator[Block]:
        """Deliver `data` block by block."""
        for i in range(round(len(data["torque"]) / 4000 / BLOCK_S)):
            ranges = {}
            for spec in SPECS:
                n = round(spec.rate_hz * BLOCK_S)
                ranges[spec.name] = self.ring.write(spec.name, data[spec.name][i * n : (i + 1) * n])
            yield Block(self.k, self.k * BLOCK_NS, BLOCK_NS, ranges, self.ring)
            self.k += 1

    def record(self, client: RecorderClient, index: int, seconds: float, **end: Any) -> dict[str, np.ndarray]:
        """One whole braking; returns its samples."""
        data = signals(seconds, seed=index)
        client.begin(specification(index), t0_s=self.k * BLOCK_S)
        for block in self.blocks(data):
            client.block(block)
        client.end(**end)
        return data


@contextmanager
def run_dir() -> Iterator[Path]:
    """A private folder with a short path, as the supervisor makes it."""
    with tempfile.TemporaryDirectory(
        prefix="rec", dir="/dev/shm" if os.path.isdir("/dev/shm") else None
    ) as name:
        yield Path(name)


def start_recorder(run: Path, campaign: Path, *options: str) -> subprocess.Popen[bytes]:
    """The real process."""
    command = [sys.executable, "-m", "rigctl.recording", "--run-dir", str(run), "--campaign", str(campaign)]
    return subprocess.Popen([*command, *options])


def _main(arguments: list[str]) -> None:
    sys.exit(main(arguments))


def forked_recorder(run: Path, campaign: Path, min_free_mb: float = 1.0) -> multiprocessing.Process:
    """The same process, forked from a server that has everything loaded: many quick runs become possible."""
    context = multiprocessing.get_context("forkserver")
    context.set_forkserver_preload(["recorder_warm"])
    paths = os.environ.get("PYTHONPATH")
    os.environ["PYTHONPATH"] = os.pathsep.join(path for path in sys.path if path)  # Python 3.11 forgets it
    try:
        forkserver.ensure_running()
    finally:
        os.environ.pop("PYTHONPATH") if paths is None else os.environ.update(PYTHONPATH=paths)
    arguments = ["--run-dir", str(run), "--campaign", str(campaign), "--min-free-mb", str(min_free_mb)]
    process = context.Process(target=_main, args=(arguments,), daemon=True)
    process.start()
    return process  # type: ignore[return-value]

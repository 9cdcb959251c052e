"""What recording costs, measured against a plain h5py write of the same samples in the same run.

Run by hand: `python tests/benchmarks/bench_recording.py [repeats]`. Prints medians and their standard errors;
CPU time of this thread for computing, wall time for what waits for the disk. Asserts nothing.
"""

from __future__ import annotations

import hashlib
import os
import socket
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "unit" / "recording"))

import h5py
from recording_samples import BLOCK_S, SPECS, header, no_evaluation, signals, specification, write_spool

from rigctl.core.blocks import Block
from rigctl.core.ring import SampleRing
from rigctl.core.wire import Link
from rigctl.recording.braking import StoredBraking, assemble
from rigctl.recording.braking_file import file_image, read_summary, verify
from rigctl.recording.client import MERGED_NS, RecorderClient
from rigctl.recording.durable import write_part
from rigctl.recording.evaluation import evaluate_braking
from rigctl.recording.spool import SpoolWriter
from rigctl.recording.spool_reader import read_spool

SECONDS = 13.0  # a braking of 12 s with half a second before and after
MESSAGE_S = MERGED_NS * 1e-9  # what the controller passes on at a time


def measure(
    name: str, action: Callable[[], Any], repeats: int, clock: Callable[[], float] = time.thread_time
) -> float:
    """Print median and standard error of `action` in ms; returns the median."""
    action()
    values = []
    for _ in range(repeats):
        start = clock()
        action()
        values.append((clock() - start) * 1e3)
    median = statistics.median(values)
    error = 1.25 * statistics.stdev(values) / len(values) ** 0.5
    print(f"  {name:<44} {median:8.2f} +- {error:.2f} ms")
    return median


def plain_h5py(path: Path, braking: StoredBraking, fill: bool) -> None:
    """The same samples the plain way: one file, high-level calls, gzip 4 and shuffle."""
    path.unlink(missing_ok=True)
    with h5py.File(path, "w") as file:
        for name, channel in braking.channels.items():
            data = channel.data
            group = file.create_group(f"entry/{name}")
            options: dict[str, Any] = (
                {"compression": "gzip", "compression_opts": 4, "shuffle": True} if fill else {}
            )
            group.create_dataset("value", data=data.samples, **options)
            group.create_dataset("time", data=data.time_s(), **options)
            for key in ("signal", "axes", "NX_class", "title"):
                group.attrs[key] = name
        for key, value in braking.outcome.results.items():
            file[f"entry/results/{key}"] = float("nan") if value is None else value


def finalise(folder: Path, repeats: int) -> None:
    data = write_spool(folder / "s", SECONDS, block_s=MESSAGE_S)
    print(f"one braking of {SECONDS:g} s: {sum(a.nbytes for a in data.values()) / 1e6:.2f} MB as acquired")
    spool = read_spool(folder / "s")
    braking = assemble(spool, evaluate_braking)
    image = file_image(braking)
    part = folder / "f.part"
    total = measure("read the spool, all CRCs", lambda: read_spool(folder / "s"), repeats)
    total += measure("decimate four channels", lambda: assemble(spool, no_evaluation), repeats)
    total += measure("build the file in memory", lambda: file_image(braking), repeats)
    total += measure("write and hash it", lambda: (write_part(part, image), hashlib.sha256(image)), repeats)
    total += measure("re-open, compare all samples", lambda: verify(part, braking), repeats)
    print(f"  {'finalise in all, CPU':<44} {total:8.2f} ms")
    measure(
        "(evaluation)",
        lambda: evaluate_braking({n: c.data for n, c in braking.channels.items()}, {}),
        repeats,
    )
    compressed = measure("plain h5py, gzip 4", lambda: plain_h5py(folder / "p.h5", braking, True), repeats)
    raw = measure("plain h5py, not compressed", lambda: plain_h5py(folder / "r.h5", braking, False), repeats)
    print(f"  finalise / plain h5py: {total / compressed:.2f} compressed, {total / raw:.2f} not compressed")
    sizes = len(image), (folder / "p.h5").stat().st_size, (folder / "r.h5").stat().st_size
    print(f"  bytes: {sizes[0]}, plain gzip 4 {sizes[1]}, not compressed {sizes[2]}")
    print(f"  225 files: {225 * sizes[0] / 1e6:.0f} MB")
    measure("read_summary", lambda: read_summary(part), repeats)


def spooling(folder: Path, repeats: int) -> None:
    data, path = signals(SECONDS), folder / "throughput"
    blocks = []
    for k in range(round(SECONDS / MESSAGE_S)):
        sizes = [(number, spec.name, round(spec.rate_hz * MESSAGE_S)) for number, spec in enumerate(SPECS)]
        blocks.append([(number, k * n, data[name][k * n : (k + 1) * n]) for number, name, n in sizes])
    size = sum(array.nbytes for array in data.values())

    def write() -> None:
        path.unlink(missing_ok=True)
        writer = SpoolWriter.create(path, SPECS, header(specification()))
        for number, parts in enumerate(blocks):
            writer.append(parts, number * MESSAGE_S)
            writer.sync_if_due()
        writer.end("complete", "")
        writer.close()

    print("spool")
    median = measure("a whole braking, wall time", write, repeats, time.perf_counter)
    print(f"  {size / median / 1e3:.0f} MB/s, {1e3 * median / len(blocks):.0f} us a message of 250 ms")


def controller(folder: Path, repeats: int) -> None:
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    reader = os.fork()
    if reader == 0:  # a process of its own, as the recorder is
        ours.close()
        while theirs.recv(65536):
            pass
        os._exit(0)
    theirs.close()
    ring = SampleRing.create(folder / "ring", SPECS, 1.0)
    client = RecorderClient(Link(ours, "bench"), window_s=1e9)
    client.begin(specification(), t0_s=0.0)
    sizes = {spec.name: round(spec.rate_hz * BLOCK_S) for spec in SPECS}
    dt_ns = round(BLOCK_S * 1e9)
    blocks = [
        Block(k, k * dt_ns, dt_ns, {name: (k * n, (k + 1) * n) for name, n in sizes.items()}, ring)
        for k in range(20_000, 21_000)
    ]
    print("controller")
    median = measure(
        "1000 x RecorderClient.block, CPU", lambda: [client.block(block) for block in blocks], repeats
    )
    print(f"  {median:.1f} us a block")
    client.close()
    os.waitpid(reader, 0)


if __name__ == "__main__":
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 20
    with tempfile.TemporaryDirectory() as name:
        spooling(Path(name), count)
        controller(Path(name), count)
        finalise(Path(name), count)

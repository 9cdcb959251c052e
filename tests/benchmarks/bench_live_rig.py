"""What the whole live rig costs and how quick it is: all real drivers on the bench.

By hand, on an idle machine: ``python tests/benchmarks/bench_live_rig.py [program.toml]``. First a run of the
program as a person starts it (`rigctl run`), and the processor time of each of its processes and threads from
arming to the end, beside that of the bench. Then the rig in this process for some seconds: set-point to wire
(time stamps of the kernel at a listener of its own), poll cycle of the drive, blocks, lost frames.
"""

from __future__ import annotations

import multiprocessing
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import can
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "system"))

from bench_rig import ROOT, BenchProcess, free_port

from rigctl.app.compose import build_rig, read_rig
from rigctl.core.journal import read_journal
from rigctl.hal.devices import RigContext

SET_POINT_ID = 0x210
RIG_SECONDS = 20.0
TICK_S = 1.0 / os.sysconf("SC_CLK_TCK")


@dataclass
class Used:
    """Processor time of one process, s, and of its threads."""

    user_s: float = 0.0
    system_s: float = 0.0
    threads: dict[int, tuple[str, float, float]] = field(default_factory=dict)


def used(pid: int) -> Used:
    """So far."""
    whole = Used(*_times(Path(f"/proc/{pid}/stat"))[1:])
    for task in Path(f"/proc/{pid}/task").iterdir():
        whole.threads[int(task.name)] = _times(task / "stat")
    return whole


def _times(stat: Path) -> tuple[str, float, float]:
    text = stat.read_text()
    fields = text[text.rindex(")") + 2 :].split()
    return text[text.index("(") + 1 : text.rindex(")")], int(fields[11]) * TICK_S, int(fields[12]) * TICK_S


def run_and_measure(bench: BenchProcess, rig: Path, program: Path, folder: Path) -> None:
    """One run of `rigctl run`, measured from arming to the controller's end."""
    command = ["run", program, "--rig", rig, "--out", folder, "--name", "live", "--no-report"]
    campaign = folder / "live"
    with (folder / "run.log").open("w") as log:
        run = subprocess.Popen(
            [sys.executable, "-m", "rigctl.app.cli", *map(str, command)],
            stdout=log, stderr=log, env=bench.environment(),
        )  # fmt: skip
    pids: dict[str, int] = {}
    while not _records(campaign, "armed"):
        if run.poll() is not None:
            raise SystemExit(f"the run has ended:\n{(folder / 'run.log').read_text()}")
        time.sleep(0.1)
    children = _records(campaign, "run_started")[0].payload["pids"]
    pids = {"supervisor": run.pid, **children, "bench": bench.process.pid}
    start_s, before = time.monotonic(), {name: used(pid) for name, pid in pids.items()}
    while not _records(campaign, "ended") and run.poll() is None:
        try:
            newest, end_s = {name: used(pid) for name, pid in pids.items()}, time.monotonic()
        except (FileNotFoundError, ProcessLookupError):  # one has ended
            break
        time.sleep(0.5)
    run.wait()
    lived_s = end_s - start_s
    ended = _records(campaign, "ended")[0].payload
    print(f"\nrigctl run {program.name}: {ended['outcome']}, {ended['done']} brakings; over {lived_s:.1f} s:")
    total = 0.0
    for name in pids:
        share = _share(before[name], newest[name], lived_s)
        total += 0.0 if name == "bench" else share
        print(f"  {name:11} {share:5.3f} cores   {_threads(before[name], newest[name], lived_s)}")
    print(f"  whole live rig without the bench: {total:.3f} cores")


def _records(campaign: Path, kind: str) -> list[Any]:
    path = campaign / "journal.jsonl"
    records = list(read_journal(path)) if path.exists() else []
    return [entry for entry in records if entry.kind == kind and entry.source in ("controller", "supervisor")]


def _share(before: Used, after: Used, lived_s: float) -> float:
    return (after.user_s + after.system_s - before.user_s - before.system_s) / lived_s


def _threads(before: Used, after: Used, lived_s: float) -> str:
    parts = []
    for thread, (_, user_s, system_s) in sorted(after.threads.items()):
        _, user_0, system_0 = before.threads.get(thread, ("", 0.0, 0.0))
        parts.append(f"{(user_s - user_0) / lived_s:.3f}+{(system_s - system_0) / lived_s:.3f}")
    return "threads, user+system: " + " ".join(parts)


def listen(table: dict[str, Any], ready: Any, stop: Any, results: Any) -> None:
    """Arrival of every set-point on the bus, by the kernel's time stamp."""
    seen: dict[int, float] = {}
    with can.Bus(**table) as bus:
        ready.set()
        while not stop.is_set():
            message = bus.recv(0.1)
            if message is not None and message.arbitration_id == SET_POINT_ID:
                seen.setdefault(struct.unpack_from("<h", message.data, 2)[0], message.timestamp)
    results.put(seen)


def measure_rig(bench: BenchProcess, rig_path: Path, folder: Path) -> None:
    """The rig in this process, a new set-point with each block."""
    os.environ["RIGCTL_BENCH_DIR"] = str(bench.folder)
    config = read_rig(rig_path)
    spawn = multiprocessing.get_context("spawn")
    ready, stop, results = spawn.Event(), spawn.Event(), spawn.Queue()
    table = dict(config.buses["main"])
    listener = spawn.Process(target=listen, args=(table, ready, stop, results))
    listener.start()
    ready.wait(30.0)
    context = RigContext(folder, "real", None, "bench_live_rig", rig_path.parent, buses=config.buses)
    sent: dict[int, float] = {}
    late: list[float] = []
    with build_rig(config, context) as rig:
        acquisition: Any = rig.acquisition
        cpu_s, start_s = time.process_time(), time.monotonic()
        for block in rig.blocks():
            late.append(acquisition.ready_after_s)
            counts = 400 + block.k
            sent[counts] = time.time()
            rig.pressure.set_pressure(counts * 50.0 / 16384)
            if time.monotonic() - start_s > RIG_SECONDS:
                break
        lived_s = time.monotonic() - start_s
        cpu = (time.process_time() - cpu_s) / lived_s
        clocks = acquisition.clocks()
        drive: Any = rig.drive
        diagnosis = drive.diagnose(0)
    time.sleep(0.2)
    stop.set()
    seen = results.get(timeout=10.0)
    listener.join(10.0)
    print(f"\nthe rig in one process, {lived_s:.1f} s, {len(late)} blocks of 50 ms, {cpu:.3f} cores")
    print(f"  pressure set-point to wire  {_line([seen[key] - sent[key] for key in sent if key in seen])}")
    print(f"  set-points not on the wire  {sum(key not in seen for key in sent)} of {len(sent)}")
    print(f"  block delivered after its end {_line(late)}")
    rates = {reading.rate_hz for reading in diagnosis.values if reading.rate_hz}
    print(f"  drive: {', '.join(f'{rate:.1f}' for rate in sorted(rates))} poll cycles/s")
    for name, state in clocks.items():
        print(f"  {name:11} {', '.join(f'{key} {value}' for key, value in state.items())}")


def _line(times_s: list[float]) -> str:
    p50, p99, top = 1e3 * np.quantile(times_s, [0.5, 0.99, 1.0])
    return f"p50 {p50:.3f}  p99 {p99:.3f}  max {top:.3f} ms  (n = {len(times_s)})"


def main() -> None:
    """Both parts."""
    program = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "configs/programs/quick_check.toml"
    print(f"load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
    folder = Path(tempfile.mkdtemp(prefix="rl-"))
    bench = BenchProcess(folder / "bench", free_port()).wait_ready()
    try:
        rig = bench.rig_file(folder / "rig.toml")
        run_and_measure(bench, rig, program.resolve(), folder)
        measure_rig(bench, rig, folder)
        counts = defaultdict(int, bench.status()["sound"])
        print(f"  bench's microphone: {counts['samples']} frames written, {counts['lost']} lost there")
    finally:
        bench.end()
        shutil.rmtree(folder)


if __name__ == "__main__":
    main()

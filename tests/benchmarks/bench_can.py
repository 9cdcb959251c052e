"""How fast set-points reach the wire and readings come back, over UDP multicast between processes.

Run by hand: ``python tests/benchmarks/bench_can.py [seconds]``. The emulated nodes and a listener that
notes the arrival of every set-point run in processes of their own; times are of the machine's monotonic
clock. Peer: the same frames sent by python-can alone, to the same listener, in the same run.
"""

from __future__ import annotations

import itertools
import multiprocessing
import os
import statistics
import struct
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import can

from drivers.can.session import can_session
from drivers.pressure.canopen_regulator import CanopenPressureActuator
from rigctl.hal.devices import RigContext
from sim_hardware.bench.can import BenchCan
from sim_hardware.bench.signals import RigSignals

TABLE: dict[str, Any] = {
    "interface": "udp_multicast", "channel": "239.74.163.2", "port": 44000 + os.getpid() % 1000,
    "hop_limit": 0, "fd": False,
}  # fmt: skip
SET_POINT_ID, PEER_ID = 0x210, 0x2F0


def serve(table: dict[str, Any], ready: Any, stop: Any) -> None:
    with can.Bus(**table) as bus:
        bench = BenchCan(bus, RigSignals())
        bench.start()
        ready.set()
        stop.wait()
        bench.stop()


def listen(table: dict[str, Any], ready: Any, stop: Any, results: Any) -> None:
    seen: dict[tuple[int, int], float] = {}
    with can.Bus(**table) as bus:
        ready.set()
        while not stop.is_set():
            message = bus.recv(0.1)
            if message is not None and message.arbitration_id in (SET_POINT_ID, PEER_ID):
                key = (message.arbitration_id, struct.unpack_from("<h", message.data, 2)[0])
                seen.setdefault(key, time.monotonic())
    results.put(seen)


def main() -> None:
    duration_s = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    spawn = multiprocessing.get_context("spawn")
    readies, stop, results = [spawn.Event(), spawn.Event()], spawn.Event(), spawn.Queue()
    workers = [
        spawn.Process(target=serve, args=(TABLE, readies[0], stop)),
        spawn.Process(target=listen, args=(TABLE, readies[1], stop, results)),
    ]
    for worker, ready in zip(workers, readies, strict=True):
        worker.start()
        ready.wait(30.0)
    folder = Path(tempfile.mkdtemp())
    context = RigContext(folder, "real", None, "bench_can", folder, buses={"main": TABLE})
    settings = {
        "bus": "main", "node": 0x10, "range_bar": 50.0, "configure": True,
        "loss_reaction": {"object": "2100h:0 u8", "vent": 1},
    }  # fmt: skip
    actuator = CanopenPressureActuator(settings, context)
    started_s = time.monotonic()
    actuator.open()
    print(f"open: {1e3 * (time.monotonic() - started_s):.0f} ms")
    session = can_session(context, "main")
    periods: list[float] = []
    session.subscribe(0x1A0, lambda _data, timestamp_s: periods.append(timestamp_s))
    session.send(0x000, b"\x01\x20")
    end = threading.Event()

    def lease() -> None:
        while not end.wait(0.05):
            context.lease.renew()

    keeper = threading.Thread(target=lease)
    keeper.start()
    time.sleep(0.3)
    actuator.set_pressure(1.0)
    time.sleep(0.3)
    sent: dict[tuple[int, int], float] = {}
    cpu_s, started_s = time.process_time(), time.monotonic()
    with can.Bus(**TABLE) as peer:
        for counts in range(400, 400 + int(duration_s / 0.02)):
            sent[SET_POINT_ID, counts] = time.monotonic()
            actuator.set_pressure(counts * 50.0 / 16384)
            time.sleep(0.01)
            sent[PEER_ID, counts] = time.monotonic()
            data = struct.pack("<Hh", 7, counts)
            peer.send(can.Message(arbitration_id=PEER_ID, data=data, is_extended_id=False))
            time.sleep(0.01)
    share = (time.process_time() - cpu_s) / (time.monotonic() - started_s)
    trips = actuator.diagnose(500).round_trip_s
    end.set()
    keeper.join()
    actuator.close()
    stop.set()
    seen = results.get(timeout=10.0)
    for worker in workers:
        worker.join(10.0)
    found = {}
    for name, cob_id in (("set_pressure -> listener", SET_POINT_ID), ("python-can -> listener", PEER_ID)):
        keys = [key for key in sent if key[0] == cob_id]
        found[name] = [seen[key] - sent[key] for key in keys if key in seen]
        show(name, found[name])
        print(f"  lost: {len(keys) - len(found[name])} of {len(keys)}")
    ours, theirs = (statistics.median(values) for values in found.values())
    print(f"ratio of medians, driver / python-can alone: {ours / theirs:.2f}")
    show("SDO round trip", trips)
    gaps = [b - a for a, b in itertools.pairwise(periods)]
    show("period of a 1 ms TPDO as stamped", gaps)
    print(f"CPU of the driver's process: {100 * share:.0f} % of a core; {session.statistics}")


def show(name: str, times_s: Any) -> None:
    ordered = sorted(times_s)
    p50, p99 = (ordered[int(share * (len(ordered) - 1))] for share in (0.5, 0.99))
    numbers = f"p50 {1e3 * p50:.3f}  p99 {1e3 * p99:.3f}  max {1e3 * ordered[-1]:.3f} ms"
    print(f"{name}: {numbers}  (n = {len(ordered)})")


if __name__ == "__main__":
    main()

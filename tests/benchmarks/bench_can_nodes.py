"""Emulated CAN nodes in real time: processor share, evenness and loss of 1 kHz PDOs between two processes.

Run by hand: ``.venv/bin/python tests/benchmarks/bench_can_nodes.py [seconds] [port]``. A process of its own
serves the six nodes over UDP multicast; the torque is a ramp of one step each millisecond, so that a lost,
doubled or swapped sample shows. This process listens with python-can. The peer for timing is python-can's own
`send_periodic`, measured in the same way right afterwards.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import threading
import time

import can
import numpy as np

from sim_hardware.bench.can import BenchCan
from sim_hardware.bench.signals import RigSignals

MS = 1_000_000
GROUP = "239.74.163.2"
WRAP = 10_000  # N·m·100: the ramp starts again within the amplifier's range


def _bus(port: int) -> can.BusABC:
    return can.Bus(interface="udp_multicast", channel=GROUP, port=port, hop_limit=0, fd=False)


def serve(seconds: float, port: int) -> None:
    signals = RigSignals()
    with _bus(port) as bus:
        bench = BenchCan(bus, signals)
        stop = threading.Event()

        def publish() -> None:
            end_ms = time.monotonic_ns() // MS
            while not stop.wait(max(0.0, (end_ms + 10) * 1e-3 - time.monotonic())):
                signals.publish(
                    (end_ms + 10) * MS, torque_nm=[(k % WRAP) / 100.0 for k in range(end_ms, end_ms + 10)]
                )
                end_ms += 10

        thread = threading.Thread(target=publish)
        thread.start()
        bench.start()
        with _bus(port) as master:
            time.sleep(0.3)
            master.send(can.Message(arbitration_id=0, data=b"\x01\x00", is_extended_id=False))
        time.sleep(0.5)
        before, start, sent = (
            resource.getrusage(resource.RUSAGE_SELF),
            time.monotonic(),
            bench.statistics.sent,
        )
        time.sleep(seconds)
        after, span_s = resource.getrusage(resource.RUSAGE_SELF), time.monotonic() - start
        cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        print(
            f"nodes: {100 * cpu / span_s:.1f} % of a core (with the thread that plays the plant), "
            f"{(bench.statistics.sent - sent) / span_s:.0f} frames/s, latest timer "
            f"{bench.scheduler.latest_ns / MS:.1f} ms, given up {bench.scheduler.skipped}, "
            f"kernel filter {bench.deaf_to_itself}",
            flush=True,
        )
        stop.set()
        thread.join()
        bench.check()
        bench.stop()


def periodic(seconds: float, port: int) -> None:
    with _bus(port) as bus:
        message = can.Message(arbitration_id=0x1A0, data=bytes(8), is_extended_id=False)
        task = bus.send_periodic(message, 0.001)
        time.sleep(seconds)
        task.stop()


def listen(seconds: float, port: int, cob_id: int) -> tuple[np.ndarray, np.ndarray]:
    """Times of arrival (kernel) and first words of a PDO's frames."""
    times, words = [], []
    with _bus(port) as bus:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            message = bus.recv(0.1)
            if message is not None and message.arbitration_id == cob_id:
                times.append(message.timestamp)
                words.append(int.from_bytes(message.data[:4], "little", signed=True))
    return np.array(times), np.array(words)


def _spacing(times: np.ndarray) -> str:
    spacing = np.diff(times) * 1e3
    p50, p99, p999 = np.percentile(spacing, [50, 99, 99.9])
    return f"spacing p50 {p50:.3f} p99 {p99:.3f} p99.9 {p999:.2f} max {spacing.max():.1f} ms"


def main() -> None:
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    port = int(sys.argv[2]) if len(sys.argv) > 2 else 43500 + os.getpid() % 1000
    for role in ("serve", "periodic"):
        child = subprocess.Popen([sys.executable, __file__, str(seconds + 2), str(port), role])
        time.sleep(2.5)
        times, words = listen(seconds, port, 0x1A0)
        child.wait()
        if role == "serve":
            steps = np.diff(words) % WRAP
            print(
                f"1 kHz PDO: {len(words)} frames, values: {int(np.sum(steps > 1))} gaps, "
                f"{int(np.sum(steps == 0))} doubled; {_spacing(times)}"
            )
        else:
            print(f"peer, send_periodic: {len(times)} frames; {_spacing(times)}")
    print("load", os.getloadavg())


if __name__ == "__main__":
    if len(sys.argv) > 3:
        {"serve": serve, "periodic": periodic}[sys.argv[3]](float(sys.argv[1]), int(sys.argv[2]))
    else:
        main()

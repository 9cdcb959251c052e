"""Poll cycle and latency from set-point to wire of the serial drives, on emulators behind ptys. By hand:

    python tests/benchmarks/bench_drive_link.py [seconds]

The ptys are paced like a wire: 10 bit times per character. Prints rates, round trips and latencies.
"""

from __future__ import annotations

import itertools
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "contract"))

from speed_drive_rigs import emulated, until

CASES = (("modbus", 115200), ("modbus", 19200), ("eurotherm590", 19200), ("eurotherm590", 9600))


def _line(times_s: list[float]) -> str:
    ordered = sorted(times_s)
    p99 = ordered[min(len(ordered) - 1, int(0.99 * len(ordered)))]
    return (
        f"p50 {1e3 * statistics.median(ordered):6.2f}  p99 {1e3 * p99:6.2f}  max {1e3 * ordered[-1]:6.2f} ms"
    )


def measure(kind: str, baud: int, seconds: float, folder: Path) -> None:
    """One drive at one speed of the line."""
    with emulated(folder, kind, line_baud=baud, baud=baud) as under:
        drive = under.drive
        drive.open()
        drive.enable()
        drive.set_speed(50.0, 5000.0)
        until(lambda: abs(under.speed_set_rpm() - 50.0) < 0.1, what="set-point")
        cycles, cpu_s, start_s = drive._cycles, time.process_time(), time.monotonic()
        latencies_s: list[float] = []
        for speed_rpm in itertools.cycle((100.0, 50.0)):
            if time.monotonic() - start_s > seconds:
                break
            time.sleep(0.037)
            asked_s = time.monotonic()
            drive.set_speed(speed_rpm, 5000.0)
            while abs(under.speed_set_rpm() - speed_rpm) > 0.1 and time.monotonic() - asked_s < 1.0:
                time.sleep(0.0005)
            latencies_s.append(time.monotonic() - asked_s)
        lived_s = time.monotonic() - start_s
        cpu = (time.process_time() - cpu_s) / lived_s
        with_changes = (drive._cycles - cycles) / lived_s
        cycles, start_s = drive._cycles, time.monotonic()
        time.sleep(seconds / 2)
        steady = (drive._cycles - cycles) / (time.monotonic() - start_s)
        print(f"{kind} at {baud} Bd: {steady:.1f} cycles/s, {with_changes:.1f} while set-points change")
        print(f"   exchange              {_line(list(drive._link.round_trips_s))}")
        print(f"   set-point to the drive {_line(latencies_s)}  (n = {len(latencies_s)})")
        print(f"   retries {drive._link.retries}, CPU of driver, emulator and this loop {100 * cpu:.0f} %")


def main() -> None:
    """All cases."""
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10.0
    print(f"load average {os.getloadavg()[0]:.1f} on {os.cpu_count()} processors")
    for kind, baud in CASES:
        with tempfile.TemporaryDirectory() as folder:
            measure(kind, baud, seconds, Path(folder))


if __name__ == "__main__":
    main()

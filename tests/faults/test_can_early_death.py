"""A controller process killed in the very moment of its first set-point: the regulator vents by itself."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import can
from can_safety_bench import HERE, ROOT, bus_table, free_port

from sim_hardware.bench.can import BenchCan
from sim_hardware.bench.signals import RigSignals


class Signals(RigSignals):
    """Signals that call when the regulator puts the first pressure in force."""

    def __init__(self) -> None:
        super().__init__()
        self.at_first_pressure: Callable[[], None] | None = None

    def set(self, **values: float | bool) -> None:
        super().set(**values)
        if not self.commands().vent and self.at_first_pressure is not None:
            call, self.at_first_pressure = self.at_first_pressure, None
            call()


def test_the_regulator_vents(tmp_path: Path) -> None:
    table = bus_table(free_port())
    arguments = {key: value for key, value in table.items() if key != "interface"}
    signals = Signals()
    with can.Bus(interface="udp_multicast", **arguments) as bus:
        bench = BenchCan(bus, signals)
        bench.start()
        bench.wait_booted()
        controller = subprocess.Popen(
            [sys.executable, str(HERE / "can_actuator_controller.py"), json.dumps(table), str(tmp_path)],
            cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        )  # fmt: skip
        signals.at_first_pressure = lambda: os.kill(controller.pid, signal.SIGKILL)
        try:
            said, _ = controller.communicate(timeout=60)
            assert (said, controller.returncode) == ("open\n", -signal.SIGKILL)
            deadline_s = time.monotonic() + 3.0
            while not signals.get("vent"):
                assert time.monotonic() < deadline_s, "it holds what a dead controller has commanded"
                time.sleep(0.005)
        finally:
            if controller.poll() is None:
                controller.kill()
                controller.communicate()
            bench.stop()
        bench.check()

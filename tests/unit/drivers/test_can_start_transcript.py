"""Golden transcript of how a pressure regulator is opened, commanded and closed, in candump's format.

Heartbeats and the periodic frames have no fixed place among the others and are left out, repeats of one
command are joined. To renew after a wanted change: run with RIGCTL_GOLDEN=write and read the difference.
"""

from __future__ import annotations

import itertools
import os
import time
from pathlib import Path

import can
import pytest

from drivers.pressure.canopen_regulator import CanopenPressureActuator
from rigctl.hal.devices import RigContext
from sim_hardware.bench.can import BenchCan
from sim_hardware.bench.signals import RigSignals

GOLDEN = Path(__file__).parent / "golden" / "pressure_regulator.log"
SETTINGS = {
    "bus": "main", "node": 0x10, "range_bar": 50.0, "configure": True,
    "loss_reaction": {"object": "2100h:0 u8", "vent": 1},
    "identity": {"serial": 1, "name": "Bench pressure regulator"},
}  # fmt: skip
SHOWN = (0x000, 0x210, 0x590, 0x610)


@pytest.fixture
def log(tmp_path):
    channel = f"transcript-{os.getpid()}"
    bus = can.Bus(interface="virtual", channel=channel, ignore_config=True)
    bench = BenchCan(bus, RigSignals())
    bench.start()
    bench.wait_booted()
    context = RigContext(
        tmp_path, "real", None, "rig.toml", tmp_path, wire_log_dir=tmp_path,
        buses={"main": {"interface": "virtual", "channel": channel}},
    )  # fmt: skip
    actuator = CanopenPressureActuator(SETTINGS, context)
    try:
        actuator.open()
        for command in (lambda: actuator.set_pressure(10.0), actuator.vent):
            command()
            end_s = time.monotonic() + 0.2
            while time.monotonic() < end_s:
                context.lease.renew()
                time.sleep(0.01)
    finally:
        actuator.close()
        bench.stop()
        bus.shutdown()
    return tmp_path / "can-main.log"


def test_transcript(log: Path):
    with can.LogReader(log) as reader:
        frames = [
            f"(0.000000) can0 {m.arbitration_id:03X}#{bytes(m.data).hex().upper()}"
            for m in reader
            if m.arbitration_id in SHOWN
        ]
    lines = [line for line, _ in itertools.groupby(frames)]
    if os.environ.get("RIGCTL_GOLDEN") == "write":
        GOLDEN.write_text("\n".join(lines) + "\n")
    assert lines == GOLDEN.read_text().splitlines()

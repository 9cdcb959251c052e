"""A controller that opens the pressure regulator, asks for blocks and commands 10 bar at once.

Started by `test_can_early_death.py`, which kills it. Arguments: the bus as JSON, a folder.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

from drivers.pressure.canopen_regulator import CanopenPressureActuator
from rigctl.hal.devices import RigContext

SETTINGS = {
    "bus": "main", "node": 0x10, "range_bar": 50.0, "configure": True,
    "loss_reaction": {"object": "2100h:0 u8", "vent": 1},
}  # fmt: skip


def main() -> None:
    folder = Path(sys.argv[2])
    buses = {"main": json.loads(sys.argv[1])}
    context = RigContext(folder, "real", None, "rig.toml", folder, buses=buses)
    actuator = CanopenPressureActuator(SETTINGS, context)
    actuator.open()
    print("open", flush=True)
    context.lease.renew()
    actuator.set_pressure(10.0)
    while True:
        context.lease.renew()
        time.sleep(0.02)


if __name__ == "__main__":
    main()

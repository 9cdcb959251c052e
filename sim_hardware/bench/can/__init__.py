"""Emulated CANopen devices of the bench, made of raw frames after the CiA standards.

`BenchCan(bus, signals, settings)` with `start()` and `stop()` is all that the bench needs; the devices'
manual is README.md beside this file. NOT its job: the plant, opening buses, drivers (they know nothing of
this package).
"""

from sim_hardware.bench.can.bench import BenchCan
from sim_hardware.bench.can.faults import FaultRule
from sim_hardware.bench.can.settings import BenchCanSettings

__all__ = ["BenchCan", "BenchCanSettings", "FaultRule"]

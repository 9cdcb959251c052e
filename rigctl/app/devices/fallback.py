"""What can be told of a device that has no `diagnose`: by the plain interface of its role.

Job: identity, and the values that the interfaces of `rigctl.hal.devices` have without moving anything; of an
acquisition the mean and the measured rate of each channel. Not its job: settings and round trips, which only
the driver knows.
"""

from __future__ import annotations

import math
import time
from typing import Any

from rigctl.core.units import NS_PER_S
from rigctl.hal.devices import Acquisition, Request
from rigctl.hal.diagnosis import Diagnosis, Finding, Reading

LISTEN_S = 1.0
_BLOCK_S = 0.05


def diagnose_plain(device: Any, role: str) -> Diagnosis:
    """Identity and values of an open device."""
    values: tuple[Reading, ...] = ()
    if role == "drive":
        values = (
            Reading("speed set-point", device.commanded_rpm, "1/min"),
            Reading("torque asked for", device.enabled),
        )
    elif role == "pressure":
        values = (Reading("pressure set-point", device.commanded_bar, "bar"),)
    elif role == "acquisition":
        values = _listen(device)
    elif role == "safety":
        status = device.status()
        values = (
            Reading("relay closed", status.relay_closed),
            Reading("emergency stop released", status.estop_ok),
            Reading("doors closed", status.doors_ok),
        )
    return Diagnosis(
        values,
        warnings=(
            Finding("its driver cannot read settings back (no `diagnose`): check them by hand.",
                    "docs/how-to/add-a-driver.md says how a driver learns it."),
        ),
        identity=dict(device.identity()),
    )  # fmt: skip


def _listen(acquisition: Acquisition) -> tuple[Reading, ...]:
    specs = acquisition.channels()
    sums = {spec.name: 0.0 for spec in specs}
    counts = {spec.name: 0 for spec in specs}
    request = Request(round(_BLOCK_S * NS_PER_S), recording=True)
    acquisition.next_block(request)  # the first may hold what was waiting
    started = time.monotonic()
    while (elapsed_s := time.monotonic() - started) < LISTEN_S:
        block = acquisition.next_block(request)
        for name in sums:
            start, stop = block.ranges.get(name, (0, 0))
            mean = block.mean(name)
            if stop > start and math.isfinite(mean):
                sums[name] += mean * (stop - start)
                counts[name] += stop - start
    return tuple(
        Reading(
            spec.name, sums[spec.name] / counts[spec.name], spec.unit, rate_hz=counts[spec.name] / elapsed_s
        )
        if counts[spec.name]
        else Reading(spec.name, None, spec.unit, fault=f"no valid sample within {LISTEN_S:g} s")
        for spec in specs
    )

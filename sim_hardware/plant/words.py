"""What goes into the plant and what comes out of a step: commands, samples, and the truth for tests.

Job: these words, and what the safety relay leaves of commands (`behind_relay`). NOT its job: physics.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True)
class Commands:
    """Set-points and switches of one step, in rig units. All hold for the whole step."""

    speed_set_rpm: float = 0.0
    speed_ramp_rpm_per_s: float = 60.0
    drive_enabled: bool = False
    quick_stop: bool = False
    pressure_set_bar: float = 0.0
    vent: bool = False
    ventilator_m3_h: float = 0.0
    relay_closed: bool = False


def behind_relay(wanted: Commands, *, closed: bool, ventilator_max_m3_h: float) -> Commands:
    """What reaches the rig of what is commanded: the open relay takes torque and pressure away, and cools."""
    if closed:
        return replace(wanted, relay_closed=True)
    return replace(
        wanted, drive_enabled=False, vent=True, ventilator_m3_h=ventilator_max_m3_h, relay_closed=False
    )


@dataclass(frozen=True, slots=True)
class PlantStep:
    """Samples of one step.

    Attributes
    ----------
    samples : per slow channel (torque, pressure, speed, disc_temperature) float32 samples, shape (n,); the
        first belongs to the start of the step
    safety : readings of the watchdog's own sensors at 100 Hz, at least one, as plain numbers for messages:
        "p" bar, "n" 1/min, "M" N m, "T" degC
    stride : samples are every `stride`-th of the 4 kHz grid
    """

    samples: dict[str, NDArray[np.float32]]
    safety: dict[str, list[float]]
    stride: int


@dataclass(frozen=True, slots=True)
class PlantTruth:
    """True values at the end of the last step, without any sensor between."""

    time_s: float
    speed_rpm: float
    motor_torque_nm: float
    brake_torque_nm: float
    pressure_bar: float
    surface_degc: float
    bulk_degc: float
    pad_degc: float
    mu: float
    slope_s_m: float
    bedding: float
    friction_energy_j: float
    loss_energy_j: float
    ventilator_m3_h: float
    relay_closed: bool

"""The few numbers between the bench's plant and its emulated devices.

Job: `RigSignals` holds what devices command (inputs of the plant) and what the plant does (outputs), safe
between threads. Not its job: physics, noise of sensors beyond what the plant gives, protocols.

The plant's thread calls `commands()` before a step and `publish(end_ns, torque_nm=values, ...)` after it;
times are `time.monotonic_ns()` on the plant's own grid. Devices call `set` for what they command. They read
`newest`, or the value *at* a time, so that several listeners read the same samples and a 1 kHz PDO carries
the sample of its own millisecond: the samples of a step are known at its end at the earliest (a step is 10
ms), so such a PDO asks for a time some 20 ms back.
"""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

NS_PER_MS = 1_000_000
#: Length of the memory of outputs. Far more than the plant's step plus the devices' delay.
HISTORY_MS = 2048

#: Readings of the rig's own sensors; the regulator's pressure and the drive's speed are those of their own
#: sensors, with errors of their own. `position_turns` (true) counts on over all turns since the start.
OUTPUTS = (
    "torque_nm", "pressure_bar", "speed_rpm", "position_turns", "disc_temperature_degc",
    "regulator_pressure_bar", "drive_speed_rpm", "motor_torque_nm",
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Inputs:
    """What the emulated devices command, and the state of the hard-wired chain. The defaults are safe."""

    speed_set_rpm: float = 0.0
    speed_ramp_rpm_per_s: float = 60.0
    drive_enabled: bool = False
    quick_stop: bool = False
    pressure_set_bar: float = 0.0
    vent: bool = True
    ventilator_m3_h: float = 0.0
    relay_closed: bool = False
    estop_ok: bool = True
    doors_ok: bool = True


_INPUT_NAMES = frozenset(field.name for field in fields(Inputs))


class RigSignals:
    """Inputs and outputs of the plant.

    Parameters
    ----------
    outputs : mapping of str to float
        Values before the plant has published any; rest and 20 degC where not given.
    """

    def __init__(self, outputs: Mapping[str, float] | None = None) -> None:
        rest = {name: 20.0 if name == "disc_temperature_degc" else 0.0 for name in OUTPUTS}
        unknown = set(outputs or ()) - set(rest)
        if unknown:
            raise ValueError(f"no such output of the rig: {', '.join(sorted(unknown))}")
        self._lock = threading.Lock()
        self._inputs = Inputs()
        self._newest: dict[str, float] = rest | dict(outputs or {})
        self._history: dict[str, list[float]] = {
            name: [value] * HISTORY_MS for name, value in self._newest.items()
        }
        self._end_ms: int | None = None  # the newest sample belongs to the millisecond before this one
        self._known_ms = 0

    # -- inputs of the plant ------------------------------------------------------------------------

    def set(self, **values: float | bool) -> None:
        """Command something; the plant takes it with its next step."""
        unknown = values.keys() - _INPUT_NAMES
        if unknown:
            raise ValueError(f"no such input of the rig: {', '.join(sorted(unknown))}")
        with self._lock:
            self._inputs = replace(self._inputs, **values)  # pyright: ignore[reportArgumentType]

    def commands(self) -> Inputs:
        """All inputs as they are now."""
        return self._inputs

    def get(self, name: str) -> float | bool:
        """One input as it is now."""
        return getattr(self._inputs, name)

    # -- outputs of the plant -----------------------------------------------------------------------

    def publish(self, end_ns: int, **samples: Sequence[float]) -> None:
        """Samples of a step at 1 kHz, oldest first; the last is of the millisecond that ends at `end_ns`."""
        end_ms = end_ns // NS_PER_MS
        with self._lock:
            length = 0
            for name, values in samples.items():
                history = self._history[name]
                length = len(values)
                for position, value in enumerate(values, start=end_ms - length):
                    history[position % HISTORY_MS] = float(value)
                self._newest[name] = float(values[-1])
            contiguous = self._end_ms is not None and end_ms - length == self._end_ms
            self._known_ms = min(self._known_ms + length, HISTORY_MS) if contiguous else length
            self._end_ms = end_ms

    def newest(self, name: str) -> float:
        """The newest value of an output."""
        return self._newest[name]

    def at(self, name: str, t_ns: int) -> float:
        """The value of the millisecond that begins at `t_ns`; the newest where that is not known."""
        end_ms = self._end_ms
        if end_ms is None:
            return self._newest[name]
        age_ms = end_ms - t_ns // NS_PER_MS
        if 1 <= age_ms <= self._known_ms:
            return self._history[name][(end_ms - age_ms) % HISTORY_MS]
        return self._newest[name]

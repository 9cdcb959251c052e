"""Live values near the watchdog's limits: a warning before the trip, with hysteresis.

Job: from what level on a value is near its limit, and whether it is near now. No widgets. Not its
job: the limits (`rigctl.safety.limits`; the watchdog alone decides), the list of alarms (`alarm_list`).

The warning begins where no ordered set-point comes: half-way between what the rig allows and the limit, but
not below 95 % of the limit.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

from rigctl.gui.rig.state import Readings
from rigctl.safety.limits import Limits, load_limits

translate = QCoreApplication.translate

SHARE = 0.95
HYSTERESIS = 0.02
"""Share of the limit by which a value must fall again before the warning ends."""
_KW_PER_NM_RPM = math.pi / 30.0 / 1000.0


@dataclass(frozen=True)
class _Bound:
    key: str
    name: str
    unit: str
    limit: float
    warn: float
    decimals: int


def allowed_of(capabilities: object) -> dict[str, float]:
    """What the rig file allows, by the keys used here."""
    names = {
        "pressure": "max_pressure_bar", "speed": "max_speed_rpm", "torque": "max_torque_nm",
        "temperature": "max_disc_temperature_degc", "power": "drive_power_kw",
    }  # fmt: skip
    return {key: float(getattr(capabilities, name)) for key, name in names.items()}


class LimitWatch:
    """Compares readings with limits.

    Parameters
    ----------
    limits : Limits or None
        None: nothing is watched.
    allowed : mapping
        What the rig allows, see `allowed_of`.
    """

    def __init__(self, limits: Limits | None, allowed: Mapping[str, float]) -> None:
        self._bounds: list[_Bound] = []
        self._near: set[str] = set()
        if limits is None:
            return
        for key, name, unit, limit, decimals in (
            (
                "pressure",
                str(QT_TRANSLATE_NOOP("alarms", "Brake pressure")),
                "bar",
                limits.pressure.max_bar,
                1,
            ),
            ("speed", str(QT_TRANSLATE_NOOP("alarms", "Speed")), "1/min", limits.speed.max_rpm, 0),
            ("torque", str(QT_TRANSLATE_NOOP("alarms", "Torque")), "N·m", limits.torque.max_nm, 0),
            (
                "temperature",
                str(QT_TRANSLATE_NOOP("alarms", "Disc temperature")),
                "°C",
                limits.disc_temperature.max_degc,
                0,
            ),
            ("power", str(QT_TRANSLATE_NOOP("alarms", "Friction power")), "kW", limits.power.max_kw, 1),
        ):
            warn = SHARE * limit
            if key in allowed and allowed[key] < limit:
                warn = max(warn, 0.5 * (allowed[key] + limit))
            self._bounds.append(_Bound(key, name, unit, limit, warn, decimals))

    @classmethod
    def of_file(cls, path: Path, capabilities: object) -> LimitWatch:
        """For the limits file of a campaign.

        Raises
        ------
        ConfigError
            The file is missing or wrong.
        """
        return cls(load_limits(path).limits, allowed_of(capabilities))

    def warn_levels(self) -> dict[str, float]:
        """Level of each warning by key."""
        return {bound.key: bound.warn for bound in self._bounds}

    def near(self, readings: Readings) -> list[tuple[str, str, str]]:
        """(key, words, remedy) of each value that is near its limit now."""
        values = {
            "pressure": readings.pressure_bar,
            "speed": abs(readings.speed_rpm),
            "torque": abs(readings.torque_nm),
            "temperature": readings.temperature_degc,
            "power": abs(readings.torque_nm * readings.speed_rpm) * _KW_PER_NM_RPM,
        }
        found = []
        for bound in self._bounds:
            value = values[bound.key]
            lower = bound.warn - HYSTERESIS * bound.limit
            if value >= bound.warn or (bound.key in self._near and value >= lower):
                self._near.add(bound.key)
                words = translate("alarms", "{0} {1} is near its limit {2}.").format(
                    translate("alarms", bound.name),
                    f"{value:.{bound.decimals}f} {bound.unit}",
                    f"{bound.limit:.{bound.decimals}f} {bound.unit}",
                )
                remedy = translate("alarms", "At the limit the watchdog trips: take some load off.")
                found.append((bound.key, words, remedy))
            else:
                self._near.discard(bound.key)
        return found

"""Constants of unit conversion, used at the two seams only: rig units outside, SI inside plant and model.

Rig units are 1/min, bar, °C, N·m, Pa (sound), m³/h (air). Not its job: a units library.
"""

from __future__ import annotations

import math

PA_PER_BAR = 1.0e5
RAD_S_PER_RPM = 2.0 * math.pi / 60.0
KELVIN_AT_0_DEGC = 273.15
M3_S_PER_M3_H = 1.0 / 3600.0
NS_PER_S = 1_000_000_000
REFERENCE_PRESSURE_PA = 20.0e-6  # 0 dB sound pressure level, IEC 61672-1

_UNITS_BY_SUFFIX = {
    "hz": "Hz",
    "db": "dB",
    "dba": "dB(A)",
    "s": "s",
    "bar": "bar",
    "degc": "°C",
    "rpm": "1/min",
    "nm": "N·m",
    "pa": "Pa",
    "ms": "ms",
    "ppm": "ppm",
}


def unit_of(name: str) -> str:
    """Unit that the suffix of a name states, "" for a plain number: "start_s" is in "s"."""
    return _UNITS_BY_SUFFIX.get(name.rpartition("_")[2], "") if "_" in name else ""

"""Limit bands of the channels, and the session's own values in its campaign file.

Job: lower and upper limit by channel, from the watchdog's limits file or its object; the geometry of mu.
Reads two small TOML files. Plain Python, no Qt. Not its job: checking anything against limits.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rigctl.core.channels import DISC_TEMPERATURE, PRESSURE, SPEED, TORQUE
from rigctl.gui.live.buffer import Friction

Bands = dict[str, tuple[float, float]]
_KEYS = {
    PRESSURE: ("min_bar", "max_bar"),
    SPEED: ("min_rpm", "max_rpm"),
    TORQUE: ("min_nm", "max_nm"),
    DISC_TEMPERATURE: ("min_degc", "max_degc"),
}


def limit_bands(limits: Any) -> Bands:
    """Limits by channel.

    Parameters
    ----------
    limits : object or mapping
        `rigctl.safety.limits.Limits`, the same as read from its file, a mapping of channel name to
        (lower, upper), or None.
    """
    bands: Bands = {}
    for channel, (low, high) in _KEYS.items():
        section = limits.get(channel) if isinstance(limits, Mapping) else getattr(limits, channel, None)
        if section is None:
            continue
        if isinstance(section, Mapping):
            bands[channel] = (float(section[low]), float(section[high]))
        elif isinstance(section, (tuple, list)):
            bands[channel] = (float(section[0]), float(section[1]))
        else:
            bands[channel] = (float(getattr(section, low)), float(getattr(section, high)))
    return bands


@dataclass(frozen=True, slots=True)
class SessionValues:
    """What the plots take from a campaign: limits, geometry of mu. Empty where the files say nothing."""

    limits: Bands
    friction: Friction | None


def read_session(campaign: Path) -> SessionValues:
    """From campaign.toml and the frozen limits beside it; a session without a campaign has neither."""
    path = campaign / "campaign.toml"
    if not path.is_file():
        return SessionValues({}, None)
    rig = tomllib.loads(path.read_text(encoding="utf-8")).get("rig", {})
    geometry = rig.get("friction")
    friction = None
    if geometry is not None:
        friction = Friction(
            float(geometry["piston_area_m2"]),
            float(geometry["effective_radius_m"]),
            float(geometry.get("p0_bar", 0.5)),
        )
    limits_file = rig.get("safety", {}).get("limits")
    bands: Bands = {}
    if limits_file and (campaign / limits_file).is_file():
        bands = limit_bands(tomllib.loads((campaign / limits_file).read_text(encoding="utf-8")))
    return SessionValues(bands, friction)

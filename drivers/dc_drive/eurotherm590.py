"""The drive of kind "eurotherm590". Job: put settings, map, link and thread together. Not its job: all of
these."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from drivers.dc_drive.eurotherm_link import EurothermLink
from drivers.dc_drive.eurotherm_map import TagMap
from drivers.dc_drive.polled import PolledDrive
from drivers.dc_drive.settings import SerialDriveSettings, read_map, read_settings
from rigctl.hal.devices import RigContext


class Eurotherm590Settings(SerialDriveSettings):
    """Keys of ``[devices.drive]`` with ``kind = "eurotherm590"``."""

    group: Annotated[int, Field(ge=0, le=7)] = 0
    unit: Annotated[int, Field(ge=0, le=15)] = 1
    baud: Annotated[int, Field(ge=300, le=115200)] = 9600
    parity: Literal["N", "E", "O"] = "E"
    data_bits: Literal[7, 8] = 7
    reply_timeout_s: Annotated[float, Field(ge=0.05, le=2)] = 0.2  # the manual: at least 160 ms
    deadline_s: Annotated[float, Field(ge=0.05, le=2)] = 0.6


class Eurotherm590Drive(PolledDrive):
    """A Eurotherm/Parker 590 on EI-Bisynch ASCII."""

    def __init__(self, settings: Mapping[str, Any], context: RigContext) -> None:
        checked = read_settings(Eurotherm590Settings, settings, context)
        tag_map = read_map(TagMap, checked.map, context)
        link = EurothermLink(checked, tag_map, checked.group, checked.unit)
        super().__init__(link, context, port=checked.port, period_s=checked.period_s)

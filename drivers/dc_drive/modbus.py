"""The drive of kind "modbus". Job: put settings, map, link and thread together. Not its job: all of these."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field

from drivers.dc_drive.modbus_link import ModbusLink
from drivers.dc_drive.modbus_map import RegisterMap
from drivers.dc_drive.polled import PolledDrive
from drivers.dc_drive.settings import SerialDriveSettings, read_map, read_settings
from rigctl.hal.devices import RigContext


class ModbusDriveSettings(SerialDriveSettings):
    """Keys of ``[devices.drive]`` with ``kind = "modbus"``."""

    address: Annotated[int, Field(ge=1, le=247)] = 1
    baud: Annotated[int, Field(ge=1200, le=1_000_000)] = 115200
    parity: Literal["N", "E", "O"] = "N"
    data_bits: Literal[7, 8] = 8


class ModbusDrive(PolledDrive):
    """A drive with control and status word on Modbus RTU."""

    def __init__(self, settings: Mapping[str, Any], context: RigContext) -> None:
        checked = read_settings(ModbusDriveSettings, settings, context)
        register_map = read_map(RegisterMap, checked.map, context)
        link = ModbusLink(checked, register_map, checked.address)
        super().__init__(link, context, port=checked.port, period_s=checked.period_s)

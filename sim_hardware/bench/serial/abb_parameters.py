"""Parameters of the emulated ABB drive: number, limits, register scaling, who may write.

Job: the table, and its access as 16-bit registers (400000 + 100 group + index) and 32-bit pairs (420000 + 200
group + 2 index, high word first). Not its job: what a parameter does (`abb_drive`).

Register rules are those of the FENA-01 manual, page 40. Numbers and scalings of the parameters are
recollections of the ACS880 and DCS880 firmware manuals: plausible, not confirmed.
"""

from __future__ import annotations

from dataclasses import dataclass

from sim_hardware.bench.serial.modbus_slave import ILLEGAL_ADDRESS, ILLEGAL_VALUE, ModbusException

MOTOR_SPEED, TRIP_CODE = (1, 1), (4, 1)
RATING_ID, FIRMWARE, SERIAL_HIGH, SERIAL_LOW = (7, 3), (7, 5), (7, 21), (7, 22)
ACCELERATION, DECELERATION, EMERGENCY_STOP_TIME = (23, 12), (23, 13), (23, 23)
SAFE_SPEED = (22, 41)
SPEED_SCALING = (46, 1)
LOSS_ACTION, LOSS_MODE, LOSS_TIME = (58, 14), (58, 15), (58, 16)

#: Values of parameter 58.14
ACTION_NONE, ACTION_FAULT, ACTION_LAST_SPEED, ACTION_SAFE_SPEED, ACTION_SAFE_SPEED_ALWAYS, ACTION_WARNING = (
    range(6)
)


@dataclass(slots=True)
class Parameter:
    """One parameter; physical value = register / scale."""

    name: str
    value: float
    low: float
    high: float
    scale_16: float = 1.0
    scale_32: float = 1.0
    read_only: bool = False


def factory_parameters() -> dict[tuple[int, int], Parameter]:
    """The parameters as the drive leaves the factory."""
    return {
        MOTOR_SPEED: Parameter("motor speed used, 1/min", 0.0, -30000, 30000, 1, 100, read_only=True),
        TRIP_CODE: Parameter("tripping fault", 0, 0, 0xFFFF, read_only=True),
        RATING_ID: Parameter("drive rating id", 1151, 0, 0xFFFF, read_only=True),
        FIRMWARE: Parameter("firmware version", 0x0280, 0, 0xFFFF, read_only=True),
        SERIAL_HIGH: Parameter("serial number, high", 0x0590, 0, 0xFFFF, read_only=True),
        SERIAL_LOW: Parameter("serial number, low", 0x1984, 0, 0xFFFF, read_only=True),
        (6, 1): Parameter("main control word", 0, 0, 0xFFFF, read_only=True),
        (6, 11): Parameter("main status word", 0, 0, 0xFFFF, read_only=True),
        SAFE_SPEED: Parameter("speed ref safe, 1/min", 0.0, -30000, 30000, 1, 100),
        ACCELERATION: Parameter("acceleration time 1, s", 20.0, 0, 1800, 10, 1000),
        DECELERATION: Parameter("deceleration time 1, s", 20.0, 0, 1800, 10, 1000),
        EMERGENCY_STOP_TIME: Parameter("emergency stop time, s", 3.0, 0, 1800, 10, 1000),
        SPEED_SCALING: Parameter("speed scaling, 1/min", 1000.0, 0.1, 30000, 1, 100),
        LOSS_ACTION: Parameter("communication loss action", ACTION_FAULT, 0, 5),
        LOSS_MODE: Parameter("communication loss mode", 1, 0, 2),
        LOSS_TIME: Parameter("communication loss time, s", 3.0, 0, 6000, 10, 10),
        (58, 3): Parameter("node address", 1, 0, 255),
        (58, 4): Parameter("baud rate", 7, 0, 7),
    }


class ParameterRegisters:
    """Parameters seen as registers."""

    FIRST_16, LAST_16 = 100, 9999  # addresses in the frame
    FIRST_32, LAST_32 = 20200, 20000 + 200 * 99 + 2 * 99

    def __init__(self, table: dict[tuple[int, int], Parameter]) -> None:
        self.table = table

    def owns(self, address: int) -> bool:
        """Whether this address belongs to parameters."""
        return self.FIRST_16 <= address <= self.LAST_16 or self.FIRST_32 - 1 <= address <= self.LAST_32

    def read(self, address: int, count: int) -> list[int]:
        """Register values. Raises `ModbusException` where one does not exist."""
        return [self._word(position) for position in range(address, address + count)]

    def prepare(self, address: int, values: list[int]) -> list[tuple[Parameter, float]]:
        """Check a write without doing it: the parameters and their new values."""
        changes: list[tuple[Parameter, float]] = []
        if address < self.FIRST_32 - 1:
            for position, word in enumerate(values, start=address):
                parameter = self._find(*divmod(position + 1, 100))
                signed = word - 0x10000 if parameter.low < 0 and word >= 0x8000 else word
                changes.append((parameter, signed / parameter.scale_16))
        else:
            offset = address + 1 - 20000
            if offset % 2 or len(values) % 2:
                raise ModbusException(ILLEGAL_ADDRESS)
            for position in range(0, len(values), 2):
                parameter = self._find(*_group_index_32(offset + position))
                raw = values[position] << 16 | values[position + 1]
                signed = raw - 0x1_0000_0000 if raw >= 0x8000_0000 else raw
                changes.append((parameter, signed / parameter.scale_32))
        for parameter, value in changes:
            if parameter.read_only or not parameter.low <= value <= parameter.high:
                raise ModbusException(ILLEGAL_VALUE)
        return changes

    def _word(self, address: int) -> int:
        if address <= self.LAST_16:
            parameter = self._find(*divmod(address + 1, 100))
            return round(parameter.value * parameter.scale_16) & 0xFFFF
        offset = address + 1 - 20000
        parameter = self._find(*_group_index_32(offset - offset % 2))
        raw = round(parameter.value * parameter.scale_32) & 0xFFFF_FFFF
        return raw & 0xFFFF if offset % 2 else raw >> 16

    def _find(self, group: int, index: int) -> Parameter:
        try:
            return self.table[group, index]
        except KeyError:
            raise ModbusException(ILLEGAL_ADDRESS) from None


def _group_index_32(offset: int) -> tuple[int, int]:
    """Group and index of 32-bit register 420000 + offset; index runs from 1 to 99."""
    group, rest = divmod(offset, 200)
    return group, rest // 2

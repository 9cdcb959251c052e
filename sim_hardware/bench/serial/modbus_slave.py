"""A Modbus RTU slave of its own: frames ended by silence, CRC-16, function codes 3, 4, 6 and 16, exceptions 1
to 3.

Job: the protocol after "MODBUS over serial line" and "MODBUS application protocol" (modbus.org), for any
`Registers`. Not its job: what a register means.
"""

from __future__ import annotations

import struct
from typing import Protocol

READ_HOLDING, READ_INPUT, WRITE_SINGLE, WRITE_MULTIPLE = 0x03, 0x04, 0x06, 0x10
ILLEGAL_FUNCTION, ILLEGAL_ADDRESS, ILLEGAL_VALUE = 1, 2, 3
BROADCAST = 0
MOST_READ, MOST_WRITTEN = 125, 123
LONGEST_FRAME = 256
#: Above 19200 Bd the silence that ends a frame is fixed.
FIXED_SILENCE_S = 0.00175
FIXED_ABOVE_BAUD = 19200


class ModbusException(Exception):
    """The request is refused with this exception code."""

    def __init__(self, code: int) -> None:
        self.code = code
        super().__init__(f"Modbus exception {code}")


class Registers(Protocol):
    """The registers of a device, by their address in the frame (register number 400001 is address 0)."""

    def read(self, address: int, count: int) -> list[int]:
        """Values of 0..65535. Raises `ModbusException`."""
        ...

    def write(self, address: int, values: list[int]) -> None:
        """Write all or none. Raises `ModbusException`."""
        ...


def crc16(data: bytes) -> int:
    """CRC-16 of Modbus: polynomial 0xA001 (reflected 0x8005), start 0xFFFF; sent low byte first."""
    crc = 0xFFFF
    for value in data:
        crc ^= value
        for _ in range(8):
            crc = (crc >> 1) ^ 0xA001 if crc & 1 else crc >> 1
    return crc


def seal(body: bytes) -> bytes:
    """The body with its CRC."""
    return body + struct.pack("<H", crc16(body))


def silence_s(baud: int, character_s: float) -> float:
    """The silence that ends a frame: 3.5 characters, 1.75 ms above 19200 Bd."""
    return FIXED_SILENCE_S if baud > FIXED_ABOVE_BAUD else 3.5 * character_s


class RtuSlave:
    """The slave's half of the protocol, fed with bytes and time.

    Parameters
    ----------
    address : int
        1..247.
    registers : Registers
    silence_s : float
        Silence that ends a frame.
    response_s : float
        Time that the device takes to answer, after the silence.
    """

    def __init__(self, address: int, registers: Registers, *, silence_s: float, response_s: float) -> None:
        self._address = address
        self._registers = registers
        self._silence_s = silence_s
        self._response_s = response_s
        self._frame = bytearray()
        self._last_s = float("-inf")
        self._answer = b""
        self._answer_s = float("inf")
        self.frames_taken = 0
        self.frames_refused = 0

    def receive(self, data: bytes, first_s: float, last_s: float) -> None:
        """Bytes have arrived; a silence before them ends the frame that they do not belong to."""
        if self._frame and first_s - self._last_s > self._silence_s:
            self._end_frame(self._last_s + self._silence_s)
        self._frame += data
        self._last_s = last_s

    def advance(self, now_s: float) -> bytes:
        """The answer, when its time has come."""
        if self._frame and now_s >= self._last_s + self._silence_s:
            self._end_frame(now_s)
        if now_s >= self._answer_s:
            answer, self._answer, self._answer_s = self._answer, b"", float("inf")
            return answer
        return b""

    def due_s(self) -> float:
        """When `advance` wants to be called."""
        return min(self._answer_s, self._last_s + self._silence_s if self._frame else float("inf"))

    def _end_frame(self, now_s: float) -> None:
        frame = bytes(self._frame)
        self._frame.clear()
        answer = self.answer(frame)
        if answer:
            self._answer, self._answer_s = answer, now_s + self._response_s

    def answer(self, frame: bytes) -> bytes:
        """The answer to a whole frame; empty where a slave keeps silent."""
        if not 4 <= len(frame) <= LONGEST_FRAME or struct.unpack("<H", frame[-2:])[0] != crc16(frame[:-2]):
            self.frames_refused += 1
            return b""
        address, function = frame[0], frame[1]
        if address not in {self._address, BROADCAST}:
            return b""
        self.frames_taken += 1
        try:
            body = self._execute(function, frame[2:-2], broadcast=address == BROADCAST)
        except ModbusException as error:
            function, body = function | 0x80, bytes([error.code])
        return b"" if address == BROADCAST else seal(bytes([address, function]) + body)

    def _execute(self, function: int, data: bytes, *, broadcast: bool) -> bytes:
        if function in {READ_HOLDING, READ_INPUT} and not broadcast:
            if len(data) != 4:
                raise ModbusException(ILLEGAL_VALUE)
            start, count = struct.unpack(">HH", data)
            _check_range(start, count, MOST_READ)
            values = self._registers.read(start, count)
            return bytes([2 * count]) + struct.pack(f">{count}H", *values)
        if function == WRITE_SINGLE:
            if len(data) != 4:
                raise ModbusException(ILLEGAL_VALUE)
            start, value = struct.unpack(">HH", data)
            self._registers.write(start, [value])
            return data
        if function == WRITE_MULTIPLE:
            if len(data) < 5:
                raise ModbusException(ILLEGAL_VALUE)
            start, count, length = struct.unpack(">HHB", data[:5])
            if length != 2 * count or len(data) != 5 + length:
                raise ModbusException(ILLEGAL_VALUE)
            _check_range(start, count, MOST_WRITTEN)
            self._registers.write(start, list(struct.unpack(f">{count}H", data[5:])))
            return data[:4]
        raise ModbusException(ILLEGAL_FUNCTION)


def _check_range(start: int, count: int, most: int) -> None:
    if not 1 <= count <= most:
        raise ModbusException(ILLEGAL_VALUE)
    if start + count > 0x10000:
        raise ModbusException(ILLEGAL_ADDRESS)

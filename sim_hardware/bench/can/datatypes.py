"""Data types of CiA 301: how values become bytes on the wire and back.

Job: encode and decode, little-endian, with the type's range. Not its job: which object has which type.
"""

from __future__ import annotations

import enum
import math
import struct

Value = int | float | str | bytes


class DataType(enum.IntEnum):
    """Indices of the static data types (CiA 301, table of data types)."""

    BOOLEAN = 0x01
    INTEGER8 = 0x02
    INTEGER16 = 0x03
    INTEGER32 = 0x04
    UNSIGNED8 = 0x05
    UNSIGNED16 = 0x06
    UNSIGNED32 = 0x07
    REAL32 = 0x08
    VISIBLE_STRING = 0x09
    OCTET_STRING = 0x0A
    DOMAIN = 0x0F
    INTEGER64 = 0x15
    UNSIGNED64 = 0x1B


#: struct letter of the types with a fixed length
LETTERS = {
    DataType.BOOLEAN: "B",
    DataType.INTEGER8: "b",
    DataType.INTEGER16: "h",
    DataType.INTEGER32: "i",
    DataType.UNSIGNED8: "B",
    DataType.UNSIGNED16: "H",
    DataType.UNSIGNED32: "I",
    DataType.REAL32: "f",
    DataType.INTEGER64: "q",
    DataType.UNSIGNED64: "Q",
}
_STRUCTS = {kind: struct.Struct("<" + letter) for kind, letter in LETTERS.items()}


def size_bytes(kind: DataType) -> int | None:
    """Length of the type's values, or None where it varies."""
    layout = _STRUCTS.get(kind)
    return None if layout is None else layout.size


def limits(kind: DataType) -> tuple[int, int] | None:
    """Smallest and largest value of an integer type, None for the others."""
    if kind is DataType.BOOLEAN:
        return 0, 1
    if kind is DataType.REAL32 or kind not in _STRUCTS:
        return None
    bits = 8 * _STRUCTS[kind].size
    signed = LETTERS[kind].islower()
    return (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)


def encode(kind: DataType, value: Value) -> bytes:
    """Bytes of a value.

    Raises
    ------
    ValueError
        The value is not one of the type.
    """
    layout = _STRUCTS.get(kind)
    if layout is None:
        if isinstance(value, str):
            return value.encode("ascii", errors="strict")
        if isinstance(value, bytes):
            return value
        raise ValueError(f"{value!r} is not a {kind.name}")
    try:
        return layout.pack(value)
    except (struct.error, OverflowError) as error:
        raise ValueError(f"{value!r} is not a {kind.name}: {error}") from error


def decode(kind: DataType, data: bytes) -> Value:
    """Value of bytes.

    Raises
    ------
    ValueError
        Wrong number of bytes, a text that is not ASCII, or a number that is not finite.
    """
    layout = _STRUCTS.get(kind)
    if layout is None:
        return data.decode("ascii") if kind is DataType.VISIBLE_STRING else bytes(data)
    if len(data) != layout.size:
        raise ValueError(f"{kind.name} has {layout.size} bytes, not {len(data)}")
    (value,) = layout.unpack(data)
    if kind is DataType.REAL32 and not math.isfinite(value):
        raise ValueError("not a finite number")
    return value

"""Objects of a CANopen dictionary as settings name them, and their bytes.

Job: `ObjectRef` ("6300h:1 i16"), packing and unpacking of values, and `PdoCodec` (several objects in one
frame) by plain `struct`. Not its job: transferring them (`drivers.can.canopen_node`).
"""

from __future__ import annotations

import math
import re
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import BeforeValidator
from pydantic_core import PydanticCustomError

from rigctl.core.errors import DeviceError

TYPES = {"u8": "B", "i8": "b", "u16": "H", "i16": "h", "u32": "I", "i32": "i", "f32": "f", "u64": "Q"}
_PATTERN = re.compile(r"(?:0x)?([0-9a-fA-F]{4})h?(?::([0-9a-fA-F]{1,2}))?\s+(\w+)")


@dataclass(frozen=True, slots=True)
class ObjectRef:
    """One entry of an object dictionary.

    Attributes
    ----------
    index, sub : int
    kind : str
        One of `TYPES`.
    """

    index: int
    sub: int
    kind: str

    def __str__(self) -> str:
        return f"{self.index:04X}h:{self.sub:X}"

    @property
    def size(self) -> int:
        """Bytes."""
        return struct.calcsize("<" + TYPES[self.kind])

    @property
    def limits(self) -> tuple[float, float]:
        """Smallest and largest value."""
        if self.kind == "f32":
            return -3.4028234e38, 3.4028234e38
        bits = 8 * self.size
        return (0, 2**bits - 1) if self.kind[0] == "u" else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)

    @property
    def mapping(self) -> int:
        """The 32 bits that name it in a PDO mapping (CiA 301): index, sub-index, length in bits."""
        return self.index << 16 | self.sub << 8 | 8 * self.size

    def pack(self, value: float) -> bytes:
        """Bytes on the wire, little endian.

        Raises
        ------
        ValueError
            The value does not fit the type.
        """
        low, high = self.limits
        if not math.isfinite(value) or not low <= value <= high:
            raise ValueError(f"{value!r} does not fit {self} ({self.kind})")
        return struct.pack("<" + TYPES[self.kind], value if self.kind == "f32" else int(value))

    def unpack(self, data: bytes) -> Any:
        """Value of exactly `size` bytes.

        Raises
        ------
        ValueError
            The length is another.
        """
        if len(data) != self.size:
            raise ValueError(f"{self} has {len(data)} bytes instead of {self.size} ({self.kind})")
        return struct.unpack("<" + TYPES[self.kind], data)[0]


def parse_object(value: Any) -> ObjectRef:
    """``"6300h:1 i16"`` or ``"0x6040 u16"``: index in hex, sub-index in hex (0 if none), type.

    Raises
    ------
    PydanticCustomError
        It is written in another way.
    """
    if isinstance(value, ObjectRef):
        return value
    match = _PATTERN.fullmatch(value.strip()) if isinstance(value, str) else None
    if match is None or match[3] not in TYPES:
        raise PydanticCustomError(
            "canopen_object",
            "{value} names no object of a CANopen dictionary",
            {
                "value": repr(value),
                "remedy": f'Write "6300h:1 i16": index, sub-index, type ({", ".join(TYPES)}).',
            },
        )
    return ObjectRef(int(match[1], 16), int(match[2] or "0", 16), match[3])


ObjectSetting = Annotated[ObjectRef, BeforeValidator(parse_object)]
"""Type of a field of a pydantic model that holds an object."""


class PdoCodec:
    """Values of several objects in one frame, in the order of the mapping.

    Parameters
    ----------
    objects : sequence of ObjectRef
        At most 8 bytes together.
    """

    def __init__(self, objects: Sequence[ObjectRef]) -> None:
        self.objects = tuple(objects)
        self._struct = struct.Struct("<" + "".join(TYPES[entry.kind] for entry in self.objects))
        if self._struct.size > 8:
            raise ValueError(f"{self._struct.size} bytes do not fit a PDO of 8")
        self.size = self._struct.size
        self.pack = self._struct.pack
        """pack(*values) -> bytes"""

    def unpack(self, data: bytes) -> tuple[Any, ...] | None:
        """Values of a frame; None when its length is wrong, so that no part of it becomes a value."""
        return self._struct.unpack(data) if len(data) == self._struct.size else None


@dataclass(frozen=True, slots=True)
class Scaling:
    """Counts of an object and its physical value: value = counts · full_scale / full_scale_counts.

    Attributes
    ----------
    full_scale : float
        Physical value at `full_scale_counts`.
    full_scale_counts : int
    """

    full_scale: float
    full_scale_counts: int

    def to_counts(self, value: float, place: str) -> int:
        """Nearest counts of a value between 0 and full scale.

        Raises
        ------
        DeviceError
            The value is not finite or outside.
        """
        if not math.isfinite(value) or not 0.0 <= value <= self.full_scale:
            raise DeviceError(
                f"refuses the set-point {value}.", place=place, value=value,
                remedy=f"Set-points must lie between 0 and {self.full_scale:g}.",
            )  # fmt: skip
        return round(value / self.full_scale * self.full_scale_counts)

    def to_value(self, counts: int) -> float:
        """Physical value of counts."""
        return counts * self.full_scale / self.full_scale_counts

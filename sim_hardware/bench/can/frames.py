"""A CAN frame as the emulated nodes see it, the identifiers of CiA 301, and the candump line of a frame.

Job: words. Not its job: any protocol on top, and the bus itself.
"""

from __future__ import annotations

from typing import NamedTuple

NMT = 0x000
SYNC = 0x080
EMCY = 0x080
TPDO = (0x180, 0x280, 0x380, 0x480)
RPDO = (0x200, 0x300, 0x400, 0x500)
SDO_TO_CLIENT = 0x580
SDO_TO_SERVER = 0x600
HEARTBEAT = 0x700

HIGHEST_NODE = 127
HIGHEST_COB_ID = 0x7FF
MAX_BYTES = 8

#: Identifiers that CiA 301 (table "restricted CAN-IDs") forbids for configurable objects, as closed ranges.
RESTRICTED = (
    (0x000, 0x07F), (0x101, 0x180), (0x581, 0x5FF), (0x601, 0x67F), (0x6E0, 0x6FF), (0x701, 0x77F),
    (0x780, 0x7FF),
)  # fmt: skip


class Frame(NamedTuple):
    """A classic CAN frame with an 11-bit identifier."""

    cob_id: int
    data: bytes = b""
    remote: bool = False


def is_restricted(cob_id: int) -> bool:
    """Whether CiA 301 keeps this identifier from PDOs and emergencies."""
    return any(low <= cob_id <= high for low, high in RESTRICTED)


def candump_line(t_s: float, frame: Frame, channel: str = "can0") -> str:
    """The frame as a line of a `candump -L` log: ``(1.000000) can0 701#05``; remote frames end in ``#R``."""
    payload = "R" if frame.remote else frame.data.hex().upper()
    return f"({t_s:.6f}) {channel} {frame.cob_id:03X}#{payload}"


def parse_candump_line(line: str) -> tuple[float, Frame]:
    """The inverse of `candump_line`.

    Raises
    ------
    ValueError
        The line is not of a `candump -L` log of classic frames.
    """
    parts = line.split()
    if len(parts) < 3 or not (parts[0].startswith("(") and parts[0].endswith(")")) or "#" not in parts[2]:
        raise ValueError(f"not a line of a candump log: {line!r}")
    identifier, payload = parts[2].split("#", 1)
    remote = payload.startswith("R")
    data = b"" if remote else bytes.fromhex(payload)
    if len(data) > MAX_BYTES:
        raise ValueError(f"more than 8 bytes in {line!r}")
    return float(parts[0][1:-1]), Frame(int(identifier, 16), data, remote)

"""From PDO bytes to readings at 100 Hz: a small decoder of its own, so that the watchdog trusts no other.

Job: decode one signal, say when a value is no measurement, and make one reading of every 10 ms: the mean of
the values in it, else the newest value while it is young enough, else None. Standard library only, no clock:
times are arguments. Not its job: the bus (`drivers.safety_io.watchdog_link`).
"""

from __future__ import annotations

import struct
from math import isfinite
from typing import Final

from drivers.safety_io.settings import TYPES, SignalSettings

# NAMUR NE 43, µA: below and above these the loop or its transmitter is at fault.
LOOP_LOW_UA: Final = 3800
LOOP_HIGH_UA: Final = 20500
# Ends of the range stand for "no value" (CiA 404) or for a converter at its stop.
NEVER_MEASURED: Final = {
    "i16": (-0x8000, 0x7FFF),
    "i32": (-0x8000_0000, 0x7FFF_FFFF),
    "u32": (0xFFFF_FFFF,),
}


class SignalDecoder:
    """One signal of one PDO.

    Attributes
    ----------
    cob_id : int
    frames, short_frames, invalid_values : int
        Counts since the start.
    """

    def __init__(self, settings: SignalSettings) -> None:
        self.cob_id = settings.cob_id
        self._length = settings.length
        self._unpack = struct.Struct(TYPES[settings.type]).unpack_from
        self._offset, self._status_offset = settings.offset, settings.status_offset
        self._scale, self._zero = settings.scale, settings.zero
        self._loop = settings.current_loop
        self._never: tuple[int, ...] = NEVER_MEASURED.get(settings.type, ())
        self._stale_ns = round(settings.stale_s * 1e9)
        self._newest: float | None = None
        self._newest_ns: int | None = None
        self._sum = 0.0
        self._count = 0
        self._invalid_now = False
        self.frames = self.short_frames = self.invalid_values = 0

    def value_of(self, data: bytes | bytearray) -> float | None:
        """The value in a PDO, None where it is no measurement. Frames that are too short are none."""
        if len(data) < self._length:
            return None
        raw = self._unpack(data, self._offset)[0]
        if raw in self._never or (self._status_offset >= 0 and data[self._status_offset]):
            return None
        if self._loop and not LOOP_LOW_UA <= raw <= LOOP_HIGH_UA:
            return None
        value = raw * self._scale + self._zero
        return value if isfinite(value) else None

    def take(self, data: bytes | bytearray, t_ns: int) -> None:
        """A PDO has arrived at this time. One that is too short does not count: the signal grows old."""
        if len(data) < self._length:
            self.short_frames += 1
            return
        self.frames += 1
        value = self.value_of(data)
        self._newest, self._newest_ns = value, t_ns
        self._invalid_now = value is None
        if value is None:
            self.invalid_values += 1
        else:
            self._sum += value
            self._count += 1

    def reading(self, end_ns: int) -> float | None:
        """The reading of the 10 ms that end now; the next ones begin."""
        total, count = self._sum, self._count
        self._sum, self._count = 0.0, 0
        if self._newest_ns is None or self._invalid_now or end_ns - self._newest_ns > self._stale_ns:
            return None
        return total / count if count else self._newest

    def age_s(self, now_ns: int) -> float | None:
        """Age of the newest PDO; None before the first."""
        return None if self._newest_ns is None else (now_ns - self._newest_ns) * 1e-9

"""A serial line's speed and character format, and the times at which characters arrive on it.

Job: a pty hands over bytes at once; a wire needs 10 or 11 bit times for each. `Pacer` gives every byte the
time at which its stop bit would have passed. Not its job: parity errors (a pty carries none), faults
(`faults`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

#: Bytes that arrive within this time are handed over together: one wake-up instead of a dozen. It must stay
#: below the 1.75 ms that end a Modbus RTU frame.
GROUP_S = 0.001


class Line(BaseModel):
    """Speed and character format, for example 115200 Bd 8N1."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    baud: Annotated[int, Field(ge=300, le=1_000_000)] = 9600
    data_bits: Literal[7, 8] = 8
    parity: Literal["N", "E", "O"] = "N"
    stop_bits: Literal[1, 2] = 1

    @property
    def character_s(self) -> float:
        """Time of one character: start bit, data, parity and stop bits."""
        bits = 1 + self.data_bits + (self.parity != "N") + self.stop_bits
        return bits / self.baud


@dataclass(frozen=True, slots=True)
class Piece:
    """Bytes on their way: the time at which the last of them has arrived, and when the first has."""

    due_s: float
    first_s: float
    data: bytes


class Pacer:
    """Times of arrival in one direction."""

    def __init__(self, character_s: float) -> None:
        self._character_s = character_s
        self._free_s = 0.0

    def schedule(self, characters: Iterable[tuple[int, float]], now_s: float) -> list[Piece]:
        """Pieces for bytes given at `now_s`; each comes with a silence to keep before it."""
        pieces: list[Piece] = []
        group = bytearray()
        first_s = end_s = max(now_s, self._free_s)
        for value, silence_s in characters:
            start_s = end_s + silence_s
            if group and (silence_s > 0 or start_s + self._character_s - first_s > GROUP_S):
                pieces.append(Piece(end_s, first_s, bytes(group)))
                group.clear()
            end_s = start_s + self._character_s
            if not group:
                first_s = end_s
            group.append(value)
        if group:
            pieces.append(Piece(end_s, first_s, bytes(group)))
        self._free_s = end_s
        return pieces

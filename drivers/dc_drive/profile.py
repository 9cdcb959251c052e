"""The start sequence of drives with control and status words: which control word comes next.

Job: pure functions from wish and status word to control word, and from status word to state. Words and bits
come from the register map. Not its job: registers.
"""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from drivers.dc_drive.words import DriveState, Torque, Wish

Word = Annotated[int, Field(ge=0, le=0xFFFF)]
Bit = Annotated[int, Field(ge=0, le=15)]


class ControlWords(BaseModel):
    """``[control_words]`` of a register map."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    coast: Word
    prepare: Word
    switch_on: Word
    run: Word
    quick_stop: Word
    reset: Word


class StatusBits(BaseModel):
    """``[status_bits]`` of a register map; `remote` may be missing."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    ready_on: Bit
    ready_run: Bit
    running: Bit
    tripped: Bit
    not_quick_stop: Bit
    inhibited: Bit
    alarm: Bit
    remote: Bit | None = None


def has(word: int, bit: int) -> bool:
    """Whether a bit is set."""
    return bool(word >> bit & 1)


def drive_state(status: int, bits: StatusBits) -> DriveState:
    """What the status word says."""
    if has(status, bits.tripped):
        return DriveState.TRIPPED
    if has(status, bits.running):
        return DriveState.RUNNING
    if has(status, bits.inhibited):
        return DriveState.INHIBITED
    if not has(status, bits.not_quick_stop):
        return DriveState.STOPPING
    return DriveState.OFF


def control_word(wish: Wish, status: int, last: int, words: ControlWords, bits: StatusBits) -> int:
    """The next control word.

    Parameters
    ----------
    wish : Wish
    status : int
        Newest status word.
    last : int
        Control word sent before: a reset needs a rising edge.
    words, bits
        From the map.
    """
    if wish.torque is Torque.OFF:
        return words.coast
    if wish.torque is Torque.QUICK_STOP:
        return words.quick_stop
    if has(status, bits.tripped):
        return words.reset if wish.reset and last == words.prepare else words.prepare
    if has(status, bits.inhibited) or not has(status, bits.ready_on):
        return words.prepare
    return words.run if has(status, bits.ready_run) else words.switch_on

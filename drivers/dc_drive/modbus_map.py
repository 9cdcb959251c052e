"""The register map of a Modbus drive: which register carries what, in which form.

Job: frozen model of ``configs/devices/*.toml`` for the kind "modbus", and the coding of values into
registers. Not its job: sending them.
"""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

from drivers.dc_drive.profile import ControlWords, StatusBits

FIRST_HOLDING = 400001
RegisterNumber = Annotated[int, Field(ge=FIRST_HOLDING, le=FIRST_HOLDING + 0xFFFF)]
LIMITS = {"u16": (0, 0xFFFF), "i16": (-0x8000, 0x7FFF), "u32": (0, 0xFFFF_FFFF), "i32": (-(2**31), 2**31 - 1)}


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Register(_Frozen):
    """One value in one or two holding registers; physical value = number / scale.

    Attributes
    ----------
    number : int
        Number as in manuals: 400001 is the first holding register.
    type : str
        "u16", "i16", "u32" or "i32".
    scale : float
        Counts per unit.
    words : str
        Order of the two words of 32-bit values.
    """

    number: RegisterNumber
    type: Literal["u16", "i16", "u32", "i32"] = "u16"
    scale: Annotated[float, Field(gt=0)] = 1.0
    words: Literal["high_first", "low_first"] = "high_first"

    @property
    def address(self) -> int:
        """Address in the frame."""
        return self.number - FIRST_HOLDING

    @property
    def count(self) -> int:
        """Number of registers."""
        return 2 if self.type.endswith("32") else 1

    def encode(self, value: float) -> list[int]:
        """Register contents for a physical value.

        Raises
        ------
        ValueError
            It does not fit.
        """
        low, high = LIMITS[self.type]
        if not math.isfinite(value) or not low <= round(value * self.scale) <= high:
            raise ValueError(f"{value!r} does not fit into register {self.number} ({self.type})")
        raw = round(value * self.scale)
        if self.count == 1:
            return [raw & 0xFFFF]
        pair = [raw >> 16 & 0xFFFF, raw & 0xFFFF]
        return pair if self.words == "high_first" else pair[::-1]

    def decode(self, registers: list[int]) -> float:
        """Physical value of register contents."""
        if len(registers) != self.count:
            raise ValueError(f"register {self.number} takes {self.count} words, not {len(registers)}")
        raw = registers[0]
        if self.count == 2:
            high, low = registers if self.words == "high_first" else registers[::-1]
            raw = high << 16 | low
        if self.type.startswith("i") and raw > LIMITS[self.type][1]:
            raw -= 1 << 16 * self.count
        return raw / self.scale


class Process(_Frozen):
    """Registers of the cycle. Control word and reference lie side by side, status and actual speed too."""

    control: RegisterNumber
    status: RegisterNumber
    full_scale: Annotated[int, Field(ge=100, le=32767)]
    echo: bool = True
    """Whether control word and reference can be read; then every other cycle reads them too."""


class Ramps(_Frozen):
    """Registers of the ramp times, from standstill to full speed."""

    acceleration: Register
    deceleration: Register
    shortest_s: Annotated[float, Field(gt=0)]
    longest_s: Annotated[float, Field(gt=0)]


class Action(_Frozen):
    """What the drive does on loss of communication, by the value of its parameter."""

    value: int
    name: str
    safe: bool


class CommunicationLoss(_Frozen):
    """Settings of the drive's own supervision, read back before it may be enabled."""

    action: Register
    actions: tuple[Action, ...]
    time: Register
    mode: Register | None = None
    modes: tuple[Action, ...] = ()
    remedy: str


class FaultName(_Frozen):
    """Name of a trip code."""

    code: int
    name: str
    resettable: bool = False


class Identity(_Frozen):
    """One line of the identity."""

    name: str
    at: Register
    format: Literal["decimal", "hex"] = "decimal"


class RegisterMap(_Frozen):
    """A map file."""

    maker: str
    model: str
    process: Process
    control_words: ControlWords
    status_bits: StatusBits
    ramps: Ramps
    communication_loss: CommunicationLoss
    speed_scaling: Register | None = None
    trip_code: Register | None = None
    trips: tuple[FaultName, ...] = ()
    identity: tuple[Identity, ...] = ()

"""The tag map of a Eurotherm/Parker 590. Job: frozen model of its TOML file. Not its job: sending."""

from __future__ import annotations

from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

from drivers.dc_drive.bisynch import TAGS, mnemonic
from drivers.dc_drive.profile import Bit, Word


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Parameter(_Frozen):
    """A parameter by its 590+ tag or by its two-character mnemonic."""

    tag: Annotated[int, Field(ge=0, lt=TAGS)] | None = None
    mnemonic: Annotated[str, Field(pattern=r"^[0-9A-Za-z]{2}$")] | None = None

    @model_validator(mode="after")
    def _one(self) -> Self:
        if (self.tag is None) == (self.mnemonic is None):
            raise PydanticCustomError(
                "parameter", "needs either a tag or a mnemonic", {"remedy": "Give one of the two."}
            )
        return self

    @property
    def name(self) -> str:
        """Mnemonic on the wire."""
        if self.mnemonic is not None:
            return self.mnemonic
        assert self.tag is not None
        return mnemonic(self.tag)


class Parameters(_Frozen):
    """Parameters that the driver uses."""

    demand_percent: Parameter
    actual_rpm: Parameter
    acceleration_s: Parameter
    deceleration_s: Parameter
    sequence: Parameter
    sequence_status: Parameter
    health: Parameter
    comms_timeout_s: Parameter
    identity: Parameter | None = None
    software: Parameter | None = None


class SequenceWords(_Frozen):
    """Values of the remote sequencing word."""

    off: Word
    enable: Word
    run: Word
    quick_stop: Word
    reset: Word


class SequenceBits(_Frozen):
    """Bits of the sequencing status."""

    enabled: Bit
    running: Bit
    tripped: Bit


class HealthBit(_Frozen):
    """A bit of the health word that is a trip."""

    bit: Bit
    name: str
    resettable: bool = False


class TagMap(_Frozen):
    """A map file."""

    maker: str
    model: str
    parameters: Parameters
    sequence_words: SequenceWords
    sequence_bits: SequenceBits
    trips: Annotated[tuple[HealthBit, ...], Field(min_length=1)]
    shortest_ramp_s: Annotated[float, Field(gt=0)]
    longest_ramp_s: Annotated[float, Field(gt=0)]
    comms_remedy: str

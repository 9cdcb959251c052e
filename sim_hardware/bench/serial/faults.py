"""The fault seam between port and emulator: bytes are lost, changed, held back, torn apart, doubled, on
purpose.

Job: decide per byte (or per message) which faults strike, from a seed, so that the same bytes meet the same
faults in every run. Faults are data (`Fault`), so that tests and the bench's command socket give them as
JSON. Not its job: time on the wire (`line`), pulling the plug (`ports` does it when it is told), the emulated
device.

A message is what one side sends in one go: the next byte after the line has been idle or has turned round
begins one.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

Direction = Literal["to_device", "to_host"]


class Fault(BaseModel):
    """One fault.

    Attributes
    ----------
    kind : str
        ``drop``, ``corrupt``, ``duplicate``: bytes, or whole messages when `per` says so. ``delay``: silence
        before a message. ``split``: silence before a byte within a message. ``mute``: nothing passes.
    direction : str
        "to_device", "to_host" or "both".
    per : str
        "byte" or "message": what `probability`, `skip` and `count` count.
    probability : float
        Chance of each opportunity.
    skip : int
        Opportunities that pass untouched first.
    count : int or None
        How often it strikes; None is for ever.
    position : int or None
        Only the byte with this index in its message.
    mask : int or None
        Bits that ``corrupt`` flips; None flips one bit at random.
    silence_s : float
        Length of ``delay`` and ``split``.
    for_s : float or None
        It ends after this time by itself.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    kind: Literal["drop", "corrupt", "duplicate", "delay", "split", "mute"]
    direction: Literal["to_device", "to_host", "both"] = "both"
    per: Literal["byte", "message"] = "byte"
    probability: Annotated[float, Field(ge=0, le=1)] = 1.0
    skip: Annotated[int, Field(ge=0)] = 0
    count: Annotated[int, Field(ge=1)] | None = None
    position: Annotated[int, Field(ge=0)] | None = None
    mask: Annotated[int, Field(ge=1, le=255)] | None = None
    silence_s: Annotated[float, Field(ge=0, le=60)] = 0.02
    for_s: Annotated[float, Field(gt=0)] | None = None

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if self.per == "message" and self.kind in {"split", "corrupt"}:
            raise PydanticCustomError(
                "fault",
                "{kind} strikes bytes, not messages",
                {"kind": self.kind, "remedy": 'Leave out per = "message"; position chooses the byte.'},
            )
        return self


class _Active:
    """A fault at work: its random numbers and how often it may still strike."""

    def __init__(self, fault: Fault, seed: str, now_s: float) -> None:
        self.fault = fault
        self._random = random.Random(seed)
        self._seen = 0
        self.struck = 0
        self._ends_s = float("inf") if fault.for_s is None else now_s + fault.for_s

    def over(self, now_s: float) -> bool:
        return now_s >= self._ends_s or (self.fault.count is not None and self.struck >= self.fault.count)

    def strikes(self) -> bool:
        """Decide one opportunity."""
        self._seen += 1
        chance = self._random.random()  # drawn always: what strikes does not depend on `skip`
        if self._seen <= self.fault.skip or chance >= self.fault.probability:
            return False
        self.struck += 1
        return True

    def flip(self, value: int) -> int:
        """The byte with bits flipped."""
        mask = self.fault.mask
        return value ^ (1 << self._random.randrange(8) if mask is None else mask)


class FaultSeam:
    """All faults of one port, for both directions."""

    def __init__(self, seed: int = 0) -> None:
        self._seed = seed
        self._next_id = 1
        self._active: dict[int, _Active] = {}
        self._index: dict[Direction, int] = {"to_device": 0, "to_host": 0}
        self._message_lost: dict[Direction, set[int]] = {"to_device": set(), "to_host": set()}
        self.counts: dict[str, int] = {}

    def add(self, fault: Fault | Mapping[str, Any], now_s: float = 0.0) -> int:
        """Put a fault to work; returns its number."""
        fault = fault if isinstance(fault, Fault) else Fault.model_validate(fault)
        number, self._next_id = self._next_id, self._next_id + 1
        self._active[number] = _Active(fault, f"{self._seed}/{number}", now_s)
        return number

    def clear(self, number: int | None = None) -> None:
        """Take one fault away, or all."""
        if number is None:
            self._active.clear()
        else:
            self._active.pop(number, None)

    def describe(self, now_s: float = 0.0) -> list[dict[str, Any]]:
        """The faults still at work, as JSON can carry them."""
        return [
            {"id": number, "struck": active.struck, **active.fault.model_dump(exclude_none=True)}
            for number, active in self._active.items()
            if not active.over(now_s)
        ]

    def apply(
        self, data: bytes, direction: Direction, *, begins: bool, now_s: float = 0.0
    ) -> list[tuple[int, float]]:
        """What comes out at the other side: bytes, each with the silence to keep before it.

        Parameters
        ----------
        data : bytes
            What was sent.
        direction : str
            Which way.
        begins : bool
            Whether the first byte begins a message.
        now_s : float
            Time, for faults that end.
        """
        faults = {
            number: active
            for number, active in self._active.items()
            if active.fault.direction in {direction, "both"} and not active.over(now_s)
        }
        result: list[tuple[int, float]] = []
        copies = 1
        silence_s = 0.0
        lost = self._message_lost[direction]
        for position, value in enumerate(data):
            if begins and position == 0:
                self._index[direction] = 0
                lost.clear()
                for number, active in faults.items():
                    silence_s += self._begin(number, active, lost)
                    if active.fault.kind == "duplicate" and number in lost:
                        copies = 2
                        lost.discard(number)
            index, self._index[direction] = self._index[direction], self._index[direction] + 1
            characters = [value]
            for active in faults.values():
                characters, extra_s = self._byte(active, characters, index, now_s)
                silence_s += extra_s
            if lost:
                characters = []
            for character in characters:
                result.append((character, silence_s))
                silence_s = 0.0
        return result * copies

    def _begin(self, number: int, active: _Active, lost: set[int]) -> float:
        """Faults that strike messages; returns the silence before it."""
        fault = active.fault
        if fault.kind == "delay":
            return self._count(fault.kind) * fault.silence_s if active.strikes() else 0.0
        if (fault.per == "message" or fault.kind == "mute") and active.strikes():
            self._count(fault.kind)
            lost.add(number)
        return 0.0

    def _byte(
        self, active: _Active, characters: list[int], index: int, now_s: float
    ) -> tuple[list[int], float]:
        """Faults that strike bytes: the bytes that remain, and the silence before them."""
        fault = active.fault
        spared = (
            fault.kind in {"delay", "mute"}
            or fault.per == "message"
            or active.over(now_s)
            or (fault.position is not None and index != fault.position)
            or (fault.kind == "split" and index == 0)
        )
        if spared or not active.strikes():
            return characters, 0.0
        self._count(fault.kind)
        if fault.kind == "split":
            return characters, fault.silence_s
        if fault.kind == "corrupt":
            return [active.flip(character) for character in characters], 0.0
        return characters * (2 if fault.kind == "duplicate" else 0), 0.0

    def _count(self, kind: str) -> int:
        self.counts[kind] = self.counts.get(kind, 0) + 1
        return 1

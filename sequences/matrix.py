"""A sequence: temperatures x speed profiles x pressures, the dialog of the paper's Fig. 5 as data.

Job: hold the lists and the way they are worked through, refuse what makes no sense, and expand to brakings
as a pure function. Not the job: the rig's limits (``check``), files (``program``), execution (the engine).
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal, Self, TypeVar, cast

from pydantic import AfterValidator, BeforeValidator, Field, model_validator

from sequences.braking import (
    AXES,
    Axis,
    Braking,
    Conditioning,
    Counting,
    LoopIndices,
    Recording,
    Role,
    TemperatureLimits,
)
from sequences.fields import Data, PauseS, PressureBar, SafeName, TemperatureDegc, refuse
from sequences.pressure import ConstantPressure, PressureFunction
from sequences.profiles import SpeedProfile
from sequences.ranges import MAX_VALUES, expand_range
from sequences.sense import require_sense

Table = Mapping[str, Any]
Values = TypeVar("Values", bound=tuple[Any, ...])


def _numbers(value: Any) -> Any:
    return expand_range(cast(Table, value)) if isinstance(value, Mapping) else value


def _profiles(value: Any) -> Any:
    """A range of constant speeds: ``{ from = 20, to = 100, step = 20, duration_s = 12 }``."""
    if not isinstance(value, Mapping):
        return value
    if "duration_s" not in value:
        raise refuse(
            "range_keys",
            "a range of speeds without duration_s",
            "write { from = 20, to = 100, step = 20, duration_s = 12 }, or a list of speed profiles",
        )
    table = dict(cast(Table, value))
    duration_s = table.pop("duration_s")
    speeds = expand_range(table)
    return [{"duration_s": duration_s, "start_rpm": n, "end_rpm": n} for n in speeds]


def _not_empty(values: Values) -> Values:
    if not values:
        raise refuse("empty_list", "zero brakings: the list is empty", "give at least one value")
    return values


def _each_loop_once(order: tuple[Axis, Axis, Axis]) -> tuple[Axis, Axis, Axis]:
    if sorted(order) != sorted(AXES):
        raise refuse(
            "loop_order",
            "{value} does not name each loop once",
            "write temperature, speed and pressure in the wanted order, outermost first",
            ", ".join(order),
        )
    return order


_Length = Field(max_length=MAX_VALUES)
Temperatures = Annotated[tuple[TemperatureDegc, ...], BeforeValidator(_numbers), _Length]
Profiles = Annotated[
    tuple[SpeedProfile, ...], BeforeValidator(_profiles), _Length, AfterValidator(_not_empty)
]
Pressures = Annotated[tuple[PressureBar, ...], BeforeValidator(_numbers), _Length, AfterValidator(_not_empty)]
LoopOrder = Annotated[tuple[Axis, Axis, Axis], AfterValidator(_each_loop_once)]


class Sequence(Data):
    """Brakings over lists of set-points.

    ``processing = "loops"`` ('schleifenweise'): every combination, nested by `loop_order`, outermost first.
    ``processing = "lists"``: the k-th entries together; a list of length 1 holds for all. `repeat` does the
    whole again. Without conditioning there are no temperatures.
    """

    name: SafeName
    role: Role
    enabled: bool = True
    repeat: Counting = 1
    temperatures_degc: Temperatures = ()
    speed_profiles: Profiles
    pressures_bar: Pressures
    loop_order: LoopOrder = AXES
    processing: Literal["loops", "lists"] = "loops"
    pressure_function: PressureFunction = ConstantPressure()
    conditioning: Conditioning = Conditioning()
    limits: TemperatureLimits = TemperatureLimits()
    recording: Recording
    dwell_s: PauseS = 0.0
    ventilator: bool = False

    @model_validator(mode="after")
    def _makes_sense(self) -> Self:
        require_sense(self)
        return self

    @property
    def count(self) -> int:
        """Number of brakings, without expanding them; 0 if the sequence is switched off."""
        if not self.enabled:
            return 0
        sizes = self.sizes
        once = max(sizes.values()) if self.processing == "lists" else math.prod(sizes.values())
        return once * self.repeat

    @property
    def sizes(self) -> dict[Axis, int]:
        """Lengths of the three loops; unconditioned temperature counts as one."""
        return {
            "temperature": len(self.temperatures_degc) if self.conditioning.enabled else 1,
            "speed": len(self.speed_profiles),
            "pressure": len(self.pressures_bar),
        }


def loop_indices(sequence: Sequence) -> Iterator[LoopIndices]:
    """Yield the places in the three lists, in the order of one repetition."""
    sizes = sequence.sizes
    if sequence.processing == "lists":
        for k in range(max(sizes.values())):
            yield LoopIndices(**{axis: min(k, size - 1) for axis, size in sizes.items()})
        return
    for places in itertools.product(*(range(sizes[axis]) for axis in sequence.loop_order)):
        yield LoopIndices(**dict(zip(sequence.loop_order, places, strict=True)))


def brakings(sequence: Sequence, first_index: int = 1) -> Iterator[Braking]:
    """Expand `sequence` to its brakings, numbered from `first_index`. Pure: the same in, the same out.

    A sequence that is switched off yields nothing. Brakings are made one at a time, never all at once.
    """
    if not sequence.enabled:
        return
    number = 0
    for repetition in range(1, sequence.repeat + 1):
        for loop in loop_indices(sequence):
            number += 1
            yield Braking(
                index=first_index + number - 1,
                sequence=sequence.name,
                role=sequence.role,
                index_in_sequence=number,
                repetition=repetition,
                loop=loop,
                temperature_degc=(
                    sequence.temperatures_degc[loop.temperature] if sequence.conditioning.enabled else None
                ),
                pressure_bar=sequence.pressures_bar[loop.pressure],
                speed_profile=sequence.speed_profiles[loop.speed],
                pressure_function=sequence.pressure_function,
                conditioning=sequence.conditioning,
                limits=sequence.limits,
                recording=sequence.recording,
                dwell_s=sequence.dwell_s,
                ventilator=sequence.ventilator,
            )

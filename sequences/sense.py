"""What a sequence must fulfil as a whole; the refusals that no single field can decide.

Job: one function per rule, each returning the error (with value and remedy) or None. Not the job: bounds of
single values (``fields``) and the limits of a rig (``check``).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from pydantic_core import PydanticCustomError

from sequences.fields import refuse

if TYPE_CHECKING:
    from sequences.matrix import Sequence

MAX_BRAKINGS = 100_000


def require_sense(sequence: Sequence) -> None:
    """Raise the first rule that `sequence` breaks, as ``PydanticCustomError``."""
    for rule in (_temperature_use, _lengths, _too_many, _too_hot, _negative_pressure, _rise):
        problem = rule(sequence)
        if problem is not None:
            raise problem


def _temperature_use(sequence: Sequence) -> PydanticCustomError | None:
    if sequence.conditioning.enabled and not sequence.temperatures_degc:
        return refuse(
            "empty_list",
            "zero brakings: {value} is empty",
            "give at least one temperature, or set conditioning.enabled = false to brake at whatever"
            " temperature the disc has",
            "temperatures_degc",
        )
    if not sequence.conditioning.enabled and sequence.temperatures_degc:
        return refuse(
            "temperatures_unused",
            "temperatures_degc has {value} entries, but conditioning is off",
            "set conditioning.enabled = true, or remove temperatures_degc",
            len(sequence.temperatures_degc),
        )
    return None


def _lengths(sequence: Sequence) -> PydanticCustomError | None:
    sizes = sequence.sizes
    if sequence.processing == "loops" or len({n for n in sizes.values() if n != 1}) <= 1:
        return None
    text = ", ".join(f"{n} of {axis}" for axis, n in sizes.items())
    return refuse(
        "unequal_lists",
        "list-wise processing of lists of unequal length: {value}",
        'make the lists equally long (or of length 1), or use processing = "loops" for all combinations',
        text,
    )


def _too_many(sequence: Sequence) -> PydanticCustomError | None:
    if sequence.count <= MAX_BRAKINGS:
        return None
    return refuse(
        "too_many_brakings",
        "{value} brakings are more than {most}",
        "shorten the lists or the repetition; split the work into several programs",
        sequence.count,
        most=MAX_BRAKINGS,
    )


def _too_hot(sequence: Sequence) -> PydanticCustomError | None:
    hottest = max(sequence.temperatures_degc, default=None)
    if hottest is None or hottest <= sequence.limits.max_degc:
        return None
    return refuse(
        "set_point_above_limit",
        "temperatures_degc: {value} degC is above limits.max_degc = {most}",
        "lower the temperature, or raise limits.max_degc if brake and rig allow it",
        hottest,
        most=sequence.limits.max_degc,
    )


def _negative_pressure(sequence: Sequence) -> PydanticCustomError | None:
    lowest = min(sequence.pressures_bar)
    if sequence.pressure_function.min_bar(lowest) >= 0:
        return None
    return refuse(
        "negative_pressure",
        "pressures_bar: the working point {value} bar less the amplitude is {low} bar",
        "raise the working point or reduce the amplitude: the pressure cannot be negative",
        lowest,
        low=sequence.pressure_function.min_bar(lowest),
    )


def _rise(sequence: Sequence) -> PydanticCustomError | None:
    shortest_s = min(profile.duration_s for profile in sequence.speed_profiles)
    if sequence.pressure_function.rise_s < shortest_s:
        return None
    return refuse(
        "rise_too_long",
        "pressure_function.rise_s = {value} is not shorter than the braking of {shortest_s} s",
        "shorten rise_s or lengthen the braking",
        sequence.pressure_function.rise_s,
        shortest_s=shortest_s,
    )

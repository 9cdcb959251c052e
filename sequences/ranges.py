"""Range tables: ``{ from = 2, to = 30, step = 2 }`` or ``{ from = 2, to = 30, count = 15 }`` as a list.

Job: expand such a table exactly, or say what is wrong with it. Both ends belong to the range; a step that
does not land on the end is refused instead of silently dropping the end. Not the job: units and bounds of
the values, which the list's own type checks afterwards.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from sequences.fields import refuse

MAX_VALUES = 1000
_LARGEST = 1e12  # beyond every bound of a list's values; also refuses nan, inf and endless integers
_SHAPE = "write { from = 2, to = 30, step = 2 } or { from = 2, to = 30, count = 15 }"


def expand_range(table: Mapping[str, Any]) -> list[float]:
    """Expand a range table to the list of its values, both ends included.

    Parameters
    ----------
    table : mapping
        ``from``, ``to`` and one of ``step`` (magnitude, > 0) or ``count`` (>= 1).

    Returns
    -------
    list of float, shape (n,)
        Ascending or descending from ``from`` to ``to``; n <= ``MAX_VALUES``.

    Raises
    ------
    pydantic_core.PydanticCustomError
        With a remedy, for every table that does not describe such a list.
    """
    keys = set(table)
    if keys not in ({"from", "to", "step"}, {"from", "to", "count"}):
        found = ", ".join(sorted(map(str, keys))) or "nothing"
        raise refuse("range_keys", "a range with {value} is not understood", _SHAPE, found)
    start, stop = _number(table, "from"), _number(table, "to")
    intervals = _intervals_from_count(table, start, stop) if "count" in keys else _by_step(table, start, stop)
    if intervals == 0:
        return [start]
    inner = [_tidy(start + (stop - start) * i / intervals) for i in range(1, intervals)]
    return [start, *inner, stop]


def _number(table: Mapping[str, Any], key: str) -> float:
    value = table[key]
    if not isinstance(value, bool) and isinstance(value, int | float) and abs(value) <= _LARGEST:
        return float(value)
    raise refuse(
        "range_number", "range: {key} = {value} is not a number to use", _SHAPE, repr(value)[:40], key=key
    )


def _intervals_from_count(table: Mapping[str, Any], start: float, stop: float) -> int:
    count = table["count"]
    if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= MAX_VALUES:
        raise refuse(
            "range_count",
            "range: count = {value} is not a whole number from 1 to {most}",
            _SHAPE,
            repr(count)[:40],
            most=MAX_VALUES,
        )
    if (count == 1) != (start == stop):
        raise refuse(
            "range_count",
            "range: count = {value} does not fit the two ends",
            "use count = 1 only with equal ends, and count >= 2 with different ends",
            count,
        )
    return count - 1


def _by_step(table: Mapping[str, Any], start: float, stop: float) -> int:
    step = _number(table, "step")
    if step <= 0:
        raise refuse(
            "range_step",
            "range: step = {value} is not above 0",
            "give the magnitude of the step; for a descending range let 'from' be the larger end",
            step,
        )
    steps = abs(stop - start) / step
    if steps >= MAX_VALUES:
        raise refuse(
            "range_step",
            "range: step = {value} makes more than {most} values",
            "use a larger step",
            step,
            most=MAX_VALUES,
        )
    if abs(steps - round(steps)) > 1e-6:
        last = _tidy(start + math.copysign(math.floor(steps) * step, stop - start))
        raise refuse(
            "range_step",
            "range: step = {value} does not land on the end",
            f"use to = {last:g}, or give 'count' instead of 'step'",
            step,
        )
    return round(steps)


def _tidy(value: float) -> float:
    """Remove the last bits of rounding, so that 0.1 + 0.2 is written 0.3."""
    return float(f"{value:.12g}")

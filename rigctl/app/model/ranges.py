"""Ranges of quantities on the command line: NAME:FROM:TO:COUNT.

Job: one way to write a range for all `rigctl model` commands, with errors that teach it. NOT its job: knowing
which quantities a model has (the model says so when it is asked).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

from rigctl.core.errors import ConfigError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

RANGE_METAVAR = "NAME:FROM:TO:COUNT"
#: most values of one range; more is a slip of the keyboard
MOST_VALUES = 1_000_000
_EXAMPLE = "For example mu:0:1:128 (128 values from 0 to 1) or pressure:0:30:61 (bar)."


def parse_range(text: str, place: str = "range") -> tuple[str, NDArray[np.float64]]:
    """Name and values of a range such as "mu:0:1:128".

    Parameters
    ----------
    text : NAME:FROM:TO:COUNT; COUNT evenly spaced values, both ends included. FROM may be larger than TO.
        A single value is NAME:VALUE:VALUE:1.
    place : what the error names, "--x"

    Returns
    -------
    name, values
        values of shape (COUNT,), in the quantity's unit

    Raises
    ------
    ConfigError
        not of that form, or a range without extent
    """

    def refuse(problem: str) -> ConfigError:
        return ConfigError(problem, place=place, value=text, remedy=_EXAMPLE)

    parts = [part.strip() for part in text.rsplit(":", 3)]  # names of variations have a colon of their own
    if len(parts) != 4 or not _is_name(parts[0]):
        raise refuse(f"is not {RANGE_METAVAR}.")
    name = parts[0]
    first, last = _ends(parts[1], parts[2], refuse)
    try:
        count = int(parts[3])
    except ValueError:
        raise refuse("COUNT must be a whole number.") from None
    if not 1 <= count <= MOST_VALUES:
        raise refuse(f"COUNT must be from 1 to {MOST_VALUES}.")
    if count == 1 and first != last:
        raise refuse("a range of COUNT 1 needs FROM equal to TO.")
    if count > 1 and first == last:
        raise refuse("FROM and TO are equal: a range needs an extent.")
    import numpy as np

    return name, np.linspace(first, last, count)


def parse_search(text: str, place: str = "range") -> tuple[str, tuple[float, float] | None]:
    """Name and range of "mu:0:1", or the name alone and None.

    Raises
    ------
    ConfigError
        not NAME or NAME:FROM:TO
    """

    def refuse(problem: str) -> ConfigError:
        return ConfigError(problem, place=place, value=text, remedy="For example mu:0:1, or pressure.")

    parts = [part.strip() for part in text.rsplit(":", 2)]
    if len(parts) == 3 and _is_number(parts[1]) and _is_number(parts[2]) and _is_name(parts[0]):
        first, last = _ends(parts[1], parts[2], refuse)
        if first == last:
            raise refuse("FROM and TO are equal: a range needs an extent.")
        return parts[0], (first, last)
    if not _is_name(text):
        raise refuse("is not NAME or NAME:FROM:TO.")
    return text.strip(), None


def _is_name(text: str) -> bool:
    return all(part.strip() and not _is_number(part) for part in text.split(":"))


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _ends(first: str, last: str, refuse: Callable[[str], ConfigError]) -> tuple[float, float]:
    if not (_is_number(first) and _is_number(last)):
        raise refuse("FROM and TO must be numbers.")
    ends = float(first), float(last)
    if not (math.isfinite(ends[0]) and math.isfinite(ends[1])):
        raise refuse("FROM and TO must be finite numbers.")
    return ends

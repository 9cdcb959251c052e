"""Two campaigns of one program beside each other: braking by braking, against stated tolerances.

Job: `compare` pairs the brakings of two campaigns by their number, takes the differences of named results,
and says where they exceed what a `Tolerances` file allows. Uses: the same program on another rig, with other
pads, before and after a change; a rig against its simulation. Not its job: reading samples, statistics over
one campaign (`summary`, `occurrence`), printing.

A pair agrees in a quantity when ``|B - A| <= absolute + relative * |A|``; brakes scatter from stop to stop,
so the means over all pairs may have a narrower tolerance of their own. Brakings that do not count
(incomplete, excluded) are not compared, and a braking that counts in one campaign only is a disagreement:
nothing passes because it is missing.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, field_validator

from rigctl.analysis.campaign_table import BrakingRow, CampaignTable
from rigctl.config.loading import load_model
from rigctl.core.errors import RecordingError

_SET = ("set_pressure_bar", "set_temperature_degc", "duration_s")  # ordered, not found


def quantities() -> tuple[str, ...]:
    """Results of a braking that can be compared: numbers of `BrakingRow` with their unit in the name."""
    return tuple(
        item.name for item in fields(BrakingRow) if item.type == (float | None) and item.name not in _SET
    )


class Tolerance(BaseModel):
    """What the two brakings of a pair may differ by: ``absolute + relative * |A|``.

    Attributes
    ----------
    absolute : float
        In the unit of the quantity.
    relative : float
        Share of the first campaign's value.
    mean : float or None
        What the means over all pairs may differ by, in the unit of the quantity; None: not judged.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    absolute: float = Field(ge=0.0)
    relative: float = Field(default=0.0, ge=0.0, le=1.0)
    mean: float | None = Field(default=None, ge=0.0)

    def allowed(self, value: float) -> float:
        """The largest difference from this value."""
        return self.absolute + self.relative * abs(value)


class Tolerances(BaseModel):
    """A file of tolerances.

    Attributes
    ----------
    squeal_may_differ : int
        So many brakings may squeal in one campaign and not in the other (close to the onset chance decides).
    quantities : mapping
        Name of a result -> `Tolerance`. Others are not compared.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    squeal_may_differ: int = Field(default=0, ge=0)
    quantities: dict[str, Tolerance] = Field(min_length=1)

    @field_validator("quantities")
    @classmethod
    def _known(cls, value: dict[str, Tolerance]) -> dict[str, Tolerance]:
        known = quantities()
        for name in value:
            if name not in known:
                raise ValueError(f"{name!r} is no result of a braking; there are: {', '.join(known)}")
        return value


def read_tolerances(path: Path) -> Tolerances:
    """Load a file of tolerances.

    Raises
    ------
    ConfigError
        Names file, key, value and remedy.
    """
    return load_model(path, Tolerances)


@dataclass(frozen=True, slots=True)
class Compared:
    """One quantity over all pairs that have it.

    Attributes
    ----------
    name : str
    pairs : int
    mean_a, mean_b : float
        Over the pairs; NaN without any.
    worst : float
        B - A of the pair that uses most of its tolerance; NaN without any.
    worst_index : int or None
        Number of that braking.
    allowed : float
        Tolerance of that pair.
    outside : tuple of int
        Brakings beyond their tolerance, or with a value in one campaign only.
    mean_allowed : float or None
        Tolerance of the means; None where there is none.
    """

    name: str
    pairs: int
    mean_a: float
    mean_b: float
    worst: float
    worst_index: int | None
    allowed: float
    outside: tuple[int, ...]
    mean_allowed: float | None

    @property
    def means_agree(self) -> bool:
        """Whether the means are within their tolerance, where they have one."""
        if self.mean_allowed is None or not self.pairs:
            return True
        return abs(self.mean_b - self.mean_a) <= self.mean_allowed

    @property
    def agrees(self) -> bool:
        """Whether all pairs and the means do."""
        return not self.outside and self.means_agree


@dataclass(frozen=True, slots=True)
class Comparison:
    """What was found.

    Attributes
    ----------
    pairs : int
        Brakings that count in both campaigns.
    only_a, only_b : tuple of int
        Brakings that count in one only.
    squeal_differs : tuple of int
        Brakings that squeal in one only.
    squeal_may_differ : int
        Of the tolerances.
    quantities : tuple of Compared
    """

    pairs: int
    only_a: tuple[int, ...]
    only_b: tuple[int, ...]
    squeal_differs: tuple[int, ...]
    squeal_may_differ: int
    quantities: tuple[Compared, ...]

    @property
    def agree(self) -> bool:
        """Whether the two campaigns agree within the tolerances."""
        return (
            self.pairs > 0
            and not (self.only_a or self.only_b)
            and len(self.squeal_differs) <= self.squeal_may_differ
            and all(entry.agrees for entry in self.quantities)
        )


def compare(a: CampaignTable, b: CampaignTable, tolerances: Tolerances) -> Comparison:
    """Compare two campaigns.

    Parameters
    ----------
    a : CampaignTable
        The reference: relative tolerances are shares of its values.
    b : CampaignTable
    tolerances : Tolerances

    Raises
    ------
    RecordingError
        The two are not of one program: a braking has other set-points there.
    """
    rows_a, rows_b = ({row.index: row for row in table.complete()} for table in (a, b))
    both = sorted(rows_a.keys() & rows_b.keys())
    for index in both:
        _same_order(rows_a[index], rows_b[index])
    sound = [index for index in both if rows_a[index].counts_for_squeal and rows_b[index].counts_for_squeal]
    differs = tuple(index for index in sound if bool(rows_a[index].squeals) != bool(rows_b[index].squeals))
    pairs = {index: (rows_a[index], rows_b[index]) for index in both}
    return Comparison(
        len(both),
        tuple(sorted(rows_a.keys() - rows_b.keys())),
        tuple(sorted(rows_b.keys() - rows_a.keys())),
        differs,
        tolerances.squeal_may_differ,
        tuple(
            _compared(name, tolerance, pairs, frozenset(differs))
            for name, tolerance in tolerances.quantities.items()
        ),
    )


def _compared(
    name: str,
    tolerance: Tolerance,
    pairs: Mapping[int, tuple[BrakingRow, BrakingRow]],
    squeal_differs: frozenset[int],
) -> Compared:
    found: list[tuple[int, float, float]] = []
    one_only: list[int] = []
    for index, (row_a, row_b) in pairs.items():
        value_a, value_b = getattr(row_a, name), getattr(row_b, name)
        if value_a is not None and value_b is not None:
            found.append((index, value_a, value_b))
        elif (value_a is not None or value_b is not None) and index not in squeal_differs:
            one_only.append(index)  # a squeal in one only has been counted as that
    if not found:
        nan = float("nan")
        return Compared(name, 0, nan, nan, nan, None, nan, tuple(one_only), tolerance.mean)
    numbers = np.array([index for index, _, _ in found])
    values_a, values_b = (np.array(column) for column in zip(*[entry[1:] for entry in found], strict=True))
    allowed = np.array([tolerance.allowed(value) for value in values_a])
    difference = values_b - values_a
    excess = np.abs(difference) - allowed
    worst = int(np.argmax(excess))
    return Compared(
        name,
        len(found),
        float(values_a.mean()),
        float(values_b.mean()),
        float(difference[worst]),
        int(numbers[worst]),
        float(allowed[worst]),
        tuple(sorted([*numbers[excess > 0.0].tolist(), *one_only])),
        tolerance.mean,
    )


def _same_order(a: BrakingRow, b: BrakingRow) -> None:
    for name in ("sequence", "role", "set_pressure_bar", "set_temperature_degc"):
        ordered_a, ordered_b = getattr(a, name), getattr(b, name)
        if ordered_a != ordered_b:
            raise RecordingError(
                f"braking {a.index} was ordered with {name} = {ordered_b}, in the other campaign with "
                f"{ordered_a}.",
                place=b.file,
                value=ordered_b,
                remedy="Compare campaigns of one program only.",
            )

"""Running statistics of the outputs of a batch: mean, rms, extremes, frequency by zero crossings.

NOT its job: the motion (`batch`), spectra.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from sim_hardware.brake_model.time_domain import simd as _simd
from sim_hardware.brake_model.time_domain.batch_tables import LANES
from sim_hardware.brake_model.time_domain.contact import Array

#: intrinsics get their first argument from the compiler: no type checker knows that
simd: Any = _simd

_OPTIONS: dict[str, Any] = {"cache": True, "nogil": True, "error_model": "numpy"}
_SUM, _SQUARES, _LEAST, _LARGEST, _LAST, _CROSSINGS, _FIRST_AT, _LAST_AT = range(8)


@dataclass(frozen=True)
class Statistics:
    """Statistics of outputs over a stretch of time; each (lanes, columns), in the unit of the output.

    Attributes
    ----------
    mean, minimum, maximum
    rms : about the mean
    frequency_hz : from the periods between the first and the last upward crossing of zero; not a number with
        less than two crossings
    crossings : number of upward crossings
    """

    mean: Array
    rms: Array
    minimum: Array
    maximum: Array
    frequency_hz: Array
    crossings: Array


class StatisticsOf:
    """Collects statistics piece by piece."""

    def __init__(self, columns: int, lanes: int) -> None:
        self._values = np.zeros((8, columns, lanes))
        self._values[_LEAST], self._values[_LARGEST] = np.inf, -np.inf
        self._values[_LAST] = 1.0  # no crossing at the first sample
        self._count = 0

    def add(self, out: Array) -> None:
        """Take in a piece, (n, columns, groups, 8)."""
        _collect(out, float(self._count), self._values)
        self._count += len(out)

    def result(self, rate_hz: float, lanes: int, lost: NDArray[np.bool_]) -> Statistics:
        """What was collected, of the first `lanes` lanes; not a number for `lost` (lanes,) ones."""
        v = self._values[:, :, :lanes].transpose(0, 2, 1).copy()
        v[:, lost] = np.nan
        n = max(self._count, 1)
        mean = v[_SUM] / n
        with np.errstate(all="ignore"):
            periods = v[_CROSSINGS] - 1.0
            frequency = rate_hz * np.where(periods > 0.0, periods / (v[_LAST_AT] - v[_FIRST_AT]), np.nan)
            rms = np.sqrt(np.maximum(v[_SQUARES] / n - mean**2, 0.0))
        return Statistics(mean, rms, v[_LEAST], v[_LARGEST], frequency, v[_CROSSINGS])


@njit(**_OPTIONS)
def _collect(out: Array, first: float, values: Array) -> None:
    """Add a piece (n, columns, groups, 8) that begins at sample `first`."""
    n, columns, groups = out.shape[0], out.shape[1], out.shape[2]
    row = columns * groups * LANES
    zero, one = simd.zero8(), simd.splat8(1.0)
    for at_lane in range(0, row, LANES):
        total, squares = simd.load8(values, at_lane), simd.load8(values, _SQUARES * row + at_lane)
        least, largest = (
            simd.load8(values, _LEAST * row + at_lane),
            simd.load8(values, _LARGEST * row + at_lane),
        )
        last, crossings = (
            simd.load8(values, _LAST * row + at_lane),
            simd.load8(values, _CROSSINGS * row + at_lane),
        )
        first_at = simd.load8(values, _FIRST_AT * row + at_lane)
        last_at = simd.load8(values, _LAST_AT * row + at_lane)
        for i in range(n):
            y = simd.load8(out, i * row + at_lane)
            total = simd.add(total, y)
            squares = simd.multiply_add(y, y, squares)
            least, largest = simd.smaller(y, least), simd.larger(y, largest)
            # upwards through zero since the last value: interpolated linearly
            crossing = simd.where_positive(last, zero, simd.where_positive(y, one, zero))
            when = simd.subtract(simd.splat8(first + i), simd.divide(y, simd.subtract(y, last)))
            last_at = simd.where_positive(crossing, when, last_at)
            first_at = simd.where_positive(simd.subtract(crossing, crossings), when, first_at)
            crossings = simd.add(crossings, crossing)
            last = y
        simd.store(values, at_lane, total)
        simd.store(values, _SQUARES * row + at_lane, squares)
        simd.store(values, _LEAST * row + at_lane, least)
        simd.store(values, _LARGEST * row + at_lane, largest)
        simd.store(values, _LAST * row + at_lane, last)
        simd.store(values, _CROSSINGS * row + at_lane, crossings)
        simd.store(values, _FIRST_AT * row + at_lane, first_at)
        simd.store(values, _LAST_AT * row + at_lane, last_at)

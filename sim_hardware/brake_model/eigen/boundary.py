"""Where a model loses (or regains) stability, exactly: over one quantity or group, and as a curve over two.

A scan finds the first cell in which the largest real part changes its sign; cells in which a pair might have
left the left half plane and come back, or in which pairs come close, are scanned finer first. In the cell
Newton's method with eq 24 finds the crossing, kept within its bracket, so that an exchange of modes does no
harm. Along a curve the scan is one eigenvalue map, and Newton solves F(i omega; t) = 0 of the secular
equation in (omega, t).
NOT its job: maps of growth rates (`maps`), many variants in one batch (`margins`), locus with mode identity
(`tracking`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.design.variations import Variation
from sim_hardware.brake_model.eigen.boundary_newton import (
    BoundaryPoint,
    crossing_between,
    free_motions,
    growing,
    on_axis,
    secular_crossings,
    without_free,
)
from sim_hardware.brake_model.eigen.directions import Direction, direction
from sim_hardware.brake_model.eigen.secular import grid_eigenvalues
from sim_hardware.brake_model.eigen.secular_equation import sorted_eigenvalues
from sim_hardware.brake_model.linear import LinearModel, Matrices, ParameterGroup

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Moved = str | ParameterGroup | Variation | Direction

_STEPS = 128
#: parts of a doubtful cell, and how often parts are divided again
_PARTS, _DEPTH = 8, 3
#: more degrees of freedom are a matter of bands
LARGEST = 400


@dataclass(frozen=True, slots=True)
class StabilityBoundary:
    """Result of `stability_boundary`.

    Attributes
    ----------
    moved : what was moved
    low, high : range, searched from low to high
    starts_unstable : at `low`
    point : the first crossing, None where there is none
    scanned, iterations : points of the scan and of its refinements; Newton steps
    """

    moved: Direction
    low: float
    high: float
    starts_unstable: bool
    point: BoundaryPoint | None
    scanned: int
    iterations: int


@dataclass(frozen=True, slots=True)
class BoundaryCurve:
    """First crossing over one number for every value of another.

    Attributes
    ----------
    moved, along : what is searched over, and what the curve runs along
    low, high : range of `moved`, searched from `low`
    along_values : (m,)
    values : (m,) first crossing, nan where there is none in the range
    frequencies_hz : (m,) 0 at divergence, nan without crossing
    destabilises : (m,) whether stability is lost there
    starts_unstable : (m,) at the beginning of the range
    by_secular : (m,) found by the secular equation; else by eq 24 and LAPACK
    map_fallback_share : share of the scan's points solved by LAPACK
    """

    moved: Direction
    along: Direction
    low: float
    high: float
    along_values: Array
    values: Array
    frequencies_hz: Array
    destabilises: NDArray[np.bool_]
    starts_unstable: NDArray[np.bool_]
    by_secular: NDArray[np.bool_]
    map_fallback_share: float


def stability_boundary(
    model: LinearModel,
    moved: Moved,
    low: float,
    high: float,
    values: Mapping[str, float] | None = None,
    *,
    steps: int = _STEPS,
) -> StabilityBoundary:
    """First value between `low` and `high` at which the model loses (or, unstable at `low`, regains)
    stability.

    Parameters
    ----------
    moved : a quantity; a group, its name or "group:clockwise"; a variation (see `directions.direction`)
    low, high : range, searched from `low`; `high` may be smaller
    values : other values than the file's
    steps : of the scan; doubtful cells are divided by up to 512

    Raises
    ------
    KeyError, ValueError
        unknown quantity, impossible values or range, a model too large for dense eigenvalues
    """
    way = direction(model, moved)
    _check_range(low, high, steps)
    check_size(model)
    scan = _Scan(model, way, dict(values or {}), low, high, steps)
    cell = scan.first_cell()
    if cell is None:
        return StabilityBoundary(way, low, high, scan.starts_unstable, None, scan.points, 0)
    point, iterations = scan.refine(*cell)
    return StabilityBoundary(way, low, high, scan.starts_unstable, point, scan.points, iterations)


def boundary_curve(
    model: LinearModel,
    moved: Moved,
    low: float,
    high: float,
    along: Moved,
    along_values: Array,
    values: Mapping[str, float] | None = None,
    *,
    steps: int = 64,
) -> BoundaryCurve:
    """First crossing over `moved` for every value of `along`: mu_crit(p), p_crit(mu), p_crit(k) …

    Parameters
    ----------
    low, high : range of `moved`, searched from `low`
    along_values : (m,) of `along`, in any order
    steps : of the scan; an unstable range narrower than a step is missed (`stability_boundary` looks closer)

    Raises
    ------
    KeyError, ValueError
        as `stability_boundary`
    """
    way, other = direction(model, moved), direction(model, along)
    _check_range(low, high, steps)
    check_size(model)
    along_values = np.asarray(along_values, dtype=float)
    if way.name == other.name:
        raise ValueError(f"{way.name} is both searched over and what the curve runs along; name another")
    base = dict(values or {})
    grid = np.linspace(low, high, steps + 1)

    def at(x: float, y: float) -> Matrices:
        return model.matrices(way.values(model, x, other.values(model, y, base)))

    solved = grid_eigenvalues(at, grid, along_values)
    unstable = growing(solved.values, free_motions(solved.values[:1, :1]))
    m = len(along_values)
    crossing, omega = np.full(m, np.nan), np.full(m, np.nan)
    changes = unstable[:, 1:] != unstable[:, :-1]
    rows = np.flatnonzero(changes.any(axis=1))
    cells = changes[rows].argmax(axis=1)
    done = np.zeros(m, dtype=bool)
    if solved.equation is not None and rows.size:
        near = solved.values[rows[:, None], np.stack([cells, cells + 1], axis=1)]
        lines = solved.equation.along_x(along_values[rows])[0], solved.equation.x
        ends = np.stack([grid[cells], grid[cells + 1]], axis=1)
        crossing[rows], omega[rows], done[rows] = secular_crossings(solved.equation, lines, ends, near)
    for row in rows[~done[rows]]:
        exact = stability_boundary(model, way, low, high, other.values(model, float(along_values[row]), base))
        if exact.point is not None:
            crossing[row], omega[row] = exact.point.value, exact.point.frequency_hz * 2.0 * math.pi
    return BoundaryCurve(
        way, other, low, high, along_values, crossing, omega / (2.0 * math.pi), ~unstable[:, 0] &
        np.isfinite(crossing), unstable[:, 0], done, solved.fallback_share,
    )  # fmt: skip


def check_size(model: LinearModel) -> None:
    """Refuse what is too large for all eigenvalues.

    Raises
    ------
    ValueError
        more than `LARGEST` degrees of freedom
    """
    if len(model.freedoms) > LARGEST:
        raise ValueError(
            f"the model '{model.name}' has {len(model.freedoms)} degrees of freedom: all eigenvalues at many "
            f"points are for up to {LARGEST}; make a small model of it (rigctl model reduce)"
        )


class _Scan:
    """Growth rates over the range, and what is done with them."""

    def __init__(
        self, model: LinearModel, way: Direction, base: dict[str, float], low: float, high: float, steps: int
    ) -> None:
        self._model, self._way, self._base = model, way, base
        self._grid = np.linspace(low, high, steps + 1)
        first = self._at(low).state_matrix()
        solved = grid_eigenvalues(lambda t, _: self._at(t), self._grid, np.zeros(1), method="lapack")
        self._values = solved.values[0]
        self._free = free_motions(sorted_eigenvalues(np.linalg.eigvals(first))[None])
        self.points = len(self._grid)
        self.starts_unstable = bool(growing(self._values[:1], self._free)[0])

    def _at(self, t: float) -> Matrices:
        return self._model.matrices(self._way.values(self._model, t, self._base))

    def first_cell(self) -> tuple[float, float] | None:
        """Ends of the first cell in which stability changes."""
        return self._first(self._grid, self._values, _DEPTH)

    def _first(self, grid: Array, values: Complex, depth: int) -> tuple[float, float] | None:
        unstable = growing(values, self._free)
        changes = unstable[1:] != unstable[:-1]
        doubtful = (
            _doubtful(values, self._free) if depth and not self.starts_unstable else np.zeros_like(changes)
        )
        for i in np.flatnonzero(changes | doubtful):
            if doubtful[i]:
                finer = np.linspace(grid[i], grid[i + 1], _PARTS + 1)
                inner = np.stack([self._at(float(t)).state_matrix() for t in finer[1:-1]])
                self.points += len(inner)
                between = sorted_eigenvalues(np.linalg.eigvals(inner))
                found = self._first(
                    finer, np.concatenate([values[i : i + 1], between, values[i + 1 : i + 2]]), depth - 1
                )
                if found is not None:
                    return found
            elif changes[i]:
                return float(grid[i]), float(grid[i + 1])
        return None

    def refine(self, before: float, after: float) -> tuple[BoundaryPoint, int]:
        """The crossing between two values."""

        def at(t: float) -> tuple[Matrices, Matrices]:
            return self._at(t).dense(), self._way.derivative(self._model, t, self._base)

        return crossing_between(at, before, after, free=self._free, began_unstable=self.starts_unstable)


def _doubtful(values: Complex, free: int) -> NDArray[np.bool_]:
    """Cells (m - 1,) between stable points that may hide an unstable range.

    A real part could rise by as much as it and its neighbours change nearby; and where two eigenvalues are
    closer than they move, they may couple in between.
    """
    kept, axis = without_free(values, free), on_axis(values)[:, None]
    high = np.maximum(kept.real[:-1], kept.real[1:])
    change = np.pad(np.abs(np.diff(kept.real, axis=0)), ((1, 1), (0, 0)))
    rise = 2.0 * np.maximum(np.maximum(change[:-2], change[1:-1]), change[2:])
    near_axis = ((high < -axis[1:]) & (high + rise >= 0.0)).any(axis=1)
    moved = np.abs(np.diff(kept, axis=0))
    apart = np.abs(kept[:, 2:] - kept[:, :-2])  # pairs follow each other by twos
    close = (np.minimum(apart[:-1], apart[1:]) < 2.0 * (moved[:, 2:] + moved[:, :-2])).any(axis=1)
    settled = np.asarray(kept.real.max(axis=1) > axis[:, 0])
    return np.asarray((near_axis | close) & ~settled[:-1] & ~settled[1:])


def _check_range(low: float, high: float, steps: int) -> None:
    if not (math.isfinite(low) and math.isfinite(high) and low != high):
        raise ValueError(f"range from {low!r} to {high!r}: give two different finite numbers")
    if steps < 1:
        raise ValueError(f"steps is {steps!r}; give at least 1")


def growth_along(
    model: LinearModel, moved: Moved, numbers: Array, values: Mapping[str, float] | None = None
) -> Array:
    """Largest real part (m,), 1/s, at numbers (m,) of what is moved. Errors as `stability_boundary`."""
    way = direction(model, moved)
    check_size(model)
    base = dict(values or {})
    solved = grid_eigenvalues(
        lambda t, _: model.matrices(way.values(model, t, base)), np.asarray(numbers, dtype=float), np.zeros(1)
    )
    return without_free(solved.values[0], free_motions(solved.values[0][::50])).real.max(axis=-1)

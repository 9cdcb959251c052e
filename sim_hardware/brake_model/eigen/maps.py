"""Maps of stability over two numbers: all eigenvalues, growth rate, frequency, unstable pairs, boundary.

Eigenvalues come from `secular` (about a microsecond a point) or LAPACK, whichever applies. The boundary is
the contour of growth rate zero; its points on the grid's lines are refined by Newton's method to the exact
crossing, with the exact frequency. NOT its job: figures, the first crossing along one quantity (`boundary`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sim_hardware.brake_model.eigen.boundary import Moved, check_size
from sim_hardware.brake_model.eigen.boundary_newton import (
    crossing_between,
    free_motions,
    on_axis,
    secular_crossings,
    without_free,
)
from sim_hardware.brake_model.eigen.contours import Edges, crossed_edges, linked
from sim_hardware.brake_model.eigen.directions import Direction, direction
from sim_hardware.brake_model.eigen.secular import GridEigenvalues, Method, grid_eigenvalues
from sim_hardware.brake_model.linear import LinearModel, Matrices

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]


@dataclass(frozen=True, slots=True)
class BoundaryLine:
    """A connected part of the stability boundary, in order along it.

    Attributes
    ----------
    x, y : (k,) exact points
    frequency_hz : (k,) of the eigenvalue that crosses; 0: divergence
    closed : whether the last point joins the first
    """

    x: Array
    y: Array
    frequency_hz: Array
    closed: bool


class EigenvalueMap:
    """All eigenvalues of a model over two numbers, and what they say about stability.

    Attributes
    ----------
    model_name : of the model
    x, y : what is moved
    x_values, y_values : (nx,), (ny,)
    eigenvalues : (ny, nx, n) 1/s, sorted by frequency at each point: a pair as l (Im > 0), conjugate; reals
        first
    method : "secular" or "lapack"; `reason`: why
    fallback : (ny, nx) points of the secular method that its guards left to LAPACK
    """

    def __init__(
        self,
        model: LinearModel,
        x: tuple[Direction, Array],
        y: tuple[Direction, Array],
        base: Mapping[str, float],
        solved: GridEigenvalues,
    ) -> None:
        self.model_name = model.name
        self._model, self._base, self._solved = model, base, solved
        (self.x, self.x_values), (self.y, self.y_values) = x, y
        self.eigenvalues = solved.values
        self.method: Method = solved.method
        self.reason = solved.reason
        self.fallback = solved.fallback
        self._free = free_motions(solved.values[:: len(y[1]), :: len(x[1])])

    @property
    def fallback_share(self) -> float:
        """Share of points that the guards left to LAPACK; 0 where all are LAPACK's."""
        return self._solved.fallback_share

    @cached_property
    def growth_rate_1_s(self) -> Array:
        """(ny, nx) largest real part, 1/s; > 0: unstable."""
        return without_free(self.eigenvalues, self._free).real.max(axis=-1)

    @cached_property
    def frequency_hz(self) -> Array:
        """(ny, nx) frequency of the eigenvalue of the largest real part, Hz; 0: real."""
        kept = without_free(self.eigenvalues, self._free)
        leading = kept.real.argmax(axis=-1)[..., None]
        return np.abs(np.take_along_axis(kept, leading, axis=-1)[..., 0].imag) / (2.0 * math.pi)

    @cached_property
    def unstable_pairs(self) -> NDArray[np.int64]:
        """(ny, nx) number of unstable pairs; an unstable real eigenvalue counts as one."""
        growing = (self.eigenvalues.real > self._axis[..., None]) & (self.eigenvalues.imag >= 0.0)
        return growing.sum(axis=-1)

    @property
    def unstable(self) -> NDArray[np.bool_]:
        """(ny, nx) whether any eigenvalue grows, beyond rounding."""
        return self.growth_rate_1_s > self._axis

    @property
    def unstable_share(self) -> float:
        """Share of the area that is unstable, each point standing for the ground nearest to it."""
        area = _widths(self.y_values)[:, None] * _widths(self.x_values)[None, :]
        return float((area * self.unstable).sum() / area.sum())

    @cached_property
    def _axis(self) -> Array:
        return on_axis(self.eigenvalues)

    @cached_property
    def boundary(self) -> tuple[BoundaryLine, ...]:
        """Lines between stable and unstable, exact at every grid line that they cross; the longest first.

        Islands smaller than a cell of the grid are not seen.
        """
        edges = crossed_edges(self.unstable)
        places, omega = self._crossings(edges)
        x = np.where(edges.along_x, places, self.x_values[edges.column])
        y = np.where(edges.along_x, self.y_values[edges.row], places)
        lines = [
            BoundaryLine(x[chain], y[chain], omega[chain] / (2.0 * math.pi), closed)
            for chain, closed in linked(edges, self.unstable, self.growth_rate_1_s)
        ]
        return tuple(sorted(lines, key=lambda line: -len(line.x)))

    def _crossings(self, edges: Edges) -> tuple[Array, Array]:
        """Place along each edge and omega of the crossing."""
        places, omega = np.empty(len(edges.row)), np.empty(len(edges.row))
        found = np.zeros(len(edges.row), dtype=bool)
        equation = self._solved.equation
        for along_x in (True, False):
            which = np.flatnonzero(edges.along_x == along_x)
            if equation is None or not which.size:
                continue
            row, column = edges.row[which], edges.column[which]
            end_row, end_column = row + (not along_x), column + along_x
            near = self.eigenvalues[np.stack([row, end_row], axis=1), np.stack([column, end_column], axis=1)]
            if along_x:
                lines = equation.along_x(self.y_values[row])[0], equation.x
                ends = np.stack([self.x_values[column], self.x_values[end_column]], axis=1)
            else:
                lines = equation.along_y(self.x_values[column])[0], equation.y
                ends = np.stack([self.y_values[row], self.y_values[end_row]], axis=1)
            places[which], omega[which], found[which] = secular_crossings(equation, lines, ends, near)
        for k in np.flatnonzero(~found):
            places[k], omega[k] = self._crossing_by_lapack(
                int(edges.row[k]), int(edges.column[k]), bool(edges.along_x[k])
            )
        return places, omega

    def _crossing_by_lapack(self, row: int, column: int, along_x: bool) -> tuple[float, float]:
        model = self._model
        if along_x:
            way, values = self.x, self.x_values[column : column + 2]
            base = self.y.values(model, float(self.y_values[row]), self._base)
        else:
            way, values = self.y, self.y_values[row : row + 2]
            base = self.x.values(model, float(self.x_values[column]), self._base)

        def at(t: float) -> tuple[Matrices, Matrices]:
            return model.matrices(way.values(model, t, base)).dense(), way.derivative(model, t, base)

        began = bool(self.unstable[row, column])
        before, after = values.tolist()
        point, _ = crossing_between(at, before, after, free=self._free, began_unstable=began)
        return point.value, point.frequency_hz * 2.0 * math.pi


def eigenvalue_map(
    model: LinearModel,
    x: tuple[Moved, ArrayLike],
    y: tuple[Moved, ArrayLike],
    values: Mapping[str, float] | None = None,
    *,
    method: Method | None = None,
    workers: int = 1,
) -> EigenvalueMap:
    """All eigenvalues over two quantities (or groups).

    Parameters
    ----------
    x, y : (what to move, its values (nx,) or (ny,)); values rising or falling. Names of quantities; groups
        move as a whole by a share: see `directions.direction`
    values : other values than the file's
    method : None: the secular equation where it applies, else LAPACK
    workers : threads of the secular method

    Raises
    ------
    KeyError, ValueError
        unknown quantity, impossible values, twice the same quantity, a model too large for dense eigenvalues
    """
    check_size(model)
    ways = tuple(direction(model, what) for what, _ in (x, y))
    if ways[0].name == ways[1].name:
        raise ValueError(f"both axes of the map are {ways[0].name}; name two quantities")
    grids = tuple(_checked(way.name, numbers) for way, (_, numbers) in zip(ways, (x, y), strict=True))
    base = dict(values or {})

    def at(a: float, b: float) -> Matrices:
        return model.matrices(ways[0].values(model, a, ways[1].values(model, b, base)))

    solved = grid_eigenvalues(at, *grids, method=method, workers=workers)
    return EigenvalueMap(model, (ways[0], grids[0]), (ways[1], grids[1]), base, solved)


def _checked(name: str, numbers: ArrayLike) -> Array:
    values = np.atleast_1d(np.asarray(numbers, dtype=float))
    if values.ndim != 1 or values.size == 0 or not np.isfinite(values).all():
        raise ValueError(f"{name}: give a row of finite numbers")
    steps = np.diff(values)
    if not ((steps > 0.0).all() or (steps < 0.0).all()):
        raise ValueError(f"{name}: values must rise or fall throughout")
    return values


def _widths(values: Array) -> Array:
    """Width of the ground that each value stands for."""
    if len(values) == 1:
        return np.ones(1)
    middles = 0.5 * (values[1:] + values[:-1])
    return np.abs(np.diff(np.concatenate([values[:1], middles, values[-1:]])))

"""Maps of stability and stability boundaries for people: facts, tables, figures.

NOT its job: eigenvalues (`sim_hardware.brake_model.eigen.maps`, `.boundary`), drawing (`maps_figures`).
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rigctl.model.maps_figures import curve_figure, growth_figure, map_figure
from rigctl.model.output import Column, Study, Table
from sim_hardware.brake_model.eigen.boundary import (
    BoundaryCurve,
    Moved,
    StabilityBoundary,
    boundary_curve,
    growth_along,
    stability_boundary,
)
from sim_hardware.brake_model.eigen.directions import Direction, direction
from sim_hardware.brake_model.eigen.maps import EigenvalueMap, eigenvalue_map
from sim_hardware.brake_model.linear import MU, PRESSURE, LinearModel

Array = NDArray[np.float64]

#: ranges searched where none is given
_USUAL = {MU: (0.0, 1.0), PRESSURE: (0.0, 30.0)}
_SHARE = 0.5
_POINTS = 241


def map_study(
    model: LinearModel,
    x: tuple[Moved, ArrayLike],
    y: tuple[Moved, ArrayLike],
    values: Mapping[str, float] | None = None,
    *,
    workers: int = 1,
) -> Study:
    """Growth rate, frequency and number of unstable pairs over two quantities, with the exact boundary.

    Parameters
    ----------
    x, y, values, workers : see `sim_hardware.brake_model.eigen.maps.eigenvalue_map`

    Returns
    -------
    facts: method, share of points left to LAPACK, share of the area that is unstable, the largest growth rate
    and where; tables "boundary" (points in order along each line, with exact frequency) and "map" (every
    point); figure "growth"
    """
    found = eigenvalue_map(model, x, y, values, workers=workers)
    title = f"{model.name}: stability over {found.x.name} and {found.y.name}"
    return Study(
        "map",
        title,
        _map_facts(found),
        (_lines_table(found), _map_table(found)),
        {"growth": partial(map_figure, found)},
    )


def boundary_study(
    model: LinearModel,
    over: Moved,
    search: tuple[float, float] | None = None,
    values: Mapping[str, float] | None = None,
) -> Study:
    """Where a model becomes unstable over one quantity, group or variation.

    Parameters
    ----------
    over : see `sim_hardware.brake_model.eigen.directions.direction`
    search : range, searched from its first number. None: mu from 0 to 1, pressure from 0 to 30 bar; anything
        else from its value half as much down and half as much again up
    values : other values than the file's

    Returns
    -------
    facts: the nearest crossing; table "boundary" (a line per search); figure "growth"
    """
    way = direction(model, over)
    start = way.start(model, values)
    if search is not None:
        searches = [search]
    elif way.name in _USUAL:
        searches = [_USUAL[way.name]]
    elif way.single and start == 0.0:
        raise ValueError(f"{way.name} is 0 in the model: give the range to search, as {way.name}:FROM:TO")
    else:
        part = _SHARE * (start if way.single else 1.0)
        searches = [(start, start + part), (start, start - part)]
    results = [stability_boundary(model, way, *ends, values) for ends in searches]
    low, high = (f(end for ends in searches for end in ends) for f in (min, max))
    numbers = np.linspace(low, high, _POINTS)
    growth = growth_along(model, way, numbers, values)
    return Study(
        "boundary",
        f"{model.name}: {_headline(way, results)}",
        _boundary_facts(way, results),
        (_searches_table(way, results),),
        {"growth": partial(growth_figure, way, numbers, growth, results, model.name)},
    )


def curve_study(
    model: LinearModel,
    over: Moved,
    along: tuple[Moved, ArrayLike],
    search: tuple[float, float] | None = None,
    values: Mapping[str, float] | None = None,
) -> Study:
    """First crossing over one quantity for every value of another: p_crit(k), mu_crit(p) …

    Parameters
    ----------
    over, search, values : as `boundary_study`; without a usual range `search` is needed
    along : what the curve runs along, and its values

    Returns
    -------
    facts: lowest and highest crossing, how many were found by the secular equation; table "curve"; figure
    "curve"
    """
    way = direction(model, over)
    ends = search or _USUAL.get(way.name)
    if ends is None:
        raise ValueError(f"give the range of {way.name} to search, as {way.name}:FROM:TO")
    what, numbers = along
    curve = boundary_curve(model, way, *ends, what, np.atleast_1d(np.asarray(numbers, dtype=float)), values)
    title = f"{model.name}: where it becomes unstable over {way.name}, along {curve.along.name}"
    return Study(
        "curve",
        title,
        _curve_facts(curve, ends),
        (_curve_table(curve),),
        {"curve": partial(curve_figure, curve, model.name)},
    )


def _map_facts(found: EigenvalueMap) -> dict[str, Any]:
    growth = found.growth_rate_1_s
    row, column = np.unravel_index(int(growth.argmax()), growth.shape)
    boundary = found.boundary
    return {
        "method": {"secular": "secular equation", "lapack": "LAPACK at every point"}[found.method],
        **({"reason_for_lapack": found.reason} if found.method == "lapack" else {}),
        "points": int(growth.size),
        "share_of_points_left_to_lapack": found.fallback_share if found.method == "secular" else 1.0,
        "unstable_share_of_the_area": found.unstable_share,
        "most_unstable_pairs_at_once": int(found.unstable_pairs.max()),
        "largest_growth_rate_1_s": float(growth[row, column]),
        f"largest_growth_at_{found.x.name}": float(found.x_values[column]),
        f"largest_growth_at_{found.y.name}": float(found.y_values[row]),
        "largest_growth_frequency_hz": float(found.frequency_hz[row, column]),
        "boundary_lines": len(boundary),
        "boundary_frequencies_hz": _frequencies(boundary),
    }


def _frequencies(boundary: tuple[Any, ...]) -> str:
    if not boundary:
        return "no boundary in this range"
    every = np.concatenate([line.frequency_hz for line in boundary])
    texts = [f"{every[every > 0.0].min():.1f} to {every.max():.1f}"] if (every > 0.0).any() else []
    if (every == 0.0).any():
        texts.append("0 (divergence)")
    return ", ".join(texts)


def _lines_table(found: EigenvalueMap) -> Table:
    lines = found.boundary
    number = [i + 1 for i, line in enumerate(lines) for _ in line.x]
    x, y, frequency = (
        [float(v) for line in lines for v in getattr(line, key)] for key in ("x", "y", "frequency_hz")
    )
    return Table(
        "boundary",
        "Stability boundary (exact where it crosses the grid's lines)",
        (
            Column("line", "", number),
            Column(found.x.name, _unit(found.x), x),
            Column(found.y.name, _unit(found.y), y),
            Column("frequency", "Hz", frequency),
            Column("kind", "", [_kind(f) for f in frequency]),
        ),
    )


def _map_table(found: EigenvalueMap) -> Table:
    x, y = np.meshgrid(found.x_values, found.y_values)
    return Table(
        "map",
        "Every point of the map",
        (
            Column(found.x.name, _unit(found.x), x.ravel().tolist()),
            Column(found.y.name, _unit(found.y), y.ravel().tolist()),
            Column("growth_rate", "1/s", found.growth_rate_1_s.ravel().tolist()),
            Column("frequency", "Hz", found.frequency_hz.ravel().tolist()),
            Column("unstable_pairs", "", found.unstable_pairs.ravel().tolist()),
            Column("by_lapack", "", (found.fallback | (found.method == "lapack")).ravel().tolist()),
        ),
    )


def _headline(way: Direction, results: list[StabilityBoundary]) -> str:
    points = [r.point for r in results if r.point is not None]
    if not points:
        state = "unstable" if results[0].starts_unstable else "stable"
        return f"{state} over the whole range of {way.name}"
    return "; ".join(
        f"{'un' if p.destabilises else ''}stable from {way.name} = {p.value:.6g} {_unit(way)}".rstrip()
        + (f", {p.frequency_hz:.1f} Hz" if p.kind == "flutter" else ", divergence")
        for p in points
    )


def _boundary_facts(way: Direction, results: list[StabilityBoundary]) -> dict[str, Any]:
    facts: dict[str, Any] = {
        "moved": way.name if way.single else f"{way.name} (relative change of {len(way.rates)} quantities)",
        "crossings_found": sum(r.point is not None for r in results),
        "unstable_at_the_start": results[0].starts_unstable,
    }
    for result in results:
        if result.point is not None:
            facts |= {
                "boundary": result.point.value,
                "boundary_unit": way.unit,
                "boundary_frequency_hz": result.point.frequency_hz,
                "kind": result.point.kind,
            }
            break
    return facts


def _searches_table(way: Direction, results: list[StabilityBoundary]) -> Table:
    def each(key: str) -> list[Any]:
        return [None if r.point is None else getattr(r.point, key) for r in results]

    return Table(
        "boundary",
        "First crossing of the imaginary axis",
        (
            Column("searched_from", _unit(way), [r.low for r in results]),
            Column("to", _unit(way), [r.high for r in results]),
            Column("stable_at_the_start", "", [not r.starts_unstable for r in results]),
            Column(way.name, _unit(way), each("value")),
            Column("frequency", "Hz", each("frequency_hz")),
            Column("kind", "", each("kind")),
            Column("destabilises", "", each("destabilises")),
            Column("growth_per_unit", f"1/s per {_unit(way) or '1'}", each("rate_1_s")),
        ),
    )


def _curve_facts(curve: BoundaryCurve, ends: tuple[float, float]) -> dict[str, Any]:
    found = np.isfinite(curve.values)
    facts: dict[str, Any] = {
        "points": len(curve.values),
        "crossings_found": int(found.sum()),
        "searched_from": ends[0],
        "searched_to": ends[1],
        "unstable_at_the_start_of_the_search": int(curve.starts_unstable.sum()),
        "found_by_the_secular_equation": int(curve.by_secular.sum()),
        "share_of_points_left_to_lapack": curve.map_fallback_share,
    }
    if found.any():
        lowest = int(np.nanargmin(curve.values))
        highest = int(np.nanargmax(curve.values))
        for word, k in (("lowest", lowest), ("highest", highest)):
            facts[f"{word}_{curve.moved.name}"] = float(curve.values[k])
            facts[f"{word}_at_{curve.along.name}"] = float(curve.along_values[k])
            facts[f"{word}_frequency_hz"] = float(curve.frequencies_hz[k])
    return facts


def _curve_table(curve: BoundaryCurve) -> Table:
    return Table(
        "curve",
        "Stability boundary along the curve (empty: none in the range)",
        (
            Column(curve.along.name, _unit(curve.along), curve.along_values.tolist()),
            Column(curve.moved.name, _unit(curve.moved), curve.values.tolist()),
            Column("frequency", "Hz", curve.frequencies_hz.tolist()),
            Column("kind", "", [None if np.isnan(f) else _kind(f) for f in curve.frequencies_hz.tolist()]),
            Column("destabilises", "", curve.destabilises.tolist()),
        ),
    )


def _kind(frequency_hz: float) -> str:
    return "flutter" if frequency_hz > 0.0 else "divergence"


def _unit(way: Direction) -> str:
    return "" if way.unit == "1" else way.unit

"""Optimisation of a model for the largest stability margin: starts in parallel, before and after, verified.

    study = optimise_study(path, free=["x_pis:0.014:0.022"], groups=["abutment_stiffness"])

Job: read bounds, `optimise`, and `optimise_study` with facts, tables and a figure. NOT its job: the climbing
itself (`sim_hardware.brake_model.design.optimise`), parallel running (`runner`, `study_tasks`).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.core.errors import ConfigError
from rigctl.model.loading import study_errors
from rigctl.model.optimise_figures import (
    draw_margin,
    finer,
    onsets_table,
    points_table,
    starts_table,
    variables_table,
)
from rigctl.model.output import Study
from rigctl.model.runner import RunOptions
from rigctl.model.runner_model import load_source, model_source
from rigctl.model.study_tasks import described
from sim_hardware.brake_model.design.optimise import (
    Bounds,
    Margin,
    at_bounds,
    check_bounds,
    stability_margin,
    starts,
    values_at,
)
from sim_hardware.brake_model.design.scatter import variables
from sim_hardware.brake_model.linear import LinearModel, known, value_of

Array = NDArray[np.float64]

#: bounds of a group where none are given, as factors on the file's values
GROUP_LOW, GROUP_HIGH = 0.8, 1.25
MOST_POINTS, MOST_STARTS = 500, 4096
_SAME_MARGIN = 1e-5
DEFINITION = (
    "Margin: the smallest damping ratio of all eigenvalues at all operating points; negative where the brake "
    "is unstable somewhere. The optimum is the best of local optima from spread starts; a better one "
    "elsewhere cannot be excluded."
)


@dataclass(frozen=True, slots=True)
class OptimiseResult:
    """Best of all starts.

    Attributes
    ----------
    factors : (k,) on the file's values; all 1 where no start improves on the file
    before, after : margin on the grid it was optimised on
    before_finer, after_finer : by plain re-solving on a finer grid
    climbs : what each start gave, in their order; start 1 is the file itself
    """

    bounds: tuple[Bounds, ...]
    points: tuple[dict[str, float], ...]
    factors: Array
    before: Margin
    after: Margin
    before_finer: Margin
    after_finer: Margin
    climbs: tuple[dict[str, Any], ...]


def optimise(
    path: Path,
    *,
    free: Sequence[str] = (),
    groups: Sequence[str] = (),
    ranges: Mapping[str, Sequence[float]],
    start_count: int = 8,
    seed: int = 1,
    values: Mapping[str, float] | None = None,
    options: RunOptions | None = None,
) -> OptimiseResult:
    """Change chosen quantities and groups within bounds for the largest stability margin.

    Parameters
    ----------
    free : "NAME:LOW:HIGH", bounds of a quantity in its unit
    groups : "NAME" or "NAME:LOW:HIGH", bounds of a group as factors on its members (0.8:1.25 where left out)
    ranges : operating range, values of each quantity; every combination counts
    start_count, seed : starts: the file's values, then a Sobol sequence over the bounds
    values : other values than the file's
    options : workers, folder

    Raises
    ------
    ConfigError
        wrong model, names, bounds, ranges
    RunError, StudyStopped
        see `run_study`
    """
    place = str(path)
    source = model_source(path)
    model = load_source(source)
    base = dict(values or {})
    with study_errors(place):
        bounds = _bounds(model, free, groups, base)
        points = _points(model, ranges)
        if not 1 <= start_count <= MOST_STARTS:
            raise ConfigError(f"must be from 1 to {MOST_STARTS}.", place="--starts", value=start_count)
        check_bounds(model, bounds, points, base)
        before = stability_margin(model, points, base)
        begin = [[_place_of_file(bound) for bound in bounds]]
        begin += starts(start_count - 1, len(bounds), seed).tolist() if start_count > 1 else []
    setting = {
        "model": source,
        "variables": described([bound.variable for bound in bounds]),
        "bounds": {bound.variable.name: [bound.low, bound.high] for bound in bounds},
        "points": points,
        "values": base,
    }
    with study_errors(place):
        climbs = (options or RunOptions()).run(
            [{"start": start} for start in begin], "rigctl.model.study_tasks:climb", setting
        )
        best = max(climbs, key=lambda found: found["margin"])
        factors = np.array(best["factors"])
        after = stability_margin(model, points, values_at(model, bounds, factors, base))
        if after.damping_ratio < before.damping_ratio and _within(bounds):
            factors, after = np.ones(len(bounds)), before  # the file is the best that was found
        dense = _points(model, {name: finer(list(grid)) for name, grid in ranges.items()}, most=math.inf)
        changed = values_at(model, bounds, factors, base)
        return OptimiseResult(
            bounds, tuple(points), factors, before, after,
            stability_margin(model, dense, base), stability_margin(model, dense, changed), tuple(climbs),
        )  # fmt: skip


def optimise_study(
    path: Path,
    *,
    free: Sequence[str] = (),
    groups: Sequence[str] = (),
    ranges: Mapping[str, Sequence[float]],
    start_count: int = 8,
    seed: int = 1,
    values: Mapping[str, float] | None = None,
    options: RunOptions | None = None,
) -> Study:
    """`optimise` as facts, tables (variables, operating points, starts) and a figure of the margin."""
    result = optimise(
        path, free=free, groups=groups, ranges=ranges, start_count=start_count, seed=seed,
        values=values, options=options,
    )  # fmt: skip
    model, base = load_source(model_source(path)), dict(values or {})
    after = values_at(model, result.bounds, result.factors, base)
    best = max(found["margin"] for found in result.climbs)
    agreeing = sum(abs(found["margin"] - best) < _SAME_MARGIN for found in result.climbs)
    where = at_bounds(result.bounds, result.factors)
    active = [f"{b.variable.name} ({w})" for b, w in zip(result.bounds, where, strict=True) if w]
    outside = [b.variable.name for b in result.bounds if not b.low <= 1.0 <= b.high]
    axis = max(ranges, key=lambda name: len(ranges[name]))
    facts: dict[str, Any] = {
        "model": model.name,
        "margin_before_percent": 100.0 * result.before.damping_ratio,
        "margin_after_percent": 100.0 * result.after.damping_ratio,
        "verified_before_percent": 100.0 * result.before_finer.damping_ratio,
        "verified_after_percent": 100.0 * result.after_finer.damping_ratio,
        "stable_in_the_whole_range": result.after_finer.damping_ratio > 0.0,
        "critical_frequency_before_hz": result.before.frequency_hz,
        "critical_frequency_after_hz": result.after.frequency_hz,
        "active_bounds": ", ".join(active) or "none",
        "file_is_outside_the_bounds_of": ", ".join(outside) or "none",
        "starts": len(result.climbs),
        "starts_that_reach_the_best_margin": agreeing,
        "seed": seed,
        "operating_points": len(result.points),
        "definition": DEFINITION,
        "set": base,
        "values_after": {name: after[name] for b in result.bounds for name in b.variable.members},
    }
    gain = f"{facts['margin_before_percent']:.3f} % to {facts['margin_after_percent']:.3f} %"
    return Study(
        "optimise",
        f"Stability margin of '{model.name}': smallest damping ratio from {gain}",
        facts,
        (
            variables_table(model, result, base, where),
            onsets_table(model, ranges, axis, base, after),
            points_table(model, result, base, after),
            starts_table(result),
        ),
        {"margin": partial(draw_margin, model, ranges, axis, base, after)},
    )


def _bounds(
    model: LinearModel, free: Sequence[str], groups: Sequence[str], base: Mapping[str, float]
) -> tuple[Bounds, ...]:
    """Bounds as factors from their texts."""
    singles = [_three(text, "--free", None) for text in free]
    grouped = [_three(text, "--groups", (GROUP_LOW, GROUP_HIGH)) for text in groups]
    if not singles and not grouped:
        raise ConfigError(
            "nothing is free.", place="--free, --groups",
            remedy="Name what may change: --free x_pis:0.014:0.022 or --groups piston_position",
        )  # fmt: skip
    chosen = variables(model, [name for name, *_ in singles], [name for name, *_ in grouped])
    found = []
    for variable, (name, low, high) in zip(chosen, [*singles, *grouped], strict=True):
        if not (math.isfinite(low) and math.isfinite(high) and low < high):
            raise ValueError(f"{name}: bounds {low:g} to {high:g}: give finite ones, the lower one first")
        if len(found) < len(singles):
            value = value_of(model, name, base)
            found.append(Bounds(variable, *sorted((low / value, high / value))))
        else:
            found.append(Bounds(variable, low, high))
    return tuple(found)


def _three(text: str, place: str, default: tuple[float, float] | None) -> tuple[str, float, float]:
    name, *numbers = (part.strip() for part in text.split(":"))
    if name and not numbers and default is not None:
        return name, *default
    try:
        low, high = map(float, numbers)
    except ValueError:
        example = "x_pis:0.014:0.022" if default is None else "piston_position or piston_position:0.9:1.1"
        raise ConfigError(
            "is not NAME:LOW:HIGH.", place=place, value=text, remedy=f"For example {place} {example}"
        ) from None
    return name, low, high


def _points(
    model: LinearModel, ranges: Mapping[str, Sequence[float]], most: float = MOST_POINTS
) -> list[dict[str, float]]:
    for name in ranges:
        known(model, name)
    count = math.prod(len(grid) for grid in ranges.values())
    if not ranges or count > most:
        raise ValueError(f"the operating range has {count if ranges else 0} points; give 1 to {most:g}")
    return [dict(zip(ranges, map(float, point), strict=True)) for point in product(*ranges.values())]


def _place_of_file(bound: Bounds) -> float:
    """Where the file's value lies between the bounds, 0 to 1 on a logarithmic scale."""
    return float(np.clip(-math.log(bound.low) / (math.log(bound.high) - math.log(bound.low)), 0.0, 1.0))


def _within(bounds: Sequence[Bounds]) -> bool:
    return all(bound.low <= 1.0 <= bound.high for bound in bounds)

"""Optimisation of a model for the largest stability margin: starts in parallel, before and after, verified.

    study = optimise_study(path, free=["x_pis:0.014:0.022"], groups=["abutment_stiffness"])

Job: read bounds, `climb` (a task of the runner: one start), `optimise_study` (facts, tables, figures). NOT
its job: the climbing itself (`sim_hardware.brake_model.optimise`), parallel running (`runner`).
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
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rigctl.analysis.style import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PALE,
    PURPLE,
    TITLE,
    VERMILION,
    grid,
    label_axes,
    new_figure,
)
from rigctl.core.errors import ConfigError
from rigctl.model.loading import study_errors
from rigctl.model.output import Column, Study, Table
from rigctl.model.runner import RunOptions
from rigctl.model.runner_model import load_source, model_source
from sim_hardware.brake_model.first_onset import scan
from sim_hardware.brake_model.linear import LinearModel, known, value_of
from sim_hardware.brake_model.optimise import (
    Bounds,
    Margin,
    at_bounds,
    check_bounds,
    improve,
    stability_margin,
    starts,
    values_at,
)
from sim_hardware.brake_model.scatter import variables

Array = NDArray[np.float64]

#: bounds of a group where none are given, as factors on the file's values
GROUP_LOW, GROUP_HIGH = 0.8, 1.25
MOST_POINTS, MOST_STARTS = 500, 4096
_FINER = 4
"""The optimum is checked on a grid this many times finer than the one it was found on."""
_SAME_MARGIN = 1e-5
_COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, GREY)
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


def climb(task: dict[str, Any], setting: dict[str, Any]) -> dict[str, Any]:
    """One start climbs to the optimum of its valley. A task of `run_study`."""
    model = load_source(setting["model"])
    bounds = _bounds(model, setting["free"], setting["groups"], setting["values"])
    found = improve(model, bounds, setting["points"], np.array(task["start"]), base=setting["values"])
    return {
        "factors": found.factors.tolist(),
        "margin": found.margin,
        "evaluations": found.evaluations,
        "converged": found.converged,
        "message": found.message,
    }


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
        "model": source, "free": list(free), "groups": list(groups), "points": points, "values": base,
    }  # fmt: skip
    with study_errors(place):
        climbs = (options or RunOptions()).run(
            [{"start": start} for start in begin], "rigctl.model.optimise:climb", setting
        )
        best = max(climbs, key=lambda found: found["margin"])
        factors = np.array(best["factors"])
        after = stability_margin(model, points, values_at(model, bounds, factors, base))
        if after.damping_ratio < before.damping_ratio and _within(bounds):
            factors, after = np.ones(len(bounds)), before  # the file is the best that was found
        finer = _points(model, {name: _finer(list(grid)) for name, grid in ranges.items()}, most=math.inf)
        changed = values_at(model, bounds, factors, base)
        return OptimiseResult(
            bounds, tuple(points), factors, before, after,
            stability_margin(model, finer, base), stability_margin(model, finer, changed), tuple(climbs),
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
            _variables_table(model, result, base, where),
            _onsets_table(model, ranges, axis, base, after),
            _points_table(model, result, base, after),
            _starts_table(result),
        ),
        {"margin": partial(_draw_margin, model, ranges, axis, base, after)},
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


def _finer(grid: Sequence[float]) -> list[float]:
    if len(grid) < 2:
        return list(grid)
    index = np.linspace(0, len(grid) - 1, _FINER * (len(grid) - 1) + 1)
    return np.interp(index, np.arange(len(grid)), grid).tolist()


def _place_of_file(bound: Bounds) -> float:
    """Where the file's value lies between the bounds, 0 to 1 on a logarithmic scale."""
    return float(np.clip(-math.log(bound.low) / (math.log(bound.high) - math.log(bound.low)), 0.0, 1.0))


def _within(bounds: Sequence[Bounds]) -> bool:
    return all(bound.low <= 1.0 <= bound.high for bound in bounds)


def _variables_table(
    model: LinearModel, result: OptimiseResult, base: Mapping[str, float], where: Sequence[str]
) -> Table:
    rows = []
    for bound, factor, side in zip(result.bounds, result.factors.tolist(), where, strict=True):
        member = bound.variable.members[0]
        single = bound.variable.members == (bound.variable.name,)
        value = value_of(model, member, base) if single else 1.0
        low, high = sorted((bound.low * value, bound.high * value))
        unit = known(model, member).unit if single else "factor"
        rows.append(
            (bound.variable.name, bound.variable.title, unit, value, factor * value, low, high, factor, side)
        )
    names = ("variable", "title", "unit", "before", "after", "lower", "upper", "factor", "at_bound")
    columns = zip(names, zip(*rows, strict=True), strict=True)
    return Table("variables", "What changes", tuple(Column(name, "", values) for name, values in columns))


def _onsets_table(
    model: LinearModel,
    ranges: Mapping[str, Sequence[float]],
    axis: str,
    base: Mapping[str, float],
    after: Mapping[str, float],
) -> Table:
    """First onset along the longest range, before and after, for every combination of the others."""
    others = {name: grid for name, grid in ranges.items() if name != axis}
    along = np.unique(_finer(_finer(list(ranges[axis]))))
    combinations = [dict(zip(others, map(float, p), strict=True)) for p in product(*others.values())]
    old = [scan(model, axis, along, {**base, **point}) for point in combinations]
    new = [scan(model, axis, along, {**after, **point}) for point in combinations]
    unit = "" if known(model, axis).unit == "1" else known(model, axis).unit
    return Table(
        "onsets",
        f"Onset over {axis} up to {along[-1]:g} (none: stable)",
        (
            *(Column(name, "", [point[name] for point in combinations]) for name in others),
            Column("onset_before", unit, [s.onset for s in old]),
            Column("frequency_before", "Hz", [s.frequency_hz for s in old]),
            Column("onset_after", unit, [s.onset for s in new]),
            Column("frequency_after", "Hz", [s.frequency_hz for s in new]),
        ),
    )


def _points_table(
    model: LinearModel, result: OptimiseResult, base: Mapping[str, float], after: Mapping[str, float]
) -> Table:
    old = [stability_margin(model, [point], base) for point in result.points]
    new = [stability_margin(model, [point], after) for point in result.points]
    return Table(
        "points",
        "Smallest damping ratio at the operating points",
        (
            *(Column(name, "", [point[name] for point in result.points]) for name in result.points[0]),
            Column("damping_before", "%", [100.0 * m.damping_ratio for m in old]),
            Column("frequency_before", "Hz", [m.frequency_hz for m in old]),
            Column("damping_after", "%", [100.0 * m.damping_ratio for m in new]),
            Column("frequency_after", "Hz", [m.frequency_hz for m in new]),
        ),
    )


def _starts_table(result: OptimiseResult) -> Table:
    return Table(
        "starts",
        "Where each start ended",
        (
            Column("start", "", range(1, len(result.climbs) + 1)),
            Column("margin", "%", [100.0 * found["margin"] for found in result.climbs]),
            Column("gradients", "", [found["evaluations"] for found in result.climbs]),
            Column("ended", "", [found["message"] for found in result.climbs]),
            *(
                Column(bound.variable.name, "", [found["factors"][i] for found in result.climbs])
                for i, bound in enumerate(result.bounds)
            ),
        ),
    )


def _draw_margin(
    model: LinearModel,
    ranges: Mapping[str, Sequence[float]],
    axis: str,
    base: Mapping[str, float],
    after: Mapping[str, float],
) -> Figure:
    figure = new_figure(8.0, 4.6)
    axes = figure.subplots()
    figure.subplots_adjust(left=0.1, right=0.97, top=0.9, bottom=0.12)
    others = {name: grid for name, grid in ranges.items() if name != axis}
    along = _finer(_finer(list(ranges[axis])))
    combinations = list(product(*others.values()))
    shown = combinations if len(combinations) <= len(_COLOURS) else [combinations[0], combinations[-1]]
    for colour, combination in zip(_COLOURS, shown, strict=False):
        point = dict(zip(others, map(float, combination), strict=True))
        name = ", ".join(f"{key} = {value:g}" for key, value in point.items()) or "margin"
        for values, style, what in ((base, (0, (4, 2)), "before"), (after, "-", "after")):
            ratio = [stability_margin(model, [{**point, axis: x}], values).damping_ratio for x in along]
            axes.plot(along, 100.0 * np.array(ratio), color=colour, ls=style, lw=1.7, label=f"{name}, {what}")
    axes.axhline(0.0, color=GREY, lw=1.0)
    low, high = axes.get_ylim()
    if low < 0.0:
        axes.axhspan(low, 0.0, color=PALE, alpha=0.6, zorder=0)
        axes.text(0.01, 0.015, "unstable: squeal", transform=axes.transAxes, color=GREY)
    axes.set_ylim(low, high)
    axes.set_xlim(along[0], along[-1])
    unit = known(model, axis).unit
    label_axes(axes, axis if unit == "1" else f"{axis} [{unit}]", "smallest damping ratio [%]", y_gap_pt=38)
    grid(axes)
    axes.legend(loc="best", ncols=2 if len(shown) > 2 else 1)
    figure.suptitle(f"Stability margin of '{model.name}' before and after", x=0.1, y=0.97, **TITLE)
    return figure

"""Tables and the figure of an optimisation (`rigctl.model.optimise`).

NOT its job: the optimum.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import TYPE_CHECKING

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
from rigctl.model.output import Column, Table
from sim_hardware.brake_model.design.optimise import stability_margin
from sim_hardware.brake_model.eigen.first_onset import scan
from sim_hardware.brake_model.linear import LinearModel, known, value_of

if TYPE_CHECKING:
    from rigctl.model.optimise import OptimiseResult

Array = NDArray[np.float64]

_FINER = 4
"""The optimum is checked on a grid this many times finer than the one it was found on."""


_COLOURS = (BLUE, VERMILION, GREEN, ORANGE, PURPLE, GREY)


def finer(grid: Sequence[float]) -> list[float]:
    """The same range with more values between."""
    if len(grid) < 2:
        return list(grid)
    index = np.linspace(0, len(grid) - 1, _FINER * (len(grid) - 1) + 1)
    return np.interp(index, np.arange(len(grid)), grid).tolist()


def variables_table(
    model: LinearModel, result: OptimiseResult, base: Mapping[str, float], where: Sequence[str]
) -> Table:
    """Variables before and after, with their bounds."""
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


def onsets_table(
    model: LinearModel,
    ranges: Mapping[str, Sequence[float]],
    axis: str,
    base: Mapping[str, float],
    after: Mapping[str, float],
) -> Table:
    """First onset along the longest range, before and after, for every combination of the others."""
    others = {name: grid for name, grid in ranges.items() if name != axis}
    along = np.unique(finer(finer(list(ranges[axis]))))
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


def points_table(
    model: LinearModel, result: OptimiseResult, base: Mapping[str, float], after: Mapping[str, float]
) -> Table:
    """Margin at the operating points."""
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


def starts_table(result: OptimiseResult) -> Table:
    """Optimum of every start."""
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


def draw_margin(
    model: LinearModel,
    ranges: Mapping[str, Sequence[float]],
    axis: str,
    base: Mapping[str, float],
    after: Mapping[str, float],
) -> Figure:
    """Margin over the longest range, before and after."""
    figure = new_figure(8.0, 4.6)
    axes = figure.subplots()
    figure.subplots_adjust(left=0.1, right=0.97, top=0.9, bottom=0.12)
    others = {name: grid for name, grid in ranges.items() if name != axis}
    along = finer(finer(list(ranges[axis])))
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

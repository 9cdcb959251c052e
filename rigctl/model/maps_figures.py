"""Drawings of stability maps and boundaries.

NOT its job: computing, facts and tables (`rigctl.model.maps`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, LinearSegmentedColormap, Normalize, TwoSlopeNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from rigctl.analysis.style import (
    BLUE,
    GREY,
    INK,
    TITLE,
    VERMILION,
    colour_bar,
    grid,
    label_axes,
    new_figure,
)
from sim_hardware.brake_model.eigen.boundary import BoundaryCurve, StabilityBoundary
from sim_hardware.brake_model.eigen.directions import Direction
from sim_hardware.brake_model.eigen.maps import BoundaryLine, EigenvalueMap

Array = NDArray[np.float64]

_LABELS = {
    "mu": "coefficient of friction μ",
    "pressure": "brake pressure p [bar]",
    "slope": "falling slope k of friction [s/m]",
}
#: blue to white: stable; white to red: unstable
_STABLE, _UNSTABLE = ("#0B4A7A", "#5FA0CC", "#F4F6F8"), ("#F4F6F8", "#E8925F", "#A63603")
_BOTH = LinearSegmentedColormap.from_list("growth", (*_STABLE, *_UNSTABLE[1:]))
_ONE_SIDE = {
    True: LinearSegmentedColormap.from_list("unstable", _UNSTABLE),
    False: LinearSegmentedColormap.from_list("stable", _STABLE),
}
#: labels of frequencies along all boundary lines, and their least distance as share of the axes
_LABELLED, _APART = 10, 0.16


def axis_label(way: Direction) -> str:
    """What is moved, with its unit."""
    if way.name in _LABELS:
        return _LABELS[way.name]
    if not way.single:
        return f"{way.name.replace('_', ' ')}, relative change"
    return f"{way.name} [{way.unit}]" if way.unit and way.unit != "1" else way.name


def map_figure(found: EigenvalueMap) -> Figure:
    """Growth rate by colour, stability boundary as a line with frequencies."""
    figure = new_figure(8.0, 5.2)
    axes = figure.subplots()
    figure.subplots_adjust(left=0.1, right=0.85, top=0.87, bottom=0.12)
    growth = found.growth_rate_1_s
    colours, norm = _colours(growth)
    mesh = axes.pcolormesh(
        *(_edges(values) for values in (found.x_values, found.y_values)),
        growth,
        cmap=colours,
        norm=norm,
        rasterized=True,
    )
    axes.set_xlim(*_limits(found.x_values))
    axes.set_ylim(*_limits(found.y_values))
    for line in found.boundary:
        closing = [0] if line.closed else []
        index = [*range(len(line.x)), *closing]
        axes.plot(line.x[index], line.y[index], color=INK, lw=1.6, solid_capstyle="round")
        if len(line.x) == 1:
            axes.plot(line.x, line.y, color=INK, marker="o", ms=4)
    _frequency_labels(axes, found.boundary)
    label_axes(axes, axis_label(found.x), axis_label(found.y), x_gap_pt=24.0, y_gap_pt=36.0)
    colour_bar(axes, mesh, "growth rate of the most unstable pair [1/s]", left=0.875, gap_pt=34.0)
    share = f"unstable over {100.0 * found.unstable_share:.1f} % of the area"
    figure.suptitle(f"{found.model_name}: {share}", x=0.1, y=0.975, **TITLE)
    line = Line2D([], [], color=INK, lw=1.6, label="stability boundary, with frequency in Hz")
    if found.boundary:
        figure.legend(handles=[line], loc="upper left", bbox_to_anchor=(0.095, 0.935), frameon=False)
    return figure


def growth_figure(
    way: Direction, numbers: Array, growth: Array, results: Sequence[StabilityBoundary], model: str
) -> Figure:
    """Growth rate over one quantity; crossings marked."""
    figure = new_figure(8.0, 4.2)
    axes = figure.subplots()
    figure.subplots_adjust(left=0.1, right=0.97, top=0.87, bottom=0.14)
    grid(axes)
    axes.axhline(0.0, color=GREY, lw=1.0)
    axes.plot(numbers, np.where(growth <= 0.0, growth, np.nan), color=BLUE, lw=1.8, label="stable")
    axes.plot(numbers, np.where(growth >= 0.0, growth, np.nan), color=VERMILION, lw=1.8, label="unstable")
    for result in results:
        point = result.point
        if point is None:
            continue
        axes.plot([point.value], [0.0], "o", color=INK, ms=6, zorder=4)
        name = f"{point.frequency_hz:.1f} Hz" if point.kind == "flutter" else "divergence"
        right = point.value > 0.5 * (numbers[0] + numbers[-1])
        text = axes.annotate(
            f"{point.value:.5g}: {name}",
            (point.value, 0.0),
            xytext=(-8 if right else 8, 9),
            textcoords="offset points",
            ha="right" if right else "left",
            fontweight="bold",
        )
        text.set_path_effects([withStroke(linewidth=3.0, foreground="white")])
    axes.set_xlim(float(numbers[0]), float(numbers[-1]))
    low, high = float(growth.min()), float(growth.max())
    room = 0.12 * max(high - low, 1e-3)
    axes.set_ylim(min(low, 0.0) - room, max(high, 0.0) + room)
    label_axes(axes, axis_label(way), "largest real part [1/s]", x_gap_pt=24.0, y_gap_pt=40.0)
    figure.suptitle(f"{model}: growth rate of the most unstable pair", x=0.1, y=0.965, **TITLE)
    axes.legend(loc="best")
    return figure


def curve_figure(curve: BoundaryCurve, model: str) -> Figure:
    """Boundary over what it runs along; frequency below."""
    figure = new_figure(8.0, 5.2)
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
    figure.subplots_adjust(left=0.1, right=0.97, top=0.88, bottom=0.11, hspace=0.12)
    x, y = curve.along_values, curve.values
    shaded = bool(np.isfinite(y).any()) and not curve.starts_unstable.any()
    flutter = curve.frequencies_hz > 0.0
    for axes in (top, bottom):
        grid(axes)
    top.plot(x, y, color=INK, lw=1.6)
    for which, colour, marker, name in (
        (flutter, BLUE, "o", "flutter"),
        (curve.frequencies_hz == 0.0, VERMILION, "s", "divergence"),
    ):
        if which.any():
            size = 4.0 if len(x) <= 60 else 2.0
            top.plot(x[which], y[which], marker, color=colour, ms=size, label=name)
            bottom.plot(x[which], curve.frequencies_hz[which] / 1e3, marker, color=colour, ms=size)
    if np.isfinite(y).any():
        top.legend(loc="best")
    if shaded:
        top.set_ylim(top.get_ylim())
        top.fill_between(x, y, curve.high, color=VERMILION, alpha=0.12, lw=0, where=np.isfinite(y))
    top.ticklabel_format(axis="y", useOffset=False)
    bottom.ticklabel_format(axis="y", useOffset=False)
    middle = float(np.nanmean(curve.frequencies_hz)) / 1e3 if np.isfinite(y).any() else 0.0
    low, high = bottom.get_ylim()
    if high - low < 0.02 * max(middle, 1e-3):
        bottom.set_ylim(middle - 0.02 * middle - 1e-3, middle + 0.02 * middle + 1e-3)
    label_axes(top, y=axis_label(curve.moved), y_gap_pt=38.0)
    label_axes(bottom, axis_label(curve.along), "frequency [kHz]", x_gap_pt=24.0, y_gap_pt=38.0)
    text = "unstable in the shaded area" if shaded else "first change of stability"
    figure.suptitle(f"{model}: stability boundary, {text}", x=0.1, y=0.965, **TITLE)
    return figure


def _colours(growth: Array) -> tuple[Colormap, Normalize]:
    """Colours that change from blue to red at growth rate 0."""
    low, high = float(growth.min()), float(growth.max())
    if low < 0.0 < high:
        return _BOTH, TwoSlopeNorm(0.0, low, high)
    if low == high:
        low, high = low - 1.0, high + 1.0
    return _ONE_SIDE[low >= 0.0], Normalize(low, high)


def _edges(values: Array) -> Array:
    """Edges of cells around values."""
    if len(values) == 1:
        half = 0.5 * (abs(values[0]) or 1.0) * 0.1
        return np.array([values[0] - half, values[0] + half])
    middles = 0.5 * (values[1:] + values[:-1])
    return np.concatenate(
        [[1.5 * values[0] - 0.5 * values[1]], middles, [1.5 * values[-1] - 0.5 * values[-2]]]
    )


def _limits(values: Array) -> tuple[float, float]:
    """Limits of an axis, rising."""
    numbers = _edges(values) if len(values) == 1 else values
    return float(numbers.min()), float(numbers.max())


def _frequency_labels(axes: Axes, lines: tuple[BoundaryLine, ...]) -> None:
    """Frequencies beside the lines, apart from each other."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    placed: list[tuple[float, float]] = []
    for line in lines:
        u, v = (line.x - left) / (right - left), (line.y - low) / (high - low)
        inside = (u > 0.04) & (u < 0.96) & (v > 0.04) & (v < 0.96)
        order = np.flatnonzero(inside)
        for k in order[np.argsort(np.abs(order - 0.5 * len(line.x)))]:
            near = any(np.hypot(u[k] - a, v[k] - b) < _APART for a, b in placed)
            if near or len(placed) >= _LABELLED:
                continue
            placed.append((float(u[k]), float(v[k])))
            name = f"{line.frequency_hz[k]:.0f}" if line.frequency_hz[k] > 0.0 else "divergence"
            text = axes.text(
                float(line.x[k]),
                float(line.y[k]),
                name,
                ha="center",
                va="center",
                fontsize=8.5,
                color=INK,
                fontweight="bold",
            )
            text.set_path_effects([withStroke(linewidth=3.0, foreground="white")])

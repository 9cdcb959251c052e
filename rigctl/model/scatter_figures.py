"""Tables and figures of a Monte Carlo study (`rigctl.model.scatter`).

NOT its job: samples, statistics.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from rigctl.analysis.style import (
    BLUE,
    GREEN,
    GREY,
    PALE,
    TITLE,
    VERMILION,
    axes_title,
    grid,
    label_axes,
    new_figure,
)
from rigctl.model.output import Column, Table
from sim_hardware.brake_model.design.scatter import (
    Drivers,
)
from sim_hardware.brake_model.linear import MU, PRESSURE, LinearModel, known

if TYPE_CHECKING:
    from rigctl.model.scatter import ScatterResult

Array = NDArray[np.float64]

_SHOWN_DRIVERS = 12


_AXIS = {PRESSURE: "brake pressure [bar]", MU: "coefficient of friction"}


def _axis(over: str, unit: str) -> str:
    return _AXIS.get(over, f"{over} [{unit}]" if unit else over)


def probability_table(result: ScatterResult, over: str, unit: str) -> Table:
    """Share of samples that are unstable, with its interval."""
    reached = [float((result.onsets <= x).mean()) for x in result.nominal.grid]
    return Table(
        "probability",
        "Share of samples that are unstable",
        (
            Column(over, unit, result.nominal.grid.tolist()),
            Column("squeal_probability", "", result.squeal.share.tolist()),
            Column("low_95", "", result.squeal.low.tolist()),
            Column("high_95", "", result.squeal.high.tolist()),
            Column("onset_reached", "", reached),
        ),
    )


def drivers_table(model: LinearModel, result: ScatterResult) -> Table:
    """Rank correlations, strongest first."""
    onset, frequency = result.by_onset, result.by_frequency
    strength = np.nan_to_num(np.abs(np.stack([onset.correlation, frequency.correlation]))).max(axis=0)
    order = np.argsort(-strength, kind="stable")
    return Table(
        "drivers",
        "What drives onset and frequency: rank correlation with each variable",
        (
            Column("variable", "", [result.variables[i].name for i in order]),
            Column("title", "", [result.variables[i].title for i in order]),
            Column("kind", "", [known(model, result.variables[i].members[0]).kind for i in order]),
            Column("onset_correlation", "", onset.correlation[order].tolist()),
            Column("onset_beyond_chance", "", _beyond(onset, order)),
            Column("frequency_correlation", "", frequency.correlation[order].tolist()),
            Column("frequency_beyond_chance", "", _beyond(frequency, order)),
        ),
    )


def _beyond(found: Drivers, order: NDArray[np.intp]) -> list[bool]:
    return [bool(abs(found.correlation[i]) > found.threshold) for i in order]


def samples_table(result: ScatterResult, over: str, unit: str) -> Table:
    """Every sample."""
    factors = [Column(v.name, "", result.factors[:, i].tolist()) for i, v in enumerate(result.variables)]
    return Table(
        "samples",
        "All samples: onset, frequency, factor of each variable",
        (
            Column("sample", "", range(1, len(result.onsets) + 1)),
            Column(f"onset_{over}", unit, result.onsets.tolist()),
            Column("frequency", "Hz", result.frequencies_hz.tolist()),
            *factors,
        ),
    )


def draw_probability(result: ScatterResult, over: str, unit: str) -> Figure:
    """Squeal probability over the quantity."""
    figure = new_figure(8.0, 4.4)
    axes = figure.subplots()
    figure.subplots_adjust(left=0.09, right=0.97, top=0.9, bottom=0.13)
    x, squeal = result.nominal.grid, result.squeal
    axes.fill_between(
        x, 100 * squeal.low, 100 * squeal.high, color=BLUE, alpha=0.2, lw=0, label="95 % confidence (Wilson)"
    )
    axes.plot(x, 100 * squeal.share, color=BLUE, lw=1.8, label=f"share of {len(result.onsets)} samples")
    if result.nominal.onset is not None:
        axes.axvline(
            result.nominal.onset, color=VERMILION, lw=1.5, ls=(0, (5, 2)),
            label=f"onset of the file's values: {result.nominal.onset:.3g}{' ' + unit if unit else ''}",
        )  # fmt: skip
    axes.set_xlim(x[0], x[-1])
    axes.set_ylim(0, 104)
    label_axes(axes, _axis(over, unit), "squeal probability [%]")
    grid(axes)
    axes.legend(loc="upper left" if squeal.share[: len(x) // 3].max(initial=0) < 0.5 else "lower right")
    figure.suptitle(f"Squeal probability over {_axis(over, unit).split(' [')[0]}", x=0.09, y=0.97, **TITLE)
    return figure


def draw_distribution(result: ScatterResult, over: str, unit: str) -> Figure:
    """Histograms of onset and frequency."""
    figure = new_figure(8.0, 4.0)
    left, right = figure.subplots(1, 2)
    figure.subplots_adjust(left=0.08, right=0.97, top=0.84, bottom=0.145, wspace=0.2)
    figure.suptitle("Where scattered brakes begin to squeal; shaded: 10–90 %", x=0.08, y=0.965, **TITLE)
    stable = float(np.isinf(result.onsets).mean())
    panels = (
        (left, result.onsets[np.isfinite(result.onsets)], result.nominal.onset, _axis(over, unit), "onset"),
        (right, result.frequencies_hz, result.nominal.frequency_hz, "frequency at onset [Hz]", "frequency"),
    )
    for axes, values, nominal, label, name in panels:
        there = values[np.isfinite(values)]
        label_axes(axes, label, "samples" if axes is left else "")
        axes.yaxis.set_major_locator(MaxNLocator(6, integer=True))
        note = f", {100 * stable:.0f} % stay stable" if name == "onset" and stable else ""
        axes_title(axes, f"{name.capitalize()}{note}")
        if there.size == 0:
            axes.text(0.5, 0.5, "no sample squeals", transform=axes.transAxes, ha="center", color=GREY)
            continue
        low, high = np.quantile(there, (0.005, 0.995))
        axes.hist(
            there,
            bins=int(np.clip(np.sqrt(there.size), 5, 50)),
            range=(low, max(high, low + 1e-9)),
            color=BLUE,
            alpha=0.85,
        )
        axes.axvspan(*np.quantile(there, (0.1, 0.9)), color=PALE, zorder=0)
        if nominal is not None:
            axes.axvline(nominal, color=VERMILION, lw=1.5, ls=(0, (5, 2)), label="file's values")
            axes.legend(loc="upper right")
    return figure


def draw_drivers(result: ScatterResult) -> Figure:
    """Rank correlations as bars."""
    onset = np.nan_to_num(result.by_onset.correlation)
    frequency = np.nan_to_num(result.by_frequency.correlation)
    strength = np.maximum(np.abs(onset), np.abs(frequency))
    order = np.argsort(-strength, kind="stable")[:_SHOWN_DRIVERS]
    figure = new_figure(8.0, 1.4 + 0.34 * len(order))
    axes = figure.subplots()
    width = max(len(result.variables[i].title) for i in order)
    bottom = 0.55 / figure.get_figheight()
    figure.subplots_adjust(left=min(0.1 + 0.0095 * width, 0.5), right=0.97, top=0.92, bottom=bottom)
    rows = np.arange(len(order))
    axes.barh(rows - 0.18, onset[order], 0.34, color=BLUE, label="onset")
    axes.barh(rows + 0.18, frequency[order], 0.34, color=GREEN, label="frequency")
    chance = result.by_onset.threshold
    if np.isfinite(chance):
        axes.axvspan(-chance, chance, color=PALE, zorder=0, label="could be chance")
    axes.axvline(0.0, color=GREY, lw=0.8)
    axes.set_yticks(rows, [result.variables[i].title for i in order])
    axes.invert_yaxis()
    axes.set_xlim(-1, 1)
    label_axes(axes, "rank correlation with the variable")
    grid(axes, "x")
    axes.legend(loc="lower right")
    figure.suptitle("What drives the onset and the frequency of squeal", x=0.03, y=0.98, **TITLE)
    return figure

"""Drawings of limit cycles: bifurcation diagram with frequency, ramps up and down.

NOT its job: what is drawn (`limit_cycle`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from rigctl.analysis.style import (
    BLUE,
    GREY,
    INK,
    ORANGE,
    SKY,
    TITLE,
    VERMILION,
    axes_title,
    grid,
    label_axes,
    new_figure,
)
from sim_hardware.brake_model.time_domain.limit_cycle import Branches
from sim_hardware.brake_model.time_domain.squeal_ramp import Ramp

Levels = Callable[[Any], Any]
_LABELS = {
    "pressure": "brake pressure p [bar]",
    "mu": "coefficient of friction μ",
    "slope": "falling slope k [s/m]",
    "slip": "sliding speed [m/s]",
}
_UNSTABLE = "#FBE3D6"


def bifurcation_figure(found: Branches, runs: Sequence[Ramp], heading: str, levels: Levels | None) -> Figure:
    """Level (where there is sound), amplitude and frequency of the limit cycles over the quantity."""
    rows = 3 if levels else 2
    figure = new_figure(8.6, 2.35 * rows + 1.0)
    top = 1.0 - 0.88 / (2.35 * rows + 1.0)
    figure.subplots_adjust(left=0.1, right=0.975, top=top, bottom=0.5 / (2.35 * rows + 1.0), hspace=0.34)
    figure.suptitle(heading, x=0.1, y=1.0 - 0.12 / (2.35 * rows + 1.0), **TITLE)
    panels = list(figure.subplots(rows, 1, sharex=True))
    for axes in panels:
        _stability(axes, found)
    if levels:
        _level(panels[0], found, runs, levels)
    _amplitude(panels[-2], found, () if levels else runs)
    _frequency(panels[-1], found)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="upper left", bbox_to_anchor=(0.093, top + 0.56 / (2.35 * rows + 1.0)),
        ncols=len(handles), borderaxespad=0.0, columnspacing=1.2, handletextpad=0.5, frameon=False,
    )  # fmt: skip
    label_axes(panels[-1], x=_x_label(found))
    return figure


def ramp_figure(found: Branches, runs: Sequence[Ramp], heading: str) -> Figure:
    """Amplitude over the quantity on every ramp, and the width between onset and end over the duration."""
    figure = new_figure(10.0, 4.4)
    course, width = figure.subplots(1, 2, width_ratios=(1.9, 1.0))
    figure.subplots_adjust(left=0.07, right=0.985, top=0.82, bottom=0.13, wspace=0.22)
    figure.suptitle(heading, x=0.07, y=0.97, **TITLE)
    durations = list(dict.fromkeys(run.duration_s for run in runs))
    for number, duration in enumerate(durations):
        run = next(r for r in runs if r.duration_s == duration)
        shade = 0.3 + 0.7 * (number + 1) / len(durations)
        up, down = (f"{way}, {duration:g} s" for way in ("up", "down"))
        course.semilogy(run.up, run.slip_up_m_s, color=ORANGE, alpha=shade, lw=1.3, label=up)
        course.semilogy(run.down, run.slip_down_m_s, color=BLUE, alpha=shade, lw=1.3, label=down)
    _stability(course, found, label=False)
    axes_title(course, "Slip amplitude; one excitation of each duration")
    label_axes(course, _x_label(found), "m/s", y_gap_pt=32.0)
    course.legend(loc="best", ncols=2)
    grid(course)
    known = [run for run in runs if run.width is not None]
    width.plot(
        [r.duration_s for r in known], [r.width for r in known], "o", color=VERMILION, ms=5, label="ramps"
    )
    if found.hysteresis is not None:
        width.axhline(found.hysteresis, color=INK, lw=1.0, ls=(0, (4, 2)), label="steady motions")
    width.set_xscale("log")
    width.set_xticks(durations, [f"{d:g}" for d in durations], minor=False)
    width.set_xticks([], minor=True)
    widths = [0.0, found.hysteresis or 0.0, *(run.width for run in known if run.width is not None)]
    reach = (max(widths) - min(widths)) or 1.0
    width.set_ylim(min(widths) - 0.05 * reach, max(widths) + 0.1 * reach)
    width.set_xlim(0.85 * min(durations), 1.18 * max(durations))
    unit = found.points.unit
    axes_title(width, "Onset (up) minus end (down)")
    label_axes(width, "duration of one direction [s]", unit if unit != "1" else "")
    width.legend(loc="lower left")
    grid(width)
    return figure


def _x_label(found: Branches) -> str:
    p = found.points
    return _LABELS.get(p.quantity, f"{p.quantity} [{p.unit}]" if p.unit else p.quantity)


def _stability(axes: Axes, found: Branches, *, label: bool = True) -> None:
    """Shade where eigenvalues say unstable; line at the onset."""
    values, growth = found.points.values, found.mode.growth_1_s
    low, high = float(values.min()), float(values.max())
    if low == high:
        low, high = low - 0.5, high + 0.5
    axes.set_xlim(low, high)
    onset = found.onset_eigenvalues
    if onset is None:
        if (growth > 0.0).all():
            axes.axvspan(low, high, color=_UNSTABLE, lw=0, zorder=0)
        return
    beyond = values[int(np.argmax(growth))]
    axes.axvspan(onset, high if beyond > onset else low, color=_UNSTABLE, lw=0, zorder=0)
    axes.axvline(onset, color=INK, lw=1.0, zorder=1, label="onset (eigenvalues)" if label else None)


def _branches(axes: Axes, found: Branches, small: Any, large: Any) -> None:
    """Both branches: circles where small starts end, crosses where large ones do."""
    x = found.points.values
    axes.plot(x, large, "o", mfc="none", mec=BLUE, ms=6.5, mew=1.1, zorder=3, label="large start")
    axes.plot(x, small, ".", color=VERMILION, ms=6, zorder=4, label="small start")


def _slowest(runs: Sequence[Ramp]) -> Ramp | None:
    return max(runs, key=lambda run: run.duration_s) if runs else None


def _level(axes: Axes, found: Branches, runs: Sequence[Ramp], levels: Levels) -> None:
    small, large = (
        np.where(c.squeals, levels(c.radiated), np.nan) for c in (found.small, found.large)
    )  # fmt: skip
    if (run := _slowest(runs)) is not None:
        axes.plot(
            run.up,
            levels(run.radiated_up),
            color=ORANGE,
            lw=1.3,
            zorder=2,
            label=f"ramp up, {run.duration_s:g} s",
        )
        axes.plot(run.down, levels(run.radiated_down), color=SKY, lw=1.3, zorder=2, label="down")
    _branches(axes, found, small, large)
    axes_title(axes, "Sound level of the brake at the microphone")
    label_axes(axes, y="dB", y_gap_pt=34.0)
    known = np.concatenate([small, large])
    if np.isfinite(known).any():
        axes.set_ylim(max(0.0, 10.0 * np.floor(np.nanmin(known) / 10.0) - 20.0), np.nanmax(known) + 4.0)
    grid(axes)


def _amplitude(axes: Axes, found: Branches, runs: Sequence[Ramp]) -> None:
    if (run := _slowest(runs)) is not None:
        axes.plot(
            run.up, run.slip_up_m_s, color=ORANGE, lw=1.3, zorder=2, label=f"ramp up, {run.duration_s:g} s"
        )
        axes.plot(run.down, run.slip_down_m_s, color=SKY, lw=1.3, zorder=2, label="down")
    small, large = (
        np.where(c.squeals | c.settled, c.slip_amplitude_m_s, np.nan) for c in (found.small, found.large)
    )  # fmt: skip
    _branches(axes, found, small, large)
    slip = found.points.slip_m_s
    top = float(np.nanmax(np.concatenate([large, small, [0.0]])))
    if top > 0.5 * float(slip.min()):
        axes.plot(found.points.values, slip, color=GREY, lw=1.0, ls=(0, (4, 2)), zorder=1)
        axes.annotate(
            "sliding speed", (found.points.values[0], slip[0]), xytext=(5, -3),
            textcoords="offset points", color=GREY, fontsize=8.5, va="top",
        )  # fmt: skip
    axes.set_ylim(0.0, 1.12 * max(top, 1e-12))
    axes_title(axes, "Slip amplitude")
    label_axes(axes, y="m/s", y_gap_pt=34.0)
    grid(axes)


def _frequency(axes: Axes, found: Branches) -> None:
    _branches(axes, found, found.small.frequency_hz, found.large.frequency_hz)
    axes.plot(found.points.values, found.mode.frequency_hz, color=GREY, lw=1.0, zorder=2)
    shown = np.concatenate([found.small.frequency_hz, found.large.frequency_hz, found.mode.frequency_hz])
    low, high = float(np.nanmin(shown)), float(np.nanmax(shown))
    margin = max(0.1 * (high - low), 1.0)
    axes.set_ylim(low - margin, high + margin)
    axes.ticklabel_format(axis="y", useOffset=False)
    axes.yaxis.set_major_locator(MaxNLocator(5))
    axes_title(axes, "Frequency; grey: imaginary part of the eigenvalue")
    label_axes(axes, y="Hz", y_gap_pt=42.0)
    grid(axes)

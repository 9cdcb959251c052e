"""Drawing of simulated motions: sliding speed and friction over time, forces in the coupling elements.

NOT its job: simulating (`motion`).
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from rigctl.analysis.style import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    TITLE,
    VERMILION,
    axes_title,
    grid,
    label_axes,
    new_figure,
)
from sim_hardware.brake_model.time_domain.motion import CouplingForces, Motion

Array = NDArray[np.float64]
_COLOURS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, GREY)
_LINES = ("-", (0, (4, 1.5)), (0, (1, 1)), (0, (5, 1, 1, 1)))
#: points of an envelope, and samples of the enlarged end
_ENVELOPE, _ZOOM = 1200, 160
_STUCK = "#F3DCA8"


def motion_figure(motion: Motion, title: str) -> Figure:
    """Sliding speed over the whole time, and its last part enlarged with the friction forces."""
    figure = new_figure(9.6, 6.0)
    whole, speed, friction = figure.subplots(3, 1, height_ratios=(1.0, 1.0, 1.0))
    figure.subplots_adjust(left=0.085, right=0.975, top=0.87, bottom=0.085, hspace=0.5)
    figure.suptitle(
        title, x=0.085, y=0.985, fontsize=9.5, **{k: v for k, v in TITLE.items() if k != "fontsize"}
    )
    zoom = slice(max(0, len(motion.times_s) - _ZOOM), None)
    time_ms = 1e3 * motion.times_s
    handles: list[Line2D | Patch] = []
    for g, name in enumerate(motion.groups):
        look = {"color": _COLOURS[g % len(_COLOURS)], "ls": _LINES[g % len(_LINES)]}
        _envelope(whole, time_ms, motion.sliding_speed_m_s[:, g], str(look["color"]))
        speed.plot(time_ms[zoom], motion.sliding_speed_m_s[zoom, g], lw=1.4, **look)
        friction.plot(time_ms[zoom], motion.friction_n[zoom, g], lw=1.4, **look)
        handles.append(Line2D([], [], lw=1.4, label=name, **look))
    begin, end = float(time_ms[zoom][0]), float(time_ms[-1])
    spans = 1e3 * np.vstack([motion.sticking_s(g) for g in range(len(motion.groups))])
    spans = spans[spans[:, 1] > begin]
    for first, last in spans:
        for axes in (speed, friction):
            axes.axvspan(max(first, begin), last, color=_STUCK, lw=0, zorder=0)
    if len(spans):
        handles.append(Patch(facecolor=_STUCK, label="a pad sticks"))
    for axes in (whole, speed):
        axes.axhline(0.0, color=GREY, lw=0.8)
    axes_title(whole, "Sliding speed: all the time (envelope)")
    axes_title(speed, "Sliding speed: the end")
    axes_title(friction, "Friction force on the pad: the end")
    label_axes(whole, "time [ms]", "speed [m/s]", y_gap_pt=36.0)
    label_axes(speed, "", "speed [m/s]", y_gap_pt=36.0)
    label_axes(friction, "time [ms]", "force [N]", y_gap_pt=36.0)
    for axes in (whole, speed, friction):
        axes.margins(x=0.0, y=0.08)
        axes.set_xlim(0.0 if axes is whole else begin, end)
        grid(axes)
    figure.legend(handles=handles, loc="upper right", ncols=len(handles), bbox_to_anchor=(0.975, 0.955))
    return figure


def _envelope(axes: Axes, time: Array, values: Array, colour: str) -> None:
    """Least and largest value of each of many short pieces: quick to draw, nothing is lost."""
    pieces = min(_ENVELOPE, len(values))
    edges = np.linspace(0, len(values), pieces + 1).astype(int)[:-1]
    low, high = np.minimum.reduceat(values, edges), np.maximum.reduceat(values, edges)
    axes.fill_between(time[edges], low, high, color=colour, alpha=0.45, lw=0.6)


def forces_figure(forces: CouplingForces, title: str) -> Figure:
    """Largest force variation of every coupling element along its axes."""
    peaks = np.abs(forces.forces_n).max(axis=0)
    count = len(forces.elements)
    figure = new_figure(9.6, max(3.2, 1.4 + 0.24 * count))
    axes = figure.subplots()
    height = figure.get_figheight()
    figure.subplots_adjust(left=0.15, right=0.98, top=1.0 - 0.85 / height, bottom=0.5 / height)
    figure.suptitle(title, x=0.02, y=1.0 - 0.1 / height, fontsize=9.5, ha="left", va="top", fontweight="bold")
    place = np.arange(count)
    axes.barh(place - 0.19, peaks[:, 0], height=0.36, color=BLUE, label="along x (contacts: friction)")
    axes.barh(place + 0.19, peaks[:, 1], height=0.36, color=ORANGE, label="along y (contacts: normal)")
    axes.set_yticks(place, list(forces.elements))
    axes.invert_yaxis()
    axes_title(axes, "Largest force variation in each coupling element")
    label_axes(axes, "force [N]")
    axes.legend(loc="lower right")
    grid(axes, "x")
    return figure

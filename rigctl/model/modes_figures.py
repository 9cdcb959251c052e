"""Drawings of a mode: the deformed brake at two phases, energies and budget as bars, freedoms as bars.

NOT its job: shapes and energies (`sim_hardware.brake_model.eigen.mode_shapes`), how a brake is painted
(`brake_painting`).
"""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rigctl.analysis.style import (
    BLUE,
    GREY,
    INK,
    ORANGE,
    TITLE,
    VERMILION,
    axes_title,
    grid,
    label_axes,
    new_figure,
)
from rigctl.model.brake_drawing import Drawing
from rigctl.model.brake_painting import Motions, label_of, paint
from sim_hardware.brake_model.eigen.mode_shapes import ModeShape, Participation

#: nearly standing wave: a quarter period later there is nothing to see
_STANDING = 0.98
_BARS = 12


def shape_figure(picture: Drawing, motions: Motions, shape: ModeShape, title: str) -> Figure:
    """The deformed brake at two phases."""
    later = 180.0 if shape.collinearity >= _STANDING else 90.0
    x0, x1, y0, y1 = picture.box
    ratio = (y1 - y0 + 0.14 * picture.size) / (x1 - x0 + 0.14 * picture.size)
    width = 12.0
    height = 0.5 * width * ratio + 0.75
    figure = new_figure(width, height)
    panels = figure.subplots(1, 2)
    figure.subplots_adjust(left=0.005, right=0.995, bottom=0.005, top=1.0 - 0.68 / height, wspace=0.01)
    figure.suptitle(title, x=0.012, y=1.0 - 0.1 / height, **TITLE)
    span = "half a period later" if later > 90.0 else "a quarter of a period later"
    for axes, phase, text in zip(panels, (0.0, later), ("largest motion", span), strict=True):
        paint(axes, picture, motions, np.radians(phase))
        axes.text(
            0.01,
            1.0,
            f"{text}; dashed: at rest",
            transform=axes.transAxes,
            va="bottom",
            fontsize=8.5,
            color=GREY,
        )
    return figure


def budget_figure(shape: ModeShape, shares: Participation, title: str) -> Figure:
    """Kinetic energy by body, strain energy by coupling, and what every coupling adds to the real part."""
    figure = new_figure(11.0, 4.9)
    left, middle, right = figure.subplots(1, 3)
    figure.subplots_adjust(left=0.115, right=0.985, top=0.85, bottom=0.11, wspace=0.5)
    figure.suptitle(title, x=0.012, y=0.975, **TITLE)
    bodies = sorted(shares.bodies, key=lambda b: b.kinetic)
    _bars(left, [label_of(b.name) for b in bodies], [100 * b.kinetic for b in bodies], BLUE)
    axes_title(left, "Kinetic energy of bodies")
    label_axes(left, "share [%]")
    strained = sorted(shares.couplings, key=lambda c: c.strain)[-_BARS:]
    _bars(middle, [c.name for c in strained], [100 * c.strain for c in strained], ORANGE)
    axes_title(middle, "Strain energy of couplings")
    label_axes(middle, "share [%]")
    size = [max(abs(c.damping_1_s), abs(c.friction_1_s)) for c in shares.couplings]
    acting = [shares.couplings[k] for k in np.argsort(size)[-_BARS:]]
    names = [c.name for c in acting]
    right.barh(
        names,
        [c.damping_1_s for c in acting],
        color=BLUE,
        height=0.7,
        label=f"dampers: {shares.damping_1_s:+.4g} 1/s",
    )
    right.barh(
        names,
        [c.friction_1_s for c in acting],
        color=VERMILION,
        height=0.34,
        label=f"friction: {shares.friction_1_s:+.4g} 1/s",
    )
    right.axvline(0.0, color=INK, lw=0.9)
    right.legend(loc="lower right" if shares.friction_1_s >= 0 else "lower left")
    right.margins(x=0.08)
    axes_title(right, f"Real part {shape.eigenvalue.real:+.4g} 1/s")
    label_axes(right, "adds to the real part [1/s]")
    grid(right, "x")
    return figure


def freedoms_figure(shape: ModeShape, title: str) -> Figure:
    """Largest degrees of freedom as bars: amplitude and phase."""
    order = np.argsort(-np.abs(shape.vector))[:24][::-1]
    figure = new_figure(8.0, 1.3 + 0.24 * len(order))
    axes = figure.subplots()
    figure.subplots_adjust(left=0.22, right=0.965, top=1.0 - 0.75 / figure.get_figheight(), bottom=0.12)
    figure.suptitle(title, x=0.02, y=0.98, **TITLE)
    amplitude = np.abs(shape.vector[order])
    amplitude = amplitude / (amplitude.max() or 1.0)
    names = [shape.freedoms[k] for k in order]
    axes.barh(names, amplitude, color=BLUE, height=0.7)
    for row, (size, z) in enumerate(zip(amplitude, shape.vector[order], strict=True)):
        axes.text(size + 0.01, row, f"{np.degrees(np.angle(z)):+.0f}°", va="center", fontsize=8, color=INK)
    axes.set_xlim(0.0, 1.12)
    label_axes(axes, "amplitude relative to the largest; phase beside the bars")
    grid(axes, "x")
    return figure


def _bars(axes: Axes, names: list[str], percent: list[float], colour: str) -> None:
    axes.barh(names, percent, color=colour, height=0.7)
    top = max([*percent, 1e-12])
    for row, value in enumerate(percent):
        axes.text(value + 0.015 * top, row, f"{value:.0f}", va="center", fontsize=8, color=INK)
    axes.set_xlim(0.0, 1.13 * top)
    grid(axes, "x")

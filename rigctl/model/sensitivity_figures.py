"""Figures of the sensitivity studies: bars over eigenvalues (Figs 8, 10), bars over modifications (Fig. 9),
rankings.

NOT its job: the numbers (`sensitivity`, `advice`, `claims`).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from rigctl.analysis.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    TITLE,
    VERMILION,
    axes_title,
    grid,
    label_axes,
    new_figure,
)
from sim_hardware.brake_model.design.effects import Effect, Influence
from sim_hardware.brake_model.design.robustness import Robustness
from sim_hardware.brake_model.linear import MU

Array = NDArray[np.float64]

#: colours of kinds of quantities
KIND_COLOURS = {
    "stiffness": BLUE, "damping": GREEN, "inertia": ORANGE, "geometry": PURPLE, "operating": VERMILION,
    "other": GREY,
}  # fmt: skip
#: colour of a real part that rises (less stable) and of one that falls
RISES, FALLS = VERMILION, BLUE
_MOST_LABELS = 16
#: mean width of a letter of tick labels, inch
_LETTER = 0.068
_SYMMETRIC, _ASYMMETRIC = BLUE, ORANGE


def eigenvalue_ticks(axes: Axes, values: NDArray[np.complex128]) -> None:
    """Ticks over the index i = 1…m: pairs as "5, 6" with their frequency in kHz below."""
    places, labels, i = [], [], 0
    while i < values.size:
        paired = i + 1 < values.size and values[i].imag != 0.0
        places.append(i + 1.5 if paired else i + 1.0)
        kilohertz = abs(values[i].imag) / 2e3 / np.pi
        labels.append(f"{i + 1}, {i + 2}\n{kilohertz:.2f}" if paired else f"{i + 1}\n{kilohertz:.2g}")
        i += 2 if paired else 1
    every = -(-len(places) // _MOST_LABELS)
    axes.set_xticks(places[::every], labels[::every], fontsize=8)
    axes.tick_params(axis="x", length=0)
    axes.set_xlim(0.2, values.size + 0.8)


def eigenvalue_bars(axes: Axes, changes: Array) -> None:
    """One bar for each eigenvalue, coloured by its sign."""
    colours = [RISES if change > 0.0 else FALLS for change in changes]
    axes.bar(np.arange(1, changes.size + 1), changes, width=0.8, color=colours)
    axes.axhline(0.0, color=INK, lw=0.8)
    axes.margins(y=0.12)
    grid(axes, "y")


def robustness_figure(found: Robustness, below_hz: float) -> Figure:
    """Eq 25 of the basic design over i = 1…m with the reference line (Fig. 8); below it the low frequencies
    alone.
    """
    nominal = found.resolved.nominal[0]
    low = int((found.frequencies_hz < below_hz).sum())
    both = 0 < low < nominal.size
    figure = new_figure(8.0, 6.0 if both else 4.2)
    panels = np.atleast_1d(figure.subplots(2 if both else 1, 1))
    figure.subplots_adjust(
        left=0.095,
        right=0.975,
        top=1.0 - 0.9 / figure.get_figheight(),
        bottom=0.66 / figure.get_figheight(),
        hspace=0.5,
    )
    symbol = "μ" if found.quantity == MU else found.quantity
    _title(figure, f"Robustness of the basic design: {symbol} {found.low:g} → {found.high:g}", 0.095)
    sizes = [nominal.size, low]
    for axes, size in zip(panels, sizes, strict=False):
        shown = found.basic[:size]
        eigenvalue_bars(axes, shown)
        eigenvalue_ticks(axes, nominal[:size])
        worst = int(shown.argmax())
        axes.axhline(float(shown[worst]), color=GREY, lw=1.2, ls=(0, (4, 2)))
        axes.annotate(
            f"maximum {shown[worst]:.3g} 1/s at {found.frequencies_hz[worst]:.0f} Hz", (0.3, shown[worst]),
            xytext=(3, 3), textcoords="offset points", fontsize=8.5, color=INK,
        )  # fmt: skip
        label_axes(axes, y=f"S = ΔRe λ / Δ{symbol}  [1/s]", y_gap_pt=38.0)
    axes_title(panels[0], "all eigenvalues" if both else "")
    if both:
        axes_title(panels[1], f"below {below_hz / 1e3:g} kHz, enlarged")
    label_axes(panels[-1], "eigenvalue i; below: frequency [kHz]", x_gap_pt=30.0)
    _legend(figure, (("loses damping", RISES), ("gains damping", FALLS)), 0.095)
    return figure


def positions_figure(found: Robustness, chosen: Sequence[int], below_hz: float) -> Figure:
    """Maximum of eq 25 for some modifications (Fig. 9): over all eigenvalues, and over those of low
    frequency.
    """
    labels = [found.variations[i].title for i in chosen]
    side = 0.25 + _LETTER * max(map(len, labels))
    width, height = side + 5.6, 1.55 + 0.33 * len(chosen)
    figure = new_figure(width, height)
    left, right = figure.subplots(1, 2, sharey=True)
    figure.subplots_adjust(
        left=side / width, right=0.975, top=1.0 - 0.9 / height, bottom=0.55 / height, wspace=0.1
    )
    _title(figure, "Largest robustness value of modified designs", 0.02)
    below = found.frequencies_hz < below_hz
    low_reference = float(found.basic[below].max()) if below.any() else float("nan")
    low = found.maxima_below(below_hz)
    places = np.arange(len(chosen))[::-1]
    colours = [_SYMMETRIC if found.variations[i].symmetric else _ASYMMETRIC for i in chosen]
    panels = (
        (left, found.maxima, found.reference, "all eigenvalues"),
        (right, low, low_reference, f"below {below_hz / 1e3:g} kHz"),
    )
    for axes, maxima, reference, title in panels:
        shown = maxima[list(chosen)]
        axes.barh(places, shown, height=0.68, color=colours)
        axes.axvline(reference, color=INK, lw=1.2, ls=(0, (4, 2)))
        top = max(float(np.nanmax(shown)), reference)
        axes.set_xlim(min(0.0, float(np.nanmin(shown))), 1.17 * top)
        for place, value in zip(places, shown, strict=True):
            axes.text(
                max(value, 0.0) + 0.015 * top, place, f"{value:.3g}", va="center", fontsize=8,
                bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.6},
            )  # fmt: skip
        axes.set_title(f"{title}; basic design {reference:.3g}", fontsize=9.5, loc="left")
        grid(axes, "x")
        label_axes(axes, "max S  [1/s]")
        axes.tick_params(axis="y", length=0)
    left.set_yticks(places, labels, fontsize=8.5)
    left.set_ylim(-0.6, len(chosen) - 0.4)
    _legend(figure, (("symmetric", _SYMMETRIC), ("asymmetric", _ASYMMETRIC)), 0.02)
    return figure


def influence_figure(found: Influence, chosen: Sequence[int], title: str) -> Figure:
    """Delta Re over i = 1…m for some modifications, one panel each, with their effect classes (Fig. 10)."""
    nominal = found.resolved.nominal[0]
    height = 1.15 + 1.85 * len(chosen)
    figure = new_figure(8.0, height)
    panels = figure.subplots(len(chosen), 1, squeeze=False)[:, 0]
    figure.subplots_adjust(left=0.095, right=0.975, top=1.0 - 1.02 / height, bottom=0.66 / height, hspace=0.8)
    _title(figure, title, 0.095)
    for axes, i in zip(panels, chosen, strict=True):
        eigenvalue_bars(axes, found.changes[i])
        eigenvalue_ticks(axes, nominal)
        axes.yaxis.set_major_locator(MaxNLocator(4))
        axes.set_title(found.variations[i].title, fontsize=9, loc="left", pad=19.0)
        axes.annotate(
            _effect_text(found.effects[i]), (0.0, 1.0), xycoords="axes fraction", xytext=(0, 5),
            textcoords="offset points", fontsize=8.5,
        )  # fmt: skip
        label_axes(axes, y="ΔRe λ  [1/s]", y_gap_pt=38.0)
    label_axes(panels[-1], "eigenvalue i; below: frequency [kHz]", x_gap_pt=30.0)
    _legend(figure, (("less stable", RISES), ("more stable", FALLS)), 0.095)
    return figure


def ranking_figure(
    title: str, labels: Sequence[str], panels: Sequence[tuple[Array, str]], colours: Sequence[str],
    legend: Sequence[tuple[str, str]],
) -> Figure:  # fmt: skip
    """Horizontal bars, best or strongest first, one panel for each measure (values, axis label)."""
    longest = max(map(len, labels), default=1)
    side = 0.25 + _LETTER * longest
    width = max(3.2 * len(panels) + side, 0.088 * len(title) + 0.3, 6.0)
    height = 1.3 + 0.27 * len(labels)
    figure = new_figure(width, height)
    axes_row = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    figure.subplots_adjust(
        left=side / width, right=0.975, top=1.0 - 0.65 / height, bottom=0.55 / height, wspace=0.1
    )
    _title(figure, title, 0.02)
    places = np.arange(len(labels))[::-1]
    for axes, (values, label) in zip(axes_row, panels, strict=True):
        axes.barh(places, np.nan_to_num(values), height=0.68, color=list(colours))
        axes.axvline(0.0, color=INK, lw=0.8)
        grid(axes, "x")
        label_axes(axes, label)
        axes.tick_params(axis="y", length=0)
    axes_row[0].set_yticks(places, list(labels), fontsize=8.5)
    axes_row[0].set_ylim(-0.6, len(labels) - 0.4)
    _legend(figure, legend, 0.02)
    return figure


def _effect_text(effect: Effect) -> str:
    words = ", ".join(effect.classes)
    if effect.classes == ("negligible",):
        return words
    return f"{words}; sum {effect.total:+.3g} 1/s" if abs(effect.total) > 1e-6 else f"{words}; sum 0"


def _legend(figure: Figure, entries: Sequence[tuple[str, str]], left: float) -> None:
    """Key of colours in a row under the title, from its left edge."""
    handles = [Patch(color=colour, label=name) for name, colour in entries]
    figure.legend(
        handles=handles, loc="upper left", bbox_to_anchor=(left, 1.0 - 0.3 / figure.get_figheight()),
        ncols=len(handles), frameon=False, handlelength=1.1, columnspacing=1.2, borderaxespad=0.0,
        borderpad=0.2,
    )  # fmt: skip


def _title(figure: Figure, text: str, left: float) -> None:
    figure.suptitle(text, x=left, y=1.0 - 0.1 / figure.get_figheight(), **TITLE)

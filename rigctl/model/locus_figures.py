"""Drawings of a root locus: complex plane (the paper's Figs 7 and 13), frequency and real part over the
parameter.

NOT its job: tracking, what is critical (`rigctl.model.locus`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle

from rigctl.analysis.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PALE,
    PURPLE,
    SKY,
    TITLE,
    VERMILION,
    axes_title,
    grid,
    label_axes,
    new_figure,
)
from sim_hardware.brake_model.eigen.tracking import Crossing, Locus

UNSTABLE = "#FBE3D6"
_OTHERS = (BLUE, GREEN, PURPLE, ORANGE, SKY)
_MARKERS = ("o", "s", "^", "D", "v", "P")
_LABELS = {"mu": "coefficient of friction μ", "pressure": "brake pressure p", "slope": "falling slope k"}
_SYMBOLS = {"mu": "μ", "pressure": "p", "slope": "k"}


@dataclass(frozen=True, slots=True)
class Section:
    """What a drawing shows of a locus.

    Attributes
    ----------
    critical : number of the mode nearest to instability, or unstable
    shown : modes drawn in colour, the critical one first
    frequency_hz, real_1_s : (from, to) of the section
    """

    critical: int
    shown: tuple[int, ...]
    frequency_hz: tuple[float, float]
    real_1_s: tuple[float, float]


def parameter_label(locus: Locus) -> str:
    """Axis label of the parameter."""
    path = locus.path
    label = _LABELS.get(path.name, path.title)
    return label if path.unit in ("", "1") else f"{label} [{path.unit}]"


def value_text(locus: Locus, value: float, digits: int = 3) -> str:
    """A value of the parameter for a label: "μ = 0.64", "p = 15 bar"."""
    path = locus.path
    name = _SYMBOLS.get(path.name, path.name if path.absolute else "factor")
    unit = "" if path.unit in ("", "1") else f" {path.unit}"
    return f"{name} = {value:.{digits}g}{unit}"


def colours(section: Section) -> dict[int, tuple[str, str]]:
    """Colour and marker of the modes drawn in colour."""
    looks = {section.critical: (VERMILION, _MARKERS[0])}
    rest = [mode for mode in section.shown if mode != section.critical]
    for number, mode in enumerate(rest):
        looks[mode] = (_OTHERS[number % len(_OTHERS)], _MARKERS[1 + number % (len(_MARKERS) - 1)])
    return looks


def plane_figure(locus: Locus, section: Section, title: str) -> Figure:
    """Root locus: the section that matters with a marker for each step, and where it lies among all modes."""
    figure = new_figure(10.0, 5.4)
    wide, near = figure.subplots(1, 2, width_ratios=(1.0, 1.9))
    figure.subplots_adjust(left=0.068, right=0.985, top=0.83, bottom=0.115, wspace=0.19)
    figure.suptitle(title, x=0.068, y=0.972, **TITLE)
    _all_modes(wide, locus, section)
    _near(near, locus, section)
    return figure


def _all_modes(axes: Axes, locus: Locus, section: Section) -> None:
    looks = colours(section)
    z = locus.eigenvalues
    for mode in range(1, locus.n_modes + 1):
        colour, _ = looks.get(mode, (GREY, ""))
        x, y = z[:, mode - 1].real, z[:, mode - 1].imag / (2e3 * np.pi)
        axes.plot(x, y, color=colour, lw=1.4 if mode in looks else 1.0, zorder=3)
        axes.plot(x[-1:], y[-1:], ".", ms=4.5, color=colour, zorder=3)
    low, high = _padded(float(np.nanmin(z.real)), max(float(np.nanmax(z.real)), 0.0), 0.06)
    axes.set_xlim(low, max(high, 0.04 * (high - low)))
    axes.set_ylim(0.0, 1.06 * float(np.nanmax(z.imag)) / (2e3 * np.pi) or 1.0)
    _half_plane(axes)
    (x0, x1), (y0, y1) = section.real_1_s, section.frequency_hz
    box = Rectangle(
        (x0, y0 / 1e3), x1 - x0, (y1 - y0) / 1e3, fill=False, ec=INK, lw=0.9, ls=(0, (3, 2)), zorder=4
    )
    axes.add_patch(box)
    axes_title(axes, "All modes; dots: end")
    label_axes(axes, "real part [1/s]", "frequency [kHz]")
    grid(axes)


def _near(axes: Axes, locus: Locus, section: Section) -> None:
    looks = colours(section)
    axes.set_xlim(*section.real_1_s)
    axes.set_ylim(*section.frequency_hz)
    _half_plane(axes)
    handles: list[Line2D | Patch] = []
    taken: list[np.ndarray] = []
    for mode in range(1, locus.n_modes + 1):
        z = locus.eigenvalues[:, mode - 1]
        x, y = z.real, z.imag / (2.0 * np.pi)
        if mode not in looks:
            axes.plot(x, y, ".-", ms=4, lw=0.8, color=GREY, zorder=2)
            taken.append(_on_axes(axes, x, y))
            continue
        colour, marker = looks[mode]
        fine = locus.fine_eigenvalues[:, mode - 1]
        axes.plot(fine.real, fine.imag / (2.0 * np.pi), "-", lw=1.0, color=colour, zorder=3)
        unstable = x > 0
        axes.plot(x[~unstable], y[~unstable], marker, ms=5, color=colour, mec="white", mew=0.6, zorder=4)
        axes.plot(x[unstable], y[unstable], marker, ms=5, color="white", mec=colour, mew=1.3, zorder=4)
        taken += [_on_axes(axes, x, y), *_arrow(axes, x, y, colour)]
        handles.append(
            Line2D([], [], color=colour, marker=marker, ms=5, mec="white", mew=0.6, lw=1.0,
                   label=f"mode {mode}: {y[0]:.0f} Hz → {y[-1]:.0f} Hz")
        )  # fmt: skip
    steps = len(locus.grid) - 1
    handles.append(
        Line2D([], [], color="none", marker="$→$", ms=9, mfc=INK, mec=INK,
               label=f"{value_text(locus, locus.grid[0])} … {_short(locus, locus.grid[-1])}, {steps} steps")
    )  # fmt: skip
    handles.append(Patch(fc=UNSTABLE, ec="none", label="unstable"))
    for crossing in locus.crossings:
        if crossing.mode in looks:
            _mark(axes, locus, crossing, np.concatenate(taken))
    axes.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 1.01), ncols=2, borderaxespad=0.0)
    label_axes(axes, "real part [1/s]", "frequency [Hz]", y_gap_pt=34.0)
    grid(axes)


def _short(locus: Locus, value: float) -> str:
    return value_text(locus, value).split(" = ", maxsplit=1)[1]


def _half_plane(axes: Axes) -> None:
    low, high = axes.get_xlim()
    if high > 0:
        axes.axvspan(max(0.0, low), high, color=UNSTABLE, zorder=0, lw=0)
    if low <= 0 <= high:
        axes.axvline(0.0, color=INK, lw=0.9, zorder=1)


def _on_axes(axes: Axes, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Points as fractions of the axes, (n, 2)."""
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    return np.column_stack([(x - x0) / (x1 - x0), (y - y0) / (y1 - y0)])


def _arrow(axes: Axes, x: np.ndarray, y: np.ndarray, colour: str) -> list[np.ndarray]:
    """Arrow along the curve at a third of its length on the drawing, in the sense of the grid; what it
    covers.
    """
    u, v = _on_axes(axes, x, y).T
    inside = (u > 0) & (u < 1) & (v > 0) & (v < 1)
    lengths = np.hypot(np.diff(u), np.diff(v)) * (inside[:-1] & inside[1:])
    if lengths.sum() < 0.05:
        return []
    k = int(np.searchsorted(np.cumsum(lengths), 0.33 * lengths.sum()))
    k = min(k, len(lengths) - 1)
    size = lengths[k] or 1.0
    direction = np.array([u[k + 1] - u[k], v[k + 1] - v[k]]) / size
    if not inside[k] or size == 1.0:
        return []
    normal = np.array([-direction[1], direction[0]])
    start = np.array([u[k], v[k]]) + 0.035 * normal - 0.04 * direction
    end = start + 0.1 * direction
    axes.annotate(
        "", xy=tuple(end), xytext=tuple(start), xycoords="axes fraction", textcoords="axes fraction",
        arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.6, "mutation_scale": 13}, zorder=5,
    )  # fmt: skip
    return [start + share * (end - start) for share in np.linspace(0.0, 1.0, 5)[:, None, None]]


def _mark(axes: Axes, locus: Locus, crossing: Crossing, taken: np.ndarray) -> None:
    """Ring and label where a mode crosses the axis; the label where it hides least of `taken` (n, 2)."""
    axes.plot(0.0, crossing.frequency_hz, "o", ms=11, mfc="none", mec=INK, mew=1.4, zorder=6)
    text = f"{value_text(locus, crossing.value)}\n{crossing.frequency_hz:.0f} Hz"
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    place = np.array([-x0 / (x1 - x0), (crossing.frequency_hz - y0) / (y1 - y0)])
    figure, box = axes.get_figure(root=True), axes.get_position()
    width, height = figure.get_size_inches() * 72.0 * (box.width, box.height)  # type: ignore[union-attr]
    size = np.array([7.5 * len(text.split("\n", maxsplit=1)[0]) / width, 42.0 / height])

    def hidden(offset: tuple[float, float]) -> float:
        centre = place + np.array(
            [offset[0] / width + np.sign(offset[0]) * 0.5 * size[0], offset[1] / height]
        )
        outside = (np.abs(centre - 0.5) + 0.5 * size > 0.99).any()
        return 100.0 * outside + (np.abs(taken - centre) < 0.5 * size + 0.01).all(axis=1).sum()

    offset = min(((x, y) for x in (-16, 16, -40, 40) for y in (28, -28, 60, -60)), key=hidden)
    axes.annotate(
        text, xy=(0.0, crossing.frequency_hz), xytext=offset,
        textcoords="offset points", ha="left" if offset[0] > 0 else "right", va="center", fontsize=9.5,
        fontweight="bold", zorder=7,
        arrowprops={"arrowstyle": "-", "color": INK, "lw": 0.8, "shrinkB": 6},
        bbox={"boxstyle": "round,pad=0.25", "fc": "white", "ec": PALE, "alpha": 0.9},
    )  # fmt: skip


def course_figure(locus: Locus, section: Section, title: str) -> Figure:
    """Frequency and real part of the modes of the section over the parameter."""
    figure = new_figure(8.0, 6.0)
    top, bottom = figure.subplots(2, 1, sharex=True)
    figure.subplots_adjust(left=0.1, right=0.975, top=0.845, bottom=0.09, hspace=0.1)
    figure.suptitle(title, x=0.1, y=0.975, **TITLE)
    looks = colours(section)
    handles = []
    for mode in range(1, locus.n_modes + 1):
        colour, marker = looks.get(mode, (GREY, ""))
        f, r = locus.frequencies_hz[:, mode - 1], locus.real_parts[:, mode - 1]
        strong = mode in looks
        look: Any = {
            "color": colour, "lw": 1.7 if strong else 0.8, "zorder": 3 if strong else 2,
            "marker": marker or None, "ms": 4.5, "mec": "white", "mew": 0.5,
            "markevery": max(1, len(f) // 24),
        }  # fmt: skip
        (line,) = top.plot(locus.grid, f, **look)
        bottom.plot(locus.grid, r, **look)
        if strong:
            line.set_label(f"mode {mode}")
            handles.append(line)
    if len(looks) < locus.n_modes:
        handles.append(Line2D([], [], color=GREY, lw=0.8, label="other modes"))
    top.set_ylim(*section.frequency_hz)
    bottom.set_ylim(*section.real_1_s)
    bottom.axhspan(0.0, max(section.real_1_s[1], 0.0), color=UNSTABLE, zorder=0, lw=0)
    bottom.axhline(0.0, color=INK, lw=0.9, zorder=1)
    bottom.margins(x=0.0)
    handles.append(Patch(fc=UNSTABLE, ec="none", label="unstable"))
    for crossing in locus.crossings:
        if crossing.mode in looks:
            for axes in (top, bottom):
                axes.axvline(crossing.value, color=INK, lw=1.0, ls=(0, (4, 3)), zorder=2)
            left = crossing.value > 0.5 * (locus.grid[0] + locus.grid[-1])
            top.annotate(
                f"{value_text(locus, crossing.value)}, {crossing.frequency_hz:.0f} Hz",
                xy=(crossing.value, 0.03), xycoords=("data", "axes fraction"), xytext=(-5 if left else 5, 0),
                textcoords="offset points", ha="right" if left else "left", fontsize=9, fontweight="bold",
                bbox={"boxstyle": "round,pad=0.2", "fc": "white", "ec": "none", "alpha": 0.85},
            )  # fmt: skip
    place = (0.1, 0.92)
    figure.legend(
        handles=handles, loc="upper left", ncols=len(handles), bbox_to_anchor=place, borderaxespad=0
    )
    for axes, label in ((top, "frequency [Hz]"), (bottom, "real part [1/s]")):
        label_axes(axes, y=label, y_gap_pt=38.0)
        grid(axes)
    label_axes(bottom, parameter_label(locus))
    return figure


def _padded(low: float, high: float, share: float) -> tuple[float, float]:
    width = (high - low) or max(abs(high), 1.0)
    return low - share * width, high + share * width

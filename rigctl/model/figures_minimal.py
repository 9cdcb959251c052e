"""Figures of the minimal models: phase plane, frequency over belt speed, sprag criterion, root locus.

Job: drawing what `minimal` computed. NOT its job: computing, files.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from numpy.typing import NDArray

from rigctl.analysis.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    SKY,
    TITLE,
    VERMILION,
    axes_title,
    colour_bar,
    grid,
    label_axes,
    new_figure,
)
from sim_hardware.brake_model.minimal.belt import BeltOscillator
from sim_hardware.brake_model.minimal.cycles import PhasePlane, SpeedCurve, orbit
from sim_hardware.brake_model.minimal.hurwitz import Crossing
from sim_hardware.brake_model.minimal.motion import Trajectory
from sim_hardware.brake_model.minimal.sprag import SpragModel, critical_mu, smallest_critical_mu

Array = NDArray[np.float64]
UM = 1e6

_SHADE = {"diverging": "#FBE3D6", "contracting": "#DDEBF5", "neutral": "#ECECEC"}
_WORDS = {
    "diverging": "trajectories diverge",
    "contracting": "trajectories contract",
    "neutral": "closed orbits (neither)",
}
_LAW_LOOK = {
    "coulomb": (BLUE, "o", "Coulomb"),
    "linear": (VERMILION, "s", "linear falling (eq 28)"),
    "exponential": (GREEN, "D", "exponential"),
    "hyperbolic": (PURPLE, "^", "hyperbolic"),
    "cubic": (ORANGE, "v", "cubic"),
}


# ---------------------------------------------------------------------------------------------- belt


def belt_phase_plane(
    belt: BeltOscillator, plane: PhasePlane, paths: dict[str, Trajectory], amplitudes: Array, turns: Array
) -> Figure:
    """Phase plane with limit cycle, trajectories and regions; friction law; growth per turn."""
    figure = new_figure(9.6, 5.2)
    cells = figure.add_gridspec(
        2, 2, width_ratios=(1.75, 1.0), left=0.085, right=0.98, top=0.8, bottom=0.1, wspace=0.29, hspace=0.55
    )
    main, law, growth = (
        figure.add_subplot(cells[:, 0]),
        figure.add_subplot(cells[0, 1]),
        figure.add_subplot(cells[1, 1]),
    )
    _, _, law_words = _LAW_LOOK[belt.law.law]
    damping = f"D = {belt.damping_ratio:.3g}".replace("-", "−")
    title = f"Mass on a moving belt, {law_words} friction: {damping}, v_belt = {belt.belt_speed_m_s:g} m/s"
    figure.suptitle(title, x=0.085, y=0.975, **TITLE)
    handles = _draw_plane(main, belt, plane, paths)
    figure.legend(
        handles=handles,
        loc="upper left",
        ncols=4 if len(handles) <= 8 else 5,
        bbox_to_anchor=(0.085, 0.925),
        borderaxespad=0,
        fontsize=8,
    )
    _draw_law(law, belt, plane)
    _draw_growth(growth, plane, amplitudes, turns)
    return figure


def _draw_plane(
    axes: Axes, belt: BeltOscillator, plane: PhasePlane, paths: dict[str, Trajectory]
) -> list[Any]:
    rest, speed = belt.equilibrium_m * UM, belt.belt_speed_m_s
    stable = [c for c in plane.cycles if c.stable]
    shown = [paths[name].sampled(600) for name in ("from inside", "from outside") if name in paths]
    shown += [stable[0].trajectory.sampled(600)] if stable else []
    x_reach = 1.12 * max(np.abs(x * UM - rest).max() for _, x, _ in shown)
    v_reach = 1.12 * max(np.abs(v).max() for *_, v in shown)
    axes.set_xlim(rest - x_reach, rest + x_reach)
    axes.set_ylim(-v_reach, v_reach)
    axes.set_facecolor(_SHADE[plane.regions[-1].behaviour])
    for region in reversed(plane.regions[:-1]):  # from the outermost: inner ones are painted over it
        cycle = next((c for c in plane.cycles if math.isclose(c.turn_m, region.to_m, rel_tol=1e-6)), None)
        path = cycle.trajectory if cycle is not None else orbit(belt, region.to_m)
        if path is not None:
            _, x, v = path.sampled(900)
            axes.fill(x * UM, v, color=_SHADE[region.behaviour], lw=0, zorder=1)
    axes.axhline(speed, color=GREY, lw=1.0, ls=(0, (4, 2)), zorder=2)
    holding = belt.holding_force_n / belt.stiffness_n_m
    low = (-belt.holding_force_n - belt.damping_ns_m * speed) / belt.stiffness_n_m
    axes.plot(
        [low * UM, (low + 2.0 * holding) * UM], [speed, speed], color=GREY, lw=4.5, alpha=0.55, zorder=2
    )
    for name, colour in (("from inside", VERMILION), ("from outside", BLUE)):
        if name in paths:
            _, x, v = paths[name].sampled(1500)
            axes.plot(x * UM, v, color=colour, lw=1.1, zorder=3)
            _arrows(axes, x * UM, v, colour)
            axes.plot(x[0] * UM, v[0], marker="o", ms=4, color=colour, zorder=4)
    for cycle in plane.cycles:
        _, x, v = cycle.trajectory.sampled(900)
        axes.plot(
            x * UM, v, color=INK, lw=2.2 if cycle.stable else 1.4, ls="-" if cycle.stable else "--", zorder=5
        )
    axes.plot(rest, 0.0, marker="o", ms=6, mfc="white" if belt.falls_too_steeply else INK, mec=INK, zorder=6)
    label_axes(axes, "displacement x [µm]", "velocity of the mass [m/s]", y_gap_pt=40.0)
    handles: list[Any] = []
    if stable:
        words = f"{stable[0].kind} limit cycle, {stable[0].frequency_hz:.0f} Hz"
        handles.append(Line2D([], [], color=INK, lw=2.2, label=words))
    handles += [Line2D([], [], color=VERMILION, lw=1.3, label="starts inside")]
    if "from outside" in paths:
        handles.append(Line2D([], [], color=BLUE, lw=1.3, label="starts outside"))
    handles += [
        Line2D(
            [], [], marker="o", ls="", ms=6, mec=INK, mfc="white" if belt.falls_too_steeply else INK,
            label=f"equilibrium, {'unstable' if belt.falls_too_steeply else 'stable'}",
        ),
        Line2D([], [], color=GREY, lw=1.0, ls=(0, (4, 2)), label="belt velocity"),
        Line2D([], [], color=GREY, lw=4.5, alpha=0.55, label="can stick here"),
    ]  # fmt: skip
    seen = dict.fromkeys(r.behaviour for r in plane.regions)
    handles += [Patch(facecolor=_SHADE[b], edgecolor=GREY, lw=0.5, label=_WORDS[b]) for b in seen]
    return handles


def _arrows(axes: Axes, x: Array, v: Array, colour: str) -> None:
    """Arrow heads along a path, at equal lengths as drawn."""
    (x0, x1), (v0, v1) = axes.get_xlim(), axes.get_ylim()
    length = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(x) / (x1 - x0), np.diff(v) / (v1 - v0)))))
    for place in np.arange(0.25, length[-1], 0.85):
        i = int(np.searchsorted(length, place))
        if 0 < i < x.size:
            axes.annotate(
                "", (x[i], v[i]), (x[i - 1], v[i - 1]),
                arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 0, "mutation_scale": 11}, zorder=4,
            )  # fmt: skip


def _draw_law(axes: Axes, belt: BeltOscillator, plane: PhasePlane) -> None:
    stable = [c for c in plane.cycles if c.stable]
    reach = stable[0].slip_speed_max_m_s if stable else 2.0 * belt.belt_speed_m_s
    speeds = np.linspace(0.0, 1.5 * reach, 300)
    mu = belt.law.curve(speeds)
    axes.axvspan(0.0, reach, color=_SHADE["neutral"], lw=0, zorder=0)
    axes.plot(speeds, mu, color=INK, lw=1.8)
    axes.plot(0.0, belt.law.mu_static, marker="o", ms=5, color=INK, clip_on=False)
    axes.plot(
        belt.belt_speed_m_s,
        belt.law.sliding(belt.belt_speed_m_s),
        marker="o",
        ms=6,
        mfc="white" if belt.falls_too_steeply else INK,
        mec=INK,
    )
    axes.set_xlim(0.0, speeds[-1])
    axes.set_ylim(min(0.0, float(mu.min())), 1.25 * belt.law.mu_static)
    axes.text(
        0.03,
        0.06,
        "grey: slip in the cycle" if stable else "",
        transform=axes.transAxes,
        fontsize=8,
        color=INK,
    )
    axes_title(axes, "Friction law and equilibrium")
    label_axes(axes, "sliding speed |v| [m/s]", "µ [–]", y_gap_pt=33.0)


def _draw_growth(axes: Axes, plane: PhasePlane, amplitudes: Array, turns: Array) -> None:
    growth = 100.0 * (np.where(np.isfinite(turns), turns, np.nan) / amplitudes - 1.0)
    finite = np.abs(growth[np.isfinite(growth)])
    top = 1.25 * float(np.percentile(finite, 88)) if finite.size else 1.0
    axes.set_ylim(-max(top, 1.0), max(top, 1.0))
    if not finite.size:
        axes.text(0.5, 0.7, "runs away without turning", transform=axes.transAxes, ha="center", fontsize=8.5)
    axes.set_xscale("log")
    axes.set_xlim(amplitudes[0] * UM, amplitudes[-1] * UM)
    for region in plane.regions:
        left, right = max(region.from_m, amplitudes[0]), min(region.to_m, amplitudes[-1])
        if right > left:
            axes.axvspan(left * UM, right * UM, color=_SHADE[region.behaviour], lw=0, zorder=0)
    axes.axhline(0.0, color=GREY, lw=0.9)
    axes.plot(amplitudes * UM, growth, color=INK, lw=1.6)
    for cycle in plane.cycles:
        axes.plot(
            cycle.turn_m * UM, 0.0, marker="o", ms=6, mec=INK, mfc=INK if cycle.stable else "white", zorder=4
        )
    _plain_log(axes)
    axes_title(axes, "Change of amplitude in one turn")
    label_axes(axes, "amplitude [µm]  (full dot: stable cycle)", "change [%]", y_gap_pt=33.0)


def _plain_log(axes: Axes) -> None:
    low, high = axes.get_xlim()
    steps = (1.0, 2.0, 5.0) if high < 500.0 * low else (1.0,)
    axes.xaxis.set_major_locator(LogLocator(subs=steps))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.xaxis.set_minor_locator(LogLocator(subs=()))


def belt_frequency(
    belt: BeltOscillator, curves: dict[str, SpeedCurve], limit_m_s: float, *, constant: bool
) -> Figure:
    """Frequency and amplitude of the limit cycle over the belt speed, a line per law.

    `limit_m_s`: speed up to which the linear law's cycle slides one way (nan without that law); `constant`:
    whether its frequency was found free of the speed up to there.
    """
    figure = new_figure(9.6, 4.3)
    left, right = figure.subplots(1, 2)
    figure.subplots_adjust(left=0.075, right=0.98, top=0.78, bottom=0.12, wspace=0.24)
    verdict = ": only the linear falling law keeps the frequency" if constant and len(curves) > 1 else ""
    figure.suptitle(f"Limit cycle over belt speed{verdict}", x=0.075, y=0.97, **TITLE)
    left.axhline(belt.frequency_hz, color=GREY, lw=1.0, ls=(0, (4, 2)))
    handles: list[Any] = []
    for law, curve in curves.items():
        colour, marker, words = _LAW_LOOK[law]
        sticks = np.array([kind == "stick-slip" for kind in curve.kinds], dtype=bool)
        for axes, values in ((left, curve.frequency_hz), (right, curve.amplitude_m * UM)):
            axes.plot(curve.speeds_m_s, values, color=colour, lw=1.5)
            axes.plot(curve.speeds_m_s[sticks], values[sticks], marker=marker, ms=3.6, ls="", color=colour)
            axes.plot(
                curve.speeds_m_s[~sticks],
                values[~sticks],
                marker=marker,
                ms=4,
                ls="",
                mfc="white",
                mec=colour,
            )
        f = curve.frequency_hz[curve.exists]
        span = f", {f.min():.0f} … {f.max():.0f} Hz" if f.size else ": no limit cycle"
        handles.append(Line2D([], [], color=colour, marker=marker, ms=4, lw=1.5, label=words + span))
    handles.append(
        Line2D(
            [], [], color=GREY, lw=1.0, ls=(0, (4, 2)), label=f"natural frequency {belt.frequency_hz:.0f} Hz"
        )
    )
    if "linear" in curves and 0.0 < limit_m_s < curves["linear"].speeds_m_s[-1]:
        for axes in (left, right):
            axes.axvline(limit_m_s, color=VERMILION, lw=1.0, ls=":")
        words = f"linear: overtakes the belt from {limit_m_s:.2g} m/s"
        handles.append(Line2D([], [], color=VERMILION, lw=1.0, ls=":", label=words))
    if any(kind not in ("", "stick-slip") for curve in curves.values() for kind in curve.kinds):
        handles.append(
            Line2D([], [], color=INK, marker="o", mfc="white", ls="", label="cycle without sticking")
        )
    figure.legend(
        handles=handles, loc="upper left", ncols=3, bbox_to_anchor=(0.075, 0.915), borderaxespad=0, fontsize=8
    )
    for axes in (left, right):
        axes.set_xscale("log")
        _plain_log(axes)
        grid(axes)
    if any(curve.exists.any() for curve in curves.values()):
        right.set_yscale("log")
    else:
        for axes in (left, right):
            axes.set_xlim(next(iter(curves.values())).speeds_m_s[[0, -1]])
            axes.text(
                0.5, 0.6, "no limit cycle", transform=axes.transAxes, ha="center", color=GREY, fontsize=13
            )
    right.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    label_axes(left, "belt speed [m/s]", "frequency of the limit cycle [Hz]", y_gap_pt=36.0)
    label_axes(right, "belt speed [m/s]", "amplitude [µm]")
    return figure


# --------------------------------------------------------------------------------------------- sprag


def sprag_criterion(model: SpragModel, ratios: Sequence[float], mu_max: float) -> Figure:
    """The criterion over the angle for several d2 / d1, both directions of rotation."""
    figure = new_figure(9.6, 4.6)
    left, right = figure.subplots(1, 2, width_ratios=(1.6, 1.0))
    figure.subplots_adjust(left=0.07, right=0.98, top=0.79, bottom=0.11, wspace=0.2)
    figure.suptitle(
        "Geometric instability: realistic friction needs a disc damped far more than the pad",
        x=0.07, y=0.97, **TITLE,
    )  # fmt: skip
    own = model.pad_damping_ns_m / model.disc_damping_ns_m
    colours = (SKY, BLUE, GREEN, ORANGE, VERMILION, PURPLE)
    angles = np.linspace(0.02, 85.0, 1200)
    handles: list[Any] = []
    for i, ratio in enumerate(ratios):
        mine = math.isclose(ratio, own, rel_tol=1e-9, abs_tol=1e-15)
        colour = INK if mine else colours[i % len(colours)]
        mu = critical_mu(np.radians(angles), 1.0, ratio)
        for sign in (1.0, -1.0):
            left.plot(sign * angles, sign * mu, color=colour, lw=2.2 if mine else 1.3, zorder=3)
            if mine:
                far = np.full_like(mu, sign * 2.0 * mu_max)
                left.fill_between(sign * angles, sign * mu, far, color=_SHADE["diverging"], lw=0, zorder=1)
        words = f"d2/d1 = {ratio:.3g}" + (" (this model)" if mine else "")
        handles.append(Line2D([], [], color=colour, lw=2.2 if mine else 1.3, label=words))
    handles.append(Patch(facecolor=_SHADE["diverging"], edgecolor=GREY, lw=0.5, label="this model unstable"))
    left.axhspan(0.3, 0.6, color=_SHADE["neutral"], lw=0, zorder=0)
    handles.append(Patch(facecolor=_SHADE["neutral"], edgecolor=GREY, lw=0.5, label="usual µ, 0.3 … 0.6"))
    left.axhline(0.0, color=GREY, lw=0.8)
    left.axvline(0.0, color=GREY, lw=0.8)
    degrees = math.degrees(model.angle_rad)
    if abs(model.critical_mu) <= mu_max:
        left.plot(degrees, model.critical_mu, marker="o", ms=7, color=INK, mec="white", zorder=5)
        left.annotate(
            f"γ = {degrees:.3g}°: µ = {model.critical_mu:.3f}", (degrees, model.critical_mu),
            xytext=(10, -12), textcoords="offset points", fontsize=8.5, zorder=5,
        )  # fmt: skip
    left.set_xlim(-85, 85)
    left.set_ylim(-mu_max, mu_max)
    left.text(
        -82, 0.93 * mu_max, "γ < 0: never unstable\nwhile the disc turns forward", fontsize=8.5, va="top"
    )
    left.text(82, -0.93 * mu_max, "µ < 0: disc turns back", fontsize=8.5, ha="right")
    label_axes(left, "angle γ [°]", "coefficient of friction µ [–]", y_gap_pt=31.0)
    figure.legend(
        handles=handles, loc="upper left", ncols=4, bbox_to_anchor=(0.07, 0.915), borderaxespad=0, fontsize=8
    )
    _draw_needed(right, own)
    return figure


def _draw_needed(axes: Axes, own: float) -> None:
    ratios = np.geomspace(1.0, 1000.0, 300)
    least = np.array([smallest_critical_mu(1.0 / r)[0] for r in ratios])
    axes.axhspan(0.3, 0.6, color=_SHADE["neutral"], lw=0, zorder=0)
    axes.plot(ratios, least, color=INK, lw=1.8)
    if 1e-3 <= own <= 1.0:
        axes.plot(1.0 / own, smallest_critical_mu(own)[0], marker="o", ms=7, color=INK, mec="white")
    axes.set_xscale("log")
    axes.set_xlim(1.0, 1000.0)
    axes.set_ylim(0.0, 3.0)
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    grid(axes)
    axes_title(axes, "Smallest critical µ of any angle")
    label_axes(axes, "d1 / d2, disc damper to pad damper", "µ [–]", y_gap_pt=25.0)


# ------------------------------------------------------------------------------------------- two-dof


def two_dof_locus(
    mus: Array, eigenvalues: NDArray[np.complex128], first: tuple[str, Crossing] | None
) -> Figure:
    """Root locus over mu in the complex plane (Fig. 1b), frequencies and real parts over mu."""
    figure = new_figure(9.6, 4.8)
    cells = figure.add_gridspec(
        2,
        2,
        width_ratios=(1.25, 1.0),
        left=0.08,
        right=0.98,
        top=0.83,
        bottom=0.105,
        wspace=0.62,
        hspace=0.16,
    )
    locus, frequency, growth = (
        figure.add_subplot(cells[:, 0]), figure.add_subplot(cells[0, 1]), figure.add_subplot(cells[1, 1]),
    )  # fmt: skip
    if first is None:
        words = "no instability at any µ > 0"
    else:
        at = f", {first[1].frequency_hz:.0f} Hz" if first[1].frequency_hz else ""
        words = f"{first[0]} from µ = {first[1].mu:.3g}{at}"
    figure.suptitle(f"Two degrees of freedom coupled by friction: {words}", x=0.08, y=0.97, **TITLE)
    hertz = np.abs(eigenvalues.imag) / (2.0 * math.pi)
    real = eigenvalues.real
    lines: Any = None
    for i in range(eigenvalues.shape[1]):
        points = np.column_stack((real[:, i], hertz[:, i]))
        segments = np.stack((points[:-1], points[1:]), axis=1)
        lines = LineCollection(
            list(segments), cmap="viridis", array=mus[:-1], linewidths=3.0, capstyle="round", zorder=3
        )
        locus.add_collection(lines)
        locus.plot(real[0, i], hertz[0, i], marker="o", ms=6, color=INK, zorder=4)
        middle = points.shape[0] // 3
        for k in (middle, 2 * middle, points.shape[0] - 2):
            locus.annotate(
                "", tuple(points[k + 1]), tuple(points[k - 3]),
                arrowprops={"arrowstyle": "-|>", "color": INK, "lw": 0, "mutation_scale": 12}, zorder=5,
            )  # fmt: skip
    locus.axvspan(0.0, 1e9, color=_SHADE["diverging"], lw=0, zorder=0)
    locus.axvline(0.0, color=GREY, lw=1.0)
    _limits(locus, real, hertz)
    if first is not None and first[1].mu <= mus[-1]:
        locus.plot(0.0, first[1].frequency_hz, marker="D", ms=8, color=VERMILION, mec="white", zorder=6)
        locus.annotate(
            f"µ = {first[1].mu:.3g}", (0.0, first[1].frequency_hz), xytext=(7, 7), textcoords="offset points",
            fontsize=9, color=VERMILION, zorder=6,
        )  # fmt: skip
    axes_title(locus, "Root locus (dots: µ = 0; shaded: unstable)")
    label_axes(locus, "real part of the eigenvalue [1/s]", "frequency [Hz]", y_gap_pt=37.0)
    colour_bar(locus, lines, "µ [–]", left=locus.get_position().x1 + 0.012, gap_pt=28.0)
    for axes, values, unit in ((frequency, hertz, "frequency [Hz]"), (growth, real, "real part [1/s]")):
        for i in range(values.shape[1]):
            axes.plot(mus, values[:, i], lw=max(1.6, 3.4 - 1.8 * i), color=(BLUE, ORANGE, GREEN, PURPLE)[i])
        axes.set_xlim(mus[0], mus[-1])
        grid(axes)
        if first is not None and first[1].mu <= mus[-1]:
            axes.axvline(first[1].mu, color=INK, lw=1.0, ls=(0, (4, 2)))
        label_axes(axes, y=unit, y_gap_pt=39.0)
    growth.axhline(0.0, color=GREY, lw=1.0)
    frequency.tick_params(labelbottom=False)
    meets = first is not None and first[0] == "flutter" and first[1].mu <= mus[-1]
    axes_title(
        frequency, "Frequencies meet, real parts part" if meets else "Frequencies and real parts over µ"
    )
    label_axes(growth, "coefficient of friction µ [–]")
    return figure


def _limits(axes: Axes, real: Array, hertz: Array) -> None:
    for set_limits, values in ((axes.set_xlim, real), (axes.set_ylim, hertz)):
        low, high = float(values.min()), float(values.max())
        margin = 0.08 * max(high - low, 1e-3 * max(abs(low), abs(high)), 1e-12)
        if values is real:
            low, high = min(low, 0.0), max(high, 0.0)
            margin = max(margin, 0.08 * (high - low))
        set_limits(low - margin, high + margin)

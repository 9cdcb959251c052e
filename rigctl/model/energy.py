"""Nonlinear pad stiffness for people: does cubic hardening change the decay of vibrations (section 4.4, Fig.
11)?

Job: the study of linear against cubic decay from every mode shape, its verdict, table and figure. NOT its
job: integration and energies (`sim_hardware.brake_model.time_domain.energy`).
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

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
    grid,
    label_axes,
    new_figure,
)
from rigctl.model.beside_paper import Comparison, paper_table
from rigctl.model.output import Column, Study, Table
from sim_hardware.brake_model.assembly import Brake
from sim_hardware.brake_model.time_domain.energy import INITIAL_NM, Decay, decays

#: factors on the realistic cubic stiffness
STRENGTHS = (1.0, 10.0, 100.0, 1000.0)
#: compression at which the contact stiffness has doubled for strength 1
DOUBLED_AT_M = 50e-6
#: the pair shown in the paper: eigenvalues i = 5, 6
_SHOWN = 3
#: what the paper says of pairs: stabilised or destabilised by the hardening springs
_PAPER = {1: "destabilises", 2: "destabilises", 3: "stabilises"}
#: relative change of the rate of decay that one can see in a plot of energies
_CLEAR = 0.05
_NOTHING = 1e-6
_COLOURS = (SKY, ORANGE, GREEN, VERMILION, PURPLE, BLUE)
_MARKERS = "osD^vP"


def figure_11_study(brake: Brake) -> Study:
    """Fig. 11 and the claims of section 4.4.2 on a brake: realistic hardening, and up to a thousand times
    it."""
    return decay_study(brake, name="figure_11")


def decay_study(
    brake: Brake,
    strengths: Sequence[float] = STRENGTHS,
    *,
    doubled_at_m: float = DOUBLED_AT_M,
    mu: float | None = None,
    energy_nm: float = INITIAL_NM,
    mode: int = _SHOWN,
    name: str = "decay",
) -> Study:
    """Linear against cubic decay of the energy E^l (eq 26) from every mode shape.

    Parameters
    ----------
    strengths : factors on the cubic stiffness; 1: the contact stiffness has doubled at `doubled_at_m`
    mu : coefficient of friction (constant); the brake file's where None
    energy_nm : E^l at the start
    mode : pair drawn over time, 1 has the lowest frequency; the paper's eigenvalues i = 2 mode - 1, 2 mode
    name : stem of the files

    Returns
    -------
    facts: the verdict in numbers; tables "modes" (rate of decay and its change by mode and strength), "paper"
    (claims of section 4.4.2) and "energies" (E^l over time of the pair drawn); figure "decay"

    Raises
    ------
    ValueError
        no such mode, and as `sim_hardware.brake_model.time_domain.energy.decays`
    """
    chosen = tuple(sorted({float(s) for s in strengths}))
    if not chosen or chosen[0] <= 0.0:
        raise ValueError(f"strengths {tuple(strengths)}: give positive factors, for example 1, 100, 1000")
    found = decays(brake, chosen, mu=mu, doubled_at_m=doubled_at_m, energy_nm=energy_nm)
    shown = next((d for d in found if d.start.index == mode), None)
    if shown is None:
        known = ", ".join(str(d.start.index) for d in found)
        raise ValueError(f"mode {mode} has no decay to show; the brake '{brake.name}' has the modes {known}")
    title = f"{brake.name}: {_headline(found, chosen)}"
    return Study(
        name,
        title,
        _facts(brake, found, chosen, doubled_at_m, energy_nm, brake.mu if mu is None else mu),
        (_claims(found, chosen), _modes(found, chosen), _energies(shown)),
        {"decay": partial(decay_figure, found, shown, title)},
    )


def _headline(found: Sequence[Decay], strengths: tuple[float, ...]) -> str:
    low = _below(found, 0)
    text = f"cubic hardening ×{strengths[0]:g} changes {low} of {len(found)} decays by < 2 %"
    needed = first_clear(found, strengths)
    return text + ("" if needed is None else f"; a third of them by 5 % at ×{needed:g}")


def _below(found: Sequence[Decay], column: int, limit: float = 0.02) -> int:
    return sum(abs(float(d.changes[column])) < limit for d in found)


def first_clear(found: Sequence[Decay], strengths: Sequence[float]) -> float | None:
    """Least strength at which a third of the modes that load the contacts lose energy 5 % faster or
    slower."""
    loaded = [d for d in found if _loads(d)]
    for column, strength in enumerate(strengths):
        clear = sum(abs(float(d.changes[column])) >= _CLEAR for d in loaded)
        if loaded and 3 * clear >= len(loaded):
            return strength
    return None


def _loads(decay: Decay) -> bool:
    """Whether the mode compresses the contacts at all."""
    return float(decay.largest_compression_m.max()) > _NOTHING * float(np.abs(decay.start.state).max())


def _facts(
    brake: Brake,
    found: Sequence[Decay],
    strengths: tuple[float, ...],
    doubled_at_m: float,
    energy_nm: float,
    mu: float,
) -> dict[str, Any]:
    stiffness = max(c.stiffness_n_m[1] for c in brake.contacts)
    return {
        "coefficient_of_friction": mu,
        "initial_energy_nm": energy_nm,
        "stiffness_doubled_at_um": 1e6 * doubled_at_m,
        "cubic_stiffness_n_m3_of_strength_1": stiffness / (3.0 * doubled_at_m**2),
        "modes": len(found),
        "modes_changed_by_less_than_2_percent": {
            f"x{s:g}": _below(found, column) for column, s in enumerate(strengths)
        },
        "modes_stabilised": {f"x{s:g}": _signs(found, i, 1.0) for i, s in enumerate(strengths)},
        "modes_destabilised": {f"x{s:g}": _signs(found, i, -1.0) for i, s in enumerate(strengths)},
        "strength_of_clear_difference": first_clear(found, strengths),
        "largest_contact_compression_um": 1e6 * max(float(d.largest_compression_m.max()) for d in found),
        "largest_contact_force_variation_n": max(float(d.largest_variation_n.max()) for d in found),
        "largest_energy_in_cubic_parts_at_start_nm": {
            f"x{s:g}": max(float(d.hidden_nm[i]) for d in found) for i, s in enumerate(strengths)
        },
        "remark": "at 1 N m real pads would lift off: the contact forces vary by more than the pads are "
        "pressed; as in the paper, the contacts stay closed and slide forwards in this computation",
    }


def _signs(found: Sequence[Decay], column: int, sign: float) -> list[int]:
    return [d.start.index for d in found if sign * float(d.changes[column]) > _NOTHING]


def _claims(found: Sequence[Decay], strengths: tuple[float, ...]) -> Table:
    """The claims of section 4.4.2 beside ours."""
    by_mode = {d.start.index: d for d in found}
    rows: list[Comparison] = []
    for index, says in _PAPER.items():
        if index in by_mode:
            words = [f"×{s:g}: {_effect(float(by_mode[index].changes[i]))}" for i, s in enumerate(strengths)]
            agreeing = [_effect(float(c)).startswith(says) for c in by_mode[index].changes]
            holds = True if all(agreeing) else "in part" if any(agreeing) else False
            what = f"hardening from the mode of i = {2 * index - 1}, {2 * index}"
            rows.append(Comparison(what, says, "; ".join(words), holds=holds))
    rows.append(
        Comparison(
            "realistic hardening is not important for stability",
            "yes",
            f"{_below(found, 0)} of {len(found)} rates change by less than 2 % at ×{strengths[0]:g}",
            holds=2 * _below(found, 0) > len(found),
        )
    )
    needed = first_clear(found, strengths)
    rows.append(
        Comparison(
            "a clear difference needs unrealistically strong hardening",
            "yes",
            "not reached" if needed is None else f"a third of the modes by 5 % at ×{needed:g}",
            holds=needed is None or needed >= 10.0,
        )
    )
    return paper_table("Claims of section 4.4.2 and what this brake does", rows)


def _effect(change: float) -> str:
    if abs(change) < _NOTHING:
        return "no effect"
    return f"{'stabilises' if change > 0.0 else 'destabilises'} {100.0 * abs(change):.2g} %"


def _modes(found: Sequence[Decay], strengths: tuple[float, ...]) -> Table:
    columns = [
        Column("mode", "", [d.start.index for d in found]),
        Column("frequency", "Hz", [d.start.frequency_hz for d in found]),
        Column("linear_rate", "1/s", [float(d.rates_1_s[0]) for d in found]),
    ]
    columns += [
        Column(f"change_x{s:g}", "%", [100.0 * float(d.changes[i]) for d in found])
        for i, s in enumerate(strengths)
    ]
    columns += [
        Column("compression", "µm", [1e6 * float(d.largest_compression_m.max()) for d in found]),
        Column("contact_force", "N", [float(d.largest_variation_n.max()) for d in found]),
    ]
    return Table(
        "modes",
        "Loss rate of E^l from each mode shape (energy lost over energy held), and its change by cubic "
        "contacts (> 0: stabilises)",
        tuple(columns),
    )


def _energies(shown: Decay) -> Table:
    columns = [Column("time", "s", list(shown.times_s)), Column("linear", "N m", list(shown.linear_nm))]
    columns += [
        Column(f"cubic_x{s:g}", "N m", list(shown.cubic_nm[i])) for i, s in enumerate(shown.strengths)
    ]
    return Table("energies", f"Linear energy E^l over time from mode {shown.start.index}", tuple(columns))


def decay_figure(found: Sequence[Decay], shown: Decay, title: str) -> Figure:
    """E^l over time from one mode, and the change of the rate of decay of all modes."""
    figure = new_figure(9.6, 4.4)
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.1))
    figure.subplots_adjust(left=0.075, right=0.985, top=0.83, bottom=0.2, wspace=0.22)
    figure.suptitle(title, x=0.075, y=0.975, **TITLE)
    _draw_energies(left, shown)
    _draw_changes(right, found, shown.strengths)
    handles, labels = left.get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncols=len(handles), bbox_to_anchor=(0.5, 0.0))
    return figure


def _draw_energies(axes: Axes, shown: Decay) -> None:
    time_ms = 1e3 * shown.times_s
    for i, strength in enumerate(shown.strengths):
        style = {"color": _COLOURS[i % len(_COLOURS)], "marker": _MARKERS[i % len(_MARKERS)], "ms": 4.0}
        every = (i * len(time_ms) // 40, max(1, len(time_ms) // 9))
        axes.plot(time_ms, shown.cubic_nm[i], lw=1.2, markevery=every, label=f"cubic ×{strength:g}", **style)
    axes.plot(time_ms, shown.linear_nm, color=INK, lw=1.6, ls=(0, (4, 2)), label="linear")
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    label_axes(axes, "time [ms]", "linear energy $E^l$ [N m]", y_gap_pt=29.0)
    axes_title(
        axes,
        f"From mode {shown.start.index} ({shown.start.frequency_hz:.0f} Hz, "
        f"i = {2 * shown.start.index - 1}, {2 * shown.start.index})",
    )
    axes.set_xlim(0.0, float(time_ms[-1]))
    grid(axes)


def _draw_changes(axes: Axes, found: Sequence[Decay], strengths: tuple[float, ...]) -> None:
    modes = np.array([d.start.index for d in found])
    width = 0.16
    axes.axhspan(-2.0, 2.0, color=GREY, alpha=0.15, lw=0)
    axes.axhline(0.0, color=GREY, lw=0.8)
    for i in range(len(strengths)):
        change = 100.0 * np.array([float(d.changes[i]) for d in found])
        x = modes + width * (i - 0.5 * (len(strengths) - 1))
        colour = _COLOURS[i % len(_COLOURS)]
        axes.vlines(x, 0.0, change, color=colour, lw=1.0)
        axes.plot(x, change, ls="none", marker=_MARKERS[i % len(_MARKERS)], ms=4.0, color=colour)
    axes.set_yscale("symlog", linthresh=2.0, linscale=0.8)
    ticks = [-1000, -100, -10, -2, 0, 2, 10, 100, 1000]
    low, high = axes.get_ylim()
    axes.set_yticks(
        [t for t in ticks if low <= t <= high], [f"{t:+d}" if t else "0" for t in ticks if low <= t <= high]
    )
    axes.minorticks_off()
    axes.set_xticks(modes, [str(m) for m in modes])
    axes.set_xlim(modes[0] - 0.6, modes[-1] + 0.6)
    label_axes(axes, "mode (by frequency)", "change of the loss rate of $E^l$ [%]", y_gap_pt=36.0)
    axes_title(axes, "Above 0: hardening stabilises (band: < 2 %)")
    grid(axes, "y")

"""Figures of a campaign, from its table.

Job: one function per figure; each returns a matplotlib Figure, or None when there is nothing to draw.
NOT its job: the spectrogram of a single braking (`spectrogram_figure`), numbers (`occurrence`,
`friction_map`), files (`report`).
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator, PercentFormatter
from numpy.typing import NDArray

from rigctl.analysis import occurrence
from rigctl.analysis.campaign_table import BrakingRow, CampaignTable, EventRow
from rigctl.analysis.friction_map import BEDDING, brakings_with_mu, friction_map
from rigctl.analysis.prediction import Prediction
from rigctl.analysis.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    LEVEL_MAP,
    LEVEL_NORM,
    ORANGE,
    PALE,
    PURPLE,
    TITLE,
    VERMILION,
    axes_title,
    colour_bar,
    grid,
    label_axes,
    new_figure,
)

_MAIN_BAND = 0.1
"""Events within this share of the median frequency belong to the main squeal."""

_LOW_KHZ = 1.15
"""Below this frequency the axis begins at zero."""

_BARS = 1.0 / 1.2
"""Height of a bar of 100 %, as share of its axes; the numbers of brakings stand above it."""

_ROLE_COLOURS = (BLUE, GREEN, PURPLE, VERMILION)


def pressure_frequency(table: CampaignTable, prediction: Prediction | None) -> Figure | None:
    """Squeal events over pressure and frequency (the paper's Fig. 14), occurrence per pressure below it."""
    rows = occurrence.by_pressure(table)
    if not rows:
        return None
    events = table.squeals()
    figure = new_figure(8.0, 5.6)
    top, bottom = figure.subplots(2, 1, sharex=True, height_ratios=(3.1, 1.0))
    figure.subplots_adjust(left=0.085, right=0.89, top=0.88, bottom=0.085, hspace=0.1)
    pressures = [row.pressure_bar for row in rows] + [p for e in events if (p := _pressure(e)) is not None]
    x_max = 1.05 * max(
        *pressures, prediction.onset_bar if prediction else 0.0
    )  # overshoot lies above set-points
    top.set_xlim(0, x_max)
    handles: list[Line2D | Patch] = []
    _draw_events(top, events)
    if prediction is not None:
        handles.append(_draw_prediction(top, bottom, prediction, x_max))
    onset = occurrence.onset_bar(table)
    if onset is not None:
        for axes, height in ((top, 1.0), (bottom, _BARS)):
            axes.axvline(onset, ymax=height, color=BLUE, lw=1.4, ls=(0, (1, 1.2)), zorder=2)
        handles.append(
            Line2D([], [], color=BLUE, lw=1.4, ls=(0, (1, 1.2)), label=f"measured onset {onset:g} bar")
        )
    top.set_ylim(*_frequency_range_khz(events, prediction))
    label_axes(top, y="frequency [kHz]")
    figure.suptitle("Squeal over brake pressure", x=0.085, y=0.975, **TITLE)
    grid(top)
    if not events:
        top.text(0.5, 0.55, "no squeal found", transform=top.transAxes, ha="center", color=GREY, fontsize=13)
    if handles:
        place = (0.085, 0.935)
        figure.legend(handles=handles, loc="upper left", ncols=2, bbox_to_anchor=place, borderaxespad=0)
    _level_bar(top)
    _occurrence_bars(bottom, rows)
    return figure


def _frequency_range_khz(events: tuple[EventRow, ...], prediction: Prediction | None) -> tuple[float, float]:
    """From 1 to 4 kHz, further by whole kHz where events or the prediction are."""
    found = [e.frequency_hz / 1000 for e in events] + ([prediction.frequency_hz / 1000] if prediction else [])
    low, high = min(found, default=1.5), max(found, default=1.5)
    return (1.0 if low >= _LOW_KHZ else 0.0), max(4.0, float(np.ceil(1.04 * high)))


def _draw_events(axes: Axes, events: tuple[EventRow, ...]) -> None:
    points = [(p, e) for e in events if (p := _pressure(e)) is not None]
    if not points:
        return
    points.sort(key=lambda item: -item[1].level_db)  # quiet, small dots on top of loud, large ones
    level = np.array([e.level_db for _, e in points])
    axes.scatter(
        [p for p, _ in points],
        [e.frequency_hz / 1000 for _, e in points],
        s=12 + 0.13 * np.clip(level - 60, 0, 50) ** 2,
        c=level,
        cmap=LEVEL_MAP,
        norm=LEVEL_NORM,
        edgecolors="white",
        linewidths=0.5,
        zorder=3,
    )


def _pressure(event: EventRow) -> float | None:
    return event.pressure_bar if event.pressure_bar is not None else event.set_pressure_bar


def _draw_prediction(top: Axes, bottom: Axes, prediction: Prediction, x_max: float) -> Line2D:
    onset, f_khz = prediction.onset_bar, prediction.frequency_hz / 1000
    look = {"color": GREEN, "lw": 1.6, "ls": (0, (5, 2))}
    top.fill_between([onset, x_max], 0.985 * f_khz, 1.015 * f_khz, color=GREEN, alpha=0.13, lw=0)
    top.plot([onset, x_max], [f_khz, f_khz], **look, zorder=2)
    for axes, height in ((top, 1.0), (bottom, _BARS)):
        axes.axvline(onset, ymax=height, **look, zorder=2)
    top.plot(onset, f_khz, marker="D", ms=7, color=GREEN, mec="white", zorder=4)
    label = f"predicted ({prediction.label}): {prediction.frequency_hz:.0f} Hz from {onset:.1f} bar"
    return Line2D([], [], marker="D", mec="white", ms=7, label=label, **look)


def _occurrence_bars(axes: Axes, rows: tuple[occurrence.PressureRow, ...]) -> None:
    pressures = [row.pressure_bar for row in rows]
    width = 0.75 * (min(np.diff(pressures)) if len(pressures) > 1 else 1.0)
    axes.bar(pressures, [1.0] * len(rows), width=width, color=PALE, zorder=1)
    axes.bar(pressures, [row.share for row in rows], width=width, color=VERMILION, alpha=0.85, zorder=1.5)
    for row in rows if len(rows) <= 24 else ():
        axes.annotate(
            f"{row.squealing}/{row.brakings}",
            (row.pressure_bar, 1.0),
            xytext=(0, 1.5),
            textcoords="offset points",
            ha="center",
            fontsize=7,
            color=GREY,
        )
    axes.set_ylim(0, 1.0 / _BARS)
    axes.set_yticks([0, 0.5, 1.0])
    axes.yaxis.set_major_formatter(PercentFormatter(1.0))
    x_label = "brake pressure [bar]  (dots: at the loudest moment; bars: set-point)"
    label_axes(axes, x_label, "squealing", y_gap_pt=35.0)


def _level_bar(axes: Axes) -> None:
    levels = ScalarMappable(LEVEL_NORM, LEVEL_MAP)
    colour_bar(axes, levels, "squeal level [dB re 20 µPa]", extend="both", extendfrac=0.03)


def pressure_temperature(table: CampaignTable, prediction: Prediction | None) -> Figure | None:
    """Loudest squeal per pressure and temperature set-point; quiet and missing cells told apart."""
    cells = occurrence.occurrence_map(table)
    if cells.brakings.size == 0:
        return None
    figure = new_figure(8.0, 4.9)
    axes = figure.subplots()
    figure.subplots_adjust(left=0.085, right=0.89, top=0.85, bottom=0.105)
    x, y = _edges(cells.pressures_bar), _edges(cells.temperatures_degc)
    quiet = np.where((cells.brakings > 0) & (cells.squealing == 0), 1.0, np.nan)
    axes.pcolormesh(x, y, quiet, cmap=ListedColormap([PALE]), edgecolors="white", linewidth=1.2)
    loud = np.ma.masked_invalid(cells.level_max_db)
    axes.pcolormesh(x, y, loud, cmap=LEVEL_MAP, norm=LEVEL_NORM, edgecolors="white", linewidth=1.2)
    many = cells.brakings.max() > 1
    for i, j in zip(*np.nonzero(cells.brakings), strict=True):
        centre = float(x[j] + x[j + 1]) / 2, float(y[i] + y[i + 1]) / 2
        if many:
            text = f"{cells.squealing[i, j]}/{cells.brakings[i, j]}"
        elif cells.squealing[i, j]:
            text = f"{cells.level_max_db[i, j]:.0f}"
        else:
            continue
        bright = not np.isnan(cells.level_max_db[i, j]) and cells.level_max_db[i, j] > 74
        colour = "white" if bright else INK
        axes.text(*centre, text, ha="center", va="center", fontsize=7, color=colour)
    handles: list[Line2D | Patch] = [
        Patch(facecolor=PALE, label="braked, no squeal"),
        Patch(facecolor="white", edgecolor=GREY, label="no complete braking"),
    ]
    if prediction is not None and x[0] < prediction.onset_bar < x[-1]:
        look = {"color": GREEN, "lw": 1.8, "ls": (0, (5, 2))}
        axes.axvline(prediction.onset_bar, **look)
        handles.append(Line2D([], [], label=f"predicted onset {prediction.onset_bar:.1f} bar", **look))
    figure.legend(handles=handles, loc="upper left", ncols=3, bbox_to_anchor=(0.085, 0.92), borderaxespad=0)
    title = "Squealing / all brakings" if many else "Loudest squeal per set-point"
    figure.suptitle(title, x=0.085, y=0.975, **TITLE)
    label_axes(axes, "brake pressure, set-point [bar]", "disc temperature, set-point [°C]", x_gap_pt=17.0)
    _ticks_at(axes, cells.pressures_bar, cells.temperatures_degc)
    _level_bar(axes)
    return figure


def _edges(centres: NDArray[np.float64]) -> NDArray[np.float64]:
    """Cell edges half-way between centres; a single centre gets a width of 2."""
    if centres.size == 1:
        return np.array([centres[0] - 1.0, centres[0] + 1.0])
    middle = (centres[1:] + centres[:-1]) / 2
    return np.concatenate(([2 * centres[0] - middle[0]], middle, [2 * centres[-1] - middle[-1]]))


def _ticks_at(axes: Axes, x: NDArray[np.float64], y: NDArray[np.float64]) -> None:
    for axis, values in ((axes.xaxis, x), (axes.yaxis, y)):
        if values.size <= 16:
            axis.set_ticks(values.tolist(), [f"{v:g}" for v in values])
    axes.tick_params(length=0)


def friction_over_pressure_temperature(table: CampaignTable) -> Figure | None:
    """mu over pressure and temperature (the paper's Fig. 6): map, and curves over temperature."""
    cells = friction_map(table)
    if cells.mu.size == 0:
        return None
    figure = new_figure(9.6, 4.3)
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.0))
    figure.subplots_adjust(left=0.07, right=0.985, top=0.9, bottom=0.125, wspace=0.456)
    x, y = _edges(cells.pressures_bar), _edges(cells.temperatures_degc)
    mesh = left.pcolormesh(
        x, y, np.ma.masked_invalid(cells.mu), cmap="cividis", edgecolors="white", linewidth=0.8
    )
    colour_bar(left, mesh, "mean µ [–]", 0.455, gap_pt=31.0)
    axes_title(left, "Coefficient of friction per set-point")
    label_axes(left, "brake pressure, set-point [bar]", "disc temperature, set-point [°C]", x_gap_pt=17.0)
    _ticks_at(left, cells.pressures_bar, cells.temperatures_degc)
    n = cells.pressures_bar.size
    chosen = sorted({round(k) for k in np.linspace(0, n - 1, min(6, n))})
    for rank, k in enumerate(chosen):
        shade = LEVEL_MAP(0.12 + 0.88 * rank / max(1, len(chosen) - 1))
        label = f"{cells.pressures_bar[k]:g} bar"
        marker = "osD^vP"[rank]
        right.plot(
            cells.temperatures_degc, cells.mu[:, k], marker=marker, ms=4.5, lw=1.5, color=shade, label=label
        )
    label_axes(right, "disc temperature, set-point [°C]", "mean µ [–]", y_gap_pt=31.0)
    axes_title(right, "Over temperature, for some pressures")
    right.legend(ncols=2)
    right.margins(y=0.12)
    grid(right)
    return figure


def friction_over_number(table: CampaignTable) -> Figure | None:
    """Mean mu over the number of the braking: bedding and drift become visible; squealing brakings are
    ringed.
    """
    rows = brakings_with_mu(table)
    if not rows:
        return None
    figure = new_figure(8.0, 3.5)
    axes = figure.subplots()
    figure.subplots_adjust(left=0.085, right=0.98, top=0.86, bottom=0.14)
    _shade_bedding(axes, [b for b in rows if b.role == BEDDING])
    roles = sorted({b.role for b in rows if b.role != BEDDING})
    colours = {BEDDING: ORANGE} | {r: _ROLE_COLOURS[i % len(_ROLE_COLOURS)] for i, r in enumerate(roles)}
    for role, colour in colours.items():
        these = [b for b in rows if b.role == role]
        if these:
            x, mu = [b.index for b in these], [_mu(b) for b in these]
            axes.plot(x, mu, ls="none", marker="o", ms=3.6, color=colour, label=role, zorder=3)
            axes.vlines(
                x,
                [_mu(b) - (b.std_mu or 0.0) for b in these],
                [_mu(b) + (b.std_mu or 0.0) for b in these],
                color=colour,
                lw=0.8,
                alpha=0.4,
            )
    loud = [b for b in rows if b.counts_for_squeal and b.squeals]
    if loud:
        axes.plot(
            [b.index for b in loud],
            [_mu(b) for b in loud],
            ls="none",
            marker="o",
            ms=7,
            mfc="none",
            mec=VERMILION,
            mew=0.9,
            label="squealed",
        )
    label_axes(axes, "number of the braking", "mean µ [–]  (bar: ± std in time)", y_gap_pt=31.0)
    figure.suptitle("Friction over the campaign", x=0.085, y=0.965, **TITLE)
    axes.xaxis.set_major_locator(MaxNLocator(integer=True))
    axes.margins(x=0.02, y=0.1)
    figure.legend(loc="upper right", ncols=5, bbox_to_anchor=(0.98, 0.97), borderaxespad=0)
    grid(axes)
    return figure


def _mu(braking: BrakingRow) -> float:
    return np.nan if braking.mean_mu is None else braking.mean_mu


def _shade_bedding(axes: Axes, bedding: list[BrakingRow]) -> None:
    if bedding:
        axes.axvspan(bedding[0].index - 0.5, bedding[-1].index + 0.5, color=ORANGE, alpha=0.1, lw=0)


def level_distribution(table: CampaignTable) -> Figure | None:
    """Histogram of the loudest squeal per braking, and share of brakings at or above a level."""
    base = table.with_sound()
    levels = np.array([b.squeal_level_db for b in table.squealing() if b.squeal_level_db is not None])
    if not base or levels.size == 0:
        return None
    figure = new_figure(9.6, 3.6)
    left, right = figure.subplots(1, 2)
    figure.subplots_adjust(left=0.065, right=0.98, top=0.88, bottom=0.14, wspace=0.2)
    low, high = 5 * np.floor(min(60.0, levels.min()) / 5), max(100.0, 5 * np.ceil(levels.max() / 5))
    bins = np.arange(low, high + 2.5, 2.5)
    _, _, patches = left.hist(levels, bins=bins.tolist(), edgecolor="white")
    for patch, centre in zip(patches, (bins[:-1] + bins[1:]) / 2, strict=True):  # type: ignore[call-overload]
        patch.set_facecolor(LEVEL_MAP(LEVEL_NORM(centre)))
    label_axes(left, "level of the loudest squeal [dB re 20 µPa]", "brakings", y_gap_pt=23.0)
    axes_title(left, f"Levels of {levels.size} squealing brakings")
    left.yaxis.set_major_locator(MaxNLocator(integer=True))
    grid(left, "y")
    ordered = np.sort(levels)
    steps = np.concatenate(([low], np.repeat(ordered, 2), [high]))
    above = np.concatenate(([ordered.size], np.repeat(np.arange(ordered.size, -1, -1), 2)[1:-1], [0])) / len(
        base
    )
    right.plot(steps, above, color=BLUE, lw=1.8)
    right.fill_between(steps, above, color=BLUE, alpha=0.12, lw=0)
    for threshold, share, _ in occurrence.occurrence_per_threshold(table):
        right.plot(threshold, share, "o", color=BLUE, ms=4)
        if share > 0:
            right.annotate(
                f"{share:.0%}", (threshold, share), xytext=(5, 4), textcoords="offset points", fontsize=8
            )
    right.set_xlim(low - 0.02 * (high - low), high)
    right.set_ylim(0, max(0.1, 1.2 * above.max()))
    right.yaxis.set_major_formatter(PercentFormatter(1.0, decimals=0))
    label_axes(right, "level L [dB re 20 µPa]")
    axes_title(right, f"Share of all {len(base)} brakings that reach L")
    grid(right)
    return figure


def frequency_over_temperature(table: CampaignTable) -> Figure | None:
    """Squeal frequency over disc temperature at the loudest moment, coloured by pressure; drift becomes
    visible.
    """
    points = [
        (e.temperature_degc, e.frequency_hz, p)
        for e in table.squeals()
        if e.temperature_degc is not None and (p := _pressure(e)) is not None
    ]
    if not points:
        return None
    temperature, frequency, pressure = (np.array(column) for column in zip(*points, strict=True))
    figure = new_figure(8.0, 3.5)
    axes = figure.subplots()
    figure.subplots_adjust(left=0.105, right=0.89, top=0.9, bottom=0.14)
    dots = axes.scatter(
        temperature, frequency, c=pressure, cmap="cividis", s=26, edgecolors="white", linewidths=0.5
    )
    colour_bar(axes, dots, "brake pressure [bar]", ticks=MaxNLocator(6, integer=True))
    label_axes(axes, "disc temperature at the loudest moment [°C]", "frequency [Hz]", y_gap_pt=44.0)
    text = "Squeal frequency over disc temperature"
    axes.ticklabel_format(useOffset=False, style="plain")
    axes.margins(x=0.04, y=0.15)
    middle = float(np.median(frequency))
    outside = np.abs(frequency / middle - 1.0) > _MAIN_BAND
    if 0 < np.count_nonzero(outside) < frequency.size / 2:
        near = frequency[~outside]
        room = max(20.0, 0.2 * float(np.ptp(near)))
        axes.set_ylim(near.min() - room, near.max() + room)
        text += f" ({np.count_nonzero(outside)} events outside)"
    axes_title(axes, text)
    grid(axes)
    return figure

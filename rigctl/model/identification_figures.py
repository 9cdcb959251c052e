"""Tables and figures of an identification (`rigctl.model.identification`).

NOT its job: the fit.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rigctl.analysis.style import BLUE, GREEN, GREY, PALE, TITLE, VERMILION, grid, label_axes, new_figure
from rigctl.model.output import Column, Table
from sim_hardware.brake_model.linear import PRESSURE, LinearModel, known, value_of

if TYPE_CHECKING:
    from rigctl.model.identification import IdentifyResult

Array = NDArray[np.float64]

_WELL_KNOWN = 0.7
"""Posterior over prior spread below which the data have told something of a parameter by itself."""


def data_table(result: IdentifyResult) -> Table:
    """Measured and predicted."""
    measured, found = result.recorded.measured, result.fit
    names = [f"onset ({measured.quantity})", "frequency (Hz)"][: measured.data.size]
    sampled = result.predictions.reshape(-1, measured.data.size)
    spread = sampled.std(axis=0).tolist() if len(sampled) else [None] * measured.data.size
    return Table(
        "data",
        "Measured, and what the model gives",
        (
            Column("datum", "", names),
            Column("measured", "", measured.data.tolist()),
            Column("uncertainty", "", measured.sigma.tolist()),
            Column("file", "", found.before.tolist()),
            Column("fitted", "", found.after.tolist()),
            Column("spread_linearised", "", found.predicted_sigma.tolist()),
            Column("spread_sampled", "", spread),
        ),
    )


def parameter_table(model: LinearModel, result: IdentifyResult, base: Mapping[str, float]) -> Table:
    """Variables with prior and posterior."""
    found = result.fit
    single = [v.members == (v.name,) for v in result.variables]
    before = [
        value_of(model, v.name, base) if one else 1.0 for v, one in zip(result.variables, single, strict=True)
    ]
    sampled = result.logarithms.reshape(-1, len(result.variables))
    spread = (100.0 * sampled.std(axis=0)).tolist() if len(sampled) else [None] * len(before)
    units = [
        known(model, v.name).unit if one else "factor"
        for v, one in zip(result.variables, single, strict=True)
    ]
    return Table(
        "parameters",
        "Free variables before and after",
        (
            Column("variable", "", [v.name for v in result.variables]),
            Column("unit", "", units),
            Column("file", "", before),
            Column("fitted", "", (np.array(before) * found.factors).tolist()),
            Column("change", "%", (100.0 * (found.factors - 1.0)).tolist()),
            Column("prior", "%", (100.0 * found.prior).tolist()),
            Column("posterior", "%", (100.0 * found.posterior).tolist()),
            Column("posterior_sampled", "%", spread),
            Column("told_by_data", "", (found.posterior < _WELL_KNOWN * found.prior).tolist()),
        ),
    )


def direction_table(result: IdentifyResult) -> Table:
    """Combinations of variables that the data see."""
    found = result.fit
    texts = []
    for direction in found.directions:
        order = np.argsort(-np.abs(direction), kind="stable")[:5]
        texts.append(", ".join(f"{direction[i]:+.2f} {result.variables[i].name}" for i in order))
    return Table(
        "directions",
        "Combinations that the data see (singular value above 1: better than the prior)",
        (
            Column("singular_value", "", found.singular_values.tolist()),
            Column("fixed", "", (found.singular_values > 1.0).tolist()),
            Column("combination", "", texts),
        ),
    )


def draw_parameters(result: IdentifyResult) -> Figure:
    """Changes with prior and posterior spread."""
    found = result.fit
    moved = np.maximum(np.abs(found.logarithms) / found.prior, 1.0 - found.posterior / found.prior)
    order = np.argsort(-moved, kind="stable")[:20]
    figure = new_figure(8.0, 1.5 + 0.3 * len(order))
    axes = figure.subplots()
    width = max(len(result.variables[i].title) for i in order)
    height = figure.get_figheight()
    figure.subplots_adjust(
        left=min(0.1 + 0.0095 * width, 0.5), right=0.97, top=1.0 - 0.45 / height, bottom=0.6 / height
    )
    rows = np.arange(len(order))
    axes.barh(
        rows,
        200.0 * found.prior[order],
        left=-100.0 * found.prior[order],
        height=0.6,
        color=PALE,
        label="prior",
    )
    axes.errorbar(
        100.0 * (found.factors[order] - 1.0), rows, xerr=100.0 * found.posterior[order], fmt="o", color=BLUE,
        capsize=3, label="posterior, linearised",
    )  # fmt: skip
    if result.logarithms.shape[1] > 1:
        sampled = 100.0 * (np.exp(result.logarithms.reshape(-1, len(result.variables))) - 1.0)
        low, middle, high = np.quantile(sampled, (0.16, 0.5, 0.84), axis=0)
        axes.errorbar(
            middle[order], rows + 0.2, xerr=[(middle - low)[order], (high - middle)[order]], fmt="s", ms=3.5,
            color=GREEN, capsize=2, label="posterior, sampled",
        )  # fmt: skip
    axes.axvline(0.0, color=GREY, lw=0.8)
    axes.set_yticks(rows, [result.variables[i].title for i in order])
    axes.invert_yaxis()
    label_axes(axes, "change of the file's value [%], bars: ± 1 standard deviation")
    grid(axes, "x")
    axes.legend(loc="best")
    figure.suptitle(
        "What the recorded squeal says about the parameters", x=0.03, y=1.0 - 0.12 / height, **TITLE
    )
    return figure


def draw_predictions(result: IdentifyResult) -> Figure:
    """Onset and frequency: measured, before, after, samples."""
    measured, found = result.recorded.measured, result.fit
    figure = new_figure(7.0, 4.6)
    axes = figure.subplots()
    figure.subplots_adjust(left=0.12, right=0.97, top=0.9, bottom=0.12)
    sampled = result.predictions.reshape(-1, 2)
    axes.scatter(*sampled.T, s=10, color=BLUE, alpha=0.5, lw=0, label="samples of the posterior")
    axes.errorbar(
        measured.onset, measured.data[1], xerr=measured.onset_sigma, yerr=measured.frequency_sigma_hz,
        fmt="o", color=VERMILION, capsize=4, zorder=4, label="measured ± 1 standard uncertainty",
    )  # fmt: skip
    axes.plot(*found.after, "D", color=GREEN, mec="white", ms=8, zorder=5, label="fitted model")
    axes.plot(*found.before, "X", color=GREY, mec="white", ms=8, zorder=5, label="model of the file")
    label_axes(
        axes, "onset pressure [bar]" if measured.quantity == PRESSURE else f"onset {measured.quantity}",
        "frequency at onset [Hz]", y_gap_pt=40,
    )  # fmt: skip
    grid(axes)
    axes.legend(loc="best")
    figure.suptitle("Onset and frequency: measured, file, fitted", x=0.12, y=0.97, **TITLE)
    return figure

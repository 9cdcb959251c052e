"""Monte Carlo over the scatter of a model's parameters: squeal probability over pressure or friction.

    study = scatter_study(Path("configs/brakes/model.toml"), "pressure", np.linspace(0, 30, 61), samples=1000)

Job: `sample` (a task of the runner), `scatter_study` (tables, facts, figures). NOT its job: random factors,
intervals and correlations themselves (`sim_hardware.brake_model.scatter`), parallel running (`runner`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

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
from rigctl.core.errors import ConfigError
from rigctl.model.loading import study_errors
from rigctl.model.output import Column, Study, Table
from rigctl.model.runner import RunOptions, generator, seeded
from rigctl.model.runner_model import load_source, model_source
from sim_hardware.brake_model.first_onset import Scan, scan
from sim_hardware.brake_model.linear import MU, PRESSURE, LinearModel, known
from sim_hardware.brake_model.scatter import (
    Drivers,
    Law,
    Shares,
    Variable,
    changed,
    check_law,
    draw,
    drivers,
    variables,
    wilson,
)

Array = NDArray[np.float64]

CONFIDENCE = 0.95
MOST_SAMPLES = 10_000_000
_SHOWN_DRIVERS = 12
_AXIS = {PRESSURE: "brake pressure [bar]", MU: "coefficient of friction"}


@dataclass(frozen=True, slots=True)
class ScatterResult:
    """What came of n samples over m values of a quantity.

    Attributes
    ----------
    nominal : the model of the file
    factors : (n, k) what each variable was multiplied with
    onsets : (n,) first unstable value; inf where stable over the range
    frequencies_hz : (n,) at the onset; nan where stable
    unstable : (n, m)
    squeal : share of samples unstable at each value, with confidence interval
    by_onset, by_frequency : what drives them
    """

    variables: tuple[Variable, ...]
    nominal: Scan
    factors: Array
    onsets: Array
    frequencies_hz: Array
    unstable: NDArray[np.bool_]
    squeal: Shares
    by_onset: Drivers
    by_frequency: Drivers


def sample(task: dict[str, Any], setting: dict[str, Any]) -> dict[str, Any]:
    """One random brake: onset, frequency, and at which values it is unstable ("0011…"). A task of
    `run_study`.
    """
    model = load_source(setting["model"])
    chosen = variables(model, setting["names"], setting["groups"])
    factors = draw(generator(task), len(chosen), setting["spread"], setting["law"])
    values = changed(model, chosen, factors, setting["values"])
    found = scan(model, setting["over"], np.array(setting["grid"]), values)
    return {
        "onset": found.onset,
        "frequency_hz": found.frequency_hz,
        "unstable": "".join("1" if u else "0" for u in found.unstable),
    }


def scatter(
    path: Path,
    over: str,
    values_over: Array,
    *,
    spread: float = 0.05,
    law: Law = "uniform",
    samples: int = 1000,
    seed: int = 1,
    names: Sequence[str] | None = None,
    groups: Sequence[str] = (),
    values: Mapping[str, float] | None = None,
    options: RunOptions | None = None,
) -> ScatterResult:
    """Scatter a model's parameters and see where the samples become unstable.

    Parameters
    ----------
    path : model file
    over : quantity that is raised, "pressure" (bar) or "mu"
    values_over : (m,) its values, rising
    spread, law : see `sim_hardware.brake_model.scatter`
    samples, seed : number of random brakes, and the seed they all come from
    names, groups : what scatters; every parameter of the file where both are left out
    values : other values than the file's, for all samples
    options : workers, folder

    Raises
    ------
    ConfigError
        wrong model, names, spread, number of samples
    RunError, StudyStopped
        see `run_study`
    """
    place = str(path)
    source = model_source(path)
    model = load_source(source)
    with study_errors(place):
        check_law(spread, law)
        if not 1 <= samples <= MOST_SAMPLES:
            raise ConfigError(f"must be from 1 to {MOST_SAMPLES}.", place="--samples", value=samples)
        known(model, over)
        chosen = variables(model, names, groups)
        _check_over(over, chosen, values)
        nominal = scan(model, over, values_over, values)
    setting = {
        "model": source,
        "over": over,
        "grid": [float(x) for x in values_over],
        "spread": spread,
        "law": law,
        "names": None if names is None else list(names),
        "groups": list(groups),
        "values": dict(values or {}),
    }
    tasks = seeded([{} for _ in range(samples)], seed)
    with study_errors(place):
        found = (options or RunOptions()).run(tasks, "rigctl.model.scatter:sample", setting)
        factors = np.stack([draw(generator(task), len(chosen), spread, law) for task in tasks])
        onsets = np.array([np.inf if f["onset"] is None else f["onset"] for f in found])
        frequencies = np.array([np.nan if f["onset"] is None else f["frequency_hz"] for f in found])
        unstable = np.array([[c == "1" for c in f["unstable"]] for f in found])
        return ScatterResult(
            chosen,
            nominal,
            factors,
            onsets,
            frequencies,
            unstable,
            wilson(unstable.sum(axis=0), samples, CONFIDENCE),
            drivers(factors, onsets),
            drivers(factors, frequencies),
        )


def scatter_study(
    path: Path,
    over: str,
    values_over: Array,
    *,
    spread: float = 0.05,
    law: Law = "uniform",
    samples: int = 1000,
    seed: int = 1,
    names: Sequence[str] | None = None,
    groups: Sequence[str] = (),
    values: Mapping[str, float] | None = None,
    options: RunOptions | None = None,
) -> Study:
    """`scatter` as facts, tables (probability, drivers, samples) and figures (probability, onset,
    drivers).
    """
    result = scatter(
        path, over, values_over, spread=spread, law=law, samples=samples, seed=seed,
        names=names, groups=groups, values=values, options=options,
    )  # fmt: skip
    model = load_source(model_source(path))
    unit = _unit(model, over)
    what = f"{over} [{unit}]" if unit else over
    percent = f"{100 * spread:g} %"
    law_text = (
        f"uniform within ±{percent}" if law == "uniform" else f"lognormal, standard deviation {percent}"
    )
    facts = {
        "model": model.name,
        "samples": samples,
        "seed": seed,
        "law": law_text,
        "variables": len(result.variables),
        "over": f"{what} from {values_over[0]:g} to {values_over[-1]:g}, {len(values_over)} values",
        "onset_of_the_file": result.nominal.onset,
        "frequency_of_the_file_hz": result.nominal.frequency_hz,
        "share_unstable_somewhere_in_the_range": float(np.isfinite(result.onsets).mean()),
        **_quantiles("onset", result.onsets),
        **_quantiles("frequency", result.frequencies_hz[np.isfinite(result.frequencies_hz)], "_hz"),
        "driver_of_onset": _leader(result.variables, result.by_onset),
        "driver_of_frequency": _leader(result.variables, result.by_frequency),
        "reading": "A quantile of onset is missing where that share of samples stays stable over the range. "
        f"Intervals: Wilson, {100 * CONFIDENCE:g} %. Drivers: Spearman's rank correlation; chance stays "
        "below the threshold with 95 % for all variables together. The probability is that of the stated "
        "scatter, which is an assumption, not of a production line.",
        "threshold_of_chance_onset": result.by_onset.threshold,
        "threshold_of_chance_frequency": result.by_frequency.threshold,
        "set": dict(values or {}),
    }
    title = f"Squeal probability of '{model.name}' over {what}, {samples} samples, {law_text}"
    return Study(
        "scatter",
        title,
        facts,
        (
            _probability_table(result, over, unit),
            _drivers_table(model, result),
            _samples_table(result, over, unit),
        ),
        {
            "probability": partial(_draw_probability, result, over, unit),
            "distribution": partial(_draw_distribution, result, over, unit),
            "drivers": partial(_draw_drivers, result),
        },
    )


def _check_over(over: str, chosen: Sequence[Variable], values: Mapping[str, float] | None) -> None:
    for variable in chosen:
        if over in variable.members:
            raise ValueError(f"{over} is raised by --over and cannot scatter as well")
    if values and over in values:
        raise ValueError(f"{over} is raised by --over and cannot be set as well")


def _unit(model: LinearModel, over: str) -> str:
    unit = model.quantities[over].unit
    return "" if unit == "1" else unit


def _axis(over: str, unit: str) -> str:
    return _AXIS.get(over, f"{over} [{unit}]" if unit else over)


def _quantiles(name: str, values: Array, suffix: str = "") -> dict[str, float | None]:
    if values.size == 0:
        return {}
    found = np.quantile(values, (0.1, 0.5, 0.9), method="inverted_cdf")  # an order statistic: inf stays inf
    return {
        f"{name}_{share}_percent{suffix}": float(x) if np.isfinite(x) else None
        for share, x in zip((10, 50, 90), found, strict=True)
    }


def _leader(chosen: Sequence[Variable], found: Drivers) -> str:
    if np.isnan(found.correlation).all():
        return "too few unstable samples"
    first = int(np.nanargmax(np.abs(found.correlation)))
    return f"{chosen[first].title} (rank correlation {found.correlation[first]:+.2f})"


def _probability_table(result: ScatterResult, over: str, unit: str) -> Table:
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


def _drivers_table(model: LinearModel, result: ScatterResult) -> Table:
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


def _samples_table(result: ScatterResult, over: str, unit: str) -> Table:
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


def _draw_probability(result: ScatterResult, over: str, unit: str) -> Figure:
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


def _draw_distribution(result: ScatterResult, over: str, unit: str) -> Figure:
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


def _draw_drivers(result: ScatterResult) -> Figure:
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

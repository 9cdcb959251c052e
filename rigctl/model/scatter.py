"""Monte Carlo over the scatter of a model's parameters: squeal probability over pressure or friction.

    study = scatter_study(Path("configs/brakes/model.toml"), "pressure", np.linspace(0, 30, 61), samples=1000)

Job: `scatter`, and `scatter_study` with tables, facts and figures. NOT its job: random factors,
intervals and correlations themselves (`sim_hardware.brake_model.design.scatter`), parallel running
(`runner`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rigctl.core.errors import ConfigError
from rigctl.model.loading import study_errors
from rigctl.model.output import Study
from rigctl.model.runner import RunOptions, generator, seeded
from rigctl.model.runner_model import load_source, model_source
from rigctl.model.scatter_figures import (
    draw_distribution,
    draw_drivers,
    draw_probability,
    drivers_table,
    probability_table,
    samples_table,
)
from rigctl.model.study_tasks import described
from sim_hardware.brake_model.design.scatter import (
    Drivers,
    Law,
    Shares,
    Variable,
    check_law,
    draw,
    drivers,
    variables,
    wilson,
)
from sim_hardware.brake_model.eigen.first_onset import Scan, scan
from sim_hardware.brake_model.linear import LinearModel, known

Array = NDArray[np.float64]

CONFIDENCE = 0.95
MOST_SAMPLES = 10_000_000


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
    spread, law : see `sim_hardware.brake_model.design.scatter`
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
        "variables": described(chosen),
        "values": dict(values or {}),
    }
    tasks = seeded([{} for _ in range(samples)], seed)
    with study_errors(place):
        found = (options or RunOptions()).run(tasks, "rigctl.model.study_tasks:sample", setting)
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
    what = f"{over} ({unit})" if unit else over
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
            probability_table(result, over, unit),
            drivers_table(model, result),
            samples_table(result, over, unit),
        ),
        {
            "probability": partial(draw_probability, result, over, unit),
            "distribution": partial(draw_distribution, result, over, unit),
            "drivers": partial(draw_drivers, result),
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

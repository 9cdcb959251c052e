"""Identification of a brake's parameters from recorded squeal: a campaign, or an onset and a frequency by
hand.

    study, result = identify_study(path, measured_in(Path("data/campaign")), free=["c_abu_t", "m_padi"])
    write_brake(path, Path("fitted.toml"), result)

Job: `measured_in` (onset and frequency of a campaign with their uncertainty), `identify`, `identify_study`
(facts, tables, figures), `write_brake`. NOT its job: the fit (`brake_model.fit`), finding squeal in sound
(`rigctl.signals`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.analysis.campaign_table import CampaignTable, read_campaign
from rigctl.analysis.occurrence import by_pressure
from rigctl.core.errors import ConfigError
from rigctl.model.identification_figures import (
    data_table,
    direction_table,
    draw_parameters,
    draw_predictions,
    parameter_table,
)
from rigctl.model.loading import read_brake, study_errors
from rigctl.model.output import Study
from rigctl.model.runner import RunOptions, seeded
from rigctl.model.runner_model import load_source, model_source
from rigctl.model.study_tasks import described
from sim_hardware.brake_model.design.fit import Fit, Measured, fit, potential_scale_reduction
from sim_hardware.brake_model.design.scatter import Variable, variables
from sim_hardware.brake_model.identify import replaced_parameter
from sim_hardware.brake_model.linear import PRESSURE, known, value_of

Array = NDArray[np.float64]

#: uncertainty of numbers given by hand, where none is given: as shares
HAND_ONSET, HAND_FREQUENCY = 0.05, 0.005
#: resolution of squeal frequencies (Hz): no frequency of a campaign is known better
_LEAST_FREQUENCY_SIGMA_HZ = 2.0
_MAIN_BAND = 0.1
"""Events within this share of the median frequency belong to the main squeal."""
_NEAR_ONSET = 3
"""The frequency is that of the lowest pressures with squeal, as many as this: the model knows it at onset
only.
"""
CHAINS = 4
_GOOD_R = 1.1


@dataclass(frozen=True, slots=True)
class Recorded:
    """What was measured, where it comes from and how it was read."""

    measured: Measured
    origin: str
    reading: str


@dataclass(frozen=True, slots=True)
class IdentifyResult:
    """A fit, its variables, and samples of its posterior (empty where none were asked for).

    Attributes
    ----------
    logarithms : (c, n, k) ln(factor) of c chains
    predictions : (c, n, d) onset and frequency of each sample
    """

    variables: tuple[Variable, ...]
    recorded: Recorded
    fit: Fit
    logarithms: Array
    predictions: Array


def by_hand(
    onset: float,
    frequency_hz: float | None = None,
    onset_sigma: float | None = None,
    frequency_sigma_hz: float | None = None,
    quantity: str = PRESSURE,
) -> Recorded:
    """Onset and frequency as somebody tells them; 5 % and 0.5 % uncertain unless told.

    Raises
    ------
    ConfigError
        a number that is not positive
    """
    with study_errors("measurement"):
        if frequency_hz is not None and frequency_sigma_hz is None:
            frequency_sigma_hz = HAND_FREQUENCY * frequency_hz
        measured = Measured(
            onset,
            HAND_ONSET * onset if onset_sigma is None else onset_sigma,
            frequency_hz,
            None if frequency_hz is None else frequency_sigma_hz,
            quantity,
        )
    return Recorded(measured, "numbers given by hand", "as given")


def measured_in(folder: Path) -> Recorded:
    """Onset pressure and squeal frequency of a campaign.

    The onset lies between the highest pressure below the first squeal (quiet) and the lowest at which at
    least half of the brakings squeal: middle, and width / sqrt(12) as standard uncertainty (anywhere
    between is equally likely). The frequency is the median of the main squeal at the lowest squealing
    pressures, its uncertainty the scatter of these events (quartiles / 1.349), at least 2 Hz.

    Raises
    ------
    ConfigError
        no squeal, or squeal at all pressures
    RecordingError
        not a campaign
    """
    table = read_campaign(folder)
    rows = by_pressure(table)
    place = str(folder)
    squealing = [row for row in rows if row.squealing]
    if not squealing:
        raise ConfigError(
            "no braking of this campaign squealed.", place=place, remedy="Nothing to identify from."
        )
    quiet = [row.pressure_bar for row in rows if row.pressure_bar < squealing[0].pressure_bar]
    mostly = [row.pressure_bar for row in squealing if row.share >= 0.5]
    if not quiet:
        raise ConfigError(
            f"it squeals already at the lowest pressure ({squealing[0].pressure_bar:g} bar).",
            place=place,
            remedy="Run lower pressures, or give the onset by hand: --onset-bar.",
        )
    low, high = quiet[-1], mostly[0] if mostly else squealing[-1].pressure_bar
    frequencies = _near_onset(table, [row.pressure_bar for row in squealing[:_NEAR_ONSET]])
    quartiles = np.percentile(frequencies, (25, 50, 75))
    sigma_hz = max(float(quartiles[2] - quartiles[0]) / 1.349, _LEAST_FREQUENCY_SIGMA_HZ)
    measured = Measured(0.5 * (low + high), (high - low) / np.sqrt(12.0), float(quartiles[1]), sigma_hz)
    reading = (
        f"quiet at {low:g} bar, at least half of the brakings squeal from {high:g} bar; "
        f"{len(frequencies)} events near onset"
    )
    return Recorded(measured, f"campaign {folder.name}", reading)


def identify(
    path: Path,
    recorded: Recorded,
    *,
    free: Sequence[str] | None = None,
    groups: Sequence[str] = (),
    spread: float = 0.05,
    samples: int = 400,
    seed: int = 1,
    values: Mapping[str, float] | None = None,
    options: RunOptions | None = None,
) -> IdentifyResult:
    """Parameters that explain a measured squeal.

    Parameters
    ----------
    free : "NAME" or "NAME:SPREAD", quantities to identify with their prior spread (standard deviation of
        ln(factor), 0.05: 5 %); every parameter of the file where neither `free` nor `groups` are given
    groups : parameter groups whose members change alike, likewise
    spread : prior spread where none is given
    samples : of the posterior, shared by four chains; 0: linearised uncertainty only
    values : other values than the file's

    Raises
    ------
    ConfigError
        wrong model, names, spreads; a model that does not squeal
    RunError, StudyStopped
        see `run_study`
    """
    place = str(path)
    source = model_source(path)
    model, base = load_source(source), dict(values or {})
    with study_errors(place):
        names, own = _spreads(free, spread, "--free")
        group_names, group_own = _spreads(groups, spread, "--groups")
        chosen = variables(model, names, group_names or ())
        spreads = [*own, *group_own] if names is not None or group_names else [spread] * len(chosen)
        found = fit(model, chosen, recorded.measured, spreads=spreads, base=base)
        if samples < 0:
            raise ConfigError("must not be negative.", place="--samples", value=samples)
    shape = (CHAINS, 0, len(chosen)), (CHAINS, 0, recorded.measured.data.size)
    logarithms, predictions = np.empty(shape[0]), np.empty(shape[1])
    if samples:
        measured = recorded.measured
        setting = {
            "model": source,
            "variables": described(chosen),
            "values": base,
            "length": -(-samples // CHAINS),
            "measured": {name: getattr(measured, name) for name in Measured.__dataclass_fields__},
            "fit": {
                "logarithms": found.logarithms.tolist(),
                "covariance": found.covariance.tolist(),
                "prior": found.prior.tolist(),
            },
        }
        with study_errors(place):
            chains = (options or RunOptions()).run(
                seeded([{} for _ in range(CHAINS)], seed),
                "rigctl.model.study_tasks:posterior_chain",
                setting,
            )
        logarithms = np.array([c["logarithms"] for c in chains])
        predictions = np.array([c["predictions"] for c in chains])
    return IdentifyResult(chosen, recorded, found, logarithms, predictions)


def identify_study(
    path: Path,
    recorded: Recorded,
    *,
    free: Sequence[str] | None = None,
    groups: Sequence[str] = (),
    spread: float = 0.05,
    samples: int = 400,
    seed: int = 1,
    values: Mapping[str, float] | None = None,
    options: RunOptions | None = None,
) -> tuple[Study, IdentifyResult]:
    """`identify` as facts, tables (parameters, data, directions) and figures; and its result for
    `write_brake`.
    """
    result = identify(
        path, recorded, free=free, groups=groups, spread=spread, samples=samples, seed=seed,
        values=values, options=options,
    )  # fmt: skip
    model, found, measured = load_source(model_source(path)), result.fit, recorded.measured
    k, d = len(result.variables), measured.data.size
    known_combinations = found.identifiable
    facts: dict[str, Any] = {
        "model": model.name,
        "data_from": recorded.origin,
        "data_read": recorded.reading,
        "free_variables": k,
        "data": d,
        "combinations_fixed_by_the_data": known_combinations,
        "verdict": _verdict(k, d, known_combinations),
        "misfit_of_data_in_sigma": float(np.sqrt(2.0 * found.cost_data)),
        "change_in_prior_sigma": float(np.sqrt(2.0 * found.cost_prior)),
        "contradiction": _contradiction(found, d),
        "converged": found.converged,
        "singular_values": found.singular_values.tolist(),
        "samples": int(result.logarithms.shape[0] * result.logarithms.shape[1]),
        "seed": seed,
        "set": dict(values or {}),
    }
    if result.logarithms.shape[1] > 1:
        scale = float(
            potential_scale_reduction(np.concatenate([result.logarithms, result.predictions], axis=2)).max()
        )
        facts["worst_r_of_chains"] = scale
        facts["samples_verdict"] = (
            "chains agree"
            if scale < _GOOD_R
            else f"chains do not agree yet (R above {_GOOD_R:g}): take more samples or fewer free variables"
        )
    title = f"'{model.name}' identified from {recorded.origin}: {_verdict(k, d, known_combinations)}"
    tables = (data_table(result), parameter_table(model, result, values or {}), direction_table(result))
    figures = {
        "parameters": partial(draw_parameters, result),
        **({"predictions": partial(draw_predictions, result)} if d > 1 and facts["samples"] else {}),
    }
    return Study("identify", title, facts, tables, figures), result


def write_brake(
    path: Path, target: Path, result: IdentifyResult, values: Mapping[str, float] | None = None
) -> None:
    """Write a new brake file: the old text with the identified values and where they come from.

    Raises
    ------
    ConfigError
        the target is there already, a variable is no parameter of the file (a place of an expression, a
        group of such), or does not stand on a line of its own
    """
    if target.exists():
        raise ConfigError(
            "is there already and is not overwritten.",
            place=str(target),
            remedy="Name a file that does not exist.",
        )
    with study_errors(str(path)):
        model = load_source(model_source(path))
        text = path.read_text(encoding="utf-8")
        measured, found = result.recorded.measured, result.fit
        data = f"{measured.quantity} {measured.onset:.4g} ± {measured.onset_sigma:.2g}"
        if measured.frequency_hz is not None:
            data += f", {measured.frequency_hz:.1f} ± {measured.frequency_sigma_hz:.2g} Hz"
        for number, variable in enumerate(result.variables):
            spread = (
                f"prior ±{100 * found.prior[number]:.3g} %, posterior ±{100 * found.posterior[number]:.3g} %"
            )
            origin = f"identified from {result.recorded.origin} (onset at {data}); {spread}"
            for member in variable.members:
                if "." in member:
                    raise ValueError(
                        f"{member} is a place of an expression and has no value of its own in the file: "
                        "free a parameter, or write one for it"
                    )
                value = value_of(model, member, values) * float(found.factors[number])
                text = replaced_parameter(
                    text, member, known(model, member).unit, float(f"{value:.8g}"), origin
                )
    try:
        target.write_text(text, encoding="utf-8")
    except OSError as error:
        raise ConfigError(f"cannot be written: {error.strerror}.", place=str(target)) from error
    read_brake(target)  # what was written is a brake


def _near_onset(table: CampaignTable, pressures: Sequence[float]) -> Array:
    squeals = table.squeals()
    here = np.array([e.frequency_hz for e in squeals if e.set_pressure_bar in pressures])
    if here.size == 0:
        here = np.array([e.frequency_hz for e in squeals])
    middle = float(np.median(here))
    return here[np.abs(here - middle) <= _MAIN_BAND * middle]


def _spreads(texts: Sequence[str] | None, spread: float, place: str) -> tuple[list[str] | None, list[float]]:
    """Names and prior spreads from "NAME" or "NAME:SPREAD"."""
    if not texts:
        return (None if place == "--free" else []), []
    names, spreads = [], []
    for text in texts:
        name, _, own = text.partition(":")
        try:
            spreads.append(float(own) if own else spread)
        except ValueError:
            raise ConfigError(
                "is not NAME or NAME:SPREAD.",
                place=place,
                value=text,
                remedy=f"For example {place} c_abu_t:0.1",
            ) from None
        names.append(name.strip())
    return names, spreads


def _verdict(k: int, d: int, fixed: int) -> str:
    numbers = f"{fixed} of {k} combinations of variables are fixed by {d} {'number' if d == 1 else 'numbers'}"
    if k > fixed:
        return f"underdetermined: {numbers}, the rest is prior"
    return f"determined: {numbers}"


def _contradiction(found: Fit, d: int) -> str:
    data, prior = np.sqrt(2.0 * found.cost_data), np.sqrt(2.0 * found.cost_prior)
    if data > 2.0 * np.sqrt(d):
        return (
            "the free variables cannot explain the data within their prior: free others, or widen the prior"
        )
    if prior > 3.0 + np.sqrt(found.prior.size):
        return "the data ask for larger changes than the prior expects"
    return "none"

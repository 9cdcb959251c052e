"""The evaluation of a braking (`rigctl.signals.evaluation`) in the form of the braking file.

Job: settings from plain mappings, results as named numbers with units, events as columns; a failure of the
evaluation is stated in the file and does not cost the samples. NOT its job: evaluating.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.core.channels import ChannelData
from rigctl.recording.braking import Outcome
from rigctl.signals.evaluation import Evaluation, evaluate
from rigctl.signals.friction import FrictionGeometry
from rigctl.signals.squeal import SquealDetection, SquealEvent

_SUFFIX_BY_UNIT = {"bar": "_bar", "N·m": "_nm", "1/min": "_rpm", "°C": "_degc", "Pa": "_pa"}


def evaluate_braking(channels: Mapping[str, ChannelData], settings: Mapping[str, Any]) -> Outcome:
    """Evaluate stored channels.

    Parameters
    ----------
    channels : mapping of str to ChannelData
    settings : mapping
        {"friction": {...}, "detection": {...}}: fields of `FrictionGeometry` and `SquealDetection`; what is
        left out has its default.

    Returns
    -------
    Outcome
        With `error` set when the evaluation was not possible: the samples are worth keeping all the same.
    """
    try:
        friction = FrictionGeometry(**settings.get("friction", {}))
        detection = SquealDetection(**settings.get("detection", {}))
        found = evaluate(channels, friction=friction, detection=detection)
    except (ArithmeticError, LookupError, TypeError, ValueError) as error:
        return Outcome(settings=dict(settings), error=f"{type(error).__name__}: {error}")
    used = {"friction": friction.model_dump(mode="json"), "detection": detection.model_dump(mode="json")}
    return Outcome(results=_results(found, channels), events=_columns(found.events), settings=used)


def _results(found: Evaluation, channels: Mapping[str, ChannelData]) -> dict[str, float | int | None]:
    main = found.main_event
    start_s, end_s = found.application_s or (None, None)
    results: dict[str, float | int | None] = {
        "mean_mu": found.mean_mu,
        "std_mu": found.std_mu,
        "leq_db": found.leq_db,
        "laeq_db": found.laeq_db,
        "lmax_db": found.lmax_db,
        "background_db": found.background_db,
        "clipped_share": found.clipped_share,
        "n_squeal": found.n_squeal,
        "squeal_frequency_hz": main.frequency_hz if main else None,
        "squeal_level_db": main.level_db if main else None,
        "application_start_s": start_s,
        "application_end_s": end_s,
    }
    for name, statistics in found.channels.items():
        suffix = _SUFFIX_BY_UNIT.get(channels[name].spec.unit, "")
        for kind, value in statistics.model_dump().items():
            results[f"{name}_{kind}{suffix}"] = value
    return results


def _columns(events: Sequence[SquealEvent]) -> dict[str, NDArray[Any]]:
    columns: dict[str, NDArray[Any]] = {}
    for item in dataclasses.fields(SquealEvent):
        values = [getattr(event, item.name) for event in events]
        if item.name == "harmonic_of":
            columns[item.name] = np.array([-1 if value is None else value for value in values], np.int64)
        else:
            columns[item.name] = np.array(
                [np.nan if value is None else value for value in values], np.float64
            )
    return columns

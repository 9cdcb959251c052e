"""The tasks of the long studies, as workers compute them: one random brake, one start, one chain.

Job: functions (task, setting) -> JSON for `rigctl.model.runner`. It imports no drawing and no statistics,
so that a worker starts quickly. NOT its job: making tasks, what becomes of their results (`scatter`,
`optimise`, `identification`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rigctl.model.runner import generator
from rigctl.model.runner_model import load_source
from sim_hardware.brake_model.design.fit import Measured, chain, fitted
from sim_hardware.brake_model.design.optimise import Bounds, improve
from sim_hardware.brake_model.design.scatter import Variable, changed, draw
from sim_hardware.brake_model.eigen.first_onset import scan


def described(variables: Sequence[Variable]) -> dict[str, list[str]]:
    """Variables for a setting: name -> members."""
    return {variable.name: list(variable.members) for variable in variables}


def sample(task: dict[str, Any], setting: dict[str, Any]) -> dict[str, Any]:
    """One random brake: onset, frequency, and at which values it is unstable ("0011…")."""
    model = load_source(setting["model"])
    chosen = _variables(setting["variables"])
    factors = draw(generator(task), len(chosen), setting["spread"], setting["law"])
    values = changed(model, chosen, factors, setting["values"])
    found = scan(model, setting["over"], np.array(setting["grid"]), values)
    return {
        "onset": found.onset,
        "frequency_hz": found.frequency_hz,
        "unstable": "".join("1" if u else "0" for u in found.unstable),
    }


def climb(task: dict[str, Any], setting: dict[str, Any]) -> dict[str, Any]:
    """One start climbs to the optimum of its valley."""
    model = load_source(setting["model"])
    bounds = [
        Bounds(variable, *setting["bounds"][variable.name]) for variable in _variables(setting["variables"])
    ]
    found = improve(model, bounds, setting["points"], np.array(task["start"]), base=setting["values"])
    return {
        "factors": found.factors.tolist(),
        "margin": found.margin,
        "evaluations": found.evaluations,
        "converged": found.converged,
        "message": found.message,
    }


def posterior_chain(task: dict[str, Any], setting: dict[str, Any]) -> dict[str, Any]:
    """Samples of the posterior by one chain."""
    model = load_source(setting["model"])
    samples, predictions = chain(
        model,
        _variables(setting["variables"]),
        Measured(**setting["measured"]),
        fitted(**setting["fit"]),
        generator(task),
        setting["length"],
        base=setting["values"],
    )
    return {"logarithms": samples.tolist(), "predictions": predictions.tolist()}


def _variables(members: Mapping[str, Sequence[str]]) -> list[Variable]:
    return [Variable(name, name, tuple(names)) for name, names in members.items()]

"""Sensitivity studies for people: eq 24 ranked, robustness (Figs 8, 9), influence with effect classes (Fig.
10).

    model = read_model(Path("configs/brakes/model.toml"))
    sensitivity_study(model, {"pressure": 15.0}, near_hz=2140)
    robustness_study(model)
    influence_study(model, ["piston"])

Job: choose, tabulate and draw what `sim_hardware.brake_model` computes. NOT its job: recommendations
(`advice`), the paper's claims (`claims`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from rigctl.analysis.style import BLUE, ORANGE
from rigctl.model import sensitivity_figures as figures
from rigctl.model.output import Study
from rigctl.model.sensitivity_tables import (
    BELOW_HZ,
    all_table,
    bands_table,
    basic_table,
    changes_table,
    effects_table,
    modifications_table,
    pairs_table,
    per_unit_table,
    ranking_table,
)
from sim_hardware.brake_model.design.effects import Influence, influence, one_of_each_pair
from sim_hardware.brake_model.design.robustness import Robustness, robustness
from sim_hardware.brake_model.design.sensitivity import (
    Sensitivities,
    eigen_sensitivities,
    parameter_names,
)
from sim_hardware.brake_model.design.variations import ASYMMETRIC, MODES, Mode, all_variations, groups_like
from sim_hardware.brake_model.eigen.eigen_systems import EigenSystem
from sim_hardware.brake_model.linear import MU, LinearModel
from sim_hardware.brake_model.parametric import LinearBrake

STEP = 0.10
_TOP = 20
_MOST_PANELS = 8

Values = Mapping[str, float]
#: frequency band in Hz for large models, None for all eigenvalues
Band = tuple[float, float] | None


def design(model: LinearModel, values: Values | None) -> tuple[LinearModel, dict[str, float]]:
    """A brake with other parameter values built into it, and the remaining values (operating values, places).

    Modifications multiply what a place of the file comes to; for a brake that depends on its parameters.
    """
    given = dict(values or {})
    if not isinstance(model, LinearBrake):
        return model, given
    own = {name: given.pop(name) for name in list(given) if name in model.brake.spec.parameters}
    changed: LinearModel = LinearBrake(model.brake.with_parameters(**own)) if own else model
    return changed, given


def sensitivity_study(
    model: LinearModel,
    values: Values | None = None,
    *,
    pair: int | None = None,
    near_hz: float | None = None,
    places: bool = False,
    band_hz: Band = None,
) -> Study:
    """Eq 24: which quantities move an eigenvalue pair, ranked by the change of its real part for 1 % more of
    each.

    Parameters
    ----------
    values : working point (mu, pressure in bar, slope) and other values that differ from the file's
    pair : number of the pair by frequency, from 1; or
    near_hz : the pair nearest to a frequency; without both the pair nearest to instability (largest real
        part)
    places : also every place of an expression ("piston_l.stiffness_y"), not only the file's parameters

    Raises
    ------
    ValueError
        no such pair
    KeyError, numpy.linalg.LinAlgError
        unknown quantity, singular M
    """
    model, values = design(model, values)
    found = eigen_sensitivities(model, parameter_names(model, places=places), values, band_hz=band_hz)
    system = found.system
    kept = one_of_each_pair(system.values)
    number = _choose(system, kept, pair, near_hz)
    i = int(kept[number])
    change = found.per_percent[:, i]
    order = np.argsort(-np.abs(change.real), kind="stable")
    reason = system.reasons[i]
    facts: dict[str, Any] = {
        "pair": number + 1,
        "frequency_hz": float(system.frequencies_hz[i]),
        "real_part_1_s": float(system.values[i].real),
        "condition": float(system.condition[i]),
        "gap_to_next_hz": float(system.gap[i]) / 2.0 / np.pi,
        "no_number_because": reason or None,
        "pairs_without_numbers": int(sum(bool(system.reasons[j]) for j in kept)),
    }
    if not reason:
        facts["strongest"] = found.names[order[0]]
    shown = [int(k) for k in order[:_TOP]]
    title = (
        f"{model.name}: what moves pair {number + 1} ({system.frequencies_hz[i]:.1f} Hz), 1 % more of each"
    )
    tables = (
        ranking_table(model, found, i, order),
        pairs_table(system, kept),
        per_unit_table(found, i, order),
        all_table(found, kept),
    )
    drawn = {} if reason else {"ranking": lambda: _ranking_figure(model, found, i, shown, title)}
    return Study("sensitivity", title, facts, tables, drawn)


def robustness_study(
    model: LinearModel,
    values: Values | None = None,
    *,
    low: float = 0.4,
    high: float = 0.6,
    step: float = STEP,
    below_hz: float = BELOW_HZ,
    band_hz: Band = None,
) -> Study:
    """Eq 25 for the design as it is (Fig. 8) and for all its modifications (Fig. 9).

    Raises
    ------
    KeyError, ValueError
        the model has no friction, impossible values
    """
    found = robustness_of(model, values, low, high, step, band_hz)
    positions = positions_of(found)
    drawn = {"basic": lambda: figures.robustness_figure(found, below_hz)}
    if positions:
        drawn["positions"] = lambda: figures.positions_figure(found, positions, below_hz)
    if found.variations:
        strongest = [int(i) for i in np.argsort(-np.abs(found.deviations), kind="stable")[:_TOP]]
        drawn["strongest"] = lambda: _strongest_figure(found, strongest)
    return Study(
        "robustness",
        f"{model.name}: robustness against {found.quantity} {low:g} → {high:g} (eq 25)",
        robustness_facts(found, below_hz),
        (basic_table(found), modifications_table(found, below_hz)),
        drawn,
    )


def influence_study(
    model: LinearModel,
    groups: Sequence[str] = (),
    values: Values | None = None,
    *,
    modes: Sequence[Mode] = MODES,
    mu: float | None = 0.4,
    step: float = STEP,
    band_hz: Band = None,
) -> Study:
    """Change of all real parts by modifications of some groups (all where none is named), with effect
    classes.

    Parameters
    ----------
    groups : names, or beginnings: "piston" means all groups of the piston
    mu : coefficient of friction; None for the model's own

    Raises
    ------
    KeyError
        no such group; the message lists them
    """
    model, values = design(model, values)
    names = [g.name for prefix in groups for g in groups_like(model, prefix)] or [
        g.name for g in model.groups
    ]
    chosen = all_variations(model, step, groups=dict.fromkeys(names), modes=modes)
    found = influence(model, chosen, values, mu=mu if MU in model.quantities else None, band_hz=band_hz)
    largest = np.abs(found.changes).max(axis=1, initial=0.0)
    panels = sorted(np.argsort(-largest, kind="stable")[:_MOST_PANELS].tolist())
    title = f"{model.name}: change of real parts by {100.0 * step:g} % changes" + (
        "" if mu is None else f", μ = {mu:g}"
    )
    facts = {
        "modifications": len(chosen),
        "mu": mu,
        "step_percent": 100.0 * step,
        "classes": _class_counts(found),
        "modes_of_uncertain_identity": int((~found.resolved.sure).sum()),
    }
    drawn = {"bars": lambda: figures.influence_figure(found, panels, title)} if panels else {}
    return Study(
        "influence", title, facts, (effects_table(found), bands_table(found), changes_table(found)), drawn
    )


def robustness_facts(found: Robustness, below_hz: float) -> dict[str, Any]:
    below = found.frequencies_hz < below_hz
    kept = one_of_each_pair(found.resolved.nominal[0])
    worst = int(found.basic.argmax())
    low = int(np.where(below, found.basic, -np.inf).argmax()) if below.any() else None
    return {
        "modifications": len(found.variations),
        "maximum_basic_design_1_s": found.reference,
        "maximum_at_hz": float(found.frequencies_hz[worst]),
        f"maximum_below_{below_hz / 1e3:g}_khz_1_s": None if low is None else float(found.basic[low]),
        f"maximum_below_{below_hz / 1e3:g}_khz_at_hz": None
        if low is None
        else float(found.frequencies_hz[low]),
        "pairs_that_lose_damping": int(found.loses_damping[kept].sum()),
        "pairs": int(kept.size),
        "sum_of_all_values_1_s": float(found.basic.sum()),
        "modes_of_uncertain_identity": int(
            (~found.resolved.sure).sum() + (~found.resolved.nominal_sure).sum()
        ),
        "remark": (
            "The values sum to zero where damping of the contacts is even along the disc: "
            "what one mode gains another loses, so only the maximum tells designs apart."
        ),
    }


def positions_of(found: Robustness) -> list[int]:
    """Modifications of Fig. 9: each group of connecting points further apart, and shifted to its worse
    side.
    """
    chosen: list[int] = []
    groups = dict.fromkeys(v.group for v in found.variations if v.kind == "geometry" and v.mode in ASYMMETRIC)
    for group in groups:
        mine = [i for i, v in enumerate(found.variations) if v.group == group]
        chosen += [i for i in mine if found.variations[i].mode == "increase"]
        shifted = [i for i in mine if not found.variations[i].symmetric]
        chosen.append(max(shifted, key=lambda i: found.maxima[i]))
    return chosen


def robustness_of(
    model: LinearModel, values: Values | None, low: float, high: float, step: float, band_hz: Band = None
) -> Robustness:
    model, values = design(model, values)
    if MU not in model.quantities:
        raise ValueError(
            f"the model '{model.name}' has no friction (quantity 'mu'): give parts that scale with it"
        )
    return robustness(model, all_variations(model, step), values, low=low, high=high, band_hz=band_hz)


def _choose(system: EigenSystem, kept: Any, pair: int | None, near_hz: float | None) -> int:
    """Place of the wanted pair in `kept`."""
    if pair is not None and near_hz is not None:
        raise ValueError("give the number of a pair or a frequency, not both")
    if pair is not None:
        if not 1 <= pair <= len(kept):
            raise ValueError(f"pair {pair}: the model has pairs 1 to {len(kept)}")
        return pair - 1
    if near_hz is not None:
        if not near_hz >= 0.0:
            raise ValueError(f"near {near_hz:g} Hz: give a frequency that is not negative")
        return int(np.argmin(np.abs(system.frequencies_hz[kept] - near_hz)))
    return int(np.argmax(system.values[kept].real))


def _class_counts(found: Influence) -> dict[str, int]:
    names = [name for effect in found.effects for name in effect.classes]
    return {name: names.count(name) for name in dict.fromkeys(names)}


def _ranking_figure(
    model: LinearModel, found: Sensitivities, i: int, shown: Sequence[int], title: str
) -> Any:
    kinds = [model.quantities[found.names[k]].kind for k in shown]
    legend = [(kind, colour) for kind, colour in figures.KIND_COLOURS.items() if kind in kinds]
    change = found.per_percent[list(shown), i]
    return figures.ranking_figure(
        title,
        [found.names[k] for k in shown],
        (
            (change.real, "change of real part  [1/s per %]"),
            (change.imag / 2.0 / np.pi, "of frequency  [Hz per %]"),
        ),
        [figures.KIND_COLOURS[kind] for kind in kinds],
        legend,
    )


def _strongest_figure(found: Robustness, shown: Sequence[int]) -> Any:
    title = f"Modifications that change robustness most (basic design {found.reference:.3g} 1/s)"
    return figures.ranking_figure(
        title,
        [found.variations[i].title for i in shown],
        ((found.deviations[list(shown)], "max S minus that of the basic design  [1/s]"),),
        [BLUE if found.variations[i].symmetric else ORANGE for i in shown],
        (("symmetric", BLUE), ("asymmetric", ORANGE)),
    )

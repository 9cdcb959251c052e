"""Recommendations in an engineer's words: which design changes quieten a brake, how much, at what price.

    recommendation_study(read_model(Path("configs/brakes/model.toml")))

Job: the ranked table, its sentences, its figure. NOT its job: measures and verdicts
(`sim_hardware.brake_model.design.recommending`, where the rule stands).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from rigctl.analysis.style import BLUE, GREEN, GREY, ORANGE, VERMILION
from rigctl.model.output import Study, Table
from rigctl.model.sensitivity import STEP, Band, design
from rigctl.model.sensitivity_figures import ranking_figure
from rigctl.model.sensitivity_tables import column
from sim_hardware.brake_model.design.recommending import (
    VERDICTS,
    RecommendationRule,
    Recommendations,
    Verdict,
    recommend,
)
from sim_hardware.brake_model.design.variations import all_variations, groups_like
from sim_hardware.brake_model.linear import MU, LinearModel

MUS = (0.3, 0.4, 0.5, 0.6)
_TOP = 20
_COLOURS: dict[Verdict, str] = dict(zip(VERDICTS, (GREEN, ORANGE, GREY, VERMILION), strict=True))


def recommendation_study(
    model: LinearModel,
    values: Mapping[str, float] | None = None,
    *,
    groups: Sequence[str] = (),
    mus: Sequence[float] = MUS,
    step: float = STEP,
    below_hz: float = 5000.0,
    pressure_max_bar: float = 60.0,
    band_hz: Band = None,
) -> Study:
    """Rank all modifications by how much they lower the real parts below a frequency without harm elsewhere.

    Parameters
    ----------
    groups : names or beginnings of groups; all where empty
    mus : coefficients of friction at which a modification has to help
    step : share by which group members change
    below_hz : squeal range that counts
    pressure_max_bar : the onset of squeal is searched up to here, where friction falls with speed
    band_hz : only the eigenvalues of a frequency band, and no onset (large models)

    Raises
    ------
    KeyError, ValueError
        no such group, the model has no groups, impossible values
    """
    model, values = design(model, values)
    names = [g.name for prefix in groups for g in groups_like(model, prefix)] or [
        g.name for g in model.groups
    ]
    if not names:
        raise ValueError(
            f"the model '{model.name}' has no parameter groups: name some in its file ([[groups]])"
        )
    rule = RecommendationRule(below_hz=below_hz)
    variations = all_variations(model, step, groups=dict.fromkeys(names))
    points = tuple(mus) if MU in model.quantities else ()
    found = recommend(
        model, variations, values, mus=points, pressure_max_bar=pressure_max_bar, rule=rule, band_hz=band_hz
    )
    verdicts = {verdict: found.verdicts.count(verdict) for verdict in VERDICTS}
    onset = found.onset
    facts: dict[str, Any] = {
        "modifications": len(variations),
        **{verdict.replace(" ", "_"): count for verdict, count in verdicts.items()},
        "friction": ", ".join(f"{mu:g}" for mu in found.mus) or None,
        "onset_bar": None if onset is None else float(onset.values[0]),
        "onset_hz": None if onset is None else float(onset.frequencies_hz[0]),
        "best": sentence(found, int(found.order[0])),
        "rule": (
            f"gain: the sum of real parts below {below_hz / 1e3:g} kHz falls at every friction by more than "
            f"{100 * rule.least_gain:g} % of their mean; harm: a real part rises by more than "
            f"{100 * rule.harm:g} % of itself; onset: moves by more than {100 * rule.onset:g} %"
        ),
    }
    title = f"{model.name}: what quietens it, {100 * step:g} % changes of each group"
    return Study(
        "recommend", title, facts, (_table(found), _words(found)), {"ranking": lambda: _figure(found, title)}
    )


def sentence(found: Recommendations, i: int) -> str:
    """What modification `i` does, in words."""
    gain, harm, rule = float(found.gains[i]), float(found.harm[i]), found.rule
    where = f"the real parts below {rule.below_hz / 1e3:g} kHz"
    friction = (
        f" at every friction from {min(found.mus):g} to {max(found.mus):g}" if len(found.mus) > 1 else ""
    )
    if gain > found.least_gain_1_s:
        words = [f"lowers {where} by {gain:.3g} 1/s in all{friction}"]
    elif gain < -found.least_gain_1_s:
        words = [f"raises {where} by up to {-gain:.3g} 1/s in all"]
    else:
        words = [f"hardly changes {where}"]
    if harm <= 1e-4:
        words.append("makes no mode worse")
    else:
        frequency = found.resolved.frequencies_hz[found.harmed[i]]
        words.append(f"raises that of the mode at {frequency:.0f} Hz by {100.0 * harm:.2g} %")
    change = found.onset_changes[i]
    if found.onset is not None and np.isfinite(change):
        start, end = found.onset.values[0], found.onset.values[i + 1]
        moves = (
            "leaves the onset at"
            if abs(change) <= rule.onset * start
            else f"moves the onset from {start:.2f} to"
        )
        words.append(f"{moves} {end:.2f} bar")
    elif found.onset is not None:
        words.append("stays stable over the whole range of pressure")
    return f"{found.variations[i].title}: {'; '.join(words)}"


def _table(found: Recommendations) -> Table:
    order = found.order
    harmed = found.resolved.frequencies_hz[found.harmed]
    return Table(
        "ranking",
        "Modifications, best first",
        (
            column("modification", "", [found.variations[i].title for i in order]),
            column("verdict", "", [found.verdicts[i] for i in order]),
            column("gain", "1/s", found.gains[order]),
            column("worst_rise", "%", 100.0 * found.harm[order]),
            column("of_mode_at", "Hz", [harmed[i] if found.harm[i] > 0.0 else None for i in order]),
            column("onset_change", "bar", found.onset_changes[order]),
            column("identity_sure", "", found.sure[order]),
        ),
    )


def _words(found: Recommendations) -> Table:
    helpful = [int(i) for i in found.order if found.verdicts[i] in VERDICTS[:2]]
    return Table(
        "in_words",
        "What helps, in words",
        (
            column("verdict", "", [found.verdicts[i] for i in helpful]),
            column("modification", "", [sentence(found, i) for i in helpful]),
        ),
    )


def _figure(found: Recommendations, title: str) -> Figure:
    shown = [int(i) for i in found.order[:_TOP]]
    panels = [(found.gains[shown], f"fall of real parts below {found.rule.below_hz / 1e3:g} kHz  [1/s]")]
    if found.onset is not None:
        panels.append((found.onset_changes[shown], "change of onset  [bar]"))
    used: list[Verdict] = [
        verdict for verdict in VERDICTS if any(found.verdicts[i] == verdict for i in shown)
    ]
    return ranking_figure(
        title,
        [found.variations[i].title for i in shown],
        panels,
        [_COLOURS.get(found.verdicts[i], BLUE) for i in shown],
        [(verdict, _COLOURS[verdict]) for verdict in used],
    )

"""Figs 8, 9, 10 of the paper from our model, the paper's printed numbers beside ours.

NOT its job: drawing (`sensitivity_figures`), the claims that the paper draws from them (`claims`).
"""

from __future__ import annotations

import numpy as np

from rigctl.model import sensitivity_figures as figures
from rigctl.model.beside_paper import Comparison, paper_table
from rigctl.model.output import Study
from rigctl.model.sensitivity import STEP, positions_of, robustness_facts, robustness_of
from rigctl.model.sensitivity_tables import (
    BELOW_HZ,
    bands_table,
    basic_table,
    changes_table,
    effects_table,
    modifications_table,
)
from sim_hardware.brake_model.design.effects import influence
from sim_hardware.brake_model.design.variations import Mode, all_variations
from sim_hardware.brake_model.linear import LinearModel

_TITLE = "The paper's numbers and statements and ours"


def figure_8_study(model: LinearModel) -> Study:
    """Fig. 8: eq 25 of the basic design over i = 1…28, with the paper's printed numbers beside ours."""
    found = robustness_of(model, None, 0.4, 0.6, STEP)
    pairs = bool(np.allclose(found.basic[::2], found.basic[1::2])) if found.basic.size % 2 == 0 else False
    facts = robustness_facts(found, BELOW_HZ)
    printed = (
        Comparison("coefficient of friction from", 0.4, found.low),
        Comparison("coefficient of friction to", 0.6, found.high),
        Comparison("sensitivity values", 28, int(found.basic.size)),
        Comparison("values equal in pairs", "yes", "yes" if pairs else "no", holds=pairs),
    )
    return Study(
        "figure_8",
        f"More friction costs the mode at {facts['maximum_at_hz']:.0f} Hz most ({found.reference:.3g} 1/s "
        f"per unit of friction: the reference); {facts['pairs_that_lose_damping']} of {facts['pairs']} modes "
        "lose damping",
        facts,
        (paper_table(_TITLE, printed), basic_table(found)),
        {"bars": lambda: figures.robustness_figure(found, BELOW_HZ)},
    )


def figure_9_study(model: LinearModel) -> Study:
    """Fig. 9: maximum of eq 25 for the positions of coupling elements, with the full table of
    modifications.
    """
    found = robustness_of(model, None, 0.4, 0.6, STEP)
    chosen = positions_of(found)
    facts = robustness_facts(found, BELOW_HZ) | {"modifications_shown": len(chosen)}
    largest = found.varied.max(axis=1)
    sided = [i for i in chosen if found.variations[i].mode in ("clockwise", "counter-clockwise")]
    even = [i for i in chosen if i not in sided]
    worst = max(chosen, key=lambda i: float(largest[i]))
    printed = (
        Comparison("change of grouped parameters", 10.0, 100.0 * STEP, "%"),
        Comparison("design modifications shown", 10, len(chosen)),
        Comparison("design modifications in all, more than", 100, len(found.variations)),
        Comparison(
            "asymmetric modifications have the stronger influence",
            "yes",
            f"up to {largest[sided].max():.0f} 1/s asymmetric, {largest[even].max():.0f} 1/s symmetric",
            holds=bool(largest[sided].max() > largest[even].max()),
        ),
    )
    return Study(
        "figure_9",
        f"Of the positions, most sensitive to more friction: {found.variations[worst].title} "
        f"({largest[worst]:.0f} 1/s; basic design {found.reference:.0f} 1/s)",
        facts,
        (paper_table(_TITLE, printed), modifications_table(found, BELOW_HZ)),
        {"bars": lambda: figures.positions_figure(found, chosen, BELOW_HZ)},
    )


def figure_10_study(model: LinearModel) -> Study:
    """Fig. 10: change of real parts by three modifications of the piston group, with effect classes."""
    wanted: tuple[tuple[str, Mode], ...] = (
        ("piston_stiffness", "increase"),
        ("piston_position", "clockwise"),
        ("piston_position", "increase"),
    )
    chosen = tuple(v for group, mode in wanted for v in all_variations(model, groups=[group], modes=[mode]))
    found = influence(model, chosen, mu=0.4)
    classes = ["; ".join(effect.classes) for effect in found.effects]
    paper = (
        "narrow band; mode coupling; bidirectional",
        "broad band; bidirectional",
        "monodirectional; strongest at high frequencies",
    )
    printed = [
        Comparison("change of grouped parameters", 10.0, 100.0 * STEP, "%"),
        Comparison("eigenvalues", 28, int(found.changes.shape[1])),
    ]
    printed += [
        Comparison(v.title, says, ours, holds=_classes_hold(says, ours))
        for v, says, ours in zip(chosen, paper, classes, strict=True)
    ]
    facts = {
        f"{v.group}_{v.mode}".replace("-", "_"): {
            "classes": list(e.classes),
            "sum_1_s": e.total,
            "band_hz": list(e.band_hz),
            "largest_1_s": float(row[np.abs(row).argmax()]),
            "largest_at_hz": float(found.resolved.frequencies_hz[np.abs(row).argmax()]),
        }
        for v, e, row in zip(chosen, found.effects, found.changes, strict=True)
    }
    title = "Influence of the group 'piston' on the real parts, μ = 0.4"
    return Study(
        "figure_10",
        "Group 'piston', sum of real parts: "
        + ", ".join(f"{v.title} {e.total:+.1f} 1/s" for v, e in zip(chosen, found.effects, strict=True)),
        facts,
        (paper_table(_TITLE, printed), effects_table(found), bands_table(found), changes_table(found)),
        {"bars": lambda: figures.influence_figure(found, (0, 1, 2), title)},
    )


def _classes_hold(says: str, ours: str) -> bool | str:
    """Whether the effect classes that the paper names are ours too."""
    named = [part.strip() for part in says.split(";") if not part.strip().startswith("strongest")]
    found = [name in ours for name in named]
    return True if all(found) else "in part" if any(found) else False

"""Figs 8, 9, 10 of the paper from our model, the paper's printed numbers beside ours.

NOT its job: drawing (`sensitivity_figures`), the claims that the paper draws from them (`claims`).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from rigctl.model import sensitivity_figures as figures
from rigctl.model.output import Study
from rigctl.model.sensitivity import STEP, positions_of, robustness_facts, robustness_of
from rigctl.model.sensitivity_tables import (
    BELOW_HZ,
    bands_table,
    basic_table,
    changes_table,
    effects_table,
    modifications_table,
    paper_table,
)
from sim_hardware.brake_model.design.effects import influence
from sim_hardware.brake_model.design.variations import Mode, all_variations
from sim_hardware.brake_model.linear import LinearModel


def figure_8_study(model: LinearModel) -> Study:
    """Fig. 8: eq 25 of the basic design over i = 1…28, with the paper's printed numbers beside ours."""
    found = robustness_of(model, None, 0.4, 0.6, STEP)
    pairs = bool(np.allclose(found.basic[::2], found.basic[1::2])) if found.basic.size % 2 == 0 else False
    printed = (
        ("coefficient of friction from", 0.4, found.low),
        ("coefficient of friction to", 0.6, found.high),
        ("sensitivity values", 28, found.basic.size),
        ("values equal in pairs", True, pairs),
    )
    return Study(
        "figure_8",
        "Fig. 8: sensitivity of the basic brake design to friction",
        robustness_facts(found, BELOW_HZ),
        (paper_table(printed), basic_table(found)),
        {"bars": lambda: figures.robustness_figure(found, BELOW_HZ)},
    )


def figure_9_study(model: LinearModel) -> Study:
    """Fig. 9: maximum of eq 25 for the positions of coupling elements, with the full table of
    modifications.
    """
    found = robustness_of(model, None, 0.4, 0.6, STEP)
    chosen = positions_of(found)
    facts = robustness_facts(found, BELOW_HZ) | {"modifications_shown": len(chosen)}
    printed = (
        ("change of grouped parameters, %", 10, 100.0 * STEP),
        ("design modifications shown", 10, len(chosen)),
        ("design modifications in all, more than", 100, len(found.variations)),
    )
    return Study(
        "figure_9",
        "Fig. 9: robustness with coupling elements moved, symmetric and asymmetric",
        facts,
        (paper_table(printed), modifications_table(found, BELOW_HZ)),
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
    printed: list[tuple[str, Any, Any]] = [("change of grouped parameters, %", 10, 100.0 * STEP)]
    printed += [("coefficient of friction", 0.4, 0.4), ("eigenvalues", 28, found.changes.shape[1])]
    printed += [(v.title, p, c) for v, p, c in zip(chosen, paper, classes, strict=True)]
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
        "Fig. 10: change of real parts by the group 'piston'",
        facts,
        (paper_table(printed), effects_table(found), bands_table(found), changes_table(found)),
        {"bars": lambda: figures.influence_figure(found, (0, 1, 2), title)},
    )

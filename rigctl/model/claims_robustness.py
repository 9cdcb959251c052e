"""The paper's claims on robustness against friction (4.3.3), each as a function of the evidence.

NOT its job: computing the evidence, the claims on influence (`claims_influence`).
"""

from __future__ import annotations

import numpy as np

from rigctl.model.claims_evidence import (
    ABUTMENT,
    BACKPLATE,
    INFLUENCE,
    PAD,
    Claim,
    Evidence,
    Untestable,
    Verdict,
    best_rank,
    rank_verdict,
    share_verdict,
)

SECTION = "4.3.3"


def equal_in_pairs(evidence: Evidence) -> Claim:
    """The values belong to conjugate pairs."""
    basic = evidence.robust.basic
    complex_ones = evidence.robust.resolved.nominal[0].imag != 0.0
    paired = bool(complex_ones.all() and np.allclose(basic[::2], basic[1::2], rtol=1e-9, atol=1e-9))
    return Claim(
        "pairs",
        SECTION,
        "The sensitivity values are equal in pairs: the system has conjugate complex pole pairs only.",
        "values of eq 25 of eigenvalues 2i − 1 and 2i",
        {"values": basic.size, "sum_1_s": float(basic.sum())},
        "holds" if paired else "does not hold",
        "The values sum to zero, for any stiffness: one mode gains what another loses.",
    )


def friction_raises_squeal(evidence: Evidence) -> Claim:
    """More friction, more squeal."""
    robust, kept = evidence.robust, evidence.kept
    nominal = robust.resolved.nominal[:, kept]
    damping = -nominal.real / np.abs(nominal)
    largest = float(robust.basic[kept].max())
    verdict: Verdict = "holds in part" if largest > 0.0 else "does not hold"
    if damping[1].min() < damping[0].min():
        verdict = "holds"
    return Claim(
        "friction",
        SECTION,
        "A high coefficient of friction increases the probability of squeal.",
        "some eigenvalue loses damping from mu 0.4 to 0.6; holds if the smallest damping ratio falls",
        {
            "pairs_that_lose_damping": int(robust.loses_damping[kept].sum()),
            "pairs": int(kept.size),
            "maximum_1_s": largest,
            "maximum_below_5_khz_1_s": float(robust.basic[kept][evidence.low].max(initial=-np.inf)),
            "smallest_damping_ratio_percent_at_0.4": 100.0 * float(damping[0].min()),
            "smallest_damping_ratio_percent_at_0.6": 100.0 * float(damping[1].min()),
        },
        verdict,
        "With linear viscous damping the mean never changes with mu: friction moves damping between modes.",
    )


def contact_and_backplate_lead(evidence: Evidence) -> Claim:
    """Fig. 9 by eye."""
    positions = evidence.of_kind("geometry", "position")
    weights = {g: evidence.robust_weight[g] for g in positions}
    order = sorted(weights, key=lambda g: -weights[g])
    contact, _ = best_rank(weights, [g for g in positions if g.startswith("contact")] or positions)
    mine = [g for g in positions if g.startswith(BACKPLATE)]
    if not mine or len(positions) < 3:
        raise Untestable("the file has no positions of piston or fingers to compare")
    backplate, _ = best_rank(weights, mine)
    first = max(contact, backplate) <= 2
    return Claim(
        "fig9",
        SECTION,
        "Friction contact, and contact between backplate and piston or fingers, matter for robustness (Fig. "
        "9).",
        "of the groups of positions, the contact's and the better of piston and fingers rank first and "
        "second",
        {g: weights[g] for g in order},
        "holds" if first else ("holds in part" if min(contact, backplate) == 1 else "does not hold"),
        "Numbers: largest change of the maximum of eq 25, 1/s.",
    )


def asymmetry_is_strong(evidence: Evidence) -> Claim:
    """Asymmetric modifications change the maximum more than symmetric ones."""
    deviations = np.abs(evidence.robust.deviations)
    stronger = []
    for group in _with_influence(evidence):
        mine = evidence.members(group)
        sides = [
            max(deviations[i] for i in mine if evidence.variations[i].symmetric == s) for s in (True, False)
        ]
        stronger.append(sides[1] > sides[0])
    share = float(np.mean(stronger))
    return Claim(
        "asymmetry_strong",
        SECTION,
        "Asymmetric modifications show a strong influence especially.",
        "share of groups where an asymmetric modification changes the maximum more than a symmetric one; 80 "
        "% holds",
        {"groups": len(stronger), "share_percent": 100.0 * share},
        share_verdict(share),
        f"Groups that change the maximum by less than {100 * INFLUENCE:g} % are left out.",
    )


def pad_matters(evidence: Evidence) -> Claim:
    """Pad properties."""
    return _family(
        evidence, "pad", "Pad properties are important.", PAD, "lining (contact), mass, inertia, heights"
    )


def backplate_matters(evidence: Evidence) -> Claim:
    """Piston and fingers."""
    return _family(
        evidence, "backplate", "Connections to the backplate are important.", BACKPLATE, "piston and fingers"
    )


def damping_may_harm(evidence: Evidence) -> Claim:
    """More damping, less robust."""
    groups = evidence.of_kind("damping")
    rises = {g: float(evidence.robust.deviations[evidence.index(g, "increase")]) for g in groups}
    threshold = 1e-3 * abs(evidence.robust.reference)
    worse = {g: rise for g, rise in rises.items() if rise > threshold}
    low = evidence.robust.maxima_below(5000.0)[[evidence.index(g, "increase") for g in groups]]
    basic_low = evidence.robust.basic[evidence.robust.frequencies_hz < 5000.0].max(initial=-np.inf)
    return Claim(
        "damping_harms",
        SECTION,
        "Increase of damping does not always improve robustness.",
        "some symmetric increase of damping raises the maximum of eq 25 by more than 0.1 % of it",
        {"damping_groups": len(groups), "worse_below_5_khz": int((low > basic_low * 1.001).sum()), **worse},
        "holds" if worse else "does not hold",
        "Numbers by group: rise of the maximum, 1/s.",
    )


def abutments_matter(evidence: Evidence) -> Claim:
    """Positions between pad and carrier."""
    groups = [g for g in evidence.named(*ABUTMENT) if g.endswith("position")]
    if not groups:
        raise Untestable("the file has no group of abutment positions")
    rank, best = best_rank(evidence.robust_weight, groups)
    low, _ = best_rank(evidence.robust_weight_low, groups)
    count = len(evidence.groups)
    return Claim(
        "abutments",
        SECTION,
        "Positions of connecting points between pad and carrier are important.",
        "rank of the group among all groups by change of the maximum; first quarter holds, first half in "
        "part",
        {"rank": rank, "of": count, "change_1_s": evidence.robust_weight[best], "rank_below_5_khz": low},
        rank_verdict(rank, count),
        ""
        if rank_verdict(low, count) == rank_verdict(rank, count)
        else "Through the modes above 5 kHz alone.",
    )


def asymmetry_squeals(evidence: Evidence) -> Claim:
    """Asymmetric designs are worse."""
    maxima, low = evidence.robust.maxima, evidence.robust.maxima_below(5000.0)
    with_influence = _with_influence(evidence)
    worse, worse_low, counted = {}, {}, 0
    for group in evidence.groups:
        mine = evidence.members(group)
        if all(evidence.variations[i].symmetric for i in mine):
            continue
        counted += 1
        for values, kept in ((maxima, worse), (low, worse_low)):
            sides = [
                max(values[i] for i in mine if evidence.variations[i].symmetric == s) for s in (True, False)
            ]
            kept[group] = bool(sides[1] > sides[0])
    if not counted:
        raise Untestable("the file has no groups with sides")
    share = float(np.mean([worse[g] for g in with_influence])) if with_influence else 0.0
    everywhere = float(np.mean(list(worse.values())))
    below = float(np.mean(list(worse_low.values())))
    return Claim(
        "asymmetry_squeals",
        SECTION,
        "Asymmetric design modifications are mostly more prone to squeal than symmetric ones.",
        "share of groups with influence whose worse asymmetric maximum exceeds the worse symmetric one; 80 "
        "% holds",
        {
            "groups_with_influence": len(with_influence), "share_percent": 100.0 * share,
            "groups_with_sides": counted, "share_of_these_percent": 100.0 * everywhere,
            "share_below_5_khz_percent": 100.0 * below,
        },
        share_verdict(share),
        f"Influence: the maximum changes by more than {100 * INFLUENCE:g} %.",
    )  # fmt: skip


ROBUSTNESS_CLAIMS = {
    "pairs": equal_in_pairs,
    "friction": friction_raises_squeal,
    "fig9": contact_and_backplate_lead,
    "asymmetry_strong": asymmetry_is_strong,
    "pad": pad_matters,
    "backplate": backplate_matters,
    "damping_harms": damping_may_harm,
    "abutments": abutments_matter,
    "asymmetry_squeals": asymmetry_squeals,
}


def _with_influence(evidence: Evidence) -> list[str]:
    """Groups with sides that change the maximum by more than a share of it."""
    threshold = INFLUENCE * abs(evidence.robust.reference)
    sided = [
        g for g in evidence.groups if any(not evidence.variations[i].symmetric for i in evidence.members(g))
    ]
    found = [g for g in sided if evidence.robust_weight[g] > threshold]
    if not found:
        raise Untestable("no group with sides has influence on robustness")
    return found


def _family(evidence: Evidence, key: str, text: str, family: tuple[str, ...], words: str) -> Claim:
    groups = evidence.named(*family)
    count = len(evidence.groups)
    rank, best = best_rank(evidence.robust_weight, groups)
    low, best_low = best_rank(evidence.robust_weight_low, groups)
    order = sorted(evidence.robust_weight, key=lambda g: -evidence.robust_weight[g])
    quarter = set(order[: max(1, count // 4)])
    return Claim(
        key,
        SECTION,
        text,
        f"rank of the strongest group ({words}) by change of the maximum of eq 25; first quarter of all "
        f"groups holds",
        {
            "rank": rank, "of": count, "strongest": best, "change_1_s": evidence.robust_weight[best],
            "groups_in_the_first_quarter": len(quarter & set(groups)), "quarter": len(quarter),
            "rank_below_5_khz": low, "strongest_below_5_khz": best_low,
        },
        rank_verdict(rank, count),
    )  # fmt: skip

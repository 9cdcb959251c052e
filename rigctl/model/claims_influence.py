"""The paper's claims on the influence of parameters at constant friction (4.3.4), each as a function of the
evidence.

NOT its job: computing the evidence, the claims on robustness (`claims_robustness`).
"""

from __future__ import annotations

import numpy as np

from rigctl.model.claims_evidence import NEAR_CONTACT, Claim, Evidence, Untestable, Verdict, share_verdict
from sim_hardware.brake_model.design.margins import onsets
from sim_hardware.brake_model.design.matrix_batches import matrix_batch
from sim_hardware.brake_model.design.variations import Mode, all_variations
from sim_hardware.brake_model.linear import PRESSURE, SLOPE

SECTION = "4.3.4"
#: rises below this share of a mode's real part do not count against "always"
_NOTHING = 1e-3
_REALISTIC = 0.40


def narrow_band(evidence: Evidence) -> Claim:
    """Fig. 10, first diagram."""
    effect, _ = evidence.effect("piston_stiffness", "increase")
    high = effect.band_hz[0] > float(np.median(evidence.frequencies_hz))
    verdict: Verdict = "does not hold"
    if "narrow band" in effect.classes:
        verdict = "holds" if high else "holds in part"
    return Claim(
        "narrow_band",
        SECTION,
        "Symmetric increase of the piston's stiffness affects high eigenfrequencies only (narrow band "
        "effect).",
        "80 % of the changes lie within an octave (EffectRule) above the median frequency",
        {
            "band_from_hz": effect.band_hz[0],
            "band_to_hz": effect.band_hz[1],
            "classes": "; ".join(effect.classes),
        },
        verdict,
    )


def mode_coupling(evidence: Evidence) -> Claim:
    """Fig. 10, first diagram."""
    effect, changes = evidence.effect("piston_stiffness", "increase")
    f = evidence.frequencies_hz
    pairs = {
        f"{f[a]:.0f}/{f[b]:.0f} Hz": f"{changes[a]:+.3g}/{changes[b]:+.3g} 1/s" for a, b in effect.coupled
    }
    return Claim(
        "mode_coupling",
        SECTION,
        "The same change moves adjacent eigenvalues in opposite directions (mode coupling).",
        "neighbours move against each other by at least a quarter of the largest change and half cancel "
        "(EffectRule)",
        pairs,
        "holds" if pairs else "does not hold",
        "The sum of all changes is zero for every change of stiffness, so something always moves the other "
        "way.",
    )


def broad_band(evidence: Evidence) -> Claim:
    """Fig. 10, second diagram."""
    effects = [evidence.effect("piston_position", mode)[0] for mode in ("clockwise", "counter-clockwise")]
    broad = ["broad band" in effect.classes for effect in effects]
    return Claim(
        "broad_band",
        SECTION,
        "Asymmetric displacement of the piston's points affects many real parts over a wide range (broad "
        "band effect).",
        "80 % of the changes need more than 1.5 octaves (EffectRule), for both directions",
        {
            "leading_band_hz": f"{effects[0].band_hz[0]:.0f}–{effects[0].band_hz[1]:.0f}",
            "trailing_band_hz": f"{effects[1].band_hz[0]:.0f}–{effects[1].band_hz[1]:.0f}",
        },
        "holds" if all(broad) else ("holds in part" if any(broad) else "does not hold"),
        "" if all(broad) else "Real parts over the whole range change, but most of the effect is in a band.",
    )


def directions(evidence: Evidence) -> Claim:
    """Fig. 10, all three."""
    modes = (
        ("piston_stiffness", "increase"),
        ("piston_position", "clockwise"),
        ("piston_position", "increase"),
    )
    against = [evidence.effect(group, mode)[0].against for group, mode in modes]  # type: ignore[arg-type]
    wanted = [against[0] > 0.1, against[1] > 0.1, against[2] <= 0.1]
    return Claim(
        "monodirectional",
        SECTION,
        "Stiffness and asymmetric displacement move real parts in both directions, symmetric displacement "
        "in one.",
        "share of all changes against the main direction: above 10 %, above 10 %, at most 10 %",
        {
            "stiffness_against_percent": 100.0 * against[0],
            "asymmetric_against_percent": 100.0 * against[1],
            "symmetric_against_percent": 100.0 * against[2],
        },
        "holds" if all(wanted) else ("holds in part" if wanted[2] else "does not hold"),
        "Any stiffness does: the sum of its changes is zero.",
    )


def piston_distance(evidence: Evidence) -> Claim:
    """General stabilisation by the piston's distance."""
    effect, changes = evidence.effect("piston_position", "increase")
    strongest = int(np.abs(changes).argmax())
    rises = changes > _NOTHING * np.abs(evidence.real_parts)
    upper = bool(evidence.frequencies_hz[strongest] > np.median(evidence.frequencies_hz))
    general = effect.total < 0.0 and effect.against <= 0.1
    names = ", ".join(f"{f:.0f} Hz" for f in evidence.frequencies_hz[rises])
    return Claim(
        "piston_distance",
        SECTION,
        "More distance between the piston's points stabilises in general, most at high frequencies.",
        "sum of changes negative, at most 10 % against it, strongest mode in the upper half",
        {
            "sum_1_s": effect.total,
            "sum_below_5_khz_1_s": float(changes[evidence.low].sum()),
            "strongest_1_s": float(changes[strongest]),
            "strongest_at_hz": float(evidence.frequencies_hz[strongest]),
            "modes_that_rise": int(rises.sum()),
        },
        "holds" if general and upper else ("holds in part" if effect.total < 0.0 else "does not hold"),
        f"Not every mode: {names} rise by more than 0.1 % of their real parts." if names else "",
    )


def less_noise_below_5_khz(evidence: Evidence) -> Claim:
    """The tested real brakes: more distance against less."""
    model = evidence.model
    both: tuple[Mode, Mode] = ("increase", "decrease")
    further, closer = (float(evidence.effect("piston_position", m)[1][evidence.low].sum()) for m in both)
    values = [evidence.variations[evidence.index("piston_position", m)].values(model) for m in both]
    found = onsets(model, values) if {PRESSURE, SLOPE} <= set(model.quantities) else None
    bars = [float("nan")] * 2 if found is None else [float(value) for value in found.values]
    lower, later = further < closer, not bars[0] <= bars[1]
    return Claim(
        "quieter_below_5_khz",
        SECTION,
        "The brake with more distance between its points was less noisy up to 5 kHz than that with less.",
        "piston's points: sum of real parts below 5 kHz lower, onset with falling friction not lower",
        {
            "further_apart_1_s": further,
            "closer_together_1_s": closer,
            "onset_further_apart_bar": bars[0],
            "onset_closer_together_bar": bars[1],
        },
        "holds" if lower and later else ("holds in part" if lower or later else "does not hold"),
    )


def near_contact(evidence: Evidence) -> Claim:
    """Parameters near the friction contact."""
    near = set(evidence.named(*NEAR_CONTACT))
    count = max(1, len(evidence.groups) // 4)
    first = sorted(evidence.influence_weight, key=lambda g: -evidence.influence_weight[g])[:count]
    low = sorted(evidence.influence_weight_low, key=lambda g: -evidence.influence_weight_low[g])[:count]
    share, share_low = (len(near & set(groups)) / count for groups in (first, low))
    return Claim(
        "near_contact",
        SECTION,
        "Parameters close to the friction contact play an important role.",
        "share of groups of pad, backplate and abutments in the first quarter by largest change; 80 % holds",
        {
            "share_percent": 100.0 * share,
            "share_below_5_khz_percent": 100.0 * share_low,
            "share_of_all_groups_percent": 100.0 * len(near) / len(evidence.groups),
            "first": first[0],
            "first_below_5_khz": low[0],
        },
        share_verdict(share),
        f"Below 5 kHz as strong: {', '.join(g for g in low if g not in near)}." if share_low < 0.8 else "",
    )


def damping_stabilises(evidence: Evidence) -> Claim:
    """Symmetric increase in damping."""
    groups = evidence.of_kind("damping")
    rows = evidence.changes[[evidence.index(g, "increase") for g in groups]]
    relative = rows / np.abs(evidence.real_parts)
    sums, worst = rows.sum(axis=1), float(relative.max())
    where = np.unravel_index(int(relative.argmax()), rows.shape)
    every = bool((sums < 0.0).all())
    return Claim(
        "damping",
        SECTION,
        "Symmetric increase in damping always stabilises the system.",
        "for every damping group the sum of changes is negative and no real part rises by more than 0.1 % "
        "of itself",
        {
            "damping_groups": len(groups),
            "largest_sum_1_s": float(sums.max()),
            "largest_rise_1_s": float(rows.max()),
            "largest_rise_percent": 100.0 * worst,
            "of_group": groups[int(where[0])],
            "at_hz": float(evidence.frequencies_hz[where[1]]),
        },
        "holds" if every and worst <= _NOTHING else ("holds in part" if every else "does not hold"),
        "For the sum it holds with any parameters: it is −½ tr(M⁻¹D). For single modes it is a property of "
        "the brake.",
    )


def inertia_destabilises(evidence: Evidence) -> Claim:
    """More inertia."""
    groups = evidence.of_kind("inertia")
    effects = {g: evidence.effect(g, "increase")[0] for g in groups}
    every = all(effect.total > 0.0 for effect in effects.values())
    one_way = [effect.against <= 0.1 for effect in effects.values()]
    return Claim(
        "inertia",
        SECTION,
        "Increase of inertia parameters lowers the stability.",
        "for every inertia group the sum of changes is positive and at most 10 % go against it",
        {f"{g}_1_s": effect.total for g, effect in effects.items()}
        | {"largest_against_percent": 100.0 * max(effect.against for effect in effects.values())},
        "holds" if every and all(one_way) else ("holds in part" if every else "does not hold"),
        "Real parts rise because damping per mass falls. The onset by falling friction can go the other way: "
        "see `rigctl model recommend`.",
    )


def distance_stabilises(evidence: Evidence) -> Claim:
    """More distance between two connecting points, all groups."""
    groups = evidence.of_kind("geometry", "position")
    effects = {g: evidence.effect(g, "increase")[0] for g in groups}
    every = all(effect.total < 0.0 for effect in effects.values())
    one_way = [g for g, effect in effects.items() if effect.against <= 0.1]
    return Claim(
        "distance",
        SECTION,
        "Increase of distance between two connecting points has a stabilising effect; seen in other groups "
        "too.",
        "for every group of positions the sum of changes is negative and at most 10 % go against it",
        {f"{g}_1_s": effect.total for g, effect in effects.items()}
        | {"groups": len(groups), "groups_in_one_direction": len(one_way)},
        "holds" if every and len(one_way) == len(groups) else ("holds in part" if every else "does not hold"),
        "For the sum it holds with any parameters: dampers act at longer levers. The single directions are "
        "fragile.",
    )


def cannot_be_destabilised(evidence: Evidence) -> Claim:
    """Section 5, first paragraph."""
    model = evidence.model
    wide = all_variations(model, _REALISTIC)
    if not wide:
        raise Untestable("the file has no groups")
    batch = matrix_batch(model, [{**v.values(model), "mu": 0.6} for v in wide])
    growth = np.linalg.eigvals(batch.state_matrices()).real.max(axis=1)
    nominal = float(evidence.robust.resolved.nominal[1].real.max())
    small = float(evidence.robust.resolved.varied[:, 1].real.max())
    worst = int(growth.argmax())
    stable = bool(growth.max() < 0.0)
    return Claim(
        "not_destabilised",
        "5",
        "It was not possible to destabilise the model by a parameter variation in a realistic range "
        "(friction constant).",
        "largest real part at mu = 0.6 with every group changed by 10 % and by 40 %, in all modes of "
        "variation",
        {
            "basic_1_s": nominal,
            "by_10_percent_1_s": small,
            "by_40_percent_1_s": float(growth[worst]),
            "worst": wide[worst].name,
            "unstable_of": f"{int((growth > 0.0).sum())} of {len(wide)}",
        },
        "holds" if stable else ("holds in part" if small < 0.0 else "does not hold"),
        "Single groups only. With falling friction, pressure decides (section 5.2).",
    )


INFLUENCE_CLAIMS = {
    "narrow_band": narrow_band,
    "mode_coupling": mode_coupling,
    "broad_band": broad_band,
    "monodirectional": directions,
    "piston_distance": piston_distance,
    "quieter_below_5_khz": less_noise_below_5_khz,
    "near_contact": near_contact,
    "damping": damping_stabilises,
    "inertia": inertia_destabilises,
    "distance": distance_stabilises,
    "not_destabilised": cannot_be_destabilised,
}

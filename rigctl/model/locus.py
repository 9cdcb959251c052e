"""Root locus of a model for people: which mode becomes unstable where, and with whom it couples (Figs 7, 13).

Job: the study (facts, tables, figures) of a tracked locus, and the paper's two figures with its numbers
beside ours. NOT its job: tracking (`sim_hardware.brake_model.eigen.tracking`), drawing (`locus_figures`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.model.beside_paper import Comparison, paper_table
from rigctl.model.locus_figures import Section, course_figure, parameter_label, plane_figure, value_text
from rigctl.model.output import Column, Study, Table
from sim_hardware.brake_model.eigen.tracking import Flag, Locus, Path, track
from sim_hardware.brake_model.eigen.tracking_band import track_band
from sim_hardware.brake_model.eigen.tracking_events import ModeCoupling, mode_couplings
from sim_hardware.brake_model.linear import LinearModel, ParameterGroup

#: what the paper prints: section 4.2 with Fig. 7, section 5.2 with Fig. 13
FIGURE_7 = {"coefficient_of_friction": 0.64, "frequency_hz": 2400.0}
FIGURE_13 = {"pressure_bar": 15.0, "frequency_hz": 2140.0}
FIGURE_7_RANGE = (0.47, 0.69)
FIGURE_13_RANGE_BAR = (0.0, 25.0)
FIGURE_13_SLOPE_S_M = 0.0576

_UNIT_RANGE = tuple(np.linspace(0.0, 1.0, 51).tolist())
_SHOWN = 0.05
_EVENTS = {
    "exceptional": "modes coincide with their shapes (exceptional point): beyond it identity has no meaning",
    "crossing": "modes pass each other without coupling",
    "split": "vibration ceases: two real eigenvalues",
    "merge": "two real eigenvalues begin to vibrate",
    "unresolved": "identity not resolved: too many points were needed; take a shorter range",
}


def locus_study(
    model: LinearModel,
    what: str | ParameterGroup | Mapping[str, float] | Path = "mu",
    grid: Sequence[float] | NDArray[np.float64] = _UNIT_RANGE,
    values: Mapping[str, float] | None = None,
    *,
    asymmetric: bool = False,
    band_hz: tuple[float, float] | None = None,
    name: str = "locus",
) -> Study:
    """Root locus of a model over a quantity, or over the common relative factor of a parameter group.

    Parameters
    ----------
    what, grid, values, asymmetric : see `sim_hardware.brake_model.eigen.tracking.track`
    band_hz : follow only the modes that lie in this band at the start; for large models made elsewhere
    name : stem of the files

    Returns
    -------
    facts: onset, crossings, coupling of modes; tables "crossings", "modes" (start and end of each mode),
    "coupling", "events" and "locus" (every mode at every point); figures "plane" and "course"
    """
    if band_hz is None:
        return study_of(track(model, what, grid, values, asymmetric=asymmetric), name=name)
    return study_of(track_band(model, what, grid, band_hz, values, asymmetric=asymmetric), name=name)


def study_of(locus: Locus, *, name: str = "locus", title: str = "") -> Study:
    """The study of a locus that has been tracked."""
    couplings = mode_couplings(locus)
    section = section_of(locus, couplings)
    title = title or f"{locus.model}: {_headline(locus, couplings)}"
    tables = [_crossings(locus), _modes(locus), _coupling_table(locus, couplings), _points(locus)]
    if locus.events:
        tables.insert(1, _events(locus))
    return Study(
        name,
        title,
        _facts(locus, couplings),
        tuple(tables),
        {
            "plane": partial(plane_figure, locus, section, title),
            "course": partial(course_figure, locus, section, title),
        },
    )


def figure_7_study(model: LinearModel, steps: int = 22) -> Study:
    """Fig. 7: the basic model becomes unstable by nonconservative restoring forces (section 4.2).

    mu from 0.47 to 0.69 in `steps` steps (the paper does not print their number), constant friction; the
    paper's numbers stand beside ours.
    """
    locus = track(model, "mu", np.linspace(*FIGURE_7_RANGE, steps + 1), {"slope": 0.0})
    study = study_of(locus, name="figure_7")
    onset = locus.onset
    couplings = [c for c in mode_couplings(locus) if c.coupled]
    rows: list[tuple[str, str, Any, Any]] = [
        ("coefficient of friction at onset", "1", FIGURE_7["coefficient_of_friction"], onset and onset.value),
        ("frequency of the unstable mode", "Hz", FIGURE_7["frequency_hz"], onset and onset.frequency_hz),
        ("mode coupling", "", "clearly seen", _coupled_modes(couplings)),
    ]
    return _beside_paper(study, "Fig. 7 (section 4.2)", rows)


def figure_13_study(model: LinearModel, steps: int = 25, slope_s_m: float = FIGURE_13_SLOPE_S_M) -> Study:
    """Fig. 13: the refined model becomes unstable by falling friction (section 5.2).

    Pressure from 0 to 25 bar in `steps` steps, slope k = 0.0576 s/m; the paper's numbers stand beside ours.
    """
    grid = np.linspace(*FIGURE_13_RANGE_BAR, steps + 1)
    locus = track(model, "pressure", grid, {"slope": slope_s_m})
    study = study_of(locus, name="figure_13")
    onset = locus.onset
    rows: list[tuple[str, str, Any, Any]] = [
        ("brake pressure at onset", "bar", FIGURE_13["pressure_bar"], onset and onset.value),
        ("frequency of the unstable mode", "Hz", FIGURE_13["frequency_hz"], onset and onset.frequency_hz),
    ]
    return _beside_paper(study, "Fig. 13 (section 5.2)", rows)


def _beside_paper(study: Study, figure: str, rows: list[tuple[str, str, Any, Any]]) -> Study:
    table = paper_table(
        f"The paper's numbers, {figure}, and ours",
        [Comparison(name, paper, ours, unit) for name, unit, paper, ours in rows],
    )
    beside = {
        name.replace(" ", "_"): {"unit": unit, "paper": paper, "ours": ours}
        for name, unit, paper, ours in rows
    }
    return replace(study, facts={**study.facts, "paper": beside}, tables=(table, *study.tables))


def critical_mode(locus: Locus) -> int:
    """Number of the mode that becomes unstable first, else of the one nearest to instability at the end.

    Nearest: least damping ratio, among vibrating modes where there are any.
    """
    if locus.onset is not None:
        return locus.onset.mode
    last = locus.damping_ratios[-1].copy()
    moving = np.abs(locus.eigenvalues[-1]) > 0
    usable = moving & (locus.frequencies_hz[-1] > 0) if (locus.frequencies_hz[-1] > 0).any() else moving
    return int(np.argmin(np.where(usable & np.isfinite(last), last, np.inf))) + 1


def section_of(locus: Locus, couplings: Sequence[ModeCoupling]) -> Section:
    """Choose what the figures show closely: the critical mode with the mode it couples with, else its
    neighbour.
    """
    critical = critical_mode(locus)
    partner = next((c for c in couplings if c.coupled and critical in c.modes), None)
    f, real = locus.frequencies_hz, locus.real_parts
    if partner is not None:
        shown = (critical, *(m for m in partner.modes if m != critical))
    else:
        distance = np.abs(f[-1] - f[-1, critical - 1])
        distance[critical - 1] = np.inf
        shown = (critical, int(np.nanargmin(distance)) + 1) if locus.n_modes > 1 else (critical,)
    columns = [m - 1 for m in shown]
    low, high = float(np.nanmin(f[:, columns])), float(np.nanmax(f[:, columns]))
    width = max(high - low, 0.02 * high, 1e-9)
    if high - low > 0.5 * max(high, 1.0):  # the neighbour is far away: the critical mode alone
        columns, shown = columns[:1], shown[:1]
        low, high = float(np.nanmin(f[:, columns])), float(np.nanmax(f[:, columns]))
        width = max(high - low, 0.06 * high, 1.0)
    left, right = float(np.nanmin(real[:, columns])), float(np.nanmax(real[:, columns]))
    reach = max(right, 0.0) - min(left, 0.0) or 1.0
    return Section(
        critical,
        shown,
        (max(low - 0.18 * width, 0.0) if low > 0 else -0.04 * width, high + 0.18 * width),
        (min(left, 0.0) - 0.07 * reach, max(right, 0.0) + (0.07 if right > 0 else 0.16) * reach),
    )


def _headline(locus: Locus, couplings: Sequence[ModeCoupling]) -> str:
    first, last = (value_text(locus, float(locus.grid[k])) for k in (0, -1))
    onset = locus.onset
    if onset is None:
        unstable = [m + 1 for m in range(locus.n_modes) if locus.real_parts[0, m] > 0]
        if unstable:
            return f"unstable from the start ({first}), mode {', '.join(map(str, unstable))}"
        return f"stable from {first} to {last.split(' = ')[1]}"
    how = f"{onset.frequency_hz:.0f} Hz" if onset.kind == "flutter" else "divergence, without vibration"
    text = f"mode {onset.mode} becomes unstable at {value_text(locus, onset.value)} ({how})"
    partner = next((c for c in couplings if c.coupled and onset.mode in c.modes), None)
    if partner is not None:
        other = next(m for m in partner.modes if m != onset.mode)
        text += f", coupling with mode {other}"
    return text


def _coupled_modes(couplings: Sequence[ModeCoupling]) -> str:
    texts = (f"modes {c.modes[0]} and {c.modes[1]}, strength {c.strength:.2f}" for c in couplings)
    return "; ".join(texts) or "none"


def _coupling_text(couplings: Sequence[ModeCoupling]) -> str:
    if not couplings:
        return "none"
    c = couplings[0]
    (f1, f2), (g1, g2) = c.frequencies_hz[0], c.frequencies_hz[-1]
    (r1, r2), (s1, s2) = c.real_parts_1_s[0], c.real_parts_1_s[-1]
    return (
        f"modes {c.modes[0]} and {c.modes[1]}: {f1:.1f}/{f2:.1f} Hz close up to {g1:.1f}/{g2:.1f} Hz, "
        f"real parts {r1:.0f}/{r2:.0f} part to {s1:+.0f}/{s2:+.0f} 1/s"
    )


def _facts(locus: Locus, couplings: Sequence[ModeCoupling]) -> dict[str, Any]:
    onset, critical = locus.onset, critical_mode(locus)
    facts: dict[str, Any] = {
        "varied": locus.path.title,
        "from": float(locus.grid[0]),
        "to": float(locus.grid[-1]),
        "unit": locus.path.unit,
        "points": len(locus.grid),
        "modes": locus.n_modes,
        "critical_mode": critical,
        "onset_value": None if onset is None else onset.value,
        "onset_frequency_hz": None if onset is None else onset.frequency_hz,
        "onset_kind": None if onset is None else onset.kind,
        "onset_rate_1_s_per_unit": None if onset is None else onset.rate_1_s,
        "largest_real_part_at_end_1_s": float(np.nanmax(locus.real_parts[-1])),
        "unstable_modes_at_end": [int(m) + 1 for m in np.flatnonzero(locus.real_parts[-1] > 0)],
        "points_added_for_identity": len(locus.fine_grid) - len(locus.grid),
    }
    strong = [c for c in couplings if c.coupled]
    facts["mode_coupling"] = _coupling_text(strong)
    if strong:
        c = strong[0]
        facts |= {
            "coupled_modes": list(c.modes),
            "coupling_strength": c.strength,
            "coupling_would_be_exact_at": c.exceptional_value,
            "coupling_distance": c.distance,
        }
    lost = np.flatnonzero(((locus.flags & Flag.LOST) > 0).any(axis=0))
    if lost.size:
        facts["modes_that_left_the_band"] = [int(m) + 1 for m in lost]
    if locus.events:
        facts["identity"] = "; ".join(dict.fromkeys(_EVENTS[event.kind] for event in locus.events))
    return facts


def _crossings(locus: Locus) -> Table:
    rows = locus.crossings
    return Table(
        "crossings",
        "Where modes cross the stability boundary",
        (
            Column(_key(locus), _unit(locus), [c.value for c in rows]),
            Column("mode", "", [c.mode for c in rows]),
            Column("frequency", "Hz", [c.frequency_hz for c in rows]),
            Column("kind", "", [c.kind for c in rows]),
            Column("becomes", "", ["unstable" if c.destabilising else "stable" for c in rows]),
            Column("rate_of_real_part", "1/s per unit", [c.rate_1_s for c in rows]),
        ),
    )


def _events(locus: Locus) -> Table:
    rows = locus.events
    return Table(
        "events",
        "What concerns the identity of modes",
        (
            Column(_key(locus), _unit(locus), [e.value for e in rows]),
            Column("modes", "", [", ".join(map(str, e.modes)) for e in rows]),
            Column("kind", "", [e.kind for e in rows]),
            Column("frequency", "Hz", [abs(e.eigenvalue.imag) / (2.0 * np.pi) for e in rows]),
            Column("meaning", "", [_EVENTS[e.kind] for e in rows]),
        ),
    )


def _modes(locus: Locus) -> Table:
    f, r, d = locus.frequencies_hz, locus.real_parts, locus.damping_ratios
    first, last = (value_text(locus, float(locus.grid[k])) for k in (0, -1))
    return Table(
        "modes",
        f"Modes at the start ({first}) and at the end ({last})",
        (
            Column("mode", "", list(range(1, locus.n_modes + 1))),
            Column("frequency_start", "Hz", f[0].tolist()),
            Column("frequency_end", "Hz", f[-1].tolist()),
            Column("real_part_start", "1/s", r[0].tolist()),
            Column("real_part_end", "1/s", r[-1].tolist()),
            Column("real_part_max", "1/s", np.nanmax(r, axis=0).tolist()),
            Column("damping_start", "%", (100.0 * d[0]).tolist()),
            Column("damping_end", "%", (100.0 * d[-1]).tolist()),
        ),
    )


def _coupling_table(locus: Locus, couplings: Sequence[ModeCoupling]) -> Table:
    rows = [c for c in couplings if c.strength >= _SHOWN][:10]
    gaps = [[abs(high - low) for low, high in (c.frequencies_hz[0], c.frequencies_hz[-1])] for c in rows]
    real = [["{:+.0f} / {:+.0f}".format(*pair) for pair in c.real_parts_1_s] for c in rows]
    return Table(
        "coupling",
        "Mode coupling: frequencies close up while real parts part (strength from 0.3 on deserves the name)",
        (
            Column("modes", "", [f"{c.modes[0]} – {c.modes[1]}" for c in rows]),
            Column("strength", "", [c.strength for c in rows]),
            Column("gap_at_start", "Hz", [gap[0] for gap in gaps]),
            Column("least_gap", "Hz", [c.nearest_gap_hz for c in rows]),
            Column(f"least_gap_at_{_key(locus)}", _unit(locus), [c.nearest_value for c in rows]),
            Column("gap_at_end", "Hz", [gap[1] for gap in gaps]),
            Column("real_parts_at_start", "1/s", [texts[0] for texts in real]),
            Column("real_parts_at_end", "1/s", [texts[-1] for texts in real]),
        ),
    )


def _points(locus: Locus) -> Table:
    g, m = locus.eigenvalues.shape
    flags = [_flag_text(int(flag)) for flag in locus.flags.ravel()]
    return Table(
        "locus",
        f"Every mode at every point of {parameter_label(locus)}",
        (
            Column(_key(locus), _unit(locus), np.repeat(locus.grid, m).tolist()),
            Column("mode", "", list(range(1, m + 1)) * g),
            Column("frequency", "Hz", locus.frequencies_hz.ravel().tolist()),
            Column("real_part", "1/s", locus.real_parts.ravel().tolist()),
            Column("damping_ratio", "", locus.damping_ratios.ravel().tolist()),
            Column("second_real_part", "1/s", _second(locus)),
            Column("flags", "", flags),
        ),
    )


def _second(locus: Locus) -> list[float | None]:
    real = (locus.flags & Flag.REAL) > 0
    second = locus.partners.real.ravel().tolist()
    return [value if is_real else None for value, is_real in zip(second, real.ravel(), strict=True)]


def _flag_text(flag: int) -> str:
    return " ".join(str(f.name).lower() for f in Flag if flag & f)


def _key(locus: Locus) -> str:
    return locus.path.name if locus.path.absolute else "factor"


def _unit(locus: Locus) -> str:
    return "" if locus.path.unit == "1" else locus.path.unit

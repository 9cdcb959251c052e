"""Studies of the minimal models (Table 1, Fig. 1): belt oscillator, sprag-slip, 2-DOF model, published cases.

Job: build `Study` objects (facts, tables, figures) from `sim_hardware.brake_model.minimal`, with the paper's
statements beside ours; the belt's is in `minimal_belt`. NOT its job: mechanics (there), drawing
(`figures_minimal`), command line.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.model import figures_minimal as figures
from rigctl.model.beside_paper import Statement, statement_table
from rigctl.model.minimal_belt import BELT, COULOMB, EXPONENTIAL, FALLING, belt_study, figure_1a_study
from rigctl.model.output import Column, Study, Table
from sim_hardware.brake_model.minimal.cases import BeltCase, TwoDofCase, check_case
from sim_hardware.brake_model.minimal.hurwitz import (
    Boundary,
    Crossing,
    first_instability,
    hurwitz_boundaries,
    root_locus,
)
from sim_hardware.brake_model.minimal.sprag import SpragModel, needed_disc_damping, smallest_critical_mu
from sim_hardware.brake_model.minimal.two_dof import TwoDofModel

__all__ = [
    "BELT",
    "COULOMB",
    "EXPONENTIAL",
    "FALLING",
    "PAD",
    "SPRAG",
    "belt_study",
    "cases_study",
    "figure_1a_study",
    "figure_1b_study",
    "sprag_study",
    "two_dof_study",
]

Array = NDArray[np.float64]

SPRAG = SpragModel(
    mass_kg=1.0,
    angle_rad=math.radians(15.0),
    disc_damping_ns_m=1000.0,
    pad_damping_ns_m=20.0,
    pad_stiffness_n_m=1.8e8,
)
PAD = TwoDofModel(mass=0.4, inertia=4.7e-4, d1=60.0, d2=0.07, c1=3.4e7, c2=1.12e5, c3=5e7, s=0.005, h=0.0165)
"""Sizes of a brake pad: modes at 2260 and 2513 Hz that mu brings together."""


# --------------------------------------------------------------------------------------------- sprag


def sprag_study(
    model: SpragModel = SPRAG,
    *,
    mu_max: float = 1.5,
    ratios: Sequence[float] = (0.0, 0.05, 0.1),
    points: int = 241,
) -> Study:
    """Geometric instability: the criterion of Table 1 over the angle, both signs, and which dampers it needs.

    Parameters
    ----------
    model : strut model; its angle is marked
    mu_max : largest coefficient of friction drawn, both directions of rotation
    ratios : d2 / d1 compared with the model's own
    points : angles between -80° and 80°

    Raises
    ------
    ValueError
        mu_max not above 0, too few points, no damper at the disc
    """
    if not (0.0 < mu_max < math.inf and points >= 3):
        raise ValueError(f"mu_max = {mu_max:g}, points = {points}: give mu_max above 0 and at least 3 points")
    if model.disc_damping_ns_m == 0.0:
        raise ValueError("disc damping d1 = 0: no friction makes it unstable. Give a damping above 0")
    own = model.pad_damping_ns_m / model.disc_damping_ns_m
    angles = np.linspace(-80.0, 80.0, points)
    table, worst = _sprag_table(model, angles)
    least, angle = smallest_critical_mu(own)
    mus = np.array([0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1.0])
    needed = np.array([needed_disc_damping(float(mu)) for mu in mus])
    facts = {
        "damping_ratio_d2_d1": own,
        "angle_deg": math.degrees(model.angle_rad),
        "critical_mu_at_that_angle": model.critical_mu,
        "smallest_critical_mu_of_any_angle": least,
        "at_angle_deg": math.degrees(angle),
        "d1_over_d2_needed_at_mu_0.4": needed_disc_damping(0.4),
        "d1_over_d2_needed_at_mu_0.6": needed_disc_damping(0.6),
        "smallest_critical_mu_for_equal_dampers": smallest_critical_mu(1.0)[0],
        "largest_damping_ratio_error_on_the_boundary": worst,
        "verdict": "As the paper says: only with d1 >> d2. "
        f"mu = 0.4 needs d1 > {needed_disc_damping(0.4):.1f} d2 at its best angle; equal dampers need "
        f"mu > {smallest_critical_mu(1.0)[0]:.2f}. A negative angle is unstable "
        "only when the disc turns back.",
    }
    return Study(
        name="sprag",
        title="Geometric instability (Spurr, Crisp): criterion over the angle (section 1.2)",
        facts=facts,
        tables=(
            table,
            statement_table(_sprag_statements(model), "1.2"),
            Table(
                "needed",
                "Disc damper needed for instability at the best angle",
                (Column("mu", "", mus.tolist()), Column("d1 / d2", "", needed.tolist())),
            ),
        ),
        figures={
            "criterion": partial(
                figures.sprag_criterion, model, tuple(sorted({*map(float, ratios), own})), mu_max
            )
        },
    )


def _sprag_statements(model: SpragModel) -> list[Statement]:
    mirrored = model.model_copy(update={"angle_rad": -abs(model.angle_rad)})
    return [
        (
            "negative angle",
            "the relation is inverted",
            f"unstable below mu = {mirrored.critical_mu:.4g}: never while the disc turns forward",
            not mirrored.unstable(10.0) and mirrored.unstable(1.001 * mirrored.critical_mu - 1e-9),
        ),
        (
            "dampers for a realistic boundary",
            "d1 should be bigger than d2",
            f"mu = 0.4 needs d1 / d2 > {needed_disc_damping(0.4):.1f}, "
            f"mu = 0.6 {needed_disc_damping(0.6):.1f}",
            needed_disc_damping(0.6) > 1.0,
        ),
    ]


def _sprag_table(model: SpragModel, angles_deg: Array) -> tuple[Table, float]:
    """Criterion over the angle, and the largest damping ratio of the eigenvalues on it (0 if they agree)."""
    critical: list[float] = []
    smaller_unstable: list[str] = []
    worst = 0.0
    for degrees in angles_deg:
        at = model.model_copy(update={"angle_rad": math.radians(float(degrees))})
        mu = at.critical_mu
        critical.append(mu)
        if math.isfinite(mu):
            eigenvalue = at.eigenvalues(mu)[0]
            worst = max(worst, abs(eigenvalue.real) / max(abs(eigenvalue), 1e-300))
        smaller_unstable.append("mu above it" if degrees > 0 else "mu below it" if degrees < 0 else "never")
    return Table(
        "criterion",
        "tan(gamma) + 2 d2 / (sin(2 gamma) d1)",
        (
            Column("angle", "deg", angles_deg.tolist()),
            Column("critical mu", "", critical),
            Column("unstable for", "", smaller_unstable),
        ),
    ), worst


# ------------------------------------------------------------------------------------------- two-dof


def two_dof_study(
    model: TwoDofModel | TwoDofCase = PAD, *, mu_max: float = 0.8, points: int = 801, name: str = "two_dof"
) -> Study:
    """Mode coupling: root locus over mu (Fig. 1b) and Hurwitz's five boundaries, each named.

    Parameters
    ----------
    model : eq 1, or any 2-DOF case of the literature
    mu_max, points : range from 0 of the locus, and its resolution

    Raises
    ------
    ValueError
        mu_max not above 0, or too few points
    """
    if not (0.0 < mu_max < math.inf and points >= 3):
        raise ValueError(f"mu_max = {mu_max:g}, points = {points}: give mu_max above 0 and at least 3 points")
    system = model.system
    mus = np.linspace(0.0, mu_max, points)
    locus = root_locus(system, mus)
    upper = locus[:, locus[0].imag >= 0.0]
    boundaries = hurwitz_boundaries(system)
    first = _first(model)
    frequencies = np.abs(upper.imag) / (2.0 * math.pi)
    gap = frequencies.max(axis=1) - frequencies.min(axis=1)
    facts: dict[str, Any] = {
        "model": model.name,
        "frequencies_at_mu_0_hz": [float(f) for f in np.sort(frequencies[0])],
        "first_instability": first[0] if first else "none",
        "critical_mu": first[1].mu if first else None,
        "critical_frequency_hz": first[1].frequency_hz if first else None,
        "undamped_coupling_mu": next((c.mu for c in boundaries[5].crossings if c.mu > 0), None),
        "divergence_mu": next((c.mu for c in boundaries[0].crossings if c.mu > 0), None),
        "frequency_gap_at_mu_0_hz": float(gap[0]),
        "smallest_frequency_gap_hz": float(gap.min()),
        "at_mu": float(mus[int(np.argmin(gap))]),
        "real_parts_at_mu_max_1_s": [float(r) for r in np.sort(upper[-1].real)],
    }
    if isinstance(model, TwoDofModel):
        facts["printed_expression_of_table_1"] = model.divergence_mu
    facts["verdict"] = _two_dof_verdict(first, facts)
    return Study(
        name=name,
        title="Nonconservative restoring forces: mode coupling over mu (section 1.3, Fig. 1b)",
        facts=facts,
        tables=(
            _boundaries_table(boundaries),
            statement_table(_two_dof_statements(model, facts, first), "1.3"),
            _locus_table(mus, upper),
        ),
        figures={"root_locus": partial(figures.two_dof_locus, mus, upper, first)},
    )


def figure_1b_study() -> Study:
    """Fig. 1b of the paper with our default numbers."""
    return two_dof_study(name="figure_1b")


def _first(model: TwoDofModel | TwoDofCase) -> tuple[str, Crossing] | None:
    return first_instability(model.system)


def _two_dof_verdict(first: tuple[str, Crossing] | None, facts: dict[str, Any]) -> str:
    if first is None:
        return "Stable at every mu above 0."
    kind, crossing = first
    text = f"Unstable from mu = {crossing.mu:.4g} by {kind}"
    text += f" at {crossing.frequency_hz:.5g} Hz." if crossing.frequency_hz else "."
    divergence = facts["divergence_mu"]
    if kind == "flutter" and divergence is not None:
        text += (
            f" The expression that Table 1 prints is divergence, det C < 0: mu = {divergence:.4g}, "
            f"{divergence / crossing.mu:.3g} times as much; squeal begins at flutter."
        )
    return text


def _two_dof_statements(
    model: TwoDofModel | TwoDofCase, facts: dict[str, Any], first: tuple[str, Crossing] | None
) -> list[Statement]:
    """Statements of section 1.3; those on eq 1 for eq 1 only."""
    gap, least = facts["frequency_gap_at_mu_0_hz"], facts["smallest_frequency_gap_hz"]
    real = facts["real_parts_at_mu_max_1_s"]
    reals = " and ".join(f"{r:.0f}" for r in real)
    rows: list[Statement] = [
        (
            "frequencies with growing mu",
            "grow closer",
            f"apart by {gap:.1f} Hz, then {least:.2g} Hz",
            least < gap,
        ),
        (
            "real parts after that",
            "move in opposite directions, instability",
            f"{reals} 1/s at the end",
            real[0] < 0.0 < real[-1],
        ),
    ]
    if isinstance(model, TwoDofModel):
        boundaries = hurwitz_boundaries(model.system)
        expressions = [b.name for b in boundaries if b.role != "reference" and len(b.polynomial) > 1]
        rows.append(("Hurwitz expressions in mu", "5", f"{len(expressions)}: {', '.join(expressions)}", True))
        kind = f"{first[0]} at mu = {first[1].mu:.4g}" if first else "nothing at any mu"
        rows.append(
            (
                "the expression printed in Table 1",
                "instability",
                f"det C < 0, divergence at mu = {model.divergence_mu:.4g}; first comes {kind}",
                first is not None and first[0] == "divergence",
            )
        )
        undamped = facts["undamped_coupling_mu"]
        if undamped is not None and first is not None:
            rows.append(
                (
                    "the mechanism needs certain damping",
                    "no",
                    f"undamped from mu = {undamped:.4g}, with these dampers {first[1].mu:.4g}",
                    True,
                )
            )
    return rows


def _boundaries_table(boundaries: Sequence[Boundary]) -> Table:
    rows = []
    for boundary in boundaries:
        crossings: Sequence[Crossing | None] = boundary.crossings or (None,)
        rows += [(boundary, crossing) for crossing in crossings]
    return Table(
        "boundaries",
        "Hurwitz's expressions as boundaries of mu",
        (
            Column("expression", "", [b.name for b, _ in rows]),
            Column("condition", "", [b.formula for b, _ in rows]),
            Column("role", "", [b.role for b, _ in rows]),
            Column("mu", "", [c.mu if c else None for _, c in rows]),
            Column("frequency", "Hz", [c.frequency_hz if c else None for _, c in rows]),
            Column("border of stability", "", [bool(c and c.is_stability_boundary) for _, c in rows]),
            Column("meaning", "", [b.meaning for b, _ in rows]),
        ),
    )


def _locus_table(mus: Array, upper: NDArray[np.complex128]) -> Table:
    hertz = np.abs(upper.imag) / (2.0 * math.pi)
    columns = [Column("mu", "", mus.tolist())]
    for i in range(upper.shape[1]):
        columns.append(Column(f"frequency {i + 1}", "Hz", hertz[:, i].tolist()))
        columns.append(Column(f"real part {i + 1}", "1/s", upper[:, i].real.tolist()))
    return Table("locus", "Root locus over mu", tuple(columns))


# --------------------------------------------------------------------------------------------- cases


def cases_study(cases: Sequence[TwoDofCase | BeltCase]) -> Study:
    """Published and derived numbers of systems of the literature beside ours.

    Raises
    ------
    ValueError
        a case expects what it cannot have
    """
    checks = [(case, check) for case in cases for check in check_case(case)]
    return Study(
        name="cases",
        title="Systems of the literature, fed in as data",
        facts={
            "cases": len(cases),
            "numbers": len(checks),
            "passed": sum(check.passed for _, check in checks),
            "largest_relative_error": max((c.relative_error for _, c in checks), default=0.0),
        },
        tables=(
            Table(
                "numbers",
                "Expected and computed",
                (
                    Column("case", "", [case.name for case, _ in checks]),
                    Column("quantity", "", [c.expectation.quantity for _, c in checks]),
                    Column("expected", "", [c.expectation.value for _, c in checks]),
                    Column("computed", "", [c.computed for _, c in checks]),
                    Column("relative error", "", [c.relative_error for _, c in checks]),
                    Column("passed", "", [c.passed for _, c in checks]),
                    Column("derivation", "", [c.expectation.derivation for _, c in checks]),
                ),
            ),
            Table(
                "sources",
                "Sources",
                (
                    Column("case", "", [case.name for case in cases]),
                    Column("title", "", [case.title for case in cases]),
                    Column("source", "", [case.source for case in cases]),
                ),
            ),
        ),
    )

"""Eigenvalue pairs of any model for people, brake file or matrices made elsewhere, all or in a frequency
band.

Job: the study "pairs" (facts, table, complex plane). NOT its job: eigenvalues
(`sim_hardware.brake_model.eigen.band`), files of matrices (`sim_hardware.brake_model.foreign.files`), courses
over a quantity (`rigctl.model.locus`).
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np
from matplotlib.figure import Figure

from rigctl.analysis.style import BLUE, INK, TITLE, VERMILION, grid, label_axes, new_figure
from rigctl.model.output import Column, Study, Table
from sim_hardware.brake_model.eigen.band import DAMPING_MAX, EigenPairs, eigen_pairs_of
from sim_hardware.brake_model.foreign.reduction import Reduction
from sim_hardware.brake_model.linear import LinearModel, value_of

_UNSTABLE = "#FBE3D6"
#: alignment below which vectors and sensitivities of a pair are called doubtful
_NEARLY_DEFECTIVE = 1e-3
_SHOWN = 12


def pairs_study(
    model: LinearModel,
    values: Mapping[str, float] | None = None,
    band: tuple[float, float] | None = None,
    *,
    damping_max: float = DAMPING_MAX,
    name: str = "pairs",
) -> Study:
    """Eigenvalue pairs of a model at one working point.

    Parameters
    ----------
    values : other values of the model's quantities
    band : frequencies (Hz); all eigenvalues where None (small models)
    damping_max : damping ratio up to which a band of a large model is searched

    Returns
    -------
    facts: number of pairs and of unstable ones, the least damped pair, method, whether the result is complete
    and how that is known; table "pairs"; figure "plane"

    Raises
    ------
    KeyError, ValueError, ArithmeticError, numpy.linalg.LinAlgError
        see `eigen_pairs_of`
    """
    found = eigen_pairs_of(model, values, band, damping_max=damping_max)
    title = f"{model.name}: {_headline(found)}{_where(found)}"
    return Study(
        name,
        title,
        _facts(model, values, found),
        (_table(found),),
        {"plane": partial(plane_figure, found, title, _point(model, values))},
    )


def _headline(found: EigenPairs) -> str:
    unstable = found.frequencies_hz[found.unstable]
    if not len(found.eigenvalues):
        return "no eigenvalues"
    if not unstable.size:
        return "stable" if found.eigenvalues.real.max() < 0.0 else "no growing pair"
    shown = ", ".join("diverges" if f == 0.0 else f"{f:.1f} Hz" for f in unstable[:4])
    return f"unstable: {shown}{' …' if unstable.size > 4 else ''}"


def _where(found: EigenPairs) -> str:
    return "" if found.band_hz is None else f" ({found.band_hz[0]:g} to {found.band_hz[1]:g} Hz)"


def _point(model: LinearModel, values: Mapping[str, float] | None) -> str:
    """The working point for a drawing: "mu = 0.5, pressure = 10 bar"."""
    operating = [
        q.name for q in model.quantities.values() if q.kind == "operating" and q.name != "piston_area"
    ]
    names = [*operating, *(name for name in values or {} if name not in operating)]
    units = {name: model.quantities[name].unit for name in names}
    return ", ".join(
        f"{name} = {value_of(model, name, values):g}{'' if units[name] in ('', '1') else ' ' + units[name]}"
        for name in names
    )


def _facts(
    model: LinearModel, values: Mapping[str, float] | None, found: EigenPairs
) -> dict[str, str | int | float | bool | None]:
    moving = np.flatnonzero(found.frequencies_hz > 0.0)
    least = moving[int(np.argmin(found.damping_ratios[moving]))] if moving.size else None
    facts: dict[str, str | int | float | bool | None] = {
        "working_point": _point(model, values),
        "degrees_of_freedom": len(model.freedoms),
        "eigenvalues_with_frequency": len(moving),
        "real_eigenvalues": len(found.eigenvalues) - len(moving),
        "unstable": int(found.unstable.sum()),
        "least_damped_hz": None if least is None else float(found.frequencies_hz[least]),
        "least_damping_ratio_percent": None if least is None else 100.0 * float(found.damping_ratios[least]),
        "complete": {True: "yes", False: "no", None: "not proven"}[found.complete],
        "how_that_is_known": found.evidence,
        "largest_residual": float(found.residuals.max(initial=0.0)),
    }
    if np.any(found.alignments[moving] < _NEARLY_DEFECTIVE):
        facts["caution"] = "nearly coinciding pairs: their vectors and sensitivities are not to be trusted"
    return facts


def _table(found: EigenPairs) -> Table:
    return Table(
        "pairs",
        "Eigenvalues with frequency 0 or more",
        (
            Column("pair", "", list(range(1, len(found.eigenvalues) + 1))),
            Column("frequency", "Hz", found.frequencies_hz.tolist()),
            Column("damping_ratio", "%", (100.0 * found.damping_ratios).tolist()),
            Column("real_part", "1/s", found.eigenvalues.real.tolist()),
            Column("error_bound", "1/s", found.errors_1_s.tolist()),
            Column("residual", "", found.residuals.tolist()),
            Column("alignment", "", found.alignments.tolist()),
            Column("unstable", "", found.unstable.tolist()),
        ),
    )


def plane_figure(found: EigenPairs, title: str, point: str) -> Figure:
    """Eigenvalues in the complex plane, unstable ones named."""
    figure = new_figure(8.0, 5.2)
    axes = figure.subplots()
    figure.subplots_adjust(left=0.095, right=0.97, top=0.8, bottom=0.12)
    figure.suptitle(title, x=0.02, y=0.97, **TITLE)
    x, y = found.eigenvalues.real, found.frequencies_hz / 1e3
    span = max(float(np.ptp(np.append(x, 0.0))), 1e-9)
    low, high = min(float(x.min(initial=0.0)), 0.0) - 0.06 * span, float(x.max(initial=0.0)) + 0.06 * span
    axes.set_xlim(low, max(high + (0.17 * span if found.unstable.any() else 0.0), 0.05 * (high - low)))
    if found.band_hz is not None:
        axes.set_ylim(found.band_hz[0] / 1e3, found.band_hz[1] / 1e3)
    else:
        axes.set_ylim(-0.02 * float(y.max(initial=1.0)), 1.06 * float(y.max(initial=1.0)))
    axes.axvspan(0.0, axes.get_xlim()[1], color=_UNSTABLE, zorder=0, lw=0, label="unstable half-plane")
    axes.axvline(0.0, color=INK, lw=0.9, zorder=1)
    calm = ~found.unstable
    axes.plot(x[calm], y[calm], "o", ms=5, color=BLUE, mec="white", mew=0.6, label="decaying", clip_on=False)
    if found.unstable.any():
        axes.plot(
            x[~calm],
            y[~calm],
            "D",
            ms=6.5,
            color="white",
            mec=VERMILION,
            mew=1.6,
            label="growing",
            clip_on=False,
        )
    for place, text in _labels(found, axes.get_xlim(), axes.get_ylim()):
        axes.annotate(
            text,
            place,
            xytext=(9, 0),
            textcoords="offset points",
            va="center",
            color=VERMILION,
            fontsize=9,
            fontweight="bold",
        )
    figure.text(0.02, 0.9, point, fontsize=9.5, va="top")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=3, borderaxespad=0.1)
    label_axes(axes, "real part [1/s]", "frequency [kHz]", y_gap_pt=34.0)
    grid(axes)
    return figure


def _labels(
    found: EigenPairs, across: tuple[float, float], up: tuple[float, float]
) -> list[tuple[tuple[float, float], str]]:
    """Where growing pairs are named, and how; neighbours share a label."""
    labels: list[tuple[tuple[float, float], list[str]]] = []
    wide, high = 0.12 * (across[1] - across[0]), 0.045 * (up[1] - up[0])
    for index in np.flatnonzero(found.unstable)[:_SHOWN]:
        x, y = float(found.eigenvalues.real[index]), float(found.frequencies_hz[index]) / 1e3
        for number, (place, texts) in enumerate(labels):
            if abs(x - place[0]) < wide and y - place[1] < high:
                labels[number] = ((max(place[0], x), place[1]), [*texts, f"{1e3 * y:.1f}"])
                break
        else:
            labels.append(((x, y), [f"{1e3 * y:.1f}"]))
    return [(place, f"{', '.join(texts)} Hz") for place, texts in labels]


def reduction_study(reduction: Reduction, *, name: str = "reduce") -> Study:
    """What a reduction kept: size, band, agreement with the large model at and between the basis' points."""
    checks = reduction.checks
    between = [check for check in checks if not check.basis_point]
    good = all(check.same_unstable for check in checks)
    facts = {
        "degrees_of_freedom_before": reduction.basis.shape[0],
        "degrees_of_freedom": reduction.basis.shape[1],
        "band_from_hz": reduction.band_hz[0],
        "band_to_hz": reduction.band_hz[1],
        "largest_error_at_basis_points": max(check.error for check in checks if check.basis_point),
        "largest_error_between": max((check.error for check in between), default=None),
        "same_pairs_grow": good,
    }
    table = Table(
        "checks",
        "Small and large model at the same working points",
        (
            Column(
                "at", "", [", ".join(f"{n} = {v:g}" for n, v in check.values.items()) for check in checks]
            ),
            Column("basis_made_here", "", [check.basis_point for check in checks]),
            Column("pairs", "", [check.pairs for check in checks]),
            Column("error", "", [check.error for check in checks]),
            Column("same_pairs_grow", "", [check.same_unstable for check in checks]),
        ),
    )
    title = (
        f"{reduction.model.name}: {reduction.basis.shape[1]} instead of {reduction.basis.shape[0]} "
        "degrees of freedom, "
        f"error up to {reduction.largest_error:.1e}"
    )
    return Study(name, title, facts, (table,))

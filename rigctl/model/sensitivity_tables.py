"""Tables of the sensitivity studies.

NOT its job: the numbers (`sim_hardware.brake_model`), which tables a study has (`sensitivity`).
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.model.output import Column, Table
from sim_hardware.brake_model.design.effects import Influence, one_of_each_pair
from sim_hardware.brake_model.design.robustness import Robustness
from sim_hardware.brake_model.design.sensitivity import Sensitivities
from sim_hardware.brake_model.eigen.eigen_systems import EigenSystem
from sim_hardware.brake_model.linear import LinearModel

#: upper end of the frequencies for which the paper trusts its rigid bodies, and squeal was tested (4.3.4)
BELOW_HZ = 5000.0


def column(name: str, unit: str, values: Iterable[Any]) -> Column:
    """A column of any values, arrays too."""
    return Column(name, unit, list(values))


def basic_table(found: Robustness) -> Table:
    nominal = found.resolved.nominal
    return Table(
        "basic",
        "Robustness of the basic design (eq 25)",
        (
            column("i", "", range(1, nominal.shape[1] + 1)),
            column("frequency", "Hz", found.frequencies_hz),
            column(f"re_{found.low:g}", "1/s", nominal[0].real),
            column(f"re_{found.high:g}", "1/s", nominal[1].real),
            column("robustness", "1/s", found.basic),
        ),
    )


def modifications_table(found: Robustness, below_hz: float) -> Table:
    order = np.argsort(-np.abs(found.deviations), kind="stable")
    chosen = [found.variations[i] for i in order]
    sure = np.asarray(found.resolved.sure.all(axis=(1, 2))) & bool(found.resolved.nominal_sure.all())
    return Table(
        "modifications",
        f"Largest robustness value of each modification; basic design {found.reference:.4g} 1/s",
        (
            column("modification", "", [v.title for v in chosen]),
            column("maximum", "1/s", found.maxima[order]),
            column("at", "Hz", found.frequencies_hz[found.worst_modes[order]]),
            column("minus_basic", "1/s", found.deviations[order]),
            column(f"maximum_below_{below_hz / 1e3:g}_khz", "1/s", found.maxima_below(below_hz)[order]),
            column("sum", "1/s", found.sums[1:][order]),
            column("identity_sure", "", sure[order]),
            column("group", "", [v.group for v in chosen]),
            column("mode", "", [v.mode for v in chosen]),
        ),
    )


def effects_table(found: Influence) -> Table:
    kept = one_of_each_pair(found.resolved.nominal[0])
    changes, frequencies = found.changes[:, kept], found.resolved.frequencies_hz[kept]
    largest = np.abs(changes).argmax(axis=1) if kept.size else np.zeros(len(changes), dtype=int)
    rows = np.arange(len(changes))
    coupled = [
        ", ".join(f"{frequencies[a]:.0f}/{frequencies[b]:.0f}" for a, b in e.coupled) or None
        for e in found.effects
    ]
    return Table(
        "effects",
        "Change of real parts, one of each pair",
        (
            column("modification", "", [v.title for v in found.variations]),
            column("effect", "", ["; ".join(e.classes) for e in found.effects]),
            column("sum", "1/s", _sums(changes)),
            column("largest", "1/s", changes[rows, largest]),
            column("at", "Hz", frequencies[largest]),
            column("coupled_modes", "Hz", coupled),
        ),
    )


def bands_table(found: Influence) -> Table:
    """Where the effect of each modification lies."""
    kept = one_of_each_pair(found.resolved.nominal[0])
    below = found.resolved.frequencies_hz[kept] < BELOW_HZ
    return Table(
        "bands",
        "Where the effects lie",
        (
            column("modification", "", [v.title for v in found.variations]),
            column("sum_below_5_khz", "1/s", _sums(found.changes[:, kept[below]])),
            column("band_from", "Hz", [e.band_hz[0] for e in found.effects]),
            column("band_to", "Hz", [e.band_hz[1] for e in found.effects]),
            column("against_main_direction", "%", [100.0 * e.against for e in found.effects]),
            column("identity_sure", "", np.asarray(found.resolved.sure.all(axis=(1, 2)))),
        ),
    )


def _sums(changes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sum over modes; what is left of the cancellation by rounding is 0."""
    sums = changes.sum(axis=1)
    return np.where(np.abs(sums) > 1e-9 * np.abs(changes).sum(axis=1), sums, 0.0)


def changes_table(found: Influence) -> Table:
    nominal = found.resolved.nominal[0]
    columns = [
        column("i", "", range(1, nominal.size + 1)),
        column("frequency", "Hz", found.resolved.frequencies_hz),
    ]
    columns += [column(v.name, "1/s", row) for v, row in zip(found.variations, found.changes, strict=True)]
    return Table("changes", "Change of the real part of every eigenvalue", tuple(columns))


def ranking_table(model: LinearModel, found: Sensitivities, i: int, order: Any) -> Table:
    relative, reach = found.per_percent[order, i], found.reach_percent[order, i]
    return Table(
        "ranking",
        "Change for 1 % more of each quantity (eq 24)",
        (
            column("quantity", "", [found.names[k] for k in order]),
            column("kind", "", [model.quantities[found.names[k]].kind for k in order]),
            column("value", "", found.amounts[order]),
            column("unit", "", [found.units[k] for k in order]),
            column("real_part", "1/s per %", relative.real),
            column("frequency", "Hz per %", relative.imag / 2.0 / np.pi),
            column("holds_up_to", "%", reach),
        ),
    )


def per_unit_table(found: Sensitivities, i: int, order: Any) -> Table:
    absolute = found.absolute[order, i]
    return Table(
        "per_unit",
        "Derivatives of the pair by each quantity, per unit of it (eq 24)",
        (
            column("quantity", "", [found.names[k] for k in order]),
            column("unit", "", [found.units[k] for k in order]),
            column("real_part", "1/s per unit", absolute.real),
            column("frequency", "Hz per unit", absolute.imag / 2.0 / np.pi),
        ),
    )


def pairs_table(system: EigenSystem, kept: Any) -> Table:
    return Table(
        "pairs",
        "Eigenvalue pairs: how far their derivatives can be trusted",
        (
            column("pair", "", range(1, len(kept) + 1)),
            column("frequency", "Hz", system.frequencies_hz[kept]),
            column("real_part", "1/s", system.values[kept].real),
            column("condition", "", system.condition[kept]),
            column("distance_to_next", "1/s", system.gap[kept]),
            column("no_number_because", "", [system.reasons[i] or None for i in kept]),
        ),
    )


def all_table(found: Sensitivities, kept: Any) -> Table:
    columns: list[Column] = [column("quantity", "", found.names)]
    for number, i in enumerate(kept, start=1):
        columns.append(column(f"real_part_{number}", "1/s per percent", found.per_percent[:, i].real))
        columns.append(
            column(f"frequency_{number}", "Hz per percent", found.per_percent[:, i].imag / 2.0 / np.pi)
        )
    return Table("all", "Change of every pair for 1 % more of each quantity", tuple(columns))

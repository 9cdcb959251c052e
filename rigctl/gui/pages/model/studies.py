"""Longer questions of the model page, for the worker: stability map, ranking, a campaign's squeal.

Job: functions that pickle, each a call of the project's studies, answered in plain values; files of results.
Not its job: numerics, Qt. Heavy imports are made inside functions.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from rigctl.gui.pages.model.data import (
    Advice,
    BrakeFile,
    CampaignPoints,
    Knob,
    MapAxis,
    Measured,
    Ranking,
    RankingRule,
    Setting,
    StabilityMap,
)
from rigctl.gui.pages.model.worker import brake_of, designed

if TYPE_CHECKING:
    from rigctl.analysis.campaign_table import CampaignTable
    from rigctl.model.output import Study
    from sim_hardware.brake_model.design.recommending import Recommendations
    from sim_hardware.brake_model.design.variations import Variation
    from sim_hardware.brake_model.eigen.maps import EigenvalueMap

Array = NDArray[np.float64]

#: contour lines of frequency at most, and the jump between neighbours that no line crosses, as share
_MOST_CONTOURS, _JUMP = 8, 0.04


def stability_map(
    file: BrakeFile,
    setting: Setting,
    x: tuple[MapAxis, Knob | None],
    y: tuple[MapAxis, Knob | None],
    count: int,
) -> StabilityMap:
    """Growth rate and unstable frequency over two sliders, `count` points each, with the exact boundary.

    Raises
    ------
    ConfigError
        twice the same slider, or values that are impossible for this brake
    """
    from rigctl.model.loading import study_errors
    from sim_hardware.brake_model.eigen.directions import Direction
    from sim_hardware.brake_model.eigen.maps import eigenvalue_map

    own = {member for _, knob in (x, y) if knob is not None for member in knob.members}
    rest = replace(setting, factors=tuple((n, f) for n, f in setting.factors if n not in own))
    ways = []
    for axis, knob in (x, y):
        grid = np.linspace(axis.low, axis.high, count)
        if knob is None:
            ways.append((axis.key, grid))
        else:
            ways.append((Direction(knob.key, "1", dict.fromkeys(knob.members, 1.0)), grid - 1.0))
    with study_errors(str(file.path)):
        model, values = designed(file, rest)
        found = eigenvalue_map(model, ways[0], ways[1], values)
        return _answer(found, x, y)
    raise AssertionError  # `study_errors` has raised


def _answer(
    found: EigenvalueMap, x: tuple[MapAxis, Knob | None], y: tuple[MapAxis, Knob | None]
) -> StabilityMap:
    shift_x, shift_y = (0.0 if knob is None else 1.0 for _, knob in (x, y))
    frequency = np.where(found.unstable, found.frequency_hz, np.nan)
    x_values, y_values = found.x_values + shift_x, found.y_values + shift_y
    lines = []
    for line in found.boundary:
        closing = [0] if line.closed else []
        index = [*range(len(line.x)), *closing]
        lines.append((line.x[index] + shift_x, line.y[index] + shift_y, line.frequency_hz[index]))
    return StabilityMap(
        x[0],
        y[0],
        x_values,
        y_values,
        found.growth_rate_1_s,
        frequency,
        tuple(lines),
        _contours(x_values, y_values, frequency),
        found.unstable_share,
    )


def _contours(x: Array, y: Array, frequency: Array) -> tuple[tuple[float, tuple[Array, ...]], ...]:
    """Lines of equal frequency; none across the jump from one unstable mode to another."""
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    known = frequency[np.isfinite(frequency)]
    if known.size == 0 or known.max() - known.min() < 2.0:
        return ()
    steep = np.zeros(frequency.shape, dtype=bool)
    for axis in (0, 1):
        jump = np.abs(np.diff(frequency, axis=axis)) > _JUMP * known.max()
        ends = [(slice(None),) * axis + (part,) for part in (slice(None, -1), slice(1, None))]
        for end in ends:
            steep[end] |= jump
    levels = MaxNLocator(_MOST_CONTOURS, integer=True).tick_values(known.min(), known.max())
    masked = np.ma.masked_invalid(np.where(steep, np.nan, frequency))
    drawn = Figure().subplots().contour(x, y, masked, levels=levels)
    found = []
    for level, segments in zip(drawn.levels, drawn.allsegs, strict=True):
        kept = tuple(np.asarray(s, dtype=float) for s in segments if len(s) > 2)
        if kept:
            found.append((float(level), kept))
    return tuple(found)


def ranking(file: BrakeFile, setting: Setting, step: float) -> Ranking:
    """All modifications of the groups by a share, best first, at the sliders' values.

    Raises
    ------
    ConfigError
        the brake has no parameter groups, or a value becomes impossible
    """
    from rigctl.core.errors import ConfigError
    from rigctl.model.loading import study_errors
    from sim_hardware.brake_model.design.recommending import recommend
    from sim_hardware.brake_model.design.variations import all_variations

    if not brake_of(file).groups:
        raise ConfigError(
            "the brake has no parameter groups.",
            place=str(file.path),
            remedy="Name some in its file: [[groups]], see docs/reference/model-studies.md.",
        )
    with study_errors(str(file.path)):
        model, values = designed(file, setting)
        found = recommend(model, all_variations(model, step), values)
        onset = found.onset
        rows = [_advice(found, k, step) for k in found.order.tolist()]
        return Ranking(
            setting, step, None if onset is None else float(onset.values[0]), tuple(rows), _rule(found)
        )
    raise AssertionError  # `study_errors` has raised


def _advice(found: Recommendations, k: int, step: float) -> Advice:
    harm = float(found.harm[k])
    onset = np.nan if found.onset is None else float(found.onset.values[k + 1])
    return Advice(
        found.variations[k].title,
        _factors(found.variations[k], step),
        found.verdicts[k],
        float(found.gains[k]),
        harm,
        float(found.resolved.frequencies_hz[found.harmed[k]]) if harm > 0.0 else None,
        onset if np.isfinite(onset) else None,
        bool(found.sure[k]),
    )


def _rule(found: Recommendations) -> RankingRule:
    rule = found.rule
    return RankingRule(
        rule.below_hz, rule.least_gain, found.least_gain_1_s, rule.harm, rule.onset,
        min(found.mus), max(found.mus),
    )  # fmt: skip


def _factors(way: Variation, step: float) -> Mapping[str, float]:
    """A modification as factors of sliders."""
    up, down = 1.0 + step, 1.0 - step
    if way.symmetric:
        return {way.group: up if way.mode == "increase" else down}
    first, second = (up, down) if way.mode == "clockwise" else (down, up)
    return {f"{way.group}:leading": first, f"{way.group}:trailing": second}


def write_ranking(file: BrakeFile, setting: Setting, step: float, path: Path) -> Path:
    """Write the ranking as the command line would: a table (.csv), or its figure (.png, .svg).

    Raises
    ------
    ConfigError
        the file cannot be written
    """
    from rigctl.model.advice import recommendation_study

    model, values = designed(file, setting)
    study = recommendation_study(model, values, step=step)
    return write_study(study, "ranking", path)


def write_map(
    file: BrakeFile, setting: Setting, x: tuple[MapAxis, Knob | None], y: tuple[MapAxis, Knob | None],
    count: int, path: Path,
) -> Path:  # fmt: skip
    """Write every point of a map as CSV.

    Raises
    ------
    ConfigError
        the file cannot be written
    """
    found = stability_map(file, setting, x, y, count)
    from rigctl.model.output import Column, Study, Table

    grid_x, grid_y = np.meshgrid(found.x_values, found.y_values)
    columns = (
        Column(found.x.key, _unit(x), grid_x.ravel().tolist()),
        Column(found.y.key, _unit(y), grid_y.ravel().tolist()),
        Column("growth_rate", "1/s", found.growth_1_s.ravel().tolist()),
        Column("unstable_frequency", "Hz", found.frequency_hz.ravel().tolist()),
    )
    return write_study(Study("map", "", {}, (Table("map", "", columns),)), "map", path)


def _unit(axis: tuple[MapAxis, Knob | None]) -> str:
    units = {"pressure": "bar", "slope": "s/m"}
    return units.get(axis[0].key, "") if axis[1] is None else ""


def write_study(study: Study, name: str, path: Path) -> Path:
    """Write one table (.csv) or figure (.png, .svg) of a study to a path.

    Raises
    ------
    ConfigError
        the file cannot be written, or its ending is none of these
    """
    import tempfile

    from rigctl.core.errors import ConfigError
    from rigctl.model.output import write

    ending = path.suffix.removeprefix(".")
    if ending not in ("csv", "png", "svg"):
        raise ConfigError(
            "no such kind of file.", place=str(path), remedy="End the name with .csv, .png or .svg."
        )
    with tempfile.TemporaryDirectory() as folder:
        written = write(study, Path(folder), [ending])
        made = next(p for p in written if p.stem == f"{study.name}_{name}")
        try:
            path.write_bytes(made.read_bytes())
        except OSError as error:
            raise ConfigError(
                f"cannot be written: {error.strerror}.", place=str(path), remedy="Choose another folder."
            ) from error
    return path


def campaign_points(folder: Path) -> CampaignPoints:
    """Measured squeal events of a campaign, and its brakings without squeal, by friction and pressure.

    Raises
    ------
    RecordingError
        the folder is not a campaign
    """
    from rigctl.analysis.campaign_table import read_campaign

    return points_of(folder, read_campaign(folder))


def points_of(folder: Path, table: CampaignTable) -> CampaignPoints:
    """Events that count (no harmonics, complete brakings only) at the friction and pressure they had."""
    files = {braking.index: folder / "brakings" / braking.file for braking in table.brakings}
    squeals, quiet, without = [], [], 0
    for event in table.squeals():
        if event.mu is None or event.pressure_bar is None:
            without += 1
            continue
        place = (event.braking, files[event.braking], event.mu, event.pressure_bar)
        squeals.append(Measured(*place, event.frequency_hz, event.level_db))
    for braking in table.with_sound():
        if braking.squeals:
            continue
        if braking.mean_mu is None or braking.pressure_mean_bar is None:
            without += 1
            continue
        quiet.append(
            Measured(braking.index, files[braking.index], braking.mean_mu, braking.pressure_mean_bar)
        )
    return CampaignPoints(folder, tuple(squeals), tuple(quiet), without)

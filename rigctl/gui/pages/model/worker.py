"""What the model page's worker process computes: it asks the studies and hands back plain values.

Job: functions that pickle, each a call of `rigctl.model` or `sim_hardware.brake_model` with the sliders'
values; brakes stay read. Not its job: numerics, and anything of Qt. Heavy imports are made inside functions:
the window's process names these functions, the worker runs them.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from rigctl.gui.pages.model.data import (
    FACTORS,
    MU,
    OPERATING,
    PRESSURE,
    SLOPE,
    BrakeFacts,
    BrakeFile,
    Knob,
    LocusLines,
    OnsetFound,
    Onsets,
    Pole,
    Poles,
    Setting,
    Shape,
)

if TYPE_CHECKING:
    from sim_hardware.brake_model.linear import LinearModel, ParameterGroup
    from sim_hardware.brake_model.parametric import LinearBrake

#: condition from which a shape is hardly its own (as `rigctl.model.modes` says it)
_DEFECTIVE = 1e8
#: points of a path, and steps of the search for an onset
_PATH_POINTS = 61
_ONSET_STEPS = 60


def read(path: Path) -> BrakeFacts:
    """Read a brake file.

    Raises
    ------
    ConfigError
        names file, key, value and remedy
    """
    file = BrakeFile(path, path.stat().st_mtime_ns if path.exists() else 0)
    model = brake_of(file)
    quantities = model.quantities
    knobs = [knob for group in model.groups for knob in _group_knobs(group)]
    knobs += [
        Knob(q.name, q.name, q.unit, q.kind, (q.name,))
        for q in quantities.values()
        if q.name not in OPERATING and q.value != 0.0
    ]
    operating = {name: quantities[name].value for name in OPERATING}
    return BrakeFacts(file, model.name, model.brake.spec.description, operating, tuple(knobs))


@lru_cache(maxsize=4)
def brake_of(file: BrakeFile) -> LinearBrake:
    """The brake of a file, read once."""
    from rigctl.model.loading import read_brake
    from sim_hardware.brake_model.parametric import LinearBrake

    return LinearBrake(read_brake(file.path))


def _group_knobs(group: ParameterGroup) -> list[Knob]:
    knobs = [Knob(group.name, group.title, "", group.kind, group.members, group.name)]
    if group.has_sides:
        knobs += [
            Knob(f"{group.name}:{side}", group.title, "", group.kind, members, group.name, side)
            for side, members in (("leading", group.leading), ("trailing", group.trailing))
        ]
    return knobs


@lru_cache(maxsize=64)
def _designed(
    file: BrakeFile, factors: tuple[tuple[str, float], ...]
) -> tuple[LinearBrake, dict[str, float]]:
    from sim_hardware.brake_model.linear import value_of
    from sim_hardware.brake_model.parametric import LinearBrake

    model = brake_of(file)
    parameters = model.brake.spec.parameters
    own = {n: f * value_of(model, n) for n, f in factors if n in parameters}
    changed = LinearBrake(model.brake.with_parameters(**own)) if own else model
    return changed, {n: f * value_of(changed, n) for n, f in factors if n not in parameters}


def designed(file: BrakeFile, setting: Setting) -> tuple[LinearBrake, dict[str, float]]:
    """The brake with the setting's factors, and the values that studies take.

    Parameters are built into the brake; a factor on a place of an expression multiplies what the place then
    comes to.
    """
    model, places = _designed(file, setting.factors)
    return model, {**setting.operating, **places}


def poles(
    file: BrakeFile, setting: Setting, near: complex | None, other: BrakeFile | None, pick: int = 0
) -> Poles:
    """Poles at a setting, and the shape of the mode nearest to `near`; None: of the critical mode.

    Raises
    ------
    ConfigError
        the setting is impossible for this brake
    """
    from rigctl.model.loading import study_errors

    with study_errors(str(file.path)):
        model, values = designed(file, setting)
        found = _poles(model, values)
        number = None if near is None else min(found, key=lambda p: abs(p.eigenvalue - near)).number
        shape = _shape(model, values, number)
        ghosts = () if other is None else _other_poles(other, setting.mu, setting.pressure, setting.slope)
        return Poles(setting, found, shape, ghosts, pick)
    raise AssertionError  # `study_errors` has raised


@lru_cache(maxsize=8)
def _other_poles(file: BrakeFile, mu: float, pressure: float, slope: float) -> tuple[Pole, ...]:
    return _poles(brake_of(file), {MU: mu, PRESSURE: pressure, SLOPE: slope})


def _poles(model: LinearModel, values: dict[str, float]) -> tuple[Pole, ...]:
    from sim_hardware.brake_model.eigen.band import eigen_pairs_of

    pairs = eigen_pairs_of(model, values)
    rows = zip(pairs.eigenvalues.tolist(), pairs.unstable.tolist(), strict=True)
    return tuple(Pole(k, value, unstable) for k, (value, unstable) in enumerate(rows, start=1))


def _shape(model: LinearBrake, values: dict[str, float], number: int | None) -> Shape:
    from rigctl.model.brake_drawing import draw_brake, scale_for
    from rigctl.model.drawn_brake import Motions
    from sim_hardware.brake_model.eigen.mode_shapes import find_shape, mode_shapes, participation

    shape = find_shape(mode_shapes(model, values), number)
    shares = participation(model, shape, values)
    picture = draw_brake(model, values)
    bodies = {body.name: body.motion for body in shares.bodies}
    strain = {coupling.name: coupling.strain for coupling in shares.couplings}
    return Shape(
        shape.number,
        picture,
        Motions(bodies, scale_for(picture, bodies), strain),
        tuple(sorted(((b.name, b.kinetic) for b in shares.bodies), key=lambda row: -row[1])),
        tuple(sorted(strain.items(), key=lambda row: -row[1])),
        shares.damping_1_s,
        shares.friction_1_s,
        shape.condition > _DEFECTIVE,
    )


def onsets(file: BrakeFile, setting: Setting, other: BrakeFile | None) -> Onsets:
    """Where the brake becomes unstable at a setting, and the brake to compare with."""
    from rigctl.model.loading import study_errors

    with study_errors(str(file.path)):
        own = _onset(file, setting.mu, setting.slope, setting.factors)
        ghost = None if other is None else _onset(other, setting.mu, setting.slope, ())
        return Onsets(setting, own, ghost)
    raise AssertionError  # `study_errors` has raised


@lru_cache(maxsize=64)
def _onset(file: BrakeFile, mu: float, slope: float, factors: tuple[tuple[str, float], ...]) -> OnsetFound:
    """Over pressure; over friction where it does not fall with speed, because pressure then has no effect."""
    from sim_hardware.brake_model.eigen.boundary import stability_boundary

    over = PRESSURE if slope > 0.0 else MU
    limit = OPERATING[over][1]
    model, places = _designed(file, factors)
    values = {MU: mu, SLOPE: slope, **places}
    values.pop(over, None)
    found = stability_boundary(model, over, 0.0, limit, values, steps=_ONSET_STEPS)
    point = found.point if found.point is not None and found.point.destabilises else None
    return OnsetFound(
        over,
        limit,
        None if point is None else point.value,
        None if point is None else point.frequency_hz,
        found.starts_unstable,
    )


def locus(file: BrakeFile, setting: Setting, over: Knob | str) -> LocusLines:
    """Paths of all modes over one slider, the others as they are; the slider's own factor is left out.

    Raises
    ------
    ConfigError
        the range holds values that are impossible for this brake
    """
    from rigctl.model.loading import study_errors
    from rigctl.model.locus import section_of
    from sim_hardware.brake_model.eigen.tracking import track
    from sim_hardware.brake_model.eigen.tracking_events import mode_couplings

    with study_errors(str(file.path)):
        model, values = designed(file, setting)
        if isinstance(over, str):
            found = track(model, over, np.linspace(*OPERATING[over], _PATH_POINTS), values)
        else:
            signs = dict.fromkeys(over.members, 1.0)
            found = track(model, signs, np.geomspace(*FACTORS, _PATH_POINTS), values)
        section = section_of(found, mode_couplings(found))
        return LocusLines(
            over if isinstance(over, str) else over.key,
            found.fine_grid,
            found.fine_eigenvalues,
            tuple((c.value, c.frequency_hz, c.destabilising) for c in found.crossings),
            (*section.real_1_s, *section.frequency_hz),
        )
    raise AssertionError  # `study_errors` has raised

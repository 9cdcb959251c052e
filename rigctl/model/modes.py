"""Mode shapes of a model for people: who takes part, what feeds it, pictures and animations of the brake
deforming.

Models without geometry (matrices made elsewhere) get their degrees of freedom as bars instead of a drawing.
NOT its job: eigenvalues and energies (`sim_hardware.brake_model.eigen.mode_shapes`), the drawings themselves
(`modes_figures`, `brake_drawing`, `brake_painting`, `brake_page`).
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

import numpy as np

from rigctl.core.errors import ConfigError
from rigctl.model.brake_drawing import Drawing, draw_brake, scale_for
from rigctl.model.brake_page import PageMode, modes_page
from rigctl.model.brake_painting import Motions, animated_gif, label_of
from rigctl.model.modes_figures import budget_figure, freedoms_figure, shape_figure
from rigctl.model.output import Column, Study, Table
from sim_hardware.brake_model.eigen.mode_shapes import (
    ModeShape,
    Participation,
    find_shape,
    mode_shapes,
    participation,
)
from sim_hardware.brake_model.linear import LinearModel
from sim_hardware.brake_model.parametric import LinearBrake

ANIMATIONS = ("gif", "html", "mp4")
#: bodies with at least this share of the kinetic energy take part
_PART = 0.1
#: condition from which a shape is hardly its own: two modes nearly coincide
_DEFECTIVE = 1e8


def modes_study(
    model: LinearModel,
    number: int | None = None,
    near_hz: float | None = None,
    values: Mapping[str, float] | None = None,
    *,
    band_hz: tuple[float, float] | None = None,
    name: str = "mode",
) -> Study:
    """Mode shape of a model: energies of bodies and couplings, what feeds and damps it, the deformed brake.

    Parameters
    ----------
    number : of the mode, from 1 by frequency; else `near_hz`, the frequency it is nearest to; else the
        critical mode
    values : quantities that differ from the file
    band_hz : frequency band, for large models; numbers then count within it
    name : stem of the files

    Raises
    ------
    KeyError, ValueError
        see `mode_shapes`
    """
    shapes = mode_shapes(model, values, band_hz)
    shape = find_shape(shapes, number, near_hz)
    title = f"{model.name}, {_heading(shape)}"
    listing = _listing(model, shapes, values)
    facts = {
        "mode": shape.number,
        "modes": len(shapes),
        "frequency_hz": shape.frequency_hz,
        "real_part_1_s": shape.eigenvalue.real,
        "damping_percent": 100.0 * shape.damping_ratio,
        "in_phase": shape.collinearity,
    }
    if shape.condition > _DEFECTIVE:
        facts["caution"] = "two modes nearly coincide here: the shape is hardly its own"
    if not isinstance(model, LinearBrake):
        facts["drawing"] = "the model has no geometry: its degrees of freedom are shown as bars"
        figures = {"freedoms": partial(freedoms_figure, shape, title)}
        return Study(name, title, facts, (_freedoms(shape), listing), figures)
    shares = participation(model, shape, values)
    picture = draw_brake(model, values)
    fed = sorted((c for c in shares.couplings if c.friction_1_s), key=lambda c: -c.friction_1_s)
    facts |= {
        "bodies_taking_part": _names_of_bodies(shares),
        "couplings_most_strained": _names_of_couplings(shares),
        "damping_adds_1_s": shares.damping_1_s,
        "friction_adds_1_s": shares.friction_1_s,
        "friction_by_contact_1_s": ", ".join(f"{c.name} {c.friction_1_s:+.1f}" for c in fed) or "none",
    }
    return Study(
        name,
        title,
        facts,
        (_bodies(shares), _couplings(shares), listing),
        {
            "shape": partial(shape_figure, picture, motions_of(model, shape, picture, values), shape, title),
            "budget": partial(budget_figure, shape, shares, title),
        },
    )


def check_animations(model: LinearModel, kinds: Sequence[str]) -> None:
    """Refuse animations that cannot be made, before anything is computed.

    Raises
    ------
    ConfigError
        unknown kind, no geometry, no ffmpeg for "mp4"
    """
    unknown = [kind for kind in kinds if kind not in ANIMATIONS]
    if unknown:
        known = ", ".join(ANIMATIONS)
        raise ConfigError(
            "no such animation.", place="--animate", value=unknown[0], remedy=f"Known: {known}."
        )
    if not isinstance(model, LinearBrake):
        raise ConfigError(
            "has no geometry that could be drawn.",
            place="--animate", value=model.name,
            remedy="Leave --animate out: bars of the freedoms are drawn.",
        )  # fmt: skip
    if "mp4" in kinds:
        _encoder()


def animate(
    model: LinearModel,
    folder: Path,
    kinds: Sequence[str] = ("gif", "html"),
    number: int | None = None,
    near_hz: float | None = None,
    values: Mapping[str, float] | None = None,
    *,
    band_hz: tuple[float, float] | None = None,
    name: str = "mode",
) -> list[Path]:
    """Write animations of a mode: "gif", "html" (page with all modes to choose from), "mp4" (needs ffmpeg).

    Raises
    ------
    ConfigError
        unknown kind, no geometry, no ffmpeg, or the folder cannot be written
    """
    check_animations(model, kinds)
    assert isinstance(model, LinearBrake)  # checked
    encoder = _encoder() if "mp4" in kinds else ""
    shapes = mode_shapes(model, values, band_hz)
    shape = find_shape(shapes, number, near_hz)
    picture = draw_brake(model, values)
    paths = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if "gif" in kinds or "mp4" in kinds:
            data = animated_gif(
                picture, motions_of(model, shape, picture, values), f"{model.name}, {_heading(shape)}"
            )
            if "gif" in kinds:
                paths.append(folder / f"{name}.gif")
                paths[-1].write_bytes(data)
            if "mp4" in kinds:
                paths.append(folder / f"{name}.mp4")
                _mp4(encoder, data, paths[-1])
        if "html" in kinds:
            paths.append(folder / f"{name}.html")
            paths[-1].write_text(page(model, shapes, shape.number, values), encoding="utf-8")
    except OSError as error:
        raise ConfigError(
            f"cannot write animations: {error.strerror}.", place=str(folder), remedy="Name another folder."
        ) from error
    return paths


def page(
    model: LinearBrake, shapes: Sequence[ModeShape], shown: int, values: Mapping[str, float] | None = None
) -> str:
    """Self-contained page (HTML) that animates all modes of a brake."""
    picture = draw_brake(model, values)
    modes = []
    for shape in shapes:
        shares = participation(model, shape, values)
        lines = [
            f"Frequency {shape.frequency_hz:.1f} Hz, damping ratio {100 * shape.damping_ratio:.2f} %, "
            f"real part {shape.eigenvalue.real:+.1f} 1/s: "
            f"{'unstable' if shape.eigenvalue.real > 0 else 'stable'}",
            f"Kinetic energy: {_names_of_bodies(shares)}",
            f"Strain energy: {_names_of_couplings(shares)}",
            f"Dampers add {shares.damping_1_s:+.1f} 1/s to the real part, "
            f"friction {shares.friction_1_s:+.1f} 1/s",
        ]
        motions = motions_of(model, shape, picture, values)
        modes.append(PageMode(shape.number, _heading(shape), lines, motions))
    return modes_page(f"Modes of the brake '{model.name}'{_setting(values)}", picture, modes, shown)


def motions_of(
    model: LinearBrake, shape: ModeShape, picture: Drawing, values: Mapping[str, float] | None = None
) -> Motions:
    """How the bodies of a drawing move in a mode."""
    shares = participation(model, shape, values)
    bodies = {body.name: body.motion for body in shares.bodies}
    return Motions(bodies, scale_for(picture, bodies), {c.name: c.strain for c in shares.couplings})


def _heading(shape: ModeShape) -> str:
    state = ", unstable" if shape.eigenvalue.real > 0 else ""
    if shape.frequency_hz == 0.0:
        kind = (
            "rigid body motion"
            if shape.eigenvalue == 0
            else f"no vibration, {shape.eigenvalue.real:+.4g} 1/s"
        )
        return f"mode {shape.number}: {kind}{state}"
    return (
        f"mode {shape.number}: {shape.frequency_hz:.0f} Hz, damping {100 * shape.damping_ratio:.2f} %{state}"
    )


def _setting(values: Mapping[str, float] | None) -> str:
    return " at " + ", ".join(f"{k} = {v:g}" for k, v in values.items()) if values else ""


def _names_of_bodies(shares: Participation) -> str:
    rows = sorted(shares.bodies, key=lambda b: -b.kinetic)
    part = [b for b in rows if b.kinetic >= _PART] or rows[:1]
    return ", ".join(f"{label_of(b.name)} {100 * b.kinetic:.0f} % ({_way(b.motion)})" for b in part)


def _way(motion: np.ndarray) -> str:
    """What a body mostly does: shifts along x or y, turns (the turn at an arm of 50 mm)."""
    sizes = np.abs(motion) * np.array([1.0, 1.0, 0.05])
    words = ("along the disc", "normal to the disc", "turns")
    kept = [words[k] for k in np.argsort(-sizes) if sizes[k] > 0.5 * sizes.max()]
    return ", ".join(kept)


def _names_of_couplings(shares: Participation) -> str:
    rows = sorted(shares.couplings, key=lambda c: -c.strain)
    part = [c for c in rows if c.strain >= _PART] or rows[:2]
    return ", ".join(f"{c.name} {100 * c.strain:.0f} %" for c in part)


def _bodies(shares: Participation) -> Table:
    rows = sorted(shares.bodies, key=lambda b: -b.kinetic)
    motion = np.array([b.motion for b in rows])
    return Table(
        "bodies",
        "Bodies: shares of the kinetic energy, amplitudes where the point that moves most has 1 µm",
        (
            Column("body", "", [b.name for b in rows]),
            Column("kinetic_energy", "%", [100.0 * b.kinetic for b in rows]),
            Column("x", "µm", np.abs(motion[:, 0]).tolist()),
            Column("y", "µm", np.abs(motion[:, 1]).tolist()),
            Column("phi", "µrad", np.abs(motion[:, 2]).tolist()),
            Column("phase_x", "deg", _phases(motion[:, 0])),
            Column("phase_y", "deg", _phases(motion[:, 1])),
            Column("phase_phi", "deg", _phases(motion[:, 2])),
        ),
    )


def _couplings(shares: Participation) -> Table:
    rows = sorted(shares.couplings, key=lambda c: -c.strain)
    return Table(
        "couplings",
        "Couplings: shares of the strain energy, and what damper and friction add to the real part",
        (
            Column("coupling", "", [c.name for c in rows]),
            Column("between", "", [" – ".join(c.between) for c in rows]),
            Column("strain_energy", "%", [100.0 * c.strain for c in rows]),
            Column("relative_x", "µm", [float(abs(c.relative[0])) for c in rows]),
            Column("relative_y", "µm", [float(abs(c.relative[1])) for c in rows]),
            Column("damper_adds", "1/s", [c.damping_1_s for c in rows]),
            Column("friction_adds", "1/s", [c.friction_1_s for c in rows]),
            Column("falling_part", "1/s", [c.falling_1_s for c in rows]),
        ),
    )


def _freedoms(shape: ModeShape) -> Table:
    order = np.argsort(-np.abs(shape.vector), kind="stable").tolist()
    return Table(
        "freedoms",
        "Degrees of freedom, the largest first",
        (
            Column("freedom", "", [shape.freedoms[k] for k in order]),
            Column("amplitude", "", np.abs(shape.vector[order]).tolist()),
            Column("phase", "deg", np.degrees(np.angle(shape.vector[order])).tolist()),
        ),
    )


def _listing(model: LinearModel, shapes: Sequence[ModeShape], values: Mapping[str, float] | None) -> Table:
    columns = [
        Column("mode", "", [s.number for s in shapes]),
        Column("frequency", "Hz", [s.frequency_hz for s in shapes]),
        Column("damping", "%", [100.0 * s.damping_ratio for s in shapes]),
        Column("real_part", "1/s", [s.eigenvalue.real for s in shapes]),
        Column("in_phase", "", [s.collinearity for s in shapes]),
    ]
    if isinstance(model, LinearBrake):
        shares = [participation(model, s, values) for s in shapes]
        columns += [
            Column("dampers_add", "1/s", [p.damping_1_s for p in shares]),
            Column("friction_adds", "1/s", [p.friction_1_s for p in shares]),
            Column("bodies", "", [_names_of_bodies(p) for p in shares]),
        ]
    return Table("modes", "All modes", tuple(columns))


def _phases(values: np.ndarray) -> list[float | None]:
    return [float(np.degrees(np.angle(z))) if abs(z) > 0 else None for z in values]


def _encoder() -> str:
    """Path of ffmpeg."""
    program = shutil.which("ffmpeg")
    if program is None:
        raise ConfigError(
            "needs the program ffmpeg, which is not installed.",
            place="--animate", value="mp4", remedy="Install ffmpeg, or take gif or html.",
        )  # fmt: skip
    return program


def _mp4(program: str, gif: bytes, path: Path) -> None:
    """A GIF as MP4."""
    command = [program, "-y", "-f", "gif", "-i", "-", "-movflags", "+faststart", "-pix_fmt", "yuv420p"]
    even = ["-vf", "scale=trunc(iw/2)*2:trunc(ih/2)*2", str(path)]
    done = subprocess.run([*command, *even], input=gif, capture_output=True, check=False)
    if done.returncode:
        reason = re.sub(r"\s+", " ", done.stderr.decode(errors="replace"))[-200:]
        raise ConfigError(
            f"ffmpeg failed: {reason}.", place="--animate", value="mp4", remedy="Take gif or html."
        )

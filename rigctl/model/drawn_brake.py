"""A drawn brake as data: outlines, springs, motions, and how a body's points move; for any painter.

It needs numpy only, so that a process which paints brakes need not load what computes them. NOT its job:
where bodies stand (`brake_drawing`), painting (`brake_painting`, `brake_page`, the window).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Motion = NDArray[np.complex128]
Role = Literal["disc", "pad", "body"]
_AT_REST = np.zeros(3, dtype=complex)


@dataclass(frozen=True, slots=True)
class DrawnBody:
    """A body: its parts move together.

    Attributes
    ----------
    centre : (2,) where its centre of mass is drawn, m
    parts : outlines (k, 2) of its solid parts
    bridge : outline (k, 2) of what joins several parts behind the others, or None
    label : (2,) where its name stands
    """

    name: str
    role: Role
    centre: Array
    parts: tuple[Array, ...]
    bridge: Array | None
    label: Array


@dataclass(frozen=True, slots=True)
class DrawnSpring:
    """A spring from a point of one body to a point of another, or of the ground ("").

    Attributes
    ----------
    coupling : name of the coupling element; one may be drawn as several springs
    first, second : (body, (2,) place)
    kind : "contact", "spring" or "torsion"
    """

    coupling: str
    first: tuple[str, Array]
    second: tuple[str, Array]
    kind: Literal["contact", "spring", "torsion"]


@dataclass(frozen=True, slots=True)
class Drawing:
    """A whole brake, m.

    Attributes
    ----------
    box : (x from, x to, y from, y to) of everything at rest
    """

    bodies: tuple[DrawnBody, ...]
    springs: tuple[DrawnSpring, ...]
    box: tuple[float, float, float, float]

    def body(self, name: str) -> DrawnBody:
        """The body of that name."""
        return next(body for body in self.bodies if body.name == name)

    @property
    def size(self) -> float:
        """Diagonal of the box."""
        return float(np.hypot(self.box[1] - self.box[0], self.box[3] - self.box[2]))


def displaced(
    points: Array, centre: Array, motion: NDArray[np.complex128], phase_rad: float, scale: float
) -> Array:
    """Points (k, 2) of a rigid body moved by Re(motion e^(i phase)) times scale; motion: complex (x, y,
    phi).
    """
    x, y, phi = (motion * np.exp(1j * phase_rad)).real * scale
    arm = points - centre
    return points + np.column_stack([x - phi * arm[:, 1], y + phi * arm[:, 0]])  # eq 10


def scale_for(drawing: Drawing, motions: Mapping[str, NDArray[np.complex128]], share: float = 0.03) -> float:
    """Scale at which the point that moves most moves by a share of the drawing's size."""
    largest = 0.0
    for body in drawing.bodies:
        x, y, phi = motions.get(body.name, np.zeros(3, dtype=complex))
        arm = np.concatenate(body.parts) - body.centre
        u, v = x - phi * arm[:, 1], y + phi * arm[:, 0]
        square = 0.5 * (np.abs(u) ** 2 + np.abs(v) ** 2 + np.abs(u * u + v * v))
        largest = max(largest, float(np.sqrt(square.max())))
    return share * drawing.size / largest if largest > 0 else 0.0


@dataclass(frozen=True, slots=True)
class Motions:
    """How the bodies of a drawing move.

    Attributes
    ----------
    bodies : name -> complex (x, y, phi)
    scale : of displacements on the drawing
    strain : coupling -> share of the strain energy, 0...1: strongly strained springs are drawn thick and red
    """

    bodies: Mapping[str, Motion]
    scale: float
    strain: Mapping[str, float] = field(default_factory=dict)

    def of(self, body: str) -> Motion:
        """Motion of a body; the ground is at rest."""
        return self.bodies.get(body, _AT_REST)


def label_of(name: str) -> str:
    """Name of a body for people: "carrier_l" -> "carrier, leading"."""
    for suffix, word in (("_l", "leading"), ("_t", "trailing")):
        if name.endswith(suffix):
            return f"{name[:-2].replace('_', ' ')}, {word}"
    return name.replace("_", " ")


def spring_path(start: Array, end: Array, kind: str, amplitude: float, turns: int = 4) -> Array:
    """Zigzag (k, 2) between two points; a spiral where the spring is torsional."""
    if kind == "torsion":
        angle = np.linspace(0.0, 3.5 * np.pi, 40)
        radius = amplitude * (0.25 + 1.3 * angle / angle[-1])
        return start + np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    along = end - start
    length = float(np.hypot(*along))
    if length == 0.0:
        return np.stack([start, end])
    count = turns if length < 12 * amplitude else max(turns, int(length / (2.5 * amplitude)))
    normal = np.array([-along[1], along[0]]) / length
    stations = np.concatenate([[0.0, 0.14], np.linspace(0.14, 0.86, 2 * count + 1)[1:-1], [0.86, 1.0]])
    swing = np.zeros(len(stations))
    swing[2:-2] = amplitude * np.where(np.arange(2 * count - 1) % 2 == 0, 1.0, -1.0)
    return start + stations[:, None] * along + swing[:, None] * normal


def ground_path(start: Array, end: Array, size: float) -> Array:
    """Hatched line (k, 2) across the end of a spring: the ground; nan separates strokes."""
    along = (end - start) / max(float(np.hypot(*(end - start))), 1e-12)
    normal = np.array([-along[1], along[0]])
    strokes = [end - size * normal, end + size * normal, np.full(2, np.nan)]
    for share in np.linspace(-1.0, 1.0, 5):
        root = end + share * size * normal
        strokes += [root, root + 0.45 * size * (along - 0.8 * normal), np.full(2, np.nan)]
    return np.array(strokes)

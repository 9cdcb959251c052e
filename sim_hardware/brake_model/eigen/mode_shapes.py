"""Complex mode shapes: how bodies and points move, who takes part, and what feeds or damps the vibration.

A mode moves as Re(x e^(lambda t)). Shapes are turned so that the motion is as nearly in phase as it can be
at phase 0, and scaled so that the point that moves most moves by 1. Energy shares are means over a period.
The budget of the real part comes from lambda^2 M x + lambda D x + K x = 0, multiplied by the conjugate of
lambda x: Re(lambda) (|lambda|^2 x^H M x + x^H K_s x) is the sum of what every damper takes and every
friction contact gives; K_s are the springs alone. The sum over all elements is Re(lambda), exactly.
NOT its job: drawing (`rigctl.model.brake_drawing`), finding eigenvalues (`band`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.eigen.band import eigen_pairs_of
from sim_hardware.brake_model.linear import MU, PRESSURE, SLOPE, LinearModel, value_of
from sim_hardware.brake_model.parametric import AREA, PA_PER_BAR, LinearBrake
from sim_hardware.brake_model.spec import Contact, Spring, Torsion

Complex = NDArray[np.complex128]
_FREEDOMS = ("x", "y", "phi")
_TINY = 1e-300


@dataclass(frozen=True, slots=True)
class ModeShape:
    """A mode of any model.

    Attributes
    ----------
    number : from 1, by frequency at this state of the model; real eigenvalues first, each for itself
    eigenvalue : 1/s
    freedoms : (n,) names
    vector : (n,) displacements, m and rad per m (largest component 1 where the model has no geometry)
    collinearity : |x^T M x|^2 / (x^H M x)^2: 1 standing wave, all in phase; near 0 travelling
    condition : relative change of the eigenvalue per relative change of the matrices; huge where nearly
        defective: the shape is then hardly its own
    """

    number: int
    eigenvalue: complex
    freedoms: tuple[str, ...]
    vector: Complex
    collinearity: float
    condition: float

    @property
    def frequency_hz(self) -> float:
        """Im / 2 pi."""
        return self.eigenvalue.imag / (2.0 * np.pi)

    @property
    def damping_ratio(self) -> float:
        """-Re / |lambda|; 0 for lambda = 0."""
        size = abs(self.eigenvalue)
        return -self.eigenvalue.real / size if size else 0.0

    def at_phase(self, phase_rad: float) -> NDArray[np.float64]:
        """Displacements (n,) at a phase of the period."""
        return (self.vector * np.exp(1j * phase_rad)).real

    def body_motion(self, body: str) -> Complex:
        """Complex (x, y, phi) of a body's centre of mass; 0 for freedoms it has not."""
        index = {name: i for i, name in enumerate(self.freedoms)}
        names = (f"{body}.{freedom}" for freedom in _FREEDOMS)
        return np.array([self.vector[index[name]] if name in index else 0.0 for name in names], dtype=complex)


@dataclass(frozen=True, slots=True)
class BodyShare:
    """How a body takes part.

    Attributes
    ----------
    kinetic : share of the mean kinetic energy, 0...1
    motion : complex (x, y, phi), m, m, rad per m
    """

    name: str
    kinetic: float
    motion: Complex


@dataclass(frozen=True, slots=True)
class CouplingShare:
    """How a coupling element takes part.

    Attributes
    ----------
    between : names of bodies or points
    strain : share of the mean strain energy of all springs, 0...1
    relative : complex relative displacement along its axes x and y (m per m), or (rotation, 0) of a torsion
    damping_1_s : what its damper adds to the real part of the eigenvalue, never positive
    friction_1_s : what friction in it adds: nonconservative and falling friction together
    falling_1_s : the falling part of that
    """

    name: str
    between: tuple[str, str]
    strain: float
    relative: Complex
    damping_1_s: float
    friction_1_s: float
    falling_1_s: float


@dataclass(frozen=True, slots=True)
class Participation:
    """Who takes part in a mode of a brake.

    Attributes
    ----------
    bodies, couplings : in the order of the brake file
    damping_1_s, friction_1_s : sums over the couplings; together they are the real part
    """

    bodies: tuple[BodyShare, ...]
    couplings: tuple[CouplingShare, ...]

    @property
    def damping_1_s(self) -> float:
        """What all dampers add to the real part."""
        return sum(c.damping_1_s for c in self.couplings)

    @property
    def friction_1_s(self) -> float:
        """What friction adds to the real part."""
        return sum(c.friction_1_s for c in self.couplings)


def mode_shapes(
    model: LinearModel,
    values: Mapping[str, float] | None = None,
    band_hz: tuple[float, float] | None = None,
) -> tuple[ModeShape, ...]:
    """Return the mode shapes of a model, all or within a frequency band (large models), by frequency.

    Numbers count within the band where one is given.

    Raises
    ------
    KeyError, ValueError, ArithmeticError
        see `band.eigen_pairs_of`
    """
    pairs = eigen_pairs_of(model, values, band_hz)
    mass = model.matrices(values).mass
    shapes = []
    for number, eigenvalue in enumerate(pairs.eigenvalues):
        x = pairs.right[:, number]
        square = complex(x @ (mass @ x))
        total = float((x.conj() @ (mass @ x)).real)
        turned = x * np.exp(-0.5j * np.angle(square)) if square else x
        scaled = turned / max(_largest(model, turned, values), _TINY)
        strongest = scaled[np.abs(scaled).argmax()]
        if strongest.real < 0:
            scaled = -scaled
        shapes.append(
            ModeShape(
                number + 1,
                complex(eigenvalue),
                tuple(model.freedoms),
                scaled,
                abs(square) ** 2 / max(total, _TINY) ** 2,
                float(pairs.conditions[number]),
            )
        )
    return tuple(shapes)


def find_shape(
    shapes: tuple[ModeShape, ...], number: int | None = None, near_hz: float | None = None
) -> ModeShape:
    """Return the mode of a number, the one nearest to a frequency, or the critical one.

    Critical: the largest real part where a mode is unstable, else the least damping ratio.

    Raises
    ------
    ValueError
        no modes at all, or no such number
    """
    if not shapes:
        raise ValueError("the model has no eigenvalues there; choose another band")
    if number is not None:
        if not 1 <= number <= len(shapes):
            raise ValueError(f"there is no mode {number}; the model has modes 1 to {len(shapes)}")
        return shapes[number - 1]
    if near_hz is not None:
        return min(shapes, key=lambda s: abs(s.frequency_hz - near_hz))
    unstable = [s for s in shapes if s.eigenvalue.real > 1e-9 * abs(s.eigenvalue)]
    if unstable:
        return max(unstable, key=lambda s: s.eigenvalue.real)
    moving = [s for s in shapes if s.frequency_hz > 0.0] or list(shapes)
    return min(moving, key=lambda s: s.damping_ratio)


def point_coordinates(
    model: LinearBrake, values: Mapping[str, float] | None = None
) -> dict[str, tuple[float, float]]:
    """Return the coordinates (m) of all connecting points, "body.point", from their body's centre of mass."""
    given = dict(values or {})
    parameters = {name: value for name, value in given.items() if name in model.brake.spec.parameters}
    changed = LinearBrake(model.brake.with_parameters(**parameters)) if parameters else model
    return {
        point.key: (
            value_of(changed, f"{point.key}.x", given),
            value_of(changed, f"{point.key}.y", given),
        )
        for point in model.brake.spec.points
    }


def participation(
    model: LinearBrake, shape: ModeShape, values: Mapping[str, float] | None = None
) -> Participation:
    """Return the shares of bodies and coupling elements, and the budget of the real part.

    `values` must be those the shape was computed with.
    """
    x, eigenvalue = shape.vector, shape.eigenvalue
    lines = model.lines(values)
    spec = model.brake.spec
    square = abs(eigenvalue) ** 2
    kinetic = lines.inertia * np.abs(x) ** 2
    relative = lines.rows @ x
    strain = lines.stiffness * np.abs(relative) ** 2
    norm = max(square * kinetic.sum() + strain.sum(), _TINY)
    taken = -square * lines.damping * np.abs(relative) ** 2 / norm
    friction, falling = _friction(model, relative, eigenvalue, values)
    friction, falling = friction / norm, falling / norm
    total_kinetic, total_strain = max(kinetic.sum(), _TINY), max(strain.sum(), _TINY)
    bodies = tuple(
        BodyShare(
            body.name,
            float(
                sum(
                    k
                    for k, f in zip(kinetic, shape.freedoms, strict=True)
                    if f.rsplit(".", 1)[0] == body.name
                )
            )
            / total_kinetic,
            shape.body_motion(body.name),
        )
        for body in spec.bodies
        if body.freedoms
    )

    def share(coupling: Spring | Contact | Torsion, rows: list[int]) -> CouplingShare:
        return CouplingShare(
            coupling.name,
            coupling.between,
            float(strain[rows].sum()) / total_strain,
            np.array([*relative[rows], 0.0])[:2],
            float(taken[rows].sum()),
            float(friction[rows].sum()),
            float(falling[rows].sum()),
        )

    first_torsion = 2 * len(spec.couplings)
    couplings = [share(c, [2 * k, 2 * k + 1]) for k, c in enumerate(spec.couplings)]
    couplings += [share(t, [k]) for k, t in enumerate(spec.torsions, start=first_torsion)]
    return Participation(bodies, tuple(couplings))


def _friction(
    model: LinearBrake, relative: Complex, eigenvalue: complex, values: Mapping[str, float] | None
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Work of friction per line along x, all of it and of the falling part, before division by the norm."""
    lines, square = model.lines(values), abs(eigenvalue) ** 2
    mu = value_of(model, MU, values)
    slope_force = (
        value_of(model, SLOPE, values)
        * value_of(model, PRESSURE, values) * PA_PER_BAR
        * value_of(model, AREA, values)
    )  # fmt: skip  # k N (eq 31)
    friction, falling = np.zeros(len(relative)), np.zeros(len(relative))
    for x, y, side, share in model.brake.structure.contacts:
        across = relative[x].conjugate() * relative[y]
        spring = (eigenvalue.conjugate() * across).real * lines.stiffness[y]
        damper = square * across.real * lines.damping[y]
        falling[x] = square * slope_force * share * abs(relative[x]) ** 2
        friction[x] = side * mu * (spring + damper) + falling[x]
    return friction, falling


def _largest(model: LinearModel, vector: Complex, values: Mapping[str, float] | None) -> float:
    """Largest displacement of a connecting point of a brake over the period; of any other model the largest
    component.
    """
    if not isinstance(model, LinearBrake):
        return float(np.abs(vector).max())
    index = {name: i for i, name in enumerate(model.freedoms)}
    largest = 0.0
    for key, (r_x, r_y) in point_coordinates(model, values).items():
        body = key.split(".", maxsplit=1)[0]
        x, y, phi = (vector[index[n]] if (n := f"{body}.{f}") in index else 0.0 for f in _FREEDOMS)
        u, v = x - phi * r_y, y + phi * r_x  # eq 10
        # the longer half axis of the ellipse that the point runs through
        size = abs(u) ** 2 + abs(v) ** 2
        axis = 0.5 * (size + abs(u * u + v * v))
        largest = max(largest, float(np.sqrt(axis)))
    return largest

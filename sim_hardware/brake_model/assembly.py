"""The brake as a mechanical system: coupling forces (eqs 2-17), matrices M, D, K and the state matrix A (eq
27).

One table of coupling elements, read from the brake file, gives both the loop over couplings that computes
forces (as the paper's simulation code does, so that forces can be recorded) and the matrices.
Conventions: displacement of a point r of body i: u = (x - phi ry, y + phi rx) (eq 10); relative displacement
du = u(first) - u(second); an element's force F acts as -F on the first and +F on the second body (eqs 12,
13). At a contact the first body is the pad; friction pushes pads towards +x.
NOT its job: reading and checking brake files (`spec`), eigenvalues (`stability`), time integration.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.laws import spring_force
from sim_hardware.brake_model.lines import Lines, Structure
from sim_hardware.brake_model.spec import BrakeSpec, Contact, Spring, load_spec

Array = NDArray[np.float64]

#: friction force of a contact (N, towards +x on the pad, deviation from its mean) from the contact's index,
#: the relative velocity pad minus disc along x (m/s) and the variation of the compression force (N)
ContactFriction = Callable[[int, float, float], float]


@dataclass(frozen=True)
class Element:
    """A coupling element with numbers: entry of table g (translational, eq 16).

    Attributes
    ----------
    row_x, row_y : (n_dof,) relative displacement of its two points along its axes x, y per degree of freedom
    stiffness_n_m, damping_ns_m : values along (x, y)
    side : +1 or -1 at a contact (see `spec.Contact`), 0 otherwise
    load_share : part of the pad force at a contact, 0 otherwise
    pad : name of the pad's body at a contact, "" otherwise
    cubic_n_m3 : hardening c3 along (x, y): F = c u + c3 u^3 + d v (section 4.4)
    one_sided : the contact cannot pull
    """

    name: str
    row_x: Array
    row_y: Array
    stiffness_n_m: tuple[float, float]
    damping_ns_m: tuple[float, float]
    side: int = 0
    load_share: float = 0.0
    pad: str = ""
    cubic_n_m3: tuple[float, float] = (0.0, 0.0)
    one_sided: bool = False


@dataclass(frozen=True)
class TorsionElement:
    """Entry of table h (eq 17). `row`: (n_dof,) relative rotation per degree of freedom; `cubic_nm_rad3`:
    hardening."""

    name: str
    row: Array
    stiffness_nm_rad: float
    damping_nms_rad: float
    cubic_nm_rad3: float = 0.0


@dataclass(frozen=True, slots=True)
class LinearParts:
    """Matrices by what they are multiplied with, each (n_dof, n_dof); `inertia`: (n_dof,), the diagonal of M.

    D = damping + mu damping_mu + k N damping_kn, K = stiffness + mu stiffness_mu.
    """

    inertia: Array
    damping: Array
    damping_mu: Array
    damping_kn: Array
    stiffness: Array
    stiffness_mu: Array


class Brake:
    """A brake assembled from its coupling tables. Immutable; SI units.

    Attributes
    ----------
    freedoms : names of the degrees of freedom, "body.x", "body.y" or "body.phi", in the order of all vectors
    elements, torsions : coupling tables g and h with numbers
    mu, slope_s_m, piston_area_m2, effective_radius_m : operating values of the brake file
    """

    def __init__(self, spec: BrakeSpec) -> None:
        self.spec = spec
        self.name = spec.name
        self.mu = spec.operating.mu.value
        self.slope_s_m = spec.operating.slope.value
        self.piston_area_m2 = spec.operating.piston_area.value
        self.effective_radius_m = spec.operating.effective_radius.value
        self.structure = Structure(spec)
        self.freedoms = self.structure.freedoms
        self._index = {name: i for i, name in enumerate(self.freedoms)}
        values = np.array([parameter.value for parameter in spec.parameters.values()])
        places = self.structure.formulas.values(values)
        self._cubic = {
            name: float(value)
            for name, value in zip(self.structure.places, places, strict=True)
            if name.rsplit(".", 1)[1].startswith("cubic")
        }
        self._lines = self.structure.lines(places)
        self.inertia = self._lines.inertia
        self.elements = tuple(self._element(i, coupling) for i, coupling in enumerate(spec.couplings))
        self.torsions = tuple(
            TorsionElement(
                torsion.name,
                self._lines.rows[i],
                float(self._lines.stiffness[i]),
                float(self._lines.damping[i]),
                self._cubic.get(f"{torsion.name}.cubic", 0.0),
            )
            for i, torsion in enumerate(spec.torsions, start=2 * len(spec.couplings))
        )

    # -- structure
    # -------------------------------------------------------------------------------------------------

    @property
    def n_dof(self) -> int:
        """Number of degrees of freedom."""
        return len(self.freedoms)

    @cached_property
    def contacts(self) -> tuple[Element, ...]:
        """The friction contacts, in the order of table g."""
        return tuple(element for element in self.elements if element.side)

    def freedom_index(self, name: str) -> int:
        """Index of a degree of freedom ("disc.y") in all vectors.

        Raises
        ------
        KeyError
            unknown name; the message lists the known ones
        """
        if name not in self._index:
            raise KeyError(f"unknown degree of freedom {name!r}; the brake has: {', '.join(self.freedoms)}")
        return self._index[name]

    def with_parameters(self, **changes: float) -> Brake:
        """Return the same brake with other parameter values (SI), checked as a file is.

        Raises
        ------
        KeyError
            unknown parameter
        pydantic.ValidationError
            the changed brake is refused
        """
        return Brake(self.spec.with_values(changes))

    def _element(self, number: int, coupling: Spring | Contact) -> Element:
        lines, (x, y) = self._lines, (2 * number, 2 * number + 1)
        contact = isinstance(coupling, Contact)
        keys = ("", "cubic") if contact else ("cubic_x", "cubic_y")
        cubic_x, cubic_y = (self._cubic.get(f"{coupling.name}.{key}", 0.0) for key in keys)
        return Element(
            coupling.name,
            lines.rows[x],
            lines.rows[y],
            (float(lines.stiffness[x]), float(lines.stiffness[y])),
            (float(lines.damping[x]), float(lines.damping[y])),
            side=coupling.side if contact else 0,
            load_share=coupling.load_share if contact else 0.0,
            pad=coupling.between[0].split(".")[0] if contact else "",
            cubic_n_m3=(cubic_x, cubic_y),
            one_sided=contact and coupling.one_sided,
        )

    # -- forces: the loop over coupling elements
    # ---------------------------------------------------------------------

    def coupling_forces(
        self,
        displacement: Array,
        velocity: Array,
        friction: ContactFriction,
        pad_force_n: float | None = None,
    ) -> tuple[Array, Array]:
        """Forces and moments of all coupling elements by their laws, linear or not (eqs 8, 9), as they act on
        the second body.

        Parameters
        ----------
        displacement, velocity : (n_dof,) m or rad, m/s or rad/s, from the steadily sliding state
        friction : deviation of each contact's friction force from its mean
        pad_force_n : mean normal force of one pad; needed where a contact is one-sided

        Returns
        -------
        forces : (n_elements, 2) N along x and y (eqs 8, 16)
        moments : (n_torsions,) N m (eqs 9, 17)

        Raises
        ------
        ValueError
            a contact is one-sided and the pad force is not given
        """
        forces = np.zeros((len(self.elements), 2))
        contact = 0
        for index, element in enumerate(self.elements):
            dx, dy = element.row_x @ displacement, element.row_y @ displacement
            vx, vy = element.row_x @ velocity, element.row_y @ velocity
            for axis, u, v in ((0, dx, vx), (1, dy, vy)):  # eqs 8, 16
                spring = spring_force(element.stiffness_n_m[axis], element.cubic_n_m3[axis], u)
                forces[index, axis] = spring + element.damping_ns_m[axis] * v
            if element.one_sided:
                if pad_force_n is None:
                    raise ValueError(f"the contact '{element.name}' is one-sided: give pad_force_n")
                pressed = max(element.side * forces[index, 1], -element.load_share * pad_force_n)
                forces[index, 1] = element.side * pressed
            if element.side:
                # -F acts on the pad, so friction towards +x on the pad enters with a minus
                forces[index, 0] -= friction(contact, float(vx), float(element.side * forces[index, 1]))
                contact += 1
        moments = np.array(
            [
                spring_force(t.stiffness_nm_rad, t.cubic_nm_rad3, t.row @ displacement)
                + t.damping_nms_rad * (t.row @ velocity)
                for t in self.torsions
            ]
        )  # eqs 9, 17
        return forces, moments

    def accelerations(
        self,
        displacement: Array,
        velocity: Array,
        friction: ContactFriction,
        external: Array | None = None,
        pad_force_n: float | None = None,
    ) -> Array:
        """Accelerations (n_dof,) by Newton and Euler (eqs 2, 3) from the loop over couplings (eqs 6, 7).

        `external`: (n_dof,) forces and moments on the bodies (N, N m); `pad_force_n` as in `coupling_forces`.
        """
        forces, moments = self.coupling_forces(displacement, velocity, friction, pad_force_n)
        total = np.zeros(self.n_dof) if external is None else external.astype(float)
        for element, force in zip(self.elements, forces, strict=True):
            total = total - element.row_x * force[0] - element.row_y * force[1]  # eqs 6, 7, 12, 13
        for torsion, moment in zip(self.torsions, moments, strict=True):
            total = total - torsion.row * moment  # eqs 7, 14, 15
        return total / self.inertia  # eqs 2, 3

    # -- matrices
    # ------------------------------------------------------------------------------------------------------

    @cached_property
    def mass_matrix(self) -> Array:
        """M, (n_dof, n_dof), kg and kg m2 (eq 5)."""
        return np.diag(self.inertia)

    @cached_property
    def _parts(self) -> LinearParts:
        return linear_parts(self.structure, self._lines)

    def stiffness_matrix(self, mu: float = 0.0) -> Array:
        """K(mu), (n_dof, n_dof); not symmetric for mu > 0 (nonconservative forces, section 2.2)."""
        return self._parts.stiffness + mu * self._parts.stiffness_mu

    def damping_matrix(self, mu: float = 0.0, slope_s_m: float = 0.0, pad_force_n: float = 0.0) -> Array:
        """D(mu, k, N), (n_dof, n_dof); falling friction of slope k adds negative damping k N (eq 31)."""
        p = self._parts
        return p.damping + mu * p.damping_mu + slope_s_m * pad_force_n * p.damping_kn

    def pad_force_n(self, pressure_pa: float) -> float:
        """Mean normal force of one pad at a brake pressure."""
        return pressure_pa * self.piston_area_m2

    def state_matrix(
        self, mu: float | None = None, slope_s_m: float | None = None, pressure_pa: float = 0.0
    ) -> Array:
        """State matrix A of (displacements, velocities), (2 n_dof, 2 n_dof) (eq 27).

        Parameters
        ----------
        mu : coefficient of friction; the brake file's where None
        slope_s_m : falling slope k of the friction law (eq 28); the brake file's where None
        pressure_pa : brake pressure
        """
        mu = self.mu if mu is None else mu
        slope = self.slope_s_m if slope_s_m is None else slope_s_m
        n = self.n_dof
        matrix = np.zeros((2 * n, 2 * n))
        matrix[:n, n:] = np.eye(n)
        matrix[n:, :n] = -self.stiffness_matrix(mu) / self.inertia[:, None]  # eq 27
        matrix[n:, n:] = (
            -self.damping_matrix(mu, slope, self.pad_force_n(pressure_pa)) / self.inertia[:, None]
        )
        return matrix


def linear_parts(structure: Structure, lines: Lines, change: Lines | None = None) -> LinearParts:
    """Matrices of coupling lines; with `change`, their derivatives along that change of the lines.

    Friction at a contact: F_x = -mu N~ with N~ = side (c du_y + d dv_y), and -k N w dv_x (eqs 28, 31).
    """
    pairs = np.array([(x, y) for x, y, _, _ in structure.contacts])
    side = np.array([side for *_, side, _ in structure.contacts], dtype=float)
    share = np.array([share for *_, share in structure.contacts])
    x, y = lines.rows[pairs[:, 0]], lines.rows[pairs[:, 1]]
    if change is None:
        c_side, d_side = side * lines.stiffness[pairs[:, 1]], side * lines.damping[pairs[:, 1]]
        return LinearParts(
            lines.inertia,
            _sum(lines.rows, lines.damping, lines.rows),
            _sum(x, -d_side, y),
            _sum(x, -share, x),
            _sum(lines.rows, lines.stiffness, lines.rows),
            _sum(x, -c_side, y),
        )
    dx, dy = change.rows[pairs[:, 0]], change.rows[pairs[:, 1]]

    def own(values: Array, rates: Array) -> Array:
        mixed = _sum(change.rows, values, lines.rows)
        return _sum(lines.rows, rates, lines.rows) + mixed + mixed.T

    def across(values: Array, rates: Array) -> Array:
        values, rates = -side * values[pairs[:, 1]], -side * rates[pairs[:, 1]]
        return _sum(x, rates, y) + _sum(dx, values, y) + _sum(x, values, dy)

    slipping = _sum(dx, -share, x)
    return LinearParts(
        change.inertia,
        own(lines.damping, change.damping),
        across(lines.damping, change.damping),
        slipping + slipping.T,
        own(lines.stiffness, change.stiffness),
        across(lines.stiffness, change.stiffness),
    )


def _sum(left: Array, factors: Array, right: Array) -> Array:
    """Sum over lines of factor * outer(left, right)."""
    return (left * factors[:, None]).T @ right


def load_brake(path: str | Path) -> Brake:
    """Read a brake file and assemble it.

    Raises
    ------
    OSError, tomllib.TOMLDecodeError, pydantic.ValidationError
        not readable, not TOML, refused (see `spec`)
    """
    return Brake(load_spec(path))

"""Slow, tight time integration of the same brake by a general-purpose method: what the fast one is measured
against.

Written from the coupling table element by element (eqs 6-17), per contact, in displacements and velocities:
no modes, no matrices, nothing shared with `kernels`. Valid while all pads slide forwards and no pad lifts
off: set-valued friction is not for a smooth method; `motion` refuses to return a motion that left this range.
NOT its job: speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sim_hardware.brake_model.assembly import Array, Brake
from sim_hardware.brake_model.friction import FrictionLaw
from sim_hardware.brake_model.laws import require_linear


@dataclass(frozen=True)
class WorkingPoint:
    """Constant working point: one pad's mean normal force (N), sliding speed (m/s) and the friction law."""

    pad_force_n: float
    slip_m_s: float
    law: FrictionLaw


class ReferenceModel:
    """Right-hand side of the equations of motion at a working point, relative to the steadily sliding state.

    `evaluations` counts calls of the right-hand side. Linear couplings only; others raise ValueError.
    """

    def __init__(self, brake: Brake, point: WorkingPoint) -> None:
        require_linear(brake, "the reference integrator")
        self.point = point
        self.inertia = brake.inertia
        self.evaluations = 0
        self._n = brake.n_dof
        self._rows = np.vstack(
            [row for e in brake.elements for row in (e.row_x, e.row_y)] + [t.row for t in brake.torsions]
        )
        self._stiffness = np.array(
            [c for e in brake.elements for c in e.stiffness_n_m]
            + [t.stiffness_nm_rad for t in brake.torsions]
        )
        self._damping = np.array(
            [d for e in brake.elements for d in e.damping_ns_m] + [t.damping_nms_rad for t in brake.torsions]
        )
        contacts = [i for i, e in enumerate(brake.elements) if e.side]
        self._slip_lines = np.array([2 * i for i in contacts])
        self._side = np.array([brake.elements[i].side for i in contacts], dtype=float)
        self._mean_force = np.array([brake.elements[i].load_share for i in contacts]) * point.pad_force_n

    def friction(self, strain_rate: Array, forces: Array) -> tuple[Array, Array, Array]:
        """Friction deviation, sliding speed and normal force of every contact, from rates and forces of all
        lines."""
        point = self.point
        speed = point.slip_m_s - strain_rate[self._slip_lines]
        normal = self._mean_force + self._side * forces[self._slip_lines + 1]
        mu = point.law.mu(speed, point.slip_m_s)
        return mu * normal * np.sign(speed) - point.law.mu_mean * self._mean_force, speed, normal

    def lines(self, state: Array) -> tuple[Array, Array]:
        """Relative velocities and linear forces of all coupling lines (eqs 8-11, 16, 17)."""
        strain, rate = self._rows @ state[: self._n], self._rows @ state[self._n :]
        return rate, self._stiffness * strain + self._damping * rate

    def __call__(self, time_s: float, state: Array) -> Array:
        """Return the derivative of (displacements, velocities)."""
        self.evaluations += 1
        rate, forces = self.lines(state)
        forces[self._slip_lines] -= self.friction(rate, forces)[0]
        return np.concatenate([state[self._n :], -(self._rows.T @ forces) / self.inertia])  # eqs 2, 3, 6, 7


def motion(
    brake: Brake,
    point: WorkingPoint,
    state: Array,
    times_s: Array,
    *,
    method: str = "DOP853",
    rtol: float = 1e-10,
    atol: float = 1e-14,
) -> Array:
    """Integrate from `state` at times_s[0]; return states (len(times_s), 2 n_dof).

    Raises
    ------
    ArithmeticError
        the solver failed, or a contact reversed its slip or lifted off
    """
    from scipy.integrate import solve_ivp

    model = ReferenceModel(brake, point)
    solution = solve_ivp(
        model, (times_s[0], times_s[-1]), state, method=method, t_eval=times_s, rtol=rtol, atol=atol
    )
    if not solution.success:
        raise ArithmeticError(f"{method} gave up at {solution.t[-1]:.6f} s: {solution.message}")
    states = solution.y.T
    speed, normal = math.inf, math.inf
    for row in states:
        rate, forces = model.lines(row)
        _, speeds, normals = model.friction(rate, forces)
        speed, normal = min(speed, float(speeds.min())), min(normal, float(normals.min()))
    if speed <= 0.0 or normal < 0.0:
        raise ArithmeticError(
            f"the motion left the range of the reference: least slip {speed:.3g} m/s, "
            f"least contact force {normal:.3g} N"
        )
    return states

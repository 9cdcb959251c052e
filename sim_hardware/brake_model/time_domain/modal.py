"""Exact propagation of the linear brake in complex modes, with the friction deviation as input.

The linear brake (constant mu_ref, no falling slope) is x' = A x + B g, with one input g per friction group:
contacts that slide along the same direction of motion (the two contacts of a rigid pad) share one scalar
friction force. In modes eta = V^-1 x each equation is eta' = lambda eta + b g and is integrated exactly for a
polynomial g(t).

Main step (exponential Adams-Moulton, predicted once): g(t) over the step is the polynomial through its new
value and the last four; the new value is the friction law at the contact motion predicted with g extrapolated
through the last four. The prediction error enters only through what one step of friction does to the slip,
about 1e-3 of it, so that the law is evaluated once per step and the accuracy is that of the implicit method:

    eta[n+1] = E eta[n] + W_new g[n+1] + sum_i W_i g[n-i],  i = 0..3

and with s = eta - sum_i R_i g[n-i], i = 0..3, the same recursion needs one input vector only:

    s[n+1] = E s[n] + beta g[n],   R_0 = W_new,   W_0 = beta + R_1 - E R_0,   W_i = R_(i+1) - E R_i

so that the high order costs no more than a low one. Fine step (around slip reversals): g linear over the step
between its two ends (first-order hold), the end value implicit.
NOT its job: the friction law, the recursion itself (`kernels`), choice of outputs (`outputs`).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.assembly import Array, Brake, Element
from sim_hardware.brake_model.laws import require_linear
from sim_hardware.brake_model.rigid_body import freely_moving

Complex = NDArray[np.complex128]

#: modes are padded with zeros to a multiple of this, for the vector unit
MODE_BLOCK = 16
_WORST_CONDITION = 1e10


@dataclass(frozen=True)
class FrictionGroup:
    """Contacts of one pad that slide along one direction of motion.

    Attributes
    ----------
    slip_row : (n_dof,) pad minus disc velocity along x per degree of freedom
    load_share : part of the pad force it carries
    """

    pad: str
    slip_row: Array
    load_share: float
    contacts: tuple[Element, ...]


def friction_groups(brake: Brake) -> tuple[FrictionGroup, ...]:
    """Group the contacts of each pad by their slip direction, in the order of the coupling table."""
    groups: list[list[Element]] = []
    for contact in brake.contacts:
        for group in groups:
            if group[0].pad == contact.pad and np.allclose(
                group[0].row_x, contact.row_x, rtol=1e-12, atol=1e-15
            ):
                group.append(contact)
                break
        else:
            groups.append([contact])
    return tuple(FrictionGroup(g[0].pad, g[0].row_x, sum(c.load_share for c in g), tuple(g)) for g in groups)


@dataclass(frozen=True)
class ModalSystem:
    """The linear brake in modes. One mode per conjugate pair (weight 2) or real eigenvalue (weight 1).

    Attributes
    ----------
    groups : friction groups, the inputs
    state_matrix, input_matrix : A (2 n_dof, 2 n_dof) and B (2 n_dof, n_groups)
    eigenvalues : (m,) 1/s
    vectors : (2 n_dof, m) state = Re(vectors @ eta), weights included
    inverse : (m, 2 n_dof) eta = inverse @ state
    inputs : (m, n_groups) b
    contact_rows : (2 n_groups, 2 n_dof) slip variation (m/s) and compression variation (N) of each group from
        the state
    """

    mu_ref: float
    groups: tuple[FrictionGroup, ...]
    state_matrix: Array
    input_matrix: Array
    eigenvalues: Complex
    vectors: Complex
    inverse: Complex
    inputs: Complex
    contact_rows: Array


def modal_system(brake: Brake, mu_ref: float) -> ModalSystem:
    """Diagonalise the brake with constant friction mu_ref.

    Raises
    ------
    ValueError
        a coupling has a cubic or one-sided law (`motion` integrates those), or the state matrix has no
        complete set of eigenvectors (a rigid-body motion, or exactly coupled modes)
    """
    require_linear(brake, "the fixed-rate integration in modes")
    n = brake.n_dof
    groups = friction_groups(brake)
    matrix = brake.state_matrix(mu_ref, 0.0, 0.0)
    inputs = np.zeros((2 * n, len(groups)))
    rows = np.zeros((2 * len(groups), 2 * n))
    for index, group in enumerate(groups):
        inputs[n:, index] = group.slip_row / brake.inertia
        rows[2 * index, n:] = group.slip_row
        for contact in group.contacts:
            rows[2 * index + 1, :n] += contact.side * contact.stiffness_n_m[1] * contact.row_y
            rows[2 * index + 1, n:] += contact.side * contact.damping_ns_m[1] * contact.row_y
    decomposition = np.linalg.eig(matrix)
    values: Complex = decomposition[0].astype(complex)
    vectors: Complex = decomposition[1].astype(complex)
    scaled = vectors / np.linalg.norm(vectors, axis=0)
    # displacements and velocities differ by the frequency: judge the condition on balanced vectors
    balance = np.concatenate([np.full(n, np.abs(values).max()), np.ones(n)])
    condition = np.linalg.cond(balance[:, None] * scaled / np.linalg.norm(balance[:, None] * scaled, axis=0))
    free = freely_moving(brake.freedoms, matrix)
    if free:
        raise ValueError(
            f"the brake '{brake.name}' has rigid-body motions ({', '.join(free)}) that no spring or damper "
            "holds; couple those bodies, or integrate with motion.integrate (rigctl model simulate)"
        )
    if not np.isfinite(condition) or condition > _WORST_CONDITION:
        raise ValueError(
            f"the brake '{brake.name}' at mu = {mu_ref:g} has no complete set of modes "
            f"(condition {condition:.1e}); choose a slightly different mu_ref"
        )
    inverse = np.linalg.inv(vectors)
    kept = values.imag >= 0.0
    weight = np.where(values.imag > 0.0, 2.0, 1.0)[kept]
    return ModalSystem(
        mu_ref,
        groups,
        matrix,
        inputs,
        values[kept].astype(complex),
        (vectors[:, kept] * weight).astype(complex),
        inverse[kept].astype(complex),
        (inverse @ inputs)[kept].astype(complex),
        rows,
    )


def moments(exponent: Complex, count: int) -> Complex:
    """Return integrals of exp(x (1 - t)) t^m over 0..1 for m = 0..count-1, shape (count, *x.shape).

    They are m! phi_(m+1)(x); backward recursion from a series for small |x|, forward recursion otherwise.
    """
    x = np.asarray(exponent, dtype=complex)
    phi = np.zeros((count + 1, *x.shape), dtype=complex)
    small = np.abs(x) < 1.0
    series = np.zeros_like(x)
    for term in range(24, -1, -1):  # phi_count(x) = sum_j x^j / (j + count)!
        series = series * x + 1.0 / factorial(term + count)
    backward = series
    phi_small = [backward]
    for order in range(count - 1, -1, -1):
        backward = backward * x + 1.0 / factorial(order)
        phi_small.append(backward)
    phi_small.reverse()
    with np.errstate(all="ignore"):
        forward = np.exp(x)
        phi[0] = forward
        for order in range(count):
            forward = np.where(
                small, phi_small[order + 1], (phi[order] - 1.0 / factorial(order)) / np.where(small, 1.0, x)
            )
            phi[order + 1] = forward
    return np.stack([factorial(m) * phi[m + 1] for m in range(count)])


def hold_weights(eigenvalues: Complex, step_s: float, nodes: Array) -> Complex:
    """Weights of exact propagation for an input that is the polynomial through given values.

    Parameters
    ----------
    eigenvalues : (m,) 1/s
    step_s : length of the step
    nodes : (k,) times of the values in steps, 0 = start, 1 = end

    Returns
    -------
    (k, m) : eta(end) = exp(lambda step) eta(start) + b * sum_i weights[i] g(nodes[i])
    """
    basis = np.linalg.inv(
        np.vander(nodes, increasing=True)
    )  # column i: coefficients of the Lagrange polynomial i
    return step_s * (basis.T @ moments(eigenvalues * step_s, len(nodes)))


@dataclass(frozen=True)
class MultistepForm:
    """Coefficients of the main step in the s form (module docstring), per mode.

    rotation : (m,) E; drive : (m, n_groups) beta; history : (4, m, n_groups) R; hold : (m, n_groups) for a
        constant input
    """

    rotation: Complex
    drive: Complex
    history: Complex
    hold: Complex


#: times, in steps, of the values of g that the main step's polynomial runs through: new, present, three past
NODES = np.array([1.0, 0.0, -1.0, -2.0, -3.0])
#: extrapolation of g to the new time from the present and three past values (cubic)
EXTRAPOLATION = np.array([4.0, -6.0, 4.0, -1.0])


def multistep_form(system: ModalSystem, step_s: float) -> MultistepForm:
    """Discretise for the main step of length `step_s`."""
    new, *past = hold_weights(system.eigenvalues, step_s, NODES)
    rotation = np.exp(system.eigenvalues * step_s)
    history = np.zeros((len(past), len(rotation)), dtype=complex)
    following = np.zeros_like(rotation)  # no term beyond the last
    for i in range(len(past) - 1, 0, -1):
        following = (following - past[i]) / rotation  # R_i = (R_(i+1) - W_i) / E
        history[i] = following
    history[0] = new
    drive = past[0] - history[1] + rotation * new  # beta
    return MultistepForm(
        rotation,
        drive[:, None] * system.inputs,
        history[:, :, None] * system.inputs,
        (new + sum(past))[:, None] * system.inputs,
    )

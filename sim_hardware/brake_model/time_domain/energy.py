"""Energy of a moving brake: the linear energy of section 4.4 (eq 26), its decay, and the balance of all
powers.

E^l = x^T diag(K, M) x / 2 with K taken from the system matrix A (eq 27), as the paper does: K contains the
friction mu N~ and is not symmetric, but a quadratic form sees its symmetric part only, so that nothing has to
be chosen. E^l is a measure, not a conserved quantity: friction feeds it through the rest of K, and what the
cubic springs store beyond their linear part is left out. Mode shapes scaled to E^l(0) = 1 N m start the
motions whose decay is compared, linear with cubic (Fig. 11).
`balance` is the physical energy: stored in all springs as they are, fed in by friction, lost in dampers.
NOT its job: integration (`motion`), figures.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.assembly import Array, Brake
from sim_hardware.brake_model.friction import ConstantFriction
from sim_hardware.brake_model.laws import one_sided_energy, release_strain, spring_energy, with_cubic_contacts
from sim_hardware.brake_model.time_domain.modal import friction_groups
from sim_hardware.brake_model.time_domain.motion import Motion, integrate
from sim_hardware.brake_model.time_domain.reference import WorkingPoint

#: energy of the initial states of section 4.4 (N m)
INITIAL_NM = 1.0
#: share of the energy that is left at the end of the window in which decays are compared, in the linear case
_LEFT = 0.1
_SAMPLES_PER_PERIOD = 16
_LEAST_SAMPLES = 400
_REAL = 1e-9
#: as `friction` has it
_LARGEST_MU = 2.0


def linear_energy(brake: Brake, states: Array, mu: float | None = None) -> Array:
    """Linear energy E^l of states (eq 26).

    Parameters
    ----------
    states : (..., 2 n_dof) displacements and velocities
    mu : coefficient of friction in K; the brake file's where None

    Returns
    -------
    (...) N m

    Raises
    ------
    ValueError
        the symmetric part of K is not positive definite or semidefinite: E^l would not measure anything
    """
    n, mu = brake.n_dof, brake.mu if mu is None else mu
    stiffness = brake.stiffness_matrix(mu)
    symmetric = 0.5 * (stiffness + stiffness.T)
    least = np.linalg.eigvalsh(symmetric)
    if least[0] < -1e-9 * least[-1]:
        raise ValueError(
            f"the stiffness matrix of brake '{brake.name}' is not positive at mu = {mu:g} (friction "
            "outweighs the springs): the linear energy of eq 26 measures nothing there; lower mu"
        )
    q, v = states[..., :n], states[..., n:]
    return 0.5 * (np.einsum("...i,ij,...j->...", q, symmetric, q) + (v**2) @ brake.inertia)  # eq 26


@dataclass(frozen=True)
class ModeStart:
    """Initial state along the mode shape of an eigenvalue pair, scaled to an energy.

    Attributes
    ----------
    index : 1 for the pair of lowest frequency; the paper's eigenvalues i = 2 index - 1, 2 index
    eigenvalue : 1/s, the one with positive imaginary part; real ones have a mode of their own
    state : (2 n_dof,)
    """

    index: int
    eigenvalue: complex
    state: Array

    @property
    def frequency_hz(self) -> float:
        """Frequency of the linear motion."""
        return abs(self.eigenvalue.imag) / (2.0 * math.pi)

    @property
    def energy_decay_1_s(self) -> float:
        """Rate at which the linear energy falls, -2 Re: E^l ~ exp(-rate t)."""
        return -2.0 * self.eigenvalue.real


def mode_starts(
    brake: Brake, mu: float | None = None, energy_nm: float = INITIAL_NM
) -> tuple[ModeStart, ...]:
    """Initial states along all mode shapes, sorted by frequency (section 4.4.1).

    The phase is that of least energy in the springs: the motion starts as it swings through, with nearly all
    energy kinetic. So a cubic brake starts with the same whole energy as the linear one; from a turning point
    it would hold more in its springs, which would come out as E^l later and look like excitation.
    """
    mu = brake.mu if mu is None else mu
    n = brake.n_dof
    decomposition = np.linalg.eig(brake.state_matrix(mu, 0.0, 0.0))
    values: NDArray[np.complex128] = decomposition[0].astype(complex)
    vectors: NDArray[np.complex128] = decomposition[1].astype(complex)
    kept = np.flatnonzero(values.imag >= -_REAL * np.abs(values))
    order = kept[np.lexsort((values[kept].real, np.round(np.abs(values[kept].imag), 6)))]
    stiffness = brake.stiffness_matrix(mu)
    starts = []
    for index, k in enumerate(order, start=1):
        parts = np.stack(
            [vectors[:, k].real, -vectors[:, k].imag]
        )  # Re(v exp(i a)) = parts by (cos a, sin a)
        stored = parts[:, :n] @ (stiffness + stiffness.T) @ parts[:, :n].T
        shape = np.linalg.eigh(stored)[1][:, 0] @ parts
        energy = float(linear_energy(brake, shape, mu))
        starts.append(ModeStart(index, complex(values[k]), shape * math.sqrt(energy_nm / energy)))
    return tuple(starts)


@dataclass(frozen=True)
class Decay:
    """Decay of the linear energy from a mode shape, linear and with cubic contacts.

    Attributes
    ----------
    start : the mode
    times_s : (N,) the window ends when the linear energy has fallen to a tenth (for one that does not decay:
        has risen tenfold)
    linear_nm : (N,) E^l of the linear brake
    strengths : (S,) factors on c3
    cubic_nm : (S, N) E^l with cubic contacts
    rates_1_s : (1 + S,) `loss_rate` over the window, of the linear case and of each strength; > 0 decays
    largest_compression_m : (C,) of each contact in the linear case
    largest_variation_n : (C,) of each contact's normal force in the linear case
    hidden_nm : (S,) energy that the cubic springs hold at the start beyond their linear part: E^l does not
        count it, and it comes out as E^l later
    """

    start: ModeStart
    times_s: Array
    linear_nm: Array
    strengths: tuple[float, ...]
    cubic_nm: Array
    rates_1_s: Array
    largest_compression_m: Array
    largest_variation_n: Array
    hidden_nm: Array

    @property
    def changes(self) -> Array:
        """(S,) relative change of the rate of decay; > 0: the cubic springs stabilise."""
        return self.rates_1_s[1:] / self.rates_1_s[0] - 1.0


def decays(
    brake: Brake,
    strengths: Sequence[float] = (1.0, 10.0, 100.0, 1000.0),
    *,
    mu: float | None = None,
    doubled_at_m: float = 50e-6,
    energy_nm: float = INITIAL_NM,
    windows: float = 1.0,
    rtol: float = 1e-8,
) -> tuple[Decay, ...]:
    """Linear against cubic decay for every mode shape (section 4.4).

    Friction as in the paper: mu N towards +x always (`motion.integrate`, `always_sliding`). At 1 N m this is
    a thought experiment: the contact forces vary by several times any pad force, real pads would lift off.

    Parameters
    ----------
    brake : its own cubic laws at the contacts are replaced
    strengths : factors on the c3 that doubles the contact stiffness at `doubled_at_m`
    mu : constant coefficient of friction; the brake file's where None
    energy_nm : E^l at the start
    windows : length of the motions in units of the time in which the linear energy falls to a tenth
    rtol : tolerance of the integration

    Raises
    ------
    ValueError
        strengths negative, one-sided contacts, K not positive (see `linear_energy`)
    ArithmeticError
        an integration failed
    """
    mu = brake.mu if mu is None else mu
    if not (math.isfinite(energy_nm) and energy_nm > 0.0 and math.isfinite(windows) and windows > 0.0):
        raise ValueError(f"energy {energy_nm!r} N m, windows {windows!r}: give positive, finite numbers")
    if not 0.0 <= mu <= _LARGEST_MU:
        raise ValueError(f"mu is {mu!r}: give a coefficient of friction from 0 to {_LARGEST_MU:g}")
    point = WorkingPoint(0.0, 1.0, ConstantFriction(mu_mean=mu))
    variants = [with_cubic_contacts(brake, doubled_at_m=doubled_at_m, strength=s) for s in (0.0, *strengths)]
    rows = np.array([c.side * c.row_y for c in brake.contacts])
    found = []
    for start in mode_starts(brake, mu, energy_nm):
        rate = max(abs(start.energy_decay_1_s), 1e-3 * abs(start.eigenvalue))
        if rate == 0.0:
            continue  # a rigid-body motion: nothing stored, nothing decays
        duration = windows * math.log(1.0 / _LEFT) / rate
        count = max(_LEAST_SAMPLES, math.ceil(_SAMPLES_PER_PERIOD * start.frequency_hz * duration))
        times = np.linspace(0.0, duration, count + 1)
        motions = [integrate(b, point, start.state, times, always_sliding=True, rtol=rtol) for b in variants]
        energies = np.array([linear_energy(brake, m.states, mu) for m in motions])
        inside = times <= duration / windows * (1.0 + 1e-12)
        rates = np.array([loss_rate(e[inside], times[inside]) for e in energies])
        found.append(
            Decay(
                start,
                times,
                energies[0],
                tuple(float(s) for s in strengths),
                energies[1:],
                rates,
                np.abs(motions[0].states[:, : brake.n_dof] @ rows.T).max(axis=0),
                np.abs(motions[0].normal_n).max(axis=0),
                np.array([_hidden(b, start.state[: brake.n_dof]) for b in variants[1:]]),
            )
        )
    return tuple(found)


def loss_rate(energy_nm: Array, times_s: Array) -> float:
    """Energy lost over energy held, (E(0) - E(T)) / integral of E dt (1/s): the rate itself for exp(-rate t).

    It weighs the whole course by the energy there is: a motion that grows before it decays has a lower rate,
    which a line fitted to ln E would not show.
    """
    return float((energy_nm[0] - energy_nm[-1]) / _integral(energy_nm, times_s)[-1])


def _hidden(brake: Brake, displacements: Array) -> float:
    """Energy in the cubic parts of the contact springs (N m)."""
    return float(sum(spring_energy(0.0, c.cubic_n_m3[1], c.row_y @ displacements) for c in brake.contacts))


@dataclass(frozen=True)
class EnergyBalance:
    """Physical energy of the motion relative to the steadily sliding state. All (N,), N m.

    Attributes
    ----------
    kinetic, stored : motion of the bodies; springs as they are, cubic and one-sided parts included
    friction_work : done on the vibration by the deviation of the friction forces from their mean, since
        times_s[0]
    dissipated : in dampers, since times_s[0]
    error : kinetic + stored - friction_work + dissipated, minus its value at the start: what integration and
        the trapezoidal rule over the given times leave
    """

    kinetic: Array
    stored: Array
    friction_work: Array
    dissipated: Array
    error: Array


def balance(motion: Motion) -> EnergyBalance:
    """Balance of all energies over a recorded motion; its times must resolve the vibration.

    Valid for a constant pad force (a varying one does work on one-sided contacts).
    """
    brake, n = motion.brake, motion.brake.n_dof
    q, v, t = motion.states[:, :n], motion.states[:, n:], motion.times_s
    work = motion.course.at(t)
    stored, lost = np.zeros(len(t)), np.zeros(len(t))
    contact = 0
    for element in brake.elements:
        for axis, row in enumerate((element.row_x, element.row_y)):
            strain, rate = q @ row, v @ row
            stiffness, cubic = element.stiffness_n_m[axis], element.cubic_n_m3[axis]
            if not element.one_sided or axis == 0:
                stored += spring_energy(stiffness, cubic, strain)
                lost += element.damping_ns_m[axis] * rate**2
                continue
            mean = element.load_share * float(work[0, 0])
            pressed, speed = element.side * strain, element.side * rate
            stored += one_sided_energy(stiffness, cubic, mean, pressed)
            free = release_strain(stiffness, cubic, mean)
            spring = np.where(pressed > free, (stiffness + cubic * pressed**2) * pressed, -mean)
            lost += (motion.normal_n[:, contact] - mean - spring) * speed
        contact += bool(element.side)
    for torsion in brake.torsions:
        stored += spring_energy(torsion.stiffness_nm_rad, torsion.cubic_nm_rad3, q @ torsion.row)
        lost += torsion.damping_nms_rad * (v @ torsion.row) ** 2
    power = np.zeros(len(t))
    for g, group in enumerate(friction_groups(brake)):
        mean_friction = work[:, 1] * group.load_share * work[:, 0]
        power += (motion.friction_n[:, g] - mean_friction) * (v @ group.slip_row)
    kinetic = 0.5 * (v**2) @ brake.inertia
    friction_work, dissipated = _integral(power, t), _integral(lost, t)
    total = kinetic + stored - friction_work + dissipated
    return EnergyBalance(kinetic, stored, friction_work, dissipated, total - total[0])


def _integral(values: Array, times: Array) -> Array:
    """Integral from the first time, trapezoidal rule, (N,)."""
    return np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(times))])

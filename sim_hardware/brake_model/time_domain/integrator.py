"""The squealing brake in the time domain: what the plant calls block by block.

`SquealIntegrator` integrates the deviation of the brake from its steadily sliding state under the working
point given by the caller (pad force, friction law, sliding speed) and returns accelerations or other outputs
at the output rate. The linear brake is propagated exactly (`modal`), friction is evaluated at the pads only
(`kernels`).

Modelled: friction mu(v) (N0 + N~) with the varying normal force N~, reversal of slip and sticking, loss of
friction when a pad's normal force falls to zero. Not modelled: the normal contact springs stay linear when a
pad lifts off. NOT its job: where the working point comes from, sound, torque, noise generation.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from sim_hardware.brake_model.assembly import Array, Brake
from sim_hardware.brake_model.time_domain import contact
from sim_hardware.brake_model.time_domain.blocks import STEPS, advance_blocks, block_tables, suits
from sim_hardware.brake_model.time_domain.kernels import advance_general
from sim_hardware.brake_model.time_domain.modal import (
    EXTRAPOLATION,
    MODE_BLOCK,
    Complex,
    ModalSystem,
    hold_weights,
    modal_system,
    multistep_form,
)
from sim_hardware.brake_model.time_domain.outputs import output_rows

#: rate of the fine steps around slip reversals
FINE_HZ = 320_000.0
#: a mode that decays by more than this in one step cannot be carried in the s form
_FASTEST_DECAY = 1e-3
#: modes below this size are set to zero between calls, so that a brake at rest does not compute with
#: subnormal numbers
NEGLIGIBLE = 1e-100
#: main steps without a reversal of slip before blocks of steps are tried again
_PATIENCE = 64


class SquealIntegrator:
    """Time integration of one brake. Keeps its state between calls; deterministic.

    Parameters
    ----------
    brake : the brake
    mu_ref : friction of the linear part; any value gives the same motion, one near the actual mu gives it
        most exactly
    output_hz : rate of outputs and excitation
    substeps : internal steps per output interval. 1 (40 kHz) keeps squeal within 0.01 Hz and 0.01 dB of a
        tight reference (`tests/benchmarks/bench_brake_model.py`)
    outputs : names of the outputs, see `outputs`; default: acceleration of every degree of freedom
    weights : one per output: return their weighted sum as the only output (one row instead of many)
    fine_steps : first-order-hold steps per internal step around slip reversals; default reaches 320 kHz

    Attributes
    ----------
    n_pads : number of friction groups (one per rigid pad), columns of `excitation_n`
    pads : their names
    outputs : names of the outputs, columns of the result
    n_columns : number of columns of the result

    Raises
    ------
    KeyError
        unknown output
    ValueError
        rates not positive, no complete set of modes, internal rate too low for the brake, as many weights as
        outputs not given
    """

    def __init__(
        self,
        brake: Brake,
        *,
        mu_ref: float | None = None,
        output_hz: float = 40_000.0,
        substeps: int = 1,
        outputs: Sequence[str] | None = None,
        weights: Sequence[float] | None = None,
        fine_steps: int | None = None,
    ) -> None:
        if not (math.isfinite(output_hz) and output_hz > 0.0):
            raise ValueError(f"output_hz is {output_hz!r}; give a positive rate")
        if substeps < 1:
            raise ValueError(f"substeps is {substeps!r}; give at least 1")
        self.brake = brake
        self.output_hz = output_hz
        self.substeps = substeps
        self.outputs = brake.freedoms if outputs is None else tuple(outputs)
        fine = max(1, math.ceil(FINE_HZ / (output_hz * substeps))) if fine_steps is None else fine_steps
        if fine < 1:
            raise ValueError(f"fine_steps is {fine!r}; give at least 1")
        self._system = modal_system(brake, brake.mu if mu_ref is None else mu_ref)
        rows, direct = output_rows(brake, self._system, self.outputs)
        if weights is not None:
            if len(weights) != len(self.outputs):
                raise ValueError(f"{len(weights)} weights for {len(self.outputs)} outputs; give one each")
            rows, direct = np.array([weights]) @ rows, np.array([weights]) @ direct
        self.n_columns = len(rows)
        self._coefficients = discretise(
            brake, self._system, (rows, direct), 1.0 / (output_hz * substeps), substeps, fine
        )
        self.pads = tuple(group.pad for group in self._system.groups)
        self.n_pads = len(self.pads)
        self._flat, self._memory = _memory(self.n_pads, self._coefficients.modal.shape[2])
        self._motion = self._flat[: self._memory.modes.size + self._memory.history.size]
        self._blocks = block_tables(self._coefficients) if suits(self._coefficients) else None
        self._no_excitation = np.zeros((0, self.n_pads))
        self.reset()

    def reset(self) -> None:
        """Go to the steadily sliding state, without memory."""
        self._flat[:] = 0.0
        self._memory.flags[0] = contact.CALM  # zero is an exact history of that state

    def advance(
        self,
        n_out: int,
        *,
        normal_force_n: tuple[float, float],
        mu: tuple[float, float],
        slip_m_s: tuple[float, float],
        k_s_m: tuple[float, float] = (0.0, 0.0),
        saturation_m_s: float | None = None,
        excitation_n: Array | None = None,
    ) -> Array:
        """Integrate `n_out` output intervals and return the outputs at the start of each.

        Parameters
        ----------
        n_out : number of output intervals
        normal_force_n : (start, end) mean normal force of one pad, p A; here and below linear within the call
        mu : (start, end) coefficient of friction at the mean sliding speed
        slip_m_s : (start, end) mean sliding speed, >= 0. At 0 the pads stick: slow; better do not integrate
            then
        k_s_m : (start, end) falling slope of the friction law at the mean sliding speed
        saturation_m_s : size v_s of speed variation at which the slope fades (`friction`); None: linear law
            (eq 28)
        excitation_n : (n_out, n_pads) N, friction force from surface roughness, held over each output
            interval

        Returns
        -------
        (n_out, n_outputs) float64

        Raises
        ------
        ValueError
            wrong shape, negative pad force or sliding speed, values that are not finite
        FloatingPointError
            the motion grew out of all bounds (a brake unstable in its linear part)
        """
        values = (*normal_force_n, *mu, *slip_m_s, *k_s_m)
        excitation = self._checked_excitation(n_out, excitation_n)
        inverse_saturation = 0.0
        if saturation_m_s is not None:
            if not saturation_m_s > 0.0:
                raise ValueError(f"saturation_m_s is {saturation_m_s!r}; give a positive speed or None")
            inverse_saturation = 1.0 / saturation_m_s
        if not all(map(math.isfinite, values)) or min(*normal_force_n, *slip_m_s) < 0.0:
            raise ValueError(
                f"working point (pad force, mu, slip, k) {normal_force_n, mu, slip_m_s, k_s_m}: "
                "give finite values, pad force and slip >= 0"
            )
        out = np.empty((n_out, self.n_columns))
        if n_out:
            self._run(np.array(values).reshape(4, 2), inverse_saturation, excitation, out)
            size = float(np.dot(self._motion, self._motion))
            if not math.isfinite(size):
                raise FloatingPointError(
                    f"the motion of brake '{self.brake.name}' is not finite; check its stability at "
                    f"mu = {mu}, pad force {normal_force_n} N, k = {k_s_m} s/m, or give saturation_m_s"
                )
            if size < NEGLIGIBLE:
                self.reset()
        return out

    def _run(self, operation: Array, inverse_saturation: float, excitation: Array, out: Array) -> None:
        """All steps: blocks where they can be taken, single steps around slip reversals and for the rest."""
        c, flags = self._coefficients, self._memory.flags
        step, steps = 0, len(out) * self.substeps
        while step < steps:
            calm = flags[0] >= contact.CALM and flags[1] == contact.FROM_LAW
            if self._blocks is not None and calm and step + STEPS <= steps:
                step = advance_blocks(
                    self._blocks, self._flat, operation, inverse_saturation, c.mu_ref, c.substeps, step,
                    excitation, out,
                )  # fmt: skip
            if step < steps:
                patience = 0 if self._blocks is None else _PATIENCE
                step = advance_general(
                    c, self._memory, operation, inverse_saturation, step, patience, excitation, out
                )

    def _checked_excitation(self, n_out: int, excitation_n: Array | None) -> Array:
        if n_out < 0:
            raise ValueError(f"n_out is {n_out!r}; give 0 or more")
        if excitation_n is None:
            return self._no_excitation
        excitation = np.ascontiguousarray(excitation_n, dtype=float)
        if excitation.shape != (n_out, self.n_pads):
            raise ValueError(f"excitation_n has the shape {excitation.shape}; give ({n_out}, {self.n_pads})")
        return excitation

    # -- state
    # -----------------------------------------------------------------------------------------------------

    def memory(self) -> dict[str, Array]:
        """Return a copy of everything that changes; `restore` continues from it bit for bit."""
        return {name: array.copy() for name, array in self._memory._asdict().items()}

    def restore(self, memory: dict[str, Array]) -> None:
        """Continue from a copy made by `memory` of an integrator with the same settings."""
        for name, array in self._memory._asdict().items():
            array[...] = memory[name]

    @property
    def state(self) -> Array:
        """(2 n_dof,) displacements and velocities from the steadily sliding state (m, rad, m/s, rad/s)."""
        m, c = self._memory, self._coefficients
        eta = m.modes[0] + 1j * m.modes[1]
        if m.flags[1] != contact.FRESH:
            past = np.vstack([m.present, m.history]).ravel()
            rows = c.modal[c.history : c.history + len(past)]
            eta = eta + past @ (rows[:, 0] + 1j * rows[:, 1])
        return (self._system.vectors @ eta[: len(self._system.eigenvalues)]).real

    @state.setter
    def state(self, value: Array) -> None:
        """Start from displacements and velocities; the friction history is rebuilt by careful steps."""
        state = np.asarray(value, dtype=float)
        if state.shape != (2 * self.brake.n_dof,) or not np.isfinite(state).all():
            raise ValueError(f"state of shape {state.shape}: give {2 * self.brake.n_dof} finite values")
        self._flat[:] = 0.0
        eta = self._system.inverse @ state
        self._memory.modes[0, : len(eta)], self._memory.modes[1, : len(eta)] = eta.real, eta.imag
        self._memory.contact[:] = self._system.contact_rows @ state
        self._memory.flags[1] = contact.FRESH


def compile_kernels(brake: Brake) -> None:
    """Compile (or load from numba's cache) the kernels this brake needs, before anything moves."""
    integrator = SquealIntegrator(brake, outputs=())
    integrator.advance(  # a block of steps and a single one
        STEPS + 1, normal_force_n=(1.0, 1.0), mu=(0.4, 0.4), slip_m_s=(1.0, 1.0)
    )


def _memory(groups: int, modes: int) -> tuple[Array, contact.Memory]:
    """A flat memory and its parts by name, in the order that `blocks` expects."""
    shapes = {
        "modes": (2, modes),
        "history": (contact.PAST, groups),
        "contact": (2 * groups,),
        "present": (groups,),
        "flags": (2,),
    }
    flat = np.zeros(sum(math.prod(shape) for shape in shapes.values()))
    parts, start = {}, 0
    for name, shape in shapes.items():
        stop = start + math.prod(shape)
        parts[name] = flat[start:stop].reshape(shape)
        start = stop
    return flat, contact.Memory(**parts)


def discretise(
    brake: Brake,
    system: ModalSystem,
    outputs: tuple[Array, Array],
    step_s: float,
    substeps: int,
    fine_steps: int,
) -> contact.Coefficients:
    """Everything constant during a run with internal steps of `step_s`; `outputs` from `output_rows`.

    Raises
    ------
    ValueError
        internal rate too low for the brake
    """
    form = multistep_form(system, step_s)
    if np.abs(form.rotation).min() < _FASTEST_DECAY:
        raise ValueError(
            f"brake '{brake.name}': a mode decays within one internal step of {step_s:.2e} s; "
            "raise substeps or lower the damping of the coupling that causes it"
        )
    fine_s = step_s / fine_steps
    fine = hold_weights(system.eigenvalues, fine_s, np.array([0.0, 1.0]))[:, :, None] * system.inputs
    contacts = system.contact_rows @ system.vectors
    state_rows, direct = outputs
    output = state_rows @ system.vectors
    padded = max(1, -(-len(system.eigenvalues) // MODE_BLOCK)) * MODE_BLOCK
    history = form.history.transpose(0, 2, 1).reshape(-1, len(system.eigenvalues))  # (DEPTH * G, m)

    def past(values: Complex) -> Array:
        """Effect of the history terms of the s form on products with the modes: (rows, DEPTH, G)."""
        return np.ascontiguousarray(np.einsum("rm,dmg->rdg", values, form.history).real)

    # c z[n+1] = c (E s[n] + beta g[n]) + c R_0 g[n+1] + c R_1 g[n] + ..., with g[n+1] extrapolated
    late = past(contacts)
    ahead_history = EXTRAPOLATION[None, :, None] * late[:, :1, :]
    ahead_history[:, :-1, :] += late[:, 1:, :]
    ahead_history[:, 0, :] += (contacts @ form.drive).real
    kinds: dict[str, Complex] = {  # products take the real part: conjugate rows
        "rotation": form.rotation[None, :],
        "drive": form.drive.T,
        "hold": form.hold.T,
        "history": history,
        "contact": contacts.conj(),
        "ahead": (contacts * form.rotation).conj(),
        "fine_rotation": np.exp(system.eigenvalues * fine_s)[None, :],
        "fine_start": fine[0].T,
        "fine_end": fine[1].T,
        "output": output.conj(),
    }
    rows: Complex = np.vstack(list(kinds.values()))
    firsts, begin = {}, 0
    for kind, part in kinds.items():
        firsts[kind] = begin
        begin += len(part)
    modal = np.zeros((len(rows), 2, padded))
    modal[:, 0, : rows.shape[1]], modal[:, 1, : rows.shape[1]] = rows.real, rows.imag
    return contact.Coefficients(
        substeps=substeps,
        fine_steps=fine_steps,
        mu_ref=system.mu_ref,
        modal=modal,
        share=np.array([group.load_share for group in system.groups]),
        ahead_history=ahead_history,
        ahead_hold=np.ascontiguousarray((contacts @ form.hold).real),
        fine_end_contact=np.ascontiguousarray((contacts @ fine[1]).real),
        output_history=past(output),
        output_direct=np.ascontiguousarray(direct),
        **firsts,
    )

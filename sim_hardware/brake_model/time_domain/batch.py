"""Many brakings of the squealing brake at once: what studies call that need hundreds of them.

`BatchIntegrator` does what `integrator.SquealIntegrator` does, for many brakings ("lanes") side by side in
the vector unit: each with its own working point, start and excitation, if wanted with its own brake. The same
steps, the same numbers up to rounding (tests hold both together), whichever lanes run together.
A lane whose motion grows out of all bounds is taken out and named in `lost`; the others go on.
NOT its job: choosing working points (`limit_cycle`), parallel processes, sound.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from sim_hardware.brake_model.assembly import Array, Brake
from sim_hardware.brake_model.time_domain import batch_careful, batch_kernels, contact
from sim_hardware.brake_model.time_domain import batch_tables as layout
from sim_hardware.brake_model.time_domain.batch_statistics import Statistics, StatisticsOf
from sim_hardware.brake_model.time_domain.integrator import (
    FINE_HZ,
    NEGLIGIBLE,
    discretise,
)
from sim_hardware.brake_model.time_domain.modal import Complex, ModalSystem, modal_system
from sim_hardware.brake_model.time_domain.outputs import output_rows

#: a value per lane: one for all or (lanes,); constant, or a tuple (start, end), linear within the call
PerLane = ArrayLike | tuple[ArrayLike, ArrayLike]

#: lanes that go through a call together, so that all they need stays in the fastest memory
_TILE_SHARED, _TILE_OWN = 64, 8
#: output intervals that `observe` keeps at a time, and pieces after which it looks for lost lanes
_PIECE, _TIDY = 512, 16


@dataclass
class _Tile:
    """Lanes that go through a call together, a multiple of eight; `table`: their coefficients."""

    first_group: int
    table: Array
    state: Array
    operation: Array


class BatchIntegrator:
    """Time integration of many brakings side by side. Keeps their state between calls; deterministic.

    Parameters
    ----------
    brakes : the brake of all lanes, or one brake per lane, all with the same bodies, couplings and pads
    lanes : number of brakings; may be omitted with a brake per lane
    mu_ref : friction of the linear part, one for all; each brake's own where None
    output_hz, substeps, outputs, fine_steps : as `SquealIntegrator`
    weights : (outputs,) return their weighted sum as the only column; (columns, outputs) that many sums

    Attributes
    ----------
    lanes : number of brakings
    n_pads, pads : number of friction groups, their pads
    outputs : names of the outputs
    n_columns : columns of the result
    lost : (lanes,) truth values, lanes whose motion was not finite: their outputs are not a number from the
        call on in which it happened, until `reset` or new states

    Raises
    ------
    KeyError
        unknown output
    ValueError
        no lanes, brakes of unequal structure, not exactly two friction groups (run `SquealIntegrator` for
        each then), rates, weights, modes as `SquealIntegrator`
    """

    def __init__(
        self,
        brakes: Brake | Sequence[Brake],
        lanes: int | None = None,
        *,
        mu_ref: float | None = None,
        output_hz: float = 40_000.0,
        substeps: int = 1,
        outputs: Sequence[str] | None = None,
        weights: ArrayLike | None = None,
        fine_steps: int | None = None,
    ) -> None:
        own = not isinstance(brakes, Brake)
        self.brakes: tuple[Brake, ...] = tuple(brakes) if not isinstance(brakes, Brake) else (brakes,)
        self.lanes = len(self.brakes) if lanes is None and own else lanes or 0
        if self.lanes < 1 or (own and len(self.brakes) != self.lanes):
            raise ValueError(
                f"{lanes!r} lanes for {len(self.brakes)} brakes; give 1 or more, one brake or one each"
            )
        if not (math.isfinite(output_hz) and output_hz > 0.0):
            raise ValueError(f"output_hz is {output_hz!r}; give a positive rate")
        if substeps < 1:
            raise ValueError(f"substeps is {substeps!r}; give at least 1")
        fine = max(1, math.ceil(FINE_HZ / (output_hz * substeps))) if fine_steps is None else fine_steps
        if fine < 1:
            raise ValueError(f"fine_steps is {fine!r}; give at least 1")
        self.output_hz, self.substeps, self._fine_steps = output_hz, substeps, fine
        first = self.brakes[0]
        self.outputs = first.freedoms if outputs is None else tuple(outputs)
        sums = (
            np.eye(len(self.outputs)) if weights is None else np.atleast_2d(np.asarray(weights, dtype=float))
        )
        if sums.ndim != 2 or sums.shape[1] != len(self.outputs):
            raise ValueError(f"weights of shape {sums.shape} for {len(self.outputs)} outputs; give one each")
        self.n_columns = len(sums)
        self._systems = [modal_system(brake, brake.mu if mu_ref is None else mu_ref) for brake in self.brakes]
        self.pads = tuple(group.pad for group in self._systems[0].groups)
        self.n_pads = len(self.pads)
        self._check_structure()
        self._modes = max(len(system.eigenvalues) for system in self._systems)
        self._history_rows: list[Complex] = []
        tables = np.stack([self._table(*pair, sums) for pair in zip(self.brakes, self._systems, strict=True)])
        self._tiles = self._make_tiles(tables, _TILE_OWN if own else _TILE_SHARED)
        self._groups = sum(len(tile.state) for tile in self._tiles)
        self._work = layout.aligned(
            (batch_careful.WORK_ROWS + batch_careful.WORK_ROWS_PER_MODE * self._modes, layout.LANES)
        )
        self._fresh = np.zeros(self.lanes, dtype=bool)
        self._ended = 0  # internal steps of the last call: where the law is to be taken
        self.lost = np.zeros(self.lanes, dtype=bool)
        self.reset()

    def _check_structure(self) -> None:
        first = self.brakes[0]
        if self.n_pads != layout.PADS:
            raise ValueError(
                f"brake '{first.name}' has {self.n_pads} friction groups; the batch is made for "
                f"{layout.PADS} (two rigid pads): use batch_serial.batch_of, or SquealIntegrator"
            )
        for brake, system in zip(self.brakes, self._systems, strict=True):
            pads = tuple(group.pad for group in system.groups)
            if brake.freedoms != first.freedoms or pads != self.pads:
                raise ValueError(
                    f"brakes '{first.name}' and '{brake.name}' differ in their bodies or pads; "
                    "put brakes of one structure into a batch"
                )

    def _table(self, brake: Brake, system: ModalSystem, sums: Array) -> Array:
        rows, direct = (sums @ part for part in output_rows(brake, system, self.outputs))
        step_s = 1.0 / (self.output_hz * self.substeps)
        c = discretise(brake, system, (rows, direct), step_s, self.substeps, self._fine_steps)
        history = c.modal[c.history : c.history + contact.DEPTH * self.n_pads, :, : self._modes]
        self._history_rows.append(history[:, 0] + 1j * history[:, 1])
        return layout.table_of(c, self._modes)

    def _make_tiles(self, tables: Array, tile_lanes: int) -> list[_Tile]:
        tiles = []
        for first in range(0, self.lanes, tile_lanes):
            stop = min(first + tile_lanes, self.lanes)
            groups = -(-(stop - first) // layout.LANES)
            if len(self.brakes) > 1:
                chosen = tables[np.minimum(np.arange(first, first + groups * layout.LANES), self.lanes - 1)]
                table = layout.aligned((groups, layout.LANES * tables.shape[1]))
                table[...] = chosen.reshape(groups, layout.LANES, -1).transpose(0, 2, 1).reshape(groups, -1)
            else:
                table = layout.aligned((tables.shape[1],))
                table[...] = tables[0]
            state = layout.aligned((groups, layout.STATE_ROWS + 4 * self._modes, layout.LANES))
            operation = layout.aligned((groups, layout.OPERATION_ROWS, layout.LANES))
            operation[:, 4] = 1.0  # lanes that are not there slide on
            tiles.append(_Tile(first // layout.LANES, table, state, operation))
        return tiles

    def _slots(self, chosen: NDArray[np.bool_]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Groups and places of the chosen lanes."""
        at = np.flatnonzero(chosen)
        return at // layout.LANES, at % layout.LANES

    def _place(self, lane: int) -> tuple[_Tile, int, int]:
        """Tile, group within it and place within the group of a lane."""
        group = lane // layout.LANES
        tile = next(t for t in reversed(self._tiles) if t.first_group <= group)
        return tile, group - tile.first_group, lane % layout.LANES

    # -- running
    # ---------------------------------------------------------------------------------------------------

    def advance(
        self,
        n_out: int,
        *,
        normal_force_n: PerLane,
        mu: PerLane,
        slip_m_s: PerLane,
        k_s_m: PerLane = 0.0,
        saturation_m_s: ArrayLike | None = None,
        excitation_n: ArrayLike | None = None,
        columns: int | None = None,
    ) -> Array:
        """Integrate `n_out` output intervals of all lanes and return the outputs at the start of each.

        Parameters
        ----------
        n_out : number of output intervals
        normal_force_n, mu, slip_m_s, k_s_m : working point as in `SquealIntegrator.advance`; each a value for
            all lanes or (lanes,), or a tuple (start, end) of those
        saturation_m_s : one for all or (lanes,); None or infinite: linear law (eq 28)
        excitation_n : (n_out, n_pads) for all lanes or (n_out, lanes, n_pads), N
        columns : compute the first columns only; each takes about a tenth of the time

        Returns
        -------
        (n_out, lanes, n_columns) float64

        Raises
        ------
        ValueError
            wrong shape, negative pad force or sliding speed, values that are not finite
        """
        self._set_operation(n_out, (normal_force_n, mu, slip_m_s, k_s_m), saturation_m_s)
        excitation = self._excitation(n_out, excitation_n)
        out = layout.aligned((n_out, self._columns(columns), self._groups, layout.LANES))
        if n_out:
            self._run(excitation, out, 0)
            self._tidy()
            out[:, :, *self._slots(self.lost)] = np.nan
        return self._by_lanes(out)

    def observe(
        self,
        n_out: int,
        *,
        normal_force_n: PerLane,
        mu: PerLane,
        slip_m_s: PerLane,
        k_s_m: PerLane = 0.0,
        saturation_m_s: ArrayLike | None = None,
        excitation_n: ArrayLike | None = None,
        columns: int | None = None,
    ) -> Statistics:
        """As `advance`, but return only mean, rms, extremes and frequency of the outputs over the call.

        Keeps no more than a small piece of the outputs at a time, which is faster and needs no memory.
        """
        self._set_operation(n_out, (normal_force_n, mu, slip_m_s, k_s_m), saturation_m_s)
        given = None if excitation_n is None else np.asarray(excitation_n, dtype=float)
        if given is not None and len(given) != n_out:
            raise ValueError(f"excitation_n has {len(given)} rows; give {n_out}")
        shown = self._columns(columns)
        statistics = StatisticsOf(shown, self._groups * layout.LANES)
        out = layout.aligned((min(_PIECE, n_out), shown, self._groups, layout.LANES))
        for first in range(0, n_out, _PIECE):
            piece = out[: min(_PIECE, n_out - first)]
            excitation = None if given is None else given[first : first + len(piece)]
            self._run(self._excitation(len(piece), excitation), piece, first * self.substeps)
            statistics.add(piece)
            if first // _PIECE % _TIDY == _TIDY - 1:
                self._tidy()
        self._tidy()
        return statistics.result(self.output_hz, self.lanes, self.lost)

    def _columns(self, wanted: int | None) -> int:
        if wanted is not None and not 0 <= wanted <= self.n_columns:
            raise ValueError(f"columns is {wanted!r}; there are {self.n_columns}")
        return self.n_columns if wanted is None else wanted

    def _run(self, excitation: Array, out: Array, begin: int) -> None:
        if self._fresh.any():
            self._start_fresh_lanes()
        for tile in self._tiles:
            batch_kernels.advance_lanes(
                tile.table, self._modes, out.shape[1], self.substeps, self._fine_steps,
                bool(tile.operation[:, layout.SATURATION_ROW].any()), tile.state, tile.operation,
                excitation, len(excitation) > 0, self._work, out, tile.first_group, begin,
            )  # fmt: skip
        self._ended = begin + len(out) * self.substeps

    def _tidy(self) -> None:
        """Take lost lanes out; set lanes at rest to zero, so that nothing computes with subnormals."""
        kept = slice(layout.STATE_ROWS, layout.STATE_ROWS + 2 * self._modes)
        for tile in self._tiles:
            size = np.einsum("grl,grl->gl", tile.state[:, kept], tile.state[:, kept])
            size += np.einsum(
                "grl,grl->gl", tile.state[:, : layout.CONTACT_ROW], tile.state[:, : layout.CONTACT_ROW]
            )
            finite = np.isfinite(size)
            if not finite.all():
                at = tile.first_group * layout.LANES + np.flatnonzero(~finite.ravel())
                self.lost[at[at < self.lanes]] = True
            rest = (~finite | (size < NEGLIGIBLE))[:, None, :]
            if rest.any():
                np.copyto(tile.state, 0.0, where=rest)
                np.copyto(tile.state[:, layout.CALM_ROW : layout.SOLVED_ROW], float(contact.CALM), where=rest)

    def _set_operation(self, n_out: int, values: Sequence[PerLane], saturation_m_s: ArrayLike | None) -> None:
        if n_out < 0:
            raise ValueError(f"n_out is {n_out!r}; give 0 or more")
        flat = np.zeros((layout.OPERATION_ROWS, self._groups * layout.LANES))
        flat[4] = 1.0
        steps = max(n_out, 1) * self.substeps
        for i, (name, value) in enumerate(zip(WORKING_POINT, values, strict=True)):
            start, end = ends(name, value, self.lanes)
            flat[2 * i, : self.lanes] = start
            flat[2 * i + 1, : self.lanes] = (end - start) / steps
        if saturation_m_s is not None:
            saturation = per_lane("saturation_m_s", saturation_m_s, self.lanes)
            if not (saturation > 0.0).all():
                raise ValueError(
                    f"saturation_m_s is {saturation_m_s!r}; give positive speeds, infinite or None"
                )
            flat[layout.SATURATION_ROW, : self.lanes] = 1.0 / saturation
        parked = np.flatnonzero(self.lost)
        flat[:, parked] = 0.0
        flat[4, parked] = 1.0
        grouped = flat.reshape(layout.OPERATION_ROWS, self._groups, layout.LANES).transpose(1, 0, 2)
        for tile in self._tiles:
            tile.operation[...] = grouped[tile.first_group : tile.first_group + len(tile.operation)]

    def _excitation(self, n_out: int, excitation_n: ArrayLike | None) -> Array:
        if excitation_n is None:
            return np.zeros((0, self._groups, self.n_pads, layout.LANES))
        given = np.asarray(excitation_n, dtype=float)
        if given.shape == (n_out, self.n_pads):
            given = given[:, None, :]
        elif given.shape != (n_out, self.lanes, self.n_pads):
            raise ValueError(
                f"excitation_n has the shape {given.shape}; give ({n_out}, {self.n_pads}) for all lanes or "
                f"({n_out}, {self.lanes}, {self.n_pads})"
            )
        made = np.empty((n_out, self._groups, self.n_pads, layout.LANES))
        if given.shape[1] == 1:
            made[...] = given[:, :, :, None]
        else:
            whole, rest = divmod(self.lanes, layout.LANES)
            first = given[:, : self.lanes - rest].reshape(n_out, whole, layout.LANES, self.n_pads)
            made[:, :whole] = first.transpose(0, 1, 3, 2)
            if rest:
                made[:, whole] = 0.0
                made[:, whole, :, :rest] = given[:, self.lanes - rest :].transpose(0, 2, 1)
        groups, slots = self._slots(self.lost)
        made[:, groups, :, slots] = 0.0
        return made

    def _by_lanes(self, out: Array) -> Array:
        return out.reshape(*out.shape[:2], self._groups * layout.LANES)[:, :, : self.lanes].transpose(0, 2, 1)

    # -- state
    # -----------------------------------------------------------------------------------------------------

    def reset(self) -> None:
        """All lanes go to the steadily sliding state, without memory."""
        for tile in self._tiles:
            tile.state[...] = 0.0
            tile.state[:, layout.CALM_ROW] = contact.CALM
        self._fresh[:] = False
        self.lost[:] = False

    @property
    def states(self) -> Array:
        """(lanes, 2 n_dof) displacements and velocities from the steadily sliding state.

        Lost lanes: not a number.
        """
        result = np.empty((self.lanes, 2 * self.brakes[0].n_dof))
        for lane in range(self.lanes):
            tile, group, slot = self._place(lane)
            column = tile.state[group, :, slot]
            eta = self._modes_of(column)
            which = lane if len(self.brakes) > 1 else 0
            if not self._fresh[lane]:
                eta = eta + self._past(tile, group, slot) @ self._history_rows[which]
            system = self._systems[which]
            result[lane] = (system.vectors @ eta[: len(system.eigenvalues)]).real
        result[self.lost] = np.nan
        return result

    @states.setter
    def states(self, value: ArrayLike) -> None:
        """Start all lanes from displacements and velocities, (lanes, 2 n_dof) or (2 n_dof,) for all."""
        size = 2 * self.brakes[0].n_dof
        given = np.asarray(value, dtype=float)
        if given.shape not in ((size,), (self.lanes, size)) or not np.isfinite(given).all():
            raise ValueError(
                f"states of shape {given.shape}: give ({self.lanes}, {size}) or ({size},) finite values"
            )
        self.reset()
        for lane, state in enumerate(np.broadcast_to(given, (self.lanes, size))):
            system = self._systems[lane if len(self.brakes) > 1 else 0]
            tile, group, slot = self._place(lane)
            column = tile.state[group, :, slot]
            eta: Complex = np.zeros(self._modes, dtype=np.complex128)
            eta[: len(system.eigenvalues)] = system.inverse @ state
            modes = column[layout.STATE_ROWS : layout.STATE_ROWS + 2 * self._modes]
            modes[0::2], modes[1::2] = eta.real, eta.imag
            column[layout.CONTACT_ROW : layout.PRESENT_ROW] = system.contact_rows @ state
            column[layout.CALM_ROW] = 0.0
        self._fresh[:] = True

    def _modes_of(self, column: Array) -> Complex:
        modes = column[layout.STATE_ROWS : layout.STATE_ROWS + 2 * self._modes]
        return modes[0::2] + 1j * modes[1::2]

    def _past(self, tile: _Tile, group: int, slot: int) -> Array:
        """(DEPTH * PADS,) g of a lane, now and earlier."""
        column = tile.state[group, :, slot]
        present = column[layout.PRESENT_ROW : layout.CALM_ROW].copy()
        if column[layout.SOLVED_ROW] == 0.0:
            present[:] = self._law(tile, group, slot)
        return np.concatenate([present, column[layout.HISTORY_ROW : layout.CONTACT_ROW]])

    def _law(self, tile: _Tile, group: int, slot: int) -> list[float]:
        """g of both pads where the last call ended by the friction law, any slip direction."""
        column, op = tile.state[group, :, slot], tile.operation[group, :, slot]
        lane = (tile.first_group + group) * layout.LANES + slot
        system = self._systems[lane if len(self.brakes) > 1 else 0]
        deviation: Any = contact.deviation
        motion = column[layout.CONTACT_ROW : layout.PRESENT_ROW]
        n0, mu, v, k = op[0:8:2] + self._ended * op[1:8:2]
        return [
            deviation(
                motion[2 * p], motion[2 * p + 1], pad.load_share * n0, mu, v, k,
                op[layout.SATURATION_ROW], system.mu_ref,
            )
            for p, pad in enumerate(system.groups)
        ]  # fmt: skip

    def _start_fresh_lanes(self) -> None:
        """Bring the friction of lanes with a new state into their memory: the working point is known now."""
        self._ended = 0
        for lane in np.flatnonzero(self._fresh):
            tile, group, slot = self._place(int(lane))
            column = tile.state[group, :, slot]
            g = np.array(self._law(tile, group, slot))
            rows = self._history_rows[lane if len(self.brakes) > 1 else 0][: self.n_pads]
            eta = self._modes_of(column) - g @ rows
            modes = column[layout.STATE_ROWS : layout.STATE_ROWS + 2 * self._modes]
            modes[0::2], modes[1::2] = eta.real, eta.imag
            column[layout.PRESENT_ROW : layout.CALM_ROW] = g
            column[layout.SOLVED_ROW] = 1.0
        self._fresh[:] = False


WORKING_POINT = ("normal_force_n", "mu", "slip_m_s", "k_s_m")
_NOT_NEGATIVE = ("normal_force_n", "slip_m_s")


def per_lane(name: str, value: ArrayLike, lanes: int) -> Array:
    """Values (lanes,) of one for all or one each."""
    given = np.asarray(value, dtype=float)
    if given.shape not in ((), (lanes,)):
        raise ValueError(f"{name} has the shape {given.shape}; give one value or ({lanes},)")
    return np.broadcast_to(given, (lanes,))


def ends(name: str, value: PerLane, lanes: int) -> tuple[Array, Array]:
    """Values (lanes,) at start and end of a call."""
    pair = value if isinstance(value, tuple) else (value, value)
    if len(pair) != 2:
        raise ValueError(f"{name} is a tuple of {len(pair)}; give (start, end), or an array for the lanes")
    start, end = per_lane(name, pair[0], lanes), per_lane(name, pair[1], lanes)
    least = min(float(start.min()), float(end.min()))
    if not (np.isfinite(start).all() and np.isfinite(end).all()) or (name in _NOT_NEGATIVE and least < 0.0):
        raise ValueError(f"{name} is {value!r}; give finite values, pad force and slip >= 0")
    return start, end

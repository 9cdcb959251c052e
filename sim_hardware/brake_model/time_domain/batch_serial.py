"""Brakings one after the other behind the interface of a batch, for brakes that the batch is not made for.

A brake with another number of friction groups than two (a pad split into bodies, a third pad) runs in
`SquealIntegrator`, lane by lane: the same results, without the speed. `batch_of` chooses.
NOT its job: brakes with two rigid pads (`batch`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from sim_hardware.brake_model.assembly import Array, Brake
from sim_hardware.brake_model.time_domain import batch_tables as layout
from sim_hardware.brake_model.time_domain.batch import WORKING_POINT, BatchIntegrator, PerLane, ends, per_lane
from sim_hardware.brake_model.time_domain.batch_statistics import Statistics, StatisticsOf
from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator
from sim_hardware.brake_model.time_domain.modal import friction_groups


class SerialBatch:
    """Lanes integrated one after the other; parameters, attributes, methods as `BatchIntegrator`."""

    def __init__(
        self,
        brakes: Brake | Sequence[Brake],
        lanes: int | None = None,
        *,
        outputs: Sequence[str],
        weights: ArrayLike,
        **settings: Any,
    ) -> None:
        every = [brakes] * (lanes or 0) if isinstance(brakes, Brake) else list(brakes)
        if not every or (lanes is not None and len(every) != lanes):
            raise ValueError(
                f"{lanes!r} lanes for {len(every)} brakes; give 1 or more, one brake or one each"
            )
        self._single = [SquealIntegrator(brake, outputs=outputs, **settings) for brake in every]
        self._sums = np.atleast_2d(np.asarray(weights, dtype=float))
        self.brakes = tuple(every)
        self.lanes, self.n_columns = len(every), len(self._sums)
        self.output_hz = self._single[0].output_hz
        self.pads, self.n_pads = self._single[0].pads, self._single[0].n_pads
        self.lost = np.zeros(self.lanes, dtype=bool)

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
        """See `BatchIntegrator.advance`."""
        pairs = {
            name: ends(name, value, self.lanes)
            for name, value in zip(WORKING_POINT, (normal_force_n, mu, slip_m_s, k_s_m), strict=True)
        }
        saturation = per_lane(
            "saturation_m_s", np.inf if saturation_m_s is None else saturation_m_s, self.lanes
        )
        push = None if excitation_n is None else np.asarray(excitation_n, dtype=float)
        out = np.full((n_out, self.lanes, self.n_columns if columns is None else columns), np.nan)
        for lane in np.flatnonzero(~self.lost):
            point: dict[str, Any] = {name: (float(a[lane]), float(b[lane])) for name, (a, b) in pairs.items()}
            try:
                with np.errstate(over="ignore", invalid="ignore"):  # what is lost says so
                    y = self._single[lane].advance(
                        n_out,
                        **point,
                        saturation_m_s=None if np.isinf(saturation[lane]) else float(saturation[lane]),
                        excitation_n=push if push is None or push.ndim == 2 else push[:, lane],
                    )
            except FloatingPointError:
                self.lost[lane] = True
            else:
                out[:, lane] = y @ self._sums[: out.shape[2]].T
        return out

    def observe(self, n_out: int, **point: Any) -> Statistics:
        """See `BatchIntegrator.observe`."""
        y = self.advance(n_out, **point)
        groups = -(-self.lanes // layout.LANES)
        padded = np.zeros((n_out, y.shape[2], groups * layout.LANES))
        padded[:, :, : self.lanes] = y.transpose(0, 2, 1)
        statistics = StatisticsOf(y.shape[2], groups * layout.LANES)
        statistics.add(padded.reshape(n_out, y.shape[2], groups, layout.LANES))
        return statistics.result(self.output_hz, self.lanes, self.lost)

    @property
    def states(self) -> Array:
        """(lanes, 2 n_dof), see `BatchIntegrator.states`."""
        states = np.stack([single.state for single in self._single])
        states[self.lost] = np.nan
        return states

    @states.setter
    def states(self, value: ArrayLike) -> None:
        """Start all lanes anew."""
        given = np.asarray(value, dtype=float)
        for single, state in zip(
            self._single, np.broadcast_to(given, (self.lanes, given.shape[-1])), strict=True
        ):
            single.state = state
        self.lost[:] = False


def batch_of(
    brakes: Brake | Sequence[Brake], lanes: int, *, outputs: Sequence[str], weights: ArrayLike
) -> BatchIntegrator | SerialBatch:
    """The batch for these brakes: side by side where they have two friction groups, one by one otherwise."""
    first = brakes if isinstance(brakes, Brake) else brakes[0]
    made = BatchIntegrator if len(friction_groups(first)) == layout.PADS else SerialBatch
    return made(brakes, lanes, outputs=outputs, weights=weights)

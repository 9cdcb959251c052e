"""Tracking of vibrating modes in a frequency band: for models made elsewhere, sparse, thousands of freedoms.

As `tracking`, but at every point only the eigenvalues of a widened band are computed (`band`), with both
vectors. Modes that lie in the band at the start are followed; one that leaves the widened band, or stops
vibrating, is marked lost from there on. NOT its job: small models (`tracking` is exact and a hundred times
faster for them), real eigenvalues.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.eigen.band import eigen_pairs_of
from sim_hardware.brake_model.eigen.tracking_events import crossings_of
from sim_hardware.brake_model.eigen.tracking_locus import Event, Flag, Locus, checked_grid
from sim_hardware.brake_model.eigen.tracking_nodes import ComplexArray, Node, matches
from sim_hardware.brake_model.eigen.tracking_path import Path, path_of
from sim_hardware.brake_model.linear import Array, LinearModel, ParameterGroup

Indices = NDArray[np.intp]

#: halvings of a step at most: each costs a solution of the band
MAX_HALVINGS = 6
#: the band is widened by this share of its edges
_MARGIN = 0.06


def track_band(
    model: LinearModel,
    what: str | ParameterGroup | Mapping[str, float] | Path,
    grid: Sequence[float] | Array,
    band_hz: tuple[float, float],
    values: Mapping[str, float] | None = None,
    *,
    asymmetric: bool = False,
    max_halvings: int = MAX_HALVINGS,
) -> Locus:
    """Track the modes that lie in a frequency band at the start of the grid.

    Parameters
    ----------
    what, grid, values, asymmetric : see `tracking.track`
    band_hz : (from, to), Hz
    max_halvings : of a step where identity is unclear

    Returns
    -------
    As `tracking.track`; eigenvalues are nan from where a mode is lost (`Flag.LOST`). Modes are numbered
    within the band.

    Raises
    ------
    KeyError, ValueError, ArithmeticError
        unknown name, bad grid or band, no mode in the band, no convergence
    """
    low, high = band_hz
    if not 0.0 <= low < high < np.inf:
        raise ValueError(f"the band {low:g} to {high:g} Hz is none; give 0 <= lower < upper")
    path = path_of(model, what, values, asymmetric=asymmetric)
    points = checked_grid(grid)
    tracker = _BandTracker(model, path, (low, high), max_halvings)
    return tracker.locus(points)


class _BandTracker:
    """Nodes of a widened band along a path."""

    def __init__(
        self, model: LinearModel, path: Path, band_hz: tuple[float, float], max_halvings: int
    ) -> None:
        self.model, self.path, self.max_halvings = model, path, max_halvings
        self.band_hz = band_hz
        self.wide_hz = ((1.0 - _MARGIN) * band_hz[0], (1.0 + _MARGIN) * band_hz[1])
        self.scale = np.pi * sum(band_hz)

    def node(self, s: float) -> Node:
        """Vibrating modes of the widened band, with state vectors and derivatives."""
        values = self.path.values(s)
        pairs = eigen_pairs_of(self.model, values, self.wide_hz)
        kept = np.flatnonzero(pairs.eigenvalues.imag > 0.0)
        z, x, y = pairs.eigenvalues[kept], pairs.right[:, kept], pairs.left[:, kept]
        m = self.model.matrices(values)
        mass_x, damping_x = m.mass @ x, m.damping @ x
        # w_i^T v_j of the state vectors is y_i^T ((l_i + l_j) M + D) x_j
        slopes = np.einsum("nu,nu->u", y, 2.0 * z * mass_x + damping_x)
        y = y / np.where(slopes == 0.0, 1.0, slopes)
        mass_y, damping_y = m.mass.T @ y, m.damping.T @ y
        right = np.vstack([self.scale * x, z * x])
        left = np.vstack([(z * mass_y + damping_y) / self.scale, mass_y]).T
        rates: ComplexArray = np.zeros(len(z), dtype=np.complex128)
        for name, rate in self.path.rates().items():  # eq 24
            d = self.model.derivative(name, values)
            change = z**2 * (d.mass @ x) + z * (d.damping @ x) + d.stiffness @ x
            rates -= rate * np.einsum("nu,nu->u", y, change)
        return Node(float(s), z, rates, right, left, len(z))

    def locus(self, grid: Array) -> Locus:
        """Follow the modes of the band at the start."""
        first = self.node(float(grid[0]))
        f = first.values.imag / (2.0 * np.pi)
        inside = np.flatnonzero((f >= self.band_hz[0]) & (f <= self.band_hz[1]))
        if not inside.size:
            low, high = self.band_hz
            raise ValueError(
                f"no vibrating mode between {low:g} and {high:g} Hz at the start; widen the band"
            )
        m = len(inside)
        flags = np.zeros((len(grid), m), dtype=np.uint8)
        events: list[Event] = []
        slots: Indices = inside.astype(np.intp)  # index of each mode at the current node, -1: lost
        chain: list[tuple[Node, Indices]] = [(first, slots)]
        at_grid = [0]
        for k in range(1, len(grid)):
            for start, end in self._steps(chain[-1][0], self.node(float(grid[k])), slots, 0):
                slots, unclear = self._followed(start, end, slots)
                for modes in unclear:
                    events.append(_event(start, end, chain[-1][1], modes))
                    flags[k, list(modes)] |= np.uint8(Flag.EXCEPTIONAL)
                chain.append((end, slots))
            at_grid.append(len(chain) - 1)
            flags[k, slots < 0] |= np.uint8(Flag.LOST)
        values, rates = (
            np.stack([np.append(getattr(node, key), np.nan)[s] for node, s in chain])  # lost, -1: nan
            for key in ("values", "rates")
        )
        locus = Locus(
            self.model.name, self.path, grid, values[at_grid], values[at_grid].conj(), flags, tuple(events),
            np.array([node.s for node, _ in chain]), values, values.conj(), rates,
        )  # fmt: skip
        return replace(locus, crossings=crossings_of(locus, self.node))

    def _steps(self, start: Node, end: Node, slots: Indices, depth: int) -> list[tuple[Node, Node]]:
        """Steps between two nodes, halved where identity is unclear."""
        _, unclear = self._followed(start, end, slots)
        if not unclear or depth >= self.max_halvings:
            return [(start, end)]
        middle = self.node(0.5 * (start.s + end.s))
        first = self._steps(start, middle, slots, depth + 1)
        for a, b in first:
            slots, _ = self._followed(a, b, slots)
        return [*first, *self._steps(middle, end, slots, depth + 1)]

    def _followed(self, start: Node, end: Node, slots: Indices) -> tuple[Indices, list[tuple[int, ...]]]:
        """Indices of the modes at the end, -1 where lost; and the modes whose identity is unclear."""
        moved: Indices = np.full(len(slots), -1, dtype=np.intp)
        step = end.s - start.s
        expected = start.values + step * start.rates
        f = expected.imag / (2.0 * np.pi)
        leaving = (f < self.wide_hz[0]) | (f > self.wide_hz[1])
        alive = np.flatnonzero(slots >= 0)
        alive = alive[~leaving[slots[alive]]]
        if not alive.size or not len(end.values):
            return moved, []
        chosen = slots[alive]
        part = Node(
            start.s, start.values[chosen], start.rates[chosen], start.right[:, chosen], start.left[chosen],
            len(chosen),
        )  # fmt: skip
        match = matches([part], [end])[0]
        doubt = match.doubtful | match.close
        edge = 0.5 * _MARGIN
        at_edge = (f < (1.0 - edge) * self.band_hz[0]) | (f > (1.0 + edge) * self.band_hz[1])
        lost = (match.order < 0) | (doubt & at_edge[chosen])
        moved[alive] = np.where(lost, -1, match.order)
        doubtful = alive[doubt & ~lost]
        groups = [tuple(int(i) for i in doubtful)] if doubtful.size else []
        return moved, groups


def _event(start: Node, end: Node, slots: Indices, modes: tuple[int, ...]) -> Event:
    numbers = tuple(mode + 1 for mode in modes)
    return Event("exceptional", 0.5 * (start.s + end.s), numbers, complex(start.values[slots[modes[0]]]))

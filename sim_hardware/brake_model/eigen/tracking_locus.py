"""Eigenvalues over a quantity, mode by mode, as data: `Locus`, its events and crossings.

NOT its job: how they are found (`tracking`, `tracking_events`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import IntFlag
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.eigen.tracking_nodes import ComplexArray
from sim_hardware.brake_model.eigen.tracking_path import Path
from sim_hardware.brake_model.linear import Array

EventKind = Literal["exceptional", "crossing", "split", "merge", "unresolved"]


class Flag(IntFlag):
    """What holds for a mode at a grid point, or happened in the step that ends there."""

    REAL = 1
    SPLIT = 2
    MERGED = 4
    CROSSED = 8
    EXCEPTIONAL = 16
    UNRESOLVED = 32
    LOST = 64


@dataclass(frozen=True, slots=True)
class Event:
    """Something that concerns the identity of modes.

    Attributes
    ----------
    kind : "exceptional" (modes coincide, with their vectors; identity beyond is undefined), "crossing"
        (modes coincide and keep their vectors: they do not couple), "split" (a vibration ceases: two real
        eigenvalues), "merge" (two real eigenvalues begin to vibrate), "unresolved" (the limit of extra
        points was reached)
    value : of the parameter
    modes : numbers, from 1
    eigenvalue : where they are, 1/s
    """

    kind: EventKind
    value: float
    modes: tuple[int, ...]
    eigenvalue: complex


@dataclass(frozen=True, slots=True)
class Crossing:
    """Where a mode crosses the imaginary axis: a boundary of stability.

    Attributes
    ----------
    mode : number, from 1
    value : of the parameter
    frequency_hz : 0 for divergence
    kind : "flutter" (vibration) or "divergence" (real eigenvalue)
    destabilising : whether the mode is unstable beyond `value`, along the grid
    rate_1_s : dRe/ds there, 1/s per unit of the parameter (eq 24); not finite at an exceptional point
    """

    mode: int
    value: float
    frequency_hz: float
    kind: Literal["flutter", "divergence"]
    destabilising: bool
    rate_1_s: float


@dataclass(frozen=True)
class Locus:
    """Eigenvalues over a quantity. g grid points, m modes.

    Attributes
    ----------
    model : name of the model
    path : what is varied
    grid : (g,) values of the parameter, ascending or descending, as asked
    eigenvalues : (g, m) 1/s; of a conjugate pair the one with Im > 0, of two real ones the larger
    partners : (g, m) 1/s; the other eigenvalue of the mode
    flags : (g, m) `Flag` bits
    events, crossings : along the grid
    fine_grid, fine_eigenvalues, fine_partners, fine_rates : the same at all points that were needed; rates:
        d/ds of eigenvalues (eq 24), not finite at exceptional points
    """

    model: str
    path: Path
    grid: Array
    eigenvalues: ComplexArray
    partners: ComplexArray
    flags: NDArray[np.uint8]
    events: tuple[Event, ...]
    fine_grid: Array = field(repr=False)
    fine_eigenvalues: ComplexArray = field(repr=False)
    fine_partners: ComplexArray = field(repr=False)
    fine_rates: ComplexArray = field(repr=False)
    crossings: tuple[Crossing, ...] = ()

    @property
    def n_modes(self) -> int:
        """Number of modes."""
        return self.eigenvalues.shape[1]

    @property
    def real_parts(self) -> Array:
        """(g, m) 1/s: growth rates; of two real eigenvalues the larger one."""
        return self.eigenvalues.real

    @property
    def frequencies_hz(self) -> Array:
        """(g, m) Im / 2 pi; 0 where real."""
        return self.eigenvalues.imag / (2.0 * np.pi)

    @property
    def damping_ratios(self) -> Array:
        """(g, m) -Re / |lambda|; negative: unstable; 0 for a mode at rest."""
        size = np.abs(self.eigenvalues)
        return -np.divide(self.eigenvalues.real, size, out=np.zeros_like(size), where=size > 0)

    @property
    def onset(self) -> Crossing | None:
        """The first crossing along the grid that makes a mode unstable."""
        return next((c for c in self.crossings if c.destabilising), None)


def checked_grid(grid: Sequence[float] | Array) -> Array:
    """Return a grid as an array (g,).

    Raises
    ------
    ValueError
        fewer than two values, not finite, or not strictly monotonic
    """
    points = np.array(grid, dtype=float)
    if points.ndim != 1 or len(points) < 2 or not np.isfinite(points).all():
        raise ValueError("the grid needs at least two finite values")
    steps = np.diff(points)
    if not ((steps > 0).all() or (steps < 0).all()):
        raise ValueError("the grid must rise or fall strictly")
    return points

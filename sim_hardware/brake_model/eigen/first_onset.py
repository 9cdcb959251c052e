"""Where one model first becomes unstable along one quantity, and how that moves with the model's other
quantities.

Job: `scan` (growth rate over a grid, onset refined), `onset_gradient` (exact, by eq 24 and the implicit
function theorem); what scatter, optimisation and identification evaluate thousands of times. NOT its job:
all boundaries of a model with mode identity, many variants in one batch (`margins`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from sim_hardware.brake_model.design.sensitivity import sensitivities_of
from sim_hardware.brake_model.eigen.eigen_systems import eigen_system
from sim_hardware.brake_model.linear import LinearModel, known

Array = NDArray[np.float64]

#: width to which an onset is refined, as share of the range
_TOLERANCE = 1e-12
#: shares of the range where it is checked that the state matrix is linear in the quantity
_CHECKED = (0.31, 0.77)
_ROUNDING = 1e-13
#: largest model that is solved thousands of times with all its eigenvalues (a second each)
MOST_FREEDOMS = 400
#: values solved at once where the scan may end early
_BLOCK = 6


@dataclass(frozen=True, slots=True)
class Scan:
    """Growth over a grid of one quantity.

    Attributes
    ----------
    quantity : its name
    grid : (n,) its values, rising
    growth_1_s : (n,) largest real part of all eigenvalues
    onset : smallest value with an unstable eigenvalue, None where there is none on the grid; the first of the
        grid where that is unstable
    frequency_hz : of the eigenvalue that becomes unstable; 0: divergence; None without onset
    """

    quantity: str
    grid: Array
    growth_1_s: Array
    onset: float | None
    frequency_hz: float | None

    @property
    def unstable(self) -> NDArray[np.bool_]:
        """(n,) whether any eigenvalue grows."""
        return self.growth_1_s > 0.0


def scan(
    model: LinearModel,
    quantity: str,
    grid: Array,
    values: Mapping[str, float] | None = None,
    *,
    whole: bool = True,
) -> Scan:
    """Growth rate at every value of a grid, and the first onset refined between two of them.

    Parameters
    ----------
    quantity : "pressure" (bar), "mu", or any other of the model
    grid : (n,) values, rising; an unstable range narrower than a step is missed
    values : other values than the file's
    whole : False: nothing beyond the first onset is computed (growth is nan there)

    Raises
    ------
    KeyError, ValueError
        unknown quantity, impossible values, a grid that does not rise
    """
    grid = np.asarray(grid, dtype=float)
    if grid.ndim != 1 or grid.size == 0 or not np.isfinite(grid).all() or (np.diff(grid) <= 0.0).any():
        raise ValueError(f"{quantity}: give rising values, at least one")
    known(model, quantity)
    check_dense(model)
    system = _along(model, quantity, float(grid[0]), float(grid[-1]), values or {})
    growth = np.full(grid.size, np.nan)
    for start in range(0, grid.size, grid.size if whole else _BLOCK):
        block = slice(start, start + (grid.size if whole else _BLOCK))
        growth[block] = np.linalg.eigvals(np.stack([system(x) for x in grid[block].tolist()])).real.max(
            axis=1
        )
        if (growth[block] > 0.0).any():
            break
    unstable = np.flatnonzero(growth > 0.0)
    if unstable.size == 0:
        return Scan(quantity, grid, growth, None, None)
    first = int(unstable[0])
    onset = float(grid[first])
    if first:

        def leading(x: float) -> float:
            return float(np.linalg.eigvals(system(x)).real.max())

        span = float(grid[-1] - grid[0])
        found: Any = brentq(leading, grid[first - 1], grid[first], xtol=_TOLERANCE * span)
        onset = float(found)
    critical = np.linalg.eigvals(system(onset))
    frequency = float(abs(critical[int(np.argmax(critical.real))].imag)) / (2.0 * np.pi)
    return Scan(quantity, grid, growth, onset, frequency)


def check_dense(model: LinearModel) -> None:
    """Refuse models whose eigenvalues, all of them many times over, would take days.

    Raises
    ------
    ValueError
        more than `MOST_FREEDOMS`
    """
    count = len(model.freedoms)
    if count > MOST_FREEDOMS:
        raise ValueError(
            f"the model has {count} degrees of freedom: this study solves for all eigenvalues thousands of "
            f"times and takes models up to {MOST_FREEDOMS}; reduce it first (Craig and Bampton)"
        )


def onset_gradient(
    model: LinearModel,
    quantity: str,
    onset: float,
    names: Sequence[str],
    values: Mapping[str, float] | None = None,
) -> tuple[Array, Array]:
    """Derivatives of an onset and of its frequency by other quantities.

    On the boundary Re lambda(p, x) = 0: dp/dx = -Re(lambda_x) / Re(lambda_p), and the frequency changes by
    Im(lambda_x + lambda_p dp/dx) / 2 pi; lambda_x, lambda_p by eq 24.

    Parameters
    ----------
    onset : of `quantity`, as `scan` refines it

    Returns
    -------
    (k,) d onset / d x, (k,) d frequency / d x in Hz; each per unit of x

    Raises
    ------
    ValueError
        the critical eigenvalue cannot be differentiated (coincides with another), or does not cross the axis
    KeyError
        unknown quantity
    """
    at = {**(values or {}), quantity: onset}
    system = eigen_system(model.matrices(at))
    upper = np.where(system.values.imag >= 0.0, system.values.real, -np.inf)
    critical = int(np.argmax(upper))
    if system.reasons[critical]:
        raise ValueError(f"{quantity} = {onset:g}: the critical eigenvalue {system.reasons[critical]}")
    rate = sensitivities_of(model, system, (quantity, *names), at).absolute[:, critical]
    along, across = rate[0], rate[1:]
    if along.real == 0.0:
        raise ValueError(f"{quantity} = {onset:g}: the critical eigenvalue does not move with {quantity}")
    moved = -across.real / along.real
    return moved, (across.imag + along.imag * moved) / (2.0 * np.pi)


def _along(
    model: LinearModel, quantity: str, low: float, high: float, values: Mapping[str, float]
) -> Callable[[float], Array]:
    """State matrix over the quantity: interpolated where it is linear in it (pressure, mu), else
    assembled.
    """

    def exact(x: float) -> Array:
        return model.matrices({**values, quantity: x}).state_matrix()

    first, last = exact(low), exact(high)
    if high == low:
        return exact
    change = (last - first) / (high - low)
    scale = max(float(np.abs(first).max()), float(np.abs(last).max()))
    for share in _CHECKED:
        x = low + share * (high - low)
        if float(np.abs(first + (x - low) * change - exact(x)).max()) > _ROUNDING * scale:
            return exact
    return lambda x: first + (x - low) * change

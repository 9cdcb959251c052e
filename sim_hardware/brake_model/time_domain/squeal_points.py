"""Working points along a quantity, and the mode that squeals there.

NOT its job: motion in time (`limit_cycle`, `squeal_ramp`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from sim_hardware.brake_model.assembly import Array, Brake
from sim_hardware.brake_model.stability import PA_PER_BAR
from sim_hardware.brake_model.time_domain.modal import Complex, friction_groups

#: quantities that belong to the working point, with their units; all others are parameters of the brake file
WORKING_QUANTITIES = {"pressure": "bar", "mu": "1", "slope": "s/m", "slip": "m/s"}
_FIELDS = {"pressure": "pressure_bar", "mu": "mu", "slope": "slope_s_m", "slip": "slip_m_s"}


@dataclass(frozen=True)
class SquealPoints:
    """Working points along a quantity. Arrays (n,); `brakes`: one for all, or one each.

    `saturation_m_s`: v_s of the saturating law; None: linear law (eq 28).
    """

    quantity: str
    unit: str
    values: Array
    brakes: tuple[Brake, ...]
    pressure_bar: Array
    mu: Array
    slope_s_m: Array
    slip_m_s: Array
    saturation_m_s: float | None

    def __len__(self) -> int:
        return len(self.values)

    @property
    def pad_force_n(self) -> Array:
        """(n,) mean normal force of a pad."""
        area = np.array([brake.piston_area_m2 for brake in self.brakes])
        return self.pressure_bar * PA_PER_BAR * area

    @property
    def scale_m_s(self) -> Array:
        """(n,) variation of speed at which the law is no longer linear."""
        bound = np.inf if self.saturation_m_s is None else self.saturation_m_s
        return np.minimum(self.slip_m_s, bound)

    def brake(self, index: int) -> Brake:
        """The brake of a point."""
        return self.brakes[index if len(self.brakes) > 1 else 0]

    def at(self, values: ArrayLike) -> SquealPoints:
        """The same with other values of a working quantity."""
        given = np.asarray(values, dtype=float)
        names = ("pressure_bar", "mu", "slope_s_m", "slip_m_s")
        fields = {name: np.full(len(given), getattr(self, name)[0]) for name in names}
        fields[_FIELDS[self.quantity]] = given
        return replace(self, values=given, **fields)

    def working_point(self) -> dict[str, Any]:
        """What `BatchIntegrator.advance` takes."""
        return {
            "normal_force_n": self.pad_force_n, "mu": self.mu, "slip_m_s": self.slip_m_s,
            "k_s_m": self.slope_s_m, "saturation_m_s": self.saturation_m_s,
        }  # fmt: skip


def squeal_points(
    brake: Brake,
    quantity: str,
    values: ArrayLike,
    *,
    slip_m_s: float,
    saturation_m_s: float | None,
    pressure_bar: float = 20.0,
    mu: float | None = None,
    slope_s_m: float | None = None,
) -> SquealPoints:
    """Working points along a quantity.

    Parameters
    ----------
    quantity : "pressure" (bar), "mu", "slope" (s/m), "slip" (m/s), or a parameter of the brake file (SI)
    values : (n,) of it
    slip_m_s, saturation_m_s, pressure_bar, mu, slope_s_m : what is not varied; the brake's mu and slope where
        None; saturation None: linear law

    Raises
    ------
    KeyError
        unknown quantity
    ValueError
        no values, or values that cannot be
    """
    given = np.asarray(values, dtype=float)
    if given.ndim != 1 or not len(given) or not np.isfinite(given).all():
        raise ValueError("give one or more finite values of the quantity")
    fixed = {
        "pressure": pressure_bar,
        "mu": brake.mu if mu is None else mu,
        "slope": brake.slope_s_m if slope_s_m is None else slope_s_m,
        "slip": slip_m_s,
    }
    arrays = {name: np.full(len(given), float(value)) for name, value in fixed.items()}
    brakes: tuple[Brake, ...] = (brake,)
    unit = WORKING_QUANTITIES.get(quantity, "")
    if quantity in arrays:
        arrays[quantity] = given
    elif quantity in brake.spec.parameters:
        unit = brake.spec.parameters[quantity].unit
        brakes = tuple(brake.with_parameters(**{quantity: float(value)}) for value in given)
    else:
        raise KeyError(
            f"unknown quantity {quantity!r}; use {', '.join(WORKING_QUANTITIES)} or a parameter of the brake "
            f"file: {', '.join(brake.spec.parameters)}"
        )
    for name, array in arrays.items():
        if (array < 0.0).any() or (name == "slip" and not (array > 0.0).all()):
            raise ValueError(
                f"{name} must be {'positive' if name == 'slip' else 'not negative'}: {array.min():g}"
            )
    return SquealPoints(
        quantity, unit, given, brakes, arrays["pressure"], arrays["mu"], arrays["slope"], arrays["slip"],
        saturation_m_s,
    )  # fmt: skip


@dataclass(frozen=True)
class CriticalMode:
    """The mode that squeals, or would first, at every point, by eigenvalues of A (eq 27).

    growth_1_s, frequency_hz : (n,)
    states : (n, 2 n_dof) motion of it whose largest speed of a translation or slip is 1 m/s
    """

    growth_1_s: Array
    frequency_hz: Array
    states: Array


def critical_mode(points: SquealPoints) -> CriticalMode:
    """Rightmost oscillating pair; where stable, the pair most like that of the nearest unstable point."""
    n = len(points)
    chosen: list[tuple[complex, Complex]] = []
    decompositions = []
    for i in range(n):
        matrix = points.brake(i).state_matrix(
            points.mu[i], points.slope_s_m[i], points.pressure_bar[i] * PA_PER_BAR
        )
        decomposition = np.linalg.eig(matrix)
        values: Complex = decomposition[0].astype(complex)
        vectors: Complex = decomposition[1].astype(complex)
        kept = (values.imag > 0.0) | (values.real > 0.0)
        if not kept.any():
            kept[:] = True
        values, vectors = values[kept], vectors[:, kept]
        at = int(np.argmax(values.real))
        decompositions.append((values, vectors / np.linalg.norm(vectors, axis=0)))
        chosen.append((complex(values[at]), decompositions[-1][1][:, at]))
    unstable = np.flatnonzero([value.real > 0.0 for value, _ in chosen])
    for i in range(n):
        if len(unstable) and chosen[i][0].real <= 0.0:
            near = chosen[int(unstable[np.argmin(np.abs(unstable - i))])][1]
            values, vectors = decompositions[i]
            at = int(np.argmax(np.abs(vectors.conj().T @ near)))
            chosen[i] = (complex(values[at]), vectors[:, at])
    states = np.stack([_scaled(points.brake(i), vector) for i, (_, vector) in enumerate(chosen)])
    growth = np.array([value.real for value, _ in chosen])
    return CriticalMode(growth, np.array([abs(value.imag) / (2.0 * np.pi) for value, _ in chosen]), states)


def _scaled(brake: Brake, vector: Complex) -> Array:
    """Motion (2 n_dof,) of an eigenvector whose largest speed of a translation or slip is 1 m/s."""
    speeds = vector[brake.n_dof :]
    along = [i for i, name in enumerate(brake.freedoms) if not name.endswith(".phi")]
    slips = [group.slip_row @ speeds for group in friction_groups(brake)]
    return (vector / max(np.abs(speeds[along]).max(), *(abs(slip) for slip in slips))).real

"""Nonlinear coupling laws: cubic hardening springs and one-sided contacts (section 4.4; eqs 8, 9).

A line of a coupling element carries F = c u + c3 u^3 + d v, with u, v its relative displacement and velocity,
all counted from the steadily sliding state: c is the tangent there, so that M, D, K and everything linear are
those of small motions, whatever c3 is. A one-sided contact cannot pull: its whole normal force, mean and
variation, is max(0, N0 + N~). Here are the laws as formulas, the strength at which hardening doubles the
stiffness, and the guard for what is made for linear couplings only.
NOT its job: friction (`friction`), matrices and loops over couplings (`assembly`), integration (`motion`).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    from sim_hardware.brake_model.assembly import Brake

Array = NDArray[np.float64]

#: origin noted for cubic values that a study puts into a brake
_ORIGIN = "chosen by a study: hardening that doubles the stiffness at a given compression (section 4.4)"


def spring_force(stiffness: ArrayLike, cubic: ArrayLike, strain: ArrayLike) -> Array:
    """Restoring force c u + c3 u^3 (eqs 8, 9); any shapes that fit; N or N m."""
    u = np.asarray(strain, dtype=float)
    return (np.asarray(stiffness) + np.asarray(cubic) * u * u) * u


def spring_energy(stiffness: ArrayLike, cubic: ArrayLike, strain: ArrayLike) -> Array:
    """Energy c u^2/2 + c3 u^4/4 stored in the spring (N m)."""
    square = np.asarray(strain, dtype=float) ** 2
    return (0.5 * np.asarray(stiffness) + 0.25 * np.asarray(cubic) * square) * square


def spring_tangent(stiffness: ArrayLike, cubic: ArrayLike, strain: ArrayLike) -> Array:
    """Tangent stiffness c + 3 c3 u^2 (N/m or N m/rad)."""
    return np.asarray(stiffness) + 3.0 * np.asarray(cubic) * np.asarray(strain, dtype=float) ** 2


def one_sided_energy(stiffness: float, cubic: float, mean_force_n: float, strain: ArrayLike) -> Array:
    """Energy stored in a contact spring whose whole force is max(0, N0 + c u + c3 u^3), counted from u = 0
    and without the work of the mean force N0 (N m)."""
    gap = release_strain(stiffness, cubic, mean_force_n)
    u = np.asarray(strain, dtype=float)
    pressed = spring_energy(stiffness, cubic, np.maximum(u, gap))
    return pressed - mean_force_n * np.minimum(u - gap, 0.0)


def release_strain(stiffness: float, cubic: float, mean_force_n: float) -> float:
    """Compression (m, <= 0) from the mean state at which c u + c3 u^3 = -N0: the spring is just free."""
    if mean_force_n == 0.0:
        return 0.0
    u = -mean_force_n / stiffness
    for _ in range(60):  # Newton on a convex, monotone function from outside: no step overshoots
        change = (float(spring_force(stiffness, cubic, u)) + mean_force_n) / float(
            spring_tangent(stiffness, cubic, u)
        )
        u -= change
        if abs(change) <= 1e-15 * abs(u):
            break
    return u


def cubic_for_doubled_stiffness(stiffness: float, at_m: float) -> float:
    """c3 (N/m3 or N m/rad3) at which the tangent stiffness has doubled at the compression `at_m`.

    Raises
    ------
    ValueError
        not positive
    """
    if not (math.isfinite(at_m) and at_m > 0.0 and stiffness > 0.0):
        raise ValueError(
            f"stiffness {stiffness!r}, doubled at {at_m!r} m: give positive numbers, for example 50e-6"
        )
    return stiffness / (3.0 * at_m**2)


def with_cubic_contacts(brake: Brake, *, doubled_at_m: float = 50e-6, strength: float = 1.0) -> Brake:
    """Return the brake with cubic hardening in all its pad-disc contacts (section 4.4).

    Parameters
    ----------
    doubled_at_m : compression at which the tangent stiffness has doubled for `strength` 1; 50 micrometres is
        what a lining of 10 to 15 mm shows in compression tests
    strength : factor on all c3; 0 gives the linear brake

    Raises
    ------
    ValueError
        not positive, strength negative or not finite
    """
    if not (math.isfinite(strength) and strength >= 0.0):
        raise ValueError(f"strength is {strength!r}: give a finite number, 0 or more")
    data = brake.spec.model_dump()
    stiffness = {element.name: element.stiffness_n_m[1] for element in brake.contacts}
    for coupling in data["couplings"]:
        if coupling["name"] in stiffness:
            name = f"c3_{coupling['name']}"[:40]
            value = strength * cubic_for_doubled_stiffness(stiffness[coupling["name"]], doubled_at_m)
            data["parameters"][name] = {"value": value, "unit": "N/m3", "origin": _ORIGIN}
            coupling["cubic"] = name
    for name in sorted(_unused_cubic(brake, data)):
        del data["parameters"][name]
    return type(brake)(type(brake.spec).model_validate(data))


def _unused_cubic(brake: Brake, data: dict[str, object]) -> set[str]:
    """Parameters in N/m3 of the brake that nothing names any more once the contacts have their own."""
    texts = [str(value) for coupling in data["couplings"] for value in coupling.values()]  # type: ignore[attr-defined]
    words = {word for text in texts for word in text.replace("(", " ").replace(")", " ").split()}
    return {
        name
        for name, parameter in brake.spec.parameters.items()
        if parameter.unit == "N/m3" and name not in words
    }


def nonlinear_couplings(brake: Brake) -> tuple[str, ...]:
    """Names of the couplings and torsions with a law that is not linear."""
    found = [e.name for e in brake.elements if any(e.cubic_n_m3) or e.one_sided]
    return (*found, *(t.name for t in brake.torsions if t.cubic_nm_rad3))


def require_linear(brake: Brake, what: str) -> None:
    """Refuse a brake with nonlinear couplings where only linear ones are computed.

    Raises
    ------
    ValueError
        names the couplings and the remedy
    """
    names = nonlinear_couplings(brake)
    if names:
        shown = ", ".join(names[:4]) + (", …" if len(names) > 4 else "")
        raise ValueError(
            f"{what} takes linear couplings only, and the brake '{brake.name}' has {len(names)} with a "
            f"cubic or one-sided law ({shown}); use motion.integrate (rigctl model simulate), or remove "
            "`cubic` and `one_sided` from the brake file"
        )

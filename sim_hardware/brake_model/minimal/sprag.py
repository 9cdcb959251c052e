"""Spurr's geometric instability in Crisp's linear form (Table 1 middle, section 1.2): sprag-slip.

Our equation of motion (the paper prints the criterion only). The pad moves along a strut that meets the
disc's surface at the angle gamma: displacement x along the strut is x cos(gamma) with the friction and x
sin(gamma) into the disc. The disc answers as damper d1 (and, if given, spring c1) normal to its surface, N~
= d1 x' sin(gamma) + c1 x sin(gamma), the pad's own support as damper d2 and spring c2 along the strut.
Normal force and friction mu N~ do work on x:

    m x'' + [d2 + d1 sin(gamma) (sin(gamma) - mu cos(gamma))] x'
          + [c2 + c1 sin(gamma) (sin(gamma) - mu cos(gamma))] x = 0

The damping is negative exactly where mu > tan(gamma) + 2 d2 / (sin(2 gamma) d1) for gamma > 0; for gamma < 0
one divides by a negative number and the relation turns round: mu < ... , a negative mu, that is the disc
turning the other way. NOT its job: figures.
"""

from __future__ import annotations

import cmath
import math
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import BaseModel, ConfigDict, Field

Array = NDArray[np.float64]


class SpragModel(BaseModel):
    """Parameters of the strut model. mu < 0 means that the disc turns the other way."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    mass_kg: Annotated[float, Field(gt=0.0)]
    angle_rad: Annotated[float, Field(gt=-math.pi / 2, lt=math.pi / 2)]
    disc_damping_ns_m: Annotated[float, Field(ge=0.0, description="d1, normal to the disc")]
    pad_damping_ns_m: Annotated[float, Field(ge=0.0, description="d2, along the strut")]
    pad_stiffness_n_m: Annotated[float, Field(ge=0.0, description="c2, along the strut")]
    disc_stiffness_n_m: Annotated[float, Field(ge=0.0, description="c1, normal to the disc")] = 0.0

    @property
    def critical_mu(self) -> float:
        """tan(gamma) + 2 d2 / (sin(2 gamma) d1), the criterion of Table 1; see `unstable` for its sense."""
        return float(critical_mu(self.angle_rad, self.disc_damping_ns_m, self.pad_damping_ns_m))

    @property
    def locking_mu(self) -> float:
        """The same with stiffnesses, tan(gamma) + 2 c2 / (sin(2 gamma) c1): static locking (divergence)."""
        return float(critical_mu(self.angle_rad, self.disc_stiffness_n_m, self.pad_stiffness_n_m))

    def damping_ns_m(self, mu: float) -> float:
        """Coefficient of x'."""
        return self.pad_damping_ns_m + self.disc_damping_ns_m * self._feedback(mu)

    def stiffness_n_m(self, mu: float) -> float:
        """Coefficient of x; negative where the strut locks."""
        return self.pad_stiffness_n_m + self.disc_stiffness_n_m * self._feedback(mu)

    def unstable(self, mu: float) -> bool:
        """The criterion with its sense: mu above it for gamma > 0, below it for gamma < 0, never at gamma =
        0."""
        if self.angle_rad == 0.0:
            return False
        return mu > self.critical_mu if self.angle_rad > 0.0 else mu < self.critical_mu

    def eigenvalues(self, mu: float) -> tuple[complex, complex]:
        """Both eigenvalues (1/s) of the equation of motion, larger real part first."""
        half = 0.5 * self.damping_ns_m(mu) / self.mass_kg
        square = self.stiffness_n_m(mu) / self.mass_kg
        root = cmath.sqrt(half * half - square)
        if root.imag != 0.0:
            return complex(-half, abs(root.imag)), complex(-half, -abs(root.imag))
        far = -half - math.copysign(root.real, half)
        near = square / far if far != 0.0 else 0.0  # free of cancellation
        return complex(max(near, far)), complex(min(near, far))

    def _feedback(self, mu: float) -> float:
        sine = math.sin(self.angle_rad)
        return sine * (sine - mu * math.cos(self.angle_rad))


def critical_mu(angles_rad: ArrayLike, disc: float, pad: float) -> Array:
    """Criterion of Table 1 over the angle: tan(gamma) + 2 pad / (sin(2 gamma) disc), signed as the angle.

    `disc`, `pad`: both dampings (or both stiffnesses). inf at angle 0 and, with pad > 0, for disc = 0: no
    friction is enough.

    Raises
    ------
    ValueError
        an angle of 90 degrees or more, a negative damping
    """
    angles = np.asarray(angles_rad, dtype=float)
    if not np.all(np.abs(angles) < math.pi / 2):
        raise ValueError(
            f"angle = {math.degrees(float(np.max(np.abs(angles)))):g}°: give angles between -90° and 90°"
        )
    if not (disc >= 0.0 and pad >= 0.0):
        raise ValueError(f"disc = {disc:g}, pad = {pad:g}: give dampings (stiffnesses) of at least 0")
    sines = np.sin(2.0 * angles) * disc
    result = np.full(angles.shape, math.inf)
    usable = sines != 0.0
    result[usable] = np.tan(angles[usable]) + 2.0 * pad / sines[usable]
    if disc == 0.0:
        return np.where(angles < 0.0, -math.inf, math.inf)
    return result


def smallest_critical_mu(damping_ratio: float) -> tuple[float, float]:
    """Smallest mu at which any angle is unstable, and that angle (rad), for d2 / d1 = `damping_ratio`.

    With t = tan(gamma) the criterion is (1 + r) t + r / t; its smallest value is 2 sqrt(r (1 + r)) at
    t = sqrt(r / (1 + r)).

    Raises
    ------
    ValueError
        not a ratio of at least 0
    """
    if not 0.0 <= damping_ratio < math.inf:
        raise ValueError(f"damping_ratio = {damping_ratio:g}: give d2 / d1 of at least 0")
    r = damping_ratio
    return 2.0 * math.sqrt(r * (1.0 + r)), math.atan(math.sqrt(r / (1.0 + r)))


def needed_disc_damping(mu: float) -> float:
    """Smallest d1 / d2 for which some angle is unstable at mu: 2 / (sqrt(1 + mu^2) - 1); the paper's d1 >>
    d2.

    Raises
    ------
    ValueError
        mu not above 0
    """
    if not 0.0 < mu < math.inf:
        raise ValueError(
            f"mu = {mu:g}: no disc damping makes that unstable. Give a coefficient of friction above 0"
        )
    return 2.0 * (math.sqrt(1.0 + mu * mu) + 1.0) / (mu * mu)  # free of cancellation

"""The 1-DOF oscillator on a moving belt (Table 1 left, sections 1.1 and 5.2): data, equilibrium, criterion.

    m x'' + d x' + c x = mu(|v|) F_n sgn(v),   v = v_belt - x'                                   (eq 29)

Job: parameters as frozen data, equilibrium, linearised stability, dimensionless form (eqs 30, 31).
NOT its job: motion in time (`motion`), limit cycles (`cycles`).
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from sim_hardware.brake_model.minimal.laws import BeltLaw


class BeltOscillator(BaseModel):
    """Mass on a spring and damper, pressed on a belt that moves with constant speed."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    mass_kg: Annotated[float, Field(gt=0.0)]
    stiffness_n_m: Annotated[float, Field(ge=0.0)]
    damping_ns_m: Annotated[float, Field(ge=0.0)] = 0.0
    normal_force_n: Annotated[float, Field(ge=0.0)]
    belt_speed_m_s: Annotated[float, Field(ge=0.0)]
    law: BeltLaw

    @property
    def angular_frequency_1_s(self) -> float:
        """sqrt(c / m), rad/s."""
        return math.sqrt(self.stiffness_n_m / self.mass_kg)

    @property
    def frequency_hz(self) -> float:
        """Natural frequency without damping and friction."""
        return self.angular_frequency_1_s / (2.0 * math.pi)

    @property
    def holding_force_n(self) -> float:
        """Largest spring and damper force that sticking can hold: mu_static F_n."""
        return self.law.mu_static * self.normal_force_n

    def friction_n(self, velocity_m_s: float) -> float:
        """Friction force on the mass while it slides at the velocity `velocity_m_s` (right side of eq 29)."""
        slip = self.belt_speed_m_s - velocity_m_s
        return math.copysign(self.law.sliding(abs(slip)) * self.normal_force_n, slip)

    @property
    def effective_damping_ns_m(self) -> float:
        """d + F_n dmu/dv_rel at the equilibrium."""
        return self.damping_ns_m + self.normal_force_n * self.law.slope(self.belt_speed_m_s)

    @property
    def slope_s_m(self) -> float:
        """dmu/dv_rel at x' = 0, the left side of the criterion of Table 1."""
        return self.law.slope(self.belt_speed_m_s)

    @property
    def critical_slope_s_m(self) -> float:
        """-d / F_n, the right side of the criterion of Table 1; -inf without normal force and with
        damping."""
        if self.normal_force_n == 0.0:
            return -math.inf if self.damping_ns_m > 0.0 else 0.0
        return 0.0 - self.damping_ns_m / self.normal_force_n

    @property
    def falls_too_steeply(self) -> bool:
        """Criterion of Table 1: dmu/dv_rel < -d / F_n, the equilibrium is unstable."""
        return self.slope_s_m < self.critical_slope_s_m

    @property
    def damping_ratio(self) -> float:
        """D (eq 31, with the structural damping d added): (d + F_n dmu/dv_rel) / (2 sqrt(c m)).

        Raises
        ------
        ValueError
            no stiffness: nothing to compare the damping with
        """
        self._need_stiffness("the damping ratio D")
        return self.effective_damping_ns_m / (2.0 * math.sqrt(self.stiffness_n_m * self.mass_kg))

    @property
    def equilibrium_m(self) -> float:
        """Position at which the mass slides steadily, x' = 0.

        Raises
        ------
        ValueError
            no stiffness (no such position), or belt at rest (a whole range: `resting_range_m`)
        """
        self._need_stiffness("the equilibrium")
        if self.belt_speed_m_s == 0.0:
            raise ValueError(
                "belt_speed_m_s = 0: the mass rests anywhere within resting_range_m, there is no single "
                "equilibrium. Give a belt speed above 0"
            )
        return self.friction_n(0.0) / self.stiffness_n_m

    @property
    def resting_range_m(self) -> tuple[float, float]:
        """Positions at which the mass can rest on a belt at rest.

        Raises
        ------
        ValueError
            no stiffness: it can rest anywhere
        """
        self._need_stiffness("the range of rest")
        reach = self.holding_force_n / self.stiffness_n_m
        return -reach, reach

    @property
    def stick_end_m(self) -> float:
        """Position at which sticking ends: c x + d v_belt = mu_static F_n.

        Raises
        ------
        ValueError
            no stiffness: sticking never ends
        """
        self._need_stiffness("the end of sticking")
        return (self.holding_force_n - self.damping_ns_m * self.belt_speed_m_s) / self.stiffness_n_m

    def eigenvalues(self) -> tuple[complex, complex]:
        """Both eigenvalues (1/s) of the motion linearised at the equilibrium, larger real part first.

        Unstable exactly where `falls_too_steeply`. Free of the equilibrium's place, so also without
        stiffness.
        """
        half = 0.5 * self.effective_damping_ns_m / self.mass_kg
        square = self.stiffness_n_m / self.mass_kg
        root = cmath.sqrt(half * half - square)
        if root.imag != 0.0:
            return complex(0.0 - half, abs(root.imag)), complex(0.0 - half, -abs(root.imag))
        far = -half - math.copysign(root.real, half)
        near = square / far if far != 0.0 else 0.0  # free of cancellation
        return complex(max(near, far)), complex(min(near, far))

    def dimensionless(self) -> DimensionlessBelt:
        """Time in sqrt(m / c), length in F_n / c (eqs 30, 31).

        Raises
        ------
        ValueError
            no stiffness or no normal force: no scale of time or of length
        """
        self._need_stiffness("the dimensionless form")
        if self.normal_force_n == 0.0:
            raise ValueError(
                "normal_force_n = 0: the dimensionless form measures length in F_n / c. "
                "Give a normal force above 0"
            )
        impedance = math.sqrt(self.stiffness_n_m * self.mass_kg)
        slope = self.law.slope(self.belt_speed_m_s)
        return DimensionlessBelt(
            friction_damping=self.normal_force_n * slope / (2.0 * impedance),  # eq 31
            structural_damping=self.damping_ns_m / (2.0 * impedance),
            belt_speed=self.belt_speed_m_s * impedance / self.normal_force_n,
            time_scale_s=1.0 / self.angular_frequency_1_s,
            length_scale_m=self.normal_force_n / self.stiffness_n_m,
            oscillator=BeltOscillator(
                mass_kg=1.0,
                stiffness_n_m=1.0,
                damping_ns_m=self.damping_ns_m / impedance,
                normal_force_n=1.0,
                belt_speed_m_s=self.belt_speed_m_s * impedance / self.normal_force_n,
                law=self.law.model_copy(update=_scaled(self.law, self.normal_force_n / impedance)),
            ),
        )

    def with_speed(self, belt_speed_m_s: float) -> BeltOscillator:
        """The same at another belt speed, validated."""
        return self.changed(belt_speed_m_s=belt_speed_m_s)

    def changed(self, **fields: object) -> BeltOscillator:
        """The same with other fields, validated."""
        return BeltOscillator.model_validate(dict(self) | fields)

    def _need_stiffness(self, what: str) -> None:
        if self.stiffness_n_m == 0.0:
            raise ValueError(f"stiffness_n_m = 0: {what} does not exist. Give a stiffness above 0")


@dataclass(frozen=True, slots=True)
class DimensionlessBelt:
    """The oscillator in units of its own: x'' + 2 D x' + x = mu_0 sgn(v) - kappa v_0 (eq 30 divided by F_n /
    c).

    Attributes
    ----------
    friction_damping : D of eq 31, negative for a falling law: F_n dmu/dv / (2 sqrt(c m))
    structural_damping : d / (2 sqrt(c m)), which the paper ignores in eq 29
    belt_speed : v_belt sqrt(c m) / F_n
    time_scale_s, length_scale_m : sqrt(m / c), F_n / c
    oscillator : with m = c = F_n = 1, its law over the scaled speed
    """

    friction_damping: float
    structural_damping: float
    belt_speed: float
    time_scale_s: float
    length_scale_m: float
    oscillator: BeltOscillator

    @property
    def damping(self) -> float:
        """Sum of both."""
        return self.friction_damping + self.structural_damping


def _scaled(law: BeltLaw, speed_scale_m_s: float) -> dict[str, float]:
    """Fields of a law whose argument is the speed divided by `speed_scale_m_s`."""
    update: dict[str, float] = {}
    for name, value in law:
        if name in ("slope_s_m", "viscous_s_m"):
            update[name] = value * speed_scale_m_s
        elif name == "speed_scale_m_s":
            update[name] = value / speed_scale_m_s
    return update

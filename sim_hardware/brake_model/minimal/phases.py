"""Single phases of the belt oscillator: closed solutions where the friction law is affine, else integrated.

Job: position and velocity over the time within a phase, and the first time at which the velocity crosses a
level from one side. NOT its job: which phase follows (`motion`).

A crossing of a closed solution is exact: the extrema of the velocity are known in closed form, between two of
them the velocity is monotone, so no crossing can be missed and each is bracketed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

Array = NDArray[np.float64]
Direction = Literal[-1, 1]

#: tolerances of integrated phases, relative and absolute (of the scale of each state)
_RTOL, _ATOL = 1e-11, 1e-13
_STEPS_A_PERIOD = 12
#: exponent beyond which a growing motion leaves the range of numbers that mean anything
_MAX_GROWTH = 500.0


class Motion(Protocol):
    """x(t), x'(t) of one phase; t from the beginning of the phase."""

    def at(self, times_s: Array) -> tuple[Array, Array]:
        """Positions (m) and velocities (m/s), same shape as the times."""
        ...


@dataclass(frozen=True, slots=True)
class Sticking:
    """The mass moves with the belt."""

    start_m: float
    speed_m_s: float

    def at(self, times_s: Array) -> tuple[Array, Array]:
        """x = x0 + v t."""
        return self.start_m + self.speed_m_s * times_s, np.full_like(times_s, self.speed_m_s)


@dataclass(frozen=True, slots=True)
class LinearSliding:
    """x'' + 2 delta x' + w2 x = constant, closed solution.

    Attributes
    ----------
    delta_1_s, w2_1_s2 : coefficients; delta may be negative, w2 may be 0
    position_m, velocity_m_s, acceleration_m_s2 : at t = 0. The acceleration is given apart, because it is
        exactly 0 where a continuous law lets go, which subtraction of forces would not give
    """

    delta_1_s: float
    w2_1_s2: float
    position_m: float
    velocity_m_s: float
    acceleration_m_s2: float

    def at(self, times_s: Array) -> tuple[Array, Array]:
        """Positions and velocities at any times >= 0."""
        t = np.asarray(times_s, dtype=float)
        cosine, sine = self._basis(t)
        integral = self._integral_of_sine(t, cosine)
        position = (
            self.position_m
            + self.velocity_m_s * (sine + 2.0 * self.delta_1_s * integral)
            + self.acceleration_m_s2 * integral
        )
        return position, self.velocity_m_s * cosine + self.acceleration_m_s2 * sine

    def velocity(self, time_s: float) -> float:
        """Velocity at one time: the formula of `at` for a number, as events are searched with it."""
        delta, t = self.delta_1_s, time_s
        self._check_growth(t)
        square = delta**2 - self.w2_1_s2
        if square < 0.0:
            omega = math.sqrt(-square)
            decay = math.exp(-delta * t)
            sine = decay * math.sin(omega * t) / omega
            cosine = decay * math.cos(omega * t) + delta * sine
        else:
            sigma, slow = math.sqrt(square), math.exp(-self._slowest_1_s() * t)
            sine = slow * (-math.expm1(-2.0 * sigma * t) / (2.0 * sigma) if sigma > 0.0 else t)
            cosine = 0.5 * slow * (1.0 + math.exp(-2.0 * sigma * t)) + delta * sine
        return self.velocity_m_s * cosine + self.acceleration_m_s2 * sine

    def _basis(self, t: Array) -> tuple[Array, Array]:
        """Solutions of u'' + 2 delta u' + w2 u = 0 with (u, u') = (1, 0) and (0, 1) at t = 0."""
        self._check_growth(float(np.max(t, initial=0.0)))
        square = self.delta_1_s**2 - self.w2_1_s2
        if square < 0.0:
            omega = math.sqrt(-square)
            decay = np.exp(-self.delta_1_s * t)
            sine = decay * np.sin(omega * t) / omega
            return decay * np.cos(omega * t) + self.delta_1_s * sine, sine
        sigma = math.sqrt(square)
        # sinh(sigma t) exp(-delta t) without differences of near numbers, at any sigma down to 0
        slow, closing = np.exp(-self._slowest_1_s() * t), np.exp(-2.0 * sigma * t)
        sine = slow * (-np.expm1(-2.0 * sigma * t) / (2.0 * sigma) if sigma > 0.0 else t)
        return 0.5 * slow * (1.0 + closing) + self.delta_1_s * sine, sine

    def _slowest_1_s(self) -> float:
        """Rate of the slower decay (the faster growth) where the motion does not vibrate."""
        sigma = math.sqrt(max(0.0, self.delta_1_s**2 - self.w2_1_s2))
        return self.w2_1_s2 / (self.delta_1_s + sigma) if self.delta_1_s > 0.0 else self.delta_1_s - sigma

    def _check_growth(self, time_s: float) -> None:
        if self.delta_1_s < 0.0 and -self._slowest_1_s() * time_s > _MAX_GROWTH:
            raise ValueError(
                f"damping of the sliding phase = {2.0 * self.delta_1_s:g} 1/s: over {time_s:g} s "
                "the motion grows beyond all numbers. Ask for a shorter time or a smaller slope"
            )

    def _integral_of_sine(self, t: Array, cosine: Array) -> Array:
        """Integral of the second basis solution from 0: the answer to a unit acceleration."""
        delta, w2 = self.delta_1_s, self.w2_1_s2
        small = (abs(delta) * t < 0.1) & (w2 * t**2 < 0.01)
        series, previous, term = 0.5 * t**2, np.zeros_like(t), 0.5 * t**2
        for n in range(1, 11):
            bracket = 2.0 * delta * (n + 1) * t * term + w2 * t**2 * previous
            previous, term = term, -bracket / ((n + 2) * (n + 1))
            series = series + term
        if np.all(small):
            return series
        if w2 > 0.1 * delta**2:
            return np.where(small, series, (1.0 - cosine) / w2)
        far = -delta - math.copysign(math.sqrt(delta**2 - w2), delta)
        near = w2 / far

        def grown(root: float) -> Array:
            return np.expm1(root * t) / root if root != 0.0 else t

        return np.where(small, series, (grown(near) - grown(far)) / (near - far))

    def _extrema(self, limit_s: float) -> Iterator[float]:
        """Times > 0 of the extrema of the velocity, up to `limit_s`, then `limit_s`."""
        square = self.delta_1_s**2 - self.w2_1_s2
        a = self.acceleration_m_s2
        b = -self.delta_1_s * a - self.w2_1_s2 * self.velocity_m_s  # jerk + delta a
        if square < 0.0:  # a cos(w t) + (b / w) sin(w t) = 0
            omega = math.sqrt(-square)
            angle = math.pi if a == 0.0 else math.atan2(-a * omega, b) % math.pi
            step = 0
            while (time := (angle + math.pi * step) / omega) < limit_s:
                yield time
                step += 1
        elif b != 0.0:  # tanh(sigma t) = -a sigma / b
            sigma = math.sqrt(square)
            q = -a / b
            if q > 0.0 and sigma * q < 1.0:
                time = math.atanh(sigma * q) / sigma if sigma * q > 1e-8 else q
                if time < limit_s:
                    yield time
        yield limit_s

    def crossing(self, level_m_s: float, direction: Direction, limit_s: float) -> float | None:
        """First time in (0, limit] at which the velocity crosses a level upwards (1) or downwards (-1)."""
        before_t, before = 0.0, direction * (self.velocity_m_s - level_m_s)
        for passed, time in enumerate(self._extrema(limit_s)):
            value = direction * (self.velocity(time) - level_m_s)
            if before < 0.0 <= value:
                return self._refine(level_m_s, before_t, time)
            if passed > 2 and self.delta_1_s >= 0.0 and self.w2_1_s2 > 0.0:
                return None  # the extrema do not grow: what they did not reach in a period they never will
            before_t, before = time, value
        return None

    def _refine(self, level_m_s: float, low_s: float, high_s: float) -> float:
        def error(time: float) -> float:
            return self.velocity(time) - level_m_s

        if error(high_s) == 0.0:
            return high_s
        if error(low_s) == 0.0:  # a root of the wrong side at the beginning: step off it
            low_s = math.nextafter(low_s, high_s)
        return root_between(error, low_s, high_s)


def root_between(error: Callable[[float], float], low: float, high: float) -> float:
    """Root between two arguments at which a function has opposite signs, to rounding."""
    return brentq(error, low, high, xtol=1e-16 * high, rtol=1e-15)  # type: ignore[arg-type,return-value]


@dataclass(frozen=True, slots=True)
class IntegratedSliding:
    """Sliding under any smooth law, integrated up to its end (DOP853, relative tolerance 1e-11)."""

    solution: Callable[[Array], Array]

    def at(self, times_s: Array) -> tuple[Array, Array]:
        """Positions and velocities within the time integrated."""
        states = self.solution(np.asarray(times_s, dtype=float))
        return states[0], states[1]


def integrate_sliding(
    acceleration: Callable[[float, float], float],
    position_m: float,
    velocity_m_s: float,
    levels: tuple[tuple[float, Direction], ...],
    *,
    limit_s: float,
    period_s: float,
    scales: tuple[float, float],
) -> tuple[IntegratedSliding, float, int | None]:
    """Integrate a sliding phase until the velocity crosses one of the levels, or to `limit_s`.

    Parameters
    ----------
    acceleration : (x, x') -> x''
    levels : (velocity, direction) that end the phase
    period_s : of the oscillator; steps stay well below it, so that no crossing is stepped over
    scales : sizes of position and velocity, for the absolute tolerances

    Returns
    -------
    motion, duration, index of the level that was crossed (None: the time was over)

    Raises
    ------
    ArithmeticError
        the integration failed
    """

    initial = acceleration(position_m, velocity_m_s)

    def rate(_: float, state: Array) -> tuple[float, float]:
        return float(state[1]), acceleration(float(state[0]), float(state[1]))

    def event(level: float, direction: Direction) -> Callable[[float, Array], float]:
        def distance(time: float, state: Array) -> float:
            if time == 0.0 and velocity_m_s == level:  # on the side to which the motion leaves
                return math.copysign(5e-324, initial) if initial != 0.0 else 0.0
            return float(state[1]) - level

        distance.terminal = True  # type: ignore[attr-defined]
        distance.direction = float(direction)  # type: ignore[attr-defined]
        return distance

    result = solve_ivp(
        rate,
        (0.0, limit_s),
        (position_m, velocity_m_s),
        method="DOP853",
        rtol=_RTOL,
        atol=[_ATOL * s for s in scales],
        max_step=period_s / _STEPS_A_PERIOD,
        dense_output=True,
        events=[event(*level) for level in levels],
    )
    if not result.success:
        raise ArithmeticError(
            f"sliding from x = {position_m:g} m, x' = {velocity_m_s:g} m/s: {result.message}"
        )
    crossed = next((i for i, times in enumerate(result.t_events) if times.size), None)
    return IntegratedSliding(result.sol), float(result.t[-1]), crossed

"""What a tracked locus shows: crossings of the imaginary axis, refined; and which modes couple (Fig. 7).

NOT its job: tracking (`tracking`), boundaries over two quantities.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from sim_hardware.brake_model.eigen.tracking_locus import Crossing, Locus
from sim_hardware.brake_model.eigen.tracking_nodes import ComplexArray, Node
from sim_hardware.brake_model.linear import Array

NodeAt = Callable[[float], Node]

#: real parts smaller than this share of the largest modulus are zero: on the axis
_ON_AXIS = 1e-9
_TOLERANCE = 1e-13
_ITERATIONS = 80
#: least strength of a coupling of modes that deserves the name
COUPLED = 0.3


def crossings_of(locus: Locus, node: NodeAt) -> tuple[Crossing, ...]:
    """Return where modes cross the imaginary axis, along the grid.

    A step is searched where the sign of a real part differs at its ends, or where its cubic through values
    and derivatives leaves the half plane in between. Refined by Newton's method with eq. 24, kept within
    the step.
    """
    s = locus.fine_grid
    found: list[tuple[float, Crossing]] = []
    limit = _ON_AXIS * float(np.nanmax(np.abs(locus.fine_eigenvalues), initial=1e-300))
    for member, curves in enumerate((locus.fine_eigenvalues, locus.fine_partners)):
        values, rates = curves, locus.fine_rates
        signs = np.where(values.real > limit, 1, -1)  # only leaving the axis to the right makes unstable
        for k, m in np.argwhere(signs[:-1] != signs[1:]).tolist():
            if member == 1 and not (_real(values[k, m]) and _real(values[k + 1, m])):
                continue  # conjugates cross together
            if not np.isfinite(values[[k, k + 1], m]).all():
                continue  # a mode that was lost
            crossing = _refined(s, values, k, m, node, limit)
            if crossing is not None:
                found.append((abs(crossing.value - s[0]), crossing))
        if member == 0:
            found += [
                (abs(c.value - s[0]), c)
                for c in _touching(s, values, rates, signs, node, limit)
                if c is not None
            ]
    found.sort(key=lambda item: item[0])
    return tuple(crossing for _, crossing in found)


def _real(value: complex) -> bool:
    return value.imag == 0.0


def _touching(
    s: Array, values: ComplexArray, rates: ComplexArray, signs: Array, node: NodeAt, limit: float
) -> Iterator[Crossing | None]:
    """Steps that begin and end on one side but cross in between, by their Hermite cubics."""
    h = np.diff(s)[:, None]
    a, b, da, db = values[:-1].real, values[1:].real, h * rates[:-1].real, h * rates[1:].real
    usable = np.isfinite(da) & np.isfinite(db) & (signs[:-1] == signs[1:])
    t = np.linspace(0.0, 1.0, 9)[1:-1][:, None, None]
    cubic = (
        (2 * t**3 - 3 * t**2 + 1) * a + (t**3 - 2 * t**2 + t) * da
        + (3 * t**2 - 2 * t**3) * b + (t**3 - t**2) * db
    )  # fmt: skip
    beyond = np.where(signs[:-1] < 0, cubic.max(axis=0) > limit, cubic.min(axis=0) < -limit) & usable
    for k, m in np.argwhere(beyond).tolist():
        best = cubic[:, k, m].argmax() if signs[k, m] < 0 else cubic[:, k, m].argmin()
        share = float(t[best, 0, 0])
        middle = node(float(s[k] + share * (s[k + 1] - s[k])))
        guess = values[k, m] + share * (values[k + 1, m] - values[k, m])
        z = middle.values[np.argmin(np.abs(middle.values - guess))]
        if (z.real > limit) != (signs[k, m] > 0):
            for ends in ((s[k], middle.s), (middle.s, s[k + 1])):
                pair = (values[k, m], z) if ends[1] == middle.s else (z, values[k + 1, m])
                yield _refined(np.array(ends), np.array(pair)[:, None], 0, 0, node, limit, mode=int(m) + 1)


@dataclass(frozen=True, slots=True)
class ModeCoupling:
    """How two modes couple over a locus: frequencies close up while real parts part (Fig. 7, section 1.3).

    Attributes
    ----------
    modes : numbers, from 1
    strength : sqrt(closing * parting), 0: none; from `COUPLED` on it deserves the name
    closing : share of the frequency gap at the start that is gone at the end
    parting : growth of the gap of the real parts, relative to the (angular) frequency gap at the start
    nearest_value, nearest_gap_hz : grid value of the least frequency gap, and that gap
    frequencies_hz, real_parts_1_s : of the two modes at the start, at `nearest_value` and at the end
    exceptional_value, distance : value of the parameter where they would coincide, were the model free to
        take complex values: its real part, and the imaginary part as distance from that; by eq. 24 at the
        nearest point
    """

    modes: tuple[int, int]
    strength: float
    closing: float
    parting: float
    nearest_value: float
    nearest_gap_hz: float
    frequencies_hz: tuple[tuple[float, float], ...]
    real_parts_1_s: tuple[tuple[float, float], ...]
    exceptional_value: float
    distance: float

    @property
    def coupled(self) -> bool:
        """Whether the two modes couple visibly."""
        return self.strength >= COUPLED


def mode_couplings(locus: Locus) -> tuple[ModeCoupling, ...]:
    """Return all pairs of vibrating modes whose frequencies close up while their real parts part, strongest
    first.

    Rule: strength = sqrt(closing * parting) over the whole grid, both relative to the frequency gap at the
    start.
    """
    z = locus.eigenvalues
    vibrating = np.flatnonzero(np.isfinite(z).all(axis=0) & (z[0].imag > 0.0))
    found = []
    for a, b in itertools.combinations(vibrating.tolist(), 2):
        gap = np.abs(z[:, a].imag - z[:, b].imag)
        apart = np.abs(z[:, a].real - z[:, b].real)
        if gap[0] <= 0.0:
            continue
        closing, parting = 1.0 - gap[-1] / gap[0], (apart[-1] - apart[0]) / gap[0]
        if closing > 0.0 and parting > 0.0:
            found.append(_coupling(locus, (a, b), float(closing), float(parting)))
    return tuple(sorted(found, key=lambda c: -c.strength))


def _coupling(locus: Locus, modes: tuple[int, int], closing: float, parting: float) -> ModeCoupling:
    z = locus.eigenvalues[:, modes]
    nearest = int(np.argmin(np.abs(z[:, 0].imag - z[:, 1].imag)))
    where = int(np.argmin(np.abs(locus.fine_eigenvalues[:, modes[0]] - locus.fine_eigenvalues[:, modes[1]])))
    difference = locus.fine_eigenvalues[where, modes[0]] - locus.fine_eigenvalues[where, modes[1]]
    slope = locus.fine_rates[where, modes[0]] - locus.fine_rates[where, modes[1]]
    # (l_a - l_b)^2 is smooth in the parameter and has a simple zero where they coincide: Newton from here
    step = difference / (2.0 * slope) if np.isfinite(slope) and slope != 0 else complex(np.nan, np.nan)
    rows = (0, nearest, len(z) - 1)

    def both(part: Array) -> tuple[tuple[float, float], ...]:
        return tuple((float(part[k, 0]), float(part[k, 1])) for k in rows)

    return ModeCoupling(
        modes=(modes[0] + 1, modes[1] + 1),
        strength=float(np.sqrt(closing * parting)),
        closing=closing,
        parting=parting,
        nearest_value=float(locus.grid[nearest]),
        nearest_gap_hz=float(np.abs(z[nearest, 0].imag - z[nearest, 1].imag) / (2.0 * np.pi)),
        frequencies_hz=both(z.imag / (2.0 * np.pi)),
        real_parts_1_s=both(z.real),
        exceptional_value=float(locus.fine_grid[where] - step.real),
        distance=float(abs(step.imag)),
    )


def _refined(
    s: Array, values: ComplexArray, k: int, m: int, node: NodeAt, limit: float, *, mode: int | None = None
) -> Crossing | None:
    """Newton with eq 24 on the real part, safeguarded by bisection, between fine points k and k + 1."""
    low, high = float(s[k]), float(s[k + 1])
    z_low, z_high = complex(values[k, m]), complex(values[k + 1, m])
    up = z_high.real > limit
    width = abs(high - low)
    span = max(abs(high), abs(low), width)
    on_axis = min(abs(z_low.real), abs(z_high.real)) <= limit  # nothing to interpolate: leaves the axis
    share = 0.5 if on_axis else z_low.real / (z_low.real - z_high.real)
    value, z, rate = high, z_high, complex(np.nan)
    for _ in range(_ITERATIONS):
        trial = low + share * (high - low)
        here = node(trial)
        part = (trial - low) / (high - low)
        guess = z_low + part * (z_high - z_low)
        candidates = here.values if not (_real(z_low) and _real(z_high)) else here.values.real.astype(complex)
        index = int(np.argmin(np.abs(candidates - guess)))
        z, rate, value = complex(here.values[index]), complex(here.rates[index]), trial
        if (z.real > limit) == up:
            high, z_high = trial, z
        else:
            low, z_low = trial, z
        newton = trial - z.real / rate.real if np.isfinite(rate.real) and rate.real else np.nan
        if (not on_axis and abs(z.real) <= 1e-3 * limit) or abs(high - low) <= _TOLERANCE * span:
            break
        if not on_axis and min(low, high) < newton < max(low, high):
            if abs(newton - trial) <= _TOLERANCE * span:
                value = newton
                break
            share = (newton - low) / (high - low)
        else:
            share = 0.5
    if abs(z) <= 0.0 and not up:
        return None
    frequency = abs(z.imag) / (2.0 * np.pi)
    return Crossing(
        mode=int(m) + 1 if mode is None else mode,
        value=float(value),
        frequency_hz=float(frequency),
        kind="flutter" if frequency > 0.0 else "divergence",
        destabilising=bool(up),
        rate_1_s=float("nan") if on_axis or (rate.real > 0) != up else float(rate.real),
    )

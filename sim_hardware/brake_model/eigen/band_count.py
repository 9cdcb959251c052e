"""How many eigenvalues lie in a rectangle: the argument principle on det T(lambda), by LU factors along its
edge.

The number of zeros of det T inside is the winding number of det T around the edge. Dividing det T by the
product of (lambda - known eigenvalue) leaves a function whose argument varies slowly along the edge, so that
few factors are needed, and whose winding number is the number of eigenvalues inside that are NOT known: 0
proves completeness. A factor exp(c lambda), which has no zeros, takes out the trend of the many far ones.
The number is exact as long as no step along the edge hides a full turn; steps are halved until both halves
turn by less than 0.9 rad and alike. NOT its job: finding eigenvalues.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from sim_hardware.brake_model.eigen.band_pencil import Complex, Pencil

_LARGEST_TURN, _LARGEST_CHANGE = 0.9, 0.45
_FIRST_STEPS = 4  # places[6] and [14] are the middles of the upright sides, [2] and [10] of the others


def missed(
    pencil: Pencil, known: Complex, corners: tuple[complex, complex], *, most_factors: int
) -> int | None:
    """Eigenvalues in the rectangle beyond the known ones; negative where a known one is none.

    Parameters
    ----------
    known : (m,) eigenvalues, each as often as its multiplicity, inside and near the rectangle; none on its
        edge
    corners : lower left, upper right (1/s)
    most_factors : LU factors to spend

    Returns
    -------
    None where that many factors do not suffice
    """
    low, high = corners
    edge = [low, complex(high.real, low.imag), high, complex(low.real, high.imag), low]
    places: list[complex] = []
    for a, b in itertools.pairwise(edge):
        places += [a + (b - a) * step / _FIRST_STEPS for step in range(_FIRST_STEPS)]
    arguments: dict[complex, float] = {}

    def argument(place: complex) -> float:
        if place not in arguments:
            own = pencil.factors(place).argument()
            arguments[place] = own - float(np.sum(np.angle(place - known)))
        return arguments[place] - (trend * place).imag

    trend = (
        0.0 + 0.0j
    )  # of all the eigenvalues far away: exp(trend lambda) has no zeros, so may be divided out
    step = 1e-3 * (high - low)
    up, down = (argument(place + 1j * step.imag) - argument(place) for place in (places[6], places[14]))
    right, left = (argument(place + step.real) - argument(place) for place in (places[2], places[10]))
    trend = complex(
        0.5 * (_wrapped(up) + _wrapped(down)) / step.imag,
        0.5 * (_wrapped(right) + _wrapped(left)) / step.real,
    )
    turned = 0.0
    stack = list(zip(places, [*places[1:], places[0]], strict=True))
    while stack:
        if len(arguments) >= most_factors:
            return None
        a, b = stack.pop()
        middle = 0.5 * (a + b)
        first, second = (_wrapped(argument(q) - argument(p)) for p, q in ((a, middle), (middle, b)))
        if max(abs(first), abs(second)) < _LARGEST_TURN and abs(first - second) < _LARGEST_CHANGE:
            turned += first + second
        else:
            stack += [(a, middle), (middle, b)]
    return round(turned / (2.0 * math.pi))


def _wrapped(angle: float) -> float:
    return (angle + math.pi) % (2.0 * math.pi) - math.pi

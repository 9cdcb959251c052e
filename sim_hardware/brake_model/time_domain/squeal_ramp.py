"""Slow ramps of a working quantity up and down: where squeal sets in and where it ends.

The rubbing surfaces excite the brake all the time, so that squeal can begin. On a ramp of finite speed squeal
sets in late even where its onset is supercritical, because it must grow out of the noise first; ramps of
several speeds tell this delay from hysteresis proper.
NOT its job: steady motions (`limit_cycle`), sound pressure, figures.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from sim_hardware.brake_model.assembly import Array, Brake
from sim_hardware.brake_model.time_domain.limit_cycle import RATE_HZ, SquealSimulation
from sim_hardware.brake_model.time_domain.squeal_points import WORKING_QUANTITIES, SquealPoints, squeal_points

_WINDOW = RATE_HZ // 50
#: amplitude, relative to the largest of the ramp, above which it squeals
_THRESHOLD = 0.1


@dataclass(frozen=True)
class Ramp:
    """One ramp up and down.

    Attributes
    ----------
    duration_s : of each direction
    seed : of its excitation
    up, down : (windows,) value of the quantity in the middle of each window, in the order of time
    slip_up_m_s, slip_down_m_s : (windows,) amplitude of the slip, half of peak to peak
    radiated_up, radiated_down : (windows,) rms of the sound
    onset, end : values at which squeal sets in and ends; None: no squeal, or from the first, to the last
    """

    duration_s: float
    seed: int
    up: Array
    down: Array
    slip_up_m_s: Array
    slip_down_m_s: Array
    radiated_up: Array
    radiated_down: Array
    onset: float | None
    end: float | None

    @property
    def width(self) -> float | None:
        """Onset minus end."""
        return None if self.onset is None or self.end is None else self.onset - self.end


def ramps(
    brake: Brake,
    quantity: str,
    first: float,
    last: float,
    *,
    slip_m_s: float,
    saturation_m_s: float | None,
    durations_s: Sequence[float] = (1.0, 2.0, 4.0, 8.0),
    seeds: Sequence[int] = (1, 2),
    roughness_n_per_sqrt_n: float = 0.003,
    radiation: dict[str, float] | None = None,
    pressure_bar: float = 20.0,
    mu: float | None = None,
    slope_s_m: float | None = None,
) -> list[Ramp]:
    """Ramp a quantity from `first` to `last` and back, once per duration and seed, all side by side.

    Parameters
    ----------
    quantity : one of `squeal_points.WORKING_QUANTITIES`
    durations_s : of one direction
    roughness_n_per_sqrt_n : rms of the white excitation, N per sqrt(N) of pad force
    others : as `squeal_points.squeal_points`

    Raises
    ------
    ValueError
        not a working quantity, no range, durations that are not positive
    """
    if quantity not in WORKING_QUANTITIES:
        raise ValueError(
            f"{quantity} cannot be ramped while the brake runs; ramp {', '.join(WORKING_QUANTITIES)}"
        )
    if first == last or not durations_s or min(durations_s) <= 0.0 or not seeds:
        raise ValueError("give two different ends, positive durations and a seed")
    lanes = [(duration, seed) for duration in durations_s for seed in seeds]
    windows = np.array([max(2, round(duration * RATE_HZ / _WINDOW)) for duration, _ in lanes])
    make: dict[str, Any] = {
        "slip_m_s": slip_m_s, "saturation_m_s": saturation_m_s, "pressure_bar": pressure_bar, "mu": mu,
        "slope_s_m": slope_s_m,
    }  # fmt: skip
    simulation = SquealSimulation(
        squeal_points(brake, quantity, np.full(len(lanes), last), **make), radiation
    )
    pads = simulation.n_pads
    noise = [np.random.default_rng(seed) for _, seed in lanes]
    values, slips, sounds = [], [], []
    for step in range(2 * int(windows.max())):
        ends = [_at(step + d, windows, first, last) for d in (0, 1)]
        start, end = (squeal_points(brake, quantity, value, **make) for value in ends)
        force = np.sqrt(0.5 * (start.pad_force_n + end.pad_force_n))
        push = np.stack([rng.normal(size=(_WINDOW, pads)) for rng in noise], axis=1)
        seen = simulation.batch.observe(
            _WINDOW,
            **_between(start, end),
            excitation_n=push * (roughness_n_per_sqrt_n * force)[:, None],
        )
        values.append(0.5 * (ends[0] + ends[1]))
        slips.append(0.5 * (seen.maximum - seen.minimum)[:, :pads].max(axis=1))
        sounds.append(seen.rms[:, -1])
    history = np.array([values, slips, sounds])
    return [_ramp(*lanes[i], int(windows[i]), history[:, :, i]) for i in range(len(lanes))]


def _at(window: int, windows: Array, first: float, last: float) -> Array:
    """Value of every lane at the beginning of a window: up, down, then as it is."""
    part = np.clip(window / windows, 0.0, 2.0)
    return first + (last - first) * np.where(part <= 1.0, part, 2.0 - part)


def _between(start: SquealPoints, end: SquealPoints) -> dict[str, Any]:
    a, b = start.working_point(), end.working_point()
    return {name: (a[name], b[name]) if name != "saturation_m_s" else a[name] for name in a}


def _ramp(duration: float, seed: int, windows: int, history: Array) -> Ramp:
    (up, slip_up, sound_up), (down, slip_down, sound_down) = (
        history[:, :windows], history[:, windows : 2 * windows]
    )  # fmt: skip
    threshold = _THRESHOLD * max(slip_up.max(), slip_down.max())
    loud_up, loud_down = np.flatnonzero(slip_up > threshold), np.flatnonzero(slip_down > threshold)
    # noise alone is not squeal: it must stand out of its smallest amplitude
    squealed = max(slip_up.max(), slip_down.max()) > 20.0 * min(slip_up.min(), slip_down.min())
    onset = float(up[loud_up[0]]) if squealed and len(loud_up) and loud_up[0] > 0 else None
    lasting = len(loud_down) > 0 and loud_down[-1] == windows - 1
    end = float(down[loud_down[-1]]) if squealed and len(loud_down) and not lasting else None
    return Ramp(duration, seed, up, down, slip_up, slip_down, sound_up, sound_down, onset, end)

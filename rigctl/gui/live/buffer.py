"""Rolling histories of all channels of a session, and of mu, which is computed from three of them.

Job: one `ChannelHistory` per channel, fed by stretches of samples; the friction coefficient where it is
defined. Plain Python and numpy, no Qt. Not its job: reading the ring (`source`), spectra and levels
(`sound`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rigctl.core.channels import PRESSURE, SPEED, TORQUE, ChannelSpec
from rigctl.core.units import PA_PER_BAR
from rigctl.gui.live.history import ChannelHistory

MU = "mu"
HISTORY_S = 60.0


@dataclass(frozen=True, slots=True)
class Stretch:
    """Physical samples of one channel that follow each other without a gap.

    Attributes
    ----------
    name : str
    t_s : float
        Rig time of the first sample.
    samples : ndarray, shape (n,), float32
    stride : int
        Only every `stride`-th sample of the channel's rate was delivered.
    """

    name: str
    t_s: float
    samples: NDArray[np.floating]
    stride: int = 1


@dataclass(frozen=True, slots=True)
class Friction:
    """Geometry of mu = M / (2 (p - p0) A r), and where it is defined; as `rigctl.signals.friction`."""

    piston_area_m2: float
    effective_radius_m: float
    p0_bar: float = 0.5
    margin_bar: float = 0.5
    min_speed_rpm: float = 1.0

    def mu(self, torque_nm: NDArray[np.floating], pressure_bar: NDArray[np.floating],
           speed_rpm: NDArray[np.floating]) -> NDArray[np.float32]:  # fmt: skip
        """Course of mu, shape (n,); NaN where the pressure is not applied or the disc does not turn."""
        excess_bar = np.asarray(pressure_bar, np.float64) - self.p0_bar
        defined = (excess_bar > self.margin_bar) & (np.abs(speed_rpm) > self.min_speed_rpm)
        moment_nm = 2.0 * excess_bar * PA_PER_BAR * self.piston_area_m2 * self.effective_radius_m
        out = np.full(excess_bar.shape, np.nan, np.float32)
        np.divide(np.abs(torque_nm), moment_nm, out=out, where=defined, casting="unsafe")
        return out


class LiveBuffer:
    """Histories by channel name.

    Parameters
    ----------
    specs : iterable of ChannelSpec
        Channels of the session.
    friction : Friction, optional
        Without it there is no mu.
    history_s : float
        Length of all histories.
    """

    def __init__(
        self,
        specs: Iterable[ChannelSpec] = (),
        friction: Friction | None = None,
        history_s: float = HISTORY_S,
    ) -> None:
        self.specs = {spec.name: spec for spec in specs}
        self.friction = friction
        self.history_s = history_s
        self.channels = {name: ChannelHistory(spec.rate_hz, history_s) for name, spec in self.specs.items()}
        if {TORQUE, PRESSURE, SPEED} <= self.specs.keys():
            self.channels[MU] = ChannelHistory(self.specs[PRESSURE].rate_hz, history_s)

    @property
    def end_s(self) -> float:
        """Time after the newest sample of any channel; minus infinity when there is none."""
        return max((channel.end_s for channel in self.channels.values()), default=-np.inf)

    def feed(self, stretches: Sequence[Stretch]) -> None:
        """Add stretches; those of one channel in the order of time."""
        for stretch in stretches:
            history = self.channels.get(stretch.name)
            if history is not None:
                history.append(stretch.t_s, stretch.samples, stretch.stride)
        if self.friction is not None and MU in self.channels:
            self._feed_mu(stretches, self.friction)

    def _feed_mu(self, stretches: Sequence[Stretch], friction: Friction) -> None:
        together: dict[tuple[int, int, int], dict[str, Stretch]] = {}
        for stretch in stretches:
            if stretch.name in (TORQUE, PRESSURE, SPEED):
                key = (round(stretch.t_s * 1e6), stretch.stride, len(stretch.samples))
                together.setdefault(key, {})[stretch.name] = stretch
        for group in together.values():
            if len(group) == 3:  # a channel of another rate, or with other losses, leaves a gap in mu
                pressure = group[PRESSURE]
                mu = friction.mu(group[TORQUE].samples, pressure.samples, group[SPEED].samples)
                self.channels[MU].append(pressure.t_s, mu, pressure.stride)

    def copy(self) -> LiveBuffer:
        """Independent copy, for a frozen display."""
        twin = LiveBuffer((), self.friction, self.history_s)
        twin.specs = self.specs
        twin.channels = {name: history.copy() for name, history in self.channels.items()}
        return twin

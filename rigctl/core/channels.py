"""Channels: what a signal is called, its unit, its rate, and how its numbers become physical values.

Not its job: where samples travel (`rigctl.core.ring`), filters (`rigctl.signals`).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.core.errors import DeviceError

MICROPHONE = "microphone"
TORQUE = "torque"
PRESSURE = "pressure"
SPEED = "speed"
DISC_TEMPERATURE = "disc_temperature"


@dataclass(frozen=True, slots=True)
class ChannelSpec:
    """One signal as its device delivers it.

    Attributes
    ----------
    name : str
        Name within the rig, e.g. "microphone".
    unit : str
        Physical unit of `samples * scale + offset`, e.g. "Pa", "bar", "1/min".
    rate_hz : float
        Samples per second.
    dtype : str
        numpy type of the samples as acquired: "int16" for counts, "float32" for physical values.
    scale, offset : float
        physical value = sample * scale + offset.
    description : str
        Sensor and its place, for people.
    """

    name: str
    unit: str
    rate_hz: float
    dtype: str = "float32"
    scale: float = 1.0
    offset: float = 0.0
    description: str = ""

    @property
    def is_counts(self) -> bool:
        """True when samples are integer counts of a converter."""
        return np.dtype(self.dtype).kind in "iu"

    def to_mapping(self) -> dict[str, Any]:
        """Plain mapping for messages; `ChannelSpec(**mapping)` is the way back."""
        return {field: getattr(self, field) for field in self.__dataclass_fields__}


@dataclass(frozen=True, slots=True)
class ChannelCorrection:
    """A calibration as a channel takes it on: true value = gain · value + offset.

    Attributes
    ----------
    nominal_scale : float
        Scale of the channel for which it was found.
    """

    channel: str
    gain: float
    offset: float
    nominal_scale: float

    def applied_to(self, spec: ChannelSpec) -> ChannelSpec:
        """The channel with calibrated scale and offset; its samples stay as acquired.

        Raises
        ------
        DeviceError
            The scale of the channel is not the one that was calibrated.
        """
        if abs(spec.scale / self.nominal_scale - 1.0) > 1e-6:
            raise DeviceError(
                f"has the scale {spec.scale:g}, and was calibrated with {self.nominal_scale:g}.",
                place=f"channel {spec.name}",
                value=spec.scale,
                remedy="Calibrate it anew, or bring the rig file back to what it was.",
            )
        return replace(spec, scale=spec.scale * self.gain, offset=spec.offset * self.gain + self.offset)

    def removed_from(self, spec: ChannelSpec) -> ChannelSpec:
        """The channel as it was before; the way back of `applied_to`."""
        return replace(spec, scale=spec.scale / self.gain, offset=(spec.offset - self.offset) / self.gain)


def corrected(specs: Iterable[ChannelSpec], corrections: Iterable[ChannelCorrection]) -> list[ChannelSpec]:
    """Channels with the corrections in force; channels without one stay as they are.

    Raises
    ------
    DeviceError
        See `ChannelCorrection.applied_to`.
    """
    by_name = {correction.channel: correction for correction in corrections}
    return [by_name[spec.name].applied_to(spec) if spec.name in by_name else spec for spec in specs]


@dataclass(frozen=True, slots=True)
class ChannelData:
    """A stretch of one channel.

    Attributes
    ----------
    spec : ChannelSpec
    t0_s : float
        Time of the first sample, relative to whatever the holder says (start of the braking, rig time).
    samples : ndarray, shape (n,)
        As acquired, dtype `spec.dtype`.
    """

    spec: ChannelSpec
    t0_s: float
    samples: NDArray[Any]

    def physical(self) -> NDArray[np.floating[Any]]:
        """Physical values in `spec.unit`, shape (n,), float32 (float64 when the samples are)."""
        kind = np.float64 if self.samples.dtype == np.float64 else np.float32
        if self.spec.scale == 1.0 and self.spec.offset == 0.0:
            return self.samples.astype(kind, copy=False)
        return self.samples.astype(kind) * kind(self.spec.scale) + kind(self.spec.offset)

    def time_s(self) -> NDArray[np.float64]:
        """Time of each sample in s, shape (n,)."""
        return self.t0_s + np.arange(len(self.samples)) / self.spec.rate_hz

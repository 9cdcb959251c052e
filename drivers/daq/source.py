"""What a signal source must be able to do, and the checking of its settings.

Job: the interface between `LiveAcquisition` and its sources, so that third parties can add sources by an
entry point ``source.KIND`` of the group ``rigctl.devices``. Not its job: any device.

Two kinds of sources:

* *slow* sources (`Source`) hand over what has arrived since they were asked last (`take`). Each sample has
  the host time (`time.monotonic`) at which it arrived. `counted` sources sample with a clock of their own at
  `rate_hz`; the others (polled) are taken when they arrive;
* the *master* (`Master`), a microphone, counts frames; its count is the rig's time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from rigctl.core.channels import ChannelSpec
from rigctl.core.errors import ConfigError
from rigctl.hal.devices import RigContext
from rigctl.hal.diagnosis import Diagnosis

Interpolation = Literal["linear", "hold"]


class SourceSettings(BaseModel):
    """Keys that every source has.

    Attributes
    ----------
    delay_s : float
        From the physical event to the earliest possible arrival of its sample: filters of the device, its
        cycle, converters. Samples are dated back by it.
    silent_s : float
        Without a sample for so long, the device counts as gone.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    delay_s: float = Field(default=0.0, ge=-1.0, le=1.0)
    silent_s: float = Field(default=0.5, gt=0.0, le=10.0)


class SlowSettings(SourceSettings):
    """Keys of sources of slow signals.

    Attributes
    ----------
    output_hz : float
        Rate at which its channels are delivered, on the grid of the blocks.
    bridge_s : float
        Gaps in the samples up to this length are bridged by a straight line between the valid samples on both
        sides; longer ones are invalid (NaN). 0: every lost sample is invalid.
    """

    output_hz: float = Field(default=1000.0, ge=1.0, le=20_000.0)
    bridge_s: float = Field(default=0.0, ge=0.0, le=0.5)


@dataclass(frozen=True, slots=True)
class Taken:
    """What has arrived since the last call: `arrivals_s` (n,), `values` (n, columns) raw, NaN: invalid."""

    arrivals_s: NDArray[np.float64]
    values: NDArray[np.float64]


NOTHING = Taken(np.zeros(0), np.zeros((0, 0)))


class AnySource(Protocol):
    """What slow sources and the master have in common. Made from settings (only checked), then opened."""

    settings: Any  # a SourceSettings
    name: str
    place: str

    def __init__(self, name: str, settings: Mapping[str, Any], context: RigContext, place: str) -> None: ...

    def open(self) -> None:
        """Connect, verify the device's own settings, start. Raises `DeviceError`."""
        ...

    def close(self) -> None:
        """Stop; never raises."""
        ...

    def identity(self) -> Mapping[str, str]:
        """Who the device says it is."""
        ...

    def channels(self) -> Sequence[ChannelSpec]:
        """What it delivers; known after `open`."""
        ...

    def check(self) -> None:
        """Raise the `DeviceError` that happened since, if any."""
        ...

    def diagnose(self, round_trips: int) -> Diagnosis:
        """As in `rigctl.hal.diagnosis`."""
        ...


class Source(AnySource, Protocol):
    """A source of slow signals.

    Attributes
    ----------
    counted : bool
        It samples at `rate_hz` by a clock of its own.
    rate_hz : float
        Nominal rate of its samples.
    interpolation : str
        "linear" between samples, or "hold": the newest reading is in force until the next one, not longer
        than `hold_s`.
    """

    counted: bool
    rate_hz: float
    interpolation: Interpolation
    hold_s: float

    def take(self) -> Taken:
        """Samples since the last call, in order."""
        ...

    def convert(
        self, numbers: NDArray[np.int64], values: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Numbers (may get fractions) and physical values (n, channels) of samples; called in order, once."""
        ...


class Master(AnySource, Protocol):
    """The source whose count of frames is the time of the rig."""

    rate_hz: float

    def frames(self) -> int:
        """Frames delivered since it was opened."""
        ...

    def stamps(self) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """(frames delivered, host time) of the callbacks since the last call."""
        ...

    def read(self, start: int, stop: int) -> NDArray[np.int16]:
        """Counts of frames [start, stop). Raises `DeviceError` when they were overwritten."""
        ...

    def last_arrival_s(self) -> float:
        """Host time of the newest frames."""
        ...


Model = TypeVar("Model", bound=BaseModel)


def checked(model: type[Model], settings: Mapping[str, Any], place: str) -> Model:
    """Settings as a frozen model.

    Raises
    ------
    ConfigError
        Names file, key, value and what is allowed.
    """
    try:
        return model.model_validate(dict(settings))
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(str(part) for part in first["loc"])
        remedy = str(first.get("ctx", {}).get("remedy", ""))
        if first["type"] == "extra_forbidden":
            remedy = f"Known keys: {', '.join(model.model_fields)}."
        raise ConfigError(
            f"{first['msg']}.", place=f"{place}.{key}", value=first["input"], remedy=remedy
        ) from error

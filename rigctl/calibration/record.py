"""One calibration: frozen data with its points, its result, its residuals and its due date.

Job: the model of a file ``QUANTITY-DATE.toml``, and what it does to a channel (`correction`). Not its job:
where files are (`store`), how a result comes from readings (`torque`, `microphone`, `emissivity`).
"""

from __future__ import annotations

from datetime import UTC, date, datetime, timedelta
from enum import StrEnum
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, field_validator

from rigctl.core.channels import ChannelCorrection

SOON_DAYS = 30
"""By so many days before the due date it is shown as due soon."""

Text = Annotated[str, Field(min_length=1, max_length=200)]


class Quantity(StrEnum):
    """What can be calibrated."""

    TORQUE = "torque"
    MICROPHONE = "microphone"
    EMISSIVITY = "emissivity"


class Due(StrEnum):
    """How far off the next calibration is."""

    VALID = "valid"
    SOON = "soon"
    OVERDUE = "overdue"
    NEVER = "never"


class _Frozen(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Point(_Frozen):
    """One reading.

    Attributes
    ----------
    applied : float
        True value: torque of the weights N·m, level of the calibrator dB, contact thermometer °C.
    measured : float
        What the uncalibrated channel read: N·m, Pa per count, °C.
    scatter : float
        Standard deviation of the samples, in the unit of `measured`.
    series : str
        "right up", "right down", "left up", "left down" for torque; "" otherwise.
    """

    applied: float
    measured: float
    scatter: Annotated[float, Field(ge=0.0)] = 0.0
    series: str = ""


class Calibration(_Frozen):
    """A calibration as it is kept.

    Attributes
    ----------
    gain, offset : float
        true value = gain · (value of the uncalibrated channel) + offset.
    nominal_scale : float
        `ChannelSpec.scale` of the uncalibrated channel; a chain with another scale wants a new calibration.
    emissivity : float or None
        Of the rub track; set it at the pyrometer when `gain` is 1.
    figures : dict
        Named numbers of the evaluation, unit in the name: residual_percent, hysteresis_percent, …
    """

    format: Literal[1] = 1
    quantity: Quantity
    channel: Text
    unit: str
    rig: Text
    date: datetime
    operator: Text
    instrument: str = ""
    reference: str = ""
    gain: Annotated[float, Field(gt=0.0, le=1e3)]
    offset: float = 0.0
    nominal_scale: Annotated[float, Field(gt=0.0)] = 1.0
    emissivity: Annotated[float, Field(gt=0.0, le=1.0)] | None = None
    figures: dict[str, float] = Field(default_factory=dict[str, float])
    points: Annotated[tuple[Point, ...], Field(min_length=1, max_length=200)]
    valid_days: Annotated[int, Field(ge=1, le=3650)] = 365
    note: str = ""

    @field_validator("date")
    @classmethod
    def _with_zone(cls, value: datetime) -> datetime:
        return value.astimezone(UTC) if value.tzinfo else value.replace(tzinfo=UTC)

    @property
    def due(self) -> date:
        """Day on which it ceases to be valid."""
        return (self.date + timedelta(days=self.valid_days)).date()

    def state(self, today: date) -> Due:
        """Valid, due soon, or overdue."""
        left = (self.due - today).days
        return Due.OVERDUE if left < 0 else Due.SOON if left <= SOON_DAYS else Due.VALID

    @property
    def correction(self) -> ChannelCorrection:
        """What it does to its channel."""
        return ChannelCorrection(self.channel, self.gain, self.offset, self.nominal_scale)

    def summary(self) -> dict[str, object]:
        """What every braking file says of it."""
        return {
            "quantity": self.quantity.value, "channel": self.channel, "date": self.date.isoformat(),
            "due": self.due.isoformat(), "operator": self.operator, "instrument": self.instrument,
            "reference": self.reference, "gain": self.gain, "offset": self.offset,
            "emissivity": self.emissivity, **self.figures,
        }  # fmt: skip

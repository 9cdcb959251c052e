"""Bounded numbers and safe names: the building stones of every model in this package.

Job: refuse a value that cannot be meant (NaN, a duration of minus two seconds, a name with a path in it)
with a message that says what to write instead. Not the job: whether a particular rig can do it (``check``),
and turning errors into text with file and key (``rigctl.config``).

Every error raised here is a ``PydanticCustomError`` whose context carries ``value`` and ``remedy``.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, ConfigDict, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

ABSOLUTE_ZERO_DEGC = -273.15

_SAFE_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._ -]{0,63}")
_CHANNEL_NAME = re.compile(r"[a-z][a-z0-9_]{0,31}")
# Names that Windows reserves: data folders are copied to evaluation machines.
_RESERVED = {"con", "prn", "aux", "nul", *(f"{port}{n}" for port in ("com", "lpt") for n in range(1, 10))}


class Data(BaseModel):
    """Base of all models here: immutable, no unknown keys, no NaN and no infinity."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


def sentence(text: str) -> str:
    """`text` with a capital letter and a full stop."""
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


def refuse(kind: str, text: str, remedy: str, value: Any = None, **context: Any) -> PydanticCustomError:
    """Return the error to raise: `text` may use ``{value}`` and the names in `context`."""
    fields = {"value": value, "remedy": sentence(remedy), **context}
    return PydanticCustomError(kind, text, fields)  # type: ignore[arg-type]


@dataclass(frozen=True)
class Bounds:
    """Annotation for ``float`` or ``int``: a number, finite, within `low` and `high` of the unit.

    Text and booleans are refused instead of converted: ``"12"`` in a file is a mistake to be shown.
    """

    low: float
    high: float
    unit: str
    remedy: str
    above_low: bool = False  # True: `low` itself is refused

    def _check(self, value: float) -> float:
        if isinstance(value, float) and not math.isfinite(value):
            raise refuse("not_finite", "{value} is not a number that can be set", self.remedy, str(value))
        if value < self.low or value > self.high or (self.above_low and value == self.low):
            floor = f"above {self.low:.12g} and up" if self.above_low else f"from {self.low:.12g}"
            span = f"{floor} to {self.high:.12g} {self.unit}".rstrip()
            raise refuse("out_of_bounds", "{value} is not {span}", self.remedy, repr(value)[:40], span=span)
        return value

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        if source is int:
            number: CoreSchema = core_schema.int_schema(strict=True)
        else:
            number = core_schema.float_schema(strict=True, allow_inf_nan=True)
        return core_schema.no_info_after_validator_function(self._check, number)

    def __get_pydantic_json_schema__(
        self, schema: CoreSchema, handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        text = dict(handler(schema))
        text["exclusiveMinimum" if self.above_low else "minimum"] = self.low
        text["maximum"] = self.high
        return text


def _safe_name(value: str) -> str:
    if not _SAFE_NAME.fullmatch(value) or value[-1] in ". " or value.split(".", 1)[0].lower() in _RESERVED:
        raise refuse(
            "unsafe_name",
            "{value} cannot be used as a name",
            "use 1 to 64 letters, digits, '.', '_', '-' or blanks, beginning with a letter or digit,"
            " not ending with '.' or a blank, and no device name of an operating system (con, nul, ...)",
            repr(value),
        )
    return value


def _channel_name(value: str) -> str:
    if not _CHANNEL_NAME.fullmatch(value):
        raise refuse(
            "unsafe_channel",
            "{value} cannot be the name of a channel",
            "use at most 32 lower-case letters, digits and '_', a letter first: 'disc_temperature'",
            repr(value),
        )
    return value


SafeName = Annotated[str, AfterValidator(_safe_name)]
ChannelName = Annotated[str, AfterValidator(_channel_name)]

SegmentS = Annotated[
    float, Bounds(0, 3600, "s", "give the duration in seconds, at most one hour", above_low=True)
]
PauseS = Annotated[float, Bounds(0, 86400, "s", "give a time in seconds, 0 or more, at most one day")]
TimeoutS = Annotated[float, Bounds(0, 86400, "s", "give a time in seconds, at most one day", above_low=True)]
SpeedRpm = Annotated[
    float, Bounds(-10_000, 10_000, "1/min", "give the disc speed in 1/min; negative is the reverse direction")
]
PressureBar = Annotated[float, Bounds(0, 1000, "bar", "give the brake pressure in bar, 0 or more")]
OffsetBar = Annotated[
    float, Bounds(-1000, 1000, "bar", "give the pressure offset from the working point in bar")
]
AmplitudeBar = Annotated[
    float, Bounds(0, 1000, "bar", "give the amplitude in bar, 0 or more; 0 is 'constant'")
]
FrequencyHz = Annotated[
    float, Bounds(0, 100, "Hz", "give the frequency of the pressure function in Hz, e.g. 0.5", above_low=True)
]
TemperatureDegc = Annotated[
    float,
    Bounds(ABSOLUTE_ZERO_DEGC, 2000, "degC", "give the disc temperature in degrees Celsius (0 K is -273.15)"),
]
ToleranceK = Annotated[
    float, Bounds(0, 200, "K", "give the half width of the band in kelvin, e.g. 2", above_low=True)
]

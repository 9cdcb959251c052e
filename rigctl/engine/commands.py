"""What a person can ask of a running controller, as validated values; and the request that wants an answer.

Job: the commands of a manual session and the notes of an operator, read from plain mappings. Verbs of a
program are in `rigctl.engine.state`. Not its job: carrying them out (`rigctl.engine.manual`), who may ask
(`rigctl.app.control_socket`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from rigctl.core.errors import ConfigError
from sequences.pressure import PressureFunction

NotNegative = Annotated[float, Field(ge=0)]
Text = Annotated[str, Field(min_length=1, max_length=2000)]


class _Command(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Enable(_Command):
    """Arm the watchdog; allow torque and pressure."""

    do: Literal["enable"] = "enable"


class Disable(_Command):
    """Release, run down, open the relay."""

    do: Literal["disable"] = "disable"


class SetSpeed(_Command):
    """Go to a speed along a ramp; without one, the rig's fastest."""

    do: Literal["set_speed"] = "set_speed"
    speed_rpm: float
    ramp_rpm_per_s: Annotated[float, Field(gt=0)] | None = None


class SetPressure(_Command):
    """Hold a pressure; with a function, follow it around this point for `duration_s`, then release."""

    do: Literal["set_pressure"] = "set_pressure"
    pressure_bar: NotNegative
    function: PressureFunction | None = None
    duration_s: Annotated[float, Field(gt=0, le=3600)] | None = None


class SetVentilator(_Command):
    """Blow cooling air; 0 is off."""

    do: Literal["set_ventilator"] = "set_ventilator"
    flow_m3_h: NotNegative


class Condition(_Command):
    """Bring the disc to a temperature."""

    do: Literal["condition"] = "condition"
    temperature_degc: float


class Record(_Command):
    """Record one braking."""

    do: Literal["record"] = "record"
    duration_s: Annotated[float, Field(gt=0, le=3600)]
    speed_rpm: float
    pressure_bar: Annotated[float, Field(gt=0)]
    function: PressureFunction | None = None
    comment: Annotated[str, Field(max_length=2000)] = ""


class Reset(_Command):
    """Acknowledge a trip in a person's words."""

    do: Literal["reset"] = "reset"
    reason: Text


class Note(_Command):
    """An operator's note."""

    do: Literal["note"] = "note"
    text: Text


class Rate(_Command):
    """Subjective noise rating of the present or last braking."""

    do: Literal["rate"] = "rate"
    rating: Annotated[int, Field(ge=1, le=10)]


class AcknowledgeAlarm(_Command):
    """A person has seen an alarm; it stays in the list."""

    do: Literal["acknowledge_alarm"] = "acknowledge_alarm"
    alarm: Text


Command = (
    Enable
    | Disable
    | SetSpeed
    | SetPressure
    | SetVentilator
    | Condition
    | Record
    | Reset
    | Note
    | Rate
    | AcknowledgeAlarm
)
FREE_FOR_ALL = (Note, Rate, AcknowledgeAlarm)
"""Commands that move nothing: whoever watches may give them."""

_adapter: TypeAdapter[Command] = TypeAdapter(Annotated[Command, Field(discriminator="do")])


def parse_command(mapping: Mapping[str, Any]) -> Command:
    """Read a command from plain values.

    Raises
    ------
    ConfigError
        Names the field, the value and what it should be.
    """
    try:
        return _adapter.validate_python(dict(mapping))
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"][1:]) or str(mapping.get("do"))
        raise ConfigError(f"{first['msg']}.", place=place, value=first.get("input")) from error


@dataclass(frozen=True)
class Ask:
    """A command with the person who gave it; to be answered once.

    Attributes
    ----------
    command : Command
    who : str
        User and program.
    answer : callable
        Called with ("" or a reason of refusal, remedy).
    """

    command: Command
    who: str
    answer: Callable[[str, str], None]

    def done(self) -> None:
        """It is carried out, or under way."""
        self.answer("", "")

    def refuse(self, reason: str, remedy: str = "") -> None:
        """It is not carried out."""
        self.answer(reason, remedy)

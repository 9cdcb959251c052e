"""Settings that all CANopen devices share, and their validation with the rig file's place in the message.

Job: `NodeSettings`, `validated`. Not its job: what a single device needs beyond.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from drivers.can.canopen_node import Identity
from rigctl.config.loading import describe
from rigctl.core.errors import ConfigError

Model = TypeVar("Model", bound=BaseModel)
NodeId = Annotated[int, Field(ge=1, le=127)]
CobId = Annotated[int, Field(ge=0x181, le=0x57F)]


class Frozen(BaseModel):
    """Frozen, and unknown keys are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, arbitrary_types_allowed=True)


class PdoSettings(Frozen):
    """Which PDO of the node is used.

    Attributes
    ----------
    number : int
        1 to 4.
    cob_id : int or None
        None: that of the predefined connection set (CiA 301).
    event_ms : int
        Period of a TPDO.
    """

    number: Annotated[int, Field(ge=1, le=4)] = 1
    cob_id: CobId | None = None
    event_ms: Annotated[int, Field(ge=1, le=100)] = 10

    def identifier(self, node: int, *, transmitted: bool) -> int:
        """Identifier in force."""
        if self.cob_id is not None:
            return self.cob_id
        return (0x180 if transmitted else 0x200) + 0x100 * (self.number - 1) + node


class NodeSettings(Frozen):
    """What every CANopen device has.

    Attributes
    ----------
    bus : str
        Name of the rig file's bus.
    node : int
        Node id.
    configure : bool
        True: parameters that differ from what is needed are set at opening. False: they are refused.
    identity : Identity
        Who it must be.
    eds : Path or None
        Data sheet, relative to the rig file.
    heartbeat_ms : int
        How often it must send its heartbeat.
    watch_ms : int
        It must miss our heartbeat (one every 100 ms) within this time.
    silence_s : float
        We miss its heartbeat after this time.
    tolerated_emcy : tuple of int
        Error codes that are only shown.
    """

    bus: Annotated[str, Field(min_length=1)]
    node: NodeId
    configure: bool = False
    identity: Identity = Identity()
    eds: Path | None = None
    heartbeat_ms: Annotated[int, Field(ge=10, le=500)] = 100
    watch_ms: Annotated[int, Field(ge=150, le=1000)] = 250
    silence_s: Annotated[float, Field(ge=0.05, le=2.0)] = 0.35
    tolerated_emcy: tuple[Annotated[int, Field(ge=0x100, le=0xFFFF)], ...] = ()


def validated(model: type[Model], settings: Mapping[str, Any], place: str) -> Model:
    """Settings of a device as its model.

    Raises
    ------
    ConfigError
        With one line for each fault.
    """
    try:
        return model.model_validate(dict(settings))
    except ValidationError as error:
        raise ConfigError(describe(error, place, model)) from error

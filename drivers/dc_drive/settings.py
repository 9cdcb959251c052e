"""Settings that the serial drives share, and the reading of their map files.

Job: turn a rig file's settings and a map's TOML into frozen models, with errors that name file, key, value
and remedy. Not its job: what the keys mean to one kind of drive.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from rigctl.config.loading import describe, load_model
from rigctl.core.errors import ConfigError
from rigctl.hal.devices import RigContext

Model = TypeVar("Model", bound=BaseModel)


class SerialDriveSettings(BaseModel):
    """Keys of ``[devices.drive]`` that all serial drives know.

    Attributes
    ----------
    port : str
        "/dev/ttyUSB0", "socket://host:port", "rfc2217://host:port" or "bench:drive".
    map : Path
        Register or tag map, relative to the rig file.
    full_speed_rpm : float
        Speed at 100 % reference.
    period_s : float
        Time from one polling cycle to the next.
    reply_timeout_s : float
        How long one answer is waited for.
    deadline_s : float
        How long a lost answer is asked for again before the link counts as failed.
    longest_loss_s : float
        The longest communication-loss time of the drive that is accepted.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    port: Annotated[str, Field(min_length=1)]
    map: Path
    full_speed_rpm: Annotated[float, Field(gt=0, le=10000)]
    baud: Annotated[int, Field(ge=300, le=1_000_000)]
    parity: Literal["N", "E", "O"]
    data_bits: Literal[7, 8]
    stop_bits: Literal[1, 2] = 1
    period_s: Annotated[float, Field(ge=0.005, le=0.2)] = 0.025
    reply_timeout_s: Annotated[float, Field(ge=0.01, le=2)] = 0.1
    deadline_s: Annotated[float, Field(ge=0.05, le=2)] = 0.4
    longest_loss_s: Annotated[float, Field(gt=0, le=2)] = 1.0


def read_settings(model: type[Model], settings: Mapping[str, Any], context: RigContext) -> Model:
    """Validate the settings of the drive. Raises `ConfigError`."""
    try:
        return model.model_validate(dict(settings))
    except ValidationError as error:
        raise ConfigError(describe(error, f"{context.place}: devices.drive", model)) from error


def read_map(model: type[Model], path: Path, context: RigContext) -> Model:
    """Read a map file; a relative path starts at the rig file's folder. Raises `ConfigError`."""
    return load_model((context.folder / path).resolve(), model)

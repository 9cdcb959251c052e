"""The watchdog's own limits: read once from its own TOML file, checked, frozen, hashed.

Job: refuse every file that leaves a limit out, misspells one, or gives a number that makes no sense; give
the one immutable object that all checks read; make a change of it noticeable (`Fingerprint`). There is no
setter and no message that changes a limit. Not its job: comparing readings
with limits (`rigctl.safety.checks`).
"""

from __future__ import annotations

import hashlib
import json
import operator
import struct
import tomllib
import zlib
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, fields
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from rigctl.core.errors import ConfigError
from rigctl.safety.causes import CAUSES

SCHEMA: Final = 1


def _within(low: float, high: float) -> Any:
    return field(metadata={"low": low, "high": high})


@dataclass(frozen=True, slots=True)
class PressureLimits:
    """Brake pressure: the range, and a second bound that trips faster."""

    min_bar: float = _within(-5.0, 0.0)
    max_bar: float = _within(1.0, 60.0)
    readings: int = _within(2, 200)
    peak_bar: float = _within(1.0, 60.0)
    peak_readings: int = _within(2, 200)


@dataclass(frozen=True, slots=True)
class SpeedLimits:
    """Speed of the shaft; the lower bound catches a wrong direction."""

    min_rpm: float = _within(-100.0, 0.0)
    max_rpm: float = _within(1.0, 3000.0)
    readings: int = _within(2, 200)


@dataclass(frozen=True, slots=True)
class TorqueLimits:
    """Brake torque."""

    min_nm: float = _within(-2000.0, 0.0)
    max_nm: float = _within(1.0, 3000.0)
    readings: int = _within(2, 200)


@dataclass(frozen=True, slots=True)
class PowerLimits:
    """Friction power, torque times speed by the watchdog's own readings."""

    max_kw: float = _within(0.1, 500.0)
    readings: int = _within(2, 500)
    peak_kw: float = _within(0.1, 500.0)
    peak_readings: int = _within(2, 200)


@dataclass(frozen=True, slots=True)
class TemperatureLimits:
    """Disc temperature; above `approach_from_degc` its rate counts too (time left < `reaction_s` trips)."""

    min_degc: float = _within(-50.0, 30.0)
    max_degc: float = _within(50.0, 700.0)
    readings: int = _within(2, 200)
    approach_from_degc: float = _within(0.0, 700.0)
    reaction_s: float = _within(0.1, 10.0)
    approach_blocks: int = _within(1, 20)
    heat_capacity_j_per_k: float = _within(200.0, 20000.0)
    heat_fraction: float = _within(0.1, 1.0)


@dataclass(frozen=True, slots=True)
class SanityLimits:
    """Readings that are no numbers, and readings that never change though the brake turns under pressure."""

    invalid_readings: int = _within(1, 50)
    frozen_readings: int = _within(20, 1000)
    frozen_above_rpm: float = _within(1.0, 1000.0)
    frozen_above_bar: float = _within(0.5, 40.0)


@dataclass(frozen=True, slots=True)
class FreshnessLimits:
    """How complete and how regular the safety channel must be, in blocks and in its own time."""

    min_readings: int = _within(1, 50)
    stale_blocks: int = _within(1, 10)
    max_block_s: float = _within(0.01, 5.0)
    clock_tolerance_s: float = _within(1e-6, 0.1)


@dataclass(frozen=True, slots=True)
class SetpointLimits:
    """What the controller may command."""

    max_pressure_bar: float = _within(0.0, 60.0)
    max_speed_rpm: float = _within(0.0, 3000.0)


@dataclass(frozen=True, slots=True)
class RelayLimits:
    """Blocks within which the relay must read what it was told, and the drive must follow an open relay."""

    readback_blocks: int = _within(1, 20)
    enabled_blocks: int = _within(1, 40)


@dataclass(frozen=True, slots=True)
class ArmingLimits:
    """What must have been seen with the relay open, and how many edges before motion is allowed."""

    samples: int = _within(5, 1000)
    heartbeats: int = _within(5, 1000)
    edges: int = _within(1, 1000)


@dataclass(frozen=True, slots=True)
class RestLimits:
    """Below both the rig is at rest: asked for at arming and disarming, and to call the state safe."""

    pressure_bar: float = _within(0.01, 5.0)
    speed_rpm: float = _within(0.1, 20.0)


@dataclass(frozen=True, slots=True)
class ResetLimits:
    """When a trip may be acknowledged."""

    pressure_bar: float = _within(0.01, 5.0)
    speed_rpm: float = _within(0.1, 20.0)
    standstill_s: float = _within(0.0, 60.0)
    same_cause_per_hour: int = _within(1, 20)


@dataclass(frozen=True, slots=True)
class Windows:
    """Wall-clock time-outs: the controller's answer to a status, and the next sample."""

    heartbeat_s: float = _within(0.02, 30.0)
    sample_s: float = _within(0.02, 60.0)


@dataclass(frozen=True, slots=True)
class TimeLimits:
    """Windows in virtual time, in real time, and in real time without real-time priority (wider)."""

    virtual: Windows
    real: Windows
    real_without_priority: Windows


@dataclass(frozen=True, slots=True)
class Limits:
    """All limits of one rig. Frozen; see `load_limits`."""

    schema: int
    name: str
    pressure: PressureLimits
    speed: SpeedLimits
    torque: TorqueLimits
    power: PowerLimits
    disc_temperature: TemperatureLimits
    sanity: SanityLimits
    freshness: FreshnessLimits
    setpoints: SetpointLimits
    relay: RelayLimits
    arming: ArmingLimits
    rest: RestLimits
    reset: ResetLimits
    time: TimeLimits
    stop_category: Mapping[str, int]


_SECTIONS: Final[dict[str, type[Any]]] = {
    "pressure": PressureLimits,
    "speed": SpeedLimits,
    "torque": TorqueLimits,
    "power": PowerLimits,
    "disc_temperature": TemperatureLimits,
    "sanity": SanityLimits,
    "freshness": FreshnessLimits,
    "setpoints": SetpointLimits,
    "relay": RelayLimits,
    "arming": ArmingLimits,
    "rest": RestLimits,
    "reset": ResetLimits,
}
_TIMES: Final = ("virtual", "real", "real_without_priority")
_TOP_KEYS: Final = ("schema", "name", *_SECTIONS, "time", "stop_category")

# (lower key, higher key, may they be equal)
_ORDER: Final = (
    ("pressure.max_bar", "pressure.peak_bar", False),
    ("setpoints.max_pressure_bar", "pressure.max_bar", False),
    ("setpoints.max_speed_rpm", "speed.max_rpm", False),
    ("power.max_kw", "power.peak_kw", False),
    ("disc_temperature.approach_from_degc", "disc_temperature.max_degc", False),
    ("rest.pressure_bar", "reset.pressure_bar", True),
    ("rest.speed_rpm", "reset.speed_rpm", True),
    ("sanity.invalid_readings", "pressure.peak_readings", True),
    ("time.real.heartbeat_s", "time.real_without_priority.heartbeat_s", True),
    ("time.real_without_priority.heartbeat_s", "time.virtual.heartbeat_s", True),
)


@dataclass(frozen=True, slots=True)
class LoadedLimits:
    """Limits with their identity: `sha256` of the content, `file_sha256` of the bytes of the file."""

    limits: Limits
    path: Path
    sha256: str
    file_sha256: str

    @property
    def hash8(self) -> str:
        """First eight digits; the controller repeats them in every heartbeat."""
        return self.sha256[:8]

    def file_unchanged(self) -> bool:
        """Whether the file on the disk is still the one that was read."""
        try:
            return hashlib.sha256(self.path.read_bytes()).hexdigest() == self.file_sha256
        except OSError:
            return False


def load_limits(path: Path) -> LoadedLimits:
    """Read and check a limits file.

    Raises
    ------
    ConfigError
        One fault, with file, key, value and remedy.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ConfigError(
            f"cannot be read: {error.strerror}.", place=str(path), remedy="Name an existing limits file."
        ) from error
    try:
        raw = tomllib.loads(data.decode("utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ConfigError(
            f"is not valid TOML: {error}.", place=str(path), remedy="Correct the file."
        ) from error
    limits = parse_limits(raw, str(path))
    canonical = json.dumps(_mapping(limits), sort_keys=True, separators=(",", ":")).encode()
    return LoadedLimits(limits, path, hashlib.sha256(canonical).hexdigest(), hashlib.sha256(data).hexdigest())


def parse_limits(raw: Mapping[str, Any], file: str) -> Limits:
    """Build limits from a mapping; see `load_limits`."""
    _known(raw, _TOP_KEYS, file, "")
    if type(raw["schema"]) is not int or raw["schema"] != SCHEMA:
        raise _fault(file, "schema", raw["schema"], "is not known", f"This program reads schema {SCHEMA}.")
    name = raw["name"]
    if not (isinstance(name, str) and 0 < len(name) <= 64 and name.isprintable()):
        raise _fault(file, "name", name, "is not a name", "Give 1 to 64 printable characters.")
    sections = {key: _section(cls, raw[key], file, key) for key, cls in _SECTIONS.items()}
    times = _table(raw["time"], file, "time")
    _known(times, _TIMES, file, "time.")
    windows = {key: _section(Windows, times[key], file, f"time.{key}") for key in _TIMES}
    limits = Limits(
        schema=SCHEMA,
        name=name,
        time=TimeLimits(**windows),
        stop_category=_stop_categories(raw["stop_category"], file),
        **sections,
    )
    _check_order(limits, file)
    return limits


def _section(cls: type[Any], raw: Any, file: str, place: str) -> Any:
    table = _table(raw, file, place)
    specs = {spec.name: spec for spec in fields(cls)}
    _known(table, tuple(specs), file, f"{place}.")
    values: dict[str, float | int] = {}
    for key, spec in specs.items():
        values[key] = _number(
            table[key],
            spec.type == "int",
            spec.metadata["low"],
            spec.metadata["high"],
            file,
            f"{place}.{key}",
        )
    return cls(**values)


def _number(value: Any, whole: bool, low: float, high: float, file: str, key: str) -> float | int:
    remedy = f"Give a {'whole ' if whole else ''}number from {low:g} to {high:g}."
    if isinstance(value, bool) or not isinstance(value, int if whole else (int, float)):
        raise _fault(file, key, value, f"is not a {'whole ' if whole else ''}number", remedy)
    if not low <= value <= high:  # NaN is refused here too
        raise _fault(file, key, value, "is out of range", remedy)
    return value if whole else float(value)


def _table(raw: Any, file: str, place: str) -> Mapping[str, Any]:
    if not isinstance(raw, dict):
        raise _fault(file, place, raw, "is not a table", f"Write [{place}] and its keys below.")
    return raw  # pyright: ignore[reportUnknownVariableType]


def _known(raw: Mapping[str, Any], keys: tuple[str, ...], file: str, prefix: str) -> None:
    for key in raw:
        if key not in keys:
            raise _fault(file, prefix + key, raw[key], "is an unknown key", f"Known: {', '.join(keys)}.")
    for key in keys:
        if key not in raw:
            raise _fault(
                file, prefix + key, None, "is missing", "Every limit must be given; there are no defaults."
            )


def _stop_categories(raw: Any, file: str) -> Mapping[str, int]:
    table = _table(raw, file, "stop_category")
    _known(table, tuple(CAUSES), file, "stop_category.")
    for key, value in table.items():
        if type(value) is not int or value != 0:
            raise _fault(
                file, f"stop_category.{key}", value, "is not supported",
                "Use 0 (torque off and pressure vented at once); a supervised ramp is not available.",
            )  # fmt: skip
    return MappingProxyType(dict(table))


def _check_order(limits: Limits, file: str) -> None:
    for low_key, high_key, equal in _ORDER:
        low = operator.attrgetter(low_key)(limits)
        high = operator.attrgetter(high_key)(limits)
        if low > high or (low == high and not equal):
            raise _fault(
                file, low_key, low, f"is not below {high_key} = {high:g}", f"Lower it or raise {high_key}."
            )


def _fault(file: str, key: str, value: Any, problem: str, remedy: str) -> ConfigError:
    place = f"{file}: {key}" if value is None else f"{file}: {key}: {value!r}"
    return ConfigError(f"{problem}.", place=place, value=value, remedy=remedy)


def _mapping(limits: Limits) -> dict[str, Any]:
    parts = {spec.name: getattr(limits, spec.name) for spec in fields(limits)}
    parts["stop_category"] = dict(limits.stop_category)
    return {key: asdict(part) if hasattr(part, "__slots__") else part for key, part in parts.items()}


def _leaves(part: Any, prefix: str) -> list[str]:
    names: list[str] = []
    for spec in fields(part):
        value = getattr(part, spec.name)
        if hasattr(value, "__dataclass_fields__"):
            names += _leaves(value, f"{prefix}{spec.name}.")
        elif isinstance(value, (int, float)):
            names.append(prefix + spec.name)
    return names


class Fingerprint:
    """CRC-32 over every number of the limits, read anew from the objects that the checks use."""

    def __init__(self, limits: Limits) -> None:
        names = _leaves(limits, "")
        self._limits = limits
        self._read: Callable[[Limits], tuple[float, ...]] = operator.attrgetter(*names)
        self._pack = struct.Struct(f"{len(names)}d").pack
        self._loaded = self._crc()

    def _crc(self) -> int:
        return zlib.crc32(self._pack(*self._read(self._limits)))

    def intact(self) -> bool:
        """Whether every number is still the one that was loaded."""
        return self._crc() == self._loaded

"""Identifiers, byte layouts and scales of what the watchdog reads on the bus, and of the relay it renews.

Job: one checked description for both ends: the rig file's `[devices.safety]` (read by `can_channel`) and the
JSON that the watchdog process is started with (read by `watchdog_link`). Standard library only. Not its job:
buses (`drivers.can.bus`), decoding (`drivers.safety_io.decoding`).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from math import isfinite
from typing import Any, Final

from rigctl.core.errors import ConfigError

SIGNALS: Final = ("pressure", "torque", "speed", "temperature")
TYPES: Final = {"i8": "<b", "u8": "<B", "i16": "<h", "u16": "<H", "i32": "<i", "u32": "<I", "f32": "<f"}
SIZES: Final = {"i8": 1, "u8": 1, "i16": 2, "u16": 2, "i32": 4, "u32": 4, "f32": 4}
HIGHEST_COB_ID: Final = 0x7FF
HIGHEST_NODE: Final = 127
FRAME_BYTES: Final = 8


@dataclass(frozen=True, slots=True)
class SignalSettings:
    """One signal in one PDO: value = raw * scale + zero, in rig units.

    Attributes
    ----------
    cob_id : int
        Identifier of the PDO.
    offset : int
        First byte of the raw value; little-endian, as all of CANopen.
    type : str
        One of `TYPES`. The two ends of i16 and i32 are never measured values.
    scale, zero : float
        To bar, N·m, 1/min or °C.
    stale_s : float
        Older than this the newest value is no reading any more.
    status_offset : int
        Byte that must be 0 for the value to be valid; -1 where there is none.
    current_loop : bool
        The raw value is a loop current in µA and NAMUR NE 43 holds: valid from 3800 to 20500 µA.
    """

    cob_id: int
    offset: int
    type: str
    scale: float
    zero: float = 0.0
    stale_s: float = 0.05
    status_offset: int = -1
    current_loop: bool = False

    @property
    def length(self) -> int:
        """Bytes that the PDO must have."""
        return max(self.offset + SIZES[self.type], self.status_offset + 1)


@dataclass(frozen=True, slots=True)
class SafetyIoSettings:
    """Settings of the safety channel. The defaults are the nodes of the bench.

    Attributes
    ----------
    node : int
        CANopen node id of the safety I/O.
    command_cob_id, state_cob_id : int
        Its RPDO (command, counter, nonce) and its TPDO (bits, echo of the counter).
    state_stale_s : float
        Without a TPDO for so long relay, emergency stop and doors are unknown; also the longest silence of
        the bus.
    start_nodes : tuple of int
        Nodes that the watchdog sets OPERATIONAL when it finds them otherwise.
    pressure, torque, speed, temperature : SignalSettings
    """

    node: int = 0x30
    command_cob_id: int = 0x230
    state_cob_id: int = 0x1B0
    state_stale_s: float = 0.05
    start_nodes: tuple[int, ...] = (0x30,)
    pressure: SignalSettings = field(default=SignalSettings(0x1A0, 4, "i32", 1e-4))
    torque: SignalSettings = field(default=SignalSettings(0x1A0, 0, "i32", 1e-2))
    speed: SignalSettings = field(default=SignalSettings(0x1A2, 4, "i16", 0.1))
    temperature: SignalSettings = field(
        # 4 mA at 0 °C, 20 mA at 600 °C
        default=SignalSettings(
            0x1A1, 0, "i16", 600.0 / 16000.0, zero=-150.0, status_offset=2, current_loop=True
        )
    )

    def to_mapping(self) -> dict[str, Any]:
        """Plain mapping for JSON; `parse_settings` reads it back."""
        mapping = asdict(self)
        mapping["start_nodes"] = list(self.start_nodes)
        return mapping

    def signals(self) -> dict[str, SignalSettings]:
        """The four signals by name."""
        return {name: getattr(self, name) for name in SIGNALS}


def parse_settings(raw: Mapping[str, Any], place: str) -> SafetyIoSettings:
    """Read and check a mapping; keys that are absent have the defaults of `SafetyIoSettings`.

    Parameters
    ----------
    raw : mapping
        Keys of `SafetyIoSettings`; a signal is a table of keys of `SignalSettings`.
    place : str
        For messages: "FILE: devices.safety".

    Raises
    ------
    ConfigError
        One fault, with key, value and remedy.
    """
    default = SafetyIoSettings()
    _known(raw, [spec.name for spec in fields(SafetyIoSettings)], place)
    values: dict[str, Any] = {
        "node": _whole(raw, "node", default.node, 1, HIGHEST_NODE, place),
        "command_cob_id": _whole(raw, "command_cob_id", default.command_cob_id, 1, HIGHEST_COB_ID, place),
        "state_cob_id": _whole(raw, "state_cob_id", default.state_cob_id, 1, HIGHEST_COB_ID, place),
        "state_stale_s": _real(raw, "state_stale_s", default.state_stale_s, 0.005, 0.15, place),
        "start_nodes": _nodes(raw.get("start_nodes", default.start_nodes), f"{place}.start_nodes"),
    }
    for name, signal in default.signals().items():
        values[name] = _signal(raw.get(name, {}), signal, f"{place}.{name}")
    settings = SafetyIoSettings(**values)
    taken = [settings.state_cob_id, *{signal.cob_id for signal in settings.signals().values()}]
    if settings.command_cob_id in taken or settings.state_cob_id in taken[1:]:
        raise ConfigError(
            "the identifiers of command, state and signals are not different.", place=place,
            value=[hex(cob_id) for cob_id in (settings.command_cob_id, *taken)],
            remedy="Give the relay's command and state identifiers of their own.",
        )  # fmt: skip
    return settings


def _signal(raw: Any, default: SignalSettings, place: str) -> SignalSettings:
    if isinstance(raw, SignalSettings):
        return raw
    if not isinstance(raw, Mapping):
        raise _fault(place, raw, "is no table", "Give cob_id, offset, type, scale, …")
    _known(raw, [spec.name for spec in fields(SignalSettings)], place)
    kind = raw.get("type", default.type)
    if kind not in TYPES:
        raise _fault(f"{place}.type", kind, "is no type of value", f"Known: {', '.join(TYPES)}.")
    current_loop = raw.get("current_loop", default.current_loop)
    if not isinstance(current_loop, bool):
        raise _fault(f"{place}.current_loop", current_loop, "is not true or false", "Give true or false.")
    last = FRAME_BYTES - 1
    signal = SignalSettings(
        cob_id=_whole(raw, "cob_id", default.cob_id, 1, HIGHEST_COB_ID, place),
        offset=_whole(raw, "offset", default.offset, 0, FRAME_BYTES - SIZES[kind], place),
        type=kind,
        scale=_real(raw, "scale", default.scale, -1e6, 1e6, place),
        zero=_real(raw, "zero", default.zero, -1e6, 1e6, place),
        stale_s=_real(raw, "stale_s", default.stale_s, 0.005, 0.5, place),
        status_offset=_whole(raw, "status_offset", default.status_offset, -1, last, place),
        current_loop=current_loop,
    )
    if signal.scale == 0.0:
        raise _fault(f"{place}.scale", 0.0, "makes every reading the same", "Give a scale other than 0.")
    if signal.offset <= signal.status_offset < signal.offset + SIZES[kind]:
        raise _fault(
            f"{place}.status_offset", signal.status_offset, "lies within the value", "Correct the offsets."
        )
    return signal


def _nodes(value: Any, place: str) -> tuple[int, ...]:
    if isinstance(value, (list, tuple)) and all(
        type(node) is int and 1 <= node <= HIGHEST_NODE
        for node in value  # pyright: ignore[reportUnknownVariableType]
    ):
        return tuple(value)  # pyright: ignore[reportUnknownArgumentType]
    raise _fault(place, value, "is no list of node ids", f"Give numbers from 1 to {HIGHEST_NODE}.")


def _whole(raw: Mapping[str, Any], key: str, default: int, low: int, high: int, place: str) -> int:
    value = raw.get(key, default)
    if type(value) is not int or not low <= value <= high:
        raise _fault(f"{place}.{key}", value, "is out of range", f"Give a whole number from {low} to {high}.")
    return value


def _real(raw: Mapping[str, Any], key: str, default: float, low: float, high: float, place: str) -> float:
    value = raw.get(key, default)
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not isfinite(value):
        raise _fault(f"{place}.{key}", value, "is no number", f"Give a number from {low:g} to {high:g}.")
    if not low <= value <= high:
        raise _fault(f"{place}.{key}", value, "is out of range", f"Give a number from {low:g} to {high:g}.")
    return float(value)


def _known(raw: Mapping[str, Any], keys: list[str], place: str) -> None:
    for key in raw:
        if key not in keys:
            raise _fault(f"{place}.{key}", raw[key], "is an unknown key", f"Known: {', '.join(keys)}.")


def _fault(place: str, value: Any, problem: str, remedy: str) -> ConfigError:
    return ConfigError(f"{value!r} {problem}.", place=place, value=value, remedy=remedy)

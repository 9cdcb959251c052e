"""Opening a python-can bus from the rig file's `[buses.NAME]`, with errors that say what to do.

Job: validate our own keys of the table, hand all others to `can.Bus`, and translate whatever that raises
into one `DeviceError` that names bus, value and remedy. Not its job: reading and dispatching frames
(`drivers.can.session`).

Keys of the table that are ours: ``interface``; ``log`` (false, true, "log", "asc", "blf"); and
``controller_node`` (our own CANopen node id, 1). Everything else goes to python-can as it is: channel, port,
bitrate, hop_limit, …
"""

from __future__ import annotations

import errno
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from rigctl.core.errors import ConfigError, DeviceError

if TYPE_CHECKING:
    import can

LOG_SUFFIXES = ("log", "asc", "blf")
ECHOING = ("udp_multicast",)
"""Interfaces that give every frame back to its sender; python-can does not mark those."""


@dataclass(frozen=True, slots=True)
class BusSettings:
    """A checked table `[buses.NAME]`.

    Attributes
    ----------
    name : str
    place : str
        "FILE: buses.NAME", for messages.
    interface : str
        python-can's name of the interface.
    arguments : mapping
        Keyword arguments for `can.Bus` beside the interface.
    log_suffix : str
        "" for no wire log, else the suffix that python-can's loggers know.
    controller_node : int
        Our own CANopen node id.
    """

    name: str
    place: str
    interface: str
    arguments: Mapping[str, Any]
    log_suffix: str = ""
    controller_node: int = 1

    @property
    def echoes(self) -> bool:
        """Whether the interface gives our own frames back to us."""
        return self.interface in ECHOING or bool(self.arguments.get("receive_own_messages"))


def bus_settings(buses: Mapping[str, Mapping[str, Any]], name: str, place: str) -> BusSettings:
    """The table of a bus, checked as far as can be without the hardware.

    Raises
    ------
    ConfigError
        There is no such bus, or one of our keys is wrong.
    """
    where = f"{place}: buses.{name}"
    if name not in buses:
        known = ", ".join(sorted(buses)) or "none"
        raise ConfigError(
            f"there is no bus {name!r}.", place=where, value=name, remedy=f"Buses of this rig file: {known}."
        )
    table = dict(buses[name])
    interface = table.pop("interface", None)
    if not isinstance(interface, str) or not interface:
        raise ConfigError(
            "missing.", place=f"{where}.interface", remedy="Name python-can's interface: socketcan, …"
        )
    log = table.pop("log", False)
    suffix = ("log" if log else "") if isinstance(log, bool) else str(log)
    if suffix not in ("", *LOG_SUFFIXES):
        raise ConfigError(
            f"{log!r} is no kind of log.", place=f"{where}.log", value=log,
            remedy='Give true, false, "log" (candump), "asc" or "blf".',
        )  # fmt: skip
    node = table.pop("controller_node", 1)
    if isinstance(node, bool) or not isinstance(node, int) or not 1 <= node <= 127:
        raise ConfigError(
            f"{node!r} is no node id.", place=f"{where}.controller_node", value=node, remedy="Give 1 to 127."
        )
    return BusSettings(name, where, interface, table, suffix, node)


def open_bus(settings: BusSettings) -> can.BusABC:
    """Open the bus.

    Raises
    ------
    DeviceError
        Library, interface, kernel module or permission is missing, or a setting does not fit.
    """
    arguments = dict(settings.arguments)
    try:
        import can
        import can.interfaces

        if settings.interface not in can.interfaces.BACKENDS:
            raise ConfigError(
                f"python-can has no interface {settings.interface!r}.", place=f"{settings.place}.interface",
                value=settings.interface, remedy=f"It has: {', '.join(sorted(can.interfaces.BACKENDS))}.",
            )  # fmt: skip
        return can.Bus(interface=settings.interface, ignore_config=True, **arguments)
    except ImportError as error:
        raise DeviceError(
            f"the library {error.name or 'python-can'!r} is missing: {error}.", place=settings.place,
            remedy=f"Install it: pip install {'python-can' if error.name == 'can' else error.name}.",
        ) from error  # fmt: skip
    except (OSError, ValueError, TypeError, NotImplementedError, can.CanError) as error:
        raise DeviceError(
            f"the {settings.interface} interface {_shown(arguments)} does not open: {_reason(error)}.",
            place=settings.place,
            value=arguments.get("channel"),
            remedy=_remedy(settings, error),
        ) from error


def _shown(arguments: Mapping[str, Any]) -> str:
    channel = arguments.get("channel")
    return f"{channel!r}" if channel is not None else "(no channel given)"


def _reason(error: BaseException) -> str:
    """The innermost cause says most: python-can wraps the operating system's errors."""
    causes = [str(error).rstrip(".")]
    inner = error.__cause__ or error.__context__
    while inner is not None:
        text = str(inner).rstrip(".")
        if text and text not in causes:
            causes.append(text)
        inner = inner.__cause__ or inner.__context__
    return ": ".join(causes)


def _errno_of(error: BaseException | None) -> int | None:
    while error is not None:
        number = getattr(error, "errno", None)
        if isinstance(number, int):
            return number
        error = error.__cause__ or error.__context__
    return None


def _remedy(settings: BusSettings, error: BaseException) -> str:
    channel = settings.arguments.get("channel", "can0")
    bitrate = settings.arguments.get("bitrate", 1_000_000)
    number = _errno_of(error)
    remedy = "Check adapter, cable and channel; compare with `rigctl devices list`."
    if "msgpack" in str(error):
        remedy = "Install it: pip install msgpack."
    elif isinstance(error, NotImplementedError) or "library not found" in str(error).lower():
        remedy = (
            f"Install the vendor's library for the {settings.interface} interface (see python-can's manual), "
            "or correct the interface."
        )
    elif number in (errno.EPERM, errno.EACCES):
        remedy = f"Permission is missing: let this user open {channel} (group dialout, or udev rule)."
    elif settings.interface == "socketcan" and number in (errno.EAFNOSUPPORT, errno.EPROTONOSUPPORT):
        remedy = "This kernel has no CAN: load it with `modprobe can can_raw`, or use another interface."
    elif settings.interface == "socketcan":
        remedy = (
            f"Bring it up: ip link set {channel} up type can bitrate {bitrate} restart-ms 100; "
            "compare with `rigctl devices list`."
        )
    elif settings.interface == "udp_multicast":
        remedy = (
            "Check that channel is a multicast address (239.x.x.x), that there is a route to it "
            "(ip route add 239.0.0.0/8 dev lo) and that msgpack is installed."
        )
    elif isinstance(error, TypeError | ValueError):
        remedy = f"Correct the keys of [buses.{settings.name}]; python-can's manual lists them."
    return remedy

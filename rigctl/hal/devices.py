"""What a device must be able to do, role by role. Drivers and simulated devices implement these.

Job: narrow interfaces that say what holds after each call. Set-points given between two blocks take effect
in the next block. All set-points are leases: a device falls back to its safe value when the controller
stops renewing them (the rig renews them with every block). Zero speed, zero pressure and `vent` are always
accepted. Not its job: limits (the engine checks before, the watchdog during the run).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol, TypeVar

from rigctl.core.blocks import Block
from rigctl.core.channels import ChannelCorrection, ChannelSpec
from rigctl.hal.sharing import Lease, StatusBoard

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Request:
    """What the controller asks of the next block.

    Attributes
    ----------
    dt_ns : int
        Length of the block in rig time.
    recording : bool
        True: all channels at their full rate. False: a rig may deliver less (see `Block.stride`).
    """

    dt_ns: int
    recording: bool


@dataclass
class RigContext:
    """What devices of one rig share: where to put sockets, how time runs, and common connections.

    Attributes
    ----------
    run_dir : Path
        Private folder of this run, for sockets and the sample ring.
    time : str
        "virtual" or "real".
    seed : int or None
        Seed of a simulated rig.
    place : str
        The rig file, for messages.
    folder : Path
        Folder of the rig file; relative paths in settings start here.
    log_dir : Path or None
        Where devices may write logs.
    wire_log_dir : Path or None
        Where drivers log every transfer on their wires (`rigctl.hal.wirelog`; CAN: `drivers.can`); None: not.
    buses : mapping
        The rig file's `[buses.NAME]` tables.
    corrections : tuple of ChannelCorrection
        Calibrations in force: the acquisition takes them into scale and offset of its channels.
    lease : Lease
        In force while the control loop asks for blocks.
    board : StatusBoard
        What the devices say of themselves; the acquisition puts a copy into every block.
    """

    run_dir: Path
    time: str
    seed: int | None
    place: str
    folder: Path
    log_dir: Path | None = None
    wire_log_dir: Path | None = None
    buses: Mapping[str, Mapping[str, Any]] = field(default_factory=dict[str, Mapping[str, Any]])
    corrections: tuple[ChannelCorrection, ...] = ()
    lease: Lease = field(default_factory=Lease)
    board: StatusBoard = field(default_factory=StatusBoard)
    _shared: dict[str, Any] = field(default_factory=dict)

    def share(self, key: str, make: Callable[[], T]) -> T:
        """The one object of this key: devices on the same bus or session use it together."""
        if key not in self._shared:
            self._shared[key] = make()
        return self._shared[key]


class Device(Protocol):
    """Every device is made from its settings (and only checks them), then opened, then closed."""

    def __init__(self, settings: Mapping[str, Any], context: RigContext) -> None: ...

    def open(self) -> None:
        """Connect. After it returns the device is in its safe state. Raises `DeviceError`."""
        ...

    def close(self) -> None:
        """Go to the safe state and disconnect; never raises for a device that is gone already."""
        ...

    def identity(self) -> Mapping[str, str]:
        """Who the device says it is: maker, model, serial number, firmware; for the record."""
        ...


class SpeedDrive(Device, Protocol):
    """The motor and its controller."""

    @property
    def commanded_rpm(self) -> float:
        """Speed set-point in force."""
        ...

    @property
    def enabled(self) -> bool:
        """True when torque has been asked for."""
        ...

    def enable(self) -> None:
        """Allow torque. The speed set-point is zero until `set_speed`. Raises `DeviceError` if refused."""
        ...

    def disable(self) -> None:
        """Torque off; the shaft coasts."""
        ...

    def set_speed(self, speed_rpm: float, ramp_rpm_per_s: float) -> None:
        """Go to a speed along a ramp that the drive controller makes."""
        ...

    def quick_stop(self) -> None:
        """Ramp to zero as fast as the drive can, then torque off."""
        ...


class PressureActuator(Device, Protocol):
    """Actuator of the brake line pressure."""

    @property
    def commanded_bar(self) -> float:
        """Pressure set-point in force; 0 when vented."""
        ...

    def set_pressure(self, pressure_bar: float) -> None:
        """Hold this line pressure; takes effect with the actuator's own lag."""
        ...

    def vent(self) -> None:
        """Open the vent valve: pressure falls to zero whatever the set-point. Cleared by `set_pressure`."""
        ...


class Ventilator(Device, Protocol):
    """Cooling-air ventilator."""

    @property
    def commanded_m3_h(self) -> float:
        """Air flow in force: what was set, or what the device blows by itself while nobody commands it."""
        ...

    def set_flow(self, flow_m3_h: float) -> None:
        """Blow this much air; 0 is off."""
        ...


class Acquisition(Device, Protocol):
    """Signal sources of the rig, and its clock: the one that waits for the next block."""

    def channels(self) -> Sequence[ChannelSpec]:
        """All channels it delivers, known after `open`, with the corrections of the context in them
        (`rigctl.core.channels.corrected`)."""
        ...

    def next_block(self, request: Request) -> Block:
        """Deliver the next block. Raises `DeviceError` when the hardware falls silent."""
        ...


@dataclass(frozen=True, slots=True)
class SafetyStatus:
    """State of the safety chain as the controller sees it (the watchdog reads it by itself)."""

    relay_closed: bool
    estop_ok: bool
    doors_ok: bool


class SafetyChannel(Device, Protocol):
    """Read-back of the safety relay and the hard-wired chain, and how the watchdog gets at it."""

    def status(self) -> SafetyStatus:
        """Newest state."""
        ...

    def watchdog_link(self) -> tuple[str, Mapping[str, Any]]:
        """("module:Class", settings) of the `rigctl.core.safety_link.SafetyLink` for the watchdog process.

        Known before `open`: the watchdog starts before the controller opens the rig.
        """
        ...

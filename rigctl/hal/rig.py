"""The rig: its devices together, driven by blocks.

Job: build devices from a rig file through the registry, open and close them in order, hand out blocks, and
put everything into the safe state on every way out. Not its job: what to run (`rigctl.engine`), limits.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator, Mapping
from types import TracebackType
from typing import Any

from rigctl.config.rig import ROLES, RigConfig
from rigctl.core.blocks import Block
from rigctl.core.channels import ChannelSpec
from rigctl.core.errors import ConfigError, DeviceError, RigctlError
from rigctl.core.registry import Registry
from rigctl.core.units import NS_PER_S
from rigctl.hal.devices import (
    Acquisition,
    PressureActuator,
    Request,
    RigContext,
    SafetyChannel,
    SpeedDrive,
    Ventilator,
)


class Rig:
    """A rig, real or simulated. Use it as a context manager: leaving it is always safe.

    Attributes
    ----------
    config : RigConfig
    drive, pressure, ventilator, acquisition, safety
        The devices of the five roles.
    """

    def __init__(self, config: RigConfig, context: RigContext, registry: Registry) -> None:
        self.config = config
        context.buses = {name: bus.settings for name, bus in config.buses.items()}
        self.context = context
        devices: dict[str, Any] = {}
        for role in ROLES:
            entry = getattr(config.devices, role)
            place = f"{context.place}: devices.{role}.kind"
            cls = registry.load(role, entry.kind, place=place)
            try:
                devices[role] = cls(entry.settings, context)
            except ConfigError:
                raise
            except (TypeError, ValueError) as error:
                raise ConfigError(f"{error}.", place=f"{context.place}: devices.{role}") from error
        self.drive: SpeedDrive = devices["drive"]
        self.pressure: PressureActuator = devices["pressure"]
        self.ventilator: Ventilator = devices["ventilator"]
        self.acquisition: Acquisition = devices["acquisition"]
        self.safety: SafetyChannel = devices["safety"]
        self._devices = devices
        self._opened: list[str] = []
        self._request = Request(round(config.block_s * NS_PER_S), recording=False)

    def open(self) -> None:
        """Open all devices; when one fails, those opened before are closed again.

        Raises
        ------
        DeviceError
            Names the device and what to do.
        """
        try:
            for role in ROLES:
                self._open(role)
                self._opened.append(role)
        except BaseException:
            self.close()
            raise

    def _open(self, role: str) -> None:
        try:
            self._devices[role].open()
        except DeviceError as error:
            named = error.within(f"{self.context.place}: devices.{role}")
            if named is error:
                raise
            raise named from error

    def close(self) -> None:
        """Safe state, then close the devices in reverse order."""
        self.make_safe()
        while self._opened:
            self._devices[self._opened.pop()].close()

    def __enter__(self) -> Rig:
        self.open()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def channels(self) -> dict[str, ChannelSpec]:
        """All channels of the rig by name."""
        return {spec.name: spec for spec in self.acquisition.channels()}

    def identities(self) -> Mapping[str, Mapping[str, str]]:
        """What each device says it is, by role."""
        return {role: dict(self._devices[role].identity()) for role in self._opened}

    @property
    def steady_block_s(self) -> float:
        """Length of recorded blocks while set-points are steady: above `block_s` in virtual time only."""
        config = self.config
        return (
            max(config.block_s, config.steady_block_s) if self.context.time == "virtual" else config.block_s
        )

    def request(self, *, dt_s: float, recording: bool) -> None:
        """Length and kind of the blocks from the next one on.

        In real time none is longer than `block_s`, and all are whole: people look at the signals at any time.
        """
        if self.context.time == "real":
            dt_s, recording = min(dt_s, self.config.block_s), True
        self._request = Request(round(dt_s * NS_PER_S), recording)

    def blocks(self) -> Iterator[Block]:
        """Blocks, one after the other, as long as the caller goes on asking.

        Raises
        ------
        DeviceError
            The hardware has fallen silent or gone.
        """
        while True:
            self.context.lease.renew()
            yield self.acquisition.next_block(self._request)

    def make_safe(self) -> None:
        """Zero pressure (vent), zero speed. Never raises: a device that is gone cannot be commanded, and the
        leases and the safety relay do the rest."""
        if "pressure" in self._opened:
            with contextlib.suppress(RigctlError):
                self.pressure.vent()
        if "drive" in self._opened:
            with contextlib.suppress(RigctlError):
                self.drive.set_speed(0.0, self.config.capabilities.max_speed_rate_rpm_s)

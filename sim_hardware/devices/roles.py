"""The five simulated devices: each a narrow view of one `SimulatedSession`.

Job: implement `rigctl.hal.devices` on top of the session. Set-points are collected and travel with the
next block. Not its job: physics.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rigctl.config.loading import read_toml, translated
from rigctl.core.blocks import Block
from rigctl.core.channels import ChannelSpec
from rigctl.core.errors import ConfigError, DeviceError
from rigctl.hal.devices import Request, RigContext, SafetyStatus
from sim_hardware.devices.session import DEFAULT_RELAY_TIMEOUT_S, SimulatedSession


class _Simulated:
    """What the five have in common."""

    role = ""
    known_settings: tuple[str, ...] = ()

    def __init__(self, settings: Mapping[str, Any], context: RigContext) -> None:
        for key in settings:
            if key not in self.known_settings:
                known = ", ".join(self.known_settings) or "none"
                raise ConfigError(
                    "unknown key.", place=f"{context.place}: devices.{self.role}.{key}", value=settings[key],
                    remedy=f"Settings of the simulated {self.role}: {known}.",
                )  # fmt: skip
        self._session = context.share("simulated", lambda: SimulatedSession(context))

    def open(self) -> None:
        """Connect to the rig server."""
        self._session.open()

    def close(self) -> None:
        """Disconnect."""
        self._session.close()

    def identity(self) -> Mapping[str, str]:
        """Maker and model."""
        return {"maker": "rigctl", "model": f"simulated {self.role}"}


class SimulatedDrive(_Simulated):
    """Speed drive of the simulated rig."""

    role = "drive"

    @property
    def commanded_rpm(self) -> float:
        """See `SpeedDrive.commanded_rpm`."""
        return self._session.setpoints.speed_rpm

    @property
    def enabled(self) -> bool:
        """See `SpeedDrive.enabled`."""
        return self._session.setpoints.enable

    def enable(self) -> None:
        """See `SpeedDrive.enable`."""
        if not self._session.status.get("relay", False):
            raise DeviceError("refuses to enable: the safety relay is open.", place="drive",
                              remedy="The watchdog must be armed first.")  # fmt: skip
        points = self._session.setpoints
        points.enable, points.quick_stop, points.speed_rpm = True, False, 0.0

    def disable(self) -> None:
        """See `SpeedDrive.disable`."""
        self._session.setpoints.enable = False

    def set_speed(self, speed_rpm: float, ramp_rpm_per_s: float) -> None:
        """See `SpeedDrive.set_speed`."""
        _require_finite("drive", speed_rpm, ramp_rpm_per_s)
        self._session.setpoints.speed_rpm = speed_rpm
        self._session.setpoints.ramp_rpm_per_s = ramp_rpm_per_s

    def quick_stop(self) -> None:
        """See `SpeedDrive.quick_stop`."""
        points = self._session.setpoints
        points.speed_rpm, points.quick_stop = 0.0, True


class SimulatedPressureActuator(_Simulated):
    """Pressure actuator of the simulated rig."""

    role = "pressure"

    @property
    def commanded_bar(self) -> float:
        """See `PressureActuator.commanded_bar`."""
        return self._session.setpoints.pressure_bar

    def set_pressure(self, pressure_bar: float) -> None:
        """See `PressureActuator.set_pressure`."""
        _require_finite("pressure", pressure_bar)
        self._session.setpoints.pressure_bar = pressure_bar
        self._session.setpoints.vent = False

    def vent(self) -> None:
        """See `PressureActuator.vent`."""
        self._session.setpoints.pressure_bar = 0.0
        self._session.setpoints.vent = True


class SimulatedVentilator(_Simulated):
    """Ventilator of the simulated rig."""

    role = "ventilator"

    @property
    def commanded_m3_h(self) -> float:
        """See `Ventilator.commanded_m3_h`."""
        return self._session.setpoints.ventilator_m3_h

    def set_flow(self, flow_m3_h: float) -> None:
        """See `Ventilator.set_flow`."""
        _require_finite("ventilator", flow_m3_h)
        self._session.setpoints.ventilator_m3_h = flow_m3_h


class SimulatedAcquisition(_Simulated):
    """Data acquisition of the simulated rig. Settings: ``brake`` and ``plant``, TOML files."""

    role = "acquisition"
    known_settings = ("brake", "plant")

    def __init__(self, settings: Mapping[str, Any], context: RigContext) -> None:
        super().__init__(settings, context)
        paths: dict[str, Path] = {}
        for key in self.known_settings:
            if not isinstance(settings.get(key), str):
                raise ConfigError("missing.", place=f"{context.place}: devices.acquisition.{key}",
                                  remedy=f"Name the {key}'s TOML file.")  # fmt: skip
            paths[key] = (context.folder / settings[key]).resolve()
        check_plant_files(paths["brake"], paths["plant"])
        self._session.arguments = ["--brake", str(paths["brake"]), "--plant", str(paths["plant"])]
        if context.seed is not None:
            self._session.arguments += ["--seed", str(context.seed)]
        if context.corrections:
            self._session.arguments += ["--corrections", json.dumps([asdict(c) for c in context.corrections])]

    def channels(self) -> Sequence[ChannelSpec]:
        """See `Acquisition.channels`."""
        return self._session.channels

    def next_block(self, request: Request) -> Block:
        """See `Acquisition.next_block`."""
        return self._session.next_block(request)


class SimulatedSafetyChannel(_Simulated):
    """Read-back of the simulated safety relay. Setting: ``relay_timeout_s``, how long the relay stays closed
    without an edge in real time; from 1 s on, in virtual time too (where it is 10 s otherwise)."""

    role = "safety"
    known_settings = ("relay_timeout_s",)

    def __init__(self, settings: Mapping[str, Any], context: RigContext) -> None:
        super().__init__(settings, context)
        timeout_s = settings.get("relay_timeout_s", DEFAULT_RELAY_TIMEOUT_S)
        if not isinstance(timeout_s, int | float) or not 0.05 <= timeout_s <= 5.0:
            raise ConfigError(
                f"{timeout_s!r} is no time for the relay.",
                place=f"{context.place}: devices.safety.relay_timeout_s",
                value=timeout_s,
                remedy="Give seconds between 0.05 and 5.",
            )
        self._session.relay_timeout_s = float(timeout_s)

    def status(self) -> SafetyStatus:
        """See `SafetyChannel.status`."""
        status = self._session.status
        return SafetyStatus(
            status.get("relay", False), status.get("estop", False), status.get("doors", False)
        )

    def watchdog_link(self) -> tuple[str, Mapping[str, Any]]:
        """See `SafetyChannel.watchdog_link`."""
        return (
            "sim_hardware.devices.safety_link:SimulatedSafetyLink",
            {"socket": str(self._session.socket)},
        )


def check_plant_files(brake: Path, plant: Path) -> None:
    """Load both files, so that a fault in them is told before any process starts.

    Raises
    ------
    ConfigError
        Names file, key, value and remedy.
    """
    from sim_hardware.brake_model import load_brake
    from sim_hardware.plant import PlantSettings

    with translated(brake):
        load_brake(brake)
    mapping = read_toml(plant)
    with translated(plant, mapping, PlantSettings):
        PlantSettings.model_validate(mapping)


def _require_finite(device: str, *values: float) -> None:
    for value in values:
        if not math.isfinite(value):
            raise DeviceError(f"refuses the set-point {value}.", place=device, value=value,
                              remedy="Set-points must be finite numbers.")  # fmt: skip

"""What is known of the devices of a rig: from the journal of a session, or from `rigctl devices test`.

Job: one `DeviceRow` for each role, in words. Plain Python, no Qt. Not its job: asking devices
(`rigctl.app.devices`), the table.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from PySide6.QtCore import QCoreApplication

from rigctl.config.rig import ROLES, RigConfig
from rigctl.core.journal import Record
from rigctl.gui.format import number_text
from rigctl.gui.rig.state import RigState

translate = QCoreApplication.translate


@dataclass(frozen=True)
class DeviceFinding:
    """Something about a device that a person should know; `unsafe` settings come first."""

    words: str
    remedy: str
    unsafe: bool


@dataclass(frozen=True)
class DeviceRow:
    """One device.

    Attributes
    ----------
    role, kind : str
    identity : tuple of (str, str)
    values : tuple of (str, str)
        Name and newest value with its unit and age.
    findings : tuple of DeviceFinding
    result : str
        "ok", "warning", "failed", "simulated", or "" while nobody has asked.
    """

    role: str
    kind: str = ""
    identity: tuple[tuple[str, str], ...] = ()
    values: tuple[tuple[str, str], ...] = ()
    findings: tuple[DeviceFinding, ...] = field(default_factory=tuple)
    result: str = ""

    @property
    def identity_text(self) -> str:
        """Identity in one line."""
        return ", ".join(f"{key} {value}" for key, value in self.identity)


def rows_of_session(config: RigConfig, records: Iterable[Record]) -> list[DeviceRow]:
    """From the rig's file and the newest record "rig_opened"."""
    told: Mapping[str, Mapping[str, str]] = {}
    for record in records:
        if record.kind == "rig_opened":
            told = record.payload.get("devices", {})
    return [
        DeviceRow(role, getattr(config.devices, role).kind, tuple(dict(told.get(role, {})).items()))
        for role in ROLES
    ]


def values_of_state(state: RigState, age_s: float) -> dict[str, tuple[tuple[str, str], ...]]:
    """Newest values by role from the state of the window, with their age."""
    r = state.readings
    old = translate("devices", "{0} s old").format(number_text(age_s, 1))

    def shown(value: float, unit: str, decimals: int) -> str:
        return f"{number_text(value, decimals)} {unit}, {old}"

    on, off = translate("devices", "on"), translate("devices", "off")
    closed, opened = translate("devices", "closed"), translate("devices", "open")
    return {
        "drive": (
            (translate("devices", "speed"), shown(r.speed_rpm, "1/min", 1)),
            (translate("devices", "set-point"), f"{number_text(r.set_speed_rpm, 1)} 1/min"),
            (translate("devices", "torque enable"), on if state.enabled else off),
        ),
        "pressure": (
            (translate("devices", "line pressure"), shown(r.pressure_bar, "bar", 2)),
            (translate("devices", "set-point"), f"{number_text(r.set_pressure_bar, 2)} bar"),
        ),
        "ventilator": ((translate("devices", "air"), f"{number_text(r.ventilator_m3_h, 0)} m³/h"),),
        "acquisition": (
            (translate("devices", "torque"), shown(r.torque_nm, "N·m", 1)),
            (translate("devices", "disc"), shown(r.temperature_degc, "°C", 1)),
        ),
        "safety": ((translate("devices", "relay"), closed if state.relay_closed else opened),),
    }


def rows_of_test(text: str) -> list[DeviceRow]:
    """From the output of ``rigctl devices test RIG --json``.

    Raises
    ------
    ValueError
        The text is no such output.
    """
    try:
        devices = json.loads(text)["devices"]
        return [_tested(device) for device in devices]
    except (KeyError, TypeError) as error:
        raise ValueError(f"the test has answered something else: {error}") from error


def _tested(device: Mapping[str, Any]) -> DeviceRow:
    values = []
    for reading in device["values"]:
        values.append((str(reading["name"]), _value_text(reading)))
    findings = [
        DeviceFinding(str(f["problem"]), str(f.get("remedy", "")), bool(f.get("unsafe")))
        for f in device["findings"]
    ]
    findings.sort(key=lambda finding: not finding.unsafe)
    return DeviceRow(
        role=str(device["role"]),
        kind=str(device["kind"]),
        identity=tuple((str(k), str(v)) for k, v in device["identity"].items()),
        values=tuple(values),
        findings=tuple(findings),
        result=str(device["result"]),
    )


def _value_text(reading: Mapping[str, Any]) -> str:
    value, fault = reading.get("value"), reading.get("fault")
    if isinstance(value, float):
        value = f"{value:.5g}"
    text = (
        translate("devices", "not valid") if value is None else f"{value} {reading.get('unit', '')}".strip()
    )
    age_s = reading.get("age_s")
    parts = [
        text,
        "" if age_s is None else translate("devices", "{0} ms old").format(f"{age_s * 1e3:.0f}"),
        fault or "",
    ]
    return ", ".join(part for part in parts if part)

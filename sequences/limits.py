"""The rules of the dry run: one braking against the rig's limits.

Job: yield a finding for every set-point the rig cannot do, extremes of the pressure function included. Not
the job: grouping and counting (``check``).

Power and torque are bounded from above: highest pressure with highest speed, at the highest coefficient of
friction. The bound may be met by no moment of the braking; it never misses one that exceeds the drive.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from sequences.braking import Braking, RecordedChannel
from sequences.capabilities import WATTS_PER_NM_RPM, ChannelCapability, RigCapabilities


@dataclass(frozen=True)
class Finding:
    """A set-point the rig cannot do. Findings with the same key and problem are one for the reader."""

    key: str
    value: float | str
    unit: str
    problem: str
    remedy: str
    severity: Literal["error", "warning"] = "error"


def temperature_findings(braking: Braking, rig: RigCapabilities) -> Iterator[Finding]:
    """Start temperature and temperature limits."""
    most_degc = rig.max_disc_temperature_degc
    if braking.limits.max_degc > most_degc:
        yield Finding(
            "limits.max_degc",
            braking.limits.max_degc,
            "degC",
            f"is above the {most_degc:g} degC the rig allows for the disc",
            f"set limits.max_degc to {most_degc:g} or less",
        )
    if braking.temperature_degc is None:
        return
    if braking.temperature_degc > most_degc:
        yield Finding(
            "temperatures_degc",
            braking.temperature_degc,
            "degC",
            f"is above the {most_degc:g} degC the rig allows for the disc",
            f"use start temperatures up to {most_degc:g} degC",
        )
    if braking.temperature_degc < rig.min_conditioning_degc:
        ambient_degc = rig.thermal.ambient_degc
        yield Finding(
            "temperatures_degc",
            braking.temperature_degc,
            "degC",
            f"is not reached by cooling with air of {ambient_degc:g} degC",
            f"use start temperatures from {rig.min_conditioning_degc:g} degC",
        )
    yield from _drag_findings(braking, rig)


def _drag_findings(braking: Braking, rig: RigCapabilities) -> Iterator[Finding]:
    speed_rpm, pressure_bar = braking.conditioning.drag_speed_rpm, braking.conditioning.drag_pressure_bar
    if speed_rpm is not None and not rig.min_speed_rpm <= speed_rpm <= rig.max_speed_rpm:
        yield Finding(
            "conditioning.drag_speed_rpm",
            speed_rpm,
            "1/min",
            f"is not within {rig.min_speed_rpm:g} to {rig.max_speed_rpm:g} 1/min of the drive",
            f"leave it out to use the rig's own {rig.conditioning_speed_rpm:g} 1/min",
        )
    if pressure_bar is not None and not rig.min_pressure_bar <= pressure_bar <= rig.max_pressure_bar:
        yield Finding(
            "conditioning.drag_pressure_bar",
            pressure_bar,
            "bar",
            f"is not within {rig.min_pressure_bar:g} to {rig.max_pressure_bar:g} bar of the actuator",
            f"leave it out to use the rig's own {rig.conditioning_pressure_bar:g} bar",
        )


def speed_findings(braking: Braking, rig: RigCapabilities) -> Iterator[Finding]:
    """Speeds and speed ramps."""
    profile = braking.speed_profile
    if profile.max_rpm > rig.max_speed_rpm:
        yield Finding(
            "speed_profiles",
            profile.max_rpm,
            "1/min",
            f"is above the {rig.max_speed_rpm:g} 1/min of the drive",
            f"use speeds up to {rig.max_speed_rpm:g} 1/min",
        )
    if profile.min_rpm < rig.min_speed_rpm:
        reverse = "is the reverse direction, which this drive does not run"
        beyond = f"is below the {rig.min_speed_rpm:g} 1/min of the drive in reverse"
        yield Finding(
            "speed_profiles",
            profile.min_rpm,
            "1/min",
            beyond if rig.min_speed_rpm < 0 else reverse,
            f"use speeds from {rig.min_speed_rpm:g} 1/min",
        )
    if profile.max_slope_rpm_s > rig.max_speed_rate_rpm_s:
        yield Finding(
            "speed_profiles",
            profile.max_slope_rpm_s,
            "1/min per s",
            f"is steeper than the drive's ramp of {rig.max_speed_rate_rpm_s:g} 1/min per s",
            "lengthen the segment, or reduce the difference of its two speeds",
        )


def pressure_findings(braking: Braking, rig: RigCapabilities) -> Iterator[Finding]:
    """Extremes and rate of the pressure, and with the speed the load of the drive."""
    low_bar, high_bar = braking.min_pressure_bar, braking.max_pressure_bar
    if high_bar > rig.max_pressure_bar:
        yield Finding(
            "pressures_bar",
            high_bar,
            "bar",
            f"is above the {rig.max_pressure_bar:g} bar of the actuator (working point plus amplitude)",
            f"keep working point plus amplitude at {rig.max_pressure_bar:g} bar or less",
        )
    if 0 < low_bar < rig.min_pressure_bar:
        yield Finding(
            "pressures_bar",
            low_bar,
            "bar",
            f"is below {rig.min_pressure_bar:g} bar, the lowest pressure the actuator can hold",
            f"use 0, or at least {rig.min_pressure_bar:g} bar after subtracting the amplitude",
        )
    rate_bar_s = braking.pressure_function.rate_bar_s(braking.pressure_bar, braking.duration_s)
    if rig.max_pressure_rate_bar_s is not None and rate_bar_s > rig.max_pressure_rate_bar_s:
        yield Finding(
            "pressure_function",
            rate_bar_s,
            "bar/s",
            f"is faster than the actuator's {rig.max_pressure_rate_bar_s:g} bar/s",
            "lower amplitude or frequency, or lengthen rise_s or the braking",
        )
    yield from _load_findings(braking, rig, high_bar)


def _load_findings(braking: Braking, rig: RigCapabilities, high_bar: float) -> Iterator[Finding]:
    profile = braking.speed_profile
    torque_nm = rig.peak_torque_nm(high_bar)
    power_kw = torque_nm * max(abs(profile.max_rpm), abs(profile.min_rpm)) * WATTS_PER_NM_RPM / 1000.0
    if torque_nm > rig.max_torque_nm and power_kw > 0:
        yield Finding(
            "pressures_bar",
            torque_nm,
            "N·m",
            f"of possible brake torque are above the {rig.max_torque_nm:g} N·m of the drive",
            f"use at most {rig.max_torque_nm / rig.peak_torque_nm_bar + rig.dead_pressure_bar:.1f} bar",
        )
    if power_kw > rig.drive_power_kw:
        yield Finding(
            "speed_profiles",
            power_kw,
            "kW",
            f"of possible brake power are above the {rig.drive_power_kw:g} kW of the drive",
            "reduce the speed or the pressure",
        )


def recording_findings(braking: Braking, rig: RigCapabilities) -> Iterator[Finding]:
    """Channels, their rates, and quiet while sound is recorded."""
    for channel in braking.recording.channels:
        capability = rig.channels.get(channel.name)
        if capability is None:
            yield Finding(
                "recording.channels",
                channel.name,
                "",
                "is no channel of this rig",
                f"choose from: {', '.join(sorted(rig.channels))}",
            )
            continue
        yield from _rate_findings(braking.recording.sampling_hz, channel, capability)
        if capability.is_sound and braking.ventilator:
            yield Finding(
                "ventilator",
                channel.name,
                "",
                "is a sound channel and would record the ventilator",
                "set ventilator = false, or remove the channel from recording.channels",
            )


def _rate_findings(
    sampling_hz: float, channel: RecordedChannel, capability: ChannelCapability
) -> Iterator[Finding]:
    ratio = capability.rate_hz * channel.decimation / sampling_hz
    if round(ratio) < 1 or abs(ratio - round(ratio)) > 1e-9 * ratio:
        stored_hz = sampling_hz / channel.decimation
        yield Finding(
            "recording.channels",
            f"{channel.name} at {stored_hz:.6g} Hz",
            "",
            "cannot be stored at this rate: it is not the channel's own rate divided by a whole number",
            f"'{channel.name}' is sampled at {capability.rate_hz:g} Hz: choose sampling_hz and decimation so"
            f" that sampling_hz / decimation is {capability.rate_hz:g}, {capability.rate_hz / 2:g},"
            f" {capability.rate_hz / 4:g} ... Hz",
        )

"""What a rig can do, for commands given by hand; and a braking by hand as a program of one.

Job: refuse before anything moves, with the words of the dry run. Not its job: limits during the run
(watchdog).
"""

from __future__ import annotations

from rigctl.core.errors import RunError
from rigctl.engine.commands import Condition, Record, SetPressure, SetSpeed, SetVentilator
from rigctl.hal.rig import Rig
from sequences.braking import Conditioning, RecordedChannel, Recording, TemperatureLimits
from sequences.capabilities import RigCapabilities
from sequences.check import check_program
from sequences.matrix import Sequence
from sequences.pressure import ConstantPressure
from sequences.profiles import SpeedProfile
from sequences.program import Program

SEQUENCE = "manual"
SLOW_RATE_HZ = 1000.0  # slow channels are stored at no more than this
COOL_DOWN_K = 20.0  # below the highest temperature
Movement = SetSpeed | SetPressure | SetVentilator | Condition | Record


def beyond_capabilities(command: Movement, rig: Rig) -> str:
    """Why the rig cannot do it, and after a line break the remedy; empty when it can."""
    can = rig.config.capabilities
    if isinstance(command, SetSpeed):
        return _speed(command, can)
    if isinstance(command, SetPressure):
        return _pressure(command, can)
    if isinstance(command, Condition):
        low, high = can.min_conditioning_degc, can.max_disc_temperature_degc
        if not low <= command.temperature_degc <= high:
            return f"temperature {command.temperature_degc:g} °C is outside {low:g} … {high:g} °C."
    if isinstance(command, Record):
        result = check_program(program_of(command, rig), can)
        if result.errors:
            first = result.errors[0]
            return f"{first.problem} ({first.value}).\n{first.remedy}"
    return ""


def _speed(command: SetSpeed, can: RigCapabilities) -> str:
    ramp, low, high = command.ramp_rpm_per_s, can.min_speed_rpm, can.max_speed_rpm
    if not low <= command.speed_rpm <= high:
        return f"speed {command.speed_rpm:g} 1/min is outside {low:g} … {high:g} 1/min."
    if ramp is not None and ramp > can.max_speed_rate_rpm_s:
        return f"ramp {ramp:g} 1/min/s is above {can.max_speed_rate_rpm_s:g} 1/min/s."
    return ""


def _pressure(command: SetPressure, can: RigCapabilities) -> str:
    function = command.function or ConstantPressure()
    low, high = function.min_bar(command.pressure_bar), function.max_bar(command.pressure_bar)
    if low < 0.0:
        return f"the pressure would fall to {low:g} bar.\nLower the amplitude."
    if high > can.max_pressure_bar:
        return f"the pressure would rise to {high:g} bar, above {can.max_pressure_bar:g} bar."
    if command.pressure_bar < can.min_pressure_bar:
        return f"the actuator cannot hold less than {can.min_pressure_bar:g} bar.\nGive 0 to release."
    if command.function is not None and command.duration_s is None:
        return "a pressure function without a duration.\nGive the duration in seconds."
    return ""


def program_of(command: Record, rig: Rig) -> Program:
    """The braking as a program of one, so that it is checked and stored like any other."""
    highest_degc = rig.config.capabilities.max_disc_temperature_degc
    sequence = Sequence(
        name=SEQUENCE,
        role="check",
        speed_profiles=(SpeedProfile.constant(command.speed_rpm, command.duration_s),),
        pressures_bar=(command.pressure_bar,),
        pressure_function=command.function or ConstantPressure(),
        conditioning=Conditioning(enabled=False),
        limits=TemperatureLimits(max_degc=highest_degc, cool_down_degc=highest_degc - COOL_DOWN_K),
        recording=recording_of_all(rig),
    )
    return Program(name=SEQUENCE, sequences=(sequence,))


def recording_of_all(rig: Rig) -> Recording:
    """All channels of a rig: sound as acquired, the others at no more than `SLOW_RATE_HZ`.

    Raises
    ------
    RunError
        The rates of the rig's channels do not fit each other.
    """
    specs = rig.channels()
    sampling_hz = max(spec.rate_hz for spec in specs.values())
    channels = [
        RecordedChannel(
            name=name,
            decimation=1 if spec.rate_hz == sampling_hz else _decimation(name, spec.rate_hz, sampling_hz),
        )
        for name, spec in specs.items()
    ]
    return Recording(sampling_hz=sampling_hz, channels=tuple(channels))


def _decimation(name: str, rate_hz: float, sampling_hz: float) -> int:
    """Whole divisor of the sampling rate whose stored rate also divides the channel's own rate."""
    least = max(round(sampling_hz / SLOW_RATE_HZ), 1)
    for decimation in range(least, 100 * least + 1):
        ratio = rate_hz * decimation / sampling_hz
        if ratio >= 1.0 and abs(ratio - round(ratio)) < 1e-9:
            return decimation
    raise RunError(
        f"its rate of {rate_hz:g} Hz does not fit the {sampling_hz:g} Hz of the sound.",
        place=name,
        remedy="Choose rates in the rig file that divide each other.",
    )

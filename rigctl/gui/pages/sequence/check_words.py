"""What the checks of a program say, in the language of the window.

Job: the list of their sentences as the package `sequences` writes them (keys of the file and all), and
`check_said`. Their translations name fields as the page does. A test holds that every finding of the checks
against a rig is in the list. Not its job: the checks, the places of faults (`checking`).
"""

from __future__ import annotations

from PySide6.QtCore import QT_TRANSLATE_NOOP

from rigctl.gui.rig.patterns import Patterns

CHECKS = Patterns("checks", (
    # one number
    QT_TRANSLATE_NOOP("checks", "{0} is not from {1} to {2}"),
    QT_TRANSLATE_NOOP("checks", "{0} is not above {1} and up to {2}"),
    QT_TRANSLATE_NOOP("checks", "{0} is not a number that can be set"),
    QT_TRANSLATE_NOOP("checks", "give a whole number of 1 or more"),
    QT_TRANSLATE_NOOP("checks", "give a whole number of 0 or more"),
    QT_TRANSLATE_NOOP("checks", "give a whole number of 1 or more, e.g. {0}"),
    QT_TRANSLATE_NOOP("checks", "give the sampling rate in Hz, e.g. {0}"),
    QT_TRANSLATE_NOOP("checks", "give a time in seconds from {0} to {1}, e.g. {2}"),
    QT_TRANSLATE_NOOP("checks", "give the duration in seconds, at most one hour"),
    QT_TRANSLATE_NOOP("checks", "give a time in seconds, 0 or more, at most one day"),
    QT_TRANSLATE_NOOP("checks", "give a time in seconds, at most one day"),
    QT_TRANSLATE_NOOP("checks", "give the disc speed in 1/min; negative is the reverse direction"),
    QT_TRANSLATE_NOOP("checks", "give the brake pressure in bar, 0 or more"),
    QT_TRANSLATE_NOOP("checks", "give the pressure offset from the working point in bar"),
    QT_TRANSLATE_NOOP("checks", "give the amplitude in bar, 0 or more; 0 is 'constant'"),
    QT_TRANSLATE_NOOP("checks", "give the frequency of the pressure function in Hz, e.g. {0}"),
    QT_TRANSLATE_NOOP("checks", "give the disc temperature in degrees Celsius (0 K is {0})"),
    QT_TRANSLATE_NOOP("checks", "give the half width of the band in kelvin, e.g. {0}"),
    # one sequence by itself
    QT_TRANSLATE_NOOP("checks", "dragging at {0} does not heat"),
    QT_TRANSLATE_NOOP(
        "checks",
        "leave out drag_speed_rpm and drag_pressure_bar to use the rig's own, or give values above 0",
    ),
    QT_TRANSLATE_NOOP("checks", "max_degc = {0} is below cool_down_degc = {1}"),
    QT_TRANSLATE_NOOP(
        "checks", "let the cool-down temperature be the lower one, e.g. max_degc = {0}, cool_down_degc = {1}"
    ),
    QT_TRANSLATE_NOOP("checks", "channel {0} is listed twice"),
    QT_TRANSLATE_NOOP("checks", "remove one of them"),
    QT_TRANSLATE_NOOP("checks", "the segments last {0} s together"),
    QT_TRANSLATE_NOOP("checks", "shorten the braking to at most {0} s"),
    QT_TRANSLATE_NOOP("checks", "the speed jumps by {0} 1/min after segment {1}"),
    QT_TRANSLATE_NOOP(
        "checks", "let the next segment start where the last one ends, or put a ramp between them"
    ),
    QT_TRANSLATE_NOOP("checks", "{0} brakings are more than {1}"),
    QT_TRANSLATE_NOOP("checks", "shorten the lists or the repetition; split the work into several programs"),
    QT_TRANSLATE_NOOP("checks", "split the work into several programs"),
    QT_TRANSLATE_NOOP("checks", "temperatures_degc: {0} degC is above limits.max_degc = {1}"),
    QT_TRANSLATE_NOOP("checks", "lower the temperature, or raise limits.max_degc if brake and rig allow it"),
    QT_TRANSLATE_NOOP("checks", "pressures_bar: the working point {0} bar less the amplitude is {1} bar"),
    QT_TRANSLATE_NOOP(
        "checks", "raise the working point or reduce the amplitude: the pressure cannot be negative"
    ),
    QT_TRANSLATE_NOOP(
        "checks", "pressure_function.rise_s = {0} is not shorter than the braking of {1} s"
    ),
    QT_TRANSLATE_NOOP("checks", "shorten rise_s or lengthen the braking"),
    QT_TRANSLATE_NOOP("checks", "two sequences are called {0}"),
    QT_TRANSLATE_NOOP("checks", "give each sequence its own name (capitals do not distinguish)"),
    # against the rig
    QT_TRANSLATE_NOOP("checks", "{0} the conditioning drag does not heat the disc to this temperature"),
    QT_TRANSLATE_NOOP(
        "checks", "raise conditioning.drag_pressure_bar or drag_speed_rpm, or lower the temperature"
    ),
    QT_TRANSLATE_NOOP("checks", "{0} conditioning is expected to take longer than its time-out"),
    QT_TRANSLATE_NOOP(
        "checks", "raise conditioning.timeout_s, or choose a loop order with smaller temperature steps"
    ),
    QT_TRANSLATE_NOOP(
        "checks",
        "{0} the braking is expected to heat the disc above this limit, and would be cut short",
    ),
    QT_TRANSLATE_NOOP("checks", "start cooler, or brake shorter or with less pressure"),
    QT_TRANSLATE_NOOP("checks", "{0} is above the {1} degC the rig allows for the disc"),
    QT_TRANSLATE_NOOP("checks", "set limits.max_degc to {0} or less"),
    QT_TRANSLATE_NOOP("checks", "use start temperatures up to {0} degC"),
    QT_TRANSLATE_NOOP("checks", "{0} is not reached by cooling with air of {1} degC"),
    QT_TRANSLATE_NOOP("checks", "use start temperatures from {0} degC"),
    QT_TRANSLATE_NOOP("checks", "{0} is not within {1} to {2} 1/min of the drive"),
    QT_TRANSLATE_NOOP("checks", "leave it out to use the rig's own {0}"),
    QT_TRANSLATE_NOOP("checks", "{0} is not within {1} to {2} bar of the actuator"),
    QT_TRANSLATE_NOOP("checks", "{0} is above the {1} 1/min of the drive"),
    QT_TRANSLATE_NOOP("checks", "use speeds up to {0} 1/min"),
    QT_TRANSLATE_NOOP("checks", "{0} is the reverse direction, which this drive does not run"),
    QT_TRANSLATE_NOOP("checks", "{0} is below the {1} 1/min of the drive in reverse"),
    QT_TRANSLATE_NOOP("checks", "use speeds from {0} 1/min"),
    QT_TRANSLATE_NOOP("checks", "{0} is steeper than the drive's ramp of {1} 1/min per s"),
    QT_TRANSLATE_NOOP("checks", "lengthen the segment, or reduce the difference of its two speeds"),
    QT_TRANSLATE_NOOP("checks", "{0} is above the {1} bar of the actuator (working point plus amplitude)"),
    QT_TRANSLATE_NOOP("checks", "keep working point plus amplitude at {0} bar or less"),
    QT_TRANSLATE_NOOP("checks", "{0} is below {1} bar, the lowest pressure the actuator can hold"),
    QT_TRANSLATE_NOOP("checks", "use 0, or at least {0} bar after subtracting the amplitude"),
    QT_TRANSLATE_NOOP("checks", "{0} is faster than the actuator's {1} bar/s"),
    QT_TRANSLATE_NOOP("checks", "lower amplitude or frequency, or lengthen rise_s or the braking"),
    QT_TRANSLATE_NOOP("checks", "{0} of possible brake torque are above the {1} N·m of the drive"),
    QT_TRANSLATE_NOOP("checks", "use at most {0} bar"),
    QT_TRANSLATE_NOOP("checks", "{0} of possible brake power are above the {1} kW of the drive"),
    QT_TRANSLATE_NOOP("checks", "reduce the speed or the pressure"),
    QT_TRANSLATE_NOOP("checks", "{0} is no channel of this rig"),
    QT_TRANSLATE_NOOP("checks", "choose from: {0}"),
    QT_TRANSLATE_NOOP("checks", "{0} is a sound channel and would record the ventilator"),
    QT_TRANSLATE_NOOP("checks", "set ventilator = false, or remove the channel from recording.channels"),
    QT_TRANSLATE_NOOP(
        "checks",
        "{0} at {1} Hz cannot be stored at this rate: it is not the channel's own rate divided by a whole"
        " number",
    ),
    QT_TRANSLATE_NOOP(
        "checks",
        "'{0}' is sampled at {1} Hz: choose sampling_hz and decimation so that sampling_hz / decimation is"
        " {2} ... Hz",
    ),
))  # fmt: skip


def check_said(text: str) -> str:
    """A problem or remedy of the checks in the language of the window; as it came when it is not known."""
    return CHECKS.say(text)

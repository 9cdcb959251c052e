"""Names of the choices of a sequence, in the language of the window. Not its job: explaining faults."""

from __future__ import annotations

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

_NAMES = {
    "bedding": QT_TRANSLATE_NOOP("sequence", "bedding"),
    "matrix": QT_TRANSLATE_NOOP("sequence", "matrix"),
    "friction": QT_TRANSLATE_NOOP("sequence", "friction"),
    "stop": QT_TRANSLATE_NOOP("sequence", "stop"),
    "calibration": QT_TRANSLATE_NOOP("sequence", "calibration"),
    "check": QT_TRANSLATE_NOOP("sequence", "check"),
    "constant": QT_TRANSLATE_NOOP("sequence", "constant"),
    "ramp": QT_TRANSLATE_NOOP("sequence", "ramp"),
    "sine": QT_TRANSLATE_NOOP("sequence", "sine"),
    "triangle": QT_TRANSLATE_NOOP("sequence", "triangle"),
    "steps": QT_TRANSLATE_NOOP("sequence", "steps"),
    "temperature": QT_TRANSLATE_NOOP("sequence", "Temperature"),
    "speed": QT_TRANSLATE_NOOP("sequence", "Speed"),
    "pressure": QT_TRANSLATE_NOOP("sequence", "Pressure"),
    "channel-pressure": QT_TRANSLATE_NOOP("sequence", "pressure"),
    "channel-speed": QT_TRANSLATE_NOOP("sequence", "speed"),
    "channel-microphone": QT_TRANSLATE_NOOP("sequence", "sound (microphone)"),
    "channel-torque": QT_TRANSLATE_NOOP("sequence", "torque"),
    "channel-disc_temperature": QT_TRANSLATE_NOOP("sequence", "disc temperature"),
}


_PLACES = {
    "name": QT_TRANSLATE_NOOP("sequence", "name"),
    "repeat": QT_TRANSLATE_NOOP("sequence", "repeat"),
    "temperatures_degc": QT_TRANSLATE_NOOP("sequence", "temperatures"),
    "speed_profiles": QT_TRANSLATE_NOOP("sequence", "speed profiles"),
    "pressures_bar": QT_TRANSLATE_NOOP("sequence", "pressures"),
    "processing": QT_TRANSLATE_NOOP("sequence", "combinations"),
    "pressure_function.kind": QT_TRANSLATE_NOOP("sequence", "pressure course"),
    "pressure_function.amplitude_bar": QT_TRANSLATE_NOOP("sequence", "amplitude"),
    "pressure_function.frequency_hz": QT_TRANSLATE_NOOP("sequence", "frequency"),
    "pressure_function.steps_bar": QT_TRANSLATE_NOOP("sequence", "steps"),
    "pressure_function.rise_s": QT_TRANSLATE_NOOP("sequence", "rise time"),
    "conditioning.tolerance_k": QT_TRANSLATE_NOOP("sequence", "tolerance"),
    "conditioning.soak_s": QT_TRANSLATE_NOOP("sequence", "soak"),
    "conditioning.timeout_s": QT_TRANSLATE_NOOP("sequence", "time-out"),
    "conditioning.drag_speed_rpm": QT_TRANSLATE_NOOP("sequence", "drag speed"),
    "conditioning.drag_pressure_bar": QT_TRANSLATE_NOOP("sequence", "drag pressure"),
    "limits.max_degc": QT_TRANSLATE_NOOP("sequence", "maximum temperature"),
    "limits.cool_down_degc": QT_TRANSLATE_NOOP("sequence", "cool-down temperature"),
    "recording.sampling_hz": QT_TRANSLATE_NOOP("sequence", "sampling rate"),
    "recording.channels": QT_TRANSLATE_NOOP("sequence", "channels"),
    "recording.pre_s": QT_TRANSLATE_NOOP("sequence", "recording before the pressure"),
    "recording.post_s": QT_TRANSLATE_NOOP("sequence", "recording after the release"),
    "dwell_s": QT_TRANSLATE_NOOP("sequence", "rest"),
    "ventilator": QT_TRANSLATE_NOOP("sequence", "ventilator"),
}


def place_name(place: str) -> str:
    """Name of a field in a sentence; "" for places that are no field."""
    return QCoreApplication.translate("sequence", str(_PLACES[place])) if place in _PLACES else ""


def name_of(key: str) -> str:
    """The name a person reads; keys without one are shown as they are."""
    return QCoreApplication.translate("sequence", str(_NAMES[key])) if key in _NAMES else key


def channel_name(key: str) -> str:
    """The name of a channel; channels without one are shown as they are."""
    named = name_of(f"channel-{key}")
    return key if named == f"channel-{key}" else named


def one_or_many(count: int, one: str, many: str) -> str:
    """ "1 braking", "25 brakings": both texts come translated, the second with {0}."""
    return one if count == 1 else many.format(count)


def brakings_text(count: int | None) -> str:
    """ "225 brakings"; a dash while the number is not known."""
    if count is None:
        return "—"
    one = QCoreApplication.translate("sequence", "1 braking")
    return one_or_many(count, one, QCoreApplication.translate("sequence", "{0} brakings"))


def long_time_text(seconds: float) -> str:
    """A duration for planning: "42 s", "12 min", "4 h 10 min", "3 d 4 h"."""
    minutes = round(seconds / 60)
    if seconds < 90:
        return f"{round(seconds)}\u202fs"
    if minutes < 60:
        return f"{minutes}\u202fmin"
    hours, rest = divmod(minutes, 60)
    if hours < 48:
        return f"{hours}\u202fh {rest:02d}\u202fmin"
    return f"{hours // 24}\u202fd {hours % 24}\u202fh"

"""Results, set-points and metadata of a braking as lines of text. No widgets.

Job: names in words, numbers with fixed decimals, units from the names. Not its job: tables (`details`).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

from rigctl.core.units import unit_of
from rigctl.gui.format import MISSING, number_text

CONTEXT = "data-results"
_NAMES = {
    "mean_mu": str(QT_TRANSLATE_NOOP("data-results", "Coefficient of friction, mean")),
    "std_mu": str(QT_TRANSLATE_NOOP("data-results", "Coefficient of friction, variation")),
    "leq_db": str(QT_TRANSLATE_NOOP("data-results", "Equivalent level")),
    "laeq_db": str(QT_TRANSLATE_NOOP("data-results", "Equivalent level, A-weighted")),
    "lmax_db": str(QT_TRANSLATE_NOOP("data-results", "Highest level (Fast)")),
    "background_db": str(QT_TRANSLATE_NOOP("data-results", "Background level")),
    "clipped_share": str(QT_TRANSLATE_NOOP("data-results", "Clipped samples, share")),
    "n_squeal": str(QT_TRANSLATE_NOOP("data-results", "Squeal events")),
    "squeal_frequency_hz": str(QT_TRANSLATE_NOOP("data-results", "Loudest squeal, frequency")),
    "squeal_level_db": str(QT_TRANSLATE_NOOP("data-results", "Loudest squeal, level")),
    "application_start_s": str(QT_TRANSLATE_NOOP("data-results", "Brake applied from")),
    "application_end_s": str(QT_TRANSLATE_NOOP("data-results", "Brake applied to")),
    "temperature_degc": str(QT_TRANSLATE_NOOP("data-results", "Disc temperature, set-point")),
    "pressure_bar": str(QT_TRANSLATE_NOOP("data-results", "Pressure, set-point")),
}
_CHANNELS = {
    "torque": str(QT_TRANSLATE_NOOP("data-results", "Torque")),
    "pressure": str(QT_TRANSLATE_NOOP("data-results", "Pressure")),
    "speed": str(QT_TRANSLATE_NOOP("data-results", "Speed")),
    "disc_temperature": str(QT_TRANSLATE_NOOP("data-results", "Disc temperature")),
}
_KINDS = {
    "mean": str(QT_TRANSLATE_NOOP("data-results", "mean")),
    "std": str(QT_TRANSLATE_NOOP("data-results", "variation")),
    "initial": str(QT_TRANSLATE_NOOP("data-results", "start")),
    "final": str(QT_TRANSLATE_NOOP("data-results", "end")),
    "minimum": str(QT_TRANSLATE_NOOP("data-results", "least")),
    "maximum": str(QT_TRANSLATE_NOOP("data-results", "greatest")),
}
_DECIMALS = {"Hz": 0, "dB": 1, "dB(A)": 1, "s": 2, "bar": 2, "°C": 1, "1/min": 2, "N·m": 1, "Pa": 3, "": 3}
_UNITS = {"laeq_db": "dB(A)"}
_WHOLE = ("n_squeal", "repetition", "index_in_sequence")

Line = tuple[str, str, str]
"""Name, value, unit."""


def result_lines(summary: Mapping[str, Any]) -> list[Line]:
    """Set-points, then results."""
    points = {k: v for k, v in summary["set_points"].items() if k in ("pressure_bar", "temperature_degc")}
    return [*_lines(points), *_lines(summary["results"])]


def _lines(values: Mapping[str, float | int | None]) -> Iterator[Line]:
    for name, value in values.items():
        unit = _UNITS.get(name) or unit_of(name)
        decimals = 0 if name in _WHOLE else _DECIMALS.get(unit, 3)
        yield name_text(name), number_text(value, decimals) if value is not None else MISSING, unit


def name_text(name: str) -> str:
    """Name of a result in words; unknown ones as they are."""
    if name in _NAMES:
        return _say(_NAMES[name])
    for channel, words in _CHANNELS.items():
        kind = name.removeprefix(f"{channel}_").partition("_")[0]
        if name.startswith(f"{channel}_") and kind in _KINDS:
            return f"{_say(words)}, {_say(_KINDS[kind])}"
    return name.replace("_", " ")


def metadata_lines(*groups: tuple[str, Mapping[str, Any]]) -> list[tuple[str, str]]:
    """Nested mappings as lines "rig", "versions.numpy", …, each group with its name before."""
    return [line for name, mapping in groups for line in _flat(mapping, name)]


def _flat(value: Any, name: str) -> Iterator[tuple[str, str]]:
    if isinstance(value, Mapping):
        for key, item in value.items():
            yield from _flat(item, f"{name}.{key}" if name else str(key))
    elif isinstance(value, list) and value and isinstance(value[0], Mapping):
        for number, item in enumerate(value, start=1):
            yield from _flat(item, f"{name}[{number}]")
    elif isinstance(value, float):
        yield name, f"{value:.6g}"
    else:
        yield name, "" if value is None else str(value)


def _say(text: str) -> str:
    return QCoreApplication.translate(CONTEXT, text)

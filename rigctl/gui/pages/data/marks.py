"""Marks of a braking in words. No widgets.

Job: times and texts of what happened while it was recorded, operator's notes and ratings among them. Not
its job: drawing.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

CONTEXT = "data-marks"
_WORDS = {
    "pressure_onset": str(QT_TRANSLATE_NOOP("data-marks", "Pressure is applied")),
    "pressure_release": str(QT_TRANSLATE_NOOP("data-marks", "Pressure is released")),
    "operator_note": str(QT_TRANSLATE_NOOP("data-marks", "Note")),
    "operator_rating": str(QT_TRANSLATE_NOOP("data-marks", "Noise rating")),
}


@dataclass(frozen=True)
class Mark:
    """Something that happened at a time since the first sample."""

    time_s: float
    words: str
    by_operator: bool


def marks_of(stored: Iterable[Mapping[str, Any]]) -> list[Mark]:
    """Marks in order of time."""
    found = []
    for mark in stored:
        name = str(mark["name"])
        known = _WORDS.get(name)
        words = QCoreApplication.translate(CONTEXT, known) if known else name.replace("_", " ")
        details = _details(name, mark.get("values") or {})
        found.append(
            Mark(float(mark["t_s"]), f"{words}: {details}" if details else words, name.startswith("operator"))
        )
    return sorted(found, key=lambda mark: mark.time_s)


def _details(name: str, values: Mapping[str, Any]) -> str:
    if name == "operator_note":
        return str(values.get("text", ""))
    if name == "operator_rating":
        return str(values.get("rating", ""))
    return ", ".join(
        f"{key}: {value:.4g}" if isinstance(value, float) else f"{key}: {value}"
        for key, value in values.items()
    )

"""Columns of the table of brakings: title, unit, decimals, value. No widgets.

Job: one description per column, and the text of a cell. Not its job: which are shown (the table remembers).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

from rigctl.gui.format import MISSING, number_text
from rigctl.gui.pages.data.entry import Entry

Value = float | int | str | None
CONTEXT = "data-columns"


@dataclass(frozen=True)
class Column:
    """One column; `decimals` is None for text."""

    key: str
    title: str
    unit: str
    decimals: int | None
    value: Callable[[Entry], Value]
    shown: bool = False
    tip: str = ""

    @property
    def is_number(self) -> bool:
        """True when it is right-aligned and sorted by value."""
        return self.decimals is not None

    def title_text(self) -> str:
        """Title in the language of the window."""
        return QCoreApplication.translate(CONTEXT, self.title)

    def header_text(self) -> str:
        """Title and, below it, the unit."""
        return f"{self.title_text()}\n{self.unit}" if self.unit else self.title_text()

    def tip_text(self) -> str:
        """What the column says."""
        return QCoreApplication.translate(CONTEXT, self.tip) if self.tip else self.title_text()

    def text(self, entry: Entry) -> str:
        """The cell."""
        value = self.value(entry)
        if value is None or value == "":
            return MISSING if self.is_number else ""
        if isinstance(value, str):
            return value
        return number_text(value, self.decimals or 0)

    def sort_key(self, entry: Entry) -> tuple[bool, float | str]:
        """Order of the cells; missing values are always last."""
        value = self.value(entry)
        if self.is_number:
            if value is None or isinstance(value, str) or value != value:  # noqa: PLR0124
                return True, 0.0
            return False, value
        text = "" if value is None else str(value).casefold()
        return not text, text


def state_text(state: str) -> str:
    """A state in the language of the window."""
    return QCoreApplication.translate(CONTEXT, _STATES.get(state, state))


def role_text(role: str) -> str:
    """A role in the language of the window; roles of one's own as they are."""
    return QCoreApplication.translate(CONTEXT, _ROLES.get(role, role))


_STATES = {
    "complete": str(QT_TRANSLATE_NOOP("data-columns", "complete")),
    "incomplete": str(QT_TRANSLATE_NOOP("data-columns", "incomplete")),
    "recovered": str(QT_TRANSLATE_NOOP("data-columns", "recovered")),
    "excluded": str(QT_TRANSLATE_NOOP("data-columns", "excluded")),
    "trashed": str(QT_TRANSLATE_NOOP("data-columns", "in the trash")),
    "unreadable": str(QT_TRANSLATE_NOOP("data-columns", "unreadable")),
}
_ROLES = {
    "bedding": str(QT_TRANSLATE_NOOP("data-columns", "bedding")),
    "matrix": str(QT_TRANSLATE_NOOP("data-columns", "matrix")),
    "check": str(QT_TRANSLATE_NOOP("data-columns", "check")),
    "manual": str(QT_TRANSLATE_NOOP("data-columns", "manual")),
}


def _remark(entry: Entry) -> str:
    row = entry.row
    return " · ".join(text for text in (row.excluded, row.remark, row.note) if text)


def _start(entry: Entry) -> str:
    return entry.row.start_time[:19].replace("T", " ")


COLUMNS: tuple[Column, ...] = (
    Column("index", str(QT_TRANSLATE_NOOP("data-columns", "No.")), "", 0, lambda e: e.index, True,
           str(QT_TRANSLATE_NOOP("data-columns", "Number of the braking in its program"))),
    Column("start", str(QT_TRANSLATE_NOOP("data-columns", "Start")), "", None, _start, False,
           str(QT_TRANSLATE_NOOP("data-columns", "Time of the first sample by the clock of the rig"))),
    Column("sequence", str(QT_TRANSLATE_NOOP("data-columns", "Sequence")), "", None,
           lambda e: e.row.sequence),
    Column("role", str(QT_TRANSLATE_NOOP("data-columns", "Role")), "", None,
           lambda e: role_text(e.row.role)),
    Column("set_pressure", str(QT_TRANSLATE_NOOP("data-columns", "Set p")), "bar", 1,
           lambda e: e.row.set_pressure_bar, True,
           str(QT_TRANSLATE_NOOP("data-columns", "Set-point of the brake pressure"))),
    Column("set_temperature", str(QT_TRANSLATE_NOOP("data-columns", "Set T")), "°C", 0,
           lambda e: e.row.set_temperature_degc, True,
           str(QT_TRANSLATE_NOOP("data-columns", "Set-point of the disc temperature"))),
    Column("pressure", str(QT_TRANSLATE_NOOP("data-columns", "Pressure")), "bar", 1,
           lambda e: e.row.pressure_mean_bar, False,
           str(QT_TRANSLATE_NOOP("data-columns", "Mean brake pressure while the brake was applied"))),
    Column("speed", str(QT_TRANSLATE_NOOP("data-columns", "Speed")), "1/min", 1,
           lambda e: e.row.speed_mean_rpm, False,
           str(QT_TRANSLATE_NOOP("data-columns", "Mean speed of the disc"))),
    Column("torque", str(QT_TRANSLATE_NOOP("data-columns", "Torque")), "N·m", 1,
           lambda e: e.row.torque_mean_nm, False,
           str(QT_TRANSLATE_NOOP("data-columns", "Mean friction torque"))),
    Column("temperature", str(QT_TRANSLATE_NOOP("data-columns", "Disc, start")), "°C", 1,
           lambda e: e.row.temperature_initial_degc, False,
           str(QT_TRANSLATE_NOOP("data-columns", "Disc temperature at the start of the brake application"))),
    Column("temperature_max", str(QT_TRANSLATE_NOOP("data-columns", "Disc, max")), "°C", 1,
           lambda e: e.row.temperature_maximum_degc, False,
           str(QT_TRANSLATE_NOOP("data-columns", "Highest disc temperature"))),
    Column("mu", str(QT_TRANSLATE_NOOP("data-columns", "Mean µ")), "", 3, lambda e: e.row.mean_mu, True,
           str(QT_TRANSLATE_NOOP("data-columns", "Mean coefficient of friction"))),
    Column("mu_std", str(QT_TRANSLATE_NOOP("data-columns", "Std µ")), "", 3, lambda e: e.row.std_mu, False,
           str(QT_TRANSLATE_NOOP("data-columns", "Variation of friction within the braking"))),
    Column("squeals", str(QT_TRANSLATE_NOOP("data-columns", "Squeals")), "", 0,
           lambda e: e.row.squeals if e.row.sound_recorded else None, False,
           str(QT_TRANSLATE_NOOP("data-columns", "Number of squeal events, harmonics left out"))),
    Column("frequency", str(QT_TRANSLATE_NOOP("data-columns", "Squeal")), "Hz", 0,
           lambda e: e.row.squeal_frequency_hz, True,
           str(QT_TRANSLATE_NOOP("data-columns", "Frequency of the loudest squeal"))),
    Column("level", str(QT_TRANSLATE_NOOP("data-columns", "Level")), "dB", 1, lambda e: e.row.squeal_level_db,
           True, str(QT_TRANSLATE_NOOP("data-columns", "Level of the loudest squeal"))),
    Column("level_a", str(QT_TRANSLATE_NOOP("data-columns", "Level A")), "dB(A)", 1,
           lambda e: e.row.squeal_level_dba, False,
           str(QT_TRANSLATE_NOOP("data-columns", "A-weighted level of the loudest squeal"))),
    Column("laeq", "LAeq", "dB(A)", 1, lambda e: e.row.laeq_db, False,
           str(QT_TRANSLATE_NOOP("data-columns", "A-weighted equivalent sound level of the braking"))),
    Column("lmax", "Lmax", "dB", 1, lambda e: e.row.lmax_db, False,
           str(QT_TRANSLATE_NOOP("data-columns", "Highest sound level, time weighting Fast"))),
    Column("rating", str(QT_TRANSLATE_NOOP("data-columns", "Rating")), "", 0, lambda e: e.row.rating, False,
           str(QT_TRANSLATE_NOOP("data-columns", "Subjective noise rating: 1 nothing heard … 9 unbearable"))),
    Column("state", str(QT_TRANSLATE_NOOP("data-columns", "State")), "", None,
           lambda e: state_text(e.state), True,
           str(QT_TRANSLATE_NOOP("data-columns", "Only complete brakings that are not excluded count"))),
    Column("tags", str(QT_TRANSLATE_NOOP("data-columns", "Tags")), "", None,
           lambda e: ", ".join(e.row.tags), True),
    Column("remark", str(QT_TRANSLATE_NOOP("data-columns", "Note")), "", None, _remark, True,
           str(QT_TRANSLATE_NOOP("data-columns", "Reason of an exclusion, notes, what went wrong"))),
)  # fmt: skip
BY_KEY = {column.key: column for column in COLUMNS}

"""Numbers that a person types: read, held against a range, refused with the reason. No widgets.

Job: `NumberRange` (limits as they are shown at the input) and its `read`. A comma is taken as decimal mark,
since many type it. Not its job: the field (`rigctl.gui.widgets.value_field`), where the limits come from.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from PySide6.QtCore import QCoreApplication

translate = QCoreApplication.translate


class EntryError(ValueError):
    """What was typed cannot be used; the text says why and what would do."""


@dataclass(frozen=True)
class NumberRange:
    """What a field takes.

    Attributes
    ----------
    low, high : float
        Both belong to the range.
    unit : str
    decimals : int
        Decimals that the field shows.
    or_zero : bool
        0 is allowed too, though it lies below `low` ("0 or 0.5…40 bar").
    what : str
        Name of the quantity for refusals: "The speed".
    """

    low: float
    high: float
    unit: str
    decimals: int = 1
    or_zero: bool = False
    what: str = ""

    def text(self) -> str:
        """The range as it stands at the input: "0…800 1/min"."""
        span = f"{self.low:g}…{self.high:g}\u202f{self.unit}".rstrip()
        return translate("entries", "0 or {0}").format(span) if self._zero_apart else span

    @property
    def _zero_apart(self) -> bool:
        return self.or_zero and self.low > 0.0

    def problem(self, value: float) -> str:
        """Why a number is refused; "" when it is fine."""
        if not math.isfinite(value):
            return translate("entries", "Give a number, e.g. {0}.").format(self.show(self.example()))
        if self.low <= value <= self.high or (self.or_zero and value == 0.0):
            return ""
        name = self.what or translate("entries", "The value")
        template = (
            translate("entries", "{0} {1} is above the {2} of this rig. Give {3}.")
            if value > self.high
            else translate("entries", "{0} {1} is below {2}. Give {3}.")
        )
        edge = self.high if value > self.high else self.low
        return template.format(name, f"{value:g}", f"{edge:g}\u202f{self.unit}".rstrip(), self.text())

    def read(self, text: str) -> float:
        """The number in a text.

        Raises
        ------
        EntryError
            No number, or out of range; the reason in words.
        """
        problem = ""
        value = number_in(text)
        if value is None:
            shown = text.strip()
            problem = (
                translate("entries", "“{0}” is not a number. Give {1}.").format(shown, self.text())
                if shown
                else translate("entries", "Give a number: {0}.").format(self.text())
            )
        else:
            problem = self.problem(value)
        if problem or value is None:
            raise EntryError(problem)
        return value

    def hopeless(self, text: str) -> bool:
        """True when further typing cannot make it right: no number, or above the upper limit."""
        if text.strip() in ("", "-", "+", ".", ","):
            return False
        value = number_in(text)
        return value is None or value > max(self.high, 0.0) or value < min(self.low, 0.0)

    def example(self) -> float:
        """A number that would be taken."""
        return self.low if self.low > 0.0 else min(1.0, self.high)

    def show(self, value: float) -> str:
        """A number as the field shows it: no more decimals than needed."""
        text = f"{value:.{self.decimals}f}"
        return text.rstrip("0").rstrip(".") if "." in text else text


def number_in(text: str) -> float | None:
    """The finite number in a text, None when there is none; "12,5" is 12.5."""
    try:
        value = float(text.strip().replace(",", ".").replace("−", "-"))
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def numbers_in(text: str) -> list[float] | None:
    """Numbers separated by blanks or semicolons (or ", "); None when something is no number."""
    parts = text.replace(";", " ").replace(", ", " ").split()
    found = [number_in(part) for part in parts]
    return None if not found or None in found else [value for value in found if value is not None]

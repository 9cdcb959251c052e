"""The paper's numbers and statements beside ours: one form of table in every study with a counterpart.

NOT its job: knowing what the paper says; each study states its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from rigctl.model.output import Column, Table

NAME = "paper"


@dataclass(frozen=True, slots=True)
class Comparison:
    """One line: what, the paper's number or words, ours, unit, and whether it holds (None: for the reader).

    `holds`: True, False, or "in part".
    """

    quantity: str
    paper: Any
    ours: Any
    unit: str = ""
    holds: bool | str | None = None

    @property
    def deviation_percent(self) -> float | None:
        """Ours against the paper's, where both are numbers."""
        both = (self.paper, self.ours)
        if any(isinstance(v, bool) or not isinstance(v, float | int) for v in both) or not self.paper:
            return None
        return 100.0 * (self.ours - self.paper) / self.paper


def paper_table(title: str, rows: Sequence[Comparison]) -> Table:
    """The table "paper" of a study."""
    return Table(
        NAME,
        title,
        (
            Column("quantity", "", [row.quantity for row in rows]),
            Column("unit", "", [row.unit for row in rows]),
            Column("paper", "", [row.paper for row in rows]),
            Column("ours", "", [row.ours for row in rows]),
            Column("deviation", "%", [row.deviation_percent for row in rows]),
            Column("holds", "", [_word(row.holds) for row in rows]),
        ),
    )


def _word(holds: bool | str | None) -> str | None:
    if isinstance(holds, bool):
        return "yes" if holds else "no"
    return holds


#: what, the paper says, we find, whether it holds
Statement = tuple[str, str, str, bool]


def statement_table(rows: Sequence[Statement], section: str) -> Table:
    """The table "paper" of statements in words."""
    title = f"What the paper says (section {section}) and what this model does"
    return paper_table(title, [Comparison(what, says, ours, holds=holds) for what, says, ours, holds in rows])

"""The paper's statements beside ours: one table for all studies of the minimal models.

NOT its job: what is stated.
"""

from __future__ import annotations

from collections.abc import Sequence

from rigctl.model.output import Column, Table

Statement = tuple[str, str, str, bool]


def paper_table(rows: Sequence[Statement], section: str) -> Table:
    """The paper's statements beside ours: (what, the paper says, we find, whether it holds)."""
    return Table(
        "paper",
        f"What the paper says (section {section}) and what this model does",
        (
            Column("quantity", "", [row[0] for row in rows]),
            Column("unit", "", [""] * len(rows)),
            Column("paper", "", [row[1] for row in rows]),
            Column("ours", "", [row[2] for row in rows]),
            Column("deviation", "%", [None] * len(rows)),
            Column("holds", "", [row[3] for row in rows]),
        ),
    )

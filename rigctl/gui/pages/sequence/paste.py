"""Numbers as people type and paste them: decimal comma or point, cells parted by tabs, lines, semicolons.

Job: text to cells and cells to numbers, without guessing: what could mean two things is refused. Pure
functions without Qt. Not its job: which values make sense (`sequences`).
"""

from __future__ import annotations

import re

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_STRANGE = str.maketrans({"\u2212": "-", "\u2013": "-", "\u00a0": " ", "\u202f": " ", "\u2009": " "})
JOIN_MARK = "+"


def parse_number(text: str) -> float | None:
    """The number that `text` shows, decimal comma tolerated; None when it shows none."""
    plain = text.translate(_STRANGE).strip()
    if plain.count(",") == 1 and "." not in plain:
        plain = plain.replace(",", ".")
    return float(plain) if _NUMBER.fullmatch(plain) else None


def write_number(value: float) -> str:
    """The shortest text from which `parse_number` reads the same number: "10", "0.1"."""
    text = repr(float(value))
    return text[:-2] if text.endswith(".0") else text


def _split_commas(token: str) -> list[str]:
    """ "5,10,15" and "2.5,3.5" are lists; "2,5" is one number; "1.234,5" stays and is refused later."""
    pieces = token.split(",")
    several = len(pieces) > 2 or (len(pieces) == 2 and all("." in piece for piece in pieces))
    return pieces if several and all(_NUMBER.fullmatch(piece) for piece in pieces) else [token]


def _cells_of_line(line: str) -> list[str]:
    if "\t" in line or ";" in line:
        return [cell.strip() for cell in re.split(r"[\t;]", line)]
    tokens = re.split(r",\s+|\s+", line.strip())
    return [cell for token in tokens if token for cell in _split_commas(token)]


def parse_rows(text: str) -> list[list[str]]:
    """Lines of cells. A first line without any number, above others, is a heading and is left out."""
    lines = [line for line in text.translate(_STRANGE).splitlines() if line.strip(" \t;")]
    rows = [_cells_of_line(line) for line in lines]
    if len(rows) > 1 and not any(parse_number(cell) is not None for cell in rows[0]):
        rows = rows[1:]
    return rows


def parse_list(text: str) -> list[str]:
    """All cells that are not empty, in reading order: one list, whatever its shape was."""
    return [piece for row in parse_rows(text) for cell in row for piece in _split_blanks(cell)]


def _split_blanks(cell: str) -> list[str]:
    """ "5 10" are two numbers of a list; "5 bar" stays together and is refused later."""
    pieces = cell.split()
    return pieces if all(parse_number(piece) is not None for piece in pieces) else [cell]


def parse_block(text: str, columns: int) -> list[list[str]]:
    """Rows of at most `columns` cells with a leading mark: "+" where a line begins with it, else "".

    A line that begins with a plus sign of its own goes on with the profile above it.
    """
    rows: list[list[str]] = []
    for cells in parse_rows(text):
        joined = bool(cells) and cells[0] == JOIN_MARK
        rows.append([JOIN_MARK if joined else "", *cells[1 if joined else 0 :][:columns]])
    return rows

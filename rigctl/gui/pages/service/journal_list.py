"""The records of a journal as rows: read on from where one was, searched, filtered, in words.

Job: `JournalFile` reads what is new without losing a torn line; `rows_of` makes the words of a record;
`Filter` says which rows are shown. Plain Python, no Qt. Not its job: writing a journal, the table.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rigctl.core.journal import Record

MOST_BYTES = 8_000_000
"""Read at once; the rest comes with the next look."""
_LONG = 100


@dataclass(frozen=True)
class Row:
    """One record with its words and what is searched."""

    record: Record
    words: str
    haystack: str


class JournalFile:
    """Reads a journal bit by bit.

    Parameters
    ----------
    path : Path
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._offset = 0

    def read_on(self) -> list[Row]:
        """Whole lines since the last call; lines that are no records (power cut) are passed over.

        Raises
        ------
        OSError
            The file cannot be read.
        """
        with self.path.open("rb") as file:
            file.seek(self._offset)
            data = file.read(MOST_BYTES)
        end = data.rfind(b"\n") + 1
        self._offset += end
        rows = []
        for line in data[:end].splitlines():
            try:
                record = Record(**json.loads(line))
            except (ValueError, TypeError):
                continue
            rows.append(row_of(record))
        return rows


def row_of(record: Record) -> Row:
    """A record with its words."""
    words = words_of(record.payload)
    return Row(record, words, f"{record.source} {record.kind} {words} {record.utc}".lower())


def words_of(payload: dict[str, Any]) -> str:
    """What a record says, in one line: its words when it has some, else its fields."""
    if payload.get("words"):
        remedy = f" {payload['remedy']}" if payload.get("remedy") else ""
        return f"{payload['words']}{remedy}"
    return ", ".join(
        f"{key} {_short(value)}" for key, value in payload.items() if value not in (None, "", [])
    )


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, dict | list):
        text = json.dumps(value, ensure_ascii=False)
        return text if len(text) <= _LONG else f"({len(value)} entries)"
    return str(value)


def details_of(record: Record) -> str:
    """Everything in a record, for people."""
    head = {
        "time": record.utc, "rig time": record.rig_s, "process": f"{record.source} ({record.pid})",
        "kind": record.kind, "number": record.seq, "hash": record.sha,
    }  # fmt: skip
    lines = [f"{name}: {value}" for name, value in head.items() if value is not None]
    return "\n".join([*lines, "", json.dumps(record.payload, indent=1, ensure_ascii=False)])


@dataclass(frozen=True)
class Filter:
    """Which rows are shown: all words of `text` occur; source and kind are equal, "" is any."""

    text: str = ""
    source: str = ""
    kind: str = ""

    def passes(self, row: Row) -> bool:
        """True when the row is shown."""
        record = row.record
        if self.source and record.source != self.source:
            return False
        if self.kind and record.kind != self.kind:
            return False
        return all(word in row.haystack for word in self.text.lower().split())

    def pick(self, rows: Iterable[Row]) -> list[Row]:
        """Rows that are shown."""
        if self == Filter():
            return list(rows)
        return [row for row in rows if self.passes(row)]


def campaigns_of(data_folder: Path) -> list[Path]:
    """Folders with a journal, newest first."""
    found = []
    for folder in data_folder.iterdir() if data_folder.is_dir() else ():
        journal = folder / "journal.jsonl"
        try:
            found.append((journal.stat().st_mtime, folder))
        except OSError:
            continue
    return [folder for _, folder in sorted(found, reverse=True)]

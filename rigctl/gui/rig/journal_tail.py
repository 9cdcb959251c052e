"""New records of a journal, as they are appended.

Job: remember how far the file has been read; half-written lines wait for their end. Not its job: what records
mean.
"""

from __future__ import annotations

import json
from pathlib import Path

from rigctl.core.journal import Record

MOST_BYTES = 4_000_000  # read at once; the rest comes with the next call


class JournalTail:
    """Reads one journal from its beginning, each record once."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._offset = 0
        self._half = b""

    def read(self) -> list[Record]:
        """Records since the last call; lines that are no records (a power cut) are passed over."""
        try:
            with self.path.open("rb") as file:
                file.seek(self._offset)
                data = file.read(MOST_BYTES)
        except FileNotFoundError:
            return []
        self._offset += len(data)
        *lines, self._half = (self._half + data).split(b"\n")
        records: list[Record] = []
        for line in lines:
            try:
                records.append(Record(**json.loads(line)))
            except (ValueError, TypeError):
                continue
        return records

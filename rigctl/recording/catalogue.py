"""The catalogue of a campaign: summaries of its braking files in one SQLite file, derived and replaceable.

Job: give the summaries of ten thousand brakings without opening ten thousand HDF5 files. An entry holds while
time of change and size of its file are the same; `catalogue.sqlite` may be deleted at any time. Loads HDF5
only when a file has to be read. Not its job: rows and statistics (`rigctl.analysis.campaign_table`); for a
report these read the files themselves.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any, Self

from rigctl.core.errors import RecordingError
from rigctl.recording.trash import FOLDER as TRASH

FILE_NAME = "catalogue.sqlite"
BRAKINGS = "brakings"
_FORMAT = 1
_WAIT_S = 5.0
_TABLE = """CREATE TABLE IF NOT EXISTS braking (file TEXT PRIMARY KEY, mtime_ns INTEGER NOT NULL,
 size INTEGER NOT NULL, summary TEXT NOT NULL, problem TEXT NOT NULL) WITHOUT ROWID"""
_INSERT = "INSERT OR REPLACE INTO braking VALUES (?, ?, ?, ?, ?)"

Stamp = tuple[int, int]
"""Time of change in ns, and size."""


@dataclass(frozen=True)
class Found:
    """What a catalogue says. Files are named relative to the campaign: "brakings/00001.h5", "trash/00002.h5".

    Attributes
    ----------
    summaries : mapping of str to dict
        As `rigctl.recording.braking_file.read_summary` gives them.
    unreadable : mapping of str to str
        Files that cannot be read, and why.
    stale : list of str
        Files of which nothing is known, or that have changed: give them to `Catalogue.update`.
    """

    summaries: Mapping[str, dict[str, Any]]
    unreadable: Mapping[str, str]
    stale: list[str]


class Catalogue:
    """The catalogue of one campaign. A context manager; open it in the thread or process that uses it."""

    def __init__(self, campaign: Path) -> None:
        self.campaign = campaign
        self._db = _opened(campaign / FILE_NAME)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the file."""
        self._db.close()

    def read(self, only: Iterable[str] | None = None) -> Found:
        """Compare the catalogue with the files; all files, or only those named."""
        stamps = files_of(self.campaign)
        if only is not None:
            wanted = set(only)
            stamps = {name: stamp for name, stamp in stamps.items() if name in wanted}
        summaries: dict[str, dict[str, Any]] = {}
        unreadable: dict[str, str] = {}
        for name, mtime_ns, size, summary, problem in self._db.execute("SELECT * FROM braking"):
            if stamps.get(name) != (mtime_ns, size):
                continue
            if problem:
                unreadable[name] = problem
            else:
                summaries[name] = json.loads(summary)
        known = summaries.keys() | unreadable.keys()
        return Found(summaries, unreadable, [name for name in stamps if name not in known])

    def update(self, names: Iterable[str]) -> Found:
        """Read these files and remember what they say; a file that has gone is passed over."""
        from rigctl.recording.braking_file import read_summary  # loads HDF5

        summaries: dict[str, dict[str, Any]] = {}
        unreadable: dict[str, str] = {}
        rows: list[tuple[str, int, int, str, str]] = []
        for name in names:
            path = self.campaign / name
            try:
                stamp = _stamp(path)
                summaries[name] = read_summary(path)
            except FileNotFoundError:
                continue
            except RecordingError as error:
                if not path.exists():
                    continue
                unreadable[name] = error.problem
            text = json.dumps(summaries[name], ensure_ascii=False) if name in summaries else ""
            rows.append((name, stamp[0], stamp[1], text, unreadable.get(name, "")))
        with self._db:
            self._db.executemany(_INSERT, rows)
        return Found(summaries, unreadable, [])


def files_of(campaign: Path) -> dict[str, Stamp]:
    """Braking files of a campaign and of its trash with their stamps, by name."""
    found: dict[str, Stamp] = {}
    for folder in (BRAKINGS, TRASH):
        for path in sorted((campaign / folder).glob("*.h5")):
            try:
                found[f"{folder}/{path.name}"] = _stamp(path)
            except FileNotFoundError:  # moved just now
                continue
    return found


def _stamp(path: Path) -> Stamp:
    status = path.stat()
    return status.st_mtime_ns, status.st_size


def _opened(path: Path) -> sqlite3.Connection:
    """The data base; anew when it is damaged or of another format, in memory where none can be written."""
    for _ in range(2):
        try:
            return _prepared(sqlite3.connect(path, timeout=_WAIT_S))
        except sqlite3.OperationalError:  # the folder is read-only, or the disk full: do without
            break
        except sqlite3.DatabaseError:  # damaged: it is derived, so make it anew
            path.unlink(missing_ok=True)
    return _prepared(sqlite3.connect(":memory:"))


def _prepared(db: sqlite3.Connection) -> sqlite3.Connection:
    try:
        with db:
            if db.execute("PRAGMA user_version").fetchone()[0] != _FORMAT:
                db.execute("DROP TABLE IF EXISTS braking")
                db.execute(_TABLE)
                db.execute(f"PRAGMA user_version = {_FORMAT}")
            db.execute("SELECT count(*) FROM braking").fetchone()
    except sqlite3.Error:
        db.close()
        raise
    return db

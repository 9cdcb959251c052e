"""The journal: append-only JSON lines, written and flushed to the disk before the caller goes on.

Job: be the truth about what happened. Several processes append to one file: each record is one `write` on
an O_APPEND descriptor, so records never mix; each writer chains its own records by hash, so a gap or a
change is found. Standard library only: the watchdog writes here too. Not its job: samples.
"""

from __future__ import annotations

import hashlib
import json
import os
import time
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Record:
    """One event: who wrote it, when (UTC, monotonic and rig time), what, and the chain to the one before."""

    utc: str
    mono_ns: int
    rig_s: float | None
    source: str
    pid: int
    seq: int
    kind: str
    payload: dict[str, Any]
    prev: str
    sha: str


class Journal:
    """Writer of one process. `source` names the process: controller, watchdog, recorder, supervisor."""

    def __init__(self, path: Path, source: str) -> None:
        self.path = path
        self.source = source
        self._seq = 0
        self._prev = hashlib.sha256(f"{source}:{os.getpid()}".encode()).hexdigest()[:16]
        created = not path.exists()
        self._fd = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o644)
        self._end_a_torn_line()
        if created:
            _sync_folder(path.parent)

    def _end_a_torn_line(self) -> None:
        """After a power cut the last line may be cut off; the next record must start on a new line."""
        size = os.fstat(self._fd).st_size
        if size and os.pread(self._fd, 1, size - 1) != b"\n":
            os.write(self._fd, b"\n")

    def write(self, kind: str, *, rig_s: float | None = None, **payload: Any) -> Record:
        """Append one event and wait until it is on the disk.

        Raises
        ------
        OSError
            The disk is full or gone. The caller decides what that means for the rig.
        """
        body = {
            "utc": datetime.now(UTC).isoformat(timespec="milliseconds"),
            "mono_ns": time.monotonic_ns(),
            "rig_s": None if rig_s is None else round(rig_s, 6),
            "source": self.source,
            "pid": os.getpid(),
            "seq": self._seq,
            "kind": kind,
            "payload": payload,
            "prev": self._prev,
        }
        sha = _digest(body)
        line = json.dumps({**body, "sha": sha}, ensure_ascii=False).encode() + b"\n"
        if os.write(self._fd, line) != len(line):
            raise OSError(f"journal {self.path}: short write, the disk is full")
        os.fdatasync(self._fd)
        self._seq += 1
        self._prev = sha
        return Record(**body, sha=sha)

    def close(self) -> None:
        """Close the file; the journal cannot be written any more."""
        os.close(self._fd)


def _digest(body: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(body, sort_keys=True, ensure_ascii=False).encode()).hexdigest()[:16]


def _sync_folder(folder: Path) -> None:
    fd = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(fd)
    finally:
        os.close(fd)


def read_journal(path: Path) -> Iterator[Record]:
    """All readable records in the order of the file; torn lines (power cut) are passed over.

    Use `verify_journal` to learn about gaps.
    """
    with path.open("rb") as file:
        for line in file:
            try:
                yield Record(**json.loads(line))
            except (ValueError, TypeError):
                continue


def verify_journal(path: Path) -> list[str]:
    """Problems found: torn lines, changed records, gaps in a writer's chain. Empty when all is well."""
    problems: list[str] = []
    last: dict[tuple[str, int], Record] = {}
    with path.open("rb") as file:
        for number, line in enumerate(file, start=1):
            try:
                raw = json.loads(line)
                record = Record(**raw)
            except (ValueError, TypeError):
                problems.append(f"line {number}: not a whole record")
                continue
            body = {key: value for key, value in raw.items() if key != "sha"}
            if _digest(body) != record.sha:
                problems.append(f"line {number}: changed after it was written")
            writer = (record.source, record.pid)
            before = last.get(writer)
            if record.seq > 0 and (
                before is None or before.sha != record.prev or before.seq + 1 != record.seq
            ):
                problems.append(f"line {number}: gap before record {record.seq} of {record.source}")
            last[writer] = record
    return problems

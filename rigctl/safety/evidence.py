"""Evidence: the writer of the watchdog's journal, and what an earlier journal says about trips.

Job: take notes from the guard without ever making it wait (a thread writes, flushes and prints them), keep a
failure to write visible, and find trips that nobody has acknowledged. Not its job: deciding.
"""

from __future__ import annotations

import sys
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from queue import SimpleQueue
from typing import Any, Final

from rigctl.core.journal import Journal, Record, read_journal
from rigctl.core.safety_link import SafetySample
from rigctl.safety.causes import CAUSES, Cause, plain_json
from rigctl.safety.guard import Note
from rigctl.safety.latch import HOUR_S, ResetBook

SOURCE: Final = "watchdog"
EVIDENCE_S: Final = 2.0  # rig time of samples kept with a trip


def samples_mapping(samples: tuple[SafetySample, ...], until_s: float | None) -> dict[str, list[Any]]:
    """The last `EVIDENCE_S` of readings as columns, in rig units; the newest block is always in it."""
    kept = [s for s in samples if until_s is None or s.t_s > until_s - EVIDENCE_S] or list(samples[-1:])
    return {
        "k": [s.k for s in kept],
        "t_s": [plain_json(s.t_s) for s in kept],
        "pressure_bar": [[plain_json(v) for v in s.pressure_bar] for s in kept],
        "speed_rpm": [[plain_json(v) for v in s.speed_rpm] for s in kept],
        "torque_nm": [[plain_json(v) for v in s.torque_nm] for s in kept],
        "temperature_degc": [[plain_json(v) for v in s.temperature_degc] for s in kept],
        "relay_closed": [s.relay_closed for s in kept],
        "drive_enabled": [s.drive_enabled for s in kept],
        **({"channel_fault": faults} if any(faults := [s.channel_fault for s in kept]) else {}),
    }


class Evidence:
    """Writer thread in front of a `Journal`. `failure` says why it cannot write; empty while it can."""

    def __init__(self, path: Path) -> None:
        self.failure = ""
        self._journal = Journal(path, SOURCE)
        self._queue: SimpleQueue[Note | threading.Event] = SimpleQueue()
        threading.stack_size(256 * 1024)  # locked into memory in real time
        self._thread = threading.Thread(target=self._write_all, name="journal", daemon=True)
        self._thread.start()

    def put(self, note: Note) -> None:
        """Hand over a note; returns at once."""
        self._queue.put(note)

    def write(self, kind: str, **payload: Any) -> None:
        """Hand over an event without rig time."""
        self.put(Note(kind, None, payload))

    def flush(self, timeout_s: float) -> bool:
        """Wait until everything handed over is written or has failed; False when it takes too long."""
        done = threading.Event()
        self._queue.put(done)
        return done.wait(timeout_s)

    def _write_all(self) -> None:
        while True:
            item = self._queue.get()
            if isinstance(item, threading.Event):
                item.set()
                continue
            payload = dict(item.payload)
            if item.samples:
                payload["samples"] = samples_mapping(item.samples, item.rig_s)
            try:
                self._journal.write(item.kind, rig_s=item.rig_s, **payload)
            except (OSError, ValueError, TypeError) as error:
                self.failure = f"{type(error).__name__}: {error}"
            _print(item)


def _print(note: Note) -> None:
    """One plain line for the log; a closed terminal is no fault."""
    words = note.payload.get("words") or ", ".join(f"{key} {value}" for key, value in note.payload.items())
    at = "" if note.rig_s is None else f" at {note.rig_s:.2f} s"
    try:
        print(f"watchdog: {note.kind}{at}: {words}", file=sys.stderr, flush=True)
    except (OSError, ValueError):
        pass


@dataclass
class Past:
    """What the journal says: the newest trip without acknowledgement, and how old the resets are."""

    unacknowledged: Cause | None = None
    reset_ages_s: list[tuple[str, float]] = field(default_factory=list[tuple[str, float]])

    def reset_book(self, limit_per_hour: int, now_s: float) -> ResetBook:
        """Resets of the last hour on the clock of this process."""
        book = ResetBook(limit_per_hour)
        for cause_id, age_s in self.reset_ages_s:
            book.add(cause_id, now_s - age_s)
        return book


def read_past(path: Path) -> Past:
    """Look for trips and resets of earlier watchdogs in a journal; an absent journal has none."""
    past = Past()
    if not path.exists():
        return past
    now = datetime.now(UTC)
    for record in read_journal(path):
        if record.source != SOURCE:
            continue
        if record.kind == "trip":
            past.unacknowledged = _cause_of(record.payload)
        elif record.kind in ("reset", "acknowledged"):
            past.unacknowledged = None
            age_s = _age_s(record, now)
            if 0.0 <= age_s < HOUR_S:
                past.reset_ages_s.append((str(record.payload.get("cause")), age_s))
    return past


def _cause_of(payload: Mapping[str, Any]) -> Cause:
    cause_id = payload.get("cause")
    if cause_id not in CAUSES:  # written by another version
        return Cause("terminated", detail=f"{payload.get('words', cause_id)}")
    return Cause(cause_id, payload.get("value"), payload.get("threshold"), str(payload.get("detail", "")))


def _age_s(record: Record, now: datetime) -> float:
    try:
        return (now - datetime.fromisoformat(record.utc)).total_seconds()
    except (TypeError, ValueError):
        return 0.0

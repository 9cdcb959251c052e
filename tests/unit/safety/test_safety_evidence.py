"""Evidence: what is written, what an earlier journal says, and what the system refuses."""

from __future__ import annotations

import errno
import os
import time
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest
from guard_loop import sample_at

from rigctl.core.journal import Journal, Record, read_journal, verify_journal
from rigctl.safety import evidence as evidence_module
from rigctl.safety import realtime
from rigctl.safety.causes import Cause
from rigctl.safety.evidence import Evidence, read_past, samples_mapping
from rigctl.safety.guard import Note


def test_notes_are_written_in_their_order_with_rig_time(tmp_path: Path) -> None:
    writer = Evidence(tmp_path / "journal.jsonl")
    for k in range(20):
        writer.put(Note("watching", float(k), {"k": k}))
    assert writer.flush(5.0)
    records = list(read_journal(tmp_path / "journal.jsonl"))
    assert [(r.kind, r.rig_s, r.payload["k"]) for r in records] == [
        ("watching", float(k), k) for k in range(20)
    ]
    assert verify_journal(tmp_path / "journal.jsonl") == []
    assert writer.failure == ""


@pytest.mark.parametrize("error", [OSError(errno.ENOSPC, "No space left on device"), TypeError("no JSON")])
def test_a_failure_to_write_stays_visible_and_the_writer_lives(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    def refuse(*_: Any, **__: Any) -> Record:
        raise error

    writer = Evidence(tmp_path / "journal.jsonl")
    monkeypatch.setattr(Journal, "write", refuse)
    before = time.monotonic()
    writer.write("armed")
    assert time.monotonic() - before < 0.1
    assert writer.flush(5.0)
    assert str(error) in writer.failure
    monkeypatch.undo()
    writer.write("ended")
    assert writer.flush(5.0)
    assert [r.kind for r in read_journal(tmp_path / "journal.jsonl")] == ["ended"]
    assert str(error) in writer.failure  # once lost, the record has a hole


def test_a_slow_disk_does_not_make_the_guard_wait(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write = Journal.write

    def slowly(self: Journal, kind: str, **payload: Any) -> Record:
        time.sleep(0.2)
        return write(self, kind, **payload)

    writer = Evidence(tmp_path / "journal.jsonl")
    monkeypatch.setattr(Journal, "write", slowly)
    before = time.monotonic()
    writer.write("trip")
    assert time.monotonic() - before < 0.1
    assert not writer.flush(0.01)
    assert writer.flush(5.0)


def test_a_closed_terminal_is_no_fault(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Closed:
        def write(self, _text: str) -> int:
            raise BrokenPipeError

        def flush(self) -> None:
            raise BrokenPipeError

    monkeypatch.setattr(evidence_module.sys, "stderr", Closed())
    writer = Evidence(tmp_path / "journal.jsonl")
    writer.write("armed")
    assert writer.flush(5.0) and writer.failure == ""


def test_the_samples_of_a_trip_are_the_last_two_seconds_and_strict_json() -> None:
    samples = tuple(sample_at(k) for k in range(60))
    columns = samples_mapping(samples, samples[-1].t_s)
    assert columns["k"] == list(range(20, 60))
    assert len(columns["pressure_bar"]) == 40 and len(columns["pressure_bar"][0]) == 5
    bad = samples_mapping((sample_at(0, speed_rpm=(float("nan"), None, 1.0)),), None)
    assert bad["speed_rpm"] == [["nan", None, 1.0]]
    assert samples_mapping(samples, 1000.0)["k"] == [59]  # at least the newest


def journal_of(path: Path, *events: tuple[str, dict[str, Any]], source: str = "watchdog") -> Path:
    journal = Journal(path / "journal.jsonl", source)
    for kind, payload in events:
        journal.write(kind, **payload)
    journal.close()
    return path / "journal.jsonl"


TRIP = ("trip", Cause("temperature_range", 505.0, 500.0).to_mapping())
RESET = ("reset", {"who": "A. Person", "reason": "cool", "cause": "temperature_range"})
ACKNOWLEDGED = ("acknowledged", {"who": "A. Person", "reason": "cool", "cause": "temperature_range"})


@pytest.mark.parametrize(
    ("events", "open_trip"),
    [
        ([], False),
        ([("started", {}), ("armed", {})], False),
        ([TRIP], True),
        ([TRIP, ("safe_state_reached", {}), ("started", {}), ("armed", {})], True),
        ([TRIP, RESET], False),
        ([TRIP, ACKNOWLEDGED], False),
        ([TRIP, RESET, TRIP], True),
    ],
)
def test_a_trip_is_open_until_somebody_acknowledges_it(
    tmp_path: Path, events: list[tuple[str, dict[str, Any]]], open_trip: bool
) -> None:
    past = read_past(journal_of(tmp_path, *events))
    assert (past.unacknowledged is not None) is open_trip
    if past.unacknowledged is not None:
        assert past.unacknowledged.words == TRIP[1]["words"]


def test_an_absent_journal_and_other_writers_have_no_trips(tmp_path: Path) -> None:
    assert read_past(tmp_path / "none.jsonl").unacknowledged is None
    assert read_past(journal_of(tmp_path, TRIP, source="controller")).unacknowledged is None


def test_a_cause_of_another_version_is_still_a_trip(tmp_path: Path) -> None:
    past = read_past(journal_of(tmp_path, ("trip", {"cause": "of_the_future", "words": "too noisy."})))
    assert past.unacknowledged is not None and "too noisy" in past.unacknowledged.words


def test_resets_of_the_last_hour_count_in_the_next_process(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = journal_of(tmp_path, TRIP, RESET, TRIP, ACKNOWLEDGED, TRIP, RESET)
    book = read_past(path).reset_book(3, now_s=50.0)
    assert book.exhausted("temperature_range", 50.0)
    assert not book.exhausted("estop", 50.0)

    class Later(datetime):
        @classmethod
        def now(cls, tz: Any = None) -> datetime:
            return datetime.now(tz) + timedelta(hours=2)

    monkeypatch.setattr(evidence_module, "datetime", Later)
    assert read_past(path).reset_ages_s == []


def test_a_reset_with_an_unreadable_time_counts_as_new() -> None:
    record = Record("yesterday", 0, None, "watchdog", 1, 0, "reset", {}, "", "")
    assert evidence_module._age_s(record, datetime.now(UTC)) == 0.0


# -- real-time hygiene ------------------------------------------------------------------------------


@pytest.mark.parametrize(("fifo", "locked"), [(True, True), (False, True), (True, False), (False, False)])
def test_what_the_system_refuses_is_said_and_widens_the_window(
    monkeypatch: pytest.MonkeyPatch, fifo: bool, locked: bool
) -> None:
    def schedule(_pid: int, policy: int, _param: Any) -> None:
        assert policy == os.SCHED_FIFO
        if not fifo:
            raise PermissionError(errno.EPERM, "Operation not permitted")

    monkeypatch.setattr(realtime.os, "sched_setscheduler", schedule)
    monkeypatch.setattr(realtime, "_lock_memory", lambda: "" if locked else "Cannot allocate memory")
    granted = realtime.ask_for_priority()
    assert (granted.fifo, granted.memory_locked) == (fifo, locked)
    assert granted.narrow_window is (fifo and locked)
    assert ("SCHED_FIFO refused" in granted.words) is not fifo
    assert ("mlockall refused (Cannot allocate memory)" in granted.words) is not locked
    assert ("granted" in granted.words) is (fifo and locked)


def test_resident_memory_is_that_of_this_process() -> None:
    status = Path("/proc/self/status").read_text()
    kb = int(next(line for line in status.splitlines() if line.startswith("VmRSS")).split()[1])
    assert realtime.resident_mb() == pytest.approx(kb * 1024 / 1e6, rel=0.05)

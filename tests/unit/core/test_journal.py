"""The journal keeps what was acknowledged, and shows what was lost or changed."""

import json
import multiprocessing
import os
from pathlib import Path

import pytest

from rigctl.core.journal import Journal, read_journal, verify_journal


def _write_many(path: Path, source: str, n: int) -> None:
    journal = Journal(path, source)
    for i in range(n):
        journal.write("event", i=i, text="ü" * (i % 7))
    journal.close()


def test_records_come_back_in_order_with_their_payload(tmp_path: Path):
    journal = Journal(tmp_path / "j", "controller")
    journal.write("started", seed=1)
    journal.write("braking_started", rig_s=12.25, index=3, nested={"a": [1, None]})
    records = list(read_journal(tmp_path / "j"))
    assert [record.kind for record in records] == ["started", "braking_started"]
    assert records[1].rig_s == 12.25
    assert records[1].payload == {"index": 3, "nested": {"a": [1, None]}}
    assert records[1].prev == records[0].sha
    assert verify_journal(tmp_path / "j") == []


def test_several_processes_write_one_file_without_mixing(tmp_path: Path):
    path = tmp_path / "j"
    context = multiprocessing.get_context("spawn")
    writers = [context.Process(target=_write_many, args=(path, f"p{i}", 100)) for i in range(3)]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join(30)
    assert verify_journal(path) == []
    records = list(read_journal(path))
    for i in range(3):
        assert [r.payload["i"] for r in records if r.source == f"p{i}"] == list(range(100))


@pytest.mark.parametrize("cut", [1, 5, 40])
def test_torn_last_line_costs_only_itself(tmp_path: Path, cut: int):
    path = tmp_path / "j"
    _write_many(path, "controller", 3)
    os.truncate(path, path.stat().st_size - cut)
    journal = Journal(path, "recorder")
    journal.write("recovered")
    kinds = [(record.source, record.kind) for record in read_journal(path)]
    expected = [("controller", "event")] * (3 if cut == 1 else 2) + [("recorder", "recovered")]
    assert kinds == expected
    assert (verify_journal(path) == []) is (cut == 1)


def test_change_and_gap_are_found(tmp_path: Path):
    path = tmp_path / "j"
    _write_many(path, "controller", 4)
    lines = path.read_text().splitlines()
    changed = json.loads(lines[1])
    changed["payload"]["i"] = 99
    path.write_text("\n".join([lines[0], json.dumps(changed), *lines[2:]]) + "\n")
    assert any("changed" in problem for problem in verify_journal(path))
    path.write_text("\n".join([lines[0], *lines[2:]]) + "\n")
    assert any("gap" in problem for problem in verify_journal(path))

"""Recovery: what each kind of leftover becomes, and that a second recovery finds nothing to do."""

from __future__ import annotations

from pathlib import Path

import pytest
from recording_samples import new_campaign, no_evaluation, write_spool

from rigctl.core.journal import Journal, read_journal, verify_journal
from rigctl.recording.braking_file import read_braking
from rigctl.recording.campaign import Campaign, file_sha256
from rigctl.recording.commit import commit
from rigctl.recording.recovery import RecoveryReport, recover


@pytest.fixture
def campaign(tmp_path: Path) -> Campaign:
    """Braking 1 is committed."""
    made = new_campaign(tmp_path)
    write_spool(made.spool_path(1), 0.2)
    journal = Journal(made.journal_path, "recorder")
    commit(made, made.spool_path(1), no_evaluation, journal)
    journal.close()
    return made


def recover_twice(campaign: Campaign) -> RecoveryReport:
    report = recover(campaign, no_evaluation)
    files = {path: file_sha256(path) for path in campaign.folder.rglob("*") if path.is_file()}
    again = recover(campaign, no_evaluation)
    assert (again.recovered, again.removed_parts, again.unreadable_spools, again.journaled) == (
        (),
        (),
        (),
        (),
    )
    assert {path: file_sha256(path) for path in campaign.folder.rglob("*") if path.is_file()} == files
    assert verify_journal(campaign.journal_path) == []
    return report


def test_nothing_to_do(campaign: Campaign) -> None:
    before = campaign.journal_path.read_bytes()
    report = recover_twice(campaign)
    assert report.nothing_to_do and report.lines() == []
    assert campaign.journal_path.read_bytes() == before


@pytest.mark.parametrize(
    ("status", "expected"), [("complete", "complete"), ("incomplete", "incomplete"), (None, "recovered")]
)
def test_left_over_spools_become_files(campaign: Campaign, status: str | None, expected: str) -> None:
    write_spool(campaign.spool_path(2), 0.2, index=2, status=status)
    report = recover_twice(campaign)
    assert [(r.index, r.status) for r in report.recovered] == [(2, expected)]
    assert expected in report.lines()[0]
    assert campaign.completed_indices() == ({1, 2} if expected == "complete" else {1})
    assert [r.kind for r in read_journal(campaign.journal_path)][-1] == "CAMPAIGN_RECOVERED"


def test_a_damaged_spool_gives_what_is_whole(campaign: Campaign) -> None:
    write_spool(campaign.spool_path(2), 0.5, index=2)
    data = bytearray(campaign.spool_path(2).read_bytes())
    data[len(data) // 2] ^= 0x10
    campaign.spool_path(2).write_bytes(bytes(data) + b"\x00" * 17)
    report = recover_twice(campaign)
    assert report.recovered[0].status == "recovered" and report.recovered[0].bytes_cut > 17
    assert "could not be read" in report.lines()[0]
    assert len(read_braking(campaign.braking_path(2)).channels["microphone"].samples) == 20000


def test_half_made_files_go(campaign: Campaign) -> None:
    (campaign.brakings / "00002.h5.part").write_bytes(b"half")
    report = recover_twice(campaign)
    assert [path.name for path in report.removed_parts] == ["00002.h5.part"]


def test_an_unreadable_spool_is_kept_aside(campaign: Campaign) -> None:
    campaign.spool_path(2).write_bytes(b"torn header")
    report = recover_twice(campaign)
    (aside, why), *_ = report.unreadable_spools
    assert aside.read_bytes() == b"torn header" and "header" in why
    write_spool(campaign.spool_path(2), 0.2, index=2)  # the name is free for the next attempt


def test_a_whole_file_without_a_record_is_entered(campaign: Campaign) -> None:
    campaign.journal_path.write_bytes(b"")
    assert campaign.completed_indices() == frozenset()
    assert recover_twice(campaign).journaled == (1,)
    assert campaign.completed_indices() == {1}


def test_damaged_and_lost_files_are_named_and_done_again(campaign: Campaign) -> None:
    whole = campaign.braking_path(1).read_bytes()
    campaign.braking_path(1).write_bytes(whole[: len(whole) // 2])
    assert [path.name for path, _ in recover_twice(campaign).damaged] == ["00001.h5"]
    assert campaign.completed_indices() == frozenset() and campaign.next_attempt(1) == 2
    write_spool(campaign.spool_path(1), 0.2)
    recover(campaign, no_evaluation)
    assert campaign.completed_indices() == {1}
    assert [path.name for path in campaign.superseded.iterdir()] == ["00001-0-damaged.h5"]
    campaign.braking_path(1).unlink()
    assert "has gone" in recover_twice(campaign).lines()[0]


def test_an_already_committed_spool_does_not_change_the_file(campaign: Campaign) -> None:
    before = file_sha256(campaign.braking_path(1))
    write_spool(campaign.spool_path(1), 0.2)  # as if the removal of the spool had not reached the disk
    assert recover_twice(campaign).nothing_to_do
    assert file_sha256(campaign.braking_path(1)) == before and not list(campaign.spools.glob("*.spool"))

"""Every state in which a crash can leave a campaign is recovered: nothing acknowledged is lost.

Random kills miss most windows; here three brakings are recorded once, all calls on files are noted, and the
campaign is rebuilt as it is after each of them: process killed, write torn in the middle, power lost.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from crash_states import Log, after_kill, after_power_cut, clone_folders, record, restore, snapshot
from recorder_harness import BLOCK_NS, BLOCK_S, MiniRig, run_dir, signals, specification
from recording_samples import EPOCH, new_campaign, no_evaluation

from rigctl.core.errors import RecordingError
from rigctl.core.journal import Journal, verify_journal
from rigctl.recording import spool
from rigctl.recording.braking_file import read_braking, read_summary, verify
from rigctl.recording.campaign import Campaign, file_sha256
from rigctl.recording.commit import commit
from rigctl.recording.recovery import recover
from rigctl.recording.running import RunningBraking

SECONDS = 0.2


def seed(index: int, attempt: int) -> int:
    """Each attempt has its own samples."""
    return 10 * index + attempt


def record_braking(
    campaign: Campaign, rig: MiniRig, index: int, attempt: int, status: str, log: Log, journal: Journal
) -> None:
    """One braking through the classes of the recorder process, in one thread, noting what it promises."""
    t0_s = rig.k * BLOCK_S
    order = {
        "specification": specification(index),
        "t0_s": t0_s,
        "epoch": EPOCH,
        "evaluation": {},
        "metadata": {},
    }
    running = RunningBraking(campaign, rig.ring, order)
    log.ack("begun", (index, attempt))
    for n, block in enumerate(rig.blocks(signals(SECONDS, seed=seed(index, attempt)))):
        begin_s = block.k * BLOCK_NS * 1e-9
        names = [channel["name"] for channel in specification()["recording"]["channels"]]
        running.block(begin_s, begin_s + BLOCK_S, [block.ranges[name] for name in names], lambda: True)
        if n % 2 == 1 and running.flush_if_due():
            log.ack("spooled", (index, attempt, running.synced_s - t0_s))
    running.end(status, "")
    log.ack(f"ended {status}", (index, attempt, SECONDS))
    done = commit(campaign, running.path, no_evaluation, journal)
    log.ack("committed", (index, attempt, done.sha256))


@pytest.fixture(scope="module")
def history(tmp_path_factory: pytest.TempPathFactory) -> tuple[Log, dict[str, bytes]]:
    """A braking cut short, done again, and another one: the log of all calls, and the files at the start."""
    with pytest.MonkeyPatch.context() as patch, run_dir() as run:
        patch.setattr(spool, "SYNC_PERIOD_S", 0.0)  # flush whenever asked: more promises to keep
        campaign = new_campaign(tmp_path_factory.mktemp("crash"))
        journal = Journal(campaign.journal_path, "recorder")
        start = snapshot(campaign.folder)
        rig = MiniRig(run)
        with record(campaign.folder) as log:
            # the journal was opened before: its descriptor is not known to the log, so open it again
            journal.close()
            journal = Journal(campaign.journal_path, "recorder")
            for index, attempt, status in ((1, 1, "incomplete"), (1, 2, "complete"), (2, 1, "complete")):
                record_braking(campaign, rig, index, attempt, status, log, journal)
            journal.close()
        assert after_kill(log, start, len(log.calls)) == snapshot(campaign.folder)  # the log is whole
        return log, start


def attempt_path(campaign: Campaign, index: int, attempt: int) -> Path | None:
    """Where the file of one attempt is: in its place, or set aside for a later one."""
    places = (campaign.braking_path(index), campaign.superseded / f"{index:05d}-{attempt}.h5")
    return next((p for p in places if p.exists() and read_summary(p)["attempt"] == attempt), None)


def check(campaign: Campaign, log: Log, calls: int) -> None:
    """Recover, then compare with all that was promised before call number `calls`."""
    report = recover(campaign, no_evaluation, lock_timeout_s=1.0)
    promised = [(kind, value) for at, kind, value in log.acks if at <= calls]
    complete = campaign.completed_indices()
    for kind, (index, attempt, *value) in promised:
        path = attempt_path(campaign, index, attempt)
        assert path is not None
        braking = read_braking(path)
        if kind == "committed":
            assert file_sha256(path) == value[0]
        elif kind != "begun":
            samples = braking.channels["microphone"].samples
            truth = signals(SECONDS, seed=seed(index, attempt))["microphone"]
            assert len(samples) >= round(value[0] * 40000)
            np.testing.assert_array_equal(samples, truth[: len(samples)])
        if kind == "ended complete":
            assert braking.status == "complete" and index in complete
        elif kind == "ended incomplete":
            assert braking.status == "incomplete"
    assert (
        not report.damaged
        and not list(campaign.spools.glob("*.spool"))
        and not list(campaign.folder.rglob("*.part"))
    )
    for path in campaign.braking_files():
        verify(path)
    before = snapshot(campaign.folder)
    assert recover(campaign, no_evaluation, lock_timeout_s=1.0).nothing_to_do
    assert snapshot(campaign.folder) == before


def rebuilt(tmp_path: Path, log: Log) -> Campaign:
    clone_folders(log.root, tmp_path / "again")
    return Campaign(tmp_path / "again")


@pytest.mark.parametrize("torn", [0.0, 0.5])
def test_killed_after_any_call(history: tuple[Log, dict[str, bytes]], tmp_path: Path, torn: float) -> None:
    log, start = history
    campaign = rebuilt(tmp_path, log)
    places = [n for n, call in enumerate([*log.calls, ("end",)]) if not torn or call[0] == "write"]
    assert len(places) > 20
    for calls in places:
        restore(after_kill(log, start, calls, torn), campaign.folder)
        check(campaign, log, calls)
        torn_lines = [
            line for line in verify_journal(campaign.journal_path) if "not a whole record" not in line
        ]
        assert torn_lines == [] or torn


def test_power_lost_after_any_call(history: tuple[Log, dict[str, bytes]], tmp_path: Path) -> None:
    log, start = history
    campaign = rebuilt(tmp_path, log)
    for calls in range(len(log.calls) + 1):
        restore(after_power_cut(log, start, calls), campaign.folder)
        check(campaign, log, calls)


def test_without_the_flush_of_the_folder_the_check_would_fail(
    history: tuple[Log, dict[str, bytes]], tmp_path: Path
) -> None:
    """The test tests: leave out the flushes of the folders and acknowledged data is lost."""
    log, start = history
    folders = {("sync", "brakings"), ("sync", "spool")}
    careless = Log(log.root, [c if c[:2] not in folders else ("sync", "report") for c in log.calls], log.acks)
    campaign = rebuilt(tmp_path, log)
    restore(after_power_cut(careless, start, len(log.calls)), campaign.folder)
    with pytest.raises((AssertionError, RecordingError)):
        check(campaign, log, len(log.calls))

"""The recorder process from outside: ordinary work, stops, a dead controller, a full or failing disk."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from recorder_harness import (
    BLOCK_S,
    MiniRig,
    forked_recorder,
    run_dir,
    signals,
    specification,
    start_recorder,
)
from recording_samples import SPECS, new_campaign

from rigctl.core.errors import LinkClosed, RecordingError
from rigctl.core.journal import read_journal, verify_journal
from rigctl.recording.braking_file import read_braking, verify
from rigctl.recording.campaign import Campaign
from rigctl.recording.client import MERGED_NS, RecorderClient
from rigctl.recording.recovery import recover


@pytest.fixture
def run() -> Iterator[Path]:
    with run_dir() as path:
        yield path


@pytest.fixture
def campaign(tmp_path: Path) -> Campaign:
    return new_campaign(tmp_path)


def kinds(events: list[dict[str, object]], kind: str) -> list[dict[str, object]]:
    return [event for event in events if event["m"] == kind]


def test_brakings_of_a_run(run: Path, campaign: Campaign) -> None:
    recorder = start_recorder(run, campaign.folder)
    rig = MiniRig(run)
    client = RecorderClient.connect(
        run, 60.0, metadata={"rig": "mini"}, evaluation={"friction": {"p0_bar": 0.4}}
    )
    data = {}
    for index in (1, 2, 3):
        data[index] = rig.record(client, index, 3.0)
        for block in rig.blocks(signals(1.0)):  # between brakings nothing is recorded
            client.block(block)
    os.kill(recorder.pid, signal.SIGINT)  # Ctrl-C reaches the whole group and must not stop the recorder
    client.begin(specification(4), t0_s=rig.k * BLOCK_S)
    client.mark("pressure_onset", rig.k * BLOCK_S, temperature_degc=float("nan"))
    client.end("incomplete", "aborted by the operator")
    client.wait_idle(60.0)
    events = client.poll()
    client.close()
    assert recorder.wait(60) == 0
    committed = kinds(events, "committed")
    assert [event["index"] for event in committed] == [1, 2, 3, 4]
    assert [event["status"] for event in committed] == ["complete"] * 3 + ["incomplete"]
    assert [event["index"] for event in kinds(events, "begun")] == [1, 2, 3, 4]
    assert {event["index"] for event in kinds(events, "spooled")} == {1, 2, 3, 4}
    assert campaign.completed_indices() == {1, 2, 3} and not list(campaign.spools.iterdir())
    assert verify_journal(campaign.journal_path) == []
    for index, samples in data.items():
        braking = read_braking(campaign.braking_path(index))
        np.testing.assert_array_equal(braking.channels["microphone"].samples, samples["microphone"])
        assert braking.results["squeal_frequency_hz"] == pytest.approx(2350.0, abs=1.0)
        assert (
            braking.results["squeal_frequency_hz"] == committed[index - 1]["summary"]["squeal_frequency_hz"]
        )
        assert braking.metadata == {"rig": "mini"} and braking.settings["friction"]["p0_bar"] == 0.4
        assert braking.summary["t0_s"] == pytest.approx((index - 1) * 4.0)
    aborted = read_braking(campaign.braking_path(4))
    assert aborted.summary["note"] == "aborted by the operator"
    assert aborted.marks[0].values == {"temperature_degc": None}


@pytest.mark.parametrize("how", ["controller leaves", "controller dies", "SIGTERM"])
def test_a_cut_off_braking_becomes_incomplete(run: Path, campaign: Campaign, how: str) -> None:
    recorder = forked_recorder(run, campaign.folder)
    rig = MiniRig(run)
    data = signals(2.0)
    controller = os.fork() if how == "controller dies" else 0
    if not controller:
        client = RecorderClient.connect(run, 60.0)
        client.begin(specification(1), t0_s=0.0)
        for block in rig.blocks(data):
            client.block(block)
        if how == "controller dies":
            os._exit(0)  # at once: nothing is closed, what is held back is lost
        if how == "SIGTERM":
            time.sleep(0.3)
            os.kill(recorder.pid, signal.SIGTERM)
            recorder.join(30)
        client.close()
    else:
        os.waitpid(controller, 0)
    recorder.join(30)
    braking = read_braking(campaign.braking_path(1))
    assert braking.status == "incomplete"
    assert (
        braking.summary["note"]
        == {
            "SIGTERM": "the recorder was stopped",
            "controller leaves": "the controller has gone",
            "controller dies": "the controller has gone",
        }[how]
    )
    samples = braking.channels["microphone"].samples
    lost = len(data["microphone"]) - len(samples)
    assert lost == 0 if how == "controller leaves" else 0 <= lost <= 40000 * (MERGED_NS * 1e-9 + BLOCK_S)
    np.testing.assert_array_equal(samples, data["microphone"][: len(samples)])
    assert campaign.completed_indices() == frozenset() and recover(campaign).nothing_to_do


def test_refusals_leave_the_recorder_at_work(run: Path, campaign: Campaign) -> None:
    recorder = forked_recorder(run, campaign.folder)
    rig = MiniRig(run)
    client = RecorderClient.connect(run, 60.0)
    rig.record(client, 1, 0.5)
    client.wait_idle(30.0)
    rig.record(client, 1, 0.5)  # complete already
    client.begin(specification(2, channels=[{"name": "force"}]), t0_s=rig.k * BLOCK_S)
    for block in rig.blocks(signals(20.0)):  # longer than the window: must not wait for ever
        client.block(block)
    client.end()
    rig.record(client, 3, 0.5)
    client.wait_idle(30.0)
    events = client.poll()
    client.close()
    recorder.join(30)
    assert [event["index"] for event in kinds(events, "committed")] == [1, 3]
    failed = kinds(events, "failed")
    assert [event["index"] for event in failed] == [1, 2]
    assert "complete already" in str(failed[0]["error"]) and "no channel 'force'" in str(failed[1]["error"])
    assert [r.kind for r in read_journal(campaign.journal_path)].count("RECORDING_FAILED") == 2


def test_the_client_does_not_let_the_ring_be_overrun(run: Path, campaign: Campaign) -> None:
    """The recorder is stopped for a while: the controller waits in the end, no sample is lost."""
    recorder = forked_recorder(run, campaign.folder)
    rig = MiniRig(run)
    client = RecorderClient.connect(run, 60.0)
    data = signals(14.0)
    client.begin(specification(1), t0_s=0.0)
    os.kill(recorder.pid, signal.SIGSTOP)
    started = time.monotonic()
    waker = subprocess.Popen(["/bin/sh", "-c", f"sleep 0.5; kill -CONT {recorder.pid}"])
    waited_at = None
    for block in rig.blocks(data):
        client.block(block)
        if waited_at is None and time.monotonic() - started > 0.45:
            waited_at = block.end_s
    client.end()
    client.wait_idle(30.0)
    client.close()
    recorder.join(30)
    waker.wait()
    assert waited_at is not None and waited_at <= 9.0
    braking = read_braking(campaign.braking_path(1))
    assert braking.status == "complete"
    np.testing.assert_array_equal(braking.channels["microphone"].samples, data["microphone"])


def test_samples_overwritten_in_the_ring_are_a_stated_gap(run: Path, campaign: Campaign) -> None:
    recorder = forked_recorder(run, campaign.folder)
    rig = MiniRig(run, seconds=1.0)  # a ring far smaller than the window
    client = RecorderClient.connect(run, 60.0)
    client.begin(specification(1), t0_s=0.0)
    data = signals(2.0)
    blocks = list(rig.blocks(data))
    for block in blocks:
        client.block(block)
    client.end()
    client.wait_idle(30.0)
    events = client.poll()
    client.close()
    recorder.join(30)
    assert len(kinds(events, "gap")) == 1
    assert [event["status"] for event in kinds(events, "committed")] == ["recovered"]
    assert campaign.completed_indices() == frozenset()
    braking = read_braking(campaign.braking_path(1))  # what is left is where it belongs in time
    microphone = braking.channels["microphone"].samples
    np.testing.assert_array_equal(microphone[-40000:], data["microphone"][-40000:])
    assert len(microphone) == len(data["microphone"])


def test_a_dead_recorder_is_noticed(run: Path, campaign: Campaign) -> None:
    recorder = forked_recorder(run, campaign.folder)
    rig = MiniRig(run)
    client = RecorderClient.connect(run, 60.0)
    client.begin(specification(1), t0_s=0.0)
    recorder.kill()
    recorder.join(10)
    with pytest.raises(LinkClosed):
        for block in rig.blocks(signals(2.0)):
            client.block(block)
            client.poll()
    client.close()


def test_two_recorders_cannot_share_a_campaign(run: Path, campaign: Campaign) -> None:
    with campaign.lock("spool"), pytest.raises(RecordingError, match="another process"):
        recover(campaign, lock_timeout_s=0.1)


@pytest.fixture
def tiny_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of 4 MB."""
    mounted = tmp_path / "disk"
    mounted.mkdir()
    done = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=4m", "tmpfs", str(mounted)], capture_output=True, check=False
    )
    if done.returncode:
        pytest.skip(f"no tmpfs can be mounted here: {done.stderr.decode(errors='replace').strip()}")
    yield mounted
    subprocess.run(["umount", str(mounted)], check=True)


def test_a_full_disk_costs_nothing_that_was_acknowledged(run: Path, tiny_disk: Path) -> None:
    campaign = new_campaign(tiny_disk)
    recorder = forked_recorder(run, campaign.folder)
    rig = MiniRig(run)
    client = RecorderClient.connect(run, 60.0)
    rig.record(client, 1, 1.0)
    client.wait_idle(30.0)
    ballast = tiny_disk / "ballast"
    ballast.write_bytes(b"x" * 2_500_000)
    data = signals(12.0, seed=2)
    client.begin(specification(2), t0_s=rig.k * BLOCK_S)
    t0_s = rig.k * BLOCK_S
    for block in rig.blocks(data):
        client.block(block)
        time.sleep(0.005)
    client.end()
    client.wait_idle(30.0)
    events = client.poll()
    client.close()
    recorder.join(30)
    failed = kinds(events, "failed")
    assert [event["index"] for event in failed] == [2]
    assert "No space left" in str(failed[0]["error"]) and "Free some space" in str(failed[0]["error"])
    acknowledged_s = max(float(str(e["t"])) for e in kinds(events, "spooled") if e["index"] == 2) - t0_s
    assert acknowledged_s > 0.1
    verify(campaign.braking_path(1))
    ballast.unlink()
    report = recover(campaign)
    assert [(r.index, r.status) for r in report.recovered] == [(2, "recovered")]
    samples = read_braking(campaign.braking_path(2)).channels["microphone"].samples
    assert len(samples) >= round(acknowledged_s * 40000)
    np.testing.assert_array_equal(samples, data["microphone"][: len(samples)])
    assert campaign.completed_indices() == {1}


def test_little_space_refuses_a_braking_before_it_begins(run: Path, tiny_disk: Path) -> None:
    campaign = new_campaign(tiny_disk)
    recorder = forked_recorder(run, campaign.folder, min_free_mb=50.0)
    MiniRig(run)
    client = RecorderClient.connect(run, 60.0)
    client.begin(specification(1), t0_s=0.0)
    client.wait_idle(30.0)
    events = client.poll()
    client.close()
    recorder.join(30)
    assert recorder.exitcode == 1
    assert "MB are needed" in str(kinds(events, "failed")[0]["error"])
    assert len(SPECS) == 5 and not list(campaign.spools.iterdir())

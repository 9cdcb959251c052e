"""SIGKILL of the recorder process at random moments, many quick runs: what it had said is on the disk."""

from __future__ import annotations

import contextlib
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from recorder_harness import MiniRig, forked_recorder, run_dir, signals
from recording_samples import new_campaign

from rigctl.core.errors import LinkClosed
from rigctl.recording.braking_file import read_braking
from rigctl.recording.campaign import Campaign, file_sha256
from rigctl.recording.client import RecorderClient
from rigctl.recording.recovery import recover

RUNS, BRAKINGS, SECONDS = 6, 6, 0.5


def run_until_killed(campaign: Campaign, run: Path, messages: int, delay_s: float) -> list[dict[str, Any]]:
    """Record until the recorder has said `messages` things (three per braking), kill it `delay_s` later."""
    recorder = forked_recorder(run, campaign.folder)
    rig = MiniRig(run)
    client = RecorderClient.connect(run, 60.0)
    said: list[dict[str, Any]] = []
    for index in range(1, BRAKINGS + 1):
        if len(said) < messages:
            rig.record(client, index, SECONDS)
            said += client.poll()
    while len(said) < messages:
        time.sleep(0.002)
        said += client.poll()
    time.sleep(delay_s)
    recorder.kill()
    recorder.join(10)
    with contextlib.suppress(LinkClosed):  # there may be last words
        said += client.poll()
    with pytest.raises(LinkClosed):
        client.poll()
    client.close()
    return said


def test_killed_at_random(tmp_path: Path) -> None:
    rng = np.random.default_rng(20)
    committed = 0
    for number in range(RUNS):
        campaign = new_campaign(tmp_path, f"run{number}")
        with run_dir() as run:
            said = run_until_killed(
                campaign, run, int(rng.integers(1, 3 * BRAKINGS - 1)), rng.uniform(0.0, 0.05)
            )
        report = recover(campaign)
        assert not report.damaged
        complete = campaign.completed_indices()
        for message in said:
            if message["m"] == "committed":
                committed += 1
                assert file_sha256(campaign.braking_path(message["index"])) == message["sha256"]
            if message["m"] in ("committed", "spooled"):
                samples = read_braking(campaign.braking_path(message["index"])).channels["microphone"].samples
                truth = signals(SECONDS, seed=message["index"])["microphone"]
                np.testing.assert_array_equal(samples, truth[: len(samples)])
                if message["m"] == "committed" or message["t"] >= message["index"] * SECONDS - 1e-9:
                    assert message["index"] in complete and len(samples) == len(truth)
        assert recover(campaign).nothing_to_do
    assert committed > 0

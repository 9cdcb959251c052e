"""The campaign folder: safe names, nothing overwritten, one run at a time, TOML that says the same."""

from __future__ import annotations

import multiprocessing
import tomllib
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from recording_samples import new_campaign, no_evaluation, write_spool

from rigctl.core.errors import ConfigError, RecordingError
from rigctl.core.journal import Journal
from rigctl.recording.campaign import Campaign, create_campaign, open_campaign, require_free_space, to_toml
from rigctl.recording.commit import commit

PLAIN = st.recursive(
    st.booleans()
    | st.integers(-(2**63), 2**63 - 1)
    | st.floats(allow_nan=False)
    | st.text(st.characters(codec="utf-8"), max_size=20),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=20,
)


@settings(max_examples=60, deadline=None)
@given(mapping=st.dictionaries(st.text(max_size=8), PLAIN, max_size=5))
def test_toml_gives_back_what_was_written(mapping: dict[str, object]) -> None:
    assert tomllib.loads(to_toml(mapping)) == mapping


def test_toml_leaves_out_none_and_refuses_what_it_cannot_say() -> None:
    assert tomllib.loads(to_toml({"a": {"b": None, "c": 1}, "d": (1, 2)})) == {"a": {"c": 1}, "d": [1, 2]}
    with pytest.raises(ConfigError, match=r"a\.b"):
        to_toml({"a": {"b": [1, None]}})
    with pytest.raises(ConfigError):
        to_toml({"a": object()})


def test_layout_and_reading_back(tmp_path: Path) -> None:
    campaign = new_campaign(tmp_path / "data")
    assert sorted(path.name for path in campaign.folder.iterdir()) == [
        "brakings",
        "campaign.toml",
        "report",
        "spool",
    ]
    assert open_campaign(campaign.folder).resolved() == {"program": {"name": "test"}, "seed": 1}
    assert campaign.braking_path(7).name == "00007.h5"


def test_an_existing_folder_is_never_touched(tmp_path: Path) -> None:
    (tmp_path / "c").mkdir()
    (tmp_path / "c" / "precious").write_text("data")
    with pytest.raises(ConfigError, match="exists already"):
        create_campaign(tmp_path / "c", {})
    assert [path.name for path in (tmp_path / "c").iterdir()] == ["precious"]


@pytest.mark.parametrize("name", ["..", ".hidden", "a b", "a;b", "trailing.", "x" * 101, "ä", "-rf", "a\nb"])
def test_names_that_are_tricks_are_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(ConfigError, match="name of a campaign"):
        create_campaign(tmp_path / name, {})


def test_no_campaign_here(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"no campaign\.toml"):
        open_campaign(tmp_path)


def hold(
    folder: Path, held: multiprocessing.synchronize.Event, release: multiprocessing.synchronize.Event
) -> None:
    with Campaign(folder).lock("run"):
        held.set()
        release.wait(20)


def test_two_runs_cannot_share_a_campaign(tmp_path: Path) -> None:
    campaign = new_campaign(tmp_path)
    context = multiprocessing.get_context("spawn")
    held, release = context.Event(), context.Event()
    other = context.Process(target=hold, args=(campaign.folder, held, release))
    other.start()
    try:
        assert held.wait(20)
        with pytest.raises(RecordingError, match=f"pid {other.pid}"), campaign.lock("run"):
            pass
        with campaign.lock("spool"):  # another purpose is free
            pass
    finally:
        release.set()
        other.join()
    with campaign.lock("run"):
        pass


def test_too_little_space_is_said_before_the_start(tmp_path: Path) -> None:
    require_free_space(tmp_path / "not" / "there", 1000)
    with pytest.raises(RecordingError, match="MB are needed"):
        require_free_space(tmp_path, 1e18)


def test_completed_means_committed_whole_and_unchanged(tmp_path: Path) -> None:
    campaign = new_campaign(tmp_path)
    journal = Journal(campaign.journal_path, "test")
    for index, status in ((1, "complete"), (2, "incomplete"), (3, "complete"), (4, "complete")):
        write_spool(campaign.spool_path(index), 0.2, index=index, status=status)
        commit(campaign, campaign.spool_path(index), no_evaluation, journal)
    journal.close()
    assert campaign.completed_indices() == {1, 3, 4}
    assert [path.name for path in campaign.braking_files()] == [f"0000{n}.h5" for n in (1, 2, 3, 4)]
    campaign.braking_path(3).unlink()
    changed = bytearray(campaign.braking_path(4).read_bytes())
    changed[-1] ^= 1
    campaign.braking_path(4).write_bytes(changed)
    assert campaign.completed_indices() == {1}


def test_an_incomplete_attempt_is_kept_when_the_braking_is_done_again(tmp_path: Path) -> None:
    campaign = new_campaign(tmp_path)
    journal = Journal(campaign.journal_path, "test")
    write_spool(campaign.spool_path(1), 0.2, status="incomplete")
    first = commit(campaign, campaign.spool_path(1), no_evaluation, journal)
    assert campaign.next_attempt(1) == 2
    write_again(campaign, attempt=2)
    second = commit(campaign, campaign.spool_path(1), no_evaluation, journal)
    journal.close()
    assert (first.status, second.status) == ("incomplete", "complete")
    assert [path.name for path in campaign.superseded.iterdir()] == ["00001-1.h5"]
    assert campaign.completed_indices() == {1} and campaign.next_attempt(1) == 3


def write_again(campaign: Campaign, attempt: int) -> None:
    from recording_samples import SPECS, header, signals, specification

    from rigctl.recording.spool import SpoolWriter

    data = signals(0.2)
    writer = SpoolWriter.create(campaign.spool_path(1), SPECS, header(specification(), attempt=attempt))
    writer.append([(n, 0, data[spec.name]) for n, spec in enumerate(SPECS)], 100.2)
    writer.end("complete", "")
    writer.close()

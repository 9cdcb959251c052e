"""Excluded brakings in table, statistics, report and command; the catalogue."""

import os

import pytest
from campaign_files import Case
from typer.testing import CliRunner

from rigctl.analysis.campaign_table import BrakingRow, read_campaign, rows_of, write_csv
from rigctl.analysis.report import build_report
from rigctl.analysis.summary import in_words, summarise
from rigctl.app.cli import app
from rigctl.recording.annotations import Action, annotate, annotate_many
from rigctl.recording.campaign import open_campaign
from rigctl.recording.catalogue import FILE_NAME, Catalogue
from rigctl.recording.recovery import recover
from rigctl.recording.trash import restore_braking, trash_braking

LOUD = (2350.0, 92.0, 1.0, 2.3)


@pytest.fixture
def three(campaign):
    return campaign(Case(0, 6.0), Case(0, 20.0, tones=(LOUD,)), Case(0, 26.0, tones=(LOUD,)))


def test_an_excluded_braking_counts_nowhere_but_is_listed_with_its_reason(three):
    annotate(three, 2, Action.EXCLUDE, "door slammed", who="anna")
    table = read_campaign(three)
    assert [b.index for b in table.complete()] == [1, 3]
    assert [b.index for b in table.squealing()] == [3]
    assert {e.braking for e in table.squeals()} == {3}
    assert [(b.index, b.excluded) for b in table.excluded()] == [(2, "door slammed")]
    summary = summarise(table, None)
    assert (summary.n_complete, summary.n_excluded, summary.onset_bar) == (2, 1, 26.0)
    assert "1 is excluded by a person" in in_words(summary)[0]
    page = build_report(three).path.read_text(encoding="utf-8")
    assert "Excluded brakings" in page and "door slammed" in page and "anna, 2" in page


def test_tags_rating_and_remark_are_columns_of_the_csv(three, tmp_path):
    annotate_many(three, [(1, Action.TAG, "x"), (1, Action.TAG, "y"), (1, Action.RATE, 4)])
    write_csv(tmp_path / "b.csv", read_campaign(three).brakings, BrakingRow)
    line = (tmp_path / "b.csv").read_text(encoding="utf-8").splitlines()[1]
    assert '"x, y",4' in line


def test_the_command_writes_events_and_says_the_state(three):
    (three / "campaign.toml").write_text("")
    run = CliRunner().invoke
    done = run(app, ["annotate", str(three), "2", "--exclude", "hammering", "--tag", "a", "--rating", "3"])
    assert done.exit_code == 0, done.output
    assert "excluded: hammering" in done.output and "noise rating: 3" in done.output
    assert run(app, ["annotate", str(three), "2", "--restore", "--trash"]).exit_code == 0
    assert (three / "trash" / "00002.h5").exists()
    assert [b.index for b in read_campaign(three).brakings] == [1, 3]
    assert "in the trash" in run(app, ["annotate", str(three), "2"]).output
    assert run(app, ["annotate", str(three), "2", "--put-back"]).exit_code == 0
    assert [b.index for b in read_campaign(three).complete()] == [1, 2, 3]
    assert run(app, ["annotate", str(three), "9", "--tag", "a"]).exit_code != 0


def test_the_catalogue_gives_what_the_files_say_and_notices_changes(three):
    with Catalogue(three) as catalogue:
        assert len(catalogue.read().stale) == 3
        catalogue.update(catalogue.read().stale)
    with Catalogue(three) as catalogue:
        found = catalogue.read()
        assert found.stale == [] and found.unreadable == {}
        rows = [rows_of(summary, name.partition("/")[2])[0] for name, summary in found.summaries.items()]
        assert tuple(rows) == read_campaign(three).brakings
        damaged = three / "brakings" / "00002.h5"
        damaged.write_bytes(b"no HDF5")
        assert catalogue.read().stale == ["brakings/00002.h5"]
        assert "brakings/00002.h5" in catalogue.update(["brakings/00002.h5", "brakings/00099.h5"]).unreadable
        assert list(catalogue.read().unreadable) == ["brakings/00002.h5"]
        damaged.unlink()
        assert len(catalogue.read().summaries) == 2 and not catalogue.read().unreadable


def test_a_damaged_catalogue_is_made_anew(three):
    (three / FILE_NAME).write_bytes(b"this is no data base" * 100)
    with Catalogue(three) as catalogue:
        assert len(catalogue.update(catalogue.read().stale).summaries) == 3
    with Catalogue(three) as catalogue:
        assert len(catalogue.read().summaries) == 3


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_without_the_right_to_write_the_catalogue_is_in_memory(three):
    three.chmod(0o555)
    with Catalogue(three) as catalogue:
        assert len(catalogue.update(catalogue.read().stale).summaries) == 3
    three.chmod(0o755)


def test_resume_says_that_a_braking_is_in_the_trash(three):
    (three / "campaign.toml").write_text("")
    opened = open_campaign(three)
    assert len(recover(opened).journaled) == 3
    trash_braking(three, 2)
    assert [words for _, words in recover(opened).damaged] == ["braking 2 is in the trash."]
    restore_braking(three, "00002.h5")
    assert recover(opened).nothing_to_do

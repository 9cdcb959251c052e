"""The campaign table and the statistics made from it, on files in the real format."""

import csv

import numpy as np
import pytest
from campaign_files import Case

from rigctl.analysis import occurrence
from rigctl.analysis.campaign_table import EventRow, read_campaign, write_csv
from rigctl.analysis.friction_map import friction_map
from rigctl.analysis.prediction import Prediction
from rigctl.analysis.summary import in_words, summarise
from rigctl.core.errors import RecordingError

TONE = (2350.0, 80.0, 1.0, 2.3)


@pytest.fixture(scope="module")
def table(matrix_campaign):
    return read_campaign(matrix_campaign)


def test_every_braking_is_a_row_with_its_numbers(table):
    assert [b.index for b in table.brakings] == list(range(1, 10))
    row = table.brakings[4]
    assert (row.set_pressure_bar, row.set_temperature_degc, row.role) == (20.0, 50.0, "matrix")
    assert row.pressure_mean_bar == pytest.approx(20.0, abs=0.2)
    assert row.speed_mean_rpm == pytest.approx(40.0)
    assert row.mean_mu == pytest.approx(0.5, abs=0.002)
    assert row.squeal_frequency_hz == pytest.approx(2360, abs=1)
    assert row.squeal_level_db == pytest.approx(92, abs=0.2)
    assert row.squeal_level_dba == pytest.approx(93.27, abs=0.2)
    assert row.background_db == pytest.approx(50, abs=0.5)


def test_only_complete_brakings_with_sound_are_the_base(table):
    assert len(table.complete()) == 8
    assert [b.note for b in table.incomplete()] == ["watchdog: door open"]
    assert [b.index for b in table.with_sound()] == [3, 4, 5, 6, 7, 8]
    assert [b.index for b in table.squealing()] == [5, 7, 8]
    # the event of the incomplete braking is in the table, and not in the statistics
    assert {e.braking for e in table.events} == {5, 7, 8, 9}
    assert {e.braking for e in table.squeals()} == {5, 7, 8}


def test_harmonics_are_listed_and_not_counted(table):
    assert sum(e.harmonic for e in table.events) == 2
    assert table.brakings[4].squeals == 1
    assert all(e.frequency_hz < 3000 for e in table.squeals())


def test_occurrence_per_pressure_and_onset(table):
    rows = occurrence.by_pressure(table)
    assert [(r.pressure_bar, r.brakings, r.squealing) for r in rows] == [(6, 2, 0), (12, 2, 1), (20, 2, 2)]
    assert [r.share for r in rows] == [0.0, 0.5, 1.0]
    assert occurrence.onset_bar(table) == 12.0


def test_occurrence_map_over_pressure_and_temperature(table):
    cells = occurrence.occurrence_map(table)
    assert cells.pressures_bar.tolist() == [6, 12, 20]
    assert cells.temperatures_degc.tolist() == [50, 150]
    assert cells.brakings.tolist() == [[1, 1, 1], [1, 1, 1]]
    assert cells.squealing.tolist() == [[0, 0, 1], [0, 1, 1]]
    assert cells.level_max_db[1] == pytest.approx([np.nan, 66, 92], abs=0.3, nan_ok=True)


def test_occurrence_per_threshold_falls_and_counts_each_braking_once(table):
    rows = occurrence.occurrence_per_threshold(table)
    by_level = {level: share for level, share, _ in rows}
    assert by_level[60] == by_level[65] == 0.5
    assert by_level[70] == by_level[90] == pytest.approx(1 / 3)
    assert by_level[95] == 0.0
    shares = [share for _, share, _ in rows]
    assert shares == sorted(shares, reverse=True)


def test_events_per_band(table):
    assert [(events, brakings) for _, _, events, brakings in occurrence.events_per_band(table)] == [
        (3, 3),
        (0, 0),
        (0, 0),
        (0, 0),
    ]


def test_spread():
    s = occurrence.spread([3.0, None, 1.0, 2.0])
    assert (s.count, s.median, s.minimum, s.maximum) == (3, 2.0, 1.0, 3.0)
    assert occurrence.spread([None]) is None


def test_friction_map_leaves_bedding_out(table):
    cells = friction_map(table)
    assert cells.pressures_bar.tolist() == [6, 12, 20]
    assert cells.mu[0] == pytest.approx([0.36, 0.42, 0.5], abs=0.005)


def test_friction_map_of_a_bedding_alone_shows_the_bedding(campaign):
    cells = friction_map(read_campaign(campaign(Case(0, 10.0, 100.0, role="bedding", sound=False))))
    assert cells.mu.shape == (1, 1)


def test_without_set_temperature_the_initial_one_is_classed(campaign):
    table = read_campaign(campaign(Case(0, 10.0, None)))
    assert occurrence.temperature_class_degc(table.brakings[0]) == 80.0


def test_repeated_set_points_are_averaged_and_counted(campaign):
    table = read_campaign(campaign(Case(0, 20.0, mu=0.4, tones=(TONE,)), Case(0, 20.0, mu=0.5)))
    assert friction_map(table).mu[0, 0] == pytest.approx(0.45, abs=0.003)
    cells = occurrence.occurrence_map(table)
    assert (cells.brakings[0, 0], cells.squealing[0, 0]) == (2, 1)


def test_summary_numbers_and_words(table):
    summary = summarise(table, Prediction(15.0, 2140.0, "model"))
    assert (summary.n_brakings, summary.n_complete, summary.n_incomplete) == (9, 8, 1)
    assert (summary.n_with_sound, summary.n_squealing, summary.n_events) == (6, 3, 3)
    assert (summary.onset_bar, summary.onset_below_bar) == (12.0, 6.0)
    assert summary.frequency_median_hz == pytest.approx(2360, abs=1)
    text = " ".join(in_words(summary))
    assert "8 of 9 recorded brakings are complete; 1 incomplete is listed" in text
    assert "3 brakings squealed (50%), with 3 events" in text
    assert "sets in at 12 bar" in text
    assert "3.0 bar below the prediction" in text
    assert "10.3% above it" in text


def test_words_without_squeal_without_sound_and_without_anything(campaign, tmp_path):
    silent = summarise(read_campaign(campaign(Case(0))), Prediction(15.0, 2140.0))
    assert any("No squeal was found (1 braking with sound)" in s for s in in_words(silent))
    assert any("no measured squeal to compare" in s for s in in_words(silent))
    (tmp_path / "empty" / "brakings").mkdir(parents=True)
    nothing = summarise(read_campaign(tmp_path / "empty"), None)
    assert in_words(nothing) == ("No braking has been recorded.",)


def test_clipping_is_said(campaign):
    table = read_campaign(campaign(Case(0, tones=((2350.0, 142.0, 1.0, 2.3),))))
    assert any(s.startswith("Caution: in 1 braking the") for s in in_words(summarise(table, None)))


def test_damaged_files_are_named_and_do_not_stop_the_rest(campaign):
    folder = campaign(Case(0), Case(0))
    (folder / "brakings" / "00007.h5").write_bytes(b"no hdf5 file")
    table = read_campaign(folder)
    assert len(table.brakings) == 2
    assert [name for name, _ in table.unreadable] == ["00007.h5"]
    assert any("1 braking file cannot" in s for s in in_words(summarise(table, None)))


def test_a_folder_that_is_no_campaign_is_refused(tmp_path):
    with pytest.raises(RecordingError, match="not a campaign"):
        read_campaign(tmp_path)


def test_csv_has_one_line_per_event_and_empty_cells_where_undefined(table, tmp_path):
    write_csv(tmp_path / "events.csv", table.events, EventRow)
    with (tmp_path / "events.csv").open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert len(rows) == len(table.events)
    assert float(rows[0]["frequency_hz"]) == pytest.approx(table.events[0].frequency_hz, rel=1e-5)
    assert {row["harmonic"] for row in rows} == {"0", "1"}
    assert "None" not in (tmp_path / "events.csv").read_text(encoding="utf-8")


@pytest.mark.parametrize(("onset", "frequency"), [(float("nan"), 2140.0), (-1.0, 2140.0), (15.0, 0.0)])
def test_impossible_predictions_are_refused(onset, frequency):
    with pytest.raises(ValueError, match="Pass no prediction"):
        Prediction(onset, frequency)

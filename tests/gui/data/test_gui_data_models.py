"""View-models of the data page, without a screen."""

import dataclasses
import math

import numpy as np
import pytest
from PySide6.QtCore import QModelIndex, Qt

from rigctl.analysis.campaign_table import BrakingRow
from rigctl.gui.pages.data.campaigns import find_campaigns
from rigctl.gui.pages.data.columns import BY_KEY, COLUMNS
from rigctl.gui.pages.data.entry import Entry, entries_of, table_of
from rigctl.gui.pages.data.figure_data import FIGURES, Cells, figure_data
from rigctl.gui.pages.data.listing import COUNTED, BrakingFilter, BrakingList
from rigctl.gui.pages.data.marks import marks_of
from rigctl.gui.pages.data.results import metadata_lines, name_text, result_lines
from rigctl.gui.pages.data.table_model import BrakingTableModel
from rigctl.recording.annotations import Action, annotate, read_annotations
from rigctl.recording.catalogue import Catalogue

NOTHING = dict.fromkeys(BrakingRow.__dataclass_fields__)


def entry(index, *, trashed=False, **values) -> Entry:
    """A synthetic row."""
    fields = {
        "index": index, "file": f"{index:05d}.h5", "sequence": "s", "role": "matrix", "status": "complete",
        "note": "", "start_time": "", "squeals": 0, "sound_recorded": True, "evaluation_error": "",
        "excluded": "", "excluded_by": "", "tags": (), "remark": "", "set_pressure_bar": float(index % 30),
        "set_temperature_degc": 50.0, **values,
    }  # fmt: skip
    folder = "trash" if trashed else "brakings"
    return Entry(f"{folder}/{index:05d}.h5", BrakingRow(**{**NOTHING, **fields}))


@pytest.fixture
def entries(campaign):
    with Catalogue(campaign) as catalogue:
        return entries_of(catalogue.update(catalogue.read().stale), read_annotations(campaign))


def shown(listing: BrakingList) -> list[int]:
    return [e.index for e in listing.visible]


@pytest.mark.parametrize(
    ("wanted", "indices"),
    [
        (BrakingFilter(), [1, 2, 3, 4]),
        (BrakingFilter(pressure_bar=(2, None)), [2, 3, 4]),
        (BrakingFilter(pressure_bar=(2, 3)), [2, 3]),
        (BrakingFilter(temperature_degc=(None, 40)), [4]),
        (BrakingFilter(squeal=True), [2]),
        (BrakingFilter(squeal=False), [1, 4]),
        (BrakingFilter(state=COUNTED), [1, 2, 3]),
        (BrakingFilter(state="excluded"), [4]),
        (BrakingFilter(state="trashed"), [5]),
        (BrakingFilter(tag="cold"), [3]),
        (BrakingFilter(text="DOOR slam"), [4]),
    ],
)
def test_filters(wanted, indices):
    listing = BrakingList()
    listing.filter = wanted
    listing.replace_all(
        [
            entry(1),
            entry(2, squeals=1, squeal_level_db=80.0),
            entry(3, sound_recorded=False, tags=("cold",)),
            entry(4, excluded="door slammed", set_temperature_degc=None, temperature_initial_degc=30.0),
            entry(5, trashed=True),
        ]
    )
    assert shown(listing) == indices
    assert all(wanted.accepts(e) == (e.index in indices) for e in listing.all())


def test_sorting_puts_missing_values_last_whichever_way_round():
    listing = BrakingList()
    listing.replace_all([entry(1, mean_mu=0.3), entry(2), entry(3, mean_mu=0.5), entry(4, mean_mu=math.nan)])
    listing.sort_by = "mu"
    listing.arrange()
    assert shown(listing) == [1, 3, 2, 4]
    listing.descending = True
    listing.arrange()
    assert shown(listing) == [3, 1, 2, 4]


def test_cells_have_fixed_decimals_and_a_dash_for_nothing():
    row = entry(7, mean_mu=0.41234, squeal_level_db=None)
    texts = {key: BY_KEY[key].text(row) for key in ("index", "mu", "level", "set_pressure", "tags")}
    assert texts == {"index": "7", "mu": "0.412", "level": "—", "set_pressure": "7.0", "tags": ""}
    assert len({column.key for column in COLUMNS}) == len(COLUMNS)


def test_the_model_tells_the_least(qtbot, theme, qtmodeltester):
    model = BrakingTableModel(theme)
    news = []
    for name in ("modelReset", "rowsInserted", "dataChanged"):
        getattr(model, name).connect(lambda *_, n=name: news.append(n))
    model.replace_all([entry(1), entry(2)])
    model.put([entry(3)])
    model.put([entry(2, mean_mu=0.4)])
    model.put([entry(2, mean_mu=0.4)], gone=["brakings/00001.h5"])
    assert news == ["modelReset", "rowsInserted", "dataChanged", "modelReset"]
    qtmodeltester.check(model)


def test_an_excluded_braking_is_struck_through_with_its_reason(theme):
    model = BrakingTableModel(theme)
    model.replace_all([entry(1), entry(2, excluded="door", excluded_by="anna, today")])
    index = model.index(1, 0, QModelIndex())
    assert model.data(index, Qt.ItemDataRole.FontRole).strikeOut()
    assert "door (anna, today)" in model.data(index, Qt.ItemDataRole.ToolTipRole)
    assert model.data(model.index(0, 0, QModelIndex()), Qt.ItemDataRole.FontRole) is None


def test_ten_thousand_rows_are_filtered_and_sorted_at_once(theme):
    rng = np.random.default_rng(1)
    model = BrakingTableModel(theme)
    many = [entry(n, mean_mu=float(rng.random())) for n in range(1, 10_001)]
    model.replace_all(many)
    model.sort([c.key for c in COLUMNS].index("mu"), Qt.SortOrder.DescendingOrder)
    values = [e.row.mean_mu for e in model.list.visible]
    assert values == sorted(values, reverse=True)
    model.set_filter(BrakingFilter(pressure_bar=(28, None)))
    assert model.rowCount() == 666


def test_entries_from_files_with_words_and_unreadable_ones(campaign):
    annotate(campaign, 2, Action.EXCLUDE, "why")
    (campaign / "brakings" / "00003.h5").write_bytes(b"no HDF5")
    with Catalogue(campaign) as catalogue:
        found = catalogue.update(catalogue.read().stale)
    entries = {e.index: e for e in entries_of(found, read_annotations(campaign))}
    assert (entries[2].state, entries[2].counts) == ("excluded", False)
    assert entries[3].state == "unreadable" and "not a readable" in entries[3].row.note
    table = table_of(entries.values())
    assert [b.index for b in table.complete()] == [1, 4, 6]
    assert [name for name, _ in table.unreadable] == ["00003.h5"]


def test_every_figure_knows_its_brakings(entries):
    for key in FIGURES:
        picture = figure_data(key, entries).picture
        names = [n for c in picture.cells for n in c.names] if isinstance(picture, Cells) else picture.names
        assert names and set(names) <= {e.name for e in entries}, key
    occurrence = figure_data("occurrence", entries).picture
    loud = occurrence.at(occurrence.pressures_bar.index(20.0), occurrence.temperatures_degc.index(150.0))
    assert loud.names == ("brakings/00004.h5",) and 90 < loud.value < 94 and loud.text == f"{loud.value:.0f}"
    quiet = occurrence.at(occurrence.pressures_bar.index(6.0), 0)
    assert math.isnan(quiet.value) and quiet.text == "–"


def test_excluded_brakings_are_in_no_figure(campaign):
    annotate(campaign, 4, Action.EXCLUDE, "why")
    with Catalogue(campaign) as catalogue:
        entries = entries_of(catalogue.update(catalogue.read().stale), read_annotations(campaign))
    data = figure_data("pressure_frequency", entries)
    assert set(data.picture.names) == {"brakings/00002.h5"}
    assert (data.summary.n_excluded, data.summary.n_squealing) == (1, 1)


def test_campaigns_newest_first_with_facts(campaign, second):
    found = find_campaigns(campaign.parent)
    assert [(c.name, c.brakings, c.simulated) for c in found] == [("first", 6, True), ("second", 6, True)]
    (second / "campaign.toml").write_text("this is = not [toml")
    assert [c.name for c in find_campaigns(campaign.parent) if c.problem] == ["second"]
    assert find_campaigns(campaign.parent / "nothing") == []
    assert [c.path for c in find_campaigns(campaign)] == [campaign]


def test_marks_and_results_in_words():
    marks = marks_of(
        [
            {"name": "operator_rating", "t_s": 2.0, "values": {"rating": 7}},
            {"name": "operator_note", "t_s": 1.0, "values": {"text": "hiss"}},
            {"name": "pressure_onset", "t_s": 0.5, "values": {"temperature_degc": 59.25}},
        ]
    )
    assert [m.words for m in marks] == [
        "Pressure is applied: temperature_degc: 59.25", "Note: hiss", "Noise rating: 7",
    ]  # fmt: skip
    assert [m.by_operator for m in marks] == [False, True, True]
    summary = {
        "set_points": {"pressure_bar": 20.0, "repetition": 1},
        "results": {"mean_mu": None, "laeq_db": 80.25},
    }
    assert result_lines(summary) == [
        ("Pressure, set-point", "20.00", "bar"),
        ("Coefficient of friction, mean", "—", ""),
        ("Equivalent level, A-weighted", "80.2", "dB(A)"),
    ]
    assert name_text("disc_temperature_initial_degc") == "Disc temperature, start"
    assert metadata_lines(("", {"a": {"b": [{"c": 1.5}]}, "d": None})) == [("a.b[1].c", "1.5"), ("d", "")]


def test_a_file_copied_elsewhere_keeps_the_notes_of_its_marks():
    from rigctl.analysis.campaign_table import annotated
    from rigctl.recording.annotations import Annotation

    marks = [
        {"name": "operator_note", "t_s": 1.0, "values": {"text": "hiss"}},
        {"name": "operator_rating", "t_s": 1.0, "values": {"rating": 3}},
    ]
    row = annotated(entry(1).row, Annotation(note="later"), marks)
    assert (row.remark, row.rating) == ("hiss · later", 3)
    row = annotated(row, Annotation(said=("hiss",), rating=8), marks)
    assert (row.remark, row.rating) == ("hiss", 8)
    assert dataclasses.replace(row, excluded="x").counts is False

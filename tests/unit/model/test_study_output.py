"""What a study writes: figures, tables with units, JSON without nan; and how options are read."""

import csv
import json
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest
from matplotlib.figure import Figure
from PIL import Image

from rigctl.analysis.style import new_figure
from rigctl.app.model.common import cell, parse_settings
from rigctl.core.errors import ConfigError
from rigctl.model.output import Column, Study, Table, write


def draw() -> Figure:
    figure = new_figure(4.0, 3.0)
    figure.subplots().plot([0, 1], [0, 1])
    return figure


TABLE = Table(
    "modes",
    "Modes",
    (
        Column("frequency", "Hz", np.array([688.4, 914.7])),
        Column("unstable", "", [False, True]),
        Column("name", "", ["pad, inner", 'with "quotes"']),
        Column("gap", "1/s", [None, 2.5]),
    ),
)
STUDY = Study(
    "probe",
    "Probe",
    {"onset_bar": np.float64(15.0), "none": float("nan"), "z": 1 + 2j},
    (TABLE,),
    {"p": draw},
)


def test_all_formats_are_written_and_read_back(tmp_path: Path) -> None:
    names = {path.name for path in write(STUDY, tmp_path / "new" / "folder")}
    assert names == {"probe_p.png", "probe_p.svg", "probe_modes.csv", "probe_modes.parquet", "probe.json"}
    folder = tmp_path / "new" / "folder"
    with (folder / "probe_modes.csv").open(encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[0] == ["frequency [Hz]", "unstable", "name", "gap [1/s]"]
    assert rows[2] == ["914.7", "True", 'with "quotes"', "2.5"]
    table = pq.read_table(folder / "probe_modes.parquet")
    assert table.column("frequency").to_pylist() == [688.4, 914.7]
    assert table.column("gap").to_pylist() == [None, 2.5]
    assert table.schema.field("frequency").metadata == {b"unit": b"Hz"}
    facts = json.loads((folder / "probe.json").read_text())["facts"]
    assert facts == {"onset_bar": 15.0, "none": None, "z": {"re": 1.0, "im": 2.0}}
    with Image.open(folder / "probe_p.png") as image:
        assert image.size == (520, 390)


def test_only_the_formats_asked_for(tmp_path: Path) -> None:
    assert [path.name for path in write(STUDY, tmp_path, ["csv"])] == ["probe_modes.csv"]


def test_unknown_format_and_unwritable_folder_are_told(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"--format.*xlsx.*Known: png, svg, csv, parquet, json"):
        write(STUDY, tmp_path, ["xlsx"])
    (tmp_path / "file").write_text("")
    with pytest.raises(ConfigError, match=r"cannot write results.*Name another folder"):
        write(STUDY, tmp_path / "file")


def test_a_table_of_unequal_columns_is_refused() -> None:
    with pytest.raises(ValueError, match="unequal length"):
        Table("t", "T", (Column("a", "", [1]), Column("b", "", [1, 2])))
    with pytest.raises(ValueError, match="one name"):
        Table("t", "T", (Column("a", "", [1]), Column("a", "", [2])))


def test_settings() -> None:
    assert parse_settings(["mu=0.45", " c_pis_n = 2.2e8"]) == {"mu": 0.45, "c_pis_n": 2.2e8}
    assert parse_settings(None) == {}
    for wrong in (["mu"], ["mu=high"], ["=3"], ["mu=1", "mu=2"], ["mu=nan"]):
        with pytest.raises(ConfigError, match="NAME=NUMBER"):
            parse_settings(wrong)


def test_cells_for_people() -> None:
    assert [cell(v) for v in (None, True, 2139.98765, "x", float("nan"), 3)] == [
        "–",
        "yes",
        "2139.99",
        "x",
        "–",
        "3",
    ]

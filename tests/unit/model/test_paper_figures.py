"""All figures of the paper on one page, its numbers beside ours; they come out of the brake files."""

import csv
import re
import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

from rigctl.app.model import model_app
from rigctl.model.paper import FIGURES, numbers_table, paper_figures

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"


def rows(folder: Path) -> dict[tuple[str, str], list[str]]:
    with (folder / "paper_numbers.csv").open(encoding="utf-8") as file:
        return {(row[0], row[1]): row for row in list(csv.reader(file))[1:]}


def test_the_command_makes_every_figure_with_the_papers_numbers_beside_ours(tmp_path: Path) -> None:
    result = CliRunner().invoke(model_app(), ["figures", "--brakes", str(BRAKES), "--out", str(tmp_path)])
    assert result.exit_code == 0, result.output
    page = (tmp_path / "figures.html").read_text(encoding="utf-8")
    assert [f.number for f in FIGURES] == [
        "Fig. 1a", "Fig. 1b", "Fig. 7", "Fig. 8", "Fig. 9", "Fig. 10", "Fig. 11", "Fig. 13",
    ]  # fmt: skip
    for figure in FIGURES:
        assert f"<h2>{figure.number}</h2>" in page
        assert figure.number in result.output
    for file in re.findall(r'<a href="([^"]+)">', page):
        assert (tmp_path / file).stat().st_size > 50, file
    assert not re.search(r'(src|href)="https?:', page)  # self-contained
    found = rows(tmp_path)
    assert {number for number, _ in found} == {figure.number for figure in FIGURES}
    for key, paper, tolerance in [
        (("Fig. 7", "coefficient of friction at onset"), 0.64, 0.001),
        (("Fig. 7", "frequency of the unstable mode"), 2400.0, 1.0),
        (("Fig. 13", "brake pressure at onset"), 15.0, 0.01),
        (("Fig. 13", "frequency of the unstable mode"), 2140.0, 0.5),
    ]:
        assert float(found[key][3]) == paper
        assert float(found[key][4]) == pytest.approx(paper, abs=tolerance)
    assert found["Fig. 10", "eigenvalues"][3:5] == ["28", "28"]
    honest = [row[-1] for row in found.values()]
    assert "yes" in honest and "no" in honest and "in part" in honest


def test_another_stiffness_in_the_file_moves_the_numbers(tmp_path: Path) -> None:
    shutil.copytree(BRAKES, tmp_path / "brakes")
    path = tmp_path / "brakes" / "model.toml"
    text = path.read_text().replace("c_abu_t = { value = 8.055e7", "c_abu_t = { value = 7.2e7")
    path.write_text(text)
    table = numbers_table(list(paper_figures(tmp_path / "brakes", ["13"])))
    ours = dict(zip(table.column("quantity"), table.column("ours"), strict=True))
    assert abs(ours["frequency of the unstable mode"] - 2140.0) > 20.0
    deviation = dict(zip(table.column("quantity"), table.column("deviation"), strict=True))
    assert abs(deviation["frequency of the unstable mode"]) > 1.0


def test_an_unknown_figure_and_a_missing_brake_are_told(tmp_path: Path) -> None:
    for arguments, words in [
        (["figures", "--only", "12"], "no such figure"),
        (["figures", "--only", "7", "--brakes", str(tmp_path)], "no such file"),
    ]:
        result = CliRunner().invoke(model_app(), [*arguments, "--out", str(tmp_path / "out")])
        assert result.exit_code != 0
        assert words in str(result.exception)

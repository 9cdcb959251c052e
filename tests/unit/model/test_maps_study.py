"""Maps and boundaries for people: facts, tables, figures, command line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from rigctl.app.model import maps as commands
from rigctl.core.errors import ConfigError
from rigctl.model.loading import read_model
from rigctl.model.maps import boundary_study, curve_study, map_study
from rigctl.model.output import write

BRAKES = Path(__file__).parents[3] / "configs/brakes"


@pytest.fixture(scope="module")
def app() -> typer.Typer:
    app = typer.Typer()
    commands.register(app)
    return app


def run(app: typer.Typer, *arguments: str) -> str:
    result = CliRunner().invoke(app, arguments, catch_exceptions=False)
    assert result.exit_code == 0
    return result.output


def test_map_of_the_basic_brake() -> None:
    study = map_study(
        read_model(BRAKES / "basic.toml"), ("mu", np.linspace(0.0, 1.0, 51)), ("pressure", np.linspace(0.0,
        10.0, 9))
    )  # fmt: skip
    assert study.facts["method"] == "secular equation"
    assert study.facts["share_of_points_left_to_lapack"] <= 0.01
    assert study.facts["unstable_share_of_the_area"] == pytest.approx(0.36, abs=0.015)
    lines = study.table("boundary")
    np.testing.assert_allclose(lines.column("mu"), 0.64, atol=1e-3)
    np.testing.assert_allclose(lines.column("frequency"), 2400.0, atol=1.0)
    assert set(lines.column("kind")) == {"flutter"}
    assert len(study.table("map")) == 51 * 9
    assert "method" in study.facts and "reason_for_lapack" not in study.facts


def test_boundary_up_and_down_from_the_value_of_the_file() -> None:
    model = read_model(BRAKES / "basic.toml")
    study = boundary_study(model, "c_con_it", values={"mu": 0.6})
    table = study.table("boundary")
    start = model.quantities["c_con_it"].value
    assert table.column("searched_from") == [start, start]
    assert [v is None for v in table.column("c_con_it")] == [True, False]
    assert study.facts["boundary_frequency_hz"] == pytest.approx(2389.9, abs=1.0)
    assert "unstable from c_con_it" in study.title


def test_what_needs_a_range_says_so() -> None:
    model = read_model(BRAKES / "basic.toml")
    with pytest.raises(ValueError, match="slope:FROM:TO"):
        boundary_study(model, "slope")
    with pytest.raises(ValueError, match="c_con_it:FROM:TO"):
        curve_study(model, "c_con_it", ("mu", [0.4, 0.5]))


def test_files_of_all_three_studies(tmp_path: Path) -> None:
    model = read_model(BRAKES / "plant.toml")
    studies = (
        map_study(model, ("mu", np.linspace(0.0, 2.0, 24)), ("pressure", np.linspace(0.0, 30.0, 16))),
        map_study(model, ("mu", [0.4]), ("pressure", [1.0])),
        boundary_study(model, "pressure"),
        boundary_study(model, "mu", (0.0, 0.1)),
        curve_study(model, "pressure", ("mu", np.linspace(0.0, 2.0, 7))),
        curve_study(model, "pressure", ("slope", [1e-4, 2e-4])),
    )
    for number, study in enumerate(studies):
        paths = write(study, tmp_path / str(number), ("png", "svg", "csv", "json"))
        assert {p.suffix for p in paths} == {".png", ".svg", ".csv", ".json"}
        assert all(p.stat().st_size > 0 for p in paths)
    assert studies[3].title.endswith("stable over the whole range of mu")
    assert studies[5].facts["crossings_found"] == 0


def test_commands(app: typer.Typer, tmp_path: Path) -> None:
    brake = str(BRAKES / "model.toml")
    shown = run(app, "map", brake, "--x", "mu:0:1:20", "--y", "pressure:0:30:20", "--out", str(tmp_path))
    assert "left to lapack: 0" in shown
    facts = json.loads((tmp_path / "map.json").read_text())["facts"]
    assert facts["points"] == 400
    assert (tmp_path / "map_growth.png").exists()
    shown = run(app, "boundary", brake, "--over", "pressure", "--set", "slope=0.0576")
    assert "15.0" in shown and "2140" in shown
    shown = run(app, "boundary", brake, "--over", "finger_stiffness:clockwise:0:0.5", "--set", "pressure=14")
    assert "0.317" in shown
    shown = run(app, "boundary", brake, "--over", "pressure:0:60", "--along", "slope:0.04:0.12:3")
    assert "crossings found: 3" in shown


@pytest.mark.parametrize(
    ("arguments", "place", "problem"),
    [
        (("map", "--x", "mu:0:1"), "--x", "NAME:FROM:TO:COUNT"),
        (("map", "--x", "presure:0:1:9"), "model.toml", "did you mean"),
        (("map", "--x", "mu:0:1:9", "--y", "mu:0:1:9"), "model.toml", "both axes"),
        (("map", "--x", "mu:-1:1:9"), "model.toml", "not negative"),
        (("boundary", "--over", "mu:1"), "--over", "NAME:FROM:TO"),
        (("boundary", "--over", "nothing"), "model.toml", "no quantity"),
        (("boundary", "--over", "mu", "--along", "mu:0:1:3"), "model.toml", "name another"),
        (("boundary", "--over", "disc_mass:clockwise:0:0.3"), "model.toml", "no leading and trailing"),
    ],
)
def test_bad_input_gives_one_clear_error(app: typer.Typer, arguments, place: str, problem: str) -> None:
    command, *options = arguments
    result = CliRunner().invoke(app, [command, str(BRAKES / "model.toml"), *options])
    assert isinstance(result.exception, ConfigError)
    assert place in str(result.exception)
    assert problem in str(result.exception)

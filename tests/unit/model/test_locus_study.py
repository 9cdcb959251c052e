"""Root locus for people: the paper's numbers of Figs 7 and 13 beside ours, files, command line."""

import json
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from rigctl.app.model import locus as command
from rigctl.core.errors import ConfigError
from rigctl.model.loading import read_model
from rigctl.model.locus import critical_mode, figure_7_study, figure_13_study, locus_study, section_of
from rigctl.model.output import plain, write
from sim_hardware.brake_model.eigen.tracking import track
from sim_hardware.brake_model.eigen.tracking_events import mode_couplings

BRAKES = Path(__file__).parents[3] / "configs/brakes"


@pytest.fixture(scope="module")
def app() -> typer.Typer:
    app = typer.Typer()
    command.register(app)
    app.command("other")(lambda: None)
    return app


def test_figure_7_has_the_papers_numbers_beside_ours() -> None:
    study = figure_7_study(read_model(BRAKES / "basic.toml"))
    paper = study.facts["paper"]
    onset = paper["coefficient_of_friction_at_onset"]
    assert onset["paper"] == 0.64 and onset["ours"] == pytest.approx(0.64, abs=1e-3)
    frequency = paper["frequency_of_the_unstable_mode"]
    assert frequency["paper"] == 2400.0 and frequency["ours"] == pytest.approx(2400.0, abs=1.0)
    assert study.facts["coupled_modes"] == [7, 8] and study.facts["critical_mode"] == 7
    assert study.table("paper").column("deviation")[:2] == pytest.approx([0.0, 0.0], abs=0.1)
    points = study.table("locus")
    values, modes = np.array(points.column("mu")), np.array(points.column("mode"))
    f, real = np.array(points.column("frequency")), np.array(points.column("real_part"))
    assert len(points) == 23 * 14 and values.min() == 0.47 and values.max() == 0.69
    gap = f[modes == 8] - f[modes == 7]
    assert (np.diff(gap) < 0).all() and gap[0] == pytest.approx(108.8, abs=0.1)
    assert (np.diff(real[modes == 7]) > 0).all() and (np.diff(real[modes == 8]) < 0).all()


def test_figure_13_has_the_papers_numbers_beside_ours() -> None:
    study = figure_13_study(read_model(BRAKES / "model.toml"))
    paper = study.facts["paper"]
    assert paper["brake_pressure_at_onset"] == {
        "unit": "bar",
        "paper": 15.0,
        "ours": pytest.approx(15.0, abs=0.02),
    }
    assert paper["frequency_of_the_unstable_mode"]["ours"] == pytest.approx(2140.0, abs=0.5)
    assert study.facts["mode_coupling"] == "none"
    assert study.facts["unstable_modes_at_end"] == [5]


def test_a_study_of_the_refined_model_over_friction_says_that_it_stays_stable() -> None:
    study = locus_study(read_model(BRAKES / "model.toml"), "mu", np.linspace(0.0, 0.69, 8), {"slope": 0.0})
    assert "stable from" in study.title and study.facts["onset_value"] is None
    assert study.facts["largest_real_part_at_end_1_s"] < 0.0


def test_section_holds_the_critical_pair_and_the_axis() -> None:
    locus = track(read_model(BRAKES / "basic.toml"), "mu", np.linspace(0.47, 0.69, 23))
    section = section_of(locus, mode_couplings(locus))
    assert section.shown == (7, 8) and critical_mode(locus) == 7
    assert section.real_1_s[0] < -437.0 and section.real_1_s[1] > 83.0
    assert section.frequency_hz[0] < 2351.0 and section.frequency_hz[1] > 2460.0


def test_files_of_a_study(tmp_path: Path) -> None:
    study = locus_study(read_model(BRAKES / "basic.toml"), "mu", np.linspace(0.5, 0.7, 5), name="l")
    paths = {path.name for path in write(study, tmp_path, ("png", "csv", "json"))}
    assert {"l_plane.png", "l_course.png", "l_locus.csv", "l_crossings.csv", "l.json"} <= paths
    assert (tmp_path / "l_plane.png").stat().st_size > 20_000
    assert json.loads((tmp_path / "l.json").read_text())["facts"]["onset_value"] == pytest.approx(
        0.64, abs=1e-3
    )
    json.dumps(plain(study.facts), allow_nan=False)


def test_drawing_the_axis_with_divergence_and_nothing_critical(tmp_path: Path) -> None:
    """Extremes are drawn too: real eigenvalues (overdamped), a range of the barest kind."""
    model = read_model(BRAKES / "model.toml")
    study = locus_study(model, "d_disc_phi", [1.0, 1e3], name="over")
    assert any(flag for flag in study.table("locus").column("flags"))
    assert len(write(study, tmp_path, ("png",))) == 2


def test_command_prints_and_writes(app: typer.Typer, tmp_path: Path) -> None:
    arguments = [
        "locus",
        str(BRAKES / "basic.toml"),
        "--figure",
        "7",
        "--out",
        str(tmp_path),
        "--format",
        "json",
    ]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    assert "0.640019" in result.output and "Fig. 7" in result.output
    assert (tmp_path / "figure_7.json").exists()


def test_command_varies_a_group(app: typer.Typer) -> None:
    arguments = [
        "locus",
        str(BRAKES / "basic.toml"),
        "--group",
        "contact_stiffness",
        "--over",
        "factor:0.8:1.2:5",
    ]
    result = CliRunner().invoke(app, [*arguments, "--set", "mu=0.6", "--asymmetric"])
    assert result.exit_code == 0, result.output
    assert "leading up and trailing down" in result.output


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["--over", "mu:0.4:0.4:1"], "at least two points"),
        (["--group", "contact_stiffness"], "relative factor"),
        (["--over", "contact_stiffnes:0.8:1.2:5"], "contact_stiffness"),
        (["--over", "mu:-1:1:5"], "not negative"),
        (["--figure", "8"], "7, 13"),
    ],
)
def test_bad_input_names_place_and_remedy(app: typer.Typer, arguments: list[str], problem: str) -> None:
    result = CliRunner().invoke(app, ["locus", str(BRAKES / "basic.toml"), *arguments])
    assert isinstance(result.exception, ConfigError)
    assert problem in str(result.exception)

"""`rigctl model optimise`: better margin, verified independently, same results anywhere, errors."""

from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from rigctl.app.model import studies
from rigctl.core.errors import RigctlError
from rigctl.model.optimise import optimise, optimise_study
from rigctl.model.output import write
from rigctl.model.runner import RunOptions
from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.stability import eigen_pairs, onset_pressure

MODEL = Path("configs/brakes/model.toml")
RANGES = {"pressure": [0.0, 10.0, 20.0], "mu": [0.4]}


@pytest.fixture(autouse=True)
def _own_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


def test_optimum_is_better_and_holds_when_solved_by_the_brake_itself():
    found = optimise(MODEL, free=["x_pis:0.014:0.022", "d_pis_t:20:40"], ranges=RANGES, start_count=3)
    before, after = load_brake(MODEL), load_brake(MODEL)
    after = after.with_parameters(x_pis=0.017 * found.factors[0], d_pis_t=27.7 * found.factors[1])

    def margin(brake):
        return min(p.damping_ratio for x in RANGES["pressure"] for p in eigen_pairs(brake, 0.4, None, x))

    assert found.before.damping_ratio == pytest.approx(margin(before), rel=1e-8)
    assert found.after.damping_ratio == pytest.approx(margin(after), rel=1e-8)
    assert found.after.damping_ratio > found.before.damping_ratio + 5e-4
    assert onset_pressure(after).value > onset_pressure(before).value + 1.0
    assert found.after_finer.damping_ratio <= found.after.damping_ratio + 1e-12
    assert 0.014 <= 0.017 * found.factors[0] <= 0.022 * (1 + 1e-12)


def test_study_tells_bounds_and_onsets_and_writes_files(tmp_path):
    here = optimise_study(
        MODEL,
        groups=["finger_stiffness", "piston_damping:0.5:2"],
        ranges={"pressure": [0.0, 20.0]},
        start_count=2,
        options=RunOptions(workers=2),
    )
    assert here.facts["starts_that_reach_the_best_margin"] == 2
    assert here.facts["margin_after_percent"] > here.facts["margin_before_percent"]
    assert here.facts["verified_after_percent"] <= here.facts["margin_after_percent"] + 1e-9
    assert "piston_damping (upper)" in here.facts["active_bounds"]
    assert here.table("variables").column("after")[1] == pytest.approx(2.0, rel=1e-3)
    onsets = here.table("onsets")
    assert onsets.column("onset_after")[0] is None or onsets.column("onset_after")[0] > 15.1
    names = {path.name for path in write(here, tmp_path, ("png", "csv", "json"))}
    assert {"optimise_margin.png", "optimise_variables.csv", "optimise.json"} <= names


def test_file_that_is_the_optimum_stays():
    """Narrow bounds with the file at one end: never worse than the file."""
    found = optimise(MODEL, free=["m_cal:3.6:3.61"], ranges={"pressure": [20.0]}, start_count=2)
    assert found.after.damping_ratio >= found.before.damping_ratio


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "nothing is free"),
        (["--free", "x_pis"], "is not NAME:LOW:HIGH"),
        (["--free", "x_pis:a:b"], "For example --free x_pis:0.014:0.022"),
        (["--free", "x_pis:0.022:0.014"], "the lower one first"),
        (["--free", "x_pis:0.014:inf"], "finite"),
        (["--free", "x_pis:-0.01:0.02"], "another sign"),
        (["--free", "x_piss:0.014:0.022"], "no quantity 'x_piss'"),
        (["--free", "x_pis:0.014:0.022", "--free", "x_pis:0.01:0.02"], "varied twice"),
        (["--free", "mu:0.3:0.5"], "belongs to the operating range"),
        (["--groups", "pistons"], "no group 'pistons'"),
        (["--groups", "piston_position:0:1"], "another sign"),
        (["--groups", "piston_position", "--over", "pressure:0:30:600"], "600 points"),
        (["--groups", "piston_position", "--over", "mu:0:1:3", "--over", "mu:0:1:4"], "quantity twice"),
    ],
)
def test_errors_are_one_clear_line(arguments, words):
    app = typer.Typer()
    studies.register(app)
    result = CliRunner().invoke(app, ["optimise", str(MODEL), *arguments])
    assert isinstance(result.exception, RigctlError), result.output
    assert words in str(result.exception)
    assert "\n" not in str(result.exception)

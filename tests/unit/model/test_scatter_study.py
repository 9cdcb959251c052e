"""`rigctl model scatter`: the same results anywhere, stopped and continued, files, errors."""

import json
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from rigctl.app import exit_codes
from rigctl.app.model import studies
from rigctl.core.errors import ConfigError, RigctlError
from rigctl.model.output import write
from rigctl.model.runner import RunOptions
from rigctl.model.runner_model import load_source, model_source
from rigctl.model.scatter import scatter, scatter_study

MODEL, BASIC = Path("configs/brakes/model.toml"), Path("configs/brakes/basic.toml")
PRESSURES = np.linspace(10.0, 20.0, 11)
FEW = ["scatter", str(MODEL), "--over", "pressure:10:20:11", "--samples", "16"]


@pytest.fixture(autouse=True)
def _own_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


@pytest.fixture
def run():
    app = typer.Typer()
    studies.register(app)

    def call(arguments):
        return CliRunner().invoke(app, arguments)

    return call


def test_result_is_consistent_and_the_same_in_workers():
    here = scatter(MODEL, "pressure", PRESSURES, samples=16, seed=3)
    there = scatter(MODEL, "pressure", PRESSURES, samples=16, seed=3, options=RunOptions(workers=2))
    assert (here.onsets == there.onsets).all()
    assert (here.frequencies_hz == there.frequencies_hz).all()
    assert (here.unstable == (here.onsets[:, None] <= PRESSURES)).all()
    assert here.squeal.share == pytest.approx(here.unstable.mean(axis=0))
    assert (here.squeal.low <= here.squeal.share).all()
    assert (here.squeal.share <= here.squeal.high).all()
    assert here.squeal.share[0] == 0.0
    assert here.squeal.share[-1] == 1.0


def test_samples_are_real_brakes():
    """A sample's onset, computed again from its factors by the brake itself."""
    from sim_hardware.brake_model.stability import onset_pressure

    found = scatter(MODEL, "pressure", PRESSURES, samples=2, spread=0.08, law="lognormal")
    model = load_source(model_source(MODEL))
    changes = {
        v.name: model.quantities[v.name].value * f
        for v, f in zip(found.variables, found.factors[1].tolist(), strict=True)
    }
    again = onset_pressure(model.brake.with_parameters(**changes))
    assert found.onsets[1] == pytest.approx(again.value, rel=1e-8)
    assert found.frequencies_hz[1] == pytest.approx(again.frequency_hz, rel=1e-8)


def test_groups_scatter_alike_and_stable_brakes_are_said_to_be():
    study = scatter_study(
        MODEL, "pressure", PRESSURES, samples=12, groups=["contact_stiffness"], values={"slope": 0.0}
    )
    assert study.facts["share_unstable_somewhere_in_the_range"] == 0.0
    assert study.facts["onset_50_percent"] is None
    assert study.facts["driver_of_onset"] == "too few unstable samples"
    assert len(study.table("drivers")) == 1


def test_study_writes_all_files(tmp_path):
    study = scatter_study(BASIC, "mu", np.linspace(0.2, 1.2, 21), samples=20)
    names = {path.name for path in write(study, tmp_path, ("png", "svg", "csv", "json", "parquet"))}
    assert {"scatter_probability.png", "scatter_drivers.svg", "scatter_samples.csv", "scatter.json"} <= names
    facts = json.loads((tmp_path / "scatter.json").read_text())["facts"]
    assert facts["onset_10_percent"] < facts["onset_of_the_file"] < 0.7
    assert len(study.table("samples")) == 20
    assert study.table("probability").column("squeal_probability")[0] == 0.0


def test_stopped_by_ctrl_c_and_continued_by_the_same_command(run, monkeypatch, tmp_path):
    whole = run([*FEW, "--out", str(tmp_path / "whole")])
    assert whole.exit_code == 0, whole.output
    show = studies._ProgressView.show

    def interrupt(self, progress):
        if progress.done >= 3:
            raise KeyboardInterrupt
        show(self, progress)

    with monkeypatch.context() as patched:
        patched.setattr(studies._ProgressView, "show", interrupt)
        stopped = run(FEW)
    assert stopped.exit_code == exit_codes.STOPPED
    assert "of 16 tasks are kept in" in stopped.output
    assert "same command" in stopped.output
    seen = []
    monkeypatch.setattr(studies._ProgressView, "show", lambda self, progress: seen.append(progress))
    again = run([*FEW, "--out", str(tmp_path / "again")])
    assert again.exit_code == 0
    assert 3 <= seen[-1].restored < 16
    for name in ("scatter_samples.csv", "scatter.json", "scatter_probability.csv"):
        assert (tmp_path / "whole" / name).read_bytes() == (tmp_path / "again" / name).read_bytes()
    assert not list((tmp_path / "cache" / "rigctl" / "studies").iterdir())


def test_own_folder_belongs_to_one_study(run, tmp_path):
    folder = ["--folder", str(tmp_path / "study")]
    assert run([*FEW, *folder]).exit_code == 0
    other = run([*FEW, *folder, "--spread", "0.1"])
    assert isinstance(other.exception, ConfigError)
    assert "spread is 0.05 there and 0.1 here" in str(other.exception)
    model = run(["scatter", str(BASIC), *FEW[2:], *folder])
    assert "model.name is model.toml there and basic.toml here" in str(model.exception)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--spread", "0"], "between 0 and 1"),
        (["--law", "normal"], "Known: uniform, lognormal"),
        (["--over", "presure:0:30:61"], "no quantity 'presure'"),
        (["--over", "pressure:0:30"], "NAME:FROM:TO:COUNT"),
        (["--over", "pressure:30:0:10"], "rising"),
        (["--free", "c_con"], "did you mean"),
        (["--groups", "pistons"], "no group"),
        (["--over", "m_disc:4:6:5"], "cannot scatter as well"),
        (["--set", "pressure=3"], "cannot be set as well"),
        (["--workers", "2", "--scheduler", "tcp://x:1"], "cannot be combined"),
    ],
)
def test_errors_are_one_clear_line(run, arguments, words):
    result = run([*FEW, *arguments])
    assert isinstance(result.exception, RigctlError), result.output
    assert words in str(result.exception)
    assert "\n" not in str(result.exception)


def test_models_by_path_are_checked_by_their_digest(tmp_path):
    model = load_source(model_source(MODEL))
    matrices = model.matrices({"pressure": 10.0})
    path = tmp_path / "made.npz"
    np.savez(path, M=matrices.mass, D=matrices.damping, K=matrices.stiffness)
    source = model_source(path)
    assert load_source(source).matrices().n_dof == 14
    np.savez(path, M=2 * matrices.mass, D=matrices.damping, K=matrices.stiffness)
    with pytest.raises(ConfigError, match="does not find the model"):
        load_source({**source, "name": "other"})

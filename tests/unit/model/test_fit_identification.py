"""`rigctl model identify`: from a campaign's files and by hand, brake files written, errors."""

import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from rigctl.app.model import studies
from rigctl.core.errors import ConfigError, RigctlError
from rigctl.model.identification import by_hand, identify, identify_study, measured_in, write_brake
from rigctl.model.output import write
from rigctl.model.runner import RunOptions
from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.stability import onset_pressure

sys.path.append(str(Path(__file__).parents[1] / "analysis"))
from campaign_files import Case, numbered, write_campaign

MODEL, PLANT = Path("configs/brakes/model.toml"), Path("configs/brakes/plant.toml")


@pytest.fixture(autouse=True)
def _own_cache(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """Quiet at 8 and 10 bar, one of two squeals at 12, all at 14 and 16; around 2350 Hz."""
    tones = {8.0: (0, 0), 10.0: (0, 0), 12.0: (0, 1), 14.0: (1, 1), 16.0: (1, 1)}
    cases = [
        Case(0, pressure_bar=p, tones=((2350.0 + 4 * n, 85.0, 1.0, 2.0),) if loud else ())
        for p, pair in tones.items()
        for n, loud in enumerate(pair)
    ]
    return write_campaign(tmp_path_factory.mktemp("campaign") / "night", numbered(cases))


def test_campaign_gives_onset_and_frequency_with_uncertainty(campaign):
    recorded = measured_in(campaign)
    measured = recorded.measured
    assert measured.onset == 11.0  # between 10 (quiet) and 12 bar (half of the brakings)
    assert measured.onset_sigma == pytest.approx(2.0 / np.sqrt(12.0))
    assert measured.frequency_hz == pytest.approx(2352.0, abs=4.0)
    assert 2.0 <= measured.frequency_sigma_hz < 6.0
    assert recorded.origin == "campaign night"


def test_campaigns_that_say_nothing_are_refused(tmp_path):
    quiet = write_campaign(tmp_path / "quiet", numbered([Case(0, pressure_bar=8.0), Case(0)]))
    with pytest.raises(ConfigError, match="no braking of this campaign squealed"):
        measured_in(quiet)
    loud = write_campaign(
        tmp_path / "loud", numbered([Case(0, pressure_bar=8.0, tones=((2350.0, 85.0, 1.0, 2.0),))])
    )
    with pytest.raises(ConfigError, match="squeals already at the lowest pressure"):
        measured_in(loud)


def test_model_is_brought_to_the_campaign(campaign, tmp_path):
    """The model squeals at 15 bar and 2140 Hz; the campaign's brake at 11 bar and 2352 Hz."""
    free = ["m_padi:0.1", "c_abu_t:0.2", "c_knu_t:0.2", "c_knu_l:0.2", "d_pis_t:0.3", "m_ct:0.1"]
    study, result = identify_study(MODEL, measured_in(campaign), free=free, samples=0)
    assert result.fit.converged
    assert study.facts["combinations_fixed_by_the_data"] == 2
    assert "underdetermined: 2 of 6" in study.facts["verdict"]
    assert result.predictions.shape == (4, 0, 2)
    target = tmp_path / "fitted.toml"
    write_brake(MODEL, target, result)
    after = onset_pressure(load_brake(target))
    assert (after.value, after.frequency_hz) == pytest.approx(tuple(result.fit.after), rel=1e-6)
    assert abs(after.value - 11.0) < 2.0 * result.recorded.measured.onset_sigma + 0.5
    assert after.frequency_hz == pytest.approx(2352.0, abs=30.0)
    assert "identify_directions.csv" in {path.name for path in write(study, tmp_path, ("csv",))}


def test_samples_are_the_same_in_workers():
    wanted = {"free": ["m_padi:0.02", "d_pis_t:0.05"], "samples": 4, "seed": 2}
    here = identify(PLANT, by_hand(12.2, 2345.0), **wanted)
    there = identify(PLANT, by_hand(12.2, 2345.0), **wanted, options=RunOptions(workers=2))
    assert here.predictions.shape == (4, 1, 2)
    assert (here.logarithms == there.logarithms).all()
    assert (here.predictions == there.predictions).all()


def test_written_file_keeps_comments_and_names_the_data(tmp_path):
    result = identify(PLANT, by_hand(12.0, 2350.0), free=["m_padi", "slope"], samples=0)
    text = PLANT.read_text().replace("\nslope = {", "\n# measured on the rig\nslope = {", 1)
    source, target = tmp_path / "plant.toml", tmp_path / "new.toml"
    source.write_text(text)
    write_brake(source, target, result)
    old, new = text.splitlines(), target.read_text().splitlines()
    changed = [n for a, n in zip(old, new, strict=True) if a != n]
    assert [line.split(" ")[0] for line in changed] == ["slope", "m_padi"]
    entry = tomllib.loads(target.read_text())["parameters"]["m_padi"]
    assert entry["value"] == pytest.approx(0.4075 * result.fit.factors[0], rel=1e-7)
    assert "numbers given by hand (onset at pressure 12 ± 0.6, 2350.0 ± 12 Hz)" in entry["origin"]
    assert "prior ±5 %" in entry["origin"]
    with pytest.raises(ConfigError, match="not overwritten"):
        write_brake(source, source, result)


def test_places_cannot_be_written(tmp_path):
    result = identify(PLANT, by_hand(12.0, 2350.0), groups=["piston_damping"], samples=0)
    with pytest.raises(ConfigError, match="has no value of its own in the file"):
        write_brake(PLANT, tmp_path / "new.toml", result)
    assert not (tmp_path / "new.toml").exists()


def test_command_by_hand(tmp_path):
    app = typer.Typer()
    studies.register(app)
    target = tmp_path / "new.toml"
    result = CliRunner().invoke(
        app,
        ["identify", str(PLANT), "--onset-bar", "12.5", "--frequency-hz", "2345", "--free", "m_padi:0.05",
         "--free", "d_pis_t:0.1", "--samples", "8", "--write", str(target), "--out", str(tmp_path / "out")],
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    assert "underdetermined: 1 of 2 combinations" in result.output
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"identify_parameters.png", "identify_predictions.svg", "identify.json"} <= names
    assert onset_pressure(load_brake(target)).value == pytest.approx(12.5, abs=0.4)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "give exactly one of them"),
        (["--onset-bar", "12", "--onset-mu", "0.5"], "give exactly one of them"),
        (["--campaign", "configs"], "not a campaign"),
        (["--campaign", "configs", "--frequency-hz", "2000"], "says onset, frequency"),
        (["--onset-bar", "-1"], "positive"),
        (["--onset-bar", "12", "--spread", "0"], "positive one for each"),
        (["--onset-bar", "12", "--free", "m_padi:x"], "is not NAME or NAME:SPREAD"),
        (["--onset-bar", "12", "--free", "m_pad"], "did you mean"),
        (["--onset-bar", "2", "--free", "m_padi"], "does not begin to squeal"),
        (["--onset-bar", "12", "--free", "m_padi", "--write", "pyproject.toml"], "not overwritten"),
    ],
)
def test_errors_are_one_clear_line(arguments, words):
    app = typer.Typer()
    studies.register(app)
    result = CliRunner().invoke(app, ["identify", str(PLANT), *arguments])
    assert isinstance(result.exception, RigctlError), result.output
    assert words in str(result.exception)
    assert "\n" not in str(result.exception)

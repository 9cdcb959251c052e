"""`rigctl model simulate` and `decay`: studies, files, refusals."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from rigctl.app.model.motion import register
from rigctl.core.errors import ConfigError
from rigctl.model.energy import decay_study, figure_11_study, first_clear
from rigctl.model.motion import least_stable_start, main_frequency_hz, simulation_study
from rigctl.model.output import write
from sim_hardware.brake_model.assembly import load_brake
from sim_hardware.brake_model.time_domain.energy import decays

#: the first run compiles the integrator
pytestmark = pytest.mark.timeout(600)

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
PLANT, MODEL = load_brake(BRAKES / "plant.toml"), load_brake(BRAKES / "model.toml")


@pytest.fixture(scope="module")
def app() -> typer.Typer:
    commands = typer.Typer()
    register(commands)
    return commands


def test_simulation_squeals_above_the_onset() -> None:
    study = simulation_study(PLANT, 20.0, 40.0, 0.15)
    assert study.facts["frequency_hz"] == pytest.approx(2350.0, abs=3.0)
    assert study.facts["slip_amplitude_m_s"] > 0.1
    assert study.facts["energy_balance_error_at_output_rate"] < 1e-4
    assert study.facts["events"] == {}
    assert len(study.table("series")) == 6001
    assert "2350 Hz" in study.title


def test_simulation_dies_out_below_the_onset() -> None:
    study = simulation_study(PLANT, 5.0, 40.0, 0.05)
    assert study.facts["slip_amplitude_m_s"] < 1e-3
    assert study.title.endswith("the motion dies out")


def test_slow_linear_law_sticks_and_forces_are_recorded(tmp_path: Path) -> None:
    study = simulation_study(PLANT, 20.0, 2.0, 0.05, law="linear", forces=True)
    events = study.table("events")
    assert len(events) > 20
    assert set(events.column("event")) == {"sticks", "releases"}
    assert 0.02 < study.facts["sticking_share"]["inner_pad"] < 0.3
    assert study.facts["sticking_share"]["outer_pad"] == 0.0
    forces = study.table("forces")
    assert len(forces.columns) == 1 + 2 * 18 + 1
    rows = study.table("peak_forces").rows()
    peaks = [(along_x, name) for name, along_x, *_ in rows if along_x is not None]
    assert max(peaks)[1] in ("knuckle_t", "abutment_it")
    paths = {path.name for path in write(study, tmp_path)}
    assert {"simulation_motion.png", "simulation_motion.svg", "simulation_forces.parquet"} <= paths
    with (tmp_path / "simulation_series.csv").open() as file:
        header = next(csv.reader(file))
    assert header[:3] == ["time [s]", "inner_pad.sliding_speed [m/s]", "inner_pad.friction [N]"]


def test_start_is_the_least_stable_shape() -> None:
    start = least_stable_start(PLANT, 0.4, 0.0576, 20e5, 1e-3)
    slips = [contact.row_x @ start[14:] for contact in PLANT.contacts]
    assert max(map(abs, slips)) == pytest.approx(1e-3, rel=1e-9)


def test_frequency_of_a_tone() -> None:
    time = np.arange(4000) / 40_000.0
    tone = np.sin(2 * np.pi * 2345.6 * time) + 3.0
    assert main_frequency_hz(tone, 40_000.0) == pytest.approx(2345.6, abs=0.1)
    assert main_frequency_hz(np.ones(4000), 40_000.0) == 0.0


def test_figure_11_with_the_papers_claims(tmp_path: Path) -> None:
    study = figure_11_study(MODEL)
    assert study.facts["modes_changed_by_less_than_2_percent"] == {"x1": 13, "x10": 10, "x100": 7, "x1000": 5}
    assert study.facts["strength_of_clear_difference"] == 100.0
    assert study.facts["cubic_stiffness_n_m3_of_strength_1"] == pytest.approx(3.587e16, rel=1e-3)
    claims = study.table("paper")
    assert list(claims.column("holds")) == ["yes", "no", "no", "yes", "yes"]
    assert study.table("modes").column("mode") == list(range(1, 15))
    energies = study.table("energies")
    assert energies.column("linear")[0] == pytest.approx(1.0)
    assert energies.column("linear")[-1] == pytest.approx(0.1, rel=0.05)
    names = {path.name for path in write(study, tmp_path, ("png", "json"))}
    assert names == {"figure_11_decay.png", "figure_11.json"}
    facts = json.loads((tmp_path / "figure_11.json").read_text())["facts"]
    assert facts["modes_stabilised"]["x1"] == [2, 11, 12, 14]


def test_no_clear_difference_is_said() -> None:
    found = decays(MODEL, (1.0,))
    assert first_clear(found, (1.0,)) is None
    study = decay_study(MODEL, (1.0,), mode=7)
    assert study.title == "model: cubic hardening ×1 changes 13 of 14 decays by < 2 %"
    assert list(study.table("paper").column("ours"))[-1] == "not reached"


def test_commands_write_files(app: typer.Typer, tmp_path: Path) -> None:
    runner = CliRunner()
    plant = str(BRAKES / "plant.toml")
    result = runner.invoke(
        app, ["simulate", plant, "--duration", "0.02", "--law", "constant", "--out", str(tmp_path)]
    )
    assert result.exit_code == 0, result.output
    assert (tmp_path / "simulation_motion.png").stat().st_size > 10_000
    assert json.loads((tmp_path / "simulation.json").read_text())["facts"]["friction_law"] == "constant"
    model = str(BRAKES / "model.toml")
    arguments = ["decay", model, "--strengths", "1,50", "--mode", "1", "--out", str(tmp_path)]
    result = runner.invoke(app, arguments)
    assert result.exit_code == 0, result.output
    assert "13 of 14" in result.output
    assert (tmp_path / "decay_modes.csv").exists()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["simulate", "plant", "--law", "sticky"], ["--law", "sticky", "constant, linear, saturating"]),
        (["simulate", "plant", "--pressure", "-3"], ["pressure is -3.0", "give a finite number"]),
        (["simulate", "plant", "--duration", "0"], ["0.0 s", "two samples"]),
        (["simulate", "plant", "--saturation", "0"], ["saturation_m_s is 0.0", "greater than 0"]),
        (["simulate", "plant", "--rtol", "5"], ["rtol"]),
        (["decay", "model", "--strengths", "1,much"], ["--strengths", "1,much", "For example"]),
        (["decay", "model", "--strengths", "0"], ["strengths", "positive factors"]),
        (["decay", "model", "--mode", "99"], ["mode 99", "1, 2, 3"]),
        (["decay", "model", "--mu", "500"], ["mu is 500.0", "from 0 to 2"]),
        (["decay", "model", "--doubled-at", "-1"], ["doubled at", "give positive numbers"]),
    ],
)
def test_bad_input_is_one_clear_line(app: typer.Typer, arguments: list[str], words: list[str]) -> None:
    command, brake, *rest = arguments
    result = CliRunner().invoke(app, [command, str(BRAKES / f"{brake}.toml"), *rest])
    assert isinstance(result.exception, ConfigError)
    assert all(word in str(result.exception) for word in words), str(result.exception)

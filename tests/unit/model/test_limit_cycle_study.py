"""`rigctl model squeal`: facts, tables and figures; the rig's sound; bad input in a line."""

import json
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from rigctl.app.model import limit_cycle as command
from rigctl.core.errors import ConfigError
from rigctl.model.limit_cycle import Radiation, level_db, read_radiation, squeal_study
from rigctl.model.loading import read_brake
from rigctl.model.output import write

ROOT = Path(__file__).parents[3]
BRAKE, PLANT = ROOT / "configs" / "brakes" / "plant.toml", ROOT / "configs" / "plants" / "a_class.toml"


def app() -> typer.Typer:
    made = typer.Typer()
    command.register(made)
    made.command("other")(lambda: None)
    return made


def test_study_with_ramps_and_sound(tmp_path: Path) -> None:
    study = squeal_study(
        read_brake(BRAKE), "pressure", np.linspace(8.0, 20.0, 7), radiation=read_radiation(PLANT), ramp=True,
        durations_s=(0.4, 0.8), longest_s=1.0,
    )  # fmt: skip
    facts = study.facts
    assert facts["onset_by_eigenvalues_bar"] == pytest.approx(12.0, abs=0.02)
    assert facts["onset_seen_in_time_bar"] == pytest.approx(12.0, abs=0.1)
    assert "supercritical" in facts["verdict"]
    branch = study.table("branches")
    assert len(branch) == 7
    levels = np.array(branch.column("large_level"), dtype=float)
    assert np.isnan(levels[:2]).all() and (np.diff(levels[3:]) > 0.0).all()
    assert 80.0 < levels[-1] < 100.0  # the plant file: 65 to 100 dB
    assert set(study.figures) == {"bifurcation", "ramps"}
    assert len(study.table("ramps")) == 4
    paths = write(study, tmp_path, ("png", "svg", "csv", "json"))
    assert {path.name for path in paths} >= {
        "squeal_bifurcation.png",
        "squeal_ramps.svg",
        "squeal_branches.csv",
    }


def test_sound_is_that_of_the_simulated_rig(tmp_path: Path) -> None:
    """The rig's own integrator with its own weights at a constant working point: the same level."""
    from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator

    radiation, brake = read_radiation(PLANT), read_brake(BRAKE)
    study = squeal_study(brake, "pressure", [18.0], radiation=radiation, longest_s=2.0)
    level = study.table("branches").column("large_level")[0]
    assert len(write(study, tmp_path, ("png",))) == 1  # a single value can be drawn
    integrator = SquealIntegrator(
        brake, outputs=list(radiation.weights_pa_s2_m), weights=list(radiation.weights_pa_s2_m.values())
    )
    integrator.state = np.concatenate([np.zeros(14), np.full(14, 0.01)])
    force, slip = brake.pad_force_n(18e5), study.facts["sliding_speed_m_s"]
    sound = integrator.advance(
        60_000, normal_force_n=(force, force), mu=(brake.mu, brake.mu), slip_m_s=(slip, slip),
        k_s_m=(brake.slope_s_m, brake.slope_s_m), saturation_m_s=radiation.saturation_m_s,
    )  # fmt: skip
    assert level == pytest.approx(float(level_db(sound[-4000:].std())), abs=0.01)


def test_command_writes_files_and_says_what_it_found(tmp_path: Path) -> None:
    options = ["--over", "pressure:10:16:4", "--longest", "0.5", "--out", str(tmp_path), "--linear"]
    result = CliRunner().invoke(app(), ["squeal", str(BRAKE), *options])
    assert result.exit_code == 0, result.output
    assert "onset by eigenvalues bar: 12" in result.output
    facts = json.loads((tmp_path / "squeal.json").read_text())["facts"]
    assert facts["verdict"].startswith("sudden") and facts["plant"] is None
    assert (tmp_path / "squeal_bifurcation.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("arguments", "place"),
    [
        (["model.npz"], "MODEL"),
        ([str(BRAKE), "--over", "m_disc:4:6:3", "--ramp"], "--over"),
        ([str(BRAKE), "--set", "pressure=3"], "--set"),
        ([str(BRAKE), "--over", "m_disk:4:6:3"], "plant.toml"),
        ([str(BRAKE), "--plant", "nowhere.toml"], "nowhere"),
        ([str(BRAKE), "--over", "pressure:0:30:3000"], "2000 at most"),
        ([str(BRAKE), "--over", "pressure:-5:30:10"], "pressure must be"),
    ],
)
def test_bad_input_is_one_clear_error(arguments: list[str], place: str) -> None:
    result = CliRunner().invoke(app(), ["squeal", *arguments])
    assert isinstance(result.exception, ConfigError) and place in str(result.exception), result.exception


def test_a_plant_that_radiates_from_elsewhere_is_refused() -> None:
    with pytest.raises(KeyError, match=r"wheel\.y"):
        squeal_study(read_brake(BRAKE), "pressure", [10.0], radiation=Radiation("other", {"wheel.y": 1.0}))


def test_levels() -> None:
    assert level_db([20e-6, 0.02, 0.0])[:2] == pytest.approx([0.0, 60.0]) and np.isnan(level_db(0.0))

"""The shipped programs load, are what they say, and run on the paper's rig."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest
from pydantic import ValidationError

from rigctl.config.loading import load_model
from rigctl.config.rig import RigConfig
from sequences import Braking, Program, dump_program, load_program
from sequences.braking import AXES
from sequences.capabilities import RigCapabilities
from sequences.check import check_program
from sequences.estimate import loop_order_durations

COUNTS = {
    "dialog_fig5": {"Matrix": 25},
    "friction_map": {"bedding": 30, "constant temperature": 90, "constant pressure": 0},
    "quick_check": {"quick": 6},
    "short_matrix": {"short": 6},
    "squeal_matrix": {"bedding": 30, "matrix": 225},
    "stop_brakings": {"stops": 24, "accelerated": 4},
}


def brakings_of(path: Path, sequence: str) -> list[Braking]:
    return [b for b in load_program(path).brakings() if b.sequence == sequence]


def test_every_shipped_program_is_listed_here(program_folder: Path) -> None:
    assert {path.stem for path in program_folder.glob("*.toml")} == set(COUNTS)


@pytest.mark.parametrize("name", COUNTS)
def test_shipped_program(program_folder: Path, configs: Path, name: str) -> None:
    program = load_program(program_folder / f"{name}.toml")
    rig = load_model(configs / "rigs" / "simulated.toml", RigConfig)
    result = check_program(program, rig.capabilities)
    assert program.name == name
    assert result.problems == ()
    assert result.n_by_sequence == COUNTS[name]
    assert program.count == sum(COUNTS[name].values()) == len(list(program.brakings()))
    assert Program.model_validate(tomllib.loads(dump_program(program))) == program


def test_squeal_matrix_is_the_experiment_of_section_5_3(program_folder: Path) -> None:
    matrix = brakings_of(program_folder / "squeal_matrix.toml", "matrix")
    assert len(matrix) == 225
    assert len({(b.temperature_degc, b.pressure_bar) for b in matrix}) == 225
    temperatures_degc = [b.temperature_degc for b in matrix]
    assert temperatures_degc == sorted(t for t in range(30, 311, 20) for _ in range(15))
    assert [b.pressure_bar for b in matrix] == list(range(2, 31, 2)) * 15
    for braking in matrix:
        assert (braking.min_pressure_bar, braking.max_pressure_bar) == (braking.pressure_bar,) * 2
        assert (braking.speed_setpoint_rpm(0.0), braking.speed_setpoint_rpm(12.0)) == (40.0, 40.0)
        assert braking.duration_s == 12.0
        assert braking.recording.stored_rate_hz("microphone") == 40000.0
        assert braking.recording.stored_rate_hz("torque") == 1000.0
        assert not braking.ventilator


def test_squeal_matrix_beds_in_first_without_sound(program_folder: Path) -> None:
    program = load_program(program_folder / "squeal_matrix.toml")
    first = list(program.brakings())[:30]
    assert {b.role for b in first} == {"bedding"}
    assert all("microphone" not in b.recording.names for b in first)


def test_squeal_matrix_runs_in_the_quickest_loop_order(program_folder: Path, rig: RigCapabilities) -> None:
    program = load_program(program_folder / "squeal_matrix.toml")
    durations = loop_order_durations(program, "matrix", rig)
    assert program.sequences[1].loop_order == AXES
    assert durations[AXES].total_s == min(d.total_s for d in durations.values())
    # The file's comment: about twice as long the other way round.
    ratio = durations[("pressure", "speed", "temperature")].total_s / durations[AXES].total_s
    assert 1.6 < ratio < 2.5


def test_quick_check_brakes_below_and_above_the_onset_of_squeal(program_folder: Path) -> None:
    pressures = {b.pressure_bar for b in brakings_of(program_folder / "quick_check.toml", "quick")}
    assert min(pressures) < 9.0
    assert sum(p >= 20.0 for p in pressures) == 2


def test_stop_brakings_run_from_200_to_0_in_12_s(program_folder: Path) -> None:
    for braking in brakings_of(program_folder / "stop_brakings.toml", "stops"):
        assert [braking.speed_setpoint_rpm(t) for t in (0.0, 6.0, 12.0)] == [200.0, 100.0, 0.0]


def test_dialog_ramps_around_the_working_point(program_folder: Path) -> None:
    first = brakings_of(program_folder / "dialog_fig5.toml", "Matrix")[1]
    assert [first.pressure_setpoint_bar(t) for t in (0.0, 5.0, 10.0)] == [5.0, 10.0, 15.0]
    assert (first.limits.max_degc, first.limits.cool_down_degc) == (500.0, 480.0)


def test_loading_lets_the_errors_out(tmp_path: Path) -> None:
    path = tmp_path / "bad.toml"
    with pytest.raises(FileNotFoundError):
        load_program(path)
    path.write_text("name = ")
    with pytest.raises(tomllib.TOMLDecodeError):
        load_program(path)
    path.write_text('name = "empty"\nsequences = []\n')
    with pytest.raises(ValidationError, match="zero brakings"):
        load_program(path)

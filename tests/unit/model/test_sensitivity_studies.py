"""Sensitivity studies and their commands: facts, tables, figures, errors; figures 8, 9, 10 by their
numbers.
"""

import json
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from rigctl.app.model import sensitivity as family
from rigctl.core.errors import ConfigError
from rigctl.model.advice import recommendation_study
from rigctl.model.loading import read_model
from rigctl.model.output import write
from rigctl.model.sensitivity import design, influence_study, robustness_study, sensitivity_study
from rigctl.model.sensitivity_paper import figure_8_study, figure_9_study, figure_10_study
from sim_hardware.brake_model.foreign.files import save_matrices
from sim_hardware.brake_model.linear import value_of

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
FILE = BRAKES / "model.toml"
MODEL = read_model(FILE)


def run(*arguments: object):
    app = typer.Typer()
    family.register(app)
    return CliRunner().invoke(app, [str(a) for a in arguments], env={"COLUMNS": "250"})


@pytest.fixture(scope="module")
def foreign(tmp_path_factory) -> Path:
    """The brake as matrices made elsewhere, with parts that scale with mu and with pressure."""
    path = tmp_path_factory.mktemp("foreign") / "brake.npz"
    zero, one = MODEL.matrices({"mu": 0.0}), MODEL.derivative("mu", {"mu": 0.0})
    falling = MODEL.derivative("pressure", {"slope": 1.0}).damping
    save_matrices(
        path,
        {"M": zero.mass, "D": zero.damping, "K": zero.stiffness, "K_mu": one.stiffness, "D_mu": one.damping,
         "D_k_p": falling},
        {"mu": 0.4, "slope": 0.0576, "pressure": 0.0},
    )  # fmt: skip
    return path


def test_sensitivity_finds_the_pair_and_ranks_by_real_part() -> None:
    study = sensitivity_study(MODEL, {"pressure": 15.0}, near_hz=2100.0)
    assert study.facts["pair"] == 5 and study.facts["frequency_hz"] == pytest.approx(2140.0, abs=0.1)
    assert study.facts["strongest"] in {"pressure", "slope", "piston_area"}
    ranking = study.table("ranking")
    sizes = np.abs(np.array(ranking.column("real_part")))
    assert np.all(np.diff(sizes) <= 0.0)
    row = ranking.column("quantity").index("c_abu_t")
    per_unit = study.table("per_unit")
    again = per_unit.column("quantity").index("c_abu_t")
    expected = per_unit.column("real_part")[again] * 0.01 * MODEL.quantities["c_abu_t"].value
    assert ranking.column("real_part")[row] == pytest.approx(expected)
    assert len(study.table("all").columns) == 1 + 2 * 14


def test_sensitivity_default_is_the_pair_nearest_to_instability() -> None:
    assert sensitivity_study(MODEL).facts["frequency_hz"] == pytest.approx(688.4, abs=0.1)
    assert sensitivity_study(MODEL, {"pressure": 20.0}).facts["frequency_hz"] == pytest.approx(
        2140.0, abs=0.1
    )


@pytest.mark.parametrize(
    ("choice", "message"),
    [({"pair": 15}, "1 to 14"), ({"pair": 0}, "1 to 14"), ({"pair": 1, "near_hz": 5.0}, "not both"),
     ({"near_hz": -3.0}, "not negative")],
)  # fmt: skip
def test_sensitivity_refuses_pairs_that_are_not_there(choice, message) -> None:
    with pytest.raises(ValueError, match=message):
        sensitivity_study(MODEL, **choice)


def test_other_parameter_values_reach_the_places_that_modifications_multiply() -> None:
    changed, rest = design(MODEL, {"x_pis": 0.02, "mu": 0.5})
    assert rest == {"mu": 0.5}
    assert value_of(changed, "inner_pad.piston_l.x") == -0.02
    study = influence_study(MODEL, ["piston_position"], {"x_pis": 0.02})
    plain = influence_study(MODEL, ["piston_position"])
    assert study.table("effects").column("sum")[0] != pytest.approx(
        plain.table("effects").column("sum")[0], rel=0.01
    )


def test_figure_8_has_the_papers_setting_and_our_numbers() -> None:
    study = figure_8_study(MODEL)
    paper = {row[0]: row[1:] for row in study.table("paper").rows()}
    assert paper["sensitivity values"][1:3] == (28, 28)
    assert paper["values equal in pairs"] == ("", "yes", "yes", None, "yes")
    assert study.facts["maximum_basic_design_1_s"] == pytest.approx(19.02, abs=0.01)
    assert study.facts["maximum_below_5_khz_1_s"] == pytest.approx(0.440, abs=0.001)
    assert study.facts["pairs_that_lose_damping"] == 4 and abs(study.facts["sum_of_all_values_1_s"]) < 1e-6
    assert len(study.table("basic")) == 28


def test_figure_9_shows_ten_of_more_than_100_modifications() -> None:
    study = figure_9_study(MODEL)
    assert study.facts["modifications"] > 100 and study.facts["modifications_shown"] == 10
    table = study.table("modifications")
    assert len(table) == study.facts["modifications"]
    first = table.rows()[0]
    assert "contact points, shifted" in first[0] and first[1] == pytest.approx(368.2, abs=0.1)
    assert all(table.column("identity_sure"))


def test_figure_10_is_the_piston_group() -> None:
    facts = figure_10_study(MODEL).facts
    assert facts["piston_stiffness_increase"]["largest_1_s"] == pytest.approx(7.03, abs=0.01)
    assert facts["piston_position_clockwise"]["largest_1_s"] == pytest.approx(-9.03, abs=0.01)
    assert facts["piston_position_increase"]["sum_1_s"] == pytest.approx(-36.04, abs=0.01)
    assert "monodirectional" in facts["piston_position_increase"]["classes"]
    assert "broad band" not in facts["piston_position_clockwise"]["classes"]


def test_all_figures_can_be_drawn_and_files_read_back(tmp_path: Path) -> None:
    studies = [
        sensitivity_study(MODEL),
        robustness_study(MODEL),
        influence_study(MODEL, ["tie"]),
        recommendation_study(MODEL, groups=["pad", "tie"]),
    ]
    for study in studies:
        files = {path.name: path for path in write(study, tmp_path, ("png", "csv", "json"))}
        assert len([name for name in files if name.endswith(".png")]) == len(study.figures) >= 1
        assert json.loads(files[f"{study.name}.json"].read_text())["facts"].keys() == study.facts.keys()


def test_recommendations_in_words() -> None:
    study = recommendation_study(MODEL, groups=["pad_mass", "abutment_damping"])
    assert study.facts["best"].startswith("Pads: mass, −10 %: lowers the real parts below 5 kHz by 57.4 1/s")
    assert study.facts["recommended"] == 2
    assert (
        study.table("in_words")
        .rows()[1][1]
        .endswith("makes no mode worse; moves the onset from 15.00 to 15.35 bar")
    )


@pytest.mark.parametrize(
    "arguments",
    [
        ["sensitivity", FILE, "--near", 2140, "--set", "pressure=15"],
        ["robustness", FILE, "--step", 5],
        ["robustness", FILE, "--band", "2000:2300"],
        ["influence", FILE, "--group", "piston", "--mode", "increase"],
        ["recommend", FILE, "--group", "finger", "--friction", "0.4,0.6"],
    ],
)
def test_commands_run_on_the_shipped_brake(arguments) -> None:
    result = run(*arguments)
    assert result.exit_code == 0, result.output
    assert "model:" in result.output


def test_influence_command_names_classes_of_the_piston_group() -> None:
    output = run("influence", FILE, "--group", "piston_stiffness", "--mode", "increase").output
    assert "narrow band; mode coupling; bidirectional" in output and "7673/8048" in output


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["influence", FILE, "--group", "pistn"], "no group 'pistn'; it has: contact_stiffness"),
        (["influence", FILE, "--mode", "up"], "no such mode"),
        (["sensitivity", FILE, "--pair", 99], "pairs 1 to 14"),
        (["recommend", FILE, "--friction", "a"], "not a list of numbers"),
        (["robustness", FILE, "--from", 0.6, "--to", 0.5], "larger than the first"),
        (["sensitivity", FILE, "--set", "c_con_li=3"], "c_con_il"),
    ],
)
def test_wrong_input_gives_one_clear_error(arguments, message) -> None:
    result = run(*arguments)
    assert isinstance(result.exception, ConfigError), result.output
    assert message in str(result.exception)


def test_models_made_elsewhere_give_the_same_eigenvalues_and_use_parts_as_groups(foreign: Path) -> None:
    model = read_model(foreign)
    ours, theirs = robustness_study(MODEL), robustness_study(model)
    for key in ("maximum_basic_design_1_s", "maximum_below_5_khz_1_s"):
        assert theirs.facts[key] == pytest.approx(ours.facts[key], rel=1e-6)
    assert theirs.facts["modifications"] == 12
    found = sensitivity_study(model, {"pressure": 15.0}, near_hz=2140.0)
    assert {"part.K_mu", "pressure", "mu"} <= set(found.table("ranking").column("quantity"))
    for command in ("sensitivity", "robustness", "influence", "recommend"):
        assert run(command, foreign).exit_code == 0
    best = recommendation_study(model).facts
    assert best["onset_bar"] == pytest.approx(15.0016, abs=1e-3)

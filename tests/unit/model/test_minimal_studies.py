"""Studies of the minimal models: numbers of Figs 1a and 1b, files, commands, messages."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from rigctl.analysis.style import drawing
from rigctl.app.model import minimal as commands
from rigctl.core.errors import ConfigError
from rigctl.model.minimal import (
    BELT,
    COULOMB,
    PAD,
    SPRAG,
    belt_study,
    cases_study,
    figure_1a_study,
    figure_1b_study,
    sprag_study,
    two_dof_study,
)
from rigctl.model.output import Study, write
from sim_hardware.brake_model.minimal.cases import FOLDER, load_case, shipped_cases
from sim_hardware.brake_model.minimal.laws import LinearFallingLaw


@pytest.fixture(scope="module")
def figure_1a() -> Study:
    return figure_1a_study()


@pytest.fixture(scope="module")
def figure_1b() -> Study:
    return figure_1b_study()


def path_of(study: Study, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities of one trajectory of the table."""
    table = study.table("trajectories")
    chosen = np.array(table.column("trajectory")) == name
    return np.array(table.column("position"))[chosen], np.array(table.column("velocity"))[chosen]


def test_figure_1a_inside_diverges_outside_contracts_onto_stick_slip(figure_1a: Study) -> None:
    facts = figure_1a.facts
    assert facts["equilibrium_unstable"] and facts["damping_ratio_D"] == pytest.approx(-0.076809, abs=1e-6)
    assert facts["stick_slip_frequency_hz"] == pytest.approx(2037.729, abs=1e-3)
    assert figure_1a.table("regions").column("behaviour")[:2] == ["diverging", "contracting"]
    assert figure_1a.table("cycles").column("kind") == ["stick-slip", "reversing"]
    assert figure_1a.table("cycles").column("stable") == [True, False]
    rest, radius = facts["equilibrium_um"], figure_1a.table("cycles").column("turning point")[0]
    inside, _ = path_of(figure_1a, "from inside")
    turns = inside[1:-1][(inside[1:-1] > inside[:-2]) & (inside[1:-1] > inside[2:])] - rest
    assert np.all(np.diff(turns) > 0.0) and turns.max() <= radius * 1.01
    outside, velocity = path_of(figure_1a, "from outside")
    assert outside[0] - rest == pytest.approx(1.6 * radius)
    assert velocity[-1] == pytest.approx(BELT.belt_speed_m_s)  # it sticks: it is on the cycle
    ring, ring_velocity = path_of(figure_1a, f"stick-slip cycle {radius:.4g} µm")
    assert (ring[0], ring_velocity[0]) == pytest.approx((ring[-1], ring_velocity[-1]), abs=1e-9)
    assert ring_velocity.max() == pytest.approx(BELT.belt_speed_m_s)


def test_figure_1a_compares_every_statement_with_the_paper(figure_1a: Study) -> None:
    table = figure_1a.table("paper")
    assert {"quantity", "unit", "paper", "ours", "deviation"} <= {c.name for c in table.columns}
    assert len(table) == 5 and all(table.column("holds"))
    assert figure_1a.facts["linear_spread_up_to_there_percent"] < 1e-9
    assert figure_1a.facts["linear_one_way_up_to_m_s"] == pytest.approx(0.21127, abs=1e-5)
    assert figure_1a.facts["coulomb_frequency_spread_percent"] == pytest.approx(31.578, abs=1e-2)
    assert figure_1a.facts["coulomb_speed_of_strong_dependence_m_s"] == pytest.approx(
        0.1 * 3435 / 13416.4, rel=1e-5
    )
    coulomb = next(row for row in table.rows() if row[0].endswith("Coulomb"))
    assert "at 0.44 m/s (40 1/min) 2135.2 Hz" in coulomb[3]  # hardly any dependence where brakes squeal


def test_growth_per_turn_is_that_of_the_eigenvalue(figure_1a: Study) -> None:
    turns = figure_1a.table("turns")
    ratio = np.array(turns.column("next amplitude")) / np.array(turns.column("amplitude"))
    assert ratio[:20] == pytest.approx(np.full(20, figure_1a.facts["growth_per_turn"]), rel=1e-9)


def test_figure_1b_shows_mode_coupling(figure_1b: Study) -> None:
    facts = figure_1b.facts
    assert facts["first_instability"] == "flutter"
    assert facts["critical_mu"] == pytest.approx(0.47149, abs=1e-5)
    assert facts["critical_frequency_hz"] == pytest.approx(2379.13, abs=0.01)
    locus = figure_1b.table("locus")
    mus = np.array(locus.column("mu"))
    gap = np.abs(np.array(locus.column("frequency 1")) - np.array(locus.column("frequency 2")))
    real = np.array([locus.column("real part 1"), locus.column("real part 2")])
    before = mus < 0.46
    assert np.all(np.diff(gap[before]) < 0.0) and gap[mus > 0.5].max() < 1.0  # they grow closer, and meet
    assert np.ptp(real[:, before], axis=0).max() < 5.0
    after = mus > facts["critical_mu"]
    assert np.all(real.max(axis=0)[after] > 0.0) and np.all(real.max(axis=0)[~after] < 0.0)
    assert np.all(np.diff(real.max(axis=0)[after]) > 0.0) and np.all(np.diff(real.min(axis=0)[after]) < 0.0)
    table = figure_1b.table("boundaries")
    border = {
        table.column("expression")[i] for i in range(len(table)) if table.column("border of stability")[i]
    }
    assert border == {"H3"}
    assert dict(zip(table.column("expression"), table.column("role"), strict=True))["a0"] == "divergence"


def test_figure_1b_says_that_the_printed_expression_is_not_flutter(figure_1b: Study) -> None:
    rows = {row[0]: row for row in figure_1b.table("paper").rows()}
    assert rows["Hurwitz expressions in mu"][3] == "5: a0, a1, a2, H2, H3"
    assert rows["the expression printed in Table 1"][-1] == "no"
    assert "det C" in figure_1b.facts["verdict"]


def test_sprag_study_agrees_with_its_eigenvalues() -> None:
    study = sprag_study()
    assert study.facts["largest_damping_ratio_error_on_the_boundary"] < 1e-12
    assert study.facts["d1_over_d2_needed_at_mu_0.4"] == pytest.approx(25.963, abs=1e-3)
    table = study.table("criterion")
    angles, mu = np.array(table.column("angle")), np.array(table.column("critical mu"))
    finite = np.isfinite(mu)
    assert mu[finite] == pytest.approx(-mu[::-1][finite])
    assert np.all(np.sign(mu[finite]) == np.sign(angles[finite]))
    assert all(study.table("paper").column("holds"))


def test_all_files_are_written_and_readable(figure_1a: Study, figure_1b: Study, tmp_path: Path) -> None:
    for study in (figure_1a, figure_1b, sprag_study(), cases_study(shipped_cases()[:1])):
        drawn = ("png", "svg") if study is figure_1b else ()
        paths = write(study, tmp_path / study.name, ("csv", "parquet", "json", *drawn))
        assert {p.suffix for p in paths} == {".csv", ".parquet", ".json", *(f".{f}" for f in drawn)}
        assert json.loads((tmp_path / study.name / f"{study.name}.json").read_text())["facts"]
    with (tmp_path / "figure_1b" / "figure_1b_locus.csv").open() as file:
        assert next(csv.reader(file))[0] == "mu"


@pytest.mark.parametrize(
    "belt",
    [
        BELT.changed(law=COULOMB, damping_ns_m=60.0, belt_speed_m_s=0.05),
        BELT.changed(damping_ns_m=60000.0),
        BELT.changed(law=LinearFallingLaw(mu_static=0.5, slope_s_m=9.0), belt_speed_m_s=0.04),
        BELT.changed(normal_force_n=0.0),
    ],
    ids=["jump", "creeping", "runaway", "no friction"],
)
def test_any_belt_can_be_drawn(belt) -> None:
    """Whatever the phase plane holds, the study says so and its figures are drawn."""
    study = belt_study(belt, laws=(belt.law,), points=2)
    with drawing():
        for draw in study.figures.values():
            draw().draw_without_rendering()  # lays out every text, tick and line
    assert study.table("regions").column("from")[0] == 0.0


@pytest.mark.parametrize(
    "name", ["hulten", "hulten_damped", "hoffmann", "paper_divergence", "falling_two_masses"]
)
def test_case_files_are_studied_like_our_own_model(name: str) -> None:
    case = load_case(FOLDER / f"{name}.toml")
    study = two_dof_study(case, mu_max=3.0, points=301)
    expected = next(e.value for e in case.expect if e.quantity == "critical_mu")
    assert study.facts["critical_mu"] == pytest.approx(expected, rel=1e-9)
    assert study.facts["model"] == name


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: belt_study(BELT.changed(belt_speed_m_s=0.9)), "belt_speed_m_s = 0.9.*negative mu.*Give"),
        (lambda: belt_study(speeds_m_s=(1.0, 0.1)), "speeds = 1 … 0.1.*Give two rising"),
        (lambda: belt_study(points=1), "in 1 points"),
        (lambda: sprag_study(mu_max=0.0), "mu_max = 0"),
        (lambda: sprag_study(SPRAG.model_copy(update={"disc_damping_ns_m": 0.0})), "disc damping d1 = 0"),
        (lambda: two_dof_study(PAD, mu_max=math.inf), "mu_max = inf"),
    ],
)
def test_nonsense_is_refused_by_name(call, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        call()


@pytest.fixture
def run():
    app = typer.Typer()
    app.callback()(lambda: None)
    commands.register(app)
    return lambda *words: CliRunner().invoke(app, ["minimal", *map(str, words)], env={"COLUMNS": "200"})


def test_commands_print_and_write(run, tmp_path: Path) -> None:
    result = run("two-dof", "--d2", 0.14, "--points", 101, "--out", tmp_path, "--format", "json,csv")
    assert result.exit_code == 0, result.output
    assert "flutter" in result.output and "0.45917" in result.output
    assert (tmp_path / "two_dof_boundaries.csv").exists()
    result = run("belt", "--speeds", "0.05:0.2", "--points", 3, "--law", "coulomb")
    assert result.exit_code == 0 and "stick-slip" in result.output
    result = run("sprag", "--angle", -10)
    assert result.exit_code == 0 and "-0.293279" in result.output
    result = run("two-dof", "--case", FOLDER / "hoffmann.toml", "--points", 11)
    assert result.exit_code == 0 and "0.75" in result.output


def test_cases_command_fails_when_a_number_is_missed(run, tmp_path: Path) -> None:
    good = FOLDER / "hoffmann.toml"
    assert run("cases", good).exit_code == 0
    wrong = tmp_path / "wrong.toml"
    wrong.write_text(good.read_text().replace("value = 0.75", "value = 0.76"))
    result = run("cases", wrong)
    assert result.exit_code == 1 and "no" in result.output


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("belt", "--mass", "0"), "mass_kg = 0.*more than 0"),
        (("belt", "--mu-dynamic", "0.7"), "mu_dynamic = 0.7 is larger than mu_static = 0.5"),
        (("belt", "--stiffness", "0"), "stiffness_n_m = 0.*Give"),
        (("belt", "--belt-speed", "0"), "belt_speed_m_s = 0.*Give"),
        (("belt", "--speeds", "quick"), "--speeds.*LOW:HIGH"),
        (("sprag", "--angle", "95"), "--angle 95.*between"),
        (("two-dof", "--c2", "nan"), "c2 = nan.*finite"),
        (("two-dof", "--case", "nowhere.toml"), "nowhere.toml: no such file"),
        (("two-dof", "--case", FOLDER / "coulomb_stick_slip.toml"), "not a 2-DOF system"),
    ],
)
def test_wrong_options_give_one_clear_line(run, words, message: str) -> None:
    result = run(*words)
    assert isinstance(result.exception, ConfigError)
    assert "\n" not in str(result.exception)
    with pytest.raises(ConfigError, match=message):
        raise result.exception

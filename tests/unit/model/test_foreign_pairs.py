"""`rigctl model pairs`: facts, table, figure and files for brake files and matrices made elsewhere; clear
errors.
"""

import json
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from rigctl.analysis.style import drawing
from rigctl.app.model import pairs as command
from rigctl.core.errors import ConfigError
from rigctl.model.foreign import pairs_study
from rigctl.model.loading import read_model
from sim_hardware.brake_model.foreign.files import save_matrices
from sim_hardware.brake_model.foreign.matrix_model import MatrixModel

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
FLUTTER = {
    "M": np.eye(2),
    "K": np.array([[4e6, 0.0], [0.0, 4.4e6]]),
    "K_mu": np.array([[0.0, 1e6], [-1e6, 0.0]]),
}


@pytest.fixture
def app() -> typer.Typer:
    app = typer.Typer()
    command.register(app)
    app.command("other")(lambda: None)
    return app


def test_foreign_copy_of_the_brake_gives_the_same_pairs(tmp_path: Path) -> None:
    """The shipped brake, exported as M, D, K with parts, studied from its file."""
    brake = read_model(BRAKES / "basic.toml")
    at = brake.matrices({"mu": 0.0, "slope": 0.0})
    by_mu = brake.derivative("mu")
    falling = brake.derivative("pressure", {"slope": 1.0})
    save_matrices(
        tmp_path / "copy.npz",
        {"M": at.mass, "D": at.damping, "K": at.stiffness, "K_mu": by_mu.stiffness, "D_mu": by_mu.damping,
         "D_k_p": falling.damping},
        {"mu": 0.4, "k": 0.0, "p": 0.0},
        freedoms=brake.freedoms,
    )  # fmt: skip
    copy = read_model(tmp_path / "copy.npz")
    assert copy.freedoms == brake.freedoms
    values = {"mu": 0.66, "slope": 0.05, "pressure": 12.0}
    ours, theirs = (pairs_study(model, values).table("pairs") for model in (brake, copy))
    for name in ("frequency", "damping_ratio", "real_part"):
        np.testing.assert_allclose(theirs.column(name), ours.column(name), rtol=1e-9)


def test_facts_of_the_basic_brake() -> None:
    study = pairs_study(read_model(BRAKES / "basic.toml"), {"mu": 0.66})
    assert study.facts["degrees_of_freedom"] == study.facts["eigenvalues_with_frequency"] == 14
    assert study.facts["unstable"] == 1
    assert study.facts["least_damped_hz"] == pytest.approx(2402.65, abs=0.01)
    assert study.facts["complete"] == "yes"
    assert study.title == "basic: unstable: 2402.7 Hz"
    assert study.facts["working_point"] == "mu = 0.66, slope = 0 s/m, pressure = 0 bar"
    inside = pairs_study(read_model(BRAKES / "basic.toml"), {"mu": 0.66}, (1000.0, 3000.0)).table("pairs")
    frequencies = np.array(study.table("pairs").column("frequency"))
    np.testing.assert_array_equal(
        inside.column("frequency"), frequencies[(frequencies > 1000) & (frequencies < 3000)]
    )


def test_figure_shows_every_eigenvalue() -> None:
    study = pairs_study(MatrixModel("flutter", FLUTTER, {"mu": 0.5}))
    table = study.table("pairs")
    assert sum(table.column("unstable")) == 1
    with drawing():
        figure = study.figures["plane"]()
    (axes,) = figure.axes
    drawn = np.concatenate(
        [line.get_xydata() for line in axes.lines if len(line.get_xydata()) and line.get_marker() in "oD"]
    )
    expected = np.column_stack([table.column("real_part"), np.array(table.column("frequency")) / 1e3])
    np.testing.assert_allclose(np.sort(drawn, axis=0), np.sort(expected, axis=0))
    assert [text.get_text() for text in axes.texts] == [
        f"{max(zip(table.column('real_part'), table.column('frequency'), strict=True))[1]:.1f} Hz"
    ]


def test_nearly_coinciding_pairs_are_called_so() -> None:
    """At mu = 0.2 the two undamped modes meet: a defective pair."""
    met = pairs_study(MatrixModel("flutter", FLUTTER, {"mu": 0.2}))
    assert "not to be trusted" in str(met.facts["caution"])
    assert "caution" not in pairs_study(MatrixModel("flutter", FLUTTER, {"mu": 0.1})).facts


def test_command_prints_and_writes(app: typer.Typer, tmp_path: Path) -> None:
    save_matrices(tmp_path / "flutter.npz", FLUTTER, {"mu": 0.1})
    out = tmp_path / "out"
    arguments = [
        "pairs",
        str(tmp_path / "flutter.npz"),
        "--set",
        "mu=0.5",
        "--band",
        "100:1000",
        "--out",
        str(out),
    ]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    assert "flutter: unstable: 326." in result.output
    assert {path.name for path in out.iterdir()} == {
        "pairs.json", "pairs_pairs.csv", "pairs_plane.png", "pairs_plane.svg"
    }  # fmt: skip
    facts = json.loads((out / "pairs.json").read_text())["facts"]
    assert facts["unstable"] == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--band", "5000"], "--band 5000: is not FROM:TO"),
        (["--band", "5000:1000"], "FROM < TO"),
        (["--band", "1000:inf"], "FROM < TO"),
        (["--set", "nu=1"], "no quantity 'nu'; did you mean mu"),
        (["--set", "mu=-1"], "mu = -1: give a value that is not negative"),
        (["--damping-max", "7"], "largest damping ratio is 7.0"),
    ],
)
def test_wrong_options_say_what_to_do(
    app: typer.Typer, tmp_path: Path, arguments: list[str], message: str
) -> None:
    save_matrices(tmp_path / "flutter.npz", FLUTTER, {"mu": 0.1})
    result = CliRunner().invoke(app, ["pairs", str(tmp_path / "flutter.npz"), *arguments])
    assert isinstance(result.exception, ConfigError)
    assert message in str(result.exception)


def test_wrong_files_say_what_to_do(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="no such file"):
        read_model(tmp_path / "none.npz")
    np.savez(tmp_path / "half.npz", M=np.eye(2))
    with pytest.raises(ConfigError, match=r"half\.npz: the matrix K is missing"):
        read_model(tmp_path / "half.npz")


def test_reduce_writes_a_small_model_and_says_how_good_it_is(app: typer.Typer, tmp_path: Path) -> None:
    n = 320
    chain = 1e9 * (np.diag(np.full(n, 2.0)) - np.diag(np.ones(n - 1), 1) - np.diag(np.ones(n - 1), -1))
    rub = np.zeros((n, n))
    rub[10, 11], rub[11, 10] = 1e8, -1e8
    save_matrices(tmp_path / "large.npz", {"M": np.eye(n), "K": chain, "K_mu": rub}, {"mu": 0.4})
    small = tmp_path / "small.npz"
    arguments = [
        "reduce",
        str(tmp_path / "large.npz"),
        str(small),
        "--band",
        "100:700",
        "--at",
        "mu=0",
        "--at",
        "mu=1",
    ]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    assert "small: " in result.output and "instead of 320 degrees of freedom" in result.output
    before, after = (
        pairs_study(read_model(path), {"mu": 1.0}, (100.0, 700.0)).table("pairs").column("frequency")
        for path in (tmp_path / "large.npz", small)
    )
    np.testing.assert_allclose(after, before, rtol=1e-6)


def test_reduce_refuses_a_brake_file(app: typer.Typer, tmp_path: Path) -> None:
    result = CliRunner().invoke(
        app, ["reduce", str(BRAKES / "basic.toml"), str(tmp_path / "s.npz"), "--band", "1:2"]
    )
    assert isinstance(result.exception, ConfigError)
    assert "small already" in str(result.exception)

"""The brake as a drawing: bodies where their points say, rigid motion, figures, animations, command line."""

import io
import json
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import typer
from PIL import Image
from typer.testing import CliRunner

from rigctl.app.model import modes as command
from rigctl.core.errors import ConfigError
from rigctl.model.brake_drawing import Drawing, displaced, draw_brake, scale_for
from rigctl.model.brake_painting import animated_gif
from rigctl.model.loading import read_model
from rigctl.model.modes import animate, modes_study, motions_of, page
from rigctl.model.output import write
from sim_hardware.brake_model.assembly import Brake
from sim_hardware.brake_model.eigen.mode_shapes import find_shape, mode_shapes
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.spec import BrakeSpec

BRAKES = Path(__file__).parents[3] / "configs/brakes"


@pytest.fixture(scope="module")
def model() -> LinearBrake:
    loaded = read_model(BRAKES / "basic.toml")
    assert isinstance(loaded, LinearBrake)
    return loaded


@pytest.fixture(scope="module")
def picture(model: LinearBrake) -> Drawing:
    return draw_brake(model)


def test_bodies_stand_where_a_brake_engineer_expects_them(model: LinearBrake, picture: Drawing) -> None:
    y = {body.name: body.centre[1] for body in picture.bodies}
    assert y["inner_pad"] < y["disc"] < y["outer_pad"] and y["caliper"] < y["inner_pad"]
    x = {body.name: body.centre[0] for body in picture.bodies}
    assert x["carrier_l"] < x["inner_pad"] < x["carrier_t"]
    assert y["disc"] == pytest.approx(0.0, abs=1e-9)
    assert y["caliper"] == pytest.approx(model.quantities["y_cal"].value, abs=1e-6)
    assert "frame" not in y
    roles = {body.name: body.role for body in picture.bodies}
    assert roles["disc"] == "disc" and roles["inner_pad"] == roles["outer_pad"] == "pad"
    assert len(picture.body("caliper").parts) == 2  # piston side and fingers, joined by the bridge


def test_every_coupling_is_drawn_between_its_bodies(model: LinearBrake, picture: Drawing) -> None:
    spec = model.brake.spec
    drawn = {s.coupling: s for s in picture.springs}
    assert set(drawn) == {c.name for c in (*spec.couplings, *spec.torsions)}
    for coupling in spec.couplings:
        bodies = {end.split(".")[0] for end in coupling.between} - {"frame"}
        assert {name for name, _ in (drawn[coupling.name].first, drawn[coupling.name].second)} - {
            ""
        } == bodies
    for spring in picture.springs:
        if spring.kind != "torsion":
            assert np.hypot(*(spring.second[1] - spring.first[1])) > 0.02 * picture.size


def test_outlines_move_rigidly_and_as_far_as_asked(model: LinearBrake, picture: Drawing) -> None:
    shape = find_shape(mode_shapes(model, {"mu": 0.64}), near_hz=2400.0)
    motions = motions_of(model, shape, picture, {"mu": 0.64})
    furthest = 0.0
    for body in picture.bodies:
        outline = np.concatenate(body.parts)
        small = displaced(outline, body.centre, motions.of(body.name), 0.3, 1e-6)
        before = np.linalg.norm(outline[:, None] - outline[None, :], axis=2)
        after = np.linalg.norm(small[:, None] - small[None, :], axis=2)
        assert np.abs(after - before).max() < 1e-9
        for phase in np.linspace(0.0, np.pi, 91):
            moved = displaced(outline, body.centre, motions.of(body.name), phase, motions.scale)
            furthest = max(furthest, float(np.linalg.norm(moved - outline, axis=1).max()))
    assert furthest == pytest.approx(0.03 * picture.size, rel=1e-3)
    assert scale_for(picture, {}) == 0.0


def test_another_topology_is_drawn_too(model: LinearBrake) -> None:
    """A carrier that turns and shifts both ways, a caliper without guides: nothing is assumed but the
    file.
    """
    data = model.brake.spec.model_dump()
    data["couplings"] = [c for c in data["couplings"] if not c["name"].startswith("guide")]
    data["points"] = [p for p in data["points"] if not p["name"].startswith("guide")]
    for name in ("c_gui_x", "c_gui_y", "d_gui_x", "d_gui_y", "x_gui", "y_gui"):
        del data["parameters"][name]
    data["groups"] = [
        g
        for g in data.get("groups", ())
        if not any("guide" in m or "_gui" in m for m in (*g["leading"], *g["trailing"], *g["both"]))
    ]
    for body in data["bodies"]:
        if body["name"] == "carrier_l":
            body |= {"freedoms": ["x", "y", "phi"], "inertia": "J_cal"}
    other = LinearBrake(Brake(BrakeSpec.model_validate(data)))
    drawn = draw_brake(other)
    assert {b.name for b in drawn.bodies} == {
        "caliper",
        "inner_pad",
        "disc",
        "outer_pad",
        "carrier_l",
        "carrier_t",
    }
    assert all(np.isfinite(np.concatenate(b.parts)).all() for b in drawn.bodies)
    assert len(modes_study(other).table("modes")) == 16


def test_study_names_who_takes_part(model: LinearBrake, tmp_path: Path) -> None:
    study = modes_study(model, near_hz=2400.0, values={"mu": 0.64})
    assert study.facts["mode"] == 7 and study.facts["frequency_hz"] == pytest.approx(2400.0, abs=1.0)
    assert "outer pad" in study.facts["bodies_taking_part"] and "disc" in study.facts["bodies_taking_part"]
    assert study.facts["damping_adds_1_s"] + study.facts["friction_adds_1_s"] == pytest.approx(
        study.facts["real_part_1_s"], abs=1e-6
    )
    assert sum(study.table("bodies").column("kinetic_energy")) == pytest.approx(100.0)
    assert study.facts["friction_by_contact_1_s"].startswith("contact_ol +")
    names = {path.name for path in write(study, tmp_path, ("png", "csv", "json"))}
    assert {"mode_shape.png", "mode_budget.png", "mode_couplings.csv", "mode.json"} <= names


def test_gif_has_a_frame_per_phase_and_moves(model: LinearBrake, picture: Drawing) -> None:
    shape = mode_shapes(model)[4]
    data = animated_gif(picture, motions_of(model, shape, picture), "mode", frames=4)
    image = Image.open(io.BytesIO(data))
    assert image.n_frames == 4 and image.info["loop"] == 0  # type: ignore[attr-defined]
    frames = []
    for k in range(4):
        image.seek(k)
        frames.append(np.asarray(image.convert("L"), dtype=int))
    assert np.abs(frames[0] - frames[2]).mean() > 1.0


def test_page_is_self_contained_and_holds_all_modes(model: LinearBrake) -> None:
    shapes = mode_shapes(model)
    text = page(model, shapes, 5)
    assert not re.search(r"(src|href)\s*=|url\(|@import|https?://(?!www\.w3\.org/2000/svg)", text)
    assert "$" not in text
    data = json.loads(re.search(r"const data = (\{.*?\});\n", text, re.S).group(1))  # type: ignore[union-attr]
    assert [m["number"] for m in data["modes"]] == list(range(1, 15))
    assert {b["name"] for b in data["bodies"]} == set(data["modes"][0]["motions"])
    motion = np.array([complex(*z) for z in data["modes"][4]["motions"]["inner_pad"]])
    assert motion / [1e3, 1e3, 1.0] == pytest.approx(shapes[4].body_motion("inner_pad"))  # mm on the page


@pytest.mark.skipif(shutil.which("node") is None, reason="no node to read the script with")
def test_script_of_the_page_is_javascript(model: LinearBrake, tmp_path: Path) -> None:
    text = page(model, mode_shapes(model), 1)
    script = re.search(r"<script>(.*)</script>", text, re.S).group(1)  # type: ignore[union-attr]
    (tmp_path / "page.js").write_text(script)
    done = subprocess.run(["node", "--check", str(tmp_path / "page.js")], capture_output=True, check=False)
    assert done.returncode == 0, done.stderr.decode()


@pytest.mark.skipif(shutil.which("ffmpeg") is not None, reason="ffmpeg is installed")
def test_mp4_without_ffmpeg_says_so(model: LinearBrake, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="ffmpeg"):
        animate(model, tmp_path, ("mp4",), 5)


def test_model_without_geometry_gets_bars_and_a_clear_message(tmp_path: Path) -> None:
    n = 6
    k = 1e6 * (2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1))
    np.savez(tmp_path / "chain.npz", M=np.eye(n), D=1e-5 * k, K=k)
    loaded = read_model(tmp_path / "chain.npz")
    study = modes_study(loaded, 2)
    assert "no geometry" in study.facts["drawing"] and set(study.figures) == {"freedoms"}
    assert len(write(study, tmp_path, ("png",))) == 1
    with pytest.raises(ConfigError, match="no geometry"):
        animate(loaded, tmp_path)


def app() -> typer.Typer:
    app = typer.Typer()
    command.register(app)
    app.command("other")(lambda: None)
    return app


def test_command_writes_figures_and_page(tmp_path: Path) -> None:
    arguments = [
        "modes",
        str(BRAKES / "model.toml"),
        "--near",
        "2140",
        "--animate",
        "html",
        "--out",
        str(tmp_path),
    ]
    result = CliRunner().invoke(app(), [*arguments, "--format", "svg,json"])
    assert result.exit_code == 0, result.output
    assert "mode 5" in result.output and "inner pad 56 %" in result.output
    assert {"mode_shape.svg", "mode.json", "mode.html"} <= {path.name for path in tmp_path.iterdir()}


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["--pair", "3", "--near", "900"], "two modes"),
        (["--pair", "15"], "modes 1 to 14"),
        (["--animate", "gif"], "--out"),
        (["--animate", "avi", "--out", "x"], "gif, html, mp4"),
        (["--set", "muu=1"], "mu"),
    ],
)
def test_bad_input_of_the_command(
    arguments: list[str], problem: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = CliRunner().invoke(app(), ["modes", str(BRAKES / "basic.toml"), *arguments])
    assert isinstance(result.exception, ConfigError)
    assert problem in str(result.exception)

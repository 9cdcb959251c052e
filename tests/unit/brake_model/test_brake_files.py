"""Brake files: shipped ones load, nonsense is refused with place, value and remedy."""

import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.expressions import UNITS, Dimension, Quantity, evaluate
from sim_hardware.brake_model.spec import BrakeSpec, load_spec

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
METRE = Dimension(0, 1, 0)


def data(name: str = "model") -> dict[str, Any]:
    return tomllib.loads((BRAKES / f"{name}.toml").read_text(encoding="utf-8"))


def refusal(brake: dict[str, Any]) -> dict[str, Any]:
    """The first error of a refused brake."""
    with pytest.raises(ValidationError) as caught:
        BrakeSpec.model_validate(brake)
    return caught.value.errors()[0]


def entry(brake: dict[str, Any], table: str, name: str) -> dict[str, Any]:
    return next(item for item in brake[table] if item["name"] == name)


@pytest.mark.parametrize("file", sorted(BRAKES.glob("*.toml")), ids=lambda file: file.stem)
def test_shipped_brakes_load(file: Path) -> None:
    brake = load_brake(file)
    assert brake.name == file.stem
    assert (brake.n_dof, len(brake.elements), len(brake.torsions), len(brake.spec.bodies)) == (14, 18, 1, 7)
    assert [contact.pad for contact in brake.contacts] == ["inner_pad", "inner_pad", "outer_pad", "outer_pad"]
    assert all(len(parameter.origin) > 10 for parameter in brake.spec.parameters.values())
    assert brake.pad_force_n(15e5) == pytest.approx(3435.0)
    assert BrakeSpec.model_validate(brake.spec.model_dump()) == brake.spec


def test_unknown_keys_are_refused_everywhere() -> None:
    for path in ((), ("operating",), ("operating", "mu"), ("parameters", "m_disc")):
        brake = data()
        place: Any = brake
        for key in path:
            place = place[key]
        place["mass_of_disk"] = 1.0
        error = refusal(brake)
        assert error["type"] == "extra_forbidden"
        assert error["loc"] == (*path, "mass_of_disk")
    for table in ("bodies", "points", "couplings", "torsions"):
        brake = data()
        brake[table][0]["stifness"] = "c_tie"
        assert refusal(brake)["type"] == "extra_forbidden"


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda b: b["parameters"]["c_tie"].update(unit="N/mm"), ["unit", "N/mm"]),
        (
            lambda b: b["parameters"]["c_tie"].update(unit="N s/m"),
            ["'tie': stiffness_x", "N s/m", "N/m is needed"],
        ),
        (lambda b: b["parameters"]["m_disc"].update(unit="kg m2"), ["'disc': mass", "kg m2 where kg"]),
        (lambda b: b["parameters"]["y_disc"].update(unit="kg"), ["points", "kg where m is needed"]),
        (lambda b: b["operating"]["slope"].update(unit="1"), ["slope", "s/m"]),
        (lambda b: b["operating"]["mu"].update(value=-0.4), ["mu", "-0.4"]),
        (lambda b: b["parameters"]["m_disc"].update(value=-5.0), ["'disc': mass", "-5 kg", "positive"]),
        (lambda b: b["parameters"]["J_cal"].update(value=0.0), ["'caliper': inertia", "positive"]),
        (lambda b: b["parameters"]["d_tie"].update(value=-1.0), ["'tie': damping_x", "not negative"]),
        (
            lambda b: b["couplings"].remove(entry(b, "couplings", "tie")),
            ["carrier_l.tie", "no coupling uses"],
        ),
        (lambda b: b["couplings"].remove(entry(b, "couplings", "contact_il")), ["no coupling uses"]),
        (lambda b: b.update(torsions=[]), ["c_disc_phi", "used nowhere"]),
        (lambda b: entry(b, "couplings", "tie").update(stiffness_x="c_tye"), ["'tie': stiffness_x", "c_tye"]),
        (
            lambda b: entry(b, "couplings", "tie").update(between=["carrier_l.tie", "carrier_t.ti"]),
            ["carrier_t.ti"],
        ),
        (
            lambda b: entry(b, "couplings", "contact_il").update(load_share=0.4),
            ["inner_pad", "0.9", "instead of 1"],
        ),
        (lambda b: entry(b, "couplings", "tie").update(name="hub"), ["'hub'", "2 times"]),
        (lambda b: entry(b, "bodies", "disc").pop("inertia"), ["disc", "inertia"]),
        (lambda b: b["parameters"].update(x_new=dict(b["parameters"]["x_con"])), ["x_new", "used nowhere"]),
        (lambda b: b["points"][0].update(x="__import__('os').getcwd()"), ["points", "something other"]),
        (lambda b: b["points"][0].update(x="x_con ** 2"), ["points", "operator"]),
        (lambda b: b["points"][0].update(x="x_con /"), ["points", "not an arithmetic"]),
        (lambda b: b["points"][0].update(x="x_con / (y_disc - y_disc)"), ["points", "divides"]),
        (lambda b: b["points"][0].update(x="-" * 201), ["longer"]),
    ],
)
def test_nonsense_names_place_value_and_remedy(change: Any, words: list[str]) -> None:
    brake = data()
    change(brake)
    error = refusal(brake)
    assert error["type"] == "brake_file"
    for word in words:
        assert word in error["msg"], error["msg"]
    assert error["ctx"]["remedy"]
    assert "value" in error["ctx"]


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_values_that_are_not_finite_are_refused(value: float) -> None:
    brake = data()
    brake["parameters"]["c_tie"]["value"] = value
    error = refusal(brake)
    assert (error["type"], error["loc"]) == ("finite_number", ("parameters", "c_tie", "value"))


def test_names_cannot_be_paths() -> None:
    brake = data()
    brake["name"] = "../../etc/passwd"
    assert refusal(brake)["type"] == "string_pattern_mismatch"


def test_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        load_spec(tmp_path / "none.toml")
    (tmp_path / "bad.toml").write_text("name = ")
    with pytest.raises(tomllib.TOMLDecodeError):
        load_spec(tmp_path / "bad.toml")


def test_topology_is_data() -> None:
    """A body and its couplings added by editing the file: one more degree of freedom, a new mode at its
    frequency."""
    brake = data()
    brake["parameters"]["m_weight"] = {"value": 0.01, "unit": "kg", "origin": "test"}
    brake["parameters"]["c_weight"] = {"value": 1e4, "unit": "N/m", "origin": "test"}
    brake["bodies"].append({"name": "weight", "freedoms": ["y"], "mass": "m_weight"})
    brake["points"] += [
        {"body": "weight", "name": "foot", "x": "0", "y": "0"},
        {"body": "disc", "name": "weight", "x": "0", "y": "0"},
    ]
    brake["couplings"].append(
        {
            "kind": "spring",
            "name": "glue",
            "between": ["weight.foot", "disc.weight"],
            "stiffness_y": "c_weight",
        }
    )
    wider = Brake(BrakeSpec.model_validate(brake))
    assert (wider.n_dof, len(wider.elements)) == (15, 19)
    assert wider.freedoms[-1] == "weight.y"
    row = wider.elements[-1].row_y
    assert row[wider.freedom_index("weight.y")] == 1.0
    assert row[wider.freedom_index("disc.y")] == -1.0


def test_with_parameters_changes_one_thing() -> None:
    brake = load_brake(BRAKES / "model.toml")
    heavier = brake.with_parameters(m_disc=6.0)
    index = brake.freedom_index("disc.x")
    assert (brake.inertia[index], heavier.inertia[index]) == (5.0, 6.0)
    assert (brake.stiffness_matrix(0.4) == heavier.stiffness_matrix(0.4)).all()
    with pytest.raises(KeyError, match="m_disk"):
        brake.with_parameters(m_disk=6.0)
    with pytest.raises(ValidationError):
        brake.with_parameters(m_disc=-6.0)
    with pytest.raises(KeyError, match=r"caliper\.z"):
        brake.freedom_index("caliper.z")


def test_package_import_is_light() -> None:
    """Neither numba nor scipy is loaded by the package, by assembling a brake, or by its stability."""
    code = (
        "import sys, sim_hardware.brake_model as b;"
        f"b.predict(b.load_brake({str(BRAKES / 'model.toml')!r}));"
        "assert not {'numba', 'scipy', 'llvmlite'} & set(sys.modules), 'heavy import'"
    )
    root = Path(__file__).parents[3]
    assert subprocess.run([sys.executable, "-c", code], cwd=root, check=False, timeout=60).returncode == 0


@given(a=st.floats(0.01, 10), b=st.floats(0.01, 10), c=st.floats(0.01, 10))
def test_expressions_follow_arithmetic(a: float, b: float, c: float) -> None:
    known = {name: Quantity(value, METRE) for name, value in (("a", a), ("b", b), ("c", c))}
    result = evaluate("-(a + b) * 2 - c / 4", known, place="test")
    assert result.value == pytest.approx(-(a + b) * 2 - c / 4)
    assert result.dimension == METRE
    assert evaluate("a * b / c / c", known, place="test").dimension == UNITS["1"]

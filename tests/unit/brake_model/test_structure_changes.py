"""Structure changes by editing the brake file only: through loading, eigenvalues and both time
integrators."""

import math
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tomli_w
from pydantic import ValidationError

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.friction import ConstantFriction, LinearFriction
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.rigid_body import eigenvalues, rigid_motions
from sim_hardware.brake_model.spec import BrakeSpec
from sim_hardware.brake_model.stability import eigen_pairs, onset_mu, predict
from sim_hardware.brake_model.time_domain.integrator import SquealIntegrator
from sim_hardware.brake_model.time_domain.motion import integrate
from sim_hardware.brake_model.time_domain.reference import WorkingPoint

#: the first run compiles the integrator
pytestmark = pytest.mark.timeout(600)

FILE = Path(__file__).parents[3] / "configs" / "brakes" / "model.toml"
MODEL = load_brake(FILE)
Data = dict[str, Any]
RATE = 40_000.0


def data() -> Data:
    brake = tomllib.loads(FILE.read_text(encoding="utf-8"))
    brake.pop("groups", None)  # they name what the changes below remove
    return brake


def entry(brake: Data, table: str, name: str) -> Data:
    return next(item for item in brake[table] if item["name"] == name)


def drop_unused(brake: Data) -> None:
    """Points and parameters that nothing names any more, as a user would have to remove them."""
    used = {end for coupling in brake["couplings"] for end in coupling["between"]}
    brake["points"] = [p for p in brake["points"] if f"{p['body']}.{p['name']}" in used]
    text = " ".join(
        str(value)
        for table in ("bodies", "points", "couplings", "torsions")
        for item in brake[table]
        for value in item.values()
    )
    words = set(text.replace("(", " ").replace(")", " ").replace("-", " ").replace("*", " ").split())
    brake["parameters"] = {k: v for k, v in brake["parameters"].items() if k in words}


def parameter(brake: Data, name: str, value: float, unit: str) -> str:
    brake["parameters"][name] = {"value": value, "unit": unit, "origin": "test"}
    return name


def point(brake: Data, body: str, name: str, x: str = "0", y: str = "0") -> str:
    brake["points"].append({"body": body, "name": name, "x": x, "y": y})
    return f"{body}.{name}"


def written(brake: Data, folder: Path) -> Brake:
    """Through a real file."""
    path = folder / "changed.toml"
    path.write_bytes(tomli_w.dumps(brake).encode())
    return load_brake(path)


def runs_everywhere(brake: Brake, *, squeals: bool = False) -> np.ndarray:
    """Eigenvalues, derivatives and 5 ms by both integrators, which must agree; returns the frequencies."""
    pairs = eigen_pairs(brake, 0.4)
    model = LinearBrake(brake)
    np.testing.assert_allclose(
        model.matrices({"mu": 0.4}).state_matrix(), brake.state_matrix(0.4, 0.0, 0.0), rtol=1e-12, atol=1e-6
    )
    start = np.zeros(2 * brake.n_dof)
    start[brake.n_dof :] = 1e-3 * np.abs(brake.contacts[0].row_x)
    load = brake.pad_force_n(10e5)
    fast = SquealIntegrator(brake, mu_ref=0.4, outputs=[f"{f}:velocity" for f in brake.freedoms], substeps=8)
    fast.state = start
    k = 0.02
    found = fast.advance(200, normal_force_n=(load, load), mu=(0.4, 0.4), slip_m_s=(0.44, 0.44), k_s_m=(k, k))
    working = WorkingPoint(load, 0.44, LinearFriction(mu_mean=0.4, k_s_m=k))
    motion = integrate(brake, working, start, np.arange(200) / RATE, record_forces=True)
    expected = motion.states[:, brake.n_dof :]
    assert np.abs(expected).max() > 1e-4
    np.testing.assert_allclose(found, expected, atol=2e-3 * np.abs(expected).max())
    assert not motion.events
    assert motion.coupling_forces is not None
    assert len(motion.coupling_forces.elements) == len(brake.spec.couplings)
    return np.array([pair.frequency_hz for pair in pairs])


def add_damper_mass(brake: Data) -> None:
    """A mass on a spring at the caliper: a vibration absorber."""
    parameter(brake, "m_abs", 0.05, "kg")
    parameter(brake, "c_abs", 0.05 * (2 * math.pi * 2140.0) ** 2, "N/m")
    brake["bodies"].append({"name": "absorber", "freedoms": ["y"], "mass": "m_abs"})
    ends = [point(brake, "absorber", "foot"), point(brake, "caliper", "absorber")]
    brake["couplings"].append({"kind": "spring", "name": "absorber", "between": ends, "stiffness_y": "c_abs"})


def split_pad(brake: Data, coupling_n_m: float = 5e8) -> None:
    """The inner pad as a leading and a trailing half that share one pad force, with a spring between them."""
    pad = entry(brake, "bodies", "inner_pad")
    brake["bodies"].remove(pad)
    for half in ("l", "t"):
        brake["bodies"].append(pad | {"name": f"inner_{half}", "mass": "m_padi / 2", "inertia": "J_padi / 4"})
        shift = "x_con" if half == "l" else "-x_con"
        for old in [
            p for p in brake["points"] if p["body"] == "inner_pad" and p["name"].endswith(f"_{half}")
        ]:
            old["body"] = f"inner_{half}"
            old["x"] = f"{old['x']} + ({shift})"
    for coupling in brake["couplings"]:
        coupling["between"] = [end.replace("inner_pad.", f"inner_{end[-1]}.") for end in coupling["between"]]
        if coupling["name"] in ("contact_il", "contact_it"):
            coupling["pad"] = "inner_pad"
    parameter(brake, "c_joint", coupling_n_m, "N/m")
    parameter(brake, "c_bend", 1e5, "N m/rad")
    ends = [point(brake, "inner_l", "joint", "x_con"), point(brake, "inner_t", "joint", "-x_con")]
    brake["couplings"].append(
        {
            "kind": "spring",
            "name": "joint",
            "between": ends,
            "stiffness_x": "c_joint",
            "stiffness_y": "c_joint",
        }
    )
    brake["torsions"].append({"name": "bend", "between": ["inner_l", "inner_t"], "stiffness": "c_bend"})


def remove_tie(brake: Data) -> None:
    brake["couplings"].remove(entry(brake, "couplings", "tie"))
    drop_unused(brake)


def turn_pistons(brake: Data) -> None:
    parameter(brake, "tilt", math.radians(10.0), "rad")
    for name, sign in (("piston_l", ""), ("piston_t", "-")):
        entry(brake, "couplings", name)["angle"] = f"{sign}tilt"


def third_contact(brake: Data) -> None:
    """A third contact in the middle of the outer pad."""
    for name in ("contact_ol", "contact_ot"):
        entry(brake, "couplings", name)["load_share"] = 0.3
    ends = [
        point(brake, "outer_pad", "contact_m", "0", "-h_pad"),
        point(brake, "disc", "contact_om", "0", "y_disc"),
    ]
    middle = entry(brake, "couplings", "contact_ol") | {"name": "contact_om", "between": ends}
    brake["couplings"].append(middle | {"load_share": 0.4})


def third_pad(brake: Data) -> None:
    """A second outer pad of one mass, held by the caliper."""
    parameter(brake, "m_third", 0.3, "kg")
    brake["bodies"].append({"name": "third_pad", "freedoms": ["x", "y"], "mass": "m_third"})
    rub = [point(brake, "third_pad", "contact"), point(brake, "disc", "third", "0", "y_disc")]
    brake["couplings"].append(
        {"kind": "contact", "name": "contact_third", "between": rub, "side": -1, "load_share": 1.0,
         "stiffness": "c_con_ol", "damping": "d_con"}
    )  # fmt: skip
    rear = [point(brake, "third_pad", "rear"), point(brake, "caliper", "third")]
    brake["couplings"].append(
        {"kind": "spring", "name": "finger_m", "between": rear, "stiffness_x": "c_fin_t", "stiffness_y":
        "c_fin_n",
         "damping_x": "d_fin_t", "damping_y": "d_fin_n"}
    )  # fmt: skip


def one_pad(brake: Data) -> None:
    """Without the outer pad and its fingers."""
    brake["bodies"].remove(entry(brake, "bodies", "outer_pad"))
    brake["couplings"] = [
        c for c in brake["couplings"] if not any(end.startswith("outer_pad.") for end in c["between"])
    ]
    drop_unused(brake)


@pytest.mark.parametrize(
    ("change", "n_dof", "groups"),
    [
        (add_damper_mass, 15, 2),
        (split_pad, 17, 3),
        (remove_tie, 14, 2),
        (turn_pistons, 14, 2),
        (third_contact, 14, 2),
        (third_pad, 16, 3),
        (one_pad, 11, 1),
    ],
)
def test_changed_structures_run_everywhere(
    change: Callable[[Data], None], n_dof: int, groups: int, tmp_path: Path
) -> None:
    brake = data()
    change(brake)
    changed = written(brake, tmp_path)
    assert changed.n_dof == n_dof
    frequencies = runs_everywhere(changed)
    assert len(frequencies) == n_dof
    assert SquealIntegrator(changed, outputs=()).n_pads == groups
    if n_dof == MODEL.n_dof:  # the change has an effect
        before = np.array([pair.frequency_hz for pair in eigen_pairs(MODEL, 0.4)])
        assert np.abs(frequencies - before).max() > 0.5


def test_absorber_adds_a_pair_near_its_frequency(tmp_path: Path) -> None:
    brake = data()
    add_damper_mass(brake)
    pairs = eigen_pairs(written(brake, tmp_path), 0.4)
    assert sum(2000.0 < pair.frequency_hz < 2200.0 for pair in pairs) == 2


def test_halves_joined_stiffly_are_the_whole_pad_again(tmp_path: Path) -> None:
    """Same mass and moment of inertia about the middle: m/2 each at +-x with J as left over."""
    brake = data()
    split_pad(brake, 1e13)
    brake["parameters"]["c_bend"]["value"] = 1e10
    leftover = MODEL.spec.parameters["J_padi"].value - 0.4 * 0.033**2
    assert leftover > 0.0
    parameter(brake, "J_half", 0.5 * leftover, "kg m2")
    for half in ("inner_l", "inner_t"):
        entry(brake, "bodies", half)["inertia"] = "J_half"
    drop_unused(brake)
    frequencies = [p.frequency_hz for p in eigen_pairs(written(brake, tmp_path), 0.4)]
    whole = [p.frequency_hz for p in eigen_pairs(MODEL, 0.4)]
    np.testing.assert_allclose(frequencies[:14], whole, rtol=1e-4)


def test_full_turn_of_axes_changes_nothing_and_a_quarter_swaps_them(tmp_path: Path) -> None:
    brake = data()
    parameter(brake, "turn", 2.0 * math.pi, "rad")
    guide = entry(brake, "couplings", "guide_l")
    guide["angle"] = "turn"
    np.testing.assert_allclose(
        written(brake, tmp_path).state_matrix(0.4), MODEL.state_matrix(0.4), rtol=1e-10, atol=1e-3
    )
    brake["parameters"]["turn"]["value"] = math.pi / 2.0
    turned = written(brake, tmp_path)
    swapped = data()
    guide = entry(swapped, "couplings", "guide_l")
    for quantity in ("stiffness", "damping"):
        x, y = guide[f"{quantity}_x"], guide[f"{quantity}_y"]
        guide[f"{quantity}_x"], guide[f"{quantity}_y"] = y, x
    np.testing.assert_allclose(
        turned.state_matrix(0.4), written(swapped, tmp_path).state_matrix(0.4), rtol=1e-10, atol=1e-3
    )


def test_halves_of_a_pad_slip_by_themselves(tmp_path: Path) -> None:
    """Three friction groups by their names, events at each, and friction that adds up."""
    brake = data()
    split_pad(brake, 1e7)
    changed = written(brake, tmp_path)
    start = np.zeros(2 * changed.n_dof)
    start[changed.n_dof + changed.freedom_index("inner_l.x")] = 0.2
    start[changed.n_dof + changed.freedom_index("inner_t.x")] = 0.1
    working = WorkingPoint(changed.pad_force_n(5e5), 0.05, ConstantFriction(mu_mean=0.4))
    motion = integrate(changed, working, start, np.linspace(0.0, 2e-3, 200), record_forces=True)
    assert set(motion.groups) == {"inner_l", "inner_t", "outer_pad"}
    assert {event.where for event in motion.events} >= {"inner_l", "inner_t"}
    most = 0.4 * motion.normal_n[:, 0].max() * 1.01
    assert motion.friction_n[:, motion.groups.index("inner_l")].max() < most


# -- rigid-body motions


def test_body_without_coupling_has_exact_zero_eigenvalues(tmp_path: Path) -> None:
    brake = data()
    parameter(brake, "m_free", 0.2, "kg")
    parameter(brake, "J_free", 0.001, "kg m2")
    brake["bodies"].append(
        {"name": "free", "freedoms": ["x", "y", "phi"], "mass": "m_free", "inertia": "J_free"}
    )
    changed = written(brake, tmp_path)
    pairs = eigen_pairs(changed, 0.4)
    assert [pair.frequency_hz for pair in pairs[:6]] == [0.0] * 6
    assert [pair.real_part_1_s for pair in pairs[:6]] == [0.0] * 6
    np.testing.assert_allclose(
        [p.frequency_hz for p in pairs[6:]], [p.frequency_hz for p in eigen_pairs(MODEL, 0.4)], rtol=1e-9
    )
    assert predict(changed).onset_pressure_bar == pytest.approx(predict(MODEL).onset_pressure_bar, rel=1e-6)
    with pytest.raises(ValueError, match=r"rigid-body motions \(free\.x, free\.y, free\.phi\)"):
        SquealIntegrator(changed)
    # it drifts as Newton has it
    start = np.zeros(2 * changed.n_dof)
    start[changed.n_dof + changed.freedom_index("free.y")] = 0.5
    working = WorkingPoint(1000.0, 0.44, ConstantFriction(mu_mean=0.4))
    motion = integrate(changed, working, start, [0.0, 0.01, 0.02])
    np.testing.assert_allclose(
        motion.states[:, changed.freedom_index("free.y")], [0.0, 0.005, 0.01], rtol=1e-12
    )


def floating() -> Brake:
    """The brake without its knuckle: caliper, pads and carrier can move along the disc together."""
    brake = data()
    for name in ("knuckle_l", "knuckle_t"):
        brake["couplings"].remove(entry(brake, "couplings", name))
    drop_unused(brake)
    return Brake(BrakeSpec.model_validate(brake))


def test_floating_brake_is_not_called_unstable() -> None:
    """The double zero of the rigid-body motion splits to +-1e-4 1/s in a general routine: not so here."""
    brake = floating()
    matrix = brake.state_matrix(0.4, 0.0, 0.0)
    raw = np.linalg.eigvals(matrix)
    assert raw.real.max() > 1e-6  # what would be taken for an instability
    shape = rigid_motions(matrix)
    assert shape.shape == (14, 1)
    np.testing.assert_allclose(matrix[14:, :14] @ shape, 0.0, atol=1e-6)
    values = eigenvalues(matrix)
    assert (values == 0.0).sum() == 2
    others = np.sort_complex(values[values != 0.0])
    expected = np.sort_complex(raw[np.abs(raw) > 1.0])
    np.testing.assert_allclose(others, expected, rtol=1e-6, atol=1e-6)
    assert onset_mu(brake, 0.0) is None
    assert not any(pair.unstable for pair in eigen_pairs(brake, 0.4))
    with pytest.raises(ValueError, match=r"caliper\.x, inner_pad\.x, outer_pad\.x, carrier_l\.x"):
        SquealIntegrator(brake)


def test_brakes_without_rigid_motions_keep_their_eigenvalues() -> None:
    matrix = MODEL.state_matrix(0.4, 0.05, 10e5)
    assert rigid_motions(matrix).shape == (14, 0)
    np.testing.assert_array_equal(eigenvalues(matrix), np.linalg.eigvals(matrix))


# -- validation that explains


def half_shares(brake: Data) -> None:
    split_pad(brake)
    for name in ("contact_il", "contact_it"):
        del entry(brake, "couplings", name)["pad"]


def dangling_point(brake: Data) -> None:
    brake["points"].remove(next(p for p in brake["points"] if p["name"] == "hub" and p["body"] == "disc"))


def dangling_body(brake: Data) -> None:
    brake["bodies"].remove(entry(brake, "bodies", "outer_pad"))


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            lambda b: b["couplings"].remove(entry(b, "couplings", "tie")),
            ["carrier_l.tie", "coupling is missing"],
        ),
        (dangling_point, ["couplings 'hub'", "unknown point 'disc.hub'", "add the point"]),
        (dangling_body, ["unknown body 'outer_pad'", "add the body"]),
        (half_shares, ["'inner_l' carry 0.5", 'pad = "']),
        (
            lambda b: entry(b, "torsions", "hub_torsion").update(between=["disc", "wheel"]),
            ["hub_torsion", "unknown body 'wheel'", "carrier_l"],
        ),
        (
            lambda b: entry(b, "couplings", "tie").update(between=["carrier_l.tie", "carrier_l.guide"]),
            ["'tie'", "with itself"],
        ),
        (lambda b: entry(b, "couplings", "hub").update(angle="m_disc"), ["hub", "angle", "kg where"]),
        (lambda b: entry(b, "couplings", "contact_il").update(angle="0"), ["angle", "Extra inputs"]),
    ],
)
def test_broken_structures_are_explained(change: Callable[[Data], Any], words: list[str]) -> None:
    brake = data()
    change(brake)
    with pytest.raises(ValidationError) as caught:
        BrakeSpec.model_validate(brake)
    error = caught.value.errors()[0]
    text = " ".join(map(str, (error["loc"], error["msg"], error.get("ctx"))))
    assert all(word in text for word in words), text

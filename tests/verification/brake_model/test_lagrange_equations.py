"""The assembled brake against Lagrange's equations of the second kind by SymPy (section 2.3.2, there by
Maple).

Matrices to 1e-12, eigenvalues to 1e-9, for small systems that isolate a feature each and for the shipped
14-DOF brakes.
"""

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from lagrange_derivation import FREEDOMS, Linear, Point, System, from_brake_file
from small_brakes import CONTACT, brake_text

from sim_hardware.brake_model.assembly import Brake
from sim_hardware.brake_model.parametric import PA_PER_BAR, LinearBrake
from sim_hardware.brake_model.spec import BrakeSpec

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
BASE = {"m_pad": 0.4, "c_n": 2.1e8, "d_n": 300.0, "c_x": 1.3e7, "c_y": 0.9e7, "d_x": 40.0, "d_y": 25.0}
SMALL = {
    "pad on springs over a disc at rest": brake_text(
        BASE,
        {"pad": "xy", "disc": "", "frame": ""},
        {"pad.face": ("0", "0"), "disc.face": ("0", "0"), "pad.back": ("0", "0"), "frame.back": ("0", "0")},
        [CONTACT, ("spring", "pad.back", "frame.back",
                   {"stiffness_x": "c_x", "stiffness_y": "c_y", "damping_x": "d_x", "damping_y": "d_y"})],
    ),
    "two bodies with offset points and rotation": brake_text(
        BASE | {"J_pad": 4.7e-4, "m_disc": 5.0, "J_disc": 8e-3, "r_x": 0.031, "r_h": 0.011, "r_b": 0.0058},
        {"pad": "xyp", "disc": "xyp", "frame": ""},
        {"pad.face": ("-r_x", "r_h"), "disc.face": ("-r_x", "-r_h"), "pad.back": ("r_x + r_b", "-r_b"),
         "frame.back": ("0", "0"), "disc.hub": ("0.5 * r_x", "0"),
         "frame.hub": ("0", "0"), "disc.rim": ("-r_x", "0"), "frame.rim": ("0", "0")},
        [CONTACT,
         ("spring", "pad.back", "frame.back",
          {"stiffness_x": "c_x", "damping_y": "d_y", "stiffness_y": "c_y"}),
         ("spring", "disc.hub", "frame.hub",
          {"stiffness_x": "2 * c_x", "stiffness_y": "c_y", "damping_x": "d_x"}),
         ("spring", "disc.rim", "frame.rim", {"stiffness_y": "c_x"})],
    ),
    "rotated element axes": brake_text(
        BASE | {"J_pad": 4.7e-4, "r_x": 0.031, "r_h": 0.011, "a_l": 0.52, "a_t": -1.1},
        {"pad": "xyp", "disc": "", "frame": ""},
        {"pad.face": ("r_x", "r_h"), "disc.face": ("0", "0"), "pad.l": ("-r_x", "0"), "frame.l": ("0", "0"),
         "pad.t": ("r_x", "-r_h"), "frame.t": ("0", "0")},
        [CONTACT,
         ("spring", "pad.l", "frame.l", {"stiffness_x": "c_x", "damping_x": "d_x", "angle": "a_l"}),
         ("spring", "pad.t", "frame.t",
          {"stiffness_x": "c_y", "stiffness_y": "c_x", "damping_y": "d_y", "angle": "a_t"})],
    ),
    "torsion, outer pad": brake_text(
        BASE | {"J_pad": 4.7e-4, "J_disc": 8e-3, "m_disc": 5.0, "r_x": 0.031, "r_h": 0.011, "t_p": 3e4,
                "e_p": 0.4, "t_d": 1.4e6},
        {"pad": "yp", "disc": "xp", "frame": ""},
        {"pad.face": ("r_x", "-r_h"), "disc.face": ("r_x", "r_h"), "pad.back": ("0", "r_h"),
         "frame.back": ("0", "0"), "disc.hub": ("0", "0"), "frame.hub": ("0", "0")},
        [("contact", "pad.face", "disc.face", CONTACT[3] | {"side": -1}),
         ("spring", "pad.back", "frame.back", {"stiffness_y": "c_y", "damping_y": "d_y"}),
         ("spring", "disc.hub", "frame.hub", {"stiffness_x": "c_x", "damping_x": "d_x"})],
        [("pad", "disc", {"stiffness": "t_p", "damping": "e_p"}), ("disc", "frame", {"stiffness": "t_d"})],
    ),
}  # fmt: skip


def compare(brake: Brake, expected: Linear, mu: float, kn: float) -> None:
    """Matrices to 1e-12 of their rows' and columns' diagonals, eigenvalues to 1e-9."""
    assert list(brake.freedoms) == expected.freedoms
    for actual, target in zip(
        (brake.mass_matrix, brake.damping_matrix(mu, 1.0, kn), brake.stiffness_matrix(mu)),
        expected.at(mu, kn),
        strict=True,
    ):
        size = np.maximum(np.abs(np.diag(target)), 1e-12 * np.abs(target).max())
        assert (np.abs(actual - target) / np.sqrt(np.outer(size, size))).max() < 1e-12
    values = np.linalg.eigvals(brake.state_matrix(mu, 1.0, kn / brake.piston_area_m2))
    values = values[values.imag >= 0]
    values = values[np.lexsort((values.real, values.imag))]
    wanted = expected.eigenvalues(mu, kn)
    np.testing.assert_allclose(
        values, wanted, rtol=1e-9, atol=1e-12 * np.abs(wanted).max()
    )  # zeros: free motion


@pytest.mark.parametrize("mu", [0.0, 0.55])
@pytest.mark.parametrize("name", SMALL)
def test_small_systems(name: str, mu: float) -> None:
    brake = Brake(BrakeSpec.model_validate(tomllib.loads(SMALL[name])))
    compare(brake, from_brake_file(SMALL[name]), mu, 175.0 if mu else 0.0)


@pytest.mark.parametrize("name", ["basic", "model", "plant"])
def test_shipped_brakes(name: str) -> None:
    text = (BRAKES / f"{name}.toml").read_text()
    brake, expected = Brake(BrakeSpec.model_validate(tomllib.loads(text))), from_brake_file(text)
    assert len(expected.freedoms) == 14
    for mu, kn in ((0.0, 0.0), (0.43, 198.0), (1.2, 700.0)):
        compare(brake, expected, mu, kn)


@settings(max_examples=15, deadline=None)
@given(
    factors=st.lists(st.floats(0.5, 2.0), min_size=70, max_size=70),
    mu=st.floats(0.0, 1.0),
    bar=st.floats(0.0, 40.0),
)
def test_model_of_quantities_with_any_values(factors: list[float], mu: float, bar: float) -> None:
    """What the studies use (`LinearBrake`), with every parameter changed."""
    text = (BRAKES / "model.toml").read_text()
    model = LinearBrake(Brake(BrakeSpec.model_validate(tomllib.loads(text))))
    parameters = model.brake.spec.parameters
    changes = {n: p.value * f for (n, p), f in zip(parameters.items(), factors, strict=False)}
    assert len(changes) == len(parameters)
    found = model.matrices({**changes, "mu": mu, "slope": 0.06, "pressure": bar})
    kn = 0.06 * bar * PA_PER_BAR * model.brake.piston_area_m2
    for actual, wanted in zip(
        (found.mass, found.damping, found.stiffness), from_brake_file(text, **changes).at(mu, kn), strict=True
    ):
        size = np.sqrt(np.outer(np.abs(np.diag(wanted)), np.abs(np.diag(wanted))))
        # falling friction may cancel a diagonal element of D: judge by the largest as well
        assert (np.abs(actual - wanted) / np.maximum(size, 1e-6 * np.abs(wanted).max())).max() < 1e-11


def drawn(p: dict[str, float]) -> System:
    """The brake's topology, by hand from its drawing: absolute places, not the points of the file."""
    system = System()
    rear = p["y_disc"] + p["h_pad"]
    centre = {"caliper": p["y_cal"], "inner_pad": -rear, "outer_pad": rear}
    for body, mass, inertia in (("caliper", "m_cal", "J_cal"), ("inner_pad", "m_padi", "J_padi"),
                                ("disc", "m_disc", "J_disc"), ("outer_pad", "m_pado", "J_pado")):  # fmt: skip
        system.body(body, FREEDOMS, p[mass], p[inertia])
    for half in ("l", "t"):
        system.body(f"carrier_{half}", "x", p[f"m_c{half}"])
    system.body("frame", "")

    def at(body: str, x: float, y: float) -> Point:
        """The material point of a body at an absolute place."""
        return body, x, y - centre.get(body, 0.0)

    def first(*names: str) -> float:
        return next(p[name] for name in names if name in p)

    for half, sign in (("l", -1.0), ("t", 1.0)):
        carrier = f"carrier_{half}"
        for pad, letter, side, plate in (("inner_pad", "i", 1, "pis"), ("outer_pad", "o", -1, "fin")):
            face = (sign * p["x_con"], -side * p["y_disc"])
            stiffness = p[f"c_con_{letter}{half}"]
            system.contact(at(pad, *face), at("disc", *face), side, 0.5, stiffness, p["d_con"])
            back = (sign * p[f"x_{plate}"], -side * (rear + p["b_pad"]))
            stiff, damp = ((p[f"{k}_{plate}_t"], p[f"{k}_{plate}_n"]) for k in ("c", "d"))
            system.spring(at("caliper", *back), at(pad, *back), stiff, damp)
            edge = (sign * p["x_abu"], -side * (rear + p["a_pad"]))
            abutment = (p[f"c_abu_{half}"], first(f"c_abu_y_{letter}{half}", "c_abu_y"))
            system.spring(at(pad, *edge), at(carrier, *edge), abutment, (p[f"d_abu_{half}"], p["d_abu_y"]))
        pin = (sign * p["x_gui"], p["y_gui"])
        guide = first(f"c_gui_x_{half}", "c_gui_x"), first(f"c_gui_y_{half}", "c_gui_y")
        system.spring(at("caliper", *pin), at(carrier, *pin), guide, (p["d_gui_x"], p["d_gui_y"]))
        knuckle = (p[f"c_knu_{half}"], 0.0), (p["d_knu"], 0.0)
        system.spring((carrier, 0.0, 0.0), ("frame", 0.0, 0.0), *knuckle)
    system.spring(("carrier_l", 0.0, 0.0), ("carrier_t", 0.0, 0.0), (p["c_tie"], 0.0), (p["d_tie"], 0.0))
    hub = (p["c_disc_x"], p["c_disc_y"]), (p["d_disc_x"], p["d_disc_y"])
    system.spring(("disc", 0.0, 0.0), ("frame", 0.0, 0.0), *hub)
    system.torsion("disc", "frame", p["c_disc_phi"], p["d_disc_phi"])
    return system


@pytest.mark.parametrize("name", ["basic", "model", "plant"])
def test_files_say_what_the_drawing_shows(name: str) -> None:
    """Topology and points of the shipped files against the same brake written down a second time."""
    brake = Brake(BrakeSpec.model_validate(tomllib.loads((BRAKES / f"{name}.toml").read_text())))
    assert len(brake.elements) == 18
    expected = drawn({n: parameter.value for n, parameter in brake.spec.parameters.items()}).linear()
    compare(brake, expected, 0.43, 198.0)


# -- the derivation itself, against closed forms -------------------------------------------------------------


def test_derivation_of_a_body_on_two_springs() -> None:
    """Springs at -a and +b under a bar: heave, pitch and their coupling as in any textbook."""
    system = System()
    system.body("bar", "y", 2.0)
    turning = System()
    for s in (system, turning):
        if s is turning:
            s.body("bar", ["x", "y", "phi"], 2.0, 0.3)
        s.body("ground", "")
        s.spring(("bar", -0.2, 0.0), ("ground", 0.0, 0.0), (0.0, 500.0), (0.0, 5.0))
        s.spring(("bar", 0.3, 0.1), ("ground", 0.0, 0.0), (40.0, 700.0))
    assert system.linear().stiffness == pytest.approx(np.array([[1200.0]]))
    found = turning.linear()
    pitch = 500 * 0.04 + 700 * 0.09 + 40 * 0.01
    expected = [[40, 0, -4.0], [0, 1200, -100 + 210], [-4.0, 110, pitch]]
    np.testing.assert_allclose(found.stiffness, expected, atol=1e-9)
    np.testing.assert_allclose(found.damping, [[0, 0, 0], [0, 5, -1.0], [0, -1.0, 0.2]], atol=1e-12)
    np.testing.assert_allclose(found.mass, np.diag([2.0, 2.0, 0.3]))


def test_derivation_of_friction() -> None:
    """A mass on a belt: pressed by c, dragged by mu c y; k N negative damping (eqs 29 to 31)."""
    system = System()
    system.body("mass", "xy", 1.5)
    system.body("belt", "")
    system.contact(("mass", 0.0, 0.0), ("belt", 0.0, 0.0), 1, 1.0, 800.0, 3.0)
    system.spring(("mass", 0.0, 0.0), ("belt", 0.0, 0.0), (200.0, 0.0), angle=math.pi / 6)
    m, d, k = system.linear().at(0.4, 7.0)
    np.testing.assert_allclose(k, [[150, 200 * math.sqrt(3) / 4 - 320], [200 * math.sqrt(3) / 4, 850]])
    np.testing.assert_allclose(d, [[-7, -1.2], [0, 3]])
    np.testing.assert_allclose(m, 1.5 * np.eye(2))


def test_derivation_finds_a_wrong_lever_arm() -> None:
    """The comparison can fail: one point moved by 10 micrometres."""
    text = (BRAKES / "model.toml").read_text()
    brake = Brake(BrakeSpec.model_validate(tomllib.loads(text)))
    x = brake.spec.parameters["x_pis"].value
    with pytest.raises(AssertionError):
        compare(brake, from_brake_file(text, x_pis=x + 1e-5), 0.4, 0.0)

"""Extremes in the studies over a quantity (root locus, stability boundary): one truth, whichever study is
asked.
"""

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from small_brakes import CONTACT, brake_text

from sim_hardware.brake_model.assembly import Brake, load_brake
from sim_hardware.brake_model.eigen.boundary import stability_boundary
from sim_hardware.brake_model.eigen.tracking import track
from sim_hardware.brake_model.foreign.matrix_model import MatrixModel
from sim_hardware.brake_model.linear import LinearModel
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.spec import BrakeSpec

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
NUMBERS = {"m_pad": 0.4, "c_n": 2e8, "d_n": 300.0, "c_x": 1e7, "c_y": 1e7, "d_x": 40.0, "d_y": 25.0}
POINTS = {"pad.face": ("0", "0"), "disc.face": ("0", "0"), "pad.back": ("0", "0"), "frame.back": ("0", "0")}
HELD = {"stiffness_x": "c_x", "stiffness_y": "c_y", "damping_x": "d_x", "damping_y": "d_y"}


def small(back: dict, bodies: dict[str, str], **numbers: float) -> LinearBrake:
    couplings = [CONTACT, ("spring", "pad.back", "frame.back", back)]
    text = brake_text(
        {**NUMBERS, **numbers}, {"pad": "xy", "disc": "", "frame": "", **bodies}, POINTS, couplings
    )
    return LinearBrake(Brake(BrakeSpec.model_validate(tomllib.loads(text))))


def onsets_of(model: LinearModel, top: float) -> list[tuple[float, float] | None]:
    """(value, frequency) of the first onset over mu, by each study."""
    fixed = {"slope": 0.0} if "slope" in model.quantities else {}
    boundary = stability_boundary(model, "mu", 0.0, top, fixed)
    assert not boundary.starts_unstable
    locus = track(model, "mu", np.linspace(0.0, top, 11), fixed)
    return [found and (found.value, found.frequency_hz) for found in (boundary.point, locus.onset)]


def test_undamped_brakes() -> None:
    """Without damping every pair lies on the axis, and rounding must not make one grow.

    Where two meet, their frequency changes as the root of the distance: mu is sharp, the frequency less.
    """
    for name, expected in (("basic", (0.6095453, 2410.63)), ("model", None)):
        brake = load_brake(BRAKES / f"{name}.toml")
        model = LinearBrake(brake.with_parameters(**{k: 0.0 for k in brake.spec.parameters if k[:2] == "d_"}))
        for found in onsets_of(model, 0.7):
            if expected is None:
                assert found is None
            else:
                assert found is not None
                assert found[0] == pytest.approx(expected[0], rel=2e-6)
                assert found[1] == pytest.approx(expected[1], rel=1e-4)


def test_divergence() -> None:
    """At the value where det K(mu), linear in mu, becomes zero; without frequency."""
    turned = {**HELD, "stiffness_x": "200 * c_x", "angle": "a_back"}
    model = small(turned, {}, a_back=-0.6)
    k0, k1 = model.matrices({"mu": 0.0}).stiffness, model.derivative("mu").stiffness
    exact = np.linalg.det(k0) / (k1[0, 1] * k0[1, 0])
    for found in onsets_of(model, 2.0 * exact):
        assert found == pytest.approx((exact, 0.0), rel=1e-6)


def test_free_body() -> None:
    for found in onsets_of(small(HELD, {"loose": "xyp"}, m_loose=2.0, J_loose=0.1), 0.9):
        assert found is None


def test_one_degree_of_freedom() -> None:
    """Damping 1 - 10 mu: exactly at 0.1, with the undamped frequency."""
    parts = {"M": np.eye(1), "K": 4e6 * np.eye(1), "D": np.eye(1), "D_mu": -10.0 * np.eye(1)}
    for found in onsets_of(MatrixModel("one", parts, {"mu": 0.05}), 1.0):
        assert found == pytest.approx((0.1, 2000.0 / math.tau), rel=1e-5)


def test_two_undamped_modes_meet() -> None:
    """K = [[4e6, mu 1e6], [-mu 1e6, 4.4e6]]: at mu = 0.2, with omega^2 = 4.2e6."""
    parts = {"M": np.eye(2), "K": np.diag([4e6, 4.4e6]), "K_mu": 1e6 * np.array([[0.0, 1.0], [-1.0, 0.0]])}
    for found in onsets_of(MatrixModel("two", parts, {"mu": 0.1}), 1.0):
        assert found == pytest.approx((0.2, math.sqrt(4.2e6) / math.tau), rel=1e-4)

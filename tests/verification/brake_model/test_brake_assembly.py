"""Forces of the loop over couplings against the matrices; Newton's third law.

The matrices themselves are checked against Lagrange's equations in `test_lagrange_equations`.
"""

from pathlib import Path

import numpy as np

from sim_hardware.brake_model.assembly import load_brake

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"


def test_loop_over_couplings_equals_matrices() -> None:
    """Forces element by element, summed (eqs 6, 7), give the same accelerations as M, D(mu), K(mu)."""
    brake = load_brake(BRAKES / "plant.toml")
    rng = np.random.default_rng(3)
    mu, k, pad_force = 0.5, 0.0576, 4000.0
    for _ in range(5):
        u, v = 1e-6 * rng.normal(size=14), 1e-2 * rng.normal(size=14)
        external = rng.normal(size=14)
        loop = brake.accelerations(
            u, v, lambda i, slip, n: mu * n + k * pad_force * brake.contacts[i].load_share * slip, external
        )
        matrices = (
            external - brake.damping_matrix(mu, k, pad_force) @ v - brake.stiffness_matrix(mu) @ u
        ) / brake.inertia
        np.testing.assert_allclose(loop, matrices, rtol=1e-9, atol=1e-9 * np.abs(matrices).max())


def test_newtons_third_law() -> None:
    """A rigid translation of all bodies is resisted only by what is tied to the frame."""
    brake = load_brake(BRAKES / "model.toml")
    shift = np.array([1e-6 if name.endswith(".x") else 0.0 for name in brake.freedoms])
    forces, moments = brake.coupling_forces(shift, np.zeros(14), lambda *_: 0.0)
    grounded = {"knuckle_l", "knuckle_t", "hub"}
    for element, force in zip(brake.elements, forces, strict=True):
        if element.name in grounded:
            assert abs(force[0]) > 100.0
        else:
            np.testing.assert_allclose(force, 0.0, atol=1e-9)
    assert np.all(moments == 0.0)

"""The assembled matrices against an independent derivation: Lagrange's equations with SymPy, topology written
by hand.

The derivation below shares nothing with `assembly` but the parameter values: energies, dissipation and the
virtual work of friction are written from the drawing of the brake, then differentiated.
"""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp

from sim_hardware.brake_model.assembly import Brake, load_brake

BRAKES = Path(__file__).parents[3] / "configs" / "brakes"
EDGES = (("l", -1), ("t", 1))


def lagrange(brake: Brake, mu: float, k: float, pad_force_n: float) -> dict[str, np.ndarray]:
    """M, D, K from T, V, Rayleigh's dissipation and virtual work."""
    p = {name: parameter.value for name, parameter in brake.spec.parameters.items()}

    def given(*names: str) -> float:
        return next(p[name] for name in names if name in p)

    bodies = {"caliper": "xyp", "inner": "xyp", "disc": "xyp", "outer": "xyp", "lead": "x", "trail": "x"}
    q = {f"{b}_{f}": sp.Symbol(f"q_{b}_{f}") for b, fs in bodies.items() for f in fs}
    w = {name: sp.Symbol(f"w_{name}") for name in q}
    masses = {"caliper": ("m_cal", "J_cal"), "inner": ("m_padi", "J_padi"), "disc": ("m_disc", "J_disc")}
    masses |= {"outer": ("m_pado", "J_pado"), "lead": ("m_cl", ""), "trail": ("m_ct", "")}
    kinetic = sum(
        sp.Rational(1, 2) * p[masses[b][1 if f == "p" else 0]] * w[f"{b}_{f}"] ** 2
        for b, fs in bodies.items()
        for f in fs
    )

    # heights over the disc's mid-plane; centres of mass of pads at +-(y_disc + h_pad)
    centre = {"caliper": p["y_cal"], "disc": 0.0, "lead": 0.0, "trail": 0.0}
    centre |= {"inner": -(p["y_disc"] + p["h_pad"]), "outer": p["y_disc"] + p["h_pad"]}

    def at(c: dict, body: str, x: float, y: float) -> tuple:
        """Motion of the material point of `body` at the absolute place (x, y)."""
        turn = c.get(f"{body}_p", 0)
        return c.get(f"{body}_x", 0) - turn * (y - centre.get(body, 0.0)), c.get(f"{body}_y", 0) + turn * x

    potential, dissipation = 0, 0

    def couple(
        first: str, second: str, x: float, y: float, cx: float, cy: float, dx: float, dy: float
    ) -> None:
        nonlocal potential, dissipation
        (ux, uy), (vx, vy) = (
            [a - b for a, b in zip(at(c, first, x, y), at(c, second, x, y), strict=True)] for c in (q, w)
        )
        potential += (cx * ux**2 + cy * uy**2) / 2
        dissipation += (dx * vx**2 + dy * vy**2) / 2

    rear = p["y_disc"] + p["h_pad"]
    work = {name: 0 for name in q}  # generalised friction forces
    for pad, letter, side in (("inner", "i", 1), ("outer", "o", -1)):
        for edge, sign in EDGES:
            x, y = sign * p["x_con"], -side * p["y_disc"]
            stiffness = p[f"c_con_{letter}{edge}"]
            couple(pad, "disc", x, y, 0, stiffness, 0, p["d_con"])
            (ux, uy), (vx, vy) = (
                [a - b for a, b in zip(at(c, pad, x, y), at(c, "disc", x, y), strict=True)] for c in (q, w)
            )
            normal = side * (stiffness * uy + p["d_con"] * vy)  # compression force, variation
            force = mu * normal + k * (pad_force_n / 2) * vx  # mu(v0 - vx) = mu + k vx
            for (
                name,
                coordinate,
            ) in q.items():  # virtual work of the friction pair: pad and reaction on the disc
                work[name] += force * sp.diff(ux, coordinate)
            couple(
                pad, "lead" if edge == "l" else "trail", sign * p["x_abu"], -side * (rear + p["a_pad"]),
                p[f"c_abu_{edge}"], given(f"c_abu_y_{letter}{edge}", "c_abu_y"),
                p[f"d_abu_{edge}"], p["d_abu_y"],
            )  # fmt: skip
            plate = ("pis", -1) if pad == "inner" else ("fin", 1)
            name, direction = plate
            couple(
                "caliper", pad, sign * p[f"x_{name}"], direction * (rear + p["b_pad"]),
                p[f"c_{name}_t"], p[f"c_{name}_n"], p[f"d_{name}_t"], p[f"d_{name}_n"],
            )  # fmt: skip
    for half, edge, sign in (("lead", "l", -1), ("trail", "t", 1)):
        couple(
            "caliper", half, sign * p["x_gui"], p["y_gui"],
            given(f"c_gui_x_{edge}", "c_gui_x"), given(f"c_gui_y_{edge}", "c_gui_y"),
            p["d_gui_x"], p["d_gui_y"],
        )  # fmt: skip
        couple(half, "ground", 0, 0, p[f"c_knu_{edge}"], 0, p["d_knu"], 0)
    couple("lead", "trail", 0, 0, p["c_tie"], 0, p["d_tie"], 0)
    couple("disc", "ground", 0, 0, p["c_disc_x"], p["c_disc_y"], p["d_disc_x"], p["d_disc_y"])
    potential += p["c_disc_phi"] * q["disc_p"] ** 2 / 2
    dissipation += p["d_disc_phi"] * w["disc_p"] ** 2 / 2

    positions, rates = list(q.values()), list(w.values())
    everything = positions + rates
    lines = sp.lambdify(
        everything,
        [sp.diff(potential, q[n]) + sp.diff(dissipation, w[n]) - work[n] for n in q],
        modules="math",
    )
    both = np.array([lines(*unit) for unit in np.eye(len(everything)).tolist()]).T  # the equations are linear
    n = len(positions)
    return {
        "M": np.array(sp.hessian(kinetic, rates).tolist(), dtype=float),
        "K": both[:, :n],
        "D": both[:, n:],
    }


@pytest.mark.parametrize("name", ["basic", "model", "plant"])
def test_matrices_equal_lagrange(name: str) -> None:
    brake = load_brake(BRAKES / f"{name}.toml")
    assert brake.n_dof == 14
    assert len(brake.elements) == 18
    assert brake.freedoms[:3] == ("caliper.x", "caliper.y", "caliper.phi")
    expected = lagrange(brake, mu=0.43, k=0.0576, pad_force_n=3435.0)
    for actual, key in (
        (brake.mass_matrix, "M"),
        (brake.damping_matrix(0.43, 0.0576, 3435.0), "D"),
        (brake.stiffness_matrix(0.43), "K"),
    ):
        scale = np.sqrt(np.outer(np.abs(np.diag(expected[key])), np.abs(np.diag(expected[key]))))
        assert np.abs((actual - expected[key]) / scale).max() < 1e-9, key


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

"""A plausible finite-element disc brake for tests and benchmarks: annular disc and two pads as grillages of
beams.

Job: sparse parts M, D, K, K_mu, D_k_p of a model of any size with the features that make real models hard:
pairs of nearly equal disc frequencies, stiff contacts, friction that couples bending and tilting, high
frequencies far above the band. NOT its job: being any particular brake.

Every node has w (out of the disc's plane) and the slopes a, b along x, y. Friction at a contact acts in the
rubbing surface, half a thickness off the middle plane, so that a pressed contact tilts both partners (the
geometric mechanism of section 2.2) and the tilting slides (which damps or, for a falling characteristic,
feeds).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse


@dataclass(frozen=True)
class Mesh:
    """Nodes of a grillage: places (n, 2) m, beams (m, 2) node indices, thickness m, Young's modulus Pa,
    density.
    """

    places: np.ndarray
    beams: np.ndarray
    thickness: float
    young: float
    density: float
    width: float


def annulus(n_radial: int, n_around: int) -> Mesh:
    """A cast-iron disc, 70 to 130 mm."""
    radii, angles = np.linspace(0.07, 0.13, n_radial), 2 * np.pi * np.arange(n_around) / n_around
    places = np.array([(r * np.cos(t), r * np.sin(t)) for t in angles for r in radii])
    index = np.arange(n_radial * n_around).reshape(n_around, n_radial)
    around = np.stack([index, np.roll(index, -1, axis=0)], axis=-1).reshape(-1, 2)
    across = np.stack([index[:, :-1], index[:, 1:]], axis=-1).reshape(-1, 2)
    return Mesh(places, np.concatenate([around, across]), 0.018, 1.1e11, 7200.0, 0.012)


def pad(disc: Mesh, nodes: np.ndarray, n_radial: int) -> Mesh:
    """A pad with its nodes over those of the disc."""
    index = np.arange(len(nodes)).reshape(-1, n_radial)
    along = np.stack([index[:-1], index[1:]], axis=-1).reshape(-1, 2)
    across = np.stack([index[:, :-1], index[:, 1:]], axis=-1).reshape(-1, 2)
    return Mesh(disc.places[nodes], np.concatenate([along, across]), 0.012, 2.1e11, 5000.0, 0.01)


def grillage(mesh: Mesh) -> tuple[sparse.coo_array, sparse.coo_array]:
    """M, K of a grillage: Euler beams with torsion, consistent mass."""
    h, b = mesh.thickness, mesh.width
    bending, torsion = mesh.young * b * h**3 / 12, mesh.young / 2.6 * b * h**3 / 5
    line_mass = mesh.density * b * h
    rows, cols, stiff, mass = [], [], [], []
    for i, j in mesh.beams:
        dx, dy = mesh.places[j] - mesh.places[i]
        length = float(np.hypot(dx, dy))
        c, s = dx / length, dy / length
        # beam's own freedoms: w1, slope1, w2, slope2, twist1, twist2
        kb = bending / length**3 * np.array(
            [[12, 6 * length, -12, 6 * length], [6 * length, 4 * length**2, -6 * length, 2 * length**2],
             [-12, -6 * length, 12, -6 * length], [6 * length, 2 * length**2, -6 * length, 4 * length**2]]
        )  # fmt: skip
        mb = line_mass * length / 420 * np.array(
            [[156, 22 * length, 54, -13 * length],
             [22 * length, 4 * length**2, 13 * length, -3 * length**2],
             [54, 13 * length, 156, -22 * length],
             [-13 * length, -3 * length**2, -22 * length, 4 * length**2]]
        )  # fmt: skip
        local_k, local_m = np.zeros((6, 6)), np.zeros((6, 6))
        local_k[:4, :4], local_m[:4, :4] = kb, mb
        local_k[4:, 4:] = torsion / length * np.array([[1, -1], [-1, 1]])
        local_m[4:, 4:] = line_mass * (h**2 + b**2) / 12 * length / 6 * np.array([[2, 1], [1, 2]])
        turn = np.zeros((6, 6))  # from (w, a, b) of both nodes
        for row, column in ((0, 0), (2, 3)):
            turn[row, column] = 1.0
            turn[row + 1, column + 1 : column + 3] = c, s
            turn[4 + row // 2, column + 1 : column + 3] = -s, c
        freedoms = np.concatenate([3 * i + np.arange(3), 3 * j + np.arange(3)])
        grid = np.meshgrid(freedoms, freedoms, indexing="ij")
        rows.append(grid[0].ravel())
        cols.append(grid[1].ravel())
        stiff.append((turn.T @ local_k @ turn).ravel())
        mass.append((turn.T @ local_m @ turn).ravel())
    place = (np.concatenate(rows), np.concatenate(cols))
    n = 3 * len(mesh.places)
    return (
        sparse.coo_array((np.concatenate(mass), place), shape=(n, n)),
        sparse.coo_array((np.concatenate(stiff), place), shape=(n, n)),
    )


def disc_brake(
    n_radial: int = 7, n_around: int = 120, contact_n_m: float = 4e6
) -> dict[str, sparse.csr_array]:
    """Parts of the model. Degrees of freedom: 3 n_radial (n_around + 2 (n_around // 6))."""
    disc = annulus(n_radial, n_around)
    covered = np.arange(n_radial * (n_around // 6))
    pads = [pad(disc, covered, n_radial) for _ in range(2)]
    blocks = [grillage(mesh) for mesh in (disc, *pads)]
    mass = sparse.block_diag([m for m, _ in blocks], format="csr")
    stiffness = sparse.block_diag([k for _, k in blocks], format="csr")
    n = mass.shape[0]
    starts = np.cumsum([0, *(3 * len(mesh.places) for mesh in (disc, *pads))])
    held = np.zeros(n)
    held[3 * np.arange(0, n_radial * n_around, n_radial)] = 2e6  # hat
    held[starts[1] : starts[2] : 3] = 1e6  # backplate on piston
    held[starts[2] :: 3] = 1.3e6  # and fingers
    held[starts[1] + 1 :: 3] = held[starts[1] + 2 :: 3] = 30.0
    stiffness = stiffness + sparse.diags_array(held)
    contact = sparse.csr_array((n, n))
    friction, falling = sparse.csr_array((n, n)), sparse.csr_array((n, n))
    for number, side in ((1, 1.0), (2, -1.0)):
        count = len(covered)
        disc_w, pad_w = 3 * covered, starts[number] + 3 * np.arange(count)
        uneven = contact_n_m * np.linspace(0.8, 1.2, count)

        def rows(columns: list[np.ndarray], values: list[np.ndarray], count: int = count) -> sparse.csr_array:
            line = np.tile(np.arange(count), len(columns))
            return sparse.csr_array(
                (np.concatenate(values), (line, np.concatenate(columns))), shape=(count, n)
            )

        one = np.ones(count)
        press = rows([pad_w, disc_w], [side * one, -side * one])  # compression
        x, y = disc.places[covered].T
        r = np.hypot(x, y)
        tx, ty = -y / r, x / r  # direction of sliding
        arms = (side * pads[number - 1].thickness / 2, side * disc.thickness / 2)
        slip = rows(
            [pad_w + 1, pad_w + 2, disc_w + 1, disc_w + 2],
            [-arms[0] * tx, -arms[0] * ty, -arms[1] * tx, -arms[1] * ty],
        )
        springs = sparse.diags_array(uneven)
        contact = contact + press.T @ springs @ press
        friction = friction - slip.T @ springs @ press
        falling = falling - slip.T @ slip * (2.29e-3 * 1e5 / count)
    damping = 4e-7 * stiffness + 8.0 * mass + 2e-6 * contact
    return {
        "M": sparse.csr_array(mass),
        "D": sparse.csr_array(damping),
        "K": sparse.csr_array(stiffness + contact),
        "K_mu": sparse.csr_array(friction),
        "D_mu": sparse.csr_array(2e-6 * friction),
        "D_k_p": sparse.csr_array(falling),
    }

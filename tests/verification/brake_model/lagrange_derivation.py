"""A second derivation of M, D, K: Lagrange's equations of the second kind by SymPy (section 2.3.2, there by
Maple).

Job: from the text of a brake file alone (read by `tomllib`, expressions evaluated here), energies T and V,
Rayleigh's dissipation function F, and generalised forces Q of friction by virtual work; then

    d/dt dT/dw - dT/dq + dF/dw + dV/dq = Q

linearised at rest. Energies add, so the equations are derived symbolically once for two bodies and any
coupling, and their terms added with numbers. Bodies turn by finite angles (a rotation matrix, not u = x - phi
r_y), so that the linearisation of eq 10 is checked too. NOT its job: sharing anything with `assembly`, `spec`
or `expressions`: it must not.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
import sympy as sp

FREEDOMS = ("x", "y", "phi")
Matrix = np.ndarray
Point = tuple[str, float, float]


@dataclass
class Linear:
    """M, D, K as functions of mu and k N, (n, n) each: D = D0 + mu D1 + k N D2, K = K0 + mu K1."""

    freedoms: list[str]
    mass: np.ndarray
    damping: np.ndarray
    damping_mu: np.ndarray
    damping_kn: np.ndarray
    stiffness: np.ndarray
    stiffness_mu: np.ndarray

    def at(self, mu: float, kn: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """M, D, K."""
        return (
            self.mass,
            self.damping + mu * self.damping_mu + kn * self.damping_kn,
            self.stiffness + mu * self.stiffness_mu,
        )

    def eigenvalues(self, mu: float, kn: float) -> np.ndarray:
        """Eigenvalues with Im > 0, or real, by frequency, (m,) 1/s."""
        m, d, k = self.at(mu, kn)
        n = len(m)
        state = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(m, k), -np.linalg.solve(m, d)]])
        values = np.linalg.eigvals(state)
        values = values[values.imag >= 0]
        return values[np.lexsort((values.real, values.imag))]


@cache
def coupling_terms() -> Callable[..., list[Matrix]]:
    """Lagrange's equations of two free bodies and one coupling, linearised at rest, for any numbers.

    Returns
    -------
    function of (r1x, r1y, r2x, r2y, angle, c_x, c_y, d_x, d_y, side, share) giving K0, D0, K1, D1, D2, each
    (6, 6) over (x1, y1, phi1, x2, y2, phi2)
    """
    q, w = sp.symbols("x1 y1 p1 x2 y2 p2"), sp.symbols("vx1 vy1 vp1 vx2 vy2 vp2")
    r1x, r1y, r2x, r2y, angle, cx, cy, dx, dy = numbers = sp.symbols("r1x r1y r2x r2y angle cx cy dx dy")
    side, share, mu, kn = sp.symbols("side share mu kN")
    rest = {symbol: 0 for symbol in (*q, *w)}

    def moved(x: sp.Expr, y: sp.Expr, phi: sp.Expr, rx: sp.Expr, ry: sp.Expr) -> sp.Matrix:
        turn = sp.Matrix([[sp.cos(phi), -sp.sin(phi)], [sp.sin(phi), sp.cos(phi)]])
        return sp.Matrix([x, y]) + turn * sp.Matrix([rx, ry]) - sp.Matrix([rx, ry])

    def rate(expression: sp.Expr) -> sp.Expr:
        return sum((sp.diff(expression, a) * b for a, b in zip(q, w, strict=True)), sp.Integer(0))

    apart = moved(*q[:3], r1x, r1y) - moved(*q[3:], r2x, r2y)
    axes = sp.Matrix([[sp.cos(angle), sp.sin(angle)], [-sp.sin(angle), sp.cos(angle)]]) * apart
    potential = cx * axes[0] ** 2 / 2 + cy * axes[1] ** 2 / 2
    dissipation = dx * rate(axes[0]) ** 2 / 2 + dy * rate(axes[1]) ** 2 / 2
    # friction: an opposite pair of forces along x; its virtual work is the force times the virtual relative
    # displacement. Its variation: mu times that of the pressing force; and the slope's part: the pad moving
    # along lowers the slip
    pressing = side * (cy * apart[1] + dy * rate(apart[1]))
    friction = mu * pressing + kn * share * rate(apart[0])
    equations = [
        sp.diff(dissipation, b) + sp.diff(potential, a) - friction * sp.diff(apart[0], a)
        for a, b in zip(q, w, strict=True)
    ]
    stiffness, damping = (
        sp.Matrix(6, 6, lambda i, j, by=by: sp.diff(equations[i], by[j]).subs(rest)) for by in (q, w)
    )
    off = {mu: 0, kn: 0}
    parts = [stiffness.subs(off), damping.subs(off), stiffness.diff(mu), damping.diff(mu), damping.diff(kn)]
    assert stiffness.diff(kn).is_zero_matrix
    return sp.lambdify([*numbers, side, share], parts, modules="numpy", cse=True)


@cache
def inertia_terms() -> Callable[[float, float], Matrix]:
    """d/dt dT/dw of a free body: (3, 3) from mass and moment of inertia."""
    mass, inertia = sp.symbols("m J")
    w = sp.symbols("vx vy vp")
    kinetic = (mass * w[0] ** 2 + mass * w[1] ** 2 + inertia * w[2] ** 2) / 2
    return sp.lambdify([mass, inertia], sp.hessian(kinetic, w), modules="numpy")


class System:
    """Bodies and couplings; energies add, so their Lagrange terms add."""

    def __init__(self) -> None:
        self._bodies: list[str] = []
        self._free: list[str] = []
        self._terms: dict[str, list[tuple[tuple[str, ...], Matrix]]] = {}

    def body(self, name: str, freedoms: str | Sequence[str], mass: float = 0.0, inertia: float = 0.0) -> None:
        """Add a body: "xy" or ["x", "y", "phi"]; none: it is at rest."""
        self._bodies.append(name)
        self._free += [f"{name}.{freedom}" for freedom in freedoms]
        self._add("m", (name,), inertia_terms()(mass, inertia))

    def spring(
        self,
        first: Point,
        second: Point,
        stiffness: tuple[float, float],
        damping: tuple[float, float] = (0.0, 0.0),
        angle: float = 0.0,
    ) -> None:
        """Spring and damper along two axes between points (body, rx, ry), turned from x towards y."""
        numbers = (*first[1:], *second[1:], angle, *stiffness, *damping, 0.0, 0.0)
        for key, term in zip(("k0", "d0"), coupling_terms()(*numbers), strict=False):
            self._add(key, (first[0], second[0]), term)

    def contact(
        self, pad: Point, disc: Point, side: int, share: float, stiffness: float, damping: float = 0.0
    ) -> None:
        """Contact with friction: normal along y; the disc slides past in +x and drags the pad along."""
        numbers = (*pad[1:], *disc[1:], 0.0, 0.0, stiffness, 0.0, damping, side, share)
        for key, term in zip(("k0", "d0", "k1", "d1", "d2"), coupling_terms()(*numbers), strict=True):
            self._add(key, (pad[0], disc[0]), term)

    def torsion(self, first: str, second: str, stiffness: float, damping: float = 0.0) -> None:
        """Torsional spring and damper."""
        p1, p2, c = sp.symbols("p1 p2 c")
        unit = np.array(sp.hessian(c * (p1 - p2) ** 2 / 2, (p1, p2)).subs(c, 1), dtype=float)
        term = np.zeros((6, 6))
        term[np.ix_([2, 5], [2, 5])] = unit
        self._add("k0", (first, second), stiffness * term)
        self._add("d0", (first, second), damping * term)

    def linear(self) -> Linear:
        """Sum of all terms over the coordinates that bodies have."""
        everything = [f"{body}.{freedom}" for body in self._bodies for freedom in FREEDOMS]
        place = {name: i for i, name in enumerate(everything)}
        free = [place[name] for name in self._free]
        sums = {}
        for key in ("m", "d0", "d1", "d2", "k0", "k1"):
            total = np.zeros((len(everything), len(everything)))
            for bodies, term in self._terms.get(key, ()):
                rows = [place[f"{body}.{freedom}"] for body in bodies for freedom in FREEDOMS]
                total[np.ix_(rows, rows)] += term
            sums[key] = total[np.ix_(free, free)]
        return Linear(self._free, sums["m"], sums["d0"], sums["d1"], sums["d2"], sums["k0"], sums["k1"])

    def _add(self, key: str, bodies: tuple[str, ...], term: Matrix) -> None:
        self._terms.setdefault(key, []).append((bodies, np.asarray(term, dtype=float)))


def from_brake_file(text: str, **changes: float) -> Linear:
    """Derive a brake from the text of its file, with other values for some parameters."""
    file = tomllib.loads(text)
    numbers = {name: entry["value"] for name, entry in file["parameters"].items()} | changes

    def value(expression: str | None) -> float:
        return 0.0 if expression is None else float(eval(str(expression), {"__builtins__": {}}, numbers))

    system = System()
    for body in file["bodies"]:
        system.body(body["name"], body["freedoms"], value(body.get("mass")), value(body.get("inertia")))
    points = {f"{p['body']}.{p['name']}": (p["body"], value(p["x"]), value(p["y"])) for p in file["points"]}
    for coupling in file["couplings"]:
        first, second = (points[end] for end in coupling["between"])
        if coupling["kind"] == "contact":
            system.contact(
                first, second, coupling["side"], coupling["load_share"], value(coupling["stiffness"]),
                value(coupling.get("damping")),
            )  # fmt: skip
        else:
            c, d = (
                (value(coupling.get(f"{kind}_x")), value(coupling.get(f"{kind}_y")))
                for kind in ("stiffness", "damping")
            )
            system.spring(first, second, c, d, value(coupling.get("angle")))
    for torsion in file.get("torsions", ()):
        system.torsion(*torsion["between"], value(torsion["stiffness"]), value(torsion.get("damping")))
    return system.linear()

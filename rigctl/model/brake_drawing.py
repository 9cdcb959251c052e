"""A brake as a schematic drawing, from its own data: where bodies stand, their outlines, springs between
them.

The brake file gives points from each body's centre of mass and says which of them are coupled. Bodies are
placed so that coupled points meet (friction contacts and bodies that can turn decide; of bodies that only
shift, points have no meaning and are drawn where their partners are). Then bodies are drawn a little apart,
so that springs are seen. Generic: any topology that the brake file allows. NOT its job: what a drawing is
(`drawn_brake`), painting (`brake_painting`, `brake_page`), mechanics.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rigctl.model.drawn_brake import Drawing, DrawnBody, DrawnSpring, Role, displaced, scale_for
from sim_hardware.brake_model.eigen.mode_shapes import point_coordinates
from sim_hardware.brake_model.linear import value_of
from sim_hardware.brake_model.parametric import LinearBrake
from sim_hardware.brake_model.spec import Contact, Spring

__all__ = ["Drawing", "DrawnBody", "DrawnSpring", "displaced", "draw_brake", "scale_for"]

Array = NDArray[np.float64]
#: distance between coupled bodies on the drawing, relative to its width
_GAP = 0.05
_LOOSE = 1e-3
_ROUND = np.array([[np.cos(a), np.sin(a)] for a in np.arange(0.0, 2 * np.pi, np.pi / 6)])


def draw_brake(model: LinearBrake, values: Mapping[str, float] | None = None) -> Drawing:
    """Lay out the drawing of a brake, with other values for some quantities.

    Raises
    ------
    KeyError, ValueError
        see `LinearModel.matrices`
    """
    return _Layout(model, values).drawing()


class _Layout:
    """Working state of a layout: first where points are, then what is drawn apart."""

    def __init__(self, model: LinearBrake, values: Mapping[str, float] | None) -> None:
        spec = model.brake.spec
        self.model, self.values, self.spec = model, values, spec
        self.local = {key: np.array(place) for key, place in point_coordinates(model, values).items()}
        self.freedoms = {body.name: body.freedoms for body in spec.bodies}
        self.turning = {name for name, freedoms in self.freedoms.items() if "phi" in freedoms}
        self.resting = {name for name, freedoms in self.freedoms.items() if not freedoms}
        contacts = [c for c in spec.couplings if isinstance(c, Contact)]
        self.discs = {_body(c.between[1]) for c in contacts}
        self.pads = {_body(c.between[0]): -float(c.side) for c in contacts}  # +1: above the disc
        self.origin = self._origins()
        self.rank = self._ranks()
        xs = [abs(float(self._place(end, mate)[0])) for end, mate in self._ends()] or [0.0]
        ys = [abs(float(self._place(end, mate)[1])) for end, mate in self._ends()] or [0.0]
        self.width = max(2.0 * max(xs), 2.0 * max(ys), 1e-6)
        self.gap = _GAP * self.width
        self.lift = {pad: np.array([0.0, side * self.gap]) for pad, side in self.pads.items()}
        #: drawn points of each body, its springs
        self.points: dict[str, list[Array]] = {name: [] for name in self.freedoms if name not in self.resting}
        self.springs: list[DrawnSpring] = []

    def drawing(self) -> Drawing:
        """The finished drawing."""
        later = []
        for coupling in self.spec.couplings:
            first, second = (_body(end) for end in coupling.between)
            grounded = first in self.resting or second in self.resting
            loose = first not in self.turning and second not in self.turning
            if grounded or loose:
                later.append(coupling)
            else:
                self._join(coupling)
        for name, points in self.points.items():
            if not points:
                points.append(self.origin[name] + self.lift.get(name, 0.0))
        bodies = {name: self._outlined(name) for name in self.points}
        bodies = self._tie(later, bodies)
        self._ground(later, bodies)
        everything = np.concatenate(
            [np.concatenate(b.parts) for b in bodies.values()]
            + [np.stack([s.first[1], s.second[1]]) for s in self.springs]
        )
        low, high = everything.min(axis=0), everything.max(axis=0)
        order = sorted(bodies.values(), key=lambda b: -self.rank[b.name])
        return Drawing(
            tuple(order), tuple(self.springs), (float(low[0]), float(high[0]), float(low[1]), float(high[1]))
        )

    def _ends(self) -> list[tuple[str, str]]:
        pairs = [c.between for c in self.spec.couplings]
        return [*pairs, *((second, first) for first, second in pairs)]

    def _origins(self) -> dict[str, Array]:
        """Places of the centres of mass such that coupled points meet, by weighted least squares."""
        moving = [name for name in self.freedoms if name not in self.resting]
        column = {name: i for i, name in enumerate(moving)}
        rows, right = [], []
        for coupling in self.spec.couplings:
            first, second = (_body(end) for end in coupling.between)
            firm = all(name in self.turning or name in self.resting for name in (first, second))
            weight = 1.0 if firm else _LOOSE
            row = np.zeros(len(moving))
            for name, sign in ((first, 1.0), (second, -1.0)):
                if name in column:
                    row[column[name]] += sign * weight
            rows.append(row)
            right.append(weight * (self.local[coupling.between[1]] - self.local[coupling.between[0]]))
        rows += list(1e-7 * np.eye(len(moving)))  # bodies without couplings stand in the middle
        right += [np.zeros(2)] * len(moving)
        solution = np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0]
        return {**{name: np.zeros(2) for name in self.resting}, **dict(zip(moving, solution, strict=True))}

    def _place(self, end: str, mate: str) -> Array:
        """Where a coupled point is: of bodies that do not turn, where its partner is."""
        body, other = _body(end), _body(mate)
        if body not in self.turning and other in self.turning:
            return self.origin[other] + self.local[mate]
        return self.origin[body] + self.local[end]

    def _ranks(self) -> dict[str, int]:
        """Number of couplings between a body and the disc."""
        rank = {name: 0 for name in self.discs}
        frontier = set(rank)
        while frontier:
            step = set()
            for end, mate in self._ends():
                body, other = _body(end), _body(mate)
                if body in frontier and other not in rank and other not in self.resting:
                    rank[other] = rank[body] + 1
                    step.add(other)
            frontier = step
        return {name: rank.get(name, 9) for name in self.freedoms}

    def _join(self, coupling: Spring | Contact) -> None:
        """A spring between two bodies, drawn a gap long."""
        near, far = sorted(
            coupling.between, key=lambda end: (self.rank[_body(end)], _body(end) not in self.turning)
        )
        inner, outer = _body(near), _body(far)
        start = self._place(near, far)
        if isinstance(coupling, Contact):
            end = start + self.lift[outer] if outer in self.lift else start + np.array([0.0, self.gap])
            kind: Literal["contact", "spring"] = "contact"
        else:
            axis = self._axis(coupling)
            out = np.sign((start - self.origin[inner])[axis]) or 1.0
            start = start + self.lift.get(inner, 0.0)
            end = start.copy()
            end[axis] += out * self.gap
            kind = "spring"
        self.points[inner].append(start)
        self.points[outer].append(end)
        self.springs.append(DrawnSpring(coupling.name, (inner, start), (outer, end), kind))

    def _axis(self, coupling: Spring) -> int:
        """The stiffer direction, 0: x, 1: y."""
        c_x, c_y = (
            value_of(self.model, f"{coupling.name}.stiffness_{axis}", self.values)
            if f"{coupling.name}.stiffness_{axis}" in self.model.quantities
            else 0.0
            for axis in "xy"
        )
        return int(c_y > c_x)

    def _outlined(self, name: str, extra: tuple[Array, ...] = ()) -> DrawnBody:
        points = np.array([*self.points[name], *extra])
        centre = self.origin[name] + self.lift.get(name, 0.0)
        if name not in self.turning and len(self.points[name]):
            centre = points.mean(axis=0)
        if name in self.discs:
            reach = 1.12 * max(self.width / 2.0, float(np.abs(points[:, 0]).max()))
            low, high = points[:, 1].min(), points[:, 1].max()
            if high - low < 0.2 * self.gap:
                low, high = low - 0.5 * self.gap, high + 0.5 * self.gap
            outline = np.array([[-reach, low], [reach, low], [reach, high], [-reach, high]])
            label = np.array([-reach + 0.25 * self.gap, 0.5 * (low + high)])
            return DrawnBody(name, "disc", centre, (outline,), None, label)
        role: Role = "pad" if name in self.pads else "body"
        margin = (0.12 if role == "pad" else 0.42) * self.gap
        middle = np.mean([self.origin[d][1] for d in self.discs]) if self.discs else 0.0
        above = points[:, 1] > middle
        if above.any() and not above.all() and role == "body":
            parts = (_hull(points[~above], margin), _hull(points[above], margin))
            return DrawnBody(name, role, centre, parts, _hull(points, margin), parts[0].mean(axis=0))
        outline = _hull(points, margin)
        return DrawnBody(name, role, centre, (outline,), None, outline.mean(axis=0))

    def _tie(self, later: list[Spring | Contact], bodies: dict[str, DrawnBody]) -> dict[str, DrawnBody]:
        """Springs between bodies that only shift, drawn below everything."""
        level = min(float(np.concatenate(b.parts)[:, 1].min()) for b in bodies.values()) - 0.9 * self.gap
        for coupling in later:
            first, second = (_body(end) for end in coupling.between)
            if first in self.resting or second in self.resting:
                continue
            ends = []
            for name, other in ((first, second), (second, first)):
                body = bodies[name]
                spot = np.array([body.centre[0], level])
                bodies[name] = replace(self._outlined(name, (spot,)), centre=body.centre, label=body.label)
                inward = np.sign(bodies[other].centre[0] - body.centre[0]) or 1.0
                outline = np.concatenate(bodies[name].parts)
                near_level = outline[np.abs(outline[:, 1] - level) < 0.5 * self.gap]
                edge = (near_level[:, 0] * inward).max() * inward if len(near_level) else body.centre[0]
                ends.append((name, np.array([edge, level])))
            self.springs.append(DrawnSpring(coupling.name, ends[0], ends[1], "spring"))
            level -= 0.9 * self.gap
        return bodies

    def _ground(self, later: list[Spring | Contact], bodies: dict[str, DrawnBody]) -> None:
        """Springs to bodies at rest, from the outer edge of the moving body to the ground."""
        for coupling in later:
            names = [_body(end) for end in coupling.between]
            if not set(names) & self.resting or set(names) <= self.resting:
                continue
            name = names[0] if names[1] in self.resting else names[1]
            own = coupling.between[0] if names[1] in self.resting else coupling.between[1]
            body = bodies[name]
            outline = np.concatenate(body.parts)
            place = self.origin[name] + self.local[own]
            side = np.sign(body.centre[0]) or 1.0
            at_centre = name not in self.turning or float(np.linalg.norm(self.local[own])) < 1e-9
            for axis, key in ((0, "x"), (1, "y")):
                if f"{coupling.name}.stiffness_{key}" not in self.model.quantities:
                    continue
                start = place + self.lift.get(name, 0.0)
                if at_centre:
                    edge = outline[np.argmax(outline[:, 0] * side)]
                    inset = 0.0 if axis == 0 else 0.45 * self.gap
                    middle = body.centre[1] if name in self.turning else edge[1]
                    start = np.array([edge[0] - side * inset, middle if axis == 0 else outline[:, 1].min()])
                end = start.copy()
                end[axis] += 1.3 * self.gap * (side if axis == 0 else -1.0)
                self.springs.append(DrawnSpring(coupling.name, (name, start), ("", end), "spring"))
        for torsion in self.spec.torsions:
            name = next((n for n in torsion.between if n not in self.resting), "")
            if name:
                centre = bodies[name].centre
                self.springs.append(DrawnSpring(torsion.name, (name, centre), ("", centre), "torsion"))


def _body(end: str) -> str:
    return end.split(".", maxsplit=1)[0]


def _hull(points: Array, margin: float) -> Array:
    """Convex outline around points, a margin away from them, with round corners."""
    from scipy.spatial import ConvexHull

    cloud = (points[:, None, :] + margin * _ROUND[None, :, :]).reshape(-1, 2)
    return cloud[ConvexHull(cloud).vertices]

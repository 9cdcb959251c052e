"""Eigenvalues over a quantity with mode identity kept: the root locus (Figs 7, 13; sections 4.2, 5.2).

Identity from one point to the next is decided by two independent signs: the eigenvalue predicted by its
derivative at both ends (eq 24), and the correlation of left and right vectors, which is 1 for the same mode
and 0 for others. Where they disagree, or two modes come nearer to each other than they move, the step is
halved. What is left unclear at the finest step is reported, not guessed silently: at an exceptional point
two modes coincide with their vectors, and their identity beyond it has no meaning.

A mode is a pair of eigenvalues: conjugate ones, or two real ones after its vibration has ceased. Modes are
numbered from 1 by frequency at the start of the grid, real pairs first.
NOT its job: maps over two quantities, boundaries by continuation, figures.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from sim_hardware.brake_model.eigen.tracking_events import crossings_of
from sim_hardware.brake_model.eigen.tracking_locus import (
    Crossing,
    Event,
    EventKind,
    Flag,
    Locus,
    checked_grid,
)
from sim_hardware.brake_model.eigen.tracking_nodes import ComplexArray, Match, Node, evaluate, matches
from sim_hardware.brake_model.eigen.tracking_path import Path, Sampler, path_of
from sim_hardware.brake_model.linear import Array, LinearModel, ParameterGroup

__all__ = ["Crossing", "Event", "Flag", "Locus", "Path", "path_of", "track"]

#: halvings of a step at most: modes that come nearer than this fraction of it pass as crossing
MAX_HALVINGS = 16
#: models with more degrees of freedom than this are tracked in a frequency band (`tracking_band`)
DENSE_LIMIT = 200
_EXTRA_POINTS = 2000
_NEARLY_REAL = 0.05
#: grid points where eigenvalues are nearer than this share of the largest are moved by a hair
_MOVED = 1e-6

_FLAG_OF: dict[EventKind, Flag] = {
    "exceptional": Flag.EXCEPTIONAL,
    "crossing": Flag.CROSSED,
    "split": Flag.SPLIT,
    "merge": Flag.MERGED,
    "unresolved": Flag.UNRESOLVED,
}


def track(
    model: LinearModel,
    what: str | ParameterGroup | Mapping[str, float] | Path,
    grid: Sequence[float] | Array,
    values: Mapping[str, float] | None = None,
    *,
    asymmetric: bool = False,
    max_halvings: int = MAX_HALVINGS,
) -> Locus:
    """Track all eigenvalues over a quantity, or over the common relative factor of a parameter group.

    Parameters
    ----------
    what : name of a quantity ("mu", "pressure" in bar, "c_pis_n", "piston_l.stiffness_y"), name of a group,
        the group, name -> sign of a relative variation, or a `Path`; see `tracking_path.path_of`
    grid : (g,) at least two values, strictly ascending or descending; relative factors (1: as in the file)
        for groups
    values : other quantities that differ from the file
    asymmetric : of a group: leading members by the factor s, trailing ones by 2 - s
    max_halvings : of a step, where identity is unclear

    Raises
    ------
    KeyError, ValueError
        unknown name, bad grid, or a value that the model refuses
    """
    path = path_of(model, what, values, asymmetric=asymmetric)
    points = checked_grid(grid)
    if len(model.freedoms) > DENSE_LIMIT:
        raise ValueError(
            f"the model has {len(model.freedoms)} degrees of freedom, more than {DENSE_LIMIT}: "
            "track the modes of a frequency band (--band HZ HZ; tracking_band.track_band)"
        )
    ascending = bool(points[-1] > points[0])
    upward = points if ascending else points[::-1]
    tracker = _Tracker(Sampler(model, path, float(upward[0]), float(upward[-1])), points, max_halvings)
    return tracker.locus(model.name, path)


@dataclass(slots=True)
class _Link:
    """From a node to the next; `kind` says what is unclear, () where nothing is."""

    end: Node
    match: Match | None
    unclear: tuple[tuple[EventKind, tuple[int, ...]], ...] = ()


class _Tracker:
    """Nodes along a grid, joined by links, then walked mode by mode."""

    def __init__(self, sampler: Sampler, grid: Array, max_halvings: int) -> None:
        self.sampler, self.grid, self.max_halvings = sampler, grid, max_halvings
        matrices, _ = sampler.matrices(grid[[0, -1]])
        inertia = np.maximum(np.abs(np.einsum("gii->gi", matrices[:, 0])), 1e-300)
        square = np.abs(np.einsum("gii->gi", matrices[:, 2])) / inertia
        self.scale = float(np.sqrt(np.median(square[square > 0]))) if (square > 0).any() else 1.0
        self.extra = 0
        #: grid points whose node was moved -> the node at the point itself
        self.exact: dict[int, Node] = {}

    def node(self, s: float) -> Node:
        """Return a node."""
        return evaluate(self.sampler, np.array([s]), self.scale)[0]

    def locus(self, name: str, path: Path) -> Locus:
        nodes = self._apart(evaluate(self.sampler, self.grid, self.scale))
        links: list[list[_Link]] = []
        groups = itertools.groupby(
            range(len(nodes) - 1), key=lambda k: (nodes[k].signature, nodes[k + 1].signature)
        )
        for (first, second), members in groups:
            steps = list(members)
            if first != second:
                links += [self._refined(nodes[k], nodes[k + 1], 0) for k in steps]
                continue
            found = matches([nodes[k] for k in steps], [nodes[k + 1] for k in steps])
            for k, match in zip(steps, found, strict=True):
                clear = match.clear
                links.append(
                    [_Link(nodes[k + 1], match)] if clear else self._refined(nodes[k], nodes[k + 1], 0)
                )
        return _walked(name, path, self.grid, nodes[0], links, self)

    def _apart(self, nodes: list[Node]) -> list[Node]:
        """Return the nodes, those with coinciding eigenvalues moved inwards: vectors mean nothing there."""
        step = float(self.grid[1] - self.grid[0])
        n = max(len(node.values) for node in nodes)
        values = np.stack(
            [np.pad(node.values, (0, n - len(node.values)), constant_values=np.nan) for node in nodes]
        )
        distance = np.abs(values[:, :, None] - values[:, None, :])
        distance[:, np.arange(n), np.arange(n)] = np.inf
        nearest = np.nanmin(distance, axis=(1, 2))
        for k in np.flatnonzero(nearest < _MOVED * np.nanmax(np.abs(values), axis=1)).tolist():
            self.exact[k] = nodes[k]
            nodes[k] = self.node(nodes[k].s + 1e-5 * step * (1 if k < len(nodes) - 1 else -1))
        return nodes

    def _refined(self, start: Node, end: Node, depth: int) -> list[_Link]:
        same = start.signature == end.signature
        match = matches([start], [end])[0] if same else None
        if match is not None and match.clear:
            return [_Link(end, match)]
        exhausted = self.extra >= _EXTRA_POINTS
        if depth < self.max_halvings and not exhausted:
            self.extra += 1
            middle = self.node(0.5 * (start.s + end.s))
            return [*self._refined(start, middle, depth + 1), *self._refined(middle, end, depth + 1)]
        if match is None:
            return [_Link(end, None, (("unresolved", ()),) if exhausted else ())]
        if exhausted:
            return [_Link(end, match, (("unresolved", _indices(match.doubtful | match.close)),))]
        unclear: list[tuple[EventKind, tuple[int, ...]]] = []
        # those that coincide with their vectors; the others only pass
        if match.doubtful.any():
            unclear.append(("exceptional", _indices(match.doubtful)))
        if (passing := match.close & ~match.doubtful).any():
            unclear.append(("crossing", _indices(passing)))
        return [_Link(end, match, tuple(unclear))]


def _indices(mask: NDArray[np.bool_]) -> tuple[int, ...]:
    return tuple(int(i) for i in np.flatnonzero(mask))


def _walked(
    name: str, path: Path, grid: Array, first: Node, links: list[list[_Link]], tracker: _Tracker
) -> Locus:
    """Follow every mode along the links."""
    slots = _first_slots(first)
    chain = [(first, slots)]
    at_grid, events = [0], []
    flags = np.zeros((len(grid), len(slots)), dtype=np.uint8)
    for k, step in enumerate(links, start=1):
        for link in step:
            start = chain[-1][0]
            slots, found = _followed(start, slots, link)
            for event in found:
                events.append(event)
                for mode in event.modes:
                    flags[k, mode - 1] |= np.uint8(_FLAG_OF[event.kind])
            chain.append((link.end, slots))
        at_grid.append(len(chain) - 1)
    fine = np.array([node.s for node, _ in chain])
    fine[at_grid] = grid  # nodes may have been moved by a hair
    upper: ComplexArray = np.stack([node.values[slots[:, 0]] for node, slots in chain])
    rates = np.stack([node.rates[slots[:, 0]] for node, slots in chain])
    conjugate = np.stack([slots[:, 1] < 0 for _, slots in chain])
    lower: ComplexArray = np.stack([node.values[slots[:, 1]] for node, slots in chain])
    lower = np.where(conjugate, upper.conj(), lower)
    for k, node in tracker.exact.items():
        moved, slots = chain[at_grid[k]]
        upper[at_grid[k]], lower[at_grid[k]] = _exact_values(moved, slots, node)
    conjugate = (np.imag(upper) != 0.0) | (np.imag(lower) != 0.0)
    flags[~conjugate[at_grid]] |= np.uint8(Flag.REAL)
    locus = Locus(
        name, path, grid, upper[at_grid], lower[at_grid], flags, _merged(events), fine, upper, lower, rates
    )
    return replace(locus, crossings=crossings_of(locus, tracker.node))


def _exact_values(moved: Node, slots: NDArray[np.intp], exact: Node) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues of every mode at a grid point whose node was moved by a hair."""
    from scipy.optimize import linear_sum_assignment

    n = moved.n_complex
    there = np.concatenate([moved.values, moved.values[:n].conj()])
    here = np.concatenate([exact.values, exact.values[: exact.n_complex].conj()])
    onto = linear_sum_assignment(np.abs(there[:, None] - here[None, :]))[1]
    partner = np.where(slots[:, 1] < 0, len(moved.values) + slots[:, 0], slots[:, 1])
    upper: ComplexArray = here[onto[slots[:, 0]]]
    lower: ComplexArray = here[onto[partner]]
    swap = (upper.imag < lower.imag) | ((upper.imag == lower.imag) & (upper.real < lower.real))
    return np.where(swap, lower, upper), np.where(swap, upper, lower)


def _first_slots(node: Node) -> NDArray[np.intp]:
    """(m, 2) indices of each mode's eigenvalues: (i, -1) for a conjugate pair, (larger, smaller) for real
    ones.
    """
    n_complex, n_real = node.signature
    real = range(n_complex, n_complex + n_real)
    pairs = [(high, low) for low, high in zip(real[::2], real[1::2], strict=True)]
    return np.array([*pairs, *((i, -1) for i in range(n_complex))], dtype=np.intp)


def _followed(start: Node, slots: NDArray[np.intp], link: _Link) -> tuple[NDArray[np.intp], list[Event]]:
    """Slots at the end of a link, and what happened on it."""
    end, middle = link.end, 0.5 * (start.s + link.end.s)
    events: list[Event] = []
    if link.match is not None:
        order = link.match.order
        moved = np.where(slots >= 0, order[slots], -1)
    else:
        moved = _changed(start, slots, end, middle, events)
    real = moved[:, 1] >= 0
    if real.any():  # the larger of two real eigenvalues first
        swap = real & (end.values[moved[:, 0]].real < end.values[moved[:, 1]].real)
        moved[swap] = moved[swap][:, ::-1]
    for kind, indices in link.unclear:
        modes = [m for m, pair in enumerate(slots) if set(pair.tolist()) & set(indices)]
        places = {m: complex(start.values[int(slots[m, 0])]) for m in modes}
        for group in _together(places):
            if len(group) == 1 and abs(places[group[0]].imag) < _NEARLY_REAL * abs(places[group[0]]):
                continue  # both eigenvalues of one mode meet: they are one mode either way
            events.append(Event(kind, middle, tuple(m + 1 for m in group), places[group[0]]))
    return moved, events


def _together(places: Mapping[int, complex]) -> Iterator[list[int]]:
    """Modes grouped by where they are: those nearer to each other than to the rest."""
    left = sorted(places, key=lambda m: (places[m].imag, places[m].real))
    size = max((abs(z) for z in places.values()), default=0.0)
    while left:
        group = [left.pop(0)]
        while left and abs(places[left[0]] - places[group[-1]]) < 1e-2 * size:
            group.append(left.pop(0))
        yield group


def _changed(
    start: Node, slots: NDArray[np.intp], end: Node, middle: float, events: list[Event]
) -> NDArray[np.intp]:
    """Slots where pairs split into real eigenvalues or real ones merge to pairs."""
    from scipy.optimize import linear_sum_assignment

    onward: dict[int, int] = {}
    for a, b in (
        (range(start.n_complex), range(end.n_complex)),
        (range(start.n_complex, len(start.values)), range(end.n_complex, len(end.values))),
    ):
        cost = np.abs(start.values[list(a)][:, None] - end.values[list(b)][None, :])
        if cost.size:
            rows, columns = linear_sum_assignment(cost)
            onward |= {a[int(i)]: b[int(j)] for i, j in zip(rows, columns, strict=True)}
    free = [i for i in range(len(end.values)) if i not in onward.values()]
    moved = np.array(
        [[onward.get(int(i), -1) if i >= 0 else -1 for i in pair] for pair in slots], dtype=np.intp
    )
    for m in range(len(slots)):
        if slots[m, 1] < 0 and moved[m, 0] < 0:  # a vibration has ceased
            near = sorted(free, key=lambda i: abs(end.values[i] - start.values[slots[m, 0]]))[:2]
            moved[m] = near
            free = [i for i in free if i not in near]
            events.append(Event("split", middle, (m + 1,), complex(end.values[near[0]])))
    broken = [m for m in range(len(slots)) if slots[m, 1] >= 0 and (moved[m] < 0).any()]
    for m in [m for m in broken if (moved[m] < 0).all()]:
        near = min(free, key=lambda i: abs(end.values[i] - start.values[slots[m, 0]]))
        moved[m] = near, -1
        free.remove(near)
        broken.remove(m)
        events.append(Event("merge", middle, (m + 1,), complex(end.values[near])))
    while (
        broken
    ):  # real eigenvalues of two modes begin to vibrate together: the remaining two are the other mode
        m = broken.pop(0)
        gone = start.values[slots[m][moved[m] < 0][0]]
        other = min(broken, key=lambda k: abs(start.values[slots[k][moved[k] < 0][0]] - gone))
        broken.remove(other)
        kept = moved[m].max(), moved[other].max()
        near = min(free, key=lambda i: abs(end.values[i] - gone))
        free.remove(near)
        moved[m], moved[other] = (near, -1), kept
        events.append(Event("merge", middle, (m + 1,), complex(end.values[near])))
        events.append(Event("exceptional", middle, (m + 1, other + 1), complex(end.values[near])))
    return moved


def _merged(events: list[Event]) -> tuple[Event, ...]:
    """Events of one kind and one group of modes on neighbouring finest steps are one event."""
    kept: list[Event] = []
    for event in events:
        near = next((e for e in kept if e.kind == event.kind and e.modes == event.modes), None)
        if near is None or abs(event.value - near.value) > 1e-3 * abs(event.value) + 1e-12:
            kept.append(event)
    return tuple(kept)

"""Lines between two kinds of points on a grid: which edges they cross, and in which order (marching squares).

NOT its job: where on an edge the line crosses (`maps` finds that exactly).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Index = NDArray[np.intp]


@dataclass(frozen=True, slots=True)
class Edges:
    """Edges of a grid whose ends are of different kinds.

    Attributes
    ----------
    row, column : (k,) the end of lower indices
    along_x : (k,) whether the other end is the next column; else the next row
    """

    row: Index
    column: Index
    along_x: NDArray[np.bool_]


def crossed_edges(kind: NDArray[np.bool_]) -> Edges:
    """All edges of a grid (ny, nx) between points of different kind."""
    row_x, column_x = np.nonzero(kind[:, 1:] != kind[:, :-1])
    row_y, column_y = np.nonzero(kind[1:] != kind[:-1])
    return Edges(
        np.concatenate([row_x, row_y]),
        np.concatenate([column_x, column_y]),
        np.concatenate([np.ones(len(row_x), bool), np.zeros(len(row_y), bool)]),
    )


def linked(edges: Edges, kind: NDArray[np.bool_], level: NDArray[np.float64]) -> list[tuple[list[int], bool]]:
    """Edges in the order in which the line crosses them, and whether it is closed, for every connected line.

    Parameters
    ----------
    kind : (ny, nx)
    level : (ny, nx) > 0 towards `kind` True; decides at saddles, where four edges of a cell are crossed
    """
    number = {
        (int(r), int(c), bool(x)): k
        for k, (r, c, x) in enumerate(zip(edges.row, edges.column, edges.along_x, strict=True))
    }
    neighbours: list[list[int]] = [[] for _ in number]
    for row, column in _cells(edges, kind.shape):
        sides = (
            (row, column, True), (row, column + 1, False), (row + 1, column, True), (row, column, False),
        )  # bottom, right, top, left  # fmt: skip
        crossed = [number[s] for s in sides if s in number]
        if len(crossed) == 4:
            middle = level[row : row + 2, column : column + 2].mean() > 0.0
            bottom, right, top, left = crossed
            joined = middle == bool(kind[row, column])
            pairs = [(bottom, right), (top, left)] if joined else [(bottom, left), (right, top)]
        else:
            pairs = [(crossed[0], crossed[1])]
        for one, other in pairs:
            neighbours[one].append(other)
            neighbours[other].append(one)
    return _traced(neighbours)


def _cells(edges: Edges, shape: tuple[int, ...]) -> list[tuple[int, int]]:
    """Cells with a crossed edge."""
    found: set[tuple[int, int]] = set()
    for r, c, x in zip(edges.row.tolist(), edges.column.tolist(), edges.along_x.tolist(), strict=True):
        found.add((r, c))
        found.add((r - 1, c) if x else (r, c - 1))
    return sorted((r, c) for r, c in found if 0 <= r < shape[0] - 1 and 0 <= c < shape[1] - 1)


def _traced(neighbours: list[list[int]]) -> list[tuple[list[int], bool]]:
    """Chains of a graph in which nobody has more than two neighbours, those with ends first."""
    done = [False] * len(neighbours)
    lines: list[tuple[list[int], bool]] = []
    order = sorted(range(len(neighbours)), key=lambda k: len(neighbours[k]))
    for first in order:
        if done[first]:
            continue
        chain, here = [first], first
        done[first] = True
        while True:
            onward = [k for k in neighbours[here] if not done[k]]
            if not onward:
                break
            here = onward[0]
            done[here] = True
            chain.append(here)
        closed = len(neighbours[first]) == 2 and len(chain) > 2 and first in neighbours[here]
        lines.append((chain, closed))
    return lines

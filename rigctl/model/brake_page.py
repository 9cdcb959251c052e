"""Modes of a brake as one self-contained page: SVG drawn and moved by a script of its own, no other files.

Job: fill the page (`modes_page.html`) with its data. NOT its job: where bodies stand (`brake_drawing`),
painting figures.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from importlib.resources import files
from string import Template
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.model.brake_drawing import Drawing
from rigctl.model.brake_painting import Motions, body_colours, ground_path, label_of

#: browsers draw text badly where a unit is a metre: coordinates on the page are millimetres
_MM = 1000.0


@dataclass(frozen=True, slots=True)
class PageMode:
    """A mode of the page: number, heading, facts as lines of text, motions."""

    number: int
    heading: str
    facts: Sequence[str]
    motions: Motions


def modes_page(title: str, picture: Drawing, modes: Sequence[PageMode], shown: int) -> str:
    """Return the page (HTML) with all modes to choose from, `shown` (number) at first."""
    data = {"bodies": _bodies(picture), "springs": _springs(picture), "modes": [_mode(m) for m in modes]}
    first = next(k for k, mode in enumerate(modes) if mode.number == shown)
    x0, x1, y0, y1 = (_MM * edge for edge in picture.box)
    size = _MM * picture.size
    room = 0.07 * size
    disc = next((b for b in picture.bodies if b.role == "disc"), None)
    arrow = ""
    if disc is not None:
        x, y = _MM * float(disc.parts[0][:, 0].min()), -_MM * float(disc.parts[0][:, 1].max()) - 0.025 * size
        tip, head = x + 0.13 * size, 0.012 * size
        arrow = (
            f'<path class="arrow" '
            f'd="M{x} {y}H{tip}m{-head} {-head / 2}l{head} {head / 2}l{-head} {head / 2}"/>'
            f'<text x="{x}" y="{y - head}" class="small">disc moves</text>'
        )
    return Template(_template()).substitute(
        title=escape(title),
        box=f"{x0 - room} {-(y1 + room)} {x1 - x0 + 2 * room} {y1 - y0 + 2 * room}",
        size=size,
        arrow=arrow,
        first=first,
        data=json.dumps(data, separators=(",", ":"), allow_nan=False).replace("</", "<\\/"),
    )


def _template() -> str:
    return files("rigctl.model").joinpath("modes_page.html").read_text(encoding="utf-8")


def _bodies(picture: Drawing) -> list[dict[str, Any]]:
    looks = body_colours(picture)
    return [
        {
            "name": b.name, "text": label_of(b.name), "fill": looks[b.name][0], "edge": looks[b.name][1],
            "centre": _list(b.centre), "label": _list(b.label), "left": b.role == "disc",
            "parts": [_list(p) for p in b.parts], "bridge": None if b.bridge is None else _list(b.bridge),
        }
        for b in picture.bodies
    ]  # fmt: skip


def _springs(picture: Drawing) -> list[dict[str, Any]]:
    found = []
    for s in picture.springs:
        ground = None
        if not s.second[0] and s.kind != "torsion":
            path = ground_path(s.first[1], s.second[1], 0.03 * picture.size)
            ground = [_list(path[k : k + 2]) for k in range(0, len(path), 3)]
        ends = [{"body": name, "at": _list(place)} for name, place in (s.first, s.second)]
        found.append({"coupling": s.coupling, "kind": s.kind, "ends": ends, "ground": ground})
    return found


def _mode(mode: PageMode) -> dict[str, Any]:
    motions: Mapping[str, NDArray[np.complex128]] = mode.motions.bodies
    return {
        "number": mode.number, "heading": mode.heading, "facts": list(mode.facts),
        "scale": mode.motions.scale,
        "motions": {
            name: [[f * float(z.real), f * float(z.imag)] for z, f in zip(m, (_MM, _MM, 1.0), strict=True)]
            for name, m in motions.items()
        },
        "strain": {name: round(float(share), 5) for name, share in mode.motions.strain.items()},
    }  # fmt: skip


def _list(points: NDArray[np.float64]) -> list[Any]:
    return np.round(_MM * points, 3).tolist()

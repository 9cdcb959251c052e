"""Painting of a deformed brake with matplotlib, and as animated GIF.

NOT its job: where bodies stand (`brake_drawing`), the page with its own animation (`brake_page`).
"""

from __future__ import annotations

import math
from io import BytesIO

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.patches import Polygon
from numpy.typing import NDArray
from PIL import Image

from rigctl.analysis.style import GREY, INK, TITLE, VERMILION, drawing, new_figure
from rigctl.model.drawn_brake import (
    Drawing,
    DrawnBody,
    DrawnSpring,
    Motions,
    displaced,
    ground_path,
    label_of,
    spring_path,
)

__all__ = [
    "Motions",
    "animated_gif",
    "body_colours",
    "frame",
    "ground_path",
    "label_of",
    "paint",
    "spring_path",
]

Array = NDArray[np.float64]

#: fill and edge by role, safe for the colour-blind; other bodies in turn
DISC, PAD = ("#C9D0D8", "#5B6672"), ("#E69F00", "#9A6A00")
OTHERS = (("#9CC9E8", "#1F6FA3"), ("#9AD3BF", "#00775A"), ("#DDB6CF", "#9A5680"), ("#D9D4B0", "#7A7340"))
_DPI = 90


def body_colours(picture: Drawing) -> dict[str, tuple[str, str]]:
    """Fill and edge colour of every body; halves of one thing ("carrier_l", "carrier_t") alike."""
    looks: dict[str, tuple[str, str]] = {}
    families: dict[str, tuple[str, str]] = {}
    for body in sorted(picture.bodies, key=lambda b: b.name):
        if body.role != "body":
            looks[body.name] = DISC if body.role == "disc" else PAD
            continue
        family = body.name.rsplit("_", 1)[0]
        families.setdefault(family, OTHERS[len(families) % len(OTHERS)])
        looks[body.name] = families[family]
    return looks


def paint(axes: Axes, picture: Drawing, motions: Motions, phase_rad: float, *, names: bool = True) -> None:
    """Paint the brake at a phase, the brake at rest as dashed outlines behind it."""
    looks = body_colours(picture)
    for body in picture.bodies:
        _paint_body(axes, body, motions, phase_rad, looks[body.name])
    for spring in picture.springs:
        _paint_spring(axes, picture, spring, motions, phase_rad)
    if names:
        for body in picture.bodies:
            place = displaced(
                body.label[None, :], body.centre, motions.of(body.name), phase_rad, motions.scale
            )[0]
            axes.text(
                float(place[0]), float(place[1]), label_of(body.name), va="center", fontsize=7.5, color=INK,
                ha="left" if body.role == "disc" else "center", zorder=9,
                bbox={"boxstyle": "round,pad=0.15", "fc": "white", "ec": "none", "alpha": 0.65},
            )  # fmt: skip
    frame(axes, picture)


def frame(axes: Axes, picture: Drawing) -> None:
    """Limits with room for the motion, equal scales, and the sense in which the disc moves."""
    x0, x1, y0, y1 = picture.box
    room = 0.07 * picture.size
    axes.set_xlim(x0 - room, x1 + room)
    axes.set_ylim(y0 - room, y1 + room)
    axes.set_aspect("equal")
    axes.set_axis_off()
    disc = next((body for body in picture.bodies if body.role == "disc"), None)
    if disc is not None:
        left = disc.parts[0][:, 0].min()
        y = disc.parts[0][:, 1].max() + 0.025 * picture.size
        axes.annotate(
            "", xy=(left + 0.13 * picture.size, y), xytext=(left, y), annotation_clip=False,
            arrowprops={"arrowstyle": "-|>", "color": INK, "lw": 1.2, "mutation_scale": 11},
        )  # fmt: skip
        axes.text(left, y + 0.012 * picture.size, "disc moves", fontsize=7.5, color=INK, va="bottom")


def _paint_body(
    axes: Axes, body: DrawnBody, motions: Motions, phase_rad: float, look: tuple[str, str]
) -> None:
    fill, edge = look
    depth = {"disc": 2.0, "pad": 3.0, "body": 2.5}[body.role]

    def moved(outline: Array) -> Array:
        return displaced(outline, body.centre, motions.of(body.name), phase_rad, motions.scale)

    if body.bridge is not None:
        axes.add_patch(
            Polygon(moved(body.bridge), closed=True, fc=fill, ec=edge, alpha=0.22, lw=0.8, zorder=1.0)
        )
    for outline in body.parts:
        axes.add_patch(
            Polygon(outline, closed=True, fill=False, ec=GREY, lw=0.8, ls=(0, (4, 3)), zorder=depth + 1.5)
        )
        axes.add_patch(
            Polygon(moved(outline), closed=True, fc=fill, ec=edge, alpha=0.85, lw=1.3, zorder=depth)
        )


def _paint_spring(
    axes: Axes, picture: Drawing, spring: DrawnSpring, motions: Motions, phase_rad: float
) -> None:
    share = motions.strain.get(spring.coupling, 0.0)
    colour = VERMILION if share >= 0.08 else INK
    width = 0.9 + 2.6 * math.sqrt(min(share, 1.0))
    ends = []
    for name, place in (spring.first, spring.second):
        centre = picture.body(name).centre if name else place
        ends.append(displaced(place[None, :], centre, motions.of(name), phase_rad, motions.scale)[0])
    path = spring_path(ends[0], ends[1], spring.kind, 0.012 * picture.size)
    axes.plot(
        path[:, 0],
        path[:, 1],
        color=colour,
        lw=width,
        zorder=6,
        solid_capstyle="round",
        solid_joinstyle="round",
    )
    if spring.kind == "contact":
        axes.plot(*np.transpose(ends), "o", ms=2.6, color=colour, zorder=6)
    if not spring.second[0] and spring.kind != "torsion":
        ground = ground_path(spring.first[1], spring.second[1], 0.03 * picture.size)
        axes.plot(ground[:, 0], ground[:, 1], color=GREY, lw=1.0, zorder=5)


def animated_gif(
    picture: Drawing, motions: Motions, title: str, *, frames: int = 24, seconds: float = 1.6
) -> bytes:
    """One period as an endless GIF."""
    x0, x1, y0, y1 = picture.box
    room = 0.14 * picture.size
    width = 7.6
    height = width * (y1 - y0 + room) / (x1 - x0 + room) + 0.5
    images = []
    with drawing():
        for k in range(frames):
            figure = new_figure(width, height)
            axes = figure.add_axes((0.01, 0.01, 0.98, 1.0 - 0.52 / height))
            figure.suptitle(title, x=0.02, y=1.0 - 0.12 / height, **TITLE)
            paint(axes, picture, motions, 2.0 * np.pi * k / frames)
            figure.set_dpi(_DPI)
            canvas = FigureCanvasAgg(figure)
            canvas.draw()
            opaque = np.ascontiguousarray(np.asarray(canvas.buffer_rgba())[:, :, :3])
            images.append(Image.fromarray(opaque))
    palette = images[0].quantize(96, dither=Image.Dither.NONE)
    shrunk = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    data = BytesIO()
    shrunk[0].save(
        data, "GIF", save_all=True, append_images=shrunk[1:], duration=int(1000 * seconds / frames), loop=0,
        optimize=False, disposal=1,
    )  # fmt: skip
    return data.getvalue()

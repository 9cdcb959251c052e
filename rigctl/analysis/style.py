"""The look of all figures: sizes, colours safe for the colour-blind, and the way they are saved.

Job: `new_figure`, colours, `render`. NOT its job: what is drawn (`figures`, `spectrogram_figure`).

Figures are made with matplotlib's object interface on the Agg canvas: no pyplot, no global figure list.
"""

from dataclasses import dataclass
from io import BytesIO, StringIO
from typing import Any

import matplotlib as mpl
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure

# Okabe and Ito's palette.
BLUE, ORANGE, GREEN, VERMILION, PURPLE, SKY, GREY = (
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#D55E00",
    "#CC79A7",
    "#56B4E9",
    "#7A7A7A",
)
INK, PALE = "#1C2530", "#E6E9ED"
TITLE: Any = {"ha": "left", "va": "top", "fontsize": 10.5, "fontweight": "bold"}
PNG_DPI = 130
_PNG: Any = {"compress_level": 4}

LEVEL_MAP = LinearSegmentedColormap.from_list(
    "level", [mpl.colormaps["inferno_r"](x) for x in (0.16, 0.3, 0.45, 0.6, 0.75, 0.9)]
)
LEVEL_NORM = Normalize(60.0, 100.0, clip=True)
"""One colour scale of sound levels for all figures, dB."""

STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9.5,
    "axes.titlesize": 10.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelcolor": INK,
    "axes.edgecolor": "#8B95A1",
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.grid": False,
    "grid.color": PALE,
    "grid.linewidth": 0.8,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 9,
    "ytick.labelsize": 9,
    "legend.fontsize": 8.5,
    "legend.frameon": True,
    "legend.framealpha": 0.92,
    "legend.edgecolor": PALE,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "svg.fonttype": "path",
    "svg.hashsalt": "rigctl",
}
"""To be used as `with matplotlib.rc_context(STYLE)` around drawing and rendering."""


@dataclass(frozen=True, slots=True)
class Rendered:
    """A figure as files: PNG bytes, SVG text, and its height-to-width ratio."""

    png: bytes
    svg: str
    aspect: float


def new_figure(width_in: float = 8.0, height_in: float = 4.6) -> Figure:
    """An empty figure on its own Agg canvas."""
    figure = Figure(figsize=(width_in, height_in))
    FigureCanvasAgg(figure)
    return figure


def grid(axes: Axes, which: str = "both") -> None:
    """Light grid lines along one or both axes."""
    axes.grid(True, axis=which)  # type: ignore[arg-type]


def render(figure: Figure) -> Rendered:
    """PNG and SVG of a figure; the same figure gives the same bytes (no dates, fixed ids)."""
    png, svg = BytesIO(), StringIO()
    figure.savefig(png, format="png", dpi=PNG_DPI, metadata={"Software": None}, pil_kwargs=_PNG)
    figure.savefig(svg, format="svg", metadata={"Date": None})
    width, height = figure.get_size_inches()
    return Rendered(png.getvalue(), svg.getvalue(), float(height / width))

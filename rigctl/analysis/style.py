"""The look of all figures: sizes, colours safe for the colour-blind, and the way they are saved.

Job: `drawing`, `new_figure`, colours, `label_axes`, `render`. NOT its job: what is drawn (`figures`,
`spectrogram_figure`).

Figures are made with matplotlib's object interface on the Agg canvas: no pyplot, no global figure list.
Layout is fixed: placing labels and titles automatically measures every tick label several times per drawing.
"""

import gc
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO, StringIO
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.transforms import ScaledTranslation
from PIL import Image

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
_PNG: Any = {"compress_level": 4, "compress_type": zlib.Z_RLE}

LEVEL_MAP = LinearSegmentedColormap.from_list(
    "level", [mpl.colormaps["inferno_r"](x) for x in (0.16, 0.3, 0.45, 0.6, 0.75, 0.9)]
)
LEVEL_NORM = Normalize(60.0, 100.0, clip=True)
"""One colour scale of sound levels for all figures, dB."""

STYLE: Any = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans", "Verdana", "Bitstream Vera Sans", "Arial"],
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
    "svg.fonttype": "none",
    "svg.hashsalt": "rigctl",
}
"""In force in `with drawing()`. Text in SVG stays text: it can be searched, and is set in the first of these
fonts that the reader has (DejaVu Sans, which measures it here, is the widest).
"""


@dataclass(frozen=True, slots=True)
class Rendered:
    """A figure as files: PNG bytes, SVG text, and its height-to-width ratio."""

    png: bytes
    svg: str
    aspect: float


@contextmanager
def drawing() -> Iterator[None]:
    """Style set and cyclic garbage collection paused, both as before afterwards.

    Figures are some hundred thousand objects that live until they are saved; collecting among them finds
    nothing and takes a quarter of the time.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        with mpl.rc_context(STYLE):
            yield
    finally:
        if collecting:
            gc.enable()


def new_figure(width_in: float = 8.0, height_in: float = 4.6) -> Figure:
    """An empty figure on its own Agg canvas."""
    figure = Figure(figsize=(width_in, height_in))
    FigureCanvasAgg(figure)
    return figure


def grid(axes: Axes, which: str = "both") -> None:
    """Light grid lines along one or both axes."""
    axes.grid(True, axis=which)  # type: ignore[arg-type]


def label_axes(
    axes: Axes, x: str = "", y: str = "", *, x_gap_pt: float = 20.0, y_gap_pt: float = 27.0
) -> None:
    """Axis labels at a fixed distance in points from the axes; a negative `y_gap_pt` is right of them."""
    scale = axes.get_figure(root=True).dpi_scale_trans  # type: ignore[union-attr]
    if x:
        axes.set_xlabel(x)
        below = ScaledTranslation(0.0, -x_gap_pt / 72.0, scale)
        axes.xaxis.set_label_coords(0.5, 0.0, transform=axes.transAxes + below)
    if y:
        axes.set_ylabel(y)
        beside = ScaledTranslation(-y_gap_pt / 72.0, 0.0, scale)
        axes.yaxis.set_label_coords(float(y_gap_pt < 0), 0.5, transform=axes.transAxes + beside)


def axes_title(axes: Axes, text: str) -> None:
    """Title above the left end of the axes."""
    axes.set_title(text, y=1.0)


def colour_bar(
    axes: Axes,
    mappable: ScalarMappable,
    text: str,
    left: float = 0.91,
    *,
    gap_pt: float = 27.0,
    **options: Any,
) -> None:
    """Labelled colour bar beside axes and of their height; `left` is its left edge in the figure, 0...1."""
    box = axes.get_position()
    figure = axes.get_figure(root=True)
    if figure is None:
        raise ValueError("axes: they are in no figure. Make them by new_figure().subplots()")
    place = figure.add_axes((left, box.y0, 0.144 / figure.get_figwidth(), box.height))
    bar = figure.colorbar(mappable, cax=place, **options)
    bar.outline.set_visible(False)  # type: ignore[operator]
    label_axes(place, y=text, y_gap_pt=-gap_pt)


def render(figure: Figure) -> Rendered:
    """PNG and SVG of a figure; the same figure gives the same bytes (no dates, fixed ids)."""
    png, svg = BytesIO(), StringIO()
    figure.set_dpi(PNG_DPI)
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    opaque = np.asarray(canvas.buffer_rgba())[:, :, :3]
    Image.fromarray(np.ascontiguousarray(opaque)).save(png, "png", dpi=(PNG_DPI, PNG_DPI), **_PNG)
    FigureCanvasSVG(figure).print_svg(svg, metadata={"Date": None})
    width, height = figure.get_size_inches()
    return Rendered(png.getvalue(), svg.getvalue(), float(height / width))

"""The paper's figures from our model: figures 1, 7, 8, 9, 10, 11 and 13, each with its numbers beside ours.

Job: which figure comes from which study and brake file; one page `figures.html` with all of them, and
`paper_numbers.csv`. NOT its job: the studies themselves.
"""

from __future__ import annotations

import base64
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined

from rigctl import __version__
from rigctl.model.beside_paper import NAME
from rigctl.model.loading import read_brake, read_model
from rigctl.model.output import Column, Study, Table, plain, write

_SVG_LIMIT = 600_000


@dataclass(frozen=True, slots=True)
class PaperFigure:
    """A figure of the paper.

    Attributes
    ----------
    number, caption : as the paper prints them
    study : "module:function" that makes it
    brake : file in the folder of brakes that the function takes; "" for a function without a brake
    raw : the function takes the brake itself, not its linear model
    """

    number: str
    caption: str
    study: str
    brake: str = ""
    raw: bool = False

    @property
    def key(self) -> str:
        """The name by which the command line calls it, "7"."""
        return self.number.removeprefix("Fig. ")

    def build(self, brakes: Path) -> Study:
        """Compute it with the brake files of a folder.

        Raises
        ------
        ConfigError
            a brake file is missing or wrong
        """
        module, name = self.study.split(":")
        function: Callable[..., Study] = getattr(import_module(f"rigctl.model.{module}"), name)
        if not self.brake:
            return function()
        path = brakes / self.brake
        return function(read_brake(path) if self.raw else read_model(path))


FIGURES = (
    PaperFigure(
        "Fig. 1a",
        "Phase plane of the 1-DOF friction oscillator with linear falling friction-velocity characteristic",
        "minimal:figure_1a_study",
    ),
    PaperFigure(
        "Fig. 1b",
        "Root locus plot of the 2-DOF system showing the effect of nonconservative restoring forces",
        "minimal:figure_1b_study",
    ),
    PaperFigure(
        "Fig. 7",
        "Instability of brake model due to nonconservative restoring forces",
        "locus:figure_7_study",
        "basic.toml",
    ),
    PaperFigure(
        "Fig. 8",
        "Sensitivity of basic brake design referring to COF variation",
        "sensitivity_paper:figure_8_study",
        "model.toml",
    ),
    PaperFigure(
        "Fig. 9",
        "Robustness for symmetric and asymmetric variation of the position of coupling elements",
        "sensitivity_paper:figure_9_study",
        "model.toml",
    ),
    PaperFigure(
        "Fig. 10",
        "Change of eigenvalue real parts due to variations of parameter group 'piston'",
        "sensitivity_paper:figure_10_study",
        "model.toml",
    ),
    PaperFigure(
        "Fig. 11",
        "Decay of vibrations in the linear and in the nonlinear case",
        "energy:figure_11_study",
        "model.toml",
        raw=True,
    ),
    PaperFigure(
        "Fig. 13",
        "Destabilisation due to falling friction characteristic",
        "locus:figure_13_study",
        "model.toml",
    ),
)


def paper_figures(brakes: Path, chosen: Sequence[str] = ()) -> Iterator[tuple[PaperFigure, Study]]:
    """Compute figures one after the other; all of them where none is chosen by its key ("7", "1a").

    Raises
    ------
    ConfigError
        a brake file is missing or wrong
    """
    for figure in FIGURES:
        if not chosen or figure.key in chosen:
            yield figure, figure.build(brakes)


def write_page(made: Sequence[tuple[PaperFigure, Study]], brakes: Path, out: Path) -> Path:
    """Write all figures and tables, `paper_numbers.csv` and `figures.html`; returns the page's path.

    Raises
    ------
    ConfigError
        the folder cannot be written
    """
    sections: list[dict[str, Any]] = []
    for figure, study in made:
        files = [path.name for path in write(study, out, ("png", "svg", "csv", "json"))]
        sections.append(
            {
                "heading": figure.number,
                "caption": figure.caption,
                "source": str(brakes / figure.brake) if figure.brake else "parameters in the facts",
                "title": study.title,
                "pictures": [_picture(study, name, out) for name in study.figures],
                "tables": [name for name in files if name.endswith(".csv")],
            }
        )
    numbers = numbers_table(made)
    write(Study("paper", numbers.title, {}, (numbers,)), out, ("csv",))
    environment = Environment(
        loader=ChoiceLoader([PackageLoader("rigctl.model"), PackageLoader("rigctl.analysis")]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
    )
    names = [column.name for column in numbers.columns]
    rows = [dict(zip(names, map(_text, row), strict=True)) for row in numbers.rows()]
    page = environment.get_template("paper.html.j2").render(version=__version__, rows=rows, figures=sections)
    path = out / "figures.html"
    path.write_text(page, encoding="utf-8")
    return path


def numbers_table(made: Sequence[tuple[PaperFigure, Study]]) -> Table:
    """All "paper" tables of the studies in one, with the figure's number before each line."""
    rows: list[tuple[Any, ...]] = []
    for figure, study in made:
        for table in study.tables:
            if table.name == NAME:
                names = ("quantity", "unit", "paper", "ours", "deviation", "holds")
                rows += [
                    (figure.number, *row) for row in zip(*map(partial(_column, table), names), strict=True)
                ]
    heads = (
        ("figure", ""), ("quantity", ""), ("unit", ""), ("paper", ""), ("ours", ""), ("deviation", "%"),
        ("holds", ""),
    )  # fmt: skip
    columns = tuple(Column(name, unit, [row[i] for row in rows]) for i, (name, unit) in enumerate(heads))
    return Table("numbers", "The paper's numbers and ours", columns)


def _column(table: Table, name: str) -> Sequence[Any]:
    return [plain(value) for value in table.column(name)]


def _picture(study: Study, name: str, out: Path) -> dict[str, Any]:
    stem = f"{study.name}_{name}"
    svg = (out / f"{stem}.svg").read_bytes()
    small = len(svg) <= _SVG_LIMIT
    data = svg if small else (out / f"{stem}.png").read_bytes()
    kind = "image/svg+xml" if small else "image/png"
    source = f"data:{kind};base64,{base64.b64encode(data).decode()}"
    return {"source": source, "files": [f"{stem}.png", f"{stem}.svg"]}


def _text(value: Any) -> str:
    if value is None:
        return "–"
    return f"{value:.5g}" if isinstance(value, float) else str(value)

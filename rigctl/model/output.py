"""What a study gives back, and how it becomes files: figures (PNG, SVG), tables (CSV, Parquet), facts (JSON).

Job: `Study`, `Table`, `Column`, `write`. NOT its job: computing, drawing (each study draws its own figures
with `rigctl.analysis.style`), printing on the console (`rigctl.app.model.common`).
"""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from rigctl.core.errors import ConfigError
from rigctl.model.formats import FIGURE_FORMATS, FORMATS

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, slots=True)
class Column:
    """A column of a table: key, unit ("" without), values (numbers, texts or truth values; None: missing)."""

    name: str
    unit: str
    values: Sequence[Any]

    @property
    def heading(self) -> str:
        """Name with unit, "frequency [Hz]"."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True, slots=True)
class Table:
    """Columns of equal length.

    Raises
    ------
    ValueError
        columns of unequal length, or two of one name
    """

    name: str
    title: str
    columns: tuple[Column, ...]

    def __post_init__(self) -> None:
        lengths = {column.name: len(column.values) for column in self.columns}
        if len(lengths) != len(self.columns):
            raise ValueError(
                f"table {self.name}: two columns have one name: {[c.name for c in self.columns]}"
            )
        if len(set(lengths.values())) > 1:
            raise ValueError(f"table {self.name}: columns of unequal length: {lengths}")

    def __len__(self) -> int:
        return len(self.columns[0].values) if self.columns else 0

    def column(self, name: str) -> Sequence[Any]:
        """Values of a column."""
        return next(column.values for column in self.columns if column.name == name)

    def rows(self) -> list[tuple[Any, ...]]:
        """All rows, numpy numbers as Python's."""
        return list(zip(*(map(plain, column.values) for column in self.columns), strict=True))


@dataclass(frozen=True, slots=True)
class Study:
    """Result of a study, ready to be written.

    Attributes
    ----------
    name : stem of all files, "locus"
    title : a line for people
    facts : numbers and texts that answer the question, JSON-able; units in the keys
    tables : by their names
    figures : name -> function that draws it; called inside `style.drawing()`
    """

    name: str
    title: str
    facts: Mapping[str, Any]
    tables: tuple[Table, ...] = ()
    figures: Mapping[str, Callable[[], Figure]] = field(default_factory=dict)

    def table(self, name: str) -> Table:
        """The table of that name."""
        return next(table for table in self.tables if table.name == name)


def write(study: Study, folder: Path, formats: Sequence[str] = FORMATS) -> list[Path]:
    """Write a study's files into a folder (made if missing); returns their paths.

    Raises
    ------
    ConfigError
        unknown format, or the folder cannot be written
    """
    unknown = [f for f in formats if f not in FORMATS]
    if unknown:
        raise ConfigError(
            "no such format.",
            place=f"--format {unknown[0]}",
            value=unknown[0],
            remedy=f"Known: {', '.join(FORMATS)}.",
        )
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return list(_write(study, folder, formats))
    except OSError as error:
        raise ConfigError(
            f"cannot write results: {error.strerror}.", place=str(folder), remedy="Name another folder."
        ) from error


def _write(study: Study, folder: Path, formats: Sequence[str]) -> list[Path]:
    written: list[Path] = []

    def save(name: str, data: bytes) -> None:
        path = folder / name
        path.write_bytes(data)
        written.append(path)

    if any(f in formats for f in FIGURE_FORMATS) and study.figures:
        from rigctl.analysis.style import drawing, render

        with drawing():
            for name, draw in study.figures.items():
                rendered = render(draw())
                if "png" in formats:
                    save(f"{study.name}_{name}.png", rendered.png)
                if "svg" in formats:
                    save(f"{study.name}_{name}.svg", rendered.svg.encode())
    for table in study.tables:
        stem = f"{study.name}_{table.name}"
        if "csv" in formats:
            path = folder / f"{stem}.csv"
            with path.open("w", newline="", encoding="utf-8") as file:
                writer = csv.writer(file)
                writer.writerow([column.heading for column in table.columns])
                writer.writerows(table.rows())
            written.append(path)
        if "parquet" in formats:
            written.append(_write_parquet(table, folder / f"{stem}.parquet"))
    if "json" in formats:
        content = {"study": study.name, "title": study.title, "facts": plain(study.facts)}
        save(
            f"{study.name}.json",
            (json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False) + "\n").encode(),
        )
    return written


def _write_parquet(table: Table, path: Path) -> Path:
    import pyarrow as pa
    import pyarrow.parquet as pq

    arrays = [pa.array(_of_one_kind([plain(v) for v in column.values])) for column in table.columns]
    fields = [
        pa.field(column.name, array.type, metadata={"unit": column.unit})
        for column, array in zip(table.columns, arrays, strict=True)
    ]
    pq.write_table(
        pa.Table.from_arrays(arrays, schema=pa.schema(fields, metadata={"title": table.title})), path
    )
    return path


def _of_one_kind(values: list[Any]) -> list[Any]:
    """Numbers and texts in one column as texts: Parquet columns have one type."""
    kinds = {type(value) for value in values if value is not None}
    if len(kinds) > 1 and not kinds <= {int, float}:
        return [None if value is None else str(value) for value in values]
    return values


def plain(value: Any) -> Any:
    """Numpy values, arrays and mappings as what JSON knows; not a number and infinities as None."""
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, complex):
        return {"re": plain(value.real), "im": plain(value.imag)}
    return None if isinstance(value, float) and not math.isfinite(value) else value

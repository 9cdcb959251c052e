"""The report of a campaign: `report/report.html`, figures as PNG and SVG, tables as CSV.

Job: put table, statistics and figures together and write the files, each replaced as a whole.
NOT its job: statistics (`occurrence`, `friction_map`, `summary`), drawing (`figures`).

The HTML file is self-contained: figures are embedded, nothing is loaded from anywhere.
"""

import base64
import json
import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from matplotlib.figure import Figure

from rigctl import __version__
from rigctl.analysis import figures, occurrence
from rigctl.analysis.campaign_table import BrakingRow, CampaignTable, EventRow, read_campaign, write_csv
from rigctl.analysis.prediction import Prediction
from rigctl.analysis.spectrogram_figure import braking_spectrogram
from rigctl.analysis.style import Rendered, drawing, render
from rigctl.analysis.summary import Summary, in_words, summarise
from rigctl.analysis.two_processes import in_two_processes
from rigctl.core.errors import RecordingError
from rigctl.recording.braking_file import read_braking

_SVG_LIMIT = 600_000
"""A figure whose SVG is larger than this (bytes) is embedded as PNG."""


@dataclass(frozen=True, slots=True)
class ReportResult:
    """Where the report is, its numbers, and the same in words."""

    path: Path
    summary: Summary
    sentences: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class _Plot:
    """One figure of the report: how it is drawn, its caption, and what to say when there is nothing to
    draw.
    """

    name: str
    section: str
    caption: str
    draw: Callable[[], Figure | None]
    absent: str


@dataclass(frozen=True, slots=True)
class _Embedded:
    plot: _Plot
    source: str


def build_report(
    campaign_dir: Path, *, prediction: Prediction | None = None, info: Mapping[str, str] | None = None
) -> ReportResult:
    """Write the report of a campaign into `campaign_dir/report/`.

    Parameters
    ----------
    campaign_dir : Path
        Folder of the campaign.
    prediction : Prediction, optional
        Drawn into the measured pictures and compared in words.
    info : mapping of str to str, optional
        Facts about the campaign in the order in which they are to be shown (seed, rig, brake, versions, ...).

    Returns
    -------
    ReportResult

    Raises
    ------
    RecordingError
        `campaign_dir` is not a campaign, or the report cannot be written.
    """
    table = read_campaign(campaign_dir)
    summary = summarise(table, prediction)
    folder = campaign_dir / "report"
    try:
        folder.mkdir(exist_ok=True)
        with drawing():
            plots = _plots(table, campaign_dir, prediction)
            sources = in_two_processes([partial(_make, plot, folder) for plot in plots])
        pictures = [_Embedded(plot, source) for plot, source in zip(plots, sources, strict=True)]
        _replace(folder / "brakings.csv", lambda path: write_csv(path, table.brakings, BrakingRow))
        _replace(folder / "events.csv", lambda path: write_csv(path, table.events, EventRow))
        page = _page(campaign_dir, table, summary, pictures, dict(info or {}))
        target = folder / "report.html"
        _replace(target, lambda path: path.write_text(page, encoding="utf-8"))
    except OSError as error:
        raise RecordingError(
            f"the report cannot be written ({error.strerror}).",
            place=str(error.filename or folder),
            remedy="Make room or permissions, then run `rigctl report`.",
        ) from error
    return ReportResult(target, summary, in_words(summary))


def loudest_braking(table: CampaignTable) -> BrakingRow | None:
    """The complete braking with the loudest squeal; without squeal the one with the highest sound level."""
    base = table.with_sound()
    with_squeal = [b for b in base if b.squeal_level_db is not None]
    if with_squeal:
        return max(with_squeal, key=lambda b: b.squeal_level_db or 0.0)
    return max(base, key=lambda b: b.lmax_db or 0.0, default=None)


def _plots(table: CampaignTable, campaign_dir: Path, prediction: Prediction | None) -> tuple[_Plot, ...]:
    no_sound = "No complete braking with recorded sound."
    no_squeal = "No squeal was found." if table.with_sound() else no_sound
    return (
        _Plot(
            "squeal_pressure_frequency",
            "squeal",
            "Every squeal event over brake pressure and frequency (the paper's Fig. 14), size and colour by "
            "level; below, how many of the brakings at each pressure squealed.",
            lambda: figures.pressure_frequency(table, prediction),
            no_sound,
        ),
        _Plot(
            "squeal_pressure_temperature",
            "squeal",
            "Where it squeals: one cell per set-point of pressure and temperature; the number is the level "
            "in dB of the loudest squeal, or squealing / all brakings where a set-point was repeated.",
            lambda: figures.pressure_temperature(table, prediction),
            no_sound,
        ),
        _Plot(
            "squeal_levels",
            "squeal",
            "Levels of the loudest squeal of each braking; right, the share of brakings that reach a level.",
            lambda: figures.level_distribution(table),
            no_squeal,
        ),
        _Plot(
            "squeal_frequency_temperature",
            "squeal",
            "Frequency of the squeal over disc temperature.",
            lambda: figures.frequency_over_temperature(table),
            no_squeal,
        ),
        _Plot(
            "spectrogram_loudest",
            "squeal",
            "Spectrogram of the loudest braking; dashed lines enclose the events that were found.",
            lambda: _loudest_spectrogram(table, campaign_dir),
            no_sound,
        ),
        _Plot(
            "friction_pressure_temperature",
            "friction",
            "Mean coefficient of friction per braking over pressure and temperature (the paper's Fig. 6).",
            lambda: figures.friction_over_pressure_temperature(table),
            "No complete braking from which a coefficient of friction could be derived.",
        ),
        _Plot(
            "friction_number",
            "friction",
            "Mean coefficient of friction in the order of the brakings; bars show its variation "
            "within a braking.",
            lambda: figures.friction_over_number(table),
            "No complete braking from which a coefficient of friction could be derived.",
        ),
    )


def _loudest_spectrogram(table: CampaignTable, campaign_dir: Path) -> Figure | None:
    braking = loudest_braking(table)
    if braking is None:
        return None
    events = tuple(e for e in table.events if e.braking == braking.index)
    return braking_spectrogram(campaign_dir / "brakings" / braking.file, braking, events)


def _make(plot: _Plot, folder: Path) -> str:
    """Draw, write both files, and return what the page embeds; "" when there is nothing to draw."""
    figure = plot.draw()
    png, svg = folder / f"{plot.name}.png", folder / f"{plot.name}.svg"
    if figure is None:
        for stale in (png, svg):
            stale.unlink(missing_ok=True)
        return ""
    rendered = render(figure)
    _replace(png, lambda path: path.write_bytes(rendered.png))
    _replace(svg, lambda path: path.write_text(rendered.svg, encoding="utf-8"))
    return _data_uri(rendered)


def _data_uri(rendered: Rendered) -> str:
    svg = rendered.svg.encode()
    kind, data = ("svg+xml", svg) if len(svg) <= _SVG_LIMIT else ("png", rendered.png)
    return f"data:image/{kind};base64,{base64.b64encode(data).decode()}"


def _replace(target: Path, write: Callable[[Path], Any]) -> None:
    """Write a file beside its target and put it in place as a whole."""
    part = target.with_name(target.name + ".part")
    write(part)
    os.replace(part, target)


def _page(
    campaign_dir: Path,
    table: CampaignTable,
    summary: Summary,
    pictures: list[_Embedded],
    info: dict[str, str],
) -> str:
    environment = Environment(
        loader=PackageLoader("rigctl.analysis"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
    )
    environment.globals.update(number=_number, picture=_picture)
    squeals = table.events
    name = campaign_dir.resolve().name
    first = _moment(table.brakings[0].start_time) if table.brakings else ""
    return environment.get_template("report.html.j2").render(
        version=__version__,
        title=f"Brake noise campaign {name}",
        subtitle=" · ".join(part for part in (*_named(info, "program", "rig"), first) if part),
        tiles=_tiles(summary),
        sentences=in_words(summary),
        pictures=pictures,
        pressures=occurrence.by_pressure(table),
        thresholds=occurrence.occurrence_per_threshold(table),
        bands=occurrence.events_per_band(table),
        events=squeals,
        n_harmonics=sum(1 for e in squeals if e.harmonic),
        brakings=table.brakings,
        incomplete=table.incomplete(),
        excluded=table.excluded(),
        excluded_indices={b.index for b in table.excluded()},
        unreadable=table.unreadable,
        info=[*info.items(), *_found_info(table)],
        detector=_detector(table, campaign_dir),
    )


def _named(info: Mapping[str, str], *names: str) -> list[str]:
    """Values of an info mapping by key, capitals disregarded; "" where missing."""
    lower = {key.lower(): value for key, value in info.items()}
    return [lower.get(name, "") for name in names]


def _tiles(s: Summary) -> list[tuple[str, str]]:
    tiles = [(f"{s.n_complete}", f"complete brakings of {s.n_brakings}")]
    if s.n_with_sound:
        tiles.append((f"{s.n_squealing}", f"squealing brakings of {s.n_with_sound} with sound"))
    if s.onset_bar is not None:
        bar = s.predicted_onset_bar
        predicted = f", predicted {bar:.1f} bar" if bar is not None else ""
        tiles.append((f"{s.onset_bar:g} bar", f"onset of squeal{predicted}"))
    if s.frequency_median_hz is not None:
        predicted = (
            f", predicted {s.predicted_frequency_hz:.0f} Hz" if s.predicted_frequency_hz is not None else ""
        )
        tiles.append((f"{s.frequency_median_hz:.0f} Hz", f"median squeal frequency{predicted}"))
    if s.level_max_db is not None:
        tiles.append((f"{s.level_max_db:.1f} dB", "loudest squeal"))
    if s.mu_min is not None and s.mu_max is not None:
        tiles.append((f"{s.mu_min:.2f}\u2013{s.mu_max:.2f}", "mean µ of the brakings"))
    return tiles


def _found_info(table: CampaignTable) -> list[tuple[str, str]]:
    """Facts the files themselves state."""
    if not table.brakings:
        return []
    roles: dict[str, int] = {}
    for braking in table.brakings:
        roles[braking.role] = roles.get(braking.role, 0) + 1
    return [
        ("first braking", f"{_moment(table.brakings[0].start_time)} (rig clock)"),
        ("last braking", f"{_moment(table.brakings[-1].start_time)} (rig clock)"),
        ("brakings per role", ", ".join(f"{n} {role}" for role, n in roles.items())),
    ]


def _detector(table: CampaignTable, campaign_dir: Path) -> str:
    """Settings of the detector as stored in the first braking with sound."""
    base = table.with_sound()
    if not base:
        return ""
    settings = read_braking(campaign_dir / "brakings" / base[0].file).settings.get("detection", {})
    return ", ".join(f"{key} = {json.dumps(value)}" for key, value in settings.items())


def _number(value: float | None, form: str) -> str:
    return "–" if value is None else form % value


def _moment(iso: str) -> str:
    """2000-01-01T00:00:03.350000+00:00 -> 2000-01-01 00:00:03 UTC; other texts as they are."""
    try:
        moment = datetime.fromisoformat(iso)
    except ValueError:
        return iso
    return f"{moment:%Y-%m-%d %H:%M:%S} {moment.tzname() or ''}".strip()


def _picture(picture: _Embedded) -> Markup:
    plot = picture.plot
    if not picture.source:
        return Markup('<div class="card soft">{}</div>\n').format(plot.absent)
    return Markup('<figure><img src="{}" alt="{}"><figcaption>{} (<a href="{}.png">PNG</a>, ').format(
        picture.source, plot.caption, plot.caption, plot.name
    ) + Markup('<a href="{}.svg">SVG</a>)</figcaption></figure>\n').format(plot.name)

"""All brakings and noise events of a campaign as one table, read in one pass.

Job: `read_campaign` turns the summaries of the braking files into typed rows; the selections that statistics
are based on; CSV. NOT its job: samples (only the loudest braking's are ever read, by `figures`), statistics.

Statistics are based on *complete* brakings that nobody has excluded. Incomplete and recovered ones, excluded
ones, and files that cannot be read, are listed, never counted. Squeal statistics are based on those of them
whose sound was recorded. Loads HDF5 only when files are read.
"""

import csv
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from rigctl.core.channels import DISC_TEMPERATURE, MICROPHONE
from rigctl.core.errors import RecordingError
from rigctl.recording.annotations import UNTOUCHED, Annotation, Folding, read_annotations

COMPLETE = "complete"


@dataclass(frozen=True, slots=True)
class EventRow:
    """One noise event; see `rigctl.signals.squeal.SquealEvent`. Set-points are those of its braking."""

    braking: int
    status: str
    frequency_hz: float
    level_db: float
    level_dba: float | None
    leq_db: float | None
    start_s: float | None
    duration_s: float | None
    share: float | None
    harmonic: bool
    pressure_bar: float | None
    temperature_degc: float | None
    speed_rpm: float | None
    mu: float | None
    set_pressure_bar: float | None
    set_temperature_degc: float | None


@dataclass(frozen=True, slots=True)
class BrakingRow:
    """One braking: set-points, results, its main (loudest) squeal, and what people said about it.

    `excluded` is the reason for which it does not count ("" when it does), `excluded_by` who and when;
    `remark` holds the notes of the operator and of whoever looked at it later.
    """

    index: int
    file: str
    sequence: str
    role: str
    status: str
    note: str
    start_time: str
    duration_s: float | None
    set_pressure_bar: float | None
    set_temperature_degc: float | None
    pressure_mean_bar: float | None
    speed_mean_rpm: float | None
    torque_mean_nm: float | None
    temperature_initial_degc: float | None
    temperature_final_degc: float | None
    temperature_maximum_degc: float | None
    mean_mu: float | None
    std_mu: float | None
    sound_recorded: bool
    background_db: float | None
    leq_db: float | None
    laeq_db: float | None
    lmax_db: float | None
    clipped_share: float | None
    squeals: int
    squeal_frequency_hz: float | None
    squeal_level_db: float | None
    squeal_level_dba: float | None
    evaluation_error: str
    excluded: str = ""
    excluded_by: str = ""
    tags: tuple[str, ...] = ()
    rating: int | None = None
    remark: str = ""

    @property
    def complete(self) -> bool:
        """True when nothing of the braking is missing."""
        return self.status == COMPLETE

    @property
    def counts(self) -> bool:
        """True when this braking belongs to the base of statistics."""
        return self.complete and not self.excluded

    @property
    def counts_for_squeal(self) -> bool:
        """True when this braking belongs to the base of squeal statistics."""
        return self.counts and self.sound_recorded and not self.evaluation_error


@dataclass(frozen=True, slots=True)
class CampaignTable:
    """The table of a campaign; `unreadable` holds (file name, problem)."""

    brakings: tuple[BrakingRow, ...]
    events: tuple[EventRow, ...]
    unreadable: tuple[tuple[str, str], ...]

    def complete(self) -> tuple[BrakingRow, ...]:
        """Brakings that count."""
        return tuple(b for b in self.brakings if b.counts)

    def incomplete(self) -> tuple[BrakingRow, ...]:
        """Brakings that are there but do not count because something is missing."""
        return tuple(b for b in self.brakings if not b.complete and not b.excluded)

    def excluded(self) -> tuple[BrakingRow, ...]:
        """Brakings that a person has excluded."""
        return tuple(b for b in self.brakings if b.excluded)

    def with_sound(self) -> tuple[BrakingRow, ...]:
        """Base of all squeal statistics."""
        return tuple(b for b in self.brakings if b.counts_for_squeal)

    def squealing(self) -> tuple[BrakingRow, ...]:
        """Brakings of that base with at least one squeal."""
        return tuple(b for b in self.with_sound() if b.squeals > 0)

    def squeals(self) -> tuple[EventRow, ...]:
        """Events of that base, harmonics left out."""
        base = {b.index for b in self.with_sound()}
        return tuple(e for e in self.events if e.braking in base and not e.harmonic)


def read_campaign(campaign_dir: Path) -> CampaignTable:
    """Read all braking files of a campaign.

    Parameters
    ----------
    campaign_dir : Path
        Folder with `brakings/*.h5`.

    Returns
    -------
    CampaignTable
        Brakings in order of their index. Files that cannot be read are in `unreadable`.

    Raises
    ------
    RecordingError
        The folder holds no `brakings` folder: it is not a campaign.
    """
    folder = campaign_dir / "brakings"
    if not folder.is_dir():
        raise RecordingError(
            "this is not a campaign: it has no folder 'brakings'.",
            place=str(campaign_dir),
            remedy="Name the folder that `rigctl run` printed.",
        )
    from rigctl.recording.braking_file import read_summary

    said = read_annotations(campaign_dir)
    brakings: list[BrakingRow] = []
    events: list[EventRow] = []
    unreadable: list[tuple[str, str]] = []
    for path in sorted(folder.glob("*.h5")):
        try:
            row, found = rows_of(read_summary(path), path.name, said)
            brakings.append(row)
            events.extend(found)
        except RecordingError as error:
            unreadable.append((path.name, error.problem))
    return in_order(brakings, events, unreadable)


def in_order(
    brakings: Iterable[BrakingRow], events: Iterable[EventRow], unreadable: Iterable[tuple[str, str]]
) -> CampaignTable:
    """The table of these rows, by number of the braking."""
    return CampaignTable(
        tuple(sorted(brakings, key=lambda b: b.index)),
        tuple(sorted(events, key=lambda e: (e.braking, e.start_s or 0.0))),
        tuple(unreadable),
    )


def rows_of(
    summary: Mapping[str, Any], file: str, said: Folding | None = None
) -> tuple[BrakingRow, tuple[EventRow, ...]]:
    """Rows of one braking, from the summary of its file.

    Raises
    ------
    RecordingError
        The summary is not one of a braking.
    """
    try:
        events = tuple(_events(summary))
        row = _braking(summary, file, events)
        index = row.index
        return annotated(row, said.of(index) if said else UNTOUCHED, summary["marks"]), events
    except (KeyError, TypeError, ValueError) as error:
        raise RecordingError(f"its summary is not understood ({error!r})", place=file) from error


def annotated(row: BrakingRow, said: Annotation, marks: Sequence[Mapping[str, Any]] = ()) -> BrakingRow:
    """The row with what people said about its braking.

    Notes and rating that the operator gave while it was recorded are in the journal and, as marks, in the
    file; those of the file are used where the journal is missing (a file copied elsewhere).
    """
    words, rating = said.remark, said.rating
    if not said.said:
        stored = [str(m["values"].get("text", "")) for m in marks if m["name"] == "operator_note"]
        words = " · ".join(text for text in (*stored, said.note) if text)
    if rating is None:
        stored_rating = [m["values"].get("rating") for m in marks if m["name"] == "operator_rating"]
        rating = stored_rating[-1] if stored_rating else None
    return replace(
        row,
        excluded=said.excluded,
        excluded_by=said.excluded_by,
        tags=said.tags,
        rating=rating,
        remark=words,
    )


def _braking(summary: Mapping[str, Any], file: str, events: Sequence[EventRow]) -> BrakingRow:
    results, set_points = summary["results"], summary["set_points"]
    main = max((e for e in events if not e.harmonic), key=lambda e: e.level_db, default=None)
    return BrakingRow(
        index=int(summary["index"]),
        file=file,
        sequence=summary["sequence"],
        role=summary["role"],
        status=summary["status"],
        note=summary["note"],
        start_time=summary["start_time"],
        duration_s=summary["duration_s"],
        set_pressure_bar=set_points.get("pressure_bar"),
        set_temperature_degc=set_points.get("temperature_degc"),
        pressure_mean_bar=results.get("pressure_mean_bar"),
        speed_mean_rpm=results.get("speed_mean_rpm"),
        torque_mean_nm=results.get("torque_mean_nm"),
        temperature_initial_degc=results.get(f"{DISC_TEMPERATURE}_initial_degc"),
        temperature_final_degc=results.get(f"{DISC_TEMPERATURE}_final_degc"),
        temperature_maximum_degc=results.get(f"{DISC_TEMPERATURE}_maximum_degc"),
        mean_mu=results.get("mean_mu"),
        std_mu=results.get("std_mu"),
        sound_recorded=MICROPHONE in summary["channels"],
        background_db=results.get("background_db"),
        leq_db=results.get("leq_db"),
        laeq_db=results.get("laeq_db"),
        lmax_db=results.get("lmax_db"),
        clipped_share=results.get("clipped_share"),
        squeals=sum(1 for e in events if not e.harmonic),
        squeal_frequency_hz=main.frequency_hz if main else None,
        squeal_level_db=main.level_db if main else None,
        squeal_level_dba=main.level_dba if main else None,
        evaluation_error=summary.get("evaluation_error", ""),
    )


def _events(summary: Mapping[str, Any]) -> Iterator[EventRow]:
    columns, set_points = summary["events"], summary["set_points"]
    count = len(columns.get("frequency_hz", ()))

    def value(name: str, row: int) -> float | None:
        return columns[name][row] if name in columns else None

    for row in range(count):
        harmonic_of = value("harmonic_of", row)
        yield EventRow(
            braking=int(summary["index"]),
            status=summary["status"],
            frequency_hz=float(columns["frequency_hz"][row]),
            level_db=float(columns["level_db"][row]),
            level_dba=value("level_dba", row),
            leq_db=value("leq_db", row),
            start_s=value("start_s", row),
            duration_s=value("duration_s", row),
            share=value("share", row),
            harmonic=harmonic_of is not None and harmonic_of >= 0,
            pressure_bar=value("pressure_bar", row),
            temperature_degc=value("temperature_degc", row),
            speed_rpm=value("speed_rpm", row),
            mu=value("mu", row),
            set_pressure_bar=set_points.get("pressure_bar"),
            set_temperature_degc=set_points.get("temperature_degc"),
        )


def write_csv(path: Path, rows: tuple[BrakingRow, ...] | tuple[EventRow, ...], row_type: type) -> None:
    """Write rows as CSV (UTF-8, comma, one header line with units in the names; empty where not defined)."""
    names = [item.name for item in fields(row_type)]
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(names)
        for row in rows:
            writer.writerow([_cell(getattr(row, name)) for name in names])


def _cell(value: object) -> object:
    if value is None:
        return ""
    if isinstance(value, bool):
        return int(value)
    if isinstance(value, tuple):
        return ", ".join(str(item) for item in value)
    return f"{value:.6g}" if isinstance(value, float) else value

"""What has happened in a run: the journal folded into rows, squeal per set-point, how it ended. No widgets.

Job: `RunModel` takes rows of the program, records of the journal, summaries of braking files and the rig's
state, and says which rows have changed. Records may come again from the beginning (another session). Not its
job: reading files (`summaries`), looks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from rigctl.core.channels import MICROPHONE
from rigctl.core.journal import Record
from rigctl.engine.state import Outcome, Verb
from rigctl.gui.pages.run.occurrence import Occurrence
from rigctl.gui.pages.run.rows import NOT_DONE, UNDER_WAY, Row, RowState
from rigctl.gui.rig.state import RigState
from rigctl.recording.kinds import ANNOTATED, COMMITTED

COMPLETE, RECOVERED = "complete", "recovered"
INITIAL_TEMPERATURE = "disc_temperature_initial_degc"


@dataclass(frozen=True)
class RunEnd:
    """How a run ended.

    Attributes
    ----------
    outcome : Outcome
    done : int
        Complete brakings.
    cause, remedy : str
        In words; "" after a run that went well.
    """

    outcome: Outcome
    done: int
    cause: str = ""
    remedy: str = ""


@dataclass
class RunModel:
    """Rows of one campaign.

    Attributes
    ----------
    rows : list of Row
        In the order of the program; brakings by hand are appended as they come.
    present : int
        Number of the braking that is under way or was last, 0 before the first.
    hold_asked : bool
        The run will wait after this braking.
    end : RunEnd or None
        How the run ended; None while it goes on.
    unread : list of int
        Brakings whose file has been committed and whose summary is wanted.
    """

    rows: list[Row] = field(default_factory=list)
    present: int = 0
    hold_asked: bool = False
    end: RunEnd | None = None
    unread: list[int] = field(default_factory=list)
    occurrence: Occurrence = field(default_factory=Occurrence)

    def __post_init__(self) -> None:
        self._place: dict[int, int] = {row.index: i for i, row in enumerate(self.rows)}
        self._skipped: set[int] = set()
        self._broken: dict[int, RowState] = {}
        self._hand_speed: float | None = None
        self._trip: Mapping[str, Any] = {}
        self._changed: set[int] = set()
        self._readers: dict[str, Callable[[Record], None]] = {
            "run_started": self._on_started_run,
            "braking_started": self._on_started,
            COMMITTED: self._on_committed,
            "braking_broken_off": self._on_broken_off,
            "verb": self._on_verb,
            "state": self._on_state,
            "operator_note": self._on_note,
            "operator_rating": self._on_rating,
            ANNOTATED: self._on_annotated,
            "manual": self._on_manual,
            "trip": self._on_trip,
            "ended": self._on_ended,
            "run_ended": self._on_ended,
        }

    # -- rows -------------------------------------------------------------------------------------

    def add(self, rows: Iterable[Row]) -> None:
        """Further rows of the program."""
        for row in rows:
            self._place[row.index] = len(self.rows)
            self.rows.append(row)
            self.occurrence.take(row)

    def place(self, index: int) -> int | None:
        """Where the row of a braking is."""
        return self._place.get(index)

    def row(self, index: int) -> Row | None:
        """The row of a braking."""
        place = self._place.get(index)
        return None if place is None else self.rows[place]

    def _row(self, index: int) -> Row:
        row = self.row(index)
        if row is None:
            row = Row(index)
            self.add([row])
        self._changed.add(index)
        return row

    def _take_changed(self) -> set[int]:
        changed, self._changed = self._changed, set()
        for index in changed:
            row = self.row(index)
            if row is not None:
                self.occurrence.take(row)
        return changed

    def count(self, *states: RowState) -> int:
        """Rows in one of the states."""
        return sum(row.state in states for row in self.rows)

    def not_done(self) -> list[int]:
        """Brakings that were tried and are not complete."""
        return [row.index for row in self.rows if row.state in NOT_DONE]

    # -- news -------------------------------------------------------------------------------------

    def fold(self, records: Iterable[Record]) -> set[int]:
        """Take records of the journal in their order; returns the brakings that have changed."""
        for record in records:
            reader = self._readers.get(record.kind)
            if reader is not None:
                reader(record)
        return self._take_changed()

    def show(self, state: RigState) -> set[int]:
        """The present braking is conditioning until it is recorded."""
        row = self.row(self.present)
        recorded = state.recording and state.braking == self.present
        if row is not None and recorded and row.state is RowState.CONDITIONING:
            row.state = RowState.BRAKING
            self._changed.add(row.index)
        return self._take_changed()

    def summary(self, index: int, summary: Mapping[str, Any]) -> set[int]:
        """Results of a committed braking (`read_summary`); those of an earlier attempt are passed over."""
        row = self.row(index)
        if row is None or row.state in UNDER_WAY or summary.get("attempt", row.attempt) != row.attempt:
            return set()
        self._changed.add(index)
        results, set_points = summary["results"], summary["set_points"]
        row.mean_mu = results.get("mean_mu")
        row.squeal_level_db = results.get("squeal_level_db")
        row.squeal_frequency_hz = results.get("squeal_frequency_hz")
        row.start_degc = results.get(INITIAL_TEMPERATURE)
        row.sound = MICROPHONE in summary["channels"]
        row.judged = summary["status"] == COMPLETE and row.sound and not summary.get("evaluation_error")
        row.sequence = row.sequence or str(summary.get("sequence", ""))
        if row.pressure_bar is None:
            row.pressure_bar = set_points.get("pressure_bar")
        if row.speed_rpm is None:
            row.speed_rpm = results.get("speed_mean_rpm")
        return self._take_changed()

    # -- records ----------------------------------------------------------------------------------

    def _on_started_run(self, _record: Record) -> None:
        self.end = None
        self.hold_asked = False
        self._trip = {}

    def _on_started(self, record: Record) -> None:
        values = record.payload
        row = self._row(int(values["index"]))
        row.begin()
        row.sequence = row.sequence or str(values.get("sequence", ""))
        if row.pressure_bar is None:
            row.pressure_bar = values.get("pressure_bar")
        if row.speed_rpm is None:
            row.speed_rpm = row.end_speed_rpm = self._hand_speed
        if self.present not in (0, row.index):
            self._changed.add(self.present)
        self.present = row.index
        self._skipped.discard(row.index)
        self._broken.pop(row.index, None)

    def _on_committed(self, record: Record) -> None:
        values = record.payload
        row = self._row(int(values["index"]))
        row.attempt = int(values.get("attempt", 1))
        status = values.get("status")
        if status == COMPLETE:
            row.state = RowState.COMPLETE
            row.reason = str(values.get("note", ""))  # the comment of a braking by hand
        else:
            state = RowState.RECOVERED if status == RECOVERED else RowState.INCOMPLETE
            open_still = row.state in (*UNDER_WAY, RowState.WAITING)
            if row.index == self.present and open_still and self.end is None:
                self._broken[row.index] = state  # it may be tried again at once
                return
            if row.state is not RowState.SKIPPED:
                row.state = state
            row.reason = row.reason or str(values.get("note", ""))
        if row.index not in self.unread:
            self.unread.append(row.index)

    def _on_broken_off(self, record: Record) -> None:
        row = self._row(int(record.payload["index"]))
        row.reason = str(record.payload.get("reason", ""))
        skipped = row.index in self._skipped
        row.state = RowState.SKIPPED if skipped else RowState.INCOMPLETE

    def _on_verb(self, record: Record) -> None:
        verb = record.payload.get("verb")
        if verb == Verb.SKIP:
            self._skipped.add(int(record.payload.get("braking", 0)))
        if verb == Verb.HOLD:
            self.hold_asked = True
        elif verb in (Verb.RESUME, Verb.SKIP, Verb.REPEAT):
            self.hold_asked = False

    def _on_state(self, record: Record) -> None:
        state = record.payload.get("state")
        if state == "paused":
            self.hold_asked = False
            self._wait_again()

    def _wait_again(self) -> None:
        """The present braking was broken off for a pause and is to be done again."""
        row = self.row(self.present)
        if row is not None and row.state in UNDER_WAY:
            row.state = RowState.WAITING
            self._changed.add(row.index)

    def _on_note(self, record: Record) -> None:
        self._say(int(record.payload.get("index", 0)), str(record.payload["text"]))

    def _on_rating(self, record: Record) -> None:
        index = int(record.payload.get("index", 0))
        if index:
            self._row(index).rating = int(record.payload["rating"])

    def _on_annotated(self, record: Record) -> None:
        values = record.payload
        index, action = int(values["index"]), values.get("action")
        if action == "rate":
            self._row(index).rating = int(values.get("value") or 0)
        elif action == "note":
            self._say(index, str(values.get("value") or ""))

    def _say(self, index: int, text: str) -> None:
        if index and text:
            self._row(index).notes.append(text)

    def _on_manual(self, record: Record) -> None:
        if record.payload.get("do") == "record":
            self._hand_speed = record.payload.get("speed_rpm")

    def _on_trip(self, record: Record) -> None:
        if not self._trip:
            self._trip = record.payload

    def _on_ended(self, record: Record) -> None:
        values = record.payload
        row = self.row(self.present)
        if row is not None and row.state in UNDER_WAY:
            row.state = self._broken.get(row.index, RowState.WAITING)
            if row.state is not RowState.WAITING:
                row.reason = row.reason or str(values.get("cause", ""))
            self._changed.add(row.index)
        before = self.end
        tripped = values.get("outcome") == Outcome.TRIPPED
        words = str(values.get("cause", "")) or (before.cause if before else "")
        if tripped and not words:
            words = str(self._trip.get("words", ""))
        self.end = RunEnd(
            Outcome(values.get("outcome", Outcome.FAILED)),
            int(values.get("done", 0)),
            words,
            str(self._trip.get("remedy", "")) if tripped else "",
        )

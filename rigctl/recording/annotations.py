"""What people say about brakings: excluded with a reason, tags, a note, a noise rating, in the trash.

Job: write each as an event into the journal of the campaign (append-only: who, when, what), and fold the
journal to the present state of every braking. A braking that is recorded anew begins without annotations, as
they belong to the samples that somebody has looked at. Standard library only. Not its job: moving files to
the trash (`trash`), statistics (`rigctl.analysis.campaign_table`).
"""

from __future__ import annotations

import getpass
from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import StrEnum
from pathlib import Path
from typing import Any

from rigctl.core.errors import ConfigError
from rigctl.core.journal import Journal, Record, read_journal
from rigctl.recording.durable import disk_error
from rigctl.recording.kinds import ANNOTATED, COMMITTED

SOURCE = "operator"
MAX_TEXT = 2000
MAX_TAG = 40
RATINGS = range(1, 11)
_STARTED, _NOTE, _RATING = "braking_started", "operator_note", "operator_rating"


class Action(StrEnum):
    """What can be said of a braking; `value` of the event: reason, tag, text, number or file name."""

    EXCLUDE = "exclude"
    RESTORE = "restore"
    TAG = "tag"
    UNTAG = "untag"
    NOTE = "note"
    RATE = "rate"
    TRASH = "trash"
    UNTRASH = "restore_from_trash"


@dataclass(frozen=True, slots=True)
class Annotation:
    """Present state of one braking.

    Attributes
    ----------
    excluded : str
        Reason; "" while the braking counts.
    excluded_by : str
        Who and when, e.g. "anna, 2026-11-30 09:12:04 UTC".
    tags : tuple of str
        In alphabetical order.
    note : str
        The newest note; an empty one removes it.
    said : tuple of str
        Notes of the operator while or after it was recorded (Run and Manual page), oldest first.
    rating : int or None
        Subjective noise rating.
    trashed : str
        Name of its file in `trash/`; "" when it is not there.
    """

    excluded: str = ""
    excluded_by: str = ""
    tags: tuple[str, ...] = ()
    note: str = ""
    said: tuple[str, ...] = ()
    rating: int | None = None
    trashed: str = ""

    @property
    def remark(self) -> str:
        """All words about the braking in one line."""
        return " · ".join(text for text in (*self.said, self.note) if text)


UNTOUCHED = Annotation()


def annotate(
    campaign: Path, index: int, action: Action, value: str | int | None = None, who: str = ""
) -> Record:
    """Write one event.

    Parameters
    ----------
    campaign : Path
        Folder of the campaign.
    index : int
        Number of the braking.
    action : Action
    value : str or int, optional
        Reason, tag, text of the note, rating, or file name, as the action needs.
    who : str
        Name of the person; by default the user of this computer.

    Raises
    ------
    ConfigError
        The value cannot be used: an empty reason, a rating that is none.
    RecordingError
        The journal cannot be written.
    """
    return annotate_many(campaign, [(index, action, value)], who)[0]


def annotate_many(
    campaign: Path, events: Iterable[tuple[int, Action, str | int | None]], who: str = ""
) -> list[Record]:
    """Write several events; see `annotate`. Nothing is written when one of them cannot be used."""
    checked = [(index, action, checked_value(action, value)) for index, action, value in events]
    path = campaign / "journal.jsonl"
    person = who or _user()
    try:
        journal = Journal(path, SOURCE)
        try:
            return [
                journal.write(ANNOTATED, index=index, action=str(action), value=value, who=person)
                for index, action, value in checked
            ]
        finally:
            journal.close()
    except OSError as error:
        raise disk_error(error, path, "write the annotation") from error


def checked_value(action: Action, value: str | int | None) -> str | int | None:
    """The value as it is written.

    Raises
    ------
    ConfigError
        It cannot be used; the message says why.
    """
    if action is Action.RESTORE:
        return None
    if action is Action.RATE:
        if value is None or value == "":
            return None
        if not (isinstance(value, int) and value in RATINGS):
            raise ConfigError(
                f"{value!r} is no noise rating.",
                value=value,
                remedy=f"Give a whole number from 1 to {RATINGS[-1]}.",
            )
        return value
    text = " ".join(str(value or "").split()) if action is not Action.NOTE else str(value or "").strip()
    if not text and action is Action.EXCLUDE:
        raise ConfigError("a braking is excluded with a reason only.", remedy="Say why, in a few words.")
    if not text and action in (Action.TAG, Action.UNTAG):
        raise ConfigError("the tag is empty.", remedy="Give a short word.")
    if action in (Action.TAG, Action.UNTAG) and (len(text) > MAX_TAG or "," in text or ";" in text):
        raise ConfigError(
            f"{text!r} cannot be a tag.",
            value=text,
            remedy=f"Use up to {MAX_TAG} letters, without comma or semicolon.",
        )
    if len(text) > MAX_TEXT:
        raise ConfigError(f"the text has {len(text)} letters.", remedy=f"Use up to {MAX_TEXT}.")
    return text


class Folding:
    """The present state of all brakings of a campaign, kept up to date record by record."""

    def __init__(self, records: Iterable[Record] = ()) -> None:
        self.states: dict[int, Annotation] = {}
        self._running: dict[int, Annotation] = {}
        self._sha: dict[int, str] = {}
        self._seen: set[str] = set()
        self.add(records)

    def of(self, index: int) -> Annotation:
        """State of one braking."""
        return self.states.get(index, UNTOUCHED)

    def add(self, records: Iterable[Record]) -> set[int]:
        """Take in further records, each once; returns the brakings that have changed."""
        return {index for record in records if (index := self._take(record)) is not None}

    def _take(self, record: Record) -> int | None:
        payload = record.payload
        index = payload.get("index")
        if not isinstance(index, int) or record.sha in self._seen:
            return None
        self._seen.add(record.sha)
        if record.kind == ANNOTATED:
            self.states[index] = _after(self.of(index), record)
        elif record.kind == _STARTED:
            self._running[index] = UNTOUCHED
        elif record.kind == COMMITTED:
            self._commit(index, str(payload.get("sha256", "")))
        elif record.kind in (_NOTE, _RATING):
            states = self._running if index in self._running else self.states
            states[index] = _said(states.get(index, UNTOUCHED), record)
        else:
            return None
        return index

    def _commit(self, index: int, sha256: str) -> None:
        known = self._sha.get(index)
        self._sha[index] = sha256
        fresh = self._running.pop(index, None)
        if known is None and fresh is not None:
            self.states[index] = fresh
        elif known is not None and known != sha256:  # recorded anew; what is in the trash stays there
            self.states[index] = replace(fresh or UNTOUCHED, trashed=self.of(index).trashed)


def read_annotations(campaign: Path) -> Folding:
    """State of all brakings of a campaign; untouched when it has no journal."""
    path = campaign / "journal.jsonl"
    return Folding(read_journal(path) if path.exists() else ())


def _after(state: Annotation, record: Record) -> Annotation:
    """The state after one event; events of later versions of the program change nothing."""
    value: Any = record.payload.get("value")
    changes: dict[str, Any] = {}
    match record.payload.get("action"):
        case Action.EXCLUDE:
            when = record.utc[:19].replace("T", " ")
            by = f"{record.payload.get('who', '')}, {when} UTC".lstrip(", ")
            changes = {"excluded": str(value), "excluded_by": by}
        case Action.RESTORE:
            changes = {"excluded": "", "excluded_by": ""}
        case Action.TAG:
            changes = {"tags": tuple(sorted({*state.tags, str(value)}))}
        case Action.UNTAG:
            changes = {"tags": tuple(tag for tag in state.tags if tag != value)}
        case Action.NOTE:
            changes = {"note": str(value or "")}
        case Action.RATE:
            changes = {"rating": value if isinstance(value, int) else None}
        case Action.TRASH:
            changes = {"trashed": str(value)}
        case Action.UNTRASH:
            changes = {"trashed": ""}
    return replace(state, **changes)


def _said(state: Annotation, record: Record) -> Annotation:
    if record.kind == _RATING:
        rating = record.payload.get("rating")
        return replace(state, rating=rating if isinstance(rating, int) else state.rating)
    return replace(state, said=(*state.said, str(record.payload.get("text", ""))))


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError, ImportError):  # no such user in a container
        return ""

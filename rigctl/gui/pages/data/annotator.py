"""What a person does to brakings, written in a thread, with undo. No widgets.

Job: exclude, restore, tag, note, rate, trash and put back several brakings at once; remember how to undo
it. Not its job: the events (`rigctl.recording.annotations`), asking for reasons (`actions_bar`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from rigctl.core.errors import RigctlError
from rigctl.core.journal import Record
from rigctl.gui.pages.data.entry import Entry
from rigctl.gui.work import Reporter, Work
from rigctl.recording.annotations import Action, annotate_many
from rigctl.recording.catalogue import BRAKINGS
from rigctl.recording.trash import FOLDER as TRASH
from rigctl.recording.trash import restore_braking, trash_braking

Event = tuple[int, Action, str | int | None]
_REMEMBERED = 50


@dataclass(frozen=True)
class Step:
    """How to undo something: words for the button, and the call."""

    words: str
    undo: Callable[[], None]


class Annotator(QObject):
    """Acts on one campaign."""

    written = Signal(list)
    """Records that are in the journal now."""
    moved = Signal(list, list)
    """Files that have gone, files that have come (names relative to the campaign)."""
    done = Signal(str)
    """What was done, in words; `can_undo` says whether it can be undone."""
    failed = Signal(str)

    def __init__(self, work: Work, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._work = work
        self.campaign: Path | None = None
        self._steps: list[Step] = []

    def open(self, campaign: Path | None) -> None:
        """Act on another campaign; what was done in the last one is not undone here."""
        self.campaign = campaign
        self._steps = []

    @property
    def can_undo(self) -> bool:
        """True when there is something to undo."""
        return bool(self._steps)

    def undo(self) -> None:
        """Undo the last thing; that cannot be undone itself."""
        if self._steps:
            self._steps.pop().undo()

    def exclude(self, entries: Sequence[Entry], reason: str) -> None:
        """Take them out of all statistics."""
        back: list[Event] = [
            (e.index, Action.EXCLUDE, e.row.excluded) if e.row.excluded else (e.index, Action.RESTORE, None)
            for e in entries
        ]
        self._write(
            [(e.index, Action.EXCLUDE, reason) for e in entries],
            self._words(entries, self.tr("{0} excluded")),
            back,
        )

    def restore(self, entries: Sequence[Entry]) -> None:
        """Count them again."""
        out = [e for e in entries if e.row.excluded]
        self._write(
            [(e.index, Action.RESTORE, None) for e in out],
            self._words(out, self.tr("{0} counted again")),
            [(e.index, Action.EXCLUDE, e.row.excluded) for e in out],
        )

    def tag(self, entries: Sequence[Entry], tag: str) -> None:
        """Add a tag."""
        new = [e for e in entries if tag not in e.row.tags]
        words = self._words(new, self.tr("{0} tagged “{1}”"), tag)
        self._write(
            [(e.index, Action.TAG, tag) for e in new], words, [(e.index, Action.UNTAG, tag) for e in new]
        )

    def untag(self, entries: Sequence[Entry], tag: str) -> None:
        """Remove a tag."""
        old = [e for e in entries if tag in e.row.tags]
        words = self._words(old, self.tr("tag “{1}” removed from {0}"), tag)
        self._write(
            [(e.index, Action.UNTAG, tag) for e in old], words, [(e.index, Action.TAG, tag) for e in old]
        )

    def note(self, entry: Entry, text: str, before: str) -> None:
        """Set the note."""
        self._write(
            [(entry.index, Action.NOTE, text)],
            self.tr("Note of braking {0} saved").format(entry.index),
            [(entry.index, Action.NOTE, before)],
        )

    def rate(self, entry: Entry, rating: int | None) -> None:
        """Set the noise rating."""
        self._write(
            [(entry.index, Action.RATE, rating)],
            self.tr("Noise rating of braking {0} saved").format(entry.index),
            [(entry.index, Action.RATE, entry.row.rating)],
        )

    def trash(self, entries: Sequence[Entry]) -> None:
        """Move their files to the trash."""
        here = [e for e in entries if not e.trashed]
        words = self._words(here, self.tr("{0} moved to the trash"))
        self._move(_to_trash, [e.index for e in here], words, undoable=True)

    def put_back(self, names: Sequence[str]) -> None:
        """Move files of the trash back."""
        words = self.tr("{0} put back from the trash").format(len(names))
        self._move(_from_trash, [name.partition("/")[2] for name in names], words, undoable=False)

    # -- how ----------------------------------------------------------------------------------------

    def _words(self, entries: Sequence[Entry], text: str, *more: str) -> str:
        if len(entries) == 1:
            what = self.tr("Braking {0}").format(entries[0].index)
        else:
            what = self.tr("{0} brakings").format(len(entries))
        return text.format(what, *more)

    def _write(self, events: list[Event], words: str, back: list[Event] | None) -> None:
        if self.campaign is None or not events:
            return
        campaign = self.campaign

        def written(records: list[Record]) -> None:
            if campaign == self.campaign:
                if back:
                    undone = self.tr("Undone: {0}").format(words)
                    self._remember(Step(words, partial(self._write, back, undone, None)))
                self.written.emit(records)
                self.done.emit(words)

        self._work.in_thread(_annotate, campaign, events, done=written, failed=self.failed.emit)

    def _move(
        self, how: Callable[..., _Moved], what: list[int] | list[str], words: str, undoable: bool
    ) -> None:
        if self.campaign is None or not what:
            return
        campaign = self.campaign

        def moved(result: _Moved) -> None:
            if campaign != self.campaign:
                return
            if undoable and result.come:
                self._remember(Step(words, lambda: self.put_back(result.come)))
            self.moved.emit(result.gone, result.come)
            if result.problem:
                self.failed.emit(result.problem)
            elif result.come:
                self.done.emit(words)

        self._work.in_thread(how, campaign, what, done=moved, failed=self.failed.emit)

    def _remember(self, step: Step) -> None:
        self._steps = [*self._steps, step][-_REMEMBERED:]


@dataclass(frozen=True)
class _Moved:
    gone: list[str]
    come: list[str]
    problem: str = ""


def _annotate(campaign: Path, events: Iterable[Event], reporter: Reporter) -> list[Record]:
    del reporter
    return annotate_many(campaign, events)


def _to_trash(campaign: Path, indices: list[int], reporter: Reporter) -> _Moved:
    del reporter
    return _each(
        indices,
        lambda index: (f"{BRAKINGS}/{index:05d}.h5", f"{TRASH}/{trash_braking(campaign, index).name}"),
    )


def _from_trash(campaign: Path, names: list[str], reporter: Reporter) -> _Moved:
    del reporter
    return _each(
        names, lambda name: (f"{TRASH}/{name}", f"{BRAKINGS}/{restore_braking(campaign, name).name}")
    )


def _each(what: list[int] | list[str], move: Callable[..., tuple[str, str]]) -> _Moved:
    """Move one after the other; what was moved before a failure stays moved and is told."""
    gone: list[str] = []
    come: list[str] = []
    for item in what:
        try:
            old, new = move(item)
        except RigctlError as error:
            return _Moved(gone, come, str(error))
        gone.append(old)
        come.append(new)
    return _Moved(gone, come)

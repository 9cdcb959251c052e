"""The program that is being edited: texts, what they mean, every earlier state, and what is saved.

Job: `ProgramDraft`, the view-model of the page, in plain Python: changes with undo and redo (snapshots of
one frozen value), validity and faults, operations on the list of sequences. Not its job: files
(`program_file`), the dry run (`forecast`), widgets.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from rigctl.gui.pages.sequence.checking import Fault, judge, judge_program
from rigctl.gui.pages.sequence.forms import (
    ChannelRow,
    ProgramForm,
    RecordingForm,
    SequenceForm,
    SpeedRow,
    form_of,
    new_uid,
)
from sequences.program import Program

MERGE_S = 1.5
MOST_STEPS = 500
_NUMBERED = re.compile(r"(.*?) ?(\d+)?")


@dataclass(frozen=True)
class _Step:
    """A state before a change, and where the change was."""

    form: ProgramForm
    uid: int
    place: str


class ProgramDraft:
    """A program under edit.

    Parameters
    ----------
    clock : callable
        Seconds; changes of the same field within `MERGE_S` of each other are one step of undo.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._undo: list[_Step] = []
        self._redo: list[_Step] = []
        self._last: tuple[int, str, float] | None = None
        self.form = ProgramForm()
        self.saved = self.form
        self.program: Program | None = None
        self.last_valid: Program | None = None
        self.faults: tuple[Fault, ...] = ()
        self._judge()

    # -- what it is -------------------------------------------------------------------------------

    @property
    def empty(self) -> bool:
        """True while there is nothing to lose and nothing to show."""
        return not self.form.sequences and not self.form.name and not self._undo

    @property
    def dirty(self) -> bool:
        """True when the texts differ from what was saved or opened last."""
        return self.form != self.saved

    @property
    def can_undo(self) -> bool:
        """True when there is a step back."""
        return bool(self._undo)

    @property
    def can_redo(self) -> bool:
        """True when there is a step forward."""
        return bool(self._redo)

    def sequence(self, uid: int) -> SequenceForm | None:
        """The sequence of that number; None when it is gone."""
        return next((s for s in self.form.sequences if s.uid == uid), None)

    def position(self, uid: int) -> int:
        """Its place in the program, from 0; -1 when it is gone."""
        return next((i for i, s in enumerate(self.form.sequences) if s.uid == uid), -1)

    def count(self, uid: int) -> int | None:
        """Brakings of a sequence, 0 when it is off; None while it is not valid."""
        form = self.sequence(uid)
        model = judge(form).sequence if form is not None else None
        return None if model is None else model.count

    # -- as a whole -------------------------------------------------------------------------------

    def load(self, program: Program | ProgramForm, *, saved: bool = True) -> None:
        """Begin with this program; earlier steps are forgotten. `saved`: there is a file of it."""
        self.form = form_of(program) if isinstance(program, Program) else program
        self.saved = self.form if saved else ProgramForm()
        self._undo.clear()
        self._redo.clear()
        self._last = None
        self.last_valid = None
        self._judge()

    def mark_saved(self, form: ProgramForm) -> None:
        """`form` is what the file holds now."""
        self.saved = form
        self._last = None

    def change(self, form: ProgramForm, uid: int = 0, place: str = "", *, merge: bool = False) -> bool:
        """Take a new state; False when nothing changes. `merge`: typing, one step per pause and field."""
        if form == self.form:
            self.form = form
            return False
        now = self._clock()
        typed_on = self._last is not None and self._last[:2] == (uid, place) and now - self._last[2] < MERGE_S
        if not (merge and typed_on and self._undo):
            self._undo.append(_Step(self.form, uid, place))
            del self._undo[:-MOST_STEPS]
        self._redo.clear()
        self._last = (uid, place, now) if merge else None
        self.form = form
        self._judge()
        return True

    def undo(self) -> tuple[int, str] | None:
        """Take back one step; returns where it was (sequence, field), None when there is none."""
        return self._go(self._undo, self._redo)

    def redo(self) -> tuple[int, str] | None:
        """Do again what was taken back."""
        return self._go(self._redo, self._undo)

    def _go(self, source: list[_Step], target: list[_Step]) -> tuple[int, str] | None:
        if not source:
            return None
        step = source.pop()
        target.append(_Step(self.form, step.uid, step.place))
        self.form = step.form
        self._last = None
        self._judge()
        return step.uid, step.place

    def _judge(self) -> None:
        self.program, self.faults = judge_program(self.form)
        if self.program is not None:
            self.last_valid = self.program

    # -- changes ----------------------------------------------------------------------------------

    def set_head(self, *, name: str | None = None, description: str | None = None) -> bool:
        """Name or description of the program, as typed."""
        form = replace(
            self.form,
            name=self.form.name if name is None else name,
            description=self.form.description if description is None else description,
        )
        return self.change(form, 0, "name" if name is not None else "description", merge=True)

    def set_sequence(self, new: SequenceForm, place: str = "", *, merge: bool = False) -> bool:
        """Another state of the sequence with the same number."""
        sequences = tuple(new if s.uid == new.uid else s for s in self.form.sequences)
        return self.change(replace(self.form, sequences=sequences), new.uid, place, merge=merge)

    def add(self, new: SequenceForm, after: int = 0) -> int:
        """Put a sequence behind the one with number `after` (0: at the end); its name is made unique."""
        new = replace(new, name=self.free_name(new.name), uid=new_uid())
        place = self.position(after) + 1 if self.position(after) >= 0 else len(self.form.sequences)
        listed = list(self.form.sequences)
        listed.insert(place, new)
        self.change(replace(self.form, sequences=tuple(listed)), new.uid, "sequences")
        return new.uid

    def duplicate(self, uid: int) -> int:
        """A copy behind the original; returns its number (0 when there is no original)."""
        original = self.sequence(uid)
        return self.add(original, uid) if original is not None else 0

    def remove(self, uid: int) -> int:
        """Remove a sequence; returns the number of the one to show next, 0 when none is left."""
        place = self.position(uid)
        if place < 0:
            return 0
        left = tuple(s for s in self.form.sequences if s.uid != uid)
        self.change(replace(self.form, sequences=left), uid, "sequences")
        return left[min(place, len(left) - 1)].uid if left else 0

    def move(self, uid: int, place: int) -> bool:
        """Bring a sequence to a place (from 0) of the program."""
        here = self.position(uid)
        place = min(max(place, 0), len(self.form.sequences) - 1)
        if here < 0 or place == here:
            return False
        listed = list(self.form.sequences)
        listed.insert(place, listed.pop(here))
        return self.change(replace(self.form, sequences=tuple(listed)), uid, "sequences")

    def free_name(self, wanted: str) -> str:
        """`wanted`, or with the next number behind it when a sequence has that name."""
        taken = {s.name.strip().casefold() for s in self.form.sequences}
        if wanted.strip().casefold() not in taken:
            return wanted
        found = _NUMBERED.fullmatch(wanted)
        stem = (found[1] if found and found[1] else wanted)[:58]
        number = 2
        while f"{stem} {number}".casefold() in taken:
            number += 1
        return f"{stem} {number}"


def new_sequence(kind: str, channels: dict[str, tuple[float, bool]]) -> SequenceForm:
    """A sequence to begin with: "matrix", "bedding" or "stop", recording `channels` of the rig.

    Parameters
    ----------
    channels : dict of name -> (own rate in Hz, is sound)
        Sound keeps its rate, the others are stored at a thousand values per second.
    """
    quiet = kind == "bedding"
    sampling = max((rate for rate, _ in channels.values()), default=40000.0)
    rows = tuple(
        ChannelRow(name, "1" if sound else str(max(round(sampling / 1000), 1)))
        for name, (_, sound) in channels.items()
        if not (quiet and sound)
    )
    recording = RecordingForm(sampling=f"{sampling:g}", channels=rows)
    base = SequenceForm(name=kind, role=kind, recording=recording, dwell="1")
    if kind == "bedding":
        how = replace(base.conditioning, mode="at_most", tolerance="5", soak="0")
        return replace(
            base,
            repeat="30",
            temperatures=("100",),
            speeds=(SpeedRow("6", "100", "100"),),
            pressures=("10",),
            conditioning=how,
            ventilator=True,
        )
    speeds = (SpeedRow("12", "200", "0"),) if kind == "stop" else (SpeedRow("12", "40", "40"),)
    return replace(base, temperatures=("50", "100"), speeds=speeds, pressures=("10", "20"))

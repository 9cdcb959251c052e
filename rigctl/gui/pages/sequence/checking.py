"""What is wrong, and at which field: validation errors and the dry run, where one types.

Job: `Fault` (place, cells, words, remedy), `judge` for one sequence and `judge_program` for the whole, and
the faults of a dry run. Words name the fields as the page does, not the keys of the file. Not its job: the
rules themselves (`sequences`), showing (`editor`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

from pydantic import ValidationError
from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

from rigctl.gui.pages.sequence.check_words import check_said
from rigctl.gui.pages.sequence.forms import ProgramForm, SequenceForm, mapping_of, profile_rows
from rigctl.gui.pages.sequence.paste import parse_number
from sequences.check import CheckResult, Problem
from sequences.fields import sentence
from sequences.matrix import Sequence
from sequences.program import Program

_SPEED_COLUMNS = {"duration_s": 0, "start_rpm": 1, "end_rpm": 2}
_WHOLE_PLACES = {  # what a model as a whole refuses, by kind: the field at which one mends it
    "soak_exceeds_timeout": "conditioning.soak_s",
    "drag_without_power": "conditioning.drag_speed_rpm",
    "limits_reversed": "limits.cool_down_degc",
    "no_channels": "recording.channels",
    "repeated_channel": "recording.channels",
    "unequal_lists": "processing",
    "too_many_brakings": "repeat",
    "set_point_above_limit": "temperatures_degc",
    "negative_pressure": "pressures_bar",
    "rise_too_long": "pressure_function.rise_s",
    "empty_list": "temperatures_degc",
    "repeated_name": "name",
    "zero_brakings": "sequences",
}
_OWN_WORDS: dict[str, tuple[object, object]] = {
    "float_type": (
        QT_TRANSLATE_NOOP("faults", "“{value}” is not a number."),
        QT_TRANSLATE_NOOP("faults", "Write for example 12.5, without a unit."),
    ),
    "int_type": (
        QT_TRANSLATE_NOOP("faults", "“{value}” is not a whole number."),
        QT_TRANSLATE_NOOP("faults", "Write for example 3."),
    ),
    "missing_number": (
        QT_TRANSLATE_NOOP("faults", "Nothing is entered here."),
        QT_TRANSLATE_NOOP("faults", "Enter a number."),
    ),
    "empty_list": (
        QT_TRANSLATE_NOOP("faults", "The list is empty: nothing would be run."),
        QT_TRANSLATE_NOOP("faults", "Enter at least one value."),
    ),
    "empty_temperatures": (
        QT_TRANSLATE_NOOP("faults", "The list is empty: nothing would be run."),
        QT_TRANSLATE_NOOP("faults", "Enter a temperature, or switch the conditioning off."),
    ),
    "zero_brakings": (
        QT_TRANSLATE_NOOP("faults", "The program has no braking to run."),
        QT_TRANSLATE_NOOP("faults", "Add a sequence, or switch one on."),
    ),
    "missing_name": (
        QT_TRANSLATE_NOOP("faults", "A name is missing."),
        QT_TRANSLATE_NOOP("faults", "Use letters, digits, “.”, “_”, “-” or blanks."),
    ),
    "unsafe_name": (
        QT_TRANSLATE_NOOP("faults", "{value} cannot be a name."),
        QT_TRANSLATE_NOOP(
            "faults", "Use letters, digits, “.”, “_”, “-”, blanks; begin with a letter or digit."
        ),
    ),
    "no_channels": (
        QT_TRANSLATE_NOOP("faults", "No channel is recorded."),
        QT_TRANSLATE_NOOP("faults", "Tick at least one."),
    ),
    "soak_exceeds_timeout": (
        QT_TRANSLATE_NOOP(
            "faults", "A soak of {value} s leaves no time within the time-out of {timeout_s} s."
        ),
        QT_TRANSLATE_NOOP("faults", "Raise the time-out or shorten the soak."),
    ),
    "unequal_lists": (
        QT_TRANSLATE_NOOP("faults", "Lists of unequal length cannot be run entry by entry."),
        QT_TRANSLATE_NOOP(
            "faults", "Make the lists equally long (or of one value), or run all combinations."
        ),
    ),
    "missing_steps": (
        QT_TRANSLATE_NOOP("faults", "No step is entered."),
        QT_TRANSLATE_NOOP("faults", "Enter offsets from the working point, for example 0 5 −3."),
    ),
}
_LABELS: dict[str, object] = {  # keys of the file, as texts of the checks name them, and their fields
    "conditioning.drag_pressure_bar": QT_TRANSLATE_NOOP("faults", "the drag pressure"),
    "conditioning.drag_speed_rpm": QT_TRANSLATE_NOOP("faults", "the drag speed"),
    "conditioning.timeout_s": QT_TRANSLATE_NOOP("faults", "the time-out"),
    "limits.max_degc": QT_TRANSLATE_NOOP("faults", "the maximum temperature"),
    "recording.channels": QT_TRANSLATE_NOOP("faults", "the recorded channels"),
    "pressure_function.rise_s": QT_TRANSLATE_NOOP("faults", "the rise time"),
    "ventilator = false": QT_TRANSLATE_NOOP("faults", "the ventilator off"),
    "temperatures_degc": QT_TRANSLATE_NOOP("faults", "temperatures"),
    "pressures_bar": QT_TRANSLATE_NOOP("faults", "pressures"),
    "drag_pressure_bar": QT_TRANSLATE_NOOP("faults", "the drag pressure"),
    "drag_speed_rpm": QT_TRANSLATE_NOOP("faults", "the drag speed"),
    "cool_down_degc": QT_TRANSLATE_NOOP("faults", "the cool-down temperature"),
    "max_degc": QT_TRANSLATE_NOOP("faults", "the maximum temperature"),
    "timeout_s": QT_TRANSLATE_NOOP("faults", "the time-out"),
    "sampling_hz": QT_TRANSLATE_NOOP("faults", "the sampling rate"),
    "soak_s": QT_TRANSLATE_NOOP("faults", "the soak"),
    "rise_s": QT_TRANSLATE_NOOP("faults", "the rise time"),
    "degC": "°C",
}
_KEYS = re.compile("|".join(re.escape(key) for key in sorted(_LABELS, key=len, reverse=True)))


def _tr(text: str) -> str:
    return QCoreApplication.translate("faults", text)


@dataclass(frozen=True)
class Fault:
    """Something wrong at one field.

    Attributes
    ----------
    uid : int
        Sequence; 0 for the program.
    place : str
        Key of the field, as in the file: "conditioning.soak_s".
    words, remedy : str
    severity : str
        "error" or "warning".
    cells : tuple of (row, column)
        In lists, the cells that are meant; empty: the list as a whole.
    note : str
        How often and where first: too long for the place beside a field.
    """

    uid: int
    place: str
    words: str
    remedy: str = ""
    severity: str = "error"
    cells: tuple[tuple[int, int], ...] = ()
    note: str = ""

    @property
    def text(self) -> str:
        """Words and remedy in one line."""
        return f"{self.words} {self.remedy}".rstrip()


@dataclass(frozen=True)
class Judged:
    """One sequence after validation: the model, or what is wrong."""

    sequence: Sequence | None
    faults: tuple[Fault, ...]


def judge(form: SequenceForm) -> Judged:
    """Validate one sequence; quick for a form that was judged before."""
    judged = _judge(form)
    if all(fault.uid == form.uid for fault in judged.faults):
        return judged
    return Judged(judged.sequence, tuple(_with_uid(fault, form.uid) for fault in judged.faults))


def _with_uid(fault: Fault, uid: int) -> Fault:
    return replace(fault, uid=uid)


@lru_cache(maxsize=256)
def _judge(form: SequenceForm) -> Judged:
    try:
        return Judged(Sequence.model_validate(mapping_of(form)), ())
    except ValidationError as error:
        faults = tuple(_fault(form, dict(entry)) for entry in error.errors(include_url=False))
        return Judged(None, _merged(faults))


def judge_program(form: ProgramForm) -> tuple[Program | None, tuple[Fault, ...]]:
    """Validate a whole program; None and every fault when it must not be run."""
    judged = [judge(sequence) for sequence in form.sequences]
    faults = [fault for each in judged for fault in each.faults]
    whole = {"name": form.name.strip(), "description": form.description}
    models = [each.sequence for each in judged if each.sequence is not None]
    try:
        program = Program.model_validate({**whole, "sequences": models})
    except ValidationError as error:
        for entry in error.errors(include_url=False):
            if entry["type"] == "zero_brakings" and faults:
                continue  # it may have brakings once the sequences are right
            faults.append(_program_fault(form, dict(entry)))
        return None, tuple(faults)
    return (None if faults else program), tuple(faults)


def _program_fault(form: ProgramForm, entry: Mapping[str, Any]) -> Fault:
    kind = str(entry["type"])
    if kind == "repeated_name":
        seen: set[str] = set()
        for sequence in form.sequences:
            name = sequence.name.strip().casefold()
            if name in seen:
                return Fault(sequence.uid, "name", *_words(entry))
            seen.add(name)
    if kind == "unsafe_name" and not form.name.strip():
        return Fault(0, "name", *_own_words("missing_name", {}))
    place = str(entry["loc"][0]) if entry["loc"] else "sequences"
    return Fault(0, place, *_words(entry))


def _fault(form: SequenceForm, entry: Mapping[str, Any]) -> Fault:
    kind, location = str(entry["type"]), tuple(entry["loc"])
    place, cells = _place(form, kind, location)
    empty = entry.get("input") == ""
    if kind == "unsafe_name" and empty:
        words = _own_words("missing_name", {})
    elif kind in ("float_type", "int_type") and empty:
        words = _own_words("missing_number", {})
    elif kind == "empty_list" and place == "temperatures_degc":
        words = _own_words("empty_temperatures", {})
    elif kind == "too_short" and place == "pressure_function.steps_bar":
        words = _own_words("missing_steps", {})
    else:
        words = _words(entry)
    return Fault(form.uid, place, *words, cells=cells)


def _place(
    form: SequenceForm, kind: str, location: tuple[Any, ...]
) -> tuple[str, tuple[tuple[int, int], ...]]:
    """Field and cells of a fault."""
    head = str(location[0]) if location else ""
    place, cells = ".".join(str(part) for part in location), ()
    if kind in _WHOLE_PLACES and len(location) < 2:
        place = head if kind == "empty_list" and head else _WHOLE_PLACES[kind]
        if kind == "set_point_above_limit":
            cells = _cells_above(form.temperatures, parse_number(form.limits.maximum))
    elif head == "speed_profiles" and len(location) > 1:
        place, cells = head, _speed_cells(form, location)
    elif head in ("temperatures_degc", "pressures_bar") and len(location) > 1:
        place, cells = head, ((int(location[1]), 0),)
    elif head == "recording" and len(location) > 2:
        place, cells = "recording.channels", ((int(location[2]), 0),)
    elif head == "pressure_function" and len(location) > 2:  # the kind stands between
        place = f"{head}.{location[2]}"
    return place, cells


def _speed_cells(form: SequenceForm, location: tuple[Any, ...]) -> tuple[tuple[int, int], ...]:
    rows = profile_rows(form.speeds)[location[1]]
    if len(location) > 4:
        return ((rows[location[3]], _SPEED_COLUMNS.get(str(location[4]), 0)),)
    return tuple((row, column) for row in rows for column in range(3))


def _cells_above(texts: tuple[str, ...], limit: float | None) -> tuple[tuple[int, int], ...]:
    numbers = [parse_number(text) for text in texts]
    return tuple(
        (row, 0) for row, n in enumerate(numbers) if n is not None and limit is not None and n > limit
    )


def _own_words(kind: str, context: Mapping[str, Any]) -> tuple[str, str]:
    words, remedy = _OWN_WORDS[kind]
    return _tr(str(words)).format(**context), _tr(str(remedy))


def _words(entry: Mapping[str, Any]) -> tuple[str, str]:
    kind, context = str(entry["type"]), dict(entry.get("ctx") or {})
    if kind in _OWN_WORDS:
        return _own_words(kind, {"value": str(entry.get("input"))[:40], **context})
    return _plain(str(entry["msg"])), _plain(str(context.get("remedy") or ""))


def _named(text: str) -> str:
    """Keys of the file by the names that the fields have on the page."""
    return _KEYS.sub(lambda found: _tr(str(_LABELS[found[0]])), text)


def _plain(text: str) -> str:
    """The text of a check as a sentence in the words of the page."""
    return sentence(_named(check_said(text))) if text else ""


def _merged(faults: tuple[Fault, ...]) -> tuple[Fault, ...]:
    """Equal words at one list are said once, with all their cells."""
    merged: dict[tuple[str, str], Fault] = {}
    for fault in faults:
        key = (fault.place, fault.text)
        before = merged.get(key)
        cells = (before.cells if before else ()) + fault.cells
        merged[key] = replace(fault, cells=cells)
    return tuple(merged.values())


# -- the dry run ------------------------------------------------------------------------------------


def rig_faults(result: CheckResult, form: ProgramForm) -> tuple[Fault, ...]:
    """What a dry run has found, at the fields of the program that was checked."""
    by_name = {sequence.name.strip(): sequence for sequence in form.sequences}
    return tuple(
        _rig_fault(problem, by_name[problem.sequence])
        for problem in result.problems
        if problem.sequence in by_name
    )


def _rig_fault(problem: Problem, form: SequenceForm) -> Fault:
    goes_on = problem.problem.startswith(("is ", "are ", "of ", "cannot "))
    words = f"{problem.value}{' ' if goes_on else ': '}{problem.problem}"
    if problem.count > 1:
        note = _tr("{0} brakings, the first is number {1}.").format(problem.count, problem.first_index)
    else:
        note = _tr("Braking {0}.").format(problem.first_index)
    return Fault(
        form.uid, _rig_place(problem.key), _named(check_said(words)) + ".", _plain(problem.remedy),
        problem.severity, _rig_cells(problem, form), note,
    )  # fmt: skip


def _rig_place(key: str) -> str:
    return "pressure_function.kind" if key == "pressure_function" else key


def _rig_cells(problem: Problem, form: SequenceForm) -> tuple[tuple[int, int], ...]:
    """Cells whose number is named by the problem, where it names set-points as they are written."""
    if "..." in problem.value:  # more values than it names: the list as a whole
        return ()
    shown = set(re.split(r",? ", problem.value))
    if problem.key in ("temperatures_degc", "pressures_bar"):
        texts = form.temperatures if problem.key == "temperatures_degc" else form.pressures
        numbers = [parse_number(text) for text in texts]
        return tuple((row, 0) for row, n in enumerate(numbers) if n is not None and f"{n:.6g}" in shown)
    if problem.key == "speed_profiles":
        cells = []
        for row, segment in enumerate(form.speeds):
            for column, text in ((1, segment.start), (2, segment.end)):
                number = parse_number(text)
                if number is not None and f"{number:.6g}" in shown:
                    cells.append((row, column))
        return tuple(cells)
    if problem.key == "recording.channels":
        names = [channel.name for channel in form.recording.channels]
        return tuple((row, 0) for row, name in enumerate(names) if name in shown)
    return ()

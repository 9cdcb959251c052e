"""What can be asked of a running program: which verb when, and what will happen, in words. No widgets.

Job: permissions with reasons, consequences for the tips. Not its job: the buttons (`verb_row`), doing it
(engine).
"""

from __future__ import annotations

from dataclasses import dataclass

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

from rigctl.engine.state import Verb
from rigctl.gui.rig.state import RigState, Word

translate = QCoreApplication.translate

VERBS = (Verb.PAUSE, Verb.HOLD, Verb.RESUME, Verb.SKIP, Verb.REPEAT, Verb.STOP)
_CONSEQUENCES = {
    Verb.PAUSE: QT_TRANSLATE_NOOP(
        "run", "Breaks off this braking now, releases, stops the disc and waits. Resume does it again."
    ),
    Verb.HOLD: QT_TRANSLATE_NOOP("run", "Finishes this braking, then releases, stops the disc and waits."),
    Verb.RESUME: QT_TRANSLATE_NOOP("run", "Goes on; after Hold it takes the wish to wait back."),
    Verb.SKIP: QT_TRANSLATE_NOOP(
        "run", "Breaks off this braking and goes on with the next. It counts as not complete."
    ),
    Verb.REPEAT: QT_TRANSLATE_NOOP(
        "run", "Breaks off this braking and starts it again. What was recorded is kept aside."
    ),
    Verb.STOP: QT_TRANSLATE_NOOP(
        "run", "Breaks off this braking, releases, stops the disc and ends the run. It can be resumed later."
    ),
}


@dataclass(frozen=True)
class VerbPermission:
    """Whether a verb can be asked now; if not, why."""

    allowed: bool
    reason: str = ""


def consequence(verb: Verb) -> str:
    """What the verb will do."""
    return translate("run", str(_CONSEQUENCES[verb]))


def may(verb: Verb, state: RigState, hold_asked: bool) -> VerbPermission:
    """Whether a verb can be asked in a state."""
    running, paused = state.word is Word.RUNNING, state.word is Word.PAUSED
    obstacles = (
        (state.mode != "program" or not (running or paused), translate("run", "No program is running.")),
        (not state.commanding, translate("run", "This window only watches. Take command first.")),
        (verb is Verb.PAUSE and paused, translate("run", "The run waits already.")),
        (verb is Verb.HOLD and paused, translate("run", "The run waits already.")),
        (verb is Verb.HOLD and hold_asked, translate("run", "It will wait after this braking already.")),
        (verb is Verb.RESUME and running and not hold_asked, translate("run", "The run does not wait.")),
    )
    reason = next((words for holds, words in obstacles if holds), "")
    return VerbPermission(not reason, reason)

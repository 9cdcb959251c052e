"""From news to the state that is shown: pure functions, no Qt, no I/O.

Job: the one word, the readings, the cause. Not its job: where news come from (`rigctl.gui.rig.connection`).
"""

from __future__ import annotations

from dataclasses import replace

from rigctl.core.journal import Record
from rigctl.engine.state import Outcome, Progress, RunResult, State
from rigctl.gui.rig.state import Readings, RigState, SafetyCause, Word


def word_of(progress: Progress) -> Word:
    """State of the rig in one word."""
    if progress.state is State.FAULTED:
        return Word.TRIPPED
    if progress.state is State.STOPPING or progress.phase == "stopping":
        return Word.STOPPING
    if progress.state is State.PAUSED:
        return Word.PAUSED
    if progress.mode == "manual":
        if not progress.enabled or progress.safety != "armed":
            return Word.LOCKED
        return Word.RUNNING if progress.state is State.RUNNING else Word.READY
    return Word.STARTING if progress.state is State.IDLE or progress.phase == "arming" else Word.RUNNING


def with_progress(state: RigState, progress: Progress, left_s: float | None) -> RigState:
    """The state after news of the controller."""
    cause = state.cause
    if progress.cause:
        utc = cause.utc if cause is not None else ""
        cause = SafetyCause(_sentence(progress.cause), progress.remedy, utc)
    word = word_of(progress)
    return replace(
        state,
        word=word,
        mode=progress.mode,
        phase=progress.phase,
        braking=progress.braking,
        done=progress.done,
        total=progress.total,
        incomplete=progress.incomplete,
        squealing=progress.squealing,
        rig_s=progress.rig_s,
        left_s=left_s,
        cause=cause if word is Word.TRIPPED else None,
        relay_closed=progress.relay,
        enabled=progress.enabled,
        recording=progress.recording,
        recording_left_s=progress.recording_left_s,
        readings=Readings(
            progress.speed_rpm, progress.pressure_bar, progress.torque_nm, progress.temperature_degc,
            progress.mu, progress.set_speed_rpm, progress.set_pressure_bar, progress.ventilator_m3_h,
        ),
    )  # fmt: skip


def with_record(state: RigState, record: Record) -> RigState:
    """The state after a record of the journal: first-out cause, safe state, end."""
    payload = record.payload
    if record.kind == "trip" and record.source == "watchdog":
        words = str(payload.get("words") or payload.get("cause") or "tripped")
        cause = SafetyCause(_sentence(words), str(payload.get("remedy") or ""), record.utc)
        return replace(state, cause=cause)
    if record.kind == "reset" and record.source == "watchdog":
        return replace(state, cause=None)
    return state


def after_result(state: RigState, result: RunResult) -> RigState:
    """The session has come to its end and says how."""
    words = result.outcome.value
    cause = None
    if result.outcome in (Outcome.TRIPPED, Outcome.FAILED):
        known = state.cause
        cause = known or SafetyCause(_sentence(result.cause), result.remedy)
    return replace(
        state,
        word=Word.TRIPPED if result.outcome is Outcome.TRIPPED else Word.OFFLINE,
        phase=f"{words}: {result.done} of {result.total} brakings complete" if result.total else words,
        done=result.done,
        total=result.total,
        left_s=None,
        cause=cause,
        relay_closed=False,
        enabled=False,
        recording=False,
        commander="",
        commanding=False,
    )


def after_loss(state: RigState, *, safe: bool) -> RigState:
    """The controller has gone without a word: killed, crashed, or the machine took it."""
    cause = state.cause or SafetyCause(
        "The controller process has gone.", "The watchdog brings the rig to the safe state."
    )
    phase = (
        "The rig is in the safe state: torque off, pressure vented."
        if safe
        else "The controller has gone; waiting for the safe state …"
    )
    return replace(
        state, word=Word.TRIPPED, phase=phase, cause=cause, left_s=None, relay_closed=False, enabled=False,
        recording=False, commander="", commanding=False,
    )  # fmt: skip


def _sentence(text: str) -> str:
    text = text.strip()
    return text[:1].upper() + text[1:] + ("" if text.endswith((".", "!")) else ".")

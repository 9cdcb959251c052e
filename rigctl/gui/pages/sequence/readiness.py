"""May the program be started, and what is said before it is: plain words from plain values.

Not its job: starting. Without widgets.
"""

from __future__ import annotations

from PySide6.QtCore import QCoreApplication

from rigctl.config.rig import RigConfig
from rigctl.gui.format import bytes_text
from rigctl.gui.pages.sequence.checking import Fault
from rigctl.gui.pages.sequence.draft import ProgramDraft
from rigctl.gui.pages.sequence.forecast import Forecast
from rigctl.gui.pages.sequence.words import brakings_text, long_time_text, place_name
from rigctl.gui.rig.state import RigState, Word

_FREE = (Word.OFFLINE, Word.TRIPPED)
"""Words with which a session can be begun; the connection refuses if a tripped one still lives."""


def why_not(
    draft: ProgramDraft,
    faults: list[Fault],
    forecast: Forecast | None,
    rig: RigConfig | None,
    state: RigState,
) -> str:
    """What hinders a start, and what to do about it; "" when nothing does."""
    errors = [fault for fault in faults if fault.severity == "error"]
    why = ""
    if not draft.form.sequences:
        why = QCoreApplication.translate("sequence", "Cannot be started: add a sequence first.")
    elif errors:
        why = _errors_text(draft, errors)
    elif rig is None:
        why = QCoreApplication.translate("sequence", "Cannot be started: no rig file is found.")
    elif forecast is None or forecast.program is not draft.program or forecast.rig is not rig:
        why = QCoreApplication.translate("sequence", "Checking every set-point against the rig …")
    elif state.word is Word.STARTING:
        why = QCoreApplication.translate("sequence", "A session is being started.")
    elif state.word not in _FREE:
        why = _session_text(state.mode)
    return why


def _session_text(mode: str) -> str:
    if mode == "program":
        return QCoreApplication.translate("sequence", "A program is running; see the run page.")
    return QCoreApplication.translate(
        "sequence", "A manual session is open; end it on the manual page first."
    )


def _errors_text(draft: ProgramDraft, errors: list[Fault]) -> str:
    names = {sequence.uid: sequence.name.strip() for sequence in draft.form.sequences}
    parts = (names.get(errors[0].uid, ""), place_name(errors[0].place))
    where = ", ".join(part for part in parts if part)
    first = (f"{where}: " if where else "") + errors[0].words
    if len(errors) == 1:
        return QCoreApplication.translate("sequence", "Cannot be started: {0}").format(first)
    text = QCoreApplication.translate("sequence", "Cannot be started, {0} errors. First: {1}")
    return text.format(len(errors), first)


def start_words(forecast: Forecast, disk_left: int | None, warnings: int, *, saved: bool) -> str:
    """What the second click starts."""
    check = forecast.check
    lines = [
        QCoreApplication.translate("sequence", "{0} on {1}").format(forecast.program.name, forecast.rig.name),
        QCoreApplication.translate("sequence", "{0}, about {1} of rig time").format(
            brakings_text(check.n_brakings), long_time_text(check.estimate.total_s)
        ),
    ]
    volume = QCoreApplication.translate("sequence", "up to {0} of data").format(bytes_text(check.data_bytes))
    if disk_left is not None:
        volume += QCoreApplication.translate("sequence", ", {0} of disk left").format(bytes_text(disk_left))
        if check.data_bytes > disk_left:
            volume = "▲ " + volume + QCoreApplication.translate("sequence", ": that may not fit")
    lines.append(volume)
    if not forecast.rig.simulated:
        lines.append(QCoreApplication.translate("sequence", "▲ The REAL rig will move, heat and brake."))
    if warnings:
        lines.append(QCoreApplication.translate("sequence", "▲ Warnings: {0}, see above").format(warnings))
    if not saved:
        lines.append(QCoreApplication.translate("sequence", "Not saved: a copy is kept and run."))
    return "\n".join(lines)

"""The list of alarms: what the journal and the live values say that needs a person.

Job: alarms from records of the journal and from a `RigState` near the watchdog's limits, each with severity,
time, words, remedy, number of times, and who has acknowledged it. The same alarm again is counted, not
repeated. No widgets. Not its job: showing it, writing acknowledgements (`rigctl.gui.rig.alarms`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from typing import Any

from PySide6.QtCore import QT_TRANSLATE_NOOP, QCoreApplication

from rigctl.core.journal import Record
from rigctl.gui.rig.near_limits import LimitWatch
from rigctl.gui.rig.phases import said
from rigctl.gui.rig.state import RigState

translate = QCoreApplication.translate

WARNING, ALARM = "warning", "alarm"
LOW_DISK_BYTES = 1e9


@dataclass(frozen=True)
class Alarm:
    """One entry.

    Attributes
    ----------
    key : str
        What it is, e.g. "trip:estop"; the same key is counted while nobody has acknowledged it.
    severity : str
        "warning" or "alarm".
    utc, last_utc : str
        First and newest time, ISO 8601.
    count : int
    active : bool
        The condition lasts, as far as is known.
    acknowledged_by, acknowledged_utc : str
        Empty while nobody has.
    """

    key: str
    severity: str
    utc: str
    words: str
    remedy: str = ""
    last_utc: str = ""
    count: int = 1
    active: bool = False
    acknowledged_by: str = ""
    acknowledged_utc: str = ""

    @property
    def open(self) -> bool:
        """True while nobody has acknowledged it."""
        return not self.acknowledged_by


@dataclass(frozen=True)
class _Found:
    key: str
    severity: str
    words: str
    remedy: str = ""


class AlarmList:
    """All alarms of a campaign, newest last."""

    def __init__(self) -> None:
        self.alarms: list[Alarm] = []
        self.watch = LimitWatch(None, {})

    def clear(self) -> None:
        """Another campaign."""
        self.alarms = []

    def newest_open(self) -> Alarm | None:
        """What the alarm bar shows: the newest that nobody has acknowledged, alarms before warnings."""
        opened = [alarm for alarm in self.alarms if alarm.open]
        worst = [alarm for alarm in opened if alarm.severity == ALARM] or opened
        return max(worst, key=lambda alarm: alarm.last_utc) if worst else None

    # -- from the journal ------------------------------------------------------------------------

    def take_records(self, records: Iterable[Record]) -> bool:
        """New records; True when the list has changed."""
        changed = False
        for record in records:
            if record.kind == "alarm_acknowledged":
                payload = record.payload
                changed |= self.acknowledge(
                    str(payload.get("alarm", "")), str(payload.get("who") or record.source), record.utc
                )
            elif (record.source, record.kind) in (("watchdog", "reset"), ("operator", "trip_acknowledged")):
                changed |= self._reset(record)
            elif (found := found_in(record)) is not None:
                self.raise_alarm(found.key, found.severity, found.words, found.remedy, record.utc)
                changed = True
        return changed

    def _reset(self, record: Record) -> bool:
        who = f"{record.payload.get('who')}: {record.payload.get('reason')}"
        changed = False
        for alarm in list(self.alarms):
            if alarm.key.startswith("trip:"):
                changed |= self.acknowledge(alarm.key, who, record.utc)
        return changed

    # -- from live values ------------------------------------------------------------------------

    def take_state(self, state: RigState, now: datetime | None = None) -> bool:
        """Newest readings; True when the list has changed."""
        utc = (now or datetime.now(UTC)).isoformat(timespec="milliseconds")
        before = self.alarms
        self.alarms = list(before)
        near = self.watch.near(state.readings)
        for key, words, remedy in near:
            self._hold(f"near:{key}", words, remedy, utc)
        low_disk = state.disk_left_bytes is not None and state.disk_left_bytes < LOW_DISK_BYTES
        if low_disk:
            gigabytes = f"{(state.disk_left_bytes or 0.0) / 1e9:.2f}"
            words = translate("alarms", "Only {0} GB of disk are left.").format(gigabytes)
            remedy = translate("alarms", "Free some space before the next braking.")
            self._hold("disk", words, remedy, utc)
        lasting = {f"near:{key}" for key, _, _ in near} | ({"disk"} if low_disk else set())
        for place, alarm in enumerate(self.alarms):
            if alarm.active and alarm.key not in lasting:
                self.alarms[place] = replace(alarm, active=False)
        return self.alarms != before

    def _hold(self, key: str, words: str, remedy: str, utc: str) -> None:
        """A lasting condition: one entry from its beginning to its end, its words follow the value."""
        for place, alarm in enumerate(self.alarms):
            if alarm.key == key and alarm.active:
                if alarm.open and alarm.words != words:
                    self.alarms[place] = replace(alarm, words=words)
                return
        self.raise_alarm(key, WARNING, words, remedy, utc, active=True)

    # -- changes ---------------------------------------------------------------------------------

    def raise_alarm(
        self, key: str, severity: str, words: str, remedy: str, utc: str, *, active: bool = False
    ) -> None:
        """A new alarm, or once more one that nobody has acknowledged."""
        for place, alarm in enumerate(self.alarms):
            if alarm.key == key and alarm.open:
                self.alarms[place] = replace(
                    alarm, words=words, remedy=remedy, last_utc=utc, count=alarm.count + 1, active=active
                )
                return
        self.alarms.append(Alarm(key, severity, utc, words, remedy, utc, active=active))

    def acknowledge(self, key: str, who: str, utc: str) -> bool:
        """Somebody has seen all that is open under this key; True when there was something."""
        changed = False
        for place, alarm in enumerate(self.alarms):
            if alarm.key == key and alarm.open:
                self.alarms[place] = replace(alarm, acknowledged_by=who or "somebody", acknowledged_utc=utc)
                changed = True
        return changed


# -- words of the records ----------------------------------------------------------------------------


def _text(payload: dict[str, Any], *keys: str) -> str:
    return said(next((str(payload[key]) for key in keys if payload.get(key)), ""))


def _sentence(text: str) -> str:
    text = text.strip()
    return text[:1].upper() + text[1:] + ("" if not text or text[-1] in ".!?" else ".")


def _trip(p: dict[str, Any]) -> _Found:
    return _Found(f"trip:{p.get('cause')}", ALARM, _sentence(_text(p, "words", "cause")), _text(p, "remedy"))


def _further(p: dict[str, Any]) -> _Found:
    words = translate("alarms", "Further cause: {0}").format(_text(p, "words", "cause"))
    return _Found(f"further:{p.get('cause')}", WARNING, _sentence(words), _text(p, "remedy"))


def _refused(what: str) -> Callable[[dict[str, Any]], _Found]:
    def found(p: dict[str, Any]) -> _Found:
        reason = _text(p, "words", "why")
        words = translate("alarms", "{0} was refused: {1}").format(translate("alarms", what), reason)
        return _Found(f"refused:{what}:{p.get('why')}", WARNING, _sentence(words), _text(p, "remedy"))

    return found


def _plain(severity: str, words: str, remedy: str = "") -> Callable[[dict[str, Any]], _Found]:
    def found(p: dict[str, Any]) -> _Found:
        detail = _text(p, "words", "error", "cause", "reason")
        said = translate("alarms", words)
        told = translate("alarms", remedy) if remedy else ""
        return _Found(words, severity, _sentence(f"{said}: {detail}" if detail else said), told)

    return found


def _broken_off(p: dict[str, Any]) -> _Found | None:
    reason = str(p.get("reason") or "")
    if reason.endswith("by the operator") or reason.startswith("safety trip"):
        return None  # a person knows, or the trip itself is the alarm
    words = translate("alarms", "Braking {0} was broken off: {1}").format(p.get("index"), said(reason))
    remedy = translate("alarms", "It can be repeated on the Run page.")
    return _Found("braking_broken_off", WARNING, _sentence(words), remedy)


def _recording_failed(p: dict[str, Any]) -> _Found:
    words = translate("alarms", "Braking {0} was not recorded: {1}").format(p.get("index"), _text(p, "error"))
    remedy = translate("alarms", "See the disk and logs/recorder.log.")
    return _Found("recording_failed", ALARM, _sentence(words), remedy)


def _run_ended(p: dict[str, Any]) -> _Found | None:
    if p.get("outcome") != "failed":
        return None
    words = translate("alarms", "The run has failed: {0}").format(_text(p, "cause"))
    return _Found("run_failed", ALARM, _sentence(words), translate("alarms", "See the logs."))


_RECORDS: dict[tuple[str, str], Callable[[dict[str, Any]], _Found | None]] = {
    ("watchdog", "trip"): _trip,
    ("watchdog", "further_cause"): _further,
    ("watchdog", "refused_arm"): _refused(str(QT_TRANSLATE_NOOP("alarms", "Arming"))),
    ("watchdog", "refused_disarm"): _refused(str(QT_TRANSLATE_NOOP("alarms", "Disarming"))),
    ("watchdog", "refused_reset"): _refused(str(QT_TRANSLATE_NOOP("alarms", "The reset"))),
    ("watchdog", "refused_controller"): _refused(str(QT_TRANSLATE_NOOP("alarms", "A second controller"))),
    ("watchdog", "refused_message"): _refused(str(QT_TRANSLATE_NOOP("alarms", "A message to the watchdog"))),
    ("watchdog", "refused_sample"): _refused(
        str(QT_TRANSLATE_NOOP("alarms", "A sample of the safety channel"))
    ),
    ("watchdog", "safe_state_not_confirmed"): _plain(
        ALARM,
        str(QT_TRANSLATE_NOOP("alarms", "The safe state is not confirmed")),
        str(QT_TRANSLATE_NOOP("alarms", "Do not go near the rig; look at pressure and speed there.")),
    ),
    ("watchdog", "rig_gone"): _plain(
        ALARM,
        str(QT_TRANSLATE_NOOP("alarms", "The safety channel has gone")),
        str(QT_TRANSLATE_NOOP("alarms", "See logs/rig.log and the cables.")),
    ),
    ("controller", "not_at_rest_after_trip"): _plain(
        ALARM,
        str(QT_TRANSLATE_NOOP("alarms", "The rig is not at rest after the trip")),
        str(QT_TRANSLATE_NOOP("alarms", "Do not go near it; press the emergency stop.")),
    ),
    ("controller", "rig_lost_after_trip"): _plain(
        ALARM,
        str(QT_TRANSLATE_NOOP("alarms", "The rig was lost after the trip")),
        str(QT_TRANSLATE_NOOP("alarms", "See logs.")),
    ),
    ("controller", "run_down_failed"): _plain(
        ALARM,
        str(QT_TRANSLATE_NOOP("alarms", "The rig could not be run down")),
        str(QT_TRANSLATE_NOOP("alarms", "The relay has dropped; look at pressure and speed there.")),
    ),
    ("controller", "recorder_lost"): _plain(
        ALARM,
        str(QT_TRANSLATE_NOOP("alarms", "The recorder has gone")),
        str(QT_TRANSLATE_NOOP("alarms", "See logs/recorder.log.")),
    ),
    ("controller", "failed"): _plain(
        ALARM,
        str(QT_TRANSLATE_NOOP("alarms", "The controller has failed")),
        str(QT_TRANSLATE_NOOP("alarms", "See logs/controller.log.")),
    ),
    ("controller", "manual_failed"): _plain(
        WARNING, str(QT_TRANSLATE_NOOP("alarms", "A manual command has failed"))
    ),
    ("controller", "unattended"): _plain(
        WARNING,
        str(QT_TRANSLATE_NOOP("alarms", "Nobody commanded: the rig was run down")),
        str(QT_TRANSLATE_NOOP("alarms", "Take command.")),
    ),
    ("controller", "braking_broken_off"): _broken_off,
    ("recorder", "RECORDING_FAILED"): _recording_failed,
    ("supervisor", "run_ended"): _run_ended,
}


def found_in(record: Record) -> _Found | None:
    """The alarm that a record of the journal means, if any."""
    make = _RECORDS.get((record.source, record.kind))
    return None if make is None else make(record.payload)

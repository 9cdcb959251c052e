"""What the manual page may show and do in which state, and in which words. No widgets.

Job: fold rig state and rig file into a scene, permissions with reasons, the notice above the controls, scales
of the indicators, and the time left of a recording. Not its job: numbers that are typed (`orders`), commands
(`page`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from PySide6.QtCore import QCoreApplication

from rigctl.config.rig import RigConfig
from rigctl.gui.format import quantity_text
from rigctl.gui.rig.phases import said
from rigctl.gui.rig.state import RigState, Word
from rigctl.gui.widgets.moving_bar import BarScale

translate = QCoreApplication.translate

TOLERANCE = 1.01  # noise of a reading at the limit is no warning
IDLE_PHASES = ("by hand", "ready", "locked")  # words of the engine while no task is under way
HOT_SHARE = 0.9  # of the highest disc temperature: warn before the watchdog stops the rig


class Scene(StrEnum):
    """Which face the page shows."""

    NO_SESSION = "no session"
    STARTING = "starting"
    PROGRAM = "program"
    MANUAL = "manual"


class Action(StrEnum):
    """What a person may want to do here."""

    ENABLE = "enable"
    DISABLE = "disable"
    SPEED = "speed"
    PRESSURE = "pressure"
    RELEASE = "release"
    VENTILATOR = "ventilator"
    CONDITION = "condition"
    STOP_MOTOR = "stop motor"
    RECORD = "record"
    END = "end"
    RATE = "rate"
    RESET = "reset"
    TAKE_COMMAND = "take command"


MOVING = frozenset({Action.SPEED, Action.PRESSURE, Action.VENTILATOR, Action.CONDITION, Action.RECORD})


@dataclass(frozen=True)
class Permission:
    """Whether something may be done now; if not, why, in words for the tip."""

    allowed: bool
    reason: str = ""


@dataclass(frozen=True)
class Notice:
    """What stands above the controls. `look` is "", "warning" or "alarm"."""

    title: str
    text: str = ""
    look: str = ""


@dataclass(frozen=True)
class WatchdogLimits:
    """Where the watchdog would stop the rig."""

    speed_rpm: float
    pressure_bar: float
    torque_nm: float
    temperature_degc: float


class ManualModel:
    """The page's knowledge. Feed it by `show`, `session` and `limits`."""

    def __init__(self) -> None:
        self.state = RigState()
        self.rig: RigConfig | None = None
        self.limits: WatchdogLimits | None = None
        self._asked = False
        self._ordered_s: float | None = None
        self._preparing = self._seen_busy = False
        self._recording_since: float | None = None

    # -- news -------------------------------------------------------------------------------------

    def session(self, rig: RigConfig | None) -> None:
        """Another session, or none: the question before enabling is asked anew."""
        self.rig = rig
        self.limits = None
        self._asked = False
        self._ordered_s = self._recording_since = None
        self._preparing = False

    def show(self, state: RigState) -> None:
        """The newest state."""
        if state.recording and not self.state.recording:
            self._recording_since = state.rig_s
        elif not state.recording and self.state.recording:
            self._recording_since = self._ordered_s = None
        self._seen_busy = self._preparing and (self._seen_busy or state.phase not in IDLE_PHASES)
        if state.recording or (self._seen_busy and state.phase in IDLE_PHASES):
            self._preparing = False
        self.state = state

    def refused(self) -> None:
        """The controller has refused what was asked last."""
        self._preparing = False

    # -- what is shown ----------------------------------------------------------------------------

    @property
    def scene(self) -> Scene:
        """Which face the page shows."""
        state = self.state
        if state.word is Word.STARTING:
            return Scene.STARTING
        if self.abandoned:
            return Scene.MANUAL
        if state.mode == "program" and state.word is not Word.OFFLINE:
            return Scene.PROGRAM
        if state.mode == "manual" and state.word is not Word.OFFLINE:
            return Scene.MANUAL
        return Scene.NO_SESSION

    @property
    def abandoned(self) -> bool:
        """Tripped, and no controller is left: only a person's word is wanted, whatever ran before."""
        return self.state.word is Word.TRIPPED and not self.state.commander

    @property
    def live_energy(self) -> bool:
        """Motor or brake may move."""
        return self.state.enabled or self.state.relay_closed

    def notice(self) -> Notice:
        """What a person must know now, and what to do next."""
        state = self.state
        if state.word is Word.TRIPPED:
            cause = state.cause
            words = said(cause.words) if cause else translate("manual", "The watchdog has stopped the rig.")
            advice = said(cause.remedy) if cause else ""
            remedy = advice or translate("manual", "Find the cause, then reset.")
            return Notice(translate("manual", "Stopped by the watchdog: {0}").format(words), remedy, "alarm")
        if state.word is Word.STOPPING:
            return Notice(
                translate("manual", "Stopping"),
                translate("manual", "Pressure is released and the disc comes to rest. Wait."),
                "warning",
            )
        if not state.commanding:
            who = state.commander or translate("manual", "nobody")
            return Notice(
                translate("manual", "This window watches. {0} commands.").format(who),
                translate("manual", "Take command to move something from here; whoever had it is told."),
            )
        if not self.live_energy:
            return Notice(
                translate("manual", "Locked: nothing can move."),
                translate(
                    "manual", "Press Enable. The watchdog checks the rig at rest and closes the safety relay."
                ),
            )
        if state.recording:
            return Notice(
                translate("manual", "A braking is being recorded."),
                translate("manual", "Releasing the pressure breaks it off."),
            )
        return Notice(
            translate("manual", "Enabled: motor and brake may move."),
            translate("manual", "Type a set-point and press Enter to apply it."),
        )

    def enable_question(self) -> str:
        """What will move; asked before energy comes in."""
        if self.rig is None:
            return translate("manual", "Motor and brake may move. Is the door closed?")
        can = self.rig.capabilities
        return translate(
            "manual", "The motor may turn up to {0} and the brake apply up to {1}. Is the door closed?"
        ).format(quantity_text(can.max_speed_rpm, "1/min", 0), quantity_text(can.max_pressure_bar, "bar", 0))

    @property
    def must_ask(self) -> bool:
        """True until the question has been answered with yes in this session."""
        return not self._asked

    def answered_yes(self) -> None:
        """Not asked again in this session."""
        self._asked = True

    # -- what may be done -------------------------------------------------------------------------

    def may(self, action: Action) -> Permission:
        """Whether an action is possible now, and why not."""
        reason = next((words for holds, words in self._obstacles(action) if holds), "")
        return Permission(not reason, reason)

    def _obstacles(self, action: Action) -> list[tuple[bool, str]]:
        """Reasons against an action, the weightiest first, each with whether it holds."""
        state, word = self.state, self.state.word
        taking = action is Action.TAKE_COMMAND
        moves = action not in (Action.TAKE_COMMAND, Action.RESET, Action.RATE, Action.END)
        enabling = action is Action.ENABLE
        return [
            (self.scene is not Scene.MANUAL, translate("manual", "There is no manual session.")),
            (action is Action.END and self.abandoned, translate("manual", "No controller is left.")),
            (taking and self.abandoned, translate("manual", "No controller is left.")),
            (taking and state.commanding, translate("manual", "This window commands already.")),
            (
                not taking and not state.commanding and not (action is Action.RESET and self.abandoned),
                translate("manual", "This window only watches. Take command first."),
            ),
            (
                action is Action.RESET and word is not Word.TRIPPED,
                translate("manual", "Nothing is to be reset."),
            ),
            (
                moves and word is Word.TRIPPED,
                translate("manual", "The watchdog has stopped the rig. Reset first."),
            ),
            (moves and word is Word.STOPPING, translate("manual", "The rig is stopping. Wait.")),
            (
                enabling and self.live_energy,
                translate("manual", "Motor and brake are enabled already."),
            ),
            (
                moves and not enabling and not self.live_energy,
                translate("manual", "Nothing can move. Enable first."),
            ),
            (
                action is Action.RECORD and self._preparing,
                translate("manual", "A braking is being prepared."),
            ),
            (
                action in MOVING and state.recording,
                translate("manual", "A braking is being recorded. Wait, or release the pressure."),
            ),
        ]

    # -- indicators -------------------------------------------------------------------------------

    def scales(self) -> dict[str, BarScale]:
        """Scales of the four indicators; of a rig of common size while none is known."""
        can = None if self.rig is None else self.rig.capabilities
        limits = self.limits

        def scale(
            most: float, unit: str, decimals: int, alarm: float | None, warn: float | None = None,
            least: float = 0.0,
        ) -> BarScale:  # fmt: skip
            warn_from = None if can is None else (most * TOLERANCE if warn is None else warn)
            if alarm is not None and warn_from is not None:
                warn_from = min(warn_from, alarm)
            end = max(most * 1.1, 0.0 if alarm is None else alarm * 1.04)
            return BarScale(least, _round_up(end), unit, decimals, warn_from, alarm)

        hot = 600.0 if can is None else can.max_disc_temperature_degc
        return {
            "speed": scale(
                1000.0 if can is None else can.max_speed_rpm, "1/min", 1,
                None if limits is None else limits.speed_rpm,
                least=0.0 if can is None else can.min_speed_rpm * 1.1,
            ),
            "pressure": scale(
                50.0 if can is None else can.max_pressure_bar, "bar", 1,
                None if limits is None else limits.pressure_bar,
            ),
            "torque": scale(
                1000.0 if can is None else can.max_torque_nm, "N·m", 0,
                None if limits is None else limits.torque_nm,
            ),
            "temperature": scale(
                hot, "°C", 1, None if limits is None else limits.temperature_degc, warn=HOT_SHARE * hot
            ),
        }  # fmt: skip

    # -- recording --------------------------------------------------------------------------------

    def ordered(self, duration_s: float) -> None:
        """A recording of that duration has been asked for from this window."""
        self._ordered_s = duration_s
        self._preparing, self._seen_busy = True, False

    def recording_progress(self) -> tuple[float, float | None] | None:
        """(s since the recording began, s left or None when unknown); None while nothing is recorded."""
        if not self.state.recording or self._recording_since is None:
            return None
        gone_s = max(self.state.rig_s - self._recording_since, 0.0)
        left_s = self.state.recording_left_s
        if left_s is None and self._ordered_s is not None:
            left_s = max(self._ordered_s - gone_s, 0.0)
        return gone_s, left_s


def _round_up(value: float) -> float:
    """The next number with two leading figures: ends of scales are easy to read."""
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{math.ceil(value / step - 1e-9) * step:.6g}")

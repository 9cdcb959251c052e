"""Every reason for which the watchdog stops the rig or keeps it locked: id, words, remedy.

Job: one place for the plain words a person reads in the terminal, the journal and the report. Not its job:
when a cause holds (`rigctl.safety.checks`, `rigctl.safety.heartbeat`, `rigctl.safety.guard`).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final


@dataclass(frozen=True, slots=True)
class CauseText:
    """Words of one cause. `catalogue` is its number in the fault catalogue of the rig."""

    catalogue: str
    words: str
    remedy: str
    resettable: bool = True


@dataclass(frozen=True, slots=True)
class Cause:
    """One cause as it happened: which, with which values against which threshold."""

    id: str
    value: Any = None
    threshold: Any = None
    detail: str = ""

    @property
    def text(self) -> CauseText:
        """The words of this cause."""
        return CAUSES[self.id]

    @property
    def words(self) -> str:
        """One sentence with the values in it."""
        sentence = self.text.words
        if self.value is not None:
            sentence += f": {_plain(self.value)}"
            if self.threshold is not None:
                sentence += f" (limit {_plain(self.threshold)})"
        elif self.detail:
            sentence += f": {self.detail}"
        return sentence + "."

    def to_mapping(self) -> dict[str, Any]:
        """Plain mapping for the journal."""
        return {
            "cause": self.id,
            "catalogue": self.text.catalogue,
            "words": self.words,
            "remedy": self.text.remedy,
            "value": plain_json(self.value),
            "threshold": plain_json(self.threshold),
            "detail": self.detail,
        }


def _plain(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def plain_json(value: Any) -> Any:
    """A value that strict JSON can hold: non-finite numbers become words."""
    if isinstance(value, float) and value - value != 0.0:
        return str(value)
    return value


_SENSOR = "Look at the sensor, its cable and its supply; then reset with a reason."
_CONTROLLER = "Look at the controller's log; reset with a reason or resume the campaign."
_INSPECT = "Find out why before anything moves again; then reset with a reason."
_RESTART = "Start the watchdog anew."

CAUSES: Final[dict[str, CauseText]] = {
    # signals that cannot be believed
    "pressure_invalid": CauseText("S2", "brake pressure has no valid reading", _SENSOR),
    "speed_invalid": CauseText("S2", "speed has no valid reading", _SENSOR),
    "torque_invalid": CauseText("S2", "torque has no valid reading", _SENSOR),
    "temperature_invalid": CauseText("S2", "disc temperature has no valid reading", _SENSOR),
    "pressure_stale": CauseText("K-19", "brake pressure is not measured any more", _SENSOR),
    "speed_stale": CauseText("K-19", "speed is not measured any more", _SENSOR),
    "torque_stale": CauseText("K-19", "torque is not measured any more", _SENSOR),
    "temperature_stale": CauseText("K-19", "disc temperature is not measured any more", _SENSOR),
    "pressure_frozen": CauseText("K-18", "brake pressure has been the same number for too long", _SENSOR),
    "speed_frozen": CauseText("K-18", "speed has been the same number for too long", _SENSOR),
    "torque_frozen": CauseText("K-18", "torque has been the same number for too long", _SENSOR),
    "temperature_frozen": CauseText(
        "K-18", "disc temperature has been the same number for too long", _SENSOR
    ),
    "samples_gap": CauseText("K-19", "blocks of the safety channel are missing or repeated", _SENSOR),
    "samples_clock": CauseText("K-19", "the safety channel's clock does not fit its blocks", _SENSOR),
    # absolute limits
    "pressure_peak": CauseText("K-11", "brake pressure in bar is far too high", _INSPECT),
    "pressure_range": CauseText("K-11", "brake pressure in bar is out of its range", _INSPECT),
    "speed_range": CauseText("K-07", "speed in 1/min is out of its range", _INSPECT),
    "torque_range": CauseText("S2", "torque in N·m is out of its range", _INSPECT),
    "temperature_range": CauseText(
        "K-16", "disc temperature in °C is out of its range", "Let the disc cool; then reset."
    ),
    "temperature_approach": CauseText(
        "K-14", "disc temperature in °C would pass its limit before a stop", "Let the disc cool; then reset."
    ),
    "power_peak": CauseText("K-21", "friction power in kW is far too high", _INSPECT),
    "power_range": CauseText("K-21", "friction power in kW is too high", _INSPECT),
    # safety relay and hard-wired chain
    "relay_welded": CauseText(
        "K-20", "the safety relay reads closed though it was told to open",
        "Switch the drive off at its main switch. The relay or its read-back is defective.", False,
    ),
    "relay_not_closed": CauseText(
        "K-20", "the safety relay reads open though it was told to close",
        "Look at emergency stop, doors, the relay and its read-back; then reset.",
    ),
    "drive_enabled": CauseText(
        "K-20", "the drive says it is enabled while the safety relay is open",
        "Switch the drive off at its main switch. Its torque-off input does not work.",
    ),
    "safety_channel": CauseText("C1", "the safety channel is at fault", _INSPECT),
    "estop": CauseText("S13", "the emergency stop is pressed", "Release it at the rig; then reset."),
    "doors": CauseText("S13", "a door is open", "Close it; then reset."),
    # controller
    "heartbeat_wrong": CauseText("K-25", "the controller's heartbeat is wrong", _CONTROLLER),
    "heartbeat_late": CauseText("K-25", "the controller's heartbeat does not come", _CONTROLLER),
    "setpoint": CauseText("K-24", "the controller commands a set-point that is not allowed", _CONTROLLER),
    "controller_gone": CauseText("P1", "the controller has gone", _CONTROLLER),
    "controller_deaf": CauseText("P2", "the controller does not read the watchdog's status", _CONTROLLER),
    # the watchdog itself
    "samples_late": CauseText("K-19", "the safety channel is silent", _SENSOR),
    "rig_gone": CauseText("C3", "the link to the rig's safety channel is closed", _INSPECT),
    "rig_garbage": CauseText("C13", "the safety channel sends what cannot be read", _SENSOR),
    "limits_changed": CauseText("rule 8", "the limits in memory have changed", _RESTART, False),
    "cycle_incomplete": CauseText("rule 2", "a cycle of the watchdog was not complete", _RESTART, False),
    "watchdog_error": CauseText("rule 1", "the watchdog has failed", _RESTART, False),
    "journal_failed": CauseText(
        "rule 13", "the journal cannot be written", "Make room on the disk; start the watchdog anew.", False
    ),
    "terminated": CauseText("P5", "the watchdog was told to end while the rig was armed", _CONTROLLER),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Obstacle:
    """Why the rig stays locked. `waiting` obstacles pass by themselves; others need somebody to act."""

    id: str
    words: str
    remedy: str
    waiting: bool = False
    values: dict[str, Any] = field(default_factory=dict[str, Any])

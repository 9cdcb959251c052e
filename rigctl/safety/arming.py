"""What stands between "locked" and "armed", and between "tripped" and "locked".

Job: name the first obstacle, in words with a remedy. Pure functions of facts. Not its job: the change of
state (`rigctl.safety.latch`), the proof by read-back after the relay has closed (`rigctl.safety.guard`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from rigctl.safety.causes import Cause, Obstacle
from rigctl.safety.checks import Verdict
from rigctl.safety.heartbeat import HeartbeatMonitor
from rigctl.safety.limits import Limits
from rigctl.safety.observe import View


@dataclass(frozen=True, slots=True)
class Facts:
    """What arming and reset depend on.

    Attributes
    ----------
    good_samples : int
        Blocks in a row without a verdict and with the relay read open.
    rest_s : float
        For how long, in rig time, pressure and speed have been below the bounds of `ResetLimits`.
    unacknowledged : str
        Words of an earlier trip in the journal that nobody has acknowledged; empty if there is none.
    journal_failure : str
        Why the journal cannot be written; empty if it can.
    """

    view: View
    verdicts: Sequence[Verdict]
    monitor: HeartbeatMonitor
    good_samples: int
    rest_s: float
    unacknowledged: str
    journal_failure: str


def arming_obstacles(
    facts: Facts, limits: Limits, file_unchanged: Callable[[], bool], failed_checks: Callable[[], list[str]]
) -> Iterator[Obstacle]:
    """What forbids closing the relay, first things first; nothing when it may close.

    `file_unchanged` and `failed_checks` take time; they are asked only when nothing else stands in the way.
    """
    if facts.journal_failure:
        yield _journal_obstacle(facts.journal_failure)
    if facts.unacknowledged:
        yield Obstacle(
            "unacknowledged",
            f"An earlier trip has not been acknowledged: {facts.unacknowledged}",
            "Acknowledge it with your name and a reason.",
        )
    if facts.verdicts:
        yield _obstacle_of(facts.verdicts[0].cause)
    monitor = facts.monitor
    if monitor.fault is not None:
        yield _obstacle_of(monitor.fault)
    if facts.good_samples < limits.arming.samples or monitor.good_in_a_row < limits.arming.heartbeats:
        yield Obstacle(
            "few_samples",
            f"Seen so far: {facts.good_samples} good samples of {limits.arming.samples}, "
            f"{monitor.good_in_a_row} good heartbeats of {limits.arming.heartbeats}.",
            "Wait.",
            waiting=True,
        )
    if not facts.view.at_rest(limits.rest.pressure_bar, limits.rest.speed_rpm):
        yield Obstacle(
            "not_at_rest", f"The rig is not at rest: {_state_of(facts.view)}.", "Wait.", waiting=True
        )
    if not monitor.standing_still:
        yield Obstacle(
            "setpoints", "The controller's set-points are not zero.", "Arm with pressure and speed at zero."
        )
    if not file_unchanged():
        yield Obstacle(
            "limits_file", "The limits file has been changed since the watchdog read it.",
            "Start the watchdog anew, so that it reads the new file.",
        )  # fmt: skip
    failed = failed_checks()
    if failed:
        yield Obstacle(
            "proof", f"The proof test failed for {', '.join(failed)}.", "Look at the limits of these checks."
        )


def reset_obstacles(
    facts: Facts, limits: Limits, cause: Cause, who: object, reason: object, *, exhausted: bool
) -> Iterator[Obstacle]:
    """What forbids acknowledging the trip, first things first; nothing when it may be reset."""
    for word, value in (("who", who), ("reason", reason)):
        if not (isinstance(value, str) and 0 < len(value.strip()) <= 200):
            yield Obstacle(word, f"The reset does not say {word}.", "Give your name and a reason in words.")
    if facts.journal_failure:
        yield _journal_obstacle(facts.journal_failure)
    if not cause.text.resettable:
        yield Obstacle("not_resettable", f"This trip cannot be reset: {cause.words}", cause.text.remedy)
    if exhausted:
        yield Obstacle(
            "too_often",
            f"The same cause has been reset {limits.reset.same_cause_per_hour} times within an hour.",
            "Find the cause; a further reset is possible an hour after the first.",
        )
    if facts.verdicts:
        yield _obstacle_of(facts.verdicts[0].cause)
    if facts.view.sample.relay_closed:
        yield Obstacle("relay", "The safety relay still reads closed.", "Look at the relay.")
    if facts.rest_s < limits.reset.standstill_s or not facts.view.at_rest(
        limits.reset.pressure_bar, limits.reset.speed_rpm
    ):
        yield Obstacle(
            "not_at_rest", f"The rig has not been at rest for {limits.reset.standstill_s:g} s: "
            f"{_state_of(facts.view)}.", "Wait.", waiting=True,
        )  # fmt: skip
    if facts.monitor.good_in_a_row < limits.arming.heartbeats:
        yield Obstacle(
            "heartbeats", f"The controller has given {facts.monitor.good_in_a_row} good heartbeats of "
            f"{limits.arming.heartbeats}.", "Wait, or look at the controller.", waiting=True,
        )  # fmt: skip


def _journal_obstacle(failure: str) -> Obstacle:
    return Obstacle("journal", f"The journal cannot be written: {failure}.", "Make room on the disk.")


def _obstacle_of(cause: Cause) -> Obstacle:
    return Obstacle(cause.id, cause.words, cause.text.remedy)


def _state_of(view: View) -> str:
    return f"{view.pressure.last:.2f} bar, {view.speed.last:.1f} 1/min"

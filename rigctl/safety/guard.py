"""The guard: one cycle per block, from samples and heartbeats to "renew the relay" or "open it".

Job: decide. Every cycle runs all checks, and the relay is renewed only at the end of a cycle in which all of
`KICK` came true. Knows no socket, file or clock: the time is an argument, what is to be written is handed out
as notes after the relay has been served. Not its job: carrying it out (`rigctl.safety.process`).
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, Final

from rigctl.core.safety_link import SafetySample
from rigctl.safety.arming import Facts, arming_obstacles, reset_obstacles
from rigctl.safety.causes import Cause, Obstacle, plain_json
from rigctl.safety.checks import CheckRunner, Verdict
from rigctl.safety.heartbeat import HeartbeatMonitor
from rigctl.safety.latch import Latch, ResetBook, State
from rigctl.safety.limits import Fingerprint, LoadedLimits, Windows
from rigctl.safety.observe import View
from rigctl.safety.proof import failed_checks

ACCEPTED_LAG: Final = 4  # nonces by which the controller may be behind in real time
TAPE_BLOCKS: Final = 40  # 2 s of the shortest blocks
WATCHING_EVERY_S: Final = 300.0  # rig time between records that say all is well

# What must have come true in a cycle before its end may renew the relay.
CHECKS_RAN: Final = 1
INPUTS_GOOD: Final = 2
LIMITS_INTACT: Final = 4
HEARTBEAT_CURRENT: Final = 8
JOURNAL_WELL: Final = 16
KICK: Final = CHECKS_RAN | INPUTS_GOOD | LIMITS_INTACT | HEARTBEAT_CURRENT | JOURNAL_WELL


class Answer(Enum):
    """The one answer to a sample."""

    EDGE = "edge"
    HOLD = "hold"
    CLOSE = "close"
    OPEN = "open"


@dataclass(frozen=True, slots=True)
class Note:
    """Something for the journal; `samples` are the last blocks before it."""

    kind: str
    rig_s: float | None
    payload: Mapping[str, Any]
    samples: tuple[SafetySample, ...] = field(default=())


NOTHING: Final[tuple[Note, ...]] = ()


class Guard:
    """Decisions of the watchdog.

    Parameters
    ----------
    loaded : LoadedLimits
    windows : Windows
        Wall-clock time-outs that hold in this run.
    lockstep : bool
        Virtual time: the heartbeat of block k−1 belongs to sample k. In real time the controller counts its
        blocks and the safety channel its samples by clocks of their own: a heartbeat is judged by its age,
        its own rising number and the nonce that it answers, one of the newest `ACCEPTED_LAG`.
    nonce : callable
        Gives an unpredictable 32-bit number.
    resets : ResetBook
    unacknowledged : Cause, optional
        Trip of an earlier watchdog that nobody has acknowledged.
    """

    def __init__(
        self,
        loaded: LoadedLimits,
        windows: Windows,
        *,
        lockstep: bool,
        nonce: Callable[[], int],
        resets: ResetBook,
        unacknowledged: Cause | None = None,
    ) -> None:
        self._loaded = loaded
        self._limits = loaded.limits
        self._windows = windows
        self._lockstep = lockstep
        self._nonce = nonce
        self._resets = resets
        self._unacknowledged = unacknowledged
        self._latch = Latch()
        self._runner = CheckRunner(loaded.limits)
        self._fingerprint = Fingerprint(loaded.limits)
        self.monitor = self._new_monitor()
        self._tape: deque[SafetySample] = deque(maxlen=TAPE_BLOCKS)
        self._view: View | None = None
        self._verdicts: list[Verdict] = []
        self._sample_at_s = self._heartbeat_at_s = 0.0
        self._samples_since_beat = 0
        self._good_samples = 0
        self._rest_since_s: float | None = None
        self._arm_after_k: int | None = None
        self._obstacle: Obstacle | None = None
        self._edges = 0
        self._journal_failure = ""
        self._setpoints: Any = None
        self._open_reason: str | None = None
        self._notes: list[Note] = []
        self._resets_refused = 0
        self._reset_refusal: tuple[int, str, str] = (0, "", "")
        self._last_refusal: tuple[str, str] | None = None
        self._trip_at: tuple[float, float] = (0.0, 0.0)  # rig time, clock
        self._watching_s = 0.0
        self.disarmed = False
        self.safe_state_reached = False

    # -- what the process asks ------------------------------------------------------------------

    @property
    def state(self) -> State:
        """State of the latch."""
        return self._latch.state

    @property
    def cause(self) -> Cause | None:
        """First cause of the trip."""
        return self._latch.cause

    @property
    def live(self) -> bool:
        """Whether the relay is to be closed."""
        return self._latch.relay_wanted

    @property
    def last_k(self) -> int:
        """Number of the newest sample; -1 before the first."""
        return -1 if self._view is None else self._view.sample.k

    def status(self, k: int) -> dict[str, Any]:
        """Status message for block `k`, with a new nonce."""
        nonce = self._nonce()
        self.monitor.issued(nonce)
        words = remedy = None
        cause = self._latch.cause or self._unacknowledged
        if cause is not None:
            words, remedy = cause.words, cause.text.remedy
        elif self._obstacle is not None:
            words, remedy = self._obstacle.words, self._obstacle.remedy
        return {
            "m": "status", "k": k, "state": self._latch.state.told, "nonce": nonce,
            "cause": words, "remedy": remedy, "reset_refused": self._reset_refusal,
        }  # fmt: skip

    def take_open(self) -> str | None:
        """Reason for opening the relay now, once; None when nothing is to be opened."""
        reason, self._open_reason = self._open_reason, None
        return reason

    def take_notes(self) -> Sequence[Note]:
        """What is to be journaled. To be asked for after the relay has been served."""
        if not self._notes:
            return NOTHING
        notes, self._notes = self._notes, []
        return notes

    def silence_deadline_s(self) -> float | None:
        """Clock time at which silence becomes a fault; None while the relay is open."""
        if not self.live:
            return None
        return min(limit_s for _, limit_s in self._silence_limits())

    # -- what comes in --------------------------------------------------------------------------

    def controller_connected(self) -> None:
        """A controller has said hello; its heartbeats are judged from their beginning."""
        self.monitor = self._new_monitor()
        self.disarmed = False

    def on_heartbeat(self, message: Mapping[str, Any], now_s: float) -> None:
        """Judge one heartbeat; a wrong one trips while the relay is closed."""
        self._heartbeat_at_s = now_s
        self._samples_since_beat = 0
        self._setpoints = message.get("set")
        fault = self.monitor.judge(message)
        if fault is None and self._latch.state is State.ARMING and not self.monitor.standing_still:
            fault = Cause("setpoint", detail="motion is commanded before the watchdog is armed")
        if fault is not None and self.live:
            self.trip(fault, now_s)

    def on_sample_garbage(self, detail: str, now_s: float) -> None:
        """The safety channel delivered something that is no sample."""
        self._good_samples = 0
        cause = Cause("rig_garbage", detail=detail)
        if self.live:
            self.trip(cause, now_s)
        else:
            self._refuse("refused_sample", "unreadable", cause.words)

    def on_controller_garbage(self, detail: str, now_s: float) -> None:
        """The controller sent something that is no known message."""
        fault = Cause("heartbeat_wrong", detail=detail)
        self.monitor.good_in_a_row = 0
        if self.live:
            self.trip(fault, now_s)
        else:
            self._refuse("refused_message", "unreadable", fault.words)

    def request_arm(self) -> None:
        """Arm as soon as nothing forbids it; decided with the samples after the next heartbeat."""
        if self._latch.state is not State.LOCKED:
            self._refuse("refused_arm", self.state.value, f"The state is {self.state.value}, not locked.")
            return
        self._arm_after_k = self.monitor.last_k

    def disarm(self) -> None:
        """Normal end: open the relay if the rig is at rest, else refuse and go on watching."""
        self._cancel_arming()
        if self._latch.state is State.TRIPPED:
            self._refuse("refused_disarm", "tripped", "The rig has tripped.")
        elif self._latch.state is State.LOCKED:
            self.disarmed = True
        elif self._view is not None and self._view.at_rest(
            self._limits.rest.pressure_bar, self._limits.rest.speed_rpm
        ):
            self._latch.open()
            self._open_reason = "disarmed"
            self.disarmed = True
            self._good_samples = 0
            self._note("disarmed", **self._readings())
        else:
            self._refuse("refused_disarm", "not_at_rest", "The rig is not at rest.")

    def reset(self, who: object, reason: object, now_s: float) -> None:
        """A person acknowledges the trip. Leads to locked, never to motion."""
        cause = self._latch.cause or self._unacknowledged
        if cause is None or self._view is None:
            self._refuse(
                "refused_reset", "nothing", "There is no trip to reset, or no sample has been seen yet."
            )
            return
        obstacles = reset_obstacles(
            self._facts(self._view), self._limits, cause, who, reason,
            exhausted=self._resets.exhausted(cause.id, now_s),
        )  # fmt: skip
        if (obstacle := next(obstacles, None)) is not None:
            self._refuse("refused_reset", obstacle.id, obstacle.words, remedy=obstacle.remedy)
            self._resets_refused += 1
            self._reset_refusal = (self._resets_refused, obstacle.words, obstacle.remedy)
            return
        if self._latch.state is State.TRIPPED:
            self._latch.reset()
        self._unacknowledged = None
        self._resets.add(cause.id, now_s)
        self._good_samples = 0
        self._cancel_arming()
        self._note("reset", who=who, reason=reason, cause=cause.id, **self._readings())

    def controller_gone(self, how: str, now_s: float) -> None:
        """Its link is closed or its process has ended."""
        self._cancel_arming()
        if self.live:
            self.trip(Cause("controller_gone", detail=how), now_s)

    def journal_failed(self, why: str, now_s: float) -> None:
        """Nothing can be written any more: no motion without a journal."""
        self._journal_failure = why
        if self.live:
            self.trip(Cause("journal_failed", detail=why), now_s)

    def on_silence(self, now_s: float) -> None:
        """Nothing has come; trip if that has lasted too long."""
        if self.live:
            for cause_id, limit_s in self._silence_limits():
                if now_s >= limit_s:
                    beat = cause_id == "heartbeat_late" and not self._lockstep
                    last_k = self.monitor.last_k if beat else self.last_k
                    self.trip(Cause(cause_id, detail=f"last block {last_k}"), now_s)

    def trip(self, cause: Cause, now_s: float) -> None:
        """Open the relay and stay tripped. The first cause is kept, further ones are noted."""
        before = self._latch.state
        if not self._latch.trip(cause):
            return
        if before is State.TRIPPED:
            self._note("further_cause", **cause.to_mapping())
            return
        self._open_reason = cause.words
        self._cancel_arming()
        rig_s = self._view.sample.t_s if self._view is not None else 0.0
        self._trip_at = (rig_s, now_s)
        self.safe_state_reached = False
        self.disarmed = False
        self.monitor.good_in_a_row = 0
        self._last_refusal = None
        payload = {
            **cause.to_mapping(), "state_before": before.value,
            "stop_category": self._limits.stop_category[cause.id], "k": self.last_k,
            "heartbeat_k": self.monitor.last_k, "heartbeat_age_s": round(now_s - self._heartbeat_at_s, 4),
            "setpoints": repr(self._setpoints), **self._readings(),
        }  # fmt: skip
        self._notes.append(Note("trip", rig_s, payload, tuple(self._tape)))

    # -- the cycle ------------------------------------------------------------------------------

    def on_sample(self, sample: SafetySample, now_s: float) -> Answer:
        """One cycle. The answer belongs to this sample; with OPEN, `take_open` gives the reason."""
        before = self._view
        gap_s = now_s - self._sample_at_s
        view = self._view = View(sample, before, self._latch.relay_wanted)
        self._sample_at_s = now_s
        self._samples_since_beat += 1
        self._tape.append(sample)
        verdicts = self._verdicts = self._runner.run(view, before)
        passed = JOURNAL_WELL if not self._journal_failure else 0
        if self._runner.ran == self._runner.expected:
            passed |= CHECKS_RAN
        if not verdicts:
            passed |= INPUTS_GOOD
        else:
            for verdict in verdicts:
                # Locked, a limit that fails because nothing is measured keeps the rig locked and is no trip.
                measured = verdict.cause.value is None or view.all_valid
                if self.live or (verdict.check.always and measured):
                    self.trip(verdict.cause, now_s)
        if self._fingerprint.intact():
            passed |= LIMITS_INTACT
        else:
            self.trip(Cause("limits_changed"), now_s)
        if self._heartbeat_is_current(sample.k, now_s):
            passed |= HEARTBEAT_CURRENT
        elif self.live:
            self.trip(Cause("heartbeat_late", detail=self._lateness(sample.k, now_s)), now_s)
        if not self._lockstep and self.live and gap_s > self._windows.sample_s:
            # This process itself was stopped or starved: what it has missed cannot be made up for.
            self.trip(Cause("samples_late", detail=f"{gap_s:.3f} s before sample {sample.k}"), now_s)
        self._watch_rest(view)
        return self._conclude(view, passed, now_s)

    def _conclude(self, view: View, passed: int, now_s: float) -> Answer:
        state = self._latch.state
        if state is State.LOCKED:
            return Answer.CLOSE if self._arming_granted(view) else Answer.HOLD
        if state is not State.TRIPPED and passed != KICK:
            self.trip(Cause("cycle_incomplete", detail=f"{passed:05b} of {KICK:05b}"), now_s)
            state = self._latch.state
        if state is State.TRIPPED:
            self._watch_for_safe_state(view, now_s)
            return Answer.HOLD if self._open_reason is None else Answer.OPEN
        if state is State.ARMING:
            self._prove_relay(view)
        elif view.sample.t_s - self._watching_s >= WATCHING_EVERY_S:
            self._watching_s = view.sample.t_s
            self._note("watching", k=view.sample.k, heartbeats=self.monitor.seen)
        return Answer.EDGE

    def _heartbeat_is_current(self, k: int, now_s: float) -> bool:
        if self._lockstep:
            return k - 1 <= self.monitor.last_k <= k
        # By the clock, and by the samples since: no clock is trusted alone.
        recent = self.monitor.seen > 0 and self._samples_since_beat <= ACCEPTED_LAG
        return recent and now_s - self._heartbeat_at_s <= self._windows.heartbeat_s

    def _lateness(self, k: int, now_s: float) -> str:
        if self._lockstep:
            return f"block {k - 1}"
        return f"{now_s - self._heartbeat_at_s:.3f} s since block {self.monitor.last_k} of the controller"

    def _silence_limits(self) -> list[tuple[str, float]]:
        """(cause, clock time at which it holds)."""
        windows = self._windows
        if not self._lockstep:
            return [
                ("heartbeat_late", self._heartbeat_at_s + windows.heartbeat_s),
                ("samples_late", self._sample_at_s + windows.sample_s),
            ]
        if self.monitor.last_k < self.last_k:
            return [("heartbeat_late", self._sample_at_s + windows.heartbeat_s)]
        return [("samples_late", max(self._sample_at_s, self._heartbeat_at_s) + windows.sample_s)]

    def _watch_rest(self, view: View) -> None:
        bounds = self._limits.reset
        if not view.at_rest(bounds.pressure_bar, bounds.speed_rpm):
            self._rest_since_s = None
        elif self._rest_since_s is None:
            self._rest_since_s = view.sample.t_s
        if self._verdicts or view.sample.relay_closed:
            self._good_samples = 0
        else:
            self._good_samples += 1

    def _watch_for_safe_state(self, view: View, now_s: float) -> None:
        rest = self._limits.rest
        if self.safe_state_reached or view.sample.relay_closed:
            return
        if view.at_rest(rest.pressure_bar, rest.speed_rpm):
            self.safe_state_reached = True
            rig_s, clock_s = self._trip_at
            self._note(
                "safe_state_reached", **self._readings(),
                after_rig_s=round(view.sample.t_s - rig_s, 3), after_wall_s=round(now_s - clock_s, 4),
            )  # fmt: skip

    # -- arming ---------------------------------------------------------------------------------

    def _arming_granted(self, view: View) -> bool:
        if self._arm_after_k is None or self.monitor.last_k <= self._arm_after_k:
            return False
        obstacles = arming_obstacles(
            self._facts(view), self._limits, self._loaded.file_unchanged, lambda: failed_checks(self._limits)
        )
        obstacle = next(obstacles, None)
        if obstacle is None:
            self._cancel_arming()
            self._latch.close()
            self._edges = 0
            self._note("relay_closed", k=view.sample.k, proof="passed")
            return True
        if not obstacle.waiting:
            self._arm_after_k = None
            self._refuse("refused_arm", obstacle.id, obstacle.words, remedy=obstacle.remedy)
        self._obstacle = obstacle
        return False

    def _prove_relay(self, view: View) -> None:
        """Armed once the relay has been renewed and read closed for the whole number of edges."""
        if view.sample.relay_closed is True:
            self._edges += 1
        if self._edges >= self._limits.arming.edges:
            self._latch.confirm()
            self._last_refusal = None
            self._watching_s = view.sample.t_s
            self._note("armed", k=view.sample.k, limits=self._loaded.hash8, edges=self._edges)

    def _cancel_arming(self) -> None:
        self._arm_after_k = None
        self._obstacle = None

    # -- helpers --------------------------------------------------------------------------------

    def _new_monitor(self) -> HeartbeatMonitor:
        accepted = 2 if self._lockstep else ACCEPTED_LAG
        return HeartbeatMonitor(self._loaded.hash8, self._limits.setpoints, accepted)

    def _facts(self, view: View) -> Facts:
        since_s = self._rest_since_s
        return Facts(
            view=view,
            verdicts=self._verdicts,
            monitor=self.monitor,
            good_samples=self._good_samples,
            rest_s=0.0 if since_s is None else view.sample.t_s - since_s,
            unacknowledged=self._unacknowledged.words if self._unacknowledged is not None else "",
            journal_failure=self._journal_failure,
        )

    def _readings(self) -> dict[str, Any]:
        view = self._view
        if view is None:
            return {}
        return {
            "pressure_bar": plain_json(view.pressure.last),
            "speed_rpm": plain_json(view.speed.last),
            "torque_nm": plain_json(view.torque.last),
            "temperature_degc": plain_json(view.temperature.last),
            "relay_closed": view.sample.relay_closed,
            "drive_enabled": view.sample.drive_enabled,
        }

    def _refuse(self, kind: str, why: str, words: str, **payload: Any) -> None:
        """Note a refusal; the same one in a row is noted once, so that nobody can flood the journal."""
        if self._last_refusal != (kind, why):
            self._last_refusal = (kind, why)
            self._note(kind, why=why, words=words, **payload)

    def _note(self, kind: str, **payload: Any) -> None:
        rig_s = self._view.sample.t_s if self._view is not None else None
        self._notes.append(Note(kind, rig_s, payload))

"""The engine: executes a program on a rig, block by block.

Job: order of brakings, states and verbs (pause, hold, resume, skip, repeat, stop), the heartbeat of each
block, and the guaranteed release of pressure and speed on every way out. Not its job: how a braking is
made (`rigctl.engine.procedures`), limits (watchdog), files (recorder).
"""

from __future__ import annotations

import contextlib
import time
from collections import Counter
from collections.abc import Callable, Generator, Iterable, Sequence
from typing import Any, Protocol

from rigctl.core.blocks import Block
from rigctl.core.channels import DISC_TEMPERATURE, PRESSURE, SPEED, TORQUE
from rigctl.core.errors import RigctlError, RunError, SafetyTrip
from rigctl.core.journal import Journal
from rigctl.engine.commands import AcknowledgeAlarm, Ask, Note, Rate
from rigctl.engine.guard import Checkpoint, Guard
from rigctl.engine.procedures import Procedures, Recorder, Script, at_rest
from rigctl.engine.state import BreakOff, Outcome, Progress, RunResult, State, Verb
from rigctl.hal.rig import Rig
from sequences.braking import Braking

ARM_TIMEOUT_BLOCKS = 200
BLOCKS_BEFORE_RESET = 60  # the watchdog wants to see the rig at rest first
MAX_FAILURES_IN_A_ROW = 3
SAFE_STATE_TIMEOUT_S = 60.0
PAUSE_SLEEP_S = 0.02
REPORT_EVERY_S = 0.1  # wall clock
ALL_CHECKPOINTS = (
    Checkpoint.BLOCK_RECEIVED
    | Checkpoint.ENGINE_STEPPED
    | Checkpoint.RECORDER_TOLD
    | (Checkpoint.SETPOINTS_MADE)
)


class RecorderProcess(Recorder, Protocol):
    """What the engine needs of the recorder beyond what a braking needs."""

    def poll(self) -> Sequence[dict[str, Any]]:
        """What the recorder has acknowledged or complained about since the last call."""
        ...

    def wait_idle(self, timeout_s: float = 60.0) -> None:
        """Wait until every braking that has ended is in its file; raises `RecordingError` if it hangs."""
        ...


class Engine:
    """Runs brakings on a rig.

    Parameters
    ----------
    rig : Rig
        Opened.
    guard : Guard
        Connected to the watchdog; the engine arms and disarms it.
    recorder : RecorderProcess
        Connected to the recorder process.
    journal : Journal
        Of the controller.
    brakings : iterable of Braking
        In the order of the program; those that are complete already are left out by the caller.
    verbs : callable
        Asked once per block: the verb that a person has given since, or None.
    report : callable
        Called with the progress, at most every `REPORT_EVERY_S`.
    acknowledgement : (who, reason), optional
        A person's acknowledgement of the trip that ended an earlier run.
    asks : callable
        Asked once per block: what people have asked for since, beyond verbs.
    watch : callable
        Called with every block, for people who look at the signals.
    """

    mode = "program"

    def __init__(
        self,
        rig: Rig,
        guard: Guard,
        recorder: RecorderProcess,
        journal: Journal,
        brakings: Iterable[Braking],
        *,
        total: int,
        done: int = 0,
        verbs: Callable[[], Verb | None],
        report: Callable[[Progress], None],
        acknowledgement: tuple[str, str] | None = None,
        asks: Callable[[], Sequence[Ask]] = tuple,
        watch: Callable[[Block], None] | None = None,
    ) -> None:
        self._rig = rig
        self._guard = guard
        self._recorder = recorder
        self._journal = journal
        self._brakings = list(brakings)
        self._verbs = verbs
        self._report = report
        self._acknowledgement = acknowledgement
        self._asks = asks
        self._watch = watch
        self.progress = Progress(total=total, done=done, mode=self.mode)
        self._procedures = Procedures(rig, recorder, self.progress)
        self._breakable = False  # a braking is under way that a verb may break off
        self._hold = False
        self._skip = False
        self._stop = False
        self._armed = False
        self._listening = True
        self._incomplete: set[int] = set()
        self._broken: Counter[int] = Counter()  # recordings ended as incomplete, until they are committed
        self._failures = 0
        self._rig_s = 0.0
        self._report_at = 0.0
        self._owed_k: int | None = None  # block whose heartbeat has not been sent

    def run(self) -> RunResult:
        """Carry out the brakings and return how it ended; the rig is at rest or in the safe state then."""
        try:
            self._carry_out()
            self._recorder.wait_idle()
            self._listen_to_recorder()
            outcome, cause, remedy = Outcome.FINISHED, "", ""
            if self._stop:
                outcome, cause = Outcome.STOPPED, "stopped by the operator"
        except SafetyTrip as trip:
            self._enter(State.FAULTED, trip.problem)
            self._break_recording(f"safety trip: {trip.problem}")
            self._wait_for_rest()
            # The relay may have been seen open before the watchdog said why: its words are the first cause.
            words, advice = self._guard.cause, self._guard.remedy
            outcome, cause, remedy = Outcome.TRIPPED, words or trip.problem, advice or trip.remedy
        except RigctlError as error:
            self._enter(State.FAULTED, str(error))
            self._break_recording(str(error))
            self._leave_safely()
            outcome, cause, remedy = Outcome.FAILED, str(error), error.remedy
        except BaseException as error:
            self._break_recording(f"internal error: {error!r}")
            self._leave_safely()
            raise
        finally:
            self._rig.make_safe()
        if self.progress.state in (State.RUNNING, State.STOPPING):
            self._enter(State.IDLE, outcome.value)
        return RunResult(
            outcome,
            self.progress.done,
            self.progress.total,
            sorted(self._incomplete),
            self._rig_s,
            cause,
            remedy,
        )

    # -- the loop -------------------------------------------------------------------------------

    def _carry_out(self) -> None:
        self._drive(self._script())

    def _drive(self, script: Script) -> None:
        """One turn per block: status of the watchdog, verbs, script, recorder, heartbeat."""
        next(script)
        self._catch_up()
        for block in self._rig.blocks():
            self._rig_s = block.end_s
            self._owed_k = block.k
            self._guard.passed(Checkpoint.BLOCK_RECEIVED)
            self._guard.update(block.k)
            self._require_relay()
            running = self._turn(script, block)
            self._guard.passed(Checkpoint.ENGINE_STEPPED | Checkpoint.SETPOINTS_MADE)
            self._listen_to_recorder()
            self._guard.passed(Checkpoint.RECORDER_TOLD)
            self._guard.heartbeat(block.k, self._commanded())
            self._owed_k = None
            self._tell(block)
            if self._watch is not None:
                self._watch(block)
            if not running:
                return

    def _require_relay(self) -> None:
        """The relay has opened without a word of the watchdog: it is frozen, or somebody pressed a button."""
        if self._armed and not self._rig.safety.status().relay_closed:
            raise SafetyTrip(
                "the safety relay has opened.",
                place="safety chain",
                remedy="Look at emergency stop, doors and logs/watchdog.log.",
            )

    def _catch_up(self) -> None:
        """After a fault in the middle of a block: the loop goes on, and owes the watchdog that heartbeat."""
        if self._owed_k is not None:
            self._guard.passed(ALL_CHECKPOINTS)
            self._guard.heartbeat(self._owed_k, self._commanded())
            self._owed_k = None

    def _turn(self, script: Script, block: Block) -> bool:
        for ask in self._asks():
            self._answer(ask)
        verb = self._verbs()
        try:
            if verb is not None and self._obey(verb):
                script.throw(BreakOff(verb, f"{verb.value} by the operator"))
            else:
                script.send(block)
        except StopIteration:
            return False
        return True

    def _answer(self, ask: Ask) -> None:
        """What people may ask during any run: notes. Everything else belongs to a manual session."""
        command = ask.command
        if isinstance(command, Note | Rate):
            self._note(command, ask.who)
            ask.done()
        elif isinstance(command, AcknowledgeAlarm):
            self._journal.write("alarm_acknowledged", rig_s=self._rig_s, alarm=command.alarm, who=ask.who)
            ask.done()
        else:
            ask.refuse("a program is running.", "Set-points by hand belong to a manual session.")

    def _note(self, command: Note | Rate, who: str) -> None:
        """Journal it; while a braking is recorded it is stored in its file, too."""
        braking = self.progress.braking
        kind = "operator_note" if isinstance(command, Note) else "operator_rating"
        values: dict[str, Any] = (
            {"text": command.text} if isinstance(command, Note) else {"rating": command.rating}
        )
        self._journal.write(kind, rig_s=self._rig_s, index=braking, who=who, **values)
        if self._procedures.recording:
            self._recorder.mark(kind, self._rig_s, **values)

    def _obey(self, verb: Verb) -> bool:
        """True when the verb breaks off what is running now."""
        self._journal.write("verb", rig_s=self._rig_s, verb=verb.value, braking=self.progress.braking)
        paused = self.progress.state is State.PAUSED
        if verb in (Verb.STOP, Verb.END):
            self._stop = True
            return self._breakable or paused
        if verb is Verb.HOLD:
            self._hold = True
        elif paused:
            self._skip = verb is Verb.SKIP
            self._hold = verb not in (Verb.RESUME, Verb.SKIP, Verb.REPEAT)
        elif verb is Verb.RESUME:
            self._hold = False
        else:
            return self._breakable
        return False

    def _listen_to_recorder(self) -> None:
        if not self._listening:
            return
        for event in self._recorder.poll():
            kind = event.get("m")
            if kind == "committed":
                self._committed(event)
            elif kind == "failed":
                raise RunError(
                    f"the recorder could not keep braking {event.get('index')}: {event.get('error')}",
                    place="recorder",
                    remedy="Remove the cause, then run `rigctl resume`.",
                )

    def _committed(self, event: dict[str, Any]) -> None:
        """A braking is in its file for good; only now it counts."""
        index = int(event["index"])
        if event.get("status") == "complete":
            self.progress.done += 1
            self.progress.squealing += 1 if event.get("events") else 0
        elif self._broken[index]:  # broken off on purpose, and dealt with then
            self._broken[index] -= 1
        else:
            self._mark_incomplete(index, "parts of the recording are missing")

    def _commanded(self) -> dict[str, Any]:
        drive = self._rig.drive
        return {"p": self._rig.pressure.commanded_bar, "n": drive.commanded_rpm, "enable": drive.enabled}

    def _tell(self, block: Block) -> None:
        now = time.monotonic()
        if now < self._report_at:
            return
        self._report_at = now + REPORT_EVERY_S
        progress = self.progress
        progress.rig_s = block.end_s
        progress.safety = self._guard.state
        progress.speed_rpm = block.mean(SPEED)
        progress.pressure_bar = block.mean(PRESSURE)
        progress.torque_nm = block.mean(TORQUE)
        progress.temperature_degc = block.mean(DISC_TEMPERATURE)
        progress.set_speed_rpm = self._rig.drive.commanded_rpm
        progress.set_pressure_bar = self._rig.pressure.commanded_bar
        progress.ventilator_m3_h = self._procedures.ventilator_m3_h
        progress.enabled = self._rig.drive.enabled
        progress.relay = bool(block.status.get("relay", self._armed))
        progress.recording = self._procedures.recording
        progress.recording_left_s = max(self._procedures.recording_end_s - block.end_s, 0.0)
        progress.mu = self._rig.config.friction.mu(progress.torque_nm, progress.pressure_bar)
        self._report(progress)

    # -- the program ----------------------------------------------------------------------------

    def _script(self) -> Script:
        self._enter(State.RUNNING, "arming")
        yield from self._arm()
        try:
            for braking in self._brakings:
                if self._stop:
                    break
                yield from self._until_done(braking)
                if self._hold and not self._stop:
                    yield from self._pause("held after the braking")
        except BreakOff as stop:
            self._journal.write("stopping", rig_s=self._rig_s, reason=stop.reason)
        self._enter(State.STOPPING, "stop" if self._stop else "the program is done")
        yield from self._procedures.run_down()
        self._armed = False
        self._guard.disarm()
        yield

    def _arm(self) -> Script:
        """Let the watchdog see good blocks, then wait until it has closed the relay."""
        self.progress.phase = "arming"
        if self._acknowledgement is not None:
            for _ in range(BLOCKS_BEFORE_RESET):
                yield
            self._guard.reset(*self._acknowledgement)
        self._guard.arm()
        for _ in range(ARM_TIMEOUT_BLOCKS):
            block = yield
            if self._guard.state == "armed" and block.status.get("relay", True):
                self._rig.drive.enable()
                self._armed = True
                self._journal.write("armed", rig_s=block.end_s)
                return
        raise SafetyTrip(
            f"the watchdog does not arm. {self._guard.cause or ''}".rstrip(),
            place="watchdog",
            remedy=self._guard.remedy or "See the journal and logs/watchdog.log.",
        )

    def _until_done(self, braking: Braking) -> Script:
        """Try one braking until it is complete, skipped, given up, or the run is to stop."""
        again = True
        while again and not self._stop:
            try:
                self._breakable = True
                yield from self._one(braking)
                self._failures = 0
                return
            except BreakOff as broken:
                self._breakable = False
                again = yield from self._after_break_off(braking, broken)
            except RunError as error:
                self._breakable = False
                self._give_up(braking, error)
                yield from self._procedures.release()
                return
            finally:
                self._breakable = False

    def _after_break_off(self, braking: Braking, broken: BreakOff) -> Generator[None, Block, bool]:
        """Release; True when the braking is to be tried again."""
        self._break_recording(broken.reason)
        yield from self._procedures.release()
        if broken.verb in (Verb.STOP, Verb.END):
            raise broken
        if broken.verb is Verb.PAUSE:
            yield from self._pause(broken.reason)
            if not self._skip:
                return True
        if broken.verb is Verb.REPEAT:
            return True
        self._skip = False
        self._mark_incomplete(braking.index, broken.reason)
        if broken.verb is None:  # too hot
            yield from self._procedures.cool_down(
                braking.limits.cool_down_degc, braking.conditioning.timeout_s
            )
        return False

    def _give_up(self, braking: Braking, error: RunError) -> None:
        """Leave a braking that cannot be carried out; after several in a row the run is over."""
        self._break_recording(str(error))
        self._mark_incomplete(braking.index, str(error))
        self._failures += 1
        if self._failures >= MAX_FAILURES_IN_A_ROW:
            raise RunError(
                f"{self._failures} brakings in a row could not be carried out; the last: {error}",
                remedy="Remove the cause, then run `rigctl resume`.",
            ) from error

    def _one(self, braking: Braking) -> Script:
        self.progress.braking = braking.index
        self._journal.write(
            "braking_started",
            rig_s=self._rig_s,
            index=braking.index,
            sequence=braking.sequence,
            temperature_degc=braking.temperature_degc,
            pressure_bar=braking.pressure_bar,
        )
        procedures = self._procedures
        if braking.conditioning.enabled and braking.temperature_degc is not None:
            yield from procedures.condition(braking.temperature_degc, braking.conditioning)
        yield from procedures.spin_up(braking.speed_setpoint_rpm(0.0), ventilator=braking.ventilator)
        yield from procedures.brake(braking)
        yield from procedures.release()
        yield from procedures.dwell(braking.dwell_s)

    def _pause(self, why: str) -> Script:
        """Rig at rest but armed; blocks go on, and with them the watchdog's view."""
        self._enter(State.PAUSED, why)
        self._hold, self._skip = True, False
        self._rig.make_safe()
        self._rig.request(dt_s=self._rig.config.block_s, recording=False)
        self.progress.phase = "paused"
        while self._hold:
            if self._rig.context.time == "virtual":
                time.sleep(PAUSE_SLEEP_S)  # virtual time need not race on while a person thinks
            yield
        self._enter(State.RUNNING, "resumed")

    # -- ways out -------------------------------------------------------------------------------

    def _mark_incomplete(self, index: int, reason: str) -> None:
        self._incomplete.add(index)
        self.progress.incomplete = len(self._incomplete)
        self._journal.write("braking_broken_off", rig_s=self._rig_s, index=index, reason=reason)

    def _break_recording(self, reason: str) -> None:
        if self._procedures.recording:
            self._broken[self.progress.braking] += 1
            try:
                self._procedures.end_recording("incomplete", reason)
            except RigctlError as error:
                # The recorder is gone: it finalises by itself what it has, or `resume` recovers the spool.
                self._journal.write("recorder_lost", rig_s=self._rig_s, error=str(error))

    def _leave_safely(self) -> None:
        """After a fault of our own: run down with the devices that still answer, else let the relay drop."""
        self._listening = False
        try:
            self._drive(self._last_script())
        except (RigctlError, OSError) as error:
            self._journal.write("run_down_failed", rig_s=self._rig_s, error=str(error))

    def _last_script(self) -> Script:
        yield from self._procedures.run_down()
        if self._armed:
            self._armed = False
            self._guard.disarm()
        yield

    def _wait_for_rest(self) -> None:
        """The relay is open: take part in the blocks until pressure and speed are gone, for the record."""
        try:
            self._rig.make_safe()
            self._rig.request(dt_s=self._rig.config.block_s, recording=False)
            start_s = self._rig_s
            for block in self._rig.blocks():
                self._rig_s = block.end_s
                self._guard.passed(ALL_CHECKPOINTS)
                self._guard.listen(block.k)
                with contextlib.suppress(SafetyTrip):  # it may be the watchdog itself that has gone
                    self._guard.heartbeat(block.k, self._commanded())
                self._tell(block)
                if at_rest(block):
                    self._journal.write("at_rest_after_trip", rig_s=block.end_s)
                    return
                if block.end_s - start_s > SAFE_STATE_TIMEOUT_S:
                    self._journal.write("not_at_rest_after_trip", rig_s=block.end_s)
                    return
        except RigctlError as error:
            self._journal.write("rig_lost_after_trip", rig_s=self._rig_s, error=str(error))

    def _enter(self, state: State, why: str) -> None:
        self.progress.state = state
        self._journal.write("state", rig_s=self._rig_s, state=state.value, why=why)

"""The engine by hand: set-points, conditioning and single brakings as a person asks for them.

Job: the same loop, heartbeat and ways out as a program, driven by commands instead of a list of brakings.
Nothing moves before `Enable`; a trip does not end the session: it stays in the safe state until a person has
reset it, and is locked then. Energy without a hand is a lease, too: when nobody has commanded for
`UNATTENDED_S`, the rig runs down. Not its job: who may command (`rigctl.app.control_socket`), limits during
the run (watchdog).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from typing import Any

from rigctl.core.blocks import Block
from rigctl.core.errors import RunError, SafetyTrip
from rigctl.engine.commands import (
    Ask,
    Condition,
    Disable,
    Enable,
    Record,
    Reset,
    SetPressure,
    SetSpeed,
    SetVentilator,
)
from rigctl.engine.engine import ALL_CHECKPOINTS, Engine
from rigctl.engine.manual_checks import Movement, beyond_capabilities, program_of
from rigctl.engine.procedures import Script, at_rest
from rigctl.engine.state import BreakOff, State, Verb
from rigctl.hal.rig import Rig
from sequences.braking import Braking, Conditioning
from sequences.pressure import ConstantPressure

UNATTENDED_S = 30.0  # wall clock; energy is taken away when nobody has commanded for so long
IDLE_PACE = 0.9  # virtual time: share of a block's length that is slept while nothing is done


class ManualEngine(Engine):
    """A manual session on a rig; see `Engine` for the parameters they share.

    Parameters
    ----------
    first_index : int
        Number of the first braking; later than those that the campaign has already.
    attended : callable
        True while somebody commands; asked once per block.
    """

    mode = "manual"

    def __init__(
        self, rig: Rig, *args: Any, first_index: int = 1, attended: Callable[[], bool], **kwargs: Any
    ) -> None:
        super().__init__(rig, *args, **kwargs)
        self._next_index = first_index
        self._attended = attended
        self._attended_at = time.monotonic()
        self._task: Generator[None, Block, None] | None = None
        self._task_name = ""
        self._waiting: Ask | None = None  # an ask that is answered when its task has ended
        self._ending = False

    # -- the session ------------------------------------------------------------------------------

    def _carry_out(self) -> None:
        while not self._ending:
            try:
                self._drive(self._script())
            except SafetyTrip as trip:
                self._drop(f"safety trip: {trip.problem}")
                self._serve_trip(trip)

    def _script(self) -> Script:
        self._locked("manual session: locked")
        while not self._ending:
            block = yield
            self._look_after(block)
            if self._task is not None:
                self._advance(block)
            elif self._rig.context.time == "virtual":
                time.sleep(IDLE_PACE * block.dt_s)  # while a person thinks, virtual time keeps their pace
        self._drop("the session ends")
        self._enter(State.STOPPING, "the manual session ends")
        yield from self._run_down()

    def _turn(self, script: Script, block: Block) -> bool:
        verb = self._verbs()
        if verb is not None:
            self._journal.write("verb", rig_s=self._rig_s, verb=verb.value, braking=self.progress.braking)
            if verb is Verb.END:
                self._ending = True
            elif verb is Verb.STOP:
                self._begin("stopping", self._run_down(), why="stop by the operator")
        for ask in self._asks():
            self._answer_manual(ask, block)
        try:
            script.send(block)
        except StopIteration:
            return False
        return True

    def _look_after(self, block: Block) -> None:
        """Words for the state, and the lease of an absent person."""
        moving = not at_rest(block) or self._task is not None
        state = State.RUNNING if self._armed and moving else State.IDLE
        if state is not self.progress.state:
            self.progress.state = state
        if self._task is None:
            self.progress.phase = ("by hand" if moving else "ready") if self._armed else "locked"
        now = time.monotonic()
        if self._attended() or not self._armed or self._procedures.recording:
            self._attended_at = now
        elif now - self._attended_at > UNATTENDED_S and self._task_name != "stopping":
            self._journal.write("unattended", rig_s=self._rig_s, seconds=UNATTENDED_S)
            self._begin("stopping", self._run_down(), why="nobody commands")

    def _locked(self, why: str) -> None:
        self._enter(State.IDLE, why)
        self.progress.phase = "locked"
        self._rig.request(dt_s=self._rig.config.block_s, recording=True)

    def _run_down(self) -> Script:
        yield from self._procedures.run_down()
        if self._armed or self._guard.state == "armed":
            self._armed = False
            self._guard.disarm()
        self._rig.request(dt_s=self._rig.config.block_s, recording=True)
        yield

    # -- tasks ------------------------------------------------------------------------------------

    def _begin(self, name: str, task: Script, why: str) -> None:
        self._drop(why)
        self._task, self._task_name = task, name
        self.progress.phase = name
        next(task)

    def _advance(self, block: Block) -> None:
        assert self._task is not None
        try:
            self._task.send(block)
        except StopIteration:
            self._settle("")
        except BreakOff as broken:  # the disc became too hot
            self._break_recording(broken.reason)
            self._mark_incomplete(self.progress.braking, broken.reason)
            self._settle(broken.reason)
            self._begin("releasing", self._procedures.release(), why="")
        except RunError as error:
            self._break_recording(str(error))
            self._settle(error.problem, error.remedy)
            self._rig.pressure.set_pressure(0.0)
            self._journal.write("manual_failed", rig_s=self._rig_s, error=str(error))

    def _settle(self, reason: str, remedy: str = "") -> None:
        """The present task is over; whoever waits for it is told."""
        self._task, self._task_name = None, ""
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            waiting.answer(reason, remedy)
        self._rig.request(dt_s=self._rig.config.block_s, recording=True)

    def _drop(self, why: str) -> None:
        """End the present task where it is; a recording is kept as incomplete."""
        if self._task is None:
            return
        self._task.close()
        if self._procedures.recording:
            self._break_recording(why)
            self._mark_incomplete(self.progress.braking, why)
            self._rig.pressure.set_pressure(0.0)
        self._settle(why)

    # -- commands ---------------------------------------------------------------------------------

    def _answer_manual(self, ask: Ask, block: Block) -> None:
        command = ask.command
        if isinstance(command, Enable):
            self._enable(ask)
        elif isinstance(command, Disable):
            self._begin("stopping", self._run_down(), why="disabled by the operator")
            ask.done()
        elif isinstance(command, Reset):
            ask.refuse("nothing has tripped.")
        elif isinstance(command, Movement):
            self._move(ask, command, block)
        else:
            self._answer(ask)

    def _move(self, ask: Ask, command: Movement, block: Block) -> None:
        zero = (isinstance(command, SetPressure) and command.pressure_bar == 0.0) or (
            isinstance(command, SetSpeed) and command.speed_rpm == 0.0
        )
        problem = "" if zero else self._obstacle(command)
        if problem:
            reason, _, remedy = problem.partition("\n")
            ask.refuse(reason, remedy)
            return
        self._journal.write("manual", rig_s=self._rig_s, who=ask.who, **command.model_dump(mode="json"))
        if isinstance(command, SetVentilator):
            self._procedures.blow(command.flow_m3_h, block)
        elif isinstance(command, SetSpeed):
            self._drop("speed by hand")
            ramp = command.ramp_rpm_per_s or self._rig.config.capabilities.max_speed_rate_rpm_s
            self._rig.drive.set_speed(command.speed_rpm, ramp)
        elif isinstance(command, SetPressure):
            self._drop("pressure by hand")
            self._set_pressure(command)
        elif isinstance(command, Condition):
            self._begin("conditioning", self._condition(command), why="conditioning by hand")
        else:
            self._record(command)
        ask.done()

    def _obstacle(self, command: Movement) -> str:
        """Why a command cannot be obeyed now, and after a line break the remedy; empty when it can."""
        if self._procedures.recording:
            return "a braking is being recorded.\nRelease or stop it first."
        if isinstance(command, SetVentilator):
            return ""
        if not self._armed or not self._rig.drive.enabled:
            return "the rig is locked.\nEnable it first."
        if self._task_name == "stopping":
            return "the rig is running down.\nWait until it rests."
        return beyond_capabilities(command, self._rig)

    def _enable(self, ask: Ask) -> None:
        if self._armed:
            ask.done()
            return
        self._begin("arming", self._arm_or_tell(), why="enabled again")
        self._waiting = ask

    def _arm_or_tell(self) -> Script:
        """Arm; a watchdog that does not arm is no trip: nothing has moved."""
        try:
            yield from self._arm()
        except SafetyTrip as trip:
            if self._guard.state == "tripped":
                raise
            raise RunError(trip.problem, place="watchdog", remedy=trip.remedy) from trip

    def _set_pressure(self, command: SetPressure) -> None:
        if command.function is None or command.duration_s is None:
            self._rig.pressure.set_pressure(command.pressure_bar)
            return
        self._begin("pressure course", self._course(command, command.duration_s), why="")

    def _course(self, command: SetPressure, duration_s: float) -> Script:
        """Follow the pressure function, then release."""
        function = command.function or ConstantPressure()
        block = yield
        start_s = block.end_s
        while (t_s := block.end_s - start_s) < duration_s:
            middle_s = t_s + 0.5 * block.dt_s
            self._rig.pressure.set_pressure(function.pressure_bar(middle_s, command.pressure_bar, duration_s))
            block = yield
        yield from self._procedures.release()

    def _condition(self, command: Condition) -> Script:
        yield from self._procedures.condition(command.temperature_degc, Conditioning())

    # -- one recorded braking ---------------------------------------------------------------------

    def _record(self, command: Record) -> None:
        index = self._next_index
        self._next_index += 1
        braking = next(program_of(command, self._rig).brakings()).model_copy(
            update={"index": index, "ventilator": self._procedures.ventilator_m3_h > 0.0}
        )
        self._begin("braking", self._one_by_hand(braking, command.comment), why="")

    def _one_by_hand(self, braking: Braking, comment: str) -> Script:
        self.progress.braking = braking.index
        self.progress.total = max(self.progress.total, braking.index)
        self._journal.write(
            "braking_started",
            rig_s=self._rig_s,
            index=braking.index,
            sequence=braking.sequence,
            temperature_degc=None,
            pressure_bar=braking.pressure_bar,
        )
        yield from self._procedures.spin_up(braking.speed_setpoint_rpm(0.0), ventilator=braking.ventilator)
        yield from self._procedures.brake(braking, comment)
        yield from self._procedures.release()

    # -- after a trip -----------------------------------------------------------------------------

    def _serve_trip(self, trip: SafetyTrip) -> None:
        """Safe state with the loop alive, until a person has reset the trip.

        Raises
        ------
        SafetyTrip
            The session ends, or the watchdog itself has gone.
        """
        self._armed = False
        self._enter(State.FAULTED, trip.problem)
        self.progress.phase = "safe state"
        self._set_cause(trip.problem, trip.remedy)
        self._catch_up()
        self._rig.make_safe()
        self._rig.drive.disable()
        self._rig.request(dt_s=self._rig.config.block_s, recording=True)
        pending: Ask | None = None
        refused = self._guard.reset_refused[0]
        for block in self._rig.blocks():
            self._rig_s = block.end_s
            self._guard.passed(ALL_CHECKPOINTS)
            alive = self._guard.listen(block.k)
            if self._guard.state == "tripped" and self._guard.cause:
                self._set_cause(self._guard.cause, self._guard.remedy or trip.remedy)
            self._listen_to_recorder()
            if self._verbs() is Verb.END or not alive:
                self._ending = True
                raise SafetyTrip(self.progress.cause, place="watchdog", remedy=self.progress.remedy)
            if pending is not None and self._guard.reset_refused[0] > refused:
                pending.refuse(*self._guard.reset_refused[1:])
                pending = None
            refused = self._guard.reset_refused[0]
            pending = self._answer_tripped(pending)
            self._guard.heartbeat(block.k, self._commanded())
            self._tell(block)
            if self._watch is not None:
                self._watch(block)
            if self._guard.state == "locked" and pending is not None:
                pending.done()
                self._set_cause("", "")
                return
            if self._rig.context.time == "virtual":
                time.sleep(IDLE_PACE * block.dt_s)

    def _answer_tripped(self, pending: Ask | None) -> Ask | None:
        for ask in self._asks():
            if isinstance(ask.command, Reset):
                # The watchdog decides.
                self._guard.reset(ask.who, ask.command.reason)
                if pending is not None:
                    pending.refuse("asked for again.")
                pending = ask
            elif isinstance(ask.command, Enable | Disable | SetSpeed | SetPressure | Condition | Record):
                ask.refuse("the watchdog has tripped.", "Remove the cause, then reset.")
            else:
                self._answer(ask)
        return pending

    def _set_cause(self, words: str, remedy: str) -> None:
        self.progress.cause, self.progress.remedy = words, remedy

    def _leave_safely(self) -> None:
        self._ending = True
        super()._leave_safely()

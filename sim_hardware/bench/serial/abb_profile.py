"""The ABB drives communication profile: control word in, status word out, and the states between them.

Job: the state machine of the profile (switch-on inhibited, ready to switch on, ready to operate, operation
enabled, ramp stop, emergency stop, coast, tripped) and when torque is on. Not its job: registers and
parameters (`abb_drive`).

Bits after the ACH550 manual, page 21 (control word), and common ABB practice (status word); names are the
manuals'.
"""

from __future__ import annotations

import enum

# control word; "not" bits act when they are 0
OFF1, OFF2, OFF3, RUN = 1 << 0, 1 << 1, 1 << 2, 1 << 3
RAMP_OUT_ZERO, RAMP_HOLD, RAMP_IN_ZERO, RESET = 1 << 4, 1 << 5, 1 << 6, 1 << 7
REMOTE_CMD = 1 << 10

# status word
RDY_ON, RDY_RUN, RDY_REF, TRIPPED = 1 << 0, 1 << 1, 1 << 2, 1 << 3
OFF2_STA, OFF3_STA, SWC_ON_INHIB, ALARM = 1 << 4, 1 << 5, 1 << 6, 1 << 7
AT_SETPOINT, REMOTE, ABOVE_LIMIT = 1 << 8, 1 << 9, 1 << 10


class State(enum.Enum):
    """States of the profile's diagram."""

    SWITCH_ON_INHIBITED = "switch-on inhibited"
    READY_TO_SWITCH_ON = "ready to switch on"
    READY_TO_OPERATE = "ready to operate"
    OPERATION_ENABLED = "operation enabled"
    RAMP_STOP = "off1: ramp stop"
    EMERGENCY_STOP = "off3: emergency stop"
    TRIPPED = "tripped"


_TURNING = {State.OPERATION_ENABLED, State.RAMP_STOP, State.EMERGENCY_STOP}


class AbbProfile:
    """State machine of one drive.

    Attributes
    ----------
    state : State
    fault_code : int
        0 without a trip.
    alarm : bool
    """

    def __init__(self) -> None:
        self.state = State.SWITCH_ON_INHIBITED
        self.control = 0
        self.fault_code = 0
        self.alarm = False
        self.remote = True

    @property
    def torque_on(self) -> bool:
        """Whether the motor is supplied."""
        return self.state in _TURNING

    @property
    def stopping(self) -> bool:
        """Whether the ramp goes to zero whatever the reference."""
        return self.state in {State.RAMP_STOP, State.EMERGENCY_STOP}

    def write(self, control: int) -> None:
        """A new control word. Without REMOTE_CMD (or in local control) the last one stays in force."""
        if not control & REMOTE_CMD or not self.remote:
            return
        rising_reset = bool(control & RESET) and not self.control & RESET
        self.control = control
        if self.state is State.TRIPPED and rising_reset:
            self.fault_code = 0
            self.state = State.SWITCH_ON_INHIBITED

    def trip(self, code: int) -> None:
        """A fault: torque off, latched until a rising edge of RESET."""
        if self.state is not State.TRIPPED:
            self.fault_code = code
        self.state = State.TRIPPED

    def advance(self, *, standstill: bool, start_allowed: bool) -> None:
        """Move through the diagram.

        Parameters
        ----------
        standstill : bool
            The shaft stands: ends the stops by ramp.
        start_allowed : bool
            Safe torque off and start interlocks permit torque.
        """
        if self.state is State.TRIPPED:
            return
        control = self.control
        if not control & OFF2 or not start_allowed:  # coast
            self.state = State.SWITCH_ON_INHIBITED
            return
        if not control & OFF3:
            self.state = State.EMERGENCY_STOP if self.torque_on else State.SWITCH_ON_INHIBITED
        if self.stopping:
            self._stop(standstill)
        elif self.state is State.SWITCH_ON_INHIBITED:
            if not control & OFF1 and control & OFF3:
                self.state = State.READY_TO_SWITCH_ON
        elif self.state is State.OPERATION_ENABLED and not control & OFF1:
            self.state = State.RAMP_STOP
        elif not control & OFF1:
            self.state = State.READY_TO_SWITCH_ON
        else:
            self.state = State.OPERATION_ENABLED if control & RUN else State.READY_TO_OPERATE

    def _stop(self, standstill: bool) -> None:
        if not self.control & RUN:  # inhibit operation: coast
            self.state = State.SWITCH_ON_INHIBITED
        elif standstill:
            emergency = self.state is State.EMERGENCY_STOP
            self.state = State.SWITCH_ON_INHIBITED if emergency else State.READY_TO_SWITCH_ON
        elif self.state is State.RAMP_STOP and self.control & OFF1:
            self.state = State.OPERATION_ENABLED  # a ramp stop may be taken back, an emergency stop may not

    def status(self, *, at_setpoint: bool, above_limit: bool) -> int:
        """The status word."""
        state = self.state
        word = 0
        if state in {State.READY_TO_SWITCH_ON, State.READY_TO_OPERATE, *_TURNING}:
            word |= RDY_ON
        if state in {State.READY_TO_OPERATE, State.OPERATION_ENABLED}:
            word |= RDY_RUN
        if state is State.OPERATION_ENABLED:
            word |= RDY_REF
        if state is State.TRIPPED:
            word |= TRIPPED
        if self.control & OFF2:
            word |= OFF2_STA
        if self.control & OFF3 and state is not State.EMERGENCY_STOP:
            word |= OFF3_STA
        if state is State.SWITCH_ON_INHIBITED:
            word |= SWC_ON_INHIB
        if self.alarm:
            word |= ALARM
        if at_setpoint and state is State.OPERATION_ENABLED:
            word |= AT_SETPOINT
        if self.remote:
            word |= REMOTE
        if above_limit:
            word |= ABOVE_LIMIT
        return word

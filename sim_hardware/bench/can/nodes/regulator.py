"""Pressure regulator: state machine of CiA 408, set-point, target window, reaction to a lost heartbeat.

Job: turn control word and set-point into pressure commands of the rig, and report. Not its job: ramp and lag
of the pressure (the plant).
"""

from __future__ import annotations

import enum

from sim_hardware.bench.can import emergency
from sim_hardware.bench.can.datatypes import DataType
from sim_hardware.bench.can.dictionary import Access
from sim_hardware.bench.can.node import Device, NmtState
from sim_hardware.bench.can.scheduler import NS_PER_MS, Timer
from sim_hardware.bench.can.settings import RegulatorSettings
from sim_hardware.bench.signals import RigSignals

FULL_SCALE = 16384
CYCLE_MS = 10
INIT_CYCLES = 5
INVALID_ACTUAL = -32768
REACTION_HOLD, REACTION_VENT = 0, 1
SUPPLY_LOW = 0x3120
SENSOR_FAILED = 0xFF01

NOT_DISABLE, NOT_HOLD, MODE_ACTIVE, RESET_FAULT = 1, 2, 4, 8
READY, IN_WINDOW, VENTED, LIMITED = 1 << 3, 1 << 8, 1 << 9, 1 << 10


class State(enum.Enum):
    """State of the device; the value is what bits 0..3 of the status word say."""

    INIT = (0, "init")
    DISABLED = (READY, "disabled")
    HOLD = (READY | NOT_DISABLE, "hold")
    ACTIVE = (READY | NOT_DISABLE | NOT_HOLD | MODE_ACTIVE, "active")
    FAULT = (0, "fault")


class Regulator(Device):
    """See the manual, node 10h.

    Attributes
    ----------
    supply_low, sensor_failed : bool
        Faults of the device itself, set from outside (`disturb`).
    """

    device_type = 0x0008_0198
    name = "Bench pressure regulator"

    def __init__(self, settings: RegulatorSettings, signals: RigSignals, delay_ns: int) -> None:
        self._settings, self._signals, self._delay_ns = settings, signals, delay_ns
        self._per_bar = FULL_SCALE / settings.range_bar
        self.state = State.INIT
        self.supply_low = False
        self.sensor_failed = False
        self._lost = False
        self._cycle: Timer | None = None
        self._cycles = 0
        self._last_control = 0
        self._outside_ns = 0

    def define(self) -> None:
        add, i16, u16 = self.node.add, DataType.INTEGER16, DataType.UNSIGNED16
        threshold = round(self._settings.window_bar * self._per_bar)
        self._control = add(0x6040, 0, "device control word", u16, Access.RWW, mappable=True)
        self._status = add(0x6041, 0, "device status word", u16, Access.RO, mappable=True)
        add(0x604E, 0, "device error code", u16, Access.RO, getter=self._error_code, mappable=True)
        for index in (0x6300, 0x6301, 0x6310, 0x6314, 0x6320, 0x6321, 0x6350, 0x6370, 0x6371, 0x6372, 0x6373):
            self.node.dictionary.add_count(index, 1)
        self._set_point = add(0x6300, 1, "set-point", i16, Access.RWW, mappable=True)
        self._actual = add(0x6301, 1, "actual value", i16, Access.RO, mappable=True)
        self._demand = add(0x6310, 1, "demand value", i16, Access.RO, mappable=True)
        self._hold = add(0x6314, 1, "hold set-point", i16, Access.RW, low=0, high=FULL_SCALE)
        self._upper = add(0x6320, 1, "upper limit", i16, Access.RW, FULL_SCALE, low=0, high=FULL_SCALE)
        self._lower = add(0x6321, 1, "lower limit", i16, Access.RW, low=0, high=FULL_SCALE)
        self._deviation = add(0x6350, 1, "control deviation", i16, Access.RO, mappable=True)
        self._window = add(0x6370, 1, "target window", DataType.INTEGER8, Access.RW, 1, low=0, high=1)
        self._window_delay = add(
            0x6371,
            1,
            "target window delay, ms",
            u16,
            Access.RW,
            self._settings.window_delay_ms,
            low=50,
            high=1000,
        )
        self._window_upper = add(0x6372, 1, "window upper threshold", i16, Access.RW, threshold, low=0)
        self._window_lower = add(0x6373, 1, "window lower threshold", i16, Access.RW, -threshold, high=0)
        reaction = REACTION_VENT if self._settings.loss_reaction == "vent" else REACTION_HOLD
        self._reaction = add(
            0x2100,
            0,
            "reaction to heartbeat loss",
            DataType.UNSIGNED8,
            Access.RW,
            reaction,
            high=REACTION_VENT,
        )
        self.node.add_rpdo(((0x6040, 0, 16), (0x6300, 1, 16)))
        self._tpdo = self.node.add_tpdo(((0x6041, 0, 16), (0x6301, 1, 16)), self._settings.tpdo_ms)

    # -- calls of the node --------------------------------------------------------------------------

    def power_on(self) -> None:
        self._cycles = 0
        self._last_control = 0
        self._lost = False
        self._enter(State.INIT)
        if self._cycle is not None:
            self._cycle.cancel()
        self._cycle = self.node.scheduler.every(CYCLE_MS * NS_PER_MS, self._run)

    def power_off(self) -> None:
        if self._cycle is not None:
            self._cycle.cancel()
        self._enter(State.INIT)

    def nmt_changed(self, state: NmtState) -> None:
        if state is NmtState.STOPPED and self.state in (State.HOLD, State.ACTIVE):
            self._control.value = 0
            self._enter(State.DISABLED)

    def heartbeat_lost(self, node: int) -> None:
        if self._reaction.number() == REACTION_VENT:
            self._lost = True
            self._enter(State.FAULT)

    def heartbeat_back(self, node: int) -> None:
        self._lost = self.node.watched_silent and self._lost

    def refresh(self, due_ns: int) -> None:
        measured = self._measured(due_ns)
        self._actual.value = measured
        status = self.state.value[0]
        demand = self._demand.number()
        self._deviation.value = 0 if self.sensor_failed else max(-32768, min(32767, demand - measured))
        if self._in_window(due_ns):
            status |= IN_WINDOW
        if self.state in (State.INIT, State.DISABLED, State.FAULT):
            status |= VENTED
        if self.state is State.ACTIVE and demand != self._set_point.number():
            status |= LIMITED
        self._status.value = status

    # -- for tests and the command line -------------------------------------------------------------

    def disturb(self, *, supply_low: bool | None = None, sensor_failed: bool | None = None) -> None:
        """Make the device fail, or end the failure."""
        if supply_low is not None:
            self.supply_low = supply_low
            self._report(SUPPLY_LOW, emergency.PROFILE, supply_low)
        if sensor_failed is not None:
            self.sensor_failed = sensor_failed
            self._report(SENSOR_FAILED, emergency.MANUFACTURER, sensor_failed)
        if self.supply_low or self.sensor_failed:
            self._enter(State.FAULT)

    # -- state machine ------------------------------------------------------------------------------

    def _report(self, code: int, register: int, present: bool) -> None:
        if present:
            self.node.emergencies.came(code, register)
        else:
            self.node.emergencies.went(code)

    def _run(self, due_ns: int) -> None:
        """One cycle of the device: at most one transition, then the set-point to the valve."""
        self._cycles += 1
        control = self._control.number()
        reset = control & RESET_FAULT and not self._last_control & RESET_FAULT
        self._last_control = control
        wanted = self._wanted(control)
        state = self.state
        if self.supply_low or self.sensor_failed:
            self._enter(State.FAULT)
        elif state is State.INIT:
            if self._cycles >= INIT_CYCLES:
                self._enter(State.DISABLED)
        elif state is State.FAULT:
            if reset and not self._lost:
                self._enter(State.DISABLED)
        elif state is State.DISABLED and wanted is not State.DISABLED:
            self._enter(State.HOLD)
        elif state is not wanted:
            self._enter(wanted)
        else:
            self._actuate()
        self._watch_window(due_ns)

    @staticmethod
    def _wanted(control: int) -> State:
        if not control & NOT_DISABLE:
            return State.DISABLED
        return State.ACTIVE if control & NOT_HOLD and control & MODE_ACTIVE else State.HOLD

    def _enter(self, state: State) -> None:
        self.state = state
        self._actuate()

    def _actuate(self) -> None:
        """Valve position of the present state."""
        lower, upper = self._lower.number(), self._upper.number()
        vented = self.state not in (State.HOLD, State.ACTIVE)
        asked = self._set_point.number() if self.state is State.ACTIVE else self._hold.number()
        demand = 0 if vented else max(lower, min(upper, asked))
        self._demand.value = demand
        self._signals.set(pressure_set_bar=demand / self._per_bar, vent=vented)

    def _measured(self, due_ns: int) -> int:
        if self.sensor_failed:
            return INVALID_ACTUAL
        bar = self._signals.at("regulator_pressure_bar", due_ns - self._delay_ns)
        return max(-32767, min(32767, round(bar * self._per_bar)))

    # -- target window ------------------------------------------------------------------------------

    def _watch_window(self, due_ns: int) -> None:
        inside = False
        if self.state is State.ACTIVE and not self.sensor_failed:
            deviation = self._demand.number() - self._measured(due_ns)
            inside = self._window_lower.number() <= deviation <= self._window_upper.number()
        if not inside:
            self._outside_ns = due_ns

    def _in_window(self, now_ns: int) -> bool:
        """Inside for as long as the window's delay."""
        if not self._window.number() or self.state is not State.ACTIVE:
            return False
        return now_ns - self._outside_ns >= self._window_delay.number() * NS_PER_MS

    def _error_code(self) -> int:
        return self.node.emergencies.newest

"""Multi-turn encoder after CiA 406: position that wraps, and speed.

Job: turns of the shaft to steps and 0.1 1/min. Not its job: the shaft.
"""

from __future__ import annotations

import math

from sim_hardware.bench.can import emergency
from sim_hardware.bench.can.datatypes import DataType, Value
from sim_hardware.bench.can.dictionary import Abort, AbortCode, Access
from sim_hardware.bench.can.node import Device
from sim_hardware.bench.can.settings import EncoderSettings
from sim_hardware.bench.signals import RigSignals

REVERSED, SCALING = 1, 4
POSITION_ERROR = 0x7320


class Encoder(Device):
    """See the manual, node 22h."""

    device_type = 0x0002_0196
    name = "Bench encoder"

    def __init__(self, settings: EncoderSettings, signals: RigSignals, delay_ns: int) -> None:
        self._settings, self._signals, self._delay_ns = settings, signals, delay_ns
        self._offset = 0
        self._steps = 0
        self._sign = 1
        self._scale = settings.steps_per_turn, settings.steps_per_turn * settings.turns
        self.stuck = False

    def define(self) -> None:
        add, u16, u32 = self.node.add, DataType.UNSIGNED16, DataType.UNSIGNED32
        steps, turns = self._settings.steps_per_turn, self._settings.turns
        self._mode = add(
            0x6000,
            0,
            "operating parameters",
            u16,
            Access.RW,
            SCALING,
            check=self._check_mode,
            written=self._rescale,
        )
        self._per_turn = add(
            0x6001,
            0,
            "steps per turn",
            u32,
            Access.RW,
            steps,
            low=1,
            high=steps,
            check=self._check_per_turn,
            written=self._rescale,
        )
        self._total = add(
            0x6002, 0, "total steps", u32, Access.RW, steps * turns, low=1, high=steps * turns,
            check=self._check_total, written=self._rescale,
        )  # fmt: skip
        self._preset = add(
            0x6003, 0, "preset value", u32, Access.RW, check=self._check_preset, written=self._set_preset
        )
        self._position = add(0x6004, 0, "position value", u32, Access.RO, mappable=True)
        self.node.dictionary.add_count(0x6030, 1)
        self._speed = add(0x6030, 1, "speed, 0.1 1/min", DataType.INTEGER16, Access.RO, mappable=True)
        add(0x6500, 0, "operating status", u16, Access.RO, getter=self._mode.number)
        add(0x6501, 0, "steps per turn of the disc", u32, Access.CONST, steps)
        add(0x6502, 0, "distinguishable turns", u16, Access.CONST, turns)
        self._alarms = add(0x6503, 0, "alarms", u16, Access.RO, mappable=True)
        self.node.add_tpdo(((0x6004, 0, 32), (0x6030, 1, 16)), self._settings.tpdo_ms)

    def power_on(self) -> None:
        self._offset = 0
        self._rescale()
        self.disturb(stuck=self.stuck)

    def refresh(self, due_ns: int) -> None:
        if self.stuck:
            return
        t_ns = due_ns - self._delay_ns
        self._read(self._signals.at("position_turns", t_ns), self._signals.at("speed_rpm", t_ns))

    def disturb(self, *, stuck: bool) -> None:
        """Let the position stand still (with the alarm that the encoder makes of it), or free it."""
        self.stuck = stuck
        self._alarms.value = int(stuck)
        if stuck:
            self.node.emergencies.came(POSITION_ERROR, emergency.PROFILE)
        else:
            self.node.emergencies.went(POSITION_ERROR)

    def _rescale(self) -> None:
        """Direction, steps per turn and total steps, from the parameters."""
        mode = self._mode.number()
        self._sign = -1 if mode & REVERSED else 1
        if mode & SCALING:
            self._scale = self._per_turn.number(), self._total.number()
        else:
            steps = self._settings.steps_per_turn
            self._scale = steps, steps * self._settings.turns

    def _read(self, turns: float, speed_rpm: float) -> None:
        sign, (per_turn, total) = self._sign, self._scale
        self._steps = math.floor(sign * turns * per_turn)
        self._position.value = (self._steps + self._offset) % total
        self._speed.value = max(-32768, min(32767, round(sign * speed_rpm * 10.0)))

    def _set_preset(self) -> None:
        """The present position becomes the preset value; only the standing shaft makes that exact."""
        self._offset = self._preset.number() - self._steps

    def _check_preset(self, value: Value) -> None:
        assert isinstance(value, int)
        if value >= self._total.number():
            raise Abort(AbortCode.TOO_HIGH)

    @staticmethod
    def _check_mode(value: Value) -> None:
        assert isinstance(value, int)
        if value & ~(REVERSED | SCALING):
            raise Abort(AbortCode.BAD_VALUE)

    def _check_per_turn(self, value: Value) -> None:
        assert isinstance(value, int)
        if value > self._total.number():
            raise Abort(AbortCode.INCOMPATIBLE)

    def _check_total(self, value: Value) -> None:
        assert isinstance(value, int)
        if value < self._per_turn.number():
            raise Abort(AbortCode.INCOMPATIBLE)

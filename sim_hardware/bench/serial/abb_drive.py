"""An emulated ABB drive on Modbus RTU: registers 400001 to 400006, parameters, ramps, communication
supervision.

Job: join the slave, the profile and the parameters, and hand speed, ramp and torque to the plant. Not its
job: physics; the plant makes the ramp with the rate that follows from the ramp times.

Registers: 400001 control word, 400002 REF1, 400003 REF2, 400004 status word, 400005 ACT1, 400006 ACT2, 400007
to 400018 data words (read as zero); +-20000 is +-100 % of the speed scaling 46.01.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from sim_hardware.bench.serial import abb_parameters as number
from sim_hardware.bench.serial.abb_parameters import ParameterRegisters, factory_parameters
from sim_hardware.bench.serial.abb_profile import AbbProfile, State
from sim_hardware.bench.serial.line import Line
from sim_hardware.bench.serial.modbus_slave import (
    ILLEGAL_ADDRESS,
    ILLEGAL_VALUE,
    ModbusException,
    RtuSlave,
    silence_s,
)
from sim_hardware.bench.signals import RigSignals

CONTROL, REF1, REF2, STATUS, ACT1, ACT2 = range(6)
LAST_DATA_WORD = 17
FULL_SCALE = 20000
TICK_S = 0.01
STANDSTILL_RPM = 0.5
AT_SETPOINT_RPM = 2.0
COMMUNICATION_LOSS = 0x6681
SHORTEST_RAMP_S = 0.01


class AbbDriveSettings(BaseModel):
    """Settings of the emulated drive; parameters by their number, "58.16" = 0.5."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    address: Annotated[int, Field(ge=1, le=247)] = 1
    response_s: Annotated[float, Field(ge=0, le=1)] = 0.002
    nominal_torque_nm: Annotated[float, Field(gt=0)] = 800.0
    parameters: dict[str, float] = Field(default_factory=dict[str, float])


class AbbDrive:
    """The drive at its serial line; see `emulator.Emulator`."""

    def __init__(self, signals: RigSignals, line: Line, settings: AbbDriveSettings | None = None) -> None:
        settings = settings or AbbDriveSettings()
        self._signals = signals
        self._torque_scale_nm = settings.nominal_torque_nm
        self.profile = AbbProfile()
        self._table = factory_parameters()
        for name, value in settings.parameters.items():
            self._set_parameter(name, value)
        self._parameters = ParameterRegisters(self._table)
        self._slave = RtuSlave(
            settings.address,
            self,
            silence_s=silence_s(line.baud, line.character_s),
            response_s=settings.response_s,
        )
        self._references = [0, 0]
        self._powered = True
        self._heard_s: float | None = None  # last message that the supervision counts; None before the first
        self._lost = False
        self._now_s = 0.0
        self._tick_s = 0.0

    # -- Emulator -----------------------------------------------------------------------------------

    def receive(self, data: bytes, first_s: float, last_s: float) -> None:
        """See `Emulator.receive`."""
        if self._powered:
            self._slave.receive(data, first_s, last_s)

    def advance(self, now_s: float) -> bytes:
        """See `Emulator.advance`."""
        self._now_s = now_s
        answer = self._slave.advance(now_s)
        if now_s >= self._tick_s:
            self._tick_s = now_s + TICK_S
            self._supervise(now_s)
            self._step()
        return answer if self._powered else b""

    def due_s(self, now_s: float) -> float:
        """See `Emulator.due_s`."""
        return min(self._tick_s, self._slave.due_s())

    def command(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """``{"do": "trip", "code": 8976}``, ``"alarm"`` (with ``on``), ``"local"`` (with ``on``), ``"power"``
        (with ``on``), ``"parameter"`` (with ``number`` "58.16" and ``value``), ``"state"``."""
        action = request.get("do")
        if action == "trip":
            self.profile.trip(int(request["code"]))
        elif action == "alarm":
            self.profile.alarm = bool(request.get("on", True))
        elif action == "local":
            self.profile.remote = not request.get("on", True)
        elif action == "power":
            self._power(bool(request.get("on", True)))
        elif action == "parameter":
            self._set_parameter(str(request["number"]), float(request["value"]))
        elif action != "state":
            raise ValueError(f"the emulated ABB drive does not know the command {action!r}")
        self._step()
        return {
            "state": self.profile.state.value,
            "fault": self.profile.fault_code,
            "control": self.profile.control,
            "reference": self._references[0],
        }

    # -- registers (Registers) ----------------------------------------------------------------------

    def read(self, address: int, count: int) -> list[int]:
        """See `modbus_slave.Registers.read`."""
        self._heard(any_message=True)
        if self._parameters.owns(address):
            self._refresh()
            return self._parameters.read(address, count)
        if address + count - 1 > LAST_DATA_WORD:
            raise ModbusException(ILLEGAL_ADDRESS)
        speed_rpm, torque_nm = self._signals.newest("speed_rpm"), self._signals.newest("torque_nm")
        actual_1 = _scaled(speed_rpm / self._value(number.SPEED_SCALING))
        actual_2 = _scaled(torque_nm / self._torque_scale_nm)
        words = [self.profile.control, *self._references, self._status(), actual_1, actual_2]
        words += [0] * (LAST_DATA_WORD + 1 - len(words))
        return [word & 0xFFFF for word in words[address : address + count]]

    def write(self, address: int, values: list[int]) -> None:
        """See `modbus_slave.Registers.write`."""
        self._heard(any_message=True)
        if self._parameters.owns(address):
            changes = self._parameters.prepare(address, values)
            for parameter, value in changes:
                parameter.value = value
            return
        last = address + len(values) - 1
        if last > LAST_DATA_WORD:
            raise ModbusException(ILLEGAL_ADDRESS)
        if address <= ACT2 and last >= STATUS:  # status and actual values are not written
            raise ModbusException(ILLEGAL_VALUE)
        self._heard(any_message=False)
        for position, word in enumerate(values, start=address):
            if position in {REF1, REF2} and self.profile.remote:
                self._references[position - REF1] = word - 0x10000 if word >= 0x8000 else word
            elif position == CONTROL:
                self.profile.write(word)
        self._step()

    # -- the drive ----------------------------------------------------------------------------------

    def _heard(self, *, any_message: bool) -> None:
        """A message for the supervision: mode 1 counts control word and references, mode 2 any message."""
        mode = self._value(number.LOSS_MODE)
        if mode == 2 or (mode == 1 and not any_message):
            self._heard_s = self._now_s
            if self._lost:
                self._lost = self.profile.alarm = False

    def _supervise(self, now_s: float) -> None:
        """Communication loss: counted from the first message on."""
        limit_s = self._value(number.LOSS_TIME)
        action = self._value(number.LOSS_ACTION)
        if self._heard_s is None or limit_s == 0 or self._lost or action == number.ACTION_NONE:
            return
        if now_s - self._heard_s <= limit_s:
            return
        self._lost = True
        if action == number.ACTION_FAULT:
            self.profile.trip(COMMUNICATION_LOSS)
            self._heard_s = None
            self._lost = False
        else:
            self.profile.alarm = True

    def _step(self) -> None:
        """Let the profile move and tell the plant."""
        signals = self._signals
        relay_closed = bool(signals.get("relay_closed"))
        standstill = abs(signals.newest("speed_rpm")) < STANDSTILL_RPM
        self.profile.advance(standstill=standstill, start_allowed=relay_closed and self._powered)
        speed_rpm = self._reference_rpm()
        down = abs(speed_rpm) < abs(signals.newest("speed_rpm"))
        time_s = self._value(number.DECELERATION if down else number.ACCELERATION)
        emergency = self.profile.state is State.EMERGENCY_STOP
        if emergency:
            time_s = self._value(number.EMERGENCY_STOP_TIME)
        signals.set(
            speed_set_rpm=0.0 if self.profile.stopping else speed_rpm,
            speed_ramp_rpm_per_s=self._value(number.SPEED_SCALING) / max(time_s, SHORTEST_RAMP_S),
            drive_enabled=self.profile.torque_on,
            quick_stop=emergency,
        )

    def _reference_rpm(self) -> float:
        """The speed reference in force."""
        if self._lost and self._value(number.LOSS_ACTION) in {
            number.ACTION_SAFE_SPEED, number.ACTION_SAFE_SPEED_ALWAYS,
        }:  # fmt: skip
            return self._value(number.SAFE_SPEED)
        control = self.profile.control
        if self.profile.state is not State.OPERATION_ENABLED or not control & 0x10 or not control & 0x40:
            return 0.0
        if not control & 0x20:  # RAMP_HOLD: stay where the shaft is
            return self._signals.newest("speed_rpm")
        reference = max(-FULL_SCALE, min(FULL_SCALE, self._references[0]))
        return reference / FULL_SCALE * self._value(number.SPEED_SCALING)

    def _status(self) -> int:
        actual_rpm = self._signals.newest("speed_rpm")
        return self.profile.status(
            at_setpoint=abs(actual_rpm - self._reference_rpm()) < AT_SETPOINT_RPM,
            above_limit=abs(actual_rpm) > self._value(number.SPEED_SCALING),
        )

    def _refresh(self) -> None:
        """Parameters that are actual values."""
        self._table[number.MOTOR_SPEED].value = self._signals.newest("speed_rpm")
        self._table[number.TRIP_CODE].value = self.profile.fault_code
        self._table[6, 1].value = self.profile.control
        self._table[6, 11].value = self._status()

    def _power(self, on: bool) -> None:
        """Power off forgets everything but the parameters."""
        if on and not self._powered:
            self.profile = AbbProfile()
            self._references = [0, 0]
            self._heard_s, self._lost = None, False
        self._powered = on

    def _value(self, key: tuple[int, int]) -> float:
        return self._table[key].value

    def _set_parameter(self, name: str, value: float) -> None:
        group, _, index = name.partition(".")
        try:
            parameter = self._table[int(group), int(index)]
        except (KeyError, ValueError):
            raise ValueError(f"the emulated ABB drive has no parameter {name!r}") from None
        if not parameter.low <= value <= parameter.high:
            raise ValueError(f"parameter {name} = {value:g} is outside {parameter.low:g}..{parameter.high:g}")
        parameter.value = value


def _scaled(share: float) -> int:
    """A share of full scale as a register, held within 16 bits."""
    return max(-32768, min(32767, round(share * FULL_SCALE)))

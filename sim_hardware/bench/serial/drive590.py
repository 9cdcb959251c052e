"""An emulated Eurotherm/Parker 590 DC drive on EI-Bisynch ASCII.

Job: mnemonics, health word, sequencing word, ramps and communication time-out; speed, ramp and torque to the
plant. Not its job: the frames (`bisynch_slave`), physics.

Confirmed by the manuals: mnemonics 09 (speed demand), 0B (current demand), 0F (health word: bit 1 missing
pulse, 9 three-phase present, 13 current trip), 22 (digital tacho), 23 (speed error), and the mapping of tags.
Recollections: tags 2, 3 (ramp times), 5 (ramp input), 535 to 537 (remote sequencing and its bits), and the
tag of the time-out.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from sim_hardware.bench.serial.bisynch_slave import BisynchSlave, Refused, tag_mnemonic
from sim_hardware.bench.signals import RigSignals

TICK_S = 0.01
STANDSTILL_RPM = 0.5
SHORTEST_RAMP_S = 0.1

# health word
MISSING_PULSE, THREE_PHASE, CURRENT_TRIP = 1 << 1, 1 << 9, 1 << 13
COMMS_TRIP = 1 << 11  # recollection
# remote sequencing word
RUN, ENABLE, NO_FAST_STOP, ALARM_ACKNOWLEDGE, NO_REMOTE_TRIP = 1 << 0, 1 << 1, 1 << 2, 1 << 8, 1 << 9
# its status word
SEQ_ENABLED, SEQ_RUNNING, SEQ_HEALTHY, SEQ_STANDSTILL, SEQ_TRIPPED = 1 << 0, 1 << 1, 1 << 2, 1 << 3, 1 << 4

ACCELERATION, DECELERATION, RAMP_INPUT, FAST_STOP_TIME = 2, 3, 5, 26
SEQUENCE, SEQUENCE_STATUS, COMMS_TIMEOUT = 536, 537, 1000


@dataclass(slots=True)
class _Number:
    value: float
    low: float
    high: float
    decimals: int


class Drive590Settings(BaseModel):
    """Settings of the emulated 590."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    group: Annotated[int, Field(ge=0, le=7)] = 0
    unit: Annotated[int, Field(ge=0, le=15)] = 1
    response_s: Annotated[float, Field(ge=0, le=0.16)] = 0.004
    full_speed_rpm: Annotated[float, Field(gt=0)] = 1000.0
    nominal_torque_nm: Annotated[float, Field(gt=0)] = 800.0
    comms_timeout_s: Annotated[float, Field(ge=0, le=600)] = 1.0


class Drive590:
    """The drive at its serial line; see `emulator.Emulator`."""

    def __init__(self, signals: RigSignals, settings: Drive590Settings | None = None) -> None:
        settings = settings or Drive590Settings()
        self._signals = signals
        self._settings = settings
        self._numbers = {
            tag_mnemonic(ACCELERATION): _Number(10.0, 0.1, 600.0, 1),
            tag_mnemonic(DECELERATION): _Number(10.0, 0.1, 600.0, 1),
            tag_mnemonic(FAST_STOP_TIME): _Number(1.5, 0.1, 600.0, 1),
            tag_mnemonic(RAMP_INPUT): _Number(0.0, -105.0, 105.0, 2),
            tag_mnemonic(COMMS_TIMEOUT): _Number(settings.comms_timeout_s, 0.0, 600.0, 1),
        }
        self._sequence = 0
        self._trips = 0
        self._running = self._stopping = self._fast = False
        self._powered = True
        self._heard_s: float | None = None
        self._now_s = self._tick_s = 0.0
        self._slave = BisynchSlave(settings.group, settings.unit, self, response_s=settings.response_s)

    # -- Emulator -----------------------------------------------------------------------------------

    def receive(self, data: bytes, first_s: float, last_s: float) -> None:
        """See `Emulator.receive`."""
        if self._powered:
            self._slave.receive(data, last_s)

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
        """``{"do": "trip", "bits": 8192}``, ``"power"`` (with ``on``), ``"state"``."""
        action = request.get("do")
        if action == "trip":
            self._trips |= int(request.get("bits", CURRENT_TRIP))
        elif action == "power":
            self._powered = bool(request.get("on", True))
            self._sequence, self._running, self._heard_s = 0, False, None
        elif action != "state":
            raise ValueError(f"the emulated 590 does not know the command {action!r}")
        self._step()
        return {"sequence": self._sequence, "health": self._health(), "running": self._running}

    # -- parameters (Mnemonics) ---------------------------------------------------------------------

    def poll(self, mnemonic: str) -> str | None:
        """See `bisynch_slave.Mnemonics.poll`."""
        full_rpm = self._settings.full_speed_rpm
        speed_rpm = self._signals.newest("speed_rpm")
        demand = self._numbers[tag_mnemonic(RAMP_INPUT)].value
        words = {
            "0F": self._health(),
            tag_mnemonic(SEQUENCE): self._sequence,
            tag_mnemonic(SEQUENCE_STATUS): self._sequence_status(),
            "II": 0x0590,
            "V0": 0x0414,
        }
        if mnemonic in words:
            return f">{words[mnemonic]:04X}"
        if mnemonic in self._numbers:
            number = self._numbers[mnemonic]
            return f"{number.value:.{number.decimals}f}"
        torque = self._signals.newest("torque_nm") / self._settings.nominal_torque_nm
        readings = {
            "09": f"{demand if self._running else 0.0:.2f}",
            "0B": f"{max(-200.0, min(200.0, 100 * torque)):.2f}",
            "10": "0.00",
            "22": f"{max(-6000.0, min(6000.0, speed_rpm)):.1f}",
            "23": f"{demand - 100 * speed_rpm / full_rpm:.2f}",
        }
        return readings.get(mnemonic)

    def write(self, mnemonic: str, text: str) -> None:
        """See `bisynch_slave.Mnemonics.write`."""
        self._heard_s = self._now_s
        if mnemonic == tag_mnemonic(SEQUENCE):
            if not text.startswith(">"):
                raise Refused
            word = _hexadecimal(text[1:])
            if word & ALARM_ACKNOWLEDGE and not self._sequence & ALARM_ACKNOWLEDGE:
                self._trips = 0
            rising_run = bool(word & RUN) and not self._sequence & RUN
            self._sequence = word
            if rising_run and self._may_run():
                self._running, self._stopping, self._fast = True, False, False
        elif mnemonic in self._numbers:
            number = self._numbers[mnemonic]
            value = _free_format(text)
            if not number.low <= value <= number.high:
                raise Refused
            number.value = value
        else:
            raise Refused
        self._step()

    def following(self, mnemonic: str) -> str:
        """See `bisynch_slave.Mnemonics.following`."""
        order = sorted({"0F", "09", "0B", "10", "22", "23", *self._numbers})
        return order[(order.index(mnemonic) + 1) % len(order)] if mnemonic in order else order[0]

    # -- the drive ----------------------------------------------------------------------------------

    def _may_run(self) -> bool:
        needed = ENABLE | NO_FAST_STOP | NO_REMOTE_TRIP
        relay_closed = bool(self._signals.get("relay_closed"))
        return self._powered and relay_closed and not self._trips and self._sequence & needed == needed

    def _supervise(self, now_s: float) -> None:
        """Communication time-out: counted from the first write on, 0 switches it off."""
        limit_s = self._numbers[tag_mnemonic(COMMS_TIMEOUT)].value
        if self._heard_s is not None and limit_s > 0 and now_s - self._heard_s > limit_s:
            self._trips |= COMMS_TRIP
            self._heard_s = None

    def _step(self) -> None:
        signals = self._signals
        word = self._sequence
        relay_closed = bool(signals.get("relay_closed"))
        if self._running:
            self._fast = self._fast or not word & NO_FAST_STOP
            self._stopping = not word & RUN or self._fast
            coast = self._trips or not word & ENABLE or not word & NO_REMOTE_TRIP or not relay_closed
            stands = abs(signals.newest("speed_rpm")) < STANDSTILL_RPM
            if coast or not self._powered or (self._stopping and stands):
                self._running = False
        demand_rpm = self._numbers[tag_mnemonic(RAMP_INPUT)].value / 100 * self._settings.full_speed_rpm
        down = self._stopping or abs(demand_rpm) < abs(signals.newest("speed_rpm"))
        tag = FAST_STOP_TIME if self._fast else DECELERATION if down else ACCELERATION
        ramp_s = max(self._numbers[tag_mnemonic(tag)].value, SHORTEST_RAMP_S)
        signals.set(
            speed_set_rpm=demand_rpm if self._running and not self._stopping else 0.0,
            speed_ramp_rpm_per_s=self._settings.full_speed_rpm / ramp_s,
            drive_enabled=self._running,
            quick_stop=self._running and self._fast,
        )

    def _health(self) -> int:
        return (THREE_PHASE if self._powered else 0) | self._trips

    def _sequence_status(self) -> int:
        stands = abs(self._signals.newest("speed_rpm")) < STANDSTILL_RPM
        return (
            (SEQ_ENABLED if self._sequence & ENABLE and self._signals.get("relay_closed") else 0)
            | (SEQ_RUNNING if self._running else 0)
            | (SEQ_HEALTHY if not self._trips else SEQ_TRIPPED)
            | (SEQ_STANDSTILL if stands else 0)
        )


def _hexadecimal(text: str) -> int:
    if not 1 <= len(text) <= 4 or any(character not in "0123456789ABCDEFabcdef" for character in text):
        raise Refused
    return int(text, 16)


def _free_format(text: str) -> float:
    """A number such as "-2.2", "19.99", " 5." """
    digits = text.strip()
    if not digits or any(character not in "+-.0123456789" for character in digits):
        raise Refused
    try:
        return float(digits)
    except ValueError:
        raise Refused from None

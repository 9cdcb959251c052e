"""A Eurotherm/Parker 590 on EI-Bisynch ASCII through pyserial, after a tag map.

Job: implement `DriveLink`. Not its job: codes (`bisynch`), threads and policy (`polled`).

The line is slow, so a cycle writes the sequencing word (which also feeds the drive's time-out), the demand
where it has changed, reads the speed, and one of the slower readings in turn. A block check of one exclusive
or lets some double errors through; therefore the demand is read back in turn and compared.
"""

from __future__ import annotations

import itertools
import termios
import time
from collections.abc import Callable, Iterator, Mapping
from typing import Any, TypeVar

import serial

from drivers.dc_drive import bisynch
from drivers.dc_drive.eurotherm_map import TagMap
from drivers.dc_drive.exchange import Exchanges, ExchangeStatistics
from drivers.dc_drive.profile import has
from drivers.dc_drive.settings import SerialDriveSettings
from drivers.dc_drive.words import DriveState, LinkError, Refused, Report, Torque, Trip, Wish
from rigctl.hal.bench_paths import port_path
from rigctl.hal.diagnosis import Finding
from rigctl.hal.wirelog import WireLog

Value = TypeVar("Value")
QUIET_S = 0.03
#: What pyserial raises when a port has gone; its SerialException is an OSError.
GONE = (OSError, termios.error)
DEMAND_STEP_PERCENT = 0.01


class EurothermLink(ExchangeStatistics):
    """See `words.DriveLink`."""

    def __init__(self, settings: SerialDriveSettings, tag_map: TagMap, group: int, unit: int) -> None:
        self._settings = settings
        self._map = tag_map
        self._group, self._unit = group, unit
        self.log = WireLog(None)
        self._serial: Any = None  # pyserial types its Serial by platform
        self._exchanges = Exchanges(settings.deadline_s, self._settle)
        self._forget()

    def _forget(self) -> None:
        self._demand: float | None = None
        self._ramp_written: float | None = None
        self._sequence = 0
        self._status = self._health = 0
        self._turn: Iterator[str] = itertools.cycle(("status", "health", "status", "demand"))

    # -- port ---------------------------------------------------------------------------------------

    def connect(self) -> None:
        """See `DriveLink.connect`."""
        self._forget()
        settings = self._settings
        try:
            self._serial = serial.serial_for_url(
                port_path(settings.port),
                baudrate=settings.baud,
                bytesize=settings.data_bits,
                parity=settings.parity,
                stopbits=settings.stop_bits,
                timeout=settings.reply_timeout_s,
                write_timeout=settings.reply_timeout_s,
                exclusive=True,
            )
        except (*GONE, ValueError) as error:
            raise LinkError(f"cannot open {port_path(settings.port)}: {error}") from error

    def disconnect(self) -> None:
        """See `DriveLink.disconnect`."""
        port, self._serial = self._serial, None
        if port is not None:
            try:
                port.close()
            except GONE:
                pass  # the port is gone already

    def _settle(self) -> None:
        """Wait until nothing comes any more and throw it away."""
        port = self._serial
        if port is None:
            return
        try:
            until_s = time.monotonic() + self._settings.reply_timeout_s
            quiet_s = time.monotonic() + QUIET_S
            while time.monotonic() < min(until_s, quiet_s):
                if port.in_waiting:
                    self.log.received(port.read(port.in_waiting))
                    quiet_s = time.monotonic() + QUIET_S
                time.sleep(0.003)
        except GONE:
            pass  # the next attempt reports it

    # -- exchanges ----------------------------------------------------------------------------------

    def _transact(self, request: bytes, *, poll: bool) -> bytes:
        """Send a request; returns what came until the answer was complete or its time was over."""
        port = self._serial
        if port is None:
            raise LinkError("the port is gone")
        answer = bytearray()
        try:
            port.reset_input_buffer()
            self.log.sent(request)
            port.write(request)
            until_s = time.monotonic() + self._settings.reply_timeout_s
            while time.monotonic() < until_s:
                answer += port.read(max(1, port.in_waiting))
                if (poll and bisynch.poll_is_complete(bytes(answer))) or (not poll and answer):
                    break
        except GONE as error:
            raise LinkError(f"the port is gone: {error}") from error
        self.log.received(bytes(answer))
        if not answer:
            raise LinkError("no answer")
        return bytes(answer)

    def _poll(self, name: str) -> str:
        request = bisynch.poll_request(self._group, self._unit, name)

        def attempt() -> str:
            try:
                return bisynch.parse_poll(self._transact(request, poll=True), name)
            except bisynch.BadAnswer as error:
                raise LinkError(str(error)) from error

        return self._exchanges.run(attempt, f"polling {name}")

    def _number(self, name: str) -> float:
        return self._parsed(name, bisynch.parse_number)

    def _word(self, name: str) -> int:
        return self._parsed(name, bisynch.parse_word)

    def _parsed(self, name: str, parse: Callable[[str], Value]) -> Value:
        text = self._poll(name)
        try:
            return parse(text)
        except bisynch.BadAnswer as error:
            raise LinkError(f"polling {name}: {error}") from error

    def _write(self, name: str, text: str) -> None:
        request = bisynch.write_request(self._group, self._unit, name, text)
        refusals = 0

        def attempt() -> None:
            nonlocal refusals
            answer = self._transact(request, poll=False)
            if answer == bytes([bisynch.NAK]):
                refusals += 1
                if refusals > 2:  # a disturbed request is refused too, three times in a row it is not
                    raise Refused(f"writing {name} = {text}: refused")
                raise LinkError("refused")
            if answer != bytes([bisynch.ACK]):
                raise LinkError(f"not an acknowledgement: {answer.hex(' ')}")

        self._exchanges.run(attempt, f"writing {name}")

    # -- DriveLink ----------------------------------------------------------------------------------

    def identity(self) -> Mapping[str, str]:
        """See `DriveLink.identity`."""
        names = self._map.parameters
        lines = {"maker": self._map.maker, "model": self._map.model}
        if names.identity is not None:
            lines["instrument"] = self._poll(names.identity.name)
        if names.software is not None:
            lines["software"] = self._poll(names.software.name)
        return lines

    def findings(self) -> list[Finding]:
        """See `DriveLink.findings`."""
        name = self._map.parameters.comms_timeout_s.name
        time_s = self._number(name)
        if 0 < time_s <= self._settings.longest_loss_s:
            return []
        problem = (
            f"the drive notices a loss of communication after {time_s:g} s ({name}; 0 is never), "
            f"{self._settings.longest_loss_s:g} s is the longest accepted."
        )
        return [Finding(problem, self._map.comms_remedy, unsafe=True)]

    def check_setpoint(self, speed_rpm: float, ramp_rpm_per_s: float) -> str:
        """See `DriveLink.check_setpoint`."""
        full_rpm = self._settings.full_speed_rpm
        slowest, fastest = full_rpm / self._map.longest_ramp_s, full_rpm / self._map.shortest_ramp_s
        if abs(speed_rpm) > full_rpm:
            return f"Its demand ends at {full_rpm:g} 1/min."
        if not slowest <= ramp_rpm_per_s <= fastest:
            return f"Its ramps are {slowest:.3g} to {fastest:.3g} 1/min per s."
        return ""

    def cycle(self, wish: Wish) -> Report:
        """See `DriveLink.cycle`."""
        names = self._map.parameters
        if wish.ramp_rpm_per_s is not None and wish.ramp_rpm_per_s != self._ramp_written:
            time_s = self._settings.full_speed_rpm / wish.ramp_rpm_per_s
            for parameter in (names.acceleration_s, names.deceleration_s):
                self._write(parameter.name, f"{time_s:.1f}")
            self._ramp_written = wish.ramp_rpm_per_s
        running = self._state() is DriveState.RUNNING
        demand = 100 * wish.speed_rpm / self._settings.full_speed_rpm
        demand = round(demand, 2) if running and wish.torque is Torque.ON else 0.0
        if demand != self._demand:
            self._write(names.demand_percent.name, f"{demand:.2f}")
            self._demand = demand
        word = self._next_word(wish)
        self._write(names.sequence.name, bisynch.format_word(word))
        changed, self._sequence = word != self._sequence, word
        actual_rpm = self._number(names.actual_rpm.name)
        self._read_in_turn("status" if changed else next(self._turn))
        if changed and self._state() is DriveState.TRIPPED:
            self._read_in_turn("health")
        return Report(self._state(), actual_rpm, self._status)

    def _next_word(self, wish: Wish) -> int:
        words = self._map.sequence_words
        if wish.torque is Torque.OFF:
            return words.off
        if wish.torque is Torque.QUICK_STOP:
            return words.quick_stop
        if self._state() is DriveState.TRIPPED and wish.reset:
            return words.off if self._sequence == words.reset else words.reset
        if self._sequence in {words.enable, words.run} and has(self._status, self._map.sequence_bits.enabled):
            return words.run
        return words.enable

    def _read_in_turn(self, what: str) -> None:
        names = self._map.parameters
        if what == "status":
            self._status = self._word(names.sequence_status.name)
        elif what == "health":
            self._health = self._word(names.health.name)
        elif self._demand is not None:
            held = self._number(names.demand_percent.name)
            if abs(held - self._demand) > DEMAND_STEP_PERCENT / 2:
                self._demand = None  # written again in the next cycle
                raise LinkError(f"the drive holds a demand of {held:g} % that nobody has written")

    def _state(self) -> DriveState:
        bits = self._map.sequence_bits
        if has(self._status, bits.tripped) or any(has(self._health, trip.bit) for trip in self._map.trips):
            return DriveState.TRIPPED
        if has(self._status, bits.running):
            stopping = self._sequence == self._map.sequence_words.quick_stop
            return DriveState.STOPPING if stopping else DriveState.RUNNING
        return DriveState.OFF

    def trip(self) -> Trip:
        """See `DriveLink.trip`."""
        self._health = self._word(self._map.parameters.health.name)
        present = [trip for trip in self._map.trips if has(self._health, trip.bit)]
        names = ", ".join(trip.name for trip in present) or "unknown trip"
        return Trip(self._health, names, bool(present) and all(trip.resettable for trip in present))

    def status_exchange(self) -> None:
        """See `DriveLink.status_exchange`."""
        self._number(self._map.parameters.actual_rpm.name)

"""A Modbus RTU drive through pymodbus, after a register map.

Job: implement `DriveLink`: write control word and reference, read status and actual speed, ramps, supervision
settings, trips. Not its job: threads and policy (`polled`).

Modbus RTU answers carry no number, so an answer that comes too late could be taken for the next one. Two
reads follow each other never with the same length: each attempt reads either status and actual speed, or
these together with control word and reference, and an answer of the other length is thrown away.
"""

from __future__ import annotations

import logging
import termios
import time
from collections.abc import Callable, Mapping, Sequence

from pymodbus.client import ModbusSerialClient
from pymodbus.exceptions import ModbusException
from pymodbus.pdu import ModbusPDU

from drivers.dc_drive.exchange import Exchanges, ExchangeStatistics
from drivers.dc_drive.modbus_map import FIRST_HOLDING, Action, Register, RegisterMap
from drivers.dc_drive.profile import control_word, drive_state, has
from drivers.dc_drive.settings import SerialDriveSettings
from drivers.dc_drive.words import DriveState, LinkError, Refused, Report, Trip, Wish
from rigctl.hal.bench_paths import port_path
from rigctl.hal.diagnosis import Finding
from rigctl.hal.wirelog import WireLog

EXCEPTIONS = {1: "illegal function", 2: "illegal data address", 3: "illegal data value", 4: "device failure"}
logging.getLogger("pymodbus").addHandler(logging.NullHandler())  # what it says is in our own errors
QUIET_S = 0.02
SCALING_TOLERANCE = 1e-3


class LoggedClient(ModbusSerialClient):
    """pymodbus' client that tells the wire log what really went over the wire."""

    wire_log: WireLog

    def send(self, request: bytes, addr: tuple | None = None) -> int:
        """Send and log."""
        self.wire_log.sent(request)
        return super().send(request, addr)

    def recv(self, size: int | None) -> bytes:
        """Receive and log."""
        data = super().recv(size)
        self.wire_log.received(data)
        return data


class ModbusLink(ExchangeStatistics):
    """See `words.DriveLink`."""

    def __init__(self, settings: SerialDriveSettings, register_map: RegisterMap, address: int) -> None:
        self._settings = settings
        self._map = register_map
        self._address = address
        self.log = WireLog(None)
        self._client: LoggedClient | None = None
        self._exchanges = Exchanges(settings.deadline_s, self._settle)
        self._forget()

    def _forget(self) -> None:
        self._status = 0
        self._control = self._map.control_words.coast
        self._ramp_written: float | None = None
        self._long_read = False

    # -- port ---------------------------------------------------------------------------------------

    def connect(self) -> None:
        """See `DriveLink.connect`."""
        self._forget()
        settings = self._settings
        client = LoggedClient(
            port_path(settings.port),
            baudrate=settings.baud,
            bytesize=settings.data_bits,
            parity=settings.parity,
            stopbits=settings.stop_bits,
            timeout=settings.reply_timeout_s,
            retries=0,
        )
        client.wire_log = self.log
        if not client.connect():
            raise LinkError(f"cannot open {port_path(settings.port)}")
        self._client = client

    def disconnect(self) -> None:
        """See `DriveLink.disconnect`."""
        client, self._client = self._client, None
        if client is not None:
            try:
                client.close()
            except OSError:
                pass  # the port is gone already

    def _settle(self) -> None:
        """Wait until nothing comes any more and throw it away."""
        client = self._client
        if client is None or client.socket is None:
            return
        try:
            until_s = time.monotonic() + self._settings.reply_timeout_s
            quiet_s = time.monotonic() + QUIET_S
            while time.monotonic() < min(until_s, quiet_s):
                waiting = client.socket.in_waiting
                if waiting:
                    self.log.received(client.socket.read(waiting))
                    quiet_s = time.monotonic() + QUIET_S
                time.sleep(0.002)
        except OSError:
            client.close()

    # -- exchanges ----------------------------------------------------------------------------------

    def _run(self, attempt: Callable[[LoggedClient], ModbusPDU], what: str) -> ModbusPDU:
        """One exchange, repeated until the deadline."""

        def once() -> ModbusPDU:
            client = self._client
            if client is None or client.socket is None:
                raise LinkError("the port is gone")
            try:
                answer = attempt(client)
            except (ModbusException, OSError, termios.error) as error:
                raise LinkError("no answer") from error
            if answer.isError():
                code = getattr(answer, "exception_code", 0)
                raise Refused(f"{what}: refused with exception {code}, {EXCEPTIONS.get(code, 'unknown')}")
            return answer

        return self._exchanges.run(once, what)

    def _read(self, address: int, count: int) -> list[int]:
        def attempt(client: LoggedClient) -> ModbusPDU:
            answer = client.read_holding_registers(address, count=count, device_id=self._address)
            if not answer.isError() and len(answer.registers) != count:
                raise LinkError(f"{len(answer.registers)} registers instead of {count}")
            return answer

        return list(self._run(attempt, f"reading register {FIRST_HOLDING + address}").registers)

    def _write(self, address: int, values: list[int]) -> None:
        def attempt(client: LoggedClient) -> ModbusPDU:
            answer = client.write_registers(address, values, device_id=self._address)
            if not answer.isError() and (answer.address, answer.count) != (address, len(values)):
                raise LinkError("the answer belongs to another request")
            return answer

        self._run(attempt, f"writing register {FIRST_HOLDING + address}")

    def _value(self, register: Register) -> float:
        return register.decode(self._read(register.address, register.count))

    def _read_process(self) -> tuple[int, int]:
        """Status word and actual speed; each attempt has another length than the one before."""
        process = self._map.process
        status, control = process.status - FIRST_HOLDING, process.control - FIRST_HOLDING
        found: list[int] = []

        def attempt(client: LoggedClient) -> ModbusPDU:
            self._long_read = process.echo and not self._long_read
            start = min(control, status) if self._long_read else status
            count = max(status, control) + 2 - start if self._long_read else 2
            answer = client.read_holding_registers(start, count=count, device_id=self._address)
            if not answer.isError():
                if len(answer.registers) != count:
                    raise LinkError(f"{len(answer.registers)} registers instead of {count}")
                found[:] = answer.registers[status - start : status - start + 2]
            return answer

        self._run(attempt, f"reading register {process.status}")
        word, actual = found
        return word, actual - 0x10000 if actual >= 0x8000 else actual

    # -- DriveLink ----------------------------------------------------------------------------------

    def identity(self) -> Mapping[str, str]:
        """See `DriveLink.identity`."""
        lines = {"maker": self._map.maker, "model": self._map.model}
        for line in self._map.identity:
            value = int(self._value(line.at))
            lines[line.name] = f"{value:04X}h" if line.format == "hex" else str(value)
        return lines

    def findings(self) -> list[Finding]:
        """See `DriveLink.findings`."""
        loss = self._map.communication_loss
        problems = [
            self._unsafe_choice(loss.action, loss.actions, "on loss of communication the drive does"),
            self._unsafe_choice(loss.mode, loss.modes, "what counts as communication is"),
        ]
        time_s, longest_s = self._value(loss.time), self._settings.longest_loss_s
        if not 0 < time_s <= longest_s:
            problems.append(
                f"the drive notices a loss of communication after {time_s:g} s (register "
                f"{loss.time.number}; 0 is never), {longest_s:g} s is the longest accepted."
            )
        found = [Finding(problem, loss.remedy, unsafe=True) for problem in problems if problem]
        if self._map.speed_scaling is not None:
            scaling_rpm, full_rpm = self._value(self._map.speed_scaling), self._settings.full_speed_rpm
            if abs(scaling_rpm - full_rpm) > SCALING_TOLERANCE * full_rpm:
                problem = (
                    f"the drive's 100 % is {scaling_rpm:g} 1/min (register "
                    f"{self._map.speed_scaling.number}), the rig file says full_speed_rpm = {full_rpm:g}: "
                    "every speed would be wrong."
                )
                found.append(Finding(problem, "Make both the same.", unsafe=True))
        return found

    def _unsafe_choice(self, register: Register | None, choices: Sequence[Action], text: str) -> str:
        """What is wrong with the value of a parameter with choices; empty where it is safe."""
        if register is None:
            return ""
        number = int(self._value(register))
        choice = next((entry for entry in choices if entry.value == number), None)
        if choice is not None and choice.safe:
            return ""
        name = choice.name if choice else "unknown"
        return f"{text} {name!r} (register {register.number} = {number})."

    def check_setpoint(self, speed_rpm: float, ramp_rpm_per_s: float) -> str:
        """See `DriveLink.check_setpoint`."""
        full_rpm, ramps = self._settings.full_speed_rpm, self._map.ramps
        slowest, fastest = full_rpm / ramps.longest_s, full_rpm / ramps.shortest_s
        if abs(speed_rpm) > full_rpm:
            return f"Its reference ends at {full_rpm:g} 1/min."
        if not slowest <= ramp_rpm_per_s <= fastest:
            return f"Its ramps are {slowest:.3g} to {fastest:.3g} 1/min per s."
        return ""

    def cycle(self, wish: Wish) -> Report:
        """See `DriveLink.cycle`."""
        if wish.ramp_rpm_per_s is not None and wish.ramp_rpm_per_s != self._ramp_written:
            time_s = self._settings.full_speed_rpm / wish.ramp_rpm_per_s
            for register in (self._map.ramps.acceleration, self._map.ramps.deceleration):
                self._write(register.address, register.encode(time_s))
            self._ramp_written = wish.ramp_rpm_per_s
        bits = self._map.status_bits
        running = drive_state(self._status, bits) is DriveState.RUNNING
        share = wish.speed_rpm / self._settings.full_speed_rpm if running else 0.0
        reference = round(share * self._map.process.full_scale) & 0xFFFF
        word = control_word(wish, self._status, self._control, self._map.control_words, bits)
        self._write(self._map.process.control - FIRST_HOLDING, [word, reference])
        self._control = word
        self._status, actual = self._read_process()
        return Report(
            state=drive_state(self._status, bits),
            actual_rpm=actual / self._map.process.full_scale * self._settings.full_speed_rpm,
            status=self._status,
            remote=bits.remote is None or has(self._status, bits.remote),
            alarm=has(self._status, bits.alarm),
        )

    def trip(self) -> Trip:
        """See `DriveLink.trip`."""
        if self._map.trip_code is None:
            return Trip(0, "trip; the map names no register of its code", resettable=False)
        code = int(self._value(self._map.trip_code))
        entry = next((entry for entry in self._map.trips if entry.code == code), None)
        return Trip(code, entry.name if entry else "unknown trip", entry.resettable if entry else False)

    def status_exchange(self) -> None:
        """See `DriveLink.status_exchange`."""
        self._read_process()

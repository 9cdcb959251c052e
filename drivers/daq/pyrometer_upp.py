"""Pyrometer on the IMPAC universal pyrometer protocol (UPP): ASCII over a serial line, 8E1.

Job: poll temperatures in a thread, read back identity and emissivity; error values, refusals and garbled
answers never become temperatures. Not its job: emission physics.

UPP has no checksum. An answer counts only when it has exactly the five characters of a temperature, lies in
the device's range, and does not jump by more than `jump_k` unless the next reading says the same.
"""

from __future__ import annotations

import os
import re
import termios
import threading
import time
from collections import deque
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from drivers.daq.source import NOTHING, SlowSettings, Taken, checked
from rigctl.core.channels import DISC_TEMPERATURE, ChannelSpec
from rigctl.core.errors import DeviceError
from rigctl.hal.bench_paths import port_hint, port_path
from rigctl.hal.devices import RigContext
from rigctl.hal.diagnosis import Diagnosis, Finding, Reading, measured
from rigctl.hal.wirelog import WireLog, wire_log

CR = b"\r"
LONGEST_ANSWER = 32
ERRORS = {
    88880: "overflow: hotter than the measuring range",
    77770: "not ready: warming up, or the device is too hot",
    75550: "the head is too hot",
    74440: "the head is too cold",
}
"""Answers to `ms` that are no temperatures."""
_TEMPERATURE = re.compile(rb"-\d{4}|\d{5}")
_OPEN_ATTEMPTS = 3


class UppSettings(SlowSettings):
    """Settings of kind "upp".

    Attributes
    ----------
    port : str
        "/dev/ttyUSB0", "socket://host:port", "rfc2217://…", "bench:pyrometer".
    baudrate, address : int
    poll_hz : float
        Readings per second.
    emissivity : float
        Must be what the device is set to; with `configure` it is set.
    answer_s : float
        The device must answer within.
    jump_k : float
        A larger step from one reading to the next must be confirmed by the next one.
    """

    port: str = Field(min_length=1)
    baudrate: int = Field(default=19_200, ge=1200, le=115_200)
    address: int = Field(default=0, ge=0, le=97)
    poll_hz: float = Field(default=25.0, ge=1.0, le=50.0)
    emissivity: float = Field(ge=0.05, le=1.0)
    configure: bool = False
    answer_s: float = Field(default=0.1, ge=0.01, le=2.0)
    jump_k: float = Field(default=50.0, gt=0.0)
    channel: str = DISC_TEMPERATURE
    description: str = ""


def parse_temperature(answer: bytes) -> tuple[float | None, str]:
    """Answer to `ms` without its CR: (temperature in °C, "") or (None, what is wrong with it).

    >>> parse_temperature(b"02563")
    (256.3, '')
    """
    if not _TEMPERATURE.fullmatch(answer):
        return None, f"garbled answer {answer!r}"
    tenths = int(answer)
    if tenths in ERRORS:
        return None, ERRORS[tenths]
    return tenths / 10.0, ""


def parse_range(answer: bytes) -> tuple[float, float]:
    """Answer to `mb`: two times four hex digits, lowest and highest temperature in °C.

    Raises
    ------
    ValueError
        It is written otherwise.
    """
    if not re.fullmatch(rb"[0-9A-Fa-f]{8}", answer):
        raise ValueError(f"{answer!r} is no measuring range")
    low, high = (int(part, 16) for part in (answer[:4], answer[4:]))
    low, high = (value - 0x10000 if value >= 0x8000 else value for value in (low, high))
    if low >= high:
        raise ValueError(f"the measuring range {low}...{high} is empty")
    return float(low), float(high)


class UppPyrometer:
    """A `drivers.daq.source.Source`; polled, so its readings have the host's time."""

    counted = False
    interpolation = "hold"

    def __init__(self, name: str, settings: Mapping[str, Any], context: RigContext, place: str) -> None:
        self.name, self.place = name, place
        self.settings = checked(UppSettings, settings, place)
        self.rate_hz = self.settings.poll_hz
        self.hold_s = 3.0 / self.settings.poll_hz
        self.timeouts = self.garbled = 0
        self._context = context
        self._log = WireLog(None)
        self._port: Any = None
        self._lock = threading.Lock()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None
        self._failure: DeviceError | None = None
        self._readings: deque[tuple[float, float]] = deque(maxlen=10_000)
        self._newest: tuple[float, float] | None = None
        self._judge = JumpJudge(self.settings.jump_k)
        self._range_degc = (-1000.0, 10_000.0)
        self._identity: dict[str, str] = {}
        self._findings: list[Finding] = []
        self._problem = ""

    def open(self) -> None:
        """See `AnySource.open`.

        Raises
        ------
        DeviceError
            Port or device is missing, or its emissivity is another.
        """
        settings = self.settings
        try:
            import serial
        except ImportError as error:
            raise DeviceError(
                "the library 'serial' is missing.",
                place=self.place,
                remedy="Install it: pip install pyserial.",
            ) from error
        try:
            self._port = _open_port(serial, settings)
        except (serial.SerialException, OSError, ValueError, termios.error) as error:
            raise DeviceError(
                f"the port {settings.port!r} does not open: {error}.", place=f"{self.place}.port",
                value=settings.port, remedy=port_hint(settings.port),
            ) from error  # fmt: skip
        self._log = wire_log(self._context, self.name, settings.port)
        self._failure, self._newest = None, None
        self._readings.clear()
        self._judge = JumpJudge(settings.jump_k)
        try:
            self._verify()
        except BaseException:
            self.close()
            raise
        self._stop.clear()
        self._thread = threading.Thread(target=self._run, name=f"pyrometer {self.name}", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """See `AnySource.close`."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join(2.0 + 2.0 * self.settings.answer_s)
            self._thread = None
        port, self._port = self._port, None
        if port is not None:
            port.close()
        self._log.close()
        self._say("")

    def identity(self) -> Mapping[str, str]:
        """See `AnySource.identity`."""
        return dict(self._identity)

    def channels(self) -> Sequence[ChannelSpec]:
        """See `AnySource.channels`."""
        own = self.settings
        return [ChannelSpec(own.channel, "°C", own.output_hz, description=own.description)]

    def check(self) -> None:
        """See `AnySource.check`."""
        failure = self._failure
        if failure is not None:
            raise DeviceError(failure.problem, place=failure.place, remedy=failure.remedy) from failure

    def take(self) -> Taken:
        """See `Source.take`."""
        readings = self._readings
        batch = [readings.popleft() for _ in range(len(readings))]
        if not batch:
            return NOTHING
        return Taken(np.array([when for when, _ in batch]), np.array([[degc] for _, degc in batch]))

    def convert(
        self, numbers: NDArray[np.int64], values: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """See `Source.convert`: they are temperatures already."""
        return numbers.astype(np.float64), values

    def diagnose(self, round_trips: int) -> Diagnosis:
        """See `AnySource.diagnose`."""
        self.check()
        times = measured(lambda: self._ask("ms"), round_trips)
        newest = self._newest
        spec = self.channels()[0]
        if newest is None:
            reading = Reading(spec.name, None, spec.unit, fault=self._problem or "no reading yet")
        else:
            valid = bool(np.isfinite(newest[1]))
            reading = Reading(
                spec.name, newest[1] if valid else None, spec.unit, time.monotonic() - newest[0],
                self.settings.poll_hz, "" if valid else self._problem,
            )  # fmt: skip
        return Diagnosis((reading,), times, tuple(self._findings), self.identity())

    # -- protocol -----------------------------------------------------------------------------------

    def _ask(self, command: str) -> bytes:
        """Answer to a command, without CR; empty where there was none in time."""
        import serial

        port = self._port
        if port is None:
            raise DeviceError("is not open.", place=self.place)
        request = f"{self.settings.address:02d}{command}".encode("ascii") + CR
        with self._lock:
            try:
                port.reset_input_buffer()  # a late answer to an earlier command is no answer to this one
                port.write(request)
                self._log.sent(request)
                answer = bytes(port.read_until(CR, LONGEST_ANSWER))
            except (
                serial.SerialException,
                OSError,
                termios.error,
                TypeError,
            ) as error:  # TypeError: closed under way
                raise DeviceError(
                    f"the line is gone: {error}.", place=self.place, value=self.settings.port,
                    remedy=port_hint(self.settings.port),
                ) from error  # fmt: skip
        self._log.received(answer)
        return answer[:-1] if answer.endswith(CR) else b""

    def _answer_to(self, command: str) -> bytes:
        """The same at opening, asked again where nothing came."""
        for _ in range(_OPEN_ATTEMPTS):
            answer = self._ask(command)
            if answer:
                return answer
        raise DeviceError(
            f"does not answer to {self.settings.address:02d}{command} within {self.settings.answer_s:g} s.",
            place=self.place, value=self.settings.port,
            remedy="Check power, cable, address, and baud rate (8 data bits, even parity).",
        )  # fmt: skip

    def _verify(self) -> None:
        settings = self.settings
        self._findings = []
        self._answer_to("ms")
        wanted = round(1000 * settings.emissivity)
        found = self._thousandths("em")
        if found != wanted and settings.configure:
            answer = self._answer_to(f"em{wanted:04d}")
            if answer != b"ok":
                raise DeviceError(
                    f"refuses the emissivity {settings.emissivity:g}: {answer!r}.",
                    place=f"{self.place}.emissivity", value=settings.emissivity,
                    remedy="Ask it for its limits: em?.",
                )  # fmt: skip
            change = f"emissivity changed from {found / 1000:g} to {settings.emissivity:g}."
            self._findings.append(Finding(change))
            found = self._thousandths("em")
        if found != wanted:
            raise DeviceError(
                f"is set to an emissivity of {found / 1000:g}, the rig file says {settings.emissivity:g}.",
                place=f"{self.place}.emissivity", value=found / 1000,
                remedy="Correct one of them, or allow it here: configure = true.",
            )  # fmt: skip
        self._identity = {"emissivity": f"{found / 1000:g}"}
        for key, command in (("model", "na"), ("serial", "sn"), ("firmware", "ve"), ("response_code", "ez")):
            answer = self._ask(command)
            if answer and answer != b"no":
                self._identity[key] = answer.decode("ascii", "replace").strip()
        answer = self._ask("mb")
        try:
            self._range_degc = parse_range(answer)
            self._identity["range"] = f"{self._range_degc[0]:g}...{self._range_degc[1]:g} °C"
        except ValueError:
            self._findings.append(Finding(
                f"does not tell its measuring range (mb: {answer!r}).",
                remedy="Readings are not checked against a range.",
            ))  # fmt: skip

    def _thousandths(self, command: str) -> int:
        answer = self._answer_to(command)
        if not re.fullmatch(rb"\d{4}", answer):
            raise DeviceError(
                f"answers {answer!r} to {command}.", place=self.place,
                value=answer.decode("ascii", "replace"),
                remedy="It is no UPP pyrometer, or the line is disturbed: see the wire log.",
            )  # fmt: skip
        return int(answer)

    # -- thread -------------------------------------------------------------------------------------

    def _run(self) -> None:
        period_s = 1.0 / self.settings.poll_hz
        due_s = time.monotonic()
        try:
            while not self._stop.wait(max(0.0, due_s - time.monotonic())):
                sent_s = time.monotonic()
                answer = self._ask("ms")
                # the device measured after it was asked and before it had answered
                self._take_answer(answer, 0.5 * (sent_s + time.monotonic()))
                due_s = max(due_s + period_s, time.monotonic())
        except DeviceError as error:
            self._fail(error)
        except Exception as error:  # a thread must not die silently, whatever happens
            self._fail(DeviceError(f"the polling thread failed: {error!r}.", place=self.place))

    def _take_answer(self, answer: bytes, when_s: float) -> None:
        if not answer:
            self.timeouts += 1
            return
        degc, problem = parse_temperature(answer)
        if degc is None and not _TEMPERATURE.fullmatch(answer):
            self.garbled += 1
            return
        low, high = self._range_degc
        if degc is not None and not low <= degc <= high:
            degc, problem = None, f"{degc:g} °C is outside its measuring range {low:g}...{high:g} °C"
        accepted = self._judge(degc)
        if degc is not None and accepted is None:
            problem = f"unconfirmed jump to {degc:g} °C"
        self._say("" if accepted is not None else problem)
        value = float("nan") if accepted is None else accepted
        self._newest = (when_s, value)
        self._readings.append((when_s, value))

    def _say(self, problem: str) -> None:
        if problem != self._problem:
            self._problem = problem
            self._context.board.fault(f"{self.name}: {self.settings.channel}", problem)

    def _fail(self, error: DeviceError) -> None:
        if not self._stop.is_set():
            self._failure = error
            self._say(error.problem)


def _open_port(serial: Any, settings: UppSettings) -> Any:
    """The port with 8 data bits and even parity; a pty, which has no parity bit, may refuse that one."""
    path = port_path(settings.port)
    local: dict[str, Any] = {} if "://" in path else {"exclusive": True}

    def opened(parity: str) -> Any:
        return serial.serial_for_url(
            path, baudrate=settings.baudrate, bytesize=8, parity=parity, stopbits=1,
            timeout=settings.answer_s, write_timeout=settings.answer_s, **local,
        )  # fmt: skip

    try:
        return opened("E")
    except termios.error:
        if not os.path.realpath(path).startswith("/dev/pts/"):
            raise
        return opened("N")


class JumpJudge:
    """Lets a reading pass unless it jumps from the last one; the same jump twice is believed."""

    def __init__(self, jump_k: float) -> None:
        self._jump_k = jump_k
        self._last: float | None = None
        self._candidate: float | None = None

    def __call__(self, degc: float | None) -> float | None:
        """The reading, or None where it is not (yet) believed."""
        if degc is None:
            self._candidate = None
            return None
        near = [value for value in (self._last, self._candidate) if value is not None]
        if self._last is None or any(abs(degc - value) <= self._jump_k for value in near):
            self._last, self._candidate = degc, None
            return degc
        self._candidate = degc
        return None

"""An emulated IMPAC pyrometer on the UPP protocol (universal pyrometer protocol), ASCII with carriage return.

Job: commands of the IN 5 plus manual, page 25 and its siblings: ms, em, ez, as, mb, et, lz, na, sn, ve, and
the error values instead of temperatures. Not its job: emission physics; it shows the plant's disc temperature
through its own response time.

Answers of na, sn, ve and the address 98 that every device answers are recollections.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

from sim_hardware.bench.signals import RigSignals

CR = 0x0D
LONGEST_COMMAND = 32
GLOBAL_ADDRESS = 98
OVERFLOW, NOT_READY, HEAD_TOO_HOT, HEAD_TOO_COLD = 88880, 77770, 75550, 74440
#: t90 by the digit of ez: IN 5 plus
T90_S = {0: 0.08, 1: 0.5, 2: 1.0, 3: 2.0, 4: 5.0, 5: 10.0, 6: 30.0}
RISE_90 = math.log(10.0)


class PyrometerSettings(BaseModel):
    """Settings of the emulated pyrometer."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    address: Annotated[int, Field(ge=0, le=97)] = 0
    response_s: Annotated[float, Field(ge=0, le=1)] = 0.003
    low_degc: Annotated[int, Field(ge=-100, le=3000)] = 0
    high_degc: Annotated[int, Field(ge=-100, le=3000)] = 800
    warm_up_s: Annotated[float, Field(ge=0)] = 0.0


class Pyrometer:
    """The pyrometer at its serial line; see `emulator.Emulator`."""

    def __init__(self, signals: RigSignals, settings: PyrometerSettings | None = None) -> None:
        self._signals = signals
        self._settings = settings or PyrometerSettings()
        self._command = bytearray()
        self._answer, self._answer_s = b"", float("inf")
        self._powered = True
        self._ready_s: float | None = None
        self._error = 0
        self._seen_degc = signals.newest("disc_temperature_degc")
        self._seen_s = 0.0
        self._now_s = 0.0
        self._values = {"em": 1000, "et": 1000, "ez": 0, "as": 1, "lz": 0}
        self._limits = {"em": (50, 1000), "et": (50, 1000), "ez": (0, 6), "as": (0, 1), "lz": (0, 8)}
        self._digits = {"em": 4, "et": 4, "ez": 1, "as": 1, "lz": 1}

    # -- Emulator -----------------------------------------------------------------------------------

    def receive(self, data: bytes, first_s: float, last_s: float) -> None:
        """See `Emulator.receive`."""
        if not self._powered:
            return
        for value in data:
            if value == CR:
                answer = self._execute(bytes(self._command))
                self._command.clear()
                if answer:
                    self._answer = answer.encode("ascii") + b"\r"
                    self._answer_s = last_s + self._settings.response_s
            elif len(self._command) < LONGEST_COMMAND:
                self._command.append(value)

    def advance(self, now_s: float) -> bytes:
        """See `Emulator.advance`."""
        self._now_s = now_s
        if self._ready_s is None:
            self._ready_s = now_s + self._settings.warm_up_s
        if now_s < self._answer_s:
            return b""
        answer, self._answer, self._answer_s = self._answer, b"", float("inf")
        return answer if self._powered else b""

    def due_s(self, now_s: float) -> float:
        """See `Emulator.due_s`."""
        return self._answer_s

    def command(self, request: Mapping[str, Any]) -> dict[str, Any]:
        """``{"do": "error", "value": 88880}`` (0 takes it back), ``"power"`` (with ``on``), ``"state"``."""
        action = request.get("do")
        if action == "error":
            value = int(request.get("value", 0))
            if value not in {0, OVERFLOW, NOT_READY, HEAD_TOO_HOT, HEAD_TOO_COLD}:
                raise ValueError(f"{value} is no error value of a pyrometer")
            self._error = value
        elif action == "power":
            on = bool(request.get("on", True))
            if on and not self._powered:
                self._ready_s = None
            self._powered = on
        elif action != "state":
            raise ValueError(f"the emulated pyrometer does not know the command {action!r}")
        return {"error": self._error, "powered": self._powered, **self._values}

    # -- UPP ----------------------------------------------------------------------------------------

    def _execute(self, command: bytes) -> str:
        """The answer to a command; empty where the pyrometer keeps silent."""
        text = command.decode("ascii", errors="replace")
        addresses = {f"{self._settings.address:02d}", f"{GLOBAL_ADDRESS:02d}"}
        if len(text) < 4 or not text.isascii() or text[:2] not in addresses:
            return ""
        name, argument = text[2:4], text[4:]
        if name == "ms":
            return self._measure(argument)
        if name in self._values:
            return self._value(name, argument)
        if argument:
            return "no"
        low, high = self._settings.low_degc, self._settings.high_degc
        answers = {
            "mb": f"{low & 0xFFFF:04X}{high & 0xFFFF:04X}",
            "na": "IN 5 plus bench ",
            "sn": "00590",
            "ve": "520103",
        }
        return answers.get(name, "no")

    def _value(self, name: str, argument: str) -> str:
        low, high = self._limits[name]
        width = self._digits[name]
        if not argument:
            return f"{self._values[name]:0{width}d}"
        if argument == "?":
            return f"{low:0{width}d}{high:0{width}d}"
        if len(argument) != width or not argument.isdigit() or not low <= int(argument) <= high:
            return "no"
        self._values[name] = int(argument)
        return "ok"

    def _measure(self, argument: str) -> str:
        if not argument:
            return self._reading()
        if len(argument) == 3 and argument.isdigit() and int(argument) > 0:
            return "\r".join(self._reading() for _ in range(int(argument)))
        return "no"

    def _reading(self) -> str:
        """Five digits of 1/10 degC, or an error value."""
        true_degc = self._signals.newest("disc_temperature_degc")
        tau_s = T90_S[self._values["ez"]] / RISE_90
        self._seen_degc += (true_degc - self._seen_degc) * -math.expm1((self._seen_s - self._now_s) / tau_s)
        self._seen_s = self._now_s
        if self._error:
            return f"{self._error:05d}"
        if self._ready_s is None or self._now_s < self._ready_s:
            return f"{NOT_READY:05d}"
        if self._seen_degc > self._settings.high_degc:
            return f"{OVERFLOW:05d}"
        tenths = round(10 * max(self._seen_degc, self._settings.low_degc))
        return f"-{-tenths:04d}" if tenths < 0 else f"{tenths:05d}"

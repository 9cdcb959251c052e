"""Drivers for the tests of `rigctl devices`: named in registries as "devices_drivers:Class"."""

import threading
import time
from collections.abc import Mapping
from typing import Any, ClassVar

from rigctl.core.errors import DeviceError
from rigctl.hal.diagnosis import Diagnosis, Finding, Reading, measured


class GoodDrive:
    """Records what is done to it; tells of itself."""

    calls: ClassVar[list[str]] = []
    warnings: tuple[Finding, ...] = ()
    values: tuple[Reading, ...] = (Reading("speed", 0.25, "1/min", age_s=0.01, rate_hz=20.0),)
    fault = ""

    def __init__(self, settings: Mapping[str, Any], context: Any) -> None:
        if "typo" in settings:
            raise ValueError("unknown setting 'typo'")
        self.context = context

    def open(self) -> None:
        self.calls.append("open")
        if self.fault:
            self.context.board.fault("drive", self.fault)

    def close(self) -> None:
        self.calls.append("close")

    def identity(self) -> Mapping[str, str]:
        return {"maker": "Test", "model": "M1"}

    def diagnose(self, round_trips: int) -> Diagnosis:
        self.calls.append(f"diagnose {round_trips}")
        times = measured(lambda: None, round_trips)
        return Diagnosis(self.values, times, self.warnings, self.identity())

    def __getattr__(self, name: str) -> Any:
        raise AssertionError(f"{name} must not be used at bring-up")


class PlainSafety:
    """Has no `diagnose`."""

    def __init__(self, settings: Mapping[str, Any], context: Any) -> None: ...

    def open(self) -> None: ...

    def close(self) -> None: ...

    def identity(self) -> Mapping[str, str]:
        return {"model": "plain"}

    def status(self) -> Any:
        from rigctl.hal.devices import SafetyStatus

        return SafetyStatus(relay_closed=False, estop_ok=True, doors_ok=True)


class Silent(PlainSafety):
    """Does not answer."""

    def open(self) -> None:
        raise DeviceError("no answer within 0.5 s.", place="/dev/ttyUSB7", remedy="Check its power.")


class Crashing(PlainSafety):
    """Has a fault in its code."""

    def open(self) -> None:
        raise KeyError("serial number")


class Flaky(GoodDrive):
    """Answers at first, then not, then again after it has been opened anew."""

    opened = 0
    closed = threading.Event()

    def open(self) -> None:
        type(self).opened += 1
        self.asked = 0

    def close(self) -> None:
        self.closed.set()

    def diagnose(self, round_trips: int) -> Diagnosis:
        self.asked += 1
        if self.opened == 1 and self.asked > 2:
            raise DeviceError("has fallen silent.", place="/dev/ttyUSB0", remedy="Check the cable.")
        return Diagnosis((Reading("times opened", self.opened),))


class Hanging(GoodDrive):
    """Answers very late."""

    def open(self) -> None: ...

    def close(self) -> None: ...

    def diagnose(self, round_trips: int) -> Diagnosis:
        time.sleep(1.5)
        return Diagnosis((Reading("late", True),))

"""One device of a rig file by itself: make it, open it, let it tell, close it; every failure is a finding.

Job: `examine` for `devices test`, and what `devices monitor` shares with it (`RigFile`, `ask`). Nothing that
one device does wrong, not even a fault in its code, reaches the others. Not its job: printing; safe
set-points (a device is in its safe state after `open`, that is the contract of `rigctl.hal.devices`).
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Any

from rigctl.app import compose
from rigctl.app.devices.fallback import diagnose_plain
from rigctl.config.rig import DeviceConfig, RigConfig
from rigctl.core.errors import ConfigError, RigctlError
from rigctl.core.registry import Registry
from rigctl.hal.devices import RigContext
from rigctl.hal.diagnosis import Diagnosable, Diagnosis, Finding, Timing, timing

SIMULATED = "sim_hardware."
SLOW_S = 0.05


class Result(StrEnum):
    """How a device came through its test."""

    OK = "ok"
    WARNING = "warning"
    FAILED = "failed"
    SIMULATED = "simulated"


@dataclass(frozen=True, slots=True)
class DeviceReport:
    """What the test of one device found.

    Attributes
    ----------
    role, kind, target : str
        As in rig file and registry; `target` is "" where the kind is not known.
    place : str
        "FILE: devices.ROLE".
    result : Result
    findings : tuple of Finding
        What to do; those with `unsafe`, and errors, make the result "failed".
    diagnosis : Diagnosis or None
        None where the device could not be opened.
    timing : Timing or None
        Statistics of its round trips.
    """

    role: str
    kind: str
    target: str
    place: str
    result: Result
    findings: tuple[Finding, ...] = ()
    diagnosis: Diagnosis | None = None
    timing: Timing | None = None


def _kinds() -> Registry:
    return compose.registry()


@dataclass(frozen=True, slots=True)
class RigFile:
    """A rig file that has been read, with the kinds of devices."""

    path: Path
    config: RigConfig
    kinds: Registry = field(default_factory=_kinds)

    @classmethod
    def read(cls, path: Path) -> RigFile:
        """Raises `ConfigError` for a file that is wrong as a whole."""
        return cls(path, compose.read_rig(path))

    def device(self, role: str) -> DeviceConfig:
        """The device of a role."""
        return getattr(self.config.devices, role)

    def place(self, role: str) -> str:
        """How messages name it."""
        return f"{self.path}: devices.{role}"

    def target(self, role: str) -> str:
        """ "module:Class" of its kind. Raises `ConfigError` for an unknown one."""
        return self.kinds.target(role, self.device(role).kind, place=f"{self.place(role)}.kind")

    def context(self, run_dir: Path, wire_log_dir: Path | None) -> RigContext:
        """A context whose lease is never in force: no device renews a set-point."""
        return RigContext(
            run_dir, "real", None, str(self.path), self.path.resolve().parent,
            log_dir=wire_log_dir, wire_log_dir=wire_log_dir,
            buses={name: bus.settings for name, bus in self.config.buses.items()},
        )  # fmt: skip

    def make(self, role: str, context: RigContext) -> Any:
        """The device, its settings checked, not opened."""
        device = self.device(role)
        cls = self.kinds.load(role, device.kind, place=f"{self.place(role)}.kind")
        try:
            return cls(device.settings, context)
        except (TypeError, ValueError) as error:
            raise ConfigError(f"{error}.", place=self.place(role)) from error


def examine(
    rig: RigFile, role: str, *, round_trips: int, run_dir: Path, wire_log_dir: Path | None
) -> DeviceReport:
    """Test the device of a role; never raises for what the device does."""
    kind, place = rig.device(role).kind, rig.place(role)
    target = ""
    diagnosis: Diagnosis | None = None
    problems: list[Finding] = []
    failed = False
    try:
        target = rig.target(role)
        context = rig.context(run_dir, wire_log_dir)
        device = rig.make(role, context)
        if target.startswith(SIMULATED):
            return DeviceReport(role, kind, target, place, Result.SIMULATED)
        try:
            device.open()
            diagnosis = ask(device, role, round_trips)
            problems += _faults_on(context)
            failed = bool(problems)
        finally:
            device.close()
    except Exception as error:
        failed = True
        problems.append(explained(error, place, target))
    times = timing(diagnosis.round_trip_s) if diagnosis else None
    if diagnosis is not None:
        problems += [
            Finding(f"{reading.name}: {reading.fault}.") for reading in diagnosis.values if reading.fault
        ]
        problems += diagnosis.warnings
        problems += _slow(times)
        failed = failed or any(finding.unsafe for finding in diagnosis.warnings)
    result = Result.FAILED if failed else Result.WARNING if problems else Result.OK
    return DeviceReport(role, kind, target, place, result, tuple(problems), diagnosis, times)


def ask(device: Any, role: str, round_trips: int) -> Diagnosis:
    """What an open device tells of itself: by its own `diagnose`, else by the plain interface of its role."""
    if isinstance(device, Diagnosable):
        return device.diagnose(round_trips)
    return diagnose_plain(device, role)


def explained(error: Exception, place: str, target: str) -> Finding:
    """An error as one clear sentence that names the device in the rig file, and what to do."""
    if isinstance(error, RigctlError):
        named = error.within(place)
        return Finding(f"{named.place}: {named.problem}", named.remedy)
    return Finding(
        f"{place}: {type(error).__name__}: {error}.",
        f"This is a fault in the driver {target}, not in the rig: report it with this line.",
    )


@contextmanager
def run_folder() -> Iterator[Path]:
    """A private folder for sample rings, in memory where there is /dev/shm."""
    shm = Path("/dev/shm")
    try:
        folder = tempfile.TemporaryDirectory(
            prefix="rigctl-devices-", dir=shm if shm.is_dir() else None, ignore_cleanup_errors=True
        )
    except OSError:
        folder = tempfile.TemporaryDirectory(prefix="rigctl-devices-", ignore_cleanup_errors=True)
    with folder as name:
        yield Path(name)


def _faults_on(context: RigContext) -> list[Finding]:
    faults = context.board.snapshot().get("faults", {})
    return [Finding(f"{device} reports a fault: {problem}.") for device, problem in faults.items()]


def _slow(times: Timing | None) -> Sequence[Finding]:
    if times is None or times.p99_s <= SLOW_S:
        return ()
    return (
        Finding(
            f"answers take up to {times.p99_s * 1e3:.0f} ms (p99), a block has {SLOW_S * 1e3:.0f} ms.",
            "Raise the baud rate, or lower the adapter's latency timer (setserial PORT low_latency).",
        ),
    )

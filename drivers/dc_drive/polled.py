"""A speed drive that one thread polls: what all serial drives have in common.

Job: implement `rigctl.hal.devices.SpeedDrive` on a `DriveLink`. The thread sends the whole wish and reads the
state many times a second. Torque is taken away, the reason kept for the next call and put on the board, when

* the control loop stops asking for blocks (the lease),
* the drive trips, takes its torque away by itself (safe torque off), or does not start in time,
* the link fails for longer than its deadline; then the drive's own supervision stops it too, the driver
reconnects
  by itself, and commands "torque off" first.

Torque comes back only by `enable`. Not its job: bytes and codes (`modbus_link`, `eurotherm_link`).
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Mapping
from dataclasses import replace

from drivers.dc_drive.words import DriveLink, DriveState, LinkError, Report, Torque, Trip, Wish
from rigctl.core.errors import DeviceError, RigctlError
from rigctl.hal.bench_paths import port_hint
from rigctl.hal.devices import RigContext
from rigctl.hal.diagnosis import Diagnosis, Finding, Reading, measured
from rigctl.hal.wirelog import wire_log

LEASE_S = 0.25
START_TIMEOUT_S = 1.5
STOP_TIMEOUT_S = 1.0
RECONNECT_S = 0.25
#: `actual_rpm` older than this is no value any more.
STALE_S = 0.5
#: While the drive starts, cycles follow each other this closely.
BUSY_PERIOD_S = 0.005


class PolledDrive:
    """A drive behind a link.

    Parameters
    ----------
    link : DriveLink
    context : RigContext
    port : str
        As in the rig file, for messages.
    period_s : float
        Time from one cycle to the next.
    """

    name = "drive"

    def __init__(self, link: DriveLink, context: RigContext, *, port: str, period_s: float) -> None:
        self._link = link
        self._context = context
        self._lease = context.lease
        self._board = context.board
        self._port = port
        self._period_s = period_s
        self._place = f"{self.name} on {port}"
        self._lock = threading.Lock()  # of the wish and all that the thread reports
        self._link_lock = threading.RLock()  # one user of the link at a time
        self._wake = threading.Event()
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None
        self._reset_state()

    def _reset_state(self) -> None:
        self._wish = Wish()
        self._asked = 0  # counts enable, disable, quick stop and failures
        self._started = False  # the drive has reported "running" since `enable`
        self._enabled_s = 0.0
        self._report: Report | None = None
        self._report_s = float("-inf")
        self._trip: Trip | None = None
        self._error: DeviceError | None = None
        self._healthy = False
        self._identity: Mapping[str, str] = {}
        self._findings: list[Finding] = []
        self._cycles = 0
        self._opened_s = 0.0

    # -- Device -------------------------------------------------------------------------------------

    def open(self) -> None:
        """See `Device.open`: torque is off when it returns.

        Raises
        ------
        DeviceError
            The port is not there, the drive does not answer, or it keeps its torque.
        """
        self._reset_state()
        self._stop.clear()
        self._link.log = wire_log(self._context, self.name, self._port)
        try:
            self._link.connect()
            self._identity = dict(self._link.identity())
            self._findings = self._link.findings()
            self._command_off()
        except LinkError as error:
            self._hang_up()
            raise DeviceError(f"{error}.", place=self._place, remedy=port_hint(self._port)) from error
        except RigctlError:
            self._hang_up()
            raise
        self._healthy = True
        self._opened_s = time.monotonic()
        self._thread = threading.Thread(target=self._run, name=f"{self.name}-poll", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """See `Device.close`."""
        thread, self._thread = self._thread, None
        if thread is None:
            return
        with self._lock:
            self._wish = Wish()
        self._stop.set()
        self._wake.set()
        thread.join()
        with self._link_lock:
            try:
                self._command_off()
            except (LinkError, DeviceError):
                pass  # it is gone or keeps its torque: its own supervision and the safety relay do the rest
            self._hang_up()
        self._board.set(enabled=False)

    def _hang_up(self) -> None:
        self._link.disconnect()
        self._link.log.close()

    def identity(self) -> Mapping[str, str]:
        """See `Device.identity`."""
        return {**self._identity, "port": self._port}

    def diagnose(self, round_trips: int) -> Diagnosis:
        """See `rigctl.hal.diagnosis`."""
        times: list[float] = []
        if round_trips > 0:
            try:
                with self._link_lock:
                    times = list(measured(self._link.status_exchange, round_trips))
                    self._findings = self._link.findings()
                    self._cycle()  # the thread had to wait: its report is old by now
            except LinkError as error:
                raise DeviceError(f"{error}.", place=self._place, remedy=port_hint(self._port)) from error
        with self._lock:
            report, age_s, error = self._report, time.monotonic() - self._report_s, self._error
        stale = "" if report is not None and age_s <= STALE_S else f"no answer for {age_s:.1f} s"
        lived_s = time.monotonic() - self._opened_s
        polled = lived_s > 0 and round_trips == 0  # those exchanges took the place of cycles
        rate_hz = self._cycles / lived_s if polled else None
        fault = stale or (str(error) if error else "")
        values = (
            Reading(
                "speed", report.actual_rpm if report and not stale else None, "1/min", age_s, rate_hz, stale
            ),
            Reading("state", report.state.value if report and not stale else None, "", age_s, None, fault),
            Reading("status word", f"{report.status:04X}h" if report else None, "", age_s, None, stale),
            Reading("retries", self._link.retries),
        )
        return Diagnosis(values, times, tuple(self._findings), self.identity())

    # -- SpeedDrive ---------------------------------------------------------------------------------

    @property
    def commanded_rpm(self) -> float:
        """See `SpeedDrive.commanded_rpm`."""
        return self._wish.speed_rpm

    @property
    def enabled(self) -> bool:
        """See `SpeedDrive.enabled`."""
        return self._wish.torque is not Torque.OFF

    @property
    def actual_rpm(self) -> float:
        """Speed as the drive reports it. Raises `DeviceError` when it is not fresh."""
        with self._lock:
            report, age_s = self._report, time.monotonic() - self._report_s
        if report is None or age_s > STALE_S:
            raise DeviceError(
                f"has not reported its speed for {age_s:.2f} s.", place=self._place,
                remedy=port_hint(self._port),
            )  # fmt: skip
        return report.actual_rpm

    def enable(self) -> None:
        """See `SpeedDrive.enable`. It only begins the start; what goes wrong later comes with the next call.

        Raises
        ------
        DeviceError
            A fault is waiting, a setting of the drive is dangerous, it is tripped or in local control, or the
            control loop is not running.
        """
        self._raise_error()
        unsafe = [finding for finding in self._findings if finding.unsafe]
        if unsafe:
            raise DeviceError(
                "refuses to enable: " + " ".join(str(finding) for finding in unsafe), place=self._place
            )
        if not self._lease.in_force(LEASE_S):
            raise DeviceError(
                "refuses to enable: the control loop is not running.", place=self._place,
                remedy="Ask the rig for blocks first.",
            )  # fmt: skip
        with self._lock:
            report, trip = self._report, self._trip
            if report is not None and not report.remote:
                raise DeviceError(
                    "refuses to enable: the drive is in local control.", place=self._place,
                    value=report.status, remedy="Press LOC/REM on its panel.",
                )  # fmt: skip
            if trip is not None and not trip.resettable:
                raise DeviceError(
                    f"refuses to enable: tripped: {trip}.", place=self._place, value=trip.code,
                    remedy="Remove the cause and reset the trip on the drive's panel.",
                )  # fmt: skip
            self._ask(Torque.ON, reset=trip is not None)
            self._started = False
            self._enabled_s = time.monotonic()
        self._wake.set()

    def disable(self) -> None:
        """See `SpeedDrive.disable`."""
        with self._lock:
            self._ask(Torque.OFF)
        self._wake.set()
        self._raise_error()

    def set_speed(self, speed_rpm: float, ramp_rpm_per_s: float) -> None:
        """See `SpeedDrive.set_speed`.

        Raises
        ------
        DeviceError
            Not a number, beyond the drive's range, a speed without `enable`, or a fault is waiting.
        """
        problem = (
            "set-points must be finite numbers."
            if not (math.isfinite(speed_rpm) and math.isfinite(ramp_rpm_per_s))
            else self._link.check_setpoint(speed_rpm, ramp_rpm_per_s)
        )
        if problem:
            raise DeviceError(
                f"refuses {speed_rpm} 1/min at {ramp_rpm_per_s} 1/min per s.", place=self._place,
                value=(speed_rpm, ramp_rpm_per_s), remedy=problem,
            )  # fmt: skip
        if speed_rpm != 0:
            self._raise_error()
        with self._lock:
            torque = self._wish.torque
            if torque is Torque.ON or speed_rpm == 0:
                self._wish = Wish(torque, speed_rpm, ramp_rpm_per_s, self._wish.reset)
        self._wake.set()
        self._raise_error()
        if speed_rpm != 0 and torque is not Torque.ON:
            raise DeviceError(
                f"refuses {speed_rpm} 1/min: the drive is not enabled.", place=self._place, value=speed_rpm,
                remedy="Call enable() first; after a quick stop too.",
            )  # fmt: skip

    def quick_stop(self) -> None:
        """See `SpeedDrive.quick_stop`."""
        with self._lock:
            if self._wish.torque is Torque.ON:
                self._ask(Torque.QUICK_STOP)
        self._wake.set()
        self._raise_error()

    # -- the thread ---------------------------------------------------------------------------------

    def _run(self) -> None:
        try:
            while not self._stop.is_set():
                began_s = time.monotonic()
                self._check_lease()
                try:
                    with self._link_lock:
                        self._cycle()
                except LinkError as error:
                    self._fail(f"the link failed: {error}.", remedy=port_hint(self._port))
                    self._healthy = False
                    self._reconnect()
                busy = self._wish.torque is Torque.ON and not self._started
                period_s = BUSY_PERIOD_S if busy else self._period_s
                self._wake.wait(max(began_s + period_s - time.monotonic(), 0.0))
                self._wake.clear()
        except Exception as error:
            self._healthy = False
            self._fail(f"the driver's thread ended: {type(error).__name__}: {error}.",
                       remedy="This is a fault of the program: report it with the log.")  # fmt: skip

    def _cycle(self) -> None:
        with self._lock:
            wish, asked = self._wish, self._asked
        report = self._link.cycle(wish)
        tripped = report.state is DriveState.TRIPPED
        trip = self._trip
        if tripped and trip is None:
            trip = self._link.trip()
        with self._lock:
            self._report, self._report_s = report, time.monotonic()
            self._trip = trip if tripped else None
            self._cycles += 1
            same = self._asked == asked
        self._board.set(enabled=report.state is DriveState.RUNNING, drive_rpm=report.actual_rpm)
        if same:
            self._judge(wish, report, asked)

    def _judge(self, wish: Wish, report: Report, asked: int) -> None:
        """Compare what the drive does with what it should."""
        if wish.torque is Torque.OFF:
            if self._trip is not None and not self._trip.resettable:
                self._board.fault(self.name, f"tripped: {self._trip}")
            elif self._error is None:
                self._board.fault(self.name, "")
            return
        if wish.torque is Torque.QUICK_STOP:
            if report.state in {DriveState.OFF, DriveState.INHIBITED}:
                with self._lock:
                    if self._asked == asked:
                        self._ask(Torque.OFF)
            elif report.state is DriveState.TRIPPED:
                self._fail(f"tripped during the quick stop: {self._trip}.", remedy="See the drive's panel.")
            return
        self._judge_running(wish, report, asked)

    def _judge_running(self, wish: Wish, report: Report, asked: int) -> None:
        """The same while it should run."""
        waited_s = time.monotonic() - self._enabled_s
        if report.state is DriveState.RUNNING:
            self._started = True
            if wish.reset:
                with self._lock:
                    if self._asked == asked:
                        self._wish = replace(self._wish, reset=False)
        elif report.state is DriveState.TRIPPED and (self._started or not wish.reset):
            self._fail(
                f"tripped: {self._trip}.", remedy="Remove the cause, reset the drive, enable it again."
            )
        elif self._started:
            self._fail(
                f"took its torque away by itself: {report.state.value}, status {report.status:04X}h.",
                remedy="Look at the safety relay and the drive's panel, then enable it again.",
            )
        elif waited_s > START_TIMEOUT_S:
            self._fail(
                f"did not start within {START_TIMEOUT_S:g} s: {report.state.value}, "
                f"status {report.status:04X}h.",
                remedy="Look at the safety relay, the drive's start interlocks and its panel.",
            )

    def _check_lease(self) -> None:
        if self._wish.torque is not Torque.OFF and not self._lease.in_force(LEASE_S):
            self._fail(f"torque taken away: the control loop has not asked for a block for {LEASE_S:g} s.",
                       remedy="Enable the drive again when it does.")  # fmt: skip

    def _fail(self, problem: str, *, remedy: str) -> None:
        """Torque off, and the reason for whoever asks."""
        with self._lock:
            if self._error is None:
                self._error = DeviceError(problem, place=self._place, remedy=remedy)
            self._ask(Torque.OFF)
        self._board.fault(self.name, problem)

    def _ask(self, torque: Torque, *, reset: bool = False) -> None:
        """A new wish at zero speed; the lock is held."""
        self._wish = Wish(torque, 0.0, self._wish.ramp_rpm_per_s, reset)
        self._asked += 1

    def _reconnect(self) -> None:
        """Until the drive answers and its torque is off, or the device is closed."""
        self._board.set(enabled=False)
        while not self._stop.is_set():
            with self._link_lock:
                self._link.disconnect()
            self._stop.wait(RECONNECT_S)
            with self._link_lock:
                try:
                    self._link.connect()
                    self._command_off()
                    self._healthy = True
                    return
                except (LinkError, DeviceError):
                    pass  # the first error is on the board already and stays the one to report

    def _command_off(self) -> None:
        """Torque off, confirmed by the drive."""
        until_s = time.monotonic() + STOP_TIMEOUT_S
        while True:
            report = self._link.cycle(Wish())
            with self._lock:
                self._report, self._report_s = report, time.monotonic()
                self._trip = self._link.trip() if report.state is DriveState.TRIPPED else None
            if report.state not in {DriveState.RUNNING, DriveState.STOPPING}:
                return
            if time.monotonic() > until_s:
                raise DeviceError(
                    f"keeps its torque although it is told to take it away: status {report.status:04X}h.",
                    place=self._place, value=report.status,
                    remedy="Open the safety relay. Is it in local control? Does another master command it?",
                )  # fmt: skip
            time.sleep(BUSY_PERIOD_S)

    def _raise_error(self) -> None:
        """Raise what the thread remembered, once; as long as the drive does not answer, every time."""
        with self._lock:
            error = self._error
            if error is not None and self._healthy:
                self._error = None
        if error is not None:
            raise error

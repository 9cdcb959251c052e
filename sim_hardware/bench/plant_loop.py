"""The bench's plant in real time: steps of 10 ms against absolute deadlines.

Job: take the devices' commands from `RigSignals`, step the plant, put its samples back at 1 kHz, hand the
sound's jobs on. A late wake-up is made up for step by step, so rig time never drifts from the clock. Not its
job: physics (`sim_hardware.plant`), rendering of sound (`microphone`), devices.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from queue import SimpleQueue

from rigctl.core.channels import DISC_TEMPERATURE, PRESSURE, SPEED, TORQUE
from rigctl.core.errors import RigctlError
from sim_hardware.bench.signals import NS_PER_MS, RigSignals
from sim_hardware.plant import Commands, Plant, SoundJob, behind_relay
from sim_hardware.plant.layout import TRACK

STEP_NS = 10 * NS_PER_MS
STEP_S = 1e-9 * STEP_NS
#: More than this behind (the machine slept): the time is given up, and counted.
MAX_BEHIND_NS = 2_000_000_000
SAMPLES = 10  # of a step at 1 kHz
_STRIDE = 4  # 4 kHz to 1 kHz
_TURN = 2.0 * math.pi
_ANGLE, _OMEGA = TRACK.index("angle"), TRACK.index("omega")


@dataclass
class LoopCounts:
    """How well the loop keeps time.

    Attributes
    ----------
    steps : int
        Done so far.
    given_up : int
        Steps never done, since the process did not run for seconds.
    latest_ms : float
        The largest lateness of a step since the last `PlantLoop.counts`.
    """

    steps: int = 0
    given_up: int = 0
    latest_ms: float = 0.0


class PlantLoop:
    """A thread that is the rig.

    Parameters
    ----------
    plant : Plant
        Compiled; the loop is its only user.
    signals : RigSignals
    sound : callable
        Takes the sound's job of each step; must not wait.
    failed : callable
        Called once, from the thread, when it cannot go on.
    """

    def __init__(
        self,
        plant: Plant,
        signals: RigSignals,
        *,
        sound: Callable[[SoundJob], None] | None = None,
        failed: Callable[[BaseException], None] | None = None,
    ) -> None:
        self._plant, self._signals = plant, signals
        self._sound, self._failed = sound, failed
        self._counts = LoopCounts()
        self._turns = 0  # whole turns of the shaft so far
        self._posted: SimpleQueue[Callable[[Plant], None]] = SimpleQueue()
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="plant", daemon=True)

    def start(self) -> None:
        """Let the rig live."""
        self._thread.start()

    def stop(self) -> None:
        """End it; returns when the thread has ended."""
        self._stop.set()
        if self._thread.is_alive() and self._thread is not threading.current_thread():
            self._thread.join()

    def post(self, action: Callable[[Plant], None]) -> None:
        """Do something to the plant before its next step, in the thread of the loop."""
        self._posted.put(action)

    def counts(self) -> dict[str, float]:
        """Time keeping so far, and the largest lateness since the last call."""
        found = asdict(self._counts)
        self._counts.latest_ms = 0.0
        return found

    def step(self, end_ns: int) -> None:
        """One step of the rig, which ends at this time."""
        while not self._posted.empty():
            self._posted.get()(self._plant)
        given = self._signals.commands()
        wanted = Commands(
            speed_set_rpm=given.speed_set_rpm,
            speed_ramp_rpm_per_s=given.speed_ramp_rpm_per_s,
            drive_enabled=given.drive_enabled,
            quick_stop=given.quick_stop,
            pressure_set_bar=given.pressure_set_bar,
            vent=given.vent,
            ventilator_m3_h=given.ventilator_m3_h,
        )
        # e-stop and doors are wired in series with the relay's contact
        closed = given.relay_closed and given.estop_ok and given.doors_ok
        commands = behind_relay(wanted, closed=closed, ventilator_max_m3_h=self._plant.ventilator_max_m3_h)
        result = self._plant.step(STEP_NS, commands, full_rate=True)
        job = self._plant.take_sound_job()
        if job is None:  # `full_rate` promises one
            raise RuntimeError("the plant gave no course of the step")
        samples = result.samples
        self._signals.publish(
            end_ns,
            torque_nm=samples[TORQUE][::_STRIDE].tolist(),
            pressure_bar=samples[PRESSURE][::_STRIDE].tolist(),
            speed_rpm=samples[SPEED][::_STRIDE].tolist(),
            disc_temperature_degc=samples[DISC_TEMPERATURE][::_STRIDE].tolist(),
            position_turns=self._positions(job),
            regulator_pressure_bar=[result.safety["p"][-1]] * SAMPLES,
            drive_speed_rpm=[result.safety["n"][-1]] * SAMPLES,
            motor_torque_nm=[self._plant.truth.motor_torque_nm] * SAMPLES,
        )
        if self._sound is not None:
            self._sound(job)

    def _positions(self, job: SoundJob) -> list[float]:
        """Shaft position in turns at 1 kHz: between the ends of the step by angle and speed there (cubic)."""
        first, last = job[0][0], job[0][-1]
        start, end = float(first[_ANGLE]), float(last[_ANGLE])
        w0, w1 = float(first[_OMEGA]), float(last[_OMEGA])
        # the plant's angle begins anew with each turn; a step may hold several turns at very high speed
        turns = round((start + 0.5 * (w0 + w1) * STEP_S - end) / _TURN)
        delta = end + turns * _TURN - start
        base = self._turns * _TURN + start
        positions: list[float] = []
        for i in range(SAMPLES):
            x = i / SAMPLES
            course = delta * x * x * (3.0 - 2.0 * x)
            course += STEP_S * x * (1.0 - x) * (w0 * (1.0 - x) - w1 * x)
            positions.append((base + course) / _TURN)
        self._turns += turns
        return positions

    def _run(self) -> None:
        due_ns = (time.monotonic_ns() // STEP_NS + 1) * STEP_NS
        try:
            while True:
                wait_ns = due_ns - time.monotonic_ns()
                if self._stop.is_set() or (wait_ns > 0 and self._stop.wait(1e-9 * wait_ns)):
                    return
                behind_ns = max(time.monotonic_ns() - due_ns, 0)
                self._counts.latest_ms = max(self._counts.latest_ms, 1e-6 * behind_ns)
                if behind_ns > MAX_BEHIND_NS:
                    missed = behind_ns // STEP_NS
                    self._counts.given_up += missed
                    due_ns += missed * STEP_NS
                self.step(due_ns)
                self._counts.steps += 1
                due_ns += STEP_NS
        except (RigctlError, ValueError, ArithmeticError, RuntimeError, LookupError) as error:
            if self._failed is None:
                raise
            self._failed(error)

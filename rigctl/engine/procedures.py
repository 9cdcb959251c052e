"""What a test engineer does by hand, as block-driven scripts: spin up, brake, release, run down.

Job: each procedure is a generator. It sets set-points, then ``block = yield`` waits for the next block of
samples. Nothing here sleeps or looks at a wall clock. Not its job: order of brakings, pause and abort
(`rigctl.engine.engine`), how a temperature is reached (`rigctl.engine.conditioning`), limits (watchdog).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from rigctl.core.blocks import Block
from rigctl.core.channels import DISC_TEMPERATURE, PRESSURE, SPEED
from rigctl.core.errors import RunError
from rigctl.engine.conditioning import Air, Conditioner, Script, wait
from rigctl.engine.state import BreakOff, Progress
from rigctl.hal.rig import Rig
from sequences.braking import Braking, Conditioning

REST_PRESSURE_BAR = 0.8
REST_SPEED_RPM = 1.0
RELEASE_TIMEOUT_S = 5.0
RUN_DOWN_TIMEOUT_S = 60.0
SPIN_UP_TIMEOUT_S = 60.0
SPIN_UP_TOLERANCE = (1.0, 0.02)  # 1/min, share of the set-point
SPIN_UP_SETTLE_S = 0.5


class Recorder(Protocol):
    """What the procedures need of the recorder process (`rigctl.recording.client.RecorderClient`)."""

    def begin(self, specification: Mapping[str, Any], *, t0_s: float) -> None:
        """A braking starts; blocks follow."""
        ...

    def block(self, block: Block) -> None:
        """One more block of the present braking."""
        ...

    def mark(self, name: str, t_s: float, **values: Any) -> None:
        """Something to remember at a rig time, e.g. the onset of pressure."""
        ...

    def end(self, status: str = "complete", note: str = "") -> None:
        """The braking is over: "complete" or "incomplete"."""
        ...


class Procedures:
    """Scripts for one rig. `progress.phase` always says in words what is going on."""

    def __init__(self, rig: Rig, recorder: Recorder, progress: Progress) -> None:
        self._rig = rig
        self._recorder = recorder
        self._progress = progress
        self._config = rig.config.conditioning
        self._can = rig.config.capabilities
        self._ramp = self._can.max_speed_rate_rpm_s
        self._air = Air(rig)
        self._conditioner = Conditioner(rig, self._air, progress)
        self.recording = False

    def end_recording(self, status: str, note: str = "") -> None:
        """The present braking is over for the recorder."""
        self.recording = False
        self._recorder.end(status, note)

    # -- one braking ----------------------------------------------------------------------------

    def spin_up(self, speed_rpm: float, *, ventilator: bool) -> Script:
        """Bring the released disc to speed and let the air come to rest.

        Raises
        ------
        RunError
            The drive did not reach the speed.
        """
        self._progress.phase = f"spinning up to {speed_rpm:.0f} 1/min"
        self._rig.request(dt_s=self._config.idle_block_s, recording=False)
        self._rig.pressure.set_pressure(0.0)
        self._rig.drive.set_speed(speed_rpm, self._ramp)
        block = yield
        if ventilator:
            self._air.blow(self._config.ventilator_m3_h)
        else:
            self._air.stop(block)
        deadline_s = block.end_s + SPIN_UP_TIMEOUT_S
        tolerance_rpm = max(SPIN_UP_TOLERANCE[0], SPIN_UP_TOLERANCE[1] * speed_rpm)
        settled_s = 0.0
        while settled_s < SPIN_UP_SETTLE_S or not (ventilator or self._air.still(block)):
            block = yield
            deviation_rpm = abs(block.mean(SPEED) - speed_rpm)
            settled_s = settled_s + block.dt_s if deviation_rpm <= tolerance_rpm else 0.0
            if block.end_s > deadline_s:
                raise RunError(
                    f"the drive did not reach {speed_rpm:g} 1/min within {SPIN_UP_TIMEOUT_S:g} s.",
                    place="spin up", remedy="Look at the drive's ramp settings and its current limit.",
                )  # fmt: skip

    def brake(self, braking: Braking) -> Script:
        """Record: background before, the braking with its profiles, and the release after it.

        Raises
        ------
        BreakOff
            The disc became hotter than the sequence allows.
        """
        rig, step_s = self._rig, self._rig.config.block_s
        self._progress.phase = f"braking with {braking.pressure_bar:g} bar"
        rig.request(dt_s=step_s, recording=True)
        block = yield
        self._recorder.begin(braking.model_dump(mode="json"), t0_s=block.t_s)
        self.recording = True
        self._recorder.block(block)
        for _ in range(max(round(braking.recording.pre_s / step_s) - 1, 0)):
            block = yield
            self._recorder.block(block)
        self._recorder.mark("pressure_onset", block.end_s, temperature_degc=block.mean(DISC_TEMPERATURE))
        for pressure_bar, speed_rpm, ramp_rpm_per_s in self._course(braking):
            rig.pressure.set_pressure(pressure_bar)
            rig.drive.set_speed(speed_rpm, ramp_rpm_per_s)
            block = yield
            self._recorder.block(block)
            degc = block.mean(DISC_TEMPERATURE)
            if degc > braking.limits.max_degc:
                raise BreakOff(None, f"disc at {degc:.0f} °C, above max_degc {braking.limits.max_degc:g} °C")
        self._progress.phase = "releasing"
        self._recorder.mark("pressure_release", block.end_s)
        rig.pressure.set_pressure(0.0)
        for _ in range(round(braking.recording.post_s / step_s)):
            block = yield
            self._recorder.block(block)
        self.end_recording("complete")

    def _course(self, braking: Braking) -> list[tuple[float, float, float]]:
        """Set-points of each block: pressure at its middle, speed at its end, and the ramp to it."""
        step_s = self._rig.config.block_s
        course: list[tuple[float, float, float]] = []
        for i in range(round(braking.duration_s / step_s)):
            start_rpm = braking.speed_setpoint_rpm(i * step_s)
            end_rpm = braking.speed_setpoint_rpm((i + 1) * step_s)
            ramp = abs(end_rpm - start_rpm) / step_s
            pressure_bar = braking.pressure_setpoint_bar((i + 0.5) * step_s)
            course.append((pressure_bar, end_rpm, ramp if ramp > 0.0 else self._ramp))
        return course

    def release(self) -> Script:
        """Pressure to zero; wait until it is gone.

        Raises
        ------
        RunError
            Pressure remains.
        """
        self._progress.phase = "releasing"
        self._rig.request(dt_s=self._config.idle_block_s, recording=False)
        self._rig.pressure.set_pressure(0.0)
        block = yield
        deadline_s = block.end_s + RELEASE_TIMEOUT_S
        while block.mean(PRESSURE) > REST_PRESSURE_BAR:
            if block.end_s > deadline_s:
                raise RunError(
                    f"{block.mean(PRESSURE):.1f} bar remain {RELEASE_TIMEOUT_S:g} s after the release.",
                    place="release", remedy="Check the vent valve.",
                )  # fmt: skip
            block = yield

    def condition(self, target_degc: float, how: Conditioning) -> Script:
        """Bring the disc to a temperature; see `Conditioner.condition`."""
        yield from self._conditioner.condition(target_degc, how)

    def cool_down(self, target_degc: float, timeout_s: float) -> Script:
        """After `max_degc` was passed: cool to the cool-down temperature before anything else."""
        yield from self._conditioner.condition(
            target_degc, Conditioning(mode="at_most", soak_s=0.0, timeout_s=timeout_s)
        )

    def dwell(self, seconds: float) -> Script:
        """Do nothing for a while, turning slowly."""
        if seconds > 0.0:
            self._progress.phase = "dwelling"
            block = yield
            yield from wait(seconds, block)

    def run_down(self) -> Script:
        """Vent, stop, ventilator off: the way out of every run.

        Raises
        ------
        RunError
            The rig does not come to rest.
        """
        self._progress.phase = "stopping"
        self._rig.request(dt_s=self._config.idle_block_s, recording=False)
        self._rig.make_safe()
        self._air.blow(0.0)
        block = yield
        deadline_s = block.end_s + RUN_DOWN_TIMEOUT_S
        while block.mean(PRESSURE) > REST_PRESSURE_BAR or abs(block.mean(SPEED)) > REST_SPEED_RPM:
            if block.end_s > deadline_s:
                raise RunError(
                    f"the rig does not come to rest: {block.mean(SPEED):.1f} 1/min, "
                    f"{block.mean(PRESSURE):.1f} bar.", place="run down", remedy="Use the emergency stop.",
                )  # fmt: skip
            block = yield
        self._rig.drive.disable()
        yield

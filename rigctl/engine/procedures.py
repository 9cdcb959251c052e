"""What a test engineer does by hand, as block-driven scripts: condition, spin up, brake, release, run down.

Job: each procedure is a generator. It sets set-points, then ``block = yield`` waits for the next block of
samples. Nothing here sleeps or looks at a wall clock. Not its job: order of brakings, pause and abort
(`rigctl.engine.engine`), limits (watchdog).
"""

from __future__ import annotations

import math
from collections.abc import Generator, Mapping
from typing import Any, Protocol

from rigctl.core.blocks import Block
from rigctl.core.channels import DISC_TEMPERATURE, PRESSURE, SPEED
from rigctl.core.errors import RunError
from rigctl.engine.state import BreakOff, Progress
from rigctl.hal.rig import Rig
from sequences.braking import Braking, Conditioning

Script = Generator[None, Block, None]

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
        self._heat_lead_k = 3.0
        self._cool_lead_k = 1.0
        self._ventilator_off_s = -math.inf
        self._ventilating = False
        self.recording = False

    def end_recording(self, status: str, note: str = "") -> None:
        """The present braking is over for the recorder."""
        self.recording = False
        self._recorder.end(status, note)

    # -- conditioning ---------------------------------------------------------------------------

    def condition(self, target_degc: float, how: Conditioning) -> Script:
        """Bring the disc to a temperature and let surface and body come together.

        Raises
        ------
        RunError
            The temperature was not reached within `how.timeout_s`.
        """
        self._rig.request(dt_s=self._config.idle_block_s, recording=False)
        block = yield
        deadline_s = block.end_s + how.timeout_s
        while True:
            degc = block.mean(DISC_TEMPERATURE)
            if how.mode == "at_most" and degc <= target_degc + how.tolerance_k:
                return
            if block.end_s > deadline_s:
                raise RunError(
                    f"the disc has {degc:.1f} °C, not {target_degc:g} °C, after {how.timeout_s:g} s.",
                    place="conditioning",
                    remedy="Raise timeout_s or tolerance_k of the sequence's conditioning, "
                    "or look at the pyrometer and the ventilator.",
                )  # fmt: skip
            if degc < target_degc - how.tolerance_k:
                block = yield from self._heat(target_degc, how, deadline_s)
            elif degc > target_degc + how.tolerance_k:
                block = yield from self._cool(target_degc, deadline_s)
            else:
                block, stayed = yield from self._soak(block, target_degc, how)
                if stayed:
                    return

    def _heat(
        self, target_degc: float, how: Conditioning, deadline_s: float
    ) -> Generator[None, Block, Block]:
        """Drag the brake until the disc surface is hotter than wanted by what it will lose to the body."""
        self._progress.phase = f"heating to {target_degc:.0f} °C"
        self._set_ventilator(0.0)
        self._rig.pressure.set_pressure(0.0)
        speed_rpm = how.drag_speed_rpm or self._can.conditioning_speed_rpm
        self._rig.drive.set_speed(speed_rpm, self._ramp)
        block = yield
        while block.mean(SPEED) < 0.9 * speed_rpm and block.end_s < deadline_s:
            block = yield
        stop_degc = target_degc + self._heat_lead_k
        self._rig.pressure.set_pressure(how.drag_pressure_bar or self._can.conditioning_pressure_bar)
        while block.mean(DISC_TEMPERATURE) < stop_degc and block.end_s < deadline_s:
            block = yield
        self._rig.pressure.set_pressure(0.0)
        block = yield from self._wait(self._settle_s(), block)
        self._heat_lead_k = self._learn(self._heat_lead_k, target_degc - block.mean(DISC_TEMPERATURE), 40.0)
        return block

    def _cool(self, target_degc: float, deadline_s: float) -> Generator[None, Block, Block]:
        """Blow air at the turning disc until it is a little cooler than wanted."""
        self._progress.phase = f"cooling to {target_degc:.0f} °C"
        self._rig.pressure.set_pressure(0.0)
        self._rig.drive.set_speed(self._config.cooling_speed_rpm, self._ramp)
        self._set_ventilator(self._config.ventilator_m3_h)
        block = yield
        while block.mean(DISC_TEMPERATURE) > target_degc - self._cool_lead_k and block.end_s < deadline_s:
            block = yield
        self._stop_ventilator(block)
        block = yield from self._wait(self._settle_s(), block)
        self._cool_lead_k = self._learn(self._cool_lead_k, block.mean(DISC_TEMPERATURE) - target_degc, 5.0)
        return block

    def _soak(
        self, block: Block, target_degc: float, how: Conditioning
    ) -> Generator[None, Block, tuple[Block, bool]]:
        """Turn slowly without pressure; True when the temperature stayed within the tolerance."""
        self._progress.phase = f"soaking at {target_degc:.0f} °C"
        self._stop_ventilator(block)
        self._rig.drive.set_speed(self._config.soak_speed_rpm, self._ramp)
        end_s = block.end_s + how.soak_s
        while block.end_s < end_s - 1e-9:
            block = yield
            if abs(block.mean(DISC_TEMPERATURE) - target_degc) > how.tolerance_k:
                return block, False
        return block, True

    def _settle_s(self) -> float:
        return 4.0 * self._config.idle_block_s

    @staticmethod
    def _learn(lead_k: float, missing_k: float, largest_k: float) -> float:
        """Next time stop later (or earlier) by half of what was missing now."""
        return min(max(lead_k + 0.5 * missing_k, 0.0), largest_k)

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
        flow_m3_h = self._config.ventilator_m3_h if ventilator else 0.0
        block = yield
        if ventilator:
            self._set_ventilator(flow_m3_h)
        else:
            self._stop_ventilator(block)
        deadline_s = block.end_s + SPIN_UP_TIMEOUT_S
        tolerance_rpm = max(SPIN_UP_TOLERANCE[0], SPIN_UP_TOLERANCE[1] * speed_rpm)
        settled_s = 0.0
        while settled_s < SPIN_UP_SETTLE_S or not (ventilator or self._air_is_still(block)):
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
        for i in range(round(braking.duration_s / step_s)):
            t_s = i * step_s
            self._set_course(braking, t_s, t_s + step_s)
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

    def _set_course(self, braking: Braking, t_s: float, next_s: float) -> None:
        """Set-points of the next block: pressure at its middle, speed along the profile to its end."""
        middle_s = 0.5 * (t_s + next_s)
        self._rig.pressure.set_pressure(braking.pressure_setpoint_bar(middle_s))
        start_rpm, end_rpm = braking.speed_setpoint_rpm(t_s), braking.speed_setpoint_rpm(next_s)
        ramp = abs(end_rpm - start_rpm) / (next_s - t_s)
        self._rig.drive.set_speed(end_rpm, ramp if ramp > 0.0 else self._ramp)

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

    def cool_down(self, target_degc: float, timeout_s: float) -> Script:
        """After `max_degc` was passed: cool to the cool-down temperature before anything else."""
        block = yield from self._cool(target_degc, math.inf)
        deadline_s = block.end_s + timeout_s
        while block.mean(DISC_TEMPERATURE) > target_degc:
            if block.end_s > deadline_s:
                raise RunError(f"the disc does not cool to {target_degc:g} °C.", place="cool down",
                               remedy="Check the ventilator.")  # fmt: skip
            block = yield from self._cool(target_degc, deadline_s)

    def dwell(self, seconds: float) -> Script:
        """Do nothing for a while, turning slowly."""
        if seconds > 0.0:
            self._progress.phase = "dwelling"
            block = yield
            yield from self._wait(seconds, block)

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
        self._set_ventilator(0.0)
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

    # -- helpers --------------------------------------------------------------------------------

    def _wait(self, seconds: float, block: Block) -> Generator[None, Block, Block]:
        end_s = block.end_s + seconds
        while block.end_s < end_s - 1e-9:
            block = yield
        return block

    def _set_ventilator(self, flow_m3_h: float) -> None:
        self._ventilating = flow_m3_h > 0.0
        self._rig.ventilator.set_flow(flow_m3_h)

    def _stop_ventilator(self, block: Block) -> None:
        if self._ventilating:
            self._ventilator_off_s = block.end_s
            self._set_ventilator(0.0)

    def _air_is_still(self, block: Block) -> bool:
        return block.end_s - self._ventilator_off_s >= self._can.ventilator_settle_s

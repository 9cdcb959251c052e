"""What a test engineer does by hand, as block-driven scripts: spin up, brake, release, run down.

Job: each procedure is a generator. It sets set-points, then ``block = yield`` waits for the next block of
samples. Nothing here sleeps or looks at a wall clock. Not its job: order of brakings, pause and abort
(`rigctl.engine.engine`), how a temperature is reached (`rigctl.engine.conditioning`), limits (watchdog).
"""

from __future__ import annotations

from collections.abc import Generator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

from rigctl.core.blocks import Block
from rigctl.core.channels import DISC_TEMPERATURE, PRESSURE, SPEED
from rigctl.core.errors import RunError
from rigctl.engine.conditioning import Air, Conditioner, Script, wait
from rigctl.engine.state import BreakOff, Progress
from rigctl.hal.rig import Rig
from sequences.braking import Braking, Conditioning

LEAST_RAMP_RPM_S = 1e-6  # below it a profile is level but for rounding: no drive ramps that slowly
REST_PRESSURE_BAR = 0.8
REST_SPEED_RPM = 1.0
RELEASE_TIMEOUT_S = 5.0
RUN_DOWN_TIMEOUT_S = 60.0
SPIN_UP_TIMEOUT_S = 60.0
SPIN_UP_TOLERANCE = (1.0, 0.02)  # 1/min, share of the set-point
SPIN_UP_SETTLE_S = 0.5


def at_rest(block: Block) -> bool:
    """True when neither pressure nor speed is left."""
    return block.mean(PRESSURE) <= REST_PRESSURE_BAR and abs(block.mean(SPEED)) <= REST_SPEED_RPM


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


@dataclass(frozen=True, slots=True)
class CoursePoint:
    """Set-points of one block of a braking."""

    dt_s: float
    pressure_bar: float
    speed_rpm: float
    ramp_rpm_per_s: float


def spans(duration_s: float, longest_s: float) -> list[float]:
    """Lengths of blocks that make up a duration, to the millisecond: as long as allowed, the rest last."""
    whole_ms, longest_ms = round(duration_s * 1000.0), round(longest_s * 1000.0)
    count, rest_ms = divmod(whole_ms, longest_ms)
    return [longest_s] * count + ([rest_ms / 1000.0] if rest_ms else [])


def course_of(
    braking: Braking, block_s: float, steady_block_s: float, ramp_rpm_per_s: float
) -> list[CoursePoint]:
    """Set-points of each block of a braking, from the onset of pressure to its release.

    Pressure is that at the middle of a block, speed that at its end with the ramp that leads to it. Blocks
    are `block_s` long; while the set-points do not change they are merged up to `steady_block_s`.
    """
    points: list[CoursePoint] = []
    t_s = 0.0
    for dt_s in spans(braking.duration_s, block_s):
        start_rpm, end_rpm = braking.speed_setpoint_rpm(t_s), braking.speed_setpoint_rpm(t_s + dt_s)
        ramp = abs(end_rpm - start_rpm) / dt_s
        pressure_bar = braking.pressure_setpoint_bar(t_s + 0.5 * dt_s)
        point = CoursePoint(dt_s, pressure_bar, end_rpm, ramp if ramp > LEAST_RAMP_RPM_S else ramp_rpm_per_s)
        last = points[-1] if points else None
        if (
            last is not None
            and replace(last, dt_s=dt_s) == point
            and round((last.dt_s + dt_s) * 1e3) <= round(steady_block_s * 1e3)
        ):
            points[-1] = replace(last, dt_s=last.dt_s + dt_s)
        else:
            points.append(point)
        t_s += dt_s
    return points


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
        self.recording_end_s = 0.0

    @property
    def ventilator_m3_h(self) -> float:
        """Air flow in force."""
        return self._air.flow_m3_h

    def blow(self, flow_m3_h: float, block: Block) -> None:
        """Air by hand; 0 is off."""
        if flow_m3_h > 0.0:
            self._air.blow(flow_m3_h)
        else:
            self._air.stop(block)

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

    def brake(self, braking: Braking, note: str = "") -> Script:
        """Record: background before, the braking with its profiles, and the release after it.

        Raises
        ------
        BreakOff
            The disc became hotter than the sequence allows.
        """
        rig, recorder = self._rig, self._recorder
        self._progress.phase = f"braking with {braking.pressure_bar:g} bar"
        before_s, *rest_s = spans(max(braking.recording.pre_s, rig.config.block_s), rig.steady_block_s)
        rig.request(dt_s=before_s, recording=True)
        block = yield
        recorder.begin(braking.model_dump(mode="json"), t0_s=block.t_s)
        self.recording = True
        self.recording_end_s = (
            block.t_s + braking.recording.pre_s + braking.duration_s + braking.recording.post_s
        )
        recorder.block(block)
        block = yield from self._record(rest_s, block)
        recorder.mark("pressure_onset", block.end_s, temperature_degc=block.mean(DISC_TEMPERATURE))
        for point in course_of(braking, rig.config.block_s, rig.steady_block_s, self._ramp):
            rig.pressure.set_pressure(point.pressure_bar)
            rig.drive.set_speed(point.speed_rpm, point.ramp_rpm_per_s)
            rig.request(dt_s=point.dt_s, recording=True)
            block = yield
            recorder.block(block)
            degc = block.mean(DISC_TEMPERATURE)
            if degc > braking.limits.max_degc:
                raise BreakOff(None, f"disc at {degc:.0f} °C, above max_degc {braking.limits.max_degc:g} °C")
        self._progress.phase = "releasing"
        recorder.mark("pressure_release", block.end_s)
        rig.pressure.set_pressure(0.0)
        yield from self._record(spans(braking.recording.post_s, rig.steady_block_s), block)
        self.end_recording("complete", note)

    def _record(self, lengths_s: Sequence[float], block: Block) -> Generator[None, Block, Block]:
        """Record blocks of these lengths without changing set-points; returns the last one."""
        for dt_s in lengths_s:
            self._rig.request(dt_s=dt_s, recording=True)
            block = yield
            self._recorder.block(block)
        return block

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
        while not at_rest(block):
            if block.end_s > deadline_s:
                raise RunError(
                    f"the rig does not come to rest: {block.mean(SPEED):.1f} 1/min, "
                    f"{block.mean(PRESSURE):.1f} bar.", place="run down", remedy="Use the emergency stop.",
                )  # fmt: skip
            block = yield
        self._rig.drive.disable()
        yield

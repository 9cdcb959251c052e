"""How long a program will take: a walk through its brakings with the disc as one thermal node.

Job: time for heating, cooling, soaking, braking and the rest, good enough to compare loop orders and to plan
a night; within tens of per cent, not a prediction of temperatures. Not the job: the simulated rig
(``sim_hardware.plant``), which has two nodes, flow-dependent cooling and a pyrometer.

Heating and cooling are solved in closed form between their two temperatures, with radiation linearised at
the mean temperature. Conditioning is taken as done when the disc enters the tolerance band.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable

from sequences.braking import AXES, Axis, Braking
from sequences.capabilities import WATTS_PER_NM_RPM, RigCapabilities
from sequences.fields import ABSOLUTE_ZERO_DEGC, Data
from sequences.program import Program

_POINTS_PER_SEGMENT = 12
LoopOrder = tuple[Axis, Axis, Axis]


class DurationEstimate(Data):
    """Estimated times by what the rig does; ``other_s`` is spinning up and down, dwell, recording."""

    heating_s: float = 0.0
    cooling_s: float = 0.0
    soaking_s: float = 0.0
    braking_s: float = 0.0
    other_s: float = 0.0

    @property
    def total_s(self) -> float:
        return self.heating_s + self.cooling_s + self.soaking_s + self.braking_s + self.other_s


class BrakingForecast(Data):
    """What the walk expects of one braking. ``conditioning_s`` is None if the temperature is out of reach."""

    index: int
    conditioning_s: float | None
    start_degc: float
    end_degc: float


class ThermalWalk:
    """Steps from braking to braking, keeping the disc temperature and the sums of time."""

    def __init__(self, capabilities: RigCapabilities, start_degc: float | None = None) -> None:
        self._rig = capabilities
        self._disc = capabilities.thermal
        self.temperature_degc = capabilities.thermal.ambient_degc if start_degc is None else start_degc
        self._time_s = dict.fromkeys(DurationEstimate.model_fields, 0.0)
        self._heat_j: dict[tuple[str, int, int], float] = {}

    @property
    def estimate(self) -> DurationEstimate:
        return DurationEstimate(**self._time_s)

    def step(self, braking: Braking) -> BrakingForecast:
        """Advance through conditioning, braking and dwell of one braking."""
        conditioning_s = self._condition(braking)
        start_degc = self.temperature_degc
        self._brake(braking)
        end_degc = self.temperature_degc
        self._finish(braking)
        return BrakingForecast(
            index=braking.index, conditioning_s=conditioning_s, start_degc=start_degc, end_degc=end_degc
        )

    def _condition(self, braking: Braking) -> float | None:
        target_degc, how = braking.temperature_degc, braking.conditioning
        if target_degc is None:
            return 0.0
        needed_s: float | None = 0.0
        if self.temperature_degc > target_degc + how.tolerance_k:
            needed_s = self._cool_to(target_degc + how.tolerance_k, how.timeout_s)
        elif how.mode == "exact" and self.temperature_degc < target_degc - how.tolerance_k:
            needed_s = self._heat_to(target_degc - how.tolerance_k, braking)
        self._time_s["soaking_s"] += how.soak_s
        self._rest(how.soak_s)
        return None if needed_s is None else needed_s + how.soak_s

    def _cool_to(self, target_degc: float, timeout_s: float) -> float | None:
        conductance = self._conductance_w_k(self.temperature_degc, target_degc, ventilated=True)
        needed_s = self._time_to_s(target_degc, 0.0, conductance)
        self._time_s["cooling_s"] += self._rig.ventilator_settle_s
        return self._spend("cooling_s", needed_s, target_degc, timeout_s)

    def _heat_to(self, target_degc: float, braking: Braking) -> float | None:
        how = braking.conditioning
        speed_rpm = abs(how.drag_speed_rpm or self._rig.conditioning_speed_rpm)
        pressure_bar = how.drag_pressure_bar or self._rig.conditioning_pressure_bar
        power_w = speed_rpm * WATTS_PER_NM_RPM * self._rig.nominal_torque_nm(pressure_bar)
        conductance = self._conductance_w_k(self.temperature_degc, target_degc, ventilated=False)
        needed_s = self._time_to_s(target_degc, power_w * self._disc.disc_heat_share, conductance)
        # Spinning up to the drag speed belongs to heating too; from there the braking's own start is counted.
        self._time_s["heating_s"] += speed_rpm / self._rig.max_speed_rate_rpm_s + self._rig.release_s
        return self._spend("heating_s", needed_s, target_degc, how.timeout_s)

    def _spend(self, kind: str, needed_s: float | None, target_degc: float, timeout_s: float) -> float | None:
        self._time_s[kind] += timeout_s if needed_s is None else min(needed_s, timeout_s)
        # After a time-out the walk goes on from the target: one unreachable point must not spoil the rest.
        self.temperature_degc = target_degc
        return needed_s

    def _brake(self, braking: Braking) -> None:
        profile = braking.speed_profile
        self._time_s["braking_s"] += braking.duration_s
        spin_up_s = abs(profile.start_rpm) / self._rig.max_speed_rate_rpm_s
        before_s = spin_up_s + max(self._rig.start_s, braking.recording.pre_s)
        self._time_s["other_s"] += before_s
        self._rest(before_s)
        power_w = self._friction_heat_j(braking) * self._disc.disc_heat_share / braking.duration_s
        self._drift(braking.duration_s, power_w, ventilated=braking.ventilator)

    def _finish(self, braking: Braking) -> None:
        spin_down_s = abs(braking.speed_profile.end_rpm) / self._rig.max_speed_rate_rpm_s
        after_s = max(self._rig.release_s, braking.recording.post_s) + spin_down_s + braking.dwell_s
        self._time_s["other_s"] += after_s
        self._rest(after_s)
        if self.temperature_degc > braking.limits.max_degc:
            self._cool_to(braking.limits.cool_down_degc, braking.conditioning.timeout_s)

    def _friction_heat_j(self, braking: Braking) -> float:
        """Nominal friction work of one braking; depends on speed profile and working point only."""
        key = (braking.sequence, braking.loop.speed, braking.loop.pressure)
        if key not in self._heat_j:
            work_j, begin_s = 0.0, 0.0
            for segment in braking.speed_profile.segments:
                dt_s = segment.duration_s / _POINTS_PER_SEGMENT
                for i in range(_POINTS_PER_SEGMENT):
                    t_s = begin_s + (i + 0.5) * dt_s
                    torque_nm = self._rig.nominal_torque_nm(braking.pressure_setpoint_bar(t_s))
                    work_j += torque_nm * abs(braking.speed_setpoint_rpm(t_s)) * WATTS_PER_NM_RPM * dt_s
                begin_s += segment.duration_s
            self._heat_j[key] = work_j
        return self._heat_j[key]

    def _rest(self, duration_s: float) -> None:
        self._drift(duration_s, 0.0, ventilated=False)

    def _drift(self, duration_s: float, power_w: float, *, ventilated: bool) -> None:
        now_degc = self.temperature_degc
        conductance = self._conductance_w_k(now_degc, now_degc, ventilated=ventilated)
        final_degc = self._disc.ambient_degc + power_w / conductance
        decay = math.exp(-conductance * duration_s / self._disc.heat_capacity_j_k)
        self.temperature_degc = final_degc + (now_degc - final_degc) * decay

    def _time_to_s(self, target_degc: float, power_w: float, conductance: float) -> float | None:
        """Time to reach the target at constant power; None if it lies at or beyond the final temperature."""
        final_degc = self._disc.ambient_degc + power_w / conductance
        from_k, to_k = self.temperature_degc - final_degc, target_degc - final_degc
        if from_k * to_k <= 0 or abs(to_k) > abs(from_k):
            return None
        return self._disc.heat_capacity_j_k / conductance * math.log(from_k / to_k)

    def _conductance_w_k(self, from_degc: float, to_degc: float, *, ventilated: bool) -> float:
        """Convection plus radiation linearised at the mean of the two temperatures."""
        disc_k = 0.5 * (from_degc + to_degc) - ABSOLUTE_ZERO_DEGC
        ambient_k = self._disc.ambient_degc - ABSOLUTE_ZERO_DEGC
        radiation = self._disc.radiation_w_k4 * (disc_k**2 + ambient_k**2) * (disc_k + ambient_k)
        return radiation + (self._disc.ventilated_w_k if ventilated else self._disc.still_w_k)


def estimate_duration(
    brakings: Iterable[Braking], capabilities: RigCapabilities, start_degc: float | None = None
) -> DurationEstimate:
    """Estimate the time for `brakings` in this order, from a disc at `start_degc` (default: ambient)."""
    walk = ThermalWalk(capabilities, start_degc)
    for braking in brakings:
        walk.step(braking)
    return walk.estimate


def loop_order_durations(
    program: Program, sequence_name: str, capabilities: RigCapabilities
) -> dict[LoopOrder, DurationEstimate]:
    """Estimate the whole program for each of the six loop orders of one of its sequences.

    Raises
    ------
    KeyError
        The program has no sequence of this name.
    """
    position = {sequence.name: i for i, sequence in enumerate(program.sequences)}[sequence_name]
    before, chosen, after = (
        program.sequences[:position],
        program.sequences[position],
        program.sequences[position + 1 :],
    )
    durations: dict[LoopOrder, DurationEstimate] = {}
    same: dict[tuple[Axis, ...], DurationEstimate] = {}  # loops of one value do not change the order
    for order in itertools.permutations(AXES, 3):
        effective: tuple[Axis, ...] = tuple(axis for axis in order if chosen.sizes[axis] > 1)
        if effective not in same:
            sequences = (*before, chosen.model_copy(update={"loop_order": order}), *after)
            variant = program.model_copy(update={"sequences": sequences})
            same[effective] = estimate_duration(variant.brakings(), capabilities)
        durations[order] = same[effective]
    return durations

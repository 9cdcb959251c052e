"""Bringing the disc to a temperature: drag heating, ventilator cooling, soaking.

Job: block-driven scripts (see `rigctl.engine.procedures`). The pyrometer sees the rub surface, which is
hotter than the disc body while the brake drags and cooler while air blows. Both differences are estimated
from the readings (friction power, excess over ambient) and learned from what happens after each heating and
cooling, so that the body, not the surface, arrives at the set-point. Not its job: brakings.
"""

from __future__ import annotations

import math
from collections.abc import Generator

from rigctl.core.blocks import Block
from rigctl.core.channels import DISC_TEMPERATURE, SPEED, TORQUE
from rigctl.core.errors import RunError
from rigctl.core.units import RAD_S_PER_RPM
from rigctl.engine.state import Progress
from rigctl.hal.rig import Rig
from sequences.braking import Conditioning

Script = Generator[None, Block, None]

SETTLE_S = 3.0  # surface and body of the disc come together
TAPER_K = 12.0  # so far from the set-point heating begins to be gentler
GENTLEST = 0.2  # share of the heating pressure close to the set-point
HEAD_START_S = 6.0  # heating goes above the set-point by what the still disc loses in this time
PATIENCE_S = 30.0  # a disc that is too hot by no more than it loses in this time is left alone
LEARN = 0.5
FLASH_K_PER_W = (0.001, 0.006, 0.03)  # surface above body per friction power: least, first guess, most
CHILL = (0.0, 0.02, 0.2)  # surface below body per excess over ambient, with the ventilator on


def wait(seconds: float, block: Block) -> Generator[None, Block, Block]:
    """Let blocks pass for a stretch of rig time; returns the last one."""
    end_s = block.end_s + seconds
    while block.end_s < end_s - 1e-9:
        block = yield
    return block


class Air:
    """The ventilator, and since when the air is still.

    Whether it blows is asked of the device: one that cools by itself while nobody commands it blows already
    when a program begins.
    """

    def __init__(self, rig: Rig) -> None:
        self._ventilator = rig.ventilator
        self._settle_s = rig.config.capabilities.ventilator_settle_s
        self._off_s = -math.inf

    @property
    def flow_m3_h(self) -> float:
        """Air flow in force."""
        return self._ventilator.commanded_m3_h

    def blow(self, flow_m3_h: float) -> None:
        """Set the air flow."""
        self._ventilator.set_flow(flow_m3_h)

    def stop(self, block: Block) -> None:
        """Switch off, if it is on."""
        if self.flow_m3_h > 0.0:
            self._off_s = block.end_s
            self.blow(0.0)

    def still(self, block: Block) -> bool:
        """True when the ventilator has run down."""
        return block.end_s - self._off_s >= self._settle_s


class Conditioner:
    """Temperature conditioning on one rig; learns how surface and body of its disc differ."""

    def __init__(self, rig: Rig, air: Air, progress: Progress) -> None:
        self._rig = rig
        self._air = air
        self._progress = progress
        self._config = rig.config.conditioning
        self._can = rig.config.capabilities
        self._ramp = self._can.max_speed_rate_rpm_s
        self._flash_k_per_w = FLASH_K_PER_W[1]
        self._chill = CHILL[1]

    def condition(self, target_degc: float, how: Conditioning) -> Script:
        """Heat, cool or wait until the disc stays within the tolerance for the soaking time.

        Raises
        ------
        RunError
            Not within `how.timeout_s`.
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
                )
            if degc < target_degc - how.tolerance_k:
                block = yield from self._heat(target_degc, how, deadline_s)
            elif degc > target_degc + PATIENCE_S * self._still_loss_k_s(degc) + how.tolerance_k:
                block = yield from self._cool(target_degc, deadline_s)
            elif degc > target_degc + how.tolerance_k:
                block = yield from self._rest(block, target_degc + 0.5 * how.tolerance_k, deadline_s)
            else:
                block, stayed = yield from self._soak(block, target_degc, how)
                if stayed:
                    return

    def _heat(
        self, target_degc: float, how: Conditioning, deadline_s: float
    ) -> Generator[None, Block, Block]:
        """Drag the brake, more gently towards the end, until the disc body has the temperature."""
        self._progress.phase = f"heating to {target_degc:.0f} °C"
        self._air.blow(0.0)
        self._rig.pressure.set_pressure(0.0)
        speed_rpm = how.drag_speed_rpm or self._can.conditioning_speed_rpm
        full_bar = how.drag_pressure_bar or self._can.conditioning_pressure_bar
        self._rig.drive.set_speed(speed_rpm, self._ramp)
        block = yield
        while block.mean(SPEED) < 0.9 * speed_rpm and block.end_s < deadline_s:
            block = yield
        aim_degc = target_degc + min(HEAD_START_S * self._still_loss_k_s(target_degc), how.tolerance_k)
        power_w = 0.0
        while block.end_s < deadline_s:
            power_w = block.mean(TORQUE) * block.mean(SPEED) * RAD_S_PER_RPM
            missing_k = aim_degc - (block.mean(DISC_TEMPERATURE) - self._flash_k_per_w * max(power_w, 0.0))
            if math.isnan(missing_k):  # no valid reading in this block: hold; who judges sensors will act
                block = yield
                continue
            if missing_k <= 0.0:
                break
            self._rig.pressure.set_pressure(full_bar * min(max(missing_k / TAPER_K, GENTLEST), 1.0))
            block = yield
        surface_degc = block.mean(DISC_TEMPERATURE)
        self._rig.pressure.set_pressure(0.0)
        self._rig.drive.set_speed(self._config.soak_speed_rpm, self._ramp)
        block = yield from wait(SETTLE_S, block)
        if power_w > 0.0:
            seen = (surface_degc - block.mean(DISC_TEMPERATURE)) / power_w
            self._flash_k_per_w = _learn(self._flash_k_per_w, seen, FLASH_K_PER_W)
        return block

    def _cool(self, target_degc: float, deadline_s: float) -> Generator[None, Block, Block]:
        """Blow air at the turning disc until its body has the temperature."""
        self._progress.phase = f"cooling to {target_degc:.0f} °C"
        self._rig.pressure.set_pressure(0.0)
        self._rig.drive.set_speed(self._config.cooling_speed_rpm, self._ramp)
        self._air.blow(self._config.ventilator_m3_h)
        block = yield
        while self._body_degc(block) > target_degc and block.end_s < deadline_s:
            block = yield
        surface_degc = block.mean(DISC_TEMPERATURE)
        self._air.stop(block)
        self._rig.drive.set_speed(self._config.soak_speed_rpm, self._ramp)
        block = yield from wait(SETTLE_S, block)
        excess_k = surface_degc - self._can.thermal.ambient_degc
        if excess_k > 0.0:
            seen = (block.mean(DISC_TEMPERATURE) - surface_degc) / excess_k
            self._chill = _learn(self._chill, seen, CHILL)
        return block

    def _body_degc(self, block: Block) -> float:
        degc = block.mean(DISC_TEMPERATURE)
        return degc + self._chill * max(degc - self._can.thermal.ambient_degc, 0.0)

    def _rest(self, block: Block, until_degc: float, deadline_s: float) -> Generator[None, Block, Block]:
        """Turn slowly in still air until the disc has cooled by itself."""
        self._progress.phase = f"resting until {until_degc:.0f} °C"
        self._air.stop(block)
        self._rig.pressure.set_pressure(0.0)
        self._rig.drive.set_speed(self._config.soak_speed_rpm, self._ramp)
        while block.mean(DISC_TEMPERATURE) > until_degc and block.end_s < deadline_s:
            block = yield
        return block

    def _still_loss_k_s(self, degc: float) -> float:
        """Rate at which the disc cools without ventilator, by the rig's thermal estimate, K/s."""
        disc = self._can.thermal
        return disc.still_w_k * max(degc - disc.ambient_degc, 0.0) / disc.heat_capacity_j_k

    def _soak(
        self, block: Block, target_degc: float, how: Conditioning
    ) -> Generator[None, Block, tuple[Block, bool]]:
        """Turn slowly without pressure; True when the temperature stayed within the tolerance."""
        self._progress.phase = f"soaking at {target_degc:.0f} °C"
        self._air.stop(block)
        self._rig.pressure.set_pressure(0.0)
        self._rig.drive.set_speed(self._config.soak_speed_rpm, self._ramp)
        end_s = block.end_s + how.soak_s
        while block.end_s < end_s - 1e-9:
            block = yield
            if abs(block.mean(DISC_TEMPERATURE) - target_degc) > how.tolerance_k:
                return block, False
        return block, True


def _learn(value: float, seen: float, bounds: tuple[float, float, float]) -> float:
    return min(max(value + LEARN * (seen - value), bounds[0]), bounds[2])

"""Proof test at arming: every check must find its own fault in made-up samples, through the real code.

Job: check the checks. For each row of the table a short run of samples with exactly that fault; the row must
give its verdict, and a good run must give none. Not its job: the relay (its proof is its read-back).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import nan
from typing import Any, Final

from rigctl.core.safety_link import SafetySample
from rigctl.safety.checks import CHECKS, CheckRunner
from rigctl.safety.limits import Limits
from rigctl.safety.observe import View

READINGS: Final = 10
BLOCK_S: Final = 0.1
_GOOD_BLOCKS: Final = 2

Maker = Callable[[SafetySample, Limits], SafetySample]


def good_sample(k: int, limits: Limits) -> SafetySample:
    """A braking well within the limits, whatever they are, with the unrest of living sensors."""
    heat = limits.disc_temperature
    bar, rpm = 0.45 * limits.pressure.max_bar, min(40.0, 0.5 * limits.speed.max_rpm)
    nm, degc = 0.3 * limits.torque.max_nm, 0.5 * (heat.min_degc + heat.approach_from_degc)
    unrest = [((k * READINGS + i) * 37 % 101) / 1000.0 for i in range(READINGS)]
    return SafetySample(
        k=k,
        t_s=(k + 1) * BLOCK_S,
        dt_s=BLOCK_S,
        pressure_bar=tuple(bar + u for u in unrest),
        speed_rpm=tuple(rpm + u for u in unrest),
        torque_nm=tuple(nm + u for u in unrest),
        temperature_degc=tuple(degc + u for u in unrest),
        relay_closed=True,
        drive_enabled=True,
        estop_ok=True,
        doors_ok=True,
    )


_FIELDS: Final = {
    "pressure": "pressure_bar",
    "speed": "speed_rpm",
    "torque": "torque_nm",
    "temperature": "temperature_degc",
}


def _all(field: str, value: Callable[[Limits], Any]) -> Maker:
    return lambda sample, limits: replace(sample, **{field: (value(limits),) * READINGS})


def _set(**changes: Any) -> Maker:
    return lambda sample, _limits: replace(sample, **changes)


def _power(kw: Callable[[Limits], float]) -> Maker:
    def make(sample: SafetySample, limits: Limits) -> SafetySample:
        speed_rpm = limits.speed.max_rpm
        torque_nm = kw(limits) * 30_000.0 / 3.141592653589793 / speed_rpm  # P = M·ω
        return replace(sample, speed_rpm=(speed_rpm,) * READINGS, torque_nm=(torque_nm,) * READINGS)

    return make


def _approach(sample: SafetySample, limits: Limits) -> SafetySample:
    # A pyrometer that stands still just below the limit while a large power goes into the disc.
    bounds = limits.disc_temperature
    power = _power(lambda lim: lim.power.max_kw * 0.99)(sample, limits)
    return replace(power, temperature_degc=(bounds.max_degc - 0.1,) * READINGS)


FAULTS: Final[dict[str, Maker]] = {
    "samples_gap": lambda sample, _limits: replace(sample, k=sample.k + 5, t_s=sample.t_s),
    "safety_channel": _set(channel_fault="made up by the proof test"),
    "samples_clock": lambda sample, _limits: replace(sample, t_s=sample.t_s + 0.05),
    **{f"{name}_stale": _set(**{field: ()}) for name, field in _FIELDS.items()},
    **{f"{name}_invalid": _all(field, lambda _limits: nan) for name, field in _FIELDS.items()},
    **{f"{name}_frozen": _all(field, lambda _limits: 25.0) for name, field in _FIELDS.items()},
    "relay_welded": _set(),
    "relay_not_closed": _set(relay_closed=False),
    "drive_enabled": _set(relay_closed=False),
    "estop": _set(estop_ok=False),
    "doors": _set(doors_ok=False),
    "pressure_peak": _all("pressure_bar", lambda limits: limits.pressure.peak_bar + 0.1),
    "pressure_range": _all("pressure_bar", lambda limits: limits.pressure.max_bar + 0.1),
    "speed_range": _all("speed_rpm", lambda limits: limits.speed.max_rpm + 0.1),
    "torque_range": _all("torque_nm", lambda limits: limits.torque.max_nm + 0.1),
    "temperature_range": _all("temperature_degc", lambda limits: limits.disc_temperature.max_degc + 0.1),
    "temperature_approach": _approach,
    "power_peak": _power(lambda limits: limits.power.peak_kw * 1.001),
    "power_range": _power(lambda limits: limits.power.max_kw * 1.001),
}
_RELAY_TOLD_OPEN: Final = ("relay_welded", "drive_enabled")


def provoke(check_id: str, limits: Limits, *, relay_wanted: bool = True, blocks: int = 110) -> bool:
    """Whether the check finds its fault within `blocks` blocks that carry it."""
    runner = CheckRunner(limits)
    make = FAULTS[check_id]
    before: View | None = None
    for k in range(_GOOD_BLOCKS + blocks):
        faulty = k >= _GOOD_BLOCKS
        sample = good_sample(k, limits)
        view = View(make(sample, limits) if faulty else sample, before, relay_wanted or not faulty)
        verdicts = runner.run(view, before)
        if any(verdict.check.id == check_id for verdict in verdicts):
            return faulty
        before = view
    return False


def failed_checks(limits: Limits) -> list[str]:
    """Ids of the checks that do not find their fault, and of those that complain about good samples."""
    failed = [check.id for check in CHECKS if not provoke(check.id, limits, relay_wanted=_wanted(check.id))]
    runner = CheckRunner(limits)
    before: View | None = None
    for k in range(2 * READINGS):
        view = View(good_sample(k, limits), before, True)
        failed += [f"{verdict.check.id} (false alarm)" for verdict in runner.run(view, before)]
        before = view
    return failed


def _wanted(check_id: str) -> bool:
    return check_id not in _RELAY_TOLD_OPEN

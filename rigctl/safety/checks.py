"""The table of checks: each a pure function of one block's view and the limits, and the counters behind them.

Job: say which checks a block fails. A check returns None when every reading is good (the usual case, cheap),
else one flag per reading, True for bad. Conditions are written as ``not (low <= x <= high)``, so that NaN is
bad. A saturating counter (+1 bad, −1 good) makes the verdict: one spike does not trip, one good reading does
not forgive. Not its job: what follows from a verdict (`rigctl.safety.guard`).

A further check is a function and a row in `CHECKS`; its id is a cause in `rigctl.safety.causes`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import isnan, nan
from operator import attrgetter
from typing import Any, Final

from rigctl.safety.causes import Cause
from rigctl.safety.limits import Limits
from rigctl.safety.observe import Signal, View

Flags = Sequence[bool] | None
CheckFunction = Callable[[View, View | None, Limits], Flags]

BAD: Final = (True,)


@dataclass(frozen=True, slots=True)
class Check:
    """One row of the table.

    Attributes
    ----------
    id : str
        Cause of `rigctl.safety.causes`.
    function : callable
        (view, view before, limits) -> flags.
    persistence : str or int
        Counter at which the verdict is given: a key of the limits, or a number.
    always : bool
        True: a verdict trips in every state (the hardware misbehaves). False: it trips while the relay is
        closed, and keeps the rig locked otherwise.
    per_block : bool
        The function gives one flag per block instead of one per reading.
    value : callable
        The value to report.
    threshold : str
        Key of the limits to report.
    low, floor : callable, str
        The same for the lower limit; reported instead when the value is below it.
    """

    id: str
    function: CheckFunction
    persistence: str | int
    always: bool = False
    per_block: bool = False
    value: Callable[[View], Any] | None = None
    threshold: str = ""
    low: Callable[[View], Any] | None = None
    floor: str = ""


# -- signals that cannot be believed ----------------------------------------------------------------


def invalid(signal: Callable[[View], Signal]) -> CheckFunction:
    """Readings that are missing, NaN or infinite."""

    def check(view: View, _before: View | None, _limits: Limits) -> Flags:
        seen = signal(view)
        return [isnan(value) for value in seen.values] if seen.invalid else None

    return check


def stale(signal: Callable[[View], Signal]) -> CheckFunction:
    """Fewer readings in the block than a living sensor gives."""

    def check(view: View, _before: View | None, limits: Limits) -> Flags:
        return None if signal(view).count >= limits.freshness.min_readings else BAD

    return check


def frozen(signal: Callable[[View], Signal]) -> CheckFunction:
    """The very same number for too long, while the brake turns under pressure and everything is moving."""

    def check(view: View, _before: View | None, limits: Limits) -> Flags:
        sanity = limits.sanity
        if signal(view).run < sanity.frozen_readings:
            return None
        turning = max(view.speed.high, -view.speed.low) > sanity.frozen_above_rpm
        return BAD if turning and view.pressure.high > sanity.frozen_above_bar else None

    return check


def samples_gap(view: View, before: View | None, _limits: Limits) -> Flags:
    """Block numbers rise by exactly one."""
    return None if before is None or view.sample.k == before.sample.k + 1 else BAD


def samples_clock(view: View, before: View | None, limits: Limits) -> Flags:
    """Blocks have a sensible length and follow each other in the safety channel's own time."""
    sample, freshness = view.sample, limits.freshness
    if not 0.0 < sample.dt_s <= freshness.max_block_s:
        return BAD
    step_s = sample.dt_s if before is None else sample.t_s - before.sample.t_s
    tolerance_s = freshness.clock_tolerance_s
    return None if -tolerance_s <= step_s - sample.dt_s <= tolerance_s else BAD


# -- absolute limits --------------------------------------------------------------------------------


def pressure_peak(view: View, _before: View | None, limits: Limits) -> Flags:
    """K-11, the fast bound."""
    signal, high = view.pressure, limits.pressure.peak_bar
    if signal.high <= high and not signal.invalid:
        return None
    return [not (value <= high) for value in signal.values]


def pressure_range(view: View, _before: View | None, limits: Limits) -> Flags:
    """K-11."""
    return _out_of(view.pressure, limits.pressure.min_bar, limits.pressure.max_bar)


def speed_range(view: View, _before: View | None, limits: Limits) -> Flags:
    """K-07, and the wrong direction."""
    return _out_of(view.speed, limits.speed.min_rpm, limits.speed.max_rpm)


def torque_range(view: View, _before: View | None, limits: Limits) -> Flags:
    """S2."""
    return _out_of(view.torque, limits.torque.min_nm, limits.torque.max_nm)


def temperature_range(view: View, _before: View | None, limits: Limits) -> Flags:
    """S8 and K-16."""
    return _out_of(view.temperature, limits.disc_temperature.min_degc, limits.disc_temperature.max_degc)


def temperature_approach(view: View, _before: View | None, limits: Limits) -> Flags:
    """K-14: (T_max − T) / rate < reaction time, rate = max(measured, q·P/C).

    The friction power bounds the rate from below, so that a frozen pyrometer cannot hide the rise.
    """
    bounds = limits.disc_temperature
    degc = view.temperature.high
    if degc <= bounds.approach_from_degc:
        return None
    physical = bounds.heat_fraction * view.power_kw() * 1000.0 / bounds.heat_capacity_j_per_k
    rate = max(physical, view.temperature_rate_k_per_s(), 0.0)
    return None if degc + rate * bounds.reaction_s <= bounds.max_degc else BAD


def power_peak(view: View, _before: View | None, limits: Limits) -> Flags:
    """K-21, the fast bound."""
    return _power_above(view, limits.power.peak_kw)


def power_range(view: View, _before: View | None, limits: Limits) -> Flags:
    """K-21."""
    return _power_above(view, limits.power.max_kw)


def _out_of(signal: Signal, low: float, high: float) -> Flags:
    if low <= signal.low and signal.high <= high and not signal.invalid:
        return None
    return [not (low <= value <= high) for value in signal.values]


def _power_above(view: View, high: float) -> Flags:
    if view.highest_power_kw() <= high and not view.torque.invalid and not view.speed.invalid:
        return None
    return [not (power <= high) for power in view.powers_kw()]


# -- safety relay and hard-wired chain --------------------------------------------------------------


def relay_welded(view: View, _before: View | None, _limits: Limits) -> Flags:
    """K-20: told to open, reads closed."""
    return BAD if view.sample.relay_closed and not view.relay_wanted else None


def relay_not_closed(view: View, _before: View | None, _limits: Limits) -> Flags:
    """K-20: told to close, does not read closed."""
    return BAD if view.relay_wanted and view.sample.relay_closed is not True else None


def drive_enabled(view: View, _before: View | None, _limits: Limits) -> Flags:
    """K-20: torque enable is on while the relay is open."""
    sample = view.sample
    return BAD if sample.drive_enabled and not view.relay_wanted and not sample.relay_closed else None


def safety_channel(view: View, _before: View | None, _limits: Limits) -> Flags:
    """C1, C3, C4, C11: bus or safety I/O silent or restarted, or somebody else renews the relay."""
    return BAD if view.sample.channel_fault else None


def estop(view: View, _before: View | None, _limits: Limits) -> Flags:
    """S13."""
    return None if view.sample.estop_ok is True else BAD


def doors(view: View, _before: View | None, _limits: Limits) -> Flags:
    """S13."""
    return None if view.sample.doors_ok is True else BAD


# -- the table: first in the table is first-out when several trip in one block -----------------------

_SIGNALS: Final = ("pressure", "speed", "torque", "temperature")
_MakeCheck = Callable[[Callable[[View], Signal]], CheckFunction]


def _for_each_signal(
    kind: str, make: _MakeCheck, persistence: str | int, shown: str, *, per_block: bool
) -> list[Check]:
    return [
        Check(
            f"{name}_{kind}", make(attrgetter(name)), persistence, per_block=per_block,
            value=attrgetter(f"{name}.{shown}"),
        )
        for name in _SIGNALS
    ]  # fmt: skip


def _highest_power(view: View) -> float:
    return max(view.powers_kw(), default=nan)


CHECKS: Final[tuple[Check, ...]] = (
    Check("samples_gap", samples_gap, 1, per_block=True, value=attrgetter("sample.k")),
    Check("samples_clock", samples_clock, 1, per_block=True, value=attrgetter("sample.dt_s")),
    Check("safety_channel", safety_channel, 1, per_block=True, value=attrgetter("sample.channel_fault")),
    *_for_each_signal("stale", stale, "freshness.stale_blocks", "count", per_block=True),
    *_for_each_signal("invalid", invalid, "sanity.invalid_readings", "invalid", per_block=False),
    *_for_each_signal("frozen", frozen, 1, "run", per_block=True),
    Check("relay_welded", relay_welded, "relay.readback_blocks", always=True, per_block=True),
    Check("relay_not_closed", relay_not_closed, "relay.readback_blocks", per_block=True),
    Check("drive_enabled", drive_enabled, "relay.enabled_blocks", always=True, per_block=True),
    Check("estop", estop, 1, per_block=True),
    Check("doors", doors, 1, per_block=True),
    Check(
        "pressure_peak", pressure_peak, "pressure.peak_readings", always=True,
        value=attrgetter("pressure.high"), threshold="pressure.peak_bar",
    ),
    Check(
        "pressure_range", pressure_range, "pressure.readings", always=True,
        value=attrgetter("pressure.high"), threshold="pressure.max_bar",
        low=attrgetter("pressure.low"), floor="pressure.min_bar",
    ),
    Check(
        "speed_range", speed_range, "speed.readings", always=True,
        value=attrgetter("speed.high"), threshold="speed.max_rpm",
        low=attrgetter("speed.low"), floor="speed.min_rpm",
    ),
    Check(
        "torque_range", torque_range, "torque.readings", always=True,
        value=attrgetter("torque.high"), threshold="torque.max_nm",
        low=attrgetter("torque.low"), floor="torque.min_nm",
    ),
    Check(
        "temperature_range", temperature_range, "disc_temperature.readings", always=True,
        value=attrgetter("temperature.high"), threshold="disc_temperature.max_degc",
        low=attrgetter("temperature.low"), floor="disc_temperature.min_degc",
    ),
    Check(
        "temperature_approach", temperature_approach, "disc_temperature.approach_blocks", always=True,
        per_block=True, value=attrgetter("temperature.high"), threshold="disc_temperature.max_degc",
    ),
    Check(
        "power_peak", power_peak, "power.peak_readings", always=True,
        value=_highest_power, threshold="power.peak_kw",
    ),
    Check(
        "power_range", power_range, "power.readings", always=True,
        value=_highest_power, threshold="power.max_kw",
    ),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Verdict:
    """A check that is failed now."""

    check: Check
    cause: Cause


class CheckRunner:
    """The counters of all checks. `ran` has one bit per check that was run on the last block."""

    def __init__(self, limits: Limits, checks: Sequence[Check] = CHECKS) -> None:
        self._limits = limits
        self._checks = checks
        self._functions = [(1 << index, check.function) for index, check in enumerate(checks)]
        self._persistence = [
            check.persistence
            if isinstance(check.persistence, int)
            else int(attrgetter(check.persistence)(limits))
            for check in checks
        ]
        self._counts = [0] * len(checks)
        self.expected: Final = (1 << len(checks)) - 1
        self.ran = 0

    def run(self, view: View, before: View | None) -> list[Verdict]:
        """Run every check on one block; the verdicts that hold now, in the order of the table."""
        limits = self._limits
        flagged: dict[int, Sequence[bool]] = {}
        ran = 0
        for bit, function in self._functions:
            flags = function(view, before, limits)
            if flags is not None:
                flagged[bit] = flags
            ran |= bit
        self.ran = ran
        if not flagged and not any(self._counts):
            return []
        return self._count(view, flagged)

    def _count(self, view: View, flagged: dict[int, Sequence[bool]]) -> list[Verdict]:
        verdicts: list[Verdict] = []
        for index, check in enumerate(self._checks):
            count, trip_at = self._counts[index], self._persistence[index]
            flags = flagged.get(1 << index)
            if flags is None:
                self._counts[index] = max(0, count - (1 if check.per_block else view.pressure.count))
                continue
            tripped = False
            for bad in flags:
                count = min(trip_at, count + 1) if bad else max(0, count - 1)
                tripped = tripped or count >= trip_at
            self._counts[index] = count
            if tripped:
                verdicts.append(Verdict(check, self._cause(check, view)))
        return verdicts

    def _cause(self, check: Check, view: View) -> Cause:
        if check.low is not None:
            lowest, floor = check.low(view), attrgetter(check.floor)(self._limits)
            if lowest < floor:
                return Cause(check.id, lowest, floor)
        value = check.value(view) if check.value is not None else None
        threshold = attrgetter(check.threshold)(self._limits) if check.threshold else None
        return Cause(check.id, value, threshold)

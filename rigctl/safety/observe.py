"""One block as the checks see it: extremes, means and runs of the readings, computed once per block.

Job: a pure function (sample, what was seen before) -> view. Everything a check needs to remember lives in the
view of the block before, so a check can be replayed on recorded samples. Not its job: limits.
"""

from __future__ import annotations

from math import isfinite, nan, pi
from typing import Final, cast

from rigctl.core.safety_link import SafetySample

RATE_WINDOW_S: Final = 0.5  # the rate of the temperature is taken over 0.5 to 1 s
_KW_PER_NM_RPM: Final = pi / 30.0 / 1000.0


class Signal:
    """Readings of one signal in one block.

    Attributes
    ----------
    values : tuple of float
        The readings; what is no finite number has become NaN.
    count, invalid : int
        Number of readings, and how many of them are NaN.
    low, high, mean : float
        Over the valid readings; NaN when there is none.
    last : float
        The newest reading; NaN when it is invalid or missing.
    run : int
        For how many readings the signal has been one and the same number.
    """

    __slots__ = ("count", "high", "invalid", "last", "low", "mean", "run", "values")

    def __init__(self, values: tuple[float | None, ...], before: Signal | None) -> None:
        count = len(values)
        try:
            total: float = sum(cast("tuple[float, ...]", values))  # TypeError where one is None
            clean = count > 0 and total - total == 0.0
        except TypeError:
            total, clean = 0.0, False
        if clean:
            self.values: tuple[float, ...] = cast("tuple[float, ...]", values)
            low: float = min(self.values)
            high: float = max(self.values)
            self.invalid = 0
            self.mean: float = total / count
        else:
            self.values = tuple([_number(value) for value in values])
            valid = [value for value in self.values if isfinite(value)]
            self.invalid = count - len(valid)
            low, high, self.mean = (
                (min(valid), max(valid), sum(valid) / len(valid)) if valid else (nan, nan, nan)
            )
        self.count = count
        self.last = self.values[-1] if count else nan
        self.low: float = low
        self.high: float = high
        # A block of different numbers has run 0, so only its last number matters to the next one.
        self.run = 0
        if low == high:
            self.run = count + (before.run if before is not None and before.high == low else 0)


def _number(value: object) -> float:
    """The finite number, or NaN for everything else."""
    if isinstance(value, (int, float)) and isfinite(value):
        return value
    return nan


class View:
    """One block, ready for the checks. See `Signal` for the four signals."""

    __slots__ = (
        "anchor_degc",
        "anchor_next_degc",
        "anchor_next_s",
        "anchor_s",
        "pressure",
        "relay_wanted",
        "sample",
        "speed",
        "temperature",
        "torque",
    )  # fmt: skip

    def __init__(self, sample: SafetySample, before: View | None, relay_wanted: bool) -> None:
        self.sample = sample
        self.relay_wanted = relay_wanted
        if before is None:
            self.pressure = Signal(sample.pressure_bar, None)
            self.speed = Signal(sample.speed_rpm, None)
            self.torque = Signal(sample.torque_nm, None)
            temperature = self.temperature = Signal(sample.temperature_degc, None)
            self.anchor_s = self.anchor_next_s = sample.t_s
            self.anchor_degc = self.anchor_next_degc = temperature.mean
            return
        self.pressure = Signal(sample.pressure_bar, before.pressure)
        self.speed = Signal(sample.speed_rpm, before.speed)
        self.torque = Signal(sample.torque_nm, before.torque)
        temperature = self.temperature = Signal(sample.temperature_degc, before.temperature)
        if sample.t_s - before.anchor_next_s >= RATE_WINDOW_S:
            self.anchor_s, self.anchor_degc = before.anchor_next_s, before.anchor_next_degc
            self.anchor_next_s, self.anchor_next_degc = sample.t_s, temperature.mean
        else:
            self.anchor_s, self.anchor_degc = before.anchor_s, before.anchor_degc
            self.anchor_next_s, self.anchor_next_degc = before.anchor_next_s, before.anchor_next_degc

    @property
    def all_valid(self) -> bool:
        """Whether every reading of the block is a number."""
        return not (
            self.pressure.invalid or self.speed.invalid or self.torque.invalid or self.temperature.invalid
        )

    def temperature_rate_k_per_s(self) -> float:
        """Rise of the disc temperature over the last 0.5 to 1 s; 0 before that much has been seen."""
        span_s = self.sample.t_s - self.anchor_s
        if span_s < RATE_WINDOW_S:
            return 0.0
        return (self.temperature.mean - self.anchor_degc) / span_s

    def power_kw(self) -> float:
        """Mean friction power of the block, eq. P = M·ω."""
        return abs(self.torque.mean * self.speed.mean) * _KW_PER_NM_RPM

    def highest_power_kw(self) -> float:
        """Bound of the friction power in the block: largest torque times largest speed."""
        torque, speed = self.torque, self.speed
        return max(torque.high, -torque.low) * max(speed.high, -speed.low) * _KW_PER_NM_RPM

    def powers_kw(self) -> tuple[float, ...]:
        """Friction power reading by reading."""
        pairs = zip(self.torque.values, self.speed.values, strict=False)
        return tuple([abs(torque * speed) * _KW_PER_NM_RPM for torque, speed in pairs])

    def at_rest(self, pressure_bar: float, speed_rpm: float) -> bool:
        """Whether the last readings of pressure and speed are valid and below both bounds."""
        pressure, speed = self.pressure.last, self.speed.last
        return -pressure_bar < pressure < pressure_bar and -speed_rpm < speed < speed_rpm

"""Ranges and ticks of axes that a person can rest the eye on.

Job: round ranges that follow the data without twitching, tick distances, clock times as text. Pure
Python, no Qt. Not its job: painting.
"""

from __future__ import annotations

import math

SHRINK_BELOW = 0.45
"""A range is made smaller when the data need less than this share of it ..."""
SHRINK_AFTER_S = 4.0
"""... for so long."""
_TIME_STEPS_S = (1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400)


def nice_step(span: float, parts: float) -> float:
    """1, 2 or 5 times a power of ten, so that `span` has at most about `parts` steps."""
    if not span > 0 or not math.isfinite(span):
        return 1.0
    raw = span / max(parts, 1.0)
    power = 10.0 ** math.floor(math.log10(raw))
    for factor in (1.0, 2.0, 5.0):
        if raw <= factor * power * (1 + 1e-9):
            return factor * power
    return 10.0 * power


def nice_time_step(span_s: float, parts: float) -> float:
    """Seconds between ticks that a clock reader expects."""
    raw = span_s / max(parts, 1.0)
    if raw <= 0.5:
        return nice_step(span_s, parts)
    return float(next((step for step in _TIME_STEPS_S if raw <= step), nice_step(span_s, parts)))


def clock_text(t_s: float, step_s: float = 1.0) -> str:
    """Rig time as h:mm:ss, with as many decimals as the step needs: "1:02:33", "2:33.25"."""
    decimals = 0 if step_s >= 1.0 else min(max(math.ceil(-math.log10(step_s) - 1e-9), 0), 6)
    sign = "-" if t_s < 0 else ""
    ticks = round(abs(t_s) * 10**decimals)
    whole, part = divmod(ticks, 10**decimals)
    hours, rest = divmod(whole, 3600)
    minutes, seconds = divmod(rest, 60)
    text = f"{hours}:{minutes:02d}:{seconds:02d}" if hours else f"{minutes}:{seconds:02d}"
    return f"{sign}{text}.{part:0{decimals}d}" if decimals else sign + text


def number_decimals(step: float) -> int:
    """Decimals that tell values `step` apart."""
    return 0 if step >= 1.0 else min(max(math.ceil(-math.log10(step) - 1e-9), 0), 6)


class CalmRange:
    """A range that follows data: grows at once, shrinks late, always in round numbers.

    Parameters
    ----------
    least : float
        Smallest span, so that noise is not blown up.
    symmetric : bool
        Keep zero in the middle (sound pressure).
    zero : bool
        Keep zero at the bottom while the data are not below (or at the top, while not above).
    start : (float, float)
        Before there are data.
    """

    def __init__(
        self,
        least: float,
        *,
        symmetric: bool = False,
        zero: bool = False,
        start: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        self._least = least
        self._symmetric = symmetric
        self._zero = zero
        self._small_since: float | None = None
        self._fresh = True
        self.low, self.high = self._round(*start)

    def follow(self, low: float, high: float, now_s: float) -> tuple[float, float]:
        """The range for data between `low` and `high`; `now_s` is any clock."""
        wanted = self._round(low, high)
        if self._fresh:
            self._fresh = False
            self.low, self.high = wanted
        elif wanted[0] < self.low or wanted[1] > self.high:
            inside = wanted[0] >= self.low or wanted[1] <= self.high
            self.low, self.high = (min(self.low, wanted[0]), max(self.high, wanted[1])) if inside else wanted
            if self.high - self.low > (wanted[1] - wanted[0]) / SHRINK_BELOW:
                self.low, self.high = wanted
            self._small_since = None
        elif wanted[1] - wanted[0] < SHRINK_BELOW * (self.high - self.low):
            if self._small_since is None:
                self._small_since = now_s
            elif now_s - self._small_since >= SHRINK_AFTER_S:
                self.low, self.high = wanted
                self._small_since = None
        else:
            self._small_since = None
        return self.low, self.high

    def _round(self, low: float, high: float) -> tuple[float, float]:
        if self._symmetric:
            reach = max(abs(low), abs(high), self._least / 2)
            step = nice_step(reach, 4)
            top = math.ceil(reach / step - 1e-9) * step
            return -top, top
        if self._zero:
            span = max(abs(low), abs(high), self._least)
            near = 0.05 * span  # noise around zero does not open the other side
            low, high = (0.0 if low > -near else low), (0.0 if high < near else high)
        if high - low < self._least:
            if self._zero and low == 0.0:
                high = low + self._least
            else:
                middle = (low + high) / 2
                low, high = middle - self._least / 2, middle + self._least / 2
        step = nice_step(high - low, 5)
        return math.floor(low / step + 1e-9) * step, math.ceil(high / step - 1e-9) * step

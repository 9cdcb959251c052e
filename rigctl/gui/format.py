"""Numbers as people read them: fixed decimals, units, h:mm:ss, Hz below 10 kHz.

Pure functions without Qt. Not their job: colours and places.
"""

from __future__ import annotations

import math
from datetime import datetime

MISSING = "—"


def number_text(value: float | None, decimals: int = 1) -> str:
    """Fixed decimals; a dash when there is no value; never "-0.0"."""
    if value is None or not math.isfinite(value):
        return MISSING
    text = f"{value:.{decimals}f}"
    return text[1:] if text.startswith("-") and not text.strip("-0.") else text


def signed_text(value: float | None, decimals: int = 2) -> str:
    """Fixed decimals with sign; never "-0.00"."""
    if value is None or not math.isfinite(value):
        return MISSING
    text = f"{value:+.{decimals}f}"
    return text if text.strip("+-0.") else f"{0.0:.{decimals}f}"


def quantity_text(value: float | None, unit: str, decimals: int = 1) -> str:
    """Number and unit with a narrow no-break space between."""
    return f"{number_text(value, decimals)}\u202f{unit}"


def time_text(seconds: float | None) -> str:
    """h:mm:ss, without hours below one hour: "1:42:10", "4:05"."""
    if seconds is None or not math.isfinite(seconds):
        return MISSING
    whole = max(round(seconds), 0)
    hours, rest = divmod(whole, 3600)
    minutes, secs = divmod(rest, 60)
    return f"{hours}:{minutes:02d}:{secs:02d}" if hours else f"{minutes}:{secs:02d}"


def frequency_text(hertz: float | None) -> str:
    """Hz below 10 kHz, kHz above."""
    if hertz is None or not math.isfinite(hertz):
        return MISSING
    return f"{hertz:.0f}\u202fHz" if hertz < 10_000 else f"{hertz / 1000:.2f}\u202fkHz"


def clock_text(utc: str) -> str:
    """Local time of day of an ISO time, "12:03:10"; a dash when it is none."""
    try:
        return datetime.fromisoformat(utc).astimezone().strftime("%H:%M:%S")
    except ValueError:
        return MISSING


def bytes_text(count: float | None) -> str:
    """MB, GB or TB with three significant figures."""
    if count is None or not math.isfinite(count):
        return MISSING
    for factor, unit in ((1e12, "TB"), (1e9, "GB"), (1e6, "MB")):
        if count >= factor:
            return f"{count / factor:.3g}\u202f{unit}"
    return f"{count / 1e3:.0f}\u202fkB"

"""Microphone by acoustic calibrator: from counts at 94 or 114 dB to Pa per count, and what is wrong.

Job: judge one or more recordings of a calibrator, drift against the calibration before. Not its job: reading
a tone (`rigctl.signals.calibration`), recording it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from rigctl.calibration.fault import Fault
from rigctl.calibration.record import Point
from rigctl.signals.calibration import clipped_share, read_calibrator

LEVELS_DB = (94.0, 114.0)
TONE_HZ = 1000.0
MAX_SPREAD_DB = 0.1
MIN_TONE_TO_REST_DB = 40.0
MAX_LINEARITY_DB = 0.2
MAX_DRIFT_DB = 0.5
"""More than this against the calibration before is said; a working microphone stays within some tenths."""
MAX_ERROR_DB = 6.0
_TONE_WINDOW_HZ = 20.0


@dataclass(frozen=True, slots=True)
class Recording:
    """What one recording of a calibrator says."""

    level_db: float
    pa_per_count: float
    frequency_hz: float
    spread_db: float
    tone_to_rest_db: float
    clipped: bool
    seconds: float

    def point(self) -> Point:
        """As it is kept."""
        scatter = self.pa_per_count * (10.0 ** (self.spread_db / 20.0) - 1.0)
        return Point(applied=self.level_db, measured=self.pa_per_count, scatter=scatter)


@dataclass(frozen=True)
class MicrophoneResult:
    """Result of all recordings.

    Attributes
    ----------
    gain : float
        true sound pressure = gain · nominal value.
    drift_db : float or None
        Of the sensitivity since the calibration before.
    """

    gain: float
    pa_per_count: float
    drift_db: float | None
    figures: dict[str, float]
    faults: tuple[Fault, ...]

    @property
    def acceptable(self) -> bool:
        """True when nothing forbids to save it."""
        return not any(fault.fatal for fault in self.faults)


def read(counts: Any, rate_hz: float, level_db: float) -> Recording:
    """Read one recording, counts of shape (n,), at least half a second.

    Raises
    ------
    ValueError
        It is too short or silent.
    """
    samples = np.asarray(counts)
    found = read_calibrator(samples, rate_hz, level_db)
    return Recording(
        level_db=level_db,
        pa_per_count=found.pa_per_count,
        frequency_hz=found.frequency_hz,
        spread_db=found.level_spread_db,
        tone_to_rest_db=found.tone_to_rest_db,
        clipped=clipped_share(samples) > 0.0,
        seconds=len(samples) / rate_hz,
    )


def evaluate(
    recordings: Sequence[Recording], nominal_pa_per_count: float, last_gain: float | None
) -> MicrophoneResult:
    """Pa per count over all recordings, drift, and what speaks against it.

    Parameters
    ----------
    recordings : sequence of Recording
        At least one.
    nominal_pa_per_count : float
        Of the uncalibrated channel.
    last_gain : float or None
        Gain of the calibration in force.
    """
    if not recordings:
        raise ValueError("no recording of a calibrator yet")
    logs = [math.log10(recording.pa_per_count) for recording in recordings]
    pa_per_count = 10.0 ** (sum(logs) / len(logs))
    gain = pa_per_count / nominal_pa_per_count
    faults = [fault for recording in recordings for fault in _faults(recording)]
    figures = {
        "spread_db": max(recording.spread_db for recording in recordings),
        "tone_to_rest_db": min(recording.tone_to_rest_db for recording in recordings),
        "frequency_hz": recordings[-1].frequency_hz,
        "error_db": 20.0 * math.log10(gain),
    }
    linearity_db = 20.0 * (max(logs) - min(logs))
    if len({recording.level_db for recording in recordings}) > 1:
        figures["linearity_db"] = linearity_db
        if linearity_db > MAX_LINEARITY_DB:
            faults.append(
                Fault(
                    f"the levels disagree by {linearity_db:.2f} dB, allowed {MAX_LINEARITY_DB:g} dB",
                    "Seat the calibrator again; check the gain of the amplifier.",
                )
            )
    drift_db = None if last_gain is None else -20.0 * math.log10(gain / last_gain)
    if drift_db is not None:
        figures["drift_db"] = drift_db
        if abs(drift_db) > MAX_DRIFT_DB:
            faults.append(
                Fault(
                    f"the sensitivity has changed by {drift_db:+.2f} dB since the last calibration",
                    "Seat the calibrator again; when it stays so, the microphone may be damaged.",
                    fatal=False,
                )
            )
    if abs(figures["error_db"]) > MAX_ERROR_DB:
        faults.append(
            Fault(
                f"the chain is {figures['error_db']:+.1f} dB off its nominal sensitivity",
                "Check the level set at the calibrator and the gain of the amplifier.",
            )
        )
    return MicrophoneResult(gain, pa_per_count, drift_db, figures, tuple(faults))


def level_of(pa_per_count: float, nominal_pa_per_count: float, level_db: float) -> float:
    """Level that the uncalibrated chain shows for a calibrator of `level_db`, dB."""
    return level_db + 20.0 * math.log10(nominal_pa_per_count / pa_per_count)


def _faults(recording: Recording) -> list[Fault]:
    at = f"at {recording.level_db:g} dB"
    found = []
    if recording.clipped:
        found.append(Fault(f"{at}: the converter is at its limit", "Lower the gain, or use 94 dB."))
    if abs(recording.frequency_hz - TONE_HZ) > _TONE_WINDOW_HZ:
        found.append(
            Fault(
                f"{at}: the loudest tone is at {recording.frequency_hz:.0f} Hz, not at 1 kHz",
                "Switch the calibrator on and push it on to its stop.",
            )
        )
    if recording.tone_to_rest_db < MIN_TONE_TO_REST_DB:
        found.append(
            Fault(
                f"{at}: the tone is only {recording.tone_to_rest_db:.0f} dB above the rest",
                "Push the calibrator on to its stop; switch the ventilator off.",
            )
        )
    if recording.spread_db > MAX_SPREAD_DB:
        found.append(
            Fault(
                f"{at}: the level moves by {recording.spread_db:.2f} dB",
                "Wait until the tone is steady; check the battery of the calibrator.",
            )
        )
    return found

"""The microphone calibration as data: recordings of a calibrator, result, file to be kept.

Job: keep one recording for each level (the newest), ask for the evaluation, make the file. Plain Python, no
Qt. Not its job: the evaluation (`rigctl.calibration.microphone` loads scipy: in a process of its own).
"""

from __future__ import annotations

from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

from rigctl.calibration.record import Calibration, Quantity
from rigctl.core.channels import MICROPHONE

if TYPE_CHECKING:
    from rigctl.calibration.microphone import MicrophoneResult, Recording

RECORD_S = 3.0


def read_and_evaluate(
    counts: Any, rate_hz: float, level_db: float, others: list[Any], nominal: float, last_gain: float | None
) -> tuple[Recording, MicrophoneResult]:
    """For a process of its own: read one recording, evaluate it with the ones before.

    Raises
    ------
    ValueError
        The recording is silent or too short.
    """
    from rigctl.calibration import microphone

    recording = microphone.read(counts, rate_hz, level_db)
    return recording, microphone.evaluate([*others, recording], nominal, last_gain)


class SoundGuide:
    """One procedure.

    Parameters
    ----------
    nominal_pa_per_count : float
    last_gain : float or None
        Gain of the calibration in force.
    """

    def __init__(self, nominal_pa_per_count: float, last_gain: float | None) -> None:
        self.nominal_pa_per_count = nominal_pa_per_count
        self.last_gain = last_gain
        self.recordings: dict[float, Recording] = {}
        self.result: MicrophoneResult | None = None

    def others(self, level_db: float) -> list[Recording]:
        """Recordings of other levels than this."""
        return [recording for level, recording in self.recordings.items() if level != level_db]

    def take(self, recording: Recording, result: MicrophoneResult) -> None:
        """A new recording, in place of the older one of its level, and the result with it."""
        self.recordings[recording.level_db] = recording
        self.result = result

    def calibration(
        self, *, rig: str, operator: str, instrument: str, reference: str, valid_days: int, note: str = ""
    ) -> Calibration:
        """The file to be kept.

        Raises
        ------
        ValueError
            There is no recording, or the result must not be used.
        """
        result = self.result
        if result is None:
            raise ValueError("there is no recording yet")
        if not result.acceptable:
            raise ValueError("; ".join(fault.words for fault in result.faults if fault.fatal))
        return Calibration(
            quantity=Quantity.MICROPHONE, channel=MICROPHONE, unit="Pa", rig=rig, date=datetime.now(UTC),
            operator=operator, instrument=instrument, reference=reference, gain=result.gain,
            nominal_scale=self.nominal_pa_per_count, figures=result.figures,
            points=tuple(recording.point() for recording in self.recordings.values()),
            valid_days=valid_days, note=note,
        )  # fmt: skip

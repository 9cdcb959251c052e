"""The emissivity calibration as data: pairs of readings, result, file to be kept.

Job: pairs of contact thermometer and pyrometer, the choice where the correction is made. Plain Python, no Qt.
Not its job: the evaluation (`rigctl.calibration.emissivity`).
"""

from __future__ import annotations

from datetime import UTC, datetime

from rigctl.calibration.emissivity import EmissivityResult, Pyrometer, evaluate
from rigctl.calibration.record import Calibration, Point, Quantity
from rigctl.core.channels import DISC_TEMPERATURE


class HeatGuide:
    """One procedure."""

    def __init__(self, nominal_scale: float = 1.0) -> None:
        self.nominal_scale = nominal_scale
        self.pyrometer = Pyrometer()
        self.points: list[Point] = []

    def take(self, contact_degc: float, pyrometer_degc: float, scatter_k: float) -> None:
        """One pair."""
        self.points.append(Point(applied=contact_degc, measured=pyrometer_degc, scatter=scatter_k))

    def remove(self, number: int) -> None:
        """A pair is not to count."""
        del self.points[number]

    def result(self) -> tuple[EmissivityResult | None, str]:
        """What the pairs say, or why they say nothing."""
        if not self.points:
            return None, ""
        try:
            return evaluate(self.points, self.pyrometer), ""
        except ValueError as error:
            return None, str(error)

    def calibration(
        self, *, rig: str, operator: str, instrument: str, reference: str, valid_days: int,
        in_channel: bool, note: str = "",
    ) -> Calibration:  # fmt: skip
        """The file to be kept; `in_channel`: the channel is corrected, the pyrometer keeps its setting.

        Raises
        ------
        ValueError
            There is no result, or it must not be used.
        """
        result, why = self.result()
        if result is None:
            raise ValueError(why or "there is no pair of readings yet")
        if not result.acceptable:
            raise ValueError("; ".join(fault.words for fault in result.faults if fault.fatal))
        place = "corrected in the channel" if in_channel else "to be set at the pyrometer"
        return Calibration(
            quantity=Quantity.EMISSIVITY, channel=DISC_TEMPERATURE, unit="°C", rig=rig,
            date=datetime.now(UTC), operator=operator, instrument=instrument, reference=reference,
            gain=result.gain if in_channel else 1.0, offset=result.offset if in_channel else 0.0,
            nominal_scale=self.nominal_scale, emissivity=result.emissivity,
            figures={**result.figures, "emissivity_set": self.pyrometer.emissivity_set},
            points=tuple(self.points), valid_days=valid_days, note=f"{place}. {note}".strip(),
        )  # fmt: skip

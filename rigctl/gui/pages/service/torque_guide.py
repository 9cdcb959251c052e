"""The guided torque calibration as data: which step is next, what was read, what follows.

Job: order of steps, readings, repeating one, the result so far and the file to be kept. Plain Python, no Qt:
the widget only shows it. Not its job: the evaluation (`rigctl.calibration.torque`).
"""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime

from rigctl.calibration.record import Calibration, Point, Quantity
from rigctl.calibration.torque import Lever, Step, TorqueResult, evaluate, steps
from rigctl.core.channels import PRESSURE, SPEED, TORQUE

REST_RPM = 1.0
REST_BAR = 1.0
CHANNELS = (TORQUE, SPEED, PRESSURE)


class TorqueGuide:
    """One procedure from its first step to its file.

    Parameters
    ----------
    lever : Lever
    full_scale_nm : float
        Largest torque of the rig.
    nominal_scale : float
        Scale of the uncalibrated channel.
    """

    def __init__(self, lever: Lever, full_scale_nm: float, nominal_scale: float = 1.0) -> None:
        self.lever = lever
        self.full_scale_nm = full_scale_nm
        self.nominal_scale = nominal_scale
        self.steps = steps(lever)
        self.points: list[Point | None] = [None] * len(self.steps)
        self.at = 0

    @property
    def step(self) -> Step | None:
        """The step that waits for its reading; None when all are done."""
        return self.steps[self.at] if self.at < len(self.steps) else None

    @property
    def complete(self) -> bool:
        """True when every step has its reading."""
        return all(point is not None for point in self.points)

    def problem(self, readings: Mapping[str, float]) -> str:
        """Why a reading must not be taken now, by the means of speed and pressure; "" when it may."""
        if not abs(readings.get(SPEED, 0.0)) <= REST_RPM:
            return f"the shaft turns with {readings[SPEED]:.1f} 1/min: bring the rig to rest"
        if not readings.get(PRESSURE, 0.0) <= REST_BAR:
            return f"the brake is pressed with {readings[PRESSURE]:.1f} bar: release it"
        return ""

    def take(self, measured_nm: float, scatter_nm: float) -> None:
        """The reading of the present step; goes on to the next one without a reading."""
        step = self.step
        if step is None:
            raise ValueError("all readings are taken")
        self.points[self.at] = Point(
            applied=step.applied_nm, measured=measured_nm, scatter=scatter_nm, series=step.series
        )
        waiting = (number for number, point in enumerate(self.points) if point is None)
        self.at = next(waiting, len(self.steps))

    def repeat(self, number: int) -> None:
        """Take the reading of a step again, next."""
        self.points[number] = None
        self.at = number

    @property
    def taken(self) -> list[Point]:
        """Readings so far, in the order of the steps."""
        return [point for point in self.points if point is not None]

    def result(self) -> TorqueResult | None:
        """What the readings so far say; None while they are too few for a line."""
        try:
            return evaluate(self.taken, self.full_scale_nm)
        except ValueError:
            return None

    def calibration(
        self, *, rig: str, operator: str, instrument: str, reference: str, valid_days: int, note: str = ""
    ) -> Calibration:
        """The file to be kept.

        Raises
        ------
        ValueError
            Readings are missing, or the result must not be used.
        """
        result = self.result()
        if result is None or not self.complete:
            raise ValueError("readings are missing")
        if not result.acceptable:
            raise ValueError("; ".join(fault.words for fault in result.faults if fault.fatal))
        lever = self.lever
        weights = f"lever {lever.length_m:g} m, g = {lever.gravity:g} m/s²"
        return Calibration(
            quantity=Quantity.TORQUE, channel=TORQUE, unit="N·m", rig=rig, date=datetime.now(UTC),
            operator=operator, instrument=instrument,
            reference=f"{reference}; {weights}" if reference else weights,
            gain=result.gain, offset=result.offset, nominal_scale=self.nominal_scale,
            figures=result.figures, points=tuple(self.taken), valid_days=valid_days, note=note,
        )  # fmt: skip


def masses_in(text: str) -> tuple[float, ...]:
    """Masses typed as "5 10 20", with comma or point as decimal mark; separators are blanks and semicolons.

    Raises
    ------
    ValueError
        Something is no number.
    """
    found = []
    for word in text.replace(";", " ").split():
        try:
            found.append(float(word.strip(",").replace(",", ".")))
        except ValueError:
            raise ValueError(f"“{word}” is not a mass in kg") from None
    return tuple(found)

"""Torque by lever and weights: the steps, the line through the readings, its residuals, and what is wrong.

Job: torque of a load, the guided order of loads in both directions of rotation, least squares, hysteresis,
accept or reject. Not its job: taking the readings.

The readings are fitted as reading = a · torque + b, since the weights are the better known; the correction is
gain = 1/a, offset = −b/a.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from rigctl.calibration.fault import Fault
from rigctl.calibration.record import Point

STANDARD_GRAVITY = 9.80665
RIGHT, LEFT = 1, -1
_NAMES = {RIGHT: "right", LEFT: "left"}


class Lever(BaseModel):
    """Lever and weights.

    Attributes
    ----------
    length_m : float
        From the axis to the weights.
    masses_kg : tuple of float
        Loads from light to heavy, without zero.
    own_nm : float
        Moment of the lever itself; 0 when it is balanced.
    gravity : float
        Local acceleration of free fall, m/s².
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    length_m: float = Field(gt=0.0, le=5.0)
    masses_kg: tuple[float, ...] = Field(min_length=1, max_length=30)
    own_nm: float = Field(default=0.0, ge=0.0, le=500.0)
    gravity: float = Field(default=STANDARD_GRAVITY, ge=9.76, le=9.84)

    @model_validator(mode="after")
    def _rising(self) -> Lever:
        masses = self.masses_kg
        if masses[0] <= 0.0 or any(b <= a for a, b in pairwise(masses)):
            raise ValueError("the masses must rise and be above zero: give them from light to heavy")
        return self

    def torque_nm(self, mass_kg: float) -> float:
        """M = m g l + own moment."""
        return mass_kg * self.gravity * self.length_m + self.own_nm


@dataclass(frozen=True, slots=True)
class Step:
    """One step of the procedure: put these weights on, take a reading.

    Attributes
    ----------
    direction : int
        RIGHT or LEFT: side on which the lever hangs, the two directions of rotation.
    mass_kg : float
    course : str
        "up" while loads rise, "down" while they fall.
    applied_nm : float
    """

    direction: int
    mass_kg: float
    course: str
    applied_nm: float

    @property
    def series(self) -> str:
        """ "right up", "left down", …"""
        return f"{_NAMES[self.direction]} {self.course}"


def steps(lever: Lever) -> tuple[Step, ...]:
    """Zero, loads up, loads down, zero; on the right, then on the left. Torque on the left is negative."""
    found: list[Step] = []
    for direction in (RIGHT, LEFT):
        masses = (0.0, *lever.masses_kg)
        courses = [(mass, "up") for mass in masses] + [(mass, "down") for mass in reversed(masses[:-1])]
        found += [
            Step(direction, mass, course, direction * lever.torque_nm(mass)) for mass, course in courses
        ]
    return tuple(found)


class TorqueAcceptance(BaseModel):
    """What a torque chain must keep to, in % of full scale; starting values."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    residual_percent: float = Field(default=0.3, gt=0.0)
    hysteresis_percent: float = Field(default=0.3, gt=0.0)
    asymmetry_percent: float = Field(default=0.5, gt=0.0)
    zero_percent: float = Field(default=0.2, gt=0.0)
    scatter_percent: float = Field(default=1.0, gt=0.0)
    gain_percent: float = Field(default=5.0, gt=0.0)
    span_percent: float = Field(default=20.0, gt=0.0)


@dataclass(frozen=True)
class TorqueResult:
    """What the readings say.

    Attributes
    ----------
    gain, offset : float
        true torque = gain · reading + offset.
    residuals_nm : tuple of float
        Corrected reading minus applied torque, per point.
    figures : dict
        residual_percent, hysteresis_percent, asymmetry_percent, zero_percent (largest, of full scale).
    faults : tuple of Fault
    """

    gain: float
    offset: float
    residuals_nm: tuple[float, ...]
    figures: dict[str, float]
    faults: tuple[Fault, ...]

    @property
    def acceptable(self) -> bool:
        """True when nothing forbids to save it."""
        return not any(fault.fatal for fault in self.faults)


def evaluate(
    points: Sequence[Point], full_scale_nm: float, accept: TorqueAcceptance | None = None
) -> TorqueResult:
    """Line through the readings, residuals, hysteresis, and what speaks against it.

    Parameters
    ----------
    points : sequence of Point
        `applied` in N·m with sign, `series` as `Step.series`.
    full_scale_nm : float
        Largest torque of the rig.

    Raises
    ------
    ValueError
        Fewer than three different loads.
    """
    accept = accept or TorqueAcceptance()
    applied = np.array([point.applied for point in points], dtype=np.float64)
    measured = np.array([point.measured for point in points], dtype=np.float64)
    if len(np.unique(applied)) < 3:
        raise ValueError("three different loads are needed for a line and its residuals")
    slope, intercept = _line(applied, measured)
    if not slope > 0.0:
        raise ValueError("the reading does not rise with the torque: check the sign of the channel")
    gain, offset = 1.0 / slope, -intercept / slope
    residuals = gain * measured + offset - applied
    percent = 100.0 / full_scale_nm
    figures = {
        "residual_percent": float(np.abs(residuals).max()) * percent,
        "hysteresis_percent": _hysteresis(points) * gain * percent,
        "zero_percent": _zero_return(points) * gain * percent,
        "scatter_percent": max(point.scatter for point in points) * percent,
        "span_percent": float(np.abs(applied).max()) * percent,
    }
    asymmetry = _asymmetry(points, gain)
    if asymmetry is not None:
        figures["asymmetry_percent"] = asymmetry
    faults = _faults(figures, gain, accept)
    return TorqueResult(gain, offset, tuple(residuals.tolist()), figures, faults)


def _line(x: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    mean_x, mean_y = x.mean(), y.mean()
    slope = float(((x - mean_x) * (y - mean_y)).sum() / ((x - mean_x) ** 2).sum())
    return slope, float(mean_y - slope * mean_x)


def _hysteresis(points: Sequence[Point]) -> float:
    """Largest difference of readings of one load between rising and falling loads, N·m."""
    largest = 0.0
    for side in ("right", "left"):
        up = {round(p.applied, 6): p.measured for p in points if p.series == f"{side} up"}
        down = {round(p.applied, 6): p.measured for p in points if p.series == f"{side} down"}
        largest = max([largest, *(abs(up[load] - down[load]) for load in up.keys() & down.keys())])
    return largest


def _zero_return(points: Sequence[Point]) -> float:
    """Largest difference between readings of the smallest load of a side, N·m: does the zero come back?"""
    largest = 0.0
    for side in ("right", "left"):
        of_side = [p for p in points if p.series.startswith(side)]
        if of_side:
            lowest = min(abs(p.applied) for p in of_side)
            zeros = [p.measured for p in of_side if math.isclose(abs(p.applied), lowest, abs_tol=1e-9)]
            largest = max(largest, max(zeros) - min(zeros))
    return largest


def _asymmetry(points: Sequence[Point], gain: float) -> float | None:
    """Difference of the slopes of both directions, % of the slope; None when only one was measured."""
    slopes = []
    for side in ("right", "left"):
        of_side = [p for p in points if p.series.startswith(side)]
        applied = np.array([p.applied for p in of_side])
        if len(np.unique(applied)) < 2:
            return None
        slopes.append(_line(applied, np.array([p.measured for p in of_side]))[0])
    return 100.0 * abs(slopes[0] - slopes[1]) * gain


def _faults(figures: dict[str, float], gain: float, accept: TorqueAcceptance) -> tuple[Fault, ...]:
    found: list[Fault] = []
    for key, limit, words, remedy in (
        ("residual_percent", accept.residual_percent, "largest residual",
         "Repeat the point that stands out; check lever length and masses."),
        ("hysteresis_percent", accept.hysteresis_percent, "hysteresis",
         "Something rubs or is loose: check lever bearing and sensor mounting."),
        ("zero_percent", accept.zero_percent, "the zero does not come back; it differs by",
         "Let the chain warm up; check that the lever hangs free."),
        ("scatter_percent", accept.scatter_percent, "scatter of a reading",
         "Wait until the weights hang still; switch the ventilator off."),
    ):  # fmt: skip
        if figures[key] > limit:
            found.append(Fault(f"{words} {figures[key]:.2f} % of full scale, allowed {limit:g} %", remedy))
    asymmetry = figures.get("asymmetry_percent")
    if asymmetry is None:
        found.append(Fault("only one direction of rotation was measured", "Load the other side too."))
    elif asymmetry > accept.asymmetry_percent:
        found.append(
            Fault(
                f"the two directions differ by {asymmetry:.2f} %, allowed {accept.asymmetry_percent:g} %",
                "Check that the lever is level on both sides and its length the same.",
            )
        )
    if abs(gain - 1.0) * 100.0 > accept.gain_percent:
        found.append(
            Fault(
                f"the gain {gain:.4f} is more than {accept.gain_percent:g} % off",
                "Check lever length and masses; then the scale of the channel in the rig file.",
            )
        )
    if figures["span_percent"] < accept.span_percent:
        found.append(
            Fault(
                f"the largest load is only {figures['span_percent']:.0f} % of full scale",
                f"Load to {accept.span_percent:g} % at least, better to the torque of the tests.",
                fatal=False,
            )
        )
    return tuple(found)

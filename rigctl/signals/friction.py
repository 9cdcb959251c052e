"""Coefficient of friction between pad and disc from brake torque and line pressure.

Job: mu(t), the brake application in time, and the rule for "settled".
NOT its job: squeal, maps over a campaign (rigctl.analysis.friction_map).

The rule: pressure is "applied" where it exceeds p0 + `margin_bar`; the application runs from the first to the
last such sample. Its plateau is the median pressure of the applied samples. Mean mu is taken over the settled
part: from the first to the last sample that reaches `settled_share` of the plateau, there only where the
pressure is applied and the disc turns at more than `min_speed_rpm`.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from rigctl.core.units import PA_PER_BAR
from rigctl.signals._model import FrozenModel


class FrictionGeometry(FrozenModel):
    """What turns torque and pressure into mu; the defaults are the brake of domain.md 6."""

    piston_area_m2: float = Field(default=2.290e-3, gt=0, le=0.1)
    effective_radius_m: float = Field(default=0.105, gt=0, le=1.0)
    p0_bar: float = Field(default=0.5, ge=0, le=10)
    margin_bar: float = Field(default=0.5, gt=0, le=10)
    settled_share: float = Field(default=0.9, gt=0, lt=1)
    min_speed_rpm: float = Field(default=1.0, gt=0, le=1000)


@dataclass(frozen=True, slots=True)
class Application:
    """The brake application: sample ranges of the pressure channel. [start, stop) applied, settled inside
    it.
    """

    start: int
    stop: int
    settled_start: int
    settled_stop: int


def find_application(pressure_bar: NDArray[np.floating], geometry: FrictionGeometry) -> Application | None:
    """Find the brake application in a pressure course (shape (n,), bar); None when pressure never rises."""
    applied = np.flatnonzero(pressure_bar > geometry.p0_bar + geometry.margin_bar)
    if applied.size == 0:
        return None
    plateau_bar = float(np.median(pressure_bar[applied]))
    settled = applied[pressure_bar[applied] >= geometry.settled_share * plateau_bar]
    return Application(int(applied[0]), int(applied[-1]) + 1, int(settled[0]), int(settled[-1]) + 1)


def friction_coefficient(
    torque_nm: NDArray[np.floating],
    pressure_bar: NDArray[np.floating],
    speed_rpm: NDArray[np.floating],
    geometry: FrictionGeometry,
) -> NDArray[np.float64]:
    """mu(t) = |M| / (2 (p - p0) A r_eff).

    Parameters
    ----------
    torque_nm, pressure_bar, speed_rpm : ndarray, shape (n,)
        On one time grid. The sign of the torque (direction of rotation) is dropped.
    geometry : FrictionGeometry

    Returns
    -------
    ndarray, shape (n,)
        NaN where the pressure is not applied or the disc does not turn: mu is not defined there.
    """
    mu = np.full(pressure_bar.shape, np.nan)
    pressure = np.asarray(pressure_bar, dtype=np.float64)
    defined = (pressure > geometry.p0_bar + geometry.margin_bar) & (
        np.abs(speed_rpm) > geometry.min_speed_rpm
    )
    force_n = 2.0 * (pressure[defined] - geometry.p0_bar) * PA_PER_BAR * geometry.piston_area_m2
    mu[defined] = np.abs(np.asarray(torque_nm, dtype=np.float64)[defined]) / (
        force_n * geometry.effective_radius_m
    )
    return mu

"""Emissivity of the rub track: what a pyrometer shows against what a contact thermometer shows.

Job: emissivity from pairs of readings by Planck's law, the correction either at the pyrometer (new setting)
or in the channel (line over the range), and what is wrong. Not its job: taking the readings.

The pyrometer makes its reading T_r from the signal of the surface at T and the reflected surroundings at T_a:
e_set (L(T_r) − L(T_a)) = e (L(T) − L(T_a)), L the spectral radiance at its wavelength.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from rigctl.calibration.fault import Fault
from rigctl.calibration.record import Point
from rigctl.core.units import KELVIN_AT_0_DEGC

C2_UM_K = 14387.77
"""Second radiation constant h c / k_B, µm K."""
MIN_ABOVE_AMBIENT_K = 30.0
MAX_DISAGREEMENT_K = 3.0
LIKELY = (0.3, 1.0)


class Pyrometer(BaseModel):
    """What is set at the pyrometer.

    Attributes
    ----------
    wavelength_um : float
        Effective wavelength; the middle of 8 to 14 µm is 10.
    emissivity_set : float
    ambient_degc : float
        Of what the disc reflects.
    range_to_degc : float
        The channel's line is fitted up to here.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    wavelength_um: float = Field(default=10.0, ge=0.7, le=20.0)
    emissivity_set: float = Field(default=0.95, ge=0.05, le=1.0)
    ambient_degc: float = Field(default=20.0, ge=-40.0, le=60.0)
    range_to_degc: float = Field(default=500.0, ge=50.0, le=1500.0)

    def radiance(self, degc: float) -> float:
        """Planck, up to a constant factor."""
        return 1.0 / math.expm1(C2_UM_K / (self.wavelength_um * (degc + KELVIN_AT_0_DEGC)))

    def true_degc(self, reading_degc: float, emissivity: float) -> float:
        """Temperature of the surface behind a reading."""
        around = self.radiance(self.ambient_degc)
        signal = around + self.emissivity_set / emissivity * (self.radiance(reading_degc) - around)
        return C2_UM_K / (self.wavelength_um * math.log1p(1.0 / signal)) - KELVIN_AT_0_DEGC


@dataclass(frozen=True)
class EmissivityResult:
    """Emissivity with its two ways of being used.

    Attributes
    ----------
    emissivity : float
        To be set at the pyrometer.
    gain, offset : float
        Line that does nearly the same to the channel when the pyrometer keeps its setting.
    residuals_k : tuple of float
        Corrected reading minus contact reading.
    figures : dict
        residual_k, line_k (what the line leaves over the range), uncorrected_k.
    """

    emissivity: float
    gain: float
    offset: float
    residuals_k: tuple[float, ...]
    figures: dict[str, float]
    faults: tuple[Fault, ...]

    @property
    def acceptable(self) -> bool:
        """True when nothing forbids to save it."""
        return not any(fault.fatal for fault in self.faults)


def evaluate(points: Sequence[Point], pyrometer: Pyrometer) -> EmissivityResult:
    """Emissivity over all pairs (`applied`: contact thermometer, `measured`: pyrometer).

    Each pair weighs by its temperature above the surroundings, so that neither errors near them nor the one
    hottest pair dominate.

    Raises
    ------
    ValueError
        No pair that is hot enough.
    """
    around = pyrometer.radiance(pyrometer.ambient_degc)
    hot = [p for p in points if p.applied - pyrometer.ambient_degc >= MIN_ABOVE_AMBIENT_K]
    if not hot:
        raise ValueError(
            f"the disc must be {MIN_ABOVE_AMBIENT_K:g} K warmer than its surroundings: the emissivity "
            "cannot be seen below"
        )
    surface = np.array([pyrometer.radiance(p.applied) - around for p in hot])
    seen = np.array([pyrometer.emissivity_set * (pyrometer.radiance(p.measured) - around) for p in hot])
    weights = np.array([p.applied - pyrometer.ambient_degc for p in hot])
    found = float(np.average(seen / surface, weights=weights))
    faults: list[Fault] = []
    if not LIKELY[0] <= found <= LIKELY[1]:
        faults.append(
            Fault(
                f"an emissivity of {found:.3f} is not likely",
                "Both must look at the same place; wait until the contact thermometer is steady.",
            )
        )
    emissivity = min(max(found, 0.01), 1.0)
    residuals = [pyrometer.true_degc(p.measured, emissivity) - p.applied for p in hot]
    readings = np.linspace(pyrometer.ambient_degc + 10.0, pyrometer.range_to_degc, 60)
    true = np.array([pyrometer.true_degc(float(reading), emissivity) for reading in readings])
    gain, offset = (float(value) for value in np.polyfit(readings, true, 1))
    figures = {
        "residual_k": max(abs(residual) for residual in residuals),
        "line_k": float(np.abs(gain * readings + offset - true).max()),
        "uncorrected_k": max(abs(p.measured - p.applied) for p in hot),
    }
    if figures["residual_k"] > MAX_DISAGREEMENT_K:
        faults.append(
            Fault(
                f"the pairs disagree by {figures['residual_k']:.1f} K after correction",
                "Repeat the pair that stands out, with a steady temperature.",
            )
        )
    if len(hot) < 2:
        faults.append(
            Fault("there is one pair only", "A second one, 100 K higher, shows errors.", fatal=False)
        )
    return EmissivityResult(emissivity, gain, offset, tuple(residuals), figures, tuple(faults))

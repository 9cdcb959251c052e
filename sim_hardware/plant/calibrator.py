"""An acoustic calibrator on the microphone (IEC 60942): a closed coupler with a tone of 1 kHz.

Job: what the converter delivers with a calibrator on, or with a microphone whose sensitivity has drifted. Not
its job: the sound of the rig (`sound`), evaluating a calibration (`rigctl.signals.calibration`).
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from rigctl.core.units import REFERENCE_PRESSURE_PA
from sim_hardware.plant.sound import SOUND_HZ

TONE_HZ = 1000
COUPLER_DB = 30.0
"""By so much the closed coupler keeps the sound of the room out."""
_PERIOD = SOUND_HZ // TONE_HZ


class CalibratorOnMicrophone:
    """Keeps the phase of the tone from block to block.

    Parameters
    ----------
    full_scale_pa : float
        Full scale of the converter.
    """

    def __init__(self, full_scale_pa: float) -> None:
        self._counts_per_pa = 32768.0 / full_scale_pa
        self._wave = np.sin(2.0 * math.pi * np.arange(_PERIOD) / _PERIOD)
        self._at = 0

    def heard(self, counts: NDArray[np.int16], level_db: float, drift_db: float) -> NDArray[np.int16]:
        """Counts, shape (n,), as they are with the calibrator on (0 dB: none) and the microphone drifted."""
        sound = counts.astype(np.float64)
        if level_db > 0.0:
            amplitude = math.sqrt(2.0) * REFERENCE_PRESSURE_PA * 10.0 ** (level_db / 20.0)
            tone = np.take(self._wave, np.arange(self._at, self._at + len(counts)) % _PERIOD)
            sound = sound * 10.0 ** (-COUPLER_DB / 20.0) + amplitude * self._counts_per_pa * tone
        self._at = (self._at + len(counts)) % _PERIOD
        sound *= 10.0 ** (drift_db / 20.0)
        return np.clip(np.rint(sound), -32768, 32767).astype(np.int16)

"""What a model predicts, as plain data to be drawn into the measured picture.

Job: one frozen value. NOT its job: computing it (the brake model, called by the command line).
"""

import math
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Prediction:
    """Predicted onset of squeal: lowest unstable pressure, bar, and frequency of the unstable mode, Hz."""

    onset_bar: float
    frequency_hz: float
    label: str = "model"

    def __post_init__(self) -> None:
        if not (math.isfinite(self.onset_bar) and self.onset_bar >= 0):
            raise ValueError(
                f"onset_bar: {self.onset_bar} is no pressure. Pass no prediction when there is none"
            )
        if not (math.isfinite(self.frequency_hz) and self.frequency_hz > 0):
            raise ValueError(f"frequency_hz: {self.frequency_hz} is no frequency. Pass no prediction")

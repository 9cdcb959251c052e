"""What is drawn of one braking, as plain arrays that can be sent from process to process.

Job: the values; loads numpy only, so that the window can take them. NOT its job: computing them (`viewing`),
drawing (`rigctl.gui`).
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

MU, LEVEL = "mu", "level"
"""Names of the computed curves beside those of the channels."""


@dataclass(frozen=True)
class Curve:
    """A quantity over time: `values` float32, the first at `t0_s`, one every `dt_s`."""

    name: str
    unit: str
    t0_s: float
    dt_s: float
    values: NDArray[np.float32]
    description: str = ""

    def time_s(self) -> NDArray[np.floating[Any]]:
        """Time of each value, s."""
        return self.t0_s + np.arange(len(self.values)) * self.dt_s


@dataclass(frozen=True)
class SoundPicture:
    """Spectrogram: `level_db` (n_frames, n_lines); columns `dt_s` apart, the first centred at `t0_s`."""

    level_db: NDArray[np.float32]
    t0_s: float
    dt_s: float
    line_hz: float


@dataclass(frozen=True)
class Spectrum:
    """Mean and largest level per line while the brake was applied, dB, lines `line_hz` apart."""

    line_hz: float
    mean_db: NDArray[np.float32]
    peak_db: NDArray[np.float32]

    def frequency_hz(self) -> NDArray[np.floating[Any]]:
        """Frequencies of the lines."""
        return np.arange(len(self.mean_db)) * self.line_hz


@dataclass(frozen=True)
class BrakingView:
    """What is shown of a braking; `picture` and `spectrum` are None without sound."""

    path: Path
    summary: dict[str, Any]
    specification: dict[str, Any]
    metadata: dict[str, Any]
    settings: dict[str, Any]
    curves: dict[str, Curve]
    picture: SoundPicture | None
    spectrum: Spectrum | None


@dataclass(frozen=True)
class Listenable:
    """Sound within ±1; `gain_db` is against the one gain that all brakings share without equal loudness."""

    samples: NDArray[np.float32]
    rate_hz: float
    gain_db: float

"""What the model page and its worker tell each other: plain values, numpy at most.

Job: frozen values that pickle and can be compared. Not its job: computing (`worker`), what a person has
chosen (`state`). Nothing here imports the brake model, so that the window's process never loads it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rigctl.model.drawn_brake import Drawing, Motions

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

MU, PRESSURE, SLOPE = "mu", "pressure", "slope"
#: least and largest value of the three operating sliders: friction 1, pressure in bar, falling slope in s/m
OPERATING: Mapping[str, tuple[float, float]] = {MU: (0.0, 1.0), PRESSURE: (0.0, 60.0), SLOPE: (0.0, 0.2)}
#: least and largest factor of a parameter group
FACTORS = (0.25, 4.0)


@dataclass(frozen=True, slots=True)
class BrakeFile:
    """A brake file in the state in which it was read; `stamp` is its time of modification, ns."""

    path: Path
    stamp: int


@dataclass(frozen=True, slots=True)
class Knob:
    """Something of the brake that a factor is laid on.

    Attributes
    ----------
    key : "piston_stiffness", one side of it "piston_stiffness:leading", or a quantity's name
    title, unit, kind : for people; a group's members may have several units: ""
    members : names of quantities
    group, side : of a group: its name, and "" (all members), "leading" or "trailing"; of a quantity ""
    """

    key: str
    title: str
    unit: str
    kind: str
    members: tuple[str, ...]
    group: str = ""
    side: str = ""


@dataclass(frozen=True, slots=True)
class BrakeFacts:
    """A brake file, read: its operating values and what can be changed."""

    file: BrakeFile
    name: str
    description: str
    operating: Mapping[str, float]
    knobs: tuple[Knob, ...]

    def knob(self, key: str) -> Knob:
        """The knob of that key."""
        return next(knob for knob in self.knobs if knob.key == key)


@dataclass(frozen=True, slots=True)
class Setting:
    """Values of the sliders as the worker needs them: operating values, and factors by quantity."""

    mu: float
    pressure: float
    slope: float
    factors: tuple[tuple[str, float], ...] = ()

    @property
    def operating(self) -> dict[str, float]:
        """The three operating values by name."""
        return {MU: self.mu, PRESSURE: self.pressure, SLOPE: self.slope}


@dataclass(frozen=True, slots=True)
class Pole:
    """An eigenvalue with Im >= 0; `number` counts by frequency from 1, real ones first."""

    number: int
    eigenvalue: complex
    unstable: bool

    @property
    def frequency_hz(self) -> float:
        """Im / 2 pi."""
        return self.eigenvalue.imag / (2.0 * math.pi)

    @property
    def real_part_1_s(self) -> float:
        """Growth rate, 1/s."""
        return self.eigenvalue.real

    @property
    def damping_ratio(self) -> float:
        """-Re / |lambda|; negative: unstable."""
        size = abs(self.eigenvalue)
        return -self.eigenvalue.real / size if size else 0.0


@dataclass(frozen=True, slots=True)
class Shape:
    """A mode shape ready to be painted, and who takes part in it.

    Attributes
    ----------
    number : of the pole
    drawing, motions : the brake at rest, and how its bodies move
    bodies : (name, share of the kinetic energy), largest first
    couplings : (name, share of the strain energy), largest first
    dampers_1_s, friction_1_s : what they add to the real part
    doubtful : two modes nearly coincide; the shape is hardly its own
    """

    number: int
    drawing: Drawing
    motions: Motions
    bodies: tuple[tuple[str, float], ...]
    couplings: tuple[tuple[str, float], ...]
    dampers_1_s: float
    friction_1_s: float
    doubtful: bool


@dataclass(frozen=True, slots=True)
class Poles:
    """Answer to one position of the sliders.

    Attributes
    ----------
    shape : of the selected mode
    other : poles of the brake to compare with, or ()
    pick : number of the selection that this answers
    """

    setting: Setting
    poles: tuple[Pole, ...]
    shape: Shape
    other: tuple[Pole, ...]
    pick: int = 0

    @property
    def selected(self) -> Pole:
        """The pole whose shape is told."""
        return next(pole for pole in self.poles if pole.number == self.shape.number)


@dataclass(frozen=True, slots=True)
class OnsetFound:
    """Where a brake becomes unstable.

    Attributes
    ----------
    over : "pressure", or "mu" where friction does not fall with speed: pressure then has no effect
    limit : end of the range searched from 0
    value, frequency_hz : of the onset; None where stable throughout; frequency 0: divergence
    from_start : unstable at 0 already
    """

    over: str
    limit: float
    value: float | None
    frequency_hz: float | None
    from_start: bool


@dataclass(frozen=True, slots=True)
class Onsets:
    """Onset of the brake and of the one to compare with."""

    setting: Setting
    own: OnsetFound
    other: OnsetFound | None


@dataclass(frozen=True, slots=True)
class LocusLines:
    """Paths of all modes while one slider runs through its range.

    Attributes
    ----------
    over : key of the slider
    values : (g,) of the slider
    eigenvalues : (g, m) 1/s, Im >= 0
    crossings : (value, frequency in Hz, becomes unstable) where a mode crosses the boundary
    near : (real part from, to, frequency from, to) of what couples and of the boundary, for a closer look
    """

    over: str
    values: Array
    eigenvalues: Complex = field(repr=False)
    crossings: tuple[tuple[float, float, bool], ...]
    near: tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class MapAxis:
    """An axis of the stability map: key of a slider, and its range."""

    key: str
    low: float
    high: float


@dataclass(frozen=True)
class StabilityMap:
    """Stability over two sliders.

    Attributes
    ----------
    x, y : what they are
    x_values, y_values : (nx,), (ny,)
    growth_1_s : (ny, nx) largest real part
    frequency_hz : (ny, nx) of the unstable mode; nan where stable
    boundary : lines of (x, y, frequency in Hz), each (k,)
    contours : (frequency in Hz, lines (k, 2)) of the unstable mode
    unstable_share : of the area
    """

    x: MapAxis
    y: MapAxis
    x_values: Array
    y_values: Array
    growth_1_s: Array = field(repr=False)
    frequency_hz: Array = field(repr=False)
    boundary: tuple[tuple[Array, Array, Array], ...] = field(repr=False)
    contours: tuple[tuple[float, tuple[Array, ...]], ...] = field(repr=False)
    unstable_share: float


@dataclass(frozen=True, slots=True)
class Measured:
    """A squeal event of a braking (frequency in Hz, level in dB), or a braking without squeal (None)."""

    braking: int
    file: Path
    mu: float
    pressure_bar: float
    frequency_hz: float | None = None
    level_db: float | None = None


@dataclass(frozen=True, slots=True)
class CampaignPoints:
    """Measured points of a campaign; `without_place` could not be drawn: no mu or pressure was measured."""

    folder: Path
    squeals: tuple[Measured, ...]
    quiet: tuple[Measured, ...]
    without_place: int


@dataclass(frozen=True, slots=True)
class Advice:
    """A design modification and what it does; see `design.recommending`.

    Attributes
    ----------
    factors : knob key -> factor
    verdict : "recommended", "with care", "no effect", "not recommended"
    gain_1_s : fall of the sum of real parts
    worst_rise : largest rise of a real part, as share; of the mode at `rise_hz`
    onset_bar : onset of the modified brake; None where it never squeals
    sure : identity of modes is certain throughout
    """

    title: str
    factors: Mapping[str, float]
    verdict: str
    gain_1_s: float
    worst_rise: float
    rise_hz: float | None
    onset_bar: float | None
    sure: bool


@dataclass(frozen=True, slots=True)
class RankingRule:
    """Thresholds of the verdicts: see `design.recommending.RecommendationRule`; friction looked at."""

    below_hz: float
    gain_share: float
    least_gain_1_s: float
    harm_share: float
    onset_share: float
    mu_from: float
    mu_to: float


@dataclass(frozen=True, slots=True)
class Ranking:
    """All modifications, best first.

    Attributes
    ----------
    step : share by which groups were changed
    onset_bar : of the brake as it is; None where an onset was not looked for (k = 0, or none)
    """

    setting: Setting
    step: float
    onset_bar: float | None
    rows: tuple[Advice, ...]
    rule: RankingRule

    def change_bar(self, row: Advice) -> float | None:
        """Change of the onset by a modification; None where one of the two is missing."""
        if self.onset_bar is None or row.onset_bar is None:
            return None
        return row.onset_bar - self.onset_bar

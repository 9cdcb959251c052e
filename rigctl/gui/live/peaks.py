"""Squeal as it happens: narrow-band peaks of each frame, and their tracks through time.

Job: the rules of threshold, prominence, separation and duration of `rigctl.signals.squeal`, frame by
frame. A test holds the two together. What needs the whole braking (the sound before the brake was
applied, shaft orders while the speed changes) is left to the evaluation afterwards. Plain numpy, no Qt.
Not its job: drawing.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from rigctl.core.units import REFERENCE_PRESSURE_PA
from rigctl.gui.live.stft import Frames, level_db

_SCALLOPING = 0.70
"""Power on the line nearest to a tone is at least this share of the tone's (Hann window)."""
_XQI_EXPONENT = 0.1138
"""Under this exponent the main lobe of the Hann window is nearly a parabola."""
_MAX_PEAKS_PER_FRAME = 64
_MIN_PRESENCE = 0.5
_MIN_CLEAR_FRAMES = 3
_MAX_HARMONIC = 8


@dataclass(frozen=True, slots=True)
class LiveDetection:
    """Settings; names and defaults as `rigctl.signals.squeal.SquealDetection`."""

    threshold_db: float = 60.0
    band_hz: tuple[float, float] = (1000.0, 16000.0)
    fft_size: int = 4096
    overlap: float = 0.5
    prominence_db: float = 12.0
    hysteresis_db: float = 3.0
    background_half_width_hz: float = 500.0
    separation_hz: float = 100.0
    dynamic_range_db: float = 60.0
    tolerance_hz: float = 30.0
    tolerance_relative: float = 0.005
    min_duration_s: float = 0.2
    merge_gap_s: float = 0.15
    harmonic_tolerance: float = 0.01

    @property
    def hop(self) -> int:
        """Step from frame to frame, samples."""
        return max(1, round(self.fft_size * (1.0 - self.overlap)))


@dataclass(frozen=True, slots=True)
class Peak:
    """A narrow-band peak of one frame: frequency in Hz, mean square in Pa², ratio to the median around it."""

    frequency_hz: float
    power: float
    ratio: float


@dataclass(frozen=True, slots=True)
class LiveEvent:
    """A squeal event so far: of the rig time from `start_s` to `end_s`; `open` while it may go on."""

    number: int
    start_s: float
    end_s: float
    frequency_hz: float
    level_db: float
    open: bool
    harmonic: bool = False


def find_peaks(power: NDArray[np.float32], line_hz: float, settings: LiveDetection) -> list[list[Peak]]:
    """Peaks of each frame, strongest first.

    Parameters
    ----------
    power : ndarray, shape (n_frames, n_lines)
        Pa².
    line_hz : float
        Distance of the lines.
    settings : LiveDetection
    """
    n_frames, n_lines = power.shape
    found: list[list[Peak]] = [[] for _ in range(n_frames)]
    low = max(2, int(np.ceil(settings.band_hz[0] / line_hz)))
    high = min(n_lines - 3, int(np.floor(settings.band_hz[1] / line_hz)))
    if high < low or not n_frames:
        return found
    least = REFERENCE_PRESSURE_PA**2 * 10.0 ** ((settings.threshold_db - settings.hysteresis_db) / 10.0)
    prominence = 10.0 ** ((settings.prominence_db - settings.hysteresis_db) / 10.0)
    inner = power[:, low : high + 1]
    frame, line = np.nonzero(inner >= _SCALLOPING * least)
    line += low
    p = power[frame, line]
    keep = (p > power[frame, line - 1]) & (p >= power[frame, line + 1])
    frame, line, p = frame[keep], line[keep], p[keep]
    if not len(line):
        return found
    separation = max(2, round(settings.separation_hz / line_hz))
    near = np.clip(line[:, None] + np.arange(-separation, separation + 1), low, high)
    keep = power[frame[:, None], near].max(axis=1) <= p
    frame, line = frame[keep], line[keep]
    position, strength = _interpolate(power, frame, line)
    half = max(4, round(settings.background_half_width_hz / line_hz))
    around = line[:, None] + np.arange(-half, half + 1)
    values = power[frame[:, None], np.clip(around, 0, n_lines - 1)]
    median = _median_inside(values, (around >= 1) & (around <= n_lines - 2))
    keep = (strength >= least) & (strength >= prominence * median)
    for i in np.flatnonzero(keep):
        ratio = strength[i] / max(float(median[i]), 1e-30)
        found[frame[i]].append(Peak(float(position[i]) * line_hz, float(strength[i]), float(ratio)))
    weakest = 10.0 ** (-settings.dynamic_range_db / 10.0)
    for number, peaks in enumerate(found):
        peaks.sort(key=lambda peak: -peak.power)
        found[number] = [p for p in peaks[:_MAX_PEAKS_PER_FRAME] if p.power >= weakest * peaks[0].power]
    return found


def _interpolate(
    power: NDArray[np.float32], frame: NDArray[np.intp], line: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Line and power of the tone at each peak: a parabola through three lines, `spectra.interpolate_peak`."""
    a, b, c = (power[frame, line + d].astype(np.float64) ** _XQI_EXPONENT for d in (-1, 0, 1))
    curvature = a - 2.0 * b + c
    round_top = curvature < 0.0
    shift = np.zeros(len(line))
    np.divide(0.5 * (a - c), curvature, out=shift, where=round_top)
    shift = np.clip(shift, -0.5, 0.5)
    return line + shift, (b - 0.25 * (a - c) * shift) ** (1.0 / _XQI_EXPONENT)


def _median_inside(values: NDArray[np.float32], inside: NDArray[np.bool_]) -> NDArray[np.float32]:
    """Upper median of the values that lie inside, per row."""
    ordered = np.sort(np.where(inside, values, np.float32(np.inf)), axis=1)
    return ordered[np.arange(len(values)), np.count_nonzero(inside, axis=1) // 2]


@dataclass(slots=True)
class _Track:
    number: int
    first_s: float
    last_s: float
    last_hz: float
    clear: int = 0
    loud: bool = False
    weight: float = 0.0
    weighted_hz: float = 0.0
    largest: float = 0.0
    event: bool = False


@dataclass(slots=True)
class LiveTracks:
    """Joins peaks of consecutive frames to tracks, and tracks that fulfil the rules to events.

    Parameters
    ----------
    settings : LiveDetection
    hop_s, line_hz : float
        Step of the frames and distance of the lines.
    keep_s : float
        Events that ended longer ago are forgotten.
    """

    settings: LiveDetection
    hop_s: float
    line_hz: float
    keep_s: float = 60.0
    _alive: list[_Track] = field(default_factory=list)
    _closed: list[LiveEvent] = field(default_factory=list)
    _count: int = 0
    _now_s: float = float("-inf")

    def feed(self, frames: Frames) -> None:
        """Take the next frames; a gap in time ends what is going on."""
        for number, peaks in enumerate(find_peaks(frames.power, self.line_hz, self.settings)):
            self._frame(frames.t_s + number * self.hop_s, peaks)

    def _frame(self, t_s: float, peaks: list[Peak]) -> None:
        if t_s < self._now_s:  # time has begun anew
            self._alive.clear()
            self._closed.clear()
        self._now_s = t_s
        reach_s = (round(self.settings.merge_gap_s / self.hop_s) + 1.5) * self.hop_s
        for track in [track for track in self._alive if t_s - track.last_s > reach_s]:
            self._alive.remove(track)
            if track.event:
                self._closed.append(self._event(track, is_open=False))
        while self._closed and self._closed[0].end_s < t_s - self.keep_s:
            self._closed.pop(0)
        for peak in peaks:
            self._join(t_s, peak)

    def _join(self, t_s: float, peak: Peak) -> None:
        settings = self.settings
        nearest = None
        distance = max(settings.tolerance_hz, settings.tolerance_relative * peak.frequency_hz)
        for track in self._alive:
            if track.last_s < t_s and abs(track.last_hz - peak.frequency_hz) <= distance:
                nearest, distance = track, abs(track.last_hz - peak.frequency_hz)
        if nearest is None:
            self._count += 1
            nearest = _Track(self._count, t_s, t_s, peak.frequency_hz)
            self._alive.append(nearest)
        nearest.last_s, nearest.last_hz = t_s, peak.frequency_hz
        nearest.clear += peak.ratio >= 10.0 ** (settings.prominence_db / 10.0)
        threshold = REFERENCE_PRESSURE_PA**2 * 10.0 ** (settings.threshold_db / 10.0)
        nearest.loud |= peak.power >= threshold
        nearest.weight += peak.power
        nearest.weighted_hz += peak.power * peak.frequency_hz
        nearest.largest = max(nearest.largest, peak.power)
        nearest.event = self._is_event(nearest)

    def _is_event(self, track: _Track) -> bool:
        span = round((track.last_s - track.first_s) / self.hop_s) + 1
        if span * self.hop_s < self.settings.min_duration_s or not track.loud:
            return False
        return track.clear >= max(min(_MIN_CLEAR_FRAMES, span), _MIN_PRESENCE * span)

    def _event(self, track: _Track, *, is_open: bool) -> LiveEvent:
        level = float(level_db(np.array(track.largest)))
        half_s = self.hop_s / 2
        frequency_hz = track.weighted_hz / track.weight
        return LiveEvent(
            track.number, track.first_s - half_s, track.last_s + half_s, frequency_hz, level, is_open
        )

    def events(self) -> list[LiveEvent]:
        """Events of the last `keep_s` in the order of their start; harmonics of louder ones are flagged."""
        going_on = [self._event(track, is_open=True) for track in self._alive if track.event]
        events = sorted([*self._closed, *going_on], key=lambda event: (event.start_s, event.frequency_hz))
        return [
            replace(event, harmonic=any(self._is_harmonic(event, other) for other in events))
            for event in events
        ]

    def _is_harmonic(self, event: LiveEvent, base: LiveEvent) -> bool:
        overlap_s = min(event.end_s, base.end_s) - max(event.start_s, base.start_s)
        if base.level_db <= event.level_db or overlap_s < 0.5 * (event.end_s - event.start_s):
            return False
        m = round(event.frequency_hz / base.frequency_hz)
        allowed_hz = max(self.settings.harmonic_tolerance * m * base.frequency_hz, self.line_hz)
        return 2 <= m <= _MAX_HARMONIC and abs(event.frequency_hz - m * base.frequency_hz) <= allowed_hz

    def copy(self) -> LiveTracks:
        """Independent copy, for a frozen display."""
        twin = replace(self, _alive=[replace(track) for track in self._alive], _closed=list(self._closed))
        return twin

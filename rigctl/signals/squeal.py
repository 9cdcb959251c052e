"""Narrow-band squeal events in the spectrogram of one braking.

Job: settings (`SquealDetection`), results (`SquealEvent`) and the detector: peaks above threshold and above
the running median of their neighbourhood and above the sound that was there before the brake was applied;
tracked through time with hysteresis; shaft orders rejected; harmonics flagged.
NOT its job: the values of p, T, n, mu at an event (`evaluation`), statistics over brakings (rigctl.analysis).

Rules, in the order in which they act (each is a key of `SquealDetection`):

1. A peak is a line with no stronger one within `separation_hz`, at least `threshold_db - hysteresis_db`, at
   least `prominence_db - hysteresis_db` above the running median over +-`background_half_width_hz`, and at
   least `onset_excess_db` above the mean spectrum before pressure onset.
2. Peaks within `tolerance_hz` or `tolerance_relative` join to tracks; gaps up to `merge_gap_s` are bridged.
3. A track is an event when it once reached `threshold_db`, lasts `min_duration_s`, and is prominent by the
   full `prominence_db` in at least three and at least half of its frames.
4. A track whose frequency follows the shaft speed is a shaft order, no event.
5. Events at whole multiples of a louder, simultaneous event are its harmonics: `harmonic_of` is set, and they
   are not counted as squeal.
"""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from rigctl.signals._model import FrozenModel
from rigctl.signals._tracking import find_peaks, track_peaks
from rigctl.signals.calibration import level_db, mean_square_pa2
from rigctl.signals.spectra import Spectrogram
from rigctl.signals.weighting import weighting_db

_MAX_PEAKS_PER_FRAME = 64
_MAX_HARMONIC = 8
_MIN_BACKGROUND_FRAMES = 3
_MIN_PRESENCE = 0.5
_MIN_CLEAR_FRAMES = 3
_SMEAR_LINES = 3
_MIN_ORDER_SPEED_CHANGE = 0.02
_ORDER_SPREAD_RATIO = 0.5


class SquealDetection(FrozenModel):
    """Settings of the squeal detector; the defaults follow the paper (60 dB, >= 1 kHz) and domain.md 2.2."""

    threshold_db: float = Field(default=60.0, ge=0, le=140)
    band_hz: tuple[float, float] = (1000.0, 16000.0)
    fft_size: int = Field(default=4096, ge=256, le=65536)
    overlap: float = Field(default=0.5, ge=0, le=0.9)
    prominence_db: float = Field(default=12.0, ge=3, le=60)
    hysteresis_db: float = Field(default=3.0, ge=0, le=20)
    background_half_width_hz: float = Field(default=500.0, gt=0, le=5000)
    separation_hz: float = Field(default=100.0, gt=0, le=2000)
    dynamic_range_db: float = Field(default=60.0, ge=20, le=120)
    onset_excess_db: float = Field(default=6.0, ge=0, le=40)
    tolerance_hz: float = Field(default=30.0, gt=0, le=500)
    tolerance_relative: float = Field(default=0.005, ge=0, le=0.1)
    min_duration_s: float = Field(default=0.2, gt=0, le=10)
    merge_gap_s: float = Field(default=0.15, ge=0, le=5)
    harmonic_tolerance: float = Field(default=0.01, ge=0, le=0.05)

    @model_validator(mode="after")
    def _check(self) -> Self:
        low, high = self.band_hz
        if not 0 < low < high:
            raise PydanticCustomError(
                "band_order",
                "band_hz {band} is not 0 < lower < upper",
                {
                    "band": list(self.band_hz),
                    "remedy": "Give the lower edge first, for example [1000.0, 16000.0].",
                },
            )
        if self.fft_size & (self.fft_size - 1):
            raise PydanticCustomError(
                "fft_size",
                "fft_size {value} is not a power of two",
                {"value": self.fft_size, "remedy": "Use 2048, 4096 or 8192."},
            )
        return self

    @property
    def hop(self) -> int:
        """Step from frame to frame, samples."""
        return max(1, round(self.fft_size * (1.0 - self.overlap)))


@dataclass(frozen=True, slots=True)
class SquealEvent:
    """One narrow-band noise event.

    Times are on the time axis of the recording (centre of frame -+ half a step; a start is known to about
    half a frame, 0.05 s). `level_db` is the largest level of the line, `leq_db` its energy mean over the
    event, `frequency_hz` its energy-weighted mean, `share` its duration over that of the braking,
    `harmonic_of` the position of the fundamental in the list of events. p, T, n, mu are those at `peak_s`,
    the time of the largest level; None where the channel is missing or mu is not defined.
    """

    frequency_hz: float
    level_db: float
    level_dba: float
    leq_db: float
    start_s: float
    duration_s: float
    peak_s: float
    prominence_db: float
    share: float
    harmonic_of: int | None = None
    pressure_bar: float | None = None
    temperature_degc: float | None = None
    speed_rpm: float | None = None
    mu: float | None = None


@dataclass(frozen=True, slots=True)
class SpeedCourse:
    """Shaft speed over time, for the rejection of shaft orders: `time_s` and `speed_rpm`, shape (n,)."""

    time_s: NDArray[np.float64]
    speed_rpm: NDArray[np.floating]


@dataclass(frozen=True, slots=True)
class _Track:
    frames: NDArray[np.int64]
    lines: NDArray[np.float64]
    power: NDArray[np.float64]
    ratio: NDArray[np.float64]


def background_spectrum(spec: Spectrogram, onset_s: float) -> NDArray[np.float64] | None:
    """Mean power per line of the frames that end before `onset_s`; None with fewer than three such frames."""
    before = int(np.count_nonzero(spec.time_s() + spec.frame_s / 2 <= onset_s))
    if before < _MIN_BACKGROUND_FRAMES:
        return None
    return spec.power[:before].mean(axis=0, dtype=np.float64)


def detect_squeal(
    spec: Spectrogram,
    settings: SquealDetection,
    *,
    window_s: tuple[float, float] | None = None,
    speed: SpeedCourse | None = None,
) -> list[SquealEvent]:
    """Find squeal events.

    Parameters
    ----------
    spec : Spectrogram
        Power in Pa^2, made with `settings.fft_size` and `settings.hop`.
    settings : SquealDetection
    window_s : (float, float), optional
        Begin and end of the brake application on the time axis of `spec`. Frames that end before its begin
        give the background and no events. None: all frames are searched, no background is known.
    speed : SpeedCourse, optional
        Needed for the rejection of shaft orders.

    Returns
    -------
    list of SquealEvent
        In order of start; harmonics included and flagged.
    """
    if spec.power.shape[0] == 0:
        return []
    background = None if window_s is None else background_spectrum(spec, window_s[0])
    tracks = _tracks(
        spec, settings, 0.0 if window_s is None else window_s[0], window_s is not None, background
    )
    total_s = spec.power.shape[0] * spec.hop_s if window_s is None else window_s[1] - window_s[0]
    kept = [t for t in tracks if _is_event(t, spec, settings) and not _is_shaft_order(t, spec, speed)]
    events = sorted((_event(t, spec, total_s) for t in kept), key=lambda e: (e.start_s, e.frequency_hz))
    return _flag_harmonics(events, settings, spec.line_hz)


def _tracks(
    spec: Spectrogram,
    settings: SquealDetection,
    begin_s: float,
    has_window: bool,
    background: NDArray[np.float64] | None,
) -> list[_Track]:
    n_frames, n_lines = spec.power.shape
    low = max(2, int(np.ceil(settings.band_hz[0] / spec.line_hz)))
    high = min(n_lines - 3, int(np.floor(settings.band_hz[1] / spec.line_hz)))
    if high < low:
        return []
    first = int(np.count_nonzero(spec.time_s() + spec.frame_s / 2 <= begin_s)) if has_window else 0
    minimum = np.full(n_lines, float(mean_square_pa2(settings.threshold_db - settings.hysteresis_db)))
    if background is not None:
        raised = _smear(background) * 10.0 ** (settings.onset_excess_db / 10.0)
        minimum = np.maximum(minimum, raised)
    capacity = n_frames * _MAX_PEAKS_PER_FRAME
    frame_of, line = np.empty(capacity, np.int64), np.empty(capacity)
    strength, ratio = np.empty(capacity), np.empty(capacity)
    n = find_peaks(
        spec.power,
        first,
        low,
        high,
        minimum,
        10.0 ** ((settings.prominence_db - settings.hysteresis_db) / 10.0),
        max(4, round(settings.background_half_width_hz / spec.line_hz)),
        max(2, round(settings.separation_hz / spec.line_hz)),
        10.0 ** (settings.dynamic_range_db / 10.0),
        frame_of,
        line,
        strength,
        ratio,
    )
    if n == 0:
        return []
    frame_of, line, strength, ratio = frame_of[:n], line[:n], strength[:n], ratio[:n]
    track_of = np.empty(n, np.int64)
    max_gap = round(settings.merge_gap_s / spec.hop_s)
    n_tracks = track_peaks(
        frame_of, line, settings.tolerance_hz / spec.line_hz, settings.tolerance_relative, max_gap, track_of
    )
    order = np.argsort(track_of, kind="stable")
    bounds = np.searchsorted(track_of[order], np.arange(n_tracks + 1))
    long_enough = np.flatnonzero(np.diff(bounds) >= 2)
    groups = (order[bounds[i] : bounds[i + 1]] for i in long_enough)
    return [_Track(frame_of[g], line[g], strength[g], ratio[g]) for g in groups]


def _smear(background: NDArray[np.float64]) -> NDArray[np.float64]:
    """Largest value within +-3 lines: a background tone may wander a little."""
    padded = np.pad(background, _SMEAR_LINES, mode="edge")
    return np.lib.stride_tricks.sliding_window_view(padded, 2 * _SMEAR_LINES + 1).max(axis=1)


def _is_event(track: _Track, spec: Spectrogram, settings: SquealDetection) -> bool:
    span = int(track.frames[-1] - track.frames[0]) + 1
    if span * spec.hop_s < settings.min_duration_s:
        return False
    # Single frames of loud noise are prominent by chance; three in a row at one frequency are not.
    clear = np.count_nonzero(track.ratio >= 10.0 ** (settings.prominence_db / 10.0))
    if clear < max(min(_MIN_CLEAR_FRAMES, span), _MIN_PRESENCE * span):
        return False
    return bool((track.power >= mean_square_pa2(settings.threshold_db)).any())


def _is_shaft_order(track: _Track, spec: Spectrogram, speed: SpeedCourse | None) -> bool:
    """True when f / n is clearly more constant than f while n varies: a line tied to the shaft."""
    if speed is None or speed.time_s.size == 0 or track.frames.size < 3:
        return False
    n_rpm = np.interp(spec.time_s()[track.frames], speed.time_s, np.abs(speed.speed_rpm))
    mean_rpm = float(n_rpm.mean())
    if float(n_rpm.min()) <= 0 or float(n_rpm.std()) < _MIN_ORDER_SPEED_CHANGE * mean_rpm:
        return False
    order = track.lines / n_rpm
    spread_order = float(order.std() / order.mean())
    spread_line = float(track.lines.std() / track.lines.mean())
    return spread_order < _ORDER_SPREAD_RATIO * spread_line


def _event(track: _Track, spec: Spectrogram, total_s: float) -> SquealEvent:
    peak = int(np.argmax(track.power))
    frequency_hz = float(np.average(track.lines, weights=track.power)) * spec.line_hz
    level = float(level_db(track.power[peak]))
    frame_s = spec.time_s()
    start_s = float(frame_s[track.frames[0]]) - spec.hop_s / 2
    duration_s = (int(track.frames[-1] - track.frames[0]) + 1) * spec.hop_s
    return SquealEvent(
        frequency_hz=frequency_hz,
        level_db=level,
        level_dba=level + float(weighting_db(track.lines[peak] * spec.line_hz, "A")),
        leq_db=float(level_db(track.power.mean())),
        start_s=start_s,
        duration_s=duration_s,
        peak_s=float(frame_s[track.frames[peak]]),
        prominence_db=float(10.0 * np.log10(track.ratio.max())),
        share=min(1.0, duration_s / total_s) if total_s > 0 else 1.0,
    )


def _flag_harmonics(
    events: list[SquealEvent], settings: SquealDetection, line_hz: float
) -> list[SquealEvent]:
    flagged = list(events)
    for i, child in enumerate(events):
        parents = [
            j
            for j, parent in enumerate(events)
            if parent.level_db > child.level_db
            and _overlap_s(parent, child) >= 0.5 * child.duration_s
            and _is_multiple(child.frequency_hz, parent.frequency_hz, settings.harmonic_tolerance, line_hz)
        ]
        if parents:
            flagged[i] = replace(child, harmonic_of=min(parents, key=lambda j: events[j].frequency_hz))
    return flagged


def _overlap_s(a: SquealEvent, b: SquealEvent) -> float:
    return min(a.start_s + a.duration_s, b.start_s + b.duration_s) - max(a.start_s, b.start_s)


def _is_multiple(frequency_hz: float, base_hz: float, tolerance: float, line_hz: float) -> bool:
    m = round(frequency_hz / base_hz)
    allowed_hz = max(tolerance * m * base_hz, line_hz)
    return 2 <= m <= _MAX_HARMONIC and abs(frequency_hz - m * base_hz) <= allowed_hz

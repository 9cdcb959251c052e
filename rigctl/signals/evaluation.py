"""Everything that is computed of one braking when it is finished: squeal events, friction, levels, channel
means.

Job: `evaluate`, a pure function of the recorded channels; its result can be dumped to JSON and to HDF5.
NOT its job: reading or writing files (rigctl.recording), statistics over brakings (rigctl.analysis).

Conventions: the braking is the brake application found in the pressure (see `friction`); without pressure
channel or application, the whole recording. Mean and standard deviation of a channel are those of the settled
part, initial and final those at begin and end of the application, minimum and maximum those of the whole
recording. A quantity that is not defined is None, never NaN.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigctl.core.channels import (
    DISC_TEMPERATURE,
    MICROPHONE,
    PRESSURE,
    SPEED,
    TORQUE,
    ChannelData,
    ChannelSpec,
)
from rigctl.signals._model import FrozenModel
from rigctl.signals.calibration import clipped_share, level_db
from rigctl.signals.decimation import decimate
from rigctl.signals.friction import Application, FrictionGeometry, find_application, friction_coefficient
from rigctl.signals.levels import leq_and_lmax_db
from rigctl.signals.spectra import Spectrogram, band_mean_square, spectrogram
from rigctl.signals.squeal import (
    SpeedCourse,
    SquealDetection,
    SquealEvent,
    background_spectrum,
    detect_squeal,
)
from rigctl.signals.weighting import weighting_gain

_AVERAGE_S = 0.05
"""Half width of the stretch over which a value "at" a time is averaged."""


class ChannelStatistics(FrozenModel):
    """Mean, spread and ends of one channel, in its physical unit."""

    mean: float | None
    std: float | None
    initial: float | None
    final: float | None
    minimum: float | None
    maximum: float | None


class Evaluation(FrozenModel):
    """Result of one braking; None where a quantity is not defined or its channel was not recorded."""

    events: tuple[SquealEvent, ...]
    channels: dict[str, ChannelStatistics]
    application_s: tuple[float, float] | None
    settled_s: tuple[float, float] | None
    mean_mu: float | None
    std_mu: float | None
    leq_db: float | None
    laeq_db: float | None
    lmax_db: float | None
    background_db: float | None
    clipped_share: float | None
    background_frames: int

    @property
    def n_squeal(self) -> int:
        """Number of squeal events, harmonics not counted."""
        return sum(1 for event in self.events if event.harmonic_of is None)

    @property
    def main_event(self) -> SquealEvent | None:
        """The loudest squeal event, harmonics not counted."""
        return max((e for e in self.events if e.harmonic_of is None), key=lambda e: e.level_db, default=None)


def evaluate(
    channels: Mapping[str, ChannelData],
    *,
    friction: FrictionGeometry,
    detection: SquealDetection,
) -> Evaluation:
    """Evaluate one braking.

    Parameters
    ----------
    channels : mapping of name to ChannelData
        Any subset of microphone, torque, pressure, speed, disc_temperature and others, on one time axis.
    friction : FrictionGeometry
    detection : SquealDetection

    Returns
    -------
    Evaluation
        Missing or empty channels give None for what depends on them; nothing is raised for them.
    """
    present = {name: data for name, data in channels.items() if len(data.samples) > 0}
    pressure = present.get(PRESSURE)
    application = None if pressure is None else find_application(pressure.physical(), friction)
    window_s = _window_s(pressure, application, settled=False)
    settled_s = _window_s(pressure, application, settled=True)
    mu_time_s, mu = _mu_course(present, friction)
    settled_mu = mu[_inside(mu_time_s, settled_s)] if settled_s is not None else mu[:0]
    settled_mu = settled_mu[np.isfinite(settled_mu)]
    statistics = {
        name: _statistics(data, window_s, settled_s) for name, data in present.items() if name != MICROPHONE
    }
    sound = _sound(present.get(MICROPHONE), present.get(SPEED), detection, window_s)
    events = tuple(_with_conditions(event, present, mu_time_s, mu) for event in sound.pop("events"))
    return Evaluation(
        events=events,
        channels=statistics,
        application_s=window_s,
        settled_s=settled_s,
        mean_mu=float(settled_mu.mean()) if settled_mu.size else None,
        std_mu=float(settled_mu.std()) if settled_mu.size else None,
        **sound,
    )


def warm_up() -> None:
    """Compile (or load from the cache) all kernels of `evaluate` and `decimate`, by evaluating one second.

    The first compilation takes about 4 s: call this where waiting does no harm, before the rig runs.
    """
    rate_hz = 40000.0
    tone = np.sin(2.0 * np.pi * 2350.0 * np.arange(int(rate_hz)) / rate_hz)
    counts = np.round(20000.0 * tone).astype(np.int16)
    spec = ChannelSpec(MICROPHONE, "Pa", rate_hz, "int16", scale=1e-3)
    for writeable in (True, False):  # samples out of a file or a pipe are read-only: kernels of their own
        counts.flags.writeable = writeable
        channels = {MICROPHONE: ChannelData(spec, 0.0, counts)}
        evaluate(channels, friction=FrictionGeometry(), detection=SquealDetection())
    decimate(tone, 4)


def _window_s(
    pressure: ChannelData | None, application: Application | None, *, settled: bool
) -> tuple[float, float] | None:
    if pressure is None or application is None:
        return None
    start, stop = application.start, application.stop
    if settled:
        start, stop = application.settled_start, application.settled_stop
    return pressure.t0_s + start / pressure.spec.rate_hz, pressure.t0_s + stop / pressure.spec.rate_hz


def _inside(time_s: NDArray[np.float64], window_s: tuple[float, float]) -> NDArray[np.bool_]:
    return (time_s >= window_s[0] - 1e-9) & (time_s < window_s[1] - 1e-9)


def _mu_course(
    channels: Mapping[str, ChannelData], friction: FrictionGeometry
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """mu on the time grid of the pressure channel; torque and speed are interpolated onto it where they
    differ.
    """
    if not all(name in channels for name in (TORQUE, PRESSURE, SPEED)):
        return np.empty(0), np.empty(0)
    pressure = channels[PRESSURE]
    time_s = pressure.time_s()
    torque_nm, speed_rpm = (_on_grid(channels[name], time_s) for name in (TORQUE, SPEED))
    return time_s, friction_coefficient(torque_nm, pressure.physical(), speed_rpm, friction)


def _on_grid(data: ChannelData, time_s: NDArray[np.float64]) -> NDArray[np.floating]:
    own_s = data.time_s()
    if own_s.shape == time_s.shape and np.array_equal(own_s, time_s):
        return data.physical()
    return np.interp(time_s, own_s, data.physical())


def _statistics(
    data: ChannelData, window_s: tuple[float, float] | None, settled_s: tuple[float, float] | None
) -> ChannelStatistics:
    time_s, values = data.time_s(), data.physical()
    finite = np.isfinite(values)
    time_s, values = time_s[finite], values[finite].astype(np.float64)
    if values.size == 0:
        return ChannelStatistics(mean=None, std=None, initial=None, final=None, minimum=None, maximum=None)
    settled = values if settled_s is None else values[_inside(time_s, settled_s)]
    begin_s, end_s = (float(time_s[0]), float(time_s[-1])) if window_s is None else window_s
    return ChannelStatistics(
        mean=float(settled.mean()) if settled.size else None,
        std=float(settled.std()) if settled.size else None,
        initial=_value_at(time_s, values, begin_s),
        final=_value_at(time_s, values, end_s),
        minimum=float(values.min()),
        maximum=float(values.max()),
    )


def _value_at(time_s: NDArray[np.float64], values: NDArray[np.floating], at_s: float) -> float | None:
    """Mean of the finite values within +-0.05 s of a time; the nearest value where there is none that
    close.
    """
    first, last = np.searchsorted(time_s, (at_s - _AVERAGE_S, at_s + _AVERAGE_S))
    near = values[first:last] if last > first else values[np.argmin(np.abs(time_s - at_s))][None]
    near = near[np.isfinite(near)]
    return float(near.mean()) if near.size else None


def _sound(
    microphone: ChannelData | None,
    speed: ChannelData | None,
    detection: SquealDetection,
    window_s: tuple[float, float] | None,
) -> dict[str, Any]:
    if microphone is None:
        levels = dict.fromkeys(("leq_db", "laeq_db", "lmax_db", "background_db", "clipped_share"))
        return {"events": [], "background_frames": 0, **levels}
    rate_hz, scale = microphone.spec.rate_hz, microphone.spec.scale
    samples = microphone.samples
    spec = spectrogram(
        samples, rate_hz, fft_size=detection.fft_size, hop=detection.hop, scale=scale, t0_s=microphone.t0_s
    )
    course = None if speed is None else SpeedCourse(speed.time_s(), speed.physical())
    start, stop = _sample_range(microphone, window_s)
    leq_db, lmax_db = leq_and_lmax_db(samples, rate_hz, scale=scale, start=start, stop=stop)
    background = None if window_s is None else background_spectrum(spec, window_s[0])
    before = 0 if window_s is None else int(np.count_nonzero(spec.time_s() + spec.frame_s / 2 <= window_s[0]))
    return {
        "events": detect_squeal(spec, detection, window_s=window_s, speed=course),
        "leq_db": leq_db,
        "laeq_db": _laeq_db(spec, window_s),
        "lmax_db": lmax_db,
        "background_db": None if background is None else _spectrum_level_db(background, spec),
        "clipped_share": clipped_share(samples) if microphone.spec.is_counts else None,
        "background_frames": before if background is not None else 0,
    }


def _sample_range(data: ChannelData, window_s: tuple[float, float] | None) -> tuple[int, int]:
    n = len(data.samples)
    if window_s is None:
        return 0, n
    start, stop = (round((t - data.t0_s) * data.spec.rate_hz) for t in window_s)
    start, stop = max(0, start), min(n, stop)
    return (start, stop) if start < stop else (0, n)


def _laeq_db(spec: Spectrogram, window_s: tuple[float, float] | None) -> float | None:
    """A-weighted Leq of the frames whose centre lies in the window (Welch estimate, exact spectral
    weighting).
    """
    inside = slice(None) if window_s is None else _inside(spec.time_s(), window_s)
    part = replace(spec, power=spec.power[inside])
    if part.power.shape[0] == 0:
        return None
    gain = weighting_gain(spec.frequency_hz(), "A")
    return float(level_db(band_mean_square(part, 0.0, spec.rate_hz / 2, gain)))


def _spectrum_level_db(mean_power: NDArray[np.float64], spec: Spectrogram) -> float:
    part = replace(spec, power=mean_power[None, :].astype(np.float32))
    return float(level_db(band_mean_square(part, 2 * spec.line_hz, spec.rate_hz / 2)))


def _with_conditions(
    event: SquealEvent,
    channels: Mapping[str, ChannelData],
    mu_time_s: NDArray[np.float64],
    mu: NDArray[np.float64],
) -> SquealEvent:
    def at_peak(name: str) -> float | None:
        data = channels.get(name)
        return None if data is None else _value_at(data.time_s(), data.physical(), event.peak_s)

    return replace(
        event,
        pressure_bar=at_peak(PRESSURE),
        temperature_degc=at_peak(DISC_TEMPERATURE),
        speed_rpm=at_peak(SPEED),
        mu=_value_at(mu_time_s, mu, event.peak_s) if mu.size else None,
    )

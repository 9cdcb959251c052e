"""Spectrogram of one braking with pressure, speed and friction torque below it.

Job: read the samples of one braking file and draw them. NOT its job: choosing the braking (`report`).
"""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from rigctl.analysis.campaign_table import BrakingRow, EventRow
from rigctl.analysis.style import BLUE, VERMILION, axes_title, colour_bar, label_axes, new_figure
from rigctl.core.channels import MICROPHONE, PRESSURE, TORQUE, ChannelData
from rigctl.core.units import REFERENCE_PRESSURE_PA
from rigctl.recording.braking_file import read_braking

_FFT_SIZE, _HOP = 2048, 1024
_FLOOR_PA2 = 1e-30
_DYNAMIC_RANGE_DB = 90.0
_MAX_COLUMNS = 320
_MAX_ROWS = 260


def braking_spectrogram(path: Path, braking: BrakingRow, events: tuple[EventRow, ...]) -> Figure | None:
    """Spectrogram of the sound of a braking, its events marked, pressure and torque below.

    Parameters
    ----------
    path : Path
        Braking file.
    braking : BrakingRow
        Its row, for the title.
    events : tuple of EventRow
        Its events; a frame is drawn around each that is no harmonic.

    Returns
    -------
    Figure or None
        None when the file holds no microphone signal or less than one frame of it.

    Raises
    ------
    RecordingError
        The file cannot be read.
    """
    channels = read_braking(path).channels
    if MICROPHONE not in channels:
        return None
    sound = channels[MICROPHONE]
    power = power_pa2(sound)
    if power.shape[0] == 0:
        return None
    rate_hz = sound.spec.rate_hz
    line_hz, hop_s = rate_hz / _FFT_SIZE, _HOP / rate_hz
    top_hz = min(rate_hz / 2, max(8000.0, 1.6 * max((e.frequency_hz for e in events), default=0.0)))
    figure = new_figure(8.0, 5.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3.0, 1.0))
    figure.subplots_adjust(left=0.085, right=0.89, top=0.93, bottom=0.095, hspace=0.1)
    picture = _picture(power[:, : int(top_hz / line_hz) + 1])
    begin_s = (_FFT_SIZE - _HOP) / 2 / rate_hz  # a column is a hop wide, around the centre of its frame
    end_s = begin_s + power.shape[0] * hop_s
    peak_db = float(picture.max())
    floor_db = max(peak_db - _DYNAMIC_RANGE_DB, float(np.percentile(picture, 20)))
    image = upper.imshow(
        picture.T,
        origin="lower",
        aspect="auto",
        extent=(begin_s, end_s, 0.0, top_hz / 1000),
        cmap="magma",
        vmin=min(floor_db, peak_db - 20.0),
        vmax=peak_db,
        interpolation="nearest",
    )
    for event in events:
        if not event.harmonic and event.start_s is not None and event.duration_s is not None:
            f_khz, stop_s = event.frequency_hz / 1000, event.start_s + event.duration_s
            for sign in (-1, 1):
                upper.plot(
                    [event.start_s, stop_s], [f_khz + sign * 0.15] * 2, color="white", lw=0.9, ls=(0, (4, 2))
                )
            label = f"{event.frequency_hz:.0f} Hz, {event.level_db:.0f} dB"
            upper.annotate(
                label, (event.start_s, f_khz + 0.2), color="white", fontsize=8.5, ha="left", va="bottom"
            )
    label_axes(upper, y="frequency [kHz]")
    axes_title(upper, f"Loudest braking: no. {braking.index}{_conditions(braking)}")
    colour_bar(upper, image, "level per line [dB re 20 µPa]")
    _draw_course(lower, channels)
    label_axes(lower, x="time since the first sample [s]")
    lower.set_xlim(0, end_s)
    upper.spines[:].set_visible(False)
    return figure


def _draw_course(axes: Axes, channels: Mapping[str, ChannelData]) -> None:
    """Pressure (left scale) and torque (right scale), scaled apart so that their curves do not cover."""
    twin = axes.twinx()
    curves = ((axes, PRESSURE, BLUE, "bar", 1.5, 27.0), (twin, TORQUE, VERMILION, "N·m", 1.1, -34.0))
    for scale, name, colour, unit, room, gap_pt in curves:
        if name in channels:
            data = channels[name]
            step = max(1, len(data.samples) // 1500)
            values = data.physical()[::step]
            scale.plot(data.time_s()[::step], values, color=colour, lw=1.3)
            label_axes(scale, y=f"{name} [{unit}]", y_gap_pt=gap_pt)
            scale.yaxis.label.set_color(colour)
            scale.set_ylim(0.0, room * max(1.0, float(values.max(initial=0.0))))
    twin.spines["right"].set_visible(True)


def power_pa2(sound: ChannelData) -> NDArray[np.float32]:
    """Short-time power spectrum of one braking, amplitude-corrected, Pa^2; shape (n_frames, 1025).

    The same numbers as `rigctl.signals.spectra.spectrogram` (a test holds them together), by numpy alone:
    loading compiled code takes ten times as long as this one transform.
    """
    window = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(_FFT_SIZE) / _FFT_SIZE)
    if len(sound.samples) < _FFT_SIZE:
        return np.empty((0, _FFT_SIZE // 2 + 1), np.float32)
    frames = np.lib.stride_tricks.sliding_window_view(sound.samples, _FFT_SIZE)[::_HOP]
    amplitude = np.abs(np.fft.rfft(frames * window, axis=1)) * (2.0 * sound.spec.scale / window.sum())
    power = 0.5 * amplitude**2
    power[:, [0, -1]] *= 0.5
    return power.astype(np.float32)


def _picture(power: NDArray[np.float32]) -> NDArray[np.float64]:
    """Levels in dB, reduced by block maxima to at most 320 x 260 pixels: narrow lines stay visible."""
    columns = -(-power.shape[0] // _MAX_COLUMNS)
    rows = -(-power.shape[1] // _MAX_ROWS)
    n, m = power.shape[0] // columns, power.shape[1] // rows
    blocks = power[: n * columns, : m * rows].reshape(n, columns, m, rows).max(axis=(1, 3))
    return 10.0 * np.log10(np.maximum(blocks.astype(np.float64), _FLOOR_PA2) / REFERENCE_PRESSURE_PA**2)


def _conditions(braking: BrakingRow) -> str:
    parts = []
    if braking.set_pressure_bar is not None:
        parts.append(f"{braking.set_pressure_bar:g} bar")
    if braking.temperature_initial_degc is not None:
        parts.append(f"{braking.temperature_initial_degc:.0f} °C")
    if braking.speed_mean_rpm is not None:
        parts.append(f"{braking.speed_mean_rpm:.0f} 1/min")
    return f" ({', '.join(parts)})" if parts else ""

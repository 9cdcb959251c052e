"""Spectrogram of one braking with pressure, speed and friction torque below it.

Job: read the samples of one braking file and draw them. NOT its job: choosing the braking (`report`).
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from rigctl.analysis.campaign_table import BrakingRow, EventRow
from rigctl.analysis.style import BLUE, VERMILION, new_figure
from rigctl.core.channels import MICROPHONE, PRESSURE, TORQUE
from rigctl.recording.braking_file import read_braking
from rigctl.signals.calibration import level_db
from rigctl.signals.spectra import spectrogram

_FFT_SIZE = 2048
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
    spec = spectrogram(
        sound.samples, sound.spec.rate_hz, fft_size=_FFT_SIZE, hop=_FFT_SIZE // 2, scale=sound.spec.scale
    )
    if spec.power.shape[0] == 0:
        return None
    top_hz = min(
        sound.spec.rate_hz / 2, max(8000.0, 1.6 * max((e.frequency_hz for e in events), default=0.0))
    )
    figure = new_figure(8.0, 5.0)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(3.0, 1.0))
    figure.subplots_adjust(left=0.085, right=0.895, top=0.93, bottom=0.095, hspace=0.1)
    picture = _picture(spec.power[:, : int(top_hz / spec.line_hz) + 1])
    end_s = float(spec.time_s()[-1]) + spec.hop_s / 2
    peak_db = float(picture.max())
    floor_db = max(peak_db - _DYNAMIC_RANGE_DB, float(np.percentile(picture, 20)))
    image = upper.imshow(
        picture.T,
        origin="lower",
        aspect="auto",
        extent=(float(spec.time_s()[0]) - spec.hop_s / 2, end_s, 0.0, top_hz / 1000),
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
    upper.set_ylabel("frequency [kHz]")
    where = _conditions(braking)
    upper.set_title(f"Loudest braking: no. {braking.index}{where}")
    bar = figure.colorbar(image, cax=figure.add_axes((0.915, 0.36, 0.018, 0.57)))
    bar.set_label("level per line [dB re 20 µPa]")
    bar.outline.set_visible(False)  # type: ignore[operator]
    twin = lower.twinx()
    for axes, name, colour, unit in ((lower, PRESSURE, BLUE, "bar"), (twin, TORQUE, VERMILION, "N·m")):
        if name in channels:
            data = channels[name]
            step = max(1, len(data.samples) // 1500)
            axes.plot(data.time_s()[::step], data.physical()[::step], color=colour, lw=1.3)
            axes.set_ylabel(f"{name} [{unit}]", color=colour)
            axes.set_ylim(bottom=0)
    twin.spines["right"].set_visible(True)
    lower.set_xlabel("time since the first sample [s]")
    lower.set_xlim(0, end_s)
    upper.spines[:].set_visible(False)
    return figure


def _picture(power: np.ndarray) -> np.ndarray:
    """Levels in dB, reduced by block maxima to at most 320 x 260 pixels: narrow lines stay visible."""
    columns = -(-power.shape[0] // _MAX_COLUMNS)
    rows = -(-power.shape[1] // _MAX_ROWS)
    n, m = power.shape[0] // columns, power.shape[1] // rows
    blocks = power[: n * columns, : m * rows].reshape(n, columns, m, rows)
    return level_db(blocks.max(axis=(1, 3)))


def _conditions(braking: BrakingRow) -> str:
    parts = []
    if braking.set_pressure_bar is not None:
        parts.append(f"{braking.set_pressure_bar:g} bar")
    if braking.temperature_initial_degc is not None:
        parts.append(f"{braking.temperature_initial_degc:.0f} °C")
    if braking.speed_mean_rpm is not None:
        parts.append(f"{braking.speed_mean_rpm:.0f} 1/min")
    return f" ({', '.join(parts)})" if parts else ""

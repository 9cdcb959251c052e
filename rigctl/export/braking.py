"""One braking as WAV, CSV, MATLAB file or as a copy of its HDF5 file.

Job: write the files, each beside the others of a folder, never replacing one. NOT its job: choosing brakings,
progress (`rigctl.gui.pages.data`).

- WAV: the counts of the converter as recorded, 16 bit; the factor Pa per count stands in the comment (ICMT).
- CSV: one file per sampling rate with time in s and one column per channel, unit in its name; one with the
  events; UTF-8, comma, decimal point.
- MAT: version 5, for MATLAB and Octave (`load`): `channels.<name>.value/rate_hz/unit`, `set_points`,
  `results`, `events`, `braking`.
"""

from __future__ import annotations

import os
import shutil
import struct
from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from rigctl.core.channels import MICROPHONE, ChannelData
from rigctl.core.errors import RecordingError
from rigctl.core.units import unit_of
from rigctl.recording.durable import disk_error

if TYPE_CHECKING:
    from rigctl.recording.braking_file import BrakingFile

_UNIT_WORDS = {"Pa": "pa", "N·m": "nm", "bar": "bar", "1/min": "rpm", "°C": "degc"}


class Format(StrEnum):
    """What can be written."""

    WAV = "wav"
    CSV = "csv"
    MAT = "mat"
    HDF5 = "h5"


def export_braking(source: Path, folder: Path, formats: list[Format], prefix: str = "") -> list[Path]:
    """Write one braking in some formats.

    Parameters
    ----------
    source : Path
        Braking file.
    folder : Path
        Where to; made if it does not exist.
    formats : list of Format
        WAV is left out when there is no sound.
    prefix : str
        Put before the names of the files, such as the campaign's name and "-".

    Returns
    -------
    list of Path
        The files written. A name that is taken gets a number: nothing is replaced.

    Raises
    ------
    RecordingError
        The braking cannot be read or a file not be written.
    """
    from rigctl.recording.braking_file import read_braking  # loads HDF5

    file = read_braking(source)
    stem = f"{prefix}{file.index:05d}"
    written: list[Path] = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if Format.HDF5 in formats:
            written.append(_new(folder, f"{stem}.h5", lambda path: shutil.copyfile(source, path)))
        if Format.WAV in formats and MICROPHONE in file.channels:
            sound = file.channels[MICROPHONE]
            written.append(
                _new(folder, f"{stem}.wav", lambda path: write_wav(path, sound, _comment(file, sound)))
            )
        if Format.CSV in formats:
            written += _csv(folder, stem, file)
        if Format.MAT in formats:
            written.append(_new(folder, f"{stem}.mat", lambda path: _mat(path, file)))
    except OSError as error:
        raise disk_error(error, Path(str(error.filename or folder)), "export the braking") from error
    return written


def save_sound(source: Path, target: Path) -> Path:
    """The sound of a braking as recorded, into a WAV file of a person's choice (replaced if it exists).

    Raises
    ------
    RecordingError
        No sound, or the file cannot be written.
    """
    from rigctl.recording.braking_file import read_braking  # loads HDF5

    file = read_braking(source)
    if MICROPHONE not in file.channels:
        raise RecordingError("this braking was recorded without sound.", place=str(source))
    sound = file.channels[MICROPHONE]
    part = target.with_name(target.name + ".part")
    try:
        write_wav(part, sound, _comment(file, sound))
        os.replace(part, target)
    except OSError as error:
        raise disk_error(error, target, "save the sound") from error
    return target


def write_wav(path: Path, sound: ChannelData, comment: str = "") -> None:
    """16-bit WAV of one channel: counts as they are, other samples scaled to their peak."""
    samples, note = sound.samples, comment
    if samples.dtype != np.int16:
        peak = float(np.abs(samples).max(initial=0.0)) or 1.0
        samples = np.round(samples * (32767 / peak)).astype(np.int16)
        note = f"{comment}; 1 count = {peak / 32767 * sound.spec.scale:.9g} {sound.spec.unit}"
    rate = round(sound.spec.rate_hz)
    text = note.encode("utf-8") + b"\0"
    text += b"\0" * (len(text) % 2)
    info = b"INFO" + b"ICMT" + struct.pack("<I", len(text)) + text
    data = samples.astype("<i2", copy=False).tobytes()
    chunks = (
        (b"fmt ", struct.pack("<HHIIHH", 1, 1, rate, 2 * rate, 2, 16)),
        (b"LIST", info),
        (b"data", data),
    )
    body = b"WAVE" + b"".join(name + struct.pack("<I", len(content)) + content for name, content in chunks)
    path.write_bytes(b"RIFF" + struct.pack("<I", len(body)) + body)


def _new(folder: Path, name: str, write: Callable[[Path], Any]) -> Path:
    """Write a new file; a half-written one never bears the final name."""
    target, number = folder / name, 2
    stem, dot, ending = name.rpartition(".")
    while target.exists():
        target, number = folder / f"{stem}-{number}{dot}{ending}", number + 1
    part = target.with_name(target.name + ".part")
    try:
        write(part)
        os.replace(part, target)
    finally:
        part.unlink(missing_ok=True)
    return target


def _comment(file: BrakingFile, sound: ChannelData) -> str:
    words = f"rigctl braking {file.index} {file.summary['start_time']}"
    if sound.spec.is_counts:
        words += f"; 1 count = {sound.spec.scale:.9g} {sound.spec.unit}"
    return words


def _csv(folder: Path, stem: str, file: BrakingFile) -> list[Path]:
    groups: dict[tuple[float, int], list[ChannelData]] = {}
    for name in file.channels:
        data = file.channels[name]
        groups.setdefault((data.spec.rate_hz, len(data.samples)), []).append(data)
    written = []
    for (rate_hz, _), channels in groups.items():
        names = ["time_s", *(_column(data) for data in channels)]
        table = np.column_stack([channels[0].time_s(), *(data.physical() for data in channels)])
        written.append(_new(folder, f"{stem}-{rate_hz:g}Hz.csv", lambda p, n=names, t=table: _table(p, n, t)))
    if file.events and len(next(iter(file.events.values()))):
        columns = np.column_stack(list(file.events.values()))
        written.append(_new(folder, f"{stem}-events.csv", lambda p: _table(p, list(file.events), columns)))
    return written


def _column(data: ChannelData) -> str:
    unit = _UNIT_WORDS.get(data.spec.unit, data.spec.unit)
    return f"{data.spec.name}_{unit}" if unit else data.spec.name


def _table(path: Path, names: list[str], table: NDArray[Any]) -> None:
    with path.open("w", encoding="utf-8", newline="") as stream:
        stream.write(",".join(names) + "\n")
        np.savetxt(stream, table, fmt="%.9g", delimiter=",")


def _mat(path: Path, file: BrakingFile) -> None:
    from scipy.io import savemat

    channels = {}
    for name in file.channels:
        data = file.channels[name]
        channels[name] = {
            "value": data.physical(),
            "rate_hz": data.spec.rate_hz,
            "t0_s": data.t0_s,
            "unit": data.spec.unit,
            "description": data.spec.description,
        }
    summary = file.summary
    content = {
        "channels": channels,
        "set_points": _plain(summary["set_points"]),
        "results": _plain(summary["results"]),
        "events": {name: np.asarray(column, np.float64) for name, column in file.events.items()},
        "event_units": {name: unit_of(name) for name in file.events},
        "braking": {
            "index": file.index,
            "status": file.status,
            "sequence": summary["sequence"],
            "role": summary["role"],
            "start_time": summary["start_time"],
            "note": summary["note"],
        },
    }
    with path.open("wb") as stream:
        savemat(stream, content, do_compression=True, long_field_names=True, oned_as="column")


def _plain(values: dict[str, Any]) -> dict[str, float]:
    """Numbers by name, NaN where not defined."""
    return {name: float("nan") if value is None else float(value) for name, value in values.items()}

"""What runs in the worker process: functions that load HDF5, scipy or numba only when they are called.

Job: late imports around `rigctl.analysis.viewing`, `rigctl.export` and the catalogue. Not its job: the
work.
"""

from __future__ import annotations

from pathlib import Path

from rigctl.analysis.braking_view import BrakingView, Listenable
from rigctl.export.braking import Format
from rigctl.recording.catalogue import Catalogue, Found

LANE = "data"
"""Worker of the data page: opening a braking does not wait for a study of the model."""


def read_files(campaign: Path, names: list[str]) -> Found:
    """Summaries of these files, remembered in the catalogue."""
    with Catalogue(campaign) as catalogue:
        return catalogue.update(names)


def view(path: Path) -> BrakingView:
    """Everything that is drawn of a braking."""
    from rigctl.analysis.viewing import view_braking

    return view_braking(path)


def overlay(path: Path) -> BrakingView:
    """What is drawn of a braking that is compared with others."""
    from rigctl.analysis.viewing import view_braking

    return view_braking(path, waveform=False)


def sound(path: Path, equal_loudness: bool, rate_hz: float | None) -> Listenable:
    """Sound for the loudspeaker."""
    from rigctl.analysis.viewing import listenable

    return listenable(path, equal_loudness=equal_loudness, rate_hz=rate_hz)


def save_wav(source: Path, target: Path) -> Path:
    """The sound as recorded, as a WAV file."""
    from rigctl.export.braking import save_sound

    return save_sound(source, target)


def export(source: Path, folder: Path, formats: list[Format], prefix: str) -> list[Path]:
    """One braking in some formats."""
    from rigctl.export.braking import export_braking

    return export_braking(source, folder, formats, prefix)

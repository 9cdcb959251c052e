"""The trash of a campaign: braking files that are moved aside and can be put back.

Job: move a file between `brakings/` and `trash/`, with the event in the journal; nothing is ever deleted or
replaced. Not its job: emptying the trash (a person with a file manager), doing the braking again (`rigctl
resume` does: for it the braking is missing).
"""

from __future__ import annotations

import os
from pathlib import Path

from rigctl.core.errors import RecordingError
from rigctl.recording.annotations import Action, annotate
from rigctl.recording.durable import disk_error, sync_folder

FOLDER = "trash"


def trash_braking(campaign: Path, index: int, who: str = "") -> Path:
    """Move a braking's file to the trash; returns where it is.

    Raises
    ------
    RecordingError
        There is no such file, or it cannot be moved.
    """
    source = campaign / "brakings" / f"{index:05d}.h5"
    if not source.exists():
        raise RecordingError(
            f"braking {index} has no file.", place=str(source), remedy="It may be in the trash."
        )
    try:
        (campaign / FOLDER).mkdir(exist_ok=True)
    except OSError as error:
        raise disk_error(error, campaign / FOLDER, "make the trash folder") from error
    target = _free_name(campaign / FOLDER, index)
    _move(source, target)
    try:
        annotate(campaign, index, Action.TRASH, target.name, who)
    except RecordingError:
        _move(target, source)
        raise
    return target


def restore_braking(campaign: Path, name: str, who: str = "") -> Path:
    """Put a file of the trash back; returns where it is.

    Raises
    ------
    RecordingError
        It is not in the trash, the braking has been recorded again since, or it cannot be moved.
    """
    source = campaign / FOLDER / name
    index = index_of(name)
    target = campaign / "brakings" / f"{index:05d}.h5"
    if not source.is_file():
        raise RecordingError(f"{name} is not in the trash.", place=str(source))
    if target.exists():
        raise RecordingError(
            f"braking {index} has been recorded again since.",
            place=str(target),
            remedy="Move the new one to the trash first, if the old one is to count.",
        )
    _move(source, target)
    try:
        annotate(campaign, index, Action.UNTRASH, name, who)
    except RecordingError:
        _move(target, source)
        raise
    return target


def trashed_files(campaign: Path) -> list[Path]:
    """Files in the trash, by name."""
    return sorted((campaign / FOLDER).glob("*.h5"))


def index_of(name: str) -> int:
    """Number of the braking whose file in the trash has this name.

    Raises
    ------
    RecordingError
        It is no name of a braking file.
    """
    number = name.partition(".")[0].partition("-")[0]
    if not number.isdecimal():
        raise RecordingError(f"{name!r} is no braking file.")
    return int(number)


def _free_name(folder: Path, index: int) -> Path:
    path, number = folder / f"{index:05d}.h5", 2
    while path.exists():
        path = folder / f"{index:05d}-{number}.h5"
        number += 1
    return path


def _move(source: Path, target: Path) -> None:
    if target.exists():
        raise RecordingError(f"{target.name} is there already; nothing was moved.", place=str(target))
    try:
        os.rename(source, target)
        sync_folder(target.parent)
        sync_folder(source.parent)
    except OSError as error:
        raise disk_error(error, source, "move the file") from error

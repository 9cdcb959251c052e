"""Writing that is on the disk when the call returns, or says that it is not.

Job: whole writes, flushed files, atomic replacement, flushed folders; every failure of the operating system
becomes one `RecordingError` that names the file and the remedy. NOT its job: formats.
"""

from __future__ import annotations

import errno
import os
from pathlib import Path

from rigctl.core.errors import RecordingError

_REMEDIES = {
    errno.ENOSPC: "Free some space on this disk; recorded data is kept and `rigctl resume` continues.",
    errno.EDQUOT: "Free some space of your quota; recorded data is kept and `rigctl resume` continues.",
    errno.EIO: "The disk fails: save the campaign folder to another disk, then `rigctl resume`.",
    errno.EROFS: "The file system has become read-only: see the system log, remount, then `rigctl resume`.",
    errno.EACCES: "Give this user the right to write there.",
}


def disk_error(error: OSError, path: Path, action: str) -> RecordingError:
    """The `RecordingError` for a failed call on `path`; `action` says what could not be done."""
    reason = error.strerror or str(error)
    remedy = _REMEDIES.get(error.errno or 0, "Look at the disk and its file system.")
    return RecordingError(f"cannot {action}: {reason}.", place=str(path), value=error.errno, remedy=remedy)


def write_all(fd: int, data: bytes | memoryview) -> None:
    """Write all of `data`, going on after short writes.

    Raises
    ------
    OSError
        The operating system refused the rest: a short write on a full disk ends in ENOSPC.
    """
    view = memoryview(data)
    while view:
        written = os.write(fd, view)
        if written <= 0:
            raise OSError(errno.EIO, "nothing was written")
        view = view[written:]


def sync_folder(folder: Path) -> None:
    """Flush a folder, so that files made, renamed or removed in it stay so after a power cut."""
    fd = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
    try:
        os.fsync(fd)
    finally:
        os.close(fd)


def write_part(path: Path, data: bytes | memoryview) -> None:
    """Write and flush a whole file that may be thrown away after a crash (`.part`); replaces an older one.

    Raises
    ------
    RecordingError
        The disk is full or fails; the incomplete file is removed.
    """
    try:
        fd = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, 0o644)
        try:
            write_all(fd, data)
            os.fsync(fd)
        finally:
            os.close(fd)
    except OSError as error:
        path.unlink(missing_ok=True)
        raise disk_error(error, path, f"write {len(data)} bytes") from error


def publish(part: Path, path: Path) -> None:
    """Rename a flushed `.part` to its final name, in one step, and flush the folder.

    Raises
    ------
    RecordingError
        The file system refuses.
    """
    try:
        os.replace(part, path)
        sync_folder(path.parent)
    except OSError as error:
        raise disk_error(error, path, "give the file its final name") from error

"""The campaign folder: one execution of a program on disk.

Job: make and open it, say where things are, write and read `campaign.toml`, keep two runs apart, know which
brakings are complete. NOT its job: contents of the files, recovery (`recovery`), reports.

::

    <campaign>/campaign.toml     resolved and frozen configuration
               journal.jsonl     what happened
               brakings/00001.h5 one file per braking; superseded/ keeps earlier, incomplete attempts
               spool/00001.spool while a braking runs
               report/
"""

from __future__ import annotations

import fcntl
import hashlib
import os
import re
import shutil
import time
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomli_w

from rigctl.core.errors import ConfigError, RecordingError
from rigctl.core.journal import read_journal
from rigctl.recording.braking import COMPLETE
from rigctl.recording.braking_file import read_summary
from rigctl.recording.durable import disk_error, publish, sync_folder, write_part
from rigctl.recording.kinds import COMMITTED

_SAFE_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9._-]{0,99}")
_FILE_NAME = re.compile(r"(\d{5,})\.h5")


@dataclass(frozen=True)
class Campaign:
    """A campaign folder that exists. Get one from `create_campaign` or `open_campaign`."""

    folder: Path

    @property
    def toml_path(self) -> Path:
        """The resolved configuration."""
        return self.folder / "campaign.toml"

    @property
    def journal_path(self) -> Path:
        """The journal of all processes."""
        return self.folder / "journal.jsonl"

    @property
    def brakings(self) -> Path:
        """Folder of the braking files."""
        return self.folder / "brakings"

    @property
    def superseded(self) -> Path:
        """Folder of earlier, incomplete attempts at brakings that were done again."""
        return self.brakings / "superseded"

    @property
    def spools(self) -> Path:
        """Folder of the spools."""
        return self.folder / "spool"

    @property
    def report(self) -> Path:
        """Folder of figures and report."""
        return self.folder / "report"

    def braking_path(self, index: int) -> Path:
        """File of a braking, whether it exists or not."""
        return self.brakings / f"{index:05d}.h5"

    def spool_path(self, index: int) -> Path:
        """Spool of a braking, whether it exists or not."""
        return self.spools / f"{index:05d}.spool"

    def braking_files(self) -> list[Path]:
        """Files of all brakings that have one, by index."""
        found = [path for path in self.brakings.iterdir() if _FILE_NAME.fullmatch(path.name)]
        return sorted(found, key=lambda path: int(path.stem))

    def resolved(self) -> dict[str, Any]:
        """The mapping in `campaign.toml`.

        Raises
        ------
        ConfigError
            It cannot be read.
        """
        try:
            return tomllib.loads(self.toml_path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
            raise ConfigError(
                f"this campaign cannot be read ({error}).",
                place=str(self.toml_path),
                remedy="Restore the file from a copy; without it the campaign cannot be continued.",
            ) from error

    def committed(self) -> dict[int, dict[str, Any]]:
        """Newest journal record of each committed braking: payload with file, sha256, status, attempt."""
        if not self.journal_path.exists():
            return {}
        records = read_journal(self.journal_path)
        return {int(r.payload["index"]): r.payload for r in records if r.kind == COMMITTED}

    def completed_indices(self) -> frozenset[int]:
        """Brakings that need not be done again: committed as complete, and the file is as it was then."""
        return frozenset(
            index
            for index, record in self.committed().items()
            if record["status"] == COMPLETE and file_sha256(self.braking_path(index)) == record["sha256"]
        )

    def next_attempt(self, index: int) -> int:
        """Number of the next attempt at a braking, from 1."""
        path = self.braking_path(index)
        kept = len(list(self.superseded.glob(f"{index:05d}-*.h5")))
        if not path.exists():
            return kept + 1
        try:
            return max(kept, int(read_summary(path)["attempt"])) + 1
        except RecordingError:  # damaged: it will be kept beside the new one
            return kept + 2

    @contextmanager
    def lock(self, purpose: str = "run", timeout_s: float = 0.0) -> Iterator[None]:
        """Hold this campaign: "run" for a whole run, "spool" for the process that writes its files.

        Raises
        ------
        RecordingError
            Another process holds it for longer than `timeout_s`.
        """
        path = self.folder / f".{purpose}.lock"
        fd = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
        try:
            _lock(fd, path, timeout_s)
            os.ftruncate(fd, 0)
            os.pwrite(fd, f"{os.getpid()}\n".encode(), 0)
            yield
        finally:
            os.close(fd)


def _lock(fd: int, path: Path, timeout_s: float) -> None:
    deadline = time.monotonic() + timeout_s
    while True:
        try:
            fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return
        except BlockingIOError as error:
            if time.monotonic() >= deadline:
                holder = os.pread(fd, 32, 0).decode(errors="replace").strip() or "unknown"
                raise RecordingError(
                    f"another process (pid {holder}) works on this campaign.",
                    place=str(path.parent),
                    value=holder,
                    remedy="Wait for its end, or stop it.",
                ) from error
            time.sleep(0.02)


def create_campaign(folder: Path, resolved: Mapping[str, Any]) -> Campaign:
    """Make a new campaign folder; an existing one is never touched.

    Parameters
    ----------
    folder : Path
        Parents are made as needed; the last part must be a plain name.
    resolved : mapping
        Rig, brake, limits, calibrations, program, versions. Keys with the value None are left out (TOML
        has no such value, and None is the default of what is left out).

    Raises
    ------
    ConfigError
        Bad name, the folder exists, or `resolved` holds what TOML cannot say.
    RecordingError
        The disk refuses.
    """
    if not _SAFE_NAME.fullmatch(folder.name) or folder.name.endswith("."):
        raise ConfigError(
            f"'{folder.name}' cannot be the name of a campaign.",
            place=str(folder),
            value=folder.name,
            remedy="Use letters, digits, '.', '_' and '-', beginning with a letter or digit.",
        )
    text = to_toml(resolved, place=str(folder / "campaign.toml"))
    campaign = Campaign(folder)
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir()
        for part in (campaign.brakings, campaign.spools, campaign.report):
            part.mkdir()
    except FileExistsError as error:
        raise ConfigError(
            "this campaign exists already.",
            place=str(folder),
            remedy="Choose another name with --out, or continue it with `rigctl resume`.",
        ) from error
    except OSError as error:
        raise disk_error(error, folder, "make the campaign folder") from error
    part = campaign.toml_path.with_suffix(".toml.part")
    write_part(part, text.encode())
    publish(part, campaign.toml_path)
    sync_folder(folder.parent)
    return campaign


def open_campaign(folder: Path) -> Campaign:
    """Open an existing campaign.

    Raises
    ------
    ConfigError
        There is none in this folder.
    """
    campaign = Campaign(folder)
    if not campaign.toml_path.is_file():
        raise ConfigError(
            "there is no campaign here (no campaign.toml).",
            place=str(folder),
            remedy="Give the folder that `rigctl run` printed.",
        )
    for part in (campaign.brakings, campaign.spools, campaign.report):
        part.mkdir(exist_ok=True)
    return campaign


def require_free_space(folder: Path, needed_bytes: float) -> None:
    """Refuse to start what does not fit on the disk.

    Raises
    ------
    RecordingError
        Less than `needed_bytes` are free at `folder` (or its nearest existing parent).
    """
    place = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    free = shutil.disk_usage(place).free
    if free < needed_bytes:
        raise RecordingError(
            f"{free / 1e6:.0f} MB are free, {needed_bytes / 1e6:.0f} MB are needed.",
            place=str(folder),
            value=free,
            remedy="Free some space, or choose another disk with --out.",
        )


def to_toml(mapping: Mapping[str, Any], place: str = "campaign.toml") -> str:
    """TOML text of nested plain mappings; `tomllib.loads` gives back the same, without the Nones.

    Raises
    ------
    ConfigError
        A value has no form in TOML: an object, or None within a list.
    """
    try:
        return tomli_w.dumps(_without_none(mapping, place, ""))
    except (TypeError, ValueError) as error:
        raise ConfigError(f"this cannot be written as TOML: {error}.", place=place) from error


def _without_none(value: Any, place: str, key: str) -> Any:
    if isinstance(value, Mapping):
        return {
            str(name): _without_none(item, place, f"{key}.{name}" if key else str(name))
            for name, item in value.items()
            if item is not None
        }
    if isinstance(value, list | tuple):
        if any(item is None for item in value):
            raise ConfigError(
                "a list with an empty entry cannot be written as TOML.", place=f"{place}: {key}"
            )
        return [_without_none(item, place, f"{key}[{number}]") for number, item in enumerate(value)]
    return value


def file_sha256(path: Path) -> str:
    """SHA-256 of a file as hexadecimal text; "" when it cannot be read."""
    try:
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError:
        return ""

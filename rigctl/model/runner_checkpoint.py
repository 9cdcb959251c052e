"""What a long study has finished, kept in a folder so that it can go on after Ctrl-C, kill -9 or a power cut.

Job: `Checkpoint`: a manifest (study.json) that says which study the folder holds, and finished results as
lines of results.jsonl, each with its CRC and flushed to the disk. NOT its job: computing, deciding where
the folder is.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import zlib
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from rigctl.core.errors import ConfigError, RunError

MANIFEST, RESULTS = "study.json", "results.jsonl"
_FORMAT = 1
_LONG = 120
"""Texts of a setting longer than this stand in the manifest as their digest (a model's text)."""


def identity(
    function: str, setting: Mapping[str, Any], tasks: Sequence[Any], code: Mapping[str, str]
) -> dict[str, Any]:
    """Everything a study's results depend on, long texts as digests; JSON-able."""
    return {
        "format": _FORMAT,
        "function": function,
        "setting": _short(setting),
        "tasks": {"count": len(tasks), "digest": digest(tasks)},
        "code": dict(code),
    }


def digest(content: Any) -> str:
    """SHA-256 of anything JSON knows, 16 digits."""
    text = json.dumps(content, sort_keys=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


class Checkpoint:
    """Finished results of the study in a folder; made where the folder is new.

    Attributes
    ----------
    results : place of the task -> result, of all lines that are whole
    damaged : lines left out because their CRC is wrong (their tasks are computed again); a torn last line,
        as kill -9 leaves it, is no damage

    Raises
    ------
    ConfigError
        the folder holds another study (other model, settings or code), is in use, or cannot be written
    """

    def __init__(self, folder: Path, study: Mapping[str, Any]) -> None:
        self.folder = folder
        self.results: dict[int, Any] = {}
        self.damaged = 0
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._fd = os.open(folder / RESULTS, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o644)
        except OSError as error:
            raise ConfigError(
                f"cannot keep the study here: {error.strerror}.",
                place=str(folder),
                remedy="Name another folder.",
            ) from error
        try:
            self._lock()
            self._check(study)
            self._restore(study["tasks"]["count"])
        except BaseException:
            os.close(self._fd)
            raise

    def append(self, places: Sequence[int], results: Sequence[Any]) -> None:
        """Keep results of tasks; they are on the disk when this returns.

        Raises
        ------
        RunError
            the disk is full or gone
        """
        body = json.dumps({"places": list(places), "results": list(results)}, allow_nan=False).encode()
        line = b"%08x %s\n" % (zlib.crc32(body), body)
        try:
            if os.write(self._fd, line) != len(line):
                raise OSError(28, "no space left")
            os.fdatasync(self._fd)
        except OSError as error:
            raise RunError(
                f"results cannot be kept: {error.strerror}.",
                place=str(self.folder),
                remedy="Make space and give the same command: it goes on.",
            ) from error
        self.results.update(zip(places, results, strict=True))

    def close(self) -> None:
        """Release the folder."""
        os.close(self._fd)

    def _lock(self) -> None:
        try:
            fcntl.flock(self._fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise ConfigError(
                "another process is computing this study.",
                place=str(self.folder),
                remedy="Wait for it, or name another folder.",
            ) from error

    def _check(self, study: Mapping[str, Any]) -> None:
        path = self.folder / MANIFEST
        if path.exists():
            try:
                there = json.loads(path.read_bytes())
            except ValueError as error:
                raise ConfigError(
                    "is not the manifest of a study.", place=str(path), remedy="Name another folder."
                ) from error
            found = list(_differences(there, json.loads(json.dumps(study))))
            if found:
                raise ConfigError(
                    f"this folder holds another study: {'; '.join(found[:4])}.",
                    place=str(self.folder),
                    remedy="Name another folder, or delete this one to begin again.",
                )
            return
        if os.fstat(self._fd).st_size:
            raise ConfigError(
                f"holds {RESULTS} but no {MANIFEST}: what they belong to is unknown.",
                place=str(self.folder),
                remedy="Name another folder.",
            )
        part = path.with_suffix(".part")
        with part.open("w", encoding="utf-8") as file:
            file.write(json.dumps(study, indent=2, ensure_ascii=False) + "\n")
            file.flush()
            os.fsync(file.fileno())
        part.replace(path)
        folder = os.open(self.folder, os.O_RDONLY | os.O_DIRECTORY)
        os.fsync(folder)
        os.close(folder)

    def _restore(self, count: int) -> None:
        data = (self.folder / RESULTS).read_bytes()
        whole = data.rfind(b"\n") + 1
        for line in data[:whole].splitlines():
            content = _line(line)
            if content is None or any(not 0 <= place < count for place in content["places"]):
                self.damaged += 1
                continue
            self.results.update(zip(content["places"], content["results"], strict=True))
        if whole < len(data):
            os.ftruncate(self._fd, whole)  # a torn last line: the next one must begin on its own


def _line(line: bytes) -> dict[str, Any] | None:
    crc, _, body = line.partition(b" ")
    try:
        return json.loads(body) if int(crc, 16) == zlib.crc32(body) else None
    except ValueError:
        return None


def _short(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _short(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_short(item) for item in value]
    if isinstance(value, str) and len(value) > _LONG:
        return f"sha256 {hashlib.sha256(value.encode()).hexdigest()[:16]}"
    return value


def _differences(there: Any, here: Any, place: str = "") -> Iterator[str]:
    if isinstance(there, dict) and isinstance(here, dict):
        for key in sorted(there.keys() | here.keys()):
            inner = f"{place}.{key}" if place else str(key)
            yield from _differences(there.get(key), here.get(key), inner)
    elif there != here:
        yield f"{place.removeprefix('setting.')} is {_shown(there)} there and {_shown(here)} here"


def _shown(value: Any) -> str:
    text = "nothing" if value is None else value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "…"

"""Crash states from a log of system calls: a folder as it is when everything stops between two of them.

`record` notes every call that changes files below a folder; `after_kill` rebuilds the folder as the death of
the process leaves it (all calls so far are done), `after_power_cut` as a loss of power may leave it: only
flushed contents, and only names whose folder was flushed. No hook in the product is needed.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest


@dataclass
class Log:
    """Calls in order: (verb, ...). `acks` are what was promised, and after how many calls."""

    root: Path
    calls: list[tuple[Any, ...]] = field(default_factory=list)
    acks: list[tuple[int, str, Any]] = field(default_factory=list)

    def ack(self, kind: str, value: Any) -> None:
        """A promise was given now."""
        self.acks.append((len(self.calls), kind, value))


@contextmanager
def record(root: Path) -> Iterator[Log]:
    """Note all calls below `root` made through `os` in this process."""
    log, names = Log(root), {}
    real = {name: getattr(os, name) for name in CALLS}

    def inside(path: Any) -> str | None:
        try:
            return str(Path(os.fspath(path)).relative_to(root))
        except (TypeError, ValueError):
            return None

    def open_(path: Any, flags: int, *rest: Any, **more: Any) -> int:
        existed = os.path.exists(path)
        fd = real["open"](path, flags, *rest, **more)
        name = inside(path)
        names[fd] = name
        if name is not None and flags & os.O_CREAT and not existed:
            log.calls.append(("create", name))
        if name is not None and flags & os.O_TRUNC:
            log.calls.append(("truncate", name, 0))
        return fd

    def write(fd: int, data: Any) -> int:
        n = real["write"](fd, data)
        if names.get(fd) is not None:
            log.calls.append(("write", names[fd], bytes(data[:n])))
        return n

    def sync(name: str) -> Any:
        def call(fd: int) -> None:
            real[name](fd)
            if names.get(fd) is not None:
                log.calls.append(("sync", names[fd]))

        return call

    def replace(source: Any, target: Any) -> None:
        real["replace"](source, target)
        log.calls.append(("replace", inside(source), inside(target)))

    def unlink(path: Any, **more: Any) -> None:
        real["unlink"](path, **more)
        if inside(path) is not None:
            log.calls.append(("unlink", inside(path)))

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "open", open_)
        patch.setattr(os, "write", write)
        patch.setattr(os, "fsync", sync("fsync"))
        patch.setattr(os, "fdatasync", sync("fdatasync"))
        patch.setattr(os, "replace", replace)
        patch.setattr(os, "unlink", unlink)
        yield log


CALLS = ("open", "write", "fsync", "fdatasync", "replace", "unlink")


@dataclass
class _File:
    content: bytearray
    flushed: bytes


class _Disk:
    """Names and contents, each once as the processes see them and once as they are on the platter."""

    def __init__(self, start: dict[str, bytes]) -> None:
        self.names = {name: _File(bytearray(data), data) for name, data in start.items()}
        self.flushed_names = dict(self.names)

    def do(self, call: tuple[Any, ...]) -> None:
        verb, name = call[0], call[1]
        if verb == "create":
            self.names[name] = _File(bytearray(), b"")
        elif verb == "truncate":
            del self.names[name].content[call[2] :]
        elif verb == "write":
            self.names[name].content += call[2]
        elif verb == "replace":
            self.names[call[2]] = self.names.pop(name)
        elif verb == "unlink":
            del self.names[name]
        elif name in self.names:
            self.names[name].flushed = bytes(self.names[name].content)
        else:  # a folder
            folder = "" if name == "." else name
            for table in (self.flushed_names, self.names):
                for path in [path for path in table if os.path.dirname(path) == folder]:
                    if path in self.names:
                        self.flushed_names[path] = self.names[path]
                    else:
                        del self.flushed_names[path]


def snapshot(root: Path) -> dict[str, bytes]:
    """Contents of all files below `root`."""
    return {str(path.relative_to(root)): path.read_bytes() for path in root.rglob("*") if path.is_file()}


def after_kill(log: Log, start: dict[str, bytes], calls: int, torn: float = 0.0) -> dict[str, bytes]:
    """Files after `calls` calls, and the part `torn` of the next one when that is a write."""
    disk = _Disk(start)
    for call in log.calls[:calls]:
        disk.do(call)
    if torn and calls < len(log.calls) and log.calls[calls][0] == "write":
        verb, name, data = log.calls[calls]
        disk.do((verb, name, data[: int(torn * len(data))]))
    return {name: bytes(file.content) for name, file in disk.names.items()}


def after_power_cut(log: Log, start: dict[str, bytes], calls: int) -> dict[str, bytes]:
    """Files after `calls` calls when nothing survives that was not flushed."""
    disk = _Disk(start)
    for call in log.calls[:calls]:
        disk.do(call)
    return {name: file.flushed for name, file in disk.flushed_names.items()}


def restore(state: dict[str, bytes], root: Path) -> None:
    """Make `root` hold exactly these files; folders stay."""
    for path in root.rglob("*"):
        if path.is_file():
            path.unlink()
    for name, data in state.items():
        target = root / name
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(data)


def clone_folders(source: Path, target: Path) -> None:
    """The folders of `source` without files."""
    shutil.copytree(
        source, target, ignore=lambda folder, items: [i for i in items if (Path(folder) / i).is_file()]
    )

"""Program files for the page: read, written as the command line does it, and what saving would lose.

Job: functions without Qt that run in a thread. Not its job: asking people (`files`), the format
(`sequences`).
"""

from __future__ import annotations

import os
import re
import tempfile
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from rigctl.config.loading import load_model, translated
from rigctl.config.rig import RigConfig
from rigctl.core.errors import ConfigError
from sequences.program import Program, dump_program, load_program

# Strings of TOML first, so that a "#" within them is none; what is left beginning with "#" is a comment.
_STRING_OR_COMMENT = re.compile(
    r'"""(?:\\.|[^\\])*?"""|' r"'''.*?'''|" r'"(?:\\.|[^"\\\n])*"|' r"'[^'\n]*'|" r"(?P<comment>#[^\n]*)",
    re.DOTALL,
)


@dataclass(frozen=True)
class OpenedProgram:
    """A program file as it was read."""

    path: Path
    program: Program
    text: str


@dataclass(frozen=True)
class ShippedProgram:
    """A program offered in the empty state."""

    path: Path
    name: str
    description: str
    count: int


def has_comments(text: str) -> bool:
    """True when a TOML text has comments, which a rewritten file loses."""
    return any(found["comment"] is not None for found in _STRING_OR_COMMENT.finditer(text))


def open_program(path: Path, _reporter: Any = None) -> OpenedProgram:
    """Read a program.

    Raises
    ------
    ConfigError
        Names file, key, value and remedy.
    """
    with translated(path, model=Program):
        return OpenedProgram(path, load_program(path), path.read_text("utf-8"))
    raise AssertionError  # `translated` has raised


def text_on_disk(path: Path) -> str | None:
    """What the file holds now; None when there is none or it is no text."""
    try:
        return path.read_text("utf-8")
    except (OSError, UnicodeDecodeError):
        return None


def save_program(program: Program, path: Path, _reporter: Any = None) -> OpenedProgram:
    """Write a program as TOML: whole or not at all.

    Raises
    ------
    ConfigError
        It cannot be written.
    """
    text = dump_program(program)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        try:
            with os.fdopen(handle, "w", encoding="utf-8") as file:
                file.write(text)
                file.flush()
                os.fsync(file.fileno())
            os.chmod(name, path.stat().st_mode & 0o777 if path.exists() else 0o666 & ~_umask())
            os.replace(name, path)
        except BaseException:
            Path(name).unlink(missing_ok=True)
            raise
    except OSError as error:
        raise ConfigError(
            f"cannot be written: {error.strerror}.", place=str(path), remedy="Choose another folder."
        ) from error
    return OpenedProgram(path, program, text)


def _umask() -> int:
    for line in Path("/proc/self/status").read_text("ascii", "replace").splitlines():
        if line.startswith("Umask:"):
            return int(line.split()[1], 8)
    return 0o022


def copy_name(program: Program, now: datetime) -> str:
    """File name of the copy that is run when a program was not saved."""
    return f"{program.name.replace(' ', '_')}-{now:%Y%m%d-%H%M%S}.toml"


def save_copy(program: Program, folder: Path, now: datetime, _reporter: Any = None) -> OpenedProgram:
    """Write a program under a new name with the time in it; never over another file."""
    path = folder / copy_name(program, now)
    number = 2
    while path.exists():
        path = folder / f"{Path(copy_name(program, now)).stem}-{number}.toml"
        number += 1
    return save_program(program, path)


def shipped_programs(folder: Path, _reporter: Any = None) -> tuple[ShippedProgram, ...]:
    """The programs of a folder; files that are none are left out."""
    shipped = []
    for path in sorted(folder.glob("*.toml")):
        try:
            program = open_program(path).program
        except ConfigError:
            continue
        shipped.append(ShippedProgram(path, program.name, program.description, program.count))
    return tuple(shipped)


def rigs_in(folder: Path, _reporter: Any = None) -> tuple[dict[Path, RigConfig], tuple[str, ...]]:
    """Rig files of a folder, simulated ones first, and why others cannot be read."""
    rigs: dict[Path, RigConfig] = {}
    refused = []
    for path in sorted(folder.glob("*.toml")):
        try:
            rigs[path] = load_model(path, RigConfig)
        except ConfigError as error:
            refused.append(str(error))
    order = sorted(rigs, key=lambda p: (p.stem != "simulated", not rigs[p].simulated, p.name))
    return {path: rigs[path] for path in order}, tuple(refused)
